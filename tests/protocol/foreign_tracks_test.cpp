// SPDX-License-Identifier: MIT
#include "chicane/protocol/track_codec.hpp"

#include <fmt/format.h>

#include "chicane/base/math.hpp"
#include "chicane/protocol/detail/foreign_roads.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/road/track.hpp"
#include "support/chicane_test.hpp"
#include "support/expect_said.hpp"
#include "support/folder.hpp"
#include "support/stadium.hpp"

namespace chicane::protocol {
namespace {

using ::testing::AllOf;
using Direction = TrackReadOptions::Direction;

const std::string kData = std::string(CHICANE_SOURCE_DIR) + "/tests/data/";

double turned(const road::Track& track) {
  return track.centre().at(track.length() - 1e-6).heading - track.centre().at(0.0).heading;
}

/// One file of tests/data/tracks and what it has to become. The road is a stadium 245.66 m long and 6 m wide,
/// for model cars a tenth of that.
struct Kind {
  std::string file;
  double length, length_tolerance;  ///< [m]
  double width, width_tolerance;    ///< everywhere [m]
  std::string said = {};            ///< in one of the warnings; empty: there are none
  bool is_left = true;              ///< driven counter-clockwise
  TrackReadOptions options = {};
};

constexpr double kLength = 245.664, kModel = 0.1 * kLength;
const TrackReadOptions kSmall{.scale = 0.1}, kReversed{.direction = Direction::kReversed};
const TrackReadOptions kSmallWithNames{.scale = 0.1, .columns = "x_m,y_m,skip,skip"};
const TrackReadOptions kNarrowToTheLeft{
    .default_left = 2.0, .default_right = 2.0, .direction = Direction::kLeft};

const Kind kKinds[] = {
    // Tables: exact but for chords and the smoothing of the corners where straights meet half circles.
    {"f1tenth_centerline.csv", kModel, 0.03, 0.6, 0.02, "", true, kSmall},
    {"f1tenth_raceline.csv", kModel, 0.03, 0.9, 0.02,
     "0.45 m left and 0.45 m right assumed (import --width-m sets it)", true, kSmall},
    {"tum_centre_line.csv", kLength + 3.14, 0.3, 6.0, 0.1},
    {"tum_race_line.csv", kLength, 0.3, 9.0, 0.1, "counts from +y"},
    {"gym_waypoints.csv", kModel, 0.03, 0.9, 0.02, "assumed", true, kSmallWithNames},
    {"matlab_writematrix.txt", kLength, 0.3, 9.0, 0.1, "4.5 m left and 4.5 m right assumed"},
    {"matlab_writetable.csv", kLength, 0.3, 6.0, 0.1, "of the whole road, half of it to each side"},
    {"decimal_commas.csv", kLength, 0.3, 6.0, 0.1},
    {"clockwise.csv", kLength, 0.3, 9.0, 0.1, "assumed", false},
    {"utm.csv", kLength, 0.3, 6.0, 0.1},
    {"autoware.csv", kLength, 0.3, 9.0, 0.1, "unknown columns, ignored"},
    {"global_waypoints.json", kModel, 0.03, 0.6, 0.02, "centerline_waypoints: taken of the file's lines",
     true, kSmall},
    // Cones stand 4 m apart, so fences are chords: 0.1 m of the width in bends, more where cones are
    // missing.
    {"cones.csv", kLength, 2.0, 6.0, 0.9, "none on the left side for 1"},
    {"fssim.yaml", kLength, 2.0, 6.0, 0.9, "none on the right side for 8."},
    {"cones.sdf", kLength, 2.0, 6.0, 0.9, "start: not in the file"},
    // Satellite noise of 0.3 m.
    {"three_laps.gpx", kLength, 3.0, 9.0, 2.0, "laps: the first of 3.0 taken"},
    {"course.kml", kLength, 0.5, 9.0, 0.7,
     "noise of 0.05 m estimated from the points (import --smoothing-m sets it)"},
    {"course.osm", kLength, 0.5, 6.0, 0.7, "way: 2 of 3 ways taken"},
    {"course.geojson", kLength, 0.5, 6.0, 0.7, "metres east and north of 48.2001"},
    // Its arcs of 20 m move inwards by 0.07 m where their ends are eased.
    {"course.xodr", kLength, 0.5, 6.0, 0.1, "lanes: those of type driving"},
    // What is asked for.
    {"course.xodr", kLength, 0.5, 6.0, 0.1, "lanes", false, kReversed},
    {"clockwise.csv", kLength, 0.3, 4.0, 0.1, "2 m left", true, kNarrowToTheLeft}};

TEST(ForeignTracks, HaveTheLengthTheWidthAndTheDirectionOfTheRoad) {
  for (const Kind& kind : kKinds) {
    SCOPED_TRACE(kind.file);
    const std::string file = kData + "tracks/" + kind.file;
    const auto content = test::good(parse_track(test::content_of(file), file, kind.options));
    if (kind.said.empty()) {
      EXPECT_THAT(content->warnings, IsEmpty());
    } else {
      EXPECT_THAT(content->warnings, Contains(AllOf(StartsWith(file), HasSubstr(kind.said))));
    }
    const Result<road::Track> track = test::good(make_track(*content));
    EXPECT_TRUE(track->centre().is_closed());
    EXPECT_NEAR(track->length(), kind.length, kind.length_tolerance);
    EXPECT_GT(kind.is_left ? turned(*track) : -turned(*track), 6.0);
    for (double s = 0.0; s < track->length(); s += 0.01 * track->length()) {
      EXPECT_NEAR(track->left_width(s) + track->right_width(s), kind.width, kind.width_tolerance) << s;
      EXPECT_LT(std::fabs(track->centre().at(s).curvature) * kind.length, 40.0)
          << "the tightest bend has 12.3 of this";
    }
  }
}
TEST(ForeignTracks, RefusesInWordsWhatIsNoRoad) {
  const std::map<std::string, std::string> expected{
      {"gym_waypoints.csv",
       ":1: header: got none for 4 columns, expected a line that names them, like "
       "x_m,y_m,w_tr_right_m,w_tr_left_m (import "
       "--columns names them)"},
      {"one_side.csv",
       ": cones: got 58 of the left side and 0 of the right one, expected at least 3 of each"},
      {"no_loop.yaml", ": free space: got no loop, open between ("},
      {"no_loop.pgm", ": file: got an image, expected the YAML file beside it that says its resolution"},
  };
  for (const auto& [name, words] : expected) {
    const auto track = read_track(kData + "tracks/" + name);
    ASSERT_FALSE(track) << name;
    EXPECT_THAT(track.error().message, AllOf(StartsWith(kData + "tracks/" + name), HasSubstr(words)));
    EXPECT_EQ(track.error().code, ErrorCode::kParse);
  }
}

/// An OpenDRIVE file of one road, 4 m to each side, of lines and arcs: x, y, heading, length, curvature.
std::string open_drive(const std::vector<std::array<double, 5>>& pieces, const std::string& more = "") {
  std::string plan;
  for (const auto& [x, y, heading, length, curvature] : pieces)
    plan += fmt::format("<geometry x='{}' y='{}' hdg='{}' length='{}'><arc curvature='{}'/></geometry>", x, y,
                        heading, length, curvature);
  const auto lane = [](const char* side, int id) {
    return fmt::format("<{}><lane id='{}' type='driving'><width a='4'/></lane></{}>", side, id, side);
  };
  return fmt::format(
      "<OpenDRIVE><road id='7' length='100'><planView>{}</planView><lanes><laneSection "
      "s='0'>{}{}</laneSection>"
      "</lanes></road>{}</OpenDRIVE>",
      plan, lane("left", 1), lane("right", -1), more);
}

// A uniform spline left the points of 24 of 40 drawn circuits by more than the width of the road.
TEST(ForeignTracks, DrawnCircuitsWithLongStraightsAreWithinTheirNoise) {
  std::string text = R"({"type": "LineString", "coordinates": [)";
  constexpr double kNorth = 111178.0, kEast = 76056.0;  // metres of a degree at 47 degrees
  for (const Vec2& point : test::stadium(40.0, 9, 300.0))
    text += fmt::format("[{:.6f}, {:.6f}], ", 8.0 + point.x() / kEast, 47.0 + point.y() / kNorth);
  text.resize(text.size() - 2);
  const auto content = test::good(parse_track(text + "]}", "drawn.geojson", {.is_closed = true}));
  const auto track = test::good(make_track(*content));
  EXPECT_NEAR(track->length(), 600.0 + kTwoPi * 40.0, 0.005 * 851.0);
  EXPECT_LT(road::point_fit(*track).most, 2.0 * content->options.smoothing_sigma + 0.01);
}

TEST(ForeignTracks, NamesElementAndLineOfAFault) {
  test::expect_said(
      [](const std::string& text) { return test::refusal_of(parse_track(text, "f.xml")); },
      {{"<?xml version='1.0'?>\n<gpx>\n<trkpt lat='x' lon='1'/></gpx>",
        "f.xml:3: latitude: got x, expected a finite number"},
       {"<svg>\n</svg>", "f.xml:1: root: got the element svg, expected gpx, kml, osm, OpenDRIVE or sdf"},
       {"<osm>\n<way id='1'><nd ref='1'/><nd ref='2'/></way></osm>", "f.xml: way: got a node "},
       {"<OpenDRIVE>\n<road id='1'>\n</road></OpenDRIVE>",
        "f.xml:2: road: got no planView and lanes, expected both"},
       {"{\"type\": \"Feature\",\n oops", "f.xml:2: file: got text that is no JSON"},
       {"{\"centerline_waypoints\": {\"wpnts\": [{\"x_m\": 1}]}}",
        "centerline_waypoints.wpnts[0]: y_m: got nothing"},
       {"tag,x,y\nblue,0,1\nblue,0,zero\n", "f.xml:3: y: got zero, expected a finite number"},
       // Files that are no roads.
       {"<osm><way id='1'><nd ref='1'/><nd ref='2'/></way><relation id='3'>\n<tag k='type' "
        "v='lanelet'/></relation></osm>",
        "f.xml:1: relation: got a lanelet of a Lanelet2 map, expected ways of a course"},
       {"<commonRoad>\n<lanelet id='1'/></commonRoad>",
        "f.xml:1: root: got a scene of CommonRoad, expected one road"},
       {"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n",
        "f.xml:1: file: got a pointer of git-LFS, expected the file itself (git lfs pull)"},
       {R"({"X": [0], "Y": [0], "X_i": [0], "Y_i": [0]})", "got a track.json of MPCC"},
       {"image: none.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n",
        "f.xml: image: got none.pgm, which cannot be read, expected a PGM or PNG file"},
       {"image: none.pgm\nresolution: 0.05\norigin: [0, 0, -nan]\n",
        "f.xml:3: origin: yaw: got -nan, expected a finite number"},
       // Jumps, kinks and junctions of OpenDRIVE.
       {open_drive({{0, 0, 0, 100, 0}, {100, 1.5, 0, 50, 0.02}}),
        "geometry: got a jump of 1.50 m at s = 100.0 m of road 7, expected pieces that join"},
       {open_drive({{0, 0, 0, 100, 0}, {100, 0, 0.2, 50, 0.02}}),
        "geometry: got a kink of 0.20 rad at s = 100.0 m of road 7"},
       {open_drive({{0, 0, 0, 100, 0}}, "<junction id='1'/>"),
        "junction: got a network of 1 roads, expected one course without junctions"}});
}

TEST(OpenDrive, KeepsItsLengthAndItsArcs) {
  const auto content = test::good(parse_track(open_drive({{0, 0, 0, 500, 0}}), "f.xodr"));
  EXPECT_THAT(content->warnings,
              Contains(HasSubstr("length: road 7 states 100.0 m, and its planView of 500.0 m is taken")));
  const auto straight = test::good(make_track(*content));
  EXPECT_FALSE(straight->centre().is_closed());
  EXPECT_NEAR(straight->length(), 500.0, 0.01);
  const double half = kPi * 40.0;
  const std::string loop = open_drive(
      {{0, 0, 0, 100, 0}, {100, 0, 0, half, 0.025}, {100, 80, kPi, 100, 0}, {0, 80, kPi, half, 0.025}});
  const auto track = test::good(make_track(*parse_track(loop, "f.xodr")));
  double sharpest = 0.0;
  for (double s = 0.0; s < track->length(); s += 0.5)
    sharpest = std::max(sharpest, track->centre().at(s).curvature);
  EXPECT_NEAR(1.0 / sharpest, 40.0, 0.6);
  EXPECT_NEAR(track->length(), 200.0 + 2.0 * half, 0.5);
  // The outer edge of an arc stays where the file has it.
  const double s = 100.0 + 0.5 * half;
  EXPECT_NEAR((track->centre().at(s).position - Vec2{100.0, 40.0}).norm() + track->right_width(s), 44.0,
              0.01);
}

TEST(ForeignTracks, ReadsConesThatAreLinksOfOneModel) {
  std::string cones = "<sdf><model name='course'>";
  for (int i = 0; i < 24; ++i)
    for (const auto& [radius, colour] : {std::pair(17.0, "blue"), std::pair(20.0, "yellow")})
      cones += fmt::format(
          "<link name='link_{0}'><pose>{1} {2} 0 0 0 "
          "0</pose><visual><geometry><mesh><uri>cone_{3}.dae</uri></mesh>"
          "</geometry></visual></link>",
          i, radius * std::cos(kPi * i / 12), radius * std::sin(kPi * i / 12), colour);
  const auto links = test::good(parse_track(cones + "</model></sdf>", "f", {}));
  EXPECT_NEAR(make_track(*links)->length(), 37.0 * kPi, 1.5);
}

/// Names, lengths and widths of tests/data/maps/expected.csv.
struct Map {
  std::string name;
  double length = 0.0, width = 0.0;
};
std::vector<Map> maps() {
  std::ifstream file(kData + "maps/expected.csv");
  std::vector<Map> all;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream row(line);
    Map map;
    char comma = 0;
    if (std::getline(row, map.name, ',') && row >> map.length >> comma >> map.width) all.push_back(map);
  }
  return all;
}

TEST(OccupancyMaps, BecomeRoadsWithTheDrawnLengthAndWidth) {
  const std::vector<Map> all = maps();
  ASSERT_EQ(all.size(), 10U);
  for (const Map& map : all) {
    const std::string file = kData + "maps/" + map.name + ".yaml";
    const auto content = test::good(parse_track(read_file(file).value(), file, {.scale = 0.1}));
    const auto track = test::good(make_track(*content));
    EXPECT_TRUE(track->centre().is_closed());
    // Smoothing rounds bends by up to a cell, and the corners of square corridors.
    const bool is_square = map.name == "corridors";
    EXPECT_NEAR(track->length(), map.length, is_square ? 4.0 : 0.02 * map.length) << map.name;
    EXPECT_GT(turned(*track), 6.0) << map.name << ": towards +x from the origin, which is counter-clockwise";
    EXPECT_NEAR(track->centre().at(0.0).position.norm(), 0.0, 0.3 * map.width) << map.name;
    std::vector<double> widths;
    for (double s = 0.0; s < track->length(); s += 0.2) {
      widths.push_back(track->left_width(s) + track->right_width(s));
      EXPECT_GT(widths.back(), 0.8 * map.width) << map.name << " at " << s;
      EXPECT_LT(widths.back(), (is_square ? 1.7 : 1.25) * map.width) << map.name << " at " << s;
    }
    std::nth_element(widths.begin(), widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2),
                     widths.end());
    EXPECT_NEAR(widths[widths.size() / 2], map.width, 0.1) << map.name;
  }
}

