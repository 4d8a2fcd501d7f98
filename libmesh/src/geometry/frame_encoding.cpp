// SPDX-License-Identifier: Apache-2.0
// Encodes and decodes tangent frames in double precision. A frame that is not orthonormal is
// replaced by the rules of frames.h and counted. The code uses only sums, products,
// quotients and square roots, so the codes are the same on every processor. Frames are independent
// of each other and processed in parallel. Sources: [Cigolle et al. 2014], [Frey and Herzeg 2011],
// [Ong 2023], [Duff et al. 2017].
#include "relief/mesh/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "geometry/direction.h"
#include "octahedral_code.h"
#include "parallel.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// An orthonormal tangent frame.
struct SoundFrame {
    glm::dvec3 normal{0.0, 0.0, 1.0};
    glm::dvec3 tangent{1.0, 0.0, 0.0};
    bool mirrored = false;  ///< w = -1.
};

/// Returns the orthonormal frame for a normal and a tangent. Deviations are counted under `index`.
SoundFrame sound_frame(const glm::vec3& normal, const glm::vec4& tangent, std::size_t index,
                       Report& found);

// Shortest projection of a unit tangent onto the plane of its normal that floats can distinguish
// from zero.
constexpr double no_remainder = 1e-6;

constexpr int largest_code(int bits) {
    return (1 << (bits - 1)) - 1;
}

/// Returns the signed component of a word. The lowest code equals the second lowest.
int component(std::uint32_t word, int first_bit, int bits) {
    const auto code = static_cast<std::int32_t>(word << (32 - first_bit - bits)) >> (32 - bits);
    return std::max(code, -largest_code(bits));
}

std::uint32_t placed(int code, int first_bit, int bits) {
    const std::uint32_t mask = (std::uint32_t{1} << bits) - 1;
    return (static_cast<std::uint32_t>(code) & mask) << first_bit;
}

/// Returns the fallback tangent of a unit normal.
glm::dvec3 fallback_tangent(const glm::dvec3& normal) {
    return glm::normalize(in_plane(glm::dvec3(perpendicular_to(glm::vec3(normal))), normal));
}

double distance_squared(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::dot(a - b, a - b);
}

OctahedralCode normal_code(const glm::dvec3& normal, int largest, FrameRounding rounding) {
    const glm::dvec2 place = octahedral_place(normal, largest);
    if (rounding == FrameRounding::nearest) return nearest_code(place, largest, -1);
    return best_code(place, largest, -1, [&](OctahedralCode code) {
        return distance_squared(glm::normalize(octahedral_direction(code, largest)), normal);
    });
}

/// \param normal   decoded normal; the decoded tangent is perpendicular to it
/// \param parity   parity of y: 0 or 1
OctahedralCode tangent_code(const glm::dvec3& tangent, const glm::dvec3& normal, int largest,
                            int parity, FrameRounding rounding) {
    const glm::dvec2 place = octahedral_place(tangent, largest);
    if (rounding == FrameRounding::nearest) return nearest_code(place, largest, parity);
    return best_code(place, largest, parity, [&](OctahedralCode code) {
        return distance_squared(
            glm::normalize(in_plane(octahedral_direction(code, largest), normal)), tangent);
    });
}

/// Position of w.
enum class Handedness { parity_of_y, top_two_bits };

template <int bits>
struct Octahedral {
    static constexpr int largest = largest_code(bits);
    static constexpr Handedness handedness =
        bits == 10 ? Handedness::top_two_bits : Handedness::parity_of_y;
    // With 8 bits, everything is in one word.
    static constexpr int tangent_word = bits == 8 ? 0 : 1;
    static constexpr int tangent_bit = bits == 8 ? 16 : 0;

