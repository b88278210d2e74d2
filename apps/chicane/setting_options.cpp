// SPDX-License-Identifier: MIT
#include "setting_options.hpp"

#include <fmt/format.h>

#include <vector>

#include "chicane/base/angle.hpp"
#include "chicane/base/text.hpp"

namespace chicane::apps {
namespace {

void add_speed(CLI::App& command, Options& options) {
  add(command, "--speed-mps", options.speed_mps, "X", "Speed reference of the controller [m/s]");
  command
      .add_option_function<double>(
          "--speed-mph", [&options](double mph) { options.speed_mps = fmt::format("{}", mph_to_mps(mph)); },
          "Speed reference of the controller [mph]")
      ->type_name("X")
      ->excludes("--speed-mps");
}

}  // namespace

void add_setting(CLI::App& command, Options& options, const std::string& name, const std::string& key,
                 const std::string& type, const std::string& help) {
  command
      .add_option_function<std::string>(
          name, [&options, key](const std::string& text) { options.settings.emplace_back(key, text); }, help)
      ->type_name(type);
}

void add_negation(CLI::App& command, const std::string& name, bool& value, const std::string& help) {
  command.add_flag_callback(
      name, [&value] { value = false; }, help);
}

void add_set(CLI::App& command, Options& options) {
  const auto take = [&options](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      const std::size_t equals = text.find('=');
      if (equals == std::string::npos || equals == 0) {
        throw CLI::ValidationError("--set",
                                   fmt::format("got {}, expected key=value without blanks", printable(text)));
      }
      options.settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
  };
  command
      .add_option_function<std::vector<std::string>>("--set", take,
                                                     "Setting of `chicane list parameters`; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_json(CLI::App& command, Options& options) {
  command.add_flag("--json", options.is_json, "Print one JSON object on stdout, all else on stderr");
}

void add_controller(CLI::App& command, Options& options) {
  add_setting(command, options, "--preset", "preset", "NAME",
              "Controller and its settings (chicane list presets)");
  add_setting(command, options, "--controller", "controller", "NAME",
              "Controller in place of the preset's (chicane list controllers)");
  add_setting(command, options, "--car", "car", "NAME|FILE",
              "Car of the simulation and of the controller's model (chicane list cars)");
  add_speed(command, options);
}

void add_world(CLI::App& command, Options& options) {
  add_setting(command, options, "--track", "track", "NAME|FILE", "Track (chicane list tracks)");
  add_setting(command, options, "--laps", "laps", "N", "Laps to drive; 0 drives until stopped");
  add_setting(command, options, "--seed", "seed", "N", "Seed of everything random");
}

}  // namespace chicane::apps
