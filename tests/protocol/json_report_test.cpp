// SPDX-License-Identifier: MIT
#include "chicane/protocol/json_report.hpp"

#include <nlohmann/json.hpp>

#include "chicane/base/instruction_set.hpp"
#include "chicane/base/math.hpp"
#include "chicane/protocol/json.hpp"
#include "support/chicane_test.hpp"
#include "support/kept_text.hpp"

namespace chicane::protocol {
namespace {

using Tree = nlohmann::json;

telemetry::RunSummary example() {
  telemetry::RunSummary run;
  run.track = "lakeside";
  run.seed = 3;
  run.latency = 0.1;
  run.laps_wanted = run.laps_completed = 1;
  run.completed = true;
  telemetry::LapSummary lap{.lap_time = 28.5};
  lap.top_speed = 44.704;
  lap.min_edge_distance = 0.75;
  lap.sector_times = {9.0, 9.5, 10.0};
  lap.corner_times = {12.25, 16.25};
  run.corners = {{.begin = 10.0, .apex = 30.0, .end = 50.0, .turn = 0.5 * kPi},
                 {.begin = 90.0, .apex = 110.0, .end = 120.0, .turn = -kPi}};
  run.laps = {lap};
  run.total = lap;
  run.step_time.p50 = 25e-6;
  run.state_hash = 0xabcULL;
  return run;
}

/// The run as JSON and as a table equals its kept files.
void expect_reports(const std::string& name, const telemetry::RunSummary& run) {
  const std::string folder = "protocol/fixtures/reports/";
  std::string json = to_json(run);
  const std::string arithmetic(chicane::arithmetic(chosen_instruction_set()));
  json.replace(json.find(arithmetic), arithmetic.size(), "of this machine");
  test::expect_kept(folder + name + ".json", json);
  test::expect_kept(folder + name + ".txt", to_table(run));
}

TEST(JsonReport, FixturesOfReportsAreUpToDate) {
  telemetry::RunSummary run = example();
  run.why_no_limit = "the road is open";
  run.off_track_events = 2;
  run.laps[0].min_edge_distance = std::numeric_limits<double>::quiet_NaN();
  expect_reports("of_another_program", run);

  run = example();
  run.learned.delay = {0.0625, 0.005};
  run.learned.offset = {degrees_to_radians(2.0), degrees_to_radians(0.1)};
  run.guard = {.mode = safety::GuardMode::kObserve, .margin = 0.5, .blind_time = 2.0};
  run.laps[0].corner_times = {10.5, 18.0};
  telemetry::compare_with_limit(run, {.lap = 25.0, .sectors = {8.0, 9.5, 7.5}, .corners = {9.0, 16.0}});
  run.planned_corner_times = {10.0, 17.5};
  run.without = {{.cause = "latency", .lap_time = 27.5, .corners = {10.25, 17.25}},
                 {.cause = "edge margin", .off_track_events = 3}};
  expect_reports("beside_its_limit", run);

  run.completed = false;
  run.end_reason = "time limit of 600 s reached";
  EXPECT_THAT(to_table(run), HasSubstr("not completed: time limit of 600 s reached"));
  run.track = "caf\xe9.csv";
  EXPECT_TRUE(Tree::accept(to_json(run))) << "a name that is not UTF-8";
}

TEST(JsonReport, IsReadAsItWasWritten) {
  const auto read = test::good(read_run(to_json(example())));
  EXPECT_EQ(read->track, "lakeside");
  EXPECT_TRUE(read->completed);
  EXPECT_EQ(read->laps_completed, 1);
  EXPECT_NEAR(read->latency, 0.1, 1e-12);  // by way of milliseconds
  ASSERT_EQ(read->laps.size(), 1U);
  EXPECT_EQ(read->laps[0].lap_time, 28.5);
  EXPECT_EQ(read->laps[0].min_edge_distance, 0.75);
  EXPECT_EQ(read->laps[0].sector_times[1], 9.5);
  EXPECT_NEAR(read->step_time.p50, 25e-6, 1e-12);  // by way of microseconds
  EXPECT_TRUE(completed_on_road(*read));
}

TEST(JsonReport, OtherTextIsNoRunAndMissingNumbersAreNotMeasured) {
  for (const char* text : {"", "{", "[]", "{}", R"({"laps": 3, "total": {}, "completed": true})",
                           R"({"laps": [], "total": {}, "completed": 1})"})
    EXPECT_FALSE(read_run(text)) << text;
  const auto bare = read_run(R"({"laps": [1, {"sector_times_s": [null]}], "total": 7, "completed": false})");
  ASSERT_TRUE(bare);
  EXPECT_THAT(to_table(*bare), HasSubstr("\nround trip         not measured\n"));
  EXPECT_TRUE(Tree::parse(to_json(*bare))["step_time_us"]["p50"].is_null());
}

TEST(Json, KeepsTheOrderOfItsKeys) {
  const Json json{{"zeta", 1}, {"alpha", {1.5, "two", nullptr, true}}};
  EXPECT_EQ(json_text(json), R"({"zeta":1,"alpha":[1.5,"two",null,true]})");
  EXPECT_EQ(json_text(parse_json(json_text(json))), json_text(json));
}

TEST(Json, WritesAnyBytesAndAnyNumbersAndIndentsByTwoSpaces) {
  EXPECT_EQ(json_text({{"a", {{"b", 1}}}}, JsonLayout::kIndented), "{\n  \"a\": {\n    \"b\": 1\n  }\n}");
  EXPECT_EQ(json_text(Json("\xff|")), "\"\xEF\xBF\xBD|\"");
  EXPECT_EQ(json_text(Json("\xC3\xA9"), JsonLayout::kAscii), "\"\\u00e9\"");
  EXPECT_EQ(json_text(Json(std::numeric_limits<double>::infinity())), "null");
}

TEST(Json, SaysOfAnyTextWhetherItIsJson) {
  for (const char* text : {"", "{", "[1,]", "1 2", "nan", "{\"a\":1}}", "\"\xff\""})
    EXPECT_TRUE(parse_json(text).is_discarded()) << text;
  for (const char* text : {"null", "-1e3", "{}", " [1, {\"a\": []}] ", "\"\\u00e9\""})
    EXPECT_FALSE(parse_json(text).is_discarded()) << text;
  EXPECT_EQ(read_json("[1,]").error().byte, 4U);
  EXPECT_EQ(read_json("[1,2").error().byte, 5U);
  EXPECT_FALSE(read_json("[1e999]").error().byte);
  EXPECT_EQ(read_json("[1,2]").value()[1], 2);
  const std::string deep(100'000, '[');
  EXPECT_TRUE(parse_json(deep).is_discarded());
  EXPECT_FALSE(parse_json(deep + std::string(100'000, ']')).is_discarded());
}

TEST(ReportDocument, KeepsSectionsAndPartsInTheirOrder) {
  ReportDocument document("sweep", "small & <plain>");
  document.add_text("10 runs, `laps=1`.");
  document.begin_section("Tables");
  document.add_table({"preset", "clean"}, Json::array({{"pid", Json{{"text", "50 %"}, {"share", 0.5}}}}));
  document.add_grid("one", {"a \\ b", "1"}, Json::array({{"2", "0"}}));
  EXPECT_EQ(document.text(),
            R"({"kind":"sweep","title":"small & <plain>","sections":[)"
            R"({"title":"","parts":[{"part":"text","text":"10 runs, `laps=1`."}]},)"
            R"({"title":"Tables","parts":[{"part":"table","title":"","columns":["preset","clean"],)"
            R"("rows":[["pid",{"text":"50 %","share":0.5}]]},)"
            R"({"part":"grid","title":"one","columns":["a \\ b","1"],"rows":[["2","0"]]}]}]})");
}

TEST(ReportDocument, PlotsRoundEachAxisToWhatAScreenShows) {
  ReportDocument document("import", "road");
  document.begin_map("here", "x [m]");
  document.add_series("line", "other", "line", {1e6 + 0.123456, 0.0, 1e6 + 1.0, 1e-7, std::nan(""), 2e-7});
  document.add_series("mark", "soft", "", {0.6});
  EXPECT_EQ(
      json_text(parse_json(document.text())["sections"][0]["parts"][0]),
      R"({"part":"map","title":"here","x":"x [m]","series":[)"
      R"({"draw":"line","tone":"other","name":"line","values":[1000000.12346,0.0,1000001.0,1e-07,null,2e-07]},)"
      R"({"draw":"mark","tone":"soft","name":"","values":[0.6]}]})");
}

}  // namespace
}  // namespace chicane::protocol
