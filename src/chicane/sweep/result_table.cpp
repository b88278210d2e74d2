// SPDX-License-Identifier: MIT
// Results as tables: rows by axis values, comparisons of runs that differ in one setting, and maps of two
// axes.
#include "chicane/sweep/result_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <span>

#include "chicane/base/file.hpp"
#include "chicane/base/text.hpp"
#include "chicane/sweep/result_file.hpp"

namespace chicane::sweep {
namespace {

using protocol::Json;

/// Figures of one run for compare().
struct ComparedRun {
  std::vector<double> laps{};  ///< times [s]
  std::int64_t off = 0;        ///< count of times off the road
  bool is_completed = false;
  std::string reasons{};  ///< reasons of the guard with their numbers of control steps
  std::string error{};    ///< error if it could not be driven; else empty

  [[nodiscard]] bool is_clean() const { return error.empty() && is_completed && off == 0; }
  /// Mean of the first `count` lap times [s].
  [[nodiscard]] double mean(std::size_t count) const {
    return std::accumulate(laps.begin(), laps.begin() + static_cast<std::ptrdiff_t>(count), 0.0) /
           static_cast<double>(count);
  }
  /// First, best and mean lap time, or why there are none.
  [[nodiscard]] std::string laps_text() const {
    if (!error.empty()) return error;
    if (laps.empty()) return "no lap";
    return fmt::format("{:.2f} · {:.2f} · {:.2f}{}", laps.front(),
                       *std::min_element(laps.begin(), laps.end()), mean(laps.size()),
                       is_completed ? "" : fmt::format(" ({} laps)", laps.size()));
  }
};

/// Figures of a line of results.
ComparedRun compared_run(const Json& json) {
  ComparedRun run{.off = json.value("off_track_events", std::int64_t{0}),
                  .is_completed = json.value("completed", false),
                  .error = json.value("error", "")};
  const Json laps = json.value("lap_times_s", Json::array());
  for (const Json& lap : laps)
    if (lap.is_number()) run.laps.push_back(lap.get<double>());
  const Json reasons = json.value("guard_reasons", Json::object());
  for (const auto& [reason, steps] : reasons.items())
    run.reasons +=
        fmt::format("{}`{}` {}", run.reasons.empty() ? "" : ", ", reason, steps.get<std::int64_t>());
  return run;
}

/// Reason why `run` is worse than its twin `other`; empty if it is not.
std::string worse_text(const ComparedRun& run, const ComparedRun& other) {
  if (!other.is_clean()) return "";
  if (!run.error.empty()) return "cannot be driven";
  if (run.off > 0) return "off the road";
  if (!run.is_completed) return "not completed";
  const std::size_t laps = std::min(run.laps.size(), other.laps.size());
  if (laps == 0) return "";
  const double slower = run.mean(laps) / other.mean(laps) - 1.0;
  return slower > kSlower ? fmt::format("{:.1f} % slower", 100.0 * slower) : "";
}

/// Runs in groups of equal settings but for the compared key. A group has the number of its first run.
struct ComparedRuns {
  std::vector<std::string> keys{};  ///< keys of the axes but for the compared one
  /// By group and compared value.
  std::map<std::uint64_t, std::map<std::string, ComparedRun>> by_first_run{};
  std::map<std::vector<std::string>, std::uint64_t> first_run{};  ///< group by the values of `keys`
};

/// Adds the runs of one file.
Result<void> add_results(const std::string& file, const std::string& key, ComparedRuns& found) {
  const auto check = [&](const Header& header) -> Result<void> {
    if (std::find(header.keys.begin(), header.keys.end(), key) != header.keys.end()) return {};
    return fail(
        refusal("--compare", key, fmt::format("an axis of the sweep: {}", fmt::join(header.keys, ", "))));
  };
  const auto add = [&](std::uint64_t run, const Json& json) -> Result<void> {
    try {
      std::vector<std::string> common, keys;
      std::string value;
      for (const auto& [name, setting] : json.at("settings").items()) {
        if (name != key) keys.push_back(name);
        if (name != key) common.push_back(plain_text(setting));
        if (name == key) value = plain_text(setting);
      }
      if (found.keys.empty()) found.keys = keys;
      const auto first = found.first_run.emplace(std::move(common), run).first;
      found.by_first_run[first->second][value] = compared_run(json);
    } catch (const Json::exception&) {
      return fail(ErrorCode::kParse,
                  fmt::format("got {}, expected results", printable(protocol::json_text(json))));
    }
    return {};
  };
  return read_runs(file, check, add);
}

/// Text as a value of RFC 4180, with quotes if needed.
std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// JSON value as a value of RFC 4180; empty for null.
std::string cell_of(const Json& value) { return value.is_null() ? "" : csv_cell(plain_text(value)); }

/// Table of a comparison, without rows.
ResultTable empty_table(const ComparedRuns& found, const std::string& key, const std::string& value) {
  std::vector<std::string> columns;
  for (const std::string& each : found.keys) columns.push_back("=" + each + "{}");
  const std::string with = "=with " + value + "{>}";
  columns.insert(columns.end(), {"=" + key + "{}", "laps [s]: first · best · mean{>}", with,
                                 "off the road{>}", with, "the guard found", "worse"});
  return ResultTable(columns);
}

/// Cell for people: a text; an object stays as it is.
Json shown_cell(const Json& cell, const std::string& decimals) {
  if (cell.is_null()) return "–";
  if (cell.is_number_float()) return fmt::format(fmt::runtime("{:" + decimals + "f}"), cell.get<double>());
  return cell.is_object() ? cell : Json(plain_text(cell));
}

/// Number of letters in a text of UTF-8: its bytes but for continuation bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

/// Cell for programs.
std::string csv_text(const Json& cell) {
  if (cell.is_boolean()) return cell.get<bool>() ? "1" : "0";
  return cell.is_number() ? number_text(cell.get<double>()) : cell_of(cell);
}

}  // namespace

ResultTable::ResultTable(const std::vector<std::string>& columns) {
  for (std::size_t place = 0; place < columns.size(); ++place) {
    const std::string& text = columns[place];
    const std::size_t equals = text.find('='), brace = std::min(text.rfind('{'), text.size());
    const std::string format = brace < text.size() ? text.substr(brace + 1, text.size() - brace - 2) : "";
    const std::size_t title = equals + 1, point = std::min(format.find('.'), format.size());  // npos + 1 is 0
    Column column{text.substr(0, title == 0 ? 0 : equals), text.substr(title, brace - title),
                  format.substr(0, point), format.substr(point), place};
    column.width = width_of(column.title);
    if (column.key.empty() || !column.title.empty()) for_people_.push_back(column);
    if (!column.key.empty()) for_programs_.push_back(column);
  }
}

void ResultTable::add(Cells cells) {
  for (Json& cell : cells)
    if (cell.is_number() && !std::isfinite(cell.get<double>())) cell = Json();
  for (Column& column : for_people_)
    if (const Json shown = shown_cell(cells[column.place], column.decimals); shown.is_string())
      column.width = std::max(column.width, width_of(shown.get<std::string>()));
  rows_.push_back(std::move(cells));
}

std::string ResultTable::lines(std::size_t shared, std::string_view begin, std::string_view rule,
                               std::string (*write)(const Column&, const std::string&)) const {
  const auto line = [&](std::span<const Column> columns, const auto& cell_of) {
    std::string cells(begin);
    for (const Column& column : columns) cells += write(column, cell_of(column));
    return cells.substr(0, cells.find_last_not_of(' ') + 1) + '\n';
  };
  const std::span columns(for_people_);
  const auto title_of = [](const Column& column) { return column.title; };
  std::string above, text = line(columns.subspan(shared), title_of).append(rule);
  for (const Cells& row : rows_) {
    const auto cell_of = [&](const Column& column) { return shown_cell(row[column.place], column.decimals); };
    if (shared > 0 && line(columns.first(shared), cell_of) != above)
      text += above = line(columns.first(shared), cell_of);
    text += line(columns.subspan(shared), cell_of);
  }
  return text;
}

std::string ResultTable::text() const {
  constexpr std::size_t kMostWide = 81;  // columns of a terminal, and the blank after the last cell
  std::size_t wide = 0, shared = 0;
  for (const Column& column : for_people_) wide += column.width + 1;
  for (; wide > kMostWide && shared + 1 < for_people_.size(); ++shared) wide -= for_people_[shared].width + 1;
  return lines(shared, "", "", [](const Column& column, const std::string& cell) {
    return fmt::format(fmt::runtime("{:" + column.alignment + "{}} "), cell, column.width);
  });
}

std::string ResultTable::markdown() const {
  std::string rule = "|";
  for (const Column& column : for_people_) rule += column.alignment.starts_with('>') ? "--:|" : "---|";
  return lines(0, "|", rule + "\n", [](const Column&, const std::string& cell) {
    return cell.empty() ? " |" : " " + cell + " |";
  });
}

std::string ResultTable::csv() const {
  std::string text;
  for (const Column& column : for_programs_) text += (text.empty() ? "" : ",") + csv_cell(column.key);
  for (const Cells& row : rows_)
    for (const Column& column : for_programs_)
      text += (column.place == for_programs_.front().place ? "\r\n" : ",") + csv_text(row[column.place]);
  return text + "\r\n";
}

Json ResultTable::json() const {
  Json rows = Json::array();
  for (const Cells& row : rows_) {
    Json& object = rows.emplace_back(Json::object());
    for (const Column& column : for_programs_) object[column.key] = row[column.place];
  }
  return rows;
}

void ResultTable::add_to(protocol::ReportDocument& document) const {
  std::vector<std::string> titles;
  Json rows(rows_.size(), Json::array());
  for (const Column& column : for_people_) {
    titles.push_back(column.title);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      rows[i].push_back(shown_cell(rows_[i][column.place], column.decimals));
  }
  document.add_table(titles, std::move(rows));
}

Result<void> write_csv(const std::string& results, const std::string& csv) {
  FileWriter out(csv);
  Header columns;
  const auto write_head = [&](const Header& header) -> Result<void> {
    columns = header;
    std::string row = "run";
    for (const std::string& key : header.keys) row += ',' + cell_of(key);
    for (const std::string& column : header.columns) row += ',' + cell_of(column);
    out.write(row + ",error\r\n");
    return {};
  };
  const auto write_run = [&](std::uint64_t number, const Json& run) -> Result<void> {
    const Json settings = run.value("settings", Json::object());
    std::string row = std::to_string(number);
    for (const std::string& key : columns.keys) row += ',' + cell_of(settings.value(key, Json()));
    for (const std::string& column : columns.columns) row += ',' + cell_of(run.value(column, Json()));
    out.write(row + ',' + cell_of(run.value("error", Json())) + "\r\n");
    return out.check();
  };
  const Result<void> read = read_runs(results, write_head, write_run);
  return read ? out.finish() : fail(read.error());
}

Result<Comparison> compare(const std::vector<std::string>& results, const std::string& key,
                           const std::string& value) {
  ComparedRuns found;
  for (const std::string& file : results)
    if (const Result<void> added = add_results(file, key, found); !added) return fail(added.error());
  std::map<std::uint64_t, const std::vector<std::string>*> names;
  for (const auto& [common, run] : found.first_run) names[run] = &common;
  Comparison comparison{.table = empty_table(found, key, value)};
  for (const auto& [first, runs] : found.by_first_run) {
    const auto other = runs.find(value);
    if (other == runs.end() || runs.size() == 1) {
      ++comparison.missing;
      continue;
    }
    for (const auto& [mine, run] : runs) {
      if (mine == value) continue;
      const std::string worse = worse_text(run, other->second);
      ++comparison.pairs;
      if (!worse.empty()) ++comparison.worse;
      std::vector<Json> row;
      for (const std::string& name : *names[first]) row.emplace_back("`" + name + "`");
      row.insert(row.end(), {mine, run.laps_text(), other->second.laps_text(), run.off, other->second.off,
                             run.reasons, worse.empty() ? "" : "**" + worse + "**"});
      comparison.table.add(std::move(row));
    }
  }
  return comparison;
}

}  // namespace chicane::sweep

