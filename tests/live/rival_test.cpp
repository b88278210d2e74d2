// SPDX-License-Identifier: MIT
#include "chicane/live/what_if.hpp"

#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane::live {
namespace {

using Json = nlohmann::json;

class Race : public testing::Test {
 protected:
  void SetUp() override { log.begin(scenario); }
  /// A race that has begun.
  void race(const std::string& question) {
    const auto asked = test::good(rival.ask(question, scenario));
    while (!is_asked) std::this_thread::yield();
    is_asked = false;
    loop->restart();
  }
  /// The run as it is driven, with what is noted of it.
  void drive(double until) {
    while (loop->time() < until) {
      const bool is_new = loop->advance();
      if (const auto lap = loop->take_lap()) log.note(*lap);
      if (is_new) log.note(loop->frame());
    }
    wait();
  }
  void change(const std::string& name, const std::string& value) {
    while (!loop->is_control_due()) loop->advance();
    const telemetry::Change changed{
        .cycle = loop->cycle(), .time = loop->time(), .name = name, .value = value};
    loop->apply(changed);
    log.note(changed);
  }
  /// Until the rival is where the run is, or does not race.
  void wait() {
    for (;;) {
      const Json now = answer();
      if (now["state"] != "racing" && now["state"] != "building") return;
      const Json& times = now["trace"]["time_s"];
      if (!times.empty() && times.back().get<double>() >= loop->frame().time - 1e-3) return;
      std::this_thread::yield();
    }
  }
  Json answer() const { return Json::parse(rival.answer()); }

  scenario::Scenario scenario = test::scenario_of({{"track", "oval"}, {"laps", "0"}});
  std::unique_ptr<run::ClosedLoop> loop = test::loop_of(scenario);
  std::atomic<bool> is_asked{false};
  RunLog log{false};
  Rival rival{log, [this] { is_asked = true; }};
};

TEST_F(Race, WithTheSameSettingsEndsInTheSameLapsBitForBitFaultsIncluded) {
  // Its own value of a setting is the run's value.
  race(R"({"settings":{"tracking_mpc.weight_lateral":)" +
       protocol::get_text(scenario, *protocol::find("tracking_mpc.weight_lateral")) + "}}");
  drive(3.0);
  change("fault.side_wind", "true");
  change("latency_ms", "60");
  drive(40.0);
  const Json now = answer();
  EXPECT_EQ(now["state"], "racing");
  ASSERT_GE(now["run"].size(), 2U);
  EXPECT_EQ(now["run"], now["rival"]);
  const Json& trace = now["trace"];
  EXPECT_NEAR(trace["x_m"].back().get<double>(), loop->frame().truth.x, 1e-3);
  EXPECT_NEAR(trace["speed_mps"].back().get<double>(),
              std::hypot(loop->frame().truth.vx, loop->frame().truth.vy), 1e-3);
}

TEST_F(Race, WithOtherSettingsTellsBothCarsThirdByThird) {
  race(R"({"settings":{"tracking_mpc.speed_limit_mps":25}})");
  drive(45.0);
  const Json now = answer();
  EXPECT_EQ(now["settings"], (Json{{"tracking_mpc.speed_limit_mps", "25"}}));
  ASSERT_FALSE(now["rival"].empty());
  const Json& mine = now["run"][0];
  const Json& other = now["rival"][0];
  EXPECT_GT(other["lap_time_s"].get<double>(), mine["lap_time_s"].get<double>() + 1.0);
  for (std::size_t third = 0; third < 3; ++third)
    EXPECT_GT(other["sector_times_s"][third], mine["sector_times_s"][third]) << third;
  EXPECT_LT(other["top_speed_mps"].get<double>(), 26.0);
  EXPECT_GT(mine["top_speed_mps"].get<double>(), 30.0);
  EXPECT_LT(other["mean_speed_mps"], mine["mean_speed_mps"]);
}

TEST_F(Race, EndsWhenTheRunBeginsWithOtherChoicesAndWhenNobodyWantsIt) {
  race(R"({"settings":{"tracking_mpc.speed_limit_mps":25}})");
  drive(1.0);
  log.begin(scenario);
  while (answer()["state"] == "racing") std::this_thread::yield();
  EXPECT_EQ(answer()["state"], "ended");
  EXPECT_EQ(answer()["why"], "the run began with other choices");
  ASSERT_TRUE(rival.ask("{}", scenario));
  while (answer()["state"] != "none") std::this_thread::yield();
  EXPECT_TRUE(answer()["rival"].empty());
}

TEST_F(Race, RefusesWhatIsNoSettingOfAController) {
  for (const std::string question :
       {R"(7)", R"({"settings":{"nothing":1}})", R"({"settings":{"track":"oval"}})",
        R"({"settings":{"latency_ms":60}})", R"({"settings":{"fault.side_wind":true}})",
        R"({"settings":{"tracking_mpc.weight_lateral":-1}})"}) {
    EXPECT_FALSE(rival.ask(question, scenario)) << question;
  }
  EXPECT_EQ(answer()["state"], "none");
}

}  // namespace
}  // namespace chicane::live
