// SPDX-License-Identifier: MIT
#include "sweep_options.hpp"

#include <fmt/format.h>

#include "chicane/sweep/shard.hpp"
#include "setting_options.hpp"

namespace chicane::apps {

void add_jobs(CLI::App& command, int& jobs) {
  command.add_option("--jobs", jobs, "Threads; 0: as many as cores")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

void add_results(CLI::App& command, std::string& results, std::string_view each) {
  command
      .add_option("--results", results,
                  fmt::format("File with a line for each {}; one that is there is completed", each))
      ->type_name("FILE.jsonl");
}

void add_sweep(CLI::App& command, Options& options) {
  Options::Sweep& sweep = options.sweep;
  command.add_option("plan", sweep.plan_file, "Plan of what to drive (docs/sweep.md)")
      ->type_name("PLAN.yaml")
      ->required();
  command
      .add_option("-o,--output", options.output_file,
                  "Results, a line for each run; a file that is there is completed. PLAN.jsonl when left out")
      ->type_name("FILE.jsonl");
  add_jobs(command, options.jobs);
  command
      .add_option(
          "--shard", sweep.shard,
          "Drive part I of N, into FILE.I-of-N.jsonl; in a Slurm array or under MPI it is known without it")
      ->type_name("I/N")
      ->check([](const std::string& text) {
        const auto shard = sweep::parse_shard(text);
        return shard ? std::string() : shard.error().message;
      });
  command
      .add_option("--show", sweep.shown,
                  "Drive nothing: print the command that drives this run, counted from 0")
      ->type_name("RUN")
      ->check(CLI::Range(0.0, 1e9));
  command.footer("Example: chicane sweep studies/plans/speed-and-latency.yaml --jobs 4");
}

void add_search(CLI::App& command, Options& options) {
  Options::Tune& tune = options.tune;
  command
      .add_option("--over", tune.over,
                  "Keys of numbers to change, with commas; weights, horizon and speed when left out")
      ->type_name("KEY,...")
      ->delimiter(',');
  command.add_option("--objective", tune.objective, "Objective, beside a clean lap with no less margin")
      ->type_name("NAME")
      ->check(CLI::IsMember({"lap", "comfort", "robust"}))
      ->capture_default_str();
  command
      .add_option("--optimizer", tune.optimizer,
                  "Optimizer of NLopt: random search, DIRECT, or Subplex from the preset on")
      ->type_name("NAME")
      ->check(CLI::IsMember({"crs", "direct", "sbplx"}))
      ->capture_default_str();
  command.add_option("--evaluations", tune.evaluations, "Number of tunings to judge, up to six trials each")
      ->type_name("N")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str();
  command.add_option("--search-seed", tune.seed, "Seed of the random search")
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--log", tune.log,
                  "File with a line for each evaluation; a search that was ended goes on with it")
      ->type_name("FILE.jsonl");
  command.add_flag("--json", options.is_json, "Print one JSON object on stdout, all else on stderr");
  command.add_option("-o,--output", options.output_file, "Keep what was found as a preset")
      ->type_name("FILE.yaml");
  add_jobs(command, options.jobs);
}

void add_league(CLI::App& command, Options& options) {
  Options::League& league = options.league;
  command.add_option("league", league.file, "League of who drives where (docs/league.md)")
      ->type_name("LEAGUE.yaml")
      ->required();
  command.add_option("-o,--output", options.output_file, "Page to write; an older one is replaced")
      ->type_name("FILE.html");
  command
      .add_option("--results", league.results,
                  "File with a line for each run; one that is there is completed. LEAGUE.jsonl when left out")
      ->type_name("FILE.jsonl");
  command.add_option("--csv", options.csv_file, "Write a table with a row for each run, too")
      ->type_name("FILE.csv");
  command.add_flag("--json", options.is_json, "Print a JSON list on stdout, too");
  command
      .add_option(
          "--server", league.servers,
          "Command that starts a program of your own, which joins; may be repeated. {port}, "
          "{latency_ms}, {track} and {chicane} in it are filled in; without {port} it listens on 4567")
      ->type_name("CMD")
      ->allow_extra_args(false);
  command
      .add_option("--patience-s", league.patience,
                  "Patience with a program that does not connect or answer [s]")
      ->type_name("S")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  add_negation(command, "--no-programs", league.wants_programs, "Start no programs, also none of the file");
  command.add_option("--page", league.page, "Write the tables into this page, below its marker")
      ->type_name("FILE.md");
  add_jobs(command, options.jobs);
  command.footer("Example: chicane league studies/leagues/shipped.yaml -o league.html");
}

void add_claims(CLI::App& command, Options& options) {
  Options::Claims& claims = options.claims;
  command.add_option("ids", claims.ids, "Claims to try, with figures and commands; all when left out")
      ->type_name("ID");
  command.add_option("--folder", claims.folder, "Folder with the claims, *.yaml")
      ->type_name("FOLDER")
      ->capture_default_str();
  CLI::Option* const page =
      command.add_option("--page", claims.page, "Write the verdicts into this page, below its marker")
          ->type_name("FILE.md");
  command.add_flag("--check", claims.is_check, "Compare with the page only; exit code 1 where a row differs")
      ->needs(page);
  add_results(command, claims.results, "run");
  add_jobs(command, options.jobs);
  command.footer("Example: chicane claims B7 D9");
}

void add_merge(CLI::App& command, Options& options) {
  command.add_option("files", options.files, "Results of the parts of one sweep")
      ->type_name("FILE.jsonl")
      ->required();
  command.add_option("-o,--output", options.output_file, "File for all of them, in the order of the plan")
      ->type_name("FILE.jsonl")
      ->required();
  command
      .add_option("--csv", options.csv_file, "Write a table with a column for each setting and result, too")
      ->type_name("FILE.csv");
  command.footer("Example: chicane merge results.*-of-*.jsonl -o results.jsonl");
}

}  // namespace chicane::apps
