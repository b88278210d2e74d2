// SPDX-License-Identifier: MIT
#include "chicane/protocol/schema_json.hpp"

#include "chicane/protocol/yaml_codec.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

std::string refusal(std::string_view text) {
  const auto event = parse_fault(text);
  EXPECT_FALSE(event) << text;
  return event ? "" : event.error().message;
}

TEST(FaultText, NamesAFaultItsTimeAndPerhapsMore) {
  const auto all = test::good(parse_fault("half_grip@12+5*0.25"));
  EXPECT_EQ(all->fault, sim::fault_named("half_grip"));
  EXPECT_EQ(all->at, 12.0);
  EXPECT_EQ(all->duration, 5.0);
  EXPECT_EQ(all->strength, 0.25);
  const auto least = test::good(parse_fault("link_lost@0.5"));
  EXPECT_EQ(least->duration, sim::kind_of(*sim::fault_named("link_lost")).duration);
}

TEST(FaultText, SaysWhatIsWrongAndWhatWasMeant) {
  EXPECT_THAT(refusal("half_girp@12"), HasSubstr("did you mean half_grip?"));
  EXPECT_THAT(refusal("half_grip"), HasSubstr("faults.at_s: got nothing"));
  EXPECT_THAT(refusal("half_grip@-1"), HasSubstr("faults.at_s: got -1, expected a number in [0, "));
  EXPECT_THAT(refusal("half_grip@1+"), HasSubstr("faults.for_s: got +"));
  EXPECT_THAT(refusal("half_grip@1*7"), HasSubstr("faults.strength: got 7, expected a number in [0.05, 1]"));
  EXPECT_THAT(refusal("link_lost@1*7"), HasSubstr("link_lost has no strength"));
  EXPECT_THAT(refusal(""), HasSubstr("faults.name: got nothing"));
  EXPECT_THAT(refusal("half_grip@nan"), HasSubstr("faults.at_s"));
}

TEST(FaultYaml, IsAListInAScenarioAndComesBackTheSame) {
  const auto document = test::good(parse_document(
      "laps: 2\nfaults:\n  - {name: half_grip, at_s: 12, for_s: 5, strength: 0.3}\n  - name: link_lost\n    "
      "at_s: 20.1\n",
      "wet.yaml"));
  scenario::Scenario scenario;
  const std::array layers{*document};
  ASSERT_TRUE(apply_layers(layers, scenario));
  ASSERT_EQ(scenario.faults.size(), 2U);
  EXPECT_EQ(scenario.faults[0].strength, 0.3);
  EXPECT_EQ(scenario.faults[1].at, 20.1);

  const std::string text = write_document(scenario, "test", true);
  const auto again = test::good(parse_document(text, "again.yaml"));
  ASSERT_TRUE(again->faults);
  ASSERT_EQ(again->faults->size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ((*again->faults)[i].fault, scenario.faults[i].fault);
    EXPECT_EQ((*again->faults)[i].at, scenario.faults[i].at);
    EXPECT_EQ((*again->faults)[i].duration, scenario.faults[i].duration);
    EXPECT_EQ((*again->faults)[i].strength, scenario.faults[i].strength);
  }
}

TEST(FaultYaml, RefusesWithFileLineAndKey) {
  const auto refused = [](const std::string& text) {
    const auto document = parse_document(text, "f.yaml");
    EXPECT_FALSE(document) << text;
    return document ? "" : document.error().message;
  };
  EXPECT_THAT(refused("faults: 3\n"), HasSubstr("f.yaml:1: faults: got 3, expected a list"));
  EXPECT_THAT(refused("faults:\n  - 3\n"), HasSubstr("f.yaml:2: faults: got 3, expected {name: half_grip"));
  EXPECT_THAT(refused("faults:\n  - {name: half_grip, at: 3}\n"),
              HasSubstr("f.yaml:2: at: got an unknown key, expected name"));
  EXPECT_THAT(refused("laps: 1\nfaults:\n  - {name: hlaf_grip, at_s: 3}\n"),
              HasSubstr("f.yaml:3: faults.name: got hlaf_grip"));
  EXPECT_THAT(refused("faults:\n  - {name: half_grip, at_s: [1]}\n"),
              HasSubstr("f.yaml:2: at_s: got a list, expected text"));
  EXPECT_THAT(refused("faults:\n  - {name: half_grip, at_s: 1, for_s: 0}\n"),
              HasSubstr("faults.for_s: got 0"));
}

TEST(FaultControls, AreSwitchedWithDurationAndStrength) {
  const auto plain = test::good(read_switch("half_grip", "true"));
  EXPECT_EQ(plain->duration, sim::default_event(plain->fault, 0.0).duration);
  const auto chosen = test::good(read_switch("half_grip", "+7.5*0.25"));
  EXPECT_EQ(chosen->duration, 7.5);
  EXPECT_EQ(chosen->strength, 0.25);
  EXPECT_EQ(read_switch("half_grip", "*0.25")->duration, plain->duration);
  for (const char* wrong : {"", "1", "yes", "+", "+-1", "+5*9", "+5@3", "+nan"})
    EXPECT_FALSE(read_switch("half_grip", wrong)) << wrong;
  EXPECT_THAT(read_switch("half_grip", "+5*9").error().message, HasSubstr("fault.half_grip: got +5*9"));
}

TEST(FaultControls, AreOneSwitchForEach) {
  const auto controls = fault_controls();
  ASSERT_EQ(controls.size(), sim::fault_kinds().size());
  EXPECT_EQ(controls[0].key, "fault.link_lost");
  EXPECT_EQ(controls[0].option.kind, Kind::kBool);
  EXPECT_EQ(controls[0].fault, &sim::fault_kinds()[0]);
}

}  // namespace
}  // namespace chicane::protocol
