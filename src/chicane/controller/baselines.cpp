// SPDX-License-Identifier: MIT
#include "chicane/controller/baselines.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"
#include "chicane/controller/explain.hpp"
#include "chicane/controller/option_range.hpp"
#include "chicane/controller/speed_hold.hpp"
#include "chicane/controller/tunable.hpp"
#include "chicane/path/path.hpp"

namespace chicane::controller {
namespace {

/// What a steering law looks at.
struct View {
  const path::Path& line;  ///< through the waypoints just told
  path::Projection here;   ///< of the centre of mass
  double heading_error;    ///< yaw minus the line's heading there [rad]
  const model::Measurement& now;
  double elapsed;  ///< since the step before [s], 0 when unknown
};

/// A curve through waypoints; skips those that are not finite or repeat the one before.
class WaypointLine {
 public:
  [[nodiscard]] bool see(const model::Measurement& now) noexcept {
    std::size_t count = 0;
    for (int i = 0; i < std::clamp(now.waypoint_count, 0, model::Measurement::kMaxWaypoints); ++i) {
      const Vec2& point = now.waypoints[static_cast<std::size_t>(i)];
      if (!std::isfinite(point.x()) || !std::isfinite(point.y())) continue;
      if (count > 0 && (point - points_[count - 1]).norm() < 1e-3) continue;
      points_[count++] = point;
    }
    return path_.rebuild({points_.data(), count}, false);
  }
  [[nodiscard]] const path::Path& path() const noexcept { return path_; }
  [[nodiscard]] std::span<const Vec2> points() const noexcept { return points_; }

 private:
  path::Path path_ = path::Path::with_capacity(model::Measurement::kMaxWaypoints);
  std::array<Vec2, model::Measurement::kMaxWaypoints> points_{};
};

/// All that the baselines share: the line, the speed, the report. `Law` steers: double steer(const View&),
/// void configure(const Options&, const VehicleParams&), void reset().
template <class Law>
class Baseline final : public Controller, public Tunable<typename Law::Options> {
 public:
  using Options = typename Law::Options;

  Baseline(std::string_view name, const Options& options, const model::VehicleParams& vehicle)
      : name_{name},
        law_{options, vehicle},
        speed_{options.speed, vehicle},
        steer_limit_{vehicle.steer_limit},
        lowest_throttle_{-vehicle.brake_throttle_limit} {
    reset();
  }

  [[nodiscard]] const StepResult& step(const model::Measurement& now,
                                       Deadline /*unused: nothing is solved*/) noexcept override {
    if (!is_finite(now) || !line_.see(now)) return no_answer();
    const path::Path& line = line_.path();
    const path::Projection here = line.project({now.x, now.y});
    const View view{line, here, angle_difference(now.psi, line.at(here.s).heading), now, elapsed(now.time)};
    const SpeedHold::Wanted wanted = speed_.reference(line, here.s);
    const double steer = std::clamp(law_.steer(view), -steer_limit_, steer_limit_);
    return answer(view, {steer, speed_.throttle(wanted.speed, now.speed)}, wanted);
  }

  void configure(const Options& options, const model::VehicleParams& vehicle) noexcept override {
    law_.configure(options, vehicle);
    speed_.configure(options.speed, vehicle);
    steer_limit_ = vehicle.steer_limit;
  }

  void reset() noexcept override {
    law_.reset();
    last_time_ = 0.0;
    has_time_ = false;
    result_ = {};
  }

  [[nodiscard]] std::string_view name() const noexcept override { return name_; }
  [[nodiscard]] std::span<const std::string_view> constraints() const noexcept override {
    return kInputConstraintNames;
  }

 private:
  static bool is_finite(const model::Measurement& now) noexcept {
    return std::isfinite(now.time + now.delay) && std::isfinite(now.x) && std::isfinite(now.y) &&
           std::isfinite(now.psi) && std::isfinite(now.speed);
  }

