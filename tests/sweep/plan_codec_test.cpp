// SPDX-License-Identifier: MIT
#include "chicane/sweep/plan_codec.hpp"
#include "chicane/sweep/plan.hpp"
#include "support/chicane_test.hpp"

namespace chicane::sweep {
namespace {

using testing::Pair;

Plan plan_of(const std::string& text) { return *test::good(parse_plan(text, "p.yaml")); }

std::string fault_of(const std::string& text) { return test::refusal_of(parse_plan(text, "p.yaml")); }

TEST(Plan, TakesTheTracksOfAFolder) {
  const std::string folder = CHICANE_SOURCE_DIR "/data/tracks";
  const auto plan = test::good(parse_plan("axes: [{track: [oval, " + folder + "/*.csv]}]", "p"));
  EXPECT_GE(plan->size(), 7U);
  EXPECT_EQ(plan->at(1)[0].second, folder + "/crossover.csv");
  EXPECT_THAT(test::refusal_of(parse_plan("axes: [{track: [nowhere/*.csv]}]", "p")),
              HasSubstr("nowhere/*.csv"));
}

TEST(PlanCodec, TheLastAxisTurnsFastest) {
  const Plan plan = plan_of(R"(
name: two axes
settings: {preset: weighted, cubic_mpc: {horizon_steps: 12}}
axes:
  - speed_mph: [30, 40]
  - latency_ms: {from: 50, to: 150, count: 3}
)");
  EXPECT_EQ(plan.name, "two axes");
  EXPECT_THAT(plan.fixed, ElementsAre(Pair("preset", "weighted"), Pair("cubic_mpc.horizon_steps", "12")));
  ASSERT_EQ(plan.size(), 6U);
  EXPECT_THAT(plan.at(0), ElementsAre(Pair("speed_mph", "30"), Pair("latency_ms", "50")));
  EXPECT_THAT(plan.at(1), ElementsAre(Pair("speed_mph", "30"), Pair("latency_ms", "100")));
  EXPECT_THAT(plan.at(5), ElementsAre(Pair("speed_mph", "40"), Pair("latency_ms", "150")));
}

TEST(PlanCodec, KeysOfOneAxisChangeTogether) {
  const Plan plan = plan_of(R"(
axes:
  - cubic_mpc.horizon_steps: [125, 62, 25]
    cubic_mpc.step_length_s: [0.005, 0.01, 0.025]
)");
  ASSERT_EQ(plan.size(), 3U);
  EXPECT_THAT(plan.at(1),
              ElementsAre(Pair("cubic_mpc.horizon_steps", "62"), Pair("cubic_mpc.step_length_s", "0.01")));
  EXPECT_EQ(plan.name, "p");
}

TEST(PlanCodec, RangesHaveShortNumbersAndBothEnds) {
  const Plan plan = plan_of(R"(
axes:
  - plant_options.friction_scale: {from: 0.1, to: 0.3, step: 0.1}
  - seed: {from: 1, to: 3}
  - cubic_mpc.weight_throttle: {from: 1, to: 100, count: 3, scale: log}
)");
  ASSERT_EQ(plan.size(), 27U);
  EXPECT_EQ(plan.at(9)[0].second, "0.2");
  EXPECT_EQ(plan.at(26)[0].second, "0.3");
  EXPECT_EQ(plan.at(26)[1].second, "3");
  EXPECT_EQ(plan.at(1)[2].second, "10");
}

TEST(PlanCodec, SamplesFillRangesAndLists) {
  for (const std::string method : {"sobol", "latin-hypercube"}) {
    const Plan plan = plan_of("axes:\n  - sample: {method: " + method + R"(, count: 16, seed: 2}
    latency_ms: {from: 50, to: 150}
    preset: [weighted, sixty-mph]
    cubic_mpc.horizon_steps: {from: 5, to: 20}
)");
    ASSERT_EQ(plan.size(), 16U);
    std::multiset<std::string> presets;
    for (std::uint64_t i = 0; i < 16; ++i) {
      const Settings run = plan.at(i);
      const double latency = std::stod(run[0].second);
      EXPECT_GE(latency, 50.0);
      EXPECT_LE(latency, 150.0);
      presets.insert(run[1].second);
      EXPECT_EQ(run[2].second.find('.'), std::string::npos) << "an integer";
    }
    EXPECT_EQ(presets.count("weighted"), 8U) << method;
  }
}

TEST(PlanCodec, FaultsAreAxes) {
  const Plan plan = plan_of(R"(
axes:
  - fault.name: [link_lost, half_grip]
  - fault.at_s: {from: 10, to: 12, step: 0.5}
  - fault: [half_grip@3+1, "half_grip@4+1*0.5"]
)");
  EXPECT_EQ(plan.size(), 20U);
}

TEST(PlanCodec, EqualPlansHaveEqualHashesHoweverWritten) {
  const Plan plan = plan_of("settings: {preset: weighted}\naxes: [{seed: [1, 2]}]\n");
  EXPECT_EQ(plan.hash(),
            plan_of("# why\nname: other\naxes:\n  - seed: [1,\n 2]\nsettings:\n  preset: weighted\n").hash());
  EXPECT_NE(plan.hash(), plan_of("settings: {preset: weighted}\naxes: [{seed: [2, 1]}]\n").hash());
  EXPECT_NE(plan.hash(), plan_of("settings: {preset: default}\naxes: [{seed: [1, 2]}]\n").hash());
  EXPECT_NE(plan.hash(),
            plan_of("settings: {preset: weighted}\naxes: [{seed: [1, 2]}]\nkeep: [cycles]\n").hash());
}

TEST(PlanCodec, SaysAllThatIsWrongWithItsLines) {
  const std::string faults = fault_of(R"(
settings: {laps: -1, cubic_mpc.horizon_step: 20}
axes:
  - latency_ms: [50, 900]
  - seed: [1]
    laps: [1, 2]
  - speed_mph: fast
  - latency_ms: [1]
keep: [lap_time]
more: 1
)");
  for (const char* words :
       {"p.yaml:2: laps: got -1, expected an integer", "p.yaml:2: cubic_mpc.horizon_step: got an unknown key",
        "did you mean cubic_mpc.horizon_steps?", "p.yaml:4: latency_ms: got 900",
        "p.yaml:6: laps: got 2 values, expected 1", "p.yaml:7: speed_mph: got fast",
        "p.yaml:8: latency_ms: got it in two axes", "p.yaml:9: keep: got lap_time, expected one of completed",
        "p.yaml:10: more: got an unknown key"})
    EXPECT_THAT(faults, HasSubstr(words));
}

TEST(PlanCodec, ShippedPlansAreRight) {
  int plans = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CHICANE_SOURCE_DIR "/studies/plans")) {
    const Result<Plan> plan = test::good(read_plan(entry.path().string()));
    EXPECT_GT(plan->size(), 1U);
    ++plans;
  }
  EXPECT_GE(plans, 3);
}

