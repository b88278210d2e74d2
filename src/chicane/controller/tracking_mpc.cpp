// SPDX-License-Identifier: MIT
// The controller `tracking-mpc` (docs/controller.md): the control step from measurement to command.
#include "chicane/controller/tracking_mpc.hpp"

#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"
#include "chicane/base/owned.hpp"
#include "chicane/controller/controller_list.hpp"
#include "chicane/controller/explain.hpp"
#include "chicane/controller/tracking_guess.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/tracking/state_estimator.hpp"
#include "chicane/tracking/tracking_solver.hpp"
#include "chicane/tracking/way_back.hpp"

namespace chicane::controller {
namespace {

using Problem = tracking::TrackingProblem;
using Horizon = tracking::TrackingTrajectory;
using Prediction = tracking::StateEstimator::Prediction;
using StageState = std::array<double, Problem::kNx>;
using StageInput = std::array<double, Problem::kNu>;

// docs/controller.md explains constants without another source; "chosen" has no other reason.
constexpr int kMostIterations = TrackingMpcOptions::kMostIterations;  // with a new guess, or after a pause
// In a race with the original curve of tyres (docs/limit.md, "The solver").
constexpr int kRacingIterations = 30;
constexpr double kTimePerIteration = 0.04;  // [s] time since the last step for one more iteration
constexpr double kFarFromLine = 15.0;       // [m] a car further away returns to the road; chosen
constexpr double kLost = 100.0;             // [m] a car further away does not return; docs/safety.md
constexpr double kSlow = 6.0;               // [m/s] a slower car may turn round on the road; chosen
constexpr double kJoining = 0.2;            // [rad] heading error at which a returning car has joined; chosen
constexpr double kSpeedAhead = 4.0;         // [m/s] largest speed demand above the last answer's speed
constexpr double kSteadySpeed = 25.0;  // [m/s] from which on the weight on the steering rate grows as v²
constexpr double kLongestHold = 0.3;   // [s] longest assumed hold of the first command; chosen
constexpr double kBlindAfter = 0.3;    // [s] without measurement, waypoint or answer; docs/guard.md, eq. 15
constexpr double kPreview = 0.3;       // [s] about the lag from steering wheel to course; chosen
constexpr double kCrawl = 3.0;         // [m/s] below it the fallback stops the car, and no plan races; chosen

class TrackingMpc final : public CopyableController<TrackingMpc>, public Tunable<TrackingMpcOptions> {
 public:
  TrackingMpc(const TrackingMpcOptions& options, const model::VehicleParams& vehicle)
      : options_{options},
        configured_{vehicle},
        model_{vehicle},
        road_{options.road(), vehicle},
        estimator_{model_},
        solver_{tracking::make_tracking_solver(kRacingIterations)} {
    grip_.configure(configured_);
    shape_raced();
  }

  void configure(const TrackingMpcOptions& options, const model::VehicleParams& vehicle) noexcept override {
    if (options.learns() != options_.learns()) grip_.forget();
    options_ = options;
    if (!(vehicle == configured_)) grip_.configure(vehicle);
    configured_ = vehicle;
    configure_model();
    grip_.begin(estimator_, model_);
  }

  [[nodiscard]] const StepResult& step(const model::Measurement& now, Deadline deadline) noexcept override {
    sent_time_ = now.time + now.delay;
    const double act_time = now.time + (options_.compensate_delay ? now.delay : 0.0);
    if (!road_.add(now)) shape_raced();  // a learned lap was dropped
    estimator_.correct(now, sent_);
    if (options_.learns()) watch_grip(now);
    reserve_.see(estimator_, now.time, now.delay);
    blind_.note(now.is_finite(), now.time);
    roadless_.note(now.waypoint_count > 0, now.time);
    const Prediction start = estimator_.predict(act_time, sent_);
    is_returning_ = !place_on_line(now, start) || (is_returning_ && std::fabs(x0_[Problem::kE]) > kJoining);
    if (is_returning_ || estimator_.rolls_back()) return return_to_road(now, start, act_time);
    if (start.state.vx < kCrawl && stopping_speed(0.0) < kCrawl) return no_answer(act_time);
    prepare(act_time);
    const double started = deadline.elapsed();
    const solver::SolveReport report = solver_->solve(problem_, x0_, horizon_, iterations_, deadline);
    result_.report.solve_time = deadline.elapsed() - started;
    result_.report.solve = report;
    // A guess without an iteration is no answer.
    const bool is_guess = report.status == solver::SolveStatus::kBudgetSpent && report.iterations == 0;
    late_.note(!is_guess, now.time);
    if (is_guess && late_.is_long && start.state.vx > kCrawl) return stop_on_road(start);
    if (!usable(report.status) || is_guess) return no_answer(act_time);
    return accept(start, act_time);
  }

