// SPDX-License-Identifier: MIT
#include "chicane/wire/command_receiver.hpp"

#include <algorithm>
#include <utility>

namespace chicane::wire {
namespace {

constexpr double kPatienceInCycles = 3.0;

}  // namespace

bool CommandReceiver::sampled(double time) noexcept {
  const double asked = std::exchange(sampled_, time);
  if (!waiting_) return true;
  add_cycle(time - asked);
  const bool is_late = is_timed_out_ && timed_out_since_ >= asked;
  if (!is_late) {
    received_ = waiting_->command;
    for (int i = 0; i < waiting_->stop.size; ++i)
      waiting_->stop.points[static_cast<std::size_t>(i)].time += asked;
    player_.arrived(time, waiting_->stop);
    picked_up_ = time;
    has_any_ = true;
    is_timed_out_ = false;
  }
  waiting_.reset();
  return !is_late;
}

void CommandReceiver::answered(const protocol::UdacitySteer& steer) noexcept { waiting_ = steer; }

void CommandReceiver::disconnected() noexcept { waiting_.reset(); }

model::Command CommandReceiver::act(double time, double speed) noexcept {
  if (!has_any_) return acting_;
  acting_ = player_.guard(received_, time, speed);
  if (!is_timed_out_ && player_.is_stopping() && time - picked_up_ > patience_) {
    is_timed_out_ = true;
    timed_out_since_ = time;
  }
  return acting_;
}

/// A controller's habit tells when it has fallen silent.
void CommandReceiver::add_cycle(double length) noexcept {
  cycles_[static_cast<std::size_t>(cycle_count_++) % cycles_.size()] = length;
  std::array<double, 9> sorted = cycles_;
  const auto size = std::min(static_cast<std::size_t>(cycle_count_), sorted.size());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(size / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(size));
  patience_ = std::max(kPatienceInCycles * *middle, safety::StopPlayer::kPatience);
  player_.set_patience(patience_);
}

}  // namespace chicane::wire
