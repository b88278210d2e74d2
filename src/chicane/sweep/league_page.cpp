// SPDX-License-Identifier: MIT
#include "chicane/sweep/league.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/result_table.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep {
namespace {

/// A table as it stands in both kinds of page; the first column is text.
struct LeagueTable {
  std::string title, note;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

std::string cell_text(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "–";
}

/// Mean of what was measured.
class Mean {
 public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    sum_ += value;
    ++count_;
  }
  [[nodiscard]] double value() const { return count_ > 0 ? sum_ / count_ : std::nan(""); }

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

class LeagueTables {
 public:
  LeagueTables(const League& league, const LeagueResults& results) : league_{league}, results_{results} {
    for (const LeagueCell& cell : results.cells)
      if (std::find(entries_.begin(), entries_.end(), cell.entry) == entries_.end())
        entries_.push_back(cell.entry);
    undisturbed_ = league.disturbances.front().first;
  }

  [[nodiscard]] std::vector<LeagueTable> all() const {
    std::vector<LeagueTable> tables{standings()};
    for (const std::string& car : league_.cars)
      for (const std::string& track : league_.tracks) tables.push_back(table_of(track, car));
    tables.push_back(times());
    return tables;
  }

  /// How much longer than the limit [%].
  [[nodiscard]] double gap(const LeagueCell& cell) const {
    const auto bound = results_.bounds.find({cell.track, cell.car});
    if (bound == results_.bounds.end() || !cell.is_clean) return std::nan("");
    return 100.0 * (cell.number("lap_time_s") / bound->second - 1.0);
  }

 private:
  struct Standing {
    std::string entry;
    int clean = 0, tried = 0, disturbed_clean = 0, disturbed = 0;
    Mean gap, error, margin, acceleration, steering, iterations;
  };

  [[nodiscard]] Standing standing_of(const std::string& entry) const {
    Standing standing;
    standing.entry = entry;
    for (const LeagueCell& cell : results_.cells) {
      if (cell.entry != entry) continue;
      const bool is_disturbed = cell.disturbance != undisturbed_;
      ++(is_disturbed ? standing.disturbed : standing.tried);
      if (!cell.is_clean) continue;
      ++(is_disturbed ? standing.disturbed_clean : standing.clean);
      if (is_disturbed) continue;
      standing.gap.add(gap(cell));
      standing.error.add(cell.number("rms_lateral_error_m"));
      standing.margin.add(cell.number("min_edge_distance_m"));
      standing.acceleration.add(cell.number("max_lateral_acceleration_mps2"));
      standing.steering.add(cell.number("steering_rate_rms_radps"));
      if (!cell.is_external) standing.iterations.add(cell.number("mean_iterations"));
    }
    return standing;
  }

  [[nodiscard]] LeagueTable standings() const {
    std::vector<Standing> all;
    for (const std::string& entry : entries_) all.push_back(standing_of(entry));
    std::stable_sort(all.begin(), all.end(), [](const Standing& a, const Standing& b) {
      const double x = a.tried > 0 ? static_cast<double>(a.clean) / a.tried : 0.0;
      const double y = b.tried > 0 ? static_cast<double>(b.clean) / b.tried : 0.0;
      if (x != y) return x > y;
      return std::isfinite(a.gap.value()) && (!std::isfinite(b.gap.value()) || a.gap.value() < b.gap.value());
    });
    LeagueTable table{.title = "Standings",
                      .note =
                          "Most clean first, then by the gap. Means over the tracks and cars on which the "
                          "entry has a clean lap, without disturbance.",
                      .head = {"entry", "clean", "clean, disturbed", "gap to the limit [%]",
                               "rms lateral error [m]", "tyre to edge, least [m]",
                               "lateral acceleration, most [m/s²]", "steering rate [rad/s]", "iterations"},
                      .rows = {}};
    for (const Standing& each : all)
      table.rows.push_back({each.entry, fmt::format("{} of {}", each.clean, each.tried),
                            fmt::format("{} of {}", each.disturbed_clean, each.disturbed),
                            cell_text(each.gap.value(), 1), cell_text(each.error.value(), 2),
                            cell_text(each.margin.value(), 2), cell_text(each.acceleration.value(), 1),
                            cell_text(each.steering.value(), 3), cell_text(each.iterations.value(), 1)});
    return table;
  }

