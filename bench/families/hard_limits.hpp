// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

// Families of the literature whose limits along the way must hold, each with instances that leave no
// solution.

/// Bryson and Denham's problem: a mass comes back after a second with its speed reversed, and goes no further
/// than a limit on the way. Convex. States: position, speed; input: acceleration.
struct BrysonDenham {
  static constexpr std::string_view kName = "Bryson-Denham";
  static constexpr int kNx = 2, kNu = 1, kNr = 1, kNe = 0, kNc = 1, kNeh = 2, kHorizon = 50;
  static constexpr double kStep = 1.0 / kHorizon;
  static constexpr bool kRecedes = false;
  double limit = 0.1, speed = 1.0, most = 100.0;

  template <class K, class T>
  std::array<T, 2> dynamics(K, const std::array<T, 2>& x, const std::array<T, 1>& u) const {
    return {x[0] + kStep * x[1] + (0.5 * kStep * kStep) * u[0], x[1] + kStep * u[0]};
  }
  template <class K, class T>
  std::array<T, 1> residual(K, const std::array<T, 2>&, const std::array<T, 1>& u) const {
    return {0.1414213562373095 * u[0]};
  }
  template <class T>
  std::array<T, 0> terminal_residual(const std::array<T, 2>&) const {
    return {};
  }
  template <class K, class T>
  std::array<T, 1> constraint(K, const std::array<T, 2>& x, const std::array<T, 1>&) const {
    return {x[0] - limit};
  }
  template <class T>
  std::array<T, 2> terminal_equality(const std::array<T, 2>& x) const {
    return {1.0 * x[0], x[1] + speed};
  }
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 10.0, .quadratic = 10.0}; }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-most}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {most}; }

  static FamilyInstance<BrysonDenham> make(Random& random) {
    FamilyInstance<BrysonDenham> instance;
    instance.problem.limit = random.uniform(0.03, 0.2);
    instance.problem.speed = random.uniform(0.7, 1.3);
    instance.start = {0.0, instance.problem.speed};
    instance.goal = {0.0, -instance.problem.speed};
    return instance;
  }
  /// Brakes too weak for the limit.
  static FamilyInstance<BrysonDenham> make_impossible(Random& random) {
    FamilyInstance<BrysonDenham> instance;
    BrysonDenham& p = instance.problem;
    p.speed = random.uniform(0.8, 1.2);
    p.most = random.uniform(3.0, 8.0);
    p.limit = random.uniform(0.2, 0.8) * p.speed * p.speed / (2.0 * p.most);
    instance.start = {0.0, p.speed};
    instance.goal = {0.0, -p.speed};
    return instance;
  }
};

/// A cart goes through gates in a narrow corridor. States: position along and across [m], heading [rad],
/// speed [m/s]; inputs: rate of the heading [rad/s], acceleration [m/s²].
struct Gates {
  static constexpr std::string_view kName = "cart through gates";
  static constexpr int kNx = 4, kNu = 2, kNr = 4, kNe = 1, kNc = 2, kHorizon = 60;
  static constexpr double kStep = 0.05;
  static constexpr bool kRecedes = false;
  double width = 0.4, turn = 1.5;
  std::array<double, 3> gate{};

  template <class T>
  [[nodiscard]] T middle(const T& along) const {
    const T first = tanh(3.0 * (along - 1.5)), second = tanh(3.0 * (along - 3.0));
    return 0.5 * (gate[0] + gate[2]) + (0.5 * (gate[1] - gate[0])) * first +
           (0.5 * (gate[2] - gate[1])) * second;
  }
  template <class K, class T>
  std::array<T, 4> dynamics(K, const std::array<T, 4>& x, const std::array<T, 2>& u) const {
    const T heading = x[2] + (0.5 * kStep) * u[0], speed = x[3] + (0.5 * kStep) * u[1];
    return {x[0] + kStep * speed * cos(heading), x[1] + kStep * speed * sin(heading), x[2] + kStep * u[0],
            x[3] + kStep * u[1]};
  }
  template <class K, class T>
  std::array<T, 4> residual(K, const std::array<T, 4>& x, const std::array<T, 2>& u) const {
    return {0.3 * (x[3] - 1.6), 0.1 * x[2], 0.1 * u[0], 0.1 * u[1]};
  }
  template <class T>
  std::array<T, 1> terminal_residual(const std::array<T, 4>& x) const {
    return {1.0 * (x[0] - 4.5)};
  }
  template <class K, class T>
  std::array<T, 2> constraint(K, const std::array<T, 4>& x, const std::array<T, 2>&) const {
    const T off = x[1] - middle(x[0]);
    return {off - width, -off - width};
  }
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 10.0, .quadratic = 10.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {-turn, -2.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {turn, 2.0}; }

