// SPDX-License-Identifier: MIT
#include "chicane/protocol/ros_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <variant>

#include "chicane/base/math.hpp"
#include "chicane/controller/guard_words.hpp"
#include "chicane/protocol/detail/cdr_writer.hpp"
#include "chicane/protocol/detail/ros_schemas.hpp"
#include "chicane/protocol/detail/scene_message.hpp"
#include "chicane/protocol/frame_fields.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::protocol {
namespace {

using telemetry::Frame;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

/// The middle of the rear axle, in W.
model::Pose base_link(const model::State& state, const Run& run) {
  const double b = run.vehicle.rear_axle;
  return {state.x - b * chicane::cos(state.psi), state.y - b * chicane::sin(state.psi), state.psi};
}

std::string encode_frame(const Frame& frame, const Run&) {
  CdrWriter writer{1024};
  for (const FrameGroup& group : frame_groups()) {
    for (const FrameField& field : group.fields) {
      std::visit([&](auto value) { writer.put(value); }, field.value(frame));
    }
  }
  return writer.bytes();
}

std::span<const controller::PlanPoint> points_of(const controller::Plan& plan) {
  return std::span{plan.points}.first(
      static_cast<std::size_t>(std::clamp(plan.size, 0, controller::Plan::kCapacity)));
}

std::string encode_plan(const Frame& frame, const Run&) {
  const auto points = points_of(frame.result.plan);
  CdrWriter writer{128 + points.size() * 7 * sizeof(double)};
  writer.stamp(frame.time);
  const auto column = [&](auto&& value_of) {
    writer.count(points.size());
    for (const controller::PlanPoint& point : points) writer.put(value_of(point));
  };
  column([](const auto& point) { return point.time; });
  column([](const auto& point) { return point.x; });
  column([](const auto& point) { return point.y; });
  column([](const auto& point) { return point.psi; });
  column([](const auto& point) { return point.speed; });
  column([](const auto& point) { return point.command.steer; });
  column([](const auto& point) { return point.command.throttle; });
  return writer.bytes();
}

/// Car and road as their files describe them, in the order of the message.
void put_origin(CdrWriter& writer, const Run& run) {
  const std::vector<IdentifiedValue>& identified = run.origin.identified;
  writer.texts(run.origin.car_notes).count(identified.size());
  for (const IdentifiedValue& each : identified) writer.text(each.key);
  for (const auto column : {&IdentifiedValue::value, &IdentifiedValue::low, &IdentifiedValue::high}) {
    writer.count(identified.size());
    for (const IdentifiedValue& each : identified) writer.put(each.*column);
  }
  writer.text(run.origin.road_kind)
      .texts(run.origin.road_notes)
      .put(run.track_scale, static_cast<std::uint32_t>(run.track_points))
      .put(run.track_fit.rms, run.track_fit.most);
}

std::string encode_run(const Frame&, const Run& run) {
  const model::VehicleParams& car = run.vehicle;
  CdrWriter writer;
  writer.text(run.track)
      .put(run.track_length, run.is_closed)
      .text(run.controller)
      .text(run.preset)
      .put(run.latency, run.control_period, run.is_paused)
      .text(car.name)
      .put(car.front_axle, car.rear_axle, car.track_width, car.tire_width, car.length, car.width,
           car.steer_limit)
      .text(run.mode)
      .texts(run.cost_terms)
      .texts(run.constraints)
      .texts(run.faults)
      .put(run.kerb_width)
      .text(run.building)
      .text(run.end)
      .text(run.end_reason)
      .text(run.guard.mode)
      .text(run.guard.road)
      .put(static_cast<std::uint32_t>(run.guard.version))
      .put(car.brake_throttle_limit)
      .texts(run.notices);
  put_origin(writer, run);
  return writer.bytes();
}

/// Of a lap or a sector; not-a-number where there is no limit.
double gap_percent(double time, double limit) {
  return limit > 0.0 ? 100.0 * lap_time::gap(time, limit) : kNaN;
}

std::string encode_lap(const Frame& frame, const Run& run) {
  const telemetry::CompletedLap& lap = frame.completed_lap;
  const bool has_limit = run.limit.found && lap.lap >= run.limit.first_lap;
  const lap_time::LapTimes limit = has_limit ? run.limit.found->times : lap_time::LapTimes{};
  return CdrWriter{}
      .put(static_cast<std::uint32_t>(lap.lap), lap.lap_time)
      .put(lap.sector_times[0], lap.sector_times[1], lap.sector_times[2], lap.is_clean)
      .put(lap.mean_speed, lap.top_speed, lap.min_edge_distance, lap.rms_lateral_error)
      .put(gap_percent(lap.lap_time, limit.lap))
      .put(gap_percent(lap.sector_times[0], limit.sectors[0]),
           gap_percent(lap.sector_times[1], limit.sectors[1]),
           gap_percent(lap.sector_times[2], limit.sectors[2]))
      .texts(run.lap_setup.names)
      .texts(run.lap_setup.values)
      .put(run.lap_setup.is_mixed, run.lap_setup.by_hand_share)
      .texts(run.lap_setup.faults)
      .bytes();
}

std::string encode_limit(const Frame&, const Run& run) {
  static const lap_time::Limit nothing = [] {
    lap_time::Limit limit;
    limit.times = {kNaN, {kNaN, kNaN, kNaN}, {}};
    return limit;
  }();
  const lap_time::Limit& limit = run.limit.found ? *run.limit.found : nothing;
  CdrWriter writer{256 + 64 * limit.line.size()};
  writer.put(run.limit.found != nullptr).put(limit.times.lap);
  for (const double sector : limit.times.sectors) writer.put(sector);
  const auto column = [&](auto value) {
    writer.count(limit.line.size());
    for (const road::LinePoint& point : limit.line) writer.put(value(point));
  };
  using Point = road::LinePoint;
  column([](const Point& p) { return p.s; });
  column([](const Point& p) { return p.position.x(); });
  column([](const Point& p) { return p.position.y(); });
  column([](const Point& p) { return p.d; });
  column([](const Point& p) { return p.speed; });
  column([](const Point& p) { return p.longitudinal_acceleration; });
  column([](const Point& p) { return p.lateral_acceleration; });
  column([](const Point& p) { return p.time; });
  std::vector<std::string> causes;
  std::vector<double> lap_times, corner_times;
  for (const lap_time::LapWithout& without : run.limit.without) {
    causes.push_back(without.cause);
    lap_times.push_back(without.lap_time);
    for (std::size_t i = 0; i < limit.times.corners.size(); ++i)
      corner_times.push_back(i < without.corners.size() ? without.corners[i] : kNaN);
  }
  return writer.text(run.limit.found ? "" : run.limit.why_not)
      .put(static_cast<std::uint32_t>(run.limit.first_lap))
      .put(std::span<const double>(limit.times.corners))
      .texts(causes)
      .put(std::span<const double>(lap_times), std::span<const double>(corner_times))
      .bytes();
}

std::string encode_odometry(const Frame& frame, const Run& run) {
  const model::State now = known_motion(frame);
  const model::Pose pose = base_link(now, run);
  const double r = or_zero(now.r);
  return CdrWriter{}
      .header(frame.time, run.frames.odom)
      .text(run.frames.base)
      .put(pose.x, pose.y, 0.0)
      .orientation(pose.psi)
      .zeros(36)
      .put(now.vx, or_zero(now.vy) - r * run.vehicle.rear_axle, 0.0, 0.0, 0.0, r)
      .zeros(36)
      .bytes();
}

void put_pose_stamped(CdrWriter& writer, double time, const std::string& frame, const model::Pose& pose) {
  writer.header(time, frame).put(pose.x, pose.y, 0.0).orientation(pose.psi);
}

constexpr std::size_t kPoseSize = 88;  // upper bound of one PoseStamped in frame "map" [byte]

std::string encode_predicted_path(const Frame& frame, const Run& run) {
  const auto points = points_of(frame.result.plan);
  CdrWriter writer{64 + kPoseSize * points.size()};
  writer.header(frame.time, run.frames.map).count(points.size());
  for (const controller::PlanPoint& point : points) {
    put_pose_stamped(writer, point.time, run.frames.map, {point.x, point.y, point.psi});
  }
  return writer.bytes();
}

/// A polyline as nav_msgs/Path, each pose looking at the next point.
std::string encode_line(double time, const Run& run, std::span<const Vec2> line) {
  CdrWriter writer{64 + kPoseSize * line.size()};
  writer.header(time, run.frames.map).count(line.size());
  double heading = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (i + 1 < line.size()) {
      const Vec2 ahead = line[i + 1] - line[i];
      heading = chicane::atan2(ahead.y(), ahead.x());
    }
    put_pose_stamped(writer, time, run.frames.map, {line[i].x(), line[i].y(), heading});
  }
  return writer.bytes();
}

