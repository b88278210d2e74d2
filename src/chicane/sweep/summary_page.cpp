// SPDX-License-Identifier: MIT
// Summary of a sweep (result_table.hpp): groups of runs, tables and heat maps, as HTML document and Markdown.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "chicane/base/file.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/sweep/result_file.hpp"
#include "chicane/sweep/result_table.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep {
namespace {

using detail::ByNumber;
using protocol::ReportDocument;
using json = protocol::Json;

constexpr std::size_t kMostValues = 60;  // values of an axis in a table; more become intervals; chosen
constexpr int kMostBins = 12;            // limit of these intervals: fits a map on a screen; chosen
constexpr int kFewestBins = 4;           // least number of these intervals; chosen
constexpr double kRunsInCell = 10.0;     // wanted runs in a cell of a map: shares to 10 %
constexpr std::size_t kMostMaps = 60;    // limit of maps on a page; chosen

/// Column of the tables, if the sweep has kept it.
struct Shown {
  const char *column, *title;  ///< name in the results, and title
  bool is_low_good;            ///< tables show the mean; of other columns the least value
};
constexpr std::array kShown{Shown{"search_value", "largest clean value", false},
                            Shown{"lap_time_s", "last lap [s]", true},
                            Shown{"rms_lateral_error_m", "rms lateral error [m]", true},
                            Shown{"min_edge_distance_m", "tyre to edge, least [m]", false},
                            Shown{"off_track_events", "times off the road", true},
                            Shown{"steering_rate_rms_radps", "steering rate [rad/s]", true},
                            Shown{"max_lateral_acceleration_mps2", "lateral acceleration, most [m/s²]", true},
                            Shown{"mean_iterations", "iterations", true}};

/// Run of the sweep.
struct Run {
  std::uint64_t number = 0;
  std::vector<std::string> values;              ///< values of the axes
  std::array<double, kShown.size()> numbers{};  ///< values of kShown; NaN: not known
  bool is_clean = false;  ///< no tyre off the road, and all laps driven if the settings have a number of laps
  std::string error;      ///< reason why it cannot be driven; else empty
};

/// Statistics of a group of runs.
struct Group {
  std::uint64_t runs = 0, clean = 0;                          ///< number of runs, and of clean ones
  std::array<double, kShown.size()> sums{}, least{}, most{};  ///< of the known values of kShown
  std::array<std::uint64_t, kShown.size()> counts{};          ///< numbers of known values of kShown

  void add(const Run& run) {
    ++runs;
    if (run.is_clean) ++clean;
    for (std::size_t i = 0; i < kShown.size(); ++i) {
      if (!std::isfinite(run.numbers[i])) continue;
      least[i] = counts[i] == 0 ? run.numbers[i] : std::min(least[i], run.numbers[i]);
      most[i] = counts[i] == 0 ? run.numbers[i] : std::max(most[i], run.numbers[i]);
      sums[i] += run.numbers[i];
      ++counts[i];
    }
  }
  [[nodiscard]] double clean_share() const {
    return static_cast<double>(clean) / static_cast<double>(std::max<std::uint64_t>(runs, 1));
  }
};

/// Number with four digits; a dash if it is not known.
std::string figure(double value) { return std::isfinite(value) ? number_text(value, 4) : "–"; }

/// Results of a sweep, and the pages about them.
class Page {
 public:
  /// Reads the files of all parts. A run that comes twice counts once.
  Result<void> read(const std::vector<std::string>& files) {
    std::vector<bool> seen;
    for (const std::string& file : files) {
      const auto begin = [&](const Header& header) -> Result<void> {
        if (seen.empty()) {
          header_ = header;
          seen.resize(header.runs);
        } else if (header.plan != header_.plan) {
          return fail(ErrorCode::kInvalidArgument,
                      fmt::format("{}: got another plan than {}", file, files.front()));
        }
        return {};
      };
      const auto take = [&](std::uint64_t run, const json& line) -> Result<void> {
        if (run >= seen.size()) return fail(ErrorCode::kParse, "got a run that is none of the plan's");
        if (!seen[run]) add(run, line);
        seen[run] = true;
        return {};
      };
      if (Result<void> read = read_runs(file, begin, take); !read) return read;
    }
    std::sort(runs_.begin(), runs_.end(), [](const Run& a, const Run& b) { return a.number < b.number; });
    return {};
  }

