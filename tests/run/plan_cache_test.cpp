// SPDX-License-Identifier: MIT
#include "chicane/run/plan_cache.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/protocol/library.hpp"

namespace chicane::run {
namespace {

road::Track ring(double radius = 60.0, double half_width = 4.0) {
  std::vector<road::TrackPoint> points;
  for (int i = 0; i < 60; ++i) {
    const double angle = kTwoPi * i / 60.0;
    points.push_back({{radius * std::cos(angle), 0.7 * radius * std::sin(angle)}, half_width, half_width});
  }
  return *road::Track::create("ring", points, true);
}

/// A cache of this process for one test.
class PlanCacheTest : public testing::Test {
 protected:
  PlanCacheTest()
      : folder_{std::filesystem::temp_directory_path() /
                ("chicane-plans-" + std::to_string(::getpid()) + "-" +
                 testing::UnitTest::GetInstance()->current_test_info()->name())} {
    std::filesystem::remove_all(folder_);
    cache_ = std::make_shared<DiskCache>(folder_.string(),
                                         [this](std::string_view line) { said_.emplace_back(line); });
    use_plan_cache(cache_);
  }
  ~PlanCacheTest() override {
    use_plan_cache(nullptr);
    std::filesystem::remove_all(folder_);
  }

  /// Iterations that it took.
  int plan(road::RacingLine& line, lap_time::RacingPlanOptions options = {.time_step = 0.12}) {
    int iterations = 0;
    options.go_on = [&](int, double) { return ++iterations > 0; };
    line = cached_plan(ring(), model::udacity_params(), options).value();
    return iterations;
  }