  void note_sent(const model::Command& command) noexcept override {
    if (std::isfinite(sent_time_)) sent_.add(sent_time_, command);
  }

  void use_line(std::shared_ptr<const road::RacingRoad> lap) noexcept override {
    const bool goes_on = has_horizon_;
    road_.race_by(std::move(lap));
    shape_raced();
    has_horizon_ =
        goes_on && move_to_line(line(), result_.plan, 2.0 * configured_.width, kFarFromLine, horizon_);
  }

  [[nodiscard]] LapRequest wants_lap() const noexcept override {
    const road::RacingRoad* lap = road_.lap();
    const std::span<const Vec2> waypoints = road_.seen().closed_waypoints();
    if (!options_.racing_line || (lap == nullptr && waypoints.empty())) return {};
    const road::LapTerms planned = lap != nullptr ? lap->terms() : road::LapTerms{options_.first_grip()};
    const bool is_known = lap != nullptr && !lap->is_learned();
    road::LapTerms terms = planned;
    if (grip_.is_shown()) terms.grip = grip_.for_plan(planned.grip);
    if (!is_known) terms.grip = std::min(terms.grip, 1.0);  // assumed edges: no more than configured
    terms.slides =
        options_.slide && is_known && grip_.may_slide(terms.grip, result_.report.delay, planned.slides);
    if (grip_.is_shown()) terms.slip = reserve_.for_plan(planned.slip);
    return {.is_wanted = lap == nullptr || terms != planned,
            .waypoints = is_known ? std::span<const Vec2>{} : waypoints,
            .terms = terms};
  }

  [[nodiscard]] double beside(const road::RacingRoad& lap) const noexcept override {
    return beside_lap(lap, road_.lap(), result_.plan, 2.0 * configured_.width, kFarFromLine);
  }

  void reset() noexcept override {
    road_.reset();
    estimator_.reset();
    grip_.forget();
    reserve_.forget();
    shape_raced();
    grip_.begin(estimator_, model_);
    sent_.clear();
    has_horizon_ = false;
    has_place_ = is_returning_ = false;
    for (Absence* each : {&blind_, &roadless_, &late_}) each->reset();
  }

  [[nodiscard]] std::string_view name() const noexcept override { return TrackingMpcEntry::kName; }
  [[nodiscard]] std::span<const std::string_view> cost_terms() const noexcept override {
    return TrackingTerms::kNames;
  }
  [[nodiscard]] std::span<const std::string_view> constraints() const noexcept override {
    return kConstraintNames;
  }

 private:
  [[nodiscard]] const road::ReferenceLine& line() const noexcept { return road_.line(); }

  /// Sets horizon and weights by the options.
  void shape_problem() noexcept {
    problem_.others = Problem::Step::of(model_, options_.step_length);
    problem_.first = problem_.others;
    problem_.horizon = options_.horizon_steps;
    problem_.weight = {.lateral = std::sqrt(options_.weight_lateral),
                       .heading = std::sqrt(options_.weight_heading),
                       .speed = std::sqrt(options_.weight_speed),
                       .steer_rate = std::sqrt(options_.weight_steer_rate),
                       .jerk = std::sqrt(options_.weight_jerk),
                       .edge = std::sqrt(options_.weight_edge),
                       .slip = std::sqrt(options_.weight_slip),
                       .excess_steer_rate = 40.0,  // root of the weight; chosen
                       .friction = std::sqrt(options_.weight_slip)};
    shape_edges();
  }

