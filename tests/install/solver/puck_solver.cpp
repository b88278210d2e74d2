// SPDX-License-Identifier: MIT
#include "puck_solver.hpp"

#include <array>
#include <chicane/base/compiler.hpp>
#include <chicane/solver/ocp_solver.hpp>
#include <tuple>

namespace solver = chicane::solver;

struct Puck {
  static constexpr int kNx = 2, kNu = 1, kNr = 1, kNe = 2, kNc = 0;
  static constexpr double kStep = 0.1;

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K, const X& x, const U& u) const {
    const auto& [position, speed] = x;
    const auto& [push] = u;
    return std::make_tuple(position + kStep * speed + 0.5 * kStep * kStep * push, speed + kStep * push);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K, const X&, const U& u) const {
    return std::make_tuple(0.01 * std::get<0>(u));
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X& x) const {
    return std::make_tuple(10.0 * (std::get<0>(x) - 1.0), 10.0 * std::get<1>(x));
  }
  std::array<double, 1> input_lower(int) const { return {-1.5}; }
  std::array<double, 1> input_upper(int) const { return {1.5}; }
};

template <class Arch>
class FastPuckSolver final : public PuckSolver {
 public:
  Plan solve() override {
    trajectory_ = {.horizon = 20};
    const solver::SolveReport report = solver_.solve(Puck{}, {0.0, 0.0}, trajectory_);
    return {report, trajectory_.x[20][0], trajectory_.x[20][1]};
  }

 private:
  solver::OcpSolver<Puck, 20, Arch> solver_;
  solver::Trajectory<2, 1, 20> trajectory_;
};

template <class Arch>
std::unique_ptr<PuckSolver> make_puck_solver() {
  return std::make_unique<FastPuckSolver<Arch>>();
}
template std::unique_ptr<PuckSolver> make_puck_solver<chicane::arch::Native>();
