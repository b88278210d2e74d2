// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

// Families of the literature whose limits along the way must hold, each with instances that leave no
// solution.

/// Bryson and Denham's problem: a mass comes back after a second with its speed reversed, and goes no further
/// than a limit on the way. Convex. States: position, speed; input: acceleration.
struct BrysonDenham : FamilyProblem<2, 1>, AllHard<10> {
  static constexpr std::string_view kName = "Bryson-Denham";
  static constexpr int kNr = 1, kNe = 0, kNc = 1, kNeh = 2, kHorizon = 50;
  static constexpr double kStep = 1.0 / kHorizon;
  static constexpr bool kRecedes = false;
  double limit = 0.1, speed = 1.0;

  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    return std::array{x[0] + kStep * x[1] + (0.5 * kStep * kStep) * u[0], x[1] + kStep * u[0]};
  }
  auto residual(auto, const Numbers auto&, const Numbers auto& u) const {
    return std::array{0.1414213562373095 * u[0]};
  }
  auto constraint(auto, const Numbers auto& x, const Numbers auto&) const { return std::array{x[0] - limit}; }
  auto terminal_equality(const Numbers auto& x) const { return std::array{1.0 * x[0], x[1] + speed}; }

  /// Impossible: brakes too weak for the limit.
  void draw(Random& random, bool is_impossible) {
    if (!is_impossible) limit = random.uniform(0.03, 0.2);
    speed = is_impossible ? random.uniform(0.8, 1.2) : random.uniform(0.7, 1.3);
    most[0] = is_impossible ? random.uniform(3.0, 8.0) : 100.0;
    if (is_impossible) limit = random.uniform(0.2, 0.8) * speed * speed / (2.0 * most[0]);
    start = {0.0, speed};
    goal = {0.0, -speed};
  }
};

/// A cart goes through gates in a narrow corridor. States: position along and across [m], heading [rad],
/// speed [m/s]; inputs: rate of the heading [rad/s], acceleration [m/s²].
struct Gates : FamilyProblem<4, 2>, AllHard<10> {
  static constexpr std::string_view kName = "cart through gates";
  static constexpr int kNr = 4, kNe = 1, kNc = 2, kHorizon = 60;
  static constexpr double kStep = 0.05;
  static constexpr bool kRecedes = false;
  double width = 0.4;
  std::array<double, 3> gate{};

  auto middle(const auto& along) const {
    const auto first = tanh(3.0 * (along - 1.5)), second = tanh(3.0 * (along - 3.0));
    return 0.5 * (gate[0] + gate[2]) + (0.5 * (gate[1] - gate[0])) * first +
           (0.5 * (gate[2] - gate[1])) * second;
  }
  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    const auto heading = x[2] + (0.5 * kStep) * u[0], speed = x[3] + (0.5 * kStep) * u[1];
    return std::array{x[0] + kStep * speed * cos(heading), x[1] + kStep * speed * sin(heading),
                      x[2] + kStep * u[0], x[3] + kStep * u[1]};
  }
  auto residual(auto, const Numbers auto& x, const Numbers auto& u) const {
    return std::array{0.3 * (x[3] - 1.6), 0.1 * x[2], 0.1 * u[0], 0.1 * u[1]};
  }
  auto terminal_residual(const Numbers auto& x) const { return std::array{1.0 * (x[0] - 4.5)}; }
  auto constraint(auto, const Numbers auto& x, const Numbers auto&) const {
    const auto off = x[1] - middle(x[0]);
    return std::array{off - width, -off - width};
  }

  /// Impossible: it starts beside the corridor, or turns too slowly for a heading to the wall.
  void draw(Random& random, bool is_impossible) {
    width = is_impossible ? random.uniform(0.05, 0.12) : random.uniform(0.15, 0.4);
    most = {is_impossible ? random.uniform(1.0, 2.0) : random.uniform(1.5, 3.0), 2.0};
    gate = {0.0, random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6)};
    if (is_impossible) start = {0.0, 0.5 * width, random.uniform(0.7, 1.0), 0.0};
    start[3] = is_impossible ? random.uniform(1.5, 2.0) : random.uniform(0.5, 1.5);
    goal = {4.5, gate[2], 0.0, 1.6};
  }
};

/// Two tanks in a row: what is drawn from the second one is given, the pump fills the first one, and no level
/// may leave its limits. States: levels [m]; inputs: pump, valve between them [m/s of level].
struct Tanks : FamilyProblem<2, 2>, AllHard<1> {
  static constexpr std::string_view kName = "two tanks";
  static constexpr int kNr = 3, kNe = 0, kNc = 4, kHorizon = 60;
  static constexpr double kStep = 0.2;
  static constexpr bool kRecedes = false;
  double low = 0.3, high = 1.0, flow = 0.2;
  solver::StageData<kHorizon> drawn;

