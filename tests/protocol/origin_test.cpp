// SPDX-License-Identifier: MIT
#include "chicane/protocol/origin.hpp"

#include "chicane/base/text.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

TEST(Origin, ReadsTheBandsThatIdentifyWrites) {
  const auto found = identified_in("vehicle:\n  mass_kg: 3.4  # " + band_remark(3.2, 3.6) +
                                   "\n  roll: 1  # [assumed]\n  width_m: 2  # [plant]\n");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], (IdentifiedValue{"mass_kg", 3.4, 3.2, 3.6}));
  EXPECT_EQ(found[1].key, "roll");
  EXPECT_TRUE(std::isnan(found[1].low) && std::isnan(found[1].high));
}

TEST(Origin, MarksOfOthersAreNoBands) {
  EXPECT_THAT(identified_in("vehicle:\n  a: 1  # [assumed]\n  b: 2  # [log] from a paper\n"), IsEmpty());
  EXPECT_THAT(identified_in("a: x  # [log] 1 to 2\nb: 1  # [log] 1 to\n: 1  # [log] to 2\n"), IsEmpty());
}

TEST(Origin, TheHeadOfAFileIsItsRemarks) {
  EXPECT_THAT(head_remarks("# SPDX-License-Identifier: MIT\n# A hall\n# closed=true, spacing_m=1\n"
                           "# note: width=9 assumed\n# x_m,y_m\n1,2\n# behind\n"),
              ElementsAre("A hall", "width=9 assumed"));
  EXPECT_THAT(head_remarks("plant: x\n# late\n"), IsEmpty());
}

TEST(Origin, AHeadOfAnyBytesBecomesShortUtf8) {
  std::string text;
  for (int i = 0; i < 40; ++i) text += "# \xff\x01" + std::string(1000, 'a') + "\n";
  const std::vector<std::string> remarks = head_remarks(text);
  EXPECT_EQ(remarks.size(), 12U);
  EXPECT_LE(remarks[0].size(), 300U);
  for (std::string_view rest = remarks[0]; !rest.empty(); rest.remove_prefix(utf8_length(rest)))
    ASSERT_GT(utf8_length(rest), 0U) << rest;
}

TEST(Origin, AShippedCarSaysWhatItIsAndHasNoBands) {
  const Origin origin = origin_of(*compose({.scenario_file = {}, .settings = {{"car", "road-car"}}}));
  ASSERT_FALSE(origin.car_notes.empty());
  EXPECT_THAT(origin.car_notes.front(), HasSubstr("road car"));
  EXPECT_THAT(origin.identified, IsEmpty());
  EXPECT_EQ(origin.road_kind, "table of points");
}

/// "waypoints.gpx" with a kind, and one thing that its reader assumed.
TEST(Origin, AnImportedRoadSaysWhatItWasReadFromAndWhatWasAssumed) {
  struct Case {
    const char* file;
    const char* kind;
  };
  for (const Case& each : {Case{"three_laps.gpx", "GPX"}, Case{"course.geojson", "GeoJSON"},
                           Case{"cones.csv", "cones"}, Case{"course.xodr", "OpenDRIVE"}}) {
    const std::string file = std::string(CHICANE_SOURCE_DIR "/tests/data/tracks/") + each.file;
    const auto scenario = test::good(compose({.scenario_file = {}, .settings = {{"track", file}}}));
    EXPECT_EQ(origin_of(*scenario).road_kind, each.kind) << file;
  }
  const std::string gpx = CHICANE_SOURCE_DIR "/tests/data/tracks/three_laps.gpx";
  const Origin origin = origin_of(*compose({.scenario_file = {}, .settings = {{"track", gpx}}}));
  EXPECT_THAT(origin.road_notes,
              Contains(HasSubstr("width: not in the file, 4.5 m left and 4.5 m right assumed")));
}

TEST(Origin, ANoteOfARoadIsNoSetting) {
  const Result<TrackFile> content = test::good(
      parse_track("# note: track_scale=2\n# note: x_m, y_m\nx_m,y_m\n0,0\n9,0\n9,9\n0,9\n", "a.csv"));
  EXPECT_EQ(content->points.size(), 4U);
}

}  // namespace
}  // namespace chicane::protocol
