// SPDX-License-Identifier: MIT
// A healthy car whose measurements agree moves again: whatever its simulator's clock, whatever put it
// elsewhere, whatever fault has ended (docs/safety.md, "The conditions").
#include <fmt/format.h>

#include <ostream>

#include "chicane/base/math.hpp"
#include "chicane/base/random.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/external_drive.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/simulated_car.hpp"
#include "chicane/sim/fault.hpp"
#include "chicane/sim/sensor.hpp"
#include "chicane/sim/world.hpp"
#include "closed_loop/drive.hpp"

namespace chicane::run {
namespace {

constexpr double kAgain = 10.0;    // [s] after which a car has to move
constexpr double kMoves = 1.0;     // [m/s] a car that is led back walks
constexpr double kRolls = 0.5;     // [m/s] slower, it stands
constexpr double kDrivesOn = 5.0;  // [s] of driving, after which a car is not waited for
constexpr double kCycle = 0.12;    // [s] of the wall's clock from telemetry to telemetry

enum class Event { kNone, kHandedBack, kReset, kPutElsewhere, kMoved1, kMoved3, kMoved10, kMoved70 };
constexpr const char* kEventNames[] = {"none",    "handed_back", "reset",    "put_elsewhere",
                                       "moved_1", "moved_3",     "moved_10", "moved_70"};
enum class Jitter { kNone, kThird, kBursts };
constexpr const char* kJitterNames[] = {"steady", "jitter", "bursts"};

struct Cell {
  double ratio = 1.0;  ///< of the simulator's clock to the wall's
  Jitter jitter = Jitter::kNone;
  Event event = Event::kNone;
  bool is_guarded = true;
  const char* preset = "default";
};
std::ostream& operator<<(std::ostream& out, const Cell& cell) {
  return out << cell.preset << (cell.is_guarded ? "" : " without guard") << ", clock " << cell.ratio << ' '
             << kJitterNames[static_cast<std::size_t>(cell.jitter)] << ", "
             << kEventNames[static_cast<std::size_t>(cell.event)];
}

/// The original's client, with a clock of its own, and a virtual one of the wall.
class Client {
 public:
  explicit Client(const Cell& cell)
      : cell_{cell},
        scenario_{*protocol::compose({.scenario_file = "",
                                      .settings = {{"preset", cell.preset},
                                                   {"track", "lakeside"},
                                                   {"guard.mode", cell.is_guarded ? "on" : "off"},
                                                   {"guard.road", "waypoints"}}})},
        track_{*make_track(scenario_)},
        waypoints_{*make_waypoints(track_)},
        plant_{std::move(*make_plant(scenario_))},
        world_{*plant_, track_},
        drive_{{.scenario = scenario_, .clock = {.is_estimated = true}},
               std::move(*make_controller(scenario_)),
               hooks_} {
    world_.place(track_.start_s(), track_.start_d());
    drive_.begin();
  }

