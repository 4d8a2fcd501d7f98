// SPDX-License-Identifier: Apache-2.0
// Writes the tangents of the MikkTSpace reference for all corners of the kit's meshes:
// relief-make-conformance-expected FOLDER writes NAME.f32 for each mesh with expected results, and
// a table of the corners that are not judged to stdout. It needs the sources of the reference
// (expected.cmake). Exit codes: 0 done, 1 failed, 2 wrong usage.
//
// NAME.f32: little-endian floats x, y, z, w for each corner, in the order of the mesh's triangles,
// by glTF's convention: bitangent = w * cross(normal, xyz) points towards decreasing v. The
// reference gets the stored texture coordinates, and its sign is negated, which gives the same
// numbers as (u, -v). All four are 0 if a corner is not judged (see README.md).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <stdexcept>

#include "kit_meshes.h"
#include "relief/mesh/statistics.h"

extern "C" {
#include <mikktspace.h>
tbool corrected_genTangSpaceDefault(const SMikkTSpaceContext* context);
}

namespace {

namespace kit = relief::conformance;

constexpr double same_degrees = 0.01;
constexpr int random_orders = 64;

using Face = std::vector<std::uint32_t>;  // Vertex indices.

/// The data of the reference's callbacks.
struct Subject {
    const relief::Mesh& mesh;
    std::vector<Face> faces;
    std::vector<std::vector<glm::vec4>> tangents;
};

Subject& subject_of(const SMikkTSpaceContext* context) {
    return *static_cast<Subject*>(context->m_pUserData);
}

std::uint32_t vertex_of(const SMikkTSpaceContext* context, int face, int corner) {
    return subject_of(context)
        .faces[static_cast<std::size_t>(face)][static_cast<std::size_t>(corner)];
}

template <typename Vector>
void copy(const Vector& from, float* to) {
    for (int i = 0; i < from.length(); ++i)
        to[i] = from[i];
}

std::vector<std::vector<glm::vec4>> reference_tangents(
    const relief::Mesh& mesh, const std::vector<Face>& faces,
    tbool (*generate)(const SMikkTSpaceContext*)) {
    Subject subject{mesh, faces, {}};
    for (const Face& face : faces)
        subject.tangents.emplace_back(face.size());
    SMikkTSpaceInterface calls{};
    calls.m_getNumFaces = [](const SMikkTSpaceContext* c) {
        return static_cast<int>(subject_of(c).faces.size());
    };
    calls.m_getNumVerticesOfFace = [](const SMikkTSpaceContext* c, const int face) {
        return static_cast<int>(subject_of(c).faces[static_cast<std::size_t>(face)].size());
    };
    calls.m_getPosition = [](const SMikkTSpaceContext* c, float* out, const int f, const int i) {
        copy(subject_of(c).mesh.positions[vertex_of(c, f, i)], out);
    };
    calls.m_getNormal = [](const SMikkTSpaceContext* c, float* out, const int f, const int i) {
        copy(subject_of(c).mesh.normals[vertex_of(c, f, i)], out);
    };
    calls.m_getTexCoord = [](const SMikkTSpaceContext* c, float* out, const int f, const int i) {
        copy(subject_of(c).mesh.texcoords[vertex_of(c, f, i)], out);
    };
    // If the reference computes nothing for a corner, the lengths are exactly 1, and the vectors
    // are the axes.
    calls.m_setTSpace = [](const SMikkTSpaceContext* c, const float* tangent,
                           const float* bitangent, const float u_length, const float v_length,
                           const tbool is_upright, const int f, const int i) {
        const glm::vec3 t(tangent[0], tangent[1], tangent[2]);
        const glm::vec3 b(bitangent[0], bitangent[1], bitangent[2]);
        const bool is_untouched = u_length == 1.0F && v_length == 1.0F && is_upright == 0 &&
                                  t == glm::vec3(1, 0, 0) && b == glm::vec3(0, 1, 0);
        subject_of(c).tangents[static_cast<std::size_t>(f)][static_cast<std::size_t>(i)] =
            is_untouched ? glm::vec4(0.0F) : glm::vec4(t, is_upright != 0 ? -1.0F : 1.0F);
    };
    SMikkTSpaceContext context{&calls, &subject};
    if (generate(&context) == 0) throw std::runtime_error("the reference failed");
    return subject.tangents;
}

/// The tangents for faces in another order and with other first corners, in the original order.
std::vector<std::vector<glm::vec4>> reordered_tangents(const relief::Mesh& mesh,
                                                       const std::vector<Face>& faces,
                                                       const std::vector<std::size_t>& order,
                                                       const std::vector<std::size_t>& begin) {
    std::vector<Face> other;
    for (const std::size_t f : order) {
        Face face = faces[f];
        std::rotate(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(begin[f]), face.end());
        other.push_back(face);
    }
    auto found = reference_tangents(mesh, other, corrected_genTangSpaceDefault);
    std::vector<std::vector<glm::vec4>> result(faces.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        std::vector<glm::vec4>& face = found[i];
        const std::size_t f = order[i];
        std::rotate(face.begin(), face.end() - static_cast<std::ptrdiff_t>(begin[f]), face.end());
        result[f] = face;
    }
    return result;
}

bool agree(const glm::vec4& a, const glm::vec4& b) {
    return a.w == b.w && relief::degrees_between(glm::dvec3(a), glm::dvec3(b)) <= same_degrees;
}

/// The numbers of corners that are not judged, by reason.
struct Tally {
    std::size_t corners = 0;
    std::size_t unjudged = 0;
    std::size_t order = 0;      ///< Another order of faces or corners gives other tangents.
    std::size_t untouched = 0;  ///< The reference computes nothing.
    std::size_t quads = 0;      ///< The quads have other tangents.
    std::size_t defect = 0;     ///< The corrected reference gives other tangents.
};

std::vector<Face> faces_of(const relief::Mesh& mesh) {
    std::vector<Face> faces;
    for (const glm::uvec3& triangle : mesh.triangles)
        faces.push_back({triangle.x, triangle.y, triangle.z});
    return faces;
}

/// The tangents of the quads, at the corners of the triangles.
std::vector<glm::vec4> quad_tangents(const kit::KitMesh& mesh) {
    std::vector<Face> faces;
    for (const glm::uvec4& quad : mesh.quads)
        faces.push_back({quad.x, quad.y, quad.z, quad.w});
    const auto found = reference_tangents(mesh.mesh, faces, corrected_genTangSpaceDefault);
    std::vector<glm::vec4> corners;
    for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
        for (int i = 0; i < 3; ++i) {
            const Face& quad = faces[t / 2];
            const auto at = std::find(quad.begin(), quad.end(), mesh.mesh.triangles[t][i]);
            corners.push_back(found[t / 2][static_cast<std::size_t>(at - quad.begin())]);
        }
    }
    return corners;
}

