// SPDX-License-Identifier: MIT
// Topics of a run as ROS 2 messages: for viewers, recordings and DDS.
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

/// Road as polylines in W [m], for drawing. A closed road repeats its first point. Empty for an unknown road.
struct RoadLines {
  std::vector<Vec2> centre;
  std::vector<Vec2> left;
  std::vector<Vec2> right;
};

/// Samples a track every `spacing` [m] > 0, which is raised for a road that would have more than 20,000
/// points.
[[nodiscard]] RoadLines road_lines(const road::Track& track, double spacing);

/// Names of the frames in messages (docs/reference/viewer_topics.md).
struct FrameNames {
  std::string map = "map";         ///< W
  std::string odom = "odom";       ///< equals `map`
  std::string base = "base_link";  ///< middle of the rear axle
};

/// Description of a run for viewers and logs: what does not change from frame to frame.
struct Run {
  std::string track;
  double track_length = 0.0;  ///< [m], 0 = unknown
  bool is_closed = true;
  std::string controller;
  std::string preset;
  double latency = 0.0;         ///< artificial delay from command to actuation [s]
  double control_period = 0.0;  ///< [s]
  bool is_paused = false;
  model::VehicleParams vehicle;
  std::string mode{};                      ///< "drive": our simulator; "serve": an external one
  std::vector<std::string> cost_terms{};   ///< names, controller::Controller::cost_terms()
  std::vector<std::string> constraints{};  ///< names, controller::Controller::constraints()
  std::vector<std::string> faults{};       ///< names of the bits of Frame::active_faults
  double kerb_width = 0.0;                 ///< [m]
  RoadLines road;
  lap_time::LimitAnswer limit{};
  telemetry::LapSetup lap_setup{};  ///< settings of the lap that is reported next
  std::string building{};  ///< another run that is being built, by its settings: "track = oval"; empty: none
  std::string end{};       ///< "finished", "stopped" or "failed"; empty: it is running
  std::string end_reason{};  ///< reason of the end, one sentence; empty if it finished
  GuardFacts guard{};        ///< guard over the controller
  FrameNames frames{};
  std::vector<std::string> notices{};  ///< notices of the scenario, a sentence each
  Origin origin{};                     ///< origin of car and road
  double track_scale = 1.0;            ///< size of the road over the size in its file
  std::size_t track_points = 0;        ///< points in the road's file
  road::PointFit track_fit{};          ///< fit of the line to these points
};

/// Copies name, cost terms and constraints of a controller into a run.
void describe(const controller::Controller& controller, Run& run);

/// Events at which the content of a topic changes.
enum class Cadence {
  kFrame,  ///< each control cycle
  kRun,    ///< changes of Run, road excepted
  kRoad,   ///< changes of Run::road
  kLimit,  ///< changes of Run::limit
  kLap,    ///< completion of a lap: Frame::completed_lap has another number
  kEvent,  ///< changes of settings; not made from frames (encode is null), see encode_change()
};

/// Stream of messages of a ROS 2 type, encoded as CDR (XCDR1, little endian, with its four-byte header): the
/// same bytes for a viewer, an MCAP log and a DDS topic (docs/reference/viewer_topics.md).
struct RosTopic {
  std::string_view name;  ///< "/odom"
  std::string_view type;  ///< "nav_msgs/msg/Odometry"
  /// Definition of the type, then those of the types in it, in the format "ros2msg" of MCAP and Foxglove.
  std::string schema;
  Cadence cadence = Cadence::kFrame;
  /// Bytes of the message, for any frame, also with not-a-number inside; topics of other cadence than kFrame
  /// and kLap ignore it. Allocates; does not throw except for want of memory.
  std::string (*encode)(const telemetry::Frame& frame, const Run& run) = nullptr;
};

/// All topics, in a fixed order: the index is a stable channel number.
[[nodiscard]] const std::vector<RosTopic>& ros_topics();

/// Message of "/chicane/change": the setting `name` has the value `value` from the control step `cycle` at
/// `time` [s] on.
[[nodiscard]] std::string encode_change(double time, std::uint64_t cycle, std::string_view name,
                                        std::string_view value);

/// Definition of a type ("nav_msgs/msg/Odometry") and of all types in it; empty for an unknown type.
[[nodiscard]] std::string ros_schema(std::string_view type);

/// Definition of a service's request: empty for std_srvs/srv/Trigger, one boolean for std_srvs/srv/SetBool, a
/// text for chicane_msgs/srv/Ask. The response of all has success and a sentence.
[[nodiscard]] std::string_view service_request_schema(std::string_view type);
[[nodiscard]] std::string_view service_response_schema();
/// Boolean of a SetBool request; none for other bytes.
[[nodiscard]] std::optional<bool> decode_set_bool(std::string_view request);
/// Text of an Ask request; none for other bytes.
[[nodiscard]] std::optional<std::string> decode_ask(std::string_view request);
[[nodiscard]] std::string encode_service_response(bool success, std::string_view message);

/// Nanoseconds of a time [s], clamped to the range of a ROS 2 time; 0 for not-a-number.
[[nodiscard]] std::uint64_t to_nanoseconds(double seconds) noexcept;

}  // namespace chicane::protocol
