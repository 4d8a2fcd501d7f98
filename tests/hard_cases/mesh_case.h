// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rows of the catalogue whose input is a mesh, their possible expectations, and textured meshes.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hard_cases/hard_cases.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/tangents.h"

namespace relief::test {

/// The expected count of each kind of finding.
using Findings = std::vector<std::pair<std::string, std::size_t>>;

/// Returns the reference normal at a vertex of the mesh, if it has one.
using ReferenceNormal =
    std::function<std::optional<glm::dvec3>(const Mesh& mesh, std::size_t vertex)>;

/// The reference normal of a horizontal plane that faces +z.
inline std::optional<glm::dvec3> facing_up(const Mesh&, std::size_t) {
    return glm::dvec3(0, 0, 1);
}

/// Returns the reference tangent at a corner of the mesh, if it has one. With w = 0, both signs are
/// correct.
using ReferenceTangent =
    std::function<std::optional<glm::dvec4>(const Mesh& mesh, std::size_t corner)>;

/// A function that computes a tangent for every corner.
struct NamedTangentMethod {
    std::string name;  ///< The name that options use.
    decltype(&mikktspace_tangents) call;
};

/// Builds a row: MeshCase(...).checked(...).normals(...).
class MeshCase {
  public:
    MeshCase(std::string name, std::string what, std::string source, std::function<Mesh()> make);

    /// diagnose() reports exactly these conditions for every order of triangles.
    MeshCase& checked(const std::vector<std::pair<MeshCondition, std::size_t>>& found);

    /// vertex_normals() with every weighting returns finite unit normals with the same bits for
    /// another order of triangles, and reports exactly these findings.
    MeshCase& normals(const Findings& findings = {});

    /// Like normals(), for some weightings; `step` names them: "normals, uniform".
    MeshCase& normals_by(const std::string& step, const std::vector<NormalWeight>& weights,
                         const Findings& findings);

    /// The normals of these weightings have an error of at most `degrees`; 0 requires equality.
    MeshCase& accurate(const std::vector<NormalWeight>& weights, double degrees,
                       const std::string& reference_name, const ReferenceNormal& reference);

    /// Every method keeps the invariants (support/invariants.h), gives the same bits for other
    /// orders of triangles, and reports exactly these findings. A mesh without texture coordinates
    /// gets those of textured_from_above().
    MeshCase& tangents(const Findings& findings = {});

    /// Like tangents(), for some methods; `step` names them.
    MeshCase& tangents_by(const std::string& step, const std::vector<NamedTangentMethod>& methods,
                          const Findings& findings);

    /// The tangents of every method have an error of at most `degrees` and the sign w of the
    /// reference; 0 requires equality.
    MeshCase& tangents_near(double degrees, const std::string& reference_name,
                            const ReferenceTangent& reference);

    /// Adds another expectation: the outcome in words, and a function that returns the problem of a
    /// mesh.
    MeshCase& expect(const std::string& step, const std::string& outcome,
                     const std::function<std::string(const Mesh&)>& problem);

    operator HardCase() const { return row_; }

  private:
    HardCase row_;
    std::function<Mesh()> make_;
};

/// The methods that tangents() tests.
const std::vector<NamedTangentMethod>& all_tangent_methods();

/// The weightings that normals() tests.
const std::vector<NormalWeight>& all_weights();

/// A torus of 576 triangles with a texture seam.
Mesh textured_torus();

/// A flat grid of 4 x 4 cells that faces +z, with an upright image.
Mesh textured_grid();

/// A wavy grid whose texture coordinates are multiples of 1/16.
Mesh coarsely_textured();

/// Computes the tangents of a method and discards its findings.
std::vector<glm::vec4> tangents_of(const Mesh& mesh, const NamedTangentMethod& method);

/// Returns the mesh after a call of change(mesh, v) for every vertex v.
template <typename Change>
Mesh changed(Mesh mesh, const Change& change) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        change(mesh, v);
    return mesh;
}

}  // namespace relief::test
