// SPDX-License-Identifier: MIT
// `chicane check` from outside: it judges what `chicane drive` judges.

#include "apps/program_outcome.hpp"
#include "support/chicane_test.hpp"
#include "support/roads.hpp"

namespace chicane {
namespace {

using ::testing::EndsWith;

/// Words of both outputs.
test::Outcome chicane(const std::string& arguments) { return test::chicane_program(arguments + " 2>&1"); }

class CheckCommand : public testing::Test, protected test::Folder {};

/// A closed circle of this radius and half width [m].
std::string circle(double radius, double half_width) {
  std::string text = "x_m,y_m,w_tr_right_m,w_tr_left_m\n";
  const std::string width = "," + std::to_string(half_width);
  for (const Vec2& point : test::circle_points(radius, 60))
    text += std::to_string(point.x()) + "," + std::to_string(point.y()) + width + width + "\n";
  return text;
}

TEST_F(CheckCommand, RefusesTheSettingsThatDriveRefusesInTheSameWords) {
  const std::vector<std::string> refused{
      "--track hairpins --set vehicle.track_width_m=10 --set vehicle.tire_width_m=1",  // a wide car
      "--set track_scale=0.1",
      "--car f1tenth --set track_scale=0.001",
      "--car indy --set plant_params.track_width_m=10",
      "--car bmw-320i --set plant_params.drive_force_n=1000000",  // its model has no such acceleration
      "--car bmw-320i --set plant_params.wheel_radius_m=0.001",
      "--car vw-vanagon --set plant_params.brake_force_n=0.001",
      "--car udacity --set plant_params.mass_kg=900",
      "--preset race --set tracking_mpc.edge_margin_m=3.9 --track hairpins",
      "--preset delay-in-model --set cubic_mpc.latency_ms=50",
      "--track " + write("tight.csv", circle(2.5, 1.5)),
      "--track " + write("narrow.csv", circle(60.0, 0.5)),
      "--fault half_grip@x"};
  for (const std::string& settings : refused) {
    SCOPED_TRACE(settings);
    const test::Outcome driven = chicane("drive --fast --laps 1 --set time_limit_s=0.2 " + settings);
    ASSERT_EQ(driven.code, 2) << driven.out;
    const test::Outcome checked = chicane("check " + settings);
    EXPECT_EQ(checked.code, 2);
    EXPECT_EQ(checked.out, driven.out);
  }
}

TEST_F(CheckCommand, JudgesFilesAsDriveWouldTakeThem) {
  const std::string wide = write("wide.yaml", "plant: road-car\nvehicle:\n  track_width_m: 10\n");
  const std::string narrow = write("narrow.csv", circle(60.0, 0.5));
  const std::string scenario = write("wide_run.yaml", "track: hairpins\nvehicle:\n  track_width_m: 10\n");
  for (const std::string& file : {wide, narrow, scenario}) {
    const test::Outcome checked = chicane("check " + file);
    EXPECT_EQ(checked.code, 2) << file;
    EXPECT_THAT(checked.out, HasSubstr(file + ": track: ")) << file;
    EXPECT_THAT(checked.out, HasSubstr("is not for the car")) << file;
  }
  EXPECT_EQ(chicane("check " + narrow + " --car orca-1-43 --set track_scale=1").code, 0);
}

TEST_F(CheckCommand, PassesWhatShips) {
  const test::Outcome checked =
      chicane("check data/presets/*.yaml data/scenarios/*.yaml data/cars/*.yaml data/tracks/*.csv");
  EXPECT_EQ(checked.code, 0) << checked.out;
  EXPECT_THAT(chicane("check --preset race --car road-car --track oval").out,
              EndsWith("ok, race (tracking-mpc) drives road-car on oval\n"));
}

}  // namespace
}  // namespace chicane
