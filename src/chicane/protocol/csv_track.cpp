// SPDX-License-Identifier: MIT
#include "chicane/protocol/csv_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "chicane/base/angle.hpp"
#include "chicane/base/math.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/detail/track_order.hpp"
#include "chicane/protocol/origin.hpp"

namespace chicane::protocol {
namespace {

enum class Column { kX, kY, kRight, kLeft, kWidth, kHeading, kDerived, kUnknown };

struct Alias {
  std::string_view name;
  Column column;
};
constexpr std::array kAliases{
    Alias{"x_m", Column::kX},
    Alias{"x", Column::kX},
    Alias{"x_ref_m", Column::kX},
    Alias{"x[m]", Column::kX},
    Alias{"x(m)", Column::kX},
    Alias{"pos_x", Column::kX},
    Alias{"position_x", Column::kX},
    Alias{"easting", Column::kX},
    Alias{"y_m", Column::kY},
    Alias{"y", Column::kY},
    Alias{"y_ref_m", Column::kY},
    Alias{"y[m]", Column::kY},
    Alias{"y(m)", Column::kY},
    Alias{"pos_y", Column::kY},
    Alias{"position_y", Column::kY},
    Alias{"northing", Column::kY},
    Alias{"w_tr_right_m", Column::kRight},
    Alias{"w_right_m", Column::kRight},
    Alias{"width_right_m", Column::kRight},
    Alias{"d_right", Column::kRight},
    Alias{"w_right", Column::kRight},
    Alias{"width_right", Column::kRight},
    Alias{"right_width", Column::kRight},
    Alias{"w_tr_left_m", Column::kLeft},
    Alias{"w_left_m", Column::kLeft},
    Alias{"width_left_m", Column::kLeft},
    Alias{"d_left", Column::kLeft},
    Alias{"w_left", Column::kLeft},
    Alias{"width_left", Column::kLeft},
    Alias{"left_width", Column::kLeft},
    Alias{"width_m", Column::kWidth},
    Alias{"width", Column::kWidth},
    Alias{"track_width_m", Column::kWidth},
    Alias{"psi_rad", Column::kHeading},
    Alias{"s_m", Column::kDerived},
    Alias{"kappa_radpm", Column::kDerived},
    Alias{"vx_mps", Column::kDerived},
    Alias{"ax_mps2", Column::kDerived},
};

constexpr std::size_t kMaxLine = 65536;  // [bytes]
constexpr std::size_t kMostColumns = 1000;
constexpr double kSameAngle = 0.3;     // headings from points scatter by this [rad]
constexpr std::size_t kMostNamed = 8;  // unknown columns in one warning
constexpr double kLeastRoad = 0.5;     // a full-size road within so small a square is in degrees [m]

class TrackParser {
 public:
  TrackParser(const std::string& file, const TrackReadOptions& options) : options_{options} {
    content_ = empty_track(file, options);
    closed_ = options.is_closed;
  }

  Result<TrackFile> parse(std::string_view text) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
      return fail(fault("file", "UTF-16", "UTF-8"));
    CsvLines lines(text);
    for (std::optional<std::string_view> line = lines.next(); line; line = lines.next()) {
      line_ = lines.number();
      if (Result<void> read = read_line(*line); !read) return fail(std::move(read.error()));
    }
    if (content_.points.empty()) {
      line_ = 0;
      return fail(fault("file", "no points", "lines of numbers below a line that names them, like x_m,y_m"));
    }
    if (Result<void> checked = check_extent(); !checked) return fail(std::move(checked.error()));
    compare_headings();
    settle_ends(content_, closed_);
    return std::move(content_);
  }

 private:
  struct Field {
    std::string name;
    Column column = Column::kUnknown;
  };

  [[nodiscard]] std::string place() const {
    return line_ > 0 ? fmt::format("{}:{}: ", content_.file, line_) : content_.file + ": ";
  }
  [[nodiscard]] Error fault(std::string_view column, std::string_view got, std::string_view expected) const {
    return {ErrorCode::kParse, fmt::format("{}{}: got {}, expected {}", place(), column, got, expected)};
  }
  void warn(std::string_view column, std::string_view what) {
    content_.warnings.push_back(fmt::format("{}{}: {}", place(), column, what));
  }

