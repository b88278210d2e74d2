// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "chicane/model/stability.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/road/reference_line.hpp"
#include "chicane/road/waypoint_map.hpp"

namespace chicane::road {

/// Work spread over control cycles: loops that stop when a cycle's share is used up and continue in the next
/// one. A cycle's part depends on the counted work alone, never on a clock.
class Instalments {
 public:
  /// Back to the first turn of the first loop.
  void restart() noexcept { phase_ = next_ = 0; }
  [[nodiscard]] int phase() const noexcept { return phase_; }

  /// Turns next..end-1 of the loop of this phase, each of which takes `cost` of `work`, as far as the work
  /// goes. At the end of the loop the next phase begins.
  template <class Turn>
  void loop(int end, int cost, int& work, Turn&& turn) noexcept {
    for (; next_ < end && work > 0; ++next_, work -= cost) turn(next_);
    if (next_ < end) return;
    enter(phase_ + 1);
  }
  /// Goes to a phase without a loop.
  void enter(int phase) noexcept {
    phase_ = phase;
    next_ = 0;
  }

 private:
  int phase_ = 0;
  int next_ = 0;
};

/// The line of least bending within a strip around a given one (docs/controller.md, eq. 6–9): minimises,
/// over the offsets n to the left at equally spaced knots,
///
///     Σ κ_new² + ℓ² (Δκ_new/h)² + w n²,      κ_new = κ (1 + κ n) + (n₋ − 2 n + n₊)/h²
///
/// The strip |n| <= width is kept by raising the weight w where n is too large and lowering it elsewhere, a
/// few passes over. ℓ is the length over which the car's yaw inertia makes a change of curvature as dear as
/// curvature itself. Each pass is one positive definite system with three off-diagonals: a sweep forwards, a
/// sweep back.
///
/// All memory is reserved at construction. The work comes in instalments of about 10 ns; a whole smoothing is
/// 33 of them for each knot.
class LineSmoother {
 public:
  explicit LineSmoother(int capacity);
  /// width [m]; 0 leaves the line where it is. slope_length ℓ [m].
  void configure(double width, double slope_length) noexcept;

  /// A new line: `knots` of them [6, capacity], `spacing` [m] apart. The caller fills curvature() before
  /// advance(). With `period` > 0 the line closes after so many knots and repeats: places `period` apart are
  /// the same and have the same weight.
  void begin(int knots, double spacing, int period) noexcept;
  [[nodiscard]] std::span<double> curvature() noexcept { return curvature_; }  ///< [1/m]
  /// Does up to `work` and takes it off; true when the offsets are there.
  [[nodiscard]] bool advance(int& work) noexcept;
  /// Offset to the left at knot k [m]. Pre: advance() said true.
  [[nodiscard]] double offset(int k) const noexcept { return offset_[static_cast<std::size_t>(k)]; }

 private:
  struct Row {
    std::array<double, 4> band{};  ///< A(k, k), A(k, k−1), A(k, k−2), A(k, k−3) without the weight
    double right = 0.0;
    std::array<double, 4> factor{};  ///< 1/D, L(k, k−1), L(k, k−2), L(k, k−3)
    double forward = 0.0;            ///< forward solution of L y = right, over D
    double root_weight = 0.0;        ///< √w [1/m²]
  };
  void assemble(int k) noexcept;
  void add_bending(int k) noexcept;
  void add_slope(int k) noexcept;
  void eliminate(int k) noexcept;
  void substitute(int k) noexcept;
  void raise_weight(int k) noexcept;
  [[nodiscard]] Row& row(int k) noexcept { return rows_[static_cast<std::size_t>(k + kMargin)]; }

  static constexpr int kMargin = 3;  ///< rows before the first and behind the last, always zero

