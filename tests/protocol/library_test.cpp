// SPDX-License-Identifier: MIT
#include "chicane/protocol/library.hpp"

#include <unistd.h>

#include "chicane/base/text.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/data_folders.hpp"
#include "chicane/protocol/origin.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::protocol {
namespace {

using scenario::Scenario;

class Library : public testing::Test, protected test::Folder {
 protected:
  Library() {
    fs::create_directories(folder_ / "presets");
    fs::create_directories(folder_ / "tracks");
  }
};

std::string error_of(const Request& request) { return test::refusal_of(compose(request)); }
/// Every tunable that differs, as "key: a, b".
std::vector<std::string> differences(const Scenario& a, const Scenario& b, std::string_view group) {
  std::vector<std::string> found;
  for (const Parameter& p : list()) {
    if (!p.key.starts_with(group)) continue;
    const Value x = get(a, p);
    const Value y = get(b, p);
    const auto* u = std::get_if<double>(&x);
    const auto* v = std::get_if<double>(&y);
    // Units are converted on reading: two roundings.
    const bool is_same =
        u != nullptr && v != nullptr ? (*u == *v || std::fabs(*u - *v) <= 1e-14 * std::fabs(*u)) : x == y;
    if (!is_same) found.push_back(std::string(p.key) + ": " + get_text(a, p) + ", " + get_text(b, p));
  }
  return found;
}

// The file of a car whose log did not use the tyres: `identify` writes 0.
TEST_F(Library, RefusesToRaceACarWhoseGripIsNotKnown) {
  const std::string car =
      write("mine.yaml", "# mine\nplant: road-car\nfriction_low: 0\nvehicle:\n  friction: 1.1\n");
  EXPECT_EQ(error_of({"", {{"car", car}}}), "");
  const std::string error = error_of({"", {{"car", car}, {"preset", "race"}}});
  EXPECT_THAT(error, HasSubstr("mine.yaml:3: friction_low: got 0"));
  EXPECT_THAT(error, HasSubstr("--set friction_low=NUMBER"));
  EXPECT_EQ(error.find('\n'), std::string::npos);
  const auto stated = test::good(compose({"", {{"car", car}, {"preset", "race"}, {"friction_low", "0.7"}}}));
  EXPECT_EQ(stated->assumed_vehicle().friction, 0.7);
  EXPECT_EQ(stated->vehicle.friction, 1.1);
  ASSERT_EQ(stated->notices.size(), 1U);
  EXPECT_THAT(stated->notices[0], HasSubstr("planned with a friction of 0.7"));
}

TEST_F(Library, TheLeastFrictionIsOfARaceAlone) {
  for (const auto& [preset, low, assumed] :
       {std::tuple{"default", "0.7", 1.2}, {"race", "inf", 1.2}, {"race", "3", 1.2}, {"race", "0.7", 0.7}}) {
    const auto scenario =
        test::good(compose({"", {{"car", "road-car"}, {"preset", preset}, {"friction_low", low}}}));
    EXPECT_EQ(scenario->assumed_vehicle().friction, assumed) << preset << ' ' << low;
    EXPECT_EQ(scenario->notices.size(), assumed < 1.2 ? 1U : 0U) << preset << ' ' << low;
  }
}

TEST_F(Library, EveryShippedFileLoadsAndSaysWhatItIs) {
  std::vector<std::string> names;
  for (const Entry& entry : entries(Shelf::kPreset)) {
    names.push_back(entry.name);
    EXPECT_GT(entry.description.size(), 20u) << entry.name;
    EXPECT_EQ(test::good(compose({"", {{"preset", entry.name}}}))->preset, entry.name);
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"default", "delay-in-model", "fast-short-step",
                                            "measured-latency", "pid", "sixty-mph", "weighted"}));
  EXPECT_FALSE(entries(Shelf::kScenario).empty());
  for (const Entry& entry : entries(Shelf::kScenario)) EXPECT_EQ(error_of({entry.name, {}}), "");
  EXPECT_THAT(differences(*compose({"", {{"preset", "default"}}}), Scenario{}, ""), IsEmpty());
}

