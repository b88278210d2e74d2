// SPDX-License-Identifier: MIT
#include "program/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"
#include "problems/cpu_time.hpp"
#include "problems/structured_solver.hpp"

namespace chicane::bench {
namespace {

constexpr int kDrives = 3;

/// Our own solver on the described problem as any model is written: one scalar type, dense derivatives.
class DenseReference final : public Reference<DescribedProblem> {
 public:
  [[nodiscard]] std::string_view name() const override { return "dense"; }
  [[nodiscard]] Outcome solve(const Instance& now, const Instance*, Trajectory& answer) override {
    constexpr int kRepeats = 12;  // as many as of the structured form
    solver::SolveReport report;
    const double begin = cpu_time();
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      answer.horizon = now.guess.horizon;
      std::copy_n(now.guess.u.begin(), now.guess.horizon, answer.u.begin());
      report = solve_fast(now.problem, now.start, answer);
    }
    return {.is_solved = report.status == solver::SolveStatus::kOptimal,
            .iterations = report.iterations,
            .time = (cpu_time() - begin) / kRepeats};
  }
};

void measure_solves(const Request& request, References& references, const std::atomic<bool>& stop,
                    BenchReport& report) {
  const double begin = cpu_time(), all = static_cast<double>(families().size() * request.horizons.size());
  double done = 0.0;
  for (const std::string_view family : families()) {
    for (const int horizon : request.horizons) {
      if (stop) return;
      const double left = (cpu_time() - begin) / std::max(done, 1.0) * (all - done);  // [s]
      fmt::print(stderr, "{}, N = {}, {} instances{}\n", family, horizon, request.instances,
                 done > 0.0 ? fmt::format(", about {:.0f} s left", left) : "");
      ++done;
      const SolveRow row = time_solves(family, horizon, request.instances, references, stop);
      if (row.instances > 0) report.solves.push_back(row);
    }
  }
}

/// Two laps of what `chicane drive` does by default, in virtual time, and again: every drive takes the same
/// steps, and each counts with the least time it took.
Result<StepTimes> measure_steps(std::string_view guard_mode, const std::atomic<bool>& stop) {
  if (stop) return StepTimes{};
  fmt::print(stderr, "control step of the default controller, guard {}\n", guard_mode);
  const Result<scenario::Scenario> scenario =
      protocol::compose({"", {{"laps", "2"}, {"guard.mode", std::string(guard_mode)}}});
  if (!scenario) return fail(scenario.error());
  std::vector<double> cpu;
  std::vector<double> wall;
  std::vector<double> solves;
  for (int drive = 0; drive < kDrives && !stop; ++drive) {
    const auto loop = run::ClosedLoop::create(*scenario);
    if (!loop) return fail(loop.error());
    std::size_t step = 0;
    const auto keep_least = [&](std::vector<double>& times, double seconds) {
      if (times.size() <= step) times.push_back(seconds * 1e6);
      times[step] = std::min(times[step], seconds * 1e6);
    };
    while (!(*loop)->is_over() && !stop) {
      const double begin = cpu_time();
      if (!(*loop)->advance()) continue;
      keep_least(cpu, cpu_time() - begin);
      keep_least(wall, (*loop)->frame().step_time);
      keep_least(solves, (*loop)->frame().solve_time);
      ++step;
    }
  }
  StepTimes times{.steps = cpu.size()};
  times.cpu_us = spread_of(std::move(cpu));
  times.wall_us = spread_of(std::move(wall));
  times.solve_us = spread_of(std::move(solves));
  return times;
}

}  // namespace

Result<BenchReport> measure(const Request& request, References& references, const std::atomic<bool>& stop) {
  references.described.push_back(std::make_unique<DenseReference>());
  BenchReport report{.machine = this_machine(references)};
  measure_solves(request, references, stop, report);
  for (StepTimes* const times : {&report.with_guard, &report.without_guard}) {
    Result<StepTimes> measured = measure_steps(times == &report.with_guard ? "on" : "off", stop);
    if (!measured) return fail(measured.error());
    *times = std::move(*measured);
  }
  report.machine.load_after = load();
  report.was_interrupted = stop;
  return report;
}

}  // namespace chicane::bench
