// SPDX-License-Identifier: MIT
#include "chicane/protocol/track_codec.hpp"

#include <clocale>

#include "chicane/base/math.hpp"
#include "chicane/protocol/csv_text.hpp"
#include "chicane/protocol/library.hpp"
#include "support/chicane_test.hpp"
#include "support/comma_locale.hpp"
#include "support/expect_said.hpp"
#include "support/folder.hpp"

namespace chicane::protocol {
namespace {

const std::string kSource = CHICANE_SOURCE_DIR;

/// A ring as CSV rows with a separator.
std::string ring(const std::string& header, const std::string& separator, const std::string& tail = "",
                 const std::string& end = "\n", double radius = 60.0) {
  std::string text = header;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2.0 * kPi * i / 40.0;
    text += std::to_string(radius * std::cos(angle)) + separator + std::to_string(radius * std::sin(angle)) +
            tail + end;
  }
  return text;
}

/// The warning of a file that has no widths.
std::string assumed_at(const std::string& place) {
  return place + ": width: not in the file, 4.5 m left and 4.5 m right assumed (import --width-m sets it)";
}

TEST(CsvTrack, ReadsWaypointsAndSaysTheWidthItAssumes) {
  const TrackFile file = parse_track(ring("x,y\n", ","), "ring.csv").value();
  EXPECT_EQ(file.points.size(), 40U);
  EXPECT_TRUE(file.is_closed);
  EXPECT_EQ(file.points[3].left, 4.5);
  EXPECT_THAT(file.warnings, ElementsAre(assumed_at("ring.csv:1")));
  const TrackFile wide =
      parse_track(ring("x,y\n", ","), "ring.csv", {.default_left = 6.0, .default_right = 3.0}).value();
  EXPECT_EQ(wide.points[3].left, 6.0);
  EXPECT_EQ(wide.points[3].right, 3.0);
  const TrackFile matlab = parse_track(ring("% x_m y_m\n% a ring\n", " "), "a.csv").value();
  EXPECT_EQ(matlab.points.size(), 40U);
  EXPECT_EQ(matlab.lines[0], 3) << "behind the comments of Matlab";
}

TEST(CsvTrack, MatchesNamesNotPositions) {
  const TrackFile tum =
      parse_track(ring("# x_m,y_m,w_tr_right_m,w_tr_left_m\n", ",", ",4.4,4.8"), "ring.csv").value();
  EXPECT_EQ(tum.points[0].right, 4.4);
  EXPECT_EQ(tum.points[0].left, 4.8);
  EXPECT_EQ(tum.lines[0], 2);
  EXPECT_THAT(tum.warnings, IsEmpty());
  const TrackFile file =
      parse_track("w_tr_left_m,y_m,note,x_m,w_tr_right_m\n4.8,1,here,0,4.4\n4.8,2,there,9,4.4\n", "a.csv")
          .value();
  EXPECT_EQ(file.points[1].position, (Vec2{9.0, 2.0}));
  EXPECT_EQ(file.points[1].left, 4.8);
  EXPECT_THAT(file.warnings, Contains("a.csv:1: note: unknown column, ignored"));
  EXPECT_EQ(parse_track("x,y,z,yaw,velocity\n0,1,18,0,30\n4,2,18,0,30\n", "a.csv")->warnings.front(),
            "a.csv:1: z, yaw, velocity: unknown columns, ignored");
}

/// Why a table of this text is refused.
std::string refusal_of(const std::string& text) { return test::refusal_of(parse_track(text, "a.csv")); }

TEST(CsvTrack, FindsTheLineOfNames) {
  const std::string number = ", expected a finite number with a decimal point";
  for (const auto& [text, words] : test::Said{
           {"x_m,y_m\nnan,1\n", "a.csv:2: x_m: got nan" + number},
           {"# x_m,y_m\n\n,2\n", "a.csv:3: x_m: got nothing" + number},
           {"None,1\n2,3\n", "a.csv:1: x_m: got None" + number},  // no line of names
           {"# v_mps, ax_max_machines_mps2\n0,9\n1,8\n",
            "a.csv:1: header: got v_mps, ax_max_machines_mps2, expected columns x and y (or x_m and y_m) in "
            "metres"}})
    EXPECT_EQ(refusal_of(text), words);
  test::expect_said(
      refusal_of,
      {{"# speed_mps time_s\n0 9\n1 8\n", "header: got speed_mps"},
       {"tag,x,y\nblue,0,1\n",
        "a.csv: cones: got 1 of the left side and 0 of the right one, expected at least 3 of each"},
       {"x,y,colour\n0,1,Yellow\n", "a.csv: cones: got 0 of"}});
  for (const char* row : {"0,0,18.3,30\n2,0,18.3,30\n", "0;0;8;3.2\n2;0;8;3.2\n", "0,0,1\n", "0 0 1 2 3\n"})
    EXPECT_THAT(refusal_of(row),
                HasSubstr("expected a line that names them, like x_m,y_m,w_tr_right_m,w_tr_left_m"));
  for (const char* text :
       {"stamp,x,y\n2024-05-01 12:00,0,1\n2024-05-01 12:01,5,1\n",  // rows that begin with text
        "x,y\nx_m,y_m\n0,1\n5,1\n",                                 // a second line of names
        "# my track\n0 9\n1 8\n",
        "# of Monza, the old one, in 2D\n0,9\n1,8\n",  // words are no names of columns
        "# a,b,c\n0,9\n1,8\n"})                        // another number of columns
    EXPECT_EQ(parse_track(text, "a.csv")->points.size(), 2U) << text;
  EXPECT_THAT(parse_track("0,0\n2,0\n", "a.csv")->warnings.front(),
              HasSubstr("header: none, read as x_m,y_m"));
}

TEST(CsvTrack, RefusesDegreesOfLatitudeAndLongitude) {
  std::string text = "x,y\n";
  for (int i = 0; i < 40; ++i)
    text += std::to_string(11.57 + 0.01 * std::cos(0.157 * i)) + "," +
            std::to_string(48.13 + 0.01 * std::sin(0.157 * i)) + "\n";
  EXPECT_THAT(refusal_of(text),
              HasSubstr("a.csv:2: x_m: got a road within 0.02 m round 11.58, 48.13, like degrees "
                        "of longitude and latitude, expected metres"));
}

TEST(CsvTrack, AssumesLengthsOfTheRoadsOwnScale) {
  const TrackFile model = parse_track(ring("x_m,y_m\n", ",", "", "\n", 6.0), "a.csv", {.scale = 0.1}).value();
  EXPECT_DOUBLE_EQ(model.points[0].left, 0.45);
  EXPECT_DOUBLE_EQ(model.options.smoothing_sigma, 0.01);
  const road::Track small = make_track(model).value();
  const road::Track large = make_track(parse_track(ring("x,y\n", ","), "a.csv").value()).value();
  EXPECT_NEAR(10.0 * small.length(), large.length(), 1e-3) << "six digits in the text";
  EXPECT_NEAR(0.1 * small.centre().at(1.0).curvature, large.centre().at(10.0).curvature, 1e-4);
}

TEST(CsvTrack, ReadsTumRaceLinesAndRecomputesTheirHeading) {
  std::string text =
      "# 7daf4d34-e3c1-4827-9777-a6793ffc3440\n# 603fd3987364b09f\n# s_m; x_m; y_m; psi_rad; kappa_radpm; "
      "vx_mps; ax_mps2\n";
  for (int i = 0; i <= 40; ++i) {  // the last row repeats the first place
    const double angle = 2.0 * kPi * i / 40.0;
    // TUM: psi is 0 along +y; heading along the ring is angle + π/2, so psi = angle.
    text += std::to_string(60.0 * angle) + "; " + std::to_string(60.0 * std::cos(angle)) + "; " +
            std::to_string(60.0 * std::sin(angle)) + "; " + std::to_string(angle) + "; 0.0166; 20.0; 0.0\n";
  }
  const TrackFile file = parse_track(text, "race.csv").value();
  EXPECT_EQ(file.points.size(), 40U) << "without the closing copy";
  EXPECT_TRUE(file.is_closed);
  EXPECT_THAT(
      file.warnings,
      ElementsAre(assumed_at("race.csv:3"),
                  "race.csv:4: psi_rad: counts from +y (as TUM files do), recomputed from the points"));
  EXPECT_NEAR(make_track(file)->centre().at(0.0).heading, kPi / 2.0, 0.01);
}

TEST(CsvTrack, ReadsRaceLinesWithWidthsMixedHeadersAndCommas) {
  const std::string header =
      "# s_m; x_m; y_m; psi_rad; kappa_radpm; vx_mps; ax_mps2, w_tr_right_m, w_tr_left_m\n";
  std::string text = header;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2.0 * kPi * i / 40.0;
    text += "0," + std::to_string(60.0 * std::cos(angle)) + "," + std::to_string(60.0 * std::sin(angle)) +
            "," + std::to_string(angle + kPi / 2.0) + ",0,0,0,1.5,2.5\n";
  }
  const TrackFile file = parse_track(text, "race.csv").value();
  EXPECT_EQ(file.points[7].right, 1.5);
  EXPECT_EQ(file.points[7].left, 2.5);
  EXPECT_THAT(file.warnings, IsEmpty()) << "this psi counts from +x";
}

