// SPDX-License-Identifier: Apache-2.0
// Each encoding of tangent frames on frames spread evenly over the sphere: how far normals and
// tangents are from where they were, and what decoding takes. Tests:
// tests/accuracy/storage_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "relief/accuracy/measure.h"
#include "relief/mesh/frame_encoding.h"
#include "storage/storage_experiments.h"

namespace relief {
namespace {

/// Frames before and after they are rounded to float, so that float's own error is seen too.
struct EvenFrames {
    std::vector<glm::dvec3> normals;
    std::vector<glm::dvec3> tangents;
    std::vector<glm::vec3> float_normals;
    std::vector<glm::vec4> float_tangents;
};

/// Normals on a spiral of equal areas; tangents turn as they go, in no step with it.
EvenFrames even_frames(std::size_t count) {
    const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
    EvenFrames frames;
    for (std::size_t i = 0; i < count; ++i) {
        const auto turn = golden * static_cast<double>(i);
        const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
        const double radius = std::sqrt(1.0 - z * z);
        const glm::dvec3 normal(radius * std::cos(turn), radius * std::sin(turn), z);
        const glm::dvec3 along(-std::sin(turn), std::cos(turn), 0.0);
        const double spin = std::numbers::sqrt2 * turn;
        const glm::dvec3 tangent =
            std::cos(spin) * along + std::sin(spin) * glm::cross(normal, along);
        frames.normals.push_back(normal);
        frames.tangents.push_back(tangent);
        frames.float_normals.emplace_back(normal);
        frames.float_tangents.emplace_back(glm::vec3(tangent), i % 2 == 0 ? 1.0F : -1.0F);
    }
    return frames;
}

/// Degrees that normals and tangents are off, all in one.
ErrorFigures error_of(const Frames& stored, const EvenFrames& truth) {
    std::vector<float> degrees;
    for (std::size_t i = 0; i < truth.normals.size(); ++i) {
        degrees.push_back(
            static_cast<float>(degrees_between(glm::dvec3(stored.normals[i]), truth.normals[i])));
        degrees.push_back(
            static_cast<float>(degrees_between(glm::dvec3(stored.tangents[i]), truth.tangents[i])));
    }
    return figures_of(angle_distribution(std::move(degrees)));
}

/// "octahedral16 (8 bytes) is off by 0.0011 degrees at most, ..." for the best of each size.
std::string finding_of(const Experiment& experiment) {
    std::vector<std::string> parts;
    for (const double bytes : {4.0, 8.0}) {
        const Measurement* best = nullptr;
        for (const Measurement& one : experiment.measurements) {
            if (one.cost.stored_bytes != bytes) continue;
            if (best == nullptr || one.error.rms < best->error.rms) best = &one;
        }
        if (best == nullptr) continue;
        parts.push_back(fmt::format("in {} bytes {} is nearest: {:.2g} degrees RMS, {:.2g} at most",
                                    bytes, best->method, best->error.rms, best->error.max));
    }
    return fmt::format("Of a frame's 28 bytes most can go: {}.", fmt::join(parts, "; "));
}

}  // namespace

Experiment frame_codes_experiment(const RunOptions& options) {
    const std::size_t count = options.is_quick ? 20000 : 200000;
    const EvenFrames frames = even_frames(count);
    Experiment experiment;
    experiment.id = "storage/frames";
    experiment.subject = Subject::storage;
    experiment.title = "Tangent frames in few bits";
    experiment.question = "How many bytes does a tangent frame need?";
    experiment.truth = "the frames in double, before they were stored";
    experiment.input = fmt::format("{} frames spread evenly over the sphere", count);
    experiment.error_unit = "degrees";
    experiment.item = "frame";
    experiment.items = static_cast<double>(count);
    std::vector<std::vector<std::uint32_t>> words;
    Report report;
    for (const FrameEncoding encoding : all_frame_encodings) {
        words.push_back(encode_frames(frames.float_normals, frames.float_tangents, encoding,
                                      FrameRounding::nearest, report));
        Measurement one;
        one.method = word_of(encoding);
        one.choices = {{"encoding", one.method}};
        one.error = error_of(decode_frames(words.back(), encoding, report), frames);
        experiment.measurements.push_back(std::move(one));
    }
    std::vector<std::function<void()>> works;
    for (std::size_t i = 0; i < words.size(); ++i) {
        works.emplace_back([&words, i] {
            Report found;
            decode_frames(words[i], all_frame_encodings.at(i), found);
        });
    }
    const std::vector<Cost> costs = measure_costs(works, options);
    for (std::size_t i = 0; i < costs.size(); ++i) {
        experiment.measurements[i].cost = costs[i];
        experiment.measurements[i].cost.stored_bytes =
            4.0 * static_cast<double>(words_per_frame(all_frame_encodings.at(i)));
    }
    mark_efficient(experiment);
    experiment.finding = finding_of(experiment);
    return experiment;
}

}  // namespace relief
