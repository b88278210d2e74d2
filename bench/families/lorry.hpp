// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A lorry backs its trailer to a dock behind a wall, where it stands exactly, and must not jackknife on the
/// way. States: position of the trailer's axle [m], its heading [rad], the lorry's heading from the trailer's
/// [rad], speed [m/s], steering [rad]; inputs: acceleration [m/s²], rate of steering [rad/s].
struct Lorry {
  static constexpr std::string_view kName = "lorry with trailer to a dock";
  static constexpr int kNx = 6, kNu = 2, kNr = 8, kNe = 0, kNc = 5, kNeh = 6, kHorizon = 80;
  static constexpr double kStep = 0.25, kBend = 1.0, kSteering = 0.6;
  double base = 3.0, bar = 6.0;

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K, const X& x, const U& u) const {
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
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K, const X& x, const U& u) const {
    const auto& [px, py, heading, bend, speed, steering] = x;
    const auto& [push, turn] = u;
    return std::make_tuple(0.03 * px, 0.03 * py, 0.1 * heading, 0.1 * bend, 0.1 * speed, 0.1 * steering,
                           0.3 * push, 0.3 * turn);
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X&) const {
    return std::make_tuple();
  }
  template <class X>
  CHICANE_INLINE auto terminal_equality(const X& x) const {
    const auto& [px, py, heading, bend, speed, steering] = x;
    return std::make_tuple(1.0 * px, 1.0 * py, 1.0 * heading, 1.0 * bend, 1.0 * speed, 1.0 * steering);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto constraint(K, const X& x, const U&) const {
    const auto& [px, py, heading, bend, speed, steering] = x;
    return std::make_tuple(bend - kBend, -kBend - bend, -0.1 - px, steering - kSteering,
                           -kSteering - steering);
  }
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 10.0, .quadratic = 10.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {-1.0, -0.6}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {1.0, 0.6}; }

  static FamilyInstance<Lorry> make(Random& random) {
    FamilyInstance<Lorry> instance;
    Lorry& p = instance.problem;
    p.base = random.uniform(2.5, 4.0);
    p.bar = random.uniform(4.0, 8.0);
    instance.start = {random.uniform(8.0, 18.0),
                      random.uniform(-4.0, 4.0),
                      random.uniform(-0.4, 0.4),
                      random.uniform(-0.3, 0.3),
                      0.0,
                      0.0};
    return instance;
  }
};

}  // namespace chicane::bench
