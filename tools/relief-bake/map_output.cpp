// SPDX-License-Identifier: Apache-2.0
// Which depths a format holds exactly decides what is refused before anything is read.
// Tests: tests/tools/relief_bake_test.cpp.
#include "map_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "common/map_choices.h"
#include "common/options.h"
#include "common/text.h"

namespace relief::tools {
namespace {

/// The depths that a format can hold normals in, the first being the one to use unless asked; none
/// where it can hold none.
std::vector<int> depths_of(const std::filesystem::path& output) {
    const std::string extension = extension_of(output);
    if (extension == ".png") return {16, 8};
    if (extension == ".tif" || extension == ".tiff") return {16, 8, 32};
    if (extension == ".exr") return {32};
    return {};
}

[[noreturn]] void refuse(const std::filesystem::path& output) {
    const std::string extension = extension_of(output);
    std::string problem = "no format to write a normal map in";
    if (extension == ".jpg" || extension == ".jpeg") problem = "JPEG distorts normals";
    if (extension == ".hdr") problem = "HDR keeps 8 bits of a normal and no sign";
    throw UsageError(output.string() + ": " + problem, "use .png, .tif or .exr");
}

}  // namespace

void add_map_output_options(CLI::App& app, MapOutputOptions& options) {
    const std::string group = "Output";
    const Choices<int> depths = {{"8", 8}, {"16", 16}, {"32", 32}};
    add_choice(app, "--green", options.green, green_choices(),
               "Where green is bright: on slopes that face up in the image, as OpenGL and glTF "
               "want it (up), or down, as DirectX does (down). Default: up.")
        ->group(group);
    add_choice(app, "--bits", options.bits, depths,
               "Bits per channel: 8 or 16 for .png, 8, 16 or 32 (float) for .tif, 32 for .exr. "
               "Default: 16, and 32 for .exr.")
        ->group(group);
    add_choice(app, "--flat", options.flat, flat_choices(),
               "Which code stands for zero in 8 and 16 bits: 128 of 255, so that flat is exactly "
               "flat (middle), or 127.5, as glTF's formula has it and no code can say (half). "
               "Default: middle.")
        ->group(group);
}

bool can_hold_normals(const std::filesystem::path& file) {
    return !depths_of(file).empty();
}

NormalMapFormat format_of(const MapOutputOptions& options, const std::filesystem::path& output) {
    const std::vector<int> depths = depths_of(output);
    if (depths.empty()) refuse(output);
    const int bits = options.bits.value_or(depths.front());
    if (std::find(depths.begin(), depths.end(), bits) == depths.end()) {
        throw UsageError(fmt::format("--bits {}: {} holds {} bits", bits, extension_of(output),
                                     fmt::join(depths, " or ")));
    }
    if (bits == 32 && options.flat)
        throw UsageError("--flat: has no effect on 32-bit output, where flat is exact");
    return {.bits = bits,
            .green = options.green,
            .flat = options.flat.value_or(NormalMapFormat{}.flat)};
}

std::string format_words(const NormalMapFormat& format) {
    const std::string green = "green " + name_of(format.green, green_choices());
    if (format.bits == 32) return "32 bit float, " + green;
    return fmt::format("{} bit, flat is {}, {}", format.bits,
                       format.flat == FlatCode::middle ? "the middle code" : "between codes",
                       green);
}

}  // namespace relief::tools
