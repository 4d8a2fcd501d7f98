// SPDX-License-Identifier: Apache-2.0
/// \file
/// Computes the normals and tangents of a mesh, splits vertices where corners differ, and encodes
/// tangent frames in 4 to 28 bytes for vertex buffers and files.
///
/// docs/tangents.md has the size and error of each encoding, and shaders that decode them.
/// Tests: tests/mesh/geometry/mesh_test.cpp, tests/mesh/geometry/frames_test.cpp,
/// tests/mesh/geometry/frame_encoding_test.cpp, tests/shade/gl/program_test.cpp.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normals.h"
#include "relief/mesh/report.h"
#include "relief/mesh/statistics.h"
#include "relief/mesh/tangents.h"

namespace RELIEF_API relief {

/// The source of every new vertex, and the triangles over the new vertices.
///
/// The first entries are the old vertices in their order, including isolated ones; the copies
/// follow. Any data by vertex can be carried along with `source_vertex`.
struct VertexSplit {
    std::vector<std::uint32_t> source_vertex;
    std::vector<glm::uvec3> triangles;
};

/// Splits vertices until all corners that share a vertex also share a value, with as few copies as
/// possible.
///
/// \param corner_values  three per triangle, in corner order. They are compared as numbers: -0
///         equals +0; NaNs are equal if their bits are
/// \return the smallest value of a vertex stays with it, the others go to copies in ascending
///         order, so that the vertices do not depend on the order of triangles
/// \throws InvalidInput if a triangle names a vertex that does not exist, or the lengths differ
VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec4> corner_values);
VertexSplit split_where_corners_differ(std::size_t vertex_count,
                                       std::span<const glm::uvec3> triangles,
                                       std::span<const glm::vec3> corner_values);

/// Returns a vertex attribute after a split; an absent (empty) one stays absent.
template <typename T>
std::vector<T> carried(std::span<const T> values, const VertexSplit& split) {
    std::vector<T> result;
    if (values.empty()) return result;
    result.reserve(split.source_vertex.size());
    for (const std::uint32_t vertex : split.source_vertex) {
        assert(vertex < values.size());
        result.push_back(values[vertex]);
    }
    return result;
}

/// Returns a mesh after a split, with all vertex attributes, new triangles and the same ranges.
/// `split` may select any vertices.
Mesh carried(const Mesh& mesh, const VertexSplit& split);

/// The normals that a mesh gets: its own, face normals, or averages over the triangles around each
/// vertex. A NormalWeight converts to the mode that averages with it.
class NormalMode {
  public:
    /// The mesh's normals; if it has none, `if_missing`.
    static const NormalMode keep;
    /// Face normals; vertices are split between triangles.
    static const NormalMode flat;
    /// Averages with a weight that is selected for each vertex: chosen_normals().
    static const NormalMode automatic;

    constexpr NormalMode() = default;  ///< The same as `keep`.
    // Not explicit, so that options read `.normals = NormalWeight::angle`.
    constexpr NormalMode(NormalWeight weight) : kind_(Kind::weighted), weight_(weight) {}

    /// Returns the weight of averages; absent for keep, flat and automatic.
    [[nodiscard]] constexpr std::optional<NormalWeight> weight() const {
        return kind_ == Kind::weighted ? std::optional(weight_) : std::nullopt;
    }
    friend constexpr bool operator==(const NormalMode&, const NormalMode&) = default;

  private:
    enum class Kind { keep, flat, automatic, weighted };

    constexpr explicit NormalMode(Kind kind) : kind_(kind) {}

    Kind kind_ = Kind::keep;
    NormalWeight weight_ = NormalWeight::angle;
};

inline constexpr NormalMode NormalMode::keep{};
inline constexpr NormalMode NormalMode::flat{Kind::flat};
inline constexpr NormalMode NormalMode::automatic{Kind::automatic};

template <>
inline constexpr auto enum_names<NormalMode> = [] {
    std::array<EnumName<NormalMode>, 3 + enum_names<NormalWeight>.size()> names{};
    names[0] = {"keep", NormalMode::keep};
    names[1] = {"flat", NormalMode::flat};
    names[2] = {"auto", NormalMode::automatic};
    for (std::size_t i = 3; i < names.size(); ++i) {
        names[i] = {enum_names<NormalWeight>[i - 3].name, enum_names<NormalWeight>[i - 3].value};
    }
    return names;
}();

struct FrameOptions {
    NormalMode normals = NormalMode::keep;
    NormalMode if_missing = NormalWeight::angle;  ///< Any mode except keep. glTF requires flat.
    TangentMethod tangents = TangentMethod::keep;

