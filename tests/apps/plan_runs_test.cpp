// SPDX-License-Identifier: MIT
// Commands that drive many runs by a plan: what they keep, and how they go on.

#include <nlohmann/json.hpp>

#include "apps/program_outcome.hpp"
#include "support/chicane_test.hpp"

namespace chicane::test {
namespace {

using OrderedJson = nlohmann::ordered_json;  // lines begin with their run

class PlanRuns : public testing::Test, protected Folder {
 protected:
  [[nodiscard]] std::vector<std::string> lines() const {
    std::ifstream stream(file_);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
  }
  void keep(const std::vector<std::string>& lines) const {
    std::ofstream stream(file_, std::ios::trunc);
    for (const std::string& line : lines) stream << line << '\n';
  }

  const std::string file_ = path("runs.jsonl");
};

TEST_F(PlanRuns, ACampaignTellsHowToRepeatWhereTheCarLeavesTheRoadAndGoesOnWithWhatIsMissing) {
  const std::string command =
      "campaign --faults frozen_sensor --for-s inf --every-s 5 --tracks oval,hairpins --cars udacity "
      "--jobs 1 --set guard.mode=off --results '" +
      file_ + "'";
  const Outcome whole = chicane_program(command);
  EXPECT_EQ(whole.code, 1);
  const std::vector<std::string> told = lines();
  ASSERT_EQ(told.size(), 3U) << whole.err;
  const std::size_t drive = whole.out.find("chicane drive");
  ASSERT_NE(drive, std::string::npos);
  const std::string again = whole.out.substr(drive + 8, whole.out.find('\n', drive) - drive - 8);
  EXPECT_GT(OrderedJson::parse(chicane_program(again + " --json").out)["off_track_events"], 0) << again;

  keep({told[0], told[1]});
  EXPECT_EQ(chicane_program(command).out, whole.out);
  EXPECT_EQ(lines(), told) << "the same bytes";
}

TEST_F(PlanRuns, RecoverGoesOnWithWhatIsMissingAndSaysTheSame) {
  const std::string command =
      "recover --tracks oval --cars udacity --starts 3 --seed 2 --jobs 1 --json --results '" + file_ + "'";
  const Outcome whole = chicane_program(command);
  const std::vector<std::string> told = lines();
  ASSERT_EQ(told.size(), 4U) << whole.err;
  const OrderedJson rows = OrderedJson::parse(whole.out)["rows"];
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0]["starts"], 3);
  EXPECT_EQ(rows[0]["outcomes"][2]["number"], 3);

  // The second start is missing, and the third has an outcome that only a file can have.
  OrderedJson third = OrderedJson::parse(told[3]);
  third["back_s"] = 12345.0;
  keep({told[0], told[1], third.dump()});
  const Outcome resumed = chicane_program(command);
  ASSERT_EQ(lines().size(), 4U) << resumed.err;
  EXPECT_EQ(lines()[3], told[2]) << "the same bytes";
  OrderedJson expected = OrderedJson::parse(whole.out);
  expected["rows"][0]["outcomes"][2]["back_s"] = 12345.0;
  EXPECT_EQ(OrderedJson::parse(resumed.out), expected);

  const Outcome other = chicane_program(command + " --set latency_ms=50");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("got results of the plan"));
}

TEST_F(PlanRuns, OneStartIsThatOfAllStarts) {
  const std::string command = "recover --tracks oval --cars udacity --starts 3 --seed 2 --json";
  const OrderedJson all = OrderedJson::parse(chicane_program(command).out)["rows"][0]["outcomes"];
  const OrderedJson one =
      OrderedJson::parse(chicane_program(command + " --only 2").out)["rows"][0]["outcomes"];
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0], all[1]);
  const Outcome none = chicane_program(command + " --only 4");
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("--only: got 4, expected a start from 1 to 3"));
}

TEST_F(PlanRuns, ALaneChangeIsShownFromItsFile) {
  const std::string command = "lane-change --cars udacity --presets stanley --json --results '" + file_ + "'";
  const Outcome mistake = chicane_program("lane-change --cars moped --presets stanley");
  EXPECT_EQ(mistake.code, 2);
  EXPECT_THAT(mistake.err, HasSubstr("car: got \"moped\""));
  const Outcome first = chicane_program(command);
  ASSERT_EQ(first.code, 0) << first.err;
  const OrderedJson row = OrderedJson::parse(first.out)["rows"][0];
  EXPECT_EQ(row["car"], "udacity");
  EXPECT_EQ(row["preset"], "stanley");
  EXPECT_GT(row["entry_kmph"], 30);
  EXPECT_LT(row["room_above_m"], 0.0);
  const std::vector<std::string> told = lines();
  ASSERT_EQ(told.size(), 2U);
  OrderedJson line = OrderedJson::parse(told[1]);
  line["entry_kmph"] = 77;
  keep({told[0], line.dump()});
  EXPECT_EQ(OrderedJson::parse(chicane_program(command).out)["rows"][0]["entry_kmph"], 77);
}

TEST(PlanCommand, ASecondStartTakesThePlanFromTheCache) {
  const Folder cache;
  const std::string drive = "XDG_CACHE_HOME='" + cache.path("cache") + "' " + kProgram +
                            "drive --preset race --track oval --fast --laps 1 --json";
  const auto lap_of = [](const Outcome& outcome) {
    return OrderedJson::parse(outcome.out, nullptr, false)["laps"][0]["lap_time_s"].dump();
  };
  const Outcome first = shell(drive);
  ASSERT_EQ(first.code, 0) << first.err;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(cache.path("cache/chicane"))) files.push_back(entry.path());
  ASSERT_GE(files.size(), 1U);
  EXPECT_EQ(lap_of(shell(drive)), lap_of(first));
  for (const auto& file : files) fs::resize_file(file, 10);
  const Outcome damaged = shell(drive);
  for (const auto& file : files)
    EXPECT_THAT(damaged.err, HasSubstr(file.string() + " is damaged and ignored"));
  EXPECT_EQ(lap_of(damaged), lap_of(first));
  EXPECT_EQ(shell(drive + " --no-cache").code, 0);
}

TEST(PlanCommand, CtrlCEndsPlanningAtOnce) {
  for (const std::string command : {"drive", "serve"}) {
    const Outcome outcome =
        interrupted_program(command + " --preset race --car road-car --track speedway --port 0 --no-cache",
                            "the lap is planned first");
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("stopped before the run began")) << command;
    EXPECT_THAT(outcome.err, HasSubstr("dashboard will be at http://localhost:")) << command;
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

TEST(PlanCommand, ABudgetEndsPlanningWithTheBestSoFar) {
  const std::string drive =
      "drive --preset race --track oval --fast --laps 1 --no-cache --json --set tracking_mpc.plan_budget_s=";
  const Outcome none = chicane_program(drive + "0.1");
  EXPECT_EQ(none.code, 0) << none.err;
  EXPECT_THAT(none.err, HasSubstr("plan: none found"));
  const Outcome some = chicane_program(drive + "0.5");
  EXPECT_EQ(some.code, 0) << some.err;
  EXPECT_THAT(some.err, HasSubstr("plan: the best so far, no optimum: tracking_mpc.plan_budget_s"));
  const Outcome limit = chicane_program("limit --track oval --no-cache --budget-s 0.4");
  EXPECT_EQ(limit.code, 0) << limit.err;
  EXPECT_THAT(limit.out, HasSubstr("is the best lap so far, no bound"));
}

}  // namespace
}  // namespace chicane::test
