// SPDX-License-Identifier: Apache-2.0
// Files to what the library measures. Tests: tests/tools/accuracy_own_test.cpp.
#include "own/own_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <set>

#include "common/findings.h"
#include "common/map_choices.h"
#include "common/map_models.h"
#include "common/model_file.h"
#include "common/normal_map_input.h"
#include "common/quoted.h"
#include "common/text.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bump_file.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/image_tags.h"
#include "relief/mesh/normal_map_check.h"

namespace relief::tools {
namespace {

constexpr int usual_map_size = 256;
constexpr std::size_t quick_triangles = std::size_t{1} << 17;
constexpr std::int64_t quick_texels = std::int64_t{1} << 18;

bool is_model(const std::filesystem::path& file) {
    constexpr std::array extensions = {".gltf", ".glb", ".obj", ".ply", ".stl", ".off"};
    const std::string own = extension_of(file);
    return std::find(extensions.begin(), extensions.end(), own) != extensions.end();
}

/// A model's triangles with the frames that the file holds; a primitive once.
Mesh read_own_mesh(const std::filesystem::path& file) {
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

std::vector<OwnExperiment> measure_mesh(const OwnInput& input, const OwnRequest& request,
                                        const OwnOptions& options, std::string& taken) {
    OwnMeshOptions how;
    how.truth = request.truth.value_or(NormalTruth::surface);
    if (request.crease_degrees) how.crease_angle = glm::radians(*request.crease_degrees);
    if (options.run.is_quick) how.most_triangles = quick_triangles;
    taken = "a mesh";
    return measure_own_mesh(read_own_mesh(input.file), how, options);
}

std::vector<OwnExperiment> measure_pair(const OwnInput& input, const OwnRequest& request,
                                        const OwnOptions& options, std::string& taken) {
    Report report;
    MapModel low = read_map_model(input.file, ModelSpace::world, report);
    require_texcoords(input.file, low, "no texture coordinates for a map to lie on",
                      "unwrap it first");
    MapModel high =
        about(*input.high, [&] { return read_map_model(*input.high, ModelSpace::world, report); });
    move_to(high, low.origin);
    const Mesh high_mesh = joined(std::move(high.parts));
    const Mesh low_mesh = joined(std::move(low.parts));
    const Baker baker(std::span(&high_mesh, 1), low_mesh, {}, report);
    const int size = request.size.value_or(usual_map_size);
    taken = fmt::format("a pair: a map of {0} x {0} is baked from {1}", size, input.high->string());
    return {measure_own_bake(baker, size, options)};
}

ImageKind kind_shown(const std::filesystem::path& file) {
    const ImageInfo info = read_image_info(file);
    if (info.channels < 3) return ImageKind::heights;
    // A part of it tells, and a large map takes long.
    const MapContent content =
        check_normal_map(read_image(file, ImageUse::data), info.metadata).content;
    return content == MapContent::grey || content == MapContent::other ? ImageKind::heights
                                                                       : ImageKind::normals;
}

/// Reports signs that an image is a picture and no height map: channels that differ, or an alpha
/// that varies.
void add_color_findings(const Image& image, Report& report) {
    // What JPEG makes of grey.
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
                           "their mean is taken for the height, which a photograph or a texture "
                           "of packed masks does not hold (--channel takes one of them)");
            }
        }
        if (channels % 2 == 0 &&
            std::abs(colors[channels - 1] - samples[channels - 1]) > tolerance) {
            report.add("texel whose alpha differs from the first one's", "texel", texel,
                       "alpha is left out (--channel alpha takes it for the height)");
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

/// Returns the findings on a height map; none for a map that is too large for memory.
std::vector<std::string> height_findings(const HeightMapFile& map, const OwnRequest& request) {
    Report report;
    if (!map.is_streamed()) {
        if (!request.channel && map.info().channels > 1)
            add_color_findings(read_image(map.path(), ImageUse::data), report);
        add_non_finite(map.map().heights, report);
    }
    Findings findings;
    findings.add("", report);
    return findings.lines();
}

std::vector<OwnExperiment> measure_heights(const OwnInput& input, const OwnRequest& request,
                                           OwnOptions options, std::string& taken) {
    const HeightMapFile map(input.file, {request.channel.value_or(HeightChannel::mean)});
    const int width = map.info().width;
    const int height = map.info().height;
    const BumpSampleParts parts = {
        parts_to_look_at(width, height),
        parts_to_measure(width, height, options.run.is_quick ? quick_texels : texels_to_measure)};
    const HeightMapFile::Survey survey = map.survey(parts.in_order());
    BumpOptions bump;
    bump.strength = request.strength.value_or(bump.strength);
    bump.wrap = request.wrap.value_or(WrapsOrAuto{}).value_or(survey.tiling.wraps());
    taken += fmt::format("a height map of {} bits, {:g} texels high, {} at the border",
                         map.info().bits, bump.strength, wrap_words(*bump.wrap));
    if (request.channel) {
        const std::string name = name_of(*request.channel, height_channel_choices());
        taken += fmt::format(", of its channel {}", name);
        options.height_arguments = " --channel " + name;
    }
    std::vector<OwnExperiment> all = {
        measure_own_heights(parts.sample(survey.parts), {width, height}, bump, options)};
    all.front().experiment.input_findings = height_findings(map, request);
    return all;
}

/// The extension of a format that relief-bake writes and that holds the same codes.
std::string lossless_extension(const std::filesystem::path& file, int bits) {
    const std::string own = extension_of(file);
    if (bits == 32) return own == ".tif" || own == ".tiff" ? own : ".exr";
    return own == ".tif" || own == ".tiff" ? own : ".png";
}

std::vector<OwnExperiment> measure_normals(const OwnInput& input, const OwnOptions& options,
                                           std::string& taken) {
    const InputMap map = read_normal_map(input.file, {});
    Report report;
    const Image normals =
        decode_normal_map(map.image, map.green.value_or(Green::up), map.flat, report);
    taken += fmt::format("a normal map of {} bits: {}", map.image.bits(), map.words);
    const NormalMapOnFile stored = {map.image.bits(), map.image.channels,
                                    lossless_extension(input.file, map.image.bits())};
    std::vector<OwnExperiment> all = {measure_own_normals(
        normals, stored, options, options.run.is_quick ? quick_texels : texels_to_measure)};
    Findings findings;
    findings.add("", report);
    all.front().experiment.input_findings = findings.lines();
    return all;
}

std::vector<OwnExperiment> measure_image(const OwnInput& input, const OwnRequest& request,
                                         const OwnOptions& options, std::string& taken) {
    const bool is_told = request.image_kind || request.channel;
    const ImageKind kind = request.image_kind ? *request.image_kind
                           : request.channel  ? ImageKind::heights
                                              : kind_shown(input.file);
    std::vector<OwnExperiment> all = kind == ImageKind::heights
                                         ? measure_heights(input, request, options, taken)
                                         : measure_normals(input, options, taken);
    if (!is_told)
        taken +=
            kind == ImageKind::heights ? " (else: --image normals)" : " (else: --image heights)";
    return all;
}

void check_effects(const OwnRequest& request, const std::vector<OwnInput>& inputs) {
    const auto any = [&](const auto& is_one) {
        return std::any_of(inputs.begin(), inputs.end(), is_one);
    };
    const bool meshes = any([](const OwnInput& one) { return !one.high && is_model(one.file); });
    const bool pairs = any([](const OwnInput& one) { return one.high.has_value(); });
    const bool images = any([](const OwnInput& one) { return !is_model(one.file); });
    const bool heights = images && request.image_kind != ImageKind::normals;
    const auto need = [](bool has, bool given, const char* option, const char* input) {
        if (given && !has)
            throw UsageError(fmt::format("{}: is for {}, and there is none", option, input));
    };
    need(meshes, request.truth.has_value(), "--truth", "meshes");
    need(meshes, request.crease_degrees.has_value(), "--crease", "meshes");
    need(pairs, request.size.has_value(), "--size", "a pair, --high and --low");
    need(images, request.image_kind.has_value(), "--image", "images");
    need(heights, request.strength.has_value(), "--strength", "height maps");
    need(heights, request.wrap.has_value(), "--wrap", "height maps");
    need(heights, request.channel.has_value(), "--channel", "height maps");
}

}  // namespace

std::vector<OwnInput> inputs_of(const OwnRequest& request) {
    if (request.high.has_value() != request.low.has_value())
        throw UsageError(request.high ? "--high: needs the other mesh of the pair"
                                      : "--low: needs the other mesh of the pair",
                         request.high ? "give --low FILE" : "give --high FILE");
    std::vector<OwnInput> inputs;
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
    if (inputs.empty())
        throw UsageError("nothing to measure on", "name a mesh, a map, or --high and --low");
    check_effects(request, inputs);
    return inputs;
}

std::string words_of(const OwnRequest& request) {
    std::string words;
    if (request.high) words += " --high " + quoted(*request.high);
    if (request.low) words += " --low " + quoted(*request.low);
    if (request.image_kind)
        words +=
            *request.image_kind == ImageKind::heights ? " --image heights" : " --image normals";
    if (request.truth)
        words += *request.truth == NormalTruth::file ? " --truth file" : " --truth surface";
    if (request.crease_degrees) words += fmt::format(" --crease {:g}", *request.crease_degrees);
    if (request.strength) words += fmt::format(" --strength {:g}", *request.strength);
    if (request.channel)
        words += " --channel " + name_of(*request.channel, height_channel_choices());
    if (request.wrap && request.wrap->is_settled())
        words += " --wrap " + wrap_words(request.wrap->value_or({}));
    if (request.size) words += fmt::format(" --size {}", *request.size);
    return words;
}

std::vector<OwnExperiment> measure(const OwnInput& input, const OwnRequest& request,
                                   OwnOptions options, std::string& taken) {
    options.file = input.name;
    options.arguments =
        input.high ? quoted(*input.high) + " " + quoted(input.file) : quoted(input.file);
    return about(input.file, [&] {
        if (input.high) return measure_pair(input, request, options, taken);
        if (is_model(input.file)) return measure_mesh(input, request, options, taken);
        return measure_image(input, request, options, taken);
    });
}

}  // namespace relief::tools
