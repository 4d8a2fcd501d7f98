// SPDX-License-Identifier: Apache-2.0
// Converts normal maps between tangent and object space, with the interpolated frame of the mesh at
// each texel, in double. Texels without a frame become (0, 0, 1) and are reported. Tests:
// tests/mesh/bake/map_convention_test.cpp.
#include "relief/mesh/map_convention.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <mutex>

#include "bake/texel_frame.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

enum class Conversion { to_object, to_tangent };

/// Returns the normal of a texel in the other space. If there is none, it is (0, 0, 1), with a
/// finding.
glm::dvec3 converted(const Mesh& mesh, const CoveredTexel& texel, const glm::dvec3& normal,
                     Conversion direction, std::size_t index, Report& report) {
    const glm::dvec3 flat(0.0, 0.0, 1.0);
    if (!texel.is_covered()) return flat;
    const detail::TexelFrame frame(mesh, texel.triangle, glm::dvec3(texel.weights()));
    if (!frame.is_usable()) {
        report.add("texel without a frame", "texel", index, "is (0, 0, 1)");
        return flat;
    }
    const glm::dvec3 result =
        direction == Conversion::to_object ? frame.to_object(normal) : frame.to_tangent(normal);
    const double length = glm::length(result);
    if (!(length > 0.0) || !std::isfinite(length)) {
        report.add("normal without direction", "texel", index, "is (0, 0, 1)");
        return flat;
    }
    if (direction == Conversion::to_tangent && result.z < 0.0)
        report.add("normal behind the surface", "texel", index, "kept");
    return result / length;
}

void check(const Image& normals, const Mesh& mesh) {
    if (normals.empty()) throw InvalidInput("the normal map is empty");
    if (normals.channels != 3 || normals.bits() != 32) {
        throw InvalidInput(fmt::format("normals have 3 float channels, not {} of {} bits",
                                       normals.channels, normals.bits()));
    }
    validate(mesh);
    if (mesh.texcoords.empty()) throw InvalidInput("the mesh has no texture coordinates");
    if (mesh.normals.empty()) throw InvalidInput("the mesh has no normals");
    if (mesh.tangents.empty()) throw InvalidInput("the mesh has no tangents");
}

ConvertedNormals convert(const Image& normals, const Mesh& mesh, const MapRegion& placement,
                         Conversion direction, Report& report) {
    check(normals, mesh);
    CoverageOptions options;
    options.width = normals.width;
    options.height = normals.height;
    options.tile = placement.tile;
    options.repeat = placement.repeat;
    ConvertedNormals result;
    result.normals = make_image(normals.width, normals.height, 3, 32, ColorSpace::data);
    std::mutex mutex;
    std::map<int, Report> reports;  // By row, so that the order does not depend on threads.
    const auto take = [&](int first_row, std::span<const CoveredTexel> texels) {
        Report row_report;
        const std::size_t first =
            static_cast<std::size_t>(first_row) * static_cast<std::size_t>(normals.width);
        const float* from = &normals.as<float>()[first * 3];
        float* to = &result.normals.as<float>()[first * 3];
        for (std::size_t i = 0; i < texels.size(); ++i) {
            const glm::dvec3 normal(from[i * 3], from[i * 3 + 1], from[i * 3 + 2]);
            const glm::dvec3 other =
                converted(mesh, texels[i], normal, direction, first + i, row_report);
            for (int axis = 0; axis < 3; ++axis)
                to[i * 3 + static_cast<std::size_t>(axis)] = static_cast<float>(other[axis] + 0.0);
        }
        const std::lock_guard lock(mutex);
        reports.emplace(first_row, std::move(row_report));
    };
    result.coverage = cover_texels(mesh.texcoords, mesh.triangles, options, take, report);
    for (const auto& [row, row_report] : reports)
        report.merge(row_report);
    return result;
}

}  // namespace

ConvertedNormals object_from_tangent(const Image& normals, const Mesh& mesh,
                                     const MapRegion& placement, Report& report) {
    return convert(normals, mesh, placement, Conversion::to_object, report);
}

ConvertedNormals tangent_from_object(const Image& normals, const Mesh& mesh,
                                     const MapRegion& placement, Report& report) {
    return convert(normals, mesh, placement, Conversion::to_tangent, report);
}

}  // namespace relief
