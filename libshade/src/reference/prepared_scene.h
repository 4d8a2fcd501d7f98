// SPDX-License-Identifier: Apache-2.0
/// \file
/// A scene with everything worked out that no single pixel decides: frames where meshes lack them,
/// vertices in world and view space, decoded textures. In double; directions are unit or, where
/// there is none, zero. Tests: tests/shade/reference/reference_test.cpp.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "reference/environment_lookup.h"
#include "reference/texels.h"
#include "relief/mesh/report.h"
#include "relief/shade/scene.h"

namespace relief::reference {

/// One instance of a mesh, by vertex.
struct PreparedInstance {
    const Mesh* mesh = nullptr;  ///< With normals, and with tangents where something asks for them.
    std::vector<glm::dvec3> positions_world;
    std::vector<glm::dvec3> positions_view;
    std::vector<glm::dvec3> normals_world;
    std::vector<glm::dvec4> tangents_world;    ///< Empty where the mesh has none.
    glm::dmat3 world_from_object_normal{1.0};  ///< Up to a positive factor.
    bool mirrors = false;                      ///< The matrix turns triangles' windings round.
};

struct PreparedScene {
    /// \throws InvalidInput, FileError as render_reference does
    PreparedScene(const Scene& scene, Report& report);

    [[nodiscard]] const Material& material_of(std::uint32_t instance, std::uint32_t triangle) const;
    /// The range's place in its mesh.
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

}  // namespace relief::reference
