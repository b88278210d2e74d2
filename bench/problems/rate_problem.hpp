// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string_view>

#include "problems/described_problem.hpp"

namespace chicane::bench {

/// A form of the described problem with bounds on how far steering and acceleration may move from one
/// interval to the next; asymmetric, and not the same in every stage.
template <class Described>
struct RateBounded : Described {
  using Described::Described;
  static constexpr std::array<int, 2> kPreviousInput{Described::kNx - 2, Described::kNx - 1};

  std::array<double, 2> most_down{-0.05, -0.3};  ///< per interval, < 0
  std::array<double, 2> most_up{0.05, 0.3};
  double wave = 0.0;  ///< every third stage allows this share less

  [[nodiscard]] std::array<double, 2> input_rate_lower(int k) const { return scaled(most_down, k); }
  [[nodiscard]] std::array<double, 2> input_rate_upper(int k) const { return scaled(most_up, k); }
  [[nodiscard]] static std::string_view input_name(int m) { return m == 0 ? "steering" : "acceleration"; }
  [[nodiscard]] static std::string_view input_unit(int m) { return m == 0 ? "rad" : "m/s²"; }

 private:
  [[nodiscard]] std::array<double, 2> scaled(const std::array<double, 2>& bound, int k) const {
    const double share = k % 3 == 2 ? 1.0 - wave : 1.0;
    return {share * bound[0], share * bound[1]};
  }
};

using RateProblem = RateBounded<DescribedProblem>;
using StructuredRateProblem = RateBounded<StructuredDescribedProblem>;

/// A problem of the described kind whose inputs start from `last` and may move so much.
struct RateInstance {
  RateProblem problem;
  std::array<double, DescribedProblem::kNx> start{};
};

/// Random problems; from hardly any bound on changes to nearly all of them active.
inline RateInstance random_rates(Random& random, int horizon) {
  const DescribedInstance plain = random_instance(random, horizon);
  RateInstance instance;
  static_cast<DescribedProblem&>(instance.problem) = plain.problem;
  instance.start = plain.start;
  const double size = exp(random.uniform(-3.0, 0.5));
  instance.problem.most_up = {size * random.uniform(0.05, 0.2), size * random.uniform(0.2, 1.0)};
  instance.problem.most_down = {-size * random.uniform(0.05, 0.2), -size * random.uniform(0.2, 1.0)};
  instance.problem.wave = random.uniform(-0.5, 0.5);
  instance.start[6] = random.uniform(-0.4, 0.4);
  instance.start[7] = random.uniform(-1.0, 1.0);
  return instance;
}

}  // namespace chicane::bench
