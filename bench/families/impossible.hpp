// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "chicane/base/math.hpp"
#include "chicane/solver/hard_constraints.hpp"
#include "chicane/solver/problem.hpp"
#include "families/family.hpp"

namespace chicane::bench {

// Problems without a solution: nearly possible ones, and ones whose constraints contradict each other. make()
// has the same with a little room, which have one.

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
struct PointMass {
  static constexpr std::string_view kName = "point mass, conflicts";
  static constexpr int kNx = 4, kNu = 2, kNr = 2, kNe = 0, kNc = 4, kNh = 1, kNeh = 4, kNec = 1,
                       kHorizon = 30;
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

  template <class K, class T>
  std::array<T, 4> dynamics(K, const std::array<T, 4>& x, const std::array<T, 2>& u) const {
    constexpr double kHalf = 0.5 * kStep * kStep;
    return {x[0] + kStep * x[2] + kHalf * u[0], x[1] + kStep * x[3] + kHalf * u[1], x[2] + kStep * u[0],
            x[3] + kStep * u[1]};
  }
  template <class K, class T>
  std::array<T, 2> residual(K, const std::array<T, 4>&, const std::array<T, 2>& u) const {
    return {0.3 * u[0], 0.3 * u[1]};
  }
  template <class T>
  std::array<T, 0> terminal_residual(const std::array<T, 4>&) const {
    return {};
  }
  template <class K, class T>
  std::array<T, 1> equality(K, const std::array<T, 4>&, const std::array<T, 2>& u) const {
    return {has_demand * (u[0] + u[1] - demand)};
  }
  template <class T>
  std::array<T, 4> terminal_equality(const std::array<T, 4>& x) const {
    return {has_end[0] * (x[0] - end[0]), has_end[1] * (x[1] - end[1]), has_end[2] * (x[2] - end[2]),
            has_end[3] * (x[3] - end[3])};
  }
  template <class T>
  std::array<T, 1> terminal_constraint(const std::array<T, 4>& x) const {
    return {x[2] - fastest_end};
  }
  template <class K, class T>
  std::array<T, 4> constraint(K k, const std::array<T, 4>& x, const std::array<T, 2>&) const {
    const T dx = x[0] - post_x, dy = x[1] - post_y;
    const T beyond = x[0] - wall, speed = x[2] - fastest.at(k);
    return {radius * radius - dx * dx - dy * dy, low.at(k) - x[1], x[1] - high.at(k),
            select(beyond > speed, beyond, speed)};
  }
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 10.0, .quadratic = 10.0}; }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {-1.0, -1.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {1.0, 1.0}; }

  static FamilyInstance<PointMass> make(Kind kind, Random& random, bool is_impossible) {
    constexpr double kTime = kStep * kHorizon;
    constexpr double kReach = 0.5 * kTime * kTime;
    FamilyInstance<PointMass> instance;
    PointMass& p = instance.problem;
    auto& x = instance.start;
    const double gap = random_gap(random, is_impossible);
    const double side = random.uniform(-0.5, 0.5);
    switch (kind) {
      case kOutOfReach:
        x = {0.0, 0.0, random.uniform(-0.5, 0.5), 0.0};
        p.end = {kReach + kTime * x[2] + gap, side, 0.0, 0.0};
        p.has_end = {1.0, 1.0, 0.0, 0.0};
        break;
      case kInsidePost: {
        constexpr double kLastStep = 0.5 * kStep * kStep;
        p.radius = random.uniform(0.4, 0.8);
        p.post_x = 1.5;
        const double depth = is_impossible ? std::min(gap, 0.5 * p.radius) + 1.5 * kLastStep : gap;
        const double angle = random.uniform(-2.0, 2.0);
        p.end = {p.post_x - (p.radius - depth) * std::cos(angle), (p.radius - depth) * std::sin(angle), 0.0,
                 0.0};
        p.has_end = {1.0, 1.0, 1.0, 1.0};
        x = {0.0, side, 0.0, 0.0};
        break;
      }
      case kTooSlow:
        p.fastest = at_all_stages<kHorizon>(random.uniform(0.3, 0.8));
        x = {0.0, 0.0, p.fastest.at(0), 0.0};
        p.end = {p.fastest.at(0) * kTime + 0.5 * kStep * kStep + gap, side, 0.0, 0.0};
        p.has_end = {1.0, 1.0, 0.0, 0.0};
        break;
      case kClosedDoor:
        x = {0.0, 0.2 + 0.3 * side, random.uniform(0.0, 0.5), 0.0};
        for (int k = 12; k < 16; ++k) {
          p.low[static_cast<std::size_t>(k)] = 0.2;
          p.high[static_cast<std::size_t>(k)] = 0.2 - gap;
        }
        break;
      case kSpeedAtEnd:
        x = {0.0, 0.0, random.uniform(0.0, 1.0), side};
        p.end[2] = random.uniform(0.5, 1.5);
        p.has_end[2] = 1.0;
        p.fastest_end = p.end[2] - gap;
        break;
      case kTooMuchDemand:
        x = {0.0, side, 0.0, 0.0};
        p.demand = 2.0 + gap;
        p.has_demand = 1.0;
        break;
      case kCannotBrake: {
        x = {0.0, side, random.uniform(0.8, 2.0), 0.0};
        // Where full braking stops; the last stage of it may be a part.
        const double stages = std::floor(x[2] / kStep), left = x[2] - kStep * stages;
        const double stop = kStep * stages * (x[2] - 0.5 * kStep * stages) + 0.5 * kStep * left;
        p.wall = stop - gap - 0.5 * kStep * kStep * (is_impossible ? 1.0 : 0.0);
        break;
      }
      case kDemandAndLimit:
        p.demand = random.uniform(0.3, 0.8);
        p.has_demand = 1.0;
        p.has_end[3] = 1.0;
        p.end[3] = 0.5 * p.demand * kTime;
        p.fastest = at_all_stages<kHorizon>(p.end[3] - gap);
        p.fastest_end = p.end[3] - gap;
        x = {0.0, side, 0.0, 0.0};
        break;
    }
    instance.goal = p.end;
    return instance;
  }
  static FamilyInstance<PointMass> make(Random& random, bool is_impossible) {
    return make(static_cast<Kind>(random.bits() % kKinds), random, is_impossible);
  }
  static FamilyInstance<PointMass> make(Random& random) { return make(random, false); }
  static FamilyInstance<PointMass> make_impossible(Random& random) { return make(random, true); }
};

