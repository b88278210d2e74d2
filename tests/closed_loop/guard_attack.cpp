// SPDX-License-Identifier: MIT
// Attacks the guard by adversaries in the controller's place and by false signals, and prints what it came
// to.
//
//   guard_attack adversaries --seeds 20 --jobs 2
//   guard_attack signals --onsets 5 --cars udacity --only drift_0.3mps,late_0.8s
//   guard_attack adversaries --only reverse_gear --cars udacity --tracks oval --seed 4 --trace
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "chicane/run/fault_campaign.hpp"
#include "closed_loop/attack.hpp"

namespace chicane::attack {
namespace {

struct Choice {
  std::vector<std::string> only{};
  std::vector<std::string> cars{"udacity", "road-car", "bmw-320i", "f1tenth"};
  std::vector<std::string> tracks{"lakeside", "oval", "hairpins", "speedway"};
  std::vector<std::string> presets{"default"};
  std::vector<std::string> settings{};
  std::vector<std::string> durations{"2", "inf"};
  int seeds = 2;
  int seed = -1;
  int onsets = 3;
  int onset = -1;
  int jobs = 1;
  double seconds = 60.0;
  bool is_traced = false;
  bool is_first_lap = false;
  bool is_spread = false;
};

/// One line of the table: a way to attack, with one car and one preset.
struct Row {
  std::size_t trials = 0, off = 0, crashed = 0, standing = 0, doubted = 0;
  double worst = std::numeric_limits<double>::infinity();
  double slowest_start = 0.0;  ///< [s] until the car drives again
  std::string repeat{};        ///< options that drive the worst trial again
  std::vector<double> doubted_after{};
  std::map<std::string, int> doubts{};

  void add(const Outcome& outcome, const std::string& options) {
    ++trials;
    crashed += outcome.is_there ? 0 : 1;
    off += outcome.has_left_road() ? 1 : 0;
    standing += outcome.end_speed < Outcome::kStanding ? 1 : 0;
    const double edge = outcome.is_there ? outcome.least_edge : -1e9;
    if (edge < worst) {
      worst = edge;
      repeat = options;
    }
    slowest_start = std::max(slowest_start, std::isnan(outcome.driving_after) ? 1e3 : outcome.driving_after);
    if (std::isnan(outcome.doubted_after)) return;
    ++doubted;
    doubted_after.push_back(outcome.doubted_after);
    ++doubts[std::string(controller::kGuardReasonWords[static_cast<std::size_t>(outcome.doubt)].name)];
  }
  [[nodiscard]] double median_doubt() const {
    std::vector<double> sorted = doubted_after;
    std::sort(sorted.begin(), sorted.end());
    return sorted.empty() ? std::numeric_limits<double>::quiet_NaN() : sorted[sorted.size() / 2];
  }
  [[nodiscard]] std::string most_frequent_doubt() const {
    const auto most = std::max_element(doubts.begin(), doubts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == doubts.end() ? "-" : most->first;
  }
};

/// Rows in the order in which they were added.
class Table {
 public:
  Row& row(const std::string& attack, const std::string& car, const std::string& preset) {
    const std::string key = fmt::format("{:<24} {:<10} {:<9}", attack, car, preset);
    const auto found =
        std::find_if(rows_.begin(), rows_.end(), [&](const auto& r) { return r.first == key; });
    if (found != rows_.end()) return found->second;
    return rows_.emplace_back(key, Row{}).second;
  }
  /// How many trials left the road.
  std::size_t print(bool has_signals) const {
    std::size_t trials = 0, off = 0;
    fmt::print("{:<24} {:<10} {:<9} {:>6} {:>5} {:>9}{}  worst\n", "attack", "car", "preset", "trials", "off",
               "edge [m]", has_signals ? " standing  doubted  after [s]  as             driving [s]" : "");
    for (const auto& [key, row] : rows_) {
      trials += row.trials;
      off += row.off;
      fmt::print("{} {:>6} {:>5} {:>9.2f}", key, row.trials, row.off, row.worst);
      if (has_signals)
        fmt::print(" {:>8} {:>8} {:>10.2f}  {:<14} {:>11.1f}", row.standing, row.doubted, row.median_doubt(),
                   row.most_frequent_doubt(), row.slowest_start);
      fmt::print("  {}{}\n", row.off > 0 ? row.repeat : "", row.crashed > 0 ? "  CRASHED" : "");
    }
    fmt::print("{} trials, {} off the road\n", trials, off);
    return off;
  }

