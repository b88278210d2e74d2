// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/lap_time/detail/limit_model.hpp"
#include "chicane/lap_time/detail/plan_model.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/road/racing_road.hpp"
#include "chicane/road/track.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::lap_time {

/// A lap of a plant's model: its nodes and their variables, one after the other.
struct NodePlan {
  RoadNodes road;
  std::vector<double> z;
  double lap_time = 0.0;
  bool is_best_so_far = false;  ///< no optimum: the budget ended the search
};

/// Time round the ring by the trapezoidal rule [s].
[[nodiscard]] double lap_time_of(const RoadNodes& road, const std::vector<double>& z, int variables);

/// A plan of `car` as a line, which keeps `margin` [m] to edge and kerb.
[[nodiscard]] road::RacingLine line_of(const road::Track& track, std::string_view car, const PlanModel& model,
                                       const NodePlan& plan, double margin);

/// The fastest laps of one model on one road: from a first guess on coarse nodes to fine ones; then others
/// with more in reserve from there.
class PlanSearch {
 public:
  struct Options {
    double time_step = 0.05;  ///< between nodes [s]
    double tolerance = 1e-6;  ///< stationarity of an optimum (Collocation::Options)
    double budget = std::numeric_limits<double>::infinity();  ///< of find() (seconds_of_work) [s]
    /// Called with the progress in words, and the lap time; false ends the search. May be empty.
    std::function<bool(int iteration, double lap_time)> go_on{};
    std::function<void(const PlanProgress&)> on_progress{};  ///< after each iteration; may be empty
  };
  PlanSearch(const road::Track& track, PlanModel& model, const Options& options)
      : track_{track}, model_{model}, options_{options} {}

  /// The best so far where the budget ends the search. kNotFound when there is none: no optimum from any
  /// first guess, or no budget left for one.
  [[nodiscard]] Result<NodePlan> find();
  /// The plan with that in reserve, from a neighbouring one.
  [[nodiscard]] Result<NodePlan> near(const NodePlan& plan, const Reserve& reserve);

  [[nodiscard]] bool is_stopped() const noexcept { return is_stopped_; }
  [[nodiscard]] bool is_out_of_budget() const noexcept { return is_out_of_budget_; }
  /// Work of all searches until now [s].
  [[nodiscard]] double work() const noexcept { return work_; }
  [[nodiscard]] int iterations() const noexcept { return iterations_; }
  [[nodiscard]] double stationarity() const noexcept { return stationarity_; }
  [[nodiscard]] double violation() const noexcept { return violation_; }

 private:
  [[nodiscard]] std::vector<double> first_guess(const RoadNodes& road, double share) const;
  [[nodiscard]] bool solve(NodePlan& plan, double barrier, int most_iterations, double tolerance);
  [[nodiscard]] bool goes_on(double lap_time, std::size_t nodes);

  const road::Track& track_;
  PlanModel& model_;
  Options options_;
  int iterations_ = 0;
  double stationarity_ = 0.0, violation_ = 0.0;
  double work_ = 0.0;
  double expected_ = 0.0;  ///< work of a search that goes well [s]
  bool is_stopped_ = false;
  bool is_out_of_budget_ = false;
};

/// Linear feedback towards a plan, for each of its nodes: the periodic linear-quadratic regulator of the
/// model's derivatives along it (docs/limit.md, section 5).
class RingFeedback {
 public:
  /// `z`: the plan's nodes.
  RingFeedback(const LimitModel& model, const RoadNodes& road, const std::vector<double>& z,
               const Tuning& tuning);

  /// Gains at node k: two rows of `driven` numbers; inputs = the plan's − gains · error.
  [[nodiscard]] const double* gains(std::size_t k) const noexcept {
    return gains_.data() + k * 2 * static_cast<std::size_t>(driven_);
  }

 private:
  int driven_;
  std::vector<double> gains_;
};

/// What came of driving a plan.
struct DrivenLaps {
  bool is_clean = false;  ///< all laps, without a boundary event since the start
  int laps = 0;
  double best = 0.0;  ///< lap time [s]
  double worst = 0.0;
  double least_edge = 0.0;  ///< of a contact patch to the edge [m]
  double event_s = 0.0;     ///< where the first boundary event was [m]
};

/// Drives a plan in the plant with full state and without latency: what the plan asks for, and feedback.
[[nodiscard]] DrivenLaps drive_plan(const road::Track& track, LimitModel& model, const NodePlan& plan,
                                    sim::Plant& plant, const Tuning& tuning, int laps);

}  // namespace chicane::lap_time
