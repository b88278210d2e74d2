// SPDX-License-Identifier: MIT
// Fit of the line ahead in the car's frame, and roll-forward over the latency, for the controller
// `cubic-mpc`.
#include "chicane/controller/cubic_problem.hpp"

#include <algorithm>
#include <cmath>

namespace chicane::controller {
namespace {

constexpr std::size_t kRows = model::Measurement::kMaxWaypoints;  // limit of fitted points
constexpr std::size_t kColumns = 4;                               // coefficients of a cubic

/// Least length of a column after elimination of the columns before it, over its full length; chosen above
/// rounding. A shorter column adds no information.
constexpr double kRankTolerance = 1e-9;

/// Waypoints in the frame of `car`; `to_local` turns their offsets from the car in W.
template <class Convert>
LocalPoints convert(const model::Measurement& now, const model::Pose& car, const Convert& to_local) noexcept {
  LocalPoints local;
  const int count = std::clamp(now.waypoint_count, 0, model::Measurement::kMaxWaypoints);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const Vec2 point = to_local(now.waypoints[i].x() - car.x, now.waypoints[i].y() - car.y);
    if (std::isfinite(point.x()) && std::isfinite(point.y()))
      local.points[static_cast<std::size_t>(local.count++)] = point;
  }
  return local;
}

/// Least squares of y = c0 + c1 t + c2 t² + c3 t³ over points, by Householder QR: R c = Qᵀ y.
class LeastSquares {
 public:
  explicit LeastSquares(int order) noexcept : used_columns_{static_cast<std::size_t>(order) + 1} {}

  /// Adds a point.
  void add(double t, double y) noexcept {
    double power = 1.0;
    for (auto& column : columns_) {
      column[rows_] = power;
      power *= t;
    }
    y_[rows_++] = y;
  }

  /// Coefficients c0 … c3; 0 for powers that the points do not determine.
  std::array<double, kColumns> solve() noexcept {
    std::array<bool, kColumns> is_used{};
    std::array<double, kColumns> diagonal{};
    std::array<std::size_t, kColumns> pivot_row{};
    std::size_t row = 0;
    for (std::size_t j = 0; j < used_columns_ && row < rows_; ++j) {
      const double rest = norm(columns_[j], row);
      if (rest <= kRankTolerance * norm(columns_[j], 0)) continue;
      pivot_row[j] = row;
      diagonal[j] = reflect(j, row, rest);
      is_used[j] = true;
      ++row;
    }
    std::array<double, kColumns> c{};
    for (std::size_t j = kColumns; j-- > 0;) {
      if (!is_used[j]) continue;
      double sum = y_[pivot_row[j]];
      for (std::size_t k = j + 1; k < kColumns; ++k) sum -= columns_[k][pivot_row[j]] * c[k];
      c[j] = sum / diagonal[j];
    }
    return c;
  }

 private:
  using Column = std::array<double, kRows>;

  /// Length of a column from row `from` on.
  double norm(const Column& column, std::size_t from) const noexcept {
    double sum = 0.0;
    for (std::size_t i = from; i < rows_; ++i) sum += column[i] * column[i];
    return std::sqrt(sum);
  }

  /// Applies to all columns after column j, and to y, the Householder reflection that maps column j, from
  /// `row` on, to (diagonal, 0, …). `length`: norm of column j from `row` on. Returns the diagonal.
  double reflect(std::size_t j, std::size_t row, double length) noexcept {
    const double diagonal = columns_[j][row] > 0.0 ? -length : length;
    Column normal = columns_[j];
    normal[row] -= diagonal;
    const double scale = 2.0 / (norm(normal, row) * norm(normal, row));
    const auto apply = [&](Column& column) {
      double dot = 0.0;
      for (std::size_t i = row; i < rows_; ++i) dot += normal[i] * column[i];
      for (std::size_t i = row; i < rows_; ++i) column[i] -= scale * dot * normal[i];
    };
    for (std::size_t k = j + 1; k < kColumns; ++k) apply(columns_[k]);
    apply(y_);
    return diagonal;
  }

  std::array<Column, kColumns> columns_{};  ///< powers of t by point
  Column y_{};
  std::size_t used_columns_;  ///< order + 1
  std::size_t rows_ = 0;      ///< number of points
};

}  // namespace

