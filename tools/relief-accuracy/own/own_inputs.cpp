// SPDX-License-Identifier: Apache-2.0
// Files to what the library measures. Tests: tests/tools/accuracy_own_test.cpp.
#include "own/own_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/trigonometric.hpp>
#include <set>

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

std::vector<OwnExperiment> measure_heights(const OwnInput& input, const OwnRequest& request,
                                           const OwnOptions& options, std::string& taken) {
    const HeightMapFile map(input.file);
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
    return {measure_own_heights(parts.sample(survey.parts), {width, height}, bump, options)};
}

std::vector<OwnExperiment> measure_normals(const OwnInput& input, const OwnOptions& options,
                                           std::string& taken) {
    const InputMap map = read_normal_map(input.file, {});
    Report report;
    const Image normals =
        decode_normal_map(map.image, map.green.value_or(Green::up), map.flat, report);
    taken += fmt::format("a normal map of {} bits: {}", map.image.bits(), map.words);
    return {measure_own_normals(normals, map.image.bits(), options,
                                options.run.is_quick ? quick_texels : texels_to_measure)};
}

std::vector<OwnExperiment> measure_image(const OwnInput& input, const OwnRequest& request,
                                         const OwnOptions& options, std::string& taken) {
    const ImageKind kind = request.image_kind ? *request.image_kind : kind_shown(input.file);
    std::vector<OwnExperiment> all = kind == ImageKind::heights
                                         ? measure_heights(input, request, options, taken)
                                         : measure_normals(input, options, taken);
    if (!request.image_kind)
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
