// SPDX-License-Identifier: Apache-2.0
// Cube maps from six images, from panoramas and light probes, and for rough reflections. Panoramas
// and probes are drawn into the faces by one triangle each. Invalid images throw InvalidInput.
#include "gl/cube_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <string_view>

#include "environment/convolution.h"
#include "environment/environment_images.h"
#include "gl/program.h"
#include "gl/resources.h"
#include "portable_math.h"
#include "relief/mesh/report.h"
#include "relief/shade/renderer.h"

namespace relief::shade::gl {
using namespace relief::shade::detail;

GLenum cube_face_target(std::size_t face) {
    return GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face);
}

int level_count(int size) {
    int levels = 1;
    while ((size >>= 1) > 0)
        ++levels;
    return levels;
}

void check_cube_size(const Api& api, int size, std::string_view name) {
    const int limit = api.limits().cube_size;
    if (size > limit) {
        throw GpuError(
            fmt::format("cube map '{}' has faces of {} x {} texels, but {} allows at most {}", name,
                        size, size, api.renderer(), limit));
    }
}

// Drawing into faces

namespace {

/// Covers the viewport with one triangle without vertex data.
constexpr const char* covering_vertex_shader = R"(#version 330 core
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";

std::string fragment_shader(const std::string& declarations, const std::string& radiance) {
    return R"(#version 330 core
uniform mat3 world_from_face;  // Columns: along s, along t, outwards.
uniform float face_size;       // In texels.
uniform int grid;              // Directions along a side of a texel.
out vec4 color;
)" + declarations +
           "\nvec3 radiance(vec3 direction) {\n" + radiance + R"(
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
}

/// The state that drawing into a cube face changes; the destructor restores it.
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

GLenum internal_format(FloatStorage storage) {
    return storage == FloatStorage::half ? GL_RGBA16F : GL_RGBA32F;
}

/// Returns faces of floats without content, bound to no unit.
///
/// \param levels  the number of levels from the largest
/// \throws GpuError if they are larger than the context's limit, or memory runs out
CubeMap make_empty_cube_map(const Api& api, int size, int levels, FloatStorage storage,
                            std::string_view name) {
    check_cube_size(api, size, name);
    CubeMap cube{Texture(api), size, levels, storage};
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    for (int level = 0; level < levels; ++level) {
        const int side = std::max(1, size >> level);
        for (std::size_t face = 0; face < 6; ++face) {
            api->TexImage2D(cube_face_target(face), level,
                            static_cast<GLint>(internal_format(storage)), side, side, 0, GL_RGBA,
                            GL_FLOAT, nullptr);
        }
    }
    api->TexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAX_LEVEL, levels - 1);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    api.check(fmt::format("making cube map '{}', six faces of {} x {}", name, size, size));
    return cube;
}

/// Sets the sampling of the bound cube map: seamless, between all of its levels.
void set_cube_sampling(const Api& api) {
    Sampling sampling;
    sampling.wrap_s = GL_CLAMP_TO_EDGE;
    sampling.wrap_t = GL_CLAMP_TO_EDGE;
    set_sampling(api, GL_TEXTURE_CUBE_MAP, sampling);
}

/// A program that draws the texels of all faces.
///
/// The fragment shader is made of `declarations`, which may declare uniforms and functions, and
/// `radiance`, the body of `vec3 radiance(vec3 direction)`, where `direction` is the direction of
/// the texel in world space, not unit. With a grid, the color is the mean of grid x grid directions
/// in a texel.
///
/// Restores the framebuffer binding, the viewport and the tests; leaves no program or vertex array
/// bound. The active texture unit is 0; the caller binds its texture.
class CubePainter {
  public:
    CubePainter(const Api& api, const std::string& name, const std::string& declarations,
                const std::string& radiance);

    /// \param prepare  sets the declared uniforms
    void paint(const CubeMap& cube, int level, int grid,
               const std::function<void(const LinkedProgram&)>& prepare) const;

  private:
    const Api* api_;
    LinkedProgram program_;
    VertexArray no_vertices_;
    Framebuffer framebuffer_;
};

CubePainter::CubePainter(const Api& api, const std::string& name, const std::string& declarations,
                         const std::string& radiance)
    : api_(&api),
      program_(api,
               {name, covering_vertex_shader, fragment_shader(declarations, radiance), {}, {}}),
      no_vertices_(api),
      framebuffer_(api) {}

