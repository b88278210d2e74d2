// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <optional>

#include "chicane/recording/driven_lap.hpp"
#include "chicane/recording/lap_picture.hpp"
#include "chicane/recording/video_encoder.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "many_runs.hpp"

namespace chicane::apps {
namespace {

using recording::DrivenMoment;
using recording::DrivenRun;

/// The moments of the lap that was asked for: -1 means the last whole one, or all where there is none.
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

/// The number of pictures; nothing when it was stopped.
Result<std::optional<std::uint64_t>> film(const Options& options) {
  static std::atomic<bool> stop{false};  // as long as signals may come
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

}  // namespace chicane::apps
