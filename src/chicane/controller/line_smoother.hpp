// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>

#include "chicane/path/path.hpp"
#include "chicane/solver/ocp_solver.hpp"

namespace chicane::controller {

/// The line of least bending within a strip around a given one (docs/tracking.md, eq. 6–9): minimises, along
/// the line,
///
///     Σ κ_new² + ℓ² (dκ_new/ds)² + w n²,      κ_new = κ (1 + κ n) + n'',      |n| <= width
///
/// over the offset n to the left. A linear optimal control problem with state (n, n', n'') and input n''';
/// the strip is kept by raising the price w of offset where n is too large and lowering it elsewhere, a few
/// passes over. ℓ is the length over which the car's yaw inertia makes a change of curvature as dear as
/// curvature itself.
///
/// All memory is reserved at construction; smooth() allocates nothing and costs about 20 µs per knot.
class LineSmoother {
 public:
  static constexpr int kMaxKnots = 2400;

  /// width [m], slope_length ℓ [m].
  LineSmoother(double width, double slope_length);
  /// For the next smooth().
  void configure(double width, double slope_length) noexcept;

  /// Offsets for knots k = 0..count-1 at arc lengths k · spacing of `line`; count·spacing covers it (closed:
  /// exactly once). False, and all offsets zero, when there is nothing to do or no answer. Pre: count +
  /// overlap <= kMaxKnots.
  [[nodiscard]] bool smooth(const path::Path& line, double spacing, int count) noexcept;
  /// Offset to the left at knot k of the last call [m].
  [[nodiscard]] double offset(int k) const noexcept;
  /// Knots that fit for a closed line of this length [m], beside the overlap at its seam.
  [[nodiscard]] static int knots_for(double length, bool closed) noexcept;

 private:
  static constexpr double kOverlap = 250.0;  ///< [m] a closed line is continued beyond its seam on both sides

  struct Problem {
    static constexpr int kNx = 3;
    static constexpr int kNu = 1;
    static constexpr int kNr = 3;
    static constexpr int kNe = 2;
    static constexpr int kNc = 0;
    static constexpr double kReturn = 15.0;  ///< [m]

    double h = 3.0;             ///< knot spacing [m]
    double slope_length = 4.0;  ///< ℓ [m]
    std::array<double, kMaxKnots + 2> curvature{};
    std::array<double, kMaxKnots + 2> root_price{};  ///< √w by knot [1/m²]

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
      const auto i = static_cast<std::size_t>(k);
      const double kappa = curvature[i];
      const double slope = (curvature[i + 1] - kappa) / h;
      return {x[2] + kappa * kappa * x[0] + kappa, slope_length * (third(x, u) + slope),
              root_price[i] * x[0]};
    }
    template <class T>
    std::array<T, kNe> terminal_residual(const std::array<T, kNx>& x) const noexcept {
      return {1e-2 * x[0], 0.1 * x[1]};
    }
    std::array<double, kNu> input_lower(int) const noexcept { return {-1e3}; }
    std::array<double, kNu> input_upper(int) const noexcept { return {1e3}; }
  };
  struct Workspace {
    Problem problem;
    solver::OcpSolver<Problem, kMaxKnots> solver{
        {.tolerance = 1e-7, .loose_tolerance = 1e-3, .max_iterations = 3, .second_order = false}};
    solver::Trajectory<3, 1, kMaxKnots> trajectory;
  };

  double width_;
  int extra_ = 0;  ///< knots of the overlap on each side
  int count_ = 0;
  bool is_valid_ = false;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace chicane::controller
