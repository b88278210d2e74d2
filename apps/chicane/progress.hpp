// SPDX-License-Identifier: MIT
// Output of a run on stderr: progress and notices, the wait for a planned lap, the recording and the report.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/net/server.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/telemetry/frame.hpp"
#include "options.hpp"
#include "program.hpp"

namespace chicane::apps {

/// Notices for the operator about events of a run: the guard replaces the controller's commands, or the car
/// is stuck. They say why, what ends the event, and when it has ended. At most two lines for each second of
/// the run.
class RunNotices {
 public:
  /// Lines to print for a frame; mostly none.
  [[nodiscard]] std::vector<std::string> look_at(const telemetry::Frame& frame);

 private:
  /// Line about the end of the event at `time` [s]; empty while it may continue, and if there is none.
  [[nodiscard]] std::string ended(double time);

  double last_time_ = 0.0;  ///< time of the last frame [s]
  // Present event: it continues, or has ended less than telemetry::kAlarmPause ago.
  std::string said_;            ///< text of the last line about it; empty: there is no event
  double said_at_ = 0.0;        ///< time of that line [s]
  double began_ = 0.0;          ///< time of the first frame of the event [s]
  double ended_ = 0.0;          ///< time of the first frame after it [s]
  bool goes_on_ = false;        ///< the last frame belongs to it
  std::uint64_t replaced_ = 0;  ///< number of replaced commands
};

/// Completed lap in words: "lap 2: 26.19 s, 97.1 mph in the mean, clean".
[[nodiscard]] std::string line_of(const telemetry::CompletedLap& lap);

/// Progress of a run on stderr: on a terminal one line, rewritten ten times a second, otherwise a line every
/// ten seconds of the run. Notices are printed at once, as lines of their own.
class Progress {
 public:
  /// Takes in a frame, and prints what is due.
  void show(const telemetry::Frame& frame);
  /// Prints a line of its own. Any thread.
  void say(std::string_view line);

 private:
  StatusLine line_;
  double next_run_time_ = 10.0;  ///< time of the run at which the next line is due without a terminal [s]
  RunNotices notices_;
};

/// Progress of a plan in words: "planning the lap: 42 %, about 12 s left". `elapsed`: time so far [s];
/// `budget`: limit of the work [s].
[[nodiscard]] std::string plan_line(const lap_time::PlanProgress& now, double elapsed, double budget);

/// Progress of a plan on stderr and, if a dashboard follows, as a page at the address of the dashboard. Both
/// begin with the first iteration: a plan from the cache shows nothing.
class PlanWait {
 public:
  /// `server`: options of the dashboard that follows; none: no page. Both must outlive this.
  PlanWait(const scenario::Scenario& scenario, std::optional<net::ServerOptions>* server);
  /// Ends the line and the page, and stores the port of the page in `server`.
  ~PlanWait();
  PlanWait(const PlanWait&) = delete;
  PlanWait& operator=(const PlanWait&) = delete;

  /// Hooks for run::plan_lap(), valid as long as this.
  [[nodiscard]] run::PlanHooks hooks();
  /// Fails if the page could not be opened: the dashboard could not be either.
  [[nodiscard]] const Result<void>& opened() const noexcept { return opened_; }

 private:
  struct Page;
  /// Shows the progress on the line and the page.
  void show(const lap_time::PlanProgress& now);
  /// Opens the page, if a dashboard follows.
  void open();

  const scenario::Scenario& scenario_;
  std::optional<net::ServerOptions>* server_;
  StatusLine line_;
  bool has_begun_ = false;      ///< show() was called
  std::unique_ptr<Page> page_;  ///< null: no page
  Result<void> opened_{};       ///< error of opening the page
};

/// Checks that browsers open a file of this name. Fails with "OPTION: got x.txt, expected a name that ends in
/// .html". Accepts the empty name, which stands for no file, and devices.
[[nodiscard]] Result<void> check_page_name(std::string_view option, const std::string& file);

/// Recording and report of a run (--record, --report). Does nothing without either option.
class KeptRun {
 public:
  /// Begins the recording. `step_budget`: deadline of a control step in real time [s]; 0 with --fast, when
  /// the run waits for the disk. Fails as Recorder::create(); and if the report cannot be written at the end:
  /// kNotFound without a dashboard in this program, kIo without a folder.
  [[nodiscard]] static Result<std::unique_ptr<KeptRun>> start(const Options& options, protocol::Run run,
                                                              const scenario::Scenario& scenario,
                                                              double step_budget);

  /// Recorder; null without --record and --report.
  [[nodiscard]] recording::Recorder* recorder() const { return recorder_.get(); }
  /// Passes a frame, lap or change to Recorder::record.
  template <class What>
  void record(What&& what) {
    if (recorder_) recorder_->record(std::forward<What>(what));
  }
  /// Closes the recording, writes the report, and prints a summary on stderr.
  [[nodiscard]] Result<void> finish();

 private:
  explicit KeptRun(const Options& options)
      : record_file_{options.record_file}, report_file_{options.report_file}, is_bag_{options.is_bag} {}
  /// Writes the report of the closed recording.
  [[nodiscard]] Result<void> write_report() const;

  std::string record_file_;
  std::string report_file_;
  bool is_bag_;                                        ///< writes metadata.yaml next to the recording
  std::optional<recording::TemporaryFile> temporary_;  ///< recording for a report without --record
  std::unique_ptr<recording::Recorder> recorder_;
};

/// Options of the server by the command line: address, port and access, with a new token unless --no-token is
/// given.
[[nodiscard]] Result<net::ServerOptions> server_options(const Options& options);

/// Address of the dashboard for people: "http://localhost:4567/?token=...". The browser keeps the token as a
/// cookie.
[[nodiscard]] std::string link(const net::ServerOptions& server, std::uint16_t port);

}  // namespace chicane::apps
