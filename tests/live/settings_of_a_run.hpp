// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/live/live_settings.hpp"
#include "support/chicane_test.hpp"
#include "support/runs.hpp"

namespace chicane::test {

using live::ChosenRun;
using live::LiveSettings;
using protocol::foxglove::Parameter;
using protocol::foxglove::ParameterValue;

using test::scenario_of;

/// Another value than the one that holds, which may stand beside the others.
inline std::string another_value(const protocol::Parameter& row, const scenario::Scenario& scenario) {
  if (row.key == "preset") return "sixty-mph";
  if (row.key == "track") return "oval";
  if (row.key == "car") return "road-car";
  const protocol::Value now = protocol::get(scenario, row);
  if (const auto* flag = std::get_if<bool>(&now)) return *flag ? "false" : "true";
  if (row.option.kind == protocol::Kind::kText) return "something else";
  if (row.option.kind == protocol::Kind::kChoice)
    return std::string(row.option.choices[std::get<std::string>(now) == row.option.choices[1] ? 0 : 1]);
  if (row.option.kind == protocol::Kind::kInteger)
    return std::get<double>(now) == row.option.minimum + 1.0
               ? std::to_string(static_cast<int>(row.option.minimum) + 2)
               : std::to_string(static_cast<int>(row.option.minimum) + 1);
  scenario::Scenario other = scenario;
  double value = row.option.minimum + (row.option.maximum - row.option.minimum) / 7.0;
  // A double track's parameters make the model's: a car that is about as it was has one within its ranges.
  const double current = std::get<double>(now);
  if (row.key.starts_with("plant_params.") && std::isfinite(current) && current != 0.0)
    value = 0.97 * current;
  EXPECT_TRUE(protocol::set(other, row, value)) << row.key;
  return protocol::get_text(other, row);
}

/// Settings of a default run beside which another one is built whenever that is asked for.
struct Live {
  explicit Live(const scenario::Scenario& scenario = scenario_of({}))
      : settings{{.scenario = scenario,
                  .build = [this](const ChosenRun& next) { started.push_back(next); },
                  .built = [this] { return std::exchange(outcome, std::nullopt); },
                  .on_building = [this](const std::string& what) { building = what; },
                  .say = [this](std::string_view line) { said += line; },
                  .on_accepted = [this](const scenario::Scenario& now) { accepted = now; }},
                 requests} {}

  /// The build has ended, and the network thread looks.
  std::vector<std::string> end_of_build(Result<void> with = {}) {
    outcome = std::move(with);
    settings.update();
    return settings.complaints();
  }

  std::string refusal(const Parameter& parameter) {
    const Result<void> done = settings.set(parameter);
    EXPECT_FALSE(done) << parameter.name;
    EXPECT_EQ(requests.front(), nullptr) << parameter.name;
    return done ? "" : done.error().message;
  }
  telemetry::Change next() {
    const run::Setting* front = requests.front();
    if (front == nullptr) {
      ADD_FAILURE() << "no change waits";
      return {};
    }
    const telemetry::Change change = front->change;
    requests.pop();
    return change;
  }
  ParameterValue value(std::string_view name) {
    const auto parameter = settings.get(name);
    return parameter ? parameter->value : ParameterValue{};
  }

  run::SettingQueue requests;
  std::vector<ChosenRun> started;
  std::optional<Result<void>> outcome;
  std::string building;
  std::string said;  ///< to whoever started the program
  scenario::Scenario accepted;
  LiveSettings settings;
};

}  // namespace chicane::test
