// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on vertex normals: every weighting on analytic surfaces and on the fans of [Max
/// 1999].
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiment_driver.h"
#include "relief/accuracy/ground_truth.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/statistics.h"

namespace relief {

/// One way to compute the vertex normals of a mesh.
struct NormalMethod {
    std::string weighting;  ///< The name in relief-mesh: "uniform", ..., "auto".
    Arithmetic arithmetic = Arithmetic::float64;
    std::optional<NormalWeight> weight{};  ///< Absent: chosen per vertex.
    /// Returns one normal per position.
    std::function<std::vector<glm::vec3>(const Mesh&)> normals;

    [[nodiscard]] std::string name() const;  ///< "max, float64"
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> choices() const;
};

/// All eight weightings, each in the given arithmetics.
std::vector<NormalMethod> normal_methods(std::span<const Arithmetic> arithmetics);

/// The angles between normals and those of the surface, at the inner vertices of the mesh.
/// \param normals  one per position of the mesh
ErrorStats normal_errors(std::span<const glm::vec3> normals, const AnalyticMesh& ground_truth);

/// The angles at the center vertices of random fans (cubic_fan() with seeds 0 to `fans` - 1).
ErrorStats fan_errors(const NormalMethod& method, int valence, std::uint32_t fans);

}  // namespace relief
