// SPDX-License-Identifier: MIT
#include "chicane/live/run_publisher.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "chicane/protocol/fault_codec.hpp"

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
  RunPublisher publisher{
      viewer, settings, {LiveHooks{}, {.on_change = [this](const telemetry::Change& change) {
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

TEST_F(Publisher, TellsTheEndOnceForEachRun) {
  EXPECT_TRUE(publisher.end({}));
  EXPECT_FALSE(publisher.end({}));
  drive(false);
  EXPECT_TRUE(publisher.has_told_end()) << "a run that is driven on stays over";
  frame = {};
  frame.begins = true;
  publisher.frame(frame);
  EXPECT_TRUE(publisher.end({}));
}

TEST_F(Publisher, ServicesAskWhatTheControlsKnow) {
  run::RunControls controls;
  const wire::ViewerServices services = run_services(controls);
  EXPECT_FALSE(services.step()) << "it is not paused";
  EXPECT_TRUE(services.pause(true));
  EXPECT_TRUE(controls.is_paused);
  EXPECT_TRUE(services.step());
  EXPECT_EQ(controls.steps, 1);
  EXPECT_TRUE(services.reset());
  EXPECT_TRUE(controls.wants_restart);
}

}  // namespace
}  // namespace chicane::live
