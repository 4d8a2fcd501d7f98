// SPDX-License-Identifier: Apache-2.0
// Encodes the layers of a bake for image files. Tests: tests/tools/relief_bake_layers_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "parallel.h"
#include "relief/mesh/bake.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Encodes alpha, which is linear in all layers.
template <typename Sample>
Sample alpha_code(float alpha) {
    if constexpr (std::is_floating_point_v<Sample>) return alpha;
    constexpr auto largest = static_cast<float>(std::numeric_limits<Sample>::max());
    return static_cast<Sample>(std::floor(std::clamp(alpha, 0.0F, 1.0F) * largest + 0.5F));
}

/// Codes of 8 bits for linear colors. srgb_from_linear() costs a power for each value, so only the
/// limits between codes come from it.
class SrgbCodes {
  public:
    SrgbCodes() {
        limits_.back() = std::numeric_limits<float>::infinity();
        for (std::size_t code = 1; code < code_count; ++code)
            limits_[code] = first_value_of(code);
        for (std::size_t cell = 0; cell < cells_.size(); ++cell)
            cells_[cell] = computed(static_cast<float>(cell) / cell_count);
    }

    /// \param linear  within [0, 1]
    [[nodiscard]] std::uint8_t code(float linear) const {
        const std::uint8_t code = cells_[static_cast<std::size_t>(linear * cell_count)];
        return linear >= limits_[code + 1U] ? static_cast<std::uint8_t>(code + 1) : code;
    }

  private:
    static constexpr std::size_t code_count = 256;
    /// The curve rises by at most 12.92 * 255 codes, so that a cell has at most one limit.
    static constexpr float cell_count = 4096.0F;

    static std::uint8_t computed(float linear) {
        constexpr double largest = code_count - 1;
        return static_cast<std::uint8_t>(
            std::round(largest * static_cast<double>(srgb_from_linear(linear))));
    }
    /// Positive floats have the order of their bits.
    static float first_value_of(std::size_t code) {
        std::uint32_t below = 0;
        auto end = std::bit_cast<std::uint32_t>(1.0F);
        while (end - below > 1) {
            const std::uint32_t middle = below + (end - below) / 2;
            (computed(std::bit_cast<float>(middle)) >= code ? end : below) = middle;
        }
        return std::bit_cast<float>(end);
    }

    std::array<float, code_count + 1> limits_{};  ///< By code: the first value that has it.
    std::array<std::uint8_t, static_cast<std::size_t>(cell_count) + 1> cells_{};
};

/// Encodes a value. \param is_outside  becomes true if the value is outside the range of the codes
template <typename Sample>
Sample encode_value(const LayerCoding& coding, float value, bool& is_outside) {
    if constexpr (std::is_floating_point_v<Sample>) {
        return value;
    } else {
        constexpr double largest = std::numeric_limits<Sample>::max();
        double place = static_cast<double>(value);
        double min = 0.0;
        if (coding.has_range()) place /= coding.range;
        if (coding.is_signed()) min = -1.0;
        is_outside = is_outside || !(place >= min && place <= 1.0);
        // NaN becomes 0.
        place = place >= min ? std::min(place, 1.0) : place < min ? min : 0.0;
        if (coding.is_signed()) {
            constexpr double middle = (largest + 1.0) / 2.0;
            return static_cast<Sample>(middle + std::round((middle - 1.0) * place));
        }
        if constexpr (std::is_same_v<Sample, std::uint8_t>) {
            static const SrgbCodes codes;
            if (coding.color_space() == ColorSpace::srgb)
                return codes.code(static_cast<float>(place));
        }
        if (coding.color_space() == ColorSpace::srgb)
            place = static_cast<double>(srgb_from_linear(static_cast<float>(place)));
        return static_cast<Sample>(std::round(largest * place));
    }
}

/// Returns the colors of ids, as codes within [0, 1]; black without an id.
std::vector<float> id_colors(std::span<const float> ids, const LayerCoding& coding) {
    std::vector<float> colors;
    colors.reserve(3 * ids.size());
    for (const float id : ids) {
        const glm::u8vec3 color =
            id >= 0.0F ? coding.ids.at(static_cast<std::size_t>(id)).color : glm::u8vec3(0);
        for (int channel = 0; channel < 3; ++channel)
            colors.push_back(static_cast<float>(color[channel]) / 255.0F);
    }
    return colors;
}

