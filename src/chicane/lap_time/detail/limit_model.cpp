// SPDX-License-Identifier: MIT
// Models for the limit of each plant: the equations of a node, reserves, first guesses, and the commands that
// drive a plan.
#include "chicane/lap_time/detail/limit_model.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "chicane/lap_time/detail/plant_models.hpp"

namespace chicane::lap_time {
namespace {

constexpr double kGravity = 9.81;    // [m/s²]
constexpr double kNearLimit = 0.96;  // used share of the drive from which on it has no reserve; chosen

// Reserves, first guesses, weights and tunings of both plants were chosen: with them the search converges and
// plans can be driven on the shipped tracks.

/// Functions of a limit model that its equations know.
template <class Model>
class WithModel : public PlanModelOf<LimitModel, Model> {
 public:
  [[nodiscard]] CarSize size() const override { return this->model_.size(); }
  [[nodiscard]] int feedback_states() const override { return Model::kDriven; }
  [[nodiscard]] int first_input() const override { return Model::kInput; }
};

/// Limit model of the plant `udacity`.
class UdacityLimit final : public WithModel<UdacityModel> {
 public:
  explicit UdacityLimit(const sim::PlantDeviation& deviation) {
    model_.car.mass *= deviation.mass_scale;
    model_.car.yaw_inertia *= deviation.mass_scale;
    friction_ = model_.car.friction_scale * deviation.friction_scale;
    set_reserve({});
  }

  [[nodiscard]] std::span<const Reserve> reserves() const override {
    static constexpr Reserve kReserves[] = {
        {.margin = 0.02},
        {.margin = 0.05, .slip_share = 1.2, .brake_share = 0.98},
        {.margin = 0.1, .grip_share = 0.98, .brake_share = 0.95},
        {.margin = 0.3, .grip_share = 0.97, .brake_share = 0.93},
        {.margin = 0.3, .grip_share = 0.98, .slip_share = 0.95, .brake_share = 0.95},
        {.margin = 0.3, .grip_share = 0.97, .slip_share = 0.85, .brake_share = 0.93}};
    return kReserves;
  }
  [[nodiscard]] GuessCar guess_car() const override {
    return {.grip = 0.9 * model_.load(0.0),
            .drive = 0.5 * model_.drive(),
            .brake = 0.65 * model_.load(0.0),
            .speed = 45.0,
            .front_axle = model_.car.front_axle,
            .rear_axle = model_.car.rear_axle};
  }
  void set_reserve(const Reserve& reserve) override {
    model_.margin = reserve.margin;
    model_.brake_share = reserve.brake_share;
    model_.slip_share = reserve.slip_share;
    model_.steer_weight = reserve.steer_weight;
    model_.car.friction_scale = friction_ * reserve.grip_share;
  }
  void guess(double v, double a, double curvature, double* z) const override {
    const double side = (1.0 - model_.car.steer_helper) * v * v * curvature / (5.0 * model_.load(v));
    z[kYawRate] = v * curvature;
    z[kVx] = v;
    z[kVy] = model_.car.rear_axle * z[kYawRate] - v * side;
    z[kHeading] = -z[kVy] / v;
    z[kSteer] = (model_.car.front_axle + model_.car.rear_axle) * curvature;
    z[kPedal] = a + model_.car.linear_drag * v;
  }
  [[nodiscard]] road::RacingLinePoint point(const double* z) const override {
    const auto m = model_.motion(z[kVx], z[kVy], z[kYawRate], z[kSteer], z[kPedal]);
    return point_of(z, z[kSteer], m.vx, std::clamp(model_.pedal_for(z[kPedal], z[kVx], m.vx), -1.0, 1.0));
  }

