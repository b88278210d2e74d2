// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <algorithm>

namespace chicane::test {

/// min ½ uᵀ H u + gᵀ u s.t. low <= u <= high for positive definite H, by coordinate descent until nothing
/// moves: slow and obviously right.
inline Eigen::VectorXd solve_dense_qp(const Eigen::MatrixXd& H, const Eigen::VectorXd& g,
                                      const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(g.size()).cwiseMax(low).cwiseMin(high);
  for (int round = 0; round < 200000; ++round) {
    double moved = 0.0;
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      const double wanted = std::clamp(u(i) - (g(i) + H.row(i).dot(u)) / H(i, i), low(i), high(i));
      moved = std::max(moved, std::abs(wanted - u(i)));
      u(i) = wanted;
    }
    if (moved < 1e-15) break;
  }
  return u;
}

}  // namespace chicane::test