    // Options of averaged normals:
    /// Vertices within this distance share their normal (normals.h).
    double weld_tolerance = 0.0;
    /// In radians, 0 to pi: edges with a larger angle are hard, and vertices are split along them.
    /// If absent, no edge is hard because of its angle.
    std::optional<double> crease_angle = std::nullopt;
    /// Edges between the mesh's smoothing groups are hard too, unless all groups are 0, which many
    /// programs write for "undefined".
    bool smoothing_groups = true;

    // Options of kept normals:
    /// Replaces normals that are zero or not finite by averaged ones (`if_missing`, or angle if
    /// that is flat), and normalizes others. Each change is counted.
    bool repair = false;
};

/// A mesh with frames, and the source of each of its vertices.
struct FramedMesh {
    Mesh mesh;
    /// For every vertex of `mesh`, the vertex of the input that it copies. The input's vertices
    /// come first, in order. Use it to carry other vertex data along.
    std::vector<std::uint32_t> source_vertex;
    /// Number of vertices that NormalMode::automatic weighted by area (see ChosenNormals).
    std::size_t normals_by_area = 0;
    /// True if averaged normals respected the mesh's smoothing groups.
    bool within_smoothing_groups = false;
};

/// Computes normals, then tangents, and splits vertices whose corners differ.
///
/// \return a mesh with all attributes; normals and tangents are as documented in normals.h and
///         tangents.h. Kept normals do not change by a bit. Normals that are not finite, or whose
///         length differs from 1 by more than the error of 8-bit storage (0.007), are counted in
///         the report and changed only if `repair` is set. Vertices without a triangle keep their
///         position and get the fallback frames. If normals change and there are no texture
///         coordinates, tangents are removed and counted
/// \throws InvalidInput if the mesh is not valid (mesh.h), if tangents must be computed without
///         texture coordinates or by TangentMethod::triangle, if `if_missing` is keep, or if an
///         option is outside of the range in normals.h
FramedMesh with_frames(Mesh mesh, const FrameOptions& options, Report& report = IgnoredReport());

/// The layout of an encoded frame, in 32-bit words whose bit 0 is the least significant one. On
/// little-endian machines, the words have the memory layout of vertex formats of the same
/// structure.
///
/// *Components* are signed, in two's complement: code c stands for c / M, where
/// M = 2^(bits - 1) - 1, and the lowest code, -M - 1, also stands for -1. *Octahedral*: a unit
/// vector is the position (x, y) on an octahedron that is unfolded into a square:
/// z = M - |x| - |y|; if z is negative, x and y become (M - |y|) sign(x) and (M - |x|) sign(y),
/// with sign(0) = 1 [Cigolle et al. 2014]. *w* is the handedness.
enum class FrameEncoding {
    /// 7 words: normal x y z, tangent x y z w, all IEEE floats.
    float32,
    /// 1 word. Bits 0-7 and 8-15: octahedral normal; 16-23 and 24-31: octahedral tangent, whose y
    /// is odd if w = -1 and even if w = 1.
    octahedral8,
    /// 2 words, as GL_INT_2_10_10_10_REV. Word 0, bits 0-9 and 10-19: octahedral normal. Word 1,
    /// 0-9 and 10-19: octahedral tangent; 30-31: w. The other bits are 0 and free for other uses.
    octahedral10,
    /// 2 words. Word 0, bits 0-15 and 16-31: octahedral normal; word 1: octahedral tangent, whose y
    /// is odd if w = -1 and even if w = 1.
    octahedral16,
    /// 1 word of x, y, z, w, 8 bits each: the quaternion that rotates the x axis to the tangent and
    /// the z axis to the normal, multiplied by w. Its last component is never 0, and its sign is
    /// that of w [Frey and Herzeg 2011].
    quaternion8,
    /// 2 words: the same, 16 bits each.
    quaternion16,
    /// 1 word. Bits 0-9 and 10-19: octahedral normal; 20-30: the tangent's direction in the plane
    /// of the normal *as decoded*; 31: set if w = -1. The direction is a position on the diamond
    /// |a| + |b| = 1, from 0 to 2^11 for one revolution [Ong 2023], where a and b are along the
    /// axes that [Duff et al. 2017] derive from the normal.
    angle10,
    /// 2 words. Word 0, bits 0-15 and 16-31: octahedral normal; word 1, bits 0-30: the tangent's
    /// direction as above, from 0 to 2^31 for one revolution; 31: set if w = -1.
    angle16,
};

