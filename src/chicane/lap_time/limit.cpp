// SPDX-License-Identifier: MIT
// Limit of a plant on a track: the search for the optimum, then plans with more and more reserve until one
// can be driven as a witness.
#include "chicane/lap_time/limit.hpp"

#include <algorithm>

#include "chicane/base/math.hpp"
#include "chicane/lap_time/detail/limit_model.hpp"
#include "chicane/lap_time/detail/plan_model.hpp"
#include "chicane/lap_time/detail/plan_search.hpp"
#include "chicane/sim/plant_registry.hpp"

namespace chicane::lap_time {
namespace {

/// Times of a lap and its thirds from the place `start_s` [m] on; without corners.
LapTimes times_of(const road::RacingLine& line, double start_s) {
  LapTimes times;
  times.lap = line.lap_time();
  const auto since = [&](double share) {
    const double t = line.at(start_s + share * line.length).time - line.at(start_s).time;
    return t < 0.0 ? t + times.lap : t;
  };
  const double first = since(1.0 / 3.0);
  const double second = since(2.0 / 3.0);
  times.sectors = {first, second - first, times.lap - second};
  return times;
}

/// Search of a limit: the optimum, then its witness.
class Finder {
 public:
  Finder(const road::Track& track, std::string_view name, const sim::PlantDeviation& deviation,
         const PlantLimitOptions& options, LimitModel& model, sim::Plant& plant)
      : track_{track},
        name_{name},
        options_{options},
        model_{model},
        plant_{plant},
        search_{track,
                model,
                {.time_step = options.time_step,
                 .slip_caps = model.slip_caps(),
                 .budget = options.budget,
                 .go_on =
                     [this](int iteration, double time) {
                       return !options_.go_on || options_.go_on(stage_, iteration, time);
                     },
                 .on_progress = options.on_progress}} {
    plant_.deviate(deviation);
  }

  Result<PlantLimit> run() {
    const Result<NodePlan> optimum = search_.find();
    if (!optimum) return fail(optimum.error());
    PlantLimit limit;
    limit.line = line_of(track_, name_, model_, *optimum, 0.0);
    limit.bound = times_of(limit.line, track_.start_s());
    limit.nodes = static_cast<int>(optimum->road.s.size());
    limit.stationarity = search_.stationarity();
    limit.violation = search_.violation();
    limit.of_optimum = effort();
    if (options_.wants_witness && !search_.is_out_of_budget()) {
      if (Result<void> driven = drive(search_.calm(), limit); !driven) return fail(driven.error());
    }
    limit.is_cut_short = search_.is_out_of_budget();
    limit.effort = effort();
    return limit;
  }

 private:
  [[nodiscard]] SearchEffort effort() const { return {search_.iterations(), search_.work()}; }
  /// Drives plans with more and more reserve, until one stays on the road.
  Result<void> drive(NodePlan from, PlantLimit& limit) {
    stage_ = "witness";
    for (const Reserve& reserve : model_.reserves()) {
      Result<NodePlan> plan = search_.near(from, reserve);
      if (search_.is_stopped()) return fail(plan.error());
      if (search_.is_out_of_budget()) break;
      if (!plan) continue;
      from = *plan;
      for (const Tuning& tuning : model_.tunings()) {
        const DrivenLaps laps = drive_plan(track_, model_, *plan, plant_, tuning, options_.laps);
        if (!laps.is_clean || (limit.witness && limit.witness->lap_time <= laps.best)) continue;
        limit.witness = Witness{.lap_time = laps.best,
                                .worst = laps.worst,
                                .laps = laps.laps,
                                .least_edge = laps.least_edge,
                                .line = line_of(track_, name_, model_, *plan, reserve.margin)};
      }
      if (limit.witness) break;
    }
    return {};
  }

