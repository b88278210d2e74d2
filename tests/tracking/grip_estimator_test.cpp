// SPDX-License-Identifier: MIT
#include "chicane/tracking/state_estimator.hpp"

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/model/vehicle.hpp"
#include "support/chicane_test.hpp"

namespace chicane::tracking {
namespace {

constexpr double kPeriod = 0.04;

/// Standard deviations of what is measured.
struct Noise {
  double place = 0.0, heading = 0.0, speed = 0.0;
};

/// A car whose tyres have `grip` of the assumed one, and `inertia` times the yaw inertia, weaves at about 25
/// m/s, up to `most` of steering [rad], and is measured.
class Weaving {
 public:
  explicit Weaving(double grip, const Noise& noise = {}, double most = 0.05, std::uint64_t seed = 1,
                   double inertia = 1.0)
      : truth_{model::PredictionModel{true_car(assumed_.vehicle(), grip, inertia)}},
        noise_{noise},
        most_{most},
        random_{seed} {
    truth_.correct({.speed = 25.0}, sent_);
    estimator.begin(truth_, assumed_);
  }
  void begin_anew() { estimator.begin(truth_, assumed_); }
  /// From an estimate that counts with a disturbance, as the controller's does.
  void begin_with_disturbance() {
    StateEstimator from = truth_;
    from.estimate_disturbance(true);
    estimator.begin(from, assumed_);
  }
  [[nodiscard]] const model::PredictionModel& assumed() const { return assumed_; }
  void drive(double seconds) {
    for (const double end = time_ + seconds; time_ < end;) {
      time_ += kPeriod;
      const model::Command command{.steer = most_ * sin(1.3 * time_), .throttle = 0.2};
      commanded_.add(time_ - kPeriod, command);
      sent_.add(time_ - kPeriod + (jitter > 0.0 ? random_.uniform(0.0, jitter) : 0.0), command);
      const model::State car = truth_.predict(time_, sent_).state;
      model::Measurement now{.time = time_,
                             .x = car.x,
                             .y = car.y,
                             .psi = car.psi,
                             .speed = std::sqrt(car.vx * car.vx + car.vy * car.vy),
                             .steer = car.steer};
      truth_.correct(now, sent_);  // of what it predicts itself: nothing changes
      now.x += noise_.place * random_.normal();
      now.y += noise_.place * random_.normal();
      now.psi += noise_.heading * random_.normal();
      now.speed += noise_.speed * random_.normal();
      estimator.see(now, commanded_);
    }
  }
  double jitter = 0.0;  ///< [s] by which a command acts later than told, at most

 private:
  static model::VehicleParams true_car(model::VehicleParams car, double grip, double inertia) {
    car.yaw_inertia *= inertia;
    return model::with_grip(car, grip);
  }

  model::PredictionModel assumed_{model::road_car_params()};
  StateEstimator truth_;
  Noise noise_;
  double most_;
  Random random_;
  CommandHistory sent_, commanded_;
  double time_ = 0.0;

