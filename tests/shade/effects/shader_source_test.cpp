// SPDX-License-Identifier: Apache-2.0
// Shader sources: includes and overrides, the parts of each set of effects, listings of programs,
// and lights as uniform values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <set>

#include "effects/light_rows.h"
#include "effects/shader_source.h"
#include "relief/shade/effects.h"
#include "relief/shade/renderer.h"
#include "shade/effects/feature_sets.h"
#include "support/gl_environment.h"
#include "support/labels.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

/// A folder of shader files that override the embedded ones.
class ShaderFolder : public ::testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
    }

  private:
    test::TemporaryDirectory folder_;
    test::ScopedVariable variable_{"RELIEF_SHADER_DIR", folder_.path().c_str()};
};

std::string refusal(std::string_view file, const ShaderSteps& steps) {
    try {
        (void)assemble(file, steps, {});
    } catch (const GpuError& error) {
        return error.what();
    }
    return "no refusal";
}

TEST_F(ShaderFolder, PutsFilesTogetherOnceEach) {
    write("main.glsl", "//@include \"a.glsl\"\n//@include <step>\nmain\n");
    write("a.glsl", "a\n");
    write("b.glsl", "//@include \"a.glsl\"\nb\n");
    const ShaderSource source = assemble("main.glsl", {{"step", "b.glsl"}}, {{"count", 3}});
    EXPECT_EQ(source.text, "#version 330 core\nconst int count = 3;\na\nb\nmain\n");
    EXPECT_EQ(source.parts, (std::vector<std::string>{"main.glsl", "a.glsl", "b.glsl"}));
}

TEST_F(ShaderFolder, TracksTheSourceOfEachLine) {
    write("main.glsl", "first\n//@include \"a.glsl\"\nlast\n");
    write("a.glsl", "one\ntwo\n");
    const ShaderSource source = assemble("main.glsl", {}, {});
    // Lines of the source: 1: version, 2: main.glsl:1, 3: a.glsl:1, 4: a.glsl:2, 5: main.glsl:3.
    EXPECT_EQ(with_file_names("0:4(7): error: what\n0:5(1): error: that", source),
              "a.glsl:2(7): error: what\nmain.glsl:3(1): error: that");
    EXPECT_EQ(with_file_names("0(3) : error C1008", source), "a.glsl:1 : error C1008");
}

TEST_F(ShaderFolder, LeavesOtherNumbersInMessagesAlone) {
    write("main.glsl", "x\n");
    const ShaderSource source = assemble("main.glsl", {}, {});
    for (const char* message : {"0:1(1): the version line", "0:99(1): beyond", "no number", "",
                                "10:2 is a time", "0:99999999999999999999(1)"}) {
        EXPECT_EQ(with_file_names(message, source), message);
    }
}

TEST_F(ShaderFolder, RefusesCycles) {
    write("a.glsl", "//@include \"b.glsl\"\n");
    write("b.glsl", "\n//@include \"a.glsl\"\n");
    EXPECT_EQ(refusal("a.glsl", {}),
              "shader b.glsl:2: a.glsl includes itself: a.glsl -> b.glsl -> a.glsl");
}

TEST_F(ShaderFolder, ReportsMissingFilesAndParts) {
    write("main.glsl", "\n//@include \"nowhere.glsl\"\n");
    EXPECT_EQ(refusal("main.glsl", {}),
              "shader main.glsl:2: there is no shader file 'nowhere.glsl'");
    write("main.glsl", "//@include <step>\n");
    EXPECT_EQ(refusal("main.glsl", {}), "shader main.glsl:1: no part is chosen for <step>");
    write("main.glsl", "//@include stray\n");
    EXPECT_EQ(refusal("main.glsl", {}), "shader main.glsl:1: '//@include stray' is not a marker");
    write("other.glsl", "//@include \"main.glsl\"\n");
    EXPECT_EQ(refusal("other.glsl", {}), "shader main.glsl:1: '//@include stray' is not a marker");
    EXPECT_EQ(refusal("nowhere.glsl", {}), "there is no shader file 'nowhere.glsl'");
}

