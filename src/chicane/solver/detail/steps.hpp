// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "chicane/base/inlining.hpp"
#include "chicane/solver/detail/iterate.hpp"

namespace chicane::solver {

/// The step of the quadratic program, stage after stage of one variable, with `Cut` inputs cut to their
/// bounds; returns the longest move of an input.
template <class Arch, bool Cut, class Lq, class Step>
double collect_step(const Lq& lq, std::size_t horizon, Step& step) noexcept {
  using V = Stages<Arch>;
  step.horizon = horizon;
  for (std::size_t k0 = 0; k0 <= horizon; k0 += 8) {
    for (std::size_t block = 0; block < Lq::kLanes; block += 8) {
      V rows[8];
      unroll<8>([&](auto lane)
                    CHICANE_INLINE { rows[lane] = V::load(lq.dx[std::min(k0 + lane, horizon)] + block); });
      transpose(rows);
      unroll<8>([&](auto i) CHICANE_INLINE {
        if (block + i < Lq::kNx) rows[i].store(step.x[block + i] + k0);
      });
    }
  }
  double longest = 0.0;
  for (std::size_t m = 0; m < Lq::kNu; ++m) {
    for (std::size_t k = 0; k < horizon; ++k) {
      const double du =
          Cut ? std::min(std::max(lq.du[k][m], lq.lq.low[m][k]), lq.lq.high[m][k]) : lq.du[k][m];
      step.u[m][k] = du;
      longest = std::max(longest, std::fabs(du));
    }
  }
  return longest;
}

/// to = from + length · step. `to` may be `from`.
template <class Arch, class Point>
void add_step(const Point& from, double length, const Point& step, Point& to) noexcept {
  using V = Stages<Arch>;
  to.horizon = from.horizon;
  for (std::size_t k = 0; k <= from.horizon; k += 8) {
    const auto move = [&](const double* value, const double* change, double* moved) CHICANE_INLINE {
      (V::load(value + k) + length * V::load(change + k)).store(moved + k);
    };
    for (std::size_t i = 0; i < std::size(from.x); ++i) move(from.x[i], step.x[i], to.x[i]);
    for (std::size_t m = 0; m < std::size(from.u); ++m) move(from.u[m], step.u[m], to.u[m]);
  }
}

/// Whether nothing moves by more than rounding between two points.
template <class Point>
bool stays(const Point& from, const Point& to) noexcept {
  constexpr double kTiny = 1e-15;
  const auto keeps = [&](const auto& a, const auto& b, std::size_t count) {
    for (std::size_t i = 0; i < std::size(a); ++i) {
      for (std::size_t k = 0; k < count; ++k) {
        if (std::fabs(a[i][k] - b[i][k]) > kTiny * (1.0 + std::fabs(a[i][k]))) return false;
      }
    }
    return true;
  };
  return keeps(from.u, to.u, from.horizon) && keeps(from.x, to.x, from.horizon + 1);
}

/// The longest move of an input between two points.
template <class Point>
CHICANE_INLINE inline double longest_move(const Point& from, const Point& to) noexcept {
  double longest = 0.0;
  for (std::size_t m = 0; m < std::size(from.u); ++m) {
    for (std::size_t k = 0; k < from.horizon; ++k)
      longest = std::max(longest, std::fabs(to.u[m][k] - from.u[m][k]));
  }
  return longest;
}

}  // namespace chicane::solver
