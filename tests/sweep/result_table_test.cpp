// SPDX-License-Identifier: MIT
#include "chicane/sweep/result_table.hpp"

#include <unistd.h>

#include "chicane/sweep/plan_codec.hpp"
#include "chicane/sweep/result_file.hpp"
#include "support/chicane_test.hpp"

namespace chicane::sweep {
namespace {

class ComparisonTest : public testing::Test {
 protected:
  ~ComparisonTest() override { fs::remove(file_); }
  /// A line about a run on a track.
  void add(int run, const char* track, const char* mode, const char* rest) {
    lines_ += "{\"run\":" + std::to_string(run) + ",\"settings\":{\"track\":\"" + track +
              "\",\"guard.mode\":\"" + mode + "\"}," + rest + "}\n";
  }
  Result<Comparison> compared(const char* key = "guard.mode") {
    const Plan plan = parse_plan("axes: [{track: [a, b, c, d]}, {guard.mode: ['on', 'off']}]", "p").value();
    std::ofstream(file_) << header_of(plan) << '\n' << lines_;
    return compare({file_}, key, "off");
  }

  std::string file_ = fs::temp_directory_path() / ("chicane_comparison_test." + std::to_string(getpid()));
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

}  // namespace
}  // namespace chicane::sweep
