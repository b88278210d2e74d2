// SPDX-License-Identifier: MIT
// Tracks: checks raw points, smooths their line, finds crossings and corners, and samples the widths.
#include "chicane/road/track.hpp"

#include <cstdint>
#include <span>

#include "chicane/base/text.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/road/detail/point_text.hpp"
#include "chicane/road/smooth_line.hpp"

namespace chicane::road {

namespace {

/// Two pieces of a polyline that touch: those that begin at points[first] and points[second], first < second.
struct Crossing {
  std::size_t first = 0;
  std::size_t second = 0;
  bool is_tangle = false;  ///< stands for crossings that were not searched: too many pieces in one cell
};

// Limits that bound the time of the search; chosen: far more than any road has.
constexpr std::size_t kMostCrossings = 10'000;
constexpr std::size_t kMaxPiecesPerCell = 300;

/// Whether the pieces from a0 to a1 and from b0 to b1 have a point in common.
bool touches(const Vec2& a0, const Vec2& a1, const Vec2& b0, const Vec2& b1) noexcept {
  const Vec2 a_low = min(a0, a1);
  const Vec2 a_high = max(a0, a1);
  const Vec2 b_low = min(b0, b1);
  const Vec2 b_high = max(b0, b1);
  if (b_high.x() < a_low.x() || b_high.y() < a_low.y()) return false;
  if (b_low.x() > a_high.x() || b_low.y() > a_high.y()) return false;
  // Positive for a point p to the left of the line from a to b.
  const auto side = [](const Vec2& a, const Vec2& b, const Vec2& p) { return (b - a).cross(p - a); };
  return side(a0, a1, b0) * side(a0, a1, b1) <= 0.0 && side(b0, b1, a0) * side(b0, b1, a1) <= 0.0;
}

/// Piece of a polyline in a cell of the grid.
struct Entry {
  std::uint64_t cell = 0;  ///< column in the upper 32 bits, row in the lower
  std::size_t piece = 0;
};

/// Crossings of the polyline through `points` with itself, by rising `second`; neighbours that share a point
/// do not count. Searches by a grid of cells as wide as the longest piece: O(n log n) for evenly spaced
/// points. A cell with hundreds of pieces, which no road has, gives one crossing that is a tangle. Ends after
/// kMostCrossings.
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
  found.erase(std::unique(found.begin(), found.end(), is_same), found.end());  // found in several cells
  return found;
}

// Chosen: beyond every road, so that points of other things and points in a wrong order are refused.
constexpr double kMaxWidth = 1000.0;        // [m] from the line to an edge
constexpr double kMaxGap = 10'000.0;        // [m] from point to point
constexpr double kLeastCrossingSine = 0.5;  // least sine of the angle between roads that cross: 30 degrees
constexpr double kLeastLoop = 4.0;          // least loop from crossing to crossing, in widths of the road
constexpr double kFootWindow = 5.0;         // [m] search along the line for the foot of a raw point

Error invalid(const std::string& where, const std::string& got, const std::string& expected) {
  return {ErrorCode::kInvalidArgument, where + ": got " + got + ", expected " + expected};
}

std::string point_name(std::size_t index) { return "points[" + std::to_string(index) + "]"; }

std::optional<Error> check_options(const TrackOptions& options) {
  const auto check = [](const char* field, double value, double low, double high) -> std::optional<Error> {
    if (value >= low && value <= high) return std::nullopt;
    return invalid(field, number_text(value),
                   "a number in [" + number_text(low) + ", " + number_text(high) + "]");
  };
  if (auto error = check("spacing", options.spacing, 0.05, 10.0)) return error;
  if (auto error = check("smoothing_sigma", options.smoothing_sigma, 0.0, 1.0)) return error;
  if (auto error = check("kerb_width", options.kerb_width, 0.0, 3.0)) return error;
  if (auto error = check("start_s", options.start_s, -Path::kMaxCoordinate, Path::kMaxCoordinate))
    return error;
  if (auto error = check("finish_s", options.finish_s, 0.0, Path::kMaxCoordinate)) return error;
  return check("start_d", options.start_d, -kMaxWidth, kMaxWidth);
}

std::optional<Error> check_points(const std::vector<TrackPoint>& points) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TrackPoint& point = points[i];
    const bool is_place = std::fabs(point.position.x()) <= Path::kMaxCoordinate &&
                          std::fabs(point.position.y()) <= Path::kMaxCoordinate;
    if (!is_place)
      return invalid(point_name(i), point_text(point.position), "finite coordinates within 1e7 m");
    const auto is_width = [](double width) { return width > 0.0 && width <= kMaxWidth; };
    constexpr const char* kWidth = "a width > 0 and <= 1000 m";
    if (!is_width(point.left)) return invalid(point_name(i) + ".left", number_text(point.left), kWidth);
    if (!is_width(point.right)) return invalid(point_name(i) + ".right", number_text(point.right), kWidth);
    const double gap = i == 0 ? Path::kMinSpacing : (point.position - points[i - 1].position).norm();
    if (gap > kMaxGap)
      return invalid(point_name(i), point_text(point.position), "a point within 10 km of the one before");
    if (gap >= Path::kMinSpacing) ++different;
  }
  if (different < 4) {
    return invalid("points",
                   std::to_string(points.size()) + " with " + std::to_string(different) + " different",
                   "at least 4 different ones");
  }
  return std::nullopt;
}

