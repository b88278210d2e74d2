// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chicane/model/vehicle.hpp"
#include "chicane/road/instalments.hpp"
#include "chicane/road/line_smoother.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/road/speed_plan.hpp"
#include "chicane/road/waypoint_map.hpp"

namespace chicane::road {

struct LinePlannerOptions {
  double smoothing_width = 1.5;  ///< the line may leave the waypoint line by this much [m]; 0 = not at all
  SpeedPlanOptions speed{};

  friend bool operator==(const LinePlannerOptions&, const LinePlannerOptions&) = default;
};

/// From a stretch of the waypoint line, or a lap of it, to the line to drive by: knots are taken, smoothed,
/// moved sideways, sampled at equal spacing, and given their speeds. In instalments, so that a whole lap may
/// be planned beside the driving: a unit of work is about 10 ns, a metre of line takes about 20.
///
/// Memory is reserved at construction; nothing here allocates.
class LinePlanner {
 public:
  static constexpr double kSampleSpacing = 1.5;  ///< [m] at most
  static constexpr int kOverlap = 84;            ///< knots a lap is smoothed on beyond both ends

  /// For stretches of up to `knots` knots.
  explicit LinePlanner(int knots);
  void configure(const LinePlannerOptions& options, const model::VehicleParams& vehicle) noexcept;

  /// The stretch from `from` to `to` [m] of a waypoint line. A lap ends where it begins. False when it has no
  /// length, or too many knots.
  [[nodiscard]] bool begin(double from, double to, bool is_lap) noexcept;
  /// Does up to `work`. True when `line` is planned; until then it is not to be used, and `source` must not
  /// change there.
  [[nodiscard]] bool advance(int work, const WaypointLine& source, ReferenceLine& line) noexcept;

  /// Samples of a line planned from so many knots.
  [[nodiscard]] static constexpr int samples_for(int knots) noexcept { return 5 * knots / 2 + 2; }

 private:
  struct Moved {
    CurvePoint curve;
    double offset = 0.0;
    double s = 0.0;  ///< along the new line [m]
  };
  void take(const WaypointLine& source, int k) noexcept;
  [[nodiscard]] double offset(int k) const noexcept;
  void move(int k) noexcept;
  bool shape(ReferenceLine& line) noexcept;
  void sample(ReferenceLine& line, int i) noexcept;

  model::VehicleParams vehicle_;
  LinePlannerOptions options_;
  LineSmoother smoother_;
  SpeedPlan speed_plan_;
  Instalments instalments_;
  std::vector<CurvePoint> knots_;
  std::vector<Moved> moved_;
  double from_ = 0.0;
  double length_ = 0.0;
  double spacing_ = 1.0;
  int intervals_ = 0;
  int extra_ = 0;   ///< knots of the overlap
  int behind_ = 0;  ///< moved knot before the last sample
  bool is_lap_ = false;
};

}  // namespace chicane::road
