// SPDX-License-Identifier: Apache-2.0
/// \file
/// One tangent frame to the words of each encoding and back; see frame_encoding.h for the layouts.
/// Tests: tests/mesh/geometry/encoding/frame_encoding_test.cpp.
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

/// The frame that a normal and a tangent are meant to be; what is amiss is counted under `index`.
SoundFrame sound_frame(const glm::vec3& normal, const glm::vec4& tangent, std::size_t index,
                       Report& found);

/// \param words  words_per_frame() of them
void encode_frame(const SoundFrame& frame, FrameEncoding encoding, FrameRounding rounding,
                  std::uint32_t* words);

/// \param words  words_per_frame() of them
SoundFrame decode_frame(const std::uint32_t* words, FrameEncoding encoding, std::size_t index,
                        Report& found);

}  // namespace relief
