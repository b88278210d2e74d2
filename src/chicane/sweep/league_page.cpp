// SPDX-License-Identifier: MIT
// Page of a league: standings, tables of controllers by track and car, and measured times, as HTML document
// and Markdown.
#include "chicane/sweep/league.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "chicane/base/median.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/result_table.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep {
namespace {

using protocol::Json;

/// Table of the page.
struct LeagueTable {
  std::string title, note;
  ResultTable table;
};

/// Columns of the results in the standings, after the gap. Other programs have no iterations, the last one.
constexpr std::array kFigures{"rms_lateral_error_m", "min_edge_distance_m", "max_lateral_acceleration_mps2",
                              "steering_rate_rms_radps", "mean_iterations"};

/// Maker of the tables of a league's page.
class LeagueTables {
 public:
  LeagueTables(const League& league, const LeagueResults& results) : league_{league}, results_{results} {
    for (const LeagueCell& cell : results.cells)
      if (std::find(entries_.begin(), entries_.end(), cell.entry) == entries_.end())
        entries_.push_back(cell.entry);
    undisturbed_ = league.disturbances.front().first;
  }

  /// All tables in the order of the page.
  [[nodiscard]] std::vector<LeagueTable> all() const {
    std::vector<LeagueTable> tables{standings()};
    for (const std::string& car : league_.cars)
      for (const std::string& track : league_.tracks) tables.push_back(table_of(track, car));
    tables.push_back(times());
    return tables;
  }

  /// Lap time [s]; null if the run is not clean.
  [[nodiscard]] static Json lap_of(const LeagueCell& cell) {
    return cell.is_clean ? Json(cell.number("lap_time_s")) : Json();
  }
  /// Excess of the lap time over the limit [%]; NaN if the run is not clean or the limit is not known.
  [[nodiscard]] double gap(const LeagueCell& cell) const {
    const auto bound = results_.bounds.find({cell.track, cell.car});
    if (bound == results_.bounds.end() || !cell.is_clean) return std::nan("");
    return 100.0 * (cell.number("lap_time_s") / bound->second - 1.0);
  }

 private:
  /// Values of a cell: the gap and kFigures; NaN if not measured.
  [[nodiscard]] std::vector<double> figures_of(const LeagueCell& cell) const {
    std::vector<double> figures{gap(cell)};
    for (const char* column : kFigures) figures.push_back(cell.number(column));
    if (cell.is_external) figures.back() = std::nan("");
    return figures;
  }

  /// Results of an entry over all tracks and cars.
  struct Standing {
    std::string entry;
    int clean = 0, tried = 0;                ///< numbers of clean and of all runs without disturbance
    int disturbed_clean = 0, disturbed = 0;  ///< numbers of clean and of all runs with a disturbance
    std::array<double, kFigures.size() + 1> sums{}, counts{};  ///< of gap and kFigures, if measured

    /// Mean of a figure; NaN if it was measured nowhere.
    [[nodiscard]] double mean(std::size_t i) const { return sums[i] / counts[i]; }
  };

