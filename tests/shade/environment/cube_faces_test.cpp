// SPDX-License-Identifier: Apache-2.0
// Environment images: cube faces, crosses and light probes, with the direction and solid angle of
// each texel.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "environment/environment_images.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/environment.h"
#include "relief/shade/shared.h"
#include "support/shared_data.h"

namespace relief {
using namespace relief::shade;
using namespace relief::shade::detail;

namespace {

using std::numbers::pi;

/// Six faces whose texels hold the direction of their center.
std::vector<Image> faces_of_directions(int size) {
    std::vector<Image> faces;
    for (std::size_t face = 0; face < 6; ++face) {
        Image image = make_image(size, size, 3, 32, ColorSpace::linear);
        std::size_t i = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const glm::dvec3 direction = face_direction(face, 2.0 * (x + 0.5) / size - 1.0,
                                                            2.0 * (y + 0.5) / size - 1.0);
                for (int c = 0; c < 3; ++c)
                    image.as<float>()[i++] = static_cast<float>(direction[c]);
            }
        }
        faces.push_back(std::move(image));
    }
    return faces;
}

glm::vec3 texel(const Image& image, int x, int y) {
    const auto start = static_cast<std::size_t>(3 * (y * image.width + x));
    const auto samples = image.as<float>();
    return {samples[start], samples[start + 1], samples[start + 2]};
}

/// Copies a face into a cross, optionally rotated by 180 degrees.
void lay(Image& cross, const Image& face, int column, int row, bool turned = false) {
    const int size = face.width;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const glm::vec3 value =
                turned ? texel(face, size - 1 - x, size - 1 - y) : texel(face, x, y);
            const auto start =
                static_cast<std::size_t>(3 * ((row * size + y) * cross.width + column * size + x));
            for (int c = 0; c < 3; ++c)
                cross.as<float>()[start + static_cast<std::size_t>(c)] = value[c];
        }
    }
}

Image horizontal_cross(const std::vector<Image>& faces) {
    const int size = faces[0].width;
    Image cross = make_image(4 * size, 3 * size, 3, 32, ColorSpace::linear);
    lay(cross, faces[2], 1, 0);
    lay(cross, faces[1], 0, 1);
    lay(cross, faces[4], 1, 1);
    lay(cross, faces[0], 2, 1);
    lay(cross, faces[5], 3, 1);
    lay(cross, faces[3], 1, 2);
    return cross;
}

Image vertical_cross(const std::vector<Image>& faces) {
    const int size = faces[0].width;
    Image cross = make_image(3 * size, 4 * size, 3, 32, ColorSpace::linear);
    lay(cross, faces[2], 1, 0);
    lay(cross, faces[1], 0, 1);
    lay(cross, faces[4], 1, 1);
    lay(cross, faces[0], 2, 1);
    lay(cross, faces[3], 1, 2);
    lay(cross, faces[5], 1, 3, true);
    return cross;
}

TEST(CubeFaces, DirectionsRoundTrip) {
    for (std::size_t face = 0; face < 6; ++face) {
        for (const double s : {-0.99, -0.3, 0.0, 0.7}) {
            for (const double t : {-0.9, 0.0, 0.5, 0.99}) {
                const FacePoint point = face_point(7.0 * face_direction(face, s, t));
                EXPECT_EQ(point.face, face);
                EXPECT_NEAR(point.s, s, 1e-15);
                EXPECT_NEAR(point.t, t, 1e-15);
            }
        }
    }
}

TEST(CubeFaces, TheAxesAreTheMiddlesAndTheTopRowIsUp) {
    EXPECT_EQ(face_direction(0, 0, 0), glm::dvec3(1, 0, 0));
    EXPECT_EQ(face_direction(5, 0, 0), glm::dvec3(0, 0, -1));
    for (const std::size_t side : {0U, 1U, 4U, 5U})
        EXPECT_EQ(face_direction(side, 0, -1).y, 1.0);
    EXPECT_EQ(face_direction(2, 0, -1), glm::dvec3(0, 1, -1));
}

