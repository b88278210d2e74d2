// SPDX-License-Identifier: MIT
// `chicane simulate`: the client that simulates a car for a controller program over its protocol.
#include "chicane/wire/simulate.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <csignal>
#include <future>
#include <memory>
#include <thread>
#include <variant>

#include "chicane/base/duration.hpp"
#include "chicane/base/math.hpp"
#include "chicane/net/client.hpp"
#include "chicane/run/simulated_car.hpp"

namespace chicane::wire {
namespace {

constexpr double kPatienceInCycles = 3.0;  // usual cycles that a controller may be silent; chosen

}  // namespace

bool CommandReceiver::sampled(double time) noexcept {
  const double asked = std::exchange(sampled_, time);
  if (!waiting_) return true;
  // The usual cycle of the controller defines its silence.
  cycles_.add(time - asked);
  patience_ = std::max(kPatienceInCycles * cycles_.value(0.0), safety::StopPlayer::kPatience);
  player_.set_patience(patience_);
  const bool is_late = is_timed_out_ && timed_out_since_ >= asked;
  if (!is_late) {
    received_ = waiting_->command;
    for (int i = 0; i < waiting_->stop.size; ++i)
      waiting_->stop.points[static_cast<std::size_t>(i)].time += asked;
    player_.arrived(time, waiting_->stop);
    picked_up_ = time;
    has_any_ = true;
    is_timed_out_ = false;
  }
  waiting_.reset();
  return !is_late;
}

model::Command CommandReceiver::act(double time, double speed) noexcept {
  if (!has_any_) return acting_;
  acting_ = player_.guard(received_, time, speed);
  if (!is_timed_out_ && player_.is_stopping() && time - picked_up_ > patience_) {
    is_timed_out_ = true;
    timed_out_since_ = time;
  }
  return acting_;
}

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// Chosen.
constexpr milliseconds kConnectTimeout{1000};  // longest attempt to connect
constexpr milliseconds kConnectPoll{5};        // period of looking whether an attempt has ended

/// Address of a controller with the request for stop plans.
std::string with_stop_plan(const std::string& url) {
  constexpr std::string_view kScheme = "ws://";
  const char* separator = url.find('?') != std::string::npos                   ? "&"
                          : url.find('/', kScheme.size()) != std::string::npos ? "?"
                                                                               : "/?";
  return fmt::format("{}{}{}", url, separator, protocol::kStopPlanItem);
}

/// Writes plan and reference of a reply into `plan`: from the car's frame to W.
void place_lines(const protocol::UdacitySteer& reply, const model::State& car, controller::Plan& plan) {
  const double c = cos(car.psi), s = sin(car.psi);
  const auto to_world = [&](const Vec2& p) {
    return Vec2{car.x + c * p.x() - s * p.y(), car.y + s * p.x() + c * p.y()};
  };
  constexpr auto kCapacity = static_cast<std::size_t>(controller::Plan::kCapacity);
  plan.size = static_cast<int>(std::min(reply.plan.size(), kCapacity));
  plan.reference_size = static_cast<int>(std::min(reply.reference.size(), kCapacity));
  for (std::size_t i = 0; i < static_cast<std::size_t>(plan.size); ++i) {
    const Vec2 point = to_world(reply.plan[i]);
    plan.points[i] = {};
    plan.points[i].x = point.x();
    plan.points[i].y = point.y();
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(plan.reference_size); ++i) {
    plan.reference[i] = to_world(reply.reference[i]);
  }
}

/// One run: the car, and the exchange with the controller, in which telemetry and answer alternate.
class Simulation {
 public:
  Simulation(const SimulateOptions& options, const scenario::Scenario& scenario, const SimulateHooks& hooks,
             run::SimulatedCar& car)
      : options_{options},
        waypoints_sent_{scenario.waypoints_sent},
        turn_around_{duration(scenario.turn_around)},
        hooks_{hooks},
        url_{scenario.guard.receiver == safety::Receiver::kStopPlan ? with_stop_plan(options.url)
                                                                    : options.url},
        log_{hooks.log},
        server_{options.server_command, log_},
        car_{car},
        receiver_{scenario.vehicle, scenario.guard.receiver},
        stops_{scenario, [this](std::string_view line) { log_.say(line); }} {}

