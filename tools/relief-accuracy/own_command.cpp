// SPDX-License-Identifier: Apache-2.0
// `relief-accuracy own FILE...` measures the methods on the user's meshes and maps, and
// recommends one.
// Tests: tests/tools/accuracy_run_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/trigonometric.hpp>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy_report.h"
#include "commands.h"
#include "common/command.h"
#include "common/error_bound.h"
#include "common/model_file.h"
#include "common/normal_map_input.h"
#include "common/options.h"
#include "common/text.h"
#include "relief/accuracy/asset.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map_check.h"

namespace relief::tools {
using namespace relief::accuracy;

namespace {

/// The content of an image.
enum class ImageKind { heights, normals };

struct AssetRequest {
    std::vector<std::filesystem::path> files;
    std::optional<std::filesystem::path> high, low;
    std::optional<ImageKind> image_kind;  ///< Default: detected from the image.
    std::optional<NormalReference> reference;
    std::optional<double> crease_degrees;
    std::optional<double> strength;
    std::optional<double> relief_depth;      ///< Of black in texels.
    std::optional<glm::dvec2> view_degrees;  ///< Between the view and the normal.
    std::optional<HeightChannel> channel;
    std::optional<WrapsOrAuto> wrap;
    std::optional<int> size;
};

/// An input: a file, or a pair of meshes.
struct AssetInput {
    std::filesystem::path file;
    std::optional<std::filesystem::path> high;  ///< Of a pair; then `file` is the low mesh.
    std::string name;                           ///< The name in titles.
};

constexpr int default_map_size = 256;
constexpr glm::dvec2 default_view_degrees{45.0, 70.0};
constexpr std::size_t quick_triangles = std::size_t{1} << 17;
constexpr std::int64_t quick_texels = std::int64_t{1} << 18;

/// Returns the triangles of a model with the stored normals and tangents, once per primitive.
Mesh read_asset_mesh(const std::filesystem::path& file) {
    Report report;
    Model model = read_model(file, report);
    if (auto* mesh = std::get_if<MeshFile>(&model)) return std::move(mesh->mesh);
    const auto& document = std::get<GltfDocument>(model);
    std::vector<MapModelPart> parts;
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        MapModelPart part;
        part.name = document.describe(id);
        part.mesh = document.mesh(id, document.tangent_texcoords(id).set);
        parts.push_back(std::move(part));
    }
    return joined(std::move(parts));
}

std::vector<AssetExperiment> measure_mesh(const AssetInput& input, const AssetRequest& request,
                                          const AssetOptions& options, std::string& description) {
    AssetMeshOptions how;
    how.ground_truth = request.reference.value_or(NormalReference::surface);
    if (request.crease_degrees) how.crease_angle = glm::radians(*request.crease_degrees);
    if (options.run.is_quick) how.max_triangles = quick_triangles;
    description = "a mesh";
    return measure_asset_mesh(read_asset_mesh(input.file), how, options);
}

std::vector<AssetExperiment> measure_pair(const AssetInput& input, const AssetRequest& request,
                                          const AssetOptions& options, std::string& description) {
    Report report;
    MapModel low = read_map_model(input.file, ModelSpace::world, report);
    require_texcoords(input.file, low, "no texture coordinates for the map", "unwrap it first");
    MapModel high =
        about(*input.high, [&] { return read_map_model(*input.high, ModelSpace::world, report); });
    move_to(high, low.origin);
    const Mesh high_mesh = joined(std::move(high.parts));
    const Mesh low_mesh = joined(std::move(low.parts));
    const Baker baker(std::span(&high_mesh, 1), low_mesh, {}, report);
    const int size = request.size.value_or(default_map_size);
    description =
        fmt::format("a pair: a map of {0} x {0} is baked from {1}", size, input.high->string());
    return {measure_asset_bake(baker, size, options)};
}

ImageKind kind_shown(const std::filesystem::path& file) {
    const ImageInfo info = read_image_info(file);
    if (info.channels < 3) return ImageKind::heights;
    const MapContent content =
        check_normal_map(read_image(file, ImageUse::data), info.metadata).content;
    return content == MapContent::gray || content == MapContent::other ? ImageKind::heights
                                                                       : ImageKind::normals;
}

/// Reports signs that an image is not a height map: different channels, or a varying alpha.
void add_color_findings(const Image& image, Report& report) {
    // The largest difference between channels of a gray JPEG.
    constexpr float tolerance = 4.0F / 255.0F;
    const Image floats = to_float(image);
    const std::span<const float> samples = floats.as<float>();
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t texel = 0; texel < samples.size() / channels; ++texel) {
        const auto colors = samples.subspan(texel * channels, channels);
        if (channels >= 3) {
            const auto [least, greatest] = std::minmax({colors[0], colors[1], colors[2]});
            if (greatest - least > tolerance) {
                report.add("texel whose red, green and blue differ", "texel", texel,
                           "the height is their mean, which is wrong for photographs and packed "
                           "masks (--channel selects one of them)");
            }
        }
        if (channels % 2 == 0 &&
            std::abs(colors[channels - 1] - samples[channels - 1]) > tolerance) {
            report.add("texel whose alpha differs from the first one's", "texel", texel,
                       "alpha is ignored (--channel alpha selects it as the height)");
        }
    }
}

