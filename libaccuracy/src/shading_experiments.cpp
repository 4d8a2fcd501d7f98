// SPDX-License-Identifier: Apache-2.0
// Experiments on shading with rendered images: per-face, per-vertex and per-pixel lighting;
// specular models; highlights smaller than a pixel; and edges. Also runs all experiments of the
// subject.
#include "shading_experiments.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "error_metrics.h"
#include "experiment_driver.h"
#include "relief/accuracy/measure.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "rendered_methods.h"

namespace relief {
namespace {

struct LightingChoice {
    const char* name;
    Interpolation interpolation;
};
constexpr std::array lighting_choices = {LightingChoice{"flat", Interpolation::flat},
                                         LightingChoice{"Gouraud", Interpolation::gouraud},
                                         LightingChoice{"Phong", Interpolation::per_pixel}};
/// Slices around the circle of the torus; the tube has half as many.
constexpr std::array lighting_slices = {12, 24, 48, 96, 192};

Scene lit_torus(int around, Interpolation interpolation) {
    Material material = glossy_plastic();
    material.interpolation = interpolation;
    Scene scene = lit_scene(make_torus(0.4F, around, around / 2), material);
    scene.camera = torus_camera();
    return scene;
}

std::vector<RenderedMethod> interpolation_methods() {
    std::vector<RenderedMethod> methods;
    for (const LightingChoice& choice : lighting_choices) {
        for (const int around : lighting_slices) {
            methods.push_back(
                {name_on_torus(choice.name, around),
                 {{"lit", choice.name}, {"triangles", fmt::format("{}", torus_triangles(around))}},
                 lit_torus(around, choice.interpolation)});
        }
    }
    return methods;
}

std::string interpolation_finding(const Experiment& experiment) {
    constexpr std::size_t coarse = 1;
    constexpr std::size_t fine = 3;
    const auto at = [&](std::size_t choice, std::size_t slices) -> const Measurement& {
        return experiment.measurements.at(choice * lighting_slices.size() + slices);
    };
    return fmt::format(
               "With {} triangles, flat shading has a FLIP error of {:.3f} (RMS), Gouraud shading "
               "{:.3f} and Phong shading {:.3f}; Gouraud shading needs {} triangles for {:.3f}.",
               torus_triangles(lighting_slices[coarse]), at(0, coarse).error.rms,
               at(1, coarse).error.rms, at(2, coarse).error.rms,
               torus_triangles(lighting_slices[fine]), at(1, fine).error.rms) +
           frame_times(
               {{"flat", at(0, coarse)}, {"Gouraud", at(1, coarse)}, {"Phong", at(2, coarse)}});
}

}  // namespace

Experiment interpolation_experiment(const GlDevice& device, const RunOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    Experiment experiment = image_experiment("shading/interpolation", size);
    experiment.question =
        "How many triangles make the error of per-face and per-vertex lighting invisible?";
    experiment.ground_truth = fmt::format(
        "The reference shader in double on a torus of {} triangles with the exact normals, one "
        "ray through the center of each pixel. A test verifies that shader by the closed form "
        "of a lit sphere.",
        torus_triangles(smooth_torus_slices));
    experiment.input =
        fmt::format("torus with a highlight of shininess 40, {0} x {0} pixels", size);
    if (!device.is_available_for(experiment)) return experiment;
    const Image ground_truth =
        supersampled_reference(lit_torus(smooth_torus_slices, Interpolation::per_pixel), size, 1);
    const std::vector<RenderedMethod> methods = interpolation_methods();
    const std::vector<RenderedImage> pictures =
        measure_rendered(device, methods, ground_truth, options, experiment);
    std::vector<std::string> names;
    for (const LightingChoice& choice : lighting_choices)
        names.emplace_back(choice.name);
    experiment.charts = {torus_chart(experiment, names, lighting_slices)};
    for (std::size_t i = 1; i < methods.size(); i += lighting_slices.size()) {
        add_images("Lighting per face, vertex and pixel", methods[i], pictures[i], ground_truth,
                   0.5, experiment);
    }
    experiment.finding = interpolation_finding(experiment);
    return experiment;
}

namespace {

/// Reflectance of the metal at normal incidence, in all channels.
constexpr float metal_reflectance = 0.3F;

struct HighlightChoice {
    const char* name;
    const char* model;
    const char* exponent;
    SpecularModel specular;
    double exponent_factor;  ///< Relative to the exponent of Blinn-Phong.
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

/// Lights before and behind the torus, so that some highlights are near grazing angles; no ambient
/// light.
Scene scene_of(const Material& material) {
    Scene scene = lit_scene(make_torus(0.4F, 192, 96), material);
    scene.directional_lights = {{{0.2F, -1.0F, -0.7F}, glm::vec3(0.7F)},
                                {{-0.9F, -0.25F, 1.2F}, glm::vec3(0.7F)}};
    scene.ambient = glm::vec3(0.0F);
    return scene;
}

Scene metal(double roughness) {
    Material material;
    material.metallic_roughness = {
        glm::vec3(metal_reflectance), 1.0F, static_cast<float>(roughness), {}};
    return scene_of(material);
}

RenderedMethod method_of(const HighlightChoice& choice, double roughness) {
    const double exponent = exponent_of(roughness) * choice.exponent_factor;
    Material material;
    material.ambient = material.diffuse = glm::vec3(0.0F);
    material.specular_model = choice.specular;
    material.shininess = static_cast<float>(exponent);
    material.specular =
        glm::vec3(metal_reflectance * static_cast<float>((exponent_of(roughness) + 2.0) / 8.0));
    return {
        choice.name, {{"model", choice.model}, {"exponent", choice.exponent}}, scene_of(material)};
}

std::vector<RenderedMethod> highlight_methods(double roughness) {
    std::vector<RenderedMethod> methods;
    for (const HighlightChoice& choice : highlight_choices)
        methods.push_back(method_of(choice, roughness));
    methods.push_back({metal_name, {{"model", "GGX"}, {"exponent", "none"}}, metal(roughness)});
    return methods;
}

Chart chart_of(const GlDevice& device, int size) {
    Chart chart{.id = "roughness",
                .title = "Error by roughness",
                .x_label = "roughness",
                .y_label = "FLIP",
                .is_x_log = false};
    for (const HighlightChoice& choice : highlight_choices)
        chart.curves.push_back({.method = choice.name});
    for (const double roughness : {0.2, 0.3, 0.4, 0.5, 0.6}) {
        const Image ground_truth = supersampled_reference(metal(roughness), size, 1);
        for (std::size_t i = 0; i < highlight_choices.size(); ++i) {
            chart.curves[i].points.push_back(
                {roughness, rendered_error(device, method_of(highlight_choices.at(i), roughness),
                                           ground_truth)});
        }
    }
    return chart;
}

}  // namespace

Experiment highlight_experiment(const GlDevice& device, const RunOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    constexpr double roughness = 0.4;
    Experiment experiment = image_experiment("shading/highlights", size);
    experiment.question =
        "How accurately do Phong and Blinn-Phong highlights approximate those of a rough "
        "metal?";
    experiment.ground_truth =
        "A metal of GGX facets, by the reference shader in double, one ray through the "
        "center of each pixel. Tests verify its GGX by the closed form in another notation, "
        "and its facets by their number within 45 degrees.";
    experiment.input = fmt::format(
        "torus of roughness {0} under two lights, one behind it, {1} x {1} "
        "pixels; exponent {2:.0f}",
        roughness, size, exponent_of(roughness));
    if (!device.is_available_for(experiment)) return experiment;
    const Image ground_truth = supersampled_reference(metal(roughness), size, 1);
    const std::vector<RenderedMethod> methods = highlight_methods(roughness);
    const std::vector<RenderedImage> pictures =
        measure_rendered(device, methods, ground_truth, options, experiment);
    experiment.charts = {computed_once(
        options, "chart", [&] { return chart_of(device, options.is_quick ? 96 : size); })};
    for (const std::size_t i : {0U, 2U}) {
        add_images("Highlights of a rough metal", methods[i], pictures[i], ground_truth, 0.5,
                   experiment);
    }
    const auto rms = [&](std::size_t i) { return experiment.measurements[i].error.rms; };
    experiment.finding = fmt::format(
        "Both lack the long tails of GGX highlights: Blinn-Phong has a FLIP error of {:.3f} (RMS), "
        "Phong with highlights of the same width {:.3f}. With the exponent of the other model, "
        "without the factor of 4, the error is {:.3f} for Blinn-Phong and {:.3f} for Phong.",
        rms(2), rms(0), rms(3), rms(1));
    experiment.finding += frame_times({{"Phong", experiment.measurements[0]},
                                       {"Blinn-Phong", experiment.measurements[2]},
                                       {"GGX", experiment.measurements[4]}});
    return experiment;
}

namespace {

constexpr int texels = 512;

/// The normal map of waves whose periods divide the map.
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

/// \param away  distance of the camera relative to the distance at which the plane fills the image
Scene plane(const Image& map, bool is_antialiased, double away) {
    Material material = glossy_plastic();
    material.shininess = 120.0F;
    material.specular = glm::vec3(0.9F);
    material.specular_antialiasing = is_antialiased;
    Scene scene = bumpy_scene(make_quad(), material, map);
    scene.directional_lights = {{{-0.15F, -0.2F, -1.0F}, glm::vec3(light_irradiance)}};
    scene.camera = Camera{};
    scene.camera->world_from_view[3] = glm::vec4(0.0F, 0.0F, 4.0F, 1.0F);
    // Repeat the map instead of moving the camera, so that the plane always fills the image.
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
    int pixels_per_side;
};
constexpr std::array aliasing_choices = {
    AliasingChoice{"averaged normals", "as sharp as ever", false, 1, 1},
    AliasingChoice{"averaged normals, MSAA", "as sharp as ever", false, 4, 1},
    AliasingChoice{"averaged normals, 2 x 2 pixels", "as sharp as ever", false, 1, 2},
    AliasingChoice{"averaged normals, 4 x 4 pixels", "as sharp as ever", false, 1, 4},
    AliasingChoice{"Toksvig", "widened", true, 1, 1},
    AliasingChoice{"Toksvig, 2 x 2 pixels", "widened", true, 1, 2}};

RenderedMethod method_of(const AliasingChoice& choice, const Image& map, double away) {
    return {choice.name,
            {{"highlights", choice.highlights},
             {"samples a pixel",
              fmt::format("{}", choice.samples * choice.pixels_per_side * choice.pixels_per_side)}},
            plane(map, choice.is_antialiased, away),
            choice.samples,
            choice.pixels_per_side};
}

/// The parameter `away` of plane() for a number of texels per pixel.
double distance_for(double texels_per_pixel, int size) {
    return texels_per_pixel * size / texels;
}

/// \param size  of the images; nearly all of the time goes into the rays of the ground truth
Chart distance_chart(const GlDevice& device, const Image& map, int size, int rays) {
    Chart chart{.id = "distance",
                .title = "Error by texels along a pixel",
                .x_label = "texels along a pixel",
                .y_label = "FLIP"};
    for (const std::size_t i : {0U, 2U, 4U})
        chart.curves.push_back({.method = aliasing_choices.at(i).name});
    for (const double texels_per_pixel : {0.5, 1.0, 2.0, 4.0, 8.0, 16.0}) {
        const double distance = distance_for(texels_per_pixel, size);
        const Image ground_truth = supersampled_reference(plane(map, false, distance), size, rays);
        for (std::size_t i = 0; i < chart.curves.size(); ++i) {
            const RenderedMethod method = method_of(aliasing_choices.at(2 * i), map, distance);
            chart.curves[i].points.push_back(
                {texels_per_pixel, rendered_error(device, method, ground_truth)});
        }
    }
    return chart;
}

}  // namespace

Experiment specular_aliasing_experiment(const GlDevice& device, const RunOptions& options) {
    const int size = options.is_quick ? 96 : 160;
    const int rays = options.is_quick ? 12 : 16;
    constexpr double shown = 8.0;
    Experiment experiment = image_experiment("shading/specular-antialiasing", size);
    experiment.question =
        "Which method keeps highlights accurate where many texels of a normal map share a "
        "pixel?";
    experiment.ground_truth = fmt::format(
        "The reference shader in double with the normal map at full size, "
        "mean of {} rays per pixel in linear light.",
        rays * rays);
    experiment.input = fmt::format(
        "shiny plane, shininess 120, {1} texels along a pixel, {0} x {0} "
        "pixels",
        size, shown);
    if (!device.is_available_for(experiment)) return experiment;
    const Image map = bumpy_normals();
    std::vector<RenderedMethod> methods;
    for (const AliasingChoice& choice : aliasing_choices)
        methods.push_back(method_of(choice, map, distance_for(shown, size)));
    const Image ground_truth = computed_once(options, "ground truth", [&] {
        return supersampled_reference(methods.front().scene, size, rays);
    });
    const std::vector<RenderedImage> pictures =
        measure_rendered(device, methods, ground_truth, options, experiment);
    experiment.charts = {computed_once(options, "chart", [&] {
        return distance_chart(device, map, options.is_quick ? size / 2 : size, rays);
    })};
    for (const std::size_t i : {0U, 4U}) {
        add_images("Highlights at a distance", methods[i], pictures[i], ground_truth, 0.5,
                   experiment);
    }
    const auto& measured = experiment.measurements;
    experiment.finding = fmt::format(
        "At {} texels along a pixel, averaged normals alone have a FLIP error of {:.3f} (RMS), "
        "widened highlights {:.3f}. Rendering 16 pixels for each pixel reduces the former to "
        "{:.3f}; multisampling, which affects only edges, to {:.3f}.",
        shown, measured[0].error.rms, measured[4].error.rms, measured[3].error.rms,
        measured[1].error.rms);
    experiment.finding +=
        frame_times({{"16 pixels for each", measured[3]}, {"widened highlights", measured[4]}});
    return experiment;
}

namespace {

Scene cube_and_ring() {
    Scene scene = lit_scene(make_torus(0.12F, 192, 48), glossy_plastic());
    Mesh cube = make_cube();
    for (glm::vec3& position : cube.positions)
        position *= 0.42F;
    scene.meshes.emplace_back(std::move(cube));
    scene.instances.push_back({1, glm::mat4(1.0F), "cube"});
    scene.camera->world_from_view = lit_scene(make_torus(0.2F), {}).camera->world_from_view;
    return scene;
}

std::vector<RenderedMethod> edge_methods() {
    const Scene scene = cube_and_ring();
    const auto choices_of = [](const char* way, const char* samples) {
        return std::vector<std::pair<std::string, std::string>>{{"averaged", way},
                                                                {"samples a pixel", samples}};
    };
    return {{"1 sample", choices_of("nothing", "1"), scene, 1, 1},
            {"MSAA, 4 samples", choices_of("coverage", "4"), scene, 4, 1},
            {"2 x 2 pixels", choices_of("pixels", "4"), scene, 1, 2},
            {"2 x 2 pixels, MSAA", choices_of("coverage and pixels", "16"), scene, 4, 2},
            {"4 x 4 pixels", choices_of("pixels", "16"), scene, 1, 4}};
}

}  // namespace

Experiment edge_experiment(const GlDevice& device, const RunOptions& options) {
    const int size = options.is_quick ? 128 : 256;
    const int rays = options.is_quick ? 8 : 16;
    Experiment experiment = image_experiment("shading/edges", size);
    experiment.question = "How much does antialiasing of edges cost?";
    experiment.ground_truth = fmt::format(
        "The reference shader in double, mean of {} rays per pixel in linear "
        "light. A test verifies its coverage by the closed form of a disc.",
        rays * rays);
    experiment.input =
        fmt::format("ring and cube before a dark background, {0} x {0} pixels", size);
    if (!device.is_available_for(experiment)) return experiment;
    const std::vector<RenderedMethod> methods = edge_methods();
    const Image ground_truth = supersampled_reference(methods.front().scene, size, rays);
    const std::vector<RenderedImage> pictures =
        measure_rendered(device, methods, ground_truth, options, experiment);
    for (const std::size_t i : {0U, 1U}) {
        add_images("Edges", methods[i], pictures[i], ground_truth, 0.3, experiment);
    }
    const auto& measured = experiment.measurements;
    experiment.finding = fmt::format(
        "4x multisampling reduces the FLIP error from {:.4f} (RMS) to {:.4f}; rendering 4 pixels "
        "for each pixel reduces it to {:.4f}, 16 pixels to {:.4f}.",
        measured[0].error.rms, measured[1].error.rms, measured[2].error.rms, measured[4].error.rms);
    experiment.finding += frame_times({{"none", measured[0]},
                                       {"4x multisampling", measured[1]},
                                       {"4 pixels", measured[2]},
                                       {"16 pixels", measured[4]}});
    return experiment;
}

std::vector<Experiment> shading_experiments(const RunOptions& options) {
    const GlDevice device;
    const auto drawn = [&](Experiment (*experiment)(const GlDevice&, const RunOptions&)) {
        return [&device, &options, experiment] { return experiment(device, options); };
    };
    const std::vector<PlannedExperiment> plan = {
        {"Flat, Gouraud and Phong shading", drawn(interpolation_experiment)},
        {"Phong's and Blinn's highlights", drawn(highlight_experiment)},
        {"Making the interpolated normal unit", [&] { return unit_normal_experiment(options); }},
        {"Schlick's factor against Fresnel's: glass", [&] { return glass_experiment(options); }},
        {"Schlick's factor against Fresnel's: a metal", [&] { return metal_experiment(options); }},
        {"The size of a reflected cube map", drawn(reflection_experiment)},
        {"Rough mirrors by levels of a cube map", drawn(glossy_experiment)},
        {"Highlights smaller than a pixel", drawn(specular_aliasing_experiment)},
        {"Edges by several samples a pixel", drawn(edge_experiment)}};
    std::vector<Experiment> experiments = run_planned(plan, options);
    for (Experiment& experiment : experiments) {
        experiment.subject = Subject::shading;
        mark_pareto_optimal(experiment);
    }
    return experiments;
}

}  // namespace relief
