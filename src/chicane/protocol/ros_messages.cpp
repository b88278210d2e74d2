// SPDX-License-Identifier: MIT
// Topics of a run in ROS 2's standard types, definitions of all types, services, and values of parameters.
#include "chicane/protocol/ros_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <variant>

#include "chicane/base/math.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/protocol/detail/cdr_archive.hpp"
#include "chicane/protocol/detail/own_messages.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::protocol {
namespace {

/// Definition of one message type in ROS 2's .msg language, without those of the types in it.
struct RosDefinition {
  std::string_view name;  ///< "nav_msgs/Odometry"
  std::string_view text;
};

/// Fields of the standard types as in ROS 2 Jazzy (common_interfaces 5.3, rcl_interfaces 2.0, geometry2 0.36,
/// ackermann_msgs 2.0, autoware_msgs 1.2), comments shortened; web/src/protocol/schemas.test.ts compares them
/// with
/// @foxglove/rosmsg-msgs-common. Those of chicane_msgs follow from their rows (own_messages.hpp).
constexpr std::array kRosDefinitions{
    RosDefinition{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    RosDefinition{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    RosDefinition{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    RosDefinition{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    RosDefinition{"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    RosDefinition{"geometry_msgs/Pose",
                  "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    RosDefinition{"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    RosDefinition{"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    RosDefinition{"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    RosDefinition{"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    RosDefinition{"geometry_msgs/Transform",
                  "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    RosDefinition{"geometry_msgs/TransformStamped",
                  "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    RosDefinition{"nav_msgs/Odometry",
                  "# Pose in header.frame_id, twist in child_frame_id.\n"
                  "std_msgs/Header header\nstring child_frame_id\n"
                  "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n"},
    RosDefinition{"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    RosDefinition{"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    RosDefinition{"diagnostic_msgs/KeyValue", "string key\nstring value\n"},
    RosDefinition{"diagnostic_msgs/DiagnosticStatus",
                  "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\n"
                  "byte level\nstring name\nstring message\nstring hardware_id\n"
                  "diagnostic_msgs/KeyValue[] values\n"},
    RosDefinition{"diagnostic_msgs/DiagnosticArray",
                  "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n"},
    RosDefinition{"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
    RosDefinition{"ackermann_msgs/AckermannDrive",
                  "float32 steering_angle\nfloat32 steering_angle_velocity\nfloat32 speed\n"
                  "float32 acceleration\nfloat32 jerk\n"},
    RosDefinition{"ackermann_msgs/AckermannDriveStamped",
                  "std_msgs/Header header\nackermann_msgs/AckermannDrive drive\n"},
    RosDefinition{"geometry_msgs/PoseWithCovarianceStamped",
                  "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
    RosDefinition{"sensor_msgs/Imu",
                  "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
                  "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
                  "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
                  "float64[9] linear_acceleration_covariance\n"},
    RosDefinition{"sensor_msgs/LaserScan",
                  "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\n"
                  "float32 angle_increment\nfloat32 time_increment\nfloat32 scan_time\n"
                  "float32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n"},
    RosDefinition{"std_msgs/Bool", "bool data\n"},
    RosDefinition{"autoware_control_msgs/Lateral",
                  "builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\n"
                  "float32 steering_tire_angle\nfloat32 steering_tire_rotation_rate\n"
                  "bool is_defined_steering_tire_rotation_rate\n"},
    RosDefinition{"autoware_control_msgs/Longitudinal",
                  "builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\n"
                  "float32 velocity\nfloat32 acceleration\nfloat32 jerk\n"
                  "bool is_defined_acceleration\nbool is_defined_jerk\n"},
    RosDefinition{"autoware_control_msgs/Control",
                  "builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\n"
                  "autoware_control_msgs/Lateral lateral\n"
                  "autoware_control_msgs/Longitudinal longitudinal\n"},
    RosDefinition{"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    RosDefinition{"foxglove_msgs/Color", "float64 r\nfloat64 g\nfloat64 b\nfloat64 a\n"},
    RosDefinition{"foxglove_msgs/KeyValuePair", "string key\nstring value\n"},
    RosDefinition{"foxglove_msgs/ArrowPrimitive",
                  "geometry_msgs/Pose pose\nfloat64 shaft_length\nfloat64 shaft_diameter\n"
                  "float64 head_length\nfloat64 head_diameter\nfoxglove_msgs/Color color\n"},
    RosDefinition{"foxglove_msgs/CubePrimitive",
                  "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfoxglove_msgs/Color color\n"},
    RosDefinition{"foxglove_msgs/SpherePrimitive",
                  "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfoxglove_msgs/Color color\n"},
    RosDefinition{"foxglove_msgs/CylinderPrimitive",
                  "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 size\nfloat64 bottom_scale\n"
                  "float64 top_scale\nfoxglove_msgs/Color color\n"},
    RosDefinition{"foxglove_msgs/LinePrimitive",
                  "uint8 LINE_STRIP=0\nuint8 LINE_LOOP=1\nuint8 LINE_LIST=2\nuint8 type\n"
                  "geometry_msgs/Pose pose\nfloat64 thickness\nbool scale_invariant\n"
                  "geometry_msgs/Point[] points\nfoxglove_msgs/Color color\n"
                  "foxglove_msgs/Color[] colors\nuint32[] indices\n"},
    RosDefinition{"foxglove_msgs/TriangleListPrimitive",
                  "geometry_msgs/Pose pose\ngeometry_msgs/Point[] points\nfoxglove_msgs/Color color\n"
                  "foxglove_msgs/Color[] colors\nuint32[] indices\n"},
    RosDefinition{"foxglove_msgs/TextPrimitive",
                  "geometry_msgs/Pose pose\nbool billboard\nfloat64 font_size\nbool scale_invariant\n"
                  "foxglove_msgs/Color color\nstring text\n"},
    RosDefinition{"foxglove_msgs/ModelPrimitive",
                  "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nfoxglove_msgs/Color color\n"
                  "bool override_color\nstring url\nstring media_type\nuint8[] data\n"},
    RosDefinition{"foxglove_msgs/SceneEntityDeletion",
                  "uint8 MATCHING_ID=0\nuint8 ALL=1\nbuiltin_interfaces/Time timestamp\nuint8 type\n"
                  "string id\n"},
    RosDefinition{"foxglove_msgs/SceneEntity",
                  "builtin_interfaces/Time timestamp\nstring frame_id\nstring id\n"
                  "builtin_interfaces/Duration lifetime\nbool frame_locked\n"
                  "foxglove_msgs/KeyValuePair[] metadata\nfoxglove_msgs/ArrowPrimitive[] arrows\n"
                  "foxglove_msgs/CubePrimitive[] cubes\nfoxglove_msgs/SpherePrimitive[] spheres\n"
                  "foxglove_msgs/CylinderPrimitive[] cylinders\nfoxglove_msgs/LinePrimitive[] lines\n"
                  "foxglove_msgs/TriangleListPrimitive[] triangles\nfoxglove_msgs/TextPrimitive[] texts\n"
                  "foxglove_msgs/ModelPrimitive[] models\n"},
    RosDefinition{"foxglove_msgs/SceneUpdate",
                  "foxglove_msgs/SceneEntityDeletion[] deletions\nfoxglove_msgs/SceneEntity[] entities\n"},
};

using telemetry::Frame;

double or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

/// Pose of the middle of the rear axle, in W.
model::Pose base_link(const model::State& state, const Run& run) {
  const double b = run.vehicle.rear_axle;
  return {state.x - b * chicane::cos(state.psi), state.y - b * chicane::sin(state.psi), state.psi};
}

std::int64_t nanoseconds(double seconds) { return static_cast<std::int64_t>(to_nanoseconds(seconds)); }

std::string encode_odometry(const Frame& frame, const Run& run) {
  const model::State now = known_motion(frame);
  const double r = or_zero(now.r);
  return encode(OdometryMessage{.stamp = nanoseconds(frame.time),
                                .frame = run.frames.odom,
                                .child_frame = run.frames.base,
                                .pose = base_link(now, run),
                                .vx = now.vx,
                                .vy = or_zero(now.vy) - r * run.vehicle.rear_axle,
                                .yaw_rate = r});
}

std::string encode_predicted_path(const Frame& frame, const Run& run) {
  const controller::Plan& plan = frame.result.plan;
  PathMessage path{.stamp = nanoseconds(frame.time), .frame = run.frames.map};
  const int size = std::clamp(plan.size, 0, controller::Plan::kCapacity);
  for (const controller::PlanPoint& point : std::span{plan.points}.first(static_cast<std::size_t>(size)))
    path.poses.push_back({nanoseconds(point.time), run.frames.map, {point.x, point.y, point.psi}});
  return encode(path);
}

std::string encode_line(double time, const Run& run, std::span<const Vec2> line) {
  return encode(path_along(nanoseconds(time), run.frames.map, line));
}

std::string encode_reference(const Frame& frame, const Run& run) {
  const controller::Plan& plan = frame.result.plan;
  const int size = std::clamp(plan.reference_size, 0, controller::Plan::kCapacity);
  return encode_line(frame.time, run, std::span{plan.reference}.first(static_cast<std::size_t>(size)));
}

std::string encode_transforms(const Frame& frame, const Run& run) {
  const FrameNames& names = run.frames;
  const std::int64_t stamp = nanoseconds(frame.time);
  return encode(TransformsMessage{{{stamp, names.map, names.odom, {}},
                                   {stamp, names.odom, names.base, base_link(known_motion(frame), run)}}});
}

std::string encode_drive(const Frame& frame, const Run& run) {
  const model::Command& sent = frame.result.command;
  return encode(DriveMessage{
      .stamp = nanoseconds(frame.time),
      .frame = run.frames.base,
      .steer = sent.steer,
      .speed = frame.result.report.speed_reference,
      .acceleration = model::longitudinal_acceleration(run.vehicle, sent.throttle, frame.measurement.speed)});
}

std::string encode_clock(const Frame& frame, const Run&) {
  return encode(ClockMessage{nanoseconds(frame.time)});
}

/// Level and message of a diagnostic_msgs/DiagnosticStatus.
struct Diagnosis {
  std::uint8_t level;  ///< 0 fine, 1 warning, 2 error, 3 unknown
  std::string message;
};

Diagnosis diagnose_controller(const Frame& frame) {
  const telemetry::Situation& now = frame.situation;
  const Severity severity = severity_of(now);
  if (severity == Severity::kOk && frame.guard.gated) return {1, "the command gate changed the command"};
  const std::string_view reason = reason_of(now);
  return {static_cast<std::uint8_t>(severity),
          reason.empty() ? sentence_of(now) : fmt::format("{}: {}", sentence_of(now), reason)};
}

Diagnosis diagnose_road(const Frame& frame) {
  if (!frame.is_judged) return {3, "not judged: external simulator, track not given"};
  return frame.is_off_track ? Diagnosis{2, "off the road"} : Diagnosis{0, "on the road"};
}

std::string encode_diagnostics(const Frame& frame, const Run& run) {
  const controller::StepReport& report = frame.result.report;
  CdrWriter writer;
  const auto status = [&](const Diagnosis& diagnosis, std::string_view name, std::string_view hardware,
                          std::initializer_list<std::pair<std::string_view, std::string>> values) {
    writer.put(diagnosis.level).text(name).text(diagnosis.message).text(hardware).count(values.size());
    for (const auto& [key, value] : values) writer.text(key).text(value);
  };
  writer.stamp(frame.time).text("").count(2);
  status(diagnose_controller(frame), "chicane: controller", run.controller,
         {{"solve_status", std::string(solver::to_string(report.solve.status))},
          {"iterations", fmt::format("{}", report.solve.iterations)},
          {"step_time_us", fmt::format("{:.0f}", 1e6 * frame.step_time)},
          {"delay_ms", fmt::format("{:.1f}", 1e3 * report.delay)},
          {"sight_m", fmt::format("{:.0f}", report.sight)}});
  const Diagnosis road = diagnose_road(frame);
  status(road, "chicane: road", run.track,
         {{"edge_distance_m", fmt::format("{:.2f}", frame.edge_distance)},
          {"lateral_error_m", fmt::format("{:.2f}", frame.lateral_error)},
          {"off_track_events", fmt::format("{}", frame.off_track_events)},
          {"lap", fmt::format("{}", frame.lap)}});
  return writer.bytes();
}

std::string encode_left(const Frame&, const Run& run) { return encode_line(0.0, run, run.road.left); }
std::string encode_right(const Frame&, const Run& run) { return encode_line(0.0, run, run.road.right); }
std::string encode_centre(const Frame&, const Run& run) { return encode_line(0.0, run, run.road.centre); }
std::string encode_racing_line(const Frame&, const Run& run) {
  std::vector<Vec2> line;
  if (run.limit.found) {
    for (const road::LinePoint& point : run.limit.found->line) line.push_back(point.position);
  }
  return encode_line(0.0, run, line);
}

/// Name without "msg": "nav_msgs/msg/Odometry" → "nav_msgs/Odometry".
std::string short_name(std::string_view type) {
  std::string name{type};
  if (const auto at = name.find("/msg/"); at != std::string::npos) name.erase(at, 4);
  return name;
}

const OwnMessage* find_own(std::string_view name) {
  for (const OwnMessage& each : own_messages())
    if (each.name == name) return &each;
  return nullptr;
}

/// Definition of a type; empty text if there is none of that name.
RosDefinition definition_of(std::string_view name) {
  if (const OwnMessage* own = find_own(name)) return {own->name, own->definition};
  for (const RosDefinition& each : kRosDefinitions)
    if (each.name == name) return each;
  return {};
}

/// Appends the definitions of the types in a definition, each once, in order of appearance, depth first.
void collect(const RosDefinition& definition, std::vector<RosDefinition>& found) {
  for (std::size_t begin = 0; begin < definition.text.size();) {
    const std::size_t end = definition.text.find('\n', begin);
    const std::string_view line = definition.text.substr(begin, end - begin);
    const RosDefinition part = definition_of(line.substr(0, line.find_first_of(" [")));
    const auto is_it = [&](const RosDefinition& each) { return each.name == part.name; };
    if (!part.text.empty() && std::none_of(found.begin(), found.end(), is_it)) {
      found.push_back(part);
      collect(part, found);
    }
    begin = end + 1;
  }
}

/// Topic of a standard type, which `encode` writes, or of a type of chicane_msgs.
RosTopic topic(std::string_view name, std::string_view type, Cadence cadence,
               std::string (*encode)(const Frame&, const Run&) = nullptr) {
  const OwnMessage* own = find_own(short_name(type));
  return {name, type, ros_schema(type), cadence, own != nullptr ? own->encode : encode};
}

}  // namespace

RoadLines road_lines(const road::Track& track, double spacing) {
  constexpr double kMaxPoints = 20'000.0;  // limit of points in a line
  const road::Path& centre = track.centre();
  const double step = std::max(spacing, centre.length() / kMaxPoints);
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(centre.length() / step)));
  RoadLines lines;
  for (std::size_t i = 0; i <= count; ++i) {
    const double s = centre.length() * static_cast<double>(i) / static_cast<double>(count);
    const road::PathPoint point = centre.at(s);
    const Vec2 normal{-chicane::sin(point.heading), chicane::cos(point.heading)};
    lines.centre.push_back(point.position);
    lines.left.emplace_back(point.position + track.left_width(s) * normal);
    lines.right.emplace_back(point.position - track.right_width(s) * normal);
  }
  return lines;
}

const std::vector<RosTopic>& ros_topics() {
  static const std::vector<RosTopic> topics{
      topic("/chicane/frame", "chicane_msgs/msg/Frame", Cadence::kFrame),
      topic("/chicane/plan", "chicane_msgs/msg/Plan", Cadence::kFrame),
      topic("/chicane/run", "chicane_msgs/msg/Run", Cadence::kRun),
      topic("/odom", "nav_msgs/msg/Odometry", Cadence::kFrame, encode_odometry),
      topic("/plan", "nav_msgs/msg/Path", Cadence::kFrame, encode_predicted_path),
      topic("/reference", "nav_msgs/msg/Path", Cadence::kFrame, encode_reference),
      topic("/drive", "ackermann_msgs/msg/AckermannDriveStamped", Cadence::kFrame, encode_drive),
      topic("/tf", "tf2_msgs/msg/TFMessage", Cadence::kFrame, encode_transforms),
      topic("/clock", "rosgraph_msgs/msg/Clock", Cadence::kFrame, encode_clock),
      topic("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", Cadence::kFrame, encode_diagnostics),
      topic("/track/left", "nav_msgs/msg/Path", Cadence::kRoad, encode_left),
      topic("/track/right", "nav_msgs/msg/Path", Cadence::kRoad, encode_right),
      topic("/track/centre", "nav_msgs/msg/Path", Cadence::kRoad, encode_centre),
      topic("/chicane/lap", "chicane_msgs/msg/Lap", Cadence::kLap),
      topic("/chicane/change", "chicane_msgs/msg/Change", Cadence::kEvent),
      topic("/chicane/limit", "chicane_msgs/msg/Limit", Cadence::kLimit),
      topic("/track/racing_line", "nav_msgs/msg/Path", Cadence::kLimit, encode_racing_line),
      topic("/scene", "foxglove_msgs/msg/SceneUpdate", Cadence::kRoad, encode_scene),
      topic("/chicane/situation", "chicane_msgs/msg/Situation", Cadence::kFrame),
  };
  return topics;
}

void describe(const controller::Controller& controller, Run& run) {
  run.controller = controller.name();
  run.cost_terms.assign(controller.cost_terms().begin(), controller.cost_terms().end());
  run.constraints.assign(controller.constraints().begin(), controller.constraints().end());
}

std::string ros_schema(std::string_view type) {
  const RosDefinition root = definition_of(short_name(type));
  std::vector<RosDefinition> parts;
  collect(root, parts);
  std::string schema{root.text};
  for (const RosDefinition& part : parts)
    schema += fmt::format("{:=<80}\nMSG: {}\n{}", "", part.name, part.text);
  return schema;
}

std::string_view service_request_schema(std::string_view type) {
  if (type == "std_srvs/srv/SetBool") return "bool data\n";
  return type == "chicane_msgs/srv/Ask" ? "string question\n" : "";
}

std::string_view service_response_schema() { return "bool success\nstring message\n"; }

std::optional<bool> decode_set_bool(std::string_view request) {
  // Header (any of the two byte orders, a single byte has none) and one boolean; peers may pad the end.
  if (request.size() < 5 || request[0] != '\0' || static_cast<unsigned char>(request[4]) > 1)
    return std::nullopt;
  return request[4] == '\1';
}

std::optional<std::string> decode_ask(std::string_view request) {
  CdrSource from(request);  // peers may pad the end
  std::string text(from.text());
  return from.ok() ? std::optional(std::move(text)) : std::nullopt;
}

std::string encode_service_response(bool success, std::string_view message) {
  return CdrWriter{}.put(success).text(message).bytes();
}

std::uint64_t to_nanoseconds(double seconds) noexcept {
  constexpr double kLast = 2147483647.0;  // largest time in ROS's int32 [s]
  return static_cast<std::uint64_t>(std::llround(1e9 * std::clamp(or_zero(seconds), 0.0, kLast)));
}

PathMessage path_along(std::int64_t stamp, const std::string& frame, std::span<const Vec2> line) {
  PathMessage path{.stamp = stamp, .frame = frame};
  path.poses.reserve(line.size());
  double heading = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (i + 1 < line.size()) {
      const Vec2 ahead = line[i + 1] - line[i];
      heading = chicane::atan2(ahead.y(), ahead.x());
    }
    path.poses.push_back({stamp, frame, {line[i].x(), line[i].y(), heading}});
  }
  return path;
}

namespace {

using Setting = foxglove::Parameter;
using foxglove::ParameterValue;

// rcl_interfaces/msg/ParameterType.
enum class Type : std::uint8_t { kNotSet = 0, kBool = 1, kInteger = 2, kDouble = 3, kString = 4 };

Type type_of(const Setting& parameter) {
  if (std::holds_alternative<bool>(parameter.value)) return Type::kBool;
  if (std::holds_alternative<std::string>(parameter.value)) return Type::kString;
  if (!std::holds_alternative<double>(parameter.value)) return Type::kNotSet;
  const auto* row = find(parameter.name);
  return row != nullptr && row->option.kind == OptionKind::kInteger ? Type::kInteger : Type::kDouble;
}

}  // namespace

std::uint8_t type_number(const Setting& parameter) { return static_cast<std::uint8_t>(type_of(parameter)); }

/// Writes rcl_interfaces/msg/ParameterValue: a type, and a field for each type, of which that one is valid.
void value_fields(WritingArchive& archive, const Setting& parameter) {
  const Type type = type_of(parameter);
  const auto* number = std::get_if<double>(&parameter.value);
  const auto* flag = std::get_if<bool>(&parameter.value);
  const auto* text = std::get_if<std::string>(&parameter.value);
  archive(static_cast<std::uint8_t>(type), flag != nullptr && *flag,
          type == Type::kInteger ? static_cast<std::int64_t>(std::llround(*number)) : std::int64_t{0},
          type == Type::kDouble ? *number : 0.0, text != nullptr ? *text : std::string());
  for (int array = 0; array < 5; ++array) archive(std::uint32_t{0});
}

void value_fields(ReadingArchive& archive, Setting& parameter) {
  std::uint8_t type = 0;
  bool flag = false;
  std::int64_t integer = 0;
  double number = 0.0;
  std::string text;
  archive(type, flag, integer, number, text);
  archive.skip_list<std::uint8_t>();
  archive.skip_list<std::uint8_t>();
  archive.skip_list<std::int64_t>();
  archive.skip_list<double>();
  std::vector<std::string> texts;
  archive(texts);
  switch (static_cast<Type>(type)) {
    case Type::kBool:
      parameter.value = flag;
      break;
    case Type::kInteger:
      parameter.value = static_cast<double>(integer);
      break;
    case Type::kDouble:
      parameter.value = number;
      break;
    case Type::kString:
      parameter.value = text;
      break;
    default:
      parameter.value = std::monostate{};
  }
}

/// Writes rcl_interfaces/msg/ParameterDescriptor.
void descriptor_fields(WritingArchive& archive, const Setting& parameter) {
  const Type type = type_of(parameter);
  const auto* row = find(parameter.name);
  std::string meaning;
  if (row != nullptr) meaning = std::string(row->option.meaning);
  if (row != nullptr && !row->option.unit.name.empty())
    meaning += " [" + std::string(row->option.unit.name) + "]";
  archive(parameter.name, static_cast<std::uint8_t>(type), meaning, std::string(),
          row != nullptr && is_fixed(*row), false);
  const bool has_range =
      row != nullptr && std::isfinite(row->option.minimum) && std::isfinite(row->option.maximum);
  archive(std::uint32_t{has_range && type == Type::kDouble});
  if (has_range && type == Type::kDouble) archive(row->option.minimum, row->option.maximum, 0.0);
  archive(std::uint32_t{has_range && type == Type::kInteger});
  if (has_range && type == Type::kInteger)
    archive.as<std::int64_t>(row->option.minimum, row->option.maximum, 1);
}

}  // namespace chicane::protocol
