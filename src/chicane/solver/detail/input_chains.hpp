// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "chicane/solver/detail/input_block.hpp"
#include "chicane/solver/detail/iterate.hpp"
#include "chicane/solver/detail/rate_chain.hpp"
#include "chicane/solver/detail/rate_set.hpp"
#include "chicane/solver/problem.hpp"
#include "chicane/solver/solution.hpp"

namespace chicane::solver {

/// The inputs of a problem whose changes are bounded, each with all its bounds over the horizon. Without such
/// inputs there is nothing to it, and it costs nothing.
template <OcpProblem P, std::size_t Capacity>
class InputChains {
 public:
  static constexpr bool kAny = kHasRateBounds<P>;
  static constexpr std::size_t kNu = P::kNu;
  static constexpr auto kState = previous_inputs<P>();
  static constexpr bool is_bounded(std::size_t m) noexcept { return kState[m] >= 0; }
  using Chain = RateChain<kAny ? kStageStride<Capacity> : 1>;

  /// Reads the bounds. False when they are no numbers or cross; what is kept is usable nonetheless.
  bool set(const P& problem, const std::array<double, P::kNx>& x0, std::size_t horizon) noexcept {
    bool is_sound = true;
    each([&](std::size_t m) { is_sound = read(problem, x0, horizon, m) && is_sound; });
    return is_sound;
  }

  [[nodiscard]] const Chain& operator[](std::size_t m) const noexcept { return chain_[m]; }

  /// The admissible value nearest to `value`, behind `last`, which stage 0 knows itself.
  [[nodiscard]] double admit(std::size_t k, std::size_t m, double value, double last) const noexcept {
    return chain_[m].admit(k, value, k > 0 ? last : chain_[m].previous);
  }
  /// The inputs u(k, m) of the first stages become the nearest admissible ones.
  template <class Inputs>
  void admit(std::size_t count, const Inputs& u) const noexcept {
    each([&](std::size_t m) {
      for (std::size_t k = 0; k < count; ++k) u(k, m) = admit(k, m, u(k, m), k > 0 ? u(k - 1, m) : 0.0);
    });
  }

  /// Distance from optimal (eq. 25) of the inputs of `t`, with the slopes dJ/du along the dynamics.
  template <class Point, class Slopes>
  double distance(const Point& t, const Slopes& slope) noexcept {
    double largest = 0.0;
    each(
        [&](std::size_t m) { largest = std::max(largest, chain_[m].distance(t.u[m], slope[m], t.horizon)); });
    return largest;
  }
  /// ν of the bounds on the change of input m at stage k at the last distance() (eq. 26); positive at the
  /// upper one.
  [[nodiscard]] double price(std::size_t k, std::size_t m) const noexcept {
    return kAny && is_bounded(m) ? chain_[m].multiplier(k) : 0.0;
  }

