// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "chicane/controller/guard_words.hpp"

namespace chicane::safety {

/// What the guard did in a control cycle, and why.
struct GuardReport {
  controller::Rung rung = controller::Rung::kController;  ///< whose command was sent
  bool gated = false;                                     ///< the command gate had to change it
  /// The worst that was found; with GuardMode::kObserve also where nothing was done about it.
  controller::GuardReason reason = controller::GuardReason::kNone;
  /// Of the stop at hand: least distance of a tyre to the known edge [m]; not-a-number: none at hand.
  double stop_edge = std::numeric_limits<double>::quiet_NaN();
  double stop_distance = std::numeric_limits<double>::quiet_NaN();  ///< and its length [m]
};

}  // namespace chicane::safety
