// SPDX-License-Identifier: Apache-2.0
// `relief-bake bump HEIGHT OUT`: reads a height map, converts it to tangent-space normals, stores
// them in the depth and convention asked for. A depth that the output format cannot hold exactly is
// refused before anything is read. Tests: tests/tools/relief_bake_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "commands.h"
#include "common/findings.h"
#include "common/map_choices.h"
#include "common/options.h"
#include "common/report_options.h"
#include "common/text.h"
#include "relief/mesh/height_statistics.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/threads.h"

namespace relief::tools {
namespace {

/// Absent: by what the map itself shows.
using WrapChoice = std::optional<Wrap>;

Choices<WrapChoice> wrap_or_auto() {
    Choices<WrapChoice> choices;
    for (const auto& [name, wrap] : wrap_choices())
        choices.emplace_back(name, wrap);
    choices.emplace_back("auto", std::nullopt);
    return choices;
}

struct BakeBumpOptions {
    std::filesystem::path input;
    std::filesystem::path output;
    BumpOptions bump;
    std::optional<double> strength;
    std::optional<double> height;
    std::optional<glm::dvec2> texel;
    std::optional<int> gaussian_radius;
    WrapChoice wrap_x = Wrap::repeat;
    WrapChoice wrap_y = Wrap::repeat;
    std::optional<int> bits;
    Green green = Green::up;
    std::optional<FlatCode> flat;
    ReportOptions report;
    GeneralOptions general;
};

/// The depths that a format can hold normals in, the first being the one to use unless asked.
std::vector<int> depths_of(const std::filesystem::path& output) {
    const std::string extension = extension_of(output);
    if (extension == ".png") return {16, 8};
    if (extension == ".tif" || extension == ".tiff") return {16, 8, 32};
    if (extension == ".exr") return {32};
    const std::string remedy = "use .png, .tif or .exr";
    if (extension == ".jpg" || extension == ".jpeg")
        throw UsageError(output.string() + ": JPEG distorts normals", remedy);
    if (extension == ".hdr")
        throw UsageError(output.string() + ": HDR keeps 8 bits of a normal and no sign", remedy);
    throw UsageError(fmt::format("{}: no format to write a normal map in", output.string()),
                     remedy);
}

NormalMapFormat format_of(const BakeBumpOptions& options) {
    const std::vector<int> depths = depths_of(options.output);
    const int bits = options.bits.value_or(depths.front());
    if (std::find(depths.begin(), depths.end(), bits) == depths.end()) {
        throw UsageError(fmt::format("--bits {}: {} holds {} bits", bits,
                                     extension_of(options.output), fmt::join(depths, " or ")));
    }
    if (bits == 32 && options.flat)
        throw UsageError("--flat: has no effect on 32-bit output, where flat is exact");
    return {.bits = bits,
            .green = options.green,
            .flat = options.flat.value_or(NormalMapFormat{}.flat)};
}

/// The options of the library; throws UsageError where some contradict each other.
BumpOptions bump_of(const BakeBumpOptions& options) {
    if (options.strength && options.height)
        throw UsageError("--strength, --height: both say how deep the map is");
    if (options.height && !options.texel)
        throw UsageError("--height: needs the size of a texel in the same unit",
                         "give --texel-size, or --strength instead");
    if (options.texel && !options.height)
        throw UsageError("--texel-size: says in which unit --height is", "give --height");
    if (options.gaussian_radius && options.bump.kernel != Kernel::gaussian)
        throw UsageError("--kernel-radius: is for --kernel gaussian");
    BumpOptions bump = options.bump;
    bump.strength = options.height ? *options.height : options.strength.value_or(bump.strength);
    bump.texel = options.texel.value_or(bump.texel);
    bump.gaussian_radius = options.gaussian_radius.value_or(bump.gaussian_radius);
    return bump;
}

/// "repeat", or "repeat,clamp" where the axes differ.
std::string wrap_words(const Wraps& wrap) {
    const std::string x = name_of(wrap.x, wrap_choices());
    return wrap.x == wrap.y ? x : x + "," + name_of(wrap.y, wrap_choices());
}

/// "gaussian of radius 2", or the plain name.
std::string kernel_words(const BumpOptions& bump) {
    const std::string name = name_of(bump.kernel, kernel_choices());
    return bump.kernel == Kernel::gaussian
               ? fmt::format("{} of radius {}", name, bump.gaussian_radius)
               : name;
}

/// How deep the map is taken to be.
std::string depth_words(const BakeBumpOptions& options, const BumpOptions& bump) {
    if (!options.height) return fmt::format("strength {:g} texels", bump.strength);
    return fmt::format("height {:g} over texels of {:g} x {:g}", bump.strength, bump.texel.x,
                       bump.texel.y);
}

/// What was made of which image, for the summary.
struct Baked {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits_read = 0;
    BumpOptions bump;              ///< With what was found out from the map.
    std::optional<Tiling> tiling;  ///< If it was looked at.
    NormalMapFormat format;
    Findings findings;
};

/// The options for a map, whose seams are looked at where that is asked for.
void settle_wraps(const BakeBumpOptions& options, const Image& height, Baked& baked) {
    if (!options.wrap_x || !options.wrap_y) baked.tiling = detect_tiling(height);
    const Wraps found = baked.tiling.value_or(Tiling{}).wraps();
    baked.bump.wrap = {options.wrap_x.value_or(found.x), options.wrap_y.value_or(found.y)};
}

Baked bake(const BakeBumpOptions& options, const BumpOptions& bump, Stages& stages) {
    Baked baked;
    baked.bump = bump;
    baked.format = format_of(options);
    const Image source =
        stages.run("read", [&] { return read_image(options.input, ImageUse::data); });
    baked.width = source.width;
    baked.height = source.height;
    baked.channels = source.channels;
    baked.bits_read = source.bits();

    Report report;
    const Image coded = about(options.input, [&] {
        return stages.run("convert", [&] {
            const auto converted = [&](const Image& height) {
                settle_wraps(options, height, baked);
                return normal_map_from_height(height, baked.bump, baked.format, report);
            };
            return source.channels == 1 ? converted(source) : converted(height_field(source));
        });
    });
    stages.run("write",
               [&] { write_image(options.output, coded, normal_map_metadata(baked.format)); });
    baked.findings.add("", report);
    return baked;
}

/// Millions of pixels a second through the conversion itself, reading and writing left out.
double megapixels_per_second(const Baked& baked, const Stages& stages) {
    const double milliseconds = stages.milliseconds("convert");
    const double pixels = static_cast<double>(baked.width) * baked.height;
    return milliseconds > 0 ? pixels / milliseconds / 1000 : 0;
}

/// "clamp", and what the map shows where it decided.
std::string border_words(const Baked& baked) {
    const std::string words = wrap_words(baked.bump.wrap) + " at the border";
    if (!baked.tiling) return words;
    return fmt::format("{} (across the seams it changes {:.2g} and {:.2g} times as much as inside)",
                       words, baked.tiling->seam_x, baked.tiling->seam_y);
}

void print_summary(const BakeBumpOptions& options, const Baked& baked, const Stages& stages) {
    const bool is_float = baked.format.bits == 32;
    print_entry(
        "read",
        fmt::format("{}: {} x {}, {}, {} bit", options.input.string(), baked.width, baked.height,
                    counted(static_cast<std::size_t>(baked.channels), "channel"), baked.bits_read));
    print_entry("slopes", fmt::format("{}, {}, {}", kernel_words(baked.bump),
                                      depth_words(options, baked.bump), border_words(baked)));
    print_entry("coded", fmt::format("{} bit{}, green {}", baked.format.bits,
                                     is_float ? " float"
                                              : ", flat is " + std::string(baked.format.flat ==
                                                                                   FlatCode::middle
                                                                               ? "the middle code"
                                                                               : "between codes"),
                                     name_of(baked.format.green, green_choices())));
    print_entry("findings",
                baked.findings.empty() ? std::vector<std::string>{"none"} : baked.findings.lines());
    print_entry("time",
                fmt::format("{} ({:.0f} MPixel/s without the files)", durations(stages.finished()),
                            megapixels_per_second(baked, stages)));
    print_entry("wrote", file_and_size(options.output));
}

nlohmann::ordered_json seams_json(const std::optional<Tiling>& tiling) {
    if (!tiling) return nullptr;
    return {tiling->seam_x, tiling->seam_y};
}

nlohmann::ordered_json bake_json(const BakeBumpOptions& options, const Baked& baked,
                                 const Stages& stages) {
    const BumpOptions& bump = baked.bump;
    const bool has_radius = bump.kernel == Kernel::gaussian;
    return {{"tool", "relief-bake bump"},
            {"version", version()},
            {"input", options.input.string()},
            {"output", options.output.string()},
            {"width", baked.width},
            {"height", baked.height},
            {"kernel", name_of(bump.kernel, kernel_choices())},
            {"kernel_radius", has_radius ? nlohmann::ordered_json(bump.gaussian_radius) : nullptr},
            {"strength", bump.strength},
            {"texel_size", {bump.texel.x, bump.texel.y}},
            {"wrap", wrap_words(bump.wrap)},
            {"seams", seams_json(baked.tiling)},
            {"bits", baked.format.bits},
            {"green", name_of(baked.format.green, green_choices())},
            {"flat", name_of(baked.format.flat, flat_choices())},
            {"findings", baked.findings.json()},
            {"milliseconds", durations_json(stages.finished())},
            {"megapixels_per_second", megapixels_per_second(baked, stages)}};
}

ExitCode run(const CLI::App& app, const BakeBumpOptions& options) {
    format_of(options);
    const BumpOptions bump = bump_of(options);
    check(options.report, {options.input, options.output});
    require_folder_of(options.output);
    set_thread_limit(options.general.threads);
    Stages stages(options.general.quiet);
    const Baked baked = bake(options, bump, stages);
    if (!options.general.quiet) print_summary(options, baked, stages);
    return finish(app, options.report, options.input, baked.findings,
                  bake_json(options, baked, stages));
}

/// "W" or "WxH".
glm::dvec2 parse_texel(const std::string& subject, const std::string& text) {
    const Range sizes{1e-30, 1e30, ""};
    const std::size_t cross = text.find('x');
    const double width = parse_number(subject, text.substr(0, cross), sizes);
    if (cross == std::string::npos) return {width, width};
    return {width, parse_number(subject, text.substr(cross + 1), sizes)};
}

/// "W" for both axes, or "W,W" for x and y.
void parse_wraps(const std::string& subject, const std::string& text, BakeBumpOptions& options) {
    const std::size_t comma = text.find(',');
    options.wrap_x = parse_choice(subject, text.substr(0, comma), wrap_or_auto());
    options.wrap_y = comma == std::string::npos
                         ? options.wrap_x
                         : parse_choice(subject, text.substr(comma + 1), wrap_or_auto());
}

void add_depth_options(CLI::App& app, BakeBumpOptions& options) {
    const std::string group = "Slopes";
    add_number(app, "--strength", "S", options.strength, {},
               "Height in texels that the value 1.0 (white) stands for; negative turns bumps into "
               "dents. Default: 16.")
        ->group(group);
    add_number(app, "--height", "H", options.height, {},
               "Instead of --strength: the height of white in a unit of length; with "
               "--texel-size.")
        ->group(group);
    add_value(app, "--texel-size", "W[xH]",
              "Width (and height, where texels are not square) of a texel in the unit of --height.",
              [&](const std::string& subject, const std::string& text) {
                  options.texel = parse_texel(subject, text);
              })
        ->group(group);
}

void add_slope_options(CLI::App& app, BakeBumpOptions& options) {
    const std::string group = "Slopes";
    add_choice(app, "--kernel", options.bump.kernel, kernel_choices(),
               "How the slope is taken from neighbouring heights; all give the same depth. "
               "central5 and central7 are the truest on smooth maps of 16 bits or float; sobel5, "
               "scharr5 and gaussian smooth steps and noise; forward is half a texel off. "
               "Default: sobel3.")
        ->group(group);
    add_value(app, "--kernel-radius", "R",
              "Texels that --kernel gaussian reaches, 1 to 64. Default: 2.",
              [&](const std::string& subject, const std::string& text) {
                  options.gaussian_radius = parse_integer(subject, text, 1, largest_kernel_radius);
              })
        ->group(group);
    add_value(
        app, "--wrap", "WORD[,WORD]",
        "What lies beyond the border: the opposite edge, for maps that tile (repeat), "
        "nothing, so that slopes there are one-sided (clamp), the map mirrored (mirror); or by "
        "whether it goes on smoothly across the seam, repeat or clamp (auto). Two words: left "
        "and right, then top and bottom. Default: repeat.",
        [&](const std::string& subject, const std::string& text) {
            parse_wraps(subject, text, options);
        })
        ->group(group);
}

void add_coding_options(CLI::App& app, BakeBumpOptions& options) {
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

}  // namespace

Command add_bump_command(CLI::App& tool) {
    CLI::App& app =
        add_subcommand(tool, "bump", "Converts a height map to a tangent-space normal map.");
    const auto options = std::make_shared<BakeBumpOptions>();
    add_file(
        app, "HEIGHT", options->input,
        "Height map: grey, or colour of which the mean counts; PNG, TIFF, EXR, HDR, JPEG, ...");
    add_file(app, "OUT", options->output, "Normal map to write: .png .tif .exr");
    add_depth_options(app, *options);
    add_slope_options(app, *options);
    add_coding_options(app, *options);
    add_report_options(app, options->report);
    add_general_options(app, options->general);
    set_examples(
        app,
        {"relief-bake bump data/bricks-height.png out/bricks-normal.png --strength 12",
         "relief-bake bump data/bricks-height.png out/bricks-dx.png --green down --bits 8",
         "relief-bake bump data/bricks-height.png out/bricks.exr --kernel central5 --wrap clamp",
         "relief-bake bump data/bricks-height.png out/wall.png --height 0.02 --texel-size "
         "0.001"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
