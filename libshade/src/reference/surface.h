// SPDX-License-Identifier: Apache-2.0
/// \file
/// A scene prepared for rays, and the surface at a hit. The preparation computes everything that no
/// single pixel decides: frames of meshes without frames, vertices in world and view space, decoded
/// textures. World space, in double. Directions are unit, or zero if undefined; the normal of a
/// surface without a direction is (0,0,1), and a map without a direction leaves the interpolated
/// normal.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "reference/lookups.h"
#include "reference/visibility.h"
#include "relief/export.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"

namespace relief {
namespace RELIEF_API reference {

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
    /// The index of the range in its mesh.
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

/// The surface at a corner of the triangle that was hit, for light computed at vertices. No map
/// bends its normal.
Surface surface_at_corner(const PreparedScene& prepared, const Hit& hit, int corner);

}  // namespace reference
}  // namespace relief
