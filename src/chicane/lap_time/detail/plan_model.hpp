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

namespace chicane::lap_time {

/// The road at the nodes of a plan (docs/limit.md, section 2).
struct RoadNodes {
  std::vector<double> s;                      ///< along the centre line [m]
  std::vector<double> heading;                ///< heading of the centre line in W, in (−π, π] [rad]
  std::vector<double> step;                   ///< distance to the next node [m]
  std::vector<double> turn;                   ///< turn of the centre line up to the next node [rad]
  std::vector<double> curvature;              ///< mean around the node [1/m]
  std::vector<double> front_bend, rear_bend;  ///< curvature that moves the line away at the axles [1/m]
  std::vector<double> front_left, front_right, rear_left, rear_right;  ///< edges at the axles [m]
};

/// First variables of every plant's model: position and motion of the body in the road's axes.
enum CommonState { kOffset, kHeading, kVx, kVy, kYawRate, kSteer, kPedal };

/// Size of a model, and the functions of a node by numbers and by jets.
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

/// A body in the road's axes (docs/limit.md, eq. 7–8).
template <class T>
struct OnRoad {
  T c, s;      ///< cosine and sine of the heading against the line
  T slowness;  ///< time by arc length of the centre line [s/m]

  OnRoad(double curvature, const T& offset, const T& heading, const T& vx, const T& vy)
      : c{cos(heading)}, s{sin(heading)}, slowness{(1.0 - curvature * offset) / (c * vx - s * vy)} {}

  /// Offset from the line of a point of the body (eq. 8); `bend` as RoadNodes.
  T offset_of(const T& offset, double x, double y, double bend) const {
    const T along = x * c - y * s;
    const T across = offset + x * s + y * c;
    return across - (0.5 * bend) * (along * along) / off_centre(T(1.0 - bend * across));
  }

 private:
  /// Distance to the bend's centre over its radius. Below kNear it bends away from zero, with two continuous
  /// derivatives, down to half of kNear: at the centre (eq. 8) has a pole that a search does not come back
  /// from.
  static T off_centre(const T& share) {
    constexpr double kNear = 0.3;
    if (!(value_of(share) < kNear)) return share;
    const T t = (2.0 / kNear) * (kNear - share);
    return 0.5 * kNear + (0.5 * kNear) / (1.0 + t + t * t);
  }
};

/// Car of a first guess of a lap.
struct GuessCar {
  double grip = 8.0;    ///< sideways [m/s²]
  double drive = 3.0;   ///< [m/s²]
  double brake = 5.0;   ///< [m/s²]
  double speed = 60.0;  ///< top speed [m/s]
  double front_axle = 1.25, rear_axle = 1.45;
};

/// Speeds at the nodes along the centre line by curvature, then braking, then drive.
[[nodiscard]] std::vector<double> guess_speeds(const std::vector<double>& curvature,
                                               const std::vector<double>& step, const GuessCar& car);

/// Nodes about `time_step` [s] apart at the speed of the guess, from s = 0 on; at least `least` [m].
[[nodiscard]] RoadNodes lay_nodes(const road::Track& track, const GuessCar& car, double time_step);

/// Size of a car that must fit a road.
struct CarSize {
  double front_axle = 0.0, rear_axle = 0.0;  ///< distances from the centre of mass [m]
  double half_width = 0.0;                   ///< distance to the outer edge of a contact patch [m]
  double steer_limit = 0.0;                  ///< [rad]

  /// Curvature that the centre of mass drives at full lock and walking pace [1/m].
  [[nodiscard]] double most_curvature() const noexcept;
};

/// Whether the car can get round at walking pace: wide enough everywhere, and a line within the edges that
/// its full lock can follow (docs/limit.md, section 4). kInvalidArgument with the place, and the radius there
/// and of the full lock.
[[nodiscard]] Result<void> fits_road(const road::Track& track, const CarSize& car);

/// Limits of a bend that a car can pass.
struct Fit {
  double reserve = 1.0 / 1.02;  ///< smallest radius allowed over the radius at full lock
  double surely = 4.0;          ///< radius over the full lock's above which a bend is not checked
  double beside = std::numeric_limits<double>::infinity();  ///< largest offset of the car from the middle [m]
  double scale = 1.0;                                       ///< scale of the lengths in messages
  std::function<bool()> go_on{};  ///< asked before each iteration; false: no answer, as if it fitted
};
[[nodiscard]] Result<void> fits_road(const road::Track& track, const CarSize& car, const Fit& fit);

/// Reserve of a plan.
struct Reserve {
  double margin = 0.0;         ///< gap of each contact patch to its edge [m]
  double grip_share = 1.0;     ///< share of the tyres' force
  double slip_share = 10.0;    ///< largest slip over the slip of peak force: steering keeps its effect
  double brake_share = 1.0;    ///< share of the largest braking force
  double steer_weight = 1e-3;  ///< weight of the steering's rate squared, in time [s/rad²·s]
};

/// A car as the search for its fastest lap sees it.
class PlanModel {
 public:
  virtual ~PlanModel() = default;

  [[nodiscard]] virtual CarSize size() const = 0;
  [[nodiscard]] virtual GuessCar guess_car() const = 0;
  [[nodiscard]] virtual const NodeFunctions& functions() const = 0;
  virtual void set_road(const RoadNodes& road) = 0;  ///< must outlive its use
  virtual void set_reserve(const Reserve& reserve) = 0;
  /// The variables of a car that follows a curve steadily.
  virtual void guess(double speed, double acceleration, double curvature, double* z) const = 0;
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
