// SPDX-License-Identifier: MIT
// Columns of a run's result, commands that repeat a run, and their links to the page.
#include "chicane/sweep/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/controller/registry.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/protocol/schema_json.hpp"

namespace chicane::sweep {
namespace {

using telemetry::LapSummary;
using telemetry::RunSummary;

/// Number as JSON; null if it is not finite.
std::string json_number(double value) { return std::isfinite(value) ? number_text(value) : "null"; }

/// Column of a number: `Get` is a member of the run or a function of it.
template <auto Get>
constexpr Column number(std::string_view name, std::string_view meaning) {
  return {name, meaning,
          [](const RunSummary& run) { return json_number(static_cast<double>(std::invoke(Get, run))); }};
}

/// Column of a list with one number for each lap.
template <auto Member>
constexpr Column laps(std::string_view name, std::string_view meaning) {
  return {name, meaning, [](const RunSummary& run) {
            std::string text = "[";
            for (const LapSummary& lap : run.laps)
              text += (text.size() > 1 ? "," : "") + json_number(lap.*Member);
            return text + "]";
          }};
}

/// Column of one fact about the guard of the run; null without a guard.
template <auto Member>
constexpr Column guard_column(std::string_view name, std::string_view meaning) {
  return {name, meaning, [](const RunSummary& run) -> std::string {
            if (!run.guard) return "null";
            return protocol::json_text(protocol::Json(protocol::guard_facts(*run.guard).*Member));
          }};
}

/// Object with the number of control steps for each reason of the guard.
std::string guard_reasons(const RunSummary& run) {
  std::string text = "{";
  for (const auto& word : controller::kGuardReasonWords) {
    const std::uint64_t steps = run.guard_reasons[static_cast<std::size_t>(word.value)];
    if (word.value != controller::GuardReason::kNone && steps > 0)
      text += fmt::format("{}\"{}\":{}", text.size() > 1 ? "," : "", word.name, steps);
  }
  return text + "}";
}

/// Time of the last completed lap [s].
double flying_lap(const RunSummary& run) {
  return run.laps.empty() ? telemetry::kNotMeasured : run.laps.back().lap_time;
}
/// Time of the fastest completed lap [s].
double best_lap(const RunSummary& run) {
  double best = telemetry::kNotMeasured;
  for (const LapSummary& lap : run.laps) best = lap.lap_time < best || std::isnan(best) ? lap.lap_time : best;
  return best;
}

/// Length of the car's path in the last completed lap [m].
double driven_in_last_lap(const RunSummary& run) {
  return run.laps.empty() ? telemetry::kNotMeasured : run.laps.back().mean_speed * run.laps.back().lap_time;
}

constexpr std::array kColumns{
    Column{"completed", "All laps were driven.",
           [](const RunSummary& run) -> std::string { return run.completed ? "true" : "false"; }},
    Column{"end_reason", "Why it ended otherwise.",
           [](const RunSummary& run) { return protocol::json_text(protocol::Json(run.end_reason)); }},
    number<&RunSummary::laps_completed>("laps_completed", "Laps driven to their end."),
    number<&RunSummary::off_track_events>("off_track_events", "Times a tyre left the road."),
    number<&RunSummary::out_of_track_time>("out_of_track_time_s", "With a tyre off the road."),
    number<&RunSummary::duration>("duration_s", "Of the run, in its own time."),
    number<&flying_lap>("lap_time_s", "Of the last completed lap."),
    number<&best_lap>("best_lap_time_s", "Of the fastest completed lap."),
    number<&driven_in_last_lap>(
        "driven_m", "In the last completed lap: less than the road's line where corners are cut."),
    number<[](const RunSummary& run) { return run.total.mean_speed; }>("mean_speed_mps",
                                                                       "Over the whole run."),
    number<[](const RunSummary& run) { return run.total.top_speed; }>("top_speed_mps", "Of the whole run."),
    number<[](const RunSummary& run) { return run.total.rms_lateral_error; }>(
        "rms_lateral_error_m", "From the track's line, over the whole run."),
    number<[](const RunSummary& run) { return run.total.max_abs_lateral_error; }>("max_abs_lateral_error_m",
                                                                                  "The largest."),
    number<[](const RunSummary& run) { return run.total.min_edge_distance; }>(
        "min_edge_distance_m", "Of the outermost tyre to the road's edge, the least; negative beyond it."),
    number<[](const RunSummary& run) { return run.total.max_lateral_acceleration; }>(
        "max_lateral_acceleration_mps2", "The largest."),
    number<[](const RunSummary& run) { return run.total.steering_rate_rms; }>(
        "steering_rate_rms_radps", "Of the road wheel, from control cycle to control cycle."),
    number<&RunSummary::cycles>("cycles", "Control steps."),
    number<&RunSummary::mean_iterations>("mean_iterations", "Of the solver, in a control step."),
    number<&RunSummary::not_usable>("not_usable", "Solves whose answer must not be used."),
    number<&RunSummary::fallbacks>("fallbacks", "Control steps that were not the controller's own answer."),
    number<&RunSummary::gate_interventions>("gate_interventions", "Commands that the gate changed."),
    Column{"guard_reasons", "Control steps in which the guard found something, by its reason.",
           &guard_reasons},
    laps<&LapSummary::lap_time>("lap_times_s", "Of each lap."),
    laps<&LapSummary::mean_speed>("lap_mean_speeds_mps", "Of each lap."),
    laps<&LapSummary::top_speed>("lap_top_speeds_mps", "Of each lap."),
    laps<&LapSummary::rms_lateral_error>("lap_rms_lateral_errors_m", "Of each lap."),
    laps<&LapSummary::min_edge_distance>("lap_min_edge_distances_m", "Of each lap."),
    laps<&LapSummary::steering_rate_rms>("lap_steering_rates_radps", "Of each lap."),
    guard_column<&protocol::GuardFacts::mode>("guard_mode", "What the guard does: on, observe or off."),
    guard_column<&protocol::GuardFacts::road>("guard_road", "Where the guard knows the road from."),
    Column{"state_hash", "Of every state and command: equal hashes mean equal runs.",
           [](const RunSummary& run) { return fmt::format("\"{:016x}\"", run.state_hash); }},
};

}  // namespace

std::span<const Column> columns() { return kColumns; }

const Column* find_column(std::string_view name) {
  const auto* const found =
      std::find_if(kColumns.begin(), kColumns.end(), [&](const Column& each) { return each.name == name; });
  return found == kColumns.end() ? nullptr : found;
}

namespace {

constexpr std::string_view kFaultPart = "fault.";  // begin of the keys of a fault in parts

/// Part of `fault` that a key sets; null for another key.
std::string* part_of(protocol::FaultText& fault, std::string_view key) {
  if (key == "fault.name") return &fault.name;
  if (key == "fault.at_s") return &fault.at;
  if (key == "fault.for_s") return &fault.duration;
  if (key == "fault.strength") return &fault.strength;
  return nullptr;
}

/// Speed of a text, in its own unit; none for a text that is no number in (0, 1e6), an arbitrary limit.
std::optional<double> speed_in(const std::string& text) {
  const std::optional<double> value = number_in(text);
  return value && *value > 0.0 && *value < 1e6 ? value : std::nullopt;
}

/// Whether the key sets the reference speed of whichever controller drives.
bool is_speed(std::string_view key) { return key == "speed_mph" || key == "speed_mps"; }

/// Checks one part of a fault, in a fault whose other parts are valid.
Result<void> check_fault_part(std::string_view key, const std::string& text) {
  protocol::FaultText fault;
  fault.name = std::string(sim::fault_kinds().front().name);
  fault.at = "0";
  std::string* const part = part_of(fault, key);
  if (part == nullptr) {
    return fail(ErrorCode::kNotFound,
                fmt::format("{}: got an unknown key, expected fault.name, fault.at_s, fault.for_s or "
                            "fault.strength",
                            printable(key)));
  }
  *part = text;
  const Result<sim::FaultEvent> event = protocol::read_fault(fault);
  return event ? Result<void>{} : fail(event.error());
}

/// Whether neither a shell nor a URL gives the character a meaning of its own: letters, digits, '-', '_',
/// '.'.
bool is_plain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_' ||
         c == '.';
}

/// Text encoded as a browser's URLSearchParams reads it.
std::string url_encoded(std::string_view text) {
  std::string encoded;
  for (const char c : text)
    encoded += is_plain(c) ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return encoded;
}

/// Settings with each key once: its last value, at the place where that stands.
Settings winning(const Settings& settings) {
  Settings last;
  for (const auto& setting : settings) {
    std::erase_if(last, [&](const auto& each) { return each.first == setting.first; });
    last.push_back(setting);
  }
  return last;
}

/// Reference speed as a setting of the controller that drives; none if the request is no valid scenario.
std::optional<std::pair<std::string, std::string>> speed_setting(const protocol::Request& request) {
  const Result<scenario::Scenario> scenario = protocol::compose(request);
  if (!scenario) return std::nullopt;
  const auto* driver = controller::Registry::find(scenario->controller);
  const protocol::Parameter* row = protocol::find_option(driver->name, driver->speed_option);
  return std::pair{std::string(row->key), protocol::get_text(*scenario, *row)};
}

}  // namespace

