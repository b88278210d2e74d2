// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "chicane/controller/line_smoother.hpp"
#include "chicane/controller/speed_plan.hpp"
#include "chicane/controller/waypoint_map.hpp"
#include "chicane/model/measurement.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/path/path.hpp"

namespace chicane::controller {

/// How a controller turns waypoints into the road it drives on.
struct RoadOptions {
  double half_width = 3.0;  ///< room for the centre of mass each side of the waypoint line [m]
  double smoothing_width =
      1.5;  ///< the reference line may leave the waypoint line by this much [m]; 0 = none
  bool remember_waypoints = true;  ///< false: only what the last measurement shows
  SpeedPlanOptions speed{};

  friend bool operator==(const RoadOptions&, const RoadOptions&) = default;
};

/// What a controller knows of the road: waypoints remembered, a smooth reference line through them, the speed
/// planned along it, and the room left and right of it. All memory is reserved at construction.
class Road {
 public:
  Road(const RoadOptions& options, const model::VehicleParams& vehicle);
  void reset() noexcept;
  /// Other settings for the same road: what is known of it is planned anew when they differ.
  void configure(const RoadOptions& options, const model::VehicleParams& vehicle) noexcept;

  /// Takes in the waypoints of a measurement; when they tell something new, line and speeds are planned anew.
  void add(const model::Measurement& now) noexcept;

  [[nodiscard]] bool is_known() const noexcept { return !line_.is_empty(); }
  [[nodiscard]] bool is_closed() const noexcept { return line_.is_closed(); }
  /// The reference line in W.
  [[nodiscard]] const path::Path& line() const noexcept { return line_; }
  [[nodiscard]] SpeedPlan::Sample speed(double s) const noexcept { return speed_plan_.at(s); }

  struct Room {
    double left = 0.0;   ///< [m]
    double right = 0.0;  ///< [m]
  };
  /// Room for the centre of mass beside the reference line at arc length s.
  [[nodiscard]] Room room(double s) const noexcept;
  /// Increases with every new plan: positions along an older line mean nothing any more.
  [[nodiscard]] unsigned revision() const noexcept { return revision_; }

 private:
  void rebuild() noexcept;
  bool smooth() noexcept;

  RoadOptions options_;
  model::VehicleParams vehicle_;
  WaypointMap map_;
  path::Path raw_;   ///< through the waypoints
  path::Path line_;  ///< smoothed
  SpeedPlan speed_plan_;
  std::vector<Vec2> knots_;
  std::vector<double> offset_;  ///< of the line from the raw path, by knot [m]
  int knot_count_ = 0;
  unsigned revision_ = 0;
  LineSmoother smoother_;
};

}  // namespace chicane::controller