  /// Sets the parts of the car that stay on the road: on a planned lap the axles inside the real edges,
  /// otherwise the centre of mass inside the assumed width.
  void shape_edges() noexcept {
    problem_.nose = road_.is_raced() ? model_.vehicle().front_axle : 0.0;
    problem_.tail = road_.is_raced() ? model_.vehicle().rear_axle : 0.0;
    slips_ = road_.is_raced() ? road_.lap()->slips() : road::RacingRoad::Slips{};
  }

  /// Adapts estimator and model to the begin or end of a race by a planned lap.
  void shape_raced() noexcept {
    has_horizon_ = false;
    const bool races = road_.is_raced() || options_.learns();
    estimator_.estimate_disturbance(races);
    estimator_.mind_helper_gap(races);
    configure_model();
  }

  /// Sets model, road and problem by options, vehicle and grip. The speeds of the road use the estimated
  /// grip, at most the configured one; before there is an estimate, and without a planned lap, first_grip().
  void configure_model() noexcept {
    const model::VehicleParams car = model::with_grip(configured_, grip_.share());
    model_.set_vehicle(car);
    const double used =
        grip_.is_shown() || road_.is_raced() ? std::min(grip_.share(), 1.0) : options_.first_grip();
    road_.configure(options_.road(), model::with_grip(configured_, used));
    estimator_.set_model(model_);
    shape_problem();
  }

  /// Updates the estimated grip, and the model with it.
  void watch_grip(const model::Measurement& now) noexcept {
    const LearnedGrip::Change change = grip_.see(now, sent_);
    if (change == LearnedGrip::Change::kNothing) return;
    configure_model();
    if (change == LearnedGrip::Change::kModel) grip_.begin(estimator_, model_);
  }

  /// Room to both edges from the line at s [m] ahead; `offset`: of the line from the waypoints [m].
  [[nodiscard]] road::Road::Room room_at(double s, double offset) const noexcept {
    if (!road_.is_raced()) return road_.seen().room(offset);
    const model::VehicleParams& car = model_.vehicle();
    const double taken = 0.5 * (car.track_width + car.tire_width) + options_.edge_margin;
    const road::Road::Room room = road_.lap()->room(s_ + s);
    return {room.left - taken, room.right - taken};
  }

  /// Highest speed at s [m] ahead with which the car can stop by the braking of the speed plan [m/s]: from
  /// now on if measurements are missing, at the end of the known road if waypoints are missing; infinite
  /// otherwise.
  [[nodiscard]] double stopping_speed(double s) const noexcept {
    const model::VehicleParams& car = model_.vehicle();
    const double v = std::max(x0_[Problem::kVx], 0.0);
    const double braking =
        -options_.brake_share * longitudinal_acceleration(car, -car.brake_throttle_limit, v);
    double squared = std::numeric_limits<double>::infinity();
    if (blind_.is_long) squared = v * v - 2.0 * braking * s;
    if (roadless_.is_long && !line().is_closed())
      squared = std::min(squared, 2.0 * braking * (line().length() - s_ - s));
    return std::sqrt(std::max(squared, 0.0));
  }

  /// Sets the predicted start in coordinates along the line. False if the car is far from the line or turned
  /// away.
  bool place_on_line(const model::Measurement& now, const Prediction& start) noexcept {
    StepReport& report = result_.report;
    report = {};
    report.solve.status = solver::SolveStatus::kNotFinite;  // until there is an answer
    report.delay = now.delay;
    if (options_.learns()) report.learned.grip = grip_.estimate();
    const road::ReferenceLine& line = this->line();
    if (line.is_empty() || !std::isfinite(start.state.x + start.state.y + start.state.psi + start.state.vx))
      return false;
    if (revision_ != road_.revision()) has_place_ = false;
    const double* last = has_place_ ? &s_ : nullptr;
    const road::ReferenceLine::Projection place =
        line.find({start.state.x, start.state.y}, start.state.psi, 2.0 * model_.vehicle().width, last,
                  0.5 * kFarFromLine);
    if (!(place.distance < kFarFromLine)) return false;
    const double heading_error = angle_difference(start.state.psi, line.at(place.s).heading);
    const double most = start.state.vx < kSlow ? 0.25 * kPi : 0.5 * kPi;
    if (std::fabs(heading_error) > most) return false;
    disturbance_ = start.disturbance;
    s_ = place.s;
    has_place_ = true;
    revision_ = road_.revision();
    x0_ = {0.0,           place.d,           heading_error,     start.state.vx, start.state.vy,
           start.state.r, start.state.steer, start.acceleration};

    const road::ReferenceLine::Projection measured =
        line.project({now.x, now.y}, s_, road::ReferenceLine::kWindow);
    report.lateral_error = measured.d;
    report.heading_error = angle_difference(now.psi, line.at(measured.s).heading);
    report.speed_reference = line.demand(s_).speed;
    report.sight = line.is_closed() ? line.length() : line.length() - s_;
    report.has_map = line.is_closed();
    return true;
  }

