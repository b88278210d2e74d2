// SPDX-License-Identifier: MIT
#include "chicane/protocol/circle_track.hpp"

#include <charconv>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"

namespace chicane::protocol {

Result<TrackFile> parse_circle_track(std::string_view text, const std::string& file,
                                     const TrackReadOptions& options) {
  double radius = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), radius);
  if (!(radius >= 10.0 && radius <= 1000.0)) {
    return fail(ErrorCode::kParse,
                file + ":1: radius: got " + printable(text) + ", expected a number in [10, 1000] m");
  }
  TrackFile road{.file = file, .points = {}, .lines = {}, .options = {}, .warnings = {}};
  for (int i = 0; i < 60; ++i) {
    const double angle = kTwoPi * i / 60.0;
    road.points.push_back(
        {Vec2{radius * cos(angle), radius * sin(angle)}, options.default_left, options.default_right});
    road.lines.push_back(1);
  }
  return road;
}

}  // namespace chicane::protocol
