// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "chicane/protocol/ros_messages.hpp"
#include "chicane/road/track.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::demo {

/// A winding closed road of about 1.3 km, drawn by hand for viewer tests.
inline std::vector<road::TrackPoint> road_points() {
  std::vector<road::TrackPoint> points;
  for (int i = 0; i < 240; ++i) {
    const double angle = 2.0 * M_PI * i / 240.0;
    const double radius = 170.0 + 42.0 * std::sin(2.0 * angle + 0.4) + 24.0 * std::sin(3.0 * angle) +
                          9.0 * std::sin(7.0 * angle);
    points.push_back({{1.25 * radius * std::cos(angle), radius * std::sin(angle)}, 5.0, 5.0});
  }
  return points;
}

/// Not a simulator: a car on rails that fills every field of a frame with plausible, moving numbers, so that
/// viewers have something to show without a plant and a controller. Deterministic: the frame is a function of
/// the step count.
class Drive {
 public:
  Drive(const road::Track& track, double period) : track_{track}, period_{period} { reset(); }

  void reset() {
    frame_ = {};
    s_ = 0.0;
    speed_ = 0.0;
    lap_start_ = 0.0;
    fill(0.0);
  }

  const telemetry::Frame& step() {
    ++frame_.cycle;
    frame_.time = period_ * static_cast<double>(frame_.cycle);
    const double change = std::clamp(wanted(s_) - speed_, -9.0 * period_, 5.0 * period_);
    speed_ += change;
    s_ += speed_ * period_;
    if (s_ >= length()) {
      s_ -= length();
      ++frame_.lap;
      frame_.last_lap_time = frame_.time - lap_start_;
      lap_start_ = frame_.time;
    }
    fill(change / period_);
    return frame_;
  }

  [[nodiscard]] const telemetry::Frame& frame() const { return frame_; }

 private:
  [[nodiscard]] double length() const { return track_.centre().length(); }
  [[nodiscard]] double offset(double s) const { return 1.4 * std::sin(2.0 * M_PI * 9.0 * s / length()); }
  /// Speed for 9 m/s² at the tightest of the next 40 m.
  [[nodiscard]] double wanted(double s) const {
    double curvature = 1e-3;
    for (double ahead = 0.0; ahead <= 40.0; ahead += 4.0) {
      curvature = std::max(curvature, std::abs(track_.centre().at(s + ahead).curvature));
    }
    return std::min(46.0, std::sqrt(9.0 / curvature));
  }
  [[nodiscard]] model::Pose pose(double s) const {
    const road::PathPoint at = track_.centre().at(s);
    const double d = offset(s);
    const double slope = 1.4 * 2.0 * M_PI * 9.0 / length() * std::cos(2.0 * M_PI * 9.0 * s / length());
    return {at.position.x() - d * std::sin(at.heading), at.position.y() + d * std::cos(at.heading),
            at.heading + std::atan(slope)};
  }
  [[nodiscard]] double steer(double s) const { return std::atan(2.87 * track_.centre().at(s).curvature); }

  void fill(double acceleration) {
    const model::Pose here = pose(s_);
    const double curvature = track_.centre().at(s_).curvature;
    frame_.has_truth = true;
    frame_.is_judged = true;
    frame_.truth = {here.x, here.y, here.psi, speed_, 0.0, speed_ * curvature, steer(s_)};
    frame_.measurement = {};
    frame_.measurement.time = frame_.time;
    frame_.measurement.x = here.x;
    frame_.measurement.y = here.y;
    frame_.measurement.psi = here.psi;
    frame_.measurement.speed = speed_;
    frame_.applied = {steer(s_), std::clamp(acceleration / 5.0, -1.0, 1.0)};
    frame_.result.command = {steer(s_ + 0.1 * speed_), frame_.applied.throttle};
    frame_.step_time = 3.5e-4 + 1.5e-4 * std::abs(std::sin(0.7 * static_cast<double>(frame_.cycle)));
    frame_.longitudinal_acceleration = acceleration;
    frame_.lateral_acceleration = speed_ * speed_ * curvature;
    frame_.s = s_;
    frame_.lateral_error = offset(s_);
    frame_.edge_distance = 5.0 - 1.2 - std::abs(offset(s_));
    frame_.lap_time = frame_.time - lap_start_;
    fill_report();
    fill_plan();
    frame_.situation = telemetry::situation_of(frame_, frame_.situation, {});
  }

  void fill_report() {
    controller::StepReport& report = frame_.result.report;
    report.solve.status = solver::SolveStatus::kOptimal;
    report.solve.iterations = 3;
    report.solve.sweeps = 5;
    report.lateral_error = frame_.lateral_error;
    report.speed_reference = wanted(s_);
    report.delay = 0.118;
    report.sight = 140.0;
    report.has_map = frame_.lap > 0;
  }

  void fill_plan() {
    controller::Plan& plan = frame_.result.plan;
    plan.size = 40;
    double s = s_ + 0.1 * speed_;
    double speed = speed_;
    for (std::size_t i = 0; i < 40; ++i) {
      const model::Pose ahead = pose(s);
      plan.points[i] = {frame_.time + 0.1 + 0.05 * static_cast<double>(i),
                        ahead.x,
                        ahead.y,
                        ahead.psi,
                        speed,
                        {steer(s), 0.5}};
      speed += std::clamp(wanted(s) - speed, -0.45, 0.25);
      s += 0.05 * speed;
    }
    plan.reference_size = 40;
    for (std::size_t i = 0; i < 40; ++i)
      plan.reference[i] = track_.centre().at(s_ + 3.0 * static_cast<double>(i)).position;
  }

  const road::Track& track_;
  double period_;
  telemetry::Frame frame_;
  double s_ = 0.0;
  double speed_ = 0.0;
  double lap_start_ = 0.0;
};

}  // namespace chicane::demo
