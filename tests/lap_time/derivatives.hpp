// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/lap_time/detail/collocation.hpp"
#include "support/chicane_test.hpp"

namespace chicane::lap_time {

/// Checks values, Jacobian and weighted Hessian of a node's functions at `z` against central differences.
inline void expect_derivatives_of_differences(const NodeFunctions& f, int node,
                                              const std::vector<double>& z) {
  const auto n = static_cast<std::size_t>(f.variables);
  const auto m = static_cast<std::size_t>(f.functions());
  std::vector<double> weights(m);
  for (std::size_t i = 0; i < m; ++i) weights[i] = 0.3 + 0.1 * static_cast<double>(i % 7);
  std::vector<double> out(m), low(m), high(m), jacobian(m * n), slopes_low(m * n), slopes_high(m * n);
  std::vector<double> hessian(n * (n + 1) / 2), other(n * (n + 1) / 2);
  f.derivatives(node, z.data(), weights.data(), out.data(), jacobian.data(), hessian.data());
  f.values(node, z.data(), low.data());
  for (std::size_t i = 0; i < m; ++i) EXPECT_NEAR(out[i], low[i], 1e-12 * (1.0 + std::fabs(low[i])));
  for (std::size_t j = 0; j < n; ++j) {
    const double step = 1e-5 * f.scale[j];
    std::vector<double> moved = z;
    moved[j] = z[j] - step;
    f.derivatives(node, moved.data(), weights.data(), low.data(), slopes_low.data(), other.data());
    moved[j] = z[j] + step;
    f.derivatives(node, moved.data(), weights.data(), high.data(), slopes_high.data(), other.data());
    for (std::size_t i = 0; i < m; ++i) {
      const double slope = (high[i] - low[i]) / (2.0 * step);
      // Central differences of second order: a millionth of the function's size by scaled steps of 1e-5.
      EXPECT_NEAR(jacobian[i * n + j], slope, 1e-5 * (std::fabs(slope) + 1.0 / f.scale[j])) << i << ' ' << j;
    }
    for (std::size_t i = 0; i <= j; ++i) {
      double bent = 0.0;
      for (std::size_t k = 0; k < m; ++k)
        bent += weights[k] * (slopes_high[k * n + i] - slopes_low[k * n + i]) / (2.0 * step);
      EXPECT_NEAR(hessian[j * (j + 1) / 2 + i], bent,
                  1e-4 * (std::fabs(bent) + 1.0 / (f.scale[i] * f.scale[j])))
          << i << ' ' << j;
    }
  }
}

}  // namespace chicane::lap_time
