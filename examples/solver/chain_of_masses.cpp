// SPDX-License-Identifier: MIT
// A chain of springs and masses hangs from a wall; the hand at its other end calms it, above a floor (after
// Wirsching, Bock, Diehl 2006, in the plane). Written with loops over arrays of one scalar type. With the
// name of a file: writes the motion there.
#include <cstdio>
#include <memory>

#include "chicane/solver/ocp_solver.hpp"

namespace solver = chicane::solver;

struct Chain {
  static constexpr std::size_t kMasses = 2,
                               kSpeeds = 2 * kMasses + 2;  // masses in motion; where their speeds begin
  static constexpr int kNx = 10, kNu = 2, kNr = 8, kNe = 6, kNc = 3;
  static constexpr double kStep = 0.2, kGravity = 9.81, kStiffness = 1.0, kMass = 0.03, kRest = 0.033,
                          kFloor = -0.8;
  static constexpr std::array<double, 2> kHand{0.5, 0.0};  // where it is to rest
  template <class T>
  using X = std::array<T, 10>;  // positions of masses and hand [m], speeds of the masses [m/s]
  template <class T>
  using U = std::array<T, 2>;  // speed of the hand [m/s]

  template <class T>
  static X<T> rate(const X<T>& x, const U<T>& u) {
    X<T> result;
    for (std::size_t i = 0; i < 2 * kMasses; ++i) result[i] = x[kSpeeds + i];
    result[2 * kMasses] = u[0];
    result[2 * kMasses + 1] = u[1];
    const auto pull = [&](std::size_t link) {  // of the spring before mass `link`
      U<T> d{x[2 * link], x[2 * link + 1]};
      if (link > 0) d = {d[0] - x[2 * link - 2], d[1] - x[2 * link - 1]};
      const T length = sqrt(d[0] * d[0] + d[1] * d[1] + 1e-6);
      const T share = kStiffness * (1.0 - kRest / length);
      return U<T>{share * d[0], share * d[1]};
    };
    for (std::size_t n = 0; n < kMasses; ++n) {
      const U<T> before = pull(n), behind = pull(n + 1);
      for (std::size_t i = 0; i < 2; ++i)
        result[kSpeeds + 2 * n + i] = (behind[i] - before[i]) * (1.0 / kMass) - 0.5 * x[kSpeeds + 2 * n + i];
      result[kSpeeds + 2 * n + 1] = result[kSpeeds + 2 * n + 1] - kGravity;
    }
    return result;
  }
  template <class K, class T>
  X<T> dynamics(K, const X<T>& x, const U<T>& u) const {  // two steps of Runge and Kutta's method
    constexpr double h = 0.5 * kStep;
    X<T> now = x;
    for (int part = 0; part < 2; ++part) {
      const auto ahead = [&](const X<T>& slope, double by) {
        X<T> result;
        for (std::size_t i = 0; i < 10; ++i) result[i] = now[i] + by * slope[i];
        return result;
      };
      const X<T> a = rate(now, u), b = rate(ahead(a, 0.5 * h), u), c = rate(ahead(b, 0.5 * h), u),
                 d = rate(ahead(c, h), u);
      for (std::size_t i = 0; i < 10; ++i) now[i] = now[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
    }
    return now;
  }
  template <class K, class T>
  std::array<T, 8> residual(K, const X<T>& x, const U<T>& u) const {
    return {1.5 * (x[4] - kHand[0]), 1.5 * (x[5] - kHand[1]), x[6], x[7], x[8], x[9], 0.1 * u[0], 0.1 * u[1]};
  }
  template <class T>
  std::array<T, 6> terminal_residual(const X<T>& x) const {
    return {5.0 * (x[4] - kHand[0]), 5.0 * (x[5] - kHand[1]), 3.0 * x[6], 3.0 * x[7], 3.0 * x[8], 3.0 * x[9]};
  }
  template <class K, class T>
  std::array<T, 3> constraint(K, const X<T>& x, const U<T>&) const {
    return {kFloor - x[1], kFloor - x[3], kFloor - x[5]};
  }
  solver::SoftPenalty soft_penalty(int) const { return {.linear = 50.0, .quadratic = 50.0}; }
  std::array<double, 2> input_lower(int) const { return {-1.0, -1.0}; }
  std::array<double, 2> input_upper(int) const { return {1.0, 1.0}; }
};

int main(int argc, char** argv) {
  constexpr int kHorizon = 40;
  constexpr double kOptimum = 3.170009;  // Ipopt's, from the same guess
  const auto ocp = std::make_unique<solver::OcpSolver<Chain, kHorizon>>();
  solver::Trajectory<10, 2, kHorizon> plan{.horizon = kHorizon};
  const std::array<double, 10> start{0.3, -0.2, 0.6, -0.1, 0.9, 0.3, 0.8, -0.6, -0.5, 0.9};
  const solver::SolveReport report = ocp->solve(Chain{}, start, plan);
  std::printf("%s after %d iterations, cost %.7g\n", to_string(report.status).data(), report.iterations,
              report.cost);
  if (argc > 1) {
    std::FILE* file = std::fopen(argv[1], "w");
    for (const auto& x : plan.x)
      std::fprintf(file, "%g %g %g %g %g %g\n", x[0], x[1], x[2], x[3], x[4], x[5]);
    std::fclose(file);
  }
  const bool is_known = chicane::abs(report.cost - kOptimum) < 1e-5 * kOptimum;
  return report.status == solver::SolveStatus::kOptimal && is_known ? 0 : 1;
}
