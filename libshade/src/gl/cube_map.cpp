// SPDX-License-Identifier: Apache-2.0
// Cube maps from six images and from panoramas; directions and storage as in cube_map.h.
// Source of the faces' orientation: OpenGL 3.3 core, table 3.10.
// Tests: tests/shade/gl/cube_map_test.cpp.
#include "gl/cube_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "gl/program.h"
#include "gl/texture.h"
#include "relief/mesh/error.h"
#include "relief/shade/error.h"

namespace relief::gl {

namespace {

constexpr float largest_half = 65504.0F;
constexpr std::array<const char*, 6> face_names{"+x", "-x", "+y", "-y", "+z", "-z"};

GLenum face_target(std::size_t face) {
    return GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face);
}

/// Covers the viewport with one triangle, without any vertex data.
constexpr const char* covering_vertex_shader = R"(#version 330 core
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";

// atan(y, length(xz)) instead of acos(y): drivers approximate acos more coarsely, worst near 0 and
// pi. textureLod: at the wrap, u jumps, and derivatives would choose the smallest level there.
constexpr const char* panorama_fragment_shader = R"(#version 330 core
uniform sampler2D panorama;
uniform mat3 world_from_face;  // Columns: along s, along t, outwards.
uniform float face_size;       // In texels.
uniform int grid;              // Lookups along a side of a texel.
out vec4 color;

const float pi = 3.14159265358979;

vec3 radiance(vec3 direction) {
    float across = length(direction.xz);
    float u = across == 0.0 ? 0.5 : 0.5 + atan(direction.x, -direction.z) / (2.0 * pi);
    float v = 0.5 - atan(direction.y, across) / pi;
    return textureLod(panorama, vec2(u, v), 0.0).rgb;
}

void main() {
    vec2 corner = floor(gl_FragCoord.xy);
    vec3 sum = vec3(0.0);
    for (int y = 0; y < grid; ++y) {
        for (int x = 0; x < grid; ++x) {
            vec2 texel = corner + (vec2(x, y) + 0.5) / float(grid);
            vec2 st = 2.0 * texel / face_size - 1.0;
            sum += radiance(world_from_face * vec3(st, 1.0));
        }
    }
    color = vec4(sum / float(grid * grid), 1.0);
}
)";

/// World directions along s, along t (down) and outwards, for each face.
const std::array<glm::mat3, 6>& world_from_face() {
    static const std::array<glm::mat3, 6> matrices{
        glm::mat3{{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}, glm::mat3{{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}},
        glm::mat3{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},   glm::mat3{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
        glm::mat3{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},  glm::mat3{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
    };
    return matrices;
}

/// What a half float can hold of a sample, counting what it cannot.
float storable(float value, std::size_t texel, Report& report) {
    if (std::isfinite(value) && std::abs(value) <= largest_half) return value;
    if (!std::isfinite(value)) {
        report.add("radiance that is not finite", "texel", texel,
                   "counts as 65504 if positive infinity, else as 0");
        return value > 0.0F ? largest_half : 0.0F;
    }
    report.add("radiance beyond half floats", "texel", texel, "is clamped to 65504");
    return std::copysign(largest_half, value);
}

/// Linear float of any image, with nothing that would become infinite as half float. Alpha, where
/// there is one, stays: nothing looks it up.
Image storable_radiance(const Image& image, Report& report) {
    Image linear = to_linear(image);
    const auto samples = linear.as<float>();
    const auto channels = static_cast<std::size_t>(linear.channels);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] = storable(samples[i], i / channels, report);
    }
    return linear;
}

bool is_coded_color(const Image& image) {
    return image.bits() == 8 && image.color_space == ColorSpace::srgb;
}

void check_size(const Api& api, int size, std::string_view name) {
    const int limit = api.limits().cube_size;
    if (size > limit) {
        throw GpuError(
            fmt::format("cube map '{}' has faces of {} x {} texels, but {} holds at most {}", name,
                        size, size, api.renderer(), limit));
    }
}

void check_faces(std::span<const Image> faces, std::string_view name) {
    if (faces.size() != 6) {
        throw InvalidInput(
            fmt::format("cube map '{}' has {} faces, but needs 6", name, faces.size()));
    }
    const Image& first = faces.front();
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const Image& face = faces[i];
        const auto refuse = [&](const std::string& reason) {
            throw InvalidInput(
                fmt::format("cube map '{}': face {} {}", name, face_names.at(i), reason));
        };
        if (face.empty()) refuse("has no texels");
        if (face.width != face.height) {
            refuse(fmt::format("has {} x {} texels, but must be square", face.width, face.height));
        }
        if (face.width != first.width) {
            refuse(fmt::format("has {0} x {0} texels, but face +x has {1} x {1}", face.width,
                               first.width));
        }
        if (face.bits() != first.bits() || face.channels != first.channels ||
            face.color_space != first.color_space) {
            refuse("differs from face +x in channels, bits or colour space");
        }
    }
}

int level_count(int size) {
    int levels = 1;
    while ((size >>= 1) > 0)
        ++levels;
    return levels;
}

