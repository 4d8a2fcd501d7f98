// SPDX-License-Identifier: Apache-2.0
// Hard edges by hand, and the angle that tells them.
#include "relief/mesh/inferred_creases.h"

#include <gtest/gtest.h>

#include <glm/trigonometric.hpp>

#include "relief/mesh/error.h"
#include "relief/mesh/normals.h"
#include "support/shapes.h"

namespace relief {
namespace {

TEST(InferredCreases, OfACubeAreItsEdgesAtHalfARightAngle) {
    const InferredCreases found = inferred_creases(test::cube());
    EXPECT_EQ(found.edges, 18U);
    EXPECT_EQ(found.hard, 12U);
    EXPECT_NEAR(glm::degrees(found.crease_angle), 45.0, 1e-6);
    EXPECT_EQ(found.misclassified, 0U);
}

TEST(InferredCreases, OfASmoothMeshAreNone) {
    const InferredCreases found = inferred_creases(test::sphere(12, 8));
    EXPECT_GT(found.edges, 100U);
    EXPECT_EQ(found.hard, 0U);
    EXPECT_EQ(found.crease_angle, std::numbers::pi);
}

TEST(InferredCreases, OfFacetsTellNoAngleFromNone) {
    Mesh facets = test::soup(test::sphere(12, 8));
    Report report;
    const std::vector<glm::vec3> normals =
        triangle_normals(facets.positions, facets.triangles, report);
    for (std::size_t t = 0; t < facets.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner)
            facets.normals[facets.triangles[t][corner]] = normals[t];
    }
    const InferredCreases found = inferred_creases(facets);
    EXPECT_GT(found.hard, found.edges / 2);
    EXPECT_LT(glm::degrees(found.crease_angle), 12.0);
}

/// A strip over the x axis that is bent at each of its lines by so many degrees, hard or not.
Mesh strip(const std::vector<std::pair<double, bool>>& bends) {
    Mesh mesh;
    glm::dvec2 place(0.0);
    double angle = 0.0;
    const auto add_line = [&](double normal_angle) {
        for (const double y : {0.0, 1.0}) {
            mesh.positions.emplace_back(place.x, y, place.y);
            mesh.normals.emplace_back(std::sin(glm::radians(normal_angle)), 0.0,
                                      std::cos(glm::radians(normal_angle)));
        }
    };
    const auto step = [&] {
        place += glm::dvec2(std::cos(glm::radians(angle)), -std::sin(glm::radians(angle)));
    };
    const auto add_quad = [&](std::uint32_t left, std::uint32_t right) {
        mesh.triangles.emplace_back(left, right, right + 1);
        mesh.triangles.emplace_back(left, right + 1, left + 1);
    };
    add_line(0.0);
    std::uint32_t left = 0;
    for (const auto& [bend, is_hard] : bends) {
        step();
        add_line(is_hard ? angle : angle + 0.5 * bend);
        const auto line = static_cast<std::uint32_t>(mesh.positions.size()) - 2;
        add_quad(left, line);
        angle += bend;
        left = line;
        if (!is_hard) continue;
        add_line(angle);
        left = line + 2;
    }
    step();
    add_line(angle);
    add_quad(left, static_cast<std::uint32_t>(mesh.positions.size()) - 2);
    return mesh;
}

TEST(InferredCreases, PartAtTheAngleWithTheFewestMisjudged) {
    // The quads' diagonals are five edges of no angle.
    const InferredCreases clear =
        inferred_creases(strip({{10.0, false}, {20.0, false}, {50.0, true}, {70.0, true}}));
    EXPECT_EQ(clear.edges, 4U + 5U);
    EXPECT_EQ(clear.hard, 2U);
    EXPECT_NEAR(glm::degrees(clear.crease_angle), 35.0, 1e-3);
    EXPECT_EQ(clear.misclassified, 0U);
    const InferredCreases mixed =
        inferred_creases(strip({{15.0, true}, {30.0, false}, {50.0, true}, {70.0, true}}));
    EXPECT_NEAR(glm::degrees(mixed.crease_angle), 40.0, 1e-3);
    EXPECT_EQ(mixed.misclassified, 1U);
}

TEST(InferredCreases, NeedNormals) {
    Mesh mesh = test::cube();
    mesh.normals.clear();
    EXPECT_THROW(inferred_creases(mesh), InvalidInput);
}

}  // namespace
}  // namespace relief
