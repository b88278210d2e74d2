// SPDX-License-Identifier: MIT
#include "chicane/live/run_publisher.hpp"

#include "chicane/protocol/schema_json.hpp"
#include "support/chicane_test.hpp"

namespace chicane::live {
namespace {

class Publisher : public testing::Test {
 protected:
  /// A frame with the first fault on or off.
  void drive(bool has_fault) {
    ++frame.cycle;
    frame.active_faults = has_fault ? 1U : 0U;
    publisher.frame(frame);
  }

  wire::ViewerEndpoint viewer{{}};
  std::vector<std::string> noted;
  run::SettingQueue requests;
  LiveSettings settings{{.scenario = {}, .has_world = false}, requests};
  RunLog log{false};
  RunPublisher publisher{
      viewer, settings, {.log = &log, .hooks = {.on_change = [this](const telemetry::Change& change) {
                                        noted.emplace_back(change.value.view());
                                      }}}};
  telemetry::Frame frame;
};

TEST_F(Publisher, TellsOfFaultsThatBeganOrEndedByThemselvesOnly) {
  drive(false);
  drive(true);
  drive(true);
  EXPECT_EQ(noted, (std::vector<std::string>{"true"}));
  drive(false);
  EXPECT_EQ(noted.size(), 2U);
  const auto key = std::string("fault.") + protocol::fault_names().front();
  publisher.change({.name = key, .value = "1@2*3"});
  EXPECT_EQ(noted.size(), 3U);
  drive(true);
  EXPECT_EQ(noted.size(), 3U) << "it was asked for";
}

TEST_F(Publisher, NotesWhatItIsToldInTheLog) {
  log.begin({});
  frame.begins = true;
  publisher.frame(frame);
  publisher.change({.cycle = 1, .time = 0.04, .name = "latency_ms", .value = "60"});
  publisher.lap({.lap = 7});
  const auto known = log.since({});
  ASSERT_TRUE(known) << known.error().message;
  ASSERT_EQ(known->events->size(), 3U);
  EXPECT_TRUE(std::get<RunLog::Step>((*known->events)[0]).begins);
  EXPECT_EQ(std::get<RunLog::Change>((*known->events)[1]).value, "60");
  EXPECT_EQ(std::get<telemetry::CompletedLap>((*known->events)[2]).lap, 7);
}

TEST_F(Publisher, TellsTheEndOnceForEachRun) {
  EXPECT_TRUE(publisher.end({}));
  EXPECT_FALSE(publisher.end({}));
  drive(false);
  EXPECT_TRUE(publisher.has_reported_end()) << "a run that is driven on stays over";
  frame = {};
  frame.begins = true;
  publisher.frame(frame);
  EXPECT_TRUE(publisher.end({}));
}

}  // namespace
}  // namespace chicane::live
