// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A crane carries a load over a wall and sets it down without swing. States: trolley [m], rope [m], swing
/// [rad], and their rates; inputs: accelerations of trolley and hoist [m/s²].
struct Crane : FamilyProblem<6, 2> {
  static constexpr std::string_view kName = "crane over a wall";
  static constexpr int kNr = 8, kNe = 6, kNc = 2, kHorizon = 60;
  static constexpr double kStep = 0.1, kGravity = 9.81;
  double wall = 3.0, height = 1.5;

  CHICANE_INLINE auto dynamics(auto, const auto& x, const auto& u) const {
    const auto& [trolley, length, swing, speed, hoist, rate] = x;
    const auto& [push, pull] = u;
    const auto v = speed + kStep * push;
    const auto h = hoist + kStep * pull;
    const auto w = rate - kStep * ((push * cos(swing) + kGravity * sin(swing) + 2.0 * hoist * rate) / length);
    return std::make_tuple(trolley + kStep * v, length + kStep * h, swing + kStep * w, v, h, w);
  }
  CHICANE_INLINE auto residual(auto, const auto& x, const auto& u) const {
    const auto& [trolley, length, swing, speed, hoist, rate] = x;
    return std::make_tuple(0.1 * (trolley - goal[0]), 0.1 * (length - goal[1]), 0.5 * swing, 0.05 * speed,
                           0.05 * hoist, 0.1 * rate, 0.1 * std::get<0>(u), 0.1 * std::get<1>(u));
  }
  CHICANE_INLINE auto terminal_residual(const auto& x) const {
    const auto& [trolley, length, swing, speed, hoist, rate] = x;
    return std::make_tuple(10.0 * (trolley - goal[0]), 10.0 * (length - goal[1]), 20.0 * swing, 5.0 * speed,
                           5.0 * hoist, 10.0 * rate);
  }
  CHICANE_INLINE auto constraint(auto, const auto& x, const auto&) const {
    const auto& [trolley, length, swing, speed, hoist, rate] = x;
    const auto at = (trolley + length * sin(swing) - wall) * (1.0 / 0.7);
    const auto depth = length * cos(swing);
    return std::make_tuple(depth - 4.0 + height * 2.0 * exp(-(at * at)), 0.5 - length);  // a smooth wall
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 100.0}; }

  void draw(Random& random) {
    goal = {random.uniform(4.5, 7.0), random.uniform(2.0, 3.5)};
    wall = goal[0] * random.uniform(0.4, 0.6);
    height = random.uniform(0.7, 1.4);
    most = {2.0, 2.0};
    const double length = random.uniform(2.0, 3.5);
    start = {
        0.0, length, random.uniform(-0.3, 0.3), random.uniform(-0.5, 0.5), 0.0, random.uniform(-0.3, 0.3)};
  }
};

/// A cart with steering is parked between two pillars, with turns back and forth. States: position [m],
/// heading [rad], speed [m/s], steering [rad]; inputs: acceleration [m/s²] and steering rate [rad/s].
struct Parking : FamilyProblem<5, 2> {
  static constexpr std::string_view kName = "parking between pillars";
  static constexpr int kNr = 6, kNe = 5, kNc = 4, kHorizon = 60;
  static constexpr double kStep = 0.15, kBase = 2.0, kMostSteering = 0.6;
  std::array<double, 2> pillar_1{-1.5, 1.5}, pillar_2{-1.5, -1.5};
  double radius = 1.0;

  CHICANE_INLINE auto dynamics(auto, const auto& x, const auto& u) const {
    const auto& [px, py, heading, speed, steering] = x;
    const auto& [push, turn] = u;
    return std::make_tuple(px + kStep * (speed * cos(heading)), py + kStep * (speed * sin(heading)),
                           heading + (kStep / kBase) * (speed * tan(steering)), speed + kStep * push,
                           steering + kStep * turn);
  }
  CHICANE_INLINE auto residual(auto, const auto& x, const auto& u) const {
    const auto& [px, py, heading, speed, steering] = x;
    return std::make_tuple(0.05 * px, 0.05 * py, 0.05 * heading, 0.1 * speed, 0.2 * std::get<0>(u),
                           0.2 * std::get<1>(u));
  }
  CHICANE_INLINE auto terminal_residual(const auto& x) const {
    const auto& [px, py, heading, speed, steering] = x;
    return std::make_tuple(10.0 * px, 10.0 * py, 10.0 * heading, 5.0 * speed, 1.0 * steering);
  }
  CHICANE_INLINE auto constraint(auto, const auto& x, const auto&) const {
    const auto inside = [&](const std::array<double, 2>& pillar) {
      const auto dx = std::get<0>(x) - pillar[0];
      const auto dy = std::get<1>(x) - pillar[1];
      return radius * radius - dx * dx - dy * dy;
    };
    return std::make_tuple(inside(pillar_1), inside(pillar_2), std::get<4>(x) - kMostSteering,
                           -kMostSteering - std::get<4>(x));
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 50.0, .quadratic = 50.0}; }

  void draw(Random& random) {
    most = {2.0, 1.0};
    radius = random.uniform(0.7, 1.2);
    pillar_1 = {random.uniform(-2.0, -1.0), radius + random.uniform(0.2, 0.6)};
    pillar_2 = {random.uniform(-2.0, -1.0), -radius - random.uniform(0.2, 0.6)};
    start = {random.uniform(-5.0, 2.0), random.uniform(2.5, 5.0), random.uniform(-kPi, kPi),
             random.uniform(-0.5, 0.5), 0.0};
  }
};

