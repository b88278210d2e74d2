// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>

#include "chicane/run/parallel.hpp"
#include "chicane/sweep/plan_codec.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/sweep/result_table.hpp"
#include "chicane/sweep/sweep.hpp"
#include "chicane/sweep/trial.hpp"
#include "commands.hpp"
#include "many_runs.hpp"

namespace chicane::apps {
namespace {

Result<run::Shard> shard_of(const Options& options) {
  if (!options.sweep.shard.empty()) return run::parse_shard(options.sweep.shard);
  return run::environment_shard([](const char* name) { return std::getenv(name); });
}

std::string output_of(const Options& options) {
  if (!options.output_file.empty()) return options.output_file;
  return std::filesystem::path(options.sweep.plan_file).stem().string() + ".jsonl";
}

ExitCode show(const sweep::Plan& plan, double number) {
  const auto run = static_cast<std::uint64_t>(number);
  if (run >= plan.size())
    return report(Error{ErrorCode::kInvalidArgument,
                        fmt::format("--show: got {}, expected a run from 0 to {}", run, plan.size() - 1)});
  fmt::print("{}\n", sweep::command_of(plan.settings_of(run)));
  if (plan.search)
    fmt::print(stderr, "without {}, which is searched: search_value of its results\n", plan.search->key);
  return kSuccess;
}

}  // namespace

ExitCode drive_sweep(const Options& options) {
  const std::atomic<bool>& stop = begin_many_runs();
  const Result<sweep::Plan> plan = sweep::read_plan(options.sweep.plan_file);
  if (!plan) return report(plan.error());
  if (options.sweep.shown) return show(*plan, *options.sweep.shown);
  const Result<run::Shard> shard = shard_of(options);
  if (!shard) return report(shard.error());
  const std::string file = shard->file_of(output_of(options));
  if (!shard->from.empty())
    fmt::print(stderr, "part {} of {} ({}): {}\n", shard->index + 1, shard->count, shard->from, file);
  RunCounter counter;
  const auto done = sweep::drive_plan(
      *plan, *shard, {.jobs = run::threads_for(options.jobs), .file = file, .on_progress = counter.follow()},
      stop);
  counter.end();
  if (!done) return report(done.error());
  fmt::print(stderr, "{}: {} of {} runs{}\n", file, done->found + done->driven, done->runs,
             done->found > 0 ? fmt::format(", {} of them from before", done->found) : "");
  if (done->failed > 0) fmt::print(stderr, "{} cannot be driven: {}\n", done->failed, done->why);
  if (done->is_complete()) return kSuccess;
  fmt::print(stderr, "stopped: the same command goes on with what is missing\n");
  return kRunFailed;
}

ExitCode merge_results(const Options& options) {
  const auto merged = sweep::merge(options.files, options.output_file);
  if (!merged) return report(merged.error());
  fmt::print(stderr, "{}: {} runs{}\n", options.output_file, merged->runs,
             merged->repeated > 0 ? fmt::format(", {} of them came twice", merged->repeated) : "");
  if (options.csv_file.empty()) return kSuccess;
  const auto written = sweep::write_csv(options.output_file, options.csv_file);
  return written ? kSuccess : report(written.error());
}

}  // namespace chicane::apps
