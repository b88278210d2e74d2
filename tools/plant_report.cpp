// SPDX-License-Identifier: MIT
// Measures the plants as a proving ground would and prints the tables of docs/plants.md.
//
//   chicane_plant_report                 all tables
//   chicane_plant_report csv DIRECTORY   the curves behind the figures, one CSV file each
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "chicane/base/angle.hpp"
#include "chicane/sim/plant_factory.hpp"
#include "sim/plant_experiment.hpp"

namespace {

using chicane::mph_to_mps;
using chicane::mps_to_mph;
using chicane::sim::make_plant;
using chicane::sim::Plant;
namespace experiment = chicane::sim::experiment;

void print_longitudinal(Plant& plant) {
  plant.reset({}, 0.0);
  const auto run = experiment::drive_straight(plant, 1.0, 90.0);
  std::vector<std::pair<double, double>> points;
  for (const auto& point : experiment::accelerations(run, 1.2)) {
    if (point.first >= 5.0 && point.first <= 45.0) points.push_back(point);
  }
  const experiment::Line law = experiment::fit_line(points);
  std::printf("  full throttle 5..45 m/s: a = %.3f %+.4f v m/s^2, rms %.4f\n", law.offset, law.slope,
              law.rms);
  for (const double v : {5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0}) {
    double best = 1e9, a = 0.0;
    for (const auto& point : experiment::accelerations(run, 1.2)) {
      if (std::fabs(point.first - v) < best) {
        best = std::fabs(point.first - v);
        a = point.second + 0.104 * (point.first - v);
      }
    }
    std::printf("    %4.0f m/s: a = %6.3f  (5.43 - 0.104 v = %6.3f)\n", v, a, 5.43 - 0.104 * v);
  }
  std::printf("  top speed %.2f m/s = %.1f mph\n", run.back().speed, mps_to_mph(run.back().speed));
  std::printf("  0-60 mph %.2f s, 0-100 mph %.2f s, 0-100 km/h %.2f s\n",
              experiment::time_to(run, mph_to_mps(60)), experiment::time_to(run, mph_to_mps(100)),
              experiment::time_to(run, 100 / 3.6));
  plant.reset({}, 40.0);
  const auto coast = experiment::accelerations(experiment::drive_straight(plant, 0.0, 25.0), 0.0);
  const experiment::Line drag = experiment::fit_line(coast);
  std::printf("  coasting 40..%.0f m/s: a = %.4f %+.4f v, rms %.4f\n", coast.back().first, drag.offset,
              drag.slope, drag.rms);
}

void print_braking(Plant& plant) {
  std::printf("  throttle      decel at 10     15     21   25.5   30.6     40 m/s\n");
  for (const double throttle :
       {-0.01, -0.02, -0.03, -0.04, -0.045, -0.05, -0.055, -0.06, -0.07, -0.1, -0.5, -1.0}) {
    std::printf("  %8.3f     ", throttle);
    for (const double v : {10.0, 15.0, 21.0, 25.5, 30.6, 40.0}) {
      std::printf(" %6.2f", experiment::braking_at(plant, throttle, v));
    }
    std::printf("\n");
  }
}

void print_lateral(Plant& plant) {
  std::printf("  v m/s   steer rad   curvature/steer 1/m   yaw gain 1/s     ay   sideslip rad   radius m\n");
  for (const double v : {1.5, 6.0, 10.0, 20.0, 30.0, 45.0}) {
    for (const double steer : {0.01, 0.05, 0.4363323}) {
      if (steer > 0.4 && v > 1.6) continue;
      const experiment::Circle c = experiment::steady_circle(plant, steer, v);
      std::printf("  %5.1f   %9.3f   %19.4f   %12.3f   %6.2f   %12.4f   %8.2f\n", v, steer,
                  c.curvature / steer, c.yaw_rate / steer, c.lateral_acceleration, c.sideslip, c.path_radius);
    }
  }
  std::printf("  yaw modes 1/s\n");
  for (const double v : {5.0, 10.0, 20.0, 30.0, 45.0}) {
    const auto [a, b] = experiment::yaw_modes(plant, v);
    const auto [half, most] = experiment::yaw_rise(plant, v, 0.01);
    std::printf("  %5.1f m/s: %.2f%+.2fi, %.2f%+.2fi; step response 50 %% after %.2f s, 90 %% after %.2f s\n",
                v, a.real(), a.imag(), b.real(), b.imag(), half, most);
  }
}

void print_cost(Plant& plant) {
  plant.reset({}, 20.0);
  const int count = 200000;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < count; ++i) plant.advance({.steer = 0.02 * std::sin(i * 0.001), .throttle = 0.4});
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  std::printf("  cost: %.2f us for a step of %.0f ms\n", 1e6 * time.count() / count,
              1e3 * plant.step_length());
}

}  // namespace

int main() {
  for (const char* name : {"udacity", "road-car"}) {
    const std::unique_ptr<Plant> plant = make_plant(name).value();
    std::printf("%s\n", name);
    print_longitudinal(*plant);
    print_braking(*plant);
    print_lateral(*plant);
    print_cost(*plant);
  }
}
