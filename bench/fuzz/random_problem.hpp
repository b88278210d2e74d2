// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "chicane/base/random.hpp"
#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/problem.hpp"
#include "problems/optimality.hpp"

namespace chicane::bench {

/// What a random problem may have that solvers do not like; each is switched on in some instances.
struct Quirks {
  double log = 0.0;      ///< 1: a logarithm of a state, not a number below zero
  double root = 0.0;     ///< 1: a square root of a state
  double pole = 0.0;     ///< 1: a division by a state
  double blow = 0.0;     ///< 1: an exponential that overflows
  double jump = 0.0;     ///< height of a discontinuity
  double kink = 0.0;     ///< weight of |x|
  double product = 0.0;  ///< weight of products of states and inputs
};

/// Numbers of a random problem, for every size.
template <int Nx, int Nu, int Nc>
struct RandomData {
  static constexpr int kNx = Nx, kNu = Nu, kNr = Nx + Nu + 1, kNe = Nx, kNc = Nc;
  double a[Nx][Nx]{}, b[Nx][Nu]{}, wave[Nx]{}, goal[Nx]{}, weight[Nx + Nu]{}, end[Nx]{};
  double edge[Nc + 1]{}, slope[Nc + 1]{};
  std::array<double, Nu> low{}, high{};
  solver::SoftPenalty penalty;
  Quirks quirks;

  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return penalty; }
  [[nodiscard]] std::array<double, Nu> input_lower(int) const { return low; }
  [[nodiscard]] std::array<double, Nu> input_upper(int) const { return high; }

  /// Next value of state i of an array or a tuple; T: what it may be assigned to.
  template <std::size_t I>
  auto next(const auto& x, const auto& u) const {
    constexpr std::size_t kOther = (I + 1) % Nx;
    const auto& own = std::get<I>(x);
    const auto& other = std::get<kOther>(x);
    const auto& push = std::get<I % Nu>(u);
    auto smooth = own + a[I][I] * own + a[I][kOther] * other + b[I][I % Nu] * push + wave[I] * sin(other) +
                  quirks.product * own * push + quirks.kink * abs(other);
    if constexpr (I == 0) {
      const auto rough = 0.05 * log(quirks.log * other + (1.0 - quirks.log)) +
                         0.05 * sqrt(quirks.root * other + (1.0 - quirks.root)) +
                         0.01 / (quirks.pole * other + (1.0 - quirks.pole)) +
                         0.01 * exp(quirks.blow * 10.0 * other);
      return smooth + rough + quirks.jump * select(own > 0.5, 0.0 * own + 1.0, 0.0 * own);
    } else {
      return smooth;
    }
  }
  template <std::size_t C>
  auto limit(const auto& x, const auto& u) const {
    return std::get<C % Nx>(x) - edge[C] + slope[C] * std::get<C % Nu>(u) +
           quirks.product * std::get<0>(x) * std::get<0>(x);
  }
  template <std::size_t R>
  auto cost(const auto& x, const auto& u) const {
    if constexpr (R < Nx) {
      return weight[R] * (std::get<R>(x) - goal[R]);
    } else if constexpr (R < Nx + Nu) {
      return weight[R] * std::get<R - Nx>(u);
    } else {
      return 0.1 * sin(std::get<0>(x)) * std::get<0>(u);
    }
  }

