// SPDX-License-Identifier: MIT
#include "chicane/run/setting.hpp"

#include "chicane/sim/fault.hpp"
#include "support/chicane_test.hpp"

namespace chicane::run {
namespace {

Result<Setting> read(std::string_view name, std::string_view value) {
  return read_setting({.cycle = 7, .time = 0.28, .name = name, .value = value});
}

template <class Kind>
Kind action(std::string_view name, std::string_view value) {
  SCOPED_TRACE(std::string(name) + " " + std::string(value));
  return std::get<Kind>(test::good(read(name, value))->action);
}

std::string refusal(std::string_view name, std::string_view value) {
  return test::refusal_of(read(name, value));
}

TEST(Setting, OfEachFieldThatIsNoTextReadsAsSetTakesIt) {
  const scenario::Scenario initial;
  for (const protocol::Parameter& row : protocol::list()) {
    SCOPED_TRACE(row.key);
    const std::string text = protocol::get_text(initial, row);
    const Result<Setting> setting = read(row.key, text);
    if (!setting) {
      EXPECT_TRUE(std::holds_alternative<std::string>(
          row.option.read(row.owner(const_cast<scenario::Scenario&>(initial)))));
      continue;
    }
    scenario::Scenario written;
    write(written, std::get<FieldValue>(setting->action));
    EXPECT_EQ(protocol::get_text(written, row), text);
    EXPECT_EQ(setting->change.name.view(), row.key);
    EXPECT_EQ(setting->change.cycle, 7U);
  }
}

TEST(Setting, OfAFieldIsMadeFromItsValueAndReadsBackTheSame) {
  scenario::Scenario scenario;
  const auto setting = test::good(set_field(scenario, *protocol::find("latency_ms"), 33.3));
  EXPECT_EQ(setting->change.name.view(), "latency_ms");
  EXPECT_EQ(setting->change.value.view(), "33.3");
  EXPECT_EQ(std::get<double>(std::get<FieldValue>(setting->action).value), scenario.latency);
  EXPECT_EQ(std::get<double>(action<FieldValue>("latency_ms", "33.3").value), scenario.latency);
  const auto text = test::good(set_field(scenario, *protocol::find("track"), std::string("oval")));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(text->action));
  EXPECT_EQ(scenario.track, "oval");
  EXPECT_EQ(set_field(scenario, *protocol::find("latency_ms"), 900.0).error().message,
            "latency_ms: got 900, expected a number in [0, 500] ms");
  EXPECT_EQ(scenario.latency, 33.3 / 1000.0);
}

TEST(Setting, OfPaceHandsAndFaultsIsReadOnce) {
  EXPECT_EQ(action<Pace>("run.pace", "0.25").value, 0.25);
  EXPECT_EQ(action<ManualSetting>("manual.is_on", "true").value, 1.0);
  EXPECT_EQ(action<ManualSetting>("manual.steer", "-0.5").value, -0.5);
  EXPECT_EQ(action<ManualSetting>("manual.throttle", "1").what, ManualSetting::What::kThrottle);
  const sim::Fault ice = *sim::fault_named("ice_patch");
  const auto given = action<FaultSwitch>("fault.ice_patch", "+1.5*0.9");
  EXPECT_EQ(given.to, FaultSwitch::To::kAsGiven);
  EXPECT_EQ(given.event.fault, ice);
  EXPECT_EQ(given.event.duration, 1.5);
  EXPECT_EQ(given.event.strength, 0.9);
  EXPECT_EQ(action<FaultSwitch>("fault.ice_patch", "true").to, FaultSwitch::To::kOn);
  EXPECT_EQ(action<FaultSwitch>("fault.ice_patch", "false").to, FaultSwitch::To::kOff);
}

TEST(Setting, IsRefusedInOneSentence) {
  EXPECT_EQ(refusal("latency_ms", "900"), "latency_ms: got 900, expected a number in [0, 500] ms");
  EXPECT_EQ(refusal("run.pace", "nan"), "run.pace: got nan, expected a number in [0.05, 20]");
  EXPECT_EQ(refusal("manual.steer", "-7"), "manual.steer: got -7, expected a number in [-1, 1]");
  EXPECT_EQ(refusal("manual.steer", "left"), "manual.steer: got left, expected a number in [-1, 1]");
  EXPECT_EQ(refusal("manual.is_on", "1"), "manual.is_on: got 1, expected true or false");
  EXPECT_EQ(refusal("track", "oval"), "track: is fixed when a run starts");
  EXPECT_TRUE(refusal("fault.ice_patch", "+1.5*9").starts_with("fault.ice_patch: got +1.5*9"));
  for (const std::string name : {"", "nonsense", "fault.", "fault.nonsense", "manual.", "manual.gear"})
    EXPECT_NE(refusal(name, "false"), "") << name;
}

using What = ManualSetting::What;

model::Measurement at(double time, double speed) { return {.time = time, .speed = speed}; }

TEST(ManualDrive, IsOffUntilItIsSwitchedOn) {
  ManualDrive drive;
  EXPECT_FALSE(drive.is_on());
  drive.set({What::kThrottle, 0.5});
  EXPECT_FALSE(drive.is_on());
  drive.set({What::kIsOn, 1.0});
  EXPECT_TRUE(drive.is_on());
  drive.set({What::kIsOn, 0.0});
  EXPECT_FALSE(drive.is_on());
}

TEST(ManualDrive, SteersByAShareOfTheLock) {
  const model::VehicleParams car = model::road_car_params();
  ManualDrive drive;
  drive.set({What::kSteer, 0.5});
  EXPECT_DOUBLE_EQ(drive.command(at(1.0, 10.0), car).steer, 0.5 * car.steer_limit);
  drive.set({What::kSteer, -1.0});
  EXPECT_DOUBLE_EQ(drive.command(at(1.1, 10.0), car).steer, -car.steer_limit);
}

TEST(ManualDrive, BrakesGentlyWhenThePersonIsSilent) {
  const model::VehicleParams car = model::udacity_params();
  ManualDrive drive;
  drive.set({What::kThrottle, 0.8});
  EXPECT_EQ(drive.command(at(5.0, 20.0), car).throttle, 0.8);
  EXPECT_EQ(drive.command(at(5.9, 20.0), car).throttle, 0.8);
  const double silent = drive.command(at(6.1, 20.0), car).throttle;
  EXPECT_LT(silent, 0.0);
  EXPECT_GT(silent, -car.brake_throttle_limit);
  EXPECT_EQ(drive.command(at(6.2, 0.0), car).throttle, 0.0) << "at a standstill nothing is left to brake";
  drive.set({What::kThrottle, 0.3});
  EXPECT_EQ(drive.command(at(6.3, 20.0), car).throttle, 0.3);
}

TEST(ManualDrive, PassesANegativePedalOnNearStandstillOnly) {
  const model::VehicleParams car = model::udacity_params();
  ManualDrive drive;
  drive.set({What::kThrottle, -1.0});
  EXPECT_DOUBLE_EQ(drive.command(at(1.0, 20.0), car).throttle, -car.brake_throttle_limit);
  EXPECT_EQ(drive.command(at(1.1, 0.5), car).throttle, -1.0) << "the reverse gear";
}

TEST(ManualDrive, KeepsTheWheelInANewRunAndCountsItsTimeAnew) {
  const model::VehicleParams car = model::udacity_params();
  ManualDrive drive;
  drive.set({What::kIsOn, 1.0});
  drive.set({What::kThrottle, 0.4});
  (void)drive.command(at(50.0, 10.0), car);
  drive.restart();
  EXPECT_TRUE(drive.is_on());
  EXPECT_EQ(drive.command(at(0.5, 10.0), car).throttle, 0.4);
  EXPECT_LT(drive.command(at(1.5, 10.0), car).throttle, 0.0);
}

}  // namespace
}  // namespace chicane::run
