// SPDX-License-Identifier: MIT
// Tables of numbers as roads: finds separator, header and columns of a table, reads its rows, and writes a
// road as a table.
#include "chicane/protocol/track_codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/road_rows.hpp"
#include "chicane/protocol/origin.hpp"

namespace chicane::protocol {
namespace {

/// Names of columns with one meaning.
struct Meaning {
  Column column;
  std::string_view names;  ///< names, a blank before and after each
};
constexpr std::array kMeanings{
    Meaning{Column::kX, " x_m x x_ref_m x[m] x(m) pos_x position_x easting "},
    Meaning{Column::kY, " y_m y y_ref_m y[m] y(m) pos_y position_y northing "},
    Meaning{Column::kRight, " w_tr_right_m w_right_m width_right_m d_right w_right width_right right_width "},
    Meaning{Column::kLeft, " w_tr_left_m w_left_m width_left_m d_left w_left width_left left_width "},
    Meaning{Column::kWidth, " width_m width track_width_m "},
    Meaning{Column::kHeading, " psi_rad "},
    Meaning{Column::kSkipped, " skip s_m kappa_radpm vx_mps ax_mps2 "},
};
constexpr std::string_view kTagNames = " tag color colour type class side ";

// Chosen: bounds memory and messages.
constexpr std::size_t kMaxLine = 65536;     // [byte]
constexpr std::size_t kMostColumns = 1000;  // columns of a table
constexpr std::size_t kMostNamed = 8;       // unknown columns in one warning

constexpr double kSameAngle = 0.3;  // [rad] scatter of headings computed from points; chosen
constexpr double kLeastRoad =
    0.5;  // [m] least extent of a full-size road: smaller ones are in degrees; chosen
constexpr std::string_view kPlane = "columns x and y (or x_m and y_m) in metres";

Column column_of(std::string_view name) {
  const auto found = std::find_if(kMeanings.begin(), kMeanings.end(),
                                  [&](const Meaning& each) { return is_among(name, each.names); });
  return found == kMeanings.end() ? Column::kUnknown : found->column;
}

/// Names of columns in a header. Some files mix separators: "ax_mps2, w_tr_right_m" between semicolons.
std::vector<std::string_view> split_names(std::string_view header) {
  std::vector<std::string_view> names;
  const char separator = separator_of(header);
  for (const std::string_view part : split(header, separator)) {
    if (separator != ';') {
      names.push_back(part);
      continue;
    }
    for (const std::string_view name : split(part, ',')) names.push_back(name);
  }
  return names;
}

/// Whether a text is a header with columns x and y.
bool names_a_plane(std::string_view text) {
  const std::string low = lower(text);
  const std::vector<std::string_view> names = split_names(low);
  const auto has = [&](Column column) {
    return std::any_of(names.begin(), names.end(), [&](auto name) { return column_of(name) == column; });
  };
  return has(Column::kX) && has(Column::kY);
}

/// Whether a comment is a list of column names of any meaning: "v_mps, ax_max_machines_mps2".
bool names_columns(std::string_view comment) {
  const std::vector<std::string_view> names = split_names(comment);
  const bool has_separator = separator_of(comment) != ' ';
  return names.size() > 1 && (has_separator || comment.find('_') != std::string_view::npos) &&
         std::all_of(names.begin(), names.end(), is_name);
}

/// Reader of one table, line by line. The first fault ends it.
class TableReader {
 public:
  TableReader(const std::string& file, const TrackReadOptions& options, bool has_tags)
      : rows_{file, options}, has_tags_{has_tags} {}

  RoadRows read(std::string_view text) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
      rows_.fault(0, "file", "UTF-16", "UTF-8");
    CsvLines lines(text);
    for (auto line = lines.next(); line && !rows_.error; line = lines.next()) {
      line_ = lines.number();
      read_line(*line);
    }
    if (!has_points())
      rows_.fault(0, "file", "no points", "lines of numbers below a line that names them, like x_m,y_m");
    return std::move(rows_);
  }

 private:
  [[nodiscard]] bool has_points() const { return !rows_.content.points.empty(); }
  [[nodiscard]] bool has_names() const { return !rows_.columns.empty(); }
  void fault(std::string_view key, std::string_view got, std::string_view expected) {
    rows_.fault(line_, key, got, expected);
  }

  void read_line(std::string_view line) {
    if (line.size() > kMaxLine)
      return fault("line", fmt::format("{} bytes", line.size()), fmt::format("at most {}", kMaxLine));
    if (line.empty()) return;
    if (line.front() == '#' || line.front() == '%')
      return read_comment(trim(line.substr(std::min(line.find_first_not_of("#%"), line.size()))));
    if (!has_points() && is_header(line)) return read_header(line);
    read_point(trim(line.substr(0, line.find_first_of("#%"))));  // without a remark after the numbers
  }

