// SPDX-License-Identifier: MIT
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/protocol/step_codec.hpp"

#include <bit>
#include <nlohmann/json.hpp>

#include "protocol/cdr_reader.hpp"
#include "protocol/viewer_samples.hpp"
#include "support/chicane_test.hpp"
#include "support/kept_text.hpp"
#include "support/roads.hpp"

namespace chicane::protocol {
namespace {

using test::CdrReader;

const RosTopic& topic(std::string_view name) {
  const auto& topics = ros_topics();
  const auto found =
      std::find_if(topics.begin(), topics.end(), [&](const auto& t) { return t.name == name; });
  EXPECT_NE(found, topics.end()) << name;
  return *found;
}

std::string encode(std::string_view name, const telemetry::Frame& frame = samples::frame(),
                   const Run& run = samples::run()) {
  auto* const encode = topic(name).encode;
  return encode != nullptr ? encode(frame, run) : samples::change();
}

/// The gap of the last third to the limit, as a lap tells it.
double last_gap(const std::string& bytes) {
  CdrReader reader{bytes};
  reader.get<std::uint32_t>();
  for (int i = 0; i < 4; ++i) reader.number();
  reader.get<std::uint8_t>();
  for (int i = 0; i < 7; ++i) reader.number();
  return reader.number();
}

TEST(RosMessages, ALimitThatIsNotKnownSaysWhyAndLapsBeforeItHaveNoGap) {
  protocol::Run run = samples::run();
  ASSERT_TRUE(run.limit.found);
  const auto gap = [&] { return last_gap(encode("/chicane/lap", samples::frame(), run)); };
  run.limit.first_lap = samples::frame().completed_lap.lap;
  EXPECT_TRUE(std::isfinite(gap()));
  ++run.limit.first_lap;
  EXPECT_TRUE(std::isnan(gap())) << "begun with another car";
  run.limit = {.why_not = "the road is open", .first_lap = 4};
  const std::string bytes = encode("/chicane/limit", samples::frame(), run);
  CdrReader reader{bytes};
  EXPECT_EQ(reader.get<std::uint8_t>(), 0);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(std::isnan(reader.number()));
  for (int i = 0; i < 8; ++i) EXPECT_EQ(reader.get<std::uint32_t>(), 0U);
  EXPECT_EQ(reader.text(), "the road is open");
  EXPECT_EQ(reader.get<std::uint32_t>(), 4U);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(reader.get<std::uint32_t>(), 0U) << "no corners, no causes";
  EXPECT_TRUE(reader.is_at_end());
  EXPECT_TRUE(std::isnan(gap()));
}

TEST(RosMessages, DiagnosticsSayInWordsWhoIsInControl) {
  telemetry::Frame frame = samples::frame();
  frame.is_off_track = frame.is_manual = false;
  const auto first = [&] {
    const std::string bytes = encode("/diagnostics", frame);
    CdrReader reader{bytes};
    reader.seconds();
    reader.text();
    EXPECT_EQ(reader.get<std::uint32_t>(), 2U);
    const int level = reader.get<std::uint8_t>();
    EXPECT_EQ(reader.text(), "chicane: controller");
    return std::pair{level, reader.text()};
  };
  const auto judge = [&](controller::Rung rung, controller::GuardReason reason) {
    frame.guard.rung = rung;
    frame.guard.reason = reason;
    frame.situation = telemetry::situation_of(frame, {}, {});
    return first();
  };
  using enum controller::GuardReason;
  EXPECT_EQ(judge(controller::Rung::kShiftedPlan, kNone),
            std::pair(1, std::string("The car follows its last plan")));
  EXPECT_EQ(judge(controller::Rung::kGuardStop, kNoAnswer),
            std::pair(2, std::string("The guard stops the car: the controller has no answer")));
  EXPECT_EQ(judge(controller::Rung::kController, kNone),
            std::pair(1, std::string("the command gate changed the command")));
  frame.guard.gated = false;
  EXPECT_EQ(judge(controller::Rung::kController, kNone).first, 0);
}

TEST(RosMessages, EveryTopicEncodesAFrameFullOfNotANumberAndOfPlansOfAnySize) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  telemetry::Frame frame = samples::frame();
  frame.time = nan;
  frame.truth = {nan, nan, nan, nan, nan, nan, nan};
  frame.measurement.x = frame.measurement.speed = frame.step_time = nan;
  frame.result.command = {nan, nan};
  for (auto& point : frame.result.plan.points) point = {nan, nan, nan, nan, nan, {nan, nan}};
  for (const RosTopic& each : ros_topics()) EXPECT_GE(encode(each.name, frame).size(), 12U) << each.name;
  for (const int size : {-5, 0, controller::Plan::kCapacity, 100'000}) {
    frame.result.plan.size = size;
    const std::string bytes = encode("/chicane/plan", frame);
    CdrReader reader{bytes};
    reader.seconds();
    EXPECT_EQ(reader.get<std::uint32_t>(),
              static_cast<std::uint32_t>(std::clamp(size, 0, controller::Plan::kCapacity)));
  }
}

TEST(RosMessages, ServicesAskABooleanOrATextAndAnswerASentence) {
  using namespace std::string_literals;
  for (const std::string& bytes : {"\0\1\0\0\1"s, "\0\1\0\0\1\0\0\0"s})
    EXPECT_EQ(decode_set_bool(bytes), true);
  EXPECT_EQ(decode_set_bool("\0\0\0\0\0"s), false);
  for (const std::string& bytes : {"\0\1\0\0"s, "\0\1\0\0\2"s, ""s})
    EXPECT_EQ(decode_set_bool(bytes), std::nullopt);
  EXPECT_EQ(decode_ask("\0\1\0\0\3\0\0\0hi\0"s), "hi");
  EXPECT_EQ(decode_ask("\0\0\0\0\0\0\0\3hi\0"s), "hi") << "big endian";
  EXPECT_EQ(decode_ask("\0\1\0\0\1\0\0\0\0"s), "");
  EXPECT_EQ(decode_ask("\0\1\0\0\0\0\0\0"s), "") << "some writers send no zero for an empty text";
  for (const std::string& bytes : {""s, "\0\1\0\0"s, "\0\1\0\0\4\0\0\0hi\0"s, "\0\1\0\0\2\0\0\0hi\0"s,
                                   "\0\1\0\0\377\377\377\377hi\0"s, "\0\2\0\0\3\0\0\0hi\0"s})
    EXPECT_FALSE(decode_ask(bytes)) << bytes.size();
  const std::string answer = encode_service_response(true, "paused");
  CdrReader reader{answer};
  EXPECT_EQ(reader.get<std::uint8_t>(), 1);
  EXPECT_EQ(reader.text(), "paused");
  EXPECT_TRUE(reader.is_at_end());
}

TEST(RosMessages, TimesAreClampedToWhatRosCanHold) {
  EXPECT_EQ(to_nanoseconds(1.5), 1'500'000'000U);
  EXPECT_EQ(to_nanoseconds(-1.0), 0U);
  EXPECT_EQ(to_nanoseconds(std::numeric_limits<double>::quiet_NaN()), 0U);
  EXPECT_EQ(to_nanoseconds(1e300), 2147483647'000'000'000U);
}

TEST(RosMessages, SchemasHoldEveryTypeTheyReferToOnce) {
  for (const RosTopic& each : ros_topics()) {
    ASSERT_FALSE(each.schema.empty()) << each.name;
    std::set<std::string> defined;
    std::istringstream lines{each.schema};
    std::vector<std::string> used;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("MSG: ")) {
        EXPECT_TRUE(defined.insert(line.substr(5)).second) << line;
      } else if (const auto end = line.find_first_of(" ["); line.find('/') < end) {
        used.push_back(line.substr(0, end));
      }
    }
    for (const std::string& name : used)
      EXPECT_TRUE(defined.contains(name)) << each.type << " lacks " << name;
  }
  EXPECT_EQ(ros_schema("no_msgs/msg/Such"), "");
}

/// The dashboard's tests decode the same bytes and compare their values.
TEST(RosMessages, BytesEqualTheFixturesTheBrowserReads) {
  const std::string folder = "protocol/fixtures/ros/";
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const RosTopic& each : ros_topics()) {
    std::string file{each.name.substr(1)};
    std::replace(file.begin(), file.end(), '/', '_');
    file += ".bin";
    list.push_back({{"topic", each.name}, {"type", each.type}, {"file", file}, {"schema", each.schema}});
    test::expect_kept(folder + file, encode(each.name));
  }
  test::expect_kept(folder + "topics.json", list.dump(1) + "\n");
}

TEST(RosMessages, RoadLinesCloseAndKeepTheirWidths) {
  const road::Track track = test::circle_road(50.0, 90, 3.0, 5.0, {});
  const RoadLines lines = road_lines(track, 2.0);
  ASSERT_GE(lines.centre.size(), 157U);  // 2π · 50 m / 2 m
  ASSERT_EQ(lines.left.size(), lines.centre.size());
  EXPECT_LT((lines.left.front() - lines.left.back()).norm(), 1e-6);
  for (std::size_t i = 0; i < lines.centre.size(); ++i) {
    // Counter-clockwise: left is inside. 0.2 m allows for the smoothing of the centre line.
    EXPECT_NEAR(lines.left[i].norm(), 47.0, 0.2);
    EXPECT_NEAR(lines.right[i].norm(), 55.0, 0.2);
  }
}

TEST(StepCodec, KeepsEveryBit) {
  telemetry::Frame frame;
  frame.cycle = 7;
  frame.measurement.x = std::bit_cast<double>(0x7ff8000000000123ULL);  // a not-a-number with a payload
  frame.measurement.waypoint_count = 2;
  frame.measurement.waypoints[1] = {-0.0, 5e-324};
  frame.result.command = {.steer = 0.1, .throttle = -0.3};
  frame.is_manual = true;
  frame.manual = {.steer = -0.2, .throttle = 0.4};
  frame.gate_interval = 0.040000000001;
  frame.longest_interval = 0.42;
  frame.deadline_spent_at = 9;
  frame.begins = true;
  frame.has_measurement = false;
  const auto step = test::good(decode_step(encode_step(frame)));
  EXPECT_EQ(step->cycle, 7U);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(step->measurement.x), 0x7ff8000000000123ULL);
  EXPECT_TRUE(std::signbit(step->measurement.waypoints[1].x()));
  EXPECT_EQ(step->measurement.waypoints[1].y(), 5e-324);
  EXPECT_EQ(step->command.throttle, -0.3);
  ASSERT_TRUE(step->manual);
  EXPECT_EQ(step->manual->steer, -0.2);
  EXPECT_EQ(step->gate_interval, 0.040000000001);
  EXPECT_EQ(step->longest_interval, 0.42);
  EXPECT_EQ(step->deadline_spent_at, 9U);
  EXPECT_TRUE(step->begins);
  EXPECT_FALSE(step->has_measurement);
}

TEST(StepCodec, RefusesEveryShorterAndALongerMessage) {
  telemetry::Frame frame;
  frame.measurement.waypoint_count = 3;
  const std::string bytes = encode_step(frame);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_step(std::string_view(bytes).substr(0, size))) << size;
  EXPECT_FALSE(decode_step(bytes + "x"));
}

TEST(StepCodec, ReadsChangesOfAnyLength) {
  for (const char* name : {"a", "ab", "abc", "abcd", "tracking_mpc.horizon_steps"}) {
    const std::string bytes = encode_change(12.25, 306, name, "20");
    const auto change = test::good(decode_change(bytes));
    EXPECT_EQ(change->name.view(), name);
    EXPECT_EQ(change->value.view(), "20");
    EXPECT_EQ(change->cycle, 306U);
    EXPECT_EQ(change->time, 12.25);
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_FALSE(decode_change(std::string_view(bytes).substr(0, size))) << size;
  }
  EXPECT_FALSE(decode_change(encode_change(0.0, 0, std::string(65, 'x'), "")));
}

}  // namespace
}  // namespace chicane::protocol
