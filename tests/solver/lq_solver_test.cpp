// SPDX-License-Identifier: MIT
#include "chicane/solver/detail/lq_solver.hpp"

#include <Eigen/Dense>

#include "chicane/base/random.hpp"
#include "solver/lq_cases.hpp"
#include "support/chicane_test.hpp"

namespace chicane {
namespace {

using test::LqAnswer;
using test::LqData;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Random stages of a pattern; costs are convex, bounds sometimes far, sometimes tight, sometimes equal.
template <class Pattern>
std::unique_ptr<LqData> random_data(Random& random, std::size_t horizon) {
  using Layout = solver::Layout<Pattern>;
  constexpr std::size_t kNx = Layout::kNx;
  constexpr std::size_t kNz = Layout::kNz;
  auto data = std::make_unique<LqData>();
  data->horizon = horizon;
  const double width = random.uniform(0.02, 1.0);
  const double size = kNx > 12 ? 0.25 : 0.5;  // many states that double in each stage are another test
  for (std::size_t k = 0; k < horizon; ++k) {
    for (std::size_t i = 0; i < kNx; ++i) {
      for (std::size_t j = 0; j < kNz; ++j) {
        if (Layout::kF[i][j] != Layout::kNone) data->F[k][i][j] = random.uniform(-size, size);
        if (Layout::kF[i][j] == Layout::kNone && Pattern::kF[i][j] == solver::Entry::kOne)
          data->F[k][i][j] = 1.0;
      }
    }
    // Sums of squares of two neighbours at a time stay inside the pattern.
    for (std::size_t i = 0; i < kNz; ++i) {
      if (i != kNx) data->L[k][i][i] += i > kNx ? 0.3 : 0.01;
      for (std::size_t j = 0; j < i; ++j) {
        if (Layout::kL[i][j] == Layout::kNone) continue;
        const double a = random.uniform(-1.0, 1.0);
        const double b = random.uniform(-1.0, 1.0);
        data->L[k][i][i] += a * a;
        data->L[k][j][j] += b * b;
        data->L[k][i][j] += a * b;
        data->L[k][j][i] += a * b;
      }
    }
    for (std::size_t m = 0; m < Layout::kNu; ++m) {
      const double kind = random.uniform();
      const double centre = random.uniform(-0.3, 0.3);
      data->low[k][m] = kind < 0.1 ? -kInfinity : centre - width;
      data->high[k][m] = kind > 0.9 ? kInfinity : centre + width;
      if (kind > 0.45 && kind < 0.5) data->low[k][m] = data->high[k][m] = centre;
    }
  }
  for (std::size_t i = 0; i < kNx; ++i) {
    data->terminal[kNx][i] = random.uniform(-1.0, 1.0);
    data->terminal[i][i] += 0.1;
    for (std::size_t j = 0; j < kNx; ++j) {
      const double a = random.uniform(-1.0, 1.0);
      data->terminal[i][i] += a * a;
      data->terminal[j][j] += 1.0;
      data->terminal[i][j] += i == j ? 2.0 * a : a;
      data->terminal[j][i] += i == j ? 0.0 : a;
    }
  }
  return data;
}

/// The same problem in the inputs alone: ½ uᵀ H u + gᵀ u, low <= u <= high.
struct Condensed {
  Eigen::MatrixXd H;
  Eigen::VectorXd g, low, high;
};

template <class Pattern>
Condensed condense(const LqData& data) {
  constexpr auto kNx = static_cast<Eigen::Index>(Pattern::kNx);
  constexpr auto kNu = static_cast<Eigen::Index>(Pattern::kNu);
  const auto horizon = static_cast<Eigen::Index>(data.horizon);
  const Eigen::Index n = horizon * kNu;
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(kNx, n + 1);
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(n + 1, n + 1);
  Condensed c;
  c.low = c.high = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 0; k < horizon; ++k) {
    Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(kNx + 1 + kNu, n + 1);
    Z.topRows(kNx) = X;
    Z(kNx, n) = 1.0;
    for (Eigen::Index m = 0; m < kNu; ++m) Z(kNx + 1 + m, k * kNu + m) = 1.0;
    Eigen::MatrixXd L(Z.rows(), Z.rows());
    Eigen::MatrixXd F(kNx, Z.rows());
    for (Eigen::Index i = 0; i < Z.rows(); ++i) {
      for (Eigen::Index j = 0; j < Z.rows(); ++j) {
        L(i, j) = data.L[k][i][j];
        if (i < kNx) F(i, j) = data.F[k][i][j];
      }
    }
    total += Z.transpose() * L * Z;
    for (Eigen::Index m = 0; m < kNu; ++m) {
      c.low(k * kNu + m) = data.low[k][m];
      c.high(k * kNu + m) = data.high[k][m];
    }
    X = F * Z;
  }
  Eigen::MatrixXd P(kNx + 1, kNx + 1);
  for (Eigen::Index i = 0; i < kNx; ++i) {
    for (Eigen::Index j = 0; j < kNx; ++j) P(i, j) = data.terminal[i][j];
    P(i, kNx) = P(kNx, i) = data.terminal[kNx][i];
  }
  P(kNx, kNx) = 0.0;
  Eigen::MatrixXd end = Eigen::MatrixXd::Zero(kNx + 1, n + 1);
  end.topRows(kNx) = X;
  end(kNx, n) = 1.0;
  total += end.transpose() * P * end;
  c.H = total.topLeftCorner(n, n);
  c.g = total.topRightCorner(n, 1);
  return c;
}

/// Largest violation of the bounds, and what is left of the gradient when multipliers of the right signs on
/// active bounds explain as much of it as they can. Both vanish at the optimum, and only there.
struct Certificate {
  double violation = 0.0;
  double gradient = 0.0;
};
Certificate certify(const Condensed& c, const Eigen::VectorXd& u) {
  Certificate result;
  const Eigen::VectorXd slope = c.H * u + c.g;
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    result.violation = std::max({result.violation, c.low(i) - u(i), u(i) - c.high(i)});
    double left = slope(i);
    if (u(i) - c.low(i) < 1e-8) left = std::min(left, 0.0);
    if (c.high(i) - u(i) < 1e-8) left = std::max(left, 0.0);
    result.gradient = std::max(result.gradient, std::fabs(left));
  }
  return result;
}
template <class Pattern>
LqAnswer solve(InstructionSet set, const LqData& data) {
  LqAnswer answer;
  with_instructions(set, [&](auto arch) { test::solve_lq<decltype(arch), Pattern>(data, answer); });
  return answer;
}

