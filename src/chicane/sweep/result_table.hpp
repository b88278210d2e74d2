// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/plan.hpp"

/// Results of many runs as tables: a row for each run, or runs that differ in one setting alone beside each
/// other.

namespace chicane::sweep {

/// A table in text, Markdown, CSV and JSON. A cell is a value of JSON; null and a number that is not finite
/// are not known.
class ResultTable {
 public:
  using Cells = std::vector<protocol::Json>;
  /// A column is "KEY=TITLE{FORMAT}". The key is for CSV and JSON, the title for people: "TITLE" and "=TITLE"
  /// are in neither CSV nor JSON, "KEY=" in these alone. FORMAT: > for a column to the right, and the
  /// decimals of a number that is no integer: "{>.2}".
  explicit ResultTable(const std::vector<std::string>& columns);

  /// Pre: as many cells as columns.
  void add(Cells cells);

  /// At most 80 columns: first cells that do not fit are a line above the rows that share them.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::string markdown() const;
  [[nodiscard]] std::string csv() const;      ///< RFC 4180, true is 1
  [[nodiscard]] protocol::Json json() const;  ///< a list with an object for each row
  /// Objects among the cells are cells of the document.
  void add_to(protocol::ReportDocument& document) const;

 private:
  struct Column {
    std::string key, title, alignment, decimals;
    std::size_t place, width = 0;  ///< index of its cells in a row; width of the widest
  };
  [[nodiscard]] std::string lines(std::size_t shared, std::string_view begin, std::string_view rule,
                                  std::string (*write)(const Column&, const std::string&)) const;

  std::vector<Column> for_people_{}, for_programs_{};
  std::vector<Cells> rows_{};
};

/// Writes a file of results as comma separated values (RFC 4180): `run`, the keys of the axes, the columns.
/// Lists are quoted JSON; values that were not measured are empty. Memory does not grow with the file.
/// kParse, kIo.
[[nodiscard]] Result<void> write_csv(const std::string& results, const std::string& csv);

/// A lap that takes longer by this share is worse.
inline constexpr double kSlower = 0.01;

struct Comparison {
  ResultTable table;          ///< a row for each pair
  std::uint64_t pairs = 0;    ///< pairs of which both runs exist
  std::uint64_t worse = 0;    ///< pairs in which this one is worse
  std::uint64_t missing = 0;  ///< runs without the other one
};

/// Compares each run with its twin that has `value` for `key`: laps, times off the road, and the guard's
/// reasons. A run is worse where it leaves the road or does not complete its laps and the other one does
/// neither, or where its laps take kSlower longer in the mean. Needs the columns completed, off_track_events
/// and lap_times_s; guard_reasons is shown where it is kept. kInvalidArgument for a key that is no axis;
/// otherwise fails as read_runs() does.
[[nodiscard]] Result<Comparison> compare(const std::vector<std::string>& results, const std::string& key,
                                         const std::string& value);

/// The results of a sweep as a document (protocol/json.hpp).
struct SummaryDocument {
  std::uint64_t runs = 0;
  std::string text{};
};

/// Sums up the results of a sweep, one file or the files of its parts: the driven runs, one table for each
/// axis, heat maps of pairs of axes, distributions, and the runs with the command that drives each (the first
/// kMostListed). Runs that are missing are left out, and counted. Fails as read_runs() does.
inline constexpr std::size_t kMostListed = 2000;
[[nodiscard]] Result<SummaryDocument> summary_document(const std::vector<std::string>& results);

/// Writes the heat maps of a sweep in letters into a page of Markdown, between the lines
/// `<!-- sweep: NAME -->` and `<!-- end of sweep -->`, which are added where they are not there. The number
/// of runs; fails as summary_document() does; kParse for a page without the second line, kIo.
[[nodiscard]] Result<std::uint64_t> write_maps(const std::vector<std::string>& results,
                                               const std::string& page);

}  // namespace chicane::sweep

namespace chicane::sweep::detail {

/// Orders numbers as numbers, and texts after them.
struct ByNumber {
  [[nodiscard]] bool operator()(const std::string& a, const std::string& b) const;
};

/// A run as a map sees it.
struct MapRun {
  std::vector<std::string> values{};  ///< values of the axes, in intervals if they are many
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
  std::vector<std::vector<Cell>> cells{};  ///< cells by row and column; no runs: nothing was driven there
};

/// One map for each pair of axes of numbers and each combination of values of the others, which are texts;
/// then one over all runs for each pair with an axis of texts. Axes of one value, or of more than `most`,
/// have none. `marks`: places to be marked, by values of axes; the nearest value of an axis of numbers
/// counts.
[[nodiscard]] std::vector<HeatMap> heat_maps(const std::vector<std::string>& keys,
                                             const std::vector<MapRun>& runs,
                                             const std::vector<Settings>& marks, std::size_t most);

/// Map in letters of equal width: `·` if no run is clean, `[ ]` around marked cells.
[[nodiscard]] std::string map_text(const HeatMap& map);

}  // namespace chicane::sweep::detail
