// SPDX-License-Identifier: MIT
#include "chicane/sweep/sweep.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <future>
#include <nlohmann/json.hpp>

#include "chicane/base/text.hpp"
#include "chicane/sweep/plan_codec.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/sweep/result_table.hpp"
#include "chicane/sweep/trial.hpp"
#include "chicane/version.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::sweep {
namespace {

constexpr const char* kPlan = R"(
settings: {laps: 0, time_limit_s: 2, preset: pid, sensor.position_noise_m: 0.05}
axes:
  - seed: {from: 1, to: 4}
  - latency_ms: [60, 100, 140]
keep: [top_speed_mps, lap_times_s, end_reason]
)";

class Sweep : public testing::Test, protected test::Folder {
 protected:
  Result<Progress> run(const std::string& file, const run::Shard& shard = {}, int jobs = 1) {
    return drive_plan(plan_, shard, {.jobs = jobs, .file = path(file)}, stop_);
  }
  /// The merged bytes of some files.
  std::string merged(const std::vector<std::string>& names) {
    std::vector<std::string> files;
    for (const std::string& name : names) files.push_back(path(name));
    const std::string refusal = test::refusal_of(merge(files, path("merged")));
    return refusal.empty() ? content("merged") : refusal;
  }

  Plan plan_ = parse_plan(kPlan, "plan.yaml").value();
  std::atomic<bool> stop_{false};
};

TEST(Column, CountsTheStepsOfEachReasonOfTheGuard) {
  telemetry::RunSummary run;
  run.guard_reasons[static_cast<std::size_t>(controller::GuardReason::kNone)] = 90;
  EXPECT_EQ(find_column("guard_reasons")->text(run), "{}");
  run.guard_reasons[static_cast<std::size_t>(controller::GuardReason::kNoAnswer)] = 2;
  run.guard_reasons[static_cast<std::size_t>(controller::GuardReason::kNoWayToStop)] = 7;
  EXPECT_EQ(find_column("guard_reasons")->text(run), R"({"no_answer":2,"no_way_to_stop":7})");
}

TEST_F(Sweep, WritesALineForEachRunWithItsSettingsAndResults) {
  const auto done = test::good(run("a.jsonl"));
  EXPECT_TRUE(done->is_complete());
  EXPECT_EQ(done->driven, 12U);
  std::ifstream stream(path("a.jsonl"));
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(nlohmann::json::parse(line)["guard"]["version"], safety::kGuardVersion);
  const auto header = test::good(parse_header(line, "a"));
  EXPECT_EQ(header->runs, 12U);
  EXPECT_EQ(header->keys, (std::vector<std::string>{"seed", "latency_ms"}));
  std::getline(stream, line);
  const auto first = nlohmann::json::parse(line);
  EXPECT_EQ(first["run"], 0);
  EXPECT_EQ(first["settings"], (nlohmann::json{{"seed", 1}, {"latency_ms", 60}}));
  EXPECT_GT(first["top_speed_mps"].get<double>(), 1.0);
  EXPECT_EQ(first["lap_times_s"], nlohmann::json::array());
  EXPECT_EQ(first["end_reason"], "time limit reached");
  EXPECT_EQ(first["state_hash"].get<std::string>().size(), 16U);
  EXPECT_EQ(first.size(), 6U);
}

TEST(Column, NamesTheGuard) {
  telemetry::RunSummary run;
  EXPECT_EQ(find_column("guard_mode")->text(run), "null");
  run.guard = {.mode = safety::GuardMode::kOff, .road = safety::GuardRoad::kWaypoints};
  EXPECT_EQ(find_column("guard_mode")->text(run), "\"off\"");
  EXPECT_EQ(find_column("guard_road")->text(run), "\"waypoints\"");
}

TEST_F(Sweep, TheMergedBytesDependOnNothingButThePlan) {
  ASSERT_TRUE(run("one.jsonl"));
  ASSERT_TRUE(run("two.jsonl", {}, 2));
  std::vector<std::string> parts;
  for (std::uint64_t i = 0; i < 7; ++i) {
    const std::string name = "part" + std::to_string(i);
    ASSERT_TRUE(run(name, {i, 7, "--shard"}, 1 + static_cast<int>(i % 2)));
    parts.insert(parts.begin(), name);
  }
  const std::string expected = merged({"one.jsonl"});
  EXPECT_EQ(std::count(expected.begin(), expected.end(), '\n'), 13);
  EXPECT_EQ(merged({"two.jsonl"}), expected);
  EXPECT_EQ(merged(parts), expected);
  EXPECT_EQ(merged({"part3", "one.jsonl"}), expected) << "the same run twice is one run";
}

