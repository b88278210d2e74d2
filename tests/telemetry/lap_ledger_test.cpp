// SPDX-License-Identifier: MIT
#include "chicane/telemetry/lap_ledger.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace chicane::telemetry {
namespace {

using Texts = std::vector<std::string>;

Change at(double time, const char* name, const char* value) {
  return {.time = time, .name = std::string_view(name), .value = std::string_view(value)};
}

TEST(LapLedger, TellsTheSettingsAsTheyWereAtTheEndOfTheLap) {
  LapLedger ledger;
  EXPECT_EQ(ledger.setup(10.0, 10.0).names, Texts{});
  ledger.add(at(5.0, "latency_ms", "60"));
  ledger.add(at(12.0, "seed_of_doubt", "1"));
  ledger.add(at(25.0, "latency_ms", "80"));
  const LapSetup first = ledger.setup(10.0, 10.0);
  EXPECT_EQ(first.names, Texts{"latency_ms"});
  EXPECT_EQ(first.values, Texts{"60"});
  EXPECT_TRUE(first.is_mixed);
  const LapSetup second = ledger.setup(20.0, 5.0);
  EXPECT_EQ(second.names, (Texts{"latency_ms", "seed_of_doubt"}));
  EXPECT_EQ(second.values, (Texts{"60", "1"}));
  EXPECT_FALSE(second.is_mixed);
  EXPECT_TRUE(ledger.setup(30.0, 10.0).is_mixed);
  EXPECT_EQ(ledger.setup(30.0, 10.0).values.front(), "80");
}

TEST(LapLedger, ASettingThatIsSetToWhatItIsMixesNothing) {
  LapLedger ledger;
  ledger.add(at(1.0, "latency_ms", "60"));
  ledger.add(at(15.0, "latency_ms", "60"));
  EXPECT_FALSE(ledger.setup(20.0, 10.0).is_mixed);
}

TEST(LapLedger, CountsTheTimeByHand) {
  LapLedger ledger;
  EXPECT_EQ(ledger.setup(10.0, 10.0).by_hand_share, 0.0);
  ledger.add(at(15.0, "manual.is_on", "true"));
  ledger.add(at(15.1, "manual.steer", "0.5"));
  EXPECT_DOUBLE_EQ(ledger.setup(20.0, 10.0).by_hand_share, 0.5);
  EXPECT_DOUBLE_EQ(ledger.setup(30.0, 10.0).by_hand_share, 1.0);
  ledger.add(at(32.5, "manual.is_on", "false"));
  EXPECT_DOUBLE_EQ(ledger.setup(40.0, 10.0).by_hand_share, 0.25);
  EXPECT_DOUBLE_EQ(ledger.setup(50.0, 10.0).by_hand_share, 0.0);
  EXPECT_EQ(ledger.setup(50.0, 10.0).names, Texts{});
  EXPECT_FALSE(ledger.setup(40.0, 10.0).is_mixed);
}

TEST(LapLedger, NamesTheFaultsThatActedInTheLap) {
  LapLedger ledger;
  ledger.add(at(5.0, "fault.half_grip", "+8*0.3"));
  ledger.add(at(13.0, "fault.half_grip", "false"));
  ledger.add(at(14.0, "fault.link_lost", "true"));
  ledger.add(at(15.0, "run.pace", "4"));
  EXPECT_EQ(ledger.setup(10.0, 10.0).faults, Texts{"half_grip"});
  EXPECT_EQ(ledger.setup(20.0, 10.0).faults, (Texts{"half_grip", "link_lost"}));
  ledger.add(at(20.5, "fault.link_lost", "false"));
  EXPECT_EQ(ledger.setup(30.0, 5.0).faults, Texts{});
}

TEST(LapLedger, ARunThatStartsAgainKeepsSettingsAndHandsButNoFaults) {
  LapLedger ledger;
  ledger.add(at(5.0, "latency_ms", "60"));
  ledger.add(at(5.0, "manual.is_on", "true"));
  ledger.add(at(6.0, "fault.half_grip", "true"));
  ledger.restart();
  const LapSetup setup = ledger.setup(4.0, 4.0);
  EXPECT_EQ(setup.values, Texts{"60"});
  EXPECT_EQ(setup.faults, Texts{});
  EXPECT_FALSE(setup.is_mixed);
  EXPECT_EQ(setup.by_hand_share, 1.0);
}

TEST(LapLedger, AnotherRunBeginsWithNothing) {
  LapLedger ledger;
  ledger.add(at(5.0, "latency_ms", "60"));
  ledger.add({.name = std::string_view("track"), .value = std::string_view("oval"), .starts_anew = true});
  EXPECT_EQ(ledger.setup(4.0, 4.0).names, Texts{});
}

TEST(LapLedger, StaysBoundedAndKnowsTheNewestOfEverything) {
  LapLedger ledger;
  ledger.add(at(0.0, "seed_of_doubt", "7"));
  for (int i = 0; i < 5000; ++i) ledger.add(at(i, "latency_ms", std::to_string(i % 100).c_str()));
  const LapSetup setup = ledger.setup(4999.5, 10.0);
  EXPECT_EQ(setup.names, (Texts{"latency_ms", "seed_of_doubt"}));
  EXPECT_EQ(setup.values, (Texts{"99", "7"}));
  EXPECT_TRUE(setup.is_mixed);
}

}  // namespace
}  // namespace chicane::telemetry
