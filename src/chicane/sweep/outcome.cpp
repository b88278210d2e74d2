// SPDX-License-Identifier: MIT
#include "chicane/sweep/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "chicane/base/text.hpp"
#include "chicane/protocol/guard_facts.hpp"
#include "chicane/protocol/json.hpp"

namespace chicane::sweep {
namespace {

using telemetry::LapSummary;
using telemetry::RunSummary;

std::string json_number(double value) { return std::isfinite(value) ? number_text(value) : "null"; }

/// A column made of a function from run to number.
template <auto Get>
constexpr Column number(std::string_view name, std::string_view meaning) {
  return {name, meaning,
          [](const RunSummary& run) { return json_number(static_cast<double>(std::invoke(Get, run))); }};
}

/// And a list with a number for each lap.
template <auto Member>
constexpr Column laps(std::string_view name, std::string_view meaning) {
  return {name, meaning, [](const RunSummary& run) {
            std::string text = "[";
            for (const LapSummary& lap : run.laps)
              text += (text.size() > 1 ? "," : "") + json_number(lap.*Member);
            return text + "]";
          }};
}

/// A text of what guards the run.
template <auto Member>
constexpr Column guard_column(std::string_view name, std::string_view meaning) {
  return {name, meaning, [](const RunSummary& run) -> std::string {
            if (!run.guard) return "null";
            return protocol::json_text(protocol::Json(protocol::guard_facts(*run.guard).*Member));
          }};
}

std::string guard_reasons(const RunSummary& run) {
  std::string text = "{";
  for (const auto& word : controller::kGuardReasonWords) {
    const std::uint64_t steps = run.guard_reasons[static_cast<std::size_t>(word.value)];
    if (word.value != controller::GuardReason::kNone && steps > 0)
      text += fmt::format("{}\"{}\":{}", text.size() > 1 ? "," : "", word.name, steps);
  }
  return text + "}";
}

double flying_lap(const RunSummary& run) {
  return run.laps.empty() ? telemetry::kNotMeasured : run.laps.back().lap_time;
}
double best_lap(const RunSummary& run) {
  double best = telemetry::kNotMeasured;
  for (const LapSummary& lap : run.laps) best = lap.lap_time < best || std::isnan(best) ? lap.lap_time : best;
  return best;
}

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

}  // namespace chicane::sweep
