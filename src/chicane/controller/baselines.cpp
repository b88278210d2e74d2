// SPDX-License-Identifier: MIT
// The baselines PID, pure pursuit and Stanley: steering laws with a common speed hold.
#include "chicane/controller/baselines.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "chicane/base/math.hpp"
#include "chicane/controller/controller_list.hpp"
#include "chicane/controller/explain.hpp"

namespace chicane::controller {
namespace {

/// Input of a steering law.
struct View {
  const road::Path& line;  ///< curve through the measured waypoints
  road::Projection here;   ///< place of `line` nearest to the centre of mass
  double heading_error;    ///< yaw minus the line's heading there [rad]
  const model::Measurement& now;
  double elapsed;  ///< time since the previous step [s], 0 if unknown
};

/// Curve through the measured waypoints.
class WaypointLine {
 public:
  /// Builds the curve; skips points that are not finite or repeat the one before. False without a curve.
  [[nodiscard]] bool see(const model::Measurement& now) noexcept {
    std::size_t count = 0;
    for (int i = 0; i < std::clamp(now.waypoint_count, 0, model::Measurement::kMaxWaypoints); ++i) {
      const Vec2& point = now.waypoints[static_cast<std::size_t>(i)];
      if (!std::isfinite(point.x()) || !std::isfinite(point.y())) continue;
      if (count > 0 && (point - points_[count - 1]).norm() < kSamePoint) continue;
      points_[count++] = point;
    }
    return path_.rebuild({points_.data(), count}, false);
  }
  [[nodiscard]] const road::Path& path() const noexcept { return path_; }

  /// [m] chosen: far above rounding, far below the waypoints' spacing.
 private:
  static constexpr double kSamePoint = 1e-3;
  road::Path path_ = road::Path::with_capacity(model::Measurement::kMaxWaypoints);
  std::array<Vec2, model::Measurement::kMaxWaypoints> points_{};
};

/// Controller of one steering law; line, speed hold and report are those of all baselines. `Law` has Options,
/// double steer(const View&), void configure(const Options&, const VehicleParams&) and void reset().
template <class Law>
class Baseline final : public CopyableController<Baseline<Law>>, public Tunable<typename Law::Options> {
 public:
  using Options = typename Law::Options;

  Baseline(std::string_view name, const Options& options, const model::VehicleParams& vehicle)
      : name_{name}, speed_{options.speed, vehicle} {
    Baseline::configure(options, vehicle);
  }

  [[nodiscard]] const StepResult& step(const model::Measurement& now,
                                       Deadline /*unused: nothing is solved*/) noexcept override {
    if (!std::isfinite(now.time + now.delay) || !now.is_finite() || !line_.see(now)) return no_answer();
    const road::Path& line = line_.path();
    const road::Projection here = line.project({now.x, now.y});
    const View view{line, here, angle_difference(now.psi, line.at(here.s).heading), now, elapsed(now.time)};
    const SpeedHold::Wanted wanted = speed_.reference(line, here.s);
    const double steer = std::clamp(law_.steer(view), -steer_limit_, steer_limit_);
    return answer(view, {steer, speed_.throttle(wanted.speed, now.speed)}, wanted);
  }

  void configure(const Options& options, const model::VehicleParams& vehicle) noexcept override {
    law_.configure(options, vehicle);
    speed_.configure(options.speed, vehicle);
    steer_limit_ = vehicle.steer_limit;
    lowest_throttle_ = -vehicle.brake_throttle_limit;
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
  /// Time since the last step [s]; 0 in a first step, and after a pause of a second or more (chosen).
  double elapsed(double time) noexcept {
    const double since = has_time_ ? time - last_time_ : 0.0;
    last_time_ = time;
    has_time_ = true;
    return since > 0.0 && since < 1.0 ? since : 0.0;
  }

  /// Result of a step with a command.
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

  /// Explains the command: inputs at their bounds, limiter of the speed.
  void explain_command(const model::Command& command, double speed,
                       const SpeedHold::Wanted& wanted) noexcept {
    Explanation& explanation = result_.report.explanation;
    explanation.active_now =
        bounds_met({command.steer, command.throttle}, {-steer_limit_, lowest_throttle_}, {steer_limit_, 1.0});
    explanation.active_ahead = explanation.active_now;
    explanation.speed_limit = wanted.speed;
    explanation.speed_limiter = limiter_of(speed, wanted.speed, wanted.limiter, explanation.active_now);
  }

  /// Result of a step that cannot see the line.
  const StepResult& no_answer() noexcept {
    result_.answer = Answer::kNone;
    result_.report = {};
    result_.report.solve.status = solver::SolveStatus::kNotFinite;
    return result_;
  }

  static constexpr int kReferencePoints = 32;  // points of the line that viewers draw; chosen

  std::string_view name_;
  Law law_;
  SpeedHold speed_;
  double steer_limit_ = 0.0;      ///< [rad]
  double lowest_throttle_ = 0.0;  ///< pedal of full braking
  WaypointLine line_;
  double last_time_ = 0.0;  ///< time of the last step [s], if has_time_
  bool has_time_ = false;
  StepResult result_;
};

/// PID law on the cross-track error (PidOptions).
class PidLaw {
 public:
  using Options = PidOptions;
  void configure(const PidOptions& options, const model::VehicleParams& vehicle) noexcept {
    options_ = options;
    steer_limit_ = vehicle.steer_limit;
  }

