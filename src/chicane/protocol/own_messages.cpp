// SPDX-License-Identifier: MIT
// Messages of chicane_msgs: the rows of each, of which bytes and definition are made, and the scene with road
// and car for viewers. A row has the name of a field, its meaning, and its value.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string_view>
#include <variant>

#include "chicane/protocol/car_messages.hpp"
#include "chicane/protocol/detail/own_messages.hpp"
#include "chicane/protocol/frame_fields.hpp"
#include "chicane/protocol/step_codec.hpp"

namespace chicane::protocol {

DefinedRows::DefinedRows(std::string_view about, int width) : width_{width} {
  if (!about.empty()) text_ = fmt::format("# {}\n", about);
}

void DefinedRows::title(std::string_view text) {
  text_ += text.empty() ? "\n" : fmt::format("\n# {}\n", text);
}

void DefinedRows::line(const std::string& declaration, std::string_view meaning) {
  text_ += meaning.empty() ? declaration : fmt::format("{:<{}} # {}", declaration, width_, meaning);
  text_ += '\n';
}

namespace {

using telemetry::Frame;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Values of one member, or of a function, for each element of a list.
template <class List, class ValueOf>
Numbers column(const List& list, ValueOf value_of) {
  Numbers numbers;
  numbers.reserve(list.size());
  for (const auto& each : list) numbers.push_back(std::invoke(value_of, each));
  return numbers;
}

constexpr auto kPlan = [](auto& row, const Frame& frame, const Run& /*run*/) {
  const controller::Plan& plan = frame.result.plan;
  const int size = std::clamp(plan.size, 0, controller::Plan::kCapacity);
  using Point = controller::PlanPoint;
  const auto points = std::span{plan.points}.first(static_cast<std::size_t>(size));
  row("stamp", "", Stamp{frame.time});
  row("time_s", "", column(points, &Point::time));
  row("x_m", "", column(points, &Point::x));
  row("y_m", "", column(points, &Point::y));
  row("yaw_rad", "", column(points, &Point::psi));
  row("speed_mps", "", column(points, &Point::speed));
  row("steer_rad", "", column(points, [](const auto& point) { return point.command.steer; }));
  row("throttle", "", column(points, [](const auto& point) { return point.command.throttle; }));
};

constexpr auto kSituation = [](auto& row, const Frame& frame, const Run& /*run*/) {
  const telemetry::Situation& now = frame.situation;
  row("stamp", "", Stamp{frame.time});
  row("severity", "\"normal\"; \"notice\": driven otherwise; \"alarm\": a person has to know or act",
      telemetry::name_of(severity_of(now)));
  row("sentence", "at most six words: \"Grip: 97 % in T4\"", sentence_of(now));
  row("reason", "why, in a clause; empty where the sentence says it", reason_of(now));
  row("ends_it", "what ends an alarm, by itself and by a person: two sentences", what_ends(now));
  row("driver", "\"controller\", \"guard\", \"person\"", name_of(now.driver));
  row("kind", "the sentence without its numbers: \"part_throttle\"", name_of(now.kind));
  row("kind_since_s", "time of the run at which `kind` began", now.kind_since);
  row("event_since_s", "of an alarm: time of the run at which its event began; not-a-number: no alarm",
      severity_of(now) == Severity::kError ? now.event_since : kNaN);
  row("stands_since_s", "time of the run since which the car stands; not-a-number: it moves",
      now.stands_since < 0.0 ? kNaN : now.stands_since);
  row("alarms", "events of the run so far that a person has to know of", now.alarms);
};

constexpr auto kRun = [](auto& row, const Frame& /*frame*/, const Run& run) {
  const model::VehicleParams& car = run.vehicle;
  row("track", "", run.track);
  row("track_length_m", "0 = unknown", run.track_length);
  row("is_closed", "", run.is_closed);
  row("controller", "", run.controller);
  row("preset", "", run.preset);
  row("latency_s", "artificial, from command to actuation", run.latency);
  row("control_period_s", "", run.control_period);
  row("is_paused", "", run.is_paused);
  row.title("The car, as the controller models it");
  row("car", "", car.name);
  row("front_axle_m", "centre of mass to front axle", car.front_axle);
  row("rear_axle_m", "centre of mass to rear axle", car.rear_axle);
  row("track_width_m", "between the wheels of an axle", car.track_width);
  row("tire_width_m", "", car.tire_width);
  row("body_length_m", "", car.length);
  row("body_width_m", "", car.width);
  row("steer_limit_rad", "", car.steer_limit);
  row.title("");
  row("mode", "\"drive\": our simulator; \"serve\": an external one", run.mode);
  row("cost_term_names", "of Frame.cost_terms", run.cost_terms);
  row("constraint_names", "of the bits of Frame.active_now and active_ahead, from the lowest",
      run.constraints);
  row("fault_names", "of the bits of Frame.active_faults", run.faults);
  row("kerb_width_m", "drivable, outside each edge", run.kerb_width);
  row("building", "another run that is being built: \"track = oval\"; empty: none", run.building);
  row("end", "\"finished\", \"stopped\", \"failed\": the run is over; empty: it goes on", run.end);
  row("end_reason", "why, in one sentence; empty when it finished", run.end_reason);
  row("guard_mode", "\"on\", \"observe\", \"off\"; empty: not known", run.guard.mode);
  row("guard_road", "where the guard knows the road from: \"track\", \"waypoints\"", run.guard.road);
  row("guard_version", "0: not known", static_cast<std::uint32_t>(run.guard.version));
  row("brake_throttle_limit", "the throttle that brakes fully is minus this", car.brake_throttle_limit);
  row("notices", "what was assumed, and what has no effect: a sentence each", run.notices);
  const std::vector<IdentifiedValue>& identified = run.origin.identified;
  Texts keys;
  for (const IdentifiedValue& each : identified) keys.push_back(each.key);
  row.title("Where car and road come from, as their files say it");
  row("car_notes", "", run.origin.car_notes);
  row("identified_keys", "parameters found by a log, in the unit of their key", keys);
  row("identified_values", "", column(identified, &IdentifiedValue::value));
  row("identified_low", "95 % interval; not-a-number: assumed, the log did not excite it",
      column(identified, &IdentifiedValue::low));
  row("identified_high", "", column(identified, &IdentifiedValue::high));
  row("track_kind", "\"occupancy map\", \"table of points\"; empty: not known", run.origin.road_kind);
  row("track_notes", "remarks of the file, and what its reader assumed", run.origin.road_notes);
  row("track_scale", "the road's size over that of its file", run.track_scale);
  row("track_points", "in the file; 0: not known", static_cast<std::uint32_t>(run.track_points));
  row("track_fit_rms_m", "of the points from the smooth line", run.track_fit.rms);
  row("track_fit_max_m", "", run.track_fit.most);
};

/// Gap of a lap or a sector to its limit [%]; not-a-number without a limit.
double gap_percent(double time, double limit) {
  return limit > 0.0 ? 100.0 * lap_time::gap(time, limit) : kNaN;
}

constexpr auto kLap = [](auto& row, const Frame& frame, const Run& run) {
  const telemetry::CompletedLap& lap = frame.completed_lap;
  const bool has_limit = run.limit.found && lap.lap >= run.limit.first_lap;
  const lap_time::LapTimes limit = has_limit ? run.limit.found->times : lap_time::LapTimes{};
  const std::array<double, 3> gaps{gap_percent(lap.sector_times[0], limit.sectors[0]),
                                   gap_percent(lap.sector_times[1], limit.sectors[1]),
                                   gap_percent(lap.sector_times[2], limit.sectors[2])};
  row("lap", "its number, from 1", static_cast<std::uint32_t>(lap.lap));
  row("lap_time_s", "", lap.lap_time);
  row("sector_times_s", "thirds of the lap", lap.sector_times);
  row("is_clean", "no tyre left the road", lap.is_clean);
  row("mean_speed_mps", "", lap.mean_speed);
  row("top_speed_mps", "", lap.top_speed);
  row("min_edge_distance_m", "of the outermost tyre, negative = off the road", lap.min_edge_distance);
  row("rms_lateral_error_m", "", lap.rms_lateral_error);
  row("gap_to_limit_percent", "lap time over the limit's, minus 100 %; not-a-number while unknown",
      gap_percent(lap.lap_time, limit.lap));
  row("sector_gaps_to_limit_percent", "the same for the thirds", gaps);
  row("setting_names", "changed since the run began, as at the end of the lap", run.lap_setup.names);
  row("setting_values", "as --set takes them", run.lap_setup.values);
  row("is_mixed", "one of them changed while the lap was driven", run.lap_setup.is_mixed);
  row("by_hand_share", "of its time, driven by a person", run.lap_setup.by_hand_share);
  row("faults", "that acted in it", run.lap_setup.faults);
};

constexpr auto kLimit = [](auto& row, const Frame& /*frame*/, const Run& run) {
  const lap_time::Limit nothing = [] {
    lap_time::Limit limit;
    limit.times = {kNaN, {kNaN, kNaN, kNaN}, {}};
    return limit;
  }();
  using Point = road::LinePoint;
  const lap_time::Limit& limit = run.limit.found ? *run.limit.found : nothing;
  const auto along = [&](auto value) { return column(limit.line, value); };
  Texts causes;
  Numbers lap_times, corner_times;
  for (const lap_time::LapWithout& without : run.limit.without) {
    causes.push_back(without.cause);
    lap_times.push_back(without.lap_time);
    for (std::size_t i = 0; i < limit.times.corners.size(); ++i)
      corner_times.push_back(i < without.corners.size() ? without.corners[i] : kNaN);
  }
  row("is_known", "false: see why_not; the rest is empty", run.limit.found != nullptr);
  row("lap_time_s", "", limit.times.lap);
  row("sector_times_s", "thirds of the lap, from the start line", limit.times.sectors);
  row("s_m", "along the centre line from its beginning", along(&Point::s));
  row("x_m", "of the centre of mass", along([](const Point& p) { return p.position.x(); }));
  row("y_m", "", along([](const Point& p) { return p.position.y(); }));
  row("n_m", "to the left of the centre line", along(&Point::d));
  row("speed_mps", "", along(&Point::speed));
  row("longitudinal_acceleration_mps2", "", along(&Point::longitudinal_acceleration));
  row("lateral_acceleration_mps2", "positive to the left", along(&Point::lateral_acceleration));
  row("time_s", "since the start line", along(&Point::time));
  row("why_not", "in one sentence, while is_known is false",
      run.limit.found ? std::string() : run.limit.why_not);
  row("first_lap", "it holds for laps from this one on: before, grip or mass were others",
      static_cast<std::uint32_t>(run.limit.first_lap));
  row("corner_times_s", "of the limit, in the order of a lap, with half of the straights beside",
      limit.times.corners);
  row("without", "laps that were driven again without these, one at a time: \"latency\"", causes);
  row("without_lap_times_s", "the best of each; not-a-number where there was none", lap_times);
  row("without_corner_times_s", "of these laps, one after the other; not-a-number where not known",
      corner_times);
};

/// Rows of chicane_msgs/Change, for writing, reading and definition.
void change_rows(auto& row, auto&& stamp, auto&& cycle, auto&& name, auto&& value) {
  row("stamp", "", stamp);
  row("cycle", "", cycle);
  row("name", "key as in YAML and --set: \"latency_ms\"", name);
  row("value", "as --set takes it", value);
}

/// Columns of a stop plan in a message: time, distance, speed, steer, throttle.
using StopColumns = std::array<Numbers, 5>;

/// Pointers to the numbers of a point of a stop plan, in the order of StopColumns.
auto numbers_of(auto& point) {
  return std::array{&point.time, &point.distance, &point.speed, &point.command.steer,
                    &point.command.throttle};
}

/// Rows of chicane_msgs/StopPlan, for writing, reading and definition.
void stop_rows(auto& row, auto&& stamp, auto&& columns) {
  row("stamp", "of the odometry that the command answers", stamp);
  row("time_s", "after the stamp, from which the command acts", columns[0]);
  row("distance_m", "driven since the stop began", columns[1]);
  row("speed_mps", "planned then", columns[2]);
  row("steer_rad", "left positive", columns[3]);
  row("throttle", "[-1, 1], negative brakes", columns[4]);
}

/// Definition of chicane_msgs/Frame: the constants of a field come before it.
std::string frame_definition() {
  DefinedRows rows(
      "One control cycle. SI units and radians; left, counter-clockwise and\n"
      "# forward are positive. Not-a-number: unknown.");
  for (const FrameGroup& group : frame_groups()) {
    if (!group.title.empty()) rows.title(group.title);
    for (const FrameField& field : group.fields) {
      for (const FrameConstant& each : field.constants)
        rows.line(fmt::format("{} {}={}", field.type, each.name, each.value), each.meaning);
      rows.line(fmt::format("{} {}", field.type, field.name), field.meaning);
    }
  }
  return rows.text();
}

/// Message that is not made from frames.
OwnMessage defined(std::string_view name, std::string_view about, auto rows_of) {
  DefinedRows rows(about);
  rows_of(rows);
  return {name, rows.text(), nullptr};
}

/// Message that is made from frames, by its rows.
template <auto kRows>
OwnMessage message_of_frame(std::string_view name, std::string_view about) {
  OwnMessage message = defined(name, about, [](auto& row) { kRows(row, Frame{}, Run{}); });
  message.encode = [](const Frame& frame, const Run& run) {
    return written([&](auto& row) { kRows(row, frame, run); });
  };
  return message;
}

std::string encode_frame(const Frame& frame, const Run& /*run*/) {
  CdrWriter writer{1024};
  for (const FrameGroup& group : frame_groups())
    for (const FrameField& field : group.fields)
      std::visit([&](auto value) { writer.put(value); }, field.value(frame));
  return writer.bytes();
}

}  // namespace

std::string encode_change(double time, std::uint64_t cycle, std::string_view name, std::string_view value) {
  return written([&](auto& row) { change_rows(row, Stamp{time}, cycle, name, value); });
}

std::optional<telemetry::Change> decode_change(std::string_view bytes) {
  ReadRows rows(bytes);
  telemetry::Change change;
  StampNs stamp;
  std::string name, value;
  change_rows(rows, stamp, change.cycle, name, value);
  if (!rows.ok() || !decltype(change.name)::fits(name) || !decltype(change.value)::fits(value))
    return std::nullopt;
  constexpr std::int64_t kSecond = 1'000'000'000;
  change.time = static_cast<double>(stamp.nanoseconds / kSecond);
  change.time += 1e-9 * static_cast<double>(stamp.nanoseconds % kSecond);
  change.name = name;
  change.value = value;
  return change;
}

template <>
std::string encode(const StopMessage& message) {
  StopColumns columns;
  for (int i = 0; i < message.stop.size; ++i) {
    const auto numbers = numbers_of(message.stop.points[static_cast<std::size_t>(i)]);
    for (std::size_t k = 0; k < columns.size(); ++k) columns[k].push_back(*numbers[k]);
  }
  const StampNs stamp{message.stamp};
  return written([&](auto& row) { stop_rows(row, stamp, columns); });
}

template <>
std::optional<StopMessage> decode(std::string_view bytes) {
  ReadRows rows(bytes);
  StopMessage message;
  StopColumns columns;
  StampNs stamp;
  stop_rows(rows, stamp, columns);
  message.stamp = stamp.nanoseconds;
  const std::size_t size = columns[0].size();
  if (!rows.ok() || size > safety::StopPlan::kCapacity) return std::nullopt;
  message.stop.size = static_cast<int>(size);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].size() != size) return std::nullopt;
    for (std::size_t i = 0; i < size; ++i) *numbers_of(message.stop.points[i])[k] = columns[k][i];
  }
  for (std::size_t i = 0; i < size; ++i) {
    for (const double* number : numbers_of(message.stop.points[i]))
      if (!std::isfinite(*number)) return std::nullopt;
    if (i > 0 && message.stop.points[i].time < message.stop.points[i - 1].time) return std::nullopt;
  }
  return message;
}

