// SPDX-License-Identifier: MIT
// `chicane replay`: shows recordings in a browser, computes one again (--verify), or branches one with other
// settings (--branch-at).
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "chicane/live/pages.hpp"
#include "chicane/live/what_if.hpp"
#include "chicane/protocol/json.hpp"
#include "chicane/protocol/schema_json.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/recording/shadow_run.hpp"
#include "chicane/wire/endpoint.hpp"
#include "chicane/wire/viewer.hpp"
#include "commands.hpp"
#include "program.hpp"
#include "progress.hpp"

namespace chicane::apps {
namespace {

using protocol::Json;

// Results as JSON, whose keys are a contract (docs/viewer.md#recordings), and as text.

/// Number of a control cycle; null if there is none.
Json cycle(const std::optional<std::uint64_t>& number) { return number ? Json(*number) : Json(nullptr); }
/// Number; null if it is not known.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// JSON as printed.
std::string dump(const Json& object) {
  return protocol::json_text(object, protocol::JsonLayout::kIndented) + "\n";
}

/// JSON of the recorded run, or of its branch.
Json json_of(const recording::Future& future) {
  return {{"duration_s", number(future.duration)},
          {"lap_times_s", future.lap_times},
          {"max_abs_lateral_error_m", number(future.max_lateral_error)},
          {"min_edge_distance_m", number(future.min_edge_distance)},
          {"mean_speed_mps", number(future.mean_speed)},
          {"top_speed_mps", number(future.top_speed)},
          {"off_track_events", future.off_track_events}};
}

/// Number in twelve characters: "0.50", or a dash for one that is not known.
std::string number_cell(double value) {
  return std::isfinite(value) ? fmt::format("{:12.2f}", value) : fmt::format("{:>12}", "-");
}

/// Result of --verify as JSON.
std::string to_json(const recording::ReplayReport& report) {
  return dump({{"recorded_by", report.recorded_by},
               {"controller", report.controller},
               {"track", report.track},
               {"verified", report.is_verified()},
               {"steps", report.steps},
               {"identical", report.identical},
               {"different", report.different},
               {"unknown", report.unknown},
               {"first_difference", cycle(report.first_difference)},
               {"late", report.late},
               {"damaged", report.damaged},
               {"closed", report.is_complete}});
}

/// Result of --verify as text.
std::string to_text(const recording::ReplayReport& report) {
  const double share =
      report.steps == 0 ? 0.0
                        : 100.0 * static_cast<double>(report.identical) / static_cast<double>(report.steps);
  // Only a verified recording shows 100: less is not rounded up to it.
  const std::string percent = report.is_verified() ? "100" : fmt::format("{:.3f}", std::min(share, 99.999));
  std::string text =
      fmt::format("{} on {}, recorded by {}:\n{} of {} commands came out identical, bit for bit ({} %)\n",
                  report.controller, report.track.empty() ? "an external simulator's track" : report.track,
                  report.recorded_by, report.identical, report.steps, percent);
  if (report.first_difference)
    text +=
        fmt::format("first difference: cycle {} ({} in all)\n", *report.first_difference, report.different);
  if (report.unknown > 0) text += fmt::format("behind missing steps, not comparable: {}\n", report.unknown);
  if (report.late > 0) text += fmt::format("of which the deadline was spent: {}\n", report.late);
  if (report.damaged > 0) text += fmt::format("damaged parts left out: {}\n", report.damaged);
  if (!report.is_complete) text += "the recording was not closed: its end is missing\n";
  return text;
}

/// Result of --branch-at as JSON.
std::string to_json(const recording::BranchReport& report) {
  return dump({{"branch_at_s", report.at},
               {"cycle", report.cycle},
               {"steps_before", report.steps_before},
               {"first_difference", cycle(report.first_difference)},
               {"end_reason", report.end_reason.empty() ? Json(nullptr) : Json(report.end_reason)},
               {"recorded", json_of(report.recorded)},
               {"branch", json_of(report.branched)}});
}

/// Result of --branch-at as text: a table of the recorded run beside its branch. `settings`: changes of the
/// branch.
std::string to_text(const recording::BranchReport& report,
                    const std::vector<std::pair<std::string, std::string>>& settings) {
  std::string changes;
  for (const auto& [key, value] : settings)
    changes += fmt::format("{}{} = {}", changes.empty() ? "" : ", ", key, value);
  std::string text = fmt::format("from {:.2f} s on: {}\n\n{:24}{:>12}{:>12}\n", report.at,
                                 changes.empty() ? "nothing changed" : changes, "", "recorded", "branch");
  const auto row = [&](std::string_view name, double recorded, double branched) {
    text += fmt::format("{:24}{}{}\n", name, number_cell(recorded), number_cell(branched));
  };
  const recording::Future &recorded = report.recorded, &branched = report.branched;
  row("duration [s]", recorded.duration, branched.duration);
  for (std::size_t i = 0; i < std::max(recorded.lap_times.size(), branched.lap_times.size()); ++i) {
    const auto lap = [&](const recording::Future& future) {
      return i < future.lap_times.size() ? future.lap_times[i] : std::nan("");
    };
    row(fmt::format("lap time {} [s]", i + 1), lap(recorded), lap(branched));
  }
  row("max |lateral error| [m]", recorded.max_lateral_error, branched.max_lateral_error);
  row("min edge distance [m]", recorded.min_edge_distance, branched.min_edge_distance);
  row("mean speed [m/s]", recorded.mean_speed, branched.mean_speed);
  row("top speed [m/s]", recorded.top_speed, branched.top_speed);
  text += fmt::format("{:24}{:>12}{:>12}\n", "off the road, times", recorded.off_track_events,
                      branched.off_track_events);
  if (!report.end_reason.empty()) text += fmt::format("the branch ended: {}\n", report.end_reason);
  if (report.first_difference)
    text += fmt::format(
        "the recording did not come out the same from cycle {} on: the first column is what this program "
        "computes, not what was\n",
        *report.first_difference);
  return text;
}

/// Name of a recording on the page.
std::string name_of(const std::string& log) { return std::filesystem::path(log).filename().string(); }

/// Recordings of the page, each in a form that browsers read.
class ShownLogs {
 public:
  ShownLogs(const Options& options, LogConverter convert) : options_{options}, convert_{convert} {}