  [[nodiscard]] std::uint64_t runs() const { return runs_.size(); }
  [[nodiscard]] const std::string& name() const { return header_.name; }

  /// Text for a page of docs/: number of runs, and the maps of numbers as text.
  [[nodiscard]] std::string markdown() {
    bin_values();
    std::string page = fmt::format("{} runs", runs_.size());
    for (std::size_t i = 0; i < header_.fixed.size(); ++i)
      page += fmt::format("{}`{}={}`", i == 0 ? ", all with " : ", ", header_.fixed[i].first,
                          header_.fixed[i].second);
    const auto failed =
        std::count_if(runs_.begin(), runs_.end(), [](const Run& run) { return !run.error.empty(); });
    page += fmt::format(". {} are clean{}.\n\n```text\n", clean_runs(),
                        failed > 0 ? fmt::format(", {} cannot be driven", failed) : "");
    for (const detail::HeatMap& map : maps()) {
      const bool is_of_numbers = number_in(map.rows.back()) && number_in(map.columns.back());
      if (is_of_numbers) page += detail::map_text(map) + "\n";
    }
    return page + "```\n";
  }

  /// HTML document of the summary, as protocol/json.hpp has it.
  [[nodiscard]] std::string document() {
    ReportDocument document("sweep", header_.name);
    document.add_text(fmt::format(
        "{} of {} runs, {} clean (all laps driven, no tyre off the road). Plan {}, {}, {} arithmetic.",
        runs_.size(), header_.runs, clean_runs(), header_.plan, header_.program, header_.arithmetic));
    std::string shared;
    for (const auto& [key, value] : header_.fixed) shared += fmt::format(" `{}={}`", key, value);
    if (!shared.empty()) document.add_text("All runs:" + shared);
    bin_values();
    document.begin_section("Along each axis");
    for (std::size_t axis = 0; axis < header_.keys.size(); ++axis) add_table(document, axis);
    add_maps(document);
    document.begin_section("Distributions");
    for (std::size_t i = 0; i < kShown.size(); ++i) add_histogram(document, i);
    add_listing(document);
    return document.text();
  }

 private:
  [[nodiscard]] std::size_t clean_runs() const {
    return static_cast<std::size_t>(
        std::count_if(runs_.begin(), runs_.end(), [](const Run& run) { return run.is_clean; }));
  }

  /// Adds the run of a line.
  void add(std::uint64_t number, const json& line) {
    Run run;
    run.number = number;
    const json settings = line.value("settings", json::object());
    for (const std::string& key : header_.keys) run.values.push_back(plain_text(settings.value(key, json())));
    for (std::size_t i = 0; i < kShown.size(); ++i) {
      const json value = line.value(kShown[i].column, json());
      run.numbers[i] = value.is_number() ? value.get<double>() : std::nan("");
    }
    run.error = line.value("error", "");
    const bool is_done = !wants_laps(run) || line.value("completed", true);
    run.is_clean = run.error.empty() && is_done && line.value("off_track_events", 0) == 0;
    runs_.push_back(std::move(run));
  }

  /// Whether the settings of a run have a number of laps.
  [[nodiscard]] bool wants_laps(const Run& run) const {
    std::string laps;
    for (const auto& [key, value] : header_.fixed)
      if (key == "laps") laps = value;
    for (std::size_t axis = 0; axis < header_.keys.size(); ++axis)
      if (header_.keys[axis] == "laps") laps = run.values[axis];
    return laps != "0";
  }

  /// Number of intervals on each of two axes that leaves kRunsInCell runs to a cell.
  static int bins_for(std::size_t runs) {
    return std::clamp(static_cast<int>(std::sqrt(static_cast<double>(runs) / kRunsInCell)), kFewestBins,
                      kMostBins);
  }

