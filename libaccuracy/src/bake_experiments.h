// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on baking: a sphere with bumps in closed form is baked onto a coarse sphere with
/// several numbers of rays per texel and several bit depths.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "relief/accuracy/bake_accuracy.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/mesh.h"

namespace relief {

/// A point of a surface with its normal.
struct SurfacePoint {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0};  ///< Unit.
};

/// A sphere with bumps in closed form, and a mesh of it.
class BumpySphere {
  public:
    /// Makes a mesh of 4 stacks^2 triangles with the positions and normals of the formula.
    explicit BumpySphere(int stacks);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }

    /// Intersects a ray that points roughly towards the center with the exact surface.
    /// \param inward  unit
    [[nodiscard]] static SurfacePoint on_surface(const glm::dvec3& from, const glm::dvec3& inward);

    /// Intersects such a ray with the mesh, in double; the normal is interpolated. Only triangles
    /// near the exact intersection are tried.
    /// \throws std::logic_error if the ray hits none of them
    [[nodiscard]] SurfacePoint on_mesh(const glm::dvec3& from, const glm::dvec3& inward) const;

  private:
    int stacks_;
    Mesh mesh_;
};

std::string name_of(const BakeSampling& way);  ///< "16 rays", "up to 64 rays beyond 2°"

/// The high and the low mesh, ready for ray casting, and the ground truth of their map.
class BumpyBake {
  public:
    static constexpr int low_slices = 46;
    static constexpr int low_stacks = 23;

    /// \param side  width and height of the map in texels
    BumpyBake(int high_stacks, int side);

    [[nodiscard]] const Baker& baker() const { return baker_; }
    [[nodiscard]] const BakeMapOptions& map() const { return map_; }
    [[nodiscard]] const BakeReference& reference() const { return reference_; }
    [[nodiscard]] std::string description() const;  ///< Of the meshes and the map.
    [[nodiscard]] double texels() const;

    /// Bakes a map.
    [[nodiscard]] Image map_by(const BakeSampling& way, const NormalMapFormat& format) const;
    [[nodiscard]] const BumpySphere& high() const { return high_; }

  private:
    BumpySphere high_;
    Report report_;
    Baker baker_;
    BakeMapOptions map_;
    BakeReference reference_;
};

}  // namespace relief