TEST_F(ShaderFolder, ExtractsPartsOfFiles) {
    write("main.glsl",
          "// Comments.\n\n//@part one\n1\n\n//@part two\n//@include \"main.glsl#three\"\n2\n"
          "//@part three\n3\n");
    const ShaderSource source = assemble("main.glsl#two", {}, {});
    EXPECT_EQ(source.text, "#version 330 core\n3\n2\n");
    EXPECT_EQ(source.parts, (std::vector<std::string>{"main.glsl#two", "main.glsl#three"}));
    EXPECT_EQ(with_file_names("0:2(1): a\n0:3(1): b", source),
              "main.glsl:10(1): a\nmain.glsl:8(1): b");
    EXPECT_EQ(assemble("main.glsl#one", {}, {}).text, "#version 330 core\n1\n");
    EXPECT_EQ(refusal("main.glsl#four", {}), "there is no part 'four' in shader file 'main.glsl'");
}

TEST_F(ShaderFolder, PutsNeutralCodeInOnce) {
    write("main.glsl", "//@include <occlusion>\nfirst\n//@include <occlusion>\nlast\n");
    const ShaderSource source = assemble("main.glsl", {}, {});
    EXPECT_EQ(source.text, "#version 330 core\nfloat occlusion() { return 1.0; }\nfirst\nlast\n");
    EXPECT_EQ(source.parts, (std::vector<std::string>{"main.glsl"}));
    EXPECT_THAT(with_file_names("0:2(1): neutral; 0:4(1): here", source),
                MatchesRegex("ambient.glsl:[0-9]+\\(1\\): neutral; main.glsl:4\\(1\\): here"));
}

TEST_F(ShaderFolder, OverridesNeutralCode) {
    write("main.glsl", "//@include <occlusion>\n");
    write("ambient.glsl", "//@neutral occlusion\nmine\n");
    EXPECT_EQ(assemble("main.glsl", {}, {}).text, "#version 330 core\nmine\n");
}

TEST_F(ShaderFolder, RefusesCodeThatIsInNoPart) {
    write("main.glsl", "// A comment.\nuniform float x;\n//@part one\n1\n");
    EXPECT_EQ(refusal("main.glsl#one", {}), "shader main.glsl:2: code before the first //@part");
    write("main.glsl", "#part one\n1\n");
    EXPECT_EQ(refusal("main.glsl#one", {}), "shader main.glsl: no line begins with //@part");
    write("surface.frag.glsl", "//@part one\n1\n");
    EXPECT_EQ(refusal("surface.frag.glsl", {}),
              "shader surface.frag.glsl: a file of one part has no //@part");
}

TEST_F(ShaderFolder, OverridesEmbeddedPartsOneByOne) {
    const std::string embedded = assemble("phong.glsl#receive", {}, {}).text;
    EXPECT_THAT(embedded, HasSubstr("void receive("));
    EXPECT_THAT(assemble("phong.glsl#lambert", {}, {}).text, HasSubstr("diffuse_color"));
    write("phong.glsl", "//@part lambert\nmine\n");
    EXPECT_EQ(assemble("phong.glsl#lambert", {}, {}).text, "#version 330 core\nmine\n");
    EXPECT_EQ(assemble("phong.glsl#receive", {}, {}).text, embedded);
}

TEST_F(ShaderFolder, GivesGlobalVariablesTheirValuesInMainOfGlslEs) {
    write("main.glsl",
          "in vec2 at;\nvec4 looked_up = texture(map, at);  // A lookup.\n"
          "const float kept = 1.0;\nfloat f(float x) { float y = x; return y; }\n"
          "//@include <buffers>\nvoid main() {\n    color = looked_up;\n}\n");
    const ShaderSource source = assemble("main.glsl", {}, {{"count", 3}}, GlslVersion::es_300);
    EXPECT_THAT(source.text, StartsWith("#version 300 es\n"));
    EXPECT_THAT(source.text, HasSubstr("precision highp float;\n"));
    EXPECT_THAT(
        source.text,
        HasSubstr("const int count = 3;\nin vec2 at;\nvec4 looked_up;\n"
                  "const float kept = 1.0;\nfloat f(float x) { float y = x; return y; }\n"));
    EXPECT_THAT(source.text, HasSubstr("#define samplerBuffer sampler2D\n"));
    EXPECT_THAT(source.text, EndsWith("void main() {\n    looked_up = texture(map, at);\n"
                                      "    color = looked_up;\n}\n"));
    write("other.glsl", "float x = f();\nvoid main() { color = x; }\n");
    EXPECT_THROW((void)assemble("other.glsl", {}, {}, GlslVersion::es_300), GpuError);
    EXPECT_EQ(source.lines.size(), std::count(source.text.begin(), source.text.end(), '\n'));
}

