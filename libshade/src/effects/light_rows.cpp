// SPDX-License-Identifier: Apache-2.0
// Lights as numbers for the shaders, in world space; light_rows.h describes the layout. Directions
// are normalized in double precision, so that every length of a float works. Shadow maps are
// computed for the bounding sphere of the scene.
// Tests: tests/shade/effects/shader_source_test.cpp, tests/shade/render/shading_test.cpp.
#include "effects/light_rows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "portable_math.h"
#include "scene/scene_parts.h"

namespace relief::shade::detail {
using namespace relief::detail;

namespace {

glm::vec3 unit(const glm::vec3& direction) {
    return glm::vec3(glm::normalize(glm::dvec3(direction)));
}

glm::vec4 position_row(const PointLight& light) {
    return {light.position_world, light.range ? 1.0F / *light.range : 0.0F};
}

glm::vec4 intensity_row(const PointLight& light) {
    return {light.intensity, light.falloff == Falloff::inverse_square ? 1.0F : 0.0F};
}

void add(std::vector<glm::vec4>& rows, const DirectionalLight& light) {
    rows.emplace_back(-unit(light.direction_world), 0.0F);
    rows.emplace_back(light.irradiance, 0.0F);
}

void add(std::vector<glm::vec4>& rows, const PointLight& light) {
    rows.push_back(position_row(light));
    rows.push_back(intensity_row(light));
}

void add(std::vector<glm::vec4>& rows, const SpotLight& light) {
    // A smaller difference between the cones is one sharp edge (KHR_lights_punctual).
    constexpr double min_difference = 1e-3;
    const double outer = portable::cos(static_cast<double>(light.outer_cone));
    const double inner = portable::cos(static_cast<double>(light.inner_cone));
    const double scale = 1.0 / std::max(inner - outer, min_difference);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(light.direction_world));
    rows.push_back(position_row(light.point));
    rows.push_back(intensity_row(light.point));
    rows.emplace_back(glm::vec3(axis * scale), static_cast<float>(-outer * scale));
}

glm::vec3 highlights_of(const DirectionalLight& light) {
    return light.highlight_irradiance.value_or(light.irradiance);
}
glm::vec3 highlights_of(const PointLight& light) {
    return light.highlight_intensity.value_or(light.intensity);
}
glm::vec3 highlights_of(const SpotLight& light) {
    return highlights_of(light.point);
}

/// Adds the rows of the shining lights of one kind, and black rows up to the planned count.
template <typename Light>
void add_all(std::vector<glm::vec4>& rows, const std::vector<Light>& lights, std::size_t end,
             bool highlight_colors) {
    for (const Light& light : lights) {
        if (!shines(light) || rows.size() >= end) continue;
        add(rows, light);
        if (highlight_colors) rows.emplace_back(highlights_of(light), 0.0F);
    }
    rows.resize(end, glm::vec4(0.0F));
}

}  // namespace

LightRowLayout light_row_layout(const Features& features) {
    const std::uint32_t more = features.highlight_colors ? 1 : 0;
    LightRowLayout layout;
    layout.directional_rows += more;
    layout.point_rows += more;
    layout.spot_rows += more;
    layout.first_point = layout.directional_rows * features.directional_lights;
    layout.first_spot = layout.first_point + layout.point_rows * features.point_lights;
    layout.count = layout.first_spot + layout.spot_rows * features.spot_lights;
    return layout;
}

bool shines(const DirectionalLight& light) {
    return light.on && (is_not_black(light.irradiance) || is_not_black(highlights_of(light)));
}
bool shines(const PointLight& light) {
    return light.on && (is_not_black(light.intensity) || is_not_black(highlights_of(light)));
}
bool shines(const SpotLight& light) {
    return shines(light.point);
}

std::vector<glm::vec4> light_rows(const Scene& scene, const Features& features) {
    const LightRowLayout layout = light_row_layout(features);
    std::vector<glm::vec4> rows;
    rows.reserve(layout.count);
    const bool colors = features.highlight_colors;
    add_all(rows, scene.directional_lights, layout.first_point, colors);
    add_all(rows, scene.point_lights, layout.first_spot, colors);
    add_all(rows, scene.spot_lights, layout.count, colors);
    return rows;
}

// Shadows

namespace {

/// Maps of a light with several points need fewer texels, since their edges are averaged.
constexpr int soft_texels = 1024;
constexpr int hard_texels = 2048;
constexpr double lift_texels = 2.5;
/// Closer lights would need maps with an angle of more than 130 degrees.
constexpr double min_distance_share = 1.1;

/// The light that casts the shadow.
struct MainLight {
    ShadowTerm kind = ShadowTerm::none;
    glm::dvec4 world{0.0};  ///< The position, or the direction to it.
};

MainLight main_light(const Scene& scene) {
    for (const DirectionalLight& light : scene.directional_lights) {
        if (shines(light)) {
            return {ShadowTerm::directional_light,
                    {-glm::normalize(glm::dvec3(light.direction_world)), 0.0}};
        }
    }
    for (const SpotLight& light : scene.spot_lights) {
        if (shines(light))
            return {ShadowTerm::spot_light, {glm::dvec3(light.point.position_world), 1.0}};
    }
    for (const PointLight& light : scene.point_lights) {
        if (shines(light))
            return {ShadowTerm::point_light, {glm::dvec3(light.position_world), 1.0}};
    }
    return {};
}

using relief::shade::detail::casts_shadow;

bool casts_shadow(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (mesh.material_ranges.empty()) return !mesh.triangles.empty();
    return std::any_of(
        mesh.material_ranges.begin(), mesh.material_ranges.end(), [&](const MaterialRange& range) {
            return range.triangle_count > 0 &&
                   (!range.material || casts_shadow(scene.materials[*range.material]));
        });
}

/// Returns the bounding box of the instances that cast shadows.
Bounds casting_bounds(const Scene& scene) {
    Bounds bounds;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        if (casts_shadow(scene, scene.instances[i])) add_instance(scene, i, bounds);
    }
    return bounds;
}

