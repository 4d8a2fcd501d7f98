// SPDX-License-Identifier: Apache-2.0
// Experiments on reflected environments: the size of cube maps for a mirror, blurred mip levels for
// rough mirrors, and the light that rough surfaces lose. The environment is a formula, so the exact
// reflection is known.
#include "shading_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "environment/environment_images.h"
#include "parallel.h"
#include "portable_math.h"
#include "relief/mesh/mesh.h"
#include "rendered_methods.h"

namespace relief::accuracy::detail {
using namespace relief::detail;
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

constexpr double eye_distance = 3.0;
/// Half the width of the image on the plane at distance 1; the corners of the image just see the
/// ball.
constexpr double half_side = 0.235;

/// Computes the pixels of an image in parallel rows.
template <typename Pixel>
void fill(Image& image, Pixel pixel) {
    const std::span<float> to = image.as<float>();
    const auto width = static_cast<std::size_t>(image.width);
    parallel_for(static_cast<std::size_t>(image.height), 1, [&](std::size_t from, std::size_t end) {
        for (std::size_t y = from; y < end; ++y) {
            for (std::size_t x = 0; x < width; ++x) {
                const glm::dvec3 color = pixel(static_cast<double>(x), static_cast<double>(y));
                for (std::size_t i = 0; i < 3; ++i)
                    to[3 * (y * width + x) + i] =
                        static_cast<float>(color[static_cast<glm::length_t>(i)]);
            }
        }
    });
}

/// The mean of a regular grid of positions in a pixel or texel.
template <typename Value>
glm::dvec3 mean_over(double x, double y, int side, Value value) {
    glm::dvec3 sum(0.0);
    for (int i = 0; i < side * side; ++i)
        sum += value(x + (i % side + 0.5) / side, y + (i / side + 0.5) / side);
    return sum / static_cast<double>(side * side);
}

/// The reflection of a unit ray from the camera; the ray hits the ball.
glm::dvec3 mirrored(const glm::dvec3& ray) {
    const glm::dvec3 eye(0.0, 0.0, eye_distance);
    const double along = glm::dot(eye, ray);
    const double far =
        -along - std::sqrt(std::max(along * along - eye_distance * eye_distance + 1.0, 0.0));
    const glm::dvec3 normal = eye + far * ray;
    return ray - 2.0 * glm::dot(ray, normal) * normal;
}

}  // namespace

glm::dvec3 waves_and_lights(const glm::dvec3& direction_world) {
    struct Wave {
        glm::dvec3 frequency;
        glm::dvec3 strength;
    };
    static const std::array waves = {
        Wave{{0.0, 2.0, 0.0}, {0.06, 0.08, 0.12}}, Wave{{9.0, 4.0, -6.0}, {0.08, 0.05, 0.02}},
        Wave{{-14.0, 20.0, 9.0}, {0.03, 0.07, 0.05}}, Wave{{31.0, -22.0, 37.0}, {0.05, 0.03, 0.06}},
        Wave{{58.0, 61.0, 26.0}, {0.04, 0.04, 0.02}}};
    static const std::array lights = {glm::normalize(glm::dvec3(0.4, 0.5, 0.8)),
                                      glm::normalize(glm::dvec3(-0.7, 0.2, 0.3)),
                                      glm::normalize(glm::dvec3(0.1, -0.6, -0.5))};
    glm::dvec3 radiance(0.3);
    for (const Wave& wave : waves)
        radiance += wave.strength * portable::sin(glm::dot(wave.frequency, direction_world));
    for (const glm::dvec3& light : lights)
        radiance += 0.4 * portable::exp(900.0 * (glm::dot(light, direction_world) - 1.0));
    return glm::clamp(radiance, 0.0, 1.0);
}

Environment cube_map_of(const EnvironmentFormula& formula, int size) {
    CubeFaces faces;
    for (std::size_t face = 0; face < 6; ++face) {
        Image image = make_image(size, size, 3, 32, ColorSpace::linear);
        fill(image, [&](double x, double y) {
            return mean_over(x, y, 2, [&](double column, double row) {
                return formula(glm::normalize(
                    face_direction(face, 2.0 * column / size - 1.0, 2.0 * row / size - 1.0)));
            });
        });
        faces.faces.at(face) = {cube_face_names.at(face), Shared<Image>(std::move(image))};
    }
    Environment environment;
    environment.source = std::move(faces);
    environment.skybox = false;
    return environment;
}

Scene mirror_ball(Environment environment, double roughness) {
    Material material;
    material.ambient = material.diffuse = glm::vec3(0.0F);
    material.reflectivity = material.grazing_reflectivity = glm::vec3(1.0F);
    material.reflection_roughness = static_cast<float>(roughness);
    Scene scene = lit_scene(make_sphere(256, 128), material);
    scene.directional_lights.clear();
    scene.ambient = glm::vec3(0.0F);
    scene.environment = std::move(environment);
    Camera camera;
    camera.world_from_view[3] = glm::vec4(0.0F, 0.0F, static_cast<float>(eye_distance), 1.0F);
    camera.vertical_fov = static_cast<float>(2.0 * portable::atan2(half_side, 1.0));
    scene.camera = camera;
    return scene;
}

