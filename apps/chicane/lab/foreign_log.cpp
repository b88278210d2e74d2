// SPDX-License-Identifier: MIT
// Converts the log of another program to a recording of ours: each sample becomes a frame.
#include "lab/foreign_log.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/identify/drive_log.hpp"
#include "chicane/live/description.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/run/account.hpp"
#include "experiment.hpp"

namespace chicane::apps {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kMinStep = 0.01;  // [s] closer samples are left out: 100 Hz are enough to look at
constexpr double kMaxGap = 2.0;    // [s] a longer gap between samples ends a stint: its lap does not count

/// Commands of a log, asked for with times that only grow.
class SentCommands {
 public:
  explicit SentCommands(const std::vector<identify::SentCommand>& commands)
      : next_{commands.begin()}, end_{commands.end()} {}
  /// The last command sent up to `time` [s]; NaN before the first one.
  [[nodiscard]] model::Command at(double time) {
    for (; next_ != end_ && next_->time <= time; ++next_)
      acting_ = {.steer = next_->steer, .throttle = next_->throttle};
    return acting_;
  }

 private:
  std::vector<identify::SentCommand>::const_iterator next_, end_;
  model::Command acting_{.steer = kNaN, .throttle = kNaN};
};

/// A sample as a measurement of the centre of mass, which is `ahead` [m] of the log's reference point.
telemetry::Frame frame_of(const identify::Sample& sample, double ahead, const model::Command& command) {
  telemetry::Frame frame{};
  frame.measurement.x = sample.x + ahead * cos(sample.psi);
  frame.measurement.y = sample.y + ahead * sin(sample.psi);
  frame.measurement.psi = sample.psi;
  frame.measurement.speed = std::fabs(sample.speed);
  frame.measurement.steer = command.steer;
  frame.measurement.throttle = command.throttle;
  frame.result.command = frame.asked = frame.applied = command;
  return frame;
}

Result<std::unique_ptr<recording::Recorder>> recorder_for(const std::string& output,
                                                          const scenario::Scenario& scenario,
                                                          const road::Track* track) {
  protocol::Run run;
  run.controller = run.preset = "external";
  run.vehicle = scenario.vehicle;
  run.mode = recording::kSimulateMode;
  if (track != nullptr) live::describe(*track, run);
  return recording::Recorder::create({.path = output, .run = run, .scenario = scenario, .may_wait = true});
}

std::string summary_of(const identify::DriveLog& log, const road::Track* track, int laps,
                       std::size_t frames) {
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
  const Result<std::optional<road::Track>> given = given_track(options, *scenario);
  if (!given) return fail(given.error());
  const road::Track* const track = *given ? &**given : nullptr;
  const auto recorder = recorder_for(output, *scenario, track);
  if (!recorder) return fail(recorder.error());

  run::Roadside roadside(track, *scenario);
  SentCommands commands(log->commands);
  const double ahead = log->is_centre_of_mass ? 0.0 : scenario->vehicle.rear_axle;  // odometry: the rear axle
  std::size_t frames = 0;
  int laps = 0;
  double last = 0.0;
  for (const identify::Sample& sample : log->samples) {
    const double time = sample.time - log->samples.front().time;
    if (frames > 0 && time - last < kMinStep) continue;
    if (time - last > kMaxGap) roadside.resume();
    last = time;
    telemetry::Frame frame = frame_of(sample, ahead, commands.at(sample.time));
    frame.cycle = frames++;
    frame.time = frame.measurement.time = time;
    roadside.judge(frame);
    (*recorder)->record(frame);
    if (const auto lap = roadside.take_lap()) {
      (*recorder)->record(*lap);
      ++laps;
    }
  }
  if (const auto done = (*recorder)->finish(); !done) return fail(done.error());
  fmt::print(stderr, "{}\n", summary_of(*log, track, laps, frames));
  return {};
}

}  // namespace chicane::apps
