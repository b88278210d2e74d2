// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/random.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/model/state.hpp"

/// Faults that a simulated run can have: kinds, scheduled events, and their effects on the signals between
/// car and controller.

namespace chicane::sim {

/// Index of a fault in fault_kinds(), and the number of its bit in FaultLab::bits(). Recordings keep these
/// bits: the index of a fault never changes.
enum class Fault : std::uint8_t {};
inline constexpr std::size_t kMostFaults = 32;  ///< limit of the list: one bit each

/// State of a fault that is on.
struct FaultMemory {
  double strength = 1.0;  ///< strength in the kind's range
  Random random{0};       ///< a stream of its own, not restarted when the fault begins
  std::optional<model::Measurement> measurement{};  ///< measurement that an effect keeps; empty at first
  std::optional<double> value{};                    ///< number that an effect keeps; empty at first
};

/// Place in a signal's path that a fault changes. Faults are applied in this order, those of one place in the
/// order of the list.
enum class FaultPlace : std::uint8_t {
  kSource,  ///< the sensor or actuator itself: frozen, noisy, stuck
  kValue,   ///< the value: offset, scaled, wrong
  kLink,    ///< the transmission: lost, incomplete
};

/// Name, meaning, parameters and effects of a fault. The functions are called while the fault is on; null
/// means no effect of that kind. They do not allocate, and take random numbers from their memory only.
struct FaultKind {
  std::string_view name;                ///< "half_grip"
  std::string_view meaning;             ///< one sentence
  double duration = 1.0;                ///< default duration [s]
  double strength = 1.0;                ///< default strength
  double weakest = 1.0;                 ///< lower limit of the strength
  double strongest = 1.0;               ///< upper limit of the strength
  std::string_view strength_meaning{};  ///< meaning with its unit; empty for a fault without a strength
  std::string_view stream{};            ///< seed of its random numbers: at most eight letters
  FaultPlace place = FaultPlace::kValue;

  /// Changes the measurement that the controller gets, `measured`; `now` is the true one.
  void (*measure)(FaultMemory&, const model::Measurement& now,
                  model::Measurement& measured) noexcept = nullptr;
  /// Whether a command gets lost on its way.
  bool (*loses_command)(FaultMemory&) noexcept = nullptr;
  /// Changes the command that actuators execute, `done`; `asked` is the command that arrived.
  void (*actuate)(FaultMemory&, const model::Command& asked, model::Command& done) noexcept = nullptr;
  /// Delay of commands beyond the `latency` that the controller assumes [s].
  double (*extra_delay)(double strength, double latency) noexcept = nullptr;
  /// Factor of the tyre forces.
  double (*grip)(double strength) noexcept = nullptr;
  /// Sideways push on the car [m/s²], left positive.
  double (*side_acceleration)(double strength) noexcept = nullptr;
  /// Number of checks after which the deadline is spent (base/deadline.hpp).
  std::uint32_t (*deadline_questions)(double strength) noexcept = nullptr;
};

/// The list of faults (fault_registry.cpp), which scenario files, --fault, dashboard, tests and docs read.
[[nodiscard]] std::span<const FaultKind> fault_kinds() noexcept;
/// Kind of a fault of the list.
[[nodiscard]] inline const FaultKind& kind_of(Fault fault) noexcept {
  return fault_kinds()[static_cast<std::size_t>(fault)];
}
/// Fault of this name; none if it is not in the list.
[[nodiscard]] std::optional<Fault> fault_named(std::string_view name) noexcept;

/// Scheduled fault of a scenario.
struct FaultEvent {
  Fault fault{};
  double at = 0.0;        ///< start [s]; >= 0
  double duration = 1.0;  ///< [s]; > 0
  double strength = 1.0;  ///< strength in the kind's range
};
/// Event with the kind's own duration and strength.
[[nodiscard]] FaultEvent default_event(Fault fault, double at) noexcept;

/// Faults of a run: scheduled events and switches, applied to the signals between car and controller. Seeded
/// and deterministic: only faults that are on draw random numbers, each from a stream of its own. No
/// allocation after construction; one thread.
class FaultLab {
 public:
  static constexpr std::size_t kCapacity = 64;  ///< scheduled events; later ones are left out

  FaultLab(std::span<const FaultEvent> events, std::uint64_t seed);
  /// Starts a run: all faults are off, all events are scheduled.
  void reset() noexcept;

  /// Begins and ends the faults that are due at `time` [s]. Call it first in each cycle; times do not
  /// decrease.
  void update(double time) noexcept;
  /// Switches a fault off, or on from `time` with the kind's duration and strength. No effect on a fault that
  /// is in that state.
  void set(Fault fault, bool on, double time) noexcept;
  /// Switches a fault on with the event's duration and strength, also one that is on. The strength is clamped
  /// to the kind's range.
  void set(const FaultEvent& event) noexcept;

  [[nodiscard]] bool is_on(Fault fault) const noexcept { return (bits_ & bit(fault)) != 0U; }
  /// One bit for each fault that is on.
  [[nodiscard]] std::uint32_t bits() const noexcept { return bits_; }

  /// Measurement that the controller gets instead of `now`. With a lost link it has only the time.
  [[nodiscard]] model::Measurement seen(const model::Measurement& now) noexcept;
  /// Whether a command arrives; false if it gets lost.
  [[nodiscard]] bool is_delivered() noexcept;
  /// Command that the actuators execute instead of `command`.
  [[nodiscard]] model::Command done(const model::Command& command) noexcept;
  /// Delay of commands beyond the `latency` that the controller assumes [s].
  [[nodiscard]] double extra_delay(double latency) const noexcept;
  /// Factor of the tyre forces.
  [[nodiscard]] double grip() const noexcept;
  /// Sideways push on the car [m/s²], left positive.
  [[nodiscard]] double side_acceleration() const noexcept;
  /// Number of checks after which the deadline is spent; 0: by the clock (base/deadline.hpp).
  [[nodiscard]] std::uint32_t deadline_questions() const noexcept;

 private:
  struct Active {
    FaultMemory memory;
    double until = 0.0;  ///< end of the fault that is on [s]
  };
  [[nodiscard]] static constexpr std::uint32_t bit(Fault fault) noexcept {
    return 1U << static_cast<unsigned>(fault);
  }
  /// Switches a fault on until a time [s].
  void begin(Fault fault, double until, double strength) noexcept;
  /// Switches a fault off and empties its memory.
  void end(Fault fault) noexcept;
  /// Calls act(kind, memory) for each fault that is on, in the order of the list.
  template <class Lab, class Act>
  static void for_each_on(Lab& lab, Act act) noexcept;
  /// Calls act(kind, memory) for each fault that is on, by places, those of one place in the order of the
  /// list.
  template <class Act>
  void for_each_on_by_place(Act act) noexcept;

  std::array<FaultEvent, kCapacity> events_{};  ///< scheduled events
  std::array<bool, kCapacity> has_begun_{};     ///< events that update() has begun
  std::size_t event_count_ = 0;                 ///< used entries of both
  std::uint64_t seed_;                          ///< seed of the faults' streams
  std::vector<Active> active_;                  ///< one for each kind
  std::uint32_t bits_ = 0;                      ///< bits()
};

}  // namespace chicane::sim
