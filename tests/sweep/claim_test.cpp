// SPDX-License-Identifier: MIT
#include "chicane/sweep/claim.hpp"

#include "chicane/protocol/library.hpp"
#include "chicane/sweep/sweep.hpp"
#include "support/chicane_test.hpp"

namespace chicane::sweep {
namespace {

constexpr const char* kClaims = R"(
settings: {preset: weighted}
claims:
  - id: D1
    says: more is faster
    settings: {laps: 2}
    cases: {N10: {}, N20: {cubic_mpc: {horizon_steps: 20}}}
    true_when: [N20.top_speed_mps > N10.top_speed_mps * 1.1, "N20.lap_times_s[-1] < 30", N10.clean = 1]
    shows: [top_speed_mps]
  - {id: D2, says: it is there, found: works, see: somewhere}
)";

protocol::Json line(const telemetry::RunSummary& summary) {
  return protocol::parse_json(line_of(Plan{}, 0, {}, RunOutcome{.run = summary}));
}

protocol::Json run(double top, double lap, bool is_clean = true) {
  telemetry::RunSummary summary;
  summary.total.top_speed = top;
  summary.laps = {{.lap_time = 99.0}, {.lap_time = lap}};
  summary.completed = true;
  summary.off_track_events = is_clean ? 0 : 1;
  return line(summary);
}

TEST(Claim, HoldsWhenAllItsConditionsDo) {
  const auto claims = test::good(parse_claims(kClaims, "c.yaml"));
  ASSERT_EQ(claims->size(), 2U);
  const Claim& claim = claims->front();
  EXPECT_TRUE(claim.is_tried());
  EXPECT_EQ(claim.cases[1].settings, (Settings{{"cubic_mpc.horizon_steps", "20"}}));
  EXPECT_EQ(claim.settings, (Settings{{"preset", "weighted"}, {"laps", "2"}}));
  EXPECT_TRUE(holds(claim, {{"N10", run(20, 40)}, {"N20", run(23, 29)}}));
  EXPECT_FALSE(holds(claim, {{"N10", run(20, 40)}, {"N20", run(21, 29)}})) << "less than 10 % faster";
  EXPECT_FALSE(holds(claim, {{"N10", run(20, 40)}, {"N20", run(23, 31)}})) << "the last lap";
  EXPECT_FALSE(holds(claim, {{"N10", run(20, 40, false)}, {"N20", run(23, 29)}})) << "off the road";
  telemetry::RunSummary lost;
  lost.total.top_speed = 23;
  lost.completed = true;
  EXPECT_FALSE(holds(claim, {{"N10", run(20, 40)}, {"N20", line(lost)}})) << "not measured";
  EXPECT_FALSE((*claims)[1].is_tried());
}

TEST(Claim, AnOptimumIsComparedWithEveryCleanPointOfItsGrid) {
  const auto claims = test::good(parse_claims(R"(
claims:
  - id: A9
    says: 20 steps are best
    cases: {own: {}}
    grid: {cubic_mpc.horizon_steps: [7, 30], cubic_mpc.step_length_s: [0.1, 0.2]}
    true_when: ["own.lap_time_s < each.lap_time_s * 1.02"]
    shows: [lap_time_s]
)",
                                              "c.yaml"));
  const Claim& claim = claims->front();
  ASSERT_EQ(claim.cases.size(), 5U);
  EXPECT_EQ(claim.grid_size, 4U);
  EXPECT_EQ(claim.cases[2].name, "7/0.2");
  EXPECT_EQ(claim.cases[2].settings,
            (Settings{{"cubic_mpc.horizon_steps", "7"}, {"cubic_mpc.step_length_s", "0.2"}}));
  const auto holds_with = [&](double lap, bool is_clean) {
    return holds(claim, {{"own", run(20, 40)}, {"7/0.1", run(20, 41)}, {"7/0.2", run(20, lap, is_clean)}});
  };
  EXPECT_TRUE(holds_with(40.0, true));
  EXPECT_TRUE(holds_with(39.5, true)) << "within 2 %";
  EXPECT_FALSE(holds_with(38.0, true));
  EXPECT_TRUE(holds_with(38.0, false)) << "off the road is no better";
}