/// Whether two pieces of the line meet as a crossing of roads: at an angle, and with a loop between them that
/// a road of this width can make. Points in a wrong order meet in other ways.
bool is_crossing_of_roads(const SmoothLine& line, const Crossing& crossing, bool closed, double road_width) {
  const std::size_t n = line.knots.size();
  const auto along = [&](std::size_t i) -> Vec2 { return line.knots[(i + 1) % n] - line.knots[i]; };
  const Vec2 first = along(crossing.first);
  const Vec2 second = along(crossing.second);
  const double sine = first.cross(second) / std::max(first.norm() * second.norm(), 1e-12);
  const double loop = line.spacing * static_cast<double>(crossing.second - crossing.first);
  const double shorter = closed ? std::min(loop, line.length - loop) : loop;
  return std::fabs(sine) >= kLeastCrossingSine && shorter >= kLeastLoop * road_width;
}

/// Counts crossings of the smooth line with itself. Fails at the first one that is no crossing of roads, and
/// names the raw points there.
Result<int> count_crossings(const SmoothLine& line, const std::vector<TrackPoint>& points, bool closed) {
  const auto raw_index = [&](std::size_t knot) {
    const double s = line.spacing * static_cast<double>(knot);
    const auto after = std::upper_bound(line.parameter.begin(), line.parameter.end(), s);
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - line.parameter.begin() - 1, 0));
  };
  const auto width = [&](std::size_t knot) {
    return points[raw_index(knot)].left + points[raw_index(knot)].right;
  };
  // A crossing at a knot touches the pieces on both sides of it.
  const auto are_near = [&](std::size_t a, std::size_t b) {
    const std::size_t apart = a > b ? a - b : b - a;
    return apart <= 1 || (closed && apart + 1 >= line.knots.size());
  };
  std::vector<Crossing> different;
  for (const Crossing& crossing : find_crossings(line.knots, closed)) {
    const double widest = std::max(width(crossing.first), width(crossing.second));
    if (crossing.is_tangle || !is_crossing_of_roads(line, crossing, closed, widest)) {
      const std::size_t index = raw_index(crossing.second);
      return fail(invalid(point_name(index),
                          "a line that crosses itself near " + point_text(points[index].position) +
                              ", where it passed after " + point_name(raw_index(crossing.first)),
                          "no crossing, or one of at least 30 degrees after four widths of way"));
    }
    const bool is_known = std::any_of(different.begin(), different.end(), [&](const Crossing& known) {
      return (are_near(known.first, crossing.first) && are_near(known.second, crossing.second)) ||
             (are_near(known.first, crossing.second) && are_near(known.second, crossing.first));
    });
    if (!is_known) different.push_back(crossing);
  }
  return static_cast<int>(different.size());
}

}  // namespace