  /// First guess of a working set: bounds that push, of inputs and of changes, where those stand at them.
  template <class Slopes, class Lq>
  void guess(const Slopes& slope, std::size_t horizon, Lq& qp) const noexcept {
    using Set = RateSet<kNu>;
    for (std::size_t m = 0; m < kNu; ++m) {
      for (std::size_t k = 0; k < horizon; ++k) {
        const bool is_low = qp.lq.low[m][k] >= 0.0 && slope[m][k] > 0.0;
        const bool is_high = qp.lq.high[m][k] <= 0.0 && slope[m][k] < 0.0;
        qp.hold[k][m] = is_low ? Hold::kLow : (is_high ? Hold::kHigh : Hold::kFree);
      }
    }
    each([&](std::size_t m) {
      for (std::size_t k = 0; k < horizon; ++k) {
        const double push = price(k, m);
        const double own = slope[m][k] + (k > 0 ? push : 0.0) - price(k + 1, m);
        const bool is_low = own > 0.0 && qp.lq.low[m][k] >= -kRounding;
        const bool is_high = own < 0.0 && qp.lq.high[m][k] <= kRounding;
        qp.hold[k][m] = is_low ? Hold::kLow : (is_high ? Hold::kHigh : Hold::kFree);
        const bool is_tied = push > 0.0 ? qp.lq.rate_high[m][k] <= kRounding
                                        : push < 0.0 && qp.lq.rate_low[m][k] >= -kRounding;
        if (!is_tied) continue;
        Set(qp.hold, m).set(k, qp.hold[k][m], push > 0.0 ? Hold::kRateHigh : Hold::kRateLow);
      }
    });
  }
  /// The input before stage 0 is given: bounds on that change are as good as its own.
  template <class Lq>
  void fold_first(Lq& lq) const noexcept {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    each([&](std::size_t m) {
      const InputBounds both{lq.low[m][0], lq.high[m][0], lq.rate_low[m][0], lq.rate_high[m][0]};
      const bool has_width = both.high() - both.low() > kRounding;
      lq.low[m][0] = both.low();
      lq.high[m][0] = has_width ? both.high() : both.low();
      lq.rate_low[m][0] = -kInfinity;
      lq.rate_high[m][0] = kInfinity;
    });
  }
  /// Cuts a step to the bounds on changes: sweeps respect them to 1e-10, steps to rounding.
  template <class Lq, class Step>
  void cut(const Lq& qp, Step& step) const noexcept {
    each([&](std::size_t m) {
      double last = 0.0;
      for (std::size_t k = 0; k < step.horizon; ++k) {
        const InputBounds bounds{qp.lq.low[m][k], qp.lq.high[m][k], last + qp.lq.rate_low[m][k],
                                 last + qp.lq.rate_high[m][k]};
        last = step.u[m][k] = std::min(std::max(step.u[m][k], bounds.low()), bounds.high());
      }
    });
  }
  /// States that hold previous inputs are those, without a defect by rounding.
  template <class Point>
  void keep_previous(Point& t) const noexcept {
    each([&](std::size_t m) {
      for (std::size_t k = 0; k < t.horizon; ++k) t.x[kState[m]][k + 1] = t.u[m][k];
    });
  }

  /// Which bound on a change gave way most.
  void tell(SolveReport& report) const noexcept {
    report.rate_excess = 0.0;
    report.rate_stage = report.rate_input = -1;
    each([&](std::size_t m) {
      if (chain_[m].excess <= report.rate_excess) return;
      report.rate_excess = chain_[m].excess;
      report.rate_stage = static_cast<int>(chain_[m].excess_stage);
      report.rate_input = static_cast<int>(m);
    });
  }

 private:
  static constexpr double kRounding = 1e-12;  ///< of sums of changes
  template <class Visit>
  static void each(const Visit& visit) noexcept {
    for (std::size_t m = 0; kAny && m < kNu; ++m) {
      if (is_bounded(m)) visit(m);
    }
  }
  bool read(const P& problem, const std::array<double, P::kNx>& x0, std::size_t horizon,
            std::size_t m) noexcept {
    bool is_sound = true;
    if constexpr (kAny) {
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      Chain& chain = chain_[m];
      chain.horizon = horizon;
      chain.previous = x0[static_cast<std::size_t>(kState[m])];
      for (std::size_t k = 0; k < horizon; ++k) {
        const int stage = static_cast<int>(k);
        chain.low[k] = problem.input_lower(stage)[m];
        chain.high[k] = problem.input_upper(stage)[m];
        const double low = problem.input_rate_lower(stage)[m];
        const double high = problem.input_rate_upper(stage)[m];
        const bool is_interval = low <= high && low < kInfinity && high > -kInfinity;
        chain.rate_low[k] = is_interval ? low : -kInfinity;
        chain.rate_high[k] = is_interval ? high : kInfinity;
        is_sound = is_sound && is_interval && chain.low[k] <= chain.high[k];
      }
      chain.make_consistent();
    }
    return is_sound;
  }

  std::array<Chain, kNu> chain_{};
};

}  // namespace chicane::solver
