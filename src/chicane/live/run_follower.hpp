// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>

#include "chicane/live/journal.hpp"
#include "chicane/live/worker.hpp"
#include "chicane/recording/branch.hpp"
#include "chicane/recording/checkpoints.hpp"

namespace chicane::live {

/// Computes the run that goes on once more, behind it, on a thread of its own with low priority, and keeps
/// checkpoints, so that another future need not be driven from the run's start (what_if.hpp). It costs what
/// the run's own control steps cost.
class RunFollower {
 public:
  static constexpr auto kFollowEvery = std::chrono::milliseconds(500);

  /// `journal` must outlive it.
  explicit RunFollower(Journal& journal);

  /// Any thread: branches the run, from a checkpoint where there is one before `options.at`. Fails as
  /// recording::branch_run() and Journal::history() do.
  [[nodiscard]] Result<recording::BranchReport> branch(const recording::BranchOptions& options,
                                                       const recording::BranchHooks& hooks);

 private:
  void work();
  void follow();

  Journal& journal_;
  recording::Checkpoints following_;  ///< this and the next are the follower's thread's
  Journal::Place place_;              ///< where it has come to

  std::mutex mutex_;  ///< of all below
  recording::CheckpointList kept_;
  std::uint64_t run_ = 0;  ///< in which they are, Journal::Place::run
  Worker worker_;          // last
};

}  // namespace chicane::live
