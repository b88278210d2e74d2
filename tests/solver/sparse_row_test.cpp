// SPDX-License-Identifier: MIT
#include "chicane/solver/sparse_row.hpp"

#include <type_traits>

#include "chicane/solver/ocp_solver.hpp"
#include "support/chicane_test.hpp"

namespace chicane::solver {
namespace {

/// Of x₀² + 3 x₀ x₂ at (2, ·, 5): slots 0 … 3 are value, slopes by 0 and 2, and the curvature by 0 and 2.
struct Row {
  std::array<double, 8> slots{34.0, -1.0, 19.0, -1.0, 6.0, -1.0, 3.0, -1.0};  // in the first of two lanes
  std::array<SparseEntry, 2> slopes{SparseEntry{0, 0, 1}, SparseEntry{2, 2, 2}};
  std::array<SparseEntry, 1> curvatures{SparseEntry{0, 2, 3}};

  [[nodiscard]] SparseRow<double> row() const {
    SparseRow<double> row;
    row.v = slots[0];
    row.slots = slots.data();
    row.slopes = slopes.data();
    row.curvatures = curvatures.data();
    row.slope_count = 2;
    row.curvature_count = 1;
    row.stride = 2;
    return row;
  }
};

using Slopes = std::vector<std::tuple<std::size_t, double>>;
Slopes slopes_of(const SparseRow<double>& row) {
  Slopes slopes;
  row.each_slope([&](std::size_t i, double slope) { slopes.emplace_back(i, slope); });
  return slopes;
}

TEST(SparseRow, TellsItsDerivativesScaled) {
  const Row of;
  const SparseRow<double> row = 2.0 * of.row() + 1.0;
  EXPECT_EQ(row.v, 69.0);
  EXPECT_EQ(slopes_of(row), (Slopes{{0, 38.0}, {2, 12.0}}));
  std::vector<std::tuple<std::size_t, std::size_t, double>> curvatures;
  row.each_curvature(
      [&](std::size_t i, std::size_t j, double value) { curvatures.emplace_back(i, j, value); });
  EXPECT_EQ(curvatures, (decltype(curvatures){{0, 2, 6.0}}));
}

TEST(SparseRow, PositivePartIsFlatBelowZero) {
  const Row of;
  EXPECT_EQ(slopes_of(positive_part(of.row())), slopes_of(of.row()));
  const SparseRow<double> below = positive_part(of.row() + -40.0);
  EXPECT_EQ(below.v, 0.0);
  EXPECT_EQ(slopes_of(below), (Slopes{{0, 0.0}, {2, 0.0}}));
}

TEST(SparseRow, IsAbsentWithoutSlots) {
  EXPECT_TRUE(SparseRow<double>{}.is_absent());
  EXPECT_FALSE(Row{}.row().is_absent());
}

/// A mass that is pushed a way of 1 in 20 stages, and is no faster than 0.2 at the end, as data: rows that
/// are linear in (position, speed, push). Of each kind of what must hold there is a second row, which is
/// absent.
class SparsePush {
 public:
  static constexpr int kNx = 2, kNu = 1, kNr = 1, kNe = 0, kNc = 0, kNh = 1, kNeh = 2, kNec = 2;
  static constexpr bool kHasSparseRows = true;

