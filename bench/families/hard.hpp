// SPDX-License-Identifier: MIT
#pragma once

#include "families/flights.hpp"
#include "families/machines.hpp"
#include "families/pendulums.hpp"

namespace chicane::bench {

// Families with something that must hold: goals that are reached exactly, limits without a penalty, a path
// that is kept, a time that is free, a motion that repeats itself.

/// A family whose end is met and whose limits hold exactly; terminal_equality() says what its end is.
template <class Soft>
struct Exactly : Soft {
  static constexpr int kNe = 0;
  CHICANE_INLINE auto terminal_residual(const auto&) const { return std::make_tuple(); }
  [[nodiscard]] bool is_hard(int) const { return true; }
};

/// The cart stands and the pole is upright after two seconds, inside the room.
struct HardCartPole : Exactly<CartPole> {
  static constexpr std::string_view kName = "cart-pole swing-up, exactly";
  static constexpr int kNeh = 4;
  CHICANE_INLINE auto terminal_equality(const auto& x) const {
    const auto& [position, angle, speed, rate] = x;
    return std::make_tuple(position, angle - kPi, speed, rate);
  }
};

/// The rocket stands on the pad, and has never been below its cone.
struct HardRocketLanding : Exactly<RocketLanding> {
  static constexpr std::string_view kName = "rocket landing, exactly";
  static constexpr int kNeh = 6;
  CHICANE_INLINE auto terminal_equality(const auto& x) const {
    const auto& [px, pz, vx, vz, pitch, rate, mass] = x;
    return std::make_tuple(px, pz, vx, vz, pitch, rate);
  }
};

/// The quadrotor hovers at its goal, and does not touch the obstacle.
struct HardPlanarQuadrotor : Exactly<PlanarQuadrotor> {
  static constexpr std::string_view kName = "planar quadrotor, exactly";
  static constexpr int kNeh = 6;
  CHICANE_INLINE auto terminal_equality(const auto& x) const {
    const auto& [px, pz, pitch, vx, vz, rate] = x;
    return std::make_tuple(px - goal[0], pz - goal[1], pitch, vx, vz, rate);
  }
};

/// The cart stands in its place with its wheels nearly straight, and has touched no pillar.
struct HardParking : Exactly<Parking> {
  static constexpr std::string_view kName = "parking, exactly";
  static constexpr int kNeh = 4, kNec = 2;
  CHICANE_INLINE auto terminal_equality(const auto& x) const {
    const auto& [px, py, heading, speed, steering] = x;
    return std::make_tuple(px, py, heading, speed);
  }
  CHICANE_INLINE auto terminal_constraint(const auto& x) const {
    return std::make_tuple(std::get<4>(x) - 0.05, -0.05 - std::get<4>(x));
  }
};

/// The arm's hand goes to its target along the straight line from where it is.
struct ArmOnALine : Arm {
  static constexpr std::string_view kName = "arm along a line";
  static constexpr bool kRecedes = false;  ///< a disturbance leaves the line
  static constexpr int kNe = 0, kNc = 0, kNh = 1, kNeh = 4;
  std::array<double, 2> from{}, across{};
  solver::StageData<kHorizon> is_on;  ///< 0: the first stage is given, else 1

  auto terminal_residual(const Numbers auto& x) const { return FamilyProblem::terminal_residual(x); }
  auto equality(auto k, const Numbers auto& x, const Numbers auto&) const {
    const auto at = hand(x, 1.0);
    return std::array{is_on.at(k) * (across[0] * (at[0] - from[0]) + across[1] * (at[1] - from[1]))};
  }
  auto terminal_equality(const Numbers auto& x) const {
    const auto at = hand(x, 1.0);
    return std::array{at[0] - target[0], at[1] - target[1], x[2], x[3]};
  }
  void draw(Random& random) {
    Arm::draw(random);
    from = hand(start, 1.0);
    const double dx = target[0] - from[0], dy = target[1] - from[1], way = hypot(dx, dy);
    across = {-dy / way, dx / way};
    for (std::size_t k = 1; k < kHorizon; ++k) is_on[k] = 1.0;
  }
};

/// A crane brings its load to a point in the shortest time, without more swing than 0.2 rad. The duration is
/// a state, which an input of the first stage sets. States: trolley [m], swing [rad], their rates, duration
/// [s]; inputs: acceleration [m/s²], duration [s].
struct CraneInLeastTime : FamilyProblem<5, 2>, AllHard<10> {
  static constexpr std::string_view kName = "crane in least time";
  static constexpr int kNr = 2, kNe = 1, kNc = 2, kNeh = 4, kHorizon = 50;
  static constexpr double kGravity = 9.81, kSwing = 0.2;
  static constexpr bool kRecedes = false;  ///< a duration cannot be set twice
  double rope = 2.0, push_limit = 2.0;

