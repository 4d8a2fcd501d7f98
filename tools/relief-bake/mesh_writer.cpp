// SPDX-License-Identifier: Apache-2.0
// Encodes rows of normals and layers and writes them to the files of one map, so that no image is
// in memory as a whole. Tests: tests/tools/relief_bake_layers_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "common/text.h"
#include "mesh_bake.h"
#include "parallel.h"
#include "relief/mesh/image_file.h"

namespace relief::tools {
namespace {

/// Full alpha.
template <typename Sample>
constexpr Sample full_sample = std::is_floating_point_v<Sample>
                                   ? Sample{1}
                                   : std::numeric_limits<Sample>::max();

/// Encodes a value, and tells whether it is outside the range of the codes.
template <typename Sample>
Sample encode_value(const LayerCoding& coding, float value, bool& is_outside) {
    if constexpr (std::is_floating_point_v<Sample>) {
        return value;
    } else {
        constexpr double largest = std::numeric_limits<Sample>::max();
        double place = static_cast<double>(value);
        double min = 0.0;
        if (coding.is_signed()) {
            place /= coding.range;
            min = -1.0;
        }
        is_outside = is_outside || !(place >= min && place <= 1.0);
        // NaN becomes 0.
        place = place >= min ? std::min(place, 1.0) : place < min ? min : 0.0;
        if (coding.is_signed()) {
            constexpr double middle = (largest + 1.0) / 2.0;
            return static_cast<Sample>(middle + std::round((middle - 1.0) * place));
        }
        if (coding.kind == LayerKind::color)
            place = static_cast<double>(srgb_from_linear(static_cast<float>(place)));
        return static_cast<Sample>(std::round(largest * place));
    }
}

template <typename Sample>
std::vector<std::byte> encode(std::span<const float> values, std::span<const TexelState> states,
                              const LayerCoding& coding, bool has_alpha, std::size_t first_texel,
                              Report& report) {
    constexpr std::size_t texels_per_task = 1 << 14;
    const std::size_t channels = coding.channels();
    const std::size_t stride = channels + (has_alpha ? 1 : 0);
    std::vector<std::byte> bytes(states.size() * stride * sizeof(Sample));
    const auto put = [&](std::size_t index, Sample sample) {
        std::memcpy(&bytes[index * sizeof(Sample)], &sample, sizeof(Sample));
    };
    parallel_for_reporting(
        states.size(), texels_per_task, report,
        [&](std::size_t begin, std::size_t end, Report& task_report) {
            for (std::size_t i = begin; i < end; ++i) {
                bool is_outside = false;
                for (std::size_t channel = 0; channel < channels; ++channel) {
                    put(i * stride + channel,
                        encode_value<Sample>(coding, values[i * channels + channel], is_outside));
                }
                if (is_outside) {
                    task_report.add(layer_name(coding.kind) + " outside the range of its file",
                                    "texel", first_texel + i, "is clamped to the range");
                }
                if (!has_alpha) continue;
                const bool is_filled =
                    states[i] == TexelState::baked || states[i] == TexelState::padded;
                put(i * stride + channels, is_filled ? full_sample<Sample> : Sample{0});
            }
        });
    return bytes;
}

std::span<const float> layer_values(LayerKind kind, const BakedRows& rows) {
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

double layer_range(LayerKind kind, const LayerOptions& options, const LayerBounds& bounds) {
    switch (kind) {
        case LayerKind::height:
            return options.height_range.value_or(bounds.height);
        case LayerKind::curvature:
            // Outliers would leave few of 256 codes for the other values.
            return options.curvature_range.value_or(
                bits_of(options, kind) == 8 ? bounds.curvature_p99 : bounds.curvature);
        case LayerKind::position:
            return options.position_range.value_or(bounds.position);
        default:
            return 1.0;
    }
}

std::map<std::string, std::string> layer_metadata(const LayerCoding& coding) {
    std::map<std::string, std::string> metadata = {{"relief:content", layer_name(coding.kind)}};
    if (coding.bits == 32 || !coding.is_signed()) return metadata;
    metadata["relief:range"] = fmt::format("{}", coding.range);
    metadata["relief:zero"] = fmt::format("{}", coding.zero_code());
    return metadata;
}

std::map<std::string, std::string> map_metadata(const MeshBakeRequest& request, const MapPlan& plan,
                                                const NormalMapFormat& format) {
    std::map<std::string, std::string> metadata = normal_map_metadata(format);
    metadata.merge(bake_metadata(request, plan));
    if (request.space == SpaceChoice::object)
        metadata["relief:content"] = "normal map, object space";
    if (request.space == SpaceChoice::world) metadata["relief:content"] = "normal map, world space";
    return metadata;
}

/// The options of the map; --half applies only to layers in .exr files.
ImageWriteOptions layer_write_options(const MapOutputOptions& map,
                                      const std::filesystem::path& file) {
    MapOutputOptions options = map;
    options.half = map.half && extension_of(file) == ".exr";
    return write_options_of(options, file);
}

/// Appends an alpha channel: 1 in baked texels, and in padded ones if they count.
template <typename Sample>
std::vector<Sample> append_alpha(std::span<const Sample> codes, std::span<const TexelState> states,
                                 bool has_padding) {
    std::vector<Sample> result(4 * states.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
        std::copy_n(&codes[3 * i], 3, &result[4 * i]);
        const bool is_filled =
            states[i] == TexelState::baked || (has_padding && states[i] == TexelState::padded);
        result[4 * i + 3] = is_filled ? full_sample<Sample> : Sample{0};
    }
    return result;
}

}  // namespace

ColorSpace LayerCoding::color_space() const {
    if (kind != LayerKind::color) return ColorSpace::data;
    return bits == 32 ? ColorSpace::linear : ColorSpace::srgb;
}

double LayerCoding::strength() const {
    if (bits == 32) return 1.0;
    const double largest = bits == 8 ? 255.0 : 65535.0;
    return range * largest / (zero_code() - 1);
}

double LayerCoding::midlevel() const {
    if (bits == 32) return 0.0;
    return zero_code() / (bits == 8 ? 255.0 : 65535.0);
}

std::vector<std::byte> encode_layer(std::span<const float> values,
                                    std::span<const TexelState> states, const LayerCoding& coding,
                                    bool has_alpha, std::size_t first_texel, Report& report) {
    if (coding.bits == 8)
        return encode<std::uint8_t>(values, states, coding, has_alpha, first_texel, report);
    if (coding.bits == 16)
        return encode<std::uint16_t>(values, states, coding, has_alpha, first_texel, report);
    return encode<float>(values, states, coding, has_alpha, first_texel, report);
}

std::vector<WrittenLayer> planned_layers(const MeshBakeRequest& request, const MapPlan& plan,
                                         const Baker& baker, const BakeLayers& layers) {
    std::vector<WrittenLayer> planned;
    if (request.layers.files.empty()) return planned;
    const LayerBounds bounds = baker.bounds(layers);
    for (const auto& [kind, file] : request.layers.files) {
        const double range = layer_range(kind, request.layers, bounds);
        // If all values are 0, any range stores them.
        const bool is_usable = range > 0.0 && std::isfinite(range);
        planned.push_back(
            {plan.named(file), {kind, bits_of(request.layers, kind), is_usable ? range : 1.0}});
    }
    return planned;
}

struct MapWriter::Files {
    struct LayerFile {
        WrittenLayer layer;
        ImageRowWriter rows;
    };

