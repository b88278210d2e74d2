// SPDX-License-Identifier: MIT
#include "options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>
#include <utility>

#include "bench_options.hpp"
#include "campaign_options.hpp"
#include "chicane/base/angle.hpp"
#include "chicane/base/instruction_set.hpp"
#include "chicane/base/text.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/version.hpp"
#include "command_text.hpp"
#include "commands.hpp"
#include "import_options.hpp"
#include "limit_options.hpp"
#include "ros_options.hpp"
#include "setting_options.hpp"
#include "sweep_options.hpp"
#include "usage.hpp"
#include "video_options.hpp"

namespace chicane::apps {
namespace {

void add_speed(CLI::App& command, Options& options) {
  command.add_option("--speed-mps", options.speed_mps, "Speed reference of the controller [m/s]")
      ->type_name("X");
  command
      .add_option_function<double>(
          "--speed-mph", [&options](double mph) { options.speed_mps = fmt::format("{}", mph_to_mps(mph)); },
          "Speed reference of the controller [mph]")
      ->type_name("X")
      ->excludes("--speed-mps");
}

void add_controller(CLI::App& command, Options& options) {
  add_setting(command, options, "--preset", "preset", "NAME",
              "Controller and its settings (chicane list presets)");
  add_setting(command, options, "--controller", "controller", "NAME",
              "Controller in place of the preset's (chicane list controllers)");
  add_setting(command, options, "--car", "car", "NAME|FILE",
              "Car of the simulation and of the controller's model (chicane list cars)");
  add_speed(command, options);
}

void add_world(CLI::App& command, Options& options) {
  add_setting(command, options, "--track", "track", "NAME|FILE", "Track (chicane list tracks)");
  add_setting(command, options, "--laps", "laps", "N", "Laps to drive; 0 drives until stopped");
  add_setting(command, options, "--seed", "seed", "N", "Seed of everything random");
}

void add_latency(CLI::App& command, Options& options) {
  add_setting(command, options, "--latency-ms", "latency_ms", "X",
              "Actuation delay of the simulated car [ms], default 100");
}

void add_faults(CLI::App& command, Options& options) {
  command
      .add_option(
          "--fault", options.faults,
          "Fault at a second of the run, for so long, so strong (chicane list faults); may be repeated")
      ->type_name("NAME@S+S*X")
      ->take_all();
}

void add_port(CLI::App& command, Options& options) {
  command.add_option("--port", options.port, "Port of dashboard and simulator socket; 0 takes any free one")
      ->type_name("P")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command.add_option("--address", options.address, "Address to listen on; 0.0.0.0 lets other machines in")
      ->type_name("A")
      ->capture_default_str();
  command
      .add_option("--allow-host", options.allowed_hosts,
                  "Host name by which this program may be reached, as in containers; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command
      .add_option("--allow-origin", options.allowed_origins,
                  "Web page that may connect beside our own, like https://app.foxglove.dev; may be repeated")
      ->type_name("ORIGIN")
      ->allow_extra_args(false);
  add_negation(command, "--no-token", options.needs_token,
               "Let every program of this machine control, without the token of the printed link");
}

void add_record(CLI::App& command, Options& options) {
  command.add_option("--record", options.record_file, "Record every control step in a new MCAP file")
      ->type_name("FILE");
  command
      .add_flag("--compress", options.is_compressed,
                "Compress the recording by Zstandard: about half the size")
      ->needs("--record");
  command
      .add_flag("--bag", options.is_bag,
                "Write metadata.yaml beside the recording, which makes its folder a bag for ros2 bag")
      ->needs("--record");
  command
      .add_option("--report", options.report_file,
                  "Write the run as one HTML page at its end; replaces an older one")
      ->type_name("FILE.html");
}

void add_tune(CLI::App& command, Options& options) {
  add_controller(command, options);
  add_setting(command, options, "--track", "track", "NAME|FILE", "Track (chicane list tracks)");
  add_setting(command, options, "--latency-ms", "latency_ms", "X",
              "Actuation delay of the simulated car [ms]");
  add_search(command, options);
  add_set(command, options);
  command.footer("Example: chicane tune --preset weighted --evaluations 2000 -o tuned.yaml");
}

void add_drive(CLI::App& command, Options& options) {
  command
      .add_option("scenario", options.scenario_file,
                  "Scenario by name or file (chicane list scenarios); other options win over it")
      ->type_name("SCENARIO");
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
  command
      .add_option("--pace", options.pace,
                  "Seconds of the run in a second of the clock; viewers can change it")
      ->type_name("X")
      ->check(CLI::Range(run::kSlowestPace, run::kFastestPace))
      ->excludes("--fast");
  command
      .add_option("--step-budget-ms", options.step_budget_ms,
                  "Bound of a control step by the clock; 0 = none, default 80 % of the control period")
      ->type_name("X")
      ->check(CLI::Range(0.0, 1000.0))
      ->excludes("--fast");
  command
      .add_flag("--manual", options.is_manual, "Drive by hand, by the dashboard's arrow keys or \"manual.…\"")
      ->excludes("--fast");
  add_faults(command, options);
  add_record(command, options);
  command.add_flag("--json", options.is_json, "Print one JSON object on stdout, all else on stderr");
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
  add_port(command, options);
  add_record(command, options);
  command.add_flag("--json", options.is_json,
                   "Print one JSON object on stdout at the end, all else on stderr");
  add_set(command, options);
  command.footer("Example: chicane serve --preset weighted --port 4567");
}

void add_simulate(CLI::App& command, Options& options) {
  command.add_option("--connect", options.connect, "Address of the controller")
      ->type_name("URL")
      ->capture_default_str();
  command
      .add_option("--server", options.server,
                  "Start the controller with this command, and again when it dies")
      ->type_name("CMD");
  add_setting(command, options, "--car", "car", "NAME|FILE", "Simulated car (chicane list cars)");
  add_world(command, options);
  add_record(command, options);
  command.add_flag("--json", options.is_json, "Print one JSON object on stdout, all else on stderr");
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

void add_logs(CLI::App& command, Options& options, const std::string& help) {
  command.add_option("logs", options.log_files, help)->type_name("LOG")->required();
}

/// For logs of other programs.
void add_foreign(CLI::App& command, Options& options) {
  add_setting(command, options, "--track", "track", "NAME|FILE", "Road of a log of another program");
  add_setting(command, options, "--car", "car", "NAME|FILE", "Car of a log of another program");
  command.add_option("--odom-topic", options.identify.odom_topic, "Odometry of a bag that has several")
      ->type_name("TOPIC");
  command.add_option("--drive-topic", options.identify.drive_topic, "Commands of a bag that has several")
      ->type_name("TOPIC");
}

void add_replay(CLI::App& command, Options& options) {
  add_logs(
      command, options,
      "Recordings by --record, and bags and tables of other programs; several are shown beside each other");
  command.add_flag(
      "--verify", options.wants_verification,
      "Compute every recorded command again and compare it bit for bit; exit code 1 if one differs");
  command
      .add_option("--branch-at", options.branch_at,
                  "Drive on otherwise from this second of the recording, and compare the two futures")
      ->type_name("T")
      ->check(CLI::NonNegativeNumber)
      ->excludes("--verify");
  add_set(command, options);
  command.get_option("--set")->needs("--branch-at");
  add_foreign(command, options);
  for (const char* name : {"--track", "--car"}) command.get_option(name)->excludes("--branch-at");
  command.add_option("--for-s", options.for_s, "Length of the branch [s]; else to the end of the recording")
      ->type_name("S")
      ->check(CLI::PositiveNumber)
      ->needs("--branch-at");
  command.add_option("--laps", options.branch_laps, "End the branch when the run has so many laps")
      ->type_name("N")
      ->check(CLI::PositiveNumber)
      ->needs("--branch-at");
  command.add_option("-o,--output", options.output_file, "Keep the branch in a new MCAP file")
      ->type_name("FILE")
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
  command.add_option("-o,--output", options.output_file, "Page to write; an older one is replaced")
      ->type_name("FILE.html");
  command.add_option("--page", options.maps_page, "Write the heat maps of a sweep in letters into this page")
      ->type_name("FILE.md");
  command
      .add_option("--compare", options.comparison,
                  "Print a table: runs of a sweep beside those with this value of an axis; exit code 1 where "
                  "one is worse")
      ->type_name("KEY=VALUE")
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
  command
      .add_option("-o,--output", options.output_file,
                  "Write the car into this file; an older one is replaced")
      ->type_name("CAR.yaml");
  command
      .add_option("--report", options.report_file,
                  "Write intervals, predictions and residuals as one HTML page; replaces an older one")
      ->type_name("FILE.html");
  command
      .add_option("--hold-out", options.identify.hold_out,
                  "Share of each log, at its end, that only tests the predictions")
      ->type_name("X")
      ->check(CLI::Range(0.0, 0.8))
      ->capture_default_str();
  command
      .add_option("--columns", options.identify.columns,
                  "Columns of a CSV file with names of their own: steer=cmd_delta_rad,psi=yaw_deg")
      ->type_name("MEANING=NAME,...")
      ->delimiter(',');
  command.add_option("--odom-topic", options.identify.odom_topic, "Odometry of a bag that has several")
      ->type_name("TOPIC");
  command.add_option("--drive-topic", options.identify.drive_topic, "Commands of a bag that has several")
      ->type_name("TOPIC");
  command.add_flag("--json", options.is_json, "Print one JSON object on stdout, all else on stderr");
  add_set(command, options);
  command.footer("Example: chicane identify run.mcap --car road-car -o mine.yaml");
}

void add_check(CLI::App& command, Options& options) {
  command
      .add_option("files", options.files,
                  fmt::format("Presets, scenarios, cars (.yaml) and tracks ({})",
                              joined(protocol::track_extensions())))
      ->type_name("FILE");
  add_controller(command, options);
  add_world(command, options);
  add_latency(command, options);
  add_faults(command, options);
  add_set(command, options);
  command.footer("Example: chicane check data/presets/weighted.yaml data/tracks/lakeside.csv --car road-car");
}

void add_list(CLI::App& command, Options& options) {
  command
      .add_option("what", options.shelf,
                  fmt::format("{}; an overview when left out", fmt::join(list_names(), ", ")))
      ->type_name("WHAT")
      ->check(CLI::IsMember(list_names()));
  command.add_flag("--markdown", options.is_markdown,
                   "parameters and faults: as in docs/configuration.md and docs/faults.md");
  command.footer("Example: chicane list presets");
}

void add_completion(CLI::App& command, Options& options) {
  command.add_option("shell", options.shell, "Shell")
      ->type_name("SHELL")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command.footer("Example: source <(chicane completion bash)");
}

void add_manual(CLI::App& command, Options&) { command.footer("Example: chicane manual | man -l -"); }

/// The options of each command.
constexpr std::pair<std::string_view, void (*)(CLI::App&, Options&)> kOptionsOf[] = {
    {"drive", add_drive},       {"serve", add_serve},
    {"simulate", add_simulate}, {"ros", add_ros},
    {"limit", add_limit},       {"replay", add_replay},
    {"report", add_report},     {"video", add_video},
    {"sweep", add_sweep},       {"league", add_league},
    {"claims", add_claims},     {"tune", add_tune},
    {"merge", add_merge},       {"campaign", add_campaign},
    {"recover", add_recover},   {"lane-change", add_lane_change},
    {"import", add_import},     {"identify", add_identify},
    {"check", add_check},       {"list", add_list},
    {"bench", add_bench},       {"completion", add_completion},
    {"manual", add_manual},
};

/// Commands that plan laps or find limits.
constexpr std::string_view kPlanning[] = {"drive", "serve",  "ros",    "limit",    "replay",  "sweep",
                                          "tune",  "league", "claims", "campaign", "recover", "check"};

void add_commands(CLI::App& app, Options& options) {
  for (const Command& command : commands()) {
    CLI::App* const sub = app.add_subcommand(std::string(command.name), std::string(command.summary));
    sub->group(std::string(command.group));
    sub->footer("Example: chicane " + std::string(command.name));  // of a command without options
    for (const auto& [name, add] : kOptionsOf)
      if (name == command.name) add(*sub, options);
    if (std::find(std::begin(kPlanning), std::end(kPlanning), command.name) != std::end(kPlanning))
      add_negation(*sub, "--no-cache", options.uses_cache,
                   "Compute plans and limits anew, and keep none in the cache folder");
  }
}

/// "NAME|FILE:{a,b}", as the parser shows it: the value's name, and the words it takes.
void read_type(const CLI::Option& option, OptionText& text) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  text.value = type.substr(0, type.find(':'));
  for (std::size_t at = open; at != std::string::npos && at + 1 < type.size();) {
    const std::size_t end = type.find_first_of(",}", at + 1);
    text.choices.push_back(type.substr(at + 1, end - at - 1));
    at = end == std::string::npos || type[end] == '}' ? std::string::npos : end;
  }
}

OptionText text_of(const CLI::Option& option) {
  OptionText text;
  text.help = option.get_description();
  text.is_required = option.get_required();
  text.takes_several = option.get_items_expected_max() > 1;
  for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
  text.default_value = option.get_default_str();
  if (option.get_items_expected_max() > 0) read_type(option, text);
  return text;
}

Done explain(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  const CLI::App& at = chosen.empty() ? app : *chosen.front();
  if (error.get_exit_code() == 0) {  // help or version
    fmt::print("{}", error.get_name() == "CallForVersion" ? std::string(error.what()) + "\n" : app.help());
    return {kSuccess};
  }
  const std::string name = chosen.empty() ? "chicane" : fmt::format("chicane {}", at.get_name());
  fmt::print(stderr, "{}: {}\nSee `{} --help`.\n", name, usage_fault(at, error), name);
  return {kUsage};
}

/// Six lines for a newcomer, in place of all commands.
constexpr std::string_view kFirstSteps =
    "chicane drive                        drives a lap; open the link that it prints\n"
    "chicane drive --preset race --fast   races at once and prints the lap times\n"
    "chicane list                         presets, tracks, cars and scenarios to choose from\n"
    "chicane serve                        drives the car of another simulator, as Udacity's\n"
    "chicane COMMAND --help               options of a command, with an example\n"
    "chicane --help                       all commands\n";

/// The first word must be a command; empty when it is, or an option.
std::string command_fault(const char* const* words) {
  const std::string_view word = words[1];
  std::vector<std::string_view> names;
  for (const Command& command : commands()) names.push_back(command.name);
  if (word.starts_with("-") || std::find(names.begin(), names.end(), word) != names.end()) return "";
  const std::string_view best = protocol::nearest(word, names);
  return fmt::format("chicane: got the unknown command {}, expected one of {}{}", printable(word),
                     fmt::join(names, ", "), best.empty() ? "" : fmt::format(" (did you mean {}?)", best));
}

/// Its second line is there when this program cannot do what a package can.
std::string version_text() {
  const std::string left_out = instruction_sets_left_out();
  if (left_out.empty()) return "chicane " CHICANE_VERSION;
  return fmt::format("chicane {}\ninstruction sets: {} (not built in: {})", CHICANE_VERSION,
                     built_instruction_sets(), left_out);
}

}  // namespace

std::variant<Options, Done> parse_command_line(int count, const char* const* words) {
  Options options;
  CLI::App app("Drives a car round a track by model predictive control.", "chicane");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.footer("Example: chicane drive");
  add_commands(app, options);
  if (count < 2) {
    fmt::print(stderr, "{}", kFirstSteps);
    return Done{kUsage};
  }
  if (const std::string fault = command_fault(words); !fault.empty()) {
    fmt::print(stderr, "{}\nSee `chicane --help`.\n", fault);
    return Done{kUsage};
  }
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    return explain(app, error);
  }
  options.command = app.get_subcommands().front()->get_name();
  options.words.assign(words + 2, words + count);
  return options;
}

std::vector<CommandText> command_texts() {
  Options options;
  CLI::App app;
  add_commands(app, options);
  std::vector<CommandText> texts;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    CommandText text{command->get_name(), command->get_description(), {}, command->get_footer()};
    const std::string_view example = "Example: ";
    if (text.example.starts_with(example)) text.example.erase(0, example.size());
    for (const CLI::Option* option : command->get_options()) {
      if (option != command->get_help_ptr()) text.options.push_back(text_of(*option));
    }
    std::stable_partition(text.options.begin(), text.options.end(),
                          [](const OptionText& option) { return option.is_positional(); });
    texts.push_back(std::move(text));
  }
  return texts;
}

std::string shelf_of(const OptionText& option) {
  const std::string_view words = "chicane list ";
  const std::size_t at = option.help.find(words);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + words.size();
  return option.help.substr(begin,
                            option.help.find_first_not_of("abcdefghijklmnopqrstuvwxyz", begin) - begin);
}

}  // namespace chicane::apps
