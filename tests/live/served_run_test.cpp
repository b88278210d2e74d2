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

/// A served run on a thread of its own.
class Serving {
 public:
  explicit Serving(std::optional<road::Track> track = *run::make_track(short_scenario()))
      : served{{.port = 0},
               short_scenario(),
               std::move(*run::make_controller(short_scenario())),
               std::move(track)} {}
  void start(const LiveHooks& hooks) {
    thread_ = std::thread([this, hooks] {
      summary_ = served.run(
          nullptr, hooks, [this](std::uint16_t chosen) { port_ = chosen; }, stop_);
    });
    while (port_ == 0) std::this_thread::yield();
  }
  /// A simulator's run against it.
  wire::SimulateReport simulate(const scenario::Scenario& scenario) {
    const std::string url = "ws://127.0.0.1:" + std::to_string(port_.load());
    return *test::good(
        wire::simulate({.url = url + "/socket.io/?EIO=4&transport=websocket"}, scenario, {}, stop_));
  }
  wire::ServeSummary finish() {
    stop_ = true;
    thread_.join();
    return *test::good(summary_);
  }

  ServedRun served;

 private:
  std::atomic<std::uint16_t> port_{0};
  std::atomic<bool> stop_{false};
  Result<wire::ServeSummary> summary_;
  std::thread thread_;
};

TEST(ServedRun, AnswersOneSimulatorAfterTheOtherAndReportsOnAll) {
  Serving serving;
  EXPECT_EQ(serving.served.description().track, "oval");
  EXPECT_EQ(serving.served.description().mode, "serve");
  std::uint64_t frames = 0;
  serving.start({.on_frame = [&](const telemetry::Frame&) { ++frames; }});
  std::uint64_t answers = 0;
  for (int car = 0; car < 2; ++car) answers += serving.simulate(short_scenario()).answers;
  const wire::ServeSummary summary = serving.finish();
  EXPECT_EQ(summary.connections, 2U);
  EXPECT_GE(summary.answers, answers);
  EXPECT_EQ(summary.run.cycles, frames) << "of both cars";
  EXPECT_EQ(summary.run.track, "oval");
}

TEST(ServedRun, NamesTheRoadThatIsNotTheSimulators) {
  Serving serving;
  std::mutex mutex;
  std::vector<std::string> named;
  double throttle_since = 0.0;
  const auto look = [&](const telemetry::Frame& frame) {
    const std::lock_guard lock(mutex);
    if (!named.empty()) throttle_since = std::max(throttle_since, frame.result.command.throttle);
  };
  const auto hear = [&](std::string_view line) {
    const std::lock_guard lock(mutex);
    if (line.find("another road") != std::string_view::npos) named.emplace_back(line);
  };
  serving.start({.on_frame = look, .say = hear});
  scenario::Scenario other = short_scenario();
  other.track = "speedway";
  other.time_limit = 4.0;  // until waypoints are shown that are not oval's, too
  serving.simulate(other);
  const wire::ServeSummary summary = serving.finish();
  EXPECT_THAT(named, ElementsAre(testing::ContainsRegex("another road than oval, up to [1-9][0-9]* m away")));
  EXPECT_GT(throttle_since, 0.0) << "it is driven";
  EXPECT_EQ(summary.run.track, "");
  EXPECT_EQ(summary.run.off_track_events, 0);
  EXPECT_EQ(summary.run.why_no_limit, "the simulator drives on another road than --track");
}

TEST(ServedRun, SaysWhyThereIsNoLimitWithoutARoad) {
  Serving serving(std::nullopt);
  EXPECT_THAT(serving.served.description().limit.why_not, HasSubstr("--track"));
  const std::atomic<bool> stop{true};
  EXPECT_EQ(test::good(serving.served.run(nullptr, {}, {}, stop))->answers, 0U);
}

}  // namespace
}  // namespace chicane::live
