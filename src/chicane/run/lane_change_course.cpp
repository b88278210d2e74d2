// SPDX-License-Identifier: MIT
#include "chicane/run/lane_change_course.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "chicane/base/math.hpp"

namespace chicane::run {
namespace {

constexpr double kGap = 1.0;         // [m] between entry and side lane
constexpr double kIntoEntry = 3.0;   // [m] of the entry lane in which the line begins to turn
constexpr double kIntoSide = 5.0;    // [m] of the side lane, at either end
constexpr double kIntoExit = 4.0;    // [m]
constexpr double kBeside = 6.0;      // [m] of space beside the line where there are no cones
constexpr double kReach = 1.0;       // [m] of the edges beyond the cones: what reaches beyond the axles
constexpr double kFarPoints = 20.0;  // [m] between points before and behind the course
constexpr double kEdgePoints = 0.5;  // [m] between points in it
constexpr double kOutline = 0.25;    // [m] between points of the body's sides

/// From 0 to 1 with no slope and no curvature at its ends.
double blend(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

}  // namespace

LaneChangeCourse::LaneChangeCourse(double width) noexcept {
  const double entry = 1.1 * width + 0.25;
  const double side = width + 1.0;
  const double exit = std::max(1.3 * width + 0.25, 3.0);
  const double shift = 0.5 * entry + kGap;
  lanes_ = {Lane{0.0, 12.0, -0.5 * entry, 0.5 * entry}, Lane{25.5, 36.5, shift, shift + side},
            Lane{49.0, kLength, -0.5 * exit, 0.5 * exit}};
}

double LaneChangeCourse::way(double x) const noexcept {
  const auto [entry, side, exit] = lanes_;
  const auto rise = [&](double from, double to) { return blend((x - from) / (to - from)); };
  const double shift = 0.5 * (side.right + side.left);
  return shift * (rise(entry.end - kIntoEntry, side.begin + kIntoSide) -
                  rise(side.end - kIntoSide, exit.begin + kIntoExit));
}

double LaneChangeCourse::room(const model::Pose& car, double length, double width) const noexcept {
  const double cosine = cos(car.psi);
  const double sine = sin(car.psi);
  double least = std::numeric_limits<double>::infinity();
  const int count = std::max(2, static_cast<int>(std::ceil(length / kOutline)));
  for (int i = 0; i <= count; ++i) {
    const double along = length * (static_cast<double>(i) / count - 0.5);
    for (const double across : {-0.5 * width, 0.5 * width}) {
      const double x = car.x + along * cosine - across * sine;
      const double y = car.y + along * sine + across * cosine;
      for (const Lane& lane : lanes_)
        if (x >= lane.begin && x <= lane.end) least = std::min({least, lane.left - y, y - lane.right});
    }
  }
  return least;
}

Result<road::Track> LaneChangeCourse::road() const {
  std::vector<road::TrackPoint> points;
  const auto add = [&](double from, double to, double apart) {
    const int count = static_cast<int>(std::lround((to - from) / apart));
    for (int i = 0; i < count; ++i) {
      const double x = from + i * (to - from) / count;
      road::TrackPoint point{{x, way(x)}, kBeside, kBeside};
      if (x < 0.0) point = {{x, 0.0}, lanes_[0].left, -lanes_[0].right};
      for (const Lane& lane : lanes_) {
        if (x < lane.begin - kReach || x > lane.end + kReach) continue;
        point.left = lane.left - way(x);
        point.right = way(x) - lane.right;
      }
      points.push_back(point);
    }
  };
  add(-kRunUp, 0.0, kFarPoints);
  add(0.0, kLength, kEdgePoints);
  add(kLength, kLength + kRunOut, kFarPoints);
  return road::Track::create("double lane change", points, false,
                             {.spacing = 0.5, .smoothing_sigma = 0.0, .start_s = kRunUp - kStart});
}

}  // namespace chicane::run
