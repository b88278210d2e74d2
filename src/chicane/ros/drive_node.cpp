// SPDX-License-Identifier: MIT
// `chicane ros`: the node that drives a car over ROS 2, cycle by cycle from odometry.
#include "chicane/ros/nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <utility>

#include "chicane/base/duration.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/ros/car_topics.hpp"
#include "chicane/ros/node_clock.hpp"
#include "chicane/ros/run_publisher.hpp"
#include "chicane/run/external_drive.hpp"
#include "chicane/safety/stop_player.hpp"
#include "chicane/wire/endpoint.hpp"

namespace chicane::ros {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// Chosen.
constexpr double kSoonest = 0.75;  // least time between cycles, in control periods
constexpr double kLatest = 2.2;    // usual times between cycles after which odometry is missing: two messages
constexpr double kAbsence = 10.0;  // [s] time without odometry after which cycles end
constexpr double kNewest = 0.1;    // weight of the newest value in smoothed means
constexpr double kLookPeriod = 0.5;       // [s] period of looking for partners
constexpr double kStanding = 0.1;         // [m/s] speed below which a car in full size stands
constexpr milliseconds kLongestWait{50};  // longest wait for a message

/// Controller's node, on the thread that calls run().
class DriveNode {
 public:
  DriveNode(const NodeOptions& node, const wire::ServeOptions& options,
            std::unique_ptr<Participant> participant, CarTopics topics,
            std::unique_ptr<RunPublisher> publisher, std::unique_ptr<ParameterServices> parameters,
            std::unique_ptr<controller::Controller> controller, const wire::ServeHooks& hooks)
      : node_{node},
        options_{options},
        participant_{std::move(participant)},
        topics_{std::move(topics)},
        publisher_{std::move(publisher)},
        parameters_{std::move(parameters)},
        log_{hooks.log},
        hooks_{with_laps_published(hooks)},
        drive_{options, std::move(controller), hooks_},
        time_{node.is_time_simulated},
        sight_{options.scenario, node.topics.path.empty() ? options.track : nullptr,
               node.is_base_at_rear_axle},
        clock_{node.topics.odom},
        partners_{wanted_partners(node), node.network, seconds(options.silent_after)},
        period_{options.scenario.control_period},
        usual_{period_} {}

  wire::ServeSummary run(const std::atomic<bool>& stop) {
    while (!stop) {
      participant_->wait(patience(time_.now()));
      read_clock();
      read_requests();
      if (parameters_) parameters_->serve();
      read_transforms();
      read_path();
      read_odometry();
      const Clock::time_point now = time_.now();
      if (is_stopped_) {
        play_stop(now);
      } else {
        cycle(now);
      }
      look_at_partners(Clock::now());
    }
    summary_.delay = delay();
    summary_.run = drive_.summary();
    return summary_;
  }

 private:
  /// Time until a cycle without odometry is due.
  [[nodiscard]] std::chrono::nanoseconds patience(Clock::time_point now) const {
    if (!is_driving_ || time_.is_simulated()) return kLongestWait;  // each tick of /clock ends it
    const double left = kLatest * usual_ - seconds(now - last_cycle_);
    return std::clamp<std::chrono::nanoseconds>(
        std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * left)), std::chrono::nanoseconds{100'000},
        kLongestWait);
  }

  /// Hooks that publish completed laps, too.
  run::ExternalDriveHooks with_laps_published(run::ExternalDriveHooks hooks) {
    hooks.on_lap = [this, on_lap = std::move(hooks.on_lap)](const telemetry::CompletedLap& lap) {
      publisher_->publish(lap);
      if (on_lap) on_lap(lap);
    };
    return hooks;
  }

  /// Expected time from odometry until the command acts [s].
  [[nodiscard]] double delay() const { return options_.scenario.latency + turn_around_; }

  void read_clock() {
    if (!topics_.clock) return;
    for (const Sample& sample : topics_.clock->take()) {
      const auto clock = protocol::decode<protocol::ClockMessage>(sample.bytes);
      if (!clock) continue;
      const std::string news = time_.tick(clock->time);
      if (news.empty()) continue;
      log_.say(news);
      clock_.forget();
      drive_.begin();
      is_driving_ = false;
    }
  }

  void read_transforms() {
    for (Reader* reader : {topics_.fixed_transforms.get(), topics_.transforms.get()}) {
      for (const Sample& sample : reader->take())
        if (const auto transforms = protocol::decode<protocol::TransformsMessage>(sample.bytes))
          for (const protocol::TransformMessage& transform : transforms->transforms) frames_.put(transform);
    }
  }

