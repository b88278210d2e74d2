// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>

#include "chicane/base/file.hpp"
#include "chicane/run/make.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "guard_notice.hpp"
#include "interrupt.hpp"
#include "limit_report.hpp"

namespace chicane::apps {
namespace {

Result<void> print_limit(const Options& options) {
  static std::atomic<bool> wants_stop{false};  // static: must outlive the last signal
  catch_interrupts(wants_stop);
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  const Result<road::Track> track = run::make_track(*scenario);
  if (!track) return fail(track.error());
  print_notices(*scenario);
  if (!options.csv_file.empty()) {
    if (Result<void> writable = check_writable(options.csv_file); !writable) return writable;
  }
  LimitRun limit_run{.track = track->name(), .car = scenario->car};
  const Result<lap_time::PlantLimit> limit =
      limit_of(*scenario, *track, {.budget = options.limit_budget}, wants_stop, limit_run.wall_time);
  if (!limit) return fail(limit.error());
  if (!options.csv_file.empty()) {
    if (Result<void> kept = write_file(options.csv_file, to_csv(limit_run, *track, *limit)); !kept)
      return kept;
  }
  fmt::print("{}", options.is_json ? to_json(limit_run, *limit) : to_table(limit_run, *limit));
  return {};
}

}  // namespace

ExitCode limit(const Options& options) {
  const Result<void> done = print_limit(options);
  return done ? kSuccess : report(done.error());
}

}  // namespace chicane::apps
