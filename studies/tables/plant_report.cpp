// SPDX-License-Identifier: MIT
// Measures the plants as a proving ground would.
//
//   chicane_plant_report                 the tables of docs/plants*.md
//   chicane_plant_report csv DIRECTORY   the curves of its figures (studies/tables/plot_plants.py draws them)
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "chicane/base/math.hpp"
#include "chicane/road/track.hpp"
#include "chicane/sim/double_track.hpp"
#include "chicane/sim/plant_registry.hpp"
#include "chicane/sim/udacity_car.hpp"
#include "chicane/sim/world.hpp"
#include "sim/plant_experiment.hpp"

namespace {

using namespace chicane;
namespace experiment = sim::experiment;
using sim::Plant;

constexpr double kBrakingSpeeds[] = {10.0, 15.0, 21.0, 25.5, 30.6, 40.0};

void print_longitudinal(Plant& plant) {
  plant.reset({}, 0.0);
  const auto run = experiment::drive_straight(plant, 1.0, 90.0);
  std::vector<std::pair<double, double>> points;
  double farthest = 0.0;
  for (const auto& [v, a] : experiment::accelerations(run, 1.2)) {
    if (v < 5.0 || v > 45.0) continue;
    points.emplace_back(v, a);
    farthest = std::max(farthest, std::fabs(a - (5.43 - 0.104 * v)));
  }
  const experiment::Line law = experiment::fit_line(points);
  std::printf("full throttle, 5 to 45 m/s: a = %.3f %+.4f v m/s2, rms %.4f\n", law.offset, law.slope,
              law.rms);
  std::printf("  farthest from 5.43 - 0.104 v: %.3f m/s2\n", farthest);
  std::printf("top speed: %.2f m/s = %.1f mph\n", run.back().speed, mps_to_mph(run.back().speed));
  std::printf("0-60 mph %.2f s, 0-100 km/h %.2f s, 0-100 mph %.2f s\n",
              experiment::time_to(run, mph_to_mps(60)), experiment::time_to(run, 100.0 / 3.6),
              experiment::time_to(run, mph_to_mps(100)));
  plant.reset({}, 40.0);
  const auto coast = experiment::accelerations(experiment::drive_straight(plant, 0.0, 25.0), 0.0);
  const experiment::Line drag = experiment::fit_line(coast);
  std::printf("coasting, 40 to %.0f m/s: a = %.4f %+.4f v\n", coast.back().first, drag.offset, drag.slope);
}

void print_braking(Plant& plant) {
  std::printf("braking, m/s2 at\n  throttle");
  for (const double v : kBrakingSpeeds) std::printf(" %6.1f", v);
  std::printf(" m/s\n");
  for (const double throttle : {-0.01, -0.02, -0.04, -0.05, -0.06, -0.07, -0.1, -0.5, -1.0}) {
    std::printf("  %8.2f", throttle);
    for (const double v : kBrakingSpeeds) std::printf(" %6.2f", experiment::braking_at(plant, throttle, v));
    std::printf("\n");
  }
}

void print_lock_threshold(Plant& plant) {
  std::printf("throttle at which the first wheel locks:");
  for (const double v : {10.0, 20.0, 30.0, 45.0}) {
    double rolls = -0.02;
    double locks = -0.15;
    while (rolls - locks > 1e-4) {
      const double middle = 0.5 * (rolls + locks);
      plant.reset({}, v);
      for (double time = 0.0; time < 0.3; time += plant.step_length()) plant.advance({.throttle = middle});
      const auto& slips = plant.output().slip_ratio;
      (*std::min_element(slips.begin(), slips.end()) < -0.5 ? locks : rolls) = middle;
    }
    std::printf("  %.4f at %.0f m/s", locks, v);
  }
  std::printf("\n");
}

void print_lateral(Plant& plant) {
  std::printf(
      "steady turns\n   v m/s   steer rad   curvature/steer 1/m   yaw gain 1/s   ay m/s2   sideslip rad   "
      "radius m\n");
  for (const double v : {1.5, 6.0, 10.0, 20.0, 30.0, 45.0}) {
    for (const double steer : {0.01, 0.05, 0.4363323}) {
      if (steer > 0.4 && v > 1.6) continue;
      const experiment::Circle c = experiment::steady_circle(plant, steer, v);
      std::printf("  %6.1f   %9.3f   %19.4f   %12.3f   %7.2f   %12.4f   %8.2f\n", v, steer,
                  c.curvature / steer, c.yaw_rate / steer, c.lateral_acceleration, c.sideslip, c.path_radius);
    }
  }
  std::printf(
      "yaw modes and response to a small step of the wheel\n   v m/s   modes 1/s                        50 "
      "%% s   90 %% s\n");
  for (const double v : {10.0, 20.0, 30.0, 45.0}) {
    const auto [a, b] = experiment::yaw_modes(plant, v);
    const auto [half, most] = experiment::yaw_rise(plant, v, 0.01);
    std::printf("  %6.1f   %7.2f %+6.2fi   %7.2f %+6.2fi   %6.2f   %6.2f\n", v, a.real(), a.imag(), b.real(),
                b.imag(), half, most);
  }
  std::printf("largest lateral acceleration, m/s2:");
  for (const double v : {10.0, 20.0, 30.0, 40.0}) {
    const experiment::Peak peak = experiment::peak_cornering(plant, v);
    std::printf("  %.1f at %.0f m/s (steer %.2f rad)", peak.lateral_acceleration, v, peak.steer);
  }
  std::printf("\n");
}

void print_model_mismatch(Plant& plant, const model::VehicleParams& params, double gentle, double hard) {
  std::printf("assumed single track against the plant: rms error of yaw rate, of lateral velocity\n");
  for (const double v : {10.0, 20.0, 30.0, 45.0}) {
    const experiment::Mismatch low = experiment::compare(plant, params, v, gentle);
    const experiment::Mismatch high = experiment::compare(plant, params, v, hard);
    std::printf("  %4.0f m/s: %4.1f %%, %5.1f %% up to %.0f m/s2;  %4.1f %%, %5.1f %% up to %.1f m/s2\n", v,
                100.0 * low.yaw_rate, 100.0 * low.lateral_velocity, gentle, 100.0 * high.yaw_rate,
                100.0 * high.lateral_velocity, hard);
  }
}

void print_identified(Plant& plant, model::VehicleParams params) {
  const experiment::Identified found = experiment::identify_single_track(plant, params);
  params.cornering_front = found.cornering_front;
  params.cornering_rear = found.cornering_rear;
  std::printf("identified from a log of this plant: C_f %.2f, C_r %.2f; modes of that model:",
              found.cornering_front, found.cornering_rear);
  for (const double v : {10.0, 20.0, 30.0, 45.0}) {
    const auto [a, b] = experiment::linear_modes(params, v);
    std::printf("  %.1f %.1f at %.0f m/s", a.real(), b.real(), v);
  }
  std::printf("\n");
}

template <class Step>
double microseconds(int count, Step&& step) {
  double best = 1e9;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < count; ++i) step(i);
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
    best = std::min(best, time.count() / count);
  }
  return best;
}

