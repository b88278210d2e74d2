// SPDX-License-Identifier: MIT
// Search for a fastest lap (optima on coarse nodes from several guesses, the best one refined), the feedback
// that follows such a plan, and a drive of the plant by both as the witness of its time.
#include "chicane/lap_time/detail/plan_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "chicane/base/math.hpp"
#include "chicane/sim/world.hpp"

namespace chicane::lap_time {
namespace {

// Chosen.
constexpr double kCoarse = 2.5;            // coarse spacing over fine spacing of the nodes
constexpr int kCoarseIterations = 260;     // limit of a search on coarse nodes, which usually takes fewer
constexpr int kFineIterations = 300;       // limit of a search on fine nodes, which usually takes fewer
constexpr double kCoarseTolerance = 1e-3;  // tolerance of the starts for fine nodes
constexpr double kWarmBarrier = 1e-4;      // first barrier near a known solution
constexpr double kUsable = 1e-2;           // largest scaled violation of a plan that can be driven: some cm
// Typical iterations of a search, for the displayed progress: on coarse and on fine nodes.
constexpr double kIterationsOfStart = 55.0, kIterationsOfFine = 35.0;
constexpr const char* kStopped = "limit: stopped";
constexpr const char* kNoBudget = "limit: its budget ended before there was a plan";

/// The plan, marked as no optimum.
NodePlan best_so_far(NodePlan plan) {
  plan.is_best_so_far = true;
  return plan;
}

/// Variables of a plan at other nodes along the same line, by linear interpolation.
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

/// Best of kEnough optima on coarse nodes, from starts that differ in the solver's first barrier and in the
/// share of the car's accelerations that the first guess uses.
Result<NodePlan> PlanSearch::find_coarse() {
  struct Start {
    double barrier, share;
  };
  constexpr Start kStarts[] = {{0.01, 1.0}, {0.003, 1.0}, {0.03, 0.7}, {0.001, 0.7}, {0.1, 0.5}};
  constexpr int kEnough = 2;
  const RoadNodes coarse = lay_nodes(track_, model_.guess_car(), kCoarse * options_.time_step);
  const double iterations = kEnough * kIterationsOfStart + kIterationsOfFine * kCoarse +
                            kIterationsOfFine * static_cast<double>(options_.slip_caps.size());
  expected_ = work_ + iterations * static_cast<double>(coarse.s.size()) / PlanProgress::kNodesPerSecond;
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
    if (is_usable) return plan;
    if (is_out_of_budget_) break;
    if (!is_solved) continue;
    if (++found == 1 || plan.lap_time < best.lap_time) best = std::move(plan);
    if (found == kEnough) break;
  }
  if (found > 0) return best;
  return fail(ErrorCode::kNotFound, is_out_of_budget_ ? kNoBudget : "limit: no optimum from any first guess");
}

/// Plans for the caps on slip in order, each searched from the previous one, until a cap has none. Without a
/// cap the search converges only from near its optimum.
std::vector<NodePlan> PlanSearch::release_slip(NodePlan first) {
  std::vector<NodePlan> plans{std::move(first)};
  for (std::size_t i = 1; i < options_.slip_caps.size() && !is_out_of_budget_; ++i) {
    model_.set_reserve({.slip_share = options_.slip_caps[i]});
    NodePlan next = plans.back();
    if (!solve(next, kWarmBarrier, kCoarseIterations, kCoarseTolerance)) break;
    plans.push_back(std::move(next));
  }
  return plans;
}

Result<NodePlan> PlanSearch::find() {
  const std::span<const double> caps = options_.slip_caps;
  if (!caps.empty()) model_.set_reserve({.slip_share = caps.front()});
  Result<NodePlan> found = find_coarse();
  if (!found) return found;
  std::vector<NodePlan> coarse = release_slip(std::move(*found));
  const RoadNodes nodes = lay_nodes(track_, model_.guess_car(), options_.time_step);
  const auto on_fine_nodes = [&](const NodePlan& from) {
    const auto variables = static_cast<std::size_t>(model_.functions().variables);
    return NodePlan{.road = nodes, .z = moved(from, nodes, variables), .lap_time = from.lap_time};
  };
  calm_ = on_fine_nodes(coarse.front());
  const auto is_whole = [&] { return coarse.size() >= caps.size(); };
  for (; !coarse.empty(); coarse.pop_back()) {
    if (is_out_of_budget_) return best_so_far(std::move(coarse.back()));
    if (!caps.empty()) model_.set_reserve({.slip_share = caps[coarse.size() - 1]});
    for (const double barrier : {kWarmBarrier, 1e-2, 1e-3}) {  // after the warm start two colder ones
      NodePlan fine = on_fine_nodes(coarse.back());
      if (solve(fine, barrier, kFineIterations, options_.tolerance))
        return is_whole() ? fine : best_so_far(std::move(fine));
      if (is_stopped_) return fail(ErrorCode::kInvalidArgument, kStopped);
      if (is_out_of_budget_)
        return best_so_far(violation_ <= kUsable ? std::move(fine) : std::move(coarse.back()));
      if (!is_whole()) break;  // a plan with a smaller cap is nearer
    }
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

namespace {

using Matrix = std::vector<double>;  // row by row

/// X = A⁻¹ B with A n × n and B n × m, by elimination with row pivots.
Matrix solved(Matrix a, Matrix b, std::size_t n, std::size_t m) {
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t top = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::fabs(a[i * n + k]) > std::fabs(a[top * n + k])) top = i;
    for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[top * n + j]);
    for (std::size_t j = 0; j < m; ++j) std::swap(b[k * m + j], b[top * m + j]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double share = a[i * n + k] / a[k * n + k];
      if (share == 0.0) continue;
      for (std::size_t j = k; j < n; ++j) a[i * n + j] -= share * a[k * n + j];
      for (std::size_t j = 0; j < m; ++j) b[i * m + j] -= share * b[k * m + j];
    }
  }
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < m; ++j) b[k * m + j] /= a[k * n + k];
  return b;
}

