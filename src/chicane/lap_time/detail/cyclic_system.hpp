// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace chicane::lap_time {

/// Factorisation P A Pᵀ = L D Lᵀ of a dense symmetric matrix, which may be indefinite, with pivots of one or
/// two rows (Bunch, Kaufman 1977). The pivots give the number of negative eigenvalues (Sylvester).
class SymmetricBlock {
 public:
  /// Factors A, given with both triangles by rows, n × n. False if it is singular.
  [[nodiscard]] bool factor(const double* matrix, int n);
  /// Number of negative eigenvalues.
  [[nodiscard]] int negative() const noexcept { return negative_; }
  /// Solves A X = B in place; B has n rows of `columns` numbers.
  void solve(double* b, int columns) const;

 private:
  [[nodiscard]] double* row(int i) noexcept { return a_.data() + static_cast<std::ptrdiff_t>(i) * n_; }
  [[nodiscard]] const double* row(int i) const noexcept {
    return a_.data() + static_cast<std::ptrdiff_t>(i) * n_;
  }
  /// Swaps rows and columns i and j.
  void swap(int i, int j) noexcept;
  /// Eliminates row k by a pivot of one row.
  void eliminate_one(int k) noexcept;
  /// Eliminates rows k and k + 1 by a pivot of two rows.
  void eliminate_two(int k) noexcept;

  int n_ = 0;                         ///< rows
  int negative_ = 0;                  ///< negative()
  std::vector<double> a_;             ///< L below the diagonal, D on it
  std::vector<double> off_;           ///< lower entries of D: (k + 1, k) in a pivot of two rows, else 0
  std::vector<int> order_;            ///< row of A that became row i
  mutable std::vector<double> work_;  ///< workspace of solve()
};

/// Symmetric linear system of a ring of nodes (docs/limit.md, section 3). Node k has unknowns b_k = (z_k,
/// λ_k, η_k): its variables, the multipliers of the interval that ends at it, and those of its own equations.
/// Matrix: dense blocks on the diagonal, and B_k = ∂(interval from k to k + 1)/∂z_k between λ_{k+1} and z_k,
/// cyclic. Nodes 1 … N−1 are eliminated in turn; what remains is the system of node 0.
class CyclicSystem {
 public:
  CyclicSystem(int nodes, int variables, int states, int equations);

  [[nodiscard]] int block_size() const noexcept { return nb_; }
  /// Block of node k, to be filled before factor(): both triangles, by rows; and B_k, states × variables.
  [[nodiscard]] double* diagonal(int k) noexcept { return diagonal_.data() + index(k) * area(); }
  [[nodiscard]] double* coupling(int k) noexcept {
    return coupling_.data() + index(k) * states_by_variables();
  }

  /// Factors the matrix. False if singular, or if the number of negative eigenvalues differs from the number
  /// of multipliers: the Hessian is then not positive definite on the equations.
  [[nodiscard]] bool factor();
  /// Solves in place, with refinement; b holds the blocks one after the other.
  void solve(std::vector<double>& b) const;

 private:
  [[nodiscard]] static std::size_t index(int k) noexcept { return static_cast<std::size_t>(k); }
  [[nodiscard]] std::size_t area() const noexcept { return index(nb_) * index(nb_); }
  [[nodiscard]] std::size_t states_by_variables() const noexcept { return index(nx_) * index(nz_); }
  /// Solves in place, without refinement.
  void solve_once(std::vector<double>& b) const;
  /// Subtracts the matrix times x from `rest`.
  void subtract_product(const std::vector<double>& x, std::vector<double>& rest) const;

  int n_, nz_, nx_, na_, nb_;  ///< nodes; variables, states, equations and unknowns of a node
  int width_;                  ///< columns of an eliminated node's fill-in: λ of the next node, z of node 0
  std::vector<double> diagonal_, coupling_;  ///< blocks of all nodes
  std::vector<double> spread_;               ///< D_k⁻¹ times both couplings, n × nb × width
  std::vector<SymmetricBlock> blocks_;       ///< factors of the eliminated blocks
};

}  // namespace chicane::lap_time
