// SPDX-License-Identifier: Apache-2.0
#include "relief/mesh/model.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

/// The rounding error of text files with six digits, relative to the size of model and texture.
constexpr double default_tolerance = 1e-5;
constexpr double default_uv_tolerance = 1e-6;

constexpr std::size_t max_worst = 24;

/// Appends a primitive. Missing attributes become zeros.
void append_part(JoinedModel& model, Mesh mesh, std::string name) {
    Mesh& all = model.mesh;
    ComparedPart part;
    part.name = std::move(name);
    part.first_triangle = all.triangles.size();
    part.triangle_count = mesh.triangles.size();
    part.has_normals = !mesh.normals.empty();
    part.has_tangents = !mesh.tangents.empty();
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    const std::size_t count = all.positions.size() + mesh.positions.size();
    const auto add = [&](auto& values, auto& more) {
        if (more.empty() && values.empty()) return;
        values.resize(first);
        std::move(more.begin(), more.end(), std::back_inserter(values));
        values.resize(count);
    };
    add(all.positions, mesh.positions);
    add(all.normals, mesh.normals);
    add(all.texcoords, mesh.texcoords);
    add(all.tangents, mesh.tangents);
    for (const glm::uvec3& triangle : mesh.triangles)
        all.triangles.push_back(triangle + first);
    all.material_ranges.push_back({static_cast<std::uint32_t>(part.first_triangle),
                                   static_cast<std::uint32_t>(part.triangle_count), std::nullopt});
    model.parts.push_back(std::move(part));
}

void append_primitives(JoinedModel& model, const GltfDocument& document, bool in_world_space) {
    if (!in_world_space) {
        for (const GltfPrimitiveId id : document.triangle_primitives())
            append_part(model, document.mesh(id), document.describe(id));
        return;
    }
    document.require_memory_of_instances();
    for (const auto& primitive : document.view().primitives) {
        append_part(model, transformed(document.mesh(primitive.what), primitive.world_from_object),
                    document.describe(primitive.what));
    }
}

/// Makes positions relative to another origin.
void move_origin(JoinedModel& model, const glm::dvec3& origin) {
    const glm::dvec3 shift = model.origin - origin;
    model.origin = origin;
    if (shift == glm::dvec3(0.0)) return;
    for (glm::vec3& position : model.mesh.positions)
        position = glm::vec3(glm::dvec3(position) + shift);
}

/// The largest absolute coordinate and the longest side of the bounds of the finite positions.
struct PositionExtent {
    double largest = 0.0;
    double size = 0.0;
};

PositionExtent extent_of(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    PositionExtent extent;
    if (bounds.empty()) return extent;
    for (int i = 0; i < 3; ++i) {
        extent.size = std::max(
            extent.size, static_cast<double>(bounds.max[i]) - static_cast<double>(bounds.min[i]));
        extent.largest = std::max({extent.largest, std::abs(static_cast<double>(bounds.max[i])),
                                   std::abs(static_cast<double>(bounds.min[i]))});
    }
    return extent;
}

double largest_texcoord(const Mesh& mesh) {
    double largest = 1.0;
    for (const glm::vec2& texcoord : mesh.texcoords) {
        for (int i = 0; i < 2; ++i) {
            const double value = std::abs(static_cast<double>(texcoord[i]));
            if (std::isfinite(value)) largest = std::max(largest, value);
        }
    }
    return largest;
}

/// The tolerance is at least the spacing of floats at the coordinates of the models.
MatchOptions match_options(const ModelMatchOptions& requested, const ModelComparison& models,
                           double farthest_origin) {
    MatchOptions options;
    const PositionExtent a = extent_of(models.a.mesh);
    const PositionExtent b = extent_of(models.b.mesh);
    constexpr double float_spacing = 1.2e-7;
    options.position_tolerance = requested.position_tolerance.value_or(
        std::max(default_tolerance * std::max(a.size, b.size),
                 2.0 * float_spacing * std::max({a.largest, b.largest, farthest_origin})));
    options.texcoord_tolerance = requested.texcoord_tolerance.value_or(
        default_uv_tolerance *
        std::max(largest_texcoord(models.a.mesh), largest_texcoord(models.b.mesh)));
    options.by_texcoord = requested.by_texcoord;
    return options;
}

