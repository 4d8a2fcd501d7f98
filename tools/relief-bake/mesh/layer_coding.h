// SPDX-License-Identifier: Apache-2.0
/// \file
/// How numbers of a layer become samples of an image, and what the image says about it.
/// Tests: tests/tools/layer_coding_test.cpp.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "mesh/layer_options.h"
#include "relief/mesh/bake.h"
#include "relief/mesh/image.h"

namespace relief::tools {

/// Floats hold numbers as they are, colours linear. In 8 and 16 bits occlusion is code / 255 or
/// 65535, colours are sRGB, and the others, which have a sign, are range * (code - 128) / 127 or
/// range * (code - 32768) / 32767, so that 0 is exactly 0.
struct LayerCoding {
    LayerKind kind = LayerKind::height;
    int bits = 16;
    double range = 1.0;  ///< Of those with a sign, in integers.

    [[nodiscard]] bool has_sign() const {
        return kind != LayerKind::occlusion && kind != LayerKind::color;
    }
    [[nodiscard]] std::size_t channels() const {
        return kind == LayerKind::position || kind == LayerKind::color ? 3 : 1;
    }
    [[nodiscard]] ColorSpace color_space() const;

    /// The code of zero, where there is a range: 128 or 32768.
    [[nodiscard]] int zero_code() const { return bits == 8 ? 128 : 32768; }

    /// What a displacement by (value - midlevel) * strength takes, with values from 0 to 1.
    [[nodiscard]] double strength() const;
    [[nodiscard]] double midlevel() const;
};

/// "relief:content"; "relief:range" and "relief:zero" where they are, as above.
std::map<std::string, std::string> layer_metadata(const LayerCoding& coding);

/// The samples of some rows, with a channel more, full where there is something, if asked for.
///
/// \param values       of the layer
/// \param first_texel  of the map
/// \param report       counts numbers beyond the range, which are stored as its end
std::vector<std::byte> coded_layer(std::span<const float> values,
                                   std::span<const TexelState> states, const LayerCoding& coding,
                                   bool has_alpha, std::size_t first_texel, Report& report);

}  // namespace relief::tools
