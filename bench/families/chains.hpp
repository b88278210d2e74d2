// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A chain of springs and masses hangs from a wall; the hand at its other end calms it (after Wirsching,
/// Bock, Diehl 2006). States: positions of the masses [m], their speeds [m/s], the hand; inputs: speed of the
/// hand. The last dimension points upwards.
template <int Masses, int Dimensions>
struct Chain : FamilyProblem<(2 * Masses + 1) * Dimensions, Dimensions> {
  static constexpr std::size_t kMasses = Masses, kDimensions = Dimensions;
  static constexpr std::size_t kPositions = kMasses * kDimensions, kHand = 2 * kPositions;
  static constexpr int kNr = (Masses + 2) * Dimensions, kNe = (Masses + 1) * Dimensions, kHorizon = 40;
  static constexpr double kStep = 0.2, kGravity = 9.81, kMass = 0.03, kRest = 0.033;
  double stiffness = 1.0, calm = 1.0, calm_at_end = 3.0;
  std::array<double, kDimensions> hand{};

  Chain() { this->most.fill(1.0); }

  template <Numbers X>
  X rate(const X& x, const auto& u) const {
    using T = typename X::value_type;
    X slope;
    std::array<T, kDimensions> before;  // pull of the spring on the wall's side
    for (std::size_t n = 0; n <= kMasses; ++n) {
      std::array<T, kDimensions> pull;
      T square = T(1e-6);
      for (std::size_t i = 0; i < kDimensions; ++i) {
        const T& to = x[(n < kMasses ? kDimensions * n : kHand) + i];
        pull[i] = n > 0 ? to - x[kDimensions * (n - 1) + i] : to;
        square = square + pull[i] * pull[i];
      }
      const T share = stiffness * (1.0 - kRest / sqrt(square));
      for (std::size_t i = 0; i < kDimensions; ++i) {
        pull[i] = share * pull[i];
        if (n == 0) continue;
        const std::size_t at = kDimensions * (n - 1) + i, speed = kPositions + at;
        slope[at] = x[speed];
        slope[speed] =
            (1.0 / kMass) * (pull[i] - before[i]) - 0.5 * x[speed] - (i + 1 == kDimensions ? kGravity : 0.0);
      }
      before = pull;
    }
    for (std::size_t i = 0; i < kDimensions; ++i) slope[kHand + i] = u[i];
    return slope;
  }
  auto dynamics(auto, const Numbers auto& x, const Numbers auto& u) const {
    const auto by_rate = [&](const auto& y) { return rate(y, u); };
    return runge_kutta_4(runge_kutta_4(x, 0.5 * kStep, by_rate), 0.5 * kStep, by_rate);
  }
  template <Numbers X>
  auto residual(auto, const X& x, const Numbers auto& u) const {
    std::array<typename X::value_type, kNr> r;
    for (std::size_t i = 0; i < kPositions; ++i) r[i] = calm * x[kPositions + i];
    for (std::size_t i = 0; i < kDimensions; ++i) {
      r[kPositions + i] = 1.5 * (x[kHand + i] - hand[i]);
      r[kPositions + kDimensions + i] = 0.1 * u[i];
    }
    return r;
  }
  template <Numbers X>
  auto terminal_residual(const X& x) const {
    std::array<typename X::value_type, kNe> r;
    for (std::size_t i = 0; i < kPositions; ++i) r[i] = calm_at_end * x[kPositions + i];
    for (std::size_t i = 0; i < kDimensions; ++i) r[kPositions + i] = 5.0 * (x[kHand + i] - hand[i]);
    return r;
  }
};

/// Two masses in the plane, above a floor.
struct ChainOfMasses : Chain<2, 2> {
  static constexpr std::string_view kName = "chain of masses";
  static constexpr int kNc = 3;
  double floor = -0.8;

  auto constraint(auto, const Numbers auto& x, const Numbers auto&) const {
    return std::array{floor - x[1], floor - x[3], floor - x[kHand + 1]};
  }
  [[nodiscard]] solver::SoftPenalty soft_penalty(int) const { return {.linear = 50.0, .quadratic = 50.0}; }
  void draw(Random& random) {
    stiffness = random.uniform(0.8, 1.5);
    hand = {random.uniform(0.4, 1.0), random.uniform(-0.2, 0.3)};
    floor = random.uniform(-0.9, -0.6);
    const double x = random.uniform(0.2, 1.2), y = random.uniform(-0.5, 0.5);
    start = {x / 3 + random.uniform(-0.1, 0.1), y / 3 - 0.3, 2 * x / 3 + random.uniform(-0.1, 0.1),
             2 * y / 3 - 0.3};
    for (std::size_t i = kPositions; i < kHand; ++i) start[i] = random.uniform(-1.0, 1.0);
    start[kHand] = x;
    start[kHand + 1] = y;
    goal = {hand[0] / 3, hand[1] / 3 - 0.4, 2 * hand[0] / 3, 2 * hand[1] / 3 - 0.4};
    goal[kHand] = hand[0];
    goal[kHand + 1] = hand[1];
  }
};

/// Nine masses in space: 60 variables in a stage.
struct LongChain : Chain<9, 3> {
  static constexpr std::string_view kName = "chain of nine masses";
  static constexpr int kNc = 0;
  static constexpr bool kGaussNewton = true;

  void draw(Random& random) {
    calm = 0.3;
    calm_at_end = 1.0;
    stiffness = random.uniform(2.0, 4.0);
    hand = {random.uniform(0.6, 1.4), random.uniform(-0.3, 0.3), random.uniform(-0.2, 0.3)};
    const std::array<double, 3> at{random.uniform(0.4, 1.4), random.uniform(-0.5, 0.5),
                                   random.uniform(-0.3, 0.3)};
    for (std::size_t n = 0; n < kMasses; ++n) {
      const double share = static_cast<double>(n + 1) / (kMasses + 1), sag = share * (1.0 - share);
      for (std::size_t i = 0; i < 3; ++i) {
        start[3 * n + i] = share * at[i] - (i == 2 ? 1.2 * sag : 0.0);
        start[kPositions + 3 * n + i] = random.uniform(-0.5, 0.5);
        goal[3 * n + i] = share * hand[i] - (i == 2 ? 2.0 * sag : 0.0);
      }
    }
    std::copy(at.begin(), at.end(), start.begin() + kHand);
    std::copy(hand.begin(), hand.end(), goal.begin() + kHand);
  }
};

}  // namespace chicane::bench
