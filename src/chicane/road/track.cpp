// SPDX-License-Identifier: MIT
#include "chicane/road/track.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "chicane/base/text.hpp"
#include "chicane/road/detail/crossing.hpp"
#include "chicane/road/detail/point_text.hpp"
#include "chicane/road/smooth_line.hpp"

namespace chicane::road {
namespace {

constexpr double kMaxWidth = 1000.0;        // [m]
constexpr double kMaxGap = 10'000.0;        // from point to point [m]
constexpr double kLeastCrossingSine = 0.5;  // of the angle between roads that cross
constexpr double kLeastLoop = 4.0;          // from crossing to crossing, in widths of the road

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

/// Whether two stretches of road meet as a crossing: at an angle, and with a loop between them that a road of
/// this width can make. Points in a wrong order and roads that run into one another do neither.
bool is_crossing_of_roads(const SmoothLine& line, const Crossing& crossing, bool closed, double road_width) {
  const std::size_t n = line.knots.size();
  const auto along = [&](std::size_t i) -> Vec2 { return line.knots[(i + 1) % n] - line.knots[i]; };
  const Vec2 first = along(crossing.first);
  const Vec2 second = along(crossing.second);
  const double sine =
      (first.x() * second.y() - first.y() * second.x()) / std::max(first.norm() * second.norm(), 1e-12);
  const double loop = line.spacing * static_cast<double>(crossing.second - crossing.first);
  const double shorter = closed ? std::min(loop, line.length - loop) : loop;
  return std::fabs(sine) >= kLeastCrossingSine && shorter >= kLeastLoop * road_width;
}

/// How often the smooth line crosses itself; a place where it must not, in terms of the raw points.
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
    const double off = centre_.project(points[i].position, raw_places_[i], 5.0).d;
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
  // A raw point at d left of the line has its left edge at d + left, its right edge at right − d.
  struct Sample {
    double s = 0.0;
    double left = 0.0;
    double right = 0.0;
  };
  std::vector<Sample> samples;
  samples.reserve(points.size() + 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Projection foot = centre_.project(points[i].position, guesses[i], 5.0);
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

}  // namespace chicane::road