  const road::Track& track_;
  std::string_view name_;
  const PlantLimitOptions& options_;
  LimitModel& model_;
  sim::Plant& plant_;
  std::string_view stage_ = "optimum";
  PlanSearch search_;
};

}  // namespace

double PlantLimit::bracket() const noexcept {
  return witness ? gap(witness->lap_time, bound.lap) : std::numeric_limits<double>::quiet_NaN();
}

Result<PlantLimit> find_plant_limit(const road::Track& track, std::string_view plant,
                                    const sim::PlantDeviation& deviation, const PlantLimitOptions& options,
                                    const sim::DoubleTrackParams& params) {
  if (!track.centre().is_closed())
    return fail(ErrorCode::kInvalidArgument,
                track.name() + ": the road is open, expected a closed one: a lap has no end");
  if (!(options.time_step >= 0.01 && options.time_step <= 0.2))
    return fail(ErrorCode::kInvalidArgument, "limit: time step: expected 0.01 to 0.2 s");
  if (!(options.budget > 0.0)) return fail(ErrorCode::kInvalidArgument, "limit: budget: expected > 0 s");
  Result<std::unique_ptr<LimitModel>> model = make_limit_model(plant, deviation, params);
  if (!model) return fail(model.error());
  Result<std::unique_ptr<sim::Plant>> car = sim::make_plant(plant, deviation, params);
  if (!car) return fail(car.error());
  if (Result<void> fits = fits_road(track, (*model)->size()); !fits) return fail(fits.error());
  return Finder(track, plant, deviation, options, **model, **car).run();
}

namespace {

/// The closed line `lap`, with its first point at `start` [m] and its time counted from there.
road::RacingLine beginning_at(const road::RacingLine& lap, double start) {
  constexpr double kSamePlace = 1e-6;  // [m]
  const road::RacingLinePoint first = lap.at(start);
  road::RacingLine line = lap;
  line.points = {first};
  const auto add = [&](auto is_wanted) {
    for (std::size_t i = 0; i + 1 < lap.points.size(); ++i)
      if (is_wanted(lap.points[i].s - first.s)) line.points.push_back(lap.points[i]);
  };
  add([](double ahead) { return ahead > kSamePlace; });
  add([](double ahead) { return ahead < -kSamePlace; });
  line.points.push_back(first);
  for (road::RacingLinePoint& point : line.points) {
    point.time -= first.time;
    if (point.time < 0.0) point.time += lap.lap_time();
  }
  line.points.back().time = lap.lap_time();
  return line;
}

}  // namespace

std::vector<double> corner_times(const road::Track& track, const road::RacingLine& line) {
  if (line.is_empty()) return {};
  const road::RacingLine lap = beginning_at(line, track.centre().wrap(track.start_s()));
  const auto distance = [&](std::size_t i) {
    return i + 1 < lap.points.size() ? track.centre().wrap(lap.points[i].s - lap.points.front().s)
                                     : track.length();
  };
  std::vector<double> times = road::corner_sectors(track, road::corners_of(track));
  double begin = 0.0;
  std::size_t i = 1;
  for (double& time : times) {
    while (i + 1 < lap.points.size() && distance(i) < time) ++i;
    const double share = (time - distance(i - 1)) / (distance(i) - distance(i - 1));
    const double end =
        lap.points[i - 1].time + std::min(share, 1.0) * (lap.points[i].time - lap.points[i - 1].time);
    time = end - begin;
    begin = end;
  }
  return times;
}

Limit bound_from_start(const road::Track& track, const PlantLimit& limit) {
  Limit from_start{.times = limit.bound, .line = {}};
  if (limit.line.is_empty()) return from_start;
  from_start.line = road::line_points(track, beginning_at(limit.line, track.centre().wrap(track.start_s())));
  // Headings are continuous, also across the beginning of the centre line.
  for (std::size_t i = 1; i < from_start.line.size(); ++i) {
    const double before = from_start.line[i - 1].heading;
    from_start.line[i].heading = before + angle_difference(from_start.line[i].heading, before);
  }
  from_start.times.corners = corner_times(track, limit.line);
  return from_start;
}

}  // namespace chicane::lap_time
