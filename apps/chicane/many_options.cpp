// SPDX-License-Identifier: MIT
// Options of the commands that drive many runs.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "chicane/base/text.hpp"
#include "chicane/run/fault_campaign.hpp"
#include "chicane/run/shard.hpp"
#include "command_options.hpp"
#include "setting_options.hpp"

namespace chicane::apps {
namespace {

void add_jobs(CLI::App& command, int& jobs) {
  add_shown(command, "--jobs", jobs, "N", "Threads; 0: as many as cores")->check(CLI::Range(0, 1024));
}

void add_results(CLI::App& command, Options& options, std::string_view each) {
  add(command, "--results", options.results_file, "FILE.jsonl",
      fmt::format("File with a line for each {}; one that is there is completed", each));
}

void add_names(CLI::App& command, const char* option, std::vector<std::string>& names, const char* help) {
  add_shown(command, option, names, "NAME,...", help)->delimiter(',');
}

/// "2", or "inf" for a fault that lasts.
double fault_duration(const std::string& text) {
  if (text == "inf") return run::kLasting;
  if (const auto seconds = number_in("--for-s", text, 0.001, run::kLasting)) return *seconds;
  throw CLI::ValidationError(
      "--for-s", fmt::format("got {}, expected a number in [0.001, 1000000] or inf", printable(text)));
}

/// On which tracks, in which cars, with which controller and settings many runs are driven.
template <class Runs>
void add_where(CLI::App& command, Runs& runs, Options& options) {
  add_names(command, "--tracks", runs.tracks, "Names or files, with commas");
  add_names(command, "--cars", runs.cars, "Names or files, with commas");
  add_jobs(command, options.jobs);
  add_json(command, options);
  add_set(command, options);
}

}  // namespace

void add_sweep(CLI::App& command, Options& options) {
  Options::Sweep& sweep = options.sweep;
  add(command, "plan", sweep.plan_file, "PLAN.yaml", "Plan of what to drive (docs/sweep.md)")->required();
  add(command, "-o,--output", options.output_file, "FILE.jsonl",
      "Results, a line for each run; a file that is there is completed. PLAN.jsonl when left out");
  add_jobs(command, options.jobs);
  add(command, "--shard", sweep.shard, "I/N",
      "Drive part I of N, into FILE.I-of-N.jsonl; in a Slurm array or under MPI it is known without it")
      ->check([](const std::string& text) {
        const auto shard = run::parse_shard(text);
        return shard ? std::string() : shard.error().message;
      });
  add(command, "--show", sweep.shown, "RUN",
      "Drive nothing: print the command that drives this run, counted from 0")
      ->check(CLI::Range(0.0, 1e9));
  command.footer("Example: chicane sweep studies/plans/speed-and-latency.yaml --jobs 4");
}

void add_league(CLI::App& command, Options& options) {
  Options::League& league = options.league;
  add(command, "league", league.file, "LEAGUE.yaml", "League of who drives where (docs/league.md)")
      ->required();
  add(command, "-o,--output", options.output_file, "FILE.html", "Page to write; an older one is replaced");
  add(command, "--results", options.results_file, "FILE.jsonl",
      "File with a line for each run; one that is there is completed. LEAGUE.jsonl when left out");
  add(command, "--csv", options.csv_file, "FILE.csv", "Write a table with a row for each run, too");
  command.add_flag("--json", options.is_json, "Print a JSON list on stdout, too");
  add(command, "--server", league.servers, "CMD",
      "Command that starts a program of your own, which joins; may be repeated. {port}, "
      "{latency_ms}, {track} and {chicane} in it are filled in; without {port} it listens on 4567")
      ->allow_extra_args(false);
  add_shown(command, "--patience-s", league.patience, "S",
            "Patience with a program that does not connect or answer [s]")
      ->check(CLI::Range(0.1, 600.0));
  add_negation(command, "--no-programs", league.wants_programs, "Start no programs, also none of the file");
  add(command, "--page", league.page, "FILE.md", "Write the tables into this page, below its marker");
  add_jobs(command, options.jobs);
  command.footer("Example: chicane league studies/leagues/shipped.yaml -o league.html");
}

void add_claims(CLI::App& command, Options& options) {
  Options::Claims& claims = options.claims;
  add(command, "ids", claims.ids, "ID", "Claims to try, with figures and commands; all when left out");
  add_shown(command, "--folder", claims.folder, "FOLDER", "Folder with the claims, *.yaml");
  CLI::Option* const page =
      add(command, "--page", claims.page, "FILE.md", "Write the verdicts into this page, below its marker");
  command.add_flag("--check", claims.is_check, "Compare with the page only; exit code 1 where a row differs")
      ->needs(page);
  add_results(command, options, "run");
  add_jobs(command, options.jobs);
  command.footer("Example: chicane claims B7 D9");
}

void add_merge(CLI::App& command, Options& options) {
  add(command, "files", options.files, "FILE.jsonl", "Results of the parts of one sweep")->required();
  add(command, "-o,--output", options.output_file, "FILE.jsonl",
      "File for all of them, in the order of the plan")
      ->required();
  add(command, "--csv", options.csv_file, "FILE.csv",
      "Write a table with a column for each setting and result, too");
  command.footer("Example: chicane merge results.*-of-*.jsonl -o results.jsonl");
}

void add_tune(CLI::App& command, Options& options) {
  add_controller(command, options);
  add_setting(command, options, "--track", "track", "NAME|FILE", "Track (chicane list tracks)");
  add_setting(command, options, "--latency-ms", "latency_ms", "X",
              "Actuation delay of the simulated car [ms]");
  Options::Tune& tune = options.tune;
  add(command, "--over", tune.over, "KEY,...",
      "Keys of numbers to change, with commas; weights, horizon and speed when left out")
      ->delimiter(',');
  add_shown(command, "--objective", tune.objective, "NAME",
            "Objective, beside a clean lap with no less margin")
      ->check(CLI::IsMember({"lap", "comfort", "robust"}));
  add_shown(command, "--optimizer", tune.optimizer, "NAME",
            "Optimizer of NLopt: random search, DIRECT, or Subplex from the preset on")
      ->check(CLI::IsMember({"crs", "direct", "sbplx"}));
  add_shown(command, "--evaluations", tune.evaluations, "N",
            "Number of tunings to judge, up to six trials each")
      ->check(CLI::Range(1, 10000000));
  add_shown(command, "--search-seed", tune.seed, "N", "Seed of the random search");
  add(command, "--log", tune.log, "FILE.jsonl",
      "File with a line for each evaluation; a search that was ended goes on with it");
  add_json(command, options);
  add(command, "-o,--output", options.output_file, "FILE.yaml", "Keep what was found as a preset");
  add_jobs(command, options.jobs);
  add_set(command, options);
  command.footer("Example: chicane tune --preset weighted --evaluations 2000 -o tuned.yaml");
}

void add_campaign(CLI::App& command, Options& options) {
  Options::Campaign& campaign = options.campaign;
  add(command, "--faults", campaign.faults, "NAME,...",
      "Faults, with commas (chicane list faults); all when left out")
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
  add_shown(command, "--every-s", campaign.step, "S", "Time between the moments of the flying lap [s]")
      ->check(CLI::Range(0.02, 1000.0));
  add(command, "--onsets", campaign.onsets, "N",
      "Number of moments by chance in the place of --every-s, for each fault, duration, track, car "
      "and preset")
      ->check(CLI::Range(1, 10000));
  add_shown(command, "--seed", campaign.seed, "N", "Seed of these moments");
  add_results(command, options, "fault, duration, track, car and preset");
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
  add_shown(command, "--starts", recover.starts, "N",
            "Starts for each car and track: standing, rolling, sliding, backwards, spun")
      ->check(CLI::Range(1, 100000));
  add_shown(command, "--seed", recover.seed, "N", "Seed of the starts");
  add(command, "--only", recover.only, "I", "Number of the only start to drive")
      ->check(CLI::Range(1, 100000));
  add_results(command, options, "start");
  add_setting(command, options, "--preset", "preset", "NAME",
              "Controller and its settings (chicane list presets)");
  add_where(command, recover, options);
  command.footer("Example: chicane recover --tracks lakeside,oval --starts 120");
}

void add_lane_change(CLI::App& command, Options& options) {
  Options::LaneChange& change = options.lane_change;
  add_names(command, "--cars", change.cars, "Names or files, with commas");
  add_names(command, "--presets", change.presets, "Presets that steer: names or files, with commas");
  add_results(command, options, "car and preset");
  add_jobs(command, options.jobs);
  add_json(command, options);
  add_set(command, options);
  command.footer("Example: chicane lane-change --cars road-car --presets default,stanley");
}

}  // namespace chicane::apps
