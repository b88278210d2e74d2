// SPDX-License-Identifier: MIT
// Options of the other commands.
#include <fmt/format.h>

#include <string>

#include "command_options.hpp"
#include "commands.hpp"
#include "setting_options.hpp"

namespace chicane::apps {
namespace {

constexpr int kLongestHorizon =
    200;  ///< limit of bench/problems/reference.hpp, which is not part of this program

}  // namespace

void add_limit(CLI::App& command, Options& options) {
  add_setting(command, options, "--track", "track", "NAME|FILE", "Track (chicane list tracks)");
  add_setting(command, options, "--car", "car", "NAME|FILE", "Car (chicane list cars)");
  add(command, "--csv", options.csv_file, "FILE", "Keep the racing line in this file, a track to drive on");
  command.add_flag("--quick", options.is_quick,
                   "Find the bound alone, without a lap that was driven; goes with the next version");
  add(command, "--spacing-m", options.spacing, "X", "Nothing any more; goes with the next version")
      ->check(CLI::Range(0.5, 5.0));
  add_shown(command, "--budget-s", options.limit_budget, "X",
            "Work of the search, in seconds of a reference core; the best lap so far is shown then")
      ->check(CLI::PositiveNumber);
  add_json(command, options);
  add_set(command, options);
  command.footer("Example: chicane limit --track lakeside --car road-car --csv line.csv");
}

void add_import(CLI::App& command, Options& options) {
  Options::Import& import = options.import_;
  add(command, "file", import.file, "FILE",
      "Map (.yaml beside its image), table, cones, JSON, GPX, KML, OSM, OpenDRIVE or CommonRoad")
      ->required();
  add(command, "-o,--output", options.output_file, "NAME.csv",
      "Write the road into this file; an older one is replaced");
  add(command, "--preview", import.preview, "FILE.html",
      "Draw what was recognised into this page; an older one is replaced");
  add(command, "--width-m", import.width, "X", "Width of the road where the file has none [m], default 9")
      ->check(CLI::Range(0.1, 100.0));
  add(command, "--direction", import.direction, "DIRECTION", "Direction of driving: cw turns right, ccw left")
      ->check(CLI::IsMember({"cw", "ccw", "reversed"}));
  add(command, "--start", import.start, "X,Y", "Place whose nearest point becomes the start [m], like 3.5,-1")
      ->delimiter(',')
      ->expected(2);
  add(command, "--smoothing-m", import.smoothing, "X",
      "Noise of the points, which smoothing removes [m], default the format's")
      ->check(CLI::Range(0.0, 1.0));
  add(command, "--spacing-m", import.spacing, "X",
      "Distance between the points written [m], default a fifth of the width")
      ->check(CLI::Range(0.02, 10.0));
  add_shown(command, "--min-width-m", import.least_width, "X", "Narrowest passage of a map that is road [m]")
      ->check(CLI::Range(0.05, 20.0));
  add(command, "--columns", import.columns, "NAME,...",
      "Columns of a table without a line of names: x_m,y_m,skip,skip");
  CLI::Option* const closed = command.add_flag("--closed", import.is_closed, "Take the road for a loop");
  command.add_flag("--open", import.is_open, "Take the road for an open one")->excludes(closed);
  add_json(command, options);
  command.footer("Example: chicane import map.yaml -o hall.csv --preview hall.html");
}

void add_video(CLI::App& command, Options& options) {
  Options::Video& video = options.video;
  add(command, "log", options.log_files, "LOG", "Recording by --record")->required()->expected(1);
  add(command, "-o,--output", options.output_file, "FILE",
      "Film to write: .mp4, .webm, .webp or .gif; an older one is replaced")
      ->required();
  add(command, "--ghost", video.ghost, "LOG", "Recording whose car drives beside, from the same beginning");
  add(command, "--lap", video.lap, "N", "Counted from 1; 0: the whole run; the last whole lap when left out")
      ->check(CLI::Range(0, 1000000));
  add(command, "--from-s", video.from, "S", "Begin so long after the beginning of the lap [s]")
      ->check(CLI::NonNegativeNumber);
  add(command, "--for-s", video.length, "S", "Show so long [s]; else to its end")->check(CLI::PositiveNumber);
  add_shown(command, "--pace", video.speed, "X", "Seconds of the run in a second of the film")
      ->check(CLI::Range(0.05, 50.0));
  add_shown(command, "--rate", video.rate, "N", "Pictures in a second")->check(CLI::Range(1.0, 120.0));
  add_shown(command, "--width", video.width, "N", "Width of the picture [px]; its height is 9/16 of it")
      ->check([](const std::string& text) {
        int width = 0;
        const bool is_even =
            CLI::detail::lexical_cast(text, width) && width >= 160 && width <= 3840 && width % 2 == 0;
        return is_even ? std::string() : "got " + text + ", expected an even number from 160 to 3840";
      });
  add(command, "--quality", video.quality, "N", "Quality of .webp, 1 to 100")->check(CLI::Range(1, 100));
  command.add_flag("--whole", video.is_whole, "Show the whole road all the time, not the car from above");
  command.footer("Example: chicane video run.mcap -o lap.mp4 --ghost other.mcap");
}

void add_bench(CLI::App& command, Options& options) {
  add_shown(command, "--instances", options.instances, "N",
            "Problems of each family and horizon; ours solves ten times as many")
      ->check(CLI::Range(1, 100000));
  add_shown(command, "--horizons", options.horizons, "N,...", "Numbers of intervals, with commas")
      ->delimiter(',')
      ->check(CLI::Range(2, kLongestHorizon));
  add(command, "--reference", options.reference_folder, "FOLDER",
      "Folder of recorded problems with known optima (lap_*.csv, golden_*.csv)");
  add_json(command, options);
  command.footer("Example: chicane bench --instances 200 --horizons 10,20");
}

void add_list(CLI::App& command, Options& options) {
  add(command, "what", options.shelf, "WHAT",
      fmt::format("{}; an overview when left out", fmt::join(list_names(), ", ")))
      ->check(CLI::IsMember(list_names()));
  command.add_flag("--markdown", options.is_markdown,
                   "parameters and faults: as in docs/configuration.md and docs/faults.md");
  command.footer("Example: chicane list presets");
}

void add_completion(CLI::App& command, Options& options) {
  add(command, "shell", options.shell, "SHELL", "Shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command.footer("Example: source <(chicane completion bash)");
}

void add_manual(CLI::App& command, Options&) { command.footer("Example: chicane manual | man -l -"); }

}  // namespace chicane::apps