void add_non_finite(const Image& heights, Report& report) {
    if (heights.bits() != 32) return;
    const std::span<const float> all = heights.as<float>();
    for (std::size_t texel = 0; texel < all.size(); ++texel) {
        if (!std::isfinite(all[texel]))
            report.add("non-finite height", "texel", texel,
                       "read as the mean of the nearest finite heights");
    }
}

/// Returns the findings on a height map. Texels of a map that is too large for memory have none.
///
/// \param of_choice  those of the choice of a kernel
std::vector<std::string> height_findings(const HeightMapFile& map, const AssetRequest& request,
                                         const Report& of_choice) {
    Report report;
    if (!map.is_streamed()) {
        if (!request.channel && map.info().channels > 1)
            add_color_findings(read_image(map.path(), ImageUse::data), report);
        add_non_finite(map.map().heights, report);
    }
    report.merge(of_choice);
    Findings findings;
    findings.add("", report, map.info().width);
    return findings.lines();
}

std::vector<AssetExperiment> measure_heights(const AssetInput& input, const AssetRequest& request,
                                             AssetOptions options, std::string& description) {
    const HeightMapFile map(input.file, {request.channel.value_or(HeightChannel::mean)});
    const int width = map.info().width;
    const int height = map.info().height;
    const BumpSampleParts parts = {
        parts_to_analyze(width, height),
        parts_to_measure(width, height, options.run.is_quick ? quick_texels : texels_to_measure)};
    const HeightMapFile::Survey survey = map.survey(parts.in_order());
    BumpOptions bump;
    bump.strength = request.strength.value_or(bump.strength);
    bump.wrap = request.wrap.value_or(WrapsOrAuto{}).value_or(survey.tiling.wraps());
    description += fmt::format("a height map of {} bits, {:g} texels high, {} at the border",
                               map.info().bits, bump.strength, name_of(*bump.wrap));
    if (request.channel) {
        const std::string name = enum_name(*request.channel);
        description += fmt::format(", channel {}", name);
        options.height_arguments = " --channel " + name;
    }
    Report report;
    std::vector<AssetExperiment> all = {
        measure_asset_heights(parts.sample(survey.parts), {width, height}, bump, options, report)};
    all.front().experiment.input_findings = height_findings(map, request, report);
    if (request.relief_depth) {
        if (map.is_streamed())
            throw InvalidInput("the map is too large for --height-depth: it is read in parts");
        all.push_back(measure_asset_relief(map.map().heights, *bump.wrap, *request.relief_depth,
                                           request.view_degrees.value_or(default_view_degrees),
                                           options));
    }
    return all;
}

