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

namespace chicane::sim {

/// Index of a fault in the list, and the number of its bit in FaultLab::bits(). Recordings keep these bits:
/// the index of a fault never changes.
enum class Fault : std::uint8_t {};
inline constexpr std::size_t kMostFaults = 32;  ///< limit of the list: one bit each

/// State of a fault that is on.
struct FaultMemory {
  double strength = 1.0;  ///< strength in the kind's range
  Random random{0};       ///< a stream of its own, not restarted when the fault begins
  std::optional<model::Measurement> measurement{};  ///< measurement of the effects; empty when it begins
  std::optional<double> value{};                    ///< the same
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
  std::string_view name;     ///< "half_grip"
  std::string_view meaning;  ///< one sentence
  double duration = 1.0;     ///< unless said otherwise [s]
  double strength = 1.0;     ///< unless said otherwise
  double weakest = 1.0;      ///< range of the strength
  double strongest = 1.0;
  std::string_view strength_meaning{};  ///< meaning with its unit; empty for a fault without a strength
  std::string_view stream{};            ///< seed of its random numbers: at most eight letters
  FaultPlace place = FaultPlace::kValue;

  /// Changes the controller's measurement, `measured`; `now` is the true one.
  void (*measure)(FaultMemory&, const model::Measurement& now,
                  model::Measurement& measured) noexcept = nullptr;
  /// Whether a command gets lost on its way.
  bool (*loses_command)(FaultMemory&) noexcept = nullptr;
  /// Changes the command that actuators execute, `done`; `asked` is the command that arrived.
  void (*actuate)(FaultMemory&, const model::Command& asked, model::Command& done) noexcept = nullptr;
  /// Time that commands arrive later than the controller assumes, when it assumes `latency` [s].
  double (*extra_delay)(double strength, double latency) noexcept = nullptr;
  /// Tyre forces times this.
  double (*grip)(double strength) noexcept = nullptr;
  /// Sideways push on the car [m/s²], left positive.
  double (*side_acceleration)(double strength) noexcept = nullptr;
  /// Questions to the deadline until it is spent (base/deadline.hpp).
  std::uint32_t (*deadline_questions)(double strength) noexcept = nullptr;
};

/// The one list of faults (fault_registry.cpp): scenario files, --fault, dashboard, tests and docs
/// all read it.
[[nodiscard]] std::span<const FaultKind> fault_kinds() noexcept;
[[nodiscard]] inline const FaultKind& kind_of(Fault fault) noexcept {
  return fault_kinds()[static_cast<std::size_t>(fault)];
}
/// Fault of this name; none if it is not in the list.
[[nodiscard]] std::optional<Fault> fault_named(std::string_view name) noexcept;

/// A fault with its time, as scenarios have it.
struct FaultEvent {
  Fault fault{};
  double at = 0.0;        ///< start [s]; >= 0
  double duration = 1.0;  ///< [s]; > 0
  double strength = 1.0;  ///< strength in the kind's range
};
/// Event with the kind's own duration and strength.
[[nodiscard]] FaultEvent default_event(Fault fault, double at) noexcept;

/// Faults of a run: scheduled events and switches, applied to the signals between car and controller. Seeded
/// and deterministic: chance is drawn only by faults that are on, each from a stream of its own. No
/// allocation after construction; one thread.
class FaultLab {
 public:
  static constexpr std::size_t kCapacity = 64;  ///< scheduled events; later ones are left out

  FaultLab(std::span<const FaultEvent> events, std::uint64_t seed);
  /// A new run: nothing is on, all is scheduled again.
  void reset() noexcept;

  /// Begins and ends faults that are due at `time` [s]; times do not decrease. Call it before the rest.
  void update(double time) noexcept;
  /// Switches a fault on from `time` for the kind's own duration and with its own strength, or off; no effect
  /// if it is so already.
  void set(Fault fault, bool on, double time) noexcept;
  /// Switches a fault on for a duration and with a strength of its own, also if it is on already; the
  /// strength is clamped to the kind's range.
  void set(const FaultEvent& event) noexcept;

  [[nodiscard]] bool is_on(Fault fault) const noexcept { return (bits_ & bit(fault)) != 0U; }
  [[nodiscard]] std::uint32_t bits() const noexcept { return bits_; }

  /// Measurement that the controller gets instead of `now`. With a lost link it has only the time.
  [[nodiscard]] model::Measurement seen(const model::Measurement& now) noexcept;
  /// Whether a command arrives; false if it gets lost.
  [[nodiscard]] bool is_delivered() noexcept;
  /// Command that the actuators execute instead of `command`.
  [[nodiscard]] model::Command done(const model::Command& command) noexcept;
  /// Time that commands arrive later than the controller assumes, when it assumes `latency` [s].
  [[nodiscard]] double extra_delay(double latency) const noexcept;
  /// Tyre forces times this.
  [[nodiscard]] double grip() const noexcept;
  /// Sideways push on the car [m/s²], left positive.
  [[nodiscard]] double side_acceleration() const noexcept;
  /// Questions to the deadline until it is spent, 0 = as the clock says (base/deadline.hpp).
  [[nodiscard]] std::uint32_t deadline_questions() const noexcept;

 private:
  struct Active {
    FaultMemory memory;
    double until = 0.0;
  };
  [[nodiscard]] static constexpr std::uint32_t bit(Fault fault) noexcept {
    return 1U << static_cast<unsigned>(fault);
  }
  void begin(Fault fault, double until, double strength) noexcept;
  void end(Fault fault) noexcept;
  /// Calls act(kind, memory) for each fault that is on, in the order of the list.
  template <class Lab, class Act>
  static void for_each_on(Lab& lab, Act act) noexcept;

  std::array<FaultEvent, kCapacity> events_{};
  std::array<bool, kCapacity> has_begun_{};
  std::size_t event_count_ = 0;
  std::uint64_t seed_;
  std::vector<Active> active_;  ///< one for each kind
  std::uint32_t bits_ = 0;
};

}  // namespace chicane::sim
