// SPDX-License-Identifier: Apache-2.0
/// \file
/// Rows of the catalogue whose input is a mesh, and what can be expected of them.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hard_cases/hard_case.h"
#include "relief/mesh/diagnose.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"

namespace relief::test {

/// How often a finding is reported, by its kind.
using Findings = std::vector<std::pair<std::string, std::size_t>>;

/// The true normal at a vertex of the mesh, where there is one.
using TrueNormal = std::function<std::optional<glm::dvec3>(const Mesh& mesh, std::size_t vertex)>;

/// The true normal of a level plane, seen from above.
inline std::optional<glm::dvec3> facing_up(const Mesh&, std::size_t) {
    return glm::dvec3(0, 0, 1);
}

/// The true tangent at a corner of the mesh, where there is one; w 0: either.
using TrueTangent = std::function<std::optional<glm::dvec4>(const Mesh& mesh, std::size_t corner)>;

/// A call that gives every corner a tangent.
struct TangentMethod {
    std::string name;  ///< As options call it.
    std::vector<glm::vec4> (*call)(std::span<const glm::vec3>, std::span<const glm::vec3>,
                                   std::span<const glm::vec2>, std::span<const glm::uvec3>,
                                   Report&);
};

/// Builds a row: MeshCase(...).checked(...).normals(...).
class MeshCase {
  public:
    MeshCase(std::string name, std::string what, std::string source, std::function<Mesh()> make);

    /// diagnose() finds exactly this, whatever the order of triangles.
    MeshCase& checked(const std::vector<std::pair<MeshCondition, std::size_t>>& found);

    /// vertex_normals() with every weighting gives finite unit normals, the same bits for another
    /// order of triangles, and reports exactly this.
    MeshCase& normals(const Findings& findings = {});

    /// The same for some weightings; `step` says which: "normals, uniform".
    MeshCase& normals_by(const std::string& step, const std::vector<NormalWeight>& weights,
                         const Findings& findings);

    /// Normals by these weightings are within so many degrees of the truth; 0: exactly there.
    MeshCase& accurate(const std::vector<NormalWeight>& weights, double degrees,
                       const std::string& truth_text, const TrueNormal& ground_truth);

    /// Every method keeps the invariant (support/tangent_invariant.h), gives the same bits for
    /// other orders of triangles, and reports exactly this. A mesh without texture is seen from
    /// above (textured_from_above).
    MeshCase& tangents(const Findings& findings = {});

    /// The same for some methods; `step` says which.
    MeshCase& tangents_by(const std::string& step, const std::vector<TangentMethod>& methods,
                          const Findings& findings);

    /// Tangents by every method are within so many degrees of the truth, with its w; 0: exactly
    /// there.
    MeshCase& tangents_near(double degrees, const std::string& truth_text,
                            const TrueTangent& ground_truth);

    /// Anything else: the outcome in words, and a function of the mesh that says what is wrong.
    MeshCase& expect(const std::string& step, const std::string& outcome,
                     const std::function<std::string(const Mesh&)>& problem);

    operator HardCase() const { return row_; }

  private:
    HardCase row_;
    std::function<Mesh()> make_;
};

/// The methods that every row of `tangents` runs through.
const std::vector<TangentMethod>& all_tangent_methods();

/// The weightings that every row of `normals` runs through.
const std::vector<NormalWeight>& all_weights();

}  // namespace relief::test
