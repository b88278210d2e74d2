// SPDX-License-Identifier: MIT
#include "chicane/live/what_if.hpp"

#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "chicane/live/run_log.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane::live {
namespace {

using testing::Pair;
using Json = nlohmann::json;

/// The answer once it is there.
Json answer_of(WhatIf& what_if) {
  for (;;) {
    Json answer = Json::parse(what_if.answer());
    if (answer["state"] != "computing") return answer;
    std::this_thread::yield();
  }
}

TEST(WhatIf, ReadsWhatIsAsked) {
  const auto question = test::good(read_question(
      R"({"at_s":12.5,"for_s":20,"laps":1,"log":2,"settings":{"latency_ms":60,"fault.half_grip":"+5*0.3"}})"));
  EXPECT_EQ(question->log, 2U);
  EXPECT_EQ(question->options.at, 12.5);
  EXPECT_EQ(question->options.duration, 20.0);
  EXPECT_EQ(question->options.more_laps, 1);
  EXPECT_TRUE(question->options.drives_both);
  EXPECT_THAT(question->options.settings,
              testing::UnorderedElementsAre(Pair("latency_ms", "60"), Pair("fault.half_grip", "+5*0.3")));
  const auto now = test::good(read_question("{}"));
  EXPECT_GT(now->options.at, 1e6) << "from now on";
  EXPECT_EQ(now->options.duration, WhatIfQuestion::kLongest);
}

TEST(WhatIf, RefusesWhatIsNoQuestionInWords) {
  for (const auto& [text, expected] : std::vector<std::pair<std::string, std::string>>{
           {"", "a JSON object"},
           {"[]", "a JSON object"},
           {R"({"at_s":"now"})", "at_s: expected a number"},
           {R"({"for_s":1e9})", "for_s: expected a number in [0.1, 600]"},
           {R"({"laps":-1})", "laps"},
           {R"({"log":-1})", "log"},
           {R"({"settings":[1]})", "settings"},
           {R"({"settings":{"a":[]}})", "a: expected a number, a text, true or false"},
           {R"({"settings":{")" + std::string(100, 'k') + R"(":1}})", "expected a setting"}}) {
    EXPECT_THAT(test::refusal_of(read_question(text)), HasSubstr(expected));
  }
  std::string many = R"({"settings":{)";
  for (int i = 0; i < 100; ++i) many += (i > 0 ? ",\"" : "\"") + std::to_string(i) + "\":1";
  EXPECT_FALSE(read_question(many + "}}"));
}

TEST(WhatIf, AnswersTheNewestQuestionWithBothFutures) {
  const auto loop = test::loop_of(test::scenario_of({{"track", "oval"}, {"laps", "0"}}));
  RunLog log(false);
  log.begin(loop->scenario());
  test::drive_cycles(*loop, 300, [&](const telemetry::Frame& frame) { log.note(frame); });
  std::atomic<int> computed{0};
  WhatIf what_if([&](const WhatIfQuestion& question, const recording::BranchHooks& hooks) {
    ++computed;
    return log.branch(question.options, hooks);
  });
  EXPECT_EQ(Json::parse(what_if.answer())["state"], "none");
  ASSERT_TRUE(what_if.ask(R"({"at_s":0})"));
  const auto asked =
      test::good(what_if.ask(R"({"at_s":8,"for_s":10,"settings":{"tracking_mpc.speed_limit_mps":9}})"));
  EXPECT_EQ(*asked, "2");
  const Json answer = answer_of(what_if);
  EXPECT_EQ(answer["id"], 2);
  EXPECT_EQ(answer["state"], "done") << answer;
  EXPECT_EQ(answer["at_s"], 8.0);
  EXPECT_EQ(answer["known_until_s"], 11.96);
  EXPECT_EQ(answer["is_exact"], true);
  EXPECT_EQ(answer["asked"]["settings"]["tracking_mpc.speed_limit_mps"], "9");
  const Json &was = answer["was"], &branch = answer["branch"];
  EXPECT_LT(branch["mean_speed_mps"], was["mean_speed_mps"]);
  for (const Json& future : {was, branch}) {
    const Json& trace = future["trace"];
    EXPECT_GT(trace["time_s"].size(), 240U);
    for (const char* column : {"distance_m", "x_m", "y_m", "yaw_rad", "steer_rad", "speed_mps", "throttle",
                               "lateral_error_m", "edge_distance_m"}) {
      EXPECT_EQ(trace[column].size(), trace["time_s"].size()) << column;
    }
    EXPECT_EQ(trace["time_s"].front(), 8.0);
  }
  EXPECT_EQ(was["trace"]["x_m"].front(), branch["trace"]["x_m"].front()) << "they begin at the same place";
  EXPECT_LT(branch["trace"]["distance_m"].back(), was["trace"]["distance_m"].back());
}

TEST(WhatIf, SaysWhyThereIsNoAnswerAndGivesUpWhatNobodyAsksAnyMore) {
  const auto failure = fail(ErrorCode::kInvalidArgument, "the run has not begun");
  WhatIf failing([&](const WhatIfQuestion&,
                     const recording::BranchHooks&) -> Result<recording::BranchReport> { return failure; });
  ASSERT_TRUE(failing.ask("{}"));
  EXPECT_EQ(answer_of(failing)["state"], "failed");
  EXPECT_EQ(answer_of(failing)["why"], "the run has not begun");
  std::atomic<int> given_up{0};
  {
    WhatIf what_if(
        [&](const WhatIfQuestion&, const recording::BranchHooks& hooks) -> Result<recording::BranchReport> {
          while (hooks.go_on(1.0)) std::this_thread::yield();
          ++given_up;
          return failure;
        });
    ASSERT_TRUE(what_if.ask("{}"));
    EXPECT_EQ(Json::parse(what_if.answer())["state"], "computing");
  }
  EXPECT_LE(given_up, 1) << "the destructor came back";
}

}  // namespace
}  // namespace chicane::live
