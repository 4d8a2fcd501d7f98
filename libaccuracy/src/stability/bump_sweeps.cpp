// SPDX-License-Identifier: Apache-2.0
// Normals of a wave that grows ever steeper, and that lies ever higher. Tests:
// tests/accuracy/stability_experiments_test.cpp.
#include <fmt/format.h>

#include <functional>

#include "analytic_words.h"
#include "bump/bump_methods.h"
#include "map_errors.h"
#include "stability/plain_code.h"
#include "stability/stability_plan.h"
#include "stability/sweep.h"

namespace relief {
namespace {

constexpr double swept_wavelength = 32.0;

/// One way from heights to unit normals.
struct SlopeMethod {
    std::string name;
    std::vector<std::pair<std::string, std::string>> choices;
    std::function<Image(const WaveMap& wave)> normals;
};

SlopeMethod by_kernel(Kernel kernel, Arithmetic arithmetic) {
    const std::string name = name_of(kernel, 0);
    return {fmt::format("{}, {}", name, word_of(arithmetic)),
            {{"kernel", name}, {"arithmetic", word_of(arithmetic)}},
            [=](const WaveMap& wave) {
                BumpOptions options = wave.options;
                options.kernel = kernel;
                options.arithmetic = arithmetic;
                Report report;
                return normals_from_height(wave.heights, options, report);
            }};
}

std::vector<SlopeMethod> swept_slope_methods() {
    std::vector<SlopeMethod> methods;
    for (const Kernel kernel : {Kernel::sobel3, Kernel::central7}) {
        for (const Arithmetic arithmetic : {Arithmetic::float64, Arithmetic::float32})
            methods.push_back(by_kernel(kernel, arithmetic));
    }
    methods.push_back({"plain sobel3",
                       {{"kernel", "sobel3"}, {"arithmetic", "float32"}},
                       [](const WaveMap& wave) {
                           return plain_sobel_normals(wave.heights,
                                                      static_cast<float>(wave.options.strength));
                       }});
    return methods;
}

int map_side(const RunOptions& options) {
    return (options.is_quick ? 64 : 192) + 2 * wave_margin;
}

std::vector<float> slope_degrees(const SlopeMethod& method, const WaveMap& wave) {
    return inner_angles(method.normals(wave), wave.normals, wave_margin);
}

/// The same heights, standing for so many times as much.
WaveMap steeper(WaveMap wave, double times) {
    wave.options.strength *= times;
    for (glm::dvec3& normal : wave.normals)
        normal = glm::normalize(normal * glm::dvec3(times, times, 1.0));
    return wave;
}

/// The same heights over another zero; added in double, and then rounded to float as any file
/// would.
WaveMap higher(WaveMap wave, double by) {
    for (float& texel : wave.heights.as<float>())
        texel = static_cast<float>(double{texel} + by);
    return wave;
}

/// A measurement of each method: errors of the sweeps, time on `wave`.
void measure_slopes(const std::vector<SlopeMethod>& methods, const Sweeps& sweeps,
                    const WaveMap& wave, const RunOptions& options, Experiment& experiment) {
    std::vector<MeasuredMethod> measured;
    for (const SlopeMethod& method : methods) {
        measured.push_back({.name = method.name,
                            .choices = method.choices,
                            .error = {},
                            .work = [&wave, normals = method.normals] { normals(wave); }});
    }
    experiment.item = "texel";
    experiment.items = static_cast<double>(wave.normals.size());
    measure_swept(std::move(measured), sweeps, options, experiment);
}

}  // namespace

Experiment bump_by_steepness(const RunOptions& options) {
    const WaveMap wave = oblique_wave(map_side(options), swept_wavelength, 32);
    const std::vector<SlopeMethod> methods = swept_slope_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    sweeps.add("steeper", "Steeper", "slope", 30, 2, [&](std::size_t method, double value) {
        return slope_degrees(methods[method], steeper(wave, value));
    });
    sweeps.add("flatter", "Flatter", "1 / slope", 30, 2, [&](std::size_t method, double value) {
        return slope_degrees(methods[method], steeper(wave, 1.0 / value));
    });
    Experiment experiment{
        .id = "stability/bump-steepness",
        .question = "How steep or flat may a height map be, before its normals are wrong?",
        .truth =
            "the wave's slopes in closed form, times the same factor; tests differentiate it "
            "numerically as well",
        .input = fmt::format("{0} x {0} texels of a wave {1} texels long, at 31 slopes from 1e-30 "
                             "to 1e30; errors of all together, times at slope 1",
                             map_side(options), swept_wavelength)};
    measure_slopes(methods, sweeps, wave, options, experiment);
    return experiment;
}

Experiment bump_by_offset(const RunOptions& options) {
    const WaveMap wave = oblique_wave(map_side(options), swept_wavelength, 32);
    const std::vector<SlopeMethod> methods = swept_slope_methods();
    Sweeps sweeps(names_of(methods), broken_degrees);
    sweeps.add("offset", "Higher", "height above zero, texels", 8, 1,
               [&](std::size_t method, double value) {
                   return slope_degrees(methods[method], higher(wave, value));
               });
    Experiment experiment{
        .id = "stability/bump-offset",
        .question = "How far above zero may heights lie, before their normals are wrong?",
        .truth =
            "the wave's slopes in closed form, which its zero does not change; tests "
            "differentiate it numerically as well",
        .input =
            fmt::format("{0} x {0} texels of a wave {1} texels long and 10 high, slope 1, at 9 "
                        "heights from 1 to 1e8; errors of all together, times at 0",
                        map_side(options), swept_wavelength)};
    measure_slopes(methods, sweeps, wave, options, experiment);
    experiment.finding +=
        " What double errs is what rounding these heights to float has done, which no method can "
        "undo: store heights from their own zero.";
    return experiment;
}

}  // namespace relief
