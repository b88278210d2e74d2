// SPDX-License-Identifier: MIT
// Logs of driving: recordings, bags and CSV files become samples and commands; units and signs are checked
// against the path.
#include "chicane/identify/drive_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/identify/detail/log_rows.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/library.hpp"

namespace chicane::identify {
namespace {

/// Quantity that a column of a CSV file may hold.
enum Quantity { kTime, kX, kY, kPsi, kSpeed, kYawRate, kSteer, kThrottle, kQuantities };

/// Names of the column of a quantity, without units.
struct Meaning {
  std::string_view name;
  std::array<std::string_view, 5> others;  ///< other names of the quantity
  bool is_needed;                          ///< a log must have the column
};
constexpr Meaning kMeanings[kQuantities] = {
    {"time", {"t", "timestamp", "stamp", "", ""}, true},
    {"x", {"pos_x", "position_x", "", "", ""}, true},
    {"y", {"pos_y", "position_y", "", "", ""}, true},
    {"psi", {"yaw", "heading", "theta", "", ""}, true},
    {"speed", {"v", "vx", "velocity", "", ""}, true},
    {"yaw_rate", {"r", "omega", "gyro_z", "", ""}, false},
    {"steer", {"steering", "steering_angle", "delta", "steer_angle"}, true},
    {"throttle", {"pedal", "", "", "", ""}, false},
};

/// Unit at the end of a column's name.
struct Suffix {
  std::string_view end;
  double factor;  ///< SI unit for one of this
};
constexpr Suffix kSuffixes[] = {
    {"_degps", kPi / 180.0}, {"_radps", 1.0},     {"_deg", kPi / 180.0}, {"_rad", 1.0},
    {"_mps", 1.0},           {"_kmh", 1.0 / 3.6}, {"_mph", 0.44704},     {"_ms", 1e-3},
    {"_us", 1e-6},           {"_ns", 1e-9},       {"_s", 1.0},           {"_m", 1.0},
};

/// Column of a CSV file.
struct Column {
  std::size_t at = 0;   ///< index
  double factor = 1.0;  ///< factor to SI
};

/// Name of a column without its unit, and the factor of the unit.
std::pair<std::string, double> parted(std::string_view name) {
  const std::string lower = chicane::lower(name);
  for (const Suffix& suffix : kSuffixes) {
    if (lower.size() > suffix.end.size() && lower.ends_with(suffix.end))
      return {lower.substr(0, lower.size() - suffix.end.size()), suffix.factor};
  }
  return {lower, 1.0};
}

/// Whether a quantity has this name.
bool means(const Meaning& meaning, std::string_view name) {
  const auto& others = meaning.others;
  return name == meaning.name ||
         (!name.empty() && std::find(others.begin(), others.end(), name) != others.end());
}

/// Header of a CSV file.
struct Header {
  /// Columns by quantity; none: the file has no column for it.
  std::array<std::optional<Column>, kQuantities> columns;
  std::size_t count = 0;  ///< number of all columns
};

/// Finds the columns of all quantities. `place`: of the header, for messages.
Result<Header> read_header(const std::vector<std::string_view>& names, const std::string& place,
                           const LogOptions& options) {
  Header header;
  header.count = names.size();
  for (std::size_t q = 0; q < kQuantities; ++q) {
    const Meaning& meaning = kMeanings[q];
    const auto configured = options.columns.find(std::string(meaning.name));
    for (std::size_t i = 0; i < names.size() && !header.columns[q]; ++i) {
      const auto [name, factor] = parted(names[i]);
      const bool is_found =
          configured == options.columns.end() ? means(meaning, name) : configured->second == names[i];
      if (is_found) header.columns[q] = Column{i, factor};
    }
    if (header.columns[q]) continue;
    if (configured != options.columns.end())
      return fail(ErrorCode::kParse, fmt::format("{}: header: got no column {}, expected one for {}", place,
                                                 printable(configured->second), meaning.name));
    if (!meaning.is_needed || (q == kSteer && !options.needs_commands)) continue;
    std::string got;
    for (const std::string_view name : names) got += (got.empty() ? "" : ",") + printable(name);
    return fail(ErrorCode::kParse,
                fmt::format("{}: header: got {}, expected a column {}; name it by --columns {}=NAME", place,
                            got.substr(0, 120), meaning.name, meaning.name));
  }
  return header;
}

/// Numbers of a row in SI, by quantity; NaN for a quantity without a column. `place`: function that names the
/// row in messages.
template <class Place>
Result<std::array<double, kQuantities>> numbers_of(const std::vector<std::string_view>& values,
                                                   const Header& header, char separator, const Place& place) {
  std::array<double, kQuantities> row;
  row.fill(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t q = 0; q < kQuantities; ++q) {
    if (!header.columns[q]) continue;
    const std::string_view text = values[header.columns[q]->at];
    const std::optional<double> value = protocol::number(text, separator);
    if (!value)
      return fail(ErrorCode::kParse, fmt::format("{}: {}: got {}, expected a finite number", place(),
                                                 kMeanings[q].name, printable(text)));
    row[q] = *value * header.columns[q]->factor;
  }
  return row;
}

}  // namespace

Result<LogRows> read_csv_rows(const std::string& text, const std::string& file, const LogOptions& options) {
  LogRows rows;
  std::optional<Header> header;
  char separator = ',';
  protocol::CsvLines lines(text);
  const auto place = [&] { return fmt::format("{}:{}", file, lines.number()); };
  std::vector<std::string_view> named;  // columns by position, for a file without header
  if (!options.positions.empty()) {
    named.resize(options.positions.rbegin()->first + 1);
    for (const auto& [at, name] : options.positions) named[at] = name;
    const auto read = read_header(named, "--columns", options);
    if (!read) return fail(read.error());
    header = *read;
  }
  for (std::optional<std::string_view> next = lines.next(); next; next = lines.next()) {
    std::string_view line = *next;
    if (!header) {
      line = protocol::trim(line.starts_with('#') ? line.substr(1) : line);
      if (line.empty()) continue;
      separator = protocol::separator_of(line);
      const auto read = read_header(protocol::split(line, separator), place(), options);
      if (!read) return fail(read.error());
      header = *read;
      continue;
    }
    if (line.empty() || line.starts_with('#')) continue;
    if (!named.empty() && rows.samples.empty()) separator = protocol::separator_of(line);
    const std::vector<std::string_view> values = protocol::split(line, separator);
    if (!named.empty() && rows.samples.empty()) header->count = std::max(named.size(), values.size());
    if (values.size() != header->count)
      return fail(ErrorCode::kParse,
                  fmt::format("{}: row: got {} columns, expected {}", place(), values.size(), header->count));
    const auto numbers = numbers_of(values, *header, separator, place);
    if (!numbers) return fail(numbers.error());
    const std::array<double, kQuantities>& row = *numbers;
    rows.samples.push_back({row[kTime], row[kX], row[kY], row[kPsi], row[kSpeed], row[kYawRate]});
    if (header->columns[kSteer]) rows.commands.push_back({row[kTime], row[kSteer], row[kThrottle]});
  }
  if (!header) return fail(ErrorCode::kParse, fmt::format("{}: got no header, expected one", file));
  return rows;
}

namespace {

// All limits from here on are chosen.
constexpr double kLongestGap = 0.5;   // [s] a longer gap between samples begins another part
constexpr double kShortestLog = 2.0;  // [s] a shorter part is left out
constexpr double kStretch = 0.2;      // [s] least duration of a stretch over which signals are compared

/// Order of samples and commands: by time.
constexpr auto kEarlier = [](const auto& a, const auto& b) { return a.time < b.time; };

/// Parts of a log between gaps and jumps, with increasing times. Unwraps the yaw; of samples with equal times
/// it keeps the first.
std::vector<DriveLog> parts_of(LogRows rows, const std::string& file) {
  std::vector<DriveLog> parts;
  const DriveLog empty{file, {}, {}, rows.is_centre_of_mass};
  DriveLog part = empty;
  std::vector<SentCommand>& commands = rows.commands;
  std::stable_sort(commands.begin(), commands.end(), kEarlier);
  // A yaw rate of 0 throughout is not measured: odometry messages have the field in any case.
  const bool has_yaw_rate = std::any_of(rows.samples.begin(), rows.samples.end(),
                                        [](const Sample& each) { return each.yaw_rate != 0.0; });
  const auto finish = [&] {
    if (!part.samples.empty() && part.samples.back().time - part.samples.front().time >= kShortestLog) {
      // Commands of the last second before the part may still act.
      const auto from = std::lower_bound(commands.begin(), commands.end(),
                                         SentCommand{.time = part.samples.front().time - 1.0}, kEarlier);
      const auto to = std::upper_bound(commands.begin(), commands.end(),
                                       SentCommand{.time = part.samples.back().time}, kEarlier);
      part.commands.assign(from, to);
      if (!part.commands.empty()) parts.push_back(std::move(part));
    }
    part = empty;
  };
  for (const Sample& each : rows.samples) {
    Sample now = each;
    if (!has_yaw_rate) now.yaw_rate = std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(now.x + now.y + now.psi + now.speed)) continue;
    if (!part.samples.empty()) {
      const Sample& last = part.samples.back();
      const double passed = now.time - last.time;
      if (passed == 0.0) continue;
      const double moved = hypot(now.x - last.x, now.y - last.y);
      if (passed < 0.0 || passed > kLongestGap ||
          moved > 2.0 + 3.0 * passed * std::max(now.speed, last.speed)) {
        finish();
      } else {
        now.psi = last.psi + wrap_angle(now.psi - last.psi);
      }
    }
    part.samples.push_back(now);
  }
  finish();
  return parts;
}

/// Sums over all parts of a log that show whether the signals agree with the path. They are taken over
/// stretches of kStretch, because the noise of single positions would lengthen the path.
struct Agreement {
  double path = 0.0, speed_path = 0.0;             ///< length of the path by positions, and by speed [m]
  double along = 0.0;                              ///< path in the direction of the yaw [m]
  double turned_with = 0.0, turned_against = 0.0;  ///< turning of the path with the yaw, and against it [rad]
  double steer_with = 0.0, steer_against = 0.0;    ///< steering with the yaw rate, and against it [rad s]
  double most_steer = 0.0;                         ///< largest steering angle [rad]