  Result<void> read_line(std::string_view line) {
    if (line.size() > kMaxLine) {
      return fail(fault("line", fmt::format("{} bytes", line.size()), fmt::format("at most {}", kMaxLine)));
    }
    if (line.empty()) return {};
    if (line.front() == '#' || line.front() == '%')
      return read_comment(trim(line.substr(std::min(line.find_first_not_of("#%"), line.size()))));
    if (content_.points.empty() && is_header(line)) return read_header(line);
    return read_point(trim(line.substr(0, line.find_first_of("#%"))));  // a remark may follow the numbers
  }

  /// Of a line above the first point: the first one without a number in front, and each that names x and y.
  [[nodiscard]] bool is_header(std::string_view line) const {
    if (names_a_plane(line)) return true;
    const std::vector<std::string_view> values = split(line, separator_of(line));
    return fields_.empty() && (values.empty() || !stands_for_a_number(values.front()));
  }

  Result<void> read_comment(std::string_view comment) {
    if (comment.starts_with(kNote)) return {};
    if (content_.points.empty() && names_a_plane(comment)) return read_header(comment);
    if (content_.points.empty() && fields_.empty() && names_columns(comment))
      other_names_ = {line_, std::string{comment}, split_names(comment).size()};
    for (const std::string_view field : split(comment, separator_of(comment))) {
      const std::size_t equals = field.find('=');
      if (equals == std::string_view::npos) continue;
      if (Result<void> set = read_setting(trim(field.substr(0, equals)), trim(field.substr(equals + 1)));
          !set)
        return set;
    }
    return {};
  }

  Result<void> read_setting(std::string_view key, std::string_view value) {
    if (key == "closed") {
      if (value != "true" && value != "false") return fail(fault(key, shown(value), "true or false"));
      if (!options_.is_closed) closed_ = value == "true";
      return {};
    }
    if (key == "track_scale") {
      if (value != "1")
        return fail(fault(key, shown(value), "1, for a road in the size in which it is driven"));
      content_.is_own_size = true;
      return {};
    }
    struct Setting {
      std::string_view key;
      double road::TrackOptions::*field;
    };
    static constexpr std::array kSettings{
        Setting{"start_s_m", &road::TrackOptions::start_s},
        Setting{"finish_s_m", &road::TrackOptions::finish_s},
        Setting{"start_d_m", &road::TrackOptions::start_d},
        Setting{"spacing_m", &road::TrackOptions::spacing},
        Setting{"smoothing_sigma_m", &road::TrackOptions::smoothing_sigma},
        Setting{"kerb_width_m", &road::TrackOptions::kerb_width},
    };
    for (const Setting& setting : kSettings) {
      if (key != setting.key) continue;
      const std::optional<double> parsed = number(value);
      if (!parsed) return fail(fault(key, shown(value), "a number"));
      content_.options.*setting.field = *parsed;
    }
    return {};
  }

  static Column column_of(std::string_view name) {
    const auto alias =
        std::find_if(kAliases.begin(), kAliases.end(), [&](const Alias& a) { return a.name == name; });
    return alias == kAliases.end() ? Column::kUnknown : alias->column;
  }

  /// Whether a comment is the line of column names.
  static bool names_a_plane(std::string_view comment) {
    bool has_x = false;
    bool has_y = false;
    const std::string text = lower(comment);
    for (const std::string_view name : split_names(text)) {
      has_x = has_x || column_of(name) == Column::kX;
      has_y = has_y || column_of(name) == Column::kY;
    }
    return has_x && has_y;
  }

  /// Whether a comment looks like the names of columns, whatever they are: "v_mps, ax_max_machines_mps2".
  static bool names_columns(std::string_view comment) {
    const std::vector<std::string_view> names = split_names(comment);
    const bool has_separator = separator_of(comment) != ' ';
    const bool has_unit = std::any_of(names.begin(), names.end(), [](std::string_view name) {
      return name.find('_') != std::string_view::npos;
    });
    return names.size() > 1 && (has_separator || has_unit) &&
           std::all_of(names.begin(), names.end(), is_name);
  }

