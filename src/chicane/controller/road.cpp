// SPDX-License-Identifier: MIT
#include "chicane/controller/road.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "chicane/base/math.hpp"

namespace chicane::controller {
namespace {

constexpr double kKnotSpacing = 3.0;  // [m] wanted between knots of the line
constexpr double kOverlap = 250.0;    // [m] a closed line is smoothed beyond its seam on both sides
constexpr int kMaxKnots = 2400;       // 7 km of road at 3 m
constexpr int kOpenWindow = 18;       // last waypoints used while the lap is not closed

}  // namespace

/// The line of least bending near a given one, as an optimal control problem along it (docs/tracking.md, eq.
/// 6–9): state offset n, n', n''; input n'''. Curvature of the new line: κ (1 + κ n) + n'' to first order.
struct Road::Smoother {
  struct Problem {
    static constexpr int kNx = 3;
    static constexpr int kNu = 1;
    static constexpr int kNr = 4;
    static constexpr int kNe = 2;
    static constexpr int kNc = 0;
    static constexpr double kBending = 1.0;  // price of curvature, times [1/m]
    static constexpr double kKeep = 2e-4;    // price of leaving the given line, per metre
    static constexpr double kEdge =
        5e-3;  // price of reaching the allowed width; smooth, as it grows with the eighth power

    static constexpr double kReturn = 15.0;  // [m]

    double h = kKnotSpacing;    // knot spacing [m]
    double slope_length = 4.0;  // [m] price of the curvature's slope relative to curvature
    double width = 1.5;         // allowed offset [m]
    std::array<double, kMaxKnots + 2> curvature{};

    /// n''' of an input: the input on top of a return to the given line within about kReturn, so that what is
    /// done at one end of a long road does not shake the other.
    template <class T>
    static T third(const std::array<T, kNx>& x, const std::array<T, kNu>& u) noexcept {
      constexpr double q = 1.0 / kReturn;
      return u[0] - q * (3.0 * x[2] + q * (3.0 * x[1] + q * x[0]));
    }
    template <class T>
    std::array<T, kNx> dynamics(int, const std::array<T, kNx>& x,
                                const std::array<T, kNu>& u) const noexcept {
      const T n3 = third(x, u);
      return {x[0] + h * (x[1] + (0.5 * h) * (x[2] + (h / 3.0) * n3)), x[1] + h * (x[2] + (0.5 * h) * n3),
              x[2] + h * n3};
    }
    template <class T>
    std::array<T, kNr> residual(int k, const std::array<T, kNx>& x,
                                const std::array<T, kNu>& u) const noexcept {
      const double kappa = curvature[static_cast<std::size_t>(k)];
      const double slope = (curvature[static_cast<std::size_t>(k + 1)] - kappa) / h;
      return {kBending * (x[2] + kappa * kappa * x[0] + kappa),
              (kBending * slope_length) * (third(x, u) + slope), kKeep * x[0],
              kEdge * fourth_power(x[0] * (1.0 / width))};
    }
    template <class T>
    std::array<T, kNe> terminal_residual(const std::array<T, kNx>& x) const noexcept {
      return {1e-2 * x[0], 0.1 * x[1]};
    }
    template <class T>
    std::array<T, kNc> constraint(int, const std::array<T, kNx>&, const std::array<T, kNu>&) const noexcept {
      return {};
    }
    std::array<double, kNu> input_lower(int) const noexcept { return {-1.0}; }
    std::array<double, kNu> input_upper(int) const noexcept { return {1.0}; }

   private:
    template <class T>
    static T fourth_power(const T& n) noexcept {
      const T n2 = n * n;
      return n2 * n2;
    }
  };

