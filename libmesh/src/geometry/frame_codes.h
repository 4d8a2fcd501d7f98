// SPDX-License-Identifier: Apache-2.0
/// \file
/// Encoding of one tangent frame in each format. frame_encoding.h documents the bit layouts.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "relief/mesh/frame_encoding.h"

namespace relief {

/// Unit, perpendicular, handed.
struct SoundFrame {
    glm::dvec3 normal{0.0, 0.0, 1.0};
    glm::dvec3 tangent{1.0, 0.0, 0.0};
    bool mirrored = false;  ///< w = -1.
};

/// Returns the orthonormal frame for a normal and a tangent. Deviations are counted under `index`.
SoundFrame sound_frame(const glm::vec3& normal, const glm::vec4& tangent, std::size_t index,
                       Report& found);

/// \param words  array of words_per_frame() words
void encode_frame(const SoundFrame& frame, FrameEncoding encoding, FrameRounding rounding,
                  std::uint32_t* words);

/// \param words  array of words_per_frame() words
SoundFrame decode_frame(const std::uint32_t* words, FrameEncoding encoding, std::size_t index,
                        Report& found);

}  // namespace relief
