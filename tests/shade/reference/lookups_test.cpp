// SPDX-License-Identifier: Apache-2.0
// Lookups of the CPU reference: small textures by hand, and environments by direction against
// closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "reference/reference_parts.h"
#include "shade/render/draw_support.h"

namespace relief::shade::reference {
namespace {

constexpr Wrap all_wraps[] = {Wrap::repeat, Wrap::clamp, Wrap::mirror};

/// A row of gray texels: 0, 1, 2, 3.
Texels ramp() {
    Image image = make_image(4, 1, 1, 32, ColorSpace::data);
    image.samples = std::vector<float>{0, 1, 2, 3};
    return Texels(image);
}

TEST(Texels, FollowTheWrapMode) {
    const int indices[] = {-9, -5, -4, -1, 0, 3, 4, 7, 8, 11};
    const int repeated[] = {3, 3, 0, 3, 0, 3, 0, 3, 0, 3};
    const int clamped[] = {0, 0, 0, 0, 0, 3, 3, 3, 3, 3};
    const int mirrored[] = {0, 3, 3, 0, 0, 3, 3, 0, 0, 3};
    for (std::size_t i = 0; i < std::size(indices); ++i) {
        SCOPED_TRACE(indices[i]);
        EXPECT_EQ(wrapped(indices[i], 4, Wrap::repeat), repeated[i]);
        EXPECT_EQ(wrapped(indices[i], 4, Wrap::clamp), clamped[i]);
        EXPECT_EQ(wrapped(indices[i], 4, Wrap::mirror), mirrored[i]);
    }
}

TEST(Texels, StayWithinTheTextureHoweverFarAway) {
    for (const Wrap wrap : all_wraps) {
        for (const double index : {1e15, -1e15, 1e300, -1e300}) {
            const int found = wrapped(index, 3, wrap);
            EXPECT_TRUE(found >= 0 && found < 3) << found;
        }
    }
}

TEST(Texels, AreExactAtTheirCentersAndLinearBetween) {
    const Texels texels = ramp();
    const auto at = [&](double u, Wrap wrap) { return texels.bilinear({u, 0.5}, wrap, wrap).r; };
    for (const Wrap wrap : all_wraps) {
        EXPECT_EQ(at(0.125, wrap), 0.0);
        EXPECT_EQ(at(0.875, wrap), 3.0);
        EXPECT_NEAR(at(0.4375, wrap), 1.25, 1e-15);
    }
    // This point is a quarter of a texel to the left of the first texel center.
    EXPECT_NEAR(at(0.0625, Wrap::repeat), 0.75, 1e-15);
    EXPECT_EQ(at(0.0625, Wrap::clamp), 0.0);
    EXPECT_EQ(at(0.0625, Wrap::mirror), 0.0);
    EXPECT_NEAR(at(1.25, Wrap::mirror), 2.5, 1e-15);
}

TEST(Texels, NearestContainsThePoint) {
    const Texels texels = ramp();
    Trace trace;
    const auto at = [&](double u) {
        return texels.nearest({u, 0.5}, Wrap::repeat, Wrap::repeat, trace).r;
    };
    EXPECT_EQ(at(0.24), 0.0);
    EXPECT_EQ(at(0.26), 1.0);
    EXPECT_EQ(at(-0.01), 3.0);
    EXPECT_EQ(at(1.26), 1.0);
}

TEST(Texels, VGrowsDownwards) {
    Image image = make_image(1, 2, 1, 32, ColorSpace::data);
    image.samples = std::vector<float>{7, 9};
    const Texels texels(image);
    EXPECT_EQ(texels.bilinear({0.5, 0.25}, Wrap::clamp, Wrap::clamp).r, 7.0);
    EXPECT_EQ(texels.bilinear({0.5, 0.75}, Wrap::clamp, Wrap::clamp).r, 9.0);
}

TEST(Texels, AreDecodedBeforeTheyAreFilteredAndAlphaIsNot) {
    Image image = make_image(2, 1, 4, 8, ColorSpace::srgb);
    image.samples = std::vector<std::uint8_t>{255, 255, 255, 255, 0, 0, 0, 51};
    const glm::dvec4 between = Texels(image).bilinear({0.5, 0.5}, Wrap::clamp, Wrap::clamp);
    EXPECT_NEAR(between.r, 0.5, 1e-7);
    EXPECT_NEAR(between.a, 0.6, 1e-7);
}

TEST(Texels, AreRgbaForAnyImage) {
    const auto of = [](std::vector<float> samples) {
        Image image = make_image(1, 1, static_cast<int>(samples.size()), 32, ColorSpace::linear);
        image.samples = std::move(samples);
        return Texels(image).at(0, 0);
    };
    EXPECT_EQ(of({5}), glm::dvec4(5, 5, 5, 1));
    EXPECT_EQ(of({5, 2}), glm::dvec4(5, 5, 5, 2));
    EXPECT_EQ(of({5, 6, 7}), glm::dvec4(5, 6, 7, 1));
    EXPECT_EQ(of({5, 6, 7, 8}), glm::dvec4(5, 6, 7, 8));
}

TEST(Texels, AtNaNAreNaN) {
    Trace trace;
    const glm::dvec2 nowhere(std::numeric_limits<double>::quiet_NaN(), 0.5);
    for (const Wrap wrap : all_wraps) {
        EXPECT_TRUE(std::isnan(ramp().bilinear(nowhere, wrap, wrap).r));
        EXPECT_TRUE(std::isnan(ramp().nearest(nowhere, wrap, wrap, trace).r));
    }
}

/// Faces of size x size texels with a value for the direction of each texel center.
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

/// Radiance that increases by 1/2 along each axis.
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
    // The error of half a texel of a face is 1/64 in direction, and half of that in radiance.
    for (const glm::dvec3& way : ways)
        expect_near(lookup.radiance(way), slope(glm::normalize(way)), 1.0 / 128);
}

TEST(EnvironmentLookups, ContinueAcrossFaces) {
    // Each face has one texel. In the middle between the centers of two faces, a lookup is the mean
    // of both.
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

TEST(EnvironmentLookups, LeftHandedFacesNegateX) {
    Environment environment = faces_of(64, slope);
    std::get<CubeFaces>(environment.source).left_handed = true;
    Report report;
    const EnvironmentLookup lookup(environment, report);
    for (const glm::dvec3& way : ways) {
        const glm::dvec3 turned(-way.x, way.y, way.z);
        expect_near(lookup.radiance(way), slope(glm::normalize(turned)), 1.0 / 128);
    }
}

TEST(EnvironmentLookups, RotationTurnsZToX) {
    Environment environment = faces_of(64, slope);
    environment.rotation = 0.5F * std::numbers::pi_v<float>;
    environment.lights = true;
    Report report;
    const EnvironmentLookup lookup(environment, report);
    environment.rotation = 0.0F;
    const EnvironmentLookup before(environment, report);
    for (const glm::dvec3& way : ways) {
        const glm::dvec3 turned(way.z, way.y, -way.x);
        expect_near(lookup.radiance(turned), before.radiance(way), 1e-6);
        expect_near(lookup.diffuse(glm::normalize(turned)), before.diffuse(glm::normalize(way)),
                    1e-6);
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

/// An image of slope() by the formula for the texels of a panorama or a probe.
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

TEST(EnvironmentLookups, RotatedPanoramasMatchOtherViewers) {
    // A horizontal wave, brightest at u = 0.3.
    const auto wave = [](double u) { return 1.0 - 2.0 * std::abs(std::remainder(u - 0.3, 1.0)); };
    const Image image = picture(256, 128, [&](double u, double) {
        return glm::dvec3(2.0 * wave(u) - 1.0, 0.0, 0.0);  // slope() is the wave.
    });
    struct Viewer {
        const char* name;
        double degrees;
        double (*angle)(double x, double z);  // Of the lookup: 2 pi (u - 1/2).
    };
    const Viewer viewers[] = {
        {"three.js", -90.0, [](double x, double z) { return std::atan2(z, x); }},
        {"glTF Sample Viewer, +Z", 180.0, [](double x, double z) { return std::atan2(-x, z); }}};
    for (const Viewer& viewer : viewers) {
        Environment environment{Equirectangular{{"panorama", image}}};
        environment.rotation = static_cast<float>(viewer.degrees * std::numbers::pi / 180.0);
        Report report;
        const EnvironmentLookup lookup(environment, report);
        for (const double around : {0.3, 1.0, 2.0, 2.9, 4.0, 5.0, 6.1}) {
            const double x = std::cos(around);
            const double z = std::sin(around);
            const double u = viewer.angle(x, z) / (2.0 * std::numbers::pi) + 0.5;
            EXPECT_NEAR(lookup.radiance({x, 0.0, z}).r, wave(u), 0.01)
                << viewer.name << " " << around;
        }
    }
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
        // The test omits two texels at the rim, which is +z: 0.05 radians.
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
    // The irradiance of a radiance of 1/2 + d/2, divided by pi, is 1/2 + (2/3) n/2.
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
    // A slope that is blurred about an axis keeps its direction: 1/2 + share * direction / 2. The
    // share decreases with the roughness.
    double last = 1.0;
    for (const double roughness : {0.2, 0.5, 0.8, 1.0}) {
        const double share = (lookup.blurred(way, roughness, trace).z - 0.5) / (0.5 * way.z);
        EXPECT_LT(share, last);
        last = share;
    }
    // For roughness 1, h has the density cos / pi. The mean of l.z weighted by l.z, with l = 2 h.z
    // h - z, is the integral of z^2 divided by that of z. With z = 2c^2 - 1 and c^2 uniform it is
    // 2/3.
    EXPECT_NEAR(last, 2.0 / 3.0, 0.01);
}

TEST(DirectionalAlbedo, SmoothSurfaceHasSchlicksFactor) {
    for (const double cosine : {1.0, 0.7, 0.3}) {
        const glm::dvec2 albedo = directional_albedo(cosine, 0.045);
        const double grazing = std::pow(1.0 - cosine, 5.0);
        EXPECT_NEAR(albedo.x, 1.0 - grazing, 0.01) << cosine;
        EXPECT_NEAR(albedo.y, grazing, 0.01) << cosine;
    }
}

TEST(DirectionalAlbedo, OmitsMultipleScattering) {
    // White microfacets lose no light, but other facets receive a part of it.
    double last = 1.001;
    for (const double roughness : {0.1, 0.5, 1.0}) {
        const glm::dvec2 albedo = directional_albedo(0.6, roughness);
        EXPECT_LT(albedo.x + albedo.y, last);
        last = albedo.x + albedo.y;
    }
    EXPECT_GT(last, 0.4);
}

}  // namespace
}  // namespace relief::shade::reference
