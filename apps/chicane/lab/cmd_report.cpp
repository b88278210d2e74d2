// SPDX-License-Identifier: MIT
// `chicane report`, which makes a page of recordings or of the results of a sweep; `chicane video`, which
// makes a film; and the conversion of logs of other programs to recordings, for both and for `chicane
// replay`.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/identify/drive_log.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/recording/html_report.hpp"
#include "chicane/recording/lap_picture.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/recording/video_encoder.hpp"
#include "chicane/run/account.hpp"
#include "chicane/sweep/result_table.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "lab/many_runs.hpp"
#include "program.hpp"
#include "progress.hpp"

namespace chicane::apps {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// [s] between frames, closer samples are left out: 100 Hz are enough to look at.
constexpr double kMinStep = 0.01;
constexpr double kMaxGap = 2.0;  // [s] a lap with a longer gap between samples does not count; chosen

/// Commands of a log in the order of time.
class SentCommands {
 public:
  explicit SentCommands(const std::vector<identify::SentCommand>& commands)
      : next_{commands.begin()}, end_{commands.end()} {}
  /// Last command sent up to `time` [s]; NaN before the first one. Pre: times never decrease.
  [[nodiscard]] model::Command at(double time) {
    for (; next_ != end_ && next_->time <= time; ++next_)
      acting_ = {.steer = next_->steer, .throttle = next_->throttle};
    return acting_;
  }

 private:
  std::vector<identify::SentCommand>::const_iterator next_, end_;
  model::Command acting_{.steer = kNaN, .throttle = kNaN};
};

/// Frame with a sample as the measurement of the centre of mass, which is `ahead` [m] of the log's reference
/// point.
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

/// Recorder of a converted log.
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

/// Sentence about a converted log.
std::string summary_of(const identify::DriveLog& log, const road::Track* track, int laps,
                       std::size_t frames) {
  std::string missing;
  if (log.commands.empty()) missing += ", no commands";
  if (!log.commands.empty() && !log.has_throttle()) missing += ", no pedal";
  if (track == nullptr) missing += ", no road (--track)";
  return fmt::format("{}: a log of another program, {:.1f} s, {} samples shown, {} laps{}", log.source,
                     log.samples.back().time - log.samples.front().time, frames, laps, missing);
}

/// Converts a log of another program to the recording `output`: each sample becomes a frame. --track gives
/// the road for laps and progress; without it a lap ends where the car has been before. Values that the log
/// lacks are NaN. Prints a summary on stderr. kParse for a file that is neither a ROS 2 bag with odometry nor
/// a CSV table of a car.
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
  // Odometry: of the rear axle.
  const double ahead = log->is_centre_of_mass ? 0.0 : scenario->vehicle.rear_axle;
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

/// Whether all files are results of a sweep, lines of JSON; recordings are MCAP files.
bool are_results(const std::vector<std::string>& files) {
  return std::all_of(files.begin(), files.end(), [](const std::string& file) {
    return std::filesystem::path(file).extension() == ".jsonl";
  });
}

/// Runs `chicane report --compare`: prints runs that differ in one setting beside each other.
ExitCode report_comparison(const Options& options) {
  const std::size_t equals = options.comparison.find('=');
  if (equals == std::string::npos || !are_results(options.log_files))
    return report(Error{ErrorCode::kInvalidArgument,
                        fmt::format("--compare: got {}, expected KEY=VALUE and results of a sweep",
                                    printable(options.comparison))});
  const auto compared = sweep::compare(options.log_files, options.comparison.substr(0, equals),
                                       options.comparison.substr(equals + 1));
  if (!compared) return report(compared.error());
  fmt::print("{}", compared->table.markdown());
  fmt::print(stderr, "{} of {} are worse than with {}; {} have no run to compare with\n", compared->worse,
             compared->pairs, options.comparison, compared->missing);
  return compared->worse == 0 ? kSuccess : kRunFailed;
}

/// Writes maps and summary of a sweep.
ExitCode report_sweep(const Options& options) {
  if (!options.maps_page.empty()) {
    const auto maps = sweep::write_maps(options.log_files, options.maps_page);
    if (!maps) return report(maps.error());
    fmt::print(stderr, "{}: maps of {} runs\n", options.maps_page, *maps);
    if (options.output_file.empty()) return kSuccess;
  }
  const auto summary = sweep::summary_document(options.log_files);
  if (!summary) return report(summary.error());
  const auto bytes = recording::write_document(options.output_file, summary->text, live::document_bundle());
  if (!bytes) return report(bytes.error());
  fmt::print("{}: {} runs, {:.1f} MB; open it in a browser\n", options.output_file, summary->runs,
             1e-6 * static_cast<double>(*bytes));
  return kSuccess;
}

using recording::DrivenMoment;
using recording::DrivenRun;

/// Moments of a recording for the film: those of the lap, from --from-s on, for --for-s.
Result<std::vector<DrivenMoment>> chosen(const DrivenRun& run, const Options::Video& video,
                                         const std::string& file) {
  const int lap = video.lap < 0 ? run.last_lap : video.lap;
  std::vector<DrivenMoment> moments = run.of_lap(lap);
  if (moments.size() < 2)
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("--lap: got {}, expected a lap of {}, from 1 to {}, or 0 for all", lap, file,
                            run.moments.back().lap + 1));
  const double begin = moments.front().time + video.from;
  std::erase_if(moments, [&](const DrivenMoment& moment) {
    return moment.time < begin || (video.length > 0.0 && moment.time > begin + video.length);
  });
  if (moments.size() >= 2) return moments;
  return fail(ErrorCode::kInvalidArgument, "--from-s: got a moment behind the end of what is shown");
}

