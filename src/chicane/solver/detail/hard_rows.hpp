// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "chicane/base/math.hpp"
#include "chicane/base/pack.hpp"
#include "chicane/solver/detail/filter.hpp"
#include "chicane/solver/detail/filter_slacks.hpp"
#include "chicane/solver/detail/iterate.hpp"
#include "chicane/solver/sparse_row.hpp"

namespace chicane::solver {

/// Whether a problem has further residuals that represent hard rows (detail/augmented.hpp).
template <class P>
inline constexpr bool kHasHardRows = requires {
  P::kOwnResiduals;
};
/// Number of residuals of a stage without hard rows.
template <class P>
[[nodiscard]] constexpr std::size_t own_residuals() noexcept {
  if constexpr (kHasHardRows<P>) return P::kOwnResiduals;
  return P::kNr;
}

/// Hard rows inside the primal-dual method (docs/solver.md, eq. 50–55): h − p + n = 0 with a multiplier y
/// between two limits. p ≥ 0 exists if the upper limit is finite, with μ = p (high − y); n ≥ 0 exists if the
/// lower limit is finite, with μ = n (y − low).
///
/// | row | lower limit | upper limit |
/// |---|---|---|
/// | equality | −∞ | ∞ |
/// | inequality, whose slack is n | 0 | ∞ |
/// | elastic equality, which may be violated | −ρ₁ | ρ₁ |
/// | elastic inequality | 0 | ρ₁ |
///
/// The problem's functions return rows as residuals √w (h + shift), in which p and n are eliminated;
/// linearisations store these residuals here with their derivatives.
template <class P, std::size_t Capacity, class Arch>
class HardRows {
 public:
  static constexpr std::size_t kNx = P::kNx, kNu = P::kNu, kNz = kNx + kNu;
  static constexpr std::size_t kStageRows = P::kEqualities;
  static constexpr std::size_t kEqualities = P::kEndEqualities;
  static constexpr std::size_t kEndRows = kEqualities + P::kEndConstraints;
  using V = Stages<Arch>;
  using Step = Iterate<kNx, kNu, Capacity>;

  // ---- residuals from linearisations

  /// Stores residual n of the eight stages from k on.
  template <class Row>
  CHICANE_INLINE void store(std::size_t n, std::size_t k, const Row& r) noexcept {
    r.v.store(value_[n] + k);
    if constexpr (AnySparseRow<Row>) {
      for (auto& slope : row_[n]) V(0.0).store(slope + k);
    }
    each_slope<V>(r, [&](std::size_t j, const V& slope) { slope.store(row_[n][j] + k); });
  }
  /// Stores the value of residual n of the end; its slopes become zero.
  void store_end(std::size_t n, double value) noexcept {
    end_value_[n] = value;
    is_there_[n] = true;
    std::fill(std::begin(end_row_[n]), std::end(end_row_[n]), 0.0);
  }
  /// Stores the slope of residual n of the end by state i.
  void store_end_slope(std::size_t n, std::size_t i, double slope) noexcept { end_row_[n][i] = slope; }

  // ---- the method

