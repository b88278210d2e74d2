// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "chicane/road/instalments.hpp"

namespace chicane::road {

/// The line of least bending within a strip around a given one (docs/controller.md, eq. 6–9): minimises,
/// over the offsets n to the left at equally spaced knots,
///
///     Σ κ_new² + ℓ² (Δκ_new/h)² + w n²,      κ_new = κ (1 + κ n) + (n₋ − 2 n + n₊)/h²
///
/// The strip |n| <= width is kept by raising the weight w where n is too large and lowering it elsewhere, a
/// few passes over. ℓ is the length over which the car's yaw inertia makes a change of curvature as dear as
/// curvature itself. Each pass is one positive definite system with three entries beside the diagonal: a
/// sweep forwards, a sweep back.
///
/// All memory is reserved at construction. The work comes in instalments of about 10 ns; a whole smoothing is
/// work_for() of them.
class LineSmoother {
 public:
  explicit LineSmoother(int capacity);
  /// width [m]; 0 leaves the line where it is. slope_length ℓ [m].
  void configure(double width, double slope_length) noexcept;

  /// A new line: `knots` of them [6, capacity], `spacing` [m] apart. The caller fills curvature() before
  /// advance(). With `period` > 0 the line closes after so many knots and goes on round: places `period`
  /// apart are the same and have the same weight.
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
    double forward = 0.0;            ///< of L y = right, over D
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

}  // namespace chicane::road
