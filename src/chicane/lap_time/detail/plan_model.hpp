// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/lap_time/detail/collocation.hpp"
#include "chicane/lap_time/detail/plant_model.hpp"
#include "chicane/lap_time/detail/road_nodes.hpp"
#include "chicane/lap_time/detail/tightest_bend.hpp"
#include "chicane/road/road_data.hpp"

namespace chicane::lap_time {

/// What a plan keeps in reserve.
struct Reserve {
  double margin = 0.0;         ///< of each contact patch from its edge [m]
  double grip_share = 1.0;     ///< of the tyres' force that it uses
  double slip_share = 10.0;    ///< most slip over that of the peak force, so that steering keeps its effect
  double brake_share = 1.0;    ///< of the largest braking force
  double steer_weight = 1e-3;  ///< of the steering's rate squared, in time [s/rad²·s]
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

/// A `Base`, PlanModel or an interface derived from it, whose functions are those of `Model`.
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
