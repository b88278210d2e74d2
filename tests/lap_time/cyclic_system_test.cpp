// SPDX-License-Identifier: MIT
#include "chicane/lap_time/detail/cyclic_system.hpp"

#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane::lap_time {
namespace {

TEST(SymmetricBlock, SolvesWhatIsNotDefiniteAndCountsItsNegativeEigenvalues) {
  Random numbers{42};
  // [H Aᵀ; A 0] with H positive definite: as many negative eigenvalues as A has rows.
  constexpr int n = 9, rows = 4, all = n + rows;
  std::vector<double> matrix(all * all, 0.0);
  for (int i = 0; i < n; ++i)
    matrix[i * all + i] = 1e-6 + (i % 3 == 0 ? 0.0 : 2.0 + numbers.uniform(-1.0, 1.0));
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < n; ++j)
      matrix[(n + i) * all + j] = matrix[j * all + n + i] = numbers.uniform(-1.0, 1.0);
  SymmetricBlock block;
  ASSERT_TRUE(block.factor(matrix.data(), all));
  EXPECT_EQ(block.negative(), rows);
  std::vector<double> x(all), b(all, 0.0);
  for (double& value : x) value = numbers.uniform(-1.0, 1.0);
  for (int i = 0; i < all; ++i)
    for (int j = 0; j < all; ++j) b[i] += matrix[i * all + j] * x[j];
  block.solve(b.data(), 1);
  for (int i = 0; i < all; ++i) EXPECT_NEAR(b[i], x[i], 1e-9);
}

TEST(SymmetricBlock, RefusesASingularMatrix) {
  const std::vector<double> matrix(9, 0.0);
  EXPECT_FALSE(SymmetricBlock{}.factor(matrix.data(), 3));
}

/// A ring of nodes with a convex cost and the equations of a system.
void fill(CyclicSystem& system, int nodes, int nz, int nx, double convexity) {
  Random numbers{42};
  const int nb = system.block_size();
  for (int k = 0; k < nodes; ++k) {
    double* d = system.diagonal(k);
    for (int i = 0; i < nz; ++i) d[i * nb + i] = convexity * (1.5 + numbers.uniform(-1.0, 1.0));
    for (int i = nz; i < nb; ++i)
      for (int j = 0; j < nz; ++j)
        d[i * nb + j] = d[j * nb + i] = (i - nz == j ? 1.0 : 0.2 * numbers.uniform(-1.0, 1.0));
    for (int i = 0; i < nx * nz; ++i)
      system.coupling(k)[i] = (i % nz == i / nz ? -0.7 : 0.1 * numbers.uniform(-1.0, 1.0));
  }
}

TEST(CyclicSystem, SolvesARing) {
  constexpr int nz = 5, nx = 3, na = 1, nb = nz + nx + na;
  for (const int nodes : {2, 3, 7}) {
    CyclicSystem system(nodes, nz, nx, na);
    fill(system, nodes, nz, nx, 1.0);
    ASSERT_TRUE(system.factor());
    Random numbers{42};
    std::vector<double> x(static_cast<std::size_t>(nodes * nb)), b(x.size(), 0.0);
    for (double& value : x) value = numbers.uniform(-1.0, 1.0);
    for (int k = 0; k < nodes; ++k) {
      const int next = (k + 1) % nodes;
      for (int i = 0; i < nb; ++i)
        for (int j = 0; j < nb; ++j) b[k * nb + i] += system.diagonal(k)[i * nb + j] * x[k * nb + j];
      for (int i = 0; i < nx; ++i) {
        for (int j = 0; j < nz; ++j) {
          const double entry = system.coupling(k)[i * nz + j];
          b[next * nb + nz + i] += entry * x[k * nb + j];
          b[k * nb + j] += entry * x[next * nb + nz + i];
        }
      }
    }
    system.solve(b);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(b[i], x[i], 1e-9) << nodes << ' ' << i;
  }
}

TEST(CyclicSystem, RefusesACostThatIsNotConvexWhereTheEquationsHold) {
  CyclicSystem system(7, 5, 3, 1);
  fill(system, 7, 5, 3, -1.0);
  EXPECT_FALSE(system.factor());
}

}  // namespace
}  // namespace chicane::lap_time