    static void encode(const SoundFrame& frame, FrameRounding rounding, std::uint32_t* words) {
        const OctahedralCode normal = normal_code(frame.normal, largest, rounding);
        const int parity =
            handedness == Handedness::parity_of_y ? static_cast<int>(frame.mirrored) : -1;
        const OctahedralCode tangent =
            tangent_code(frame.tangent, glm::normalize(octahedral_direction(normal, largest)),
                         largest, parity, rounding);
        words[0] = placed(normal.x, 0, bits) | placed(normal.y, bits, bits);
        std::uint32_t rest =
            placed(tangent.x, tangent_bit, bits) | placed(tangent.y, tangent_bit + bits, bits);
        if (handedness == Handedness::top_two_bits) rest |= placed(frame.mirrored ? -1 : 1, 30, 2);
        if (tangent_word == 0)
            words[0] |= rest;
        else
            words[1] = rest;
    }

    static SoundFrame decode(const std::uint32_t* words, std::size_t index, Report& found) {
        const std::uint32_t rest = words[tangent_word];
        const OctahedralCode normal{component(words[0], 0, bits), component(words[0], bits, bits)};
        const OctahedralCode tangent{component(rest, tangent_bit, bits),
                                     component(rest, tangent_bit + bits, bits)};
        SoundFrame frame;
        frame.normal = glm::normalize(octahedral_direction(normal, largest));
        frame.mirrored = handedness == Handedness::top_two_bits
                             ? (rest >> 31U) != 0
                             : ((rest >> static_cast<unsigned>(tangent_bit + bits)) & 1U) != 0;
        const glm::dvec3 remainder =
            in_plane(glm::normalize(octahedral_direction(tangent, largest)), frame.normal);
        if (glm::length(remainder) > no_remainder) {
            frame.tangent = glm::normalize(remainder);
            return frame;
        }
        found.add("tangent along its normal", "vertex", index,
                  "replaced by a direction perpendicular to the normal");
        frame.tangent = fallback_tangent(frame.normal);
        return frame;
    }
};

using Quaternion = std::array<double, 4>;  ///< x, y, z, w.

/// Rotation whose matrix has the columns tangent, cross(normal, tangent), normal, computed from its
/// largest component, which is at least 1/2. Its last component is not negative.
Quaternion rotation_of(const SoundFrame& frame) {
    const glm::dvec3& t = frame.tangent;
    const glm::dvec3& n = frame.normal;
    const glm::dvec3 b = glm::cross(n, t);
    // Four times the products of x, y, z and w. Each row is 4 q times one component.
    const double xy = t.y + b.x, xz = t.z + n.x, yz = b.z + n.y;
    const double xw = b.z - n.y, yw = n.x - t.z, zw = t.y - b.x;
    const std::array<Quaternion, 4> rows = {Quaternion{1.0 + t.x - b.y - n.z, xy, xz, xw},
                                            Quaternion{xy, 1.0 - t.x + b.y - n.z, yz, yw},
                                            Quaternion{xz, yz, 1.0 - t.x - b.y + n.z, zw},
                                            Quaternion{xw, yw, zw, 1.0 + t.x + b.y + n.z}};
    std::size_t largest = 0;
    for (std::size_t i = 1; i < 4; ++i) {
        if (rows[i][i] > rows[largest][largest]) largest = i;
    }
    Quaternion rotation = rows[largest];
    const double length = std::sqrt(rotation[0] * rotation[0] + rotation[1] * rotation[1] +
                                    rotation[2] * rotation[2] + rotation[3] * rotation[3]);
    const double scale = (rotation[3] < 0.0 ? -1.0 : 1.0) / length;
    for (double& value : rotation)
        value *= scale;
    return rotation;
}

using QuaternionCode = std::array<int, 4>;

QuaternionCode quaternion_code(const Quaternion& rotation, double scale) {
    QuaternionCode code{};
    for (std::size_t i = 0; i < 4; ++i)
        code[i] = rounded_to_int(rotation[i] * scale);
    // It is never 0, because its sign is the handedness.
    code[3] = std::max(code[3], 1);
    return code;
}

/// Returns the squared cosine of half the angle between two rotations.
double closeness(const QuaternionCode& code, const Quaternion& rotation) {
    double along = 0.0;
    double length = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        along += code[i] * rotation[i];
        length += static_cast<double>(code[i]) * code[i];
    }
    return along * along / length;
}

