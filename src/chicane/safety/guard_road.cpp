// SPDX-License-Identifier: MIT
// The guard with the road that it knows: its line, and where the car is on it (docs/safety.md, "Settings").
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/safety/guard.hpp"

namespace chicane::safety {
namespace {

constexpr double kFarFromRoad = 20.0;    // [m] beside its line there is no stop along the road
constexpr double kTraction = 0.9;        // of the grip of a driven axle: beyond it no prediction holds
constexpr double kLeastTraction = 0.04;  // square of what is left of an axle that slides

/// The acceleration [m/s²] that the driven axles can give beside the force that they carry sideways
/// (docs/safety_watch.md, eq. 14). Infinite for cars whose tyres share nothing between the directions.
double traction(const model::PredictionModel& model, const model::BodyMotion<double>& body) noexcept {
  const model::VehicleParams& car = model.vehicle();
  if (!(car.friction_coupling > 0.0)) return std::numeric_limits<double>::infinity();
  const auto tires = model.tire_use(body);  // undriven
  const double grip = kTraction * car.friction * model.load(body.vx) / car.wheelbase();
  const auto left = [](double use) { return std::sqrt(std::max(1.0 - use * use, kLeastTraction)); };
  const double front = left(tires.front) * grip * car.rear_axle / std::max(car.drive_share_front, 1e-6);
  const double rear = left(tires.rear) * grip * car.front_axle / std::max(1.0 - car.drive_share_front, 1e-6);
  return std::min(front, rear) + longitudinal_acceleration(car, 0.0, body.vx);
}

}  // namespace

road::KnownRoad known_road(const GuardOptions& options, const road::RoadData* road,
                           const model::VehicleParams& vehicle) {
  if (options.mode == GuardMode::kOff) return {};
  const bool knows_track = options.road == GuardRoad::kTrack && road != nullptr && road->points.size() > 1;
  return knows_track ? road::KnownRoad{*road, vehicle} : road::KnownRoad{options.half_width, vehicle};
}

void Guard::forget_road() {
  if (options_.road == GuardRoad::kWaypoints) return;
  options_.road = GuardRoad::kWaypoints;
  road_ = known_road(options_, nullptr, model_.vehicle());
  has_place_ = false;
  filter_.forget();
  set_grip(1.0);
  controller_->use_line(nullptr);
}

void Guard::use_line(std::shared_ptr<const road::RacingRoad> lap) {
  // The road that the lap was planned for has to be the one that the guard knows.
  if (lap && lap->is_learned() == (options_.road == GuardRoad::kWaypoints)) {
    road_.use_line(lap.get());
    take_up_line();
  }
  estimator_.mind_helper_gap(lap != nullptr);
  set_grip(lap ? lap->grip() : 1.0);
  controller_->use_line(std::move(lap));
}

/// The road's line is another one. The stored policy is a law that holds on any line of the road: it stays.
void Guard::take_up_line() noexcept {
  if (revision_ == road_.revision()) return;
  revision_ = road_.revision();
  has_place_ = false;
  if (road_.line().is_empty()) filter_.forget();
}

/// Where the car will be on the known road when the command acts; none when car or road are lost.
std::optional<StopStart> Guard::place_on_road(double act_time) noexcept {
  const road::ReferenceLine& line = road_.line();
  is_far_ = false;
  most_drive_ = std::numeric_limits<double>::infinity();
  act_speed_ = estimator_.is_started() ? estimator_.state().vx : std::numeric_limits<double>::infinity();
  if (line.is_empty() || !estimator_.is_started() || !std::isfinite(act_time)) return std::nullopt;
  const tracking::StateEstimator::Prediction at = estimator_.predict(act_time, sent_);
  model::State car = at.state;
  if (!std::isfinite(car.x + car.y + car.psi + car.vx + car.vy + car.r)) return std::nullopt;
  if (car.vx < model::PredictionModel::kSpeedFloor)
    car.vx = std::max(car.vx, estimator_.rolling_speed(act_time, sent_));
  act_speed_ = car.vx;
  most_drive_ = traction(model_, {car.vx, car.vy, car.r, car.steer, 0.0});
  const Vec2 position{car.x, car.y};
  const double* last = has_place_ ? &s_ : nullptr;
  const road::ReferenceLine::Projection place =
      line.find(position, car.psi, 2.0 * model_.vehicle().width, last, 0.5 * kFarFromRoad);
  has_place_ = place.distance < kFarFromRoad;
  is_far_ = !has_place_;
  if (is_far_) return std::nullopt;
  s_ = place.s;
  d_ = place.d;
  const double e = angle_difference(car.psi, line.at(place.s).heading);
  return StopStart{.time = act_time,
                   .s = place.s,
                   .d = place.d,
                   .e = e,
                   .body = {car.vx, car.vy, car.r, car.steer, at.acceleration},
                   .load_along = at.acceleration,
                   .load_across = car.vx * car.r};
}

}  // namespace chicane::safety
