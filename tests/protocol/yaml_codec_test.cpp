// SPDX-License-Identifier: MIT
#include "chicane/protocol/yaml_codec.hpp"

#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/protocol/yaml_tree.hpp"
#include "support/chicane_test.hpp"
#include "support/expect_said.hpp"
#include "support/folder.hpp"

namespace chicane::protocol {
namespace {

using scenario::Scenario;

const fs::path kBroken = fs::path(CHICANE_SOURCE_DIR) / "tests/protocol/fixtures/broken";

Result<Scenario> load(std::string_view text, const std::string& file) {
  const Result<Document> document = parse_document(text, file);
  if (!document) return fail(document.error());
  Scenario scenario;
  if (const Result<void> applied = apply_layers({&*document, 1}, scenario); !applied)
    return fail(applied.error());
  return scenario;
}

std::string error_of(std::string_view text) { return test::refusal_of(load(text, "f")); }

struct Broken {
  const char* name;
  std::vector<const char*> expected;  // parts of the message, the file's name stands before each
};

// clang-format off
const Broken kFiles[] = {
    {"alias_bomb", {R"(1: a: got an unknown key)"}},
    {"alias_of_itself", {R"(1: text: got an alias of what it is part of, expected another)"}},
    {"bad_indentation", {R"(3: text: got illegal map value, expected valid YAML)"}},
    {"colon_missing", {R"(2: text: got illegal map value, expected valid YAML)"}},
    {"comma_after_comment", {R"(3: text: got a comma outside of a list, expected valid YAML)"}},
    {"comma_first", {R"(1: text: got a comma outside of a list, expected valid YAML)"}},
    {"decimal_comma", {R"(2: cubic_mpc.step_length_s: got 0,1, expected a number in [0.005, 0.5] s)"}},
    {"deep_nesting", {R"(text: got very deep nesting, expected at most 8 levels)"}},
    {"delay_is_not_one_step", {R"(4: cubic_mpc.latency_ms: got 100 ms, expected cubic_mpc.step_length_s (0.05 s))"}},
    {"duplicate", {R"(3: latency_ms: got it a second time, expected it once (first on line 1))"}},
    {"duplicate_dotted", {R"(3: cubic_mpc.horizon_steps: got it a second time, expected it once (first on line 1))"}},
    {"empty", {R"(1: file: got an empty file, expected a map of settings)"}},
    {"empty_text", {R"(1: track: got nothing, expected text)"}},
    {"fraction_for_integer", {R"(2: cubic_mpc.horizon_steps: got 10.5, expected an integer in [2, 200])"}},
    {"hexadecimal", {R"(1: laps: got 0x10, expected an integer in [0, 10000])"}},
    {"infinite", {R"(2: cubic_mpc.weight_lateral: got .inf, expected a number in [0, 1000000] 1/m²)"}},
    {"list_at_top", {R"(1: file: got a list, expected a map of settings)"}},
    {"list_for_group", {R"(1: vehicle: got a list, expected a map of settings)"}},
    {"list_for_number", {R"(1: latency_ms: got a list, expected a number in [0, 500] ms)"}},
    {"map_as_key", {R"(1: key: got a map as a key, expected a name)"}},
    {"map_for_number", {R"(1: latency_ms: got a map, expected a number in [0, 500] ms)"}},
    {"merge_key", {R"(4: vehicle.<<: got an unknown key)"}},
    {"negative_seed", {R"(1: seed: got -1, expected an integer in [0, 9007199254740992])"}},
    {"not_a_number", {R"(1: latency_ms: got .nan, expected a number in [0, 500] ms)"}},
    {"not_utf8", {R"(1: text: got byte 0xe9, expected UTF-8)"}},
    {"nothing", {R"(2: latency_ms: got nothing, expected a number in [0, 500] ms)"}},
    {"nul_byte", {R"(2: text: got control character 0x00, expected text)"}},
    {"number_for_group", {R"(1: cubic_mpc: got 10, expected a map of settings)"}},
    {"number_for_switch", {R"(2: cubic_mpc.polar_waypoints: got 1, expected true or false)"}},
    {"number_in_quotes", {R"(1: laps: got "3" in quotes, expected an integer in [0, 10000])"}},
    {"number_with_unit", {R"(1: latency_ms: got 100 ms, expected a number in [0, 500] ms)"}},
    {"only_comments", {R"(1: file: got an empty file, expected a map of settings)"}},
    {"overflow", {R"(1: seed: got 1e400, expected an integer in [0, 9007199254740992])"}},
    {"overlong_utf8", {R"(2: text: got byte 0xc0, expected UTF-8)"}},
    {"preset_is_a_list", {R"(1: preset: got a list, expected the name of a preset)"}},
    {"preset_is_empty", {R"(1: preset: got nothing, expected the name of a preset)"}},
    {"scalar_at_top", {R"(1: file: got latency_ms, expected a map of settings)"}},
    {"several_faults", {R"(1: latency_ms: got 900)", R"(2: laps: got -1)", R"(4: vehicle.mass_kg: got heavy)", R"(5: vehicle.colour: got an unknown key)"}},
    {"tab", {R"(2: text: got a tab in the indentation, expected spaces)"}},
    {"tag", {R"(1: laps: got the tag tag:yaml.org,2002:python/object:os.system, expected an integer in [0, 10000])"}},
    {"text_for_number", {R"(1: latency_ms: got slow, expected a number in [0, 500] ms)"}},
    {"too_high", {R"(1: latency_ms: got 900, expected a number in [0, 500] ms)"}},
    {"too_low", {R"(2: vehicle.mass_kg: got -900, expected a number in [0.001, 100000] kg)"}},
    {"two_documents", {R"(2: file: got 2 documents, expected one)"}},
    {"unclosed_bracket", {R"(expected valid YAML)"}},
    {"unclosed_quote", {R"(text: got illegal EOF in scalar, expected valid YAML)"}},
    {"unit_forgotten", {R"(2: latency: got an unknown key, expected one of `chicane list parameters` (did you mean latency_ms?))"}},
    {"unknown_alias", {R"(1: text: got the referenced anchor is not defined, expected valid YAML)"}},
    {"unknown_choice", {R"(1: controller: got mpc, expected one of tracking-mpc, cubic-mpc, pid, )"}},
    {"unknown_group", {R"(1: cubic_mcp: got an unknown key, expected one of)"}},
    {"unknown_key", {R"(2: latenzy_ms: got an unknown key, expected one of `chicane list parameters` (did you mean latency_ms?))"}},
    {"unknown_key_in_group", {R"(2: cubic_mpc.horizon_step: got an unknown key, expected one of `chicane list parameters` (did you mean cubic_mpc.horizon_steps?))"}},
    {"unknown_latency_handling", {R"(2: cubic_mpc.latency_handling: got magic, expected one of none, roll-forward, measured, position-only, inside-model)"}},
    {"utf16", {R"(1: text: got byte 0xff, expected UTF-8)"}},
    {"wrong_group", {R"((did you mean vehicle.mass_kg?))"}},
    {"yes_for_switch", {R"(1: tracking_mpc.compensate_delay: got yes, expected true or false)"}},
};
// clang-format on

TEST(YamlCodec, EveryBrokenFileIsRefusedWithFileLineAndKey) {
  for (const Broken& broken : kFiles) {
    const fs::path file = kBroken / (std::string(broken.name) + ".yaml");
    ASSERT_TRUE(fs::exists(file)) << file;
    const std::string refusal = test::refusal_of(load(test::content_of(file), "broken.yaml"));
    EXPECT_THAT(refusal, StartsWith("broken.yaml:")) << broken.name;
    for (const char* expected : broken.expected) EXPECT_THAT(refusal, HasSubstr(expected)) << broken.name;
  }
  const auto count = std::count_if(fs::directory_iterator(kBroken), {},
                                   [](const auto& item) { return item.path().extension() == ".yaml"; });
  EXPECT_EQ(count, static_cast<std::ptrdiff_t>(std::size(kFiles))) << "each has an expectation";
}

TEST(YamlCodec, ReadsNestedDottedRosAndJson) {
  for (const char* text : {"cubic_mpc:\n  horizon_steps: 20\n", "cubic_mpc.horizon_steps: 20\n",
                           "/**:\n  ros__parameters:\n    cubic_mpc:\n      horizon_steps: 20\n",
                           "/**:\n  ros__parameters:\n    cubic_mpc.horizon_steps: 20\n",
                           "{\"cubic_mpc\": {\"horizon_steps\": 20}}",
                           "\xef\xbb\xbf"
                           "cubic_mpc:\r\n  horizon_steps: 20\r\n"}) {
    const Result<Scenario> scenario = test::good(load(text, "f"));
    EXPECT_EQ(std::get<controller::CubicMpcOptions>(scenario->controllers).horizon_steps, 20) << text;
  }
}

TEST(YamlCodec, NothingIsAppliedWhenAnythingIsWrong) {
  Document document;
  document.file = "f";
  document.assignments.push_back({find("laps"), 7.0, 1});
  document.assignments.push_back({find("latency_ms"), 900.0, 2});
  Scenario scenario;
  EXPECT_THAT(test::refusal_of(apply_layers({&document, 1}, scenario)), HasSubstr("f:2: latency_ms"));
  EXPECT_EQ(scenario.laps, Scenario{}.laps);
}

TEST(YamlCodec, AnAnswerToAnyFileIsShort) {
  std::string faults, values = "faults: [";
  for (int i = 0; i < 20000; ++i) faults.append("k").append(std::to_string(i)).append(": 1\n");
  for (int i = 0; i < 60000; ++i) values += "1,";
  EXPECT_THAT(error_of(std::string(1000000, '#')),
              HasSubstr("f: file: got 1000000 bytes, expected at most 262144"));
  EXPECT_THAT(error_of(faults), ::testing::EndsWith("f: and perhaps more"));
  EXPECT_LT(error_of(faults).size(), 20000u);
  EXPECT_THAT(error_of(values + "]"), HasSubstr("1: file: got more than 50000 values, expected fewer"));
}

// yaml-cpp 0.7 found documents without end where one began with a comma: the program hung and ate its
// machine.
TEST(YamlCodec, PatternsThatRepeatToTheLimitEnd) {
  const std::vector<std::string> patterns{
      ",",     "\n,",    "---\n", "...\n", "[",    "{a: ", "? ",     "- ",         "a: &a ",  "*a ",
      "[],",   "a: b\n", "'",     "\"",    ":",    "!",    "|\n",    "%TAG ! x\n", "{? ",     "<<: ",
      "\n- [", "]",      "}",     "a,",    "- - ", "\n ",  "a: |\n", "#,\n",       "--- ,\n", "[,"};
  constexpr std::size_t kLength = 200000;  // bytes; the largest file has 262144
  for (const std::string& before : {std::string(), std::string("# x\n"), std::string("a: 1\n...\n")}) {
    for (const std::string& pattern : patterns) {
      std::string text = before;
      while (text.size() < kLength) text += pattern;
      EXPECT_LT(error_of(text).size(), 20000u) << before << pattern;
    }
  }
}

TEST(YamlCodec, AliasesAreFollowedUpToTheLimit) {
  EXPECT_THAT(error_of("/**: &m {latency_ms: 50}\n/a: *m\n"), HasSubstr("got it a second time"));
  EXPECT_THAT(error_of("vehicle: {mass_kg: &m 900, front_axle_m: *m}\n"), HasSubstr("front_axle_m: got 900"));
  EXPECT_EQ(error_of("latency_ms: &m 50\ncubic_mpc: {latency_ms: *m}\n"), "");
}

TEST(YamlCodec, WritesOnlyWhatDiffers) {
  Scenario scenario;
  scenario.laps = 9;
  scenario.vehicle.mass = 1234.0;
  EXPECT_EQ(write_document(scenario, "Mine"), "# Mine\nlaps: 9\nvehicle:\n  mass_kg: 1234\n");
  EXPECT_EQ(write_document({}, "Nothing"), "# Nothing\n");
}

TEST(YamlCodec, TheModelFollowsFromThePlantAndWhatIsSetOfItStays) {
  const Result<Scenario> scenario = test::good(load(
      "plant: double-track\nvehicle: {friction: 0.9}\nplant_params: {mass_kg: 800, drive_force_n: 4000}\n",
      "f"));
  model::VehicleParams expected = sim::model_of(scenario->plant_params, model::udacity_params());
  EXPECT_EQ(expected.mass, 800.0);
  expected.friction = 0.9;
  EXPECT_EQ(scenario->vehicle, expected);
  EXPECT_EQ(write_document(*scenario, "Mine"),
            "# Mine\nplant: double-track\nvehicle:\n  friction: 0.9\nplant_params:\n  mass_kg: 800\n"
            "  drive_force_n: 4000\n");
  EXPECT_THAT(error_of("plant: road-car\nplant_params: {mass_kg: 800}\n"),
              HasSubstr("1: plant: got road-car, expected double-track, the only one with plant_params"));
}

TEST(YamlCodec, WritesAPresetThatBuildsOnAnother) {
  scenario::Scenario base;
  base.preset = "sixty-mph";
  std::get<controller::CubicMpcOptions>(base.controllers).horizon_steps = 7;
  scenario::Scenario changed = base;
  std::get<controller::CubicMpcOptions>(changed.controllers).horizon_steps =
      10;  // a default again, but not the preset's
  changed.latency = 0.05;
  EXPECT_EQ(write_preset(changed, base, "Mine"),
            "# Mine\npreset: \"sixty-mph\"\ntrack: \"lakeside\"\ncar: \"udacity\"\nlatency_ms: 50\n"
            "cubic_mpc:\n  horizon_steps: 10\n");
  const Result<Document> read = test::good(parse_document(write_preset(changed, base, "Mine"), "mine.yaml"));
  EXPECT_EQ(read->preset, "sixty-mph");
  EXPECT_EQ(read->assignments.size(), 4U);
}

/// Everything that readers of a tree look at.
std::string written(const YamlNode& node) {
  std::string text = std::to_string(static_cast<int>(node.kind)) + " " + node.text;
  if (node.kind != YamlNode::Kind::kNothing) text += "@" + std::to_string(node.line);
  if (node.is_scalar()) text += node.tag;
  for (const YamlNode* child : node.children) text += "(" + written(*child) + ")";
  return text;
}

/// kinds, lines and texts of both parsers
void expect_same(const std::string& text, const std::string& file) {
  const auto plain = parse_plain_yaml(text, file);
  const auto whole = parse_yaml(text, file);
  ASSERT_TRUE(plain) << plain.error().message;
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_EQ(written(*plain->root), written(*whole->root)) << file;
}

TEST(PlainYaml, ReadsAllShippedPresetsAndCarsAsTheWholeParserDoes) {
  int read = 0;
  for (const Shelf shelf : {Shelf::kPreset, Shelf::kCar}) {
    for (const Entry& entry : entries(shelf)) {
      const auto text = test::good(read_file(entry.file));
      expect_same(*text, entry.file);
      ++read;
    }
  }
  EXPECT_GE(read, 12);
}

TEST(PlainYaml, ReadsWhatTheirKindMayHave) {
  for (const std::string text :
       {"", "# nothing\n", "a: 1", "a: 1\nb:\n  c: -2.5 # why\n  d: x#y\ne: .inf\r\n",
        "a:\n    b:\n     c: 1\n    d: 2\n", "a:\nb: 1\n", "a: two words\n\n\n# end\nb: http://x\n"}) {
    expect_same(text, "file.yaml");
  }
}

TEST(PlainYaml, RefusesWhatOnlyTheWholeParserUnderstandsWithItsLine) {
  for (const std::string text :
       {"a: 1\nb: [1, 2]", "a: 1\n- b", "a: 1\nb: \"c\"", "a: 1\n\tb: 2", "a: 1\nb", "a: 1\n  b: 2",
        "a: 1\nb: {c: 1}", "a: 1\nb: &x 1", "a: 1\nb: |", "a: 1\n--- ", "a: 1\nb: c: 2"}) {
    EXPECT_THAT(test::refusal_of(parse_plain_yaml(text, "file.yaml")), StartsWith("file.yaml:2: ")) << text;
  }
}

TEST(FaultText, NamesAFaultItsTimeAndPerhapsMoreAndSaysWhatIsWrong) {
  const auto all = test::good(parse_fault("half_grip@12+5*0.25"));
  EXPECT_EQ(all->fault, sim::fault_named("half_grip"));
  EXPECT_EQ(all->at, 12.0);
  EXPECT_EQ(all->duration, 5.0);
  EXPECT_EQ(all->strength, 0.25);
  const auto least = test::good(parse_fault("link_lost@0.5"));
  EXPECT_EQ(least->duration, sim::kind_of(*sim::fault_named("link_lost")).duration);
  test::expect_said([](const std::string& text) { return test::refusal_of(parse_fault(text)); },
                    {{"half_girp@12", "did you mean half_grip?"},
                     {"half_grip", "faults.at_s: got nothing"},
                     {"half_grip@-1", "faults.at_s: got -1, expected a number in [0, "},
                     {"half_grip@1+", "faults.for_s: got +"},
                     {"half_grip@1*7", "faults.strength: got 7, expected a number in [0.05, 1]"},
                     {"link_lost@1*7", "link_lost has no strength"},
                     {"", "faults.name: got nothing"},
                     {"half_grip@nan", "faults.at_s"}});
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
  test::expect_said(
      [](const std::string& text) { return test::refusal_of(parse_document(text, "f.yaml")); },
      {{"faults: 3\n", "f.yaml:1: faults: got 3, expected a list"},
       {"faults:\n  - 3\n", "f.yaml:2: faults: got 3, expected {name: half_grip"},
       {"faults:\n  - {name: half_grip, at: 3}\n", "f.yaml:2: at: got an unknown key, expected name"},
       {"laps: 1\nfaults:\n  - {name: hlaf_grip, at_s: 3}\n",
        "f.yaml:3: faults.name: got hlaf_grip, expected one of `chicane list faults` (did you mean "
        "half_grip?)"},
       {"faults:\n  - {name: half_grip, at_s: [1]}\n", "f.yaml:2: at_s: got a list, expected text"},
       {"faults:\n  - {name: half_grip, at_s: 1, for_s: 0}\n", "faults.for_s: got 0"}});
}

TEST(FaultControls, AreOneSwitchForEachWithDurationAndStrength) {
  const auto plain = test::good(read_switch("half_grip", "true"));
  EXPECT_EQ(plain->duration, sim::default_event(plain->fault, 0.0).duration);
  const auto chosen = test::good(read_switch("half_grip", "+7.5*0.25"));
  EXPECT_EQ(chosen->duration, 7.5);
  EXPECT_EQ(chosen->strength, 0.25);
  EXPECT_EQ(read_switch("half_grip", "*0.25")->duration, plain->duration);
  for (const char* wrong : {"", "1", "yes", "+", "+-1", "+5*9", "+5@3", "+nan"})
    EXPECT_THAT(test::refusal_of(read_switch("half_grip", wrong)), HasSubstr("fault.half_grip: got "))
        << wrong;
  const auto controls = fault_controls();
  ASSERT_EQ(controls.size(), sim::fault_kinds().size());
  EXPECT_EQ(controls[0].key, "fault.link_lost");
  EXPECT_EQ(controls[0].option.kind, Kind::kBool);
  EXPECT_EQ(controls[0].fault, &sim::fault_kinds()[0]);
}

}  // namespace
}  // namespace chicane::protocol
