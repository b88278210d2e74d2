// SPDX-License-Identifier: MIT
#include "chicane/sweep/result_table.hpp"

#include <unistd.h>

#include <nlohmann/json.hpp>

#include "chicane/sweep/plan_codec.hpp"
#include "chicane/sweep/result_file.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::sweep {
namespace {

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
