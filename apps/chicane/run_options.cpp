// SPDX-License-Identifier: MIT
// Tables of the options of `drive`, `serve`, `simulate`, `ros`, `replay`, `report`, `identify` and `check`. A
// row has the name of the option, the name of its value, the meaning in --help, the member of Options or the
// setting that it fills, and rules such as a range. Ranges are chosen, unless a comment or constant has
// another reason.
#include <fmt/format.h>

#include <string>

#include "chicane/base/math.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/run/closed_loop.hpp"
#include "commands.hpp"

namespace chicane::apps {
namespace {

/// Option for the latency.
OptionRow latency_row(std::string meaning) {
  return {"--latency-ms", "X", std::move(meaning), Setting{"latency_ms"}};
}

/// Option for JSON at the end of a run that another program may end.
OptionRow json_at_end_row(Options& o) {
  return {"--json", "", "Print one JSON object on stdout at the end, all else on stderr", &o.is_json};
}

/// Options for the server of dashboard and simulator.
Rows port_rows(Options& o) {
  return {
      {"--port", "P", "Port of dashboard and simulator socket; 0 takes any free one", &o.port,
       between(0, 65535) | kShown},
      {"--address", "A", "Address to listen on; 0.0.0.0 lets other machines in", &o.address, kShown},
      {"--allow-host", "NAME", "Host name by which this program may be reached, as in containers",
       &o.allowed_hosts},
      {"--allow-origin", "ORIGIN", "Web page that may connect besides our own, like https://app.foxglove.dev",
       &o.allowed_origins},
      {"--no-token", "", "Let every program of this machine control, without the token of the printed link",
       Off{&o.needs_token}},
  };
}

/// Options for recording and report.
Rows record_rows(Options& o) {
  return {
      {"--record", "FILE", "Record every control step in a new MCAP file", &o.record_file},
      {"--compress", "", "Compress the recording by Zstandard: about half the size", &o.is_compressed,
       with("--record")},
      {"--bag", "", "Write metadata.yaml for the recording, which makes its folder a bag for ros2 bag",
       &o.is_bag, with("--record")},
      {"--report", "FILE.html", "Write the run as one HTML page at its end; replaces an older one",
       &o.report_file},
  };
}

/// Option for faults of the run.
OptionRow fault_row(Options& o) {
  return {"--fault", "NAME@S+S*X", "Fault at a second of the run, for so long, so strong", &o.faults,
          from_shelf("faults")};
}

/// Positional arguments for recordings and logs.
OptionRow logs_row(Options& o, std::string meaning) {
  return {"logs", "LOG", std::move(meaning), &o.log_files, kRequired};
}

/// Options for the topics of a bag.
Rows topic_rows(Options& o) {
  return {{"--odom-topic", "TOPIC", "Odometry of a bag that has several", &o.identify.odom_topic},
          {"--drive-topic", "TOPIC", "Commands of a bag that has several", &o.identify.drive_topic}};
}

/// Options for logs of other programs, which exclude the options `excludes`.
Rows foreign_rows(Options& o, std::vector<std::string_view> excludes) {
  return joined(
      {{{"--track", "NAME|FILE", "Road of a log of another program", Setting{"track"}, without(excludes)},
        {"--car", "NAME|FILE", "Car of a log of another program", Setting{"car"}, without(excludes)}},
       topic_rows(o)});
}

/// Option whose value in miles per hour fills the setting in m/s.
OptionRow speed_mph_row(Options& o) {
  const auto take = [&o](const std::string& text) -> std::string {
    const std::optional<double> mph = number_in(text);
    if (!mph) return "a number";
    o.speed_mps = fmt::format("{}", mph_to_mps(*mph));
    o.speed_mph = text;
    return "";
  };
  return {"--speed-mph", "X", "Speed reference of the controller [mph]", take, kOnce};
}

/// Options of a ROS 2 node.
Rows ros_network_rows(Options::Ros& ros) {
  const auto topic = [](std::string name, std::string& to, std::string meaning) {
    return OptionRow{std::move(name), "TOPIC", std::move(meaning), &to, kShown};
  };
  const auto quality = [](std::string name, std::string& to) {
    return OptionRow{std::move(name), "KIND", "Reliability of the controller's end of this topic", &to,
                     one_of({"best-effort", "reliable"}) | kShown};
  };
  return {
      {"--simulate", "", "Be the car and its simulator, for a controller that is a ROS 2 program",
       &ros.is_simulator},
      {"--domain", "N", "DDS domain", &ros.domain,
       between(0, 232) | from_variable("ROS_DOMAIN_ID")},  // the last domain whose UDP ports exist
      {"--interface", "NAME", "Network interface of DDS: lo reaches this machine alone, auto takes the best",
       &ros.interface, kShown},
      {"--peer", "ADDRESS", "Address of a partner, where there is no multicast", &ros.peers},
      topic("--odom-topic", ros.odom_topic, "Odometry of the car"),
      topic("--drive-topic", ros.drive_topic, "Commands as AckermannDriveStamped"),
      topic("--autoware-topic", ros.autoware_topic, "Commands as Autoware's Control, too"),
      topic("--path-topic", ros.path_topic, "Follow a nav_msgs/Path in place of a track"),
      topic("--imu-topic", ros.imu_topic, "IMU: its yaw rate is compared with the odometry's"),
      {"--map-frame", "FRAME", "Frame of the odometry's pose", &ros.map_frame, kShown},
      {"--base-frame", "FRAME", "Frame of the car", &ros.base_frame, kShown},
      {"--base-at", "PLACE",
       "Place of the car's frame: in the middle of the rear axle, or in the centre of mass", &ros.base_at,
       one_of({"rear-axle", "centre-of-mass"}) | kShown},
      {"--use-sim-time", "", "Count time by /clock, as a simulator sends it, in place of this machine's",
       &ros.is_time_simulated, without({"--simulate"})},
      {"--pace", "X", "Seconds of the simulator in a second of the clock; sends /clock", &ros.pace,
       between(run::kSlowestPace, run::kFastestPace) | with("--simulate")},
      {"--map", "FILE.yaml",
       "Occupancy map whose walls /scan sees, as map_server reads it, in place of the track's edges",
       &ros.map_file, with("--simulate")},
      {"--drive-by", "PART", "Part of a drive message that the car follows", &ros.drive_by,
       one_of({"speed", "acceleration"}) | kShown},
      {"--speed-lead-s", "X",
       "Time in which the car's speed controller closes a gap, with --drive-by speed [s]", &ros.speed_lead,
       between(0.02, 5.0) | kShown},
      quality("--odom-qos", ros.odom_qos),
      quality("--drive-qos", ros.drive_qos),
  };
}

}  // namespace

OptionRow json_row(Options& o) {
  return {"--json", "", "Print one JSON object on stdout, all else on stderr", &o.is_json};
}

OptionRow set_row(Options& o) {
  const auto take = [&o](const std::string& text) -> std::string {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) return "key=value without blanks";
    o.settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    return "";
  };
  return {"--set", "KEY=VALUE", "Setting", take, from_shelf("parameters")};
}

