// SPDX-License-Identifier: Apache-2.0
// The shaders of docs/tangents.md that decode frames, compiled as they stand there, against the
// library's decoder: same frames, same hands.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "gl/resources.h"
#include "relief/mesh/frame_encoding.h"
#include "support/angle.h"
#include "support/gl_environment.h"
#include "support/shared_data.h"

namespace relief::gl {
namespace {

class FrameDecoding : public test::GlTest {};
RELIEF_ON_DEFAULT_BACKEND(FrameDecoding);

/// What stands in the page's blocks of GLSL.
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

/// Frames of the axes and random ones, of both hands, by turns.
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

/// Each word as a texel of four bytes; a frame is a column.
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

/// The tangents as decoded by the page's shader, or (normal, 0).
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
                    std::string(name_of(encoding)) + "(" + read +
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
    // Some dozen roundings of a float, in a shader whose square roots and quotients may be off by a
    // few units in the last place: in degrees.
    constexpr double float_degrees = 6e-5;
    for (const FrameEncoding encoding : all_frame_encodings) {
        if (encoding == FrameEncoding::float32) continue;  // Needs no decoder.
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
            // Written so that NaN counts.
            if (!(normal <= worst)) worst = normal;
            if (!(tangent <= worst)) worst = tangent;
            wrong_hands += tangents[i].w == frames.tangents[i].w ? 0U : 1U;
        }
        EXPECT_LE(worst, float_degrees) << name_of(encoding);
        EXPECT_EQ(wrong_hands, 0U) << name_of(encoding);
    }
}

}  // namespace
}  // namespace relief::gl