TEST(EmbeddedShaders, AreTheFilesOfTheProject) {
    std::size_t files = 0;
    const std::filesystem::path folder = test::source_directory() / "shaders";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".glsl") ++files;
    }
    EXPECT_EQ(embedded_shaders().size(), files);
    for (const EmbeddedShader& shader : embedded_shaders()) {
        std::ifstream file(folder / shader.name);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        EXPECT_EQ(shader.text, text) << shader.name;
        EXPECT_THAT(text, ::testing::StartsWith("// SPDX-License-Identifier: Apache-2.0\n//"));
    }
}

/// Returns the names of the functions in which GLSL calls one of some functions; outside of
/// functions, "".
std::set<std::string> callers_of(const std::string& text, const std::string& functions) {
    const std::string code = std::regex_replace(text, std::regex("(//|#)[^\n]*"), "");
    const std::regex token("\\b(" + functions + ")\\s*\\(|(\\w+)\\s*\\([^(){};]*\\)\\s*\\{|[{}]");
    std::set<std::string> callers;
    std::string function;
    int depth = 0;
    for (std::sregex_iterator match(code.begin(), code.end(), token), end; match != end; ++match) {
        const std::string found = match->str();
        if (found == "}") {
            --depth;
        } else if ((*match)[1].matched) {
            callers.insert(depth == 0 ? "" : function);
        } else {
            if (depth == 0) function = (*match)[2];
            ++depth;
        }
    }
    return callers;
}

/// A lookup that chooses its mip level takes differences between the pixels of a block of four.
/// OpenGL 3.3 defines them only where all four come along: not in a branch, after a return that
/// depends on the pixel, or after a discard. Lookups are therefore the initial values of global
/// variables, and discarding is the last step.
TEST(EmbeddedShaders, ComputeDerivativesInUniformControlFlow) {
    const std::set<std::string> allowed = {
        "",                      // The initial value of a global variable.
        "derived_frame",         // Called for such a value.
        "normal_of_heights",     // Called for such a value.
        "height_beside",         // Called by normal_of_heights().
        "environment_radiance",  // Called in each pixel by what mirrors, refracts and is seen.
        "visible_share",         // Called for each light; shadow maps have one level.
    };
    std::size_t lookups = 0;
    for (const EmbeddedShader& shader : embedded_shaders()) {
        const std::string text(shader.text);
        for (const std::string& caller : callers_of(text, "texture|dFdx|dFdy|fwidth")) {
            EXPECT_TRUE(allowed.contains(caller)) << shader.name << ": " << caller;
            ++lookups;
        }
        // The level is the same in all pixels.
        EXPECT_FALSE(
            std::regex_search(text, std::regex("textureSize\\((?!\\w+, 0\\))[^)\n]*,[^)]*\\)")))
            << shader.name;
        const bool discards = text.find("discard;") != std::string::npos;
        EXPECT_EQ(discards, shader.name == "alpha.glsl" || shader.name == "height_edge.glsl" ||
                                shader.name == "overlay.glsl")
            << shader.name;
    }
    EXPECT_GT(lookups, 15U);
    for (const char* main_shader : {"surface.frag.glsl", "unlit.frag.glsl", "data.frag.glsl"}) {
        const auto shader =
            std::find_if(embedded_shaders().begin(), embedded_shaders().end(),
                         [&](const EmbeddedShader& each) { return each.name == main_shader; });
        ASSERT_NE(shader, embedded_shaders().end());
        EXPECT_TRUE(
            std::string(shader->text).ends_with("    cut_holes();\n    cut_silhouette();\n}\n"))
            << main_shader;
    }
}

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

TEST(ShaderListings, AreEmptyWithoutDraws) {
    EXPECT_TRUE(shader_listings({}).empty());
}

TEST_LABELS(not_sanitized);
TEST(SurfaceProgram, ComesTogetherForEveryCanonicalSet) {
    test::for_random_features(5000, [](const Features& f) {
        ASSERT_NO_THROW((void)surface_program(canonical(f))) << describe(f);
    });
}