  /// Telemetry, its answer, and the simulator's time until the next one.
  void turn() {
    const model::State& car = plant_->state();
    model::Measurement now{.x = car.x, .y = car.y, .psi = car.psi, .speed = plant_->output().speed};
    sim::select_waypoints(waypoints_, {.x = now.x, .y = now.y, .psi = now.psi}, scenario_.waypoints_sent,
                          now);
    const model::Command answer =
        drive_.step({.received = wall(), .measured = now, .delay = kCycle, .usual_delay = kCycle})
            .result.command;
    drive_.finish();
    double cycle = kCycle;
    if (cell_.jitter == Jitter::kThird) cycle *= chance_.uniform(0.7, 1.3);
    if (cell_.jitter == Jitter::kBursts && ++cycles_ % 20 == 0) cycle += 0.3;
    wait(cycle, acting_);
    acting_ = answer;
    stood_ = speed() < kMoves ? stood_ + cell_.ratio * cycle : 0.0;
    longest_ = std::max(longest_, stood_);
  }
  /// The same for `time` [s] of the simulator.
  void drive(double time) {
    for (const double end = time_ + time; time_ < end;) turn();
  }
  void happen(Event event) {
    constexpr double kAhead[] = {0.0, 70.0, 0.0, 200.0, 1.0, 3.0, 10.0, 70.0};  // [m]
    if (event == Event::kNone) return;
    const bool is_reset = event == Event::kReset, is_handed_back = event == Event::kHandedBack;
    if (is_handed_back) {
      drive_.begin_anew();
      wall_ += 3.0;
      simulated_ = time_ += 3.0 * cell_.ratio;
    }
    const double s = world_.state().s;
    const double ahead = is_reset ? track_.start_s() - s : kAhead[static_cast<std::size_t>(event)];
    move(ahead, is_reset ? 0.0 : event == Event::kPutElsewhere ? 10.0 : speed());
    if (!is_handed_back) return;
    // By a person who kept to the road: who lets go of the wheel in a bend leaves it before the first answer.
    model::State car = plant_->state();
    const double curvature = track_.centre().at(s + ahead).curvature;
    car.r = car.vx * curvature;
    world_.reset(car);
    acting_ = {atan(scenario_.vehicle.wheelbase() * curvature), 0.0};
  }
  [[nodiscard]] double speed() const { return plant_->output().speed; }
  void forget_standing() { stood_ = longest_ = 0.0; }
  [[nodiscard]] double stood() const { return longest_; }  ///< longest, simulator's time [s]
  [[nodiscard]] double least_edge() const { return least_edge_; }
  [[nodiscard]] const telemetry::Frame& frame() const { return drive_.frame(); }

 private:
  [[nodiscard]] ExternalDrive::Clock::time_point wall() const {
    return start_ + std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * wall_));
  }
  void wait(double cycle, const model::Command& command) {
    wall_ += cycle;
    time_ += cell_.ratio * cycle;
    while (simulated_ + plant_->step_length() <= time_) {
      world_.advance(command);
      simulated_ += plant_->step_length();
      least_edge_ = std::min(least_edge_, world_.state().edge_distance);
    }
  }
  /// Along the road, as far beside its line, as far off its course, and turning as before.
  void move(double ahead, double speed) {
    const double s = world_.state().s;
    const road::PathPoint from = track_.centre().at(s), to = track_.centre().at(s + ahead);
    model::State car = plant_->state();
    const double beside = speed > 0.0 ? world_.state().lateral_error : 0.0;
    const double share = car.vx > 0.0 ? speed / car.vx : 0.0;
    car.x = to.position.x() - beside * std::sin(to.heading);
    car.y = to.position.y() + beside * std::cos(to.heading);
    car.psi = to.heading + (speed > 0.0 ? angle_difference(car.psi, from.heading) : 0.0);
    car.vx *= share;
    car.vy *= share;
    car.r *= share;
    world_.reset(car);
  }

  Cell cell_;
  scenario::Scenario scenario_;
  road::Track track_, waypoints_;
  std::unique_ptr<sim::Plant> plant_;
  sim::World world_;
  ExternalDriveHooks hooks_;
  ExternalDrive drive_;
  Random chance_{5};
  model::Command acting_;
  const ExternalDrive::Clock::time_point start_ = ExternalDrive::Clock::now();
  double wall_ = 0.0, time_ = 0.0, simulated_ = 0.0;  ///< [s]
  double stood_ = 0.0, longest_ = 0.0;                ///< [s]
  double least_edge_ = std::numeric_limits<double>::infinity();
  int cycles_ = 0;
};

std::vector<Cell> cells() {
  std::vector<Cell> all;
  for (const char* preset : {"default", "weighted", "pid", "race"})
    for (const bool is_guarded : {true, false})
      for (const Jitter jitter : {Jitter::kNone, Jitter::kThird, Jitter::kBursts})
        for (const double ratio : {0.2, 0.5, 0.8, 1.0, 1.25, 2.0, 5.0})
          for (int event = 0; event < 8; ++event)
            all.push_back({ratio, jitter, static_cast<Event>(event), is_guarded, preset});
  if (kDrivesAll) return all;
  std::vector<Cell> some;
  for (std::size_t i = 5; i < all.size(); i += 83) some.push_back(all[i]);
  return some;
}