std::string encode_reference(const Frame& frame, const Run& run) {
  const controller::Plan& plan = frame.result.plan;
  const int size = std::clamp(plan.reference_size, 0, controller::Plan::kCapacity);
  return encode_line(frame.time, run, std::span{plan.reference}.first(static_cast<std::size_t>(size)));
}

std::string encode_transforms(const Frame& frame, const Run& run) {
  const model::Pose pose = base_link(known_motion(frame), run);
  return CdrWriter{}
      .count(2)
      .header(frame.time, run.frames.map)
      .text(run.frames.odom)
      .zeros(3)
      .orientation(0.0)
      .header(frame.time, run.frames.odom)
      .text(run.frames.base)
      .put(pose.x, pose.y, 0.0)
      .orientation(pose.psi)
      .bytes();
}

std::string encode_drive(const Frame& frame, const Run& run) {
  const model::Command& sent = frame.result.command;
  const double acceleration =
      model::longitudinal_acceleration(run.vehicle, sent.throttle, frame.measurement.speed);
  return CdrWriter{}
      .header(frame.time, run.frames.base)
      .put(static_cast<float>(sent.steer), 0.0F, static_cast<float>(frame.result.report.speed_reference),
           static_cast<float>(acceleration), 0.0F)
      .bytes();
}

