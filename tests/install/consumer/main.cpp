// SPDX-License-Identifier: MIT
#include <chicane/base/math.hpp>
#include <chicane/road/path.hpp>
#include <chicane/version.hpp>
#include <cstdio>
#include <vector>

static_assert(chicane::kVersionMajor == 0 && chicane::kVersionMinor >= 2);

/// Uses a header and a compiled part of two modules: a path through three points knows its length.
int main() {
  const std::vector<chicane::Vec2> points{{0.0, 0.0}, {50.0, 0.0}, {100.0, 0.0}};
  const auto path = chicane::road::Path::create(points, false);
  if (!path) return 1;
  std::printf("length %.1f m, sin(1) = %.17g\n", path->length(), chicane::sin(1.0));
  return path->length() > 99.0 && path->length() < 101.0 ? 0 : 1;
}
