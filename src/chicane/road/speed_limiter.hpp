// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "chicane/base/word.hpp"

/// The table of SpeedLimiter. A row makes the enumerator, its constant in the messages and its sentence in
/// the dashboard. Rows are numbered in order; recordings keep the numbers, so a new row goes to the end.
/// Columns: enumerator, name, sentence (base/word.hpp).
// clang-format off
#define CHICANE_SPEED_LIMITERS(ROW)                                                                  \
  ROW(kNone, "none", "the controller does not say what limits the speed")                            \
  ROW(kAsked, "asked", "the car drives at the speed that is asked for")                              \
  ROW(kCurvature, "curvature", "the bend takes all the grip that the plan may use")                  \
  ROW(kBraking, "braking", "the car must be slower at the bend ahead")                               \
  ROW(kPower, "power", "the drive gives no more")                                                    \
  ROW(kSight, "sight", "the road is not known far enough ahead")                                     \
  ROW(kPartThrottle, "part_throttle", "the controller gives less than full throttle")                \
  ROW(kSteerRate, "steer_rate", "the wheels cannot be turned any faster")                            \
  ROW(kEdge, "edge", "the car already uses the road up to its edge")                                 \
  ROW(kPlan, "plan", "the planned lap is no faster here")
// clang-format on

namespace chicane::road {

#define CHICANE_ENUMERATOR(enumerator, name, sentence) enumerator,
/// What keeps the car from being faster where it is.
enum class SpeedLimiter : std::uint8_t { CHICANE_SPEED_LIMITERS(CHICANE_ENUMERATOR) };
#undef CHICANE_ENUMERATOR

#define CHICANE_WORD(enumerator, name, sentence) \
  Word<SpeedLimiter>{SpeedLimiter::enumerator, name, Severity::kOk, sentence},
inline constexpr std::array kSpeedLimiterWords{CHICANE_SPEED_LIMITERS(CHICANE_WORD)};
#undef CHICANE_WORD

}  // namespace chicane::road