OptionRow track_row() { return {"--track", "NAME|FILE", "Track", Setting{"track"}, from_shelf("tracks")}; }

Rows controller_rows(Options& o) {
  return {
      {"--preset", "NAME", "Controller and its settings", Setting{"preset"}, from_shelf("presets")},
      {"--controller", "NAME", "Controller in place of the preset's", Setting{"controller"},
       from_shelf("controllers")},
      {"--car", "NAME|FILE", "Car of the simulation and of the controller's model", Setting{"car"},
       from_shelf("cars")},
      {"--speed-mps", "X", "Speed reference of the controller [m/s]", &o.speed_mps, without({"--speed-mph"})},
      speed_mph_row(o),
  };
}

Rows world_rows() {
  return {
      track_row(),
      {"--laps", "N", "Laps to drive; 0, the default of a dashboard, drives until stopped", Setting{"laps"}},
      {"--seed", "N", "Seed of everything random", Setting{"seed"}}};
}

Rows drive_rows(Options& o) {
  const Rows own = {
      latency_row("Actuation delay of the simulated car [ms], 100 when left out"),
      {"--fast", "", "Run as fast as possible, deterministic, without sockets", &o.is_fast},
      {"--limit", "", "Find the limit first, for the gap of each lap to it", &o.wants_limit, with("--fast")},
      {"--explain", "",
       "Drive again without latency, edge margin, grip reserve, sensor errors and guard, one at a "
       "time: what each takes of the gap, corner by corner",
       &o.wants_causes, with("--limit")},
  };
  const Rows by_the_clock = {
      {"--pace", "X", "Seconds of the run in a second of the clock; viewers can change it", &o.pace,
       between(run::kSlowestPace, run::kFastestPace) | without({"--fast"})},
      {"--step-budget-ms", "X",
       "Bound of a control step by the clock; 0: none; 80 % of the control period when left out",
       &o.step_budget_ms, between(0.0, 1000.0) | without({"--fast"})},
      {"--manual", "", "Drive by hand, by the dashboard's arrow keys or \"manual.…\"", &o.is_manual,
       without({"--fast"})},
  };
  return joined({{{"scenario", "SCENARIO", "Scenario by name or file; other options win over it",
                   &o.scenario_file, from_shelf("scenarios")}},
                 controller_rows(o),
                 world_rows(),
                 own,
                 port_rows(o),
                 by_the_clock,
                 {fault_row(o)},
                 record_rows(o),
                 {json_row(o), set_row(o)}});
}

