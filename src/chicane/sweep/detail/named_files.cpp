// SPDX-License-Identifier: MIT
#include "chicane/sweep/detail/named_files.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "chicane/protocol/library.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/sweep/detail/text_hash.hpp"

namespace chicane::sweep::detail {
namespace {

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

std::string digest_of_files(const Plan& plan) {
  Named named = named_in(plan);
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

}  // namespace chicane::sweep::detail
