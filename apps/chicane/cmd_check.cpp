// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "chicane/path/track.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "commands.hpp"

namespace chicane::apps {
namespace {

Result<std::string> check_track(const std::string& file) {
  const Result<path::Track> track = protocol::read_track(file);
  if (!track) return fail(track.error());
  const double length = track->centre().length();
  double narrowest = 1e9;
  double sharpest = 1e-9;
  for (double s = 0.0; s < length; s += 1.0) {
    narrowest = std::min(narrowest, track->left_width(s) + track->right_width(s));
    sharpest = std::max(sharpest, std::abs(track->centre().at(s).curvature));
  }
  std::string text =
      fmt::format("{} track, {:.1f} m long, at least {:.1f} m wide, tightest radius {:.1f} m",
                  track->centre().is_closed() ? "closed" : "open", length, narrowest, 1.0 / sharpest);
  if (track->crossings() > 0)
    text += fmt::format(", crosses itself in {} {}", track->crossings(),
                        track->crossings() == 1 ? "place" : "places");
  if (!track->centre().is_closed())
    text += fmt::format(", {:.1f} m from start to finish", track->lap_length());
  return text;
}

/// A file with a plant and nothing that a car file may not hold is a car; every other is what a run can start
/// from.
Result<std::string> check_settings(const std::string& file) {
  const Result<std::string> text = protocol::read_file(file);
  if (!text) return fail(text.error());
  const Result<protocol::Document> document = protocol::parse_document(*text, file);
  if (!document) return fail(document.error());
  const auto& settings = document->assignments;
  const bool has_plant =
      std::any_of(settings.begin(), settings.end(),
                  [](const protocol::Assignment& setting) { return setting.parameter->key == "plant"; });
  const Result<scenario::Scenario> car = protocol::compose({"", {{"car", file}}});
  const bool is_car = has_plant && !document->preset && car;
  const Result<scenario::Scenario> scenario = is_car ? car : protocol::compose({file, {}});
  if (!scenario) return fail(scenario.error());
  return fmt::format("{}, {} settings", is_car ? "car" : "preset or scenario", settings.size());
}

}  // namespace

ExitCode check(const Options& options) {
  ExitCode worst = kSuccess;
  for (const std::string& file : options.files) {
    const bool is_track = protocol::track_format_of(file) != nullptr;
    const Result<std::string> found = is_track ? check_track(file) : check_settings(file);
    if (found) {
      fmt::print("{}: ok, {}\n", file, *found);
    } else {
      worst = std::max(worst, report(found.error()));
    }
  }
  return worst;
}

}  // namespace chicane::apps
