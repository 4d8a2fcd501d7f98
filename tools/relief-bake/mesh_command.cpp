// SPDX-License-Identifier: Apache-2.0
// The command `relief-bake mesh` and its options. Contradictory and useless options are refused
// before any file is read. Tests: tests/tools/relief_bake_mesh_test.cpp,
// relief_bake_layers_test.cpp, relief_bake_shards_test.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <map>
#include <memory>

#include "common/file_jobs.h"
#include "common/model_file.h"
#include "common/summary.h"
#include "mesh_bake.h"
#include "mesh_shards.h"
#include "relief/mesh/execution.h"

namespace relief::tools {
namespace {

constexpr double default_angle = 2.0;  // In degrees.
constexpr int auto_samples = 16;

// Options of rays, texels and maps.

/// Parses "1024" or "2048x1024".
glm::ivec2 parse_map_size(const std::string& subject, const std::string& text) {
    if (text.find('x') != std::string::npos) return parse_size(subject, text);
    const int side = parse_integer(subject, text, 1, 16384);
    return {side, side};
}

SampleChoice parse_samples(const std::string& subject, const std::string& text) {
    if (text == "auto") return {auto_samples, true, true};
    const Choices<int> counts = {{"1", 1},   {"4", 4},     {"16", 16},
                                 {"64", 64}, {"256", 256}, {"auto", 0}};
    return {parse_choice(subject, text, counts), false, true};
}

void add_map_options(CLI::App& app, MeshBakeRequest& request) {
    const std::string group = "Map";
    add_value(app, "--size", "N|WxH", "Size of the map in texels. Default: 1024.",
              [&](const std::string& subject, const std::string& text) {
                  request.size = parse_map_size(subject, text);
              })
        .group(group);
    add_texel_options(app, request);
    add_value(app, "--padding", "PX|border",
              "Width of the padding around charts in texels, 0 to 1024, filled from the nearest "
              "texels. border fills the whole map, which needs temporary space in OUT's folder: 3 "
              "bytes per texel, and 4 bytes per texel and channel. Default: 16.",
              [&](const std::string& subject, const std::string& text) {
                  request.fills_to_border = text == "border";
                  request.bake.map.padding =
                      request.fills_to_border ? 0 : parse_integer(subject, text, 0, 1024);
              })
        .group(group);
    add_choice(
        app, "--background", request.background,
        Choices<Background>{{"flat", Background::flat}, {"transparent", Background::transparent}},
        "Texels beyond the padding: flat normals in three channels, or a fourth channel that is 1 "
        "in baked and padded texels (with --padding border: only in baked ones) and 0 elsewhere. "
        "Default: flat.")
        .group(group);
}

void add_high_texture_option(CLI::App& app, const std::string& name,
                             std::optional<std::filesystem::path>& target,
                             const std::string& description) {
    add_value(app, name, "FILE|none", description,
              [&target](const std::string&, const std::string& text) {
                  target = text == "none" ? std::filesystem::path() : std::filesystem::path(text);
              })
        .group("High models");
}

// Options of layers.

struct LayerInfo {
    LayerKind kind;
    const char* option;
    const char* description;
};

constexpr LayerInfo all_layers[] = {
    {LayerKind::height, "--height-map",
     "Write the height of the high surface above the low mesh along the ray, in the unit of the "
     "mesh."},
    {LayerKind::occlusion, "--occlusion-map",
     "Write the ambient occlusion by the high meshes: 1 is not occluded."},
    {LayerKind::curvature, "--curvature-map",
     "Write the mean curvature of the high meshes per unit of length: convex surfaces are "
     "positive; a sphere of radius r has 1/r."},
    {LayerKind::position, "--position-map",
     "Write the world positions of the points that rays hit."},
    {LayerKind::color, "--color-map",
     "Write the color of the high meshes: the product of vertex color, material color and "
     "texture. If a material is transparent, the fourth channel is the opacity."},
    {LayerKind::bent_normal, "--bent-normal-map",
     "Write the mean direction of the occlusion rays that hit nothing, in the space and with the "
     "green and the code of zero of the normal map."},
    {LayerKind::thickness, "--thickness-map",
     "Write the mean distance to the surface behind, along rays into the high meshes: white is "
     "--thickness-distance."},
    {LayerKind::id, "--id-map",
     "Write a flat color for each material of the high meshes; triangles without a material have "
     "the color of their object, or of their file. The report lists the colors."},
};

const LayerInfo& layer_info(LayerKind kind) {
    return *std::ranges::find(all_layers, kind, &LayerInfo::kind);
}

void add_layer_options(CLI::App& app, LayerOptions& options) {
    const std::string group = "Other layers, from the same rays";
    for (const LayerInfo& layer : all_layers) {
        add_value(app, layer.option, "FILE", layer.description,
                  [&options, kind = layer.kind](const std::string&, const std::string& text) {
                      options.files[kind] = text;
                  })
            .group(group);
    }
    add_choice(app, "--layer-bits", options.bits, Choices<int>{{"8", 8}, {"16", 16}, {"32", 32}},
               "Bits per channel of these files: 8 or 16 for .png; 8, 16 or 32 (float) for .tif; "
               "32 for .exr. Default: 16, 8 for colors and ids, and 32 for .exr.")
        .group(group);
    const Range positive{1e-30, 1e30, ""};
    add_number(app, "--height-range", "H", options.height_range, positive,
               "Height of white in 8 and 16 bits; black is -H, and the middle code is exactly 0. "
               "Default: the ray length.")
        .group(group);
    add_number(app, "--curvature-range", "C", options.curvature_range, positive,
               "Curvature of white in the same way. Default: the maximum; in 8 bits, the value "
               "that 99% of the high meshes do not exceed.")
        .group(group);
    add_number(app, "--position-range", "P", options.position_range, positive,
               "Coordinate of white in the same way. Default: the maximum of the high meshes.")
        .group(group);
    add_value(app, "--occlusion-rays", "N",
              "Occlusion rays per texel, 1 to 65536, shared by its samples, and by occlusion and "
              "bent normals. Doubling N reduces the error to 0.6 times. Default: 64.",
              [&options](const std::string& subject, const std::string& text) {
                  options.occlusion_rays = parse_integer(subject, text, 1, 65536);
              })
        .group(group);
    add_number(app, "--occlusion-distance", "D", options.occlusion_distance, {0.0, 1e30, ""},
               "Length of occlusion rays: surfaces farther away do not occlude. Default: half of "
               "the longest side of the bounding box of the high meshes.")
        .group(group);
    add_value(app, "--thickness-rays", "N",
              "Rays of the thickness per texel, 1 to 65536, shared by its samples. Default: 64.",
              [&options](const std::string& subject, const std::string& text) {
                  options.thickness_rays = parse_integer(subject, text, 1, 65536);
              })
        .group(group);
    add_number(app, "--thickness-distance", "D", options.thickness_distance, {1e-30, 1e30, ""},
               "Length of the rays of the thickness, with which rays that hit nothing count. "
               "Default: the longest side of the bounding box of the high meshes.")
        .group(group);
}

/// Checks an option that only integer files of one layer use.
void check_range(const LayerOptions& options, LayerKind kind, const std::optional<double>& range,
                 const char* option) {
    if (!range) return;
    if (!options.has(kind))
        throw UsageError(
            fmt::format("{}: has no effect without {}", option, layer_info(kind).option));
    if (bits_of(options, kind) == 32)
        throw UsageError(
            fmt::format("{}: has no effect on float files, which need no range", option));
}

void check(const LayerOptions& options) {
    for (const auto& [kind, file] : options.files)
        bits_of(options, kind);
    if (options.bits && options.files.empty())
        throw UsageError("--layer-bits: has no effect without a layer's file");
    check_range(options, LayerKind::height, options.height_range, "--height-range");
    check_range(options, LayerKind::curvature, options.curvature_range, "--curvature-range");
    check_range(options, LayerKind::position, options.position_range, "--position-range");
    if ((options.occlusion_rays || options.occlusion_distance) &&
        !options.has(LayerKind::occlusion) && !options.has(LayerKind::bent_normal)) {
        throw UsageError(
            "--occlusion-rays, --occlusion-distance: have no effect without --occlusion-map or "
            "--bent-normal-map");
    }
    if ((options.thickness_rays || options.thickness_distance) &&
        !options.has(LayerKind::thickness)) {
        throw UsageError(
            "--thickness-rays, --thickness-distance: have no effect without --thickness-map");
    }
}

BakeLayers bake_layers_of(const LayerOptions& options) {
    BakeLayers layers;
    layers.heights = options.has(LayerKind::height);
    layers.curvature = options.has(LayerKind::curvature);
    layers.positions = options.has(LayerKind::position);
    layers.colors = options.has(LayerKind::color);
    layers.ids = options.has(LayerKind::id);
    const OcclusionOptions occlusion{
        .rays = options.occlusion_rays.value_or(OcclusionOptions{}.rays),
        .distance = options.occlusion_distance};
    if (options.has(LayerKind::occlusion)) layers.occlusion = occlusion;
    if (options.has(LayerKind::bent_normal)) layers.bent_normals = occlusion;
    if (options.has(LayerKind::thickness)) {
        layers.thickness = {.rays = options.thickness_rays.value_or(ThicknessOptions{}.rays),
                            .distance = options.thickness_distance};
    }
    return layers;
}

// Options of accuracy and the preview.

void add_accuracy_options(CLI::App& app, MeshBakeRequest& request) {
    add_switch(app, "--verify", request.verify,
               "Read the finished map, compare every texel as rendered with the high models, and "
               "print the errors and their causes.")
        .group("Accuracy");
    add_error_map_option(app, request.error_map);
    add_error_bound(app, request.bound, "Accuracy",
                    "Increase samples and bits (unless they are given) until the error is at "
                    "most DEG degrees; fail if it never is. The error is measured on this map, "
                    "against the mean over each texel.");
    add_switch(app, "--compare", request.compare,
               "Also bake with all numbers of samples, bits and dither methods, in memory, and "
               "print their errors and times.")
        .group("Accuracy");
}

void add_preview_options(CLI::App& app, PreviewOptions& options) {
    const std::string group = "Report";
    add_path(app, "--preview", options.file,
             "Also write a picture (.png) of the high models, the low model with the finished map, "
             "and the low model without it, side by side; or a page (.html) that shows them beside "
             "a line and can be orbited.")
        .group(group);
    add_value(app, "--preview-size", "WxH",
              "Size of each of the three panels in pixels, or of the picture of the page. Default: "
              "512x512.",
              [&](const std::string& subject, const std::string& text) {
                  options.size = parse_size(subject, text);
              })
        .group(group);
}

// Checks of the command line.

/// Samples are counted along the sides of the map.
void check_sample_count(const MeshBakeRequest& request) {
    int across = 1;
    while (across * across < request.samples.count)
        ++across;
    const int max_side = TexelRasterizer::largest_side / across;
    if (std::max(request.size.x, request.size.y) <= max_side) return;
    throw UsageError(fmt::format("--size {}x{}: with {} samples per texel, the maximum side is {}",
                                 request.size.x, request.size.y, request.samples.count, max_side));
}

/// Splits the files into high meshes, low mesh and map, and checks the options.
void check_request(MeshBakeRequest& request, const std::vector<std::filesystem::path>& files) {
    if (files.size() < 3)
        throw UsageError(fmt::format("{} files are too few", files.size()),
                         "give HIGH... LOW OUT: models, and the map to write");
    request.high.assign(files.begin(), files.end() - 2);
    request.low = files[files.size() - 2];
    request.output = files.back();
    for (const std::filesystem::path& file : request.high)
        readable_format(file);
    readable_format(request.low);
    format_of(request.map, request.output);
    write_options_of(request.map, request.output);
    check(request.layers);
    if (request.textures.color && !request.layers.has(LayerKind::color))
        throw UsageError("--high-color: has no effect without --color-map");
    check_map_names(request);
    check_bake_options(request);
    check_sample_count(request);
    check_accuracy(request);
}

void check_error_map_request(const MeshBakeRequest& request,
                             const std::vector<std::filesystem::path>& files) {
    if (!request.error_map) return;
    if (!request.verify)
        throw UsageError("--error-map: has no effect without --verify", "give --verify");
    if (names_word(request.output, material_word) || names_word(request.output, tile_word))
        throw UsageError("--error-map: needs a single map, not <material> or <UDIM>",
                         "use relief-bake check for each map");
    check_error_map(request.error_map, files);
}

/// The maps of --write-into must be what glTF prescribes. The model may be LOW, but no other file.
void check_write_into(const MeshBakeRequest& request,
                      const std::vector<std::filesystem::path>& files) {
    if (!request.write_into.model) return;
    const auto refuse = [](const char* option, const char* problem, const char* remedy) {
        throw UsageError(fmt::format("{}, --write-into: {}", option, problem), remedy);
    };
    if (request.bake.space != VectorSpace::tangent)
        refuse("--space", "normals of glTF are in tangent space", "use --space tangent");
    if (request.map.green == Green::down) refuse("--green", "glTF has green up", "use --green up");
    if (request.map.flat == FlatCode::middle)
        refuse("--zero-code", "glTF decodes zero at 127.5", "use --zero-code 127.5");
    if (names_word(request.output, tile_word))
        refuse("<UDIM>", "a material of glTF has one image", "use --outside repeat");
    if (names_word(request.output, material_word) && request.write_into.material)
        refuse("--material", "<material> names the materials", "leave it out");
    check_image("--write-into", request.output);
    for (const LayerKind kind : {LayerKind::occlusion, LayerKind::color}) {
        if (request.layers.has(kind)) check_image("--write-into", request.layers.files.at(kind));
    }
    std::vector<std::filesystem::path> others = files;
    std::erase(others, request.low);
    check_distinct("--write-into", *request.write_into.model, others);
}

void check_files(const MeshBakeRequest& request, std::vector<std::filesystem::path> files) {
    if (request.cage) files.push_back(*request.cage);
    for (const auto& [kind, file] : request.layers.files)
        files.push_back(file);
    check(request.report, files);
    if (request.report.file) files.push_back(*request.report.file);
    check(request.preview, files);
    if (request.preview.file) files.push_back(*request.preview.file);
    check_write_into(request, files);
    check_error_map_request(request, files);
    require_folder_of(request.output);
    for (const auto& [kind, file] : request.layers.files)
        require_folder_of(file);
}

// The command.

struct MeshOptions {
    std::vector<std::filesystem::path> files;
    std::optional<std::string> output;  ///< -o as typed, because a final '/' is significant.
    MeshBakeRequest request;
    std::optional<ShardChoice> shard;
    std::optional<std::filesystem::path> part;
    GeneralOptions general;
};

// Several bakes: models are paired by the names of their files.

/// The placeholder of the name of a pair in output files.
constexpr std::string_view model_word = "<model>";

struct FilePair {
    std::string name;  ///< As in the name of the low file.
    std::vector<std::filesystem::path> high;
    std::filesystem::path low;
};

/// Pairs X_low with all X_high. \throws UsageError
std::vector<FilePair> file_pairs(const std::vector<std::filesystem::path>& files) {
    std::map<std::string, FilePair> pairs;
    for (const std::filesystem::path& file : files) {
        const std::string stem = file.stem().string();
        const std::optional<std::string> low = pair_name(stem, BakeSide::low);
        const std::optional<std::string> high = pair_name(stem, BakeSide::high);
        if (!low && !high) {
            throw UsageError(file.string() + ": has no pair name",
                             "name the models X_high and X_low");
        }
        FilePair& pair = pairs[low ? *low : *high];
        if (!low) {
            pair.high.push_back(file);
            continue;
        }
        if (!pair.low.empty()) {
            throw UsageError(fmt::format("{} and {}: are both the low model of '{}'",
                                         pair.low.string(), file.string(), *low));
        }
        pair.low = file;
        pair.name = stem.substr(0, low->size());
    }
    std::vector<FilePair> result;
    for (auto& [name, pair] : pairs) {
        if (pair.low.empty() || pair.high.empty()) {
            throw UsageError(
                fmt::format("'{}': has no {} model", name, pair.low.empty() ? "low" : "high"),
                "name the models X_high and X_low");
        }
        result.push_back(std::move(pair));
    }
    if (result.empty()) throw UsageError("IN is missing");
    return result;
}

/// The output of -o: in a folder, each map has the name of its pair.
std::filesystem::path output_pattern(const std::string& output) {
    if (output.ends_with('/') || std::filesystem::is_directory(output))
        return std::filesystem::path(output) / fmt::format("{}.png", model_word);
    return output;
}

/// The request of one pair, with its name in the names of all files.
MeshBakeRequest request_of(const MeshOptions& options, const FilePair& pair, bool is_only,
                           std::vector<std::filesystem::path>& files) {
    const auto named = [&](const std::filesystem::path& file) {
        if (!is_only && !names_word(file, model_word)) {
            throw UsageError(fmt::format("{}: several bakes would write or read it", file.string()),
                             fmt::format("write {} in its name", model_word));
        }
        return with_word(file, model_word, pair.name);
    };
    MeshBakeRequest request = options.request;
    for (auto& [kind, file] : request.layers.files)
        file = named(file);
    for (auto* file :
         {&request.cage, &request.preview.file, &request.write_into.model, &request.error_map}) {
        if (*file) *file = named(**file);
    }
    files = pair.high;
    files.push_back(pair.low);
    files.push_back(named(output_pattern(*options.output)));
    return request;
}

/// "out/rock.png: 1024 x 1024, 1 map, 3 texels missed, no findings, 2.1 s"
std::string line_of(const MeshBakeRequest& request, const MeshBake& bake, const Stages& stages) {
    return fmt::format("{}: {} x {}, {}, {} missed, {}, {}", request.output.string(),
                       request.size.x, request.size.y, counted(bake.maps.size(), "map"),
                       counted(bake.all.texels_missed, "texel"), bake.findings.count_text(),
                       duration(stages.milliseconds()));
}

/// Bakes one pair after another, because each bake uses all threads.
ExitCode bake_pairs(const CLI::App& app, const MeshOptions& options) {
    const std::vector<FilePair> pairs = file_pairs(options.files);
    if (options.output->ends_with('/')) make_folder(*options.output);
    std::vector<MeshBakeRequest> requests;
    Batch batch;
    check(app, options.request.write_into);
    for (const FilePair& pair : pairs) {
        std::vector<std::filesystem::path> files;
        MeshBakeRequest request = request_of(options, pair, pairs.size() == 1, files);
        check_request(request, files);
        check_files(request, files);
        batch.jobs.push_back({request.low, request.output});
        requests.push_back(std::move(request));
    }
    set_thread_limit(options.general.threads);
    batch.one_by_one = true;
    batch.head = {{"tool", "relief-bake mesh"}, {"version", version()}};
    batch.work = [&](std::size_t index) -> FileOutcome {
        const MeshBakeRequest& request = requests[index];
        Stages stages(true);
        const MeshBake bake = bake_maps(request, stages);
        return {line_of(request, bake, stages), strict_findings(request, bake.findings),
                summary_of(request, bake, stages)};
    };
    return run_batch(app, batch, options.request.report, options.general);
}

/// Checks the whole command line of a single bake.
void check_single(const CLI::App& app, MeshOptions& options) {
    MeshBakeRequest& request = options.request;
    apply_engine(request.map);
    check_request(request, options.files);
    check(app, request.write_into);
    check_files(request, options.files);
}

ExitCode run_shard(const CLI::App& app, MeshOptions& options) {
    if (options.output) {
        throw UsageError("-o, --shard: contradict each other", "bake the pairs one after another");
    }
    check_sharded(options.request);
    check_single(app, options);
    std::vector<std::filesystem::path> files = options.files;
    if (options.part) {
        check_distinct("--part", *options.part, files);
        require_folder_of(*options.part);
    }
    set_thread_limit(options.general.threads);
    Stages stages(options.general.quiet);
    const BakedShard shard = bake_shard(options.request, {shared_options(app), options.files},
                                        *options.shard, options.part, stages);
    if (options.general.quiet) return ExitCode::done;
    Summary summary;
    BakeCounts counts;
    std::vector<std::string> rows;
    for (const PartRows& one : shard.part.rows) {
        const std::string map = shard.part.plans[one.map].name();
        rows.push_back(fmt::format("{}{}rows {} to {}", map, map.empty() ? "" : ": ",
                                   one.found.rows.first, one.found.rows.last));
        counts += one.found.counts;
    }
    if (rows.empty()) rows.emplace_back("no rows: there are more shards than groups of 4 rows");
    summary.add("shard", fmt::format("{} of {}, job {}", shard.part.shard, shard.part.job.count,
                                     shard.part.job.hash()));
    summary.add("rows", rows);
    summary.add("texels", fmt::format("{} baked, {} missed, {} rays", counts.baked, counts.missed,
                                      counts.rays));
    summary.add_times(stages);
    summary.add("wrote", file_and_size(shard.file));
    summary.print();
    return ExitCode::done;
}

ExitCode run(const CLI::App& app, MeshOptions& options) {
    if (options.shard) return run_shard(app, options);
    if (options.part) throw UsageError("--part: has no effect without --shard");
    MeshBakeRequest& request = options.request;
    if (options.output) {
        apply_engine(request.map);
        return bake_pairs(app, options);
    }
    check_single(app, options);
    set_thread_limit(options.general.threads);
    Stages stages(options.general.quiet);
    const MeshBake bake = bake_maps(request, stages);
    const Summary summary = summary_of(request, bake, stages);
    if (!options.general.quiet) summary.print();
    for (const std::string& warning :
         {shared_texels_warning(request, bake),
          swapped_models_warning(request, bake.high_triangles, bake.low_triangles)}) {
        if (!warning.empty()) warn(app, warning);
    }
    return finish(app, request.report, request.low, strict_findings(request, bake.findings),
                  summary.json());
}

}  // namespace

void add_ray_options(CLI::App& app, MeshBakeRequest& request) {
    const std::string group = "Rays";
    add_choice(app, "--rays", request.directions, enum_choices<RayDirections>(),
               "Ray directions: smoothed normals, which ignore hard edges (averaged); the vertex "
               "normals of the low mesh (shading); or its face normals (face). Default: averaged.")
        .group(group);
    add_number(app, "--hardness", "H", request.hardness, {0.0, 1.0, ""},
               "Blends averaged ray directions with the vertex normals: at hard edges, 0 leaves no "
               "gaps, and 1 does not skew details. Default: 0.")
        .group(group);
    add_path(app, "--cage", request.cage,
             "Cast rays from this cage mesh to the low mesh. The cage has the triangles of the low "
             "mesh, moved outwards.")
        .group(group);
    add_number(app, "--offset", "D", request.bake.offset, {0.0, 1e30, ""},
               "Distance outside the low mesh at which rays begin, in its unit. Default: 1.5 times "
               "the distance of the surfaces, plus 1% of half the size of the low mesh.")
        .group(group);
    add_number(app, "--max-distance", "D", request.bake.max_distance, {0.0, 1e30, ""},
               "Distance inside the low mesh at which rays end. Default: as for --offset; with "
               "--cage, the distance to the cage.")
        .group(group);
    add_choice(app, "--match", request.match, enum_choices<PartMatching>(),
               "High parts that each low part sees: name selects parts with the same object or "
               "file name (X_low sees X_high, or X sees X if no low part is named so), all selects "
               "all parts, and auto selects by name if every part has a counterpart. Default: "
               "auto.")
        .group(group);
    add_choice(
        app, "--back-faces", request.bake.back_faces,
        Choices<BackFaces>{{"skip", BackFaces::skip}, {"take", BackFaces::take}},
        "High triangles that face away from the ray: skip ignores them, take flips their normals. "
        "Default: skip.")
        .group(group);
}

void add_texel_options(CLI::App& app, MeshBakeRequest& request) {
    const std::string group = "Map";
    add_choice(app, "--space", request.bake.space, enum_choices<VectorSpace>(),
               "Space of the normals: the tangent space of the low mesh (with the tangents of its "
               "file, else those of MikkTSpace), its object space, or world space. Default: "
               "tangent.")
        .group(group);
    add_value(app, "--samples", "N|auto",
              "Samples per texel: 1, 4, 16, 64 or 256 in a square grid; auto uses 4, and 16 if "
              "they differ. Default: 1.",
              [&](const std::string& subject, const std::string& text) {
                  request.samples = parse_samples(subject, text);
              })
        .group(group);
    add_number(app, "--sample-angle", "DEG", request.sample_angle, {0.0, 180.0, "degrees"},
               fmt::format("Difference of the first samples above which --samples auto uses more. "
                           "Default: {:g}.",
                           default_angle))
        .group(group);
    add_outside_option(app, request.bake.map.placement.repeat,
                       "Texture coordinates outside the unit square: do not bake them (drop), or "
                       "wrap them into the square (repeat). Default: drop.")
        .group(group);
}

void add_fit_options(CLI::App& app, MeshBakeRequest& request, const std::string& consequence) {
    add_number(
        app, "--max-missed", "PERCENT", request.max_missed, {0.0, 100.0, "percent"},
        fmt::format("Maximum percentage of the texels covered by LOW whose rays may hit nothing. "
                    "{} Default: {:g}.",
                    consequence, MeshBakeRequest{}.missed_limit()))
        .group("Rays");
    add_switch(app, "--allow-size-mismatch", request.bake.allow_size_mismatch,
               fmt::format("Accept models whose bounding boxes differ in size by more than a "
                           "factor of {:g}, which is an error otherwise.",
                           max_size_ratio))
        .group("Rays");
}

void add_high_normal_map_option(CLI::App& app, HighTextureOptions& options) {
    add_high_texture_option(app, "--high-normal-map", options.normal_map,
                            "Normal map of the high models, green up unless its metadata say "
                            "down, which is added to their normals; or none. Default: those of "
                            "their materials (glTF, MTL's norm).");
}

void add_error_map_option(CLI::App& app, std::optional<std::filesystem::path>& file) {
    add_path(app, "--error-map", file,
             "Write the error of every texel: .png from black (no error) to pale yellow (the "
             "printed maximum of the scale), .exr or .tif in degrees.")
        .group("Accuracy");
}

int bits_of(const LayerOptions& options, LayerKind kind) {
    const std::filesystem::path& file = options.files.at(kind);
    const std::vector<int> depths = depths_of(file);
    if (depths.empty()) {
        throw UsageError(fmt::format("{} {}: the format cannot store this layer",
                                     layer_info(kind).option, file.string()),
                         "use .png, .tif or .exr");
    }
    const bool is_8_bit =
        (kind == LayerKind::color || kind == LayerKind::id) && std::ranges::count(depths, 8) > 0;
    const int bits = options.bits.value_or(is_8_bit ? 8 : depths.front());
    check_depth("--layer-bits", bits, file, depths);
    return bits;
}

void check_bake_options(const MeshBakeRequest& request) {
    if (request.cage) {
        readable_format(*request.cage);
        if (request.bake.offset || request.directions || request.hardness)
            throw UsageError("--offset, --rays, --hardness: have no effect with --cage");
    }
    if (request.hardness &&
        request.directions.value_or(RayDirections::averaged) != RayDirections::averaged)
        throw UsageError("--hardness: has no effect without --rays averaged");
    if (request.sample_angle && !request.samples.is_auto)
        throw UsageError("--sample-angle: has no effect without --samples auto");
}

void check_error_map(const std::optional<std::filesystem::path>& file,
                     const std::vector<std::filesystem::path>& files) {
    if (!file) return;
    const std::string extension = extension_of(*file);
    if (extension != ".png" && extension != ".exr" && extension != ".tif" && extension != ".tiff") {
        throw UsageError(fmt::format("--error-map {}: the format cannot store it", file->string()),
                         "use .png, .exr or .tif");
    }
    check_distinct("--error-map", *file, files);
    require_folder_of(*file);
}

void check(const PreviewOptions& options, const std::vector<std::filesystem::path>& files) {
    if (!options.file) {
        if (options.size) throw UsageError("--preview-size: has no effect without --preview");
        return;
    }
    if (extension_of(*options.file) != ".png" && extension_of(*options.file) != ".html")
        throw UsageError(
            fmt::format("--preview {}: the format is not supported", options.file->string()),
            "use .png or .html");
    check_distinct("--preview", *options.file, files);
    require_folder_of(*options.file);
}

std::optional<double> angle_of(const MeshBakeRequest& request, const SampleChoice& samples) {
    if (!samples.is_auto) return std::nullopt;
    return request.sample_angle.value_or(default_angle);
}

BakeOptions bake_options_of(const MeshBakeRequest& request) {
    BakeOptions options = request.bake;
    options.map.layers = bake_layers_of(request.layers);
    options.map.width = request.size.x;
    options.map.height = request.size.y;
    options.directions = request.directions.value_or(RayDirections::averaged);
    options.hardness = request.hardness.value_or(0.0);
    options.map.samples = request.samples.count;
    if (const auto angle = angle_of(request, request.samples))
        options.map.sample_angle = glm::radians(*angle);
    if (request.fills_to_border) {
        const std::filesystem::path folder = request.output.parent_path();
        options.map.border_folder = folder.empty() ? "." : folder;
    }
    return options;
}

/// The findings for which --strict exits with 3: all except intended ones and those that an option
/// limits.
Findings strict_findings(const MeshBakeRequest& request, const Findings& findings) {
    Findings strict;
    for (const PlacedFinding& placed : findings.all()) {
        const std::string& kind = placed.finding.kind;
        const bool is_intended = kind == "texel of mirrored triangles";
        const bool is_limited = (kind == "texel missed by its rays" && request.max_missed) ||
                                (kind == "normal behind the surface" && request.bound.degrees);
        if (is_intended || is_limited) continue;
        Report report;
        report.add(placed.finding);
        strict.add(placed.where, report);
    }
    return strict;
}

namespace {

void add_mesh_options(CLI::App& app, MeshOptions& options) {
    MeshBakeRequest& request = options.request;
    add_files(
        app, "FILE...", options.files,
        "HIGH... LOW OUT: one or more detailed models (.glb .gltf .obj .ply .stl .off), the "
        "simple model with texture coordinates, and the map to write (.png .tif .exr .ktx2 .dds). "
        "<material> in the name of OUT writes a map for each material of LOW; <UDIM> writes "
        "a map for each UDIM tile that LOW uses.");
    add_value(
        app, "-o,--output", "PATH",
        "Bake several pairs of models, each X_low from all X_high. PATH is a folder for the "
        "maps X.png, or a name with <model>, which stands for X in the names of all files. If "
        "a pair fails, the others are still baked.",
        [&output = options.output](const std::string&, const std::string& text) { output = text; })
        .group("Several bakes");
    add_ray_options(app, request);
    add_fit_options(app, request,
                    "If more are missed, the bake fails and writes nothing. If this option is "
                    "given, --strict accepts missed texels.");
    add_map_options(app, request);
    add_high_normal_map_option(app, request.textures);
    add_high_texture_option(app, "--high-color", request.textures.color,
                            "Color texture of the high models for --color-map; or none. Default: "
                            "those of their materials.");
    add_assume_option(app, request.textures.assumed, {MapKind::normal, MapKind::color})
        .group("High models");
    add_layer_options(app, request.layers);
    add_map_output_options(app, request.map);
    add_preview_options(app, request.preview);
    add_accuracy_options(app, request);
    add_write_into_options(
        app, request.write_into,
        "Store the finished maps in a material of this model (.glb .gltf): normals, occlusion and "
        "colors. If it does not exist, it is made from LOW. It may be LOW itself, whose materials "
        "all get a map without <material> in its name.");
    add_report_options(
        app, request.report,
        "Exit with 3 if there is a finding. The map is written in any case. Accepted findings: "
        "texels of mirrored triangles; missed texels, with --max-missed; normals behind the "
        "surface, with --max-error.");
    add_general_options(app, options.general);
    add_shard_option(
        app, options.shard,
        "Bake only part K of N, with about the same number of covered texels in each, and write it "
        "as a file for relief-bake merge. The shards may run on different machines, in any order, "
        "and be repeated; the map is the same, byte for byte.");
    add_path(app, "--part", options.part,
             "The file of the shard. Default: OUT.JOB-K-of-N.part, where JOB is a hash of inputs "
             "and options.")
        .group("Several machines");
}

}  // namespace

MeshBakeRequest parse_mesh_request(const MeshArguments& arguments) {
    CLI::App app;
    MeshOptions options;
    add_mesh_options(app, options);
    try {
        app.parse(std::vector<std::string>(arguments.options.rbegin(), arguments.options.rend()));
    } catch (const CLI::Error& error) {
        throw UsageError(error.what());
    }
    options.files = arguments.files;
    check_single(app, options);
    return std::move(options.request);
}

Command add_mesh_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "mesh", "Bakes the normals of detailed models into a map for a simple one.");
    const auto options = std::make_shared<MeshOptions>();
    add_mesh_options(app, *options);
    set_common_options(
        app, {"--cage",          "--offset",  "--max-distance", "--match",      "--size",
              "--space",         "--samples", "--padding",      "--height-map", "--occlusion-map",
              "--curvature-map", "--green",   "--bits",         "--preview",    "--report",
              "--strict",        "--verify",  "--max-error",    "--threads",    "--write-into",
              "--shard"});
    set_examples(
        app,
        {"relief-mesh subdivide data/vase.obj out/high.obj --levels 2",
         "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 512 "
         "--preview out/vase-preview.png",
         "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 256 --verify",
         "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 128 --max-error 1",
         "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 64 --compare",
         "relief-bake mesh data/urn-high.ply data/urn-low.obj -o out/maps/ --size 64",
         "relief-bake mesh out/high.obj data/vase.obj 'out/<material>-<UDIM>.png'",
         "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 64 "
         "--occlusion-map out/vase-occlusion.png --write-into out/vase-baked.glb"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
