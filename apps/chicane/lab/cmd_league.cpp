// SPDX-License-Identifier: MIT
// `chicane league`: compares our controllers and programs of others on the same tracks, in the same cars.
// Ours are driven as a sweep, others in real time over their own protocol; the results become a page, CSV,
// Markdown and JSON.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "chicane/base/file.hpp"
#include "chicane/base/result.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/recording/html_report.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/sweep/league.hpp"
#include "chicane/sweep/sweep.hpp"
#include "chicane/sweep/trial.hpp"
#include "chicane/telemetry/metrics.hpp"
#include "chicane/wire/simulate.hpp"
#include "commands.hpp"
#include "lab/many_runs.hpp"
#include "program.hpp"

namespace chicane::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using sweep::ExternalTrial;
using sweep::League;

constexpr std::chrono::milliseconds kPollPeriod{100};  // between two looks at the simulator's output; chosen
// First DDS domain of ROS 2 programs, and number of domains, chosen by process number. DDS has 0 to 232;
// people use the low ones.
constexpr int kRosDomain = 110, kRosDomains = 80;

/// Last line of the output of a program.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of("\r\n");
  if (end == std::string::npos) return "it has said nothing";
  const std::size_t begin = text.find_last_of("\r\n", end);
  return text.substr(begin == std::string::npos ? 0 : begin + 1,
                     end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

/// Drives a car by a ROS 2 controller in real time: shells start `chicane ros --simulate` and the program of
/// the controller, both in the DDS domain `domain`. `own`: this program as a word of a shell. kIo if no
/// command arrives within `patience` [s], or if the simulator ends without a result.
Result<telemetry::RunSummary> drive_ros_program(const ExternalTrial& trial, int domain,
                                                const std::string& own, double patience,
                                                const std::atomic<bool>& stop) {
  const recording::TemporaryFile out(".json"), err(".txt"), done(".done");
  std::string simulator = fmt::format("{} ros --simulate --json --domain {}", own, domain);
  for (const auto& [key, text] : trial.settings)
    simulator += fmt::format(" --set {}", sweep::shell_word(key + "=" + text));
  simulator += fmt::format(" > {} 2> {}; : > {}", sweep::shell_word(out.path()),
                           sweep::shell_word(err.path()), sweep::shell_word(done.path()));

  wire::SparseLog log({});
  wire::ServerProcess simulating(simulator, log);
  wire::ServerProcess driving(sweep::filled(trial, domain, own), log);
  const Clock::time_point began = Clock::now();
  simulating.keep_running(began);
  driving.keep_running(began);
  bool has_command = false;
  while (!stop) {
    std::this_thread::sleep_for(kPollPeriod);
    const std::string output = protocol::read_file(err.path()).value_or("");
    if (std::filesystem::exists(done.path())) {
      auto run = protocol::read_run(protocol::read_file(out.path()).value_or(""));
      return run ? std::move(run) : fail(ErrorCode::kIo, "the simulator has no result: " + last_line(output));
    }
    has_command = has_command || output.find("first command on") != std::string::npos;
    if (!has_command && std::chrono::duration<double>(Clock::now() - began).count() > patience)
      return fail(ErrorCode::kIo, fmt::format("the program sends no command in DDS domain {}", domain));
  }
  return fail(ErrorCode::kIo, "stopped");
}

/// The port `wanted` if it is free, or with 0 any free port of this machine; none if it is taken.
std::optional<int> free_port(int wanted) {
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(wanted));
  const int reuse = 1;  // a program that has just ended does not keep its port
  ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse);
  socklen_t size = sizeof address;
  auto* const plain = reinterpret_cast<sockaddr*>(&address);
  const bool is_free = ::bind(descriptor, plain, size) == 0 && ::listen(descriptor, 1) == 0 &&
                       ::getsockname(descriptor, plain, &size) == 0;
  ::close(descriptor);
  return is_free ? std::optional<int>(ntohs(address.sin_port)) : std::nullopt;
}

