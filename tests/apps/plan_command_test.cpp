// SPDX-License-Identifier: MIT
// Planning as a user meets it: progress, signals, budgets and the cache.
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "apps/program_outcome.hpp"
#include "support/chicane_test.hpp"

namespace chicane::test {
namespace {

using Json = nlohmann::json;

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

TEST(PlanCommand, ASecondStartTakesThePlanFromTheCache) {
  const fs::path cache = file_of_test("cache");
  fs::remove_all(cache);
  const std::string drive = "XDG_CACHE_HOME='" + cache.string() + "' " + kProgram +
                            "drive --preset race --track oval --fast --laps 1 --json";
  const auto lap_of = [](const Outcome& outcome) {
    return Json::parse(outcome.out, nullptr, false)["laps"][0]["lap_time_s"].dump();
  };
  const Outcome first = shell(drive);
  ASSERT_EQ(first.code, 0) << first.err;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(cache / "chicane")) files.push_back(entry.path());
  ASSERT_GE(files.size(), 1U);
  const Outcome second = shell(drive);
  EXPECT_EQ(lap_of(second), lap_of(first));
  for (const fs::path& file : files) fs::resize_file(file, 10);
  const Outcome damaged = shell(drive);
  for (const fs::path& file : files)
    EXPECT_THAT(damaged.err, HasSubstr(file.string() + " is damaged and ignored"));
  EXPECT_EQ(lap_of(damaged), lap_of(first));
  EXPECT_EQ(shell(drive + " --no-cache").code, 0);
  fs::remove_all(cache);
}

}  // namespace
}  // namespace chicane::test
