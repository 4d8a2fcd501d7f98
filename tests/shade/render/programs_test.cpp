// SPDX-License-Identifier: Apache-2.0
// Every pair of effects that can meet: the program compiles, links, and takes from outside exactly
// what the planned table says. The proof that nothing uncalled-for is simulated.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../effects/all_features.h"
#include "effects/surface_program.h"
#include "relief/shade/error.h"
#include "render/program_cache.h"
#include "support/gl_environment.h"
#include "support/shared_data.h"

namespace relief {
namespace {

class RendererPrograms : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(RendererPrograms);

std::vector<std::string> names(const std::vector<gl::ActiveVariable>& variables) {
    std::vector<std::string> result;
    for (const gl::ActiveVariable& variable : variables)
        result.push_back(variable.name);
    return result;
}

TEST_P(RendererPrograms, OfACoveringSetTakeExactlyWhatIsPlanned) {
    for (const Features& f : test::covering_features()) {
        SCOPED_TRACE(describe(f));
        ProgramCache cache(api());
        const DrawProgram& program = *cache.get(f);
        const gl::ProgramInterface& actual = program.linked.interface();
        const PlannedInterface active{names(actual.attributes), names(actual.uniforms),
                                      actual.uniform_blocks, names(actual.samplers)};
        EXPECT_EQ(active.attributes, program.planned.attributes);
        EXPECT_EQ(active.uniforms, program.planned.uniforms);
        EXPECT_EQ(active.uniform_blocks, program.planned.uniform_blocks);
        EXPECT_EQ(active.samplers, program.planned.samplers);
    }
}

TEST_P(RendererPrograms, AreSharedByEqualFeatures) {
    ProgramCache cache(api());
    Features f;
    f.directional_lights = 1;
    f.diffuse = true;
    const auto first = cache.get(f);
    EXPECT_EQ(first, cache.get(Features(f)));
    f.directional_lights = 2;
    EXPECT_NE(first, cache.get(f));
    EXPECT_EQ(cache.size(), 2U);
}

TEST_P(RendererPrograms, NameTheFileAndLineOfAnError) {
    const test::TemporaryDirectory folder;
    const test::ScopedVariable variable("RELIEF_SHADER_DIR", folder.path().c_str());
    std::ofstream(folder / "phong.glsl")
        << "// One part replaces the embedded one.\n#part lambert\nuniform vec3 diffuse_color;\n"
           "vec3 diffuse_scattering(float n_dot_l) { return diffuse_colour * n_dot_l; }\n";
    Features f;
    f.directional_lights = 1;
    f.diffuse = true;
    ProgramCache cache(api());
    try {
        (void)cache.get(f);
        FAIL() << "a broken shader was accepted";
    } catch (const GpuError& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("phong.glsl:4"));
        EXPECT_THAT(error.what(), ::testing::HasSubstr("diffuse_colour"));
        EXPECT_THAT(error.what(), ::testing::HasSubstr("1 directional light, diffuse"));
    }
}

}  // namespace
}  // namespace relief
