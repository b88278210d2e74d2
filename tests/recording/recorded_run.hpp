// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/recording/recorder.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane::recording {

/// Drives laps of a track and records them in `path`, as the program does; the frames that were recorded.
inline std::vector<telemetry::Frame> record_run(const std::string& path, const std::string& track,
                                                const std::string& laps) {
  const auto loop = test::loop_of(test::scenario_of({{"track", track}, {"laps", laps}}));
  RecorderOptions options{.path = path, .run = {}, .scenario = loop->scenario(), .may_wait = true};
  options.run.track = track;
  options.run.track_length = loop->track().length();
  options.run.vehicle = loop->scenario().vehicle;
  options.run.road = protocol::road_lines(loop->track(), 2.0);
  const auto recorder = test::good(Recorder::create(options));
  std::vector<telemetry::Frame> frames;
  static_cast<void>(run::run_closed_loop(
      *loop, {.on_frame =
                  [&](const telemetry::Frame& frame) {
                    frames.push_back(frame);
                    (*recorder)->record(frame);
                  },
              .on_lap = [&](const telemetry::CompletedLap& lap) { (*recorder)->record(lap); }}));
  EXPECT_TRUE((*recorder)->finish());
  return frames;
}

}  // namespace chicane::recording
