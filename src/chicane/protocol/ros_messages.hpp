// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/vec2.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/protocol/origin.hpp"
#include "chicane/road/track.hpp"
#include "chicane/telemetry/frame.hpp"
#include "chicane/telemetry/metrics.hpp"

namespace chicane::protocol {

/// The road as polylines in W [m], for drawing. A closed road repeats its first point. Empty where the road
/// is not known.
struct RoadLines {
  std::vector<Vec2> centre;
  std::vector<Vec2> left;
  std::vector<Vec2> right;
};

/// Samples a track every `spacing` [m]; spacing > 0, raised where a line would get more than 20,000 points.
[[nodiscard]] RoadLines road_lines(const road::Track& track, double spacing);

/// Names of the frames in messages (docs/reference/viewer_topics.md).
struct FrameNames {
  std::string map = "map";         ///< W
  std::string odom = "odom";       ///< equals it
  std::string base = "base_link";  ///< middle of the rear axle
};

/// Description of a run: everything viewers and logs need that stays the same from frame to frame.
struct Run {
  std::string track;
  double track_length = 0.0;  ///< [m], 0 = unknown
  bool is_closed = true;
  std::string controller;
  std::string preset;
  double latency = 0.0;         ///< artificial, from command to actuation [s]
  double control_period = 0.0;  ///< [s]
  bool is_paused = false;
  model::VehicleParams vehicle;
  std::string mode{};                     ///< "drive": our simulator; "serve": an external one
  std::vector<std::string> cost_terms{};  ///< names, controller::Controller::cost_terms()
  std::vector<std::string> constraints{};
  std::vector<std::string> faults{};  ///< names of the bits of Frame::active_faults
  double kerb_width = 0.0;            ///< [m]
  RoadLines road;
  lap_time::LimitAnswer limit{};
  telemetry::LapSetup lap_setup{};  ///< setup of the lap that is reported next
  std::string building{};    ///< another run that is being built, in words: "track = oval"; empty: none
  std::string end{};         ///< "finished", "stopped" or "failed"; empty: it is running
  std::string end_reason{};  ///< reason of the end, one sentence; empty if it finished
  GuardFacts guard{};        ///< guard over the controller
  FrameNames frames{};
  std::vector<std::string> notices{};  ///< notices of the scenario, a sentence each
  Origin origin{};                     ///< origin of car and road
  double track_scale = 1.0;            ///< size of the road over the size in its file
  std::size_t track_points = 0;        ///< points in the road's file
  road::PointFit track_fit{};          ///< fit of the line to these points
};

/// Copies a controller's description of itself into a run.
void describe(const controller::Controller& controller, Run& run);

/// Time at which the content of a topic changes.
enum class Cadence {
  kFrame,  ///< each control cycle
  kRun,    ///< changes of Run, road excepted
  kRoad,   ///< changes of Run::road
  kLimit,  ///< changes of Run::limit
  kLap,    ///< completion of a lap: Frame::completed_lap has another number
  kEvent,  ///< an event that no frame has; encode is null, see encode_change()
};

/// One stream of messages of a ROS 2 type, encoded as CDR (XCDR1, little endian, with its four-byte header):
/// the same bytes for a viewer, an MCAP log and a DDS topic. Frames: `map` is W, `odom` equals it,
/// `base_link` is the middle of the rear axle (docs/reference/viewer_topics.md).
struct RosTopic {
  std::string_view name;  ///< "/odom"
  std::string_view type;  ///< "nav_msgs/msg/Odometry"
  std::string
      schema;  ///< definition followed by those it refers to, as MCAP and Foxglove's "ros2msg" want it
  Cadence cadence = Cadence::kFrame;
  /// Any frame, also with not-a-number inside; topics of other cadence ignore it. Allocates; does not throw
  /// (but for memory).
  std::string (*encode)(const telemetry::Frame& frame, const Run& run) = nullptr;
};

/// All topics, in a fixed order: the index is a stable channel number.
[[nodiscard]] const std::vector<RosTopic>& ros_topics();

/// A message for "/chicane/change", of the topic's type: `name` got `value` before the control step `cycle`
/// at `time` [s].
[[nodiscard]] std::string encode_change(double time, std::uint64_t cycle, std::string_view name,
                                        std::string_view value);

/// The definition of a type ("nav_msgs/msg/Odometry") with all it refers to; empty for a type not known.
[[nodiscard]] std::string ros_schema(std::string_view type);

/// Services: std_srvs/srv/Trigger asks nothing, std_srvs/srv/SetBool one boolean, chicane_msgs/srv/Ask a
/// text; all answer with success and a sentence.
[[nodiscard]] std::string_view service_request_schema(std::string_view type);
[[nodiscard]] std::string_view service_response_schema();
/// The boolean of a SetBool request; none when the bytes are not one.
[[nodiscard]] std::optional<bool> decode_set_bool(std::string_view request);
/// The text of an Ask request; none when the bytes are not one.
[[nodiscard]] std::optional<std::string> decode_ask(std::string_view request);
[[nodiscard]] std::string encode_service_response(bool success, std::string_view message);

/// Seconds of the run as nanoseconds, clamped to the range of a ROS 2 time; not-a-number gives 0.
[[nodiscard]] std::uint64_t to_nanoseconds(double seconds) noexcept;

}  // namespace chicane::protocol
