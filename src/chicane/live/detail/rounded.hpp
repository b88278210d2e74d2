// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace chicane::live {

/// Three digits behind the point are a millimetre and a millisecond; null for what is not finite.
inline nlohmann::ordered_json rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * 1e3) / 1e3;
}

}  // namespace chicane::live