void CubePainter::paint(const CubeMap& cube, int level, int grid,
                        const std::function<void(const LinkedProgram&)>& prepare) const {
    const Api& api = *api_;
    const SavedState saved(api);
    const int size = std::max(1, cube.size >> level);
    api->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    api->Viewport(0, 0, size, size);
    api->BindVertexArray(no_vertices_.name());
    program_.use();
    program_.set("face_size", static_cast<float>(size));
    program_.set("grid", grid);
    prepare(program_);
    for (std::size_t face = 0; face < 6; ++face) {
        program_.set("world_from_face", world_from_face().at(face));
        api->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, cube_face_target(face),
                                  cube.texture.name(), level);
        api->DrawArrays(GL_TRIANGLES, 0, 3);
    }
    api->UseProgram(0);
    api->BindVertexArray(0);
}

}  // namespace

// Six images

namespace {

bool is_coded_color(const Image& image) {
    return image.bits() == 8 && image.color_space == ColorSpace::srgb;
}

/// Tells whether the faces are stored as sRGB codes.
bool holds_codes(const Api& api, const CubeMap& cube) {
    GLint format = 0;
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    api->GetTexLevelParameteriv(cube_face_target(0), 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    return format == GL_SRGB8 || format == GL_SRGB8_ALPHA8;
}

}  // namespace

CubeMap make_cube_map(const Api& api, std::span<const Image> faces, std::string_view name,
                      Report& report) {
    check_faces(faces, name);
    const int size = faces.front().width;
    check_cube_size(api, size, name);
    CubeMap cube{Texture(api), size, level_count(size)};
    const bool are_codes = is_coded_color(faces.front());
    std::vector<std::optional<Image>> converted;
    for (const Image& face : faces) {
        converted.push_back(are_codes ? converted_for_upload(face)
                                      : std::optional(storable_radiance(face, report)));
        if (!are_codes && !fits_half_floats(*converted.back())) cube.storage = FloatStorage::full;
    }
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    set_cube_sampling(api);  // Before any level, as in make_texture().
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const Image& uploaded = converted[i] ? *converted[i] : faces[i];
        TexelFormat format = texel_format(uploaded, cube.storage);
        if (!are_codes) format.internal = internal_format(cube.storage);
        upload_levels(api, cube_face_target(i), format, uploaded);
    }
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    api.check(fmt::format("uploading cube map '{}', six faces of {} x {}", name, size, size));
    return cube;
}

std::vector<Image> read_faces(const Api& api, const CubeMap& cube, int level) {
    const bool is_coded = holds_codes(api, cube);
    std::vector<Image> faces;
    for (std::size_t face = 0; face < 6; ++face) {
        const Image stored =
            read_texture(api, cube.texture, cube_face_target(face), level, 3, is_coded ? 8 : 32,
                         is_coded ? ColorSpace::srgb : ColorSpace::linear);
        faces.push_back(to_linear(stored));
    }
    return faces;
}

// Panoramas and light probes

namespace {

/// A projection of the sphere onto an image.
struct Projection {
    const char* name;
    /// GLSL: the body of vec3 radiance(vec3 direction), which looks up `image`.
    const char* radiance;
    GLenum wrap_s;  ///< Beyond the left and right edges; rows are clamped.
};

// atan(y, length(xz)) replaces acos(y), which drivers approximate less accurately, especially near
// 0 and pi. textureLod avoids derivatives, which at the jump of u would choose the smallest level.
constexpr Projection panorama_projection{"panorama", R"(
    float across = length(direction.xz);
    float u = across == 0.0 ? 0.5 : 0.5 + atan(direction.x, -direction.z) / (2.0 * pi);
    float v = 0.5 - atan(direction.y, across) / pi;
    return textureLod(image, vec2(u, v), 0.0).rgb;)",
                                         GL_REPEAT};

// This is angular_map_place() in GLSL.
constexpr Projection angular_projection{"angular map", R"(
    float across = length(direction.xy);
    float radius = min(atan(across, -direction.z) / pi, reach);
    vec2 side = across == 0.0 ? vec2(1.0, 0.0) : direction.xy / across;
    return textureLod(image, 0.5 + 0.5 * radius * vec2(side.x, -side.y), 0.0).rgb;)",
                                        GL_CLAMP_TO_EDGE};

constexpr const char* declarations = R"(
uniform sampler2D image;
uniform float reach;  // Of an angular map.
const float pi = 3.14159265358979;
)";

/// Returns the number of lookups along a side of a texel that use every texel of the image in the
/// center of a face, where a texel spans 2 / size radians and those of the image 2 pi / width
/// radians.
int grid_of(int image_width, int size) {
    const double spanned = image_width / (std::numbers::pi * size);
    return std::max(2, static_cast<int>(std::ceil(spanned)));
}

