// SPDX-License-Identifier: Apache-2.0
// Converts a height map in memory to a normal map of 8 bits.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>

#include "relief/mesh/bump.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/report.h"

int main() {
    // Heights from 0 to 1 that rise by one 64th from texel to texel.
    const int size = 64;
    relief::Image heights = relief::make_image(size, size, 1, 32, relief::ColorSpace::data);
    const std::span<float> values = heights.as<float>();
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(i % size) / size;

    relief::BumpOptions options;
    options.kernel = relief::Kernel::scharr3;
    options.wrap = relief::Wrap::clamp;
    options.strength = 32.0;  // The value 1 is 32 texels high, so the slope is one half.

    relief::Report report;
    relief::NormalMapFormat format;
    format.bits = 8;
    format.green = relief::Green::up;
    const relief::Image map = relief::normal_map_from_height(heights, options, format, report);

    const std::span<const std::uint8_t> codes = map.as<std::uint8_t>();
    const std::span<const std::uint8_t> texel = codes.subspan((size / 2 * size + size / 2) * 3, 3);
    std::printf("size %d x %d\n", map.width, map.height);
    std::printf("texel %d %d %d\n", texel[0], texel[1], texel[2]);

    // Decoding tells what the eight bits cost: the exact normal is (-1, 0, 2) / sqrt(5).
    const relief::Image normals = relief::decode_normal_map(map, format.green, format.flat, report);
    const std::span<const float> normal =
        normals.as<float>().subspan((size / 2 * size + size / 2) * 3, 3);
    const double slope = -static_cast<double>(normal[0]) / normal[2];
    std::printf("slope %.4f\n", slope);
    std::printf("error %.3f degrees\n", std::abs(std::atan(slope) - std::atan(0.5)) * 57.2957795);
    std::printf("findings %zu\n", report.findings().size());
}
