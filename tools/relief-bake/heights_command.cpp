// SPDX-License-Identifier: Apache-2.0
// The command `relief-bake heights`: options, the conversion of a normal map to a height map, and
// its summary. Integer files map 0 to the lowest and the largest code to the highest height; float
// files store heights in texels. Tests: tests/tools/relief_bake_heights_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "commands.h"
#include "common/normal_map_input.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image.h"
#include "relief/mesh/normal_map_check.h"

namespace relief::tools {
namespace {

struct HeightsRequest {
    MapInputOptions input;
    IntegrationOptions integration;  ///< All except the border mode.
    WrapsOrAuto wrap{};
    std::optional<int> bits{};
    double max_residual = 5.0;  ///< RMS in degrees, above which the residual is a finding.
};

/// The result of a conversion.
struct HeightsConversion {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits_read = 0;
    std::string input_text;
    Green green = Green::up;
    bool green_by_slopes = false;
    IntegrationOptions integration;
    IntegratedHeights result;  ///< Without the heights themselves.
    int bits = 16;
    double strength = 1.0;  ///< The height of the stored value 1.0, in texels.
    Findings findings;

    [[nodiscard]] double code_step() const { return strength / (bits == 8 ? 255.0 : 65535.0); }
};

/// The bit depths in which a file format can store heights, the default first.
std::vector<int> height_depths_of(const std::filesystem::path& output) {
    const std::vector<int> depths = depths_of(output);
    if (depths.empty()) {
        throw UsageError(output.string() + ": the format cannot store heights",
                         "use .png, .tif or .exr");
    }
    return depths;
}

/// \throws UsageError if the format cannot store heights, or not with this depth
int bits_of(const HeightsRequest& request, const std::filesystem::path& output) {
    const std::vector<int> depths = height_depths_of(output);
    const int bits = request.bits.value_or(depths.front());
    check_depth("--bits", bits, output, depths);
    return bits;
}

void add_heights_options(CLI::App& app, HeightsRequest& request) {
    const std::string input = "Input";
    add_choice(app, "--input-green", request.input.green, enum_choices<Green>(),
               "Direction of the green channel of the input: up (OpenGL) or down (DirectX). "
               "Default: from the file's metadata, else detected from the slopes.")
        .group(input);
    add_choice(app, "--input-zero-code", request.input.flat, enum_choices<FlatCode>(),
               "The code of 255 that represents zero in the input: 128, or 127.5 as in glTF. Flat "
               "texels are read as exactly flat with both. Default: from the file's metadata, else "
               "127.5.")
        .group(input);
    add_switch(app, "--input-signed", request.input.is_signed,
               "Float samples of the input store the components n from -1 to 1, not (n + 1) / 2.")
        .group(input);
    add_assume_option(app, request.input.assumed, {MapKind::normal}).group(input);
    const std::string group = "Heights";
    add_choice(app, "--kernel", request.integration.kernel, enum_choices<Kernel>(),
               "The kernel with which relief-bake bump will reproduce the normals. central7 is the "
               "most accurate for smooth maps. Default: central7.")
        .group(group);
    add_wrap(app, request.wrap,
             "Border mode: repeat uses the opposite edge, for maps that tile; clamp uses one-sided "
             "differences; mirror uses the mirrored map; auto chooses repeat if the map continues "
             "smoothly across the seam, else clamp. Two words set left and right, then top and "
             "bottom. Default: auto.")
        .group(group);
    add_number(app, "--steepest", "S", request.integration.max_slope, {1e-3, 1e6, ""},
               "Maximum slope. Steeper slopes, and those of normals that point sideways or "
               "backwards, are limited to it and counted. Default: 16, which is 86 degrees.")
        .group(group);
    add_switch(app, "--level", request.integration.level,
               "First remove the mean slope: a map whose flat texels are off by one code would "
               "tilt.")
        .group(group);
    add_number(app, "--max-residual", "DEG", request.max_residual, {0.0, 180.0, "degrees"},
               fmt::format("Residual (RMS) above which it is reported that no height field has the "
                           "slopes of the map. Default: {:g}.",
                           HeightsRequest{}.max_residual))
        .group(group);
    const Choices<int> depths = {{"8", 8}, {"16", 16}, {"32", 32}};
    add_choice(app, "--bits", request.bits, depths,
               "Bits of a height: 8 or 16 for .png; 8, 16 or 32 (float) for .tif; 32 for .exr. "
               "Floats store texels; codes range from the lowest to the highest height. Default: "
               "16, and 32 for .exr.")
        .group("Output");
}

/// Chooses the green direction from the options, the file or the slopes.
/// \throws FileError if none of them shows it
void choose_green(const Job& job, const InputMap& input, HeightsConversion& conversion) {
    std::optional<Green> green = input.green;
    if (!green) {
        green = check_normal_map(input.image).green.green;
        conversion.green_by_slopes = true;
    }
    if (!green) {
        throw failure(job.input,
                      "the direction of the green channel is unknown, and the slopes do not show "
                      "it",
                      "give --input-green");
    }
    conversion.green = *green;
}

Wraps choose_wraps(const HeightsRequest& request, const Image& normals) {
    Wraps wraps = request.wrap.value_or(Wrap::repeat);
    if (request.wrap.is_settled()) return wraps;
    for (const int channel : {0, 1}) {
        const Wraps detected = detect_tiling(channel_of(normals, channel)).wraps();
        if (!request.wrap.x && detected.x == Wrap::clamp) wraps.x = Wrap::clamp;
        if (!request.wrap.y && detected.y == Wrap::clamp) wraps.y = Wrap::clamp;
    }
    return wraps;
}

template <typename Code>
Image encode_heights(const Image& heights, double highest) {
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

/// Moves the heights into the image that is stored, and sets the strength of its values.
Image take_stored_heights(HeightsConversion& conversion) {
    IntegratedHeights& result = conversion.result;
    if (conversion.bits == 32) return std::move(result.heights);
    conversion.strength = result.highest > 0.0 ? result.highest : 1.0;
    Image codes = conversion.bits == 8
                      ? encode_heights<std::uint8_t>(result.heights, result.highest)
                      : encode_heights<std::uint16_t>(result.heights, result.highest);
    result.heights = Image{};
    return codes;
}

std::map<std::string, std::string> metadata_of(const HeightsConversion& conversion) {
    std::map<std::string, std::string> entries = {
        {"relief:strength", fmt::format("{:.9g}", conversion.strength)},
        {"relief:kernel", enum_name(conversion.integration.kernel)},
        {"relief:wrap", name_of(conversion.integration.wrap)}};
    entries.merge(write_description({.kind = MapKind::height, .color_space = ColorSpace::data},
                                    conversion.bits));
    return entries;
}

/// Reports a map that contains much that no height field has.
void report_residual(const HeightsRequest& request, const IntegratedHeights& result,
                     Report& report) {
    if (result.residual.rms <= request.max_residual) return;
    report.add(
        "map whose slopes are not those of a height field", "map", 0,
        fmt::format("{:.3g} degrees (RMS) of it are lost, more than the limit of {:g}: a bake, "
                    "or maps that were blended?",
                    result.residual.rms, request.max_residual));
}

/// Reads, integrates and writes. The stages are "read", "integrate" and "write".
/// \throws FileError, UsageError
HeightsConversion convert_heights(const Job& job, const HeightsRequest& request, Stages& stages) {
    HeightsConversion conversion;
    Report report;
    conversion.integration = request.integration;
    conversion.bits = bits_of(request, job.output);
    InputMap input = stages.run("read", [&] { return read_normal_map(job.input, request.input); });
    conversion.width = input.image.width;
    conversion.height = input.image.height;
    conversion.channels = input.image.channels;
    conversion.bits_read = input.image.bits();
    conversion.input_text = input.conventions;
    const Image file = about(job.input, [&] {
        return stages.run("integrate", [&] {
            choose_green(job, input, conversion);
            const Image normals = decode_normal_map(input.image, conversion.green, input.flat,
                                                    report, FlatTexels::exact);
            input.image = Image{};
            conversion.integration.wrap = choose_wraps(request, normals);
            conversion.result = heights_from_normals(normals, conversion.integration, report);
            return take_stored_heights(conversion);
        });
    });
    report_residual(request, conversion.result, report);
    stages.run("write", [&] { write_image(job.output, file, metadata_of(conversion)); });
    conversion.findings.add("", report, conversion.width);
    return conversion;
}

/// The RMS error of flat normals that rounding to codes causes, in degrees.
double rounding_degrees(const HeightsConversion& conversion) {
    if (conversion.bits == 32) return 0.0;
    const IntegrationOptions& integration = conversion.integration;
    const double deviation =
        conversion.code_step() / std::sqrt(12.0) *
        noise_gain(gradient_kernel(integration.kernel, integration.gaussian_radius));
    return std::atan(deviation) * 180.0 / std::acos(-1.0);
}

std::string storage_text(const HeightsConversion& conversion) {
    if (conversion.bits == 32) return "32 bit float, in texels";
    return fmt::format(
        "{} bit, white is {:.6g} texels; a code step of {:.3g} texels tilts normals by {:.3g} "
        "degrees (RMS)",
        conversion.bits, conversion.strength, conversion.code_step(), rounding_degrees(conversion));
}

/// The command that computes the normal map from the heights.
std::string inverse_command(const Job& job, const HeightsConversion& conversion) {
    return fmt::format("relief-bake bump {} normals.png --strength {:.9g} --kernel {} --wrap {}{}",
                       job.output.string(), conversion.strength,
                       enum_name(conversion.integration.kernel),
                       name_of(conversion.integration.wrap),
                       conversion.green == Green::down ? " --green down" : "");
}

Summary summary_of(const Job& job, const HeightsConversion& conversion, const Stages& stages) {
    const IntegratedHeights& result = conversion.result;
    const IntegrationOptions& integration = conversion.integration;
    Summary summary;
    summary.add("read",
                fmt::format("{}: {} x {}, {}, {} bit, {}", job.input.string(), conversion.width,
                            conversion.height,
                            counted(static_cast<std::size_t>(conversion.channels), "channel"),
                            conversion.bits_read, conversion.input_text),
                {{"width", conversion.width}, {"height", conversion.height}});
    const std::string green = enum_name(conversion.green);
    summary.add("green", conversion.green_by_slopes ? green + ", from the slopes" : "",
                {{"green", green}, {"green_by_slopes", conversion.green_by_slopes}});
    summary.add("slopes",
                fmt::format("{:.4g} (RMS), mean {:.3g} and {:.3g}{}, {}, {} at the border",
                            result.rms_slope, result.mean_slope.x, result.mean_slope.y,
                            integration.level ? " (removed)" : "", enum_name(integration.kernel),
                            name_of(integration.wrap)),
                {{"kernel", enum_name(integration.kernel)},
                 {"wrap", name_of(integration.wrap)},
                 {"steepest", integration.max_slope},
                 {"level", integration.level},
                 {"rms_slope", result.rms_slope},
                 {"mean_slope", {result.mean_slope.x, result.mean_slope.y}}});
    summary.add("residual",
                fmt::format("slopes of {:.3g} (RMS) that no height field has: {:.3g} degrees, "
                            "{:.3g} at most{}",
                            result.residual_slope, result.residual.rms, result.residual.max,
                            result.rounds > 1 ? fmt::format(" ({} rounds)", result.rounds) : ""),
                {{"residual_slope", result.residual_slope},
                 {"residual_degrees",
                  {{"rms", result.residual.rms},
                   {"mean", result.residual.mean},
                   {"max", result.residual.max}}},
                 {"rounds", result.rounds}});
    summary.add("heights", fmt::format("0 to {:.6g} texels", result.highest),
                {{"highest", result.highest}});
    summary.add("format", storage_text(conversion),
                {{"bits", conversion.bits},
                 {"strength", conversion.strength},
                 {"step_degrees", rounding_degrees(conversion)}});
    summary.add("inverse", inverse_command(job, conversion));
    summary.add_findings(conversion.findings);
    summary.add_times(stages);
    summary.add("wrote", file_and_size(job.output));
    return summary;
}

std::string line_of(const Job& job, const HeightsConversion& conversion, const Stages& stages) {
    return fmt::format("{}: {} x {}, strength {:.6g}, residual {:.3g} degrees, {}",
                       job.output.string(), conversion.width, conversion.height,
                       conversion.strength, conversion.result.residual.rms,
                       duration(stages.milliseconds()));
}

ExitCode run(const CLI::App& app, const MapFiles& files, const HeightsRequest& request) {
    MapWork work;
    work.head = {{"tool", "relief-bake heights"}, {"version", version()}};
    work.check = [&](const Job& job) {
        bits_of(request, job.output);
        refuse_to_replace(job.input, "normal map", job);
    };
    work.work = [&](const Job& job, Stages& stages) -> FileOutcome {
        const HeightsConversion conversion = convert_heights(job, request, stages);
        return {line_of(job, conversion, stages), conversion.findings,
                summary_of(job, conversion, stages)};
    };
    return run_map_jobs(app, files, work);
}

}  // namespace

Command add_heights_command(CLI::App& tool) {
    struct Options {
        MapFiles files;
        HeightsRequest request;
    };
    CLI::App& app = add_subcommand(
        tool, "heights", "Converts tangent-space normal maps to height maps: the inverse of bump.");
    const auto options = std::make_shared<Options>();
    options->request.input.accepted = {MapKind::normal};
    add_map_files(app, options->files, "normal map",
                  "The heights are those whose slopes fit the map best (least squares). The "
                  "summary shows how much of the map no height field can represent.",
                  "height map");
    add_heights_options(app, options->request);
    add_map_folder(app, options->files);
    add_report_options(app, options->files.report);
    add_general_options(app, options->files.general);
    set_examples(app, {"relief-bake heights data/scenes/bricks-normal.png out/bricks-height.png",
                       "relief-bake heights data/scenes/bricks-normal.png out/bricks-height.exr "
                       "--wrap clamp --kernel sobel3"});
    return {&app, [&app, options] { return run(app, options->files, options->request); }};
}

}  // namespace relief::tools
