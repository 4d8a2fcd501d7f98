// SPDX-License-Identifier: Apache-2.0
// Attributes and normals at a hit, in double, world space. See surface.h for what has no direction.
// The basis of a map is used as interpolated, not made unit and not made perpendicular, as
// MikkTSpace asks [Mikkelsen 2008]; heights bend the normal as in [Blinn 1978].
// Tests: tests/shade/reference/surface_test.cpp.
#include "reference/surface.h"

#include <array>
#include <cmath>

#include "geometry/direction.h"

namespace relief::reference {

namespace {

/// A unit vector, or the fallback where there is none that a float could square.
glm::dvec3 unit_or(const glm::dvec3& vector, const glm::dvec3& fallback) {
    const double squared = glm::dot(vector, vector);
    return squared > 1e-30 && squared < 1e30 ? vector / std::sqrt(squared) : fallback;
}

const glm::dvec3 z_axis(0.0, 0.0, 1.0);

/// One hit with its triangle's corners at hand.
struct Triangle {
    const PreparedInstance& instance;
    glm::uvec3 corners;
    glm::dvec3 barycentric;

    template <typename T>
    [[nodiscard]] T interpolated(const std::vector<T>& by_vertex) const {
        return by_vertex[corners.x] * barycentric.x + by_vertex[corners.y] * barycentric.y +
               by_vertex[corners.z] * barycentric.z;
    }
    template <typename Double, typename Float>
    [[nodiscard]] Double interpolated_as(const std::vector<Float>& by_vertex) const {
        return Double(by_vertex[corners.x]) * barycentric.x +
               Double(by_vertex[corners.y]) * barycentric.y +
               Double(by_vertex[corners.z]) * barycentric.z;
    }
};

Triangle triangle_of(const PreparedScene& prepared, const Hit& hit) {
    const PreparedInstance& instance = prepared.instances[hit.instance];
    return {instance, instance.mesh->triangles[hit.triangle], hit.barycentric};
}

/// The normal of the triangle's plane on its front side: where it is counter-clockwise, or
/// clockwise where the instance is mirrored.
glm::dvec3 front_of_plane(const Triangle& triangle) {
    const auto& positions = triangle.instance.positions_world;
    const glm::dvec3 a = positions[triangle.corners.x];
    const glm::dvec3 normal = direction_or_zero(
        glm::cross(positions[triangle.corners.y] - a, positions[triangle.corners.z] - a));
    return triangle.instance.mirrors ? -normal : normal;
}

/// The basis of tangent space, none of it necessarily unit or perpendicular.
struct Basis {
    glm::dvec3 tangent{0.0};
    glm::dvec3 bitangent{0.0};
    glm::dvec3 normal{0.0};
};

Basis stored_basis(const Triangle& triangle, const glm::dvec3& normal) {
    if (triangle.instance.tangents_world.empty()) return {glm::dvec3(0.0), glm::dvec3(0.0), normal};
    const glm::dvec4 tangent = triangle.interpolated(triangle.instance.tangents_world);
    const glm::dvec3 along(tangent);
    return {along, tangent.w * glm::cross(normal, along), normal};
}

/// From how positions change with texture coordinates over the triangle. Where those span nothing,
/// neither does the basis.
Basis derived_basis(const Triangle& triangle, const glm::dvec3& normal) {
    const auto& positions = triangle.instance.positions_world;
    const auto& texcoords = triangle.instance.mesh->texcoords;
    const glm::uvec3& corners = triangle.corners;
    const glm::dvec3 p1 = positions[corners.y] - positions[corners.x];
    const glm::dvec3 p2 = positions[corners.z] - positions[corners.x];
    const glm::dvec2 t1 = glm::dvec2(texcoords[corners.y]) - glm::dvec2(texcoords[corners.x]);
    const glm::dvec2 t2 = glm::dvec2(texcoords[corners.z]) - glm::dvec2(texcoords[corners.x]);
    const double area = t1.x * t2.y - t1.y * t2.x;
    const glm::dvec3 unit_normal = unit_or(normal, z_axis);
    if (!(std::abs(area) > 0.0)) return {glm::dvec3(0.0), glm::dvec3(0.0), unit_normal};
    const glm::dvec3 along_u = (p1 * t2.y - p2 * t1.y) * (area < 0.0 ? -1.0 : 1.0);
    const glm::dvec3 tangent = direction_or_zero(in_plane(along_u, unit_normal));
    // v grows downwards: a texture that is upright on the front side has a negative area.
    const bool upright = (area < 0.0) != triangle.instance.mirrors;
    return {tangent, (upright ? 1.0 : -1.0) * glm::cross(unit_normal, tangent), unit_normal};
}

/// The vector that a normal map's filtered codes stand for; y up, without the scale of x and y.
glm::dvec3 decoded(const glm::dvec3& sample, int bits, FlatCode flat, Green green) {
    glm::dvec3 vector = 2.0 * sample - 1.0;
    if (bits < 32 && flat == FlatCode::middle) {
        const double largest = bits == 8 ? 255.0 : 65535.0;
        const double middle = (largest + 1.0) / 2.0;
        vector = (sample * largest - middle) / (middle - 1.0);
    }
    if (green == Green::down) vector.y = -vector.y;
    return vector;
}

glm::dvec3 mapped_vector(const PreparedScene& prepared, const NormalMap& map,
                         const glm::dvec2& texcoord, Trace& trace) {
    const glm::dvec3 sample(prepared.texels.look_up(map.texture, ImageUse::data, texcoord, trace));
    return decoded(sample, prepared.normal_map_bits.at(map.texture.image), prepared.flat_code(map),
                   map.green);
}

/// The normal of heights: central differences over one texel to either side.
glm::dvec3 bumped_vector(const PreparedScene& prepared, const BumpMap& map,
                         const glm::dvec2& texcoord, Trace& trace) {
    const Texels& texels = prepared.texels.get(map.texture.image, ImageUse::data);
    const auto height = [&](double x, double y) {
        const glm::dvec2 place = texcoord + glm::dvec2(x / texels.width(), y / texels.height());
        return prepared.texels.look_up(map.texture, ImageUse::data, place, trace).x;
    };
    const double strength = static_cast<double>(map.strength);
    const double along_u = 0.5 * strength * (height(1.0, 0.0) - height(-1.0, 0.0));
    const double along_v = 0.5 * strength * (height(0.0, 1.0) - height(0.0, -1.0));
    return {-along_u, along_v, 1.0};
}

/// The vector of tangent space that a material's normal or bump map asks for at a point.
glm::dvec3 vector_tangent(const PreparedScene& prepared, const Material& material,
                          const glm::dvec2& texcoord, Trace& trace) {
    if (material.bump_map) return bumped_vector(prepared, *material.bump_map, texcoord, trace);
    const double scale = static_cast<double>(material.normal_map->scale);
    return mapped_vector(prepared, *material.normal_map, texcoord, trace) *
           glm::dvec3(scale, scale, 1.0);
}

/// The mean of three codes' rounding: shorter vectors are none.
bool holds_nothing(const glm::dvec3& vector) {
    return !(glm::dot(vector, vector) > 1e-12);
}

/// The normal that an object-space map stores, in world space; zero where it stores none.
glm::dvec3 stored_normal(const PreparedScene& prepared, const Hit& hit, const NormalMap& map,
                         const glm::dvec2& texcoord, Trace& trace) {
    const glm::dvec3 normal_object = mapped_vector(prepared, map, texcoord, trace);
    if (holds_nothing(normal_object)) return glm::dvec3(0.0);
    return direction_or_zero(prepared.instances[hit.instance].world_from_object_normal *
                             normal_object);
}

/// The normal on the front side.
glm::dvec3 front_normal(const PreparedScene& prepared, const Hit& hit, const Material& material,
                        const glm::dvec2& texcoord, Trace& trace) {
    const Triangle triangle = triangle_of(prepared, hit);
    const glm::dvec3 normal = material.interpolation == Interpolation::flat
                                  ? front_of_plane(triangle)
                                  : triangle.interpolated(triangle.instance.normals_world);
    const glm::dvec3 fallback = unit_or(normal, z_axis);
    // Flat shading knows the triangle's plane only, and Gouraud's the normals of vertices.
    const bool has_map = material.interpolation == Interpolation::per_pixel &&
                         (material.normal_map || material.bump_map);
    if (!has_map || triangle.instance.mesh->texcoords.empty()) return fallback;
    if (material.normal_map && material.normal_map->space == NormalSpace::object) {
        return unit_or(stored_normal(prepared, hit, *material.normal_map, texcoord, trace),
                       fallback);
    }
    const glm::dvec3 vector = vector_tangent(prepared, material, texcoord, trace);
    if (holds_nothing(vector)) return fallback;
    const Basis basis = material.tangent_frame == TangentFrame::derivatives
                            ? derived_basis(triangle, normal)
                            : stored_basis(triangle, normal);
    return unit_or(vector.x * basis.tangent + vector.y * basis.bitangent + vector.z * basis.normal,
                   fallback);
}

/// What needs no material.
Surface attributes_at(const PreparedScene& prepared, const Hit& hit) {
    const Triangle triangle = triangle_of(prepared, hit);
    const Mesh& mesh = *triangle.instance.mesh;
    Surface surface;
    surface.position_world = triangle.interpolated(triangle.instance.positions_world);
    surface.has_texcoord = !mesh.texcoords.empty();
    if (surface.has_texcoord) {
        surface.texcoord = triangle.interpolated_as<glm::dvec2>(mesh.texcoords);
    }
    if (!mesh.colors.empty()) surface.color = triangle.interpolated_as<glm::dvec4>(mesh.colors);
    return surface;
}

void face_viewer(const PreparedScene& prepared, const Hit& hit, Surface& surface) {
    if (is_back(prepared, hit)) surface.normal_world = -surface.normal_world;
    surface.view_world = unit_or(prepared.eye_world - surface.position_world, surface.normal_world);
}

}  // namespace

bool is_back(const PreparedScene& prepared, const Hit& hit) {
    return hit.counter_clockwise == prepared.instances[hit.instance].mirrors;
}

Surface surface_at(const PreparedScene& prepared, const Hit& hit, const Material& material,
                   Trace& trace) {
    Surface surface = attributes_at(prepared, hit);
    surface.normal_world = front_normal(prepared, hit, material, surface.texcoord, trace);
    face_viewer(prepared, hit, surface);
    return surface;
}

Surface surface_at_corner(const PreparedScene& prepared, const Hit& hit, int corner) {
    Hit at_corner = hit;
    at_corner.barycentric = glm::dvec3(0.0);
    at_corner.barycentric[corner] = 1.0;
    Surface surface = attributes_at(prepared, at_corner);
    const Triangle triangle = triangle_of(prepared, at_corner);
    surface.normal_world = unit_or(triangle.interpolated(triangle.instance.normals_world), z_axis);
    face_viewer(prepared, at_corner, surface);
    return surface;
}

}  // namespace relief::reference
