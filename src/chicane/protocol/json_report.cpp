// SPDX-License-Identifier: MIT
// Summaries of runs as JSON for machines and as text for people, and the reading of such JSON.
#include "chicane/protocol/json_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <numeric>
#include <type_traits>
#include <utility>
#include <variant>

#include "chicane/base/instruction_set.hpp"
#include "chicane/base/math.hpp"
#include "chicane/protocol/json.hpp"

namespace chicane::protocol {
namespace {

using telemetry::LapSummary;
using telemetry::RunSummary;
using telemetry::TimeSummary;

/// Shares in percent.
std::array<double, 3> percent(const std::array<double, 3>& shares) {
  return {100.0 * shares[0], 100.0 * shares[1], 100.0 * shares[2]};
}

/// Corners in the order of a lap, by which they are numbered.
Json to_object(const std::vector<road::Corner>& corners) {
  Json json = Json::array();
  for (const road::Corner& each : corners) {
    json.push_back({{"begin_m", each.begin},
                    {"apex_m", each.apex},
                    {"end_m", each.end},
                    {"turn_deg", radians_to_degrees(each.turn)}});
  }
  return json;
}

/// Times of corners, three a line: "corners [s]         1 left 10.44   2 right 3.80".
std::string corner_lines(const RunSummary& run, const LapSummary& lap) {
  std::string text;
  for (std::size_t i = 0; i < lap.corner_times.size() && i < run.corners.size(); ++i) {
    if (i % 3 == 0) text += i == 0 ? "\ncorners [s]     " : "\n                ";
    text += fmt::format("{:>5} {:<5}{:6.2f}", i + 1, run.corners[i].turn > 0.0 ? "left" : "right",
                        lap.corner_times[i]);
  }
  return text;
}

Json to_object(const std::optional<lap_time::LapTimes>& limit) {
  if (!limit) return nullptr;
  return {{"lap_time_s", limit->lap}, {"sector_times_s", limit->sectors}, {"corner_times_s", limit->corners}};
}

Json to_object(const std::vector<lap_time::LapWithout>& laps) {
  Json json = Json::array();
  for (const lap_time::LapWithout& lap : laps) {
    json.push_back({{"cause", lap.cause},
                    {"lap_time_s", lap.lap_time},
                    {"corner_times_s", lap.corners},
                    {"off_track_events", lap.off_track_events}});
  }
  return json;
}

std::string cell(double value, int width) {
  return std::isfinite(value) ? fmt::format(" {:>{}.2f}", value, width) : fmt::format(" {:>{}}", "-", width);
}

/// Line of the table of causes, for a corner or the lap. The last cell is the part of the gap without a
/// cause.
std::string cause_line(std::string_view name, double limit, double planned, double lap,
                       const std::vector<double>& without) {
  std::string text = fmt::format("{:>8}", name);
  for (const double time : {limit, planned, lap, lap - limit}) text += cell(time, 6);
  double rest = lap - limit;
  for (const double time : without) {
    text += cell(lap - time, 7);
    if (std::isfinite(time)) rest -= lap - time;
  }
  return text + cell(rest, 5) + "\n";
}

/// Table of the gap of `lap` to the limit by cause, a line for each corner; empty for runs without such a
/// table.
std::string cause_table(const RunSummary& run, const LapSummary& lap) {
  if (run.without.empty() || !run.limit || lap.corner_times.size() != run.limit->corners.size()) return "";
  const auto at = [](const std::vector<double>& times, std::size_t corner) {
    return corner < times.size() ? times[corner] : telemetry::kNotMeasured;
  };
  std::string text = fmt::format("\n{:>8} {:>6} {:>6} {:>6} {:>6}", "gap [s]", "limit", "plan", "lap", "gap");
  std::string second(36, ' ');  // words of the causes: "edge" above "margin"
  for (const lap_time::LapWithout& each : run.without) {
    const std::string_view cause = each.cause;
    const std::size_t space = std::min(cause.find(' '), cause.size());
    text += fmt::format(" {:>7}", cause.substr(0, space));
    second += fmt::format(" {:>7}", cause.substr(std::min(space + 1, cause.size())));
  }
  text += fmt::format(" {:>5}\n{}\n", "rest", second.substr(0, second.find_last_not_of(' ') + 1));
  std::vector<double> without(run.without.size());
  for (std::size_t corner = 0; corner < lap.corner_times.size(); ++corner) {
    for (std::size_t i = 0; i < without.size(); ++i) without[i] = at(run.without[i].corners, corner);
    text += cause_line(fmt::format("{} {}", corner + 1, run.corners[corner].turn > 0.0 ? "left " : "right"),
                       run.limit->corners[corner], at(run.planned_corner_times, corner),
                       lap.corner_times[corner], without);
  }
  for (std::size_t i = 0; i < without.size(); ++i) without[i] = run.without[i].lap_time;
  const auto& planned = run.planned_corner_times;
  const double planned_lap =
      planned.empty() ? telemetry::kNotMeasured : std::accumulate(planned.begin(), planned.end(), 0.0);
  text += cause_line("lap", run.limit->lap, planned_lap, lap.lap_time, without);
  for (const lap_time::LapWithout& each : run.without)
    if (each.off_track_events > 0)
      text += fmt::format("{:>8} without {} the car left the road {} times\n", "", each.cause,
                          each.off_track_events);
  return text;
}

/// Times of sectors: "8.93 8.80 9.14", or "-" for a stretch that was no lap.
std::string sectors(const LapSummary& lap) {
  const auto& times = lap.sector_times;
  if (!std::isfinite(times[0] + times[1] + times[2])) return "-";
  return fmt::format("{:.2f} {:.2f} {:.2f}", times[0], times[1], times[2]);
}

std::string row(std::string_view name, const LapSummary& lap) {
  const std::string edge =
      std::isfinite(lap.min_edge_distance) ? fmt::format("{:.2f}", lap.min_edge_distance) : "-";
  return fmt::format("{:>4} {:>8.3f} {:>6.1f} {:>6.1f} {:>7.2f} {:>7.2f} {:>7} {:>7.1f} {:>20}\n", name,
                     lap.lap_time, mps_to_mph(lap.mean_speed), mps_to_mph(lap.top_speed),
                     lap.rms_lateral_error, lap.max_abs_lateral_error, edge, lap.max_lateral_acceleration,
                     sectors(lap));
}

std::string times(const TimeSummary& time) {
  if (!std::isfinite(time.p50)) return "not measured";
  return fmt::format("{:.1f} / {:.1f} / {:.1f} / {:.1f} µs", 1e6 * time.p50, 1e6 * time.p99, 1e6 * time.p999,
                     1e6 * time.max);
}

/// Version and options of the guard, as files name them; null where another program drives.
Json to_object(const std::optional<safety::GuardOptions>& guard) {
  if (!guard) return nullptr;
  Json json{{"version", safety::kGuardVersion}};
  for (const Option& option : safety::guard_options())
    std::visit([&](const auto& value) { json[option_key("", option)] = value; }, get(option, &*guard));
  return json;
}

/// Count of steps by the guard's findings; findings without steps are left out.
Json guard_reasons(const telemetry::RunSummary& run) {
  Json reasons = Json::object();
  for (std::size_t i = 1; i < run.guard_reasons.size(); ++i) {
    if (run.guard_reasons[i] > 0)
      reasons[std::string(controller::kGuardReasonWords[i].name)] = run.guard_reasons[i];
  }
  return reasons;
}

/// Estimated quantities with their standard deviations; null for any that was not estimated.
Json to_object(const controller::LearnedCar& learned) {
  Json json = Json::object();
  const auto add = [&](const std::string& name, std::string_view unit, const controller::Estimate& estimate,
                       double in_unit) {
    if (!std::isfinite(estimate.value)) return;
    json[fmt::format("{}{}", name, unit)] = in_unit * estimate.value;
    json[fmt::format("{}_sd{}", name, unit)] = in_unit * estimate.deviation;
  };
  add("delay", "_ms", learned.delay, 1e3);
  add("steer_gain", "", learned.gain, 1.0);
  add("steer_offset", "_deg", learned.offset, radians_to_degrees(1.0));
  add("grip", "", learned.grip, 1.0);
  return json.empty() ? Json(nullptr) : json;
}

/// Line of learned values: "learned            delay +58 ± 6 ms, ...", with two standard deviations; empty
/// unless a run identifies its car.
std::string learned_line(const controller::LearnedCar& learned) {
  if (!std::isfinite(learned.delay.value)) return "";
  std::string text;
  const auto add = [&](std::string_view name, std::string_view format, const controller::Estimate& estimate,
                       double in_unit) {
    if (!std::isfinite(estimate.value)) return;
    text += text.empty() ? "learned            " : name == "offset" ? ",\n                   " : ", ";
    text += fmt::format("{} ", name) +
            fmt::format(fmt::runtime(format), in_unit * estimate.value, 2.0 * in_unit * estimate.deviation);
  };
  add("delay", "{:+.0f} ± {:.0f} ms", learned.delay, 1e3);
  add("steering gain", "{:.2f} ± {:.2f}", learned.gain, 1.0);
  add("offset", "{:+.2f} ± {:.2f}°", learned.offset, radians_to_degrees(1.0));
  add("grip", "{:.2f} ± {:.2f}", learned.grip, 1.0);
  return text + "\n";
}

/// Members of a JSON object, each written from a value or read into it. A number that is missing is read as
/// NaN, a count as 0.
struct Members {
  Json& json;
  bool is_read;

