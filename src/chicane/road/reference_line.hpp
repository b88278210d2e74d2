// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/base/vec2.hpp"

/// The table of SpeedLimiter. A row makes the enumerator, its constant in the messages and its sentence in
/// the dashboard. Rows are numbered in order; recordings keep the numbers, so a new row goes to the end.
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
  double grip = 1.0;    ///< grip over the grip of the vehicle's parameters
  bool slides = false;  ///< slip beyond the tyres' peak, where that is stable
  double slip = 1.0;    ///< largest slip of an axle, over the options' limit

  friend bool operator==(const LapTerms&, const LapTerms&) = default;
};

/// A place of a plane curve.
struct CurvePoint {
  Vec2 position{};                ///< position in W [m]
  Vec2 tangent = Vec2{1.0, 0.0};  ///< tangent of length 1
  double heading = 0.0;           ///< heading of the tangent [rad], continuous along the curve
  double curvature = 0.0;         ///< [1/m], left positive
};

/// The curve between two of its places, `share` of the way along the `length` [m] between them: cubic Hermite
/// in position and heading, linear in curvature. Error O(length⁴).
[[nodiscard]] CurvePoint between(const CurvePoint& from, const CurvePoint& to, double length,
                                 double share) noexcept;

/// The line a controller drives by, as a table of equally spaced samples: where it is, how fast, and how far
/// it has moved away from the line through the waypoints. Looking something up takes a division and one place
/// of the table.
///
/// Memory is reserved at construction. The code that fills it (line_planner.hpp) begins with shape().
class ReferenceLine {
 public:
  struct Sample {
    CurvePoint curve;
    double offset = 0.0;  ///< offset of the line from the waypoint line, left positive [m]
    double speed = 0.0;   ///< planned [m/s]
    SpeedLimiter limiter = SpeedLimiter::kNone;
  };
  /// Demand of the line at a place. Beyond an open end: straight on, everything else as at the end.
  struct Demand {
    double curvature = 0.0;        ///< [1/m]
    double curvature_slope = 0.0;  ///< [1/m²]
    double speed = 0.0;            ///< [m/s]
    double speed_slope = 0.0;      ///< [1/s]
    double offset = 0.0;           ///< [m]
    SpeedLimiter limiter = SpeedLimiter::kNone;
  };
  /// Nearest place to a point.
  struct Projection {
    double s = 0.0;
    double d = 0.0;         ///< signed distance, left positive [m]
    double distance = 0.0;  ///< |point − nearest place| [m]: more than |d| beyond an open end
  };

  explicit ReferenceLine(int capacity) { samples_.resize(static_cast<std::size_t>(capacity)); }

  void clear() noexcept { count_ = 0; }
  /// Makes room for samples 0..intervals at s = i · length / intervals. A closed line repeats its first
  /// sample as its last, a lap later. False, and cleared, beyond the capacity.
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
  [[nodiscard]] Demand demand(double s) const noexcept;
  /// Projects among all samples, O(n); pre: not empty, finite.
  [[nodiscard]] Projection project(const Vec2& point) const noexcept;
  /// Projects a car that moves along `heading` [rad]. If the line passes the point more than once, each time
  /// by less than `reach` [m] farther than the nearest time, the pass whose direction fits best. O(n).
  [[nodiscard]] Projection project_along(const Vec2& point, double heading, double reach) const noexcept;
  /// Projects a car: within kWindow of its `last` place if there is one and the line still passes nearer than
  /// `far` [m] there; else anywhere (project_along()).
  [[nodiscard]] Projection find(const Vec2& point, double heading, double reach, const double* last,
                                double far) const noexcept;
  static constexpr double kWindow = 30.0;  ///< [m]
  /// Projects within `window` [m] before and after `guess`.
  [[nodiscard]] Projection project(const Vec2& point, double guess, double window) const noexcept;

 private:
  struct Place {
    std::size_t index = 0;  ///< index of the previous sample
    double share = 0.0;     ///< weight of the next sample
    double beyond = 0.0;    ///< open end [m], or whole laps [m]
  };
  [[nodiscard]] Place place(double s) const noexcept;
  [[nodiscard]] Projection refine(const Vec2& point, std::size_t nearest) const noexcept;

  std::vector<Sample> samples_;
  std::size_t count_ = 0;
  double length_ = 0.0;
  double spacing_ = 1.0;
  bool is_closed_ = false;
};

}  // namespace chicane::road
