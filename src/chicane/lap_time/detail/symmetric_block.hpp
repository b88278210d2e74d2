// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace chicane::lap_time {

/// P A Pᵀ = L D Lᵀ of a dense symmetric matrix that need not be definite, with pivots of one or two rows
/// (Bunch, Kaufman 1977). Its pivots tell how many eigenvalues are negative (Sylvester).
class SymmetricBlock {
 public:
  /// Both triangles of A by rows, n × n. False for a singular one.
  [[nodiscard]] bool factor(const double* matrix, int n);
  [[nodiscard]] int negative() const noexcept { return negative_; }
  /// Solves A X = B in place; B has n rows of `columns` numbers.
  void solve(double* b, int columns) const;

 private:
  [[nodiscard]] double* row(int i) noexcept { return a_.data() + static_cast<std::ptrdiff_t>(i) * n_; }
  [[nodiscard]] const double* row(int i) const noexcept {
    return a_.data() + static_cast<std::ptrdiff_t>(i) * n_;
  }
  void swap(int i, int j) noexcept;
  void eliminate_one(int k) noexcept;
  void eliminate_two(int k) noexcept;

  int n_ = 0;
  int negative_ = 0;
  std::vector<double> a_;    ///< L below the diagonal, D on it
  std::vector<double> off_;  ///< of D: entry (k + 1, k) of a pivot of two rows, else 0
  std::vector<int> order_;   ///< row of A that stands in row i
  mutable std::vector<double> work_;
};

}  // namespace chicane::lap_time