/// Makes the film. Returns the number of pictures; empty if it was stopped.
Result<std::optional<std::uint64_t>> film(const Options& options) {
  static std::atomic<bool> stop{false};  // static: must outlive the last signal
  catch_interrupts(stop);
  const Options::Video& video = options.video;
  recording::PictureOptions picture{
      .width = video.width, .height = video.width * 9 / 16 / 2 * 2, .shows_whole = video.is_whole};
  if (const auto named = recording::check_video_name(options.output_file); !named) return fail(named.error());
  const auto run = recording::read_run(options.log_files.front());
  if (!run) return fail(run.error());
  const auto shown = chosen(*run, video, options.log_files.front());
  if (!shown) return fail(shown.error());
  std::vector<DrivenMoment> ghost;
  if (!video.ghost.empty()) {
    const auto other = recording::read_run(video.ghost);
    if (!other) return fail(other.error());
    const auto moments = chosen(*other, video, video.ghost);
    if (!moments) return fail(moments.error());
    ghost = *moments;
  }
  recording::LapPicture drawing(*run, *shown, ghost, picture);
  auto encoder = recording::VideoEncoder::start({.output = options.output_file,
                                                 .width = picture.width,
                                                 .height = picture.height,
                                                 .rate = video.rate,
                                                 .quality = video.quality});
  if (!encoder) return fail(encoder.error());
  const double step = video.speed / video.rate;
  const auto pictures = static_cast<std::uint64_t>(std::floor(drawing.duration() / step)) + 1;
  RunCounter counter("pictures");
  for (std::uint64_t i = 0; i < pictures; ++i) {
    if (stop) return std::optional<std::uint64_t>{};
    if (const auto added = encoder->add(drawing.at(static_cast<double>(i) * step).bytes()); !added)
      return fail(added.error());
    counter.show(i + 1, pictures, i + 1);
  }
  counter.end();
  const auto finished = encoder->finish();
  return finished ? Result<std::optional<std::uint64_t>>(pictures) : fail(finished.error());
}

}  // namespace

ExitCode report_logs(const Options& options) {
  if (!options.comparison.empty()) return report_comparison(options);
  if (options.output_file.empty() && options.maps_page.empty())
    return report(Error{ErrorCode::kInvalidArgument,
                        "report: got none of --output, --page and --compare, expected one"});
  const Result<void> named = check_page_name("--output", options.output_file);
  if (are_results(options.log_files)) return named ? report_sweep(options) : report(named.error());
  if (!options.maps_page.empty())
    return report(Error{ErrorCode::kInvalidArgument, "--page: got recordings, expected results of a sweep"});
  recording::ReportOptions reporting{
      .output = options.output_file, .logs = {}, .bundle = live::document_bundle()};
  std::list<recording::TemporaryFile> copies;
  for (const std::string& file : options.log_files) {
    std::error_code error;  // ignored: the file may not exist
    if (std::filesystem::equivalent(file, options.output_file, error)) {
      return report(Error{ErrorCode::kInvalidArgument,
                          fmt::format("--output: got {}, expected another file than a recording that is read",
                                      options.output_file)});
    }
    std::string read = file;
    if (named && recording::is_foreign_log(file)) {
      copies.emplace_back(".mcap");
      read = copies.back().path();
      if (const Result<void> made = convert_foreign_log(file, options, read); !made)
        return report(made.error());
    }
    reporting.logs.push_back({std::filesystem::path(file).filename().string(), read});
  }
  if (!named) return report(named.error());
  const Result<recording::ReportSummary> written = recording::write_report(reporting);
  if (!written) return report(written.error());
  fmt::print("{}: {:.1f} MB, {:g} control steps a second; open it in a browser\n", options.output_file,
             1e-6 * static_cast<double>(written->bytes), written->rate);
  return kSuccess;
}

ExitCode make_video(const Options& options) {
  const auto done = film(options);
  if (!done) {
    const ExitCode code = report(done.error());
    return done.error().message.starts_with("ffmpeg") ? kEnvironment : code;
  }
  if (!*done) {
    fmt::print(stderr, "stopped: nothing was written\n");
    return kRunFailed;
  }
  fmt::print("{}: {} pictures\n", options.output_file, **done);
  return kSuccess;
}

ExitCode replay_any_logs(const Options& options) { return replay_logs(options, convert_foreign_log); }

}  // namespace chicane::apps
