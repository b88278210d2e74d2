// SPDX-License-Identifier: MIT
// Pictures of a drive: reads a recorded run, and draws road, car and ghost with speed, times and gaps as
// text.
#include "chicane/recording/lap_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"
#include "chicane/recording/detail/ros_message.hpp"
#include "chicane/telemetry/mcap.hpp"

namespace chicane::recording {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
// Limit of control steps read; chosen: 44 hours at 25 a second.
constexpr std::size_t kMostMoments = 4'000'000;
constexpr double kFarApart = 100.0;  // [m] distance between two steps beyond which a car was placed; chosen

/// Points from two fields of a message.
std::vector<Vec2> points_of(const RosContent& message, std::string_view x, std::string_view y) {
  const std::vector<double>& xs = message.list(x);
  const std::vector<double>& ys = message.list(y);
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < std::min(xs.size(), ys.size()); ++i) points.emplace_back(xs[i], ys[i]);
  return points;
}

/// Collects the last run of a recording.
class RunReader {
 public:
  Result<void> add(const telemetry::McapMessage& message) {
    const std::string& topic = message.channel.topic;
    const bool is_wanted = topic == "/chicane/frame" || topic == "/chicane/plan" || topic == "/chicane/run" ||
                           topic == "/chicane/lap" || topic == "/track/left" || topic == "/track/right";
    if (!is_wanted) return {};
    const Result<RosContent> content = readers_.read(message);
    if (!content) return fail(content.error());
    if (topic == "/chicane/frame") add_frame(*content);
    if (topic == "/chicane/plan") add_plan(*content);
    if (topic == "/chicane/run") add_run(*content);
    if (topic == "/chicane/lap") run_.last_lap = static_cast<int>(content->number("lap"));
    if (topic == "/track/left")
      run_.left = points_of(*content, "poses.pose.position.x", "poses.pose.position.y");
    if (topic == "/track/right")
      run_.right = points_of(*content, "poses.pose.position.x", "poses.pose.position.y");
    return {};
  }

  [[nodiscard]] DrivenRun take() { return std::move(run_); }

 private:
  void add_frame(const RosContent& frame) {
    DrivenMoment moment;
    moment.time = frame.number("time_s");
    // A time that falls begins another run of the recording: keep the last run only.
    if (!run_.moments.empty() && moment.time < run_.moments.back().time) {
      run_.moments.clear();
      run_.last_lap = 0;
    }
    if (run_.moments.size() >= kMostMoments) return;
    const bool has_truth = frame.number("has_truth") != 0.0;
    moment.position = has_truth ? Vec2{frame.number("x_m"), frame.number("y_m")}
                                : Vec2{frame.number("measured_x_m"), frame.number("measured_y_m")};
    moment.heading = frame.number(has_truth ? "yaw_rad" : "measured_yaw_rad");
    moment.speed = frame.number("speed_mps", frame.number("measured_speed_mps"));
    moment.steer = frame.number("steer_sent_rad");
    moment.throttle = frame.number("throttle_sent");
    moment.lap = static_cast<int>(frame.number("lap"));
    moment.lap_time = frame.number("lap_time_s");
    moment.s = frame.number("s_m", kUnknown);
    moment.edge_distance = frame.number("edge_distance_m", kUnknown);
    moment.is_off_track = frame.number("is_off_track") != 0.0;
    const bool is_drawable = std::isfinite(moment.position.x() + moment.position.y() + moment.heading);
    if (is_drawable) run_.moments.push_back(std::move(moment));
  }

  void add_plan(const RosContent& plan) {
    if (run_.moments.empty()) return;
    run_.moments.back().plan = points_of(plan, "x_m", "y_m");
    run_.moments.back().plan_speed = plan.list("speed_mps");
  }

  void add_run(const RosContent& run) {
    run_.track = run.text("track");
    run_.controller = run.text("controller");
    run_.preset = run.text("preset");
    run_.track_length = run.number("track_length_m");
    run_.is_closed = run.number("is_closed", 1.0) != 0.0;
    const double length = run.number("body_length_m", 4.5);
    const double axles = run.number("front_axle_m") + run.number("rear_axle_m");
    const double overhang = std::max(0.0, 0.5 * (length - axles));
    run_.front = run.number("front_axle_m", 1.4) + overhang;
    run_.rear = run.number("rear_axle_m", 1.4) + overhang;
    run_.width = run.number("body_width_m", 1.9);
    run_.steer_limit = std::max(run.number("steer_limit_rad", 0.4), 0.05);
  }

