// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <functional>
#include <utility>
#include <vector>

#include "chicane/model/vehicle.hpp"
#include "chicane/sim/plant.hpp"

/// Test drives: what one would measure on a proving ground, for the tests of the plants and for
/// studies/tables/plant_report.cpp.
namespace chicane::sim::experiment {

struct Sample {
  double time = 0.0;
  double speed = 0.0;
  double ax = 0.0;
  double ay = 0.0;
  double x = 0.0;
  double y = 0.0;
  double r = 0.0;
  double vy = 0.0;
};

/// y = offset + slope · x through points by least squares.
struct Line {
  double offset = 0.0;
  double slope = 0.0;
  double rms = 0.0;
};
[[nodiscard]] Line fit_line(const std::vector<std::pair<double, double>>& points);

/// The plant as it stands, driven straight with a constant throttle for `duration` [s]; one sample for each
/// step.
std::vector<Sample> drive_straight(Plant& plant, double throttle, double duration);

/// Accelerations from standstill in windows of 0.2 s: (mean speed, mean acceleration), after the first `skip`
/// seconds.
[[nodiscard]] std::vector<std::pair<double, double>> accelerations(const std::vector<Sample>& run,
                                                                   double skip);

/// First time at which the speed reaches `speed` [s]; −1 if never. Between samples: interpolated.
[[nodiscard]] double time_to(const std::vector<Sample>& run, double speed);

/// Acceleration while braking straight with a constant `throttle` < 0: mean over `speed` ± 0.75 m/s [m/s²].
[[nodiscard]] double braking_at(Plant& plant, double throttle, double speed);

/// Curvature r / v after settling with `steer` at a held `speed` [1/m], and the yaw rate [rad/s].
struct Circle {
  double curvature = 0.0;
  double yaw_rate = 0.0;
  double lateral_acceleration = 0.0;
  double sideslip = 0.0;
  double speed = 0.0;
  double path_radius = 0.0;  ///< of the centre of mass, speed / |d(course)/dt|
};
[[nodiscard]] Circle steady_circle(Plant& plant, double steer, double speed, double settle = 12.0);

/// The two modes of lateral motion at a held `speed` [1/s]: from the free response after a small steering
/// pulse, by a linear recurrence of order two through the lateral velocity (Prony 1795).
[[nodiscard]] std::pair<std::complex<double>, std::complex<double>> yaw_modes(Plant& plant, double speed);

/// Yaw rate over steady yaw rate after a step of the wheel at a held speed: times [s] to 50 and 90 %.
[[nodiscard]] std::pair<double, double> yaw_rise(Plant& plant, double speed, double steer);

/// Largest lateral acceleration while the wheel turns in slowly (0.02 rad/s) at a held speed, and the
/// steering angle there.
struct Peak {
  double lateral_acceleration = 0.0;
  double steer = 0.0;
};
[[nodiscard]] Peak peak_cornering(Plant& plant, double speed);

/// How far a single track with `params` is from the plant, for random steps of the wheel at a held speed, up
/// to a lateral acceleration of about `lateral` [m/s²]: rms of the error over rms of the plant's value, for
/// yaw rate and lateral velocity.
struct Mismatch {
  double yaw_rate = 0.0;
  double lateral_velocity = 0.0;
};
[[nodiscard]] Mismatch compare(Plant& plant, const model::VehicleParams& params, double speed,
                               double lateral);

/// What one would identify from a log of this plant, as was done with logs of the original: the normalised
/// cornering stiffnesses of a linear single track (docs/model.md, eq. 7) that reproduce the yaw rate best
/// while the wheel moves in random steps at 20, 30 and 45 m/s, and the yaw modes such a model has.
struct Identified {
  double cornering_front = 0.0;
  double cornering_rear = 0.0;
};
[[nodiscard]] Identified identify_single_track(Plant& plant, const model::VehicleParams& params);
[[nodiscard]] std::pair<std::complex<double>, std::complex<double>> linear_modes(
    const model::VehicleParams& params, double speed);

/// Throttle that holds the speed of this plant: a proportional-integral controller.
class SpeedHold {
 public:
  explicit SpeedHold(double speed) : speed_{speed} {}
  [[nodiscard]] double throttle(const Plant& plant);

 private:
  double speed_;
  double sum_ = 0.0;
};

}  // namespace chicane::sim::experiment