void print_cost(Plant& plant) {
  std::vector<road::TrackPoint> points;
  for (int i = 0; i < 200; ++i) {
    const double angle = kTwoPi * i / 200;
    points.push_back({Vec2{200.0 * std::cos(angle), 200.0 * std::sin(angle)}, 5.0, 5.0});
  }
  const road::Track track = road::Track::create("circle", points, true).value();
  plant.reset({}, 20.0);
  const auto command = [](int i) {
    return model::Command{.steer = 0.02 * std::sin(i * 0.001), .throttle = 0.4};
  };
  const double alone = microseconds(20000, [&](int i) { plant.advance(command(i)); });
  sim::World world{plant, track};
  world.place(0.0, 0.0, 20.0);
  const double judged = microseconds(20000, [&](int) {
    world.advance(
        {.steer = 2.75 / 200.0 - 0.02 * world.state().lateral_error - 0.3 * world.state().heading_error,
         .throttle = 0.3});
  });
  std::printf(
      "cost: %.2f us for a step of %.0f ms alone, %.2f us with the world's judgement: %.0f x real time\n",
      alone, 1e3 * plant.step_length(), judged, 1e6 * plant.step_length() / judged);
}

void print_tables() {
  for (const model::VehicleParams& assumed : {model::udacity_params(), model::road_car_params()}) {
    const std::unique_ptr<Plant> plant = sim::make_plant(assumed.name).value();
    const bool is_udacity = assumed.steer_helper > 0.0;
    std::printf("== %s\n", assumed.name.c_str());
    print_longitudinal(*plant);
    print_braking(*plant);
    if (is_udacity) print_lock_threshold(*plant);
    print_lateral(*plant);
    print_model_mismatch(*plant, assumed, is_udacity ? 5.0 : 3.0, is_udacity ? 20.0 : 8.5);
    if (is_udacity) print_identified(*plant, assumed);
    print_cost(*plant);
    std::printf("\n");
  }
}

