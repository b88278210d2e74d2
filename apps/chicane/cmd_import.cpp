// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "chicane/base/file.hpp"
#include "chicane/base/text.hpp"
#include "chicane/live/assets.hpp"
#include "chicane/protocol/csv_track.hpp"
#include "chicane/protocol/foreign_tracks.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/origin.hpp"
#include "chicane/recording/html_report.hpp"
#include "chicane/road/point_fit.hpp"
#include "commands.hpp"
#include "import_preview.hpp"
#include "record.hpp"

namespace chicane::apps {
namespace {

using protocol::TrackFile;
using protocol::TrackReadOptions;

constexpr double kModelRoad = 3.0;     // a narrower road is that of a model car [m]
constexpr double kWideRoad = 30.0;     // a wider road may have another unit [m]
constexpr double kModelScale = 0.1;    // scale of a model road's assumed noise and spacing
constexpr double kPointsAcross = 5.0;  // spacing of the points is the width over this

/// A road as it was read, and as it is written.
struct Imported {
  TrackFile content;
  road::Track track;
  std::string kind;         ///< "occupancy map"
  double spacing = 0.0;     ///< distance between the written points [m]
  double mean_width = 0.0;  ///< [m]
  road::PointFit fit{};
  double narrowest = 1e9, widest = 0.0;  ///< [m]
  double sharpest = 0.0;                 ///< curvature [1/m]

  [[nodiscard]] bool is_model() const noexcept { return mean_width < kModelRoad; }
};

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

double mean_width(const TrackFile& content) {
  double sum = 0.0;
  for (const road::TrackPoint& point : content.points) sum += point.left + point.right;
  return sum / static_cast<double>(content.points.size());
}

/// How far the points of the file are from the line, and what the road is like.
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
  const double usual = std::clamp(width / kPointsAcross, 0.05, 2.0);
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

/// The smooth line as evenly spaced points, which need no smoothing any more.
TrackFile resampled(const Imported& road) {
  TrackFile out;
  out.is_closed = road.track.centre().is_closed();
  out.options = road.content.options;
  out.options.smoothing_sigma = 0.0;
  out.options.spacing = road.spacing;
  const double length = road.track.length();
  const int count = std::max(8, static_cast<int>(std::lround(length / road.spacing)));
  const auto rounded = [](double value) { return std::round(1e4 * value) / 1e4; };
  for (int i = 0; i <= (out.is_closed ? count - 1 : count); ++i) {
    const double s = length * i / count;
    const Vec2 place = road.track.centre().at(s).position;
    out.points.push_back({{rounded(place.x()), rounded(place.y())},
                          rounded(road.track.left_width(s)),
                          rounded(road.track.right_width(s))});
  }
  return out;
}

std::string in_words(const Imported& road) {
  return fmt::format(
      "{} road, {:.{}f} m long, {:.2f} to {:.2f} m wide, {}; {} points of the file are {:.3f} m from its "
      "line (rms), {:.3f} m at most",
      road.track.centre().is_closed() ? "closed" : "open", road.track.length(), road.is_model() ? 2 : 1,
      road.narrowest, road.widest,
      road.sharpest > 1e-6 ? fmt::format("tightest radius {:.2f} m", 1.0 / road.sharpest) : "straight",
      road.content.points.size(), road.fit.rms, road.fit.most);
}

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

/// The head of the written file: what was read, how well the line fits, what was assumed.
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

Result<void> import_and_tell(const Options& options) {
  const Options::Import& import = options.import_;
  if (Result<void> named = check_page_name("--preview", import.preview); !named) return named;
  for (const std::string& file : {options.output_file, import.preview})
    if (Result<void> writable = check_writable(file); !writable) return writable;
  if (!options.output_file.empty() && !options.output_file.ends_with(".csv"))
    return fail(
        ErrorCode::kInvalidArgument,
        fmt::format("--output: got {}, expected a name that ends in .csv", printable(options.output_file)));
  const Result<Imported> road = read_road(import);
  if (!road) return fail(road.error());
  for (const std::string& warning : road->content.warnings) fmt::print(stderr, "{}\n", warning);
  const std::string csv = protocol::write_csv_track(resampled(*road), description_of(*road, import.file));
  // The written file is read again: it has to be a road.
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
  if (options.is_json) {
    fmt::print("{}", in_json(*road));
    return {};
  }
  fmt::print("{}: {}\n", import.file, in_words(*road));
  if (!options.output_file.empty())
    fmt::print("{}: chicane drive --track {}{}\n", options.output_file, options.output_file,
               road->is_model() ? " --car f1tenth" : "");
  return {};
}

}  // namespace

ExitCode import_road(const Options& options) {
  const Result<void> done = import_and_tell(options);
  return done ? kSuccess : report(done.error());
}

}  // namespace chicane::apps