Result<Track> Track::create(std::string name, const std::vector<TrackPoint>& points, bool closed,
                            const TrackOptions& options) {
  if (std::optional<Error> error = check_options(options)) return fail(std::move(*error));
  if (std::optional<Error> error = check_points(points)) return fail(std::move(*error));
  std::vector<Vec2> positions;
  positions.reserve(points.size());
  for (const TrackPoint& point : points) positions.push_back(point.position);

  Result<SmoothLine> line = smooth_line(positions, closed, options.spacing, options.smoothing_sigma);
  if (!line) return fail(line.error());
  Result<Path> centre = Path::create(line->knots, closed);
  if (!centre) return fail(invalid("points", "a line that stands still or folds back", "a road"));
  const Result<int> crossings = count_crossings(*line, points, closed);
  if (!crossings) return fail(crossings.error());

  Track track{std::move(name), std::move(*centre)};
  for (double& s : line->parameter) s *= track.length() / line->length;
  track.set_widths(points, line->parameter);
  if (std::optional<Error> error = track.check_fit(points)) return fail(std::move(*error));
  track.crossings_ = *crossings;
  track.kerb_width_ = options.kerb_width;
  track.start_s_ = track.centre_.wrap(options.start_s);
  track.start_d_ = options.start_d;
  if (options.start_d >= track.left_width(track.start_s_) ||
      -options.start_d >= track.right_width(track.start_s_)) {
    return fail(invalid("start_d", number_text(options.start_d), "a place on the road"));
  }
  track.lap_length_ = track.length();
  if (closed && options.finish_s != 0.0)
    return fail(invalid("finish_s", number_text(options.finish_s), "none on a closed road"));
  if (!closed) {
    const double finish = options.finish_s == 0.0 ? track.length() : options.finish_s;
    if (!(finish > track.start_s_ && finish <= track.length()))
      return fail(invalid("finish_s", number_text(options.finish_s),
                          "a place behind the start at " + number_text(track.start_s_) +
                              " and on the road of " + number_text(std::floor(track.length() + 1e-6)) +
                              " m"));
    track.lap_length_ = finish - track.start_s_;
  }
  track.raw_points_ = points;
  return track;
}

std::optional<Error> Track::check_fit(const std::vector<TrackPoint>& points) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double off = centre_.project(points[i].position, raw_places_[i], kFootWindow).d;
    const double room = off > 0.0 ? points[i].right : points[i].left;
    if (std::fabs(off) < room) continue;
    return invalid(point_name(i), chicane::number_text(std::fabs(off), 3) + " m beside the smooth line",
                   "less than the " + number_text(room) + " m to the edge of the road");
  }
  return std::nullopt;
}

Track Track::scaled(double factor) const {
  Track track = *this;
  track.centre_ = centre_.scaled(factor);
  for (double* length :
       {&track.kerb_width_, &track.start_s_, &track.start_d_, &track.lap_length_, &track.width_spacing_})
    *length *= factor;
  for (std::vector<double>* widths : {&track.left_, &track.right_}) {
    for (double& width : *widths) width *= factor;
  }
  for (double& place : track.raw_places_) place *= factor;
  for (TrackPoint& point : track.raw_points_)
    point = {factor * point.position, factor * point.left, factor * point.right};
  return track;
}

