// SPDX-License-Identifier: Apache-2.0
// The command `relief-bake bump`: converts height map files. Contradictory and useless options are
// refused before any file is read. Tests: tests/tools/relief_bake_bump_test.cpp.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "bump_conversion.h"
#include "commands.h"
#include "common/material_maps.h"
#include "common/options.h"
#include "file_replacement.h"
#include "relief/mesh/report.h"

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
    add_choice(app, "--channel", request.channel, enum_choices<HeightChannel>(),
               "The height of a color texel; luminance is computed from decoded sRGB. Grayscale "
               "images accept mean, luminance and red, which are the same. Default: mean.")
        .group(group);
    add_assume_option(app, request.assumed, {MapKind::height}).group(group);
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
               "First smooth the quantization steps of maps with few bits; no height "
               "changes by more than half a step.")
        .group(group);
    const Choices<std::optional<Arithmetic>> precisions = {
        {"float32", Arithmetic::float32}, {"float64", Arithmetic::float64}, {"auto", std::nullopt}};
    add_choice(app, "--precision", request.precision, precisions,
               "Floating-point type of slopes and normals. Default: auto, which is float64 for "
               "32-bit output and float32 otherwise.")
        .group(group);
    add_error_bound(
        app, request.bound, group,
        "Choose the fastest kernel, precision and bit depth whose expected error is at most DEG "
        "degrees; fail if there is none. The expected error is the root sum of squares of the "
        "error of the map (noise, rounding) and the error that the conversion adds. If it is a "
        "range, the lower end counts, and an upper end above DEG is a finding.");
    add_number(app, "--max-added-error", "DEG", request.max_added_error, {0.0, 180.0, "degrees"},
               "The same limit for only the error that the conversion adds: its distance from the "
               "most accurate known result. --max-error-kind applies to it, too.")
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
    add_choice(app, "--alpha", request.alpha, enum_choices<MapAlpha>(),
               "Content of the alpha channel: none, the height (for parallax mapping), or the "
               "alpha of the height map (keep). Default: none.")
        .group(group);
    add_path(app, "--cone-map", request.cone_map,
             "Also write a cone map for relief mapping with relaxed cones to FILE (.png, .tif or "
             ".exr): the height, and in the second channel the root of the ratio of the cone's "
             "radius to its height, both as fractions of the larger side of the map and of the "
             "depth. It holds for every depth, and for the border mode of this conversion.")
        .group(group);
    add_switch(app, "--slope-moments", request.slope_moments,
               "Instead of normals, write six float channels (.exr or .tif) that can be filtered "
               "(LEAN mapping): height, dh/dx, dh/dy, their squares and their product, with the "
               "channel names of maketx --bumpslopes.")
        .group(group);
}

/// The map of --write-into must be what glTF prescribes.
void check_write_into(const BumpRequest& request, const WriteIntoOptions& write_into,
                      const Job& job) {
    const auto refuse = [](const char* option, const char* problem, const char* remedy) {
        throw UsageError(fmt::format("{}, --write-into: {}", option, problem), remedy);
    };
    if (request.output.green == Green::down)
        refuse("--green", "glTF has green up", "use --green up");
    if (request.output.flat == FlatCode::middle)
        refuse("--zero-code", "glTF decodes zero at 127.5", "use --zero-code 127.5");
    if (request.xy_only) refuse("--xy", "glTF needs z in blue", "leave it out");
    check_image("--write-into", job.output);
    if (!std::filesystem::exists(*write_into.model))
        throw failure(*write_into.model, "does not exist", "name a model that has the surface");
    check_distinct("--write-into", *write_into.model, {job.input, job.output});
}

