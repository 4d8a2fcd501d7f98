// SPDX-License-Identifier: Apache-2.0
// The truth of pictures against closed forms: a lit sphere, and how much of pixels a disc covers.
#include "drawn/many_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drawn/lit_scene.h"
#include "relief/mesh/shapes.h"

namespace relief {
namespace {

/// Straight ahead of a unit sphere, from +z.
Camera camera_before(double distance, double vertical_fov) {
    Camera camera;
    camera.world_from_view[3] = glm::vec4(0.0F, 0.0F, static_cast<float>(distance), 1.0F);
    camera.vertical_fov = static_cast<float>(vertical_fov);
    return camera;
}

glm::dvec3 pixel(const Image& image, int x, int y) {
    const auto i = static_cast<std::size_t>(3 * (y * image.width + x));
    const std::span<const float> samples = image.as<float>();
    return {samples[i], samples[i + 1], samples[i + 2]};
}

/// Ambient, Lambert's and Blinn's terms of glossy_plastic() under lit_scene()'s lamp, by hand.
glm::dvec3 radiance_on_sphere(const glm::dvec3& normal, const glm::dvec3& eye) {
    const Material material = glossy_plastic();
    const glm::dvec3 light = -glm::normalize(glm::dvec3(lamp_direction_world));
    const glm::dvec3 half = glm::normalize(light + glm::normalize(eye - normal));
    const double n_dot_l = glm::dot(normal, light);
    glm::dvec3 radiance = glm::dvec3(material.ambient) * double{lit_ambient};
    if (n_dot_l > 0.0) {
        radiance += double{lamp_irradiance} *
                    (glm::dvec3(material.diffuse) * n_dot_l +
                     glm::dvec3(material.specular) * std::pow(std::max(glm::dot(normal, half), 0.0),
                                                              double{material.shininess}));
    }
    return glm::min(radiance, 1.0);
}

TEST(ManySamples, OfASphereAreTheClosedForm) {
    constexpr int size = 24;
    constexpr double distance = 3.0;
    constexpr double fov = 0.5;  // The whole picture lies on the sphere.
    // Lit from the front left, so that some of it is dark.
    Scene scene = lit_scene(make_sphere(1024, 512), glossy_plastic());
    scene.camera = camera_before(distance, fov);
    const Image picture = many_samples(scene, size, 1);
    const glm::dvec3 eye(0.0, 0.0, distance);
    double brightest = 0.0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const double top = std::tan(0.5 * double{scene.camera->vertical_fov});
            const glm::dvec3 ray = glm::normalize(glm::dvec3(
                ((x + 0.5) / size * 2.0 - 1.0) * top, (1.0 - (y + 0.5) / size * 2.0) * top, -1.0));
            const double along = glm::dot(eye, ray);
            const glm::dvec3 normal =
                eye + (-along - std::sqrt(along * along - distance * distance + 1.0)) * ray;
            const glm::dvec3 expected = radiance_on_sphere(normal, eye);
            brightest = std::max(brightest, expected.r);
            // The mesh's facets lie up to 2e-5 below the sphere.
            EXPECT_LT(glm::distance(pixel(picture, x, y), expected), 1e-3) << x << ", " << y;
        }
    }
    EXPECT_GT(brightest, 0.6) << "the highlight is in the picture";
}

TEST(ManySamples, CoverWhatADiscCovers) {
    constexpr int size = 24;
    constexpr double distance = 4.0;
    Material white;
    white.unlit = true;
    white.diffuse = glm::vec3(1.0F);
    Scene scene = lit_scene(make_sphere(1024, 512), white);
    scene.background = glm::vec4(0.0F, 0.0F, 0.0F, 1.0F);
    scene.camera = camera_before(distance, 0.7);
    const Image picture = many_samples(scene, size, 16);
    double sum = 0.0;
    for (const float sample : picture.as<float>())
        sum += sample / 3.0;
    // The sphere's outline is seen at asin(1 / distance).
    const double radius = std::tan(std::asin(1.0 / distance)) / std::tan(0.35) * size / 2.0;
    const double expected = std::numbers::pi * radius * radius;
    EXPECT_NEAR(sum, expected, 0.002 * expected);
    // One ray a pixel counts pixels, and is further off than that.
    double counted = 0.0;
    const Image single = many_samples(scene, size, 1);
    for (const float sample : single.as<float>())
        counted += sample / 3.0;
    EXPECT_NEAR(counted, std::round(counted), 1e-4);
}

TEST(ManySamples, AreCutBeforeTheyAreAveraged) {
    Material glaring;
    glaring.unlit = true;
    glaring.diffuse = glm::vec3(100.0F);
    Scene scene = lit_scene(make_quad(), glaring);
    // Its right half is off the quad, which ends in the middle of the pixel.
    scene.background = glm::vec4(0.0F, 0.0F, 0.0F, 1.0F);
    scene.camera = camera_before(1.0, 2.0 * std::atan(1.0));
    scene.camera->world_from_view[3].x = 1.0F;
    const Image picture = many_samples(scene, 1, 4);
    EXPECT_NEAR(pixel(picture, 0, 0).r, 0.5, 1e-6);
}

}  // namespace
}  // namespace relief