  /// Headers of the wild mix their separators: "ax_mps2, w_tr_right_m" after semicolons.
  static std::vector<std::string_view> split_names(std::string_view header) {
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

  [[nodiscard]] bool has(Column column) const {
    return std::any_of(fields_.begin(), fields_.end(),
                       [&](const Field& field) { return field.column == column; });
  }

  Result<void> read_header(std::string_view header) {
    fields_.clear();
    content_.warnings.clear();  // of the line of names that this one takes the place of
    const std::string text = lower(header);
    const std::vector<std::string_view> names = split_names(text);
    if (names.size() > kMostColumns) {
      return fail(
          fault("header", fmt::format("{} columns", names.size()), fmt::format("at most {}", kMostColumns)));
    }
    std::vector<std::string> unknown;
    for (const std::string_view name : names) {
      const Column column = column_of(name);
      if (name == "skip") {
        fields_.push_back({std::string{name}, Column::kDerived});
        continue;
      }
      const bool is_once = column == Column::kUnknown || column == Column::kDerived || !has(column);
      if (!is_once) return fail(fault(shown(name), "a second such column", "one"));
      if (column == Column::kUnknown) unknown.push_back(shown(name));
      fields_.push_back({std::string{name}, column});
    }
    if (!has(Column::kX) || !has(Column::kY)) return fail(fault("header", shown(header), kPlane));
    warn_of_unknown(unknown);
    return check_widths();
  }

  void warn_of_unknown(std::vector<std::string>& names) {
    if (names.empty()) return;
    if (names.size() > kMostNamed) {
      const std::size_t more = names.size() - kMostNamed;
      names.resize(kMostNamed);
      names.push_back(fmt::format("and {} more", more));
    }
    warn(fmt::format("{}", fmt::join(names, ", ")),
         names.size() == 1 ? "unknown column, ignored" : "unknown columns, ignored");
  }

  Result<void> check_widths() {
    const bool has_right = has(Column::kRight);
    if (has_right != has(Column::kLeft)) {
      return fail(fault("header", has_right ? "only a right width" : "only a left width",
                        "both w_tr_right_m and w_tr_left_m, or none"));
    }
    if (!has_right && has(Column::kWidth)) {
      warn("width", "of the whole road, half of it to each side");
    } else if (!has_right) {
      warn("width",
           fmt::format("not in the file, {} m left and {} m right assumed (import --width-m sets it)",
                       options_.scale * options_.default_left, options_.scale * options_.default_right));
    }
    return {};
  }

  /// Numbers without a line of names: two columns can hardly be anything but a line of points. What more
  /// columns are is never guessed: widths, height, speed and heading look alike.
  Result<void> assume_header(std::size_t count) {
    if (!options_.columns.empty()) return read_header(options_.columns);
    if (other_names_.count == count) {
      line_ = other_names_.line;
      return fail(fault("header", shown(other_names_.text), kPlane));
    }
    if (count != 2) {
      return fail(fault(
          "header", fmt::format("none for {} columns", count),
          "a line that names them, like x_m,y_m,w_tr_right_m,w_tr_left_m (import --columns names them)"));
    }
    fields_ = {{"x_m", Column::kX}, {"y_m", Column::kY}};
    warn("header", "none, read as x_m,y_m");
    return check_widths();
  }

  Result<void> read_point(std::string_view line) {
    if (separator_ == '\0') separator_ = separator_of(line);
    std::vector<std::string_view> values = split(line, separator_);
    if (fields_.empty()) {
      if (Result<void> assumed = assume_header(values.size()); !assumed) return assumed;
    }
    if (values.size() == fields_.size() + 1 && values.back().empty()) values.pop_back();
    if (values.size() != fields_.size()) {
      return fail(fault("row", fmt::format("{} columns", values.size()), fmt::format("{}", fields_.size())));
    }
    if (content_.points.size() == kMaxTrackPoints)
      return fail(fault("row", "another point", "at most 1000000"));

    road::TrackPoint point{Vec2{}, options_.scale * options_.default_left,
                           options_.scale * options_.default_right};
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (Result<void> read = read_value(fields_[i], values[i], point); !read) return read;
    }
    content_.points.push_back(point);
    content_.lines.push_back(line_);
    return {};
  }

