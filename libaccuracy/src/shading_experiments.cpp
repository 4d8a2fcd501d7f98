// SPDX-License-Identifier: Apache-2.0
// Experiments on shading with rendered images: per-face, per-vertex and per-pixel lighting;
// specular models; highlights smaller than a pixel; and edges. Also runs all experiments of the
// subject.
#include "shading_experiments.h"

#include <fmt/format.h>

#include <array>
#include <numbers>

#include "experiment_parts.h"
#include "portable_math.h"
#include "relief/mesh/mesh.h"
#include "relief/mesh/normal_map.h"
#include "rendered_methods.h"

namespace relief::accuracy::detail {
using namespace relief::shade;

namespace {

Scene lit_torus(int around, Interpolation interpolation) {
    Material material = glossy_plastic();
    material.interpolation = interpolation;
    Scene scene = lit_scene(make_torus(0.4F, around, around / 2), material);
    scene.camera = torus_camera();
    return scene;
}

PreparedExperiment interpolation_experiment(const PlanOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    const auto torus = [](Interpolation interpolation) {
        return [interpolation](int around) { return lit_torus(around, interpolation); };
    };
    RenderedExperiment experiment = on_tori(
        {.question = "How many triangles make the error of per-face and per-vertex lighting "
                     "invisible?",
         .ground_truth = fmt::format(
             "The reference shader in double on a torus of {} triangles with the exact "
             "normals, one ray through the center of each pixel. A test verifies that shader "
             "by the closed form of a lit sphere.",
             torus_triangles(smooth_torus_slices)),
         .input = fmt::format("torus with a highlight of shininess 40, {0} x {0} pixels", size)},
        "lit",
        {{"flat", torus(Interpolation::flat)},
         {"Gouraud", torus(Interpolation::gouraud)},
         {"Phong", torus(Interpolation::per_pixel)}},
        {12, 24, 48, 96, 192}, torus(Interpolation::per_pixel), size);
    experiment.compared = {"flat, 576 triangles", "Gouraud, 576 triangles", "Phong, 576 triangles",
                           "Gouraud, 9216 triangles"};
    experiment.shown = {1, 6, 11};
    experiment.title = "Lighting per face, vertex and pixel";
    return prepare_rendering(options.device.get(), std::move(experiment));
}

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

double exponent_of(double roughness) {
    return 2.0 / (roughness * roughness * roughness * roughness) - 2.0;
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

Scene highlight_of(const HighlightChoice& choice, double roughness) {
    const double exponent = exponent_of(roughness) * choice.exponent_factor;
    Material material;
    material.ambient = material.diffuse = glm::vec3(0.0F);
    material.specular_model = choice.specular;
    material.shininess = static_cast<float>(exponent);
    material.specular =
        glm::vec3(metal_reflectance * static_cast<float>((exponent_of(roughness) + 2.0) / 8.0));
    return scene_of(material);
}

/// Approximations of a metal, by its roughness; GGX comes last.
std::vector<RenderedMethod> highlight_methods() {
    std::vector<RenderedMethod> methods;
    for (const HighlightChoice& choice : highlight_choices) {
        methods.push_back(
            {choice.name,
             {{"model", choice.model}, {"exponent", choice.exponent}},
             [choice](double roughness) { return Rendering{highlight_of(choice, roughness)}; }});
    }
    methods.push_back({"GGX", {{"model", "GGX"}, {"exponent", "none"}}, [](double roughness) {
                           return Rendering{metal(roughness)};
                       }});
    return methods;
}

PreparedExperiment highlight_experiment(const PlanOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    const int chart_size = options.is_quick ? 96 : size;
    constexpr double roughness = 0.4;
    return prepare_rendering(
        options.device.get(),
        {.report =
             {.question = "How accurately do Phong and Blinn-Phong highlights approximate those of "
                          "a rough metal?",
              .ground_truth =
                  "A metal of GGX facets, by the reference shader in double, one ray through the "
                  "center of each pixel. Tests verify its GGX by the closed form in another "
                  "notation, and its facets by their number within 45 degrees.",
              .input = fmt::format("torus of roughness {0} under two lights, one behind it, {1} x "
                                   "{1} pixels; exponent {2:.0f}",
                                   roughness, size, exponent_of(roughness))},
         .size = size,
         .methods = highlight_methods(),
         .x = roughness,
         .ground_truth = [size] { return supersampled_reference(metal(roughness), size, 1); },
         .shown = {0, 2},
         .title = "Highlights of a rough metal",
         .finish =
             [chart_size](Experiment& report, const Renderings& renderings) {
                 std::vector<RenderedMethod> methods = highlight_methods();
                 methods.pop_back();
                 report.charts = {
                     rendered_chart(*renderings.device,
                                    {.id = "roughness",
                                     .title = "Error by roughness",
                                     .x_label = "roughness",
                                     .y_label = "FLIP",
                                     .is_x_log = false},
                                    methods, {0.2, 0.3, 0.4, 0.5, 0.6}, [chart_size](double x) {
                                        return supersampled_reference(metal(x), chart_size, 1);
                                    })};
             }});
}

constexpr int wave_texels = 512;

/// The normal map of waves whose periods divide the map.
Image bumpy_normals() {
    Image normals = make_image(wave_texels, wave_texels, 3, 32, ColorSpace::data);
    const std::span<float> to = normals.as<float>();
    const auto slope = [](double u, double v, double fast, double slow) {
        return 0.22 * relief::detail::portable::cos(2.0 * std::numbers::pi * (fast * u + slow * v));
    };
    for (int y = 0; y < wave_texels; ++y) {
        for (int x = 0; x < wave_texels; ++x) {
            const double u = (x + 0.5) / wave_texels;
            const double v = (y + 0.5) / wave_texels;
            const glm::dvec3 normal =
                glm::normalize(glm::dvec3(slope(u, v, 67, 23) + slope(u, v, 41, -31),
                                          slope(u, v, 19, 71) + slope(u, v, -29, 47), 1.0));
            for (int i = 0; i < 3; ++i)
                to[static_cast<std::size_t>(3 * (y * wave_texels + x) + i)] =
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
    scene.camera->vertical_fov =
        static_cast<float>(2.0 * relief::detail::portable::atan2(0.25, 1.0));
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

/// A plane with a number of texels along a pixel of images of a size.
Scene plane_at(const Image& map, bool is_antialiased, double texels_per_pixel, int size) {
    return plane(map, is_antialiased, texels_per_pixel * size / wave_texels);
}

/// By the number of texels along a pixel of images of a size.
std::vector<RenderedMethod> aliasing_methods(const Image& map, int size) {
    std::vector<RenderedMethod> methods;
    for (const AliasingChoice& choice : aliasing_choices) {
        methods.push_back(
            {choice.name,
             {{"highlights", choice.highlights},
              {"samples a pixel", fmt::format("{}", choice.samples * choice.pixels_per_side *
                                                        choice.pixels_per_side)}},
             [=](double texels) {
                 return Rendering{plane_at(map, choice.is_antialiased, texels, size),
                                  choice.samples, choice.pixels_per_side};
             }});
    }
    return methods;
}

PreparedExperiment specular_aliasing_experiment(const PlanOptions& options) {
    const int size = options.is_quick ? 96 : 160;
    // Nearly all of the time goes into the rays of the ground truth.
    const int chart_size = options.is_quick ? size / 2 : size;
    const int rays = options.is_quick ? 12 : 16;
    constexpr double shown = 8.0;
    const Image map = bumpy_normals();
    const auto reference = [map, rays](double texels, int pixels) {
        return supersampled_reference(plane_at(map, false, texels, pixels), pixels, rays);
    };
    return prepare_rendering(
        options.device.get(),
        {.report =
             {.question = "Which method keeps highlights accurate where many texels of a normal "
                          "map share a pixel?",
              .ground_truth = fmt::format("The reference shader in double with the normal map at "
                                          "full size, mean of {} rays per pixel in linear light.",
                                          rays * rays),
              .input = fmt::format("shiny plane, shininess 120, {1} texels along a pixel, {0} x "
                                   "{0} pixels",
                                   size, shown)},
         .size = size,
         .methods = aliasing_methods(map, size),
         .x = shown,
         .ground_truth = [reference, size] { return reference(shown, size); },
         .shown = {0, 4},
         .title = "Highlights at a distance",
         .finish =
             [map, reference, chart_size](Experiment& report, const Renderings& renderings) {
                 const std::vector<RenderedMethod> all = aliasing_methods(map, chart_size);
                 report.charts = {
                     rendered_chart(*renderings.device,
                                    {.id = "distance",
                                     .title = "Error by texels along a pixel",
                                     .x_label = "texels along a pixel",
                                     .y_label = "FLIP"},
                                    {all[0], all[2], all[4]}, {0.5, 1.0, 2.0, 4.0, 8.0, 16.0},
                                    [&](double texels) { return reference(texels, chart_size); })};
             }});
}

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
    const auto method = [](const char* name, const char* way, int samples, int pixels_per_side) {
        const int count = samples * pixels_per_side * pixels_per_side;
        return RenderedMethod{
            name, {{"averaged", way}, {"samples a pixel", fmt::format("{}", count)}}, [=](double) {
                return Rendering{cube_and_ring(), samples, pixels_per_side};
            }};
    };
    return {method("1 sample", "nothing", 1, 1), method("MSAA, 4 samples", "coverage", 4, 1),
            method("2 x 2 pixels", "pixels", 1, 2),
            method("2 x 2 pixels, MSAA", "coverage and pixels", 4, 2),
            method("4 x 4 pixels", "pixels", 1, 4)};
}

PreparedExperiment edge_experiment(const PlanOptions& options) {
    const int size = options.is_quick ? 128 : 256;
    const int rays = options.is_quick ? 8 : 16;
    return prepare_rendering(
        options.device.get(),
        {.report = {.question = "How much does antialiasing of edges cost?",
                    .ground_truth = fmt::format(
                        "The reference shader in double, mean of {} rays per pixel in linear "
                        "light. A test verifies its coverage by the closed form of a disc.",
                        rays * rays),
                    .input = fmt::format("ring and cube before a dark background, {0} x {0} pixels",
                                         size)},
         .size = size,
         .methods = edge_methods(),
         .ground_truth = [=] { return supersampled_reference(cube_and_ring(), size, rays); },
         .compared = {"1 sample", "MSAA, 4 samples", "2 x 2 pixels", "4 x 4 pixels"},
         .shown = {0, 1},
         .title = "Edges",
         .brightest = 0.3});
}

}  // namespace

std::vector<PlannedExperiment> shading_plan(const PlanOptions&) {
    return {
        {"shading/interpolation", "Flat, Gouraud and Phong shading", interpolation_experiment},
        {"shading/highlights", "Phong's and Blinn's highlights", highlight_experiment},
        {"shading/unit-normal", "Making the interpolated normal unit", unit_normal_experiment},
        {"shading/fresnel-glass", "Schlick's factor against Fresnel's: glass", glass_experiment},
        {"shading/fresnel-metal", "Schlick's factor against Fresnel's: a metal", metal_experiment},
        {"shading/cube-map-size", "The size of a reflected cube map", reflection_experiment},
        {"shading/glossy-levels", "Rough mirrors by levels of a cube map", glossy_experiment},
        {"shading/energy", "Energy lost by rough surfaces", energy_experiment},
        {"shading/specular-antialiasing", "Highlights smaller than a pixel",
         specular_aliasing_experiment},
        {"shading/edges", "Edges by several samples per pixel", edge_experiment}};
}

}  // namespace relief::accuracy::detail
