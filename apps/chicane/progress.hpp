// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/net/server.hpp"
#include "chicane/run/racing.hpp"
#include "chicane/telemetry/frame.hpp"

namespace chicane::apps {

/// Finds in the situations of a run what its operator has to know at once: that the controller's commands are
/// replaced or the car is stuck, why, what ends it, and that it has ended. At most two lines for each second
/// of the run.
class RunNotices {
 public:
  /// The lines that a frame gives rise to; mostly none.
  [[nodiscard]] std::vector<std::string> look_at(const telemetry::Frame& frame);

 private:
  [[nodiscard]] std::string ended(double time);

  double last_time_ = 0.0;
  // The event that goes on, or ended less than telemetry::kAlarmPause ago.
  std::string said_;            ///< printed last; empty: none
  double said_at_ = 0.0;        ///< [s]
  double began_ = 0.0;          ///< [s]
  double ended_ = 0.0;          ///< first step after it [s]
  bool goes_on_ = false;        ///< in the last step
  std::uint64_t replaced_ = 0;  ///< count of commands
};

/// A completed lap in words: "lap 2: 26.19 s, 97.1 mph in the mean, clean".
[[nodiscard]] std::string line_of(const telemetry::CompletedLap& lap);

/// Tells on stderr how a run goes: on a terminal one line that renews itself ten times a second, otherwise a
/// line every ten seconds of the run. Notices are lines of their own, at once.
class Progress {
 public:
  Progress();
  /// Leaves the cursor at the beginning of a line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const telemetry::Frame& frame);
  /// A line of its own. Any thread.
  void say(std::string_view line);

 private:
  using Clock = std::chrono::steady_clock;
  bool is_terminal_;
  std::atomic<bool> has_line_{false};  ///< the cursor stands behind a line that will renew itself
  Clock::time_point next_{};
  double next_run_time_ = 10.0;
  RunNotices notices_;
};

/// "planning the lap: 42 %, about 12 s left". `elapsed`: until now [s]; `budget`: of the work [s].
[[nodiscard]] std::string plan_line(const lap_time::PlanProgress& now, double elapsed, double budget);

/// Shows how a plan comes along: on stderr, and, where a dashboard is to follow, as a page at its address.
/// Both begin with the first iteration: a plan from the cache shows nothing.
class PlanWait {
 public:
  /// `server`: of the dashboard that follows; none: no page. Both must outlive this.
  PlanWait(const scenario::Scenario& scenario, std::optional<net::ServerOptions>* server);
  /// Ends line and page; the port of the page becomes that of `server`.
  ~PlanWait();
  PlanWait(const PlanWait&) = delete;
  PlanWait& operator=(const PlanWait&) = delete;

  /// For run::plan_lap(). Valid as long as this.
  [[nodiscard]] run::PlanHooks hooks();
  /// Why the page could not be opened: then the dashboard could not be either.
  [[nodiscard]] const Result<void>& opened() const noexcept { return opened_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Page;
  void show(const lap_time::PlanProgress& now);
  void open();
  void clear_line();

  const scenario::Scenario& scenario_;
  std::optional<net::ServerOptions>* server_;
  bool is_terminal_;
  bool has_line_ = false;
  Clock::time_point begin_ = Clock::now();
  std::optional<Clock::time_point> shown_{};
  std::unique_ptr<Page> page_;
  Result<void> opened_{};
};

}  // namespace chicane::apps