const std::vector<OwnMessage>& own_messages() {
  static const std::vector<OwnMessage> messages{
      {"chicane_msgs/Frame", frame_definition(), encode_frame},
      message_of_frame<kPlan>(
          "chicane_msgs/Plan",
          "What the controller intends: predicted motion of the centre of mass with\n"
          "# its commands, all arrays of the same length; element 0 is where the first command acts."),
      message_of_frame<kRun>("chicane_msgs/Run", "What is running: constant until something is chosen anew."),
      message_of_frame<kSituation>(
          "chicane_msgs/Situation",
          "State of the run in a control cycle, for people: who drives, what limits or\n"
          "# stops the car, what ends a stop. Computed from the applied command and the motion."),
      message_of_frame<kLap>("chicane_msgs/Lap", "One completed lap, sent when it is."),
      message_of_frame<kLimit>(
          "chicane_msgs/Limit",
          "The physical limit of this road for this car: the fastest lap of the model\n"
          "# in docs/limit.md and its line, arrays of the same length by rising time from the start\n"
          "# line, the last point the first one again."),
      defined("chicane_msgs/Change", "A setting that changed during the run, before this control cycle.",
              [](auto& row) {
                change_rows(row, Stamp{}, std::uint64_t{}, std::string_view{}, std::string_view{});
              }),
      defined("chicane_msgs/StopPlan",
              "How the car comes to rest when no further command arrives. Sent before the\n"
              "# command that it belongs to; columns have the same length.",
              [](auto& row) { stop_rows(row, Stamp{}, StopColumns{}); })};
  return messages;
}

