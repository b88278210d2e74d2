// SPDX-License-Identifier: MIT
// Built with a copy of protocol/frame_fields.cpp that has one row more (CMakeLists.txt), in front of the
// library's own: what a new signal touches is this table, and nothing else.

#include "protocol/decoded_frame.hpp"
#include "protocol/typescript.hpp"
#include "protocol/viewer_samples.hpp"
#include "support/chicane_test.hpp"

namespace chicane::test {
namespace {

TEST(OneMoreField, IsInTheDefinitionWithItsMeaning) {
  const std::string schema = protocol::ros_schema("chicane_msgs/msg/Frame");
  EXPECT_NE(schema.find("\nfloat64 half_pace                       # for a test\n"), std::string::npos)
      << schema;
}

TEST(OneMoreField, IsInTheMessageAndMovesNoOther) {
  const Values values = decoded(protocol::samples::frame());
  EXPECT_EQ(values.at("half_pace"), std::vector{0.125});
  EXPECT_EQ(values.at("active_faults"), std::vector{36.0});         // in front of it
  EXPECT_EQ(values.at("stationarity"), std::vector{0.0009765625});  // behind it
  EXPECT_EQ(values.at("prediction_error_m"), std::vector{0.03125});
}

TEST(OneMoreField, IsInTheTypeOfTheDashboardItsUnknownFrameAndItsColumns) {
  const std::string text = typescript_messages();
  for (const char* line :
       {"\n  /** for a test */\n  half_pace: number;\n", "\n  half_pace: NaN,\n", "\n  'half_pace',\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace chicane::test
