// SPDX-License-Identifier: MIT
#include "campaign_options.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/run/fault_campaign.hpp"
#include "setting_options.hpp"
#include "sweep_options.hpp"

namespace chicane::apps {
namespace {

/// "2", or "inf" for a fault that lasts.
double fault_duration(const std::string& text) {
  if (text == "inf") return run::kLasting;
  if (const auto seconds = number_in("--for-s", text, 0.001, run::kLasting)) return *seconds;
  throw CLI::ValidationError(
      "--for-s", fmt::format("got {}, expected a number in [0.001, 1000000] or inf", printable(text)));
}

void add_names(CLI::App& command, const char* option, std::vector<std::string>& names, const char* help) {
  command.add_option(option, names, help)->type_name("NAME,...")->delimiter(',')->capture_default_str();
}

/// On which tracks, in which cars, with which controller and settings many runs are driven.
template <class Runs>
void add_where(CLI::App& command, Runs& runs, Options& options) {
  add_names(command, "--tracks", runs.tracks, "Names or files, with commas");
  add_names(command, "--cars", runs.cars, "Names or files, with commas");
  add_jobs(command, options.jobs);
  command.add_flag("--json", options.is_json, "Print one JSON object on stdout, all else on stderr");
  add_set(command, options);
}

}  // namespace

void add_campaign(CLI::App& command, Options& options) {
  Options::Campaign& campaign = options.campaign;
  command
      .add_option("--faults", campaign.faults, "Faults, with commas (chicane list faults); all when left out")
      ->type_name("NAME,...")
      ->delimiter(',');
  command.add_flag("--pairs", campaign.has_pairs,
                   "Add each two of them at once; without --faults: of those of measurement, link, computer");
  command
      .add_option_function<std::vector<std::string>>(
          "--for-s",
          [&campaign](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) campaign.durations.push_back(fault_duration(text));
          },
          "Durations of the faults [s], with commas; inf: to the end; each fault's own when left out")
      ->type_name("S,...")
      ->delimiter(',');
  command.add_option("--every-s", campaign.step, "Time between the moments of the flying lap [s]")
      ->type_name("S")
      ->check(CLI::Range(0.02, 1000.0))
      ->capture_default_str();
  command
      .add_option(
          "--onsets", campaign.onsets,
          "Number of moments by chance in the place of --every-s, for each fault, duration, track, car "
          "and preset")
      ->type_name("N")
      ->check(CLI::Range(1, 10000));
  command.add_option("--seed", campaign.seed, "Seed of these moments")->type_name("N")->capture_default_str();
  add_results(command, campaign.results, "fault, duration, track, car and preset");
  command.add_flag("--markdown", options.is_markdown, "Print the table of docs/safety.md on stdout");
  add_names(command, "--preset", campaign.presets,
            "Controllers and their settings; as --tracks and --cars: all stands for those that ship");
  add_where(command, campaign, options);
  command.footer(
      "Example: chicane campaign --pairs --onsets 3 --for-s 1,2,inf --preset default,race --tracks all "
      "--results campaign.jsonl");
}

void add_recover(CLI::App& command, Options& options) {
  Options::Recover& recover = options.recover;
  command
      .add_option("--starts", recover.starts,
                  "Starts for each car and track: standing, rolling, sliding, backwards, spun")
      ->type_name("N")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command.add_option("--seed", recover.seed, "Seed of the starts")->type_name("N")->capture_default_str();
  command.add_option("--only", recover.only, "Number of the only start to drive")
      ->type_name("I")
      ->check(CLI::Range(1, 100000));
  add_results(command, recover.results, "start");
  add_setting(command, options, "--preset", "preset", "NAME",
              "Controller and its settings (chicane list presets)");
  add_where(command, recover, options);
  command.footer("Example: chicane recover --tracks lakeside,oval --starts 120");
}

void add_lane_change(CLI::App& command, Options& options) {
  Options::LaneChange& change = options.lane_change;
  add_names(command, "--cars", change.cars, "Names or files, with commas");
  add_names(command, "--presets", change.presets, "Presets that steer: names or files, with commas");
  add_results(command, change.results, "car and preset");
  add_jobs(command, options.jobs);
  command.add_flag("--json", options.is_json, "Print one JSON object on stdout, all else on stderr");
  add_set(command, options);
  command.footer("Example: chicane lane-change --cars road-car --presets default,stanley");
}

}  // namespace chicane::apps
