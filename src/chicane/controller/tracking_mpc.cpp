// SPDX-License-Identifier: MIT
#include "chicane/controller/tracking_mpc.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/angle.hpp"
#include "chicane/controller/command_history.hpp"
#include "chicane/controller/doubt.hpp"
#include "chicane/controller/explain.hpp"
#include "chicane/controller/fallback.hpp"
#include "chicane/controller/prediction.hpp"
#include "chicane/controller/road.hpp"
#include "chicane/controller/tracking_problem.hpp"
#include "chicane/controller/tunable.hpp"
#include "chicane/solver/ocp_solver.hpp"

namespace chicane::controller {
namespace {

using Problem = TrackingProblem;
using Solver = solver::OcpSolver<Problem, Problem::kCapacity>;
using Horizon = solver::Trajectory<Problem::kNx, Problem::kNu, Problem::kCapacity>;
using StageState = std::array<double, Problem::kNx>;
using StageInput = std::array<double, Problem::kNu>;

constexpr double kFarFromLine = 15.0;       // [m] further away the car is lost
constexpr double kSpeedAhead = 4.0;         // [m/s] wanted at most beyond what the last answer reaches
constexpr double kLongestHold = 0.3;        // [s] the first command is believed to be held at most this long
constexpr double kBlindAfter = 0.3;         // [s] without a measurement, or a waypoint: stop
constexpr double kPreview = 0.3;            // [s] the car answers the wheel about so late
constexpr double kCrawl = 3.0;              // [m/s] who stops is brought to rest by the fallback from here
constexpr double kProjectionWindow = 30.0;  // [m] searched around the last place

class TrackingMpc final : public Controller, public Tunable<TrackingMpcOptions> {
 public:
  TrackingMpc(const TrackingMpcOptions& options, const model::VehicleParams& vehicle)
      : options_{options},
        model_{vehicle},
        road_{road_options(options), vehicle},
        estimator_{model_},
        fallback_{vehicle},
        solver_{{.tolerance = 1e-3,
                 .loose_tolerance = 1e3,
                 .max_iterations = 8,
                 .may_start_short = false,
                 .second_order = false}} {
    problem_.model = &model_;
    shape_problem();
  }

  void configure(const TrackingMpcOptions& options, const model::VehicleParams& vehicle) noexcept override {
    options_ = options;
    model_.set_vehicle(vehicle);
    road_.configure(road_options(options), vehicle);
    estimator_.set_model(model_);
    fallback_.set_vehicle(vehicle);
    shape_problem();
  }

  [[nodiscard]] const StepResult& step(const model::Measurement& told, Deadline deadline) noexcept override {
    const model::Measurement& now = doubt_.judge(told);
    const double act_time = now.time + (options_.compensate_delay ? now.delay : 0.0);
    road_.add(now);
    estimator_.correct(now, sent_);
    watch_sight(now);
    const StateEstimator::Prediction start = estimator_.predict(act_time, sent_);
    if (!place_on_line(now, start)) return fall_back(now, act_time);
    if (start.state.vx < kCrawl && stopping_speed(0.0) < kCrawl) return fall_back(now, act_time);
    warm_start(act_time);
    const double started = deadline.elapsed();
    const solver::SolveReport report = solver_.solve(problem_, x0_, horizon_, deadline);
    result_.report.solve_time = deadline.elapsed() - started;
    result_.report.solve = report;
    // A guess that was never improved is no answer, however well it went before.
    const bool is_guess = report.status == solver::SolveStatus::kBudgetSpent && report.iterations == 0;
    late_.note(!is_guess, now.time);
    if (is_guess && late_.is_long && start.state.vx > kCrawl) return stop_on_line(now, start);
    if (!usable(report.status) || is_guess) return fall_back(now, act_time);
    return accept(now, start, act_time);
  }

  void note_sent(const model::Command& command) noexcept override {
    if (std::isfinite(sent_time_)) sent_.add(sent_time_, command);
  }

  void reset() noexcept override {
    road_.reset();
    estimator_.reset();
    fallback_.reset();
    sent_.clear();
    has_horizon_ = false;
    has_place_ = false;
    doubt_.reset();
    blind_ = roadless_ = late_ = Absence{};
  }

  [[nodiscard]] std::string_view name() const noexcept override { return "tracking-mpc"; }
  [[nodiscard]] std::span<const std::string_view> cost_terms() const noexcept override {
    return TrackingTerms::kNames;
  }
  [[nodiscard]] std::span<const std::string_view> constraints() const noexcept override {
    return kConstraintNames;
  }

