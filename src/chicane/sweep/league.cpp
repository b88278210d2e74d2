// SPDX-License-Identifier: MIT
#include "chicane/sweep/league.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "chicane/base/text.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/plan_cache.hpp"
#include "chicane/sweep/detail/settings_reader.hpp"
#include "chicane/sweep/trial.hpp"

namespace chicane::sweep {
namespace {

using protocol::YamlEntry;
using protocol::YamlNode;

/// What a page shows.
constexpr std::array kKept{"completed",
                           "end_reason",
                           "laps_completed",
                           "off_track_events",
                           "lap_time_s",
                           "mean_speed_mps",
                           "top_speed_mps",
                           "rms_lateral_error_m",
                           "min_edge_distance_m",
                           "max_lateral_acceleration_mps2",
                           "steering_rate_rms_radps",
                           "mean_iterations",
                           "not_usable"};

class LeagueReader : private detail::SettingsReader {
 public:
  using SettingsReader::SettingsReader;

  Result<League> read(const YamlNode& root) {
    league_.plan.search = Search{.key = "speed_mps", .from = 8.0, .to = 80.0, .factor = 1.4};
    std::string about;
    read_map(root, "file", "a league with entries, tracks and cars",
             {{"name", text(league_.name)},
              {"about", text(about)},
              {"settings", settings(league_.plan.fixed)},
              {"search", search(league_.plan.search)},
              {"entries", [this](const YamlEntry& entry) { read_entries(entry); }},
              {"tracks", values("track", league_.tracks)},
              {"cars", values("car", league_.cars)},
              {"disturbances", [this](const YamlEntry& entry) { read_disturbances(entry); }}});
    if (entries_.list.empty() && league_.externals.empty())
      fault(root.line, "entries", "got none, expected some");
    if (league_.tracks.empty()) fault(root.line, "tracks", "got none, expected some");
    if (league_.cars.empty()) fault(root.line, "cars", "got none, expected some");
    if (league_.disturbances.empty()) league_.disturbances.emplace_back("none", Settings{});
    for (ExternalEntry& entry : league_.externals) complete(entry);
    if (!is_faultless()) return fail(error());
    make_plan();
    return std::move(league_);
  }

 private:
  void read_disturbances(const YamlEntry& entry) {
    for (const YamlEntry& each : named(entry))
      read_settings(each.value, league_.disturbances.emplace_back(each.key.text, Settings{}).second);
  }

  void read_entries(const YamlEntry& entry) {
    for (const YamlEntry& each : named(entry)) {
      const std::vector<YamlEntry> parts = each.value.entries();
      const bool is_external = std::any_of(parts.begin(), parts.end(),
                                           [](const YamlEntry& part) { return part.key.text == "server"; });
      if (is_external) {
        read_external(each);
      } else {
        entries_.list.push_back(each.key.text);
        read_settings(each.value, entries_.cases.emplace_back());
      }
    }
  }

  void read_external(const YamlEntry& entry) {
    ExternalEntry& external = league_.externals.emplace_back();
    external.name = entry.key.text;
    read_map(entry.value, entry.key.text, "a program",
             {{"server", text(external.command, "a command")},
              {"tracks", values("track", external.tracks)},
              {"cars", values("car", external.cars)},
              {"disturbances",
               list("names", [&](const YamlNode& name) { external.disturbances.push_back(name.text); })}});
  }

  /// What it does not say is everything.
  void complete(ExternalEntry& entry) {
    if (entry.tracks.empty()) entry.tracks = league_.tracks;
    if (entry.cars.empty()) entry.cars = league_.cars;
    std::vector<std::string> known;
    for (const auto& disturbance : league_.disturbances) known.push_back(disturbance.first);
    if (entry.disturbances.empty()) entry.disturbances = known;
    for (const std::string& name : entry.disturbances) {
      if (std::find(known.begin(), known.end(), name) == known.end())
        fault(1, "disturbances",
              fmt::format("got {}, expected one of {}", printable(name), fmt::join(known, ", ")));
    }
  }

