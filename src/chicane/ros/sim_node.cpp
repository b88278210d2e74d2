// SPDX-License-Identifier: MIT
// `chicane ros --simulate`: the node that simulates a car over ROS 2, with odometry, transforms, scan and
// clock.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "chicane/base/duration.hpp"
#include "chicane/base/math.hpp"
#include "chicane/protocol/car_messages.hpp"
#include "chicane/protocol/occupancy_map.hpp"
#include "chicane/ros/car_topics.hpp"
#include "chicane/ros/dds.hpp"
#include "chicane/ros/nodes.hpp"
#include "chicane/run/simulated_car.hpp"
#include "chicane/sim/range_scanner.hpp"
#include "chicane/wire/endpoint.hpp"

namespace chicane::ros {

Result<sim::OccupancyGrid> read_map(const std::string& file) {
  const Result<protocol::OccupancyMap> map = protocol::read_map(file);
  if (!map) return fail(map.error());
  sim::OccupancyGrid grid{.width = map->image.width,
                          .height = map->image.height,
                          .resolution = map->resolution,
                          .origin = {.x = map->origin.x(), .y = map->origin.y(), .psi = map->yaw}};
  grid.is_wall.reserve(map->image.values.size());
  for (int y = map->image.height - 1; y >= 0; --y)  // rows of the image begin at the top
    for (int x = 0; x < map->image.width; ++x) grid.is_wall.push_back(map->darkness(x, y) > map->occupied);
  return grid;
}

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kScanPeriod = 0.025;  // [s] period of scans, by the data sheet of the Hokuyo UST-10LX
constexpr double kTickPeriod = 0.005;  // [s] period of /clock; chosen
// Laser ahead of the rear axle, in wheelbases, by f1tenth_gym_ros.
constexpr double kScannerAhead = 0.275 / 0.307;
constexpr double kLookPeriod = 0.5;  // [s] period of looking for partners; chosen
constexpr double kRangeMin = 0.02;   // [m] least range of the laser, by its data sheet
constexpr double kRounding = 1e-9;   // [s] rounding of times

std::vector<WantedPartner> partners_of_simulator(const NodeOptions& node) {
  return {{true,
           node.topics.drive,
           std::string(protocol::DriveMessage::kType),
           {.is_reliable = false},
           "--drive-qos",
           "--drive-topic"},
          {false,
           node.topics.odom,
           std::string(protocol::OdometryMessage::kType),
           {},
           "--odom-qos",
           "--odom-topic",
           false}};
}

/// Readers and writers of the simulator; null for topics without a name.
struct SimTopics {
  std::unique_ptr<Reader> drive{}, stop_plan{}, initial_pose{};
  std::unique_ptr<Writer> odom{}, transform{}, fixed_transform{}, imu{}, scan{}, map{}, clock{};

