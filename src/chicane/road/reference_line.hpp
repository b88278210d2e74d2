// SPDX-License-Identifier: MIT
// ReferenceLine: the line that a controller drives by, as samples with speeds and the reasons that limit
// them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/base/vec2.hpp"

/// Table of SpeedLimiter. A row makes the enumerator, its constant in the messages and its sentence in the
/// dashboard. Rows are numbered in order; recordings have the numbers, so that a new row goes to the end.
/// Columns: enumerator, name, sentence (base/text.hpp).
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
/// Reason that keeps the car from being faster.
enum class SpeedLimiter : std::uint8_t { CHICANE_SPEED_LIMITERS(CHICANE_ENUMERATOR) };
#undef CHICANE_ENUMERATOR

#define CHICANE_WORD(enumerator, name, sentence) \
  Word<SpeedLimiter>{SpeedLimiter::enumerator, name, Severity::kOk, sentence},
inline constexpr std::array kSpeedLimiterWords{CHICANE_SPEED_LIMITERS(CHICANE_WORD)};
#undef CHICANE_WORD

/// Terms that a lap is planned with: shares of the car's limits.
struct LapTerms {
  double grip = 1.0;    ///< planned grip as a share of the grip of the vehicle's parameters
  bool slides = false;  ///< allows slip beyond the tyres' peak where that is stable
  double slip = 1.0;    ///< largest slip of an axle as a share of the options' limit

  friend bool operator==(const LapTerms&, const LapTerms&) = default;
};

/// Point of a plane curve, with direction and curvature.
struct CurvePoint {
  Vec2 position{};                ///< position in W [m]
  Vec2 tangent = Vec2{1.0, 0.0};  ///< tangent of length 1
  double heading = 0.0;           ///< heading of the tangent [rad], continuous along the curve
  double curvature = 0.0;         ///< [1/m], left positive
};

/// Interpolates a curve between two of its points: `share` in [0, 1] of the arc length `length` [m] from the
/// first to the second. Cubic Hermite in position and heading, linear in curvature. Error O(length⁴).
[[nodiscard]] CurvePoint between(const CurvePoint& from, const CurvePoint& to, double length,
                                 double share) noexcept;

/// Line that a controller drives by, as a table of equally spaced samples: curve, planned speed, and offset
/// from the line through the waypoints. A look-up takes O(1).
///
/// Memory is reserved at construction. Code that fills the table (line_planner.hpp) calls shape() first.
class ReferenceLine {
 public:
  /// Row of the table.
  struct Sample {
    CurvePoint curve;
    double offset = 0.0;  ///< offset of the line from the waypoint line, left positive [m]
    double speed = 0.0;   ///< planned [m/s]
    SpeedLimiter limiter = SpeedLimiter::kNone;
  };
  /// Values of the line at one arc length. Beyond an open end the line is straight, with speed and offset of
  /// the end. Slopes are derivatives by arc length.
  struct Demand {
    double curvature = 0.0;        ///< [1/m], left positive
    double curvature_slope = 0.0;  ///< [1/m²]
    double speed = 0.0;            ///< [m/s]
    double speed_slope = 0.0;      ///< [1/s]
    double offset = 0.0;           ///< from the waypoint line, left positive [m]
    SpeedLimiter limiter = SpeedLimiter::kNone;
  };
  /// Nearest point of the line to a given point.
  struct Projection {
    double s = 0.0;         ///< arc length of the nearest point [m]
    double d = 0.0;         ///< signed distance of the given point, left positive [m]
    double distance = 0.0;  ///< |given point − nearest point| [m]: more than |d| beyond an open end
  };

  explicit ReferenceLine(int capacity) { samples_.resize(static_cast<std::size_t>(capacity)); }

  void clear() noexcept { count_ = 0; }
  /// Makes room for samples 0 … intervals at s = i · length / intervals. The last sample of a closed line is
  /// its first one, with the heading of a lap later. False, and the line is empty, beyond the capacity.
  [[nodiscard]] bool shape(double length, int intervals, bool is_closed) noexcept;
  [[nodiscard]] std::span<Sample> samples() noexcept { return {samples_.data(), count_}; }
  [[nodiscard]] std::span<const Sample> samples() const noexcept { return {samples_.data(), count_}; }

  [[nodiscard]] bool is_empty() const noexcept { return count_ < 2; }
  [[nodiscard]] bool is_closed() const noexcept { return is_closed_; }
  [[nodiscard]] double length() const noexcept { return length_; }
  [[nodiscard]] double spacing() const noexcept { return spacing_; }

  /// Point at any s: wrapped when closed, straight beyond open ends. The heading is continuous beyond the
  /// first lap. Pre: not empty.
  [[nodiscard]] CurvePoint at(double s) const noexcept;
  /// Curvature, speed and offset at any s, as at() has its point. Pre: not empty.
  [[nodiscard]] Demand demand(double s) const noexcept;
  /// Projects onto the whole line, O(n). Pre: not empty, and `point` is finite.
  [[nodiscard]] Projection project(const Vec2& point) const noexcept;
  /// Projects the position of a car that moves along `heading` [rad]. Where the line passes the point several
  /// times, chooses the pass whose direction fits best among those less than `reach` [m] farther away than
  /// the nearest. O(n).
  [[nodiscard]] Projection project_along(const Vec2& point, double heading, double reach) const noexcept;
  /// Projects the position of a car within kWindow of `*last`, the arc length of its last projection. Without
  /// one (null), or if the line is farther away than `far` [m] there, by project_along().
  [[nodiscard]] Projection find(const Vec2& point, double heading, double reach, const double* last,
                                double far) const noexcept;
  static constexpr double kWindow = 30.0;  ///< [m] chosen: far beyond the motion of a car between projections
  /// Projects within `window` [m] before and after `guess`.
  [[nodiscard]] Projection project(const Vec2& point, double guess, double window) const noexcept;

 private:
  /// Position of an arc length in the table.
  struct Place {
    std::size_t index = 0;  ///< index of the previous sample
    double share = 0.0;     ///< weight of the next sample
    double beyond = 0.0;    ///< arc length beyond an open end, or of whole laps [m]
  };
  [[nodiscard]] Place place(double s) const noexcept;
  /// Projects by Newton's method from the nearest sample.
  [[nodiscard]] Projection refine(const Vec2& point, std::size_t nearest) const noexcept;

  std::vector<Sample> samples_;
  std::size_t count_ = 0;  ///< samples in use
  double length_ = 0.0;    ///< [m]
  double spacing_ = 1.0;   ///< of the samples [m]
  bool is_closed_ = false;
};

}  // namespace chicane::road
