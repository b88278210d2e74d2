// SPDX-License-Identifier: MIT
// Finds the road in an occupancy map: coarsens the map, measures distances to walls, finds the cheapest loop
// round an infield, moves its line to the middle and measures its widths.
#include "chicane/survey/free_space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/base/median.hpp"
#include "chicane/survey/image.hpp"
#include "chicane/survey/sampled_line.hpp"

namespace chicane::survey {
namespace {

constexpr std::size_t kMostFine = 16'000'000;   // limit of cells of the distance field: bounds memory; chosen
constexpr std::size_t kMostCoarse = 1'000'000;  // limit of cells of the search: bounds time; chosen
constexpr double kLeastInfield = 1.0;           // [m] least diagonal of an infield; chosen
constexpr double kMostReach = 1.6;  // widest side of the road over its clearance: pockets are no road; chosen
constexpr int kRounds = 40;         // rounds of moving the line to the middle; chosen
constexpr std::size_t kLeastLine = 8;  // least points of a way round; chosen: fewer are no road with bends

/// Road round an obstacle, on the coarse grid.
struct Ring {
  Mask road;                 ///< cells of the road
  std::size_t centre = 0;    ///< rightmost cell of the obstacle
  double infield = 0.0;      ///< diagonal of the obstacle without the clearance [coarse cells]
  bool is_at_border = true;  ///< whether the road reaches the edge of the map
};

/// Cheapest ways from one cell, the gate, to all cells of a road on the coarse grid.
struct Ways {
  std::vector<float> cell_cost;    ///< cost of a unit of length in a cell: more near walls
  std::vector<float> cost;         ///< cost of the way to a cell; infinite where there is none
  std::vector<std::int8_t> turns;  ///< turns of the way round the obstacle, counter-clockwise positive
  std::vector<std::int8_t> back;   ///< number in kNeighbours of the way's last step; -1: none

  /// Cost of a step from cell a to cell b, its n-th neighbour.
  [[nodiscard]] float step_cost(std::size_t a, std::size_t b, int n) const {
    return 0.5F * (cell_cost[a] + cell_cost[b]) * (n < 4 ? 1.0F : 1.41421356F);
  }
};
constexpr float kUnreached = std::numeric_limits<float>::infinity();  // Ways::cost without a way

/// Turn round the cell `centre` that a step from a cell to its n-th neighbour makes: 1 or -1 where the step
/// crosses the ray from the centre to the right, counter-clockwise or clockwise, and else 0.
int turn_of(const Place& centre, const Place& from, int n) {
  const Place& step = kNeighbours[n];
  if (from.x + 0.5 * step.x <= centre.x) return 0;
  if (from.y == centre.y && step.y == 1) return 1;
  return from.y == centre.y + 1 && step.y == -1 ? -1 : 0;
}

/// Search of the loop. The map is coarsened twice: to the fine grid, which holds walls and distances, and to
/// the coarse grid, on which ways are searched. Positions and lengths are in fine cells unless a name or a
/// comment says otherwise.
class LoopFinder {
 public:
  LoopFinder(const FreeSpace& space, const LoopOptions& options) : space_{space}, options_{options} {
    while (space.width / join_ * static_cast<double>(space.height / join_) > static_cast<double>(kMostFine))
      ++join_;
    fine_ = {std::max(1, space.width / join_), std::max(1, space.height / join_)};
    cell_ = space.resolution * join_;
    while (static_cast<std::size_t>(fine_.width / stride_) *
                   static_cast<std::size_t>(fine_.height / stride_) >
               kMostCoarse &&
           cell_ * (stride_ + 1) * 3.0 < options.least_width)
      ++stride_;
    coarse_ = {std::max(1, fine_.width / stride_), std::max(1, fine_.height / stride_)};
  }

