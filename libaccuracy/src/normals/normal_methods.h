// SPDX-License-Identifier: Apache-2.0
/// \file
/// Every way that relief has of getting vertex normals, and how far they are from the truth; what
/// the experiments and the tables of docs/normals.md measure.
/// Tests: tests/accuracy/normal_methods_test.cpp.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "relief/mesh/analytic_surfaces.h"
#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/arithmetic.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"

namespace relief {

/// One way of getting a mesh's vertex normals.
struct NormalMethod {
    std::string weighting;  ///< "uniform", ..., "auto": the words of relief-mesh.
    Arithmetic arithmetic = Arithmetic::float64;
    std::optional<NormalWeight> weight{};  ///< Absent: chosen by vertex.
    /// One for each position.
    std::function<std::vector<glm::vec3>(const Mesh&)> normals;

    [[nodiscard]] std::string name() const;  ///< "max, float64"
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> choices() const;
};

/// All eight weightings in these arithmetics, by weighting.
std::vector<NormalMethod> normal_methods(std::span<const Arithmetic> arithmetics);

/// How far normals are from those of the surface, at its inner vertices.
/// \param normals  one for each position of the mesh
AngleDistribution normal_errors(std::span<const glm::vec3> normals, const AnalyticMesh& truth);

/// The errors of a method at the vertices in the middle of random fans (cubic_fan()) of seeds 0, 1,
/// ...
AngleDistribution fan_errors(const NormalMethod& method, int valence, std::uint32_t fans);

}  // namespace relief
