// SPDX-License-Identifier: Apache-2.0
/// \file
/// Looking cube maps up from tests: which directions, what stands there, how far off it is.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "gl/cube_map.h"
#include "gl/resources.h"
#include "support/angle.h"
#include "support/gl_environment.h"

namespace relief::gl {

/// What lookups in these directions give, at one level of detail.
inline std::vector<glm::vec3> look_up(const Api& api, const CubeMap& cube,
                                      const std::vector<glm::vec3>& directions,
                                      float level = 0.0F) {
    std::vector<glm::vec4> padded;
    for (const glm::vec3& direction : directions)
        padded.emplace_back(direction, 0.0F);
    const Buffer buffer = make_buffer(api, padded, "directions");
    const Texture list = make_buffer_texture(api, buffer, GL_RGBA32F, padded.size(), "directions");
    const RenderTarget target(api, static_cast<int>(padded.size()), 1, ColorFormat::rgba32f, 1);
    api->ActiveTexture(GL_TEXTURE1);
    api->BindTexture(GL_TEXTURE_BUFFER, list.name());
    api->ActiveTexture(GL_TEXTURE0);
    api->BindTexture(GL_TEXTURE_CUBE_MAP, cube.texture.name());
    test::cover(api,
                "uniform samplerCube cube;\nuniform samplerBuffer directions;\n"
                "uniform float level;\nout vec4 color;\nvoid main() {\n"
                "    vec3 direction = texelFetch(directions, int(gl_FragCoord.x)).xyz;\n"
                "    color = textureLod(cube, direction, level);\n}\n",
                [&](const LinkedProgram& program) {
                    program.set("cube", 0);
                    program.set("directions", 1);
                    program.set("level", level);
                });
    api->BindTexture(GL_TEXTURE_CUBE_MAP, 0);
    const Image image = target.read(ColorSpace::linear);
    std::vector<glm::vec3> result;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const auto texel = image.as<float>().subspan(4 * i, 3);
        result.emplace_back(texel[0], texel[1], texel[2]);
    }
    return result;
}

/// Directions spread evenly over the sphere (Fibonacci's spiral).
inline std::vector<glm::vec3> spread_directions(int count) {
    std::vector<glm::vec3> directions;
    for (int i = 0; i < count; ++i) {
        const double y = 1.0 - (2.0 * i + 1.0) / count;
        const double across = std::sqrt(1.0 - y * y);
        const double turn = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
        directions.emplace_back(across * std::cos(turn), y, across * std::sin(turn));
    }
    return directions;
}

/// The largest angle between corresponding directions.
inline double worst_degrees(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        worst = std::max(worst, test::degrees_between(glm::dvec3(a[i]), glm::dvec3(b[i])));
    }
    return worst;
}

/// Those whose bilinear lookup reads one face only.
inline std::vector<glm::vec3> inside_faces(const std::vector<glm::vec3>& directions, int size) {
    std::vector<glm::vec3> inside;
    for (const glm::vec3& direction : directions) {
        std::array<float, 3> axes{std::abs(direction.x), std::abs(direction.y),
                                  std::abs(direction.z)};
        std::ranges::sort(axes);
        if (axes[1] / axes[2] < 1.0F - 1.0F / static_cast<float>(size)) inside.push_back(direction);
    }
    return inside;
}

/// Radiance that tells where it comes from.
inline const auto direction_itself = [](glm::vec3 direction) { return direction; };

}  // namespace relief::gl
