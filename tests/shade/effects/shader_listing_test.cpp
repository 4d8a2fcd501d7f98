// SPDX-License-Identifier: Apache-2.0
// A plan's programs as text: one for each set of effects, and nothing in it of effects that are
// absent.
#include "relief/shade/shader_listing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace relief {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(ShaderListings, HoldEachProgramOnceWithItsDraws) {
    FramePlan plan;
    plan.draws.resize(3);
    plan.draws[1].features.emission = true;
    const std::vector<ShaderListing> listings = shader_listings(plan);
    ASSERT_EQ(listings.size(), 2U);
    EXPECT_THAT(listings[0].draws, ElementsAre(0, 2));
    EXPECT_THAT(listings[1].draws, ElementsAre(1));
    EXPECT_THAT(listings[0].vertex, StartsWith("#version 330 core\n"));
    EXPECT_THAT(listings[0].fragment, Not(HasSubstr("emission_color")));
    EXPECT_THAT(listings[1].fragment, HasSubstr("uniform vec3 emission_color;"));
    EXPECT_THAT(listings[1].files, Contains("emission.glsl#color"));
    EXPECT_THAT(listings[1].files, Contains("surface.vert.glsl"));
    EXPECT_TRUE(std::is_sorted(listings[1].files.begin(), listings[1].files.end()));
}

TEST(ShaderListings, OfNoDrawsAreNone) {
    EXPECT_TRUE(shader_listings({}).empty());
}

}  // namespace
}  // namespace relief
