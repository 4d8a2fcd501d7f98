// SPDX-License-Identifier: Apache-2.0
// Ways to bake held against one truth, in turns; clocks are those of BakeTrials.
// Tests: tests/accuracy/own_bake_test.cpp.
#include <fmt/format.h>

#include <glm/trigonometric.hpp>

#include "own/own_experiment.h"
#include "progress_stage.h"
#include "relief/accuracy/own.h"
#include "relief/mesh/bake_trials.h"

namespace relief {
namespace {

constexpr std::size_t texels_looked_at = std::size_t{1} << 16;
/// Nobody sees less.
constexpr double unseen_degrees = 0.01;

/// How many rays a texel gets.
struct SampleWay {
    int samples = 1;
    std::optional<double> angle;  ///< Degrees; `samples` only where the first differ by more.

    [[nodiscard]] std::string words() const {
        return angle ? fmt::format("auto {:g}", *angle) : fmt::format("{}", samples);
    }
};

const std::vector<SampleWay>& sample_ways() {
    static const std::vector<SampleWay> ways = {{1, {}},   {4, {}},   {16, {}}, {64, {}},
                                                {16, 8.0}, {16, 2.0}, {16, 0.5}};
    return ways;
}

std::vector<NormalMapFormat> map_formats() {
    std::vector<NormalMapFormat> formats(4);
    formats[0].bits = formats[1].bits = 8;
    formats[1].dither = Dither::blue_noise;
    formats[2].bits = 16;
    formats[3].bits = 32;
    return formats;
}

OwnMethod method_of(const SampleWay& way, const NormalMapFormat& format, int size,
                    const OwnOptions& options) {
    const bool is_dithered = format.dither != Dither::none;
    const std::string depth = fmt::format("{} bit", format.bits);
    OwnMethod method;
    method.measured.name =
        fmt::format("{} {}, {}{}", way.words(), way.words() == "1" ? "sample" : "samples", depth,
                    is_dithered ? ", dithered" : "");
    method.measured.choices = {{"samples", way.words()},
                               {"depth", depth},
                               {"dither", is_dithered ? "blue-noise" : "none"}};
    method.measured.stored_bytes = 3.0 * format.bits / 8.0;
    method.command =
        fmt::format("relief-bake mesh {} OUT.{} --size {} --samples {}{}{}{}", options.arguments,
                    format.bits == 32 ? "exr" : "png", size, way.angle ? "auto" : way.words(),
                    way.angle ? fmt::format(" --sample-angle {:g}", *way.angle) : "",
                    format.bits == 32 ? "" : fmt::format(" --bits {}", format.bits),
                    is_dithered ? " --dither blue-noise" : "");
    return method;
}

/// Errors and seconds of all ways in all formats.
struct Measured {
    std::vector<AngleSummary> errors;
    std::vector<Timing> times;
};

Measured measure(const BakeTrials& trials, const std::vector<NormalMapFormat>& formats,
                 const OwnOptions& options) {
    const std::vector<SampleWay>& ways = sample_ways();
    Measured all;
    all.errors.resize(ways.size() * formats.size());
    all.times.resize(all.errors.size());
    const Repeats repeats =
        options.run.is_timed ? Repeats{options.run.repeats.counted, 0} : Repeats{1, 0};
    interleave(ways.size(), repeats, [&](std::size_t way, bool) {
        check_cancelled();
        std::optional<double> angle;
        if (ways[way].angle) angle = glm::radians(*ways[way].angle);
        const BakeTrial trial = trials.measure(ways[way].samples, angle, formats);
        for (std::size_t f = 0; f < formats.size(); ++f) {
            const std::size_t i = way * formats.size() + f;
            all.errors[i] = trial.errors[f];
            all.times[i].rounds.push_back(trial.cast_seconds + trial.code_seconds[f]);
        }
    });
    return all;
}

}  // namespace

OwnExperiment measure_own_bake(const Baker& baker, int size, const OwnOptions& options) {
    OwnExperiment own = own_experiment(Subject::bake, "bake", "Baked normals", options);
    BakeMapOptions map;
    map.width = size;
    map.height = size;
    const BakeTrials trials(baker, map, texels_looked_at);
    const std::vector<NormalMapFormat> formats = map_formats();
    const Measured measured = measure(trials, formats, options);
    Experiment& experiment = own.experiment;
    experiment.question = "How many samples and bits does a map of these meshes need?";
    experiment.truth = fmt::format(
        "The mean of {} samples a texel of the high mesh's normals, in the low mesh's tangent "
        "space: what a map of this size can show at best. It says nothing of what a larger map "
        "would show, nor whether the rays find the right surface.",
        trials.reference_samples());
    experiment.input =
        fmt::format("{} x {} texels{}; {} triangles of the low mesh", size, size,
                    trials.is_whole() ? "" : fmt::format(", {} of them", trials.texels()),
                    baker.low().triangles.size());
    experiment.item = "texel";
    experiment.items = static_cast<double>(trials.texels());
    std::vector<OwnMethod> methods;
    for (std::size_t i = 0; i < measured.errors.size(); ++i) {
        methods.push_back(method_of(sample_ways()[i / formats.size()], formats[i % formats.size()],
                                    size, options));
        methods.back().measured.error = figures_of(measured.errors[i]);
        if (options.run.is_timed) methods.back().known_time = measured.times[i];
    }
    finish(own, std::move(methods), CostKind::time, unseen_degrees, options);
    return own;
}

}  // namespace relief
