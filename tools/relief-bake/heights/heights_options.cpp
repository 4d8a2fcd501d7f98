// SPDX-License-Identifier: Apache-2.0
#include "heights/heights_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "common/choices.h"
#include "common/options.h"
#include "common/text.h"

namespace relief::tools {
namespace {

/// The depths that a format can hold heights in, the first being the one to use unless asked.
std::vector<int> height_depths_of(const std::filesystem::path& output) {
    const std::string extension = extension_of(output);
    if (extension == ".png") return {16, 8};
    if (extension == ".tif" || extension == ".tiff") return {16, 8, 32};
    if (extension == ".exr") return {32};
    throw UsageError(output.string() + ": no format to write heights in", "use .png, .tif or .exr");
}

}  // namespace

void add_heights_options(CLI::App& app, HeightsRequest& request) {
    const std::string input = "Input";
    add_choice(app, "--input-green", request.input.green, green_choices(),
               "Where green is bright in the input: on slopes that face up (OpenGL) or down "
               "(DirectX). Default: what the file says, else what its slopes show.")
        .group(input);
    add_choice(
        app, "--input-zero-code", request.input.flat, zero_code_choices(),
        "Which code stands for zero in the input: 128 of 255, or 127.5 as glTF decodes. "
        "Default: what the file says, else 127.5. Flat texels are read as exactly flat under both.")
        .group(input);
    add_switch(app, "--input-signed", request.input.is_signed,
               "Float samples of the input hold the components themselves, not (n + 1) / 2.")
        .group(input);
    const std::string group = "Heights";
    add_choice(app, "--kernel", request.integration.kernel, kernel_choices(),
               "The kernel by which relief-bake bump will give the normals back. central7 knows "
               "the slopes of smooth maps best. Default: central7.")
        .group(group);
    add_wrap(app, request.wrap,
             "What lies beyond the border: the opposite edge, for maps that tile (repeat), nothing "
             "(clamp), the map mirrored (mirror); or repeat or clamp by whether the map goes on "
             "smoothly across the seam (auto). Two words: left and right, then top and bottom. "
             "Default: auto.")
        .group(group);
    add_number(app, "--steepest", "S", request.integration.steepest, {1e-3, 1e6, ""},
               "Cut steeper slopes to this, and those of normals that face sideways or back; they "
               "are counted. Default: 16, which is 86 degrees.")
        .group(group);
    add_switch(app, "--level", request.integration.level,
               "Take the mean slope out first: maps whose flat texels are a code off would tilt.")
        .group(group);
    const Choices<int> depths = {{"8", 8}, {"16", 16}, {"32", 32}};
    add_choice(app, "--bits", request.bits, depths,
               "Bits of a height: 8 or 16 for .png, 8, 16 or 32 (float) for .tif, 32 for .exr. "
               "Floats hold texels; codes span the lowest to the highest. Default: 16, and 32 for "
               ".exr.")
        .group("Output");
}

int bits_of(const HeightsRequest& request, const std::filesystem::path& output) {
    const std::vector<int> depths = height_depths_of(output);
    const int bits = request.bits.value_or(depths.front());
    if (std::find(depths.begin(), depths.end(), bits) == depths.end()) {
        throw UsageError(fmt::format("--bits {}: {} holds {} bits", bits, extension_of(output),
                                     fmt::join(depths, " or ")));
    }
    return bits;
}

}  // namespace relief::tools