  /// Brings odometry into the frame of the road. Reports once whether there is a transform.
  void bring_to_map(protocol::OdometryMessage& odometry) {
    if (odometry.frame == node_.frames.map) return;
    const auto place = frames_.find(node_.frames.map, odometry.frame);
    if (has_transform_ != place.has_value()) {
      has_transform_ = place.has_value();
      log_.say(fmt::format("{}: got the frame \"{}\", expected \"{}\": {}", node_.topics.odom, odometry.frame,
                           node_.frames.map,
                           place ? "brought there by /tf" : "used as it is, without a transform on /tf"));
    }
    if (place) odometry.pose = composed(*place, odometry.pose);
  }

  void read_odometry() {
    for (const Sample& sample : topics_.odom->take()) {
      const Clock::time_point now = time_.now();
      const auto message = protocol::decode<protocol::OdometryMessage>(sample.bytes);
      if (!message) {
        ++summary_.unusable;
        log_.complain(
            fmt::format("{}: got bytes that are no {}", node_.topics.odom, protocol::OdometryMessage::kType));
        continue;
      }
      if (sample.writer != writer_) begin(sample.writer, *message);
      const bool is_new = clock_.accept(
          message->stamp, std::chrono::nanoseconds(now.time_since_epoch()).count(), time_.stamp_now());
      if (const std::string news = clock_.news(); !news.empty()) log_.say(news);
      if (!is_new) continue;
      if (is_silent_) log_.say(fmt::format("{} again", node_.topics.odom));
      is_silent_ = false;
      odometry_ = *message;
      bring_to_map(odometry_);
      arrived_ = now;
      moment_ = Clock::time_point(std::chrono::nanoseconds(clock_.moment()));
      is_fresh_ = true;
    }
  }

  /// Begins with another sender of odometry: another car, or the same one after a restart.
  void begin(std::uint64_t writer, const protocol::OdometryMessage& first) {
    writer_ = writer;
    ++summary_.connections;
    clock_.forget();
    drive_.begin();
    is_driving_ = false;
    usual_ = period_;
    has_transform_.reset();
    log_.say(fmt::format("odometry of {} in {} by {}", first.child_frame, first.frame, node_.topics.odom));
  }

  /// Does a control cycle if one is due, with odometry or without.
  void cycle(Clock::time_point now) {
    const double since = seconds(now - last_cycle_);
    if (is_fresh_ && (!is_driving_ || since >= kSoonest * period_)) {
      is_fresh_ = false;
      if (is_driving_ && !was_blind_)
        usual_ = std::max(period_, usual_ + kNewest * (std::min(since, 1.0) - usual_));
      was_blind_ = false;
      // The stamp is the time of measurement, but time must not go back after a cycle without odometry.
      const Clock::time_point moment =
          is_driving_ ? std::max(moment_, last_cycle_ + milliseconds{1}) : moment_;
      const double time = drive_.time(moment);
      auto measured = sight_.measure(odometry_, time);
      if (!measured) {
        ++summary_.unusable;
        log_.complain(fmt::format("{}: got numbers that are not finite", node_.topics.odom));
      }
      if (!sight_.has_road())
        return log_.complain(fmt::format("no path on {} yet: the car stands", node_.topics.path));
      answer(measured, moment, odometry_.stamp);
      return;
    }
    if (!is_driving_ || since < kLatest * usual_) return;
    const double silence = seconds(now - arrived_);
    if (silence > kAbsence) {
      is_driving_ = false;
      return;
    }
    was_blind_ = true;
    complain_about_silence(silence);
    answer(std::nullopt, now, odometry_.stamp + std::chrono::nanoseconds(now - arrived_).count());
  }

  void complain_about_silence(double silence) {
    if (is_silent_ || silence < std::min(1.0, seconds(options_.silent_after))) return;
    is_silent_ = true;
    log_.say(
        fmt::format("no odometry on {} for {:.1f} s: the guard stops the car", node_.topics.odom, silence));
  }

  /// Computes and sends the command for a measurement at `received`, or for a missing one.
  void answer(const std::optional<model::Measurement>& measured, Clock::time_point received,
              std::int64_t stamp) {
    const double usual = delay();
    const telemetry::Frame& frame =
        drive_.step({.received = received, .measured = measured, .delay = usual, .usual_delay = usual});
    is_driving_ = true;
    last_cycle_ = received;
    const controller::Plan& plan = frame.result.plan;
    const double act_speed = plan.size > 0 ? plan.points[0].speed
                             : measured    ? measured->speed
                                           : std::max(0.0, last_speed_);
    last_speed_ = act_speed;
    send(frame.result.command, act_speed, stamp, &drive_.stop(), frame.time);
    const Clock::time_point sent = time_.now();
    turn_around_ += kNewest * (std::min(seconds(sent - received), period_) - turn_around_);
    sight_.sent(drive_.time(sent), frame.result.command);
    ++summary_.answers;
    if (frame.guard.gated) ++summary_.interventions;
    drive_.finish();
    publisher_->publish(drive_.frame(),
                        1e-9 * static_cast<double>(time_.stamp_now()) - drive_.time(time_.now()));
  }

