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

/// What a process tells its caller. A contract: scripts depend on it.
enum ExitCode : int {
  kSuccess = 0,
  kRunFailed = 1,    ///< the run left the road, or did not do all its laps
  kUsage = 2,        ///< wrong usage or a bad input file
  kEnvironment = 3,  ///< port in use, no permission, chicane-bench not built
};

struct Options {
  std::string command;

  std::string scenario_file;  ///< empty: none
  std::vector<std::pair<std::string, std::string>>
      settings;           ///< schema key and text, in the order of precedence
  std::string speed_mps;  ///< reference of whichever controller drives; empty: its own

  bool is_fast = false;  ///< as fast as possible, no sockets
  bool is_json = false;
  std::optional<double> pace;            ///< drive: run seconds per second of the clock
  std::optional<double> step_budget_ms;  ///< drive: bound of a control step; 0 = none
  bool is_manual = false;                ///< drive: a person has the wheel
  std::string record_file;               ///< empty: nothing is recorded
  bool is_compressed = false;            ///< the recording
  std::string report_file;               ///< empty: no report is written at the end
  std::vector<std::string> faults{};     ///< drive: NAME@SECOND+SECONDS*STRENGTH
  std::string address = "127.0.0.1";
  std::uint16_t port = 4567;
  bool needs_token = true;                     ///< to change something (docs/security.md)
  std::vector<std::string> allowed_origins{};  ///< pages that may connect, beside our own

  bool wants_limit = false;       ///< drive --fast: the gaps of its laps to the limit
  std::string csv_file;           ///< limit: the racing line; empty: not kept
  std::optional<double> spacing;  ///< limit: of the places computed [m]

  std::string connect =
      "ws://127.0.0.1:4567/socket.io/?EIO=4&transport=websocket";  ///< simulate: the controller
  std::string server;                                              ///< simulate: command that starts it

  std::vector<std::string> files;      ///< check
  std::vector<std::string> log_files;  ///< replay, report
  bool wants_verification = false;     ///< replay: nothing else is done
  std::optional<double> branch_at;     ///< replay: on the recording's time line [s]
  double for_s = 0.0;                  ///< replay: length of the branch; 0: to the end of the recording
  int branch_laps = 0;                 ///< replay: of the run; 0: no matter
  std::string output_file;             ///< replay: the branch's recording; report: the page
  bool is_served = true;               ///< replay
  std::string shelf;                   ///< list; empty: an overview
  bool is_markdown = false;            ///< list parameters, list faults
  std::string shell;                   ///< completion

  struct Campaign {
    std::vector<std::string> faults{};  ///< names; empty: all
    std::vector<double> durations{};    ///< [s]; empty: each fault's own
    std::vector<std::string> tracks{"lakeside", "oval", "hairpins", "speedway"};
    std::vector<std::string> cars{"udacity", "road-car"};
    double step = 0.5;  ///< between onsets [s]
    int jobs = 0;       ///< threads; 0: as many as cores
  };
  Campaign campaign{};

  int instances = 100;                    ///< bench: of each family
  std::vector<int> horizons{10, 20, 50};  ///< bench
  std::string reference_folder;           ///< bench: problems with known optima; empty: none
};

/// Nothing is left to do: text was printed.
struct Done {
  ExitCode code = kSuccess;
};

/// Prints help to stdout, mistakes to stderr.
[[nodiscard]] std::variant<Options, Done> parse_command_line(int count, const char* const* words);

}  // namespace chicane::apps