  Result<SimulateReport> run(const std::atomic<bool>& stop) {
    began_ = last_connected_ = Clock::now();
    const Clock::time_point wall_start = began_;
    while (!stop && !car_.account.is_over() && why_.empty()) {
      const Clock::time_point now = Clock::now();
      server_.keep_running(now);
      lose_hope(now);
      if (report_.connections > 0) move(now);
      if (const auto lap = car_.account.take_lap(); lap && hooks_.on_lap) hooks_.on_lap(*lap);
      if (client_ == nullptr) {
        connect(now);
      } else {
        turn(now);
      }
    }
    if (report_.connections == 0 && !stop) return fail(ErrorCode::kIo, why_);
    report_.server_starts = server_.starts();
    report_.run = car_.account.summary(car_.world.time());
    report_.run.wall_time = seconds(Clock::now() - wall_start);
    if (!why_.empty()) report_.run.end_reason = why_;
    return report_;
  }

 private:
  /// Physics up to now. Reports when the car is stopped because no commands come, and when it stands.
  void move(Clock::time_point now) {
    const double speed = car_.speed();
    began_ += duration(
        car_.catch_up(seconds(now - began_), [&] { return receiver_.act(car_.world.time(), car_.speed()); }));
    if (stops_.look(car_, receiver_.is_timed_out(), speed, [&] { return silence(now); })) ++report_.stops;
  }

  /// Reason for which no command comes, a clause.
  [[nodiscard]] std::string silence(Clock::time_point now) const {
    if (client_ == nullptr) return "no controller is connected";
    if (!asked_) return "the answers come too late";
    return fmt::format("the controller has not answered for {:.1f} s", seconds(now - *asked_));
  }

  /// Ends the run after SimulateOptions::hopeless_after without a usable answer.
  void lose_hope(Clock::time_point now) {
    if (options_.hopeless_after.count() == 0 || report_.connections == 0) return;
    if (now - last_answer_ >= options_.hopeless_after)
      why_ = fmt::format("no usable answer within {:g} s", seconds(options_.hopeless_after));
  }

  /// Connects while the physics runs, with pauses between attempts.
  void connect(Clock::time_point now) {
    if (attempt_.valid()) {
      if (attempt_.wait_for(kConnectPoll) != std::future_status::ready) return;
      auto result = attempt_.get();
      next_attempt_ = now + options_.retry_after;
      if (result) return begin(std::move(*result));
      if (result.error().message != last_failure_)
        log_.complain(fmt::format("no controller yet: {}; trying again", result.error().message));
      last_failure_ = result.error().message;
      if (now - last_connected_ >= options_.lost_after) why_ = "no controller: " + last_failure_;
      return;
    }
    if (now < next_attempt_) return std::this_thread::sleep_for(kConnectPoll);
    attempt_ =
        std::async(std::launch::async, [url = url_] { return net::Client::connect(url, kConnectTimeout); });
  }

  /// Begins the exchange on a new connection.
  void begin(std::unique_ptr<net::Client> client) {
    client_ = std::move(client);
    last_failure_.clear();
    if (report_.connections++ == 0) began_ = last_answer_ = Clock::now();  // at the first controller
    log_.say(fmt::format("connected to {}", options_.url));
    asked_.reset();
    due_ = Clock::now();
    deliver("2");  // pings once, as the original does: its period is a thousand times too long
  }

  /// Drops the connection, for the reason `why`.
  void lose(const std::string& why) {
    log_.say(fmt::format("connection lost: {}", why));
    client_.reset();
    receiver_.disconnected();
    last_connected_ = Clock::now();
    next_attempt_ = last_connected_ + options_.retry_after;
  }

  /// Sends a message, or drops the connection.
  void deliver(const std::string& text) {
    if (auto sent = client_->send_text(text); !sent) lose(sent.error().message);
  }

  /// Sends due messages, then listens until the next physics step.
  void turn(Clock::time_point now) {
    if (due_ && now >= *due_) {
      ask(now);
      if (client_ == nullptr) return;
    }
    Clock::time_point wake = began_ + duration(car_.world.time() + car_.plant->step_length());
    if (due_) wake = std::min(wake, *due_);
    const auto patience = std::chrono::ceil<milliseconds>(std::max(wake - now, Clock::duration::zero()));
    auto received = client_->receive(std::max(patience, milliseconds{1}));
    if (!received) return lose(received.error().message);
    if (*received) {
      hear(**received);
    } else if (asked_) {
      watch(Clock::now() - *asked_);
    }
  }