/// Derivatives of the driven states' rates by these states and the two inputs: n rows of n + 2, with the
/// equations' own variables eliminated.
Matrix reduced_slopes(const LimitModel& model, std::size_t node, const double* z) {
  const NodeFunctions& f = model.functions();
  const auto variables = static_cast<std::size_t>(f.variables);
  const auto count = static_cast<std::size_t>(f.functions());
  const auto states = static_cast<std::size_t>(f.states);
  const auto equations = static_cast<std::size_t>(f.equations);
  const auto n = static_cast<std::size_t>(model.feedback_states());
  const auto input = static_cast<std::size_t>(model.first_input());
  std::vector<double> out(count);
  std::vector<double> slope(count * variables);
  std::vector<double> hessian(variables * (variables + 1) / 2);
  const std::vector<double> none(count, 0.0);
  f.derivatives(static_cast<int>(node), z, none.data(), out.data(), slope.data(), hessian.data());
  const std::size_t own = variables - equations;
  const auto column = [&](std::size_t j) { return j < n ? j : input + j - n; };
  Matrix follow;
  if (equations > 0) {  // δ own = −(∂e/∂own)⁻¹ ∂e/∂(x, u)
    Matrix by_own(equations * equations);
    Matrix by_rest(equations * (n + 2));
    for (std::size_t i = 0; i < equations; ++i) {
      for (std::size_t j = 0; j < equations; ++j)
        by_own[i * equations + j] = slope[(states + i) * variables + own + j];
      for (std::size_t j = 0; j < n + 2; ++j)
        by_rest[i * (n + 2) + j] = -slope[(states + i) * variables + column(j)];
    }
    follow = solved(std::move(by_own), std::move(by_rest), equations, n + 2);
  }
  Matrix result(n * (n + 2));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n + 2; ++j) {
      double sum = slope[i * variables + column(j)];
      for (std::size_t e = 0; e < equations; ++e)
        sum += slope[i * variables + own + e] * follow[e * (n + 2) + j];
      result[i * (n + 2) + j] = sum;
    }
  }
  return result;
}

}  // namespace

