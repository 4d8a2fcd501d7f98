// SPDX-License-Identifier: Apache-2.0
// Six images around a point: directions, solid angles, crosses and turned hands.
#include "environment/environment_images.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "relief/mesh/error.h"
#include "relief/mesh/image_file.h"
#include "support/shared_data.h"

namespace relief {
namespace {

using std::numbers::pi;

/// Six faces whose texels hold what they show: the direction of their middle.
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

/// Lays a face into a cross, turned by 180 degrees if asked.
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

TEST(CubeFaces, EveryFacePointIsFoundAgainByItsDirection) {
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
    // A small one in the middle is its area; at a corner, 3 sqrt(3) times smaller.
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

/// The largest step between neighbours in a cross, where both belong to faces.
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

TEST(CubeFaces, NeighboursInACrossAreNeighboursOnTheCube) {
    const std::vector<Image> faces = faces_of_directions(8);
    // Directions to texels side by side are 2/8 apart on a face, and sqrt(2)/8 round an edge; any
    // face laid wrongly would be 1 apart somewhere.
    EXPECT_LE(largest_step(horizontal_cross(faces)), 0.2501F);
    EXPECT_LE(largest_step(vertical_cross(faces)), 0.2501F);
}

TEST(CubeFaces, ACrossKeepsItsCodes) {
    Image cross = make_image(12, 9, 4, 8, ColorSpace::srgb);
    cross.as<std::uint8_t>()[4 * (12 * 3 + 6) + 3] = 77;  // Upper left texel of +x.
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
                // In the direction (x, y, z) stands what stood in (-x, y, z).
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
    // The seam between -y and the turned -z, against as many rows within -y: no rougher than those.
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

}  // namespace
}  // namespace relief
