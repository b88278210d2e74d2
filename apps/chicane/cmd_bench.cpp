// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "bench_report.hpp"
#include "bench_solves.hpp"
#include "chicane/runtime/closed_loop.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "interrupt.hpp"
#include "problems/cpu_time.hpp"

namespace chicane::apps {
namespace {

constexpr int kGrowthHorizons[] = {10, 20, 50, 100, 200};
constexpr int kGrowthInstances = 64;

void measure_solves(const Options& options, const std::atomic<bool>& stop, BenchReport& report) {
  for (const std::string_view family : families()) {
    for (const int horizon : options.horizons) {
      if (stop) return;
      fmt::print(stderr, "{}, N = {}, {} instances\n", family, horizon, options.instances);
      const SolveRow row = time_solves(family, horizon, options.instances, true, stop);
      if (row.instances > 0) report.solves.push_back(row);
    }
  }
}

/// Exponent of the least-squares line through (log N, log time).
double exponent(const std::vector<SolveRow>& rows) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (const SolveRow& row : rows) {
    const double x = std::log(row.horizon);
    const double y = std::log(row.own.time_us.median);
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return n < 2.0 ? std::nan("") : (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void measure_growth(const std::atomic<bool>& stop, BenchReport& report) {
  for (const int horizon : kGrowthHorizons) {
    if (stop) break;
    fmt::print(stderr, "cost against horizon, N = {}\n", horizon);
    const SolveRow row = time_solves("warm", horizon, kGrowthInstances, false, stop);
    if (row.instances == kGrowthInstances) report.growth.push_back(row);
  }
  report.growth_exponent = exponent(report.growth);
}

/// Two laps of what `chicane drive` does by default, in virtual time.
Result<void> measure_steps(const std::atomic<bool>& stop, BenchReport& report) {
  if (stop) return {};
  fmt::print(stderr, "control step of the default controller\n");
  Options driving;
  driving.settings = {{"laps", "2"}};
  const Result<scenario::Scenario> scenario = experiment(driving);
  if (!scenario) return fail(scenario.error());
  const auto loop = runtime::ClosedLoop::create(*scenario);
  if (!loop) return fail(loop.error());
  std::vector<double> cpu;
  std::vector<double> wall;
  std::vector<double> solves;
  while (!(*loop)->is_over() && !stop) {
    const double begin = chicane::bench::cpu_time();
    if (!(*loop)->advance()) continue;
    cpu.push_back((chicane::bench::cpu_time() - begin) * 1e6);
    wall.push_back((*loop)->frame().step_time * 1e6);
    solves.push_back((*loop)->frame().solve_time * 1e6);
  }
  report.steps = cpu.size();
  report.step_cpu_us = spread_of(std::move(cpu));
  report.step_us = spread_of(std::move(wall));
  report.step_solve_us = spread_of(std::move(solves));
  return {};
}

}  // namespace

ExitCode bench(const Options& options) {
  static std::atomic<bool> stop{false};  // as long as signals may come
  catch_interrupts(stop);
  BenchReport result{.machine = this_machine()};
  if (result.machine.ipopt.empty()) {
    fmt::print(stderr, "Built without Ipopt (Debian: coinor-libipopt-dev): only our solver is timed.\n");
  }
  measure_solves(options, stop, result);
  measure_growth(stop, result);
  const Result<void> done = measure_steps(stop, result);
  if (!done) return report(done.error());
  result.machine.load_after = load();
  result.was_interrupted = stop;
  fmt::print("{}", options.is_json ? to_json(result) : to_markdown(result));
  return kSuccess;
}

}  // namespace chicane::apps
