// SPDX-License-Identifier: Apache-2.0
// Environments by direction: layouts, blur and spherical harmonics against closed forms.
#include "reference/lookups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../render/draw_test.h"

namespace relief::reference {
namespace {

/// Faces of size x size texels, each texel by the direction of its centre.
template <typename Light>
Environment faces_of(int size, Light light) {
    CubeFaces faces;
    const auto direction = [](std::size_t face, double s, double t) -> glm::dvec3 {
        const glm::dvec3 ways[] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t},
                                   {s, -1, -t}, {s, -t, 1},  {-s, -t, -1}};
        return glm::normalize(ways[face]);
    };
    for (std::size_t face = 0; face < 6; ++face) {
        Image image = make_image(size, size, 3, 32, ColorSpace::linear);
        auto samples = image.as<float>();
        for (int i = 0; i < size * size; ++i) {
            const glm::dvec3 way = direction(face, (2.0 * (i % size) + 1.0) / size - 1.0,
                                             (2.0 * (i / size) + 1.0) / size - 1.0);
            const glm::dvec3 radiance = light(way);
            for (int c = 0; c < 3; ++c)
                samples[static_cast<std::size_t>(3 * i + c)] = static_cast<float>(radiance[c]);
        }
        faces.faces[face] = {"face", image};
    }
    Environment environment{faces};
    environment.lights = true;
    return environment;
}

/// Radiance that grows by 1/2 along each axis.
glm::dvec3 slope(const glm::dvec3& d) {
    return 0.5 + 0.5 * d;
}

const glm::dvec3 ways[] = {{1, 0.2, 0.3},   {-1, 0.5, -0.2}, {0.3, 1, 0.1}, {-0.2, -1, 0.6},
                           {0.4, -0.7, 1},  {0.1, 0.2, -1},  {1, 1, 1.01},  {0, 0, 1},
                           {0.0, 1.0, 0.0}, {-3, -2.9, 2.8}};

void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double tolerance) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], expected[i], tolerance) << i;
}

TEST(EnvironmentLookups, FindDirectionsOnTheirFaces) {
    Report report;
    const EnvironmentLookup lookup(faces_of(64, slope), report);
    // Half a texel of a face: 1/64 in direction, and half of that in radiance.
    for (const glm::dvec3& way : ways)
        expect_near(lookup.radiance(way), slope(glm::normalize(way)), 1.0 / 128);
}