std::string encode_clock(const Frame& frame, const Run&) { return CdrWriter{}.stamp(frame.time).bytes(); }

struct Diagnosis {
  std::uint8_t level;  ///< 0 fine, 1 warning, 2 error, 3 unknown
  std::string message;
};

Diagnosis diagnose_controller(const safety::GuardReport& report) {
  const controller::DriverWords words = controller::describe_driver(report.rung, report.reason);
  if (words.severity == Severity::kOk && report.gated) return {1, "the command gate changed the command"};
  return {static_cast<std::uint8_t>(words.severity), controller::sentence_of(words)};
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
  writer.header(frame.time, "").count(2);
  status(diagnose_controller(frame.guard), "chicane: controller", run.controller,
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

/// "nav_msgs/msg/Odometry" → "nav_msgs/Odometry"
std::string short_name(std::string_view type) {
  std::string name{type};
  if (const auto at = name.find("/msg/"); at != std::string::npos) name.erase(at, 4);
  return name;
}

/// The definition of chicane_msgs/Frame: constants in front of their field, meanings in one column.
std::string frame_definition() {
  std::string text =
      "# One control cycle. SI units and radians; left, counter-clockwise and\n"
      "# forward are positive. Not-a-number: unknown.\n";
  const auto line = [&](const std::string& declaration, std::string_view meaning) {
    text += meaning.empty() ? declaration : fmt::format("{:<39} # {}", declaration, meaning);
    text += '\n';
  };
  for (const FrameGroup& group : frame_groups()) {
    if (!group.title.empty()) text += fmt::format("\n# {}\n", group.title);
    for (const FrameField& field : group.fields) {
      for (const FrameConstant& each : field.constants)
        line(fmt::format("{} {}={}", field.type, each.name, each.value), each.meaning);
      line(fmt::format("{} {}", field.type, field.name), field.meaning);
    }
  }
  return text;
}

const RosDefinition* find_definition(std::string_view name) {
  static const std::string frame_text = frame_definition();
  static const RosDefinition frame{"chicane_msgs/Frame", frame_text};
  if (name == frame.name) return &frame;
  const auto* found = std::find_if(kRosDefinitions.begin(), kRosDefinitions.end(),
                                   [&](const RosDefinition& definition) { return definition.name == name; });
  return found == kRosDefinitions.end() ? nullptr : found;
}

/// Appends the names that a definition refers to, each once, in order of appearance, depth first.
void collect(const RosDefinition& definition, std::vector<const RosDefinition*>& found) {
  for (std::size_t begin = 0; begin < definition.text.size();) {
    const std::size_t end = definition.text.find('\n', begin);
    const std::string_view line = definition.text.substr(begin, end - begin);
    const RosDefinition* part = find_definition(line.substr(0, line.find_first_of(" [")));
    if (part != nullptr && std::find(found.begin(), found.end(), part) == found.end()) {
      found.push_back(part);
      collect(*part, found);
    }
    begin = end + 1;
  }
}

RosTopic topic(std::string_view name, std::string_view type, Cadence cadence,
               std::string (*encode)(const Frame&, const Run&)) {
  return {name, type, ros_schema(type), cadence, encode};
}

}  // namespace

RoadLines road_lines(const road::Track& track, double spacing) {
  constexpr double kMaxPoints = 20'000.0;
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
      topic("/chicane/frame", "chicane_msgs/msg/Frame", Cadence::kFrame, encode_frame),
      topic("/chicane/plan", "chicane_msgs/msg/Plan", Cadence::kFrame, encode_plan),
      topic("/chicane/run", "chicane_msgs/msg/Run", Cadence::kRun, encode_run),
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
      topic("/chicane/lap", "chicane_msgs/msg/Lap", Cadence::kLap, encode_lap),
      topic("/chicane/change", "chicane_msgs/msg/Change", Cadence::kEvent, nullptr),
      topic("/chicane/limit", "chicane_msgs/msg/Limit", Cadence::kLimit, encode_limit),
      topic("/track/racing_line", "nav_msgs/msg/Path", Cadence::kLimit, encode_racing_line),
      topic("/scene", "foxglove_msgs/msg/SceneUpdate", Cadence::kRoad, encode_scene),
  };
  return topics;
}

