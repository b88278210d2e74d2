// SPDX-License-Identifier: MIT
#include "chicane/live/limit_search.hpp"

#include <sys/resource.h>

#include <utility>

#include "chicane/model/grip.hpp"

namespace chicane::live {

model::VehicleParams limit_vehicle(const scenario::Scenario& scenario) {
  model::VehicleParams car = model::with_grip(scenario.vehicle, scenario.plant_options.friction_scale);
  const double mass = scenario.plant_options.mass_scale;
  // Forces over mass; the yaw inertia deviates with the mass.
  car.mass *= mass;
  car.yaw_inertia *= mass;
  car.drive_acceleration /= mass;
  car.drive_power_per_mass /= mass;
  car.brake_acceleration /= mass;
  car.drag_quadratic /= mass;
  return car;
}

LimitSearch::LimitSearch(path::Track track, const scenario::Scenario& scenario, OnEnd on_end)
    : on_end_{std::move(on_end)}, thread_{[this, track = std::move(track), car = limit_vehicle(scenario)] {
        work(track, car);
      }} {}

LimitSearch::~LimitSearch() {
  cancel();
  thread_.join();
}

void LimitSearch::cancel() {
  const std::lock_guard lock(telling_);
  is_wanted_ = false;
}

void LimitSearch::work(const path::Track& track, const model::VehicleParams& car) {
  // Behind everything else, yet not starved: on cores that others keep busy, a tenth of one thread's share.
  constexpr int kLowPriority = 10;
  static_cast<void>(setpriority(PRIO_PROCESS, 0, kLowPriority));  // of this thread, on Linux
  lap_time::LimitOptions options;
  options.go_on = [this](int, double) { return is_wanted_.load(); };
  Result<lap_time::Limit> limit = lap_time::find_limit(track, car, options);
  {
    const std::lock_guard lock(telling_);
    if (is_wanted_ && !limit) on_end_(fail(limit.error()));
    if (is_wanted_ && limit) on_end_(std::make_shared<const lap_time::Limit>(std::move(*limit)));
  }
  has_ended_.store(true, std::memory_order_release);
}

}  // namespace chicane::live