/// A chain of given length between two points at the same height, over a peak in the middle: it hangs as low
/// as it can. States: height, length so far; input: slope.
struct HangingChain {
  static constexpr std::string_view kName = "hanging chain over a peak";
  static constexpr int kNx = 2, kNu = 1, kNr = 1, kNe = 0, kNc = 1, kNeh = 2, kHorizon = 40;
  static constexpr double kStep = 1.0 / kHorizon;
  static constexpr bool kRecedes = false;
  double length = 2.0;
  solver::StageData<kHorizon> ground = at_all_stages<kHorizon>(-10.0);

  template <class K, class T>
  std::array<T, 2> dynamics(K, const std::array<T, 2>& x, const std::array<T, 1>& u) const {
    return {x[0] + kStep * u[0], x[1] + kStep * sqrt(1.0 + u[0] * u[0])};
  }
  template <class K, class T>
  std::array<T, 1> residual(K, const std::array<T, 2>& x, const std::array<T, 1>& u) const {
    return {sqrt((2.0 * kStep) * (x[0] + 6.0) * sqrt(1.0 + u[0] * u[0]))};
  }
  template <class T>
  std::array<T, 0> terminal_residual(const std::array<T, 2>&) const {
    return {};
  }
  template <class K, class T>
  std::array<T, 1> constraint(K k, const std::array<T, 2>& x, const std::array<T, 1>&) const {
    return {ground.at(k) - x[0]};
  }
  template <class T>
  std::array<T, 2> terminal_equality(const std::array<T, 2>& x) const {
    return {1.0 * x[0], x[1] - length};
  }
  [[nodiscard]] bool is_hard(int) const { return true; }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 10.0, .quadratic = 10.0}; }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-5.0}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {5.0}; }

  static FamilyInstance<HangingChain> make(Random& random, bool is_impossible) {
    FamilyInstance<HangingChain> instance;
    HangingChain& p = instance.problem;
    const double height = random.uniform(0.2, 1.0);
    const double least = 2.0 * std::sqrt(0.25 + height * height);
    p.ground[kHorizon / 2] = height;
    p.length = least - std::min(random_gap(random, is_impossible), 0.5 * (least - 1.0));
    instance.goal = {0.0, p.length};
    return instance;
  }
  static FamilyInstance<HangingChain> make(Random& random) { return make(random, false); }
  static FamilyInstance<HangingChain> make_impossible(Random& random) { return make(random, true); }
};

