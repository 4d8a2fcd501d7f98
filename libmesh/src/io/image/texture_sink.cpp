// SPDX-License-Identifier: Apache-2.0
// Writes KTX2 and DDS files by the interface of images: the rows of a map are collected, and
// encoded as the kind of map that the text entries state.
#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <utility>

#include "files.h"
#include "io/image/row_codec.h"
#include "io/image/texture_container.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/map_texture.h"
#include "relief/mesh/normal_map.h"

namespace relief::detail {
namespace {

/// Samples of normals are codes, or (n + 1) / 2 in float.
Image normals_of_map(const Image& map, const MapDescription& stated, Report& report) {
    const FlatCode flat = stated.flat.value_or(FlatCode::half);
    const Green green = stated.green.value_or(Green::up);
    return decode_normal_map(map, green, flat, report, FlatTexels::exact);
}

class TextureSink final : public RowSink {
  public:
    explicit TextureSink(const RowSinkPlan& plan)
        : plan_(plan), stated_(read_description(plan.metadata)) {
        const ImageShape& shape = plan_.shape;
        map_ = make_image(shape.width, shape.height, shape.channels, shape.bits, shape.color_space);
    }

    void write(const std::byte* rows, int count) override {
        const std::size_t size = static_cast<std::size_t>(count) * plan_.row_bytes();
        std::visit(
            [&](auto& samples) {
                std::memcpy(std::as_writable_bytes(std::span(samples)).data() + written_, rows,
                            size);
            },
            map_.samples);
        written_ += size;
    }

    void finish() override {
        MapTextureOptions options;
        options.kind = stated_.kind.value_or(MapKind::color);
        options.measured_texels = 0;
        options.green = stated_.green.value_or(Green::up);
        if (stated_.kind == MapKind::packed && stated_.detail == "unity") {
            options.roughness_channel = 3;
            options.is_smoothness = true;
        }
        const bool are_normals =
            options.kind == MapKind::normal || options.kind == MapKind::object_normal;
        if (are_normals) map_ = normals_of_map(map_, stated_, report_);
        MapTexture encoded = encode_map_texture(map_, options, nullptr, report_);
        map_ = Image{};
        // The entries of the map remain, except for those that the format changes.
        encoded.texture.metadata.erase("relief:content");
        encoded.texture.metadata.insert(plan_.metadata.begin(), plan_.metadata.end());
        const bool is_dds = lower_extension(plan_.file) == ".dds";
        const std::vector<std::byte> bytes =
            is_dds ? dds_bytes(encoded.texture) : ktx2_bytes(encoded.texture, {});
        std::ofstream stream(plan_.written, std::ios::binary);
        stream.write(reinterpret_cast<const char*>(bytes.data()),
                     static_cast<std::streamsize>(bytes.size()));
        stream.close();
        if (!stream) throw FileError(plan_.file, "cannot be written");
        if (is_dds) report_lost_entries(encoded.texture, report_);
    }

    void report(Report& report) const override { report.merge(report_); }

  private:
    RowSinkPlan plan_;
    MapDescription stated_;
    Image map_;
    std::size_t written_ = 0;
    Report report_;
};

}  // namespace

void check_texture_shape(const ImageShape& shape,
                         const std::map<std::string, std::string>& metadata) {
    const MapDescription stated = read_description(metadata);
    if (!stated.kind) throw InvalidInput("a texture needs the kind of its map (relief:content)");
    const MapTextureKind* const kind = find_map_texture_kind(*stated.kind);
    if (kind == nullptr) {
        throw InvalidInput(
            fmt::format("{} is not stored in textures", map_kind_info(*stated.kind).phrase));
    }
    const bool may_have_alpha =
        kind->filter == MipFilter::packed || kind->filter == MipFilter::colors;
    if (shape.channels == kind->channels ||
        (may_have_alpha && shape.channels == kind->channels + 1))
        return;
    throw InvalidInput(fmt::format("a texture of {} has {} channels, not {}",
                                   map_kind_info(*stated.kind).phrase, kind->channels,
                                   shape.channels));
}

std::unique_ptr<RowSink> make_texture_sink(const RowSinkPlan& plan) {
    return std::make_unique<TextureSink>(plan);
}

}  // namespace relief::detail
