// SPDX-License-Identifier: MIT
// The five presets from standstill, 1.5 m beside the line: where they steer, and whether they come back.
#include <unistd.h>

#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"
#include "support/folder.hpp"
#include "support/runs.hpp"

namespace chicane::run {
namespace {

namespace fs = std::filesystem;

struct Start {
  double first_steer = 0.0;  ///< left positive [rad]
  double begin = 0.0;        ///< lateral error, left positive [m]
  double end = 0.0;          ///< [m]
};

/// `lakeside` with the car `offset` to the left of its line, for `seconds`.
Start drive_from(const std::string& preset, double offset, const std::string& seconds = "8") {
  std::string track = test::content_of(CHICANE_SOURCE_DIR "/data/tracks/lakeside.csv");
  const std::string shipped = "start_d_m=-0.76";
  const std::size_t at = track.find(shipped);
  EXPECT_NE(at, std::string::npos);
  track.replace(at, shipped.size(), "start_d_m=" + std::to_string(offset));
  const test::Folder folder;
  const auto loop = test::loop_of(test::scenario_of({{"preset", preset},
                                                     {"track", folder.write("track.csv", track)},
                                                     {"guard.mode", "off"},
                                                     {"laps", "0"},
                                                     {"time_limit_s", seconds}}));
  Start start;
  bool is_first = true;
  static_cast<void>(run_closed_loop(*loop, {.on_frame = [&](const telemetry::Frame& frame) {
    if (is_first) start = {.first_steer = frame.result.command.steer, .begin = frame.lateral_error};
    is_first = false;
    start.end = frame.lateral_error;
  }}));
  return start;
}

TEST(Standstill, MeasuredLatencyAndWeightedSteerTowardsTheLineFromBothSides) {
  for (const char* preset : {"measured-latency", "weighted"}) {
    const Start left = drive_from(preset, 1.5), right = drive_from(preset, -1.5);
    EXPECT_NEAR(left.begin, 1.5, 0.01);
    EXPECT_LT(left.first_steer, -0.01) << preset << ": left of the line, it steers to the right";
    EXPECT_GT(right.first_steer, 0.01) << preset << ": right of it, to the left";
    // The road bends to the left there, which adds to both.
    EXPECT_GT(left.first_steer + right.first_steer, 0.0) << preset;
  }
}

TEST(Standstill, AllFiveComeBackToTheLine) {
  for (const char* preset : {"measured-latency", "fast-short-step", "weighted", "delay-in-model"})
    for (const double side : {1.5, -1.5})
      EXPECT_LT(std::fabs(drive_from(preset, side).end), 0.6) << preset << " from " << side << " m";
  for (const double side : {1.5, -1.5})  // which steers slowly
    EXPECT_LT(std::fabs(drive_from("sixty-mph", side, "20").end), 0.6) << "sixty-mph from " << side << " m";
}

}  // namespace
}  // namespace chicane::run
