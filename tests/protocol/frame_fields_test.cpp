// SPDX-License-Identifier: MIT
#include "chicane/protocol/frame_fields.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <regex>
#include <set>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "protocol/decoded_frame.hpp"
#include "protocol/message_definition.hpp"
#include "protocol/viewer_samples.hpp"

namespace chicane::protocol {
namespace {

using test::decoded;
using test::MessageLine;
using test::Values;

void expect_values(const Values& values, const Values& expected) {
  for (const auto& [name, numbers] : expected) {
    ASSERT_TRUE(values.contains(name)) << name;
    ASSERT_EQ(values.at(name).size(), numbers.size()) << name;
    for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_DOUBLE_EQ(values.at(name)[i], numbers[i]) << name;
  }
}

/// Of samples::frame(), by name.
const Values kSample{{"stamp", {12.25}},
                     {"cycle", {1234567890123.0}},
                     {"time_s", {12.25}},
                     {"has_truth", {1}},
                     {"x_m", {10.0}},
                     {"y_m", {-20.0}},
                     {"yaw_rad", {0.5}},
                     {"vx_mps", {30.0}},
                     {"vy_mps", {-0.4}},
                     {"yaw_rate_radps", {0.25}},
                     {"speed_mps", {std::sqrt(30.0 * 30.0 + 0.4 * 0.4)}},
                     {"longitudinal_acceleration_mps2", {-1.25}},
                     {"lateral_acceleration_mps2", {7.5}},
                     {"measured_x_m", {10.1}},
                     {"measured_y_m", {-20.2}},
                     {"measured_yaw_rad", {0.51}},
                     {"measured_speed_mps", {29.5}},
                     {"s_m", {456.5}},
                     {"lateral_error_m", {0.3}},
                     {"heading_error_rad", {-0.03}},
                     {"edge_distance_m", {1.875}},
                     {"is_off_track", {1}},
                     {"off_track_events", {3}},
                     {"lap", {2}},
                     {"lap_time_s", {4.5}},
                     {"last_lap_time_s", {28.125}},
                     {"steer_asked_rad", {0.02}},
                     {"steer_applied_rad", {0.015}},
                     {"throttle_asked", {0.75}},
                     {"throttle_applied", {-0.5}},
                     {"rung", {1}},
                     {"solve_status", {1}},
                     {"is_gated", {1}},
                     {"has_map", {1}},
                     {"iterations", {7}},
                     {"sweeps", {9}},
                     {"cost", {123.5}},
                     {"step_time_us", {456.0}},
                     {"delay_s", {0.118}},
                     {"speed_reference_mps", {33.0}},
                     {"sight_m", {140.0}},
                     {"tracked_lateral_error_m", {0.31}},
                     {"tracked_heading_error_rad", {-0.02}},
                     {"steer_sent_rad", {0.01}},
                     {"throttle_sent", {0.625}},
                     {"pace", {0.25}},
                     {"is_manual", {1}},
                     {"cost_terms", {0.5, 1.5, 121.5}},
                     {"speed_limiter", {3}},
                     {"speed_limit_mps", {34.5}},
                     {"active_now", {0b10}},
                     {"active_ahead", {0b101010}},
                     {"front_tire_use", {0.875}},
                     {"rear_tire_use", {1.0625}},
                     {"active_faults", {0b100100}},
                     {"stationarity", {0.0009765625}},
                     {"violation", {0.0625}},
                     {"worst_stage", {17}},
                     {"worst_constraint", {4}},
                     {"prediction_error_m", {0.03125}},
                     {"learned_delay_s", {0.0625}},
                     {"learned_delay_sd_s", {0.004}},
                     {"learned_steer_gain", {0.95}},
                     {"learned_steer_gain_sd", {0.02}},
                     {"learned_steer_offset_rad", {-0.03}},
                     {"learned_steer_offset_sd_rad", {0.002}},
                     {"learned_grip", {0.85}},
                     {"learned_grip_sd", {0.01}}};

std::vector<FrameField> rows() {
  std::vector<FrameField> all;
  for (const FrameGroup& group : frame_groups())
    all.insert(all.end(), group.fields.begin(), group.fields.end());
  return all;
}

TEST(FrameFields, CarryWhatTheSampleHolds) { expect_values(decoded(samples::frame()), kSample); }

TEST(FrameFields, SayNoLimitOfTheSpeedThatThePedalContradicts) {
  telemetry::Frame frame = samples::frame();
  road::SpeedLimiter& limiter = frame.result.report.explanation.speed_limiter;
  const auto told = [&](road::SpeedLimiter said, double throttle) {
    limiter = said;
    frame.result.command.throttle = throttle;
    return static_cast<road::SpeedLimiter>(decoded(frame).at("speed_limiter").at(0));
  };
  EXPECT_EQ(told(road::SpeedLimiter::kPower, 1.0), road::SpeedLimiter::kPower);
  EXPECT_EQ(told(road::SpeedLimiter::kPower, 0.2), road::SpeedLimiter::kPartThrottle);
  EXPECT_EQ(told(road::SpeedLimiter::kPartThrottle, 0.2), road::SpeedLimiter::kPartThrottle);
  EXPECT_EQ(told(road::SpeedLimiter::kPartThrottle, 1.0), road::SpeedLimiter::kPower);
  EXPECT_EQ(told(road::SpeedLimiter::kCurvature, 1.0), road::SpeedLimiter::kCurvature);
}

TEST(FrameFields, WithoutTruthShowWhatWasMeasuredAndLeaveTheRestUnknown) {
  telemetry::Frame frame = samples::frame();
  frame.has_truth = false;
  frame.is_judged = false;
  const Values values = decoded(frame);
  expect_values(values, {{"has_truth", {0}},
                         {"x_m", {10.1}},
                         {"y_m", {-20.2}},
                         {"yaw_rad", {0.51}},
                         {"vx_mps", {29.5}},
                         {"speed_mps", {29.5}},
                         {"measured_x_m", {10.1}},
                         {"measured_y_m", {-20.2}},
                         {"measured_yaw_rad", {0.51}},
                         {"measured_speed_mps", {29.5}},
                         {"lateral_error_m", {0.3}},
                         {"heading_error_rad", {-0.03}}});
  for (const char* name : {"vy_mps", "yaw_rate_radps", "longitudinal_acceleration_mps2",
                           "lateral_acceleration_mps2", "s_m", "edge_distance_m", "lap_time_s"}) {
    EXPECT_TRUE(std::isnan(values.at(name).at(0))) << name;
  }
}

TEST(FrameFields, EveryRowIsInTheDefinitionInItsPlaceWithItsTypeAndMeaning) {
  std::vector<MessageLine> expected;
  for (const FrameGroup& group : frame_groups()) {
    const std::size_t first = expected.size();
    for (const FrameField& row : group.fields) {
      const std::string type{row.type.substr(0, row.type.find('['))};
      const std::string array{row.type.substr(type.size())};
      for (const FrameConstant& each : row.constants) {
        expected.push_back(
            {type, "", std::string{each.name}, std::to_string(each.value), std::string{each.meaning}, ""});
      }
      expected.push_back({type, array, std::string{row.name}, "", std::string{row.meaning}, ""});
    }
    ASSERT_LT(first, expected.size()) << group.title;
    expected[first].title = group.title;
  }
  const std::vector<MessageLine> lines = test::message_lines(ros_schema("chicane_msgs/msg/Frame"));
  ASSERT_EQ(lines.size(), expected.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].type + lines[i].array, expected[i].type + expected[i].array) << expected[i].name;
    EXPECT_EQ(lines[i].name, expected[i].name);
    EXPECT_EQ(lines[i].constant, expected[i].constant) << expected[i].name;
    EXPECT_EQ(lines[i].meaning, expected[i].meaning) << expected[i].name;
    if (i > 0) {  // the first title is the message's
      EXPECT_EQ(lines[i].title, expected[i].title) << expected[i].name;
    }
  }
}

