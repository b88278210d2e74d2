// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/controller/baselines.hpp"
#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/controller/tracking_mpc.hpp"
#include "support/chicane_test.hpp"
#include "support/guarded.hpp"

namespace chicane::controller {

/// The handlings of latency, both steering signs and both ways to the car's frame, in all combinations.
inline std::vector<CubicMpcOptions> cubic_variants() {
  std::vector<CubicMpcOptions> variants;
  for (const auto handling :
       {LatencyHandling::kNone, LatencyHandling::kRollForward, LatencyHandling::kMeasured,
        LatencyHandling::kPositionOnly, LatencyHandling::kInsideModel}) {
    for (const bool sign : {false, true}) {
      for (const bool polar : {false, true}) {
        CubicMpcOptions& options = variants.emplace_back();
        options.latency_handling = handling;
        options.steering_right_positive = sign;
        options.polar_waypoints = polar;
        options.weight_speed_steer = 0.5;
      }
    }
  }
  return variants;
}

using Controllers = std::vector<std::unique_ptr<test::Guarded>>;
inline void add(Result<std::unique_ptr<Controller>> made, Controllers& to) {
  to.push_back(std::make_unique<test::Guarded>(*test::good(std::move(made)), model::VehicleParams{}));
}

/// The controllers that plan nothing, for a car with default values.
inline Controllers all_baselines() {
  Controllers all;
  add(make_pid({}, {}), all);
  add(make_pure_pursuit({}, {}), all);
  add(make_stanley({}, {}), all);
  return all;
}

/// All of them, and all variants of the cubic one.
inline Controllers all_controllers() {
  Controllers all = all_baselines();
  add(make_tracking_mpc({}, {}), all);
  for (const CubicMpcOptions& options : cubic_variants()) add(make_cubic_mpc(options, {}), all);
  return all;
}

}  // namespace chicane::controller
