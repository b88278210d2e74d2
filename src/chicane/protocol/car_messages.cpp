// SPDX-License-Identifier: MIT
#include "chicane/protocol/car_messages.hpp"

#include "chicane/base/math.hpp"

namespace chicane::protocol {

PathMessage path_along(std::int64_t stamp, const std::string& frame, std::span<const Vec2> line) {
  PathMessage path{.stamp = stamp, .frame = frame};
  path.poses.reserve(line.size());
  double heading = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (i + 1 < line.size()) {
      const Vec2 ahead = line[i + 1] - line[i];
      heading = chicane::atan2(ahead.y(), ahead.x());
    }
    path.poses.push_back({stamp, frame, {line[i].x(), line[i].y(), heading}});
  }
  return path;
}

}  // namespace chicane::protocol
