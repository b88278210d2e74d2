// SPDX-License-Identifier: MIT
// The command line as plain data, so that no command depends on the parser; and the exit codes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace chicane::apps {

/// Exit codes of the program. Scripts depend on the numbers.
enum ExitCode : int {
  kSuccess = 0,
  kRunFailed = 1,    ///< the run left the road, or did not do all its laps
  kUsage = 2,        ///< wrong usage or a bad input file
  kEnvironment = 3,  ///< port in use, no permission, a part of the program that is missing
};

/// Values of all options; members begin with the commands that use them.
struct Options {
  std::string command;               ///< name of the command
  std::vector<std::string> words{};  ///< arguments after the command, as given

  std::string scenario_file;  ///< scenario by name or file; empty: none
  /// Key of the schema and text of each setting; later ones win.
  std::vector<std::pair<std::string, std::string>> settings;
  std::string speed_mps;  ///< reference speed of whichever controller drives; empty: its own
  std::string speed_mph;  ///< reference speed as typed in mph; empty: typed in m/s

  bool is_fast = false;        ///< drive: as fast as possible, without sockets
  bool is_json = false;        ///< all: results as JSON on stdout
  std::optional<double> pace;  ///< drive: seconds of the run in a second of the clock
  std::string sim_time;        ///< serve: field of telemetry with the simulator's time; empty: none
  double lock_step_ms = 0.0;   ///< serve: time that the simulator advances with each answer; 0: not fixed
  std::optional<double> step_budget_ms;        ///< drive: limit of a control step; 0: none
  bool is_manual = false;                      ///< drive: by hand
  std::string record_file;                     ///< file of the recording; empty: none
  bool is_compressed = false;                  ///< compresses the recording
  bool is_bag = false;                         ///< writes metadata.yaml next to the recording
  std::string report_file;                     ///< file of the report at the end; empty: none
  std::vector<std::string> faults{};           ///< drive: NAME@SECOND+SECONDS*STRENGTH
  std::string address = "127.0.0.1";           ///< address to listen on
  std::uint16_t port = 4567;                   ///< port to listen on
  bool needs_token = true;                     ///< changes need a token (docs/reference/security.md)
  std::vector<std::string> allowed_hosts{};    ///< names by which browsers may reach the port
  std::vector<std::string> allowed_origins{};  ///< other pages that may connect

  bool wants_limit = false;     ///< drive --fast: finds the limit, for the gap of each lap to it
  bool wants_causes = false;    ///< drive --fast --limit: finds the causes of the gaps
  std::string csv_file;         ///< limit, league, merge: CSV file to write; empty: none
  double limit_budget = 600.0;  ///< limit: work of the search [s]

  std::string connect =
      "ws://127.0.0.1:4567/socket.io/?EIO=4&transport=websocket";  ///< simulate: address of the controller
  std::string server;  ///< simulate: command that starts the controller; empty: none

  std::vector<std::string> files;      ///< check, merge: files to read
  std::vector<std::string> log_files;  ///< replay, report, video, identify: recordings and logs
  bool wants_verification = false;     ///< replay: computes the commands again, and nothing else
  std::optional<double> branch_at;     ///< replay: time in the recording at which a branch begins [s]
  double for_s = 0.0;                  ///< replay: length of the branch; 0: to the end of the recording
  int branch_laps = 0;                 ///< replay: laps after which the branch ends; 0: no limit
  std::string output_file;             ///< file of the main result; empty: none
  std::string maps_page;               ///< report: page of Markdown for the maps of a sweep; empty: none
  std::string comparison{};            ///< report: KEY=VALUE to compare runs with; empty: none
  bool is_served = true;               ///< replay: shows the recording in a browser
  std::string shelf;                   ///< list: shelf to show; empty: an overview
  bool is_markdown = false;            ///< list, campaign: tables as Markdown
  std::string shell;                   ///< completion: name of the shell
  std::vector<std::string> line{};     ///< completion: words before the cursor; empty: prints the script

  /// league, claims, campaign, recover, lane-change: file with a line for each run; empty: none.
  std::string results_file;
  int jobs = 0;  ///< commands of many runs: number of threads; 0: as many as cores

  /// ros: the node is the controller, or the simulator.
  struct Ros {
    bool is_simulator = false;
    int domain = 0;                    ///< DDS domain
    std::string interface = "lo";      ///< network interface; "auto": the best
    std::vector<std::string> peers{};  ///< addresses of partners without multicast
    std::string odom_topic = "/ego_racecar/odom", drive_topic = "/drive", imu_topic = "/imu";
    std::string autoware_topic{}, path_topic{};  ///< empty: none
    std::string map_frame = "map", base_frame = "ego_racecar/base_link", base_at = "rear-axle";
    bool is_time_simulated = false;  ///< counts time by /clock
    double pace = 0.0;       ///< seconds of the simulator in a second of the clock; 0: 1, without /clock
    std::string map_file{};  ///< map whose walls /scan sees; empty: the edges of the track
    std::string drive_by = "speed";  ///< part of a drive message that the car follows
    double speed_lead = 0.25;        ///< time in which the car closes a gap in speed [s]; chosen
    std::string odom_qos = "best-effort", drive_qos = "reliable";
  };
  Ros ros{};