TEST(CubeFaces, SolidAnglesAddUpToTheSphere) {
    EXPECT_NEAR(solid_angle({-1, -1}, {1, 1}), 4.0 * pi / 6.0, 1e-15);
    double sum = 0.0;
    constexpr int size = 7;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const glm::dvec2 from(2.0 * x / size - 1.0, 2.0 * y / size - 1.0);
            sum += solid_angle(from, from + 2.0 / size);
        }
    }
    EXPECT_NEAR(sum, 4.0 * pi / 6.0, 1e-14);
    // The solid angle of a small square in the middle equals its area. At a corner it is 3 sqrt(3)
    // times smaller.
    EXPECT_NEAR(solid_angle({0, 0}, {1e-4, 1e-4}) / 1e-8, 1.0, 1e-6);
    EXPECT_NEAR(solid_angle({1 - 1e-4, 1 - 1e-4}, {1, 1}) / 1e-8, 1.0 / std::sqrt(27.0), 1e-4);
}

TEST(CubeFaces, ACrossOfEitherShapeFallsApartIntoItsFaces) {
    const std::vector<Image> faces = faces_of_directions(5);
    for (const Image& cross : {horizontal_cross(faces), vertical_cross(faces)}) {
        const std::vector<Image> cut = faces_of_cross(cross, "cross");
        ASSERT_EQ(cut.size(), 6U);
        for (std::size_t face = 0; face < 6; ++face)
            EXPECT_EQ(cut[face].samples, faces[face].samples) << cube_face_names.at(face);
    }
}

/// Returns the largest difference between adjacent texels of a cross if both belong to faces.
float largest_step(const Image& cross) {
    float largest = 0.0F;
    const auto step = [&](int x0, int y0, int x1, int y1) {
        const glm::vec3 a = texel(cross, x0, y0);
        const glm::vec3 b = texel(cross, x1, y1);
        if (a != glm::vec3(0) && b != glm::vec3(0))
            largest = std::max(largest, glm::distance(a, b));
    };
    for (int y = 0; y + 1 < cross.height; ++y) {
        for (int x = 0; x + 1 < cross.width; ++x) {
            step(x, y, x + 1, y);
            step(x, y, x, y + 1);
        }
    }
    return largest;
}

TEST(CubeFaces, NeighborsInACrossAreNeighborsOnTheCube) {
    const std::vector<Image> faces = faces_of_directions(8);
    // The directions of adjacent texels differ by 2/8 on a face and by sqrt(2)/8 across an edge. A
    // wrong face would give a difference of 1 somewhere.
    EXPECT_LE(largest_step(horizontal_cross(faces)), 0.2501F);
    EXPECT_LE(largest_step(vertical_cross(faces)), 0.2501F);
}

TEST(CubeFaces, ACrossKeepsItsCodes) {
    Image cross = make_image(12, 9, 4, 8, ColorSpace::srgb);
    cross.as<std::uint8_t>()[4 * (12 * 3 + 6) + 3] = 77;  // The upper left texel of +x.
    const std::vector<Image> faces = faces_of_cross(cross, "codes");
    EXPECT_EQ(faces[0].bits(), 8);
    EXPECT_EQ(faces[0].color_space, ColorSpace::srgb);
    EXPECT_EQ(faces[0].as<std::uint8_t>()[3], 77);
}

