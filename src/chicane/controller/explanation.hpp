// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "chicane/road/speed_limiter.hpp"

namespace chicane::controller {

using road::SpeedLimiter;

/// Why the answer is what it is. Plain data, filled once per step; what a controller cannot say stays at its
/// default.
struct Explanation {
  static constexpr int kMaxCostTerms = 12;

  /// Price of the plan by what it is paid for, summed over the stages: the first `cost_term_count` have the
  /// names of Controller::cost_terms(). Together they are SolveReport::cost.
  std::array<double, kMaxCostTerms> cost_terms{};
  int cost_term_count = 0;

  SpeedLimiter speed_limiter = SpeedLimiter::kNone;
  double speed_limit =
      std::numeric_limits<double>::quiet_NaN();  ///< what is allowed where the command acts [m/s]

  /// One bit each, in the order of Controller::constraints(): active in the first stage of the plan, and in
  /// any.
  std::uint32_t active_now = 0;
  std::uint32_t active_ahead = 0;
};

/// Constraints by their bit in Explanation::active_now. Controllers without tyres and edges in their problem
/// know the first three only.
enum class Constraint : std::uint8_t {
  kSteerLimit,
  kThrottleMax,
  kBrakeMax,
  kSteerRate,
  kLeftEdge,
  kRightEdge,
  kFrontTire,
  kRearTire,
  kFrictionEllipse,
};
[[nodiscard]] constexpr std::uint32_t bit(Constraint constraint) noexcept {
  return 1U << static_cast<unsigned>(constraint);
}

/// Names in the order of the bits.
inline constexpr std::array<std::string_view, 9> kConstraintNames{
    "steer_limit", "throttle_max", "brake_max", "steer_rate",      "left_edge",
    "right_edge",  "front_tire",   "rear_tire", "friction_ellipse"};
/// Those of controllers that bound their inputs only.
inline constexpr std::span<const std::string_view> kInputConstraintNames{kConstraintNames.data(), 3};

}  // namespace chicane::controller
