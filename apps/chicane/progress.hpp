// SPDX-License-Identifier: MIT
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

/// Watches the situations of a run for what its operator must know at once: the controller's commands are
/// replaced or the car is stuck, why, what ends it, and that it has ended. Prints at most two lines for each
/// second of the run.
class RunNotices {
 public:
  /// Lines for a frame; mostly none.
  [[nodiscard]] std::vector<std::string> look_at(const telemetry::Frame& frame);

 private:
  [[nodiscard]] std::string ended(double time);

  double last_time_ = 0.0;
  // Event that continues, or ended less than telemetry::kAlarmPause ago.
  std::string said_;            ///< printed last; empty: none
  double said_at_ = 0.0;        ///< [s]
  double began_ = 0.0;          ///< [s]
  double ended_ = 0.0;          ///< first step after it [s]
  bool goes_on_ = false;        ///< the event continues in the last step
  std::uint64_t replaced_ = 0;  ///< count of commands
};

/// A completed lap in words: "lap 2: 26.19 s, 97.1 mph in the mean, clean".
[[nodiscard]] std::string line_of(const telemetry::CompletedLap& lap);

/// Reports a run's progress on stderr: on a terminal one line, rewritten ten times a second, otherwise a line
/// every ten seconds of the run. Notices are lines of their own, printed at once.
class Progress {
 public:
  void show(const telemetry::Frame& frame);
  /// Prints a line of its own. Any thread.
  void say(std::string_view line);

 private:
  StatusLine line_;
  double next_run_time_ = 10.0;
  RunNotices notices_;
};

/// Progress in words: "planning the lap: 42 %, about 12 s left". `elapsed`: time so far [s]; `budget`: limit
/// of the work [s].
[[nodiscard]] std::string plan_line(const lap_time::PlanProgress& now, double elapsed, double budget);

/// Shows the progress of a plan on stderr and, if a dashboard follows, as a page at its address. Both begin
/// with the first iteration: a plan from the cache shows nothing.
class PlanWait {
 public:
  /// `server`: options of the dashboard that follows; none: no page. Both must outlive this.
  PlanWait(const scenario::Scenario& scenario, std::optional<net::ServerOptions>* server);
  /// Ends the line and the page; copies the page's port to `server`.
  ~PlanWait();
  PlanWait(const PlanWait&) = delete;
  PlanWait& operator=(const PlanWait&) = delete;

  /// Hooks for run::plan_lap(), valid as long as this.
  [[nodiscard]] run::PlanHooks hooks();
  /// Fails if the page could not be opened: the dashboard could not be either.
  [[nodiscard]] const Result<void>& opened() const noexcept { return opened_; }

 private:
  struct Page;
  void show(const lap_time::PlanProgress& now);
  void open();

  const scenario::Scenario& scenario_;
  std::optional<net::ServerOptions>* server_;
  StatusLine line_;
  bool has_begun_ = false;
  std::unique_ptr<Page> page_;
  Result<void> opened_{};
};

/// Checks that browsers open a page of this name. Fails with "OPTION: got x.txt, expected a name that ends in
/// .html". Passes the empty name, which is no file, and devices.
[[nodiscard]] Result<void> check_page_name(std::string_view option, const std::string& file);

/// Recording and report of a run (--record, --report), made of every control step. Does nothing without
/// either option.
class KeptRun {
 public:
  /// `step_budget` [s]: deadline of a control step in real time; 0 with --fast, where the run waits for the
  /// disk. Fails as Recorder::create does. Fails also if the report cannot be written at the end: kNotFound
  /// without a dashboard in this program, kIo without a folder.
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
  /// Closes the recording, writes the report, and sums them up on stderr.
  [[nodiscard]] Result<void> finish();

 private:
  explicit KeptRun(const Options& options)
      : record_file_{options.record_file}, report_file_{options.report_file}, is_bag_{options.is_bag} {}
  [[nodiscard]] Result<void> write_report() const;

  std::string record_file_;
  std::string report_file_;
  bool is_bag_;                                        ///< writes metadata.yaml next to the recording
  std::optional<recording::TemporaryFile> temporary_;  ///< recording for a report without --record
  std::unique_ptr<recording::Recorder> recorder_;
};

/// Listening address and access rules from the command line, with a new token unless --no-token.
/// kInvalidArgument for --no-token on an address that other machines reach.
[[nodiscard]] Result<net::ServerOptions> server_options(const Options& options);

/// Address that a person opens: "http://localhost:4567/?token=...". The browser keeps the token as a cookie.
[[nodiscard]] std::string link(const net::ServerOptions& server, std::uint16_t port);

}  // namespace chicane::apps