TEST(CubeFaces, ACrossOfAnotherShapeIsRefused) {
    const auto message = [](int width, int height) -> std::string {
        try {
            (void)faces_of_cross(make_image(width, height, 3, 8, ColorSpace::srgb), "room.png");
            return "accepted";
        } catch (const InvalidInput& error) {
            return error.what();
        }
    };
    EXPECT_EQ(message(100, 50),
              "cross 'room.png' has 100 x 50 texels, but the faces of a cube lie in 4 x 3 "
              "(horizontal) or 3 x 4 (vertical) squares");
    EXPECT_NE(message(5, 4), "accepted");
    EXPECT_NE(message(4, 4), "accepted");
    EXPECT_NE(message(5, 3), "accepted") << "4:3 only in whole numbers";
    EXPECT_EQ(message(4, 3), "accepted") << "faces of one texel";
    EXPECT_EQ(message(3, 4), "accepted");
    EXPECT_THROW(faces_of_cross(Image{}, "nothing"), InvalidInput);
}

TEST(CubeFaces, TheOtherHandTurnsXRound) {
    const std::vector<Image> faces = faces_of_directions(6);
    const std::vector<Image> turned = other_handed(faces);
    for (std::size_t face = 0; face < 6; ++face) {
        for (int y = 0; y < 6; ++y) {
            for (int x = 0; x < 6; ++x) {
                // The direction (x, y, z) has the texel that was at (-x, y, z).
                EXPECT_EQ(texel(turned[face], x, y),
                          texel(faces[face], x, y) * glm::vec3(-1, 1, 1));
            }
        }
    }
    const std::vector<Image> again = other_handed(turned);
    for (std::size_t face = 0; face < 6; ++face)
        EXPECT_EQ(again[face].samples, faces[face].samples);
}

TEST(CubeFaces, ARealSetContinuesFromFaceToFaceInBothCrosses) {
    RELIEF_NEEDS_SHARED(folder, "data/env/cube/venice_sunset_256");
    std::vector<Image> faces;
    for (const char* name : {"posx", "negx", "posy", "negy", "posz", "negz"})
        faces.push_back(read_image(folder / (std::string(name) + ".hdr"), ImageUse::color));
    // The seam between -y and the rotated -z is no rougher than the same number of rows within -y.
    const Image cross = vertical_cross(faces);
    const auto roughness = [&](int row) {
        double sum = 0.0;
        for (int x = 256; x < 512; ++x)
            sum +=
                static_cast<double>(glm::distance(texel(cross, x, row), texel(cross, x, row + 1)));
        return sum / 256.0;
    };
    EXPECT_LT(roughness(767), 2.0 * roughness(760));
    EXPECT_LT(roughness(511), 2.0 * roughness(504)) << "+z to -y";
}

constexpr int wide = 1 << 20;  // In an image of this width, the part that the rim omits is
                               // negligible.

void expect_place(const glm::dvec3& direction, double u, double v) {
    const glm::dvec2 place = angular_map_place(direction, wide);
    EXPECT_NEAR(place.x, u, 1e-5);
    EXPECT_NEAR(place.y, v, 1e-5);
}

TEST(AngularMap, TheMiddleIsMinusZAndHalfwayToTheRimAreTheOtherAxes) {
    expect_place({0, 0, -3}, 0.5, 0.5);
    expect_place({1, 0, 0}, 0.75, 0.5);
    expect_place({-2, 0, 0}, 0.25, 0.5);
    expect_place({0, 1, 0}, 0.5, 0.25);
    expect_place({0, -1, 0}, 0.5, 0.75);
    // A direction of 45 degrees to the right of -z lies at a quarter of the distance to the rim.
    expect_place({1, 0, -1}, 0.625, 0.5);
    expect_place({1, 0, 1}, 0.875, 0.5);
}

TEST(AngularMap, BehindIsTheRimOnTheSideThatTheDirectionLeansTo) {
    expect_place({1e-9, 0, 1}, 1.0, 0.5);
    expect_place({0, 1e-9, 1}, 0.5, 0.0);
    expect_place({0, 0, 1}, 1.0, 0.5);
}