TEST(FrameFields, NamesAreSnakeCaseAndUniqueAndTextsAreOneLine) {
  std::set<std::string_view> names;
  for (const FrameField& row : rows()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_TRUE(std::regex_match(std::string{row.name}, std::regex("[a-z][a-z0-9]*(_[a-z0-9]+)*")))
        << row.name;
    EXPECT_EQ(row.meaning.find_first_of("#\n"), std::string_view::npos) << row.name;
    for (const FrameConstant& each : row.constants) {
      EXPECT_TRUE(names.insert(each.name).second) << each.name;
      EXPECT_TRUE(std::regex_match(std::string{each.name}, std::regex("[A-Z][A-Z0-9_]*"))) << each.name;
    }
  }
  for (const FrameGroup& group : frame_groups())
    EXPECT_EQ(group.title.find_first_of("#\n"), std::string_view::npos);
}

TEST(FrameFields, EachValueHasTheTypeOfItsRowWhateverTheFrameHolds) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  telemetry::Frame broken = samples::frame();
  broken.time = broken.step_time = nan;
  broken.truth = {nan, nan, nan, nan, nan, nan, nan};
  broken.result.report.explanation.cost_term_count = 1'000'000;
  const std::vector<std::string> types{"builtin_interfaces/Time",
                                       "bool",
                                       "int8",
                                       "uint8",
                                       "int32",
                                       "uint32",
                                       "uint64",
                                       "float64",
                                       "float64[]"};
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

TEST(FrameFields, HaveAConstantForEverySourceReasonAndStatus) {
  expect_constants("rung", "RUNG_", controller::kRungWords);
  expect_constants("guard_reason", "REASON_", controller::kGuardReasonWords);
  expect_constants("solve_status", "STATUS_", solver::kSolveStatusWords);
}

}  // namespace
}  // namespace chicane::protocol
