// SPDX-License-Identifier: MIT
// Tables of the options of the commands that drive many runs, and of `limit`, `import`, `video`, `bench`,
// `list` and `completion` (run_options.cpp describes a row). Ranges are chosen.
#include <fmt/format.h>

#include <string>

#include "chicane/base/text.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/run/fault_campaign.hpp"
#include "chicane/run/parallel.hpp"
#include "commands.hpp"

namespace chicane::apps {
namespace {

// Limit of bench/problems/structured_solver.hpp, which is not part of this program.
constexpr int kLongestHorizon = 200;

/// Option for the start of a road.
OptionRow start_row(std::vector<double>& start) {
  const auto take = [&start](const std::string& text) -> std::string {
    const std::size_t comma = text.find(',');
    const auto x = number_in(text.substr(0, comma));
    const auto y = number_in(comma == std::string::npos ? "" : text.substr(comma + 1));
    if (!x || !y) return "two numbers X,Y";
    start = {*x, *y};
    return "";
  };
  return {"--start", "X,Y", "Place whose nearest point becomes the start [m], like 3.5,-1", take, kOnce};
}

/// Option for the width of a film: even, because encoders need it.
OptionRow film_width_row(int& width) {
  const auto take = [&width](const std::string& text) -> std::string {
    const auto pixels = count_in(text);
    if (!pixels || *pixels < 160 || *pixels > 3840 || *pixels % 2 != 0)
      return "an even number from 160 to 3840";
    width = static_cast<int>(*pixels);
    return "";
  };
  return {"--width", "N", "Width of the picture [px], 1280 when left out; its height is 9/16 of it", take,
          kOnce};
}

/// Option for an optional length.
OptionRow metres_row(std::string name, std::optional<double>& metres, Interval within, std::string meaning) {
  return {std::move(name), "X", std::move(meaning), &metres, between(within.least, within.most)};
}

}  // namespace

Rows limit_rows(Options& o) {
  return {track_row(),
          {"--car", "NAME|FILE", "Car", Setting{"car"}, from_shelf("cars")},
          {"--csv", "FILE", "Keep the racing line in this file, a track to drive on", &o.csv_file},
          {"--budget-s", "X",
           "Work of the search, in seconds of a reference core; the best lap so far is shown then",
           &o.limit_budget, kPositive | kShown},
          json_row(o),
          set_row(o)};
}

Rows import_rows(Options& o) {
  Options::Import& import = o.import_;
  return {
      {"file", "FILE", std::string(protocol::kRoadFiles), &import.file, kRequired},
      {"-o,--output", "NAME.csv", "Write the road into this file; an older one is replaced", &o.output_file},
      {"--preview", "FILE.html", "Draw what was recognised into this page; an older one is replaced",
       &import.preview},
      metres_row("--width-m", import.width, {0.1, 100.0},
                 "Width of the road where the file has none [m]; 9 when left out"),
      {"--direction", "DIRECTION", "Direction of driving: cw turns right, ccw left", &import.direction,
       one_of({"cw", "ccw", "reversed"})},
      start_row(import.start),
      metres_row("--smoothing-m", import.smoothing, {0.0, 1.0},
                 "Noise of the points, which smoothing removes [m]; the format's when left out"),
      metres_row("--spacing-m", import.spacing, {0.02, 10.0},
                 "Distance between the points written [m]; a fifth of the width when left out"),
      {"--min-width-m", "X", "Narrowest passage of a map that is road [m]", &import.least_width,
       between(0.05, 20.0) | kShown},
      {"--columns", "NAME,NAME", "Columns of a table without a line of names: x_m,y_m,skip,skip",
       &import.columns},
      {"--closed", "", "Take the road for a loop", &import.is_closed},
      {"--open", "", "Take the road for an open one", &import.is_open, without({"--closed"})},
      json_row(o)};
}

Rows video_rows(Options& o) {
  Options::Video& video = o.video;
  const auto take_log = [&o](const std::string& text) { return o.log_files = {text}, std::string(); };
  return {{"log", "LOG", "Recording by --record", take_log, kRequired | kOnce},
          {"-o,--output", "FILE", "Film to write: .mp4, .webm, .webp or .gif; an older one is replaced",
           &o.output_file, kRequired},
          {"--ghost", "LOG", "Recording whose car drives along, from the same beginning", &video.ghost},
          {"--lap", "N", "Lap, counted from 1; 0: the whole run; the last whole lap when left out",
           &video.lap, between(0, 1000000)},
          {"--from-s", "S", "Begin so long after the beginning of the lap [s]", &video.from, kNonNegative},
          {"--for-s", "S", "Show so long [s]; else to its end", &video.length, kPositive},
          {"--pace", "X", "Seconds of the run in a second of the film", &video.speed,
           between(0.05, 50.0) | kShown},
          {"--rate", "N", "Pictures in a second", &video.rate, between(1.0, 120.0) | kShown},
          film_width_row(video.width),
          {"--quality", "N", "Quality of .webp", &video.quality, between(1, 100)},
          {"--whole", "", "Show the whole road all the time, not the car from above", &video.is_whole}};
}

Rows bench_rows(Options& o) {
  return {{"--instances", "N", "Problems of each family and horizon; ours solves ten times as many",
           &o.instances, between(1, 100000) | kShown},
          {"--horizons", "N,...", "Numbers of intervals, with commas", &o.horizons,
           between(2, kLongestHorizon) | kShown},
          json_row(o)};
}

Rows list_rows(Options& o) {
  return {{"what", "WHAT", "Shelf to show; an overview when left out", &o.shelf, one_of(list_names())},
          {"--markdown", "", "Print parameters or faults as tables of Markdown", &o.is_markdown}};
}

Rows completion_rows(Options& o) {
  return {{"shell", "SHELL", "Shell", &o.shell, one_of({"bash", "zsh", "fish"}) | kRequired},
          {"line", "WORD", "Word before the cursor: prints the words that may follow", &o.line}};
}

namespace {

/// Option for the file of results of many runs.
OptionRow results_row(Options& o, std::string_view each) {
  return {"--results", "FILE.jsonl",
          fmt::format("File with a line for each {}; one that is there is completed", each), &o.results_file};
}

/// Option for a list of names with a default.
OptionRow names_row(std::string name, std::vector<std::string>& names, std::string meaning) {
  return {std::move(name), "NAME,...", std::move(meaning), &names, kShown};
}

/// Option for a number of things with a default.
OptionRow count_row(std::string name, int& count, Interval within, std::string meaning) {
  return {std::move(name), "N", std::move(meaning), &count, between(within.least, within.most) | kShown};
}

/// Option for a seed.
OptionRow seed_row(std::string name, std::uint64_t& seed, std::string meaning) {
  return {std::move(name), "N", std::move(meaning), &seed, kShown};
}

/// Option for the main file to write.
OptionRow output_row(Options& o, std::string_view value, std::string meaning, bool is_required = false) {
  return {"-o,--output", value, std::move(meaning), &o.output_file, {.is_required = is_required}};
}

/// Positional argument for a file to read.
OptionRow file_row(std::string name, std::string_view value, std::string meaning, std::string& file) {
  return {std::move(name), value, std::move(meaning), &file, kRequired};
}

/// Option for one shard of a sweep.
OptionRow shard_row(std::string& shard) {
  const auto take = [&shard](const std::string& text) -> std::string {
    if (!run::parse_shard(text)) return "I/N with 1 <= I <= N, like 3/7";
    shard = text;
    return "";
  };
  return {"--shard", "I/N",
          "Drive part I of N, into FILE.I-of-N.jsonl; in a Slurm array or under MPI it is known "
          "without it",
          take, kOnce};
}

/// Option for durations: "2", or "inf" for a lasting fault.
OptionRow durations_row(std::vector<double>& durations) {
  const auto take = [&durations](const std::string& text) -> std::string {
    const auto seconds =
        text == "inf" ? Result<double>(run::kLasting) : number_in("--for-s", text, 0.001, run::kLasting);
    if (!seconds) return "a number in [0.001, 1000000] or inf";
    durations.push_back(*seconds);
    return "";
  };
  return {"--for-s", "S,...",
          "Durations of the faults [s], with commas; inf: to the end; each fault's own when left out", take};
}

/// Options for the tracks, cars and settings of many runs.
template <class Runs>
Rows where_rows(Runs& runs, Options& o) {
  return {names_row("--tracks", runs.tracks, "Names or files, with commas"),
          names_row("--cars", runs.cars, "Names or files, with commas"), jobs_row(o), json_row(o),
          set_row(o)};
}

}  // namespace

OptionRow jobs_row(Options& o) {
  return count_row("--jobs", o.jobs, {0, 1024}, "Threads; 0: as many as cores");
}

Rows sweep_rows(Options& o) {
  return {
      file_row("plan", "PLAN.yaml", "Plan of what to drive (docs/sweep.md)", o.sweep.plan_file),
      output_row(o, "FILE.jsonl",
                 "Results, a line for each run; a file that is there is completed. PLAN.jsonl when left out"),
      jobs_row(o),
      shard_row(o.sweep.shard),
      {"--show", "RUN", "Drive nothing: print the command that drives this run, counted from 0",
       &o.sweep.shown, between(0.0, 1e9)}};
}

Rows league_rows(Options& o) {
  Options::League& league = o.league;
  return {file_row("league", "LEAGUE.yaml", "League of who drives where (docs/sweep.md)", league.file),
          output_row(o, "FILE.html", "Page to write; an older one is replaced"),
          {"--results", "FILE.jsonl",
           "File with a line for each run; one that is there is completed. LEAGUE.jsonl when left out",
           &o.results_file},
          {"--csv", "FILE.csv", "Write a table with a row for each run, too", &o.csv_file},
          {"--json", "", "Print a JSON list on stdout, too", &o.is_json},
          {"--server", "CMD",
           "Command that starts a program of your own, which joins. {port}, {latency_ms}, {track} and "
           "{chicane} in it are filled in; without {port} it listens on 4567",
           &league.servers},
          {"--patience-s", "S", "Patience with a program that does not connect or answer [s]",
           &league.patience, between(0.1, 600.0) | kShown},
          {"--no-programs", "", "Start no programs, also none of the file", Off{&league.wants_programs}},
          {"--page", "FILE.md", "Write the tables into this page, below its marker", &league.page},
          jobs_row(o)};
}

Rows claims_rows(Options& o) {
  Options::Claims& claims = o.claims;
  return {{"ids", "ID", "Claims to try, with figures and commands; all when left out", &claims.ids},
          {"--folder", "FOLDER", "Folder with the claims, *.yaml", &claims.folder, kShown},
          {"--page", "FILE.md", "Write the verdicts into this page, below its marker", &claims.page},
          {"--check", "", "Compare with the page only; exit code 1 where a row differs", &claims.is_check,
           with("--page")},
          results_row(o, "run"),
          jobs_row(o)};
}

Rows merge_rows(Options& o) {
  return {{"files", "FILE.jsonl", "Results of the parts of one sweep", &o.files, kRequired},
          output_row(o, "FILE.jsonl", "File for all of them, in the order of the plan", true),
          {"--csv", "FILE.csv", "Write a table with a column for each setting and result, too", &o.csv_file}};
}

Rows tune_rows(Options& o) {
  Options::Tune& tune = o.tune;
  return joined(
      {controller_rows(o),
       {track_row(),
        {"--latency-ms", "X", "Actuation delay of the simulated car [ms]", Setting{"latency_ms"}},
        {"--over", "KEY,...",
         "Keys of numbers to change, with commas; weights, horizon and speed when left out", &tune.over},
        {"--objective", "NAME", "Objective, besides a clean lap with no less margin", &tune.objective,
         one_of({"lap", "comfort", "robust"}) | kShown},
        {"--optimizer", "NAME", "Optimizer of NLopt: random search, DIRECT, or Subplex from the preset on",
         &tune.optimizer, one_of({"crs", "direct", "sbplx"}) | kShown},
        count_row("--evaluations", tune.evaluations, {1, 10000000},
                  "Number of tunings to judge, up to six trials each"),
        seed_row("--search-seed", tune.seed, "Seed of the random search"),
        {"--log", "FILE.jsonl",
         "File with a line for each evaluation; a search that was ended goes on with it", &tune.log},
        json_row(o),
        output_row(o, "FILE.yaml", "Keep what was found as a preset"),
        jobs_row(o),
        set_row(o)}});
}

Rows campaign_rows(Options& o) {
  Options::Campaign& campaign = o.campaign;
  return joined(
      {{{"--faults", "NAME,...", "Faults, with commas; all when left out", &campaign.faults,
         from_shelf("faults")},
        {"--pairs", "",
         "Add each two of them at once; without --faults: the faults of measurement, link, computer",
         &campaign.has_pairs},
        durations_row(campaign.durations),
        {"--every-s", "S", "Time between the moments of the flying lap [s]", &campaign.step,
         between(0.02, 1000.0) | kShown},
        {"--onsets", "N",
         "Number of moments by chance, for each fault, duration, track, car and preset; replaces "
         "--every-s",
         &campaign.onsets, between(1, 10000)},
        seed_row("--seed", campaign.seed, "Seed of these moments"),
        results_row(o, "fault, duration, track, car and preset"),
        {"--markdown", "", "Print the table as Markdown on stdout", &o.is_markdown},
        names_row("--preset", campaign.presets,
                  "Controllers and their settings; as --tracks and --cars: all stands for those that ship")},
       where_rows(campaign, o)});
}

Rows recover_rows(Options& o) {
  Options::Recover& recover = o.recover;
  return joined(
      {{count_row("--starts", recover.starts, {1, 100000},
                  "Starts for each car and track: standing, rolling, sliding, backwards, spun"),
        seed_row("--seed", recover.seed, "Seed of the starts"),
        {"--only", "I", "Number of the only start to drive", &recover.only, between(1, 100000)},
        results_row(o, "start"),
        {"--preset", "NAME", "Controller and its settings", Setting{"preset"}, from_shelf("presets")}},
       where_rows(recover, o)});
}

Rows lane_change_rows(Options& o) {
  return {names_row("--cars", o.lane_change.cars, "Names or files, with commas"),
          names_row("--presets", o.lane_change.presets, "Presets that steer: names or files, with commas"),
          results_row(o, "car and preset"),
          jobs_row(o),
          json_row(o),
          set_row(o)};
}

}  // namespace chicane::apps
