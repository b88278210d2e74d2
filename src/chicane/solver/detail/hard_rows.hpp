// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "chicane/base/math.hpp"
#include "chicane/base/math_pack.hpp"
#include "chicane/solver/detail/bound_barrier.hpp"
#include "chicane/solver/detail/filter.hpp"
#include "chicane/solver/detail/iterate.hpp"
#include "chicane/solver/sparse_row.hpp"

namespace chicane::solver {

/// Whether some residuals of a problem stand for rows that must hold (detail/augmented.hpp): those behind its
/// own.
template <class P>
inline constexpr bool kHasHardRows = requires {
  P::kOwnResiduals;
};
template <class P>
[[nodiscard]] constexpr std::size_t own_residuals() noexcept {
  if constexpr (kHasHardRows<P>) return P::kOwnResiduals;
  return P::kNr;
}

/// Rows that must hold inside the primal-dual method (docs/solver_hard.md, eq. 50–54): equalities of stages
/// and end with multipliers y, inequalities of the end with slacks t > 0 and multipliers z > 0. The problem's
/// functions return them as residuals √ρ (h + shift); linearisations store those here with their derivatives.
template <class P, std::size_t Capacity, class Arch>
class HardRows {
 public:
  static constexpr std::size_t kNx = P::kNx, kNu = P::kNu, kNz = kNx + kNu;
  static constexpr std::size_t kStageRows = P::kEqualities;
  static constexpr std::size_t kEqualities = P::kEndEqualities;
  static constexpr std::size_t kEndRows = kEqualities + P::kEndConstraints;
  using V = Stages<Arch>;
  using Step = Iterate<kNx, kNu, Capacity>;

  // ---- what linearisations leave here
  template <class Row>
  CHICANE_INLINE void store(std::size_t n, std::size_t k, const Row& r) noexcept {
    r.v.store(value_[n] + k);
    if constexpr (AnySparseRow<Row>) {
      for (auto& slope : row_[n]) V(0.0).store(slope + k);
      r.each_slope([&](std::size_t j, const V& slope) { slope.store(row_[n][j] + k); });
    } else if constexpr (AnyJet<Row>) {
      jet::repeat<size_of(Row::kFirst)>([&](auto i) CHICANE_INLINE {
        constexpr int j = member_of(Row::kFirst, i);
        jet::number<V>(jet::slope<j>(r)).store(row_[n][j] + k);
      });
    } else {
      for (std::size_t j = 0; j < kNz; ++j) r.slopes[j].store(row_[n][j] + k);
    }
  }
  void store_end(std::size_t n, double value) noexcept {
    end_value_[n] = value;
    is_there_[n] = true;
    std::fill(std::begin(end_row_[n]), std::end(end_row_[n]), 0.0);
  }
  void store_end_slope(std::size_t n, std::size_t i, double slope) noexcept { end_row_[n][i] = slope; }

  // ---- the method

  /// No multipliers yet, and equalities of hardly any weight: of the guess the costs alone are to be seen.
  void begin(P& problem) noexcept {
    problem.is_primal_dual = true;
    for (auto& weight : problem.equality_weight) weight.set(kNearlyNone);
    for (auto& weight : problem.terminal_weight) weight.set(kNearlyNone);
    for (auto& shift : problem.equality_shift) shift.values.fill(0.0);
    problem.terminal_shift.fill(0.0);
    std::fill(std::begin(is_there_), std::end(is_there_), false);
    std::fill(std::begin(end_value_), std::end(end_value_), 0.0);
    for (auto& row : end_row_) std::fill(std::begin(row), std::end(row), 0.0);
    value_ = {};
    row_ = {};
  }
  /// From now on with ρ, multipliers as they are.
  void weigh(P& problem, double rho) noexcept {
    rho_ = rho;
    const auto set = [&](auto& weight, auto& shifts) {
      for (double& shift : shifts) shift *= weight.rho / rho;
      weight.set(rho);
    };
    for (std::size_t n = 0; n < kStageRows; ++n)
      set(problem.equality_weight[n], problem.equality_shift[n].values);
    for (std::size_t n = 0; n < kEqualities; ++n) {
      problem.terminal_shift[n] *= problem.terminal_weight[n].rho / rho;
      problem.terminal_weight[n].set(rho);
    }
  }
  /// Slacks of the end's inequalities, whose values are `g`, with some room; multipliers on the central path.
  template <class Values>
  void centre(P& problem, const Values& g, double mu) noexcept {
    for (std::size_t n = kEqualities; n < kEndRows; ++n) {
      t_[n] = std::max(-g[n], kPush * std::max(1.0, std::fabs(g[n])));
      z_[n] = mu / t_[n];
    }
    set_ends(problem, mu);
  }
  /// After a change of t, z or μ: residuals √ρ (g + shift) with ρ = z/t that pull as much as the eliminated
  /// slack (eq. 53).
  void set_ends(P& problem, double mu) noexcept {
    for (std::size_t n = kEqualities; n < kEndRows; ++n) {
      problem.terminal_weight[n].set(z_[n] / t_[n]);
      problem.terminal_shift[n] = t_[n] + mu / z_[n];
    }
  }

