// SPDX-License-Identifier: MIT
// Laps without one cause of lost time each: latency, sensor errors, margins, guard.
#include "chicane/run/laps_without.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "chicane/run/closed_loop.hpp"
#include "chicane/run/parallel.hpp"

namespace chicane::run {
namespace {

using scenario::Scenario;

controller::TrackingMpcOptions* tracking_options(Scenario& scenario) {
  using Entry = controller::TrackingMpcEntry;
  if (scenario.controller != Entry::kName) return nullptr;
  return &std::get<Entry::Options>(scenario.controllers);
}

// Each function removes one cause, and returns whether the scenario had it.

bool drop_latency(Scenario& scenario) {
  const bool has = scenario.latency > 0.0 || scenario.latency_jitter > 0.0;
  scenario.latency = scenario.latency_jitter = 0.0;
  return has;
}

bool drop_sensor_errors(Scenario& scenario) {
  const bool has = !(scenario.sensor == sim::SensorOptions{});
  scenario.sensor = {};
  return has;
}

bool drop_edge_margin(Scenario& scenario) {
  controller::TrackingMpcOptions* options = tracking_options(scenario);
  if (options == nullptr || !scenario.races()) return false;
  // The guard's own margin would stop the car: let it observe only.
  if (scenario.guard.mode == safety::GuardMode::kOn) scenario.guard.mode = safety::GuardMode::kObserve;
  return std::exchange(options->edge_margin, 0.0) > 0.0;
}

bool drop_grip_reserve(Scenario& scenario) {
  controller::TrackingMpcOptions* options = tracking_options(scenario);
  if (options == nullptr) return false;
  const double grip = std::exchange(options->grip_share, 1.0);
  const double brake = std::exchange(options->brake_share, 1.0);
  return grip < 1.0 || brake < 1.0;
}

bool drop_guard(Scenario& scenario) {
  return std::exchange(scenario.guard.mode, safety::GuardMode::kOff) != safety::GuardMode::kOff;
}

struct Cause {
  const char* name;
  bool (*drop)(Scenario&);
};
constexpr Cause kCauses[] = {{"latency", drop_latency},
                             {"sensor", drop_sensor_errors},
                             {"edge margin", drop_edge_margin},
                             {"grip reserve", drop_grip_reserve},
                             {"guard", drop_guard}};

lap_time::LapWithout best_of(const char* cause, const telemetry::RunSummary& run) {
  lap_time::LapWithout without{.cause = cause, .off_track_events = run.off_track_events};
  const auto best = std::min_element(run.laps.begin(), run.laps.end(),
                                     [](const auto& a, const auto& b) { return a.lap_time < b.lap_time; });
  if (best == run.laps.end()) return without;
  without.lap_time = best->lap_time;
  without.corners = best->corner_times;
  return without;
}

}  // namespace

Result<std::vector<lap_time::LapWithout>> laps_without(const Scenario& scenario,
                                                       const std::function<bool()>& go_on) {
  struct Variant {
    const char* cause;
    Scenario scenario;
    std::optional<Result<lap_time::LapWithout>> driven{};
  };
  std::vector<Variant> variants;
  for (const Cause& cause : kCauses) {
    Scenario changed = scenario;
    if (cause.drop(changed)) variants.push_back({cause.name, std::move(changed)});
  }
  for_each_run(variants.size(), threads_for(0), [&](std::uint64_t i, Roads& roads) {
    Variant& variant = variants[i];
    const auto stop = [&] { return go_on && !go_on(); };
    if (stop()) return false;
    const auto loop = ClosedLoop::create(variant.scenario, roads);
    if (!loop) {
      variant.driven = fail(loop.error());
      return false;
    }
    const telemetry::RunSummary run = run_closed_loop(**loop, {}, stop);
    if (!stop()) variant.driven = best_of(variant.cause, run);
    return true;
  });
  std::vector<lap_time::LapWithout> laps;
  for (Variant& variant : variants) {
    if (!variant.driven) continue;
    if (!*variant.driven) return fail(variant.driven->error());
    laps.push_back(std::move(**variant.driven));
  }
  return laps;
}

}  // namespace chicane::run
