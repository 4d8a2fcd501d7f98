// SPDX-License-Identifier: Apache-2.0
// Each encoding of tangent frames on frames spread evenly over the sphere: how far normals and
// tangents are from where they were, and what reading and writing take. Tests:
// tests/accuracy/frame_codes_test.cpp.
#include <fmt/format.h>

#include "measured_methods.h"
#include "storage/frame_code_methods.h"
#include "storage/storage_experiments.h"

namespace relief {
namespace {

/// "in 4 bytes 'angle10, best' has the least error, 0.08 degrees RMS, 0.21 at most; ..."
std::string frame_code_finding(const Experiment& experiment) {
    std::vector<std::string> parts;
    for (const double bytes : {4.0, 8.0}) {
        const Measurement* best = nullptr;
        for (const Measurement& one : experiment.measurements) {
            if (one.cost.stored_bytes != bytes) continue;
            if (best == nullptr || one.error.rms < best->error.rms) best = &one;
        }
        if (best == nullptr) continue;
        parts.push_back(
            fmt::format("in {} bytes '{}' has the least error, {:.2g} degrees RMS, {:.2g} at most",
                        bytes, best->method, best->error.rms, best->error.max));
    }
    return fmt::format("A frame of floats takes 28 bytes; {}.", fmt::join(parts, "; "));
}

/// "Searching for the best codes changes ...: octahedral8 0.44 to 0.35 and takes 3 times as long"
std::string price_of_best(const Experiment& experiment) {
    std::vector<std::string> parts;
    const auto& all = experiment.measurements;
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        const bool is_pair =
            value_of(all[i], "rounding") == "nearest" && value_of(all[i + 1], "rounding") == "best";
        if (!is_pair || all[i].cost.stored_bytes != 4.0) continue;
        std::string part = fmt::format("{} {:.2g} to {:.2g}", value_of(all[i], "encoding"),
                                       all[i].error.rms, all[i + 1].error.rms);
        const double times = median_seconds(all[i + 1]) / median_seconds(all[i]);
        if (times > 0.0) part += fmt::format(" and takes {:.1f} times as long", times);
        parts.push_back(std::move(part));
    }
    return fmt::format(
        "Searching for the best codes changes the error in 4 bytes, degrees RMS: {}.",
        fmt::join(parts, "; "));
}

Experiment on_even_frames(std::size_t count) {
    Experiment experiment;
    experiment.subject = Subject::storage;
    experiment.truth =
        "The frames in double, before they were stored: perpendicular and unit by construction.";
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
    experiment.question = "How many bytes does a tangent frame need, and what does reading take?";
    std::vector<MeasuredMethod> measured;
    for (const FrameCode& code : all_frame_codes()) {
        Report report;
        MeasuredMethod method = code.measured(frames);
        method.work = [encoding = code.encoding,
                       words = encode_frames(frames.float_normals, frames.float_tangents,
                                             code.encoding, code.rounding, report)] {
            Report found;
            decode_frames(words, encoding, found);
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
        "What does writing tangent frames take, and is looking for the best "
        "codes worth it?";
    std::vector<MeasuredMethod> measured;
    for (const FrameCode& code : all_frame_codes()) {
        MeasuredMethod method = code.measured(frames);
        method.work = [&frames, code] {
            Report found;
            encode_frames(frames.float_normals, frames.float_tangents, code.encoding, code.rounding,
                          found);
        };
        measured.push_back(std::move(method));
    }
    measure_methods(measured, options, {}, experiment);
    experiment.finding = price_of_best(experiment);
    return experiment;
}

}  // namespace relief
