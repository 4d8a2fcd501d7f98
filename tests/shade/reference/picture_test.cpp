// SPDX-License-Identifier: Apache-2.0
// From radiance to pictures, by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../render/draw_test.h"
#include "relief/mesh/error.h"
#include "relief/shade/reference.h"

namespace relief {
namespace {

/// The picture of one pixel of grey.
glm::dvec4 shown(float light, const Scene& scene, OutputCoding output, float alpha = 1.0F) {
    Image radiance = make_image(1, 1, 4, 32, ColorSpace::linear);
    radiance.samples = std::vector<float>{light, light, light, alpha};
    return test::pixel(reference_picture(radiance, scene, output), 0, 0);
}

/// The light that an sRGB picture shows.
double shown_light(float light, const Scene& scene, float alpha = 1.0F) {
    return static_cast<double>(
        linear_from_srgb(static_cast<float>(shown(light, scene, OutputCoding::srgb, alpha).r)));
}

TEST(ReferencePicture, IsExposedAndThenToneMapped) {
    Scene scene;
    scene.exposure = 0.5F;
    EXPECT_NEAR(shown_light(1.5F, scene), 0.75, 1e-6);
    EXPECT_NEAR(shown_light(3.0F, scene), 1.0, 1e-6);
    scene.tone_mapping = ToneMapping::reinhard;
    EXPECT_NEAR(shown_light(6.0F, scene), 0.75, 1e-6);
    scene.tone_mapping = ToneMapping::aces;
    // x = 1: (2.51 + 0.03) / (2.43 + 0.59 + 0.14)
    EXPECT_NEAR(shown_light(2.0F, scene), 2.54 / 3.16, 1e-6);
    EXPECT_NEAR(shown_light(1e30F, scene), 1.0, 1e-6);
}

TEST(ReferencePicture, OfLinearLightIsNeitherExposedNorToneMapped) {
    Scene scene;
    scene.exposure = 0.5F;
    scene.tone_mapping = ToneMapping::aces;
    EXPECT_EQ(shown(3.0F, scene, OutputCoding::linear).r, 3.0);
    EXPECT_EQ(shown(3.0F, scene, OutputCoding::clamped).r, 1.0);
    EXPECT_EQ(shown(0.5F, scene, OutputCoding::clamped).r, 0.5);
    EXPECT_THROW((void)shown(0.5F, scene, OutputCoding::half), InvalidInput);
}

TEST(ReferencePicture, IsCodedByTheStandardsCurve) {
    const Scene scene;
    EXPECT_NEAR(shown(0.5F, scene, OutputCoding::srgb).r, 0.7353569830, 1e-7);
    EXPECT_NEAR(shown(0.001F, scene, OutputCoding::srgb).r, 0.01292, 1e-9);
    EXPECT_EQ(shown(1.0F, scene, OutputCoding::srgb), glm::dvec4(1.0));
}

TEST(ReferencePicture, LiesOverABackgroundThatIsNeitherExposedNorToneMapped) {
    Scene scene;
    scene.exposure = 2.0F;
    scene.tone_mapping = ToneMapping::reinhard;
    scene.background = {0.25F, 0.25F, 0.25F, 1.0F};
    EXPECT_NEAR(shown_light(0.0F, scene, 0.0F), 0.25, 1e-6);
    // A half-covering surface of 1.5, which shows as 0.75.
    EXPECT_NEAR(shown_light(1.5F, scene, 0.5F), 0.5, 1e-6);
    // Over half a background: (0.75 * 0.5 + 0.25 * 0.25) / 0.75, and alpha 0.75.
    scene.background.a = 0.5F;
    EXPECT_NEAR(shown_light(1.5F, scene, 0.5F), 0.4375 / 0.75, 1e-6);
    EXPECT_NEAR(shown(1.5F, scene, OutputCoding::srgb, 0.5F).a, 0.75, 1e-7);
}

TEST(ReferencePicture, HoldsNothingThatIsNotANumber) {
    Scene scene;
    for (const ToneMapping mapping :
         {ToneMapping::none, ToneMapping::reinhard, ToneMapping::aces}) {
        scene.tone_mapping = mapping;
        EXPECT_EQ(shown(std::numeric_limits<float>::quiet_NaN(), scene, OutputCoding::srgb).r, 0.0);
        EXPECT_EQ(shown(-1.0F, scene, OutputCoding::srgb).r, 0.0);
        EXPECT_NEAR(shown(std::numeric_limits<float>::infinity(), scene, OutputCoding::srgb).r, 1.0,
                    1e-12);
    }
}

}  // namespace
}  // namespace relief
