// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A pole on a cart is swung up from hanging, with a push of at most 12 to 25 N and little room for the cart.
/// States: position [m], angle from hanging [rad], and their rates; input: push [N].
struct CartPole {
  static constexpr std::string_view kName = "cart-pole swing-up";
  static constexpr int kNx = 4, kNu = 1, kNr = 5, kNe = 4, kNc = 2, kHorizon = 50;
  static constexpr double kStep = 0.04, kGravity = 9.81;
  double cart = 1.0, pole = 0.2, length = 0.5, most = 20.0, room = 0.6;

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K, const X& x, const U& u) const {
    const auto& [position, angle, speed, rate] = x;
    const auto& [push] = u;
    const auto s = sin(angle), c = cos(angle);
    const auto inertia = cart + pole * s * s;
    const auto swing = pole * length * rate * rate;
    const auto v = speed + kStep * ((push + s * (swing + pole * kGravity * c)) / inertia);
    const auto torque = push * c + swing * s * c + (cart + pole) * kGravity * s;
    const auto w = rate - kStep * (torque / (length * inertia));
    return std::make_tuple(position + kStep * v, angle + kStep * w, v, w);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K, const X& x, const U& u) const {
    const auto& [position, angle, speed, rate] = x;
    return std::make_tuple(1.0 * position, angle - kPi, 0.1 * speed, 0.1 * rate, 0.05 * std::get<0>(u));
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X& x) const {
    const auto& [position, angle, speed, rate] = x;
    return std::make_tuple(10.0 * position, 30.0 * (angle - kPi), 5.0 * speed, 5.0 * rate);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto constraint(K, const X& x, const U&) const {
    return std::make_tuple(std::get<0>(x) - room, -room - std::get<0>(x));
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 100.0}; }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-most}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {most}; }

  static FamilyInstance<CartPole> make(Random& random) {
    FamilyInstance<CartPole> instance;
    CartPole& p = instance.problem;
    p.cart = random.uniform(0.6, 1.5);
    p.pole = random.uniform(0.1, 0.4);
    p.length = random.uniform(0.35, 0.7);
    p.most = random.uniform(12.0, 25.0);
    p.room = random.uniform(0.4, 1.0);
    instance.start = {random.uniform(-0.3, 0.3), random.uniform(-0.5, 0.5), random.uniform(-0.3, 0.3),
                      random.uniform(-0.5, 0.5)};
    instance.goal = {0.0, kPi, 0.0, 0.0};
    return instance;
  }
};

}  // namespace chicane::bench
