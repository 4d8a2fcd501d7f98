// SPDX-License-Identifier: Apache-2.0
// The extension module relief._relief. relief/__init__.py is the public interface.
#include "arrays.h"
#include "relief/version.h"

PYBIND11_MODULE(_relief, module) {
    namespace py = relief::python::py;
    py::options options;
    options.disable_function_signatures();  // relief/_relief.pyi states them with the exact types.
    module.doc() = "The functions of the relief library on numpy arrays.";
    module.attr("__version__") = RELIEF_VERSION;
    module.attr("tool_directory") = RELIEF_TOOL_DIRECTORY;
    relief::python::add_errors(module);
    relief::python::add_execution(module);
    relief::python::add_meshes(module);
    relief::python::add_displace(module);
    relief::python::add_repair(module);
    relief::python::add_unwrap(module);
    relief::python::add_images(module);
    relief::python::add_bake(module);
    relief::python::add_scenes(module);
}
