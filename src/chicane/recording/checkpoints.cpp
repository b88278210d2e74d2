// SPDX-License-Identifier: MIT
#include "chicane/recording/checkpoints.hpp"

#include <variant>

namespace chicane::recording {

std::shared_ptr<const Checkpoint> newest_before(const CheckpointList& list, double time,
                                                std::uint64_t first_event) {
  constexpr double kRounding = 1e-9;
  for (auto each = list.rbegin(); each != list.rend(); ++each) {
    if ((*each)->time < time - kRounding && (*each)->event_count >= first_event) return *each;
  }
  return nullptr;
}

Result<void> Checkpoints::follow(const RecordedEvent& event) {
  return std::visit([this](const auto& one) { return take(one); }, event);
}

void Checkpoints::clear() {
  kept_.clear();
  run_.forget();
  event_count_ = 0;
  first_difference_.reset();
}

Result<void> Checkpoints::take(const scenario::Scenario& scenario) {
  clear();
  return run_.begin(scenario, make_);
}

Result<void> Checkpoints::take(const telemetry::Change& change) {
  ++event_count_;
  if (!run_.has_begun()) return {};
  if (const Result<run::Setting> setting = run::read_setting(change)) run_.apply(*setting);
  return {};
}

Result<void> Checkpoints::take(const RecordedStep& recorded) {
  ++event_count_;
  if (!run_.has_begun()) return {};
  const telemetry::Frame& frame = run_.follow(recorded.step);
  if (!first_difference_ && !is_same(frame, recorded.step)) first_difference_ = recorded.step.cycle;
  if (!kept_.empty() && recorded.log_time - kept_.back()->time < kSpacing) return {};
  std::shared_ptr<const run::ClosedLoop> loop = run_.loop().copy();
  if (loop == nullptr) {
    run_.forget();
    return fail(ErrorCode::kInvalidArgument, "this controller cannot be copied");
  }
  kept_.push_back(std::make_shared<const Checkpoint>(Checkpoint{.loop = std::move(loop),
                                                                .time = recorded.log_time,
                                                                .next_cycle = recorded.step.cycle + 1,
                                                                .event_count = event_count_,
                                                                .first_difference = first_difference_}));
  thin(recorded.log_time);
  return {};
}

/// Leaves out each one whose neighbours are close enough to each other for how long ago they are.
void Checkpoints::thin(double now) {
  for (std::size_t i = 1; i + 1 < kept_.size();) {
    const double gap = kept_[i + 1]->time - kept_[i - 1]->time;
    if (gap <= now - kept_[i + 1]->time) {
      kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
}

}  // namespace chicane::recording
