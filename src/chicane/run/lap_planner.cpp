// SPDX-License-Identifier: MIT
#include "chicane/run/lap_planner.hpp"

#include <sys/resource.h>

#include <utility>

#include "chicane/run/racing.hpp"

namespace chicane::run {

LapPlanner::~LapPlanner() {
  is_wanted_ = false;
  if (thread_.joinable()) thread_.join();
}

std::shared_ptr<const road::RacingRoad> LapPlanner::follow(const controller::Controller& controller,
                                                           const scenario::Scenario& scenario, double time) {
  const std::span<const Vec2> waypoints = controller.wants_lap_of();
  is_wanted_ = !waypoints.empty();
  const bool is_searching = thread_.joinable();
  if (is_searching && has_ended_.load(std::memory_order_acquire)) thread_.join();
  if (waypoints.empty()) {
    wanted_since_.reset();
    return {};
  }
  if (!wanted_since_ || time < *wanted_since_) {
    if (thread_.joinable()) return {};  // one that nobody waits for any more
    wanted_since_ = time;
    has_answered_ = false;
    has_ended_ = false;
    lap_.reset();
    if (clock_ == Clock::kReal)
      thread_ = std::thread([this, points = std::vector<Vec2>(waypoints.begin(), waypoints.end()),
                             scenario]() mutable { search(std::move(points), scenario); });
    return {};
  }
  if (has_answered_) return {};
  if (clock_ == Clock::kVirtual) {
    if (time - *wanted_since_ < kPlanningTime) return {};
    search({waypoints.begin(), waypoints.end()}, scenario);
  }
  if (!has_ended_.load(std::memory_order_acquire)) return {};
  has_answered_ = true;
  return std::exchange(lap_, nullptr);
}

void LapPlanner::search(std::vector<Vec2> waypoints, const scenario::Scenario& scenario) {
  if (clock_ == Clock::kReal) {
    // Behind everything else, yet not starved: on cores that others keep busy, a tenth of one thread's share.
    constexpr int kLowPriority = 10;
    static_cast<void>(setpriority(PRIO_PROCESS, 0, kLowPriority));  // of this thread, on Linux
  }
  auto lap = plan_learned_lap(scenario, waypoints, [this] { return is_wanted_.load(); });
  if (lap) lap_ = std::move(*lap);
  has_ended_.store(true, std::memory_order_release);
}

}  // namespace chicane::run
