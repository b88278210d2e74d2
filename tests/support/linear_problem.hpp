// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <array>

#include "chicane/base/random.hpp"
#include "chicane/solver/problem.hpp"
#include "support/dense_qp.hpp"

namespace chicane::test {

/// Linear dynamics x⁺ = A x + B u + c and linear residuals: one quadratic program. All stages share random
/// matrices; bounds differ from stage to stage and are sometimes infinite or equal.
template <int Nx, int Nu>
struct LinearProblem {
  static constexpr int kNx = Nx;
  static constexpr int kNu = Nu;
  static constexpr int kNr = Nx + Nu;
  static constexpr int kNe = Nx;
  static constexpr int kNc = 0;
  static constexpr int kStages = 16;

  std::array<std::array<double, Nx + Nu + 1>, Nx> next{};   ///< rows [A B c]
  std::array<std::array<double, Nx + Nu + 1>, kNr> miss{};  ///< rows of the residual
  std::array<std::array<double, Nx + 1>, kNe> end{};        ///< rows of the terminal residual
  std::array<std::array<double, Nu>, kStages> low{};
  std::array<std::array<double, Nu>, kStages> high{};

  template <class T>
  std::array<T, Nx> dynamics(int, const std::array<T, Nx>& x, const std::array<T, Nu>& u) const {
    return apply<Nx>(next, x, u);
  }
  template <class T>
  std::array<T, kNr> residual(int, const std::array<T, Nx>& x, const std::array<T, Nu>& u) const {
    return apply<kNr>(miss, x, u);
  }
  template <class T>
  std::array<T, kNe> terminal_residual(const std::array<T, Nx>& x) const {
    std::array<T, kNe> r;
    for (std::size_t i = 0; i < r.size(); ++i) {
      r[i] = T(end[i][Nx]);
      for (std::size_t j = 0; j < x.size(); ++j) r[i] += end[i][j] * x[j];
    }
    return r;
  }
  [[nodiscard]] std::array<double, Nu> input_lower(int k) const { return low[static_cast<std::size_t>(k)]; }
  [[nodiscard]] std::array<double, Nu> input_upper(int k) const { return high[static_cast<std::size_t>(k)]; }

 private:
  template <int Rows, class T, class Matrix>
  static std::array<T, Rows> apply(const Matrix& matrix, const std::array<T, Nx>& x,
                                   const std::array<T, Nu>& u) {
    std::array<T, Rows> y;
    for (std::size_t i = 0; i < y.size(); ++i) {
      y[i] = T(matrix[i][Nx + Nu]);
      for (std::size_t j = 0; j < x.size(); ++j) y[i] += matrix[i][j] * x[j];
      for (std::size_t j = 0; j < u.size(); ++j) y[i] += matrix[i][Nx + j] * u[j];
    }
    return y;
  }
};

template <int Nx, int Nu>
LinearProblem<Nx, Nu> random_linear_problem(Random& random) {
  LinearProblem<Nx, Nu> p;
  const auto fill = [&random](auto& matrix, double size) {
    for (auto& row : matrix) {
      for (double& value : row) value = random.uniform(-size, size);
    }
  };
  fill(p.next, 0.6);
  fill(p.miss, 1.0);
  fill(p.end, 1.0);
  for (std::size_t m = 0; m < Nu; ++m) p.miss[Nx + m][Nx + m] += 2.0;  // every input has a cost of its own
  const double width = random.uniform(0.05, 1.5);
  for (std::size_t k = 0; k < p.low.size(); ++k) {
    for (std::size_t m = 0; m < Nu; ++m) {
      const double kind = random.uniform();
      const double centre = random.uniform(-0.5, 0.5);
      p.low[k][m] = kind < 0.1 ? -std::numeric_limits<double>::infinity() : centre - width;
      p.high[k][m] = kind > 0.9 ? std::numeric_limits<double>::infinity() : centre + width;
      if (kind > 0.45 && kind < 0.5) p.low[k][m] = p.high[k][m] = centre;
    }
  }
  return p;
}

/// The optimal inputs by eliminating all states: a dense quadratic program in the inputs alone.
template <int Nx, int Nu>
Eigen::VectorXd solve_densely(const LinearProblem<Nx, Nu>& p,
                              const std::array<double, LinearProblem<Nx, Nu>::kNx>& x0, int horizon) {
  const Eigen::Index n = Eigen::Index{horizon} * Nu;
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(Nx, n + 1);  // x_k as an affine function of all inputs
  for (int i = 0; i < Nx; ++i) X(i, n) = x0[static_cast<std::size_t>(i)];
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n + 1, n + 1);
  Eigen::VectorXd low(n);
  Eigen::VectorXd high(n);
  const auto row = [&](const auto& coefficients, int stage) {
    Eigen::RowVectorXd r = Eigen::RowVectorXd::Zero(n + 1);
    for (int j = 0; j < Nx; ++j) r += coefficients[static_cast<std::size_t>(j)] * X.row(j);
    if (stage >= 0) {
      for (int m = 0; m < Nu; ++m) r(stage * Nu + m) += coefficients[static_cast<std::size_t>(Nx + m)];
    }
    r(n) += coefficients[coefficients.size() - 1];
    return r;
  };
  for (int k = 0; k < horizon; ++k) {
    for (const auto& coefficients : p.miss) {
      const Eigen::RowVectorXd r = row(coefficients, k);
      H += r.transpose() * r;
    }
    Eigen::MatrixXd next(Nx, n + 1);
    for (int i = 0; i < Nx; ++i) next.row(i) = row(p.next[static_cast<std::size_t>(i)], k);
    X = next;
    for (int m = 0; m < Nu; ++m) {
      low(k * Nu + m) = p.low[static_cast<std::size_t>(k)][static_cast<std::size_t>(m)];
      high(k * Nu + m) = p.high[static_cast<std::size_t>(k)][static_cast<std::size_t>(m)];
    }
  }
  for (const auto& coefficients : p.end) {
    const Eigen::RowVectorXd r = row(coefficients, -1);
    H += r.transpose() * r;
  }
  return solve_dense_qp(H.topLeftCorner(n, n), H.topRightCorner(n, 1), low, high);
}

}  // namespace chicane::test
