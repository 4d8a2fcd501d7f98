// SPDX-License-Identifier: Apache-2.0
#include "hard_cases/mesh_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "hard_cases/counted_findings.h"
#include "support/angle.h"

namespace relief::test {
namespace {

// Rounding of a unit vector to floats.
constexpr double unit_tolerance = 1e-6;

/// The mesh with its triangles in reverse order, and every triangle begun at another corner.
Mesh reordered(Mesh mesh) {
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    for (glm::uvec3& triangle : mesh.triangles)
        triangle = {triangle.y, triangle.z, triangle.x};
    return mesh;
}

std::string not_unit(const std::vector<glm::vec3>& normals) {
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const double length = glm::length(glm::dvec3(normals[v]));
        if (!(std::abs(length - 1.0) <= unit_tolerance))
            return fmt::format("the normal of vertex {} has length {}", v, length);
    }
    return "";
}

std::string wrong_normals(const Mesh& mesh, NormalWeight weight,
                          const std::map<std::string, std::size_t>& expected) {
    Report report;
    const std::vector<glm::vec3> normals =
        vertex_normals(mesh.positions, mesh.triangles, weight, report);
    if (normals.size() != mesh.positions.size()) return "not one normal per vertex";
    if (const std::string problem = not_unit(normals); !problem.empty()) return problem;
    if (counts_of(report) != expected) return "reports " + as_text(counts_of(report));
    Report ignored;
    const Mesh other = reordered(mesh);
    const std::vector<glm::vec3> again =
        vertex_normals(other.positions, other.triangles, weight, ignored);
    if (!normals.empty() &&
        std::memcmp(normals.data(), again.data(), normals.size() * sizeof(glm::vec3)) != 0)
        return "other bits for another order of triangles";
    return "";
}

std::string inaccurate(const Mesh& mesh, NormalWeight weight, double degrees,
                       const TrueNormal& ground_truth) {
    Report report;
    const std::vector<glm::vec3> normals =
        vertex_normals(mesh.positions, mesh.triangles, weight, report);
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const std::optional<glm::dvec3> expected = ground_truth(mesh, v);
        if (!expected) continue;
        const double error = degrees_between(glm::dvec3(normals[v]), *expected);
        if (!(error <= degrees)) return fmt::format("vertex {} is {} degrees off", v, error);
    }
    return "";
}

}  // namespace

const std::vector<NormalWeight>& all_weights() {
    static const std::vector<NormalWeight> weights = {
        NormalWeight::uniform,   NormalWeight::area, NormalWeight::angle,
        NormalWeight::sine,      NormalWeight::max,  NormalWeight::angle_edges,
        NormalWeight::area_angle};
    return weights;
}

MeshCase::MeshCase(std::string name, std::string what, std::string source,
                   std::function<Mesh()> make)
    : row_{std::move(name), std::move(what), std::move(source), {}}, make_(std::move(make)) {}

MeshCase& MeshCase::checked(const std::vector<std::pair<MeshCondition, std::size_t>>& found) {
    std::map<std::string, std::size_t> expected;
    std::string outcome;
    for (const auto& [condition, count] : found) {
        const std::string word(condition_info(condition).word);
        expected[word] = count;
        outcome += fmt::format("{}{} x {}", outcome.empty() ? "" : ", ", count, word);
    }
    return expect("check", outcome.empty() ? "nothing" : outcome, [expected](const Mesh& mesh) {
        for (const Mesh& one : {mesh, reordered(mesh)}) {
            const auto counts = counts_of(to_report(diagnose(one)));
            if (counts != expected) return "finds " + as_text(counts);
        }
        return std::string();
    });
}

MeshCase& MeshCase::normals(const Findings& findings) {
    return normals_by("normals", all_weights(), findings);
}

MeshCase& MeshCase::normals_by(const std::string& step, const std::vector<NormalWeight>& weights,
                               const Findings& findings) {
    const std::map<std::string, std::size_t> expected(findings.begin(), findings.end());
    return expect(step, "unit" + reported(findings), [weights, expected](const Mesh& mesh) {
        for (const NormalWeight weight : weights) {
            if (std::string problem = wrong_normals(mesh, weight, expected); !problem.empty())
                return fmt::format("weight {}: {}", static_cast<int>(weight), problem);
        }
        return std::string();
    });
}

MeshCase& MeshCase::accurate(const std::vector<NormalWeight>& weights, double degrees,
                             const std::string& truth_text, const TrueNormal& ground_truth) {
    const std::string outcome = degrees == 0.0
                                    ? "exactly " + truth_text
                                    : fmt::format("within {} degrees of {}", degrees, truth_text);
    return expect("normals", outcome, [weights, degrees, ground_truth](const Mesh& mesh) {
        for (const NormalWeight weight : weights) {
            if (std::string problem = inaccurate(mesh, weight, degrees, ground_truth);
                !problem.empty())
                return fmt::format("weight {}: {}", static_cast<int>(weight), problem);
        }
        return std::string();
    });
}

MeshCase& MeshCase::expect(const std::string& step, const std::string& outcome,
                           const std::function<std::string(const Mesh&)>& problem) {
    row_.expectations.push_back(
        {step, outcome, [make = make_, problem] { return problem(make()); }});
    return *this;
}

}  // namespace relief::test
