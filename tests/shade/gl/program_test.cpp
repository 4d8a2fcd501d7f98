// SPDX-License-Identifier: Apache-2.0
// Programs: compiler messages, active uniforms, and the shaders of docs/tangents.md that decode
// frames, against the library's decoder.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "gl/program.h"
#include "gl/resources.h"
#include "relief/mesh/frames.h"
#include "relief/shade/renderer.h"
#include "support/gl_environment.h"
#include "support/images.h"
#include "support/invariants.h"
#include "support/shared_data.h"

namespace relief::shade::gl {
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
    EXPECT_THAT(message, HasSubstr("3"));  // The line number.
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

TEST_P(Programs, InterfaceListsOnlyUsedInputs) {
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

TEST_P(Programs, AttributesHaveTheirLocations) {
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

class FrameDecoding : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(FrameDecoding);

/// Returns the contents of the GLSL blocks of the page.
std::string shown_shaders() {
    std::ifstream page(test::source_directory() / "docs" / "tangents.md");
    std::string shaders;
    bool inside = false;
    for (std::string line; std::getline(page, line);) {
        if (line.starts_with("```"))
            inside = line == "```glsl";
        else if (inside)
            shaders += line + "\n";
    }
    return shaders;
}

/// Frames of the axes and random ones, with alternating handedness.
Frames many_frames(std::size_t count) {
    std::mt19937 random(5);
    const auto coordinate = [&] { return std::ldexp(static_cast<float>(random()), -31) - 1.0F; };
    Frames frames;
    while (frames.normals.size() < count) {
        glm::vec3 normal(coordinate(), coordinate(), coordinate());
        glm::vec3 tangent(coordinate(), coordinate(), coordinate());
        if (frames.normals.size() < count / 2) {
            normal = glm::round(normal);
            tangent = glm::round(tangent);
        }
        if (glm::length(glm::cross(normal, tangent)) < 0.1F) continue;
        normal = glm::normalize(normal);
        tangent = glm::normalize(tangent - normal * glm::dot(normal, tangent));
        frames.normals.push_back(normal);
        frames.tangents.emplace_back(tangent, frames.normals.size() % 2 == 0 ? 1.0F : -1.0F);
    }
    return frames;
}

/// A texture with a texel of four bytes for each word and a column for each frame.
Texture word_texture(const Api& api, const std::vector<std::uint32_t>& words, std::size_t stride) {
    const auto width = static_cast<int>(words.size() / stride);
    Image image = make_image(width, static_cast<int>(stride), 4, 8, ColorSpace::data);
    const auto bytes = image.as<std::uint8_t>();
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::size_t texel = i % stride * static_cast<std::size_t>(width) + i / stride;
        for (std::size_t byte = 0; byte < 4; ++byte)
            bytes[texel * 4 + byte] = static_cast<std::uint8_t>(words[i] >> (8 * byte));
    }
    return make_texture(api, image, "words", false);
}

/// Returns the tangents that the shader of the page decodes, or (normal, 0).
std::vector<glm::vec4> drawn(const Api& api, FrameEncoding encoding,
                             const std::vector<std::uint32_t>& words, bool normals) {
    const std::size_t stride = words_per_frame(encoding);
    const auto width = static_cast<int>(words.size() / stride);
    const Texture texture = word_texture(api, words, stride);
    const RenderTarget target(api, width, 1, ColorFormat::rgba32f, 1);
    const std::string read = stride == 1 ? "word(0)" : "uvec2(word(0), word(1))";
    test::cover(api,
                shown_shaders() +
                    "uniform sampler2D words;\nout vec4 color;\n"
                    "uint word(int row) {\n"
                    "    vec4 texel = texelFetch(words, ivec2(int(gl_FragCoord.x), row), 0);\n"
                    "    uvec4 bytes = uvec4(round(255.0 * texel));\n"
                    "    return bytes.x | bytes.y << 8 | bytes.z << 16 | bytes.w << 24;\n}\n"
                    "void main() {\n    vec3 normal;\n    vec4 tangent;\n    " +
                    std::string(enum_name(encoding)) + "(" + read +
                    ", normal, tangent);\n    color = " +
                    (normals ? "vec4(normal, 0.0)" : "tangent") + ";\n}\n",
                [&](const LinkedProgram& program) {
                    program.set("words", 0);
                    api->BindTexture(GL_TEXTURE_2D, texture.name());
                });
    api->BindTexture(GL_TEXTURE_2D, 0);
    const Image picture = target.read(ColorSpace::linear);
    const auto samples = picture.as<float>();
    std::vector<glm::vec4> result;
    for (std::size_t i = 0; i + 3 < samples.size(); i += 4)
        result.emplace_back(samples[i], samples[i + 1], samples[i + 2], samples[i + 3]);
    return result;
}

TEST_P(FrameDecoding, ThePagesShadersDecodeAsTheLibraryDoes) {
    const Frames frames = many_frames(4000);
    // About a dozen roundings of float, in degrees. Square roots and quotients of a shader may have
    // an error of a few units in the last place.
    constexpr double float_degrees = 6e-5;
    for (const FrameEncoding encoding : all_frame_encodings) {
        if (encoding == FrameEncoding::float32) continue;  // This encoding needs no decoder.
        Report report;
        const std::vector<std::uint32_t> words =
            encode_frames(frames.normals, frames.tangents, encoding, FrameRounding::best, report);
        const Frames expected = decode_frames(words, encoding, report);
        EXPECT_TRUE(report.empty());
        const std::vector<glm::vec4> normals = drawn(api(), encoding, words, true);
        const std::vector<glm::vec4> tangents = drawn(api(), encoding, words, false);
        ASSERT_EQ(normals.size(), frames.normals.size());
        double worst = 0.0;
        std::size_t wrong_hands = 0;
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const double normal =
                test::degrees_between(glm::dvec3(normals[i]), glm::dvec3(expected.normals[i]));
            const double tangent =
                test::degrees_between(glm::dvec3(tangents[i]), glm::dvec3(expected.tangents[i]));
            // The condition is also true for NaN.
            if (!(normal <= worst)) worst = normal;
            if (!(tangent <= worst)) worst = tangent;
            wrong_hands += tangents[i].w == frames.tangents[i].w ? 0U : 1U;
        }
        EXPECT_LE(worst, float_degrees) << enum_name(encoding);
        EXPECT_EQ(wrong_hands, 0U) << enum_name(encoding);
    }
}

}  // namespace
}  // namespace relief::shade::gl
