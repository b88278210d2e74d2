// SPDX-License-Identifier: MIT
#include "chicane/road/corners.hpp"

#include <algorithm>
#include <cmath>

namespace chicane::road {
namespace {

constexpr double kSpacing = 2.0;                 // between samples [m]
constexpr int kHalfWindow = 3;                   // samples on each side that the curvature is averaged with
constexpr double kLeastCurvature = 1.0 / 220.0;  // a larger radius is straight at racing speed [1/m]
constexpr double kSameCorner = 20.0;             // straight between bends of one corner, at most [m]
constexpr double kLeastTurn = 0.3;               // [rad]
constexpr double kNarrowest = 6.0;               // road in full size [m]

/// Over a road in full size.
double size_of(const Track& track) {
  constexpr int kSamples = 64;
  double width = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double s = track.length() * i / kSamples;
    width += (track.left_width(s) + track.right_width(s)) / kSamples;
  }
  return std::min(width / kNarrowest, 1.0);
}

/// Mean curvature of a line at equal distances [1/m].
struct Bends {
  double spacing = 0.0;  ///< [m]
  int count = 0;
  bool is_closed = false;
  std::vector<double> curvature{};

  [[nodiscard]] double at(int i) const {
    if (is_closed) return curvature[static_cast<std::size_t>(((i % count) + count) % count)];
    return i < 0 || i >= count ? 0.0 : curvature[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] double place(int i) const { return is_closed ? (i % count) * spacing : i * spacing; }
};

Bends bends_of(const Path& line, double size) {
  Bends bends{.is_closed = line.is_closed()};
  bends.count = static_cast<int>(std::lround(line.length() / (kSpacing * size)));
  if (bends.count <= 2 * kHalfWindow + 1) return {};
  bends.spacing = line.length() / bends.count;
  bends.curvature.resize(static_cast<std::size_t>(bends.count));
  for (int i = 0; i < bends.count; ++i) {
    const double from = (i - kHalfWindow) * bends.spacing, to = (i + kHalfWindow + 1) * bends.spacing;
    bends.curvature[static_cast<std::size_t>(i)] =
        (line.at(to).heading - line.at(from).heading) / (to - from);
  }
  return bends;
}

}  // namespace

std::vector<Corner> corners_of(const Track& track) {
  const double size = size_of(track);
  const Bends bends = bends_of(track.centre(), size);
  const auto side = [&](int i) {
    const double curvature = size * bends.at(i);
    return std::fabs(curvature) < kLeastCurvature ? 0 : curvature > 0.0 ? 1 : -1;
  };
  // Begins where the road is straight or changes its side, so that no corner is cut in two.
  int first = 0;
  while (bends.is_closed && first < bends.count && side(first) != 0 && side(first - 1) == side(first))
    ++first;
  if (first == bends.count) return {};

  struct Bend {
    int from, to, side;
  };
  std::vector<Bend> found;
  for (int i = first; i < first + bends.count; ++i) {
    if (side(i) == 0) continue;
    const bool goes_on = !found.empty() && found.back().side == side(i) &&
                         (i - found.back().to) * bends.spacing < kSameCorner * size;
    if (goes_on) {
      found.back().to = i + 1;
    } else {
      found.push_back({i, i + 1, side(i)});
    }
  }

  std::vector<Corner> corners;
  for (const Bend& bend : found) {
    int apex = bend.from;
    double turn = 0.0;
    for (int i = bend.from; i < bend.to; ++i) {
      turn += bends.at(i) * bends.spacing;
      if (std::fabs(bends.at(i)) > std::fabs(bends.at(apex))) apex = i;
    }
    if (std::fabs(turn) < kLeastTurn) continue;
    corners.push_back({bends.place(bend.from), bends.place(apex), bends.place(bend.to), turn});
  }
  const auto from_start = [&](const Corner& corner) {
    const double s = corner.apex - track.start_s();
    return track.centre().is_closed() && s < 0.0 ? s + track.length() : s;
  };
  std::sort(corners.begin(), corners.end(),
            [&](const Corner& a, const Corner& b) { return from_start(a) < from_start(b); });
  if (!track.centre().is_closed()) {
    std::erase_if(corners, [&](const Corner& each) {
      return from_start(each) < 0.0 || from_start(each) > track.lap_length();
    });
  }
  if (corners.size() > kMostCorners) corners.resize(kMostCorners);
  return corners;
}

std::vector<double> corner_sectors(const Track& track, const std::vector<Corner>& corners) {
  const double round = track.centre().is_closed() ? track.length() : 0.0;
  const auto ahead = [&](double s, double of) { return s < of ? s - of + round : s - of; };
  std::vector<double> ends;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Corner& here = corners[i];
    const Corner& next = corners[i + 1];
    const double to_end = ahead(here.end, here.apex);
    const double straight = ahead(next.apex, here.apex) - to_end - ahead(next.apex, next.begin);
    ends.push_back(ahead(here.apex, track.start_s()) + to_end + 0.5 * straight);
  }
  if (!corners.empty()) ends.push_back(track.lap_length());
  return ends;
}

}  // namespace chicane::road
