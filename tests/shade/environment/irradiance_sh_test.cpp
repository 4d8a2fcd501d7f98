// SPDX-License-Identifier: Apache-2.0
// Irradiance by nine numbers: exact where it must be, and by how much it is off elsewhere.
#include "environment/convolution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "relief/mesh/error.h"
#include "relief/mesh/image_file.h"
#include "support/shared_data.h"
#include "test_environments.h"

namespace relief {
namespace {

using test::faces_of;
using test::spread_directions;

using std::numbers::pi;

double grey_at(const IrradianceSh& sh, const glm::dvec3& normal) {
    return irradiance_over_pi(sh, normal).x;
}

/// Light that depends on the cosine to an axis only.
std::vector<Image> lobe(int size, const glm::dvec3& axis, double (*radiance)(double cosine)) {
    return faces_of(size, [&](glm::dvec3 d) { return glm::dvec3(radiance(glm::dot(d, axis))); });
}

TEST(IrradianceSh, OfEvenLightIsThatLightAndNothingElse) {
    for (const int size : {1, 2, 3, 32, 100}) {
        const IrradianceSh sh =
            irradiance_sh(faces_of(size, [](glm::dvec3) { return glm::dvec3(0.5, 2, 8); }));
        EXPECT_LT(glm::length(sh[0] - glm::vec3(0.5F, 2, 8)), 1e-6F) << size;
        for (std::size_t i = 1; i < 9; ++i)
            EXPECT_LT(glm::length(sh.at(i)), 1e-6F) << size << ' ' << i;
    }
}

TEST(IrradianceSh, IsExactForLightUpToOrderTwo) {
    // Radiance 2 + a.d + (b.d)^2 sheds, over pi, 2 + 2/3 a.n + ((b.n)^2 + |b|^2) / 4: a third of
    // |b|^2 is of order 0 and stays, the rest is of order 2 and is quartered.
    const glm::dvec3 a(0.3, -0.5, 0.2);
    const glm::dvec3 b(0.8, 0.4, -0.6);
    const IrradianceSh sh = irradiance_sh(faces_of(64, [&](glm::dvec3 d) {
        return glm::dvec3(2.0 + glm::dot(a, d) + std::pow(glm::dot(b, d), 2.0));
    }));
    for (const glm::dvec3& n : spread_directions(100)) {
        const double expected = 2.0 + 2.0 / 3.0 * glm::dot(a, n) +
                                0.25 * (std::pow(glm::dot(b, n), 2.0) + glm::dot(b, b));
        // Radiance is taken as even within each of 64 x 64 texels.
        EXPECT_NEAR(grey_at(sh, n), expected, 2e-4);
    }
}

TEST(IrradianceSh, OfAHemisphereIsExactToo) {
    // (1 + cos) / 2: nothing of order 2 in it.
    const IrradianceSh sh =
        irradiance_sh(lobe(64, {0, 1, 0}, [](double cosine) { return cosine > 0 ? 1.0 : 0.0; }));
    for (const glm::dvec3& n : spread_directions(100))
        EXPECT_NEAR(grey_at(sh, n), 0.5 * (1.0 + n.y), 1e-4);
}

TEST(IrradianceSh, OfACosineLobeIsOffByWhatOrderTwoLeavesOut) {
    for (const glm::dvec3& axis : spread_directions(7)) {
        const IrradianceSh sh =
            irradiance_sh(lobe(64, axis, [](double cosine) { return std::max(cosine, 0.0); }));
        // The lobe's own coefficients are the cosine's: the sum of A_l^2 (2 l + 1) / (4 pi^2) is
        // 127 / 192 = 0.6615 where the integral is 2/3.
        EXPECT_NEAR(grey_at(sh, axis), 127.0 / 192.0, 2e-4);
        EXPECT_NEAR(grey_at(sh, -axis), 1.0 / 4 - 1.0 / 3 + 5.0 / 64, 2e-4) << "instead of 0";
    }
}

TEST(IrradianceSh, OfOneSmallLightIsNoWorseThanKnown) {
    // One texel of 64 x 64, as bright as to shed 1 head on: order 2 gives 1/4 + 1/2 + 5/16.
    std::vector<Image> faces = faces_of(64, [](glm::dvec3) { return glm::dvec3(0); });
    const double cover = solid_angle({0, 0}, {2.0 / 64, 2.0 / 64});
    for (std::size_t c = 0; c < 3; ++c)
        faces[0].as<float>()[3 * (64 * 32 + 32) + c] = static_cast<float>(pi / cover);
    const IrradianceSh sh = irradiance_sh(faces);
    const glm::dvec3 towards = glm::normalize(face_direction(0, 1.0 / 64, 1.0 / 64));
    EXPECT_NEAR(grey_at(sh, towards), 17.0 / 16.0, 1e-4);
    double lowest = 0.0;
    double worst = 0.0;
    for (const glm::dvec3& n : spread_directions(5000)) {
        lowest = std::min(lowest, grey_at(sh, n));
        worst = std::max(worst, std::abs(grey_at(sh, n) - std::max(glm::dot(n, towards), 0.0)));
    }
    // In the cosine x: 3/32 + x/2 + 15/32 x^2, lowest at -8/15, and farthest from max(x, 0) at 0.
    EXPECT_NEAR(lowest, 3.0 / 32 - 2.0 / 15, 1e-4);
    EXPECT_NEAR(worst, 3.0 / 32, 1e-3);
}

TEST(IrradianceSh, OfARealPlaceIsWithinTwoPercentOfTheIntegral) {
    RELIEF_NEEDS_SHARED(folder, "data/env/cube/venice_sunset_256");
    std::vector<Image> faces;
    for (const char* name : {"posx", "negx", "posy", "negy", "posz", "negz"})
        faces.push_back(read_image(folder / (std::string(name) + ".hdr"), ImageUse::color));
    const IrradianceSh sh = irradiance_sh(faces);
    double worst = 0.0;
    double sum = 0.0;
    double brightest = 0.0;
    const std::vector<glm::dvec3> normals = spread_directions(60);
    for (const glm::dvec3& n : normals) {
        glm::dvec3 integral(0.0);
        test::for_each_texel(faces,
                             [&](const glm::dvec3& d, double cover, const glm::dvec3& light) {
                                 integral += light * (cover * std::max(glm::dot(d, n), 0.0) / pi);
                             });
        const double off = glm::length(irradiance_over_pi(sh, n) - integral);
        worst = std::max(worst, off);
        sum += off;
        brightest = std::max(brightest, glm::length(integral));
    }
    RecordProperty("worst_of_brightest", std::to_string(worst / brightest));
    RecordProperty("mean_of_brightest", std::to_string(sum / 60.0 / brightest));
    EXPECT_LT(worst / brightest, 0.02);
    EXPECT_LT(sum / 60.0 / brightest, 0.01);
}

TEST(IrradianceSh, ATexelThatIsNotFiniteIsRefusedByPlace) {
    std::vector<Image> faces = faces_of(4, [](glm::dvec3) { return glm::dvec3(1); });
    faces[3].as<float>()[3 * 7 + 1] = std::numeric_limits<float>::infinity();
    try {
        (void)irradiance_sh(faces);
        FAIL() << "was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(), "irradiance: face -y holds inf in texel 7, which is not finite");
    }
    faces.pop_back();
    EXPECT_THROW(irradiance_sh(faces), InvalidInput);
    const std::vector<Image> codes(6, make_image(4, 4, 3, 8, ColorSpace::srgb));
    EXPECT_THROW(irradiance_sh(codes), InvalidInput);
}

}  // namespace
}  // namespace relief
