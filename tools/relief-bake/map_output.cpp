// SPDX-License-Identifier: Apache-2.0
// Which depths a format holds exactly decides what is refused before anything is read.
// Tests: tests/tools/relief_bake_test.cpp.
#include "map_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/choices.h"
#include "common/options.h"
#include "common/text.h"

namespace relief::tools {
namespace {

/// "zero at 127.5 of 255 (as glTF and engines decode; flat texels are 0.32 degrees off)"
std::string zero_code_words(const NormalMapFormat& format) {
    const double largest = format.bits == 8 ? 255.0 : 65535.0;
    // Half a code in x and in y.
    const std::string degrees =
        fmt::format("{:.2g}", std::atan(std::numbers::sqrt2 / largest) * 180.0 / std::numbers::pi);
    if (format.flat == FlatCode::middle) {
        return fmt::format(
            "zero at {:g} of {:g} (glTF and engines decode zero at {:g}, so they read it {} "
            "degrees off)",
            (largest + 1.0) / 2.0, largest, largest / 2.0, degrees);
    }
    const std::string flat = format.dither == Dither::none
                                 ? fmt::format("; flat texels are {} degrees off", degrees)
                                 : "";
    return fmt::format("zero at {:g} of {:g} (as glTF and engines decode{})", largest / 2.0,
                       largest, flat);
}

[[noreturn]] void refuse(const std::filesystem::path& output) {
    const std::string extension = extension_of(output);
    std::string problem = "no format to write a normal map in";
    if (extension == ".jpg" || extension == ".jpeg") problem = "JPEG distorts normals";
    if (extension == ".hdr") problem = "HDR keeps 8 bits of a normal and no sign";
    throw UsageError(output.string() + ": " + problem, "use .png, .tif or .exr");
}

}  // namespace

std::vector<int> depths_of(const std::filesystem::path& output) {
    const std::string extension = extension_of(output);
    if (extension == ".png") return {16, 8};
    if (extension == ".tif" || extension == ".tiff") return {16, 8, 32};
    if (extension == ".exr") return {32};
    return {};
}

void add_map_output_options(CLI::App& app, MapOutputOptions& options, bool follows_input) {
    const std::string group = "Output";
    const auto or_input = [&](const std::string& otherwise) {
        return " Default: " + (follows_input ? std::string("that of the input.") : otherwise);
    };
    const Choices<int> depths = {{"8", 8}, {"16", 16}, {"32", 32}};
    add_choice(app, "--green", options.green, green_choices(),
               "Where green is bright: on slopes that face up in the image, as OpenGL and glTF "
               "want it (up), or down, as DirectX does (down)." +
                   or_input("up."))
        .group(group);
    add_choice(app, "--bits", options.bits, depths,
               "Bits per channel: 8 or 16 for .png, 8, 16 or 32 (float) for .tif, 32 for .exr." +
                   or_input("16, and 32 for .exr."))
        .group(group);
    add_choice(app, "--zero-code", options.flat, zero_code_choices(),
               "Which code of 255 stands for zero in 8 bits, and likewise of 65535 in 16 bits. "
               "127.5: glTF and engines decode maps so; no code is exactly zero. 128: flat texels "
               "are exactly flat for readers that know this, and engines read all normals "
               "0.32 degrees off in 8 bits, 0.0012 in 16." +
                   or_input("127.5."))
        .group(group);
    add_choice(app, "--dither", options.dither, dither_choices(),
               "How normals between two codes are rounded: to the nearest (none), or so that the "
               "mean over a few texels is right, by a short pattern (ordered) or one that the eye "
               "sees least (blue-noise). Default: none.")
        .group(group);
    add_switch(app, "--half", options.half,
               "Store .exr as half floats, 11 bits each: half the size.")
        .group(group);
    add_switch(app, "--fast", options.fast, "Write as fast as possible, at a larger file.")
        .group(group);
    add_switch(app, "--small", options.small,
               "Write the smallest file, which takes many times as long.")
        .group(group);
}

bool can_hold_normals(const std::filesystem::path& file) {
    return !depths_of(file).empty();
}

NormalMapFormat format_of(const MapOutputOptions& options, const std::filesystem::path& output,
                          const MapOutputDefaults& defaults) {
    const std::vector<int> depths = depths_of(output);
    if (depths.empty()) refuse(output);
    const auto holds = [&](int bits) {
        return std::find(depths.begin(), depths.end(), bits) != depths.end();
    };
    const int usual = defaults.bits && holds(*defaults.bits) ? *defaults.bits : depths.front();
    const int bits = options.bits.value_or(usual);
    if (!holds(bits)) {
        const bool wants_halves = bits == 16 && extension_of(output) == ".exr";
        throw UsageError(fmt::format("--bits {}: {} holds {} bits", bits, extension_of(output),
                                     fmt::join(depths, " or ")),
                         wants_halves ? "--half stores halves" : "");
    }
    if (bits == 32 && options.flat)
        throw UsageError("--zero-code: has no effect on 32-bit output, where zero is exact");
    if (bits == 32 && options.dither)
        throw UsageError("--dither: has no effect on 32-bit output, which needs no codes");
    return {.bits = bits,
            .green = options.green.value_or(defaults.green),
            .flat = options.flat.value_or(defaults.flat),
            .dither = options.dither.value_or(Dither::none)};
}

ImageWriteOptions write_options_of(const MapOutputOptions& options,
                                   const std::filesystem::path& output) {
    if (options.fast && options.small) throw UsageError("--fast, --small: contradict each other");
    if (options.half && extension_of(output) != ".exr")
        throw UsageError("--half: is for .exr, not " + output.filename().string());
    ImageWriteOptions result;
    result.half = options.half;
    if (options.fast) result.effort = WriteEffort::fast;
    if (options.small) result.effort = WriteEffort::small;
    return result;
}

std::string format_words(const NormalMapFormat& format) {
    const std::string green = "green " + name_of(format.green, green_choices());
    if (format.bits == 32) return "32 bit float, " + green;
    const std::string dither = format.dither == Dither::none
                                   ? ""
                                   : ", dithered " + name_of(format.dither, dither_choices());
    return fmt::format("{} bit, {}, {}{}", format.bits, zero_code_words(format), green, dither);
}

}  // namespace relief::tools
