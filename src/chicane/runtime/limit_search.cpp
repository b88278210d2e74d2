// SPDX-License-Identifier: MIT
#include "chicane/runtime/limit_search.hpp"

#include <sys/resource.h>

#include <utility>

namespace chicane::runtime {

model::VehicleParams limit_vehicle(const scenario::Scenario& scenario) {
  model::VehicleParams car = scenario.vehicle;
  const double grip = scenario.plant_options.friction_scale;
  const double mass = scenario.plant_options.mass_scale;
  car.friction *= grip;
  car.cornering_front *= grip;
  car.cornering_rear *= grip;
  // Forces over mass; the yaw inertia deviates with the mass.
  car.mass *= mass;
  car.yaw_inertia *= mass;
  car.drive_acceleration /= mass;
  car.drive_power_per_mass /= mass;
  car.brake_acceleration /= mass;
  car.drag_quadratic /= mass;
  return car;
}

LimitSearch::LimitSearch(path::Track track, const scenario::Scenario& scenario,
                         std::function<void(Result<std::shared_ptr<const lap_time::Limit>>)> on_end)
    : thread_{[this, track = std::move(track), car = limit_vehicle(scenario), on_end = std::move(on_end)] {
        constexpr int kLowestPriority = 19;
        static_cast<void>(setpriority(PRIO_PROCESS, 0, kLowestPriority));  // of this thread, on Linux
        lap_time::LimitOptions options;
        options.go_on = [this](int, double) { return is_wanted_.load(); };
        Result<lap_time::Limit> limit = lap_time::find_limit(track, car, options);
        if (!is_wanted_) return;
        if (!limit) return on_end(fail(limit.error()));
        on_end(std::make_shared<const lap_time::Limit>(std::move(*limit)));
      }} {}

LimitSearch::~LimitSearch() {
  is_wanted_ = false;
  thread_.join();
}

}  // namespace chicane::runtime
