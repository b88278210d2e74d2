// SPDX-License-Identifier: MIT
#include "chicane/protocol/schema.hpp"

#include "chicane/base/random.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "support/chicane_test.hpp"
#include "support/comma_locale.hpp"

namespace chicane::protocol {
namespace {

using scenario::Scenario;

std::string error_of(std::string_view key, std::string_view text) {
  Scenario scenario;
  return test::refusal_of(set_text(scenario, key, text));
}

/// Converts to anything, to count the fields of an aggregate.
struct Any {
  template <class T>
  operator T() const;  // NOLINT: implicit on purpose
};
template <class Aggregate, class... Fields>
consteval long field_count() {
  if constexpr (requires { Aggregate{Fields{}..., Any{}}; }) return field_count<Aggregate, Fields..., Any>();
  return sizeof...(Fields);
}
long row_count(std::string_view group) {
  return std::count_if(list().begin(), list().end(), [&](const Parameter& p) { return p.group == group; });
}

TEST(Schema, EveryFieldOfEveryOptionsStructHasARow) {
  // A nested struct's fields stand in the place of itself.
  constexpr long kSpeedHold = field_count<controller::SpeedHoldOptions>() - 1;
  controller::Registry::for_each([]<class Entry>() {
    using Options = typename Entry::Options;
    const long nested = requires(Options options) { options.speed.speed_gain; }
    ? kSpeedHold : 0;
    EXPECT_EQ(row_count(controller::kOptionGroup<Entry>), field_count<Options>() + nested) << Entry::kName;
  });
  // Base classes count as one field of an aggregate. VehicleParams is none: a name, all else numbers.
  constexpr long kBody = field_count<model::CarBody>() - 1;
  constexpr std::size_t kNumbers = (sizeof(model::VehicleParams) - sizeof(std::string)) / sizeof(double);
  EXPECT_EQ(row_count("vehicle"), static_cast<long>(1 + kNumbers));
  EXPECT_EQ(row_count("plant_params"), field_count<sim::DoubleTrackParams>() + kBody);
  EXPECT_EQ(row_count("plant_options"), field_count<sim::PlantDeviation>());
  EXPECT_EQ(row_count("sensor"), field_count<sim::SensorOptions>());
}

TEST(Schema, KeysAreUniqueAndEndWithTheirUnit) {
  std::set<std::string_view> keys;
  for (const Parameter& parameter : list()) {
    EXPECT_TRUE(keys.insert(parameter.key).second) << parameter.key;
    EXPECT_TRUE(parameter.key.ends_with(parameter.option.unit.suffix)) << parameter.key;
    EXPECT_TRUE(parameter.option.meaning.ends_with(".")) << parameter.key;
    EXPECT_EQ(find(parameter.key), &parameter);
  }
}

TEST(Schema, EveryControllerOfTheRegistryCanBeChosenAndSet) {
  const Parameter& controller = *find("controller");
  for (const controller::Registry::Kind& kind : controller::Registry::kinds()) {
    Scenario scenario;
    EXPECT_TRUE(set(scenario, controller, std::string(kind.name))) << kind.name;
    const auto first = std::find_if(list().begin(), list().end(),
                                    [&](const Parameter& p) { return p.controller == kind.name; });
    ASSERT_NE(first, list().end()) << kind.name;
    EXPECT_EQ(first->group, kind.group);
    EXPECT_TRUE(first->key.starts_with(std::string(kind.group) + "." + std::string(first->option.name)));
    EXPECT_EQ(find_option(kind.name, first->option.name), &*first);
  }
}

TEST(Schema, EveryDefaultIsInItsOwnRange) {
  const Scenario defaults;
  for (const Parameter& parameter : list()) {
    Scenario scenario;
    const Result<void> result = set(scenario, parameter, get(defaults, parameter));
    EXPECT_TRUE(result.has_value()) << result.error().message;
  }
}

TEST(Schema, ConvertsUnitsAtTheEdge) {
  Scenario scenario;
  ASSERT_TRUE(set_text(scenario, "latency_ms", "40"));
  ASSERT_TRUE(set_text(scenario, "vehicle.steer_limit_deg", "25"));
  ASSERT_TRUE(set_text(scenario, "cubic_mpc.latency_handling", "measured"));
  EXPECT_EQ(scenario.latency, 0.04);
  EXPECT_EQ(scenario.vehicle.steer_limit, 0.4363323129985824);
  EXPECT_EQ(std::get<controller::CubicMpcOptions>(scenario.controllers).latency_handling,
            controller::LatencyHandling::kMeasured);
  EXPECT_EQ(get_text(scenario, *find("latency_ms")), "40");
  EXPECT_EQ(get_text(scenario, *find("vehicle.steer_limit_deg")), "25");
  EXPECT_EQ(get_text(scenario, *find("cubic_mpc.latency_handling")), "measured");
  EXPECT_EQ(get_text(scenario, *find("vehicle.steer_rate_limit_degps")), "inf");
}

// Some value in range for every kind of parameter.
Value any_value(const Parameter& parameter, Random& random) {
  switch (parameter.option.kind) {
    case Kind::kNumber:
      return random.uniform(parameter.option.minimum, parameter.option.maximum);
    case Kind::kInteger:
      return std::floor(random.uniform(parameter.option.minimum, parameter.option.maximum));
    case Kind::kBool:
      return random.uniform() < 0.5;
    case Kind::kChoice:
      return std::string(parameter.option.choices[static_cast<std::size_t>(
          random.uniform() * static_cast<double>(parameter.option.choices.size()))]);
    case Kind::kText:
      break;
  }
  return "text " + std::to_string(random.bits());
}

TEST(Schema, ADocumentIsReadBackAsItWasWritten) {
  Random random(3);
  for (int round = 0; round < 50; ++round) {
    Scenario scenario;
    for (const Parameter& parameter : list()) {
      if (random.uniform() < 0.5 || parameter.key == "preset" || parameter.key == "controller") continue;
      if (parameter.group == "plant_params" && scenario.plant != "double-track") continue;
      Value value = any_value(parameter, random);
      if (parameter.option.kind == Kind::kText) value = std::string("a \"b\\ #: ö\n\tc");
      if (parameter.option.kind == Kind::kChoice) value = std::string(parameter.option.choices.back());
      ASSERT_TRUE(set(scenario, parameter, value));
    }
    const std::string text = write_document(scenario, "written by a test,\nin two lines");
    const auto document = test::good(parse_document(text, "f"));
    Scenario read_back;
    ASSERT_EQ(test::refusal_of(apply_layers({&*document, 1}, read_back)), "") << text;
    for (const Parameter& parameter : list())
      EXPECT_EQ(get_text(scenario, parameter), get_text(read_back, parameter)) << parameter.key;
  }
}

TEST(Schema, SettingOneParameterChangesNoOther) {
  Random random(5);
  const Scenario defaults;
  for (const Parameter& changed : list()) {
    Scenario scenario;
    ASSERT_TRUE(set(scenario, changed, any_value(changed, random)));
    for (const Parameter& other : list()) {
      if (&other == &changed) continue;
      EXPECT_EQ(get(scenario, other), get(defaults, other)) << changed.key << " " << other.key;
    }
  }
}

TEST(Schema, RefusesWhatIsOutOfRangeOrOfAnotherTypeWithRangeAndUnit) {
  for (const char* text : {"900", "nan", "inf", "fast", "1,5", "", "100ms"}) {
    const std::string got = *text == '\0' ? "nothing" : text;
    EXPECT_EQ(error_of("latency_ms", text), "latency_ms: got " + got + ", expected a number in [0, 500] ms");
  }
  EXPECT_EQ(error_of("cubic_mpc.horizon_steps", "1"),
            "cubic_mpc.horizon_steps: got 1, expected an integer in [2, 200]");
  EXPECT_EQ(error_of("laps", "2.5"), "laps: got 2.5, expected an integer in [0, 10000]");
  EXPECT_EQ(error_of("vehicle.steer_rate_limit_degps", "-inf"),
            "vehicle.steer_rate_limit_degps: got -inf, expected a number in [1, 10000] deg/s or inf");
  EXPECT_EQ(error_of("cubic_mpc.polar_waypoints", "1"),
            "cubic_mpc.polar_waypoints: got 1, expected true or false");
  EXPECT_EQ(error_of("plant", "rocket"),
            "plant: got rocket, expected one of udacity, road-car, double-track");
  EXPECT_EQ(error_of("track", ""), "track: got nothing, expected text");
}
TEST(Schema, AWrongTypeOfValueIsAnErrorForEveryParameter) {
  for (const Parameter& parameter : list()) {
    Scenario scenario;
    const bool is_number = parameter.option.kind == Kind::kNumber || parameter.option.kind == Kind::kInteger;
    const auto is_taken = [&](const Value& value) { return set(scenario, parameter, value).has_value(); };
    EXPECT_EQ(is_taken(true), parameter.option.kind == Kind::kBool) << parameter.key;
    EXPECT_TRUE(is_number || !is_taken(1.0)) << parameter.key;
    EXPECT_TRUE(parameter.option.kind == Kind::kText || !is_taken(std::string("?"))) << parameter.key;
  }
}

TEST(Schema, OnlyWhatMakesTheRunAnotherOneIsNotLive) {
  std::vector<std::string_view> not_live;
  for (const Parameter& parameter : list()) {
    if (parameter.group == "plant_params") {
      EXPECT_FALSE(is_live(parameter)) << parameter.key;
    } else if (!is_live(parameter)) {
      not_live.push_back(parameter.key);
    }
  }
  EXPECT_EQ(not_live, (std::vector<std::string_view>{
                          "preset", "track", "track_scale", "car", "plant", "controller", "seed",
                          "friction_low", "control_period_ms", "waypoints_sent", "vehicle.name",
                          "vehicle.scale", "guard.mode", "guard.road", "guard.half_width_m", "guard.receiver",
                          "guard.margin_m", "guard.blind_time_s"}));
}

TEST(Schema, SuggestsWhatWasMeantAndCutsALongOrBinaryText) {
  EXPECT_THAT(error_of("latency", "1"), HasSubstr("did you mean latency_ms?"));
  EXPECT_THAT(error_of("cubic_mpc.horizon_step", "1"), HasSubstr("did you mean cubic_mpc.horizon_steps?"));
  EXPECT_THAT(error_of("steer_limit_deg", "1"), HasSubstr("did you mean vehicle.steer_limit_deg?"));
  EXPECT_THAT(error_of("xyzzy", "1"), Not(HasSubstr("did you mean")));
  EXPECT_LT(error_of(std::string(100000, 'k'), "1").size(), 300u);
  EXPECT_LT(error_of("latency_ms", std::string(100000, '7')).size(), 300u);
  EXPECT_THAT(error_of("latency_ms", "a\nb\x1b[31m"), HasSubstr("a?b?[31m"));
}

TEST(Schema, ReadsAndWritesPointsInALocaleOfCommas) {
  const test::CommaLocale comma;
  if (!comma.is_set()) GTEST_SKIP() << "the Debian package locales is not installed";
  Scenario scenario;
  EXPECT_TRUE(set_text(scenario, "cubic_mpc.step_length_s", "0.025"));
  EXPECT_EQ(std::get<controller::CubicMpcOptions>(scenario.controllers).step_length, 0.025);
  EXPECT_EQ(get_text(scenario, *find("cubic_mpc.step_length_s")), "0.025");
}

TEST(Schema, DelayInsideTheModelMustBeOneStep) {
  Scenario scenario;
  scenario.controller = "cubic-mpc";
  std::get<controller::CubicMpcOptions>(scenario.controllers).latency_handling =
      controller::LatencyHandling::kInsideModel;
  EXPECT_TRUE(contradictions(scenario).empty());
  std::get<controller::CubicMpcOptions>(scenario.controllers).step_length = 0.05;
  ASSERT_EQ(contradictions(scenario).size(), 1u);
  EXPECT_EQ(contradictions(scenario)[0].key, "cubic_mpc.latency_ms");
  scenario.controller = "pid";  // then it has no effect
  EXPECT_TRUE(contradictions(scenario).empty());
}

}  // namespace
}  // namespace chicane::protocol
