// SPDX-License-Identifier: MIT
#include "import_preview.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/protocol/occupancy_map.hpp"
#include "chicane/survey/image.hpp"

namespace chicane::apps {
namespace {

using survey::Colour;

constexpr int kLongest = 1400;  // side of the picture [px]
constexpr int kMargin = 20;     // [px]
constexpr Colour kGround{255, 255, 255}, kPoint{170, 170, 170}, kEdge{20, 20, 20}, kLine{200, 30, 30},
    kStart{0, 140, 60}, kFree{225, 232, 240}, kWall{90, 90, 90}, kUnknown{200, 200, 200};

/// Where places of W are in the picture, north up.
struct View {
  Vec2 low{}, high{};
  double scale = 1.0;  ///< [px/m]

  static View round(const Vec2& low, const Vec2& high) {
    const double extent = std::max({high.x() - low.x(), high.y() - low.y(), 1e-3});
    return {low, high, (kLongest - 2.0 * kMargin) / extent};
  }
  [[nodiscard]] int width() const { return 2 * kMargin + 1 + static_cast<int>(scale * (high.x() - low.x())); }
  [[nodiscard]] int height() const {
    return 2 * kMargin + 1 + static_cast<int>(scale * (high.y() - low.y()));
  }
  [[nodiscard]] Vec2 at(const Vec2& place) const {
    return {kMargin + scale * (place.x() - low.x()), kMargin + scale * (high.y() - place.y())};
  }
  [[nodiscard]] Vec2 place(int x, int y) const {
    return {low.x() + (x + 0.5 - kMargin) / scale, high.y() - (y + 0.5 - kMargin) / scale};
  }
};

void draw_map(const protocol::OccupancyMap& map, const View& view, survey::Picture& picture) {
  const survey::FreeSpace space{.width = map.image.width,
                                .height = map.image.height,
                                .resolution = map.resolution,
                                .origin = map.origin,
                                .yaw = map.yaw};
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const Vec2 cell = space.to_cells(view.place(x, y));
      const int column = static_cast<int>(std::floor(cell.x())), row = static_cast<int>(std::floor(cell.y()));
      if (column < 0 || row < 0 || column >= space.width || row >= space.height) continue;
      const double dark = map.darkness(column, space.height - 1 - row);
      picture.set(x, y,
                  dark > map.occupied                                                  ? kWall
                  : dark < map.free && !map.is_unknown(column, space.height - 1 - row) ? kFree
                                                                                       : kUnknown);
    }
}

void draw(const std::vector<Vec2>& line, bool is_closed, const View& view, survey::Picture& picture,
          Colour colour, int thickness) {
  for (std::size_t i = is_closed ? 0 : 1; i < line.size(); ++i) {
    const Vec2 a = view.at(line[i == 0 ? line.size() - 1 : i - 1]), b = view.at(line[i]);
    picture.draw_line(a.x(), a.y(), b.x(), b.y(), colour, thickness);
  }
}

}  // namespace

std::string preview_of(const road::Track& track, const protocol::TrackFile& content) {
  const bool is_closed = track.centre().is_closed();
  std::vector<Vec2> line, left, right;
  constexpr int kSteps = 2000;
  for (int i = 0; i <= (is_closed ? kSteps - 1 : kSteps); ++i) {
    const double s = track.length() * i / kSteps;
    const auto at = track.centre().at(s);
    const Vec2 normal{-sin(at.heading), cos(at.heading)};
    line.push_back(at.position);
    left.push_back(at.position + track.left_width(s) * normal);
    right.push_back(at.position - track.right_width(s) * normal);
  }
  Vec2 low = line.front(), high = low;
  for (const std::vector<Vec2>* each : {&left, &right})
    for (const Vec2& place : *each) {
      low = min(low, place);
      high = max(high, place);
    }
  const double margin = 0.05 * std::max(high.x() - low.x(), high.y() - low.y());
  const View view = View::round(low - Vec2{margin, margin}, high + Vec2{margin, margin});
  survey::Picture picture(std::min(view.width(), 2 * kLongest), std::min(view.height(), 2 * kLongest),
                          kGround);
  if (const auto map = protocol::read_map(content.file)) draw_map(*map, view, picture);
  for (const road::TrackPoint& point : content.points) {
    const Vec2 at = view.at(point.position);
    picture.draw_line(at.x() - 1.0, at.y(), at.x() + 1.0, at.y(), kPoint, 2);
  }
  draw(left, is_closed, view, picture, kEdge, 2);
  draw(right, is_closed, view, picture, kEdge, 2);
  draw(line, is_closed, view, picture, kLine, 2);
  // The start line, and an arrow in the direction of driving.
  const auto start = track.centre().at(track.start_s());
  const Vec2 along{cos(start.heading), sin(start.heading)}, across{-along.y(), along.x()};
  const double width = track.left_width(track.start_s()) + track.right_width(track.start_s());
  draw({start.position + track.left_width(track.start_s()) * across,
        start.position - track.right_width(track.start_s()) * across},
       false, view, picture, kStart, 3);
  const double reach = std::max(width, 40.0 / view.scale);
  const Vec2 tip = start.position + reach * along;
  draw({start.position, tip}, false, view, picture, kStart, 3);
  draw({tip - 0.3 * reach * (along - 0.6 * across), tip, tip - 0.3 * reach * (along + 0.6 * across)}, false,
       view, picture, kStart, 3);
  return picture.png();
}

}  // namespace chicane::apps
