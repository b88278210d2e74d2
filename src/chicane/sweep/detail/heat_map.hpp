// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "chicane/sweep/plan.hpp"

namespace chicane::sweep::detail {

/// Orders numbers as numbers, and texts behind them.
struct ByNumber {
  [[nodiscard]] bool operator()(const std::string& a, const std::string& b) const;
};

/// A run as a map sees it.
struct MapRun {
  std::vector<std::string> values{};  ///< of the axes, in intervals where they are many
  bool is_clean = false;
};

/// The share of clean runs over two axes.
struct HeatMap {
  struct Cell {
    std::uint64_t runs = 0, clean = 0;
    bool is_marked = false;
    [[nodiscard]] double share() const { return static_cast<double>(clean) / static_cast<double>(runs); }
  };
  std::string title{};  ///< the values of axes that are texts: "weighted, udacity"; empty: all runs
  std::string row_key{}, column_key{};
  std::vector<std::string> rows{}, columns{};
  std::vector<std::vector<Cell>> cells{};  ///< by row and column; no runs: nothing was driven there
};

/// One map for each pair of axes of numbers and each combination of values of the others, which are texts;
/// then one over all runs for each pair with an axis of texts. Axes of one value, or of more than `most`,
/// have none. `marks`: places to be marked, by values of axes; the nearest value of an axis of numbers
/// counts.
[[nodiscard]] std::vector<HeatMap> heat_maps(const std::vector<std::string>& keys,
                                             const std::vector<MapRun>& runs,
                                             const std::vector<Settings>& marks, std::size_t most);

/// In letters of equal width: `·` where no run is clean, `[ ]` around what is marked.
[[nodiscard]] std::string map_text(const HeatMap& map);

}  // namespace chicane::sweep::detail
