// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rays from the eye, a scene prepared for them, and the surface at a hit.
///
/// Hits have exact positions in view space: the eye is at the origin and looks along -z. The rules
/// of bake/embree_scene.h make the result the same on every processor. The preparation computes
/// everything that no single pixel decides: frames of meshes without frames, vertices in world and
/// view space, decoded textures. Surfaces are in world space, in double. Directions are unit, or
/// zero if undefined; the normal of a surface without a direction is (0,0,1), and a map without a
/// direction leaves the interpolated normal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "reference/lookups.h"
#include "relief/export.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"

namespace RELIEF_API relief {
class EmbreeScene;
}

namespace relief {
namespace RELIEF_API reference {

// Rays from the eye

/// Triangles of one instance; both spans must outlive their use.
struct ViewMesh {
    std::span<const glm::dvec3> positions_view;
    std::span<const glm::uvec3> triangles;
};

struct Hit {
    std::uint32_t instance = 0;
    std::uint32_t triangle = 0;
    double depth = 0.0;             ///< Distance along -z.
    glm::dvec3 barycentric{0.0};    ///< On the triangle itself, correct for perspective.
    bool counter_clockwise = true;  ///< As the eye sees it.
};

class Visibility {
  public:
    /// \param near, far  the depth range of hits
    Visibility(std::vector<ViewMesh> meshes, double near, double far);
    ~Visibility();
    Visibility(const Visibility&) = delete;
    Visibility& operator=(const Visibility&) = delete;

    /// Returns all hits of the ray through (x, y, -1), nearest first. If the ray hits an edge or a
    /// vertex that triangles of an instance share, only the nearest of them is a hit; ties: the
    /// first one.
    [[nodiscard]] std::vector<Hit> hits(double x, double y) const;

  private:
    [[nodiscard]] bool shares_place(const Hit& a, const Hit& b) const;
    [[nodiscard]] bool is_repeated(const std::vector<Hit>& all, std::size_t index) const;

    std::vector<ViewMesh> meshes_;
    double near_;
    double far_;
    std::unique_ptr<EmbreeScene> embree_;
};

// Prepared scenes and surfaces

/// One instance of a mesh, by vertex.
struct PreparedInstance {
    const Mesh* mesh = nullptr;  ///< With normals, and with tangents if something needs them.
    std::vector<glm::dvec3> positions_world;
    std::vector<glm::dvec3> positions_view;
    std::vector<glm::dvec3> normals_world;
    std::vector<glm::dvec4> tangents_world;    ///< Empty if the mesh has none.
    glm::dmat3 world_from_object_normal{1.0};  ///< Up to a positive factor.
    bool mirrors = false;                      ///< The matrix reverses the winding of triangles.
};

struct PreparedScene {
    /// \throws InvalidInput, FileError as render_reference does
    PreparedScene(const Scene& scene, Report& report);

    [[nodiscard]] const Material& material_of(std::uint32_t instance, std::uint32_t triangle) const;
    /// Returns the index of the range in its mesh.
    [[nodiscard]] std::size_t range_of(std::uint32_t instance, std::uint32_t triangle) const;
    [[nodiscard]] FlatCode flat_code(const NormalMap& map) const;

    const Scene& scene;
    std::vector<Material> materials;  ///< Without the textures that cannot be read.
    glm::dvec3 eye_world;
    std::vector<Mesh> meshes;
    std::vector<PreparedInstance> instances;
    SceneTexels texels;
    std::map<std::size_t, FlatCode> detected_flat_codes;  ///< By image.
    std::map<std::size_t, int> normal_map_bits;           ///< By image.
    std::optional<EnvironmentLookup> environment;
};

/// Interpolated attributes at a hit, and the normal: interpolated or of the plane, bent by a normal
/// or bump map.
struct Surface {
    glm::dvec3 position_world{0.0};
    glm::dvec3 normal_world{0.0, 0.0, 1.0};  ///< Unit, on the visible side.
    glm::dvec3 view_world{0.0, 0.0,
                          1.0};  ///< Unit, to the eye; the normal if the eye is at the surface.
    glm::dvec2 texcoord{0.0};
    glm::dvec4 color{1.0};      ///< Interpolated vertex color.
    bool has_texcoord = false;  ///< Without them, no texture is looked up.
};

/// Tells whether the hit shows the back of its triangle.
bool is_back(const PreparedScene& prepared, const Hit& hit);

Surface surface_at(const PreparedScene& prepared, const Hit& hit, const Material& material,
                   Trace& trace);

/// Returns the surface at a corner of the triangle that was hit, for light computed at vertices. No
/// map bends its normal.
Surface surface_at_corner(const PreparedScene& prepared, const Hit& hit, int corner);

}  // namespace reference
}  // namespace relief
