// SPDX-License-Identifier: MIT
#include "chicane/sim/actuation_delay.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "chicane/base/random.hpp"

namespace chicane::sim {

void ActuationDelay::reset(const model::Command& acting) noexcept {
  first_ = 0;
  count_ = 0;
  acting_ = acting;
}

void ActuationDelay::push(double time, const model::Command& command) noexcept {
  time = std::max(time, last_time());
  if (count_ == kCapacity) {
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }
  waiting_[static_cast<std::size_t>((first_ + count_) % kCapacity)] = {time, command};
  ++count_;
}

double ActuationDelay::last_time() const noexcept {
  if (count_ == 0) return -std::numeric_limits<double>::infinity();
  return waiting_[static_cast<std::size_t>((first_ + count_ - 1) % kCapacity)].time;
}

const model::Command& ActuationDelay::at(double time) noexcept {
  // A command due within a nanosecond is due: sums of step lengths round.
  constexpr double kRounding = 1e-9;
  while (count_ > 0 && waiting_[static_cast<std::size_t>(first_)].time <= time + kRounding) {
    acting_ = waiting_[static_cast<std::size_t>(first_)].command;
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }
  return acting_;
}

double random_delay(std::uint64_t seed, double time, double most) noexcept {
  if (!(most > 0.0)) return 0.0;
  Random seeded(seed);
  return Random(seeded.bits() ^ std::bit_cast<std::uint64_t>(time)).uniform(0.0, most);
}

}  // namespace chicane::sim
