// SPDX-License-Identifier: MIT
// Options of the other commands.
#include <fmt/format.h>

#include <string>

#include "chicane/base/text.hpp"
#include "command_options.hpp"
#include "commands.hpp"

namespace chicane::apps {
namespace {

constexpr int kLongestHorizon =
    200;  ///< limit of bench/problems/reference.hpp, which is not part of this program

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
      {"file", "FILE", "Map (.yaml with its image), table, cones, JSON, GPX, KML, OSM or OpenDRIVE",
       &import.file, kRequired},
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
          {"--reference", "FOLDER", "Folder of recorded problems with known optima (lap_*.csv, golden_*.csv)",
           &o.reference_folder},
          json_row(o)};
}

Rows list_rows(Options& o) {
  return {{"what", "WHAT", "Shelf to show; an overview when left out", &o.shelf, one_of(list_names())},
          {"--markdown", "", "Print parameters or faults as tables of Markdown", &o.is_markdown}};
}

Rows completion_rows(Options& o) {
  return {{"shell", "SHELL", "Shell", &o.shell, one_of({"bash", "zsh", "fish"}) | kRequired}};
}

}  // namespace chicane::apps
