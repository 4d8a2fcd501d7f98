// SPDX-License-Identifier: Apache-2.0
// The table of shader parts: for every canonical set of effects each step has one file, and the
// sources come together.
#include "effects/surface_program.h"

#include <gtest/gtest.h>

#include <set>

#include "all_features.h"

namespace relief {
namespace {

std::set<Features> canonical_sets() {
    std::set<Features> sets;
    test::for_all_features([&](const Features& f) { sets.insert(canonical(f)); });
    return sets;
}

TEST(SurfaceProgram, ComesTogetherForEveryCanonicalSet) {
    // Sets with the same files differ in numbers alone: one of them is put together.
    std::set<ShaderSteps> seen;
    for (const Features& f : canonical_sets()) {
        if (!seen.insert(chosen_steps(f)).second) continue;
        if (f.output != OutputCoding::srgb) continue;
        ASSERT_NO_THROW((void)surface_program(f)) << describe(f);
    }
    EXPECT_GT(seen.size(), 1000U);
}

TEST(SurfaceProgram, ChoosesNoFileThatItDoesNotUse) {
    for (const Features& f : test::covering_features()) {
        const SurfaceProgram program = surface_program(f);
        std::set<std::string> files(program.vertex.files.begin(), program.vertex.files.end());
        files.insert(program.fragment.files.begin(), program.fragment.files.end());
        for (const auto& [step, file] : chosen_steps(f)) {
            const bool general = file.starts_with("absent/");
            if (!general && f.unlit) continue;
            if (!general && !files.contains(std::string(file))) {
                FAIL() << describe(f) << " chooses " << file << " for nothing";
            }
        }
    }
}

TEST(SurfaceProgram, OfADiffuseSurfaceHasNoCodeForAnythingElse) {
    Features f;
    f.directional_lights = 1;
    f.diffuse = true;
    const SurfaceProgram program = surface_program(f);
    for (const char* absent : {"texture(", "sampler", "tangent", "eye_world", "exp(", "pow_",
                               "shininess", "reflect(", "emission_color", "position_world"}) {
        EXPECT_EQ(program.fragment.text.find(absent), std::string::npos) << absent;
        EXPECT_EQ(program.vertex.text.find(absent), std::string::npos) << absent;
    }
}

TEST(PlannedInterface, IsKnownByHandForANormalMappedSurface) {
    Features f;
    f.directional_lights = 2;
    f.diffuse = true;
    f.normal_map = true;
    const PlannedInterface planned = planned_interface(f);
    using Names = std::vector<std::string>;
    EXPECT_EQ(planned.attributes,
              (Names{"normal_object", "position_object", "tangent_object", "texcoord"}));
    EXPECT_EQ(planned.uniforms,
              (Names{"clip_from_object", "diffuse_color", "handedness", "normal_map_bias",
                     "normal_map_scale", "world_from_object_normal", "world_from_object_tangent"}));
    EXPECT_EQ(planned.samplers, (Names{"normal_texture"}));
    EXPECT_EQ(planned.uniform_blocks, (Names{"Lights"}));
}

TEST(PlannedInterface, OfNothingIsThePositionAlone) {
    const PlannedInterface planned = planned_interface(Features{});
    EXPECT_EQ(planned.attributes, (std::vector<std::string>{"position_object"}));
    EXPECT_EQ(planned.uniforms, (std::vector<std::string>{"clip_from_object"}));
    EXPECT_TRUE(planned.samplers.empty());
    EXPECT_TRUE(planned.uniform_blocks.empty());
}

TEST(CoveringFeatures, MeetEveryPairThatCanMeet) {
    const std::vector<Features> covering = test::covering_features();
    EXPECT_GE(covering.size(), 9U);
    EXPECT_LE(covering.size(), 120U);
    // One pair by hand that a careless choice would miss.
    const bool met = std::any_of(covering.begin(), covering.end(), [](const Features& f) {
        return f.lights_in_buffer && f.specular == SpecularTerm::phong && f.normal_map;
    });
    EXPECT_TRUE(met);
}

}  // namespace
}  // namespace relief