  /// Starts without multipliers and with negligible weights, so that at the guess only costs count.
  void begin(P& problem) noexcept {
    problem.is_primal_dual = true;
    for (std::size_t n = 0; n < kStageRows; ++n) problem.set_weight(n, kNearlyNone);
    for (auto& weight : problem.terminal_weight) weight.set(kNearlyNone);
    for (auto& shift : problem.equality_shift) shift.values.fill(0.0);
    problem.terminal_shift.fill(0.0);
    std::fill(std::begin(is_there_), std::end(is_there_), false);
    std::fill(std::begin(end_value_), std::end(end_value_), 0.0);
    for (auto& row : end_row_) std::fill(std::begin(row), std::end(row), 0.0);
    value_ = {};
    row_ = {};
    stage_ = {};
    end_ = {};
    is_ready_ = false;
  }
  /// Continues the primal-dual method from the state at end().
  void resume(P& problem, double mu, std::size_t horizon) noexcept {
    problem.is_primal_dual = true;
    set_rows(problem, mu, horizon);
  }
  /// Whether weigh() has been called.
  [[nodiscard]] bool is_ready() const noexcept { return is_ready_; }
  /// Sets the weights: `rho`, divided by the square of a row's steepest slope if that is above 1. With
  /// `penalty` > 0 rows are elastic, with that limit of multipliers. Pre: begin(), then one linearisation.
  void weigh(double rho, double penalty, std::size_t horizon) noexcept {
    rho_ = rho;
    is_ready_ = true;
    most_ = penalty > 0.0 ? penalty : kInfinity;
    const auto share = [](double steepest) { return 1.0 / std::max(1.0, steepest * steepest / kNearlyNone); };
    for (std::size_t n = 0; n < kStageRows; ++n) {
      double steepest = 0.0;
      for (const Line& slope : row_[n]) {
        for (std::size_t k = 0; k < horizon; ++k) steepest = std::max(steepest, std::fabs(slope.values[k]));
      }
      stage_share_[n] = share(steepest);
    }
    for (std::size_t n = 0; n < kEndRows; ++n) {
      double steepest = 0.0;
      for (const double slope : end_row_[n]) steepest = std::max(steepest, std::fabs(slope));
      end_share_[n] = share(steepest);
    }
  }
  /// Multiplies the weights by `factor`, up to `most`, so that multipliers converge faster.
  void raise(P& problem, double factor, double most, double mu, std::size_t horizon) noexcept {
    if (is_elastic() || rho_ >= most) return;
    rho_ *= factor;
    set_rows(problem, mu, horizon);
  }
  /// Whether rows may be violated at a penalty.
  [[nodiscard]] bool is_elastic() const noexcept { return most_ < kInfinity; }
  /// Puts p, n and multipliers of row n of the eight stages from k on, whose values are `h`, on the central
  /// path.
  void centre(std::size_t n, std::size_t k, const V& h, double mu) noexcept {
    alignas(64) double values[8];
    h.store(values);
    for (std::size_t lane = 0; lane < 8; ++lane) {
      const Row<double> row = centred(stage_limits(n), values[lane], 0.0, mu);
      Rows& rows = stage_[n];
      rows.y[k + lane] = row.y;
      rows.p[k + lane] = row.p, rows.n[k + lane] = row.n;
      rows.above[k + lane] = row.above, rows.below[k + lane] = row.below;
    }
  }
  /// Puts rows of the end, whose values are `h`, on the central path; slacks of inequalities get some room.
  template <class Values>
  void centre_end(const Values& h, double mu) noexcept {
    for (std::size_t n = 0; n < kEndRows; ++n)
      end_[n] = centred(limits(n), h[n], n < kEqualities ? end_[n].y : 0.0, mu);
  }
  /// Updates weights and shifts of the problem's residuals after a change of rows or μ, so that the residuals
  /// have the force of the eliminated p and n.
  void set_rows(P& problem, double mu, std::size_t horizon) noexcept {
    for (std::size_t n = 0; n < kStageRows; ++n) {
      for (std::size_t k = 0; k < horizon; k += 8) {
        const auto [root, shift] = stage_[n].load(k).residual(stage_limits(n), mu);
        root.store(problem.equality_root[n].values.data() + k);
        shift.store(problem.equality_shift[n].values.data() + k);
      }
    }
    for (std::size_t n = 0; n < kEndRows; ++n) {
      const auto [root, shift] = end_[n].residual(limits(n), mu);
      problem.terminal_weight[n] = {root, root * root};
      problem.terminal_shift[n] = shift;
    }
  }
  /// Updates weights and shifts after a change of μ alone, the gradient of the end, `slope`, and the stages'
  /// gradients through `pull(k, j, amount)`.
  template <class Pull>
  void set_rows(P& problem, double mu, std::size_t horizon, double* slope, const Pull& pull) noexcept {
    const auto old_end = problem.terminal_shift;
    const auto old_stage = problem.equality_shift;
    set_rows(problem, mu, horizon);
    for (std::size_t n = 0; n < kEndRows; ++n) {
      if (!is_there_[n]) continue;
      const double change = problem.terminal_weight[n].root * (problem.terminal_shift[n] - old_end[n]);
      end_value_[n] += change;
      for (std::size_t i = 0; i < kNx; ++i) slope[i] += change * end_row_[n][i];
    }
    if (!is_elastic()) return;
    for (std::size_t n = 0; n < kStageRows; ++n) {
      for (std::size_t k = 0; k < horizon; ++k) {
        const double change = problem.equality_root[n].values[k] *
                              (problem.equality_shift[n].values[k] - old_stage[n].values[k]);
        value_[n][k] += change;
        for (std::size_t j = 0; j < kNz; ++j) pull(k, j, change * row_[n][j][k]);
      }
    }
  }

