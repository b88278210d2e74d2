// SPDX-License-Identifier: MIT
#include "chicane/sweep/detail/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "chicane/base/text.hpp"

namespace chicane::sweep::detail {
namespace {

using Values = std::set<std::string, ByNumber>;

std::size_t place_in(const std::vector<std::string>& values, const std::string& value) {
  return static_cast<std::size_t>(std::find(values.begin(), values.end(), value) - values.begin());
}

/// The nearest of `values` where all are numbers; the same text otherwise. values.size(): none.
std::size_t nearest_place(const std::vector<std::string>& values, const std::string& wanted) {
  const std::optional<double> number = number_in(wanted);
  std::size_t best = values.size();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::optional<double> value = number_in(values[i]);
    if (!number || !value) continue;
    const double distance = std::fabs(*value - *number);
    if (distance < least) {
      least = distance;
      best = i;
    }
  }
  return best < values.size() ? best : place_in(values, wanted);
}

class MapMaker {
 public:
  MapMaker(const std::vector<std::string>& keys, const std::vector<MapRun>& runs,
           const std::vector<Settings>& marks)
      : keys_{keys}, runs_{runs}, marks_{marks}, values_(keys.size()) {
    for (const MapRun& run : runs)
      for (std::size_t axis = 0; axis < keys.size(); ++axis) values_[axis].insert(run.values[axis]);
  }

  std::vector<HeatMap> all(std::size_t most) {
    std::vector<std::size_t> texts, pairable;
    for (std::size_t axis = 0; axis < keys_.size(); ++axis) {
      if (is_text(axis)) texts.push_back(axis);
      if (values_[axis].size() >= 2 && values_[axis].size() <= most) pairable.push_back(axis);
    }
    std::vector<HeatMap> maps;
    for (const std::vector<std::string>& group : groups_of(texts))
      for (std::size_t i = 0; i < pairable.size(); ++i)
        for (std::size_t j = i + 1; j < pairable.size(); ++j)
          if (!is_text(pairable[i]) && !is_text(pairable[j]))
            maps.push_back(map_of(pairable[i], pairable[j], texts, group));
    for (std::size_t i = 0; i < pairable.size(); ++i)
      for (std::size_t j = i + 1; j < pairable.size(); ++j)
        if (is_text(pairable[i]) || is_text(pairable[j]))
          maps.push_back(map_of(pairable[i], pairable[j], {}, {}));
    return maps;
  }

 private:
  [[nodiscard]] bool is_text(std::size_t axis) const {
    return std::any_of(values_[axis].begin(), values_[axis].end(),
                       [](const std::string& value) { return !number_in(value); });
  }

  /// The combinations of these axes' values, as they come.
  [[nodiscard]] std::vector<std::vector<std::string>> groups_of(const std::vector<std::size_t>& axes) const {
    std::vector<std::vector<std::string>> groups;
    for (const MapRun& run : runs_) {
      std::vector<std::string> group;
      for (const std::size_t axis : axes) group.push_back(run.values[axis]);
      if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(std::move(group));
    }
    return groups;
  }

  [[nodiscard]] HeatMap map_of(std::size_t a, std::size_t b, const std::vector<std::size_t>& group_axes,
                               const std::vector<std::string>& group) const {
    HeatMap map;
    map.title = fmt::format("{}", fmt::join(group, ", "));
    map.row_key = keys_[a];
    map.column_key = keys_[b];
    map.rows.assign(values_[a].begin(), values_[a].end());
    map.columns.assign(values_[b].begin(), values_[b].end());
    map.cells.assign(map.rows.size(), std::vector<HeatMap::Cell>(map.columns.size()));
    for (const MapRun& run : runs_) {
      bool is_here = true;
      for (std::size_t i = 0; i < group.size(); ++i)
        is_here = is_here && run.values[group_axes[i]] == group[i];
      if (!is_here) continue;
      HeatMap::Cell& cell =
          map.cells[place_in(map.rows, run.values[a])][place_in(map.columns, run.values[b])];
      ++cell.runs;
      if (run.is_clean) ++cell.clean;
    }
    for (const Settings& mark : marks_) set_mark(map, mark, group_axes, group);
    return map;
  }

  void set_mark(HeatMap& map, const Settings& mark, const std::vector<std::size_t>& group_axes,
                const std::vector<std::string>& group) const {
    const std::map<std::string, std::string> values(mark.begin(), mark.end());
    for (std::size_t i = 0; i < group.size(); ++i) {
      const auto found = values.find(keys_[group_axes[i]]);
      if (found != values.end() && found->second != group[i]) return;
    }
    const auto row = values.find(map.row_key), column = values.find(map.column_key);
    if (row == values.end() || column == values.end()) return;
    const std::size_t r = nearest_place(map.rows, row->second);
    const std::size_t c = nearest_place(map.columns, column->second);
    if (r < map.rows.size() && c < map.columns.size()) map.cells[r][c].is_marked = true;
  }

  const std::vector<std::string>& keys_;
  const std::vector<MapRun>& runs_;
  const std::vector<Settings>& marks_;
  std::vector<Values> values_;
};

/// How many letters a text takes: continuing bytes of UTF-8 take none.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string to_the_right(const std::string& text, std::size_t width) {
  return std::string(width > width_of(text) ? width - width_of(text) : 0, ' ') + text;
}

}  // namespace

bool ByNumber::operator()(const std::string& a, const std::string& b) const {
  const auto x = number_in(a), y = number_in(b);
  if (x && y) return *x < *y;
  return x.has_value() != y.has_value() ? x.has_value() : a < b;
}

std::vector<HeatMap> heat_maps(const std::vector<std::string>& keys, const std::vector<MapRun>& runs,
                               const std::vector<Settings>& marks, std::size_t most) {
  return MapMaker(keys, runs, marks).all(most);
}

std::string map_text(const HeatMap& map) {
  std::size_t head = 0, width = 5;
  for (const std::string& row : map.rows) head = std::max(head, width_of(row));
  for (const std::string& column : map.columns) width = std::max(width, width_of(column) + 1);
  std::string text = fmt::format("{}{} down, {} across\n", map.title.empty() ? "" : map.title + ": ",
                                 map.row_key, map.column_key);
  text += std::string(head, ' ');
  for (const std::string& column : map.columns) text += to_the_right(column, width) + " ";
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    while (text.back() == ' ') text.pop_back();
    text += "\n" + to_the_right(map.rows[r], head);
    for (const HeatMap::Cell& cell : map.cells[r]) {
      std::string value = cell.runs == 0    ? " "
                          : cell.clean == 0 ? "·"
                                            : fmt::format("{:.0f}", 100.0 * cell.share());
      if (cell.is_marked) value = "[" + value + "]";
      text += to_the_right(value, cell.is_marked ? width + 1 : width) + (cell.is_marked ? "" : " ");
    }
  }
  while (text.back() == ' ') text.pop_back();
  return text + "\n";
}

}  // namespace chicane::sweep::detail
