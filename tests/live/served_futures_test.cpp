// SPDX-License-Identifier: MIT
#include "chicane/live/served_run.hpp"

#include <numbers>

#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane::live {
namespace {

using test::Settings;

scenario::Scenario scenario_of(Settings settings) {
  settings.insert(settings.begin(), {{"track", "oval"}, {"laps", "0"}});
  return test::scenario_of(settings);
}

/// A car that another program simulates: what is told of it is what was measured, and what it was sent.
class Theirs {
 public:
  explicit Theirs(const Settings& settings)
      : loop_{std::move(*run::ClosedLoop::create(scenario_of(settings)))} {
    log.begin(loop_->scenario());
  }
  void drive(double seconds) {
    for (const double end = loop_->time() + seconds; loop_->time() < end;) static_cast<void>(step());
  }
  /// Where it is after so many control steps more.
  [[nodiscard]] std::vector<Vec2> way(int steps) {
    std::vector<Vec2> all;
    while (static_cast<int>(all.size()) < steps)
      if (step()) all.emplace_back(loop_->frame().truth.x, loop_->frame().truth.y);
    return all;
  }
  RunLog log{false};

 private:
  /// A physics step; what is told of it.
  bool step() {
    if (!loop_->advance()) return false;
    telemetry::Frame frame = loop_->frame();
    frame.truth = {};
    frame.has_truth = false;
    log.note(frame);
    static_cast<void>(log.end());  // collects
    return true;
  }

  std::unique_ptr<run::ClosedLoop> loop_;
};

struct Asked {
  recording::BranchReport answer;
  std::vector<Vec2> was;
};
Result<Asked> ask(ServedFutures& futures, Settings settings, double at = 1e9) {
  std::vector<Vec2> was;
  const recording::BranchHooks hooks{.on_future = [&](const recording::FutureStep& step) {
    if (!step.is_branch) was.emplace_back(step.frame.truth.x, step.frame.truth.y);
  }};
  auto answer = futures.branch({.at = at, .settings = std::move(settings), .duration = 4.0}, hooks);
  if (!answer) return fail(answer.error());
  return Asked{*answer, was};
}

struct Case {
  const char* name;
  Settings settings;
  double apart;  // our car from theirs after ten seconds, where both are the same kind [m]
};
class Futures : public testing::TestWithParam<Case> {};

TEST_P(Futures, BeginWhereTheCarIsAndGoOnAsItDoes) {
  Theirs theirs(GetParam().settings);
  ServedFutures futures(theirs.log);
  futures.assume(scenario_of(GetParam().settings));
  for (const double more : {8.0, 5.0, 14.0}) {
    theirs.drive(more);
    const auto asked = test::good(ask(futures, {}));
    const auto& [answer, was] = *asked;
    ASSERT_TRUE(answer.stand_in);
    EXPECT_NEAR(answer.stand_in->compared, more == 8.0 ? 8.0 : 10.0, 0.2);
    EXPECT_LT(answer.stand_in->apart, GetParam().apart);
    EXPECT_EQ(answer.recorded.mean_speed, answer.branched.mean_speed) << "nothing was changed";
    const auto driven = theirs.way(75);
    ASSERT_GE(was.size(), driven.size());
    for (std::size_t i = 0; i < driven.size(); ++i)
      ASSERT_LT((was[i] - driven[i]).norm(), GetParam().apart) << i << " steps after the moment";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Runs, Futures,
    testing::Values(Case{"default", {}, 2.5}, Case{"road_car", {{"car", "road-car"}}, 3.0},
                    Case{"pid", {{"preset", "pid"}}, 1.5},
                    Case{"short_latency", {{"latency_ms", "30"}, {"controller", "pure-pursuit"}}, 1.5}),
    [](const auto& each) { return std::string(each.param.name); });

TEST(ServedFutures, TellWhatAChangeWouldDo) {
  Theirs theirs({});
  ServedFutures futures(theirs.log);
  futures.assume(scenario_of({}));
  theirs.drive(20.0);
  const auto slower = test::good(ask(futures, {{"tracking_mpc.speed_limit_mps", "12"}}));
  EXPECT_LT(slower->answer.branched.mean_speed, slower->answer.recorded.mean_speed - 2.0);
  const auto earlier = test::good(ask(futures, {}, 12.0));
  EXPECT_NEAR(earlier->answer.at, 12.0, 0.1);
  EXPECT_THAT(test::refusal_of(ask(futures, {{"nothing", "1"}})), HasSubstr("nothing"));
}

TEST(ServedFutures, SayHowFarOurCarIsFromTheirs) {
  Theirs theirs({{"plant_options.friction_scale", "0.6"}, {"latency_ms", "160"}});
  ServedFutures futures(theirs.log);
  futures.assume(scenario_of({}));
  theirs.drive(25.0);
  const auto asked = test::good(ask(futures, {}));
  EXPECT_EQ(asked->answer.stand_in->plant, "udacity");
  EXPECT_GT(asked->answer.stand_in->apart, 0.2) << "a car with less grip is another one";
}

TEST(ServedFutures, SayWhyThereAreNone) {
  Theirs theirs({});
  ServedFutures futures(theirs.log);
  const auto why = [&](double at = 1e9) {
    const auto asked = ask(futures, {}, at);
    EXPECT_FALSE(asked);
    return asked ? "" : asked.error().message;
  };
  EXPECT_THAT(why(), HasSubstr("road is not known"));
  futures.assume(scenario_of({}));
  EXPECT_THAT(why(), HasSubstr("no second"));
  theirs.drive(5.0);
  EXPECT_THAT(why(0.2), HasSubstr("no second"));
  futures.give_up("the simulator drives on another road than --track");
  EXPECT_THAT(why(), HasSubstr("another road"));
}

TEST(ServedFutures, KnowHowTheCarMovesFromWhereItWas) {
  // On circles, with a constant sideslip, both ways round.
  constexpr double kRadius = 40.0, kSpeed = 15.0, kPeriod = 0.04;
  for (const double direction : {1.0, -1.0}) {
    for (const double slip : {-0.1, 0.0, 0.15}) {
      for (double begin = -3.0; begin < 3.2; begin += 0.3) {
        std::vector<Seen> seen;
        for (int i = 0; i < 2; ++i) {
          const double angle = begin + direction * kSpeed / kRadius * kPeriod * i;
          const double heading = angle + direction * 0.5 * std::numbers::pi - slip;
          seen.push_back({.time = kPeriod * i,
                          .x = kRadius * std::cos(angle),
                          .y = kRadius * std::sin(angle),
                          .psi = std::remainder(heading, 2.0 * std::numbers::pi),
                          .speed = kSpeed,
                          .sent = {}});
        }
        const model::State state = moving(seen, 1);
        EXPECT_NEAR(state.r, direction * kSpeed / kRadius, 1e-9);
        EXPECT_NEAR(state.vx, kSpeed * std::cos(slip), 1e-9);
        EXPECT_NEAR(state.vy, kSpeed * std::sin(slip), 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace chicane::live
