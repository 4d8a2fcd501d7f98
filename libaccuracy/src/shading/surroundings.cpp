// SPDX-License-Identifier: Apache-2.0
// Tests: tests/accuracy/surroundings_experiments_test.cpp.
#include "shading/surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "drawn/lit_scene.h"
#include "environment/environment_images.h"
#include "parallel.h"
#include "relief/mesh/shapes.h"

namespace relief {
namespace {

constexpr double eye_distance = 3.0;
/// Of the picture's half side, on the plane at distance 1: its corners just see the ball.
constexpr double half_side = 0.235;

/// Image rows in turn on all threads.
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

/// The mean of a grid of places in a pixel or texel.
template <typename Value>
glm::dvec3 mean_over(double x, double y, int side, Value value) {
    glm::dvec3 sum(0.0);
    for (int i = 0; i < side * side; ++i)
        sum += value(x + (i % side + 0.5) / side, y + (i / side + 0.5) / side);
    return sum / static_cast<double>(side * side);
}

/// Which way the ball throws a ray from the eye; both unit, the ray meets the ball.
glm::dvec3 mirrored(const glm::dvec3& ray) {
    const glm::dvec3 eye(0.0, 0.0, eye_distance);
    const double along = glm::dot(eye, ray);
    const double far =
        -along - std::sqrt(std::max(along * along - eye_distance * eye_distance + 1.0, 0.0));
    const glm::dvec3 normal = eye + far * ray;
    return ray - 2.0 * glm::dot(ray, normal) * normal;
}

}  // namespace

glm::dvec3 waves_and_lamps(const glm::dvec3& direction_world) {
    struct Wave {
        glm::dvec3 way;
        glm::dvec3 strength;
    };
    static const std::array waves = {
        Wave{{0.0, 2.0, 0.0}, {0.06, 0.08, 0.12}}, Wave{{9.0, 4.0, -6.0}, {0.08, 0.05, 0.02}},
        Wave{{-14.0, 20.0, 9.0}, {0.03, 0.07, 0.05}}, Wave{{31.0, -22.0, 37.0}, {0.05, 0.03, 0.06}},
        Wave{{58.0, 61.0, 26.0}, {0.04, 0.04, 0.02}}};
    static const std::array lamps = {glm::normalize(glm::dvec3(0.4, 0.5, 0.8)),
                                     glm::normalize(glm::dvec3(-0.7, 0.2, 0.3)),
                                     glm::normalize(glm::dvec3(0.1, -0.6, -0.5))};
    glm::dvec3 radiance(0.3);
    for (const Wave& wave : waves)
        radiance += wave.strength * std::sin(glm::dot(wave.way, direction_world));
    for (const glm::dvec3& lamp : lamps)
        radiance += 0.4 * std::exp(900.0 * (glm::dot(lamp, direction_world) - 1.0));
    return glm::clamp(radiance, 0.0, 1.0);
}

Environment cube_map_of(const Surroundings& surroundings, int size) {
    CubeFaces faces;
    for (std::size_t face = 0; face < 6; ++face) {
        Image image = make_image(size, size, 3, 32, ColorSpace::linear);
        fill(image, [&](double x, double y) {
            return mean_over(x, y, 2, [&](double column, double row) {
                return surroundings(glm::normalize(
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
    camera.vertical_fov = static_cast<float>(2.0 * std::atan(half_side));
    scene.camera = camera;
    return scene;
}

Image true_mirror(const Surroundings& surroundings, int size, int rays_a_side) {
    Image picture = make_image(size, size, 3, 32, ColorSpace::linear);
    fill(picture, [&](double x, double y) {
        return mean_over(x, y, rays_a_side, [&](double column, double row) {
            return surroundings(
                mirrored(glm::normalize(glm::dvec3((2.0 * column / size - 1.0) * half_side,
                                                   (1.0 - 2.0 * row / size) * half_side, -1.0))));
        });
    });
    return picture;
}

}  // namespace relief
