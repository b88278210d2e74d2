// SPDX-License-Identifier: MIT
#include "traced/banded.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace chicane::python {
namespace {

/// Pivots below this share of the largest entry count as zero.
constexpr double kSingular = 1e-15;

/// A matrix by rows, each from `lower` entries before the diagonal to `upper` behind it. Pivoting moves
/// entries up by `lower` rows at most: `upper` has room for that.
struct Band {
  std::size_t n, lower, upper;
  std::vector<double> numbers = std::vector<double>(n * width(), 0.0);

  [[nodiscard]] std::size_t width() const { return lower + upper + 1; }
  /// Pre: column within the band of the row.
  [[nodiscard]] double& at(std::size_t row, std::size_t column) {
    return numbers[row * width() + lower + column - row];
  }
};

Band band_of(std::size_t n, std::span<const BandEntry> entries) {
  std::int32_t lower = 0, upper = 0;
  for (const BandEntry& entry : entries) {
    lower = std::max(lower, entry.row - entry.column);
    upper = std::max(upper, entry.column - entry.row);
  }
  Band band{n, static_cast<std::size_t>(lower), static_cast<std::size_t>(lower + upper)};
  for (const BandEntry& entry : entries)
    band.at(static_cast<std::size_t>(entry.row), static_cast<std::size_t>(entry.column)) += entry.value;
  return band;
}

}  // namespace

bool solve_banded(std::size_t n, std::span<const BandEntry> entries, std::span<double> right) {
  Band a = band_of(n, entries);
  const std::size_t count = n > 0 ? right.size() / n : 0;
  double largest = 0.0;
  for (const double number : a.numbers) largest = std::max(largest, std::fabs(number));
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t last_row = std::min(n - 1, k + a.lower);
    const std::size_t last_column = std::min(n - 1, k + a.upper);
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i <= last_row; ++i) {
      if (std::fabs(a.at(i, k)) > std::fabs(a.at(pivot, k))) pivot = i;
    }
    if (!(std::fabs(a.at(pivot, k)) > kSingular * largest)) return false;
    if (pivot != k) {
      std::swap_ranges(&a.at(k, k), &a.at(k, k) + (last_column - k + 1), &a.at(pivot, k));
      std::swap_ranges(&right[k * count], &right[k * count] + count, &right[pivot * count]);
    }
    const double* const from = &a.at(k, k);
    for (std::size_t i = k + 1; i <= last_row; ++i) {
      double* const to = &a.at(i, k);
      const double share = to[0] / from[0];
      if (share == 0.0) continue;
      for (std::size_t j = 0; j <= last_column - k; ++j) to[j] -= share * from[j];
      for (std::size_t c = 0; c < count; ++c) right[i * count + c] -= share * right[k * count + c];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    const std::size_t last_column = std::min(n - 1, k + a.upper);
    for (std::size_t c = 0; c < count; ++c) {
      double value = right[k * count + c];
      for (std::size_t j = k + 1; j <= last_column; ++j) value -= a.at(k, j) * right[j * count + c];
      right[k * count + c] = value / a.at(k, k);
    }
  }
  return true;
}

}  // namespace chicane::python
