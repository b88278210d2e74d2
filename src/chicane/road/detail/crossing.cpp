// SPDX-License-Identifier: MIT
#include "chicane/road/detail/crossing.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace chicane::road {
namespace {

constexpr std::size_t kMaxPiecesPerCell = 300;

double side(const Vec2& a, const Vec2& b, const Vec2& p) noexcept {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

bool touches(const Vec2& a0, const Vec2& a1, const Vec2& b0, const Vec2& b1) noexcept {
  const Vec2 a_low = min(a0, a1);
  const Vec2 a_high = max(a0, a1);
  const Vec2 b_low = min(b0, b1);
  const Vec2 b_high = max(b0, b1);
  if (b_high.x() < a_low.x() || b_high.y() < a_low.y()) return false;
  if (b_low.x() > a_high.x() || b_low.y() > a_high.y()) return false;
  return side(a0, a1, b0) * side(a0, a1, b1) <= 0.0 && side(b0, b1, a0) * side(b0, b1, a1) <= 0.0;
}

struct Entry {
  std::uint64_t cell = 0;
  std::size_t piece = 0;
};

}  // namespace

std::vector<Crossing> find_crossings(std::span<const Vec2> points, bool closed) {
  const std::size_t n = points.size();
  const std::size_t pieces = closed ? n : n - 1;
  const auto end_of = [&](std::size_t i) -> const Vec2& { return points[i + 1 == n ? 0 : i + 1]; };

  Vec2 low = points[0];
  double width = 0.0;
  for (std::size_t i = 0; i < pieces; ++i) {
    low = min(min(low, points[i]), end_of(i));
    width = std::max(width, (end_of(i) - points[i]).norm());
  }
  if (!(width > 0.0)) return {};
  std::vector<Entry> entries;
  entries.reserve(2 * pieces);
  for (std::size_t i = 0; i < pieces; ++i) {
    const Vec2 from = (min(points[i], end_of(i)) - low) / width;
    const Vec2 to = (max(points[i], end_of(i)) - low) / width;
    for (auto x = static_cast<std::uint64_t>(from.x()); x <= static_cast<std::uint64_t>(to.x()); ++x) {
      for (auto y = static_cast<std::uint64_t>(from.y()); y <= static_cast<std::uint64_t>(to.y()); ++y) {
        entries.push_back({(x << 32U) + y, i});
      }
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.piece < b.piece;
  });

  std::vector<Crossing> found;
  for (std::size_t start = 0, stop = 0; start < entries.size() && found.size() < kMostCrossings;
       start = stop) {
    while (stop < entries.size() && entries[stop].cell == entries[start].cell) ++stop;
    if (stop - start > kMaxPiecesPerCell)
      found.push_back({entries[start].piece, entries[start + kMaxPiecesPerCell].piece, true});
    const std::size_t last = std::min(stop, start + kMaxPiecesPerCell);
    for (std::size_t i = start; i < last; ++i) {
      for (std::size_t j = i + 1; j < last; ++j) {
        const std::size_t a = entries[i].piece;
        const std::size_t b = entries[j].piece;
        const bool are_neighbours = b - a <= 1 || (closed && a == 0 && b + 1 == n);
        if (!are_neighbours && touches(points[a], end_of(a), points[b], end_of(b))) found.push_back({a, b});
      }
    }
  }
  if (found.size() >= kMostCrossings) found.back().is_tangle = true;
  const auto by_place = [](const Crossing& a, const Crossing& b) {
    return a.second != b.second ? a.second < b.second : a.first < b.first;
  };
  const auto is_same = [](const Crossing& a, const Crossing& b) {
    return a.first == b.first && a.second == b.second;
  };
  std::sort(found.begin(), found.end(), by_place);
  found.erase(std::unique(found.begin(), found.end(), is_same), found.end());  // seen from several cells
  return found;
}

}  // namespace chicane::road
