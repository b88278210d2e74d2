// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"

namespace chicane::recording {

/// One control step of a recording, as a picture needs it.
struct DrivenMoment {
  double time = 0.0;           ///< of the run [s]
  Vec2 position{};             ///< of the centre of mass in W [m]
  double heading = 0.0;        ///< [rad]
  double speed = 0.0;          ///< [m/s]
  double steer = 0.0;          ///< of the road wheels, sent [rad], left positive
  double throttle = 0.0;       ///< sent, [-1, 1]
  int lap = 0;                 ///< laps completed
  double lap_time = 0.0;       ///< of the running lap [s]
  double s = 0.0;              ///< along the track's line [m]; not-a-number where no track is known
  double edge_distance = 0.0;  ///< of the outermost tyre [m]; not-a-number where no track is known
  bool is_off_track = false;
  std::vector<Vec2> plan{};          ///< predicted positions in W [m]
  std::vector<double> plan_speed{};  ///< [m/s]
};

/// A recorded run, and its road.
struct DrivenRun {
  std::string track{}, controller{}, preset{};
  double track_length = 0.0;  ///< [m], 0: unknown
  bool is_closed = true;
  double front = 2.0, rear = 2.0, width = 1.9;  ///< of the body from the centre of mass, and across [m]
  double steer_limit = 0.4;                     ///< [rad]
  std::vector<Vec2> left{}, right{};            ///< edges of the road in W [m]
  std::vector<DrivenMoment> moments{};
  int last_lap = 0;  ///< number of the last one that was driven to its end; 0: none was

  /// Moments of lap number `lap`, counted from 1; 0: all. Empty when there are none.
  [[nodiscard]] std::vector<DrivenMoment> of_lap(int lap) const;
};

/// Reads the last run of a recording of `drive`, `simulate` or `serve`. kParse for what is no recording of
/// ours, or has no control step; otherwise fails as telemetry::read_mcap() does.
[[nodiscard]] Result<DrivenRun> read_run(const std::string& recording);

}  // namespace chicane::recording