/// Returns the lossy compression of an image file by its first bytes: JPEG, WebP, or the blocks of
/// GPUs in DDS and KTX2. Empty: none that is known.
std::string lossy_compression(const std::filesystem::path& file) {
    std::array<char, 132> bytes{};
    std::ifstream(file, std::ios::binary).read(bytes.data(), bytes.size());
    const std::string_view head(bytes.data(), bytes.size());
    const auto number_at = [&](std::size_t offset) {
        std::uint32_t number = 0;
        std::memcpy(&number, bytes.data() + offset, sizeof number);
        return number;
    };
    const auto is_within = [](std::uint32_t value, std::uint32_t first, std::uint32_t last) {
        return value >= first && value <= last;
    };
    if (head.starts_with("\xFF\xD8\xFF")) return "JPEG";
    if (head.starts_with("RIFF") && head.substr(8, 8) == "WEBPVP8 ") return "WebP";
    if (head.starts_with("\xABKTX 20")) {
        constexpr std::uint32_t bc1 = 131, last_astc = 184, basis = 1;  // Numbers of VkFormat.
        return is_within(number_at(12), bc1, last_astc) || number_at(44) == basis ? "block" : "";
    }
    if (!head.starts_with("DDS ")) return "";
    const std::string_view code = head.substr(84, 4);
    const bool is_dx10_block =
        code == "DX10" && (is_within(number_at(128), 70, 84) || is_within(number_at(128), 94, 99));
    const bool is_block = code.starts_with("DXT") || code.starts_with("ATI") ||
                          code.starts_with("BC4") || code.starts_with("BC5");
    return is_block || is_dx10_block ? "block" : "";
}

/// Returns the extension of a format that relief-bake writes without loss.
std::string lossless_extension(const std::filesystem::path& file, int bits) {
    const std::string own = extension_of(file);
    if (own == ".tif" || own == ".tiff") return own;
    return bits == 32 ? ".exr" : ".png";
}

std::vector<AssetExperiment> measure_normals(const AssetInput& input, const AssetOptions& options,
                                             std::string& description) {
    const InputMap map = read_normal_map(input.file, {});
    Report report;
    const Image normals =
        decode_normal_map(map.image, map.green.value_or(Green::up), map.flat, report);
    description += fmt::format("a normal map of {} bits: {}", map.image.bits(), map.conventions);
    const NormalMapStorage stored = {map.image.bits(), map.image.channels,
                                     lossless_extension(input.file, map.image.bits())};
    std::vector<AssetExperiment> all = {measure_asset_normals(
        normals, stored, options, options.run.is_quick ? quick_texels : texels_to_measure)};
    Findings findings;
    findings.add("", report, normals.width);
    all.front().experiment.input_findings = findings.lines();
    return all;
}

std::vector<AssetExperiment> measure_image(const AssetInput& input, const AssetRequest& request,
                                           const AssetOptions& options, std::string& description) {
    const bool is_given = request.image_kind || request.channel;
    const ImageKind kind = request.image_kind ? *request.image_kind
                           : request.channel  ? ImageKind::heights
                                              : kind_shown(input.file);
    std::vector<AssetExperiment> all = kind == ImageKind::heights
                                           ? measure_heights(input, request, options, description)
                                           : measure_normals(input, options, description);
    if (!is_given)
        description += kind == ImageKind::heights ? " (if not: --image normals)"
                                                  : " (if not: --image heights)";
    return all;
}

