// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "chicane/protocol/json.hpp"

namespace chicane::live {

/// Three digits behind the point are a millimetre and a millisecond. What is not finite is null in JSON.
inline double rounded(double value) { return std::round(value * 1e3) / 1e3; }

/// {"time_s": [...], ...} of `rows`, each an array of numbers in the order of `names`; every `stride`-th one
/// and the last.
template <std::size_t kCount, class Rows>
protocol::Json columns(const std::array<const char*, kCount>& names, const Rows& rows,
                       std::size_t stride = 1) {
  protocol::Json all = protocol::Json::object();
  for (std::size_t column = 0; column < kCount; ++column) {
    protocol::Json& values = all[names[column]] = protocol::Json::array();
    for (std::size_t row = 0; row < rows.size(); ++row)
      if (row % stride == 0 || row + 1 == rows.size()) values.push_back(rounded(rows[row][column]));
  }
  return all;
}

}  // namespace chicane::live
