// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>

#include "chicane/solver/small_qp.hpp"

namespace chicane::solver {

/// One stage of the linear-quadratic problem in homogeneous coordinates z = (δx, 1, δu): gradient and defect
/// ride along as one more row and column, so that the whole stage is two products and one elimination
/// (docs/solver.md, eq. 8–11). Rows are padded to whole vectors; the padding is zero.
template <std::size_t Nx, std::size_t Nu>
struct LqStage {
  static constexpr std::size_t kOne = Nx;                         ///< index of the constant 1 in z
  static constexpr std::size_t kHead = Nx + 1;                    ///< size of (δx, 1)
  static constexpr std::size_t kSize = Nx + 1 + Nu;               ///< size of z
  static constexpr std::size_t kWidth = (kSize + 3) / 4 * 4;      ///< padded row of z
  static constexpr std::size_t kHeadWidth = (kHead + 3) / 4 * 4;  ///< padded row of (δx, 1)

  double F[Nx][kWidth]{};     ///< δx⁺ = F z with F = [A | defect | B]
  double L[kSize][kWidth]{};  ///< stage cost ½ zᵀ L z, symmetric
  double low[Nu]{};           ///< bounds on δu
  double high[Nu]{};
  Hold hold[Nu]{};                ///< working set: which inputs stand at a bound
  double gain[Nu][kHeadWidth]{};  ///< δu = gain (δx, 1)
  double gradient[Nu][kWidth]{};  ///< d(cost to go)/dδu = gradient z
};

/// Solves min Σ ½ zᵀLz + ½ (δx_N, 1)ᵀ P_N (δx_N, 1) s.t. δx₀ = 0, δx⁺ = F z, low <= δu <= high for one
/// horizon. A backward sweep eliminates stage by stage with the inputs of the working set held at their
/// bounds; a forward sweep finds the step and corrects the working set. Repeating both until nothing changes
/// is the primal-dual active set method (Hintermüller, Ito, Kunisch 2003). No allocation; time per sweep O(N
/// (Nx + Nu)³).
template <std::size_t Nx, std::size_t Nu, std::size_t Capacity>
class Riccati {
 public:
  using Stage = LqStage<Nx, Nu>;

  Stage stage[Capacity];
  double terminal[Stage::kHead][Stage::kHeadWidth]{};  ///< P_N
  double dx[Capacity + 1][Nx]{};                       ///< step of the states
  double du[Capacity][Nu]{};                           ///< step of the inputs

  /// Factorises with `shift` added to the input block. `choose`: take the working set of each stage from its
  /// own small box problem instead of the stored one (that is control-limited differential dynamic
  /// programming; the step then descends). Returns the largest extra shift that an indefinite input block
  /// needed; 0 when none did.
  double backward(std::size_t horizon, double shift, bool choose) noexcept {
    double P[Stage::kHead][Stage::kHeadWidth] = {};
    std::copy(&terminal[0][0], &terminal[0][0] + Stage::kHead * Stage::kHeadWidth, &P[0][0]);
    double largest = 0.0;
    for (std::size_t k = horizon; k-- > 0;)
      largest = std::max(largest, eliminate(stage[k], P, shift, choose));
    return largest;
  }

  /// What the forward sweep does with inputs that contradict the working set.
  enum class Repair { kAll, kLast, kClip };

  /// Computes dx and du, and corrects the working set: all contradicting inputs at once, only the last one,
  /// or none while du is cut to its bounds. Returns how many inputs contradicted it.
  int forward(std::size_t horizon, Repair repair) noexcept {
    int contradictions = 0;
    Hold* last = nullptr;
    Hold last_hold = Hold::kFree;
    std::fill(dx[0], dx[0] + Nx, 0.0);
    for (std::size_t k = 0; k < horizon; ++k) {
      Stage& s = stage[k];
      double z[Stage::kWidth] = {};
      std::copy(dx[k], dx[k] + Nx, z);
      z[Stage::kOne] = 1.0;
      for (std::size_t m = 0; m < Nu; ++m) {
        double u = dot(s.gain[m], z, Stage::kHead);
        if (repair == Repair::kClip) u = std::min(std::max(u, s.low[m]), s.high[m]);
        z[Stage::kHead + m] = du[k][m] = u;
      }
      for (std::size_t m = 0; m < Nu; ++m) {
        const double slope = dot(s.gradient[m], z, Stage::kSize);
        const Hold next =
            next_hold(s.hold[m], du[k][m], slope, s.low[m], s.high[m], s.gradient[m][Stage::kHead + m]);
        if (next == s.hold[m]) continue;
        ++contradictions;
        if (repair == Repair::kAll) s.hold[m] = next;
        last = &s.hold[m];
        last_hold = next;
      }
      for (std::size_t i = 0; i < Nx; ++i) dx[k + 1][i] = dot(s.F[i], z, Stage::kSize);
    }
    if (repair == Repair::kLast && last != nullptr) *last = last_hold;
    return contradictions;
  }

