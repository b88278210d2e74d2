// SPDX-License-Identifier: MIT
#include "chicane/protocol/schema.hpp"

#include <clocale>

#include "chicane/base/random.hpp"
#include "support/chicane_test.hpp"

namespace chicane::protocol {
namespace {

using scenario::Scenario;

std::string error_of(std::string_view key, std::string_view text) {
  Scenario scenario;
  const Result<void> result = set_text(scenario, key, text);
  return result ? "" : result.error().message;
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

TEST(Schema, EveryValueSurvivesTheRoundTripThroughText) {
  Random random(11);
  for (const Parameter& parameter : list()) {
    for (int i = 0; i < 200; ++i) {
      Scenario first;
      ASSERT_TRUE(set(first, parameter, any_value(parameter, random)));
      Scenario second;
      const std::string text = get_text(first, parameter);
      ASSERT_TRUE(set_text(second, parameter.key, text)) << parameter.key << " " << text;
      const Value a = get(first, parameter);
      const Value b = get(second, parameter);
      if (const auto* number = std::get_if<double>(&a)) {
        // One rounding on the way out and one on the way in.
        const double tolerance = 2.0 * std::numeric_limits<double>::epsilon() * std::fabs(*number);
        EXPECT_NEAR(*number, std::get<double>(b), tolerance) << parameter.key;
      } else {
        EXPECT_EQ(a, b) << parameter.key;
      }
    }
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

TEST(Schema, RefusesWhatIsOutOfRangeWithRangeAndUnit) {
  EXPECT_EQ(error_of("latency_ms", "900"), "latency_ms: got 900, expected a number in [0, 500] ms");
  EXPECT_EQ(error_of("cubic_mpc.horizon_steps", "1"),
            "cubic_mpc.horizon_steps: got 1, expected an integer in [2, 200]");
  EXPECT_EQ(error_of("laps", "2.5"), "laps: got 2.5, expected an integer in [0, 10000]");
  EXPECT_EQ(error_of("vehicle.steer_rate_limit_degps", "-inf"),
            "vehicle.steer_rate_limit_degps: got -inf, expected a number in [1, 10000] deg/s or inf");
  EXPECT_EQ(error_of("latency_ms", "nan"), "latency_ms: got nan, expected a number in [0, 500] ms");
  EXPECT_EQ(error_of("latency_ms", "inf"), "latency_ms: got inf, expected a number in [0, 500] ms");
}

TEST(Schema, RefusesTheWrongType) {
  EXPECT_EQ(error_of("latency_ms", "fast"), "latency_ms: got fast, expected a number in [0, 500] ms");
  EXPECT_EQ(error_of("latency_ms", "1,5"), "latency_ms: got 1,5, expected a number in [0, 500] ms");
  EXPECT_EQ(error_of("latency_ms", ""), "latency_ms: got nothing, expected a number in [0, 500] ms");
  EXPECT_EQ(error_of("latency_ms", "100ms"), "latency_ms: got 100ms, expected a number in [0, 500] ms");
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
    if (parameter.option.kind != Kind::kBool) {
      EXPECT_FALSE(set(scenario, parameter, true)) << parameter.key;
    }
    if (!is_number) {
      EXPECT_FALSE(set(scenario, parameter, 1.0)) << parameter.key;
    }
    if (parameter.option.kind != Kind::kText) {
      EXPECT_FALSE(set(scenario, parameter, std::string("?"))) << parameter.key;
    }
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

TEST(Schema, SuggestsWhatWasMeant) {
  EXPECT_THAT(error_of("latency", "1"), HasSubstr("did you mean latency_ms?"));
  EXPECT_THAT(error_of("cubic_mpc.horizon_step", "1"), HasSubstr("did you mean cubic_mpc.horizon_steps?"));
  EXPECT_THAT(error_of("steer_limit_deg", "1"), HasSubstr("did you mean vehicle.steer_limit_deg?"));
  EXPECT_THAT(error_of("xyzzy", "1"), Not(HasSubstr("did you mean")));
}

TEST(Schema, ALongOrBinaryKeyOrValueIsCutInTheMessage) {
  EXPECT_LT(error_of(std::string(100000, 'k'), "1").size(), 300u);
  EXPECT_LT(error_of("latency_ms", std::string(100000, '7')).size(), 300u);
  EXPECT_THAT(error_of("latency_ms", "a\nb\x1b[31m"), HasSubstr("a?b?[31m"));
}

TEST(Schema, ReadsAndWritesPointsInEveryLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C"}) {
    if (std::setlocale(LC_ALL, name) == nullptr) continue;
    Scenario scenario;
    EXPECT_TRUE(set_text(scenario, "cubic_mpc.step_length_s", "0.025"));
    EXPECT_EQ(std::get<controller::CubicMpcOptions>(scenario.controllers).step_length, 0.025);
    EXPECT_EQ(get_text(scenario, *find("cubic_mpc.step_length_s")), "0.025");
  }
  std::setlocale(LC_ALL, before.c_str());
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
