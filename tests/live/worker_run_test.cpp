// SPDX-License-Identifier: MIT
#include "chicane/live/worker_run.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane::live {
namespace {

using Json = nlohmann::json;

scenario::Scenario short_run() { return test::scenario_of({{"track", "oval"}, {"laps", "1"}}); }

class WorkerRuns : public testing::Test {
 protected:
  void start(const scenario::Scenario& scenario) {
    run = std::move(*WorkerRun::create(scenario, [this](std::string_view bytes, bool binary) {
      if (!binary) texts.emplace_back(bytes);
    }));
    ASSERT_TRUE(run->connect());
  }
  /// Lets the clock go on, and the page take everything.
  void pass(double seconds, double turn = 0.01) {
    for (const double end = clock + seconds; clock < end; clock += turn) {
      run->advance(clock, [] { return true; });
      run->acknowledge(1000);
    }
  }
  void set(const std::string& name, const Json& value) {
    Json parameter{{"name", name}, {"value", value}};
    if (value.is_number()) parameter["type"] = "float64";
    run->receive(Json{{"op", "setParameters"}, {"parameters", {parameter}}, {"id", "1"}}.dump(), false);
  }
  Json page() { return Json::parse(run->get("/run.json")->bytes); }

  std::unique_ptr<WorkerRun> run;
  std::vector<std::string> texts;
  double clock = 100.0;
};

TEST_F(WorkerRuns, AreThoseOfTheProgramBitForBitAtWhateverPace) {
  const telemetry::RunSummary expected = test::drive(short_run());
  ASSERT_TRUE(expected.completed);
  for (const double pace : {1.0, 20.0}) {
    start(short_run());
    if (pace != 1.0) set("run.pace", pace);
    pass(0.02);
    EXPECT_TRUE(page()["state_hash"].is_null());
    pass(expected.duration / pace + 1.0);
    EXPECT_EQ(page()["state_hash"], fmt::format("{:016x}", expected.state_hash)) << pace;
    EXPECT_EQ(page()["laps"], 1);
    EXPECT_GT(run->loop().time(), expected.duration) << "it drives on";
  }
}

TEST_F(WorkerRuns, FollowTheClockAndSkipWhatTheyMiss) {
  start(short_run());
  pass(2.0);
  EXPECT_NEAR(run->loop().time(), 2.0, 0.05);
  clock += 50.0;  // the browser had let it sleep
  int cycles = 0;
  run->advance(clock, [&] { return ++cycles < 5; });
  EXPECT_EQ(cycles, 5);
  EXPECT_LT(run->loop().time(), 2.5);
  pass(1.0);
  EXPECT_NEAR(run->loop().time(), 3.2, 0.15);
}

TEST_F(WorkerRuns, PauseStepAndGoOn) {
  start(short_run());
  pass(0.5);
  run->receive(std::string("\x02\0\0\0\0\x07\0\0\0\x03\0\0\0cdr\0\1\0\0\1", 21), true);  // "/pause" with true
  pass(0.1);
  const double time = run->loop().time();
  pass(1.0);
  EXPECT_EQ(run->loop().time(), time);
  run->receive(std::string("\x02\1\0\0\0\x08\0\0\0\x03\0\0\0cdr\0\1\0\0", 20), true);  // "/step"
  pass(0.1);
  EXPECT_NEAR(run->loop().time(), time + run->loop().scenario().control_period, 1e-9);
  run->receive(std::string("\x02\0\0\0\0\x09\0\0\0\x03\0\0\0cdr\0\1\0\0\0", 21), true);
  pass(1.0);
  EXPECT_NEAR(run->loop().time(), time + 1.0, 0.1);
}

TEST_F(WorkerRuns, BuildAnotherRunWhenATrackIsChosenAndSayWhyTheyCannot) {
  start(short_run());
  pass(1.0);
  set("track", "nowhere");
  EXPECT_NE(texts.end()[-2].find("nowhere"), std::string::npos);
  set("track", "lakeside");
  pass(0.5);
  EXPECT_EQ(run->loop().track().name(), "lakeside");
  EXPECT_LT(run->loop().time(), 0.6);
  EXPECT_NE(run->get("/schema.json")->shared->find("lakeside"), std::string::npos);
}

class InWorker : public testing::Test {
 protected:
  std::vector<std::string> sent, events;
  bool accepts = true;
  net::Server* started = nullptr;
  WorkerServer server{
      {.on_start = [this](net::Server& self) { started = &self; },
       .on_upgrade =
           [this](const net::UpgradeRequest& request) {
             EXPECT_TRUE(request.may_control);
             return net::UpgradeAnswer{.accept = accepts, .endpoint = 7};
           },
       .on_open = [this](net::ConnectionId,
                         int endpoint) { events.push_back("open " + std::to_string(endpoint)); },
       .on_message = [this](net::ConnectionId, int, std::string_view bytes,
                            bool) { events.emplace_back(bytes); },
       .on_close = [this](net::ConnectionId, int, std::string_view) { events.emplace_back("close"); },
       .on_get = [](std::string_view path) -> std::optional<net::Content> {
         if (path != "/page") return std::nullopt;
         return net::Content{.bytes = "content"};
       }},
      [this](std::string_view bytes, bool) { sent.emplace_back(bytes); }};

  void say(const std::string& text, net::Delivery delivery = net::Delivery::kReliable,
           std::uint32_t topic = 0) {
    server.send(WorkerServer::kPage, std::make_shared<const std::string>(text), false, delivery, topic);
  }
};

TEST_F(InWorker, ConnectsThePageAndConnectsItAnew) {
  EXPECT_EQ(started, &server);
  say("nobody is there");
  server.receive("nor here", false);
  EXPECT_TRUE(server.connect());
  server.receive("hello", false);
  EXPECT_TRUE(server.connect());
  server.close(WorkerServer::kPage, 1000, "");
  server.close(WorkerServer::kPage, 1000, "");
  EXPECT_EQ(events, (std::vector<std::string>{"open 7", "hello", "close", "open 7", "close"}));
  EXPECT_TRUE(sent.empty());
  accepts = false;
  EXPECT_FALSE(server.connect());
  EXPECT_EQ(server.get("/page")->bytes, "content");
  EXPECT_FALSE(server.get("/other"));
}

TEST_F(InWorker, HoldsBackWhatThePageHasNotTakenAndOfFramesTheNewest) {
  ASSERT_TRUE(server.connect());
  for (std::size_t i = 0; i < WorkerServer::kInFlight; ++i) say("first");
  say("lap");
  for (const char* frame : {"a", "b", "c"}) say(frame, net::Delivery::kNewest, 1);
  say("other", net::Delivery::kNewest, 2);
  EXPECT_EQ(sent.size(), WorkerServer::kInFlight);
  EXPECT_EQ(server.waiting(WorkerServer::kPage), WorkerServer::kInFlight + 3);
  server.acknowledge(2);
  EXPECT_EQ(std::vector(sent.end() - 2, sent.end()), (std::vector<std::string>{"lap", "c"}));
  server.acknowledge(1000);
  EXPECT_EQ(sent.back(), "other");
  EXPECT_EQ(server.waiting(WorkerServer::kPage), 1U);
}

}  // namespace
}  // namespace chicane::live