/// Refuses options without effect on the inputs.
void check_effects(const AssetRequest& request, const std::vector<AssetInput>& inputs) {
    const auto any = [&](const auto& is_one) {
        return std::any_of(inputs.begin(), inputs.end(), is_one);
    };
    const bool meshes =
        any([](const AssetInput& one) { return !one.high && has_model_extension(one.file); });
    const bool pairs = any([](const AssetInput& one) { return one.high.has_value(); });
    const bool images = any([](const AssetInput& one) { return !has_model_extension(one.file); });
    const bool heights = images && request.image_kind != ImageKind::normals;
    const auto require = [](bool has_input, bool is_given, const char* option, const char* input) {
        if (is_given && !has_input)
            throw UsageError(fmt::format("{}: applies only to {}", option, input));
    };
    require(meshes, request.reference.has_value(), "--truth", "meshes");
    require(meshes, request.crease_degrees.has_value(), "--crease", "meshes");
    require(pairs, request.size.has_value(), "--size", "a pair, --high and --low");
    require(images, request.image_kind.has_value(), "--image", "images");
    require(heights, request.strength.has_value(), "--strength", "height maps");
    require(heights, request.wrap.has_value(), "--wrap", "height maps");
    require(heights, request.relief_depth.has_value(), "--height-depth", "height maps");
    require(request.relief_depth.has_value(), request.view_degrees.has_value(), "--view-angles",
            "relief mapping, --height-depth");
    require(heights, request.channel.has_value(), "--channel", "height maps");
}

/// \throws UsageError if options contradict each other or have no effect on these inputs
std::vector<AssetInput> inputs_of(const AssetRequest& request) {
    if (request.high.has_value() != request.low.has_value())
        throw UsageError(request.high ? "--high: requires the other mesh of the pair"
                                      : "--low: requires the other mesh of the pair",
                         request.high ? "give --low FILE" : "give --high FILE");
    std::vector<AssetInput> inputs;
    std::set<std::string> names;
    for (const std::filesystem::path& file : request.files) {
        if (!names.insert(file.string()).second)
            throw UsageError(fmt::format("{}: given twice", file.string()));
        const bool is_shared =
            std::count_if(request.files.begin(), request.files.end(), [&](const auto& other) {
                return other.filename() == file.filename();
            }) > 1;
        inputs.push_back({file, {}, is_shared ? file.string() : file.filename().string()});
    }
    if (request.low) {
        for (const auto& file : {*request.high, *request.low})
            readable_format(file);
        inputs.push_back({*request.low, request.high,
                          fmt::format("{} for {}", request.high->filename().string(),
                                      request.low->filename().string())});
    }
    if (inputs.empty()) throw UsageError("no input", "name a mesh, a map, or --high and --low");
    check_effects(request, inputs);
    return inputs;
}

/// Measures an input.
/// \param options      all but `file` and `arguments`
/// \param description  receives the type of the input and how it was read
/// \throws FileError
std::vector<AssetExperiment> measure(const AssetInput& input, const AssetRequest& request,
                                     AssetOptions options, std::string& description) {
    options.file = input.name;
    if (!input.high && !has_model_extension(input.file))
        options.lossy_compression = lossy_compression(input.file);
    options.arguments =
        input.high ? quoted(*input.high) + " " + quoted(input.file) : quoted(input.file);
    return about(input.file, [&] {
        if (input.high) return measure_pair(input, request, options, description);
        if (has_model_extension(input.file))
            return measure_mesh(input, request, options, description);
        return measure_image(input, request, options, description);
    });
}

struct AssetCommandOptions {
    AssetRequest request;
    ErrorBound bound;
    std::optional<double> max_milliseconds;
    ExperimentOptions how;
};

/// Longer tables show only the efficient and the recommended methods.
constexpr std::size_t max_rows = 24;

void check(const AssetCommandOptions& options) {
    check(options.how);
    check(options.bound);
    if (options.how.no_times && options.max_milliseconds)
        throw UsageError("--no-times and --max-time contradict each other");
}

/// Returns the command that repeats the report.
std::string command_for(const CLI::App& app, const AssetRequest& request) {
    std::string command = "relief-accuracy own";
    for (const std::filesystem::path& file : request.files)
        command += " " + quoted(file);
    return command + repeated_options(app);
}