  /// Whether a line above the first point is the header: any line that names x and y, or the first line that
  /// does not begin with a number.
  [[nodiscard]] bool is_header(std::string_view line) const {
    if (names_a_plane(line)) return true;
    const std::vector<std::string_view> values = split(line, separator_of(line));
    return !has_tags_ && !has_names() && (values.empty() || !stands_for_a_number(values.front()));
  }

  void read_comment(std::string_view comment) {
    if (comment.starts_with(kNote)) return;
    if (!has_points() && names_a_plane(comment)) return read_header(comment);
    if (!has_points() && !has_names() && names_columns(comment))
      other_names_ = {line_, std::string{comment}, split_names(comment).size()};
    for (const std::string_view field : split(comment, separator_of(comment))) {
      const std::size_t equals = field.find('=');
      if (equals != std::string_view::npos)
        read_setting(trim(field.substr(0, equals)), trim(field.substr(equals + 1)));
    }
  }

  void read_setting(std::string_view key, std::string_view value) {
    if (key == "closed") {
      if (value != "true" && value != "false") return fault(key, printable(value), "true or false");
      if (!rows_.options.is_closed) rows_.closed = value == "true";
    }
    for (const TrackSetting& setting : kTrackSettings) {
      if (key != setting.key) continue;
      const std::optional<double> parsed = number(value);
      if (!parsed) return fault(key, printable(value), "a number");
      rows_.content.options.*setting.length = *parsed;
    }
  }

  void read_header(std::string_view header) {
    rows_.columns.clear();
    rows_.content.warnings.clear();  // a second line of names replaces the first
    const std::string text = lower(header);
    const std::vector<std::string_view> names = split_names(text);
    if (names.size() > kMostColumns)
      return fault("header", fmt::format("{} columns", names.size()),
                   fmt::format("at most {}", kMostColumns));
    std::vector<std::string> unknown;
    for (const std::string_view name : names) {
      const Column column = has_tags_ && is_among(name, kTagNames) ? Column::kTag : column_of(name);
      if (column != Column::kUnknown && column != Column::kSkipped && rows_.has(column))
        return fault(printable(name), "a second such column", "one");
      if (column == Column::kUnknown) unknown.push_back(printable(name));
      rows_.columns.push_back({std::string{name}, column});
    }
    if (!rows_.has(Column::kX) || !rows_.has(Column::kY)) return fault("header", printable(header), kPlane);
    if (has_tags_ && !rows_.has(Column::kTag))
      return fault("header", printable(header), "a column tag, colour or type beside x and y");
    warn_of_unknown(unknown);
    check_widths();
  }

  void warn_of_unknown(std::vector<std::string>& names) {
    if (names.empty()) return;
    const std::string_view what = names.size() == 1 ? "unknown column, ignored" : "unknown columns, ignored";
    if (names.size() > kMostNamed) {
      const std::size_t more = names.size() - kMostNamed;
      names.resize(kMostNamed);
      names.push_back(fmt::format("and {} more", more));
    }
    warn(rows_.content, fmt::format("{}: {}", fmt::join(names, ", "), what), line_);
  }

  void check_widths() {
    const bool has_right = rows_.has(Column::kRight);
    if (has_right != rows_.has(Column::kLeft))
      return fault("header", has_right ? "only a right width" : "only a left width",
                   "both w_tr_right_m and w_tr_left_m, or none");
    if (has_right) return;
    if (rows_.has(Column::kWidth))
      warn(rows_.content, "width: of the whole road, half of it to each side", line_);
    else
      warn_of_width(rows_.content, rows_.options, line_);
  }

  /// Takes a header for a table without one: the options' columns, or x and y for two columns. More columns
  /// are a fault: widths, height, speed and heading look alike.
  void assume_header(std::size_t count) {
    if (has_tags_) return read_header("tag,x,y");
    if (!rows_.options.columns.empty()) return read_header(rows_.options.columns);
    if (other_names_.count == count) {
      line_ = other_names_.line;
      return fault("header", printable(other_names_.text), kPlane);
    }
    if (count != 2)
      return fault(
          "header", fmt::format("none for {} columns", count),
          "a line that names them, like x_m,y_m,w_tr_right_m,w_tr_left_m (import --columns names them)");
    rows_.columns = {{"x_m", Column::kX}, {"y_m", Column::kY}};
    warn(rows_.content, "header: none, read as x_m,y_m", line_);
    check_widths();
  }

