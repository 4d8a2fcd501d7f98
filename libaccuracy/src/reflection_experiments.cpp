// SPDX-License-Identifier: Apache-2.0
// Experiments on reflected environments: the size of cube maps for a mirror, and blurred mip levels
// for rough mirrors. The environment is a formula, so the exact reflection is known.
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

void finish_cube_map_sizes(Experiment& experiment, const Renderings& renderings) {
    const std::vector<RenderedMethod>& methods = renderings.methods;
    Curve curve{.method = "cube map"};
    for (std::size_t i = 0; i < methods.size(); ++i)
        curve.points.push_back(
            {smallest_map_side * std::exp2(i), experiment.measurements[i].error.rms});
    curve.order = fitted_order(curve.points);
    experiment.charts = {{.id = "size",
                          .title = "Error by size",
                          .x_label = "texels along a face",
                          .y_label = "FLIP",
                          .curves = {std::move(curve)}}};
    for (const std::size_t i : {1U, 3U})  // 32 and 128 texels.
        add_images("The environment in a mirror", renderings, i, 0.5, experiment);
}

}  // namespace

PreparedExperiment reflection_experiment(const PlanOptions& options) {
    const int size = options.is_quick ? 160 : 320;
    const int rays = 4;
    const int largest = options.is_quick ? 256 : 1024;
    Experiment experiment = image_experiment(size);
    experiment.question = "How large must a cube map be for a mirror?";
    experiment.ground_truth = fmt::format(
        "The formula of the environment in the directions that an exact ball "
        "reflects, mean of {} rays per pixel. A test verifies it by the reference "
        "shader.",
        rays * rays);
    experiment.input = fmt::format(
        "mirror ball, environment with details of 3 degrees, {0} x {0} "
        "pixels, about 0.7 degrees of the environment in each",
        size);
    const std::shared_ptr<const GlDevice> device = options.device.get();
    if (!device->is_available()) return not_rendered(std::move(experiment), *device);
    std::vector<RenderedMethod> methods;
    for (int side = smallest_map_side; side <= largest; side *= 2) {
        methods.push_back({name_of(side),
                           {{"size", fmt::format("{}", side)}},
                           mirror_ball(cube_map_of(waves_and_lights, side), 0.0),
                           1,
                           1,
                           bytes_of(side)});
    }
    return prepare_rendering(device, std::move(experiment), std::move(methods),
                             exact_mirror(waves_and_lights, size, rays), finish_cube_map_sizes,
                             {name_of(32), name_of(128), name_of(largest)});
}

namespace {

/// Cube maps below 256 texels have fewer and smaller blurred levels (libshade/src/gl/cube_map.h).
constexpr int large = 256;
constexpr int small_map_side = 128;
/// Image sizes in pixels.
constexpr int full_ball_size = 192;
constexpr int quick_ball_size = 64;

/// The environments, and the methods for one roughness.
struct Balls {
    Environment finest = cube_map_of(waves_and_lights, large);
    Environment coarser = cube_map_of(waves_and_lights, small_map_side);

    [[nodiscard]] std::vector<RenderedMethod> methods(double roughness) const {
        return {{"not blurred", {{"levels", "none"}}, mirror_ball(finest, 0.0)},
                {"5 levels, 128 texels", {{"levels", "5"}}, mirror_ball(coarser, roughness)},
                {"6 levels, 256 texels", {{"levels", "6"}}, mirror_ball(finest, roughness)}};
    }
};

/// The ground truth dominates the time: 1024 lookups per pixel and roughness. A quick run therefore
/// uses smaller images and fewer roughnesses.
Chart roughness_chart(const GlDevice& device, const Balls& balls, bool is_quick) {
    const int size = is_quick ? quick_ball_size / 2 : full_ball_size;
    std::vector<double> roughnesses = {0.1, 0.2, 0.3, 0.5, 1.0};
    if (!is_quick) roughnesses = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
    struct Input {
        Image ground_truth;
        std::vector<RenderedMethod> methods;
    };
    return chart_over(
        {.id = "roughness",
         .title = "Error by roughness",
         .x_label = "roughness",
         .y_label = "FLIP",
         .is_x_log = false},
        names_of(balls.methods(0.0)), roughnesses,
        [&](double roughness) {
            return Input{supersampled_reference(mirror_ball(balls.finest, roughness), size, 1),
                         balls.methods(roughness)};
        },
        [&](std::size_t i, const Input& input) {
            return rendered_error(device, input.methods[i], input.ground_truth);
        });
}

}  // namespace

PreparedExperiment glossy_experiment(const PlanOptions& options) {
    const int size = options.is_quick ? quick_ball_size : full_ball_size;
    constexpr double shown = 0.3;
    Experiment experiment = image_experiment(size);
    experiment.question = "How accurate are rough mirrors with a few blurred mip levels?";
    experiment.ground_truth =
        "The reference shader in double, mean of 1024 facets of GGX for each pixel. Tests "
        "verify it by constant environments, and by linear ones, whose blur has a closed "
        "form.";
    experiment.input = fmt::format("ball of roughness {0}, {1} x {1} pixels", shown, size);
    const std::shared_ptr<const GlDevice> device = options.device.get();
    if (!device->is_available()) return not_rendered(std::move(experiment), *device);
    const auto balls = std::make_shared<const Balls>();
    return prepare_rendering(
        device, std::move(experiment), balls->methods(shown),
        supersampled_reference(mirror_ball(balls->finest, shown), size, 1),
        [device = device.get(), balls, is_quick = options.is_quick](Experiment& report,
                                                                    const Renderings& renderings) {
            report.charts = {roughness_chart(*device, *balls, is_quick)};
            const std::size_t levels_6 = renderings.methods.size() - 1;
            for (const std::size_t i : {std::size_t{0}, levels_6})
                report.pictures.push_back(image_pair("A rough mirror", renderings.methods[i].name,
                                                     renderings.images[i].picture,
                                                     renderings.ground_truth));
            report.heat_maps.push_back({"FLIP error", renderings.methods[levels_6].name,
                                        renderings.images[levels_6].errors, 0.2});
        });
}

}  // namespace relief::accuracy::detail