  static RandomData make(Random& random) {
    RandomData p;
    const auto chance = [&](double share) { return random.uniform() < share; };
    const auto decade = [&](double least, double most) {
      return exp(2.302585 * random.uniform(least, most));
    };
    const double speed = decade(-2.0, 0.3), scale = chance(0.3) ? decade(-4.0, 4.0) : 1.0;
    const double costs = chance(0.3) ? decade(-4.0, 4.0) : 1.0;
    for (std::size_t i = 0; i < Nx; ++i) {
      for (double& v : p.a[i]) v = speed * random.normal();
      for (double& v : p.b[i]) v = speed * scale * random.normal();
      p.wave[i] = speed * random.normal();
      p.goal[i] = random.normal();
      p.weight[i] = chance(0.2) ? 0.0 : costs * decade(-2.0, 1.0);
      p.end[i] = chance(0.2) ? 0.0 : costs * decade(-1.0, 2.0);
    }
    for (std::size_t m = 0; m < Nu; ++m) {
      p.weight[Nx + m] = chance(0.1) ? 0.0 : costs * scale * decade(-2.0, 0.0);
      const double middle = random.normal() / scale, width = chance(0.1) ? 0.0 : decade(-2.0, 1.0) / scale;
      p.low[m] = middle - width;
      p.high[m] = middle + width;
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      if (chance(0.2)) p.low[m] = -kInfinity;
      if (chance(0.2)) p.high[m] = kInfinity;
      if (chance(0.003)) std::swap(p.low[m], p.high[m]);
      if (chance(0.003)) p.low[m] = std::numeric_limits<double>::quiet_NaN();
    }
    for (std::size_t c = 0; c < Nc; ++c) {
      p.edge[c] = random.normal();
      p.slope[c] = chance(0.5) ? 0.0 : random.normal() * scale;
    }
    p.penalty = {.linear = decade(-1.0, 4.0),
                 .quadratic = chance(0.2) ? 0.0 : decade(-1.0, 4.0),
                 .cap = chance(0.2) ? decade(-3.0, 0.0) : 1e30};
    Quirks& q = p.quirks;
    q.log = chance(0.04) ? 1.0 : 0.0;
    q.root = chance(0.04) ? 1.0 : 0.0;
    q.pole = chance(0.04) ? 1.0 : 0.0;
    q.blow = chance(0.04) ? 1.0 : 0.0;
    q.jump = chance(0.06) ? random.normal() : 0.0;
    q.kink = chance(0.06) ? speed * random.normal() : 0.0;
    q.product = chance(0.2) ? speed * random.normal() : 0.0;
    return p;
  }
};

/// With a type for each variable.
template <int Nx, int Nu, int Nc>
struct RandomStructured : RandomData<Nx, Nu, Nc> {
  using Data = RandomData<Nx, Nu, Nc>;
  template <int Count, class Make>
  static auto row(const Make& make) {
    return [&]<std::size_t... i>(std::index_sequence<i...>) {
      return std::make_tuple(make(std::integral_constant<std::size_t, i>{})...);
    }
    (std::make_index_sequence<static_cast<std::size_t>(Count)>{});
  }
  auto dynamics(auto, const auto& x, const auto& u) const {
    return row<Nx>([&](auto i) { return this->template next<i>(x, u); });
  }
  auto residual(auto, const auto& x, const auto& u) const {
    return row<Data::kNr>([&](auto r) { return this->template cost<r>(x, u); });
  }
  auto terminal_residual(const auto& x) const {
    return row<Nx>([&](auto i) { return this->end[i] * (std::get<i>(x) - this->goal[i]); });
  }
  auto constraint(auto, const auto& x, const auto& u) const {
    return row<Nc>([&](auto c) { return this->template limit<c>(x, u); });
  }
};

/// Over arrays of one scalar type, one stage at a time: it branches.
template <class Base>
struct Branching : OverArrays<Base> {
  template <class T>
  auto dynamics(int k, const std::array<T, Base::kNx>& x, const std::array<T, Base::kNu>& u) const {
    auto next = OverArrays<Base>::dynamics(k, x, u);
    if (x[0] > 3.0) next[0] = next[0] + 0.1 * this->quirks.jump;
    return next;
  }
};

