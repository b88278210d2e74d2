// SPDX-License-Identifier: MIT
#include "faces.hpp"

PYBIND11_MODULE(_chicane, module) {
  using namespace chicane::python;
  add_scenario(module);
  add_controller(module);
  add_plant(module);
  add_drive(module);
  add_recording(module);
  add_limit(module);
  add_sweep(module);
  add_view(module);
  add_environment(module);
  add_problem(module);
}
