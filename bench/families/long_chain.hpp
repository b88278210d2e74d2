// SPDX-License-Identifier: MIT
#pragma once

#include "families/family.hpp"

namespace chicane::bench {

/// A chain of nine masses between springs hangs from a wall in space; the hand at its other end calms it
/// (after Wirsching, Bock, Diehl 2006). States: positions of the masses [m], their speeds [m/s], the hand;
/// inputs: speed of the hand. 60 variables in a stage.
struct LongChain {
  static constexpr std::string_view kName = "chain of nine masses";
  static constexpr std::size_t kMasses = 9, kPositions = 3 * kMasses, kHand = 6 * kMasses;
  static constexpr int kNx = 57, kNu = 3, kNr = 33, kNe = 30, kNc = 0, kHorizon = 40;
  static constexpr bool kGaussNewton = true;
  static constexpr double kStep = 0.2, kGravity = 9.81;
  double stiffness = 1.0, mass = 0.03, rest = 0.033, most = 1.0;
  std::array<double, 3> hand{1.0, 0.0, 0.0};

  template <class T>
  using State = std::array<T, 57>;
  template <class T>
  using Input = std::array<T, 3>;

  template <class T>
  static State<T> rate(const LongChain& p, const State<T>& x, const Input<T>& u) {
    State<T> slope;
    std::array<T, 3> before;  // pull of the spring on the wall's side
    for (std::size_t n = 0; n <= kMasses; ++n) {
      std::array<T, 3> pull;
      T square = T(1e-6);
      for (std::size_t i = 0; i < 3; ++i) {
        const T& to = n < kMasses ? x[3 * n + i] : x[kHand + i];
        pull[i] = n > 0 ? to - x[3 * (n - 1) + i] : to;
        square = square + pull[i] * pull[i];
      }
      const T share = p.stiffness * (1.0 - p.rest / sqrt(square));
      for (std::size_t i = 0; i < 3; ++i) {
        pull[i] = share * pull[i];
        if (n > 0) {
          const std::size_t at = 3 * (n - 1) + i;
          slope[at] = x[kPositions + at];
          slope[kPositions + at] =
              (1.0 / p.mass) * (pull[i] - before[i]) - 0.5 * x[kPositions + at] - (i == 2 ? kGravity : 0.0);
        }
      }
      before = pull;
    }
    for (std::size_t i = 0; i < 3; ++i) slope[kHand + i] = u[i];
    return slope;
  }
  template <class K, class T>
  State<T> dynamics(K, const State<T>& x, const Input<T>& u) const {
    State<T> next = x;
    for (int part = 0; part < 2; ++part)
      next = runge_kutta_4(next, 0.5 * kStep, [&](const State<T>& y) { return rate<T>(*this, y, u); });
    return next;
  }
  template <class K, class T>
  std::array<T, 33> residual(K, const State<T>& x, const Input<T>& u) const {
    std::array<T, 33> r;
    for (std::size_t i = 0; i < kPositions; ++i) r[i] = 0.3 * x[kPositions + i];
    for (std::size_t i = 0; i < 3; ++i) {
      r[kPositions + i] = 1.5 * (x[kHand + i] - hand[i]);
      r[kPositions + 3 + i] = 0.1 * u[i];
    }
    return r;
  }
  template <class T>
  std::array<T, 30> terminal_residual(const State<T>& x) const {
    std::array<T, 30> r;
    for (std::size_t i = 0; i < kPositions; ++i) r[i] = 1.0 * x[kPositions + i];
    for (std::size_t i = 0; i < 3; ++i) r[kPositions + i] = 5.0 * (x[kHand + i] - hand[i]);
    return r;
  }
  [[nodiscard]] std::array<double, 3> input_lower(int) const { return {-most, -most, -most}; }
  [[nodiscard]] std::array<double, 3> input_upper(int) const { return {most, most, most}; }

  static FamilyInstance<LongChain> make(Random& random) {
    FamilyInstance<LongChain> instance;
    LongChain& p = instance.problem;
    p.stiffness = random.uniform(2.0, 4.0);
    p.hand = {random.uniform(0.6, 1.4), random.uniform(-0.3, 0.3), random.uniform(-0.2, 0.3)};
    const std::array<double, 3> at{random.uniform(0.4, 1.4), random.uniform(-0.5, 0.5),
                                   random.uniform(-0.3, 0.3)};
    for (std::size_t n = 0; n < kMasses; ++n) {
      const double share = static_cast<double>(n + 1) / (kMasses + 1);
      for (std::size_t i = 0; i < 3; ++i) {
        instance.start[3 * n + i] = share * at[i] - (i == 2 ? 1.2 * share * (1.0 - share) : 0.0);
        instance.start[kPositions + 3 * n + i] = random.uniform(-0.5, 0.5);
        instance.goal[3 * n + i] = share * p.hand[i] - (i == 2 ? 2.0 * share * (1.0 - share) : 0.0);
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      instance.start[kHand + i] = at[i];
      instance.goal[kHand + i] = p.hand[i];
    }
    return instance;
  }
};

}  // namespace chicane::bench
