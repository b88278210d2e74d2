// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/minimum_time.hpp"
#include "chicane/path/track.hpp"
#include "chicane/scenario/scenario.hpp"

namespace chicane::runtime {

/// The car of an experiment as its plant is: what is believed, with the plant's deviations in grip and mass.
[[nodiscard]] model::VehicleParams limit_vehicle(const scenario::Scenario& scenario);

/// Finds the limit of a run in a thread of its own, with the lowest priority: control never waits for it. The
/// destructor ends a search that still goes on, within the time of one round (some 10 ms).
class LimitSearch {
 public:
  /// Begins. `on_end` is called once, on the other thread, unless the search is ended before.
  LimitSearch(path::Track track, const scenario::Scenario& scenario,
              std::function<void(Result<std::shared_ptr<const lap_time::Limit>>)> on_end);
  ~LimitSearch();
  LimitSearch(const LimitSearch&) = delete;
  LimitSearch& operator=(const LimitSearch&) = delete;

 private:
  std::atomic<bool> is_wanted_{true};
  std::thread thread_;
};

}  // namespace chicane::runtime