  [[nodiscard]] const LeagueCell* find(const std::string& entry, const std::string& track,
                                       const std::string& car, const std::string& disturbance) const {
    for (const LeagueCell& cell : results_.cells)
      if (cell.entry == entry && cell.track == track && cell.car == car && cell.disturbance == disturbance)
        return &cell;
    return nullptr;
  }

  [[nodiscard]] LeagueTable table_of(const std::string& track, const std::string& car) const {
    const auto bound = results_.bounds.find({track, car});
    LeagueTable table{.title = fmt::format("{} on {}", car, track),
                      .note = bound == results_.bounds.end()
                                  ? std::string("The limit is not known.")
                                  : fmt::format("The limit is {:.2f} s.", bound->second),
                      .head = {"entry", "reference [m/s]", "lap [s]", "gap [%]", "rms lateral error [m]",
                               "tyre to edge [m]", "lateral acceleration [m/s²]", "steering rate [rad/s]"},
                      .rows = {}};
    for (std::size_t i = 1; i < league_.disturbances.size(); ++i)
      table.head.push_back(fmt::format("{}: lap [s]", league_.disturbances[i].first));
    for (const std::string& entry : entries_) {
      const LeagueCell* cell = find(entry, track, car, undisturbed_);
      if (cell == nullptr) continue;
      table.rows.push_back(row_of(*cell));
    }
    return table;
  }

  [[nodiscard]] std::vector<std::string> row_of(const LeagueCell& cell) const {
    std::vector<std::string> row{cell.entry};
    if (cell.is_clean) {
      row.push_back(cell.is_external ? "its own" : cell_text(cell.number(kSearchValue), 1));
      for (const auto& [column, decimals] :
           std::array{std::pair{"lap_time_s", 2}, std::pair{"", 1}, std::pair{"rms_lateral_error_m", 2},
                      std::pair{"min_edge_distance_m", 2}, std::pair{"max_lateral_acceleration_mps2", 1},
                      std::pair{"steering_rate_rms_radps", 3}})
        row.push_back(cell_text(*column == '\0' ? gap(cell) : cell.number(column), decimals));
    } else {
      row.push_back(cell.why);
      row.resize(8, "–");
    }
    for (std::size_t i = 1; i < league_.disturbances.size(); ++i) {
      const LeagueCell* disturbed = find(cell.entry, cell.track, cell.car, league_.disturbances[i].first);
      row.push_back(
          disturbed != nullptr && disturbed->is_clean ? cell_text(disturbed->number("lap_time_s"), 2) : "–");
    }
    return row;
  }

  /// Medians over an entry's runs of the times that a clock measured.
  [[nodiscard]] LeagueTable times() const {
    LeagueTable table{.title = "Times",
                      .note =
                          "Measured on the machine that drove the league, with all else that it did: the "
                          "optimisation of a control step, or from telemetry to the answer of a program, "
                          "its latency included. The median and the 99th percentile of a run; of these "
                          "the median over all runs.",
                      .head = {"entry", "what", "median [µs]", "99 % [µs]", "runs"},
                      .rows = {}};
    for (const std::string& entry : entries_) {
      std::vector<double> median, late;
      bool is_external = false;
      for (const LeagueCell& cell : results_.cells) {
        if (cell.entry != entry) continue;
        is_external = cell.is_external;
        const std::string name = cell.is_external ? "answer_time_us" : "solve_time_us";
        if (!std::isfinite(cell.number(name + ".p50"))) continue;
        median.push_back(cell.number(name + ".p50"));
        late.push_back(cell.number(name + ".p99"));
      }
      const auto middle = [](std::vector<double>& values) {
        if (values.empty()) return std::nan("");
        std::sort(values.begin(), values.end());
        return values[values.size() / 2];
      };
      table.rows.push_back({entry, is_external ? "answer" : "solve", cell_text(middle(median), 0),
                            cell_text(middle(late), 0), fmt::format("{}", median.size())});
    }
    return table;
  }

