// SPDX-License-Identifier: MIT
// Planners that want to leave the road, in the controller's place, against the guard.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "chicane/base/random.hpp"
#include "closed_loop/drive.hpp"

namespace chicane::run {
namespace {

using Wish = std::function<model::Command(const model::Measurement&, Random&)>;

class Adversary final : public controller::Controller {
 public:
  explicit Adversary(Wish wish) : wish_{std::move(wish)} {}
  const controller::StepResult& step(const model::Measurement& now, Deadline) noexcept override {
    result_ = {};
    result_.command = wish_(now, random_);
    return result_;
  }
  void reset() noexcept override { random_ = Random(7); }
  [[nodiscard]] std::string_view name() const noexcept override { return "adversary"; }

 private:
  Wish wish_;
  Random random_{7};
  controller::StepResult result_;
};

struct Case {
  const char* name;
  Wish wish;
};

std::vector<Case> cases() {
  return {
      {"straight on",
       [](const auto&, Random&) {
         return model::Command{0.0, 1.0};
       }},
      {"full lock left",
       [](const auto&, Random&) {
         return model::Command{0.43, 1.0};
       }},
      {"full lock right",
       [](const auto&, Random&) {
         return model::Command{-0.43, 1.0};
       }},
      {"random",
       [](const auto&, Random& r) {
         return model::Command{0.4 * (2.0 * r.uniform() - 1.0), 1.0};
       }},
      {"bang-bang",
       [](const model::Measurement& now, Random&) {
         return model::Command{std::fmod(now.time, 1.0) < 0.5 ? 0.3 : -0.3, 1.0};
       }},
      {"not a number",
       [](const model::Measurement& now, Random&) {
         const double bad = std::fmod(now.time, 2.0) < 1.0 ? 0.02 : std::numeric_limits<double>::quiet_NaN();
         return model::Command{bad, 1.0};
       }},
      {"a slow drift to the edge",
       [](const model::Measurement& now, Random&) {
         return model::Command{0.01 * std::sin(0.3 * now.time), 1.0};
       }},
  };
}

TEST(Adversary, StaysOnTheRoad) {
  int place = 0;
  int turn =
      0;  // every other one drives here, the others on the next track; with the slow tests all everywhere
  for (const char* car : {"udacity", "road-car"}) {
    for (const char* track : {"lakeside", "oval"}) {
      ++place;
      turn = 0;
      for (const Case& each : cases()) {
        if (!kDrivesAll && (place + turn++) % 2 != 0) continue;
        const auto scenario = protocol::compose(
            {.scenario_file = {}, .settings = {{"track", track}, {"car", car}, {"laps", "0"}}});
        ASSERT_TRUE(scenario);
        const auto loop = ClosedLoop::create(
            *scenario, [&](const auto&) -> Result<std::unique_ptr<controller::Controller>> {
              return std::make_unique<Adversary>(each.wish);
            });
        ASSERT_TRUE(loop);
        double least = std::numeric_limits<double>::infinity();
        double fastest = 0.0;
        while ((*loop)->time() < 60.0) {
          (*loop)->advance();
          least = std::min(least, (*loop)->world().edge_distance);
          fastest = std::max(fastest, (*loop)->frame().truth.vx);
        }
        EXPECT_GE(least, 0.0) << car << " on " << track << ", " << each.name;
        EXPECT_GT(fastest, 0.5) << "it drives at all: " << each.name;
      }
    }
  }
}

/// Nothing of what it sees changes what is sent: the same bits as without it, faults and all.
TEST(Guard, ReportsInObserveWhatItWouldHaveDone) {
  const auto run_with = [](const char* mode) {
    auto scenario = protocol::compose(
        {.scenario_file = {},
         .settings = {{"track", "oval"}, {"laps", "0"}, {"time_limit_s", "24"}, {"guard.mode", mode}}});
    EXPECT_TRUE(scenario);
    scenario->faults = {sim::default_event(*sim::fault_named("nan_measurement"), 14.0),
                        sim::default_event(*sim::fault_named("position_jump"), 19.0)};
    auto loop = ClosedLoop::create(*scenario);
    EXPECT_TRUE(loop);
    return run_closed_loop(**loop);
  };
  const auto found = [](const telemetry::RunSummary& run, controller::GuardReason reason) {
    return run.guard_reasons[static_cast<std::size_t>(reason)];
  };
  const telemetry::RunSummary off = run_with("off");
  const telemetry::RunSummary observe = run_with("observe");
  const telemetry::RunSummary on = run_with("on");
  EXPECT_EQ(observe.state_hash, off.state_hash);
  EXPECT_NE(on.state_hash, off.state_hash);
  for (const auto reason : {controller::GuardReason::kNotMeasured, controller::GuardReason::kPositionJump}) {
    EXPECT_EQ(found(off, reason), 0U);
    EXPECT_GT(found(observe, reason), 10U);
    EXPECT_GT(found(on, reason), 10U);
  }
}

}  // namespace
}  // namespace chicane::run