Image exact_mirror(const EnvironmentFormula& formula, int size, int rays_per_side) {
    Image picture = make_image(size, size, 3, 32, ColorSpace::linear);
    fill(picture, [&](double x, double y) {
        return mean_over(x, y, rays_per_side, [&](double column, double row) {
            return formula(
                mirrored(glm::normalize(glm::dvec3((2.0 * column / size - 1.0) * half_side,
                                                   (1.0 - 2.0 * row / size) * half_side, -1.0))));
        });
    });
    return picture;
}

namespace {

std::string name_of(int side) {
    return fmt::format("{0} x {0} texels", side);
}

/// Bytes of six faces of four half floats, and a third more for the mip levels.
double bytes_of(int side) {
    return 6.0 * 8.0 * side * side * 4.0 / 3.0;
}

/// Side of the smallest cube map; each method doubles it.
constexpr int smallest_map_side = 16;

Chart map_size_chart(const Experiment& experiment) {
    Curve curve{.method = "cube map"};
    for (const Measurement& one : experiment.measurements)
        curve.points.push_back({smallest_map_side * std::exp2(curve.points.size()), one.error.rms});
    curve.order = fitted_order(curve.points);
    return {.id = "size",
            .title = "Error by size",
            .x_label = "texels along a face",
            .y_label = "FLIP",
            .curves = {std::move(curve)}};
}

}  // namespace

PreparedExperiment reflection_experiment(const PlanOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    constexpr int rays = 4;
    const int largest = options.is_quick ? 256 : 1024;
    std::vector<RenderedMethod> methods;
    for (int side = smallest_map_side; side <= largest; side *= 2) {
        methods.push_back({.name = name_of(side),
                           .choices = {{"size", fmt::format("{}", side)}},
                           .compute =
                               [side](double) {
                                   return Rendering{
                                       mirror_ball(cube_map_of(waves_and_lights, side), 0.0)};
                               },
                           .stored_bytes = bytes_of(side)});
    }
    return prepare_rendering(
        options.device.get(),
        {.report =
             {.question = "How large must a cube map be for a mirror?",
              .ground_truth = fmt::format(
                  "The formula of the environment in the directions that an exact ball reflects, "
                  "mean of {} rays per pixel. A test verifies it by the reference shader.",
                  rays * rays),
              .input = fmt::format(
                  "mirror ball, environment with details of 3 degrees, {0} x {0} pixels, about 0.7 "
                  "degrees of the environment in each",
                  size)},
         .size = size,
         .methods = std::move(methods),
         .ground_truth = [size] { return exact_mirror(waves_and_lights, size, rays); },
         .compared = {name_of(32), name_of(128), name_of(largest)},
         .shown = {1, 3},  // 32 and 128 texels.
         .title = "The environment in a mirror",
         .finish = [](Experiment& report,
                      const Renderings&) { report.charts = {map_size_chart(report)}; }});
}

namespace {

/// Cube maps below 256 texels have fewer and smaller blurred levels (libshade/src/gl/cube_map.h).
constexpr int large = 256;
constexpr int small_map_side = 128;
/// Image sizes in pixels.
constexpr int full_ball_size = 192;
constexpr int quick_ball_size = 64;

/// The environments of the methods.
struct Maps {
    Environment finest = cube_map_of(waves_and_lights, large);
    Environment coarser = cube_map_of(waves_and_lights, small_map_side);
};

/// By the roughness of the ball.
std::vector<RenderedMethod> glossy_methods(const SharedInput<Maps>& maps) {
    return {{"not blurred",
             {{"levels", "none"}},
             [maps](double) { return Rendering{mirror_ball(maps.get()->finest, 0.0)}; }},
            {"5 levels, 128 texels",
             {{"levels", "5"}},
             [maps](double x) { return Rendering{mirror_ball(maps.get()->coarser, x)}; }},
            {"6 levels, 256 texels", {{"levels", "6"}}, [maps](double x) {
                 return Rendering{mirror_ball(maps.get()->finest, x)};
             }}};
}

Chart roughness_chart(const char* id, const char* title, const char* y_label) {
    return {
        .id = id, .title = title, .x_label = "roughness", .y_label = y_label, .is_x_log = false};
}

const std::vector<double> all_roughnesses = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};

}  // namespace