  [[nodiscard]] std::vector<double> error_weights() const override { return {25.0, 4.0, 4.0, 0.1, 0.1}; }
  [[nodiscard]] std::span<const Tuning> tunings() const override {
    static constexpr Tuning kTunings[] = {{{40.0, 0.1}}, {{10.0, 0.1}}, {{160.0, 0.1}}, {{40.0, 0.02}}};
    return kTunings;
  }
  [[nodiscard]] bool is_drive_saturated(const double*) const override { return false; }
  void start_estimate() override {}
  void update_estimate(const model::Command&, const sim::PlantOutput&, double) override {}
  /// Uses the velocity in the middle of the next step: the helper turns it first, drag comes last.
  void read_states(const model::State& state, double* x) const override {
    const double turn = kSeen * model_.car.steer_helper * sim::UdacityCar::kStepLength * state.r;
    const double mean = 1.0 + 0.5 * model_.car.linear_drag * sim::UdacityCar::kStepLength;
    x[kVx] = mean * state.vx - turn * state.vy;
    x[kVy] = state.vy + turn * state.vx;
    x[kYawRate] = state.r;
  }
  [[nodiscard]] model::Command command(const model::State& state, const double* z,
                                       const double* inputs) const override {
    const double lock = model_.rear_share() / (1.0 - model_.front_pull()) * model_.load(state.vx);
    const double pull = std::max(inputs[1], -kNearLock * lock);
    const auto m = model_.motion(state.vx, state.vy, state.r, z[kSteer], pull);
    // More slip than at the peak would give less force: limit the demand.
    const auto course = [&](double vx, double vy, double r) {
      return chicane::atan((vy + model_.car.front_axle * r) / (vx + model_.car.lateral_speed_offset));
    };
    const double planned = z[kSteer] - course(z[kVx], z[kVy], z[kYawRate]);
    const double most = std::max(kMostSlip, std::fabs(planned));
    std::array<double, 5> x{};
    read_states(state, x.data());
    const double now = course(x[kVx], x[kVy], x[kYawRate]);
    const double steer = std::clamp(inputs[0], now - most, now + most);
    return {std::clamp(steer, -model_.car.steer_limit, model_.car.steer_limit),
            std::clamp(model_.pedal_for(pull, state.vx, m.vx), -1.0, 1.0)};
  }

 private:
  static constexpr double kSeen = 0.625;  ///< remaining share of the helper's turn, mean over a step's parts
  static constexpr double kMostSlip = 0.19;   ///< largest front slip: just below the peak at 0.2 [rad]
  static constexpr double kNearLock = 0.985;  ///< used share of the force at which wheels lock; chosen
  double friction_ = 1.0;                     ///< friction scale of the plant
};

/// Limit model of the plants `double-track` and `road-car`.
class DoubleTrackLimit final : public WithModel<DoubleTrackModel> {
 public:
  DoubleTrackLimit(const sim::DoubleTrackParams& car, const sim::PlantDeviation& deviation) {
    model_.car = car;
    model_.car.mass *= deviation.mass_scale;
    model_.car.yaw_inertia *= deviation.mass_scale;
    model_.car.friction *= deviation.friction_scale;
  }

  [[nodiscard]] std::span<const Reserve> reserves() const override {
    static constexpr Reserve kReserves[] = {{.margin = 0.05, .slip_share = 1.0},
                                            {.margin = 0.06, .slip_share = 0.95},
                                            {.margin = 0.1, .slip_share = 0.9},
                                            {.margin = 0.15, .grip_share = 0.99, .slip_share = 0.85},
                                            {.margin = 0.2, .grip_share = 0.98, .slip_share = 0.8}};
    return kReserves;
  }
  /// Caps rise from the peak: beyond it a tyre gives less force, and laps of most cars use less than twice
  /// the slip of the peak.
  [[nodiscard]] std::span<const double> slip_caps() const override {
    static constexpr double kCaps[] = {1.0, 1.1, 1.25, 1.5, 2.0, 10.0};
    return kCaps;
  }
  [[nodiscard]] GuessCar guess_car() const override {
    return {.grip = 0.68 * model_.car.friction * kGravity,
            .drive = 0.5 * model_.car.drive_force / model_.car.mass,
            .brake = 0.42 * model_.car.friction * kGravity,
            .speed = 60.0,
            .front_axle = model_.car.front_axle,
            .rear_axle = model_.car.rear_axle};
  }
  void set_reserve(const Reserve& reserve) override {
    model_.margin = reserve.margin;
    model_.grip_share = reserve.grip_share;
    model_.slip_share = reserve.slip_share;
    model_.steer_weight = reserve.steer_weight;
  }
  void guess(double v, double a, double curvature, double* z) const override {
    const sim::DoubleTrackParams& car = model_.car;
    const double side = v * v * curvature;
    const double slope = kGravity * car.friction * car.shape;
    const double rear_slip = side / (slope * car.stiffness_rear);
    z[kYawRate] = v * curvature;
    z[kVx] = v;
    z[kVy] = car.rear_axle * z[kYawRate] - v * rear_slip;
    z[kHeading] = -z[kVy] / v;
    z[kSteer] = car.wheelbase() * curvature + side / (slope * car.stiffness_front) - rear_slip;
    z[kPedal] = a * car.mass / (a > 0.0 ? car.drive_force : car.brake_force);
    z[DoubleTrackModel::kShiftX] = a;
    z[DoubleTrackModel::kShiftY] = side;
    const auto axles = car.axles();
    for (std::size_t i = 0; i < 4; ++i) {
      const model::Axle& axle = axles[i / 2];
      const double share = 0.5 * (a > 0.0 ? axle.drive_share : axle.brake_share) / axle.rest;
      z[DoubleTrackModel::kSlip + i] = share * a / (slope * car.tire(i < 2).stiffness);
    }
  }
  [[nodiscard]] road::RacingLinePoint point(const double* z) const override {
    const auto m = model_.motion(z);
    const sim::DoubleTrackParams& car = model_.car;
    const double pedal = z[kPedal] + car.drive_lag * z[DoubleTrackModel::kPedalRate];
    return point_of(z, z[kSteer] + car.steer_lag * z[DoubleTrackModel::kSteerRate],
                    m.ax + z[kYawRate] * z[kVy], std::clamp(pedal, -1.0, 1.0));
  }

