// SPDX-License-Identifier: MIT
#include "chicane/live/live_settings.hpp"

#include <nlohmann/json.hpp>

#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"
#include "live/settings_of_a_run.hpp"
#include "support/chicane_test.hpp"
#include "support/folder.hpp"

namespace chicane::live {
namespace {

using protocol::foxglove::Parameter;
using protocol::foxglove::ParameterValue;
using test::another_value;
using test::Live;
using test::scenario_of;

TEST(LiveSettings, OfferEveryTunableOfTheSchemaAndTheControlsOfTheRun) {
  Live live;
  const std::vector<Parameter> all = live.settings.list();
  EXPECT_EQ(all.size(), protocol::list().size() + 4);
  for (const protocol::Parameter& row : protocol::list())
    EXPECT_TRUE(live.settings.get(row.key).has_value()) << row.key;
  EXPECT_EQ(live.value("tracking_mpc.horizon_steps"), ParameterValue(40.0));
  EXPECT_EQ(live.value("latency_ms"), ParameterValue(100.0));
  EXPECT_EQ(live.value("track"), ParameterValue(std::string("lakeside")));
  EXPECT_EQ(live.value("run.pace"), ParameterValue(1.0));
  EXPECT_EQ(live.value("vehicle.drive_power_per_mass_wpkg"), ParameterValue(std::string("inf")));
}

TEST(LiveSettings, HandOverEachKindOfValueAsTheTextThatSetTakes) {
  Live live;
  const std::vector<std::pair<Parameter, std::string>> values{
      {{"tracking_mpc.weight_lateral", 2.5}, "2.5"},
      {{"tracking_mpc.horizon_steps", 20.0}, "20"},
      {{"tracking_mpc.compensate_delay", false}, "false"},
      {{"cubic_mpc.latency_handling", std::string("measured")}, "measured"},
      {{"latency_ms", 33.3}, "33.3"},
      {{"sensor.heading_noise_deg", 0.2}, "0.2"},
      {{"run.pace", 0.25}, "0.25"},
      {{"manual.is_on", true}, "true"},
      {{"manual.steer", -0.5}, "-0.5"}};
  for (const auto& [parameter, text] : values) {
    ASSERT_TRUE(live.settings.set(parameter)) << parameter.name;
    const telemetry::Change change = live.next();
    EXPECT_EQ(change.name.view(), parameter.name);
    EXPECT_EQ(change.value.view(), text);
    EXPECT_FALSE(change.starts_anew);
    EXPECT_EQ(live.value(parameter.name), parameter.value) << parameter.name;
  }
}

TEST(LiveSettings, RefuseWhatSetWouldRefuseInOneSentence) {
  Live live;
  const std::string latency = ", expected a number in [0, 500] ms", share = ", expected a number in [-1, 1]";
  for (const auto& [parameter, sentence] : std::vector<std::pair<Parameter, std::string>>{
           {{"latency_ms", 900.0}, "latency_ms: got 900" + latency},
           {{"latency_ms", {}}, "latency_ms: got nothing" + latency},
           {{"latency_ms", std::vector<double>{1.0}}, "latency_ms: got a list" + latency},
           {{"tracking_mpc.horizon_steps", 7.5},
            "tracking_mpc.horizon_steps: got 7.5, expected an integer in [5, 100]"},
           {{"tracking_mpc.compensate_delay", 1.0},
            "tracking_mpc.compensate_delay: got 1, expected true or false"},
           {{"run.pace", 21.0}, "run.pace: got 21, expected a number in [0.05, 20]"},
           {{"manual.steer", std::numeric_limits<double>::quiet_NaN()}, "manual.steer: got nan" + share},
           {{"manual.steer", std::string("0.5")}, "manual.steer: got 0.5" + share},
           {{"manual.is_on", 1.0}, "manual.is_on: got 1, expected true or false"},
           {{"guard.mode", std::string("no")}, "guard.mode: got no, expected one of on, observe, off"},
           {{"track", std::string(300, 'x')}, "track: got 300 bytes, expected at most 256"}})
    EXPECT_EQ(live.refusal(parameter), sentence);
  EXPECT_THAT(live.refusal({"tracking_mpc.horizon_step", 20.0}),
              HasSubstr("did you mean tracking_mpc.horizon_steps?"));
  EXPECT_THAT(live.refusal({"manual.ste", 0.0}), HasSubstr("did you mean manual.steer?"));
  EXPECT_THAT(live.refusal({"cubic_mpc.latency_handling", std::string("magic")}),
              HasSubstr("expected one of"));
  EXPECT_EQ(live.value("latency_ms"), ParameterValue(100.0));
  Live other(scenario_of({{"preset", "delay-in-model"}}));
  EXPECT_THAT(other.refusal({"cubic_mpc.latency_ms", 50.0}), HasSubstr("expected cubic_mpc.step_length_s"))
      << "settings that exclude each other";
}

TEST(LiveSettings, SendWhatChangesAndEveryWordOfAPersonUntilTooMuchWaits) {
  Live live;
  ASSERT_TRUE(live.settings.set({"latency_ms", 100.0}));
  EXPECT_EQ(live.requests.front(), nullptr) << "it holds already";
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(live.settings.set({"manual.throttle", 0.5}));
    EXPECT_EQ(live.next().value.view(), "0.5");
  }
  for (std::uint64_t i = 0; i < run::SettingQueue::kCapacity; ++i)
    ASSERT_TRUE(live.settings.set({"manual.steer", 0.001 * static_cast<double>(i)}));
  EXPECT_EQ(test::refusal_of(live.settings.set({"latency_ms", 10.0})),
            "latency_ms: too many changes wait; try again");
  EXPECT_FALSE(live.settings.set({"track", std::string("oval")}));
  EXPECT_TRUE(live.started.empty());
}

TEST(LiveSettings, StartAnewWithAnotherTrackAndKeepWhatWasSet) {
  Live live;
  ASSERT_TRUE(live.settings.set({"tracking_mpc.grip_share", 0.5}));
  ASSERT_TRUE(live.settings.set({"run.pace", 2.0}));
  live.next();
  live.next();
  ASSERT_TRUE(live.settings.set({"track", std::string("oval")}));
  ASSERT_EQ(live.started.size(), 1U);
  EXPECT_EQ(live.started[0].scenario.track, "oval");
  EXPECT_EQ(std::get<controller::TrackingMpcOptions>(live.started[0].scenario.controllers).grip_share, 0.5);
  EXPECT_EQ(live.building, "track = oval");
  EXPECT_TRUE(live.settings.complaints().empty());
  EXPECT_EQ(live.requests.front(), nullptr);  // the run before goes on
  EXPECT_EQ(live.settings.scenario().track, "lakeside");
  EXPECT_TRUE(live.end_of_build().empty());
  EXPECT_EQ(live.building, "");
  EXPECT_EQ(live.settings.scenario().track, "oval");
  const telemetry::Change change = live.next();
  EXPECT_EQ(change.name.view(), "track");
  EXPECT_TRUE(change.starts_anew);
  EXPECT_EQ(live.next().name.view(), "run.pace");  // the new run hears of it again
  EXPECT_EQ(live.requests.front(), nullptr);
  EXPECT_THAT(live.refusal({"track", std::string("ovall")}), HasSubstr("did you mean oval?"));
  EXPECT_EQ(live.value("track"), ParameterValue(std::string("oval")));
}

TEST(LiveSettings, TakeAPresetsSettingsButKeepTheWorld) {
  Live live(scenario_of({{"latency_ms", "50"}, {"track", "oval"}, {"seed", "7"}}));
  ASSERT_TRUE(live.settings.set({"tracking_mpc.grip_share", 0.5}));
  EXPECT_EQ(live.settings.news().size(), 1U);
  ASSERT_TRUE(live.settings.set({"preset", std::string("sixty-mph")}));
  live.end_of_build();
  const scenario::Scenario& now = live.settings.scenario();
  EXPECT_EQ(now.controller, "cubic-mpc");
  EXPECT_EQ(std::get<controller::CubicMpcOptions>(now.controllers).horizon_steps, 7);
  EXPECT_EQ(std::get<controller::TrackingMpcOptions>(now.controllers).grip_share,
            controller::TrackingMpcOptions{}.grip_share);
  EXPECT_EQ(now.latency, 0.05);
  EXPECT_EQ(now.track, "oval");
  EXPECT_EQ(now.seed, 7U);
  std::vector<std::string> names;
  for (const Parameter& parameter : live.settings.news()) names.push_back(parameter.name);
  EXPECT_THAT(names, testing::IsSupersetOf({"preset", "controller", "cubic_mpc.horizon_steps",
                                            "tracking_mpc.grip_share", "control_period_ms"}));
  EXPECT_TRUE(live.settings.news().empty());
}

TEST(LiveSettings, RememberWithWhatARunStarted) {
  Live live(scenario_of({{"latency_ms", "50"}}));
  const auto start = [&](const std::string& key) {
    for (const auto& each : nlohmann::json::parse(live.settings.schema_json())) {
      if (each["key"] == key) return each["start"];
    }
    return nlohmann::json();
  };
  ASSERT_TRUE(live.settings.set({"latency_ms", 80.0}));
  live.next();
  EXPECT_EQ(start("latency_ms"), 50);
  ASSERT_TRUE(live.settings.set({"car", std::string("road-car")}));
  live.end_of_build();
  EXPECT_EQ(start("car"), "road-car");
  EXPECT_EQ(start("latency_ms"), 50) << "what was changed before stays a change";
  ASSERT_TRUE(live.settings.set({"preset", std::string("sixty-mph")}));
  live.end_of_build();
  EXPECT_EQ(start("cubic_mpc.horizon_steps"), 7);
  EXPECT_EQ(start("latency_ms"), 80) << "a preset leaves nothing of before";
}

TEST(LiveSettings, TakeACarsVehicleAndPlantAndTheDelayThatItStates) {
  Live live;
  ASSERT_TRUE(live.settings.set({"car", std::string("f1tenth")}));
  live.end_of_build();
  EXPECT_EQ(live.settings.scenario().plant_params.mass, 3.54);
  EXPECT_EQ(live.settings.scenario().latency, 0.02);
  ASSERT_TRUE(live.settings.set({"car", std::string("road-car")}));
  live.end_of_build();
  EXPECT_EQ(live.settings.scenario().plant, "road-car");
  EXPECT_EQ(live.settings.scenario().vehicle.name, "road-car");
  EXPECT_EQ(live.settings.scenario().latency, 0.1);
}

TEST(LiveSettings, ChangeNothingWhenTheRunCannotBeBuiltAndSaySo) {
  Live live;
  ASSERT_TRUE(live.settings.set({"seed", 2.0}));
  static_cast<void>(live.settings.news());
  EXPECT_EQ(live.value("seed"), ParameterValue(2.0));  // what was asked for, while it is being built
  const std::vector<std::string> said =
      live.end_of_build(fail(ErrorCode::kInvalidArgument, "no room in the garage"));
  EXPECT_EQ(said,
            std::vector<std::string>{"no run with seed = 2: no room in the garage; the one before goes on"});
  EXPECT_TRUE(live.settings.complaints().empty());
  EXPECT_EQ(live.building, "");
  EXPECT_EQ(live.settings.scenario().seed, 1U);
  ASSERT_EQ(live.settings.news().size(), 1U);  // viewers hear that it is not so
  EXPECT_EQ(live.value("seed"), ParameterValue(1.0));
  EXPECT_EQ(live.requests.front(), nullptr);
}

// A viewer read the first lines of any file of the machine in such a message.
TEST(LiveSettings, ChooseFromTheLibraryByNameAndOpenNoOtherFile) {
  const test::Folder folder;
  const std::string file = folder.write("secret.yaml", "the secret word\n");
  Live live;
  for (const char* key : {"preset", "car", "track"}) {
    for (const std::string& value :
         {file, std::string("/etc/hostname"), std::string("../presets/default.yaml"),
          std::string("default.yaml"), std::string("presets/default"), std::string("."), std::string(".."),
          std::string("/dev/zero"), std::string("default\0x", 9), std::string("\\\\host\\share"),
          std::string("file:///etc/passwd")}) {
      const std::string said = live.refusal({key, value});
      EXPECT_THAT(said, HasSubstr(std::string(key) + ": got \"")) << value;
      EXPECT_THAT(said, HasSubstr("expected one of ")) << value;
      EXPECT_THAT(said, Not(HasSubstr("secret word")));
    }
  }
  EXPECT_TRUE(live.started.empty());
  EXPECT_EQ(live.said, "");
}

TEST(LiveSettings, TakeBackTheFileThatTheRunWasStartedWith) {
  const test::Folder folder;
  const std::string file =
      folder.write("mine.csv", test::content_of(*protocol::locate(protocol::Shelf::kTrack, "oval")));
  Live live(scenario_of({{"track", file}}));
  ASSERT_TRUE(live.settings.set({"track", std::string("hairpins")}));
  live.end_of_build();
  ASSERT_TRUE(live.settings.set({"track", file}));
  EXPECT_EQ(live.started.back().scenario.track, file);
}

TEST(LiveSettings, TellWhatAFileHoldsToWhoStartedTheProgramOnly) {
  const test::Folder folder;
  const std::string file = folder.write("goes_bad.yaml", "preset: default\n");
  Live live(scenario_of({{"preset", file}}));
  std::ofstream(file) << "preset: default\nlaps: the secret word\n";
  EXPECT_EQ(live.refusal({"car", std::string("road-car")}),
            "car: road-car cannot be used here; the program's own output says why");
  EXPECT_THAT(live.said, HasSubstr(":2: laps: got the secret word"));

  Live other;
  ASSERT_TRUE(other.settings.set({"track", std::string("oval")}));
  EXPECT_EQ(other.end_of_build(fail(ErrorCode::kParse, "oval.csv:3: x_m: got the secret word")),
            std::vector<std::string>{"no run with track = oval: it cannot be built; the program's own output "
                                     "says why; the one before goes on"});
  EXPECT_THAT(other.said, HasSubstr("oval.csv:3: x_m: got the secret word"));
}

TEST(LiveSettings, TakeTheLastOfQuickChoicesWithThoseBefore) {
  Live live;
  ASSERT_TRUE(live.settings.set({"track", std::string("oval")}));
  ASSERT_TRUE(live.settings.set({"car", std::string("road-car")}));
  ASSERT_TRUE(live.settings.set({"track", std::string("hairpins")}));
  EXPECT_EQ(live.building, "car = road-car, track = hairpins");
  ASSERT_EQ(live.started.size(), 3U);
  const ChosenRun& last = live.started.back();
  EXPECT_EQ(last.scenario.track, "hairpins");
  EXPECT_EQ(last.scenario.car, "road-car");
  ASSERT_EQ(last.choices.size(), 2U);
  EXPECT_EQ(last.choices[1].value.view(), "hairpins");
  live.end_of_build();
  const telemetry::Change change = live.next();  // one run begins, not three
  EXPECT_EQ(change.name.view(), "track");
  EXPECT_EQ(change.value.view(), "hairpins");
  EXPECT_TRUE(change.starts_anew);
  EXPECT_EQ(live.requests.front(), nullptr);
  EXPECT_EQ(live.settings.scenario().car, "road-car");
}

TEST(LiveSettings, OfferTheControllerOnlyForAnExternalSimulatorAndShowWhatIsFixed) {
  run::SettingQueue requests;
  LiveSettings settings({.scenario = scenario_of({{"preset", "weighted"}}), .has_world = false}, requests);
  for (const Parameter& parameter : settings.list()) {
    const bool is_fixed = parameter.name.starts_with("vehicle.") || parameter.name.starts_with("guard.");
    EXPECT_TRUE(is_fixed || parameter.name.starts_with("cubic_mpc.")) << parameter.name;
  }
  const Result<void> guard = settings.set({"guard.mode", std::string("off")});
  ASSERT_FALSE(guard);
  EXPECT_EQ(guard.error().message,
            "guard.mode is fixed when the run starts; set it on the command line: --set guard.mode=off");
  EXPECT_TRUE(settings.get("cubic_mpc.weight_lateral"));
  EXPECT_TRUE(settings.set({"cubic_mpc.weight_lateral", 10.0}));
  EXPECT_EQ(test::refusal_of(settings.set({"latency_ms", 10.0})),
            "latency_ms: cannot be set while this run goes on");
}

TEST(LiveSettings, TellWhatTheRunHasTakenUpAndFaultsThatEndByThemselves) {
  run::SettingQueue requests;
  LiveSettings settings({.scenario = scenario_of({}),
                         .faults = {{"fault.link_lost", protocol::switch_of("Silence."), false,
                                     &sim::kind_of(*sim::fault_named("link_lost"))}}},
                        requests);
  ASSERT_TRUE(settings.set({"fault.link_lost", true}));
  EXPECT_EQ(settings.get("fault.link_lost")->value, ParameterValue(true));
  EXPECT_EQ(settings.news().size(), 1U);
  settings.tell({.cycle = 9, .time = 0.36, .name = "fault.link_lost", .value = "false"});
  const std::vector<telemetry::Change> changes = settings.applied();
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].cycle, 9U);
  ASSERT_EQ(settings.news().size(), 1U);
  EXPECT_EQ(settings.get("fault.link_lost")->value, ParameterValue(false));
  ASSERT_TRUE(settings.set({"fault.link_lost", std::string("+4")}));
  EXPECT_EQ(settings.get("fault.link_lost")->value, ParameterValue(true));
  EXPECT_THAT(test::refusal_of(settings.set({"fault.link_lost", std::string("+4*2")})),
              HasSubstr("fault.link_lost: got +4*2"));
}

