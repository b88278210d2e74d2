// SPDX-License-Identifier: MIT
// The controller `cubic-mpc`: roll-forward over the delay, fit of the line, solve, command; and its table of
// options.
#include "chicane/controller/cubic_mpc.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "chicane/base/instruction_set.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/owned.hpp"
#include "chicane/base/text.hpp"
#include "chicane/controller/controller_list.hpp"
#include "chicane/controller/cubic_problem.hpp"
#include "chicane/controller/cubic_solver.hpp"
#include "chicane/controller/explain.hpp"
#include "chicane/solver/warm_start.hpp"

namespace chicane::controller {
namespace {

// Limit of iterations; chosen: one solve in thousands needs more than 40, if the cubic reaches far beyond the
// waypoints.
constexpr int kMaxIterations = 100;
constexpr int kReferencePoints = 32;  // points of the line that viewers draw; chosen

/// Speed of the roll-forward for 1 m/s (CubicMpcOptions::roll_forward_in_mph).
double roll_forward_unit(const CubicMpcOptions& options) noexcept {
  return options.roll_forward_in_mph ? mps_to_mph(1.0) : 1.0;
}

class CubicMpc final : public CopyableController<CubicMpc>, public Tunable<CubicMpcOptions> {
 public:
  CubicMpc(const CubicMpcOptions& options, const model::VehicleParams& vehicle,
           std::unique_ptr<CubicSolver> solver)
      : uses_polar_{options.polar_waypoints},
        line_order_{options.line_order},
        steer_sign_{options.steering_right_positive ? -1.0 : 1.0},
        stages_{options.horizon_steps - 1},
        roll_forward_{options.latency_handling, options.latency, vehicle.kinematic_length,
                      roll_forward_unit(options), options.latency_acceleration_term},
        problem_{options, vehicle},
        solver_{std::move(solver)} {
    reset();
  }

  [[nodiscard]] const StepResult& step(const model::Measurement& now, Deadline deadline) noexcept override {
    result_.report = {};
    result_.report.solve.status = solver::SolveStatus::kNotFinite;  // until there is an answer
    if (!std::isfinite(now.time + now.steer + now.throttle) || !now.is_finite()) return no_answer(now);
    start_ = roll_forward_.predict(now);  // state when the command acts
    start_time_ = now.time + roll_forward_.compensated();
    if (!see_line(now)) return no_answer(now);  // cubic through the waypoints, seen from that state
    shift_warm_start();                         // last answer, shifted by the elapsed time
    solve(now, deadline);
    if (!usable(result_.report.solve.status)) return no_answer(now);
    return accept();
  }

  void configure(const CubicMpcOptions& options, const model::VehicleParams& vehicle) noexcept override {
    const double steer_sign = options.steering_right_positive ? -1.0 : 1.0;
    const bool stays_valid = steer_sign == steer_sign_;  // inputs of the last answer keep their sign
    const double ratio = options.step_length / problem_.dt;
    uses_polar_ = options.polar_waypoints;
    line_order_ = options.line_order;
    steer_sign_ = steer_sign;
    stages_ = options.horizon_steps - 1;
    roll_forward_.configure(options.latency_handling, options.latency, vehicle.kinematic_length,
                            roll_forward_unit(options), options.latency_acceleration_term);
    problem_ = CubicProblem{options, vehicle};
    if (has_answer_ && stays_valid) {
      solver::resample(answer_, stages_, ratio);
    } else {
      forget_warm_start();
    }
  }

  void reset() noexcept override {
    roll_forward_.reset();
    forget_warm_start();
    result_ = {};
  }

  [[nodiscard]] std::string_view name() const noexcept override { return CubicMpcEntry::kName; }
  [[nodiscard]] std::span<const std::string_view> cost_terms() const noexcept override {
    return CubicTerms::kNames;
  }
  [[nodiscard]] std::span<const std::string_view> constraints() const noexcept override {
    return kInputConstraintNames;
  }

