// SPDX-License-Identifier: Apache-2.0
// GGX: what its functions integrate to.
#include "environment/ggx.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

namespace relief {
namespace {

using std::numbers::pi;

TEST(Ggx, ProjectedFacetsCoverTheSurfaceOnce) {
    for (const double alpha : {0.05, 0.3, 0.7, 1.0}) {
        // In the square of the sine x, n.h dh = pi dx; even steps of a fourth root resolve the
        // peak.
        double sum = 0.0;
        constexpr int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double root = (i + 0.5) / steps;
            const double x = std::pow(root, 4.0);
            sum += ggx_distribution(std::sqrt(1.0 - x), alpha) * pi * 4.0 * std::pow(root, 3.0);
        }
        EXPECT_NEAR(sum / steps, 1.0, 1e-4) << alpha;
    }
}

TEST(Ggx, FacetsAreDrawnAsOftenAsTheyAre) {
    for (const double alpha : {0.1, 0.5, 1.0}) {
        // The share of facets within an angle of the normal, by points and by the formula.
        constexpr unsigned count = 4096;
        unsigned within = 0;
        for (unsigned i = 0; i < count; ++i) {
            const glm::dvec3 facet = ggx_facet(hammersley(i, count), alpha);
            EXPECT_NEAR(glm::length(facet), 1.0, 1e-12);
            if (facet.z > 0.9) ++within;
        }
        const double tan_squared = 1.0 / 0.81 - 1.0;
        EXPECT_NEAR(static_cast<double>(within) / count,
                    tan_squared / (tan_squared + alpha * alpha), 2.0 / count);
    }
}

TEST(Ggx, VisibilityIsSymmetricAndOneForAMirror) {
    EXPECT_DOUBLE_EQ(ggx_visibility(0.3, 0.8, 0.4), ggx_visibility(0.8, 0.3, 0.4));
    EXPECT_NEAR(ggx_visibility(0.3, 0.8, 1e-9) * 4.0 * 0.3 * 0.8, 1.0, 1e-12);
    EXPECT_LT(ggx_visibility(0.3, 0.8, 1.0) * 4.0 * 0.3 * 0.8, 0.5);
}

TEST(Ggx, AVerySharpPeakIsFinite) {
    EXPECT_NEAR(ggx_distribution(1.0, 1e-4) * pi * 1e-8, 1.0, 1e-12);
    EXPECT_GT(ggx_distribution(0.5, 1e-4), 0.0);
    EXPECT_DOUBLE_EQ(ggx_distribution(0.2, 1.0), 1.0 / pi);
}

TEST(Hammersley, PutsOnePointInEachStripBothWays) {
    constexpr unsigned count = 64;
    std::set<int> columns;
    std::set<int> rows;
    for (unsigned i = 0; i < count; ++i) {
        const glm::dvec2 point = hammersley(i, count);
        columns.insert(static_cast<int>(point.x * count));
        rows.insert(static_cast<int>(point.y * count));
        EXPECT_GT(point.x, 0.0);
        EXPECT_LT(point.x, 1.0);
        EXPECT_LT(point.y, 1.0);
    }
    EXPECT_EQ(columns.size(), count);
    EXPECT_EQ(rows.size(), count);
    EXPECT_EQ(hammersley(1, 64).y, 0.5 + 0.5 / 64);
}

}  // namespace
}  // namespace relief