 private:
  std::vector<std::pair<std::string, Row>> rows_;
};

void print_trace(const telemetry::Frame& frame) {
  const safety::GuardReport& report = frame.guard;
  const model::Measurement& seen = frame.measurement;
  fmt::print(
      "{:7.2f} s  v {:6.2f} ({:6.2f})  edge {:6.2f}  off line {:6.2f}  place error {:6.2f}  asked {:+.3f} "
      "{:+.3f}  "
      "sent {:+.3f} {:+.3f}  stop edge {:6.3f}  rung {}  {}\n",
      frame.time, frame.truth.vx, seen.speed, frame.edge_distance, frame.lateral_error,
      std::hypot(seen.x - frame.truth.x, seen.y - frame.truth.y), frame.asked.steer, frame.asked.throttle,
      frame.result.command.steer, frame.result.command.throttle, report.stop_edge,
      static_cast<int>(report.rung),
      controller::kGuardReasonWords[static_cast<std::size_t>(report.reason)].name);
}

bool is_chosen(const Choice& choice, std::string_view name) {
  return choice.only.empty() || std::find(choice.only.begin(), choice.only.end(), name) != choice.only.end();
}

std::vector<Place> places_of(const Choice& choice) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const std::string& text : choice.settings)
    settings.emplace_back(text.substr(0, text.find('=')), text.substr(text.find('=') + 1));
  std::vector<Place> places;
  for (const std::string& preset : choice.presets)
    for (const std::string& car : choice.cars)
      for (const std::string& track : choice.tracks) places.push_back({car, track, preset, settings});
  return places;
}

void tell(const Place& place, std::size_t off, std::size_t trials) {
  fmt::print(stderr, "{} {} {}: {} of {} off the road\n", place.preset, place.car, place.track, off, trials);
}

using AdversaryTrial = std::pair<const AdversaryKind*, std::uint64_t>;

std::vector<AdversaryTrial> adversary_trials(const Choice& choice, const Place& place) {
  const auto track = static_cast<std::size_t>(
      std::find(choice.tracks.begin(), choice.tracks.end(), place.track) - choice.tracks.begin());
  std::vector<AdversaryTrial> trials;
  for (const AdversaryKind& kind : adversary_kinds()) {
    if (!is_chosen(choice, kind.name)) continue;
    for (int seed = 0; seed < choice.seeds; ++seed) {
      const bool is_elsewhere =
          choice.is_spread && static_cast<std::size_t>(seed) % choice.tracks.size() != track;
      if (!is_elsewhere && (choice.seed < 0 || seed == choice.seed)) trials.emplace_back(&kind, seed);
    }
  }
  return trials;
}

/// All chosen adversaries and seeds on one road.
void attack_place(const Choice& choice, const Place& place, Table& table) {
  const auto scenario = scenario_of(place);
  run::Roads roads;
  if (!scenario || !roads.of(*scenario)) {
    fmt::print(stderr, "{} {} {}: left out: {}\n", place.preset, place.car, place.track,
               scenario ? roads.of(*scenario).error().message : scenario.error().message);
    return;
  }
  const std::vector<AdversaryTrial> trials = adversary_trials(choice, place);
  std::size_t off = 0;
  drive_in_processes(
      trials.size(), choice.jobs, {},
      [&](std::size_t i) {
        const auto outcome = drive_adversary(*scenario, roads, *trials[i].first, trials[i].second,
                                             choice.seconds, choice.is_traced ? print_trace : OnFrame{});
        std::fflush(stdout);
        return outcome.value_or(Outcome{});
      },
      [&](std::size_t i, const Outcome& outcome) {
        off += outcome.has_left_road() ? 1 : 0;
        table.row(std::string(trials[i].first->name), place.car, place.preset)
            .add(outcome, fmt::format("--tracks {} --seed {}  ({:.1f} s)", place.track, trials[i].second,
                                      outcome.least_at));
      });
  tell(place, off, trials.size());
}

/// Trials in the order of their onsets.
std::vector<SignalTrial> signal_trials(const Choice& choice, const run::FlyingLap& lap) {
  std::vector<SignalTrial> trials;
  for (int k = 0; k < choice.onsets; ++k) {
    if (choice.onset >= 0 && k != choice.onset) continue;
    const double share = (k + 0.5) / choice.onsets;
    const double onset = choice.is_first_lap ? share * lap.begins : lap.begins + share * lap.time;
    for (const FalseSignal& signal : false_signals()) {
      if (!is_chosen(choice, signal.name)) continue;
      if (signal.put_on_lap >= 0.0) {
        trials.push_back({signal, onset, kAfterwards, static_cast<std::uint64_t>(k)});
        continue;
      }
      for (const std::string& duration : choice.durations)
        trials.push_back({signal, onset, duration == "inf" ? kLasting : std::stod(duration),
                          static_cast<std::uint64_t>(k)});
    }
  }
  return trials;
}

/// All chosen signals, onsets and durations on one road.
void falsify_place(const Choice& choice, const Place& place, Table& table) {
  const auto scenario = scenario_of(place);
  auto lap =
      scenario ? run::drive_undisturbed(*scenario, 0.0) : Result<run::FlyingLap>{fail(scenario.error())};
  if (lap && !lap->off.empty()) lap = fail(ErrorCode::kInvalidArgument, "off the road without any attack");
  const auto loop =
      lap ? run::ClosedLoop::create(*scenario) : Result<std::unique_ptr<run::ClosedLoop>>{fail(lap.error())};
  if (!loop) {
    fmt::print(stderr, "{} {} {}: left out: {}\n", place.preset, place.car, place.track,
               loop.error().message);
    return;
  }
  const auto memory = remember(**loop, 1);
  const std::vector<SignalTrial> trials = signal_trials(choice, *lap);
  std::size_t off = 0;
  drive_in_processes(
      trials.size(), choice.jobs,
      [&](std::size_t i) {
        while ((*loop)->time() < trials[i].onset - 1e-9) (*loop)->advance();
      },
      [&](std::size_t i) {
        memory->random = Random{trials[i].seed};
        const Outcome outcome =
            drive_signal(**loop, trials[i], memory, choice.is_traced ? print_trace : OnFrame{});
        std::fflush(stdout);
        return outcome;
      },
      [&](std::size_t i, const Outcome& outcome) {
        off += outcome.has_left_road() ? 1 : 0;
        const bool is_lasting = trials[i].duration >= kLasting;
        const std::string duration = is_lasting ? "inf" : fmt::format("{:g}", trials[i].duration);
        table
            .row(fmt::format("{} {}", trials[i].signal.name, is_lasting ? "inf" : duration + "s"), place.car,
                 place.preset)
            .add(outcome,
                 fmt::format("--tracks {} --onset {} --for-s {}{}  (at {:.2f} s, edge at {:.2f} s)",
                             place.track, trials[i].seed, duration, choice.is_first_lap ? " --first-lap" : "",
                             trials[i].onset, outcome.least_at));
      });
  tell(place, off, trials.size());
}

void add_options(CLI::App& command, Choice& choice) {
  command.add_option("--only", choice.only, "Names, with commas")->delimiter(',');
  command.add_option("--cars", choice.cars, "With commas")->delimiter(',')->capture_default_str();
  command.add_option("--tracks", choice.tracks, "With commas")->delimiter(',')->capture_default_str();
  command.add_option("--presets", choice.presets, "With commas")->delimiter(',')->capture_default_str();
  command.add_option("--set", choice.settings, "KEY=VALUE of the scenario")->allow_extra_args(false);
  command.add_option("--jobs", choice.jobs, "Processes at a time")->capture_default_str();
  command.add_flag("--trace", choice.is_traced, "Print each control step");
}

int attack(int argc, char** argv) {
  Choice choice;
  Choice falsity{.cars = {"udacity", "road-car"}, .tracks = {"lakeside"}};
  CLI::App app("Attacks the guard; exits with 1 when a car has left the road");
  app.require_subcommand(1);
  CLI::App* adversaries = app.add_subcommand("adversaries", "Controllers that try to leave the road");
  add_options(*adversaries, choice);
  adversaries->add_option("--seeds", choice.seeds, "Of each adversary on each road")->capture_default_str();
  adversaries->add_flag("--spread", choice.is_spread, "Each seed on one of the tracks only, in turn");
  adversaries->add_option("--seed", choice.seed, "This one alone");
  adversaries->add_option("--seconds", choice.seconds, "Of each run")->capture_default_str();
  CLI::App* signals = app.add_subcommand("signals", "Wrong telemetry and wrong actuators");
  add_options(*signals, falsity);
  signals->add_option("--onsets", falsity.onsets, "Spread over the flying lap")->capture_default_str();
  signals->add_flag("--first-lap", falsity.is_first_lap, "Onsets in the lap from standstill");
  signals->add_option("--onset", falsity.onset, "This one alone, from 0");
  signals->add_option("--for-s", falsity.durations, "Durations [s], inf: to the end")
      ->delimiter(',')
      ->capture_default_str();
  CLI::App* list = app.add_subcommand("list", "Prints the names of all attacks");
  CLI11_PARSE(app, argc, argv);
  if (list->parsed()) {
    for (const AdversaryKind& kind : adversary_kinds()) fmt::print("{:<18} {}\n", kind.name, kind.meaning);
    for (const FalseSignal& signal : false_signals()) fmt::print("{}\n", signal.name);
    return 0;
  }
  Table table;
  if (choice.seed >= choice.seeds) choice.seeds = choice.seed + 1;
  if (adversaries->parsed())
    for (const Place& place : places_of(choice)) attack_place(choice, place, table);
  if (signals->parsed())
    for (const Place& place : places_of(falsity)) falsify_place(falsity, place, table);
  return table.print(signals->parsed()) > 0 ? 1 : 0;
}

}  // namespace
}  // namespace chicane::attack

int main(int argc, char** argv) { return chicane::attack::attack(argc, argv); }