 private:
  static RoadOptions road_options(const TrackingMpcOptions& options) noexcept {
    return {.half_width = options.assumed_half_width,
            .smoothing_width = options.smoothing_width,
            .remember_waypoints = options.remember_waypoints,
            .speed = {.speed_limit = options.speed_limit,
                      .grip_share = options.grip_share,
                      .brake_share = options.brake_share}};
  }

  /// Horizon and prices, from the options.
  void shape_problem() noexcept {
    problem_.dt = options_.step_length;
    problem_.horizon = options_.horizon_steps;
    problem_.weight = {.lateral = std::sqrt(options_.weight_lateral),
                       .heading = std::sqrt(options_.weight_heading),
                       .speed = std::sqrt(options_.weight_speed),
                       .steer_rate = std::sqrt(options_.weight_steer_rate),
                       .jerk = std::sqrt(options_.weight_jerk),
                       .edge = std::sqrt(options_.weight_edge),
                       .slip = std::sqrt(options_.weight_slip),
                       .excess_steer_rate = 10.0,
                       .friction = std::sqrt(options_.weight_slip)};
  }

  /// How long something has not been there that was.
  struct Absence {
    double since = 0.0;  ///< [s]
    bool was_there = false;
    bool is_long = false;
    void note(bool is_there, double time) noexcept {
      if (is_there) since = time;
      was_there = was_there || is_there;
      is_long = was_there && std::isfinite(time) && time - since > kBlindAfter;
    }
  };

  void watch_sight(const model::Measurement& now) noexcept {
    blind_.note(std::isfinite(now.x + now.y + now.psi + now.speed), now.time);
    roadless_.note(now.waypoint_count > 0, now.time);
  }

  /// Who has not been told where he is for a while knows the road and counts on: he stops on it. Who is not
  /// shown more road stops where it ends. Highest speed at s [m] ahead, with the braking that the speed plan
  /// counts on [m/s].
  [[nodiscard]] double stopping_speed(double s) const noexcept {
    const model::VehicleParams& car = model_.vehicle();
    const ReferenceLine& line = road_.line();
    const double v = std::max(x0_[Problem::kVx], 0.0);
    const double braking =
        -options_.brake_share * longitudinal_acceleration(car, -car.brake_throttle_limit, v);
    double squared = std::numeric_limits<double>::infinity();
    if (blind_.is_long) squared = v * v - 2.0 * braking * s;
    if (roadless_.is_long && !line.is_closed())
      squared = std::min(squared, 2.0 * braking * (line.length() - s_ - s));
    return std::sqrt(std::max(squared, 0.0));
  }

  /// The predicted start in coordinates along the line. False when the car or the road is lost.
  bool place_on_line(const model::Measurement& now, const StateEstimator::Prediction& start) noexcept {
    StepReport& report = result_.report;
    report = {};
    report.delay = now.delay;
    const ReferenceLine& line = road_.line();
    if (line.is_empty() || !std::isfinite(start.state.x + start.state.y + start.state.psi + start.state.vx))
      return false;
    const Vec2 position{start.state.x, start.state.y};
    if (revision_ != road_.revision()) has_place_ = false;
    ReferenceLine::Projection place =
        has_place_ ? line.project(position, s_, kProjectionWindow) : line.project(position);
    if (has_place_ && place.distance > 0.5 * kFarFromLine) place = line.project(position);
    if (!(place.distance < kFarFromLine)) return false;
    const CurvePoint at = line.at(place.s);
    const double heading_error = angle_difference(start.state.psi, at.heading);
    if (std::fabs(heading_error) > 0.5 * kPi) return false;
    s_ = place.s;
    has_place_ = true;
    revision_ = road_.revision();
    x0_ = {0.0,           place.d,           heading_error,     start.state.vx, start.state.vy,
           start.state.r, start.state.steer, start.acceleration};

    const ReferenceLine::Projection measured = line.project({now.x, now.y}, s_, kProjectionWindow);
    report.lateral_error = measured.d;
    report.heading_error = angle_difference(now.psi, line.at(measured.s).heading);
    report.speed_reference = line.demand(s_).speed;
    report.sight = line.is_closed() ? line.length() : line.length() - s_;
    report.has_map = line.is_closed();
    return true;
  }