  void make_plan() {
    Axis entries = list_axis(kEntryKey, entries_.list);
    entries.dimensions.front().cases = entries_.cases;
    Axis disturbances = list_axis(kDisturbanceKey, {});
    disturbances.size = league_.disturbances.size();
    for (const auto& [name, settings] : league_.disturbances) {
      disturbances.dimensions.front().list.push_back(name);
      disturbances.dimensions.front().cases.push_back(settings);
    }
    league_.plan.axes = {std::move(entries), list_axis("track", league_.tracks),
                         list_axis("car", league_.cars), std::move(disturbances)};
    league_.plan.keep.assign(kKept.begin(), kKept.end());
  }

  League league_;
  Dimension entries_;
};

bool has_place(const std::string& command, std::string_view name) {
  return command.find(fmt::format("{{{}}}", name)) != std::string::npos;
}

}  // namespace

std::vector<ExternalTrial> League::external_trials() const {
  std::vector<ExternalTrial> trials;
  for (const ExternalEntry& entry : externals)
    for (const std::string& track : entry.tracks)
      for (const std::string& car : entry.cars)
        for (const std::string& disturbance : entry.disturbances) {
          ExternalTrial trial{.entry = entry.name,
                              .command = entry.command,
                              .track = track,
                              .car = car,
                              .disturbance = disturbance,
                              .settings = plan.fixed};
          trial.settings.emplace_back("track", track);
          trial.settings.emplace_back("car", car);
          for (const auto& [each, settings] : disturbances) {
            if (each != disturbance) continue;
            for (const auto& setting : settings) {
              if (setting.first.starts_with("fault")) trial.why_not = "faults are in our own control loop";
              if (setting.first == "latency_ms" && !has_place(entry.command, "latency_ms") && !is_ros(trial))
                trial.why_not = "the command has no place {latency_ms}";
              trial.settings.push_back(setting);
            }
          }
          trials.push_back(std::move(trial));
        }
  return trials;
}

bool is_ros(const ExternalTrial& trial) { return has_place(trial.command, "domain"); }

std::string filled(const ExternalTrial& trial, int port, const std::string& program) {
  std::string latency = "100";
  for (const auto& [key, text] : trial.settings)
    if (key == "latency_ms") latency = text;
  std::string command = trial.command;
  for (const auto& [place, text] :
       {std::pair{std::string("{port}"), fmt::format("{}", port)},
        std::pair{std::string("{domain}"), fmt::format("{}", port)},
        std::pair{std::string("{latency_ms}"), latency}, std::pair{std::string("{track}"), trial.track},
        std::pair{std::string("{chicane}"), program}}) {
    for (std::size_t at = command.find(place); at != std::string::npos;
         at = command.find(place, at + text.size()))
      command.replace(at, place.size(), text);
  }
  return command;
}

void add_external(League& league, const std::string& command) {
  ExternalEntry entry{.name = command, .command = command, .tracks = league.tracks, .cars = league.cars};
  for (const auto& disturbance : league.disturbances) entry.disturbances.push_back(disturbance.first);
  league.externals.push_back(std::move(entry));
}

Result<League> parse_league(std::string_view text, const std::string& file) {
  const Result<protocol::YamlTree> tree = protocol::parse_yaml(text, file);
  if (!tree) return fail(tree.error());
  Result<League> league = LeagueReader(file).read(*tree->root);
  if (league && league->name.empty()) league->name = std::filesystem::path(file).stem().string();
  if (league) league->plan.name = league->name;
  return league;
}

Result<League> read_league(const std::string& file) {
  const Result<std::string> text = protocol::read_file(file);
  return text ? parse_league(*text, file) : fail(text.error());
}

Result<double> bound_of(const Settings& settings, const std::atomic<bool>& stop) {
  const Result<scenario::Scenario> scenario = scenario_of(settings);
  if (!scenario) return fail(scenario.error());
  const Result<road::Track> track = run::make_track(*scenario);
  if (!track) return fail(track.error());
  lap_time::PlantLimitOptions options;
  options.wants_witness = false;
  options.go_on = [&](std::string_view, int, double) { return !stop.load(); };
  const Result<lap_time::PlantLimit> limit = run::limit_of(*scenario, *track, options);
  return limit ? Result<double>(limit->bound.lap) : fail(limit.error());
}

}  // namespace chicane::sweep
