// SPDX-License-Identifier: MIT
// Reads the remarks of car and road files: intervals of identified parameters, and the lines at a file's
// head.
#include "chicane/protocol/origin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "chicane/base/text.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/track_codec.hpp"

namespace chicane::protocol {
namespace {

constexpr std::string_view kLogRemark = "[log] ";
constexpr std::string_view kTo = " to ";
// Chosen: bounds the message that has the origin.
constexpr std::size_t kMostRemarks = 12;
constexpr std::size_t kLongestRemark = 300;  // [byte]
constexpr std::size_t kMostParameters = 200;

/// Identified value in a line of a car file: "  mass_kg: 3.4  # [log] 3.2 to 3.6".
std::optional<IdentifiedValue> identified_line(std::string_view line) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const std::size_t colon = line.find(": ");
  const std::size_t remark = line.find("  # [");
  if (colon == std::string_view::npos || remark == std::string_view::npos || remark < colon) return {};
  const std::optional<double> value = number(trim(line.substr(colon + 2, remark - colon - 2)));
  if (!value) return {};
  IdentifiedValue found{std::string{trim(line.substr(0, colon))}, *value, kNone, kNone};
  const std::string_view words = trim(line.substr(remark + 4));
  if (words == kAssumedRemark) return found;
  const std::size_t to = words.find(kTo);
  if (!words.starts_with(kLogRemark) || to == std::string_view::npos) return {};
  const std::optional<double> low = number(words.substr(kLogRemark.size(), to - kLogRemark.size()));
  const std::optional<double> high = number(words.substr(to + kTo.size()));
  if (!low || !high) return {};
  found.low = *low;
  found.high = *high;
  return found;
}

/// Beginning of a file's text as UTF-8, with "?" for other bytes and control characters.
std::string readable(std::string_view text) {
  std::string out;
  while (!text.empty() && out.size() < kLongestRemark) {
    const std::size_t length = utf8_length(text);
    const bool is_control = static_cast<unsigned char>(text.front()) < 0x20;
    out += length == 0 || is_control ? std::string_view("?") : text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return out;
}

/// Notices of the road's reader, which begin with its `file`, without file and line.
std::vector<std::string> notes_of(const std::string& file, const std::vector<std::string>& notices) {
  std::vector<std::string> notes;
  for (const std::string& notice : notices) {
    std::string_view text = notice;
    if (!text.starts_with(file + ":")) continue;
    text.remove_prefix(file.size() + 1);
    const std::size_t digits = text.find_first_not_of("0123456789");
    if (digits != 0 && digits != std::string_view::npos && text[digits] == ':')
      text.remove_prefix(digits + 1);
    notes.emplace_back(trim(text));
  }
  return notes;
}

/// Text of the file of a name on a shelf; sets `file` to its path.
Result<std::string> text_of(Shelf shelf, const std::string& name, std::string& file) {
  const Result<std::string> found = locate(shelf, name);
  if (!found) return fail(found.error());
  file = *found;
  return read_file(file);
}

}  // namespace

std::string band_remark(double low, double high) {
  return fmt::format("{}{}{}{}", kLogRemark, number_text(low, 3), kTo, number_text(high, 3));
}

std::vector<IdentifiedValue> identified_in(std::string_view car_file) {
  std::vector<IdentifiedValue> found;
  bool has_band = false;
  for (const std::string_view line : split(car_file, '\n')) {
    const std::optional<IdentifiedValue> each = identified_line(line);
    if (!each || found.size() == kMostParameters) continue;
    has_band = has_band || each->low <= each->high;
    found.push_back(*each);
  }
  if (!has_band) found.clear();  // without an interval no log was used
  return found;
}

std::vector<std::string> head_remarks(std::string_view text) {
  std::vector<std::string> remarks;
  CsvLines lines(text);
  for (auto line = lines.next(); line && remarks.size() < kMostRemarks; line = lines.next()) {
    if (line->empty()) continue;
    if (line->front() != '#' && line->front() != '%') break;
    std::string_view words = trim(line->substr(std::min(line->find_first_not_of("#%"), line->size())));
    const bool is_note = words.starts_with(kNote);
    if (is_note) words.remove_prefix(kNote.size());
    const bool is_other = words.empty() || words.front() == '[' || words.starts_with("SPDX") ||
                          (!is_note && (words.find('=') != std::string_view::npos ||
                                        words.find("x_m") != std::string_view::npos));
    if (!is_other) remarks.push_back(readable(words));
  }
  return remarks;
}

Origin origin_of(const scenario::Scenario& scenario) {
  Origin origin;
  std::string file;
  if (const Result<std::string> car = text_of(Shelf::kCar, scenario.car, file)) {
    origin.car_notes = head_remarks(*car);
    origin.identified = identified_in(*car);
  }
  if (const Result<std::string> road = text_of(Shelf::kTrack, scenario.track, file)) {
    origin.road_kind = road_kind(*road);
    origin.road_notes = head_remarks(*road);
    for (std::string& note : notes_of(file, scenario.notices)) origin.road_notes.push_back(std::move(note));
  }
  return origin;
}

}  // namespace chicane::protocol
