// SPDX-License-Identifier: Apache-2.0
// Normals, tangents, vertex splits and curvature of arrays; the class Mesh, mesh files, and checks
// and comparisons of meshes.
// Tests: tests/python/test_command_line.py.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <variant>

#include "arrays.h"
#include "mesh_type.h"
#include "relief/mesh/curvature.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/model.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/tangents.h"
#include "relief/mesh/topology.h"

namespace relief::python {
namespace {

using Text = std::optional<std::string>;
using Positions = StridedSpan<const glm::vec3>;

/// Returns the weight of a name; absent for "auto".
std::optional<NormalWeight> weight_of(const std::string& name) {
    return value_of<NormalMode>(name, "weight", std::span(enum_names<NormalMode>).subspan<2>())
        .weight();
}

std::optional<double> radians(const std::optional<double>& degrees) {
    if (!degrees) return std::nullopt;
    return *degrees * std::numbers::pi / 180.0;
}

NormalOptions normal_options(const std::string& arithmetic, std::optional<double> weld_tolerance) {
    NormalOptions options;
    options.arithmetic = value_of<Arithmetic>(arithmetic, "arithmetic");
    options.weld_tolerance = weld_tolerance;
    return options;
}

/// Returns `out`, or a new array, for one row per position.
template <typename Vector>
py::array output_for(const py::object& out, const Positions& positions) {
    if (out.is_none()) {
        const auto size = static_cast<py::ssize_t>(positions.size());
        return py::array_t<float>({size, static_cast<py::ssize_t>(Vector::length())});
    }
    const StridedSpan<Vector> rows = output_rows<Vector>(out, "out");
    if (rows.size() != 0 && static_cast<const void*>(rows.data()) == positions.data())
        throw InvalidInput("out: the array is also the input 'positions'");
    return py::reinterpret_borrow<py::array>(out);
}

py::array py_vertex_normals(const py::object& positions, const py::object& triangles,
                            const std::string& weight, const std::string& arithmetic,
                            std::optional<double> weld_tolerance, const py::object& out,
                            const FindingList& report) {
    Report findings;
    Inputs inputs(findings);
    const Positions points = inputs.positions(positions);
    const TriangleSpan faces = inputs.triangles(triangles);
    const std::optional<NormalWeight> chosen = weight_of(weight);
    NormalOptions options = normal_options(arithmetic, weld_tolerance);
    options.weight = chosen.value_or(options.weight);
    py::array result = output_for<glm::vec3>(out, points);
    const StridedSpan<glm::vec3> normals = output_rows<glm::vec3>(result, "out");
    if (normals.size() != points.size()) {
        throw InvalidInput("out: " + std::to_string(normals.size()) + " rows for " +
                           std::to_string(points.size()) + " positions");
    }
    without_gil([&] {
        if (chosen) return vertex_normals(points, faces, options, normals, findings);
        const ChosenNormals automatic = chosen_normals(points, faces, options, findings);
        for (std::size_t i = 0; i < normals.size(); ++i)
            normals[i] = automatic.normals[i];
    });
    append(findings, report);
    return result;
}

py::array py_corner_normals(const py::object& positions, const py::object& triangles,
                            const std::string& weight, std::optional<double> crease_degrees,
                            const py::object& smoothing_groups, const std::string& arithmetic,
                            std::optional<double> weld_tolerance, const FindingList& report) {
    Report findings;
    Inputs inputs(findings);
    const Positions points = inputs.positions(positions);
    const TriangleSpan faces = inputs.triangles(triangles);
    const HardEdges hard = {radians(crease_degrees),
                            inputs.indices(smoothing_groups, "smoothing_groups")};
    const NormalOptions options = normal_options(arithmetic, weld_tolerance);
    const std::optional<NormalWeight> chosen = weight_of(weight);
    CornerNormals corners =
        without_gil([&] { return corner_normals(points, faces, chosen, options, hard, findings); });
    append(findings, report);
    const auto count = static_cast<py::ssize_t>(faces.size());
    return array_of<float>(std::move(corners.normals), {count, 3, 3});
}

py::array py_triangle_normals(const py::object& positions, const py::object& triangles,
                              const FindingList& report) {
    Report findings;
    Inputs inputs(findings);
    const Positions points = inputs.positions(positions);
    const TriangleSpan faces = inputs.triangles(triangles);
    std::vector<glm::vec3> normals =
        without_gil([&] { return triangle_normals(points, faces, findings); });
    append(findings, report);
    return array_of(std::move(normals));
}

py::array py_corner_tangents(const py::object& positions, const py::object& normals,
                             const py::object& texcoords, const py::object& triangles,
                             const std::string& method, const FindingList& report) {
    Report findings;
    Inputs inputs(findings);
    const Positions points = inputs.positions(positions);
    const Positions directions = inputs.rows<glm::vec3>(normals, "normals");
    const StridedSpan<const glm::vec2> coordinates = inputs.rows<glm::vec2>(texcoords, "texcoords");
    const TriangleSpan faces = inputs.triangles(triangles);
    const auto function_of = [&] {
        switch (value_of<TangentMethod>(method, "method")) {
            case TangentMethod::mikktspace:
                return &mikktspace_tangents;
            case TangentMethod::area_weighted:
                return &area_weighted_tangents;
            case TangentMethod::lengyel:
                return &lengyel_tangents;
            default:
                refuse_name("method", method, {"mikktspace", "area-weighted", "lengyel"});
        }
    };
    const auto function = function_of();
    std::vector<glm::vec4> tangents =
        without_gil([&] { return function(points, directions, coordinates, faces, findings); });
    append(findings, report);
    const auto count = static_cast<py::ssize_t>(faces.size());
    return array_of<float>(std::move(tangents), {count, 3, 4});
}

py::array py_vertex_tangents(const py::object& positions, const py::object& normals,
                             const py::object& texcoords, const py::object& triangles,
                             const py::object& out, const FindingList& report) {
    Report findings;
    Inputs inputs(findings);
    const Positions points = inputs.positions(positions);
    const Positions directions = inputs.rows<glm::vec3>(normals, "normals");
    const StridedSpan<const glm::vec2> coordinates = inputs.rows<glm::vec2>(texcoords, "texcoords");
    const TriangleSpan faces = inputs.triangles(triangles);
    py::array result = output_for<glm::vec4>(out, points);
    const StridedSpan<glm::vec4> tangents = output_rows<glm::vec4>(result, "out");
    without_gil(
        [&] { vertex_tangents(points, directions, coordinates, faces, tangents, findings); });
    append(findings, report);
    return result;
}

py::tuple py_split_vertices(std::size_t vertex_count, const py::object& triangles,
                            const py::object& corner_values, const FindingList& report) {
    Report findings;
    Inputs inputs(findings);
    const std::vector<glm::uvec3> faces = inputs.copied_triangles(triangles);
    py::object values = corner_values;
    if (py::isinstance<py::array>(values) && values.attr("ndim").cast<int>() == 3) {
        const py::object last = values.attr("shape").attr("__getitem__")(2);
        values = values.attr("reshape")(-1, last);  // From (m, 3, c) to (3 m, c).
    }
    const bool has_four = py::isinstance<py::array>(values) &&
                          values.attr("ndim").cast<int>() == 2 &&
                          values.attr("shape").attr("__getitem__")(1).cast<int>() == 4;
    const auto split_by = [&]<typename Vector>(const std::vector<Vector>& corners) {
        return without_gil([&] {
            return split_where_corners_differ(vertex_count, faces,
                                              std::span<const Vector>(corners));
        });
    };
    VertexSplit split = has_four ? split_by(inputs.copied_rows<glm::vec4>(values, "corner_values"))
                                 : split_by(inputs.copied_rows<glm::vec3>(values, "corner_values"));
    append(findings, report);
    const auto size = static_cast<py::ssize_t>(split.source_vertex.size());
    return py::make_tuple(array_of<std::uint32_t>(std::move(split.source_vertex), {size}),
                          array_of(std::move(split.triangles)));
}

py::array py_mean_curvatures(const py::object& positions, const py::object& triangles,
                             const FindingList& report) {
    Report findings;
    Inputs inputs(findings);
    const std::vector<glm::vec3> points = Inputs::copied(inputs.positions(positions));
    const std::vector<glm::uvec3> faces = inputs.copied_triangles(triangles);
    std::vector<float> curvatures =
        without_gil([&] { return mean_curvatures(points, faces, findings); });
    append(findings, report);
    const auto size = static_cast<py::ssize_t>(curvatures.size());
    return array_of<float>(std::move(curvatures), {size});
}

// The class Mesh.

MeshObject new_mesh(const py::object& positions, const py::object& triangles,
                    const py::object& normals, const py::object& texcoords,
                    const py::object& tangents, const py::object& colors,
                    const py::object& smoothing_groups, const std::string& name,
                    const FindingList& report) {
    Report findings;
    Inputs inputs(findings);
    MeshObject mesh;
    mesh.name = name;
    mesh.positions = Inputs::copied(inputs.positions(positions, mesh.origin));
    mesh.triangles = inputs.copied_triangles(triangles);
    mesh.normals = inputs.copied_rows<glm::vec3>(normals, "normals");
    mesh.texcoords = inputs.copied_rows<glm::vec2>(texcoords, "texcoords");
    mesh.tangents = inputs.copied_rows<glm::vec4>(tangents, "tangents");
    mesh.colors = inputs.copied_rows<glm::vec4>(colors, "colors");
    const auto groups = inputs.indices(smoothing_groups, "smoothing_groups");
    mesh.smoothing_groups.assign(groups.begin(), groups.end());
    validate(mesh);
    append(findings, report);
    return mesh;
}

/// Returns an array that views a vector of the mesh, or None for an absent attribute.
template <typename Vector>
py::object view_of(const py::object& mesh, std::vector<Vector> Mesh::*member) {
    std::vector<Vector>& values = mesh.cast<MeshObject&>().*member;
    using Scalar = typename Vector::value_type;
    if (values.empty()) return py::none();
    const auto size = static_cast<py::ssize_t>(values.size());
    return py::array_t<Scalar>({size, static_cast<py::ssize_t>(Vector::length())},
                               reinterpret_cast<Scalar*>(values.data()), mesh);
}

std::tuple<double, double, double> tuple_of(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

// Pickling: a dictionary with every member that a mesh has.

template <typename Vector>
std::vector<Vector> rows_in(const py::dict& state, const char* name) {
    Report unused;
    Inputs inputs(unused);
    return inputs.copied_rows<Vector>(state[name], name);
}

py::dict state_of(const py::object& object) {
    const auto& mesh = object.cast<const MeshObject&>();
    py::list ranges;
    for (const MaterialRange& range : mesh.material_ranges)
        ranges.append(py::make_tuple(range.first_triangle, range.triangle_count, range.material));
    py::dict state;
    state["name"] = mesh.name;
    state["origin"] = tuple_of(mesh.origin);
    state["positions"] = view_of(object, &Mesh::positions);
    state["triangles"] = view_of(object, &Mesh::triangles);
    state["normals"] = view_of(object, &Mesh::normals);
    state["texcoords"] = view_of(object, &Mesh::texcoords);
    state["texcoords_2"] = view_of(object, &Mesh::texcoords_2);
    state["tangents"] = view_of(object, &Mesh::tangents);
    state["colors"] = view_of(object, &Mesh::colors);
    state["material_ranges"] = std::move(ranges);
    state["smoothing_groups"] = py::array_t<std::uint32_t>(
        static_cast<py::ssize_t>(mesh.smoothing_groups.size()), mesh.smoothing_groups.data());
    return state;
}

MeshObject mesh_of(const py::dict& state) {
    MeshObject mesh;
    mesh.name = state["name"].cast<std::string>();
    const auto [x, y, z] = state["origin"].cast<std::tuple<double, double, double>>();
    mesh.origin = {x, y, z};
    mesh.positions = rows_in<glm::vec3>(state, "positions");
    Report unused;
    Inputs inputs(unused);
    if (!state["triangles"].is_none()) mesh.triangles = inputs.copied_triangles(state["triangles"]);
    mesh.normals = rows_in<glm::vec3>(state, "normals");
    mesh.texcoords = rows_in<glm::vec2>(state, "texcoords");
    mesh.texcoords_2 = rows_in<glm::vec2>(state, "texcoords_2");
    mesh.tangents = rows_in<glm::vec4>(state, "tangents");
    mesh.colors = rows_in<glm::vec4>(state, "colors");
    using Range = std::tuple<std::uint32_t, std::uint32_t, std::optional<std::uint32_t>>;
    for (const auto& [first, count, material] : state["material_ranges"].cast<std::vector<Range>>())
        mesh.material_ranges.push_back({first, count, material});
    const auto groups = inputs.indices(state["smoothing_groups"], "smoothing_groups");
    mesh.smoothing_groups.assign(groups.begin(), groups.end());
    validate(mesh);
    return mesh;
}

MeshObject py_read_mesh(const FileName& file, const std::string& space, const FindingList& report) {
    constexpr auto spaces = std::to_array<EnumName<ModelSpace>>(
        {{"object", ModelSpace::object}, {"world", ModelSpace::world}});
    const ModelSpace chosen = value_of<ModelSpace>(space, "space", spaces);
    Report findings;
    MeshObject mesh = without_gil([&] {
        const std::string extension = file.extension().string();
        if (extension != ".gltf" && extension != ".glb") {
            MeshFile file_mesh = read_mesh(file, findings);
            return MeshObject(std::move(file_mesh.mesh), file_mesh.origin);
        }
        MapModel model = map_model(GltfDocument::read(file, findings), chosen, findings);
        const glm::dvec3 origin = model.origin;
        return MeshObject(joined(std::move(model.parts)), origin);
    });
    append(findings, report);
    return mesh;
}

void py_write_mesh(const FileName& file, const MeshObject& mesh, const FindingList& report) {
    Report findings;
    without_gil([&] {
        MeshFile file_mesh{.mesh = mesh, .materials = {}, .origin = mesh.origin};
        file_mesh.mesh.material_ranges.clear();
        write_mesh(file, file_mesh, findings);
    });
    append(findings, report);
}

FrameOptions frame_options(const std::string& normals, const std::string& tangents,
                           std::optional<double> crease_degrees, double weld_tolerance,
                           bool smoothing_groups, bool repair) {
    return {.normals = value_of<NormalMode>(normals, "normals"),
            .tangents = value_of<TangentMethod>(tangents, "tangents"),
            .weld_tolerance = weld_tolerance,
            .crease_angle = radians(crease_degrees),
            .smoothing_groups = smoothing_groups,
            .repair = repair};
}

py::tuple pair_of(FramedMesh&& framed, const MeshObject& source) {
    const auto size = static_cast<py::ssize_t>(framed.source_vertex.size());
    return py::make_tuple(MeshObject(std::move(framed.mesh), source.origin),
                          array_of<std::uint32_t>(std::move(framed.source_vertex), {size}));
}

py::tuple py_with_frames(const MeshObject& mesh, const std::string& normals,
                         const std::string& tangents, std::optional<double> crease_degrees,
                         double weld_tolerance, bool smoothing_groups, bool repair,
                         const FindingList& report) {
    const FrameOptions options =
        frame_options(normals, tangents, crease_degrees, weld_tolerance, smoothing_groups, repair);
    Report findings;
    FramedMesh framed = without_gil([&] { return with_frames(mesh, options, findings); });
    append(findings, report);
    return pair_of(std::move(framed), mesh);
}

AttributeWeights weights_of(const std::map<std::string, double>& weights) {
    AttributeWeights result;
    for (const auto& [name, weight] : weights) {
        if (name == "texcoords")
            result.texcoord = weight;
        else if (name == "normals")
            result.normal = weight;
        else if (name == "colors")
            result.color = weight;
        else
            refuse_name("weights", name, {"texcoords", "normals", "colors"});
    }
    return result;
}

py::tuple py_decimated(const MeshObject& mesh, std::optional<std::size_t> triangles,
                       std::optional<double> max_error,
                       const std::optional<double>& max_normal_degrees, bool keep_borders,
                       bool keep_seams, bool keep_positions, double drop_parts,
                       const std::optional<std::string>& goal,
                       const std::map<std::string, double>& weights, const std::string& normals,
                       const FindingList& report) {
    DecimateOptions options;
    options.triangles = triangles;
    options.max_error = max_error;
    options.max_normal_error = radians(max_normal_degrees);
    options.keep_borders = keep_borders;
    options.keep_seams = keep_seams;
    options.fit_positions = !keep_positions;
    options.drop_parts = drop_parts;
    options.weights = weights_of(weights);
    options.goal = goal        ? value_of<DecimateGoal>(*goal, "goal")
                   : max_error ? DecimateGoal::distance
                               : DecimateGoal::picture;
    if (options.goal != DecimateGoal::picture && !weights.contains("normals"))
        options.weights.normal = 0.0;
    options.frames.normals = value_of<NormalMode>(normals, "normals");
    Report findings;
    FramedMesh framed = without_gil([&] { return decimated(mesh, options, findings); });
    append(findings, report);
    return pair_of(std::move(framed), mesh);
}

/// Returns the statistics with the keys of `relief-mesh decimate --report`.
py::dict to_dict(const DistanceStats& stats) {
    py::dict result;
    result["mean"] = stats.mean;
    result["rms"] = stats.rms;
    result["p95"] = stats.p95;
    result["max"] = stats.max;
    result["mean_degrees"] = stats.mean_degrees;
    result["max_degrees"] = stats.max_degrees;
    result["samples"] = stats.samples;
    result["omitted"] = stats.omitted;
    return result;
}

py::tuple py_surface_distance(const MeshObject& a, const MeshObject& b) {
    const SurfaceDistance distance = without_gil([&] { return surface_distance(a, b); });
    return py::make_tuple(to_dict(distance.from_a), to_dict(distance.from_b));
}

py::list py_levels_of_detail(const MeshObject& mesh, const std::vector<std::size_t>& triangles,
                             const std::map<std::string, double>& weights,
                             const FindingList& report) {
    DecimateOptions options;
    options.fit_positions = true;
    options.weights = weights_of(weights);
    Report findings;
    std::vector<MeshObject> levels;
    without_gil([&] {
        const MeshObject* before = &mesh;
        levels.reserve(triangles.size());
        for (const std::size_t count : triangles) {
            options.triangles = count;
            levels.emplace_back(decimated(*before, options, findings).mesh, mesh.origin);
            before = &levels.back();
        }
    });
    append(findings, report);
    py::list result;
    for (MeshObject& level : levels)
        result.append(std::move(level));
    return result;
}

MeshObject py_subdivided(const MeshObject& mesh, int levels, const std::string& normals,
                         const FindingList& report) {
    FrameOptions options;
    options.normals = value_of<NormalMode>(normals, "normals");
    Report findings;
    MeshObject result = without_gil(
        [&] { return MeshObject(subdivided(mesh, levels, options, findings), mesh.origin); });
    append(findings, report);
    return result;
}

// Checks and comparisons, with the keys of `relief-mesh check --json` and `compare --json`.

/// Returns whether almost all (99%) of the agreeing corners have the opposite sign w.
bool is_negated(const TangentAgreement& agreement) {
    return static_cast<double>(agreement.negated) >=
           0.99 * static_cast<double>(agreement.agreeing());
}

std::string variant_of(const TangentAgreement& agreement) {
    return std::string(variant_text(agreement.quarter_turns, is_negated(agreement)));
}

py::dict to_dict(const IdentifiedTangents& identified) {
    py::list agreements;
    for (const TangentAgreement& agreement : identified.agreements) {
        py::dict entry;
        entry["basis"] = enum_name(agreement.method);
        entry["agreeing"] = agreement.agreeing();
        entry["variant"] = variant_of(agreement);
        entry["w_negated"] = agreement.negated;
        const py::dict angles = python::to_dict(agreement.angles, "corners");
        entry["rms"] = angles["rms"];
        entry["mean"] = angles["mean"];
        entry["median"] = agreement.angles.median;
        entry["p90"] = agreement.angles.p90;
        entry["p99"] = angles["p99"];
        entry["max"] = angles["max"];
        entry["histogram"] = angles["histogram"];
        agreements.append(std::move(entry));
    }
    py::list equivalent;
    for (const TangentMethod method : identified.equivalent_methods)
        equivalent.append(enum_name(method));
    const TangentAgreement* best = identified.best();
    py::dict result;
    result["basis"] = identified.method ? enum_name(*identified.method) : "unknown";
    result["variant"] = best == nullptr ? "" : variant_of(*best);
    result["nearest"] = best == nullptr ? "" : enum_name(best->method);
    result["nearest_by_far"] = identified.is_clearly_best();
    result["same_here"] = std::move(equivalent);
    result["corners"] = identified.corners;
    result["left_out"] = identified.left_out;
    result["without_direction"] = identified.undefined;
    result["stored_bits"] = identified.stored_bits == 0 ? 32 : identified.stored_bits;
    result["tolerance"] = identified.tolerance;
    result["agreements"] = std::move(agreements);
    return result;
}

py::dict py_check_mesh(const MeshObject& mesh, bool for_baking, bool for_tangents) {
    Report problems;
    Report notes;
    std::optional<IdentifiedTangents> tangents;
    const Diagnosis diagnosis = without_gil([&] {
        Diagnosis result = diagnose(mesh);
        for (const MeshConditionCount& found : result.conditions) {
            bool is_problem = condition_info(found.condition).severity == Severity::problem;
            if (found.condition == MeshCondition::texture_overlapping && for_baking)
                is_problem = true;
            if (found.condition == MeshCondition::texture_degenerate && !for_tangents &&
                !for_baking && mesh.tangents.empty())
                is_problem = false;
            (is_problem ? problems : notes).add(to_finding(found));
        }
        if (!mesh.tangents.empty()) tangents = identify_tangents(mesh);
        return result;
    });
    py::dict result;
    result["name"] = mesh.name;
    result["sound"] = problems.empty();
    result["triangles"] = mesh.triangles.size();
    result["vertices"] = mesh.positions.size();
    result["size"] = diagnosis.size;
    result["spacing"] = diagnosis.spacing;
    result["overlap_raster"] = diagnosis.overlap_raster;
    result["tangents"] = tangents ? py::object(to_dict(*tangents)) : py::none();
    result["problems"] = to_list(problems);
    result["notes"] = to_list(notes);
    return result;
}

py::list worst_of(const Mesh& mesh, const std::vector<WorstCorner>& corners) {
    py::list list;
    for (const WorstCorner& worst : corners) {
        const std::uint32_t triangle = worst.corner_a / 3;
        const std::uint32_t corner = worst.corner_a % 3;
        const glm::vec3 at = mesh.positions[mesh.triangles[triangle][static_cast<int>(corner)]];
        py::dict entry;
        entry["degrees"] =
            std::isnan(worst.degrees) ? py::object(py::none()) : py::float_(worst.degrees);
        entry["position"] = std::vector<float>{at.x, at.y, at.z};
        entry["triangle"] = triangle;
        entry["corner"] = corner;
        entry["triangle_of_b"] = worst.corner_b / 3;
        entry["corner_of_b"] = worst.corner_b % 3;
        list.append(std::move(entry));
    }
    return list;
}

py::dict py_compare_meshes(const MeshObject& a, const MeshObject& b,
                           std::optional<double> position_tolerance,
                           std::optional<double> texcoord_tolerance, bool by_texcoord) {
    const ModelComparison compared = without_gil([&] {
        const auto model = [](const MeshObject& mesh) {
            return joined_model(MeshFile{.mesh = mesh, .materials = {}, .origin = mesh.origin},
                                true);
        };
        return compare_models(model(a), model(b),
                              {position_tolerance, texcoord_tolerance, by_texcoord});
    });
    const CornerMatch& match = compared.match;
    py::dict triangles;
    triangles["equal"] = match.exact;
    triangles["near"] = match.near;
    triangles["ambiguous"] = match.ambiguous;
    triangles["only_in_a"] = match.only_a.size();
    triangles["only_in_b"] = match.only_b.size();
    py::dict result;
    result["by_texture_coordinate"] = match.by_texcoord;
    result["tolerance"] = compared.options.position_tolerance;
    result["uv_tolerance"] = compared.options.texcoord_tolerance;
    result["triangles"] = std::move(triangles);
    result["corners"] = compared.all.corners;
    result["normals"] = python::to_dict(compared.all.normals, "corners");
    result["tangents"] = python::to_dict(compared.all.tangents, "corners");
    result["sign_differences"] = compared.all.sign_differences;
    result["worst_normals"] = worst_of(compared.a.mesh, compared.all.worst_normals);
    result["worst_tangents"] = worst_of(compared.a.mesh, compared.all.worst_tangents);
    return result;
}

void add_array_functions(py::module_& module) {
    using py::arg;
    module.def(
        "vertex_normals", &py_vertex_normals, arg("positions"), arg("triangles"), py::kw_only(),
        arg("weight") = "angle", arg("arithmetic") = "float64", arg("weld_tolerance") = 0.0,
        arg("out") = py::none(), arg("report") = py::none(),
        "Compute the unit normal of every vertex, the weighted mean over its triangles.\n\n"
        "positions: float32 (n, 3); triangles: uint16 or uint32 (m, 3), counter-clockwise.\n"
        "Other types and layouts are converted. The result, float32 (n, 3), is `out` or a new\n"
        "array. A vertex without a direction gets (0, 0, 1), and a finding is appended to the\n"
        "list `report`. Vertices within `weld_tolerance` share their normal; None: none do.\n\n"
        "Raises InvalidInput for wrong shapes, indices and options, and TypeError for wrong\n"
        "types; `out` must be float32.");
    module.def("corner_normals", &py_corner_normals, arg("positions"), arg("triangles"),
               py::kw_only(), arg("weight") = "angle", arg("crease_degrees") = py::none(),
               arg("smoothing_groups") = py::none(), arg("arithmetic") = "float64",
               arg("weld_tolerance") = 0.0, arg("report") = py::none(),
               "Compute the unit normal of every corner, averaged up to hard edges.\n\n"
               "Edges are hard if their triangles' normals differ by more than `crease_degrees`,\n"
               "or between different `smoothing_groups`: uint32 (m,). positions: float32\n"
               "(n, 3); triangles: uint16 or uint32 (m, 3). The result is float32 (m, 3, 3):\n"
               "triangle, corner, component.\n\n"
               "Raises InvalidInput for wrong shapes, indices and options, and TypeError for\n"
               "wrong types.");
    module.def("triangle_normals", &py_triangle_normals, arg("positions"), arg("triangles"),
               py::kw_only(), arg("report") = py::none(),
               "Compute the unit normal of every triangle by the right-hand rule.\n\n"
               "positions: float32 (n, 3); triangles: uint16 or uint32 (m, 3); the result:\n"
               "float32 (m, 3), with (0, 0, 1) and a finding for degenerate triangles.\n\n"
               "Raises InvalidInput for wrong shapes and indices, and TypeError for wrong types.");
    module.def("corner_tangents", &py_corner_tangents, arg("positions"), arg("normals"),
               arg("texcoords"), arg("triangles"), py::kw_only(), arg("method") = "mikktspace",
               arg("report") = py::none(),
               "Compute a tangent for every corner from texture coordinates (v points down).\n\n"
               "positions and normals: float32 (n, 3); texcoords: float32 (n, 2); triangles:\n"
               "uint16 or uint32 (m, 3). The result is float32 (m, 3, 4): triangle, corner,\n"
               "x y z w. The bitangent is w * cross(normal, tangent). Convert corners to vertices\n"
               "with split_vertices().\n\n"
               "Raises InvalidInput for wrong shapes, indices and options, and TypeError for\n"
               "wrong types.");
    module.def(
        "vertex_tangents", &py_vertex_tangents, arg("positions"), arg("normals"), arg("texcoords"),
        arg("triangles"), py::kw_only(), arg("out") = py::none(), arg("report") = py::none(),
        "Compute the MikkTSpace tangent of every vertex of a mesh that is already split.\n\n"
        "positions and normals: float32 (n, 3); texcoords: float32 (n, 2); triangles: uint16 or\n"
        "uint32 (m, 3). The result, float32 (n, 4), is `out` or a new array. If the corners at\n"
        "a vertex differ, it gets the most frequent tangent, and a finding is appended to the\n"
        "list `report`.\n\n"
        "Raises InvalidInput for wrong shapes and indices, and TypeError for wrong types; `out`\n"
        "must be float32.");
    module.def(
        "split_vertices", &py_split_vertices, arg("vertex_count"), arg("triangles"),
        arg("corner_values"), py::kw_only(), arg("report") = py::none(),
        "Split vertices until all corners of a vertex share a value, with fewest copies.\n\n"
        "triangles: uint16 or uint32 (m, 3); corner_values: float32 (m, 3, c) or (3 m, c) with\n"
        "c = 3 or 4. The result is (source_vertex, triangles), uint32 (k,) and (m, 3): index any\n"
        "vertex data with source_vertex.\n\n"
        "Raises InvalidInput for wrong shapes and indices, and TypeError for wrong types.");
    module.def("mean_curvatures", &py_mean_curvatures, arg("positions"), arg("triangles"),
               py::kw_only(), arg("report") = py::none(),
               "Compute the mean curvature at every vertex, positive for convex surfaces.\n\n"
               "positions: float32 (n, 3); triangles: uint16 or uint32 (m, 3); the result:\n"
               "float32 (n,).\n\n"
               "Raises InvalidInput for wrong shapes and indices, and TypeError for wrong types.");
}

void add_mesh_class(py::module_& module) {
    using py::arg;
    const py::object none = py::none();
    py::class_<MeshObject>(module, "Mesh",
                           "Triangles and vertex attributes, which the mesh owns.\n\n"
                           "The attributes are arrays that view the mesh's memory: they may be\n"
                           "written, but not resized. An absent attribute is None. Meshes can be\n"
                           "copied (copy.copy() copies the arrays) and pickled.")
        .def(py::init(&new_mesh), arg("positions"), arg("triangles"), py::kw_only(),
             arg("normals") = none, arg("texcoords") = none, arg("tangents") = none,
             arg("colors") = none, arg("smoothing_groups") = none, arg("name") = "",
             arg("report") = none,
             "Copy arrays to a new mesh. Texture coordinates have v downwards.\n\n"
             "positions and normals: float32 (n, 3); texcoords: float32 (n, 2); tangents and\n"
             "colors: float32 (n, 4); triangles: uint16 or uint32 (m, 3); smoothing_groups:\n"
             "uint32 (m,). Other numbers are converted. Positions that are farther from 0 than 16\n"
             "times their extent, and that float32 cannot hold, are stored relative to the\n"
             "attribute `origin`.\n\n"
             "Raises InvalidInput for wrong shapes and indices, and TypeError for wrong types.")
        .def_readwrite("name", &MeshObject::name, "The name of the mesh.")
        .def_property_readonly(
            "origin", [](const MeshObject& mesh) { return tuple_of(mesh.origin); },
            "The origin of the positions; zero except for meshes far from 0.")
        .def_property_readonly(
            "positions", [](const py::object& mesh) { return view_of(mesh, &Mesh::positions); },
            "Positions: float32 of shape (n, 3).")
        .def_property_readonly(
            "triangles", [](const py::object& mesh) { return view_of(mesh, &Mesh::triangles); },
            "Vertex indices: uint32 of shape (m, 3).")
        .def_property_readonly(
            "normals", [](const py::object& mesh) { return view_of(mesh, &Mesh::normals); },
            "Unit normals: float32 of shape (n, 3), or None.")
        .def_property_readonly(
            "texcoords", [](const py::object& mesh) { return view_of(mesh, &Mesh::texcoords); },
            "Texture coordinates, v down: float32 of shape (n, 2), or None.")
        .def_property_readonly(
            "tangents", [](const py::object& mesh) { return view_of(mesh, &Mesh::tangents); },
            "Tangents with the handedness w: float32 of shape (n, 4), or None.")
        .def_property_readonly(
            "colors", [](const py::object& mesh) { return view_of(mesh, &Mesh::colors); },
            "Linear RGB and coverage: float32 of shape (n, 4), or None.")
        .def("__copy__", [](const MeshObject& mesh) { return MeshObject(mesh); })
        .def("__deepcopy__",
             [](const MeshObject& mesh, const py::dict&) { return MeshObject(mesh); })
        .def(py::pickle(&state_of, &mesh_of))
        .def("__repr__", [](const MeshObject& mesh) {
            return "<relief.Mesh of " + std::to_string(mesh.positions.size()) + " vertices and " +
                   std::to_string(mesh.triangles.size()) + " triangles>";
        });
}

void add_mesh_functions(py::module_& module) {
    using py::arg;
    module.def("read_mesh", &py_read_mesh, arg("file"), py::kw_only(), arg("space") = "world",
               arg("report") = py::none(),
               "Read an OBJ, PLY, STL or OFF file, or a glTF file as one mesh.\n\n"
               "`space` is for glTF: all instances of the scene in world space, or each primitive\n"
               "once in object space, with the exact numbers of the file.\n\n"
               "Raises FileError if the file cannot be read, or is damaged.");
    module.def("write_mesh", &py_write_mesh, arg("file"), arg("mesh"), py::kw_only(),
               arg("report") = py::none(),
               "Write an OBJ or PLY file. Both formats cannot store tangents.\n\n"
               "Raises FileError if the file cannot be written; then an older file is unchanged.");
    module.def("with_frames", &py_with_frames, arg("mesh"), py::kw_only(), arg("normals") = "keep",
               arg("tangents") = "keep", arg("crease_degrees") = py::none(),
               arg("weld_tolerance") = 0.0, arg("smoothing_groups") = true, arg("repair") = false,
               arg("report") = py::none(),
               "Compute normals, then tangents, and split vertices whose corners differ.\n\n"
               "The options are those of `relief-mesh process`. The result is (mesh,\n"
               "source_vertex): the new mesh, and for each of its vertices the one it copies,\n"
               "uint32 (k,).\n\n"
               "Raises InvalidInput for wrong options, and if tangents lack texture coordinates.");
    module.def(
        "decimate", &py_decimated, arg("mesh"), py::kw_only(), arg("triangles") = py::none(),
        arg("max_error") = py::none(), arg("max_normal_degrees") = py::none(),
        arg("keep_borders") = false, arg("keep_seams") = false, arg("keep_positions") = false,
        arg("drop_parts") = 0.0, arg("goal") = py::none(),
        arg("weights") = std::map<std::string, double>(), arg("normals") = "keep",
        arg("report") = py::none(),
        "Remove vertices by edge collapses until a number of triangles or an error.\n\n"
        "`max_error` is the maximum distance between the surfaces, and `max_normal_degrees` the\n"
        "angle between a changed triangle and the surface. `keep_borders` and `keep_seams`\n"
        "leave boundaries and seams unchanged. Without `keep_positions`, the vertices that\n"
        "remain move to where the result fits the mesh best. Connected parts that are smaller\n"
        "than `drop_parts` are removed. `goal` is \"picture\", \"distance\", the default\n"
        "with `max_error`, or \"largest-distance\", as for `relief-mesh decimate --for`. `weights` "
        "has any of \"texcoords\",\n"
        "\"normals\" and \"colors\", as for `relief-mesh decimate --weights`. The result is\n"
        "(mesh, source_vertex), with source_vertex as for with_frames().\n\n"
        "Raises InvalidInput for options that are missing or out of range.");
    module.def(
        "levels_of_detail", &py_levels_of_detail, arg("mesh"), arg("triangles"), py::kw_only(),
        arg("weights") = std::map<std::string, double>(), arg("report") = py::none(),
        "Decimate a mesh to several numbers of triangles, each level from the one before.\n\n"
        "All levels have the texture coordinates of the mesh, so that one normal map serves\n"
        "all. The result is a list of meshes without the input.\n\n"
        "Raises InvalidInput for options that are out of range.");
    module.def("surface_distance", &py_surface_distance, arg("a"), arg("b"),
               "Measure the distances between two surfaces and the angles of their normals.\n\n"
               "The result is (from_a, from_b): dictionaries with the keys of the reports of\n"
               "`relief-mesh decimate` and `p95`, of the points of `a` from `b` and of those of "
               "`b` from `a`.\n\n"
               "Raises InvalidInput if a mesh has no triangle.");
    module.def("subdivide", &py_subdivided, arg("mesh"), arg("levels"), py::kw_only(),
               arg("normals") = "keep", arg("report") = py::none(),
               "Apply Loop subdivision: each level splits every triangle into four.\n\n"
               "Raises InvalidInput for wrong options, or if the result would be too large.");
    module.def("check_mesh", &py_check_mesh, arg("mesh"), py::kw_only(), arg("for_baking") = false,
               arg("for_tangents") = true,
               "Find degenerate, non-manifold, non-finite and other unusual elements.\n\n"
               "The result has the keys of a primitive of `relief-mesh check --json`.\n\n"
               "Raises InvalidInput if a triangle names a vertex that does not exist.");
    module.def("compare_meshes", &py_compare_meshes, arg("a"), arg("b"), py::kw_only(),
               arg("position_tolerance") = py::none(), arg("texcoord_tolerance") = py::none(),
               arg("by_texcoord") = true,
               "Match the corners of two meshes and measure the angles between their frames.\n\n"
               "The result has the keys of `relief-mesh compare --json`.\n\n"
               "Raises InvalidInput for wrong tolerances.");
}

}  // namespace

void add_meshes(py::module_& module) {
    add_mesh_class(module);
    add_array_functions(module);
    add_mesh_functions(module);
}

}  // namespace relief::python
