// SPDX-License-Identifier: MIT
// Built with copies of lists that have one line more (CMakeLists.txt), in front of the library's own: what a
// new plant, fault, track format or signal touches is its list, and nothing else.

#include "chicane/base/math.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/sim/plant_registry.hpp"
#include "protocol/decoded_frame.hpp"
#include "protocol/typescript.hpp"
#include "protocol/viewer_samples.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane {
namespace {

TEST(OneMorePlant, IsAChoiceOfTheSchemaAndInItsMessages) {
  scenario::Scenario scenario;
  EXPECT_TRUE(protocol::set_text(scenario, "plant", "cart"));
  EXPECT_THAT(protocol::set_text(scenario, "plant", "carts").error().message,
              HasSubstr("plant: got carts, expected one of udacity, road-car, double-track, cart"));
  EXPECT_TRUE(std::any_of(sim::plants().begin(), sim::plants().end(),
                          [](const auto& each) { return each.meaning == "rolls where its wheels point"; }));
}

TEST(OneMorePlant, IsDriven) {
  const auto loop = test::loop_of(test::scenario_of({{"plant", "cart"}, {"preset", "pid"}}));
  while (loop->time() < 3.0) loop->advance();
  EXPECT_GT(loop->frame().truth.vx, 5.0);
  EXPECT_EQ(loop->frame().truth.vy, 0.0) << "the cart does not slip";
}

TEST(OneMoreFault, IsReadWrittenListedAndSwitched) {
  const auto event = test::good(protocol::parse_fault("fast_speedometer@1+2*3"));
  EXPECT_EQ(protocol::write_fault(*event), "{name: fast_speedometer, at_s: 1, for_s: 2, strength: 3}");
  EXPECT_FALSE(protocol::parse_fault("fast_speedometer@1*5"));
  const auto index = static_cast<std::size_t>(event->fault);
  EXPECT_EQ(protocol::fault_names()[index], "fast_speedometer");
  EXPECT_EQ(protocol::fault_controls()[index].key, "fault.fast_speedometer");
}

TEST(OneMoreFault, HasABitOfItsOwnAndActs) {
  const auto loop = test::loop_of(test::scenario_of({{"preset", "pid"}}));
  while (loop->time() < 3.0) loop->advance();
  EXPECT_TRUE(loop->set_fault("fast_speedometer", true));
  while (!loop->advance()) continue;
  const telemetry::Frame& frame = loop->frame();
  EXPECT_EQ(frame.active_faults, 1U << 18U);
  EXPECT_GT(frame.measurement.speed, 1.3 * frame.truth.vx);
}

TEST(OneMoreTrackFormat, IsFoundReadAndDrivenOn) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(::testing::TempDir()) / "chicane_one_more_track";
  fs::create_directories(folder / "tracks");
  std::ofstream(folder / "tracks/ring.circle") << "80\n";
  ::setenv("CHICANE_DATA_DIR", folder.c_str(), 1);
  const std::vector<protocol::Entry> tracks = protocol::entries(protocol::Shelf::kTrack);
  EXPECT_TRUE(
      std::any_of(tracks.begin(), tracks.end(), [](const auto& each) { return each.name == "ring"; }));
  const auto loop = test::loop_of(test::scenario_of({{"track", "ring"}, {"preset", "pid"}}));
  EXPECT_NEAR(loop->track().centre().length(), kTwoPi * 80.0, 1.0);
  while (loop->time() < 3.0) loop->advance();
  EXPECT_FALSE(loop->frame().is_off_track);
  ::unsetenv("CHICANE_DATA_DIR");
  fs::remove_all(folder);
}

TEST(OneMoreTrackFormat, SaysWhatIsWrongWithAFile) {
  EXPECT_EQ(protocol::parse_track("three", "a.circle").error().message,
            "a.circle:1: radius: got three, expected a number in [10, 1000] m");
}

TEST(OneMoreField, IsInTheDefinitionWithItsMeaning) {
  const std::string schema = protocol::ros_schema("chicane_msgs/msg/Frame");
  EXPECT_NE(schema.find("\nfloat64 half_pace                       # for a test\n"), std::string::npos)
      << schema;
}

TEST(OneMoreField, IsInTheMessageAndMovesNoOther) {
  const test::Values values = test::decoded(protocol::samples::frame());
  EXPECT_EQ(values.at("half_pace"), std::vector{0.125});
  EXPECT_EQ(values.at("active_faults"), std::vector{36.0});         // in front of it
  EXPECT_EQ(values.at("stationarity"), std::vector{0.0009765625});  // behind it
  EXPECT_EQ(values.at("prediction_error_m"), std::vector{0.03125});
}

TEST(OneMoreField, IsInTheTypeOfTheDashboardItsUnknownFrameAndItsColumns) {
  const std::string text = test::typescript_messages();
  for (const char* line :
       {"\n  /** for a test */\n  half_pace: number;\n", "\n  half_pace: NaN,\n", "\n  'half_pace',\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace chicane