  Result<void> read_value(const Field& field, std::string_view text, road::TrackPoint& point) {
    if (field.column == Column::kDerived || field.column == Column::kUnknown) return {};
    const std::optional<double> value = number(text, separator_);
    if (field.column == Column::kHeading) {
      headings_.push_back(value.value_or(0.0));
      return {};
    }
    if (!value) return fail(fault(field.name, shown(text), "a finite number with a decimal point"));
    const bool is_width =
        field.column == Column::kRight || field.column == Column::kLeft || field.column == Column::kWidth;
    if (is_width && !(*value > 0.0 && *value <= kMaxTrackWidth))
      return fail(fault(field.name, shown(text), "a width > 0 and <= 1000 m"));
    if (!is_width && std::fabs(*value) > road::Path::kMaxCoordinate)
      return fail(fault(field.name, shown(text), "a coordinate within 1e7 m"));
    switch (field.column) {
      case Column::kX:
        point.position.x() = *value;
        break;
      case Column::kY:
        point.position.y() = *value;
        break;
      case Column::kRight:
        point.right = *value;
        break;
      case Column::kWidth:
        if (!has(Column::kRight)) point.left = point.right = 0.5 * *value;
        break;
      default:
        point.left = *value;
    }
    return {};
  }

  /// Degrees of latitude and longitude in columns that are taken for metres.
  Result<void> check_extent() {
    Vec2 low = content_.points.front().position;
    Vec2 high = low;
    for (const road::TrackPoint& point : content_.points) {
      low = {std::min(low.x(), point.position.x()), std::min(low.y(), point.position.y())};
      high = {std::max(high.x(), point.position.x()), std::max(high.y(), point.position.y())};
    }
    const double most = std::max(high.x() - low.x(), high.y() - low.y());
    const Vec2& first = content_.points.front().position;
    const bool may_be_degrees =
        first.norm() > 1.0 && std::max(std::fabs(first.x()), std::fabs(first.y())) <= 180.0;
    if (!(most > 0.0 && most < kLeastRoad * options_.scale && may_be_degrees)) return {};
    line_ = content_.lines.front();
    return fail(
        fault("x_m",
              fmt::format("a road within {:.2g} m round {}, {}, like degrees of longitude and latitude", most,
                          first.x(), first.y()),
              "metres: project the points to a plane first"));
  }

  /// Headings are always recomputed; a column that counts from elsewhere is worth a word.
  void compare_headings() {
    const std::vector<road::TrackPoint>& points = content_.points;
    if (headings_.size() != points.size() || points.size() < 3) return;
    std::size_t from_x = 0;
    std::size_t from_y = 0;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const Vec2 along = points[i + 1].position - points[i - 1].position;
      const double heading = atan2(along.y(), along.x());
      if (std::fabs(headings_[i]) > 1e5) continue;
      from_x += std::fabs(angle_difference(headings_[i], heading)) < kSameAngle ? 1U : 0U;
      from_y += std::fabs(angle_difference(headings_[i] + 0.5 * kPi, heading)) < kSameAngle ? 1U : 0U;
    }
    const std::size_t most = (points.size() - 2) * 8 / 10;
    line_ = content_.lines.front();
    if (from_x > most) return;
    warn("psi_rad", from_y > most ? "counts from +y (as TUM files do), recomputed from the points"
                                  : "disagrees with the points, recomputed from them");
  }

  static constexpr std::string_view kPlane = "columns x and y (or x_m and y_m) in metres";

  /// A comment that names columns, but not x and y.
  struct OtherNames {
    int line = 0;
    std::string text;
    std::size_t count = 0;
  };

  TrackReadOptions options_;
  TrackFile content_;
  OtherNames other_names_;
  std::optional<bool> closed_;
  std::vector<Field> fields_;
  std::vector<double> headings_;
  char separator_ = '\0';
  int line_ = 0;
};

}  // namespace

Result<TrackFile> parse_csv_track(std::string_view text, const std::string& file,
                                  const TrackReadOptions& options) {
  return TrackParser{file, options}.parse(text);
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
  if (content.is_own_size) text += "# track_scale=1\n";
  if (o.finish_s != 0.0) fmt::format_to(std::back_inserter(text), "# finish_s_m={}\n", o.finish_s);
  text += "# x_m,y_m,w_tr_right_m,w_tr_left_m\n";
  for (const road::TrackPoint& p : content.points) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{}\n", p.position.x(), p.position.y(), p.right,
                   p.left);
  }
  return text;
}

}  // namespace chicane::protocol