/// Returns the part of each triangle.
std::vector<const ComparedPart*> part_by_triangle(const JoinedModel& model) {
    std::vector<const ComparedPart*> parts(model.mesh.triangles.size());
    for (const ComparedPart& part : model.parts)
        std::fill_n(parts.begin() + static_cast<std::ptrdiff_t>(part.first_triangle),
                    part.triangle_count, &part);
    return parts;
}

/// Excludes corners of primitives that lack an attribute, and counts those that lack it in one
/// file.
void exclude_missing(ModelComparison& models, CornerDifferences& differences) {
    constexpr float not_compared = -1.0F;
    const auto of_a = part_by_triangle(models.a);
    const auto of_b = part_by_triangle(models.b);
    for (std::size_t corner = 0; corner < models.match.corners.size(); ++corner) {
        const std::uint32_t partner = models.match.corners[corner];
        if (partner == no_corner_matched) continue;
        const ComparedPart& a = *of_a[corner / 3];
        const ComparedPart& b = *of_b[partner / 3];
        models.normals_in_one += a.has_normals != b.has_normals ? 1 : 0;
        models.tangents_in_one += a.has_tangents != b.has_tangents ? 1 : 0;
        if (!differences.normals.empty() && !(a.has_normals && b.has_normals))
            differences.normals[corner] = not_compared;
        if (!differences.tangents.empty() && !(a.has_tangents && b.has_tangents)) {
            differences.tangents[corner] = not_compared;
            differences.sign_differs[corner] = 0;
        }
    }
}

void count_unmatched(std::vector<ComparedPart>& parts, const std::vector<std::uint32_t>& only) {
    for (ComparedPart& part : parts) {
        const auto begin = std::lower_bound(only.begin(), only.end(), part.first_triangle);
        const auto end =
            std::lower_bound(begin, only.end(), part.first_triangle + part.triangle_count);
        part.unmatched = static_cast<std::size_t>(end - begin);
    }
}

}  // namespace

bool ModelComparison::is_within(double degrees) const {
    return all.normals.max <= degrees && all.tangents.max <= degrees && all.sign_differences == 0 &&
           all.normals.undefined + all.tangents.undefined == 0;
}

bool ModelComparison::is_complete() const {
    return match.only_a.empty() && match.only_b.empty() && match.ambiguous == 0 &&
           all.normals.undefined + all.tangents.undefined == 0 &&
           normals_in_one + tangents_in_one == 0;
}

bool ModelComparison::has_directions() const {
    return all.normals.count + all.normals.undefined + all.tangents.count +
               all.tangents.undefined !=
           0;
}

JoinedModel joined_model(Model model, bool in_world_space) {
    JoinedModel result;
    result.in_world_space = in_world_space;
    if (auto* contents = std::get_if<MeshFile>(&model)) {
        validate(contents->mesh);
        result.origin = contents->origin;
        append_part(result, std::move(contents->mesh), "");
    } else {
        append_primitives(result, std::get<GltfDocument>(model), in_world_space);
    }
    if (result.mesh.triangles.empty()) throw InvalidInput("has no triangles");
    return result;
}

ModelComparison compare_models(JoinedModel a, JoinedModel b, const ModelMatchOptions& options) {
    const glm::dvec3 origin = a.origin != glm::dvec3(0.0) ? a.origin : b.origin;
    const double farthest_origin = a.origin != b.origin ? glm::length(origin) : 0.0;
    ModelComparison result;
    result.a = std::move(a);
    result.b = std::move(b);
    move_origin(result.a, origin);
    move_origin(result.b, origin);
    result.options = match_options(options, result, farthest_origin);
    result.match = match_corners(result.a.mesh, result.b.mesh, result.options);
    CornerDifferences differences = corner_differences(result.a.mesh, result.b.mesh, result.match);
    exclude_missing(result, differences);
    count_unmatched(result.a.parts, result.match.only_a);
    count_unmatched(result.b.parts, result.match.only_b);
    result.all = compared(differences, result.match, 0, result.a.mesh.triangles.size(), max_worst);
    for (ComparedPart& part : result.a.parts) {
        part.comparison = compared(differences, result.match, part.first_triangle,
                                   part.triangle_count, max_worst);
    }
    return result;
}

}  // namespace relief
