// SPDX-License-Identifier: Apache-2.0
#include "page_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include "relief/mesh/height_map.h"
#include "relief/shade/scene_variant.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// In codes. Half a code of x and y is more than a code of z where the normal leans by more than 45
/// degrees.
constexpr double max_z_error = 4.0;

template <typename Sample>
std::vector<std::uint8_t> packed(std::span<const Sample> samples, std::size_t row,
                                 std::size_t channels) {
    std::vector<std::uint8_t> bytes(samples.size() * sizeof(Sample));
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const bool is_first = i % row < channels;
        const auto difference =
            static_cast<unsigned>(samples[i] - (is_first ? 0 : samples[i - channels]));
        for (std::size_t byte = 0; byte < sizeof(Sample); ++byte)
            bytes[byte * samples.size() + i] = static_cast<std::uint8_t>(difference >> (8 * byte));
    }
    return bytes;
}

template <typename Sample>
std::vector<Sample> samples_of(const std::vector<std::byte>& bytes) {
    std::vector<Sample> samples(bytes.size() / sizeof(Sample));
    std::memcpy(samples.data(), bytes.data(), samples.size() * sizeof(Sample));
    return samples;
}

bool is_map_of_samples(const PageTexture& texture) {
    return texture.kind == PageTexture::Kind::map &&
           (texture.texels == PageTexels::bits_8 || texture.texels == PageTexels::bits_16);
}

/// The textures with samples whose sections nothing else uses, by section.
std::map<std::size_t, const PageTexture*> packable_textures(const PageDescription& page) {
    std::map<std::size_t, const PageTexture*> textures;
    std::set<std::size_t> others;
    const auto layout = [](const PageTexture& t) {
        return std::array<int, 4>{t.width, t.height, t.channels, static_cast<int>(t.texels)};
    };
    for (const PageTexture& texture : page.textures) {
        const auto [same, is_new] = textures.try_emplace(texture.section, &texture);
        if (!is_map_of_samples(texture) || layout(*same->second) != layout(texture))
            others.insert(texture.section);
    }
    for (const PageMesh& mesh : page.meshes) {
        others.insert(mesh.triangles);
        for (const PageStream& stream : mesh.streams)
            others.insert(stream.section);
    }
    std::erase_if(textures, [&](const auto& each) { return others.contains(each.first); });
    return textures;
}

/// A normal map and the conversion that makes it of the heights.
struct Converted {
    std::vector<std::uint16_t> samples;
    Json heights;
};

Json json_of(const BumpOptions& bump, const Image& image) {
    const GradientKernel kernel = gradient_kernel(*bump.kernel, bump.gaussian_radius);
    Json taps = Json::array();
    for (const HeightDifference& difference : kernel.differences)
        taps.push_back({difference.before, difference.after, difference.weight});
    const double largest = image.bits() == 8 ? 255.0 : 65535.0;
    const double scale = bump.strength / (kernel.divisor * largest);
    return {{"t", image.bits() == 8 ? "bits_8" : "bits_16"},
            {"taps", taps},
            {"lines", kernel.smoothing},
            {"wraps", {bump.wrap->x == Wrap::repeat, bump.wrap->y == Wrap::repeat}},
            {"scale", {scale / bump.texel.x, scale / bump.texel.y}}};
}

/// Returns the normal maps of heights of one integer channel, which the page computes by the rule
/// of libmesh/src/bump/bump.cpp for borders that repeat or continue.
std::vector<Converted> conversions(const std::optional<PageHeights>& heights) {
    std::vector<Converted> converted;
    if (!heights || heights->image.channels != 1 || heights->image.bits() > 16) return converted;
    const Image& image = heights->image;
    for (const BumpOptions& options : heights->conversions) {
        const BumpOptions bump = resolve_options(height_field(image), options);
        const int radius = gradient_kernel(*bump.kernel, bump.gaussian_radius).radius;
        if (bump.wrap->x == Wrap::mirror || bump.wrap->y == Wrap::mirror ||
            radius >= std::min(image.width, image.height))
            continue;
        Report same;
        const Image map = converted_heights(image, bump, 16, same);
        if (!same.findings().empty()) continue;
        const std::span<const std::uint16_t> codes = map.as<std::uint16_t>();
        converted.push_back({{codes.begin(), codes.end()}, json_of(bump, image)});
    }
    return converted;
}

