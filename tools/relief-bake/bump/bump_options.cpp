// SPDX-License-Identifier: Apache-2.0
// Options in groups, as --help shows them, and what contradicts what.
// Tests: tests/tools/relief_bake_test.cpp.
#include "bump/bump_options.h"

#include "common/choices.h"

namespace relief::tools {
namespace {

/// "W" or "WxH".
glm::dvec2 parse_texel(const std::string& subject, const std::string& text) {
    const Range sizes{1e-30, 1e30, ""};
    const std::size_t cross = text.find('x');
    const double width = parse_number(subject, text.substr(0, cross), sizes);
    if (cross == std::string::npos) return {width, width};
    return {width, parse_number(subject, text.substr(cross + 1), sizes)};
}

void add_height_options(CLI::App& app, BumpRequest& request) {
    const std::string group = "Heights";
    add_choice(app, "--channel", request.channel, height_channel_choices(),
               "What of a colour is the height; luminance is that of decoded sRGB. Grey has one "
               "height, which mean, luminance and red take. Default: mean.")
        .group(group);
    add_switch(app, "--ignore-alpha", request.ignore_alpha,
               "Take transparent texels for a part of the surface. Default: where alpha is 0, the "
               "map becomes flat, and the surface beside does not see what colour stands there.")
        .group(group);
    add_switch(app, "--invert", request.invert,
               "Black is high and white is deep: as the same --strength with the other sign.")
        .group(group);
}

void add_depth_options(CLI::App& app, BumpRequest& request) {
    const std::string group = "Slopes";
    const Range depths{-1e30, 1e30, ""};  // As normals_from_height() takes them.
    add_number(app, "--strength", "S", request.strength, depths,
               "Height in texels that the value 1.0 (white) stands for; negative turns bumps into "
               "dents. Default: 16.")
        .group(group);
    add_number(app, "--height", "H", request.height, depths,
               "Instead of --strength: the height of white in a unit of length; with "
               "--texel-size.")
        .group(group);
    add_value(app, "--texel-size", "W[xH]",
              "Width (and height, where texels are not square) of a texel in the unit of --height.",
              [&](const std::string& subject, const std::string& text) {
                  request.texel = parse_texel(subject, text);
              })
        .group(group);
}

void add_slope_options(CLI::App& app, BumpRequest& request) {
    const std::string group = "Slopes";
    add_value(app, "--kernel-radius", "R",
              "Texels that --kernel gaussian reaches, 1 to 64. Default: 2.",
              [&](const std::string& subject, const std::string& text) {
                  request.gaussian_radius = parse_integer(subject, text, 1, largest_kernel_radius);
              })
        .group("Accuracy");
    add_wrap(
        app, request.wrap,
        "What lies beyond the border: the opposite edge, for maps that tile (repeat), "
        "nothing, so that slopes there are one-sided (clamp), the map mirrored (mirror); or by "
        "whether it goes on smoothly across the seam, repeat or clamp (auto). Two words: left "
        "and right, then top and bottom. Default: auto.")
        .group(group);
}

}  // namespace

void add_bump_options(CLI::App& app, BumpRequest& request) {
    add_height_options(app, request);
    add_depth_options(app, request);
    add_accuracy_options(app, request.accuracy);
    add_slope_options(app, request);
}

void add_bump_content_options(CLI::App& app, BumpRequest& request) {
    const std::string group = "Output";
    add_switch(app, "--xy", request.xy_only,
               "Leave z out, which shaders find from x and y: blue is 0.")
        .group(group);
    add_choice(app, "--alpha", request.alpha, map_alpha_choices(),
               "What goes into alpha: nothing, the height (as parallax mapping needs it), or the "
               "alpha of the height map. Default: none.")
        .group(group);
    add_switch(app, "--slope-moments", request.slope_moments,
               "Write height, dh/dx, dh/dy, their squares and their product instead of normals: "
               "six float channels (.exr or .tif), which can be filtered (LEAN mapping), by the "
               "names that maketx --bumpslopes gives them.")
        .group(group);
}

BumpOptions bump_of(const BumpRequest& request) {
    if (request.strength && request.height)
        throw UsageError("--strength, --height: both say how deep the map is");
    if (request.height && !request.texel)
        throw UsageError("--height: needs the size of a texel in the same unit",
                         "give --texel-size, or --strength instead");
    if (request.texel && !request.height)
        throw UsageError("--texel-size: says in which unit --height is", "give --height");
    if (request.gaussian_radius && request.accuracy.kernel != Kernel::gaussian)
        throw UsageError("--kernel-radius: is for --kernel gaussian");
    check(request.accuracy, request.slope_moments, request.output.half);
    BumpOptions bump = request.bump;
    bump.strength = request.height ? *request.height : request.strength.value_or(bump.strength);
    if (request.invert) bump.strength = -bump.strength;
    bump.texel = request.texel.value_or(bump.texel);
    bump.gaussian_radius = request.gaussian_radius.value_or(bump.gaussian_radius);
    return bump;
}

BumpFileFormat file_format_of(const BumpRequest& request, const std::filesystem::path& output) {
    BumpFileFormat format;
    format.write = write_options_of(request.output, output);
    format.xy_only = request.xy_only;
    format.alpha = request.alpha;
    if (!request.slope_moments) {
        format.normals = format_of(request.output, output);
        return format;
    }
    const auto refuse = [](bool is_given, const char* option) {
        if (is_given)
            throw UsageError(fmt::format("{}, --slope-moments: contradict each other", option));
    };
    refuse(request.xy_only, "--xy");
    refuse(request.alpha != MapAlpha::none, "--alpha");
    refuse(request.output.flat.has_value(), "--zero-code");
    refuse(request.output.dither.has_value(), "--dither");
    refuse(request.output.bits.value_or(32) != 32, "--bits");
    MapOutputOptions floats = request.output;
    floats.bits = 32;
    format.content = BumpContent::slope_moments;
    format.normals = format_of(floats, output);
    return format;
}

}  // namespace relief::tools