  [[nodiscard]] Members part(Json& member) const {
    if (!member.is_object()) member = Json::object();
    return {member, is_read};
  }
  void only_written(const char* key, Json value) const {
    if (!is_read) json[key] = std::move(value);
  }
  /// `factor`: how much larger the number is in the unit of its key.
  void number(Json& member, double& value, double factor = 1.0) const {
    if (!is_read) member = factor * value;
    if (is_read) value = member.is_number() ? member.get<double>() / factor : telemetry::kNotMeasured;
  }
  void operator()(const char* key, double& value, double factor = 1.0) const {
    number(json[key], value, factor);
  }
  void operator()(const char* key, std::integral auto& count) const {
    double value = telemetry::kNotMeasured;
    if (!is_read) json[key] = count;
    if (is_read) number(json[key], value);
    if (is_read) count = value >= 0.0 && value < 1e9 ? static_cast<std::decay_t<decltype(count)>>(value) : 0;
  }
  void operator()(const char* key, std::string& text) const {
    if (!is_read) json[key] = text;
    if (is_read) text = json[key].is_string() ? json[key].get<std::string>() : "";
  }
};

void add(const Members& to, LapSummary& lap) {
  to("lap_time_s", lap.lap_time);
  to("mean_speed_mps", lap.mean_speed);
  to("top_speed_mps", lap.top_speed);
  to.only_written("top_speed_mph", mps_to_mph(lap.top_speed));
  to("rms_lateral_error_m", lap.rms_lateral_error);
  to("max_abs_lateral_error_m", lap.max_abs_lateral_error);
  to("min_edge_distance_m", lap.min_edge_distance);
  to("max_lateral_acceleration_mps2", lap.max_lateral_acceleration);
  to("steering_rate_rms_radps", lap.steering_rate_rms);
  to.only_written("sector_times_s", lap.sector_times);
  Json& sectors = to.json["sector_times_s"];
  for (std::size_t i = 0;
       sectors.is_array() && sectors.size() == lap.sector_times.size() && i < sectors.size(); ++i)
    to.number(sectors[i], lap.sector_times[i]);
  to.only_written("corner_times_s", lap.corner_times);
  to.only_written("gap_to_limit_percent", 100.0 * lap.gap_to_limit.value_or(telemetry::kNotMeasured));
  to.only_written("sector_gaps_to_limit_percent", percent(lap.sector_gaps));
}

void add(const Members& to, TimeSummary& time) {
  to("p50", time.p50, 1e6);
  to("p99", time.p99, 1e6);
  to("p999", time.p999, 1e6);
  to("max", time.max, 1e6);
}

void add(const Members& to, RunSummary& run) {
  to("track", run.track);
  if (run.track.empty()) to.only_written("track", nullptr);
  to("car", run.car);
  to("controller", run.controller);
  to("preset", run.preset);
  to.only_written("guard", to_object(run.guard));
  to("seed", run.seed);
  to("latency_ms", run.latency, 1e3);
  to.only_written("notices", run.notices);
  to.only_written("completed", run.completed);
  to("end_reason", run.end_reason);
  to("laps_completed", run.laps_completed);
  to("off_track_events", run.off_track_events);
  to("out_of_track_time_s", run.out_of_track_time);
  to.only_written("corners", to_object(run.corners));
  to.only_written("laps", std::vector<Json>(run.laps.size()));
  run.laps.resize(to.json["laps"].size());
  for (std::size_t i = 0; i < run.laps.size(); ++i) add(to.part(to.json["laps"][i]), run.laps[i]);
  add(to.part(to.json["total"]), run.total);
  to.only_written("limit", to_object(run.limit));
  to.only_written("planned_corner_times_s", run.planned_corner_times);
  to.only_written("without", to_object(run.without));
  to.only_written("why_no_limit", run.why_no_limit.empty() ? Json(nullptr) : Json(run.why_no_limit));
  to.only_written("step_time_is", run.guard ? "control step" : "round trip");
  add(to.part(to.json["step_time_us"]), run.step_time);
  add(to.part(to.json["solve_time_us"]), run.solve_time);
  to.only_written("solver", {{"mean_iterations", run.mean_iterations}, {"not_usable", run.not_usable}});
  to("cycles", run.cycles);
  to("fallbacks", run.fallbacks);
  to.only_written("guard_reasons", guard_reasons(run));
  to.only_written("learned", to_object(run.learned));
  to.only_written("gate_interventions", run.gate_interventions);
  to("deadline_misses", run.deadline_misses);
  to("duration_s", run.duration);
  to("wall_time_s", run.wall_time);
  to.only_written("state_hash", fmt::format("{:016x}", run.state_hash));
  to.only_written("arithmetic", arithmetic(chosen_instruction_set()));
}

/// Duration of the run, and the reason of its end.
std::string outcome(const RunSummary& run) {
  std::string text;
  if (run.wall_time > 0.0) {
    text += fmt::format("simulated          {:.1f} s in {:.2f} s ({:.0f} times real time)\n", run.duration,
                        run.wall_time, run.duration / run.wall_time);
  }
  if (run.laps_wanted == 0) return text + fmt::format("{} laps until stopped\n", run.laps_completed);
  const std::string how =
      completed_on_road(run) ? "completed, all tyres on the road"
      : run.completed        ? "completed, but left the road"
                      : fmt::format("not completed: {}", run.end_reason.empty() ? "stopped" : run.end_reason);
  return text + fmt::format("{} of {} laps, {}\n", run.laps_completed, run.laps_wanted, how);
}

}  // namespace

Result<RunSummary> read_run(std::string_view text) {
  Json json = parse_json(text);
  if (!json.is_object() || !json.contains("laps") || !json["laps"].is_array() || !json.contains("total") ||
      !json.contains("completed") || !json["completed"].is_boolean())
    return fail(ErrorCode::kParse, "got no result of a run, expected an object as --json prints it");
  RunSummary run;
  add({json, true}, run);
  run.completed = json["completed"].get<bool>();
  run.laps_wanted = std::max(run.laps_completed, 1);
  return run;
}

std::string to_json(const RunSummary& summary) {
  Json report;
  RunSummary run = summary;
  add({report, false}, run);
  return json_text(report, JsonLayout::kIndented) + "\n";
}

std::string to_table(const RunSummary& run) {
  const std::string guard = run.guard ? fmt::format(", guard {}", guard_facts(*run.guard).mode) : "";
  std::string text = fmt::format("{} on {}, {} ({}){}, {:g} ms latency, seed {}\n", run.car,
                                 run.track.empty() ? "an unknown road" : run.track, run.preset,
                                 run.controller, guard, 1e3 * run.latency, run.seed);
  if (const std::size_t at = text.find(" guard "); text.size() > 81 && at < text.size()) text[at] = '\n';
  text +=
      " lap     time   mean    top   e rms   e max to edge lateral              sectors\n"
      "            s    mph    mph       m       m       m    m/s²                    s\n";
  int lap = 0;
  for (const LapSummary& summary : run.laps) text += row(fmt::format("{}", ++lap), summary);
  text += row("all", run.total);
  const auto best =
      std::min_element(run.laps.begin(), run.laps.end(),
                       [](const LapSummary& a, const LapSummary& b) { return a.lap_time < b.lap_time; });
  if (best != run.laps.end()) text += corner_lines(run, *best);
  if (run.limit) {
    text += fmt::format("\nlimit              {:.3f} s", run.limit->lap);
    if (best != run.laps.end())
      text += fmt::format(", the best lap {:+.2f} %", 100.0 * lap_time::gap(best->lap_time, run.limit->lap)) +
              cause_table(run, *best);
  } else if (!run.why_no_limit.empty()) {
    text += fmt::format("\nlimit              not known: {}", run.why_no_limit);
  }
  text +=
      fmt::format("\noff track          {} times, {:.2f} s\n", run.off_track_events, run.out_of_track_time);
  if (!run.guard) {  // another program drives, of which only the time of its answers is known
    text += fmt::format("round trip         {}\n                   p50 / p99 / p99.9 / max, {} answers\n",
                        times(run.step_time), run.cycles);
    return text + outcome(run);
  }
  text +=
      fmt::format("control step       {}\n                   p50 / p99 / p99.9 / max, {} steps, {} late\n",
                  times(run.step_time), run.cycles, run.deadline_misses);
  text += fmt::format("optimisation       {}\n                   {:.1f} iterations, {} without an answer\n",
                      times(run.solve_time), run.mean_iterations, run.not_usable);
  text += fmt::format("safety             {} fallbacks, {} commands changed by the gate\n", run.fallbacks,
                      run.gate_interventions);
  text += learned_line(run.learned);
  const Json reasons = guard_reasons(run);
  for (const auto& [reason, steps] : reasons.items())
    text += fmt::format("guard              {}: {} steps\n", reason, steps.get<std::uint64_t>());
  return text + outcome(run);
}

namespace {

std::string text_of(std::string_view name, const safety::GuardOptions& guard) {
  const auto rows = safety::guard_options();
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const Option& each) { return each.name == name; });
  return std::get<std::string>(get(*row, &guard));
}

}  // namespace

GuardFacts guard_facts(const safety::GuardOptions& guard) {
  return {.mode = text_of("mode", guard), .road = text_of("road", guard), .version = safety::kGuardVersion};
}

}  // namespace chicane::protocol