TEST_F(Sweep, GoesOnAfterItWasKilledInTheMiddleOfALine) {
  ASSERT_TRUE(run("a.jsonl"));
  const std::string whole = content("a.jsonl");
  const std::string expected = merged({"a.jsonl"});
  for (const std::size_t size : {std::size_t{0}, std::size_t{10}, whole.size() / 2, whole.size() - 1}) {
    std::ofstream(path("a.jsonl"), std::ios::trunc) << whole.substr(0, size);
    const auto again = test::good(run("a.jsonl"));
    EXPECT_EQ(again->found + again->driven, 12U);
    EXPECT_GT(again->driven, 0U);
    EXPECT_EQ(merged({"a.jsonl"}), expected);
  }
  EXPECT_EQ(run("a.jsonl")->driven, 0U) << "nothing is left to do";
}

TEST_F(Sweep, StopsWithWhatIsDoneAndGoesOnLater) {
  SweepOptions options{.jobs = 1, .file = path("a.jsonl")};
  options.on_progress = [&](const Progress& progress) {
    if (progress.driven == 5) stop_ = true;
  };
  const auto stopped = test::good(drive_plan(plan_, {}, options, stop_));
  EXPECT_EQ(stopped->driven, 5U);
  EXPECT_FALSE(stopped->is_complete());
  EXPECT_THAT(merged({"a.jsonl"}), HasSubstr("7 of 12 runs are missing: 5-11"));
  stop_ = false;
  EXPECT_EQ(run("a.jsonl")->found, 5U);
}

TEST_F(Sweep, AFullDiskIsSaidAndLeavesNoHalfLine) {
  ASSERT_TRUE(run("a.jsonl"));
  const std::string expected = merged({"a.jsonl"});
  const std::size_t size = content("a.jsonl").size();
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit limit = before;
  limit.rlim_cur = size / 2 + 20;  // in the middle of a line
  setrlimit(RLIMIT_FSIZE, &limit);
  const auto full = run("b.jsonl");
  setrlimit(RLIMIT_FSIZE, &before);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, ErrorCode::kIo);
  EXPECT_THAT(full.error().message, HasSubstr("cannot be written: "));
  EXPECT_THAT(full.error().message, HasSubstr("of 12 runs are done"));
  EXPECT_EQ(content("b.jsonl").back(), '\n');
  EXPECT_GT(run("b.jsonl")->found, 0U);
  EXPECT_EQ(merged({"b.jsonl"}), expected);
}

TEST_F(Sweep, ARunThatCannotBeDrivenSaysWhyAndStopsNothing) {
  const char* text =
      "settings: {laps: 0, time_limit_s: 1}\naxes: [{controller: [pid, cubic-mpc], speed_mph: [30, 30]}, "
      "{track: [lakeside, nowhere]}]";
  plan_ = parse_plan(text, "p").value();
  const auto done = test::good(run("a.jsonl", {}, 2));
  EXPECT_EQ(done->failed, 2U);
  EXPECT_THAT(done->why, HasSubstr("track: got \"nowhere\", expected"));
  EXPECT_THAT(merged({"a.jsonl"}), HasSubstr("\"error\":\"track: got \\\"nowhere\\\", expected"));
}

TEST_F(Sweep, ResultsOfAnotherPlanAreNotMixed) {
  ASSERT_TRUE(run("a.jsonl"));
  plan_ = parse_plan(std::string(kPlan) + "about: the same\n", "plan.yaml").value();
  EXPECT_TRUE(run("a.jsonl")) << "the same plan in other words";
  plan_.fixed.emplace_back("laps", "1");
  EXPECT_THAT(run("a.jsonl").error().message, HasSubstr("got results of the plan "));
  ASSERT_TRUE(run("b.jsonl"));
  EXPECT_THAT(merged({"a.jsonl", "b.jsonl"}), HasSubstr("got the plan"));
}

