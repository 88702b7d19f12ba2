#pragma once

#include <pybind11/pybind11.h>

namespace patchlight {

/// Each puts one part of the library into the module `patchlight`.
void bind_errors(pybind11::module_& module);
void bind_options(pybind11::module_& module);
void bind_adaptive_options(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_mesh(pybind11::module_& module);
void bind_light(pybind11::module_& module);
void bind_refinement(pybind11::module_& module);
void bind_adaptive(pybind11::module_& module);
void bind_stored(pybind11::module_& module);

}  // namespace patchlight
