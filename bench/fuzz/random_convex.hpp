// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "chicane/base/random.hpp"
#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/problem.hpp"

namespace chicane::bench {

/// A random problem with linear dynamics and linear rows that must hold, whose cost is a sum of squares, of
/// penalties of a linear row, or nothing. All of its local minima are global.
template <int Nx, int Nu, int Capacity>
struct RandomConvex {
  static constexpr int kNx = Nx, kNu = Nu, kNr = Nx + Nu, kNe = Nx, kNc = 2, kNh = 1, kNeh = 2, kNec = 1;
  template <class T>
  using X = std::array<T, static_cast<std::size_t>(Nx)>;
  template <class T>
  using U = std::array<T, static_cast<std::size_t>(Nu)>;
  using Start = X<double>;
  /// A linear function of state and input.
  struct Row {
    X<double> x{};
    U<double> u{};
    double offset = 0.0;

    template <class T>
    [[nodiscard]] T of_state(const X<T>& at) const {
      T sum = x[0] * at[0] + offset;
      for (std::size_t i = 1; i < x.size(); ++i) sum = sum + x[i] * at[i];
      return sum;
    }
    template <class T>
    [[nodiscard]] T of(const X<T>& at, const U<T>& input) const {
      T sum = of_state(at);
      for (std::size_t m = 0; m < u.size(); ++m) sum = sum + u[m] * input[m];
      return sum;
    }
    static Row make(Random& random, double input_scale) {
      Row row;
      for (double& v : row.x) v = random.uniform() < 0.3 ? 0.0 : random.normal();
      for (double& v : row.u) v = random.uniform() < 0.3 ? 0.0 : input_scale * random.normal();
      row.x[static_cast<std::size_t>(random.uniform(0.0, Nx))] = 1.0;
      return row;
    }
  };

  std::array<Row, Nx> motion;
  std::array<Row, 2> limit, end;  ///< limit[0] is soft unless `all_hard`
  Row equation, end_limit;
  solver::StageData<Capacity> demand;  ///< right side of `equation`
  X<double> goal{}, weight{}, end_weight{};
  U<double> input_weight{}, low{}, high{};
  solver::SoftPenalty penalty;
  bool all_hard = true;

  [[nodiscard]] bool is_hard(int c) const { return all_hard || c > 0; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return penalty; }
  [[nodiscard]] U<double> input_lower(int) const { return low; }
  [[nodiscard]] U<double> input_upper(int) const { return high; }
  template <class K, class T>
  X<T> dynamics(K, const X<T>& x, const U<T>& u) const {
    X<T> next;
    for (std::size_t i = 0; i < next.size(); ++i) next[i] = motion[i].of(x, u);
    return next;
  }
  template <class K, class T>
  std::array<T, kNr> residual(K, const X<T>& x, const U<T>& u) const {
    std::array<T, kNr> r;
    for (std::size_t i = 0; i < x.size(); ++i) r[i] = weight[i] * (x[i] - goal[i]);
    for (std::size_t m = 0; m < u.size(); ++m) r[x.size() + m] = input_weight[m] * u[m];
    return r;
  }
  template <class T>
  X<T> terminal_residual(const X<T>& x) const {
    X<T> r;
    for (std::size_t i = 0; i < x.size(); ++i) r[i] = end_weight[i] * (x[i] - goal[i]);
    return r;
  }
  template <class K, class T>
  std::array<T, 2> constraint(K, const X<T>& x, const U<T>& u) const {
    return {limit[0].of(x, u), limit[1].of(x, u)};
  }
  template <class K, class T>
  std::array<T, 1> equality(K k, const X<T>& x, const U<T>& u) const {
    return {equation.of(x, u) - demand.at(k)};
  }
  template <class T>
  std::array<T, 2> terminal_equality(const X<T>& x) const {
    return {end[0].of_state(x), end[1].of_state(x)};
  }
  template <class T>
  std::array<T, 1> terminal_constraint(const X<T>& x) const {
    return {end_limit.of_state(x)};
  }

