// SPDX-License-Identifier: Apache-2.0
// Displaces meshes by height maps. Tests: tests/python/test_command_line.py.
#include "relief/mesh/displace.h"

#include <utility>

#include "arrays.h"
#include "heights.h"
#include "mesh_type.h"
#include "relief/mesh/height_map.h"

namespace relief::python {
namespace {

/// Returns half a pixel of a mesh whose box has a diagonal of so many pixels.
double half_pixel(const Mesh& mesh, double pixels) {
    if (!(pixels >= 1.0)) throw InvalidInput("pixels must be at least 1");
    const Bounds bounds = bounds_of(mesh);
    if (bounds.empty()) return 1.0;
    return 0.5 * static_cast<double>(glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min))) /
           pixels;
}

py::tuple py_displaced(const MeshObject& mesh, const py::object& heights, double height,
                       double zero, std::optional<double> max_error, double pixels,
                       const std::string& wrap, std::size_t max_triangles,
                       const std::string& channel, const std::optional<std::string>& assume,
                       const FindingList& report) {
    Report findings;
    const Image map = heights_of(heights, "heights", channel, assume, findings);
    DisplaceOptions options;
    options.height = height;
    options.zero = zero;
    options.max_error = max_error ? *max_error : half_pixel(mesh, pixels);
    options.max_triangles = max_triangles;
    DisplacedMesh result = without_gil([&] {
        options.wrap = wrap == "auto" ? detect_tiling(map).wraps() : wraps_of(wrap);
        return displaced(mesh, map, options, findings);
    });
    append(findings, report);
    py::dict details;
    details["limit"] = options.max_error;
    details["max_error"] = result.max_error;
    details["rms_error"] = result.rms_error;
    details["above_limit"] = result.above_limit;
    details["is_complete"] = result.is_complete;
    details["wrap"] = name_of(options.wrap);
    return py::make_tuple(MeshObject(std::move(result.mesh), mesh.origin), details);
}

}  // namespace

void add_displace(py::module_& module) {
    using py::arg;
    module.def(
        "displace", &py_displaced, arg("mesh"), arg("heights"), py::kw_only(), arg("height"),
        arg("zero") = 0.0, arg("max_error") = py::none(), arg("pixels") = 2000.0,
        arg("wrap") = "auto", arg("max_triangles") = DisplaceOptions().max_triangles,
        arg("channel") = "mean", arg("assume") = py::none(), arg("report") = py::none(),
        "Move the surface of a mesh by a height map, with triangles that are near enough to it.\n\n"
        "`height` is the length by which 1.0 (white) moves the surface along its normal, and\n"
        "`zero` the value that does not move it. Triangles are divided while the surface of the\n"
        "heights is farther than `max_error` from them, by default half a pixel of a mesh that is\n"
        "`pixels` large. The options are those of `relief-mesh displace`. The result is\n"
        "(mesh, details); details has the limit, the errors that were reached, the number of\n"
        "triangles above the limit, whether the division was complete, and the wrap modes.\n\n"
        "Raises InvalidInput if the mesh has no texture coordinates, or for wrong options.");
}

}  // namespace relief::python
