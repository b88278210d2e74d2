// SPDX-License-Identifier: MIT
#include "chicane/run/fault_campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/parallel.hpp"

namespace chicane::run {
namespace {

constexpr double kStood = 1.0;         // [s] a car that stands so long has come to rest
constexpr double kTimeToGetGoing = 5;  // [s] for a car that the fault has stopped

scenario::Scenario endless(const scenario::Scenario& scenario) {
  scenario::Scenario other = scenario;
  other.laps = 0;
  other.time_limit = 0.0;
  other.faults.clear();
  return other;
}

}  // namespace

Result<FlyingLap> find_flying_lap(const scenario::Scenario& scenario, const ControllerFactory& make) {
  scenario::Scenario two = endless(scenario);
  two.laps = 2;
  auto loop = ClosedLoop::create(two, make);
  if (!loop) return fail(loop.error());
  double begins = 0.0;
  while (!(*loop)->is_over()) {
    (*loop)->advance();
    if ((*loop)->world().lap == 0) begins = (*loop)->time();
  }
  const sim::WorldState& world = (*loop)->world();
  if (world.lap < 2 || world.off_track_events > 0) {
    return fail(
        ErrorCode::kInvalidArgument,
        fmt::format("{} on {} with {}: two laps without leaving the road are not driven "
                    "without any fault: {} laps, {} times off the road",
                    scenario.car, scenario.track, scenario.preset, world.lap, world.off_track_events));
  }
  return FlyingLap{.begins = begins, .time = world.last_lap_time};
}

Result<FaultOutcome> drive_trial(const scenario::Scenario& scenario, const FlyingLap& lap,
                                 const FaultTrial& trial, Roads& roads, const ControllerFactory& make) {
  scenario::Scenario one = endless(scenario);
  FaultOutcome outcome{.trial = trial, .at = lap.begins + trial.onset};
  one.faults = {{trial.fault, outcome.at, trial.duration, trial.strength}};
  auto created = ClosedLoop::create(one, roads, make);
  if (!created) return fail(created.error());
  ClosedLoop& loop = **created;
  const bool is_lasting = trial.duration >= kLasting;
  const double end = outcome.at + (is_lasting ? kLongestWait : trial.duration + kSettling);
  double standing_since = loop.time();
  while (loop.time() < end && !loop.is_over()) {
    const bool is_new = loop.advance();
    const double speed = loop.frame().has_truth ? hypot(loop.frame().truth.vx, loop.frame().truth.vy) : 0.0;
    if (speed > FaultOutcome::kStanding || loop.time() < outcome.at) standing_since = loop.time();
    if (loop.time() <= outcome.at) continue;
    outcome.least_edge = std::min(outcome.least_edge, loop.world().edge_distance);
    outcome.end_speed = speed;
    if (is_new && loop.frame().result.report.rung != controller::Rung::kController) ++outcome.not_controller;
    if (is_lasting && loop.time() - standing_since > kStood && loop.time() > outcome.at + kTimeToGetGoing)
      break;
  }
  return outcome;
}

std::vector<FaultTrial> trials_over_lap(const FlyingLap& lap, sim::Fault fault, double duration,
                                        double step) {
  std::vector<FaultTrial> trials;
  for (int i = 0; i * step < lap.time; ++i)
    trials.push_back({fault, i * step, duration, sim::kind_of(fault).strength});
  return trials;
}

Result<std::vector<FaultOutcome>> drive_trials(const scenario::Scenario& scenario, const FlyingLap& lap,
                                               const std::vector<FaultTrial>& trials, int jobs,
                                               const std::function<bool(std::size_t)>& on_done,
                                               const ControllerFactory& make) {
  std::vector<Result<FaultOutcome>> outcomes(trials.size());
  for (std::size_t i = 0; i < trials.size(); ++i) outcomes[i] = FaultOutcome{.trial = trials[i]};
  std::atomic<std::size_t> done{0};
  for_each_run(trials.size(), jobs, [&](std::uint64_t i, Roads& roads) {
    outcomes[i] = drive_trial(scenario, lap, trials[i], roads, make);
    const std::size_t count = ++done;
    return !on_done || on_done(count);
  });
  std::vector<FaultOutcome> all;
  all.reserve(outcomes.size());
  for (Result<FaultOutcome>& outcome : outcomes) {
    if (!outcome) return fail(outcome.error());
    all.push_back(*outcome);
  }
  return all;
}

}  // namespace chicane::run
