// SPDX-License-Identifier: Apache-2.0
// A shiny plane whose normal map is seen from so far that many texels fall into a pixel: a level of
// averaged normals is too smooth, highlights too sharp, unless they are widened [Toksvig 2005].
// Tests: tests/accuracy/shading_experiments_test.cpp.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "drawn/lit_scene.h"
#include "drawn/many_samples.h"
#include "drawn/picture_error.h"
#include "relief/accuracy/passes.h"
#include "relief/mesh/normal_map.h"
#include "relief/mesh/shapes.h"
#include "shading/shading_plan.h"

namespace relief {
namespace {

constexpr int texels = 512;

/// Waves that fit into the map a whole number of times.
Image bumpy_normals() {
    Image normals = make_image(texels, texels, 3, 32, ColorSpace::data);
    const std::span<float> to = normals.as<float>();
    const auto slope = [](double u, double v, double fast, double slow) {
        return 0.22 * std::cos(2.0 * std::numbers::pi * (fast * u + slow * v));
    };
    for (int y = 0; y < texels; ++y) {
        for (int x = 0; x < texels; ++x) {
            const double u = (x + 0.5) / texels;
            const double v = (y + 0.5) / texels;
            const glm::dvec3 normal =
                glm::normalize(glm::dvec3(slope(u, v, 67, 23) + slope(u, v, 41, -31),
                                          slope(u, v, 19, 71) + slope(u, v, -29, 47), 1.0));
            for (int i = 0; i < 3; ++i)
                to[static_cast<std::size_t>(3 * (y * texels + x) + i)] =
                    static_cast<float>(normal[i]);
        }
    }
    Report report;
    return encode_normal_map(normals, {.bits = 8}, report);
}

/// \param away  how many times farther than where the plane fills the picture
Scene plane(const Image& map, bool is_antialiased, double away) {
    Material material = glossy_plastic();
    material.shininess = 120.0F;
    material.specular = glm::vec3(0.9F);
    material.specular_antialiasing = is_antialiased;
    Scene scene = bumpy_scene(make_quad(), material, map);
    scene.directional_lights = {{{-0.15F, -0.2F, -1.0F}, glm::vec3(lamp_irradiance)}};
    scene.camera = Camera{};
    scene.camera->world_from_view[3] = glm::vec4(0.0F, 0.0F, 4.0F, 1.0F);
    // The map repeats, so that the plane fills the picture from anywhere.
    for (glm::vec2& texcoord : scene.meshes.front().edit().texcoords)
        texcoord *= static_cast<float>(away);
    scene.camera->vertical_fov = 2.0F * std::atan(0.25F);
    return scene;
}

struct AliasingChoice {
    const char* name;
    const char* highlights;
    bool is_antialiased;
    int samples;
    int pixels_a_side;
};
constexpr std::array aliasing_choices = {
    AliasingChoice{"averaged normals", "as sharp as ever", false, 1, 1},
    AliasingChoice{"averaged normals, MSAA", "as sharp as ever", false, 4, 1},
    AliasingChoice{"averaged normals, 2 x 2 pixels", "as sharp as ever", false, 1, 2},
    AliasingChoice{"averaged normals, 4 x 4 pixels", "as sharp as ever", false, 1, 4},
    AliasingChoice{"Toksvig", "widened", true, 1, 1},
    AliasingChoice{"Toksvig, 2 x 2 pixels", "widened", true, 1, 2}};

DrawnMethod method_of(const AliasingChoice& choice, const Image& map, double away) {
    return {choice.name,
            {{"highlights", choice.highlights},
             {"samples a pixel",
              fmt::format("{}", choice.samples * choice.pixels_a_side * choice.pixels_a_side)}},
            plane(map, choice.is_antialiased, away),
            choice.samples,
            choice.pixels_a_side};
}

/// plane()'s `away` at which so many texels lie along a pixel.
double distance_for(double texels_a_pixel, int size) {
    return texels_a_pixel * size / texels;
}

/// \param size  of the pictures: the rays of the truth are nearly all that this takes
Chart distance_chart(const Drawing& drawing, const Image& map, int size, int rays) {
    Chart chart{.id = "distance",
                .title = "Error by texels along a pixel",
                .x_label = "texels along a pixel",
                .y_label = "FLIP"};
    for (const std::size_t i : {0U, 2U, 4U})
        chart.curves.push_back({.method = aliasing_choices.at(i).name});
    for (const double texels_a_pixel : {0.5, 1.0, 2.0, 4.0, 8.0, 16.0}) {
        const double distance = distance_for(texels_a_pixel, size);
        const Image truth = many_samples(plane(map, false, distance), size, rays);
        for (std::size_t i = 0; i < chart.curves.size(); ++i) {
            const DrawnMethod method = method_of(aliasing_choices.at(2 * i), map, distance);
            chart.curves[i].points.push_back({texels_a_pixel, drawn_error(drawing, method, truth)});
        }
    }
    return chart;
}

}  // namespace

Experiment specular_aliasing_experiment(const Drawing& drawing, const RunOptions& options) {
    const int size = options.is_quick ? 96 : 160;
    const int rays = options.is_quick ? 12 : 16;
    constexpr double shown = 8.0;
    Experiment experiment{
        .id = "shading/specular-antialiasing",
        .question = "What keeps highlights right where many texels of a normal map share a pixel?",
        .truth = fmt::format("the reference shader in double with the normal map at full size, "
                             "mean of {} rays a pixel in linear light",
                             rays * rays),
        .input = fmt::format("shiny plane, shininess 120, {1} texels along a pixel, {0} x {0} "
                             "pixels",
                             size, shown),
        .error_unit = "FLIP",
        .item = "pixel",
        .items = static_cast<double>(size) * size};
    if (!drawing.is_possible_for(experiment)) return experiment;
    const Image map = bumpy_normals();
    std::vector<DrawnMethod> all;
    for (const AliasingChoice& choice : aliasing_choices)
        all.push_back(method_of(choice, map, distance_for(shown, size)));
    const Image truth =
        made_once(options, [&] { return many_samples(all.front().scene, size, rays); });
    const std::vector<DrawnPicture> pictures =
        measure_drawn(drawing, all, truth, options, experiment);
    experiment.charts = {made_once(options, [&] {
        return distance_chart(drawing, map, options.is_quick ? size / 2 : size, rays);
    })};
    for (const std::size_t i : {0U, 4U}) {
        experiment.pictures.push_back(
            pair_of("Highlights from afar", all[i].name, pictures[i].picture, truth));
        experiment.heat_maps.push_back({"Where it is seen", all[i].name, pictures[i].errors, 0.5});
    }
    const auto& found = experiment.measurements;
    experiment.finding = fmt::format(
        "At {} texels along a pixel, averaged normals alone are FLIP {:.3f} (RMS) off, widened "
        "highlights {:.3f}. Drawing 16 pixels for each brings the former to {:.3f}; multisampling, "
        "which looks at edges only, to {:.3f}.",
        shown, found[0].error.rms, found[4].error.rms, found[3].error.rms, found[1].error.rms);
    experiment.finding +=
        frame_times({{"16 pixels for each", found[3]}, {"widened highlights", found[4]}});
    return experiment;
}

}  // namespace relief
