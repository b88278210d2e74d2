// SPDX-License-Identifier: MIT
#include "replay_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "chicane/protocol/json.hpp"

namespace chicane::apps {
namespace {

using protocol::Json;

Json cycle(const std::optional<std::uint64_t>& number) { return number ? Json(*number) : Json(nullptr); }
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string dump(const Json& object) {
  return protocol::json_text(object, protocol::JsonLayout::kIndented) + "\n";
}

Json json_of(const recording::Future& future) {
  return {{"duration_s", number(future.duration)},
          {"lap_times_s", future.lap_times},
          {"max_abs_lateral_error_m", number(future.max_lateral_error)},
          {"min_edge_distance_m", number(future.min_edge_distance)},
          {"mean_speed_mps", number(future.mean_speed)},
          {"top_speed_mps", number(future.top_speed)},
          {"off_track_events", future.off_track_events}};
}

/// "0.50" or a dash, in a column of ten characters.
std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{:12.2f}", value) : fmt::format("{:>12}", "-");
}

}  // namespace

std::string to_json(const recording::ReplayReport& report) {
  return dump({{"recorded_by", report.recorded_by},
               {"controller", report.controller},
               {"track", report.track},
               {"verified", report.is_verified()},
               {"steps", report.steps},
               {"identical", report.identical},
               {"different", report.different},
               {"unknown", report.unknown},
               {"first_difference", cycle(report.first_difference)},
               {"late", report.late},
               {"damaged", report.damaged},
               {"closed", report.is_complete}});
}

std::string to_text(const recording::ReplayReport& report) {
  const double share =
      report.steps == 0 ? 0.0
                        : 100.0 * static_cast<double>(report.identical) / static_cast<double>(report.steps);
  // Never rounded up to 100.
  const std::string percent = report.is_verified() ? "100" : fmt::format("{:.3f}", std::min(share, 99.999));
  std::string text =
      fmt::format("{} on {}, recorded by {}: {} of {} commands came out identical, bit for bit ({} %)\n",
                  report.controller, report.track.empty() ? "an external simulator's track" : report.track,
                  report.recorded_by, report.identical, report.steps, percent);
  if (report.first_difference) {
    text +=
        fmt::format("first difference: cycle {} ({} in all)\n", *report.first_difference, report.different);
  }
  if (report.unknown > 0) text += fmt::format("behind missing steps, not comparable: {}\n", report.unknown);
  if (report.late > 0) text += fmt::format("of which the deadline was spent: {}\n", report.late);
  if (report.damaged > 0) text += fmt::format("damaged parts left out: {}\n", report.damaged);
  if (!report.is_complete) text += "the recording was not closed: its end is missing\n";
  return text;
}

std::string to_json(const recording::BranchReport& report) {
  return dump({{"branch_at_s", report.at},
               {"cycle", report.cycle},
               {"steps_before", report.steps_before},
               {"first_difference", cycle(report.first_difference)},
               {"end_reason", report.end_reason.empty() ? Json(nullptr) : Json(report.end_reason)},
               {"recorded", json_of(report.recorded)},
               {"branch", json_of(report.branched)}});
}

std::string to_text(const recording::BranchReport& report,
                    const std::vector<std::pair<std::string, std::string>>& settings) {
  std::string changes;
  for (const auto& [key, value] : settings) {
    changes += fmt::format("{}{} = {}", changes.empty() ? "" : ", ", key, value);
  }
  std::string text = fmt::format("from {:.2f} s on: {}\n\n{:24}{:>12}{:>12}\n", report.at,
                                 changes.empty() ? "nothing changed" : changes, "", "recorded", "branch");
  const auto row = [&](std::string_view name, double was, double is) {
    text += fmt::format("{:24}{}{}\n", name, cell(was), cell(is));
  };
  const recording::Future &was = report.recorded, &is = report.branched;
  row("duration [s]", was.duration, is.duration);
  for (std::size_t i = 0; i < std::max(was.lap_times.size(), is.lap_times.size()); ++i) {
    const auto lap = [&](const recording::Future& future) {
      return i < future.lap_times.size() ? future.lap_times[i] : std::nan("");
    };
    row(fmt::format("lap time {} [s]", i + 1), lap(was), lap(is));
  }
  row("max |lateral error| [m]", was.max_lateral_error, is.max_lateral_error);
  row("min edge distance [m]", was.min_edge_distance, is.min_edge_distance);
  row("mean speed [m/s]", was.mean_speed, is.mean_speed);
  row("top speed [m/s]", was.top_speed, is.top_speed);
  text +=
      fmt::format("{:24}{:>12}{:>12}\n", "off the road, times", was.off_track_events, is.off_track_events);
  if (!report.end_reason.empty()) text += fmt::format("the branch ended: {}\n", report.end_reason);
  if (report.first_difference) {
    text += fmt::format(
        "the recording did not come out the same from cycle {} on: the first column is what this program "
        "computes, not what was\n",
        *report.first_difference);
  }
  return text;
}

}  // namespace chicane::apps
