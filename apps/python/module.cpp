#include "apps/python/bindings.h"
#include "apps/run/run_record.h"

namespace py = pybind11;

PYBIND11_MODULE(_patchlight, module)
{
    using namespace patchlight;
    module.doc() = "Adaptive-meshing radiosity, one function a step.";
    // Classes are called by the name of the package, which is what is imported.
    const py::object own_name = module.attr("__name__");
    module.attr("__name__") = "patchlight";
    bind_errors(module);
    bind_options(module);
    bind_adaptive_options(module);
    bind_scene(module);
    bind_mesh(module);
    bind_light(module);
    bind_refinement(module);
    bind_adaptive(module);
    bind_stored(module);
    module.attr("__name__") = own_name;
    module.attr("__version__") = tool_version();
}
