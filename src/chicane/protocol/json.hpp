// SPDX-License-Identifier: MIT
// JSON values and texts, and documents of results for the page that draws them. Not installed.
#pragma once

#include <nlohmann/json.hpp>
#include <tl/expected.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace chicane::protocol {

/// JSON value whose keys are in the order in which they were written. The library's reader and writer take
/// the compiler long: they are instantiated in json.cpp alone.
using Json = nlohmann::ordered_json;

/// Layout of a JSON text.
enum class JsonLayout {
  kLine,      ///< one line, without a line break at its end
  kAscii,     ///< one line with \u escapes for non-ASCII characters
  kIndented,  ///< indented by two spaces, without a line break at its end
};

/// UTF-8 text of `json`; bytes that are no UTF-8 become U+FFFD. A number that is not finite becomes null.
[[nodiscard]] std::string json_text(const Json& json, JsonLayout layout = JsonLayout::kLine);

/// Value of `text`; is_discarded() for a text that is no JSON. Deep nesting takes memory, not stack.
[[nodiscard]] Json parse_json(std::string_view text);

/// Fault of a text that is no JSON.
struct JsonError {
  std::optional<std::size_t> byte;  ///< position of the error, from 1; nothing if a number is too large
};

/// Value of `text`, or the position of its fault.
[[nodiscard]] tl::expected<Json, JsonError> read_json(std::string_view text);

/// Contents of a page of results, as JSON for the page that draws it (web/src/document): sections of prose,
/// tables, grids, charts and maps, in the order in which they are added. Texts are plain; words between
/// backticks are code.
///
/// A cell of a table is a text, or an object with `text` and any of
/// - hint: shown where a pointer rests; remark: shown in a line of its own;
/// - link: an address to open; is_code; is_marked: framed; an empty hint, remark or link is left out;
/// - share: colours the cell from red at 0 over yellow to green at 1;
/// - signed: colours the cell from one colour at -1 over none at 0 to another at 1;
/// - interval: low, high, value and the assumed value, drawn.
class ReportDocument {
 public:
  /// `kind`: sweep, league, identify, import.
  ReportDocument(std::string_view kind, std::string_view title);

  void begin_section(std::string_view title);
  void add_text(std::string_view words);
  /// `rows`: lists of cells, as many as `columns`; the first column names the rows.
  void add_table(const std::vector<std::string>& columns, Json rows);
  /// Adds a table of cells of one kind, such as a heat map; the title may be empty.
  void add_grid(std::string_view title, const std::vector<std::string>& columns, Json rows);
  /// Begins a chart, or a map, which has the same scale on both axes; add_series() adds to it.
  void begin_chart(std::string_view title, std::string_view x_name);
  void begin_map(std::string_view title, std::string_view x_name);
  /// Adds a series to the last chart or map; `name` is its name in the legend. `draw`: "line" or "dots"
  /// through x, y,
  /// ...; "cells" x, y, width, height, ...; "mark", an upright stroke at each x. `tone`: "ink" for the
  /// subject, "other" for its comparison, "good"; "soft", "faint" and "paper" for grounds. Values are rounded
  /// to what a screen shows.
  void add_series(std::string_view draw, std::string_view tone, std::string_view name,
                  const std::vector<double>& values);

  /// Text of the document, one line of UTF-8.
  [[nodiscard]] std::string text() const { return json_text(json_); }

 private:
  /// Parts of the last section.
  [[nodiscard]] Json& parts() { return json_["sections"].back()["parts"]; }

  Json json_;
};

}  // namespace chicane::protocol