  template <class K, class X, std::size_t N, class U, std::size_t M>
  auto dynamics(K, const std::array<X, N>& x, const std::array<U, M>& u) const {
    return std::array{row({1.0, 0.1, 0.0}, 0.0, x, u), row({0.0, 1.0, 0.1}, 0.0, x, u)};
  }
  template <class K, class X, std::size_t N, class U, std::size_t M>
  auto residual(K, const std::array<X, N>& x, const std::array<U, M>& u) const {
    return std::array{row({0.0, 0.0, 1.0}, 0.0, x, u)};
  }
  template <class K, class X, std::size_t N, class U, std::size_t M>
  auto equality(K, const std::array<X, N>& x, const std::array<U, M>& u) const {
    return std::array{absent(row({0.0, 0.0, 0.0}, 0.0, x, u))};
  }
  template <class X, std::size_t N>
  auto terminal_residual(const std::array<X, N>& x) const {
    return std::array<decltype(row({}, 0.0, x, std::array<X, 0>{})), 0>{};
  }
  template <class X, std::size_t N>
  auto terminal_equality(const std::array<X, N>& x) const {
    const std::array<X, 0> none{};
    return std::array{row({1.0, 0.0, 0.0}, -1.0, x, none), absent(row({0.0, 0.0, 0.0}, 0.0, x, none))};
  }
  template <class X, std::size_t N>
  auto terminal_constraint(const std::array<X, N>& x) const {
    const std::array<X, 0> none{};
    return std::array{row({0.0, 1.0, 0.0}, -0.2, x, none), absent(row({0.0, 0.0, 0.0}, 0.0, x, none))};
  }
  [[nodiscard]] std::array<double, 1> input_lower(int) const { return {-5.0}; }
  [[nodiscard]] std::array<double, 1> input_upper(int) const { return {5.0}; }

 private:
  template <class T>
  struct Result {
    using Value = T;
    using Type = T;
    static T value(const T& x) { return x; }
  };
  template <class T, int Order>
  struct Result<SparseSeed<T, Order>> {
    using Value = T;
    using Type = SparseRow<T>;
    static T value(const SparseSeed<T, Order>& x) { return x.v; }
  };
  template <class X, std::size_t N, class U, std::size_t M>
  static typename Result<X>::Type row(const std::array<double, 3>& factors, double constant,
                                      const std::array<X, N>& x, const std::array<U, M>& u) {
    using Of = Result<X>;
    using Value = typename Of::Value;
    static constexpr std::array kEntries{SparseEntry{0, 0, 0}, SparseEntry{1, 1, 1}, SparseEntry{2, 2, 2}};
    Value value = Value(constant) + factors[0] * Of::value(x[0]) + factors[1] * Of::value(x[1]);
    if constexpr (M > 0) value = value + factors[2] * Of::value(u[0]);
    if constexpr (std::is_same_v<typename Of::Type, Value>) {
      return value;
    } else {
      static std::vector<std::unique_ptr<std::array<Value, 3>>> kept;  // slots outlive the call
      kept.push_back(std::make_unique<std::array<Value, 3>>());
      for (std::size_t i = 0; i < 3; ++i) (*kept.back())[i] = Value(factors[i]);
      SparseRow<Value> result;
      result.v = value;
      result.slots = kept.back()->data();
      result.slopes = kEntries.data();
      result.slope_count = M > 0 ? 3 : 2;
      return result;
    }
  }
  template <class T>
  static SparseRow<T> absent(const SparseRow<T>&) {
    return {};
  }
  template <class T>
  static T absent(const T&) {
    return T(0.0);
  }
};

TEST(SparseRow, ThatIsAbsentNeedNotHold) {
  const auto ocp = std::make_unique<OcpSolver<SparsePush, 20>>();
  Trajectory<2, 1, 20> plan{.horizon = 20};
  const HardReport report = ocp->solve({}, {0.0, 0.0}, plan);
  ASSERT_EQ(report.status, SolveStatus::kOptimal);
  EXPECT_LE(report.iterations, 20);
  EXPECT_EQ(report.rounds, 1);  // by the primal-dual method
  EXPECT_NEAR(plan.x[20][0], 1.0, 1e-6);
  EXPECT_NEAR(plan.x[20][1], 0.2, 1e-6);
  EXPECT_EQ(ocp->terminal_equality_multiplier(1), 0.0);
  EXPECT_EQ(ocp->terminal_constraint_multiplier(1), 0.0);
}

}  // namespace
}  // namespace chicane::solver
