// SPDX-License-Identifier: MIT
#include "chicane/wire/simulate.hpp"

#include <mutex>

#include "chicane/net/server.hpp"
#include "chicane/protocol/udacity_codec.hpp"
#include "chicane/run/make.hpp"
#include "chicane/sim/world.hpp"
#include "chicane/wire/serve.hpp"
#include "support/chicane_test.hpp"

namespace chicane::wire {
namespace {

using namespace std::chrono_literals;

const std::string kStraight =
    R"(42["steer",{"mpc_x":[1,2],"mpc_y":[0,0],"next_x":[],"next_y":[],"steering_angle":0,"throttle":1}])";

/// A controller program that answers the n-th message with what `script` says; empty = not at all.
class ScriptedServer {
 public:
  using Script = std::function<std::vector<std::string>(int n, const std::string& message)>;
  explicit ScriptedServer(
      Script script = [](int, const std::string&) { return std::vector{kStraight}; },
      std::chrono::milliseconds latency = 0ms)
      : script_{std::move(script)} {
    auto created = net::Server::create(
        {.port = 0},
        {.on_start = [this](net::Server& server) { server_ = &server; },
         .on_upgrade =
             [this](const net::UpgradeRequest& request) {
               const std::lock_guard lock(mutex_);
               target_ = request.target;
               return net::UpgradeAnswer{.accept = true};
             },
         .on_open = [](net::ConnectionId, int) {},
         .on_message =
             [this, latency](net::ConnectionId id, int, std::string_view bytes, bool) {
               if (bytes == "2") return;
               const std::lock_guard lock(mutex_);
               messages_.emplace_back(bytes);
               if (is_answering_) ++pipelined_;
               is_answering_ = true;
               server_->run_after(latency, [this, id, n = static_cast<int>(messages_.size()) - 1,
                                            text = std::string(bytes)] {
                 is_answering_ = false;
                 for (const std::string& answer : script_(n, text)) server_->send(id, answer, false);
               });
             },
         .on_close = [](net::ConnectionId, int, std::string_view) {}},
        {});
    if (created) owner_ = std::move(*created);
  }
  ~ScriptedServer() { owner_.reset(); }
  ScriptedServer(const ScriptedServer&) = delete;
  ScriptedServer& operator=(const ScriptedServer&) = delete;

  [[nodiscard]] std::string url(const std::string& path = "/socket.io/?EIO=4") const {
    return "ws://127.0.0.1:" + std::to_string(owner_->port()) + path;
  }
  /// What the simulator asked for when it connected.
  [[nodiscard]] std::string target() {
    const std::lock_guard lock(mutex_);
    return target_;
  }
  [[nodiscard]] std::vector<std::string> messages() {
    const std::lock_guard lock(mutex_);
    return messages_;
  }
  /// Telemetry that came before the last one was answered.
  [[nodiscard]] int pipelined() const { return pipelined_; }