  std::filesystem::path folder_;
  std::shared_ptr<const DiskCache> cache_;
  std::vector<std::string> said_;
};

TEST_F(PlanCacheTest, ACachedPlanHasTheBitsOfAFreshOne) {
  road::RacingLine fresh, cached, again;
  EXPECT_GT(plan(fresh), 0);
  EXPECT_EQ(plan(cached), 0);
  EXPECT_EQ(to_bytes(cached), to_bytes(fresh));
  use_plan_cache(nullptr);
  EXPECT_GT(plan(again), 0);
  EXPECT_EQ(to_bytes(again), to_bytes(cached));
}

TEST_F(PlanCacheTest, ADamagedPlanIsPlannedAnewWithOneLine) {
  road::RacingLine fresh, anew;
  plan(fresh);
  const std::string name = name_of_plan(ring(), model::udacity_params(), {.time_step = 0.12});
  cache_->keep(name, "whole, and no plan");
  EXPECT_GT(plan(anew), 0);
  ASSERT_EQ(said_.size(), 1U);
  EXPECT_EQ(to_bytes(anew), to_bytes(fresh));
  EXPECT_EQ(plan(anew), 0) << "and kept";
}

TEST_F(PlanCacheTest, TheNameTellsAllThatAPlanDependsOn) {
  const road::Track road = ring();
  const model::VehicleParams car = model::udacity_params();
  const std::string name = name_of_plan(road, car, {});
  ASSERT_EQ(name.size(), 32U) << "this program has no build id";
  EXPECT_EQ(name, name_of_plan(ring(), car, {}));
  EXPECT_NE(name, name_of_plan(ring(60.001), car, {}));
  EXPECT_NE(name, name_of_plan(ring(60.0, 4.001), car, {}));
  for (const Option& option : model::vehicle_options()) {
    if (option.kind != OptionKind::kNumber) continue;
    model::VehicleParams other = car;
    option.write(&other, std::get<double>(option.read(&other)) == 0.5 ? 0.25 : 0.5);
    EXPECT_NE(name, name_of_plan(road, other, {})) << option.name;
  }
  for (const lap_time::RacingPlanOptions& other : {lap_time::RacingPlanOptions{.margin = 0.1},
                                                   {.grip_share = 0.9},
                                                   {.slip_share = 0.9},
                                                   {.brake_share = 0.9},
                                                   {.speed_limit = 50.0},
                                                   {.time_step = 0.1},
                                                   {.budget = 10.0}})
    EXPECT_NE(name, name_of_plan(road, car, other));
  EXPECT_NE(name, name_of_limit(road, "udacity", {}, {}, {}));
  EXPECT_NE(name_of_limit(road, "udacity", {}, {}, {}), name_of_limit(road, "road-car", {}, {}, {}));
  EXPECT_NE(name_of_limit(road, "udacity", {}, {}, {}),
            name_of_limit(road, "udacity", {.friction_scale = 0.9}, {}, {}));
}

TEST_F(PlanCacheTest, KeepsLimitsWithTheirWitness) {
  int iterations = 0;
  lap_time::PlantLimitOptions options{.time_step = 0.15};
  options.go_on = [&](std::string_view, int, double) { return ++iterations > 0; };
  const auto limit = [&] { return cached_limit(ring(), "udacity", {}, options, {}).value(); };
  const lap_time::PlantLimit fresh = limit();
  ASSERT_TRUE(fresh.witness);
  const int needed = iterations;
  EXPECT_EQ(to_bytes(limit()), to_bytes(fresh));
  EXPECT_EQ(iterations, needed);
}

TEST_F(PlanCacheTest, AWholeLimitAnswersWhateverNeedsNoMoreWork) {
  int iterations = 0;
  lap_time::PlantLimitOptions options{.time_step = 0.15};
  options.go_on = [&](std::string_view, int, double) { return ++iterations > 0; };
  const auto limit = [&] { return cached_limit(ring(), "udacity", {}, options, {}).value(); };
  const lap_time::PlantLimit whole = limit();
  ASSERT_TRUE(whole.is_whole());
  ASSERT_GT(whole.effort.work, whole.of_optimum.work);
  iterations = 0;

  options.budget = whole.effort.work;
  EXPECT_EQ(to_bytes(limit()), to_bytes(whole));
  options.wants_witness = false;
  options.budget = whole.of_optimum.work;
  const lap_time::PlantLimit bound = limit();
  EXPECT_EQ(iterations, 0) << "from the cache";
  EXPECT_EQ(to_bytes(bound), to_bytes(*lap_time::find_plant_limit(ring(), "udacity", {}, options)));

  options.budget = 0.5 * whole.of_optimum.work;  // less than it took: another answer
  iterations = 0;
  EXPECT_FALSE(limit().is_whole());
  EXPECT_GT(iterations, 0);
}

TEST_F(PlanCacheTest, OfAScenarioOneIsKnownOnceItWasFound) {
  const auto scenario = protocol::compose({.scenario_file = {}, .settings = {{"car", "udacity"}}}).value();
  EXPECT_FALSE(known_limit(scenario, ring()));
  const lap_time::PlantLimit found = limit_of(scenario, ring(), {.wants_witness = false}).value();
  const auto known = known_limit(scenario, ring());
  ASSERT_TRUE(known);
  EXPECT_EQ(to_bytes(*known), to_bytes(found));

  const auto small = protocol::compose({.scenario_file = {}, .settings = {{"car", "f1tenth"}}}).value();
  EXPECT_FALSE(known_limit(small, ring()));
  const auto refused = limit_of(small, ring(), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "limit: got the model car f1tenth, expected one in full size");
}

TEST_F(PlanCacheTest, ThatACarGetsRoundIsKeptAndThatItDoesNotIsComputedAnew) {
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(cached_room(ring(), model::udacity_params(), infinite, 1.0));
  EXPECT_TRUE(cached_room(ring(), model::udacity_params(), infinite, 1.0)) << "from the cache";
  model::VehicleParams stiff = model::udacity_params();
  stiff.steer_limit = 0.03;
  for (int i = 0; i < 2; ++i) {
    const Result<void> fits = cached_room(ring(), stiff, infinite, 1.0);
    ASSERT_FALSE(fits);
    EXPECT_NE(fits.error().message.find("circle at full lock"), std::string::npos) << fits.error().message;
  }
  int files = 0;
  for ([[maybe_unused]] const auto& each : std::filesystem::directory_iterator(folder_)) ++files;
  EXPECT_EQ(files, 1);
}

TEST_F(PlanCacheTest, AStoppedSearchIsNotKept) {
  const auto stopped =
      cached_plan(ring(), model::udacity_params(), {.go_on = [](int, double) { return false; }});
  EXPECT_FALSE(stopped);
  EXPECT_FALSE(cache_->find(name_of_plan(ring(), model::udacity_params(), {})));
}

TEST(PlanBytes, EachCutOfAPlanIsRefused) {
  road::RacingLine line{.car = "udacity", .track = "ring", .length = 10.0, .points = {{}, {.s = 10.0}}};
  const std::string bytes = to_bytes(line);
  ASSERT_TRUE(line_from_bytes(bytes));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(line_from_bytes(std::string_view(bytes).substr(0, size))) << size;
  EXPECT_FALSE(line_from_bytes(bytes + "x"));
}

TEST(Planning, EndsWithTheProcessesFlag) {
  static std::atomic<bool> flag{false};
  stop_planning_by(flag);
  EXPECT_FALSE(must_stop_planning());
  flag = true;
  EXPECT_TRUE(must_stop_planning());
  flag = false;
}

}  // namespace
}  // namespace chicane::run
