// SPDX-License-Identifier: MIT
#include "chicane/sim/sensor.hpp"

#include "chicane/sim/plant_registry.hpp"
#include "support/chicane_test.hpp"

namespace chicane::sim {
namespace {

std::unique_ptr<Plant> moving_plant() {
  auto plant = make_plant("road-car").value();
  plant->reset({.x = 12.3456, .y = -7.891, .psi = 0.777}, 20.0);
  plant->advance({.steer = 0.1, .throttle = 0.5});
  return plant;
}

TEST(Sensor, IsPerfectByDefault) {
  const auto plant = moving_plant();
  const model::Measurement seen = Sensor{{}, 1}.sample(3.5, *plant);
  EXPECT_EQ(seen.time, 3.5);
  EXPECT_EQ(seen.x, plant->state().x);
  EXPECT_EQ(seen.y, plant->state().y);
  EXPECT_EQ(seen.psi, plant->state().psi);
  EXPECT_EQ(seen.speed, plant->output().speed);
  EXPECT_EQ(seen.steer, plant->state().steer);
  EXPECT_EQ(seen.throttle, 0.5);
}

TEST(Sensor, SameSeedSameNoiseOfTheStatedDeviationThatDoesNotShiftAnother) {
  const auto plant = moving_plant();
  const SensorOptions options{.position_noise = 0.5, .heading_noise = 0.02, .speed_noise = 0.2};
  Sensor a{options, 7}, b{options, 7}, c{options, 43}, only_speed{{.speed_noise = 0.2}, 7};
  double sum = 0.0, squares_x = 0.0, squares_psi = 0.0;
  const int count = 20000;
  for (int i = 0; i < count; ++i) {
    const model::Measurement seen = a.sample(0.0, *plant);
    sum += (seen.x - plant->state().x) / count;
    squares_x += std::pow(seen.x - plant->state().x, 2) / count;
    squares_psi += std::pow(seen.psi - plant->state().psi, 2) / count;
    if (i >= 10) continue;
    const model::Measurement same = b.sample(0.0, *plant);
    EXPECT_EQ(seen.x, same.x);
    EXPECT_EQ(seen.speed, same.speed);
    EXPECT_NE(seen.x, c.sample(0.0, *plant).x);
    EXPECT_EQ(seen.speed, only_speed.sample(0.0, *plant).speed);
  }
  // Four standard errors: 0.5 / √n for the mean, σ / √(2 n) for the deviations.
  EXPECT_NEAR(sum, 0.0, 4.0 * 0.5 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares_x), 0.5, 4.0 * 0.5 / std::sqrt(2.0 * count));
  EXPECT_NEAR(std::sqrt(squares_psi), 0.02, 4.0 * 0.02 / std::sqrt(2.0 * count));
}

TEST(Sensor, RoundsToItsQuantaAndTellsNoNegativeSpeed) {
  const auto plant = moving_plant();
  const SensorOptions options{.position_quantum = 0.25, .heading_quantum = 0.125, .speed_quantum = 0.5};
  const model::Measurement seen = Sensor{options, 1}.sample(0.0, *plant);
  EXPECT_EQ(std::fmod(seen.x, 0.25), 0.0);
  EXPECT_NEAR(seen.x, plant->state().x, 0.125);
  EXPECT_EQ(std::fmod(seen.psi, 0.125), 0.0);
  EXPECT_EQ(std::fmod(seen.speed, 0.5), 0.0);
  const auto standing = make_plant("road-car").value();
  Sensor noisy{{.speed_noise = 1.0}, 3};
  for (int i = 0; i < 100; ++i) EXPECT_GE(noisy.sample(0.0, *standing).speed, 0.0);
}

TEST(Sensor, TellsWhatWasThereALatencyAgoAsIfItWereNew) {
  const auto plant = make_plant("road-car").value();
  plant->reset({.x = 1.0, .y = 2.0, .psi = 3.1}, 20.0);
  Sensor sensor{{.latency = 0.1}, 1};
  std::vector<model::Measurement> truth;
  for (int i = 0; i <= 50; ++i) {
    const double time = 0.04 * i;
    truth.push_back(Sensor{{}, 1}.sample(time, *plant));
    const model::Measurement seen = sensor.sample(time, *plant);
    EXPECT_EQ(seen.time, time);
    if (i < 3) {
      EXPECT_EQ(seen.x, 1.0) << "nothing is older than the beginning";
    } else {
      const auto older = static_cast<std::size_t>(i - 3), newer = static_cast<std::size_t>(i - 2);
      EXPECT_NEAR(seen.x, 0.5 * (truth[older].x + truth[newer].x), 1e-9) << "between 120 and 80 ms ago";
      EXPECT_NEAR(seen.speed, 0.5 * (truth[older].speed + truth[newer].speed), 1e-9);
      EXPECT_EQ(seen.steer, truth[older].steer);
    }
    for (int step = 0; step < 40; ++step) plant->advance({.steer = 0.05, .throttle = 0.3});
  }
  EXPECT_GT(truth.back().x * truth.back().x + truth.back().y * truth.back().y, 100.0);
}

TEST(Sensor, TheLongestLatencyIsHeldAlsoWhereItIsSampledOften) {
  const auto plant = moving_plant();
  Sensor sensor{{.latency = 0.5}, 1};
  model::Measurement first = sensor.sample(0.0, *plant);
  for (int i = 1; i < 400; ++i) {
    plant->advance({});
    static_cast<void>(sensor.sample(0.004 * i, *plant));
  }
  Sensor exact{{}, 1};
  const model::Measurement now = exact.sample(1.6, *plant), seen = sensor.sample(1.6, *plant);
  EXPECT_NE(now.x, seen.x);
  EXPECT_NE(first.x, seen.x);
}

struct Sent {
  double due, throttle;
};
/// Throttles that act at times [s], one after the other, of commands that were sent.
std::vector<double> throttles_at(const std::vector<double>& times, const std::vector<Sent>& commands,
                                 double first = 0.0) {
  ActuationDelay delay;
  delay.reset({.steer = -first, .throttle = first});
  for (const Sent& each : commands)
    delay.push(each.due, {.steer = -each.throttle, .throttle = each.throttle});
  std::vector<double> acting;
  for (const double time : times) acting.push_back(delay.at(time).throttle);
  return acting;
}

TEST(ActuationDelay, ShowsTheNewestOfTheCommandsDueInTheOrderOfSending) {
  EXPECT_THAT(throttles_at({0.0, 0.2499, 0.25, 9.0}, {{0.25, 0.2}}, 0.1), ElementsAre(0.1, 0.1, 0.2, 0.2));
  EXPECT_THAT(throttles_at({0.3}, {{0.1 + 0.2, 1.0}}), ElementsAre(1.0))
      << "0.30000000000000004: a sum of steps";
  EXPECT_THAT(throttles_at({0.2, 0.3}, {{0.10, 0.1}, {0.11, 0.2}, {0.30, 0.3}}), ElementsAre(0.2, 0.3));
  EXPECT_THAT(throttles_at({0.25, 0.3}, {{0.3, 0.1}, {0.2, 0.2}}), ElementsAre(0.0, 0.2))
      << "a faster answer cannot overtake";
  std::vector<Sent> many;
  for (int i = 1; i <= 200; ++i) many.push_back({static_cast<double>(i), i / 1000.0});
  EXPECT_THAT(throttles_at({72.0, 73.0, 200.0}, many), ElementsAre(0.0, 0.073, 0.2)) << "1 … 72 were dropped";
}

TEST(RandomDelay, IsEvenlyDistributedAndDependsOnSeedAndTimeOnly) {
  constexpr int kCount = 10000;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double late = random_delay(1, 0.04 * i, 0.06);
    ASSERT_GE(late, 0.0);
    ASSERT_LT(late, 0.06);
    sum += late;
    squares += late * late;
  }
  EXPECT_NEAR(sum / kCount, 0.03, 0.0006);
  EXPECT_NEAR(squares / kCount, 0.06 * 0.06 / 3.0, 3e-5);
  EXPECT_EQ(random_delay(1, 0.4, 0.06), random_delay(1, 0.4, 0.06));
  EXPECT_NE(random_delay(1, 0.4, 0.06), random_delay(2, 0.4, 0.06));
  EXPECT_EQ(random_delay(1, 0.4, 0.0), 0.0);
}

}  // namespace
}  // namespace chicane::sim
