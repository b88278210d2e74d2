// SPDX-License-Identifier: MIT
// `chicane serve`: the session with one simulator on the network thread, and the control thread that answers
// its telemetry.
#include "chicane/wire/serve.hpp"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "chicane/base/duration.hpp"
#include "chicane/protocol/schema.hpp"

namespace chicane::wire {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int kMaxUnanswered = 16;  // telemetry without an answer; chosen: a client in lock-step has one
constexpr std::size_t kMaxAccepted = 16;     // upgrades in progress; chosen
constexpr double kTypicalTurnAround = 0.02;  // [s] time of the original simulator from answer to telemetry
constexpr milliseconds kWatchPeriod{250};    // period of looking for silence; chosen
constexpr std::chrono::seconds kPingInterval{25};  // Engine.IO's default
constexpr const char* kOpenPacket =
    R"(0{"sid":"chicane","upgrades":[],"pingInterval":25000,"pingTimeout":60000,"maxPayload":65536})";

/// Message of a simulator that needs an answer.
struct Request {
  enum class Kind : signed char { kTelemetry, kManual, kUnusable };
  Kind kind = Kind::kTelemetry;
  net::ConnectionId from = 0;
  Clock::time_point received{};      ///< time of its arrival
  model::Measurement measurement{};  ///< of kTelemetry
  bool wants_stop_plan = false;      ///< Session::knows_stop_plan
};

/// Options for the clock of the run: measured by telemetry's time field, or without one estimated from the
/// distance that the car moves.
run::ExternalDriveOptions by_simulator_clock(const ServeOptions& options) {
  run::ExternalDriveOptions counted = options;
  counted.clock.is_measured = !options.time_field.empty();
  counted.clock.is_estimated = !counted.clock.is_measured;
  return counted;
}

}  // namespace

/// Control thread, and everything that it owns.
class UdacityEndpoint::Control {
 public:
  using Answer = std::function<void(const Request&, std::string text, std::chrono::nanoseconds after)>;

  Control(const ServeOptions& options, std::unique_ptr<controller::Controller> controller,
          const ServeHooks& hooks, Answer answer)
      : options_{options},
        answer_{std::move(answer)},
        drive_hooks_{hooks},
        drive_{by_simulator_clock(options), std::move(controller), drive_hooks_},
        expected_delay_{seconds(options.latency) + kTypicalTurnAround},
        thread_{[this] { work(); }} {}
  ~Control() { stop(); }
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

  void stop() {
    {
      const std::lock_guard lock(mutex_);
      is_stopping_ = true;
    }
    changed_.notify_one();
    if (!thread_.joinable()) return;
    thread_.join();
    run_ = drive_.summary();
  }
  /// Summary of the run; empty before stop().
  [[nodiscard]] const telemetry::RunSummary& run() const { return run_; }

  void push(const Request& request) {
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back(request);
    }
    changed_.notify_one();
  }

  [[nodiscard]] std::uint64_t answers() const { return answers_.load(); }
  [[nodiscard]] std::uint64_t manual() const { return manual_.load(); }
  [[nodiscard]] std::uint64_t interventions() const { return interventions_.load(); }
  [[nodiscard]] double measured_delay() const { return measured_delay_.load(); }

 private:
  void work() {
    for (;;) {
      Request request;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return is_stopping_ || !waiting_.empty(); });
        if (is_stopping_) return;
        request = waiting_.front();
        waiting_.pop_front();
      }
      if (request.from != driven_) begin(request.from);
      if (request.kind == Request::Kind::kManual) {
        ++manual_;
        if (!std::exchange(is_by_hand_, true)) drive_.begin_anew();
        answer_(request, protocol::encode_manual(), std::chrono::nanoseconds{0});
      } else {
        drive(request);
      }
    }
  }

  /// Begins with another simulator, or the same one again: drops learned values.
  void begin(net::ConnectionId from) {
    driven_ = from;
    drive_.begin();
    delay_.reset();
  }

  void drive(const Request& request) {
    is_by_hand_ = false;
    run::ExternalDrive::Sighting sighting{.received = request.received, .usual_delay = delay()};
    if (const auto gap = drive_.gap(request.received)) {
      delay_.add(*gap);
      measured_delay_ = delay();
    }
    sighting.delay = delay();
    if (request.kind == Request::Kind::kTelemetry) sighting.measured = request.measurement;
    const telemetry::Frame& frame = drive_.step(sighting);
    if (frame.guard.gated) ++interventions_;
    static const safety::StopPlan kNone;
    answer_(request,
            protocol::encode_steer(frame.result.command, frame.result.plan, pose_at_receipt(frame),
                                   request.wants_stop_plan ? drive_.stop() : kNone, frame.time),
            options_.latency);
    ++answers_;
    drive_.finish();
  }

  /// Expected time from telemetry to the telemetry that shows the command's effect [s]: the control step,
  /// artificial latency, both ways through the sockets and the simulator's turn-around.
  [[nodiscard]] double delay() const { return delay_.value(expected_delay_); }

  /// Expected pose of the car at the arrival of the answer: start of the plan.
  [[nodiscard]] static model::Pose pose_at_receipt(const telemetry::Frame& frame) {
    const controller::Plan& plan = frame.result.plan;
    if (plan.size > 0) return {.x = plan.points[0].x, .y = plan.points[0].y, .psi = plan.points[0].psi};
    return {.x = frame.measurement.x, .y = frame.measurement.y, .psi = frame.measurement.psi};
  }

  const ServeOptions& options_;
  Answer answer_;
  const run::ExternalDriveHooks drive_hooks_;
  run::ExternalDrive drive_;
  const double expected_delay_;   ///< delay before one was measured [s]
  RecentMedian delay_;            ///< measured delays [s]
  telemetry::RunSummary run_;     ///< summary after stop()
  net::ConnectionId driven_ = 0;  ///< simulator of the last request; 0: none
  bool is_by_hand_ = false;       ///< a person drives
  // Read by any thread: counts of ServeSummary.
  std::atomic<std::uint64_t> answers_{0};
  std::atomic<std::uint64_t> manual_{0};
  std::atomic<std::uint64_t> interventions_{0};
  std::atomic<double> measured_delay_{0.0};  ///< newest median [s]

  std::mutex mutex_;                 ///< guards the following members
  std::condition_variable changed_;  ///< notified when one of them changes
  std::deque<Request> waiting_;      ///< requests in the order of arrival
  bool is_stopping_ = false;         ///< the thread has to end
  std::thread thread_;               ///< last member: it starts when all others are constructed
};

