// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_bake_mesh_layers_test.cpp.
#include "mesh/layer_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/options.h"
#include "common/text.h"

namespace relief::tools {
namespace {

struct LayerWords {
    LayerKind kind;
    const char* option;
    const char* name;
    const char* description;
};

constexpr LayerWords all_words[] = {
    {LayerKind::height, "--height-map", "height map",
     "Write how far outside of the low mesh the surface lies, along the ray, in its unit."},
    {LayerKind::occlusion, "--occlusion-map", "ambient occlusion",
     "Write how much of the surroundings the surface sees: 1 where nothing of the high meshes is "
     "in the way."},
    {LayerKind::curvature, "--curvature-map", "curvature",
     "Write the mean curvature of the high meshes, over their unit: positive where they bulge, "
     "1/r on a sphere."},
    {LayerKind::position, "--position-map", "positions",
     "Write where rays have met the surface, in the world."},
    {LayerKind::color, "--color-map", "colours",
     "Write the colour of the high meshes: of vertices, materials and textures, multiplied."},
};

const LayerWords& words_of(LayerKind kind) {
    return *std::find_if(std::begin(all_words), std::end(all_words),
                         [&](const LayerWords& words) { return words.kind == kind; });
}

int usual_bits(LayerKind kind, const std::vector<int>& depths) {
    const bool has_bytes = std::find(depths.begin(), depths.end(), 8) != depths.end();
    return kind == LayerKind::color && has_bytes ? 8 : depths.front();
}

/// An option that is for one layer's file in integers.
void check_range(const LayerOptions& options, LayerKind kind, const std::optional<double>& range,
                 const char* option) {
    if (!range) return;
    if (!options.files.contains(kind))
        throw UsageError(
            fmt::format("{}: has no effect without {}", option, words_of(kind).option));
    if (bits_of(options, kind) == 32)
        throw UsageError(
            fmt::format("{}: has no effect on floats, which hold all numbers", option));
}

void add_numbers(CLI::App& app, LayerOptions& options, const std::string& group) {
    add_choice(app, "--layer-bits", options.bits, Choices<int>{{"8", 8}, {"16", 16}, {"32", 32}},
               "Bits per channel of these files: 8 or 16 for .png, 8, 16 or 32 (float) for .tif, "
               "32 for .exr. Default: 16, 8 for colours, and 32 for .exr.")
        .group(group);
    const Range above{1e-30, 1e30, ""};
    add_number(app, "--height-range", "H", options.height_range, above,
               "Which height is white in 8 and 16 bits; -H is black, 0 is the middle code exactly. "
               "Default: how far rays reach.")
        .group(group);
    add_number(app, "--curvature-range", "C", options.curvature_range, above,
               "Which curvature is white, likewise. Default: the largest; in 8 bits what 99% of "
               "the high meshes do not exceed.")
        .group(group);
    add_number(app, "--position-range", "P", options.position_range, above,
               "Which coordinate is white, likewise. Default: the largest of the high meshes.")
        .group(group);
    add_value(app, "--occlusion-rays", "N",
              "Rays for each texel, shared by its samples: 1 to 65536; twice as many have 0.6 of "
              "the error. Default: 64.",
              [&options](const std::string& subject, const std::string& text) {
                  options.occlusion_rays = parse_integer(subject, text, 1, 65536);
              })
        .group(group);
    add_number(app, "--occlusion-distance", "D", options.occlusion_distance, {0.0, 1e30, ""},
               "What is further away than this hides nothing. Default: half of the longest side of "
               "the high meshes' box.")
        .group(group);
}

}  // namespace

std::string layer_name(LayerKind kind) {
    return words_of(kind).name;
}

void add_layer_options(CLI::App& app, LayerOptions& options) {
    const std::string group = "Other layers, from the same rays";
    for (const LayerWords& words : all_words) {
        add_value(app, words.option, "FILE", words.description,
                  [&options, kind = words.kind](const std::string&, const std::string& text) {
                      options.files[kind] = text;
                  })
            .group(group);
    }
    add_numbers(app, options, group);
}

int bits_of(const LayerOptions& options, LayerKind kind) {
    const std::filesystem::path& file = options.files.at(kind);
    const std::vector<int> depths = depths_of(file);
    if (depths.empty()) {
        throw UsageError(
            fmt::format("{} {}: no format for it", words_of(kind).option, file.string()),
            "use .png, .tif or .exr");
    }
    const int bits = options.bits.value_or(usual_bits(kind, depths));
    if (std::find(depths.begin(), depths.end(), bits) == depths.end()) {
        throw UsageError(fmt::format("--layer-bits {}: {} holds {} bits", bits, extension_of(file),
                                     fmt::join(depths, " or ")));
    }
    return bits;
}

void check_layer_options(const LayerOptions& options) {
    for (const auto& [kind, file] : options.files)
        bits_of(options, kind);
    if (options.bits && options.files.empty())
        throw UsageError("--layer-bits: has no effect without a layer's file");
    check_range(options, LayerKind::height, options.height_range, "--height-range");
    check_range(options, LayerKind::curvature, options.curvature_range, "--curvature-range");
    check_range(options, LayerKind::position, options.position_range, "--position-range");
    if ((options.occlusion_rays || options.occlusion_distance) &&
        !options.files.contains(LayerKind::occlusion)) {
        throw UsageError(
            "--occlusion-rays, --occlusion-distance: have no effect without --occlusion-map");
    }
}

BakeLayers layers_of(const LayerOptions& options) {
    BakeLayers layers;
    layers.heights = options.files.contains(LayerKind::height);
    layers.curvature = options.files.contains(LayerKind::curvature);
    layers.positions = options.files.contains(LayerKind::position);
    layers.colors = options.files.contains(LayerKind::color);
    if (options.files.contains(LayerKind::occlusion)) {
        layers.occlusion.emplace();
        layers.occlusion->rays = options.occlusion_rays.value_or(layers.occlusion->rays);
        layers.occlusion->distance = options.occlusion_distance;
    }
    return layers;
}

}  // namespace relief::tools
