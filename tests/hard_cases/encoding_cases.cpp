// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "hard_cases/mesh_case.h"
#include "hard_cases/mesh_cases.h"
#include "hard_cases/sample_meshes.h"
#include "relief/mesh/frame_encoding.h"

namespace relief::test {
namespace {

/// A vertex for each hand of each turn by 180 degrees about axes in many directions: there, the
/// real part of a quaternion, of which the sign is the handedness, is 0.
Mesh half_turns() {
    Mesh mesh;
    for (int x = -3; x <= 3; ++x) {
        for (int y = -3; y <= 3; ++y) {
            for (int z = -3; z <= 3; ++z) {
                const glm::dvec3 axis(x, y, z);
                if (axis == glm::dvec3(0.0)) continue;
                const glm::dvec3 unit = glm::normalize(axis);
                const auto turned = [&](const glm::dvec3& v) {
                    return 2.0 * glm::dot(unit, v) * unit - v;
                };
                for (const float w : {1.0F, -1.0F}) {
                    mesh.positions.emplace_back(axis);
                    mesh.normals.emplace_back(turned({0.0, 0.0, 1.0}));
                    mesh.tangents.emplace_back(glm::vec3(turned({1.0, 0.0, 0.0})), w);
                }
            }
        }
    }
    return mesh;
}

/// Unit and perpendicular within this: what floats of unit vectors resolve.
constexpr double resolved = 2e-7;

std::string lost_in_codes(const Mesh& mesh) {
    for (const FrameEncoding encoding : all_frame_encodings) {
        for (const FrameRounding rounding : {FrameRounding::nearest, FrameRounding::best}) {
            Report report;
            const Frames frames = decode_frames(
                encode_frames(mesh.normals, mesh.tangents, encoding, rounding, report), encoding,
                report);
            if (!report.empty()) return to_string(report.findings().front());
            for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
                const glm::dvec3 normal(frames.normals[v]);
                const glm::dvec3 tangent(frames.tangents[v]);
                const bool is_frame = std::abs(glm::length(normal) - 1.0) <= resolved &&
                                      std::abs(glm::length(tangent) - 1.0) <= resolved &&
                                      std::abs(glm::dot(normal, tangent)) <= resolved;
                if (is_frame && frames.tangents[v].w == mesh.tangents[v].w) continue;
                return fmt::format("encoding {}, vertex {}", static_cast<int>(encoding), v);
            }
        }
    }
    return "";
}

}  // namespace

std::vector<HardCase> encoding_cases() {
    return {MeshCase("frames in few bits, turned by 180 degrees",
                     "Frames of both hands, turned by half a turn about 342 axes, where the real "
                     "part of a quaternion is 0.",
                     "QTangents whose sign is lost when the real part is rounded to 0", half_turns)
                .expect("encodings", "orthonormal, w as it was, in each of the eight encodings",
                        lost_in_codes)};
}

}  // namespace relief::test
