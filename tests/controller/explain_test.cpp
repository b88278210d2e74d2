// SPDX-License-Identifier: MIT
#include "chicane/controller/explain.hpp"

#include "chicane/controller/baselines.hpp"
#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/controller/tracking_mpc.hpp"
#include "chicane/road/line_planner.hpp"
#include "controller/sample_road.hpp"
#include "support/chicane_test.hpp"

namespace chicane::controller {
namespace {

std::unique_ptr<Controller> tracking(const TrackingMpcOptions& options = {}) {
  return std::move(*make_tracking_mpc(options, model::udacity_params()));
}
std::unique_ptr<Controller> cubic(const CubicMpcOptions& options = {}) {
  return std::move(*make_cubic_mpc(options, model::udacity_params()));
}

/// The answer after a few cycles in which the car stands still in `now`'s world.
StepResult answer(Controller& controller, model::Measurement now) {
  for (int i = 0; i < 5; ++i) {
    controller.note_sent(controller.step(now, Deadline::never()).command);
    now.time += 0.001;
  }
  return controller.step(now, Deadline::never());
}

double sum(const Explanation& explanation) {
  return std::accumulate(explanation.cost_terms.begin(),
                         explanation.cost_terms.begin() + explanation.cost_term_count, 0.0);
}

double term(const Controller& controller, const Explanation& explanation, std::string_view name) {
  const auto names = controller.cost_terms();
  const auto found = std::find(names.begin(), names.end(), name);
  EXPECT_NE(found, names.end()) << name;
  return explanation.cost_terms[static_cast<std::size_t>(found - names.begin())];
}

TEST(Explanation, CostTermsAddUpToTheSolversCost) {
  for (const auto& controller : {tracking(), cubic()}) {
    const StepReport report = answer(*controller, on_a_left_bend()).report;
    ASSERT_EQ(report.explanation.cost_term_count, static_cast<int>(controller->cost_terms().size()));
    ASSERT_GT(report.solve.cost, 0.0);
    // 1e-9: the same squares, added in another order.
    EXPECT_NEAR(sum(report.explanation), report.solve.cost, 1e-9 * report.solve.cost) << controller->name();
  }
}

TEST(Explanation, ATermIsPaidForWhatItNames) {
  model::Measurement aside = on_a_left_bend();
  aside.y += 1.0;
  const auto controller = tracking({.smoothing_width = 0.0});
  const Explanation near = answer(*controller, on_a_left_bend()).report.explanation;
  controller->reset();
  const Explanation far = answer(*controller, aside).report.explanation;
  EXPECT_GT(term(*controller, far, "lateral"), 3.0 * term(*controller, near, "lateral"));
  EXPECT_EQ(term(*controller, near, "edge"), 0.0);

  const auto weighted = cubic({.weight_speed_steer = 10.0});
  EXPECT_GT(term(*weighted, answer(*weighted, on_a_left_bend()).report.explanation, "speed_steer"), 0.0);
  const auto free = cubic();
  EXPECT_EQ(term(*free, answer(*free, on_a_left_bend()).report.explanation, "speed_steer"), 0.0);
}

TEST(Explanation, NamesTheEdgeTheCarIsBeyond) {
  model::Measurement aside = on_a_left_bend();
  aside.y += 2.5;  // 3 m left of the line, more than the road is assumed to be wide
  const auto controller = tracking({.assumed_half_width = 2.0, .smoothing_width = 0.0});
  const Explanation left = answer(*controller, aside).report.explanation;
  EXPECT_NE(left.active_now & bit(Constraint::kLeftEdge), 0U);
  EXPECT_EQ(left.active_ahead & bit(Constraint::kRightEdge), 0U);
  controller->reset();
  const Explanation right = answer(*controller, mirrored(aside)).report.explanation;
  EXPECT_NE(right.active_now & bit(Constraint::kRightEdge), 0U);
}

TEST(Explanation, SaysWhatLimitsTheSpeed) {
  model::Measurement now = on_a_left_bend();
  now.speed = 5.0;
  const auto slow = tracking();
  const Explanation power = answer(*slow, now).report.explanation;
  EXPECT_NE(power.active_now & bit(Constraint::kThrottleMax), 0U);
  EXPECT_EQ(power.speed_limiter, SpeedLimiter::kPower);

  const auto limited = tracking({.speed_limit = 15.0});
  const Explanation asked = answer(*limited, on_a_left_bend()).report.explanation;
  EXPECT_EQ(asked.speed_limiter, SpeedLimiter::kAsked);
  EXPECT_DOUBLE_EQ(asked.speed_limit, 15.0);

  now.speed = 45.0;  // with 54 m of known road ahead
  const auto blind = tracking();
  EXPECT_EQ(answer(*blind, now).report.explanation.speed_limiter, SpeedLimiter::kSight);

  const auto described = cubic({.speed_reference = 15.0});
  EXPECT_EQ(answer(*described, on_a_left_bend()).report.explanation.speed_limiter, SpeedLimiter::kAsked);
}

TEST(Explanation, SaysWhatLimitsTheSpeedOfAPlannedLap) {
  const model::VehicleParams car = model::road_car_params();
  const auto says = [&](const road::ReferenceLine::Demand& planned, std::uint32_t active = 0) {
    return limiter_of_lap(planned, car, active);
  };
  const double v = 20.0, grip = car.cornering_friction() * car.load(v) / (v * v);
  const double most = longitudinal_acceleration(car, 1.0, v) / v;
  EXPECT_EQ(says({.curvature = grip, .speed = v}), SpeedLimiter::kCurvature);
  EXPECT_EQ(says({.curvature = 0.5 * grip, .speed = v, .speed_slope = -0.2}), SpeedLimiter::kBraking);
  EXPECT_EQ(says({.speed = v, .speed_slope = most}), SpeedLimiter::kPower);
  EXPECT_EQ(says({.curvature_slope = car.steer_rate_limit / (car.wheelbase() * v), .speed = v}),
            SpeedLimiter::kSteerRate);
  EXPECT_EQ(says({.speed = v}, bit(Constraint::kLeftEdge)), SpeedLimiter::kEdge);
  EXPECT_EQ(says({.speed = v}, bit(Constraint::kFrictionEllipse)), SpeedLimiter::kCurvature);
  EXPECT_EQ(says({.curvature = grip, .speed = v}, bit(Constraint::kThrottleMax)), SpeedLimiter::kPower);
  EXPECT_EQ(says({.speed = v}), SpeedLimiter::kPlan);
}

TEST(Explanation, BaselinesKnowTheirInputsAndTheBendAhead) {
  const auto pid = std::move(*make_pid({.proportional_gain = 10.0, .speed = {}}, model::udacity_params()));
  const Explanation full_lock = answer(*pid, on_a_left_bend()).report.explanation;
  EXPECT_NE(full_lock.active_now & bit(Constraint::kSteerLimit), 0U);
  EXPECT_EQ(full_lock.cost_term_count, 0);
  EXPECT_TRUE(pid->cost_terms().empty());

  // 80 m of radius at 1 m/s² allow 9 m/s.
  const PidOptions gentle{.proportional_gain = 0.06,
                          .speed = {.speed_reference = 30.0, .lateral_acceleration_limit = 1.0}};
  const auto careful = std::move(*make_pid(gentle, model::udacity_params()));
  const Explanation bend = answer(*careful, on_a_left_bend()).report.explanation;
  EXPECT_TRUE(bend.speed_limiter == SpeedLimiter::kCurvature || bend.speed_limiter == SpeedLimiter::kBraking);
  EXPECT_LT(bend.speed_limit, 15.0);
}

TEST(Explanation, IsEmptyWithoutAnAnswer) {
  model::Measurement blind = on_a_left_bend();
  blind.waypoint_count = 0;
  for (const auto& controller : {tracking(), cubic()}) {
    const StepResult& result = controller->step(blind, Deadline::never());
    ASSERT_EQ(result.answer, Answer::kNone);
    const StepReport& report = result.report;
    EXPECT_EQ(report.explanation.cost_term_count, 0) << controller->name();
    EXPECT_EQ(report.explanation.active_ahead, 0U);
    EXPECT_TRUE(std::isnan(report.explanation.speed_limit));
  }
}

/// A straight of 300 m, a bend of 40 m radius, a straight of 300 m, open. For a speed plan only: no
/// positions.
road::ReferenceLine straight_bend_straight() {
  constexpr int kIntervals = 442;
  road::ReferenceLine line(kIntervals + 1);
  EXPECT_TRUE(line.shape(663.0, kIntervals, false));
  for (std::size_t i = 200; i <= 242; ++i) line.samples()[i].curve.curvature = 1.0 / 40.0;
  return line;
}

TEST(SpeedPlan, KnowsWhichPassBoundIt) {
  road::ReferenceLine line = straight_bend_straight();
  road::SpeedPlan plan(static_cast<int>(line.samples().size()));
  plan.begin(model::road_car_params(), {.speed_limit = 35.0});
  int work = 1'000'000;
  ASSERT_TRUE(plan.advance(work, line));
  std::vector<SpeedLimiter> met;
  for (const road::ReferenceLine::Sample& sample : line.samples()) {
    if (met.empty() || met.back() != sample.limiter) met.push_back(sample.limiter);
  }
  const std::vector expected{SpeedLimiter::kAsked, SpeedLimiter::kBraking, SpeedLimiter::kCurvature,
                             SpeedLimiter::kPower, SpeedLimiter::kSight};
  std::size_t next = 0;
  for (const SpeedLimiter limiter : met) {
    if (next < expected.size() && limiter == expected[next]) ++next;
  }
  EXPECT_EQ(next, expected.size()) << "the order of a straight, a bend and an end";
  EXPECT_EQ(met.front(), SpeedLimiter::kAsked);
  EXPECT_EQ(met.back(), SpeedLimiter::kSight);
}

}  // namespace
}  // namespace chicane::controller