 private:
  /// Fits the line in the frame of start_, and reports the offset of the measured position. False without a
  /// line.
  bool see_line(const model::Measurement& now) noexcept {
    const LocalPoints local =
        uses_polar_ ? to_car_frame_polar(now, start_.pose) : to_car_frame(now, start_.pose);
    Cubic line = problem_.line;
    if (!fit_cubic(local.view(), line, line_order_)) return false;
    problem_.follow(line);
    const Vec2 seen = to_start_frame(now.x, now.y);
    const double slope = problem_.line.slope(seen.x());
    StepReport& report = result_.report;
    report.lateral_error = (seen.y() - problem_.line.at(seen.x())) / hypot(1.0, slope);
    report.heading_error = angle_difference(now.psi, start_.pose.psi + atan(slope));
    report.speed_reference = problem_.speed_reference / problem_.speed_unit;
    report.delay = start_time_ - now.time;
    for (const Vec2& point : local.view()) report.sight = std::max(report.sight, point.x());
    return true;
  }

  /// First state of the horizon, in the car's own frame with the car at the origin (equations 8 and 9).
  [[nodiscard]] CubicProblem::State initial_state(const model::Measurement& now) const noexcept {
    return {0.0,
            0.0,
            0.0,
            start_.speed * problem_.speed_unit,
            -atan(problem_.line.slope(0.0)),
            steer_sign_ * now.steer,
            now.throttle};
  }

  /// Solves from the present guess, and measures the time.
  void solve(const model::Measurement& now, const Deadline& deadline) noexcept {
    const double started = deadline.elapsed();
    result_.report.solve = solver_->solve(problem_, initial_state(now), answer_, deadline);
    result_.report.solve_time = deadline.elapsed() - started;
  }

  /// Shifts the last answer by the time since its start: the guess of this step.
  void shift_warm_start() noexcept {
    if (has_answer_) solver::shift(answer_, (start_time_ - answer_time_) / problem_.dt);
  }

  /// Makes zero inputs the guess.
  void forget_warm_start() noexcept {
    has_answer_ = false;
    answer_.horizon = stages_;
    answer_.u.fill({});
  }

  /// Result of a step with a usable answer of the solver.
  const StepResult& accept() noexcept {
    has_answer_ = true;
    result_.answer = Answer::kDrive;
    answer_time_ = start_time_;
    write_plan();
    explain_answer();
    result_.command = result_.plan.points[0].command;
    return result_;
  }

  /// Fills the explanation of the report.
  void explain_answer() noexcept {
    Explanation& explanation = result_.report.explanation;
    explain<CubicTerms>(problem_, answer_, explanation);
    explanation.speed_limit = result_.report.speed_reference;
    explanation.speed_limiter =
        limiter_of(start_.speed, explanation.speed_limit, SpeedLimiter::kAsked, explanation.active_now);
  }

  /// Result of a step without an answer.
  const StepResult& no_answer(const model::Measurement& now) noexcept {
    forget_warm_start();
    result_.answer = Answer::kNone;
    result_.report.act_time = now.time + roll_forward_.compensated();
    return result_;
  }

  /// Fills the plan: the answer in W. With the latency inside the model an input acts one stage late; a point
  /// has the input that acts on its state.
  void write_plan() noexcept {
    Plan& plan = result_.plan;
    const int late = problem_.acts_late ? 1 : 0;
    plan.size = stages_ + 1 - late;
    for (int j = 0; j < plan.size; ++j) {
      const auto& x = answer_.x[static_cast<std::size_t>(j + late)];
      const auto& u = answer_.u[static_cast<std::size_t>(std::min(j, stages_ - 1))];
      const Vec2 position = to_world(x[CubicProblem::kX], x[CubicProblem::kY]);
      plan.points[static_cast<std::size_t>(j)] = {.time = start_time_ + (j + late) * problem_.dt,
                                                  .x = position.x(),
                                                  .y = position.y(),
                                                  .psi = start_.pose.psi + x[CubicProblem::kPsi],
                                                  .speed = x[CubicProblem::kV] / problem_.speed_unit,
                                                  .command = {steer_sign_ * u[0], u[1]}};
    }
    plan.reference_size = kReferencePoints;
    for (int i = 0; i < kReferencePoints; ++i) {
      const double x = result_.report.sight * i / (kReferencePoints - 1);
      plan.reference[static_cast<std::size_t>(i)] = to_world(x, problem_.line.at(x));
    }
  }

