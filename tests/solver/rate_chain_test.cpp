// SPDX-License-Identifier: MIT
#include "chicane/solver/detail/rate_chain.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "chicane/base/random.hpp"

namespace chicane {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Chain = solver::RateChain<24>;

Chain random_chain(Random& random, std::size_t horizon) {
  Chain chain;
  chain.horizon = horizon;
  chain.previous = random.uniform(-0.5, 0.5);
  const double width = random.uniform(0.05, 1.0);
  for (std::size_t k = 0; k < horizon; ++k) {
    const double middle = random.uniform(-0.3, 0.3);
    chain.low[k] = random.uniform() < 0.1 ? -kInfinity : middle - width;
    chain.high[k] = random.uniform() < 0.1 ? kInfinity : middle + width;
    const double change = random.uniform(-0.1, 0.1);
    const double kind = random.uniform();
    chain.rate_low[k] = kind < 0.1 ? -kInfinity : change - (kind < 0.2 ? 0.0 : random.uniform(0.0, 0.4));
    chain.rate_high[k] = kind > 0.9 ? kInfinity : change + (kind < 0.2 ? 0.0 : random.uniform(0.0, 0.4));
  }
  chain.make_consistent();
  return chain;
}

/// Largest violation of the bounds.
double violation(const Chain& chain, const std::vector<double>& v) {
  double worst = 0.0;
  double last = chain.previous;
  for (std::size_t k = 0; k < v.size(); ++k) {
    worst = std::max({worst, chain.low[k] - v[k], v[k] - chain.high[k], v[k] - last - chain.rate_high[k],
                      chain.rate_low[k] - (v[k] - last)});
    last = v[k];
  }
  return worst;
}

/// The admissible point nearest to y: Dykstra's alternating projections, slow and sure.
std::vector<double> nearest(const Chain& chain, std::vector<double> v) {
  const std::size_t n = v.size();
  std::vector<std::array<double, 2>> box(n), rate(n);
  for (int round = 0; round < 20000; ++round) {
    double moved = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      const double wanted = v[k] + box[k][0];
      const double now = std::min(std::max(wanted, chain.low[k]), chain.high[k]);
      moved = std::max(moved, std::abs(now - v[k]));
      box[k][0] = wanted - now;
      v[k] = now;
      const double from = k == 0 ? chain.previous : v[k - 1] + rate[k][0];
      const double to = v[k] + rate[k][1];
      const double change = std::min(std::max(to - from, chain.rate_low[k]), chain.rate_high[k]);
      const double excess = (to - from) - change;
      const double share = k == 0 ? 0.0 : 0.5 * excess;
      rate[k] = {-share, excess - share};
      moved = std::max(moved, std::abs(to - (excess - share) - v[k]));
      if (k > 0) v[k - 1] = from + share;
      v[k] = to - (excess - share);
    }
    if (moved < 1e-14) break;
  }
  return v;
}

/// The multipliers of the last distance() explain what is left at v, the point nearest to `wanted`, with the
/// right signs.
void expect_multipliers_of(const Chain& chain, const std::vector<double>& v,
                           const std::vector<double>& wanted, int trial) {
  double last = chain.previous;
  for (std::size_t k = 0; k < v.size(); ++k) {
    const double price = chain.multiplier(k);
    if (price > 1e-9) {
      ASSERT_NEAR(v[k] - last, chain.rate_high[k], 1e-9) << trial << ' ' << k;
    }
    if (price < -1e-9) {
      ASSERT_NEAR(v[k] - last, chain.rate_low[k], 1e-9) << trial << ' ' << k;
    }
    const double left = v[k] - wanted[k] + price - (k + 1 < v.size() ? chain.multiplier(k + 1) : 0.0);
    if (left > 1e-8) {
      ASSERT_NEAR(v[k], chain.low[k], 1e-9) << trial << ' ' << k;
    }
    if (left < -1e-8) {
      ASSERT_NEAR(v[k], chain.high[k], 1e-9) << trial << ' ' << k;
    }
    last = v[k];
  }
}

