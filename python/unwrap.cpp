// SPDX-License-Identifier: Apache-2.0
// Computes and measures the texture coordinates of meshes.
// Tests: tests/python/test_command_line.py.
#include "relief/mesh/unwrap.h"

#include <glm/ext/vector_float1.hpp>
#include <numbers>

#include "arrays.h"
#include "mesh_type.h"
#include "relief/mesh/texcoord_quality.h"

namespace relief::python {
namespace {

/// Returns the statistics with the keys of `relief-mesh unwrap --report`.
py::dict to_dict(const AtlasStats& stats) {
    py::dict result;
    result["charts"] = stats.charts;
    result["stacked_parts"] = stats.stacked_parts;
    result["small_charts"] = stats.small_charts;
    result["used"] = stats.used;
    result["texels_per_unit"] = stats.texels_per_unit;
    result["min_density"] = stats.min_density;
    result["max_density"] = stats.max_density;
    result["stretch"] = stats.stretch;
    result["mean_anisotropy"] = stats.mean_anisotropy;
    result["max_anisotropy"] = stats.max_anisotropy;
    result["seam_length"] = stats.seam_length;
    result["relative_seam_length"] = stats.relative_seam_length;
    result["area"] = stats.area;
    result["perimeter"] = stats.perimeter;
    result["padding_share"] = stats.padding_share;
    result["safe_mip_level"] = stats.safe_mip_level;
    return result;
}

/// Returns the chart of each triangle; -1 for those that are set aside.
py::array_t<std::int32_t> charts_of(const std::vector<std::optional<std::uint32_t>>& chart_of) {
    std::vector<std::int32_t> charts;
    charts.reserve(chart_of.size());
    for (const std::optional<std::uint32_t>& chart : chart_of)
        charts.push_back(chart ? static_cast<std::int32_t>(*chart) : -1);
    const auto size = static_cast<py::ssize_t>(charts.size());
    return array_of<std::int32_t>(std::move(charts), {size});
}

py::dict py_unwrap(const MeshObject& mesh, std::pair<int, int> size, int padding, int align,
                   std::optional<double> texels_per_unit, const std::string& flatten,
                   double max_stretch, std::optional<double> split_hard_degrees,
                   bool split_materials, bool keep_seams, const py::object& densities, bool stack,
                   bool repack, bool fix_mirrored, int udim, const FindingList& report) {
    Report findings;
    UnwrapOptions options;
    options.size = {size.first, size.second};
    options.padding = padding;
    options.alignment = align;
    options.texels_per_unit = texels_per_unit;
    options.flattening = value_of<Flattening>(flatten, "flatten");
    options.max_stretch = max_stretch;
    if (split_hard_degrees) options.split_hard = *split_hard_degrees * std::numbers::pi / 180.0;
    options.split_materials = split_materials;
    options.keep_seams = keep_seams;
    if (!densities.is_none()) {
        Inputs inputs(findings);
        const py::object column =
            py::module_::import("numpy").attr("reshape")(densities, py::make_tuple(-1, 1));
        for (const glm::vec1& density : inputs.copied_rows<glm::vec1>(column, "densities"))
            options.densities.push_back(density.x);
    }
    options.stack = stack;
    options.repack = repack;
    options.unmirror = fix_mirrored;
    options.tiles = udim;
    Unwrapped unwrapped;
    FramedMesh result;
    without_gil([&] {
        unwrapped = unwrap(mesh, options, findings);
        result = with_texcoords(mesh, unwrapped);
    });
    append(findings, report);
    const auto vertices = static_cast<py::ssize_t>(result.source_vertex.size());
    py::dict parts;
    parts["mesh"] = MeshObject(std::move(result.mesh), mesh.origin);
    parts["source_vertex"] = array_of<std::uint32_t>(std::move(result.source_vertex), {vertices});
    parts["charts"] = charts_of(unwrapped.chart);
    parts["stats"] = to_dict(unwrapped.stats);
    return parts;
}

py::dict py_measure_texcoords(const MeshObject& mesh, std::pair<int, int> size,
                              const FindingList& report) {
    Report findings;
    const TexcoordQuality quality = without_gil([&] {
        return measure_texcoords(mesh, {size.first, size.second}, findings);
    });
    append(findings, report);
    py::dict result;
    result["atlas"] = to_dict(quality.stats);
    result["tiles"] = quality.tiles;
    result["shared_charts"] = quality.shared_charts;
    result["overlapping"] = quality.overlapping;
    result["inverted"] = quality.inverted;
    result["flat"] = quality.flat;
    result["outside"] = quality.outside;
    result["mirrored_charts"] = quality.mirrored_charts;
    result["min_distance"] = quality.min_distance;
    result["charts"] = charts_of(quality.chart);
    return result;
}

}  // namespace

void add_unwrap(py::module_& module) {
    using py::arg;
    const py::object none = py::none();
    module.def("unwrap", &py_unwrap, arg("mesh"), py::kw_only(),
               arg("size") = std::pair(2048, 2048), arg("padding") = 4, arg("align") = 1,
               arg("texels_per_unit") = none, arg("flatten") = "arap", arg("max_stretch") = 4.0,
               arg("split_hard_degrees") = none, arg("split_materials") = false,
               arg("keep_seams") = false, arg("densities") = none, arg("stack") = false,
               arg("repack") = false, arg("fix_mirrored") = false, arg("udim") = 1,
               arg("report") = none,
               "Compute texture coordinates without overlaps.\n\n"
               "See relief.unwrap() for the result.");
    module.def(
        "measure_texcoords", &py_measure_texcoords, arg("mesh"), arg("size"), py::kw_only(),
        arg("report") = none,
        "Measure the texture coordinates of a mesh on a map of `size` (width, height).\n\n"
        "The result has the keys of `texcoords` in `relief-mesh check --map-size --json`, and\n"
        "`charts`, int32 (m,): the chart of each triangle, or -1 if it has no area or is not\n"
        "finite. `min_distance` is that of two charts in texels, or None above 64. Charts with\n"
        "exactly the same triangles in the map share texels (`shared_charts`) and do not overlap.\n"
        "`tiles` has the numbers of the UDIM tiles with triangles.\n\n"
        "Raises InvalidInput if the mesh has no texture coordinates, and for wrong sizes.");
}

}  // namespace relief::python