  /// Point of W in the frame of start_ [m].
  [[nodiscard]] Vec2 to_start_frame(double x, double y) const noexcept {
    const double cosine = cos(start_.pose.psi);
    const double sine = sin(start_.pose.psi);
    const double dx = x - start_.pose.x;
    const double dy = y - start_.pose.y;
    return {cosine * dx + sine * dy, cosine * dy - sine * dx};
  }

  /// Point of the frame of start_ in W [m].
  [[nodiscard]] Vec2 to_world(double x, double y) const noexcept {
    const double cosine = cos(start_.pose.psi);
    const double sine = sin(start_.pose.psi);
    return {start_.pose.x + cosine * x - sine * y, start_.pose.y + sine * x + cosine * y};
  }

  bool uses_polar_;    ///< CubicMpcOptions::polar_waypoints
  int line_order_;     ///< CubicMpcOptions::line_order
  double steer_sign_;  ///< sign of the model's steering: 1 for left positive, else −1
  int stages_;         ///< number of intervals of the horizon
  RollForward roll_forward_;
  CubicProblem problem_;
  Owned<CubicSolver> solver_;
  Motion start_;              ///< start of the horizon: motion when the command acts, in W
  double start_time_ = 0.0;   ///< time when the command acts [s]
  CubicTrajectory answer_;    ///< last usable solve, in the frame of its start
  double answer_time_ = 0.0;  ///< start of answer_ [s]
  bool has_answer_ = false;   ///< answer_ is usable as a guess
  StepResult result_;
};

using C = CubicMpcOptions;
constexpr double kHighestWeight = 1e6;  // limit of the weights; chosen, far above useful ones
constexpr std::array<std::string_view, 5> kLatencyHandlings{
    "none", "roll-forward", "measured", "position-only", "inside-model"};  // names in the order of the enum
constexpr std::array kOptions{
    option<&C::horizon_steps>("horizon_steps", unit::kNone, 2, CubicProblem::kCapacity,
                              "N, the steps the plan looks ahead."),
    option<&C::step_length>("step_length", unit::kSecond, 0.005, 0.5,
                            "dt, the time between two points of the plan."),
    option<&C::speed_reference>("speed_reference", unit::kSpeed, 0, 110,
                                "v_ref, the speed the cost pulls towards."),
    option<&C::latency_handling>("latency_handling", kLatencyHandlings,
                                 "Treatment of the time between measurement and actuation."),
    option<&C::latency>("latency", unit::kMillisecond, 0, 500, "Compensated delay when it is not measured."),
    option<&C::polar_waypoints>("polar_waypoints",
                                "Waypoints to the car's frame by radius and angle instead of a rotation."),
    option<&C::steering_right_positive>("steering_right_positive",
                                        "Model written with the simulator's steering sign."),
    option<&C::lateral_error_to_left>(
        "lateral_error_to_left",
        "Write-up of `measured-latency`: cte is y − f(x), so that + v sin eψ dt has the right sign."),
    option<&C::heading_error_integrated>(
        "heading_error_integrated",
        "Write-up of `measured-latency`: eψ⁺ = eψ + v δ dt / L_f from step to step."),
    option<&C::lateral_error_integrated>(
        "lateral_error_integrated",
        "Write-up of `measured-latency`: cte⁺ = cte + v sin eψ dt from step to "
        "step. The plan does not see the bend ahead."),
    option<&C::line_order>("line_order", unit::kNone, 1, 3,
                           "Order of the polynomial that is fitted through the waypoints."),
    option<&C::latency_acceleration_term>(
        "latency_acceleration_term",
        "Give the measured roll-forward the term a tan δ τ² / (2 L_f) of `measured-latency`'s write-up."),
    option<&C::speed_in_mph>("speed_in_mph", "Let the model take miles per hour for metres per second."),
    option<&C::roll_forward_in_mph>("roll_forward_in_mph",
                                    "Let the roll-forward over the latency do so, too."),
    option<&C::weight_lateral>("weight_lateral", unit::per("1/m²"), 0, kHighestWeight,
                               "Weight of the squared lateral error."),
    option<&C::weight_heading>("weight_heading", unit::per("1/rad²"), 0, kHighestWeight,
                               "Weight of the squared heading error."),
    option<&C::weight_speed>("weight_speed", unit::per("s²/m²"), 0, kHighestWeight,
                             "Weight of the squared speed error."),
    option<&C::weight_steer>("weight_steer", unit::per("1/rad²"), 0, kHighestWeight,
                             "Weight of the squared steering angle."),
    option<&C::weight_throttle>("weight_throttle", unit::kNone, 0, kHighestWeight,
                                "Weight of the squared throttle."),
    option<&C::weight_steer_change>("weight_steer_change", unit::per("1/rad²"), 0, kHighestWeight,
                                    "Weight of the squared change of steering between steps."),
    option<&C::weight_throttle_change>("weight_throttle_change", unit::kNone, 0, kHighestWeight,
                                       "Weight of the squared change of throttle between steps."),
    option<&C::weight_speed_steer>("weight_speed_steer", unit::per("s²/(m² rad²)"), 0, kHighestWeight,
                                   "Weight of the squared product of speed and steering: slows in turns."),
};

}  // namespace

std::span<const Option> CubicMpcEntry::options() noexcept { return kOptions; }

std::vector<OptionContradiction> CubicMpcEntry::contradictions(const CubicMpcOptions& options) {
  if (options.lateral_error_integrated && !options.heading_error_integrated)
    return {
        {"lateral_error_integrated",
         "got true, expected cubic_mpc.heading_error_integrated=true beside it: the write-up has both errors "
         "from step to step"}};
  constexpr double kSame = 1e-9;  // [s] rounding of a time that is written in ms and in s
  const bool shifts_by_a_step = options.latency_handling == LatencyHandling::kInsideModel;
  if (!shifts_by_a_step || std::fabs(options.latency - options.step_length) <= kSame) return {};
  return {{"latency", "got " + number_text(options.latency * 1e3, 6) +
                          " ms, expected cubic_mpc.step_length_s (" + number_text(options.step_length, 6) +
                          " s), because latency_handling inside-model shifts by exactly one step"}};
}

std::unique_ptr<CubicSolver> make_cubic_solver() {
  return with_instructions(chosen_instruction_set(), [&](auto instructions) {
    return make_cubic_solver<decltype(instructions)>({.max_iterations = kMaxIterations});
  });
}

Result<std::unique_ptr<Controller>> make_cubic_mpc(const CubicMpcOptions& options,
                                                   const model::VehicleParams& vehicle) {
  return make_cubic_mpc_with(options, vehicle, make_cubic_solver());
}

Result<std::unique_ptr<Controller>> make_cubic_mpc_with(const CubicMpcOptions& options,
                                                        const model::VehicleParams& vehicle,
                                                        std::unique_ptr<CubicSolver> solver) {
  if (const auto valid = check<CubicMpcEntry>(options, vehicle); !valid) return fail(valid.error());
  return std::make_unique<CubicMpc>(options, vehicle, std::move(solver));
}

}  // namespace chicane::controller
