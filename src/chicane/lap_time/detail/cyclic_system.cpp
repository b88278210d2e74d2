// SPDX-License-Identifier: MIT
// Linear system of a ring of nodes: factors each node's block in turn, then solves with refinement.
#include "chicane/lap_time/detail/cyclic_system.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace chicane::lap_time {
namespace {

// Share that decides between pivots of one and two rows: (1 + √17) / 8 bounds the growth (Bunch, Kaufman).
constexpr double kPivotShare = 0.6403882032022076;

}  // namespace

void SymmetricBlock::swap(int i, int j) noexcept {
  if (i == j) return;
  std::swap_ranges(row(i), row(i) + n_, row(j));
  for (int k = 0; k < n_; ++k) std::swap(row(k)[i], row(k)[j]);
  std::swap(order_[static_cast<std::size_t>(i)], order_[static_cast<std::size_t>(j)]);
}

void SymmetricBlock::eliminate_one(int k) noexcept {
  const double* top = row(k);
  negative_ += top[k] < 0.0 ? 1 : 0;
  const double inverse = 1.0 / top[k];
  for (int i = k + 1; i < n_; ++i) {
    double* r = row(i);
    const double share = r[k] * inverse;
    if (share == 0.0) continue;
    for (int j = k + 1; j < n_; ++j) r[j] -= share * top[j];
    r[k] = share;
  }
}

void SymmetricBlock::eliminate_two(int k) noexcept {
  const double* first = row(k);
  const double* second = row(k + 1);
  const double a = first[k];
  const double b = second[k];
  const double c = second[k + 1];
  const double det = a * c - b * b;  // negative for a pivot of this kind: one eigenvalue of each sign
  negative_ += det < 0.0 ? 1 : (a < 0.0 ? 2 : 0);
  off_[static_cast<std::size_t>(k)] = b;
  for (int i = k + 2; i < n_; ++i) {
    double* r = row(i);
    const double x = (c * r[k] - b * r[k + 1]) / det;
    const double y = (a * r[k + 1] - b * r[k]) / det;
    for (int j = k + 2; j < n_; ++j) r[j] -= x * first[j] + y * second[j];
    r[k] = x;
    r[k + 1] = y;
  }
}

bool SymmetricBlock::factor(const double* matrix, int n) {
  n_ = n;
  negative_ = 0;
  a_.assign(matrix, matrix + static_cast<std::ptrdiff_t>(n) * n);
  off_.assign(static_cast<std::size_t>(n), 0.0);
  order_.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) order_[static_cast<std::size_t>(i)] = i;
  for (int k = 0; k < n;) {
    // Choice of the pivot: one row, another row, or two rows.
    const double own = std::fabs(row(k)[k]);
    int far = k;
    double most = 0.0;
    for (int i = k + 1; i < n; ++i) {
      if (const double size = std::fabs(row(i)[k]); size > most) {
        most = size;
        far = i;
      }
    }
    if (!(std::max(own, most) > 0.0) || !std::isfinite(own + most)) return false;
    int steps = 1;
    int take = k;
    if (own < kPivotShare * most) {
      double across = 0.0;
      for (int j = k; j < n; ++j)
        if (j != far) across = std::max(across, std::fabs(row(far)[j]));
      if (own * across < kPivotShare * most * most) {
        take = far;
        if (std::fabs(row(far)[far]) < kPivotShare * across) steps = 2;
      }
    }
    swap(k + steps - 1, take);
    if (steps == 1) {
      eliminate_one(k);
    } else {
      eliminate_two(k);
    }
    k += steps;
  }
  return true;
}

