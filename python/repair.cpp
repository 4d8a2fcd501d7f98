// SPDX-License-Identifier: Apache-2.0
// Repairs and replaces triangles.
// Tests: tests/python/test_command_line.py.
#include "relief/mesh/repair.h"

#include <utility>

#include "arrays.h"
#include "mesh_type.h"
#include "relief/mesh/remesh.h"

namespace relief::python {
namespace {

py::tuple py_repaired(const MeshObject& mesh, std::optional<double> weld, bool keep_non_finite,
                      bool keep_degenerate, bool keep_duplicates, const std::string& two_sided,
                      double drop_parts, bool orient, bool separate, const FindingList& report) {
    RepairOptions options;
    options.merge_vertices = weld.has_value();
    options.weld_tolerance = weld.value_or(0.0);
    options.remove_non_finite = !keep_non_finite;
    options.remove_collapsed = !keep_degenerate;
    options.remove_duplicates = !keep_duplicates;
    options.two_sided = value_of<TwoSided>(two_sided, "two_sided");
    options.drop_parts = drop_parts;
    options.orient = orient;
    options.separate = separate;
    Report findings;
    FramedMesh framed = without_gil([&] { return repaired(mesh, options, findings); });
    append(findings, report);
    const auto size = static_cast<py::ssize_t>(framed.source_vertex.size());
    return py::make_tuple(MeshObject(std::move(framed.mesh), mesh.origin),
                          array_of<std::uint32_t>(std::move(framed.source_vertex), {size}));
}

MeshObject py_remeshed(const MeshObject& mesh, int resolution, bool shell, const std::string& sign,
                       const FindingList& report) {
    RemeshOptions options;
    options.resolution = resolution;
    options.shell = shell;
    options.sign = value_of<RemeshSign>(sign, "sign");
    Report findings;
    Mesh result = without_gil([&] { return remeshed(mesh, options, findings); });
    append(findings, report);
    return MeshObject(std::move(result), mesh.origin);
}

}  // namespace

void add_repair(py::module_& module) {
    using py::arg;
    module.def(
        "repair", &py_repaired, arg("mesh"), py::kw_only(), arg("weld") = 0.0,
        arg("keep_non_finite") = false, arg("keep_degenerate") = false,
        arg("keep_duplicates") = false, arg("two_sided") = "keep", arg("drop_parts") = 0.0,
        arg("orient") = true, arg("separate") = true, arg("report") = py::none(),
        "Merge equal vertices, remove useless triangles, orient parts outwards, and separate\n"
        "non-manifold edges and vertices.\n\n"
        "`weld` is the largest distance of positions that become one, or None: no vertices are\n"
        "merged. `two_sided`, for triangles with the same corners and opposite winding, is\n"
        "\"keep\", \"together\", \"single\" or \"remove\". Parts whose box has a diagonal\n"
        "shorter than `drop_parts` are removed. The other options are those of\n"
        "`relief-mesh repair`. The result is (mesh, source_vertex), with source_vertex as for\n"
        "with_frames(). Each change is appended to the list `report`.\n\n"
        "Raises InvalidInput for options that are out of range.");
    module.def("remesh", &py_remeshed, arg("mesh"), py::kw_only(), arg("resolution") = 128,
               arg("shell") = false, arg("sign") = "flood", arg("report") = py::none(),
               "Compute a closed manifold surface around the solid that the triangles enclose.\n\n"
               "`resolution` is the number of cells along the longest side, 8 to 1024. With\n"
               "`shell`, everything within 0.75 cells of a triangle is solid, too. `sign` is\n"
               "\"flood\" (all that cannot be reached from outside is solid) or \"winding\" (all\n"
               "with a winding number of at least a half). The result has positions and triangles\n"
               "only.\n\n"
               "Raises InvalidInput for wrong options, or if the triangles enclose nothing.");
}

}  // namespace relief::python
