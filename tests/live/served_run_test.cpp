// SPDX-License-Identifier: MIT
#include "chicane/live/served_run.hpp"

#include <atomic>
#include <mutex>
#include <thread>

#include "chicane/run/make.hpp"
#include "chicane/wire/simulate.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane::live {
namespace {

scenario::Scenario short_scenario() {
  return test::scenario_of(
      {{"preset", "pid"}, {"track", "oval"}, {"laps", "0"}, {"time_limit_s", "2"}, {"latency_ms", "0"}});
}

TEST(ServedRun, AnswersOneSimulatorAfterTheOtherAndReportsOnAll) {
  const scenario::Scenario scenario = short_scenario();
  net::ServerOptions server;
  server.port = 0;
  ServedRun served(server, scenario, std::move(*run::make_controller(scenario)), *run::make_track(scenario));
  EXPECT_EQ(served.description().track, "oval");
  EXPECT_EQ(served.description().mode, "serve");
  std::atomic<std::uint16_t> port{0};
  std::atomic<bool> stop{false};
  Result<wire::ServeSummary> summary;
  int frames = 0;
  std::thread serving([&] {
    summary = served.run(
        nullptr, {.on_frame = [&](const telemetry::Frame&) { ++frames; }},
        [&](std::uint16_t chosen) { port = chosen; }, stop);
  });
  while (port == 0) std::this_thread::yield();
  std::uint64_t answers = 0;
  for (int car = 0; car < 2; ++car) {
    const auto done = test::good(wire::simulate(
        {.url = "ws://127.0.0.1:" + std::to_string(port.load()) + "/socket.io/?EIO=4&transport=websocket"},
        scenario, {}, stop));
    answers += done->answers;
  }
  stop = true;
  serving.join();
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->connections, 2U);
  EXPECT_GE(summary->answers, answers);
  EXPECT_EQ(summary->run.cycles, static_cast<std::uint64_t>(frames)) << "of both cars";
  EXPECT_EQ(summary->run.track, "oval");
}

TEST(ServedRun, NamesTheRoadThatIsNotTheSimulators) {
  scenario::Scenario scenario = short_scenario();
  net::ServerOptions server;
  server.port = 0;
  ServedRun served(server, scenario, std::move(*run::make_controller(scenario)), *run::make_track(scenario));
  std::atomic<std::uint16_t> port{0};
  std::atomic<bool> stop{false};
  Result<wire::ServeSummary> summary;
  std::vector<std::string> lines;
  std::mutex mutex;
  std::thread serving([&] {
    summary = served.run(
        nullptr,
        {.say =
             [&](std::string_view line) {
               const std::lock_guard lock(mutex);
               lines.emplace_back(line);
             }},
        [&](std::uint16_t chosen) { port = chosen; }, stop);
  });
  while (port == 0) std::this_thread::yield();
  scenario.track = "speedway";
  scenario.time_limit = 4.0;  // until waypoints are shown that are not oval's, too
  const auto done = wire::simulate(
      {.url = "ws://127.0.0.1:" + std::to_string(port.load()) + "/socket.io/?EIO=4&transport=websocket"},
      scenario, {}, stop);
  stop = true;
  serving.join();
  ASSERT_TRUE(done && summary);
  EXPECT_EQ(std::count_if(lines.begin(), lines.end(),
                          [](const std::string& line) {
                            return line.find("another road than oval, up to") != std::string::npos;
                          }),
            1);
  EXPECT_EQ(summary->run.track, "");
  EXPECT_EQ(summary->run.off_track_events, 0);
  EXPECT_EQ(summary->run.why_no_limit, "the simulator drives on another road than --track");
}

TEST(ServedRun, SaysWhyThereIsNoLimitWithoutARoad) {
  const scenario::Scenario scenario = short_scenario();
  net::ServerOptions server;
  server.port = 0;
  ServedRun served(server, scenario, std::move(*run::make_controller(scenario)), std::nullopt);
  EXPECT_NE(served.description().limit.why_not.find("--track"), std::string::npos);
  const std::atomic<bool> stop{true};
  const auto summary = test::good(served.run(nullptr, {}, {}, stop));
  EXPECT_EQ(summary->answers, 0U);
}

}  // namespace
}  // namespace chicane::live
