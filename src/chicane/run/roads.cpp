// SPDX-License-Identifier: MIT
// Roads shared by many runs: finds a remembered road that fits a scenario, or makes one.
#include "chicane/run/roads.hpp"

#include <algorithm>
#include <utility>

#include "chicane/run/control_cycle.hpp"

namespace chicane::run {

std::optional<double> distance_to_other_road(const road::Track& track,
                                             const model::Measurement& shown) noexcept {
  int beside = 0;
  double farthest = 0.0;
  for (int i = 0; i < shown.waypoint_count; ++i) {
    const road::Projection foot = track.centre().project(shown.waypoints[static_cast<std::size_t>(i)]);
    if (track.edge_distance(foot) < -kBesideRoad) ++beside;
    farthest = std::max(farthest, foot.distance);
  }
  if (shown.waypoint_count < 2 || 2 * beside < shown.waypoint_count) return std::nullopt;
  return farthest;
}

namespace {

/// Whether two structs have equal values in all rows of their table.
bool are_same(std::span<const Option> options, const void* a, const void* b) {
  return std::all_of(options.begin(), options.end(),
                     [&](const Option& option) { return option.read(a) == option.read(b); });
}

bool have_same_tracking(const scenario::Scenario& a, const scenario::Scenario& b) {
  using Entry = controller::TrackingMpcEntry;
  return are_same(Entry::options(), &std::get<Entry::Options>(a.controllers),
                  &std::get<Entry::Options>(b.controllers));
}

/// Whether both scenarios plan the same lap, or none.
bool plan_same_lap(const scenario::Scenario& a, const scenario::Scenario& b) {
  if (!a.races() && !b.races()) return true;
  return a.races() && b.races() && have_same_tracking(a, b);
}

/// Whether both scenarios have the same Prepared road.
bool is_same_road(const scenario::Scenario& a, const scenario::Scenario& b) {
  return a.track == b.track && a.size_of_track() == b.size_of_track() && a.vehicle.scale == b.vehicle.scale &&
         a.friction_low == b.friction_low && are_same(safety::guard_options(), &a.guard, &b.guard) &&
         plan_same_lap(a, b) &&
         ((a.guard.mode == safety::GuardMode::kOff && !a.races()) ||
          are_same(model::vehicle_options(), &a.vehicle, &b.vehicle));
}

/// Whether car and controller, which decide check_room(), are the same.
bool needs_same_room(const scenario::Scenario& a, const scenario::Scenario& b) {
  return a.controller == b.controller && are_same(model::vehicle_options(), &a.vehicle, &b.vehicle) &&
         have_same_tracking(a, b);
}

}  // namespace

Result<const Roads::Prepared*> Roads::of(const scenario::Scenario& scenario, const TrackFactory& make,
                                         const PlanHooks& hooks) {
  const auto known = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& each) { return is_same_road(each.scenario, scenario); });
  if (known != entries_.end()) return &known->prepared;
  Result<road::Track> track = make(scenario);
  if (!track) return fail(track.error());
  Result<road::Track> waypoints = make_waypoints(*track, scenario.vehicle.scale);
  if (!waypoints) return fail(waypoints.error());
  // Plan nothing for a road that the car does not fit.
  std::optional<scenario::Scenario> has_room;
  if (scenario.races()) {
    if (const Result<void> fits = run::check_room(scenario, *track); !fits) return fail(fits.error());
    has_room = scenario;
  }
  road::KnownRoad road = known_road(scenario, &*track);
  auto lap = plan_lap(scenario, &*track, hooks);
  if (!lap) return fail(lap.error());
  if (entries_.size() == kRemembered) entries_.pop_back();
  entries_.push_front(
      {scenario, {std::move(*track), std::move(*waypoints), std::move(road), std::move(*lap)}, has_room});
  return &entries_.front().prepared;
}

Result<void> Roads::check_room(const scenario::Scenario& scenario, const Prepared& road) {
  const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& each) { return &each.prepared == &road; });
  const bool is_ours = entry != entries_.end();
  if (is_ours && entry->has_room && needs_same_room(*entry->has_room, scenario)) return {};
  Result<void> fits = run::check_room(scenario, road.track);
  if (fits && is_ours) entry->has_room = scenario;
  return fits;
}

}  // namespace chicane::run