  auto dynamics(auto k, const Numbers auto& x, const Numbers auto& u) const {
    const auto leak = 0.02 * sqrt(x[0] * x[0] + 0.01);
    return std::array{x[0] + kStep * (u[0] - u[1] - leak), x[1] + kStep * (u[1] - drawn.at(k))};
  }
  auto residual(auto, const Numbers auto& x, const Numbers auto& u) const {
    return std::array{2.0 * u[0], 0.5 * u[1], 0.01 * (x[0] - 0.5)};
  }
  auto constraint(auto, const Numbers auto& x, const Numbers auto&) const {
    return std::array{low - x[0], x[0] - high, low - x[1], x[1] - high};
  }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {0.0, 0.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {flow, 2.0 * flow}; }

  /// Impossible: more is drawn than is pumped.
  void draw(Random& random, bool is_impossible) {
    flow = is_impossible ? random.uniform(0.1, 0.2) : random.uniform(0.15, 0.3);
    const double mean = (is_impossible ? random.uniform(1.3, 1.6) : random.uniform(0.3, 0.6)) * flow;
    const double swing = is_impossible ? 0.3 * mean : random.uniform(0.3, 0.9) * mean;
    const double phase = is_impossible ? 0.0 : random.uniform(0.0, 2.0 * kPi);
    const double turns = is_impossible ? 1.0 : random.uniform(1.0, 3.0);
    for (int k = 0; k < kHorizon; ++k)
      drawn[static_cast<std::size_t>(k)] = mean + swing * sin(phase + turns * 2.0 * kPi * k / kHorizon);
    start[0] = is_impossible ? random.uniform(0.4, 0.6) : random.uniform(0.4, 0.9);
    start[1] = is_impossible ? random.uniform(0.5, 0.7) : random.uniform(0.5, 0.9);
    goal = start;
    idle.fill(is_impossible ? flow : mean);
  }
};

/// The line of fastest descent above a slope (Bryson, Ho 1975), in a time that is free. States: position
/// along, depth [m], speed [m/s], duration [s]; inputs: angle [rad], duration [s].
struct Brachistochrone : FamilyProblem<4, 2>, AllHard<1> {
  static constexpr std::string_view kName = "brachistochrone above a slope";
  static constexpr int kNr = 1, kNe = 1, kNc = 1, kNeh = 1, kHorizon = 50;
  static constexpr double kGravity = 9.81;
  static constexpr bool kRecedes = false;  ///< a duration cannot be set twice
  double slope = 0.5, room = 0.2, longest = 5.0;

  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    const auto duration = x[3] + u[1], step = duration * (1.0 / kHorizon);
    const auto gain = step * (kGravity * sin(u[0])), mean = x[2] + 0.5 * gain;
    return std::array{x[0] + step * mean * cos(u[0]), x[1] + step * mean * sin(u[0]), x[2] + gain, duration};
  }
  auto residual(auto, const Numbers auto&, const Numbers auto& u) const { return std::array{1e-3 * u[0]}; }
  auto terminal_residual(const Numbers auto& x) const { return std::array{1.0 * x[3]}; }
  auto terminal_equality(const Numbers auto& x) const { return std::array{x[0] - goal[0]}; }
  auto constraint(auto, const Numbers auto& x, const Numbers auto&) const {
    return std::array{x[1] - slope * x[0] - room};
  }
  [[nodiscard]] std::array<double, 2> input_lower(int k) const { return {-1.5, k == 0 ? 0.1 : 0.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int k) const { return {1.6, k == 0 ? longest : 0.0}; }

  /// Impossible: the goal lies beyond the longest slide.
  void draw(Random& random, bool is_impossible) {
    const double duration = is_impossible ? 0.4 : 1.0;
    const double along = random.uniform(is_impossible ? 2.0 : 1.0, 4.0);
    slope = random.uniform(0.2, 0.6);
    room = random.uniform(0.05, is_impossible ? 0.3 : 0.4);
    if (is_impossible) longest = random.uniform(0.3, 0.5);
    start = {0.0, 0.0, random.uniform(0.2, 1.0), 0.0};
    goal = {along, slope * along, 4.0, duration};
    idle = {0.3, duration};
  }
};

/// A spacecraft with constant thrust reaches the largest circular orbit (Bryson, Ho 1975). States: radius and
/// speeds outwards and along, in units of the first orbit; input: angle of the thrust [rad].
struct OrbitRaising : FamilyProblem<3, 1>, AllHard<1> {
  static constexpr std::string_view kName = "orbit raising";
  static constexpr int kNr = 1, kNe = 1, kNc = 1, kNeh = 2, kNec = 1, kHorizon = 50;
  double duration = 3.3, thrust = 0.14, flow = 0.075, least = 1.0, low = 0.9;
  static constexpr bool kRecedes = false;

