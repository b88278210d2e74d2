// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace chicane::controller {

/// How long something has not been there that was. One thread; allocates nothing.
struct Absence {
  double longest;      ///< that is borne [s]
  double since = 0.0;  ///< last there [s]
  bool was_there = false;
  bool is_long = false;

  void note(bool is_there, double time) noexcept {
    if (is_there) since = time;
    was_there = was_there || is_there;
    is_long = was_there && std::isfinite(time) && time - since > longest;
  }
  void reset() noexcept { *this = {.longest = longest}; }
};

}  // namespace chicane::controller
