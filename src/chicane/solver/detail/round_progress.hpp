// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

namespace chicane::solver {

/// Watches what is missed from round to round of an augmented Lagrangian.
class RoundProgress {
 public:
  /// No round yet: there is nothing that misses could have come down from.
  [[nodiscard]] bool is_first() const noexcept { return first_ == kInfinity; }
  /// Takes note of a round of `iterations` that left `miss`; one that has not `converged` is not blamed. It
  /// should leave half of the least miss before, or nine tenths if it was short.
  void note(double miss, bool converged, int iterations) noexcept {
    const bool is_enough = miss <= (iterations <= kShort ? 0.9 : 0.5) * best_;
    idle_ = is_enough ? 0 : idle_ + (converged ? 1 : 0);
    if (is_first()) first_ = miss;
    best_ = std::min(best_, miss);
  }
  /// The last round counts as good.
  void excuse() noexcept { idle_ = 0; }
  /// From a point that misses so much.
  void begin_at(double miss) noexcept {
    idle_ = 0;
    best_ = miss;
  }
  /// The last rounds have come closer than the first one.
  [[nodiscard]] bool is_good() const noexcept { return idle_ == 0 && best_ < first_; }
  /// Three rounds in turn were not enough; short ones with a `miss` that is small beside that of the `guess`
  /// may be eight.
  [[nodiscard]] bool is_lost(double miss, double guess, int iterations) const noexcept {
    return idle_ >= (miss <= kSmall * guess && iterations <= kShort ? 8 : 3);
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kSmall = 1e-2;
  static constexpr int kShort = 10;  ///< iterations
  double first_ = kInfinity;
  double best_ = kInfinity;
  int idle_ = 0;
};

}  // namespace chicane::solver