  /// The same after a change of μ alone; `slope`, the gradient of the end, follows.
  void set_ends(P& problem, double mu, double* slope) noexcept {
    for (std::size_t n = kEqualities; n < kEndRows; ++n) {
      if (!is_there_[n]) continue;
      const double shift = t_[n] + mu / z_[n];
      const double change = problem.terminal_weight[n].root * (shift - problem.terminal_shift[n]);
      problem.terminal_shift[n] = shift;
      end_value_[n] += change;
      for (std::size_t i = 0; i < kNx; ++i) slope[i] += change * end_row_[n][i];
    }
  }

  /// Multipliers, and how far they and slacks may be followed, of a step from the present iterate.
  StepLengths find(const P& problem, const Step& step, double mu, double fraction) noexcept {
    slope_ = 0.0;
    for (std::size_t n = 0; n < kStageRows; ++n) {
      const double root = problem.equality_weight[n].root;
      V slope(0.0);
      for (std::size_t k = 0; k < step.horizon; k += 8) {
        V change(0.0);
        for (std::size_t i = 0; i < kNx; ++i) change += V::load(row_[n][i] + k) * V::load(step.x[i] + k);
        for (std::size_t m = 0; m < kNu; ++m)
          change += V::load(row_[n][kNx + m] + k) * V::load(step.u[m] + k);
        const V value = V::load(value_[n] + k);
        const auto live =
            stage_number(StageLanes<V>{static_cast<int>(k)}) < V(static_cast<double>(step.horizon));
        slope += select(live, value * change, V(0.0));
        const V shift = problem.equality_shift[n].at(StageLanes<V>{static_cast<int>(k)});
        select(live, (value + change) * (1.0 / root) - shift, V(0.0)).store(dshift_[n] + k);
      }
      slope_ -= sum(slope);
    }
    StepLengths lengths;
    for (std::size_t n = 0; n < kEndRows; ++n) {
      double change = 0.0;
      for (std::size_t i = 0; i < kNx; ++i) change += end_row_[n][i] * step.x[i][step.horizon];
      const double root = problem.terminal_weight[n].root, shift = problem.terminal_shift[n];
      if (!is_there_[n]) continue;
      slope_ -= end_value_[n] * change;
      const double linear = (end_value_[n] + change) / root - shift;  // h + J δx
      dend_[n] = linear;
      if (n < kEqualities) continue;
      dt_[n] = -linear - t_[n];
      dz_[n] = root * (end_value_[n] + change) - z_[n];
      slope_ -= mu * dt_[n] / t_[n];
      lengths.primal = std::min(lengths.primal, fraction / std::max(-dt_[n] / t_[n], 1e-30));
      lengths.dual = std::min(lengths.dual, fraction / std::max(-dz_[n] / z_[n], 1e-30));
    }
    return lengths;
  }
  /// Slope along the direction of what the rows cost, less what the stages' gradients have of them.
  [[nodiscard]] double slope() const noexcept { return slope_; }

