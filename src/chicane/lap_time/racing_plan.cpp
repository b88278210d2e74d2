// SPDX-License-Identifier: MIT
// Lap that a controller races by: PlanSearch with the controller's own model of the car, repeated with other
// nodes if it fails.
#include "chicane/lap_time/racing_plan.hpp"

#include <algorithm>
#include <string_view>

#include "chicane/lap_time/detail/plan_search.hpp"
#include "chicane/lap_time/detail/plant_models.hpp"

namespace chicane::lap_time {
namespace {

constexpr double kQuickSteering =
    1.2;                             // [rad/s] steering rate that needs no bound on braking in bends; chosen
constexpr double kTolerance = 1e-4;  // tolerance of the optimum; chosen: about 1 ms of a lap
constexpr int kSteerRate = kPedal + 1, kPedalRate = kPedal + 2;  // inputs follow the states of CommonState

/// Whether all options are in the ranges of RacingPlanOptions.
[[nodiscard]] bool are_in_range(const RacingPlanOptions& options) {
  const auto is_share = [](double share, double most) { return share > 0.0 && share <= most; };
  return options.margin >= 0.0 && is_share(options.grip_share, 1.0) && is_share(options.brake_share, 1.0) &&
         is_share(options.slip_share, 2.0) && options.speed_limit > 3.0 && options.time_step >= 0.01 &&
         options.time_step <= 0.2 && options.budget > 0.0 && options.delay > 0.0;
}

/// The model of tracking controllers (model::PredictionModel) as a car whose fastest lap is searched.
class VehiclePlan final : public PlanModelOf<PlanModel, VehicleModel> {
 public:
  explicit VehiclePlan(const model::VehicleParams& vehicle, const RacingPlanOptions& options = {})
      : vehicle_{vehicle} {
    model_.speed_limit = std::min(options.speed_limit, vehicle.valid_speed);
    model_.sliding = model::SlidingBound(vehicle, options.delay);
    model_.slides = options.slides && model_.sliding.permits();
    model_.stability = model::BrakingStability(vehicle);
    model_.is_steered_slowly = vehicle.friction_coupling > 0.0 && vehicle.steer_rate_limit < kQuickSteering;
    set_reserve({.slip_share = 1.0});
  }
  [[nodiscard]] CarSize size() const override { return model_.size(); }
  /// Shares of grip, drive and brakes were chosen: the search converges from them.
  [[nodiscard]] GuessCar guess_car() const override {
    const model::VehicleParams& car = vehicle_;
    const double stay = 1.0 - car.steer_helper;
    const double grip = car.friction * car.load_constant;
    return {.grip = 0.65 * grip / std::max(stay, 0.6),
            .drive = 0.5 * car.drive_acceleration,
            .brake = 0.5 * std::min(car.brake_acceleration * car.brake_throttle_limit, grip),
            .speed = std::min(45.0, model_.speed_limit),
            .front_axle = car.front_axle,
            .rear_axle = car.rear_axle};
  }
  void set_reserve(const Reserve& reserve) override {
    model::VehicleParams car = vehicle_;
    car.friction *= reserve.grip_share;
    model_.model.set_vehicle(car);
    model_.margin = reserve.margin;
    model_.brake_share = reserve.brake_share;
    model_.slip_share = reserve.slip_share;
    model_.steer_weight = reserve.steer_weight;
  }
  /// Steady motion along the bend.
  void guess(double v, double a, double curvature, double* z) const override {
    const model::VehicleParams& car = vehicle_;
    const double side = (1.0 - car.steer_helper) * v * v * curvature / model_.model.load(v);
    z[kYawRate] = v * curvature;
    z[kVx] = v;
    z[kVy] = car.rear_axle * z[kYawRate] - v * side / car.cornering_rear;
    z[kHeading] = -z[kVy] / v;
    z[kSteer] = car.wheelbase() * curvature + side / car.cornering_front - side / car.cornering_rear;
    z[kPedal] = a;
  }
  [[nodiscard]] road::RacingLinePoint point(const double* z) const override {
    const model::VehicleParams& car = vehicle_;
    const model::BodyMotion<double> body{z[kVx], z[kVy], z[kYawRate], z[kSteer], z[kPedal]};
    return point_of(z, z[kSteer] + car.steer_lag * z[kSteerRate], model_.model.change(body).vx,
                    throttle_for(car, z[kPedal] + car.drive_lag * z[kPedalRate], z[kVx]));
  }

 private:
  model::VehicleParams vehicle_;
};

}  // namespace

Result<void> can_be_driven(const road::Track& track, const model::VehicleParams& vehicle, double max_offset,
                           double scale) {
  if (!track.centre().is_closed()) return {};
  const CarSize size = VehiclePlan(vehicle).size();
  // A tenth of the steering lock stays for control (1.1). A road whose middle has a fifth more room than that
  // (1.32) needs no search for a line.
  const Fit fit{.reserve = 1.1, .surely = 1.32, .beside = max_offset, .scale = scale};
  Result<void> fits = fits_road(track, size, fit);
  constexpr std::string_view kPrefix = "limit: ";
  if (!fits) return fail(fits.error().code, fits.error().message.substr(kPrefix.size()));
  return {};
}

Result<road::RacingLine> plan_racing_line(const road::Track& track, const model::VehicleParams& vehicle,
                                          const RacingPlanOptions& options) {
  if (Result<void> valid = model::validate(vehicle); !valid) return fail(valid.error());
  if (!are_in_range(options))
    return fail(ErrorCode::kInvalidArgument, "racing plan: an option is out of its range");
  VehiclePlan model(vehicle, options);
  CarSize size = model.size();
  size.half_width += options.margin;
  Fit fit;
  bool is_stopped = false;
  if (options.go_on) fit.go_on = [&] { return !(is_stopped = is_stopped || !options.go_on(0, 0.0)); };
  if (Result<void> fits = fits_road(track, size, fit); !fits) return fail(fits.error());
  if (is_stopped) return fail(ErrorCode::kInvalidArgument, "limit: stopped");
  model.set_reserve({.margin = options.margin,
                     .grip_share = options.grip_share,
                     .slip_share = options.slip_share,
                     .brake_share = options.brake_share});
  // The search may fail on some nodes, where tyres saturate; 0.85 and 1.2 times the step give other nodes.
  Result<NodePlan> plan = fail(ErrorCode::kInvalidArgument, "");
  double work = 0.0;
  for (const double step : {1.0, 0.85, 1.2}) {
    PlanSearch search(track, model,
                      {.time_step = step * options.time_step,
                       .tolerance = kTolerance,
                       .budget = options.budget - work,
                       .go_on = options.go_on,
                       .on_progress = [&](const PlanProgress& now) {
                         if (options.on_progress)
                           options.on_progress({work + now.work, work + now.expected, now.lap_time});
                       }});
    plan = search.find();
    work += search.work();
    if (plan || search.is_stopped() || search.is_out_of_budget()) break;
  }
  if (!plan) return fail(plan.error());
  return line_of(track, vehicle.name, model, *plan, options.margin);
}

}  // namespace chicane::lap_time
