// SPDX-License-Identifier: Apache-2.0
// The command `relief-bake convert`: its summary as text, as a line and as JSON, and its options in
// the order in which they take effect.
// Tests: tests/tools/relief_bake_convert_test.cpp.
#include <fmt/format.h>

#include <map>
#include <memory>

#include "common/options.h"
#include "common/summary.h"
#include "convert.h"
#include "file_replacement.h"
#include "map_textures.h"

namespace relief::tools {

// The summary.

namespace {

std::string format_text(const MapConversion& conversion) {
    if (conversion.texture) {
        const TextureFormat format = conversion.texture->format;
        const std::string green = conversion.green ? enum_name(*conversion.green) : "unknown";
        const std::string quality =
            block_format_of(format)
                ? fmt::format(", quality {}", enum_name(conversion.texture->quality))
                : "";
        return fmt::format("{}{}, green {}", enum_name(format), quality, green);
    }
    NormalMapFormat format = conversion.format;
    format.green = conversion.green.value_or(Green::up);
    const std::string text = to_string(format);
    if (conversion.green) return text;
    const std::string known = "green up";
    const std::size_t place = text.find(known);
    const bool is_object_space = conversion.kind == MapKind::object_normal;
    return text.substr(0, place) + (is_object_space ? "object space" : "green unknown") +
           text.substr(place + known.size());
}

std::vector<std::string> level_lines(const MapConversion& conversion) {
    std::vector<std::string> lines;
    for (const WrittenLevel& level : conversion.levels) {
        if (level.error) {
            std::string line = (lines.empty() ? file_and_size(level.file) + ", " : "") +
                               level_text(lines.size(), {level.width, level.height, *level.error,
                                                         level.confidence});
            if (level.mean_roughness)
                line += fmt::format(", roughness {:.4f}", *level.mean_roughness);
            lines.push_back(line);
            continue;
        }
        std::string line = file_and_size(level.file);
        if (conversion.levels.size() > 1) {
            line += fmt::format(", {} x {}, mean length {:.4f}", level.width, level.height,
                                level.mean_length);
        }
        if (level.mean_roughness) line += fmt::format(", roughness {:.4f}", *level.mean_roughness);
        lines.push_back(line);
    }
    return lines;
}

Json json_of(const WrittenLevel& level) {
    Json json = {{"file", level.file.string()},
                 {"width", level.width},
                 {"height", level.height},
                 {"mean_length", level.mean_length},
                 {"min_length", level.min_length}};
    if (level.roughness_file) {
        json["roughness_file"] = level.roughness_file->string();
        json["mean_roughness"] = *level.mean_roughness;
    }
    if (level.error) {
        json["error"] = {
            {"mean", level.error->mean}, {"p99", level.error->p99}, {"max", level.error->max}};
    }
    if (level.confidence) add_confidence(json["error"], *level.confidence);
    return json;
}

Summary summary_of(const Job& job, const MapConversion& conversion, const Stages& stages) {
    const WrittenLevel& largest = conversion.levels.front();
    const NormalMapFormat& format = conversion.format;
    Json lengths;
    if (conversion.lengths) {
        lengths = {{"min", conversion.lengths->min},
                   {"mean", conversion.lengths->mean},
                   {"max", conversion.lengths->max}};
    }
    Summary summary;
    summary.add_json({{"width", largest.width}, {"height", largest.height}});
    summary.add("read",
                fmt::format("{}: {} x {}, {}, {} bit, {}", job.input.string(), conversion.width,
                            conversion.height,
                            counted(static_cast<std::size_t>(conversion.channels), "channel"),
                            conversion.bits_read, conversion.input_text),
                {{"input_size", {conversion.width, conversion.height}},
                 {"input_lengths", std::move(lengths)}});
    summary.add("steps", conversion.steps, {{"done", conversion.steps}});
    const Json green = conversion.green ? Json(enum_name(*conversion.green)) : Json();
    if (conversion.texture) {
        summary.add("format", format_text(conversion),
                    {{"texture_format", enum_name(conversion.texture->format)},
                     {"quality", enum_name(conversion.texture->quality)},
                     {"green", green}});
    } else {
        summary.add("format", format_text(conversion),
                    {{"bits", format.bits},
                     {"green", green},
                     {"zero_code", enum_name(format.flat)},
                     {"dither", enum_name(format.dither)}});
    }
    summary.add_findings(conversion.findings);
    summary.add_times(stages);
    summary.add("wrote", level_lines(conversion),
                {{"levels", json_list(conversion.levels, json_of)}});
    return summary;
}

std::string line_of(const Job& job, const MapConversion& conversion, const Stages& stages) {
    const WrittenLevel& largest = conversion.levels.front();
    return fmt::format("{}: {} x {}, {}, {}", job.output.string(), largest.width, largest.height,
                       conversion.findings.count_text(), duration(stages.milliseconds()));
}

// The options.

/// Parses "x,-y,z".
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

/// Parses "512x256" or "50%".
SizeChoice parse_resize(const std::string& subject, const std::string& text) {
    constexpr int max_side = 65536;
    if (text.ends_with('%')) {
        const std::string number = text.substr(0, text.size() - 1);
        return {{}, parse_number(subject, number, {0.01, 10000.0, "percent"}) / 100.0};
    }
    const std::vector<std::string> sides = split(text, 'x');
    if (sides.size() != 2) throw UsageError(subject + ": not a size like 512x512 or 50%");
    return {{parse_integer(subject, sides[0], 1, max_side),
             parse_integer(subject, sides[1], 1, max_side)},
            0.0};
}

/// Parses "N" for both axes, or "NxM".
glm::dvec2 parse_repeat(const std::string& subject, const std::string& text) {
    const Range range{1e-3, 1e4, ""};
    const std::vector<std::string> parts = split(text, 'x');
    const double x = parse_number(subject, parts[0], range);
    if (parts.size() == 1) return {x, x};
    if (parts.size() > 2) throw UsageError(subject + ": not a number like 4, or two like 4x2");
    return {x, parse_number(subject, parts[1], range)};
}

void add_input_options(CLI::App& app, ConvertRequest& request) {
    const std::string group = "Input";
    add_green_choice(
        app, "--input-green", request.input,
        "Direction of the green channel of the input: up (OpenGL), down (DirectX), or "
        "detected from the slopes like relief-bake check does (auto). Default: from the "
        "file's metadata, else unknown; only --green and --to-object need it.")
        .group(group);
    add_choice(app, "--input-zero-code", request.input.flat, enum_choices<FlatCode>(),
               "The code that represents zero in the input; see --zero-code. Flat texels are read "
               "as exactly flat with both. Default: from the file's metadata, else 127.5.")
        .group(group);
    add_switch(app, "--input-signed", request.input.is_signed,
               "Float samples of the input store the components n from -1 to 1. The output stores "
               "(n + 1) / 2.")
        .group(group);
    add_assume_option(app, request.input.assumed, {MapKind::normal}).group(group);
    add_choice(app, "--rebuild-z", request.rebuild_z,
               Choices<XyChannels>{{"rg", XyChannels{0, 1}}, {"ag", XyChannels{3, 1}}},
               "Compute z from x and y, which are stored in red and green (rg) or in alpha and "
               "green (ag). If the length of (x, y) is above 1, z is 0.")
        .group(group);
    add_switch(app, "--normalize", request.normalize,
               "Normalize all normals, and count those that were not of unit length. All later "
               "operations also normalize.")
        .group(group);
    add_choice(
        app, "--alpha", request.alpha,
        Choices<AlphaChoice>{{"keep", AlphaChoice::keep}, {"drop", AlphaChoice::drop}},
        "Alpha channel of the input: keep it, resized like the normals, or drop it. Default: keep.")
        .group(group);
}

void add_axis_options(CLI::App& app, ConvertRequest& request) {
    const std::string group = "Axes (exact operations on the stored codes)";
    add_choice(app, "--flip", request.flip,
               Choices<Flip>{{"green", Flip::green}, {"red", Flip::red}, {"both", Flip::both}},
               "Invert the green channel (converts between OpenGL and DirectX), the red channel, "
               "or both.")
        .group(group);
    add_value(app, "--axes", "X,Y,Z",
              "Input components that become x, y and z: x, y and z in any order, each optionally "
              "with a minus sign. x,-y,z inverts green; y,x,z swaps red and green. Write "
              "--axes=-x,y,z if the value begins with a minus sign.",
              [&](const std::string& subject, const std::string& text) {
                  request.axes = parse_axes(subject, text);
              })
        .group(group);
}

void add_resize_options(CLI::App& app, ResizeChoice& resize) {
    const std::string group = "Size";
    add_value(app, "--resize", "WxH|N%", "New size, in texels or in percent of the current size.",
              [&](const std::string& subject, const std::string& text) {
                  resize.size = parse_resize(subject, text);
              })
        .group(group);
    add_choice(app, "--resize-filter", resize.options.filter, filter_choices(),
               "Filter kernel. best is lanczos for reduction and cubic for enlargement. Default: "
               "best.")
        .group(group);
    add_choice(app, "--resize-of", resize.options.domain, domain_choices(),
               "Filtered quantity: slopes give the normals of the filtered surface; vectors are "
               "the normals themselves, which gives steep texels less weight. Default: slopes.")
        .group(group);
    add_wrap(app, resize.options.wrap,
             "Border mode: the opposite edge (repeat), the last texel (clamp) or the mirrored map "
             "(mirror). Two words set left and right, then top and bottom. Default: repeat.")
        .group(group);
}

void add_detail_options(CLI::App& app, DetailOptions& detail) {
    const std::string group = "Detail";
    add_path(app, "--detail", detail.file, "Blend a detail normal map over this map.").group(group);
    add_choice(app, "--blend", detail.blend, blend_choices(),
               "Blend method: reoriented rotates the detail onto the base; partial-derivative adds "
               "their heights. docs/normal-maps.md has formulas, errors and times of all methods. "
               "Default: reoriented.")
        .group(group);
    add_number(app, "--detail-strength", "S", detail.strength, {-1e6, 1e6, ""},
               "Factor for the slopes of the detail. Default: 1.")
        .group(group);
    add_value(app, "--detail-repeat", "N[xM]",
              "How many times the detail repeats horizontally, and vertically. The detail is "
              "resized accordingly with --resize-filter, in slopes. Default: 1.",
              [&](const std::string& subject, const std::string& text) {
                  detail.repeat = parse_repeat(subject, text);
              })
        .group(group);
    add_green_choice(
        app, "--detail-green", detail.input,
        "Direction of the green channel of the detail. Default: from its metadata, else that "
        "of the base.")
        .group(group);
    add_choice(app, "--detail-zero-code", detail.input.flat, enum_choices<FlatCode>(),
               "The code that represents zero in the detail. Default: as for --input-zero-code.")
        .group(group);
}

void add_space_options(CLI::App& app, SpaceOptions& space) {
    const std::string group = "Space";
    add_path(app, "--to-object", space.to_object,
             "Convert from tangent space to the object space of the mesh in FILE, as the last "
             "operation.")
        .group(group);
    add_path(app, "--to-tangent", space.to_tangent,
             "Convert from the object space of the mesh in FILE to its tangent space, as the first "
             "operation.")
        .group(group);
    Choices<TangentMethod> methods;
    for (const auto& [name, mode] : tangent_choices()) {
        if (computes_tangents(mode)) methods.emplace_back(name, mode);
    }
    add_choice(app, "--tangents", space.tangents, methods,
               "Method that computes the tangents of the mesh. Default: the tangents of the file, "
               "else mikktspace.")
        .group(group);
    add_outside_option(app, space.repeats,
                       "Texture coordinates outside the unit square: leave their triangles out "
                       "(drop), or wrap them into the square (repeat). Default: drop.")
        .group(group);
    add_value(app, "--udim", "N",
              "UDIM tile of the map, from 1001; tile 1011 is above tile 1001. Default: 1001.",
              [&](const std::string& subject, const std::string& text) {
                  space.udim = parse_integer(subject, text, first_udim, 9999);
              })
        .group(group);
}

void add_mip_options(CLI::App& app, MipOptions& mips) {
    const std::string group = "Mip levels";
    add_switch(app, "--mips", mips.wanted,
               "Also write all smaller mip levels: OUT-mip01 at half the size, and so on, with "
               "OUT's extension; .ktx2 and .dds store all levels in OUT. Each stores normalized "
               "averages of the normals.")
        .group(group);
    add_switch(app, "--mip-lengths", mips.lengths,
               "Store the lengths of the averaged normals in the alpha of OUT and of each level: 1 "
               "if all normals agree.")
        .group(group);
    add_number(app, "--roughness-from-variance", "R", mips.roughness, {0.0, 1.0, ""},
               "For a surface of glTF roughness R, also write the roughness that compensates for "
               "the averaged normals, for OUT and each level: OUT-roughness, OUT-roughness-mip01, "
               "and so on; for textures OUT-roughness in bc4.")
        .group(group);
}

void check(const SpaceOptions& space) {
    if (space.to_object && space.to_tangent)
        throw UsageError("--to-object, --to-tangent: contradict each other");
    if (space.udim && space.repeats)
        throw UsageError("--udim, --outside: both set what lies outside the unit square");
}

/// \throws UsageError if options contradict each other, or have no effect
void check(const CLI::App& app, const ConvertRequest& request) {
    const bool has_detail = request.detail.file.has_value();
    const bool changes_space = request.space.to_object || request.space.to_tangent;
    if (request.flip && request.axes) throw UsageError("--flip, --axes: both set the axes");
    if (request.flip && *request.flip != Flip::red && request.output.green)
        throw UsageError("--flip, --green: both set the direction of green");
    if (request.normalize && request.rebuild_z)
        throw UsageError("--normalize: has no effect with --rebuild-z, which normalizes");
    check(request.space);
    if (!changes_space)
        refuse_given(app, {"--tangents", "--outside", "--udim"}, "--to-object or --to-tangent");
    if (request.space.to_object && request.output.green)
        throw UsageError("--green, --to-object: object space has no green direction");
    if (request.space.to_tangent && (request.input.green || request.flip))
        throw UsageError(fmt::format("{}, --to-tangent: object space has no green direction",
                                     request.flip ? "--flip" : "--input-green"));
    if (!has_detail) {
        refuse_given(app,
                     {"--blend", "--detail-strength", "--detail-repeat", "--detail-green",
                      "--detail-zero-code"},
                     "--detail");
    }
    if (!request.resize.size) {
        refuse_given(app, {"--resize-of", "--wrap"}, "--resize");
        if (!has_detail) refuse_given(app, {"--resize-filter"}, "--resize or --detail");
    }
    if (!request.mips.wanted)
        refuse_given(app, {"--mip-lengths", "--roughness-from-variance"}, "--mips");
}

/// The input of each output file.
using InputByOutput = std::map<std::filesystem::path, std::filesystem::path>;

/// The map itself may replace its input. No output may replace the detail map, no mip level may
/// replace the input, and no two inputs may have the same output.
void check_files(const Job& job, const ConvertRequest& request, InputByOutput& inputs) {
    for (const std::filesystem::path& file : output_files(job.output, request.mips)) {
        const Job written{job.input, file};
        if (request.detail.file) refuse_to_replace(*request.detail.file, "detail map", written);
        if (file != job.output) refuse_to_replace(job.input, "normal map", written);
        const auto [known, is_new] = inputs.emplace(weakly_canonical(absolute(file)), job.input);
        if (is_new) continue;
        throw UsageError(fmt::format("{} and {}: would both be written to {}",
                                     known->second.string(), job.input.string(), file.string()),
                         "convert them by separate calls, to different folders");
    }
}

ExitCode run(const CLI::App& app, const MapFiles& files, const ConvertRequest& given) {
    ConvertRequest request = given;
    request.input.judges_texels = !request.rebuild_z;
    request.input.needs_z = false;  // Codes can be kept without z.
    request.detail.input.assumed = request.input.assumed;
    apply_engine(request.output);
    check(app, request);
    MapWork work;
    work.head = {{"tool", "relief-bake convert"}, {"version", version()}};
    InputByOutput inputs;
    work.check = [&](const Job& job) {
        // For textures, --for sets only the direction of green.
        check_value_options(app, given, job.output);
        check_texture_options(app, given, job.output);
        if (!is_texture(job.output)) {
            format_of(request.output, job.output);
            write_options_of(request.output, job.output);
        }
        check_files(job, request, inputs);
    };
    work.work = [&](const Job& job, Stages& stages) -> FileOutcome {
        if (const auto kind = value_kind_of(job, request))
            return convert_values(job, request, *kind, stages);
        relief::detail::FileSet levels;
        const MapConversion conversion = convert_map(job, request, stages);
        levels.commit();
        return {line_of(job, conversion, stages), conversion.findings,
                summary_of(job, conversion, stages)};
    };
    return run_map_jobs(app, files, work);
}

}  // namespace

Choices<ResizeFilter> filter_choices() {
    return {{"best", ResizeFilter::best},
            {"box", ResizeFilter::box},
            {"triangle", ResizeFilter::triangle},
            {"cubic", ResizeFilter::cubic},
            {"lanczos", ResizeFilter::lanczos}};
}

Choices<ResizeDomain> domain_choices() {
    return {{"slopes", ResizeDomain::slopes}, {"vectors", ResizeDomain::vectors}};
}

Choices<NormalBlend> blend_choices() {
    return {{"reoriented", NormalBlend::reoriented},
            {"partial-derivative", NormalBlend::partial_derivative},
            {"whiteout", NormalBlend::whiteout},
            {"udn", NormalBlend::udn},
            {"unity", NormalBlend::unity},
            {"linear", NormalBlend::linear},
            {"overlay", NormalBlend::overlay}};
}

Command add_convert_command(CLI::App& tool) {
    struct Options {
        MapFiles files;
        ConvertRequest request;
    };
    CLI::App& app = add_subcommand(
        tool, "convert",
        "Converts normal maps (conventions, size, details, mip levels), and any map to a texture.");
    const auto options = std::make_shared<Options>();
    ConvertRequest& request = options->request;
    add_map_files(app, options->files, "normal map",
                  "OUT may be IN, which is replaced when the new map is complete, or a texture for "
                  "engines (.ktx2 .dds). The operations "
                  "run in a fixed order: z, axes, size, slopes, detail, mip levels, encoding.");
    add_input_options(app, request);
    add_axis_options(app, request);
    add_resize_options(app, request.resize);
    add_number(app, "--strength", "S", request.strength, {-1e6, 1e6, ""},
               "Factor for all slopes, as if the heights were scaled: 2 doubles the depth, -1 "
               "turns bumps into dents.")
        .group("Slopes");
    add_detail_options(app, request.detail);
    add_space_options(app, request.space);
    add_mip_options(app, request.mips);
    add_map_folder(app, options->files);
    add_map_output_options(app, request.output, true);
    add_texture_options(app, request.texture);
    add_value_options(app, request.values);
    add_report_options(app, options->files.report);
    add_general_options(app, options->files.general);
    set_common_options(
        app, {"--input-green", "--flip", "--resize", "--strength", "--detail", "--to-object",
              "--to-tangent", "--mips", "--roughness-from-variance", "--output", "--green",
              "--bits", "--dither", "--format", "--kind", "--max-error", "--report", "--strict"});
    set_examples(app, {"relief-bake bump data/bricks-height.png out/bricks.png",
                       "relief-bake convert out/bricks.png out/bricks-dx.png --flip green",
                       "relief-bake convert out/bricks.png out/bricks8.png --bits 8 --dither "
                       "blue-noise",
                       "relief-bake convert out/bricks.png out/small.png --resize 50% --strength 2",
                       "relief-bake convert out/bricks.png out/fine.png --detail out/small.png "
                       "--detail-repeat 4",
                       "relief-bake convert out/bricks.png out/mips.png --mips "
                       "--roughness-from-variance 0.3",
                       "relief-bake convert out/bricks.png out/bricks.ktx2 --format bc5 --mips",
                       "relief-bake convert data/bricks-diffuse.png out/bricks-color.ktx2 --kind "
                       "color --mips"});
    return {&app, [&app, options] { return run(app, options->files, options->request); }};
}

}  // namespace relief::tools
