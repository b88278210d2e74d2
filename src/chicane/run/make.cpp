// SPDX-License-Identifier: MIT
// Parts of a run from its scenario: controller, plant, track, and waypoints as telemetry shows them.
#include "chicane/run/make.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/sim/plant_registry.hpp"

namespace chicane::run {
namespace {

// Spacing in full size; measured: median of the original's waypoints [m].
constexpr double kWaypointSpacing = 12.0;
constexpr double kFewestWaypoints = 8.0;  // least number of waypoints on any road; chosen
constexpr double kDenseShare = 0.6;       // share of the spacing below which points are thinned; chosen
constexpr double kGapShare = 0.5;  // least distance from the last to the first point, in spacings; chosen

/// Points of a track, at least `spacing` [m] apart; an open road keeps its last point.
std::vector<road::TrackPoint> thinned(const std::vector<road::TrackPoint>& raw, bool is_closed,
                                      double spacing) {
  double length = is_closed ? (raw.front().position - raw.back().position).norm() : 0.0;
  for (std::size_t i = 1; i < raw.size(); ++i) length += (raw[i].position - raw[i - 1].position).norm();
  std::vector<road::TrackPoint> kept{raw.front()};
  double along = 0.0, last = 0.0;  // distance of this point and of the last kept one [m]
  for (std::size_t i = 1; i < raw.size(); ++i) {
    along += (raw[i].position - raw[i - 1].position).norm();
    const bool is_end = !is_closed && i + 1 == raw.size();
    const bool meets_first = is_closed && length - along < kGapShare * spacing;
    if (!is_end && (along - last < spacing || meets_first)) continue;
    kept.push_back(raw[i]);
    last = along;
  }
  return kept;
}

}  // namespace

model::VehicleParams full_size(const scenario::Scenario& scenario) {
  return model::Similarity(scenario.vehicle).full_size(scenario.assumed_vehicle());
}

Result<std::unique_ptr<controller::Controller>> make_controller(const scenario::Scenario& scenario) {
  return controller::Registry::make(scenario.controller, scenario.controllers, full_size(scenario));
}

Result<std::unique_ptr<sim::Plant>> make_plant(const scenario::Scenario& scenario) {
  return sim::make_plant(scenario.plant, scenario.plant_options, scenario.plant_params);
}

Result<road::Track> make_track(const scenario::Scenario& scenario) {
  Result<std::string> file = protocol::locate(protocol::Shelf::kTrack, scenario.track);
  if (!file) return fail(file.error());
  const double size = scenario.size_of_track();
  Result<road::Track> track = protocol::read_track(*file, {.scale = scenario.scale_of_file()});
  return track && size != 1.0 ? track->scaled(size) : std::move(track);
}

Result<road::Track> make_waypoints(const road::Track& track, double scale) {
  const double spacing = std::min(kWaypointSpacing * scale, track.length() / kFewestWaypoints);
  const std::vector<road::TrackPoint>& raw = track.raw_points();
  const double mean_spacing = track.centre().length() / static_cast<double>(raw.size());
  if (mean_spacing > kDenseShare * spacing) return track;
  const bool is_closed = track.centre().is_closed();
  std::vector<road::TrackPoint> sparse = thinned(raw, is_closed, spacing);
  // Smooth in full size: the smoothing depends on the size of a road.
  for (road::TrackPoint& point : sparse)
    point = {(1.0 / scale) * point.position, point.left / scale, point.right / scale};
  Result<road::Track> waypoints = road::Track::create(track.name(), sparse, is_closed);
  return waypoints && scale != 1.0 ? waypoints->scaled(scale) : std::move(waypoints);
}

}  // namespace chicane::run