  /// Sends a command that acts at `speed` [m/s], after its stop plan. `time`: run time of the cycle [s].
  void send(const model::Command& command, double speed, std::int64_t stamp, const safety::StopPlan* stop,
            double time) {
    if (topics_.stop_plan && stop != nullptr && stop->size > 0) {
      stop_message_.stamp = stamp;
      stop_message_.stop = *stop;
      for (int i = 0; i < stop->size; ++i)
        stop_message_.stop.points[static_cast<std::size_t>(i)].time -= time;
      static_cast<void>(topics_.stop_plan->write(protocol::encode(stop_message_)));
    }
    protocol::DriveMessage message = to_message(options_.scenario.vehicle, command, speed, node_.drive);
    message.stamp = stamp;
    message.frame = node_.frames.base;
    const bool is_sent = !topics_.drive || topics_.drive->write(protocol::encode(message));
    if (!is_sent) log_.complain(fmt::format("{}: DDS did not take a command in time", node_.topics.drive));
    if (topics_.autoware)
      static_cast<void>(topics_.autoware->write(protocol::encode(protocol::AutowareMessage{message})));
  }

  // ---- Requests ----

  void read_requests() {
    if (topics_.stop) {
      for (const Sample& sample : topics_.stop->take())
        if (const auto wanted = protocol::decode<protocol::BoolMessage>(sample.bytes))
          request_stop(wanted->data);
    }
    if (topics_.initial_pose) {
      for (const Sample& sample : topics_.initial_pose->take()) {
        if (!protocol::decode<protocol::PoseMessage>(sample.bytes)) continue;
        log_.say(
            fmt::format("{}: the car was put elsewhere, nothing learned is kept", node_.topics.initial_pose));
        drive_.begin();
      }
    }
  }

  void request_stop(bool wanted) {
    if (wanted && !is_stopped_) {
      is_stopped_ = true;
      player_.emplace(options_.scenario.vehicle, period_, options_.scenario.guard.receiver);
      player_->arrived(drive_.time(time_.now()), drive_.stop());
      stopping_ = drive_.frame().result.command;
      log_.say("stopped by request");
      return;
    }
    if (wanted || !is_stopped_) return;
    if (speed_now() > kStanding * std::sqrt(options_.scenario.vehicle.scale))
      return log_.say(
          fmt::format("got a request to drive on at {:.1f} m/s, expected a car that stands", speed_now()));
    is_stopped_ = false;
    is_driving_ = false;
    drive_.begin();
    log_.say("drives on by request");
  }

  [[nodiscard]] double speed_now() const { return std::fabs(odometry_.vx); }

  /// Sends the next command of the stop plan, as the car's receiver would execute it when commands cease.
  void play_stop(Clock::time_point now) {
    is_fresh_ = false;
    if (seconds(now - last_cycle_) < period_) return;
    last_cycle_ = now;
    const double time = drive_.time(now);
    const double speed = speed_now();
    const model::Command command = player_->guard(stopping_, time + safety::StopPlayer::kPatience, speed);
    send(command, speed, odometry_.stamp + std::chrono::nanoseconds(now - arrived_).count(), nullptr, time);
    sight_.sent(time, command);
  }

  void read_path() {
    if (!topics_.path) return;
    read_paths(*topics_.kept_path);
    read_paths(*topics_.path);
  }

  void read_paths(Reader& reader) {
    for (const Sample& sample : reader.take()) {
      const auto path = protocol::decode<protocol::PathMessage>(sample.bytes);
      if (!path) {
        log_.complain(
            fmt::format("{}: got bytes that are no {}", node_.topics.path, protocol::PathMessage::kType));
        continue;
      }
      std::vector<Vec2> points;
      const model::Pose place = frames_.find(node_.frames.map, path->frame).value_or(model::Pose{});
      points.reserve(path->poses.size());
      for (const protocol::StampedPose& each : path->poses) {
        const model::Pose moved = composed(place, {.x = each.pose.x, .y = each.pose.y});
        points.emplace_back(moved.x, moved.y);
      }
      if (const Result<void> used = sight_.use_path(points); !used)
        log_.complain(fmt::format("{}: {}", node_.topics.path, used.error().message));
    }
  }

