// SPDX-License-Identifier: MIT
#include "chicane/tracking/error_covariance.hpp"

#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane::tracking {
namespace {

constexpr double kStep = 0.04;    // [s]
constexpr double kSpeed = 30.0;   // [m/s]
constexpr double kFading = 0.92;  // of a disturbance in a step
constexpr ErrorCovariance::Slopes kSlopes{0.8, -0.9, 0.02, 0.8};
using Vector = ErrorCovariance::Vector;
using Errors = ErrorCovariance;

/// Errors of an estimate that follow the model of the covariance, measured with noise.
class Simulated {
 public:
  Simulated(double place_noise, double heading_noise, double lateral, double yaw)
      : place_noise_{place_noise}, heading_noise_{heading_noise}, lateral_{lateral}, yaw_{yaw} {
    covariance.estimate_disturbance(true);
    covariance.begin();
  }
  void step() {
    covariance.advance(kStep, kSpeed, kSlopes, kFading);
    const Vector x = error;
    error = {x[0] + kStep * (kSpeed * x[1] + x[2]),
             x[1] + kStep * x[3],
             kSlopes.slide_by_slide * x[2] + kSlopes.slide_by_yaw_rate * x[3] + kStep * x[4],
             kSlopes.yaw_rate_by_slide * x[2] + kSlopes.yaw_rate_by_yaw_rate * x[3] + kStep * x[5],
             kFading * x[4] + std::sqrt(1.0 - kFading * kFading) * lateral_ * random_.normal(),
             kFading * x[5] + std::sqrt(1.0 - kFading * kFading) * yaw_ * random_.normal()};
    const Vector by = covariance.correct(
        {error[0] + place_noise_ * random_.normal(), error[1] + heading_noise_ * random_.normal(), false});
    for (std::size_t i = 0; i < by.size(); ++i) error[i] -= by[i];
  }
  Vector error{};
  ErrorCovariance covariance;

 private:
  double place_noise_, heading_noise_, lateral_, yaw_;
  Random random_{7};
};

TEST(ErrorCovariance, FindsTheNoiseOfTheSensors) {
  for (const double scale : {0.2, 1.0, 4.0}) {
    Simulated car(0.05 * scale, 0.005 * scale, 0.5, 0.25);
    double place = 0.0, heading = 0.0;
    for (int i = 0; i < 3000; ++i) {
      car.step();
      if (i < 1000) continue;
      place += car.covariance.place_noise() / 2000.0;
      heading += car.covariance.heading_noise() / 2000.0;
    }
    EXPECT_NEAR(place, 0.05 * scale, 0.1 * 0.05 * scale);
    EXPECT_NEAR(heading, 0.005 * scale, 0.1 * 0.005 * scale);
  }
}

TEST(ErrorCovariance, IsTheVarianceOfTheErrorsThatAreThere) {
  for (const double wrong : {0.5, 1.0, 2.0}) {  // the model's error, of a usual one
    Simulated car(0.05, 0.005, 0.5 * wrong, 0.25 * wrong);
    double expected = 0.0, there = 0.0;
    for (int i = 0; i < 10000; ++i) {
      car.step();
      if (i < 500) continue;
      const double slide = car.error[Errors::kSlide] - 1.4 * car.error[Errors::kYawRate];
      expected += car.covariance.slide_variance(1.4);
      there += slide * slide;
    }
    EXPECT_GT(std::sqrt(expected / there), 0.8) << wrong;
    EXPECT_LT(std::sqrt(expected / there), 1.5) << wrong;
  }
}

TEST(ErrorCovariance, TakesOverMostOfWhatAPerfectSensorSays) {
  ErrorCovariance covariance;
  Vector by{};
  for (int i = 0; i < 50; ++i) {
    covariance.advance(kStep, kSpeed, kSlopes, kFading);
    by = covariance.correct({0.01, 0.001, false});
  }
  EXPECT_NEAR(by[Errors::kHeading], Errors::kMostShare * 0.001, 0.2e-3);
  EXPECT_GT(by[Errors::kYawRate], 0.0);
}

TEST(ErrorCovariance, ALaggingEstimateIsCorrectedByMoreThanANoisyOne) {
  ErrorCovariance noisy, wrong;
  Random random{4};
  Vector of_noisy{}, of_wrong{};
  for (int i = 0; i < 200; ++i) {
    noisy.advance(kStep, kSpeed, kSlopes, kFading);
    wrong.advance(kStep, kSpeed, kSlopes, kFading);
    noisy.correct({0.3 * random.normal(), 0.03 * random.normal(), false});
    wrong.correct({0.3, 0.03, false});
  }
  of_noisy = noisy.correct({0.3, 0.03, false});
  of_wrong = wrong.correct({0.3, 0.03, false});
  EXPECT_LT(of_noisy[Errors::kHeading], 0.5 * of_wrong[Errors::kHeading]);
  EXPECT_LT(of_noisy[Errors::kYawRate], 0.5 * of_wrong[Errors::kYawRate]);
}

TEST(ErrorCovariance, IsMirrored) {
  ErrorCovariance left, right;
  Random random{9};
  for (int i = 0; i < 100; ++i) {
    left.advance(kStep, kSpeed, kSlopes, kFading);
    right.advance(kStep, kSpeed, kSlopes, kFading);
    const double aside = 0.1 * random.normal(), heading = 0.01 * random.normal();
    const Vector a = left.correct({aside, heading, false}), b = right.correct({-aside, -heading, false});
    for (std::size_t q = 0; q < a.size(); ++q) EXPECT_EQ(a[q], -b[q]);
  }
}

// A car whose rear tyres slide is unstable: there the asymmetry of a matrix grows.
TEST(ErrorCovariance, ForgetsThatTheCarHasSlid) {
  constexpr Errors::Slopes kSliding{0.995, -0.362, -0.004, 0.994}, kGripping{0.953, -0.384, 0.002, 0.957};
  constexpr int kInterval = 4;  // steps of 0.01 s
  ErrorCovariance slid, calm;
  for (ErrorCovariance* each : {&slid, &calm}) each->estimate_disturbance(true);
  const auto advance = [](ErrorCovariance& each, const Errors::Slopes& slopes, double time) {
    for (int i = 0; i < static_cast<int>(time / (0.01 * kInterval)); ++i) {
      for (int k = 0; k < kInterval; ++k) each.advance(0.01, 38.0, slopes, 0.98);
      each.correct({0.0, 0.0, false});
    }
  };
  advance(slid, kSliding, 20.0);
  for (ErrorCovariance* each : {&slid, &calm}) advance(*each, kGripping, 20.0);
  const Vector a = slid.correct({1e-3, 1e-3, false}), b = calm.correct({1e-3, 1e-3, false});
  for (std::size_t q = 0; q < a.size(); ++q) EXPECT_NEAR(a[q], b[q], 1e-9 + 1e-6 * std::fabs(b[q])) << q;
}

TEST(ErrorCovariance, CorrectsByTheHeadingAloneWhereThePlaceIsMissing) {
  ErrorCovariance covariance;
  covariance.advance(kStep, kSpeed, kSlopes, kFading);
  const Vector by = covariance.correct({std::nan(""), 0.01, false});
  EXPECT_GT(by[Errors::kHeading], 0.0);
  EXPECT_GT(by[Errors::kAside], 0.0) << "the heading was wrong while the car drove";
}

}  // namespace
}  // namespace chicane::tracking