  [[nodiscard]] std::vector<double> error_weights() const override {
    return {25.0, 4.0, 4.0, 0.1, 0.1, 0.0, 0.0, 0.0, 0.0};
  }
  [[nodiscard]] std::span<const Tuning> tunings() const override {
    static constexpr Tuning kTunings[] = {{{2.0, 0.1}},         {{2.0, 0.1}, 1000.0}, {{10.0, 1.0}},
                                          {{10.0, 1.0}, 100.0}, {{0.5, 0.1}},         {{2.0, 0.1}, 10.0},
                                          {{2.0, 0.1}, 100.0},  {{0.5, 0.1}, 1000.0}};
    return kTunings;
  }
  [[nodiscard]] bool is_drive_saturated(const double* z) const override {
    const sim::DoubleTrackParams& car = model_.car;
    const double asked = z[kPedal] + car.drive_lag * z[DoubleTrackModel::kPedalRate];
    return asked > kNearLimit || z[kPedal] * car.drive_force * z[kVx] > kNearLimit * car.drive_power;
  }

  void start_estimate() override {
    pedal_ = 0.0;
    shift_x_ = shift_y_ = 0.0;
  }
  void update_estimate(const model::Command& asked, const sim::PlantOutput& output, double elapsed) override {
    pedal_ = model_.car.pedal().next(pedal_, asked.throttle, elapsed);
    shift_x_ += elapsed / model_.car.load_lag * (output.ax - shift_x_);
    shift_y_ += elapsed / model_.car.load_lag * (output.ay - shift_y_);
  }
  void read_states(const model::State& state, double* x) const override {
    x[kVx] = state.vx;
    x[kVy] = state.vy;
    x[kYawRate] = state.r;
    x[kSteer] = state.steer;
    x[kPedal] = pedal_;
    x[DoubleTrackModel::kShiftX] = shift_x_;
    x[DoubleTrackModel::kShiftY] = shift_y_;
  }
  [[nodiscard]] model::Command command(const model::State& state, const double* z,
                                       const double* inputs) const override {
    const sim::DoubleTrackParams& car = model_.car;
    // More slip than at the peak would give less force: limit the demand.
    const auto course = [&](double vx, double vy, double r) { return (vy + car.front_axle * r) / vx; };
    const double planned = z[kSteer] - course(z[kVx], z[kVy], z[kYawRate]);
    const double most = std::max(kMostSlip * car.tire(true).peak_slip(), std::fabs(planned));
    const double now = course(std::max(state.vx, 1.0), state.vy, state.r);
    const double steer = std::clamp(state.steer + car.steer_lag * inputs[0], now - most, now + most);
    return {std::clamp(steer, -car.steer_limit, car.steer_limit),
            std::clamp(pedal_ + car.drive_lag * inputs[1], -1.0, 1.0)};
  }

 private:
  static constexpr double kMostSlip = 0.9;  ///< largest front slip over that of the peak; chosen
  double pedal_ = 0.0;                      ///< pedal after its lag
  double shift_x_ = 0.0, shift_y_ = 0.0;    ///< lagged acceleration that shifts load [m/s²]
};

}  // namespace

Result<std::unique_ptr<LimitModel>> make_limit_model(std::string_view plant,
                                                     const sim::PlantDeviation& deviation,
                                                     const sim::DoubleTrackParams& params) {
  if (plant == sim::UdacityCar::kName) return std::make_unique<UdacityLimit>(deviation);
  if (plant == sim::DoubleTrack::kRoadCar)
    return std::make_unique<DoubleTrackLimit>(sim::DoubleTrackParams{}, deviation);
  if (plant == sim::DoubleTrack::kName) return std::make_unique<DoubleTrackLimit>(params, deviation);
  return fail(ErrorCode::kNotFound, "limit: got plant " + std::string(plant) +
                                        ", expected one with a model: udacity, road-car, double-track");
}

}  // namespace chicane::lap_time
