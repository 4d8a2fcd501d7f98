// SPDX-License-Identifier: Apache-2.0
// The command `relief-bake bump` and its options. Contradictory and useless options are refused
// before any file is read. Tests: tests/tools/relief_bake_bump_test.cpp.
#include <memory>

#include "bump.h"
#include "common/choices.h"

namespace relief::tools {
namespace {

/// Parses "W" or "WxH".
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
               "The height of a color texel; luminance is computed from decoded sRGB. Grayscale "
               "images accept mean, luminance and red, which are the same. Default: mean.")
        .group(group);
    add_switch(app, "--ignore-alpha", request.ignore_alpha,
               "Use the heights of transparent texels. Default: texels with alpha 0 become flat, "
               "and their colors do not affect the texels around them.")
        .group(group);
    add_switch(app, "--invert", request.invert,
               "Black is high and white is low; the same as the negative --strength.")
        .group(group);
}

void add_depth_options(CLI::App& app, BumpRequest& request) {
    const std::string group = "Slopes";
    const Range depths{-1e30, 1e30, ""};  // The range of normals_from_height().
    add_number(app, "--strength", "S", request.strength, depths,
               "Height of the value 1.0 (white), in texels; a negative value turns bumps into "
               "dents. Default: 16.")
        .group(group);
    add_number(app, "--height", "H", request.height, depths,
               "Height of the value 1.0 (white), in a unit of length. It replaces --strength and "
               "needs --texel-size.")
        .group(group);
    add_value(app, "--texel-size", "W[xH]",
              "Width of a texel in the unit of --height, and its height if texels are not square.",
              [&](const std::string& subject, const std::string& text) {
                  request.texel = parse_texel(subject, text);
              })
        .group(group);
}

void add_accuracy_options(CLI::App& app, BumpAccuracyRequest& request) {
    const std::string group = "Accuracy";
    add_choice(app, "--kernel", request.kernel, kernel_or_auto_choices(),
               "Derivative kernel; all kernels have the same gain. auto estimates bit depth, noise "
               "and detail of the map and chooses the most accurate kernel. central5 and central7 "
               "suit smooth maps of 16 bits or float; sobel5, scharr5 and gaussian also smooth "
               "quantization steps and noise; forward is shifted by half a texel. Default: auto.")
        .group(group);
    const Choices<Grain> grains = {
        {"auto", Grain::automatic}, {"noise", Grain::noise}, {"detail", Grain::detail}};
    add_choice(app, "--grain", request.grain, grains,
               "How --kernel auto interprets fine, uniform grain: as noise, which it smooths, or "
               "as detail, which it keeps. auto assumes noise, unless the map contains nothing "
               "else. Default: auto.")
        .group(group);
    add_switch(app, "--destaircase", request.destaircase,
               "First smooth the quantization steps of maps with few bits; no height moves by more "
               "than half a step.")
        .group(group);
    const Choices<std::optional<Arithmetic>> precisions = {
        {"float32", Arithmetic::float32}, {"float64", Arithmetic::float64}, {"auto", std::nullopt}};
    add_choice(app, "--precision", request.precision, precisions,
               "Floating-point type of slopes and normals. Default: auto, which is float64 for "
               "32-bit output and float32 otherwise.")
        .group(group);
    add_number(app, "--max-error", "DEG", request.max_error, {0.0, 180.0, "degrees"},
               "Choose the fastest kernel, precision and bit depth whose expected error is at most "
               "DEG degrees; fail if there is none. The expected error is the root sum of squares "
               "of the error of the map (noise, rounding) and the error that the conversion adds. "
               "If it is a range, the lower end counts, and an upper end above DEG is a finding.")
        .group(group);
    add_number(app, "--max-added-error", "DEG", request.max_added_error, {0.0, 180.0, "degrees"},
               "The same limit for only the error that the conversion adds: its distance from the "
               "most accurate known result.")
        .group(group);
    const Choices<ErrorKind> kinds = {{"rms", ErrorKind::rms}, {"max", ErrorKind::max}};
    add_choice(app, "--max-error-kind", request.max_error_kind, kinds,
               "Error that --max-error and --max-added-error limit: the root mean square or the "
               "maximum. Default: rms.")
        .group(group);
    add_switch(app, "--compare", request.compare,
               "Also measure all methods, and print their errors and times.")
        .group(group);
}

void add_slope_options(CLI::App& app, BumpRequest& request) {
    add_value(app, "--kernel-radius", "R",
              "Radius of --kernel gaussian in texels, 1 to 64. Default: 2.",
              [&](const std::string& subject, const std::string& text) {
                  request.gaussian_radius = parse_integer(subject, text, 1, max_kernel_radius);
              })
        .group("Accuracy");
    add_wrap(app, request.wrap,
             "Border mode: repeat uses the opposite edge, for maps that tile; clamp uses one-sided "
             "differences; mirror uses the mirrored map; auto chooses repeat if the map continues "
             "smoothly across the seam, else clamp. Two words set left and right, then top and "
             "bottom. Default: auto.")
        .group("Slopes");
}

