// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "problems/reference.hpp"
#include "program/solves.hpp"

namespace chicane::bench {

/// What a benchmark ran on, in the words of the report.
struct Machine {
  std::string processor, compiler, flags, commit, date;
  std::string references;                      ///< what is compared with; empty without
  double load_before = 0.0, load_after = 0.0;  ///< jobs that want a core, mean over the last minute
};
[[nodiscard]] Machine this_machine(const References& references);
[[nodiscard]] double load();

/// Control steps of the default controller in closed loop.
struct StepTimes {
  std::size_t steps = 0;
  Spread cpu_us{};    ///< CPU time of a control step and one physics step
  Spread wall_us{};   ///< whole control steps, wall clock
  Spread solve_us{};  ///< the optimisation in them, wall clock
};

struct BenchReport {
  Machine machine;
  std::vector<SolveRow> solves{};
  StepTimes with_guard{}, without_guard{};
  bool was_interrupted = false;
};

/// One target of docs/benchmarks.md beside what was measured.
struct Target {
  std::string what;
  double least = 0.0;  ///< to be kept
  double aim = 0.0;
  bool is_ceiling = false;  ///< smaller is better
  double measured = 0.0;    ///< NaN: not measured in this run

  [[nodiscard]] bool is_kept() const { return is_ceiling ? measured <= least : measured >= least; }
};
[[nodiscard]] std::vector<Target> targets(const BenchReport& report);

[[nodiscard]] std::string to_markdown(const BenchReport& report);
[[nodiscard]] std::string to_json(const BenchReport& report);

/// What `chicane bench` asks for.
struct Request {
  int instances = 100;                    ///< of each family
  std::vector<int> horizons{10, 20, 50};  ///< intervals, each 2 to kLongestHorizon
};

/// Everything that `chicane bench` times, beside these solvers; says on stderr what it is at. Ends early,
/// with what there is, when `stop` is set. Fails like run::ClosedLoop::create().
[[nodiscard]] Result<BenchReport> measure(const Request& request, References& references,
                                          const std::atomic<bool>& stop);

}  // namespace chicane::bench
