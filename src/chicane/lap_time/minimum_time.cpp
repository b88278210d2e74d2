// SPDX-License-Identifier: MIT
#include "chicane/lap_time/minimum_time.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "chicane/base/math.hpp"
#include "chicane/lap_time/detail/limit_solver.hpp"
#include "chicane/lap_time/detail/message.hpp"

namespace chicane::lap_time {
namespace {

using Problem = LimitProblem;
using State = Problem::State;
using Input = Problem::Input;

constexpr double kRunIn = 600.0;  // [m] before and behind the lap, but at most a lap

// Prices for leaving the round before (eq. 17), for each metre; times a common factor.
constexpr double kNearOffset = 1e-4;
constexpr double kNearCourse = 0.1;
constexpr double kNearSpeed = 5e-5;
constexpr double kNearCurvature = 30.0;
constexpr double kNearForce = 2e-4;
constexpr double kNearBend = 1.0;
constexpr double kFirstNearness = 10.0;
constexpr double kMostNearness = 1e5;
constexpr double kNearer = 3.0;   // after a round that failed
constexpr double kLooser = 0.75;  // after one that did not

// A search has ended when so many rounds in succession changed the lap time by less, and the lap is closed.
constexpr int kCalmRounds = 3;
constexpr double kSameTime = 5e-5;   // relative
constexpr double kSeamOffset = 0.3;  // [m]
constexpr double kSeamSpeed = 0.1;   // [m/s]

// Prices of changes (eq. 8), for each metre.
constexpr double kCurvaturePrice = 1e-4;
constexpr double kForcePrice = 2.5e-5;

struct Leg {
  std::size_t run = 0;  ///< stages before the lap
  std::size_t lap = 0;  ///< of the lap
  std::size_t all = 0;  ///< of the problem
};

class Search {
 public:
  Search(const path::Track& track, const model::VehicleParams& vehicle, const LimitOptions& options)
      : track_{track}, options_{options}, solver_{solver_options()} {
    problem_.car = LimitCar(vehicle);
    const double length = track.length();
    const double run_in = std::min(kRunIn, length);
    const double least = (length + 2.0 * run_in) / (Problem::kCapacity - 8.0);
    leg_.lap = static_cast<std::size_t>(std::ceil(length / std::max(options.spacing, least)));
    problem_.step = length / static_cast<double>(leg_.lap);
    leg_.run = std::min(leg_.lap, static_cast<std::size_t>(run_in / problem_.step));
    leg_.all = leg_.lap + 2 * leg_.run;
    problem_.horizon = static_cast<int>(leg_.all);
    problem_.root_curvature_price = std::sqrt(kCurvaturePrice * problem_.step);
    const double settle = std::max(1.5 * problem_.step, kSettle);
    problem_.feedback = {.n = 1.0 / (kReach * kReach * settle * Problem::kCurvatureSlope),
                         .course = 1.6 / (kReach * settle * Problem::kCurvatureSlope),
                         .curvature = 1.0 / (settle * Problem::kCurvatureSlope),
                         .speed = kSpeedGain / (settle * Problem::kForceSlope),
                         .force = 1.0 / (settle * Problem::kForceSlope)};
    problem_.root_force_price = std::sqrt(kForcePrice * problem_.step);
    start_ = track.start_s() - static_cast<double>(leg_.run) * problem_.step;
  }

  Result<Limit> run() {
    if (Result<void> laid = lay_road(); !laid) return fail(laid.error());
    begin();
    double nearness = kFirstNearness;
    for (report_.rounds = 1; report_.rounds <= options_.most_rounds; ++report_.rounds) {
      const bool is_solved = round(nearness);
      if (is_solved && options_.go_on && !options_.go_on(report_.rounds, lap_time(now_)))
        return fail(ErrorCode::kInvalidArgument, "limit: stopped");
      if (is_solved && has_settled()) return finish();
      nearness *= is_solved ? kLooser : kNearer;
      if (nearness > kMostNearness) break;
    }
    return fail(
        ErrorCode::kInvalidArgument,
        message("limit: no optimum after %.0f rounds: lap time %.3f s, changed by %.1e in the last one",
                static_cast<double>(report_.rounds - 1), lap_time(now_), report_.last_change) +
            message("; seam open by %.3f m and %.3f m/s", report_.seam_offset, report_.seam_speed));
  }

 private:
  static solver::SolverOptions solver_options() {
    return {.tolerance = 1e-6, .loose_tolerance = 1e-4, .max_iterations = 25, .may_start_short = false};
  }
  [[nodiscard]] double place(std::size_t k) const { return start_ + static_cast<double>(k) * problem_.step; }

