// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "chicane/base/random.hpp"
#include "chicane/controller/controller.hpp"
#include "chicane/model/state.hpp"
#include "chicane/model/vehicle.hpp"

/// Controllers that try to drive the car off the road, for attacks on the guard.
namespace chicane::attack {

/// Numbers and answers that an adversary keeps while one of its attacks lasts. Empty when an attack begins.
struct AdversaryMemory {
  std::optional<controller::StepResult> answer{};
  model::Command command{};
  double until = -1e9;  ///< end of what is held [s], clock of the measurements
  double side = 1.0;    ///< −1 right, 1 left: drawn when the attack begins
  double pace = 1.0;    ///< in [0.2, 3): drawn when the attack begins
  bool has_stood = false;
  std::size_t way = 0;      ///< index of the kind that is imitated
  double way_until = -1e9;  ///< [s], clock of the measurements
};

/// One cycle of an attack.
struct AttackCycle {
  const model::Measurement& now;
  double since = 0.0;  ///< the attack began [s]
  double lock = 0.0;   ///< steering limit [rad]
  Random& random;
  AdversaryMemory& memory;
};

/// A way to attack. `act` changes `answer`, which is the nominal controller's, into the adversary's.
struct AdversaryKind {
  std::string_view name;
  std::string_view meaning;
  void (*act)(AttackCycle& cycle, controller::StepResult& answer);
};

/// All of them. A new one is a row in adversaries.cpp.
[[nodiscard]] std::span<const AdversaryKind> adversary_kinds();
/// Null for a name that is none.
[[nodiscard]] const AdversaryKind* adversary_named(std::string_view name);

/// A controller that attacks as `kind` does, and between attacks answers as `nominal`. The seed chooses
/// numbers and schedule: from the first cycle on (seed 0, 3, 6, …), from a moment in [5, 25) s on (1, 4, 7,
/// …), or again and again, 0.5–6 s at a time (2, 5, 8, …). Pre: `nominal` is not null.
[[nodiscard]] std::unique_ptr<controller::Controller> make_adversary(
    const AdversaryKind& kind, std::uint64_t seed, std::unique_ptr<controller::Controller> nominal,
    const model::VehicleParams& vehicle);

}  // namespace chicane::attack
