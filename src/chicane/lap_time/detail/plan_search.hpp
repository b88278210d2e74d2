// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <span>
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

/// Lap of a car's model: nodes of the road, and the variables of each node in turn.
struct NodePlan {
  RoadNodes road;
  std::vector<double> z;        ///< variables of the first node, of the second ...
  double lap_time = 0.0;        ///< [s]
  bool is_best_so_far = false;  ///< no optimum: the budget or a slip cap ended the search
};

/// Lap time by the trapezoidal rule [s].
[[nodiscard]] double lap_time_of(const RoadNodes& road, const std::vector<double>& z, int variables);

/// Racing line of a plan for `car`; `margin`: distance kept to edge and kerb [m].
[[nodiscard]] road::RacingLine line_of(const road::Track& track, std::string_view car, const PlanModel& model,
                                       const NodePlan& plan, double margin);

/// Search of the fastest laps of one car on one road: from a guess, on coarse nodes and then on fine ones;
/// and from a known plan to plans with more reserve.
class PlanSearch {
 public:
  struct Options {
    double time_step = 0.05;  ///< time between nodes [s]
    double tolerance = 1e-6;  ///< stationarity at an optimum (Collocation::Options)
    /// Rising caps on the slip over the slip of peak force: find() solves with each in turn on coarse nodes.
    /// Empty: one search, with the reserve that the model has.
    std::span<const double> slip_caps{};
    double budget = std::numeric_limits<double>::infinity();  ///< limit of find()'s work [s]
    /// Progress callback: count of iterations and lap time [s]; false ends the search. May be empty.
    std::function<bool(int iteration, double lap_time)> go_on{};
    std::function<void(const PlanProgress&)> on_progress{};  ///< called after each iteration; may be empty
  };
  PlanSearch(const road::Track& track, PlanModel& model, const Options& options)
      : track_{track}, model_{model}, options_{options} {}

  /// Fastest lap, or the best plan so far if the budget or a slip cap without an optimum ends the search.
  /// Fails with kNotFound without a plan: no optimum from any first guess, or no budget left to reach one.
  [[nodiscard]] Result<NodePlan> find();
  /// Plan on fine nodes near the one with the first slip cap. Pre: find() has found a plan.
  [[nodiscard]] const NodePlan& calm() const noexcept { return calm_; }
  /// Plan with `reserve`, searched from a neighbouring plan.
  [[nodiscard]] Result<NodePlan> near(const NodePlan& plan, const Reserve& reserve);

  [[nodiscard]] bool is_stopped() const noexcept { return is_stopped_; }
  [[nodiscard]] bool is_out_of_budget() const noexcept { return is_out_of_budget_; }
  /// Work of all searches so far [s].
  [[nodiscard]] double work() const noexcept { return work_; }
  [[nodiscard]] int iterations() const noexcept { return iterations_; }
  [[nodiscard]] double stationarity() const noexcept { return stationarity_; }
  [[nodiscard]] double violation() const noexcept { return violation_; }

 private:
  /// Variables of a lap along the centre line with a share of the guess car's accelerations.
  [[nodiscard]] std::vector<double> first_guess(const RoadNodes& road, double share) const;
  /// Best of several optima on coarse nodes.
  [[nodiscard]] Result<NodePlan> find_coarse();
  /// `first`, and plans with further slip caps.
  [[nodiscard]] std::vector<NodePlan> release_slip(NodePlan first);
  /// Solves from a plan, which it replaces; false without an optimum.
  [[nodiscard]] bool solve(NodePlan& plan, double barrier, int most_iterations, double tolerance);
  /// Counts an iteration and reports it; false ends the search.
  [[nodiscard]] bool goes_on(double lap_time, std::size_t nodes);

  const road::Track& track_;
  PlanModel& model_;
  Options options_;
  NodePlan calm_;                                ///< calm()
  int iterations_ = 0;                           ///< iterations of all searches
  double stationarity_ = 0.0, violation_ = 0.0;  ///< those of the last search
  double work_ = 0.0;                            ///< work()
  double expected_ = 0.0;                        ///< work of a search without retries [s]
  bool is_stopped_ = false;
  bool is_out_of_budget_ = false;
};

/// Linear feedback towards a plan, for each of its nodes: the periodic linear-quadratic regulator of the
/// model's derivatives along it (docs/limit.md, section 5).
class RingFeedback {
 public:
  /// `z`: variables of the plan's nodes.
  RingFeedback(const LimitModel& model, const RoadNodes& road, const std::vector<double>& z,
               const Tuning& tuning);

  /// Gains at node k: two rows of `driven` numbers; inputs = plan's inputs − gains · error.
  [[nodiscard]] const double* gains(std::size_t k) const noexcept {
    return gains_.data() + k * 2 * static_cast<std::size_t>(driven_);
  }

 private:
  int driven_;                 ///< LimitModel::feedback_states()
  std::vector<double> gains_;  ///< gains() of all nodes
};

/// Result of driving a plan.
struct DrivenLaps {
  bool is_clean = false;    ///< all laps driven without a boundary event
  int laps = 0;             ///< completed laps
  double best = 0.0;        ///< shortest lap time [s]
  double worst = 0.0;       ///< longest lap time [s]
  double least_edge = 0.0;  ///< smallest distance of a contact patch to the edge [m]
  double event_s = 0.0;     ///< arc length at the first boundary event [m]
};

/// Drives a plan in the plant with full state and without latency: the plan's inputs plus feedback.
[[nodiscard]] DrivenLaps drive_plan(const road::Track& track, LimitModel& model, const NodePlan& plan,
                                    sim::Plant& plant, const Tuning& tuning, int laps);

}  // namespace chicane::lap_time