  /// Finds the directions of all rows for a step from the present iterate, and their longest lengths.
  StepLengths find(const P& problem, const Step& step, double mu, double fraction) noexcept {
    slope_ = 0.0;
    V primal(0.0), dual(0.0);
    for (std::size_t n = 0; n < kStageRows; ++n) {
      V slope(0.0);
      const Limits limits = stage_limits(n);
      for (std::size_t k = 0; k < step.horizon; k += 8) {
        V change(0.0);
        for (std::size_t i = 0; i < kNx; ++i) change += V::load(row_[n][i] + k) * V::load(step.x[i] + k);
        for (std::size_t m = 0; m < kNu; ++m)
          change += V::load(row_[n][kNx + m] + k) * V::load(step.u[m] + k);
        const V value = V::load(value_[n] + k),
                root = problem.equality_root[n].at(StageLanes<V>{static_cast<int>(k)});
        const auto live = stages_before<V>(k, step.horizon);
        const Row<V> row = stage_[n].load(k);
        const Row<V> d = row.step(limits, root * (value + change), mu);
        stage_step_[n].store(k, d);
        slope += select(live, row.slope(limits, d, mu) - value * change, V(0.0));
        const auto [by_primal, by_dual] = row.shares(limits, d);
        primal = max(primal, select(live, by_primal, V(0.0)));
        dual = max(dual, select(live, by_dual, V(0.0)));
      }
      slope_ += sum(slope);
    }
    double most_primal = largest(primal), most_dual = largest(dual);
    for (std::size_t n = 0; n < kEndRows; ++n) {
      if (!is_there_[n]) continue;
      double change = 0.0;
      for (std::size_t i = 0; i < kNx; ++i) change += end_row_[n][i] * step.x[i][step.horizon];
      const double root = problem.terminal_weight[n].root;
      end_step_[n] = end_[n].step(limits(n), root * (end_value_[n] + change), mu);
      slope_ += end_[n].slope(limits(n), end_step_[n], mu) - end_value_[n] * change;
      const auto [by_primal, by_dual] = end_[n].shares(limits(n), end_step_[n]);
      most_primal = std::max(most_primal, by_primal);
      most_dual = std::max(most_dual, by_dual);
    }
    return {fraction / std::max(most_primal, 1e-30), fraction / std::max(most_dual, 1e-30)};
  }
  /// Slope of the rows' cost along the direction, less the part that the stages' gradients contain.
  [[nodiscard]] double slope() const noexcept { return slope_; }

