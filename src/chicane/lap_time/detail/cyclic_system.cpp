// SPDX-License-Identifier: MIT
#include "chicane/lap_time/detail/cyclic_system.hpp"

#include <algorithm>
#include <numeric>

namespace chicane::lap_time {

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

// Couplings of node k when its turn comes: to λ of the next node (node 0 for the last) through B_k, to z of
// node 0 through a matrix `border` (variables of node 0 × λ_k), which starts as B_0ᵀ and is passed on.
bool CyclicSystem::factor() {
  std::vector<double> first(diagonal(0), diagonal(0) + area());
  std::vector<double> now(area());
  std::vector<double> border(states_by_variables());  // nz × nx
  std::vector<double> next_border(states_by_variables());
  std::vector<double> change(index(nx_) * index(nx_), 0.0);  // of the block of λ_k
  for (int i = 0; i < nz_; ++i)
    for (int j = 0; j < nx_; ++j) border[index(i * nx_ + j)] = coupling(0)[j * nz_ + i];
  int negative = 0;
  for (int k = 1; k < n_; ++k) {
    std::copy_n(diagonal(k), area(), now.begin());
    for (int i = 0; i < nx_; ++i)
      for (int j = 0; j < nx_; ++j) now[index((nz_ + i) * nb_ + nz_ + j)] -= change[index(i * nx_ + j)];
    SymmetricBlock& block = blocks_[index(k)];
    if (!block.factor(now.data(), nb_)) return false;
    negative += block.negative();
    double* y = spread_.data() + index(k) * index(nb_) * index(width_);
    std::fill_n(y, index(nb_) * index(width_), 0.0);
    for (int i = 0; i < nz_; ++i)
      for (int j = 0; j < nx_; ++j) y[i * width_ + j] = coupling(k)[j * nz_ + i];
    for (int i = 0; i < nx_; ++i)
      for (int j = 0; j < nz_; ++j) y[(nz_ + i) * width_ + nx_ + j] = border[index(j * nx_ + i)];
    block.solve(y, width_);
    // B_k Y: rows of λ_{k+1}. borderᵀ Y: rows of z_0.
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
  constexpr int kRefinements = 2;
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
