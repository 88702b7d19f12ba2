#include "apps/python/bindings.h"
#include "apps/run/run_folder.h"
#include "formfactor/work_monitor.h"
#include "meshing/scene_error.h"

namespace py = pybind11;

namespace patchlight {

namespace {

/// Python's exception with the same text, and the short word as `code`.
void raise(PyObject* type, const char* text, const std::string& code)
{
    py::object error = py::reinterpret_borrow<py::object>(type)(text);
    error.attr("code") = code;
    PyErr_SetObject(type, error.ptr());
}

// Types that live as long as the interpreter; a translator may not capture.
PyObject* scene_error = nullptr;
PyObject* run_error = nullptr;

void translate(std::exception_ptr thrown)
{
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const SceneError& error) {
        raise(scene_error, error.what(), error.code());
    } catch (const FolderRefused& error) {
        raise(run_error, error.what(), "run");
    } catch (const OutputError& error) {
        PyErr_SetString(PyExc_OSError, error.what());
    } catch (const Interrupted& error) {
        PyErr_SetString(PyExc_KeyboardInterrupt, error.what());
    }
}

PyObject* new_error(py::module_& module, const char* name, const char* doc)
{
    const std::string full = std::string("patchlight.") + name;
    PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), doc, PyExc_ValueError, nullptr);
    if (type == nullptr) throw py::error_already_set();
    module.attr(name) = py::reinterpret_borrow<py::object>(type);
    return type;
}

}  // namespace

void bind_errors(py::module_& module)
{
    scene_error = new_error(module, "SceneError",
                            "A scene or a stored solution that can't be read. `code` is the command's short word, as "
                            "\"nonfinite\"; the text names the file and line.");
    run_error = new_error(module, "RunError", "A folder that isn't that of a run, or a cycle that it doesn't hold.");
    py::register_exception_translator(&translate);
}

}  // namespace patchlight
