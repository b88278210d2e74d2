// SPDX-License-Identifier: MIT
#include "chicane/recording/driven_lap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "chicane/recording/detail/ros_message.hpp"
#include "chicane/telemetry/mcap_reader.hpp"

namespace chicane::recording {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostMoments = 4'000'000;

std::vector<Vec2> points_of(const RosContent& message, std::string_view x, std::string_view y) {
  const std::vector<double>& xs = message.list(x);
  const std::vector<double>& ys = message.list(y);
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < std::min(xs.size(), ys.size()); ++i) points.emplace_back(xs[i], ys[i]);
  return points;
}

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
    // Another run of the same recording begins: only the last one is kept.
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

}  // namespace chicane::recording
