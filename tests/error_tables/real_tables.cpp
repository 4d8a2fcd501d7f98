// SPDX-License-Identifier: Apache-2.0
// Errors on real inputs, beside those on surfaces and maps with a formula: a model of folded cloth,
// a height map of terrain, and a normal map of rock.
#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string_view>

#include "error_tables/error_tables.h"
#include "experiment_parts.h"
#include "relief/accuracy/asset.h"
#include "relief/accuracy/bake_accuracy.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/bake_check.h"
#include "relief/mesh/block_compression.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/texture_file.h"
#include "relief/mesh/topology.h"
#include "support/shared_data.h"

namespace relief::test {
using namespace relief::accuracy;
using namespace relief::accuracy::detail;

namespace {

const std::vector<std::string> statistics = {"RMS", "99 %", "maximum"};

std::string cells_of(const ErrorStats& error) {
    return fmt::format(" {} | {} | {} |", in_digits(error.rms), in_digits(error.p99),
                       in_digits(error.max));
}

Mesh cloth() {
    return GltfDocument::read(shared_directory() / real_cloth).mesh({0, 0});
}

/// The experiment of a mesh whose id ends with `topic`.
const Experiment& experiment_of(const std::vector<AssetExperiment>& all, std::string_view topic) {
    for (const AssetExperiment& one : all) {
        if (one.experiment.id.ends_with(topic)) return one.experiment;
    }
    throw std::runtime_error(fmt::format("the mesh has no experiment {}", topic));
}

const std::vector<AssetExperiment>& cloth_experiments() {
    static const std::vector<AssetExperiment> all = [] {
        AssetOptions options;
        options.run.is_timed = false;
        options.file = "cloth";
        return measure_asset_mesh(cloth(), {}, options);
    }();
    return all;
}

std::string table_of(std::string_view topic) {
    std::string text = table_header(statistics);
    for (const Measurement& one : experiment_of(cloth_experiments(), topic).measurements)
        text += fmt::format("| {} |{}\n", one.method, cells_of(one.error));
    return text;
}

Image decoded_normals(const Image& level) {
    if (level.channels == 2) return decode_xy_map(level, {0, 1}, Green::up, FlatCode::half);
    return decode_normal_map(level, Green::up, FlatCode::half);
}

/// The angles between the normals of a map and their copies in a texture format.
ErrorStats error_in(const Image& normals, TextureFormat format, BlockQuality quality) {
    GpuTexture texture;
    texture.format = format;
    texture.width = normals.width;
    texture.height = normals.height;
    if (format == TextureFormat::bc5) {
        texture.levels.push_back(
            encode_normal_blocks(normals, {.format = BlockFormat::bc5, .quality = quality}));
    } else {
        const NormalMapFormat exact{.bits = 32, .green = Green::up, .flat = FlatCode::half};
        texture.levels.push_back(
            encode_texture_level(encode_normal_map(normals, exact), format, quality));
    }
    const Image stored = decoded_normals(decode_texture_level(texture, 0));
    return map_errors(stored, directions_of(normals));
}

}  // namespace

std::vector<PageSection> real_normal_table() {
    return {written_section("table of a real model", "\n" + table_of("/normals"))};
}

std::vector<PageSection> real_tangent_tables() {
    return {written_section(
        "table of a real model",
        "\nBetween averaged tangents and the gradient of the texture, in degrees\n\n" +
            table_of("/tangents") +
            "\nOf texels that are tilted by 30 degrees, if a map for MikkTSpace is read in another "
            "basis, in degrees\n\n" +
            table_of("/tangent-basis"))};
}

std::vector<PageSection> real_bump_table() {
    const Image heights = read_image(shared_directory() / real_heights, ImageUse::data);
    const KernelChoice choice = choose_kernel(heights, BumpOptions{});
    std::string text = "\n" + table_header({"RMS", "mean", "99 %", "maximum"});
    for (const KernelPrediction& one : choice.predictions) {
        std::string name = enum_name(one.kernel);
        if (one.kernel == Kernel::gaussian) name += fmt::format(" {}", one.gaussian_radius);
        text += fmt::format("| {} | {:.2g} | {:.2g} | {:.2g} | {:.2g} |\n", name, one.rms_degrees,
                            one.mean_degrees, one.p99_degrees, one.max_degrees);
    }
    return {written_section("table of a real map", text)};
}

std::vector<PageSection> real_bake_table() {
    const Mesh high = cloth();
    DecimateOptions decimate;
    decimate.triangles = 2000;
    const Mesh low = decimated(high, decimate).mesh;
    const Baker baker(std::span(&high, 1), low, {});
    BakeMapOptions map;
    map.width = map.height = 128;
    const BakeReference reference(baker, map, 128 * 128);
    std::vector<NormalMapFormat> formats(2);
    formats[0].bits = 8;
    formats[1].bits = 16;
    std::string text =
        "\n" + table_header({"8 bit: RMS", "99 %", "maximum", "16 bit: RMS", "99 %", "maximum"});
    for (const int samples : {1, 4, 16, 64}) {
        text += fmt::format("| `--samples {}` |", samples);
        for (const MeasuredBake& bake : measure_bake(reference, {samples, {}}, formats))
            text += cells_of(bake.error);
        text += "\n";
    }
    return {written_section("table of a real model", text)};
}

std::vector<PageSection> real_compression_table() {
    struct Code {
        const char* name;
        TextureFormat format;
        BlockQuality quality;
    };
    constexpr std::array codes = {Code{"bc5 fast", TextureFormat::bc5, BlockQuality::fast},
                                  Code{"bc5 normal", TextureFormat::bc5, BlockQuality::normal},
                                  Code{"bc5 best", TextureFormat::bc5, BlockQuality::best},
                                  Code{"bc7 fast", TextureFormat::bc7, BlockQuality::fast},
                                  Code{"bc7 normal", TextureFormat::bc7, BlockQuality::normal}};
    const Image map = read_image(shared_directory() / real_normals, ImageUse::data);
    const Image normals = decode_normal_map(map, Green::up, FlatCode::half);
    std::string text = "\n" + table_header({"mean", "99 %", "maximum"});
    for (const Code& code : codes) {
        const ErrorStats error = error_in(normals, code.format, code.quality);
        text += fmt::format("| {} | {} | {} | {} |\n", code.name, in_digits(error.mean),
                            in_digits(error.p99), in_digits(error.max));
    }
    return {written_section("table of a real map", text)};
}

}  // namespace relief::test