  static FamilyInstance<Gates> make(Random& random) {
    FamilyInstance<Gates> instance;
    Gates& p = instance.problem;
    p.width = random.uniform(0.15, 0.4);
    p.turn = random.uniform(1.5, 3.0);
    p.gate = {0.0, random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6)};
    instance.start = {0.0, 0.0, 0.0, random.uniform(0.5, 1.5)};
    instance.goal = {4.5, p.gate[2], 0.0, 1.6};
    return instance;
  }
  /// It starts beside the corridor, or turns too slowly for a heading to the wall.
  static FamilyInstance<Gates> make_impossible(Random& random) {
    FamilyInstance<Gates> instance;
    Gates& p = instance.problem;
    p.width = random.uniform(0.05, 0.12);
    p.turn = random.uniform(1.0, 2.0);
    p.gate = {0.0, random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6)};
    instance.start = {0.0, 0.5 * p.width, random.uniform(0.7, 1.0), random.uniform(1.5, 2.0)};
    instance.goal = {4.5, p.gate[2], 0.0, 1.6};
    return instance;
  }
};

/// Two tanks in a row: what is drawn from the second one is given, the pump fills the first one, and no level
/// may leave its limits. States: levels [m]; inputs: pump, valve between them [m/s of level].
struct Tanks {
  static constexpr std::string_view kName = "two tanks";
  static constexpr int kNx = 2, kNu = 2, kNr = 3, kNe = 0, kNc = 4, kHorizon = 60;
  static constexpr double kStep = 0.2;
  static constexpr bool kRecedes = false;
  double low = 0.3, high = 1.0, most = 0.2;
  solver::StageData<kHorizon> drawn;

  template <class K, class T>
  std::array<T, 2> dynamics(K k, const std::array<T, 2>& x, const std::array<T, 2>& u) const {
    const T leak = 0.02 * sqrt(x[0] * x[0] + 0.01);
    return {x[0] + kStep * (u[0] - u[1] - leak), x[1] + kStep * (u[1] - drawn.at(k))};
  }
  template <class K, class T>
  std::array<T, 3> residual(K, const std::array<T, 2>& x, const std::array<T, 2>& u) const {
    return {2.0 * u[0], 0.5 * u[1], 0.01 * (x[0] - 0.5)};
  }
  template <class T>
  std::array<T, 0> terminal_residual(const std::array<T, 2>&) const {
    return {};
  }
  template <class K, class T>
  std::array<T, 4> constraint(K, const std::array<T, 2>& x, const std::array<T, 2>&) const {
    return {low - x[0], x[0] - high, low - x[1], x[1] - high};
  }
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 1.0, .quadratic = 1.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {0.0, 0.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {most, 2.0 * most}; }

  static FamilyInstance<Tanks> make(Random& random) {
    FamilyInstance<Tanks> instance;
    Tanks& p = instance.problem;
    p.most = random.uniform(0.15, 0.3);
    const double mean = random.uniform(0.3, 0.6) * p.most, swing = random.uniform(0.3, 0.9) * mean;
    const double phase = random.uniform(0.0, 2.0 * kPi), turns = random.uniform(1.0, 3.0);
    for (int k = 0; k < kHorizon; ++k)
      p.drawn[static_cast<std::size_t>(k)] = mean + swing * sin(phase + turns * 2.0 * kPi * k / kHorizon);
    instance.start = {random.uniform(0.4, 0.9), random.uniform(0.5, 0.9)};
    instance.goal = instance.start;
    instance.idle = {mean, mean};
    return instance;
  }
  /// More is drawn than is pumped.
  static FamilyInstance<Tanks> make_impossible(Random& random) {
    FamilyInstance<Tanks> instance;
    Tanks& p = instance.problem;
    p.most = random.uniform(0.1, 0.2);
    const double mean = random.uniform(1.3, 1.6) * p.most;
    for (int k = 0; k < kHorizon; ++k)
      p.drawn[static_cast<std::size_t>(k)] = mean * (1.0 + 0.3 * sin(2.0 * kPi * k / kHorizon));
    instance.start = {random.uniform(0.4, 0.6), random.uniform(0.5, 0.7)};
    instance.goal = instance.start;
    instance.idle = {p.most, p.most};
    return instance;
  }
};

/// The line of fastest descent above a slope (Bryson, Ho 1975), in a time that is free. States: position
/// along, depth [m], speed [m/s], duration [s]; inputs: angle [rad], duration [s].
struct Brachistochrone {
  static constexpr std::string_view kName = "brachistochrone above a slope";
  static constexpr int kNx = 4, kNu = 2, kNr = 1, kNe = 1, kNc = 1, kNeh = 1, kHorizon = 50;
  static constexpr double kGravity = 9.81;
  static constexpr bool kRecedes = false;  ///< a duration cannot be set twice
  double goal = 2.0, slope = 0.5, room = 0.2, longest = 5.0;

