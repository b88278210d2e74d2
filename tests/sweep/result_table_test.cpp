// SPDX-License-Identifier: MIT
#include "chicane/sweep/result_table.hpp"

#include <nlohmann/json.hpp>

#include "chicane/sweep/plan_codec.hpp"
#include "chicane/sweep/result_file.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::sweep {
namespace {

class ComparisonTest : public testing::Test, protected test::Folder {
 protected:
  /// A line about a run on a track.
  void add(int run, const char* track, const char* mode, const char* rest) {
    lines_ += "{\"run\":" + std::to_string(run) + ",\"settings\":{\"track\":\"" + track +
              "\",\"guard.mode\":\"" + mode + "\"}," + rest + "}\n";
  }
  Result<Comparison> compared(const char* key = "guard.mode") {
    const Plan plan = parse_plan("axes: [{track: [a, b, c, d]}, {guard.mode: ['on', 'off']}]", "p").value();
    return compare({write("r.jsonl", header_of(plan) + "\n" + lines_)}, key, "off");
  }

  std::string lines_;
};

constexpr const char* kClean = R"("completed":true,"off_track_events":0,"lap_times_s":[12,10,11])";

TEST_F(ComparisonTest, FlagsWhatIsWorse) {
  add(0, "a", "on", R"("completed":true,"off_track_events":2,"lap_times_s":[12,10,11])");
  add(1, "a", "off", kClean);
  add(2, "b", "on",
      R"("completed":true,"off_track_events":0,"lap_times_s":[12,10,11.5],"guard_reasons":{"frozen":3})");
  add(3, "b", "off", kClean);
  add(4, "c", "on", R"("completed":false,"off_track_events":0,"lap_times_s":[12])");
  add(5, "c", "off", kClean);
  const auto comparison = test::good(compared());
  EXPECT_EQ(comparison->pairs, 3U);
  EXPECT_EQ(comparison->worse, 3U);
  EXPECT_THAT(
      comparison->table.markdown(),
      HasSubstr("| `a` | on | 12.00 · 10.00 · 11.00 | 12.00 · 10.00 · 11.00 | 2 | 0 | | **off the road** |"));
  EXPECT_THAT(comparison->table.markdown(), HasSubstr("`frozen` 3 | **1.5 % slower** |"));
  EXPECT_THAT(comparison->table.markdown(), HasSubstr("**not completed** |"));
}

TEST_F(ComparisonTest, FlagsNothingWhereTheOtherOneIsNotCleanEither) {
  add(0, "a", "on", R"("completed":true,"off_track_events":1,"lap_times_s":[22,20,21])");
  add(1, "a", "off", R"("completed":true,"off_track_events":3,"lap_times_s":[12,10,11])");
  add(3, "b", "off", kClean);
  add(4, "c", "on", R"("completed":true,"off_track_events":0,"lap_times_s":[12,10,11.2])");
  add(5, "c", "off", kClean);
  const auto comparison = test::good(compared());
  EXPECT_EQ(comparison->pairs, 2U);
  EXPECT_EQ(comparison->worse, 0U);
  EXPECT_EQ(comparison->missing, 1U);
  EXPECT_THAT(comparison->table.markdown(), Not(HasSubstr("**")));
}

TEST_F(ComparisonTest, NamesTheAxesWhereTheKeyIsNone) {
  add(1, "a", "off", kClean);
  EXPECT_THAT(test::refusal_of(compared("guard.mod")), HasSubstr("track, guard.mode"));
}

TEST(ResultTable, ShowsPeopleTitlesAndGivesProgramsKeys) {
  ResultTable table({"car=car", "laps=laps{>}", "for [s]{>.1}", "edge_m=", "is_clean=clean", "=a=b{}"});
  table.add({"indy", 3, 2.25, std::nan(""), true, ""});
  table.add({"a,\"b\"", 12, nullptr, 0.5, false, "why"});
  EXPECT_EQ(table.text(),
            "car   laps for [s] clean a=b\nindy     3     2.2 true\na,\"b\"   12       – false why\n");
  EXPECT_EQ(table.markdown(),
            "| car | laps | for [s] | clean | a=b |\n|---|--:|--:|---|---|\n"
            "| indy | 3 | 2.2 | true | |\n| a,\"b\" | 12 | – | false | why |\n");
  EXPECT_EQ(table.csv(), "car,laps,edge_m,is_clean\r\nindy,3,,1\r\n\"a,\"\"b\"\"\",12,0.5,0\r\n");
  EXPECT_EQ(protocol::json_text(table.json()),
            R"([{"car":"indy","laps":3,"edge_m":null,"is_clean":true},)"
            R"({"car":"a,\"b\"","laps":12,"edge_m":0.5,"is_clean":false}])");
}

TEST(ResultTableTest, PutsColumnsThatDoNotFitAboveTheirRows) {
  ResultTable table({"car=car", "faults=faults"});
  const std::string wide(76, 'x');
  for (const std::string car : {"indy", "indy", "kart"}) table.add({car, wide});
  EXPECT_EQ(table.text(), "faults\nindy\n" + wide + "\n" + wide + "\nkart\n" + wide + "\n");
}

