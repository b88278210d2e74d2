// SPDX-License-Identifier: MIT
#include "chicane/controller/controller.hpp"

#include <gtest/gtest.h>

#include "chicane/controller/registry.hpp"
#include "controller/sample_road.hpp"
#include "support/alloc_guard.hpp"

namespace chicane::controller {
namespace {

const model::VehicleParams kCar;

/// Each controller of the registry, as whatever Tunable it is.
template <class Entry>
class TunableController : public ::testing::Test {
 protected:
  static std::unique_ptr<Controller> make() { return std::move(*Entry::kMake({}, kCar)); }
  static Tunable<typename Entry::Options>& tunable(Controller& controller) {
    return dynamic_cast<Tunable<typename Entry::Options>&>(controller);
  }
  /// The commands of some steps along a bend.
  static model::Command drive(Controller& controller, int from, int steps) {
    model::Command last;
    for (int i = from; i < from + steps; ++i) {
      model::Measurement now = on_a_left_bend();
      now.time += 0.05 * i;
      last = controller.step(now, Deadline::never()).command;
    }
    return last;
  }
};

using Entries = ::testing::Types<TrackingMpcEntry, CubicMpcEntry, PidEntry, PurePursuitEntry, StanleyEntry>;
TYPED_TEST_SUITE(TunableController, Entries);

TYPED_TEST(TunableController, DrivesOnAsBeforeWithTheSameSettings) {
  const auto one = this->make(), other = this->make();
  this->drive(*one, 0, 5);
  this->drive(*other, 0, 5);
  this->tunable(*other).configure({}, kCar);
  const model::Command before = this->drive(*one, 5, 3), after = this->drive(*other, 5, 3);
  EXPECT_EQ(after.steer, before.steer);
  EXPECT_EQ(after.throttle, before.throttle);
}

TYPED_TEST(TunableController, FollowsAnotherLimitOfTheVehicleInTheNextStep) {
  const auto controller = this->make();
  this->drive(*controller, 0, 5);
  model::VehicleParams stiff = kCar;
  stiff.steer_limit = 0.001;
  this->tunable(*controller).configure({}, stiff);
  EXPECT_LE(std::abs(this->drive(*controller, 5, 1).steer), 0.001);
}

TYPED_TEST(TunableController, AllocatesNothing) {
  const auto controller = this->make();
  this->drive(*controller, 0, 5);
  const test::AllocationGuard guard;
  this->tunable(*controller).configure({}, kCar);
  EXPECT_EQ(guard.count(), 0);
}

}  // namespace
}  // namespace chicane::controller
