// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>

#include "bench_batches.hpp"
#include "bench_report.hpp"
#include "bench_solves.hpp"
#include "chicane/run/closed_loop.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "interrupt.hpp"
#include "problems/cpu_time.hpp"
#include "problems/dense_reference.hpp"

namespace chicane::apps {
namespace {

constexpr int kGrowthHorizons[] = {10, 20, 50, 100, 200};
constexpr int kGrowthInstances = 64;
constexpr int kDrives = 3;
constexpr int kBatchHorizons[] = {10, 20};
constexpr int kBatchProblems = 192;

void measure_solves(const Options& options, chicane::bench::References& references,
                    const std::atomic<bool>& stop, BenchReport& report) {
  for (const std::string_view family : families()) {
    for (const int horizon : options.horizons) {
      if (stop) return;
      fmt::print(stderr, "{}, N = {}, {} instances\n", family, horizon, options.instances);
      const SolveRow row = time_solves(family, horizon, options.instances, references, stop);
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
  chicane::bench::References none;
  for (const int horizon : kGrowthHorizons) {
    if (stop) break;
    fmt::print(stderr, "cost against horizon, N = {}\n", horizon);
    const SolveRow row = time_solves("warm", horizon, kGrowthInstances, none, stop);
    if (row.instances == kGrowthInstances) report.growth.push_back(row);
  }
  report.growth_exponent = exponent(report.growth);
}

void measure_batches(const std::atomic<bool>& stop, BenchReport& report) {
  for (const std::string_view family : families()) {
    for (const int horizon : kBatchHorizons) {
      if (stop) return;
      fmt::print(stderr, "{}, N = {}, {} problems in lanes\n", family, horizon, kBatchProblems);
      report.batches.push_back(time_batch(family, horizon, kBatchProblems, stop));
    }
  }
}

/// Two laps of what `chicane drive` does by default, in virtual time, and again: every drive takes the same
/// steps, and each counts with the least time it took.
Result<void> measure_steps(const std::atomic<bool>& stop, BenchReport& report) {
  if (stop) return {};
  fmt::print(stderr, "control step of the default controller\n");
  Options driving;
  driving.settings = {{"laps", "2"}};
  const Result<scenario::Scenario> scenario = experiment(driving);
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
      const double begin = chicane::bench::cpu_time();
      if (!(*loop)->advance()) continue;
      keep_least(cpu, chicane::bench::cpu_time() - begin);
      keep_least(wall, (*loop)->frame().step_time);
      keep_least(solves, (*loop)->frame().solve_time);
      ++step;
    }
  }
  report.steps = cpu.size();
  report.step_cpu_us = spread_of(std::move(cpu));
  report.step_us = spread_of(std::move(wall));
  report.step_solve_us = spread_of(std::move(solves));
  return {};
}

/// The program beside this one that holds the other solvers; it never ships. Empty when there is none.
std::string comparing_program() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto other = self.parent_path() / "chicane-bench";
  return !error && std::filesystem::exists(other, error) ? other.string() : std::string();
}

}  // namespace

ExitCode measure(const Options& options, chicane::bench::References& references) {
  static std::atomic<bool> stop{false};  // as long as signals may come
  catch_interrupts(stop);
  references.described.push_back(std::make_unique<chicane::bench::DenseReference>());
  BenchReport result{.machine = this_machine(references)};
  measure_solves(options, references, stop, result);
  measure_growth(stop, result);
  measure_batches(stop, result);
  if (!options.reference_folder.empty()) {
    Result<std::vector<GoldenRow>> golden = solve_golden(options.reference_folder, stop);
    if (!golden) return report(golden.error());
    result.golden = std::move(*golden);
  }
  const Result<void> done = measure_steps(stop, result);
  if (!done) return report(done.error());
  result.machine.load_after = load();
  result.was_interrupted = stop;
  fmt::print("{}", options.is_json ? to_json(result) : to_markdown(result));
  return kSuccess;
}

ExitCode bench(const Options& options) {
  const std::string program = comparing_program();
  if (!program.empty()) {
    std::vector<std::string> words = options.words;
    words.front() = program;
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(program.c_str(), arguments.data());
    fmt::print(stderr, "{} cannot be started: {}\n", program, std::strerror(errno));
  }
  fmt::print(
      stderr,
      "Built without Ipopt (Debian: coinor-libipopt-dev, then build again): only our solver is timed.\n");
  chicane::bench::References none;
  return measure(options, none);
}

}  // namespace chicane::apps
