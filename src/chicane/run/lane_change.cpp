// SPDX-License-Identifier: MIT
// Double lane change of ISO 3888-2: the course, the line through it, and the search for the fastest entry.
#include "chicane/run/lane_change.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "chicane/base/math.hpp"
#include "chicane/controller/registry.hpp"
#include "chicane/lap_time/racing_plan.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/control_cycle.hpp"
#include "chicane/run/racing.hpp"

namespace chicane::run {
namespace {

// Numbers of the course: docs/measured/racing.md, "The severe double lane change". All others are chosen.
constexpr double kGap = 1.0;        // [m] between entry and side lane, by the standard
constexpr double kIntoEntry = 3.0;  // [m] length of the entry lane's end in which way() already turns
constexpr double kIntoSide = 5.0;   // [m] length of each end of the side lane in which way() turns
constexpr double kIntoExit = 4.0;   // [m] length of the exit lane's beginning in which way() still turns
constexpr double kBeside = 6.0;     // [m] width of the road to each side of the line where there are no cones
constexpr double kReach = 1.0;  // [m] length of a lane's edges beyond its cones: the body beyond its axles
constexpr double kFarPoints = 20.0;  // [m] between points of the road before and behind the course
constexpr double kEdgePoints = 0.5;  // [m] between points of the road in the course
constexpr double kOutline = 0.25;    // [m] between points of the body's sides

/// Smooth step from 0 to 1 with no slope and no curvature at its ends.
double blend(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

// Distance behind the entry at which the throttle is released, by the standard [m].
constexpr double kReleased = 2.0;
constexpr double kWayStep = 5.0 / 3.6;  // [m/s] between speeds for which lines are planned
constexpr double kUsedRoom = 0.2;   // share of the space beside the body in the entry lane that the line uses
constexpr double kPlanStep = 0.04;  // [s] mean time between nodes of a plan
constexpr double kStopping = 10.0;  // [m/s²] braking at the end of the road, which no car reaches
constexpr double kShown = 6.0;      // [m] width of the road beside the waypoints
constexpr double kWaypoints = 3.0;  // [m] between waypoints in the course
constexpr double kFarWaypoints = 20.0;  // [m] between waypoints before and behind the course
constexpr double kSpeedGain = 2.0;      // [1/s] acceleration over speed error before the entry
constexpr double kNoPedal = 0.01;    // [m/s²] largest drive and braking in the controller's model: no pedals
constexpr double kMostTime = 60.0;   // [s] longest run
constexpr double kHasStopped = 1.0;  // [m/s] speed below which a run has failed and ends

/// Driver of the course: holds the speed, then releases the throttle. The controller under test steers.
class ReleasesThrottle final : public controller::Controller {
 public:
  ReleasesThrottle(std::unique_ptr<Controller> driver, const model::VehicleParams& vehicle, double speed)
      : driver_(std::move(driver)), vehicle_(vehicle), speed_(speed) {}
  [[nodiscard]] const controller::StepResult& step(const model::Measurement& now,
                                                   Deadline deadline) noexcept override {
    result_ = driver_->step(now, deadline);
    result_.command.throttle =
        now.x > kReleased ? 0.0 : throttle_for(vehicle_, kSpeedGain * (speed_ - now.speed), now.speed);
    return result_;
  }
  void note_sent(const model::Command& command) noexcept override { driver_->note_sent(command); }
  void use_line(std::shared_ptr<const road::RacingRoad> lap) noexcept override {
    driver_->use_line(std::move(lap));
  }
  void reset() noexcept override { driver_->reset(); }
  [[nodiscard]] std::string_view name() const noexcept override { return driver_->name(); }

 private:
  std::unique_ptr<Controller> driver_;
  model::VehicleParams vehicle_;
  double speed_;
  controller::StepResult result_;
};

/// Gap of the tyres to the cones when the body uses kUsedRoom of its space [m].
double margin_of(const model::VehicleParams& car) {
  const LaneChangeCourse::Lane entry = LaneChangeCourse(car.width).lanes()[0];
  const double beside_tyres = 0.5 * (entry.left - entry.right - car.track_width - car.tire_width);
  const double beside_body = 0.5 * (entry.left - entry.right - car.width);
  return beside_tyres - kUsedRoom * beside_body;
}

/// Copy of `driven` for the course: without laps, time limit, faults and guard.
scenario::Scenario on_course(const scenario::Scenario& driven) {
  scenario::Scenario scenario = endless(driven);
  scenario.guard.mode = safety::GuardMode::kOff;
  std::get<controller::TrackingMpcEntry::Options>(scenario.controllers).edge_margin =
      margin_of(scenario.vehicle);
  return scenario;
}

/// Drives through the course, and measures speeds and the room to the cones.
LaneChangeOutcome outcome_of(ClosedLoop& loop, const LaneChangeCourse& course,
                             const model::VehicleParams& vehicle) {
  LaneChangeOutcome outcome;
  const double to_middle = 0.5 * (vehicle.front_axle - vehicle.rear_axle);
  while (loop.time() < kMostTime) {
    (void)loop.advance();
    const model::State& car = loop.car();
    const double speed = hypot(car.vx, car.vy);
    if (outcome.entry_speed == 0.0 && car.x >= 0.0) outcome.entry_speed = speed;
    const model::Pose middle{car.x + to_middle * cos(car.psi), car.y + to_middle * sin(car.psi), car.psi};
    outcome.room = std::min(outcome.room, course.room(middle, vehicle.length, vehicle.width));
    if (speed < kHasStopped) break;
    if (car.x < LaneChangeCourse::kLength + 0.5 * vehicle.length) continue;
    outcome.exit_speed = speed;
    break;
  }
  return outcome;
}

/// Waypoints of the line as telemetry shows them.
Result<road::Track> waypoints_on(const road::ReferenceLine& way) {
  std::vector<road::TrackPoint> points;
  for (double s = 0.0; s < way.length();) {
    const Vec2 position = way.at(s).position;
    points.push_back({position, kShown, kShown});
    const bool is_in_course = position.x() > -kFarWaypoints && position.x() < LaneChangeCourse::kLength;
    s += is_in_course ? kWaypoints : kFarWaypoints;
  }
  return road::Track::create("double lane change", points, false);
}

}  // namespace

LaneChangeCourse::LaneChangeCourse(double width) noexcept {
  const double entry = 1.1 * width + 0.25;
  const double side = width + 1.0;
  const double exit = std::max(1.3 * width + 0.25, 3.0);
  const double shift = 0.5 * entry + kGap;
  lanes_ = {Lane{0.0, 12.0, -0.5 * entry, 0.5 * entry}, Lane{25.5, 36.5, shift, shift + side},
            Lane{49.0, kLength, -0.5 * exit, 0.5 * exit}};
}

double LaneChangeCourse::way(double x) const noexcept {
  const auto [entry, side, exit] = lanes_;
  const auto rise = [&](double from, double to) { return blend((x - from) / (to - from)); };
  const double shift = 0.5 * (side.right + side.left);
  return shift * (rise(entry.end - kIntoEntry, side.begin + kIntoSide) -
                  rise(side.end - kIntoSide, exit.begin + kIntoExit));
}

double LaneChangeCourse::room(const model::Pose& car, double length, double width) const noexcept {
  const double cosine = cos(car.psi), sine = sin(car.psi);
  double least = std::numeric_limits<double>::infinity();
  const int count = std::max(2, static_cast<int>(std::ceil(length / kOutline)));
  for (int i = 0; i <= count; ++i) {
    const double along = length * (static_cast<double>(i) / count - 0.5);
    for (const double across : {-0.5 * width, 0.5 * width}) {
      const double x = car.x + along * cosine - across * sine;
      const double y = car.y + along * sine + across * cosine;
      for (const Lane& lane : lanes_)
        if (x >= lane.begin && x <= lane.end) least = std::min({least, lane.left - y, y - lane.right});
    }
  }
  return least;
}

Result<road::Track> LaneChangeCourse::road() const {
  std::vector<road::TrackPoint> points;
  const auto add = [&](double from, double to, double apart) {
    const int count = static_cast<int>(std::lround((to - from) / apart));
    for (int i = 0; i < count; ++i) {
      const double x = from + i * (to - from) / count;
      road::TrackPoint point{{x, way(x)}, kBeside, kBeside};
      if (x < 0.0) point = {{x, 0.0}, lanes_[0].left, -lanes_[0].right};
      for (const Lane& lane : lanes_) {
        if (x < lane.begin - kReach || x > lane.end + kReach) continue;
        point.left = lane.left - way(x);
        point.right = way(x) - lane.right;
      }
      points.push_back(point);
    }
  };
  add(-kRunUp, 0.0, kFarPoints);
  add(0.0, kLength, kEdgePoints);
  add(kLength, kLength + kRunOut, kFarPoints);
  return road::Track::create("double lane change", points, false,
                             {.spacing = 0.5, .smoothing_sigma = 0.0, .start_s = kRunUp - kStart});
}

Result<LaneChange> LaneChange::create(const model::VehicleParams& vehicle) {
  if (vehicle.scale != 1.0)
    return fail(ErrorCode::kInvalidArgument, "lane change: got a model car, expected one in full size");
  const LaneChangeCourse course(vehicle.width);
  Result<road::Track> road = course.road();
  if (!road) return fail(road.error());
  LaneChange change(vehicle, course, std::move(*road));
  const Result<road::RacingLine> fastest = change.plan(1.0);
  if (!fastest) return fail(fastest.error());
  const double time = fastest->at(LaneChangeCourse::kRunUp + LaneChangeCourse::kLength).time -
                      fastest->at(LaneChangeCourse::kRunUp).time;
  change.full_speed_ = LaneChangeCourse::kLength / time;
  return change;
}

Result<road::RacingLine> LaneChange::plan(double grip_share) const {
  return lap_time::plan_racing_line(
      road_, vehicle_, {.margin = margin_of(vehicle_), .grip_share = grip_share, .time_step = kPlanStep});
}

Result<LaneChange::Way> LaneChange::way_at(double speed) {
  Result<road::RacingLine> line = fail(ErrorCode::kInvalidArgument, "");
  // The slowest speeds may have no plan: take the line of the next speed that has one.
  for (int step = static_cast<int>(std::ceil(speed / kWayStep));; ++step) {
    if (const auto known = ways_.find(step); known != ways_.end()) return known->second;
    const double line_speed = std::min(step * kWayStep, full_speed_);
    const double share = line_speed / full_speed_;
    line = plan(share * share);  // grip grows with the square of the speed
    if (!line && line_speed < full_speed_) continue;
    if (!line) return fail(line.error());
    const road::RacingRoad::Basis basis{.is_closed = false, .braking = kStopping};
    Way way = std::make_shared<const road::RacingRoad>(road::line_points(road_, *line), 0.0, basis);
    ways_.emplace(step, way);
    return way;
  }
}

Result<LaneChangeOutcome> LaneChange::drive(const scenario::Scenario& scenario, double speed,
                                            const Factories& make) {
  const scenario::Scenario one = on_course(scenario);
  const Result<Way> way = way_at(speed);
  if (!way) return fail(way.error());
  Result<road::Track> waypoints = waypoints_on((*way)->line());
  if (!waypoints) return fail(waypoints.error());
  const Roads::Prepared road{road_, std::move(*waypoints), known_road(one, &road_),
                             one.races() ? *way : nullptr};
  Factories parts = make;
  parts.controller = [&](const scenario::Scenario& each) -> Result<std::unique_ptr<controller::Controller>> {
    scenario::Scenario steering = each;
    steering.vehicle.drive_acceleration = steering.vehicle.brake_acceleration = kNoPedal;
    auto driver = make.controller(steering);
    if (!driver) return fail(driver.error());
    return std::make_unique<ReleasesThrottle>(std::move(*driver), each.vehicle, speed);
  };
  auto loop = ClosedLoop::create(one, road, parts);
  if (!loop) return fail(loop.error());
  (*loop)->restart_at({.x = -LaneChangeCourse::kStart, .vx = speed});
  return outcome_of(**loop, course_, one.vehicle);
}

Result<LaneChangeLimit> LaneChange::find_limit(const scenario::Scenario& scenario, const Factories& make) {
  LaneChangeLimit limit;
  for (int speed = kSlowest; speed <= kFastest; ++speed) {
    const Result<LaneChangeOutcome> outcome = drive(scenario, speed / 3.6, make);
    if (!outcome) return fail(outcome.error());
    limit.failed = *outcome;
    if (!outcome->has_passed()) break;
    limit.passed_kmph = speed;
    limit.passed = *outcome;
  }
  return limit;
}

}  // namespace chicane::run
