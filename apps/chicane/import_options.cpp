// SPDX-License-Identifier: MIT
#include "import_options.hpp"

namespace chicane::apps {

void add_import(CLI::App& command, Options& options) {
  Options::Import& import = options.import_;
  command
      .add_option("file", import.file,
                  "Map (.yaml beside its image), table, cones, JSON, GPX, KML, OSM, OpenDRIVE or CommonRoad")
      ->type_name("FILE")
      ->required();
  command
      .add_option("-o,--output", options.output_file,
                  "Write the road into this file; an older one is replaced")
      ->type_name("NAME.csv");
  command
      .add_option("--preview", import.preview,
                  "Draw what was recognised into this page; an older one is replaced")
      ->type_name("FILE.html");
  command.add_option("--width-m", import.width, "Width of the road where the file has none [m], default 9")
      ->type_name("X")
      ->check(CLI::Range(0.1, 100.0));
  command.add_option("--direction", import.direction, "Direction of driving: cw turns right, ccw left")
      ->type_name("DIRECTION")
      ->check(CLI::IsMember({"cw", "ccw", "reversed"}));
  command.add_option("--start", import.start, "Place whose nearest point becomes the start [m], like 3.5,-1")
      ->type_name("X,Y")
      ->delimiter(',')
      ->expected(2);
  command
      .add_option("--smoothing-m", import.smoothing,
                  "Noise of the points, which smoothing removes [m], default the format's")
      ->type_name("X")
      ->check(CLI::Range(0.0, 1.0));
  command
      .add_option("--spacing-m", import.spacing,
                  "Distance between the points written [m], default a fifth of the width")
      ->type_name("X")
      ->check(CLI::Range(0.02, 10.0));
  command.add_option("--min-width-m", import.least_width, "Narrowest passage of a map that is road [m]")
      ->type_name("X")
      ->check(CLI::Range(0.05, 20.0))
      ->capture_default_str();
  command
      .add_option("--columns", import.columns,
                  "Columns of a table without a line of names: x_m,y_m,skip,skip")
      ->type_name("NAME,...");
  CLI::Option* const closed = command.add_flag("--closed", import.is_closed, "Take the road for a loop");
  command.add_flag("--open", import.is_open, "Take the road for an open one")->excludes(closed);
  command.add_flag("--json", options.is_json, "Print one JSON object on stdout, all else on stderr");
  command.footer("Example: chicane import map.yaml -o hall.csv --preview hall.html");
}

}  // namespace chicane::apps