TEST(PlanCodec, BoundsWhatAFileCanAskFor) {
  std::string text = "axes:\n";
  for (const char* key : {"seed", "laps", "latency_ms", "time_limit_s"})
    text += std::string("  - ") + key + ": {from: 1, to: 200, step: 0.5}\n";
  EXPECT_THAT(fault_of(text), HasSubstr("runs, expected at most 1e+09"));
  EXPECT_THAT(fault_of("axes: [{time_limit_s: {from: 0, to: 1e7, step: 1e-9}}]"),
              HasSubstr("expected fewer steps"));
  EXPECT_THAT(fault_of("axes: [{seed: {from: 1, to: nan}}]"), HasSubstr("seed"));
  EXPECT_THAT(fault_of("axes: [{latency_ms: {from: 1, to: 9}}]"), HasSubstr("either count or step"));
  EXPECT_THAT(fault_of("- 1"), HasSubstr("got a list, expected a plan"));
  EXPECT_THAT(fault_of("axes: [{sample: {method: random, count: 0}}]"),
              HasSubstr("expected sobol or latin-hypercube"));
}

TEST(PlanCodec, NamesStandForSettings) {
  const Plan plan = plan_of(R"(
settings: {laps: 1, latency_ms: 100}
axes:
  - preset: [pid, stanley]
  - world: {cases: {plain: {}, late: {latency_ms: 150, sensor: {speed_noise_mps: 0.1}}}}
)");
  ASSERT_EQ(plan.size(), 4U);
  EXPECT_THAT(plan.at(3), ElementsAre(Pair("preset", "stanley"), Pair("world", "late")));
  EXPECT_THAT(plan.settings_of(3),
              ElementsAre(Pair("laps", "1"), Pair("latency_ms", "100"), Pair("preset", "stanley"),
                          Pair("latency_ms", "150"), Pair("sensor.speed_noise_mps", "0.1")));
  EXPECT_EQ(plan.settings_of(2).size(), 3U);
  Plan other = plan;
  other.axes[1].dimensions[0].cases[1][0].second = "160";
  EXPECT_NE(other.hash(), plan.hash());
  EXPECT_THAT(fault_of("axes: [{latency_ms: {cases: {a: {}}}}]"), HasSubstr("a name of your own"));
  EXPECT_THAT(fault_of("axes: [{world: {cases: {a: {nonsense: 1}}}}]"), HasSubstr("nonsense"));
  EXPECT_THAT(fault_of("axes: [{world: {cases: {a: {}, a: {}}}}]"), HasSubstr("a second time"));
}

