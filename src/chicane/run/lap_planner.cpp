// SPDX-License-Identifier: MIT
#include "chicane/run/lap_planner.hpp"

#include <sys/resource.h>

#include <utility>

#include "chicane/base/text.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/control_cycle.hpp"
#include "chicane/run/racing.hpp"

namespace chicane::run {

LapPlanner::~LapPlanner() {
  is_wanted_ = false;
  if (thread_.joinable()) thread_.join();
}

telemetry::Change LapPlanner::lap_change(const road::RacingRoad& lap, std::uint64_t cycle, double time) {
  std::string value = number_text(lap.grip());
  if (lap.slides()) value += kSlides;
  return {.cycle = cycle, .time = time, .name = kChange, .value = value};
}

std::shared_ptr<const road::RacingRoad> LapPlanner::follow(const controller::Controller& controller,
                                                           const scenario::Scenario& scenario,
                                                           const road::Track* track, double time) {
  const controller::LapRequest request = controller.wants_lap();
  is_wanted_ = request.is_wanted;
  if (thread_.joinable() && has_ended_.load(std::memory_order_acquire)) thread_.join();
  if (!request.is_wanted) {
    wanted_since_.reset();
    return {};
  }
  if (!wanted_since_ || time < *wanted_since_) {
    if (thread_.joinable()) return {};  // one that nobody waits for any more
    wanted_since_ = time;
    ready_since_.reset();
    has_answered_ = false;
    has_ended_ = false;
    lap_.reset();
    if (clock_ == Clock::kReal)
      thread_ = std::thread([this, scenario, track,
                             points = std::vector(request.waypoints.begin(), request.waypoints.end()),
                             wanted = controller::LapRequest(request)]() mutable {
        wanted.waypoints = points;
        search(scenario, track, wanted);
      });
    return {};
  }
  if (has_answered_) return {};
  if (clock_ == Clock::kVirtual && !ready_since_) {
    if (time - *wanted_since_ < kPlanningTime) return {};
    search(scenario, track, request);
  }
  if (!has_ended_.load(std::memory_order_acquire)) return {};
  if (!ready_since_) ready_since_ = time;
  const double near = kJoining + kJoiningGrows * (time - *ready_since_);
  if (lap_ && controller.beside(*lap_) > near) return {};
  has_answered_ = true;
  return std::exchange(lap_, nullptr);
}

std::optional<telemetry::Change> LapPlanner::advance(ClosedLoop& loop) {
  const auto lap = follow(loop.controller(), loop.scenario(), &loop.track(), loop.time());
  if (!lap) return {};
  loop.use_line(lap);
  return lap_change(*lap, loop.cycle(), loop.time());
}

std::optional<telemetry::Change> LapPlanner::advance(ControlCycle& cycle, const scenario::Scenario& scenario,
                                                     const road::Track* track, double time) {
  const auto lap = follow(cycle.controller(), scenario, track, time);
  if (!lap) return {};
  cycle.use_line(lap);
  return lap_change(*lap, cycle.next(), time);
}

void LapPlanner::search(const scenario::Scenario& scenario, const road::Track* track,
                        const controller::LapRequest& request) {
  if (clock_ == Clock::kReal) {
    // Behind everything else, yet not starved: on cores that others keep busy, a tenth of one thread's share.
    constexpr int kLowPriority = 10;
    static_cast<void>(setpriority(PRIO_PROCESS, 0, kLowPriority));  // of this thread, on Linux
  }
  auto lap = plan_wanted_lap(scenario, track, request, [this] { return is_wanted_.load(); });
  if (lap) lap_ = std::move(*lap);
  has_ended_.store(true, std::memory_order_release);
}

}  // namespace chicane::run
