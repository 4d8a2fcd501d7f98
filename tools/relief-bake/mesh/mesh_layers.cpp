// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/relief_bake_mesh_layers_test.cpp.
#include "mesh/mesh_layers.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/text.h"
#include "relief/mesh/image_rows.h"

namespace relief::tools {
namespace {

std::span<const float> values_of(LayerKind kind, const BakedRows& rows) {
    switch (kind) {
        case LayerKind::height:
            return rows.heights;
        case LayerKind::occlusion:
            return rows.occlusion;
        case LayerKind::curvature:
            return rows.curvature;
        case LayerKind::position:
            return rows.positions;
        default:
            return rows.colors;
    }
}

double range_of(LayerKind kind, const LayerOptions& options, const LayerBounds& bounds) {
    switch (kind) {
        case LayerKind::height:
            return options.height_range.value_or(bounds.height);
        case LayerKind::curvature:
            // Outliers would leave few of 256 codes to the rest.
            return options.curvature_range.value_or(
                bits_of(options, kind) == 8 ? bounds.usual_curvature : bounds.curvature);
        case LayerKind::position:
            return options.position_range.value_or(bounds.position);
        default:
            return 1.0;
    }
}

/// As for the map; --half is for those that are .exr.
ImageWriteOptions write_options(const MapOutputOptions& map, const std::filesystem::path& file) {
    MapOutputOptions options = map;
    options.half = map.half && extension_of(file) == ".exr";
    return write_options_of(options, file);
}

}  // namespace

struct LayerWriters::Writer {
    WrittenLayer layer;
    ImageRowWriter rows;
};

std::vector<WrittenLayer> planned_layers(const MeshBakeRequest& request, const MapPlan& plan,
                                         const Baker& baker, const BakeLayers& layers) {
    std::vector<WrittenLayer> planned;
    if (request.layers.files.empty()) return planned;
    const LayerBounds bounds = baker.bounds(layers);
    for (const auto& [kind, file] : request.layers.files) {
        const double range = range_of(kind, request.layers, bounds);
        // Where all is 0, any range says so.
        const bool is_range = range > 0.0 && std::isfinite(range);
        planned.push_back(
            {plan.named(file), {kind, bits_of(request.layers, kind), is_range ? range : 1.0}});
    }
    return planned;
}

LayerWriters::LayerWriters(const MeshBakeRequest& request, const std::vector<WrittenLayer>& layers,
                           Report& report)
    : has_alpha_(request.background == Background::transparent), report_(report) {
    for (const WrittenLayer& layer : layers) {
        const ImageShape shape{request.size.x, request.size.y,
                               static_cast<int>(layer.coding.channels()) + (has_alpha_ ? 1 : 0),
                               layer.coding.bits, layer.coding.color_space()};
        writers_.push_back(std::make_unique<Writer>(
            Writer{layer, ImageRowWriter(layer.file, shape, layer_metadata(layer.coding),
                                         write_options(request.map, layer.file))}));
    }
}

LayerWriters::~LayerWriters() = default;

void LayerWriters::write(const BakedRows& rows) {
    const std::size_t width = rows.states.size() / static_cast<std::size_t>(rows.row_count);
    const std::size_t first = width * static_cast<std::size_t>(rows.first_row);
    for (const auto& writer : writers_) {
        writer->rows.write(coded_layer(values_of(writer->layer.coding.kind, rows), rows.states,
                                       writer->layer.coding, has_alpha_, first, report_));
    }
}

void LayerWriters::complete() {
    for (const auto& writer : writers_)
        writer->rows.complete(report_);
}

void LayerWriters::finish(const std::filesystem::path& map) {
    std::string done = map.string();
    for (const auto& writer : writers_) {
        try {
            writer->rows.finish(report_);
        } catch (const Error& error) {
            throw FileError(writer->layer.file,
                            fmt::format("{}; complete are {}", error.what(), done));
        }
        done += ", " + writer->layer.file.string();
    }
}

std::string layer_words(const WrittenLayer& layer) {
    const LayerCoding& coding = layer.coding;
    std::string words =
        fmt::format("{}: {}, {}", layer.file.string(), layer_name(coding.kind),
                    coding.bits == 32 ? "float" : fmt::format("{} bit", coding.bits));
    if (coding.bits == 32) return words;
    if (coding.has_sign()) words += fmt::format(", {:.6g} to {:.6g}", -coding.range, coding.range);
    if (coding.kind == LayerKind::color) words += ", sRGB";
    return words;
}

std::vector<std::string> height_use(const WrittenLayer& layer, double texel_size) {
    const LayerCoding& coding = layer.coding;
    std::vector<std::string> lines = {
        fmt::format("as a displacement: strength {:.7g}, midlevel {:.7g}", coding.strength(),
                    coding.midlevel())};
    if (texel_size > 0.0) {
        lines.push_back(fmt::format("for relief-bake bump: --height {:.7g} --texel-size {:.5g}",
                                    coding.strength(), texel_size));
    }
    return lines;
}

nlohmann::ordered_json layer_json(const WrittenLayer& layer) {
    const LayerCoding& coding = layer.coding;
    nlohmann::ordered_json json = {{"content", layer_name(coding.kind)},
                                   {"output", layer.file.string()},
                                   {"bits", coding.bits}};
    if (coding.bits != 32 && coding.has_sign()) {
        json["range"] = coding.range;
        json["zero"] = coding.zero_code();
    }
    if (coding.kind == LayerKind::height) {
        json["strength"] = coding.strength();
        json["midlevel"] = coding.midlevel();
    }
    return json;
}

double mean_texel_size(const Mesh& low, const glm::ivec2& size) {
    double area = 0.0, texels = 0.0;
    for (const glm::uvec3& corners : low.triangles) {
        const glm::dvec3 a(low.positions[corners.x]);
        const double here = glm::length(glm::cross(glm::dvec3(low.positions[corners.y]) - a,
                                                   glm::dvec3(low.positions[corners.z]) - a));
        const glm::dvec2 u = glm::dvec2(low.texcoords[corners.y] - low.texcoords[corners.x]);
        const glm::dvec2 v = glm::dvec2(low.texcoords[corners.z] - low.texcoords[corners.x]);
        const double covered = std::abs(u.x * v.y - u.y * v.x) * size.x * size.y;
        if (!std::isfinite(here) || !std::isfinite(covered)) continue;
        area += here;
        texels += covered;
    }
    return texels > 0.0 ? std::sqrt(area / texels) : 0.0;
}

}  // namespace relief::tools
