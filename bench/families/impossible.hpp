// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "families/family.hpp"

namespace chicane::bench {

// Problems without a solution: nearly possible ones, and ones whose constraints contradict each other. Each
// kind has the same with a little room, which have one.

/// How far a problem is from being possible: 1e-4 … 0.3 of a unit, evenly in its logarithm; the room that
/// a possible one has.
[[nodiscard]] inline double random_gap(Random& random, bool is_impossible) noexcept {
  const double size = std::pow(10.0, random.uniform(-4.0, -0.5));
  return is_impossible ? size : -std::max(1e-2, size);
}

/// One number for all stages.
template <std::size_t N>
[[nodiscard]] solver::StageData<N> at_all_stages(double value) noexcept {
  solver::StageData<N> data;
  data.values.fill(value);
  return data;
}

/// A point mass on a plane. States: position [m], speed [m/s], in x and y; inputs: acceleration [m/s²], at
/// most 1 in each direction.
struct PointMass : FamilyProblem<4, 2>, AllHard<10> {
  static constexpr std::string_view kName = "point mass, conflicts";
  static constexpr int kNr = 2, kNe = 0, kNc = 4, kNh = 1, kNeh = 4, kNec = 1, kHorizon = 30;
  static constexpr double kStep = 0.1;
  static constexpr bool kRecedes = false;
  enum Kind {
    kOutOfReach,     ///< the goal is further away than full acceleration gets
    kInsidePost,     ///< the goal is inside a round post
    kTooSlow,        ///< the goal is further away than the speed limit gets
    kClosedDoor,     ///< two walls leave no way between them for some stages
    kSpeedAtEnd,     ///< the speed at the end is prescribed above its limit
    kTooMuchDemand,  ///< each stage has to accelerate more than it can
    kCannotBrake,    ///< a wall is nearer than the mass can stop
    kDemandAndLimit  ///< each stage has to accelerate, and no speed may grow so much
  };
  static constexpr int kKinds = 8;

  double demand = 0.0, has_demand = 0.0;
  std::array<double, 4> end{}, has_end{};
  double post_x = 0.0, post_y = 0.0, radius = 0.0;
  double wall = 1e3, fastest_end = 1e3;
  solver::StageData<kHorizon> low = at_all_stages<kHorizon>(-1e3), high = at_all_stages<kHorizon>(1e3),
                              fastest = at_all_stages<kHorizon>(1e3);

  PointMass() { most = {1.0, 1.0}; }

  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    constexpr double kHalf = 0.5 * kStep * kStep;
    return std::array{x[0] + kStep * x[2] + kHalf * u[0], x[1] + kStep * x[3] + kHalf * u[1],
                      x[2] + kStep * u[0], x[3] + kStep * u[1]};
  }
  auto residual(auto, const Numbers auto&, const Numbers auto& u) const {
    return std::array{0.3 * u[0], 0.3 * u[1]};
  }
  auto equality(auto, const Numbers auto&, const Numbers auto& u) const {
    return std::array{has_demand * (u[0] + u[1] - demand)};
  }
  auto terminal_equality(const Numbers auto& x) const {
    return std::array{has_end[0] * (x[0] - end[0]), has_end[1] * (x[1] - end[1]),
                      has_end[2] * (x[2] - end[2]), has_end[3] * (x[3] - end[3])};
  }
  auto terminal_constraint(const Numbers auto& x) const { return std::array{x[2] - fastest_end}; }
  auto constraint(auto k, const Numbers auto& x, const Numbers auto&) const {
    const auto dx = x[0] - post_x, dy = x[1] - post_y;
    const auto beyond = x[0] - wall, speed = x[2] - fastest.at(k);
    return std::array{radius * radius - dx * dx - dy * dy, low.at(k) - x[1], x[1] - high.at(k),
                      select(beyond > speed, beyond, speed)};
  }