/// Returns the parts that the steps of a stage name and its source does not contain.
std::vector<std::string> unused_parts(const ShaderSteps& steps, const ShaderSource& source) {
    const std::set<std::string> parts(source.parts.begin(), source.parts.end());
    std::vector<std::string> unused;
    for (const auto& [step, part] : steps) {
        if (!parts.contains(std::string(part))) unused.emplace_back(part);
    }
    return unused;
}

TEST(SurfaceProgram, ChoosesNoPartThatItDoesNotUse) {
    // These parts implement a step in every program, even if it is unused. They have no inputs.
    const std::set<std::string> idle = {"inputs.glsl#position", "color.glsl#tint",
                                        "metallic_roughness.glsl#tint"};
    for (const Features& f : test::covering_features()) {
        const SurfaceProgram program = surface_program(f);
        const ChosenSteps steps = chosen_steps(f);
        for (const auto& [chosen, source] : {std::pair(steps.vertex, program.vertex),
                                             std::pair(steps.fragment, program.fragment)}) {
            for (const std::string& part : unused_parts(chosen, source)) {
                EXPECT_TRUE(idle.contains(part)) << describe(f) << " chooses " << part;
            }
        }
    }
}

TEST(SurfaceProgram, DiffuseSurfaceHasNoOtherCode) {
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

TEST(SurfaceProgram, HasNeutralCodeForAnAbsentEffect) {
    Features f;
    f.ambient = true;
    const std::string neutral = "\nfloat occlusion() { return 1.0; }\n";
    EXPECT_FALSE(chosen_steps(f).fragment.contains("occlusion"));
    EXPECT_THAT(surface_program(f).fragment.text, HasSubstr(neutral));
    f.occlusion_texture = true;
    EXPECT_EQ(chosen_steps(f).fragment.at("occlusion"), "ambient.glsl#occlusion");
    EXPECT_THAT(surface_program(f).fragment.text, Not(HasSubstr(neutral)));
}

TEST(PlannedInterface, IsKnownByHandForANormalMappedSurface) {
    Features f;
    f.directional_lights = 2;
    f.diffuse = true;
    f.detail = NormalDetail::normal_map;
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

TEST(PlannedInterface, EmptyPlanHasOnlyThePosition) {
    const PlannedInterface planned = planned_interface(Features{});
    EXPECT_EQ(planned.attributes, (std::vector<std::string>{"position_object"}));
    EXPECT_EQ(planned.uniforms, (std::vector<std::string>{"clip_from_object"}));
    EXPECT_TRUE(planned.samplers.empty());
    EXPECT_TRUE(planned.uniform_blocks.empty());
}

TEST(CoveringFeatures, MeetEveryPairThatCanMeet) {
    const std::vector<Features> covering = test::covering_features();
    EXPECT_GE(covering.size(), 16U);  // Two fields with four values each.
    EXPECT_LE(covering.size(), 200U);
    const auto met = [&](const auto& condition) {
        return std::any_of(covering.begin(), covering.end(), condition);
    };
    // Pairs that a careless choice would miss.
    EXPECT_TRUE(met(
        [](const Features& f) { return f.lights_in_buffer && f.specular == SpecularTerm::phong; }));
    EXPECT_TRUE(met([](const Features& f) {
        return f.interpolation == Interpolation::gouraud && f.fresnel == FresnelTerm::conductor;
    }));
    EXPECT_TRUE(met([](const Features& f) {
        return f.metallic_roughness && f.frame == TangentFrame::derivatives;
    }));
    EXPECT_TRUE(met([](const Features& f) {
        return f.alpha == AlphaMode::mask && f.detail == NormalDetail::bump_map;
    }));
}

Features counts(std::uint32_t directional, std::uint32_t point, std::uint32_t spot) {
    Features f;
    f.directional_lights = directional;
    f.point_lights = point;
    f.spot_lights = spot;
    return f;
}

TEST(LightRows, HoldEveryKindInOrder) {
    Scene scene;
    scene.directional_lights = {{{0, -2, 0}, {1, 2, 3}}};
    scene.point_lights = {{{4, 5, 6}, {7, 8, 9}, std::nullopt}, {{1, 1, 1}, {2, 2, 2}, 4.0F}};
    const std::vector<glm::vec4> rows = light_rows(scene, counts(1, 2, 0));
    ASSERT_EQ(rows.size(), 6U);
    EXPECT_EQ(rows[0], glm::vec4(0, 1, 0, 0));  // The unit vector to the light.
    EXPECT_EQ(rows[1], glm::vec4(1, 2, 3, 0));
    EXPECT_EQ(rows[2], glm::vec4(4, 5, 6, 0));
    EXPECT_EQ(rows[3], glm::vec4(7, 8, 9, 1));  // The inverse square law.
    EXPECT_EQ(rows[4], glm::vec4(1, 1, 1, 0.25F));
    const LightRowLayout layout = light_row_layout(counts(1, 2, 0));
    EXPECT_EQ(layout.first_point, 2U);
    EXPECT_EQ(layout.first_spot, 6U);
    EXPECT_EQ(layout.count, 6U);
}

TEST(LightRows, SpotFadesFromTheInnerToTheOuterCone) {
    Scene scene;
    SpotLight spot;
    spot.direction_world = {0, 0, -3};
    spot.inner_cone = 0.25F;
    spot.outer_cone = 0.5F;
    scene.spot_lights = {spot};
    const std::vector<glm::vec4> rows = light_rows(scene, counts(0, 0, 1));
    ASSERT_EQ(rows.size(), 3U);
    const auto share = [&](float angle) { return std::cos(angle) * -rows[2].z + rows[2].w; };
    // Cosines near 1 in float, times a scale of 11, have an error of about 1e-6.
    EXPECT_NEAR(share(0.25F), 1.0F, 1e-5F);
    EXPECT_NEAR(share(0.5F), 0.0F, 1e-5F);
    EXPECT_EQ(glm::vec2(rows[2]), glm::vec2(0, 0));
}

TEST(LightRows, LeaveBlackLightsOut) {
    Scene scene;
    scene.directional_lights = {{{0, -1, 0}, {0, 0, 0}}, {{1, 0, 0}, {1, 1, 1}}};
    const std::vector<glm::vec4> rows = light_rows(scene, counts(1, 0, 0));
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0], glm::vec4(-1, 0, 0, 0));
}