TEST(LiveSettings, DescribeThemselvesInJson) {
  Live live(scenario_of({{"preset", "sixty-mph"}, {"cubic_mpc.horizon_steps", "9"}}));
  const auto schema = nlohmann::json::parse(live.settings.schema_json());
  ASSERT_EQ(schema.size(), live.settings.list().size());
  const auto entry = [&](const std::string& key) {
    for (const auto& each : schema) {
      if (each["key"] == key) return each;
    }
    return nlohmann::json();
  };
  const auto expect = [&](const std::string& key, const nlohmann::json& values) {
    for (const auto& [name, value] : values.items()) EXPECT_EQ(entry(key)[name], value) << key << ' ' << name;
  };
  // The default is the preset's value, neither the present one nor the command line's.
  expect("cubic_mpc.horizon_steps", {{"kind", "integer"},
                                     {"group", "cubic_mpc"},
                                     {"minimum", 2},
                                     {"maximum", 200},
                                     {"default", 7},
                                     {"start", 9},
                                     {"is_live", true},
                                     {"is_fixed", false}});
  for (const char* key : {"vehicle.friction", "guard.mode"}) expect(key, {{"is_fixed", true}});
  expect("latency_ms", {{"unit", "ms"}, {"group", "run"}});
  expect("track", {{"is_live", false}});
  EXPECT_THAT(entry("track")["choices"].dump(), HasSubstr("lakeside"));
  expect("cubic_mpc.latency_handling", {{"kind", "choice"}});
  expect("vehicle.drive_power_per_mass_wpkg", {{"default", "inf"}, {"may_be_infinite", true}});
  expect("manual.is_on", {{"kind", "bool"}});
  expect("manual.steer",
         {{"minimum", -1.0}, {"maximum", 1.0}, {"meaning", "Share of the steering lock, left positive."}});
  expect("run.pace", {{"maximum", 20}});
  for (const auto& each : schema) EXPECT_FALSE(each["meaning"].get<std::string>().empty()) << each["key"];
  EXPECT_EQ(schema[0]["key"], protocol::list().front().key) << "the controls stand behind";
}

