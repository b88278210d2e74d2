// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "chicane/live/pages.hpp"
#include "chicane/protocol/json_report.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/recording/recorder.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/run/closed_loop.hpp"
#include "conversion.hpp"
#include "faces.hpp"
#include "frame_columns.hpp"
#include "python_controller.hpp"
#include "python_plant.hpp"
#include "signals.hpp"

namespace chicane::python {
namespace {

constexpr double kStandingSpeed = 0.1;  // [m/s] at which a run ends whose controller has failed
constexpr double kTimeToStop = 30.0;    // [s] after which it ends anyway
constexpr double kRoadSpacing = 2.0;    // [m] between the points of the returned road

/// What was raised in Python while a run was under way.
struct Failures {
  std::shared_ptr<ControllerFailure> controller = std::make_shared<ControllerFailure>();
  std::shared_ptr<PlantFailure> plant = std::make_shared<PlantFailure>();

  /// Raises what ends a run at once.
  void raise() const {
    if (controller->interrupt) throw py::error_already_set(*controller->interrupt);
    if (plant->error) throw py::error_already_set(*plant->error);
  }
};

struct DriveOptions {
  std::string record;  ///< file; empty: nothing is recorded
  bool wants_frames = true;
};

/// What came of a run.
struct Driven {
  telemetry::RunSummary summary;
  protocol::RoadLines road;
  FrameColumns frames;
  std::vector<telemetry::Situation> situations;  ///< each once, in the order of time
};

py::list to_list(const std::vector<telemetry::Situation>& situations) {
  py::list list;
  for (const telemetry::Situation& each : situations) {
    py::dict row;
    row["time_s"] = each.kind_since;
    row["severity"] = telemetry::name_of(severity_of(each));
    row["sentence"] = sentence_of(each);
    row["reason"] = reason_of(each);
    row["ends_it"] = what_ends(each);
    row["driver"] = name_of(each.driver);
    list.append(row);
  }
  return list;
}

/// Makes an instance that calls the Python object, or the scenario's own controller for None. Called without
/// the interpreter's lock, copied and destroyed with it.
run::ControllerFactory factory_of(const py::object& controller, double step_limit,
                                  const std::shared_ptr<ControllerFailure>& failure) {
  if (controller.is_none()) return run::make_controller;
  return [=](const scenario::Scenario& scenario) -> Result<std::unique_ptr<controller::Controller>> {
    const py::gil_scoped_acquire lock;
    return std::make_unique<PythonController>(controller, scenario.vehicle, step_limit, failure);
  };
}

/// The same for the simulated car.
run::PlantFactory plant_factory_of(const py::object& plant, double step_limit,
                                   const std::shared_ptr<PlantFailure>& failure) {
  if (plant.is_none()) return run::make_plant;
  return [=](const scenario::Scenario& scenario) -> Result<std::unique_ptr<sim::Plant>> {
    const py::gil_scoped_acquire lock;
    try {
      return std::make_unique<PythonPlant>(plant, scenario.vehicle, step_limit, failure);
    } catch (const std::exception& error) {
      return chicane::fail(ErrorCode::kInvalidArgument, error.what());
    }
  };
}

/// The recording's scenario names a controller of the library in any case: readers refuse another one. Who
/// drove is in its description.
Result<std::unique_ptr<recording::Recorder>> recorder_of(const run::ClosedLoop& loop,
                                                         const std::string& file) {
  if (file.empty()) return std::unique_ptr<recording::Recorder>();
  scenario::Scenario scenario = loop.scenario();
  if (controller::Registry::find(scenario.controller) == nullptr) {
    scenario.controller = scenario::Scenario{}.controller;
    scenario.preset = scenario::Scenario{}.preset;
  }
  return recording::Recorder::create(
      {.path = file, .run = live::description(loop), .scenario = std::move(scenario), .may_wait = true});
}

/// The hooks that keep what a run tells.
run::RunHooks hooks_of(Driven& driven, recording::Recorder* recorder, bool wants_frames) {
  run::RunHooks hooks;
  hooks.on_frame = [=, &driven](const telemetry::Frame& frame) {
    if (recorder != nullptr) recorder->record(frame);
    if (!wants_frames) return;
    driven.frames.add(frame);
    const auto& seen = driven.situations;
    if (seen.empty() || seen.back().kind != frame.situation.kind)
      driven.situations.push_back(frame.situation);
  };
  if (recorder == nullptr) return hooks;
  hooks.on_lap = [=](const telemetry::CompletedLap& lap) { recorder->record(lap); };
  hooks.on_change = [=](const telemetry::Change& change) { recorder->record(change); };
  return hooks;
}

/// Without the interpreter's lock.
Result<Driven> run_to_end(const scenario::Scenario& scenario, const run::Factories& make,
                          const DriveOptions& options, const Failures& failures, SignalWatch& signals) {
  const ControllerFailure& failure = *failures.controller;
  const auto loop = run::ClosedLoop::create(scenario, make);
  if (!loop) return fail(loop.error());
  auto recorder = recorder_of(**loop, options.record);
  if (!recorder) return fail(recorder.error());
  Driven driven;
  const auto has_stopped = [&] {
    if (failure.interrupt || failures.plant->has_failed()) return true;
    const bool is_standing = (*loop)->frame().truth.vx < kStandingSpeed;
    return failure.has_failed() && (is_standing || (*loop)->time() > failure.time + kTimeToStop);
  };
  driven.summary = run::run_closed_loop(**loop, hooks_of(driven, recorder->get(), options.wants_frames),
                                        [&] { return signals() || has_stopped(); });
  driven.road = protocol::road_lines((*loop)->track(), kRoadSpacing * scenario.vehicle.scale);
  if (!*recorder) return driven;
  if (const auto report = (*recorder)->finish(); !report) return fail(report.error());
  return driven;
}

py::dict to_dict(const protocol::RoadLines& lines) {
  py::dict road;
  road["centre"] = to_array(lines.centre);
  road["left"] = to_array(lines.left);
  road["right"] = to_array(lines.right);
  return road;
}

/// The scenario; a controller written in Python has its class's name.
scenario::Scenario scenario_of(const protocol::Request& request, const py::object& controller) {
  scenario::Scenario scenario = value_of(unlocked([&] { return protocol::compose(request); }));
  if (!controller.is_none())
    scenario.controller = scenario.preset = py::str(py::type::of(controller).attr("__name__"));
  return scenario;
}

py::dict drive(const protocol::Request& request, const py::object& controller, const py::object& plant,
               const std::string& record, bool wants_frames, double step_limit) {
  const Failures failures;
  const auto& failure = failures.controller;
  const scenario::Scenario scenario = scenario_of(request, controller);
  run::Factories make = factory_of(controller, step_limit, failure);
  make.plant = plant_factory_of(plant, step_limit, failures.plant);
  SignalWatch signals;
  Driven driven = value_of(unlocked([&] {
    return run_to_end(scenario, make, {.record = record, .wants_frames = wants_frames}, failures, signals);
  }));
  signals.raise();
  failures.raise();
  py::dict result;
  result["report"] = protocol::to_json(driven.summary);
  result["table"] = protocol::to_table(driven.summary);
  result["road"] = to_dict(driven.road);
  result["frames"] = wants_frames ? driven.frames.take() : py::dict();
  result["situations"] = to_list(driven.situations);
  result["error"] = failure->text.empty() ? py::object(py::none()) : py::str(failure->text);
  result["error_time"] = failure->time;
  return result;
}

/// Computes every command of a recording again.
py::dict verify(const std::string& file, const py::object& controller, double step_limit) {
  const auto failure = std::make_shared<ControllerFailure>();
  const run::ControllerFactory make = factory_of(controller, step_limit, failure);
  const recording::ReplayReport report =
      value_of(unlocked([&] { return recording::verify_recording(file, make); }));
  if (failure->interrupt) throw py::error_already_set(*failure->interrupt);
  py::dict result;
  result["steps"] = report.steps;
  result["identical"] = report.identical;
  result["different"] = report.different;
  result["first_difference"] = report.first_difference;
  result["is_verified"] = report.is_verified();
  result["error"] = failure->text.empty() ? py::object(py::none()) : py::str(failure->text);
  return result;
}

}  // namespace

void add_drive(py::module_& module) {
  module.def("drive", drive, py::arg("request"), py::arg("controller"), py::arg("plant"), py::arg("record"),
             py::arg("wants_frames"), py::arg("step_limit_s"));
  module.def("verify", verify, py::arg("file"), py::arg("controller"), py::arg("step_limit_s"));
}

}  // namespace chicane::python
