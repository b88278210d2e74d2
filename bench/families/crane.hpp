// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A crane carries a load over a wall and sets it down without swing. States: trolley [m], rope [m], swing
/// [rad], and their rates; inputs: accelerations of trolley and hoist [m/s²].
struct Crane {
  static constexpr std::string_view kName = "crane over a wall";
  static constexpr int kNx = 6, kNu = 2, kNr = 8, kNe = 6, kNc = 2, kHorizon = 60;
  static constexpr double kStep = 0.1, kGravity = 9.81;
  double goal = 6.0, rope = 3.0, wall = 3.0, height = 1.5;

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K, const X& x, const U& u) const {
    const auto& [trolley, length, swing, speed, hoist, rate] = x;
    const auto& [push, pull] = u;
    const auto v = speed + kStep * push;
    const auto h = hoist + kStep * pull;
    const auto w = rate - kStep * ((push * cos(swing) + kGravity * sin(swing) + 2.0 * hoist * rate) / length);
    return std::make_tuple(trolley + kStep * v, length + kStep * h, swing + kStep * w, v, h, w);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K, const X& x, const U& u) const {
    const auto& [trolley, length, swing, speed, hoist, rate] = x;
    return std::make_tuple(0.1 * (trolley - goal), 0.1 * (length - rope), 0.5 * swing, 0.05 * speed,
                           0.05 * hoist, 0.1 * rate, 0.1 * std::get<0>(u), 0.1 * std::get<1>(u));
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X& x) const {
    const auto& [trolley, length, swing, speed, hoist, rate] = x;
    return std::make_tuple(10.0 * (trolley - goal), 10.0 * (length - rope), 20.0 * swing, 5.0 * speed,
                           5.0 * hoist, 10.0 * rate);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto constraint(K, const X& x, const U&) const {
    const auto& [trolley, length, swing, speed, hoist, rate] = x;
    const auto at = (trolley + length * sin(swing) - wall) * (1.0 / 0.7);
    const auto depth = length * cos(swing);
    return std::make_tuple(depth - 4.0 + height * 2.0 * exp(-(at * at)), 0.5 - length);  // a smooth wall
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 100.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {-2.0, -2.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {2.0, 2.0}; }

  static FamilyInstance<Crane> make(Random& random) {
    FamilyInstance<Crane> instance;
    Crane& p = instance.problem;
    p.goal = random.uniform(4.5, 7.0);
    p.rope = random.uniform(2.0, 3.5);
    p.wall = p.goal * random.uniform(0.4, 0.6);
    p.height = random.uniform(0.7, 1.4);
    const double length = random.uniform(2.0, 3.5);
    instance.start = {
        0.0, length, random.uniform(-0.3, 0.3), random.uniform(-0.5, 0.5), 0.0, random.uniform(-0.3, 0.3)};
    instance.goal = {p.goal, p.rope, 0.0, 0.0, 0.0, 0.0};
    return instance;
  }
};

}  // namespace chicane::bench
