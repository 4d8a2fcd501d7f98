// SPDX-License-Identifier: Apache-2.0
// Words and JSON of a conversion. Tests: tests/tools/relief_bake_test.cpp.
#include "bump/bump_summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bump/bump_accuracy_summary.h"
#include "common/choices.h"
#include "common/text.h"

namespace relief::tools {
namespace {

/// "gaussian of radius 2", or the plain name.
std::string kernel_words(const BumpOptions& bump) {
    const std::string name = name_of(*bump.kernel, kernel_choices());
    return bump.kernel == Kernel::gaussian
               ? fmt::format("{} of radius {}", name, bump.gaussian_radius)
               : name;
}

/// How deep the map is taken to be.
std::string depth_words(const BumpRequest& request, const BumpOptions& bump) {
    if (!request.height) return fmt::format("strength {:g} texels", bump.strength);
    return fmt::format("height {:g} over texels of {:g} x {:g}", bump.strength, bump.texel.x,
                       bump.texel.y);
}

/// Millions of pixels a second through the conversion itself, reading and writing left out.
double megapixels_per_second(const Baked& baked, const Stages& stages) {
    const double milliseconds = stages.milliseconds("convert");
    const double pixels = static_cast<double>(baked.input.width) * baked.input.height;
    return milliseconds > 0 ? pixels / milliseconds / 1000 : 0;
}

/// "clamp", and what the map shows where it decided.
std::string border_words(const Baked& baked) {
    const std::string words = wrap_words(*baked.bump.wrap) + " at the border";
    if (!baked.tiling) return words;
    return fmt::format("{} (across the seams it changes {:.2g} and {:.2g} times as much as inside)",
                       words, baked.tiling->seam_x, baked.tiling->seam_y);
}

std::string input_words(const Job& job, const Baked& baked) {
    const ImageInfo& input = baked.input;
    std::string words =
        fmt::format("{}: {} x {}, {}, {} bit", job.input.string(), input.width, input.height,
                    counted(static_cast<std::size_t>(input.channels), "channel"), input.bits);
    if (baked.is_streamed) words += ", row by row";
    if (baked.transparent > 0)
        words += fmt::format(", {} left flat", counted(baked.transparent, "transparent texel"));
    return words;
}

/// What stands in the file.
std::string content_words(const BumpFileFormat& format) {
    if (format.content == BumpContent::slope_moments) {
        return fmt::format("slope moments, 32 bit float, dh/dy {}{}",
                           name_of(format.normals.green, green_choices()),
                           format.write.half ? ", halves" : "");
    }
    std::string words = format_words(format.normals);
    if (format.xy_only) words += ", without z";
    if (format.alpha == MapAlpha::height) words += ", height in alpha";
    if (format.alpha == MapAlpha::keep) words += ", alpha kept";
    if (format.write.half) words += ", halves";
    return words;
}

nlohmann::ordered_json seams_json(const std::optional<Tiling>& tiling) {
    if (!tiling) return nullptr;
    return {tiling->seam_x, tiling->seam_y};
}

}  // namespace

void print_summary(const Job& job, const BumpRequest& request, const Baked& baked,
                   const Stages& stages) {
    print_entry("read", input_words(job, baked));
    print_entry("slopes", fmt::format("{}, {}, {}", kernel_words(baked.bump),
                                      depth_words(request, baked.bump), border_words(baked)));
    print_accuracy(baked.accuracy);
    print_entry("coded", content_words(baked.format));
    print_entry("findings",
                baked.findings.empty() ? std::vector<std::string>{"none"} : baked.findings.lines());
    print_entry("time",
                fmt::format("{} ({:.0f} MPixel/s without the files)", durations(stages.finished()),
                            megapixels_per_second(baked, stages)));
    print_entry("wrote", file_and_size(job.output));
}

std::string line_of(const Job& job, const Baked& baked, const Stages& stages) {
    double sum = 0;
    for (const Stage& stage : stages.finished())
        sum += stage.milliseconds;
    return fmt::format(
        "{}: {} x {}, {}, {}, {}", job.output.string(), baked.input.width, baked.input.height,
        kernel_words(baked.bump),
        baked.findings.empty() ? "no findings" : counted(baked.findings.all().size(), "finding"),
        duration(sum));
}

nlohmann::ordered_json results_json(const Baked& baked, const Stages& stages) {
    const BumpOptions& bump = baked.bump;
    const bool has_radius = bump.kernel == Kernel::gaussian;
    const NormalMapFormat& format = baked.format.normals;
    const bool has_slopes = baked.format.content == BumpContent::slope_moments;
    nlohmann::ordered_json json = {
        {"width", baked.input.width},
        {"height", baked.input.height},
        {"by_rows", baked.is_streamed},
        {"transparent", baked.transparent},
        {"kernel", name_of(*bump.kernel, kernel_choices())},
        {"kernel_radius", has_radius ? nlohmann::ordered_json(bump.gaussian_radius) : nullptr},
        {"strength", bump.strength},
        {"texel_size", {bump.texel.x, bump.texel.y}},
        {"wrap", wrap_words(*bump.wrap)},
        {"seams", seams_json(baked.tiling)},
        {"content", has_slopes ? "slope moments" : "normals"},
        {"xy_only", baked.format.xy_only},
        {"alpha", name_of(baked.format.alpha, map_alpha_choices())},
        {"bits", format.bits},
        {"green", name_of(format.green, green_choices())},
        {"zero_code", name_of(format.flat, zero_code_choices())},
        {"dither", name_of(format.dither, dither_choices())},
        {"findings", baked.findings.json()},
        {"milliseconds", durations_json(stages.finished())},
        {"megapixels_per_second", megapixels_per_second(baked, stages)}};
    add_accuracy(baked.accuracy, json);
    return json;
}

}  // namespace relief::tools
