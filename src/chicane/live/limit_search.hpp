// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/live/worker.hpp"
#include "chicane/road/track.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::live {

/// Finds the bound of a run's plant in a thread of its own, with low priority: control never waits for it.
/// From the cache where it is known (run/plan_cache.hpp).
class LimitSearch {
 public:
  /// Work after which the search gives up (lap_time::PlanProgress) [s]: more than any car in full size needs
  /// on a track that ships.
  static constexpr double kBudget = 60.0;
  using OnEnd = std::function<void(Result<std::shared_ptr<const lap_time::Limit>>)>;

  /// Begins. `on_end` is called once, on the other thread, unless the search was cancelled before.
  LimitSearch(road::Track track, const scenario::Scenario& scenario, OnEnd on_end);
  /// Cancels, and waits for the thread: for one iteration, 1 to 100 ms on an idle machine, but as long as
  /// others keep it from running on a busy one.
  ~LimitSearch();
  LimitSearch(const LimitSearch&) = delete;
  LimitSearch& operator=(const LimitSearch&) = delete;

  /// `on_end` is not called any more once this has returned. Waits for no more than a call under way.
  void cancel();
  /// The thread has nothing left to do: the destructor does not wait.
  [[nodiscard]] bool has_ended() const noexcept { return has_ended_.load(std::memory_order_acquire); }

 private:
  void work(const road::Track& track, const scenario::Scenario& scenario);

  OnEnd on_end_;
  std::mutex telling_;
  std::atomic<bool> is_wanted_{true};
  std::atomic<bool> has_ended_{false};
  Worker worker_;  // last
};

}  // namespace chicane::live
