// SPDX-License-Identifier: MIT
// Planning of a line to drive by, in instalments: smoothing within a strip, samples, and speeds.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "chicane/model/stability.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/road/waypoint_map.hpp"

namespace chicane::road {

/// Position in work that is spread over control cycles: numbered phases, each with a loop that stops when a
/// cycle's units of work are used up and continues in the next cycle. Depends on counted work, never on a
/// clock.
class Instalments {
 public:
  /// Returns to the first turn of the first phase's loop.
  void restart() noexcept { phase_ = next_ = 0; }
  [[nodiscard]] int phase() const noexcept { return phase_; }

  /// Calls turn(i) for the next i below `end` while there is `work`, and takes `cost` off it for each. After
  /// the last turn the next phase begins.
  template <class Turn>
  void loop(int end, int cost, int& work, Turn&& turn) noexcept {
    for (; next_ < end && work > 0; ++next_, work -= cost) turn(next_);
    if (next_ < end) return;
    enter(phase_ + 1);
  }
  /// Begins a phase.
  void enter(int phase) noexcept {
    phase_ = phase;
    next_ = 0;
  }

 private:
  int phase_ = 0;
  int next_ = 0;  ///< next turn of the phase's loop
};

/// The line of least bending within a strip around a given one (docs/controller.md, eq. 6–9): minimises,
/// over the offsets n to the left at equally spaced knots,
///
///     Σ κ_new² + ℓ² (Δκ_new/h)² + w n²,      κ_new = κ (1 + κ n) + (n₋ − 2 n + n₊)/h²
///
/// Ten passes keep the line in the strip |n| <= width: each raises the weight w where n is too large, and
/// lowers it elsewhere. ℓ is the length by which the car's yaw inertia gives a change of curvature the cost
/// of curvature itself. Each pass solves one positive definite system with three off-diagonals.
///
/// All memory is reserved at construction. Works in instalments: a unit of work takes about 10 ns, and a
/// whole smoothing 33 units for each knot.
class LineSmoother {
 public:
  explicit LineSmoother(int capacity);
  /// Sets half the width of the strip [m]; 0 leaves the line where it is. `slope_length`: ℓ [m].
  void configure(double width, double slope_length) noexcept;

  /// Begins a line of `knots` knots in [6, capacity], `spacing` [m] apart. The caller fills curvature()
  /// before advance(). With `period` > 0 the line is closed: knots `period` apart are the same point and have
  /// the same weight.
  void begin(int knots, double spacing, int period) noexcept;
  /// Curvature of the given line at each knot [1/m], left positive.
  [[nodiscard]] std::span<double> curvature() noexcept { return curvature_; }
  /// Does up to `work` units and takes them off `work`; true when the offsets are computed.
  [[nodiscard]] bool advance(int& work) noexcept;
  /// Offset to the left at knot k [m]. Pre: advance() returned true.
  [[nodiscard]] double offset(int k) const noexcept { return offset_[static_cast<std::size_t>(k)]; }

 private:
  /// Row k of the system (A + w) n = right, and of its factors L D Lᵀ.
  struct Row {
    std::array<double, 4> band{};    ///< A(k, k), A(k, k−1), A(k, k−2), A(k, k−3) without the weight
    double right = 0.0;              ///< right side
    std::array<double, 4> factor{};  ///< 1/D, L(k, k−1), L(k, k−2), L(k, k−3)
    double forward = 0.0;            ///< forward solution of L y = right, over D
    double root_weight = 0.0;        ///< √w [1/m²]
  };
  void assemble(int k) noexcept;      ///< adds the cost of inner knot k to A and the right side
  void add_bending(int k) noexcept;   ///< adds κ_new² of knot k
  void add_slope(int k) noexcept;     ///< adds ℓ² (Δκ_new/h)² between knots k and k + 1
  void eliminate(int k) noexcept;     ///< factorises row k of A + w, and solves L y = right forwards
  void substitute(int k) noexcept;    ///< solves for the offset of knot k backwards
  void raise_weight(int k) noexcept;  ///< multiplies √w of knot k by |n| / width, within bounds
  [[nodiscard]] Row& row(int k) noexcept { return rows_[static_cast<std::size_t>(k + kMargin)]; }

  static constexpr int kMargin = 3;  ///< zero rows before the first and behind the last; the off-diagonals

  double width_ = 1.0;         ///< half the width of the strip [m]
  double slope_length_ = 4.0;  ///< ℓ [m]
  double spacing_ = 3.0;       ///< h [m]
  int knots_ = 0;
  int period_ = 0;  ///< knots of a closed line's lap; 0: open
  Instalments instalments_;
  std::vector<double> curvature_;  ///< κ of the given line by knot [1/m]
  std::vector<double> offset_;     ///< n by knot [m]
  std::vector<Row> rows_;
};

/// Limits of the speed plan: shares of the modelled forces, and assumptions.
struct SpeedPlanOptions {
  double speed_limit = 60.0;    ///< highest planned speed [m/s]
  double grip_share = 0.9;      ///< share of the tyres' lateral force; (0, 1]
  double brake_share = 0.8;     ///< share of the braking; (0, 1]
  double drive_share = 1.0;     ///< share of the drive; (0, 1]
  double end_curvature = 0.05;  ///< curvature assumed beyond the end of an open line, out of sight [1/m]

