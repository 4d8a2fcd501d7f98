// SPDX-License-Identifier: Apache-2.0
/// \file
/// The triangles that a ray from the eye hits, with exact positions. View space: the eye is at the
/// origin and looks along -z. The rules of bake/embree_scene.h make the result the same on every
/// processor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "relief/export.h"

namespace RELIEF_API relief {
class EmbreeScene;
}

namespace relief {
namespace RELIEF_API reference {

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

    /// All hits of the ray through (x, y, -1), nearest first. If the ray hits an edge or a vertex
    /// that triangles of an instance share, only the nearest of them is a hit; ties: the first one.
    [[nodiscard]] std::vector<Hit> hits(double x, double y) const;

  private:
    [[nodiscard]] bool shares_place(const Hit& a, const Hit& b) const;
    [[nodiscard]] bool is_repeated(const std::vector<Hit>& all, std::size_t index) const;

    std::vector<ViewMesh> meshes_;
    double near_;
    double far_;
    std::unique_ptr<EmbreeScene> embree_;
};

}  // namespace reference
}  // namespace relief
