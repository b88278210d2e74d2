// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/live/live_settings.hpp"
#include "chicane/live/run_publisher.hpp"
#include "chicane/live/worker_server.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/live_steps.hpp"
#include "chicane/run/realtime_loop.hpp"
#include "chicane/telemetry/metrics.hpp"
#include "chicane/wire/viewer.hpp"

namespace chicane::live {

/// A run with our simulator that is watched and changed like LiveRun, in one thread and without a network: a
/// browser's worker, which owns clock and page (apps/page). No control step has a deadline, so that a run
/// that nobody changes is that of `drive --fast`, bit for bit, whatever the pace. Drives on after its end.
///
/// Left out, beside what needs a network or files: the recording, other futures (WhatIf) and the limit.
class WorkerRun {
 public:
  /// Fails as ClosedLoop::create does. `send` is given each message for the page.
  [[nodiscard]] static Result<std::unique_ptr<WorkerRun>> create(const scenario::Scenario& scenario,
                                                                 WorkerServer::Send send);
  WorkerRun(const WorkerRun&) = delete;
  WorkerRun& operator=(const WorkerRun&) = delete;
  ~WorkerRun() = default;

  bool connect() { return server_->connect(); }
  void receive(std::string_view bytes, bool binary) { server_->receive(bytes, binary); }
  void acknowledge(std::size_t count) { server_->acknowledge(count); }
  /// What a GET of `path` gives: those of live_pages(), and /run.json: time, laps, and once the run is over
  /// its state_hash, and which arithmetic computed it.
  [[nodiscard]] std::optional<net::Content> get(std::string_view path) const { return server_->get(path); }

  /// Drives to where the run is when the clock shows `now` [s], as it is asked for by its pace, and sends
  /// what is new. `go_on` is asked after each control cycle; where it says no, the run is late and skips the
  /// time it has missed.
  void advance(double now, const std::function<bool()>& go_on);

  [[nodiscard]] const run::ClosedLoop& loop() const { return *loop_; }

 private:
  WorkerRun(std::unique_ptr<run::ClosedLoop> loop, WorkerServer::Send send);
  void begin_steps();
  void drive(double until, const std::function<bool()>& go_on);
  void drive_paused();
  void take_over();
  [[nodiscard]] std::string run_json() const;

  run::RunControls controls_;
  std::unique_ptr<run::ClosedLoop> loop_;
  std::optional<ChosenRun> request_;  ///< to be built
  std::unique_ptr<BuiltRun> built_;
  LiveSettings settings_;
  wire::ViewerEndpoint viewer_;
  wire::Router router_;
  RunPublisher publisher_;
  run::RunHooks hooks_;
  std::optional<run::LiveSteps> steps_;
  std::optional<telemetry::RunSummary> ended_;  ///< the run as it was when it was over
  /// Where the run was at a moment of the clock, and how fast it goes on from there.
  struct Anchor {
    double time = 0.0;   ///< [s]
    double clock = 0.0;  ///< [s]
    double pace = 1.0;
  };
  std::optional<Anchor> anchor_;
  std::unique_ptr<WorkerServer> server_;  ///< ends first: it calls all of the above
};

}  // namespace chicane::live
