// SPDX-License-Identifier: MIT
#include "chicane/sweep/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/sweep/detail/text_hash.hpp"
#include "chicane/sweep/sampling.hpp"

namespace chicane::sweep {
namespace {

constexpr int kDigits = 12;  // of a computed value: 0.3, not 0.30000000000000004

using detail::add_text;

void add_settings(Fnv& hash, const Settings& settings) {
  for (const auto& [key, text] : settings) {
    add_text(hash, key);
    add_text(hash, text);
  }
}

using Named = std::set<std::pair<std::string, std::string>>;  ///< keys with their values, each once

void add_named(const Settings& settings, Named& named) {
  for (const auto& [key, text] : settings)
    if (key == "preset" || key == "car" || key == "scenario" || key == "track") named.emplace(key, text);
}

Named named_in(const Plan& plan) {
  Named named{{"scenario", ""}};  // the defaults
  add_named(plan.fixed, named);
  for (const Axis& axis : plan.axes) {
    for (const Dimension& dimension : axis.dimensions) {
      if (dimension.cases.empty())
        for (const std::string& text : dimension.list) add_named({{dimension.key, text}}, named);
      for (const Settings& meaning : dimension.cases) add_named(meaning, named);
    }
  }
  return named;
}

std::string track_bytes(const std::string& track) {
  const Result<std::string> file = protocol::locate(protocol::Shelf::kTrack, track);
  const Result<std::string> bytes = file ? protocol::read_file(*file) : fail(file.error());
  return bytes ? *bytes : bytes.error().message;
}

}  // namespace

Axis list_axis(std::string_view key, std::vector<std::string> list) {
  Axis axis;
  axis.size = list.size();
  axis.dimensions.push_back({.key = std::string(key), .list = std::move(list)});
  return axis;
}

std::vector<double> Search::ladder() const {
  std::vector<double> values{to};
  while (values.back() / factor > from) values.push_back(values.back() / factor);
  if (values.back() > from) values.push_back(from);
  return values;
}

Settings expanded(const Settings& settings, const Cases& cases) {
  Settings all;
  for (const auto& [key, text] : settings) {
    const auto meanings = cases.find(key);
    if (meanings == cases.end()) {
      all.emplace_back(key, text);
    } else if (const auto meaning = meanings->second.find(text); meaning != meanings->second.end()) {
      all.insert(all.end(), meaning->second.begin(), meaning->second.end());
    }
  }
  return all;
}

std::string Dimension::at(double share) const {
  if (!list.empty()) {
    const auto place = static_cast<std::size_t>(share * static_cast<double>(list.size()));
    return list[std::min(place, list.size() - 1)];
  }
  const double value =
      is_logarithmic ? from * exp(share * (log(to) - log(from))) : from + share * (to - from);
  const double inside = std::clamp(value, std::min(from, to), std::max(from, to));
  return number_text(is_integer ? std::round(inside) : inside, kDigits);
}

std::string Axis::value(std::size_t d, std::uint64_t i) const {
  const Dimension& dimension = dimensions[d];
  const auto index = static_cast<std::uint32_t>(i);
  const auto which = static_cast<int>(d);
  switch (kind) {
    case Kind::kSobol:
      return dimension.at(sobol(index, which, seed));
    case Kind::kLatinHypercube:
      return dimension.at(latin_hypercube(index, static_cast<std::uint32_t>(size), which, seed));
    case Kind::kTogether:
      break;
  }
  if (!dimension.list.empty()) return dimension.list[i];
  return dimension.at(size < 2 ? 0.0 : static_cast<double>(i) / static_cast<double>(size - 1));
}

std::uint64_t Plan::size() const {
  std::uint64_t size = 1;
  for (const Axis& axis : axes) size *= axis.size;
  return size;
}

Settings Plan::at(std::uint64_t index) const {
  std::vector<std::uint64_t> places(axes.size());
  for (std::size_t a = axes.size(); a-- > 0; index /= axes[a].size) places[a] = index % axes[a].size;
  Settings settings;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    for (std::size_t d = 0; d < axes[a].dimensions.size(); ++d)
      settings.emplace_back(axes[a].dimensions[d].key, axes[a].value(d, places[a]));
  }
  return settings;
}

Settings Plan::settings_of(std::uint64_t index) const {
  Settings settings = fixed;
  for (auto& setting : expanded(at(index), cases())) settings.push_back(std::move(setting));
  return settings;
}

Cases Plan::cases() const {
  Cases cases;
  for (const Axis& axis : axes)
    for (const Dimension& dimension : axis.dimensions)
      for (std::size_t i = 0; i < dimension.cases.size(); ++i)
        cases[dimension.key][dimension.list[i]] = dimension.cases[i];
  return cases;
}

std::vector<std::string> Plan::keys() const {
  std::vector<std::string> keys;
  for (const Axis& axis : axes)
    for (const Dimension& dimension : axis.dimensions) keys.push_back(dimension.key);
  return keys;
}

std::uint64_t Plan::hash() const {
  Fnv hash;
  add_settings(hash, fixed);
  for (const Axis& axis : axes) {
    hash.add(static_cast<std::uint64_t>(axis.kind));
    hash.add(axis.size);
    hash.add(axis.seed);
    for (const Dimension& dimension : axis.dimensions) {
      add_text(hash, dimension.key);
      for (const std::string& text : dimension.list) add_text(hash, text);
      for (const Settings& meaning : dimension.cases) {
        hash.add(static_cast<std::uint64_t>(meaning.size()));
        add_settings(hash, meaning);
      }
      hash.add(dimension.from);
      hash.add(dimension.to);
      hash.add(
          static_cast<std::uint64_t>((dimension.is_logarithmic ? 1 : 0) + (dimension.is_integer ? 2 : 0)));
    }
  }
  if (search) {
    add_text(hash, search->key);
    for (const double value : {search->from, search->to, search->factor, search->within}) hash.add(value);
  }
  for (const std::string& column : keep) add_text(hash, column);
  return hash.value();
}

std::string Plan::digest_of_files() const {
  Named named = named_in(*this);
  Fnv hash;
  for (const auto& [key, text] : Named(named)) {
    if (key == "track") continue;
    protocol::Request request;
    if (key == "scenario") {
      request.scenario_file = text;
    } else {
      request.settings.emplace_back(key, text);
    }
    const Result<scenario::Scenario> scenario = protocol::compose(request);
    if (scenario) named.emplace("track", scenario->track);
    add_text(hash, scenario ? protocol::write_document(*scenario, "", true) : scenario.error().message);
  }
  for (const auto& [key, text] : named)
    if (key == "track") add_text(hash, track_bytes(text));
  return fmt::format("{:016x}", hash.value());
}

}  // namespace chicane::sweep
