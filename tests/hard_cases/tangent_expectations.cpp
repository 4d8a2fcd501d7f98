// SPDX-License-Identifier: Apache-2.0
// What a row can expect of tangents. Tests: hard_cases_test.cpp.
#include <fmt/format.h>

#include "hard_cases/counted_findings.h"
#include "hard_cases/mesh_case.h"
#include "hard_cases/sample_meshes.h"
#include "relief/mesh/tangents.h"
#include "support/angle.h"
#include "support/tangent_invariant.h"
#include "support/triangle_orders.h"

namespace relief::test {
namespace {

std::vector<glm::vec4> tangents_of(const Mesh& mesh, const TangentMethod& method, Report& report) {
    return method.call(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report);
}

Mesh textured(const Mesh& mesh) {
    return mesh.texcoords.empty() ? textured_from_above(mesh) : mesh;
}

std::string wrong_tangents(const Mesh& mesh, const TangentMethod& method,
                           const std::map<std::string, std::size_t>& expected) {
    Report report;
    const std::vector<glm::vec4> tangents = tangents_of(mesh, method, report);
    if (const std::string problem = broken_tangents(mesh, tangents); !problem.empty())
        return problem;
    if (counts_of(report) != expected) return "reports " + as_text(counts_of(report));
    const std::size_t count = mesh.triangles.size();
    for (const auto& order : {reversed(count), shuffled(count)}) {
        Report other;
        const auto again = tangents_of(with_triangle_order(mesh, order), method, other);
        if (!same_bits(again, corners_in_order(tangents, order)))
            return "other bits for another order of triangles";
        if (counts_of(other) != expected) return "reports differently for another order";
    }
    return "";
}

std::string too_far(const Mesh& mesh, const TangentMethod& method, double degrees,
                    const TrueTangent& ground_truth) {
    Report report;
    const std::vector<glm::vec4> tangents = tangents_of(mesh, method, report);
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const std::optional<glm::dvec4> expected = ground_truth(mesh, corner);
        if (!expected) continue;
        const glm::dvec4 tangent(tangents[corner]);
        const double error = degrees_between(glm::dvec3(tangent), glm::dvec3(*expected));
        if (!(error <= degrees)) return fmt::format("corner {} is {} degrees off", corner, error);
        if (expected->w != 0.0 && expected->w != tangent.w)
            return fmt::format("corner {} has w {}", corner, tangent.w);
    }
    return "";
}

/// What is wrong with any method.
template <typename Problem>
std::function<std::string(const Mesh&)> with_each(const std::vector<TangentMethod>& methods,
                                                  const Problem& problem) {
    return [methods, problem](const Mesh& bare) {
        const Mesh mesh = textured(bare);
        for (const TangentMethod& method : methods) {
            if (const std::string found = problem(mesh, method); !found.empty())
                return method.name + ": " + found;
        }
        return std::string();
    };
}

}  // namespace

const std::vector<TangentMethod>& all_tangent_methods() {
    static const std::vector<TangentMethod> methods = {{"mikktspace", mikktspace_tangents},
                                                       {"area-weighted", area_weighted_tangents},
                                                       {"lengyel", lengyel_tangents}};
    return methods;
}

MeshCase& MeshCase::tangents(const Findings& findings) {
    return tangents_by("tangents", all_tangent_methods(), findings);
}

MeshCase& MeshCase::tangents_by(const std::string& step, const std::vector<TangentMethod>& methods,
                                const Findings& findings) {
    const std::map<std::string, std::size_t> expected(findings.begin(), findings.end());
    return expect(step, "orthonormal" + reported(findings),
                  with_each(methods, [expected](const Mesh& mesh, const TangentMethod& method) {
                      return wrong_tangents(mesh, method, expected);
                  }));
}

MeshCase& MeshCase::tangents_near(double degrees, const std::string& truth_text,
                                  const TrueTangent& ground_truth) {
    const std::string outcome = degrees == 0.0
                                    ? "exactly " + truth_text
                                    : fmt::format("within {} degrees of {}", degrees, truth_text);
    return expect(
        "tangents", outcome,
        with_each(all_tangent_methods(), [=](const Mesh& mesh, const TangentMethod& method) {
            return too_far(mesh, method, degrees, ground_truth);
        }));
}

}  // namespace relief::test
