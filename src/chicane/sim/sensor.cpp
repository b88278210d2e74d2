// SPDX-License-Identifier: MIT
#include "chicane/sim/sensor.hpp"

#include <array>
#include <cmath>

namespace chicane::sim {
namespace {

double quantised(double value, double quantum) noexcept {
  return quantum > 0.0 ? quantum * std::floor(value / quantum + 0.5) : value;
}

using S = SensorOptions;
constexpr std::array kOptions{
    option<&S::position_noise>("position_noise", unit::kMetre, 0, 10, "Standard deviation of x and y."),
    option<&S::heading_noise>("heading_noise", unit::kDegree, 0, 28, "Standard deviation of the yaw."),
    option<&S::speed_noise>("speed_noise", unit::kSpeed, 0, 10, "Standard deviation of the speed."),
    option<&S::position_quantum>("position_quantum", unit::kMetre, 0, 10,
                                 "x and y are rounded to multiples of it; 0 does not round."),
    option<&S::heading_quantum>("heading_quantum", unit::kDegree, 0, 28,
                                "The yaw is rounded to multiples of it."),
    option<&S::speed_quantum>("speed_quantum", unit::kSpeed, 0, 10,
                              "The speed is rounded to multiples of it."),
};

}  // namespace

std::span<const Option> sensor_options() noexcept { return kOptions; }

model::Measurement Sensor::sample(double time, const Plant& plant) noexcept {
  // Every sample draws four numbers, whatever the options: one noise does not shift the stream of another.
  const double noise_x = random_.normal() * options_.position_noise;
  const double noise_y = random_.normal() * options_.position_noise;
  const double noise_psi = random_.normal() * options_.heading_noise;
  const double noise_speed = random_.normal() * options_.speed_noise;
  const model::State& state = plant.state();
  model::Measurement result;
  result.time = time;
  result.x = quantised(state.x + noise_x, options_.position_quantum);
  result.y = quantised(state.y + noise_y, options_.position_quantum);
  result.psi = quantised(state.psi + noise_psi, options_.heading_quantum);
  result.speed = std::fabs(quantised(plant.output().speed + noise_speed, options_.speed_quantum));
  result.steer = state.steer;
  result.throttle = plant.output().throttle;
  return result;
}

}  // namespace chicane::sim
