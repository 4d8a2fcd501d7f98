// SPDX-License-Identifier: Apache-2.0
// measure_bump() for the errors, one thread and all for the times. Tests:
// tests/accuracy/own_maps_test.cpp.
#include <fmt/format.h>

#include <array>

#include "analytic_words.h"
#include "bump/bump_words.h"
#include "own/own_experiment.h"
#include "relief/accuracy/own.h"
#include "relief/mesh/destaircase.h"
#include "relief/mesh/height_statistics.h"

namespace relief {
namespace {

constexpr std::array arithmetics_tried = {Arithmetic::float32, Arithmetic::float64};

/// The conversion as it is done, on all parts.
std::function<void()> work_of(const BumpMethod& method, const BumpSample& sample,
                              BumpOptions bump) {
    bump.kernel = method.kernel;
    bump.gaussian_radius = method.gaussian_radius;
    bump.arithmetic = method.arithmetic;
    NormalMapFormat format;
    format.bits = method.bits;
    return [=, &sample, map = Image()]() mutable {
        Report ignored;
        for (const Image& part : sample.measured) {
            if (method.destaircased) {
                normal_map_from_height(destaircase(part, {.wrap = *bump.wrap}).heights, bump,
                                       format, map, ignored);
            } else {
                normal_map_from_height(part, bump, format, map, ignored);
            }
        }
    };
}

std::string command_of(const BumpMethod& method, const BumpOptions& bump,
                       const OwnOptions& options) {
    std::string command =
        fmt::format("relief-bake bump {} OUT.{} --strength {:g} --kernel {}", options.arguments,
                    method.bits == 32 ? "exr" : "png", bump.strength, word_of(method.kernel));
    if (method.kernel == Kernel::gaussian)
        command += fmt::format(" --kernel-radius {}", method.gaussian_radius);
    command += " --precision " + word_of(method.arithmetic);
    if (method.bits != 32) command += fmt::format(" --bits {}", method.bits);
    if (method.destaircased) command += " --destaircase";
    return command + " --wrap " + words_of(*bump.wrap) + options.height_arguments;
}

/// Steps are smoothed away where there are any; one arithmetic and depth shows what that does.
std::vector<BumpMethod> methods_for(const KernelChoice& choice, const OwnOptions& options) {
    constexpr int most_bits_with_steps = 12;
    const int radius = best_gaussian_radius(choice);
    const std::array as_is = {false};
    std::vector<BumpMethod> methods =
        bump_methods(radius, options.map_bits, arithmetics_tried, as_is);
    const bool has_steps = choice.depth.bits > 0 && choice.depth.bits <= most_bits_with_steps;
    if (!has_steps || !options.smooths_steps) return methods;
    const std::array smooth = {true};
    for (const BumpMethod& method :
         bump_methods(radius, std::array{16}, std::array{Arithmetic::float32}, smooth))
        methods.push_back(method);
    return methods;
}

}  // namespace

OwnExperiment measure_own_heights(const BumpSample& sample, glm::ivec2 size,
                                  const BumpOptions& bump, const OwnOptions& options) {
    OwnExperiment own = own_experiment(Subject::bump, "bump", "Normals from heights", options);
    const KernelChoice choice = choose_kernel(sample.looked_at, bump);
    const std::vector<BumpMethod> methods = methods_for(choice, options);
    BumpExperimentOptions how;
    how.bump = bump;
    how.repeats = {0, 0};
    const BumpExperiment found = measure_bump(sample, methods, how);
    Experiment& experiment = own.experiment;
    experiment.question = "Which kernel is truest on this map, and what does it cost?";
    experiment.truth =
        fmt::format("The map's own best: {}. {}.", found.reference.words, choice.reason);
    experiment.reference_error = found.reference.own_degrees;
    experiment.input = found.is_whole ? fmt::format("{} x {} texels", size.x, size.y)
                                      : fmt::format("{} texels in nine parts of {} x {}",
                                                    found.texels, size.x, size.y);
    experiment.item = "texel";
    experiment.items = static_cast<double>(found.texels);
    std::vector<OwnMethod> measured;
    for (const BumpMeasurement& one : found.measurements) {
        measured.push_back({measured_method(one.method, figures_of(one.error)),
                            command_of(one.method, bump, options)});
        measured.back().measured.work = work_of(one.method, sample, bump);
        measured.back().natural_cost = cost_of(one.method);
    }
    finish(own, std::move(measured), {.reference = "the map itself"}, options);
    return own;
}

OwnExperiment measure_own_heights(const Image& height, const BumpOptions& bump,
                                  const OwnOptions& options, std::int64_t most_texels) {
    BumpOptions with_wrap = bump;
    if (!bump.wrap) with_wrap.wrap = detect_tiling(height).wraps();
    return measure_own_heights(sample_of(height, most_texels), {height.width, height.height},
                               with_wrap, options);
}

}  // namespace relief