/// Returns points that cover the unit disc evenly, on a spiral by the golden angle [Vogel 1979].
std::vector<glm::dvec2> disc_points() {
    const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
    std::vector<glm::dvec2> points;
    for (std::size_t i = 0; i < shadow_point_count; ++i) {
        const double index = static_cast<double>(i);
        const double angle = golden_angle * index;
        const double radius = std::sqrt((index + 0.5) / static_cast<double>(shadow_point_count));
        points.push_back(radius * glm::dvec2(portable::cos(angle), portable::sin(angle)));
    }
    return points;
}

}  // namespace

glm::dvec3 ShadowView::to_light(const glm::dvec3& position_world, const glm::dvec2& point) const {
    const glm::dvec3 light(homogeneous_light(point));
    if (light_world.w != 0.0) return light - position_world;
    return light * (radius + glm::distance(position_world, center_world));
}

glm::dvec4 ShadowView::homogeneous_light(const glm::dvec2& point) const {
    return light_world + glm::dvec4(point.x * right_world + point.y * up_world, 0.0);
}

glm::dmat4 ShadowView::clip_from_world(const glm::dvec2& point) const {
    const glm::dmat4 rows = glm::transpose(place_from_world);
    const glm::dvec4 displaced = shift.x * rows[2] + shift.y * rows[3];
    const glm::dvec4 x = rows[0] + point.x * displaced;
    const glm::dvec4 y = rows[1] + point.y * displaced;
    return glm::transpose(
        glm::dmat4(2.0 * x - rows[3], 2.0 * y - rows[3], 2.0 * rows[2] - rows[3], rows[3]));
}

std::optional<ShadowView> shadow_view(const Scene& scene) {
    const MainLight light = main_light(scene);
    if (!scene.shadow || light.kind == ShadowTerm::none) return std::nullopt;
    const Bounds bounds = casting_bounds(scene);
    if (bounds.empty()) return std::nullopt;
    ShadowView view;
    view.kind = light.kind;
    view.light_world = light.world;
    view.center_world = 0.5 * (glm::dvec3(bounds.min) + glm::dvec3(bounds.max));
    view.radius = 0.5 * glm::distance(glm::dvec3(bounds.min), glm::dvec3(bounds.max));
    if (!(view.radius > 0.0)) return std::nullopt;
    const double radius = view.radius;
    const bool is_directional = light.world.w == 0.0;
    const glm::dvec3 to_light = glm::dvec3(light.world) - light.world.w * view.center_world;
    const double distance = is_directional ? radius : glm::length(to_light);
    if (!is_directional && distance < min_distance_share * radius) return std::nullopt;

    const glm::dvec3 back = glm::normalize(to_light);
    glm::dvec3 other(0.0);
    other[std::abs(back.y) < 0.9 ? 1 : 0] = 1.0;
    const glm::dvec3 right = glm::normalize(glm::cross(other, back));
    const glm::dvec3 up = glm::cross(back, right);
    const bool is_hard = scene.shadow->size == 0.0F;
    const double tangent = portable::tan(0.5 * static_cast<double>(scene.shadow->size));
    view.points = is_hard ? std::vector{glm::dvec2(0.0)} : disc_points();
    view.texels = is_hard ? hard_texels : soft_texels;
    view.right_world = right * tangent * (is_directional ? 1.0 : distance);
    view.up_world = up * tangent * (is_directional ? 1.0 : distance);

    // Depth is measured from the plane of the light, which is at the scene if it is directional.
    constexpr double margin = 1.02;
    const double near = is_directional ? -margin * radius + radius
                                       : distance - std::min(margin * radius, 0.98 * distance);
    const double far = distance + margin * radius;
    const glm::dvec3 origin = view.center_world + distance * back;
    const glm::dvec4 x(right, -glm::dot(right, origin));
    const glm::dvec4 y(up, -glm::dot(up, origin));
    const glm::dvec4 depth(-back, glm::dot(back, origin));
    const glm::dvec4 one(0.0, 0.0, 0.0, 1.0);
    // Half of the width of the maps: of a directional light in world units, else at depth 1. Points
    // of the light displace what is beside the middle of the scene by up to tangent * radius.
    const double half =
        margin * (is_directional ? radius * (1.0 + tangent)
                                 : radius / std::sqrt(distance * distance - radius * radius) +
                                       tangent * radius / (distance - radius));
    const glm::dvec4 w = is_directional ? one : depth;
    const glm::dvec4 z = is_directional ? (depth - near * one) / (far - near)
                                        : far * (depth - near * one) / (far - near);
    view.place_from_world =
        glm::transpose(glm::dmat4(0.5 * (x / half + w), 0.5 * (y / half + w), z, w));
    // A point p of the light displaces by p * slope * (depth - distance).
    const double slope = 0.5 * tangent / half;
    view.shift = is_directional ? slope * glm::dvec2(far - near, near - distance)
                                : slope * glm::dvec2(distance * (far - near) / (far * near),
                                                     1.0 - distance / near);
    const double width = 2.0 * half * (is_directional ? 1.0 : far);
    view.lift = lift_texels * width / view.texels;
    return view;
}

ShadowTerm shadow_term(const Scene& scene) {
    const std::optional<ShadowView> view = shadow_view(scene);
    return view ? view->kind : ShadowTerm::none;
}

}  // namespace relief::shade::detail
