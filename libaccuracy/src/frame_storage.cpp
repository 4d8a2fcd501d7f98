// SPDX-License-Identifier: Apache-2.0
// Encodes evenly spread tangent frames with every frame encoding and compares the decoded frames
// with the frames in double.
#include "storage_experiments.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "experiment_driver.h"
#include "relief/mesh/error_stats.h"
#include "tangent_methods.h"

namespace relief {
namespace {

const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));

float degrees_of(const glm::dvec3& actual, const glm::dvec3& expected) {
    return static_cast<float>(degrees_between(actual, expected));
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

FrameCodeErrors frame_code_errors(const SampleFrames& ground_truth, FrameEncoding encoding,
                                  FrameRounding rounding) {
    Report report;
    const std::vector<std::uint32_t> words = encode_frames(
        ground_truth.float_normals, ground_truth.float_tangents, encoding, rounding, report);
    return frame_errors(ground_truth, decode_frames(words, encoding, report));
}

FrameCodeErrors frame_errors(const SampleFrames& ground_truth, const Frames& actual) {
    std::vector<float> normals;
    std::vector<float> tangents;
    std::vector<float> texels;
    FrameCodeErrors errors;
    for (std::size_t i = 0; i < ground_truth.normals.size(); ++i) {
        const glm::dvec3 normal(actual.normals[i]);
        const glm::dvec3 tangent(actual.tangents[i]);
        normals.push_back(degrees_of(normal, ground_truth.normals[i]));
        tangents.push_back(degrees_of(tangent, ground_truth.tangents[i]));
        errors.flipped_frames += actual.tangents[i].w == ground_truth.float_tangents[i].w ? 0U : 1U;
        const glm::dmat3 basis(tangent, glm::cross(normal, tangent), normal);
        const glm::dmat3 expected(ground_truth.tangents[i],
                                  glm::cross(ground_truth.normals[i], ground_truth.tangents[i]),
                                  ground_truth.normals[i]);
        for (const glm::dvec3& texel : tilted_texels)
            texels.push_back(degrees_of(basis * texel, expected * texel));
    }
    errors.normal = error_stats(normals);
    errors.tangent = error_stats(tangents);
    normals.insert(normals.end(), tangents.begin(), tangents.end());
    errors.both = error_stats(std::move(normals));
    errors.texel = error_stats(std::move(texels));
    return errors;
}

std::string FrameCode::rounding_name() const {
    return rounding == FrameRounding::nearest ? "nearest" : "best";
}

MeasuredMethod FrameCode::measured(const SampleFrames& frames) const {
    MeasuredMethod method;
    method.name = fmt::format("{}, {}", name_of(encoding), rounding_name());
    method.choices = {{"encoding", std::string(name_of(encoding))}, {"rounding", rounding_name()}};
    const FrameCodeErrors errors = frame_code_errors(frames, encoding, rounding);
    method.error = errors.both;
    method.stored_bytes = 4.0 * static_cast<double>(words_per_frame(encoding));
    if (errors.flipped_frames > 0)
        method.note = fmt::format("The handedness of {} frames changed.", errors.flipped_frames);
    return method;
}

std::vector<FrameCode> all_frame_codes() {
    std::vector<FrameCode> codes;
    for (const FrameEncoding encoding : all_frame_encodings) {
        codes.push_back({encoding, FrameRounding::nearest});
        if (encoding != FrameEncoding::float32) codes.push_back({encoding, FrameRounding::best});
    }
    return codes;
}

namespace {

/// "A frame of floats needs 28 bytes; in 4 bytes 'angle10, best' has the smallest error, ..."
std::string frame_code_finding(const Experiment& experiment) {
    std::vector<std::string> parts;
    for (const double bytes : {4.0, 8.0}) {
        const Measurement* best = nullptr;
        for (const Measurement& one : experiment.measurements) {
            if (one.cost.stored_bytes != bytes) continue;
            if (best == nullptr || one.error.rms < best->error.rms) best = &one;
        }
        if (best == nullptr) continue;
        parts.push_back(fmt::format(
            "in {} bytes '{}' has the smallest error, {:.2g} degrees RMS, {:.2g} at most", bytes,
            best->method, best->error.rms, best->error.max));
    }
    return fmt::format("A frame of floats needs 28 bytes; {}.", fmt::join(parts, "; "));
}

/// "Searching for the best codes changes ...: octahedral8 0.44 to 0.35 in 3 times the time"
std::string price_of_best(const Experiment& experiment, std::span<const FrameCode> codes) {
    std::vector<std::string> parts;
    const auto& all = experiment.measurements;
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        const bool is_pair = codes[i].rounding == FrameRounding::nearest &&
                             codes[i + 1].rounding == FrameRounding::best;
        if (!is_pair || all[i].cost.stored_bytes != 4.0) continue;
        std::string part = fmt::format("{} {:.2g} to {:.2g}", name_of(codes[i].encoding),
                                       all[i].error.rms, all[i + 1].error.rms);
        const double times = median_seconds(all[i + 1]) / median_seconds(all[i]);
        if (times > 0.0) part += fmt::format(" in {:.1f} times the time", times);
        parts.push_back(std::move(part));
    }
    return fmt::format(
        "Searching for the best codes changes the error in 4 bytes, degrees RMS: {}.",
        fmt::join(parts, "; "));
}

Experiment on_even_frames(std::size_t count) {
    Experiment experiment;
    experiment.subject = Subject::storage;
    experiment.ground_truth =
        "The frames in double before encoding, which are orthonormal by construction.";
    experiment.input = fmt::format("{} frames spread evenly over the sphere", count);
    experiment.error_unit = "degrees";
    experiment.item = "frame";
    experiment.items = static_cast<double>(count);
    return experiment;
}

std::size_t count_of(const RunOptions& options) {
    return options.is_quick ? 20000 : 200000;
}

}  // namespace