/// A quaternion of any length represents the same rotation. The search uses the code of the length
/// with the smallest error.
QuaternionCode best_quaternion_code(const Quaternion& rotation, int largest) {
    constexpr int lengths = 32;
    QuaternionCode best = quaternion_code(rotation, largest);
    double closest = closeness(best, rotation);
    double size = 0.0;
    for (const double value : rotation)
        size = std::max(size, std::abs(value));
    for (int i = 0; i < lengths; ++i) {
        // Lengths from the largest that fits down to half of it: shorter ones are coarser.
        const double scale = largest / size * (1.0 - i / (2.0 * lengths));
        const QuaternionCode code = quaternion_code(rotation, scale);
        const double found = closeness(code, rotation);
        if (found > closest) {
            closest = found;
            best = code;
        }
    }
    return best;
}

template <int bits>
struct QuaternionFrame {
    static constexpr int largest = largest_code(bits);
    static constexpr std::size_t per_word = 32 / bits;

    static void encode(const SoundFrame& frame, FrameRounding rounding, std::uint32_t* words) {
        const Quaternion rotation = rotation_of(frame);
        const QuaternionCode code = rounding == FrameRounding::best
                                        ? best_quaternion_code(rotation, largest)
                                        : quaternion_code(rotation, largest);
        std::fill_n(words, 4 / per_word, 0U);
        for (std::size_t i = 0; i < 4; ++i) {
            words[i / per_word] |= placed(frame.mirrored ? -code[i] : code[i],
                                          static_cast<int>(i % per_word) * bits, bits);
        }
    }

    static SoundFrame decode(const std::uint32_t* words, std::size_t index, Report& found) {
        std::array<double, 4> q{};
        for (std::size_t i = 0; i < 4; ++i)
            q[i] = component(words[i / per_word], static_cast<int>(i % per_word) * bits, bits);
        const double x = q[0], y = q[1], z = q[2], w = q[3];
        SoundFrame frame;
        frame.mirrored = w < 0.0;
        const double length = x * x + y * y + z * z + w * w;
        if (length == 0.0) {
            found.add("quaternion of length 0", "vertex", index, "read as the axes");
            return frame;
        }
        if (w == 0.0) found.add("quaternion without handedness", "vertex", index, "read as w = 1");
        const double scale = 2.0 / length;
        frame.tangent = {1.0 - scale * (y * y + z * z), scale * (x * y + w * z),
                         scale * (x * z - w * y)};
        frame.normal = {scale * (x * z + w * y), scale * (y * z - w * x),
                        1.0 - scale * (x * x + y * y)};
        return frame;
    }
};

/// Two axes that form a right-handed frame with a unit normal: first, second, normal
struct PlaneAxes {
    glm::dvec3 first;
    glm::dvec3 second;
};