TEST_F(Library, CarFilesSayWhatTheCodeSays) {
  for (const model::VehicleParams& car : {model::udacity_params(), model::road_car_params()}) {
    const Result<Scenario> scenario = test::good(compose({"", {{"car", car.name}}}));
    EXPECT_EQ(scenario->plant, car.name);
    Scenario expected;
    expected.vehicle = car;
    EXPECT_THAT(differences(*scenario, expected, "vehicle."), IsEmpty());
  }
}

TEST_F(Library, LaterLayersWin) {
  const std::string file = write("run.yaml", "preset: sixty-mph\nlaps: 5\ncubic_mpc.horizon_steps: 9\n");
  Result<Scenario> scenario = test::good(compose({file, {{"cubic_mpc.horizon_steps", "11"}, {"seed", "4"}}}));
  EXPECT_EQ(scenario->preset, "sixty-mph");
  EXPECT_EQ(scenario->controller, "cubic-mpc");
  EXPECT_EQ(scenario->laps, 5);
  EXPECT_EQ(scenario->seed, 4u);
  EXPECT_EQ(std::get<controller::CubicMpcOptions>(scenario->controllers).horizon_steps, 11);
  EXPECT_NEAR(std::get<controller::CubicMpcOptions>(scenario->controllers).speed_reference, 26.8224, 1e-12);
  scenario = test::good(compose({file, {{"preset", "weighted"}}}));
  EXPECT_EQ(scenario->preset, "weighted");
  EXPECT_EQ(std::get<controller::CubicMpcOptions>(scenario->controllers).horizon_steps, 9);
}

TEST_F(Library, APresetMayBuildOnAnotherButNotOnItself) {
  const std::string file = write("mine.yaml", "preset: sixty-mph\ncubic_mpc.horizon_steps: 8\n");
  const Result<Scenario> scenario = test::good(compose({"", {{"preset", file}}}));
  const auto& options = std::get<controller::CubicMpcOptions>(scenario->controllers);
  EXPECT_EQ(options.horizon_steps, 8);
  EXPECT_EQ(options.latency_handling, controller::LatencyHandling::kPositionOnly);
  const std::string loop = write("loop.yaml", "preset: " + path("loop.yaml") + "\n");
  EXPECT_THAT(error_of({"", {{"preset", loop}}}), HasSubstr("more than 8 presets"));
}

TEST_F(Library, NamesAllFaultsWhereTheyStandAndWhatIsKnown) {
  const std::string preset = write("mine.yaml", "# builds on nothing\npreset: no-such\n");
  const std::string car = write("car.yaml", "plant: udacity\nlaps: 3\n");
  struct Fault {
    Request request;
    std::vector<const char*> words;
  };
  for (const auto& [request, words] : std::vector<Fault>{
           {{"", {{"preset", "sixty_mph"}}},
            {"preset: got \"sixty_mph\", expected a file or one of", "(did you mean sixty-mph?)"}},
           {{"", {{"car", "rode-car"}}}, {"(did you mean road-car?)"}},
           {{"", {{"track", "nowhere"}}}, {"track: got \"nowhere\""}},
           {{"", {{"track", "no/such.csv"}}}, {"track: got no/such.csv, expected a file that exists"}},
           {{write("run.yaml", "preset: nobody\nlaps: 1\ncar: rode-car\ntrack: nowhere\n"), {}},
            {"run.yaml:1: preset: got \"nobody\"", "run.yaml:3: car: got \"rode-car\"",
             "run.yaml:4: track: got \"nowhere\""}},
           {{"", {{"preset", preset}}}, {"mine.yaml:2: preset: got \"no-such\""}},
           {{write("layers.yaml", "laps: -1\nlatency_ms: slow\n"),
             {{"preset", "nobody"}, {"seed", "-1"}, {"latenzy_ms", "1"}}},
            {"layers.yaml:1: laps: got -1, expected an integer in [0, 10000]",
             "layers.yaml:2: latency_ms: got slow", "preset: got \"nobody\"", "seed: got -1",
             "latenzy_ms: got an unknown key"}},
           {{"", {{"car", car}}},
            {"car.yaml:2: laps: got a setting of a run, expected only plant, plant_params, vehicle"}}}) {
    for (const char* each : words) EXPECT_THAT(error_of(request), HasSubstr(each));
  }
}