Result<void> check_setting(std::string_view key, const std::string& text) {
  if (key == "scenario")
    return text.empty() ? fail(ErrorCode::kInvalidArgument, "scenario: got nothing, expected a name or file")
                        : Result<void>{};
  if (is_speed(key)) {
    if (speed_in(text)) return {};
    return fail(refusal(key, text, "a positive number"));
  }
  if (key == "fault") {
    const Result<sim::FaultEvent> event = protocol::parse_fault(text);
    return event ? Result<void>{} : fail(event.error());
  }
  if (key.starts_with(kFaultPart)) return check_fault_part(key, text);
  scenario::Scenario scratch;
  return protocol::set_text(scratch, key, text);
}

Result<protocol::Request> request_of(const Settings& settings) {
  protocol::Request request;
  protocol::FaultText fault;
  for (const auto& [key, text] : settings) {
    if (key == "scenario") {
      request.scenario_file = text;
    } else if (key == "speed_mps") {
      request.speed_mps = text;
    } else if (key == "speed_mph") {
      const std::optional<double> mph = speed_in(text);
      if (!mph) return fail(ErrorCode::kInvalidArgument, fmt::format("speed_mph: got {}", printable(text)));
      request.speed_mps = fmt::format("{}", mph_to_mps(*mph));
    } else if (key == "fault") {
      request.faults.push_back(text);
    } else if (std::string* const part = part_of(fault, key)) {
      *part = text;
    } else {
      request.settings.emplace_back(key, text);
    }
  }
  if (!fault.name.empty()) {
    std::string text = fmt::format("{}@{}", fault.name, fault.at.empty() ? "0" : fault.at);
    if (!fault.duration.empty()) text += "+" + fault.duration;
    if (!fault.strength.empty()) text += "*" + fault.strength;
    request.faults.push_back(std::move(text));
  }
  return request;
}