TEST(CsvTrack, ForgivesLineEndsMarksBlanksAndSeparators) {
  const std::vector<road::TrackPoint> expected = parse_track(ring("x,y\n", ","), "a").value().points;
  for (const std::string& text :
       {ring("x,y\r\n", ",", "", "\r\n"), ring("x,y\r", ",", "", "\r"), ring("\xef\xbb\xbfx,y\n", ","),
        ring("X;Y\n\n", " ; ", "", "\n\n  \n"), ring("x\ty\n", "\t"), ring("x y\n", "   "),
        ring("\"x\",\"y\"\n", ","), ring("x,y\n", ",", ","), ring("", ","), ring("# x, y\n", ",")}) {
    const auto file = test::good(parse_track(text, "a"));
    ASSERT_EQ(file->points.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_EQ(file->points[i].position, expected[i].position);
  }
}

TEST(CsvTrack, ReadsDecimalPointsInALocaleOfCommas) {
  const std::string text = ring("x,y\n", ",");  // std::to_string writes commas in that locale
  const test::CommaLocale comma;
  if (!comma.is_set()) GTEST_SKIP() << "the Debian package locales is not installed";
  EXPECT_EQ(parse_track(text, "a")->points[0].position.x(), 60.0);
  EXPECT_NEAR(parse_track(text, "a")->points[5].position.x(), 60.0 * std::sqrt(0.5), 1e-6)
      << "six digits in the text";
}

TEST(CsvTrack, TellsOpenFromClosedAndCanBeForced) {
  const std::string straight = "x,y\n0,0\n10,0\n20,1\n30,2\n40,2\n";
  const TrackFile open = parse_track(straight, "a.csv").value();
  EXPECT_FALSE(open.is_closed);
  EXPECT_THAT(
      open.warnings,
      Contains(HasSubstr("a.csv:6: row: 40.0 m from the last point to the first: read as an open road")));
  EXPECT_TRUE(parse_track(straight, "a.csv", {.is_closed = true})->is_closed);
  EXPECT_FALSE(parse_track(ring("x,y\n", ","), "a.csv", {.is_closed = false})->is_closed);
  EXPECT_FALSE(parse_track(ring("# closed=false\nx,y\n", ","), "a.csv")->is_closed);
  EXPECT_TRUE(parse_track(ring("# closed=false\nx,y\n", ","), "a.csv", {.is_closed = true})->is_closed)
      << "the caller wins";
}

TEST(CsvTrack, TakesTheStartAndOptionsFromComments) {
  const TrackFile file =
      parse_track(ring("# a ring\n# start_s_m=258.5, start_d_m=-0.76, kerb_width_m=0.5\nx,y\n", ","), "a.csv")
          .value();
  const road::Track track = make_track(file).value();
  EXPECT_EQ(track.start_s(), 258.5);
  EXPECT_EQ(track.start_d(), -0.76);
  EXPECT_EQ(track.kerb_width(), 0.5);
  EXPECT_EQ(track.name(), "a");
}

TEST(CsvTrack, WritesWhatItReadsBackBitForBit) {
  TrackFile open =
      parse_track(ring("# start_s_m=12.25, finish_s_m=99.5, closed=false\nx,y\n", ","), "a.csv").value();
  EXPECT_EQ(parse_track(write_csv_track(open, "an open one"), "b.csv").value().options.finish_s, 99.5);
  TrackFile file = parse_track(ring("# start_s_m=12.25\nx,y\n", ","), "a.csv").value();
  file.points[3].left = 1.0 / 3.0;
  const TrackFile back = parse_track(write_csv_track(file, "a ring\nof two lines"), "b.csv").value();
  ASSERT_EQ(back.points.size(), file.points.size());
  for (std::size_t i = 0; i < file.points.size(); ++i) {
    EXPECT_EQ(back.points[i].position, file.points[i].position);
    EXPECT_EQ(back.points[i].left, file.points[i].left);
    EXPECT_EQ(back.points[i].right, file.points[i].right);
  }
  EXPECT_EQ(back.options.start_s, 12.25);
  EXPECT_EQ(back.is_closed, file.is_closed);
  EXPECT_THAT(back.warnings, IsEmpty());
}

TEST(CsvTrack, PointsWarningsAndColumnsHaveALimit) {
  std::string points = "x,y\n";
  for (std::size_t i = 0; i <= kMaxTrackPoints; ++i) points += i % 2 == 0 ? "1,2\n" : "3,4\n";
  EXPECT_EQ(refusal_of(points), "a.csv:1000002: row: got another point, expected at most 1000000");
  std::string text;
  for (int i = 0; i < 2000; ++i) text += "# x,y,mood,colour\n";
  EXPECT_LE(parse_track(text + "1,2,3,4\n5,6,7,8\n", "a.csv")->warnings.size(), 4U)
      << "of the last line of names";
  std::string many = "x,y";
  for (int i = 0; i < 900; ++i) many += ",c" + std::to_string(i);
  EXPECT_LT(parse_track(many + "\n1,2" + std::string(900, ',') + "\n", "a.csv")->warnings.front().size(),
            200U);
  EXPECT_EQ(refusal_of(many + std::string(100, ',')),
            "a.csv:1: header: got 1002 columns, expected at most 1000");
}

struct BrokenTrack {
  const char* file;
  const char* message;  ///< how it begins after the file's name
};

const BrokenTrack kBrokenTracks[] = {
    {"empty.csv", ": file: got no points, expected lines of numbers"},
    {"header_only.csv", ": file: got no points, expected lines of numbers"},
    {"three_points.csv", ": points: got 3 with 3 different, expected at least 4 different ones"},
    {"word_for_a_number.csv", ":6: x_m: got abc, expected a finite number with a decimal point"},
    {"nan.csv", ":7: x_m: got nan, expected a finite number"},
    {"infinity.csv", ":8: y_m: got inf, expected a finite number"},
    {"overflow.csv", ":9: x_m: got 1e999, expected a finite number"},
    {"negative_width.csv", ":10: w_tr_left_m: got -4.8, expected a width > 0 and <= 1000 m"},
    {"zero_width.csv", ":4: w_tr_right_m: got 0, expected a width > 0"},
    {"width_in_millimetres.csv", ":5: w_tr_right_m: got 4400, expected a width > 0 and <= 1000 m"},
    {"missing_column.csv", ":11: row: got 3 columns, expected 4"},
    {"extra_column.csv", ":12: row: got 5 columns, expected 4"},
    {"empty_field.csv", ":13: x_m: got nothing, expected a finite number"},
    {"decimal_commas.csv", ":3: row: got 8 columns, expected 4"},
    {"no_y_column.csv", ":1: header: got x_m,z_m,w_tr_right_m,w_tr_left_m, expected columns x and y"},
    {"column_twice.csv", ":1: x_m: got a second such column, expected one"},
    {"one_width.csv", ":1: header: got only a right width, expected both"},
    {"three_columns_no_header.csv", ":1: header: got none for 3 columns, expected a line that names them"},
    {"one_place.csv", ": points: got"},
    {"merging_roads.csv", ":61: points[59]: got a line that crosses itself near"},
    {"wrong_order.csv", ":"},
    {"start_in_words.csv", ":1: start_s_m: got soon, expected a number"},
    {"closed_yes.csv", ":1: closed: got yes, expected true or false"},
    {"start_off_the_road.csv", ": start_d: got 7.5, expected a place on the road"},
    {"far_away.csv", ":14: x_m: got 1e8, expected a coordinate within 1e7 m"},
    {"other_separator.csv", ":15: row: got 1 columns, expected 4"},
    {"utf16.csv", ": file: got UTF-16, expected UTF-8"},
    {"picture.csv", ": file: got an image, expected the YAML file beside it"},
    {"json.csv", ":1: header: got {\"x\": [1, 2, 3]"},
    {"hexadecimal.csv", ":16: x_m: got 0x1F, expected a finite number"},
    {"units_in_values.csv", ":17: x_m: got "},
    {"degrees.csv", ":1: header: got lat,lon, expected columns x and y"},
    {"endless_line.csv", ":2: line: got 70000 bytes, expected at most 65536"},
    {"wide_kerb.csv", ": kerb_width: got 9, expected a number in [0, 3]"}};

TEST(CsvTrack, EveryBrokenFixtureIsRefusedWithFileAndLine) {
  const std::string folder = kSource + "/tests/protocol/fixtures/tracks/";
  for (const BrokenTrack& broken : kBrokenTracks) {
    const Result<road::Track> track = read_track(folder + broken.file);
    ASSERT_FALSE(track) << broken.file;
    EXPECT_EQ(track.error().code, ErrorCode::kParse);
    EXPECT_THAT(track.error().message, StartsWith(folder + broken.file + broken.message));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}),
            static_cast<std::ptrdiff_t>(std::size(kBrokenTracks)));
}

