// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// The command line as plain data, so that no command knows how it is parsed.
namespace chicane::apps {

/// Exit codes of the program. A contract: scripts depend on them.
enum ExitCode : int {
  kSuccess = 0,
  kRunFailed = 1,    ///< the run left the road, or did not do all its laps
  kUsage = 2,        ///< wrong usage or a bad input file
  kEnvironment = 3,  ///< port in use, no permission, a program of its own that is not there
};

struct Options {
  std::string command;
  std::vector<std::string> words{};  ///< arguments after the command, as given

  std::string scenario_file;  ///< empty: none
  std::vector<std::pair<std::string, std::string>>
      settings;           ///< schema key and text, in the order of precedence
  std::string speed_mps;  ///< reference of whichever controller drives; empty: its own
  std::string speed_mph;  ///< speed as typed in mph; empty: typed in m/s

  bool is_fast = false;  ///< drives as fast as possible, without sockets
  bool is_json = false;
  std::optional<double> pace;  ///< drive: run seconds per second of the clock
  std::string sim_time;        ///< serve: field of telemetry with the simulator's time; empty: none
  double lock_step_ms = 0.0;   ///< serve: time of the simulator with each answer; 0: the measurements show it
  std::optional<double> step_budget_ms;  ///< drive: bound of a control step; 0 = none
  bool is_manual = false;                ///< drive: a person has the wheel
  std::string record_file;               ///< empty: nothing is recorded
  bool is_compressed = false;            ///< the recording
  bool is_bag = false;                   ///< writes metadata.yaml next to the recording
  std::string report_file;               ///< empty: no report is written at the end
  std::vector<std::string> faults{};     ///< drive: NAME@SECOND+SECONDS*STRENGTH
  std::string address = "127.0.0.1";
  std::uint16_t port = 4567;
  bool needs_token = true;                     ///< changes need a token (docs/reference/security.md)
  std::vector<std::string> allowed_hosts{};    ///< names by which the port may be asked for
  std::vector<std::string> allowed_origins{};  ///< pages that may connect, beside our own

  bool wants_limit = false;     ///< drive --fast: the gaps of its laps to the limit
  bool wants_causes = false;    ///< drive --fast --limit: what each cause takes of these gaps
  std::string csv_file;         ///< limit: the racing line; empty: not kept
  double limit_budget = 600.0;  ///< limit: work of the search [s]

  std::string connect =
      "ws://127.0.0.1:4567/socket.io/?EIO=4&transport=websocket";  ///< simulate: the controller
  std::string server;                                              ///< simulate: command that starts it

  std::vector<std::string> files;      ///< check
  std::vector<std::string> log_files;  ///< replay, report
  bool wants_verification = false;     ///< replay: nothing else is done
  std::optional<double> branch_at;     ///< replay: on the recording's time line [s]
  double for_s = 0.0;                  ///< replay: length of the branch; 0: to the end of the recording
  int branch_laps = 0;                 ///< replay: laps of the run; 0: no limit
  std::string output_file;             ///< replay: the branch's recording; report: the page
  std::string maps_page;               ///< report: Markdown, for the maps of a sweep; empty: none
  std::string comparison{};            ///< report: KEY=VALUE of a sweep; empty: nothing is compared
  bool is_served = true;               ///< replay
  std::string shelf;                   ///< list; empty: an overview
  bool is_markdown = false;            ///< list parameters, list faults, campaign
  std::string shell;                   ///< completion
  std::vector<std::string> line{};     ///< completion: words before the cursor; empty: the script

  /// league, claims, campaign, recover, lane-change: a line for each run; empty: none
  std::string results_file;
  int jobs = 0;  ///< sweep, tune, claims, campaign: threads; 0: as many as cores

  /// A ROS 2 node: the controller, or the simulator.
  struct Ros {
    bool is_simulator = false;
    int domain = 0;
    std::string interface = "lo";
    std::vector<std::string> peers{};
    std::string odom_topic = "/ego_racecar/odom", drive_topic = "/drive", imu_topic = "/imu";
    std::string autoware_topic{}, path_topic{};  ///< empty: none
    std::string map_frame = "map", base_frame = "ego_racecar/base_link", base_at = "rear-axle";
    bool is_time_simulated = false;
    double pace = 0.0;       ///< seconds of the simulator in one of the clock; 0: one, without /clock
    std::string map_file{};  ///< map whose walls /scan sees; empty: the track's walls
    std::string drive_by = "speed";
    double speed_lead = 0.25;  ///< [s]
    std::string odom_qos = "best-effort", drive_qos = "reliable";
  };
  Ros ros{};