 public:
  GripEstimator estimator{assumed_};
};

TEST(GripEstimator, FindsTheGripOfTheTyres) {
  for (const double grip : {0.8, 0.9, 1.0, 1.1}) {
    Weaving car(grip);
    car.drive(15.0);
    ASSERT_TRUE(car.estimator.is_known()) << grip;
    EXPECT_NEAR(car.estimator.share(), grip, 0.03) << grip;
    EXPECT_LT(car.estimator.deviation(), 0.002) << grip << ": nothing takes up what it explains";
  }
}

/// Noise is no lack of grip: the mean over seeds is right, and each is within what it is said to be.
TEST(GripEstimator, IsNotDeceivedByNoiseAndKnowsHowSureItIs) {
  constexpr int kSeeds = 40;
  for (const double grip : {0.9, 1.0}) {
    double sum = 0.0;
    int outside = 0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      Weaving car(grip, {.place = 0.05, .heading = 0.005, .speed = 0.1}, 0.05,
                  static_cast<std::uint64_t>(seed));
      car.drive(20.0);
      ASSERT_TRUE(car.estimator.is_known()) << grip << ' ' << car.estimator.deviation();
      sum += car.estimator.share();
      outside += std::fabs(car.estimator.share() - grip) > 2.0 * car.estimator.deviation() ? 1 : 0;
    }
    EXPECT_NEAR(sum / kSeeds, grip, 0.02) << grip;
    EXPECT_LE(outside, kSeeds / 6) << grip;
  }
}

TEST(GripEstimator, ForgetsEverythingWhereItBeginsAnew) {
  Weaving car(0.8), fresh(0.8);
  car.drive(16.0);
  ASSERT_TRUE(car.estimator.is_known());
  car.begin_anew();
  EXPECT_FALSE(car.estimator.is_known());
  EXPECT_TRUE(std::isinf(car.estimator.deviation()));
  fresh.drive(16.0);
  fresh.estimator = GripEstimator{fresh.assumed()};
  fresh.begin_anew();
  for (Weaving* each : {&car, &fresh}) each->drive(15.0);
  EXPECT_EQ(car.estimator.share(), fresh.estimator.share());
  EXPECT_EQ(car.estimator.deviation(), fresh.estimator.deviation());
}

/// What takes up the acceleration that the model lacks would take up the lack of grip.
TEST(GripEstimator, EstimatesNoDisturbanceBesideTheGrip) {
  Weaving car(0.9), beside(0.9);
  beside.begin_with_disturbance();
  for (Weaving* each : {&car, &beside}) each->drive(15.0);
  EXPECT_EQ(beside.estimator.share(), car.estimator.share());
  EXPECT_EQ(beside.estimator.deviation(), car.estimator.deviation());
}

TEST(GripEstimator, KnowsNothingBeforeACorner) {
  Weaving straight(0.8, {}, 0.005);
  straight.drive(20.0);
  EXPECT_FALSE(straight.estimator.is_known());
  EXPECT_EQ(straight.estimator.share(), 1.0);
  EXPECT_FALSE(straight.estimator.differs(0.0));
}

TEST(GripEstimator, IsLessSureWithNoise) {
  Weaving quiet(1.0), noisy(1.0, {.place = 0.1, .heading = 0.01, .speed = 0.1});
  quiet.drive(20.0);
  noisy.drive(20.0);
  EXPECT_GT(noisy.estimator.deviation(), 2.0 * quiet.estimator.deviation());
}

/// What the model lacks is no noise: with another yaw inertia the estimate is wrong by more than noise
/// explains, and says so.
TEST(GripEstimator, IsUnsureWhereTheModelLacksSomething) {
  for (const double inertia : {0.7, 1.5}) {
    Weaving car(1.0, {.place = 0.002, .heading = 0.0002}, 0.05, 1, inertia);
    car.drive(20.0);
    EXPECT_LT(std::fabs(car.estimator.share() - 1.0), 2.0 * car.estimator.deviation() + 0.01) << inertia;
  }
}

TEST(GripEstimator, SaysWhenItDiffersFromTheAssumption) {
  Weaving same(1.0), less(0.8);
  same.drive(15.0);
  less.drive(15.0);
  EXPECT_FALSE(same.estimator.differs(0.03));
  EXPECT_TRUE(less.estimator.differs(0.03));
  EXPECT_FALSE(less.estimator.differs(0.3));
}

/// docs/limit.md, eq. 18. Evenly distributed jitter has a root mean square of 0.58 of the most.
TEST(GripEstimator, SaysHowSureTheTimeOfCommandsIs) {
  const auto unsure_time = [](double jitter, const Noise& noise) {
    Weaving car(1.0, noise, 0.2);
    car.jitter = jitter;
    EXPECT_FALSE(std::isfinite(car.estimator.unsure_time())) << "before a corner";
    car.drive(20.0);
    return car.estimator.unsure_time();
  };
  EXPECT_LT(unsure_time(0.0, {}), 0.002);
  for (const double jitter : {0.01, 0.02, 0.03})
    EXPECT_NEAR(unsure_time(jitter, {}), 0.58 * jitter, 0.2 * jitter) << jitter;
  EXPECT_GT(unsure_time(0.0, {.heading = 0.005}), 0.04) << "noise is no knowledge of it, either";
}

TEST(GripEstimator, LeavesOutWhatIsNoMeasurement) {
  Weaving car(0.9);
  car.drive(10.0);
  const double share = car.estimator.share();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const CommandHistory none;
  car.estimator.see({.time = 10.04, .x = nan, .y = nan, .psi = nan, .speed = nan}, none);
  car.estimator.see({.time = nan}, none);
  EXPECT_EQ(car.estimator.share(), share);
  EXPECT_TRUE(std::isfinite(car.estimator.deviation()));
}

}  // namespace
}  // namespace chicane::tracking