Experiment frame_reading_experiment(const RunOptions& options) {
    const SampleFrames frames = even_frames(count_of(options));
    Experiment experiment = on_even_frames(frames.normals.size());
    experiment.id = "storage/frames";
    experiment.question =
        "How many bytes does a tangent frame need, and how long does decoding take?";
    std::vector<MeasuredMethod> measured;
    for (const FrameCode& code : all_frame_codes()) {
        Report report;
        MeasuredMethod method = code.measured(frames);
        method.work = [encoding = code.encoding,
                       words = encode_frames(frames.float_normals, frames.float_tangents,
                                             code.encoding, code.rounding, report)] {
            Report ignored;
            decode_frames(words, encoding, ignored);
        };
        measured.push_back(std::move(method));
    }
    measure_methods(measured, options, {}, experiment);
    experiment.finding = frame_code_finding(experiment);
    return experiment;
}

Experiment frame_writing_experiment(const RunOptions& options) {
    const SampleFrames frames = even_frames(count_of(options));
    Experiment experiment = on_even_frames(frames.normals.size());
    experiment.id = "storage/frames-written";
    experiment.question =
        "How long does encoding tangent frames take, and does the search for the best codes pay "
        "off?";
    std::vector<MeasuredMethod> measured;
    const std::vector<FrameCode> codes = all_frame_codes();
    for (const FrameCode& code : codes) {
        MeasuredMethod method = code.measured(frames);
        method.work = [&frames, code] {
            Report ignored;
            encode_frames(frames.float_normals, frames.float_tangents, code.encoding, code.rounding,
                          ignored);
        };
        measured.push_back(std::move(method));
    }
    measure_methods(measured, options, {}, experiment);
    experiment.finding = price_of_best(experiment, codes);
    return experiment;
}

std::vector<Experiment> storage_experiments(const RunOptions& options) {
    const std::vector<PlannedExperiment> plan = {
        {"Normals in few bits", [&] { return normal_reading_experiment(options); }},
        {"A smooth surface in few bits, written",
         [&] { return normal_writing_experiment(options); }},
        {"Tangent frames in few bits", [&] { return frame_reading_experiment(options); }},
        {"Tangent frames in few bits, written", [&] { return frame_writing_experiment(options); }}};
    return run_planned(plan, options);
}

}  // namespace relief