  /// Value of row n of the eight stages from k on, whose residual is `value`.
  [[nodiscard]] static V row_value(const P& problem, std::size_t n, std::size_t k, const V& value) noexcept {
    const StageLanes<V> lanes{static_cast<int>(k)};
    return value / problem.equality_root[n].at(lanes) - problem.equality_shift[n].at(lanes);
  }
  /// Adds miss, cost and logarithms of row n of the stages from k on, whose residual is `value`, at `length`
  /// of the direction.
  template <class Mask>
  void measure(const P& problem, std::size_t n, std::size_t k, const V& value, double length,
               const Mask& live, V& miss, V& cost, V& logs) noexcept {
    const V h = row_value(problem, n, k, value);
    Row<V> at = stage_[n].load(k);
    if (length > 0.0) at.go(length, stage_step_[n].load(k));
    at.p.store(stage_at_[n].p + k);
    at.n.store(stage_at_[n].n + k);
    at.measure(stage_limits(n), h, [&](const V& missed, const V& costs, const V& logarithms) {
      miss += select(live, missed, V(0.0));
      cost += select(live, costs, V(0.0));
      logs += select(live, logarithms, V(0.0));
    });
  }
  /// Adds miss, cost and logarithms of the rows of the end, whose values are `h`.
  template <class Values>
  void measure_end(const Values& h, double length, Merit& merit) noexcept {
    for (std::size_t n = 0; n < kEndRows; ++n) {
      if (!is_there_[n]) continue;
      Row<double> at = end_[n];
      if (length > 0.0) {
        at.go(length, end_step_[n]);
        if (n >= kEqualities) at.n = std::max(at.n, at.p - h[n]);  // a larger slack costs nothing
      }
      end_at_[n] = at;
      at.measure(limits(n), h[n], [&](double missed, double costs, double logarithms) {
        merit.miss += missed;
        merit.cost += costs;
        merit.logs += logarithms;
      });
    }
  }
  /// Largest residual of the rows and of their complementarity at the present iterate.
  [[nodiscard]] double residual(const P& problem, double mu, double unit,
                                std::size_t horizon) const noexcept {
    V all(0.0);
    for (std::size_t n = 0; n < kStageRows; ++n) {
      for (std::size_t k = 0; k < horizon; k += 8) {
        const auto live = stages_before<V>(k, horizon);
        const V h = row_value(problem, n, k, V::load(value_[n] + k));
        all = max(all, select(live, stage_[n].load(k).worst(stage_limits(n), h, mu, unit), V(0.0)));
      }
    }
    double worst = largest(all);
    for (std::size_t n = 0; n < kEndRows; ++n) {
      if (!is_there_[n]) continue;
      const double h = end_value_[n] / problem.terminal_weight[n].root - problem.terminal_shift[n];
      worst = std::max(worst, end_[n].worst(limits(n), h, mu, unit));
    }
    return worst;
  }
  /// Force of the end's residuals on state i beyond their multipliers.
  [[nodiscard]] double excess(const P& problem, std::size_t i) const noexcept {
    double sum = 0.0;
    for (std::size_t n = 0; n < kEndRows; ++n)
      sum += (end_value_[n] - end_weight(problem, n)) * end_row_[n][i];
    return sum;
  }
  /// Multiplier of row n of the end over √w.
  [[nodiscard]] double end_weight(const P& problem, std::size_t n) const noexcept {
    return end_[n].y / problem.terminal_weight[n].root;
  }
  /// Multiplier of row n of the eight stages from k on over √w.
  [[nodiscard]] V stage_weight(const P& problem, std::size_t n, std::size_t k) const noexcept {
    return V::load(stage_[n].y + k) / problem.equality_root[n].at(StageLanes<V>{static_cast<int>(k)});
  }

  /// Moves to the point of the last measure(); multipliers of equalities that are not elastic by `length` of
  /// their direction, others by `dual_length`.
  void move(P& problem, double length, double dual_length, double mu, std::size_t horizon) noexcept {
    constexpr double kFar = 1e10;  // largest factor between y and μ / n; usual for the method
    const double by = is_elastic() ? dual_length : length;
    for (std::size_t n = 0; n < kStageRows; ++n) {
      for (std::size_t k = 0; k < horizon; k += 8) {
        Row<V> row = stage_[n].load(k);
        row.move(by, stage_step_[n].load(k), V::load(stage_at_[n].p + k), V::load(stage_at_[n].n + k));
        stage_[n].store(k, row);
      }
    }
    for (std::size_t n = 0; n < kEndRows; ++n) {
      if (!is_there_[n]) continue;
      Row<double>& row = end_[n];
      row.move(n < kEqualities ? by : dual_length, end_step_[n], end_at_[n].p, end_at_[n].n);
      if (n >= kEqualities && !is_elastic())
        row.y = row.below = std::min(std::max(row.y, mu / (kFar * row.n)), kFar * mu / row.n);
    }
    set_rows(problem, mu, horizon);
  }
  /// Ends the method: the problem becomes an augmented Lagrangian with the multipliers that were found.
  void end(P& problem, std::size_t horizon) noexcept {
    problem.is_primal_dual = false;
    for (std::size_t n = 0; n < kStageRows; ++n) {
      const double rho = rho_ * stage_share_[n];
      problem.set_weight(n, rho);
      for (std::size_t k = 0; k < horizon; ++k) problem.equality_shift[n].values[k] = stage_[n].y[k] / rho;
    }
    for (std::size_t n = 0; n < kEndRows; ++n) {
      const double rho = rho_ * end_share_[n];
      problem.terminal_weight[n].set(rho);
      problem.terminal_shift[n] = is_there_[n] ? end_[n].y / rho : 0.0;
    }
  }

