// SPDX-License-Identifier: MIT
#include "chicane/live/run_news.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "chicane/protocol/fault_codec.hpp"

namespace chicane::live {
namespace {

class News : public testing::Test {
 protected:
  /// A frame with the first fault on or off.
  void drive(bool has_fault) {
    ++frame.cycle;
    frame.active_faults = has_fault ? 1U : 0U;
    news.frame(frame);
  }

  wire::ViewerEndpoint viewer{{}};
  std::vector<std::string> noted;
  RunNews news{viewer, [this](const telemetry::Change& change) { noted.emplace_back(change.value.view()); }};
  telemetry::Frame frame;
};

TEST_F(News, TellsOfFaultsThatBeganOrEndedByThemselvesOnly) {
  drive(false);
  drive(true);
  drive(true);
  EXPECT_EQ(noted, (std::vector<std::string>{"true"}));
  drive(false);
  EXPECT_EQ(noted.size(), 2U);
  const auto key = std::string("fault.") + protocol::fault_names().front();
  news.change({.name = key, .value = "1@2*3"});
  drive(true);
  EXPECT_EQ(noted.size(), 2U) << "it was asked for";
}

TEST_F(News, TellsTheEndOnceForEachRun) {
  EXPECT_TRUE(news.end({}));
  EXPECT_FALSE(news.end({}));
  drive(false);
  EXPECT_TRUE(news.has_told_end()) << "a run that is driven on stays over";
  frame = {};
  frame.begins = true;
  news.frame(frame);
  EXPECT_TRUE(news.end({}));
}

TEST_F(News, ServicesAskWhatTheControlsKnow) {
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