/// A cart whose heading turns too slowly for its goal. States: position [m], heading [rad], speed [m/s];
/// inputs: rate of the heading, acceleration.
struct SlowTurn {
  static constexpr std::string_view kName = "cart that turns too slowly";
  static constexpr int kNx = 4, kNu = 2, kNr = 3, kNe = 0, kNc = 0, kNeh = 3, kHorizon = 40;
  static constexpr double kStep = 0.05;
  static constexpr bool kRecedes = false;
  double turn = 1.0;
  std::array<double, 3> end{};

  template <class K, class T>
  std::array<T, 4> dynamics(K, const std::array<T, 4>& x, const std::array<T, 2>& u) const {
    const T heading = x[2] + (0.5 * kStep) * u[0], speed = x[3] + (0.5 * kStep) * u[1];
    return {x[0] + kStep * speed * cos(heading), x[1] + kStep * speed * sin(heading), x[2] + kStep * u[0],
            x[3] + kStep * u[1]};
  }
  template <class K, class T>
  std::array<T, 3> residual(K, const std::array<T, 4>& x, const std::array<T, 2>& u) const {
    return {0.1 * (x[3] - 1.0), 0.1 * u[0], 0.1 * u[1]};
  }
  template <class T>
  std::array<T, 0> terminal_residual(const std::array<T, 4>&) const {
    return {};
  }
  template <class T>
  std::array<T, 3> terminal_equality(const std::array<T, 4>& x) const {
    return {x[0] - end[0], x[1] - end[1], x[2] - end[2]};
  }
  [[nodiscard]] std::array<double, 2> input_lower(int) const { return {-turn, -1.0}; }
  [[nodiscard]] std::array<double, 2> input_upper(int) const { return {turn, 1.0}; }

  static FamilyInstance<SlowTurn> make(Random& random, bool is_impossible) {
    FamilyInstance<SlowTurn> instance;
    SlowTurn& p = instance.problem;
    p.turn = random.uniform(0.4, 1.2);
    const double most = p.turn * kStep * kHorizon;
    const double room = is_impossible ? random_gap(random, true) : -0.4 * most;
    p.end = {random.uniform(1.2, 1.8), random.uniform(0.3, 0.8), most + room};
    if (!is_impossible) p.end = {random.uniform(1.5, 1.7), random.uniform(0.3, 0.5), 0.5 * most};
    instance.start = {0.0, 0.0, 0.0, random.uniform(0.5, 1.0)};
    instance.goal = {p.end[0], p.end[1], p.end[2], 1.0};
    return instance;
  }
  static FamilyInstance<SlowTurn> make(Random& random) { return make(random, false); }
  static FamilyInstance<SlowTurn> make_impossible(Random& random) { return make(random, true); }
};

}  // namespace chicane::bench
