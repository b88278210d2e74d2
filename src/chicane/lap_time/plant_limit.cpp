// SPDX-License-Identifier: MIT
#include "chicane/lap_time/plant_limit.hpp"

#include <limits>
#include <memory>

#include "chicane/lap_time/detail/limit_model.hpp"
#include "chicane/lap_time/detail/plan_driver.hpp"
#include "chicane/lap_time/detail/plan_search.hpp"
#include "chicane/lap_time/detail/tightest_bend.hpp"
#include "chicane/sim/plant_registry.hpp"

namespace chicane::lap_time {
namespace {

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
      if (Result<void> driven = drive(*optimum, limit); !driven) return fail(driven.error());
    }
    limit.is_cut_short = search_.is_out_of_budget();
    limit.effort = effort();
    return limit;
  }

 private:
  [[nodiscard]] SearchEffort effort() const { return {search_.iterations(), search_.work()}; }
  /// Plans with more and more in reserve, until one can be driven.
  Result<void> drive(const NodePlan& optimum, PlantLimit& limit) {
    stage_ = "witness";
    NodePlan from = optimum;
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

}  // namespace chicane::lap_time
