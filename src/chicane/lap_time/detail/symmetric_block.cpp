// SPDX-License-Identifier: MIT
#include "chicane/lap_time/detail/symmetric_block.hpp"

#include <algorithm>
#include <cmath>

namespace chicane::lap_time {
namespace {

constexpr double kPivotShare = 0.6403882032022076;  // (1 + √17) / 8

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
  const auto take = [&](double* to, const double* from, double share) {
    if (share == 0.0) return;
    for (std::size_t j = 0; j < width; ++j) to[j] -= share * from[j];
  };
  for (int k = 0; k < n_;) {
    const double b_off = off_[static_cast<std::size_t>(k)];
    if (b_off == 0.0) {
      for (int i = k + 1; i < n_; ++i) take(line(i), line(k), row(i)[k]);
      const double inverse = 1.0 / row(k)[k];
      for (std::size_t j = 0; j < width; ++j) line(k)[j] *= inverse;
      ++k;
      continue;
    }
    for (int i = k + 2; i < n_; ++i) {
      take(line(i), line(k), row(i)[k]);
      take(line(i), line(k + 1), row(i)[k + 1]);
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
  for (int k = n_ - 1; k >= 0; --k) {
    const bool is_second = k > 0 && off_[static_cast<std::size_t>(k - 1)] != 0.0;
    for (int i = k + 1; i < n_; ++i) {
      take(line(k), line(i), row(i)[k]);
      if (is_second) take(line(k - 1), line(i), row(i)[k - 1]);
    }
    if (is_second) --k;
  }
  for (int i = 0; i < n_; ++i)
    std::copy_n(line(i), width, b + static_cast<std::size_t>(order_[static_cast<std::size_t>(i)]) * width);
}

}  // namespace chicane::lap_time