  double steer(const View& view) noexcept {
    const double error = view.here.d;
    const double rate = view.now.speed * sin(view.heading_error);  // de/dt on a line that hardly turns
    const double integral = integral_ + error * view.elapsed;
    const double steer = law(error, integral, rate);
    // Anti-windup: the integral does not grow while it would only push the wheel further against its stop.
    if (std::fabs(steer) < steer_limit_ || std::fabs(law(error, integral_, rate)) > std::fabs(steer))
      integral_ = integral;
    return steer;
  }
  void reset() noexcept { integral_ = 0.0; }

 private:
  /// Steering angle for the error [m], its integral [m s] and its rate [m/s]; left positive.
  [[nodiscard]] double law(double error, double integral, double rate) const noexcept {
    return -(options_.proportional_gain * error + options_.integral_gain * integral +
             options_.derivative_gain * rate);
  }

  PidOptions options_;
  double steer_limit_ = 0.0;  ///< [rad]
  double integral_ = 0.0;     ///< integral of the cross-track error [m s]
};

/// Pure pursuit (PurePursuitOptions).
class PurePursuitLaw {
 public:
  using Options = PurePursuitOptions;
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
    const double sideways = cosine * dy - sine * dx;  // target's offset from the rear axle, left positive [m]
    return atan(2.0 * wheelbase_ * sideways / std::max(dx * dx + dy * dy, 1e-6));
  }
  void reset() noexcept {}

 private:
  PurePursuitOptions options_;
  double rear_axle_ = 0.0;
  double wheelbase_ = 0.0;
};

/// Stanley's law (StanleyOptions).
class StanleyLaw {
 public:
  using Options = StanleyOptions;
  void configure(const StanleyOptions& options, const model::VehicleParams& vehicle) noexcept {
    options_ = options;
    front_axle_ = vehicle.front_axle;
  }

  double steer(const View& view) noexcept {
    const double psi = view.now.psi;
    const Vec2 front{view.now.x + front_axle_ * cos(psi), view.now.y + front_axle_ * sin(psi)};
    const road::Projection there = view.line.project(front);
    const double heading_error = angle_difference(psi, view.line.at(there.s).heading);
    return -heading_error - atan2(options_.gain * there.d, options_.softening_speed + view.now.speed);
  }
  void reset() noexcept {}

