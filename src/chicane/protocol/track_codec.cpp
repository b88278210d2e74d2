// SPDX-License-Identifier: MIT
// List of formats of road files, choice of the format by content and name, and making of roads from files.
#include "chicane/protocol/track_codec.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <filesystem>

#include "chicane/protocol/detail/road_rows.hpp"
#include "chicane/protocol/library.hpp"

namespace chicane::protocol {
namespace {

/// Formats by extension. A new format is a line here and its include.
constexpr std::array kFormats{
    kCsvTrack,
};

constexpr auto kExtensions = [] {
  std::array<std::string_view, kFormats.size()> extensions{};
  for (std::size_t i = 0; i < extensions.size(); ++i) extensions[i] = kFormats[i].extension;
  return extensions;
}();

/// Message of Track::create, "points[57]: …", after the file and the line of that point.
std::string with_line(const std::string& message, const TrackFile& content) {
  constexpr std::string_view kPrefix = "points[";
  std::size_t index = 0;
  if (message.starts_with(kPrefix)) {
    const char* end = message.data() + message.size();
    if (std::from_chars(message.data() + kPrefix.size(), end, index).ec == std::errc{} &&
        index < content.lines.size()) {
      return fmt::format("{}:{}: {}", content.file, content.lines[index], message);
    }
  }
  return fmt::format("{}: {}", content.file, message);
}

const TrackFormat* foreign_format_of(std::string_view text) noexcept {
  for (const TrackFormat& format : foreign_tracks())
    if (format.recognises(text)) return &format;
  return nullptr;
}

}  // namespace

bool is_foreign_track(std::string_view text) noexcept { return foreign_format_of(text) != nullptr; }

std::span<const std::string_view> track_extensions() noexcept { return kExtensions; }

const TrackFormat* track_format_of(std::string_view file) noexcept {
  for (const TrackFormat& format : kFormats) {
    if (file.ends_with(format.extension)) return &format;
  }
  return nullptr;
}

Result<TrackFile> parse_track(std::string_view text, const std::string& file,
                              const TrackReadOptions& options) {
  for (const double width : {options.default_left, options.default_right}) {
    if (!(width > 0.0 && width <= kMaxTrackWidth)) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("default width: got {}, expected a width > 0 and <= 1000 m", width));
    }
  }
  if (!(options.scale > 0.0 && options.scale <= kMaxTrackScale)) {
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("scale: got {}, expected a number > 0 and <= {}", options.scale, kMaxTrackScale));
  }
  if (text.size() > kMaxTrackBytes)
    return fail(fault_of(file, 0, "file", fmt::format("{} bytes", text.size()), "at most 64 MiB"));
  if (text.starts_with("version https://git-lfs.github.com/"))
    return fail(fault_of(file, 1, "file", "a pointer of git-LFS", "the file itself (git lfs pull)"));
  const TrackFormat* format = foreign_format_of(text);
  if (format == nullptr) format = track_format_of(file);
  Result<TrackFile> content = (format != nullptr ? *format : kFormats.front()).parse(text, file, options);
  if (content) arrange(*content, options);
  return content;
}

Result<road::Track> make_track(const TrackFile& content) {
  const std::string name = std::filesystem::path{content.file}.stem().string();
  const double scale = content.scale;
  std::vector<road::TrackPoint> points = content.points;
  for (road::TrackPoint& point : points)
    point = {(1.0 / scale) * point.position, point.left / scale, point.right / scale};
  road::TrackOptions options = content.options;
  for (const TrackSetting& setting : kTrackSettings) options.*setting.length /= scale;
  Result<road::Track> track = road::Track::create(name, points, content.is_closed, options);
  const bool is_model = scale != 1.0;
  if (!track) {
    const std::string size = is_model ? fmt::format(" (in full size: metres of the file / {})", scale) : "";
    return fail(ErrorCode::kParse, with_line(track.error().message, content) + size);
  }
  return is_model ? track->scaled(scale) : std::move(track);
}

Result<road::Track> read_track(const std::string& file, const TrackReadOptions& options) {
  const Result<std::string> text = read_file(file);
  if (!text) return fail(text.error());
  const Result<TrackFile> content = parse_track(*text, file, options);
  return content ? make_track(*content) : fail(content.error());
}

}  // namespace chicane::protocol