LocalPoints to_car_frame(const model::Measurement& now, const model::Pose& car) noexcept {
  const double cosine = cos(car.psi);
  const double sine = sin(car.psi);
  return convert(now, car, [=](double dx, double dy) {
    return Vec2{cosine * dx + sine * dy, cosine * dy - sine * dx};
  });
}

LocalPoints to_car_frame_polar(const model::Measurement& now, const model::Pose& car) noexcept {
  return convert(now, car, [&](double dx, double dy) {
    const double radius = hypot(dx, dy);
    const double angle = atan2(dy, dx) - car.psi;
    return Vec2{radius * cos(angle), radius * sin(angle)};
  });
}

bool fit_cubic(std::span<const Vec2> points, Cubic& fit, int order) noexcept {
  CHICANE_ASSERT(order >= 1 && order <= 3);
  CHICANE_ASSERT(points.size() <= kRows);
  if (points.size() < 2) return false;
  double low = points[0].x();
  double high = low;
  for (const Vec2& point : points) {
    low = std::min(low, point.x());
    high = std::max(high, point.x());
  }
  if (!(high - low > 1e-3)) return false;  // [m] extent along x: 1 mm

  // Scale to powers of t = x / scale in [-1, 1], because powers of x itself differ by a factor of a million.
  const double scale = std::max(std::fabs(low), std::fabs(high));
  LeastSquares system{order};
  for (const Vec2& point : points) system.add(point.x() / scale, point.y());
  fit.c = system.solve();
  double unit = 1.0;
  for (double& coefficient : fit.c) {
    coefficient /= unit;
    unit *= scale;
  }
  return true;
}

namespace {

/// Largest latency that is taken from a measured loop time [s]: beyond it the clock is wrong, not the loop
/// late; chosen.
constexpr double kMaxLatency = 0.5;

/// Equation 14 (docs/the_five_systems.md): x and y move on by the latency [s].
Motion roll_position(const Motion& from, double latency) noexcept {
  Motion to = from;
  to.pose.x += from.speed * cos(from.pose.psi) * latency;
  to.pose.y += from.speed * sin(from.pose.psi) * latency;
  return to;
}

/// Equation 15: one Euler step of the kinematic model over the latency, ψ += v δ L / L_f, v += a L. The
/// throttle of `acting` is taken for the acceleration a [m/s²].
Motion roll_kinematic(const Motion& from, const model::Command& acting, double latency,
                      double kinematic_length) noexcept {
  Motion to = roll_position(from, latency);
  to.pose.psi += from.speed * acting.steer / kinematic_length * latency;
  to.speed += acting.throttle * latency;
  return to;
}

/// Equation 16, which goes with the measured latency: ψ += v tan δ L / L_f + a tan δ L² / (2 L_f).
/// `has_term`: with the last term, of the acceleration.
Motion roll_accelerating(const Motion& from, const model::Command& acting, double latency,
                         double kinematic_length, bool has_term) noexcept {
  const double curvature = tan(acting.steer) / kinematic_length;
  Motion to = roll_position(from, latency);
  const double term = has_term ? 0.5 * acting.throttle * curvature * latency * latency : 0.0;
  to.pose.psi += from.speed * curvature * latency + term;
  to.speed += acting.throttle * latency;
  return to;
}

}  // namespace

Motion RollForward::predict(const model::Measurement& now) noexcept {
  const double unit = is_rolled() ? speed_unit_ : 1.0;
  Motion rolled = roll(now, {{now.x, now.y, now.psi}, now.speed * unit});
  rolled.speed /= unit;
  return rolled;
}

Motion RollForward::roll(const model::Measurement& now, const Motion& seen) noexcept {
  const model::Command acting{now.steer, now.throttle};
  switch (handling_) {
    case LatencyHandling::kNone:
    case LatencyHandling::kInsideModel:
      return seen;
    case LatencyHandling::kPositionOnly:
      return roll_position(seen, latency_);
    case LatencyHandling::kRollForward:
      return roll_kinematic(seen, acting, latency_, kinematic_length_);
    case LatencyHandling::kMeasured:
      if (std::isfinite(now.delay)) latency_ = 0.5 * (latency_ + std::clamp(now.delay, 0.0, kMaxLatency));
      return roll_accelerating(seen, acting, latency_, kinematic_length_, has_term_);
  }
  return seen;
}

double RollForward::compensated() const noexcept { return is_rolled() ? latency_ : 0.0; }

}  // namespace chicane::controller