  /// Rows that a random motion from `start` fulfils, with some room or none; with noise in a third of all.
  static RandomConvex make(Random& random, Start& start, int horizon) {
    RandomConvex p;
    const auto chance = [&](double share) { return random.uniform() < share; };
    const auto decade = [&](double least, double most) {
      return std::pow(10.0, random.uniform(least, most));
    };
    const double speed = decade(-1.5, 0.0), scale = chance(0.3) ? decade(-2.0, 2.0) : 1.0;
    for (double& x : start) x = random.normal();
    for (std::size_t i = 0; i < Nx; ++i) {
      for (double& v : p.motion[i].x) v = 0.5 * speed * random.normal();
      p.motion[i].x[i] += chance(0.8) ? 1.0 : 0.5;
      for (double& v : p.motion[i].u) v = chance(0.3) ? 0.0 : speed * scale * random.normal();
      p.motion[i].offset = chance(0.5) ? 0.0 : 0.1 * random.normal();
    }
    const bool has_squares = chance(0.8);
    for (double& v : p.goal) v = random.normal();
    for (double& v : p.weight) v = has_squares && chance(0.7) ? decade(-2.0, 1.0) : 0.0;
    for (double& v : p.end_weight) v = has_squares && chance(0.5) ? decade(-1.0, 1.0) : 0.0;
    for (double& v : p.input_weight) v = has_squares && chance(0.8) ? scale * decade(-2.0, 0.0) : 0.0;
    for (std::size_t m = 0; m < Nu; ++m) {
      const double middle = random.normal() / scale, width = chance(0.05) ? 0.0 : decade(-1.0, 1.0) / scale;
      p.low[m] = chance(0.1) ? -std::numeric_limits<double>::infinity() : middle - width;
      p.high[m] = chance(0.1) ? std::numeric_limits<double>::infinity() : middle + width;
    }
    p.penalty = {.linear = decade(-1.0, 2.0), .quadratic = chance(0.3) ? 0.0 : decade(-1.0, 2.0)};
    p.all_hard = chance(0.5);
    const double of_inputs = scale * (chance(0.5) ? 0.0 : 1.0);
    for (Row& row : p.limit) {
      row = Row::make(random, of_inputs);
      row.offset = -1e3;  // far away
    }
    const bool has_equation = chance(0.3), has_end_limit = chance(0.5);
    if (has_equation) {
      p.equation = Row::make(random, scale);
      p.equation.u[0] = scale;
    }
    for (Row& row : p.end) row = chance(0.5) ? Row::make(random, 0.0) : Row{};
    if (has_end_limit) p.end_limit = Row::make(random, 0.0);
    p.fit(random, start, horizon, chance(0.35) ? decade(-4.0, 0.3) : 0.0);
    return p;
  }

 private:
  void fit(Random& random, Start x, int horizon, double noise) {
    const auto room = [&] {
      return random.uniform() < 0.4 ? 0.0 : std::pow(10.0, random.uniform(-4.0, 0.0));
    };
    std::array<double, 2> highest{-1e30, -1e30};
    const bool is_limited = random.uniform() < 0.8;
    for (int k = 0; k < horizon; ++k) {
      U<double> u;
      for (std::size_t m = 0; m < u.size(); ++m)
        u[m] = std::fmin(std::fmax(random.normal() / (1.0 + std::fabs(low[m])), low[m]), high[m]);
      demand[static_cast<std::size_t>(k)] = equation.of(x, u);
      for (std::size_t c = 0; c < 2; ++c) highest[c] = std::max(highest[c], limit[c].of(x, u));
      x = dynamics(k, x, u);
    }
    const bool is_noisy = noise > 0.0;
    for (std::size_t c = 0; is_limited && c < 2; ++c)
      limit[c].offset -= highest[c] + (is_noisy ? noise * random.normal() : room());
    for (Row& row : end) row.offset = noise * random.normal() - row.of_state(x);
    end_limit.offset = (is_noisy ? noise * random.normal() : -room()) - end_limit.of_state(x);
    if (equation.u[0] == 0.0) return;
    for (int k = 0; is_noisy && k < horizon; ++k)
      demand[static_cast<std::size_t>(k)] += noise * random.normal();
  }
};

}  // namespace chicane::bench