    NormalMapFormat format;
    bool has_alpha, padding_is_opaque;
    Report& report;
    std::filesystem::path map;
    ImageRowWriter normals;
    std::vector<std::unique_ptr<LayerFile>> layers;

    void write_normals(const BakedRows& rows) {
        Image image;
        image.width =
            static_cast<int>(rows.states.size() / static_cast<std::size_t>(rows.row_count));
        image.height = rows.row_count;
        image.channels = 3;
        image.color_space = ColorSpace::data;
        image.samples = std::vector<float>(rows.normals.begin(), rows.normals.end());
        // Row counts are multiples of the dither tile, so that its pattern continues.
        const Image codes = encode_normal_map(image, format, report);
        std::visit(
            [&]<typename Sample>(const std::vector<Sample>& samples) {
                if (!has_alpha) return normals.write(std::as_bytes(std::span(samples)));
                const std::vector<Sample> all =
                    append_alpha(std::span(samples), rows.states, padding_is_opaque);
                normals.write(std::as_bytes(std::span(all)));
            },
            codes.samples);
    }

    void write_layers(const BakedRows& rows) {
        const std::size_t width = rows.states.size() / static_cast<std::size_t>(rows.row_count);
        const std::size_t first = width * static_cast<std::size_t>(rows.first_row);
        for (const auto& file : layers) {
            const LayerCoding& coding = file->layer.coding;
            file->rows.write(encode_layer(layer_values(coding.kind, rows), rows.states, coding,
                                          has_alpha, first, report));
        }
    }
};

MapWriter::MapWriter(const MeshBakeRequest& request, const MapPlan& plan,
                     const NormalMapFormat& format, const std::vector<WrittenLayer>& layers,
                     Report& report) {
    const bool has_alpha = request.background == Background::transparent;
    const ImageShape shape{request.size.x, request.size.y, has_alpha ? 4 : 3, format.bits,
                           ColorSpace::data};
    files_ = std::make_unique<Files>(
        Files{format,
              has_alpha,
              !request.fills_to_border,
              report,
              plan.output,
              ImageRowWriter(plan.output, shape, map_metadata(request, plan, format),
                             write_options_of(request.map, plan.output)),
              {}});
    for (const WrittenLayer& layer : layers) {
        const ImageShape layer_shape{
            request.size.x, request.size.y,
            static_cast<int>(layer.coding.channels()) + (has_alpha ? 1 : 0), layer.coding.bits,
            layer.coding.color_space()};
        files_->layers.push_back(std::make_unique<Files::LayerFile>(Files::LayerFile{
            layer, ImageRowWriter(layer.file, layer_shape, layer_metadata(layer.coding),
                                  layer_write_options(request.map, layer.file))}));
    }
}

MapWriter::~MapWriter() = default;

void MapWriter::write(const BakedRows& rows) {
    files_->write_normals(rows);
    files_->write_layers(rows);
}

void MapWriter::complete() {
    files_->normals.complete(files_->report);
    for (const auto& file : files_->layers)
        file->rows.complete(files_->report);
}

void MapWriter::finish() {
    files_->normals.finish(files_->report);
    std::string finished = files_->map.string();
    for (const auto& file : files_->layers) {
        try {
            file->rows.finish(files_->report);
        } catch (const Error& error) {
            throw FileError(file->layer.file,
                            fmt::format("{}; complete are {}", error.what(), finished));
        }
        finished += ", " + file->layer.file.string();
    }
}

}  // namespace relief::tools
