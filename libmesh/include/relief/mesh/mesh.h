// SPDX-License-Identifier: Apache-2.0
/// \file
/// Indexed triangle meshes in plain arrays, in the layout of GPU buffers.
///
/// Right-handed object space, any unit of length; triangles are counter-clockwise seen from
/// outside. Texture coordinates are those of glTF: (0,0) is the upper left corner of the stored
/// image, and v points down.
/// Tests: tests/mesh/geometry/mesh_test.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "relief/export.h"

namespace RELIEF_API relief {

/// A range of triangles with the same material.
struct MaterialRange {
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
    /// Index into the materials that were read with the mesh.
    std::optional<std::uint32_t> material;

    friend bool operator==(const MaterialRange&, const MaterialRange&) = default;
};

/// Triangles and vertex attributes.
///
/// Every vertex array is empty (the attribute is absent) or has the length of `positions`. Vertices
/// with equal positions but different other attributes (at a texture seam or a crease) are separate
/// entries.
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;  ///< Object space.
    std::vector<glm::vec3> normals;    ///< Object space, unit.
    std::vector<glm::vec2> texcoords;  ///< Upper left origin, v down.
    /// Object space: xyz is unit and perpendicular to the normal, w is +1 or -1. The bitangent
    /// w * cross(normal, xyz) points towards decreasing v: up in the stored image.
    std::vector<glm::vec4> tangents;
    std::vector<glm::vec4> colors;      ///< Linear RGB and coverage, usually within [0,1].
    std::vector<glm::uvec3> triangles;  ///< Vertex indices.
    /// Disjoint and ascending ranges that cover all triangles; or empty, which means one range
    /// without a material.
    std::vector<MaterialRange> material_ranges;
    /// The smoothing groups of OBJ, one for each triangle, or empty. Edges between triangles of
    /// different groups are hard, and so are all edges of group 0. They affect the computation of
    /// normals, not stored normals.
    std::vector<std::uint32_t> smoothing_groups;
    /// A second set of texture coordinates, at which materials of a scene may look up textures.
    /// Mesh files are read and written without it.
    std::vector<glm::vec2> texcoords_2;
};

/// An axis-aligned box; empty (min > max) by default.
struct Bounds {
    glm::vec3 min{std::numeric_limits<float>::infinity()};
    glm::vec3 max{-std::numeric_limits<float>::infinity()};

    [[nodiscard]] bool empty() const { return !(min.x <= max.x); }
};

/// Returns the bounding box of all finite positions; empty if there is none.
Bounds bounds_of(const Mesh& mesh);

/// Checks that array lengths agree, every index names a vertex, and the material ranges are as
/// documented in `Mesh`. Values may be degenerate or non-finite.
///
/// \throws InvalidInput naming the first error: "triangle 7 names vertex 12, but there are only 8"
void validate(const Mesh& mesh);

/// Extracts triangles in the given order, with their smoothing groups and materials, and the
/// vertices that they use, in their order and with all attributes. The name is kept.
/// \throws InvalidInput if there is no such triangle, or the mesh is not valid
Mesh part_of(const Mesh& mesh, std::span<const std::uint32_t> triangles);

/// Transforms the positions, normals and tangents of a mesh.
///
/// \param world_from_object  affine; computed in double precision
/// \return a mesh whose normals are transformed by the inverse transpose and normalized, and whose
///         tangents are transformed and normalized, but not made perpendicular again (after a shear
///         they lean). If the transform mirrors, the winding of triangles is reversed, so that they
///         stay counter-clockwise, and the w of tangents is negated, so that bitangents still point
///         up in the image. A direction that would become zero does not change
Mesh transformed(Mesh mesh, const glm::mat4& world_from_object);

/// KHR_texture_transform: texture coordinates are scaled, then rotated, then shifted.
struct GltfTextureTransform {
    glm::vec2 offset{0.0F};
    float rotation = 0.0F;  ///< Radians; the image rotates clockwise.
    glm::vec2 scale{1.0F};

    friend bool operator==(const GltfTextureTransform&, const GltfTextureTransform&) = default;
};

/// Returns the coordinates at which the image is sampled. Both have v downwards.
glm::vec2 transformed(const GltfTextureTransform& transform, const glm::vec2& texcoord);

/// Returns the tangent for transformed texture coordinates, computed from that for the original
/// ones. Both belong to the frames in which a renderer reads a normal map with transformed
/// coordinates.
///
/// \param tangent  unit, w = +1 or -1, with its unit normal, as in Mesh
/// \return the tangent rotated in the plane of the normal, with w negated if the transform mirrors.
///         It is exact if the image lies on the surface without distortion, or if axes are only
///         scaled and mirrored. A transform that reduces the image to a line or a point does not
///         change the tangent
glm::vec4 transformed(const GltfTextureTransform& transform, const glm::vec4& tangent,
                      const glm::vec3& normal);

/// Creates the square from -1 to 1 in the xy plane, facing +z, with cells x cells cells; the image
/// is upright. \throws InvalidInput unless there are 1 to 4096 cells
Mesh make_quad(int cells = 1);

/// Creates the unit sphere by longitude and latitude: u runs eastwards from +z, v down from the
/// north pole (+y), with a seam and two poles. Normals equal positions.
/// \throws InvalidInput unless slices are 3 to 4096 and stacks 2 to 4096
Mesh make_sphere(int slices = 64, int stacks = 32);

/// Creates the cube from -1 to 1 with 24 vertices: every face has its own four, with its normal and
/// the whole image upright.
Mesh make_cube();

/// Creates a torus about the y axis whose tube is centered at distance 1: u runs along the tube
/// eastwards from +z, v around the tube from its inner side over the top. \throws InvalidInput
/// unless tube_radius is within (0, 1], and slices and sides are 3 to 4096
Mesh make_torus(float tube_radius = 0.4F, int slices = 96, int sides = 48);

/// Creates a closed cylinder about the y axis with radius 1, from y = -1 to 1: u runs eastwards
/// from +z, v down from the upper rim. The caps show the image upright, with +x to the right.
/// \throws InvalidInput unless slices are 3 to 4096
Mesh make_cylinder(int slices = 64);

/// Describes in a few numbers how joints and morph targets move the vertices of a mesh.
///
/// Each array is empty or has the length of `positions`. The numbers are linear in the weights of
/// joints and in the displacements. If there are more joints or targets than numbers, they are
/// projections, whose squared differences between vertices are about those of the weights and of
/// the displacements.
struct Deformation {
    std::vector<glm::vec4> joints;
    /// Object space.
    std::array<std::vector<glm::vec3>, 3> displacements;
};

}  // namespace relief