void add_content_options(CLI::App& app, BumpRequest& request) {
    const std::string group = "Output";
    add_switch(app, "--xy", request.xy_only,
               "Store 0 in blue, for shaders that compute z from x and y.")
        .group(group);
    add_choice(app, "--alpha", request.alpha, map_alpha_choices(),
               "Content of the alpha channel: none, the height (for parallax mapping), or the "
               "alpha of the height map (keep). Default: none.")
        .group(group);
    add_switch(app, "--slope-moments", request.slope_moments,
               "Instead of normals, write six float channels (.exr or .tif) that can be filtered "
               "(LEAN mapping): height, dh/dx, dh/dy, their squares and their product, with the "
               "channel names of maketx --bumpslopes.")
        .group(group);
}

void check(const BumpAccuracyRequest& request, bool slope_moments, bool half) {
    if (request.max_error_kind && !request.has_limit())
        throw UsageError("--max-error-kind: has no effect without --max-error",
                         "give --max-error DEG");
    if (!request.needs_experiment()) return;
    const std::string option = request.max_error         ? "--max-error"
                               : request.max_added_error ? "--max-added-error"
                                                         : "--compare";
    if (request.compare && request.has_limit())
        throw UsageError("--compare, " + option + ": contradict each other");
    if (slope_moments)
        throw UsageError(option + ", --slope-moments: errors are measured only for normals");
    if (half) throw UsageError(option + ", --half: errors of half floats are not measured");
}

ExitCode run(const CLI::App& app, const MapFiles& files, const BumpRequest& request) {
    MapWork work;
    work.head = {{"tool", "relief-bake bump"}, {"version", version()}};
    work.check = [&](const Job& job) {
        bump_options_of(request);
        file_format_of(request, job.output);
        refuse_to_replace(job.input, "height map", job);
    };
    work.work = [&](const Job& job, Stages& stages, bool prints_summary) -> FileOutcome {
        const BumpConversion conversion = convert_bump(job, request, stages);
        if (prints_summary) print_summary(job, request, conversion, stages);
        return {line_of(job, conversion, stages), conversion.findings,
                results_json(conversion, stages)};
    };
    return run_map_jobs(app, files, work);
}

}  // namespace

BumpOptions bump_options_of(const BumpRequest& request) {
    if (request.strength && request.height)
        throw UsageError("--strength, --height: both set the depth of the map");
    if (request.height && !request.texel)
        throw UsageError("--height: needs the size of a texel in the same unit",
                         "give --texel-size, or --strength instead");
    if (request.texel && !request.height)
        throw UsageError("--texel-size: has no effect without --height", "give --height");
    if (request.gaussian_radius && request.accuracy.kernel != Kernel::gaussian)
        throw UsageError("--kernel-radius: has no effect without --kernel gaussian");
    check(request.accuracy, request.slope_moments, request.output.half);
    BumpOptions bump;
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

Command add_bump_command(CLI::App& tool) {
    struct Options {
        MapFiles files;
        BumpRequest request;
    };
    CLI::App& app =
        add_subcommand(tool, "bump", "Converts height maps to tangent-space normal maps.");
    const auto options = std::make_shared<Options>();
    add_map_files(app, options->files, "height map",
                  "Height maps are grayscale or color images (PNG, TIFF, EXR, HDR, JPEG, ...).");
    add_height_options(app, options->request);
    add_depth_options(app, options->request);
    add_accuracy_options(app, options->request.accuracy);
    add_slope_options(app, options->request);
    add_map_folder(app, options->files);
    add_content_options(app, options->request);
    add_map_output_options(app, options->request.output);
    add_report_options(app, options->files.report);
    add_general_options(app, options->files.general);
    set_examples(
        app,
        {"relief-bake bump data/bricks-height.png out/bricks-normal.png --strength 12",
         "relief-bake bump data/bricks-height.png out/bricks-dx.png --green down --bits 8",
         "relief-bake bump data/bricks-height.png out/bricks.exr --kernel central5 --wrap clamp",
         "relief-bake bump data/bricks-height.png out/bricks.png --compare",
         "relief-bake bump data/bricks-height.png out/bricks.tif --max-error 2",
         "relief-bake bump data/bricks-height.png out/wall.png --height 0.02 --texel-size "
         "0.001",
         "relief-bake bump data/bricks-height.png out/bricks-parallax.png --alpha height",
         "relief-bake bump data/*-height.png -o out/maps/ --strength 8"});
    return {&app, [&app, options] { return run(app, options->files, options->request); }};
}

}  // namespace relief::tools
