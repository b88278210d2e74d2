// SPDX-License-Identifier: MIT
#include "chicane/protocol/frame_fields.hpp"

#include <cctype>
#include <span>
#include <variant>

#include "protocol/decoded_frame.hpp"
#include "protocol/typescript.hpp"
#include "protocol/viewer_samples.hpp"
#include "support/chicane_test.hpp"
#include "support/kept_text.hpp"

namespace chicane::protocol {
namespace {

using test::decoded;
using test::Values;

std::vector<FrameField> rows() {
  std::vector<FrameField> all;
  for (const FrameGroup& group : frame_groups())
    all.insert(all.end(), group.fields.begin(), group.fields.end());
  return all;
}

TEST(FrameFields, WithoutTruthShowWhatWasMeasuredAndLeaveTheRestUnknown) {
  telemetry::Frame frame = samples::frame();
  frame.has_truth = false;
  frame.is_judged = false;
  const Values values = decoded(frame);
  std::istringstream expected(
      "has_truth 0 x_m 10.1 y_m -20.2 yaw_rad 0.51 vx_mps 29.5 speed_mps 29.5 measured_x_m 10.1 measured_y_m "
      "-20.2 measured_yaw_rad 0.51 measured_speed_mps 29.5 lateral_error_m 0.3 heading_error_rad -0.03");
  double number = 0.0;
  for (std::string name; expected >> name >> number;)
    EXPECT_THAT(values.at(name), ElementsAre(testing::DoubleEq(number))) << name;
  for (const char* name : {"vy_mps", "yaw_rate_radps", "longitudinal_acceleration_mps2",
                           "lateral_acceleration_mps2", "s_m", "edge_distance_m", "lap_time_s"}) {
    EXPECT_TRUE(std::isnan(values.at(name).at(0))) << name;
  }
}

TEST(FrameFields, EachValueHasTheTypeOfItsRowWhateverTheFrameHolds) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  telemetry::Frame broken = samples::frame();
  broken.time = broken.step_time = nan;
  broken.truth = {nan, nan, nan, nan, nan, nan, nan};
  broken.result.report.explanation.cost_term_count = 1'000'000;
  std::istringstream words("builtin_interfaces/Time bool int8 uint8 int32 uint32 uint64 float64 float64[]");
  const std::vector<std::string> types(std::istream_iterator<std::string>{words}, {});
  for (const telemetry::Frame& frame : {telemetry::Frame{}, samples::frame(), broken}) {
    for (const FrameField& row : rows()) EXPECT_EQ(types.at(row.value(frame).index()), row.type) << row.name;
  }
  for (const FrameField& row : rows()) {
    if (row.name == "cost_terms") {
      EXPECT_EQ(std::get<std::span<const double>>(row.value(broken)).size(),
                std::size_t{controller::Explanation::kMaxCostTerms});
    }
  }
}

/// Of a field by its name, in its order.
std::span<const FrameConstant> constants_of(std::string_view name) {
  for (const FrameField& row : rows())
    if (row.name == name) return row.constants;
  return {};
}

template <class Enum, std::size_t N>
void expect_constants(std::string_view field, std::string_view prefix,
                      const std::array<Word<Enum>, N>& words) {
  const std::span<const FrameConstant> found = constants_of(field);
  ASSERT_EQ(found.size(), N) << field;
  for (std::size_t i = 0; i < N; ++i) {
    std::string name{prefix};
    for (const char letter : words[i].name)
      name += static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    EXPECT_EQ(found[i].name, name);
    EXPECT_EQ(found[i].value, static_cast<int>(words[i].value)) << name;
    EXPECT_EQ(found[i].meaning, words[i].sentence) << name;
    EXPECT_EQ(found[i].severity, words[i].severity) << name;
  }
}

TEST(TypeScript, RefusesATypeItDoesNotKnow) {
  EXPECT_THROW(std::ignore = test::typescript("Sample", "geometry_msgs/Point[] points\n"), std::logic_error);
}

TEST(TypeScript, FixturesOfTheDashboardAreUpToDate) {
  test::expect_kept("../web/src/protocol/messages.ts", test::typescript_messages());
}

TEST(FrameFields, HaveAConstantForEverySourceReasonAndStatus) {
  expect_constants("rung", "RUNG_", controller::kRungWords);
  expect_constants("guard_reason", "REASON_", controller::kGuardReasonWords);
  expect_constants("solve_status", "STATUS_", solver::kSolveStatusWords);
}

}  // namespace
}  // namespace chicane::protocol