TEST(LiveSettings, BecomeAPresetFileThatGivesThemBackForEveryRow) {
  const test::Folder folder;
  for (const protocol::Parameter& row : protocol::list()) {
    SCOPED_TRACE(row.key);
    // Only a double track has parameters of its own.
    const std::string car = row.key.starts_with("plant_params.") ? "bmw-320i" : "udacity";
    const scenario::Scenario plain = scenario_of({{"car", car}});
    const Live live(scenario_of({{"car", car}, {std::string(row.key), another_value(row, plain)}}));
    const std::string file = folder.write("preset.yaml", live.settings.preset_yaml());
    const Result<scenario::Scenario> again =
        test::good(protocol::compose({.scenario_file = file, .settings = {}}));
    for (const protocol::Parameter& each : protocol::list()) {
      EXPECT_EQ(protocol::get_text(*again, each), protocol::get_text(live.settings.scenario(), each))
          << each.key;
    }
  }
}

TEST(FixedSettings, KeepTheGuardAndItsModelOutOfReach) {
  const std::string fixed = " is fixed when the run starts; set it on the command line: --set ";
  EXPECT_EQ(Live().refusal({"guard.mode", std::string("off")}), "guard.mode" + fixed + "guard.mode=off");
  EXPECT_EQ(Live().refusal({"vehicle.friction", 2.5}), "vehicle.friction" + fixed + "vehicle.friction=2.5");
  const scenario::Scenario plain = scenario_of({});
  for (const protocol::Parameter& row : protocol::list()) {
    if (row.group != "guard" && row.group != "vehicle") continue;
    Live live;
    const ParameterValue before = live.value(row.key);
    EXPECT_THAT(live.refusal({std::string(row.key), another_value(row, plain)}), HasSubstr(fixed));
    EXPECT_EQ(live.value(row.key), before) << row.key;
    EXPECT_TRUE(live.started.empty()) << row.key;
    EXPECT_TRUE(live.settings.set({std::string(row.key), before})) << "the value that holds";
  }
  for (const char* world : {"plant_options.friction_scale", "plant_options.mass_scale"})
    EXPECT_TRUE(Live().settings.set({world, 0.8})) << "the simulated world is left to viewers";
}

TEST(FixedSettings, KeepTheGuardAndTheModelOfTheCommandLineWhateverPresetOrCarIsChosen) {
  const scenario::Scenario given =
      scenario_of({{"guard.mode", "observe"}, {"guard.margin_m", "0.7"}, {"vehicle.friction", "0.6"}});
  Live live(given);
  for (const auto& [key, value] : std::vector<std::pair<std::string, std::string>>{
           {"preset", "race"}, {"car", "road-car"}, {"preset", "weighted"}, {"car", "udacity"}}) {
    SCOPED_TRACE(key + " = " + value);
    ASSERT_TRUE(live.settings.set({key, value}));
    live.end_of_build();
    while (live.requests.front() != nullptr) live.next();
    EXPECT_EQ(live.settings.scenario().guard, given.guard);
    EXPECT_EQ(live.settings.scenario().vehicle.friction,
              live.settings.scenario().car == "udacity"
                  ? 0.6
                  : scenario_of({{"car", "road-car"}}).vehicle.friction);
  }
}

}  // namespace
}  // namespace chicane::live