TEST_F(Library, FindsFilesBesideAScenarioAndInTheFolderTheEnvironmentNames) {
  write("tracks/mine.csv", "# a track\n");
  const auto scenario = test::good(compose({write("run.yaml", "track: tracks/mine.csv\n"), {}}));
  EXPECT_EQ(scenario->track, (folder_ / "tracks/mine.csv").string());
  write("presets/from-elsewhere.yaml", "# Mine\ncontroller: pid\n");
  ::setenv("CHICANE_DATA_DIR", folder_.c_str(), 1);
  const Result<std::string> found = locate(Shelf::kPreset, "from-elsewhere");
  ::unsetenv("CHICANE_DATA_DIR");
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(*found, (folder_ / "presets/from-elsewhere.yaml").string());
  EXPECT_FALSE(locate(Shelf::kPreset, "from-elsewhere"));
  const Error error = read_file(folder_.string()).error();
  EXPECT_EQ(error.code, ErrorCode::kNotFound);
  EXPECT_THAT(error.message, HasSubstr("got a folder, expected a file"));
  EXPECT_FALSE(compose({(folder_ / "presets").string(), {}}));
}

TEST(RememberedFiles, ComposeTheSameAsFiles) {
  RememberedFiles files;
  for (int round = 0; round < 2; ++round) {
    for (const char* preset : {"default", "weighted", "pid"}) {
      for (const char* car : {"udacity", "road-car"}) {
        const Request request{.scenario_file = "noisy-sensor",
                              .settings = {{"preset", preset}, {"car", car}, {"laps", "3"}},
                              .speed_mps = "20"};
        const auto once = compose(request);
        const auto remembered = compose(request, files);
        ASSERT_TRUE(once && remembered);
        EXPECT_EQ(write_document(*once, "all"), write_document(*remembered, "all"));
      }
    }
  }
}

TEST(RememberedFiles, AreReadOnceAndFailuresAgain) {
  const test::Folder folder;
  const fs::path file = folder.path("remembered.yaml");
  const Request request{.scenario_file = {}, .settings = {{"preset", file.string()}}};
  RememberedFiles files;
  EXPECT_FALSE(compose(request, files)) << "there is none yet";
  std::ofstream(file) << "laps: 4\n";
  EXPECT_EQ(compose(request, files)->laps, 4);
  std::ofstream(file, std::ios::trunc) << "laps: 5\n";
  EXPECT_EQ(compose(request, files)->laps, 4);
  EXPECT_EQ(compose(request)->laps, 5);
  fs::remove(file);
  EXPECT_EQ(compose(request, files)->laps, 4);
}

TEST(RememberedFiles, AreBoundedInNumber) {
  RememberedFiles files;
  std::size_t reads = 0;
  const auto read = [&]() -> Result<Document> {
    ++reads;
    return Document{};
  };
  for (std::size_t i = 0; i < 3 * RememberedFiles::kMost; ++i)
    ASSERT_TRUE(files.document(Shelf::kPreset, std::to_string(i), read));
  EXPECT_EQ(reads, 3 * RememberedFiles::kMost);
  ASSERT_TRUE(files.document(Shelf::kPreset, std::to_string(3 * RememberedFiles::kMost - 1), read));
  EXPECT_EQ(reads, 3 * RememberedFiles::kMost);
}

TEST(Origin, ReadsTheBandsThatIdentifyWrites) {
  const auto found = identified_in("vehicle:\n  mass_kg: 3.4  # " + band_remark(3.2, 3.6) +
                                   "\n  roll: 1  # [assumed]\n  width_m: 2  # [plant]\n");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], (IdentifiedValue{"mass_kg", 3.4, 3.2, 3.6}));
  EXPECT_EQ(found[1].key, "roll");
  EXPECT_TRUE(std::isnan(found[1].low) && std::isnan(found[1].high));
}