  double width_ = 1.0;
  double slope_length_ = 4.0;
  double spacing_ = 3.0;
  int knots_ = 0;
  int period_ = 0;
  Instalments instalments_;
  std::vector<double> curvature_;
  std::vector<double> offset_;
  std::vector<Row> rows_;
};

/// Shares of the modelled tyre and brake force for the speed plan.
struct SpeedPlanOptions {
  double speed_limit = 60.0;    ///< [m/s]
  double grip_share = 0.9;      ///< share of the tyres' lateral force; (0, 1]
  double brake_share = 0.8;     ///< share of the braking; (0, 1]
  double drive_share = 1.0;     ///< share of the drive; (0, 1]
  double end_curvature = 0.05;  ///< assumed behind the end of an open line [1/m]: sight limits the speed

  friend bool operator==(const SpeedPlanOptions&, const SpeedPlanOptions&) = default;
};

/// Fastest speed along a line within the modelled grip: a limit for each place from curvature and its slope,
/// then a forward pass for the drive and a backward pass for the brakes, which leaves the car stable
/// (docs/controller.md, eq. 10–14c). A point mass cannot do better; a car whose yaw lags must not either,
/// hence the curvature slope: turning the body takes tyre force, too,
///
///     v² |(1 − h) κ + i κ'| <= grip · friction · load(v),   i = I/(m b) at the front axle, −I/(m a) at the
///     rear.
///
/// Memory is reserved at construction. The work comes in instalments of about 10 ns, 12 for each sample.
class SpeedPlan {
 public:
  explicit SpeedPlan(int capacity) { demand_.resize(static_cast<std::size_t>(capacity)); }

  /// A new plan, for this car. One that is not the last one's takes 0.1 ms.
  void begin(const model::VehicleParams& vehicle, const SpeedPlanOptions& options) noexcept;
  /// Does up to `work` and takes it off; true when every sample of the line has its speed and limiter. Pre:
  /// the same line, at most of the capacity, from begin() on.
  [[nodiscard]] bool advance(int& work, ReferenceLine& line) noexcept;

 private:
  void limit(ReferenceLine& line, int i) noexcept;
  void finish_limits(ReferenceLine& line) noexcept;
  void accelerate(ReferenceLine& line, int turn) noexcept;
  void brake(ReferenceLine& line, int turn) noexcept;

  model::VehicleParams vehicle_;
  model::BrakingStability stability_{vehicle_};
  SpeedPlanOptions options_;
  Instalments instalments_;
  std::vector<double> demand_;  ///< tyre force per v² [1/m], by sample
  int slowest_ = 0;             ///< sample of the lowest limit: the passes round a closed line begin there
};

struct LinePlannerOptions {
  double smoothing_width = 1.5;  ///< the line may leave the waypoint line by this much [m]; 0 = not at all
  SpeedPlanOptions speed{};

  friend bool operator==(const LinePlannerOptions&, const LinePlannerOptions&) = default;
};

/// Plans the line to drive by from a stretch of the waypoint line, or a lap of it: takes knots, smooths them,
/// moves them sideways, samples at equal spacing, and sets speeds. Works in instalments, so that a whole lap
/// is planned during the drive: a unit of work is about 10 ns, a metre of line takes about 20.
///
/// Memory is reserved at construction; nothing here allocates.
class LinePlanner {
 public:
  static constexpr double kSampleSpacing = 1.5;  ///< [m] at most
  static constexpr int kOverlap = 84;            ///< knots a lap is smoothed on beyond both ends

  /// Planner for stretches of up to `knots` knots.
  explicit LinePlanner(int knots);
  void configure(const LinePlannerOptions& options, const model::VehicleParams& vehicle) noexcept;

  /// The stretch from `from` to `to` [m] of a waypoint line. A lap ends where it begins. False when it has no
  /// length, or too many knots.
  [[nodiscard]] bool begin(double from, double to, bool is_lap) noexcept;
  /// Does up to `work`. True when `line` is planned; until then it is not to be used, and `source` must not
  /// change there.
  [[nodiscard]] bool advance(int work, const WaypointLine& source, ReferenceLine& line) noexcept;

  /// Number of samples of a line planned from `knots` knots.
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
