// SPDX-License-Identifier: Apache-2.0
// A torus of few to many triangles, lit for each triangle, each vertex or each pixel
// [Gouraud 1971], [Phong 1975], against the smooth torus. Tests:
// tests/accuracy/shading_experiments_test.cpp.
#include <fmt/format.h>

#include <array>

#include "drawn/lit_scene.h"
#include "drawn/many_samples.h"
#include "drawn/picture_error.h"
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
constexpr std::array slices = {12, 24, 48, 96, 192};
constexpr int true_slices = 768;

std::size_t triangles_of(int around) {
    return static_cast<std::size_t>(around) * static_cast<std::size_t>(around);
}

std::string name_of(const LightingChoice& choice, int around) {
    return fmt::format("{}, {} triangles", choice.name, triangles_of(around));
}

Scene lit_torus(int around, Interpolation interpolation) {
    Material material = glossy_plastic();
    material.interpolation = interpolation;
    Scene scene = lit_scene(make_torus(0.4F, around, around / 2), material);
    // The camera is that of the smooth one: coarse ones are a little smaller.
    scene.camera = lit_scene(make_torus(), material).camera;
    return scene;
}

std::vector<DrawnMethod> interpolation_methods() {
    std::vector<DrawnMethod> all;
    for (const LightingChoice& choice : lighting_choices) {
        for (const int around : slices) {
            all.push_back(
                {name_of(choice, around),
                 {{"lit", choice.name}, {"triangles", fmt::format("{}", triangles_of(around))}},
                 lit_torus(around, choice.interpolation)});
        }
    }
    return all;
}

Chart chart_of(const Experiment& experiment) {
    Chart chart{.id = "triangles",
                .title = "Error by triangles",
                .x_label = "triangles",
                .y_label = "FLIP"};
    for (const LightingChoice& choice : lighting_choices) {
        Curve curve{.method = choice.name};
        for (const int around : slices) {
            curve.points.push_back({static_cast<double>(triangles_of(around)),
                                    method_in(experiment, name_of(choice, around)).error.rms});
        }
        curve.order = fitted_order(curve.points);
        chart.curves.push_back(std::move(curve));
    }
    return chart;
}

std::string interpolation_finding(const Experiment& experiment) {
    const auto at = [&](std::size_t choice, int around) -> const Measurement& {
        return method_in(experiment, name_of(lighting_choices.at(choice), around));
    };
    return fmt::format(
        "With {} triangles, flat shading is off by FLIP {:.3f} (RMS), Gouraud's by {:.3f} and "
        "Phong's by {:.3f}; Gouraud's needs {} triangles to come to {:.3f}. Frames took {}, {} and "
        "{}.",
        triangles_of(24), at(0, 24).error.rms, at(1, 24).error.rms, at(2, 24).error.rms,
        triangles_of(96), at(1, 96).error.rms, frame_words(at(0, 24)), frame_words(at(1, 24)),
        frame_words(at(2, 24)));
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
            triangles_of(true_slices)),
        .input = fmt::format("torus with a highlight of shininess 40, {0} x {0} pixels", size),
        .error_unit = "FLIP",
        .item = "pixel",
        .items = static_cast<double>(size) * size};
    if (!drawing.is_possible_for(experiment)) return experiment;
    const Image truth = many_samples(lit_torus(true_slices, Interpolation::per_pixel), size, 1);
    const std::vector<DrawnMethod> all = interpolation_methods();
    const std::vector<DrawnPicture> pictures =
        measure_drawn(drawing, all, truth, options, experiment);
    experiment.charts = {chart_of(experiment)};
    for (std::size_t i = 1; i < all.size(); i += slices.size()) {
        experiment.pictures.push_back(
            pair_of("Where light is computed", all[i].name, pictures[i].picture, truth));
        experiment.heat_maps.push_back({"Where it is seen", all[i].name, pictures[i].errors, 0.5});
    }
    experiment.finding = interpolation_finding(experiment);
    return experiment;
}

}  // namespace relief