  const League& league_;
  const LeagueResults& results_;
  std::vector<std::string> entries_;
  std::string undisturbed_;
};

std::string in_words(const League& league, const LeagueResults& results) {
  std::string words = fmt::format("{} runs", results.cells.size());
  if (results.missing > 0) words += fmt::format(", {} of them not driven yet", results.missing);
  if (const auto& search = league.plan.search)
    words += fmt::format(
        "; each of our own controllers at the largest {} from {:g} to {:g}, to within {:g} %, with which all "
        "laps are driven and no tyre leaves the road",
        search->key, search->from, search->to, 100.0 * search->within);
  std::string shared;
  for (const auto& [key, text] : league.plan.fixed)
    shared += fmt::format("{}{}={}", shared.empty() ? "" : ", ", key, text);
  if (!shared.empty()) words += "; all runs: " + shared;
  return words + ".";
}

constexpr std::array kCsvColumns{"search_value",
                                 "search_trials",
                                 "completed",
                                 "laps_completed",
                                 "off_track_events",
                                 "lap_time_s",
                                 "mean_speed_mps",
                                 "top_speed_mps",
                                 "rms_lateral_error_m",
                                 "min_edge_distance_m",
                                 "max_lateral_acceleration_mps2",
                                 "steering_rate_rms_radps",
                                 "mean_iterations",
                                 "not_usable"};

}  // namespace

std::string league_document(const League& league, const LeagueResults& results) {
  using protocol::Json;
  protocol::ReportDocument document("league", league.name);
  document.add_text(in_words(league, results));
  const LeagueTables tables(league, results);
  for (const LeagueTable& table : tables.all()) {
    document.begin_section(table.title);
    document.add_text(table.note);
    document.add_table(table.head, table.rows);
  }
  document.begin_section("Runs");
  document.add_text(
      "Each with the command that drives it; without `--fast` it is driven in the dashboard, at "
      "`http://localhost:4567/`.");
  Json rows = Json::array();
  for (const LeagueCell& cell : results.cells)
    rows.push_back(
        {cell.entry, cell.track, cell.car, cell.disturbance,
         cell.is_clean ? cell_text(cell.number("lap_time_s"), 2) : "–", cell_text(tables.gap(cell), 1),
         Json{{"text", cell.command}, {"is_code", true}, {"remark", cell.is_clean ? "" : cell.why}}});
  document.add_table({"entry", "track", "car", "disturbance", "lap [s]", "gap [%]", "command"},
                     std::move(rows));
  return document.text();
}

std::string league_markdown(const League& league, const LeagueResults& results) {
  const auto line = [](const std::vector<std::string>& cells) {
    std::string text = "|";
    for (const std::string& cell : cells) text += " " + cell + " |";
    return text + "\n";
  };
  std::string page = in_words(league, results) + "\n";
  for (const LeagueTable& table : LeagueTables(league, results).all()) {
    page += fmt::format("\n### {}\n\n{}\n\n{}|---|", table.title, table.note, line(table.head));
    for (std::size_t i = 1; i < table.head.size(); ++i) page += "--:|";
    page += "\n";
    for (const auto& row : table.rows) page += line(row);
  }
  return page;
}

std::string league_csv(const LeagueResults& results) {
  std::string text = "entry,track,car,disturbance,clean,limit_s";
  for (const char* column : kCsvColumns) text += fmt::format(",{}", column);
  text += ",why_not\r\n";
  for (const LeagueCell& cell : results.cells) {
    const auto bound = results.bounds.find({cell.track, cell.car});
    text += fmt::format("{},{},{},{},{},{}", csv_cell(cell.entry), csv_cell(cell.track), csv_cell(cell.car),
                        csv_cell(cell.disturbance), cell.is_clean ? 1 : 0,
                        bound == results.bounds.end() ? "" : number_text(bound->second));
    for (const char* column : kCsvColumns) {
      const double value = cell.number(column);
      text += "," + (std::isfinite(value) ? number_text(value) : std::string());
    }
    text += "," + csv_cell(cell.why) + "\r\n";
  }
  return text;
}

std::string league_json(const LeagueResults& results) {
  using protocol::Json;
  Json list = Json::array();
  for (const LeagueCell& cell : results.cells) {
    Json row{{"entry", cell.entry},
             {"track", cell.track},
             {"car", cell.car},
             {"disturbance", cell.disturbance},
             {"clean", cell.is_clean}};
    const auto bound = results.bounds.find({cell.track, cell.car});
    row["limit_s"] = bound == results.bounds.end() ? Json() : Json(bound->second);
    for (const char* column : kCsvColumns) {
      const double value = cell.number(column);
      row[column] = std::isfinite(value) ? Json(value) : Json();
    }
    row["why_not"] = cell.why;
    list.push_back(std::move(row));
  }
  return protocol::json_text(list, protocol::JsonLayout::kIndented) + "\n";
}

}  // namespace chicane::sweep