  /// Fills binned_: divides the range of an axis with more than kMostValues numbers into equal intervals.
  void bin_values() {
    binned_.assign(runs_.size(), {});
    const int bins = bins_for(runs_.size());
    for (std::size_t axis = 0; axis < header_.keys.size(); ++axis) {
      std::map<std::string, int, ByNumber> values;
      double low = std::numeric_limits<double>::infinity(), high = -low;
      bool are_numbers = true;
      for (const Run& run : runs_) {
        if (values.size() <= kMostValues) ++values[run.values[axis]];
        const auto number = number_in(run.values[axis]);
        are_numbers = are_numbers && number;
        if (number) low = std::min(low, *number), high = std::max(high, *number);
      }
      const bool is_binned = values.size() > kMostValues && are_numbers && high > low;
      for (std::size_t i = 0; i < runs_.size(); ++i) {
        std::string value = runs_[i].values[axis];
        if (is_binned) {
          const double width = (high - low) / bins;
          const int bin = std::min(bins - 1, static_cast<int>((*number_in(value) - low) / width));
          value = number_text(low + (bin + 0.5) * width, 3);
        }
        binned_[i].push_back(std::move(value));
      }
    }
  }

  /// Whether the results have column `i` of kShown.
  [[nodiscard]] bool is_kept(std::size_t i) const {
    return std::find(header_.columns.begin(), header_.columns.end(), kShown[i].column) !=
           header_.columns.end();
  }

  /// Titles `first`, then the titles of the kept columns.
  [[nodiscard]] std::vector<std::string> with_columns(std::vector<std::string> first) const {
    for (std::size_t i = 0; i < kShown.size(); ++i)
      if (is_kept(i)) first.emplace_back(kShown[i].title);
    return first;
  }

  /// Table with a row for each value of an axis.
  void add_table(ReportDocument& document, std::size_t axis) const {
    std::map<std::string, Group, ByNumber> groups;
    for (std::size_t i = 0; i < runs_.size() && groups.size() <= kMostValues; ++i)
      groups[binned_[i][axis]].add(runs_[i]);
    json rows = json::array();
    for (const auto& [value, group] : groups) {
      json row{value, std::to_string(group.runs),
               json{{"text", fmt::format("{:.0f} %", 100.0 * group.clean_share())},
                    {"share", group.clean_share()}}};
      for (std::size_t i = 0; i < kShown.size(); ++i) {
        if (!is_kept(i)) continue;
        const double mean =
            group.counts[i] > 0 ? group.sums[i] / static_cast<double>(group.counts[i]) : std::nan("");
        row.push_back({{"text", figure(kShown[i].is_low_good ? mean : group.least[i])},
                       {"hint", fmt::format("{} to {}", figure(group.least[i]), figure(group.most[i]))}});
      }
      rows.push_back(std::move(row));
    }
    document.add_table(with_columns({header_.keys[axis], "runs", "clean"}), std::move(rows));
  }

  /// Section of the heat maps.
  void add_maps(ReportDocument& document) const {
    const std::vector<detail::HeatMap> all = maps();
    if (all.empty()) return;
    document.begin_section(header_.marks.empty()
                               ? "Clean runs over pairs of axes [%]"
                               : "Clean runs over pairs of axes [%]; framed: what is marked");
    for (const detail::HeatMap& map : all) {
      std::vector<std::string> columns{fmt::format("{} \\ {}", map.row_key, map.column_key)};
      columns.insert(columns.end(), map.columns.begin(), map.columns.end());
      json rows = json::array();
      for (std::size_t r = 0; r < map.rows.size(); ++r) {
        json row{map.rows[r]};
        for (const detail::HeatMap::Cell& cell : map.cells[r])
          row.push_back(cell.runs == 0 ? json("")
                                       : json{{"text", fmt::format("{:.0f}", 100.0 * cell.share())},
                                              {"share", cell.share()},
                                              {"is_marked", cell.is_marked},
                                              {"hint", fmt::format("{} runs{}", cell.runs,
                                                                   cell.is_marked ? ", marked" : "")}});
        rows.push_back(std::move(row));
      }
      document.add_grid(map.title, columns, std::move(rows));
    }
  }

  /// Heat maps of the runs that could be driven; the first kMostMaps.
  [[nodiscard]] std::vector<detail::HeatMap> maps() const {
    std::vector<detail::MapRun> runs;
    for (std::size_t i = 0; i < runs_.size(); ++i)
      if (runs_[i].error.empty()) runs.push_back({binned_[i], runs_[i].is_clean});
    std::vector<detail::HeatMap> maps = detail::heat_maps(header_.keys, runs, header_.marks, kMostValues);
    if (maps.size() > kMostMaps) maps.resize(kMostMaps);
    return maps;
  }

