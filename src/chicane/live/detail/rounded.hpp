// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace chicane::live {

/// Three digits behind the point are a millimetre and a millisecond. What is not finite is null in JSON.
inline double rounded(double value) { return std::round(value * 1e3) / 1e3; }

}  // namespace chicane::live