  /// The loop, or why there is none.
  Result<FreeLoop> find() {
    measure_walls();
    const double clearance = 0.5 * options_.least_width / cell_;
    const std::optional<Ring> ring = find_ring(clearance);
    std::vector<Vec2> line = ring ? way_round(*ring) : std::vector<Vec2>{};
    if (line.size() < kLeastLine) return fail(ErrorCode::kParse, why_none());
    return measured(moved_to_the_middle(std::move(line)));
  }

 private:
  /// Fills the fine grid, where a cell is blocked if any of its cells of the map is, and measures distances.
  void measure_walls() {
    blocked_.assign(fine_.size(), 0);
    for (int y = 0; y < fine_.height * join_ && y < space_.height; ++y)
      for (int x = 0; x < fine_.width * join_ && x < space_.width; ++x) {
        const Cell cell = space_.cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(space_.width) +
                                       static_cast<std::size_t>(x)];
        if (cell != Cell::kFree) blocked_[fine_.at(x / join_, y / join_)] = 1;
      }
    remove_spots();
    field_ = distance_field(blocked_, fine_.width, fine_.height);
  }

  /// Frees small obstacles, which are noise of the map.
  void remove_spots() {
    spots_ = 0;
    std::vector<int> labels;
    const std::vector<Region> spots = regions_of(blocked_, fine_, 8, labels);
    const double most = options_.least_obstacle / cell_;
    Mask is_noise(spots.size() + 1, 0);
    for (std::size_t i = 0; i < spots.size(); ++i) {
      if (spots[i].is_at_border || spots[i].diagonal() > most) continue;
      is_noise[i + 1] = 1;
      ++spots_;
    }
    for (std::size_t i = 0; i < blocked_.size(); ++i)
      if (labels[i] != 0 && is_noise[static_cast<std::size_t>(labels[i])] != 0) blocked_[i] = 0;
  }

  /// Distance from a coarse cell to the nearest wall [fine cells].
  [[nodiscard]] double clearance_at(std::size_t coarse) const {
    const Place at = coarse_.place(coarse);
    const int x = std::min(fine_.width - 1, at.x * stride_ + stride_ / 2);
    const int y = std::min(fine_.height - 1, at.y * stride_ + stride_ / 2);
    return static_cast<double>(field_[fine_.at(x, y)]) - 0.5;
  }

