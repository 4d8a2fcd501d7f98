// SPDX-License-Identifier: Apache-2.0
// The steps from a normal map to heights. Codes span the lowest to the highest height, floats are
// heights in texels; either way the file says the strength that undoes it.
// Tests: tests/tools/relief_bake_heights_test.cpp.
#include "heights/heights_job.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/choices.h"
#include "common/text.h"
#include "relief/mesh/image_channels.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map_check.h"

namespace relief::tools {
namespace {

/// By the command line, the file, or the slopes. \throws FileError if none of these knows
void settle_green(const Job& job, const InputMap& input, MadeHeights& made) {
    std::optional<Green> green = input.green;
    if (!green) {
        green = check_normal_map(input.image).green.green;
        made.green_by_slopes = true;
    }
    if (!green) {
        throw failure(job.input, "where its green is bright is not known, nor do its slopes tell",
                      "give --input-green");
    }
    made.green = *green;
}

Wraps settled_wraps(const HeightsRequest& request, const Image& normals) {
    Wraps wraps = request.wrap.value_or(Wrap::repeat);
    for (const int channel : {0, 1}) {
        if (request.wrap.is_settled()) break;
        const Wraps shown = detect_tiling(channel_of(normals, channel)).wraps();
        if (!request.wrap.x && shown.x == Wrap::clamp) wraps.x = Wrap::clamp;
        if (!request.wrap.y && shown.y == Wrap::clamp) wraps.y = Wrap::clamp;
    }
    return wraps;
}

template <typename Code>
Image coded(const Image& heights, double highest) {
    constexpr auto largest = static_cast<double>(std::numeric_limits<Code>::max());
    Image codes =
        make_image(heights.width, heights.height, 1, sizeof(Code) == 1 ? 8 : 16, ColorSpace::data);
    const double scale = highest > 0.0 ? largest / highest : 0.0;
    for (std::size_t i = 0; i < codes.sample_count(); ++i) {
        const double code = static_cast<double>(heights.as<float>()[i]) * scale;
        codes.as<Code>()[i] = static_cast<Code>(std::min(largest, std::floor(code + 0.5)));
    }
    return codes;
}

/// The heights as they are stored; says what 1.0 stands for.
Image stored(MadeHeights& made) {
    if (made.bits == 32) return std::move(made.result.heights);
    made.strength = made.result.highest > 0.0 ? made.result.highest : 1.0;
    Image codes = made.bits == 8 ? coded<std::uint8_t>(made.result.heights, made.result.highest)
                                 : coded<std::uint16_t>(made.result.heights, made.result.highest);
    made.result.heights = Image{};
    return codes;
}

std::map<std::string, std::string> metadata_of(const MadeHeights& made) {
    return {{"relief:content", "height map"},
            {"relief:strength", fmt::format("{:.9g}", made.strength)},
            {"relief:kernel", name_of(made.integration.kernel, kernel_choices())},
            {"relief:wrap", wrap_words(made.integration.wrap)}};
}

/// What rounding to codes does to the slopes that the kernel finds, in degrees where they are flat.
double degrees_of_steps(const MadeHeights& made) {
    if (made.bits == 32) return 0.0;
    const double step = made.strength / (made.bits == 8 ? 255.0 : 65535.0);
    const double deviation =
        step / std::sqrt(12.0) *
        noise_gain(gradient_kernel(made.integration.kernel, made.integration.gaussian_radius));
    return std::atan(deviation) * 180.0 / std::acos(-1.0);
}

std::string stored_words(const MadeHeights& made) {
    if (made.bits == 32) return "32 bit float, in texels";
    return fmt::format(
        "{} bit, white is {:.6g} texels; steps of {:.3g} texels tilt normals by {:.3g} "
        "degrees (RMS)",
        made.bits, made.strength, made.strength / (made.bits == 8 ? 255.0 : 65535.0),
        degrees_of_steps(made));
}

/// The command that makes the normal map again.
std::string way_back(const Job& job, const MadeHeights& made) {
    return fmt::format(
        "relief-bake bump {} normals.png --strength {:.9g} --kernel {} --wrap {}{}",
        job.output.string(), made.strength, name_of(made.integration.kernel, kernel_choices()),
        wrap_words(made.integration.wrap), made.green == Green::down ? " --green down" : "");
}

}  // namespace

MadeHeights make_heights(const Job& job, const HeightsRequest& request, Stages& stages) {
    MadeHeights made;
    Report report;
    made.integration = request.integration;
    made.bits = bits_of(request, job.output);
    InputMap input = stages.run("read", [&] { return read_normal_map(job.input, request.input); });
    made.width = input.image.width;
    made.height = input.image.height;
    made.channels = input.image.channels;
    made.bits_read = input.image.bits();
    made.input_words = input.words;
    const Image file = about(job.input, [&] {
        return stages.run("integrate", [&] {
            settle_green(job, input, made);
            const Image normals =
                decode_normal_map(input.image, made.green, input.flat, report, FlatTexels::exact);
            input.image = Image{};
            made.integration.wrap = settled_wraps(request, normals);
            made.result = heights_from_normals(normals, made.integration, report);
            return stored(made);
        });
    });
    stages.run("write", [&] { write_image(job.output, file, metadata_of(made)); });
    made.findings.add("", report);
    return made;
}

void print_summary(const Job& job, const MadeHeights& made, const Stages& stages) {
    const IntegratedHeights& result = made.result;
    print_entry("read", fmt::format("{}: {} x {}, {}, {} bit, {}", job.input.string(), made.width,
                                    made.height,
                                    counted(static_cast<std::size_t>(made.channels), "channel"),
                                    made.bits_read, made.input_words));
    if (made.green_by_slopes)
        print_entry("green", name_of(made.green, green_choices()) + ", by its slopes");
    print_entry("slopes",
                fmt::format("{:.4g} (RMS), mean {:.3g} and {:.3g}{}, by {}, {} at the border",
                            result.rms_slope, result.mean_slope.x, result.mean_slope.y,
                            made.integration.level ? " taken out" : "",
                            name_of(made.integration.kernel, kernel_choices()),
                            wrap_words(made.integration.wrap)));
    print_entry("residual",
                fmt::format("slopes {:.3g} (RMS) belong to no surface: {:.3g} degrees, {:.3g} at "
                            "most{}",
                            result.residual_slope, result.residual.rms, result.residual.max,
                            result.rounds > 1 ? fmt::format(" ({} rounds)", result.rounds) : ""));
    print_entry("heights", fmt::format("0 to {:.6g} texels", result.highest));
    print_entry("stored", stored_words(made));
    print_entry("way back", way_back(job, made));
    print_entry("findings",
                made.findings.empty() ? std::vector<std::string>{"none"} : made.findings.lines());
    print_entry("time", durations(stages.finished()));
    print_entry("wrote", file_and_size(job.output));
}

std::string line_of(const Job& job, const MadeHeights& made, const Stages& stages) {
    double sum = 0.0;
    for (const Stage& stage : stages.finished())
        sum += stage.milliseconds;
    return fmt::format("{}: {} x {}, strength {:.6g}, residual {:.3g} degrees, {}",
                       job.output.string(), made.width, made.height, made.strength,
                       made.result.residual.rms, duration(sum));
}

nlohmann::ordered_json results_json(const MadeHeights& made, const Stages& stages) {
    return {{"width", made.width},
            {"height", made.height},
            {"green", name_of(made.green, green_choices())},
            {"green_by_slopes", made.green_by_slopes},
            {"kernel", name_of(made.integration.kernel, kernel_choices())},
            {"wrap", wrap_words(made.integration.wrap)},
            {"steepest", made.integration.steepest},
            {"bits", made.bits},
            {"strength", made.strength},
            {"highest", made.result.highest},
            {"level", made.integration.level},
            {"rms_slope", made.result.rms_slope},
            {"mean_slope", {made.result.mean_slope.x, made.result.mean_slope.y}},
            {"residual_slope", made.result.residual_slope},
            {"residual_degrees",
             {{"rms", made.result.residual.rms},
              {"mean", made.result.residual.mean},
              {"max", made.result.residual.max}}},
            {"rounds", made.result.rounds},
            {"step_degrees", degrees_of_steps(made)},
            {"findings", made.findings.json()},
            {"milliseconds", durations_json(stages.finished())}};
}

}  // namespace relief::tools