  /// Where the middles of the axles may be; what the line's curvature adds at an axle is in the edges.
  Result<void> lay_road() {
    const LimitCar& car = problem_.car;
    Problem::Road& road = problem_.road;
    for (std::size_t k = 0; k <= leg_.all; ++k) {
      const double s = place(k);
      const double bend = track_.centre().at(s).curvature;
      road.curvature[k] = track_.centre().at(s + 0.5 * problem_.step).curvature;
      const auto room = [&](double axle, auto& left, auto& right) {
        const double margin = track_.kerb_width() - car.half_width;
        const double shift = 0.5 * bend * axle * axle;
        left[k] = track_.left_width(s + axle) + margin + shift;
        right[k] = shift - track_.right_width(s + axle) - margin;
      };
      room(car.front_axle, road.front_left, road.front_right);
      room(-car.rear_axle, road.rear_left, road.rear_right);
      if (road.front_left[k] <= road.front_right[k]) {
        return fail(
            ErrorCode::kInvalidArgument,
            message("limit: the road is %.2f m wide at s = %.1f m, expected more than the car's %.2f m",
                    track_.left_width(s) + track_.right_width(s) + 2.0 * track_.kerb_width(),
                    track_.centre().wrap(s), 2.0 * car.half_width));
      }
    }
    return {};
  }

  /// The first guess: the middle of the room, at a speed the car certainly has the grip for.
  void begin() {
    const LimitCar& car = problem_.car;
    std::vector<double> speed(leg_.lap);
    const auto at = [&](std::size_t k) -> double& { return speed[k % leg_.lap]; };
    for (std::size_t k = 0; k < leg_.lap; ++k) {
      double sharpest = 1e-4;
      for (std::size_t j = 0; j <= 4; ++j)
        sharpest = std::max(sharpest,
                            std::fabs(problem_.road.curvature[leg_.run + (k + leg_.lap + j - 2) % leg_.lap]));
      speed[k] = std::min(kGuessSpeed, std::sqrt(kGuessShare * car.grip_0 / sharpest));
    }
    for (std::size_t k = 2 * leg_.lap; k-- > 0;)
      at(k) = std::min(at(k), std::sqrt(at(k + 1) * at(k + 1) + kGuessBraking * problem_.step));
    for (std::size_t k = 0; k < 2 * leg_.lap; ++k)
      at(k + 1) = std::min(at(k + 1), std::sqrt(at(k) * at(k) + kGuessDrive * problem_.step));
    now_.horizon = problem_.horizon;
    for (std::size_t k = 0; k <= leg_.all; ++k) {
      const double v = at(k + leg_.lap - leg_.run % leg_.lap);
      const double next = at(k + 1 + leg_.lap - leg_.run % leg_.lap);
      now_.x[k] = {0.0, 0.0, v, problem_.road.curvature[k],
                   (next * next - v * v) / (2.0 * problem_.step) + car.drag(v)};
      if (k == 0) continue;
      now_.u[k - 1] = {(now_.x[k][3] - now_.x[k - 1][3]) / (problem_.step * Problem::kCurvatureSlope),
                       (now_.x[k][4] - now_.x[k - 1][4]) / (problem_.step * Problem::kForceSlope)};
    }
  }

  /// The line known so far becomes what the next round is near to, and its first guess. The stages before and
  /// behind the lap are those of a lap later and earlier: what is open at the seam closes here.
  void centre() {
    next_.horizon = now_.horizon;
    Problem::Centre& to = problem_.centre;
    for (std::size_t k = 0; k <= leg_.all; ++k) {
      const std::size_t from = k < leg_.run ? k + leg_.lap : (k > leg_.run + leg_.lap ? k - leg_.lap : k);
      const State& x = now_.x[from];
      to.n[k] = x[Problem::kN];
      to.course[k] = x[Problem::kCourse];
      to.speed[k] = x[Problem::kSpeed];
      to.curvature[k] = x[Problem::kCurvature];
      to.force[k] = x[Problem::kForce];
      if (k == leg_.all) break;
      next_.u[k] = now_.u[from];
      to.bend[k] = next_.u[k][0];
    }
  }

  /// Solves the problem near the line known so far. False when the solver did not get there.
  bool round(double nearness) {
    centre();
    const auto root = [&](double price) { return std::sqrt(nearness * price * problem_.step); };
    problem_.near = {root(kNearOffset),    root(kNearCourse), root(kNearSpeed),
                     root(kNearCurvature), root(kNearForce),  root(kNearBend)};
    const State begin = now_.x[leg_.lap];
    const solver::SolveReport solved = solver_.solve(problem_, begin, next_);
    report_.iterations += solved.iterations;
    if (!usable(solved.status) || solved.defect > 1e-6) return false;
    compare();
    report_.stationarity = solved.stationarity;
    report_.violation = solved.violation;
    for (std::size_t k = 0; k < leg_.all; ++k) {  // the changes themselves, without feedback
      const auto [bend, push] = problem_.changes(static_cast<int>(k), next_.x[k], next_.u[k]);
      next_.u[k] = {bend, push};
    }
    now_ = next_;
    return true;
  }