TEST(CsvText, ReadsFiniteNumbersOnly) {
  EXPECT_EQ(number("+1.5e1"), 15.0);
  for (const char* bad : {"", "1.5x", "nan", "inf", "1e999", "--1"}) EXPECT_FALSE(number(bad)) << bad;
  EXPECT_FALSE(number("1,250.5", ';')) << "of thousands";
}

TEST(TrackCodec, FindsTheFormatByTheEndOfTheName) {
  for (const std::string_view extension : track_extensions()) {
    const TrackFormat* const format = track_format_of("roads/mine" + std::string(extension));
    ASSERT_NE(format, nullptr) << extension;
    EXPECT_EQ(format->extension, extension);
    EXPECT_TRUE(extension.starts_with("."));
  }
  EXPECT_EQ(track_format_of("cars/road-car.yaml"), nullptr);
  EXPECT_EQ(track_format_of(""), nullptr);
  EXPECT_EQ(parse_track("x,y\n0,1\n2,3\n", "points.txt")->points.size(), 2U) << "as the first format";
  EXPECT_EQ(read_track("no/such/track.csv").error().code, ErrorCode::kNotFound);
}

TEST(TrackCodec, RefusesTooMuchInEveryFormat) {
  const std::string large(kMaxTrackBytes + 1, ' ');
  for (const std::string_view extension : track_extensions()) {
    EXPECT_THAT(parse_track(large, "a" + std::string(extension)).error().message,
                HasSubstr(": file: got 67108865 bytes, expected at most 64 MiB"));
    EXPECT_EQ(parse_track("", "a" + std::string(extension), {.default_left = -1.0}).error().code,
              ErrorCode::kInvalidArgument);
  }
}

TEST(TrackCodec, TheLibraryHasTheTracksOfEveryFormat) {
  const test::Folder folder;
  fs::create_directories(folder.path("tracks"));
  ::setenv("CHICANE_DATA_DIR", folder.path("").c_str(), 1);
  int number = 0;
  for (const std::string_view extension : track_extensions()) {
    const std::string name = "format-" + std::to_string(++number);
    folder.write("tracks/" + name + std::string(extension), "\n");
    const auto file = test::good(locate(Shelf::kTrack, name));
    EXPECT_THAT(*file, ::testing::EndsWith(name + std::string(extension)));
    const std::vector<Entry> all = entries(Shelf::kTrack);
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Entry& each) { return each.name == name; }));
  }
  ::unsetenv("CHICANE_DATA_DIR");
}

}  // namespace
}  // namespace chicane::protocol