/// All levels from level 0 of the bound cube map, and how it is looked up.
void finish(const Api& api) {
    api->GenerateMipmap(GL_TEXTURE_CUBE_MAP);
    Sampling sampling;
    sampling.wrap_s = GL_CLAMP_TO_EDGE;
    sampling.wrap_t = GL_CLAMP_TO_EDGE;
    set_sampling(api, GL_TEXTURE_CUBE_MAP, sampling);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
}

/// What drawing into a cube face changes; restored at the end of life.
class SavedState {
  public:
    explicit SavedState(const Api& api) : api_(api) {
        api->GetIntegerv(GL_VIEWPORT, viewport_.data());
        api->GetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_);
        api->GetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_);
        for (std::size_t i = 0; i < tests.size(); ++i) {
            enabled_.at(i) = api->IsEnabled(tests.at(i));
            api->Disable(tests.at(i));
        }
    }
    ~SavedState() {
        for (std::size_t i = 0; i < tests.size(); ++i) {
            if (enabled_.at(i) != GL_FALSE) api_->Enable(tests.at(i));
        }
        api_->BindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_));
        api_->BindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read_));
        api_->Viewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
    }
    SavedState(const SavedState&) = delete;
    SavedState& operator=(const SavedState&) = delete;

  private:
    static constexpr std::array<GLenum, 4> tests{GL_DEPTH_TEST, GL_CULL_FACE, GL_BLEND,
                                                 GL_SCISSOR_TEST};
    const Api& api_;
    std::array<GLint, 4> viewport_{};
    GLint draw_ = 0;
    GLint read_ = 0;
    std::array<GLboolean, 4> enabled_{};
};

/// How many lookups along a side of a texel it takes to miss no panorama texel at the horizon,
/// where a face's middle texel spans 2 / size radians and a panorama's 2 pi / width.
int grid_of(int panorama_width, int size) {
    const double spanned = panorama_width / (std::numbers::pi * size);
    return std::max(2, static_cast<int>(std::ceil(spanned)));
}

void draw_faces(const Api& api, const Texture& cube, const Texture& panorama, int size, int grid) {
    const LinkedProgram program(
        api, {"panorama to cube map", covering_vertex_shader, panorama_fragment_shader, {}, {}});
    const VertexArray no_vertices(api);
    const Framebuffer framebuffer(api);
    const SavedState saved(api);
    api->BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    api->Viewport(0, 0, size, size);
    api->BindVertexArray(no_vertices.name());
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_2D, panorama.name());
    api->BindSampler(0, 0);
    program.use();
    program.set("panorama", 0);
    program.set("face_size", static_cast<float>(size));
    program.set("grid", grid);
    for (std::size_t face = 0; face < 6; ++face) {
        program.set("world_from_face", world_from_face().at(face));
        api->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, face_target(face),
                                  cube.name(), 0);
        api->DrawArrays(GL_TRIANGLES, 0, 3);
    }
    api->UseProgram(0);
    api->BindVertexArray(0);
    api->BindTexture(GL_TEXTURE_2D, 0);
}

}  // namespace

CubeMap make_cube_map(const Api& api, std::span<const Image> faces, std::string_view name,
                      Report& report) {
    check_faces(faces, name);
    const int size = faces.front().width;
    check_size(api, size, name);
    CubeMap cube{Texture(api), size, level_count(size)};
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const Image& face = faces[i];
        const std::optional<Image> converted = is_coded_color(face)
                                                   ? converted_for_upload(face)
                                                   : std::optional(storable_radiance(face, report));
        const Image& uploaded = converted ? *converted : face;
        TexelFormat format = texel_format(uploaded, FloatStorage::half);
        if (!is_coded_color(face)) format.internal = GL_RGBA16F;
        upload_level(api, face_target(i), 0, format, uploaded);
    }
    finish(api);
    api.check(fmt::format("uploading cube map '{}', six faces of {} x {}", name, size, size));
    return cube;
}

CubeMap make_cube_map_from_panorama(const Api& api, const Image& panorama, std::string_view name,
                                    Report& report, int size) {
    if (panorama.empty()) throw InvalidInput(fmt::format("panorama '{}' has no texels", name));
    if (size < 0) throw InvalidInput(fmt::format("faces of {} texels are asked for", size));
    if (size == 0) size = (panorama.width + 3) / 4;
    check_size(api, size, name);
    const Image radiance = storable_radiance(panorama, report);
    const Texture source = make_texture(api, radiance, name, false);
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_2D, source.name());
    // Around the horizon it wraps; beyond a pole there is nothing.
    set_sampling(api, GL_TEXTURE_2D, {GL_REPEAT, GL_CLAMP_TO_EDGE, GL_LINEAR, GL_LINEAR, 1.0F});

    CubeMap cube{Texture(api), size, level_count(size)};
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    for (std::size_t face = 0; face < 6; ++face) {
        api->TexImage2D(face_target(face), 0, GL_RGBA16F, size, size, 0, GL_RGBA, GL_FLOAT,
                        nullptr);
    }
    api.check(fmt::format("making cube map '{}', six faces of {} x {}", name, size, size));
    // Until finish(), level 0 is all there is.
    draw_faces(api, cube.texture, source, size, grid_of(panorama.width, size));
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    finish(api);
    api.check(fmt::format("converting panorama '{}' to a cube map", name));
    return cube;
}

}  // namespace relief::gl
