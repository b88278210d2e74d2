// SPDX-License-Identifier: MIT
// Faults of a run: switches and schedules them, and applies them to the signals between car and controller.
#include "chicane/sim/fault.hpp"

#include <algorithm>

namespace chicane::sim {
namespace {

/// Letters of a stream's name as one number, so that different names give different streams.
std::uint64_t stream_number(std::string_view name) noexcept {
  std::uint64_t number = 0;
  for (const char letter : name) number = number << 8U | static_cast<unsigned char>(letter);
  return number;
}

}  // namespace

std::optional<Fault> fault_named(std::string_view name) noexcept {
  for (std::size_t i = 0; i < fault_kinds().size(); ++i) {
    if (fault_kinds()[i].name == name) return static_cast<Fault>(i);
  }
  return std::nullopt;
}

FaultEvent default_event(Fault fault, double at) noexcept {
  const FaultKind& kind = kind_of(fault);
  return {fault, at, kind.duration, kind.strength};
}

FaultLab::FaultLab(std::span<const FaultEvent> events, std::uint64_t seed)
    : event_count_{std::min(events.size(), kCapacity)}, seed_{seed}, active_(fault_kinds().size()) {
  std::copy_n(events.begin(), event_count_, events_.begin());
  reset();
}

void FaultLab::reset() noexcept {
  has_begun_ = {};
  bits_ = 0;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    active_[i] = {};
    active_[i].memory.random = Random{seed_ ^ stream_number(fault_kinds()[i].stream)};
  }
}

template <class Lab, class Act>
void FaultLab::for_each_on(Lab& lab, Act act) noexcept {
  for (std::size_t i = 0; lab.bits_ != 0 && i < lab.active_.size(); ++i) {
    if (lab.is_on(static_cast<Fault>(i))) act(fault_kinds()[i], lab.active_[i].memory);
  }
}

template <class Act>
void FaultLab::for_each_on_by_place(Act act) noexcept {
  for (const FaultPlace place : {FaultPlace::kSource, FaultPlace::kValue, FaultPlace::kLink}) {
    for_each_on(*this, [&](const FaultKind& kind, FaultMemory& memory) {
      if (kind.place == place) act(kind, memory);
    });
  }
}

void FaultLab::update(double time) noexcept {
  constexpr double kRounding = 1e-9;  // [s] rounding of sums of step lengths
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const auto fault = static_cast<Fault>(i);
    if (is_on(fault) && time >= active_[i].until - kRounding) end(fault);
  }
  for (std::size_t i = 0; i < event_count_; ++i) {
    const FaultEvent& event = events_[i];
    if (has_begun_[i] || time < event.at - kRounding) continue;
    has_begun_[i] = true;
    begin(event.fault, event.at + event.duration, event.strength);
  }
}

void FaultLab::set(Fault fault, bool on, double time) noexcept {
  if (on == is_on(fault)) return;
  if (!on) return end(fault);
  const FaultKind& kind = kind_of(fault);
  begin(fault, time + kind.duration, kind.strength);
}

void FaultLab::set(const FaultEvent& event) noexcept {
  const FaultKind& kind = kind_of(event.fault);
  begin(event.fault, event.at + event.duration, std::clamp(event.strength, kind.weakest, kind.strongest));
}

void FaultLab::begin(Fault fault, double until, double strength) noexcept {
  Active& active = active_[static_cast<std::size_t>(fault)];
  active.until = until;
  active.memory.strength = strength;
  bits_ |= bit(fault);
}

void FaultLab::end(Fault fault) noexcept {
  FaultMemory& memory = active_[static_cast<std::size_t>(fault)].memory;
  memory.measurement.reset();
  memory.value.reset();
  bits_ &= ~bit(fault);
}

model::Measurement FaultLab::seen(const model::Measurement& now) noexcept {
  model::Measurement measured = now;
  for_each_on_by_place([&](const FaultKind& kind, FaultMemory& memory) {
    if (kind.measure != nullptr) kind.measure(memory, now, measured);
  });
  return measured;
}

bool FaultLab::is_delivered() noexcept {
  bool is_lost = false;
  for_each_on(*this, [&](const FaultKind& kind, FaultMemory& memory) {
    is_lost = is_lost || (kind.loses_command != nullptr && kind.loses_command(memory));
  });
  return !is_lost;
}

model::Command FaultLab::done(const model::Command& command) noexcept {
  model::Command result = command;
  for_each_on_by_place([&](const FaultKind& kind, FaultMemory& memory) {
    if (kind.actuate != nullptr) kind.actuate(memory, command, result);
  });
  return result;
}

double FaultLab::extra_delay(double latency) const noexcept {
  double delay = 0.0;
  for_each_on(*this, [&](const FaultKind& kind, const FaultMemory& memory) {
    if (kind.extra_delay != nullptr) delay += kind.extra_delay(memory.strength, latency);
  });
  return delay;
}

double FaultLab::grip() const noexcept {
  double grip = 1.0;
  for_each_on(*this, [&](const FaultKind& kind, const FaultMemory& memory) {
    if (kind.grip != nullptr) grip *= kind.grip(memory.strength);
  });
  return grip;
}

double FaultLab::side_acceleration() const noexcept {
  double push = 0.0;
  for_each_on(*this, [&](const FaultKind& kind, const FaultMemory& memory) {
    if (kind.side_acceleration != nullptr) push += kind.side_acceleration(memory.strength);
  });
  return push;
}

std::uint32_t FaultLab::deadline_questions() const noexcept {
  std::uint32_t least = 0;
  for_each_on(*this, [&](const FaultKind& kind, const FaultMemory& memory) {
    if (kind.deadline_questions == nullptr) return;
    const std::uint32_t questions = kind.deadline_questions(memory.strength);
    least = least == 0 ? questions : std::min(least, questions);
  });
  return least;
}

}  // namespace chicane::sim
