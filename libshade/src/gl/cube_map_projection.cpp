// SPDX-License-Identifier: Apache-2.0
// Cube maps from single images that hold the whole sphere: panoramas by longitude and latitude, and
// light probes by angle. Directions and storage as in cube_map.h; impossible images throw
// InvalidInput. Tests: tests/shade/gl/cube_map_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "environment/angular_map.h"
#include "environment/radiance.h"
#include "gl/cube_map.h"
#include "gl/cube_map_drawing.h"
#include "gl/texture.h"
#include "relief/mesh/error.h"

namespace relief::gl {

namespace {

/// A way to hold the sphere in an image.
struct Projection {
    const char* name;
    /// GLSL: the body of vec3 radiance(vec3 direction), which looks up `image`.
    const char* radiance;
    GLenum wrap_s;  ///< Beyond the left and right edges; above and below there is nothing.
};

// atan(y, length(xz)) instead of acos(y): drivers approximate acos more coarsely, worst near 0 and
// pi. textureLod: at the wrap, u jumps, and derivatives would choose the smallest level there.
constexpr Projection panorama_projection{"panorama", R"(
    float across = length(direction.xz);
    float u = across == 0.0 ? 0.5 : 0.5 + atan(direction.x, -direction.z) / (2.0 * pi);
    float v = 0.5 - atan(direction.y, across) / pi;
    return textureLod(image, vec2(u, v), 0.0).rgb;)",
                                         GL_REPEAT};

// As angular_map_place().
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

/// How many lookups along a side of a texel it takes to miss no texel of the image where a face's
/// middle texel, which spans 2 / size radians, meets texels of 2 pi / width radians.
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
    CubeMap cube = make_empty_cube_map(api, size, level_count(size), name);
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

void check_asked_size(int size) {
    if (size < 0) throw InvalidInput(fmt::format("faces of {} texels are asked for", size));
}

}  // namespace

CubeMap make_cube_map_from_panorama(const Api& api, const Image& panorama, std::string_view name,
                                    Report& report, int size) {
    if (panorama.empty()) throw InvalidInput(fmt::format("panorama '{}' has no texels", name));
    check_asked_size(size);
    return projected(api, panorama, panorama_projection, name, report,
                     size == 0 ? (panorama.width + 3) / 4 : size);
}

CubeMap make_cube_map_from_angular_map(const Api& api, const Image& map, std::string_view name,
                                       Report& report, int size) {
    check_angular_map(map, name);
    check_asked_size(size);
    return projected(api, map, angular_projection, name, report,
                     size == 0 ? (map.width + 1) / 2 : size);
}

}  // namespace relief::gl
