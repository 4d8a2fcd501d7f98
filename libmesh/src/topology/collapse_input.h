// SPDX-License-Identifier: Apache-2.0
/// \file
/// Prepares meshes for edge collapses (edge_collapse.h), one or several together.
///
/// Positions are scaled into [-1, 1] by a power of two, so the result does not depend on the unit
/// of length. Triangles are visited along a space-filling curve, with ties in the order of their
/// vertices' values, so the result does not depend on the order of triangles.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "geometry/corners.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/topology.h"
#include "topology/edge_collapse.h"
#include "topology/triangle_layers.h"

namespace relief::detail {

/// Maps object space to [-1, 1]; `scale` is the factor of lengths.
struct UnitSpace {
    glm::dvec3 center{0.0};
    double scale = 1.0;

    [[nodiscard]] glm::dvec3 operator()(const glm::vec3& position) const {
        return (glm::dvec3(position) - center) * scale;
    }
};

UnitSpace unit_space(const Mesh& mesh);

/// The index of the material range of each triangle; empty if there is at most one.
struct Parts {
    std::vector<std::uint32_t> of_triangle;

    [[nodiscard]] std::uint32_t operator[](std::size_t triangle) const {
        return of_triangle.empty() ? 0 : of_triangle[triangle];
    }
};

Parts parts_of(const Mesh& mesh);

/// A mesh with the attributes that make seams where they differ.
struct AttributedMesh {
    const Mesh& mesh;
    const Deformation& deformation;
    bool with_normals = false;

    [[nodiscard]] std::strong_ordering compare_attributes(std::uint32_t a, std::uint32_t b) const;
};

/// Returns the corner of a triangle with the first position by value. All computations begin there,
/// because their rounding depends on the first corner.
Corner first_corner(const Mesh& mesh, std::uint32_t triangle);

/// The surface of a mesh for edge collapses, and the way back from it.
struct PreparedMesh {
    CollapseInput input;
    std::vector<std::uint32_t> sources;  ///< For each triangle of the surface, that of the mesh.
    std::vector<std::uint32_t> set_aside;
    /// Their vertices; of equal ones, that of the wedge.
    std::vector<glm::uvec3> set_aside_triangles;
    std::vector<std::uint32_t> vertex_of_wedge;
    /// Triangles of the mesh at the positions of others, which become what those become.
    TriangleLayers layers;
    LayeredWedges layered_wedges;  ///< Empty if there are no layers.
};

/// \param weights  instead of those of the options
/// \param smallest_part  connected parts whose bounding box has a shorter diagonal, in object
///         space, are left out, and counted in the report
PreparedMesh prepared(const AttributedMesh& surface, const DecimateOptions& options,
                      const AttributeWeights& weights, double smallest_part, Report& report);

/// Several surfaces as one, whose edges share an order of collapses.
class JoinedSurfaces {
  public:
    /// Consumes the inputs of the meshes, but not the ways back.
    /// \param factors  for each mesh: the length that one of its units has in the joined surface
    JoinedSurfaces(std::span<PreparedMesh> meshes, std::span<const double> factors);

    /// Returns the joined input without limits.
    [[nodiscard]] CollapseInput take() { return std::move(joined_); }

    /// Separates a result into those of the meshes.
    [[nodiscard]] std::vector<Collapsed> separated(const Collapsed& all) const;

  private:
    /// The first triangle and wedge of a mesh, and the way back to its object space.
    struct Place {
        std::uint32_t first_triangle = 0;
        std::uint32_t first_wedge = 0;
        glm::dvec3 center{0.0};
        double scale = 1.0;
    };

    CollapseInput joined_;
    std::vector<Place> places_;
};

}  // namespace relief::detail