  /// The last answer, moved on by the time that has passed; a path-following law where there is none. Samples
  /// the road for each stage on the way.
  void warm_start(double act_time) noexcept {
    const int n = options_.horizon_steps;
    const double elapsed = act_time - act_time_;
    const double old_first = problem_.first_dt;
    const double old_end = old_first + (horizon_.horizon - 1) * answer_dt_;
    const bool can_shift = has_horizon_ && elapsed >= 0.0 && elapsed < 0.5 * old_end;
    if (can_shift) old_ = horizon_;
    problem_.first_dt = can_shift ? std::clamp(elapsed, problem_.dt, kLongestHold) : problem_.dt;
    // Position of a time of the old answer in its stages, as a real number.
    const auto old_stage = [&](double time) {
      return std::clamp(time < old_first ? time / old_first : 1.0 + (time - old_first) / answer_dt_, 0.0,
                        old_.horizon - 1.0);
    };
    horizon_.horizon = n;
    horizon_.x[0] = x0_;
    for (int k = 0; k < n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      sample_stage(k, horizon_.x[i]);
      if (can_shift) {
        const double where = old_stage(problem_.time(k) + elapsed);
        const auto j = static_cast<std::size_t>(where);
        const std::size_t next = std::min(j + 1, static_cast<std::size_t>(old_.horizon - 1));
        const double share = where - static_cast<double>(j);
        for (std::size_t q = 0; q < Problem::kNu; ++q) {
          horizon_.u[i][q] = old_.u[j][q] + share * (old_.u[next][q] - old_.u[j][q]);
        }
      } else {
        horizon_.u[i] = follow_line(k, horizon_.x[i]);
      }
      const StageInput low = problem_.input_lower(k);
      const StageInput high = problem_.input_upper(k);
      for (std::size_t q = 0; q < Problem::kNu; ++q)
        horizon_.u[i][q] = std::clamp(horizon_.u[i][q], low[q], high[q]);
      horizon_.x[i + 1] = problem_.dynamics(k, horizon_.x[i], horizon_.u[i]);
      keep_sane(horizon_.x[i + 1]);
    }
    sample_stage(n, horizon_.x[static_cast<std::size_t>(n)]);
    act_time_ = act_time;
    answer_dt_ = problem_.dt;
  }

  /// A guess far from the road is no place to linearise: pull it back.
  static void keep_sane(StageState& x) noexcept {
    x[Problem::kD] = std::clamp(x[Problem::kD], -5.0, 5.0);
    x[Problem::kE] = std::clamp(x[Problem::kE], -0.6, 0.6);
    x[Problem::kVx] = std::max(x[Problem::kVx], 0.0);
  }

  [[nodiscard]] StageInput follow_line(int k, const StageState& x) const noexcept {
    const model::VehicleParams& car = model_.vehicle();
    const Problem::Stage& stage = problem_.stages[static_cast<std::size_t>(k)];
    const double v = std::max(x[Problem::kVx], 1.0);
    const double steer =
        car.wheelbase() * (stage.curvature - x[Problem::kD] / (v * v) - 1.4 * x[Problem::kE] / v);
    return {steer, stage.speed - x[Problem::kVx]};
  }

  void sample_stage(int k, const StageState& x) noexcept {
    const double s = x[Problem::kS];
    ReferenceLine::Demand road = road_.line().demand(s_ + s);
    if (const double stop = stopping_speed(s); stop < road.speed) {
      road.speed = stop;
      road.speed_slope = 0.0;
    }
    const Road::Room room = road_.room(road.offset);
    const model::VehicleParams& car = model_.vehicle();
    const double v = std::max(x[Problem::kVx], 0.0);
    // Asking for far more than the car can do would only drown the other prices (and Gauss–Newton with them).
    const bool is_reachable = road.speed < v + kSpeedAhead;
    problem_.stages[static_cast<std::size_t>(k)] = {
        .s = s,
        .curvature = road.curvature,
        .curvature_slope = road.curvature_slope,
        .speed = is_reachable ? road.speed : v + kSpeedAhead,
        .speed_slope = is_reachable ? road.speed_slope : 0.0,
        .left = room.left,
        .right = room.right,
        .acceleration_min = longitudinal_acceleration(car, -car.brake_throttle_limit, v),
        .acceleration_max = longitudinal_acceleration(car, 1.0, v)};
  }

  const StepResult& accept(const model::Measurement& now, const StateEstimator::Prediction& start,
                           double act_time) noexcept {
    has_horizon_ = true;
    fill_plan(act_time);
    model::Command& command = result_.command;
    command.steer = horizon_.u[0][0];
    command.throttle = throttle_for(model_.vehicle(), horizon_.u[0][1], start.state.vx);
    explain_answer(start.state.vx);
    fallback_.accept(result_.plan);
    send(now, command);
    return result_;
  }

