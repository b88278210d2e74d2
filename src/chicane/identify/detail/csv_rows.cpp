// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/identify/detail/log_rows.hpp"
#include "chicane/protocol/csv_text.hpp"

namespace chicane::identify {
namespace {

/// What a column holds.
enum Quantity { kTime, kX, kY, kPsi, kSpeed, kYawRate, kSteer, kThrottle, kQuantities };

struct Meaning {
  std::string_view name;
  std::array<std::string_view, 5> others;  ///< names that mean the same
  bool is_needed;
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

struct Suffix {
  std::string_view end;
  double factor;
};
constexpr Suffix kSuffixes[] = {
    {"_degps", kPi / 180.0}, {"_radps", 1.0},     {"_deg", kPi / 180.0}, {"_rad", 1.0},
    {"_mps", 1.0},           {"_kmh", 1.0 / 3.6}, {"_mph", 0.44704},     {"_ms", 1e-3},
    {"_us", 1e-6},           {"_ns", 1e-9},       {"_s", 1.0},           {"_m", 1.0},
};

struct Column {
  std::size_t at = 0;
  double factor = 1.0;
};

/// A name without its unit, and the factor of the unit.
std::pair<std::string, double> parted(std::string_view name) {
  const std::string lower = protocol::lower(name);
  for (const Suffix& suffix : kSuffixes) {
    if (lower.size() > suffix.end.size() && lower.ends_with(suffix.end))
      return {lower.substr(0, lower.size() - suffix.end.size()), suffix.factor};
  }
  return {lower, 1.0};
}

bool means(const Meaning& meaning, std::string_view name) {
  return name == meaning.name || (!name.empty() && std::find(meaning.others.begin(), meaning.others.end(),
                                                             name) != meaning.others.end());
}

struct Header {
  std::array<std::optional<Column>, kQuantities> columns;
  std::size_t count = 0;
};

Result<Header> read_header(const std::vector<std::string_view>& names, const std::string& place,
                           const LogOptions& options) {
  Header header;
  header.count = names.size();
  for (std::size_t q = 0; q < kQuantities; ++q) {
    const Meaning& meaning = kMeanings[q];
    const auto configured = options.columns.find(std::string(meaning.name));
    for (std::size_t i = 0; i < names.size() && !header.columns[q]; ++i) {
      const auto [name, factor] = parted(names[i]);
      const bool is_it =
          configured == options.columns.end() ? means(meaning, name) : configured->second == names[i];
      if (is_it) header.columns[q] = Column{i, factor};
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

}  // namespace

Result<LogRows> read_csv_rows(const std::string& text, const std::string& file, const LogOptions& options) {
  LogRows rows;
  std::optional<Header> header;
  char separator = ',';
  protocol::CsvLines lines(text);
  const auto place = [&] { return fmt::format("{}:{}", file, lines.number()); };
  std::vector<std::string_view> named;
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
    std::array<double, kQuantities> row;
    row.fill(std::numeric_limits<double>::quiet_NaN());
    for (std::size_t q = 0; q < kQuantities; ++q) {
      if (!header->columns[q]) continue;
      const std::optional<double> value = protocol::number(values[header->columns[q]->at], separator);
      if (!value)
        return fail(ErrorCode::kParse,
                    fmt::format("{}: {}: got {}, expected a finite number", place(), kMeanings[q].name,
                                printable(values[header->columns[q]->at])));
      row[q] = *value * header->columns[q]->factor;
    }
    rows.samples.push_back({row[kTime], row[kX], row[kY], row[kPsi], row[kSpeed], row[kYawRate]});
    if (header->columns[kSteer]) rows.commands.push_back({row[kTime], row[kSteer], row[kThrottle]});
  }
  if (!header) return fail(ErrorCode::kParse, fmt::format("{}: got no header, expected one", file));
  return rows;
}

}  // namespace chicane::identify
