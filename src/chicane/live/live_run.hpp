// SPDX-License-Identifier: MIT
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

struct LiveRunOptions {
  net::ServerOptions server{};  ///< server of the dashboard and other viewers
  std::vector<net::Asset>
      assets{};  ///< files of the dashboard: embedded_assets() in the program; none: no page
  std::optional<double>
      step_budget{};             ///< deadline of a control step [s]; 0: none; default: a share of the period
  bool stay_at_end = false;      ///< drive on after the last lap until asked to stop
  std::optional<double> pace{};  ///< run seconds per second of the clock
  bool is_manual = false;        ///< a person drives from the beginning
};

/// A run with our simulator, paced by the clock, which people watch and change meanwhile: the loop, its
/// viewers, recording, limit and settings, and the data that threads exchange.
///
/// Threads, and what each owns: the thread of run() the loop, the recorder's input and RunPublisher; the
/// network thread LiveSettings, the viewers and the runs that were built; a builder, a searcher of the limit
/// and the recorder's writer have one each, and so do RunLog, WhatIf and Rival. The network thread hands
/// changes to the loop through RunControls::settings and built runs through a queue under the one mutex here,
/// which is held for a pointer's move. A setting that cannot change during a run starts another one: built in
/// parallel, taken over between two cycles.
class LiveRun {
 public:
  /// Opens the port. `controls` belongs to the caller, who may stop the run, and outlives this. kIo if the
  /// port is taken, with the remedy; kInvalidArgument for a pace out of range.
  [[nodiscard]] static Result<std::unique_ptr<LiveRun>> create(const LiveRunOptions& options,
                                                               std::unique_ptr<run::ClosedLoop> loop,
                                                               run::RunControls& controls);
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;
  ~LiveRun();

  [[nodiscard]] std::uint16_t port() const { return server_->port(); }
  /// The run that begins, for a recording.
  [[nodiscard]] protocol::Run description() const;
  /// Deadline of each control step [s]; 0: none.
  [[nodiscard]] double step_budget() const;

  /// Drives until the end, or until RunControls::wants_stop. `recorder` may be null. The laps of the summary
  /// are compared with the limit, which is waited for where a lap needs it.
  [[nodiscard]] telemetry::RunSummary run(recording::Recorder* recorder, const LiveHooks& hooks);

 private:
  LiveRun(const LiveRunOptions& options, std::unique_ptr<run::ClosedLoop> loop, run::RunControls& controls);
  [[nodiscard]] Result<void> open();
  [[nodiscard]] telemetry::RunSummary drive();
  void say(std::string_view line);
  [[nodiscard]] bool take_over();
  [[nodiscard]] std::optional<Result<void>> built();

  LiveRunOptions options_;
  run::RunControls& controls_;
  std::unique_ptr<run::ClosedLoop> loop_;
  LiveSettings settings_;
  wire::ViewerEndpoint viewer_;
  wire::Router router_;
  std::optional<RunPublisher> publisher_;  ///< while run() drives
  recording::Recorder* recorder_ = nullptr;
  std::mutex mutex_;
  std::deque<std::unique_ptr<BuiltRun>> built_;  ///< one for each change that starts a new run
  run::NewestTask<ChosenRun, Result<std::unique_ptr<BuiltRun>>> builder_;  ///< the network thread's
  LiveHooks hooks_;
  RunLog log_{true};
  WhatIf what_if_;
  Rival rival_;
  RunLimit limit_;                       ///< destroyed before everything that it calls
  std::unique_ptr<net::Server> server_;  ///< ends first: it calls all of the above
};

}  // namespace chicane::live