  DrivenRun run_;
  RosReaders readers_;
};

}  // namespace

std::vector<DrivenMoment> DrivenRun::of_lap(int lap) const {
  std::vector<DrivenMoment> chosen;
  std::copy_if(moments.begin(), moments.end(), std::back_inserter(chosen),
               [&](const DrivenMoment& moment) { return lap == 0 || moment.lap == lap - 1; });
  return chosen;
}

Result<DrivenRun> read_run(const std::string& recording) {
  RunReader reader;
  std::optional<Error> failure;
  telemetry::McapVisitor visitor;
  visitor.on_message = [&](const telemetry::McapMessage& message) {
    if (failure) return;
    if (const Result<void> added = reader.add(message); !added) failure = added.error();
  };
  const Result<telemetry::McapReport> read = telemetry::read_mcap(recording, visitor);
  if (!read) return fail(read.error());
  if (failure) return fail(failure->code, fmt::format("{}: {}", recording, failure->message));
  DrivenRun run = reader.take();
  if (run.moments.empty())
    return fail(ErrorCode::kParse, recording + ": got no control step, expected a recording of ours");
  return run;
}

namespace {

// Colours, chosen.
constexpr Colour kGround{17, 24, 32}, kRoad{44, 54, 66}, kEdge{150, 165, 180}, kCar{255, 176, 46},
    kGhost{120, 190, 255, 0.75}, kTrace{255, 176, 46, 0.35}, kWords{236, 240, 245}, kFaint{150, 165, 180},
    kBetter{90, 210, 130}, kWorse{255, 110, 100}, kPanel{17, 24, 32, 0.7};

/// Mixture of two colours; `share` of the second one.
Colour between(const Colour& a, const Colour& b, double share) {
  const auto mix = [&](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(std::lround(x + std::clamp(share, 0.0, 1.0) * (y - x)));
  };
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

/// Colour of a speed, from red for slow to green for fast; `share` of the top speed.
Colour of_speed(double share) {
  constexpr Colour kSlow{240, 80, 90}, kMiddle{250, 210, 80}, kFast{70, 220, 170};
  return share < 0.5 ? between(kSlow, kMiddle, 2.0 * share) : between(kMiddle, kFast, 2.0 * share - 1.0);
}

/// Moment at `time` [s] after the first one, interpolated between two moments. Values that cannot be
/// interpolated are those of the earlier one.
DrivenMoment moment_at(const std::vector<DrivenMoment>& moments, double time) {
  const double begin = moments.front().time;
  const auto next = std::upper_bound(moments.begin(), moments.end(), begin + time,
                                     [](double t, const DrivenMoment& moment) { return t < moment.time; });
  if (next == moments.begin()) return moments.front();
  DrivenMoment moment = *(next - 1);
  if (next == moments.end()) return moment;
  const double share = (begin + time - moment.time) / (next->time - moment.time);
  moment.position += share * (next->position - moment.position);
  moment.heading += share * angle_difference(next->heading, moment.heading);
  moment.speed += share * (next->speed - moment.speed);
  moment.lap_time += begin + time - moment.time;
  if (next->s > moment.s) moment.s += share * (next->s - moment.s);
  moment.time = begin + time;
  return moment;
}

/// First time after the start [s] at which a run was at `s` [m] in lap number `lap`, from 0; none if it never
/// was.
std::optional<double> time_at_place(const std::vector<DrivenMoment>& moments, double s, int lap) {
  for (std::size_t i = 0; i + 1 < moments.size(); ++i) {
    const DrivenMoment &a = moments[i], &b = moments[i + 1];
    const bool is_here = a.lap - moments.front().lap == lap && a.s <= s && s <= b.s && b.s - a.s < kFarApart;
    if (!is_here) continue;
    const double share = b.s > a.s ? (s - a.s) / (b.s - a.s) : 0.0;
    return a.time + share * (b.time - a.time) - moments.front().time;
  }
  return std::nullopt;
}

/// Time as minutes and seconds: "1:23.4".
std::string clock_text(double seconds) {
  return fmt::format("{}:{:04.1f}", static_cast<int>(seconds / 60.0),
                     std::floor(std::fmod(seconds, 60.0) * 10.0) / 10.0);
}

}  // namespace

LapPicture::LapPicture(const DrivenRun& run, std::vector<DrivenMoment> shown, std::vector<DrivenMoment> ghost,
                       const PictureOptions& options)
    : run_{run},
      shown_{std::move(shown)},
      ghost_{std::move(ghost)},
      options_{options},
      canvas_{options.width, options.height} {
  for (const DrivenMoment& moment : shown_) top_speed_ = std::max(top_speed_, moment.speed);
}

double LapPicture::duration() const {
  return shown_.empty() ? 0.0 : shown_.back().time - shown_.front().time;
}

std::optional<double> LapPicture::lost_to_ghost(double time) const {
  if (ghost_.empty() || shown_.empty()) return std::nullopt;
  const DrivenMoment moment = moment_at(shown_, time);
  if (!std::isfinite(moment.s)) return std::nullopt;
  const std::optional<double> other = time_at_place(ghost_, moment.s, moment.lap - shown_.front().lap);
  return other ? std::optional(time - *other) : std::nullopt;
}

Vec2 LapPicture::Camera::operator()(const Vec2& point) const {
  return {centre.x() + scale * (point.x() - middle.x()), centre.y() - scale * (point.y() - middle.y())};
}

// All shares and sizes of the drawing below are chosen by eye.
LapPicture::Camera LapPicture::whole(double x, double y, double width, double height) const {
  double left = 1e12, right = -1e12, low = 1e12, high = -1e12;
  const auto extend = [&](const Vec2& point) {
    left = std::min(left, point.x());
    right = std::max(right, point.x());
    low = std::min(low, point.y());
    high = std::max(high, point.y());
  };
  for (const Vec2& point : run_.left) extend(point);
  for (const Vec2& point : run_.right) extend(point);
  for (const DrivenMoment& moment : shown_) extend(moment.position);
  return {{0.5 * (left + right), 0.5 * (low + high)},
          std::min(width / std::max(right - left, 1.0), height / std::max(high - low, 1.0)),
          {x + 0.5 * width, y + 0.5 * height}};
}

void LapPicture::draw_road(const Camera& camera, double edge) {
  std::vector<Vec2> left, right;
  for (const Vec2& point : run_.left) left.push_back(camera(point));
  for (const Vec2& point : run_.right) right.push_back(camera(point));
  if (left.size() < 2 || right.size() < 2) return;
  std::vector<Vec2> back(right.rbegin(), right.rend());
  if (run_.is_closed) {
    canvas_.fill({left, back}, kRoad);
  } else {
    std::vector<Vec2> ring = left;
    ring.insert(ring.end(), back.begin(), back.end());
    canvas_.fill({ring}, kRoad);
  }
  canvas_.line(left, edge, kEdge);
  canvas_.line(right, edge, kEdge);
}

void LapPicture::draw_car(const Camera& camera, const DrivenMoment& moment, const Colour& colour) {
  constexpr double kSmallest = 9.0;  // [px] least length of a drawn car
  const double grown = std::max(1.0, kSmallest / (camera.scale * (run_.front + run_.rear)));
  const Vec2 ahead{cos(moment.heading), sin(moment.heading)};
  const Vec2 across{-ahead.y(), ahead.x()};
  const auto place = [&](double along, double side) {
    return camera(moment.position + grown * along * ahead + grown * side * across);
  };
  const double half = 0.5 * run_.width, nose = 0.6 * half;
  canvas_.fill({{place(run_.front, nose), place(0.8 * run_.front, half), place(-0.9 * run_.rear, half),
                 place(-run_.rear, 0.8 * half), place(-run_.rear, -0.8 * half),
                 place(-0.9 * run_.rear, -half), place(0.8 * run_.front, -half), place(run_.front, -nose)}},
               colour);
  if (grown > 1.0) return;  // too small for windscreen and wheels
  canvas_.fill({{place(0.35 * run_.front, 0.7 * half), place(0.1 * run_.front, 0.75 * half),
                 place(0.1 * run_.front, -0.75 * half), place(0.35 * run_.front, -0.7 * half)}},
               kGround);
  for (const double side : {half, -half}) {
    const double turned = moment.heading + moment.steer;
    const Vec2 hub = moment.position + 0.6 * run_.front * ahead + side * across;
    const Vec2 way{0.4 * cos(turned), 0.4 * sin(turned)};
    canvas_.line(std::array{camera(hub - way), camera(hub + way)}, 0.35 * camera.scale, kGround);
  }
}

void LapPicture::draw_plan(const Camera& camera, const DrivenMoment& moment) {
  for (std::size_t i = 0; i + 1 < moment.plan.size(); ++i) {
    const double speed = i < moment.plan_speed.size() ? moment.plan_speed[i] : moment.speed;
    canvas_.line(std::array{camera(moment.plan[i]), camera(moment.plan[i + 1])},
                 std::max(2.0, 0.45 * camera.scale), of_speed(speed / top_speed_));
  }
}

void LapPicture::draw_trace(const Camera& camera, double time) {
  std::vector<Vec2> way;
  for (const DrivenMoment& moment : shown_) {
    if (moment.time > shown_.front().time + time) break;
    way.push_back(camera(moment.position));
  }
  canvas_.line(way, std::max(1.5, 0.25 * camera.scale), kTrace);
}

void LapPicture::draw_map(const DrivenMoment& moment, const std::optional<DrivenMoment>& other) {
  const double size = 0.3 * canvas_.height();
  const double x = canvas_.width() - 1.3 * size, y = 0.04 * canvas_.height();
  canvas_.rectangle(x - 0.05 * size, y - 0.05 * size, 1.3 * size, 1.1 * size, kPanel);
  const Camera camera = whole(x, y, 1.2 * size, size);
  draw_road(camera, 1.0);
  const double radius = std::max(2.5, 0.03 * size);
  if (other) canvas_.disc(camera(other->position), radius, kGhost);
  canvas_.disc(camera(moment.position), radius, kCar);
}

std::optional<double> LapPicture::progress(const DrivenMoment& moment) const {
  const auto first = std::find_if(shown_.begin(), shown_.end(),
                                  [&](const DrivenMoment& each) { return each.lap == moment.lap; });
  if (first == shown_.end() || !(run_.track_length > 0.0) || !std::isfinite(moment.s - first->s))
    return std::nullopt;
  const double driven = moment.s - first->s;
  return (driven < 0.0 ? driven + run_.track_length : driven) / run_.track_length;
}

void LapPicture::draw_words(const DrivenMoment& moment, double time) {
  const double unit = canvas_.height() / 36.0, left = 1.2 * unit;
  canvas_.rectangle(0.0, 0.0, 13.5 * unit, 8.6 * unit, kPanel);
  const double end =
      canvas_.text(left, 3.4 * unit, 2.2 * unit, fmt::format("{:.0f}", mps_to_mph(moment.speed)), kWords);
  canvas_.text(end, 3.4 * unit, unit, "mph", kFaint);
  canvas_.text(left, 5.4 * unit, unit, fmt::format("lap {}  {}", moment.lap + 1, clock_text(moment.lap_time)),
               kWords);
  if (const std::optional<double> lost = lost_to_ghost(time))
    canvas_.text(left, 7.4 * unit, unit, fmt::format("{:+.2f} s", *lost), *lost > 0.0 ? kWorse : kBetter);
  if (moment.is_off_track)
    canvas_.text(0.5 * (canvas_.width() - Canvas::text_width(1.6 * unit, "off the road")), 4.0 * unit,
                 1.6 * unit, "off the road", kWorse);
  const double base = canvas_.height() - 1.2 * unit;
  canvas_.text(left, base - 0.8 * unit, 0.8 * unit,
               fmt::format("{}  {}", run_.preset.empty() ? run_.controller : run_.preset, run_.track),
               kFaint);
  const std::optional<double> share = progress(moment);
  if (!share) return;
  canvas_.rectangle(0.0, base + 0.7 * unit, canvas_.width(), 0.5 * unit, kRoad);
  canvas_.rectangle(0.0, base + 0.7 * unit, *share * canvas_.width(), 0.5 * unit, kCar);
}

const Canvas& LapPicture::at(double time) {
  time = std::clamp(time, 0.0, duration());
  canvas_.clear(kGround);
  if (shown_.empty()) return canvas_;
  const DrivenMoment moment = moment_at(shown_, time);
  std::optional<DrivenMoment> other;
  if (!ghost_.empty()) other = moment_at(ghost_, time);
  const double margin = 0.06 * canvas_.height();
  const double scale = canvas_.width() / options_.view;
  const Camera camera =
      options_.shows_whole
          ? whole(margin, margin, canvas_.width() - 2.0 * margin, canvas_.height() - 2.0 * margin)
          : Camera{moment.position + 0.16 * options_.view * Vec2{cos(moment.heading), sin(moment.heading)},
                   scale,
                   {0.5 * canvas_.width(), 0.55 * canvas_.height()}};
  draw_road(camera, std::max(1.0, 0.2 * camera.scale));
  draw_trace(camera, time);
  draw_plan(camera, moment);
  if (other) draw_car(camera, *other, kGhost);
  draw_car(camera, moment, kCar);
  if (!options_.shows_whole) draw_map(moment, other);
  draw_words(moment, time);
  return canvas_;
}

}  // namespace chicane::recording
