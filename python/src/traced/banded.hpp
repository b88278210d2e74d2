// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace chicane::python {

/// An entry of a sparse matrix; entries at the same place add up.
struct BandEntry {
  std::int32_t row = 0;
  std::int32_t column = 0;
  double value = 0.0;
};

/// Solves A X = B by Gaussian elimination with row pivoting inside the band that the entries of A (n × n)
/// span: O(n · band²). B comes and X goes in `right`, (n, count) row by row. Returns whether A is regular.
[[nodiscard]] bool solve_banded(std::size_t n, std::span<const BandEntry> entries, std::span<double> right);

}  // namespace chicane::python
