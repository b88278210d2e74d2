// SPDX-License-Identifier: MIT
// Results of many runs as tables, comparisons, summaries and heat maps, in text, Markdown, CSV, JSON and HTML
// documents.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/sweep/plan.hpp"

namespace chicane::sweep {

/// Table that is written as text, Markdown, CSV and JSON. A cell is a JSON value; null, or a number that is
/// not finite, means unknown.
class ResultTable {
 public:
  using Cells = std::vector<protocol::Json>;
  /// Makes a table without rows. A column is "KEY=TITLE{FORMAT}": CSV and JSON have the columns with a key,
  /// text and Markdown all but "KEY=", which has no title. FORMAT, such as "{>.2}": > aligns to the right, .2
  /// are the decimals of a number that is no integer.
  explicit ResultTable(const std::vector<std::string>& columns);

  /// Adds a row. Pre: as many cells as columns.
  void add(Cells cells);

  /// Text of at most 80 columns. First columns that do not fit become a line above the rows that share their
  /// values.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::string markdown() const;
  [[nodiscard]] std::string csv() const;      ///< RFC 4180; true is 1
  [[nodiscard]] protocol::Json json() const;  ///< list with an object for each row
  /// Adds the table to a document. A cell that is a JSON object is a cell of the document as it stands.
  void add_to(protocol::ReportDocument& document) const;

 private:
  struct Column {
    std::string key, title, alignment, decimals;  ///< alignment and decimals as fmt takes them: ">" and ".2"
    std::size_t place, width = 0;                 ///< index of its cells in a row; letters of the widest cell
  };
  /// Lines of the table for people. The first `shared` columns become a line above rows with equal values.
  /// `begin`: begin of a line; `rule`: line below the titles; `write`: text of a cell.
  [[nodiscard]] std::string lines(std::size_t shared, std::string_view begin, std::string_view rule,
                                  std::string (*write)(const Column&, const std::string&)) const;

  std::vector<Column> for_people_{}, for_programs_{};  ///< columns with a title or without key; with a key
  std::vector<Cells> rows_{};
};

/// Writes a file of results as comma separated values (RFC 4180): `run`, the keys of the axes, the columns,
/// `error`. Lists are quoted JSON, unknown values are empty. Memory does not grow with the file. kParse, kIo.
[[nodiscard]] Result<void> write_csv(const std::string& results, const std::string& csv);

/// Laps that take longer by more than this share are worse; chosen.
inline constexpr double kSlower = 0.01;

/// Runs compared with their twins, which differ in the value of one key alone.
struct Comparison {
  ResultTable table;          ///< a row for each pair
  std::uint64_t pairs = 0;    ///< runs with a twin
  std::uint64_t worse = 0;    ///< runs that are worse than their twin
  std::uint64_t missing = 0;  ///< runs without a twin
};

/// Compares each run with its twin that has `value` for `key`: laps, times off the road, and reasons of the
/// guard. A run is worse if its twin is clean and it is not, or if the mean of its laps is longer by more
/// than kSlower. Needs the columns completed, off_track_events and lap_times_s; shows guard_reasons if the
/// results have it. kInvalidArgument for a key that is no axis; otherwise fails as read_runs() does.
[[nodiscard]] Result<Comparison> compare(const std::vector<std::string>& results, const std::string& key,
                                         const std::string& value);

/// Summary of a sweep as a document (protocol/json.hpp).
struct SummaryDocument {
  std::uint64_t runs = 0;  ///< number of runs in it
  std::string text{};
};

/// Limit of runs listed in a summary: some MB of HTML; chosen.
inline constexpr std::size_t kMostListed = 2000;
/// Sums up the results of a sweep, one file or the files of its parts: one table for each axis, heat maps of
/// pairs of axes, distributions, and the first kMostListed runs with their commands. Missing runs are left
/// out and counted. Fails as read_runs() does.
[[nodiscard]] Result<SummaryDocument> summary_document(const std::vector<std::string>& results);

/// Writes the heat maps of a sweep as text into a page of Markdown, between the lines `<!-- sweep: NAME -->`
/// and
/// `<!-- end of sweep -->`; both are added to a page without the first. Returns the number of runs. Fails as
/// summary_document() does; kParse for a page without the second line, kIo.
[[nodiscard]] Result<std::uint64_t> write_maps(const std::vector<std::string>& results,
                                               const std::string& page);

}  // namespace chicane::sweep

namespace chicane::sweep::detail {

/// Order of values of an axis: numbers by size, then texts.
struct ByNumber {
  [[nodiscard]] bool operator()(const std::string& a, const std::string& b) const;
};

/// Run for heat_maps().
struct MapRun {
  std::vector<std::string> values{};  ///< values of the axes; of an axis with many values the interval
  bool is_clean = false;              ///< all laps driven, no tyre off the road
};

/// Share of clean runs over two axes.
struct HeatMap {
  struct Cell {
    std::uint64_t runs = 0, clean = 0;  ///< numbers of runs, and of clean ones
    bool is_marked = false;             ///< framed
    [[nodiscard]] double share() const { return static_cast<double>(clean) / static_cast<double>(runs); }
  };
  std::string title{};                  ///< values of the axes of texts: "weighted, udacity"; empty: all runs
  std::string row_key{}, column_key{};  ///< keys of the two axes
  std::vector<std::string> rows{}, columns{};  ///< values of the two axes
  std::vector<std::vector<Cell>> cells{};      ///< cells by row and column; no runs: nothing was driven there
};

/// Heat maps of a sweep: first one for each pair of axes of numbers and each combination of the values of all
/// axes of texts, then one over all runs for each pair with an axis of texts. Axes of one value, or of more
/// than `most`, have none. `marks`: points to mark, as values of axes; on an axis of numbers the nearest
/// value is marked.
[[nodiscard]] std::vector<HeatMap> heat_maps(const std::vector<std::string>& keys,
                                             const std::vector<MapRun>& runs,
                                             const std::vector<Settings>& marks, std::size_t most);

/// Map as text of equal width: percentages, `·` if no run is clean, `[ ]` around marked cells.
[[nodiscard]] std::string map_text(const HeatMap& map);

}  // namespace chicane::sweep::detail