  void compare() {
    report_.last_offset = 0.0;
    for (std::size_t k = leg_.run; k < leg_.run + leg_.lap; ++k)
      report_.last_offset = std::max(report_.last_offset, std::fabs(next_.x[k][0] - now_.x[k][0]));
    report_.last_change = std::fabs(lap_time(next_) / lap_time(now_) - 1.0);
    calm_ = report_.last_change <= kSameTime ? calm_ + 1 : 0;
    const State& first = next_.x[leg_.run];
    const State& last = next_.x[leg_.run + leg_.lap];
    report_.seam_offset = std::fabs(last[Problem::kN] - first[Problem::kN]);
    report_.seam_speed = std::fabs(last[Problem::kSpeed] - first[Problem::kSpeed]);
  }
  [[nodiscard]] bool has_settled() const {
    return calm_ >= kCalmRounds && report_.seam_offset <= kSeamOffset && report_.seam_speed <= kSeamSpeed;
  }

  [[nodiscard]] double lap_time(const LimitTrajectory& t) const {
    double sum = 0.0;
    for (std::size_t k = leg_.run; k < leg_.run + leg_.lap; ++k)
      sum += problem_.time(static_cast<int>(k), t.x[k]);
    return sum;
  }

  [[nodiscard]] path::LinePoint point(std::size_t k, double time) const {
    const LimitCar& car = problem_.car;
    const State& x = now_.x[k];
    const auto& [n, course, v, kappa, force] = x;
    path::LinePoint p;
    p.s = track_.centre().wrap(place(k));
    p.time = time;
    p.d = n;
    const path::PathPoint foot = track_.centre().at(place(k));
    p.position = foot.position + n * Vec2{-chicane::sin(foot.heading), chicane::cos(foot.heading)};
    p.heading = foot.heading + course;
    p.curvature = kappa;
    p.speed = v;
    p.lateral_acceleration = v * v * kappa;
    p.longitudinal_acceleration =
        force - car.drag(v) - car.slip_drag * p.lateral_acceleration * p.lateral_acceleration / car.load(v);
    p.left = track_.left_width(place(k)) - n;
    p.right = track_.right_width(place(k)) + n;
    return p;
  }

  Limit finish() {
    Limit limit;
    report_.stages = static_cast<int>(leg_.all);
    report_.spacing = problem_.step;
    limit.report = report_;
    limit.top_speed = 0.0;
    limit.least_speed = now_.x[leg_.run][Problem::kSpeed];
    std::array<double, 4> split{};
    double time = 0.0;
    for (std::size_t i = 0; i < leg_.lap; ++i) {
      const std::size_t k = leg_.run + i;
      limit.line.push_back(point(k, time));
      limit.top_speed = std::max(limit.top_speed, now_.x[k][Problem::kSpeed]);
      limit.least_speed = std::min(limit.least_speed, now_.x[k][Problem::kSpeed]);
      const double taken = problem_.time(static_cast<int>(k), now_.x[k]);
      for (std::size_t third = 1; third <= 3; ++third) {  // its crossing, between stages
        const double at = static_cast<double>(third * leg_.lap) / 3.0 - static_cast<double>(i);
        if (at > 0.0 && at <= 1.0) split[third] = time + at * taken;
      }
      limit.line_length += problem_.path(static_cast<int>(k), now_.x[k]).first;
      time += taken;
    }
    path::LinePoint last = point(leg_.run + leg_.lap, time);
    limit.line.push_back(last);
    limit.times.lap = time;
    split[3] = time;
    for (std::size_t i = 0; i < 3; ++i) limit.times.sectors[i] = split[i + 1] - split[i];
    limit.mean_speed = limit.line_length / time;
    return limit;
  }

  static constexpr double kGuessSpeed = 40.0;   // [m/s]
  static constexpr double kGuessShare = 0.5;    // of the grip at rest
  static constexpr double kGuessBraking = 8.0;  // twice an acceleration [m/s²]
  static constexpr double kGuessDrive = 4.0;
  static constexpr double kReach = 8.0;      // of the feedback: to the line [m]
  static constexpr double kSettle = 4.0;     // and of curvature and force [m]
  static constexpr double kSpeedGain = 1.0;  // [1/s]

  const path::Track& track_;
  LimitOptions options_;
  LimitSolver solver_;
  Problem problem_;
  Leg leg_;
  double start_ = 0.0;
  LimitTrajectory now_;   ///< the best known
  LimitTrajectory next_;  ///< the one being made
  LimitReport report_;
  int calm_ = 0;  ///< rounds in succession that changed next to nothing
};

}  // namespace

Result<Limit> find_limit(const path::Track& track, const model::VehicleParams& vehicle,
                         const LimitOptions& options) {
  if (Result<void> valid = model::validate(vehicle); !valid) return fail(valid.error());
  if (vehicle.scale != 1.0)
    return fail(ErrorCode::kInvalidArgument,
                message("limit: got a model car of scale %g, expected one in full size", vehicle.scale));
  if (!track.centre().is_closed())
    return fail(ErrorCode::kInvalidArgument,
                track.name() + ": the road is open, expected a closed one: a lap has no end");
  if (!(options.spacing >= 0.5 && options.spacing <= 5.0))
    return fail(ErrorCode::kInvalidArgument,
                message("limit: spacing: got %g m, expected 0.5 to 5", options.spacing));
  return std::make_unique<Search>(track, vehicle, options)->run();
}

}  // namespace chicane::lap_time