 private:
  StanleyOptions options_;
  double front_axle_ = 0.0;
};

/// Makes the controller of a law, if its options are valid.
template <class Entry, class Law>
Result<std::unique_ptr<Controller>> make(const typename Law::Options& options,
                                         const model::VehicleParams& vehicle) {
  if (const auto valid = check<Entry>(options, vehicle); !valid) return fail(valid.error());
  return std::make_unique<Baseline<Law>>(Entry::kName, options, vehicle);
}

/// Rows of the options of a law, followed by those of its speed hold, the member `Speed`.
template <auto Speed, std::size_t N>
constexpr std::array<Option, N + 3> with_speed_hold(const std::array<Option, N>& law) {
  std::array<Option, N + 3> all{};
  std::copy(law.begin(), law.end(), all.begin());
  all[N] = option<Speed, &SpeedHoldOptions::speed_reference>("speed_reference", unit::kSpeed, 0, 110,
                                                             "Speed to hold.");
  all[N + 1] = option<Speed, &SpeedHoldOptions::speed_gain>("speed_gain", unit::per("s/m"), 0, 10,
                                                            "Throttle for the speed error.");
  all[N + 2] = option<Speed, &SpeedHoldOptions::lateral_acceleration_limit>(
      "lateral_acceleration_limit", unit::kAcceleration, 0.1, 100,
      "Slows where the curve would ask for more.");
  return all;
}

constexpr auto kPidOptions = with_speed_hold<&PidOptions::speed>(std::array{
    option<&PidOptions::proportional_gain>("proportional_gain", unit::per("rad/m"), 0, 10,
                                           "Steering for the cross-track error."),
    option<&PidOptions::integral_gain>("integral_gain", unit::per("rad/(m s)"), 0, 10,
                                       "Steering for its integral."),
    option<&PidOptions::derivative_gain>("derivative_gain", unit::per("rad s/m"), 0, 10,
                                         "Steering for its rate."),
});
constexpr auto kPurePursuitOptions = with_speed_hold<&PurePursuitOptions::speed>(std::array{
    option<&PurePursuitOptions::lookahead_time>("lookahead_time", unit::kSecond, 0, 5,
                                                "Distance of the point aimed at, over speed."),
    option<&PurePursuitOptions::lookahead_min>("lookahead_min", unit::kMetre, 0.5, 50,
                                               "Distance at which it aims at least."),
});
constexpr auto kStanleyOptions = with_speed_hold<&StanleyOptions::speed>(std::array{
    option<&StanleyOptions::gain>("gain", unit::per("1/s"), 0, 50,
                                  "Steering for the front axle's cross-track error over speed."),
    option<&StanleyOptions::softening_speed>(
        "softening_speed", unit::kSpeed, 0.01, 20,
        "Added to the speed so that the gain stays finite near standstill."),
});

constexpr double kComfortableBraking = 3.0;  // [m/s²] assumed before a curve; chosen
constexpr double kSampleSpacing = 2.0;       // [m] between samples of the curvature ahead; chosen
constexpr int kMaxSamples = 100;  // limit of these samples: 200 m, more than waypoints reach; chosen

}  // namespace

std::span<const Option> PidEntry::options() noexcept { return kPidOptions; }
std::span<const Option> PurePursuitEntry::options() noexcept { return kPurePursuitOptions; }
std::span<const Option> StanleyEntry::options() noexcept { return kStanleyOptions; }

Result<std::unique_ptr<Controller>> make_pid(const PidOptions& options, const model::VehicleParams& vehicle) {
  return make<PidEntry, PidLaw>(options, vehicle);
}

Result<std::unique_ptr<Controller>> make_pure_pursuit(const PurePursuitOptions& options,
                                                      const model::VehicleParams& vehicle) {
  return make<PurePursuitEntry, PurePursuitLaw>(options, vehicle);
}

Result<std::unique_ptr<Controller>> make_stanley(const StanleyOptions& options,
                                                 const model::VehicleParams& vehicle) {
  return make<StanleyEntry, StanleyLaw>(options, vehicle);
}

SpeedHold::Wanted SpeedHold::reference(const road::Path& path, double s) const noexcept {
  double wanted_squared = options_.speed_reference * options_.speed_reference;
  SpeedLimiter limiter = SpeedLimiter::kAsked;
  const double sight = path.length() - s;
  for (int i = 0; i < kMaxSamples && i * kSampleSpacing <= sight; ++i) {
    const double ahead = i * kSampleSpacing;
    const double curvature = std::fabs(path.at(s + ahead).curvature);
    const double limit_squared =
        options_.lateral_acceleration_limit / std::max(curvature, 1e-6);  // straight: finite
    const double here_squared = limit_squared + 2.0 * kComfortableBraking * ahead;
    if (here_squared < wanted_squared) {
      wanted_squared = here_squared;
      limiter = i == 0 ? SpeedLimiter::kCurvature : SpeedLimiter::kBraking;
    }
  }
  return {std::sqrt(wanted_squared), limiter};
}

double SpeedHold::throttle(double wanted, double v) const noexcept {
  const double holding = model::throttle_for(vehicle_, 0.0, v);
  const double pedal = std::clamp(holding + options_.speed_gain * (wanted - v), -1.0, 1.0);
  return pedal >= 0.0 ? pedal : pedal * vehicle_.brake_throttle_limit;
}

}  // namespace chicane::controller