  struct Identify {
    double hold_out = 0.3;               ///< share of each log for the prediction errors
    std::vector<std::string> columns{};  ///< MEANING=NAME or POSITION=MEANING of a CSV file
    double budget_s = 120.0;             ///< budget of the search
    bool is_forced = false;              ///< writes a car that does not predict its log
    std::string odom_topic{}, drive_topic{};
  };
  Identify identify{};

  struct Import {
    std::string file{}, preview{};
    std::optional<double> width{}, smoothing{}, spacing{};  ///< [m]
    std::string direction{};                                ///< cw, ccw, reversed; empty: the file's
    std::vector<double> start{};                            ///< x and y [m]; empty: the file's
    double least_width = 0.4;                               ///< narrowest road in a map [m]
    std::string columns{};
    bool is_closed = false, is_open = false;
  };
  Import import_{};  // `import` is a keyword of C++20

  struct Sweep {
    std::string plan_file{};
    std::string shard{};            ///< I/N; empty: as the environment says
    std::optional<double> shown{};  ///< only the command of this run
  };
  Sweep sweep{};

  struct Tune {
    std::vector<std::string> over{};  ///< keys; empty: weights, horizon and speed
    std::string objective = "lap", optimizer = "crs";
    int evaluations = 500;
    std::uint64_t seed = 1;
    std::string log{};  ///< empty: none
  };
  Tune tune{};

  struct Claims {
    std::vector<std::string> ids{};  ///< empty: all
    std::string folder = "studies/claims";
    std::string page{};     ///< page to write; empty: details on stdout
    bool is_check = false;  ///< compare only
  };
  Claims claims{};

  struct League {
    std::string file{};
    std::string page{};                  ///< page of docs/, written below its marker; empty: none
    std::vector<std::string> servers{};  ///< commands of external programs, added to the file's
    bool wants_programs = true;          ///< false: no external ones are started
    double patience = 15.0;              ///< wait for a program that does not answer [s]
  };
  League league{};

  struct Video {
    std::string ghost{};  ///< another recording; empty: none
    int lap = -1;         ///< lap from 1; 0: the whole run; -1: the last whole lap
    double from = 0.0;    ///< time since the lap began [s]
    double length = 0.0;  ///< [s]; 0: to its end
    double rate = 30.0;   ///< pictures in a second
    double speed = 1.0;   ///< seconds of the run in one of the film
    int width = 1280;     ///< [px]
    int quality = 0;      ///< quality of .webp; 0: the encoder's default
    bool is_whole = false;
  };
  Video video{};

  struct Campaign {
    std::vector<std::string> faults{};  ///< names; empty: all, for pairs of signals and computer
    bool has_pairs = false;             ///< adds each pair of faults at once
    std::vector<double> durations{};    ///< [s]; empty: each fault's own
    std::vector<std::string> tracks{"lakeside", "oval", "hairpins", "speedway"};
    std::vector<std::string> cars{"udacity", "road-car"};
    std::vector<std::string> presets{"default"};
    double step = 0.5;       ///< time between onsets [s]
    int onsets = 0;          ///< random moments of each group; 0: one each step
    std::uint64_t seed = 1;  ///< seed of the random moments
  };
  Campaign campaign{};

  struct Recover {
    int starts = 120;        ///< starts for each car and track
    std::uint64_t seed = 1;  ///< seed of the starts
    int only = 0;            ///< number of the only start, from 1; 0: all
    std::vector<std::string> tracks{"lakeside", "oval", "hairpins", "speedway"};
    std::vector<std::string> cars{"udacity", "road-car"};
  };
  Recover recover{};

  struct LaneChange {
    std::vector<std::string> cars{"udacity", "road-car", "bmw-320i"};
    std::vector<std::string> presets{"race", "pure-pursuit", "stanley"};
  };
  LaneChange lane_change{};

  bool uses_cache = true;  ///< plans and limits are kept on disk

  int instances = 100;                    ///< bench: of each family
  std::vector<int> horizons{10, 20, 50};  ///< bench
};

/// Result of a command line that only prints text.
struct Done {
  ExitCode code = kSuccess;
};

/// Prints help to stdout, mistakes to stderr.
[[nodiscard]] std::variant<Options, Done> parse_command_line(int count, const char* const* words);

}  // namespace chicane::apps