  void read_point(std::string_view line) {
    if (separator_ == '\0') separator_ = separator_of(line);
    std::vector<std::string_view> values = split(line, separator_);
    if (!has_names()) assume_header(values.size());
    if (values.size() == rows_.columns.size() + 1 && values.back().empty()) values.pop_back();
    if (values.size() > rows_.columns.size() && !has_tags_)
      fault("row", fmt::format("{} columns", values.size()), fmt::format("{}", rows_.columns.size()));
    rows_.add(line_, values, separator_);
  }

  /// Comment that names columns, but not x and y: the cause of a fault in a table without a header.
  struct OtherNames {
    int line = 0;
    std::string text;
    std::size_t count = 0;  ///< count of the names
  };

  RoadRows rows_;
  bool has_tags_;  ///< a table of cones
  OtherNames other_names_;
  char separator_ = '\0';  ///< separator of the rows, found in the first one
  int line_ = 0;           ///< number of the current line
};

/// Refuses columns in metres whose values are plausible as degrees of latitude and longitude only.
void check_extent(RoadRows& rows) {
  if (rows.error) return;
  const Vec2& first = rows.content.points.front().position;
  Vec2 low = first, high = first;
  for (const road::TrackPoint& point : rows.content.points) {
    low = min(low, point.position);
    high = max(high, point.position);
  }
  const double most = std::max(high.x() - low.x(), high.y() - low.y());
  const bool may_be_degrees =
      first.norm() > 1.0 && std::max(std::fabs(first.x()), std::fabs(first.y())) <= 180.0;
  if (most > 0.0 && most < kLeastRoad * rows.options.scale && may_be_degrees)
    rows.fault(rows.content.lines.front(), "x_m",
               fmt::format("a road within {:.2g} m round {}, {}, like degrees of longitude and latitude",
                           most, first.x(), first.y()),
               "metres: project the points to a plane first");
}

/// Warns if a column of headings counts from another axis or contradicts the points. Headings are recomputed
/// from the points in any case.
void compare_headings(RoadRows& rows) {
  const std::vector<road::TrackPoint>& points = rows.content.points;
  const std::vector<double>& headings = rows.headings;
  if (headings.size() != points.size() || points.size() < 3) return;
  std::size_t from_x = 0;
  std::size_t from_y = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec2 along = points[i + 1].position - points[i - 1].position;
    const double heading = atan2(along.y(), along.x());
    if (std::fabs(headings[i]) > 1e5) continue;
    from_x += std::fabs(angle_difference(headings[i], heading)) < kSameAngle ? 1U : 0U;
    from_y += std::fabs(angle_difference(headings[i] + 0.5 * kPi, heading)) < kSameAngle ? 1U : 0U;
  }
  const std::size_t most = (points.size() - 2) * 8 / 10;
  if (from_x > most) return;
  warn(rows.content,
       from_y > most ? "psi_rad: counts from +y (as TUM files do), recomputed from the points"
                     : "psi_rad: disagrees with the points, recomputed from them",
       rows.content.lines.front());
}

}  // namespace

RoadRows read_table(std::string_view text, const std::string& file, const TrackReadOptions& options,
                    bool has_tags) {
  return TableReader{file, options, has_tags}.read(text);
}

Result<TrackFile> parse_csv_track(std::string_view text, const std::string& file,
                                  const TrackReadOptions& options) {
  RoadRows rows = read_table(text, file, options);
  check_extent(rows);
  compare_headings(rows);
  return rows.build();
}

std::string write_csv_track(const TrackFile& content, std::string_view description) {
  std::string text;
  for (const std::string_view line : split(description, '\n'))
    fmt::format_to(std::back_inserter(text), "# {}\n", line);
  const road::TrackOptions& o = content.options;
  fmt::format_to(
      std::back_inserter(text),
      "# closed={}, start_s_m={}, start_d_m={}, spacing_m={}, smoothing_sigma_m={}, kerb_width_m={}\n",
      content.is_closed, o.start_s, o.start_d, o.spacing, o.smoothing_sigma, o.kerb_width);
  if (o.finish_s != 0.0) fmt::format_to(std::back_inserter(text), "# finish_s_m={}\n", o.finish_s);
  text += "# x_m,y_m,w_tr_right_m,w_tr_left_m\n";
  for (const road::TrackPoint& p : content.points) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{}\n", p.position.x(), p.position.y(), p.right,
                   p.left);
  }
  return text;
}

}  // namespace chicane::protocol