  CHICANE_INLINE auto dynamics(auto, const auto& x, const auto& u) const {
    const auto& [trolley, swing, speed, rate, duration] = x;
    const auto& [push, set] = u;
    const auto total = duration + set;
    const auto step = total * (1.0 / kHorizon);
    const auto v = speed + step * push;
    const auto w = rate - step * ((push * cos(swing) + kGravity * sin(swing)) * (1.0 / rope));
    return std::make_tuple(trolley + step * v, swing + step * w, v, w, total);
  }
  CHICANE_INLINE auto residual(auto, const auto& x, const auto& u) const {
    return std::make_tuple(0.01 * std::get<0>(u), 0.01 * std::get<3>(x));
  }
  CHICANE_INLINE auto terminal_residual(const auto& x) const { return std::make_tuple(1.0 * std::get<4>(x)); }
  CHICANE_INLINE auto terminal_equality(const auto& x) const {
    const auto& [trolley, swing, speed, rate, duration] = x;
    return std::make_tuple(trolley - goal[0], swing, speed, rate);
  }
  CHICANE_INLINE auto constraint(auto, const auto& x, const auto&) const {
    return std::make_tuple(std::get<1>(x) - kSwing, -kSwing - std::get<1>(x));
  }
  [[nodiscard]] std::array<double, 2> input_lower(int k) const { return {-push_limit, k == 0 ? 1.0 : 0.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int k) const { return {push_limit, k == 0 ? 20.0 : 0.0}; }

  void draw(Random& random) {
    goal = {random.uniform(2.0, 8.0), 0.0, 0.0, 0.0, 5.0};
    rope = random.uniform(1.0, 4.0);
    push_limit = random.uniform(1.0, 3.0);
    start = {0.0, random.uniform(-0.1, 0.1), random.uniform(-0.5, 0.5), random.uniform(-0.1, 0.1), 0.0};
    idle = {0.0, 5.0};
  }
};

/// A damped pendulum is driven round a motion that repeats itself, near one that is asked for. Its first
/// state is free: two inputs of the first stage set it, two states remember it. States: angle [rad], rate,
/// and both at the start; inputs: torque, and what is added to both at the start.
struct PeriodicPendulum : FamilyProblem<4, 3> {
  static constexpr std::string_view kName = "pendulum that repeats itself";
  static constexpr int kNr = 2, kNe = 0, kNc = 0, kNeh = 2, kHorizon = 50;
  static constexpr double kStep = 0.05;
  static constexpr bool kRecedes = false;  ///< a period is a period
  double stiffness = 9.0, damping = 0.3, strongest = 6.0, effort = 0.1;
  solver::StageData<kHorizon> wanted;

  CHICANE_INLINE auto dynamics(auto, const auto& x, const auto& u) const {
    const auto& [angle, rate, first_angle, first_rate] = x;
    const auto& [torque, add_angle, add_rate] = u;
    const auto a = angle + add_angle, w = rate + add_rate;
    const auto next = w + kStep * (torque - stiffness * sin(a) - damping * w);
    return std::make_tuple(a + kStep * next, next, first_angle + add_angle, first_rate + add_rate);
  }
  CHICANE_INLINE auto residual(auto k, const auto& x, const auto& u) const {
    return std::make_tuple(std::get<0>(x) + std::get<1>(u) - wanted.at(k), effort * std::get<0>(u));
  }
  CHICANE_INLINE auto terminal_residual(const auto&) const { return std::make_tuple(); }
  CHICANE_INLINE auto terminal_equality(const auto& x) const {
    const auto& [angle, rate, first_angle, first_rate] = x;
    return std::make_tuple(angle - first_angle, rate - first_rate);
  }
  [[nodiscard]] std::array<double, 3> input_lower(int k) const {
    return {-strongest, k == 0 ? -3.0 : 0.0, k == 0 ? -10.0 : 0.0};
  }
  [[nodiscard]] std::array<double, 3> input_upper(int k) const {
    return {strongest, k == 0 ? 3.0 : 0.0, k == 0 ? 10.0 : 0.0};
  }

  void draw(Random& random) {
    stiffness = random.uniform(2.0, 15.0);
    damping = random.uniform(0.05, 1.0);
    strongest = random.uniform(2.0, 10.0);
    const double size = random.uniform(0.5, 2.5), second = random.uniform(-0.5, 0.5);
    for (int k = 0; k < kHorizon; ++k) {
      const double phase = 2.0 * kPi * k / kHorizon;
      wanted[static_cast<std::size_t>(k)] = size * (sin(phase) + second * sin(2.0 * phase));
    }
  }
};

}  // namespace chicane::bench
