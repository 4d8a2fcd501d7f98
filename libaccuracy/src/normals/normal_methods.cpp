// SPDX-License-Identifier: Apache-2.0
// Vertices are welded as the tools do it; angles are compared in double. Tests:
// tests/accuracy/normal_methods_test.cpp.
#include "normals/normal_methods.h"

#include "analytic_words.h"
#include "relief/mesh/direction_error.h"

namespace relief {
namespace {

NormalMethod weighted(std::string weighting, NormalWeight weight, Arithmetic arithmetic) {
    return {std::move(weighting), arithmetic, weight, [weight, arithmetic](const Mesh& mesh) {
                Report report;
                NormalOptions options;
                options.weight = weight;
                options.arithmetic = arithmetic;
                return vertex_normals(mesh.positions, mesh.triangles, options, report);
            }};
}

NormalMethod chosen(Arithmetic arithmetic) {
    return {"auto", arithmetic, std::nullopt, [arithmetic](const Mesh& mesh) {
                Report report;
                NormalOptions options;
                options.arithmetic = arithmetic;
                return chosen_normals(mesh.positions, mesh.triangles, options, report).normals;
            }};
}

}  // namespace

std::string NormalMethod::name() const {
    return weighting + ", " + word_of(arithmetic);
}

std::vector<std::pair<std::string, std::string>> NormalMethod::choices() const {
    return {{"weighting", weighting}, {"arithmetic", word_of(arithmetic)}};
}

std::vector<NormalMethod> normal_methods(std::span<const Arithmetic> arithmetics) {
    using enum NormalWeight;
    std::vector<NormalMethod> methods;
    for (const auto& [word, weight] :
         {std::pair("uniform", uniform), std::pair("area", area), std::pair("angle", angle),
          std::pair("sine", sine), std::pair("max", max), std::pair("angle-edges", angle_edges),
          std::pair("area-angle", area_angle)}) {
        for (const Arithmetic arithmetic : arithmetics)
            methods.push_back(weighted(word, weight, arithmetic));
    }
    for (const Arithmetic arithmetic : arithmetics)
        methods.push_back(chosen(arithmetic));
    return methods;
}

AngleDistribution normal_errors(std::span<const glm::vec3> normals, const AnalyticMesh& truth) {
    std::vector<float> degrees;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        if (truth.inner[v] == 0) continue;
        degrees.push_back(
            static_cast<float>(degrees_between(glm::dvec3(normals[v]), truth.normals[v])));
    }
    return angle_distribution(std::move(degrees));
}

AngleDistribution fan_errors(const NormalMethod& method, int valence, std::uint32_t fans) {
    constexpr glm::dvec3 up(0.0, 0.0, 1.0);
    std::vector<float> degrees;
    for (std::uint32_t seed = 0; seed < fans; ++seed) {
        const std::vector<glm::vec3> normals = method.normals(cubic_fan(valence, seed));
        degrees.push_back(static_cast<float>(degrees_between(glm::dvec3(normals.front()), up)));
    }
    return angle_distribution(std::move(degrees));
}

}  // namespace relief
