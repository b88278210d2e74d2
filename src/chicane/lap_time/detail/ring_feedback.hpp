// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "chicane/lap_time/detail/limit_model.hpp"

namespace chicane::lap_time {

/// Linear feedback towards a plan, for each of its nodes: the periodic linear-quadratic regulator of the
/// model's derivatives along it (docs/limit.md, section 5).
class RingFeedback {
 public:
  /// `z`: the plan's nodes.
  RingFeedback(const LimitModel& model, const RoadNodes& road, const std::vector<double>& z,
               const Tuning& tuning);

  /// Gains at node k: two rows of `driven` numbers; inputs = the plan's − gains · error.
  [[nodiscard]] const double* gains(std::size_t k) const noexcept {
    return gains_.data() + k * 2 * static_cast<std::size_t>(driven_);
  }

 private:
  int driven_;
  std::vector<double> gains_;
};

}  // namespace chicane::lap_time
