// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "chicane/recording/reader.hpp"
#include "chicane/recording/rebuilt_run.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/make.hpp"

namespace chicane::recording {

/// A run of ours as it was at a moment, to go on from; it is not changed any more.
struct Checkpoint {
  std::shared_ptr<const run::ClosedLoop> loop;
  double time = 0.0;              ///< of the last control step in it, on the time line of the events [s]
  std::uint64_t next_cycle = 0;   ///< number of the next control step
  std::uint64_t event_count = 0;  ///< of the events, from the beginning of the run: what comes next
  std::optional<std::uint64_t> first_difference{};  ///< BranchReport::first_difference, up to here
};

/// By rising time.
using CheckpointList = std::vector<std::shared_ptr<const Checkpoint>>;
/// The newest one before `time` [s], whose next event is `first_event` or a later one; null: none.
[[nodiscard]] std::shared_ptr<const Checkpoint> newest_before(const CheckpointList& list, double time,
                                                              std::uint64_t first_event = 0);

/// Follows a run that goes on by computing it once more, event by event, and keeps checkpoints of it: close
/// together for the last moments, farther apart the longer ago, so that no moment is farther behind one than
/// it is ago, or kSpacing. A run of T seconds needs some 2 log2(T / kSpacing) of them, of some 8 MB each. One
/// thread.
class Checkpoints {
 public:
  static constexpr double kSpacing = 10.0;  ///< of the newest ones [s]

  /// The next event. A scenario begins another run. Fails as RebuiltRun::begin() does, and where the run
  /// cannot be copied: nothing is kept of it then.
  [[nodiscard]] Result<void> follow(const RecordedEvent& event);
  /// Forgets all.
  void clear();
  [[nodiscard]] const CheckpointList& kept() const noexcept { return kept_; }

 private:
  Result<void> take(const scenario::Scenario& scenario);
  Result<void> take(const telemetry::Change& change);
  Result<void> take(const RecordedStep& recorded);
  void thin(double now);

  run::Factories make_;
  RebuiltRun run_;
  std::uint64_t event_count_ = 0;
  std::optional<std::uint64_t> first_difference_;
  CheckpointList kept_;
};

}  // namespace chicane::recording
