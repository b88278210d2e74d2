// SPDX-License-Identifier: MIT
// The Udacity simulator's messages: parses telemetry and commands with a fault for each bad field, and writes
// them as the original does.
#include "chicane/protocol/udacity_codec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <tl/expected.hpp>

#include "chicane/base/compiler.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/option.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"

namespace chicane::protocol {
namespace {

// Wheel angle at a steering command of ±1 [rad] (CarController.cs, m_MaximumSteerAngle).
constexpr double kSteerUnit = degrees_to_radians(25.0);
constexpr double kMilesPerHour = 2.23693629;  // mph in 1 m/s (CarController.cs, CurrentSpeed)
constexpr std::size_t kMaxWords = 80;         // [byte] limit of received text in messages; chosen: one line

/// Allowed range of a number in messages. Chosen: wide enough for any world, narrow enough for arithmetic.
struct Range {
  double low;
  double high;
};
constexpr Range kPosition{-1e6, 1e6};  // [m]
constexpr Range kAngle{-1e3, 1e3};     // [rad]
constexpr Range kSpeed{0.0, 1e3};      // [mph]
constexpr Range kSteer{-1.6, 1.6};     // [rad]
constexpr Range kThrottle{-1.0, 1.0};

/// Allowed ranges of a stop plan's point: after_s, distance_m, speed_mps, steering_angle, throttle.
constexpr std::array<Range, 5> kStopPoint{
    Range{0.0, 60.0}, {0.0, 1e4}, {0.0, 450.0}, {-1.0, 1.0}, {-1.0, 1.0}};
constexpr Range kStopBegins{0.0, 5.0};  // [s] of the first point; chosen: a later stop would be none

/// Received value for an error message: short, printable, valid UTF-8.
std::string shown(const Json& value) {
  if (value.is_discarded()) return "nothing";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  if (value.is_object()) return "an object";
  std::string text = json_text(value, JsonLayout::kAscii);
  if (text.size() <= kMaxWords) return text;
  return fmt::format("{}…", std::string_view(text).substr(0, kMaxWords));
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

UdacityBroken unexpected(std::string_view field, const Json& value, std::string_view expected) {
  return {fmt::format("{}: got {}, expected {}", field, shown(value), expected)};
}

/// Whether a text has decimal commas, `"x":-40,62`: a number after a key, then a comma and a digit.
bool has_decimal_comma(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t i = text.find("\":"); i != std::string_view::npos; i = text.find("\":", i + 1)) {
    std::size_t k = i + 2;
    if (k < text.size() && text[k] == '-') ++k;
    const std::size_t first = k;
    while (k < text.size() && is_digit(text[k])) ++k;
    if (k > first && k + 1 < text.size() && text[k] == ',' && is_digit(text[k + 1])) return true;
  }
  return false;
}

/// Word that a malformed JSON text has in place of a number: "speed: got NaN", "ptsx[1]: got Infinity". Empty
/// if it has none.
std::string bare_word(std::string_view text) {
  static constexpr std::array<std::string_view, 9> kWords{"NaN", "nan",       "Infinity", "infinity", "Inf",
                                                          "inf", "undefined", "None",     "Nan"};
  std::string key;
  std::string last_text;
  int index = -1;  // index in an array of numbers
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      const std::size_t end = std::min(text.find('"', i + 1), text.size());
      last_text = text.substr(i + 1, end - i - 1);
      i = end;
    } else if (c == ':') {
      key = last_text;
      index = -1;
    } else if (c == '[') {
      index = 0;
    } else if (c == ',' && index >= 0) {
      ++index;
    } else if (c == ']') {
      index = -1;
    } else if (is_letter(c)) {
      std::size_t end = i;
      while (end < text.size() && is_letter(text[end])) ++end;
      const std::string_view word = text.substr(i, end - i);
      if (std::find(kWords.begin(), kWords.end(), word) != kWords.end()) {
        const std::string_view sign = i > 0 && text[i - 1] == '-' ? "-" : "";
        const std::string place = index >= 0 ? fmt::format("{}[{}]", key, index) : key;
        return fmt::format("{}: got {}{}, expected a number", printable(place), sign, word.substr(0, 20));
      }
      i = end - 1;
    }
  }
  return "";
}

/// Event of Socket.IO.
struct Event {
  std::string name;
  Json payload;  // discarded when there is none
};

