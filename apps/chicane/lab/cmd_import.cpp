// SPDX-License-Identifier: MIT
// `chicane import`: reads a road from a file of any known format, checks it, and writes it as CSV with a
// preview of what was recognised.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "chicane/base/file.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/occupancy_map.hpp"
#include "chicane/protocol/origin.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/recording/html_report.hpp"
#include "chicane/road/track.hpp"
#include "commands.hpp"
#include "option_row.hpp"
#include "progress.hpp"

namespace chicane::apps {
namespace {

using protocol::ReportDocument;

// Detail of the preview; chosen: as much as a screen shows.
constexpr int kSteps = 800;                // samples along the road
constexpr double kCells = 500.0;           // cells along the longer side of a map
constexpr std::size_t kMostPoints = 4000;  // limit of drawn points of the file

/// State of a place on a map.
enum Place { kWall, kFree, kUnknown, kOutside };

/// State of a map at a position in W.
Place place_in(const protocol::OccupancyMap& map, const survey::FreeSpace& space, const Vec2& at) {
  const Vec2 cell = space.to_cells(at);
  const int column = static_cast<int>(std::floor(cell.x())), row = static_cast<int>(std::floor(cell.y()));
  if (column < 0 || row < 0 || column >= space.width || row >= space.height) return kOutside;
  const int y = space.height - 1 - row;
  const double dark = map.darkness(column, y);
  if (dark > map.occupied) return kWall;
  return dark < map.free && !map.is_unknown(column, y) ? kFree : kUnknown;
}

/// Draws the map between two corners, as rectangles of the height of a step.
void add_map(ReportDocument& document, const protocol::OccupancyMap& map, const Vec2& low, const Vec2& high) {
  const survey::FreeSpace space{.width = map.image.width,
                                .height = map.image.height,
                                .resolution = map.resolution,
                                .origin = map.origin,
                                .yaw = map.yaw};
  const double step = std::max(map.resolution, std::max(high.x() - low.x(), high.y() - low.y()) / kCells);
  const int width = static_cast<int>((high.x() - low.x()) / step);
  std::array<std::vector<double>, kOutside> cells;
  for (double y = low.y(); y < high.y(); y += step)
    for (int from = 0, to = 0; from < width; from = to) {
      const auto place = [&](int x) {
        return place_in(map, space, Vec2{low.x() + (x + 0.5) * step, y + 0.5 * step});
      };
      const Place here = place(from);
      for (to = from + 1; to < width && place(to) == here;) ++to;
      if (here != kOutside)
        cells[here].insert(cells[here].end(), {low.x() + from * step, y, (to - from) * step, step});
    }
  document.add_series("cells", "faint", "unknown", cells[kUnknown]);
  document.add_series("cells", "paper", "free", cells[kFree]);
  document.add_series("cells", "soft", "wall", cells[kWall]);
}

/// Coordinates x, y, x, y, … of positions.
std::vector<double> numbers_of(const std::vector<Vec2>& places) {
  std::vector<double> numbers;
  for (const Vec2& place : places) numbers.insert(numbers.end(), {place.x(), place.y()});
  return numbers;
}

/// Draws the start line and an arrow in the direction of driving; `extent`: size of the road [m].
void add_start(ReportDocument& document, const road::Track& track, double extent) {
  const auto start = track.centre().at(track.start_s());
  const double left = track.left_width(track.start_s()), right = track.right_width(track.start_s());
  const Vec2 along{cos(start.heading), sin(start.heading)}, across{-along.y(), along.x()};
  const double reach = std::max(left + right, 0.03 * extent);
  const Vec2 tip = start.position + reach * along;
  document.add_series("line", "good", "start",
                      numbers_of({start.position + left * across, start.position - right * across}));
  document.add_series("line", "good", "", numbers_of({start.position, tip}));
  document.add_series("line", "good", "",
                      numbers_of({tip - 0.3 * reach * (along - 0.6 * across), tip,
                                  tip - 0.3 * reach * (along + 0.6 * across)}));
}

/// HTML document (protocol/json.hpp) of the preview: `words`, and a drawing of the map or the points of the
/// file, edges, line, start and direction.
std::string preview_of(const road::Track& track, const protocol::TrackFile& content,
                       const std::string& words) {
  std::vector<Vec2> line, left, right, points;
  for (int i = 0; i <= kSteps; ++i) {
    const double s = track.length() * i / kSteps;
    const auto at = track.centre().at(s);
    const Vec2 normal{-sin(at.heading), cos(at.heading)};
    line.push_back(at.position);
    left.push_back(at.position + track.left_width(s) * normal);
    right.push_back(at.position - track.right_width(s) * normal);
  }
  Vec2 low = line.front(), high = low;
  for (const std::vector<Vec2>* each : {&left, &right})
    for (const Vec2& place : *each) {
      low = min(low, place);
      high = max(high, place);
    }
  const double extent = std::max(high.x() - low.x(), high.y() - low.y());
  ReportDocument document("import", std::filesystem::path(content.file).filename().string());
  document.add_text(words);
  for (const std::string& warning : content.warnings) document.add_text(warning);
  document.begin_map("what was recognised [m]", "x [m]");
  const Vec2 margin{0.05 * extent, 0.05 * extent};  // around the road
  if (const auto map = protocol::read_map(content.file)) add_map(document, *map, low - margin, high + margin);
  const std::size_t step = content.points.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < content.points.size(); i += step) points.push_back(content.points[i].position);
  document.add_series("dots", "soft", "points of the file", numbers_of(points));
  document.add_series("line", "ink", "edge", numbers_of(left));
  document.add_series("line", "ink", "", numbers_of(right));
  document.add_series("line", "other", "line", numbers_of(line));
  add_start(document, track, extent);
  return document.text();
}

using protocol::TrackFile;
using protocol::TrackReadOptions;

// Sizes by which a road is judged; chosen.
constexpr double kModelRoad = 3.0;     // [m] mean width below which a road is for model cars
constexpr double kModelNarrow = 2.5;   // [m] least width below which a road is for model cars
constexpr double kWideRoad = 30.0;     // [m] mean width above which the file may be in another unit
constexpr double kModelScale = 0.1;    // scale of assumed noise and spacing on a road for model cars
constexpr double kPointsAcross = 5.0;  // width of the road over the spacing of written points

/// Road of the file, with the figures of the report.
struct Imported {
  TrackFile content;
  road::Track track;
  std::string kind;                      ///< format of the file: "occupancy map"
  double spacing = 0.0;                  ///< distance between the written points [m]
  double mean_width = 0.0;               ///< mean width of the road [m]
  road::PointFit fit{};                  ///< distance of the file's points from the line
  double narrowest = 1e9, widest = 0.0;  ///< least and largest width [m]
  double sharpest = 0.0;                 ///< largest curvature [1/m]

