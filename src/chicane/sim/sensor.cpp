// SPDX-License-Identifier: MIT
// Signals between plant and controller: measurements with latency and noise, and commands in flight.
#include "chicane/sim/sensor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "chicane/base/math.hpp"

namespace chicane::sim {
namespace {

/// Multiple of `quantum` nearest to a value; the value itself for a quantum of 0.
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
                                "Step to whose multiples the yaw is rounded."),
    option<&S::speed_quantum>("speed_quantum", unit::kSpeed, 0, 10,
                              "Step to whose multiples the speed is rounded."),
    option<&S::latency>("latency", unit::kMillisecond, 0, 500,
                        "Age of a measurement when it reaches the controller, which does not know it."),
};

}  // namespace

std::span<const Option> sensor_options() noexcept { return kOptions; }

model::Measurement Sensor::sample(double time, const Plant& plant) noexcept {
  // Draw four numbers for every sample, whatever the options: one noise must not shift the stream of another.
  const double noise_x = random_.normal() * options_.position_noise;
  const double noise_y = random_.normal() * options_.position_noise;
  const double noise_psi = random_.normal() * options_.heading_noise;
  const double noise_speed = random_.normal() * options_.speed_noise;
  const model::State& state = plant.state();
  sights_[count_++ % kRemembered] = {
      time, state.x, state.y, state.psi, plant.output().speed, state.steer, plant.output().throttle};
  const Sight seen = seen_at(time - options_.latency);
  model::Measurement result;
  result.time = time;
  result.x = quantised(seen.x + noise_x, options_.position_quantum);
  result.y = quantised(seen.y + noise_y, options_.position_quantum);
  result.psi = quantised(seen.psi + noise_psi, options_.heading_quantum);
  result.speed = std::fabs(quantised(seen.speed + noise_speed, options_.speed_quantum));
  result.steer = seen.steer;
  result.throttle = seen.throttle;
  return result;
}

Sensor::Sight Sensor::seen_at(double time) const noexcept {
  const Sight* later = &sights_[(count_ - 1) % kRemembered];
  const std::size_t most = std::min(count_, kRemembered);
  for (std::size_t back = 2; later->time > time && back <= most; ++back) {
    const Sight& earlier = sights_[(count_ - back) % kRemembered];
    if (earlier.time <= time) {
      const double share = (time - earlier.time) / (later->time - earlier.time);
      const auto between = [&](double a, double b) { return a + share * (b - a); };
      return {time,
              between(earlier.x, later->x),
              between(earlier.y, later->y),
              earlier.psi + share * angle_difference(later->psi, earlier.psi),
              between(earlier.speed, later->speed),
              earlier.steer,
              earlier.throttle};
    }
    later = &earlier;
  }
  return *later;
}

void ActuationDelay::reset(const model::Command& acting) noexcept {
  count_ = 0;
  acting_ = acting;
}

void ActuationDelay::push(double time, const model::Command& command) noexcept {
  time = std::max(time, last_time());
  if (count_ == kCapacity) {
    std::shift_left(waiting_.begin(), waiting_.end(), 1);
    --count_;
  }
  waiting_[count_++] = {time, command};
}

double ActuationDelay::last_time() const noexcept {
  return count_ > 0 ? waiting_[count_ - 1].time : -std::numeric_limits<double>::infinity();
}

const model::Command& ActuationDelay::at(double time) noexcept {
  constexpr double kRounding = 1e-9;  // [s] rounding of sums of step lengths
  std::size_t due = 0;
  while (due < count_ && waiting_[due].time <= time + kRounding) acting_ = waiting_[due++].command;
  std::shift_left(waiting_.data(), waiting_.data() + count_, static_cast<std::ptrdiff_t>(due));
  count_ -= due;
  return acting_;
}

double random_delay(std::uint64_t seed, double time, double most) noexcept {
  if (!(most > 0.0)) return 0.0;
  Random seeded(seed);
  return Random(seeded.bits() ^ std::bit_cast<std::uint64_t>(time)).uniform(0.0, most);
}

}  // namespace chicane::sim
