// SPDX-License-Identifier: MIT
#include "chicane/lap_time/detail/plan_driver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chicane/base/angle.hpp"
#include "chicane/sim/judge.hpp"

namespace chicane::lap_time {
namespace {

/// Variables and gains of a plan between its nodes.
class PlanTable {
 public:
  PlanTable(const NodePlan& plan, const RingFeedback& feedback, std::size_t variables, std::size_t driven,
            double length)
      : plan_{plan}, feedback_{feedback}, variables_{variables}, driven_{driven}, length_{length} {}

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

/// Where the car moves most nearly as a plant that is put down: straight on.
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
  const auto driven = static_cast<std::size_t>(model.driven());
  const auto input = static_cast<std::size_t>(model.input());
  const PlanTable table(plan, feedback, variables, driven, track.length());
  const road::Path& line = track.centre();

  const std::size_t first = straightest(plan, variables);
  const double* z0 = plan.z.data() + first * variables;
  const road::PathPoint foot = line.at(plan.road.s[first]);
  const Vec2 place =
      foot.position + z0[kOffset] * Vec2{-chicane::sin(foot.heading), chicane::cos(foot.heading)};
  plant.reset({place.x(), place.y(), foot.heading + z0[kHeading]}, z0[kVx]);
  model.start();
  sim::Judge judge(track);
  judge.reset(0.0, sighting_of(plant));

  DrivenLaps result;
  std::vector<double> z(variables);
  std::vector<double> ahead(variables);
  std::vector<double> gains(2 * driven);
  std::vector<double> x(driven);
  const double dt = plant.step_length();
  const double most_time = (laps + 2.0) * 1.5 * plan.lap_time;
  for (double time = 0.0; time < most_time && judge.state().lap < laps;) {
    const sim::WorldState& seen = judge.state();
    table.at(seen.s, z.data(), gains.data());
    // What is asked for now acts for a step: the plan's inputs in its middle.
    const OnRoad<double> on(line.at(seen.s).curvature, z[kOffset], z[kHeading], z[kVx], z[kVy]);
    table.at(seen.s + 0.5 * dt / on.slowness, ahead.data(), nullptr);
    model.motion(plant.state(), x.data());
    x[kOffset] = seen.lateral_error;
    x[kHeading] = seen.heading_error;
    double inputs[2] = {ahead[input], ahead[input + 1]};
    for (std::size_t i = 0; i < driven; ++i) {
      const double error = i == kHeading ? wrap_angle(x[i] - z[i]) : x[i] - z[i];
      for (std::size_t j = 0; j < 2; ++j) inputs[j] -= gains[j * driven + i] * error;
    }
    const model::Command asked = model.command(plant.state(), ahead.data(), inputs);
    plant.advance(asked);
    model.see(asked, plant.output(), dt);
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
