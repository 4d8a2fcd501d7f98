// SPDX-License-Identifier: Apache-2.0
// Bakes the normals of a wavy high-poly mesh onto a flat quad, in memory.
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/bake.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"

int main() {
    relief::Report report;
    const relief::Mesh low = relief::make_quad();
    relief::Mesh high = relief::make_quad(256);
    const relief::Bounds box = relief::bounds_of(low);
    const float width = box.max.x - box.min.x;
    const float waves = 4.0F;
    const float height = 0.01F * width;
    for (glm::vec3& position : high.positions)
        position.z += height * glm::sin(6.2831853F * waves * (position.x - box.min.x) / width);
    high.normals =
        relief::vertex_normals(high.positions, high.triangles, relief::NormalWeight::angle, report);
    high.tangents.clear();

    relief::BakeOptions options;
    options.map.width = 128;
    options.map.height = 128;
    options.map.samples = 4;
    options.map.padding = 4;

    // The baker hands over bands of rows, from the top.
    relief::Image normals =
        relief::make_image(options.map.width, options.map.height, 3, 32, relief::ColorSpace::data);
    const relief::BakeResult result = relief::bake_normals(
        std::span(&high, 1), low, options,
        [&](const relief::BakedRows& rows) {
            const std::size_t first = static_cast<std::size_t>(rows.first_row) * 128 * 3;
            std::copy(rows.normals.begin(), rows.normals.end(),
                      normals.as<float>().begin() + static_cast<std::ptrdiff_t>(first));
        },
        report);
    const relief::Image map = relief::encode_normal_map(normals, {.bits = 8}, report);

    double steepest = 0.0;
    const std::span<const float> values = normals.as<float>();
    for (std::size_t texel = 0; texel < values.size(); texel += 3)
        steepest =
            std::max(steepest, std::abs(static_cast<double>(values[texel])) / values[texel + 2]);
    std::printf("baked %zu, missed %zu of %d texels\n", result.texels_baked, result.texels_missed,
                map.width * map.height);
    std::printf("steepest slope %.4f, of the wave %.4f\n", steepest, 0.01 * 6.2831853 * waves);
}
