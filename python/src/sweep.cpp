// SPDX-License-Identifier: MIT
#include "chicane/sweep/sweep.hpp"

#include <atomic>
#include <optional>
#include <string>

#include "chicane/run/parallel.hpp"
#include "chicane/sweep/plan_codec.hpp"
#include "conversion.hpp"
#include "faces.hpp"
#include "signals.hpp"

namespace chicane::python {
namespace {

/// Drives a plan into a file, as `chicane sweep` does; what is in the file already is not driven again.
py::dict sweep(const std::string& plan_text, const std::string& name, const std::string& file, int jobs) {
  const sweep::Plan plan = value_of(sweep::parse_plan(plan_text, name));
  std::atomic<bool> stop{false};
  std::optional<Result<sweep::Progress>> progress;
  run_with_signals(stop, [&] {
    progress = sweep::drive_plan(plan, {}, {.jobs = run::threads_for(jobs), .file = file}, stop);
  });
  const sweep::Progress done = value_of(std::move(*progress));
  py::dict result;
  result["runs"] = done.runs;
  result["found"] = done.found;
  result["driven"] = done.driven;
  result["failed"] = done.failed;
  result["why"] = done.why;
  return result;
}

}  // namespace

void add_sweep(py::module_& module) {
  module.def("sweep", sweep, py::arg("plan"), py::arg("name"), py::arg("file"), py::arg("jobs"));
}

}  // namespace chicane::python