/// Returns the table of an experiment, shortened if it has many methods.
std::string short_table(const AssetExperiment& own) {
    Experiment shown = own.experiment;
    const std::size_t all = shown.measurements.size();
    if (all <= max_rows) return table_of(shown);
    std::vector<Measurement> rows;
    for (std::size_t i = 0; i < all; ++i) {
        const bool is_recommended = own.recommendation.method == i || own.recommendation.next == i;
        if (is_recommended || shown.measurements[i].is_pareto_optimal)
            rows.push_back(std::move(shown.measurements[i]));
    }
    shown.input +=
        fmt::format(" (only the efficient ones of {} methods; the report contains all)", all);
    shown.measurements = std::move(rows);
    return table_of(shown);
}

/// Returns the findings on an input, from its first experiment, because all share the input.
std::vector<std::string> findings_of(const std::vector<AssetExperiment>& experiments) {
    if (experiments.empty() || experiments.front().experiment.input_findings.empty())
        return {"none"};
    return experiments.front().experiment.input_findings;
}

AssetOptions asset_options(const CLI::App& app, const AssetCommandOptions& options,
                           Stages& stages) {
    AssetOptions own;
    own.run = run_options(options.how);
    own.run.tell = [&stages](const RunProgress& progress) {
        stages.show_progress(progress.title, 0.0);
    };
    own.command = command_for(app, options.request);
    own.request.max_error = options.bound.degrees;
    own.request.kind = options.bound.statistic();
    if (options.max_milliseconds) own.request.max_seconds = 1e-3 * *options.max_milliseconds;
    return own;
}

ExitCode run(const CLI::App& app, const AssetCommandOptions& options) {
    check(options);
    const std::vector<AssetInput> inputs = inputs_of(options.request);
    prepare(options.how);
    Stages stages(options.how.general.quiet);
    const AssetOptions own = asset_options(app, options, stages);
    AccuracyReport report;
    report.command = own.command;
    bool is_within_limits = true;
    const ProcessorUse use;
    for (const AssetInput& input : inputs) {
        std::string description;
        std::vector<AssetExperiment> experiments =
            measure(input, options.request, own, description);
        stages.clear_progress();
        if (prints_tables(options.how)) {
            print_entry("input", input.file.string() + ": " + description);
            print_entry("findings", findings_of(experiments));
        }
        for (AssetExperiment& one : experiments) {
            if (prints_tables(options.how))
                print_text(fmt::format("\n{}", printable_lines(short_table(one))));
            is_within_limits = is_within_limits && one.recommendation.method.has_value();
            report.experiments.push_back(std::move(one.experiment));
        }
        if (prints_tables(options.how)) print_text("\n");
        std::fflush(out());
    }
    finish_report(options.how, std::move(report), false, use);
    const bool has_limits = options.bound.degrees || options.max_milliseconds;
    return has_limits && !is_within_limits ? ExitCode::failed : ExitCode::done;
}

