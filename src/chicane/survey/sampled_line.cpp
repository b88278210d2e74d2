// SPDX-License-Identifier: MIT
#include "chicane/survey/sampled_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace chicane::survey {

double length_of(std::span<const Vec2> line, bool closed) noexcept {
  double length = closed && !line.empty() ? (line.front() - line.back()).norm() : 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

std::vector<Vec2> sampled(std::span<const Vec2> line, bool closed, double spacing) {
  constexpr double kMost = 1e6;
  const double length = length_of(line, closed);
  const auto count = static_cast<std::size_t>(std::clamp(std::round(length / spacing), 2.0, kMost));
  const double step = length / static_cast<double>(count);
  std::vector<Vec2> points;
  points.reserve(count + 1);
  double passed = 0.0;
  const std::size_t segments = closed ? line.size() : line.size() - 1;
  for (std::size_t i = 0; i < segments && points.size() < count; ++i) {
    const Vec2& a = line[i];
    const Vec2& b = line[(i + 1) % line.size()];
    const double segment = (b - a).norm();
    while (points.size() < count && step * static_cast<double>(points.size()) <= passed + segment) {
      const double share =
          segment > 0.0 ? (step * static_cast<double>(points.size()) - passed) / segment : 0.0;
      points.push_back(a + share * (b - a));
    }
    passed += segment;
  }
  if (!closed) points.push_back(line.back());
  return points;
}

double turned_area(std::span<const Vec2> line) noexcept {
  double area = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec2 a = line[i] - line[0];
    const Vec2 b = line[(i + 1) % line.size()] - line[0];
    area += a.x() * b.y() - a.y() * b.x();
  }
  return area;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace chicane::survey
