// SPDX-License-Identifier: MIT
// Sessions with an external simulator, recorded as received and computed again.

#include "chicane/recording/recorder.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/run/make.hpp"
#include "chicane/wire/serve.hpp"
#include "net/raw_socket.hpp"
#include "protocol/hostile_telemetry.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"
#include "telemetry/sample_mcap.hpp"

namespace chicane::live {
namespace {

using telemetry::TemporaryFile;
using test::RawSocket;
using wire::Router;
using wire::ServeOptions;
using wire::UdacityEndpoint;

scenario::Scenario short_run(const std::string& controller) {
  return test::scenario_of({{"controller", controller}, {"time_limit_s", "6"}});
}

/// What a simulator sends during a short drive.
std::vector<std::string> telemetry_of_a_drive() {
  const auto loop = test::loop_of(short_run("pid"));
  std::vector<std::string> messages;
  static_cast<void>(run::run_closed_loop(*loop, {.on_frame = [&](const telemetry::Frame& frame) {
    messages.push_back(protocol::encode_telemetry(frame.measurement));
  }}));
  return messages;
}

/// One client's session: telemetry, some of it broken, a person at the wheel for a moment.
void drive(std::uint16_t port, const std::vector<std::string>& messages) {
  RawSocket client(port);
  client.send(test::unity_handshake(port));
  client.until("\r\n\r\n");
  for (std::size_t i = 0; i < messages.size(); ++i) {
    client.send(RawSocket::masked(messages[i]));
    ASSERT_TRUE(client.frame());
    if (i == 20) client.send(RawSocket::masked(test::with("\"speed\":2.995219E-06", "\"speed\":\"fast\"")));
    if (i == 30) client.send(RawSocket::masked(R"(42["telemetry",null])"));
    if (i == 20 || i == 30) {
      ASSERT_TRUE(client.frame());
    }
  }
}

recording::ReplayReport record_and_verify(const std::string& name, std::chrono::nanoseconds step_budget) {
  const telemetry::TemporaryFile file;
  scenario::Scenario scenario = short_run(name);
  scenario.guard.road = safety::GuardRoad::kWaypoints;  // nobody tells the endpoint its track
  auto controller = run::make_controller(scenario);
  recording::RecorderOptions recording;
  recording.path = file.path();
  recording.scenario = scenario;
  recording.may_wait = true;
  auto recorder = recording::Recorder::create(recording);
  EXPECT_TRUE(recorder);
  ServeOptions options;
  options.server.port = 0;
  options.latency = std::chrono::nanoseconds{0};
  options.quiet_after = std::chrono::milliseconds{10};
  options.step_budget = step_budget;
  options.scenario = scenario;
  run::SettingQueue settings;
  wire::ServeHooks hooks;
  hooks.settings = &settings;
  hooks.on_change = [&](const telemetry::Change& change) { (*recorder)->record(change); };
  hooks.on_frame = [&](const telemetry::Frame& frame) { (*recorder)->record(frame); };
  UdacityEndpoint endpoint(options, std::move(*controller), std::move(hooks));
  Router router(&endpoint, nullptr);
  auto server = net::Server::create(options.server, router.handlers(), {});
  EXPECT_TRUE(server);
  const std::vector<std::string> messages = telemetry_of_a_drive();
  for (int session = 0; session < 2; ++session) {
    const auto limit =
        run::read_setting({.name = "vehicle.steer_limit_deg", .value = session == 0 ? "3" : "20"});
    EXPECT_TRUE(limit && settings.push(*limit));
    drive((*server)->port(), messages);
    std::this_thread::sleep_for(2 * options.quiet_after);
  }
  endpoint.stop();
  server->reset();
  EXPECT_TRUE((*recorder)->finish());
  const Result<recording::ReplayReport> report = recording::verify_recording(file.path());
  EXPECT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->steps, 2 * (messages.size() + 1));
  return report.value_or(recording::ReplayReport{});
}

TEST(RecordedSession, ComesOutTheSameWithBrokenTelemetryAPersonAndASecondClient) {
  for (const char* controller : {"tracking-mpc", "cubic-mpc", "pid", "stanley"}) {
    const recording::ReplayReport report = record_and_verify(controller, std::chrono::seconds{10});
    EXPECT_EQ(report.identical, report.steps) << controller << " " << report.first_difference.value_or(0);
    EXPECT_EQ(report.late, 0U);
  }
}

/// Somewhere, and each of them.
TEST(RecordedSession, ComesOutTheSameWhenDeadlinesAreSpent) {
  for (const char* controller : {"tracking-mpc", "cubic-mpc"}) {
    for (const int nanoseconds : {1, 15'000, 60'000}) {
      const recording::ReplayReport report =
          record_and_verify(controller, std::chrono::nanoseconds{nanoseconds});
      EXPECT_EQ(report.identical, report.steps) << controller << ", " << report.late << " late";
      // Until the car stands, and nothing is solved any more.
      EXPECT_GE(report.late, nanoseconds == 1 ? 20U : 0U);
    }
  }
}

}  // namespace
}  // namespace chicane::live