 private:
  Script script_;
  std::mutex mutex_;
  std::vector<std::string> messages_;
  std::string target_;
  bool is_answering_ = false;
  std::atomic<int> pipelined_{0};
  net::Server* server_ = nullptr;
  std::unique_ptr<net::Server> owner_;
};

scenario::Scenario short_run(double time_limit) {
  scenario::Scenario scenario;
  scenario.time_limit = time_limit;
  return scenario;
}

/// Runs and collects the log.
struct Outcome {
  Result<SimulateReport> report = fail(ErrorCode::kIo, "not run");
  std::string log;
};

Outcome run(const SimulateOptions& options, const scenario::Scenario& scenario, bool stop_at_once = false) {
  Outcome outcome;
  const std::atomic<bool> stop{stop_at_once};
  outcome.report =
      simulate(options, scenario,
               {.log = [&](std::string_view line) { outcome.log += std::string(line) + "\n"; }}, stop);
  return outcome;
}

/// What comes of a run beside this program.
struct Driven {
  SimulateReport report;
  std::string log;
};
Driven drive(const ScriptedServer& server, const scenario::Scenario& scenario, SimulateOptions options = {}) {
  options.url = server.url();
  const Outcome outcome = run(options, scenario);
  return {*test::good(outcome.report), outcome.log};
}

TEST(Simulate, PassesTheTokenInLockStepAndDrivesByTheAnswers) {
  ScriptedServer server([](int, const std::string&) { return std::vector{kStraight}; }, 50ms);
  const SimulateReport report = drive(server, short_run(1.5)).report;
  EXPECT_EQ(server.pipelined(), 0);
  EXPECT_EQ(report.broken_answers, 0U);
  EXPECT_EQ(report.connections, 1U);
  // A cycle is 50 ms of latency and 20 ms of turn-around, so that 1.5 s hold at most 22.
  EXPECT_GE(report.answers, 5U);
  EXPECT_LE(report.answers, 22U);
  EXPECT_GT(report.run.total.top_speed, 0.5);  // full throttle, as soon as it was picked up
  EXPECT_EQ(report.run.end_reason, "time limit reached");
}

TEST(Simulate, EndsWithAProgramThatNeverAnswersWhereItShall) {
  const ScriptedServer server([](int, const std::string&) { return std::vector<std::string>{}; });
  const SimulateReport report = drive(server, short_run(600.0), {.hopeless_after = 300ms}).report;
  EXPECT_EQ(report.answers, 0U);
  EXPECT_EQ(report.run.end_reason, "no usable answer within 0.3 s");
}

TEST(Simulate, SendsWhatTheOriginalSendsWithAnEchoThatIsOneCycleOld) {
  ScriptedServer server;
  drive(server, short_run(0.5));
  const std::vector<std::string> messages = server.messages();
  ASSERT_GE(messages.size(), 3U);
  EXPECT_THAT(
      messages[0],
      testing::MatchesRegex(
          R"re(42\["telemetry",\{"ptsx":\[[-0-9.,]+\],"ptsy":\[[-0-9.,]+\],"psi_unity":[0-9.]+,)re"
          R"re("psi":[0-9.]+,"x":[-0-9.]+,"y":[-0-9.]+,"steering_angle":0,"throttle":0,"speed":0\}\])re"));
  const auto first = protocol::parse_telemetry(messages[0]);
  EXPECT_EQ(std::get<model::Measurement>(first).waypoint_count, 6);
  // The first answer is picked up when the second telemetry is sampled, and acts before the third.
  EXPECT_THAT(messages[1], HasSubstr("\"throttle\":0,"));
  EXPECT_THAT(messages[2], HasSubstr("\"throttle\":1,"));
}

TEST(Simulate, SendsTheWaypointsOfTheMeasuredPlaceAsDriveDoes) {
  scenario::Scenario noisy = short_run(1.0);
  noisy.sensor.position_noise = 8.0;  // other waypoints than those of the true place, now and then
  const road::Track points = run::make_waypoints(run::make_track(noisy).value()).value();
  ScriptedServer server;
  int frames = 0;
  const std::atomic<bool> stop{false};
  const auto look = [&](const telemetry::Frame& frame) {
    const model::Measurement& seen = frame.measurement;
    model::Measurement expected;
    sim::select_waypoints(points, {.x = seen.x, .y = seen.y, .psi = seen.psi}, noisy.waypoints_sent,
                          expected);
    ASSERT_EQ(seen.waypoint_count, expected.waypoint_count);
    ASSERT_EQ(seen.waypoints[0].x(), expected.waypoints[0].x());
    ++frames;
  };
  ASSERT_TRUE(simulate({.url = server.url()}, noisy, {.on_frame = look}, stop));
  EXPECT_GT(frames, 5);
}

TEST(Simulate, SaysInWordsWhatIsWrongWithAnAnswerAndDrivesOn) {
  const ScriptedServer server([](int n, const std::string&) {
    return n == 0 ? std::vector<std::string>{R"(42["steer",{"steering_angle":0.1,"throttle":null}])"}
                  : std::vector{kStraight, kStraight};
  });
  const auto [report, log] = drive(server, short_run(0.5));
  EXPECT_EQ(report.broken_answers, 1U);
  EXPECT_GE(report.answers, 2U);
  EXPECT_THAT(log, HasSubstr("broken answer: throttle: got null, expected a number (the original"));
  EXPECT_GE(report.extra_answers, 1U) << "that nobody asked for";
  EXPECT_THAT(log, HasSubstr("two loops"));
}

TEST(Simulate, NoticesASilentControllerAndConnectsAnew) {
  const ScriptedServer server(
      [](int n, const std::string&) { return n == 1 ? std::vector<std::string>{} : std::vector{kStraight}; });
  const auto [report, log] =
      drive(server, short_run(1.0), {.retry_after = 20ms, .complain_after = 50ms, .give_up_after = 150ms});
  EXPECT_EQ(report.silences, 1U);
  EXPECT_EQ(report.connections, 2U);
  EXPECT_GE(report.answers, 2U);
  EXPECT_THAT(log, HasSubstr("no answer for 50 ms: the original simulator would wait for ever"));
}

TEST(Simulate, StopsTheCarOfAControllerThatFallsSilentUnlessItHoldsTheLastCommand) {
  for (const safety::Receiver receiver : {safety::Receiver::kStopPlan, safety::Receiver::kHold}) {
    std::optional<std::chrono::steady_clock::time_point> began;
    const ScriptedServer server([&](int, const std::string&) {  // full throttle for 1.2 s
      const auto now = std::chrono::steady_clock::now();
      if (!began) began = now;
      return now - *began < 1200ms ? std::vector{kStraight} : std::vector<std::string>{};
    });
    scenario::Scenario scenario = short_run(5.0);
    scenario.guard.receiver = receiver;
    const auto [report, log] = drive(server, scenario);
    if (receiver == safety::Receiver::kHold) {
      EXPECT_EQ(report.stops, 0U);
      EXPECT_GT(report.run.total.top_speed, 10.0);
      continue;
    }
    EXPECT_GE(report.stops, 1U);
    EXPECT_THAT(log, HasSubstr("no command in time: the car is stopped from "));
    EXPECT_THAT(log, HasSubstr("the car stands, its outermost wheel "));
    EXPECT_THAT(log, HasSubstr("the road's edge: the controller has not answered for "));
  }
}

TEST(Simulate, SaysThatItPlaysStopPlansUnlessItHoldsAsTheOriginal) {
  const auto target = [](safety::Receiver receiver, const std::string& path) {
    ScriptedServer server;
    scenario::Scenario scenario = short_run(0.1);
    scenario.guard.receiver = receiver;
    static_cast<void>(run({.url = server.url(path)}, scenario));
    return server.target();
  };
  EXPECT_EQ(target(safety::Receiver::kStopPlan, "/socket.io/?EIO=4"), "/socket.io/?EIO=4&stop_plan=1");
  EXPECT_EQ(target(safety::Receiver::kStopPlan, "/x"), "/x?stop_plan=1");
  EXPECT_EQ(target(safety::Receiver::kStopPlan, ""), "/?stop_plan=1");
  EXPECT_EQ(target(safety::Receiver::kHold, "/socket.io/?EIO=4"), "/socket.io/?EIO=4");
}

TEST(Simulate, ManualDrivingSendsNull) {
  ScriptedServer server([](int, const std::string& message) {
    return std::vector{message == R"(42["telemetry",null])" ? protocol::encode_manual() : kStraight};
  });
  const auto [report, log] = drive(server, short_run(0.6), {.manual_time = 0.2});
  EXPECT_EQ(server.messages().at(0), R"(42["telemetry",null])");
  EXPECT_THAT(server.messages().back(), HasSubstr("ptsx"));
  EXPECT_GE(report.answers, 1U);
  EXPECT_THAT(log, Not(HasSubstr("did not understand")));
}

TEST(Simulate, WarnsOfAnOpenPacketAndAnswersAPing) {
  ScriptedServer server([](int n, const std::string& message) {
    if (message == "3") return std::vector<std::string>{};
    return n == 0 ? std::vector<std::string>{"0{\"sid\":\"x\"}", "2", kStraight} : std::vector{kStraight};
  });
  EXPECT_THAT(drive(server, short_run(0.3)).log, HasSubstr("open packet"));
  EXPECT_THAT(server.messages(), Contains("3"));
}

TEST(Simulate, SaysThatNobodyAnswers) {
  const Outcome outcome =
      run({.url = "ws://127.0.0.1:1/", .retry_after = 20ms, .lost_after = 100ms}, short_run(1.0));
  EXPECT_EQ(outcome.log,
            "no controller yet: 127.0.0.1:1: Connection refused; trying again\n");  // and only once
  ASSERT_FALSE(outcome.report);
  EXPECT_EQ(outcome.report.error().code, ErrorCode::kIo);
  EXPECT_THAT(outcome.report.error().message, HasSubstr("no controller: 127.0.0.1:1: Connection refused"));
  EXPECT_EQ(run({.url = "http://x"}, short_run(1.0)).report.error().code, ErrorCode::kInvalidArgument);
}

TEST(Simulate, StartsTheControllerAndSurvivesItsDeath) {
  const Outcome outcome = run(
      {.url = "ws://127.0.0.1:1/", .server_command = "kill -SEGV $$", .lost_after = 300ms}, short_run(1.0));
  ASSERT_FALSE(outcome.report);
  EXPECT_THAT(outcome.log, HasSubstr("the controller was ended by signal 11"));
}

TEST(Simulate, EndsWithTheResultsSoFarWhenStopped) {
  const Outcome outcome = run({}, short_run(1.0), true);
  ASSERT_TRUE(outcome.report);
  EXPECT_EQ(outcome.report->run.end_reason, "stopped");
  EXPECT_FALSE(outcome.report->run.completed);
}

TEST(ServeAndSimulate, DriveTheLakesideTogetherOverRealSockets) {
  scenario::Scenario scenario = short_run(4.0);
  auto controller = test::good(run::make_controller(scenario));
  ServeOptions options;
  options.server.port = 0;
  std::string log;
  ServeHooks hooks;
  hooks.log = [&](std::string_view line) { log += std::string(line) + "\n"; };
  UdacityEndpoint endpoint(options, std::move(*controller), std::move(hooks));
  Router router(&endpoint, nullptr);
  auto server = net::Server::create(options.server, router.handlers(), {});
  ASSERT_TRUE(server) << server.error().message;
  const std::string url =
      "ws://127.0.0.1:" + std::to_string((*server)->port()) + "/socket.io/?EIO=4&transport=websocket";
  const Outcome outcome = run({.url = url}, scenario);
  endpoint.stop();
  server->reset();
  ASSERT_TRUE(outcome.report) << outcome.report.error().message;
  EXPECT_EQ(outcome.report->broken_answers, 0U);
  EXPECT_EQ(outcome.report->extra_answers, 0U);
  EXPECT_EQ(endpoint.summary().unusable, 0U);
  EXPECT_EQ(outcome.report->run.off_track_events, 0) << log << outcome.log;
  EXPECT_GT(outcome.report->run.total.top_speed, 5.0);
  // Measured telemetry to actuation: 100 ms of artificial latency, 20 ms of turn-around and what the machine
  // adds.
  EXPECT_GE(endpoint.summary().delay, 0.119);
}

}  // namespace
}  // namespace chicane::wire