void SymmetricBlock::solve(double* b, int columns) const {
  const auto width = static_cast<std::size_t>(columns);
  work_.resize(static_cast<std::size_t>(n_) * width);
  const auto line = [&](int i) { return work_.data() + static_cast<std::size_t>(i) * width; };
  for (int i = 0; i < n_; ++i)
    std::copy_n(b + static_cast<std::size_t>(order_[static_cast<std::size_t>(i)]) * width, width, line(i));
  const auto subtract = [&](double* to, const double* from, double share) {
    if (share == 0.0) return;
    for (std::size_t j = 0; j < width; ++j) to[j] -= share * from[j];
  };
  // Forward substitution, and division by the pivots.
  for (int k = 0; k < n_;) {
    const double b_off = off_[static_cast<std::size_t>(k)];
    if (b_off == 0.0) {
      for (int i = k + 1; i < n_; ++i) subtract(line(i), line(k), row(i)[k]);
      const double inverse = 1.0 / row(k)[k];
      for (std::size_t j = 0; j < width; ++j) line(k)[j] *= inverse;
      ++k;
      continue;
    }
    for (int i = k + 2; i < n_; ++i) {
      subtract(line(i), line(k), row(i)[k]);
      subtract(line(i), line(k + 1), row(i)[k + 1]);
    }
    const double a = row(k)[k];
    const double c = row(k + 1)[k + 1];
    const double det = a * c - b_off * b_off;
    for (std::size_t j = 0; j < width; ++j) {
      const double x = line(k)[j];
      const double y = line(k + 1)[j];
      line(k)[j] = (c * x - b_off * y) / det;
      line(k + 1)[j] = (a * y - b_off * x) / det;
    }
    k += 2;
  }
  // Backward substitution.
  for (int k = n_ - 1; k >= 0; --k) {
    const bool is_second = k > 0 && off_[static_cast<std::size_t>(k - 1)] != 0.0;
    for (int i = k + 1; i < n_; ++i) {
      subtract(line(k), line(i), row(i)[k]);
      if (is_second) subtract(line(k - 1), line(i), row(i)[k - 1]);
    }
    if (is_second) --k;
  }
  for (int i = 0; i < n_; ++i)
    std::copy_n(line(i), width, b + static_cast<std::size_t>(order_[static_cast<std::size_t>(i)]) * width);
}

CyclicSystem::CyclicSystem(int nodes, int variables, int states, int equations)
    : n_{nodes},
      nz_{variables},
      nx_{states},
      na_{equations},
      nb_{variables + states + equations},
      width_{states + variables},
      diagonal_(index(nodes) * area()),
      coupling_(index(nodes) * states_by_variables()),
      spread_(index(nodes) * index(nb_) * index(width_)),
      blocks_(index(nodes)) {}

// When node k is eliminated it is coupled to λ of the next node (node 0 for the last) through B_k, and to z
// of node 0 through the matrix `border` (variables of node 0 × λ_k), which is B_0ᵀ at first.
bool CyclicSystem::factor() {
  std::vector<double> first(diagonal(0), diagonal(0) + area());
  std::vector<double> now(area());
  std::vector<double> border(states_by_variables());  // nz × nx
  std::vector<double> next_border(states_by_variables());
  std::vector<double> change(index(nx_) * index(nx_), 0.0);  // change of the block of λ_k
  for (int i = 0; i < nz_; ++i)
    for (int j = 0; j < nx_; ++j) border[index(i * nx_ + j)] = coupling(0)[j * nz_ + i];
  int negative = 0;
  for (int k = 1; k < n_; ++k) {
    // The block of node k, with the change by the node before it.
    std::copy_n(diagonal(k), area(), now.begin());
    for (int i = 0; i < nx_; ++i)
      for (int j = 0; j < nx_; ++j) now[index((nz_ + i) * nb_ + nz_ + j)] -= change[index(i * nx_ + j)];
    SymmetricBlock& block = blocks_[index(k)];
    if (!block.factor(now.data(), nb_)) return false;
    negative += block.negative();
    // Y: the inverse of the block times both couplings.
    double* y = spread_.data() + index(k) * index(nb_) * index(width_);
    std::fill_n(y, index(nb_) * index(width_), 0.0);
    for (int i = 0; i < nz_; ++i)
      for (int j = 0; j < nx_; ++j) y[i * width_ + j] = coupling(k)[j * nz_ + i];
    for (int i = 0; i < nx_; ++i)
      for (int j = 0; j < nz_; ++j) y[(nz_ + i) * width_ + nx_ + j] = border[index(j * nx_ + i)];
    block.solve(y, width_);
    // Changes of the remaining rows: those of λ_{k+1} by B_k Y, those of z_0 by borderᵀ Y.
    for (int i = 0; i < nx_; ++i) {
      for (int j = 0; j < nx_; ++j) {
        double sum = 0.0;
        for (int l = 0; l < nz_; ++l) sum += coupling(k)[i * nz_ + l] * y[l * width_ + j];
        change[index(i * nx_ + j)] = sum;
      }
    }
    for (int i = 0; i < nz_; ++i) {
      for (int j = 0; j < width_; ++j) {
        double sum = 0.0;
        for (int l = 0; l < nx_; ++l) sum += border[index(i * nx_ + l)] * y[(nz_ + l) * width_ + j];
        if (j < nx_) {
          next_border[index(i * nx_ + j)] = -sum;
        } else {
          first[index(i * nb_ + j - nx_)] -= sum;
        }
      }
    }
    border.swap(next_border);
  }
  // The block of node 0, with the changes by all others.
  for (int i = 0; i < nx_; ++i)
    for (int j = 0; j < nx_; ++j) first[index((nz_ + i) * nb_ + nz_ + j)] -= change[index(i * nx_ + j)];
  for (int i = 0; i < nz_; ++i) {
    for (int j = 0; j < nx_; ++j) {
      first[index(i * nb_ + nz_ + j)] += border[index(i * nx_ + j)];
      first[index((nz_ + j) * nb_ + i)] += border[index(i * nx_ + j)];
    }
  }
  if (!blocks_[0].factor(first.data(), nb_)) return false;
  negative += blocks_[0].negative();
  return negative == n_ * (nx_ + na_);
}