UdacityEndpoint::UdacityEndpoint(const ServeOptions& options,
                                 std::unique_ptr<controller::Controller> controller, ServeHooks hooks)
    : options_{options}, hooks_{std::move(hooks)}, log_{hooks_.log} {
  const auto answer = [this](const Request& request, std::string text, std::chrono::nanoseconds after) {
    server_->run_after(after, [this, id = request.from, text = std::move(text)]() mutable {
      if (id != session_.id) return;  // another simulator drives now
      --session_.unanswered;
      send(id, std::move(text));
    });
  };
  control_ = std::make_unique<Control>(options_, std::move(controller), hooks_, answer);
}

UdacityEndpoint::~UdacityEndpoint() = default;

void UdacityEndpoint::stop() { control_->stop(); }

ServeSummary UdacityEndpoint::summary() const {
  return {.answers = control_->answers(),
          .manual = control_->manual(),
          .unusable = unusable_,
          .connections = connections_,
          .refusals = refusals_,
          .interventions = control_->interventions(),
          .delay = control_->measured_delay(),
          .run = control_->run()};
}

void UdacityEndpoint::on_start(net::Server& server) {
  server_ = &server;
  server_->run_after(kWatchPeriod, [this] { watch(); });
}

net::UpgradeAnswer UdacityEndpoint::on_upgrade(const net::UpgradeRequest& request) {
  if (session_.id != 0 && !is_quiet()) {
    ++refusals_;
    const std::string why =
        fmt::format("another simulator ({}) is being driven; end it first", session_.name);
    log_.complain(fmt::format("refused {}: {}", request.peer, why));
    return {.accept = false, .status = 503, .reason = why};
  }
  Session session{.id = request.id, .name = request.peer};
  session.is_version_3 = request.target.find("EIO=3") != std::string::npos;
  session.knows_stop_plan = asks_for(protocol::kStopPlanItem, request.target);
  if (accepted_.size() >= kMaxAccepted) accepted_.erase(accepted_.begin());
  accepted_[request.id] = session;
  return {.accept = true};
}

void UdacityEndpoint::on_open(net::ConnectionId id) {
  const auto accepted = accepted_.extract(id);
  if (accepted.empty() || (session_.id != 0 && !is_quiet())) {
    return server_->close(id, 1013, "another simulator is being driven");
  }
  if (session_.id != 0) {
    log_.say(fmt::format("{} has gone quiet, {} takes over", session_.name, accepted.mapped().name));
    server_->close(session_.id, 1000, "another simulator took over");
  }
  session_ = accepted.mapped();
  session_.last_word = Clock::now();
  ++connections_;
  log_.say(fmt::format("simulator connected from {}", session_.name));
  server_->run_after(options_.open_after, [this, id] {
    if (session_.id == id && !session_.has_spoken) send_open_packet(id);
  });
}

void UdacityEndpoint::on_message(net::ConnectionId id, std::string_view bytes, bool) {
  if (id != session_.id) return;
  session_.has_spoken = true;
  session_.last_word = Clock::now();
  hear_telemetry(bytes);
}

