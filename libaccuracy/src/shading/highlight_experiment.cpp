// SPDX-License-Identifier: Apache-2.0
// Highlights of Phong's and Blinn's models, as bright and as wide as those of a rough metal (GGX),
// which they stand for. A facet distribution of alpha is nearly Blinn's lobe of exponent
// 2 / alpha^2 - 2, times (exponent + 2) / 8 at normal incidence [Hoffman 2013]; Phong's lobe is as
// wide with a quarter of the exponent [Blinn 1977]. Tests:
// tests/accuracy/shading_experiments_test.cpp.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "drawn/lit_scene.h"
#include "drawn/many_samples.h"
#include "drawn/picture_error.h"
#include "relief/accuracy/passes.h"
#include "relief/mesh/shapes.h"
#include "shading/shading_plan.h"

namespace relief {
namespace {

/// Of the metal, colourless.
constexpr float reflectance = 0.3F;

struct HighlightChoice {
    const char* name;
    const char* model;
    const char* exponent;
    SpecularModel specular;
    double exponent_factor;  ///< Of Blinn's.
};
constexpr std::array highlight_choices = {
    HighlightChoice{"Phong, a quarter of Blinn's exponent", "Phong", "a quarter",
                    SpecularModel::phong, 0.25},
    HighlightChoice{"Phong, Blinn's exponent", "Phong", "the same", SpecularModel::phong, 1.0},
    HighlightChoice{"Blinn-Phong", "Blinn-Phong", "the same", SpecularModel::blinn_phong, 1.0},
    HighlightChoice{"Blinn-Phong, Phong's exponent", "Blinn-Phong", "a quarter",
                    SpecularModel::blinn_phong, 0.25}};
constexpr const char* metal_name = "GGX";

double exponent_of(double roughness) {
    return 2.0 / std::pow(roughness, 4.0) - 2.0;
}

/// Lamps before and behind the torus, so that some highlights are near to the mirror image at
/// grazing angles; no other light.
Scene scene_of(const Material& material) {
    Scene scene = lit_scene(make_torus(0.4F, 192, 96), material);
    scene.directional_lights = {{{0.2F, -1.0F, -0.7F}, glm::vec3(0.7F)},
                                {{-0.9F, -0.25F, 1.2F}, glm::vec3(0.7F)}};
    scene.ambient = glm::vec3(0.0F);
    return scene;
}

Scene metal(double roughness) {
    Material material;
    material.metallic_roughness = {glm::vec3(reflectance), 1.0F, static_cast<float>(roughness), {}};
    return scene_of(material);
}

DrawnMethod method_of(const HighlightChoice& choice, double roughness) {
    const double exponent = exponent_of(roughness) * choice.exponent_factor;
    Material material;
    material.ambient = material.diffuse = glm::vec3(0.0F);
    material.specular_model = choice.specular;
    material.shininess = static_cast<float>(exponent);
    material.specular =
        glm::vec3(reflectance * static_cast<float>((exponent_of(roughness) + 2.0) / 8.0));
    return {
        choice.name, {{"model", choice.model}, {"exponent", choice.exponent}}, scene_of(material)};
}

std::vector<DrawnMethod> highlight_methods(double roughness) {
    std::vector<DrawnMethod> all;
    for (const HighlightChoice& choice : highlight_choices)
        all.push_back(method_of(choice, roughness));
    all.push_back({metal_name, {{"model", "GGX"}, {"exponent", "none"}}, metal(roughness)});
    return all;
}

Chart chart_of(const Drawing& drawing, int size) {
    Chart chart{.id = "roughness",
                .title = "Error by roughness",
                .x_label = "roughness",
                .y_label = "FLIP",
                .is_x_log = false};
    for (const HighlightChoice& choice : highlight_choices)
        chart.curves.push_back({.method = choice.name});
    for (const double roughness : {0.2, 0.3, 0.4, 0.5, 0.6}) {
        const Image truth = many_samples(metal(roughness), size, 1);
        for (std::size_t i = 0; i < highlight_choices.size(); ++i) {
            chart.curves[i].points.push_back(
                {roughness,
                 drawn_error(drawing, method_of(highlight_choices.at(i), roughness), truth)});
        }
    }
    return chart;
}

}  // namespace

Experiment highlight_experiment(const Drawing& drawing, const RunOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    constexpr double roughness = 0.4;
    Experiment experiment{
        .id = "shading/highlights",
        .question = "How near do Phong's and Blinn's highlights come to those of a rough metal?",
        .truth =
            "a metal of GGX facets, by the reference shader in double, one ray through the "
            "centre of each pixel; tests hold its GGX to the closed form in another notation, and "
            "its facets to how many there are within 45 degrees",
        .input = fmt::format("torus of roughness {0} under two lamps, one behind it, {1} x {1} "
                             "pixels; exponent {2:.0f}",
                             roughness, size, exponent_of(roughness)),
        .error_unit = "FLIP",
        .item = "pixel",
        .items = static_cast<double>(size) * size};
    if (!drawing.is_possible_for(experiment)) return experiment;
    const Image truth = many_samples(metal(roughness), size, 1);
    const std::vector<DrawnMethod> all = highlight_methods(roughness);
    const std::vector<DrawnPicture> pictures =
        measure_drawn(drawing, all, truth, options, experiment);
    experiment.charts = {
        made_once(options, [&] { return chart_of(drawing, options.is_quick ? 96 : size); })};
    for (const std::size_t i : {0U, 2U}) {
        experiment.pictures.push_back(
            pair_of("Highlights of a rough metal", all[i].name, pictures[i].picture, truth));
        experiment.heat_maps.push_back({"Where it is seen", all[i].name, pictures[i].errors, 0.5});
    }
    const auto rms = [&](std::size_t i) { return experiment.measurements[i].error.rms; };
    experiment.finding = fmt::format(
        "Both lack the glow around GGX's highlights: Blinn's are FLIP {:.3f} (RMS) off those of "
        "the metal, Phong's of the same width {:.3f}. An exponent taken over from the other model "
        "without the factor of 4 makes "
        "{:.3f} of Blinn's and {:.3f} of Phong's.",
        rms(2), rms(0), rms(3), rms(1));
    experiment.finding += frame_times({{"Phong", experiment.measurements[0]},
                                       {"Blinn-Phong", experiment.measurements[2]},
                                       {"GGX", experiment.measurements[4]}});
    return experiment;
}

}  // namespace relief
