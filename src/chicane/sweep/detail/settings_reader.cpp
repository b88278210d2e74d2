// SPDX-License-Identifier: MIT
#include "chicane/sweep/detail/settings_reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "chicane/base/text.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep::detail {
namespace {

constexpr double kMostCount = 4294967295.0;
constexpr double kLeastFactor = 1.01;
constexpr double kLeastWithin = 1e-4;

}  // namespace

void SettingsReader::read_settings(const protocol::YamlNode& map, Settings& settings,
                                   const std::string& prefix) {
  if (!map.is_map()) return refuse(map, prefix.empty() ? "settings" : prefix, "a map of settings");
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
    refuse(node, key, "one value");
    return false;
  }
  const Result<void> checked = check_setting(key, node.text);
  if (!checked) fault(node.line, checked.error());
  return checked.has_value();
}

std::vector<protocol::YamlEntry> SettingsReader::named(const protocol::YamlEntry& entry) {
  std::vector<protocol::YamlEntry> entries = entry.value.entries();
  if (!entry.value.is_map() || entries.size() > kMostNames) {
    refuse(entry, fmt::format("a map of at most {} names", kMostNames));
    return {};
  }
  std::set<std::string_view> names;
  for (const protocol::YamlEntry& each : entries)
    if (!names.insert(each.key.text).second)
      fault(each.key.line, printable(each.key.text), "got it a second time, expected it once");
  return entries;
}

SettingsReader::Take SettingsReader::count(std::uint64_t& to, std::uint64_t least) {
  return [this, &to, least](const protocol::YamlEntry& entry) {
    const auto number = number_in(entry.value.text);
    if (!number || *number < static_cast<double>(least) || *number > kMostCount ||
        *number != std::floor(*number))
      return refuse(entry, fmt::format("an integer from {} on", least));
    to = static_cast<std::uint64_t>(*number);
  };
}

SettingsReader::Take SettingsReader::settings(Settings& to) {
  return [this, &to](const protocol::YamlEntry& entry) { read_settings(entry.value, to); };
}

SettingsReader::Take SettingsReader::values(const std::string& key, std::vector<std::string>& to) {
  return list("values", [this, key, &to](const protocol::YamlNode& node) {
    if (takes(key, node)) to.push_back(node.text);
  });
}

SettingsReader::Take SettingsReader::search(std::optional<Search>& to) {
  return [this, &to](const protocol::YamlEntry& entry) { to = read_search(entry.value); };
}

std::optional<Search> SettingsReader::read_search(const protocol::YamlNode& map) {
  constexpr std::string_view kExpected = "{a key: {from: a number above zero, to: a larger one}}";
  if (!map.is_map() || map.entries().size() != 1) {
    refuse(map, "search", kExpected);
    return std::nullopt;
  }
  const protocol::YamlEntry range = map.entries().front();
  Search search{.key = range.key.text};
  const auto bound = [&](double& to) -> Take {
    return [this, &search, take = number(to)](const protocol::YamlEntry& entry) {
      if (takes(search.key, entry.value)) take(entry);
    };
  };
  const bool is_read = read_map(range.value, "search", kExpected,
                                {{"from", bound(search.from)},
                                 {"to", bound(search.to)},
                                 {"factor", number(search.factor)},
                                 {"within", number(search.within)}});
  if (!is_read) return std::nullopt;
  if (search.from > 0.0 && search.to >= search.from && search.factor >= kLeastFactor &&
      search.within >= kLeastWithin)
    return search;
  fault(map.line, "search",
        fmt::format("expected {}, factor from {} and within from {} on", kExpected, kLeastFactor,
                    kLeastWithin));
  return std::nullopt;
}

}  // namespace chicane::sweep::detail
