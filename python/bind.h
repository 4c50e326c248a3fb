// The parts of the extension, a file each.
#pragma once

#include <pybind11/pybind11.h>

namespace mortier::python {

/// Scenes and what is wrong with them.
void bindScene(pybind11::module_& module);
/// States of runs as arrays.
void bindFields(pybind11::module_& module);
/// Laws that are callables.
void bindLaw(pybind11::module_& module);
/// Runs of scenes, and their steps one after another.
void bindRun(pybind11::module_& module);

}  // namespace mortier::python