RingFeedback::RingFeedback(const LimitModel& model, const RoadNodes& road, const std::vector<double>& z,
                           const Tuning& tuning)
    : driven_{model.feedback_states()} {
  const auto n = static_cast<std::size_t>(driven_);
  const auto variables = static_cast<std::size_t>(model.functions().variables);
  const std::size_t nodes = road.s.size();
  const std::size_t m = n + 2;
  std::vector<Matrix> slopes(nodes);
  for (std::size_t k = 0; k < nodes; ++k) slopes[k] = reduced_slopes(model, k, z.data() + k * variables);
  const std::vector<double> error = model.error_weights();
  gains_.resize(nodes * 2 * n);
  Matrix p(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) p[i * n + i] = error[i];
  constexpr std::size_t kRounds =
      2;  // laps backwards; chosen: the second does not depend on the cost at the end
  for (std::size_t turn = kRounds * nodes; turn-- > 0;) {
    const std::size_t k = turn % nodes;
    const std::size_t next = (k + 1) % nodes;
    const double h = road.step[k];
    std::array<double, 2> weight = tuning.inputs;
    if (model.is_drive_saturated(z.data() + k * variables)) weight[1] *= tuning.saturated_pedal_factor;
    // x⁺ = A x + B u by the trapezoidal rule with the input held.
    Matrix left(n * n);
    Matrix right(n * m);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        left[i * n + j] = (i == j ? 1.0 : 0.0) - 0.5 * h * slopes[next][i * m + j];
        right[i * m + j] = (i == j ? 1.0 : 0.0) + 0.5 * h * slopes[k][i * m + j];
      }
      for (std::size_t j = n; j < m; ++j)
        right[i * m + j] = 0.5 * h * (slopes[k][i * m + j] + slopes[next][i * m + j]);
    }
    const Matrix f = solved(std::move(left), std::move(right), n, m);
    // Q = Fᵀ P F plus the weights of the step.
    Matrix pf(n * m, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t l = 0; l < n; ++l)
        for (std::size_t j = 0; j < m; ++j) pf[i * m + j] += p[i * n + l] * f[l * m + j];
    Matrix q(m * m, 0.0);
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t l = 0; l < n; ++l)
        for (std::size_t j = 0; j < m; ++j) q[i * m + j] += f[l * m + i] * pf[l * m + j];
    const double dt = h * std::max(1e-3, 1.0 / z[k * variables + kVx]);
    for (std::size_t i = 0; i < n; ++i) q[i * m + i] += dt * error[i];
    for (std::size_t i = 0; i < 2; ++i) q[(n + i) * m + n + i] += dt * weight[i];
    // Gains: the inverse of the inputs' 2 × 2 block times their rows.
    const double a = q[n * m + n];
    const double b = q[n * m + n + 1];
    const double c = q[(n + 1) * m + n + 1];
    const double det = a * c - b * b;
    double* gain = gains_.data() + k * 2 * n;
    for (std::size_t j = 0; j < n; ++j) {
      gain[j] = (c * q[n * m + j] - b * q[(n + 1) * m + j]) / det;
      gain[n + j] = (a * q[(n + 1) * m + j] - b * q[n * m + j]) / det;
    }
    // P of this node: the Riccati step.
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        p[i * n + j] = q[i * m + j] - q[n * m + i] * gain[j] - q[(n + 1) * m + i] * gain[n + j];
    // Restores symmetry: rounding differences would grow from node to node.
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) p[i * n + j] = p[j * n + i] = 0.5 * (p[i * n + j] + p[j * n + i]);
  }
}

namespace {

/// Variables and gains of a plan between its nodes.
class PlanTable {
 public:
  PlanTable(const NodePlan& plan, const RingFeedback& feedback, std::size_t variables, std::size_t driven,
            double length)
      : plan_{plan}, feedback_{feedback}, variables_{variables}, driven_{driven}, length_{length} {}

  /// Variables and, unless null, gains at the place s [m].
  void at(double s, double* z, double* gains) const {
    const std::vector<double>& nodes = plan_.road.s;
    const double wrapped = s - length_ * std::floor(s / length_);
    const auto above = std::upper_bound(nodes.begin() + 1, nodes.end(), wrapped);
    const auto k = static_cast<std::size_t>(above - nodes.begin() - 1);
    const std::size_t next = (k + 1) % nodes.size();
    const double share = (wrapped - nodes[k]) / plan_.road.step[k];
    const auto between = [share](double a, double b) { return a + share * (b - a); };
    for (std::size_t i = 0; i < variables_; ++i)
      z[i] = between(plan_.z[k * variables_ + i], plan_.z[next * variables_ + i]);
    if (gains == nullptr) return;
    for (std::size_t i = 0; i < 2 * driven_; ++i)
      gains[i] = between(feedback_.gains(k)[i], feedback_.gains(next)[i]);
  }

