// SPDX-License-Identifier: Apache-2.0
// Texel by texel: the frame of the mesh there, interpolated as a shader has it, and the map's
// normal taken out of it or put into it. Frames in double; texels without one are (0, 0, 1) and
// counted. Tests: tests/mesh/bake/normal_space_test.cpp.
#include "relief/mesh/normal_space.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <mutex>

#include "bake/texel_frame.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

enum class SpaceTurn { to_object, to_tangent };

/// The normal of one texel in the other space, or (0, 0, 1) and why.
glm::dvec3 converted(const Mesh& mesh, const CoveredTexel& texel, const glm::dvec3& normal,
                     SpaceTurn direction, std::size_t index, Report& found) {
    const glm::dvec3 flat(0.0, 0.0, 1.0);
    if (!texel.is_covered()) return flat;
    const TexelFrame frame(mesh, texel.triangle, glm::dvec3(texel.weights()));
    if (!frame.is_usable()) {
        found.add("texel without a frame", "texel", index, "is (0, 0, 1)");
        return flat;
    }
    const glm::dvec3 result =
        direction == SpaceTurn::to_object ? frame.to_object(normal) : frame.to_tangent(normal);
    const double length = glm::length(result);
    if (!(length > 0.0) || !std::isfinite(length)) {
        found.add("normal without direction", "texel", index, "is (0, 0, 1)");
        return flat;
    }
    if (direction == SpaceTurn::to_tangent && result.z < 0.0)
        found.add("normal behind the surface", "texel", index, "kept");
    return result / length;
}

void check(const Image& normals, const Mesh& mesh) {
    if (normals.empty()) throw InvalidInput("an empty image holds no normals");
    if (normals.channels != 3 || normals.bits() != 32) {
        throw InvalidInput(fmt::format("normals have 3 float channels, not {} of {} bits",
                                       normals.channels, normals.bits()));
    }
    validate(mesh);
    if (mesh.texcoords.empty()) throw InvalidInput("the mesh has no texture coordinates");
    if (mesh.normals.empty()) throw InvalidInput("the mesh has no normals");
    if (mesh.tangents.empty()) throw InvalidInput("the mesh has no tangents");
}

ConvertedNormals convert(const Image& normals, const Mesh& mesh, const MapPlacement& placement,
                         SpaceTurn direction, Report& report) {
    check(normals, mesh);
    CoverageOptions options;
    options.width = normals.width;
    options.height = normals.height;
    options.tile = placement.tile;
    options.repeat = placement.repeat;
    ConvertedNormals result;
    result.normals = make_image(normals.width, normals.height, 3, 32, ColorSpace::data);
    std::mutex mutex;
    std::map<int, Report> reports;  // By row, so that their order is no matter of threads.
    const auto take = [&](int first_row, std::span<const CoveredTexel> texels) {
        Report found;
        const std::size_t first =
            static_cast<std::size_t>(first_row) * static_cast<std::size_t>(normals.width);
        const float* from = &normals.as<float>()[first * 3];
        float* to = &result.normals.as<float>()[first * 3];
        for (std::size_t i = 0; i < texels.size(); ++i) {
            const glm::dvec3 normal(from[i * 3], from[i * 3 + 1], from[i * 3 + 2]);
            const glm::dvec3 other =
                converted(mesh, texels[i], normal, direction, first + i, found);
            for (int axis = 0; axis < 3; ++axis)
                to[i * 3 + static_cast<std::size_t>(axis)] = static_cast<float>(other[axis] + 0.0);
        }
        const std::lock_guard lock(mutex);
        reports.emplace(first_row, std::move(found));
    };
    result.coverage = cover_texels(mesh.texcoords, mesh.triangles, options, take, report);
    for (const auto& [row, found] : reports)
        report.merge(found);
    return result;
}

}  // namespace

ConvertedNormals object_from_tangent(const Image& normals, const Mesh& mesh,
                                     const MapPlacement& placement, Report& report) {
    return convert(normals, mesh, placement, SpaceTurn::to_object, report);
}

ConvertedNormals tangent_from_object(const Image& normals, const Mesh& mesh,
                                     const MapPlacement& placement, Report& report) {
    return convert(normals, mesh, placement, SpaceTurn::to_tangent, report);
}

}  // namespace relief