  /// Road of at least `clearance` [fine cells] to each side that leads round the largest infield. Roads that
  /// do not reach the edge of the map come first, because the room outside of a course often does.
  std::optional<Ring> find_ring(double clearance) {
    Mask passable(coarse_.size(), 0);
    for (std::size_t i = 0; i < passable.size(); ++i) passable[i] = clearance_at(i) >= clearance ? 1 : 0;
    std::vector<int> labels;
    std::vector<Region> roads = regions_of(passable, coarse_, 8, labels);
    std::vector<int> order;
    for (std::size_t i = 0; i < roads.size(); ++i) order.push_back(static_cast<int>(i));
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      return roads[static_cast<std::size_t>(a)].count > roads[static_cast<std::size_t>(b)].count;
    });
    constexpr std::size_t kMostRoads = 6;  // limit of examined roads, the largest first; chosen
    if (order.size() > kMostRoads) order.resize(kMostRoads);
    if (options_.start) {
      const int wanted = labels[coarse_of(space_.to_cells(*options_.start) / join_)];
      if (wanted == 0) return std::nullopt;
      order = {wanted - 1};
    }
    if (!order.empty()) largest_ = {labels, order.front() + 1};
    std::optional<Ring> best;
    for (const int road : order) {
      std::optional<Ring> ring =
          ring_of(labels, road + 1, roads[static_cast<std::size_t>(road)].is_at_border, clearance);
      if (!ring) continue;
      const bool is_better = !best || (best->is_at_border && !ring->is_at_border) ||
                             (best->is_at_border == ring->is_at_border && ring->infield > best->infield);
      if (is_better) best = std::move(ring);
    }
    return best;
  }

  /// Road made of the cells with `label`, round its largest hole; none without a hole.
  std::optional<Ring> ring_of(const std::vector<int>& labels, int label, bool is_at_border,
                              double clearance) const {
    Ring ring{.road = Mask(coarse_.size(), 0), .is_at_border = is_at_border};
    Mask others(coarse_.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
      ring.road[i] = labels[i] == label ? 1 : 0;
      others[i] = labels[i] == label ? 0 : 1;
    }
    std::vector<int> holes;
    for (const Region& hole : regions_of(others, coarse_, 4, holes)) {
      const double size = hole.diagonal() - 2.0 * clearance / stride_;
      if (hole.is_at_border || size * cell_ * stride_ < kLeastInfield || size <= ring.infield) continue;
      ring.infield = size;
      ring.centre = hole.rightmost;
    }
    return ring.infield > 0.0 ? std::optional<Ring>(std::move(ring)) : std::nullopt;
  }

  /// Coarse cell at a position.
  [[nodiscard]] std::size_t coarse_of(const Vec2& fine) const {
    const auto clamped = [](double value, int most) {
      return static_cast<int>(std::clamp(value, 0.0, most - 1.0));
    };
    return coarse_.at(clamped(fine.x() / stride_, coarse_.width),
                      clamped(fine.y() / stride_, coarse_.height));
  }

  /// Roomiest cell of the road right of the obstacle, where the way round begins and ends.
  [[nodiscard]] std::size_t gate_of(const Ring& ring) const {
    const Place centre = coarse_.place(ring.centre);
    std::size_t best = ring.centre;
    double most = -1.0;
    for (int x = centre.x + 1; x < coarse_.width; ++x) {
      const std::size_t index = coarse_.at(x, centre.y);
      const bool is_road = ring.road[index] != 0;
      if (!is_road && most >= 0.0) break;
      if (!is_road || clearance_at(index) <= most) continue;
      most = clearance_at(index);
      best = index;
    }
    return best;
  }

  /// Cheapest ways from the gate on the road (Dijkstra). A step costs its length, and more near walls.
  [[nodiscard]] Ways ways_from(std::size_t gate, const Ring& ring) const {
    const Place centre = coarse_.place(ring.centre);
    const double roomy = std::max(1.0, clearance_at(gate));
    const std::size_t size = coarse_.size();
    Ways ways{std::vector<float>(size, 0.0F), std::vector<float>(size, kUnreached),
              std::vector<std::int8_t>(size, 0), std::vector<std::int8_t>(size, -1)};
    for (std::size_t i = 0; i < size; ++i) {
      if (ring.road[i] == 0) continue;
      const double near = roomy / std::max(0.5, clearance_at(i));
      ways.cell_cost[i] = static_cast<float>(1.0 + near * near);
    }
    using Entry = std::pair<float, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    ways.cost[gate] = 0.0F;
    open.emplace(0.0F, gate);
    while (!open.empty()) {
      const float so_far = open.top().first;
      const std::size_t index = open.top().second;
      open.pop();
      if (so_far > ways.cost[index]) continue;
      coarse_.for_each_neighbour(index, 8, [&](int n, std::size_t next) {
        const float total = so_far + ways.step_cost(index, next, n);
        if (ring.road[next] == 0 || total >= ways.cost[next]) return;
        const int turns = ways.turns[index] + turn_of(centre, coarse_.place(index), n);
        ways.cost[next] = total;
        ways.turns[next] = static_cast<std::int8_t>(std::clamp(turns, -100, 100));
        ways.back[next] = static_cast<std::int8_t>(n);
        open.emplace(total, next);
      });
    }
    return ways;
  }

  /// Cheapest way from the gate round the obstacle and back: two ways from the gate that together turn round
  /// it once, joined by a step. Empty if there is none.
  [[nodiscard]] std::vector<Vec2> way_round(const Ring& ring) const {
    const std::size_t gate = gate_of(ring);
    if (gate == ring.centre) return {};
    const Place centre = coarse_.place(ring.centre);
    const Ways ways = ways_from(gate, ring);
    float best = kUnreached;
    std::size_t one = gate, other = gate;
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
      if (ways.cost[i] == kUnreached) continue;
      coarse_.for_each_neighbour(i, 8, [&](int n, std::size_t next) {
        const int turns = ways.turns[i] + turn_of(centre, coarse_.place(i), n) - ways.turns[next];
        const float total = ways.cost[i] + ways.step_cost(i, next, n) + ways.cost[next];
        if (ring.road[next] == 0 || turns != 1 || total >= best) return;
        best = total;
        one = i;
        other = next;
      });
    }
    if (best == kUnreached) return {};
    std::vector<Vec2> line;
    trace(ways, gate, one, line);
    std::reverse(line.begin(), line.end());
    trace(ways, gate, other, line);
    if (!line.empty()) line.pop_back();  // the gate is the first point already
    return line;
  }

  /// Adds the way from a cell back to the gate.
  void trace(const Ways& ways, std::size_t gate, std::size_t from, std::vector<Vec2>& line) const {
    for (std::size_t i = from;;) {
      const Place at = coarse_.place(i);
      line.push_back(centre_of(i));
      if (i == gate || ways.back[i] < 0) return;
      const Place& step = kNeighbours[ways.back[i]];
      i = coarse_.at(at.x - step.x, at.y - step.y);
    }
  }

  /// Position of the centre of a coarse cell.
  [[nodiscard]] Vec2 centre_of(std::size_t coarse) const {
    const Place at = coarse_.place(coarse);
    return {(at.x + 0.5) * stride_, (at.y + 0.5) * stride_};
  }

  /// Distance from any position to the nearest wall, interpolated between the centres of fine cells.
  [[nodiscard]] double room_at(const Vec2& place) const {
    const double x = std::clamp(place.x() - 0.5, 0.0, fine_.width - 1.001);
    const double y = std::clamp(place.y() - 0.5, 0.0, fine_.height - 1.001);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, fine_.width - 1), y1 = std::min(y0 + 1, fine_.height - 1);
    const double u = x - x0, v = y - y0;
    const auto value = [&](int column, int row) {
      return static_cast<double>(field_[fine_.at(column, row)]);
    };
    return (1.0 - v) * ((1.0 - u) * value(x0, y0) + u * value(x1, y0)) +
           v * ((1.0 - u) * value(x0, y1) + u * value(x1, y1)) - 0.5;
  }

  /// Unit vector to the left of the closed line at point i, by the chord between the points `reach` before
  /// and after it.
  static Vec2 left_of(const std::vector<Vec2>& line, std::size_t i, std::size_t reach) {
    const std::size_t count = line.size();
    const Vec2 along = line[(i + reach) % count] - line[(i + count - reach) % count];
    const double length = along.norm();
    return length > 0.0 ? Vec2{-along.y() / length, along.x() / length} : Vec2{0.0, 1.0};
  }

  /// Moves each point across the line to the place with most room, in rounds. Each round ends with smoothing
  /// and even spacing. Chosen: reach and spacing as shares of the half width, four places to each side, a
  /// slight preference for staying (1e-3), half of each move.
  [[nodiscard]] std::vector<Vec2> moved_to_the_middle(std::vector<Vec2> line) const {
    std::vector<double> room;
    for (const Vec2& point : line) room.push_back(room_at(point));
    const double half_width = std::max(2.0, median(std::move(room)));
    const double spacing = std::clamp(0.3 * half_width, 1.5, 200.0);
    line = sampled(line, true, spacing);
    for (int round = 0; round < kRounds; ++round) {
      const std::vector<Vec2> before = line;
      const std::size_t count = line.size();
      const double reach = round < kRounds / 2 ? 0.3 * half_width : 0.1 * half_width;
      for (std::size_t i = 0; i < count; ++i) {
        const Vec2 left = left_of(before, i, 2);
        double best = room_at(before[i]);
        double offset = 0.0;
        for (int k = -4; k <= 4; ++k) {
          const double tried = reach * k / 4.0;
          const double there = room_at(before[i] + tried * left) - 1e-3 * std::fabs(tried);
          if (there > best) {
            best = there;
            offset = tried;
          }
        }
        line[i] = before[i] + 0.5 * offset * left;
      }
      const std::vector<Vec2> moved = line;
      for (std::size_t i = 0; i < count; ++i)
        line[i] = 0.5 * moved[i] + 0.25 * (moved[(i + 1) % count] + moved[(i + count - 1) % count]);
      line = sampled(line, true, spacing);
    }
    return line;
  }

  /// Distance to the first blocked cell in a direction, at most `most`. Each step is as long as the distance
  /// field allows, less 1.5 cells: from the position to its cell's centre, and from the wall's centre to its
  /// corner.
  [[nodiscard]] double cast(const Vec2& from, const Vec2& direction, double most) const {
    double away = 0.0;
    while (away < most) {
      const Vec2 at = from + away * direction;
      const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
      if (!fine_.has(x, y) || blocked_[fine_.at(x, y)] != 0) return away;
      away += std::max(0.1, static_cast<double>(field_[fine_.at(x, y)]) - 1.5);
    }
    return most;
  }

  /// Distances to a wall without the teeth that the cells of an oblique wall make: the road's edge runs along
  /// their tips. Each is the least of three neighbours, then the mean of five, and never more than measured.
  static std::vector<double> without_teeth(const std::vector<double>& side) {
    const std::size_t count = side.size();
    std::vector<double> least(count), even(count);
    for (std::size_t i = 0; i < count; ++i)
      least[i] = std::min({side[(i + count - 1) % count], side[i], side[(i + 1) % count]});
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 5; ++k) sum += least[(i + count + k - 2) % count];
      even[i] = std::min(0.2 * sum, side[i]);
    }
    return even;
  }

  /// The loop in W along a line, with the distances to the walls on both sides.
  [[nodiscard]] FreeLoop measured(const std::vector<Vec2>& line) const {
    FreeLoop loop{.spots = spots_};
    const std::size_t count = line.size();
    std::vector<double> to_left, to_right, widths;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec2 left = left_of(line, i, 2);
      const double most = kMostReach * std::max(0.5, room_at(line[i]));
      to_left.push_back(std::max(0.2, cast(line[i], left, most)));
      to_right.push_back(std::max(0.2, cast(line[i], -left, most)));
    }
    to_left = without_teeth(to_left);
    to_right = without_teeth(to_right);
    for (std::size_t i = 0; i < count; ++i) {
      loop.points.push_back({space_.to_world(join_ * line[i]), to_left[i] * cell_, to_right[i] * cell_});
      widths.push_back((to_left[i] + to_right[i]) * cell_);
    }
    loop.median_width = median(std::move(widths));
    return loop;
  }

  /// Position in W [m] as text for messages.
  [[nodiscard]] std::string shown(const Vec2& fine) const {
    const Vec2 world = space_.to_world(join_ * fine);
    return fmt::format("({:.2f}, {:.2f})", world.x(), world.y());
  }

  /// Message that says why there is no loop: a narrow place, an open end, or unknown cells.
  std::string why_none() {
    if (options_.start && clearance_at(coarse_of(space_.to_cells(*options_.start) / join_)) <= 0.0)
      return fmt::format("start: got ({}, {}), expected a place in free space", options_.start->x(),
                         options_.start->y());
    const std::pair<std::vector<int>, int> largest = largest_;
    if (const std::optional<Ring> narrow = find_ring(0.6)) {  // [cells]: any way through
      const std::vector<Vec2> line = way_round(*narrow);
      if (!line.empty()) {
        const auto tightest = std::min_element(
            line.begin(), line.end(), [&](const Vec2& a, const Vec2& b) { return room_at(a) < room_at(b); });
        return fmt::format("free space: got a loop that is {:.2f} m wide at {}, expected at least {} m",
                           2.0 * cell_ * room_at(*tightest), shown(*tightest), options_.least_width);
      }
    }
    if (largest.second == 0)
      return fmt::format("free space: got no room of {} m, expected a closed loop of free cells",
                         options_.least_width);
    const auto [one, other] = ends_of(largest.first, largest.second);
    const bool is_unseen = ends_unseen(one) || ends_unseen(other);
    return fmt::format(
        "free space: got no loop, open between {} and {}, {:.1f} m apart{}; expected a closed loop",
        shown(one), shown(other), (one - other).norm() * cell_, is_unseen ? ", where cells are unknown" : "");
  }

  /// Whether the room at an end of a road stops at unknown cells.
  [[nodiscard]] bool ends_unseen(const Vec2& end) const {
    const double reach = std::min(room_at(end) + 2.0, 200.0);
    const int most = static_cast<int>(reach);
    for (int dy = -most; dy <= most; ++dy)
      for (int dx = -most; dx <= most; ++dx) {
        const int x = static_cast<int>(end.x()) + dx, y = static_cast<int>(end.y()) + dy;
        if (hypot(dx, dy) > reach || !fine_.has(x, y) || blocked_[fine_.at(x, y)] == 0) continue;
        const auto column = static_cast<std::size_t>(x * join_), row = static_cast<std::size_t>(y * join_);
        if (space_.cells[row * static_cast<std::size_t>(space_.width) + column] == Cell::kUnknown)
          return true;
      }
    return false;
  }

  /// Two places of a region that are farthest from each other within it.
  [[nodiscard]] std::pair<Vec2, Vec2> ends_of(const std::vector<int>& labels, int label) const {
    const auto farthest = [&](std::size_t from) {
      Mask is_seen(labels.size(), 0);
      std::vector<std::size_t> open{from};
      is_seen[from] = 1;
      for (std::size_t i = 0; i < open.size(); ++i) {
        coarse_.for_each_neighbour(open[i], 4, [&](int /*n*/, std::size_t next) {
          if (labels[next] != label || is_seen[next] != 0) return;
          is_seen[next] = 1;
          open.push_back(next);
        });
      }
      return open.back();
    };
    const auto any =
        static_cast<std::size_t>(std::find(labels.begin(), labels.end(), label) - labels.begin());
    const std::size_t one = farthest(any);
    const std::size_t other = farthest(one);
    return {centre_of(one), centre_of(other)};
  }

  const FreeSpace& space_;
  LoopOptions options_;
  int join_ = 1;                                ///< side of a fine cell, in cells of the map
  int stride_ = 1;                              ///< side of a coarse cell, in fine cells
  double cell_ = 0.0;                           ///< side of a fine cell [m]
  Grid fine_;                                   ///< grid of walls and distances
  Grid coarse_;                                 ///< grid of the search
  Mask blocked_;                                ///< walls and unknown cells, on the fine grid
  std::vector<float> field_;                    ///< distance of each fine cell to the nearest wall
  int spots_ = 0;                               ///< spots that remove_spots() freed
  std::pair<std::vector<int>, int> largest_{};  ///< labels of the coarse grid, and its largest road's label
};

}  // namespace

Vec2 FreeSpace::to_world(const Vec2& in_cells) const noexcept {
  const Vec2 there = resolution * in_cells;
  const double c = cos(yaw), s = sin(yaw);
  return origin + Vec2{c * there.x() - s * there.y(), s * there.x() + c * there.y()};
}

Vec2 FreeSpace::to_cells(const Vec2& in_world) const noexcept {
  const Vec2 there = in_world - origin;
  const double c = cos(yaw), s = sin(yaw);
  return Vec2{c * there.x() + s * there.y(), -s * there.x() + c * there.y()} / resolution;
}

Result<FreeLoop> find_loop(const FreeSpace& space, const LoopOptions& options) {
  return LoopFinder(space, options).find();
}

}  // namespace chicane::survey
