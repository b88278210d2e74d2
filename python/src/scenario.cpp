// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "chicane/base/instruction_set.hpp"
#include "chicane/protocol/frame_fields.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/sim/fault.hpp"
#include "chicane/version.hpp"
#include "conversion.hpp"
#include "faces.hpp"

namespace chicane::python {
namespace {

protocol::Shelf shelf_named(const std::string& name) {
  if (name == "presets") return protocol::Shelf::kPreset;
  if (name == "cars") return protocol::Shelf::kCar;
  if (name == "tracks") return protocol::Shelf::kTrack;
  if (name == "scenarios") return protocol::Shelf::kScenario;
  throw py::value_error("list: got \"" + name + "\", expected presets, cars, tracks or scenarios");
}

/// Names and descriptions of what ships.
py::dict entries(const std::string& shelf) {
  py::dict known;
  for (const protocol::Entry& entry : protocol::entries(shelf_named(shelf)))
    known[py::str(entry.name)] = entry.description;
  return known;
}

/// Every setting: its key, unit and meaning.
py::dict parameters() {
  py::dict known;
  for (const protocol::Parameter& row : protocol::list())
    known[to_text(row.key)] = py::make_tuple(to_text(row.option.unit.name), to_text(row.option.meaning));
  return known;
}

py::dict faults() {
  py::dict known;
  for (const sim::FaultKind& kind : sim::fault_kinds()) known[to_text(kind.name)] = to_text(kind.meaning);
  return known;
}

/// What the columns of frames mean.
py::dict frame_fields() {
  py::dict known;
  for (const protocol::FrameGroup& group : protocol::frame_groups())
    for (const protocol::FrameField& field : group.fields)
      known[to_text(field.name)] = to_text(field.meaning);
  return known;
}

}  // namespace

void add_scenario(py::module_& module) {
  py::class_<protocol::Request>(module, "Request")
      .def(py::init([](std::string scenario, std::vector<std::pair<std::string, std::string>> settings,
                       std::string speed, std::vector<std::string> wanted_faults) {
             return protocol::Request{std::move(scenario), std::move(settings), std::move(speed),
                                      std::move(wanted_faults)};
           }),
           py::arg("scenario"), py::arg("settings"), py::arg("speed_mps"), py::arg("faults"));
  module.def("entries", entries, py::arg("shelf"));
  module.def("parameters", parameters);
  module.def("faults", faults);
  module.def("frame_fields", frame_fields);
  module.def("check_processor", [] { value_of(environment_instruction_set()); });
  module.attr("__version__") = std::to_string(CHICANE_VERSION_MAJOR) + "." +
                               std::to_string(CHICANE_VERSION_MINOR) + "." +
                               std::to_string(CHICANE_VERSION_PATCH);
}

}  // namespace chicane::python
