// SPDX-License-Identifier: Apache-2.0
/// \file
/// The high-poly meshes of a bake: a ray scene, and the attributes at a hit (normal, color,
/// curvature, position, surface, emission, id). An attribute is prepared only if a layer needs it.
/// Tests: tests/mesh/bake/bake_test.cpp, high_materials_test.cpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bake/ray_scene.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"

namespace relief::detail {

/// Textures are decoded to linear values before they are filtered, in double, as OpenGL defines it
/// for the full-size level. A coordinate that is not finite reads the first texel.

/// Returns the linear RGB color of a texture.
glm::dvec3 color_at(const SurfaceTexture& texture, const glm::dvec2& texcoord);

/// Returns the normal of a normal map, y up, with x and y scaled; its length is arbitrary.
glm::dvec3 normal_at(const SurfaceNormalMap& map, const glm::dvec2& texcoord);

/// Returns the triangle rotated to begin with its first corner by position. Sums over corners in
/// this order are rounded independently of the given first corner.
glm::uvec3 from_first_position(std::span<const glm::vec3> positions, const glm::uvec3& triangle);

/// Checks the images, materials and texture coordinates of a high mesh.
/// \throws InvalidInput if an image is missing, empty or has too few channels, if the mesh names a
///         missing material, or if texture coordinates and vertices differ in number
void check(const HighMaterials& detail);

class HighSurface {
  public:
    /// The meshes and everything that the options refer to must outlive this object. Meshes without
    /// normals get averaged ones (frames.h). Meshes with normal maps but without tangents get
    /// MikkTSpace tangents. \throws InvalidInput if a mesh is not valid
    HighSurface(std::span<const Mesh> meshes, const BakeOptions& options, Report& report);

    [[nodiscard]] const RayScene& scene() const { return *scene_; }

    /// Returns the interpolated unit normal. If it has no direction, the result is the face normal,
    /// and is reported.
    [[nodiscard]] glm::dvec3 smooth_normal(const RayHit& hit, std::size_t sample,
                                           Report& report) const;

    /// Returns the smooth normal with the normal map applied, if a normal layer is requested.
    [[nodiscard]] glm::dvec3 normal(const RayHit& hit, std::size_t sample, Report& report) const;

    /// Returns the unit normal of the triangle.
    [[nodiscard]] glm::dvec3 face_normal(const RayHit& hit) const;

    [[nodiscard]] glm::dvec3 position(const RayHit& hit) const;

    /// Returns the interpolated mean curvature, positive where the surface is convex, if requested.
    [[nodiscard]] double curvature(const RayHit& hit) const;

    /// Returns the linear RGB color, white if the mesh has none, if requested.
    [[nodiscard]] glm::dvec3 color(const RayHit& hit) const;

    /// Returns the opacity, 1 for opaque materials, if requested.
    [[nodiscard]] double opacity(const RayHit& hit) const;

    /// Returns occlusion, roughness and metalness of the material, (1, 1, 0) without a material, if
    /// requested.
    [[nodiscard]] glm::dvec3 surface(const RayHit& hit) const;

    /// Returns the linear RGB emission, black without a material, if requested.
    [[nodiscard]] glm::dvec3 emission(const RayHit& hit) const;

    /// Adds the names of the ids of all meshes, if ids are requested.
    void add_names(std::vector<std::string>& names) const;

    /// Sets the numbers of the ids, which are needed before id().
    /// \param ids  sorted by name; all names are in it
    void number_ids(const std::vector<SurfaceId>& ids);

    /// Returns the number of the id.
    [[nodiscard]] std::uint32_t id(const RayHit& hit) const;

    /// Bounds of the absolute curvature over all meshes, if requested.
    struct CurvatureRange {
        double usual = 0.0;  ///< Holds on 99% of the area.
        double max = 0.0;
    };
    [[nodiscard]] CurvatureRange curvature_range() const;

    /// Returns the largest absolute coordinate of a position in other axes.
    [[nodiscard]] double largest_coordinate(const glm::dmat4& axes_from_mesh) const;

    /// Returns a bound of the emission in any channel.
    [[nodiscard]] double largest_emission() const;

  private:
    /// A mesh with its attributes.
    struct Entry {
        const Mesh* mesh = nullptr;
        std::vector<glm::uvec3> triangles;      ///< Those of the mesh, from_first_position().
        const HighMaterials* detail = nullptr;  ///< Null if no layer needs it.
        std::span<const glm::vec2> color_texcoords;
        std::vector<glm::vec2>
            split_texcoords;           ///< Storage of `color_texcoords` if vertices were split.
        std::vector<float> curvature;  ///< By vertex.
        std::vector<NamedTriangles> names;
        std::vector<std::uint32_t> ids;  ///< By the indices of `names`.
    };
    [[nodiscard]] Entry entry(const Mesh& mesh, std::size_t index, const BakeOptions& options,
                              Report& report);
    [[nodiscard]] std::uint32_t id_of(const Entry& entry, std::uint32_t triangle) const;
    [[nodiscard]] const HighMaterial* material(const RayHit& hit) const;
    [[nodiscard]] glm::dvec2 color_texcoord(const RayHit& hit) const;
    /// Returns the color of a texture at a hit; white without a texture or texture coordinates.
    [[nodiscard]] glm::dvec3 textured(const std::optional<SurfaceTexture>& texture,
                                      const RayHit& hit) const;
    /// All attributes of a triangle that a bake can read, independent of its first corner. They
    /// order triangles that coincide.
    [[nodiscard]] std::vector<std::uint32_t> attributes(const MetTriangle& met) const;

    std::vector<Mesh> made_;  ///< Meshes that got normals or tangents.
    std::vector<Entry> entries_;
    std::unique_ptr<RayScene> scene_;
};

}  // namespace relief::detail
