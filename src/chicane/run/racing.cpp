// SPDX-License-Identifier: MIT
// Laps to race by: plans for a scenario's road from the cache or a search, the planner during a run, and the
// runs without one cause of lost time each.
#include "chicane/run/racing.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "chicane/base/text.hpp"
#include "chicane/controller/registry.hpp"
#include "chicane/lap_time/racing_plan.hpp"
#include "chicane/model/stability.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/run/closed_loop.hpp"
#include "chicane/run/control_cycle.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/parallel.hpp"
#include "chicane/run/plan_cache.hpp"

namespace chicane::run {
namespace {

constexpr double kModelRoad = 2.5;      // [m] width below which a road may belong to a model car; chosen
constexpr double kShareAtTheEnd = 0.9;  // share of the plan's braking at the end of an open road; chosen

const controller::TrackingMpcOptions& options_of(const scenario::Scenario& scenario) {
  return std::get<controller::TrackingMpcEntry::Options>(scenario.controllers);
}

/// Plans a lap on a road in full size, with the grip and slip of `basis.terms`. Null if none was found.
Result<PlannedLap> plan_on(const road::Track& track, const scenario::Scenario& scenario,
                           const road::RacingRoad::Basis& basis, const std::function<bool()>& go_on,
                           const PlanHooks& hooks) {
  const controller::TrackingMpcOptions& options = options_of(scenario);
  // Time from a measurement until the next command acts, in full size [s].
  const double delay =
      (scenario.latency + scenario.control_period) * model::Similarity(scenario.vehicle).time();
  lap_time::RacingPlanOptions planning{.margin = options.edge_margin,
                                       .grip_share = options.grip_share,
                                       .slip_share = basis.terms.slip * options.slip_share,
                                       .brake_share = options.brake_share,
                                       .slides = basis.terms.slides,
                                       .delay = std::max(delay, model::SlidingBound::kAssumedDelay),
                                       .speed_limit = options.speed_limit,
                                       .budget = options.plan_budget};
  planning.go_on = [&](int, double) { return !must_stop_planning() && (!go_on || go_on()); };
  planning.on_progress = hooks.on_progress;
  const model::VehicleParams car = model::with_grip(full_size(scenario), basis.terms.grip);
  const Result<road::RacingLine> lap = cached_plan(track, car, planning);
  if (!lap && lap.error().code != ErrorCode::kNotFound) return fail(lap.error());
  if (!lap) {
    if (hooks.say) hooks.say("plan: none found (" + lap.error().message + "): driving without one");
    return PlannedLap{};
  }
  if (lap->is_best_so_far && hooks.say)
    hooks.say("plan: the best so far, no optimum: tracking_mpc.plan_budget_s ended the search after " +
              number_text(options.plan_budget) + " s");
  road::RacingRoad::Basis planned = basis;
  const model::SlidingBound sliding(car, planning.delay);
  if (planning.slides && sliding.permits())
    planned.slips = {planning.slip_share * sliding.front(), planning.slip_share * sliding.most_rear()};
  planned.is_closed = track.centre().is_closed();
  if (planned.is_closed && !planned.is_learned) planned.corner_times = lap_time::corner_times(track, *lap);
  planned.room_behind = track.length() - track.start_s() - track.lap_length();
  planned.braking =
      kShareAtTheEnd * options.brake_share *
      std::min(car.brake_acceleration * car.brake_throttle_limit, car.friction * car.load_constant);
  return std::make_shared<const road::RacingRoad>(road::line_points(track, *lap), track, planned);
}

/// Advice for a road of model size under a car of full size; empty for other roads.
std::string size_remedy(const scenario::Scenario& scenario, const road::Track& track) {
  const bool may_be_model =
      scenario.vehicle.scale == 1.0 && track.left_width(0.0) + track.right_width(0.0) < kModelRoad;
  return may_be_model ? "; a road of model size needs a model car: --car f1tenth" : "";
}

/// Track in the size in which the controller of a model car sees it.
road::Track in_full_size(const road::Track& track, const scenario::Scenario& scenario) {
  const model::Similarity similarity(scenario.vehicle);
  return similarity.is_identity() ? track : track.scaled(similarity.length());
}

}  // namespace

double plan_budget(const scenario::Scenario& scenario) noexcept { return options_of(scenario).plan_budget; }

Result<void> check_room(const scenario::Scenario& scenario, const road::Track& track) {
  const bool keeps_to_the_middle =
      scenario.controller == controller::TrackingMpcEntry::kName && !scenario.races();
  const double beside =
      keeps_to_the_middle ? options_of(scenario).assumed_half_width : std::numeric_limits<double>::infinity();
  const road::Track road = in_full_size(track, scenario);
  const model::VehicleParams car = full_size(scenario);
  // Cache the result for racing scenarios only: with a cached plan their start takes milliseconds.
  const Result<void> fits = scenario.races()
                                ? cached_room(road, car, beside, scenario.vehicle.scale)
                                : lap_time::can_be_driven(road, car, beside, scenario.vehicle.scale);
  if (fits) return {};
  return fail(fits.error().code, "track: " + track.name() + " is not for the car " + scenario.vehicle.name +
                                     ": " + fits.error().message + size_remedy(scenario, track));
}

Result<PlannedLap> plan_lap(const scenario::Scenario& scenario, const road::Track* track,
                            const PlanHooks& hooks) {
  const bool is_known = track != nullptr && scenario.guard.road == safety::GuardRoad::kTrack;
  if (!scenario.races() || !is_known) return PlannedLap{};
  return plan_on(in_full_size(*track, scenario), scenario,
                 {.terms = {.grip = options_of(scenario).first_grip()}}, {}, hooks);
}

Result<PlannedLap> plan_wanted_lap(const scenario::Scenario& scenario, const road::Track* track,
                                   const controller::LapRequest& request,
                                   const std::function<bool()>& go_on) {
  const road::RacingRoad::Basis basis{.is_learned = !request.waypoints.empty(), .terms = request.terms};
  if (!basis.is_learned && track == nullptr) return PlannedLap{};
  if (!basis.is_learned) return plan_on(in_full_size(*track, scenario), scenario, basis, go_on, {});
  const model::VehicleParams car = full_size(scenario);
  const double beside = 0.5 * (car.track_width + car.tire_width);
  // Plan within the road that the guard allows.
  const bool is_guarded = scenario.guard.mode == safety::GuardMode::kOn;
  const double granted = is_guarded ? scenario.guard.half_width : std::numeric_limits<double>::infinity();
  const double half_width = std::min(options_of(scenario).assumed_half_width + beside, granted);
  std::vector<road::TrackPoint> points;
  points.reserve(request.waypoints.size());
  for (const Vec2& waypoint : request.waypoints) points.push_back({waypoint, half_width, half_width});
  const Result<road::Track> learned = road::Track::create("learned", points, true);
  if (!learned) return fail(learned.error());
  return plan_on(*learned, scenario, basis, go_on, {});
}

telemetry::Change LapPlanner::lap_change(const road::RacingRoad& lap, std::uint64_t cycle, double time) {
  const road::LapTerms& terms = lap.terms();
  std::string value = number_text(terms.grip);
  if (terms.slip != 1.0) value += std::string(kSlip) + number_text(terms.slip);
  if (terms.slides) value += kSlides;
  return {.cycle = cycle, .time = time, .name = kChange, .value = value};
}

PlannedLap LapPlanner::follow(const controller::Controller& controller, const scenario::Scenario& scenario,
                              const road::Track* track, double time) {
  const controller::LapRequest request = controller.wants_lap();
  if (!request.is_wanted) {
    if (wanted_since_ && search_) search_->cancel();
    wanted_since_.reset();
    return {};
  }
  if (!wanted_since_ || time < *wanted_since_) {
    wanted_since_ = time;
    ready_since_.reset();
    has_answered_ = false;
    if (clock_ == Clock::kReal) begin(scenario, track, request);
    return {};
  }
  if (has_answered_) return {};
  if (!ready_since_) {
    if (clock_ == Clock::kVirtual && time - *wanted_since_ < kPlanningTime) return {};
    std::optional<PlannedLap> lap =
        clock_ == Clock::kReal ? search_->take() : planned(scenario, track, request, {});
    if (!lap) return {};
    lap_ = std::move(*lap);
    ready_since_ = time;
  }
  const double near = kJoining + kJoiningGrows * (time - *ready_since_);
  if (lap_ && controller.beside(*lap_) > near) return {};
  has_answered_ = true;
  return std::exchange(lap_, nullptr);
}

std::optional<telemetry::Change> LapPlanner::advance(ClosedLoop& loop) {
  const auto lap = follow(loop.controller(), loop.scenario(), &loop.track(), loop.time());
  if (!lap) return {};
  loop.use_line(lap);
  return lap_change(*lap, loop.cycle(), loop.time());
}

std::optional<telemetry::Change> LapPlanner::advance(ControlCycle& cycle, const scenario::Scenario& scenario,
                                                     const road::Track* track, double time) {
  const auto lap = follow(cycle.controller(), scenario, track, time);
  if (!lap) return {};
  cycle.use_line(lap);
  return lap_change(*lap, cycle.next(), time);
}

void LapPlanner::begin(const scenario::Scenario& scenario, const road::Track* track,
                       const controller::LapRequest& request) {
  if (!search_)
    search_.emplace([](Search search, const std::function<bool()>& is_wanted) {
      search.request.waypoints = search.waypoints;
      return planned(search.scenario, search.track, search.request, is_wanted);
    });
  search_->begin({scenario, track, request, {request.waypoints.begin(), request.waypoints.end()}});
}

PlannedLap LapPlanner::planned(const scenario::Scenario& scenario, const road::Track* track,
                               const controller::LapRequest& request,
                               const std::function<bool()>& is_wanted) {
  Result<PlannedLap> lap = plan_wanted_lap(scenario, track, request, is_wanted);
  return lap ? std::move(*lap) : PlannedLap{};
}

namespace {

using scenario::Scenario;

controller::TrackingMpcOptions* tracking_options(Scenario& scenario) {
  using Entry = controller::TrackingMpcEntry;
  if (scenario.controller != Entry::kName) return nullptr;
  return &std::get<Entry::Options>(scenario.controllers);
}

// Each function removes one cause of lost time, and returns whether the scenario had that cause.

bool drop_latency(Scenario& scenario) {
  const bool has = scenario.latency > 0.0 || scenario.latency_jitter > 0.0;
  scenario.latency = scenario.latency_jitter = 0.0;
  return has;
}

bool drop_sensor_errors(Scenario& scenario) {
  const bool has = !(scenario.sensor == sim::SensorOptions{});
  scenario.sensor = {};
  return has;
}

bool drop_edge_margin(Scenario& scenario) {
  controller::TrackingMpcOptions* options = tracking_options(scenario);
  if (options == nullptr || !scenario.races()) return false;
  // The guard would stop a car within its own margin: let the guard observe only.
  if (scenario.guard.mode == safety::GuardMode::kOn) scenario.guard.mode = safety::GuardMode::kObserve;
  return std::exchange(options->edge_margin, 0.0) > 0.0;
}

bool drop_grip_reserve(Scenario& scenario) {
  controller::TrackingMpcOptions* options = tracking_options(scenario);
  if (options == nullptr) return false;
  const double grip = std::exchange(options->grip_share, 1.0);
  const double brake = std::exchange(options->brake_share, 1.0);
  return grip < 1.0 || brake < 1.0;
}

bool drop_guard(Scenario& scenario) {
  return std::exchange(scenario.guard.mode, safety::GuardMode::kOff) != safety::GuardMode::kOff;
}

struct Cause {
  const char* name;
  bool (*drop)(Scenario&);
};
constexpr Cause kCauses[] = {{"latency", drop_latency},
                             {"sensor", drop_sensor_errors},
                             {"edge margin", drop_edge_margin},
                             {"grip reserve", drop_grip_reserve},
                             {"guard", drop_guard}};

lap_time::LapWithout best_of(const char* cause, const telemetry::RunSummary& run) {
  lap_time::LapWithout without{.cause = cause, .off_track_events = run.off_track_events};
  const auto best = std::min_element(run.laps.begin(), run.laps.end(),
                                     [](const auto& a, const auto& b) { return a.lap_time < b.lap_time; });
  if (best == run.laps.end()) return without;
  without.lap_time = best->lap_time;
  without.corners = best->corner_times;
  return without;
}

}  // namespace

Result<std::vector<lap_time::LapWithout>> laps_without(const Scenario& scenario,
                                                       const std::function<bool()>& go_on) {
  struct Variant {
    const char* cause;
    Scenario scenario;
    std::optional<Result<lap_time::LapWithout>> driven{};
  };
  std::vector<Variant> variants;
  for (const Cause& cause : kCauses) {
    Scenario changed = scenario;
    if (cause.drop(changed)) variants.push_back({cause.name, std::move(changed)});
  }
  for_each_run(variants.size(), threads_for(0), [&](std::uint64_t i, Roads& roads) {
    Variant& variant = variants[i];
    const auto stop = [&] { return go_on && !go_on(); };
    if (stop()) return false;
    const auto loop = ClosedLoop::create(variant.scenario, roads);
    if (!loop) {
      variant.driven = fail(loop.error());
      return false;
    }
    const telemetry::RunSummary run = run_closed_loop(**loop, {}, stop);
    if (!stop()) variant.driven = best_of(variant.cause, run);
    return true;
  });
  std::vector<lap_time::LapWithout> laps;
  for (Variant& variant : variants) {
    if (!variant.driven) continue;
    if (!*variant.driven) return fail(variant.driven->error());
    laps.push_back(std::move(**variant.driven));
  }
  return laps;
}

}  // namespace chicane::run
