// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "chicane/base/deadline.hpp"
#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/iteration_log.hpp"
#include "chicane/solver/problem.hpp"
#include "traced/program.hpp"

namespace chicane::python {

/// Longest horizon of a traced problem.
inline constexpr int kMostStages = 200;

/// What a traced problem is solved with. Arrays belong to the caller; rows are contiguous, in the order of
/// the shapes given.
struct TracedCall {
  int horizon = 0;
  const double* x0 = nullptr;
  const double* data = nullptr;  ///< parameters by stage: (np, data_stride), 64-byte aligned rows
  std::size_t data_stride = 0;
  const double* lower = nullptr;  ///< (horizon, nu)
  const double* upper = nullptr;
  const solver::SoftPenalty* penalties = nullptr;  ///< of each constraint
  const bool* is_hard = nullptr;
  solver::SolverOptions options;
  bool goes_on = false;  ///< from the multipliers of the solve before
  Deadline deadline = Deadline::never();
  solver::IterationLog* log = nullptr;
};

/// States and inputs (in: the guess), multipliers and the report. Vectors have the sizes of the problem.
struct TracedAnswer {
  std::vector<double> x;           ///< (horizon + 1, nx)
  std::vector<double> u;           ///< (horizon, nu)
  std::vector<double> adjoint;     ///< (horizon, nx): of x_{k+1}
  std::vector<double> bound;       ///< (horizon, nu)
  std::vector<double> constraint;  ///< (horizon, constraints)
  std::vector<double> equality;    ///< (horizon, equalities)
  std::vector<double> terminal_equality;
  std::vector<double> terminal_constraint;
  solver::HardReport report;
};

/// Memory of one program: slots as packs of eight stages, and as packs of two for one. Constants are in
/// place.
struct Slots {
  double* wide = nullptr;
  double* narrow = nullptr;
};
/// Memory of a solver for all programs, made outside of code that is compiled for one instruction set.
class Workspace {
 public:
  explicit Workspace(const TracedProblem& problem);
  [[nodiscard]] Slots slots(Function function, int order) const {
    return slots_[static_cast<std::size_t>(function)][static_cast<std::size_t>(order)];
  }

 private:
  std::array<std::array<Slots, 3>, kFunctions> slots_{};
  std::vector<double> memory_;
};

/// Solves one traced problem, again and again. One thread at a time.
class TracedSolver {
 public:
  virtual ~TracedSolver() = default;
  virtual void solve(const TracedCall& call, TracedAnswer& answer) noexcept = 0;
  /// At the answer of the last solve; false where that is not finite.
  virtual bool prepare() noexcept = 0;
  /// States and inputs from x0 (nx), after prepare(); returns whether the quadratic program is solved.
  virtual bool feedback(const double* x0, TracedAnswer& answer) noexcept = 0;
};

struct SizeClass {
  int nx, nu, nr, ne, nc, nh, neh, nec;
};
inline constexpr SizeClass kOf2States{2, 2, 8, 8, 6, 2, 2, 4};
inline constexpr SizeClass kOf4States{4, 2, 16, 12, 8, 2, 4, 4};
inline constexpr SizeClass kOf6States{6, 2, 16, 12, 8, 2, 6, 6};
inline constexpr SizeClass kOf8States{8, 4, 24, 16, 12, 4, 8, 8};
inline constexpr SizeClass kOf24States{24, 8, 48, 48, 48, 8, 24, 48};
inline constexpr SizeClass kOf52States{52, 8, 64, 64, 112, 8, 52, 104};

/// Sizes for which code exists; a problem takes the first that it fits in. A quadratic program of six states
/// costs a third of one of eight with two inputs more: hence the small steps. Tests that are not slow do with
/// two (CMake: CHICANE_PYTHON_TWO_SIZES).
#ifdef CHICANE_TWO_SIZES
inline constexpr std::array kSizeClasses{kOf8States, kOf52States};
#else
inline constexpr std::array kSizeClasses{kOf2States, kOf4States,  kOf6States,
                                         kOf8States, kOf24States, kOf52States};
#endif

/// A solver of the size class `Sizes` for the instruction set `Arch`. `problem` and `workspace` must outlive
/// it.
template <class Arch, SizeClass Sizes>
std::unique_ptr<TracedSolver> make_sized_solver(const TracedProblem& problem, const Workspace& workspace);

}  // namespace chicane::python