std::vector<std::uint8_t> packed(const Image& image) {
    const auto row = static_cast<std::size_t>(image.width * image.channels);
    const auto channels = static_cast<std::size_t>(image.channels);
    return image.bits() == 8 ? packed_samples(image.as<std::uint8_t>(), row, channels)
                             : packed_samples(image.as<std::uint16_t>(), row, channels);
}

PackedImage packed_codes(const std::vector<std::uint16_t>& samples, const PageTexture& texture) {
    const auto channels = static_cast<std::size_t>(texture.channels);
    const auto width = static_cast<std::size_t>(texture.width);
    const std::optional<NormalCodes> normals =
        channels == 3 ? unit_normal_codes(samples) : std::nullopt;
    if (!normals) return {packed_samples(samples, width * channels, channels), Json::object()};
    std::vector<std::uint16_t> xy;
    for (std::size_t i = 0; i < samples.size(); i += 3)
        xy.insert(xy.end(), {samples[i], samples[i + 1]});
    return {packed_samples(xy, 2 * width, 2), {{"c", 2}, {"z", {normals->zero, normals->steps}}}};
}

}  // namespace

std::vector<std::uint8_t> packed_samples(std::span<const std::uint8_t> samples, std::size_t row,
                                         std::size_t channels) {
    return packed(samples, row, channels);
}

std::vector<std::uint8_t> packed_samples(std::span<const std::uint16_t> samples, std::size_t row,
                                         std::size_t channels) {
    return packed(samples, row, channels);
}

std::optional<NormalCodes> unit_normal_codes(std::span<const std::uint16_t> samples) {
    for (const NormalCodes codes : {NormalCodes{32768.0, 32767.0}, NormalCodes{32767.5, 32767.5}}) {
        bool is_unit = true;
        for (std::size_t i = 0; is_unit && i < samples.size(); i += 3) {
            const double x = (samples[i] - codes.zero) / codes.steps;
            const double y = (samples[i + 1] - codes.zero) / codes.steps;
            const double z = std::sqrt(std::max(1.0 - x * x - y * y, 0.0));
            is_unit = std::abs(codes.zero + codes.steps * z - samples[i + 2]) <= max_z_error;
        }
        if (is_unit) return codes;
    }
    return std::nullopt;
}

std::map<std::size_t, PackedImage> packed_images(const PageDescription& page,
                                                 const std::optional<PageHeights>& heights) {
    std::map<std::size_t, PackedImage> images;
    const std::vector<Converted> normals = conversions(heights);
    std::optional<std::size_t> place_of_heights;
    for (const auto& [section, texture] : packable_textures(page)) {
        const std::vector<std::byte>& bytes = page.sections[section];
        PackedImage& image = images[section];
        if (texture->texels == PageTexels::bits_8) {
            const auto channels = static_cast<std::size_t>(texture->channels);
            image = {packed_samples(samples_of<std::uint8_t>(bytes),
                                    channels * static_cast<std::size_t>(texture->width), channels),
                     Json::object()};
        } else {
            const std::vector<std::uint16_t> samples = samples_of<std::uint16_t>(bytes);
            const auto same =
                std::find_if(normals.begin(), normals.end(),
                             [&](const Converted& each) { return each.samples == samples; });
            if (same == normals.end()) {
                image = packed_codes(samples, *texture);
            } else {
                if (!place_of_heights) image.bytes = packed(heights->image);
                place_of_heights = place_of_heights.value_or(section);
                image.fields = {{"heights", same->heights}, {"d", *place_of_heights}};
            }
        }
        image.fields["packed"] = true;
    }
    return images;
}

}  // namespace relief::tools
