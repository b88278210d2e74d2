// SPDX-License-Identifier: MIT
#include "chicane/wire/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <variant>

#include "chicane/base/math.hpp"
#include "chicane/net/client.hpp"
#include "chicane/protocol/udacity_codec.hpp"
#include "chicane/run/account.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/observe.hpp"
#include "chicane/sim/sensor.hpp"
#include "chicane/sim/world.hpp"
#include "chicane/wire/endpoint.hpp"
#include "chicane/wire/server_process.hpp"

namespace chicane::wire {
namespace {

constexpr double kPatienceInCycles = 3.0;

}  // namespace

bool CommandReceiver::sampled(double time) noexcept {
  const double asked = std::exchange(sampled_, time);
  if (!waiting_) return true;
  add_cycle(time - asked);
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

void CommandReceiver::answered(const protocol::UdacitySteer& steer) noexcept { waiting_ = steer; }

void CommandReceiver::disconnected() noexcept { waiting_.reset(); }

model::Command CommandReceiver::act(double time, double speed) noexcept {
  if (!has_any_) return acting_;
  acting_ = player_.guard(received_, time, speed);
  if (!is_timed_out_ && player_.is_stopping() && time - picked_up_ > patience_) {
    is_timed_out_ = true;
    timed_out_since_ = time;
  }
  return acting_;
}

/// A controller's habit tells when it has fallen silent.
void CommandReceiver::add_cycle(double length) noexcept {
  cycles_[static_cast<std::size_t>(cycle_count_++) % cycles_.size()] = length;
  std::array<double, 9> sorted = cycles_;
  const auto size = std::min(static_cast<std::size_t>(cycle_count_), sorted.size());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(size / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(size));
  patience_ = std::max(kPatienceInCycles * *middle, safety::StopPlayer::kPatience);
  player_.set_patience(patience_);
}

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr double kCatchUp = 1.0 / 3.0;  // physics skips time it cannot catch up, as the original [s]
constexpr milliseconds kConnectTimeout{1000};
constexpr milliseconds kNap{5};
constexpr double kStanding = 0.1;  // [m/s]

Clock::duration duration(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}
double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

/// Says in the request that this simulator plays stop plans.
std::string with_stop_plan(const std::string& url) {
  constexpr std::string_view kScheme = "ws://";
  const char* separator = url.find('?') != std::string::npos                   ? "&"
                          : url.find('/', kScheme.size()) != std::string::npos ? "?"
                                                                               : "/?";
  return fmt::format("{}{}{}", url, separator, protocol::kStopPlanItem);
}

run::AccountTerms terms(const scenario::Scenario& scenario, const road::Track& track) {
  run::AccountTerms terms = run::terms_of(scenario, &track);
  terms.controller = terms.preset = "external";
  terms.guard.reset();
  terms.latency = 0.0;
  terms.remedy = telemetry::kControllerRemedy;
  terms.step_deadline = std::numeric_limits<double>::infinity();  // there is none
  return terms;
}

/// The physical side: plant, road and what is measured of them, and the account of the run.
class Scene {
 public:
  Scene(const scenario::Scenario& scenario, road::Track track, road::Track waypoints,
        std::unique_ptr<sim::Plant> plant)
      : waypoints_sent_{scenario.waypoints_sent},
        track_{std::move(track)},
        waypoints_{std::move(waypoints)},
        plant_{std::move(plant)},
        world_{*plant_, track_},
        sensor_{scenario.sensor, scenario.seed},
        receiver_{scenario.vehicle, scenario.guard.receiver},
        account_{terms(scenario, track_)} {
    world_.place(track_.start_s(), track_.start_d());
  }

  /// Physics up to the moment `elapsed` [s] after the run began; what it cannot catch up is returned.
  double advance_to(double elapsed) {
    const double step = plant_->step_length();
    const double forgotten = std::max(0.0, elapsed - world_.time() - kCatchUp);
    while (world_.time() + step <= elapsed - forgotten && !account_.is_over()) {
      world_.advance(receiver_.act(world_.time(), plant_->output().speed));
      account_.add_physics(world_, false);
    }
    return forgotten;
  }

  /// Telemetry's content now, and with it the command of the last answer reaches the wheels, unless it is too
  /// late for that; false says so. `frame` is filled with what the world knows and the controller has not
  /// answered yet.
  bool sample(telemetry::Frame& frame) {
    model::Measurement now = sensor_.sample(world_.time(), *plant_);
    sim::select_waypoints(waypoints_, {.x = now.x, .y = now.y, .psi = now.psi}, waypoints_sent_, now);
    run::observe(world_, frame);
    frame.completed_lap = account_.completed_lap();
    frame.time = now.time;
    frame.measurement = now;
    frame.applied = receiver_.acting();
    return receiver_.sampled(now.time);
  }

  [[nodiscard]] telemetry::RunSummary summary() const { return account_.summary(world_.time()); }
  [[nodiscard]] run::Account& account() { return account_; }
  [[nodiscard]] double next_step() const { return world_.time() + plant_->step_length(); }
  [[nodiscard]] const model::State& car() const { return plant_->state(); }
  [[nodiscard]] double speed() const { return plant_->output().speed; }
  [[nodiscard]] double edge() const { return world_.state().edge_distance; }
  [[nodiscard]] CommandReceiver& receiver() { return receiver_; }

 private:
  int waypoints_sent_;
  road::Track track_;
  road::Track waypoints_;
  std::unique_ptr<sim::Plant> plant_;
  sim::World world_;
  sim::Sensor sensor_;
  CommandReceiver receiver_;
  run::Account account_;
};

/// The lines of a reply, from the car's frame to W.
void place_lines(const protocol::UdacitySteer& reply, const model::State& car, controller::Plan& plan) {
  const double c = cos(car.psi);
  const double s = sin(car.psi);
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

/// One run: the scene and the token that goes round between it and the controller.
class Simulation {
 public:
  Simulation(const SimulateOptions& options, const scenario::Scenario& scenario, const SimulateHooks& hooks,
             Scene& scene)
      : options_{options},
        turn_around_{duration(scenario.turn_around)},
        hooks_{hooks},
        url_{scenario.guard.receiver == safety::Receiver::kStopPlan ? with_stop_plan(options.url)
                                                                    : options.url},
        log_{hooks.log},
        server_{options.server_command, log_},
        scene_{scene} {}

  Result<SimulateReport> run(const std::atomic<bool>& stop) {
    began_ = last_connected_ = Clock::now();
    const Clock::time_point wall_start = began_;
    while (!stop && !scene_.account().is_over() && why_.empty()) {
      const Clock::time_point now = Clock::now();
      server_.keep_running(now);
      lose_hope(now);
      if (report_.connections > 0) move(now);
      if (const auto lap = scene_.account().take_lap(); lap && hooks_.on_lap) hooks_.on_lap(*lap);
      if (client_ == nullptr) {
        connect(now);
      } else {
        turn(now);
      }
    }
    if (report_.connections == 0 && !stop) return fail(ErrorCode::kIo, why_);
    report_.server_starts = server_.starts();
    report_.run = scene_.summary();
    report_.run.wall_time = seconds(Clock::now() - wall_start);
    if (!why_.empty()) report_.run.end_reason = why_;
    return report_;
  }

 private:
  /// Physics up to now; says when the car is stopped because no commands arrive, and when it stands.
  void move(Clock::time_point now) {
    const double speed = scene_.speed();
    began_ += duration(scene_.advance_to(seconds(now - began_)));
    const bool is_timed_out = scene_.receiver().is_timed_out();
    if (is_timed_out && !is_timed_out_ && speed > kStanding) {
      ++report_.stops;
      log_.say(
          fmt::format("no command in time: the car is stopped from {:.1f} m/s: {}", speed, silence(now)));
      is_standing_reported_ = false;
    }
    if (!is_timed_out && is_timed_out_ && !is_standing_reported_) {
      log_.say(fmt::format("commands again: the car drives on from {:.1f} m/s", speed));
      is_standing_reported_ = true;
    }
    is_timed_out_ = is_timed_out;
    if (!is_timed_out || is_standing_reported_ || scene_.speed() >= kStanding) return;
    is_standing_reported_ = true;
    log_.say(fmt::format("the car stands, its outermost wheel {:.2f} m {} the road's edge: {}",
                         std::fabs(scene_.edge()), scene_.edge() < 0.0 ? "beyond" : "inside", silence(now)));
  }

  /// Why no command acts.
  [[nodiscard]] std::string silence(Clock::time_point now) const {
    if (client_ == nullptr) return "no controller is connected";
    if (!asked_) return "the answers come too late";
    return fmt::format("the controller has not answered for {:.1f} s", seconds(now - *asked_));
  }

  void lose_hope(Clock::time_point now) {
    if (options_.hopeless_after.count() == 0 || report_.connections == 0) return;
    if (now - last_answer_ >= options_.hopeless_after)
      why_ = fmt::format("no usable answer within {:g} s", seconds(options_.hopeless_after));
  }

  /// Attempts run beside the physics, politely spaced.
  void connect(Clock::time_point now) {
    if (attempt_.valid()) {
      if (attempt_.wait_for(kNap) != std::future_status::ready) return;
      auto result = attempt_.get();
      next_attempt_ = now + options_.retry_after;
      if (result) return begin(std::move(*result));
      if (result.error().message != last_failure_)
        log_.complain(fmt::format("no controller yet: {}; trying again", result.error().message));
      last_failure_ = result.error().message;
      if (now - last_connected_ >= options_.lost_after) why_ = "no controller: " + last_failure_;
      return;
    }
    if (now < next_attempt_) return std::this_thread::sleep_for(kNap);
    attempt_ =
        std::async(std::launch::async, [url = url_] { return net::Client::connect(url, kConnectTimeout); });
  }

  void begin(std::unique_ptr<net::Client> client) {
    client_ = std::move(client);
    last_failure_.clear();
    if (report_.connections++ == 0) began_ = last_answer_ = Clock::now();  // with the first controller
    log_.say(fmt::format("connected to {}", options_.url));
    asked_.reset();
    due_ = Clock::now();
    deliver("2");  // the original pings once, because its time-out is a thousand times too long
  }

  void lose(const std::string& why) {
    log_.say(fmt::format("connection lost: {}", why));
    client_.reset();
    scene_.receiver().disconnected();
    last_connected_ = Clock::now();
    next_attempt_ = last_connected_ + options_.retry_after;
  }

  void deliver(const std::string& text) {
    if (auto sent = client_->send_text(text); !sent) lose(sent.error().message);
  }

  /// Sends what is due, then listens until the next physics step.
  void turn(Clock::time_point now) {
    if (due_ && now >= *due_) {
      ask(now);
      if (client_ == nullptr) return;
    }
    Clock::time_point wake = began_ + duration(scene_.next_step());
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

  /// Telemetry, and with it the command of the last answer reaches the wheels.
  void ask(Clock::time_point now) {
    due_.reset();
    asked_ = now;
    is_reported_silent_ = false;
    if (!scene_.sample(frame_)) ++report_.late_answers;
    is_manual_ = frame_.time < options_.manual_time;
    deliver(is_manual_ ? protocol::encode_manual_telemetry()
                       : protocol::encode_telemetry(frame_.measurement));
  }

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

  void accept(const protocol::UdacitySteer& steer, double waited) {
    ++report_.answers;
    if (!steer.clamped.empty())
      log_.complain(
          fmt::format("{}: clamped, as the original does. The answer is a share of full lock (25°, 0.436 "
                      "rad) or of the pedal, not degrees",
                      steer.clamped));
    last_answer_ = Clock::now();
    scene_.receiver().answered(steer);
    ++frame_.cycle;
    frame_.step_time = waited;
    frame_.result.command = frame_.asked = steer.command;  // its own gate is unknown
    frame_.result.report.solve.status =
        solver::SolveStatus::kOptimal;  // of an external solver nothing is known
    place_lines(steer, scene_.car(), frame_.result.plan);
    scene_.account().add(frame_);
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
  const Clock::duration turn_around_;
  const SimulateHooks& hooks_;
  const std::string url_;
  SparseLog log_;
  ServerProcess server_;
  Scene& scene_;
  SimulateReport report_;
  std::string why_;  ///< the run is over

  std::future<Result<std::unique_ptr<net::Client>>> attempt_;
  Clock::time_point next_attempt_{};
  Clock::time_point last_connected_{};
  Clock::time_point last_answer_{};
  std::string last_failure_;
  std::unique_ptr<net::Client> client_;

  Clock::time_point began_{};               ///< wall time of physics time 0
  std::optional<Clock::time_point> due_;    ///< of the next telemetry
  std::optional<Clock::time_point> asked_;  ///< telemetry is out since then
  bool is_reported_silent_ = false;
  bool is_manual_ = false;
  bool is_timed_out_ = false;         ///< when the car was looked at last
  bool is_standing_reported_ = true;  ///< nothing more to say about the stop
  telemetry::Frame frame_;
};

}  // namespace

Result<SimulateReport> simulate(const SimulateOptions& options, const scenario::Scenario& scenario,
                                const SimulateHooks& hooks, const std::atomic<bool>& stop) {
  if (auto url = net::parse_url(options.url); !url) return fail(url.error());
  Result<road::Track> track = run::make_track(scenario);
  if (!track) return fail(track.error());
  Result<road::Track> waypoints = run::make_waypoints(*track, scenario.vehicle.scale);
  if (!waypoints) return fail(waypoints.error());
  Result<std::unique_ptr<sim::Plant>> plant = run::make_plant(scenario);
  if (!plant) return fail(plant.error());
  Scene scene(scenario, std::move(*track), std::move(*waypoints), std::move(*plant));
  return Simulation(options, scenario, hooks, scene).run(stop);
}

}  // namespace chicane::wire
