// SPDX-License-Identifier: Apache-2.0
// The bounds of what a relief can change on the screen: plain geometry of triangles, camera and
// lights.
// Tests: tests/shade/render/depth_mapping_test.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "effects/features.h"
#include "effects/light_rows.h"
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

    /// True if one normal holds for all of the triangle.
    [[nodiscard]] bool has_one_normal() const {
        return normals[0] != glm::dvec3(0.0) && normals[1] == normals[0] &&
               normals[2] == normals[0];
    }
};

/// Returns the sine of the steepest angle between view and normal on a triangle; none if it is seen
/// from behind, where nothing is displaced. Between normals that differ, it may be larger than at
/// the corners: then the sine is 1.
std::optional<double> steepest(const Screen& screen, const Seen& seen) {
    if (!seen.has_one_normal()) return 1.0;
    double sine = 0.0;
    int behind = 0;
    for (const glm::dvec3& corner : seen.corners) {
        const glm::dvec3 view = screen.is_orthographic ? glm::dvec3(0, 0, 1) : -corner;
        if (!(glm::dot(view, seen.normals[0]) > 0.0)) ++behind;
        sine = std::max(sine, sine_between(view, seen.normals[0]));
    }
    if (behind == 3) return std::nullopt;
    return behind > 0 ? 1.0 : sine;
}

/// The lights that shine, homogeneous in view space: a position, or a direction to the light.
std::vector<glm::dvec4> lights_in(const Screen& screen, const Scene& scene) {
    std::vector<glm::dvec4> lights;
    const auto add = [&](const glm::vec3& vector, double w) {
        lights.push_back(screen.view_from_world * glm::dvec4(glm::dvec3(vector), w));
    };
    for (const DirectionalLight& light : scene.directional_lights)
        if (shines(light)) add(-light.direction_world, 0.0);
    for (const PointLight& light : scene.point_lights)
        if (shines(light)) add(light.position_world, 1.0);
    for (const SpotLight& light : scene.spot_lights)
        if (shines(light)) add(light.point.position_world, 1.0);
    return lights;
}

/// Returns the tangent of the flattest angle of light on a triangle, rounded up; infinite if light
/// arrives along it or from behind, or if its normals differ. The tangent is largest at a corner.
double flattest(const std::vector<glm::dvec4>& lights, const Seen& seen) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (!seen.has_one_normal()) return infinity;
    double tangent = 0.0;
    for (const glm::dvec4& light : lights) {
        for (const glm::dvec3& corner : seen.corners) {
            const glm::dvec3 to_light = glm::dvec3(light) - light.w * corner;
            const double sine = sine_between(to_light, seen.normals[0]);
            if (!(glm::dot(to_light, seen.normals[0]) > 0.0) || sine >= 1.0) return infinity;
            tangent = std::max(tangent, sine / std::sqrt(1.0 - sine * sine));
        }
    }
    return tangent;
}

/// Returns how long a depth is on the screen at the nearest corner; infinite if it reaches the eye,
/// 0 if the triangle is not seen.
double pixels_of(const Screen& screen, const Seen& seen, double depth_world) {
    if (screen.is_orthographic) return depth_world * screen.pixels;
    const double nearest = -std::max({seen.corners[0].z, seen.corners[1].z, seen.corners[2].z});
    const double farthest = -std::min({seen.corners[0].z, seen.corners[1].z, seen.corners[2].z});
    if (farthest < screen.near) return 0.0;
    const double distance = std::max(nearest, screen.near) - depth_world;
    if (!(distance > 0.0)) return std::numeric_limits<double>::infinity();
    return depth_world * screen.pixels * screen.oblique / distance;
}

/// Raises the bounds by those of one triangle.
void include(const Screen& screen, const Seen& seen, double depth_world,
             const std::vector<glm::dvec4>& lights, ReliefBounds& bounds) {
    const double pixels = pixels_of(screen, seen, depth_world);
    if (pixels == 0.0) return;
    // Behind the near plane, a view may be steeper than at any corner.
    const bool is_cut =
        !screen.is_orthographic && std::any_of(seen.corners.begin(), seen.corners.end(),
                                               [&](const auto& c) { return -c.z < screen.near; });
    const std::optional<double> sine = is_cut ? 1.0 : steepest(screen, seen);
    const bool is_near = std::isinf(pixels);
    if (!sine && !is_near) return;
    bounds.shift = std::max(bounds.shift, is_near ? pixels : pixels * *sine);
    bounds.depth = std::max(bounds.depth, pixels);
    // A relief that curves is not lower than one that does not, and nothing lies deeper than black.
    if (!seen.has_one_normal()) bounds.curve = std::max(bounds.curve, pixels);
    if (lights.empty() || std::isinf(bounds.shadow)) return;
    bounds.shadow = std::max(bounds.shadow, is_near ? pixels : pixels * flattest(lights, seen));
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

std::optional<ReliefBounds> relief_bounds(const Scene& scene, const Instance& instance,
                                          const MaterialRange& range,
                                          const FrameSettings& settings) {
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
    const std::vector<glm::dvec4> lights =
        map.self_shadow ? lights_in(screen, scene) : std::vector<glm::dvec4>{};
    ReliefBounds bounds;
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
        include(screen, seen, depth_world, lights, bounds);
        const bool curve_is_known =
            map.silhouette != ReliefSilhouette::curve || std::isinf(bounds.curve);
        if (std::isinf(bounds.shift) && curve_is_known &&
            (lights.empty() || std::isinf(bounds.shadow)))
            break;
    }
    return bounds;
}

}  // namespace relief::shade::detail
