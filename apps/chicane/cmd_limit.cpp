// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>

#include "chicane/run/make.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "guard_notice.hpp"
#include "interrupt.hpp"
#include "limit_of.hpp"
#include "limit_report.hpp"
#include "many_runs.hpp"

namespace chicane::apps {
namespace {

Result<void> print_limit(const Options& options) {
  static std::atomic<bool> wants_stop{false};  // static: must outlive the last signal
  catch_interrupts(wants_stop);
  const Result<scenario::Scenario> scenario = experiment(options);
  if (!scenario) return fail(scenario.error());
  const Result<path::Track> track = run::make_track(*scenario);
  if (!track) return fail(track.error());
  print_notices(*scenario);
  if (!options.csv_file.empty()) {
    if (Result<void> writable = check_writable(options.csv_file); !writable) return writable;
  }
  LimitRun told{.track = track->name(), .car = scenario->car};
  const auto tell = [&](const auto& limit) -> Result<void> {
    if (!options.csv_file.empty()) {
      if (Result<void> kept = write_file(options.csv_file, to_csv(told, *track, limit)); !kept) return kept;
    }
    fmt::print("{}", options.is_json ? to_json(told, limit) : to_table(told, limit));
    return {};
  };
  if (options.is_quick || options.spacing) {
    const auto limit = limit_of(*scenario, *track, options.spacing, wants_stop, told.wall_time);
    return limit ? tell(**limit) : fail(limit.error());
  }
  const auto limit = plant_limit_of(*scenario, *track, options.limit_budget, wants_stop, told.wall_time);
  return limit ? tell(*limit) : fail(limit.error());
}

}  // namespace

ExitCode limit(const Options& options) {
  const Result<void> done = print_limit(options);
  return done ? kSuccess : report(done.error());
}

}  // namespace chicane::apps
