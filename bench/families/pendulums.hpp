// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A pole on a cart is swung up from hanging, with a push of at most 12 to 25 N and little room for the cart.
/// States: position [m], angle from hanging [rad], and their rates; input: push [N].
struct CartPole : FamilyProblem<4, 1> {
  static constexpr std::string_view kName = "cart-pole swing-up";
  static constexpr int kNr = 5, kNe = 4, kNc = 2, kHorizon = 50;
  static constexpr double kStep = 0.04, kGravity = 9.81;
  double cart = 1.0, pole = 0.2, length = 0.5, room = 0.6;

  CartPole() { most = {20.0}; }

  CHICANE_INLINE auto dynamics(auto, const auto& x, const auto& u) const {
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
  CHICANE_INLINE auto residual(auto, const auto& x, const auto& u) const {
    const auto& [position, angle, speed, rate] = x;
    return std::make_tuple(1.0 * position, angle - kPi, 0.1 * speed, 0.1 * rate, 0.05 * std::get<0>(u));
  }
  CHICANE_INLINE auto terminal_residual(const auto& x) const {
    const auto& [position, angle, speed, rate] = x;
    return std::make_tuple(10.0 * position, 30.0 * (angle - kPi), 5.0 * speed, 5.0 * rate);
  }
  CHICANE_INLINE auto constraint(auto, const auto& x, const auto&) const {
    return std::make_tuple(std::get<0>(x) - room, -room - std::get<0>(x));
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 100.0}; }

  void draw(Random& random) {
    cart = random.uniform(0.6, 1.5);
    pole = random.uniform(0.1, 0.4);
    length = random.uniform(0.35, 0.7);
    most = {random.uniform(12.0, 25.0)};
    room = random.uniform(0.4, 1.0);
    start = {random.uniform(-0.3, 0.3), random.uniform(-0.5, 0.5), random.uniform(-0.3, 0.3),
             random.uniform(-0.5, 0.5)};
    goal = {0.0, kPi, 0.0, 0.0};
  }
};

/// Two rods standing on a cart, one on the other, are caught and held upright: doubly unstable. States: cart
/// [m], angles from upright [rad], and their rates; input: push [N].
struct DoublePendulum : FamilyProblem<6, 1> {
  static constexpr std::string_view kName = "unstable balance of two rods";
  static constexpr int kNr = 7, kNe = 6, kNc = 2, kHorizon = 60;
  static constexpr double kStep = 0.03, kGravity = 9.81;
  double cart = 1.0, lower = 0.3, upper = 0.2, length_1 = 0.5, length_2 = 0.4, room = 0.8;

  auto rate(const Numbers auto& x, const auto& push) const {
    // M(q) q'' = f(q, q') of two point masses on rods, solved by elimination.
    const double d1 = cart + lower + upper;
    const double d2 = (lower + upper) * length_1;
    const double d3 = upper * length_2;
    const double d4 = (lower + upper) * length_1 * length_1;
    const double d5 = upper * length_1 * length_2;
    const double d6 = upper * length_2 * length_2;
    const auto s1 = sin(x[1]), c1 = cos(x[1]), s2 = sin(x[2]), c2 = cos(x[2]);
    const auto c12 = c1 * c2 + s1 * s2, s12 = s1 * c2 - c1 * s2;
    const auto a12 = d2 * c1, a13 = d3 * c2, a23 = d5 * c12;
    const auto f1 = push + d2 * s1 * x[4] * x[4] + d3 * s2 * x[5] * x[5] - 0.1 * x[3];
    const auto f2 = d2 * kGravity * s1 - d5 * s12 * x[5] * x[5];
    const auto f3 = d3 * kGravity * s2 + d5 * s12 * x[4] * x[4];
    const auto b22 = d4 - a12 * a12 * (1.0 / d1), b23 = a23 - a12 * a13 * (1.0 / d1),
               b33 = d6 - a13 * a13 * (1.0 / d1);
    const auto g2 = f2 - a12 * f1 * (1.0 / d1), g3 = f3 - a13 * f1 * (1.0 / d1);
    const auto det = b22 * b33 - b23 * b23;
    const auto q2 = (b33 * g2 - b23 * g3) / det;
    const auto q3 = (b22 * g3 - b23 * g2) / det;
    return std::array{x[3], x[4], x[5], (f1 - a12 * q2 - a13 * q3) * (1.0 / d1), q2, q3};
  }
  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    return runge_kutta_4(x, kStep, [&](const auto& y) { return rate(y, u[0]); });
  }
  auto residual(auto, const Numbers auto& x, const Numbers auto& u) const {
    return std::array{1.0 * x[0], 3.0 * x[1], 3.0 * x[2], 0.1 * x[3], 0.1 * x[4], 0.1 * x[5], 0.05 * u[0]};
  }
  auto terminal_residual(const Numbers auto& x) const {
    return std::array{5.0 * x[0], 20.0 * x[1], 20.0 * x[2], 3.0 * x[3], 5.0 * x[4], 5.0 * x[5]};
  }
  auto constraint(auto, const Numbers auto& x, const Numbers auto&) const {
    return std::array{x[0] - room, -room - x[0]};
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 100.0}; }

  void draw(Random& random) {
    lower = random.uniform(0.2, 0.4);
    upper = random.uniform(0.1, 0.3);
    length_1 = random.uniform(0.4, 0.7);
    length_2 = random.uniform(0.3, 0.6);
    most = {random.uniform(20.0, 40.0)};
    room = random.uniform(0.6, 1.2);
    start = {random.uniform(-0.4, 0.4), random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25),
             random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),   random.uniform(-0.5, 0.5)};
  }
};