  /// Prepares the problem of this step and its first guess: the last answer, shifted by the elapsed time, or
  /// without one the motion by a path-following law.
  void prepare(double act_time) noexcept {
    problem_.model = &model_;  // set in each step, so that a copied controller uses its own model
    const double elapsed = act_time - act_time_;
    const bool can_shift =
        has_horizon_ && elapsed >= 0.0 && elapsed < 0.5 * (old_first_ + (horizon_.horizon - 1) * old_step_);
    const double step = options_.step_length;
    const double first = can_shift ? std::clamp(elapsed, step, kLongestHold) : step;
    problem_.first = first == step ? problem_.others : Problem::Step::of(model_, first);
    problem_.first_correction = {};
    problem_.push(disturbance_);
    iterations_ = kMostIterations;
    if (can_shift) {
      const int later = static_cast<int>(elapsed / kTimePerIteration + 0.5);
      iterations_ = std::clamp(options_.iterations - 1 + later, options_.iterations, kMostIterations);
      shift_answer(elapsed);
    } else {
      follow_line();
    }
    if (road_.is_raced() && !(configured_.friction_coupling > 0.0)) iterations_ = kRacingIterations;
    if (road_.is_raced()) add_helper_gap(problem_, horizon_, line(), s_);
    problem_.correct_first(x0_, horizon_.u[0]);
    act_time_ = act_time;
    old_first_ = first;
    old_step_ = step;
  }

  /// Makes the last answer, `elapsed` [s] later, the first guess, and reads the road at its states.
  void shift_answer(double elapsed) noexcept {
    old_ = horizon_;
    const double last = old_.horizon;
    // Stage of the last answer at a time since its start, as a real number.
    const auto stage_at = [&](double time) {
      const double stage = time < old_first_ ? time / old_first_ : 1.0 + (time - old_first_) / old_step_;
      return std::clamp(stage, 0.0, last);
    };
    const auto blend = [](const auto& from, const auto& to, double share) {
      auto value = from;
      for (std::size_t i = 0; i < value.size(); ++i) value[i] += share * (to[i] - from[i]);
      return value;
    };
    const auto state_at = [&](double stage) {
      const std::size_t j = std::min(static_cast<std::size_t>(stage), static_cast<std::size_t>(last - 1.0));
      return blend(old_.x[j], old_.x[j + 1], stage - static_cast<double>(j));
    };
    const double begin = state_at(stage_at(elapsed))[Problem::kS];
    horizon_.horizon = options_.horizon_steps;
    horizon_.x[0] = x0_;
    for (int k = 0; k <= horizon_.horizon; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double time = problem_.time(k) + elapsed;
      if (k > 0) {
        horizon_.x[i] = state_at(stage_at(time));
        // Beyond the end of the last answer: continue at its last speed.
        const double beyond = std::max(0.0, time - old_first_ - (last - 1.0) * old_step_);
        horizon_.x[i][Problem::kS] += beyond * horizon_.x[i][Problem::kVx] - begin;
      }
      ask_road(k, horizon_.x[i]);
      if (k == horizon_.horizon) break;
      const double stage = std::min(stage_at(time), last - 1.0);
      const auto j = static_cast<std::size_t>(stage);
      const std::size_t next = std::min(j + 1, static_cast<std::size_t>(last - 1.0));
      horizon_.u[i] =
          problem_.within_bounds(k, blend(old_.u[j], old_.u[next], stage - static_cast<double>(j)));
    }
  }

