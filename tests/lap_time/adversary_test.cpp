// SPDX-License-Identifier: MIT

#include "chicane/base/random.hpp"
#include "chicane/lap_time/detail/plan_search.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/sim/plant_registry.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane::lap_time {
namespace {

/// Corners to both sides, some of them tight.
road::Track road() {
  const auto radius = [](double angle) {
    return 70.0 + 20.0 * std::cos(2.0 * angle) + 5.0 * std::sin(5.0 * angle);
  };
  return *road::Track::create("clover", test::with_widths(test::points_round(160, radius), 4.0, 4.0), true);
}

/// The slip of driven rear wheels has a flat optimum beyond the peak, where a search without a cap gets
/// stuck.
TEST(LimitOfADriftingCar, IsFoundFromSlipCappedAtThePeak) {
  sim::DoubleTrackParams car;
  car.mass = 1093.3;
  car.yaw_inertia = 1791.6;
  car.height = 0.575;
  car.track_width = 1.375;
  car.friction = 1.05;
  car.shape = 1.35;
  car.stiffness_front = 14.0;
  car.stiffness_rear = 15.5;
  car.drive_force = car.brake_force = 12573.0;
  car.drive_power = 92020.0;
  car.drive_share_front = 0.0;
  car.traction_slip_start = 0.1;
  car.traction_slip_end = 0.18;
  car.steer_limit = 1.07;
  car.steer_rate_limit = 0.4;
  car.steer_lag = 0.0;
  const auto limit = test::good(find_plant_limit(test::bean_road(1.0, 2.5, 4.0, 5.0), "double-track", {},
                                                 {.time_step = 0.1, .wants_witness = false}, car));
  EXPECT_FALSE(limit->line.is_best_so_far);
}

class Adversary : public testing::TestWithParam<const char*> {};

TEST_P(Adversary, BeatsNoBoundWithWhateverItAssumesAndRisks) {
  const road::Track track = road();
  const PlantLimitOptions options{.time_step = 0.1, .wants_witness = false};
  const Result<PlantLimit> limit = test::good(find_plant_limit(track, GetParam(), {}, options));

  const std::unique_ptr<LimitModel> model = std::move(*make_limit_model(GetParam(), {}));
  const std::unique_ptr<sim::Plant> plant = std::move(*sim::make_plant(GetParam()));
  PlanSearch search(track, *model, {.time_step = 0.1});
  const Result<NodePlan> optimum = test::good(search.find());
  NodePlan from = *optimum;
  const bool is_udacity = std::string(GetParam()) == "udacity";
  Random numbers{2026};
  int clean = 0;
  double best = 1e9;
  constexpr int kTrials = 16;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Reserve risk{.margin = numbers.uniform(-0.02, 0.2),
                       .grip_share = numbers.uniform(0.97, 1.02),  // above 1: it assumes more than there is
                       .slip_share = is_udacity ? numbers.uniform(0.9, 1.6) : numbers.uniform(0.75, 1.05),
                       .brake_share = numbers.uniform(0.95, 1.02),
                       .steer_weight = numbers.uniform(1e-5, 1e-3)};
    const Result<NodePlan> plan = search.near(from, risk);
    if (!plan) continue;
    from = *plan;
    for (const Tuning& tuning : model->tunings()) {
      const DrivenLaps laps = drive_plan(track, *model, *plan, *plant, tuning, 3);
      clean += laps.is_clean ? 1 : 0;
      if (laps.is_clean) best = std::min(best, laps.best);
    }
  }
  EXPECT_GE(clean, 3);  // it does drive
  EXPECT_GE(best, limit->bound.lap);
  EXPECT_LE(best, 1.03 * limit->bound.lap);  // and comes near
}

INSTANTIATE_TEST_SUITE_P(Plants, Adversary, testing::Values("udacity", "road-car"), [](const auto& param) {
  return std::string(param.param) == "udacity" ? "Udacity" : "RoadCar";
});

}  // namespace
}  // namespace chicane::lap_time