void describe(const controller::Controller& controller, Run& run) {
  run.controller = controller.name();
  run.cost_terms.assign(controller.cost_terms().begin(), controller.cost_terms().end());
  run.constraints.assign(controller.constraints().begin(), controller.constraints().end());
}

std::string encode_change(double time, std::uint64_t cycle, std::string_view name, std::string_view value) {
  return CdrWriter{}.stamp(time).put(cycle).text(name).text(value).bytes();
}

std::string ros_schema(std::string_view type) {
  const RosDefinition* root = find_definition(short_name(type));
  if (root == nullptr) return {};
  std::vector<const RosDefinition*> parts;
  collect(*root, parts);
  std::string schema{root->text};
  for (const RosDefinition* part : parts) {
    schema += fmt::format("{:=<80}\nMSG: {}\n{}", "", part->name, part->text);
  }
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
  // Header, length with the final zero, and the text; peers may pad the end.
  constexpr std::size_t kBegin = 8;
  if (request.size() < kBegin + 1 || request[0] != '\0' || (request[1] != '\0' && request[1] != '\1'))
    return std::nullopt;
  const bool is_little_endian = request[1] == '\1';
  std::size_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto byte = static_cast<unsigned char>(request[4 + i]);
    size |= static_cast<std::size_t>(byte) << (8 * (is_little_endian ? i : 3 - i));
  }
  if (size < 1 || size > request.size() - kBegin || request[kBegin + size - 1] != '\0') return std::nullopt;
  return std::string(request.substr(kBegin, size - 1));
}

std::string encode_service_response(bool success, std::string_view message) {
  return CdrWriter{}.put(success).text(message).bytes();
}

std::uint64_t to_nanoseconds(double seconds) noexcept {
  constexpr double kLast = 2147483647.0;
  return static_cast<std::uint64_t>(std::llround(1e9 * std::clamp(or_zero(seconds), 0.0, kLast)));
}

}  // namespace chicane::protocol
