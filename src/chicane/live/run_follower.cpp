// SPDX-License-Identifier: MIT
#include "chicane/live/run_follower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace chicane::live {

RunFollower::RunFollower(Journal& journal) : journal_{journal}, worker_{[this] { work(); }, kFollowEvery} {}

void RunFollower::work() {
  follow();
  const std::lock_guard lock(mutex_);
  kept_ = following_.kept();
  run_ = place_.run;
}

/// The events since the last time. A run that cannot be followed, or not any more, has no new checkpoints.
void RunFollower::follow() {
  const Result<Journal::Excerpt> news = journal_.history(place_);
  if (!news) return;
  if (news->begin != place_) following_.clear();
  const Result<void> followed = news->events(
      [this](const recording::RecordedEvent& event) -> Result<void> { return following_.follow(event); });
  static_cast<void>(followed);
  place_ = news->end;
}

Result<recording::BranchReport> RunFollower::branch(const recording::BranchOptions& options,
                                                    const recording::BranchHooks& hooks) {
  recording::BranchOptions from_there = options;
  Journal::Place place;
  const Journal::Place oldest = journal_.oldest();
  {
    const std::lock_guard lock(mutex_);
    if (run_ == oldest.run) from_there.from = recording::newest_before(kept_, options.at, oldest.event);
    if (from_there.from) place = {.run = run_, .event = from_there.from->event_count};
    const auto known = std::find_if(kept_.begin(), kept_.end(), [&](const auto& each) {
      return run_ == oldest.run && each->event_count >= oldest.event;
    });
    if (!from_there.from && oldest.event > 0 && known != kept_.end()) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("the run is not known so far back any more: ask for a moment after {:.0f} s",
                              std::ceil((*known)->time)));
    }
  }
  const Result<Journal::Excerpt> events = journal_.history(place);
  if (!events) return fail(events.error());
  if (events->begin.event == 0) from_there.from.reset();  // another run has begun meanwhile
  return recording::branch_run(events->events, from_there, hooks);
}

}  // namespace chicane::live