TEST(OccupancyMaps, TakeDirectionAndStartFromTheOptions) {
  const std::string file = kData + "maps/ring.yaml";
  const std::string text = read_file(file).value();
  const auto right = test::good(make_track(
      *parse_track(text, file, {.scale = 0.1, .direction = Direction::kRight, .start = Vec2{7.0, 4.5}})));
  EXPECT_LT(turned(*right), -6.0);
  EXPECT_NEAR((right->centre().at(0.0).position - Vec2{7.2, 4.5}).norm(), 0.0, 0.5);
  EXPECT_THAT(parse_track(text, file, {.least_width = 3.0}).error().message, HasSubstr("m wide at ("));
}

TEST(XmlDocument, HasElementsAndNumbersWithTheirLines) {
  const auto xml = test::good(parse_xml(
      "<?xml version='1.0'?>\n<a:road id='7' length=' 12.5 '>\n <x>3</x>\n <x>4</x>\n</a:road>", "f.xml"));
  const pugi::xml_node road = xml->root();
  EXPECT_STREQ(road.name(), "road") << "without the prefix of its namespace";
  EXPECT_EQ(xml->line_of(road), 2);
  EXPECT_EQ(number_at(road, "length"), 12.5);
  EXPECT_EQ(number_at(road, "width", -1.0), -1.0);
  const std::vector<pugi::xml_node> found = xml->find_all("x");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_STREQ(found[1].child_value(), "4");
  EXPECT_EQ(xml->line_of(found[1]), 4);
}

TEST(XmlDocument, SaysWhereTextIsNoXmlAndEndsAtItsLimits) {
  std::string deep, many = "<a>";
  for (int i = 0; i < 65; ++i) deep = "<a>" + deep + "</a>";
  for (int i = 0; i < 2'000'001; ++i) many += "<b/>";
  test::expect_said([](const std::string& text) { return test::refusal_of(parse_xml(text, "f.xml")); },
                    {{"<a>\n<b></a>", "f.xml:2: file: got XML that cannot be read: Start-end tags mismatch"},
                     {"<a/>\n<a/>", "f.xml:2: file: got XML that cannot"},
                     {"<!DOCTYPE a [<!ENTITY b 'bbbb'>]>\n<a>&b;</a>",
                      "f.xml:1: file: got XML that cannot be read: entities of its own"},
                     {deep, "nested more than 64 deep"},
                     {many + "</a>", "more than 2000000 tags"}});
  EXPECT_FALSE(parse_xml("", "f.xml"));
}

}  // namespace
}  // namespace chicane::protocol
