// SPDX-License-Identifier: MIT
#include "chicane/sweep/league.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

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

constexpr std::size_t kMostEntries = 1000;
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
    entries_.key = kEntryKey;
    league_.plan.search = Search{.key = "speed_mps", .from = 8.0, .to = 80.0, .factor = 1.4};
    if (!root.is_map()) {
      fault(1, "file",
            fmt::format("got {}, expected a league with entries, tracks and cars", detail::shown(root)));
      return fail(error());
    }
    for (const YamlEntry& entry : root.entries()) read_part(entry);
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
  void read_part(const YamlEntry& entry) {
    const std::string& name = entry.key.text;
    if (!parts_.insert(name).second)
      return fault(entry.key.line, printable(name), "got it a second time, expected it once");
    if (name == "name" || name == "about") {
      if (name == "name") league_.name = entry.value.text;
    } else if (name == "settings") {
      read_settings(entry.value, league_.plan.fixed);
    } else if (name == "search") {
      league_.plan.search = read_search(entry.value);
    } else if (name == "tracks") {
      league_.tracks = names_in(entry, "track");
    } else if (name == "cars") {
      league_.cars = names_in(entry, "car");
    } else if (name == "entries") {
      for (const YamlEntry& each : named(entry)) read_entry(each);
    } else if (name == "disturbances") {
      for (const YamlEntry& each : named(entry))
        read_settings(each.value, league_.disturbances.emplace_back(each.key.text, Settings{}).second);
    } else {
      fault(entry.key.line, printable(name),
            "got an unknown key, expected name, about, settings, search, entries, tracks, cars or "
            "disturbances");
    }
  }

  /// The parts of a map of maps, whose names are all different.
  std::vector<YamlEntry> named(const YamlEntry& entry) {
    std::set<std::string> names;
    if (!entry.value.is_map() || entry.value.entries().size() > kMostEntries) {
      fault(entry.key.line, entry.key.text,
            fmt::format("got {}, expected a map of at most {} names", detail::shown(entry.value),
                        kMostEntries));
      return {};
    }
    for (const YamlEntry& each : entry.value.entries()) {
      if (!names.insert(each.key.text).second)
        fault(each.key.line, printable(each.key.text), "got it a second time, expected it once");
    }
    return entry.value.entries();
  }

  /// A list of values of `key`; without a key, of any names.
  std::vector<std::string> names_in(const YamlEntry& entry, const std::string& key) {
    std::vector<std::string> names;
    if (!entry.value.is_list() || entry.value.children.size() > kMostEntries) {
      fault(entry.key.line, entry.key.text,
            fmt::format("got {}, expected a list", detail::shown(entry.value)));
      return names;
    }
    for (const YamlNode* node : entry.value.children)
      if (key.empty() ? node->is_scalar() : takes(key, *node)) names.push_back(node->text);
    return names;
  }

  void read_entry(const YamlEntry& entry) {
    const std::vector<YamlEntry> parts =
        entry.value.is_map() ? entry.value.entries() : std::vector<YamlEntry>{};
    const bool is_external = std::any_of(parts.begin(), parts.end(),
                                         [](const YamlEntry& part) { return part.key.text == "server"; });
    if (!is_external) {
      entries_.list.push_back(entry.key.text);
      return read_settings(entry.value, entries_.cases.emplace_back());
    }
    ExternalEntry external{.name = entry.key.text};
    for (const YamlEntry& part : parts) {
      const std::string& key = part.key.text;
      if (key == "server" && part.value.is_scalar() && !part.value.text.empty()) {
        external.command = part.value.text;
      } else if (key == "tracks") {
        external.tracks = names_in(part, "track");
      } else if (key == "cars") {
        external.cars = names_in(part, "car");
      } else if (key == "disturbances") {
        external.disturbances = names_in(part, "");
      } else {
        fault(part.key.line, printable(key),
              fmt::format("got {}, expected server: a command, tracks, cars or disturbances of a program",
                          detail::shown(part.value)));
      }
    }
    league_.externals.push_back(std::move(external));
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
    const auto axis = [&](Dimension dimension) {
      Axis& added = league_.plan.axes.emplace_back();
      added.size = dimension.list.size();
      added.dimensions.push_back(std::move(dimension));
    };
    axis(entries_);
    axis({.key = "track", .list = league_.tracks});
    axis({.key = "car", .list = league_.cars});
    Dimension disturbances{.key = std::string(kDisturbanceKey)};
    for (const auto& [name, settings] : league_.disturbances) {
      disturbances.list.push_back(name);
      disturbances.cases.push_back(settings);
    }
    axis(std::move(disturbances));
    league_.plan.keep.assign(kKept.begin(), kKept.end());
  }

  League league_;
  Dimension entries_;
  std::set<std::string> parts_;
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
  const Result<protocol::Request> request = request_of(settings);
  if (!request) return fail(request.error());
  const Result<scenario::Scenario> scenario = protocol::compose(*request);
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