/// Replacement of {chicane} in commands: this program, as a word of the shell.
std::string driving_program() {
  const std::string program = other_program("chicane", false);
  return program.empty() ? "chicane" : sweep::shell_word(program);
}

/// Starts a program, drives the car by it in real time, and ends it. Fails if it does not connect, or does
/// not answer for `patience` [s].
Result<telemetry::RunSummary> drive_program(const ExternalTrial& trial, double patience,
                                            const std::atomic<bool>& stop) {
  if (sweep::is_ros(trial))
    return drive_ros_program(trial, kRosDomain + static_cast<int>(::getpid()) % kRosDomains,
                             driving_program(), patience, stop);
  const bool has_port = trial.command.find("{port}") != std::string::npos;
  const std::optional<int> port = free_port(has_port ? 0 : sweep::kOriginalPort);
  if (!port)
    return fail(ErrorCode::kIo, fmt::format("port {} is taken by another program, and the command has no "
                                            "place {{port}}",
                                            sweep::kOriginalPort));
  const auto scenario = sweep::scenario_of(trial.settings);
  if (!scenario) return fail(scenario.error());
  wire::SimulateOptions options;
  options.url = fmt::format("ws://127.0.0.1:{}/socket.io/?EIO=4&transport=websocket", *port);
  options.server_command = sweep::filled(trial, *port, driving_program());
  options.lost_after = options.hopeless_after =
      std::chrono::milliseconds(static_cast<long long>(1e3 * patience));
  const auto done = wire::simulate(options, *scenario, {}, stop);
  if (!done)
    return fail(done.error().code,
                fmt::format("the program does not listen on port {}: {}", *port, done.error().message));
  if (done->answers == 0)
    return fail(ErrorCode::kIo,
                fmt::format("the program accepts the simulator, and gives {}",
                            done->run.end_reason.empty() ? "no usable answer" : done->run.end_reason));
  return done->run;
}

/// Drives a league in three steps: our controllers, limits of cars on tracks, other programs. Skips what is
/// in the files of results already.
class LeagueRun {
 public:
  LeagueRun(const Options& options, League league, std::string results, const std::atomic<bool>& stop)
      : options_{options}, league_{std::move(league)}, results_{std::move(results)}, stop_{stop} {
    beside_ = fs::path(results_).replace_extension(".beside.jsonl").string();
  }

  /// Drives what is missing. Ends early if it is stopped.
  Result<void> drive() {
    Result<sweep::BesideFile> beside = sweep::BesideFile::open(beside_, league_);
    if (!beside) return fail(beside.error());
    if (Result<void> done = drive_own(*beside); !done) return done;
    if (Result<void> done = find_bounds(*beside); !done) return done;
    return options_.league.wants_programs ? drive_programs(*beside) : Result<void>{};
  }

  /// Results of all files.
  [[nodiscard]] Result<sweep::LeagueResults> read() const {
    return sweep::read_results(league_, results_, beside_);
  }
  [[nodiscard]] const League& league() const { return league_; }

 private:
  /// Drives our controllers.
  Result<void> drive_own(sweep::BesideFile& beside) {
    RunCounter counter;
    std::optional<Error> failure;
    sweep::SweepOptions sweeping{
        .jobs = run::threads_for(options_.jobs), .file = results_, .on_progress = counter.follow()};
    sweeping.on_run = [&](std::uint64_t run, const telemetry::RunSummary& summary) {
      if (const Result<void> kept = beside.add_times(run, summary); !kept) failure = kept.error();
    };
    const auto done = sweep::drive_plan(league_.plan, {}, sweeping, stop_);
    counter.end();
    if (!done) return fail(done.error());
    if (failure) return fail(*failure);
    fmt::print(stderr, "{}: {} of {} runs, {} of them found\n", results_, done->found + done->driven,
               done->runs, done->found);
    return {};
  }