TEST(AngularMap, LookupsReachNoTexelThatTheRimCuts) {
    for (const int width : {8, 32, 511, 512}) {
        for (int i = 0; i < 400; ++i) {
            const double turn = 0.0157 * i;
            const glm::dvec2 place =
                angular_map_place({1e-3 * std::cos(turn), 1e-3 * std::sin(turn), 1}, width);
            // The four texels of a bilinear lookup, relative to their outermost corner.
            const glm::dvec2 from = glm::floor(place * static_cast<double>(width) - 0.5);
            for (const glm::dvec2 corner :
                 {from, from + glm::dvec2(2, 0), from + glm::dvec2(0, 2), from + 2.0}) {
                EXPECT_LE(glm::distance(corner, glm::dvec2(0.5 * width)), 0.5 * width + 1e-9);
            }
        }
    }
}

TEST(AngularMap, AMapOfFewTexelsShowsItsMiddle) {
    EXPECT_EQ(angular_map_reach(1), 0.0);
    EXPECT_EQ(angular_map_reach(4), 0.0);
    EXPECT_EQ(angular_map_place({1, 2, 3}, 1), glm::dvec2(0.5));
    EXPECT_NEAR(angular_map_reach(512), 0.9917, 1e-4);
}

TEST(AngularMap, MustBeSquare) {
    EXPECT_NO_THROW(check_angular_map(make_image(3, 3, 3, 8, ColorSpace::srgb), "ball"));
    try {
        check_angular_map(make_image(512, 256, 3, 32, ColorSpace::linear), "ball.hdr");
        FAIL() << "was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "angular map 'ball.hdr' has 512 x 256 texels, but must be square");
    }
    EXPECT_THROW(check_angular_map(Image{}, "nothing"), InvalidInput);
}

/// Returns the irradiance over pi of a surface in a panorama.
double irradiance(const Image& panorama, const glm::dvec3& normal) {
    const auto samples = panorama.as<float>();
    double sum = 0.0;
    for (int y = 0; y < panorama.height; ++y) {
        const double elevation = pi * (0.5 - (y + 0.5) / panorama.height);
        for (int x = 0; x < panorama.width; ++x) {
            const double right = 2.0 * pi * ((x + 0.5) / panorama.width - 0.5);  // From -z to +x.
            const glm::dvec3 direction(std::cos(elevation) * std::sin(right), std::sin(elevation),
                                       -std::cos(elevation) * std::cos(right));
            const double weight = std::cos(elevation) * 2.0 * pi * pi /
                                  (static_cast<double>(panorama.width) * panorama.height);
            const auto texel = static_cast<std::size_t>(3 * (y * panorama.width + x));
            sum += static_cast<double>(samples[texel]) * weight *
                   std::max(glm::dot(direction, normal), 0.0);
        }
    }
    return sum / pi;
}

TEST(Studio, LightsTheFrontFromTheLeftAndAbove) {
    const Environment studio = studio_environment();
    EXPECT_TRUE(is_studio(studio));
    EXPECT_TRUE(studio.lights);
    EXPECT_FALSE(studio.skybox);
    const auto& source = std::get<Equirectangular>(studio.source).image.source;
    const Image& image = *std::get<Shared<Image>>(source);
    EXPECT_EQ(glm::ivec2(image.width, image.height), glm::ivec2(512, 256));
    const glm::dvec3 to_key = glm::normalize(glm::dvec3(-0.5, 0.78, 0.6));
    const double key = irradiance(image, to_key);
    EXPECT_NEAR(key, 1.2, 0.1);
    EXPECT_NEAR(irradiance(image, {0.0, 0.0, 1.0}), 0.75, 0.1);
    EXPECT_LT(irradiance(image, {1.0, 0.0, 0.0}), 0.7 * key);
    EXPECT_LT(irradiance(image, {0.0, -1.0, 0.0}), 0.2 * key);
    // Other environments with the same name are files.
    Environment file = studio;
    file.source = Equirectangular{{"studio", std::filesystem::path("studio")}};
    EXPECT_FALSE(is_studio(file));
}

}  // namespace
}  // namespace relief
