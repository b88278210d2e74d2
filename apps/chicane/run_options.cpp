// SPDX-License-Identifier: MIT
// Options of the commands about one run, its recordings and its car.
#include <fmt/format.h>

#include <string>
#include <utility>

#include "chicane/base/text.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/run/closed_loop.hpp"
#include "command_options.hpp"
#include "setting_options.hpp"

namespace chicane::apps {
namespace {

void add_latency(CLI::App& command, Options& options) {
  add_setting(command, options, "--latency-ms", "latency_ms", "X",
              "Actuation delay of the simulated car [ms], default 100");
}

void add_faults(CLI::App& command, Options& options) {
  add(command, "--fault", options.faults, "NAME@S+S*X",
      "Fault at a second of the run, for so long, so strong (chicane list faults); may be repeated")
      ->take_all();
}

void add_port(CLI::App& command, Options& options) {
  add_shown(command, "--port", options.port, "P",
            "Port of dashboard and simulator socket; 0 takes any free one")
      ->check(CLI::Range(0, 65535));
  add_shown(command, "--address", options.address, "A",
            "Address to listen on; 0.0.0.0 lets other machines in");
  add(command, "--allow-host", options.allowed_hosts, "NAME",
      "Host name by which this program may be reached, as in containers; may be repeated")
      ->allow_extra_args(false);
  add(command, "--allow-origin", options.allowed_origins, "ORIGIN",
      "Web page that may connect beside our own, like https://app.foxglove.dev; may be repeated")
      ->allow_extra_args(false);
  add_negation(command, "--no-token", options.needs_token,
               "Let every program of this machine control, without the token of the printed link");
}

void add_record(CLI::App& command, Options& options) {
  add(command, "--record", options.record_file, "FILE", "Record every control step in a new MCAP file");
  command
      .add_flag("--compress", options.is_compressed,
                "Compress the recording by Zstandard: about half the size")
      ->needs("--record");
  command
      .add_flag("--bag", options.is_bag,
                "Write metadata.yaml beside the recording, which makes its folder a bag for ros2 bag")
      ->needs("--record");
  add(command, "--report", options.report_file, "FILE.html",
      "Write the run as one HTML page at its end; replaces an older one");
}

void add_logs(CLI::App& command, Options& options, const std::string& help) {
  add(command, "logs", options.log_files, "LOG", help)->required();
}

/// Options that read logs of other programs.
void add_foreign(CLI::App& command, Options& options) {
  add_setting(command, options, "--track", "track", "NAME|FILE", "Road of a log of another program");
  add_setting(command, options, "--car", "car", "NAME|FILE", "Car of a log of another program");
  add(command, "--odom-topic", options.identify.odom_topic, "TOPIC", "Odometry of a bag that has several");
  add(command, "--drive-topic", options.identify.drive_topic, "TOPIC", "Commands of a bag that has several");
}

void add_topic(CLI::App& command, const char* name, std::string& to, const char* help) {
  add_shown(command, name, to, "TOPIC", help);
}

void add_ros_network(CLI::App& command, Options& options) {
  Options::Ros& ros = options.ros;
  command.add_flag("--simulate", ros.is_simulator,
                   "Be the car and its simulator, for a controller that is a ROS 2 program");
  add(command, "--domain", ros.domain, "N", "DDS domain, as ROS_DOMAIN_ID, which is the default")
      ->check(CLI::Range(0, 232))
      ->envname("ROS_DOMAIN_ID");
  add_shown(command, "--interface", ros.interface, "NAME",
            "Network interface of DDS: lo reaches this machine alone, auto takes the best");
  add(command, "--peer", ros.peers, "ADDRESS",
      "Address of a partner, where there is no multicast; may be repeated")
      ->allow_extra_args(false);
  add_topic(command, "--odom-topic", ros.odom_topic, "Odometry of the car");
  add_topic(command, "--drive-topic", ros.drive_topic, "Commands as AckermannDriveStamped");
  add_topic(command, "--autoware-topic", ros.autoware_topic, "Commands as Autoware's Control, too");
  add_topic(command, "--path-topic", ros.path_topic, "Follow a nav_msgs/Path in place of a track");
  add_topic(command, "--imu-topic", ros.imu_topic, "IMU: its yaw rate is compared with the odometry's");
  add_shown(command, "--map-frame", ros.map_frame, "FRAME", "Frame of the odometry's pose");
  add_shown(command, "--base-frame", ros.base_frame, "FRAME", "Frame of the car");
  command
      .add_option("--base-at", ros.base_at,
                  "Place of the car's frame: in the middle of the rear axle, or in the "
                  "centre of mass")
      ->check(CLI::IsMember({"rear-axle", "centre-of-mass"}))
      ->capture_default_str();
  CLI::Option* const simulates = command.get_option("--simulate");
  command
      .add_flag("--use-sim-time", ros.is_time_simulated,
                "Count time by /clock, as a simulator sends it, in place of this machine's")
      ->excludes(simulates);
  add(command, "--pace", ros.pace, "X",
      "Seconds of the simulator in a second of the clock, with --simulate; sends /clock")
      ->check(CLI::Range(0.05, 20.0))
      ->needs(simulates);
  add(command, "--map", ros.map_file, "FILE.yaml",
      "Occupancy map whose walls /scan sees, with --simulate, as map_server reads it, in "
      "place of the track's edges")
      ->needs(simulates);
  command.add_option("--drive-by", ros.drive_by, "Part of a drive message that the car follows")
      ->check(CLI::IsMember({"speed", "acceleration"}))
      ->capture_default_str();
  add_shown(command, "--speed-lead-s", ros.speed_lead, "X",
            "Time in which the car's speed controller closes a gap, with --drive-by speed [s]")
      ->check(CLI::Range(0.02, 5.0));
  for (const auto& [name, to] :
       {std::pair{"--odom-qos", &ros.odom_qos}, std::pair{"--drive-qos", &ros.drive_qos}}) {
    command.add_option(name, *to, "Reliability of the controller's end of this topic")
        ->check(CLI::IsMember({"best-effort", "reliable"}))
        ->capture_default_str();
  }
}

}  // namespace

void add_drive(CLI::App& command, Options& options) {
  add(command, "scenario", options.scenario_file, "SCENARIO",
      "Scenario by name or file (chicane list scenarios); other options win over it");
  add_controller(command, options);
  add_world(command, options);
  add_latency(command, options);
  CLI::Option* const fast =
      command.add_flag("--fast", options.is_fast, "Run as fast as possible, deterministic, without sockets");
  CLI::Option* const limit =
      command.add_flag("--limit", options.wants_limit, "Find the limit first, for the gap of each lap to it")
          ->needs(fast);
  command
      .add_flag(
          "--explain", options.wants_causes,
          "Drive again without latency, edge margin, grip reserve, sensor errors and guard, one at a time: "
          "what each takes of the gap, corner by corner")
      ->needs(limit);
  add_port(command, options);
  add(command, "--pace", options.pace, "X",
      "Seconds of the run in a second of the clock; viewers can change it")
      ->check(CLI::Range(run::kSlowestPace, run::kFastestPace))
      ->excludes("--fast");
  add(command, "--step-budget-ms", options.step_budget_ms, "X",
      "Bound of a control step by the clock; 0 = none, default 80 % of the control period")
      ->check(CLI::Range(0.0, 1000.0))
      ->excludes("--fast");
  command
      .add_flag("--manual", options.is_manual, "Drive by hand, by the dashboard's arrow keys or \"manual.…\"")
      ->excludes("--fast");
  add_faults(command, options);
  add_record(command, options);
  add_json(command, options);
  add_set(command, options);
  command.footer("Example: chicane drive --preset sixty-mph --track lakeside --laps 2 --fast");
}

void add_serve(CLI::App& command, Options& options) {
  add_controller(command, options);
  add_setting(command, options, "--latency-ms", "latency_ms", "X",
              "Sleep before each answer [ms], default 100 as the original");
  add_setting(
      command, options, "--track", "track", "NAME|FILE",
      "Road of the simulator: judges tyres, tells the gap to the limit. For the original game its course's "
      "lake_track_waypoints.csv; lap times need none");
  add(command, "--lock-step-ms", options.lock_step_ms, "X",
      "Time that the simulator advances with each answer; else the measurements show its clock")
      ->check(CLI::Range(1.0, 1000.0));
  add_port(command, options);
  add_record(command, options);
  command.add_flag("--json", options.is_json,
                   "Print one JSON object on stdout at the end, all else on stderr");
  add_set(command, options);
  command.footer("Example: chicane serve --preset weighted --port 4567");
}

void add_simulate(CLI::App& command, Options& options) {
  add_shown(command, "--connect", options.connect, "URL", "Address of the controller");
  add(command, "--server", options.server, "CMD",
      "Start the controller with this command, and again when it dies");
  add_setting(command, options, "--car", "car", "NAME|FILE", "Simulated car (chicane list cars)");
  add_world(command, options);
  add_record(command, options);
  add_json(command, options);
  add_set(command, options);
  command.footer("Example: chicane simulate --connect ws://127.0.0.1:4567 --track lakeside --laps 2");
}

void add_ros(CLI::App& command, Options& options) {
  add_controller(command, options);
  add_world(command, options);
  add_setting(command, options, "--latency-ms", "latency_ms", "X",
              "Time from a command's arrival to its effect at the car [ms], default the car's");
  add_ros_network(command, options);
  add_port(command, options);
  add_record(command, options);
  command.add_flag("--json", options.is_json,
                   "Print one JSON object on stdout at the end, all else on stderr");
  add_set(command, options);
  command.footer("Example: chicane ros --car f1tenth --track oval --domain 7");
}

void add_replay(CLI::App& command, Options& options) {
  add_logs(
      command, options,
      "Recordings by --record, and bags and tables of other programs; several are shown beside each other");
  command.add_flag(
      "--verify", options.wants_verification,
      "Compute every recorded command again and compare it bit for bit; exit code 1 if one differs");
  add(command, "--branch-at", options.branch_at, "T",
      "Drive on otherwise from this second of the recording, and compare the two futures")
      ->check(CLI::NonNegativeNumber)
      ->excludes("--verify");
  add_set(command, options);
  command.get_option("--set")->needs("--branch-at");
  add_foreign(command, options);
  for (const char* name : {"--track", "--car"}) command.get_option(name)->excludes("--branch-at");
  add(command, "--for-s", options.for_s, "S", "Length of the branch [s]; else to the end of the recording")
      ->check(CLI::PositiveNumber)
      ->needs("--branch-at");
  add(command, "--laps", options.branch_laps, "N", "End the branch when the run has so many laps")
      ->check(CLI::PositiveNumber)
      ->needs("--branch-at");
  add(command, "-o,--output", options.output_file, "FILE", "Keep the branch in a new MCAP file")
      ->needs("--branch-at");
  add_port(command, options);
  add_negation(command, "--no-serve", options.is_served, "Show nothing in a browser");
  command.add_flag("--json", options.is_json,
                   "Print one JSON object on stdout, all else on stderr; shows nothing");
  command.footer("Example: chicane replay run.mcap --branch-at 12 --set plant_options.friction_scale=0.5");
}

void add_report(CLI::App& command, Options& options) {
  add_logs(command, options,
           "Recordings by --record, bags and tables of other programs, or the results of a sweep (.jsonl)");
  add(command, "-o,--output", options.output_file, "FILE.html", "Page to write; an older one is replaced");
  add(command, "--page", options.maps_page, "FILE.md",
      "Write the heat maps of a sweep in letters into this page");
  add(command, "--compare", options.comparison, "KEY=VALUE",
      "Print a table: runs of a sweep beside those with this value of an axis; exit code 1 where "
      "one is worse")
      ->excludes("--output")
      ->excludes("--page");
  add_foreign(command, options);
  command.footer("Example: chicane report run.mcap -o run.html");
}

void add_identify(CLI::App& command, Options& options) {
  add_logs(command, options,
           "Recordings, bags (.mcap, .db3) and CSV files of one car; several count together");
  add_setting(command, options, "--car", "car", "NAME|FILE",
              "Car to begin with: mass, width, tyre shape and limits are not in a log");
  add(command, "-o,--output", options.output_file, "CAR.yaml",
      "Write the car into this file; an older one is replaced");
  add(command, "--report", options.report_file, "FILE.html",
      "Write intervals, predictions and residuals as one HTML page; replaces an older one");
  add_shown(command, "--hold-out", options.identify.hold_out, "X",
            "Share of each log, at its end, that only tests the predictions")
      ->check(CLI::Range(0.0, 0.8));
  add(command, "--columns", options.identify.columns, "MEANING=NAME,...",
      "Columns of a CSV file with other names: steer=cmd_delta_rad,psi=yaw_deg; without a header: 0=time,1=x")
      ->delimiter(',');
  add_shown(command, "--budget-s", options.identify.budget_s, "X", "End the search after so long [s]")
      ->check(CLI::Range(1.0, 86400.0));
  command.add_flag("--force", options.identify.is_forced,
                   "Write the car also where it does not predict its log");
  add(command, "--odom-topic", options.identify.odom_topic, "TOPIC", "Odometry of a bag that has several");
  add(command, "--drive-topic", options.identify.drive_topic, "TOPIC", "Commands of a bag that has several");
  add_json(command, options);
  add_set(command, options);
  command.footer("Example: chicane identify run.mcap --car road-car -o mine.yaml");
}

void add_check(CLI::App& command, Options& options) {
  add(command, "files", options.files, "FILE",
      fmt::format("Presets, scenarios, cars (.yaml) and tracks ({})", joined(protocol::track_extensions())));
  add_controller(command, options);
  add_world(command, options);
  add_latency(command, options);
  add_faults(command, options);
  add_set(command, options);
  command.footer("Example: chicane check data/presets/weighted.yaml data/tracks/lakeside.csv --car road-car");
}

}  // namespace chicane::apps
