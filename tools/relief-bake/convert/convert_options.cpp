// SPDX-License-Identifier: Apache-2.0
// The options of `relief-bake convert`, in the order in which they take effect.
// Tests: tests/tools/convert_test.cpp.
#include "convert/convert_options.h"

#include <fmt/format.h>

#include "common/choices.h"
#include "common/options.h"
#include "convert/convert_words.h"

namespace relief::tools {
namespace {

/// "x,-y,z"
AxisMapping parse_axes(const std::string& subject, const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    AxisMapping mapping;
    unsigned used = 0;
    for (std::size_t i = 0; i < parts.size() && i < 3; ++i) {
        const bool is_negative = parts[i].starts_with('-');
        const std::string axis = parts[i].substr(is_negative ? 1 : 0);
        const std::size_t index = axis.size() == 1 ? std::string("xyz").find(axis) : 3;
        if (index > 2) continue;
        mapping[i] = {static_cast<int>(index), is_negative};
        used |= 1U << index;
    }
    if (parts.size() != 3 || used != 7)
        throw UsageError(subject + ": not x, y and z in some order, like x,-y,z");
    if (mapping == same_axes) throw UsageError(subject + ": changes nothing");
    return mapping;
}

/// "512x256", or "50%"
SizeChoice parse_resize(const std::string& subject, const std::string& text) {
    constexpr int largest_side = 65536;
    if (text.ends_with('%')) {
        const std::string number = text.substr(0, text.size() - 1);
        return {{}, parse_number(subject, number, {0.01, 10000.0, "percent"}) / 100.0};
    }
    const std::vector<std::string> sides = split(text, 'x');
    if (sides.size() != 2) throw UsageError(subject + ": not a size like 512x512 or 50%");
    return {{parse_integer(subject, sides[0], 1, largest_side),
             parse_integer(subject, sides[1], 1, largest_side)},
            0.0};
}

/// "N" for both axes, or "NxM".
glm::dvec2 parse_repeat(const std::string& subject, const std::string& text) {
    const Range range{1e-3, 1e4, ""};
    const std::vector<std::string> parts = split(text, 'x');
    const double x = parse_number(subject, parts[0], range);
    if (parts.size() == 1) return {x, x};
    if (parts.size() > 2) throw UsageError(subject + ": not a number like 4, or two like 4x2");
    return {x, parse_number(subject, parts[1], range)};
}

/// "up", "down" or "auto"
AddedOption add_green(CLI::App& app, const std::string& name, MapInputOptions& input,
                      const std::string& description) {
    Choices<std::optional<Green>> choices = {{"auto", std::nullopt}};
    for (const auto& [word, green] : green_choices())
        choices.emplace_back(word, green);
    return add_value(app, name, "up|down|auto", description,
                     [&input, choices](const std::string& subject, const std::string& text) {
                         input.green = parse_choice(subject, text, choices);
                         input.finds_green = !input.green;
                     });
}

void add_input_options(CLI::App& app, ConvertRequest& request) {
    const std::string group = "Input";
    add_green(app, "--input-green", request.input,
              "Where green is bright in the input: on slopes that face up (OpenGL) or down "
              "(DirectX), or whichever its slopes show, as relief-bake check finds it (auto). "
              "Default: what the file says; else it is unknown, which --green alone minds.")
        .group(group);
    add_choice(
        app, "--input-zero-code", request.input.flat, zero_code_choices(),
        "Which code stands for zero in the input: see --zero-code. Default: what the file says, "
        "else 127.5. Flat texels are read as exactly flat under both.")
        .group(group);
    add_switch(app, "--input-signed", request.input.is_signed,
               "Float samples of the input hold n itself, from -1 to 1, not (n + 1) / 2, which is "
               "what is written.")
        .group(group);
    add_choice(app, "--rebuild-z", request.rebuild_z, xy_choices(),
               "Take x and y from red and green (rg), or from alpha and green (ag), and compute z. "
               "Where x and y are longer than 1, z is 0.")
        .group(group);
    add_switch(app, "--normalize", request.normalize,
               "Make every normal of length 1, and say how many were not. All that follows does "
               "so too.")
        .group(group);
    add_choice(app, "--alpha", request.alpha, alpha_choices(),
               "A fourth channel of the input: keep it, resized as the normals are, or drop it. "
               "Default: keep.")
        .group(group);
}

void add_axis_options(CLI::App& app, ConvertRequest& request) {
    const std::string group = "Axes: code by code, so that the way back gives the same bits";
    add_choice(app, "--flip", request.flip, flip_choices(),
               "Turn green round (OpenGL to DirectX and back), or red, or both.")
        .group(group);
    add_value(app, "--axes", "X,Y,Z",
              "What becomes x, y and z: x, y and z in any order, each with - before it or not; "
              "x,-y,z flips green, y,x,z swaps red and green. One that begins with - goes as "
              "--axes=-x,y,z.",
              [&](const std::string& subject, const std::string& text) {
                  request.axes = parse_axes(subject, text);
              })
        .group(group);
}

void add_resize_options(CLI::App& app, ResizeChoice& resize) {
    const std::string group = "Size";
    add_value(app, "--resize", "WxH|N%", "Make the map this large, in texels or of its own size.",
              [&](const std::string& subject, const std::string& text) {
                  resize.size = parse_resize(subject, text);
              })
        .group(group);
    add_choice(app, "--resize-filter", resize.filter, filter_choices(),
               "How texels are weighed. best: lanczos to shrink, cubic to enlarge. Default: best.")
        .group(group);
    add_choice(app, "--resize-of", resize.domain, domain_choices(),
               "What is averaged: slopes, which gives the normals of the surface filtered so, or "
               "the normals themselves (vectors), by which steep texels count for less. Default: "
               "slopes.")
        .group(group);
    add_wrap(app, resize.wrap,
             "What lies beyond the border: the opposite edge (repeat), the last texel (clamp), or "
             "the map mirrored (mirror). Two words: left and right, then top and bottom. Default: "
             "repeat.")
        .group(group);
}

void add_slope_options(CLI::App& app, ConvertRequest& request) {
    add_number(app, "--strength", "S", request.strength, {-1e6, 1e6, ""},
               "Multiply all slopes, as if heights had been: 2 is twice as deep, -1 turns bumps "
               "into dents.")
        .group("Slopes");
}

void add_detail_options(CLI::App& app, DetailChoice& detail) {
    const std::string group = "Detail";
    add_path(app, "--detail", detail.file, "Lay another normal map over this one.").group(group);
    add_choice(app, "--blend", detail.blend, blend_choices(),
               "How: docs/normal-maps.md has formulas, errors and times. reoriented carves the "
               "detail into the base, partial-derivative adds their heights. Default: reoriented.")
        .group(group);
    add_number(app, "--detail-strength", "S", detail.strength, {-1e6, 1e6, ""},
               "Multiply the slopes of the detail first. Default: 1.")
        .group(group);
    add_value(app, "--detail-repeat", "N[xM]",
              "How often the detail is seen across the base, and up and down. It is resized for "
              "that, as slopes, by --resize-filter. Default: 1, stretched over all of it.",
              [&](const std::string& subject, const std::string& text) {
                  detail.repeat = parse_repeat(subject, text);
              })
        .group(group);
    add_green(app, "--detail-green", detail.input,
              "The same for the detail. Default: what its file says, else as in the base.")
        .group(group);
    add_choice(app, "--detail-zero-code", detail.input.flat, zero_code_choices(),
               "Which code stands for zero in the detail. Default: as for --input-zero-code.")
        .group(group);
}

void add_mip_options(CLI::App& app, MipChoice& mips) {
    const std::string group = "Mip levels";
    add_switch(app, "--mips", mips.wanted,
               "Write all smaller levels too: OUT-mip01, at half the size, and so on, with OUT's "
               "extension. Each holds the directions of mean vectors.")
        .group(group);
    add_switch(app, "--mip-lengths", mips.lengths,
               "Store in the alpha of OUT and of each level how long the mean vectors are: 1 where "
               "all normals agree.")
        .group(group);
    add_number(app, "--roughness-from-variance", "R", mips.roughness, {0.0, 1.0, ""},
               "For a surface of roughness R (glTF's), write for OUT and each level the roughness "
               "that makes up for the normals averaged away: OUT-roughness, OUT-roughness-mip01, "
               "and so on.")
        .group(group);
}

void need(bool is_given, const std::string& option, const std::string& other) {
    if (is_given) throw UsageError(option + ": has no effect without " + other);
}

}  // namespace

void add_convert_options(CLI::App& app, ConvertRequest& request) {
    add_input_options(app, request);
    add_axis_options(app, request);
    add_resize_options(app, request.resize);
    add_slope_options(app, request);
    add_detail_options(app, request.detail);
    add_space_options(app, request.space);
    add_mip_options(app, request.mips);
}

void check_convert_options(const ConvertRequest& request) {
    const DetailChoice& detail = request.detail;
    if (request.flip && request.axes)
        throw UsageError("--flip, --axes: both say what becomes of the axes");
    if (request.flip && *request.flip != Flip::red && request.output.green)
        throw UsageError("--flip, --green: both say what becomes of green");
    if (request.normalize && request.rebuild_z)
        throw UsageError("--normalize: normals with a computed z are of length 1 anyway");
    check_space_options(request.space);
    if (request.space.to_object && request.output.green)
        throw UsageError("--green, --to-object: object space has no green");
    if (request.space.to_tangent && (request.input.green || request.flip))
        throw UsageError(fmt::format("{}, --to-tangent: object space has no green",
                                     request.flip ? "--flip" : "--input-green"));
    if (!detail.file) {
        need(detail.blend.has_value(), "--blend", "--detail");
        need(detail.strength.has_value(), "--detail-strength", "--detail");
        need(detail.repeat.has_value(), "--detail-repeat", "--detail");
        need(detail.input.green || detail.input.finds_green, "--detail-green", "--detail");
        need(detail.input.flat.has_value(), "--detail-zero-code", "--detail");
    }
    if (!request.resize.size) {
        need(request.resize.domain.has_value(), "--resize-of", "--resize");
        need(request.resize.wrap.has_value(), "--wrap", "--resize");
        if (!detail.file)
            need(request.resize.filter.has_value(), "--resize-filter", "--resize or --detail");
    }
    if (!request.mips.wanted) {
        need(request.mips.lengths, "--mip-lengths", "--mips");
        need(request.mips.roughness.has_value(), "--roughness-from-variance", "--mips");
    }
}

AxisMapping mapping_of(const ConvertRequest& request) {
    AxisMapping mapping = request.axes.value_or(same_axes);
    if (!request.flip) return mapping;
    mapping[0].is_negative = *request.flip != Flip::green;
    mapping[1].is_negative = *request.flip != Flip::red;
    return mapping;
}

}  // namespace relief::tools