  /// What eight stages from k on miss of row n, whose residual is `value`.
  [[nodiscard]] static V miss(const P& problem, std::size_t n, std::size_t k, const V& value) noexcept {
    const V shift = problem.equality_shift[n].at(StageLanes<V>{static_cast<int>(k)});
    return abs(value * (1.0 / problem.equality_weight[n].root) - shift);
  }
  /// Adds miss and logarithms of the end, whose rows are `h`, at `length` of the direction.
  template <class Values>
  void measure_end(const Values& h, double length, Merit& merit) noexcept {
    for (std::size_t n = 0; n < kEqualities; ++n) merit.miss += std::fabs(h[n]);
    for (std::size_t n = kEqualities; n < kEndRows; ++n) {
      if (!is_there_[n]) continue;
      t_at_[n] = t_[n];
      if (length > 0.0) t_at_[n] = std::max(t_[n] + length * dt_[n], -h[n]);  // more room costs nothing
      merit.miss += std::fabs(h[n] + t_at_[n]);
      merit.logs += log(t_at_[n]);
    }
  }
  /// Largest residual of the rows and of their complementarity at the present iterate.
  [[nodiscard]] double residual(const P& problem, double mu, double unit,
                                std::size_t horizon) const noexcept {
    double worst = 0.0;
    for (std::size_t n = 0; n < kStageRows; ++n) {
      for (std::size_t k = 0; k < horizon; ++k) {
        const double h = value_[n][k] / problem.equality_weight[n].root - problem.equality_shift[n].values[k];
        worst = std::max(worst, unit * std::fabs(h));
      }
    }
    for (std::size_t n = 0; n < kEndRows; ++n) {
      if (!is_there_[n]) continue;
      const double h = end_value_[n] / problem.terminal_weight[n].root - problem.terminal_shift[n];
      worst = std::max(worst, unit * std::fabs(n < kEqualities ? h : h + t_[n]));
      if (n >= kEqualities) worst = std::max(worst, std::fabs(t_[n] * z_[n] - mu));
    }
    return worst;
  }
  /// What the end's residuals pull at state i beyond their multipliers.
  [[nodiscard]] double excess(const P& problem, std::size_t i) const noexcept {
    double sum = 0.0;
    for (std::size_t n = 0; n < kEndRows; ++n)
      sum += (end_value_[n] - end_weight(problem, n)) * end_row_[n][i];
    return sum;
  }
  /// The multiplier of row n of the end over √ρ.
  [[nodiscard]] double end_weight(const P& problem, std::size_t n) const noexcept {
    const auto& weight = problem.terminal_weight[n];
    return n < kEqualities ? weight.root * problem.terminal_shift[n] : z_[n] / weight.root;
  }

  /// Multipliers of equalities by `length` of their direction, slacks to where the last measure() was, their
  /// multipliers by `dual_length`.
  void move(P& problem, double length, double dual_length, double mu, std::size_t horizon) noexcept {
    constexpr double kFar = 1e10;
    for (std::size_t n = 0; n < kStageRows; ++n) {
      for (std::size_t k = 0; k < horizon; ++k) problem.equality_shift[n].values[k] += length * dshift_[n][k];
    }
    for (std::size_t n = 0; n < kEqualities; ++n) problem.terminal_shift[n] += length * dend_[n];
    for (std::size_t n = kEqualities; n < kEndRows; ++n) {
      if (!is_there_[n]) continue;
      t_[n] = t_at_[n];
      const double z = z_[n] + dual_length * dz_[n];
      z_[n] = std::min(std::max(z, mu / (kFar * t_[n])), kFar * mu / t_[n]);
    }
    set_ends(problem, mu);
  }
  /// Back to an augmented Lagrangian, with the multipliers that were found.
  void end(P& problem) noexcept {
    problem.is_primal_dual = false;
    for (std::size_t n = kEqualities; n < kEndRows; ++n) {
      problem.terminal_weight[n].set(rho_);
      problem.terminal_shift[n] = is_there_[n] ? z_[n] / rho_ : 0.0;
    }
  }

 private:
  static constexpr std::size_t kStride = kStageStride<Capacity>;
  static constexpr double kPush = 1e-2;
  static constexpr double kNearlyNone = 1e-12;
  template <class T, std::size_t N>
  using Of = std::array<T, (N > 0 ? N : 1)>;
  struct alignas(64) Line {
    double values[kStride]{};
    operator double*() noexcept { return values; }
    operator const double*() const noexcept { return values; }
  };

  Of<Line, kStageRows> value_{}, dshift_{};
  Of<std::array<Line, kNz>, kStageRows> row_{};
  double end_value_[kEndRows + 1]{}, end_row_[kEndRows + 1][kNx]{};
  double dend_[kEndRows + 1]{};
  double t_[kEndRows + 1]{}, z_[kEndRows + 1]{}, dt_[kEndRows + 1]{}, dz_[kEndRows + 1]{},
      t_at_[kEndRows + 1]{};
  bool is_there_[kEndRows + 1]{};  ///< sparse rows may be absent: rows that the problem does not have
  double slope_ = 0.0;
  double rho_ = 1.0;
};

/// In its place for problems without.
struct NoHardRows {};

template <class P, std::size_t Capacity, class Arch>
struct HardRowsOf {
  using Type = NoHardRows;
};
template <class P, std::size_t Capacity, class Arch>
requires kHasHardRows<P>
struct HardRowsOf<P, Capacity, Arch> {
  using Type = HardRows<P, Capacity, Arch>;
};

}  // namespace chicane::solver