/// Appends alpha to texels of a normal map.
template <typename Sample>
std::vector<std::byte> normal_codes(const Image& map, std::span<const TexelState> states,
                                    bool has_alpha) {
    const std::span<const Sample> codes = map.as<Sample>();
    if (!has_alpha) {
        const std::span<const std::byte> bytes = std::as_bytes(codes);
        return {bytes.begin(), bytes.end()};
    }
    std::vector<Sample> all;
    all.reserve(4 * states.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
        all.insert(all.end(), &codes[3 * i], &codes[3 * i] + 3);
        const bool is_filled = states[i] == TexelState::baked || states[i] == TexelState::padded;
        all.push_back(alpha_code<Sample>(is_filled ? 1.0F : 0.0F));
    }
    const std::span<const std::byte> bytes = std::as_bytes(std::span(all));
    return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> encode_bent_normals(std::span<const float> values,
                                           std::span<const TexelState> states,
                                           const LayerCoding& coding, bool has_alpha,
                                           Report& report) {
    NormalMapFormat format = coding.normal_format;
    format.bits = coding.bits;
    format.dither = Dither::none;  // Dithering depends on the place in the map.
    const ImageView normals(values.data(), static_cast<int>(states.size()), 1, 3);
    const Image map = encode_normal_map(normals, format, report);
    if (coding.bits == 8) return normal_codes<std::uint8_t>(map, states, has_alpha);
    if (coding.bits == 16) return normal_codes<std::uint16_t>(map, states, has_alpha);
    return normal_codes<float>(map, states, has_alpha);
}

template <typename Sample>
std::vector<std::byte> encode(std::span<const float> values, std::span<const TexelState> states,
                              const LayerCoding& coding, bool has_alpha, std::size_t first_texel,
                              Report& report, std::span<const float> opacity) {
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
                    task_report.add(
                        std::string(enum_name(coding.kind)) + " outside the range of its file",
                        "texel", first_texel + i, "is clamped to the range");
                }
                if (!has_alpha) continue;
                const bool is_filled =
                    states[i] == TexelState::baked || states[i] == TexelState::padded;
                const float alpha = !is_filled ? 0.0F : opacity.empty() ? 1.0F : opacity[i];
                put(i * stride + channels, alpha_code<Sample>(alpha));
            }
        });
    return bytes;
}

MapKind kind_of(LayerKind kind) {
    switch (kind) {
        case LayerKind::height:
            return MapKind::height;
        case LayerKind::occlusion:
            return MapKind::occlusion;
        case LayerKind::curvature:
            return MapKind::curvature;
        case LayerKind::position:
            return MapKind::position;
        case LayerKind::surface:
            return MapKind::packed;
        case LayerKind::emission:
            return MapKind::emission;
        case LayerKind::bent_normal:
            return MapKind::bent_normal;
        case LayerKind::thickness:
            return MapKind::thickness;
        case LayerKind::id:
            return MapKind::id;
        case LayerKind::color:
            break;
    }
    return MapKind::color;
}

}  // namespace

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
        case LayerKind::surface:
            return rows.surface;
        case LayerKind::emission:
            return rows.emission;
        case LayerKind::bent_normal:
            return rows.bent_normals;
        case LayerKind::thickness:
            return rows.thickness;
        case LayerKind::id:
            return rows.ids;
        default:
            return rows.colors;
    }
}

ColorSpace LayerCoding::color_space() const {
    if (kind != LayerKind::color && kind != LayerKind::emission) return ColorSpace::data;
    return bits == 32 ? ColorSpace::linear : ColorSpace::srgb;
}

std::map<std::string, std::string> layer_metadata(const LayerCoding& coding,
                                                  std::optional<AlphaContent> alpha) {
    MapDescription description{
        .kind = kind_of(coding.kind), .color_space = coding.color_space(), .alpha = alpha};
    if (coding.kind == LayerKind::surface) description.detail = "gltf";
    if (coding.kind == LayerKind::bent_normal) {
        description.detail = std::string(enum_name(coding.space)) + " space";
        if (coding.space == VectorSpace::tangent) description.green = coding.normal_format.green;
        description.flat = coding.normal_format.flat;
    }
    std::map<std::string, std::string> metadata = write_description(description, coding.bits);
    for (const SurfaceId& id : coding.ids)
        metadata["relief:ids"] += fmt::format("{} {}\n", color_text(id), id.name);
    if (coding.bits == 32) return metadata;
    if (coding.has_range()) metadata["relief:range"] = fmt::format("{}", coding.range);
    if (coding.is_signed()) metadata["relief:zero"] = fmt::format("{}", coding.zero_code());
    return metadata;
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
                                    bool has_alpha, std::size_t first_texel, Report& report,
                                    std::span<const float> opacity) {
    if (states.empty()) return {};
    if (coding.kind == LayerKind::bent_normal)
        return encode_bent_normals(values, states, coding, has_alpha, report);
    std::vector<float> colors;
    if (coding.kind == LayerKind::id) {
        colors = id_colors(values, coding);
        values = colors;
    }
    if (coding.bits == 8) {
        return encode<std::uint8_t>(values, states, coding, has_alpha, first_texel, report,
                                    opacity);
    }
    if (coding.bits == 16) {
        return encode<std::uint16_t>(values, states, coding, has_alpha, first_texel, report,
                                     opacity);
    }
    return encode<float>(values, states, coding, has_alpha, first_texel, report, opacity);
}

}  // namespace relief
