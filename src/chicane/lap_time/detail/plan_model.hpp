// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "chicane/base/jet.hpp"
#include "chicane/base/math.hpp"
#include "chicane/base/result.hpp"
#include "chicane/lap_time/detail/collocation.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/track.hpp"

/// Car and road as the search of a fastest lap sees them: the road at nodes, the functions of a node, the
/// first guess, and the check that the car fits the road.

namespace chicane::lap_time {

/// The road at the nodes of a plan (docs/limit.md, section 2).
struct RoadNodes {
  std::vector<double> s;                      ///< along the centre line [m]
  std::vector<double> heading;                ///< heading of the centre line in W, in (−π, π] [rad]
  std::vector<double> step;                   ///< distance to the next node [m]
  std::vector<double> turn;                   ///< turn of the centre line up to the next node [rad]
  std::vector<double> curvature;              ///< mean curvature around the node [1/m]
  std::vector<double> front_bend, rear_bend;  ///< mean curvature from the node to an axle [1/m]
  /// Distances from the line to the edges at the axles [m].
  std::vector<double> front_left, front_right, rear_left, rear_right;
};

/// Size of a car that must fit a road.
struct CarSize {
  double front_axle = 0.0, rear_axle = 0.0;  ///< distances from the centre of mass [m]
  double half_width = 0.0;                   ///< distance to the outer edge of a contact patch [m]
  double steer_limit = 0.0;                  ///< largest road-wheel angle [rad]

  /// Curvature that the centre of mass drives at full lock and walking pace [1/m].
  [[nodiscard]] double most_curvature() const noexcept;
};

/// First variables of every plant's model: position and motion of the body in the road's axes.
enum CommonState { kOffset, kHeading, kVx, kVy, kYawRate, kSteer, kPedal };

/// Point of a line with the variables `z` of its node, the road-wheel angle commanded [rad], the rate of vx
/// [m/s²] and the pedal.
[[nodiscard]] inline road::RacingLinePoint point_of(const double* z, double steer_command,
                                                    double acceleration, double throttle) noexcept {
  return {.offset = z[kOffset],
          .heading = z[kHeading],
          .vx = z[kVx],
          .vy = z[kVy],
          .yaw_rate = z[kYawRate],
          .steer = z[kSteer],
          .steer_command = steer_command,
          .acceleration = acceleration,
          .throttle = throttle};
}

/// Functions of a node for the search, from a model that is a template over the scalar.
template <class Model>
class ModelFunctions final : public NodeFunctions {
 public:
  explicit ModelFunctions(const Model& model) : model_{model} {
    variables = Model::kVariables;
    states = Model::kStates;
    equations = Model::kEquations;
    inequalities = Model::kInequalities;
    const auto sizes = Model::scale();
    scale.assign(sizes.begin(), sizes.end());
  }
  void values(int node, const double* z, double* out) const override {
    model_.template functions<double>(static_cast<std::size_t>(node), z, out);
  }
  void derivatives(int node, const double* z, const double* weights, double* out, double* jacobian,
                   double* hessian) const override {
    using T = LooseJet<double, Model::kVariables>;
    constexpr std::size_t kCount = Model::kStates + Model::kEquations + 1 + Model::kInequalities;
    std::array<T, Model::kVariables> x;
    std::array<T, kCount> f;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = T::variable(z[i], static_cast<int>(i));
    model_.template functions<T>(static_cast<std::size_t>(node), x.data(), f.data());
    std::fill_n(hessian, T::kCurvatures, 0.0);
    for (std::size_t m = 0; m < kCount; ++m) {
      out[m] = f[m].v;
      std::copy(f[m].slopes.begin(), f[m].slopes.end(), jacobian + m * x.size());
      if (weights[m] == 0.0) continue;
      f[m].each_curvature([&](std::size_t i, std::size_t j, double curvature) {
        hessian[j * (j + 1) / 2 + i] += weights[m] * curvature;
      });
    }
  }

 private:
  const Model& model_;
};

/// Body in the axes of the road (docs/limit.md, eq. 7–8).
template <class T>
struct OnRoad {
  T c, s;      ///< cosine and sine of the heading relative to the line
  T slowness;  ///< time by arc length of the centre line [s/m]

  OnRoad(double curvature, const T& offset, const T& heading, const T& vx, const T& vy)
      : c{cos(heading)}, s{sin(heading)}, slowness{(1.0 - curvature * offset) / (c * vx - s * vy)} {}

