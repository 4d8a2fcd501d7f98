// SPDX-License-Identifier: Apache-2.0
// The reasons that the planner gives for its decisions.
#include <gtest/gtest.h>

#include <vector>

#include "relief/shade/effects.h"
#include "shade/effects/feature_sets.h"
#include "shade/effects/scene_changes.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::reason;

TEST(EffectPlan, NamesTheReason) {
    using namespace test::changes;
    struct Decision {
        const char* effect;
        std::vector<Change> changes;
        const char* reason;
    };
    const std::vector<Decision> decisions = {
        {"alpha mask", {}, "material 'body' is opaque"},
        {"alpha mask", {masked}, "material 'body' is covered everywhere"},
        {"alpha mask",
         {masked, translucent},
         "material 'body' has holes where alpha is below its cutoff"},
        {"alpha blending", {blended}, "material 'body' is covered everywhere"},
        {"alpha blending",
         {blended, translucent},
         "material 'body' is blended with what is behind it"},
        {"no falloff", {constant_light}, "no light falls off with distance"},
        {"no falloff", {point_light}, "every light falls off with the squared distance"},
        {"no falloff", {point_light, constant_light}, "some lights fall off with distance"},
        {"mixed falloff", {point_light}, "all lights follow one law"},
        {"mixed falloff", {constant_light}, "all lights follow one law"},
        {"mixed falloff",
         {point_light, constant_light},
         "some lights fall off with distance and some do not"},
        {"morphing", {}, "the mesh has no morph targets"},
        {"morphing", {morph_target}, "the weights of all morph targets are 0"},
        {"morphing", {morph_target, morphed}, "morph targets with a weight: 1 of 1"},
        {"skinning", {morph_target}, "the mesh has no joints"},
        {"skinning", {joints}, "all joints are at rest"},
        {"skinning", {joints, moved_joint}, "joints move the vertices"},
        {"ambient", {}, "the scene has no ambient light"},
        {"ambient", {ambient}, "material 'body' scatters ambient light"},
        {"ambient", {ambient, black_surface}, "material 'body' scatters none"},
        {"ambient", {ambient, black_surface, physical}, "material 'body' scatters ambient light"},
        {"dielectric reflectance", {}, "material 'body' is Phong's model"},
        {"dielectric reflectance", {no_metal}, "material 'body' reflects the 4% of the index 1.5"},
        {"dielectric reflectance",
         {denser},
         "material 'body' has an index, weight or color of its own"},
        {"dielectric reflectance",
         {denser, with(&MetallicRoughness::metallic, 1.0F)},
         "material 'body' is a metal everywhere"},
        {"energy compensation", {}, "material 'body' is Phong's model"},
        {"energy compensation",
         {smooth_dielectric},
         "material 'body' is a smooth dielectric, which loses less than 1% of what it mirrors"},
        {"energy compensation",
         {physical},
         "material 'body' loses light that bounces between its facets"},
        {"energy compensation",
         {physical, no_suns, ambient},
         "the material is not metallic-roughness, or reflects nothing"},
        {"sheen", {}, "material 'body' has none"},
        {"sheen", {sheen}, "material 'body' has a sheen color"},
        {"sheen",
         {sheen, no_suns},
         "the material is not metallic-roughness, or no light reaches it"},
        {"clearcoat", {clearcoat}, "material 'body' has a clear coat"},
        {"environment light", {}, "the scene has no environment"},
        {"environment light", {environment}, "the environment does not light surfaces"},
        {"environment light", {environment, scattered, black_surface}, "material 'body' is black"},
        {"environment rotation", {}, "the scene has no environment"},
        {"environment rotation", {environment, mirror}, "the environment is not rotated"},
        {"environment rotation", {environment, mirror, rotated}, "the environment is rotated"},
        {"environment rotation",
         {environment, rotated},
         "the surface neither mirrors the environment nor refracts it"},
        {"refraction", {}, "material 'body' transmits no light"},
        {"refraction", {transmitting}, "the scene has no environment"},
        {"mirror reflection", {}, "material 'body' reflects nothing"},
        {"mirror reflection", {mirror}, "the scene has no environment"},
        {"ACES tone mapping", {}, "radiance above 1 is shown as 1"},
        {"ACES tone mapping", {reinhard}, "the scene requests another curve"},
    };
    for (const Decision& decision : decisions) {
        test::changes::Frame frame;
        for (const Change& change : decision.changes)
            change(frame);
        const FramePlan plan = plan_effects(frame.scene, frame.settings);
        EXPECT_EQ(reason(plan.draws.at(0).reasons, decision.effect).reason, decision.reason);
    }
}

}  // namespace
}  // namespace relief
