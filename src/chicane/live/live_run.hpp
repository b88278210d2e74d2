// SPDX-License-Identifier: MIT
// Live run with our simulator: paced by the clock, watched and changed by viewers over the network.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/live/live_settings.hpp"
#include "chicane/live/run_limit.hpp"
#include "chicane/live/run_log.hpp"
#include "chicane/live/run_publisher.hpp"
#include "chicane/live/what_if.hpp"
#include "chicane/net/server.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/run_steps.hpp"
#include "chicane/run/worker.hpp"
#include "chicane/telemetry/metrics.hpp"
#include "chicane/wire/endpoint.hpp"
#include "chicane/wire/viewer.hpp"

namespace chicane::live {

/// Options of a LiveRun.
struct LiveRunOptions {
  net::ServerOptions server{};  ///< server of the dashboard and other viewers
  /// Files of the dashboard: embedded_assets() in the program; none: no page.
  std::vector<net::Asset> assets{};
  /// Deadline of a control step [s]; 0: none; by default a share of the control period.
  std::optional<double> step_budget{};
  bool stay_at_end = false;      ///< drive on after the last lap until RunControls::wants_stop
  std::optional<double> pace{};  ///< run seconds per second of the clock; none: 1
  bool is_manual = false;        ///< a person drives from the beginning
};

/// Run with our simulator, paced by the clock, which people watch and change meanwhile: the loop, its
/// viewers, recording, limit and settings, and the data that threads exchange.
///
///     thread                 owns
///     of run()               the loop, the input of the recorder, RunPublisher
///     network                LiveSettings, the viewers
///     one each               builder of runs, search of the limit, RunLog, WhatIf, Rival, recorder's output
///
/// The network thread hands changes to the loop through RunControls::settings, and built runs through a queue
/// under a mutex that is held for the move of a pointer. A setting that cannot change during a run starts
/// another run: built beside the current one, taken over between two cycles.
class LiveRun {
 public:
  /// Opens the port. `controls` belongs to the caller, who may stop the run, and outlives this. kIo if the
  /// port is taken, with the remedy; kInvalidArgument for a pace out of range.
  [[nodiscard]] static Result<std::unique_ptr<LiveRun>> create(const LiveRunOptions& options,
                                                               std::unique_ptr<run::ClosedLoop> loop,
                                                               run::RunControls& controls);
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;
  ~LiveRun() = default;

  [[nodiscard]] std::uint16_t port() const { return server_->port(); }
  /// Description of the run that begins, for a recording.
  [[nodiscard]] protocol::Run description() const;
  /// Deadline of each control step [s]; 0: none.
  [[nodiscard]] double step_budget() const;

  /// Drives until the end, or until RunControls::wants_stop. `recorder` may be null. Compares the laps of the
  /// summary with the limit, and waits for the limit if a lap needs it.
  [[nodiscard]] telemetry::RunSummary run(recording::Recorder* recorder, const LiveHooks& hooks);

 private:
  LiveRun(const LiveRunOptions& options, std::unique_ptr<run::ClosedLoop> loop, run::RunControls& controls);
  /// Applies the options of the run, and opens the port.
  [[nodiscard]] Result<void> open();
  /// Drives this run and those that viewers begin, until the end.
  [[nodiscard]] telemetry::RunSummary drive();
  /// Hands a line for people to LiveHooks::say. Any thread.
  void say(std::string_view line);
  /// Takes over the run that the next change begins. False if there is none.
  [[nodiscard]] bool take_over();
  /// Hands a built run to the loop, on the network thread; its result, or none while nothing is built.
  [[nodiscard]] std::optional<Result<void>> built();

  LiveRunOptions options_;
  run::RunControls& controls_;
  std::unique_ptr<run::ClosedLoop> loop_;
  LiveSettings settings_;
  wire::ViewerEndpoint viewer_;
  wire::Router router_;
  std::optional<RunPublisher> publisher_;        ///< publisher; none before run()
  recording::Recorder* recorder_ = nullptr;      ///< recorder of run(); null: none
  std::mutex mutex_;                             ///< guards built_ and hooks_
  std::deque<std::unique_ptr<BuiltRun>> built_;  ///< runs to take over, one for each change that begins one
  run::NewestTask<ChosenRun, Result<std::unique_ptr<BuiltRun>>> builder_;  ///< used by the network thread
  LiveHooks hooks_;
  RunLog log_{true};  ///< memory of the run, with checkpoints
  WhatIf what_if_;
  Rival rival_;
  RunLimit limit_;                       ///< destroyed before everything that it calls
  std::unique_ptr<net::Server> server_;  ///< last member, destroyed first: it calls all of the above
};

}  // namespace chicane::live
