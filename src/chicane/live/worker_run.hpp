// SPDX-License-Identifier: MIT
// Live run inside a browser's worker: one thread, no network, messages instead of sockets.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/live/live_settings.hpp"
#include "chicane/live/run_publisher.hpp"
#include "chicane/net/server.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/run_steps.hpp"
#include "chicane/telemetry/metrics.hpp"
#include "chicane/wire/viewer.hpp"

namespace chicane::live {

/// Server without a network, for a run inside the page that shows it: one connection, whose messages go to a
/// function, and a clock that the owner moves. As a network server does, it keeps messages until the page
/// takes them, and of each topic of frames only the newest. One thread.
class WorkerServer final : public net::Server {
 public:
  using Send = std::function<void(std::string_view bytes, bool binary)>;
  static constexpr net::ConnectionId kPage = 1;  ///< the only connection
  static constexpr std::size_t kInFlight = 64;   ///< most messages sent and not acknowledged; chosen

  WorkerServer(net::ServerHandlers handlers, Send send);

  /// Connects the page, in place of its earlier connection. False if the endpoint refuses it.
  bool connect();
  /// Takes a message of the page.
  void receive(std::string_view bytes, bool binary);
  /// Takes the report of the page that it has read `count` further messages.
  void acknowledge(std::size_t count);
  [[nodiscard]] std::optional<net::Content> get(std::string_view path) const {
    return handlers_.on_get(path);
  }
  /// Moves the clock to `now` [s], which has any zero, and runs due tasks.
  void pass_time(double now);

  using net::Server::send;
  [[nodiscard]] std::uint16_t port() const noexcept override { return 0; }
  void send(net::ConnectionId to, net::Bytes bytes, bool binary, net::Delivery delivery,
            std::uint32_t topic) override;
  [[nodiscard]] std::size_t waiting(net::ConnectionId id) const override;
  void close(net::ConnectionId id, std::uint16_t code, std::string_view reason) override;
  void run_after(std::chrono::nanoseconds delay, std::function<void()> task) override;

 private:
  /// Message that waits for room at the page.
  struct Held {
    net::Bytes bytes;
    bool binary = false;
    net::Delivery delivery = net::Delivery::kReliable;
    std::uint32_t topic = 0;  ///< topic of kNewest messages
  };
  /// Sends waiting messages while the page has room.
  void flush();

  net::ServerHandlers handlers_;
  Send send_;
  bool is_open_ = false;                                ///< the page is connected
  int endpoint_ = 0;                                    ///< net::UpgradeAnswer::endpoint of the page
  std::deque<Held> held_;                               ///< waiting messages, the oldest first
  std::size_t in_flight_ = 0;                           ///< messages sent and not acknowledged
  double now_ = 0.0;                                    ///< time of the owner's clock [s]
  std::multimap<double, std::function<void()>> tasks_;  ///< tasks by due time [s]
};

/// Run with our simulator, watched and changed as LiveRun is, in one thread without a network: a browser's
/// worker owns clock and page (apps/page). Control steps have no deadline, so that an unchanged run has the
/// bits of `drive --fast` at any pace. The run continues after its end.
///
/// Recording, other futures (WhatIf), the limit, and everything else that needs a network or files is
/// missing.
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
  /// Answer to a GET of `path`: live_pages(), and /run.json with time, laps, and after the run its state_hash
  /// and the arithmetic that computed it.
  [[nodiscard]] std::optional<net::Content> get(std::string_view path) const { return server_->get(path); }

  /// Drives up to the run time that belongs to `now` [s] of the clock, and sends the news. `go_on` is asked
  /// after each control cycle; false ends the call, and the run skips the missed time.
  void advance(double now, const std::function<bool()>& go_on);

  [[nodiscard]] const run::ClosedLoop& loop() const { return *loop_; }

 private:
  WorkerRun(std::unique_ptr<run::ClosedLoop> loop, WorkerServer::Send send);
  /// Begins to step the current loop.
  void begin_steps();
  /// Drives up to the run time `until` [s].
  void drive(double until, const std::function<bool()>& go_on);
  /// Applies changes and does requested cycles of a paused run.
  void drive_paused();
  /// Takes over the run that the next change begins.
  void take_over();
  /// Text for GET /run.json.
  [[nodiscard]] std::string run_json() const;

  run::RunControls controls_;
  std::unique_ptr<run::ClosedLoop> loop_;
  std::optional<ChosenRun> request_;  ///< run to build
  std::unique_ptr<BuiltRun> built_;   ///< run to take over
  LiveSettings settings_;
  wire::ViewerEndpoint viewer_;
  wire::Router router_;
  RunPublisher publisher_;
  run::RunHooks hooks_;
  std::optional<run::LiveSteps> steps_;
  std::optional<telemetry::RunSummary> ended_;  ///< summary at the end of the run; none: not over yet
  /// Run time at a moment of the clock, and pace from there on.
  struct Anchor {
    double time = 0.0;   ///< [s]
    double clock = 0.0;  ///< [s]
    double pace = 1.0;
  };
  std::optional<Anchor> anchor_;          ///< none: the next advance() sets it
  std::unique_ptr<WorkerServer> server_;  ///< last member, destroyed first: it calls all of the above
};

}  // namespace chicane::live