PreparedExperiment glossy_experiment(const PlanOptions& options) {
    const bool is_quick = options.is_quick;
    const int size = is_quick ? quick_ball_size : full_ball_size;
    constexpr double shown = 0.3;
    const SharedInput<Maps> maps([] { return std::make_shared<const Maps>(); });
    const auto reference = [maps](double roughness, int pixels) {
        return supersampled_reference(mirror_ball(maps.get()->finest, roughness), pixels, 1);
    };
    return prepare_rendering(
        options.device.get(),
        {.report =
             {.question = "How accurate are rough mirrors with a few blurred mip levels?",
              .ground_truth =
                  "The reference shader in double, mean of 1024 facets of GGX for each pixel. "
                  "Tests verify it by constant environments, and by linear ones, whose blur has a "
                  "closed form.",
              .input = fmt::format("ball of roughness {0}, {1} x {1} pixels", shown, size)},
         .size = size,
         .methods = glossy_methods(maps),
         .x = shown,
         .ground_truth = [reference, size] { return reference(shown, size); },
         .finish =
             [reference, is_quick](Experiment& report, const Renderings& renderings) {
                 // The ground truth dominates the time: 1024 lookups per pixel and roughness. A
                 // quick run therefore uses smaller images and fewer roughnesses.
                 const int chart_size = is_quick ? quick_ball_size / 2 : full_ball_size;
                 report.charts = {rendered_chart(
                     *renderings.device, roughness_chart("roughness", "Error by roughness", "FLIP"),
                     renderings.methods,
                     is_quick ? std::vector{0.1, 0.2, 0.3, 0.5, 1.0} : all_roughnesses,
                     [&](double roughness) { return reference(roughness, chart_size); })};
                 const std::size_t levels_6 = renderings.methods.size() - 1;
                 for (const std::size_t i : {std::size_t{0}, levels_6})
                     report.pictures.push_back(
                         image_pair("A rough mirror", renderings.methods[i].name,
                                    renderings.images[i].picture, renderings.ground_truth));
                 report.heat_maps.push_back({"FLIP error", renderings.methods[levels_6].name,
                                             renderings.images[levels_6].errors, 0.2});
             }});
}

namespace {

/// The radiance of the light; also of the exact picture.
constexpr double even_radiance = 0.5;

/// A ball of white metal in even light.
/// \param coat_roughness  of a clear coat; below 0: none
Scene white_ball(double roughness, double coat_roughness = -1.0) {
    const auto even = [](const glm::dvec3&) { return glm::dvec3(even_radiance); };
    Scene scene = mirror_ball(cube_map_of(even, 16), 0.0);
    MetallicRoughness metal{glm::vec3(1.0F), 1.0F, static_cast<float>(roughness), {}};
    if (coat_roughness >= 0.0) {
        metal.clearcoat = 1.0F;
        metal.clearcoat_roughness = static_cast<float>(coat_roughness);
    }
    scene.materials.front() = {};
    scene.materials.front().metallic_roughness = metal;
    return scene;
}

Image even_picture(int size) {
    Image picture = make_image(size, size, 3, 32, ColorSpace::linear);
    std::ranges::fill(picture.as<float>(), static_cast<float>(even_radiance));
    return picture;
}

/// With and without the effect "energy compensation".
std::vector<RenderedMethod> energy_methods(const std::function<Scene(double)>& ball) {
    return {{"one bounce",
             {{"bounces", "1"}},
             [ball](double roughness) {
                 return Rendering{.scene = ball(roughness),
                                  .effects = {{"energy compensation", false}}};
             }},
            {"all bounces", {{"bounces", "all"}}, [ball](double roughness) {
                 return Rendering{ball(roughness)};
             }}};
}

}  // namespace

PreparedExperiment energy_experiment(const PlanOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    const auto of_metal = [](double roughness) { return white_ball(roughness); };
    const auto of_coat = [](double roughness) { return white_ball(0.0, roughness); };
    const auto chart = [=, chart_size = options.is_quick ? 64 : 160](
                           const GlDevice& device, const char* id, const char* title,
                           const std::function<Scene(double)>& ball) {
        return rendered_chart(
            device, roughness_chart(id, title, "lost light in percent"), energy_methods(ball),
            all_roughnesses, [=](double) { return even_picture(chart_size); },
            PictureMetric::percent);
    };
    return prepare_rendering(
        options.device.get(),
        {.report =
             {.question = "How much light do rough surfaces lose, and what does it cost to keep "
                          "it?",
              .ground_truth = "In even light, a white surface is exactly as bright as the light, "
                              "from every direction.",
              .input = fmt::format("ball of white metal of roughness 1 in even light, {0} x {0} "
                                   "pixels; errors are the lost share of the light",
                                   size)},
         .size = size,
         .methods = energy_methods(of_metal),
         .x = 1.0,
         .ground_truth = [size] { return even_picture(size); },
         .metric = PictureMetric::percent,
         .finish =
             [=](Experiment& report, const Renderings& renderings) {
                 report.charts = {
                     chart(*renderings.device, "roughness", "Lost light by roughness", of_metal),
                     chart(*renderings.device, "coat", "Lost light by roughness of a clear coat",
                           of_coat)};
             }});
}

}  // namespace relief::accuracy::detail
