// SPDX-License-Identifier: Apache-2.0
// The options of `relief-bake mesh`. Tests: tests/tools/relief_bake_mesh_test.cpp.
#include "mesh/mesh_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/model_file.h"
#include "common/options.h"
#include "mesh/mesh_accuracy.h"
#include "mesh/mesh_sets.h"
#include "mesh/mesh_verify.h"
#include "mesh/model_fit.h"

namespace relief::tools {
namespace {

constexpr double default_angle = 2.0;  // Degrees, of --samples auto.
constexpr int auto_samples = 16;

/// "1024" or "2048x1024"
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
    add_value(app, "--size", "N|WxH", "Of the map, in texels. Default: 1024.",
              [&](const std::string& subject, const std::string& text) {
                  request.size = parse_map_size(subject, text);
              })
        .group(group);
    add_texel_options(app, request);
    add_value(app, "--padding", "PX|border",
              "Fill so many texels around charts from the nearest ones, 0 to 1024; or all, up to "
              "the map's border, for which OUT's folder needs room: 4 bytes a texel and channel, "
              "and 3. Default: 16.",
              [&](const std::string& subject, const std::string& text) {
                  request.fills_to_border = text == "border";
                  request.padding =
                      request.fills_to_border ? 0 : parse_integer(subject, text, 0, 1024);
              })
        .group(group);
    add_choice(
        app, "--background", request.background,
        Choices<Background>{{"flat", Background::flat}, {"transparent", Background::transparent}},
        "What is further away: flat, in three channels; or transparent, with a fourth that "
        "is 1 where the map is baked or padded (with --padding border: baked). Default: flat.")
        .group(group);
}

/// Samples are counted along the sides of the map.
void check_sample_count(const MeshBakeRequest& request) {
    int across = 1;
    while (across * across < request.samples.count)
        ++across;
    const int most = TexelCover::largest_side / across;
    if (std::max(request.size.x, request.size.y) <= most) return;
    throw UsageError(
        fmt::format("--size {}x{}: with {} samples a texel, {} are the most along a side",
                    request.size.x, request.size.y, request.samples.count, most));
}

void check_cage(const MeshBakeRequest& request) {
    if (!request.cage) return;
    readable_format(*request.cage);
    if (request.offset || request.directions || request.hardness)
        throw UsageError("--offset, --rays, --hardness: have no effect with --cage");
}

}  // namespace

void add_ray_options(CLI::App& app, MeshBakeRequest& request) {
    const std::string group = "Rays";
    add_choice(app, "--rays", request.directions,
               Choices<RayDirections>{{"averaged", RayDirections::averaged},
                                      {"shading", RayDirections::shading},
                                      {"face", RayDirections::face}},
               "Along what rays run: normals averaged over all that meets at a place, whatever is "
               "hard or split there; the low mesh's own; or those of its triangles. Default: "
               "averaged.")
        .group(group);
    add_number(app, "--hardness", "H", request.hardness, {0.0, 1.0, ""},
               "How far averaged rays are drawn to the low mesh's own normals: at hard edges, 0 "
               "leaves no gap, 1 skews no detail. Default: 0.")
        .group(group);
    add_path(app, "--cage", request.cage,
             "Cast rays from this mesh to the low one instead: its triangles, moved outwards.")
        .group(group);
    add_number(app, "--offset", "D", request.offset, {0.0, 1e30, ""},
               "How far outside of the low mesh rays begin, in its unit. Default: 1.5 times what "
               "the surfaces are apart, and 1% of the low mesh's half size.")
        .group(group);
    add_number(app, "--max-distance", "D", request.max_distance, {0.0, 1e30, ""},
               "How far inside of the low mesh rays end. Default: as for --offset; with --cage, as "
               "far again as it is outside.")
        .group(group);
    add_choice(app, "--match", request.match,
               Choices<MatchChoice>{{"auto", MatchChoice::automatic},
                                    {"name", MatchChoice::name},
                                    {"all", MatchChoice::all}},
               "Which high parts each low part sees: those of its name (X_low sees X_high, as "
               "objects or files are called), all, or by name if all have a counterpart (auto). "
               "Default: auto.")
        .group(group);
    add_choice(
        app, "--back-faces", request.back_faces,
        Choices<BackFaces>{{"skip", BackFaces::skip}, {"take", BackFaces::take}},
        "High triangles seen from behind: rays pass through them, or hit them as if they were "
        "turned round. Default: skip.")
        .group(group);
}

