// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>

#include "chicane/solver/detail/input_block.hpp"

namespace chicane::solver {

/// Working set of one input over the stages where its change is bounded, too (docs/solver_constraints.md).
/// Inputs tied by changes at their bounds are a chain: with no member at a bound of its own, the first is
/// free and each other one follows its predecessor (kRate…); with one at its bound, those before it are fixed
/// by their successors (kNext…) and those behind it still follow.
///
/// `Tag`: the instruction set that its translation unit is compiled for, so that the linker tells them apart.
template <std::size_t Nu, class Tag = void>
class RateSet {
 public:
  RateSet(Hold (*hold)[Nu], std::size_t input) noexcept : hold_(hold), m_(input) {}

  static constexpr bool follows(Hold hold) noexcept {
    return hold == Hold::kRateLow || hold == Hold::kRateHigh;
  }
  static constexpr bool precedes(Hold hold) noexcept {
    return hold == Hold::kNextLow || hold == Hold::kNextHigh;
  }
  /// Does not depend on the state.
  static constexpr bool is_fixed(Hold hold) noexcept { return hold != Hold::kFree && !follows(hold); }

  /// The bound is above, or acts as one that is.
  static constexpr bool rises(Hold hold) noexcept {
    return hold == Hold::kHigh || hold == Hold::kRateHigh || hold == Hold::kNextLow;
  }

  /// What contradicts the working set at one stage.
  enum class Finding { kNone, kBeyondOwn, kBeyondRate, kPulledInside };

  /// `slope`: dJ/du, with that of the members it fixes where it is fixed.
  static Finding find(Hold hold, const InputBounds& bounds, double u, double slope,
                      double curvature) noexcept {
    constexpr double kTolerance = 1e-10;
    if (!(bounds.own_high > bounds.own_low)) return hold == Hold::kLow ? Finding::kNone : Finding::kBeyondOwn;
    const bool is_own = hold == Hold::kLow || hold == Hold::kHigh;
    if (!is_own && (u > bounds.own_high + kTolerance || u < bounds.own_low - kTolerance))
      return Finding::kBeyondOwn;
    if (!follows(hold) && (u > bounds.rate_high + kTolerance || u < bounds.rate_low - kTolerance))
      return Finding::kBeyondRate;
    if (hold == Hold::kFree) return Finding::kNone;
    const double inward = rises(hold) ? slope : -slope;  // > 0: the cost falls when the bound is left
    return inward > kTolerance * (1.0 + std::fabs(curvature)) ? Finding::kPulledInside : Finding::kNone;
  }

  /// Corrects the working set at stage k.
  void repair(std::size_t k, Finding finding, const InputBounds& bounds, double u) noexcept {
    const double own_middle = 0.5 * (bounds.own_low + bounds.own_high);
    const bool above_rate = u > bounds.rate_high;
    switch (finding) {
      case Finding::kBeyondOwn: {
        const bool has_free_chain = follows(at(k)) && !is_fixed_chain(k);
        const Hold link = at(k);
        at(k) = u > bounds.own_high || (u > own_middle && bounds.own_high > bounds.own_low) ? Hold::kHigh
                                                                                            : Hold::kLow;
        if (has_free_chain) fix_before(k, link == Hold::kRateHigh);
        return;
      }
      case Finding::kBeyondRate:
        if (is_fixed(at(k)) && k > 0 && !is_fixed_chain(k - 1)) {
          fix_before(k, above_rate);
        } else if (!(k == 0 && is_fixed(at(k)) &&
                     (bounds.rate_high < bounds.own_low || bounds.rate_low > bounds.own_high))) {
          at(k) = above_rate ? Hold::kRateHigh : Hold::kRateLow;
        }
        return;
      case Finding::kPulledInside:
        return loosen(k);
      case Finding::kNone:
        return;
    }
  }

  /// Holds stage k at a bound of its own, tied to the one before by a change at a bound, or both. Pre: the
  /// stages before it are set.
  void set(std::size_t k, Hold own, Hold tie) noexcept {
    at(k) = tie;
    if (own == Hold::kFree) return;
    const bool has_free_chain = tie != Hold::kFree && !is_fixed_chain(k);
    at(k) = own;
    if (has_free_chain) fix_before(k, tie == Hold::kRateHigh);
  }

  /// Members that no successor fixes any more are free.
  void tidy(std::size_t horizon) noexcept {
    for (std::size_t k = horizon; k-- > 0;) {
      if (precedes(at(k)) && (k + 1 >= horizon || !is_fixed(at(k + 1)))) at(k) = Hold::kFree;
    }
  }

 private:
  Hold& at(std::size_t k) noexcept { return hold_[k][m_]; }

  /// Whether stage k and what it follows stand still.
  bool is_fixed_chain(std::size_t k) noexcept {
    while (k > 0 && follows(at(k))) --k;
    return at(k) != Hold::kFree;
  }
  /// Stage k is fixed: so is the chain that ends at k − 1, tied to k by a change at its upper or lower bound.
  void fix_before(std::size_t k, bool upper) noexcept {
    while (k-- > 0) {
      const Hold before = at(k);
      at(k) = upper ? Hold::kNextHigh : Hold::kNextLow;
      if (!follows(before)) return;
      upper = before == Hold::kRateHigh;
    }
  }
  /// Stage k is let go: the chain that it fixed is free at its first member, and the others follow.
  void loosen(std::size_t k) noexcept {
    while (k > 0 && precedes(at(k - 1)) && !follows(at(k))) {
      at(k) = at(k - 1) == Hold::kNextHigh ? Hold::kRateHigh : Hold::kRateLow;
      --k;
    }
    at(k) = Hold::kFree;
  }

  Hold (*hold_)[Nu];
  std::size_t m_;
};

}  // namespace chicane::solver