void add_input_options(CLI::App& app, AssetRequest& request) {
    add_files(app, "FILE...", request.files,
              "Meshes (.glb .gltf .obj .ply .stl .off), height maps and normal maps. Two meshes "
              "are separate inputs, not a pair.");
    const char* pair = "Pair of meshes: the error of a map baked from one for the other";
    add_path(app, "--high", request.high, "The detailed mesh.").group(pair);
    add_path(app, "--low", request.low, "The simple mesh, with texture coordinates.").group(pair);
    add_value(app, "--size", "N", "The width and height of the map in texels. Default: 256.",
              [&](const std::string& subject, const std::string& text) {
                  request.size = parse_integer(subject, text, 16, 16384);
              })
        .group(pair);
    const char* mesh = "Meshes";
    const Choices<NormalReference> references = {{"surface", NormalReference::surface},
                                                 {"file", NormalReference::file}};
    add_choice(app, "--truth", request.reference, references,
               "The ground truth of normals: a smooth surface fitted through the vertices, or the "
               "normals of the file. Default: surface.")
        .group(mesh);
    add_number(app, "--crease", "DEG", request.crease_degrees, {0.0, 180.0, "degrees"},
               "Edges sharper than this angle are hard; 180: no hard edges. Default: the smoothing "
               "groups of the file, or else the discontinuities of its normals, or else none.")
        .group(mesh);
    const char* image = "Maps";
    const Choices<ImageKind> kinds = {{"heights", ImageKind::heights},
                                      {"normals", ImageKind::normals}};
    add_choice(app, "--image", request.image_kind, kinds,
               "The content of images. Default: detected and reported for each image.")
        .group(image);
    add_number(app, "--strength", "S", request.strength, {-1e6, 1e6, "texels"},
               "Height maps: the height of the value 1.0 in texels. Default: 16.")
        .group(image);
    add_number(app, "--height-depth", "D", request.relief_depth, {0.01, 16384.0, "texels"},
               "Height maps: also measure the methods of relief mapping, with black at this depth "
               "in texels: errors in texels, for views of a plane.")
        .group(image);
    add_value(app, "--view-angles", "FROM,TO",
              "With --height-depth: the smallest and the largest angle in degrees between the view "
              "and the normal of the surface, within 0 to 89. Default: 45,70.",
              [&](const std::string& subject, const std::string& text) {
                  const std::vector<double> angles = parse_numbers(subject, text);
                  if (angles.size() != 2 ||
                      !(0.0 <= angles[0] && angles[0] <= angles[1] && angles[1] <= 89.0))
                      throw UsageError(
                          fmt::format("{}: not two ascending angles within 0 to 89", subject));
                  request.view_degrees = glm::dvec2(angles[0], angles[1]);
              })
        .group(image);
    add_choice(
        app, "--channel", request.channel, enum_choices<HeightChannel>(),
        "Height maps: the height channel of a color image, as for relief-bake bump; the image is "
        "then read as a height map. Default: mean, with a finding if the channels differ.")
        .group(image);
    request.wrap.reset();
    add_value(app, "--wrap", "WORD",
              "Height maps: the continuation beyond the border: repeat, clamp, mirror, or auto "
              "(repeat if the map tiles). Default: auto.",
              [&](const std::string& subject, const std::string& text) {
                  const std::optional<Wrap> wrap =
                      parse_choice(subject, text, wrap_or_auto_choices());
                  request.wrap = WrapsOrAuto{wrap, wrap};
              })
        .group(image);
}

void add_limit_options(CLI::App& app, AssetCommandOptions& options) {
    const char* group = "Recommendation; by default the method beyond which more time gains little";
    add_error_bound(
        app, options.bound, group,
        "Recommend the cheapest method whose expected error is within this limit. The expected "
        "error includes the error of the map or model itself; if that is a range, its lower end "
        "counts; if it is unknown, as for JPEG files, no method is within a limit. Without times: "
        "the method that stores the fewest bytes, then the one with the fewest operations. Exit "
        "with 1 if an experiment has no such method.");
    add_number(app, "--max-time", "MS", options.max_milliseconds, {0.0, 1e9, "milliseconds"},
               "Recommend the most accurate method within this time.")
        .group(group);
}

void add_options(CLI::App& app, AssetCommandOptions& options) {
    add_input_options(app, options.request);
    add_limit_options(app, options);
    add_experiment_options(app, options.how);
    set_examples(
        app, {"relief-accuracy own data/vase.obj --quick",
              "relief-accuracy own data/bricks-height.png --strength 12 --max-error 4 --quick",
              "relief-accuracy own data/bricks-height.png --height-depth 12 --view-angles 60,80 "
              "--quick",
              "relief-mesh subdivide data/vase.obj out/high.obj --levels 2",
              "relief-accuracy own --high out/high.obj --low data/vase.obj --size 64 --repeats 3",
              "relief-accuracy own data/vase.obj --crease 40 --no-times --output out/vase"});
}

}  // namespace

Command add_own_command(CLI::App& tool) {
    return add_command<AssetCommandOptions>(
        tool, "own", "Measures methods on your meshes and maps, and recommends one.", add_options,
        run);
}

}  // namespace relief::tools