/// A simulator that is fast does not wait: at 2 and 5 times the wall's clock its car drives on for 0.8 s and
/// more with a command, and for longer where the answer bursts. No controller here drives that.
bool is_drivable(const Cell& cell) {
  constexpr double kLate[] = {0.0, 0.3 * kCycle, 0.3};
  const double longest = cell.ratio * (kCycle + kLate[static_cast<std::size_t>(cell.jitter)]);
  return longest < (cell.is_guarded ? 0.7 : 0.4);
}

/// The whole matrix counts cells: a car may be slow in its last moment, and one that is shown elsewhere while
/// it stands drives on with its wheels turned.
TEST(MovesAgain, WhateverTheSimulatorsClockAndWhereverTheCarIsPut) {
  std::ostringstream bad;
  int driven = 0, count = 0;
  for (const Cell& cell : cells()) {
    if (!is_drivable(cell)) continue;
    Client client(cell);
    client.drive(14.0);
    client.forget_standing();
    client.happen(cell.event);
    client.drive(24.0);
    // A place that jumps while the car drives is a lie until it is tried.
    const bool keeps_road = cell.is_guarded && cell.event < Event::kPutElsewhere;
    ++driven;
    if (client.stood() < kAgain && client.speed() > kRolls && !(keeps_road && client.least_edge() <= 0.0))
      continue;
    ++count;
    bad << '\n'
        << cell << ": stood " << client.stood() << " s, edge " << client.least_edge() << " m, "
        << controller::word_of(client.frame().guard.reason).sentence;
  }
  EXPECT_LE(count, kDrivesAll ? driven / 200 : 0) << driven << " cells" << bad.str();
}

/// The receiver brakes for one command that does not arrive. The original car keeps that brake below 5 mph.
TEST(MovesAgain, WithABrakeThatStaysOnWhileItDrives) {
  scenario::Scenario scenario = *protocol::compose({});
  scenario.faults = {{.fault = *sim::fault_named("dead_controller"), .at = 0.8, .duration = 0.1}};
  const auto loop = std::move(*ClosedLoop::create(scenario));
  while (loop->time() < 4.0) loop->advance();
  EXPECT_GT(loop->frame().truth.vx, 10.0) << "without a release it rolls at 2.3 to 0.4 m/s for 8 s";
}

/// A short run of a car that is configured right, with faults that end.
struct FaultRun {
  std::string preset, car, track;
  double mass_scale;
  std::string_view fault;
  double at, lasts;            // [s]
  std::string_view also = "";  // another fault at the same time
  double grip_scale = 1.0;
};

struct Standing {
  double time = 0.0;     ///< longest time that the car stands on its road after its fault [s]
  std::string why{};     ///< reason and place at the end of it
  bool can_turn = true;  ///< can_turn()
};

/// Whether the standing car of `loop` gets along its road with all tyres inside the kerbs, at walking pace
/// with its wheels at full lock to either side: by the plant itself, so that no model of a turning circle is
/// assumed.
bool can_turn(const ClosedLoop& loop) {
  const scenario::Scenario& scenario = loop.scenario();
  const model::VehicleParams& car = scenario.vehicle;
  const double pace = std::sqrt(car.scale);  // [m/s]
  const double inside = std::min(loop.track().kerb_width(), loop.frame().edge_distance);
  for (const double lock : {-car.steer_limit, car.steer_limit}) {
    const auto plant = std::move(*make_plant(scenario));
    sim::World world(*plant, loop.track());
    world.reset({.x = loop.car().x, .y = loop.car().y, .psi = loop.car().psi}, 0.0);
    while (world.time() < 60.0 && world.state().edge_distance > inside - 1e-6) {
      if (std::fabs(world.state().heading_error) < 0.02) return true;
      const double v = plant->state().vx;
      const bool turns =
          world.time() < 5.0 && std::fabs(plant->state().steer - lock) > 0.02 * car.steer_limit;
      const double rest = car.latches_brakes() ? car.brake_release_throttle : 0.0;
      world.advance({lock, turns ? rest : throttle_for(car, 2.5 * std::max(pace - v, 0.0) / pace, v)});
    }
  }
  return false;
}