PlaneAxes plane_axes(const glm::dvec3& n) {
    const double sign = n.z < 0.0 ? -1.0 : 1.0;
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    return {{1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

template <int normal_bits, int angle_bits>
struct Angle {
    static constexpr int largest = largest_code(normal_bits);
    static constexpr double quarter = std::uint32_t{1} << (angle_bits - 2);
    static constexpr std::uint32_t mask = (std::uint32_t{1} << angle_bits) - 1;
    static constexpr std::size_t angle_word = 2 * normal_bits + angle_bits < 32 ? 0 : 1;
    static constexpr unsigned angle_bit = angle_word == 0 ? 2 * normal_bits : 0;

    static void encode(const SoundFrame& frame, FrameRounding rounding, std::uint32_t* words) {
        const OctahedralCode code = normal_code(frame.normal, largest, rounding);
        const PlaneAxes axes = plane_axes(glm::normalize(octahedral_direction(code, largest)));
        const double a = glm::dot(axes.first, frame.tangent);
        const double b = glm::dot(axes.second, frame.tangent);
        const double across = a / (std::abs(a) + std::abs(b));
        const double around = b < 0.0 ? 3.0 + across : 1.0 - across;
        // A full turn is 0 again.
        const std::uint32_t angle = static_cast<std::uint32_t>(around * quarter + 0.5) & mask;
        words[0] = placed(code.x, 0, normal_bits) | placed(code.y, normal_bits, normal_bits);
        const std::uint32_t rest = angle << angle_bit | static_cast<std::uint32_t>(frame.mirrored)
                                                            << 31U;
        if (angle_word == 0)
            words[0] |= rest;
        else
            words[1] = rest;
    }

    static SoundFrame decode(const std::uint32_t* words) {
        const OctahedralCode code{component(words[0], 0, normal_bits),
                                  component(words[0], normal_bits, normal_bits)};
        SoundFrame frame;
        frame.normal = glm::normalize(octahedral_direction(code, largest));
        frame.mirrored = words[angle_word] >> 31U != 0;
        const double around = ((words[angle_word] >> angle_bit) & mask) / quarter;
        const double a = around < 2.0 ? 1.0 - around : around - 3.0;
        const double b = (around < 2.0 ? 1.0 : -1.0) * (1.0 - std::abs(a));
        const PlaneAxes axes = plane_axes(frame.normal);
        frame.tangent = glm::normalize(a * axes.first + b * axes.second);
        return frame;
    }
};

struct Floats {
    static void encode(const SoundFrame& frame, std::uint32_t* words) {
        for (int i = 0; i < 3; ++i) {
            words[i] = std::bit_cast<std::uint32_t>(rounded(frame.normal)[i]);
            words[3 + i] = std::bit_cast<std::uint32_t>(rounded(frame.tangent)[i]);
        }
        words[6] = std::bit_cast<std::uint32_t>(frame.mirrored ? -1.0F : 1.0F);
    }

    static SoundFrame decode(const std::uint32_t* words, std::size_t index, Report& found) {
        std::array<float, 7> v{};
        std::transform(words, words + 7, v.begin(),
                       [](std::uint32_t word) { return std::bit_cast<float>(word); });
        return sound_frame({v[0], v[1], v[2]}, {v[3], v[4], v[5], v[6]}, index, found);
    }
};

void report_length(const glm::dvec3& vector, const char* kind, std::size_t index, Report& found) {
    if (std::abs(glm::length(vector) - 1.0) > unit_tolerance)
        found.add(kind, "vertex", index, "its direction is taken");
}

/// Returns the tangent in the plane of a unit normal.
glm::dvec3 sound_tangent(const glm::dvec3& tangent, const glm::dvec3& normal, std::size_t index,
                         Report& found) {
    const glm::dvec3 unit = direction_or_zero(tangent);
    const glm::dvec3 remainder = in_plane(unit, normal);
    const double length = glm::length(remainder);
    if (length > no_remainder) {
        report_length(tangent, "tangent not of unit length", index, found);
        if (std::abs(glm::dot(unit, normal)) > leaning_tolerance) {
            found.add("tangent not perpendicular to its normal", "vertex", index,
                      "projected into the plane of the normal");
        }
        // Projected twice, because a short remainder contains the rounding error of the first
        // projection.
        return glm::normalize(in_plane(remainder / length, normal));
    }
    found.add(unit == glm::dvec3(0.0) ? "tangent without direction" : "tangent along its normal",
              "vertex", index, "replaced by a direction perpendicular to the normal");
    return fallback_tangent(normal);
}

/// Validates a frame and counts its problems.
SoundFrame repaired_frame(const glm::vec3& normal, const glm::vec4& tangent, std::size_t index,
                          Report& found) {
    SoundFrame frame;
    const glm::dvec3 unit_normal = direction_or_zero(glm::dvec3(normal));
    if (unit_normal != glm::dvec3(0.0)) {
        report_length(glm::dvec3(normal), "normal not of unit length", index, found);
        frame.normal = unit_normal;
    } else {
        found.add("normal without direction", "vertex", index,
                  "replaced by a direction perpendicular to the tangent");
        if (direction_or_zero(glm::dvec3(tangent)) != glm::dvec3(0.0))
            frame.normal = glm::normalize(glm::dvec3(perpendicular_to(glm::vec3(tangent))));
    }
    frame.tangent = sound_tangent(glm::dvec3(tangent), frame.normal, index, found);
    if (std::abs(tangent.w) != 1.0F) {
        found.add("tangent without handedness", "vertex", index,
                  "w becomes -1 if it is negative, else 1");
    }
    frame.mirrored = tangent.w < 0.0F;
    return frame;
}

SoundFrame sound_frame(const glm::vec3& normal, const glm::vec4& tangent, std::size_t index,
                       Report& found) {
    const glm::dvec3 n(normal);
    const glm::dvec3 t(tangent);
    const double normal_length = glm::length(n);
    const glm::dvec3 unit = n * (1.0 / normal_length);
    const double along = glm::dot(unit, t);
    // The condition is false for NaN. Nearly all frames are valid and cost three square roots.
    const bool is_sound = std::abs(normal_length - 1.0) <= unit_tolerance &&
                          std::abs(glm::length(t) - 1.0) <= unit_tolerance &&
                          std::abs(along) <= leaning_tolerance && std::abs(tangent.w) == 1.0F;
    if (!is_sound) return repaired_frame(normal, tangent, index, found);
    const glm::dvec3 remainder = t - unit * along;
    return {unit, remainder * (1.0 / glm::length(remainder)), tangent.w < 0.0F};
}

/// \param words  array of words_per_frame() words
void encode_frame(const SoundFrame& frame, FrameEncoding encoding, FrameRounding rounding,
                  std::uint32_t* words) {
    switch (encoding) {
        case FrameEncoding::float32:
            return Floats::encode(frame, words);
        case FrameEncoding::octahedral8:
            return Octahedral<8>::encode(frame, rounding, words);
        case FrameEncoding::octahedral10:
            return Octahedral<10>::encode(frame, rounding, words);
        case FrameEncoding::octahedral16:
            return Octahedral<16>::encode(frame, rounding, words);
        case FrameEncoding::quaternion8:
            return QuaternionFrame<8>::encode(frame, rounding, words);
        case FrameEncoding::quaternion16:
            return QuaternionFrame<16>::encode(frame, rounding, words);
        case FrameEncoding::angle10:
            return Angle<10, 11>::encode(frame, rounding, words);
        case FrameEncoding::angle16:
            return Angle<16, 31>::encode(frame, rounding, words);
    }
}

/// \param words  array of words_per_frame() words
SoundFrame decode_frame(const std::uint32_t* words, FrameEncoding encoding, std::size_t index,
                        Report& found) {
    switch (encoding) {
        case FrameEncoding::float32:
            return Floats::decode(words, index, found);
        case FrameEncoding::octahedral8:
            return Octahedral<8>::decode(words, index, found);
        case FrameEncoding::octahedral10:
            return Octahedral<10>::decode(words, index, found);
        case FrameEncoding::octahedral16:
            return Octahedral<16>::decode(words, index, found);
        case FrameEncoding::quaternion8:
            return QuaternionFrame<8>::decode(words, index, found);
        case FrameEncoding::quaternion16:
            return QuaternionFrame<16>::decode(words, index, found);
        case FrameEncoding::angle10:
            return Angle<10, 11>::decode(words);
        case FrameEncoding::angle16:
            break;
    }
    return Angle<16, 31>::decode(words);
}

constexpr std::size_t frames_per_piece = 1 << 12;

Frames stored_and_read(std::span<const glm::vec3> normals, std::span<const glm::vec4> tangents,
                       FrameEncoding encoding, FrameRounding rounding) {
    Report seen_before;  // Invalid frames are already reported.
    return decode_frames(encode_frames(normals, tangents, encoding, rounding, seen_before),
                         encoding, seen_before);
}

FrameEncodingError error_against(const Frames& reference, const Frames& found) {
    const std::vector<glm::dvec3> normals(reference.normals.begin(), reference.normals.end());
    const std::vector<glm::dvec3> tangents(reference.tangents.begin(), reference.tangents.end());
    const std::vector<glm::vec3> found_tangents(found.tangents.begin(), found.tangents.end());
    return {direction_error(found.normals, normals), direction_error(found_tangents, tangents)};
}

double largest(const FrameEncodingError& error) {
    return std::max(error.normal.max, error.tangent.max);
}

}  // namespace

std::size_t words_per_frame(FrameEncoding encoding) {
    switch (encoding) {
        case FrameEncoding::float32:
            return 7;
        case FrameEncoding::octahedral8:
        case FrameEncoding::quaternion8:
        case FrameEncoding::angle10:
            return 1;
        case FrameEncoding::octahedral10:
        case FrameEncoding::octahedral16:
        case FrameEncoding::quaternion16:
        case FrameEncoding::angle16:
            break;
    }
    return 2;
}

std::vector<std::uint32_t> encode_frames(std::span<const glm::vec3> normals,
                                         std::span<const glm::vec4> tangents,
                                         FrameEncoding encoding, FrameRounding rounding,
                                         Report& report) {
    if (normals.size() != tangents.size()) {
        throw InvalidInput(
            fmt::format("there are {} normals, but {} tangents", normals.size(), tangents.size()));
    }
    const std::size_t stride = words_per_frame(encoding);
    std::vector<std::uint32_t> words(normals.size() * stride);
    parallel_for_reporting(normals.size(), frames_per_piece, report,
                           [&](std::size_t begin, std::size_t end, Report& found) {
                               for (std::size_t i = begin; i < end; ++i) {
                                   encode_frame(sound_frame(normals[i], tangents[i], i, found),
                                                encoding, rounding, &words[i * stride]);
                               }
                           });
    return words;
}

Frames decode_frames(std::span<const std::uint32_t> words, FrameEncoding encoding, Report& report) {
    const std::size_t stride = words_per_frame(encoding);
    if (words.size() % stride != 0) {
        throw InvalidInput(fmt::format("{} words are not a multiple of {}, the words of a frame",
                                       words.size(), stride));
    }
    const std::size_t count = words.size() / stride;
    Frames frames{std::vector<glm::vec3>(count), std::vector<glm::vec4>(count)};
    parallel_for_reporting(
        count, frames_per_piece, report, [&](std::size_t begin, std::size_t end, Report& found) {
            for (std::size_t i = begin; i < end; ++i) {
                const SoundFrame frame = decode_frame(&words[i * stride], encoding, i, found);
                frames.normals[i] = rounded(frame.normal);
                frames.tangents[i] =
                    glm::vec4(rounded(frame.tangent), frame.mirrored ? -1.0F : 1.0F);
            }
        });
    return frames;
}

FrameEncodingError frame_encoding_error(std::span<const glm::vec3> normals,
                                        std::span<const glm::vec4> tangents, FrameEncoding encoding,
                                        FrameRounding rounding) {
    return error_against(
        stored_and_read(normals, tangents, FrameEncoding::float32, FrameRounding::nearest),
        stored_and_read(normals, tangents, encoding, rounding));
}

ChosenEncoding smallest_encoding_within(double max_degrees, std::span<const glm::vec3> normals,
                                        std::span<const glm::vec4> tangents,
                                        FrameRounding rounding) {
    if (!(max_degrees >= 0.0) || !std::isfinite(max_degrees)) {
        throw InvalidInput(
            fmt::format("the limit is {} degrees, but must be finite and at least 0", max_degrees));
    }
    const Frames reference =
        stored_and_read(normals, tangents, FrameEncoding::float32, FrameRounding::nearest);
    ChosenEncoding chosen{FrameEncoding::float32, error_against(reference, reference)};
    for (const FrameEncoding encoding : all_frame_encodings) {
        const std::size_t words = words_per_frame(encoding);
        const std::size_t fewest = words_per_frame(chosen.encoding);
        if (encoding == FrameEncoding::float32 || words > fewest) continue;
        const FrameEncodingError error =
            error_against(reference, stored_and_read(normals, tangents, encoding, rounding));
        if (largest(error) > max_degrees) continue;
        if (words < fewest || largest(error) < largest(chosen.error)) chosen = {encoding, error};
    }
    return chosen;
}

}  // namespace relief