 private:
  static double dot(const double* a, const double* b, std::size_t n) noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) sum += a[i] * b[i];
    return sum;
  }

  /// One stage backwards: the value function P of stage k + 1 becomes that of stage k (eq. 10–11).
  static double eliminate(Stage& s, double (&P)[Stage::kHead][Stage::kHeadWidth], double shift,
                          bool choose) noexcept {
    double Q[Stage::kSize][Stage::kWidth];
    add_cost_to_go(s, P, Q);
    const double extra = settle_inputs(s, Q, shift, choose);
    for (std::size_t m = Nu; m-- > 0;) {
      const std::size_t c = Stage::kHead + m;
      if (s.hold[m] == Hold::kFree) {
        const double inverse = 1.0 / Q[c][c];
        for (std::size_t i = 0; i < c; ++i) {
          const double factor = Q[c][i] * inverse;
          for (std::size_t j = 0; j < Stage::kWidth; ++j) Q[i][j] -= factor * Q[c][j];
        }
        for (std::size_t j = 0; j < c; ++j) Q[c][j] *= -inverse;
      } else {
        const double b = s.hold[m] == Hold::kLow ? s.low[m] : s.high[m];
        for (std::size_t i = 0; i < c; ++i) Q[i][Stage::kOne] += b * Q[i][c];
        for (std::size_t j = 0; j < c; ++j) Q[Stage::kOne][j] += b * Q[c][j];
        Q[Stage::kOne][Stage::kOne] += b * b * Q[c][c];
        for (std::size_t j = 0; j < c; ++j) Q[c][j] = 0.0;
        Q[c][Stage::kOne] = b;
      }
    }
    for (std::size_t m = 0; m < Nu; ++m) {  // an input depends on the earlier ones: make the gains explicit
      for (std::size_t j = 0; j < Stage::kHead; ++j) {
        double value = Q[Stage::kHead + m][j];
        for (std::size_t l = 0; l < m; ++l) value += Q[Stage::kHead + m][Stage::kHead + l] * s.gain[l][j];
        s.gain[m][j] = value;
      }
    }
    for (std::size_t i = 0; i < Stage::kHead; ++i) {  // rounding must not grow into asymmetry
      for (std::size_t j = i; j < Stage::kHead; ++j) P[i][j] = P[j][i] = Q[i][j];
    }
    return extra;
  }

  /// Q = L + F̂ᵀ P F̂ with F̂ = [F; e_one] (eq. 9). Jacobians are mostly zeros: both products go by the entries
  /// of F that are not.
  static void add_cost_to_go(const Stage& s, const double (&P)[Stage::kHead][Stage::kHeadWidth],
                             double (&Q)[Stage::kSize][Stage::kWidth]) noexcept {
    double PF[Stage::kSize][Stage::kHeadWidth] = {};  // (P F̂)ᵀ
    std::copy(P[Stage::kOne], P[Stage::kOne] + Stage::kHeadWidth, PF[Stage::kOne]);
    for (std::size_t i = 0; i < Nx; ++i) {
      for (std::size_t j = 0; j < Stage::kSize; ++j) {
        if (s.F[i][j] != 0.0) add_scaled<Stage::kHeadWidth>(s.F[i][j], P[i], PF[j]);
      }
    }
    double W[Stage::kHead][Stage::kWidth] = {};
    for (std::size_t r = 0; r < Stage::kHead; ++r) {
      for (std::size_t j = 0; j < Stage::kSize; ++j) W[r][j] = PF[j][r];
    }
    std::copy(&s.L[0][0], &s.L[0][0] + Stage::kSize * Stage::kWidth, &Q[0][0]);
    add_scaled<Stage::kWidth>(1.0, W[Stage::kOne], Q[Stage::kOne]);
    for (std::size_t r = 0; r < Nx; ++r) {
      for (std::size_t i = 0; i < Stage::kSize; ++i) {
        if (s.F[r][i] != 0.0) add_scaled<Stage::kWidth>(s.F[r][i], W[r], Q[i]);
      }
    }
  }

  template <std::size_t Width>
  static void add_scaled(double factor, const double* row, double* sum) noexcept {
    for (std::size_t j = 0; j < Width; ++j) sum[j] += factor * row[j];
  }

  /// Shifts the input block until its free part is positive definite, chooses the working set when asked, and
  /// keeps the input rows for the multipliers. Returns the extra shift.
  static double settle_inputs(Stage& s, double (&Q)[Stage::kSize][Stage::kWidth], double shift,
                              bool choose) noexcept {
    SmallQp<Nu> box;
    for (std::size_t m = 0; m < Nu; ++m) {
      for (std::size_t l = 0; l < Nu; ++l) box.H[m][l] = Q[Stage::kHead + m][Stage::kHead + l];
      box.H[m][m] += shift;
      box.g[m] = Q[Stage::kHead + m][Stage::kOne];
      box.low[m] = s.low[m];
      box.high[m] = s.high[m];
      box.hold[m] = choose ? Hold::kFree : s.hold[m];
    }
    const double extra = box.make_positive();
    if (choose) box.solve();
    for (std::size_t m = 0; m < Nu; ++m) {
      const std::size_t c = Stage::kHead + m;
      s.hold[m] = box.hold[m];
      Q[c][c] = box.H[m][m];
      std::copy(Q[c], Q[c] + Stage::kWidth, s.gradient[m]);
    }
    return extra;
  }
};

}  // namespace chicane::solver
