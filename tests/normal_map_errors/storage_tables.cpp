// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "normal_map_errors/error_tables.h"
#include "storage_experiments.h"

namespace relief::test {
namespace {

constexpr int storage_side = 256;

/// One of the ways of normal_codes().
std::string row_of(const char* name, const std::string& code_name) {
    const Image ground_truth = image_of_normals(smooth_surface(storage_side), storage_side);
    for (const NormalCode& code : normal_codes()) {
        if (code.name != code_name) continue;
        const Image read = code.stored(ground_truth);
        std::vector<std::string> cells;
        for (const int block : {1, 4, 16})
            cells.push_back(fmt::format("{:.5f}", patch_errors(read, ground_truth, block).rms));
        return table_row(name, std::vector<double>(3, NAN), cells);
    }
    throw std::invalid_argument("no code " + code_name);
}

}  // namespace

std::string storage_tables() {
    std::string text =
        "\nRMS error in degrees of single texels, and of the means of 4 x 4 and 16 x 16 of them, "
        "on "
        "a smooth surface\n\n" +
        table_header({"1 texel", "4 x 4", "16 x 16"});
    text += row_of("8 bits", "xyz 8 bit");
    text += row_of("8 bits, zero at 128", "xyz 8 bit, zero at 128");
    text += row_of("8 bits, zero at 128, read as glTF and engines do",
                   "xyz 8 bit, zero at 128, read as glTF does");
    text += row_of("8 bits, ordered", "xyz 8 bit, ordered");
    text += row_of("8 bits, blue-noise", "xyz 8 bit, blue-noise");
    text += row_of("16 bits", "xyz 16 bit");
    text += row_of("16 bits, blue-noise", "xyz 16 bit, blue-noise");
    text += row_of("half floats", "xyz half");
    text += row_of("32 bits", "xyz float");
    return text;
}

}  // namespace relief::test