/// Results that are written by hand: a run is clean where speed times latency stays below 5000.
class SummaryPage : public testing::Test, protected test::Folder {
 protected:
  SummaryPage() {
    const Plan plan = parse_plan(R"(
name: by hand
settings: {laps: 1}
axes:
  - preset: [pid, stanley]
  - latency_ms: [50, 100, 150]
  - speed_mph: [20, 40, 60]
marks: [{preset: stanley, latency_ms: 100, speed_mph: 39}]
keep: [completed, off_track_events]
)",
                                 "plan.yaml")
                          .value();
    std::ofstream out(path("r.jsonl"));
    out << header_of(plan) << "\n";
    for (std::uint64_t run = 0; run < plan.size(); ++run) {
      const Settings at = plan.at(run);
      const bool is_clean = std::stod(at[1].second) * std::stod(at[2].second) < 5000.0;
      out << "{\"run\":" << run << ",\"settings\":{\"preset\":\"" << at[0].second
          << "\",\"latency_ms\":" << at[1].second << ",\"speed_mph\":" << at[2].second
          << "},\"completed\":true,\"off_track_events\":" << (is_clean ? 0 : 2) << "}\n";
    }
  }
};

TEST_F(SummaryPage, HasAMapOfNumbersForEachText) {
  const auto summary = test::good(summary_document({path("r.jsonl")}));
  const auto sections = nlohmann::json::parse(summary->text)["sections"];
  EXPECT_EQ(sections[1]["title"], "Along each axis");
  const auto by_latency = sections[1]["parts"][1];
  EXPECT_EQ(by_latency["columns"], (nlohmann::json{"latency_ms", "runs", "clean", "times off the road"}));
  EXPECT_EQ(by_latency["rows"][1][2], (nlohmann::json{{"text", "67 %"}, {"share", 4.0 / 6.0}}));
  EXPECT_EQ(by_latency["rows"][1][3], (nlohmann::json{{"text", "0.6667"}, {"hint", "0 to 2"}}));
  EXPECT_EQ(sections[2]["title"], "Clean runs over pairs of axes [%]; framed: what is marked");
  const auto pid = sections[2]["parts"][0], stanley = sections[2]["parts"][1];
  EXPECT_EQ(pid["title"], "pid");
  EXPECT_EQ(pid["columns"], (nlohmann::json{"latency_ms \\ speed_mph", "20", "40", "60"}));
  EXPECT_EQ(pid["rows"][1][2]["share"], 1.0);
  EXPECT_EQ(pid["rows"][1][2]["is_marked"], false);
  EXPECT_EQ(stanley["title"], "stanley");
  EXPECT_EQ(stanley["rows"][1][2]["is_marked"], true) << "the nearest value is marked";
  EXPECT_EQ(stanley["rows"][1][2]["hint"], "1 runs, marked");
  EXPECT_EQ(sections[3]["title"], "Distributions");
  EXPECT_EQ(sections[3]["parts"][0]["series"][0]["values"].size(), 4U * 24U);
  EXPECT_EQ(sections[4]["parts"][1]["rows"].size(), 18U) << "the runs";
}

TEST_F(SummaryPage, MapsInLettersStandBetweenTheirLines) {
  std::ofstream(path("page.md")) << "above\n<!-- sweep: by hand -->\nolder\n<!-- end of sweep -->\nbelow\n";
  const auto written = test::good(write_maps({path("r.jsonl")}, path("page.md")));
  const std::string page = content("page.md");
  EXPECT_TRUE(page.starts_with("above\n<!-- sweep: by hand -->\n18 runs, all with `laps=1`."));
  EXPECT_TRUE(page.ends_with("<!-- end of sweep -->\nbelow\n"));
  EXPECT_THAT(page, Not(HasSubstr("older")));
  EXPECT_THAT(page, HasSubstr("pid: latency_ms down, speed_mph across\n"
                              "      20    40    60\n"
                              " 50  100   100   100\n"
                              "100  100   100     ·\n"
                              "150  100     ·     ·\n"));
  EXPECT_THAT(page, HasSubstr("100  100  [100]    ·\n")) << "the nearest value is marked";
  ASSERT_TRUE(write_maps({path("r.jsonl")}, path("page.md")));
  EXPECT_EQ(content("page.md"), page) << "once more changes nothing";
}

TEST_F(SummaryPage, APageWithoutItsSecondLineIsLeftAsItIs) {
  std::ofstream(path("page.md")) << "<!-- sweep: by hand -->\nmine\n";
  EXPECT_THAT(test::refusal_of(write_maps({path("r.jsonl")}, path("page.md"))), HasSubstr("end of sweep"));
  EXPECT_THAT(content("page.md"), HasSubstr("mine"));
}

}  // namespace
}  // namespace chicane::sweep
