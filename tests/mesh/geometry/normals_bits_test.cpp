// SPDX-License-Identifier: Apache-2.0
// The bits of vertex normals: equal to the definition in higher precision, and unchanged for any
// order of triangles and number of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "mesh/geometry/normal_samples.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "support/hard_meshes.h"
#include "support/invariants.h"
#include "support/shapes.h"
#include "support/vector_bits.h"

namespace relief {
namespace {

using test::all_weights;
using test::bumpy_ball;
using test::degrees_between;
using test::float_degrees;
using test::normals_of;

/// Returns the weight of a corner with edges u and v by definition.
long double weight_of(NormalWeight weight, const glm::dvec3& u, const glm::dvec3& v) {
    using Vector = glm::vec<3, long double>;
    const Vector a(u);
    const Vector b(v);
    const long double area = glm::length(glm::cross(a, b));
    const long double lengths = glm::length(a) * glm::length(b);
    const long double angle = std::atan2(area, glm::dot(a, b));
    switch (weight) {
        case NormalWeight::uniform:
            return 1.0L;
        case NormalWeight::area:
            return area;
        case NormalWeight::angle:
            return angle;
        case NormalWeight::sine:
            return area / lengths;
        case NormalWeight::max:
            return area / lengths / lengths;
        case NormalWeight::angle_edges:
            return angle * lengths;
        case NormalWeight::area_angle:
            return angle * area;
    }
    return 0.0L;
}

/// Computes normals by definition in long double, rounded as normals.h states, without shared sums.
std::vector<glm::vec3> normals_by_definition(const Mesh& mesh, NormalWeight weight) {
    using Vector = glm::vec<3, long double>;
    std::vector<Vector> sums(mesh.positions.size(), Vector(0.0L));
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 here(mesh.positions[triangle[i]]);
            const glm::dvec3 u = glm::dvec3(mesh.positions[triangle[(i + 1) % 3]]) - here;
            const glm::dvec3 v = glm::dvec3(mesh.positions[triangle[(i + 2) % 3]]) - here;
            sums[triangle[i]] +=
                weight_of(weight, u, v) * glm::normalize(glm::cross(Vector(u), Vector(v)));
        }
    }
    std::vector<glm::vec3> normals;
    for (const Vector& sum : sums) {
        const Vector steps = glm::round(glm::normalize(sum) * 268435456.0L);
        normals.push_back(glm::vec3(steps) / 268435456.0F + 0.0F);
    }
    return normals;
}

TEST(VertexNormals, AreTheDefinitionsBitForBit) {
    const Mesh mesh = bumpy_ball();
    for (const NormalWeight weight : all_weights) {
        const auto normals = normals_of(mesh, {weight, Arithmetic::float64, std::nullopt});
        const auto expected = normals_by_definition(mesh, weight);
        std::size_t different = 0;
        for (std::size_t i = 0; i < normals.size(); ++i) {
            if (std::isnan(expected[i].x)) continue;  // An unused vertex of a pole.
            different += normals[i] != expected[i] ? 1 : 0;
        }
        EXPECT_EQ(different, 0U) << "weight " << static_cast<int>(weight);
    }
}

TEST(VertexNormals, NoInstructionSetChangesABit) {
    const Mesh mesh = bumpy_ball();
    for (const NormalWeight weight : all_weights) {
        for (const Arithmetic arithmetic : {Arithmetic::float64, Arithmetic::float32}) {
            const auto expected = normals_of(mesh, {weight, arithmetic});
            for (const char* bits : {"128", "256"}) {
                const test::VectorBits narrower(bits);
                EXPECT_TRUE(test::same_bits(normals_of(mesh, {weight, arithmetic}), expected))
                    << bits << " bits, weight " << static_cast<int>(weight);
            }
        }
    }
}

TEST(VertexNormals, ArithmeticInFloatIsOffByFloatsRounding) {
    const Mesh mesh = bumpy_ball();
    for (const NormalWeight weight : all_weights) {
        const auto exact = normals_of(mesh, {weight, Arithmetic::float64});
        const auto quick = normals_of(mesh, {weight, Arithmetic::float32});
        double worst = 0.0;
        for (std::size_t i = 0; i < exact.size(); ++i)
            worst = std::max(worst, degrees_between(quick[i], exact[i]));
        // Edges near the poles have a length of 0.01 at a distance of 1 from the origin: their
        // relative rounding error is 1e-5.
        EXPECT_LE(worst, 1e-3) << "weight " << static_cast<int>(weight);
        EXPECT_GT(worst, 0.0);
    }
}