  /// Adds a recording or a log of another program; viewers see its name.
  Result<void> add(const std::string& file, std::string name) {
    const Result<std::string> mcap = as_mcap(file);
    if (!mcap) return fail(mcap.error());
    const Result<std::string> readable = readable_form(*mcap);
    if (!readable) return fail(readable.error());
    const auto scenario = recording::recorded_scenario(*readable);
    logs_.push_back({std::move(name), *readable,
                     scenario ? protocol::schema_json(*scenario, *scenario, &protocol::is_live, {}) : ""});
    return {};
  }
  /// All recordings.
  [[nodiscard]] const std::vector<live::ServedLog>& logs() const { return logs_; }
  /// Branches a recording. Messages have its name in place of the file.
  [[nodiscard]] Result<recording::BranchReport> branch(const live::WhatIfQuestion& question,
                                                       const recording::BranchHooks& hooks) const {
    if (question.log >= logs_.size())
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("what if: log: got {}, expected one of {}", question.log, logs_.size()));
    recording::BranchOptions options = question.options;
    options.log = logs_[question.log].file;
    auto report = recording::branch_recording(options, hooks);
    if (report) return report;
    std::string message = report.error().message;
    if (const auto file = message.find(options.log); file != std::string::npos)
      message.replace(file, options.log.size(), logs_[question.log].name);
    return fail(report.error().code, std::move(message));
  }

