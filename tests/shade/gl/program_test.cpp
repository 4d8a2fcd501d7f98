// SPDX-License-Identifier: Apache-2.0
// Programs: what the driver says of a bad one, and what it kept of a good one.
#include "gl/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gl/resources.h"
#include "relief/shade/error.h"
#include "support/gl_environment.h"
#include "support/samples.h"

namespace relief::gl {
namespace {

using test::samples_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Programs : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(Programs);

constexpr const char* vertex_shader = R"(#version 330 core
in vec3 position_object;
in vec2 texcoord;
in vec3 never_read;
uniform mat4 clip_from_object;
uniform float never_used;
out vec2 st;
void main() {
    st = texcoord;
    gl_Position = clip_from_object * vec4(position_object, 1.0) * float(gl_VertexID + 1);
}
)";

constexpr const char* fragment_shader = R"(#version 330 core
in vec2 st;
struct Light { vec3 direction; vec3 color; };
uniform Light lights[2];
uniform vec4 kernel[3];
uniform vec3 tint;
uniform int count;
uniform sampler2D picture;
uniform samplerCube surroundings;
layout(std140) uniform Frame { vec4 ambient; vec4 fog; };
out vec4 color;
void main() {
    vec3 sum = ambient.rgb + tint * texture(picture, st).rgb + texture(surroundings, tint).rgb;
    for (int i = 0; i < 2; ++i) sum += lights[i].color * dot(lights[i].direction, tint);
    for (int i = 0; i < 3; ++i) sum += kernel[i].xyz * float(count);
    color = vec4(sum, 1.0);
}
)";

ProgramSources sources() {
    return {"test", vertex_shader, fragment_shader, {{"position_object", 3}, {"texcoord", 5}}, {}};
}

std::vector<std::string> names(const std::vector<ActiveVariable>& variables) {
    std::vector<std::string> result;
    for (const ActiveVariable& variable : variables)
        result.push_back(variable.name);
    return result;
}

std::string link_error(const Api& api, const ProgramSources& bad) {
    try {
        const LinkedProgram program(api, bad);
        return "no error";
    } catch (const GpuError& error) {
        return error.what();
    }
}

TEST_P(Programs, AnErrorNamesProgramStageLineAndTheDriversReason) {
    ProgramSources bad = sources();
    bad.fragment = "#version 330 core\nout vec4 color;\nvoid main() { color = nonsense; }\n";
    const std::string message = link_error(api(), bad);
    EXPECT_THAT(message, HasSubstr("program 'test': fragment shader: "));
    EXPECT_THAT(message, HasSubstr("nonsense"));
    EXPECT_THAT(message, HasSubstr("3"));  // The line.
    bad = sources();
    bad.vertex = "#version 330 core\nvoid main( { }\n";
    EXPECT_THAT(link_error(api(), bad), HasSubstr("program 'test': vertex shader: "));
}

TEST_P(Programs, StagesThatDoNotFitAreAnErrorOfLinking) {
    ProgramSources bad = sources();
    bad.fragment =
        "#version 330 core\nin vec3 st;\nout vec4 color;\nvoid main() { color = vec4(st, 1.0); }\n";
    const std::string message = link_error(api(), bad);
    EXPECT_THAT(message, HasSubstr("program 'test': linking: "));
    EXPECT_THAT(message, HasSubstr("st"));
}

TEST_P(Programs, AnEmptySourceIsAnErrorNotACrash) {
    ProgramSources bad = sources();
    bad.fragment.clear();
    EXPECT_THAT(link_error(api(), bad), HasSubstr("program 'test': "));
}

TEST_P(Programs, TheInterfaceListsWhatIsUsedAndNothingElse) {
    const LinkedProgram program(api(), sources());
    const ProgramInterface& interface = program.interface();
    EXPECT_THAT(names(interface.attributes), ElementsAre("position_object", "texcoord"));
    EXPECT_THAT(
        names(interface.uniforms),
        ElementsAre("clip_from_object", "count", "kernel", "lights[0].color", "lights[0].direction",
                    "lights[1].color", "lights[1].direction", "tint"));
    EXPECT_THAT(names(interface.samplers), ElementsAre("picture", "surroundings"));
    EXPECT_THAT(interface.uniform_blocks, ElementsAre("Frame"));
    EXPECT_EQ(interface.uniforms[2].size, 3);
    EXPECT_EQ(interface.samplers[1].type, GLenum{GL_SAMPLER_CUBE});
}

TEST_P(Programs, AttributesStandWhereTheyWerePut) {
    const LinkedProgram program(api(), sources());
    EXPECT_EQ(program.interface().attributes[0].location, 3);
    EXPECT_EQ(program.interface().attributes[1].location, 5);
}

TEST_P(Programs, UniformsTakeTheirValuesAndAbsentOnesAreFalse) {
    const LinkedProgram program(api(), sources());
    program.use();
    EXPECT_TRUE(program.set("tint", glm::vec3(1, 2, 3)));
    EXPECT_TRUE(program.set("count", 7));
    EXPECT_TRUE(program.set("surroundings", 4));
    EXPECT_TRUE(program.set("lights[1].color", glm::vec3(4, 5, 6)));
    EXPECT_TRUE(program.set("clip_from_object", glm::mat4(2.0F)));
    const std::vector<glm::vec4> kernel{{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}};
    EXPECT_TRUE(program.set("kernel", std::span(kernel)));
    EXPECT_FALSE(program.set("never_used", 1.0F));
    EXPECT_FALSE(program.set("no such name", glm::vec3(1)));

    glm::vec3 tint{};
    api()->GetUniformfv(program.name(), api()->GetUniformLocation(program.name(), "tint"), &tint.x);
    EXPECT_EQ(tint, glm::vec3(1, 2, 3));
    glm::vec4 last{};
    api()->GetUniformfv(program.name(), api()->GetUniformLocation(program.name(), "kernel[2]"),
                        &last.x);
    EXPECT_EQ(last, glm::vec4(9, 10, 11, 12));
    GLint unit = 0;
    api()->GetUniformiv(program.name(), api()->GetUniformLocation(program.name(), "surroundings"),
                        &unit);
    EXPECT_EQ(unit, 4);
}

TEST_P(Programs, AValueOfAnotherTypeOrTooManyAreRefused) {
    const LinkedProgram program(api(), sources());
    program.use();
    EXPECT_THROW(program.set("tint", glm::vec4(1)), GpuError);
    EXPECT_THROW(program.set("count", 1.0F), GpuError);
    const std::vector<glm::vec4> four(4);
    EXPECT_THROW(program.set("kernel", std::span(four)), GpuError);
    EXPECT_TRUE(program.set("kernel", std::span<const glm::vec4>{}));
}

TEST_P(Programs, ABlockReadsTheBufferAtItsBindingPoint) {
    const RenderTarget target(api(), 1, 1, ColorFormat::rgba32f, 1);
    const Buffer block = make_buffer(api(), std::vector<glm::vec4>{{0.5F, 2, 3, 4}}, "block");
    api()->BindBufferBase(GL_UNIFORM_BUFFER, 2, block.name());
    test::cover(api(),
                "layout(std140) uniform Frame { vec4 ambient; };\n"
                "out vec4 color;\nvoid main() { color = ambient; }\n",
                [](const LinkedProgram& program) {
                    EXPECT_TRUE(program.bind_block("Frame", 2));
                    EXPECT_FALSE(program.bind_block("Absent", 2));
                });
    EXPECT_THAT(samples_of<float>(target.read(ColorSpace::linear)), ElementsAre(0.5F, 2, 3, 4));
}

}  // namespace
}  // namespace relief::gl
