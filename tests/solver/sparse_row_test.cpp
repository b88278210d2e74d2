// SPDX-License-Identifier: MIT
#include "chicane/solver/sparse_row.hpp"

#include <gtest/gtest.h>

#include <array>
#include <tuple>
#include <vector>

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

}  // namespace
}  // namespace chicane::solver
