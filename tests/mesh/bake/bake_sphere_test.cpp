// SPDX-License-Identifier: Apache-2.0
// A sphere with bumps baked onto a coarse one, held against every triangle tried in double, through
// codes of 16 and 8 bits and the shader's own basis.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "mesh/bake/bake_support.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/shapes.h"

namespace relief {
namespace {

using test::bake;
using test::BakedImage;
using test::sized;

constexpr int side = 128;

Mesh bumpy_sphere(int stacks) {
    Mesh mesh = make_sphere(2 * stacks, stacks);
    mesh.texcoords.clear();
    for (glm::vec3& position : mesh.positions) {
        const double longitude = std::atan2(position.x, position.z);
        const double polar = std::acos(std::clamp(double{position.y}, -1.0, 1.0));
        position *=
            static_cast<float>(1.0 + 0.02 * std::sin(12.0 * longitude) * std::sin(12.0 * polar));
    }
    Report report;
    mesh.normals = vertex_normals(mesh.positions, mesh.triangles, NormalWeight::angle, report);
    return mesh;
}

/// The high mesh's interpolated normal on a ray's outermost hit, every triangle tried.
glm::dvec3 ground_truth(const Mesh& high, const glm::dvec3& origin, const glm::dvec3& direction) {
    double nearest = 1e30;
    glm::dvec3 normal(0.0);
    for (const glm::uvec3& t : high.triangles) {
        const glm::dvec3 a(high.positions[t.x]), e(glm::dvec3(high.positions[t.y]) - a),
            f(glm::dvec3(high.positions[t.z]) - a);
        const glm::dvec3 p = glm::cross(direction, f);
        const double determinant = glm::dot(e, p);
        if (determinant == 0.0) continue;
        const glm::dvec3 s = origin - a;
        const double u = glm::dot(s, p) / determinant;
        const glm::dvec3 q = glm::cross(s, e);
        const double v = glm::dot(direction, q) / determinant;
        const double distance = glm::dot(f, q) / determinant;
        if (u < -1e-12 || v < -1e-12 || u + v > 1.0 + 1e-12 || distance < 0.0 || distance > nearest)
            continue;
        nearest = distance;
        normal = (1.0 - u - v) * glm::dvec3(high.normals[t.x]) + u * glm::dvec3(high.normals[t.y]) +
                 v * glm::dvec3(high.normals[t.z]);
    }
    return normal;
}

struct Errors {
    double mean = 0.0;
    double largest = 0.0;
};

/// Of a map as a shader reads it: codes decoded, put through the low mesh's basis.
Errors errors_of(const Mesh& high, const Mesh& low, const BakedImage& baked, int bits) {
    Image normals = make_image(side, side, 3, 32, ColorSpace::data);
    std::copy(baked.normals.begin(), baked.normals.end(), normals.as<float>().begin());
    Report report;
    const NormalMapFormat format{.bits = bits};
    const Image decoded = decode_normal_map(encode_normal_map(normals, format, report),
                                            format.green, format.flat, report);
    const Image object = object_from_tangent(decoded, low, {}, report).normals;
    const std::vector<glm::vec3> averaged =
        vertex_normals(low.positions, low.triangles, NormalWeight::angle, report);
    Errors errors;
    std::size_t count = 0;
    cover_texels(
        low.texcoords, low.triangles, {.width = side, .height = side},
        [&](int first_row, std::span<const CoveredTexel> texels) {
            for (std::size_t i = 0; i < texels.size(); i += 37) {
                if (!texels[i].is_covered()) continue;
                const glm::uvec3 corners = low.triangles[texels[i].triangle];
                glm::dvec3 point(0.0), outward(0.0);
                for (int corner = 0; corner < 3; ++corner) {
                    const double weight = texels[i].weights()[corner];
                    point += weight * glm::dvec3(low.positions[corners[corner]]);
                    outward += weight * glm::dvec3(averaged[corners[corner]]);
                }
                outward = glm::normalize(outward);
                const std::size_t texel = static_cast<std::size_t>(first_row) * side + i;
                const float* n = &object.as<float>()[3 * texel];
                const double error =
                    degrees_between(glm::dvec3(n[0], n[1], n[2]),
                                    ground_truth(high, point + 0.1 * outward, -outward));
                static std::mutex mutex;
                const std::lock_guard lock(mutex);
                errors.mean += error;
                errors.largest = std::max(errors.largest, error);
                ++count;
            }
        },
        report);
    EXPECT_GT(count, 400U);
    errors.mean /= static_cast<double>(count);
    return errors;
}

TEST(BakeSphere, IsTheHighMeshsNormalsWithinWhatCodesHold) {
    const Mesh high = bumpy_sphere(100);
    Report report;
    const Mesh low =
        with_frames(make_sphere(46, 23), {.tangents = TangentMode::mikktspace}, report).mesh;
    const BakedImage baked = bake({high}, low, sized(side, side));
    EXPECT_EQ(baked.result.texels_missed, 0U);
    // Bumps of 2%, over a sphere whose facets lie up to 0.7% inside: all of it was found.
    EXPECT_GT(baked.result.max_height, 0.02);
    EXPECT_LT(baked.result.min_height, -0.015);
    const Errors fine = errors_of(high, low, baked, 16);
    EXPECT_LT(fine.mean, 0.005);
    EXPECT_LT(fine.largest, 0.05);
    const Errors coarse = errors_of(high, low, baked, 8);
    EXPECT_LT(coarse.mean, 0.2);
}

}  // namespace
}  // namespace relief
