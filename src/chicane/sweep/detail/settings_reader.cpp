// SPDX-License-Identifier: MIT
#include "chicane/sweep/detail/settings_reader.hpp"

#include <fmt/format.h>

#include "chicane/base/text.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep::detail {
namespace {

constexpr std::size_t kMostFaults = 50;
constexpr double kLeastFactor = 1.01;
constexpr double kLeastWithin = 1e-4;

}  // namespace

std::string shown(const protocol::YamlNode& node) {
  if (node.is_map()) return "a map";
  if (node.is_list()) return "a list";
  return node.is_scalar() ? printable(node.text) : "nothing";
}

void SettingsReader::fault(int line, std::string_view key, std::string_view what) {
  if (faults_.size() < kMostFaults)
    faults_.push_back(fmt::format("{}{}: {}", protocol::place(file_, line), key, what));
}
void SettingsReader::fault(int line, const Error& error) {
  if (faults_.size() < kMostFaults) faults_.push_back(protocol::place(file_, line) + error.message);
}
Error SettingsReader::error() const {
  return {ErrorCode::kParse, fmt::format("{}", fmt::join(faults_, "\n"))};
}

void SettingsReader::read_settings(const protocol::YamlNode& map, Settings& settings,
                                   const std::string& prefix) {
  if (!map.is_map())
    return fault(map.line, prefix.empty() ? "settings" : prefix,
                 fmt::format("got {}, expected a map of settings", shown(map)));
  for (const protocol::YamlEntry& entry : map.entries()) {
    const std::string key = prefix.empty() ? entry.key.text : fmt::format("{}.{}", prefix, entry.key.text);
    if (entry.value.is_map()) {
      read_settings(entry.value, settings, key);
    } else if (takes(key, entry.value)) {
      settings.emplace_back(key, entry.value.text);
    }
  }
}

bool SettingsReader::takes(const std::string& key, const protocol::YamlNode& node) {
  if (!node.is_scalar()) {
    fault(node.line, printable(key), fmt::format("got {}, expected one value", shown(node)));
    return false;
  }
  const Result<void> checked = check_setting(key, node.text);
  if (!checked) fault(node.line, checked.error());
  return checked.has_value();
}

std::optional<Search> SettingsReader::read_search(const protocol::YamlNode& map) {
  constexpr std::string_view kExpected = "expected {a key: {from: a number above zero, to: a larger one}}";
  if (!map.is_map() || map.entries().size() != 1 || !map.entries().front().value.is_map()) {
    fault(map.line, "search", fmt::format("got {}, {}", shown(map), kExpected));
    return std::nullopt;
  }
  const protocol::YamlEntry range = map.entries().front();
  Search search{.key = range.key.text};
  for (const protocol::YamlEntry& entry : range.value.entries()) {
    const std::string& name = entry.key.text;
    const std::optional<double> number = number_in(entry.value.text);
    double* const place = name == "from"     ? &search.from
                          : name == "to"     ? &search.to
                          : name == "factor" ? &search.factor
                          : name == "within" ? &search.within
                                             : nullptr;
    if (place == nullptr || !number) {
      fault(entry.key.line, printable(name),
            fmt::format("got {}, expected numbers for from, to, factor and within", shown(entry.value)));
      return std::nullopt;
    }
    *place = *number;
    const bool is_value = name == "from" || name == "to";
    if (is_value && !takes(search.key, entry.value)) return std::nullopt;
  }
  if (search.from > 0.0 && search.to >= search.from && search.factor >= kLeastFactor &&
      search.within >= kLeastWithin)
    return search;
  fault(map.line, "search",
        fmt::format("{}, factor from {} and within from {} on", kExpected, kLeastFactor, kLeastWithin));
  return std::nullopt;
}

}  // namespace chicane::sweep::detail
