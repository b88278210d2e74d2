// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A rocket lands upright on its engine, which can neither be shut off nor swivel far, and burns the mass it
/// carries. States: position [m], speeds [m/s], pitch [rad], its rate, mass [t]; inputs: thrust in units of
/// `unit` kN, swivel [rad].
struct RocketLanding {
  static constexpr std::string_view kName = "rocket landing";
  static constexpr int kNx = 7, kNu = 2, kNr = 6, kNe = 6, kNc = 2, kHorizon = 60;
  static constexpr double kGravity = 9.81, kLever = 8.0, kFlow = 0.00035;
  double step = 0.25;
  double least = 180.0, most = 600.0;  ///< thrust [kN]
  double unit = 1.0;                   ///< of the thrust [kN]: answers must not depend on it
  double glide = 0.4;                  ///< least slope of the approach

  template <class K, class X, class U>
  CHICANE_INLINE auto dynamics(K, const X& x, const U& u) const {
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    const auto thrust = unit * std::get<0>(u);
    const auto& swivel = std::get<1>(u);
    const auto push = thrust / mass;
    const auto wx = vx + step * (push * sin(pitch + swivel));
    const auto wz = vz + step * (push * cos(pitch + swivel) - kGravity);
    const auto w = rate - step * (kLever * push * sin(swivel) * (1.0 / 120.0));
    return std::make_tuple(px + step * wx, pz + step * wz, wx, wz, pitch + step * w, w,
                           mass - (step * kFlow) * thrust);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto residual(K, const X& x, const U& u) const {
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    return std::make_tuple(0.02 * px, 0.02 * vx, 1.0 * pitch, 1.0 * rate, (0.003 * unit) * std::get<0>(u),
                           2.0 * std::get<1>(u));
  }
  template <class X>
  CHICANE_INLINE auto terminal_residual(const X& x) const {
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    return std::make_tuple(3.0 * px, 3.0 * pz, 3.0 * vx, 3.0 * vz, 30.0 * pitch, 30.0 * rate);
  }
  template <class K, class X, class U>
  CHICANE_INLINE auto constraint(K, const X& x, const U&) const {  // stay inside a cone above the pad
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    return std::make_tuple(glide * px - pz - 1.0, -glide * px - pz - 1.0);
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 10.0, .quadratic = 10.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {least / unit, -0.2}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {most / unit, 0.2}; }

  static FamilyInstance<RocketLanding> make(Random& random) {
    FamilyInstance<RocketLanding> instance;
    RocketLanding& p = instance.problem;
    const double mass = random.uniform(22.0, 30.0);
    const double height = random.uniform(400.0, 700.0);
    p.unit = random.uniform() < 0.5 ? 1.0 : 0.001;  // kN or N
    p.glide = random.uniform(0.2, 0.6);
    p.most = mass * kGravity * random.uniform(1.7, 2.2);
    p.least = 0.4 * p.most;
    instance.start = {random.uniform(-150.0, 150.0),
                      height,
                      random.uniform(-20.0, 20.0),
                      -height * random.uniform(0.10, 0.14),
                      random.uniform(-0.1, 0.1),
                      0.0,
                      mass};
    instance.goal = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.95 * mass};
    instance.idle = {mass * kGravity / p.unit, 0.0};
    return instance;
  }
};

}  // namespace chicane::bench