void add_texel_options(CLI::App& app, MeshBakeRequest& request) {
    const std::string group = "Map";
    add_choice(app, "--space", request.space,
               Choices<SpaceChoice>{{"tangent", SpaceChoice::tangent},
                                    {"object", SpaceChoice::object},
                                    {"world", SpaceChoice::world}},
               "What the normals are relative to: the low mesh's normals and tangents (its own, "
               "else MikkTSpace's), its axes, or the world's. Default: tangent.")
        .group(group);
    add_value(
        app, "--samples", "N|auto",
        "Rays for each texel: 1, 4, 16, 64 or 256 in a square grid; auto casts 4, and 16 where "
        "they disagree. Default: 1.",
        [&](const std::string& subject, const std::string& text) {
            request.samples = parse_samples(subject, text);
        })
        .group(group);
    add_number(app, "--sample-angle", "DEG", request.sample_angle, {0.0, 180.0, "degrees"},
               fmt::format("By how much, with --samples auto. Default: {:g}.", default_angle))
        .group(group);
    add_choice(
        app, "--outside", request.outside,
        Choices<OutsideChoice>{{"drop", OutsideChoice::drop}, {"repeat", OutsideChoice::repeat}},
        "Texture coordinates outside of the unit square: not baked, or moved into it by "
        "whole numbers, as textures repeat. Default: drop.")
        .group(group);
}

void add_mesh_options(CLI::App& app, MeshBakeRequest& request,
                      std::vector<std::filesystem::path>& files) {
    add_files(app, "FILE...", files,
              "HIGH... LOW OUT: the detailed models (.glb .gltf .obj .ply .stl .off), one or "
              "several; the simple model, with texture coordinates; the map to write (.png .tif "
              ".exr). <material> in its name gives a map for each material of LOW, <UDIM> one for "
              "each tile that its texture coordinates enter.");
    add_ray_options(app, request);
    add_fit_options(app, request,
                    "more is an error, and nothing is written. With --strict, texels that are "
                    "missed are no fault where this is given");
    add_map_options(app, request);
    add_high_normal_map_option(app, request.looks);
    add_high_color_option(app, request.looks);
    add_layer_options(app, request.layers);
    add_map_output_options(app, request.map);
    add_preview_options(app, request.preview);
    add_verify_options(app, request.verify);
    add_accuracy_options(app, request.accuracy);
}

void check_bake_options(const MeshBakeRequest& request) {
    check_cage(request);
    if (request.hardness &&
        request.directions.value_or(RayDirections::averaged) != RayDirections::averaged)
        throw UsageError("--hardness: is for --rays averaged");
    if (request.sample_angle && !request.samples.is_auto)
        throw UsageError("--sample-angle: has no effect without --samples auto");
}

void check_mesh_options(MeshBakeRequest& request, const std::vector<std::filesystem::path>& files) {
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
    check_layer_options(request.layers);
    if (request.looks.color && !request.layers.files.contains(LayerKind::color))
        throw UsageError("--high-color: has no effect without --color-map");
    check_map_names(request);
    check_bake_options(request);
    check_sample_count(request);
    check_accuracy(request);
}

std::optional<double> angle_of(const MeshBakeRequest& request, const SampleChoice& samples) {
    if (!samples.is_auto) return std::nullopt;
    return request.sample_angle.value_or(default_angle);
}

BakeOptions bake_options_of(const MeshBakeRequest& request) {
    BakeOptions options;
    options.layers = layers_of(request.layers);
    options.width = request.size.x;
    options.height = request.size.y;
    options.placement.repeat = request.outside == OutsideChoice::repeat;
    options.space = request.space == SpaceChoice::tangent ? BakeSpace::tangent : BakeSpace::object;
    options.directions = request.directions.value_or(RayDirections::averaged);
    options.hardness = request.hardness.value_or(0.0);
    options.offset = request.offset;
    options.max_distance = request.max_distance;
    options.back_faces = request.back_faces;
    options.allow_size_mismatch = request.allow_size_mismatch;
    options.samples = request.samples.count;
    if (const auto angle = angle_of(request, request.samples))
        options.sample_angle = glm::radians(*angle);
    options.padding = request.padding;
    if (request.fills_to_border) {
        const std::filesystem::path folder = request.output.parent_path();
        options.border_folder = folder.empty() ? "." : folder;
    }
    return options;
}

}  // namespace relief::tools
