// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "normal_map_errors/error_tables.h"
#include "relief/mesh/normal_map.h"
#include "storage/normal_codes.h"

namespace relief::test {
namespace {

constexpr int storage_side = 256;

std::string row_of(const char* name, const NormalMapFormat& format) {
    const Image truth = image_of_normals(smooth_surface(storage_side), storage_side);
    Report report;
    const Image read = decode_normal_map(encode_normal_map(truth, format, report), format.green,
                                         format.flat, report);
    std::vector<std::string> cells;
    for (const int block : {1, 4, 16})
        cells.push_back(fmt::format("{:.5f}", patch_errors(read, truth, block).rms));
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
