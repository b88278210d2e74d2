// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "chicane/protocol/json.hpp"

namespace chicane::protocol {

/// What a page of results shows, as JSON for the page that draws it (web/src/document): sections of prose,
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
  /// x. `tone`: ink for what is, other for what is compared with it, good; soft, faint and paper for grounds.
  /// Names are in the legend. Values are kept as exactly as a screen shows them.
  void add_series(std::string_view draw, std::string_view tone, std::string_view name,
                  const std::vector<double>& values);

  /// The document on one line of UTF-8.
  [[nodiscard]] std::string text() const { return json_text(json_); }

 private:
  [[nodiscard]] Json& parts() { return json_["sections"].back()["parts"]; }

  Json json_;
};

}  // namespace chicane::protocol
