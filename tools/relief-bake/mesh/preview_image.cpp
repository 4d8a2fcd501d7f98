// SPDX-License-Identifier: Apache-2.0
// A large map is read by rows, and only its means are kept. Tests:
// tests/tools/mesh_preview_test.cpp.
#include <algorithm>
#include <cstddef>

#include "mesh/mesh_preview.h"
#include "relief/mesh/image_rows.h"

namespace relief::tools {
namespace {

/// The next rows of a map as normals.
Image next_rows(ImageRowReader& reader, int rows, const NormalMapFormat& format) {
    const ImageInfo& info = reader.info();
    Image band = make_image(info.width, rows, info.channels, info.bits, ColorSpace::data);
    std::visit([&](auto& samples) { reader.read(std::as_writable_bytes(std::span(samples))); },
               band.samples);
    Report unused;  // The map is relief's own: every texel is a normal.
    return decode_normal_map(band, format.green, format.flat, unused);
}

/// Adds a band, of `factor` rows or fewer, to the row of means that it belongs to.
void add(std::span<const float> band, int width, int factor, std::span<float> means) {
    const std::size_t texels = band.size() / 3;
    for (std::size_t i = 0; i < texels; ++i) {
        const std::size_t x = i % static_cast<std::size_t>(width);
        for (std::size_t channel = 0; channel < 3; ++channel)
            means[3 * (x / static_cast<std::size_t>(factor)) + channel] += band[3 * i + channel];
    }
}

}  // namespace

ImageSource preview_image(const std::filesystem::path& map, const NormalMapFormat& format,
                          int most) {
    ImageRowReader reader(map);
    const int width = reader.info().width;
    const int height = reader.info().height;
    const int factor = (std::max(width, height) + most - 1) / most;
    if (factor <= 1) return {.name = map.string(), .source = map, .is_required = true};
    // What is left over at the right and at the bottom becomes texels of their own: the map ends a
    // little further out then, by less than a texel of the smaller one.
    Image means = make_image((width + factor - 1) / factor, (height + factor - 1) / factor, 3, 32,
                             ColorSpace::data);
    const std::span<float> all = means.as<float>();
    const std::size_t row = 3 * static_cast<std::size_t>(means.width);
    for (int y = 0; y < means.height; ++y) {
        const Image band = next_rows(reader, std::min(factor, height - y * factor), format);
        add(band.as<float>(), width, factor, all.subspan(static_cast<std::size_t>(y) * row, row));
    }
    Report unused;  // Where normals cancel out, flat is as good as any.
    return {map.string(), encode_normal_map(means, {.bits = 32}, unused)};
}

}  // namespace relief::tools
