// SPDX-License-Identifier: Apache-2.0
// canonical() over every set of effects, and by hand.
#include <gtest/gtest.h>

#include "all_features.h"

namespace relief {
namespace {

Features lit() {
    Features f;
    f.directional_lights = 1;
    f.diffuse = true;
    return f;
}

TEST(CanonicalFeatures, AreAFixedPointForEverySet) {
    std::size_t count = 0;
    std::size_t fixed = 0;
    test::for_all_features([&](const Features& f) {
        const Features once = canonical(f);
        ++count;
        if (once == f) ++fixed;
        if (canonical(once) != once) ADD_FAILURE() << describe(f);
    });
    EXPECT_EQ(count, 2048U * 54U * 9U);
    EXPECT_LT(fixed, count / 4);  // Most sets hold something that cannot show.
}

TEST(CanonicalFeatures, HoldNothingThatCannotShow) {
    test::for_all_features([](const Features& f) {
        const Features c = canonical(f);
        const bool lights = c.directional_lights + c.point_lights + c.spot_lights > 0;
        const bool uses_lights = c.diffuse || c.specular != SpecularTerm::none;
        const bool uses_normal = uses_lights || c.reflection;
        const bool sound =
            lights == uses_lights && (uses_normal || !c.normal_map) &&
            (uses_normal || !c.double_sided) && (lights || !c.lights_in_buffer) &&
            (c.point_lights + c.spot_lights > 0 || !c.light_ranges) &&
            (c.emission || !c.emission_texture) &&
            (c.unlit || c.ambient || c.diffuse || (!c.diffuse_texture && !c.vertex_colors)) &&
            !(c.unlit && (lights || uses_normal || c.ambient || c.emission)) &&
            c.output == f.output;
        if (!sound) ADD_FAILURE() << describe(f) << " became " << describe(c);
    });
}

TEST(CanonicalFeatures, AddNothing) {
    test::for_all_features([](const Features& f) {
        const Features c = canonical(f);
        const bool adds = (c.diffuse_texture && !f.diffuse_texture) ||
                          (c.normal_map && !f.normal_map) || (c.diffuse && !f.diffuse) ||
                          (c.reflection && !f.reflection) || (c.emission && !f.emission) ||
                          c.directional_lights > f.directional_lights ||
                          (c.specular != SpecularTerm::none && c.specular != f.specular);
        if (adds) ADD_FAILURE() << describe(f) << " became " << describe(c);
    });
}

TEST(CanonicalFeatures, WithoutLightHaveNoNormalMap) {
    Features f = lit();
    f.normal_map = true;
    EXPECT_TRUE(canonical(f).normal_map);
    f.directional_lights = 0;
    EXPECT_EQ(canonical(f), Features{});
    f.reflection = true;  // A reflection shows the normal too.
    EXPECT_TRUE(canonical(f).normal_map);
}

TEST(CanonicalFeatures, OfABlackSurfaceHaveNoLights) {
    Features f = lit();
    f.diffuse = false;
    f.diffuse_texture = true;
    EXPECT_EQ(canonical(f), Features{});
}

TEST(CanonicalFeatures, PutManyLightsIntoABuffer) {
    Features f = lit();
    f.directional_lights = 512;  // Two rows each: exactly the 1024 that a block holds.
    EXPECT_FALSE(canonical(f).lights_in_buffer);
    f.directional_lights = 513;
    EXPECT_TRUE(canonical(f).lights_in_buffer);
}

TEST(Features, AreDescribedInWords) {
    Features f = lit();
    f.point_lights = 2;
    f.specular = SpecularTerm::blinn_phong;
    EXPECT_EQ(describe(f), "1 directional light, 2 point lights, diffuse, Blinn-Phong, sRGB");
}

}  // namespace
}  // namespace relief
