// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/plan_progress.hpp"
#include "chicane/net/server.hpp"
#include "chicane/run/racing.hpp"

namespace chicane::apps {

/// "planning the lap: 42 %, about 12 s left". `elapsed`: until now [s]; `budget`: of the work [s].
[[nodiscard]] std::string plan_line(const lap_time::PlanProgress& now, double elapsed, double budget);

/// Shows how a plan comes along: on stderr, and, where a dashboard is to follow, as a page at its address.
/// Both begin with the first iteration: a plan from the cache shows nothing.
class PlanWait {
 public:
  /// `server`: of the dashboard that follows; none: no page. Must outlive this.
  PlanWait(double budget, std::optional<net::ServerOptions>* server);
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

  double budget_;
  std::optional<net::ServerOptions>* server_;
  bool is_terminal_;
  bool has_line_ = false;
  Clock::time_point begin_ = Clock::now();
  std::optional<Clock::time_point> shown_{};
  std::unique_ptr<Page> page_;
  Result<void> opened_{};
};

}  // namespace chicane::apps