void CyclicSystem::solve_once(std::vector<double>& b) const {
  const auto block = [&](int k) { return b.data() + index(k) * index(nb_); };
  const auto spread = [&](int k) { return spread_.data() + index(k) * index(nb_) * index(width_); };
  for (int k = 1; k < n_; ++k) {
    const double* y = spread(k);
    double* next = block(k + 1 < n_ ? k + 1 : 0);
    for (int i = 0; i < nb_; ++i) {
      const double value = block(k)[i];
      for (int j = 0; j < nx_; ++j) next[nz_ + j] -= y[i * width_ + j] * value;
      for (int j = 0; j < nz_; ++j) block(0)[j] -= y[i * width_ + nx_ + j] * value;
    }
    blocks_[index(k)].solve(block(k), 1);
  }
  blocks_[0].solve(block(0), 1);
  std::vector<double> known(index(width_));  // λ of the next node, z of node 0
  std::copy_n(block(0), nz_, known.begin() + nx_);
  for (int k = n_ - 1; k > 0; --k) {
    std::copy_n(block(k + 1 < n_ ? k + 1 : 0) + nz_, nx_, known.begin());
    for (int i = 0; i < nb_; ++i)
      block(k)[i] -= std::inner_product(known.begin(), known.end(), spread(k) + i * width_, 0.0);
  }
}

void CyclicSystem::subtract_product(const std::vector<double>& x, std::vector<double>& rest) const {
  for (int k = 0; k < n_; ++k) {
    const double* matrix = diagonal_.data() + index(k) * area();
    const double* b = coupling_.data() + index(k) * states_by_variables();
    const double* own = x.data() + index(k) * index(nb_);
    const int other = k + 1 < n_ ? k + 1 : 0;
    const double* next = x.data() + index(other) * index(nb_);
    double* to = rest.data() + index(k) * index(nb_);
    double* to_next = rest.data() + index(other) * index(nb_);
    for (int i = 0; i < nb_; ++i)
      for (int j = 0; j < nb_; ++j) to[i] -= matrix[i * nb_ + j] * own[j];
    for (int i = 0; i < nx_; ++i) {
      for (int j = 0; j < nz_; ++j) {
        to_next[nz_ + i] -= b[i * nz_ + j] * own[j];
        to[j] -= b[i * nz_ + j] * next[nz_ + i];
      }
    }
  }
}

void CyclicSystem::solve(std::vector<double>& b) const {
  constexpr int kRefinements = 2;  // chosen: the shift of the equations costs digits
  const std::vector<double> wanted = b;
  solve_once(b);
  for (int i = 0; i < kRefinements; ++i) {
    std::vector<double> rest = wanted;
    subtract_product(b, rest);
    solve_once(rest);
    for (std::size_t j = 0; j < b.size(); ++j) b[j] += rest[j];
  }
}

}  // namespace chicane::lap_time
