// SPDX-License-Identifier: Apache-2.0
// Needles and their normals, once more in integers, and where those are too small, without any
// difference of positions.
#include "stability/needles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "relief/mesh/direction_error.h"

namespace relief {
namespace {

__extension__ using Wide = __int128;

/// In units of 2^-62, in which floats of 1e-11 and more are whole numbers.
Wide units(float value) {
    return static_cast<Wide>(std::ldexp(static_cast<double>(value), 62));
}

TEST(Needles, HaveTheNormalsThatIntegersGive) {
    for (const double width : {1.0, 1e-3, 1e-6}) {
        const Needles needles = make_needles(300, width, 7);
        for (const glm::uvec3& t : needles.mesh.triangles) {
            std::array<std::array<Wide, 3>, 3> p{};
            for (std::size_t corner = 0; corner < 3; ++corner) {
                for (std::size_t i = 0; i < 3; ++i)
                    p.at(corner).at(i) = units(
                        needles.mesh.positions[t[static_cast<int>(corner)]][static_cast<int>(i)]);
            }
            // A quarter of each difference, so that products are below 2^127.
            glm::dvec3 normal;
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t j = (i + 1) % 3;
                const std::size_t k = (i + 2) % 3;
                const Wide first = (p[1].at(j) - p[0].at(j)) / 4 * ((p[2].at(k) - p[0].at(k)) / 4);
                const Wide second = (p[1].at(k) - p[0].at(k)) / 4 * ((p[2].at(j) - p[0].at(j)) / 4);
                normal[static_cast<int>(i)] = static_cast<double>(first - second);
            }
            EXPECT_LT(degrees_between(normal, needles.normals[t.x]), 1e-4) << width;
        }
    }
}

using LongVector = glm::vec<3, long double>;

/// (b - a) x (c - a) multiplied out: positions are never subtracted, products are, of which each
/// has 11 bits more than a double's.
LongVector multiplied_out(const LongVector& a, const LongVector& b, const LongVector& c) {
    return glm::cross(a, b) + glm::cross(b, c) + glm::cross(c, a);
}

TEST(Needles, HaveTheNormalsOfAnotherFormulaDownToTheNarrowest) {
    for (const double width : {1.0, 1e-3, 1e-6, 1e-9, 1e-12}) {
        const Needles needles = make_needles(300, width, 7);
        double furthest = 0.0;
        for (const glm::uvec3& t : needles.mesh.triangles) {
            const auto corner = [&](int i) { return LongVector(needles.mesh.positions[t[i]]); };
            const LongVector normal = multiplied_out(corner(0), corner(1), corner(2));
            const long double length = glm::length(normal);
            // Short sides lie across long ones, which end within `width` of where they would for 1.
            if (width < 1.0) {
                EXPECT_NEAR(static_cast<double>(length) / width, 1.0, width + 1e-6);
            }
            for (int i = 0; i < 3; ++i) {
                furthest = std::max(
                    furthest, degrees_between(glm::dvec3(normal / length), needles.normals[t[i]]));
            }
        }
        // Doubles are 2^-53 apart, 6e-15 degrees; a cross product has some of them.
        EXPECT_LT(furthest, 1e-13) << width;
    }
}

TEST(Needles, OfANormalThatIsAHairOffAreFoundToBe) {
    const Needles needles = make_needles(1, 1e-12, 7);
    const glm::uvec3 t = needles.mesh.triangles.front();
    const auto corner = [&](int i) { return LongVector(needles.mesh.positions[t[i]]); };
    const glm::dvec3 along = glm::normalize(glm::dvec3(corner(1)) - glm::dvec3(corner(0)));
    const LongVector normal = multiplied_out(corner(0), corner(1), corner(2));
    const glm::dvec3 leaning = needles.normals[t.x] + 1e-9 * along;
    EXPECT_NEAR(degrees_between(glm::dvec3(normal / glm::length(normal)), leaning),
                1e-9 * 180.0 / std::numbers::pi, 1e-12);
}

TEST(Needles, AreAsNarrowAsAsked) {
    for (const double width : {1e-2, 1e-12}) {
        const Needles needles = make_needles(100, width, 3);
        EXPECT_EQ(needles.mesh.positions.size(), 300U);
        for (const glm::uvec3& t : needles.mesh.triangles) {
            std::array<double, 3> sides{};
            for (int i = 0; i < 3; ++i) {
                sides.at(static_cast<std::size_t>(i)) =
                    glm::distance(glm::dvec3(needles.mesh.positions[t[i]]),
                                  glm::dvec3(needles.mesh.positions[t[(i + 1) % 3]]));
            }
            std::sort(sides.begin(), sides.end());
            EXPECT_NEAR(sides[0], width, 1e-6 * width);
            EXPECT_NEAR(sides[2], 1.0, 2.0 * width + 1e-6);
        }
    }
}

}  // namespace
}  // namespace relief
