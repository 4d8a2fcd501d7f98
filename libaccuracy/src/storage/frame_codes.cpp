// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/frame_codes_test.cpp.
#include "storage/frame_codes.h"

#include <cmath>
#include <numbers>

#include "relief/mesh/direction_error.h"
#include "tangents/tangent_methods.h"

namespace relief {
namespace {

const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));

float degrees_of(const glm::dvec3& found, const glm::dvec3& expected) {
    return static_cast<float>(degrees_between(found, expected));
}

}  // namespace

SampleFrames sample_frames(std::span<const glm::dvec3> normals,
                           std::span<const glm::dvec3> tangents) {
    SampleFrames frames;
    frames.normals.assign(normals.begin(), normals.end());
    frames.tangents.assign(tangents.begin(), tangents.end());
    for (std::size_t i = 0; i < normals.size(); ++i) {
        frames.float_normals.emplace_back(normals[i]);
        frames.float_tangents.emplace_back(glm::vec3(tangents[i]), i % 2 == 0 ? 1.0F : -1.0F);
    }
    return frames;
}

std::vector<glm::dvec3> even_directions(std::size_t count) {
    std::vector<glm::dvec3> directions;
    for (std::size_t i = 0; i < count; ++i) {
        const double turn = golden_angle * static_cast<double>(i);
        const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
        const double radius = std::sqrt(1.0 - z * z);
        directions.emplace_back(radius * std::cos(turn), radius * std::sin(turn), z);
    }
    return directions;
}

SampleFrames even_frames(std::size_t count) {
    const std::vector<glm::dvec3> normals = even_directions(count);
    std::vector<glm::dvec3> tangents;
    for (std::size_t i = 0; i < count; ++i) {
        const double turn = golden_angle * static_cast<double>(i);
        const double spin = std::numbers::sqrt2 * turn;
        const glm::dvec3 along(-std::sin(turn), std::cos(turn), 0.0);
        tangents.push_back(std::cos(spin) * along + std::sin(spin) * glm::cross(normals[i], along));
    }
    return sample_frames(normals, tangents);
}

FrameCodeErrors frame_code_errors(const SampleFrames& truth, FrameEncoding encoding,
                                  FrameRounding rounding) {
    Report report;
    const std::vector<std::uint32_t> words =
        encode_frames(truth.float_normals, truth.float_tangents, encoding, rounding, report);
    return frame_errors(truth, decode_frames(words, encoding, report));
}

FrameCodeErrors frame_errors(const SampleFrames& truth, const Frames& found) {
    std::vector<float> normals;
    std::vector<float> tangents;
    std::vector<float> texels;
    FrameCodeErrors errors;
    for (std::size_t i = 0; i < truth.normals.size(); ++i) {
        const glm::dvec3 normal(found.normals[i]);
        const glm::dvec3 tangent(found.tangents[i]);
        normals.push_back(degrees_of(normal, truth.normals[i]));
        tangents.push_back(degrees_of(tangent, truth.tangents[i]));
        errors.lost_hands += found.tangents[i].w == truth.float_tangents[i].w ? 0U : 1U;
        const glm::dmat3 basis(tangent, glm::cross(normal, tangent), normal);
        const glm::dmat3 expected(
            truth.tangents[i], glm::cross(truth.normals[i], truth.tangents[i]), truth.normals[i]);
        for (const glm::dvec3& texel : tilted_texels)
            texels.push_back(degrees_of(basis * texel, expected * texel));
    }
    errors.normal = angle_distribution(normals);
    errors.tangent = angle_distribution(tangents);
    normals.insert(normals.end(), tangents.begin(), tangents.end());
    errors.both = angle_distribution(std::move(normals));
    errors.texel = angle_distribution(std::move(texels));
    return errors;
}

}  // namespace relief