namespace chicane::sweep::detail {
namespace {

using Values = std::set<std::string, ByNumber>;

/// Index of a value; values.size() if there is none.
std::size_t place_in(const std::vector<std::string>& values, const std::string& value) {
  return static_cast<std::size_t>(std::find(values.begin(), values.end(), value) - values.begin());
}

/// Index of the number nearest to `wanted`, or of the same text if there are no numbers; values.size() if
/// there is none.
std::size_t nearest_place(const std::vector<std::string>& values, const std::string& wanted) {
  const std::optional<double> number = number_in(wanted);
  const auto distance = [&](const std::string& value) {
    const std::optional<double> there = number_in(value);
    return number && there ? std::fabs(*there - *number) : std::numeric_limits<double>::infinity();
  };
  const auto best = std::min_element(values.begin(), values.end(),
                                     [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  return place_in(values, best != values.end() && std::isfinite(distance(*best)) ? *best : wanted);
}

/// Maker of the heat maps of one set of runs.
class MapMaker {
 public:
  MapMaker(const std::vector<std::string>& keys, const std::vector<MapRun>& runs,
           const std::vector<Settings>& marks)
      : keys_{keys}, runs_{runs}, marks_{marks}, values_(keys.size()) {
    for (const MapRun& run : runs)
      for (std::size_t axis = 0; axis < keys.size(); ++axis) values_[axis].insert(run.values[axis]);
  }

  /// All maps, of axes with at most `most` values.
  std::vector<HeatMap> all(std::size_t most) {
    std::vector<std::size_t> texts, pairable;
    for (std::size_t axis = 0; axis < keys_.size(); ++axis) {
      if (is_text(axis)) texts.push_back(axis);
      if (values_[axis].size() >= 2 && values_[axis].size() <= most) pairable.push_back(axis);
    }
    std::vector<HeatMap> maps;
    const auto add_pairs = [&](bool have_text, const auto& group_axes, const auto& group) {
      for (std::size_t i = 0; i < pairable.size(); ++i)
        for (std::size_t j = i + 1; j < pairable.size(); ++j)
          if ((is_text(pairable[i]) || is_text(pairable[j])) == have_text)
            maps.push_back(map_of(pairable[i], pairable[j], group_axes, group));
    };
    for (const std::vector<std::string>& group : groups_of(texts)) add_pairs(false, texts, group);
    add_pairs(true, std::vector<std::size_t>{}, std::vector<std::string>{});
    return maps;
  }

 private:
  /// Whether an axis has a value that is no number.
  [[nodiscard]] bool is_text(std::size_t axis) const {
    return std::any_of(values_[axis].begin(), values_[axis].end(),
                       [](const std::string& value) { return !number_in(value); });
  }

  /// Combinations of the values of some axes, in the order of the runs.
  [[nodiscard]] std::vector<std::vector<std::string>> groups_of(const std::vector<std::size_t>& axes) const {
    std::vector<std::vector<std::string>> groups;
    for (const MapRun& run : runs_) {
      std::vector<std::string> group;
      for (const std::size_t axis : axes) group.push_back(run.values[axis]);
      if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(std::move(group));
    }
    return groups;
  }

  /// Map of the axes `a` (rows) and `b`, of the runs whose values on `group_axes` are `group`.
  [[nodiscard]] HeatMap map_of(std::size_t a, std::size_t b, const std::vector<std::size_t>& group_axes,
                               const std::vector<std::string>& group) const {
    HeatMap map{.title = fmt::format("{}", fmt::join(group, ", ")),
                .row_key = keys_[a],
                .column_key = keys_[b],
                .rows = {values_[a].begin(), values_[a].end()},
                .columns = {values_[b].begin(), values_[b].end()}};
    map.cells.assign(map.rows.size(), std::vector<HeatMap::Cell>(map.columns.size()));
    for (const MapRun& run : runs_) {
      const auto has_value = [&](std::size_t axis, const std::string& value) {
        return run.values[axis] == value;
      };
      if (!std::equal(group_axes.begin(), group_axes.end(), group.begin(), group.end(), has_value)) continue;
      HeatMap::Cell& cell =
          map.cells[place_in(map.rows, run.values[a])][place_in(map.columns, run.values[b])];
      ++cell.runs;
      if (run.is_clean) ++cell.clean;
    }
    for (const Settings& mark : marks_) set_mark(map, mark, group_axes, group);
    return map;
  }

  /// Marks a cell, if the mark is in the group of the map.
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
  std::vector<Values> values_;  ///< values of each axis
};

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
  std::size_t head = 0, width = 5;  // of the rows' values, and of a column: "[100]" at least
  for (const std::string& row : map.rows) head = std::max(head, width_of(row));
  for (const std::string& column : map.columns) width = std::max(width, width_of(column) + 1);
  std::string text = fmt::format("{}{} down, {} across\n{:{}}", map.title.empty() ? "" : map.title + ": ",
                                 map.row_key, map.column_key, "", head);
  for (const std::string& column : map.columns) text += fmt::format("{:>{}} ", column, width);
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    while (text.back() == ' ') text.pop_back();
    text += fmt::format("\n{:>{}}", map.rows[r], head);
    for (const HeatMap::Cell& cell : map.cells[r]) {
      std::string value = cell.runs == 0    ? " "
                          : cell.clean == 0 ? "·"
                                            : fmt::format("{:.0f}", 100.0 * cell.share());
      if (cell.is_marked) value = "[" + value + "]";
      text += fmt::format("{:>{}}{}", value, cell.is_marked ? width + 1 : width, cell.is_marked ? "" : " ");
    }
  }
  while (text.back() == ' ') text.pop_back();
  return text + "\n";
}

}  // namespace chicane::sweep::detail
