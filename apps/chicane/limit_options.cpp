// SPDX-License-Identifier: MIT
#include "limit_options.hpp"

#include "setting_options.hpp"

namespace chicane::apps {

void add_limit(CLI::App& command, Options& options) {
  add_setting(command, options, "--track", "track", "NAME|FILE", "Track (chicane list tracks)");
  add_setting(command, options, "--car", "car", "NAME|FILE", "Car (chicane list cars)");
  command.add_option("--csv", options.csv_file, "Keep the racing line in this file, a track to drive on")
      ->type_name("FILE");
  command.add_flag("--quick", options.is_quick,
                   "Find the bound alone, without a lap that was driven; goes with the next version");
  command.add_option("--spacing-m", options.spacing, "Nothing any more; goes with the next version")
      ->type_name("X")
      ->check(CLI::Range(0.5, 5.0));
  command
      .add_option("--budget-s", options.limit_budget,
                  "Work of the search, in seconds of a reference core; the best lap so far is shown then")
      ->type_name("X")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_flag("--json", options.is_json, "Print one JSON object on stdout, all else on stderr");
  add_set(command, options);
  command.footer("Example: chicane limit --track lakeside --car road-car --csv line.csv");
}

}  // namespace chicane::apps