  static Result<SimTopics> create(Participant& at, const NodeOptions& node) {
    SimTopics topics;
    Endpoints endpoints{at};
    const Qos any{.is_reliable = false};
    endpoints.read(topics.drive, node.topics.drive, protocol::DriveMessage::kType, any);
    endpoints.read(topics.stop_plan, node.topics.stop_plan, protocol::StopMessage::kType, any);
    endpoints.read(topics.initial_pose, node.topics.initial_pose, protocol::PoseMessage::kType, any);
    endpoints.send(topics.odom, node.topics.odom, protocol::OdometryMessage::kType, {});
    endpoints.send(topics.transform, "/tf", protocol::TransformsMessage::kType, {.depth = 100});
    endpoints.send(topics.fixed_transform, "/tf_static", protocol::TransformsMessage::kType,
                   {.is_transient_local = true, .depth = 1});
    endpoints.send(topics.imu, node.topics.imu, protocol::ImuMessage::kType, {});
    if (node.pace > 0.0) endpoints.send(topics.clock, "/clock", protocol::ClockMessage::kType, {});
    endpoints.send(topics.scan, node.topics.scan, protocol::ScanMessage::kType, {});
    endpoints.send(topics.map, "/map", "nav_msgs/msg/OccupancyGrid",
                   {.is_transient_local = true, .depth = 1});
    if (!endpoints.made()) return fail(endpoints.made().error());
    return topics;
  }
};

/// Map of walls: a cell is wall if a line of `walls` crosses it. `resolution`: size of cells [m].
sim::OccupancyGrid drawn(const std::vector<std::vector<Vec2>>& walls, double resolution) {
  constexpr double kMargin = 1.0;  // [m] free margin around the walls; chosen
  Vec2 low = walls.front().front(), high = low;
  for (const std::vector<Vec2>& wall : walls) {
    for (const Vec2& point : wall) {
      low = {std::min(low.x(), point.x()), std::min(low.y(), point.y())};
      high = {std::max(high.x(), point.x()), std::max(high.y(), point.y())};
    }
  }
  low -= Vec2{kMargin, kMargin};
  const Vec2 sides = high + Vec2{kMargin, kMargin} - low;
  sim::OccupancyGrid grid{.width = static_cast<int>(sides.x() / resolution),
                          .height = static_cast<int>(sides.y() / resolution),
                          .resolution = resolution,
                          .origin = {.x = low.x(), .y = low.y()}};
  grid.is_wall.resize(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  for (const std::vector<Vec2>& wall : walls) {
    for (std::size_t i = 1; i < wall.size(); ++i) {
      const Vec2 step = wall[i] - wall[i - 1];
      const int parts = 1 + static_cast<int>(2.0 * step.norm() / resolution);
      for (int part = 0; part <= parts; ++part) {
        const Vec2 at = (wall[i - 1] + (static_cast<double>(part) / parts) * step - low) / resolution;
        grid.is_wall[static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(grid.width) +
                     static_cast<std::size_t>(at.x())] = true;
      }
    }
  }
  return grid;
}

/// Walls that the laser sees: edges of the road, or walls of a map.
class Walls {
 public:
  static Result<Walls> create(const road::Track& track, double size, const std::string& map_file) {
    if (map_file.empty()) {
      auto road = sim::RangeScanner::create(track, {.spacing = std::max(0.05, 0.5 * size)});
      if (!road) return fail(road.error());
      sim::OccupancyGrid grid = drawn(road->walls(), road->options().spacing);
      return Walls(std::move(*road), std::move(grid));
    }
    auto grid = read_map(map_file);
    if (!grid) return fail(grid.error());
    auto map = sim::MapScanner::create(*grid);
    if (!map) return fail(map.error().code, map_file + ": " + map.error().message);
    return Walls(std::move(*map), std::move(*grid));
  }
  /// Message nav_msgs/msg/OccupancyGrid in the frame `frame`.
  [[nodiscard]] std::string message(std::int64_t stamp, const std::string& frame) const {
    constexpr std::int8_t kOccupied = 100, kFree = 0;
    protocol::CdrWriter to(grid_.is_wall.size() + 200);
    to.stamp_ns(stamp).text(frame).stamp_ns(stamp).put(static_cast<float>(grid_.resolution));
    to.put(grid_.width, grid_.height, grid_.origin.x, grid_.origin.y, 0.0).orientation(grid_.origin.psi);
    to.count(grid_.is_wall.size());
    for (const bool is_wall : grid_.is_wall) to.put(is_wall ? kOccupied : kFree);
    return to.bytes();
  }
  /// Ranges from the pose of the laser [m].
  void scan(const model::Pose& sensor, std::span<float> ranges) const {
    std::visit([&](const auto& scanner) { scanner.scan(sensor, ranges); }, scanner_);
  }
  [[nodiscard]] const sim::RangeScannerOptions& options() const {
    return std::visit(
        [](const auto& scanner) -> const sim::RangeScannerOptions& { return scanner.options(); }, scanner_);
  }
  /// Whether a place is wall of a map; without a map every place is free.
  [[nodiscard]] bool is_wall(const Vec2& place) const {
    const auto* map = std::get_if<sim::MapScanner>(&scanner_);
    return map != nullptr && map->is_wall(place);
  }

 private:
  template <class Scanner>
  Walls(Scanner scanner, sim::OccupancyGrid grid) : scanner_{std::move(scanner)}, grid_{std::move(grid)} {}
  std::variant<sim::RangeScanner, sim::MapScanner> scanner_;
  sim::OccupancyGrid grid_;
};

/// Simulator's node, on the thread that calls run().
class SimNode {
 public:
  SimNode(const NodeOptions& node, const scenario::Scenario& scenario, const wire::SimulateHooks& hooks,
          std::unique_ptr<Participant> participant, SimTopics topics, const Walls& walls,
          run::SimulatedCar& car)
      : node_{node},
        scenario_{scenario},
        hooks_{hooks},
        participant_{std::move(participant)},
        topics_{std::move(topics)},
        log_{hooks.log},
        walls_{walls},
        car_{car},
        stop_news_{scenario, [this](std::string_view line) { log_.say(line); }},
        partners_{partners_of_simulator(node), node.network},
        scanner_ahead_{kScannerAhead * scenario.vehicle.wheelbase()},
        pace_{node.pace > 0.0 ? node.pace : 1.0} {
    ranges_.resize(static_cast<std::size_t>(walls_.options().beams));
  }

  wire::SimulateReport run(const std::atomic<bool>& stop) {
    started_ = began_ = Clock::now();
    if (topics_.clock) next_tick_ = 0.0;
    send_scanner_place();
    static_cast<void>(topics_.map->write(walls_.message(stamp(0.0), node_.frames.map)));
    const model::State& car = car_.plant->state();
    if (walls_.is_wall({car.x, car.y})) {
      log_.say(fmt::format(
          "{}: got a wall at ({:.2f}, {:.2f}), where the car stands, expected a map of this track",
          node_.map_file, car.x, car.y));
    }
    while (!stop && !car_.account.is_over()) {
      participant_->wait(std::chrono::nanoseconds(std::max<Clock::duration>(
          std::chrono::microseconds{50}, began_ + duration(next_moment() / pace_) - Clock::now())));
      const Clock::time_point now = Clock::now();
      read_commands();
      read_initial_pose();
      if (report_.connections > 0) move(now);
      sense(now);
      look_at_partners(now);
    }
    report_.run = car_.account.summary(car_.world.time());
    report_.run.wall_time = seconds(Clock::now() - started_);
    return report_;
  }

 private:
  /// Simulated time that belongs to `now` [s].
  [[nodiscard]] double elapsed(Clock::time_point now) const { return pace_ * seconds(now - began_); }
  /// Stamp of a simulated time [ns since 1970].
  [[nodiscard]] std::int64_t stamp(double time) const {
    return epoch_ + static_cast<std::int64_t>(std::llround(1e9 * time));
  }
  /// Simulated time of the next message [s].
  [[nodiscard]] double next_moment() const { return std::min({next_odometry_, next_scan_, next_tick_}); }

  // ---- In ----

  void read_commands() {
    std::vector<Sample> drives = topics_.drive ? topics_.drive->take() : std::vector<Sample>{};
    if (topics_.stop_plan) {  // after the commands, each of which was sent after its stop plan
      for (const Sample& sample : topics_.stop_plan->take()) {
        if (auto stop = protocol::decode<protocol::StopMessage>(sample.bytes))
          stops_[stop_count_++ % stops_.size()] = *stop;
      }
    }
    for (const Sample& sample : drives) {
      const auto message = protocol::decode<protocol::DriveMessage>(sample.bytes);
      const bool is_finite = message && std::isfinite(message->steer) && std::isfinite(message->speed) &&
                             std::isfinite(message->acceleration);
      if (!is_finite) {
        ++report_.broken_answers;
        log_.complain(fmt::format("{}: got {}, expected finite numbers in a {}", node_.topics.drive,
                                  message ? "numbers that are not finite" : "other bytes",
                                  protocol::DriveMessage::kType));
        continue;
      }
      if (sample.writer != writer_) begin(sample.writer);
      accept(*message);
    }
  }

  /// Begins with another sender of commands; the first one starts the world.
  void begin(std::uint64_t writer) {
    writer_ = writer;
    if (report_.connections++ > 0) return log_.say(fmt::format("another sender on {}", node_.topics.drive));
    const double ahead = elapsed(Clock::now());
    began_ += duration(ahead / pace_);  // the world begins with the first command, and the stamps continue
    epoch_ += static_cast<std::int64_t>(std::llround(1e9 * ahead));
    next_odometry_ = next_scan_ = 0.0;
    if (topics_.clock) next_tick_ = 0.0;
    log_.say(fmt::format("first command on {}", node_.topics.drive));
  }

  /// Queues a command. Its wanted speed or acceleration stands in for the pedal, which depends on the speed
  /// at which the command acts.
  void accept(const protocol::DriveMessage& message) {
    ++report_.answers;
    const double time = car_.world.time();
    const double act =
        std::max(time + scenario_.latency + sim::random_delay(scenario_.seed, time, scenario_.latency_jitter),
                 car_.in_flight.last_time());
    car_.in_flight.push(act, {.steer = message.steer,
                              .throttle = node_.drive.is_by_speed ? message.speed : message.acceleration});
    safety::StopPlan stop;
    for (const protocol::StopMessage& each : stops_) {
      if (each.stop.size == 0 || each.stamp != message.stamp) continue;
      stop = each.stop;
      const double asked = 1e-9 * static_cast<double>(each.stamp - epoch_);
      for (int i = 0; i < stop.size; ++i) stop.points[static_cast<std::size_t>(i)].time += asked;
    }
    car_.receiver.arrived(act, stop);
    arrived_ = time;
    frame_.result.command.steer = message.steer;
    frame_.step_time = time - 1e-9 * static_cast<double>(message.stamp - epoch_);
  }

  void read_initial_pose() {
    if (!topics_.initial_pose) return;
    for (const Sample& sample : topics_.initial_pose->take()) {
      const auto message = protocol::decode<protocol::PoseMessage>(sample.bytes);
      if (!message) continue;
      const double b = node_.is_base_at_rear_axle ? scenario_.vehicle.rear_axle : 0.0;
      const model::Pose& base = message->pose;
      const model::Pose centre{base.x + b * chicane::cos(base.psi), base.y + b * chicane::sin(base.psi),
                               base.psi};
      car_.world.put(centre);
      car_.plant->reset(centre, 0.0);
      car_.account.resume();
      log_.say(fmt::format("{}: the car is at ({:.2f}, {:.2f})", node_.topics.initial_pose, base.x, base.y));
    }
  }

  // ---- Physics ----

  /// Physics up to now. Reports stops and laps.
  void move(Clock::time_point now) {
    const double speed = car_.speed();
    const double forgotten = car_.catch_up(elapsed(now), [this] { return act(); });
    began_ += duration(forgotten / pace_);
    epoch_ += static_cast<std::int64_t>(std::llround(1e9 * forgotten));
    const double silence = car_.world.time() - arrived_;
    const bool is_timed_out =
        car_.receiver.is_stopping() && silence > safety::StopPlayer::kPatience + scenario_.latency;
    const auto why = [&] { return fmt::format("nothing on {} for {:.1f} s", node_.topics.drive, silence); };
    if (stop_news_.look(car_, is_timed_out, speed, why)) ++report_.stops;
    if (const auto lap = car_.account.take_lap(); lap && hooks_.on_lap) hooks_.on_lap(*lap);
  }

  /// Command of the actuators in the next physics step.
  model::Command act() {
    model::Command command = car_.in_flight.at(car_.world.time() + kRounding);
    command.throttle = throttle_of(scenario_.vehicle, command.throttle, car_.speed(), node_.drive);
    applied_ = car_.receiver.guard(command, car_.world.time(), car_.speed());
    return applied_;
  }

  // ---- Out ----

  /// Sends the messages that are due.
  void sense(Clock::time_point now) {
    const double time = report_.connections > 0 ? car_.world.time() : elapsed(now);
    if (topics_.clock && time + kRounding >= next_tick_) {
      next_tick_ = std::max(next_tick_ + kTickPeriod, time);
      static_cast<void>(topics_.clock->write(protocol::encode(protocol::ClockMessage{stamp(time)})));
    }
    if (time + kRounding >= next_odometry_) {
      next_odometry_ = std::max(next_odometry_ + scenario_.control_period, time);
      send_odometry(time);
    }
    if (time + kRounding < next_scan_) return;
    next_scan_ = std::max(next_scan_ + kScanPeriod, time);
    if (topics_.scan && topics_.scan->matched() > 0) send_scan(time);
  }

  void send_odometry(double time) {
    const model::Measurement seen = car_.sense(0);
    const model::State& state = car_.plant->state();
    const double b = node_.is_base_at_rear_axle ? scenario_.vehicle.rear_axle : 0.0;
    const model::Pose base{seen.x - b * chicane::cos(seen.psi), seen.y - b * chicane::sin(seen.psi),
                           seen.psi};
    if (topics_.odom) {
      static_cast<void>(topics_.odom->write(
          protocol::encode(protocol::OdometryMessage{.stamp = stamp(time),
                                                     .frame = node_.frames.map,
                                                     .child_frame = node_.frames.base,
                                                     .pose = base,
                                                     .vx = state.vx + seen.speed - car_.speed(),
                                                     .vy = state.vy - b * state.r,
                                                     .yaw_rate = state.r})));
    }
    static_cast<void>(topics_.transform->write(protocol::encode(
        protocol::TransformsMessage{{{stamp(time), node_.frames.map, node_.frames.base, base}}})));
    if (topics_.imu && topics_.imu->matched() > 0) {
      static_cast<void>(
          topics_.imu->write(protocol::encode(protocol::ImuMessage{.stamp = stamp(time),
                                                                   .frame = node_.frames.base,
                                                                   .yaw_rate = state.r,
                                                                   .ax = car_.plant->output().ax,
                                                                   .ay = car_.plant->output().ay})));
    }
    if (report_.connections > 0) record(seen);
  }

  /// Counts a cycle: the state of the world, with the last command as the answer.
  void record(const model::Measurement& seen) {
    car_.write(seen, applied_, frame_);
    frame_.result.command.throttle = applied_.throttle;
    car_.count(frame_);
    if (hooks_.on_frame) hooks_.on_frame(frame_);
  }

  void send_scanner_place() {
    static_cast<void>(topics_.fixed_transform->write(protocol::encode(protocol::TransformsMessage{
        {{stamp(0.0), node_.frames.base, scanner_frame(), {.x = scanner_ahead_}}}})));
  }

  /// Frame of the laser: "ego_racecar/base_link" → "ego_racecar/laser".
  [[nodiscard]] std::string scanner_frame() const {
    const std::size_t slash = node_.frames.base.rfind('/');
    return (slash == std::string::npos ? "" : node_.frames.base.substr(0, slash + 1)) + "laser";
  }

  void send_scan(double time) {
    const model::State& car = car_.plant->state();
    const double ahead = scanner_ahead_ - scenario_.vehicle.rear_axle;
    walls_.scan({car.x + ahead * chicane::cos(car.psi), car.y + ahead * chicane::sin(car.psi), car.psi},
                ranges_);
    protocol::ScanMessage message{.stamp = stamp(time),
                                  .frame = scanner_frame(),
                                  .angle_min = walls_.options().first_angle(),
                                  .angle_increment = walls_.options().increment(),
                                  .scan_time = kScanPeriod,
                                  .range_min = kRangeMin,
                                  .range_max = walls_.options().range_max,
                                  .ranges = ranges_};
    static_cast<void>(topics_.scan->write(protocol::encode(message)));
  }

  void look_at_partners(Clock::time_point now) {
    if (seconds(now - looked_) < kLookPeriod) return;
    looked_ = now;
    const std::vector<int> matched{topics_.drive ? topics_.drive->matched() : 0,
                                   topics_.odom ? topics_.odom->matched() : 0};
    const std::vector<Endpoint> others = participant_->others();
    participant_->announce("chicane_simulator");
    for (const std::string& line : partners_.look(seconds(now - started_), others, matched)) log_.say(line);
  }

  const NodeOptions& node_;
  const scenario::Scenario& scenario_;
  const wire::SimulateHooks& hooks_;
  std::unique_ptr<Participant> participant_;
  SimTopics topics_;
  wire::SparseLog log_;
  const Walls& walls_;
  run::SimulatedCar& car_;  ///< its commands in flight hold the wanted speed or acceleration as throttle
  run::StopNews stop_news_;
  PartnerWatch partners_;
  wire::SimulateReport report_;
  telemetry::Frame frame_;

  const double scanner_ahead_;                    ///< distance ahead of the rear axle [m]
  const double pace_;                             ///< seconds simulated in a second of the clock
  std::vector<float> ranges_;                     ///< ranges of the last scan [m]
  std::array<protocol::StopMessage, 8> stops_{};  ///< ring of the newest stop plans; size chosen
  std::size_t stop_count_ = 0;                    ///< stop plans so far
  std::uint64_t writer_ = 0;                      ///< writer of the commands; 0: none yet
  Clock::time_point started_{}, looked_{};        ///< times of the start, and of the last look for partners
  Clock::time_point began_{};                     ///< time of the clock at the simulated time 0
  std::int64_t epoch_ = std::chrono::duration_cast<std::chrono::nanoseconds>(
                            std::chrono::system_clock::now().time_since_epoch())
                            .count();                           ///< simulated time 0 [ns since 1970]
  double next_odometry_ = 0.0, next_scan_ = 0.0;                ///< times of the next messages [s]
  double next_tick_ = std::numeric_limits<double>::infinity();  ///< time of the next /clock message [s]
  double arrived_ = 0.0;                                        ///< time of the last command's arrival [s]
  model::Command applied_;                                      ///< command of the last physics step
};

}  // namespace

Result<wire::SimulateReport> simulate(const NodeOptions& node, const scenario::Scenario& scenario,
                                      const wire::SimulateHooks& hooks, const std::atomic<bool>& stop) {
  const auto car = run::SimulatedCar::create(scenario, scenario.latency);
  if (!car) return fail(car.error());
  const auto walls = Walls::create((*car)->track, scenario.vehicle.scale, node.map_file);
  if (!walls) return fail(walls.error());
  auto participant = Participant::create(node.network);
  if (!participant) return fail(participant.error());
  auto topics = SimTopics::create(**participant, node);
  if (!topics) return fail(topics.error());
  return SimNode(node, scenario, hooks, std::move(*participant), std::move(*topics), *walls, **car).run(stop);
}

}  // namespace chicane::ros