/// What must hold beside: hard limits, an equation of each stage, some at the end; some of them cannot.
template <int Nx, int Nu, int Nc, int Nh, int Neh, int Nec>
struct RandomHard : RandomStructured<Nx, Nu, Nc> {
  using Base = RandomStructured<Nx, Nu, Nc>;
  static constexpr int kNh = Nh, kNeh = Neh, kNec = Nec;
  std::array<bool, Nc> must_hold{};
  solver::StageData<64> is_on;  ///< 0: what the first stage cannot change
  std::array<solver::StageData<64>, Nh> at{};
  std::array<double, Nh> by_input{};
  std::array<double, Neh> end_at{}, end_bend{};
  std::array<double, Nec> end_most{};

  [[nodiscard]] bool is_hard(int c) const { return must_hold[static_cast<std::size_t>(c)]; }
  auto equality(auto k, const auto& x, const auto& u) const {
    return Base::template row<Nh>([&](auto n) {
      return is_on.at(k) * (std::get<(n + 1) % Nx>(x) - at[n].at(k) + by_input[n] * std::get<n % Nu>(u));
    });
  }
  auto terminal_equality(const auto& x) const {
    return Base::template row<Neh>([&](auto n) {
      return std::get<n>(x) - end_at[n] + end_bend[n] * (std::get<n>(x) * std::get<(n + 1) % Nx>(x));
    });
  }
  auto terminal_constraint(const auto& x) const {
    return Base::template row<Nec>([&](auto n) { return std::get<(n + 1) % Nx>(x) - end_most[n]; });
  }
  /// With data of which six in ten can hold: those of a motion from `start`.
  void make_hard(Random& random, const std::array<double, Nx>& start, int horizon) {
    const auto chance = [&](double share) { return random.uniform() < share; };
    for (bool& hard : must_hold) hard = chance(0.7);
    const double wide = chance(0.3) ? 3.0 : 0.5, scale = chance(0.2) ? 1e3 : 1.0;
    for (std::size_t n = 0; n < Nh; ++n) {
      by_input[n] = chance(0.2) ? 0.0 : scale * random.normal();
      const double value = chance(0.3) ? 0.0 : 0.3 * random.normal();
      for (std::size_t k = 0; k < 64; ++k) at[n][k] = value;
    }
    for (std::size_t k = 0; k < 64; ++k) is_on[k] = k > 0 ? 1.0 : 0.0;
    for (std::size_t n = 0; n < Neh; ++n) {
      end_at[n] = wide * random.normal();
      end_bend[n] = chance(0.5) ? 0.0 : 0.5 * random.normal();
    }
    for (double& most : end_most) most = wide * random.normal();
    if (chance(0.6)) make_possible(random, start, horizon);
  }

 private:
  void make_possible(Random& random, std::array<double, Nx> x, int horizon) {
    std::array<double, Nc> highest;
    highest.fill(-1e30);
    auto along = at;
    for (int k = 0; k < horizon; ++k) {
      std::array<double, Nu> u;
      for (std::size_t m = 0; m < Nu; ++m)
        u[m] = std::fmin(std::fmax(random.normal(), this->low[m]), this->high[m]);
      const auto stage = static_cast<std::size_t>(k);
      for (std::size_t n = 0; n < Nh; ++n) along[n][stage] = x[(n + 1) % Nx] + by_input[n] * u[n % Nu];
      const auto limits = solver::to_array<double>(this->constraint(k, x, u));
      for (std::size_t c = 0; c < Nc; ++c) highest[c] = std::fmax(highest[c], limits[c]);
      x = solver::next_state(*this, k, x, u);
    }
    for (const double value : x) {
      if (!(std::fabs(value) < 1e12)) return;
    }
    at = along;
    for (std::size_t c = 0; c < Nc; ++c) this->edge[c] += highest[c];
    for (std::size_t n = 0; n < Neh; ++n) end_at[n] = x[n] + end_bend[n] * (x[n] * x[(n + 1) % Nx]);
    for (std::size_t n = 0; n < Nec; ++n) end_most[n] = x[(n + 1) % Nx];
  }
};

}  // namespace chicane::bench