  template <class K, class T>
  std::array<T, 4> dynamics(K, const std::array<T, 4>& x, const std::array<T, 2>& u) const {
    const T duration = x[3] + u[1], step = duration * (1.0 / kHorizon);
    const T gain = step * (kGravity * sin(u[0])), mean = x[2] + 0.5 * gain;
    return {x[0] + step * mean * cos(u[0]), x[1] + step * mean * sin(u[0]), x[2] + gain, duration};
  }
  template <class K, class T>
  std::array<T, 1> residual(K, const std::array<T, 4>&, const std::array<T, 2>& u) const {
    return {1e-3 * u[0]};
  }
  template <class T>
  std::array<T, 1> terminal_residual(const std::array<T, 4>& x) const {
    return {1.0 * x[3]};
  }
  template <class T>
  std::array<T, 1> terminal_equality(const std::array<T, 4>& x) const {
    return {x[0] - goal};
  }
  template <class K, class T>
  std::array<T, 1> constraint(K, const std::array<T, 4>& x, const std::array<T, 2>&) const {
    return {x[1] - slope * x[0] - room};
  }
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 1.0, .quadratic = 1.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int k) const { return {-1.5, k == 0 ? 0.1 : 0.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int k) const { return {1.6, k == 0 ? longest : 0.0}; }

  static FamilyInstance<Brachistochrone> make(Random& random) {
    FamilyInstance<Brachistochrone> instance;
    Brachistochrone& p = instance.problem;
    p.goal = random.uniform(1.0, 4.0);
    p.slope = random.uniform(0.2, 0.6);
    p.room = random.uniform(0.05, 0.4);
    instance.start = {0.0, 0.0, random.uniform(0.2, 1.0), 0.0};
    instance.goal = {p.goal, p.slope * p.goal, 4.0, 1.0};
    instance.idle = {0.3, 1.0};
    return instance;
  }
  /// The goal lies beyond the longest slide.
  static FamilyInstance<Brachistochrone> make_impossible(Random& random) {
    FamilyInstance<Brachistochrone> instance;
    Brachistochrone& p = instance.problem;
    p.goal = random.uniform(2.0, 4.0);
    p.slope = random.uniform(0.2, 0.6);
    p.room = random.uniform(0.05, 0.3);
    p.longest = random.uniform(0.3, 0.5);
    instance.start = {0.0, 0.0, random.uniform(0.2, 1.0), 0.0};
    instance.goal = {p.goal, p.slope * p.goal, 4.0, 0.4};
    instance.idle = {0.3, 0.4};
    return instance;
  }
};

/// A spacecraft with constant thrust reaches the largest circular orbit (Bryson, Ho 1975). States: radius and
/// speeds outwards and along, in units of the first orbit; input: angle of the thrust [rad].
struct OrbitRaising {
  static constexpr std::string_view kName = "orbit raising";
  static constexpr int kNx = 3, kNu = 1, kNr = 1, kNe = 1, kNc = 1, kNeh = 2, kNec = 1, kHorizon = 50;
  double duration = 3.3, thrust = 0.14, flow = 0.075, least = 1.0, low = 0.9;
  static constexpr bool kRecedes = false;

  template <class K, class T>
  std::array<T, 3> dynamics(K k, const std::array<T, 3>& x, const std::array<T, 1>& u) const {
    const auto push = thrust * mass_inverse(k);
    const T s = sin(u[0]), c = cos(u[0]);
    const auto rate = [&](const std::array<T, 3>& y) {
      const T inverse = 1.0 / y[0];
      return std::array<T, 3>{1.0 * y[1], (y[2] * y[2] - inverse) * inverse + push * s,
                              -1.0 * (y[1] * y[2]) * inverse + push * c};
    };
    return runge_kutta_4(x, duration / kHorizon, rate);
  }
  template <class K>
  [[nodiscard]] auto mass_inverse(K k) const {
    return 1.0 / (1.0 - (flow * duration / kHorizon) * (solver::stage_number(k) + 0.5));
  }
  template <class K, class T>
  std::array<T, 1> residual(K, const std::array<T, 3>&, const std::array<T, 1>& u) const {
    return {1e-3 * u[0]};
  }
  template <class T>
  std::array<T, 1> terminal_residual(const std::array<T, 3>& x) const {
    return {3.0 - x[0]};  // further than it gets
  }
  template <class T>
  std::array<T, 2> terminal_equality(const std::array<T, 3>& x) const {
    return {1.0 * x[1], x[2] * x[2] * x[0] - 1.0};
  }
  template <class T>
  std::array<T, 1> terminal_constraint(const std::array<T, 3>& x) const {
    return {least - x[0]};
  }
  template <class K, class T>
  std::array<T, 1> constraint(K, const std::array<T, 3>& x, const std::array<T, 1>&) const {
    return {low - x[0]};
  }
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 1.0, .quadratic = 1.0}; }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-2.0}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {5.0}; }

  static FamilyInstance<OrbitRaising> make(Random& random) {
    FamilyInstance<OrbitRaising> instance;
    OrbitRaising& p = instance.problem;
    p.duration = random.uniform(3.0, 4.0);
    p.thrust = random.uniform(0.1, 0.18);
    p.flow = random.uniform(0.05, 0.1);
    instance.start = {1.0, 0.0, 1.0};
    instance.goal = {1.5, 0.0, 0.8165};
    instance.idle = {0.3};
    return instance;
  }
  /// A radius that the thrust does not reach.
  static FamilyInstance<OrbitRaising> make_impossible(Random& random) {
    FamilyInstance<OrbitRaising> instance = make(random);
    instance.problem.least = random.uniform(2.2, 3.0);
    return instance;
  }
};