/// The names in docs/tangents.md.
template <>
inline constexpr auto enum_names<FrameEncoding> =
    std::to_array<EnumName<FrameEncoding>>({{"float32", FrameEncoding::float32},
                                            {"octahedral8", FrameEncoding::octahedral8},
                                            {"octahedral10", FrameEncoding::octahedral10},
                                            {"octahedral16", FrameEncoding::octahedral16},
                                            {"quaternion8", FrameEncoding::quaternion8},
                                            {"quaternion16", FrameEncoding::quaternion16},
                                            {"angle10", FrameEncoding::angle10},
                                            {"angle16", FrameEncoding::angle16}});

inline constexpr std::array all_frame_encodings = {
    FrameEncoding::float32,      FrameEncoding::octahedral8, FrameEncoding::octahedral10,
    FrameEncoding::octahedral16, FrameEncoding::quaternion8, FrameEncoding::quaternion16,
    FrameEncoding::angle10,      FrameEncoding::angle16};

/// The selection of a code near a value.
enum class FrameRounding {
    /// The nearest code of each component. Quaternions then have unit length up to rounding.
    nearest,
    /// The codes, among a few candidates, that decode to the closest frame. Encoding is slower,
    /// decoding is the same. The candidates of octahedral vectors are the four codes around the
    /// value, as [Cigolle et al. 2014] propose. Those of quaternions have 32 different lengths, so
    /// decoders must divide by the length.
    best,
};

/// Returns the number of words of a frame.
std::size_t words_per_frame(FrameEncoding encoding);

/// Encodes frames.
///
/// \param normals  in any space
/// \param tangents  one per normal: xyz and handedness w, +1 or -1
/// \param report  counts invalid frames by vertex: a normal or tangent whose length differs from 1
///         by more than 0.007 (its direction is stored); a tangent more than 1.1 degrees outside
///         the plane of the normal (projected into it); a tangent without direction or parallel to
///         the normal (replaced by the x axis, or the y axis if the normal is near x, projected
///         into the plane); a normal without direction (replaced in the same way by a perpendicular
///         of the tangent, or by (0,0,1) without a tangent); a w that is neither 1 nor -1 (-1 if it
///         is negative, else 1)
/// \return words_per_frame() words for each frame, in order; the handedness of every frame is
///         preserved
/// \throws InvalidInput if the spans differ in length
///
/// The same input gives the same bits for any number of threads.
std::vector<std::uint32_t> encode_frames(std::span<const glm::vec3> normals,
                                         std::span<const glm::vec4> tangents,
                                         FrameEncoding encoding, FrameRounding rounding,
                                         Report& report = IgnoredReport());

/// Frames as normals and tangents of the same number.
struct Frames {
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> tangents;
};

/// Decodes frames.
///
/// \param report  counts, by vertex, words that encode_frames() never writes: a quaternion of
///         length 0 (decoded as the axes), a quaternion whose last component is 0 (w is 1), an
///         octahedral tangent parallel to its normal, and invalid frames of floats (both replaced
///         as in encode_frames())
/// \return for any words: unit normals and unit tangents that are perpendicular to each other
///         within 2e-7, with w exactly 1 or -1
/// \throws InvalidInput if the number of words is not a multiple of words_per_frame()
Frames decode_frames(std::span<const std::uint32_t> words, FrameEncoding encoding,
                     Report& report = IgnoredReport());

/// The angles between the original and the decoded directions, in degrees.
struct FrameEncodingError {
    ErrorStats normal;
    ErrorStats tangent;
};

/// Measures the error of an encoding for given frames. Invalid frames are compared with their
/// replacement, and tangents outside the plane of the normal with their projection.
///
/// \throws InvalidInput if the spans differ in length
FrameEncodingError frame_encoding_error(std::span<const glm::vec3> normals,
                                        std::span<const glm::vec4> tangents, FrameEncoding encoding,
                                        FrameRounding rounding);

/// An encoding and its error for the frames that it was selected for.
struct ChosenEncoding {
    FrameEncoding encoding = FrameEncoding::float32;
    FrameEncodingError error;
};

/// Selects the smallest encoding whose maximum error of normals and tangents is within a limit.
/// Ties: the one with the smaller maximum error. float32 if no other encoding is within the limit.
///
/// \param max_degrees  finite, at least 0
/// \throws InvalidInput if max_degrees is out of range, or the spans differ in length
ChosenEncoding smallest_encoding_within(double max_degrees, std::span<const glm::vec3> normals,
                                        std::span<const glm::vec4> tangents,
                                        FrameRounding rounding);

}  // namespace relief