  Problem problem;
  solver::OcpSolver<Problem, kMaxKnots> solver{
      {.tolerance = 1e-5, .loose_tolerance = 1e-2, .max_iterations = 30, .second_order = false}};
  solver::Trajectory<3, 1, kMaxKnots> trajectory;
};

Road::Road(const RoadOptions& options, const model::VehicleParams& vehicle)
    : options_{options},
      vehicle_{vehicle},
      raw_{path::Path::with_capacity(WaypointMap::kCapacity)},
      line_{path::Path::with_capacity(WaypointMap::kCapacity)},
      smoother_{std::make_unique<Smoother>()} {
  knots_.reserve(static_cast<std::size_t>(kMaxKnots));
  offset_.reserve(static_cast<std::size_t>(kMaxKnots));
  // Eq. 9: what the curvature's slope costs relative to curvature is the yaw inertia against the tyres'
  // share.
  const double yaw_length =
      vehicle.yaw_inertia / (vehicle.mass * vehicle.rear_axle) / std::max(0.05, 1.0 - vehicle.steer_helper);
  smoother_->problem.slope_length = std::clamp(yaw_length, 1.0, 10.0);
  smoother_->problem.width = options.smoothing_width;
}

Road::~Road() = default;

void Road::reset() noexcept {
  map_.clear();
  knot_count_ = 0;
  line_ = path::Path::with_capacity(WaypointMap::kCapacity);
  ++revision_;
}

void Road::add(const model::Measurement& now) noexcept {
  if (!options_.remember_waypoints && !map_.points().empty()) {
    const bool is_new =
        now.waypoint_count > 0 && (map_.points().front() - now.waypoints[0]).norm() > WaypointMap::kSame;
    if (is_new) map_.clear();
  }
  if (map_.add(now)) rebuild();
}

void Road::rebuild() noexcept {
  std::span<const Vec2> points = map_.points();
  if (!map_.is_closed() && points.size() > static_cast<std::size_t>(kOpenWindow))
    points = points.last(static_cast<std::size_t>(kOpenWindow));
  if (points.size() < 3 || !raw_.rebuild(points, map_.is_closed())) return;
  if (!smooth()) return;
  speed_plan_.rebuild(line_, vehicle_, options_.speed);
  ++revision_;
}

bool Road::smooth() noexcept {
  const bool closed = raw_.is_closed();
  const double overlap = closed ? kOverlap : 0.0;
  const double wanted = raw_.length() + 2.0 * overlap;
  const double spacing = std::max(kKnotSpacing, wanted / (kMaxKnots - 2));
  const int intervals = std::max(4, static_cast<int>(std::ceil(raw_.length() / spacing)));
  knot_spacing_ = raw_.length() / intervals;
  const int extra = static_cast<int>(overlap / knot_spacing_);
  const int total = intervals + 2 * extra;

  Smoother::Problem& problem = smoother_->problem;
  problem.h = knot_spacing_;
  for (int k = 0; k <= total; ++k) {
    problem.curvature[static_cast<std::size_t>(k)] = raw_.at((k - extra) * knot_spacing_).curvature;
  }
  auto& trajectory = smoother_->trajectory;
  trajectory.horizon = total;
  trajectory.u.fill({0.0});
  trajectory.x.fill({0.0, 0.0, 0.0});
  bool use = options_.smoothing_width > 0.0;
  if (use)
    use = usable(smoother_->solver.solve(problem, {0.0, 0.0, 0.0}, trajectory, Deadline::never()).status);

  knot_count_ = closed ? intervals : intervals + 1;
  knots_.clear();
  offset_.clear();
  for (int k = 0; k < knot_count_; ++k) {
    const path::PathPoint at = raw_.at(k * knot_spacing_);
    const double n = use ? trajectory.x[static_cast<std::size_t>(k + extra)][0] : 0.0;
    offset_.push_back(n);
    knots_.emplace_back(at.position.x() - n * sin(at.heading), at.position.y() + n * cos(at.heading));
  }
  return line_.rebuild(knots_, closed);
}

Road::Room Road::room(double s) const noexcept {
  if (knot_count_ < 2) return {options_.half_width, options_.half_width};
  const double position =
      line_.wrap(s) / line_.length() * (line_.is_closed() ? knot_count_ : knot_count_ - 1);
  const int i = std::clamp(static_cast<int>(position), 0, knot_count_ - 1);
  const int j = line_.is_closed() ? (i + 1) % knot_count_ : std::min(i + 1, knot_count_ - 1);
  const double share = std::clamp(position - i, 0.0, 1.0);
  const double n = offset_[static_cast<std::size_t>(i)] +
                   share * (offset_[static_cast<std::size_t>(j)] - offset_[static_cast<std::size_t>(i)]);
  return {options_.half_width - n, options_.half_width + n};
}

}  // namespace chicane::controller