/// Parses `["name",payload]`, after the packet digits and an optional acknowledgement number.
tl::expected<Event, UdacityBroken> parse_event(std::string_view text) {
  const std::size_t start = text.find_first_not_of("0123456789");
  if (start == std::string_view::npos || text[start] != '[')
    return tl::unexpected(UdacityBroken{"the event is no array"});
  tl::expected<Json, JsonError> read = read_json(text.substr(start));
  if (!read && read.error().byte) {
    if (has_decimal_comma(text)) {
      return tl::unexpected(
          UdacityBroken{"decimal comma: the simulator runs with a comma locale; start it with LC_NUMERIC=C"});
    }
    if (std::string word = bare_word(text.substr(start)); !word.empty())
      return tl::unexpected(UdacityBroken{std::move(word)});
    return tl::unexpected(UdacityBroken{fmt::format("not JSON at byte {}", *read.error().byte + start)});
  }
  if (!read) return tl::unexpected(UdacityBroken{"a number is too large for JSON"});
  Json& array = *read;
  if (array.empty() || array.size() > 2 || !array[0].is_string()) {
    return tl::unexpected(UdacityBroken{"the event is not an array of a name and one value"});
  }
  Event event{array[0].get<std::string>(),
              array.size() == 2 ? std::move(array[1]) : Json(Json::value_t::discarded)};
  return event;
}

/// Parses a packet that is no event; nullopt for an event.
std::optional<std::variant<UdacityPacket, UdacityBroken>> parse_packet(std::string_view text) {
  if (text.size() > kMaxUdacityMessage) {
    return UdacityBroken{fmt::format("{} bytes, expected at most {}", text.size(), kMaxUdacityMessage),
                         false};
  }
  if (text.empty()) return UdacityBroken{"an empty message", false};
  if (text.starts_with("42")) return std::nullopt;
  if (text.starts_with("40")) return UdacityPacket::kConnect;
  if (text.starts_with("41")) return UdacityPacket::kDisconnect;
  switch (text[0]) {
    case '0':
      return UdacityPacket::kOpen;
    case '1':
      return UdacityPacket::kClose;
    case '2':
      return UdacityPacket::kPing;
    case '3':
      return UdacityPacket::kPong;
    default:
      break;
  }
  if (text[0] >= '4' && text[0] <= '9') return UdacityPacket::kIgnored;
  return UdacityBroken{"the message does not begin with a digit", false};
}

/// Names the scene of the simulator collection that sends such keys (templates of udacity/CarND-*).
std::optional<UdacityForeign> foreign_scene(const Json& data) {
  struct Scene {
    const char* key;
    const char* name;
  };
  constexpr std::array kScenes{
      Scene{"sensor_fusion", "Path Planning"},
      Scene{"sensor_measurement", "Kalman Filters"},
      Scene{"sense_observations_x", "Kidnapped Vehicle"},
      Scene{"cte", "PID Controller"},
      Scene{"velocity", "System Integration"},
      Scene{"image", "Behavioral Cloning"},
  };
  if (data.contains("ptsx") || data.contains("psi")) return std::nullopt;
  for (const Scene& scene : kScenes) {
    if (data.contains(scene.key)) {
      return UdacityForeign{
          true, fmt::format("the telemetry of the scene '{}'; choose 'MPC Controller' in the simulator",
                            scene.name)};
    }
  }
  return std::nullopt;
}

/// Reader of the numbers of an object. Stores the first fault.
class FieldReader {
 public:
  explicit FieldReader(const Json& data) : data_{data} {}

  /// Number of a field; 0 after a fault.
  double number(const std::string& key, const Range& range) {
    const Json* value = find(key);
    return value == nullptr ? 0.0 : checked(key, *value, range);
  }

  /// Numbers of an array of at most `capacity`.
  std::vector<double> numbers(const char* key, std::size_t capacity, const Range& range) {
    const Json* value = find(key);
    if (value == nullptr) return {};
    if (!value->is_array() || value->size() > capacity) {
      refuse(unexpected(key, *value, fmt::format("an array of at most {} numbers", capacity)));
      return {};
    }
    std::vector<double> result;
    result.reserve(value->size());
    for (const Json& element : *value) {
      result.push_back(checked(fmt::format("{}[{}]", key, result.size()), element, range));
    }
    return result;
  }