/// A lorry backs its trailer to a dock behind a wall, where it stands exactly, and must not jackknife on the
/// way. States: position of the trailer's axle [m], its heading [rad], the lorry's heading from the trailer's
/// [rad], speed [m/s], steering [rad]; inputs: acceleration [m/s²], rate of steering [rad/s].
struct Lorry : FamilyProblem<6, 2>, AllHard<10> {
  static constexpr std::string_view kName = "lorry with trailer to a dock";
  static constexpr int kNr = 8, kNe = 0, kNc = 5, kNeh = 6, kHorizon = 80;
  static constexpr double kStep = 0.25, kBend = 1.0, kSteering = 0.6;
  double base = 3.0, bar = 6.0;

  CHICANE_INLINE auto dynamics(auto, const auto& x, const auto& u) const {
    const auto& [px, py, heading, bend, speed, steering] = x;
    const auto& [push, turn] = u;
    const auto v = speed + kStep * push;
    const auto d = steering + kStep * turn;
    const auto w = v * sin(bend) * (1.0 / bar);
    const auto h = heading + kStep * w;
    const auto b = bend + kStep * (v * tan(d) * (1.0 / base) - w);
    const auto along = v * cos(bend);
    return std::make_tuple(px + kStep * (along * cos(h)), py + kStep * (along * sin(h)), h, b, v, d);
  }
  CHICANE_INLINE auto residual(auto, const auto& x, const auto& u) const {
    const auto& [px, py, heading, bend, speed, steering] = x;
    const auto& [push, turn] = u;
    return std::make_tuple(0.03 * px, 0.03 * py, 0.1 * heading, 0.1 * bend, 0.1 * speed, 0.1 * steering,
                           0.3 * push, 0.3 * turn);
  }
  CHICANE_INLINE auto terminal_residual(const auto&) const { return std::make_tuple(); }
  CHICANE_INLINE auto terminal_equality(const auto& x) const {
    const auto& [px, py, heading, bend, speed, steering] = x;
    return std::make_tuple(1.0 * px, 1.0 * py, 1.0 * heading, 1.0 * bend, 1.0 * speed, 1.0 * steering);
  }
  CHICANE_INLINE auto constraint(auto, const auto& x, const auto&) const {
    const auto& [px, py, heading, bend, speed, steering] = x;
    return std::make_tuple(bend - kBend, -kBend - bend, -0.1 - px, steering - kSteering,
                           -kSteering - steering);
  }

  void draw(Random& random) {
    most = {1.0, 0.6};
    base = random.uniform(2.5, 4.0);
    bar = random.uniform(4.0, 8.0);
    start = {random.uniform(8.0, 18.0),
             random.uniform(-4.0, 4.0),
             random.uniform(-0.4, 0.4),
             random.uniform(-0.3, 0.3),
             0.0,
             0.0};
  }
};

/// A stirred tank with an exothermic reaction is brought to an unstable operating point by its coolant
/// (Hicks, Ray 1971). States: concentration and temperature, scaled; its flow, whose change is the
/// input and has bounds, is a third state.
struct Reactor : FamilyProblem<3, 1> {
  static constexpr std::string_view kName = "stirred tank reactor";
  static constexpr int kNr = 3, kNe = 2, kNc = 3, kHorizon = 80;
  static constexpr double kStep = 0.15;
  double concentration = 0.4, temperature = 0.7, flow = 0.0, hottest = 0.8;
  static constexpr double kMostFlow = 700.0;

  static auto change(const Numbers auto& x, const auto& coolant) {
    const auto reaction = 300.0 * x[0] * exp(-5.0 / x[1]);
    return std::array{(1.0 - x[0]) * (1.0 / 20.0) - reaction,
                      (0.3947 - x[1]) * (1.0 / 20.0) + reaction - 1.95e-4 * coolant * (x[1] - 0.3816)};
  }
  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    auto y = std::array{x[0], x[1]};
    for (int part = 0; part < 2; ++part)
      y = runge_kutta_4(y, 5.0 * kStep, [&](const auto& z) { return change(z, x[2] + u[0]); });
    return std::array{y[0], y[1], x[2] + u[0]};
  }
  auto residual(auto, const Numbers auto& x, const Numbers auto& u) const {
    return std::array{10.0 * (x[0] - concentration), 10.0 * (x[1] - temperature),
                      0.002 * (x[2] + u[0] - flow)};
  }
  auto terminal_residual(const Numbers auto& x) const {
    return std::array{50.0 * (x[0] - concentration), 50.0 * (x[1] - temperature)};
  }
  auto constraint(auto, const Numbers auto& x, const Numbers auto& u) const {
    const auto share = (x[2] + u[0]) / kMostFlow;
    return std::array{x[1] - hottest, share - 1.0, -share};
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 100.0, .quadratic = 1000.0}; }

  void draw(Random& random) {
    temperature = random.uniform(0.60, 0.72);
    const double reaction = 300.0 * exp(-5.0 / temperature);
    concentration = (1.0 / 20.0) / (1.0 / 20.0 + reaction);
    flow = ((0.3947 - temperature) / 20.0 + reaction * concentration) / (1.95e-4 * (temperature - 0.3816));
    hottest = temperature + random.uniform(0.02, 0.1);
    most = {random.uniform(30.0, 120.0)};
    const double last = random.uniform(100.0, 400.0);
    start = {random.uniform(0.1, 0.9), random.uniform(0.45, 0.8), last};
    goal = {concentration, temperature, last};
  }
};

}  // namespace chicane::bench
