// SPDX-License-Identifier: MIT
// Vec2: a vector of two doubles in a plane.
#pragma once

#include <cmath>

namespace chicane {

/// A point, direction or force in a plane; two doubles, zero by default. Operations round in the order in
/// which their formulas are written, so that results have the same bits everywhere.
class Vec2 {
 public:
  constexpr Vec2() noexcept = default;
  constexpr Vec2(double x, double y) noexcept : x_{x}, y_{y} {}

  [[nodiscard]] constexpr double x() const noexcept { return x_; }
  [[nodiscard]] constexpr double y() const noexcept { return y_; }
  [[nodiscard]] constexpr double& x() noexcept { return x_; }
  [[nodiscard]] constexpr double& y() noexcept { return y_; }

  constexpr Vec2& operator+=(const Vec2& b) noexcept { return *this = *this + b; }
  constexpr Vec2& operator-=(const Vec2& b) noexcept { return *this = *this - b; }
  constexpr Vec2& operator*=(double s) noexcept { return *this = *this * s; }
  constexpr Vec2& operator/=(double s) noexcept { return *this = *this / s; }

  [[nodiscard]] friend constexpr Vec2 operator+(const Vec2& a, const Vec2& b) noexcept {
    return {a.x_ + b.x_, a.y_ + b.y_};
  }
  [[nodiscard]] friend constexpr Vec2 operator-(const Vec2& a, const Vec2& b) noexcept {
    return {a.x_ - b.x_, a.y_ - b.y_};
  }
  [[nodiscard]] friend constexpr Vec2 operator-(const Vec2& a) noexcept { return {-a.x_, -a.y_}; }
  [[nodiscard]] friend constexpr Vec2 operator*(const Vec2& a, double s) noexcept {
    return {a.x_ * s, a.y_ * s};
  }
  [[nodiscard]] friend constexpr Vec2 operator*(double s, const Vec2& a) noexcept { return a * s; }
  [[nodiscard]] friend constexpr Vec2 operator/(const Vec2& a, double s) noexcept {
    return {a.x_ / s, a.y_ / s};
  }
  [[nodiscard]] friend constexpr bool operator==(const Vec2& a, const Vec2& b) noexcept = default;

  [[nodiscard]] constexpr double dot(const Vec2& b) const noexcept { return x_ * b.x_ + y_ * b.y_; }
  /// Component of a × b out of the plane; positive where b points to the left of a.
  [[nodiscard]] constexpr double cross(const Vec2& b) const noexcept { return x_ * b.y_ - y_ * b.x_; }
  [[nodiscard]] constexpr double squared_norm() const noexcept { return dot(*this); }
  /// Length, by sqrt(): the last bits of std::hypot depend on the library.
  [[nodiscard]] double norm() const noexcept { return std::sqrt(squared_norm()); }
  [[nodiscard]] bool is_finite() const noexcept { return std::isfinite(x_) && std::isfinite(y_); }

 private:
  double x_ = 0.0, y_ = 0.0;
};

/// Smaller value of each component, and the greater value below.
[[nodiscard]] constexpr Vec2 min(const Vec2& a, const Vec2& b) noexcept {
  return {b.x() < a.x() ? b.x() : a.x(), b.y() < a.y() ? b.y() : a.y()};
}
[[nodiscard]] constexpr Vec2 max(const Vec2& a, const Vec2& b) noexcept {
  return {a.x() < b.x() ? b.x() : a.x(), a.y() < b.y() ? b.y() : a.y()};
}

}  // namespace chicane
