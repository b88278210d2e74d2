// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "chicane/base/jet.hpp"
#include "chicane/base/math.hpp"
#include "chicane/lap_time/detail/collocation.hpp"

namespace chicane::lap_time {

/// The road at the nodes of a plan (docs/limit.md, section 2).
struct RoadNodes {
  std::vector<double> s;                      ///< along the centre line [m]
  std::vector<double> heading;                ///< of the centre line in W, in (−π, π] [rad]
  std::vector<double> step;                   ///< to the next node [m]
  std::vector<double> turn;                   ///< of the centre line until the next node [rad]
  std::vector<double> curvature;              ///< mean around the node [1/m]
  std::vector<double> front_bend, rear_bend;  ///< that moves the line away at the axles [1/m]
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
  T c, s;      ///< of the heading against the line
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

}  // namespace chicane::lap_time