Result<scenario::Scenario> scenario_of(const Settings& settings) {
  const Result<protocol::Request> request = request_of(settings);
  return request ? protocol::compose(*request) : fail(request.error());
}

std::string shell_word(const std::string& text) {
  const auto needs_no_quotes = [](char c) {
    return is_plain(c) || std::string_view("/:=+@,%").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), needs_no_quotes)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string command_of(const Settings& settings) {
  using Name = std::pair<std::string_view, std::string_view>;
  constexpr std::array kOptions{Name{"preset", "--preset"},
                                Name{"controller", "--controller"},
                                Name{"track", "--track"},
                                Name{"car", "--car"},
                                Name{"laps", "--laps"},
                                Name{"seed", "--seed"},
                                Name{"latency_ms", "--latency-ms"}};
  std::string command = "chicane drive --fast";
  const Result<protocol::Request> request = request_of(settings);
  if (!request) return command;
  if (!request->scenario_file.empty()) command += " " + shell_word(request->scenario_file);
  const Settings last = winning(request->settings);
  std::string rest;
  for (const auto& [key, text] : last) {
    const auto* const option = std::find_if(
        kOptions.begin(), kOptions.end(), [&, &name = key](const auto& each) { return name == each.first; });
    if (option != kOptions.end()) command += fmt::format(" {} {}", option->second, shell_word(text));
    if (option == kOptions.end()) rest += " --set " + shell_word(fmt::format("{}={}", key, text));
  }
  const auto speed = std::find_if(settings.rbegin(), settings.rend(),
                                  [](const auto& setting) { return is_speed(setting.first); });
  if (speed != settings.rend()) rest += fmt::format(" --speed-{} {}", speed->first.substr(6), speed->second);
  for (const std::string& fault : request->faults) rest += " --fault " + shell_word(fault);
  return command + rest;
}

std::string link_of(const Settings& settings) {
  const Result<protocol::Request> request = request_of(settings);
  if (!request || !request->scenario_file.empty() || !request->faults.empty()) return "";
  Settings held = winning(request->settings);
  for (const auto& [key, text] : held) {
    const bool is_name = key == "track" || key == "car" || key == "preset";
    if (is_name && text.find_first_of("/.") != std::string::npos) return "";
  }
  if (!request->speed_mps.empty()) {
    const auto speed = speed_setting(*request);
    if (!speed) return "";
    held.push_back(*speed);
  }
  std::string query;
  for (const auto& [key, text] : winning(held)) {
    if (key == "laps" || key == "time_limit_s") continue;  // the length of a run does not identify it
    query += fmt::format("{}{}={}", query.empty() ? "" : "&", url_encoded(key), url_encoded(text));
  }
  return "http://localhost:4567/#run?" + query;
}

}  // namespace chicane::sweep
