// SPDX-License-Identifier: MIT

#include <unistd.h>

#include <nlohmann/json.hpp>

#include "chicane/sweep/league.hpp"
#include "chicane/sweep/sweep.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::sweep {
namespace {

/// A league that takes a second: nobody has to complete a lap.
class LeagueFiles : public testing::Test, protected test::Folder {
 protected:
  LeagueFiles() {
    league_ = parse_league(R"(
name: small & <plain>
settings: {laps: 0, time_limit_s: 2}
search: {speed_mps: {from: 8, to: 10}}
entries:
  mine: {preset: pid}
  theirs: {server: "./mpc {port}"}
tracks: [oval]
cars: [udacity]
disturbances: {none: {}, late: {latency_ms: 130}}
)",
                           "l.yaml")
                  .value();
  }

  /// All runs, a limit of 10 s, and one trial of the program.
  LeagueResults driven(const Result<telemetry::RunSummary>& of_program) {
    auto beside = BesideFile::open(path("b.jsonl"), league_);
    EXPECT_TRUE(beside);
    SweepOptions options{.jobs = 2, .file = path("r.jsonl")};
    options.on_run = [&](std::uint64_t run, const telemetry::RunSummary& summary) {
      EXPECT_TRUE(beside->add_times(run, summary));
    };
    const std::atomic<bool> stop{false};
    EXPECT_TRUE(drive_plan(league_.plan, {}, options, stop));
    EXPECT_TRUE(beside->add_bound("oval", "udacity", 10.0));
    EXPECT_TRUE(beside->add_trial(league_.external_trials()[0], of_program));
    return *test::good(read_results(league_, path("r.jsonl"), path("b.jsonl")));
  }

  static telemetry::RunSummary clean_run() {
    telemetry::RunSummary run;
    run.completed = true;
    run.laps_wanted = run.laps_completed = 1;
    run.laps.push_back({.lap_time = 12.5});
    run.step_time = {.p50 = 0.12, .p99 = 0.13};
    return run;
  }

  League league_;
};

TEST_F(LeagueFiles, ResultsJoinOurRunsThoseOfTheProgramAndTheLimits) {
  const LeagueResults results = driven(clean_run());
  ASSERT_EQ(results.cells.size(), 4U);
  EXPECT_EQ(results.missing, 0U);
  EXPECT_TRUE(results.cells[0].is_clean);
  EXPECT_DOUBLE_EQ(results.cells[0].number("search_value"), 10.0);
  EXPECT_THAT(results.cells[1].command, HasSubstr("--latency-ms 130"));
  EXPECT_THAT(results.cells[1].command, HasSubstr("--speed-mps 10"));
  EXPECT_TRUE(results.cells[2].is_external);
  EXPECT_TRUE(results.cells[2].is_clean);
  EXPECT_DOUBLE_EQ(results.cells[2].number("lap_time_s"), 12.5);
  EXPECT_DOUBLE_EQ(results.cells[2].number("answer_time_us.p50"), 120000.0);
  EXPECT_FALSE(results.cells[3].is_clean);
  EXPECT_EQ(results.cells[3].why, "the command has no place {latency_ms}");
  EXPECT_EQ(results.bounds.size(), 1U);
  EXPECT_THAT(content("r.jsonl"), Not(HasSubstr("time_us"))) << "what a clock has told";
  EXPECT_THAT(content("r.jsonl"), Not(HasSubstr("theirs")));
}

TEST_F(LeagueFiles, ThePageHasStandingsGapsTimesAndReasons) {
  const LeagueResults results =
      driven(fail(ErrorCode::kIo, "the program does not listen on port 1: <refused>"));
  const auto document = nlohmann::json::parse(league_document(league_, results));
  EXPECT_EQ(document["title"], "small & <plain>");
  EXPECT_EQ(document["sections"][1]["title"], "Standings");
  EXPECT_EQ(document["sections"][1]["parts"][1]["rows"][0][0], "mine");
  const auto commands = document["sections"].back()["parts"][1]["rows"];
  EXPECT_THAT(commands[0].back()["text"], HasSubstr("--preset pid --track oval --car udacity"));
  EXPECT_THAT(commands[2].back()["remark"], HasSubstr("<refused>"));
  telemetry::RunSummary without_clock = clean_run();
  without_clock.step_time.p50 = telemetry::kNotMeasured;
  EXPECT_THAT(league_markdown(league_, driven(without_clock)),
              HasSubstr("| theirs | answer | not measured | not measured | 0 |"));
  const std::string markdown = league_markdown(league_, driven(clean_run()));
  EXPECT_THAT(markdown, HasSubstr("### Standings"));
  EXPECT_THAT(markdown, HasSubstr("| mine | 1 of 1 | 1 of 1 |"));
  EXPECT_THAT(markdown, HasSubstr("| theirs | its own | 12.50 | 25.0 |"));
  EXPECT_THAT(markdown, HasSubstr("The limit is 10.00 s."));
  EXPECT_THAT(markdown, HasSubstr("| theirs | answer | 120000 | 130000 | 1 |"));
}

