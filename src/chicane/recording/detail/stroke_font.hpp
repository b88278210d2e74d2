// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace chicane::recording {

/// Calls `stroke(x0, y0, x1, y1)` for each line of a letter: base line at y = 0, top of a capital at 1, y up,
/// width about 0.6. Digits, letters of ASCII (small ones look like capitals) and some signs; nothing for any
/// other.
void for_each_stroke(char letter, const std::function<void(double, double, double, double)>& stroke);

}  // namespace chicane::recording