Rows serve_rows(Options& o) {
  return joined(
      {controller_rows(o),
       {latency_row("Sleep before each answer [ms], 100 when left out, as the original"),
        {"--track", "NAME|FILE",
         "Road of the simulator: judges tyres, shows the gap to the limit. For the original game its "
         "course's lake_track_waypoints.csv; lap times need none",
         Setting{"track"}},
        {"--lock-step-ms", "X",
         "Time that the simulator advances with each answer; else the measurements show its clock",
         &o.lock_step_ms, between(1.0, 1000.0)},
        {"--sim-time", "FIELD",
         "Field of the telemetry with the simulator's time [s]: the run is counted by it", &o.sim_time,
         without({"--lock-step-ms"})}},
       port_rows(o),
       record_rows(o),
       {json_at_end_row(o), set_row(o)}});
}

Rows simulate_rows(Options& o) {
  return joined(
      {{{"--connect", "URL", "Address of the controller", &o.connect, kShown},
        {"--server", "CMD", "Start the controller with this command, and again when it dies", &o.server},
        {"--car", "NAME|FILE", "Simulated car", Setting{"car"}, from_shelf("cars")}},
       world_rows(),
       record_rows(o),
       {json_row(o), set_row(o)}});
}

Rows ros_rows(Options& o) {
  return joined(
      {controller_rows(o),
       world_rows(),
       {latency_row("Time from a command's arrival to its effect at the car [ms]; the car's when left out")},
       ros_network_rows(o.ros),
       port_rows(o),
       record_rows(o),
       {json_at_end_row(o), set_row(o)}});
}

Rows replay_rows(Options& o) {
  OptionRow set = set_row(o);
  set.rule.needs = "--branch-at";
  return joined(
      {{logs_row(o, "Recordings by --record, and bags and tables of other programs; several are compared"),
        {"--verify", "",
         "Compute every recorded command again and compare it bit for bit; exit code 1 if one differs",
         &o.wants_verification},
        {"--branch-at", "T",
         "Drive on otherwise from this second of the recording, and compare the two futures", &o.branch_at,
         kNonNegative | without({"--verify"})},
        set},
       foreign_rows(o, {"--branch-at"}),
       {{"--for-s", "S", "Length of the branch [s]; else to the end of the recording", &o.for_s,
         kPositive | with("--branch-at")},
        {"--laps", "N", "End the branch when the run has so many laps", &o.branch_laps,
         kPositive | with("--branch-at")},
        {"-o,--output", "FILE", "Keep the branch in a new MCAP file", &o.output_file, with("--branch-at")}},
       port_rows(o),
       {{"--no-serve", "", "Show nothing in a browser", Off{&o.is_served}},
        {"--json", "", "Print one JSON object on stdout, all else on stderr; shows nothing", &o.is_json}}});
}

Rows report_rows(Options& o) {
  return joined(
      {{logs_row(
            o,
            "Recordings by --record, bags and tables of other programs, or the results of a sweep (.jsonl)"),
        {"-o,--output", "FILE.html", "Page to write; an older one is replaced", &o.output_file},
        {"--page", "FILE.md", "Write the heat maps of a sweep in letters into this page", &o.maps_page},
        {"--compare", "KEY=VALUE",
         "Print a table: runs of a sweep compared with the runs of this value of an axis; exit code 1 "
         "where one is worse",
         &o.comparison, without({"--output", "--page"})}},
       foreign_rows(o, {})});
}

Rows identify_rows(Options& o) {
  Options::Identify& identify = o.identify;
  return joined(
      {{logs_row(o, "Recordings, bags (.mcap, .db3) and CSV files of one car; several count together"),
        {"--car", "NAME|FILE", "Car to begin with: mass, width, tyre shape and limits are not in a log",
         Setting{"car"}},
        {"-o,--output", "CAR.yaml", "Write the car into this file; an older one is replaced", &o.output_file},
        {"--report", "FILE.html",
         "Write intervals, predictions and residuals as one HTML page; replaces an older one",
         &o.report_file},
        {"--hold-out", "X", "Share of each log, at its end, that only tests the predictions",
         &identify.hold_out, between(0.0, 0.8) | kShown},
        {"--columns", "MEANING=NAME,...",
         "Columns of a CSV file with other names: steer=cmd_delta_rad,psi=yaw_deg; without a header: "
         "0=time,1=x",
         &identify.columns},
        {"--budget-s", "X", "End the search after so long [s]", &identify.budget_s,
         between(1.0, 86400.0) | kShown},  // up to a day
        {"--force", "", "Write the car also where it does not predict its log", &identify.is_forced}},
       topic_rows(o),
       {json_row(o), set_row(o)}});
}

Rows check_rows(Options& o) {
  return joined({{{"files", "FILE",
                   fmt::format("Presets, scenarios, cars (.yaml) and tracks ({})",
                               chicane::joined(protocol::track_extensions())),
                   &o.files}},
                 controller_rows(o),
                 world_rows(),
                 {latency_row("Actuation delay of the simulated car [ms], 100 when left out"), fault_row(o),
                  set_row(o)}});
}

}  // namespace chicane::apps
