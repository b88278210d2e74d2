// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>

#include "chicane/base/inlining.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/solver/detail/small_qp.hpp"

namespace chicane::solver {

/// The inputs' part of one stage's elimination: their curvature H and slope g, and the inverse of the free
/// part of H as adjugate · scale (so that the rest of the stage need not wait for the division). Rows and
/// columns of held inputs are zero in it. In closed form for up to three inputs.
template <class Arch, std::size_t Nu>
struct InputBlock {
  double H[Nu][Nu];
  double g[Nu];
  double adjugate[Nu][Nu];
  double scale;

  /// Inverts the free part. False, and no inverse, when that is not safely positive definite.
  [[nodiscard]] CHICANE_INLINE bool invert(const bool (&is_held)[Nu]) noexcept {
    double A[Nu][Nu];
    unroll<Nu>([&](auto m) CHICANE_INLINE {
      unroll<Nu>([&](auto l)
                     CHICANE_INLINE { A[m][l] = is_held[m] || is_held[l] ? (m == l ? 1.0 : 0.0) : H[m][l]; });
    });
    const bool positive = invert_all(A);
    unroll<Nu>([&](auto m) CHICANE_INLINE { adjugate[m][m] = is_held[m] ? 0.0 : adjugate[m][m]; });
    return positive;
  }
  /// The same where no input is held.
  [[nodiscard]] CHICANE_INLINE bool invert() noexcept { return invert_all(H); }

  /// Row m of the adjugate times v.
  [[nodiscard]] CHICANE_INLINE double adjugate_times(std::size_t m, const double (&v)[Nu]) const noexcept {
    double sum = adjugate[m][0] * v[0];
    unroll<Nu - 1>([&](auto l)
                       CHICANE_INLINE { sum = fused_multiply_add<Arch>(adjugate[m][l + 1], v[l + 1], sum); });
    return sum;
  }

  /// Adds the smallest of a rising series of shifts that makes the free part positive definite, and inverts
  /// it; returns the shift.
  [[gnu::noinline, gnu::cold]] double shift_and_invert(const bool (&is_held)[Nu]) noexcept {
    double diagonal = 0.0;
    for (std::size_t m = 0; m < Nu; ++m)
      diagonal = std::fabs(H[m][m]) > diagonal ? std::fabs(H[m][m]) : diagonal;
    double added = 0.0;
    for (int attempt = 0; attempt < 40; ++attempt) {
      const double more = added > 0.0 ? 3.0 * added : 1e-8 * (1.0 + diagonal);
      for (std::size_t m = 0; m < Nu; ++m) H[m][m] += more;
      added += more;
      if (invert(is_held)) break;
    }
    return added;
  }

 private:
  /// A pivot this small beside its own entry is noise.
  CHICANE_INLINE static double noise(double entry) noexcept { return 1e-10 * std::fabs(entry) + 1e-12; }
  /// a d − b c
  CHICANE_INLINE static double cross(double a, double d, double b, double c) noexcept {
    return fused_negative_multiply_add<Arch>(b, c, a * d);
  }

  [[nodiscard]] CHICANE_INLINE bool invert_all(const double (&A)[Nu][Nu]) noexcept {
    if constexpr (Nu == 1) {
      adjugate[0][0] = 1.0;
      scale = 1.0 / A[0][0];
      return A[0][0] > 1e-12;
    } else if constexpr (Nu == 2) {
      const double determinant = cross(A[0][0], A[1][1], A[1][0], A[1][0]);
      scale = 1.0 / determinant;
      adjugate[0][0] = A[1][1];
      adjugate[1][1] = A[0][0];
      adjugate[0][1] = adjugate[1][0] = -A[1][0];
      return (A[1][1] > 1e-12) & (determinant > noise(A[0][0]) * A[1][1]);
    } else if constexpr (Nu == 3) {
      adjugate[0][0] = cross(A[1][1], A[2][2], A[2][1], A[2][1]);
      adjugate[0][1] = adjugate[1][0] = cross(A[2][0], A[2][1], A[1][0], A[2][2]);
      adjugate[0][2] = adjugate[2][0] = cross(A[1][0], A[2][1], A[2][0], A[1][1]);
      adjugate[1][1] = cross(A[0][0], A[2][2], A[2][0], A[2][0]);
      adjugate[1][2] = adjugate[2][1] = cross(A[1][0], A[2][0], A[0][0], A[2][1]);
      adjugate[2][2] = cross(A[0][0], A[1][1], A[1][0], A[1][0]);
      const double minor = adjugate[0][0];
      const double determinant = fused_multiply_add<Arch>(
          A[2][0], adjugate[2][0], fused_multiply_add<Arch>(A[1][0], adjugate[1][0], A[0][0] * minor));
      scale = 1.0 / determinant;
      return (A[2][2] > 1e-12) & (minor > noise(A[1][1]) * A[2][2]) & (determinant > noise(A[0][0]) * minor);
    } else {
      return eliminate(A);
    }
  }

  /// Gauss and Jordan, last input first.
  bool eliminate(const double (&A)[Nu][Nu]) noexcept {
    bool positive = true;
    scale = 1.0;
    for (std::size_t m = 0; m < Nu; ++m) {
      for (std::size_t l = 0; l < Nu; ++l) adjugate[m][l] = A[m][l];
    }
    for (std::size_t p = Nu; p-- > 0;) {
      positive = positive && adjugate[p][p] > noise(A[p][p]);
      const double pivot = 1.0 / adjugate[p][p];
      for (std::size_t m = 0; m < Nu; ++m) {
        if (m == p) continue;
        const double factor = adjugate[m][p] * pivot;
        for (std::size_t l = 0; l < Nu; ++l) {
          if (l != p)
            adjugate[m][l] = fused_negative_multiply_add<Arch>(factor, adjugate[p][l], adjugate[m][l]);
        }
        adjugate[m][p] = -factor;
      }
      for (std::size_t l = 0; l < Nu; ++l) {
        if (l != p) adjugate[p][l] *= pivot;
      }
      adjugate[p][p] = pivot;
    }
    return positive;
  }
};

}  // namespace chicane::solver
