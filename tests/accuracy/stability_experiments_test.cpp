// SPDX-License-Identifier: Apache-2.0
// Sweeps computed by hand, and the values up to which methods are known to work.
#include "experiment_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiment_checks.h"

namespace relief {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

TEST(Sweeps, FindTheFailurePointOfEachMethod) {
    Sweeps sweeps({"good", "growing", "lost"}, 1.0,
                  {{"size", "Larger", "size", 6, 2, [](std::size_t method, double value) {
                        if (method == 0) return std::vector<float>{0.25F, 0.25F};
                        if (method == 1)
                            return std::vector<float>{static_cast<float>(1e-3 * value)};
                        return std::vector<float>{0.0F, value > 50.0 ? NAN : 0.5F};
                    }}});
    EXPECT_EQ(sweeps.measure(0).count, 8U);
    sweeps.measure(1);
    EXPECT_EQ(sweeps.measure(2).undefined, 3U);
    ASSERT_EQ(sweeps.charts().size(), 1U);
    const std::vector<Curve>& curves = sweeps.charts().front().curves;
    ASSERT_EQ(curves[0].points.size(), 4U);
    EXPECT_EQ(curves[0].points[1].x, 100.0);
    EXPECT_NEAR(curves[0].points[3].error, 0.25, 1e-7);
    EXPECT_FALSE(curves[0].breaks_at);
    EXPECT_EQ(curves[1].breaks_at, 1e4) << "0.1 degrees at 100";
    EXPECT_EQ(curves[2].breaks_at, 100.0);
    EXPECT_TRUE(std::isnan(curves[2].points[1].error)) << "half a result is none";
    EXPECT_EQ(sweeps.breaks(),
              "Larger (size): lost fails from 100 on, growing fails from 1e+04 on, all others are "
              "within the limit.");
}

TEST(Sweeps, SayThatAllAreWithinTheLimitOrNone) {
    Sweeps sweeps({"a", "b"}, 1.0,
                  {{"x", "Good", "x", 1, 1, [](auto, auto) { return std::vector{0.5F}; }},
                   {"y", "Bad", "y", 1, 1, [](auto, auto) { return std::vector{5.0F}; }}});
    sweeps.measure(0);
    sweeps.measure(1);
    EXPECT_EQ(sweeps.breaks(),
              "Good (x): all are within the limit. Bad (y): a and b fail from 1 on, none is within "
              "the limit everywhere.");
}

}  // namespace
}  // namespace relief
