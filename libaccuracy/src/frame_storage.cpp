// SPDX-License-Identifier: Apache-2.0
// Encodes evenly spread tangent frames with every frame encoding and compares the decoded frames
// with the frames in double.
#include "storage_experiments.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "experiment_driver.h"
#include "experiment_parts.h"
#include "relief/mesh/statistics.h"

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

ExperimentMethod FrameCode::method(std::shared_ptr<const SampleFrames> frames) const {
    return {
        .name = fmt::format("{}, {}", name_of(encoding), rounding_name()),
        .choices = {{"encoding", std::string(name_of(encoding))}, {"rounding", rounding_name()}},
        .error =
            [code = *this, frames = std::move(frames)] {
                const FrameCodeErrors errors =
                    frame_code_errors(*frames, code.encoding, code.rounding);
                return MethodError(errors.both,
                                   errors.flipped_frames == 0
                                       ? ""
                                       : fmt::format("The handedness of {} frames changed.",
                                                     errors.flipped_frames));
            },
        .stored_bytes = 4.0 * static_cast<double>(words_per_frame(encoding))};
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

/// All codes on the same frames.
PreparedExperiment on_even_frames(std::shared_ptr<const SampleFrames> frames) {
    PreparedExperiment prepared;
    prepared.report = {
        .ground_truth =
            "The frames in double before encoding, which are orthonormal by construction.",
        .input = fmt::format("{} frames spread evenly over the sphere", frames->normals.size()),
        .error_unit = "degrees",
        .item = "frame",
        .items = static_cast<double>(frames->normals.size())};
    for (const FrameCode& code : all_frame_codes()) {
        prepared.methods.push_back(code.method(frames));
        prepared.methods.back().id = method_id(prepared.methods.size() - 1);
    }
    return prepared;
}

std::shared_ptr<const SampleFrames> sampled_frames(bool is_quick) {
    return std::make_shared<const SampleFrames>(even_frames(is_quick ? 20000 : 200000));
}

PreparedExperiment frame_reading_experiment(bool is_quick) {
    const auto frames = sampled_frames(is_quick);
    PreparedExperiment prepared = on_even_frames(frames);
    prepared.report.question =
        "How many bytes does a tangent frame need, and how long does decoding take?";
    const std::vector<FrameCode> codes = all_frame_codes();
    for (std::size_t i = 0; i < codes.size(); ++i) {
        Report ignored;
        prepared.methods[i].work = [encoding = codes[i].encoding,
                                    words = encode_frames(frames->float_normals,
                                                          frames->float_tangents, codes[i].encoding,
                                                          codes[i].rounding, ignored)] {
            Report report;
            decode_frames(words, encoding, report);
        };
    }
    prepared.finish = [](Experiment& report) { report.finding = frame_code_finding(report); };
    return prepared;
}

PreparedExperiment frame_writing_experiment(bool is_quick) {
    const auto frames = sampled_frames(is_quick);
    PreparedExperiment prepared = on_even_frames(frames);
    prepared.report.question =
        "How long does encoding tangent frames take, and does the search for the best codes pay "
        "off?";
    const std::vector<FrameCode> codes = all_frame_codes();
    for (std::size_t i = 0; i < codes.size(); ++i) {
        prepared.methods[i].work = [frames, code = codes[i]] {
            Report ignored;
            encode_frames(frames->float_normals, frames->float_tangents, code.encoding,
                          code.rounding, ignored);
        };
    }
    prepared.finish = [codes](Experiment& report) {
        report.finding = price_of_best(report, codes);
    };
    return prepared;
}

}  // namespace

std::vector<PlannedExperiment> storage_plan(const PlanOptions& options) {
    const bool is_quick = options.is_quick;
    return {{"storage/normals", Subject::storage, "Normals in few bits",
             [is_quick] { return normal_reading_experiment(is_quick); }},
            {"storage/smooth-surface", Subject::storage, "A smooth surface in few bits, written",
             normal_writing_experiment},
            {"storage/frames", Subject::storage, "Tangent frames in few bits",
             [is_quick] { return frame_reading_experiment(is_quick); }},
            {"storage/frames-written", Subject::storage, "Tangent frames in few bits, written",
             [is_quick] { return frame_writing_experiment(is_quick); }}};
}

}  // namespace relief