  /// Standing of an entry; sums count clean runs without disturbance.
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
      const std::vector<double> figures = figures_of(cell);
      for (std::size_t i = 0; i < figures.size(); ++i) {
        if (!std::isfinite(figures[i])) continue;
        standing.sums[i] += figures[i];
        ++standing.counts[i];
      }
    }
    return standing;
  }

  /// Table of the standings, the best entry first.
  [[nodiscard]] LeagueTable standings() const {
    std::vector<Standing> all;
    for (const std::string& entry : entries_) all.push_back(standing_of(entry));
    std::stable_sort(all.begin(), all.end(), [](const Standing& a, const Standing& b) {
      const double clean_of_a = a.tried > 0 ? static_cast<double>(a.clean) / a.tried : 0.0;
      const double clean_of_b = b.tried > 0 ? static_cast<double>(b.clean) / b.tried : 0.0;
      if (clean_of_a != clean_of_b) return clean_of_a > clean_of_b;
      return std::isfinite(a.mean(0)) && !(a.mean(0) >= b.mean(0));
    });
    LeagueTable table{
        .title = "Standings",
        .note =
            "Most clean first, then by the gap. Means over the tracks and cars on which the "
            "entry has a clean lap, without disturbance.",
        .table = ResultTable({"entry", "clean{>}", "clean, disturbed{>}", "gap to the limit [%]{>.1}",
                              "rms lateral error [m]{>.2}", "tyre to edge, least [m]{>.2}",
                              "lateral acceleration, most [m/s²]{>.1}", "steering rate [rad/s]{>.3}",
                              "iterations{>.1}"})};
    for (const Standing& each : all) {
      ResultTable::Cells row{each.entry, fmt::format("{} of {}", each.clean, each.tried),
                             fmt::format("{} of {}", each.disturbed_clean, each.disturbed)};
      for (std::size_t i = 0; i < each.sums.size(); ++i) row.emplace_back(each.mean(i));
      table.table.add(std::move(row));
    }
    return table;
  }

  /// Cell of a run; null if the entry has none.
  [[nodiscard]] const LeagueCell* find(const std::string& entry, const std::string& track,
                                       const std::string& car, const std::string& disturbance) const {
    for (const LeagueCell& cell : results_.cells)
      if (cell.entry == entry && cell.track == track && cell.car == car && cell.disturbance == disturbance)
        return &cell;
    return nullptr;
  }

  /// Table of one track and car.
  [[nodiscard]] LeagueTable table_of(const std::string& track, const std::string& car) const {
    const auto bound = results_.bounds.find({track, car});
    std::vector<std::string> columns{"entry",
                                     "reference [m/s]{>.1}",
                                     "lap [s]{>.2}",
                                     "gap [%]{>.1}",
                                     "rms lateral error [m]{>.2}",
                                     "tyre to edge [m]{>.2}",
                                     "lateral acceleration [m/s²]{>.1}",
                                     "steering rate [rad/s]{>.3}"};
    for (std::size_t i = 1; i < league_.disturbances.size(); ++i)
      columns.push_back("=" + league_.disturbances[i].first + ": lap [s]{>.2}");
    ResultTable table(columns);
    for (const std::string& entry : entries_)
      if (const LeagueCell* cell = find(entry, track, car, undisturbed_)) table.add(row_of(*cell));
    return {.title = fmt::format("{} on {}", car, track),
            .note = bound == results_.bounds.end() ? std::string("The limit is not known.")
                                                   : fmt::format("The limit is {:.2f} s.", bound->second),
            .table = std::move(table)};
  }

  /// Row of an entry in the table of a track and car: the run without disturbance, then the laps with each.
  [[nodiscard]] ResultTable::Cells row_of(const LeagueCell& cell) const {
    ResultTable::Cells row{cell.entry, cell.why};
    if (cell.is_clean) {
      row = {cell.entry, cell.is_external ? Json("its own") : Json(cell.number(kSearchValue)), lap_of(cell)};
      for (const double figure : figures_of(cell)) row.emplace_back(figure);
    }
    row.resize(8);  // columns of table_of() before the disturbances
    for (std::size_t i = 1; i < league_.disturbances.size(); ++i) {
      const LeagueCell* disturbed = find(cell.entry, cell.track, cell.car, league_.disturbances[i].first);
      row.push_back(disturbed != nullptr ? lap_of(*disturbed) : Json());
    }
    return row;
  }

  /// Medians over an entry's runs of the times that a clock measured.
  [[nodiscard]] LeagueTable times() const {
    LeagueTable table{
        .title = "Times",
        .note =
            "Measured on the machine that drove the league, with all else that it did: the "
            "optimisation of a control step, or from telemetry to the answer of a program, "
            "its latency included. The median and the 99th percentile of a run; of these "
            "the median over all runs.",
        .table = ResultTable({"entry", "what{>}", "median [µs]{>.0}", "99 % [µs]{>.0}", "runs{>}"})};
    for (const std::string& entry : entries_) {
      std::vector<double> middle, late;
      bool is_external = false;
      for (const LeagueCell& cell : results_.cells) {
        if (cell.entry != entry) continue;
        is_external = cell.is_external;
        const std::string name = cell.is_external ? "answer_time_us" : "solve_time_us";
        const double p50 = cell.number(name + ".p50"), p99 = cell.number(name + ".p99");
        if (!std::isfinite(p50 + p99)) continue;
        middle.push_back(p50);
        late.push_back(p99);
      }
      const auto usual = [](const std::vector<double>& values) {
        return values.empty() ? Json("not measured") : Json(median(values));
      };
      table.table.add({entry, is_external ? "answer" : "solve", usual(middle), usual(late), middle.size()});
    }
    return table;
  }

  const League& league_;
  const LeagueResults& results_;
  std::vector<std::string> entries_;  ///< names of all entries, in the order of the league
  std::string undisturbed_;           ///< name of the first disturbance, which is none
};

/// Sentence about all runs of the league.
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

}  // namespace

std::string league_document(const League& league, const LeagueResults& results) {
  protocol::ReportDocument document("league", league.name);
  document.add_text(in_words(league, results));
  const LeagueTables tables(league, results);
  for (const LeagueTable& each : tables.all()) {
    document.begin_section(each.title);
    document.add_text(each.note);
    each.table.add_to(document);
  }
  document.begin_section("Runs");
  document.add_text(
      "Each with the command that drives it; without `--fast` it is driven in the dashboard, at "
      "`http://localhost:4567/`.");
  ResultTable runs({"entry", "track", "car", "disturbance", "lap [s]{>.2}", "gap [%]{>.1}", "command"});
  for (const LeagueCell& cell : results.cells)
    runs.add({cell.entry, cell.track, cell.car, cell.disturbance, tables.lap_of(cell), tables.gap(cell),
              Json{{"text", cell.command}, {"is_code", true}, {"remark", cell.is_clean ? "" : cell.why}}});
  runs.add_to(document);
  return document.text();
}

std::string league_markdown(const League& league, const LeagueResults& results) {
  std::string page = in_words(league, results) + "\n";
  for (const LeagueTable& each : LeagueTables(league, results).all())
    page += fmt::format("\n### {}\n\n{}\n\n{}", each.title, each.note, each.table.markdown());
  return page;
}

ResultTable league_runs(const League& league, const LeagueResults& results) {
  std::vector<std::string> kept{std::string(kSearchValue), std::string(kSearchTrials)};
  for (const std::string& column : league.plan.keep)
    if (column != "end_reason") kept.push_back(column);
  std::vector<std::string> columns{"entry=", "track=", "car=", "disturbance=", "clean=", "limit_s="};
  for (const std::string& column : kept) columns.push_back(column + "=");
  columns.emplace_back("why_not=");
  ResultTable table(columns);
  for (const LeagueCell& cell : results.cells) {
    ResultTable::Cells row{cell.entry, cell.track, cell.car, cell.disturbance, cell.is_clean, Json()};
    const auto bound = results.bounds.find({cell.track, cell.car});
    if (bound != results.bounds.end()) row.back() = bound->second;
    for (const std::string& column : kept) row.emplace_back(cell.number(column));
    row.emplace_back(cell.why);
    table.add(std::move(row));
  }
  return table;
}

}  // namespace chicane::sweep
