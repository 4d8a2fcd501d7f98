// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "normal_map_errors/error_tables.h"
#include "relief/mesh/direction_error.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/normal_map_operations.h"
#include "support/resized_waves.h"

namespace relief::test {
namespace {

constexpr int side = 256;

/// A smooth surface, as codes are bad at: slopes that change by a code every few texels.
std::vector<HeightWave> smooth_waves() {
    return tiling_waves(side, side, 5, 128, 0.2, 41);
}

Image stored(const Image& normals, const NormalMapFormat& format) {
    Report report;
    return decode_normal_map(encode_normal_map(normals, format, report), format.green, format.flat,
                             report);
}

/// Sums of vectors over squares of `block` texels.
std::vector<glm::dvec3> block_sums(const Image& normals, int block) {
    const int blocks = side / block;
    std::vector<glm::dvec3> sums(static_cast<std::size_t>(blocks * blocks));
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const float* const n = &normals.as<float>()[static_cast<std::size_t>(y * side + x) * 3];
            sums[static_cast<std::size_t>(y / block * blocks + x / block)] +=
                glm::dvec3(n[0], n[1], n[2]);
        }
    }
    return sums;
}

double rms_of_blocks(const Image& normals, const Image& truth, int block) {
    const std::vector<glm::dvec3> a = block_sums(normals, block);
    const std::vector<glm::dvec3> b = block_sums(truth, block);
    double squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        squares += std::pow(degrees_between(a[i], b[i]), 2);
    return std::sqrt(squares / static_cast<double>(a.size()));
}

std::string row_of(const char* name, const NormalMapFormat& format) {
    const Image truth = normals_image(side, side, smooth_waves());
    const Image read = stored(truth, format);
    std::vector<std::string> cells;
    for (const int block : {1, 4, 16})
        cells.push_back(fmt::format("{:.5f}", rms_of_blocks(read, truth, block)));
    return table_row(name, std::vector<double>(3, NAN), cells);
}

}  // namespace

std::string storage_tables() {
    std::string text =
        "\nRMS error in degrees of single texels, and of the means of 4 x 4 and 16 x 16 of them, "
        "on "
        "a smooth surface\n\n" +
        table_header({"1 texel", "4 x 4", "16 x 16"});
    text += row_of("8 bits", {8});
    text += row_of("8 bits, ordered", {8, Green::up, FlatCode::middle, Dither::ordered});
    text += row_of("8 bits, blue-noise", {8, Green::up, FlatCode::middle, Dither::blue_noise});
    text += row_of("16 bits", {16});
    text += row_of("16 bits, blue-noise", {16, Green::up, FlatCode::middle, Dither::blue_noise});
    text += row_of("32 bits", {32});
    return text;
}

}  // namespace relief::test
