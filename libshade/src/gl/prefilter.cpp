// SPDX-License-Identifier: Apache-2.0
// Blurred levels of a cube map: the mirror picture is drawn, read back at 128 texels a face,
// blurred by environment/blur.h and uploaded. A GPU could sample the lobes itself, but takes some
// thousand lookups a texel where small bright lights are to be right, and software OpenGL thirty
// times as long for a lookup as the walk down a tree for a term. See prefilter.h. Tests:
// tests/shade/gl/prefilter_test.cpp.
#include "gl/prefilter.h"

#include <algorithm>
#include <cmath>

#include "environment/blur.h"
#include "environment/radiance.h"
#include "gl/cube_map_drawing.h"
#include "gl/texture.h"

namespace relief::gl {

namespace {

constexpr int largest_size = 256;
/// Of what is blurred: the sharpest lobe, of roughness 1/5, is 13 of these texels wide.
constexpr int blurred_size = 128;
constexpr int smallest_level = 8;

/// The surroundings drawn into the first levels of a cube map, each time from a level of theirs
/// that is as large or just larger.
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
            program.set("level", static_cast<float>(std::max(0.0, std::log2(shrinking))));
        });
    }
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
}

void upload_level(const Api& api, const CubeMap& cube, int level, const std::vector<Image>& faces) {
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    for (std::size_t face = 0; face < 6; ++face) {
        // Blurring is exact within a percent or two, which may lead beyond the largest half float.
        Image stored = faces[face];
        for (float& sample : stored.as<float>())
            sample = std::min(sample, largest_half);
        api->TexSubImage2D(cube_face_target(face), level, 0, 0, stored.width, stored.height, GL_RGB,
                           GL_FLOAT, stored.as<float>().data());
    }
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
}

}  // namespace

CubeMap make_prefiltered(const Api& api, const CubeMap& environment) {
    const int size = environment.size >= largest_size ? largest_size : blurred_size;
    const int levels = level_count(size / smallest_level);
    CubeMap cube = make_empty_cube_map(api, size, levels, "prefiltered environment");
    // Level 1 may serve as a scratch pad for the smaller picture until its own is there.
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

}  // namespace relief::gl