  /// Finds the limits of all cars on all tracks.
  Result<void> find_bounds(sweep::BesideFile& beside) {
    std::vector<std::pair<std::string, std::string>> wanted;
    for (const std::string& track : league_.tracks)
      for (const std::string& car : league_.cars)
        if (!beside.has_bound(track, car)) wanted.emplace_back(track, car);
    std::mutex mutex;
    std::optional<Error> failure;
    run::for_each_run(wanted.size(), run::threads_for(options_.jobs), [&](std::uint64_t i, run::Roads&) {
      const auto& [track, car] = wanted[i];
      sweep::Settings settings = league_.plan.fixed;
      settings.emplace_back("track", track);
      settings.emplace_back("car", car);
      const Result<double> bound = sweep::bound_of(settings, stop_);
      if (stop_) return false;
      const std::lock_guard lock(mutex);
      fmt::print(stderr, "the limit of {} on {}: {}\n", car, track,
                 bound ? fmt::format("{:.2f} s", *bound) : bound.error().message);
      if (const Result<void> kept = beside.add_bound(track, car, bound); !kept) failure = kept.error();
      return !failure;
    });
    return failure ? fail(*failure) : Result<void>{};
  }

  /// Drives the external trials.
  Result<void> drive_programs(sweep::BesideFile& beside) {
    for (const ExternalTrial& trial : league_.external_trials()) {
      if (stop_) return {};
      if (!trial.why_not.empty() || beside.has_trial(trial)) continue;
      fmt::print(stderr, "{} on {} in {}, {}, in real time: ", trial.entry, trial.track, trial.car,
                 trial.disturbance);
      const auto run = drive_program(trial, options_.league.patience, stop_);
      if (stop_) return {};
      fmt::print(
          stderr, "{}\n",
          run ? fmt::format("{} laps, {} times off the road", run->laps_completed, run->off_track_events)
              : run.error().message);
      if (const Result<void> kept = beside.add_trial(trial, run); !kept) return kept;
    }
    return {};
  }

  const Options& options_;
  const League league_;
  const std::string results_;  ///< file of the sweep's results
  const std::atomic<bool>& stop_;
  std::string beside_;  ///< file of sweep::BesideFile
};

constexpr std::string_view kLeagueMarker = "<!-- league: chicane league -->\n";  // the tables follow it

/// Writes the page, CSV, Markdown and JSON that the options ask for.
Result<void> write_pages(const Options& options, const League& league, const sweep::LeagueResults& results) {
  if (!options.output_file.empty()) {
    const auto done = recording::write_document(options.output_file, sweep::league_document(league, results),
                                                live::document_bundle());
    if (!done) return fail(done.error());
    fmt::print(stderr, "{}: open it in a browser\n", options.output_file);
  }
  const sweep::ResultTable runs = sweep::league_runs(league, results);
  if (!options.csv_file.empty()) {
    if (Result<void> done = write_file(options.csv_file, runs.csv()); !done) return done;
  }
  if (!options.league.page.empty()) {
    const std::string tables = "\n" + sweep::league_markdown(league, results);
    if (Result<void> done = write_below(options.league.page, kLeagueMarker, tables); !done) return done;
  }
  if (options.is_json) fmt::print("{}\n", protocol::json_text(runs.json(), protocol::JsonLayout::kIndented));
  return {};
}

}  // namespace

ExitCode compare_league(const Options& options) {
  const std::atomic<bool>& stop = begin_many_runs();
  Result<League> league = sweep::read_league(options.league.file);
  if (!league) return report(league.error());
  for (const std::string& file : {options.output_file, options.csv_file, options.league.page})
    if (const Result<void> writable = check_writable(file); !writable) return report(writable.error());
  for (const std::string& command : options.league.servers) sweep::add_external(*league, command);
  const std::string results = options.results_file.empty()
                                  ? fs::path(options.league.file).stem().string() + ".jsonl"
                                  : options.results_file;
  LeagueRun run(options, std::move(*league), results, stop);
  if (const Result<void> done = run.drive(); !done) return report(done.error());
  const auto read = run.read();
  if (!read) return report(read.error());
  if (const Result<void> written = write_pages(options, run.league(), *read); !written)
    return report(written.error());
  if (!stop) return kSuccess;
  fmt::print(stderr, "stopped: the same command goes on with what is missing\n");
  return kRunFailed;
}

}  // namespace chicane::apps
