// SPDX-License-Identifier: Apache-2.0
// Needles and their normals, once more in integers.
#include "stability/needles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

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
