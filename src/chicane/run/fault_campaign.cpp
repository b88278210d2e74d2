// SPDX-License-Identifier: MIT
// Trials of faults in a flying lap: the lap is driven once, and each trial branches off in a process of its
// own.
#include "chicane/run/fault_campaign.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <deque>
#include <numeric>

#include "chicane/base/math.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/run_steps.hpp"

namespace chicane::run {
namespace {

constexpr double kStood = 1.0;         // [s] at standstill after which a car has come to rest
constexpr double kTimeToGetGoing = 5;  // [s] for a car that the fault has stopped
constexpr double kRounding = 1e-9;     // [s] sums of step lengths round
constexpr double kLongestLaps = 1800;  // [s] for the two laps without a fault; longer ones are not waited for

/// Time at which a trial's faults begin, in whole milliseconds of the run: short in `--fault NAME@at`.
double onset_of(const FlyingLap& lap, const FaultTrial& trial) {
  return std::round(1e3 * (lap.begins + trial.onset)) / 1e3;
}

/// Drives until the next step is the first with a fault in it.
void drive_up_to(RunSteps& steps, double at) {
  while (steps.loop().time() < at - kRounding && !steps.loop().is_over()) steps.advance();
}

/// Drives from the faults to the trial's end.
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

/// Memory that processes share with those that fork from them; all zero at first.
class SharedOutcomes {
 public:
  struct Slot {
    bool is_there;
    FaultOutcome outcome;
  };
  explicit SharedOutcomes(std::size_t count)
      : bytes_{std::max<std::size_t>(count, 1) * sizeof(Slot)},
        memory_{mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)} {}
  ~SharedOutcomes() {
    if (is_there()) munmap(memory_, bytes_);
  }
  SharedOutcomes(const SharedOutcomes&) = delete;
  SharedOutcomes& operator=(const SharedOutcomes&) = delete;

  [[nodiscard]] bool is_there() const noexcept { return memory_ != MAP_FAILED; }
  [[nodiscard]] Slot& operator[](std::size_t i) const noexcept { return static_cast<Slot*>(memory_)[i]; }

 private:
  std::size_t bytes_;
  void* memory_;
};

/// Ends this process with its parent: open files and their locks are released.
void end_with_parent() noexcept {
#ifdef __linux__
  static_cast<void>(prctl(PR_SET_PDEATHSIG, SIGKILL));
#endif
}

/// Waits for the end of a process of ours.
void wait_for(pid_t process) noexcept {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
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
  const SharedOutcomes found(trials.size());
  if (!found.is_there()) return fail(ErrorCode::kIo, "no memory for the outcomes of the trials");
  std::vector<std::size_t> order(trials.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return trials[a].onset < trials[b].onset; });

  struct Running {
    pid_t process;
    std::size_t trial;
  };
  std::deque<Running> running;
  std::string trouble;
  std::size_t done = 0;
  bool goes_on = true;
  const auto finish_oldest = [&] {
    const Running oldest = running.front();
    running.pop_front();
    wait_for(oldest.process);
    if (!found[oldest.trial].is_there && trouble.empty())
      trouble = fmt::format("the trial at {} s broke off", lap.begins + trials[oldest.trial].onset);
    if (on_done && !on_done(++done)) goes_on = false;
  };
  for (const std::size_t i : order) {
    if (static_cast<int>(running.size()) >= std::max(jobs, 1)) finish_oldest();
    if (!goes_on || !trouble.empty()) break;
    const double at = onset_of(lap, trials[i]);
    drive_up_to(steps, at);
    const pid_t process = fork();
    if (process < 0) {
      trouble = "no process for a trial";
      break;
    }
    if (process == 0) {
      end_with_parent();
      found[i].outcome = drive_on(steps, trials[i], at);
      found[i].is_there = true;
      _exit(0);  // nothing of the parent's is flushed or torn down
    }
    running.push_back({process, i});
  }
  while (!running.empty()) finish_oldest();
  if (!trouble.empty()) return fail(ErrorCode::kIo, trouble);
  std::vector<FaultOutcome> all;
  all.reserve(trials.size());
  for (std::size_t i = 0; i < trials.size(); ++i)
    all.push_back(found[i].is_there ? found[i].outcome : FaultOutcome{.trial = trials[i]});
  return all;
}

}  // namespace chicane::run
