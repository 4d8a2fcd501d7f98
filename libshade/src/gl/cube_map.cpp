// SPDX-License-Identifier: Apache-2.0
// Cube maps from six images, and reading them back; directions and storage as in cube_map.h.
// Tests: tests/shade/gl/cube_map_test.cpp.
#include "gl/cube_map.h"

#include <fmt/format.h>

#include "environment/cube_faces.h"
#include "environment/radiance.h"
#include "gl/cube_map_drawing.h"
#include "gl/texture.h"
#include "relief/shade/error.h"

namespace relief::gl {

namespace {

bool is_coded_color(const Image& image) {
    return image.bits() == 8 && image.color_space == ColorSpace::srgb;
}

/// Whether the faces are stored as sRGB codes.
bool holds_codes(const Api& api, const CubeMap& cube) {
    GLint format = 0;
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    api->GetTexLevelParameteriv(cube_face_target(0), 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    return format == GL_SRGB8 || format == GL_SRGB8_ALPHA8;
}

}  // namespace

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
            fmt::format("cube map '{}' has faces of {} x {} texels, but {} holds at most {}", name,
                        size, size, api.renderer(), limit));
    }
}

CubeMap make_cube_map(const Api& api, std::span<const Image> faces, std::string_view name,
                      Report& report) {
    check_faces(faces, name);
    const int size = faces.front().width;
    check_cube_size(api, size, name);
    CubeMap cube{Texture(api), size, level_count(size)};
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    set_cube_sampling(api);  // Before any level, as in make_texture().
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const Image& face = faces[i];
        const std::optional<Image> converted = is_coded_color(face)
                                                   ? converted_for_upload(face)
                                                   : std::optional(storable_radiance(face, report));
        const Image& uploaded = converted ? *converted : face;
        TexelFormat format = texel_format(uploaded, FloatStorage::half);
        if (!is_coded_color(face)) format.internal = GL_RGBA16F;
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

}  // namespace relief::gl