 private:
  /// File of a recording: itself, or a conversion of a log of another program.
  Result<std::string> as_mcap(const std::string& file) {
    if (convert_ == nullptr || !recording::is_foreign_log(file)) return file;
    const std::string& copy = copies_.emplace_back(".mcap").path();
    const Result<void> made = convert_(file, options_, copy);
    return made ? Result<std::string>(copy) : fail(made.error());
  }
  /// File that browsers read: itself, or a copy if the recording is compressed, damaged, or without an index.
  Result<std::string> readable_form(const std::string& file) {
    const Result<telemetry::McapReport> read = recording::check_recording(file);
    if (!read) return fail(read.error());
    if (read->damaged > 0) fmt::print(stderr, "{}: damaged parts left out: {}\n", file, read->damaged);
    if (read->is_complete && !read->is_compressed && read->damaged == 0)
      return std::filesystem::absolute(file).string();
    const std::string& copy = copies_.emplace_back(".mcap").path();
    const auto copied = recording::indexed_copy(file, copy);
    return copied ? Result<std::string>(copy) : fail(copied.error());
  }

  const Options& options_;
  LogConverter convert_;                        ///< null: no file is a log of another program
  std::list<recording::TemporaryFile> copies_;  ///< files that exist as long as the page
  std::vector<live::ServedLog> logs_;
};

/// Serves the page until the program is interrupted; `start`: time that the page shows first [s].
Result<void> show(const Options& options, const ShownLogs& shown, double start) {
  static std::atomic<bool> stop{false};  // static: must outlive the last signal
  catch_interrupts(stop);
  live::WhatIf what_if([&shown](const live::WhatIfQuestion& question, const recording::BranchHooks& hooks) {
    return shown.branch(question, hooks);
  });
  wire::ViewerServices services;
  services.what_if = [&what_if](std::string_view question) { return what_if.ask(question); };
  wire::ViewerEndpoint viewer({.run = {}, .services = std::move(services)});
  wire::Router router(nullptr, &viewer);
  const Result<net::ServerOptions> serving = server_options(options);
  if (!serving) return fail(serving.error());
  wire::Pages pages = live::replay_pages(shown.logs(), start);
  live::add_what_if(pages, what_if);
  const auto server =
      net::Server::create(*serving, router.handlers(std::move(pages)), live::embedded_assets());
  if (!server) return fail(server.error());
  print_sentence(stderr, fmt::format("recordings at {} (Ctrl-C ends)", link(*serving, (*server)->port())));
  while (!stop)  // polled, because a signal handler can notify nothing
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  return {};
}

/// Recorder of a branch while it is computed.
class BranchRecorder {
 public:
  explicit BranchRecorder(std::string file) : file_{std::move(file)} {}

  /// Hooks for recording::branch_recording(), valid as long as this.
  recording::BranchHooks hooks() {
    return {.on_begin = [this](const run::ClosedLoop& loop) { return begin(loop); },
            .on_change = [this](const telemetry::Change& change) { recorder_->record(change); },
            .on_frame = [this](const telemetry::Frame& frame) { recorder_->record(frame); },
            .on_lap = [this](const telemetry::CompletedLap& lap) { recorder_->record(lap); }};
  }
  /// Whether the file was begun.
  [[nodiscard]] bool has_file() const { return recorder_ != nullptr; }
  /// Closes the file.
  Result<void> finish() {
    if (recorder_ == nullptr) return {};
    const Result<recording::RecorderReport> report = recorder_->finish();
    return report ? Result<void>{} : fail(report.error());
  }

 private:
  /// Begins the file; in a run that changes, records the new run.
  Result<void> begin(const run::ClosedLoop& loop) {
    if (recorder_) {
      recorder_->record(std::make_unique<const recording::RecordedRun>(
          recording::RecordedRun{.run = live::description(loop), .scenario = loop.scenario()}));
      return {};
    }
    auto recorder = recording::Recorder::create(
        {.path = file_, .run = live::description(loop), .scenario = loop.scenario(), .may_wait = true});
    if (!recorder) return fail(recorder.error());
    recorder_ = std::move(*recorder);
    return {};
  }

