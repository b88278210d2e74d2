// SPDX-License-Identifier: MIT
#include "chicane/sweep/league.hpp"
#include "support/chicane_test.hpp"

namespace chicane::sweep {
namespace {

using testing::Pair;

constexpr const char* kLeague = R"(
name: two and a program
settings: {laps: 1, guard.mode: "off"}
search: {speed_mps: {from: 5, to: 40, factor: 1.5}}
entries:
  mine: {preset: pid, pid: {derivative_gain: 0.1}}
  theirs: {server: "./mpc {port} {latency_ms} {track}", tracks: [oval]}
  other: {preset: stanley}
tracks: [lakeside, oval]
cars: [udacity]
disturbances: {none: {}, late: {latency_ms: 130}, blind: {fault: link_lost@3}}
)";

std::string league_fault(const std::string& text) {
  const auto league = parse_league(text, "l.yaml");
  return league ? "none" : league.error().message;
}

TEST(League, IsAPlanOfEntriesTracksCarsAndDisturbances) {
  const auto league = test::good(parse_league(kLeague, "l.yaml"));
  EXPECT_EQ(league->plan.size(), 2U * 2U * 1U * 3U);
  EXPECT_THAT(league->plan.at(1), ElementsAre(Pair("entry", "mine"), Pair("track", "lakeside"),
                                              Pair("car", "udacity"), Pair("disturbance", "late")));
  EXPECT_THAT(league->plan.settings_of(1),
              ElementsAre(Pair("laps", "1"), Pair("guard.mode", "off"), Pair("preset", "pid"),
                          Pair("pid.derivative_gain", "0.1"), Pair("track", "lakeside"),
                          Pair("car", "udacity"), Pair("latency_ms", "130")));
  ASSERT_TRUE(league->plan.search);
  EXPECT_DOUBLE_EQ(league->plan.search->factor, 1.5);
}

TEST(League, ProgramsAreTriedWhereTheySay) {
  const auto league = test::good(parse_league(kLeague, "l.yaml"));
  const auto trials = league->external_trials();
  ASSERT_EQ(trials.size(), 3U) << "one track, one car, three disturbances";
  EXPECT_EQ(trials[0].entry, "theirs");
  EXPECT_EQ(filled(trials[0], 1234), "./mpc 1234 100 oval");
  EXPECT_EQ(filled(trials[1], 1234), "./mpc 1234 130 oval");
  EXPECT_EQ(trials[1].why_not, "");
  EXPECT_EQ(trials[2].why_not, "faults are in our own control loop");
}

TEST(League, ACommandWithoutAPlaceForLatencyIsNotTriedWithIt) {
  auto league = test::good(parse_league(kLeague, "l.yaml"));
  add_external(*league, "{chicane} serve");
  const auto trials = league->external_trials();
  ASSERT_EQ(trials.size(), 3U + 6U);
  EXPECT_EQ(trials[3].entry, "{chicane} serve");
  EXPECT_EQ(filled(trials[3], 4567, "/opt/chicane"), "/opt/chicane serve");
  EXPECT_EQ(trials[3].why_not, "");
  EXPECT_EQ(trials[4].why_not, "the command has no place {latency_ms}");
}

TEST(League, ARosControllerIsTheOneWithAPlaceForTheDomain) {
  auto league = test::good(parse_league(kLeague, "l.yaml"));
  add_external(*league, "./follow {domain}");
  const auto trials = league->external_trials();
  ASSERT_GT(trials.size(), 4U);
  EXPECT_FALSE(is_ros(trials[0]));
  ASSERT_TRUE(is_ros(trials[3]));
  EXPECT_EQ(filled(trials[3], 7), "./follow 7");
  EXPECT_EQ(trials[4].why_not, "") << "latency is that of the simulated car";
}

TEST(League, TellsAllFaultsWithTheirLines) {
  const std::string fault = league_fault(R"(entries:
  a: {preset: nothing_like_this, latency_ms: x}
  a: {server: ""}
tracks: lakeside
teams: 1
)");
  EXPECT_THAT(fault, HasSubstr("l.yaml:2: latency_ms"));
  EXPECT_THAT(fault, HasSubstr("l.yaml:3: a: got it a second time"));
  EXPECT_THAT(fault, HasSubstr("l.yaml:3: server: got nothing"));
  EXPECT_THAT(fault, HasSubstr("l.yaml:4: tracks: got lakeside, expected a list"));
  EXPECT_THAT(fault, HasSubstr("l.yaml:5: teams: got an unknown key"));
  EXPECT_THAT(fault, HasSubstr("cars: got none"));
  EXPECT_THAT(league_fault("7"), HasSubstr("expected a league"));
  EXPECT_THAT(
      league_fault("entries: {a: {server: x, disturbances: [wet]}}\ntracks: [oval]\ncars: [udacity]\n"),
      HasSubstr("got wet, expected one of none"));
  EXPECT_THAT(league_fault("search: {speed_mps: {from: 5, to: 4}}\n"), HasSubstr("search: expected"));
  EXPECT_THAT(league_fault("search: {nonsense: {from: 5, to: 40}}\n"), HasSubstr("nonsense"));
}

TEST(League, TheShippedOneIsReadAndHasAProgram) {
  const auto league = test::good(read_league(CHICANE_SOURCE_DIR "/studies/leagues/shipped.yaml"));
  EXPECT_EQ(league->tracks.size(), 6U);
  EXPECT_EQ(league->cars.size(), 2U);
  EXPECT_EQ(league->plan.size(), 10U * 6U * 2U * 4U);
  EXPECT_EQ(league->externals.size(), 2U);
  EXPECT_FALSE(read_league("nowhere.yaml"));
}

TEST(League, TheBoundOfAnUnknownTrackIsAnError) {
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(bound_of({{"track", "nowhere"}}, stop));
  EXPECT_FALSE(bound_of({{"track", "oval"}}, stop)) << "stopped";
}

}  // namespace
}  // namespace chicane::sweep
