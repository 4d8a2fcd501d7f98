// SPDX-License-Identifier: Apache-2.0
/// \file
/// What encodings of tangent frames err, on frames that are known in double; what the experiments
/// and the tables of docs/tangents.md measure. Tests: tests/accuracy/frame_codes_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "relief/mesh/angle_distribution.h"
#include "relief/mesh/frame_encoding.h"

namespace relief {

/// Frames before and after they are rounded to float, so that float's own error is seen too.
struct SampleFrames {
    std::vector<glm::dvec3> normals;  ///< Unit.
    std::vector<glm::dvec3> tangents;
    std::vector<glm::vec3> float_normals;
    std::vector<glm::vec4> float_tangents;  ///< Right- and left-handed by turns.
};

/// Frames of these normals and tangents, equally many.
SampleFrames sample_frames(std::span<const glm::dvec3> normals,
                           std::span<const glm::dvec3> tangents);

/// Directions on a spiral of equal areas, from (0, 0, 1) to (0, 0, -1).
std::vector<glm::dvec3> even_directions(std::size_t count);

/// Normals so; tangents turn as they go, in no step with it.
SampleFrames even_frames(std::size_t count);

/// In degrees from the frames in double.
struct FrameCodeErrors {
    AngleDistribution normal;
    AngleDistribution tangent;
    AngleDistribution both;      ///< Normals and tangents, all in one.
    AngleDistribution texel;     ///< The normals that texels tilted by 30 degrees stand for.
    std::size_t lost_hands = 0;  ///< Frames that came back with the other handedness.
};

/// What becomes of frames that are stored and read back.
FrameCodeErrors frame_code_errors(const SampleFrames& truth, FrameEncoding encoding,
                                  FrameRounding rounding);

/// The same of frames that have been read back, by whatever means.
FrameCodeErrors frame_errors(const SampleFrames& truth, const Frames& found);

}  // namespace relief