std::vector<InstructionSet> available_sets() {
  std::vector<InstructionSet> sets;
  for (const auto set :
       {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512, InstructionSet::kNeon}) {
    if (is_available(set)) sets.push_back(set);
  }
  return sets;
}

template <class Pattern>
class LqSolverOn : public testing::Test {};
using Patterns = testing::Types<test::SparsePattern, test::MemorylessPattern, solver::FullPattern<2, 1>,
#ifdef CHICANE_SLOW_TESTS  // between the sizes of the others; seconds of compiler time for each set
                                solver::FullPattern<8, 2>, test::Compact<solver::FullPattern<8, 2>>,
#endif
                                solver::FullPattern<5, 3>, solver::FullPattern<2, 4>,
                                solver::FullPattern<10, 2>, test::Compact<test::SparsePattern>,
                                test::Compact<solver::FullPattern<23, 2>>>;  // the last one: in loops
TYPED_TEST_SUITE(LqSolverOn, Patterns);

TYPED_TEST(LqSolverOn, FindsTheOptimumOfTheWholeProblem) {
  Random random{41};
  for (int trial = 0; trial < 96; ++trial) {
    const auto data =
        random_data<TypeParam>(random, 1 + static_cast<std::size_t>(trial) % LqData::kMostStages);
    const Condensed dense = condense<TypeParam>(*data);
    for (const InstructionSet set : available_sets()) {
      const LqAnswer answer = solve<TypeParam>(set, *data);
      EXPECT_EQ(answer.shift, 0.0);
      ASSERT_LT(answer.sweeps, 100) << to_string(set) << ", trial " << trial;
      Eigen::VectorXd u(dense.g.size());
      for (Eigen::Index i = 0; i < u.size(); ++i) {
        constexpr auto kNu = static_cast<Eigen::Index>(TypeParam::kNu);
        u(i) = answer.du[i / kNu][i % kNu];
      }
      const Certificate certificate = certify(dense, u);
      // The working set tolerates 1e-10 beyond a bound; gradients are of the order of 10.
      ASSERT_LE(certificate.violation, 2e-10) << to_string(set) << ", trial " << trial;
      ASSERT_LE(certificate.gradient, 1e-8) << to_string(set) << ", trial " << trial;
    }
  }
}

TYPED_TEST(LqSolverOn, GivesTheSameBitsForEveryWidthOfRegisters) {
  if (!is_available(InstructionSet::kAvx512) || !is_available(InstructionSet::kAvx2))
    GTEST_SKIP() << "needs a processor with AVX-512 and a build with CHICANE_SIMD=all";
  Random random{42};
  for (int trial = 0; trial < 48; ++trial) {
    const auto data =
        random_data<TypeParam>(random, 1 + static_cast<std::size_t>(trial) % LqData::kMostStages);
    const LqAnswer narrow = solve<TypeParam>(InstructionSet::kAvx2, *data);
    const LqAnswer wide = solve<TypeParam>(InstructionSet::kAvx512, *data);
    ASSERT_EQ(narrow.sweeps, wide.sweeps);
    ASSERT_EQ(std::memcmp(narrow.du, wide.du, sizeof wide.du), 0) << "trial " << trial;
    ASSERT_EQ(std::memcmp(narrow.dx, wide.dx, sizeof wide.dx), 0) << "trial " << trial;
  }
}