void Track::set_widths(const std::vector<TrackPoint>& points, const std::vector<double>& guesses) {
  // Widths at the foot of a raw point that is d left of the line: d + left, and right − d.
  struct Sample {
    double s = 0.0;
    double left = 0.0;
    double right = 0.0;
  };
  std::vector<Sample> samples;
  samples.reserve(points.size() + 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Projection foot = centre_.project(points[i].position, guesses[i], kFootWindow);
    samples.push_back({foot.s, foot.d + points[i].left, points[i].right - foot.d});
    raw_places_.push_back(foot.s);
  }
  std::sort(samples.begin(), samples.end(),
            [](const Sample& a, const Sample& b) { return a.s != b.s ? a.s < b.s : a.left < b.left; });
  Sample before = centre_.is_closed() ? samples.back() : samples.front();
  Sample after = centre_.is_closed() ? samples.front() : samples.back();
  before.s = centre_.is_closed() ? before.s - length() : -1.0;
  after.s = centre_.is_closed() ? after.s + length() : length() + 1.0;
  samples.insert(samples.begin(), before);
  samples.push_back(after);

  const auto intervals = static_cast<std::size_t>(std::max(1, centre_.capacity()));
  width_spacing_ = length() / static_cast<double>(intervals);
  std::size_t next = 1;
  for (std::size_t k = 0; k <= intervals; ++k) {
    const double s = width_spacing_ * static_cast<double>(k);
    while (next + 1 < samples.size() && samples[next].s <= s) ++next;
    const Sample& a = samples[next - 1];
    const Sample& b = samples[next];
    const double share = b.s > a.s ? std::clamp((s - a.s) / (b.s - a.s), 0.0, 1.0) : 0.0;
    left_.push_back(a.left + share * (b.left - a.left));
    right_.push_back(a.right + share * (b.right - a.right));
  }
}

double Track::width_at(const std::vector<double>& table, double s) const noexcept {
  const double u = centre_.wrap(s) / width_spacing_;
  if (!(u >= 0.0)) return u;
  const std::size_t k = std::min(static_cast<std::size_t>(u), table.size() - 2);
  return table[k] + (u - static_cast<double>(k)) * (table[k + 1] - table[k]);
}

double Track::edge_distance(const Projection& foot) const noexcept {
  return std::min(left_width(foot.s) - foot.d, right_width(foot.s) + foot.d);
}

namespace {

// Chosen: the corners of known circuits come out as their names have them. corners.ts has the same numbers.
constexpr double kSpacing = 2.0;                 // spacing of samples [m]
constexpr int kHalfWindow = 3;                   // samples on each side that the curvature is averaged with
constexpr double kLeastCurvature = 1.0 / 220.0;  // a larger radius is straight at racing speed [1/m]
constexpr double kSameCorner = 20.0;             // longest straight between bends of one corner [m]
constexpr double kLeastTurn = 0.3;               // least turn of a corner [rad]
constexpr double kNarrowest = 6.0;               // mean width of the narrowest road in full size [m]

/// Size of a road as a share of full size, by its mean width.
double size_of(const Track& track) {
  constexpr int kPlaces = 64;  // samples along the track
  double width = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const double s = track.length() * i / kPlaces;
    width += (track.left_width(s) + track.right_width(s)) / kPlaces;
  }
  return std::min(width / kNarrowest, 1.0);
}

/// Mean curvature of a line at equal distances [1/m].
struct Bends {
  double spacing = 0.0;  ///< [m]
  int count = 0;         ///< of the samples
  bool is_closed = false;
  std::vector<double> curvature{};  ///< at the samples

  /// Curvature of sample `i`: of any lap of a closed line; zero beyond the ends of an open one.
  [[nodiscard]] double at(int i) const {
    if (is_closed) return curvature[static_cast<std::size_t>(((i % count) + count) % count)];
    return i < 0 || i >= count ? 0.0 : curvature[static_cast<std::size_t>(i)];
  }
  /// Arc length of sample `i` within a lap [m].
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
  // Begins at a sample that is straight or turns to another side than the one before: within no corner.
  int first = 0;
  while (bends.is_closed && first < bends.count && side(first) != 0 && side(first - 1) == side(first))
    ++first;
  if (first == bends.count) return {};

  struct Bend {
    int from, to, side;  // first sample, the one after the last, and 1: left, −1: right
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
  // Distance forwards from `from` to `s`, round a closed road.
  const auto ahead = [&](double s, double from) { return s < from ? s - from + round : s - from; };
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