TEST(RateChain, FindsTheNearestAdmissibleInputs) {
  Random random{11};
  int unique = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t n = 1 + static_cast<std::size_t>(trial) % 24;
    Chain chain = random_chain(random, n);
    std::vector<double> u(n), slope(n), wanted(n);
    for (std::size_t k = 0; k < n; ++k) {
      u[k] = random.uniform(-1.0, 1.0);
      slope[k] = random.uniform(-1.5, 1.5);
      wanted[k] = u[k] - slope[k];
    }
    const std::vector<double> v = nearest(chain, wanted);
    double largest = 0.0;
    for (std::size_t k = 0; k < n; ++k) largest = std::max(largest, std::abs(u[k] - v[k]));
    ASSERT_NEAR(chain.distance(u.data(), slope.data(), n), largest, 1e-9) << trial;
    // Its multipliers explain what is left, with the right signs; they are unique where nothing had to give
    // way.
    if (chain.excess > 0.0) continue;
    ++unique;
    expect_multipliers_of(chain, v, wanted, trial);
  }
  EXPECT_GT(unique, 50);
}

// Inputs that touch an own bound between two changes at their bounds: multipliers of one piece depend on
// those of the pieces before and behind it.
TEST(RateChain, FindsMultipliersOfInputsThatBounceOffABound) {
  Random random{13};
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t n = 4 + static_cast<std::size_t>(trial) % 21;
    Chain chain;
    chain.horizon = n;
    std::vector<double> u(n), slope(n), wanted(n);
    for (std::size_t k = 0; k < n; ++k) {
      chain.low[k] = 0.0;
      chain.high[k] = random.uniform() < 0.5 ? 1.0 : kInfinity;
      chain.rate_low[k] = -1.0;
      chain.rate_high[k] = 1.0;
      wanted[k] = 8.0 * random.uniform(-1.0, 1.0);
      slope[k] = u[k] - wanted[k];
    }
    chain.make_consistent();
    chain.distance(u.data(), slope.data(), n);
    expect_multipliers_of(chain, nearest(chain, wanted), wanted, trial);
  }
}

TEST(RateChain, AdmitsAnyInputs) {
  Random random{12};
  int contradictions = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t n = 1 + static_cast<std::size_t>(trial) % 24;
    const Chain chain = random_chain(random, n);
    contradictions += chain.excess > 0.0 ? 1 : 0;
    std::vector<double> v(n);
    double last = chain.previous;
    for (std::size_t k = 0; k < n; ++k) {
      const double wanted = trial % 7 == 0 ? std::nan("") : random.uniform(-3.0, 3.0);
      last = v[k] = chain.admit(k, wanted, last);
      ASSERT_TRUE(v[k] >= chain.low[k] && v[k] <= chain.high[k]);
    }
    ASSERT_LE(violation(chain, v), 1e-15) << trial;
    // What is admissible stays.
    last = chain.previous;
    for (std::size_t k = 0; k < n; ++k) {
      ASSERT_NEAR(chain.admit(k, v[k], last), v[k], 1e-15);
      last = v[k];
    }
  }
  EXPECT_GT(contradictions, 50);
}

TEST(RateChain, LooksAheadWhereOwnBoundsMove) {
  Chain chain;
  chain.horizon = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    chain.low[k] = k == 2 ? 0.7 : -1.0;
    chain.high[k] = 1.0;
    chain.rate_low[k] = -0.4;
    chain.rate_high[k] = 0.4;
  }
  chain.make_consistent();
  EXPECT_EQ(chain.excess, 0.0);
  EXPECT_EQ(chain.admit(0, -1.0, 0.0), 0.7 - 0.4 - 0.4);  // from lower, stage 2 is out of reach
  chain.previous = -1.0;
  chain.make_consistent();
  EXPECT_NEAR(chain.excess, 0.5, 1e-15);  // 1.2 in three changes, 1.7 is needed: the first gives way
  EXPECT_EQ(chain.excess_stage, 0U);
}

}  // namespace
}  // namespace chicane
