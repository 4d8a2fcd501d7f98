// SPDX-License-Identifier: Apache-2.0
// A torus of few to many triangles, lit for each triangle, each vertex or each pixel
// [Gouraud 1971], [Phong 1975], against the smooth torus. Tests:
// tests/accuracy/shading_experiments_test.cpp.
#include <fmt/format.h>

#include <array>

#include "drawn/lit_scene.h"
#include "drawn/many_samples.h"
#include "drawn/refined_torus.h"
#include "measured_methods.h"
#include "relief/mesh/shapes.h"
#include "shading/shading_plan.h"

namespace relief {
namespace {

struct LightingChoice {
    const char* name;
    Interpolation interpolation;
};
constexpr std::array lighting_choices = {LightingChoice{"flat", Interpolation::flat},
                                         LightingChoice{"Gouraud", Interpolation::gouraud},
                                         LightingChoice{"Phong", Interpolation::per_pixel}};
/// Around the tube's circle; half as many around the tube.
constexpr std::array lighting_slices = {12, 24, 48, 96, 192};

Scene lit_torus(int around, Interpolation interpolation) {
    Material material = glossy_plastic();
    material.interpolation = interpolation;
    Scene scene = lit_scene(make_torus(0.4F, around, around / 2), material);
    scene.camera = torus_camera();
    return scene;
}

std::vector<DrawnMethod> interpolation_methods() {
    std::vector<DrawnMethod> all;
    for (const LightingChoice& choice : lighting_choices) {
        for (const int around : lighting_slices) {
            all.push_back(
                {name_on_torus(choice.name, around),
                 {{"lit", choice.name}, {"triangles", fmt::format("{}", torus_triangles(around))}},
                 lit_torus(around, choice.interpolation)});
        }
    }
    return all;
}

std::string interpolation_finding(const Experiment& experiment) {
    const auto at = [&](std::size_t choice, int around) -> const Measurement& {
        return method_in(experiment, name_on_torus(lighting_choices.at(choice).name, around));
    };
    return fmt::format(
               "With {} triangles, flat shading is off by FLIP {:.3f} (RMS), Gouraud's by {:.3f} "
               "and Phong's by {:.3f}; Gouraud's needs {} triangles to come to {:.3f}.",
               torus_triangles(24), at(0, 24).error.rms, at(1, 24).error.rms, at(2, 24).error.rms,
               torus_triangles(96), at(1, 96).error.rms) +
           frame_times({{"flat", at(0, 24)}, {"Gouraud", at(1, 24)}, {"Phong", at(2, 24)}});
}

}  // namespace

Experiment interpolation_experiment(const Drawing& drawing, const RunOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    Experiment experiment{
        .id = "shading/interpolation",
        .question =
            "How many triangles does it take until it no longer shows where light is "
            "computed?",
        .truth = fmt::format(
            "the reference shader in double on a torus of {} triangles with the true normals, one "
            "ray through the centre of each pixel; a test holds that shader to the closed form of "
            "a lit sphere",
            torus_triangles(smooth_torus_slices)),
        .input = fmt::format("torus with a highlight of shininess 40, {0} x {0} pixels", size),
        .error_unit = "FLIP",
        .item = "pixel",
        .items = static_cast<double>(size) * size};
    if (!drawing.is_possible_for(experiment)) return experiment;
    const Image truth =
        many_samples(lit_torus(smooth_torus_slices, Interpolation::per_pixel), size, 1);
    const std::vector<DrawnMethod> all = interpolation_methods();
    const std::vector<DrawnPicture> pictures =
        measure_drawn(drawing, all, truth, options, experiment);
    std::vector<std::string> ways;
    for (const LightingChoice& choice : lighting_choices)
        ways.emplace_back(choice.name);
    experiment.charts = {torus_chart(experiment, ways, lighting_slices)};
    for (std::size_t i = 1; i < all.size(); i += lighting_slices.size()) {
        experiment.pictures.push_back(
            pair_of("Where light is computed", all[i].name, pictures[i].picture, truth));
        experiment.heat_maps.push_back({"Where it is seen", all[i].name, pictures[i].errors, 0.5});
    }
    experiment.finding = interpolation_finding(experiment);
    return experiment;
}

}  // namespace relief