  /// Makes a guess by simulating a path-following law.
  void follow_line() noexcept {
    horizon_.horizon = options_.horizon_steps;
    horizon_.x[0] = x0_;
    for (int k = 0; k < horizon_.horizon; ++k) {
      const auto i = static_cast<std::size_t>(k);
      ask_road(k, horizon_.x[i]);
      horizon_.u[i] = problem_.within_bounds(k, path_law(problem_, k, horizon_.x[i]));
      horizon_.x[i + 1] = solver::next_state(problem_, k, horizon_.x[i], horizon_.u[i]);
      clamp_to_road(horizon_.x[i + 1]);
    }
    ask_road(horizon_.horizon, horizon_.x[static_cast<std::size_t>(horizon_.horizon)]);
  }

  /// Sets the road of stage k for a car near state x.
  void ask_road(int k, const StageState& x) noexcept {
    const double s = x[Problem::kS];
    road::ReferenceLine::Demand demand = line().demand(s_ + s);
    double haste = options_.haste(demand.speed * demand.speed_slope);
    if (!road_.is_raced() || k == problem_.horizon || demand.speed < kCrawl) haste = 0.0;
    haste = std::clamp(model_.vehicle().valid_speed - demand.speed, 0.0, haste);
    if (const double stop = stopping_speed(s); stop < demand.speed) {
      demand.speed = stop;
      demand.speed_slope = haste = 0.0;
    }
    const road::Road::Room room = room_at(s + problem_.nose, demand.offset);
    const road::Road::Room behind = room_at(s - problem_.tail, demand.offset);
    const model::VehicleParams& car = model_.vehicle();
    const double v = std::max(x[Problem::kVx], 0.0);
    // A larger error would outweigh all other terms.
    const bool is_reachable = demand.speed < v + kSpeedAhead;
    const auto i = static_cast<std::size_t>(k);
    Problem::Road& road = problem_.road;
    road.s[i] = s;
    road.curvature[i] = demand.curvature;
    road.curvature_slope[i] = demand.curvature_slope;
    road.speed[i] = haste + (is_reachable ? demand.speed : v + kSpeedAhead);
    road.speed_slope[i] = is_reachable ? demand.speed_slope : 0.0;
    road.slide_front[i] = model::SlidingBound::share(demand.speed) * (slips_.front - 1.0);
    road.slide_rear[i] = model::SlidingBound::share(demand.speed) * (slips_.rear - 1.0);
    road.steadiness[i] = std::max(1.0, v / kSteadySpeed);
    road.sideslip[i] = road_.is_raced() ? road_.lap()->sideslip(s_ + s) : 0.0;
    road.left[i] = room.left;
    road.right[i] = room.right;
    road.tail_left[i] = behind.left;
    road.tail_right[i] = behind.right;
    road.acceleration_min[i] = longitudinal_acceleration(car, -car.brake_throttle_limit, v);
    road.acceleration_max[i] = longitudinal_acceleration(car, 1.0, v);
  }

  /// Result with the plan of a usable answer.
  const StepResult& accept(const Prediction& start, double act_time) noexcept {
    has_horizon_ = true;
    result_.answer = Answer::kDrive;
    fill_plan(act_time);
    result_.command = {horizon_.u[0][0], throttle_for(model_.vehicle(), horizon_.u[0][1], start.state.vx)};
    explain<TrackingTerms>(problem_, horizon_, result_.report.explanation);
    explain_speed(line().demand(s_), start.state.vx, road_.is_raced() ? &model_.vehicle() : nullptr,
                  result_.report.explanation);
    return result_;
  }

  /// Result without a plan: steers by feedback to the line, and brakes fully.
  const StepResult& stop_on_road(const Prediction& start) noexcept {
    const model::VehicleParams& car = model_.vehicle();
    const int ahead = std::min(static_cast<int>(kPreview / options_.step_length), options_.horizon_steps - 1);
    const double v = start.state.vx, braking = longitudinal_acceleration(car, -car.brake_throttle_limit, v);
    result_.command = {
        std::clamp(path_law(problem_, ahead, horizon_.x[0])[0], -car.steer_limit, car.steer_limit),
        throttle_for(car, braking, v)};
    return without_plan(Answer::kStopOnRoad);
  }

