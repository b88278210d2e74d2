// SPDX-License-Identifier: MIT
#include "chicane/protocol/udacity_codec.hpp"

#include <clocale>
#include <nlohmann/json.hpp>

#include "chicane/base/math.hpp"
#include "protocol/hostile_telemetry.hpp"
#include "support/chicane_test.hpp"
#include "support/comma_locale.hpp"
#include "support/expect_said.hpp"

namespace chicane::protocol {
namespace {

using test::Hostile;
using test::hostile_messages;
using test::kRealTelemetry;
using test::with;

constexpr double kFullLock = degrees_to_radians(25.0);

/// Why a message is refused; empty where it is not.
template <class Message>
std::string reason_of(const Message& message) {
  const auto* broken = std::get_if<UdacityBroken>(&message);
  return broken == nullptr ? "" : broken->reason;
}

TEST(UdacityTelemetry, ReadsARealMessage) {
  const auto message = parse_telemetry(kRealTelemetry);
  const auto* measurement = std::get_if<model::Measurement>(&message);
  ASSERT_NE(measurement, nullptr);
  EXPECT_DOUBLE_EQ(measurement->x, -40.62008);
  EXPECT_DOUBLE_EQ(measurement->y, 108.7301);
  EXPECT_DOUBLE_EQ(measurement->psi, 3.733667);
  EXPECT_DOUBLE_EQ(measurement->speed, 2.995219e-06 * 0.44704);
  EXPECT_EQ(measurement->waypoint_count, 6);
  EXPECT_DOUBLE_EQ(measurement->waypoints[5].x(), -107.7717);
  EXPECT_DOUBLE_EQ(measurement->waypoints[5].y(), 50.57938);
}

TEST(UdacityTelemetry, WritesARealMessageByteForByte) {
  model::Measurement measurement = std::get<model::Measurement>(parse_telemetry(kRealTelemetry));
  // The message's two yaws were rounded separately from one angle: 3.7336667 rounds to both.
  measurement.psi = 3.7336667;
  EXPECT_EQ(encode_telemetry(measurement), kRealTelemetry);
}

TEST(UdacityTelemetry, SteeringIsPositiveToTheRightAndSpeedInMilesPerHour) {
  const auto message = parse_telemetry(with(R"("steering_angle":0,"throttle":0,"speed":2.995219E-06)",
                                            R"("steering_angle":0.25,"throttle":1,"speed":100)"));
  const auto& measurement = std::get<model::Measurement>(message);
  EXPECT_DOUBLE_EQ(measurement.steer, -0.25);
  EXPECT_DOUBLE_EQ(measurement.throttle, 1.0);
  EXPECT_DOUBLE_EQ(measurement.speed, 44.704);
}

TEST(UdacityTelemetry, OwnMessagesComeBackAsTheyWere) {
  model::Measurement sent{.x = -123.4567,
                          .y = 1e-5,
                          .psi = -0.5,
                          .speed = 44.7,
                          .steer = 0.1,
                          .throttle = -1.0,
                          .waypoint_count = 2};
  sent.waypoints[0] = Vec2{0.5, 3.0};
  sent.waypoints[1] = Vec2{1.0, -2.0};
  const auto message = parse_telemetry(encode_telemetry(sent));
  const auto& received = std::get<model::Measurement>(message);
  constexpr double kSevenDigits = 5e-5;  // of numbers below 1000
  EXPECT_NEAR(received.x, sent.x, kSevenDigits);
  EXPECT_NEAR(received.y, sent.y, 1e-11);
  EXPECT_NEAR(received.psi, sent.psi + kTwoPi, 1e-6);  // the wire has [0, 2π)
  EXPECT_NEAR(received.speed, sent.speed, kSevenDigits);
  EXPECT_NEAR(received.steer, sent.steer, 1e-7);
  EXPECT_EQ(received.throttle, 0.0);  // the original reports braking as 0
  EXPECT_EQ(received.waypoint_count, 2);
  EXPECT_EQ(received.waypoints[1], sent.waypoints[1]);
}

TEST(UdacityTelemetry, PacketsAreToldApart) {
  EXPECT_TRUE(std::holds_alternative<UdacityManual>(parse_telemetry(R"(42["telemetry",null])")));
  EXPECT_EQ(encode_manual_telemetry(), R"(42["telemetry",null])");
  EXPECT_EQ(encode_manual(), R"(42["manual",{}])");
  for (const auto& [text, packet] : {std::pair{"0{\"sid\":1}", UdacityPacket::kOpen},
                                     {"1", UdacityPacket::kClose},
                                     {"2", UdacityPacket::kPing},
                                     {"2probe", UdacityPacket::kPing},
                                     {"3", UdacityPacket::kPong},
                                     {"40", UdacityPacket::kConnect},
                                     {"40{}", UdacityPacket::kConnect},
                                     {"41", UdacityPacket::kDisconnect},
                                     {"5", UdacityPacket::kIgnored},
                                     {"43[]", UdacityPacket::kIgnored}})
    EXPECT_EQ(std::get<UdacityPacket>(parse_telemetry(text)), packet) << text;
  const std::string acknowledged = std::string("4217") + (kRealTelemetry + 2);
  EXPECT_TRUE(std::holds_alternative<model::Measurement>(parse_telemetry(acknowledged)))
      << "stock clients may ask for an acknowledgement";
}

TEST(UdacityTelemetry, OtherScenesAreNamed) {
  test::expect_said(
      [](const std::string& event) {
        const auto message = parse_telemetry("42[" + event + "]");
        return std::get<UdacityForeign>(message).what;
      },
      {{R"("telemetry",{"cte":"0.76","speed":"0.4","steering_angle":"0","image":"x"})", "PID Controller"},
       {R"("telemetry",{"steering_angle":"0,0","throttle":"0","speed":"0","image":"x"})",
        "Behavioral Cloning"},
       {R"("telemetry",{"x":1,"y":2,"s":3,"d":4,"yaw":5,"speed":6,"sensor_fusion":[]})", "Path Planning"},
       {R"("telemetry",{"sensor_measurement":"L 1 2"})", "Kalman Filters"},
       {R"("telemetry",{"sense_x":"1","sense_observations_x":"1 2"})", "Kidnapped Vehicle"},
       {R"("telemetry",{"x":1,"y":2,"z":3,"yaw":4,"velocity":5})", "System Integration"},
       {R"("hello",{})", "the event \"hello\""}});
}

/// Telemetry of a car that stands at the origin and sees nothing, but for these fields.
std::string telemetry_with(nlohmann::json fields) {
  nlohmann::json data{{"ptsx", nlohmann::json::array()},
                      {"ptsy", nlohmann::json::array()},
                      {"psi", 0},
                      {"x", 0},
                      {"y", 0},
                      {"steering_angle", 0},
                      {"throttle", 0},
                      {"speed", 0}};
  data.update(fields);
  return "42" + nlohmann::json{"telemetry", data}.dump();
}

TEST(UdacityTelemetry, FewWaypointsAreTheControllersBusiness) {
  for (int count = 0; count < 3; ++count) {
    const std::vector<int> points(static_cast<std::size_t>(count), 1);
    const auto message = parse_telemetry(telemetry_with({{"ptsx", points}, {"ptsy", points}}));
    ASSERT_TRUE(std::holds_alternative<model::Measurement>(message)) << count;
    EXPECT_EQ(std::get<model::Measurement>(message).waypoint_count, count);
  }
}

TEST(UdacityTelemetry, HostileMessagesAreRefusedInWordsThatNameTheField) {
  const std::vector<Hostile> list = hostile_messages();
  EXPECT_GE(list.size(), 60U);
  for (const Hostile& hostile : list) {
    const std::string reason = reason_of(parse_telemetry(hostile.text));
    EXPECT_NE(reason, "") << hostile.text.substr(0, 120);
    EXPECT_THAT(reason, HasSubstr(hostile.words)) << hostile.text.substr(0, 120);
    EXPECT_LT(reason.size(), 250U) << hostile.text.substr(0, 120);
  }
  const std::string text = kRealTelemetry;
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_FALSE(std::holds_alternative<model::Measurement>(parse_telemetry(text.substr(0, size)))) << size;
}

TEST(UdacityCodec, DoesNotDependOnTheLocale) {
  const test::CommaLocale comma;
  if (!comma.is_set()) GTEST_SKIP() << "the Debian package locales is not installed";
  EXPECT_EQ(std::localeconv()->decimal_point, std::string(","));
  const auto message = parse_telemetry(kRealTelemetry);
  const auto& measurement = std::get<model::Measurement>(message);
  EXPECT_DOUBLE_EQ(measurement.x, -40.62008);
  EXPECT_THAT(encode_telemetry(measurement), HasSubstr("\"x\":-40.62008"));
  EXPECT_THAT(encode_steer({.steer = -0.1, .throttle = 0.5}, {}, {}), HasSubstr("\"throttle\":0.5"));
}

controller::Plan straight_plan(int size) {
  controller::Plan plan;
  plan.size = size;
  plan.reference_size = size;
  for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) {
    plan.points[i] = {.x = 10.0, .y = 20.0 + static_cast<double>(i), .command = {}};
    plan.reference[i] = Vec2{9.0, 20.0 + static_cast<double>(i)};
  }
  return plan;
}

TEST(UdacitySteerReply, HasAllSixFieldsInTheOrderEveryControllerSends) {
  EXPECT_EQ(encode_steer({}, {}, {}),
            R"(42["steer",{"mpc_x":[],"mpc_y":[],"next_x":[],"next_y":[],"steering_angle":0,"throttle":0}])");
}

TEST(UdacitySteerReply, SteeringLeftIsNegativeAndAShareOf25Degrees) {
  const auto field = [](const model::Command& command, const char* key) {
    return nlohmann::json::parse(encode_steer(command, {}, {}).substr(2))[1][key].get<double>();
  };
  EXPECT_DOUBLE_EQ(field({.steer = kFullLock}, "steering_angle"), -1.0);
  EXPECT_DOUBLE_EQ(field({.steer = -0.5 * kFullLock}, "steering_angle"), 0.5);
  EXPECT_DOUBLE_EQ(field({.steer = 3.0}, "steering_angle"), -1.0);
  EXPECT_DOUBLE_EQ(field({.throttle = -0.25}, "throttle"), -0.25);
  EXPECT_DOUBLE_EQ(field({.throttle = 7.0}, "throttle"), 1.0);
}

TEST(UdacitySteerReply, LinesAreSeenFromTheCarAtReceipt) {
  const controller::Plan plan = straight_plan(3);
  const std::string text = encode_steer({}, plan, {.x = 10.0, .y = 18.0, .psi = 0.5 * kPi});  // facing north
  EXPECT_THAT(text, HasSubstr(R"("mpc_x":[2.000,3.000,4.000],"mpc_y":[)"));
  EXPECT_THAT(text, HasSubstr(R"("next_y":[1.000,1.000,1.000])"));  // one metre to the left
}

TEST(UdacitySteerReply, LongLinesAreThinnedAndNonFinitePointsNeverSent) {
  controller::Plan plan = straight_plan(controller::Plan::kCapacity);
  const auto reply = parse_reply(encode_steer({}, plan, {}));
  EXPECT_LE(std::get<UdacitySteer>(reply).plan.size(), static_cast<std::size_t>(kMaxUdacityLine));
  EXPECT_GE(std::get<UdacitySteer>(reply).plan.size(), static_cast<std::size_t>(kMaxUdacityLine) / 2);
  plan = straight_plan(5);
  plan.points[2].x = std::numeric_limits<double>::quiet_NaN();
  plan.reference[0].y() = std::numeric_limits<double>::infinity();
  const auto cut = parse_reply(encode_steer({}, plan, {}));
  EXPECT_EQ(std::get<UdacitySteer>(cut).plan.size(), 2U);
  EXPECT_TRUE(std::get<UdacitySteer>(cut).reference.empty());
}

TEST(UdacityReplyFromController, IsReadAsTheSimulatorDoes) {
  const auto reply = parse_reply(
      R"(42["steer",{"steering_angle":-0.5,"throttle":7,"next_x":[1],"next_y":[2,3],"mpc_x":[],"mpc_y":[],"more":"?"}])");
  const auto* steer = std::get_if<UdacitySteer>(&reply);
  ASSERT_NE(steer, nullptr);
  EXPECT_DOUBLE_EQ(steer->command.steer, 0.5 * kFullLock);
  EXPECT_DOUBLE_EQ(steer->command.throttle, 1.0);
  EXPECT_EQ(steer->reference.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<UdacityManual>(parse_reply(R"(42["manual",{}])")));
  EXPECT_EQ(std::get<UdacityPacket>(parse_reply("0{\"sid\":\"x\"}")), UdacityPacket::kOpen);
}

/// A steer event with these four lists, in the order next_x, next_y, mpc_x, mpc_y; "" leaves a key out.
std::string steer_with(const std::array<std::string, 4>& lists) {
  constexpr std::array kKeys{"next_x", "next_y", "mpc_x", "mpc_y"};
  std::string text = R"(42["steer",{"steering_angle":0.25,"throttle":0.5)";
  for (std::size_t i = 0; i < lists.size(); ++i)
    if (!lists[i].empty()) text += std::string(",\"") + kKeys[i] + "\":" + lists[i];
  return text + "}]";
}

TEST(UdacityReplyFromController, TakesEveryShapeOfTheLinesThatTheOriginalTakes) {
  struct Shape {
    std::array<std::string, 4> lists;
    std::size_t reference, plan;  // points
  };
  const std::vector<Shape> taken{
      {{"[1,2]", "[3,4]", "[5]", "[6]"}, 2, 1},
      {{"[]", "[]", "[]", "[]"}, 0, 0},
      {{"0", "0", "0", "0"}, 0, 0},                            // its loops do not run
      {{"null", "null", "[1]", "[2]"}, 0, 1},                  // nlohmann::json() prints so
      {{R"("")", R"("a")", "true", "false"}, 0, 0},            //
      {{"[]", "", "null", ""}, 0, 0},                          // *_y of an empty *_x is never looked at
      {{"[1]", R"([2,"three",null])", "[1]", "[2,3]"}, 1, 1},  // nor what *_y has more
      {{R"({"a":1,"b":2})", R"({"a":3,"b":4})", "{}", "7"}, 2, 0},
      {{"[1e30]", "[-1E-30]", "[1]", "[2]"}, 1, 1},
      {{test::repeated("1", 2000), test::repeated("2", 2000), "[]", "[]"}, 2000, 0},
  };
  for (const Shape& shape : taken) {
    const auto reply = parse_reply(steer_with(shape.lists));
    const auto* steer = std::get_if<UdacitySteer>(&reply);
    ASSERT_NE(steer, nullptr) << shape.lists[0].substr(0, 30) << ": "
                              << std::get<UdacityBroken>(reply).reason;
    EXPECT_EQ(steer->reference.size(), shape.reference) << shape.lists[0];
    EXPECT_EQ(steer->plan.size(), shape.plan) << shape.lists[2];
    EXPECT_DOUBLE_EQ(steer->command.steer, -0.25 * kFullLock);
  }
  const std::string lines = R"("next_x":[],"next_y":[],"mpc_x":[],"mpc_y":[])";
  for (const std::string& data : {
           R"({"throttle":1,)" + lines + R"(,"steering_angle":0})",             // any order
           "{" + lines + R"(,"steering_angle":1e-7,"throttle":-3E0})",          // exponents, beyond the range
           "{" + lines + R"(,"steering_angle":0,"throttle":0,"note":[null]})",  // more keys
           "{ " + lines + "  ,\n\"steering_angle\" : 0 , \"throttle\" : 0 }",   // white space
       })
    EXPECT_TRUE(std::holds_alternative<UdacitySteer>(parse_reply("42[\"steer\"," + data + "]"))) << data;
}

TEST(UdacityReplyFromController, WhatStallsTheOriginalIsSaidInWords) {
  const std::string rest = R"("next_x":[],"next_y":[],"mpc_x":[],"mpc_y":[])";
  test::expect_said(
      [](const std::string& text) { return reason_of(parse_reply(text)); },
      {{steer_with({"", "[]", "[]", "[]"}), "next_x: missing"},
       {steer_with({"[]", "[]", "", "[]"}), "mpc_x: missing"},
       {steer_with({"[1]", "", "[]", "[]"}), "next_y: missing"},
       {steer_with({"[1,2]", "[1]", "[]", "[]"}), "next_x has 2 points, next_y only 1"},
       {steer_with({"[1]", "0", "[]", "[]"}), "next_x has 1 points, next_y only 0"},
       {steer_with({"[1]", "null", "[]", "[]"}), "next_y only 0"},
       {steer_with({"[]", "[]", R"(["1"])", "[1]"}), R"(mpc_x[0]: got "1", expected a number)"},
       {steer_with({"[]", "[]", "[1]", "[null]"}), "mpc_y[0]: got null"},
       {steer_with({"[[1]]", "[1]", "[]", "[]"}), "next_x[0]: got an array of 1"},
       {steer_with({"[1e39]", "[1]", "[]", "[]"}), "next_x[0]: got 1e+39"},
       {R"(42["steer",{"throttle":0,)" + rest + "}]", "steering_angle: missing"},
       {R"(42["steer",{"steering_angle":0,)" + rest + "}]", "throttle: missing"},
       {R"(42["steer",{"steering_angle":null,"throttle":0,)" + rest + "}]", "steering_angle: got null"},
       {R"(42["steer",{"steering_angle":"0.1","throttle":0,)" + rest + "}]", "steering_angle: got \"0.1\""},
       {R"(42["steer"])", "steer: got nothing, expected an object"},
       {R"(42["steer",{},1])", "name and one value"},
       {R"(42["Steer",{}])", "got \"Steer\", expected \"steer\""},
       {"steer", "does not begin with a digit"},
       {"42[\"steer\",{\"throttle\":nan}]", "throttle: got nan, expected a number"}});
}

TEST(UdacityReplyFromController, SaysWhatWasClamped) {
  const auto clamped = [](const std::string& steering) {
    const auto reply =
        parse_reply(R"(42["steer",{"next_x":[],"next_y":[],"mpc_x":[],"mpc_y":[],"throttle":0,)"
                    R"("steering_angle":)" +
                    steering + "}]");
    return std::get<UdacitySteer>(reply).clamped;
  };
  EXPECT_EQ(clamped("12.5"), "steering_angle: got 12.5, expected a number in [-1, 1]");
  EXPECT_EQ(clamped("-1.0000001"), "") << "rounding";
  EXPECT_EQ(clamped("0.25"), "");
}

TEST(UdacityTelemetry, CarriesTheSimulatorsTimeInTheFieldThatIsNamed) {
  const std::string text = telemetry_with({{"t", 12.5}, {"speed", 9}});
  EXPECT_EQ(std::get<model::Measurement>(parse_telemetry(text, "t")).time, 12.5);
  EXPECT_EQ(std::get<model::Measurement>(parse_telemetry(text)).time, 0.0);
  EXPECT_EQ(reason_of(parse_telemetry(text, "time")), "time: missing");
}

TEST(UdacityTelemetry, RoundingBeyondABorderIsTheBorder) {
  const auto read = [](double throttle, double speed) {
    return std::get<model::Measurement>(
        parse_telemetry(telemetry_with({{"throttle", throttle}, {"speed", speed}})));
  };
  EXPECT_EQ(read(1.0000001, -1e-7).speed, 0.0);
  EXPECT_EQ(read(1.0000001, -1e-7).throttle, 1.0);
  EXPECT_EQ(read(-1.0000001, -0.0).throttle, -1.0);
}

safety::StopPlan stop_of(int size) {
  safety::StopPlan stop;
  stop.size = size;
  for (int i = 0; i < size; ++i) {
    stop.points[static_cast<std::size_t>(i)] = {.time = 7.25 + 0.1 * i,
                                                .distance = 1.5 * i,
                                                .speed = 20.0 - 0.1 * i,
                                                .command = {.steer = 0.25 * kFullLock, .throttle = -0.5}};
  }
  return stop;
}

TEST(UdacityStopPlan, TravelsBetweenTheSixFieldsInTheWiresSignsUnlessItIsNotFinite) {
  safety::StopPlan stop = stop_of(2);
  EXPECT_EQ(encode_steer({.steer = -0.5 * kFullLock}, {}, {}, stop, 7.0),
            R"(42["steer",{"mpc_x":[],"mpc_y":[],"next_x":[],"next_y":[],"steering_angle":0.5,)"
            R"("stop_plan":[[0.25,0,20,-0.25,-0.5],[0.35,1.5,19.9,-0.25,-0.5]],"throttle":0}])");
  stop.points[1].speed = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(encode_steer({}, {}, {}, stop, 7.0), encode_steer({}, {}, {}));
}

TEST(UdacityStopPlan, ComesBackAsItWasCountedFromTheTelemetryAndALongOneWithItsEnds) {
  const auto reply = parse_reply(encode_steer({}, {}, {}, stop_of(30), 7.0));
  const safety::StopPlan& stop = std::get<UdacitySteer>(reply).stop;
  ASSERT_EQ(stop.size, 30);
  EXPECT_NEAR(stop.points[29].time, 3.15, 1e-3);
  EXPECT_NEAR(stop.points[29].distance, 43.5, 1e-3);
  EXPECT_NEAR(stop.points[29].speed, 17.1, 1e-3);
  EXPECT_NEAR(stop.points[29].command.steer, 0.25 * kFullLock, 1e-4);  // left is left
  EXPECT_NEAR(stop.points[29].command.throttle, -0.5, 1e-4);
  const std::string text = encode_steer({}, {}, {}, stop_of(safety::StopPlan::kCapacity), 7.25);
  EXPECT_LT(text.size(), 3000U);
  const auto thinned = parse_reply(text);
  const safety::StopPlan& ends = std::get<UdacitySteer>(thinned).stop;
  ASSERT_EQ(ends.size, kMaxUdacityStop);
  EXPECT_EQ(ends.points[0].time, 0.0);
  EXPECT_NEAR(ends.points[kMaxUdacityStop - 1].distance, 1.5 * (safety::StopPlan::kCapacity - 1), 1e-3);
}

TEST(UdacityStopPlan, WhatCouldNotBePlayedIsRefusedInWords) {
  const auto reply_with = [](const std::string& stop) {
    return parse_reply(
        R"(42["steer",{"mpc_x":[],"mpc_y":[],"next_x":[],"next_y":[],"steering_angle":0,"throttle":0,"stop_plan":)" +
        stop + "}]");
  };
  EXPECT_EQ(std::get<UdacitySteer>(reply_with("[]")).stop.size, 0);
  std::string many = "[[0,0,0,0,0]";
  for (int i = 0; i < kMaxUdacityStop; ++i) many += ",[0,0,0,0,0]";
  test::expect_said([&](const std::string& text) { return reason_of(reply_with(text)); },
                    {{"null", "stop_plan: got null, expected an array of at most 64 points"},
                     {"7", "stop_plan: got 7"},
                     {many + "]", "stop_plan: got an array of 65"},
                     {"[[0,0,0,0]]", "stop_plan[0]: got an array of 4, expected an array of 5 numbers"},
                     {"[7]", "stop_plan[0]: got 7"},
                     {"[[0,0,0,0,null]]", "stop_plan[0][4]: got null, expected a number"},
                     {R"([[0,0,0,0,"1"]])", R"(stop_plan[0][4]: got "1")"},
                     {"[[-1,0,0,0,0]]", "stop_plan[0][0]: got -1"},
                     {"[[6,0,0,0,0]]", "begins after 6 s"},
                     {"[[0,1e9,0,0,0]]", "stop_plan[0][1]: got 1000000000.0"},
                     {"[[0,0,-1,0,0]]", "stop_plan[0][2]: got -1"},
                     {"[[0,0,0,1.01,0]]", "stop_plan[0][3]: got 1.01"},
                     {"[[0,0,0,0,-2]]", "stop_plan[0][4]: got -2"},
                     {"[[1,0,0,0,0],[0,0,0,0,0]]", "stop_plan[1]: time and distance must not fall"},
                     {"[[1,9,0,0,0],[2,8,0,0,0]]", "stop_plan[1]: time and distance must not fall"}});
}

}  // namespace
}  // namespace chicane::protocol