TEST(VertexNormals, ArithmeticInFloatKeepsItsBitsInAnyOrderAndAtAnyScale) {
    const Mesh mesh = bumpy_ball();
    const Mesh permuted = test::with_triangle_order(mesh, test::shuffled(mesh.triangles.size()));
    Mesh scaled = mesh;
    for (glm::vec3& position : scaled.positions)
        position *= std::ldexp(1.0F, -90);
    for (const NormalWeight weight : all_weights) {
        const NormalOptions options{weight, Arithmetic::float32};
        const auto expected = normals_of(mesh, options);
        EXPECT_TRUE(test::same_bits(normals_of(permuted, options), expected));
        EXPECT_TRUE(test::same_bits(normals_of(scaled, options), expected));
    }
}

TEST(VertexNormals, MinusZeroEqualsZero) {
    // Two perpendicular triangles whose shared corner has zeros of different signs.
    const std::vector<glm::vec3> positions = {{0, 0, 0},         {1, 0, 0}, {0, 1, 0},
                                              {-0.0F, 0, -0.0F}, {0, 1, 0}, {0, 0, 1}};
    Report report;
    const auto normals = vertex_normals(positions, std::vector<glm::uvec3>{{0, 1, 2}, {3, 4, 5}},
                                        NormalWeight::angle, report);
    EXPECT_EQ(normals[0], normals[3]);
    EXPECT_LE(degrees_between(normals[0], glm::dvec3(1, 0, 1)), float_degrees);
}

TEST(VertexNormals, LateTrianglesChangeNormalsThatWereRoundedEarly) {
    // Normals of vertices below those of the last triangles are rounded early.
    Mesh mesh = test::sphere(200, 150);
    mesh.triangles.push_back({10, 20'000, 300});
    mesh.triangles.push_back({29'000, 5'000, 5'001});
    const Mesh permuted = test::with_triangle_order(mesh, test::shuffled(mesh.triangles.size()));
    for (const NormalWeight weight : {NormalWeight::area, NormalWeight::angle}) {
        const NormalOptions options{weight, Arithmetic::float64, std::nullopt};
        const auto expected = normals_of(permuted, options);
        for (const unsigned threads : {1U, 2U}) {
            const ExecutionScope scope({.threads = threads});
            EXPECT_TRUE(test::same_bits(normals_of(mesh, options), expected));
        }
    }
}

TEST(VertexNormals, ScalingByAPowerOfTwoChangesNoBit) {
    const Mesh sphere = test::sphere(16, 8);
    for (const NormalWeight weight : all_weights) {
        for (const int exponent : {-60, 60}) {
            Mesh scaled = sphere;
            for (glm::vec3& position : scaled.positions)
                position *= std::ldexp(1.0F, exponent);
            EXPECT_TRUE(test::same_bits(normals_of(scaled, weight), normals_of(sphere, weight)));
        }
    }
}

TEST(VertexNormals, OffsetCostsOnlyThePrecisionOfPositions) {
    // Positions that are multiples of 1/16 stay exact at an offset of 2^19.
    Mesh mesh = test::grid(8);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i].z = static_cast<float>(i * i % 7) / 16.0F;
    const auto expected = normals_of(mesh, NormalWeight::angle);
    for (glm::vec3& position : mesh.positions)
        position += glm::vec3(524288.0F);
    EXPECT_TRUE(test::same_bits(normals_of(mesh, NormalWeight::angle), expected));
}

TEST(VertexNormals, PermutingTrianglesAndRotatingTheirCornersChangesNoBit) {
    std::vector<test::NamedMesh> meshes = test::hard_meshes();
    meshes.push_back({"sphere", test::sphere(20, 10)});
    for (const test::NamedMesh& hard : meshes) {
        SCOPED_TRACE(hard.name);
        Mesh permuted =
            test::with_triangle_order(hard.mesh, test::shuffled(hard.mesh.triangles.size()));
        for (std::size_t i = 0; i < permuted.triangles.size(); i += 2) {
            glm::uvec3& triangle = permuted.triangles[i];
            triangle = {triangle.y, triangle.z, triangle.x};
        }
        for (const NormalWeight weight : all_weights) {
            EXPECT_TRUE(
                test::same_bits(normals_of(hard.mesh, weight), normals_of(permuted, weight)));
        }
    }
}

TEST(VertexNormals, TheNumberOfThreadsChangesNoBit) {
    const Mesh sphere = test::sphere(200, 100);
    for (const NormalWeight weight : all_weights) {
        set_thread_limit(1);
        const auto expected = normals_of(sphere, weight);
        for (const unsigned threads : {2U, 3U, 0U}) {
            set_thread_limit(threads);
            EXPECT_TRUE(test::same_bits(normals_of(sphere, weight), expected)) << threads;
        }
    }
    set_thread_limit(0);
}

}  // namespace
}  // namespace relief