  auto dynamics(auto k, const Numbers auto& x, const Numbers auto& u) const {
    const auto push = thrust * mass_inverse(k);
    const auto s = sin(u[0]), c = cos(u[0]);
    const auto rate = [&](const auto& y) {
      const auto inverse = 1.0 / y[0];
      return std::array{1.0 * y[1], (y[2] * y[2] - inverse) * inverse + push * s,
                        -1.0 * (y[1] * y[2]) * inverse + push * c};
    };
    return runge_kutta_4(x, duration / kHorizon, rate);
  }
  auto mass_inverse(auto k) const {
    return 1.0 / (1.0 - (flow * duration / kHorizon) * (solver::stage_number(k) + 0.5));
  }
  auto residual(auto, const Numbers auto&, const Numbers auto& u) const { return std::array{1e-3 * u[0]}; }
  auto terminal_residual(const Numbers auto& x) const {
    return std::array{3.0 - x[0]};  // further than it gets
  }
  auto terminal_equality(const Numbers auto& x) const {
    return std::array{1.0 * x[1], x[2] * x[2] * x[0] - 1.0};
  }
  auto terminal_constraint(const Numbers auto& x) const { return std::array{least - x[0]}; }
  auto constraint(auto, const Numbers auto& x, const Numbers auto&) const { return std::array{low - x[0]}; }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-2.0}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {5.0}; }

  /// Impossible: a radius that the thrust does not reach.
  void draw(Random& random, bool is_impossible) {
    duration = random.uniform(3.0, 4.0);
    thrust = random.uniform(0.1, 0.18);
    flow = random.uniform(0.05, 0.1);
    start = {1.0, 0.0, 1.0};
    goal = {1.5, 0.0, 0.8165};
    idle = {0.3};
    if (is_impossible) least = random.uniform(2.2, 3.0);
  }
};

/// A planar quadrotor flies through a tube that bends. States: position [m], pitch [rad], velocity [m/s];
/// inputs: thrust over mass [m/s²], rate of the pitch [rad/s].
struct Tube : FamilyProblem<5, 2>, AllHard<10> {
  static constexpr std::string_view kName = "quadrotor in a tube";
  static constexpr int kNr = 4, kNe = 0, kNc = 2, kNeh = 5, kHorizon = 50;
  static constexpr double kStep = 0.06, kGravity = 9.81;
  static constexpr bool kRecedes = false;
  double bend = 0.5, radius = 0.3, strongest = 20.0;

  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    const auto pitch = x[2] + (0.5 * kStep) * u[1];
    const auto vx = x[3] + kStep * (u[0] * sin(pitch)), vz = x[4] + kStep * (u[0] * cos(pitch) - kGravity);
    return std::array{x[0] + (0.5 * kStep) * (x[3] + vx), x[1] + (0.5 * kStep) * (x[4] + vz),
                      x[2] + kStep * u[1], vx, vz};
  }
  auto residual(auto, const Numbers auto& x, const Numbers auto& u) const {
    return std::array{0.1 * (u[0] - kGravity), 0.2 * u[1], 0.1 * x[2], 0.05 * (x[0] - goal[0])};
  }
  auto terminal_equality(const Numbers auto& x) const {
    return std::array{x[0] - goal[0], 1.0 * x[1], 1.0 * x[2], 1.0 * x[3], 1.0 * x[4]};
  }
  auto constraint(auto, const Numbers auto& x, const Numbers auto&) const {
    const auto off = x[1] - bend * sin(x[0] * (2.0 * kPi / goal[0]));
    return std::array{off - radius, -1.0 * off - radius};
  }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {2.0, -4.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {strongest, 4.0}; }

  /// Impossible: it enters too fast across.
  void draw(Random& random, bool is_impossible) {
    const double widest = is_impossible ? 0.2 : 0.6;
    goal[0] = random.uniform(3.0, 5.0);
    bend = random.uniform(-widest, widest);
    radius = random.uniform(0.15, is_impossible ? 0.25 : 0.4);
    start[2] = is_impossible ? 0.0 : random.uniform(-0.2, 0.2);
    start[3] = random.uniform(0.0, is_impossible ? 0.5 : 1.0);
    start[4] = is_impossible ? -random.uniform(2.6, 3.2) : random.uniform(-0.3, 0.3);
    idle = {kGravity, 0.0};
  }
};

}  // namespace chicane::bench