namespace {

/// Colour; each part in [0, 1].
struct Colour {
  double r, g, b;
};
constexpr Colour kAsphalt{0.33, 0.35, 0.39}, kPaint{0.92, 0.93, 0.95}, kBody{0.15, 0.39, 0.85},
    kCabin{0.11, 0.13, 0.17}, kTire{0.07, 0.07, 0.08};
constexpr double kLineWidth = 0.25;  // width of an edge's line [m]
constexpr double kPaintHeight =
    0.02;  // of edges' lines above the road [m], so that viewers draw them over it

/// Box of the car's body, in `base_link`.
struct Cube {
  double x, y, z;                // position of the middle [m]
  double length, width, height;  // [m]
  Colour colour;
};

void put_colour(CdrWriter& writer, Colour colour) { writer.put(colour.r, colour.g, colour.b, 1.0); }

void put_points(CdrWriter& writer, const std::vector<Vec2>& points, double height) {
  writer.count(points.size());
  for (const Vec2& point : points) writer.put(point.x(), point.y(), height);
}

/// Begins a scene entity, up to its arrays of primitives: arrows, cubes, spheres, cylinders, lines,
/// triangles, texts, models.
void begin_entity(CdrWriter& writer, std::string_view frame_id, std::string_view id, bool is_locked) {
  writer.stamp(0.0).text(frame_id).text(id);
  writer.put(std::int32_t{0}, std::uint32_t{0}, is_locked).count(0);  // lifetime for ever, no metadata
}

/// Writes empty arrays.
void put_empty(CdrWriter& writer, int arrays) {
  for (int i = 0; i < arrays; ++i) writer.count(0);
}

void put_line(CdrWriter& writer, const std::vector<Vec2>& points) {
  writer.put(std::uint8_t{0}, 0.0, 0.0, 0.0).orientation(0.0).put(kLineWidth, false);  // a strip
  put_points(writer, points, kPaintHeight);
  put_colour(writer, kPaint);
  put_empty(writer, 2);  // colours, indices
}

/// Writes the surface between the edges: two triangles between each pair of neighbouring points.
void put_surface(CdrWriter& writer, const RoadLines& road) {
  const std::size_t pairs = std::min(road.left.size(), road.right.size());
  writer.put(0.0, 0.0, 0.0).orientation(0.0);
  writer.count(2 * pairs);
  for (std::size_t i = 0; i < pairs; ++i)
    writer.put(road.left[i].x(), road.left[i].y(), 0.0, road.right[i].x(), road.right[i].y(), 0.0);
  put_colour(writer, kAsphalt);
  writer.count(0).count(pairs == 0 ? 0 : 6 * (pairs - 1));
  for (std::uint32_t i = 0; i + 1 < pairs; ++i) {
    const std::uint32_t at = 2 * i;
    writer.put(at, at + 1, at + 2, at + 1, at + 3, at + 2);
  }
}

void put_road(CdrWriter& writer, const RoadLines& road) {
  begin_entity(writer, "map", "road", false);
  put_empty(writer, 4);
  writer.count(2);
  put_line(writer, road.left);
  put_line(writer, road.right);
  writer.count(1);
  put_surface(writer, road);
  put_empty(writer, 2);
}

/// Body, cabin and wheels of a car. Sizes without a parameter are chosen shares of the wheelbase.
std::vector<Cube> parts_of(const model::VehicleParams& car) {
  const double wheelbase = car.front_axle + car.rear_axle;
  const double wheel = 0.24 * wheelbase, low = 0.12 * wheelbase, tall = 0.2 * wheelbase;
  std::vector<Cube> parts{
      {0.5 * wheelbase, 0.0, low + 0.5 * tall, car.length, 0.92 * car.width, tall, kBody},
      {0.4 * wheelbase, 0.0, low + 1.4 * tall, 0.42 * car.length, 0.75 * car.width, 0.8 * tall, kCabin}};
  for (const double x : {0.0, wheelbase}) {
    for (const double side : {-0.5, 0.5})
      parts.push_back({x, side * car.track_width, 0.5 * wheel, wheel, car.tire_width, wheel, kTire});
  }
  return parts;
}

void put_car(CdrWriter& writer, const model::VehicleParams& car) {
  begin_entity(writer, "base_link", "car", true);
  const std::vector<Cube> parts = parts_of(car);
  put_empty(writer, 1);
  writer.count(parts.size());
  for (const Cube& part : parts) {
    writer.put(part.x, part.y, part.z).orientation(0.0).put(part.length, part.width, part.height);
    put_colour(writer, part.colour);
  }
  put_empty(writer, 6);
}

}  // namespace

std::string encode_scene(const telemetry::Frame& /*frame*/, const Run& run) {
  const std::size_t points = run.road.left.size() + run.road.right.size();
  CdrWriter writer{4096 + 80 * points};
  writer.count(0).count(2);  // deletions, entities
  put_road(writer, run.road);
  put_car(writer, run.vehicle);
  return writer.bytes();
}

}  // namespace chicane::protocol