  double elapsed(double time) noexcept {
    const double since = has_time_ ? time - last_time_ : 0.0;
    last_time_ = time;
    has_time_ = true;
    return since > 0.0 && since < 1.0 ? since : 0.0;
  }

  const StepResult& answer(const View& view, const model::Command& command,
                           const SpeedHold::Wanted& wanted) noexcept {
    const model::Measurement& now = view.now;
    result_.answer = Answer::kDrive;
    result_.command = command;
    result_.plan.size = 1;
    result_.plan.points[0] = {now.time + now.delay, now.x, now.y, now.psi, now.speed, command};
    result_.plan.reference_size = kReferencePoints;
    const double sight = view.line.length() - view.here.s;
    for (int i = 0; i < kReferencePoints; ++i) {
      const double s = view.here.s + sight * i / (kReferencePoints - 1);
      result_.plan.reference[static_cast<std::size_t>(i)] = view.line.at(s).position;
    }
    result_.report = {};
    result_.report.solve.status = solver::SolveStatus::kOptimal;
    result_.report.lateral_error = view.here.d;
    result_.report.heading_error = view.heading_error;
    result_.report.speed_reference = wanted.speed;
    result_.report.sight = sight;
    explain_command(command, now.speed, wanted);
    return result_;
  }

  void explain_command(const model::Command& command, double speed,
                       const SpeedHold::Wanted& wanted) noexcept {
    Explanation& explanation = result_.report.explanation;
    explanation.active_now =
        bounds_met({command.steer, command.throttle}, {-steer_limit_, lowest_throttle_}, {steer_limit_, 1.0});
    explanation.active_ahead = explanation.active_now;
    explanation.speed_limit = wanted.speed;
    explanation.speed_limiter = limiter_of(speed, wanted.speed, wanted.limiter, explanation.active_now);
  }

  const StepResult& no_answer() noexcept {
    result_.answer = Answer::kNone;
    result_.report = {};
    result_.report.solve.status = solver::SolveStatus::kNotFinite;
    return result_;
  }

  static constexpr int kReferencePoints = 32;

  std::string_view name_;
  Law law_;
  SpeedHold speed_;
  double steer_limit_;
  double lowest_throttle_;
  WaypointLine line_;
  double last_time_ = 0.0;
  bool has_time_ = false;
  StepResult result_;
};

class PidLaw {
 public:
  using Options = PidOptions;
  PidLaw(const PidOptions& options, const model::VehicleParams& vehicle) noexcept {
    configure(options, vehicle);
  }
  void configure(const PidOptions& options, const model::VehicleParams& vehicle) noexcept {
    options_ = options;
    steer_limit_ = vehicle.steer_limit;
  }

  double steer(const View& view) noexcept {
    const double error = view.here.d;
    const double rate = view.now.speed * sin(view.heading_error);  // de/dt on a line that hardly turns
    const double integral = integral_ + error * view.elapsed;
    const double steer = law(error, integral, rate);
    // Anti-windup: no more integral while it would only push the wheel further against its stop.
    if (std::fabs(steer) < steer_limit_ || std::fabs(law(error, integral_, rate)) > std::fabs(steer))
      integral_ = integral;
    return steer;
  }
  void reset() noexcept { integral_ = 0.0; }

 private:
  [[nodiscard]] double law(double error, double integral, double rate) const noexcept {
    return -(options_.proportional_gain * error + options_.integral_gain * integral +
             options_.derivative_gain * rate);
  }

  PidOptions options_;
  double steer_limit_ = 0.0;
  double integral_ = 0.0;
};

class PurePursuitLaw {
 public:
  using Options = PurePursuitOptions;
  PurePursuitLaw(const PurePursuitOptions& options, const model::VehicleParams& vehicle) noexcept {
    configure(options, vehicle);
  }
  void configure(const PurePursuitOptions& options, const model::VehicleParams& vehicle) noexcept {
    options_ = options;
    rear_axle_ = vehicle.rear_axle;
    wheelbase_ = vehicle.wheelbase();
  }

