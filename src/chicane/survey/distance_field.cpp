// SPDX-License-Identifier: MIT
#include "chicane/survey/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace chicane::survey {
namespace {

constexpr double kFar = 1e12;  // [cells²]

/// Lower envelope of parabolas: squared distances along one line from those across it.
class Envelope {
 public:
  explicit Envelope(std::size_t most) : from_(most), to_(most), vertex_(most), bound_(most + 1) {}

  std::vector<double>& from() { return from_; }
  const std::vector<double>& measure(std::size_t count) {
    std::size_t top = 0;
    vertex_[0] = 0;
    bound_[0] = -kFar;
    bound_[1] = kFar;
    for (std::size_t q = 1; q < count; ++q) {
      double meets = crossing(q, vertex_[top]);
      while (top > 0 && meets <= bound_[top]) meets = crossing(q, vertex_[--top]);
      if (meets <= bound_[top]) {
        vertex_[top] = q;
        continue;
      }
      vertex_[++top] = q;
      bound_[top] = meets;
      bound_[top + 1] = kFar;
    }
    std::size_t at = 0;
    for (std::size_t q = 0; q < count; ++q) {
      while (bound_[at + 1] < static_cast<double>(q)) ++at;
      const double away = static_cast<double>(q) - static_cast<double>(vertex_[at]);
      to_[q] = std::min(kFar, away * away + from_[vertex_[at]]);
    }
    return to_;
  }

 private:
  [[nodiscard]] double crossing(std::size_t q, std::size_t v) const {
    const double a = static_cast<double>(q), b = static_cast<double>(v);
    return ((from_[q] + a * a) - (from_[v] + b * b)) / (2.0 * (a - b));
  }

  std::vector<double> from_, to_;
  std::vector<std::size_t> vertex_;
  std::vector<double> bound_;
};

}  // namespace

std::vector<float> distance_field(const std::vector<std::uint8_t>& is_set, int width, int height) {
  const auto columns = static_cast<std::size_t>(width);
  const auto rows = static_cast<std::size_t>(height);
  std::vector<float> field(columns * rows);
  // Down the columns by two sweeps, distances in whole cells.
  for (std::size_t x = 0; x < columns; ++x) {
    float away = 1e6F;
    for (std::size_t y = 0; y < rows; ++y) {
      away = is_set[y * columns + x] != 0 ? 0.0F : std::min(away + 1.0F, 1e6F);
      field[y * columns + x] = away;
    }
    for (std::size_t y = rows; y-- > 0;) {
      away = std::min(away + 1.0F, field[y * columns + x]);
      field[y * columns + x] = away;
    }
  }
  Envelope envelope(columns);
  for (std::size_t y = 0; y < rows; ++y) {
    float* const row = field.data() + y * columns;
    for (std::size_t x = 0; x < columns; ++x)
      envelope.from()[x] = static_cast<double>(row[x]) * static_cast<double>(row[x]);
    const std::vector<double>& squares = envelope.measure(columns);
    for (std::size_t x = 0; x < columns; ++x) row[x] = static_cast<float>(std::sqrt(squares[x]));
  }
  return field;
}

}  // namespace chicane::survey