/// A planar quadrotor flies through a tube that bends. States: position [m], pitch [rad], velocity [m/s];
/// inputs: thrust over mass [m/s²], rate of the pitch [rad/s].
struct Tube {
  static constexpr std::string_view kName = "quadrotor in a tube";
  static constexpr int kNx = 5, kNu = 2, kNr = 4, kNe = 0, kNc = 2, kNeh = 5, kHorizon = 50;
  static constexpr double kStep = 0.06, kGravity = 9.81;
  static constexpr bool kRecedes = false;
  double goal = 4.0, bend = 0.5, radius = 0.3, most = 20.0;

  template <class K, class T>
  std::array<T, 5> dynamics(K, const std::array<T, 5>& x, const std::array<T, 2>& u) const {
    const T pitch = x[2] + (0.5 * kStep) * u[1];
    const T vx = x[3] + kStep * (u[0] * sin(pitch)), vz = x[4] + kStep * (u[0] * cos(pitch) - kGravity);
    return {x[0] + (0.5 * kStep) * (x[3] + vx), x[1] + (0.5 * kStep) * (x[4] + vz), x[2] + kStep * u[1], vx,
            vz};
  }
  template <class K, class T>
  std::array<T, 4> residual(K, const std::array<T, 5>& x, const std::array<T, 2>& u) const {
    return {0.1 * (u[0] - kGravity), 0.2 * u[1], 0.1 * x[2], 0.05 * (x[0] - goal)};
  }
  template <class T>
  std::array<T, 0> terminal_residual(const std::array<T, 5>&) const {
    return {};
  }
  template <class T>
  std::array<T, 5> terminal_equality(const std::array<T, 5>& x) const {
    return {x[0] - goal, 1.0 * x[1], 1.0 * x[2], 1.0 * x[3], 1.0 * x[4]};
  }
  template <class K, class T>
  std::array<T, 2> constraint(K, const std::array<T, 5>& x, const std::array<T, 2>&) const {
    const T off = x[1] - bend * sin(x[0] * (2.0 * kPi / goal));
    return {off - radius, -1.0 * off - radius};
  }
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 10.0, .quadratic = 10.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {2.0, -4.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {most, 4.0}; }

  static FamilyInstance<Tube> make(Random& random) {
    FamilyInstance<Tube> instance;
    Tube& p = instance.problem;
    p.goal = random.uniform(3.0, 5.0);
    p.bend = random.uniform(-0.6, 0.6);
    p.radius = random.uniform(0.15, 0.4);
    instance.start = {0.0, 0.0, random.uniform(-0.2, 0.2), random.uniform(0.0, 1.0),
                      random.uniform(-0.3, 0.3)};
    instance.goal = {p.goal, 0.0, 0.0, 0.0, 0.0};
    instance.idle = {kGravity, 0.0};
    return instance;
  }
  /// It enters too fast across.
  static FamilyInstance<Tube> make_impossible(Random& random) {
    FamilyInstance<Tube> instance;
    Tube& p = instance.problem;
    p.goal = random.uniform(3.0, 5.0);
    p.bend = random.uniform(-0.2, 0.2);
    p.radius = random.uniform(0.15, 0.25);
    instance.start = {0.0, 0.0, 0.0, random.uniform(0.0, 0.5), -random.uniform(2.6, 3.2)};
    instance.goal = {p.goal, 0.0, 0.0, 0.0, 0.0};
    instance.idle = {kGravity, 0.0};
    return instance;
  }
};

}  // namespace chicane::bench
