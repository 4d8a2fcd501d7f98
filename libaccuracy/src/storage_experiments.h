// SPDX-License-Identifier: Apache-2.0
/// \file
/// Experiments on storage: unit normals of maps, and tangent frames of vertices, in few bits.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "experiment_driver.h"
#include "relief/accuracy/experiment.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/image.h"
#include "relief/mesh/statistics.h"

namespace relief::accuracy::detail {

/// The work that is timed.
enum class StorageWork { encode, decode };

/// Decodes the normals that were encoded: three float channels.
using NormalDecoder = std::function<Image()>;

/// A way to store the normals of a map, as texels or as blocks of GPUs: "xyz 8 bit, blue-noise". It
/// encodes three float channels with unit normals; dithering depends on the position of a texel.
/// The stored bytes are those of a texel in an existing texture format. The command has the
/// arguments of relief-bake convert that write this code.
using NormalCode = MethodOn<Image, NormalDecoder>;

/// The normals of a map after encoding and decoding.
inline Image stored(const NormalCode& code, const Image& normals) {
    return code.compute(normals)();
}

/// x, y, z in 8, 10 and 16 bits, half and float (stored as (n + 1) / 2); x and y alone; octahedral
/// in 2 x 8 to 2 x 16 bits, rounded to the nearest code of each coordinate or to the best of four;
/// and with dithering for the codes that relief dithers.
std::vector<NormalCode> normal_codes();

/// Rounds directions to float as the texels of a map. \throws InvalidInput if the rows are not full
Image image_of_normals(std::span<const glm::dvec3> directions, int width);

/// The normals of a smooth surface of waves, row by row, y up. Its slopes change by an 8-bit code
/// only every few texels, which is hard for codes.
std::vector<glm::dvec3> smooth_surface(int side);

/// The angles between sums of normals over squares of `block` texels and the exact sums, in
/// degrees. A mip level or the eye averages a patch in the same way.
/// \param ground_truth  of the same size; `block` divides it
ErrorStats patch_errors(const Image& normals, const Image& ground_truth, int block);

/// Frames before and after rounding to float; the error of float itself therefore counts.
struct SampleFrames {
    std::vector<glm::dvec3> normals;  ///< Unit.
    std::vector<glm::dvec3> tangents;
    std::vector<glm::vec3> float_normals;
    std::vector<glm::vec4> float_tangents;  ///< Alternately right- and left-handed.
};

/// Frames from equally many normals and tangents.
SampleFrames sample_frames(std::span<const glm::dvec3> normals,
                           std::span<const glm::dvec3> tangents);

/// Directions on a spiral of equal areas from (0, 0, 1) to (0, 0, -1).
std::vector<glm::dvec3> even_directions(std::size_t count);

/// Directions that are spread evenly over the half sphere above a surface, which a map in tangent
/// space can represent.
std::vector<glm::dvec3> upper_directions(std::size_t count);

/// Frames at even_directions(); the tangents rotate around the normals in another rhythm.
SampleFrames even_frames(std::size_t count);

/// Angles to the frames in double, in degrees.
struct FrameCodeErrors {
    ErrorStats normal;
    ErrorStats tangent;
    ErrorStats both;                 ///< Normals and tangents together.
    ErrorStats texel;                ///< Normals of texels tilted by 30 degrees.
    std::size_t flipped_frames = 0;  ///< Number of frames whose handedness changed.
};

/// Encodes and decodes frames, and computes their errors.
FrameCodeErrors frame_code_errors(const SampleFrames& ground_truth, FrameEncoding encoding,
                                  FrameRounding rounding);

/// The errors of decoded frames.
FrameCodeErrors frame_errors(const SampleFrames& ground_truth, const Frames& actual);

/// Every encoding with both rounding modes. The choices are the encoding and the rounding.
std::vector<Method> frame_methods(const std::shared_ptr<const SampleFrames>& frames,
                                  StorageWork work);

}  // namespace relief::accuracy::detail