  std::string file_;
  std::unique_ptr<recording::Recorder> recorder_;
};

/// Whether the command ends by serving a page.
bool has_page(const Options& options) { return options.is_served && !options.is_json; }

/// Shows the recording and its branch side by side.
Result<void> show_branch(const Options& options, const std::string& branch_file, double at) {
  const std::string& log = options.log_files.front();
  ShownLogs shown(options, nullptr);
  if (Result<void> added = shown.add(log, name_of(log)); !added) return added;
  if (Result<void> added = shown.add(branch_file, fmt::format("branch at {:.1f} s", at)); !added)
    return added;
  return show(options, shown, at);
}

/// Runs `chicane replay --branch-at`.
Result<ExitCode> branch(const Options& options) {
  const std::string& log = options.log_files.front();
  if (options.log_files.size() > 1)
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("logs: got {}, expected one to branch from", options.log_files.size()));
  const recording::TemporaryFile temporary(".mcap");
  const std::string& file = options.output_file.empty() ? temporary.path() : options.output_file;
  BranchRecorder recorder(file);
  const recording::BranchOptions branching{.log = log,
                                           .at = *options.branch_at,
                                           .settings = options.settings,
                                           .duration = options.for_s,
                                           .laps = options.branch_laps};
  const Result<recording::BranchReport> report = recording::branch_recording(branching, recorder.hooks());
  if (const Result<void> kept = recorder.finish(); report && !kept) return fail(kept.error());
  if (!report) {
    std::error_code error;
    if (recorder.has_file()) std::filesystem::remove(file, error);  // half a branch is of no use
    return fail(report.error());
  }
  fmt::print("{}", options.is_json ? to_json(*report) : to_text(*report, options.settings));
  std::fflush(stdout);
  if (has_page(options)) {
    if (Result<void> done = show_branch(options, file, report->at); !done) return fail(done.error());
  }
  return report->first_difference ? kRunFailed : kSuccess;
}

/// Runs `chicane replay --verify`.
Result<ExitCode> verify(const Options& options) {
  bool is_verified = true;
  for (const std::string& log : options.log_files) {
    const Result<recording::ReplayReport> result = recording::verify_recording(log);
    if (!result) return fail(result.error());
    fmt::print("{}", options.is_json ? to_json(*result) : to_text(*result));
    is_verified = is_verified && result->is_verified();
  }
  return is_verified ? kSuccess : kRunFailed;
}

/// Runs `chicane replay` without these options.
Result<ExitCode> show_logs(const Options& options, LogConverter convert) {
  if (!has_page(options))
    return fail(ErrorCode::kInvalidArgument, "replay: got nothing to do, expected --verify or --branch-at");
  ShownLogs shown(options, convert);
  for (const std::string& log : options.log_files)
    if (Result<void> added = shown.add(log, name_of(log)); !added) return fail(added.error());
  if (Result<void> done = show(options, shown, 0.0); !done) return fail(done.error());
  return kSuccess;
}

/// Whether the command shows logs of other programs, which chicane-lab reads.
bool shows_foreign_logs(const Options& options) {
  return !options.wants_verification && !options.branch_at &&
         std::any_of(options.log_files.begin(), options.log_files.end(), recording::is_foreign_log);
}

}  // namespace

ExitCode replay_logs(const Options& options, LogConverter convert) {
  const Result<ExitCode> done = options.wants_verification ? verify(options)
                                : options.branch_at        ? branch(options)
                                                           : show_logs(options, convert);
  return done ? *done : report(done.error());
}

ExitCode replay(const Options& options) {
  return shows_foreign_logs(options) ? in_lab(options) : replay_logs(options, nullptr);
}

}  // namespace chicane::apps
