// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/solver/ocp_solver.hpp"
#include "problems/described_problem.hpp"

namespace chicane::bench {

/// Where a solve starts from.
enum class Start {
  kCold,     ///< inputs of zero
  kPathLaw,  ///< inputs of a path-following law
  kWarm,     ///< the optimum of the control cycle before, shifted by one interval
};

/// One problem with the state and the inputs a solver starts from.
template <class Problem, int Capacity>
struct Instance : Posed<Problem> {
  DescribedTrajectory<Capacity> guess;
};

namespace detail {

/// A road of two sines; as long and as bent as suits the horizon.
struct Road {
  double wavelength, amplitude;

  explicit Road(double horizon_length)
      : wavelength{4.0 * horizon_length}, amplitude{0.35 * wavelength / (2.0 * kPi)} {}
  [[nodiscard]] double at(double x) const {
    const double phase = 2.0 * kPi * x / wavelength;
    return amplitude * (std::sin(phase) + 0.15 * std::sin(phase / 0.6 + 1.0));
  }
};

/// The least-squares cubic through twelve points of the road ahead, in the frame of a car at (x, y, psi).
inline std::array<double, 4> fit(const Road& road, double x, double y, double psi, double length) {
  Eigen::Matrix<double, 12, 4> powers;
  Eigen::Matrix<double, 12, 1> values;
  for (int i = 0; i < 12; ++i) {
    const double dx = length * std::cos(psi) * (i - 0.5) / 11.0;
    const double dy = road.at(x + dx) - y;
    const double along = (std::cos(psi) * dx + std::sin(psi) * dy) / length;
    powers.row(i) << 1.0, along, along * along, along * along * along;
    values(i) = -std::sin(psi) * dx + std::cos(psi) * dy;
  }
  const Eigen::Vector4d c = powers.colPivHouseholderQr().solve(values);
  return {c[0], c[1] / length, c[2] / (length * length), c[3] / (length * length * length)};
}

/// Puts a window of the corridor where it is seen in cycle `cycle` of a drive: never two in one horizon.
inline void place_window(CorridorProblem& problem, int cycle, int horizon) {
  const int length = std::max(4, horizon / 5);
  const int period = horizon + length + 10;
  const int number = (cycle + horizon) / period;
  problem.window_begin = number * period - cycle;
  problem.window_end = problem.window_begin + length;
  problem.window_side = number % 2 == 1 ? 1.0 : -1.0;
  if (number == 0) problem.window_end = problem.window_begin;
}

}  // namespace detail

/// Consecutive control cycles of a closed loop along a winding road: the speed wanted jumps between 9 and 24
/// m/s, every 25 cycles the car is moved aside (by 1.5 m, in a corridor by 1 m), and there is noise. The
/// first 20 cycles are left out.
template <class Problem, int Capacity>
std::vector<Instance<Problem, Capacity>> drive_a_loop(int horizon, int count,
                                                      solver::OcpSolver<Problem, Capacity>& ocp) {
  constexpr int kLeftOut = 20;
  constexpr double kKick = Problem::kNc > 0 ? 1.0 : 1.5;
  constexpr double dt = DescribedProblem::kStep;
  Random random{static_cast<std::uint64_t>(77 + horizon)};
  const detail::Road road(std::max(20.0, 18.0 * horizon * dt));
  double x = 0.0;
  double y = road.at(0.0) + 0.5;
  double psi = std::atan2(road.at(0.1) - road.at(0.0), 0.1);
  double speed = 12.0;
  std::vector<Instance<Problem, Capacity>> cycles;
  DescribedTrajectory<Capacity> plan;
  for (int cycle = 0; cycle < count + kLeftOut; ++cycle) {
    Instance<Problem, Capacity> now;
    now.problem.speed_reference = (cycle / 30) % 2 == 1 ? 9.0 : 24.0;
    const double length = 1.1 * std::max(speed, now.problem.speed_reference) * horizon * dt;
    now.problem.path = detail::fit(road, x, y, psi, std::max(20.0, length));
    if constexpr (Problem::kNc > 0) detail::place_window(now.problem, cycle, horizon);
    now.place(speed);
    now.guess.horizon = horizon;
    if (cycle == 0) {
      guess_by_path_law(now, now.guess);
    } else {
      now.guess = plan;
      solver::shift(now.guess, 1.0);
    }
    solver::roll_out(now.problem, now.start, now.guess);
    plan = now.guess;
    ocp.solve(now.problem, now.start, plan);
    if (cycle >= kLeftOut) cycles.push_back(now);
    const auto& input = plan.u[0];
    x += speed * std::cos(psi) * dt;
    y += speed * std::sin(psi) * dt + random.uniform(-0.02, 0.02);
    psi += speed * input[0] * dt / DescribedProblem::kLength + random.uniform(-0.004, 0.004);
    speed += input[1] * dt + random.uniform(-0.05, 0.05);
    if (cycle % 25 == 24) y += (cycle / 25) % 2 == 1 ? kKick : -kKick;
  }
  return cycles;
}

/// Seeded instances. Warm ones are consecutive cycles, solved by `ocp` on the way.
template <class Problem, int Capacity>
std::vector<Instance<Problem, Capacity>> make_family(Start start, int horizon, int count,
                                                     solver::OcpSolver<Problem, Capacity>& ocp) {
  if (start == Start::kWarm) return drive_a_loop<Problem, Capacity>(horizon, count, ocp);
  Random random{static_cast<std::uint64_t>(7000 + horizon)};
  std::vector<Instance<Problem, Capacity>> family;
  for (int i = 0; i < count; ++i) {
    Instance<Problem, Capacity> instance{random_instance<Problem>(random, horizon), {.horizon = horizon}};
    if (start == Start::kPathLaw) guess_by_path_law(instance, instance.guess);
    solver::roll_out(instance.problem, instance.start, instance.guess);
    family.push_back(instance);
  }
  return family;
}

}  // namespace chicane::bench