  /// Samples and sends telemetry; the command of the last answer acts from now on.
  void ask(Clock::time_point now) {
    due_.reset();
    asked_ = now;
    is_reported_silent_ = false;
    car_.write(car_.sense(waypoints_sent_), receiver_.acting(), frame_);
    if (!receiver_.sampled(frame_.time)) ++report_.late_answers;
    is_manual_ = frame_.time < options_.manual_time;
    deliver(is_manual_ ? protocol::encode_manual_telemetry()
                       : protocol::encode_telemetry(frame_.measurement));
  }

  /// Reports a silent controller, and drops the connection after a long silence.
  void watch(Clock::duration silence) {
    if (silence >= options_.give_up_after) {
      ++report_.silences;
      return lose("the controller does not answer");
    }
    if (silence < options_.complain_after || is_reported_silent_) return;
    is_reported_silent_ = true;
    log_.say(fmt::format("no answer for {} ms: the original simulator would wait for ever",
                         options_.complain_after.count()));
  }

  /// Takes a message of the controller.
  void hear(const std::string& text) {
    const protocol::UdacityReply reply = protocol::parse_reply(text);
    if (const auto* packet = std::get_if<protocol::UdacityPacket>(&reply)) return hear_packet(*packet);
    if (!asked_) {
      ++report_.extra_answers;
      return log_.complain(
          "an answer that nobody asked for: the original simulator would now run two loops at once");
    }
    const Clock::time_point now = Clock::now();
    const double waited = seconds(now - *asked_);
    asked_.reset();
    due_ = now + turn_around_;
    if (const auto* steer = std::get_if<protocol::UdacitySteer>(&reply)) return accept(*steer, waited);
    if (const auto* broken = std::get_if<protocol::UdacityBroken>(&reply)) {
      ++report_.broken_answers;
      return log_.complain(
          fmt::format("broken answer: {} (the original simulator would stall)", broken->reason));
    }
    if (!is_manual_)
      log_.complain("the controller answered telemetry with \"manual\": it did not understand it");
  }

  /// Takes a usable answer, which came `waited` [s] after the telemetry.
  void accept(const protocol::UdacitySteer& steer, double waited) {
    ++report_.answers;
    if (!steer.clamped.empty())
      log_.complain(
          fmt::format("{}: clamped, as the original does. The answer is a share of full lock (25°, 0.436 "
                      "rad) or of the pedal, not degrees",
                      steer.clamped));
    last_answer_ = Clock::now();
    receiver_.answered(steer);
    frame_.step_time = waited;
    frame_.result.command = steer.command;
    place_lines(steer, car_.plant->state(), frame_.result.plan);
    car_.count(frame_);
    if (hooks_.on_frame) hooks_.on_frame(frame_);
  }

  void hear_packet(protocol::UdacityPacket packet) {
    if (packet == protocol::UdacityPacket::kPing) deliver("3");
    if (packet == protocol::UdacityPacket::kOpen) {
      log_.complain(
          "the controller sent an Engine.IO open packet: the original simulator would now run two loops at "
          "once");
    }
  }

  const SimulateOptions& options_;
  const int waypoints_sent_;
  const Clock::duration turn_around_;
  const SimulateHooks& hooks_;
  const std::string url_;
  SparseLog log_;
  ServerProcess server_;
  run::SimulatedCar& car_;
  CommandReceiver receiver_;
  run::StopNews stops_;
  SimulateReport report_;
  std::string why_;  ///< reason of an early end of the run; empty: it goes on

  std::future<Result<std::unique_ptr<net::Client>>> attempt_;  ///< attempt to connect; invalid: none runs
  Clock::time_point next_attempt_{};                           ///< time of the next attempt
  Clock::time_point last_connected_{};                         ///< time at which the last connection ended
  Clock::time_point last_answer_{};                            ///< time of the last usable answer
  std::string last_failure_;                                   ///< message of the last failed attempt
  std::unique_ptr<net::Client> client_;                        ///< connection; null: none