  struct Identify {
    double hold_out = 0.3;                    ///< share of each log for the prediction errors
    std::vector<std::string> columns{};       ///< MEANING=NAME or POSITION=MEANING of a CSV file
    double budget_s = 120.0;                  ///< time of the search
    bool is_forced = false;                   ///< writes a car even if it does not predict its log
    std::string odom_topic{}, drive_topic{};  ///< topics of a bag; empty: the only ones
  };
  Identify identify{};

  struct Import {
    std::string file{}, preview{};                          ///< file to read, and page to write
    std::optional<double> width{}, smoothing{}, spacing{};  ///< [m]; none: by the file
    std::string direction{};                                ///< cw, ccw, reversed; empty: by the file
    std::vector<double> start{};                            ///< x and y [m]; empty: by the file
    double least_width = 0.4;                               ///< narrowest road in a map [m]
    std::string columns{};                    ///< names of the columns of a table without a header
    bool is_closed = false, is_open = false;  ///< both false: by the file
  };
  Import import_{};  // `import` is a keyword of C++20

  struct Sweep {
    std::string plan_file{};
    std::string shard{};            ///< I/N; empty: as the environment has it
    std::optional<double> shown{};  ///< number of the run whose command is printed; none: drives
  };
  Sweep sweep{};

  struct Tune {
    std::vector<std::string> over{};  ///< keys to tune; empty: weights, horizon and speed
    std::string objective = "lap", optimizer = "crs";
    int evaluations = 500;   ///< number of tunings to try
    std::uint64_t seed = 1;  ///< seed of the search
    std::string log{};       ///< file of all evaluations; empty: none
  };
  Tune tune{};

  struct Claims {
    std::vector<std::string> ids{};         ///< claims to try; empty: all
    std::string folder = "studies/claims";  ///< folder of the claims
    std::string page{};                     ///< page to write; empty: prints details on stdout
    bool is_check = false;                  ///< compares with the page, and does not write it
  };
  Claims claims{};

  struct League {
    std::string file{};                  ///< file of the league
    std::string page{};                  ///< page of docs/, written below its marker; empty: none
    std::vector<std::string> servers{};  ///< commands of external programs beside those of the file
    bool wants_programs = true;          ///< starts external programs
    double patience = 15.0;              ///< longest wait for an answer of a program [s]; chosen
  };
  League league{};

  struct Video {
    std::string ghost{};    ///< recording whose car drives along; empty: none
    int lap = -1;           ///< number of the lap from 1; 0: the whole run; -1: the last whole lap
    double from = 0.0;      ///< begin of the film after the begin of the lap [s]
    double length = 0.0;    ///< length of the film in time of the run [s]; 0: to the end
    double rate = 30.0;     ///< pictures in a second
    double speed = 1.0;     ///< seconds of the run in a second of the film
    int width = 1280;       ///< width of the picture [px]
    int quality = 0;        ///< quality of .webp; 0: the encoder's default
    bool is_whole = false;  ///< shows the whole road all the time
  };
  Video video{};

  struct Campaign {
    std::vector<std::string> faults{};  ///< names; empty: all, with pairs those of signals and computer
    bool has_pairs = false;             ///< adds each pair of faults at once
    std::vector<double> durations{};    ///< [s]; empty: each fault's own
    std::vector<std::string> tracks{"lakeside", "oval", "hairpins", "speedway"};
    std::vector<std::string> cars{"udacity", "road-car"};
    std::vector<std::string> presets{"default"};
    double step = 0.5;       ///< time between two onsets [s]
    int onsets = 0;          ///< number of random onsets of each group; 0: one each step
    std::uint64_t seed = 1;  ///< seed of the random onsets
  };
  Campaign campaign{};

  struct Recover {
    int starts = 120;        ///< number of starts for each car and track
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

  bool uses_cache = true;  ///< keeps plans and limits on disk

  int instances = 100;                    ///< bench: number of problems of each family
  std::vector<int> horizons{10, 20, 50};  ///< bench: numbers of intervals
};

/// Result of a command line that only prints text.
struct Done {
  ExitCode code = kSuccess;
};

/// Reads a command line; `words`: arguments of main. Prints help on stdout, and mistakes on stderr.
[[nodiscard]] std::variant<Options, Done> parse_command_line(int count, const char* const* words);

}  // namespace chicane::apps
