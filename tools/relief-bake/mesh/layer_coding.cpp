// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/layer_coding_test.cpp.
#include "mesh/layer_coding.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "parallel.h"

namespace relief::tools {
namespace {

constexpr std::size_t texels_at_once = 1 << 14;

/// One sample; says whether the number is beyond what its codes hold.
template <typename Sample>
Sample code_of(const LayerCoding& coding, float value, bool& is_beyond) {
    if constexpr (std::is_floating_point_v<Sample>) {
        return value;
    } else {
        constexpr double largest = std::numeric_limits<Sample>::max();
        double place = static_cast<double>(value);
        double least = 0.0;
        if (coding.has_sign()) {
            place /= coding.range;
            least = -1.0;
        }
        is_beyond = is_beyond || !(place >= least && place <= 1.0);
        // What is no number is 0.
        place = place >= least ? std::min(place, 1.0) : place < least ? least : 0.0;
        if (coding.has_sign()) {
            constexpr double middle = (largest + 1.0) / 2.0;
            return static_cast<Sample>(middle + std::round((middle - 1.0) * place));
        }
        if (coding.kind == LayerKind::color)
            place = static_cast<double>(srgb_from_linear(static_cast<float>(place)));
        return static_cast<Sample>(std::round(largest * place));
    }
}

template <typename Sample>
std::vector<std::byte> coded(std::span<const float> values, std::span<const TexelState> states,
                             const LayerCoding& coding, bool has_alpha, std::size_t first_texel,
                             Report& report) {
    const std::size_t channels = coding.channels();
    const std::size_t stride = channels + (has_alpha ? 1 : 0);
    std::vector<std::byte> bytes(states.size() * stride * sizeof(Sample));
    const auto put = [&](std::size_t index, Sample sample) {
        std::memcpy(&bytes[index * sizeof(Sample)], &sample, sizeof(Sample));
    };
    const Sample full =
        std::is_floating_point_v<Sample> ? Sample{1} : std::numeric_limits<Sample>::max();
    parallel_for_reporting(
        states.size(), texels_at_once, report,
        [&](std::size_t begin, std::size_t end, Report& found) {
            for (std::size_t i = begin; i < end; ++i) {
                bool is_beyond = false;
                for (std::size_t channel = 0; channel < channels; ++channel) {
                    put(i * stride + channel,
                        code_of<Sample>(coding, values[i * channels + channel], is_beyond));
                }
                if (is_beyond) {
                    found.add(layer_name(coding.kind) + " beyond what its file holds", "texel",
                              first_texel + i, "is stored as the end of the range");
                }
                if (!has_alpha) continue;
                const bool is_there =
                    states[i] == TexelState::baked || states[i] == TexelState::padded;
                put(i * stride + channels, is_there ? full : Sample{0});
            }
        });
    return bytes;
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

std::map<std::string, std::string> layer_metadata(const LayerCoding& coding) {
    std::map<std::string, std::string> metadata = {{"relief:content", layer_name(coding.kind)}};
    if (coding.bits == 32 || !coding.has_sign()) return metadata;
    metadata["relief:range"] = fmt::format("{}", coding.range);
    metadata["relief:zero"] = fmt::format("{}", coding.zero_code());
    return metadata;
}

std::vector<std::byte> coded_layer(std::span<const float> values,
                                   std::span<const TexelState> states, const LayerCoding& coding,
                                   bool has_alpha, std::size_t first_texel, Report& report) {
    if (coding.bits == 8)
        return coded<std::uint8_t>(values, states, coding, has_alpha, first_texel, report);
    if (coding.bits == 16)
        return coded<std::uint16_t>(values, states, coding, has_alpha, first_texel, report);
    return coded<float>(values, states, coding, has_alpha, first_texel, report);
}

}  // namespace relief::tools
