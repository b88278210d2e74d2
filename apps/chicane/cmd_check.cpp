// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "chicane/protocol/library.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/road/track.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "guard_notice.hpp"

namespace chicane::apps {
namespace {

/// Length as text, with a digit more on roads of model scale.
std::string metres(double length) { return fmt::format("{:.{}f}", length, length < 3.0 ? 2 : 1); }

/// The road in words, as the run has it.
std::string road_in_words(const road::Track& track) {
  const double length = track.centre().length();
  const double step = std::min(1.0, length / 1000.0);
  double narrowest = 1e9;
  double sharpest = 0.0;
  for (double s = 0.0; s < length; s += step) {
    narrowest = std::min(narrowest, track.left_width(s) + track.right_width(s));
    sharpest = std::max(sharpest, std::abs(track.centre().at(s).curvature));
  }
  std::string text =
      fmt::format("{} track, {:.1f} m long, at least {} m wide, {}",
                  track.centre().is_closed() ? "closed" : "open", length, metres(narrowest),
                  sharpest > 1e-6 ? fmt::format("tightest radius {} m", metres(1.0 / sharpest)) : "straight");
  if (track.crossings() > 0)
    text += fmt::format(", crosses itself in {} {}", track.crossings(),
                        track.crossings() == 1 ? "place" : "places");
  if (!track.centre().is_closed()) text += fmt::format(", {:.1f} m from start to finish", track.lap_length());
  return text;
}

/// A file with a plant and nothing that a car file may not hold is a car; every other is what a run can start
/// from.
bool is_car(const protocol::Document& document, const std::string& file) {
  const auto& settings = document.assignments;
  const bool has_plant =
      std::any_of(settings.begin(), settings.end(),
                  [](const protocol::Assignment& setting) { return setting.parameter->key == "plant"; });
  return has_plant && !document.preset && protocol::compose({"", {{"car", file}}}).has_value();
}

/// Adds the file to the request. Its kind in words; of a track nothing yet.
Result<std::string> add_file(const std::string& file, protocol::Request& request) {
  if (protocol::track_format_of(file) != nullptr) {
    request.settings.emplace_back("track", file);
    return std::string{};
  }
  const Result<std::string> text = protocol::read_file(file);
  if (!text) return fail(text.error());
  if (protocol::is_foreign_track(*text)) {
    request.settings.emplace_back("track", file);
    return std::string{};
  }
  const Result<protocol::Document> document = protocol::parse_document(*text, file);
  if (!document) return fail(document.error());
  const bool car = is_car(*document, file);
  if (car) {
    request.settings.emplace_back("car", file);
  } else {
    request.scenario_file = file;
  }
  return fmt::format("{}, {} settings", car ? "car" : "preset or scenario", document->assignments.size());
}

/// Judges one file together with the settings of the command line, as `drive` does.
Result<std::string> check_file(const std::string& file, protocol::Request request) {
  Result<std::string> found = add_file(file, request);
  if (!found) return found;
  const auto run = prepared(request);
  if (!run) {
    const std::string& message = run.error().message;
    return fail(run.error().code, message.starts_with(file) ? message : fmt::format("{}: {}", file, message));
  }
  print_notices((*run)->scenario());
  return found->empty() ? road_in_words((*run)->track()) : found;
}

ExitCode check_experiment(const protocol::Request& request) {
  if (request.settings.empty() && request.speed_mps.empty() && request.faults.empty())
    return report({ErrorCode::kInvalidArgument, "check: got nothing, expected files or settings"});
  const auto run = prepared(request);
  if (!run) return report(run.error());
  const scenario::Scenario& scenario = (*run)->scenario();
  print_notices(scenario);
  fmt::print("ok, {} ({}) drives {} on {}\n", scenario.preset, scenario.controller, scenario.car,
             scenario.track);
  return kSuccess;
}

}  // namespace

ExitCode check(const Options& options) {
  const protocol::Request request = request_of(options);
  if (options.files.empty()) return check_experiment(request);
  ExitCode worst = kSuccess;
  for (const std::string& file : options.files) {
    const Result<std::string> found = check_file(file, request);
    if (found) {
      fmt::print("{}: ok, {}\n", file, *found);
    } else {
      worst = std::max(worst, report(found.error()));
    }
  }
  return worst;
}

}  // namespace chicane::apps