  /// Line of two lists, read as the original does: point by point, *_y at each index of *_x. A value that is
  /// no list has no points; an object counts as the list of its values.
  std::vector<Vec2> line(const char* x_key, const char* y_key, const Range& range) {
    std::vector<Vec2> points;
    const Json* xs = find(x_key);
    if (xs == nullptr || !xs->is_structured() || xs->empty()) return points;  // *_y is not read then
    const Json* ys = find(y_key);
    if (ys == nullptr) return points;
    const std::size_t size = ys->is_structured() ? ys->size() : 0;
    if (size < xs->size()) {
      refuse({fmt::format("{} has {} points, {} only {}", x_key, xs->size(), y_key, size)});
      return points;
    }
    points.reserve(xs->size());
    auto y = ys->begin();
    for (auto x = xs->begin(); x != xs->end() && !broken_; ++x, ++y) {
      const std::size_t i = points.size();
      points.emplace_back(checked(fmt::format("{}[{}]", x_key, i), *x, range),
                          checked(fmt::format("{}[{}]", y_key, i), *y, range));
    }
    return points;
  }

  /// Rows of a table of at most `capacity`; empty if there is no such field.
  template <std::size_t kColumns>
  std::vector<std::array<double, kColumns>> rows(const char* key, std::size_t capacity,
                                                 const std::array<Range, kColumns>& ranges) {
    std::vector<std::array<double, kColumns>> result;
    const auto found = data_.find(key);
    if (found == data_.end()) return result;
    if (!found->is_array() || found->size() > capacity) {
      refuse(unexpected(key, *found, fmt::format("an array of at most {} points", capacity)));
      return result;
    }
    result.reserve(found->size());
    for (const Json& row : *found) {
      const std::string name = fmt::format("{}[{}]", key, result.size());
      if (!row.is_array() || row.size() != kColumns) {
        refuse(unexpected(name, row, fmt::format("an array of {} numbers", kColumns)));
        return result;
      }
      std::array<double, kColumns>& numbers = result.emplace_back();
      for (std::size_t i = 0; i < kColumns; ++i)
        numbers[i] = checked(fmt::format("{}[{}]", name, i), row[i], ranges[i]);
    }
    return result;
  }

  void refuse(UdacityBroken broken) {
    if (!broken_) broken_ = std::move(broken);
  }
  [[nodiscard]] const std::optional<UdacityBroken>& broken() const { return broken_; }

 private:
  const Json* find(const std::string& key) {
    const auto found = data_.find(key);
    if (found != data_.end()) return &*found;
    refuse({fmt::format("{}: missing", key)});
    return nullptr;
  }

  /// The value if it is a number in range; else 0 and a fault.
  double checked(std::string_view key, const Json& value, const Range& range) {
    if (!value.is_number()) {
      refuse(unexpected(key, value, "a number"));
      return 0.0;
    }
    const double number = value.get<double>();
    if (const std::optional<double> inside = within(number, range.low, range.high)) return *inside;
    refuse(unexpected(key, value, fmt::format("a number in [{}, {}]", range.low, range.high)));
    return 0.0;
  }

  const Json& data_;
  std::optional<UdacityBroken> broken_;  ///< first fault
};

UdacityTelemetry read_measurement(const Json& data, const std::string& time_field) {
  FieldReader fields(data);
  const std::vector<double> xs = fields.numbers("ptsx", model::Measurement::kMaxWaypoints, kPosition);
  const std::vector<double> ys = fields.numbers("ptsy", model::Measurement::kMaxWaypoints, kPosition);
  model::Measurement measurement;
  measurement.psi = fields.number("psi", kAngle);
  measurement.x = fields.number("x", kPosition);
  measurement.y = fields.number("y", kPosition);
  measurement.steer = 0.0 - fields.number("steering_angle", kSteer);
  measurement.throttle = fields.number("throttle", kThrottle);
  measurement.speed = mph_to_mps(fields.number("speed", kSpeed));
  if (!time_field.empty()) measurement.time = fields.number(time_field, {0.0, 1e10});
  if (xs.size() != ys.size())
    fields.refuse({fmt::format("ptsx has {} points, ptsy {}", xs.size(), ys.size())});
  if (fields.broken()) return *fields.broken();
  measurement.waypoint_count = static_cast<int>(xs.size());
  for (std::size_t i = 0; i < xs.size(); ++i) measurement.waypoints[i] = Vec2{xs[i], ys[i]};
  return measurement;
}

