// SPDX-License-Identifier: MIT
#include "closed_loop/attack.hpp"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <deque>
#include <memory>
#include <new>
#include <utility>

#include "chicane/protocol/library.hpp"

namespace chicane::attack {
namespace {

using controller::GuardReason;

/// Reasons that name a sensor or an actuator, not an answer of the controller.
bool names_a_part(GuardReason reason) {
  switch (reason) {
    case GuardReason::kNotMeasured:
    case GuardReason::kFrozen:
    case GuardReason::kSpeedMismatch:
    case GuardReason::kHeadingJump:
    case GuardReason::kPositionJump:
    case GuardReason::kLate:
    case GuardReason::kOtherSteering:
    case GuardReason::kWeakBrakes:
      return true;
    default:
      return false;
  }
}

void note_guard(const telemetry::Frame& frame, double since, Outcome& outcome) {
  const safety::GuardReport& report = frame.guard;
  if (report.rung != controller::Rung::kController && std::isnan(outcome.acted_after))
    outcome.acted_after = since;
  if (names_a_part(report.reason) && std::isnan(outcome.doubted_after)) {
    outcome.doubted_after = since;
    outcome.doubt = report.reason;
  }
}

void wait_for(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
}

/// One outcome that a process writes and its parent reads.
class SharedOutcome {
 public:
  SharedOutcome()
      : memory_{mmap(nullptr, sizeof(Outcome), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)} {
    if (memory_ != MAP_FAILED) new (memory_) Outcome{};
  }
  ~SharedOutcome() {
    if (memory_ != MAP_FAILED) munmap(memory_, sizeof(Outcome));
  }
  SharedOutcome(const SharedOutcome&) = delete;
  SharedOutcome& operator=(const SharedOutcome&) = delete;
  void set(const Outcome& outcome) {
    if (memory_ != MAP_FAILED) *static_cast<Outcome*>(memory_) = outcome;
  }
  [[nodiscard]] Outcome get() const {
    return memory_ == MAP_FAILED ? Outcome{} : *static_cast<const Outcome*>(memory_);
  }

 private:
  void* memory_;
};

}  // namespace

Result<scenario::Scenario> scenario_of(const Place& place) {
  std::vector<std::pair<std::string, std::string>> settings{
      {"preset", place.preset}, {"track", place.track}, {"car", place.car}};
  settings.insert(settings.end(), place.settings.begin(), place.settings.end());
  settings.emplace_back("laps", "0");
  return protocol::compose({.scenario_file = {}, .settings = settings});
}

Outcome watch(run::ClosedLoop& loop, double until, const OnFrame& on_frame) {
  Outcome outcome{.is_there = true};
  const double began = loop.time();
  const double driving = Outcome::kDriving * std::sqrt(loop.scenario().vehicle.scale);
  while (loop.time() < until && !loop.is_over()) {
    const bool is_new = loop.advance();
    const double since = loop.time() - began;
    const double speed = std::hypot(loop.car().vx, loop.car().vy);
    if (loop.world().edge_distance < outcome.least_edge) {
      outcome.least_edge = loop.world().edge_distance;
      outcome.least_at = loop.time();
    }
    outcome.fastest = std::max(outcome.fastest, speed);
    outcome.end_speed = speed;
    if (speed > driving && std::isnan(outcome.driving_after)) outcome.driving_after = since;
    if (!is_new) continue;
    note_guard(loop.frame(), since, outcome);
    if (on_frame) on_frame(loop.frame());
  }
  return outcome;
}

Result<Outcome> drive_adversary(const scenario::Scenario& scenario, run::Roads& roads,
                                const AdversaryKind& kind, std::uint64_t seed, double seconds,
                                const OnFrame& on_frame) {
  const run::ControllerFactory make =
      [&](const scenario::Scenario& of) -> Result<std::unique_ptr<controller::Controller>> {
    auto nominal = run::make_controller(of);
    if (!nominal) return fail(nominal.error());
    return make_adversary(kind, seed, std::move(*nominal), run::full_size(of));
  };
  const auto loop = run::ClosedLoop::create(scenario, roads, make);
  if (!loop) return fail(loop.error());
  return watch(**loop, seconds, on_frame);
}

Outcome drive_signal(run::ClosedLoop& loop, const SignalTrial& trial, std::shared_ptr<SignalMemory> memory,
                     const OnFrame& on_frame) {
  make_false(loop, trial.signal, std::move(memory), trial.duration);
  const bool is_lasting = trial.duration >= kLasting;
  return watch(loop, loop.time() + (is_lasting ? kLongest : trial.duration + kAfterwards), on_frame);
}

void drive_in_processes(std::size_t count, int jobs, const std::function<void(std::size_t)>& prepare,
                        const std::function<Outcome(std::size_t)>& work,
                        const std::function<void(std::size_t, const Outcome&)>& on_done) {
  struct Running {
    std::size_t trial;
    pid_t process;
    std::unique_ptr<SharedOutcome> outcome;
  };
  std::deque<Running> running;
  const auto finish_oldest = [&] {
    wait_for(running.front().process);
    on_done(running.front().trial, running.front().outcome->get());
    running.pop_front();
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (static_cast<int>(running.size()) >= std::max(jobs, 1)) finish_oldest();
    if (prepare) prepare(i);
    Running next{i, 0, std::make_unique<SharedOutcome>()};
    next.process = fork();
    if (next.process == 0) {
      next.outcome->set(work(i));
      _exit(0);  // nothing of the parent's is flushed or torn down
    }
    if (next.process > 0)
      running.push_back(std::move(next));
    else
      on_done(i, Outcome{});
  }
  while (!running.empty()) finish_oldest();
}

}  // namespace chicane::attack