  Clock::time_point began_{};             ///< wall time of physics time 0
  std::optional<Clock::time_point> due_;  ///< time of the next telemetry; none: an answer is awaited
  std::optional<Clock::time_point>
      asked_;                        ///< time of the telemetry without an answer; none: all are answered
  bool is_reported_silent_ = false;  ///< the silence since asked_ was reported
  bool is_manual_ = false;           ///< the last telemetry was that of manual driving
  telemetry::Frame frame_;           ///< frame of the current cycle
};

}  // namespace

Result<SimulateReport> simulate(const SimulateOptions& options, const scenario::Scenario& scenario,
                                const SimulateHooks& hooks, const std::atomic<bool>& stop) {
  if (auto url = net::parse_url(options.url); !url) return fail(url.error());
  const auto car = run::SimulatedCar::create(scenario, 0.0);
  if (!car) return fail(car.error());
  return Simulation(options, scenario, hooks, **car).run(stop);
}

namespace {

// Chosen.
constexpr std::chrono::seconds kRestartAfter{1};  // least time between two starts of the controller
constexpr unsigned kPatience = 1;                 // [s] time for a group to end before it is killed

/// Becomes the shell that runs the command.
[[noreturn]] void run_shell(const char* command, const sigset_t& no_signals) {
  ::sigprocmask(SIG_SETMASK, &no_signals, nullptr);
  const int nothing = ::open("/dev/null", O_RDWR);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDOUT_FILENO);  // the original's controllers print every message
  ::execl("/bin/sh", "sh", "-c", command, static_cast<char*>(nullptr));
  ::_exit(127);
}

/// Ends this process with the status or signal of the shell.
[[noreturn]] void end_like(int status, const sigset_t& no_signals) {
  if (WIFSIGNALED(status)) {
    ::sigprocmask(SIG_SETMASK, &no_signals, nullptr);
    static_cast<void>(::signal(WTERMSIG(status), SIG_DFL));
    static_cast<void>(::raise(WTERMSIG(status)));
  }
  ::_exit(WEXITSTATUS(status));
}

/// Head of the group: waits for the shell. Ends the whole group when asked to, or when the parent dies. Makes
/// system calls only, because it is forked from a program with several threads.
[[noreturn]] void guard(const char* command, pid_t parent) {
  ::setpgid(0, 0);
  sigset_t awaited, no_signals;
  ::sigemptyset(&no_signals);
  ::sigemptyset(&awaited);
  for (const int signal : {SIGCHLD, SIGTERM, SIGALRM}) ::sigaddset(&awaited, signal);
  ::sigprocmask(SIG_SETMASK, &awaited, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);     // orphans of the shell become children of this process
  if (::getppid() != parent) ::_exit(0);  // the parent died before prctl()
  const pid_t shell = ::fork();
  if (shell == 0) run_shell(command, no_signals);
  for (bool is_ending = false;;) {
    int signal = 0;
    if (::sigwait(&awaited, &signal) != 0) continue;
    if (signal == SIGALRM) ::kill(0, SIGKILL);
    if (signal == SIGTERM && !is_ending) {
      is_ending = true;
      ::kill(0, SIGTERM);
      ::alarm(kPatience);
    }
    int status = 0;
    pid_t ended = 0;
    while ((ended = ::waitpid(-1, &status, WNOHANG)) > 0) {
      if (ended == shell && !is_ending) end_like(status, no_signals);
    }
    if (ended < 0) ::_exit(0);  // no process is left
  }
}

}  // namespace

ServerProcess::~ServerProcess() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGTERM);
  ::waitpid(pid_, nullptr, 0);  // within the guard's time limit
}

void ServerProcess::keep_running(std::chrono::steady_clock::time_point now) {
  if (command_.empty()) return;
  if (pid_ > 0) {
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) != pid_) return;
    pid_ = -1;
    log_.say(WIFSIGNALED(status) ? fmt::format("the controller was ended by signal {}", WTERMSIG(status))
                                 : fmt::format("the controller ended with status {}", WEXITSTATUS(status)));
  }
  if (starts_ > 0 && now - started_ < kRestartAfter) return;
  start();
  started_ = now;
  ++starts_;
}

void ServerProcess::start() {
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) guard(command_.c_str(), parent);
}

}  // namespace chicane::wire