  friend bool operator==(const SpeedPlanOptions&, const SpeedPlanOptions&) = default;
};

/// Fastest speed along a line within the modelled grip: a limit for each sample from curvature and its slope,
/// then a forward pass for the drive and a backward pass for the brakes, which leaves the car stable
/// (docs/controller.md, eq. 10–14c). The curvature slope κ' counts because turning the body takes tyre force,
/// too:
///
///     v² |(1 − h) κ + i κ'| <= grip · friction · load(v),   i = I/(m b) at the front axle, −I/(m a) at the
///     rear.
///
/// Memory is reserved at construction. Works in instalments: 12 units of about 10 ns for each sample.
class SpeedPlan {
 public:
  explicit SpeedPlan(int capacity) { demand_.resize(static_cast<std::size_t>(capacity)); }

  /// Begins a plan for `vehicle`. Takes 0.1 ms if that is not the vehicle of the last plan.
  void begin(const model::VehicleParams& vehicle, const SpeedPlanOptions& options) noexcept;
  /// Does up to `work` units and takes them off `work`; true when every sample of the line has its speed and
  /// limiter. Pre: the same line from begin() on, with at most `capacity` samples.
  [[nodiscard]] bool advance(int& work, ReferenceLine& line) noexcept;

 private:
  void limit(ReferenceLine& line, int i) noexcept;          ///< speed of sample i by curvature
  void finish_limits(ReferenceLine& line) noexcept;         ///< speed at the end of an open line, by sight
  void accelerate(ReferenceLine& line, int turn) noexcept;  ///< turn of the forward pass
  void brake(ReferenceLine& line, int turn) noexcept;       ///< turn of the backward pass

  model::VehicleParams vehicle_;
  model::BrakingStability stability_{vehicle_};  ///< limit of braking that keeps the car stable
  SpeedPlanOptions options_;
  Instalments instalments_;
  std::vector<double> demand_;  ///< tyre force per v² [1/m], by sample
  int slowest_ = 0;             ///< sample of the lowest limit, where the passes round a closed line begin
};

/// Options of a planned line.
struct LinePlannerOptions {
  double smoothing_width = 1.5;  ///< largest distance from the waypoint line [m]; 0: the waypoint line itself
  SpeedPlanOptions speed{};

  friend bool operator==(const LinePlannerOptions&, const LinePlannerOptions&) = default;
};

/// Plans the line to drive by from a stretch or a lap of the waypoint line: takes knots, smooths them, moves
/// them sideways, samples at equal spacing, and sets speeds. Works in instalments, so that a whole lap is
/// planned during the drive: a unit of work takes about 10 ns, and a metre of line about 20 units.
///
/// Memory is reserved at construction; nothing here allocates.
class LinePlanner {
 public:
  static constexpr double kSampleSpacing = 1.5;  ///< largest spacing of samples [m]; half a knot's
  /// Knots by which a lap is continued beyond both ends for its smoothing: 250 m, beyond which one bend
  /// hardly moves another.
  static constexpr int kOverlap = 84;

  /// Planner for stretches of up to `knots` knots.
  explicit LinePlanner(int knots);
  /// Sets options and vehicle of lines begun from now on.
  void configure(const LinePlannerOptions& options, const model::VehicleParams& vehicle) noexcept;

  /// Begins a line along the part of a waypoint line from `from` to `to` [m]; a lap has the same point at
  /// both. False when it has no length, or too many knots.
  [[nodiscard]] bool begin(double from, double to, bool is_lap) noexcept;
  /// Does up to `work` units. True when `line` is planned. Until then `line` is unusable, and `source` must
  /// not change in the part of begin().
  [[nodiscard]] bool advance(int work, const WaypointLine& source, ReferenceLine& line) noexcept;

  /// Largest number of samples of a line planned from `knots` knots. Derived from the spacings: two samples
  /// to a knot, and a quarter more for lines that are longer than the waypoint line.
  [[nodiscard]] static constexpr int samples_for(int knots) noexcept { return 5 * knots / 2 + 2; }

 private:
  /// Knot of the new line.
  struct Moved {
    CurvePoint curve;
    double offset = 0.0;  ///< offset to the left of the waypoint line [m]
    double s = 0.0;       ///< along the new line [m]
  };
  void take(const WaypointLine& source,
            int k) noexcept;                          ///< copies knot k, and its curvature to the smoother
  [[nodiscard]] double offset(int k) const noexcept;  ///< offset of knot k to the left [m]
  void move(int k) noexcept;                          ///< computes moved_[k]
  bool shape(ReferenceLine& line) noexcept;           ///< makes room for samples; false: too long
  void sample(ReferenceLine& line, int i) noexcept;   ///< computes the curve of sample i

  model::VehicleParams vehicle_;
  LinePlannerOptions options_;
  LineSmoother smoother_;
  SpeedPlan speed_plan_;
  Instalments instalments_;
  std::vector<CurvePoint> knots_;  ///< knots of the waypoint line
  std::vector<Moved> moved_;       ///< knots of the new line
  double from_ = 0.0;              ///< start along the waypoint line [m]
  double length_ = 0.0;            ///< along the waypoint line [m]
  double spacing_ = 1.0;           ///< spacing of the knots [m]
  int intervals_ = 0;              ///< between knots
  int extra_ = 0;                  ///< knots of the overlap at each end; 0 for a stretch
  int behind_ = 0;                 ///< moved knot before the last sample
  bool is_lap_ = false;
};

}  // namespace chicane::road
