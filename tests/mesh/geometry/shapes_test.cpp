// SPDX-License-Identifier: Apache-2.0
// Shapes against their known volumes and areas, and that normals and windings look outwards.
#include "relief/mesh/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "relief/mesh/error.h"
#include "support/angle.h"

namespace relief {
namespace {

/// Of a closed mesh, by the divergence theorem: negative if it is inside out.
double volume(const Mesh& mesh) {
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        sum +=
            glm::dot(glm::dvec3(mesh.positions[t.x]),
                     glm::cross(glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z]))) /
            6.0;
    }
    return sum;
}

/// The largest angle between a vertex normal and the plane of a triangle there, in degrees.
double largest_tilt(const Mesh& mesh) {
    double largest = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 normal =
            glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
        if (glm::length(normal) < 1e-9) continue;  // At a pole.
        for (int k = 0; k < 3; ++k) {
            largest =
                std::max(largest, test::degrees_between(glm::dvec3(mesh.normals[t[k]]), normal));
        }
    }
    return largest;
}

using std::numbers::pi;

TEST(Shapes, HaveTheirVolumesAndLookOutwards) {
    struct Case {
        Mesh mesh;
        double volume, tolerance, tilt;
    };
    // Inscribed shapes are smaller by a share that goes with the square of the step; normals tilt
    // by half a step at most, on both sides of a quad together by a step.
    const double prism = 64.0 * std::sin(2.0 * pi / 64.0);  // Two 64-gons' areas, of radius 1.
    const Case cases[] = {
        {make_cube(), 8.0, 1e-9, 1e-4},
        {make_sphere(128, 64), 4.0 / 3.0 * pi, 0.01, 3.0},
        {make_torus(0.4F, 128, 64), 2.0 * pi * pi * 0.16, 0.01, 6.0},
        {make_cylinder(64), prism, 1e-5, 3.0},
    };
    for (const Case& shape : cases) {
        SCOPED_TRACE(shape.mesh.name);
        EXPECT_NO_THROW(validate(shape.mesh));
        EXPECT_NEAR(volume(shape.mesh), shape.volume, shape.tolerance);
        EXPECT_LT(largest_tilt(shape.mesh), shape.tilt);
        EXPECT_EQ(shape.mesh.texcoords.size(), shape.mesh.positions.size());
        for (const glm::vec3& normal : shape.mesh.normals)
            ASSERT_NEAR(glm::length(normal), 1.0F, 1e-6F);
    }
}

TEST(Shapes, AQuadFacesTheViewerWithTheImageUpright) {
    const Mesh quad = make_quad(2);
    EXPECT_EQ(quad.triangles.size(), 8U);
    EXPECT_EQ(quad.positions.front(), glm::vec3(-1, 1, 0));
    EXPECT_EQ(quad.texcoords.front(), glm::vec2(0, 0));
    EXPECT_EQ(quad.positions.back(), glm::vec3(1, -1, 0));
    EXPECT_EQ(quad.texcoords.back(), glm::vec2(1, 1));
    EXPECT_LT(largest_tilt(quad), 1e-6);
}

TEST(Shapes, MeetExactlyAtTheirSeams) {
    const Mesh torus = make_torus(0.3F, 8, 6);
    for (std::size_t side = 0; side <= 6; ++side)
        EXPECT_EQ(torus.positions[side * 9], torus.positions[side * 9 + 8]);
    for (std::size_t slice = 0; slice <= 8; ++slice)
        EXPECT_EQ(torus.positions[slice], torus.positions[6 * 9 + slice]);
}

TEST(Shapes, OfNoUsableSizeAreRefused) {
    EXPECT_THROW((void)make_quad(0), InvalidInput);
    EXPECT_THROW((void)make_sphere(2, 8), InvalidInput);
    EXPECT_THROW((void)make_sphere(8, 1), InvalidInput);
    EXPECT_THROW((void)make_torus(0.0F), InvalidInput);
    EXPECT_THROW((void)make_torus(0.4F, 5000, 8), InvalidInput);
    EXPECT_THROW((void)make_cylinder(2), InvalidInput);
}

}  // namespace
}  // namespace relief
