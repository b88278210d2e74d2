// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

/// The compiled part of the Python module `chicane`: one function for each face, which adds its names to the
/// module. What users see of them is in python/chicane; docstrings with shapes and units are there.
namespace chicane::python {

void add_scenario(pybind11::module_& module);
void add_controller(pybind11::module_& module);
void add_plant(pybind11::module_& module);
void add_drive(pybind11::module_& module);
void add_recording(pybind11::module_& module);
void add_limit(pybind11::module_& module);
void add_sweep(pybind11::module_& module);
void add_view(pybind11::module_& module);
void add_environment(pybind11::module_& module);
void add_problem(pybind11::module_& module);

}  // namespace chicane::python
