// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace chicane::survey {

/// Distance from the centre of each cell to that of the nearest one that is not zero [cells], exact
/// (Felzenszwalb and Huttenlocher 2012). A large number where all are zero. Time and memory are proportional
/// to the cells: four bytes each, and two rows.
[[nodiscard]] std::vector<float> distance_field(const std::vector<std::uint8_t>& is_set, int width,
                                                int height);

}  // namespace chicane::survey
