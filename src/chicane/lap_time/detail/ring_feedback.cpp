// SPDX-License-Identifier: MIT
#include "chicane/lap_time/detail/ring_feedback.hpp"

#include <cmath>
#include <utility>

namespace chicane::lap_time {
namespace {

using Matrix = std::vector<double>;  // by rows

/// X = A⁻¹ B with A n × n and B n × m, by elimination with row pivots; both are used up.
Matrix solved(Matrix a, Matrix b, std::size_t n, std::size_t m) {
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t top = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::fabs(a[i * n + k]) > std::fabs(a[top * n + k])) top = i;
    for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[top * n + j]);
    for (std::size_t j = 0; j < m; ++j) std::swap(b[k * m + j], b[top * m + j]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double share = a[i * n + k] / a[k * n + k];
      if (share == 0.0) continue;
      for (std::size_t j = k; j < n; ++j) a[i * n + j] -= share * a[k * n + j];
      for (std::size_t j = 0; j < m; ++j) b[i * m + j] -= share * b[k * m + j];
    }
  }
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < m; ++j) b[k * m + j] /= a[k * n + k];
  return b;
}

/// Derivatives of the driven states' rates by these states and the two inputs: n rows of n + 2, the
/// equations' own variables eliminated.
Matrix reduced_slopes(const LimitModel& model, std::size_t node, const double* z) {
  const NodeFunctions& f = model.functions();
  const auto variables = static_cast<std::size_t>(f.variables);
  const auto count = static_cast<std::size_t>(f.functions());
  const auto states = static_cast<std::size_t>(f.states);
  const auto equations = static_cast<std::size_t>(f.equations);
  const auto n = static_cast<std::size_t>(model.driven());
  const auto input = static_cast<std::size_t>(model.input());
  std::vector<double> out(count);
  std::vector<double> slope(count * variables);
  std::vector<double> hessian(variables * (variables + 1) / 2);
  const std::vector<double> none(count, 0.0);
  f.derivatives(static_cast<int>(node), z, none.data(), out.data(), slope.data(), hessian.data());
  const std::size_t own = variables - equations;
  const auto column = [&](std::size_t j) { return j < n ? j : input + j - n; };
  Matrix follow;
  if (equations > 0) {  // δ own = −(∂e/∂own)⁻¹ ∂e/∂(x, u)
    Matrix by_own(equations * equations);
    Matrix by_rest(equations * (n + 2));
    for (std::size_t i = 0; i < equations; ++i) {
      for (std::size_t j = 0; j < equations; ++j)
        by_own[i * equations + j] = slope[(states + i) * variables + own + j];
      for (std::size_t j = 0; j < n + 2; ++j)
        by_rest[i * (n + 2) + j] = -slope[(states + i) * variables + column(j)];
    }
    follow = solved(std::move(by_own), std::move(by_rest), equations, n + 2);
  }
  Matrix result(n * (n + 2));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n + 2; ++j) {
      double sum = slope[i * variables + column(j)];
      for (std::size_t e = 0; e < equations; ++e)
        sum += slope[i * variables + own + e] * follow[e * (n + 2) + j];
      result[i * (n + 2) + j] = sum;
    }
  }
  return result;
}

}  // namespace

RingFeedback::RingFeedback(const LimitModel& model, const RoadNodes& road, const std::vector<double>& z,
                           const Tuning& tuning)
    : driven_{model.driven()} {
  const auto n = static_cast<std::size_t>(driven_);
  const auto variables = static_cast<std::size_t>(model.functions().variables);
  const std::size_t nodes = road.s.size();
  const std::size_t m = n + 2;
  std::vector<Matrix> slopes(nodes);
  for (std::size_t k = 0; k < nodes; ++k) slopes[k] = reduced_slopes(model, k, z.data() + k * variables);
  const std::vector<double> error = model.error_weights();
  gains_.resize(nodes * 2 * n);
  Matrix p(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) p[i * n + i] = error[i];
  constexpr std::size_t kRounds = 2;  // so that the end is forgotten
  for (std::size_t turn = kRounds * nodes; turn-- > 0;) {
    const std::size_t k = turn % nodes;
    const std::size_t next = (k + 1) % nodes;
    const double h = road.step[k];
    std::array<double, 2> weight = tuning.inputs;
    if (model.is_spent(z.data() + k * variables)) weight[1] *= tuning.spent;
    // x⁺ = A x + B u by the trapezoidal rule with the input held.
    Matrix left(n * n);
    Matrix right(n * m);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        left[i * n + j] = (i == j ? 1.0 : 0.0) - 0.5 * h * slopes[next][i * m + j];
        right[i * m + j] = (i == j ? 1.0 : 0.0) + 0.5 * h * slopes[k][i * m + j];
      }
      for (std::size_t j = n; j < m; ++j)
        right[i * m + j] = 0.5 * h * (slopes[k][i * m + j] + slopes[next][i * m + j]);
    }
    const Matrix f = solved(std::move(left), std::move(right), n, m);
    Matrix pf(n * m, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t l = 0; l < n; ++l)
        for (std::size_t j = 0; j < m; ++j) pf[i * m + j] += p[i * n + l] * f[l * m + j];
    Matrix q(m * m, 0.0);
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t l = 0; l < n; ++l)
        for (std::size_t j = 0; j < m; ++j) q[i * m + j] += f[l * m + i] * pf[l * m + j];
    const double dt = h * std::max(1e-3, 1.0 / z[k * variables + kVx]);
    for (std::size_t i = 0; i < n; ++i) q[i * m + i] += dt * error[i];
    for (std::size_t i = 0; i < 2; ++i) q[(n + i) * m + n + i] += dt * weight[i];
    const double a = q[n * m + n];
    const double b = q[n * m + n + 1];
    const double c = q[(n + 1) * m + n + 1];
    const double det = a * c - b * b;
    double* gain = gains_.data() + k * 2 * n;
    for (std::size_t j = 0; j < n; ++j) {
      gain[j] = (c * q[n * m + j] - b * q[(n + 1) * m + j]) / det;
      gain[n + j] = (a * q[(n + 1) * m + j] - b * q[n * m + j]) / det;
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        p[i * n + j] = q[i * m + j] - q[n * m + i] * gain[j] - q[(n + 1) * m + i] * gain[n + j];
    // What rounding makes of a symmetric matrix would grow from node to node.
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) p[i * n + j] = p[j * n + i] = 0.5 * (p[i * n + j] + p[j * n + i]);
  }
}

}  // namespace chicane::lap_time