  /// Adds one part.
  void look_at(const DriveLog& log) {
    std::size_t command = 0;
    double last_course = std::numeric_limits<double>::quiet_NaN();
    std::size_t begin = 0;
    for (std::size_t i = 1; i < log.samples.size(); ++i) {
      if (log.samples[i].time - log.samples[begin].time < kStretch) continue;
      const Sample& a = log.samples[std::exchange(begin, i)];
      const Sample& b = log.samples[i];
      const double dx = b.x - a.x, dy = b.y - a.y, dt = b.time - a.time;
      const double moved = hypot(dx, dy);
      if (0.5 * (a.speed + b.speed) * dt < 0.02 || a.speed < 0.3) continue;  // the car stands: noise alone
      path += moved;
      speed_path += 0.5 * (a.speed + b.speed) * dt;
      const double middle = 0.5 * (a.psi + b.psi);
      along += dx * cos(middle) + dy * sin(middle);
      const double course = atan2(dy, dx);
      const double yawed = b.psi - a.psi;
      if (std::isfinite(last_course)) {
        const double turned = wrap_angle(course - last_course);
        (turned * yawed >= 0.0 ? turned_with : turned_against) +=
            std::min(std::fabs(turned), std::fabs(yawed));
      }
      last_course = course;
      while (command + 1 < log.commands.size() && log.commands[command + 1].time <= a.time - 0.1) ++command;
      const double steer = log.commands[command].steer;
      most_steer = std::max(most_steer, std::fabs(steer));
      (steer * yawed >= 0.0 ? steer_with : steer_against) += std::fabs(steer) * dt;
    }
  }
};

/// Checks units and signs of the signals. The fault names the signal that contradicts the path.
Result<void> check(const Agreement& seen, const std::string& file) {
  const auto fault = [&](const std::string& text) { return fail(ErrorCode::kParse, file + ": " + text); };
  if (seen.path < 20.0 && seen.speed_path < 20.0)
    return fault(fmt::format("got {:.1f} m of driving, expected at least 20 m", seen.path));
  const double ratio = seen.speed_path / std::max(seen.path, 1e-9);
  if (ratio < 0.8 || ratio > 1.25) {
    const char* guess = std::fabs(ratio - 2.237) < 0.15 ? "; is it in mph?"
                        : std::fabs(ratio - 3.6) < 0.25 ? "; is it in km/h?"
                                                        : "";
    return fault(fmt::format("speed: got {:.2f} times the speed of the path, expected 1{}", ratio, guess));
  }
  if (seen.turned_against > 2.0 * seen.turned_with && seen.turned_against > 0.5)
    return fault("psi: got a yaw that turns against the path, expected left positive");
  if (seen.along < 0.7 * seen.path)
    return fault(
        fmt::format("psi: got a car that moves {:.0f} % of its way forwards, expected nearly all; yaw is "
                    "counted from +x, left positive [rad]",
                    100.0 * seen.along / seen.path));
  if (seen.most_steer > 1.2)
    return fault(
        fmt::format("steer: got {:.3g} rad, expected a road-wheel angle below 1.2 rad; "
                    "is it in degrees? (name the column steer_deg)",
                    seen.most_steer));
  if (seen.steer_against > 2.0 * seen.steer_with && seen.steer_against > 0.02)
    return fault("steer: got steering against the turning, expected left positive");
  return {};
}

/// Reads a file of any format.
Result<LogRows> read_rows(const std::string& file, const LogOptions& options) {
  std::string head(8, ' ');
  std::ifstream(file, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  if (head == "#ROSBAG ")
    return fail(ErrorCode::kParse, file + ": got a bag of ROS 1, expected one of ROS 2");
  if (file.ends_with(".mcap")) return read_mcap_rows(file, options);
  if (file.ends_with(".db3")) return read_sqlite_rows(file, options);
  const Result<std::string> text = protocol::read_file(file);
  return text ? read_csv_rows(*text, file, options) : fail(text.error());
}

/// The file, or all files of a bag, which is a folder in rosbag2.
Result<std::vector<std::string>> files_of(const std::string& path) {
  std::error_code trouble;
  if (!std::filesystem::is_directory(path, trouble)) return std::vector<std::string>{path};
  std::vector<std::string> files;
  for (const auto& each : std::filesystem::directory_iterator(path, trouble)) {
    const std::string name = each.path().string();
    if (name.ends_with(".mcap") || name.ends_with(".db3")) files.push_back(name);
  }
  if (trouble) return fail(ErrorCode::kIo, path + ": " + trouble.message());
  if (files.empty())
    return fail(ErrorCode::kParse, path + ": got a folder without .mcap or .db3, expected a bag of ROS 2");
  std::sort(files.begin(), files.end());
  return files;
}

/// Parts of a log, if its signals agree with the path.
Result<std::vector<DriveLog>> checked(Result<LogRows> rows, const std::string& file) {
  if (!rows) return fail(rows.error());
  std::vector<DriveLog> parts = parts_of(std::move(*rows), file);
  Agreement seen;
  for (const DriveLog& part : parts) seen.look_at(part);
  if (const Result<void> good = check(seen, file); !good) return fail(good.error());
  return parts;
}

}  // namespace

Result<std::vector<DriveLog>> parse_csv_log(const std::string& text, const std::string& file,
                                            const LogOptions& options) {
  return checked(read_csv_rows(text, file, options), file);
}

Result<std::vector<DriveLog>> read_log(const std::string& file, const LogOptions& options) {
  const auto files = files_of(file);
  if (!files) return fail(files.error());
  std::vector<DriveLog> all;
  for (const std::string& each : *files) {
    auto parts = checked(read_rows(each, options), each);
    if (!parts) return fail(parts.error());
    std::move(parts->begin(), parts->end(), std::back_inserter(all));
  }
  return all;
}

Result<DriveLog> read_plain_log(const std::string& file, const LogOptions& options) {
  const auto files = files_of(file);
  if (!files) return fail(files.error());
  if (files->size() > 1)
    return fail(ErrorCode::kParse,
                fmt::format("{}: got a bag of {} files, expected one of them", file, files->size()));
  Result<LogRows> rows = read_rows(files->front(), options);
  if (!rows) return fail(rows.error());
  std::erase_if(rows->samples, [](const Sample& each) {
    return !std::isfinite(each.time + each.x + each.y + each.psi + each.speed);
  });
  std::erase_if(rows->commands,
                [](const SentCommand& each) { return !std::isfinite(each.time + each.steer); });
  std::stable_sort(rows->samples.begin(), rows->samples.end(), kEarlier);
  std::stable_sort(rows->commands.begin(), rows->commands.end(), kEarlier);
  if (rows->samples.empty())
    return fail(ErrorCode::kParse, file + ": got no sample of a car, expected places and speeds");
  return DriveLog{file, std::move(rows->samples), std::move(rows->commands), rows->is_centre_of_mass};
}

}  // namespace chicane::identify
