// SPDX-License-Identifier: MIT
// Trials of faults in a flying lap: the lap is driven once, and each trial continues a copy of the run.
#include "chicane/run/fault_campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

#include "chicane/base/math.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/run/run_steps.hpp"

namespace chicane::run {
namespace {

// Chosen, except for kRounding.
constexpr double kStood = 1.0;         // [s] time at standstill after which a car has come to rest
constexpr double kTimeToGetGoing = 5;  // [s] least trial: time for a stopped car to drive on by itself
constexpr double kRounding = 1e-9;     // [s] rounding of a time that is a sum of step lengths
constexpr double kLongestLaps = 1800;  // [s] longest time for the two laps without a fault

/// Time at which a trial's faults begin, in whole milliseconds of the run: short in `--fault NAME@at`.
double onset_of(const FlyingLap& lap, const FaultTrial& trial) {
  return std::round(1e3 * (lap.begins + trial.onset)) / 1e3;
}

/// Drives up to the time `at` [s]: the next step is the first with a fault.
void drive_up_to(RunSteps& steps, double at) {
  while (steps.loop().time() < at - kRounding && !steps.loop().is_over()) steps.advance();
}

/// Switches the faults of a trial on at the time `at` [s], and drives to its end.
FaultOutcome drive_on(RunSteps& steps, const FaultTrial& trial, double at) {
  ClosedLoop& loop = steps.loop();
  FaultOutcome outcome{.trial = trial, .at = at};
  loop.set_fault({trial.fault, at, trial.duration, trial.strength});
  if (trial.second) loop.set_fault({*trial.second, at, trial.duration, sim::kind_of(*trial.second).strength});
  const bool is_lasting = trial.duration >= kLasting;
  const double end = at + longest_trial(trial.duration);
  double standing_since = loop.time();
  while (loop.time() < end && !loop.is_over()) {
    const bool is_new = steps.advance();
    const double speed = loop.frame().has_truth ? hypot(loop.frame().truth.vx, loop.frame().truth.vy) : 0.0;
    if (speed > FaultOutcome::kStanding) standing_since = loop.time();
    if (loop.time() <= at) continue;
    outcome.least_edge = std::min(outcome.least_edge, loop.world().edge_distance);
    outcome.end_speed = speed;
    if (is_new && loop.frame().guard.rung != controller::Rung::kController) ++outcome.not_controller;
    if (is_lasting && loop.time() - standing_since > kStood && loop.time() > at + kTimeToGetGoing) break;
  }
  outcome.until = loop.time();
  return outcome;
}

}  // namespace

bool FlyingLap::is_off_within(double from, double to) const noexcept {
  return std::any_of(off.begin(), off.end(),
                     [&](const Excursion& each) { return each.from <= to && each.to >= from; });
}

Result<FlyingLap> drive_undisturbed(const scenario::Scenario& scenario, double wait, const Factories& make) {
  auto loop = ClosedLoop::create(endless(scenario), make);
  if (!loop) return fail(loop.error());
  FlyingLap lap;
  const RunHooks hooks;
  RunSteps steps(**loop, hooks);
  const auto advance = [&] {
    steps.advance();
    if ((*loop)->world().edge_distance >= 0.0) return;
    const double now = (*loop)->time();
    const double before = now - 2.0 * (*loop)->scenario().control_period;
    if (lap.off.empty() || lap.off.back().to < before) lap.off.push_back({now, now});
    lap.off.back().to = now;
  };
  // An open road has one lap, from standstill.
  const bool is_open = !(*loop)->track().centre().is_closed();
  const int laps = is_open ? 1 : 2;
  while ((*loop)->world().lap < laps && (*loop)->time() < kLongestLaps && !(*loop)->is_over()) {
    advance();
    if ((*loop)->world().lap == 0 && !is_open) lap.begins = (*loop)->time();
  }
  if ((*loop)->world().lap < laps) {
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("{} on {} with {}: {} not driven without any fault: {} in {:.0f} s", scenario.car,
                            scenario.track, scenario.preset, is_open ? "the road is" : "two laps are",
                            (*loop)->world().lap, (*loop)->time()));
  }
  lap.time = is_open ? (*loop)->time() : (*loop)->world().last_lap_time;
  while ((*loop)->time() < lap.begins + lap.time + wait && !(*loop)->is_over()) advance();
  return lap;
}

Result<std::vector<FaultOutcome>> drive_trials(const scenario::Scenario& scenario, const FlyingLap& lap,
                                               const std::vector<FaultTrial>& trials, int jobs,
                                               const std::function<bool(std::size_t)>& on_done,
                                               const Factories& make) {
  const auto loop = ClosedLoop::create(endless(scenario), make);
  if (!loop) return fail(loop.error());
  const RunHooks hooks;
  RunSteps steps(**loop, hooks);
  std::vector<std::size_t> order(trials.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return trials[a].onset < trials[b].onset; });
  std::vector<FaultOutcome> found;
  for (const FaultTrial& trial : trials) found.push_back({.trial = trial});

  std::mutex mutex;  // guards the run without faults, and all below
  std::size_t begun = 0;
  std::size_t done = 0;
  bool can_copy = true;
  for_each_run(trials.size(), jobs, [&](std::uint64_t, Roads&) {
    std::unique_lock lock(mutex);
    const std::size_t i = order[begun++];
    const double at = onset_of(lap, trials[i]);
    drive_up_to(steps, at);
    const std::unique_ptr<ClosedLoop> branch = (*loop)->copy();
    if (branch == nullptr) return can_copy = false;
    RunSteps branch_steps(*branch, steps);
    lock.unlock();
    const FaultOutcome outcome = drive_on(branch_steps, trials[i], at);
    lock.lock();
    found[i] = outcome;
    ++done;
    return !on_done || on_done(done);
  });
  if (!can_copy) return fail(ErrorCode::kInvalidArgument, "trials need a controller and a plant with copy()");
  return found;
}

}  // namespace chicane::run
