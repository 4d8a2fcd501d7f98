// SPDX-License-Identifier: Apache-2.0
/// \file
/// Tangent frames in few bits, for vertex buffers and files, and back. docs/tangents.md has what
/// each encoding costs and errs, and shaders that decode them.
/// Tests: tests/mesh/geometry/encoding/frame_encoding_test.cpp,
/// tests/shade/gl/frame_decoding_test.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "relief/mesh/direction_error.h"
#include "relief/mesh/report.h"

namespace relief {

/// How a frame is laid out, in 32-bit words whose bit 0 is the lowest: on little-endian machines
/// the words lie in memory as vertex formats of the same layout do.
///
/// *Components* are signed, in two's complement: c stands for c / M with M = 2^(bits - 1) - 1, and
/// the lowest code, -M - 1, for -1 too. *Octahedral* is a unit vector's place (x, y) on an
/// octahedron that is unfolded into a square: z = M - |x| - |y|, and where that is negative, x and
/// y become (M - |y|) sign(x) and (M - |x|) sign(y), with sign(0) = 1 [Cigolle et al. 2014].
/// *w* is the handedness.
enum class FrameEncoding {
    /// 7 words: normal x y z, tangent x y z w, all IEEE floats.
    float32,
    /// 1 word. Bits 0-7 and 8-15: octahedral normal; 16-23 and 24-31: octahedral tangent, whose y
    /// is odd where w = -1 and even where w = 1.
    octahedral8,
    /// 2 words, as GL_INT_2_10_10_10_REV. Word 0, bits 0-9 and 10-19: octahedral normal. Word 1,
    /// 0-9 and 10-19: octahedral tangent; 30-31: w. The rest, 0, is free for others to use.
    octahedral10,
    /// 2 words. Word 0, bits 0-15 and 16-31: octahedral normal; word 1: octahedral tangent, whose y
    /// is odd where w = -1 and even where w = 1.
    octahedral16,
    /// 1 word of x, y, z, w, 8 bits each: the quaternion that turns the x axis to the tangent and
    /// the z axis to the normal, all of it times w. Its last component is never 0, so that its sign
    /// is that of w [Frey and Herzeg 2011].
    quaternion8,
    /// 2 words: the same, 16 bits each.
    quaternion16,
    /// 1 word. Bits 0-9 and 10-19: octahedral normal; 20-30: the tangent's direction in the plane
    /// of the normal *as decoded*; 31: set where w = -1. The direction is a place on the diamond
    /// |a| + |b| = 1, once around from 0 to 2^11 [Ong 2023], a and b along the axes that
    /// [Duff et al. 2017] derive from the normal.
    angle10,
    /// 2 words. Word 0, bits 0-15 and 16-31: octahedral normal; word 1, bits 0-30: the tangent's
    /// direction as above, once around from 0 to 2^31; 31: set where w = -1.
    angle16,
};

inline constexpr std::array all_frame_encodings = {
    FrameEncoding::float32,      FrameEncoding::octahedral8, FrameEncoding::octahedral10,
    FrameEncoding::octahedral16, FrameEncoding::quaternion8, FrameEncoding::quaternion16,
    FrameEncoding::angle10,      FrameEncoding::angle16};

/// Which of the codes near a value is taken.
enum class FrameRounding {
    nearest,  ///< Each component's nearest. Quaternions then have unit length to within rounding.
    /// The codes among a few that decode closest to the frame; slower, the same to decode. For
    /// octahedral vectors the four around the value, as [Cigolle et al. 2014] propose; for
    /// quaternions the best of 32 lengths: decoders must divide by the length.
    best,
};

/// "float32", "octahedral8", ...: as in docs/tangents.md.
std::string_view word_of(FrameEncoding encoding);

/// How many words a frame takes.
std::size_t words_per_frame(FrameEncoding encoding);

/// Stores frames in few bits.
///
/// \param normals   any space
/// \param tangents  one per normal: xyz and handedness w, +1 or -1
/// \param report    counts, by vertex, what is no frame: a normal or tangent whose length is not 1
///                  to within 0.007 (its direction is stored); a tangent more than 1.1 degrees off
///                  the plane of the normal (turned into it); a tangent without direction, or along
///                  the normal (replaced by the x axis, or if the normal is near that the y axis,
///                  turned into the plane); a normal without direction (replaced in the same way by
///                  a perpendicular of the tangent, or by (0,0,1) where there is no tangent
///                  either); a w that is neither 1 nor -1 (-1 where it is negative, else 1)
/// \return words_per_frame() for each frame, in order; handedness is kept for every frame
/// \throws InvalidInput if the spans are not equally long
///
/// Same input, same bits, for any number of threads.
std::vector<std::uint32_t> encode_frames(std::span<const glm::vec3> normals,
                                         std::span<const glm::vec4> tangents,
                                         FrameEncoding encoding, FrameRounding rounding,
                                         Report& report);

/// Frames as normals and tangents, equally many.
struct Frames {
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> tangents;
};

/// Reads frames back.
///
/// \param report  counts, by vertex, words that encode_frames() never writes: a quaternion of
///                length 0 (read as the axes), a quaternion whose last component is 0 (w is 1), an
///                octahedral tangent along its normal (as by encode_frames()), floats that are no
///                frame (as by encode_frames())
/// \return for any words: normals and tangents of unit length and perpendicular to each other
///         within 2e-7, w exactly 1 or -1
/// \throws InvalidInput if the words are not a multiple of words_per_frame()
Frames decode_frames(std::span<const std::uint32_t> words, FrameEncoding encoding, Report& report);

/// How far directions are from where they were, in degrees, after they have been stored.
struct FrameEncodingError {
    DirectionError normal;
    DirectionError tangent;
};

/// What an encoding does to these frames. What is no frame is compared with what it is replaced by;
/// a tangent that leans is compared with the one turned into the plane.
///
/// \throws InvalidInput if the spans are not equally long
FrameEncodingError frame_encoding_error(std::span<const glm::vec3> normals,
                                        std::span<const glm::vec4> tangents, FrameEncoding encoding,
                                        FrameRounding rounding);

/// An encoding, and what it does to the frames that it was chosen for.
struct ChosenEncoding {
    FrameEncoding encoding = FrameEncoding::float32;
    FrameEncodingError error;
};

/// The encoding of fewest bytes that leaves no normal and no tangent further off than a bound; of
/// several, the one whose largest error is least; float32 if no other keeps to it.
///
/// \param max_degrees  finite, at least 0
/// \throws InvalidInput if that is not so, or the spans are not equally long
ChosenEncoding smallest_encoding_within(double max_degrees, std::span<const glm::vec3> normals,
                                        std::span<const glm::vec4> tangents,
                                        FrameRounding rounding);

}  // namespace relief