TEST(PlanCodec, ASearchHasALadderDownToItsSmallestValue) {
  const Plan plan = plan_of("search: {speed_mps: {from: 10, to: 40, factor: 2}}");
  ASSERT_TRUE(plan.search);
  EXPECT_THAT(plan.search->ladder(), ElementsAre(40.0, 20.0, 10.0));
  EXPECT_NE(plan.hash(), Plan{}.hash());
  EXPECT_THAT((Search{.key = "x", .from = 15.0, .to = 40.0, .factor = 2.0}.ladder()),
              ElementsAre(40.0, 20.0, 15.0));
  EXPECT_THAT(fault_of("search: 7"), HasSubstr("search: got 7"));
  EXPECT_THAT(fault_of("search: {speed_mps: {from: 10, to: 40, factor: 1}}"), HasSubstr("factor from 1.01"));
  EXPECT_THAT(fault_of("search: {speed_mps: {from: ten, to: 40}}"), HasSubstr("got ten"));
}

TEST(PlanCodec, MarksArePlacesOnAxesAndOfNoEffectOnRuns) {
  const std::string axes = "axes: [{speed_mph: [30, 40]}, {latency_ms: [0, 100]}]\n";
  const Plan plan = plan_of(axes + "marks: [{speed_mph: 40, latency_ms: 100}]");
  ASSERT_EQ(plan.marks.size(), 1U);
  EXPECT_THAT(plan.marks[0], ElementsAre(Pair("speed_mph", "40"), Pair("latency_ms", "100")));
  EXPECT_EQ(plan.hash(), plan_of(axes).hash());
  EXPECT_THAT(fault_of(axes + "marks: [{seed: 1}]"), HasSubstr("p.yaml:2: seed: got no key of an axis"));
  EXPECT_THAT(fault_of(axes + "marks: 3"), HasSubstr("marks: got 3"));
}

TEST(Sobol, EachBlockOfAPowerOfTwoHasOneNumberInEachPart) {
  for (const std::uint64_t seed : {0U, 7U}) {
    for (int dimension = 0; dimension < kSobolDimensions; ++dimension) {
      for (const std::uint32_t begin : {0U, 64U, 4096U}) {
        std::set<int> parts;
        for (std::uint32_t i = 0; i < 64; ++i)
          parts.insert(static_cast<int>(64.0 * sobol(begin + i, dimension, seed)));
        EXPECT_EQ(parts.size(), 64U) << dimension;
        EXPECT_GE(*parts.begin(), 0);
        EXPECT_LE(*parts.rbegin(), 63);
      }
    }
  }
}

TEST(Sobol, BeginsAsPublished) {
  // Joe and Kuo's sobol.cc, points 1 to 4 of three dimensions.
  const std::vector<std::vector<double>> points{
      {0.5, 0.5, 0.5}, {0.75, 0.25, 0.25}, {0.25, 0.75, 0.75}, {0.375, 0.375, 0.625}};
  for (std::uint32_t i = 0; i < points.size(); ++i)
    for (int d = 0; d < 3; ++d)
      EXPECT_EQ(sobol(i + 1, d, 0), points[i][static_cast<std::size_t>(d)]) << i << " " << d;
}

TEST(Sobol, TwoDimensionsTogetherFillTheSquare) {
  for (int other = 1; other < kSobolDimensions; ++other) {
    std::set<int> cells;
    for (std::uint32_t i = 0; i < 1024; ++i)
      cells.insert(8 * static_cast<int>(8.0 * sobol(i, 0, 0)) + static_cast<int>(8.0 * sobol(i, other, 0)));
    EXPECT_EQ(cells.size(), 64U) << other;
  }
}

TEST(LatinHypercube, EachPartHasOnePointForAnyNumberOfThem) {
  for (const std::uint32_t count : {1U, 2U, 3U, 10U, 97U, 1000U}) {
    for (int dimension = 0; dimension < 3; ++dimension) {
      std::set<std::uint32_t> parts;
      for (std::uint32_t i = 0; i < count; ++i) {
        const double x = latin_hypercube(i, count, dimension, 5);
        ASSERT_GE(x, 0.0);
        ASSERT_LT(x, 1.0);
        parts.insert(static_cast<std::uint32_t>(x * count));
      }
      EXPECT_EQ(parts.size(), count);
    }
  }
}

TEST(LatinHypercube, DependsOnSeedAndDimension) {
  EXPECT_NE(latin_hypercube(3, 100, 0, 1), latin_hypercube(3, 100, 0, 2));
  EXPECT_NE(latin_hypercube(3, 100, 0, 1), latin_hypercube(3, 100, 1, 1));
  EXPECT_EQ(latin_hypercube(3, 100, 0, 1), latin_hypercube(3, 100, 0, 1));
}

}  // namespace
}  // namespace chicane::sweep
