// SPDX-License-Identifier: MIT
// Memory of a run for late viewers: frames, laps and changes in bounded memory.
#include "chicane/wire/run_memory.hpp"

namespace chicane::wire {
namespace {

constexpr double kRounding = 1e-6;  // [s] rounding of times that are sums of periods

/// Count of the messages with a lower number, by bisection.
template <class Messages>
std::size_t count_before(const Messages& messages, std::uint64_t number) {
  const auto found =
      std::lower_bound(messages.begin(), messages.end(), number,
                       [](const KeptMessage& each, std::uint64_t wanted) { return each.number < wanted; });
  return static_cast<std::size_t>(found - messages.begin());
}

/// Oldest message with this number or a higher one; null: none.
template <class Messages>
const KeptMessage* first_from(const Messages& messages, std::uint64_t number) {
  const std::size_t older = count_before(messages, number);
  return older < messages.size() ? &messages[older] : nullptr;
}

}  // namespace

void RunMemory::forget() {
  sparse_.clear();
  dense_.clear();
  laps_.clear();
  changes_.clear();
}

void RunMemory::add_frame(double time, std::string payload) {
  dense_.push_back({next_++, time, std::move(payload)});
  // A frame that leaves the dense part is kept if it is kSpacing after the last one kept.
  while (dense_.size() > kMostDense || dense_.front().time < time - kDense) {
    if (sparse_.empty() || dense_.front().time >= sparse_.back().time + kSpacing - kRounding)
      sparse_.push_back(std::move(dense_.front()));
    dense_.pop_front();
  }
  while (sparse_.size() > kMostSparse) sparse_.pop_front();
}

void RunMemory::add_lap(const telemetry::CompletedLap& lap, double time, std::string payload) {
  if (laps_.size() >= kMostLaps) drop_lap();
  KeptLap kept;
  kept.number = next_++;
  kept.time = time;
  kept.payload = std::move(payload);
  kept.lap_time = lap.lap_time;
  kept.is_clean = lap.is_clean;
  laps_.push_back(std::move(kept));
}

void RunMemory::drop_lap() {
  const auto best = std::min_element(laps_.begin(), laps_.end(), [](const KeptLap& a, const KeptLap& b) {
    return a.is_clean != b.is_clean ? a.is_clean : a.lap_time < b.lap_time;
  });
  laps_.erase(best == laps_.begin() ? best + 1 : laps_.begin());
}

void RunMemory::add_change(double time, std::string payload) {
  if (changes_.size() >= kMostChanges) changes_.pop_front();
  changes_.push_back({next_++, time, std::move(payload)});
}

const KeptMessage* RunMemory::frame_before(std::uint64_t number) const {
  const std::size_t dense_count = count_before(dense_, number);
  if (dense_count > 0) return &dense_[dense_count - 1];
  const std::size_t sparse_count = count_before(sparse_, number);
  return sparse_count > 0 ? &sparse_[sparse_count - 1] : nullptr;
}

std::size_t RunMemory::frames_before(std::uint64_t number) const {
  return count_before(sparse_, number) + count_before(dense_, number);
}

const KeptMessage* RunMemory::lap_from(std::uint64_t number) const { return first_from(laps_, number); }

const KeptMessage* RunMemory::change_from(std::uint64_t number) const { return first_from(changes_, number); }

}  // namespace chicane::wire