  void draw(Kind kind, Random& random, bool is_impossible) {
    constexpr double kTime = kStep * kHorizon;
    constexpr double kReach = 0.5 * kTime * kTime;
    const double gap = random_gap(random, is_impossible);
    const double side = random.uniform(-0.5, 0.5);
    switch (kind) {
      case kOutOfReach:
        start = {0.0, 0.0, random.uniform(-0.5, 0.5), 0.0};
        end = {kReach + kTime * start[2] + gap, side, 0.0, 0.0};
        has_end = {1.0, 1.0, 0.0, 0.0};
        break;
      case kInsidePost: {
        constexpr double kLastStep = 0.5 * kStep * kStep;
        radius = random.uniform(0.4, 0.8);
        post_x = 1.5;
        const double depth = is_impossible ? std::min(gap, 0.5 * radius) + 1.5 * kLastStep : gap;
        const double angle = random.uniform(-2.0, 2.0);
        end = {post_x - (radius - depth) * std::cos(angle), (radius - depth) * std::sin(angle), 0.0, 0.0};
        has_end = {1.0, 1.0, 1.0, 1.0};
        start = {0.0, side, 0.0, 0.0};
        break;
      }
      case kTooSlow:
        fastest = at_all_stages<kHorizon>(random.uniform(0.3, 0.8));
        start = {0.0, 0.0, fastest.at(0), 0.0};
        end = {fastest.at(0) * kTime + 0.5 * kStep * kStep + gap, side, 0.0, 0.0};
        has_end = {1.0, 1.0, 0.0, 0.0};
        break;
      case kClosedDoor:
        start = {0.0, 0.2 + 0.3 * side, random.uniform(0.0, 0.5), 0.0};
        for (int k = 12; k < 16; ++k) {
          low[static_cast<std::size_t>(k)] = 0.2;
          high[static_cast<std::size_t>(k)] = 0.2 - gap;
        }
        break;
      case kSpeedAtEnd:
        start = {0.0, 0.0, random.uniform(0.0, 1.0), side};
        end[2] = random.uniform(0.5, 1.5);
        has_end[2] = 1.0;
        fastest_end = end[2] - gap;
        break;
      case kTooMuchDemand:
        start = {0.0, side, 0.0, 0.0};
        demand = 2.0 + gap;
        has_demand = 1.0;
        break;
      case kCannotBrake: {
        start = {0.0, side, random.uniform(0.8, 2.0), 0.0};
        // Where full braking stops; the last stage of it may be a part.
        const double stages = std::floor(start[2] / kStep), left = start[2] - kStep * stages;
        const double stop = kStep * stages * (start[2] - 0.5 * kStep * stages) + 0.5 * kStep * left;
        wall = stop - gap - 0.5 * kStep * kStep * (is_impossible ? 1.0 : 0.0);
        break;
      }
      case kDemandAndLimit:
        demand = random.uniform(0.3, 0.8);
        has_demand = 1.0;
        has_end[3] = 1.0;
        end[3] = 0.5 * demand * kTime;
        fastest = at_all_stages<kHorizon>(end[3] - gap);
        fastest_end = end[3] - gap;
        start = {0.0, side, 0.0, 0.0};
        break;
    }
    goal = end;
  }
  void draw(Random& random, bool is_impossible) {
    draw(static_cast<Kind>(random.bits() % kKinds), random, is_impossible);
  }
};

/// A chain of given length between two points at the same height, over a peak in the middle: it hangs as low
/// as it can. States: height, length so far; input: slope.
struct HangingChain : FamilyProblem<2, 1>, AllHard<10> {
  static constexpr std::string_view kName = "hanging chain over a peak";
  static constexpr int kNr = 1, kNe = 0, kNc = 1, kNeh = 2, kHorizon = 40;
  static constexpr double kStep = 1.0 / kHorizon;
  static constexpr bool kRecedes = false;
  double length = 2.0;
  solver::StageData<kHorizon> ground = at_all_stages<kHorizon>(-10.0);

  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    return std::array{x[0] + kStep * u[0], x[1] + kStep * sqrt(1.0 + u[0] * u[0])};
  }
  auto residual(auto, const Numbers auto& x, const Numbers auto& u) const {
    return std::array{sqrt((2.0 * kStep) * (x[0] + 6.0) * sqrt(1.0 + u[0] * u[0]))};
  }
  auto constraint(auto k, const Numbers auto& x, const Numbers auto&) const {
    return std::array{ground.at(k) - x[0]};
  }
  auto terminal_equality(const Numbers auto& x) const { return std::array{1.0 * x[0], x[1] - length}; }

  void draw(Random& random, bool is_impossible) {
    most = {5.0};
    const double height = random.uniform(0.2, 1.0);
    const double least = 2.0 * std::sqrt(0.25 + height * height);
    ground[kHorizon / 2] = height;
    length = least - std::min(random_gap(random, is_impossible), 0.5 * (least - 1.0));
    goal = {0.0, length};
  }
};

/// A cart whose heading turns too slowly for its goal. States: position [m], heading [rad], speed [m/s];
/// inputs: rate of the heading, acceleration.
struct SlowTurn : FamilyProblem<4, 2> {
  static constexpr std::string_view kName = "cart that turns too slowly";
  static constexpr int kNr = 3, kNe = 0, kNc = 0, kNeh = 3, kHorizon = 40;
  static constexpr double kStep = 0.05;
  static constexpr bool kRecedes = false;
  std::array<double, 3> end{};

  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    const auto heading = x[2] + (0.5 * kStep) * u[0], speed = x[3] + (0.5 * kStep) * u[1];
    return std::array{x[0] + kStep * speed * cos(heading), x[1] + kStep * speed * sin(heading),
                      x[2] + kStep * u[0], x[3] + kStep * u[1]};
  }
  auto residual(auto, const Numbers auto& x, const Numbers auto& u) const {
    return std::array{0.1 * (x[3] - 1.0), 0.1 * u[0], 0.1 * u[1]};
  }
  auto terminal_equality(const Numbers auto& x) const {
    return std::array{x[0] - end[0], x[1] - end[1], x[2] - end[2]};
  }

  void draw(Random& random, bool is_impossible) {
    most = {random.uniform(0.4, 1.2), 1.0};
    const double turn = most[0] * kStep * kHorizon;
    const double room = is_impossible ? random_gap(random, true) : -0.4 * turn;
    end = {random.uniform(1.2, 1.8), random.uniform(0.3, 0.8), turn + room};
    if (!is_impossible) end = {random.uniform(1.5, 1.7), random.uniform(0.3, 0.5), 0.5 * turn};
    start = {0.0, 0.0, 0.0, random.uniform(0.5, 1.0)};
    goal = {end[0], end[1], end[2], 1.0};
  }
};

}  // namespace chicane::bench