TEST_F(LeagueFiles, TablesForOtherProgramsHaveARowForEachRun) {
  const LeagueResults results = driven(clean_run());
  const std::string csv = league_runs(league_, results).csv();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_THAT(csv, HasSubstr("mine,oval,udacity,late,1,10,10,1,"));
  const auto json = league_runs(league_, results).json();
  ASSERT_EQ(json.size(), 4U);
  EXPECT_EQ(json[2]["lap_time_s"], 12.5);
  EXPECT_TRUE(json[3]["lap_time_s"].is_null());
}

TEST_F(LeagueFiles, TheFileBesideKnowsWhatIsDone) {
  static_cast<void>(driven(clean_run()));
  const auto trials = league_.external_trials();
  const auto again = test::good(BesideFile::open(path("b.jsonl"), league_));
  EXPECT_TRUE(again->has_bound("oval", "udacity"));
  EXPECT_FALSE(again->has_bound("oval", "road-car"));
  EXPECT_TRUE(again->has_trial(trials[0]));
  EXPECT_FALSE(again->has_trial(trials[1]));
}

TEST_F(LeagueFiles, TrialsStayWhenAnotherProgramsCommandChanges) {
  league_.externals.push_back(league_.externals[0]);
  league_.externals[1].name = "others";
  league_.externals[1].command = "./other {port}";
  static_cast<void>(driven(clean_run()));
  {
    auto file = BesideFile::open(path("b.jsonl"), league_);
    ASSERT_TRUE(file && file->add_trial(league_.external_trials()[2], clean_run()));
  }
  const std::string before = league_.externals[0].command;
  league_.externals[0].command = "./another {port}";
  {
    const auto changed = test::good(BesideFile::open(path("b.jsonl"), league_));
    EXPECT_FALSE(changed->has_trial(league_.external_trials()[0]));
    EXPECT_TRUE(changed->has_trial(league_.external_trials()[2]));
    EXPECT_TRUE(changed->has_bound("oval", "udacity"));
  }
  const auto results = test::good(read_results(league_, path("r.jsonl"), path("b.jsonl")));
  EXPECT_EQ(results->cells[2].why, "not driven yet") << "the trial was of another command";
  EXPECT_TRUE(results->cells[4].is_clean);
  league_.externals[0].command = before;
  EXPECT_TRUE(BesideFile::open(path("b.jsonl"), league_)->has_trial(league_.external_trials()[0]));
}

TEST_F(LeagueFiles, RefusesTheFileOfAnotherLeagueAndLeavesIt) {
  static_cast<void>(driven(clean_run()));
  const auto size = fs::file_size(path("b.jsonl"));
  league_.name = "another";
  const auto other = BesideFile::open(path("b.jsonl"), league_);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(other.error().message, HasSubstr("b.jsonl: got the limits and trials of small & <plain>"));
  EXPECT_EQ(fs::file_size(path("b.jsonl")), size);
}

TEST_F(LeagueFiles, MissingRunsAreCounted) {
  SweepOptions options{.jobs = 1, .file = path("r.jsonl")};
  std::atomic<bool> stop{false};
  options.on_progress = [&](const Progress&) { stop = true; };
  ASSERT_TRUE(drive_plan(league_.plan, {}, options, stop));
  const auto results = test::good(read_results(league_, path("r.jsonl"), path("none.jsonl")));
  EXPECT_EQ(results->missing, 1U);
  EXPECT_EQ(results->cells[1].why, "not driven yet");
  EXPECT_THAT(league_markdown(league_, *results), HasSubstr("1 of them not driven yet"));
}

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

std::string league_fault(const std::string& text) { return test::refusal_of(parse_league(text, "l.yaml")); }

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