 private:
  const NodePlan& plan_;
  const RingFeedback& feedback_;
  std::size_t variables_, driven_;
  double length_;
};

/// Node with the least sideways and turning motion: closest to the state of a plant after reset().
std::size_t straightest(const NodePlan& plan, std::size_t variables) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < plan.road.s.size(); ++k) {
    const double* z = plan.z.data() + k * variables;
    const double motion = std::fabs(z[kYawRate]) + std::fabs(z[kVy]) + 10.0 * std::fabs(z[kSteer]);
    if (motion < least) {
      least = motion;
      best = k;
    }
  }
  return best;
}

/// Sighting of the plant for the judge.
sim::Sighting sighting_of(const sim::Plant& plant) {
  const model::State& x = plant.state();
  return {{x.x, x.y, x.psi}, plant.output().speed, plant.contact_points()};
}

}  // namespace

DrivenLaps drive_plan(const road::Track& track, LimitModel& model, const NodePlan& plan, sim::Plant& plant,
                      const Tuning& tuning, int laps) {
  model.set_road(plan.road);
  const RingFeedback feedback(model, plan.road, plan.z, tuning);
  const auto variables = static_cast<std::size_t>(model.functions().variables);
  const auto driven = static_cast<std::size_t>(model.feedback_states());
  const auto input = static_cast<std::size_t>(model.first_input());
  const PlanTable table(plan, feedback, variables, driven, track.length());
  const road::Path& line = track.centre();

  // Put the plant on the plan, at its straightest node.
  const std::size_t first = straightest(plan, variables);
  const double* z0 = plan.z.data() + first * variables;
  const road::PathPoint foot = line.at(plan.road.s[first]);
  const Vec2 place =
      foot.position + z0[kOffset] * Vec2{-chicane::sin(foot.heading), chicane::cos(foot.heading)};
  plant.reset({place.x(), place.y(), foot.heading + z0[kHeading]}, z0[kVx]);
  model.start_estimate();
  sim::Judge judge(track);
  judge.reset(0.0, sighting_of(plant));

  DrivenLaps result;
  std::vector<double> z(variables);
  std::vector<double> ahead(variables);
  std::vector<double> gains(2 * driven);
  std::vector<double> x(driven);
  const double dt = plant.step_length();
  const double most_time = (laps + 2.0) * 1.5 * plan.lap_time;  // laps may take half as long again as planned
  for (double time = 0.0; time < most_time && judge.state().lap < laps;) {
    const sim::WorldState& seen = judge.state();
    table.at(seen.s, z.data(), gains.data());
    // Inputs of the plan in the middle of the next step, for which the command acts, plus feedback.
    const OnRoad<double> on(line.at(seen.s).curvature, z[kOffset], z[kHeading], z[kVx], z[kVy]);
    table.at(seen.s + 0.5 * dt / on.slowness, ahead.data(), nullptr);
    model.read_states(plant.state(), x.data());
    x[kOffset] = seen.lateral_error;
    x[kHeading] = seen.heading_error;
    double inputs[2] = {ahead[input], ahead[input + 1]};
    for (std::size_t i = 0; i < driven; ++i) {
      const double error = i == kHeading ? wrap_angle(x[i] - z[i]) : x[i] - z[i];
      for (std::size_t j = 0; j < 2; ++j) inputs[j] -= gains[j * driven + i] * error;
    }
    // One step of the plant, and its judgement.
    const model::Command asked = model.command(plant.state(), ahead.data(), inputs);
    plant.advance(asked);
    model.update_estimate(asked, plant.output(), dt);
    time += dt;
    const int lap = judge.state().lap;
    judge.see(time, sighting_of(plant));
    if (judge.state().lap > lap) result.worst = std::max(result.worst, judge.state().last_lap_time);
    if (judge.state().off_track_events > 0) {
      result.event_s = judge.state().s;
      break;
    }
  }
  result.laps = judge.state().lap;
  result.best = judge.state().best_lap_time;
  result.least_edge = judge.state().min_edge_distance;
  result.is_clean = judge.state().off_track_events == 0 && result.laps >= laps;
  return result;
}

}  // namespace chicane::lap_time
