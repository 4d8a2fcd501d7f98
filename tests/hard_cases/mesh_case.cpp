// SPDX-License-Identifier: Apache-2.0
#include "hard_cases/mesh_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/mesh/tangents.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"

namespace relief::test {
namespace {

std::map<std::string, std::size_t> counts_of(const Report& report) {
    std::map<std::string, std::size_t> counts;
    for (const Finding& finding : report.findings())
        counts[finding.kind] = finding.count;
    return counts;
}

std::string as_text(const std::map<std::string, std::size_t>& counts) {
    std::string text;
    for (const auto& [kind, count] : counts)
        text += fmt::format("{}{} x {}", text.empty() ? "" : ", ", count, kind);
    return text.empty() ? "nothing" : text;
}

std::string reported(const std::vector<std::pair<std::string, std::size_t>>& findings) {
    std::string text;
    for (const auto& [kind, count] : findings)
        text += fmt::format("{} {} x {}", text.empty() ? "; reported:" : ",", count, kind);
    return text;
}

// The rounding error of a unit vector in floats.
constexpr double unit_tolerance = 1e-6;

/// Returns the mesh with its triangles in reverse order, each beginning at another corner.
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
                       const ReferenceNormal& reference) {
    Report report;
    const std::vector<glm::vec3> normals =
        vertex_normals(mesh.positions, mesh.triangles, weight, report);
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const std::optional<glm::dvec3> expected = reference(mesh, v);
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
    : row_{std::move(name), std::move(what), std::move(source), {}, make}, make_(std::move(make)) {}

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
                             const std::string& reference_name, const ReferenceNormal& reference) {
    const std::string outcome =
        degrees == 0.0 ? "exactly " + reference_name
                       : fmt::format("within {} degrees of {}", degrees, reference_name);
    return expect("normals", outcome, [weights, degrees, reference](const Mesh& mesh) {
        for (const NormalWeight weight : weights) {
            if (std::string problem = inaccurate(mesh, weight, degrees, reference);
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

namespace {

std::vector<glm::vec4> tangents_of(const Mesh& mesh, const NamedTangentMethod& method,
                                   Report& report) {
    return method.call(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, report);
}

Mesh textured(const Mesh& mesh) {
    return mesh.texcoords.empty() ? textured_from_above(mesh) : mesh;
}

std::string wrong_tangents(const Mesh& mesh, const NamedTangentMethod& method,
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

std::string too_far(const Mesh& mesh, const NamedTangentMethod& method, double degrees,
                    const ReferenceTangent& reference) {
    Report report;
    const std::vector<glm::vec4> tangents = tangents_of(mesh, method, report);
    for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
        const std::optional<glm::dvec4> expected = reference(mesh, corner);
        if (!expected) continue;
        const glm::dvec4 tangent(tangents[corner]);
        const double error = degrees_between(glm::dvec3(tangent), glm::dvec3(*expected));
        if (!(error <= degrees)) return fmt::format("corner {} is {} degrees off", corner, error);
        if (expected->w != 0.0 && expected->w != tangent.w)
            return fmt::format("corner {} has w {}", corner, tangent.w);
    }
    return "";
}

/// Returns the first problem of any method.
template <typename Problem>
std::function<std::string(const Mesh&)> with_each(const std::vector<NamedTangentMethod>& methods,
                                                  const Problem& problem) {
    return [methods, problem](const Mesh& bare) {
        const Mesh mesh = textured(bare);
        for (const NamedTangentMethod& method : methods) {
            if (const std::string found = problem(mesh, method); !found.empty())
                return method.name + ": " + found;
        }
        return std::string();
    };
}

}  // namespace

const std::vector<NamedTangentMethod>& all_tangent_methods() {
    static const std::vector<NamedTangentMethod> methods = {
        {"mikktspace", mikktspace_tangents},
        {"area-weighted", area_weighted_tangents},
        {"lengyel", lengyel_tangents}};
    return methods;
}

MeshCase& MeshCase::tangents(const Findings& findings) {
    return tangents_by("tangents", all_tangent_methods(), findings);
}

MeshCase& MeshCase::tangents_by(const std::string& step,
                                const std::vector<NamedTangentMethod>& methods,
                                const Findings& findings) {
    const std::map<std::string, std::size_t> expected(findings.begin(), findings.end());
    return expect(
        step, "orthonormal" + reported(findings),
        with_each(methods, [expected](const Mesh& mesh, const NamedTangentMethod& method) {
            return wrong_tangents(mesh, method, expected);
        }));
}

MeshCase& MeshCase::tangents_near(double degrees, const std::string& reference_name,
                                  const ReferenceTangent& reference) {
    const std::string outcome =
        degrees == 0.0 ? "exactly " + reference_name
                       : fmt::format("within {} degrees of {}", degrees, reference_name);
    return expect(
        "tangents", outcome,
        with_each(all_tangent_methods(), [=](const Mesh& mesh, const NamedTangentMethod& method) {
            return too_far(mesh, method, degrees, reference);
        }));
}

std::vector<glm::vec4> tangents_of(const Mesh& mesh, const NamedTangentMethod& method) {
    Report ignored;
    return method.call(mesh.positions, mesh.normals, mesh.texcoords, mesh.triangles, ignored);
}

Mesh textured_torus() {
    return make_torus(0.4F, 24, 12);
}

Mesh textured_grid() {
    return textured_from_above(flat_grid(4));
}

Mesh coarsely_textured() {
    Mesh mesh = textured_from_above(wavy_grid(6));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        mesh.texcoords[v].x += 0.0625F * static_cast<float>(v % 3);
    return mesh;
}

}  // namespace relief::test