CubeMap projected(const Api& api, const Image& image, const Projection& projection,
                  std::string_view name, Report& report, int size) {
    check_cube_size(api, size, name);
    const Image radiance = storable_radiance(image, report);
    const Texture source = make_texture(api, radiance, name, false);
    const CubePainter painter(api, fmt::format("{} to cube map", projection.name), declarations,
                              projection.radiance);
    const FloatStorage storage =
        fits_half_floats(radiance) ? FloatStorage::half : FloatStorage::full;
    CubeMap cube = make_empty_cube_map(api, size, level_count(size), storage, name);
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_2D, source.name());
    api->BindSampler(0, 0);
    set_sampling(api, GL_TEXTURE_2D,
                 {projection.wrap_s, GL_CLAMP_TO_EDGE, GL_LINEAR, GL_LINEAR, 1.0F});
    painter.paint(cube, 0, grid_of(image.width, size), [&](const LinkedProgram& program) {
        program.set("image", 0);
        program.set("reach", static_cast<float>(angular_map_reach(image.width)));
    });
    api->BindTexture(GL_TEXTURE_2D, 0);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    api->GenerateMipmap(GL_TEXTURE_CUBE_MAP);
    set_cube_sampling(api);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    api.check(fmt::format("converting {} '{}' to a cube map", projection.name, name));
    return cube;
}

void check_requested_size(int size) {
    if (size < 0) throw InvalidInput(fmt::format("faces of {} texels were requested", size));
}

}  // namespace

CubeMap make_cube_map_from_panorama(const Api& api, const Image& panorama, std::string_view name,
                                    Report& report, int size) {
    if (panorama.empty()) throw InvalidInput(fmt::format("panorama '{}' has no texels", name));
    check_requested_size(size);
    return projected(api, panorama, panorama_projection, name, report,
                     size == 0 ? (panorama.width + 3) / 4 : size);
}

CubeMap make_cube_map_from_angular_map(const Api& api, const Image& map, std::string_view name,
                                       Report& report, int size) {
    check_angular_map(map, name);
    check_requested_size(size);
    return projected(api, map, angular_projection, name, report,
                     size == 0 ? (map.width + 1) / 2 : size);
}

// Rough reflections

namespace {

// The mirror picture is drawn, read back at 128 texels a face, blurred by convolution.h and
// uploaded. A GPU could sample the lobes itself, but it needs some thousand lookups a texel for
// small bright lights, and a lookup in software OpenGL costs thirty times as much as a term of the
// tree walk.

constexpr int max_prefiltered_size = 256;
/// The size of the blurred picture: the sharpest lobe, of roughness 1/5, is 13 of its texels wide.
constexpr int blurred_size = 128;
constexpr int min_level_size = 8;

/// Draws the environment into the first levels of a cube map, each from the level of the
/// environment that is as large or just larger.
void draw_mirror_pictures(const Api& api, const CubeMap& environment, const CubeMap& cube,
                          int levels) {
    const CubePainter painter(api, "mirrored environment",
                              "uniform samplerCube environment;\nuniform float level;\n",
                              "    return textureLod(environment, direction, level).rgb;");
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, environment.texture.name());
    api->BindSampler(0, 0);
    for (int level = 0; level < levels; ++level) {
        const double shrinking = static_cast<double>(environment.size) / (cube.size >> level);
        painter.paint(cube, level, 1, [&](const LinkedProgram& program) {
            program.set("environment", 0);
            program.set("level",
                        static_cast<float>(std::max(
                            0.0, relief::detail::portable::log(shrinking) / std::numbers::ln2)));
        });
    }
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
}

void upload_level(const Api& api, const CubeMap& cube, int level, const std::vector<Image>& faces) {
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    for (std::size_t face = 0; face < 6; ++face) {
        Image stored = faces[face];
        if (cube.storage == FloatStorage::half) {
            // The error of blurring, up to two percent, may exceed the largest half float.
            for (float& sample : stored.as<float>())
                sample = std::min(sample, max_half);
        }
        api->TexSubImage2D(cube_face_target(face), level, 0, 0, stored.width, stored.height, GL_RGB,
                           GL_FLOAT, stored.as<float>().data());
    }
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
}

}  // namespace

CubeMap make_prefiltered(const Api& api, const CubeMap& environment) {
    const int size = environment.size >= max_prefiltered_size ? max_prefiltered_size : blurred_size;
    const int levels = level_count(size / min_level_size);
    CubeMap cube =
        make_empty_cube_map(api, size, levels, environment.storage, "prefiltered environment");
    // Level 1 holds the smaller sharp picture until its own content is computed.
    const int blurred_level = size == blurred_size ? 0 : 1;
    draw_mirror_pictures(api, environment, cube, blurred_level + 1);
    const RadianceTree tree(read_faces(api, cube, blurred_level));
    for (int level = 1; level < levels; ++level) {
        const double roughness = static_cast<double>(level) / (levels - 1);
        upload_level(api, cube, level, blurred_faces(tree, size >> level, roughness));
    }
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    set_cube_sampling(api);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    api.check("blurring the environment");
    return cube;
}

}  // namespace relief::shade::gl