/// Stores the finished map in the model of --write-into.
MaterialResult write_into_model(const WriteIntoOptions& write_into, const Job& job,
                                Stages& stages) {
    MaterialRequest request;
    request.input = request.output = *write_into.model;
    request.materials.push_back({write_into.material, {{TextureSlot::normal, job.output}}});
    request.embeds = write_into.embed;
    request.normal_scale = write_into.scale;
    request.assumed = {MapKind::normal};  // The options were checked before the conversion.
    return store_maps(request, stages);
}

ExitCode run(const CLI::App& app, const MapFiles& files, const BumpRequest& given,
             const WriteIntoOptions& write_into) {
    BumpRequest request = given;
    apply_engine(request.output);
    check(app, write_into);
    if (!write_into.model) refuse_given(app, {"--scale"}, "--write-into");
    MapWork work;
    std::size_t jobs = 0;
    work.head = {{"tool", "relief-bake bump"}, {"version", version()}};
    work.check = [&](const Job& job) {
        bump_options_of(request);
        file_format_of(request, job.output);
        refuse_to_replace(job.input, "height map", job);
        check_cone_map(request, job);
        ++jobs;
        if (jobs > 1 && request.cone_map) throw UsageError("--cone-map: needs a single map");
        if (!write_into.model) return;
        if (jobs > 1) throw UsageError("--write-into: needs a single map");
        check_write_into(request, write_into, job);
    };
    work.work = [&](const Job& job, Stages& stages) -> FileOutcome {
        relief::detail::FileSet outputs;
        BumpConversion conversion = convert_bump(job, request, stages);
        std::optional<MaterialResult> stored;
        if (write_into.model) {
            stored = write_into_model(write_into, job, stages);
            for (const PlacedFinding& placed : stored->findings.all()) {
                Report report;
                report.add(placed.finding);
                conversion.findings.add(placed.where, report, placed.map_width);
            }
        }
        outputs.commit();
        Summary summary = summary_of(job, request, conversion, stages);
        if (stored) {
            summary.add_part("stored", summary_of(*stored));
            summary.add("", file_and_size(*write_into.model));
        }
        return {line_of(job, conversion, stages), conversion.findings, std::move(summary)};
    };
    return run_map_jobs(app, files, work);
}

}  // namespace

Command add_bump_command(CLI::App& tool) {
    struct Options {
        MapFiles files;
        BumpRequest request;
        WriteIntoOptions write_into;
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
    add_write_into_options(app, options->write_into,
                           "Store the finished map as the normal map of a material of this model "
                           "(.glb .gltf), which is replaced.");
    add_number(app, "--scale", "S", options->write_into.scale, {-100.0, 100.0, ""},
               "Factor of the x and y of the normal map in the material. Default: that of the "
               "material, or 1.")
        .group("glTF");
    add_report_options(app, options->files.report);
    add_general_options(app, options->files.general);
    set_common_options(app, {"--channel", "--strength", "--height", "--texel-size", "--wrap",
                             "--kernel", "--max-error", "--compare", "--output", "--green",
                             "--bits", "--dither", "--write-into", "--report", "--strict"});
    set_examples(
        app,
        {"relief-bake bump data/bricks-height.png out/bricks-normal.png --strength 12",
         "relief-bake bump data/bricks-height.png out/bricks-dx.png --green down --bits 8",
         "relief-bake bump data/bricks-height.png out/bricks.exr --kernel central5 --wrap clamp",
         "relief-bake bump data/bricks-height.png out/bricks.png --compare",
         "relief-bake bump data/bricks-height.png out/bricks.tif --max-error 5",
         "relief-bake bump data/bricks-height.png out/wall.png --height 0.02 --texel-size "
         "0.001",
         "relief-bake bump data/bricks-height.png out/bricks-parallax.png --alpha height",
         "relief-bake bump data/bricks-height.png out/bricks-normal.png --cone-map "
         "out/bricks-cones.png",
         "relief-bake bump data/*-height.png -o out/maps/ --strength 8"});
    return {&app, [&app, options] {
                return run(app, options->files, options->request, options->write_into);
            }};
}

}  // namespace relief::tools
