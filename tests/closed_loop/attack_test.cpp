// SPDX-License-Identifier: MIT
// A sample of the attacks of guard_attack.cpp, which drives all of them.
#include "closed_loop/attack.hpp"

#include "support/results.hpp"
#include "support/runs.hpp"
#include "support/slow_tests.hpp"

namespace chicane::attack {
namespace {

/// The program's adversaries do attack: without a guard they leave the road.
TEST(Attack, LeavesTheRoadWithoutAGuard) {
  run::Roads roads;
  const auto scenario = test::good(scenario_of({.settings = {{"guard.mode", "off"}}}));
  for (const char* name : {"lock", "random_hold", "hold", "swerve", "brake", "false_plan", "everything"}) {
    const auto outcome = test::good(drive_adversary(*scenario, roads, *adversary_named(name), 2, 40.0));
    EXPECT_LT(outcome->least_edge, 0.0) << name;
  }
}

/// Plans that are not the ones driven, model cars, and cars whose wheels turn slowly.
TEST(Attack, DoesNotLeadOffTheRoad) {
  run::Roads roads;
  struct Trial {
    const char *adversary, *car, *track;
    double seconds;
  };
  for (const Trial& trial : {Trial{"frozen_output", "road-car", "lakeside", 25.0},
                             {"full_throttle", "road-car", "lakeside", 20.0},
                             {"creep", "road-car", "lakeside", 12.0},
                             {"lock", "f1tenth", "lakeside", 8.0},
                             {"rock", "f1tenth", "lakeside", 8.0},
                             {"blind_throttle", "f1tenth", "lakeside", 23.0},
                             {"blind_throttle", "f1tenth", "speedway", 12.0},
                             {"random_hold", "udacity", "lakeside", 30.0},
                             {"lock", "udacity", "lakeside", 10.0},
                             {"bang_bang", "udacity", "oval", 20.0},
                             {"random", "road-car", "oval", 20.0},
                             {"not_a_number", "road-car", "lakeside", 20.0},
                             {"drift", "udacity", "oval", 20.0},
                             {"return_slowly", "road-car", "lakeside", 8.0},
                             {"straight_on", "bmw-320i", "speedway", 46.0},
                             {"stop_on_road", "bmw-320i", "speedway", 10.0}}) {
    const auto scenario = test::good(scenario_of({.car = trial.car, .track = trial.track}));
    const auto outcome =
        test::good(drive_adversary(*scenario, roads, *adversary_named(trial.adversary), 0, trial.seconds));
    EXPECT_GE(outcome->least_edge, 0.0) << trial.adversary << " with " << trial.car;
    EXPECT_LE(outcome->fastest, 1.06 * scenario->vehicle.valid_speed)
        << trial.adversary << " with " << trial.car;
  }
}

/// Outcomes of signals that begin at full speed and last, each in a process of its own.
std::vector<Outcome> under_each(const std::string& car, const std::vector<std::string>& names) {
  const auto loop = std::move(*run::ClosedLoop::create(*scenario_of({.car = car})));
  const auto memory = remember(*loop, 1);
  while (loop->time() < 50.0) loop->advance();
  const std::vector<FalseSignal> all = false_signals();
  std::vector<Outcome> outcomes;
  drive_in_processes(
      names.size(), 2, {},
      [&](std::size_t i) {
        const auto found =
            std::find_if(all.begin(), all.end(), [&](const FalseSignal& s) { return s.name == names[i]; });
        return found == all.end() ? Outcome{} : drive_signal(*loop, {*found, 50.0, kLasting, 1}, memory);
      },
      [&](std::size_t, const Outcome& outcome) { outcomes.push_back(outcome); });
  return outcomes;
}

TEST(Guard, StopsOnItsRoadWhateverIsSaidOfAReset) {
  const std::vector<std::string> names{"faked_reset_to_start", "faked_reset_aside", "faked_reset_back",
                                       "zeros"};
  for (const char* car : {"udacity", "road-car"}) {
    const std::vector<Outcome> outcomes = under_each(car, names);
    ASSERT_EQ(outcomes.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      EXPECT_GE(outcomes[i].least_edge, 0.0) << car << ' ' << names[i];
      EXPECT_LT(outcomes[i].end_speed, Outcome::kStanding) << car << ' ' << names[i];
    }
  }
}

TEST(Guard, StopsOnItsRoadWithAHeadingThatJumps) {
  const std::vector<std::string> names{"heading+180", "heading+90", "heading-90"};
  for (const char* car : {"udacity", "road-car"}) {
    const std::vector<Outcome> outcomes = under_each(car, names);
    for (std::size_t i = 0; i < names.size(); ++i)
      EXPECT_GE(outcomes[i].least_edge, 0.0) << car << ' ' << names[i];
  }
}

/// Without a look at the actuators the car leaves the road by 7.9 m with 7° more; now by less, in the time in
/// which the offset is found. Half of each angle is named and not compensated: lost commands look like it.
TEST(Guard, NamesWheelsThatTurnOtherwise) {
  const std::vector<Outcome> outcomes = under_each("udacity", {"steering_half", "steering+7deg"});
  ASSERT_EQ(outcomes.size(), 2U);
  for (const Outcome& outcome : outcomes) EXPECT_EQ(outcome.doubt, controller::GuardReason::kOtherSteering);
  EXPECT_GE(outcomes[0].least_edge, -3.5);
  EXPECT_GE(outcomes[1].least_edge, -3.0);
}

TEST(Guard, DrivesOnAfterAReset) {
  const std::vector<std::string> all{"reset_to_start", "reset_to_third", "reset_to_two_thirds"};
  for (const char* car : {"udacity", "road-car"}) {
    const bool is_first = car[0] == 'u';
    for (const Outcome& outcome : under_each(car, kDrivesAll ? all : std::vector{all[is_first ? 0 : 1]})) {
      EXPECT_GE(outcome.least_edge, 0.0) << car;
      EXPECT_LT(outcome.driving_after, 12.0) << car << ": stopped, tried, driving [s]";
    }
  }
}

/// Nothing of what it sees changes what is sent: the same bits as without it, faults and all.
TEST(Guard, ReportsInObserveWhatItWouldHaveDone) {
  const auto run_with = [](const char* mode) {
    scenario::Scenario scenario =
        test::scenario_of({{"track", "oval"}, {"laps", "0"}, {"time_limit_s", "24"}, {"guard.mode", mode}});
    scenario.faults = {sim::default_event(*sim::fault_named("nan_measurement"), 14.0),
                       sim::default_event(*sim::fault_named("position_jump"), 19.0)};
    return test::drive(scenario);
  };
  const auto found = [](const telemetry::RunSummary& run, controller::GuardReason reason) {
    return run.guard_reasons[static_cast<std::size_t>(reason)];
  };
  const telemetry::RunSummary off = run_with("off");
  const telemetry::RunSummary observe = run_with("observe");
  const telemetry::RunSummary on = run_with("on");
  EXPECT_EQ(observe.state_hash, off.state_hash);
  EXPECT_NE(on.state_hash, off.state_hash);
  for (const auto reason : {controller::GuardReason::kNotMeasured, controller::GuardReason::kPositionJump}) {
    EXPECT_EQ(found(off, reason), 0U);
    EXPECT_GT(found(observe, reason), 10U);
    EXPECT_GT(found(on, reason), 10U);
  }
}

}  // namespace
}  // namespace chicane::attack