Standing stands_after(const FaultRun& run) {
  auto scenario = *protocol::compose(
      {.scenario_file = "",
       .settings = {{"preset", run.preset}, {"car", run.car}, {"track", run.track}, {"laps", "0"}}});
  scenario.vehicle.mass *= run.mass_scale;
  scenario.vehicle.friction *= run.grip_scale;
  for (const std::string_view name : {run.fault, run.also})
    if (const auto one = sim::fault_named(name)) scenario.faults.push_back(sim::default_event(*one, run.at));
  for (sim::FaultEvent& event : scenario.faults) event.duration = run.lasts;
  auto made = ClosedLoop::create(scenario);
  if (!made) return {};  // its road is too narrow for it
  const auto loop = std::move(*made);
  const double ended = run.at + run.lasts;
  Standing longest;
  double stands_since = ended, stood_at = ended;
  const double rolls = kRolls * std::sqrt(scenario.vehicle.scale);
  while (loop->time() < ended + 20.0 && loop->time() < stood_at + kDrivesOn && !loop->is_over()) {
    loop->advance();
    const telemetry::Frame& now = loop->frame();
    const bool rests = std::hypot(now.truth.vx, now.truth.vy) <= rolls;
    if (rests || loop->time() < ended) stood_at = loop->time();
    // Beside its road a person fetches it.
    if (!rests || loop->time() < ended || now.edge_distance < 0.0) stands_since = loop->time();
    if (loop->time() - stands_since <= longest.time) continue;
    longest = {loop->time() - stands_since,
               fmt::format("{}, {:.1f} m inside, {:.1f} rad", controller::word_of(now.guard.reason).name,
                           now.edge_distance, now.heading_error)};
  }
  if (longest.time > kAgain) longest.can_turn = can_turn(*loop);
  return longest;
}

/// Causes of standing for ever: late beside a place in doubt; across its road after a slide; in wait for a
/// lock that its wheels do not reach; between a way back and a stop that turn its wheels in turn; across a
/// hairpin, nearer to the edge than it takes to turn by the tangent of its lock, without any fault; beside
/// the edge of a bend, where the gentle way to the line leads over it; after a trial in which its speed was
/// not measured. It gave up an arc that it had begun two millimetres too near to the edge; its turning was
/// judged by an angle that its wheels had only later; a trial of its speed wanted a metre of room. Wheels
/// that a stop has locked on ice get grip again, those of the original with the brake that it keeps.
TEST(MovesAgain, FromWhereItStood) {
  for (const FaultRun& run :
       {FaultRun{"pid", "vw-vanagon", "oval", 0.902734, "gps_noise", 4.350844, 1.0},
        {"sixty-mph", "vw-vanagon", "hairpins", 1.144555, "half_grip", 8.07, 5.0},
        {"pid", "bmw-320i", "oval", 0.892637, "steering_stuck", 5.112047, 5.0},
        {"sixty-mph", "bmw-320i", "hairpins", 1.080957, "throttle_stuck", 20.5398, 2.0},
        {"sixty-mph", "vw-vanagon", "hairpins", 0.983686, "slow_solver", 4.0, 0.3},
        {"sixty-mph", "bmw-320i", "hairpins", 0.839345, "slow_solver", 4.0, 0.3},
        {"pid", "f1tenth", CHICANE_TRACKS "f1tenth_centerline.csv", 1.0, "link_lost", 5.0, 2.0},
        {"weighted", "formula-student", "speedway", 1.0, "speed_sensor_zero", 5.0, 5.0},
        {"measured-latency", "f1tenth", CHICANE_TRACKS "f1tenth_centerline.csv", 0.890, "command_dropped",
         11.59, 5.0, "", 1.120},
        {"weighted", "vw-vanagon", CHICANE_TRACKS "course.geojson", 1.070941, "dead_controller", 9.046654,
         0.3, "", 1.092472},
        {"pid", "tum-1200", CHICANE_TRACKS "course.xodr", 0.974118, "speed_sensor_zero", 10.630399, 2.0, "",
         0.967505},
        {"default", "udacity", "lakeside", 1.0, "ice_patch", 8.0, 5.0, "link_lost"},
        {"default", "road-car", "oval", 1.0, "ice_patch", 8.0, 5.0, "link_lost"}}) {
    const Standing standing = stands_after(run);
    EXPECT_LT(standing.time, kAgain) << run.car << " on " << run.track << ", " << run.fault << ": "
                                     << standing.why;
  }
}