  /// Result without a plan; the command is set.
  const StepResult& without_plan(Answer answer) noexcept {
    has_horizon_ = false;
    result_.answer = answer;
    result_.plan.size = result_.plan.reference_size = 0;
    return result_;
  }

  /// Result for a car that has spun, or is far from its line: no answer until it is slow, then walking pace
  /// to the road.
  const StepResult& return_to_road(const model::Measurement& now, const Prediction& start,
                                   double act_time) noexcept {
    const road::ReferenceLine& line = this->line();
    const model::State& car = start.state;
    const bool is_known = std::isfinite(car.x + car.y + car.psi + car.vx + now.time + now.delay);
    if (line.is_empty() || !is_known) return no_answer(act_time);
    const road::ReferenceLine::Projection place =
        line.project_along({car.x, car.y}, car.psi, 2.0 * model_.vehicle().width);
    result_.report.lateral_error = std::copysign(place.distance, place.d);
    result_.report.heading_error = angle_difference(car.psi, line.at(place.s).heading);
    const bool must_stop = blind_.is_long || roadless_.is_long;
    const bool rolls_back = estimator_.rolls_back();
    if (must_stop || !(place.distance < kLost) || !(rolls_back || std::fabs(car.vx) < kSlow))
      return no_answer(act_time);
    result_.command =
        rolls_back ? model::Command{0.0, tracking::throttle_against_rolling_back(model_.vehicle(), now.speed)}
                   : tracking::way_back(line, place, car, model_.vehicle());
    return without_plan(Answer::kReturnToRoad);
  }

  const StepResult& no_answer(double act_time) noexcept {
    result_.report.act_time = act_time;
    return without_plan(Answer::kNone);
  }

  /// Writes the answer in W.
  void fill_plan(double act_time) noexcept {
    const road::ReferenceLine& line = this->line();
    Plan& plan = result_.plan;
    const int n = options_.horizon_steps;
    plan.size = plan.reference_size = n + 1;
    for (int k = 0; k <= n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const StageState& x = horizon_.x[i];
      const StageInput& u = horizon_.u[static_cast<std::size_t>(std::min(k, n - 1))];
      const road::CurvePoint at = line.at(s_ + x[Problem::kS]);
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
  model::VehicleParams configured_;  ///< vehicle of the configuration
  model::PredictionModel model_;     ///< configured_ with the estimated grip
  SlipReserve reserve_;
  LearnedGrip grip_{model_};
  road::DrivenRoad road_;
  tracking::StateEstimator estimator_;
  tracking::CommandHistory sent_;
  road::RacingRoad::Slips slips_;  ///< slips of the planned lap
  Problem problem_;
  Owned<tracking::TrackingSolver> solver_;
  Horizon horizon_;  ///< in a step: first the last answer, then the guess, then the new answer
  Horizon old_;      ///< copy of the last answer in shift_answer()
  StageState x0_{};  ///< state where the command acts
  tracking::Disturbance disturbance_;  ///< estimate for the horizon
  StepResult result_;
  double s_ = 0.0;                    ///< arc length on the line where the command acts [m]
  double act_time_ = 0.0;             ///< time at which the last answer begins [s]
  double sent_time_ = 0.0;            ///< time from which the last command acts [s]
  double old_first_ = 0.0;            ///< length of the first stage of the last answer [s]
  double old_step_ = 0.0;             ///< step of its other stages [s]
  int iterations_ = kMostIterations;  ///< iterations of the solver in this step
  unsigned revision_ = 0;             ///< number of the road's line that s_ refers to
  bool has_place_ = false;            ///< s_ is valid
  bool has_horizon_ = false;          ///< horizon_ holds the last answer
  bool is_returning_ = false;         ///< on the way back to the road
  Absence blind_{kBlindAfter};        ///< absence of measurements
  Absence roadless_{kBlindAfter};     ///< absence of waypoints
  Absence late_{kBlindAfter};         ///< absence of answers within the time budget
};

}  // namespace

Result<std::unique_ptr<Controller>> make_tracking_mpc(const TrackingMpcOptions& options,
                                                      const model::VehicleParams& vehicle) {
  if (const auto valid = check<TrackingMpcEntry>(options, vehicle); !valid) return fail(valid.error());
  return std::make_unique<TrackingMpc>(options, vehicle);
}

}  // namespace chicane::controller
