// SPDX-License-Identifier: Apache-2.0
// The bound of what a relief can displace on the screen: plain geometry of triangles and camera.
// Tests: tests/shade/render/depth_mapping_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "effects/features.h"
#include "relief/mesh/report.h"
#include "scene/scene_parts.h"

namespace relief::shade::detail {

namespace {

/// The camera, and what it sees of a world unit.
struct Screen {
    glm::dmat4 view_from_world;
    bool is_orthographic = false;
    double near = 0.0;
    double pixels = 0.0;  ///< Of a world unit at distance 1, or anywhere if it is orthographic.
    double oblique =
        1.0;  ///< The ratio of lengths on the screen and across the view, at its corner.
};

Screen screen_of(const Camera& camera, const FrameSettings& settings) {
    Screen screen;
    screen.view_from_world = glm::inverse(glm::dmat4(camera.world_from_view));
    screen.is_orthographic = camera.orthographic_height.has_value();
    screen.near = static_cast<double>(camera.near);
    const double half = half_height(camera);
    screen.pixels = 0.5 * settings.height / half;
    if (screen.is_orthographic) return screen;
    const double aspect = static_cast<double>(settings.width) / settings.height;
    screen.oblique = std::sqrt(1.0 + half * half * (1.0 + aspect * aspect));
    return screen;
}

/// Returns the sine of the angle between two directions of any length, rounded up.
double sine_between(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 across = glm::cross(a, b);
    const double lengths = std::sqrt(glm::dot(a, a) * glm::dot(b, b));
    if (!(lengths > 0.0)) return 1.0;
    return std::min(1.0, std::sqrt(glm::dot(across, across)) / lengths + 1e-6);
}

/// A triangle in view space.
struct Seen {
    std::array<glm::dvec3, 3> corners;
    std::array<glm::dvec3, 3> normals;  ///< Zero if they are unknown.
};

/// Returns the sine of the steepest angle between view and normal on a triangle; 0 if it is seen
/// from behind, where nothing is displaced. Between normals that differ, it may be larger than at
/// the corners: then the sine is 1.
double steepest(const Screen& screen, const Seen& seen) {
    double sine = 0.0;
    int behind = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3& normal = seen.normals.at(i);
        if (normal == glm::dvec3(0.0) || normal != seen.normals[0]) return 1.0;
        const glm::dvec3 view = screen.is_orthographic ? glm::dvec3(0, 0, 1) : -seen.corners.at(i);
        if (!(glm::dot(view, normal) > 0.0)) ++behind;
        sine = std::max(sine, sine_between(view, normal));
    }
    return behind == 3 ? 0.0 : behind > 0 ? 1.0 : sine;
}

/// Returns the bound for one triangle; infinite if the relief reaches the eye, 0 if it is not seen.
double shift_of(const Screen& screen, const Seen& seen, double depth_world) {
    if (screen.is_orthographic) return depth_world * screen.pixels * steepest(screen, seen);
    const double nearest = -std::max({seen.corners[0].z, seen.corners[1].z, seen.corners[2].z});
    const double farthest = -std::min({seen.corners[0].z, seen.corners[1].z, seen.corners[2].z});
    if (farthest < screen.near) return 0.0;
    const double distance = std::max(nearest, screen.near) - depth_world;
    if (!(distance > 0.0)) return std::numeric_limits<double>::infinity();
    // Behind the near plane, a view may be steeper than at any corner.
    const double sine = nearest < screen.near ? 1.0 : steepest(screen, seen);
    return depth_world * screen.pixels * screen.oblique * sine / distance;
}

/// Returns the size of an image; none if it cannot be read.
std::optional<glm::dvec2> size_of(const ImageSource& source) {
    try {
        return glm::dvec2(image_size(source));
    } catch (const FileError&) {
        return std::nullopt;
    }
}

}  // namespace

std::optional<double> relief_shift(const Scene& scene, const Instance& instance,
                                   const MaterialRange& range, const FrameSettings& settings) {
    if (!range.material || !scene.materials[*range.material].height_map) return std::nullopt;
    const ReliefMap& map = *scene.materials[*range.material].height_map;
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (!settings.camera || instance.pose || mesh.texcoords.empty()) return std::nullopt;
    const std::optional<glm::dvec2> size = size_of(scene.images[map.texture.image]);
    if (!size) return std::nullopt;

    const Screen screen = screen_of(*settings.camera, settings);
    const glm::dmat4 world_from_object(instance.world_from_object);
    const glm::dmat3 linear(world_from_object);
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    const glm::dmat3 of_normals =
        glm::dmat3(screen.view_from_world) *
        (glm::dot(linear[0], cofactors[0]) < 0.0 ? -cofactors : cofactors);
    double bound = 0.0;
    for (std::uint32_t i = 0; i < range.triangle_count; ++i) {
        const glm::uvec3& triangle = mesh.triangles[range.first_triangle + i];
        Seen seen;
        std::array<glm::dvec2, 3> texels;
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = triangle[corner];
            const auto at = static_cast<std::size_t>(corner);
            seen.corners.at(at) = glm::dvec3(
                screen.view_from_world *
                (world_from_object * glm::dvec4(glm::dvec3(mesh.positions[vertex]), 1.0)));
            texels.at(at) = *size * glm::dvec2(mesh.texcoords[vertex]);
            if (!mesh.normals.empty())
                seen.normals.at(at) = of_normals * glm::dvec3(mesh.normals[vertex]);
        }
        const glm::dvec3 across =
            glm::cross(seen.corners[1] - seen.corners[0], seen.corners[2] - seen.corners[0]);
        const double area_world = std::sqrt(glm::dot(across, across));
        const glm::dvec2 a = texels[1] - texels[0];
        const glm::dvec2 b = texels[2] - texels[0];
        const double area_texels = std::abs(a.x * b.y - a.y * b.x);
        // Without an area in the map, nothing is displaced.
        if (!(area_texels > 0.0) || !(area_world > 0.0)) continue;
        const double depth_world =
            static_cast<double>(map.depth) * std::sqrt(area_world / area_texels);
        bound = std::max(bound, shift_of(screen, seen, depth_world));
        if (!std::isfinite(bound)) return bound;
    }
    return bound;
}

}  // namespace relief::shade::detail