  /// Histogram of one column.
  void add_histogram(ReportDocument& document, std::size_t column) const {
    std::vector<double> values;
    for (const Run& run : runs_)
      if (std::isfinite(run.numbers[column])) values.push_back(run.numbers[column]);
    if (values.size() < 2) return;
    std::sort(values.begin(), values.end());
    const double low = values.front(), high = values.back();
    if (high <= low) return;
    constexpr int kBars = 24;  // chosen
    const double width = (high - low) / kBars;
    std::vector<double> bars;  // four numbers each: left end, bottom, width, height
    for (int i = 0; i < kBars; ++i)
      for (const double number : {low + i * width, 0.0, width, 0.0}) bars.push_back(number);
    for (const double value : values)
      ++bars[4 * static_cast<std::size_t>(std::min(kBars - 1, static_cast<int>((value - low) / width))) + 3];
    document.begin_chart(fmt::format("runs by {}: {} to {}, median {}", kShown[column].title, figure(low),
                                     figure(high), figure(values[values.size() / 2])),
                         kShown[column].title);
    document.add_series("cells", "soft", "", bars);
  }

  /// Settings that drive a run again; with a search the largest clean value.
  [[nodiscard]] Settings settings_of(const Run& run) const {
    Settings varied;
    for (std::size_t axis = 0; axis < header_.keys.size(); ++axis)
      varied.emplace_back(header_.keys[axis], run.values[axis]);
    Settings settings = header_.fixed;
    for (auto& setting : expanded(varied, header_.cases)) settings.push_back(std::move(setting));
    if (!header_.search_key.empty() && std::isfinite(run.numbers[0]))
      settings.emplace_back(header_.search_key, number_text(run.numbers[0]));
    return settings;
  }

  /// Section of the runs with their commands.
  void add_listing(ReportDocument& document) const {
    document.begin_section("Runs");
    document.add_text(fmt::format(
        "{}Each with the command that drives it, and a link that opens it in the dashboard while "
        "`chicane drive` runs on this machine.",
        runs_.size() > kMostListed ? fmt::format("The first {} of {}. ", kMostListed, runs_.size()) : ""));
    json rows = json::array();
    for (std::size_t n = 0; n < std::min(runs_.size(), kMostListed); ++n) {
      const Run& run = runs_[n];
      json row{std::to_string(run.number), run.is_clean ? "yes" : "no"};
      for (std::size_t i = 0; i < kShown.size(); ++i)
        if (is_kept(i)) row.push_back(figure(run.numbers[i]));
      const Settings settings = settings_of(run);
      row.push_back({{"text", command_of(settings)},
                     {"is_code", true},
                     {"link", link_of(settings)},
                     {"remark", run.error}});
      rows.push_back(std::move(row));
    }
    std::vector<std::string> columns = with_columns({"run", "clean"});
    columns.emplace_back("command");
    document.add_table(columns, std::move(rows));
  }

  Header header_;
  std::vector<Run> runs_;  ///< by number
  /// Values of the axes by run; an axis with many values has the middle of the interval.
  std::vector<std::vector<std::string>> binned_;
};

}  // namespace

Result<SummaryDocument> summary_document(const std::vector<std::string>& results) {
  Page content;
  if (const Result<void> read = content.read(results); !read) return fail(read.error());
  return SummaryDocument{content.runs(), content.document()};
}

Result<std::uint64_t> write_maps(const std::vector<std::string>& results, const std::string& page) {
  Page content;
  if (const Result<void> read = content.read(results); !read) return fail(read.error());
  std::string older = protocol::read_file(page).value_or("");
  const std::string begin = fmt::format("<!-- sweep: {} -->\n", content.name());
  const std::string_view end = "<!-- end of sweep -->\n";
  if (older.find(begin) == std::string::npos) older += begin + std::string(end);
  const std::size_t from = older.find(begin) + begin.size();
  const std::size_t to = older.find(end, from);
  if (to == std::string::npos)
    return fail(ErrorCode::kParse,
                fmt::format("{}: got no \"<!-- end of sweep -->\" after that of {}", page, content.name()));
  const std::string text = older.substr(0, from) + content.markdown() + older.substr(to);
  if (const Result<void> written = write_file(page, text); !written) return fail(written.error());
  return content.runs();
}

}  // namespace chicane::sweep
