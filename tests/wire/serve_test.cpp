// SPDX-License-Identifier: MIT
#include "chicane/wire/serve.hpp"

#include <nlohmann/json.hpp>
#include <thread>

#include "net/raw_socket.hpp"
#include "protocol/hostile_telemetry.hpp"
#include "support/chicane_test.hpp"
#include "wire/served.hpp"

namespace chicane::wire {
namespace {

using nlohmann::json;
using test::FixedController;
using test::kRealTelemetry;
using test::RawSocket;
using test::Served;
using test::steer_of;
using testing::AnyOf;
using namespace std::chrono_literals;

/// What the controller answers to a telemetry of the real simulator.
json driven(RawSocket& simulator) {
  simulator.send(RawSocket::masked(kRealTelemetry));
  return steer_of(simulator.frame());
}

constexpr double kFullLock = 0.4363323129985824;  // 25° in rad

TEST(Serve, AnswersTheOriginalClientWithExactlyOneCompleteReply) {
  Served served;
  RawSocket unity = served.connect();
  unity.send(RawSocket::masked("2"));
  for (int i = 0; i < 3; ++i) {
    const json data = driven(unity);
    EXPECT_DOUBLE_EQ(data["steering_angle"].get<double>(), -0.1 / kFullLock);
    EXPECT_DOUBLE_EQ(data["throttle"].get<double>(), 0.5);
  }
  EXPECT_FALSE(unity.frame(100ms)) << "nothing unasked: no open packet, no pong, no second reply";
  EXPECT_EQ(served.summary().answers, 3U);
  EXPECT_EQ(served.controller.last().waypoint_count, 6);
}

TEST(Serve, SendsAStopPlanToASimulatorThatAsksForItAndToNobodyElse) {
  Served served;
  for (const bool asks : {false, true}) {
    std::string handshake = test::unity_handshake(served.port());
    if (asks) handshake.replace(handshake.find("transport=websocket"), 19, "stop_plan=1&transport=websocket");
    RawSocket socket(served.port());
    socket.send(handshake);
    ASSERT_THAT(socket.until("\r\n\r\n"), StartsWith("HTTP/1.1 101"));
    const json data = driven(socket);
    ASSERT_EQ(data.contains("stop_plan"), asks) << data;
    EXPECT_EQ(data.size(), asks ? 7U : 6U);
    if (asks) {
      EXPECT_GT(data["stop_plan"].size(), 0U);
    }
    socket.send(RawSocket::masked("41"));
  }
}

TEST(Serve, AnswersEachOfSeveralPipelinedTelemetries) {
  Served served;
  RawSocket client = served.connect();
  const std::string one = RawSocket::masked(kRealTelemetry);
  client.send(one + one + one);
  for (int i = 0; i < 3; ++i) steer_of(client.frame());
  EXPECT_FALSE(client.frame(50ms));
}

TEST(Serve, APersonWhoDrivesIsAnsweredAtOnceAndTheRunBeginsAnewOnce) {
  Served slow(&ServeOptions::latency, 1h), served;
  RawSocket manual = slow.connect(), client = served.connect();
  manual.send(RawSocket::masked(R"(42["telemetry",null])"));
  EXPECT_EQ(manual.frame()->payload, R"(42["manual",{}])") << "without the latency";
  EXPECT_EQ(slow.controller.steps(), 0);
  for (const bool is_manual : {false, true, true, false, false}) {
    client.send(RawSocket::masked(is_manual ? R"(42["telemetry",null])" : std::string(kRealTelemetry)));
    ASSERT_TRUE(client.frame());
  }
  EXPECT_EQ(served.controller.resets(), 2) << "with the connection, and when the person takes over";
}

TEST(Serve, TheLatencyDelaysTheAnswerAndNothingElse) {
  Served served(&ServeOptions::latency, 300ms);
  RawSocket client = served.connect();
  const auto sent = std::chrono::steady_clock::now();
  client.send(RawSocket::masked(kRealTelemetry));
  RawSocket page(served.port());
  page.send("GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(page.rest(), HasSubstr("the page"));
  EXPECT_FALSE(client.frame(0ms)) << "the page came while the answer waited";
  steer_of(client.frame());
  EXPECT_GE(std::chrono::steady_clock::now() - sent, 300ms);
}

TEST(Serve, TellsTheControllerHowLongItsCommandsTake) {
  Served served(&ServeOptions::latency, 20ms);
  RawSocket client = served.connect();
  driven(client);
  EXPECT_DOUBLE_EQ(served.controller.last().delay,
                   0.04);  // nothing measured yet: the latency and a typical turn-around
  double last_time = served.controller.last().time;
  for (int i = 0; i < 12; ++i) {
    std::this_thread::sleep_for(15ms);  // the client's turn-around
    driven(client);
    EXPECT_GE(served.controller.last().time, last_time + 0.035);
    last_time = served.controller.last().time;
  }
  EXPECT_GE(served.controller.last().delay, 0.035 - 0.005);  // without the control step
  EXPECT_GE(served.summary().delay, 0.035 - 0.005);
}

TEST(Serve, CountsByTheTimeThatTelemetryCarries) {
  Served served(&ServeOptions::time_field, "t");
  RawSocket client = served.connect();
  const auto seen_at = [&](const std::string& t) {
    client.send(RawSocket::masked(test::with("\"x\":", "\"t\":" + t + ",\"x\":")));
    steer_of(client.frame());
    return served.controller.last();
  };
  const double first = seen_at("1000").time;
  seen_at("1000.05");
  std::this_thread::sleep_for(100ms);
  EXPECT_NEAR(seen_at("1000.1").time, first + 0.1, 1e-9) << "whatever the wall's clock shows";
  EXPECT_NEAR(served.controller.last().delay, 0.05, 1e-6);
  EXPECT_NEAR(seen_at("3").time, first + 0.15, 1e-6) << "its time went back, the run's goes on";
  EXPECT_TRUE(served.has_logged("the simulator's time jumped"));
  EXPECT_LT(driven(client)["throttle"].get<double>(), 0.0);
  EXPECT_TRUE(served.has_logged("broken telemetry: t: "));
}

TEST(Serve, BeginsAnewAfterASilenceAndOnceMoreWithTheNextTelemetry) {
  for (const bool is_long : {false, true}) {
    Served served(&ServeOptions::forget_after, is_long ? -60s : 60s);  // every gap is long, or none
    RawSocket unity = served.connect();
    int resets = 0;
    for (int i = 0; i < 3; ++i) {
      driven(unity);
      if (i == 0) resets = served.controller.resets();
    }
    EXPECT_EQ(served.controller.resets() - resets, is_long ? 2 : 0);
  }
}

TEST(Serve, EveryHostileMessageIsSafe) {
  Served served(&ServeOptions::quiet_after, 0ns);  // each message comes over a connection of its own
  for (const test::Hostile& hostile : test::hostile_messages()) {
    const std::string shown = hostile.text.substr(0, 100);
    RawSocket client = served.connect();
    client.send(RawSocket::masked(hostile.text));
    client.send(RawSocket::masked(R"(42["telemetry",null])"));  // answered after it, and marks the end
    if (hostile.text.starts_with("42")) {                       // its sender waits for an answer
      const auto frame = client.frame();
      if (frame && frame->opcode == 8) {
        EXPECT_THAT(frame->payload, AnyOf(StartsWith("\x03\xef"), StartsWith("\x03\xf1")))
            << shown;  // 1007, 1009
        continue;
      }
      steer_of(frame);
    }
    const auto last = client.frame();
    ASSERT_TRUE(last) << shown;
    EXPECT_TRUE(last->opcode == 8 || last->payload == R"(42["manual",{}])") << shown;
  }
}

TEST(Serve, BrokenTelemetryStopsTheCarAlongTheRoadThatWasSeen) {
  Served served;
  RawSocket client = served.connect();
  const json driving = driven(client);
  client.send(RawSocket::masked(test::with("\"x\":-40.62008", "\"x\":-40,62008")));
  const json braking = steer_of(client.frame());
  EXPECT_NEAR(braking["steering_angle"].get<double>(), driving["steering_angle"].get<double>(), 0.3);
  EXPECT_LT(braking["throttle"].get<double>(), 0.0);
  EXPECT_FALSE(braking["mpc_x"].empty()) << "the stop is drawn";
  EXPECT_TRUE(served.has_logged("broken telemetry: decimal comma"));
}

TEST(Serve, NamesTheSceneThatIsNotOurs) {
  Served served;
  RawSocket client = served.connect();
  client.send(
      RawSocket::masked(R"(42["telemetry",{"cte":"0.7","speed":"0","steering_angle":"0","image":""}])"));
  EXPECT_LT(steer_of(client.frame())["throttle"].get<double>(), 0.0);
  EXPECT_TRUE(served.has_logged("PID Controller"));
}

/// Answer to another simulator that asks to be served, too.
std::string answer_to_another(const Served& served) {
  RawSocket second(served.port());
  second.send(test::unity_handshake(served.port()));
  return second.rest();
}

TEST(Serve, ASecondSimulatorIsRefusedInWordsWhileTheFirstIsDrivenOrWaitsForItsAnswer) {
  Served served;
  RawSocket first = served.connect();
  driven(first);
  const std::string answer = answer_to_another(served);
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(answer, HasSubstr("another simulator (127.0.0.1:"));
  driven(first);
  ServeOptions options = Served::immediate();
  options.quiet_after = 0ns;
  options.latency = 1h;
  Served slow(options);
  RawSocket waiting = slow.connect();
  waiting.send(RawSocket::masked(kRealTelemetry));
  while (slow.summary().answers == 0) std::this_thread::yield();
  EXPECT_THAT(answer_to_another(slow), StartsWith("HTTP/1.1 503"));
}

TEST(Serve, ASecondSimulatorTakesOverWhenTheFirstIsQuiet) {
  Served served(&ServeOptions::quiet_after, 0ns);
  RawSocket first = served.connect();
  driven(first);
  EXPECT_EQ(served.controller.resets(), 1);
  RawSocket second = served.connect();
  driven(second);
  EXPECT_EQ(served.controller.resets(), 2);
  const auto goodbye = test::good(first.frame());
  EXPECT_EQ(goodbye->opcode, 8);
  EXPECT_THAT(goodbye->payload, HasSubstr("another simulator took over"));
}

TEST(Serve, AGoodbyeMakesRoomBeforeTheConnectionEnds) {
  Served served;
  RawSocket first = served.connect();
  first.send(RawSocket::masked("41") + RawSocket::masked(R"(42["telemetry",null])"));
  EXPECT_EQ(first.frame()->payload, R"(42["manual",{}])");  // so the goodbye has been heard
  RawSocket second = served.connect();
  driven(second);
}

TEST(Serve, AfterADisconnectionTheNextSimulatorIsServedAfresh) {
  Served served;
  {
    RawSocket first = served.connect();
    driven(first);
  }
  EXPECT_TRUE(served.has_logged("is gone"));
  RawSocket second = served.connect();
  driven(second);
  EXPECT_EQ(served.controller.resets(), 2);
}

TEST(Serve, AStockClientThatStaysSilentIsGreeted) {
  for (const std::string version : {"EIO=4", "EIO=3"}) {
    Served served(&ServeOptions::open_after, 10ms);
    RawSocket stock(served.port());
    std::string request = test::unity_handshake(served.port());
    stock.send(request.replace(request.find("EIO=4"), 5, version));
    stock.until("\r\n\r\n");
    const auto open = test::good(stock.frame());
    EXPECT_THAT(open->payload, StartsWith("0{\"sid\":"));
    EXPECT_EQ(json::parse(open->payload.substr(1))["pingInterval"], 25000);
    if (version == "EIO=4") stock.send(RawSocket::masked("40"));
    EXPECT_THAT(stock.frame()->payload, testing::MatchesRegex(version == "EIO=4" ? "40[{]\"sid\":.*" : "40"));
    stock.send(RawSocket::masked("2"));
    EXPECT_EQ(stock.frame()->payload, "3");
    driven(stock);
  }
}

TEST(Serve, SilenceIsReportedAndItsEndToo) {
  Served served(&ServeOptions::silent_after, 10ms);
  RawSocket client = served.connect();
  EXPECT_TRUE(served.has_logged("is connected but sends no telemetry"));
  driven(client);
  EXPECT_TRUE(served.has_logged("again"));
  EXPECT_TRUE(served.has_logged("is it paused"));
}

TEST(Serve, AFloodWithoutWaitingIsEndedInWords) {
  Served served(&ServeOptions::latency, 1h);
  RawSocket client = served.connect();
  for (int i = 0; i < 20; ++i) client.send(RawSocket::masked(kRealTelemetry));
  const auto frame = test::good(client.frame());
  EXPECT_EQ(frame->opcode, 8);
  EXPECT_THAT(frame->payload, HasSubstr("unanswered"));
}

TEST(Serve, EndsWhenAskedAndReportsABusyPort) {
  Served first;
  FixedController controller;
  ServeOptions options = Served::immediate();
  options.server.port = first.port();
  const std::atomic<bool> stop{true};
  EXPECT_THAT(
      serve(options, std::make_unique<test::Borrowed>(controller), {}, nullptr, {}, stop).error().message,
      HasSubstr("is in use by"));
  options.server.port = 0;
  EXPECT_EQ(serve(options, std::make_unique<test::Borrowed>(controller), {}, nullptr, {}, stop)->answers, 0U);
}

}  // namespace
}  // namespace chicane::wire
