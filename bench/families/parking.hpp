// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A cart with steering is parked between two pillars, with turns back and forth. States: position [m],
/// heading [rad], speed [m/s], steering [rad]; inputs: acceleration [m/s²] and steering rate [rad/s].
struct Parking {
  static constexpr std::string_view kName = "parking between pillars";
  static constexpr int kNx = 5, kNu = 2, kNr = 6, kNe = 5, kNc = 4, kHorizon = 60;
  static constexpr double kStep = 0.15, kBase = 2.0, kMostSteering = 0.6;
  std::array<double, 2> pillar_1{-1.5, 1.5}, pillar_2{-1.5, -1.5};
  double radius = 1.0;

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K, const X& x, const U& u) const {
    const auto& [px, py, heading, speed, steering] = x;
    const auto& [push, turn] = u;
    return std::make_tuple(px + kStep * (speed * cos(heading)), py + kStep * (speed * sin(heading)),
                           heading + (kStep / kBase) * (speed * tan(steering)), speed + kStep * push,
                           steering + kStep * turn);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K, const X& x, const U& u) const {
    const auto& [px, py, heading, speed, steering] = x;
    return std::make_tuple(0.05 * px, 0.05 * py, 0.05 * heading, 0.1 * speed, 0.2 * std::get<0>(u),
                           0.2 * std::get<1>(u));
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X& x) const {
    const auto& [px, py, heading, speed, steering] = x;
    return std::make_tuple(10.0 * px, 10.0 * py, 10.0 * heading, 5.0 * speed, 1.0 * steering);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto constraint(K, const X& x, const U&) const {
    const auto inside = [&](const std::array<double, 2>& pillar) {
      const auto dx = std::get<0>(x) - pillar[0];
      const auto dy = std::get<1>(x) - pillar[1];
      return radius * radius - dx * dx - dy * dy;
    };
    return std::make_tuple(inside(pillar_1), inside(pillar_2), std::get<4>(x) - kMostSteering,
                           -kMostSteering - std::get<4>(x));
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 50.0, .quadratic = 50.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {-2.0, -1.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {2.0, 1.0}; }

  static FamilyInstance<Parking> make(Random& random) {
    FamilyInstance<Parking> instance;
    Parking& p = instance.problem;
    p.radius = random.uniform(0.7, 1.2);
    p.pillar_1 = {random.uniform(-2.0, -1.0), p.radius + random.uniform(0.2, 0.6)};
    p.pillar_2 = {random.uniform(-2.0, -1.0), -p.radius - random.uniform(0.2, 0.6)};
    instance.start = {random.uniform(-5.0, 2.0), random.uniform(2.5, 5.0), random.uniform(-kPi, kPi),
                      random.uniform(-0.5, 0.5), 0.0};
    return instance;
  }
};

}  // namespace chicane::bench