std::vector<glm::vec4> flattened(const std::vector<std::vector<glm::vec4>>& faces) {
    std::vector<glm::vec4> corners;
    for (const auto& face : faces)
        corners.insert(corners.end(), face.begin(), face.end());
    return corners;
}

/// The tangents for other orders. They show which corners are unambiguous.
std::vector<std::vector<glm::vec4>> other_tangents(const relief::Mesh& mesh,
                                                   const std::vector<Face>& faces) {
    std::vector<std::size_t> order(faces.size());
    std::vector<std::size_t> begin(faces.size(), 0);
    std::iota(order.rbegin(), order.rend(), std::size_t{0});
    std::vector<std::vector<glm::vec4>> all = {
        flattened(reordered_tangents(mesh, faces, order, begin))};
    kit::Random random(20);
    for (int i = 0; i < random_orders; ++i) {
        for (std::size_t f = faces.size(); f > 1; --f)
            std::swap(order[f - 1], order[random.below(static_cast<std::uint32_t>(f))]);
        for (std::size_t& first : begin)
            first = random.below(3);
        all.push_back(flattened(reordered_tangents(mesh, faces, order, begin)));
    }
    return all;
}

Tally write_expected(const std::filesystem::path& file, const kit::KitMesh& mesh) {
    const std::vector<Face> faces = faces_of(mesh.mesh);
    std::vector<glm::vec4> expected =
        flattened(reference_tangents(mesh.mesh, faces, corrected_genTangSpaceDefault));
    const std::vector<glm::vec4> uncorrected =
        flattened(reference_tangents(mesh.mesh, faces, genTangSpaceDefault));
    const auto others = other_tangents(mesh.mesh, faces);
    const std::vector<glm::vec4> by_quads = mesh.quads.empty() ? expected : quad_tangents(mesh);
    Tally tally;
    tally.corners = expected.size();
    for (std::size_t corner = 0; corner < expected.size(); ++corner) {
        const glm::vec4 tangent = expected[corner];
        const bool is_defect = !agree(tangent, uncorrected[corner]);
        const bool is_stable = std::all_of(others.begin(), others.end(), [&](const auto& other) {
            return agree(tangent, other[corner]);
        });
        const bool is_untouched = tangent == glm::vec4(0.0F);
        const bool is_quads = agree(tangent, by_quads[corner]);
        const bool is_excused = is_defect && mesh.group != kit::KitGroup::defect;
        tally.defect += is_defect ? 1U : 0U;
        if (is_stable && !is_untouched && is_quads && !is_excused) continue;
        ++tally.unjudged;
        tally.order += is_stable ? 0U : 1U;
        tally.untouched += is_untouched ? 1U : 0U;
        tally.quads += is_quads ? 0U : 1U;
        expected[corner] = glm::vec4(0.0F);
    }
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(expected.data()),
                 static_cast<std::streamsize>(expected.size() * sizeof(glm::vec4)));
    if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
    return tally;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2 || arguments[1][0] == '-') {
        fmt::print(stderr, "usage: relief-make-conformance-expected FOLDER\n");
        return 2;
    }
    try {
        fmt::print(
            "| mesh | corners | not judged | order decides | no answer | quads differ | defect |\n"
            "|---|---|---|---|---|---|---|\n");
        for (const kit::KitMesh& mesh : kit::kit_meshes()) {
            if (mesh.group == kit::KitGroup::stability) continue;
            const Tally tally =
                write_expected(std::filesystem::path(arguments[1]) / (mesh.name + ".f32"), mesh);
            fmt::print("| `{}` | {} | {} | {} | {} | {} | {} |\n", mesh.name, tally.corners,
                       tally.unjudged, tally.order, tally.untouched, tally.quads, tally.defect);
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "relief-make-conformance-expected: error: {}\n", error.what());
        return 1;
    }
    return 0;
}