TEST(LightRows, ForcedLightsAreBlack) {
    const std::vector<glm::vec4> rows = light_rows(Scene{}, counts(1, 1, 1));
    ASSERT_EQ(rows.size(), 7U);
    for (const glm::vec4& row : rows)
        EXPECT_EQ(row, glm::vec4(0));
}

TEST(LightRows, MarkLightsWithoutFalloff) {
    Scene scene;
    scene.point_lights = {{{4, 5, 6}, {7, 8, 9}, std::nullopt, Falloff::none}};
    EXPECT_EQ(light_rows(scene, counts(0, 1, 0))[1], glm::vec4(7, 8, 9, 0));
}

TEST(LightRows, HaveColorsOfHighlightsIfTheyDiffer) {
    Scene scene;
    scene.directional_lights = {{{0, -1, 0}, {1, 1, 1}, glm::vec3(0.5F)}};
    scene.point_lights = {{{4, 5, 6}, {7, 8, 9}}};
    scene.spot_lights = {SpotLight{{{1, 2, 3}, {0, 0, 0}}}};
    // This light has only a highlight.
    scene.spot_lights[0].point.highlight_intensity = glm::vec3(3.0F);
    Features f = counts(1, 1, 1);
    f.highlight_colors = true;
    const std::vector<glm::vec4> rows = light_rows(scene, f);
    ASSERT_EQ(rows.size(), 10U);
    EXPECT_EQ(rows[2], glm::vec4(0.5F, 0.5F, 0.5F, 0));
    EXPECT_EQ(rows[5], glm::vec4(7, 8, 9, 0));
    EXPECT_EQ(rows[9], glm::vec4(3, 3, 3, 0));
    EXPECT_EQ(light_row_layout(f).first_spot, 6U);
}

TEST(LightRows, MakeDirectionsOfAnyLengthUnit) {
    Scene scene;
    scene.directional_lights = {{{0, -1e-30F, 0}, {1, 1, 1}}, {{3e38F, 0, 0}, {1, 1, 1}}};
    const std::vector<glm::vec4> rows = light_rows(scene, counts(2, 0, 0));
    EXPECT_EQ(rows[0], glm::vec4(0, 1, 0, 0));
    EXPECT_EQ(rows[2], glm::vec4(-1, 0, 0, 0));
}

}  // namespace
}  // namespace relief