TEST(Origin, IsOfOurMarksAndOfTheHeadOfAFileOnly) {
  for (const char* text : {"vehicle:\n  a: 1  # [assumed]\n  b: 2  # [log] from a paper\n",
                           "a: x  # [log] 1 to 2\nb: 1  # [log] 1 to\n: 1  # [log] to 2\n"})
    EXPECT_THAT(identified_in(text), IsEmpty());
  EXPECT_THAT(head_remarks("# SPDX-License-Identifier: MIT\n# A hall\n# closed=true, spacing_m=1\n"
                           "# note: width=9 assumed\n# x_m,y_m\n1,2\n# behind\n"),
              ElementsAre("A hall", "width=9 assumed"));
  EXPECT_THAT(head_remarks("plant: x\n# late\n"), IsEmpty());
  const auto content = test::good(
      parse_track("# note: track_scale=2\n# note: x_m, y_m\nx_m,y_m\n0,0\n9,0\n9,9\n0,9\n", "a.csv"));
  EXPECT_EQ(content->points.size(), 4U) << "a note is no setting";
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
  const Origin origin = origin_of(*compose({"", {{"car", "road-car"}}}));
  ASSERT_FALSE(origin.car_notes.empty());
  EXPECT_THAT(origin.car_notes.front(), HasSubstr("road car"));
  EXPECT_THAT(origin.identified, IsEmpty());
  EXPECT_EQ(origin.road_kind, "table of points");
}

/// "waypoints.gpx" with a kind, and one thing that its reader assumed.
TEST(Origin, AnImportedRoadSaysWhatItWasReadFromAndWhatWasAssumed) {
  const auto origin_at = [](const std::string& file) {
    return origin_of(
        *test::good(compose({"", {{"track", CHICANE_SOURCE_DIR "/tests/data/tracks/" + file}}})));
  };
  for (const auto& [file, kind] : {std::pair{"three_laps.gpx", "GPX"},
                                   {"course.geojson", "GeoJSON"},
                                   {"cones.csv", "cones"},
                                   {"course.xodr", "OpenDRIVE"}})
    EXPECT_EQ(origin_at(file).road_kind, kind) << file;
  EXPECT_THAT(origin_at("three_laps.gpx").road_notes,
              Contains(HasSubstr("width: not in the file, 4.5 m left and 4.5 m right assumed")));
}

std::vector<std::string> folders_of(const DataOrigins& origins) { return data_folders(origins, "tracks"); }

TEST(DataFolders, AreInTheirOrderAndNamedOnce) {
  const std::vector<std::string> fixed = folders_of({});
  EXPECT_EQ(fixed.front(), "./tracks");
  EXPECT_EQ(fixed.back(), "/usr/share/chicane/tracks");
  std::vector<std::string> folders = folders_of({.program = "/none/such/bin/program"});
  folders.resize(4);
  EXPECT_THAT(folders, ElementsAre("./tracks", "/none/such/bin/share/chicane/tracks",
                                   "/none/such/share/chicane/tracks", "/none/share/chicane/tracks"));
  folders = folders_of({.environment = "/mine",
                        .program = "/none/bin/python3",
                        .shared_object = "/none/lib/module/chicane.so",
                        .header = "/none/prefix/include/chicane/protocol/data_folders.hpp"});
  const auto place = [&](std::string_view folder) {
    return std::find(folders.begin(), folders.end(), folder) - folders.begin();
  };
  EXPECT_EQ(place("/mine/tracks"), 1);
  EXPECT_LT(place("/none/share/chicane/tracks"), place("/none/lib/module/share/chicane/tracks"));
  EXPECT_LT(place("/none/lib/module/share/chicane/tracks"), place("/none/prefix/share/chicane/tracks"));
  EXPECT_LT(place("/none/prefix/share/chicane/tracks"), place("/usr/share/chicane/tracks"));
  EXPECT_EQ(folders_of({.program = "/none/bin/program", .shared_object = "/none/bin/program"}).size(),
            fixed.size() + 3);
  for (const std::string& here : {std::string("."), std::filesystem::current_path().string()})
    EXPECT_EQ(folders_of({.environment = here}), fixed) << "the working folder is the first one";
}

TEST(DataOrigins, AreThisProgramAndNoInstallation) {
  const DataOrigins origins = data_origins();
  EXPECT_EQ(std::filesystem::path(origins.program).filename(), "protocol_test");
  EXPECT_EQ(origins.header, "") << "tests are compiled with the source tree, not with an installation";
  ::setenv("CHICANE_DATA_DIR", "/mine", 1);
  EXPECT_EQ(data_origins().environment, "/mine");
  ::unsetenv("CHICANE_DATA_DIR");
}

TEST(BuildIds, AreThoseOfThisProgramAndOfItsLibraries) {
  const std::string ids = build_ids();
  EXPECT_GE(ids.size(), 40U) << "20 bytes each: this program's, and that of the C library";
  EXPECT_EQ(build_ids(), ids);
}

}  // namespace
}  // namespace chicane::protocol