/// An arm with two links in a vertical plane reaches a point with its hand, round a ball. States: joint
/// angles [rad], their rates; inputs: torques [N m].
struct Arm : FamilyProblem<4, 2> {
  static constexpr std::string_view kName = "arm round a ball";
  static constexpr int kNr = 6, kNe = 4, kNc = 3, kHorizon = 50;
  static constexpr double kStep = 0.03, kGravity = 9.81;
  double length_1 = 0.5, length_2 = 0.4, mass_1 = 2.0, mass_2 = 1.0;
  std::array<double, 2> target{0.5, 0.5}, ball{0.6, 0.0};
  double radius = 0.15;

  auto rate(const Numbers auto& x, const auto& shoulder, const auto& elbow) const {
    const double r1 = 0.5 * length_1, r2 = 0.5 * length_2;
    const double i1 = mass_1 * length_1 * length_1 / 12.0, i2 = mass_2 * length_2 * length_2 / 12.0;
    const double a = i1 + i2 + mass_1 * r1 * r1 + mass_2 * (length_1 * length_1 + r2 * r2);
    const double b = mass_2 * length_1 * r2;
    const double d = i2 + mass_2 * r2 * r2;
    const auto s2 = sin(x[1]), c2 = cos(x[1]);
    const auto m11 = a + 2.0 * b * c2, m12 = d + b * c2;
    const auto sway = b * s2;
    const auto g2 = (mass_2 * kGravity * r2) * cos(x[0] + x[1]);
    const auto g1 = ((mass_1 * r1 + mass_2 * length_1) * kGravity) * cos(x[0]) + g2;
    const auto f1 = shoulder + sway * x[3] * (2.0 * x[2] + x[3]) - g1 - 0.2 * x[2];
    const auto f2 = elbow - sway * x[2] * x[2] - g2 - 0.2 * x[3];
    const auto det = m11 * d - m12 * m12;
    return std::array{x[2], x[3], (d * f1 - m12 * f2) / det, (m11 * f2 - m12 * f1) / det};
  }
  auto hand(const Numbers auto& x, double share) const {
    return std::array{length_1 * cos(x[0]) + (share * length_2) * cos(x[0] + x[1]),
                      length_1 * sin(x[0]) + (share * length_2) * sin(x[0] + x[1])};
  }
  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    return runge_kutta_4(x, kStep, [&](const auto& y) { return rate(y, u[0], u[1]); });
  }
  auto residual(auto, const Numbers auto& x, const Numbers auto& u) const {
    const auto at = hand(x, 1.0);
    return std::array{1.0 * (at[0] - target[0]),
                      1.0 * (at[1] - target[1]),
                      0.05 * x[2],
                      0.05 * x[3],
                      0.01 * u[0],
                      0.02 * u[1]};
  }
  auto terminal_residual(const Numbers auto& x) const {
    const auto at = hand(x, 1.0);
    return std::array{30.0 * (at[0] - target[0]), 30.0 * (at[1] - target[1]), 3.0 * x[2], 3.0 * x[3]};
  }
  auto constraint(auto, const Numbers auto& x, const Numbers auto&) const {
    const auto inside = [&](double share) {
      const auto at = hand(x, share);
      const auto dx = at[0] - ball[0], dy = at[1] - ball[1];
      return radius * radius - dx * dx - dy * dy;
    };
    return std::array{inside(0.2), inside(0.2 + 0.4), inside(0.2 + 0.8)};
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 200.0, .quadratic = 100.0}; }

  void draw(Random& random) {
    most = {random.uniform(20.0, 40.0), random.uniform(6.0, 15.0)};
    const double from = random.uniform(-1.8, -0.8), to = random.uniform(0.3, 1.8);
    const double elbow = random.uniform(0.2, 1.2);
    start = {from, elbow, 0.0, 0.0};
    goal = {to, random.uniform(0.2, 1.2), 0.0, 0.0};
    target = hand(goal, 1.0);
    const double way = from + random.uniform(0.3, 0.7) * (to - from) + 0.4, far = random.uniform(0.5, 0.9);
    ball = {far * cos(way), far * sin(way)};
    radius = random.uniform(0.08, 0.2);
  }
};

/// An arm with a motor in its elbow alone swings itself up. States: angle of the upper link from hanging
/// [rad], angle of the elbow, and their rates; input: torque of the elbow [N m].
struct Acrobot : FamilyProblem<4, 1> {
  static constexpr std::string_view kName = "acrobot swing-up";
  static constexpr int kNr = 5, kNe = 4, kNc = 0, kHorizon = 60;
  static constexpr double kStep = 0.05;
  Arm body{};

  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    return runge_kutta_4(x, kStep, [&](const auto& y) {
      return body.rate(std::array{y[0] - 0.5 * kPi, y[1], y[2], y[3]}, 0.0, u[0]);
    });
  }
  auto residual(auto, const Numbers auto& x, const Numbers auto& u) const {
    return std::array{0.1 * (x[0] - kPi), 0.1 * x[1], 0.02 * x[2], 0.02 * x[3], 0.03 * u[0]};
  }
  auto terminal_residual(const Numbers auto& x) const {
    return std::array{10.0 * (x[0] - kPi), 10.0 * x[1], 2.0 * x[2], 2.0 * x[3]};
  }

  void draw(Random& random) {
    body.mass_1 = random.uniform(0.7, 1.3);
    body.mass_2 = random.uniform(0.7, 1.3);
    body.length_1 = random.uniform(0.4, 0.6);
    body.length_2 = random.uniform(0.4, 0.6);
    most = {random.uniform(5.0, 12.0)};
    start = {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0.0, 0.0};
    goal = {kPi, 0.0, 0.0, 0.0};
  }
};

}  // namespace chicane::bench
