// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/bump_methods_test.cpp.
#include "bump/bump_methods.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "map_errors.h"
#include "relief/mesh/error.h"

namespace relief {

std::span<const NamedKernel> named_kernels() {
    static const std::array kernels = {NamedKernel{"forward", Kernel::forward, 2},
                                       NamedKernel{"central3", Kernel::central3, 2},
                                       NamedKernel{"prewitt3", Kernel::prewitt3, 2},
                                       NamedKernel{"sobel3", Kernel::sobel3, 2},
                                       NamedKernel{"scharr3", Kernel::scharr3, 2},
                                       NamedKernel{"sobel5", Kernel::sobel5, 2},
                                       NamedKernel{"scharr5", Kernel::scharr5, 2},
                                       NamedKernel{"central5", Kernel::central5, 2},
                                       NamedKernel{"central7", Kernel::central7, 2},
                                       NamedKernel{"gaussian 2", Kernel::gaussian, 2},
                                       NamedKernel{"gaussian 4", Kernel::gaussian, 4},
                                       NamedKernel{"gaussian 8", Kernel::gaussian, 8},
                                       NamedKernel{"gaussian 16", Kernel::gaussian, 16}};
    return kernels;
}

std::string name_of(Kernel kernel, int gaussian_radius) {
    for (const NamedKernel& named : named_kernels()) {
        if (named.kernel == kernel && kernel != Kernel::gaussian) return named.name;
    }
    return fmt::format("gaussian {}", gaussian_radius);
}

double rms_error(const BumpField& field, Kernel kernel, int gaussian_radius) {
    BumpOptions options = field.options;
    options.kernel = kernel;
    options.gaussian_radius = gaussian_radius;
    options.arithmetic = Arithmetic::float64;
    Report report;
    return field_error(normals_from_height(field.heights, options, report), field).rms;
}

const FieldRecipe& recipe_named(const std::string& name) {
    for (const auto& set : {tuning_fields(), judging_fields()}) {
        for (const FieldRecipe& recipe : set) {
            if (name == recipe.name) return recipe;
        }
    }
    throw InvalidInput("there is no field " + name);
}

WaveMap oblique_wave(int side, double wavelength, int bits) {
    const double steepness = 2.0 * std::numbers::pi / wavelength;
    const HeightWave wave{1.0 / steepness, steepness * glm::dvec2(2.0, 1.0) / std::sqrt(5.0), 0.7};
    AnalyticHeights field = wave_heights(side, side, std::span(&wave, 1));
    WaveMap map;
    map.options.wrap = Wrap::clamp;
    map.options.strength = 1.0;
    map.normals = std::move(field.normals);
    if (bits == 32) {
        map.heights = std::move(field.heights);
    } else {
        CodedHeights coded = coded_heights(field.heights, bits);
        map.options.strength = coded.strength;
        map.heights = std::move(coded.codes);
    }
    return map;
}

AngleDistribution wave_errors(const WaveMap& wave, const NamedKernel& kernel,
                              Arithmetic arithmetic) {
    BumpOptions options = wave.options;
    options.kernel = kernel.kernel;
    options.gaussian_radius = kernel.radius;
    options.arithmetic = arithmetic;
    Report report;
    const int margin = options.wrap == Wraps(Wrap::repeat) ? 0 : wave_margin;
    return map_errors(normals_from_height(wave.heights, options, report), wave.normals, margin);
}

WaveMap surface_at(int side) {
    constexpr int coarsest = 64;
    constexpr std::uint32_t seed = 5;
    const double scale = static_cast<double>(side) / coarsest;
    std::vector<HeightWave> waves = tiling_waves(coarsest, coarsest, 8, 8.0, 0.3, seed);
    for (HeightWave& wave : waves) {
        wave.frequency /= scale;
        wave.amplitude *= scale;
    }
    AnalyticHeights field = wave_heights(side, side, waves);
    WaveMap map;
    map.heights = std::move(field.heights);
    map.options.strength = 1.0;
    map.normals = std::move(field.normals);
    return map;
}

}  // namespace relief
