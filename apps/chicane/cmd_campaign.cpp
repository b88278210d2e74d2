// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/protocol/fault_codec.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/fault_campaign.hpp"
#include "chicane/run/parallel.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "interrupt.hpp"
#include "many_runs.hpp"

namespace chicane::apps {
namespace {

using run::FaultOutcome;
using Settings = std::vector<std::pair<std::string, std::string>>;

/// All trials of one fault and duration with one car on one track.
struct Row {
  std::string track, car, fault;
  double duration = 0.0;  ///< [s]
  std::vector<FaultOutcome> outcomes{};

  [[nodiscard]] bool is_lasting() const { return duration >= run::kLasting; }
  [[nodiscard]] auto driven() const {
    return std::count_if(outcomes.begin(), outcomes.end(),
                         [](const FaultOutcome& each) { return std::isfinite(each.least_edge); });
  }
  [[nodiscard]] auto off() const {
    return std::count_if(outcomes.begin(), outcomes.end(),
                         [](const FaultOutcome& each) { return each.has_left_road(); });
  }
  [[nodiscard]] auto standing() const {
    return std::count_if(outcomes.begin(), outcomes.end(),
                         [](const FaultOutcome& each) { return each.stands(); });
  }
  [[nodiscard]] const FaultOutcome& worst() const {
    return *std::min_element(outcomes.begin(), outcomes.end(),
                             [](const auto& a, const auto& b) { return a.least_edge < b.least_edge; });
  }
};

std::string words(double duration) {
  return duration >= run::kLasting ? std::string("lasting") : fmt::format("{} s", duration);
}

/// The command that drives one trial again.
std::string command_of(const Options& options, const Row& row, const FaultOutcome& outcome) {
  std::string text = fmt::format("chicane drive --fast --laps 0 --track {} --car {}", row.track, row.car);
  for (const auto& [key, value] : options.settings) text += fmt::format(" --set {}={}", key, value);
  text += fmt::format(" --fault {}@{}+{}", row.fault, outcome.at, outcome.trial.duration);
  if (outcome.trial.strength != sim::kind_of(outcome.trial.fault).strength)
    text += fmt::format("*{}", outcome.trial.strength);
  const double wait = row.is_lasting() ? run::kLongestWait : outcome.trial.duration + run::kSettling;
  return text + fmt::format(" --set time_limit_s={:.0f}", std::ceil(outcome.at + wait));
}

void print_table(const Options& options, const std::vector<Row>& rows) {
  fmt::print("{:<10} {:<10} {:<20} {:>8} {:>7} {:>5} {:>9} {:>11}\n", "track", "car", "fault", "for",
             "trials", "off", "standing", "to edge [m]");
  for (const Row& row : rows) {
    fmt::print("{:<10} {:<10} {:<20} {:>8} {:>7} {:>5} {:>9} {:>11.2f}\n", row.track, row.car, row.fault,
               words(row.duration), row.driven(), row.off(), row.standing(), row.worst().least_edge);
  }
  for (const Row& row : rows) {
    if (row.off() == 0) continue;
    fmt::print("\n{} {} {} {}: off the road {} of {} times; the worst:\n  {}\n", row.track, row.car,
               row.fault, words(row.duration), row.off(), row.driven(),
               command_of(options, row, row.worst()));
  }
}

/// One line for each car and fault, the tracks together; then the rows in which the road was left.
void print_markdown(const Options& options, const std::vector<Row>& rows) {
  std::vector<double> durations;
  std::vector<std::pair<std::string, std::string>> lines;  // car and fault
  for (const Row& row : rows) {
    if (std::find(durations.begin(), durations.end(), row.duration) == durations.end())
      durations.push_back(row.duration);
    const std::pair line{row.car, row.fault};
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
  }
  fmt::print("| car | fault |");
  for (const double duration : durations)
    fmt::print(" {}: off the road | to the edge [m] |", words(duration));
  fmt::print(" standing at the end |\n|---|---|");
  for (std::size_t i = 0; i < durations.size(); ++i) fmt::print("--:|--:|");
  fmt::print("--:|\n");
  for (const auto& [car, fault] : lines) {
    fmt::print("| `{}` | `{}` |", car, fault);
    std::string standing;
    for (const double duration : durations) {
      std::int64_t off = 0, driven = 0, stood = 0;
      double least = std::numeric_limits<double>::infinity();
      for (const Row& row : rows) {
        if (row.car != car || row.fault != fault || row.duration != duration || row.driven() == 0) continue;
        off += row.off();
        driven += row.driven();
        stood += row.standing();
        least = std::min(least, row.worst().least_edge);
      }
      fmt::print(" {} of {} | {:.2f} |", off, driven, least);
      if (duration >= run::kLasting) standing = fmt::format("{} of {}", stood, driven);
    }
    fmt::print(" {} |\n", standing);
  }
  for (const Row& row : rows) {
    if (row.off() > 0)
      fmt::print("\n{} with `{}`, `{}` {}: {} of {}\n\n    {}\n", row.track, row.car, row.fault,
                 words(row.duration), row.off(), row.driven(), command_of(options, row, row.worst()));
  }
}

void print_json(const Options& options, const std::vector<Row>& rows) {
  protocol::Json all = protocol::Json::array();
  for (const Row& row : rows) {
    protocol::Json json{{"track", row.track}, {"car", row.car}, {"fault", row.fault}};
    json["for_s"] = row.is_lasting() ? protocol::Json() : protocol::Json(row.duration);
    json["trials"] = row.driven();
    json["off_road"] = row.off();
    json["standing"] = row.standing();
    json["least_edge_m"] = row.worst().least_edge;
    json["worst"] = command_of(options, row, row.worst());
    protocol::Json each = protocol::Json::array();
    for (const FaultOutcome& outcome : row.outcomes) {
      if (!std::isfinite(outcome.least_edge)) continue;
      each.push_back({{"at_s", outcome.at},
                      {"least_edge_m", outcome.least_edge},
                      {"end_speed_mps", outcome.end_speed},
                      {"not_controller", outcome.not_controller}});
    }
    json["outcomes"] = std::move(each);
    all.push_back(std::move(json));
  }
  fmt::print("{}\n",
             protocol::json_text(protocol::Json{{"rows", std::move(all)}}, protocol::JsonLayout::kIndented));
}

Result<std::vector<sim::Fault>> chosen_faults(const std::vector<std::string>& names) {
  std::vector<sim::Fault> faults;
  if (names.empty()) {
    for (std::size_t i = 0; i < sim::fault_kinds().size(); ++i) faults.push_back(static_cast<sim::Fault>(i));
  }
  for (const std::string& name : names) {
    const auto fault = sim::fault_named(name);
    if (!fault) {
      return fail(ErrorCode::kInvalidArgument, fmt::format("--faults: got {}, expected {}", printable(name),
                                                           protocol::expected_fault(name)));
    }
    faults.push_back(*fault);
  }
  return faults;
}

/// Where the trials of one car on one track are driven.
struct Place {
  scenario::Scenario scenario;
  run::FlyingLap lap;
};

Result<Place> place_of(const Options& options, const std::string& track, const std::string& car) {
  Settings settings = options.settings;
  settings.emplace_back("track", track);
  settings.emplace_back("car", car);
  Result<scenario::Scenario> scenario = protocol::compose({"", settings});
  if (!scenario) return fail(scenario.error());
  const Result<run::FlyingLap> lap = run::find_flying_lap(*scenario);
  if (!lap) return fail(lap.error());
  return Place{std::move(*scenario), *lap};
}

/// Rows so far, also when it was interrupted.
Result<std::vector<Row>> drive_all(const Options& options, const std::atomic<bool>& wants_stop) {
  const Result<std::vector<sim::Fault>> faults = chosen_faults(options.campaign.faults);
  if (!faults) return fail(faults.error());
  const bool is_terminal = isatty(STDERR_FILENO) == 1;
  const int jobs = run::threads_for(options.jobs);
  std::vector<Row> rows;
  for (const std::string& track : options.campaign.tracks) {
    for (const std::string& car : options.campaign.cars) {
      if (wants_stop) return rows;
      const Result<Place> place = place_of(options, track, car);
      if (!place) return fail(place.error());
      for (const sim::Fault fault : *faults) {
        std::vector<double> durations = options.campaign.durations;
        if (durations.empty()) durations = {sim::kind_of(fault).duration};
        for (const double duration : durations) {
          if (wants_stop) return rows;
          Row row{track, car, std::string(sim::kind_of(fault).name), duration, {}};
          const auto trials = run::trials_over_lap(place->lap, fault, duration, options.campaign.step);
          auto outcomes = run::drive_trials(place->scenario, place->lap, trials, jobs,
                                            [&](std::size_t) { return !wants_stop; });
          if (!outcomes) return fail(outcomes.error());
          row.outcomes = std::move(*outcomes);
          fmt::print(stderr, "{}{} {} {} {}: {} of {} off the road{}", is_terminal ? "\r" : "", track, car,
                     row.fault, words(duration), row.off(), row.driven(), is_terminal ? "          " : "\n");
          rows.push_back(std::move(row));
        }
      }
    }
  }
  if (is_terminal) fmt::print(stderr, "\r{:78}\r", "");
  return rows;
}

}  // namespace

ExitCode campaign(const Options& options) {
  keep_memory();
  static std::atomic<bool> wants_stop{false};  // as long as signals may come
  catch_interrupts(wants_stop);
  const Result<std::vector<Row>> rows = drive_all(options, wants_stop);
  if (!rows) return report(rows.error());
  if (options.is_json) {
    print_json(options, *rows);
  } else if (options.is_markdown) {
    print_markdown(options, *rows);
  } else {
    print_table(options, *rows);
  }
  const bool is_kept = std::none_of(rows->begin(), rows->end(), [](const Row& row) { return row.off() > 0; });
  return is_kept ? kSuccess : kRunFailed;
}

}  // namespace chicane::apps
