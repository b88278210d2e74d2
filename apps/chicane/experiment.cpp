// SPDX-License-Identifier: MIT
// Experiment of a command line: its scenario, road, run and limit; the limit as text, JSON and CSV.
#include "experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/plan_cache.hpp"
#include "chicane/run/roads.hpp"
#include "option_row.hpp"
#include "program.hpp"

namespace chicane::apps {

protocol::Request request_of(const Options& options) {
  return {options.scenario_file, options.settings, options.speed_mps, options.faults, options.speed_mph};
}

Result<scenario::Scenario> experiment(const Options& options) {
  return protocol::compose(request_of(options));
}

bool has_setting(const Options& options, std::string_view key) {
  return std::any_of(options.settings.begin(), options.settings.end(),
                     [&](const auto& setting) { return setting.first == key; });
}

Result<std::optional<road::Track>> given_track(const Options& options, const scenario::Scenario& scenario) {
  if (!has_setting(options, "track")) return std::optional<road::Track>{};
  Result<road::Track> track = run::make_track(scenario);
  if (!track) return fail(track.error());
  return std::optional<road::Track>{std::move(*track)};
}

Result<std::unique_ptr<run::ClosedLoop>> prepared(const protocol::Request& request) {
  const Result<scenario::Scenario> scenario = protocol::compose(request);
  if (!scenario) return fail(scenario.error());
  return run::ClosedLoop::create(*scenario);
}

Result<std::unique_ptr<run::ClosedLoop>> prepared(const scenario::Scenario& scenario,
                                                  const run::PlanHooks& hooks) {
  run::Roads roads;
  if (auto road = roads.of(scenario, run::make_track, hooks); !road) return fail(road.error());
  return run::ClosedLoop::create(scenario, roads);  // `roads` has the road already
}

std::string guard_notice(const safety::GuardOptions& guard) {
  switch (guard.mode) {
    case safety::GuardMode::kOff:
      return "guard.mode=off: only range and rate of commands are limited; nothing stops the car on the road "
             "when sensors, link or controller fail (docs/safety.md)";
    case safety::GuardMode::kObserve:
      return "guard.mode=observe: the guard only reports; nothing stops the car on the road when sensors or "
             "controller fail (docs/safety.md)";
    case safety::GuardMode::kOn:
      break;
  }
  if (guard.blind_time > 0.0) return "";
  return "guard.blind_time_s=0: a car that gets no commands may leave the road; `chicane campaign` measures "
         "how often (docs/safety.md)";
}

void print_guard_notice(const Options& options, const safety::GuardOptions& guard) {
  const std::string notice = guard_notice(guard);
  if (!options.is_json && !notice.empty()) print_sentence(stderr, notice);
}

void print_notices(const scenario::Scenario& scenario) {
  for (const std::string& notice : scenario.notices) print_sentence(stderr, notice);
}

namespace {

/// Slowest and fastest speed on a line [m/s].
struct SpeedRange {
  double least = 0.0, top = 0.0;
};

SpeedRange speeds_of(const road::RacingLine& line) {
  SpeedRange speeds{line.points.front().vx, line.points.front().vx};
  for (const road::RacingLinePoint& p : line.points) {
    speeds.least = std::min(speeds.least, std::hypot(p.vx, p.vy));
    speeds.top = std::max(speeds.top, std::hypot(p.vx, p.vy));
  }
  return speeds;
}

}  // namespace

Result<lap_time::PlantLimit> limit_of(const scenario::Scenario& scenario, const road::Track& track,
                                      const LimitQuestion& question, const std::atomic<bool>& wants_stop,
                                      double& wall_time) {
  StatusLine line;
  lap_time::PlantLimitOptions options{.wants_witness = question.wants_witness, .budget = question.budget};
  lap_time::PlanProgress progress;
  options.on_progress = [&](const lap_time::PlanProgress& now) { progress = now; };
  options.go_on = [&](std::string_view stage, int iteration, double lap_time) {
    if (line.is_due()) {
      const bool is_unknown = progress.work <= 0.0 || progress.work >= progress.expected;
      const double left_share = progress.expected / progress.work - 1.0;  // work left over the work so far
      const std::string left =
          is_unknown ? "" : fmt::format(", about {:.0f} s left", line.seconds() * left_share);
      line.show(fmt::format("limit: {}, iteration {}, {:.3f} s{}", stage, iteration, lap_time, left));
    }
    return !wants_stop.load();
  };
  Result<lap_time::PlantLimit> limit = run::limit_of(scenario, track, options);
  wall_time = line.seconds();
  line.clear();
  return limit;
}

std::string to_table(const LimitRun& run, const lap_time::PlantLimit& limit) {
  const SpeedRange speeds = speeds_of(limit.line);
  if (limit.line.is_best_so_far)
    return fmt::format(
        "{} on {}: {:.3f} s is the best lap so far, no bound: {}\n"
        "speed    {:.1f} mph at least, {:.1f} at most\n"
        "searched {:.1f} s: {} nodes, {} iterations; stationarity {:.1e}, violation {:.1e}\n",
        run.car, run.track, limit.bound.lap,
        limit.is_cut_short ? "the budget ended the search (--budget-s)" : lap_time::kNoOptimum,
        mps_to_mph(speeds.least), mps_to_mph(speeds.top), run.wall_time, limit.nodes, limit.effort.iterations,
        limit.stationarity, limit.violation);
  std::string text = fmt::format("{} on {}: between {:.3f} s and ", run.car, run.track, limit.bound.lap);
  text += limit.witness
              ? fmt::format("{:.3f} s ({:+.2f} %)\n", limit.witness->lap_time, 100.0 * limit.bracket())
          : limit.is_cut_short ? "what could be driven: the budget ended the search for that (--budget-s)\n"
                               : "what could be driven: no plan could\n";
  text +=
      fmt::format("bound    {:.3f} s ({:.3f} {:.3f} {:.3f} by thirds), the plant's optimum\n",
                  limit.bound.lap, limit.bound.sectors[0], limit.bound.sectors[1], limit.bound.sectors[2]);
  if (limit.witness)
    text += fmt::format("witness  {:.3f} s, best of {} laps (slowest {:.3f} s), {:.3f} m from the edge\n",
                        limit.witness->lap_time, limit.witness->laps, limit.witness->worst,
                        limit.witness->least_edge);
  text += fmt::format("speed    {:.1f} mph at least, {:.1f} at most\n", mps_to_mph(speeds.least),
                      mps_to_mph(speeds.top));
  text +=
      fmt::format("found in {:.1f} s: {} nodes, {} iterations; stationarity {:.0e}, violation {:.0e}\n",
                  run.wall_time, limit.nodes, limit.effort.iterations, limit.stationarity, limit.violation);
  return text;
}

std::string to_json(const LimitRun& run, const lap_time::PlantLimit& limit) {
  using protocol::Json;
  const SpeedRange speeds = speeds_of(limit.line);
  Json witness;
  if (limit.witness)
    witness = Json{{"lap_time_s", limit.witness->lap_time},
                   {"slowest_lap_s", limit.witness->worst},
                   {"laps", limit.witness->laps},
                   {"least_edge_distance_m", limit.witness->least_edge},
                   {"planned_lap_s", limit.witness->line.lap_time()},
                   {"planned_margin_m", limit.witness->line.margin}};
  const Json json{{"track", run.track},
                  {"car", run.car},
                  {"plant", limit.line.car},
                  {"lap_time_s", limit.bound.lap},
                  {"is_best_so_far", limit.line.is_best_so_far},
                  {"sector_times_s", limit.bound.sectors},
                  {"witness", witness},
                  {"bracket_percent", limit.witness ? Json(100.0 * limit.bracket()) : Json()},
                  {"least_speed_mps", speeds.least},
                  {"top_speed_mps", speeds.top},
                  {"nodes", limit.nodes},
                  {"iterations", limit.effort.iterations},
                  {"work_s", limit.effort.work},
                  {"stationarity", limit.stationarity},
                  {"violation", limit.violation},
                  {"wall_time_s", run.wall_time}};
  return protocol::json_text(json, protocol::JsonLayout::kIndented) + "\n";
}

std::string to_csv(const LimitRun& run, const road::Track& track, const lap_time::PlantLimit& limit) {
  const road::RacingLine& line = limit.witness ? limit.witness->line : limit.line;
  std::string text = fmt::format(
      "# A lap of {} on {} in {:.4f} s, planned for the plant {} with {:g} m to spare (chicane limit, "
      "docs/limit.md)\n"
      "# start_s_m=0, kerb_width_m={:g}, smoothing_sigma_m=0.02, closed=true\n"
      "# x_m,y_m,w_tr_right_m,w_tr_left_m,s_m,n_m,time_s,heading_rad,vx_mps,vy_mps,yaw_rate_radps,steer_rad,"
      "steer_asked_rad,ax_mps2,throttle\n",
      run.car, run.track, line.lap_time(), line.car, line.margin, track.kerb_width());
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {  // the last repeats the first
    const road::RacingLinePoint& p = line.points[i];
    const road::PathPoint foot = track.centre().at(p.s);
    const Vec2 place =
        foot.position + p.offset * Vec2{-chicane::sin(foot.heading), chicane::cos(foot.heading)};
    text += fmt::format(
        "{:.4f},{:.4f},{:.4f},{:.4f},{:.3f},{:.4f},{:.4f},{:.5f},{:.4f},{:.4f},{:.5f},{:.5f},{:.5f},{:.4f},{:"
        ".4f}\n",
        place.x(), place.y(), track.right_width(p.s) + p.offset, track.left_width(p.s) - p.offset, p.s,
        p.offset, p.time, p.heading, p.vx, p.vy, p.yaw_rate, p.steer, p.steer_command, p.acceleration,
        p.throttle);
  }
  return text;
}

}  // namespace chicane::apps
