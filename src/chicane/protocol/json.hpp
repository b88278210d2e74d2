// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <tl/expected.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace chicane::protocol {

/// A JSON value; keys keep the order in which they were written. This header is for our own sources and not
/// installed. The library's reader and writer take the compiler long: they are instantiated in json.cpp
/// alone.
using Json = nlohmann::ordered_json;

enum class JsonLayout {
  kLine,      ///< one line, without a line break at its end
  kAscii,     ///< one line with \u escapes for non-ASCII characters
  kIndented,  ///< indented by two spaces, without a line break at its end
};

/// UTF-8 text of `json`; bytes that are no UTF-8 become U+FFFD. A number that is not finite becomes null.
[[nodiscard]] std::string json_text(const Json& json, JsonLayout layout = JsonLayout::kLine);

/// The value of `text`; is_discarded() where it is no JSON. Deep nesting takes memory, not stack.
[[nodiscard]] Json parse_json(std::string_view text);

struct JsonError {
  std::optional<std::size_t> byte;  ///< position of the error, from 1; nothing if a number is too large
};

/// Parses a text; the error names the position of the fault.
[[nodiscard]] tl::expected<Json, JsonError> read_json(std::string_view text);

/// Contents of a page of results, as JSON for the page that draws it (web/src/document): sections of prose,
/// tables, grids, charts and maps, in the order in which they are added. Texts are plain; words between
/// backticks are code.
///
/// A cell of a table is a text or an object with `text` and any of
/// - hint: shown where a pointer rests; is_code; is_marked: framed; link: an address to open; remark: in a
/// line of
///   its own; an empty text is none of these;
/// - share: colours the cell from red at 0 over yellow to green at 1; signed: from one colour at -1 over none
/// at 0 to
///   another at 1;
/// - interval: low, high, value and what was assumed, drawn.
class ReportDocument {
 public:
  /// `kind`: sweep, league, identify, import.
  ReportDocument(std::string_view kind, std::string_view title);

  void begin_section(std::string_view title);
  void add_text(std::string_view words);
  /// `rows`: lists of cells, as many as `columns`; the first column names the rows.
  void add_table(const std::vector<std::string>& columns, Json rows);
  /// A table of cells of one kind, such as a heat map; the title may be empty.
  void add_grid(std::string_view title, const std::vector<std::string>& columns, Json rows);
  /// A chart, or a map, which has both axes to the same scale; its series follow.
  void begin_chart(std::string_view title, std::string_view x_name);
  void begin_map(std::string_view title, std::string_view x_name);
  /// `draw`: line or dots through x, y, ...; cells x, y, width, height, ...; mark, an upright stroke at each
  /// x. `tone`: ink for the subject, other for its comparison, good; soft, faint and paper for grounds. Names
  /// are in the legend. Values are kept as exactly as a screen shows them.
  void add_series(std::string_view draw, std::string_view tone, std::string_view name,
                  const std::vector<double>& values);

  /// The document on one line of UTF-8.
  [[nodiscard]] std::string text() const { return json_text(json_); }

 private:
  [[nodiscard]] Json& parts() { return json_["sections"].back()["parts"]; }

  Json json_;
};

}  // namespace chicane::protocol
