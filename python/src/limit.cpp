// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>

#include "chicane/base/math.hpp"
#include "chicane/lap_time/limit.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/make.hpp"
#include "chicane/run/plan_cache.hpp"
#include "conversion.hpp"
#include "faces.hpp"
#include "signals.hpp"

namespace chicane::python {
namespace {

struct Experiment {
  scenario::Scenario scenario;
  road::Track track;
};

Result<Experiment> experiment_of(const protocol::Request& request) {
  const Result<scenario::Scenario> scenario = protocol::compose(request);
  if (!scenario) return fail(scenario.error());
  Result<road::Track> track = run::make_track(*scenario);
  if (!track) return fail(track.error());
  return Experiment{*scenario, std::move(*track)};
}

py::list list_of(const std::array<double, 3>& values) {
  py::list list;
  for (const double value : values) list.append(value);
  return list;
}

/// Columns of a line: one array for each number of its points.
template <class Points, class... Columns>
py::dict line_of(const Points& points, const Columns&... columns) {
  py::dict line;
  const auto add = [&](const char* name, const auto& value) {
    std::vector<double> values;
    values.reserve(points.size());
    for (const auto& point : points) values.push_back(value(point));
    line[name] = to_array(std::move(values));
  };
  (add(columns.first, columns.second), ...);
  return line;
}

struct FoundLimit {
  lap_time::PlantLimit limit;
  std::vector<Vec2> points;  ///< of its line, in W [m]
};

std::vector<Vec2> points_of(const road::RacingLine& line, const road::Track& track) {
  std::vector<Vec2> points;
  for (const road::RacingLinePoint& each : line.points) {
    const road::PathPoint centre = track.centre().at(each.s);
    points.push_back(centre.position +
                     each.offset * Vec2(-chicane::sin(centre.heading), chicane::cos(centre.heading)));
  }
  return points;
}

/// The optimum of the plant's own equations, and the best lap driven.
Result<FoundLimit> plant_limit(const protocol::Request& request, bool wants_witness, SignalWatch& signals) {
  const Result<Experiment> experiment = experiment_of(request);
  if (!experiment) return fail(experiment.error());
  lap_time::PlantLimitOptions options{.wants_witness = wants_witness};
  options.go_on = [&](std::string_view, int, double) { return !signals(); };
  Result<lap_time::PlantLimit> limit = run::limit_of(experiment->scenario, experiment->track, options);
  if (!limit) return fail(limit.error());
  std::vector<Vec2> points = points_of(limit->line, experiment->track);
  return FoundLimit{std::move(*limit), std::move(points)};
}

py::dict limit(const protocol::Request& request, bool wants_witness) {
  SignalWatch signals;
  Result<FoundLimit> found = unlocked([&] { return plant_limit(request, wants_witness, signals); });
  signals.raise();
  const auto [limit, points] = value_of(std::move(found));
  using Point = road::RacingLinePoint;
  py::dict result;
  result["bound_s"] = limit.bound.lap;
  result["sector_times_s"] = list_of(limit.bound.sectors);
  result["witness_s"] =
      limit.witness ? py::object(py::float_(limit.witness->lap_time)) : py::object(py::none());
  result["iterations"] = limit.effort.iterations;
  result["violation"] = limit.violation;
  py::dict line = line_of(limit.line.points, std::pair("s_m", [](const Point& p) { return p.s; }),
                          std::pair("speed_mps", [](const Point& p) { return std::hypot(p.vx, p.vy); }));
  line["xy_m"] = to_array(points);
  result["line"] = line;
  return result;
}

}  // namespace

void add_limit(py::module_& module) {
  module.def("limit", limit, py::arg("request"), py::arg("wants_witness"));
}

}  // namespace chicane::python