  void look_at_partners(Clock::time_point now) {
    if (seconds(now - looked_) < kLookPeriod) return;
    looked_ = now;
    const std::vector<Endpoint> others = participant_->others();
    participant_->announce("chicane");
    for (const std::string& line : partners_.look(drive_.time(now), others, topics_.matched()))
      log_.say(line);
    const bool has_clock = std::any_of(others.begin(), others.end(), [](const Endpoint& other) {
      return other.is_writer && other.topic == "/clock";
    });
    if (has_clock && !time_.is_simulated() && !std::exchange(has_said_clock_, true))
      log_.say("/clock is sent by a partner: time is simulated; --use-sim-time counts by it");
  }

  const NodeOptions& node_;
  const wire::ServeOptions& options_;
  std::unique_ptr<Participant> participant_;
  CarTopics topics_;
  std::unique_ptr<RunPublisher> publisher_;
  std::unique_ptr<ParameterServices> parameters_;  ///< null: none
  wire::SparseLog log_;
  run::ExternalDriveHooks hooks_;
  run::ExternalDrive drive_;
  NodeClock time_;                       ///< time of this node
  CarSight sight_;                       ///< measurements from odometry
  ClockWatch clock_;                     ///< stamps of the odometry
  FrameTree frames_;                     ///< frames by /tf and /tf_static
  std::optional<bool> has_transform_{};  ///< whether odometry has a transform to the map, as reported last
  PartnerWatch partners_;
  wire::ServeSummary summary_;
  protocol::StopMessage stop_message_;  ///< message of the current stop plan

  const double period_;                       ///< control period [s]
  double usual_;                              ///< usual time from cycle to cycle [s]
  double turn_around_ = 0.0;                  ///< time from odometry to command [s]
  double last_speed_ = 0.0;                   ///< speed at which the last command acts [m/s]
  std::uint64_t writer_ = 0;                  ///< writer of the odometry; 0: none yet
  protocol::OdometryMessage odometry_;        ///< newest odometry
  Clock::time_point arrived_{}, moment_{};    ///< times of its arrival, and of its measurement
  Clock::time_point last_cycle_{};            ///< time of the last cycle
  Clock::time_point looked_{};                ///< time of the last look for partners
  bool is_fresh_ = false;                     ///< odometry waits for a cycle
  bool is_driving_ = false;                   ///< cycles continue, with odometry or without
  bool was_blind_ = false;                    ///< the last cycle had no odometry
  bool is_silent_ = false;                    ///< missing odometry was reported
  bool is_stopped_ = false;                   ///< stopped by request
  std::optional<safety::StopPlayer> player_;  ///< executes the stop plan of a stop by request
  model::Command stopping_;                   ///< last command before that stop
  bool has_said_clock_ = false;               ///< a /clock that is not used was reported
};

}  // namespace

Result<wire::ServeSummary> drive(const NodeOptions& node, const wire::ServeOptions& options,
                                 std::unique_ptr<controller::Controller> controller, wire::ServeHooks hooks,
                                 wire::Endpoint* viewer, std::vector<net::Asset> assets,
                                 const std::atomic<bool>& stop) {
  auto participant = Participant::create(node.network);
  if (!participant) return fail(participant.error());
  auto topics = CarTopics::create(**participant, node);
  if (!topics) return fail(topics.error());
  protocol::Run run = hooks.description != nullptr ? *hooks.description : protocol::Run{};
  run.frames = node.frames;
  auto publisher = RunPublisher::create(**participant, run);
  if (!publisher) return fail(publisher.error());
  wire::Router router(nullptr, viewer, hooks.log);
  auto server =
      net::Server::create(options.server, router.handlers(std::move(hooks.pages)), std::move(assets));
  if (!server) return fail(server.error());
  std::unique_ptr<ParameterServices> parameters;
  if (hooks.parameters != nullptr) {
    auto services =
        ParameterServices::create(**participant, *hooks.parameters, [&server](std::function<void()> task) {
          (*server)->run_after(std::chrono::nanoseconds{0}, std::move(task));
        });
    if (!services) return fail(services.error());
    parameters = std::move(*services);
  }
  if (hooks.on_listening) hooks.on_listening((*server)->port());
  wire::ServeSummary summary;
  {
    DriveNode driving(node, options, std::move(*participant), std::move(*topics), std::move(*publisher),
                      std::move(parameters), std::move(controller), hooks);
    summary = driving.run(stop);
    // Wait until the network thread has done the tasks of the services, which end with this block.
    std::promise<void> is_idle;
    (*server)->run_after(std::chrono::nanoseconds{0}, [&is_idle] { is_idle.set_value(); });
    is_idle.get_future().wait();
  }
  if (hooks.on_end) hooks.on_end();
  server->reset();
  return summary;
}

}  // namespace chicane::ros