  /// Offset from the line of the point (x, y) of the body [m] (eq. 8); `bend` as RoadNodes::front_bend.
  T offset_of(const T& offset, double x, double y, double bend) const {
    const T along = x * c - y * s;
    const T across = offset + x * s + y * c;
    return across - (0.5 * bend) * (along * along) / off_centre(T(1.0 - bend * across));
  }
  /// Writes the distances of the car's four corners to the edges at node k, less `margin` [m], to `out`:
  /// front left, front right, rear left, rear right. Returns the place after them.
  T* edge_gaps(const RoadNodes& at, std::size_t k, const T& offset, const CarSize& car, double margin,
               T* out) const {
    const double w = car.half_width;
    *out++ = at.front_left[k] - margin - offset_of(offset, car.front_axle, w, at.front_bend[k]);
    *out++ = at.front_right[k] - margin + offset_of(offset, car.front_axle, -w, at.front_bend[k]);
    *out++ = at.rear_left[k] - margin - offset_of(offset, -car.rear_axle, w, at.rear_bend[k]);
    *out++ = at.rear_right[k] - margin + offset_of(offset, -car.rear_axle, -w, at.rear_bend[k]);
    return out;
  }

 private:
  /// Distance to the bend's centre over its radius. Below kNear it is replaced by a curve that falls only to
  /// half of kNear, with two continuous derivatives: at the centre eq. 8 has a pole, from which a search does
  /// not return.
  static T off_centre(const T& share) {
    constexpr double kNear = 0.3;  // chosen
    if (!(value_of(share) < kNear)) return share;
    const T t = (2.0 / kNear) * (kNear - share);
    return 0.5 * kNear + (0.5 * kNear) / (1.0 + t + t * t);
  }
};

/// Simple car for the first guess of a lap.
struct GuessCar {
  double grip = 8.0;                           ///< largest lateral acceleration [m/s²]
  double drive = 3.0;                          ///< largest acceleration [m/s²]
  double brake = 5.0;                          ///< largest deceleration [m/s²]
  double speed = 60.0;                         ///< top speed [m/s]
  double front_axle = 1.25, rear_axle = 1.45;  ///< distances from the centre of mass [m]
};

/// Speeds at the nodes along the centre line [m/s]: limited by curvature, then by braking, then by drive.
[[nodiscard]] std::vector<double> guess_speeds(const std::vector<double>& curvature,
                                               const std::vector<double>& step, const GuessCar& car);

/// Nodes about `time_step` [s] apart at the speed of the guess, from s = 0 on; at least `least` [m].
[[nodiscard]] RoadNodes lay_nodes(const road::Track& track, const GuessCar& car, double time_step);

/// Options of fits_road().
struct Fit {
  double reserve = 1.0 / 1.02;  ///< smallest radius allowed over the radius at full lock
  double surely = 4.0;          ///< radius over the full lock's above which a bend is not checked
  double beside = std::numeric_limits<double>::infinity();  ///< largest offset of the car from the middle [m]
  double scale = 1.0;                                       ///< factor of the lengths in messages
  std::function<bool()> go_on{};  ///< called before each iteration; false ends the check as if the car fitted
};

/// Checks that the car can drive the road at walking pace: it is wide enough everywhere, and has a line
/// within the edges that the car's full lock can follow (docs/limit.md, section 4). Fails with
/// kInvalidArgument, with the place, and the radius there and of the full lock.
[[nodiscard]] Result<void> fits_road(const road::Track& track, const CarSize& car, const Fit& fit = {});

/// Reserve that a plan keeps.
struct Reserve {
  double margin = 0.0;         ///< gap of each contact patch to its edge [m]
  double grip_share = 1.0;     ///< used share of the tyres' force
  double slip_share = 10.0;    ///< largest slip over the slip of peak force: steering keeps its effect
  double brake_share = 1.0;    ///< used share of the largest braking force
  double steer_weight = 1e-3;  ///< weight of the steering's rate squared, in time [s/rad²·s]
};

/// Interface of a car to the search for its fastest lap.
class PlanModel {
 public:
  virtual ~PlanModel() = default;

  [[nodiscard]] virtual CarSize size() const = 0;
  /// Gentle car, from whose lap the search converges.
  [[nodiscard]] virtual GuessCar guess_car() const = 0;
  [[nodiscard]] virtual const NodeFunctions& functions() const = 0;
  virtual void set_road(const RoadNodes& road) = 0;  ///< `road` must outlive its use
  virtual void set_reserve(const Reserve& reserve) = 0;
  /// Sets the variables of a node to a steady motion along a curve [m/s, m/s², 1/m].
  virtual void guess(double speed, double acceleration, double curvature, double* z) const = 0;
  /// Point of a racing line by the variables of a node, without arc length and time.
  [[nodiscard]] virtual road::RacingLinePoint point(const double* z) const = 0;
};

/// Implements `Base`, which is PlanModel or derived from it, with the functions of `Model`.
template <class Base, class Model>
class PlanModelOf : public Base {
 public:
  [[nodiscard]] const NodeFunctions& functions() const override { return functions_; }
  void set_road(const RoadNodes& road) override { model_.road = &road; }

 protected:
  Model model_;

 private:
  ModelFunctions<Model> functions_{model_};
};

}  // namespace chicane::lap_time
