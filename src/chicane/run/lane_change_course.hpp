// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "chicane/base/result.hpp"
#include "chicane/model/state.hpp"
#include "chicane/road/track.hpp"

namespace chicane::run {

/// The cones of the severe double lane change of ISO 3888-2: an entry lane, a side lane to the left with 1 m
/// between the two, an exit lane in line with the entry lane, as wide as the car makes them, and 13.5 m and
/// 12.5 m between them. x runs along the course from the entry, y to the left from the entry lane's middle
/// (docs/tracks.md).
class LaneChangeCourse {
 public:
  struct Lane {
    double begin = 0.0, end = 0.0;   ///< x [m]
    double right = 0.0, left = 0.0;  ///< y of its cones [m]
  };
  static constexpr double kLength = 61.0;   ///< [m]
  static constexpr double kStart = 80.0;    ///< where a car waits before the entry [m]
  static constexpr double kRunUp = 100.0;   ///< of the road before the entry [m]
  static constexpr double kRunOut = 200.0;  ///< and behind the exit [m]

  /// For a car of this width [m].
  explicit LaneChangeCourse(double width) noexcept;

  [[nodiscard]] const std::array<Lane, 3>& lanes() const noexcept { return lanes_; }
  /// y of a smooth line through [m].
  [[nodiscard]] double way(double x) const noexcept;
  /// Least distance of a body of this length and width to the cones beside it [m], which are taken for walls;
  /// negative: it has hit one. Infinite where no lane is beside it. `car` is of the middle between the axles.
  [[nodiscard]] double room(const model::Pose& car, double length, double width) const noexcept;
  /// As an open road along that line: its edges are where the cones are, as wide as the entry lane before the
  /// entry, and wide where there are none.
  [[nodiscard]] Result<road::Track> road() const;

 private:
  std::array<Lane, 3> lanes_;
};

}  // namespace chicane::run