/// Texts `[x0,x1,…]` and `[y0,y1,…]` of a line.
struct LineText {
  std::string x = "[";
  std::string y = "[";
};

/// Texts of a line of `size` points, in the frame of `pose`.
template <class PointAt>
LineText encode_line(int size, const model::Pose& pose, PointAt point_at) {
  LineText line;
  const double c = cos(pose.psi);
  const double s = sin(pose.psi);
  const int stride = std::max(1, (size + kMaxUdacityLine - 1) / kMaxUdacityLine);
  for (int i = 0; i < size; i += stride) {
    const Vec2 point = point_at(static_cast<std::size_t>(i));
    const double dx = point.x() - pose.x;
    const double dy = point.y() - pose.y;
    const double x = c * dx + s * dy;
    const double y = c * dy - s * dx;
    if (!(std::abs(x) <= kPosition.high && std::abs(y) <= kPosition.high)) break;
    const char* separator = i == 0 ? "" : ",";
    line.x += fmt::format("{}{:.3f}", separator, x);
    line.y += fmt::format("{}{:.3f}", separator, y);
  }
  line.x += ']';
  line.y += ']';
  return line;
}

/// Finite value in [-1, 1] that never prints as "-0".
double normalised(double value) {
  CHICANE_ASSERT(std::isfinite(value));
  return std::isfinite(value) ? std::clamp(value, -1.0, 1.0) + 0.0 : 0.0;
}

/// Stop plan of a reply.
safety::StopPlan read_stop(FieldReader& fields) {
  constexpr const char* kKey = "stop_plan";
  const auto rows = fields.rows(kKey, kMaxUdacityStop, kStopPoint);
  safety::StopPlan stop;
  for (const auto& [after, distance, speed, steer, throttle] : rows) {
    if (stop.size == 0 && after > kStopBegins.high)
      fields.refuse(
          {fmt::format("{}: begins after {} s, expected at most {}", kKey, after, kStopBegins.high)});
    if (stop.size > 0) {
      const safety::StopPoint& before = stop.points[static_cast<std::size_t>(stop.size - 1)];
      if (after < before.time || distance < before.distance)
        fields.refuse({fmt::format("{}[{}]: time and distance must not fall", kKey, stop.size)});
    }
    stop.points[static_cast<std::size_t>(stop.size++)] = {
        after, distance, speed, {.steer = 0.0 - steer * kSteerUnit, .throttle = throttle}};
  }
  return stop;
}

/// Field `"stop_plan":[…],` of a reply; empty without a plan.
std::string encode_stop(const safety::StopPlan& stop, double sampled) {
  const int size = std::clamp(stop.size, 0, safety::StopPlan::kCapacity);
  const int sent = std::min(size, kMaxUdacityStop);
  const auto rounded = [](double value, double unit) { return std::round(value / unit) * unit + 0.0; };
  std::string text;
  for (int k = 0; k < sent; ++k) {
    const int i = sent < 2 ? 0 : k * (size - 1) / (sent - 1);  // includes the first and the last
    const safety::StopPoint& point = stop.points[static_cast<std::size_t>(i)];
    const std::array numbers{point.time - sampled, point.distance, point.speed,
                             -point.command.steer / kSteerUnit, point.command.throttle};
    constexpr std::array kUnits{1e-3, 1e-3, 1e-3, 1e-4, 1e-4};  // resolution of each column
    text += k == 0 ? "[" : ",[";
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      if (!std::isfinite(numbers[n])) return {};
      const double value = std::clamp(numbers[n], kStopPoint[n].low, kStopPoint[n].high);
      text += fmt::format("{}{:.6g}", n == 0 ? "" : ",", rounded(value, kUnits[n]));
    }
    text += ']';
  }
  return text.empty() ? text : fmt::format(R"("stop_plan":[{}],)", text);
}

/// Angle in [0, 2π), as the original sends angles.
double full_turn(double angle) {
  const double wrapped = wrap_angle(angle);
  return wrapped < 0.0 ? wrapped + kTwoPi : wrapped;
}

/// Number as C# prints a float: at most 7 significant digits.
std::string as_float(double value) { return fmt::format("{:.7G}", static_cast<float>(value + 0.0)); }

}  // namespace