TEST(Claim, SaysWhatIsWrongWithAFile) {
  const auto fault = [](const std::string& text) { return test::refusal_of(parse_claims(text, "c.yaml")); };
  EXPECT_THAT(fault("claims: [{id: A, says: b}]"),
              HasSubstr("c.yaml:1: A: expected either cases and true_when, or found"));
  EXPECT_THAT(fault("claims: [{id: A, says: b, cases: {x: {}}, true_when: [y.clean = 1]}]"),
              HasSubstr("true_when: got y.clean = 1"));
  EXPECT_THAT(fault("claims: [{id: A, says: b, cases: {x: {}}, true_when: [x.cleen = 1]}]"),
              HasSubstr("true_when"));
  EXPECT_THAT(fault("claims: [{id: A, says: b, cases: {x: {lap: 2}}, true_when: [x.clean = 1]}]"),
              HasSubstr("lap: got an unknown key"));
  EXPECT_THAT(fault("claims: [{id: A, says: b, cases: {x: {}}, grid: {laps: 2}, true_when: [x.clean = 1]}]"),
              HasSubstr("laps: got 2, expected a list"));
  EXPECT_THAT(fault("claims: [{id: A, says: b, cases: {x: {}}, true_when: [each.clean = 1]}]"),
              HasSubstr("true_when"));
  EXPECT_THAT(fault("claims: [{id: A, says: b, found: works}, {id: A, says: b, found: works}]"),
              HasSubstr("id of its own"));
  EXPECT_THAT(fault("claims: [{id: A, says: b, found: works, shows: [x]}]"),
              HasSubstr("got x, expected a column"));
}

TEST(Claim, QuotesFewWordsThatItsWriteUpHas) {
  const auto read = [](const std::string& quotes) {
    return parse_claims("claims:\n  - {id: A, says: b, found: works, quotes: " + quotes + "}",
                        "claims/c.yaml", "# from a page: of ours\nkeeps the car in the lane\nat 60 mph\n");
  };
  ASSERT_TRUE(read("the car in the lane")) << read("the car in the lane").error().message;
  EXPECT_EQ(read("the car in the lane")->front().quotes, "the car in the lane");
  const auto fault = [&](const std::string& quotes) { return read(quotes).error().message; };
  EXPECT_EQ(fault("the cars"),
            "claims/c.yaml:2: quotes: got the cars, expected words of a line of claims/quotations/c.txt");
  EXPECT_THAT(fault("of ours"), HasSubstr("got of ours, expected words of a line"));
  EXPECT_EQ(fault("a b c d e f g h i j k"), "claims/c.yaml:2: quotes: got 11 words, expected 1 to 10");
}

TEST(Claim, AllStatementsAreThere) {
  std::set<std::string> ids;
  int tried = 0, quoted = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CHICANE_SOURCE_DIR "/studies/claims")) {
    const std::string file = entry.path().string();
    if (entry.is_directory()) continue;
    const auto claims = test::good(parse_claims(protocol::read_file(file).value(), file,
                                                protocol::read_file(quotations_file(file)).value_or("")));
    for (const Claim& claim : *claims) {
      if (!claim.quotes.empty()) ++quoted;
      EXPECT_TRUE(ids.insert(claim.id).second) << claim.id;
      const bool has_command = claim.see.find("`ctest --preset release -R ") != std::string::npos ||
                               claim.see.starts_with("`chicane") || claim.see.starts_with("`./run.sh");
      EXPECT_TRUE(claim.is_tried() || has_command) << claim.id << ": " << claim.see;
      EXPECT_TRUE(!claim.is_tried() || !claim.shows.empty()) << claim.id;
      if (claim.is_tried()) ++tried;
    }
  }
  EXPECT_EQ(ids.size(), 88U);
  EXPECT_GE(tried, 49);
  EXPECT_EQ(quoted, 37) << "the others are paraphrases: three write-ups were not found";
}

}  // namespace
}  // namespace chicane::sweep
