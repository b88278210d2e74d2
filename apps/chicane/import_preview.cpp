// SPDX-License-Identifier: MIT
#include "import_preview.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/protocol/occupancy_map.hpp"
#include "chicane/protocol/report_document.hpp"

namespace chicane::apps {
namespace {

using protocol::ReportDocument;

constexpr int kSteps = 800;                // along the road
constexpr double kCells = 500.0;           // along the longer side of a map
constexpr std::size_t kMostPoints = 4000;  // points of a file drawn at most

/// State of a place on a map.
enum Place { kWall, kFree, kUnknown, kOutside };

Place place_in(const protocol::OccupancyMap& map, const survey::FreeSpace& space, const Vec2& at) {
  const Vec2 cell = space.to_cells(at);
  const int column = static_cast<int>(std::floor(cell.x())), row = static_cast<int>(std::floor(cell.y()));
  if (column < 0 || row < 0 || column >= space.width || row >= space.height) return kOutside;
  const int y = space.height - 1 - row;
  const double dark = map.darkness(column, y);
  if (dark > map.occupied) return kWall;
  return dark < map.free && !map.is_unknown(column, y) ? kFree : kUnknown;
}

/// The map between two corners, as rectangles one step high.
void add_map(ReportDocument& document, const protocol::OccupancyMap& map, const Vec2& low, const Vec2& high) {
  const survey::FreeSpace space{.width = map.image.width,
                                .height = map.image.height,
                                .resolution = map.resolution,
                                .origin = map.origin,
                                .yaw = map.yaw};
  const double step = std::max(map.resolution, std::max(high.x() - low.x(), high.y() - low.y()) / kCells);
  const int width = static_cast<int>((high.x() - low.x()) / step);
  std::array<std::vector<double>, kOutside> cells;
  for (double y = low.y(); y < high.y(); y += step)
    for (int from = 0, to = 0; from < width; from = to) {
      const auto place = [&](int x) {
        return place_in(map, space, Vec2{low.x() + (x + 0.5) * step, y + 0.5 * step});
      };
      const Place here = place(from);
      for (to = from + 1; to < width && place(to) == here;) ++to;
      if (here != kOutside)
        cells[here].insert(cells[here].end(), {low.x() + from * step, y, (to - from) * step, step});
    }
  document.add_series("cells", "faint", "unknown", cells[kUnknown]);
  document.add_series("cells", "paper", "free", cells[kFree]);
  document.add_series("cells", "soft", "wall", cells[kWall]);
}

std::vector<double> numbers_of(const std::vector<Vec2>& places) {
  std::vector<double> numbers;
  for (const Vec2& place : places) numbers.insert(numbers.end(), {place.x(), place.y()});
  return numbers;
}

/// The start line, and an arrow in the direction of driving; `extent` of the road [m].
void add_start(ReportDocument& document, const road::Track& track, double extent) {
  const auto start = track.centre().at(track.start_s());
  const double left = track.left_width(track.start_s()), right = track.right_width(track.start_s());
  const Vec2 along{cos(start.heading), sin(start.heading)}, across{-along.y(), along.x()};
  const double reach = std::max(left + right, 0.03 * extent);
  const Vec2 tip = start.position + reach * along;
  document.add_series("line", "good", "start",
                      numbers_of({start.position + left * across, start.position - right * across}));
  document.add_series("line", "good", "", numbers_of({start.position, tip}));
  document.add_series("line", "good", "",
                      numbers_of({tip - 0.3 * reach * (along - 0.6 * across), tip,
                                  tip - 0.3 * reach * (along + 0.6 * across)}));
}

}  // namespace

std::string preview_of(const road::Track& track, const protocol::TrackFile& content,
                       const std::string& words) {
  std::vector<Vec2> line, left, right, points;
  for (int i = 0; i <= kSteps; ++i) {
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
  const double extent = std::max(high.x() - low.x(), high.y() - low.y());
  ReportDocument document("import", std::filesystem::path(content.file).filename().string());
  document.add_text(words);
  for (const std::string& warning : content.warnings) document.add_text(warning);
  document.begin_map("what was recognised [m]", "x [m]");
  const Vec2 margin{0.05 * extent, 0.05 * extent};
  if (const auto map = protocol::read_map(content.file)) add_map(document, *map, low - margin, high + margin);
  const std::size_t step = content.points.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < content.points.size(); i += step) points.push_back(content.points[i].position);
  document.add_series("dots", "soft", "points of the file", numbers_of(points));
  document.add_series("line", "ink", "edge", numbers_of(left));
  document.add_series("line", "ink", "", numbers_of(right));
  document.add_series("line", "other", "line", numbers_of(line));
  add_start(document, track, extent);
  return document.text();
}

}  // namespace chicane::apps