  /// Whether the road is for model cars.
  [[nodiscard]] bool is_model() const noexcept { return mean_width < kModelRoad || narrowest < kModelNarrow; }
};

/// Options of the reader by the command line; `scale`: of assumed noise and spacing.
TrackReadOptions read_options(const Options::Import& import, double scale) {
  using Direction = TrackReadOptions::Direction;
  TrackReadOptions options{.scale = scale,
                           .smoothing_sigma = import.smoothing,
                           .least_width = import.least_width,
                           .columns = import.columns};
  if (import.width) options.default_left = options.default_right = 0.5 * *import.width / scale;
  if (import.is_closed || import.is_open) options.is_closed = import.is_closed;
  if (import.start.size() == 2) options.start = Vec2{import.start[0], import.start[1]};
  options.direction = import.direction == "cw"         ? Direction::kRight
                      : import.direction == "ccw"      ? Direction::kLeft
                      : import.direction == "reversed" ? Direction::kReversed
                                                       : Direction::kOfTheFile;
  return options;
}

/// Mean width of the road at the points of a file [m].
double mean_width(const TrackFile& content) {
  double sum = 0.0;
  for (const road::TrackPoint& point : content.points) sum += point.left + point.right;
  return sum / static_cast<double>(content.points.size());
}

/// Measures the distance of the file's points from the line, and the road's widths and curvature.
void measure(Imported& road) {
  const road::Path& centre = road.track.centre();
  road.fit = road::point_fit(road.track);
  const double step = road.track.length() / std::ceil(road.track.length() / (0.5 * road.spacing));
  for (double s = 0.0; s < road.track.length(); s += step) {
    const double width = road.track.left_width(s) + road.track.right_width(s);
    road.narrowest = std::min(road.narrowest, width);
    road.widest = std::max(road.widest, width);
    road.sharpest = std::max(road.sharpest, std::fabs(centre.at(s).curvature));
  }
}

/// Reads and measures the road.
Result<Imported> read_road(const Options::Import& import) {
  const Result<std::string> text = protocol::read_file(import.file);
  if (!text) return fail(text.error());
  Result<TrackFile> content = protocol::parse_track(*text, import.file, read_options(import, 1.0));
  if (!content) return fail(content.error());
  if (mean_width(*content) < kModelRoad) {
    content = protocol::parse_track(*text, import.file, read_options(import, kModelScale));
    if (!content) return fail(content.error());
  }
  const double width = mean_width(*content);
  if (width > kWideRoad)
    content->warnings.push_back(
        fmt::format("{}: size: {:.0f} m wide on average, expected at most {:g} m: is "
                    "the file in metres (a map: is its resolution)?",
                    import.file, width, kWideRoad));
  const double usual = std::clamp(width / kPointsAcross, 0.05, 2.0);  // [m]
  Result<road::Track> track = protocol::make_track(*content);
  if (!track) return fail(track.error());
  Imported road{.content = std::move(*content),
                .track = std::move(*track),
                .kind = std::string{protocol::road_kind(*text)},
                .spacing = import.spacing.value_or(usual),
                .mean_width = width};
  measure(road);
  return road;
}

/// Smoothed line as evenly spaced points, which need no further smoothing.
TrackFile resampled(const Imported& road) {
  TrackFile out;
  out.is_closed = road.track.centre().is_closed();
  out.options = road.content.options;
  out.options.smoothing_sigma = 0.0;
  out.options.spacing = road.spacing;
  const double length = road.track.length();
  const int count = std::max(8, static_cast<int>(std::lround(length / road.spacing)));
  const auto rounded = [](double value) { return std::round(1e4 * value) / 1e4; };  // 0.1 mm
  for (int i = 0; i <= (out.is_closed ? count - 1 : count); ++i) {
    const double s = length * i / count;
    const Vec2 place = road.track.centre().at(s).position;
    out.points.push_back({{rounded(place.x()), rounded(place.y())},
                          rounded(road.track.left_width(s)),
                          rounded(road.track.right_width(s))});
  }
  return out;
}

/// Figures of the road in words.
std::string in_words(const Imported& road) {
  return fmt::format(
      "{} road, {:.{}f} m long, {:.2f} to {:.2f} m wide, {}; {} points of the file are {:.3f} m from its "
      "line (rms), {:.3f} m at most",
      road.track.centre().is_closed() ? "closed" : "open", road.track.length(), road.is_model() ? 2 : 1,
      road.narrowest, road.widest,
      road.sharpest > 1e-6 ? fmt::format("tightest radius {:.2f} m", 1.0 / road.sharpest) : "straight",
      road.content.points.size(), road.fit.rms, road.fit.most);
}

/// Figures of the road as JSON.
std::string in_json(const Imported& road) {
  nlohmann::ordered_json json;
  json["is_closed"] = road.track.centre().is_closed();
  json["length_m"] = road.track.length();
  json["narrowest_m"] = road.narrowest;
  json["widest_m"] = road.widest;
  json["tightest_radius_m"] =
      road.sharpest > 0.0 ? nlohmann::ordered_json(1.0 / road.sharpest) : nlohmann::ordered_json(nullptr);
  json["points"] = road.content.points.size();
  json["rms_m"] = road.fit.rms;
  json["max_m"] = road.fit.most;
  json["notices"] = road.content.warnings;
  return json.dump(2) + "\n";
}

/// Head of the written file: source, fit of the line, assumptions.
std::string description_of(const Imported& road, const std::string& file) {
  std::string text = fmt::format(
      "From {} by chicane import\n{}{}: its {} points are {:.3f} m from the line (rms), {:.3f} m at most",
      std::filesystem::path(file).filename().string(), protocol::kNote, road.kind, road.content.points.size(),
      road.fit.rms, road.fit.most);
  for (const std::string& warning : road.content.warnings)
    text += fmt::format("\n{}{}", protocol::kNote,
                        warning.starts_with(file + ": ") ? warning.substr(file.size() + 2) : warning);
  return text;
}

/// Runs `chicane import`.
Result<void> import_and_report(const Options& options) {
  const Options::Import& import = options.import_;
  // Check the names of all outputs before any work.
  if (Result<void> named = check_page_name("--preview", import.preview); !named) return named;
  for (const std::string& file : {options.output_file, import.preview})
    if (Result<void> writable = check_writable(file); !writable) return writable;
  if (!options.output_file.empty() && !options.output_file.ends_with(".csv"))
    return fail(
        ErrorCode::kInvalidArgument,
        fmt::format("--output: got {}, expected a name that ends in .csv", printable(options.output_file)));
  const Result<Imported> road = read_road(import);
  if (!road) return fail(road.error());
  for (const std::string& warning : road->content.warnings) print_sentence(stderr, warning);
  const std::string csv = protocol::write_csv_track(resampled(*road), description_of(*road, import.file));
  // Read the written file back: it must be a road.
  const Result<TrackFile> again = protocol::parse_track(
      csv, options.output_file.empty() ? import.file : options.output_file, {.scale = road->content.scale});
  if (!again) return fail(again.error());
  if (const Result<road::Track> made = protocol::make_track(*again); !made) return fail(made.error());
  if (!options.output_file.empty())
    if (Result<void> kept = write_file(options.output_file, csv); !kept) return kept;
  if (!import.preview.empty()) {
    const auto kept = recording::write_document(
        import.preview, preview_of(road->track, road->content, in_words(*road)), live::document_bundle());
    if (!kept) return fail(kept.error());
  }
  // Report on stdout.
  if (options.is_json) {
    fmt::print("{}", in_json(*road));
    return {};
  }
  print_sentence(stdout, fmt::format("{}: {}", import.file, in_words(*road)));
  if (!options.output_file.empty())
    fmt::print("{}: chicane drive --track {}{}\n", options.output_file, options.output_file,
               road->is_model() ? " --car f1tenth" : "");
  return {};
}

}  // namespace

ExitCode import_road(const Options& options) {
  const Result<void> done = import_and_report(options);
  return done ? kSuccess : report(done.error());
}

}  // namespace chicane::apps
