// SPDX-License-Identifier: Apache-2.0
// Many frames to codes and back, in parallel. Each frame is on its own: same input, same bits, for
// any number of threads. Tests: tests/mesh/geometry/encoding/frame_encoding_test.cpp.
#include "relief/mesh/frame_encoding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/direction.h"
#include "geometry/encoding/frame_codes.h"
#include "parallel.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

constexpr std::size_t frames_per_piece = 1 << 12;

Frames stored_and_read(std::span<const glm::vec3> normals, std::span<const glm::vec4> tangents,
                       FrameEncoding encoding, FrameRounding rounding) {
    Report seen_before;  // What is no frame is not news here.
    return decode_frames(encode_frames(normals, tangents, encoding, rounding, seen_before),
                         encoding, seen_before);
}

FrameEncodingError error_against(const Frames& truth, const Frames& found) {
    const std::vector<glm::dvec3> normals(truth.normals.begin(), truth.normals.end());
    const std::vector<glm::dvec3> tangents(truth.tangents.begin(), truth.tangents.end());
    const std::vector<glm::vec3> found_tangents(found.tangents.begin(), found.tangents.end());
    return {direction_error(found.normals, normals), direction_error(found_tangents, tangents)};
}

double largest(const FrameEncodingError& error) {
    return std::max(error.normal.max, error.tangent.max);
}

}  // namespace

std::string_view word_of(FrameEncoding encoding) {
    switch (encoding) {
        case FrameEncoding::float32:
            break;
        case FrameEncoding::octahedral8:
            return "octahedral8";
        case FrameEncoding::octahedral10:
            return "octahedral10";
        case FrameEncoding::octahedral16:
            return "octahedral16";
        case FrameEncoding::quaternion8:
            return "quaternion8";
        case FrameEncoding::quaternion16:
            return "quaternion16";
        case FrameEncoding::angle10:
            return "angle10";
        case FrameEncoding::angle16:
            return "angle16";
    }
    return "float32";
}

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
        throw InvalidInput(
            fmt::format("{} words are not whole frames of {} words", words.size(), stride));
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
            fmt::format("an error of {} degrees is no bound: 0 or more", max_degrees));
    }
    const Frames truth =
        stored_and_read(normals, tangents, FrameEncoding::float32, FrameRounding::nearest);
    ChosenEncoding chosen{FrameEncoding::float32, error_against(truth, truth)};
    for (const FrameEncoding encoding : all_frame_encodings) {
        const std::size_t words = words_per_frame(encoding);
        const std::size_t fewest = words_per_frame(chosen.encoding);
        if (encoding == FrameEncoding::float32 || words > fewest) continue;
        const FrameEncodingError error =
            error_against(truth, stored_and_read(normals, tangents, encoding, rounding));
        if (largest(error) > max_degrees) continue;
        if (words < fewest || largest(error) < largest(chosen.error)) chosen = {encoding, error};
    }
    return chosen;
}

}  // namespace relief