 private:
  static constexpr std::size_t kStride = kStageStride<Capacity>;
  static constexpr double kPush = 1e-2;         ///< least first n over |h|; usual for the method
  static constexpr double kNearlyNone = 1e-12;  ///< negligible weight of a row; chosen
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  template <class T, std::size_t N>
  using Of = std::array<T, (N > 0 ? N : 1)>;
  /// One number for each stage.
  struct alignas(64) Line {
    double values[kStride]{};
    operator double*() noexcept { return values; }
    operator const double*() const noexcept { return values; }
  };
  /// Range of a multiplier. `soft`: violation over multiplier of an equality that is not elastic; `scale`:
  /// factor of the row in miss and residual.
  struct Limits {
    double low = 0.0, high = 0.0, soft = 0.0, scale = 1.0;
    [[nodiscard]] bool has_p() const noexcept { return high < kInfinity; }
    [[nodiscard]] bool has_n() const noexcept { return low > -kInfinity; }
  };
  /// One row, or one of eight stages, or a direction of it: `above` = high − y, `below` = y − low.
  template <class T>
  struct Row {
    T y{0.0}, p{0.0}, n{0.0}, above{1.0}, below{1.0};

    /// Root of the weight and shift of the residual.
    [[nodiscard]] auto residual(const Limits& limits, double mu) const noexcept {
      T give(limits.soft), shift(0.0);
      if (limits.has_p()) give += p / above, shift -= mu / above;
      if (limits.has_n()) give += n / below, shift += mu / below;
      return std::array<T, 2>{1.0 / sqrt(give), y * give + shift};
    }
    /// Direction towards the multiplier `next`.
    [[nodiscard]] Row step(const Limits& limits, const T& next, double mu) const noexcept {
      Row d;
      d.y = next - y;
      d.above = -d.y;
      d.below = d.y;
      d.p = limits.has_p() ? mu / above - p + p / above * d.y : T(0.0);
      d.n = limits.has_n() ? mu / below - n - n / below * d.y : T(0.0);
      return d;
    }
    /// Slope of cost and barriers along a direction.
    [[nodiscard]] T slope(const Limits& limits, const Row& d, double mu) const noexcept {
      T sum(0.0);
      if (limits.has_p()) sum += (limits.high - mu / p) * d.p;
      if (limits.has_n()) sum += (-limits.low - mu / n) * d.n;
      return sum;
    }
    /// Shares of p and n, and of the distances to the limits, that a whole step takes.
    [[nodiscard]] std::array<T, 2> shares(const Limits& limits, const Row& d) const noexcept {
      T primal(0.0), dual(0.0);
      if (limits.has_p()) primal = larger(primal, -d.p / p), dual = larger(dual, -d.above / above);
      if (limits.has_n()) primal = larger(primal, -d.n / n), dual = larger(dual, -d.below / below);
      return {primal, dual};
    }
    /// Moves p and n by `length` of a direction.
    void go(double length, const Row& d) noexcept {
      p += length * d.p;
      n += length * d.n;
    }
    /// Moves the multiplier by `length` of a direction, p and n to given values.
    void move(double length, const Row& d, const T& p_at, const T& n_at) noexcept {
      y += length * d.y;
      above += length * d.above;
      below += length * d.below;
      p = p_at;
      n = n_at;
    }
    /// Calls add(miss, cost, logarithms) of a row with value h.
    template <class Add>
    void measure(const Limits& limits, const T& h, const Add& add) const noexcept {
      T cost(0.0), logs(0.0);
      if (limits.has_p()) cost += limits.high * p, logs += log(p);
      if (limits.has_n()) cost -= limits.low * n, logs += log(n);
      add(limits.scale * magnitude(h - p + n), cost, logs);
    }
    /// Largest residual of the row and of its complementarity.
    [[nodiscard]] T worst(const Limits& limits, const T& h, double mu, double unit) const noexcept {
      T result = unit * limits.scale * magnitude(h - p + n);
      if (limits.has_p()) result = larger(result, magnitude(p * above - mu));
      if (limits.has_n()) result = larger(result, magnitude(n * below - mu));
      return result;
    }
    static T larger(const T& a, const T& b) noexcept { return select(a > b, a, b); }
    static T magnitude(const T& a) noexcept { return larger(a, -a); }
  };
  /// Rows of all stages.
  struct Rows {
    Line y, p, n, above, below;
    [[nodiscard]] Row<V> load(std::size_t k) const noexcept {
      return {V::load(y + k), V::load(p + k), V::load(n + k), V::load(above + k), V::load(below + k)};
    }
    void store(std::size_t k, const Row<V>& row) noexcept {
      row.y.store(y + k);
      row.p.store(p + k);
      row.n.store(n + k);
      row.above.store(above + k);
      row.below.store(below + k);
    }
  };
  [[nodiscard]] Limits stage_limits(std::size_t n) const noexcept { return equality(stage_share_[n]); }
  [[nodiscard]] Limits limits(std::size_t n) const noexcept {
    return n < kEqualities ? equality(end_share_[n]) : Limits{0.0, most_, 0.0};
  }
  [[nodiscard]] Limits equality(double share) const noexcept {
    if (is_elastic()) return {-most_, most_, 0.0, 1.0};
    return {-most_, most_, 1.0 / (rho_ * share), std::sqrt(share)};
  }
  /// A row of value h: an elastic one on the central path, h = μ/(high − y) − μ/(y − low); an inequality with
  /// some room in its slack; an equality with multiplier `y`.
  static Row<double> centred(const Limits& limits, double h, double y, double mu) noexcept {
    Row<double> row;
    row.y = y;
    if (limits.has_p()) {
      const double half = 0.5 * (limits.high - limits.low), by = half * std::fabs(h);
      const double root = std::sqrt(mu * mu + by * by), off = half * by / (mu + root);  // |y − middle|
      const double near = half * mu * (1.0 + mu / (root + by)) / (mu + root), far = half + off;
      row.y = 0.5 * (limits.high + limits.low) + (h > 0.0 ? off : -off);
      row.above = h > 0.0 ? near : far;
      row.below = h > 0.0 ? far : near;
      row.p = mu / row.above;
      row.n = mu / row.below;
    } else if (limits.has_n()) {
      row.n = std::max(-h, kPush * std::max(1.0, std::fabs(h)));
      row.y = row.below = mu / row.n;
    }
    return row;
  }

  Of<Line, kStageRows> value_{};                              ///< residuals of the stages
  Of<std::array<Line, kNz>, kStageRows> row_{};               ///< their slopes
  Of<Rows, kStageRows> stage_{}, stage_step_{}, stage_at_{};  ///< rows of the stages, directions, trial
  double end_value_[kEndRows + 1]{}, end_row_[kEndRows + 1][kNx]{};  ///< residuals of the end, slopes
  std::array<Row<double>, kEndRows + 1> end_{}, end_step_{},
      end_at_{};                          ///< rows of the end, directions, trial
  bool is_there_[kEndRows + 1]{};         ///< whether a problem with sparse rows has the row
  Of<double, kStageRows> stage_share_{};  ///< weights of the stages' rows over rho_
  Of<double, kEndRows> end_share_{};      ///< weights of the end's rows over rho_
  double most_ = kInfinity;               ///< limit of multipliers of elastic rows
  double slope_ = 0.0;                    ///< slope()
  double rho_ = 1.0;                      ///< weight of rows with slopes up to 1
  bool is_ready_ = false;                 ///< is_ready()
};

/// Empty member in place of a part that the solver of a problem does not need.
struct Nothing {};

}  // namespace chicane::solver