TYPED_TEST(LqSolverOn, StartsASweepAgainWhereTheWorkingSetChanged) {
  Random random{43};
  int iterations = 0;
  for (int trial = 0; trial < 48; ++trial) {
    const auto data = random_data<TypeParam>(random, 24);
    for (const InstructionSet set : available_sets()) {
      const LqAnswer answer = solve<TypeParam>(set, *data);
      EXPECT_TRUE(answer.again_is_same) << to_string(set) << ", trial " << trial;
      iterations += answer.sweeps;
    }
  }
  EXPECT_GT(iterations, 60);
}

TYPED_TEST(LqSolverOn, ShiftsInputsWhoseCostIsNotConvex) {
  Random random{45};
  const auto data = random_data<TypeParam>(random, 6);
  constexpr std::size_t kInput = TypeParam::kNx + 1;
  data->L[3][kInput][kInput] -= 100.0;
  for (std::size_t m = 0; m < TypeParam::kNu; ++m) {
    data->low[3][m] = -1.0;  // free at first: the shift is that of the whole block
    data->high[3][m] = 1.0;
  }
  for (const InstructionSet set : available_sets()) {
    const LqAnswer answer = solve<TypeParam>(set, *data);
    EXPECT_GT(answer.shift, 1.0) << to_string(set);
    for (std::size_t k = 0; k < data->horizon; ++k) {
      for (std::size_t m = 0; m < TypeParam::kNu; ++m) EXPECT_TRUE(std::isfinite(answer.du[k][m]));
    }
  }
}

template <class Pattern>
void expect_same_bits_when_compact() {
  Random random{47};
  for (std::size_t trial = 0; trial < 48; ++trial) {
    const auto data = random_data<Pattern>(random, 1 + trial % LqData::kMostStages);
    for (const InstructionSet set : available_sets()) {
      const LqAnswer one = solve<Pattern>(set, *data);
      const LqAnswer other = solve<test::Compact<Pattern>>(set, *data);
      EXPECT_EQ(one.sweeps, other.sweeps);
      EXPECT_EQ(std::memcmp(one.du, other.du, sizeof one.du), 0) << to_string(set) << ", trial " << trial;
    }
  }
}
TEST(LqSolver, HasTheSameBitsWhereItIsBuiltQuickly) {
  expect_same_bits_when_compact<test::SparsePattern>();
#ifdef CHICANE_SLOW_TESTS
  expect_same_bits_when_compact<solver::FullPattern<8, 2>>();
#endif
}

TEST(LqProblem, IsSetByTablesAsByCode) {
  using Lq = solver::LqProblem<test::SparsePattern, 16>;
  using V = Pack<arch::Baseline, 8>;
  std::array<V, Lq::Layout::kFCount> f;
  std::array<V, Lq::Layout::kLCount> l;
  Random random{48};
  const auto fill = [&](auto& entries) {
    for (V& entry : entries) {
      for (std::size_t lane = 0; lane < 8; ++lane) entry.set(lane, random.uniform(-1.0, 1.0));
    }
  };
  fill(f);
  fill(l);
  const auto one = std::make_unique<Lq>(), other = std::make_unique<Lq>();
  one->set(8, f, l);
  other->set_by_tables(8, f, l);
  for (std::size_t k = 8; k < 16; ++k) {
    EXPECT_EQ(std::memcmp(one->stage[k].number, other->stage[k].number, sizeof one->stage[k].number), 0) << k;
    const std::size_t size = Lq::Layout::kWideRows * sizeof one->stage[k].wide[0];
    EXPECT_EQ(std::memcmp(one->stage[k].wide, other->stage[k].wide, size), 0) << k;
  }
}

TEST(LqSolver, KeepsUnstableSystemsSymmetric) {
  // Rounding errors would grow by 1.5² per stage: beyond all bounds after 200 stages if nothing held them.
  using Pattern = solver::FullPattern<2, 1>;
  const auto qp = std::make_unique<solver::LqSolver<arch::Baseline, Pattern, 200>>();
  for (std::size_t k = 0; k < 200; ++k) {
    const double F[2][4] = {{1.5, 0.3, 0.0, 0.1}, {0.2, 1.4, 0.0, 1.0}};
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 4; ++j) qp->lq.set_jacobian(k, i, j, F[i][j]);
      qp->lq.set_cost(k, i, i, 1.0);
    }
    qp->lq.set_jacobian(k, 0, 2, k == 0 ? 1.0 : 0.0);
    qp->lq.set_cost(k, 3, 3, 1.0);
    qp->lq.low[0][k] = -kInfinity;
    qp->lq.high[0][k] = kInfinity;
  }
  qp->backward(200);
  // Far from the end gains are those of the infinite horizon.
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(qp->gain(20, 0, i), qp->gain(100, 0, i), 1e-10);
  qp->forward(200, decltype(qp)::element_type::Repair::kAll);
  EXPECT_LT(std::abs(qp->dx[200][0]), 1e-3);
}

}  // namespace
}  // namespace chicane