void write_longitudinal(Plant& plant, const std::string& path) {
  std::ofstream file(path);
  file << "phase,speed_mps,acceleration_mps2\n";
  plant.reset({}, 0.0);
  for (const auto& [v, a] : experiment::accelerations(experiment::drive_straight(plant, 1.0, 60.0), 1.2)) {
    file << "drive," << v << ',' << a << '\n';
  }
  plant.reset({}, 50.0);
  for (const auto& [v, a] : experiment::accelerations(experiment::drive_straight(plant, -1.0, 8.0), 0.3)) {
    if (v > 3.0) file << "brake," << v << ',' << a << '\n';
  }
}

void write_yaw_steps(Plant& plant, const std::string& path) {
  std::ofstream file(path);
  file << "speed_mps,time_s,yaw_gain_per_s\n";
  for (const double v : {10.0, 20.0, 30.0, 45.0}) {
    plant.reset({}, v);
    experiment::SpeedHold hold{v};
    const double dt = plant.step_length();
    const int stride = std::max(1, static_cast<int>(0.01 / dt + 0.5));
    for (int i = static_cast<int>(-3.0 / dt); i <= static_cast<int>(2.5 / dt); ++i) {
      plant.advance({.steer = i >= 0 ? 0.01 : 0.0, .throttle = hold.throttle(plant)});
      if (i >= -1 && (i + 1) % stride == 0)
        file << v << ',' << (i + 1) * dt << ',' << plant.state().r / 0.01 << '\n';
    }
  }
}

void write_modes(Plant& plant, const std::string& path) {
  std::ofstream file(path);
  file << "speed_mps,mode_1_per_s,mode_2_per_s\n";
  for (double v = 8.0; v <= 46.0; v += 2.0) {
    const auto [a, b] = experiment::yaw_modes(plant, v);
    file << v << ',' << a.real() << ',' << b.real() << '\n';
  }
}

void write_tires(const std::string& path) {
  std::ofstream file(path);
  file << "slip,physx_forward,physx_sideways,road_front,road_rear\n";
  const sim::UdacityCarParams udacity;
  const sim::DoubleTrackParams road;
  const model::MagicFormula front{
      .stiffness = road.stiffness_front, .shape = road.shape, .peak = road.friction};
  const model::MagicFormula rear{
      .stiffness = road.stiffness_rear, .shape = road.shape, .peak = road.friction};
  for (double slip = 0.0; slip <= 1.0; slip += 0.005) {
    file << slip << ',' << udacity.forward(slip) << ',' << udacity.sideways(slip) << ',' << front(slip) << ','
         << rear(slip) << '\n';
  }
}

/// Largest acceleration in each direction at 25 m/s: the pedal from full brake to full drive, the wheel
/// turning in slowly.
void write_envelope(Plant& plant, const std::string& path) {
  std::ofstream file(path);
  file << "throttle,ax_mps2,ay_mps2\n";
  for (double throttle = -1.0; throttle <= 1.001; throttle += 0.1) {
    double best_ax = 0.0;
    double best_ay = 0.0;
    plant.reset({}, 27.0);
    double ax = 0.0;
    double ay = 0.0;
    for (double time = 0.0; time < 2.0; time += plant.step_length()) {
      plant.advance({.steer = 0.12 * time, .throttle = throttle});
      const double share = plant.step_length() / 0.05;
      ax += share * (plant.output().ax - ax);
      ay += share * (plant.output().ay - ay);
      if (time > 0.3 && ay > best_ay) {
        best_ay = ay;
        best_ax = ax;
      }
    }
    file << throttle << ',' << best_ax << ',' << best_ay << '\n';
  }
}

void write_curves(const std::string& directory) {
  const auto udacity = sim::make_plant("udacity").value();
  const auto road = sim::make_plant("road-car").value();
  write_longitudinal(*udacity, directory + "/udacity_longitudinal.csv");
  write_longitudinal(*road, directory + "/road_car_longitudinal.csv");
  write_yaw_steps(*udacity, directory + "/udacity_yaw_steps.csv");
  write_yaw_steps(*road, directory + "/road_car_yaw_steps.csv");
  write_modes(*udacity, directory + "/udacity_modes.csv");
  write_tires(directory + "/tires.csv");
  write_envelope(*road, directory + "/road_car_envelope.csv");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "csv") {
    write_curves(argv[2]);
    return 0;
  }
  if (argc != 1) {
    std::fprintf(stderr, "usage: chicane_plant_report [csv DIRECTORY]\n");
    return 2;
  }
  print_tables();
  return 0;
}