UdacityTelemetry parse_telemetry(std::string_view text, const std::string& time_field) {
  if (auto packet = parse_packet(text)) {
    return std::visit([](auto& alternative) -> UdacityTelemetry { return std::move(alternative); }, *packet);
  }
  const auto event = parse_event(text);
  if (!event) return event.error();
  if (event->name != "telemetry")
    return UdacityForeign{false, fmt::format("the event {}", shown(event->name))};
  if (event->payload.is_null()) return UdacityManual{};
  if (event->payload.is_discarded()) return UdacityBroken{"telemetry: without data"};
  if (!event->payload.is_object()) return unexpected("telemetry", event->payload, "an object or null");
  if (auto foreign = foreign_scene(event->payload)) return *foreign;
  return read_measurement(event->payload, time_field);
}

std::string encode_steer(const model::Command& command, const controller::Plan& plan, const model::Pose& pose,
                         const safety::StopPlan& stop, double sampled) {
  const LineText mpc = encode_line(plan.size, pose, [&](std::size_t i) {
    return Vec2{plan.points[i].x, plan.points[i].y};
  });
  const LineText next =
      encode_line(plan.reference_size, pose, [&](std::size_t i) { return plan.reference[i]; });
  return fmt::format(
      R"(42["steer",{{"mpc_x":{},"mpc_y":{},"next_x":{},"next_y":{},"steering_angle":{},{}"throttle":{}}}])",
      mpc.x, mpc.y, next.x, next.y, normalised(-command.steer / kSteerUnit), encode_stop(stop, sampled),
      normalised(command.throttle));
}

std::string encode_manual() { return R"(42["manual",{}])"; }

UdacityReply parse_reply(std::string_view text) {
  if (auto packet = parse_packet(text)) {
    return std::visit([](auto& alternative) -> UdacityReply { return std::move(alternative); }, *packet);
  }
  const auto event = parse_event(text);
  if (!event) return event.error();
  if (event->name == "manual") return UdacityManual{};
  if (event->name != "steer")
    return UdacityBroken{fmt::format("event: got {}, expected \"steer\"", shown(event->name))};
  if (!event->payload.is_object()) return unexpected("steer", event->payload, "an object");
  constexpr Range kAnything{-3.4e38, 3.4e38};  // a larger number does not fit the original's float
  FieldReader fields(event->payload);
  UdacitySteer steer;
  const auto share = [&](const char* key) {
    const double number = fields.number(key, kAnything);
    if (!within(number, -1.0, 1.0) && steer.clamped.empty())
      steer.clamped = fmt::format("{}: got {:g}, expected a number in [-1, 1]", key, number);
    return std::clamp(number, -1.0, 1.0);
  };
  steer.command.steer = 0.0 - share("steering_angle") * kSteerUnit;
  steer.command.throttle = share("throttle");
  steer.reference = fields.line("next_x", "next_y", kAnything);
  steer.plan = fields.line("mpc_x", "mpc_y", kAnything);
  steer.stop = read_stop(fields);
  if (fields.broken()) return *fields.broken();
  return steer;
}

std::string encode_telemetry(const model::Measurement& measurement) {
  std::string xs;
  std::string ys;
  for (std::size_t i = 0; i < static_cast<std::size_t>(measurement.waypoint_count); ++i) {
    const char* separator = i == 0 ? "" : ",";
    xs += fmt::format("{}{}", separator, as_float(measurement.waypoints[i].x()));
    ys += fmt::format("{}{}", separator, as_float(measurement.waypoints[i].y()));
  }
  return fmt::format(R"(42["telemetry",{{"ptsx":[{}],"ptsy":[{}],"psi_unity":{},"psi":{},"x":{},"y":{},)"
                     R"("steering_angle":{},"throttle":{},"speed":{}}}])",
                     xs, ys, as_float(full_turn(0.5 * kPi - measurement.psi)),
                     as_float(full_turn(measurement.psi)), as_float(measurement.x), as_float(measurement.y),
                     as_float(0.0 - measurement.steer), as_float(std::clamp(measurement.throttle, 0.0, 1.0)),
                     as_float(measurement.speed * kMilesPerHour));
}

std::string encode_manual_telemetry() { return R"(42["telemetry",null])"; }

}  // namespace chicane::protocol
