// SPDX-License-Identifier: MIT
#include "chicane/protocol/schema_json.hpp"
#include "support/chicane_test.hpp"

#include <nlohmann/json.hpp>

namespace chicane::protocol {
namespace {

scenario::Scenario started() {
  scenario::Scenario start;
  start.seed = 4;
  return start;
}

nlohmann::json rows(const scenario::Scenario& defaults, std::string_view only,
                    std::span<const Control> controls = {}) {
  return nlohmann::json::parse(schema_json(
      defaults, started(), [&](const Parameter& row) { return row.key == only; }, controls));
}

TEST(SchemaJson, DescribesATunableWithUnitRangeDefaultAndMeaning) {
  scenario::Scenario defaults;
  defaults.seed = 17;
  const nlohmann::json all = rows(defaults, "seed");
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0]["key"], "seed");
  EXPECT_EQ(all[0]["default"], 17);
  EXPECT_EQ(all[0]["start"], 4);
  EXPECT_EQ(all[0]["kind"], "integer");
  EXPECT_TRUE(all[0].contains("minimum"));
  EXPECT_TRUE(all[0].contains("maximum"));
  EXPECT_FALSE(all[0]["meaning"].get<std::string>().empty());
}

TEST(SchemaJson, OffersWhatIsAskedForAndTheControlsBehind) {
  const Control hands{"manual.steer", number_of(-1.0, 1.0, "A person's hands."), 0.0};
  const nlohmann::json all = rows({}, "laps", {&hands, 1});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0]["key"], "laps");
  EXPECT_EQ(all[1]["key"], "manual.steer");
  EXPECT_EQ(all[1]["minimum"], -1.0);
  EXPECT_EQ(all[1]["meaning"], "A person's hands.");
}

TEST(SchemaJson, WritesInfinityAsText) {
  const nlohmann::json all = rows({}, "vehicle.drive_power_per_mass_wpkg");
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0]["default"], "inf");
  EXPECT_EQ(all[0]["may_be_infinite"], true);
}

}  // namespace
}  // namespace chicane::protocol
