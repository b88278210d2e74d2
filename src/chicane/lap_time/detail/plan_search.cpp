// SPDX-License-Identifier: MIT
#include "chicane/lap_time/detail/plan_search.hpp"

#include <algorithm>
#include <utility>

namespace chicane::lap_time {
namespace {

constexpr double kCoarse = 2.5;  // times the spacing, for the first solutions
constexpr int kCoarseIterations = 260;
constexpr double kCoarseTolerance = 1e-3;  // a start for the fine nodes needs no more
constexpr int kFineIterations = 300;
constexpr double kWarmBarrier = 1e-4;
constexpr double kUsable = 1e-2;             // violation of an iterate that can be driven: some centimetres
constexpr double kIterationsOfStart = 55.0;  // of a search that goes well, on coarse nodes
constexpr double kIterationsOfFine = 35.0;
constexpr const char* kStopped = "limit: stopped";
constexpr const char* kNoBudget = "limit: its budget ended before there was a plan";

NodePlan best_so_far(NodePlan plan) {
  plan.is_best_so_far = true;
  return plan;
}

/// Variables at the nodes of another ring on the same line, by linear interpolation.
std::vector<double> moved(const NodePlan& from, const RoadNodes& to, std::size_t variables) {
  std::vector<double> z(to.s.size() * variables);
  const std::size_t n = from.road.s.size();
  std::size_t i = 0;
  for (std::size_t k = 0; k < to.s.size(); ++k) {
    while (i + 1 < n && from.road.s[i + 1] <= to.s[k]) ++i;
    const double share = (to.s[k] - from.road.s[i]) / from.road.step[i];
    const std::size_t next = (i + 1) % n;
    for (std::size_t j = 0; j < variables; ++j)
      z[k * variables + j] =
          from.z[i * variables + j] + share * (from.z[next * variables + j] - from.z[i * variables + j]);
  }
  return z;
}

}  // namespace

double lap_time_of(const RoadNodes& road, const std::vector<double>& z, int variables) {
  double sum = 0.0;
  const std::size_t n = road.s.size();
  for (std::size_t k = 0; k < n; ++k) {
    const double* at = z.data() + k * static_cast<std::size_t>(variables);
    const OnRoad<double> on(road.curvature[k], at[kOffset], at[kHeading], at[kVx], at[kVy]);
    sum += 0.5 * (road.step[k] + road.step[(k + n - 1) % n]) * on.slowness;
  }
  return sum;
}

road::RacingLine line_of(const road::Track& track, std::string_view car, const PlanModel& model,
                         const NodePlan& plan, double margin) {
  road::RacingLine line;
  line.car = car;
  line.track = track.name();
  line.length = track.length();
  line.margin = margin;
  line.is_best_so_far = plan.is_best_so_far;
  const auto variables = static_cast<std::size_t>(model.functions().variables);
  const std::size_t n = plan.road.s.size();
  const auto slowness = [&](std::size_t k) {
    const double* z = plan.z.data() + k * variables;
    return OnRoad<double>(plan.road.curvature[k], z[kOffset], z[kHeading], z[kVx], z[kVy]).slowness;
  };
  double time = 0.0;
  for (std::size_t k = 0; k <= n; ++k) {
    road::RacingLinePoint p = model.point(plan.z.data() + k % n * variables);
    p.s = k < n ? plan.road.s[k] : line.length;
    p.time = time;
    line.points.push_back(p);
    if (k < n) time += 0.5 * plan.road.step[k] * (slowness(k) + slowness((k + 1) % n));
  }
  return line;
}

std::vector<double> PlanSearch::first_guess(const RoadNodes& road, double share) const {
  GuessCar car = model_.guess_car();
  car.grip *= share;
  car.drive *= share;
  car.brake *= share;
  const std::vector<double> v = guess_speeds(road.curvature, road.step, car);
  const auto variables = static_cast<std::size_t>(model_.functions().variables);
  std::vector<double> z(road.s.size() * variables, 0.0);
  for (std::size_t k = 0; k < v.size(); ++k) {
    const double next = v[(k + 1) % v.size()];
    model_.guess(v[k], (next * next - v[k] * v[k]) / (2.0 * road.step[k]), road.curvature[k],
                 z.data() + k * variables);
  }
  return z;
}

bool PlanSearch::solve(NodePlan& plan, double barrier, int most_iterations, double tolerance) {
  const NodeFunctions& f = model_.functions();
  model_.set_road(plan.road);
  std::vector<double> changes(plan.road.s.size() * static_cast<std::size_t>(f.states), 0.0);
  for (std::size_t k = 0; k < plan.road.s.size(); ++k)
    changes[k * static_cast<std::size_t>(f.states) + kHeading] = -plan.road.turn[k];
  Collocation problem(f, plan.road.step, std::move(changes));
  Collocation::Options options;
  options.first_barrier = barrier;
  options.tolerance = tolerance;
  options.most_iterations = most_iterations;
  options.go_on = [&](int, double cost, double) { return goes_on(cost, plan.road.s.size()); };
  const Collocation::Report report = problem.solve(plan.z, options);
  stationarity_ = report.stationarity;
  violation_ = report.violation;
  plan.lap_time = lap_time_of(plan.road, plan.z, f.variables);
  return report.is_solved;
}

bool PlanSearch::goes_on(double lap_time, std::size_t nodes) {
  ++iterations_;
  work_ += static_cast<double>(nodes) / PlanProgress::kNodesPerSecond;
  if (options_.on_progress) options_.on_progress({work_, expected_, lap_time});
  is_stopped_ = is_stopped_ || (options_.go_on && !options_.go_on(iterations_, lap_time));
  is_out_of_budget_ = work_ > options_.budget;
  return !is_stopped_ && !is_out_of_budget_;
}

Result<NodePlan> PlanSearch::find() {
  struct Start {
    double barrier, share;
  };
  constexpr Start kStarts[] = {{0.01, 1.0}, {0.003, 1.0}, {0.03, 0.7}, {0.001, 0.7}, {0.1, 0.5}};
  constexpr int kEnough = 2;  // solutions, of which the best goes on
  const RoadNodes coarse = lay_nodes(track_, model_.guess_car(), kCoarse * options_.time_step);
  const RoadNodes nodes = lay_nodes(track_, model_.guess_car(), options_.time_step);
  expected_ = work_ + (kEnough * kIterationsOfStart * static_cast<double>(coarse.s.size()) +
                       kIterationsOfFine * static_cast<double>(nodes.s.size())) /
                          PlanProgress::kNodesPerSecond;
  NodePlan best;
  int found = 0;
  for (const Start& start : kStarts) {
    NodePlan plan;
    plan.road = coarse;
    plan.z = first_guess(plan.road, start.share);
    const bool is_solved =
        solve(plan, start.barrier, kCoarseIterations, std::max(kCoarseTolerance, options_.tolerance));
    if (is_stopped_) return fail(ErrorCode::kInvalidArgument, kStopped);
    const bool is_usable = is_out_of_budget_ && found == 0 && violation_ <= kUsable;
    if (is_usable) return best_so_far(std::move(plan));
    if (is_out_of_budget_) break;
    if (!is_solved) continue;
    if (++found == 1 || plan.lap_time < best.lap_time) best = std::move(plan);
    if (found == kEnough) break;
  }
  if (found == 0)
    return fail(ErrorCode::kNotFound,
                is_out_of_budget_ ? kNoBudget : "limit: no optimum from any first guess");
  if (is_out_of_budget_) return best_so_far(std::move(best));
  const auto variables = static_cast<std::size_t>(model_.functions().variables);
  for (const double barrier : {kWarmBarrier, 1e-2, 1e-3}) {
    NodePlan fine;
    fine.road = nodes;
    fine.z = moved(best, fine.road, variables);
    if (solve(fine, barrier, kFineIterations, options_.tolerance)) return fine;
    if (is_stopped_) return fail(ErrorCode::kInvalidArgument, kStopped);
    if (is_out_of_budget_) return best_so_far(violation_ <= kUsable ? std::move(fine) : std::move(best));
  }
  return fail(ErrorCode::kNotFound, "limit: an optimum on coarse nodes only");
}

Result<NodePlan> PlanSearch::near(const NodePlan& plan, const Reserve& reserve) {
  model_.set_reserve(reserve);
  for (const double barrier : {kWarmBarrier, 1e-2}) {
    NodePlan next = plan;
    if (solve(next, barrier, kFineIterations, options_.tolerance)) return next;
    if (is_stopped_) return fail(ErrorCode::kInvalidArgument, kStopped);
  }
  return fail(ErrorCode::kNotFound, "limit: no optimum with more in reserve");
}

}  // namespace chicane::lap_time
