// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "chicane/protocol/json.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/lane_change.hpp"
#include "commands.hpp"

namespace chicane::apps {
namespace {

struct CarAndDriver {
  std::string car, preset;
  run::LaneChangeLimit limit;
};

constexpr double kKmph = 3.6;

void print_row(const CarAndDriver& row) {
  const run::LaneChangeOutcome& next = row.limit.failed;
  const std::string why = next.has_passed() ? "passed every speed tried"
                          : next.room < 0.0 ? fmt::format("a cone is hit by {:.2f} m", -next.room)
                                            : "does not arrive";
  fmt::print("{:<16} {:<14} {:>7} {:>11.1f} {:>9.2f}   {}\n", row.car, row.preset, row.limit.passed_kmph,
             kKmph * row.limit.passed.exit_speed, row.limit.passed_kmph > 0 ? row.limit.passed.room : 0.0,
             why);
}

protocol::Json json_of(const CarAndDriver& row) {
  return {{"car", row.car},
          {"preset", row.preset},
          {"entry_kmph", row.limit.passed_kmph},
          {"exit_kmph", kKmph * row.limit.passed.exit_speed},
          {"room_m", row.limit.passed_kmph > 0 ? protocol::Json(row.limit.passed.room) : protocol::Json()},
          {"room_above_m", row.limit.failed.room}};
}

}  // namespace

ExitCode lane_change(const Options& options) {
  protocol::Json rows = protocol::Json::array();
  if (!options.is_json)
    fmt::print("{:<16} {:<14} {:>7} {:>11} {:>9}   {}\n", "car", "preset", "[km/h]", "exit [km/h]",
               "room [m]", "1 km/h faster");
  for (const std::string& car : options.lane_change.cars) {
    std::optional<run::LaneChange> change;
    for (const std::string& preset : options.lane_change.presets) {
      auto settings = options.settings;
      settings.emplace_back("preset", preset);
      settings.emplace_back("car", car);
      const Result<scenario::Scenario> scenario = protocol::compose({"", settings});
      if (!scenario) return report(scenario.error());
      if (!change) {
        Result<run::LaneChange> created = run::LaneChange::create(scenario->vehicle);
        if (!created) return report(created.error());
        change.emplace(std::move(*created));
      }
      Result<run::LaneChangeLimit> limit = change->find_limit(*scenario);
      if (!limit) return report(limit.error());
      const CarAndDriver row{car, preset, *limit};
      if (options.is_json)
        rows.push_back(json_of(row));
      else
        print_row(row);
    }
  }
  if (options.is_json)
    fmt::print("{}\n", protocol::json_text(protocol::Json{{"rows", std::move(rows)}},
                                           protocol::JsonLayout::kIndented));
  return kSuccess;
}

}  // namespace chicane::apps