/// The version is the same in all of them.
TEST_F(Sweep, ResultsOfAnotherBuildAreNotMixed) {
  ASSERT_TRUE(run("a.jsonl"));
  const std::string ours = program_name();
  EXPECT_THAT(ours, testing::MatchesRegex("chicane [0-9.]+ \\([0-9a-f]+\\)"));
  std::string other = content("a.jsonl");
  other.replace(other.find(ours), ours.size(), "chicane " CHICANE_VERSION " (0123456789ab)");
  std::ofstream(path("b.jsonl")) << other;
  EXPECT_THAT(
      merged({"a.jsonl", "b.jsonl"}),
      HasSubstr("b.jsonl: got the program chicane " CHICANE_VERSION " (0123456789ab), expected " + ours));
  EXPECT_THAT(run("b.jsonl").error().message, HasSubstr("got results of the program chicane "));
  other = content("a.jsonl");
  other.replace(other.find(R"({"version":)"), 11, R"({"version":9)");
  std::ofstream(path("b.jsonl")) << other;
  EXPECT_THAT(merged({"a.jsonl", "b.jsonl"}), HasSubstr(R"(b.jsonl: got the guard {"version":9)"));
}

TEST_F(Sweep, ResultsWithFilesOfOtherContentsAreNotMixed) {
  write("inner.yaml", "controller: pid\npid: {speed_gain: 0.3}\n");
  write("outer.yaml", "preset: inner.yaml\nlatency_ms: 80\n");
  const std::string text =
      fmt::format("settings: {{laps: 0, time_limit_s: 1, track: {}}}\naxes: [{{preset: [pid, {}]}}]",
                  path("road.csv"), path("outer.yaml"));
  plan_ = parse_plan(text, "plan.yaml").value();
  EXPECT_TRUE(run("a.jsonl"));
  EXPECT_TRUE(run("a.jsonl"));
  write("road.csv", "# x_m,y_m\n");
  EXPECT_THAT(run("a.jsonl").error().message, HasSubstr("presets, cars or tracks of other contents"));
  fs::remove(path("road.csv"));
  EXPECT_TRUE(run("a.jsonl"));
  write("inner.yaml", "controller: pid\npid: {speed_gain: 0.4}\n");  // which the preset builds on
  EXPECT_THAT(run("a.jsonl").error().message, HasSubstr("presets, cars or tracks of other contents"));
}

TEST_F(Sweep, APipeCannotBeMergedBecauseItsLinesAreReadTwice) {
  ASSERT_TRUE(run("a.jsonl"));
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  // The half line at the end fills the pipe, which so stays open until its lines are read; it is skipped.
  const std::string text = content("a.jsonl") + std::string(1U << 18U, ' ');
  const auto writer = std::async(std::launch::async, [&] { return write("pipe", text); });
  EXPECT_THAT(merged({"pipe"}), HasSubstr("pipe: cannot be read a second time"));
}

TEST_F(Sweep, TwoResultsOfOneRunAreSaid) {
  ASSERT_TRUE(run("a.jsonl"));
  std::string other = content("a.jsonl");
  const std::size_t at = other.find("state_hash\":\"", other.find("{\"run\":4,")) + 13;
  other[at] = other[at] == '0' ? '1' : '0';
  std::ofstream(path("b.jsonl")) << other;
  EXPECT_THAT(merged({"a.jsonl", "b.jsonl"}), HasSubstr("got other results of run 4 than"));
  std::ofstream(path("b.jsonl")) << other.substr(0, other.find('\n') + 1) << "hello\n";
  EXPECT_THAT(merged({"a.jsonl", "b.jsonl"}),
              HasSubstr("b.jsonl:2: got hello, expected the results of a run"));
}

TEST_F(Sweep, AFileHasOneWriter) {
  const auto first = test::good(ResultFile::open(path("a.jsonl"), plan_, {}));
  EXPECT_THAT(run("a.jsonl").error().message, HasSubstr("another process writes it"));
}