void UdacityEndpoint::on_close(net::ConnectionId id, std::string_view why) {
  accepted_.erase(id);
  if (id != session_.id) return;
  log_.say(fmt::format("simulator {} is gone: {}", session_.name, why));
  session_ = {};
}

void UdacityEndpoint::hear_telemetry(std::string_view bytes) {
  Request request{.from = session_.id, .received = session_.last_word};
  request.wants_stop_plan = session_.knows_stop_plan;
  const protocol::UdacityTelemetry message = protocol::parse_telemetry(bytes, options_.time_field);
  if (const auto* packet = std::get_if<protocol::UdacityPacket>(&message)) return hear_packet(*packet);
  if (const auto* measurement = std::get_if<model::Measurement>(&message)) {
    request.measurement = *measurement;
  } else if (std::holds_alternative<protocol::UdacityManual>(message)) {
    request.kind = Request::Kind::kManual;
  } else {
    ++unusable_;
    if (!complain_about(message)) return;
    request.kind = Request::Kind::kUnusable;
  }
  if (session_.is_reported_silent) log_.say(fmt::format("telemetry from {} again", session_.name));
  session_.has_telemetry = true;
  session_.is_reported_silent = false;
  if (++session_.unanswered > kMaxUnanswered) {
    return server_->close(session_.id, 1008, fmt::format("more than {} unanswered messages", kMaxUnanswered));
  }
  control_->push(request);
}

bool UdacityEndpoint::complain_about(const protocol::UdacityTelemetry& message) {
  if (const auto* foreign = std::get_if<protocol::UdacityForeign>(&message)) {
    log_.complain(fmt::format("this is {}{}", foreign->what, foreign->is_telemetry ? "; braking" : ""));
    return foreign->is_telemetry;
  }
  const auto& broken = std::get<protocol::UdacityBroken>(message);
  log_.complain(broken.is_event ? fmt::format("broken telemetry: {}; braking", broken.reason)
                                : fmt::format("ignored a message: {}", broken.reason));
  return broken.is_event;
}

void UdacityEndpoint::hear_packet(protocol::UdacityPacket packet) {
  using enum protocol::UdacityPacket;
  session_.has_left |= packet == kDisconnect || packet == kClose;
  if (!session_.is_stock) return;  // the original pings once, but would go on if it got an answer
  switch (packet) {
    case kPing:
      return send(session_.id, "3");
    case kConnect:
      return send(session_.id, R"(40{"sid":"chicane"})");
    default:
      return;
  }
}

void UdacityEndpoint::send(net::ConnectionId id, std::string text) {
  session_.last_word = Clock::now();
  server_->send(id, std::move(text), false);
}

void UdacityEndpoint::send_open_packet(net::ConnectionId id) {
  session_.is_stock = true;
  send(id, kOpenPacket);
  if (session_.is_version_3) return send(id, "40");
  server_->run_after(kPingInterval, [this, id] { ping(id); });
}

void UdacityEndpoint::ping(net::ConnectionId id) {
  if (session_.id != id) return;
  server_->send(id, std::string("2"), false);  // Engine.IO 4: the server pings
  server_->run_after(kPingInterval, [this, id] { ping(id); });
}

void UdacityEndpoint::watch() {
  server_->run_after(kWatchPeriod, [this] { watch(); });
  const bool is_waiting =
      session_.id != 0 && !session_.has_left && session_.unanswered == 0 && !session_.is_reported_silent;
  if (!is_waiting || Clock::now() - session_.last_word < options_.silent_after) return;
  session_.is_reported_silent = true;
  log_.say(session_.has_telemetry
               ? fmt::format("no telemetry from {} for {:.0f} s: is it paused, or in its menu?",
                             session_.name, seconds(options_.silent_after))
               : fmt::format("{} is connected but sends no telemetry: leave the scene and enter it again",
                             session_.name));
}

bool UdacityEndpoint::is_quiet() const {
  return session_.has_left ||
         (session_.unanswered == 0 && Clock::now() - session_.last_word >= options_.quiet_after);
}

Result<ServeSummary> serve(const ServeOptions& options, std::unique_ptr<controller::Controller> controller,
                           ServeHooks hooks, Endpoint* viewer, std::vector<net::Asset> assets,
                           const std::atomic<bool>& stop) {
  const auto announce = hooks.on_listening;
  const auto end = hooks.on_end;
  Pages pages = std::move(hooks.pages);
  const auto say = hooks.log;
  UdacityEndpoint simulator(options, std::move(controller), std::move(hooks));
  Router router(&simulator, viewer, say);
  auto server = net::Server::create(options.server, router.handlers(std::move(pages)), std::move(assets));
  if (!server) return fail(server.error());
  if (announce) announce((*server)->port());
  while (!stop) std::this_thread::sleep_for(milliseconds{20});
  simulator.stop();
  if (end) end();
  server->reset();
  return simulator.summary();
}

}  // namespace chicane::wire
