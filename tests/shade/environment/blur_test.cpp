// SPDX-License-Identifier: Apache-2.0
// Blurred surroundings: by integrals known by hand, and the walk down the tree against the sum over
// all texels.
#include "environment/convolution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "relief/mesh/error.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/threads.h"
#include "support/shared_data.h"
#include "test_environments.h"

namespace relief {
namespace {

using test::faces_of;
using test::spread_directions;

/// The texels of faces of this size, all or every so many, with their directions.
struct Probe {
    std::size_t face;
    int x;
    int y;
    glm::dvec3 direction;
};

std::vector<Probe> probes(int size, int step) {
    std::vector<Probe> all;
    for (std::size_t face = 0; face < 6; ++face) {
        for (int y = step / 2; y < size; y += step) {
            for (int x = step / 2; x < size; x += step) {
                all.push_back({face, x, y,
                               face_direction(face, 2.0 * (x + 0.5) / size - 1.0,
                                              2.0 * (y + 0.5) / size - 1.0)});
            }
        }
    }
    return all;
}

glm::dvec3 texel(const std::vector<Image>& faces, const Probe& probe) {
    const Image& face = faces[probe.face];
    const float* sample =
        face.as<float>().data() + static_cast<std::size_t>(3 * (probe.y * face.width + probe.x));
    return {sample[0], sample[1], sample[2]};
}

/// Root mean square of how far the walk is from the sum, by that of the sum.
double relative_error(const std::vector<Image>& faces, int size, double roughness, int step) {
    const std::vector<Image> blurred = blurred_faces(RadianceTree(faces), size, roughness);
    double apart = 0.0;
    double all = 0.0;
    for (const Probe& probe : probes(size, step)) {
        const glm::dvec3 expected = blurred_radiance(faces, probe.direction, roughness);
        const glm::dvec3 off = texel(blurred, probe) - expected;
        apart += glm::dot(off, off);
        all += glm::dot(expected, expected);
    }
    return std::sqrt(apart / all);
}

/// A dim room with a small sun ten thousand times as bright, and a wide lamp.
glm::dvec3 sunny_room(glm::dvec3 d) {
    const double sun = glm::dot(d, glm::normalize(glm::dvec3(0.3, 0.8, -0.5)));
    const double lamp = glm::dot(d, glm::normalize(glm::dvec3(-0.7, 0.1, 0.6)));
    return glm::dvec3(0.3 + 0.2 * d.y, 0.3, 0.3 - 0.1 * d.x) +
           glm::dvec3(sun > 0.9995 ? 4000.0 : 0.0) + glm::dvec3(lamp > 0.9 ? 20.0 : 0.0);
}

TEST(Blur, EvenLightStaysEven) {
    const glm::dvec3 light(0.5, 2, 8);
    for (const int source : {1, 2, 64}) {
        const std::vector<Image> faces = faces_of(source, [&](glm::dvec3) { return light; });
        const RadianceTree tree(faces);
        for (const double roughness : {0.1, 0.2, 0.6, 1.0}) {
            for (const int size : {1, 3, 8, 20}) {
                const std::vector<Image> blurred = blurred_faces(tree, size, roughness);
                double worst = 0.0;
                for (const Probe& probe : probes(size, 1))
                    worst = std::max(worst, glm::length(texel(blurred, probe) / light - 1.0));
                // Some thousand terms in float.
                EXPECT_LT(worst, 2e-5) << source << ' ' << roughness << ' ' << size;
            }
        }
    }
}

TEST(Blur, OfTheRoughestSurfaceIsTheMeanByTheCosine) {
    // GGX of roughness 1 prefers no half vector: 1 + a.d becomes 1 + 2/3 a.n.
    const glm::dvec3 a(0.4, -0.3, 0.6);
    const std::vector<Image> faces =
        faces_of(64, [&](glm::dvec3 d) { return glm::dvec3(1.0 + glm::dot(a, d)); });
    for (const glm::dvec3& n : spread_directions(20))
        EXPECT_NEAR(blurred_radiance(faces, n, 1.0).x, 1.0 + 2.0 / 3.0 * glm::dot(a, n), 2e-4);
    const std::vector<Image> blurred = blurred_faces(RadianceTree(faces), 8, 1.0);
    for (const Probe& probe : probes(8, 1)) {
        EXPECT_NEAR(texel(blurred, probe).x,
                    1.0 + 2.0 / 3.0 * glm::dot(a, glm::normalize(probe.direction)), 2e-3);
    }
}

TEST(Blur, TheWalkIsCloseToTheSumOverAllTexels) {
    const std::vector<Image> faces = faces_of(128, sunny_room);
    // As levels of a prefiltered cube map have them.
    EXPECT_LT(relative_error(faces, 128, 0.2, 26), 0.02);
    EXPECT_LT(relative_error(faces, 64, 0.4, 13), 0.02);
    EXPECT_LT(relative_error(faces, 32, 0.6, 11), 0.01);
    EXPECT_LT(relative_error(faces, 16, 0.8, 6), 0.01);
    EXPECT_LT(relative_error(faces, 8, 1.0, 3), 0.005);
}

TEST(Blur, OfARealPlaceIsWithinAPercentOfTheSum) {
    RELIEF_NEEDS_SHARED(folder, "data/env/cube/venice_sunset_256");
    std::vector<Image> faces;
    for (const char* name : {"posx", "negx", "posy", "negy", "posz", "negz"})
        faces.push_back(read_image(folder / (std::string(name) + ".hdr"), ImageUse::color));
    EXPECT_LT(relative_error(faces, 128, 0.2, 64), 0.01);
    EXPECT_LT(relative_error(faces, 32, 0.6, 16), 0.01);
    EXPECT_LT(relative_error(faces, 8, 1.0, 4), 0.01);
}

TEST(Blur, ASunGetsDimmerAndWiderWithRoughness) {
    const std::vector<Image> faces = faces_of(128, sunny_room);
    const RadianceTree tree(faces);
    const glm::dvec3 sun = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
    const FacePoint at = face_point(sun);
    double before = 1e9;
    double aside_before = 0.0;
    for (const double roughness : {0.1, 0.2, 0.3}) {
        const std::vector<Image> blurred = blurred_faces(tree, 32, roughness);
        const auto column = [&](double shift) {
            return static_cast<int>((at.s + shift + 1.0) * 16.0);
        };
        const int row = static_cast<int>((at.t + 1.0) * 16.0);
        const double peak = texel(blurred, {at.face, column(0), row, {}}).y;
        const double aside = texel(blurred, {at.face, column(0.6), row, {}}).y;
        EXPECT_LT(peak, before);
        EXPECT_GT(aside, aside_before);
        EXPECT_GT(peak, 2.0 * aside);
        before = peak;
        aside_before = aside;
    }
}

TEST(Blur, ATurnedRoomIsBlurredAlike) {
    // A quarter turn about y maps texels to texels: +x to -z, -z to -x.
    const auto turned = [](glm::dvec3 d) { return glm::dvec3(d.z, d.y, -d.x); };
    const std::vector<Image> before = faces_of(32, sunny_room);
    const std::vector<Image> after =
        faces_of(32, [&](glm::dvec3 d) { return sunny_room(turned(d)); });
    const std::vector<Image> a = blurred_faces(RadianceTree(before), 16, 0.5);
    const std::vector<Image> b = blurred_faces(RadianceTree(after), 16, 0.5);
    for (const Probe& probe : probes(16, 1)) {
        const FacePoint from = face_point(turned(probe.direction));
        const Probe other{from.face,
                          static_cast<int>((from.s + 1.0) * 8.0),
                          static_cast<int>((from.t + 1.0) * 8.0),
                          {}};
        // The same nodes in another order.
        EXPECT_NEAR(texel(b, probe).y / texel(a, other).y, 1.0, 1e-4);
    }
}

TEST(Blur, TheNumberOfThreadsChangesNoBit) {
    const std::vector<Image> faces = faces_of(32, sunny_room);
    const std::vector<Image> all = blurred_faces(RadianceTree(faces), 20, 0.4);
    set_thread_limit(1);
    const std::vector<Image> one = blurred_faces(RadianceTree(faces), 20, 0.4);
    set_thread_limit(0);
    for (std::size_t face = 0; face < 6; ++face)
        EXPECT_EQ(all[face].samples, one[face].samples);
}

TEST(Blur, BlackSurroundingsStayBlack) {
    const std::vector<Image> faces = faces_of(16, [](glm::dvec3) { return glm::dvec3(0); });
    for (const Image& face : blurred_faces(RadianceTree(faces), 8, 0.5)) {
        for (const float sample : face.as<float>())
            EXPECT_EQ(sample, 0.0F);
    }
}

TEST(Blur, FacesOfAnotherKindAreRefused) {
    const auto faces = [](int size, int channels, int bits) {
        return std::vector<Image>(6, make_image(size, size, channels, bits, ColorSpace::linear));
    };
    try {
        const RadianceTree tree(faces(12, 3, 32));
        FAIL() << "was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(),
                     "faces of 12 texels, 3 channels and 32 bits cannot be blurred: it takes a "
                     "power of two, three and 32");
    }
    EXPECT_THROW(RadianceTree(faces(16, 4, 32)), InvalidInput);
    EXPECT_THROW(RadianceTree(faces(16, 3, 8)), InvalidInput);
    EXPECT_THROW(RadianceTree(std::vector<Image>(5, faces(16, 3, 32)[0])), InvalidInput);
}

}  // namespace
}  // namespace relief