/// Separated by spaces.
std::vector<std::string> words(const std::string& text) {
  std::istringstream all(text);
  return {std::istream_iterator<std::string>(all), {}};
}

FaultRun draw(Random& chance) {
  const auto pick = [&](const auto& names) { return names[chance.bits() % std::size(names)]; };
  static const auto kRoads = words(
      "lakeside original-lake oval hairpins speedway stage utm.csv clockwise.csv course.xodr course.geojson "
      "course.kml course.osm cones.csv cones.sdf fssim.yaml three_laps.gpx tum_centre_line.csv "
      "matlab_writetable.csv");
  static const auto kCars = words("udacity road-car bmw-320i vw-vanagon indy formula-student tum-1200");
  static const auto kNarrowRoads = words(
      "oval hairpins lakeside speedway f1tenth_centerline.csv gym_waypoints.csv ../maps/ring.yaml "
      "../maps/oval.yaml ../maps/bean.yaml ../maps/clover.yaml ../maps/chicane.yaml ../maps/hairpins.yaml "
      "../maps/long.yaml ../maps/turned.yaml ../maps/corridors.yaml");
  static const auto kModelCars = words("f1tenth orca-1-43");
  static const auto kPresets = words(
      "default default pid measured-latency sixty-mph weighted stanley delay-in-model fast-short-step "
      "pure-pursuit");
  static constexpr double kLasts[] = {0.3, 1.0, 2.0, 5.0};
  const bool is_small = chance.uniform() < 0.25;
  const std::string track = is_small ? pick(kNarrowRoads) : pick(kRoads);
  FaultRun run{pick(kPresets),
               is_small ? pick(kModelCars) : pick(kCars),
               track.find('.') != std::string::npos ? CHICANE_TRACKS + track : track,
               chance.uniform(0.8, 1.2),
               pick(sim::fault_kinds()).name,
               chance.uniform(4.0, 12.0),
               pick(kLasts),
               chance.uniform() < 0.3 ? pick(sim::fault_kinds()).name : ""};
  run.grip_scale = chance.uniform(0.85, 1.15);
  return run;
}

/// Other runs: --gtest_random_seed=N. Cars that face the edge nearer than they turn count apart: there is no
/// reverse gear. The large search counts how many others stand, the sample must have none.
TEST(MovesAgain, AfterAFaultThatHasEnded) {
  Random chance(58 + static_cast<std::uint64_t>(testing::GTEST_FLAG(random_seed)));
  constexpr int kRuns = kDrivesAll ? 20'000 : 4, kMost = kDrivesAll ? kRuns / 200 : 0;
  int stood = 0, faces_edge = 0;
  std::string which;
  for (int i = 0; i < kRuns; ++i) {
    const FaultRun run = draw(chance);
    const Standing standing = stands_after(run);
    if (standing.time <= kAgain) continue;
    ++(standing.can_turn ? stood : faces_edge);
    if (!standing.can_turn) continue;
    which += fmt::format("\nrun {}: {} {} on {}, {} from {:.1f} s: {:.0f} s, {}", i, run.preset, run.car,
                         run.track, run.fault, run.at, standing.time, standing.why);
  }
  EXPECT_LE(stood, kMost) << faces_edge << " others face the edge nearer than they turn" << which;
  EXPECT_LE(faces_edge, kDrivesAll ? kRuns / 50 : 0);
}

}  // namespace
}  // namespace chicane::run
