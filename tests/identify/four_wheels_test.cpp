// SPDX-License-Identifier: MIT
#include "chicane/identify/detail/four_wheels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "chicane/base/math.hpp"
#include "chicane/sim/double_track.hpp"

namespace chicane::identify {
namespace {

struct Worst {
  double r = 0.0, vy = 0.0, vx = 0.0, most_r = 0.0;
};

Worst compare(const sim::DoubleTrackParams& p, double speed, double swing, double period, double throttle, bool print) {
  constexpr double kStep = 0.01;
  sim::DoubleTrack plant(p);
  model::VehicleParams vehicle = sim::model_of(p, model::road_car_params());
  const FourWheels wheels(vehicle, wheels_of(p), kStep);
  plant.reset({}, speed);
  FourWheels::Motion motion = wheels.steady(speed, 0.0, 0.0, 0.0, 0.0);
  Worst worst;
  double pedal = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double t = kStep * i;
    const double before = plant.state().steer;
    const double asked = swing * sin(2.0 * kPi * t / period);
    for (int k = 0; k < 10; ++k) plant.advance({asked, throttle});
    const double next = throttle + (pedal - throttle) * exp(-kStep / p.drive_lag);
    const double drag = -model::longitudinal_acceleration(vehicle, 0.0, motion.vx);
    wheels.advance(motion, before, 0.5 * (before + plant.state().steer),
                   model::longitudinal_acceleration(vehicle, 0.5 * (pedal + next), motion.vx) + drag, drag);
    pedal = next;
    const model::State& s = plant.state();
    worst.r = std::max(worst.r, std::fabs(s.r - motion.r));
    worst.vy = std::max(worst.vy, std::fabs(s.vy - motion.vy));
    worst.vx = std::max(worst.vx, std::fabs(s.vx - motion.vx));
    worst.most_r = std::max(worst.most_r, std::fabs(s.r));
    if (print && i % 10 == 9)
      std::printf("%.2f r %.4f %.4f  vy %.4f %.4f  vx %.4f %.4f\n", t, s.r, motion.r, s.vy, motion.vy, s.vx, motion.vx);
  }
  return worst;
}

TEST(FourWheels, MovesAsThePlant) {
  for (const double throttle : {0.1, 0.6, -0.4})
    for (const double swing : {0.02, 0.1}) {
      for (int what = 0; what < 4; ++what) {
        sim::DoubleTrackParams p;
        if (what == 1) p.wheel_inertia = 0.05;
        if (what == 2) p.rolling_resistance = 0.0;
        if (what == 3) p.relaxation_along = 0.02;
        const Worst w = compare(p, 15.0, swing, 1.5, throttle, what == 0 && std::getenv("SHOW") != nullptr);
        std::printf("throttle %.1f swing %.2f what %d: r %.4f of %.3f, vy %.4f, vx %.4f\n", throttle, swing, what, w.r, w.most_r, w.vy, w.vx);
      }
    }
}

}  // namespace
}  // namespace chicane::identify