  void explain_answer(double speed) noexcept {
    Explanation& explanation = result_.report.explanation;
    explain<TrackingTerms>(problem_, horizon_, explanation);
    const ReferenceLine::Demand planned = road_.line().demand(s_);
    explanation.speed_limit = planned.speed;
    explanation.speed_limiter = limiter_of(speed, planned.speed, planned.limiter, explanation.active_now);
  }

  /// No time to solve, and the last plan is old: the wheel by feedback to the line, all useful braking.
  const StepResult& stop_on_line(const model::Measurement& now,
                                 const StateEstimator::Prediction& start) noexcept {
    const model::VehicleParams& car = model_.vehicle();
    const int ahead = std::min(static_cast<int>(kPreview / problem_.dt), options_.horizon_steps - 1);
    result_.command.steer =
        std::clamp(follow_line(ahead, horizon_.x[0])[0], -car.steer_limit, car.steer_limit);
    result_.command.throttle = throttle_for(
        car, longitudinal_acceleration(car, -car.brake_throttle_limit, start.state.vx), start.state.vx);
    result_.report.rung = Rung::kHoldAndBrake;
    result_.plan.size = 0;
    result_.plan.reference_size = 0;
    has_horizon_ = false;
    send(now, result_.command);
    return result_;
  }

  const StepResult& fall_back(const model::Measurement& now, double act_time) noexcept {
    has_horizon_ = false;
    const Fallback::Answer answer = fallback_.command(act_time, now);
    result_.command = answer.command;
    result_.report.rung = answer.rung;
    result_.plan.size = 0;
    result_.plan.reference_size = 0;
    send(now, result_.command);
    return result_;
  }

  void send(const model::Measurement& now, const model::Command& command) noexcept {
    sent_time_ = now.time + now.delay;
    note_sent(command);
  }

  void fill_plan(double act_time) noexcept {
    const ReferenceLine& line = road_.line();
    Plan& plan = result_.plan;
    const int n = options_.horizon_steps;
    plan.size = n + 1;
    plan.reference_size = n + 1;
    for (int k = 0; k <= n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const StageState& x = horizon_.x[i];
      const StageInput& u = horizon_.u[static_cast<std::size_t>(std::min(k, n - 1))];
      const CurvePoint at = line.at(s_ + x[Problem::kS]);
      plan.reference[i] = at.position;
      plan.points[i] = {.time = act_time + problem_.time(k),
                        .x = at.position.x() - x[Problem::kD] * at.tangent.y(),
                        .y = at.position.y() + x[Problem::kD] * at.tangent.x(),
                        .psi = at.heading + x[Problem::kE],
                        .speed = x[Problem::kVx],
                        .command = {u[0], throttle_for(model_.vehicle(), u[1], x[Problem::kVx])}};
    }
  }

  TrackingMpcOptions options_;
  PredictionModel model_;
  Road road_;
  StateEstimator estimator_;
  CommandHistory sent_;
  Fallback fallback_;
  Problem problem_;
  Solver solver_;
  Horizon horizon_;  ///< the last answer, then the guess, then the new answer
  Horizon old_;
  StageState x0_{};
  StepResult result_;
  double s_ = 0.0;  ///< arc length on the line where the command acts
  double act_time_ = 0.0;
  double sent_time_ = 0.0;  ///< from which the last command acts [s]
  double answer_dt_ = 0.0;  ///< step length of the last answer [s]
  unsigned revision_ = 0;
  bool has_place_ = false;
  bool has_horizon_ = false;
  Doubt doubt_;
  Absence blind_;     ///< of measurements that tell where the car is
  Absence roadless_;  ///< of waypoints
  Absence late_;      ///< of answers, for want of time
};

}  // namespace

Result<std::unique_ptr<Controller>> make_tracking_mpc(const TrackingMpcOptions& options,
                                                      const model::VehicleParams& vehicle) {
  if (auto valid = validate(vehicle); !valid) return fail(valid.error());
  if (options.horizon_steps < 5 || options.horizon_steps > Problem::kCapacity) {
    return fail(ErrorCode::kInvalidArgument, "tracking_mpc.horizon_steps: got " +
                                                 std::to_string(options.horizon_steps) + ", expected 5 to " +
                                                 std::to_string(Problem::kCapacity));
  }
  return std::unique_ptr<Controller>(std::make_unique<TrackingMpc>(options, vehicle));
}

}  // namespace chicane::controller
