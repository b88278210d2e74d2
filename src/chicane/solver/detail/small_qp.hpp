// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "chicane/base/compiler.hpp"
#include "chicane/base/instruction_set.hpp"
#include "chicane/base/pack.hpp"

namespace chicane::solver {

/// State of an input in the working set: free, or at one of its bounds.
enum class Hold : std::int8_t { kLow = -1, kFree = 0, kHigh = 1 };

/// Working-set rule of the primal-dual active set method: an input beyond a bound becomes held there; a held
/// one whose cost falls towards the inside (`slope` = dJ/du) becomes free. `curvature` scales the tolerance.
/// An input whose bounds are equal is always held.
[[nodiscard]] CHICANE_INLINE inline Hold next_hold(Hold hold, double u, double slope, double low, double high,
                                                   double curvature) noexcept {
  constexpr double kTolerance = 1e-10;  // [unit of the input] rounding of an input; chosen
  constexpr double kRounding = 1e-3;    // rounding of a slope over curvature times kTolerance; chosen
  if (!(high > low)) return Hold::kLow;
  if (hold == Hold::kFree) {
    if (u > high + kTolerance) return Hold::kHigh;
    return u < low - kTolerance ? Hold::kLow : Hold::kFree;
  }
  const double inward =
      hold == Hold::kLow ? -slope : slope;  // > 0: the cost falls when the input leaves the bound
  return inward > kTolerance * (1.0 + kRounding * std::fabs(curvature)) ? Hold::kFree : hold;
}

/// Box problem of one stage: min ½ uᵀ H u + gᵀ u s.t. low <= u <= high for a few inputs. `Arch` only
/// separates the code of files that are compiled for different instruction sets.
template <std::size_t N, class Arch = arch::Native>
struct SmallQp {
  double H[N][N]{};
  double g[N]{};
  double low[N]{};
  double high[N]{};
  Hold hold[N]{};
  double u[N]{};

  /// Adds shifts to the diagonal until the free block is positive definite; returns their sum. The first is
  /// 1e-8 of the diagonal, each further one three times the sum of those before (chosen).
  double make_positive() noexcept {
    double diagonal = 0.0;
    for (std::size_t i = 0; i < N; ++i) diagonal = std::max(diagonal, std::fabs(H[i][i]));
    double added = 0.0;
    for (int attempt = 0; attempt < 40 && !is_positive(); ++attempt) {
      const double more = added > 0.0 ? 3.0 * added : 1e-8 * (1.0 + diagonal);
      for (std::size_t i = 0; i < N; ++i) H[i][i] += more;
      added += more;
    }
    return added;
  }

  /// Finds u and the working set by active-set iterations, or by coordinate descent if they cycle.
  void solve() noexcept {
    for (std::size_t iteration = 0; iteration < 4 * N; ++iteration) {
      solve_free();
      bool changed = false;
      for (std::size_t i = 0; i < N; ++i) {
        double slope = g[i];
        for (std::size_t j = 0; j < N; ++j) slope += H[i][j] * u[j];
        const Hold next = next_hold(hold[i], u[i], slope, low[i], high[i], H[i][i]);
        changed = changed || next != hold[i];
        hold[i] = next;
      }
      if (!changed) return;
    }
    descend();
  }

 private:
  /// Whether the free block is safely positive definite.
  [[nodiscard]] bool is_positive() const noexcept {
    double A[N][N];
    std::copy(&H[0][0], &H[0][0] + N * N, &A[0][0]);
    for (std::size_t m = N; m-- > 0;) {  // the order in which the stage eliminates
      if (hold[m] != Hold::kFree) continue;
      if (!(A[m][m] > 1e-10 * std::fabs(H[m][m]) + 1e-12)) return false;
      for (std::size_t i = 0; i < m; ++i) {
        for (std::size_t j = 0; j < m; ++j) A[i][j] -= A[i][m] * A[m][j] / A[m][m];
      }
    }
    return true;
  }

  /// Sets held inputs to their bounds and solves for the free ones.
  void solve_free() noexcept {
    double A[N][N];
    double b[N];
    for (std::size_t i = 0; i < N; ++i) {
      if (hold[i] != Hold::kFree) u[i] = hold[i] == Hold::kLow ? low[i] : high[i];
    }
    for (std::size_t i = 0; i < N; ++i) {
      b[i] = -g[i];
      for (std::size_t j = 0; j < N; ++j) {
        A[i][j] = H[i][j];
        if (hold[j] != Hold::kFree) b[i] -= H[i][j] * u[j];
      }
    }
    for (std::size_t m = N; m-- > 0;) {
      if (hold[m] != Hold::kFree) continue;
      for (std::size_t i = 0; i < m; ++i) {
        const double factor = A[i][m] / A[m][m];
        for (std::size_t j = 0; j < m; ++j) A[i][j] -= factor * A[m][j];
        b[i] -= factor * b[m];
      }
    }
    for (std::size_t m = 0; m < N; ++m) {
      if (hold[m] != Hold::kFree) continue;
      double value = b[m];
      for (std::size_t j = 0; j < m; ++j) {
        if (hold[j] == Hold::kFree) value -= A[m][j] * u[j];
      }
      u[m] = value / A[m][m];
    }
  }

  /// Coordinate descent: 50 rounds (chosen).
  void descend() noexcept {
    for (std::size_t i = 0; i < N; ++i) u[i] = std::clamp(0.0, low[i], high[i]);
    for (int round = 0; round < 50; ++round) {
      for (std::size_t i = 0; i < N; ++i) {
        double slope = g[i];
        for (std::size_t j = 0; j < N; ++j) slope += H[i][j] * u[j];
        u[i] = std::clamp(u[i] - slope / H[i][i], low[i], high[i]);
      }
    }
    for (std::size_t i = 0; i < N; ++i)
      hold[i] = u[i] <= low[i] ? Hold::kLow : (u[i] >= high[i] ? Hold::kHigh : Hold::kFree);
  }
};

/// Inputs in the elimination of one stage: their curvature H and slope g, and the inverse of the free part of
/// H as adjugate · scale, so that the rest of the stage need not wait for the division. Its rows and columns
/// of held inputs are zero. In closed form for up to three inputs.
template <class Arch, std::size_t Nu>
struct InputBlock {
  double H[Nu][Nu];
  double g[Nu];
  double adjugate[Nu][Nu];
  double scale;

  /// Inverts the free part. False, without an inverse, if it is not safely positive definite.
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
  /// Inverts H when no input is held.
  [[nodiscard]] CHICANE_INLINE bool invert() noexcept { return invert_all(H); }

  /// Row m of the adjugate times v.
  [[nodiscard]] CHICANE_INLINE double adjugate_times(std::size_t m, const double (&v)[Nu]) const noexcept {
    double sum = adjugate[m][0] * v[0];
    unroll<Nu - 1>([&](auto l)
                       CHICANE_INLINE { sum = fused_multiply_add<Arch>(adjugate[m][l + 1], v[l + 1], sum); });
    return sum;
  }

  /// Adds shifts as SmallQp::make_positive() does, and inverts the free part; returns their sum.
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
  /// Limit below which a pivot is noise, relative to its own entry.
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

  /// Inverts by Gauss–Jordan elimination, last input first.
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