TEST_F(Sweep, TablesHaveAColumnForEachSettingAndResult) {
  ASSERT_TRUE(run("a.jsonl"));
  ASSERT_TRUE(write_csv(path("a.jsonl"), path("a.csv")));
  const std::string csv = content("a.csv");
  EXPECT_THAT(csv, StartsWith("run,seed,latency_ms,top_speed_mps,lap_times_s,end_reason,error\r\n0,1,60,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 13);
  EXPECT_THAT(write_csv(path("a.jsonl"), path("nowhere/a.csv")).error().message,
              HasSubstr("cannot be written: No such file or directory"));
}

TEST(SweepOutcome, ColumnsAreFoundByTheirNames) {
  for (const Column& column : columns()) EXPECT_EQ(find_column(column.name), &column);
  EXPECT_EQ(find_column("wall_time_s"), nullptr) << "nothing that the clock has told";
  telemetry::RunSummary run;
  EXPECT_EQ(find_column("lap_time_s")->text(run), "null");
  run.laps = {{.lap_time = 30.5}, {.lap_time = 25.25}, {.lap_time = 26.0}};
  EXPECT_EQ(find_column("lap_time_s")->text(run), "26");
  EXPECT_EQ(find_column("best_lap_time_s")->text(run), "25.25");
  EXPECT_EQ(find_column("lap_times_s")->text(run), "[30.5,25.25,26]");
}

TEST_F(Sweep, ThePageSumsUpAxesAndPairsAndHasTheCommandOfEachRun) {
  ASSERT_TRUE(run("a", {0, 2, "--shard"}));
  ASSERT_TRUE(run("b", {1, 2, "--shard"}));
  const auto summary = test::good(summary_document({path("a"), path("b")}));
  EXPECT_EQ(summary->runs, 12U);
  for (
      const char* words :
      {R"("title":"plan")", "12 of 12 runs, 12 clean", R"("columns":["latency_ms")", R"(seed \\ latency_ms)",
       R"("text":"chicane drive --fast --laps 0 --preset pid --seed 3 --latency-ms 140 --set time_limit_s=2)",
       R"(&seed=3&latency_ms=140")"})
    EXPECT_THAT(summary->text, HasSubstr(words));
  EXPECT_EQ(summary_document({path("a")})->runs, 6U) << "what is missing is left out";
  std::ofstream(path("x")) << "hello\n";
  EXPECT_FALSE(summary_document({path("x")}));
}

TEST(SweepMerge, NamesRanges) {
  EXPECT_EQ(ranges_text({17, 18, 19, 20, 33}), "17-20, 33");
  EXPECT_EQ(ranges_text({1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 22}),
            "1, 3, 5, 7, 9, 11, 13, 15, 17, 19 and 2 more");
}

/// Of "laps=2;track=oval".
Settings settings_in(const std::string& text) {
  Settings settings;
  std::istringstream words(text);
  for (std::string key, value; std::getline(words, key, '=') && std::getline(words, value, ';');)
    settings.emplace_back(key, value);
  return settings;
}

TEST(SweepTrial, TheCommandDrivesTheSameRun) {
  EXPECT_EQ(command_of(settings_in("preset=weighted;laps=2;speed_mph=40;guard.mode=off;laps=3;"
                                   "fault.name=half_grip;fault.at_s=12;track=my track.csv")),
            "chicane drive --fast --preset weighted --laps 3 --track 'my track.csv' --set guard.mode=off "
            "--speed-mph 40 --fault half_grip@12");
  EXPECT_EQ(command_of(settings_in("speed_mph=30;speed_mps=8;speed_mph=20")),
            "chicane drive --fast --speed-mph 20")
      << "the last one wins, and drive takes one";
  EXPECT_FALSE(check_setting("latency_ms", "900"));
  EXPECT_FALSE(check_setting("speed_mph", "-3"));
  EXPECT_FALSE(check_setting("fault.name", "half_gripp"));
  EXPECT_FALSE(check_setting("fault.when_s", "3"));
  EXPECT_TRUE(check_setting("scenario", "first-lap"));
}

TEST(SweepTrial, TheLinkHoldsTheSameRunWhereALinkCan) {
  EXPECT_EQ(
      link_of(settings_in("preset=weighted;laps=2;speed_mph=40;latency_ms=90;latency_ms=130;guard.mode=off")),
      "http://localhost:4567/#run?preset=weighted&latency_ms=130&guard.mode=off"
      "&cubic_mpc.speed_reference_mps=17.8816");
  EXPECT_EQ(link_of(settings_in("preset=a b&c")), "http://localhost:4567/#run?preset=a%20b%26c");
  for (const char* none : {"track=../lake.csv", "scenario=first-lap", "fault=half_grip@12",
                           "preset=nothing-like-this;speed_mph=40"})
    EXPECT_EQ(link_of(settings_in(none)), "") << none;
}

/// How fast PID may be on the oval: a clean lap at slow speed, none at high speed.
constexpr const char* kSearching = R"(
settings: {laps: 1, time_limit_s: 200, preset: pid, track: oval, guard.mode: "off"}
axes:
  - grip: {cases: {dry: {}, wet: {plant_options.friction_scale: 0.5}}}
search: {speed_mps: {from: 12, to: 80, factor: 1.5, within: 0.1}}
keep: [completed, off_track_events, lap_time_s]
)";

TEST_F(Sweep, SearchesTheLargestValueThatIsClean) {
  plan_ = parse_plan(kSearching, "plan.yaml").value();
  ASSERT_EQ(plan_.size(), 2U);
  run::Roads roads;
  const auto found = test::good(find_largest(*plan_.search, plan_.settings_of(0), roads, stop_));
  const RunOutcome& best = **found;
  EXPECT_TRUE(telemetry::completed_on_road(best.run));
  EXPECT_GT(best.search_value, 12.0);
  EXPECT_LT(best.search_value, 60.0) << "PID takes no more than 60 m/s: 80 is passed over";
  Settings faster = plan_.settings_of(0);
  faster.emplace_back("speed_mps", number_text(best.search_value * 1.5, 4));
  const auto too_fast = test::good(drive(faster, roads, stop_));
  EXPECT_FALSE(telemetry::completed_on_road(**too_fast)) << "a rung of the ladder above";
  const auto wet = test::good(find_largest(*plan_.search, plan_.settings_of(1), roads, stop_));
  EXPECT_LT((*wet)->search_value, best.search_value);
}

TEST_F(Sweep, ASearchIsALineWithValueTrialsAndColumns) {
  plan_ = parse_plan(kSearching, "plan.yaml").value();
  ASSERT_TRUE(run("one.jsonl"));
  ASSERT_TRUE(run("two.jsonl", {}, 2));
  EXPECT_EQ(merged({"one.jsonl"}), merged({"two.jsonl"}));
  std::ifstream stream(path("one.jsonl"));
  std::string line;
  std::getline(stream, line);
  const auto header = test::good(parse_header(line, "a"));
  EXPECT_EQ(header->search_key, "speed_mps");
  EXPECT_EQ(header->columns.front(), "search_value");
  EXPECT_EQ(header->cases.at("grip").at("wet").front().second, "0.5");
  std::getline(stream, line);
  const auto first = nlohmann::json::parse(line);
  EXPECT_EQ(first["settings"], (nlohmann::json{{"grip", "dry"}}));
  EXPECT_GT(first["search_value"], 12.0);
  EXPECT_GT(first["search_trials"], 2);
  EXPECT_EQ(first["off_track_events"], 0);
  const auto summary = test::good(summary_document({path("one.jsonl")}));
  EXPECT_THAT(summary->text, HasSubstr("largest clean value"));
  EXPECT_THAT(summary->text, HasSubstr("friction_scale=0.5"));
}

TEST_F(Sweep, ASearchThatFindsNothingSaysSoWithTheSlowestRun) {
  plan_ = parse_plan(kSearching, "plan.yaml").value();
  plan_.search->from = plan_.search->to = 55.0;
  ASSERT_TRUE(run("a.jsonl"));
  EXPECT_THAT(content("a.jsonl"), HasSubstr(R"("search_value":null,"search_trials":1,)"));
  plan_.search->from = plan_.search->to = 120.0;
  ASSERT_TRUE(run("b.jsonl"));
  EXPECT_THAT(content("b.jsonl"), HasSubstr("expected a number in [0, 110]"));
}

}  // namespace
}  // namespace chicane::sweep