TEST(EnvironmentLookups, GoOnAcrossTheEdgesOfFaces) {
    // One texel a face: half-way between two faces' centres is the mean of both.
    const glm::dvec3 ends[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    Report report;
    const EnvironmentLookup lookup(faces_of(1, slope), report);
    for (const glm::dvec3& a : ends) {
        for (const glm::dvec3& b : ends) {
            if (glm::dot(a, b) != 0.0) continue;
            expect_near(lookup.radiance(a + b), 0.5 * (slope(a) + slope(b)), 1e-7);
            expect_near(lookup.radiance(1.0000001 * a + b), 0.5 * (slope(a) + slope(b)), 1e-6);
        }
    }
}

TEST(EnvironmentLookups, OfLeftHandedFacesTurnXRound) {
    Environment environment = faces_of(64, slope);
    std::get<CubeFaces>(environment.source).left_handed = true;
    Report report;
    const EnvironmentLookup lookup(environment, report);
    for (const glm::dvec3& way : ways) {
        const glm::dvec3 turned(-way.x, way.y, way.z);
        expect_near(lookup.radiance(way), slope(glm::normalize(turned)), 1.0 / 128);
    }
}

TEST(EnvironmentLookups, FindDirectionsInCrosses) {
    const Environment six = faces_of(16, slope);
    const auto& faces = std::get<CubeFaces>(six.source).faces;
    const std::array<glm::ivec2, 6> cells{{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}};
    Image cross = make_image(64, 48, 3, 32, ColorSpace::linear);
    for (std::size_t face = 0; face < 6; ++face) {
        const Image& image = *std::get<Shared<Image>>(faces.at(face).source);
        for (int i = 0; i < 16 * 16 * 3; ++i) {
            const glm::ivec2 at = 16 * cells.at(face) + glm::ivec2(i / 3 % 16, i / 48);
            cross.as<float>()[static_cast<std::size_t>(3 * (64 * at.y + at.x) + i % 3)] =
                image.as<float>()[static_cast<std::size_t>(i)];
        }
    }
    Report report;
    const EnvironmentLookup by_face(six, report);
    const EnvironmentLookup by_cross(Environment{CubeCross{{"cross", cross}}}, report);
    for (const glm::dvec3& way : ways)
        expect_near(by_cross.radiance(way), by_face.radiance(way), 0.0);
}

/// A picture of slope() by the formula of a panorama's or a probe's texel.
template <typename Direction>
Image picture(int width, int height, Direction direction) {
    Image image = make_image(width, height, 3, 32, ColorSpace::linear);
    auto samples = image.as<float>();
    for (int i = 0; i < width * height; ++i) {
        const glm::dvec3 light =
            slope(direction((i % width + 0.5) / width, (i / width + 0.5) / height));
        for (int c = 0; c < 3; ++c)
            samples[static_cast<std::size_t>(3 * i + c)] = static_cast<float>(light[c]);
    }
    return image;
}

TEST(EnvironmentLookups, FindDirectionsInPanoramas) {
    const Image image = picture(256, 128, [](double u, double v) {
        const double longitude = (u - 0.5) * 2.0 * std::numbers::pi;
        const double latitude = (0.5 - v) * std::numbers::pi;
        return glm::dvec3(std::sin(longitude) * std::cos(latitude), std::sin(latitude),
                          -std::cos(longitude) * std::cos(latitude));
    });
    Report report;
    const EnvironmentLookup lookup(Environment{Equirectangular{{"panorama", image}}}, report);
    for (const glm::dvec3& way : ways)
        expect_near(lookup.radiance(way), slope(glm::normalize(way)), 0.01);
}

TEST(EnvironmentLookups, FindDirectionsInProbes) {
    const Image image = picture(256, 256, [](double u, double v) {
        const glm::dvec2 place(2.0 * u - 1.0, 1.0 - 2.0 * v);
        const double angle = std::min(glm::length(place), 1.0) * std::numbers::pi;
        const glm::dvec2 across = glm::normalize(place) * std::sin(angle);
        return glm::dvec3(across, -std::cos(angle));
    });
    Report report;
    const EnvironmentLookup lookup(Environment{AngularMap{{"probe", image}}}, report);
    for (const glm::dvec3& way : ways)
        // Two texels are left out at the rim, which is +z: 0.05 radians.
        expect_near(lookup.radiance(way), slope(glm::normalize(way)), 0.03);
}

TEST(EnvironmentLookups, HaveTheEnvironmentsIntensity) {
    Trace trace;
    Environment environment = test::constant_environment({0.25F, 0.5F, 1.0F}, false);
    environment.intensity = 3.0F;
    environment.lights = true;
    Report report;
    const EnvironmentLookup lookup(environment, report);
    const glm::dvec3 expected(0.75, 1.5, 3.0);
    expect_near(lookup.radiance({1, 2, 3}), expected, 1e-12);
    expect_near(lookup.blurred({1, 2, 3}, 0.6, trace), expected, 1e-12);
    expect_near(lookup.diffuse({0, 1, 0}), expected, 1e-9);
}

TEST(EnvironmentLookups, ShedLightOnSurfacesByTheConvolvedCosine) {
    // Over pi, a radiance of 1/2 + d/2 sheds 1/2 + (2/3) n/2.
    Report report;
    const EnvironmentLookup lookup(faces_of(64, slope), report);
    for (const glm::dvec3& way : ways) {
        const glm::dvec3 n = glm::normalize(way);
        expect_near(lookup.diffuse(n), 0.5 + n / 3.0, 1e-3);
    }
}

TEST(EnvironmentLookups, BlurMoreTheRougherTheSurface) {
    Trace trace;
    Report report;
    const EnvironmentLookup lookup(faces_of(64, slope), report);
    const glm::dvec3 way = glm::normalize(glm::dvec3(0.3, 0.2, 1.0));
    expect_near(lookup.blurred(way, 0.0, trace), lookup.radiance(way), 0.0);
    expect_near(lookup.blurred(way, 0.05, trace), slope(way), 0.01);
    // Blurred about an axis, a slope keeps its direction: 1/2 + share way/2, share falling.
    double last = 1.0;
    for (const double roughness : {0.2, 0.5, 0.8, 1.0}) {
        const double share = (lookup.blurred(way, roughness, trace).z - 0.5) / (0.5 * way.z);
        EXPECT_LT(share, last);
        last = share;
    }
    // Roughness 1 draws h with density cos / pi; the mean of l.z by l.z, l = 2 h.z h - z, is
    // integral z^2 over integral z with z = 2c^2 - 1: (1/3 sqrt(8))... by c^2 = q uniform: 2/3.
    EXPECT_NEAR(last, 2.0 / 3.0, 0.01);
}

TEST(DirectionalAlbedo, OfASmoothSurfaceIsSchlicks) {
    for (const double cosine : {1.0, 0.7, 0.3}) {
        const glm::dvec2 albedo = directional_albedo(cosine, 0.045);
        const double grazing = std::pow(1.0 - cosine, 5.0);
        EXPECT_NEAR(albedo.x, 1.0 - grazing, 0.01) << cosine;
        EXPECT_NEAR(albedo.y, grazing, 0.01) << cosine;
    }
}

TEST(DirectionalAlbedo, LosesWhatScattersTwice) {
    // White microfacets send everything on, some of it into others.
    double last = 1.001;
    for (const double roughness : {0.1, 0.5, 1.0}) {
        const glm::dvec2 albedo = directional_albedo(0.6, roughness);
        EXPECT_LT(albedo.x + albedo.y, last);
        last = albedo.x + albedo.y;
    }
    EXPECT_GT(last, 0.4);
}

}  // namespace
}  // namespace relief::reference
