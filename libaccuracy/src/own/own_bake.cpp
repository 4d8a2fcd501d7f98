// SPDX-License-Identifier: Apache-2.0
// Ways to bake held against one truth, in turns; clocks are those of BakeTrials.
// Tests: tests/accuracy/own_bake_test.cpp.
#include <fmt/format.h>

#include "own/own_experiment.h"
#include "relief/accuracy/own.h"
#include "relief/mesh/bake_trials.h"

namespace relief {
namespace {

constexpr std::size_t texels_looked_at = std::size_t{1} << 16;

std::string samples_words(const BakeWay& way) {
    return way.sample_degrees ? fmt::format("auto {:g}", *way.sample_degrees)
                              : fmt::format("{}", way.samples);
}

OwnMethod method_of(const BakeWay& way, const NormalMapFormat& format, int size,
                    const OwnOptions& options) {
    const bool is_dithered = format.dither != Dither::none;
    const std::string depth = fmt::format("{} bit", format.bits);
    OwnMethod method;
    method.measured.name = fmt::format("{} {}, {}{}", samples_words(way),
                                       samples_words(way) == "1" ? "sample" : "samples", depth,
                                       is_dithered ? ", dithered" : "");
    method.measured.choices = {{"samples", samples_words(way)},
                               {"depth", depth},
                               {"dither", is_dithered ? "blue-noise" : "none"}};
    method.measured.stored_bytes = 3.0 * format.bits / 8.0;
    method.command = fmt::format(
        "relief-bake mesh {} OUT.{} --size {} --samples {}{}{}{}", options.arguments,
        format.bits == 32 ? "exr" : "png", size, way.sample_degrees ? "auto" : samples_words(way),
        way.sample_degrees ? fmt::format(" --sample-angle {:g}", *way.sample_degrees) : "",
        format.bits == 32 ? "" : fmt::format(" --bits {}", format.bits),
        is_dithered ? " --dither blue-noise" : "");
    return method;
}

}  // namespace

OwnExperiment measure_own_bake(const Baker& baker, int size, const OwnOptions& options) {
    OwnExperiment own = own_experiment(Subject::bake, "bake", "Baked normals", options);
    BakeMapOptions map;
    map.width = size;
    map.height = size;
    const BakeTrials trials(baker, map, texels_looked_at);
    const std::span<const BakeWay> ways = usual_bake_ways();
    const std::vector<NormalMapFormat> formats = usual_map_formats({});
    const Repeats repeats{options.run.is_timed ? options.run.repeats.counted : 1, 0};
    const std::vector<TimedBakeTrial> found = measured_in_turns(trials, ways, formats, repeats);
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
    for (std::size_t way = 0; way < ways.size(); ++way) {
        for (std::size_t f = 0; f < formats.size(); ++f) {
            methods.push_back(method_of(ways[way], formats[f], size, options));
            methods.back().measured.error = figures_of(found[way].trial.errors[f]);
            if (options.run.is_timed) methods.back().known_time = Timing{found[way].seconds[f]};
        }
    }
    finish(own, std::move(methods), {CostKind::time, unseen_degrees}, options);
    return own;
}

}  // namespace relief