  double steer(const View& view) noexcept {
    const double lookahead = std::max(options_.lookahead_min, view.now.speed * options_.lookahead_time);
    const Vec2 target = view.line.at(view.here.s + lookahead).position;
    const double cosine = cos(view.now.psi);
    const double sine = sin(view.now.psi);
    const double dx = target.x() - (view.now.x - rear_axle_ * cosine);
    const double dy = target.y() - (view.now.y - rear_axle_ * sine);
    const double sideways = cosine * dy - sine * dx;
    return atan(2.0 * wheelbase_ * sideways / std::max(dx * dx + dy * dy, 1e-6));
  }
  void reset() noexcept {}

 private:
  PurePursuitOptions options_;
  double rear_axle_ = 0.0;
  double wheelbase_ = 0.0;
};

class StanleyLaw {
 public:
  using Options = StanleyOptions;
  StanleyLaw(const StanleyOptions& options, const model::VehicleParams& vehicle) noexcept {
    configure(options, vehicle);
  }
  void configure(const StanleyOptions& options, const model::VehicleParams& vehicle) noexcept {
    options_ = options;
    front_axle_ = vehicle.front_axle;
  }

  double steer(const View& view) noexcept {
    const double psi = view.now.psi;
    const Vec2 front{view.now.x + front_axle_ * cos(psi), view.now.y + front_axle_ * sin(psi)};
    const path::Projection there = view.line.project(front);
    const double heading_error = angle_difference(psi, view.line.at(there.s).heading);
    return -heading_error - atan2(options_.gain * there.d, options_.softening_speed + view.now.speed);
  }
  void reset() noexcept {}

 private:
  StanleyOptions options_;
  double front_axle_ = 0.0;
};

Result<void> check(const SpeedHoldOptions& speed, const model::VehicleParams& vehicle) {
  if (const auto valid = model::validate(vehicle); !valid) return fail(valid.error());
  return check_ranges({{"speed.speed_reference", speed.speed_reference, 0.0, 60.0},
                       {"speed.speed_gain", speed.speed_gain, 0.0, 10.0},
                       {"speed.lateral_acceleration_limit", speed.lateral_acceleration_limit, 0.1, 100.0}});
}

template <class Law>
Result<std::unique_ptr<Controller>> make(std::string_view name, const typename Law::Options& options,
                                         const model::VehicleParams& vehicle) {
  if (const auto valid = check(options.speed, vehicle); !valid) return fail(valid.error());
  return std::make_unique<Baseline<Law>>(name, options, vehicle);
}

}  // namespace

Result<std::unique_ptr<Controller>> make_pid(const PidOptions& options, const model::VehicleParams& vehicle) {
  const auto valid = check_ranges({{"pid.proportional_gain", options.proportional_gain, 0.0, 10.0},
                                   {"pid.integral_gain", options.integral_gain, 0.0, 10.0},
                                   {"pid.derivative_gain", options.derivative_gain, 0.0, 10.0}});
  if (!valid) return fail(valid.error());
  return make<PidLaw>("pid", options, vehicle);
}

Result<std::unique_ptr<Controller>> make_pure_pursuit(const PurePursuitOptions& options,
                                                      const model::VehicleParams& vehicle) {
  const auto valid = check_ranges({{"pure_pursuit.lookahead_time", options.lookahead_time, 0.0, 5.0},
                                   {"pure_pursuit.lookahead_min", options.lookahead_min, 0.5, 50.0}});
  if (!valid) return fail(valid.error());
  return make<PurePursuitLaw>("pure-pursuit", options, vehicle);
}

Result<std::unique_ptr<Controller>> make_stanley(const StanleyOptions& options,
                                                 const model::VehicleParams& vehicle) {
  const auto valid = check_ranges({{"stanley.gain", options.gain, 0.0, 50.0},
                                   {"stanley.softening_speed", options.softening_speed, 0.01, 20.0}});
  if (!valid) return fail(valid.error());
  return make<StanleyLaw>("stanley", options, vehicle);
}

}  // namespace chicane::controller
