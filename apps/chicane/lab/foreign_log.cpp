// SPDX-License-Identifier: MIT
#include "lab/foreign_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "chicane/base/math.hpp"
#include "chicane/identify/drive_log.hpp"
#include "chicane/live/description.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/run/account.hpp"
#include "chicane/run/make.hpp"

namespace chicane::apps {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kLeastStep = 0.01;  // denser samples are left out [s]
constexpr double kPause = 2.0;       // without samples: another run [s]

bool is_asked_for(const Options& options, std::string_view key) {
  return std::any_of(options.settings.begin(), options.settings.end(),
                     [&](const auto& setting) { return setting.first == key; });
}

std::string in_words(const identify::DriveLog& log, const road::Track* track, int laps, std::size_t frames) {
  std::string missing;
  if (log.commands.empty()) missing += ", no commands";
  if (!log.commands.empty() && !log.has_throttle()) missing += ", no pedal";
  if (track == nullptr) missing += ", no road (--track)";
  return fmt::format("{}: a log of another program, {:.1f} s, {} samples shown, {} laps{}", log.source,
                     log.samples.back().time - log.samples.front().time, frames, laps, missing);
}

}  // namespace

Result<void> convert_foreign_log(const std::string& file, const Options& options, const std::string& output) {
  const auto log = identify::read_plain_log(file, {.columns = {},
                                                   .odom_topic = options.identify.odom_topic,
                                                   .drive_topic = options.identify.drive_topic,
                                                   .needs_commands = false});
  if (!log) return fail(log.error());
  const Result<scenario::Scenario> scenario =
      protocol::compose({.scenario_file = {}, .settings = options.settings});
  if (!scenario) return fail(scenario.error());
  std::optional<road::Track> track;
  if (is_asked_for(options, "track")) {
    Result<road::Track> made = run::make_track(*scenario);
    if (!made) return fail(made.error());
    track = std::move(*made);
  }
  protocol::Run run;
  run.controller = run.preset = "external";
  run.vehicle = scenario->vehicle;
  run.mode = recording::kSimulateMode;
  if (track) live::describe(*track, run);
  auto recorder =
      recording::Recorder::create({.path = output, .run = run, .scenario = *scenario, .may_wait = true});
  if (!recorder) return fail(recorder.error());

  run::Roadside roadside(track ? &*track : nullptr, *scenario);
  // Odometry is of the rear axle, measurements of the centre of mass.
  const double ahead = log->is_centre_of_mass ? 0.0 : scenario->vehicle.rear_axle;
  const double begin = log->samples.front().time;
  auto commands = log->commands.begin();
  telemetry::Frame frame;
  std::size_t frames = 0;
  int laps = 0;
  double last = -1e9;
  for (const identify::Sample& sample : log->samples) {
    const double time = sample.time - begin;
    if (time - last < kLeastStep) continue;
    if (frames > 0 && time - last > kPause) roadside.resume();
    last = time;
    while (commands != log->commands.end() && commands + 1 != log->commands.end() &&
           (commands + 1)->time <= sample.time)
      ++commands;
    const bool has_command = commands != log->commands.end() && commands->time <= sample.time;
    frame = {};
    frame.cycle = frames++;
    frame.time = time;
    frame.measurement.time = time;
    frame.measurement.x = sample.x + ahead * cos(sample.psi);
    frame.measurement.y = sample.y + ahead * sin(sample.psi);
    frame.measurement.psi = sample.psi;
    frame.measurement.speed = std::fabs(sample.speed);
    frame.measurement.steer = has_command ? commands->steer : kNaN;
    frame.measurement.throttle = has_command ? commands->throttle : kNaN;
    frame.result.command = {.steer = frame.measurement.steer, .throttle = frame.measurement.throttle};
    frame.asked = frame.applied = frame.result.command;
    roadside.judge(frame);
    (*recorder)->record(frame);
    if (const auto lap = roadside.take_lap()) {
      (*recorder)->record(*lap);
      ++laps;
    }
  }
  if (const auto done = (*recorder)->finish(); !done) return fail(done.error());
  fmt::print(stderr, "{}\n", in_words(*log, track ? &*track : nullptr, laps, frames));
  return {};
}

}  // namespace chicane::apps
