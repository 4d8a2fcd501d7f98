// SPDX-License-Identifier: Apache-2.0
// Lights as text: hand-computed directions and intensities, and every way to get them wrong.
#include "view_options.h"

#include <gtest/gtest.h>

#include "common/options.h"
#include "support/angle.h"

namespace relief::tools {
namespace {

using test::degrees_between;

/// Of sines and cosines in float.
constexpr double light_tolerance = 1e-5;

template <typename Light>
Light parsed(const std::string& text) {
    return std::get<Light>(parse_light("--light " + text, text));
}

std::string light_refusal(const std::string& text) {
    try {
        parse_light("--light " + text, text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(LightOption, ADirectionalLightComesFromWhereItIsNamed) {
    // From the right (+x), so it travels to the left.
    const auto right = parsed<DirectionalLight>("directional:90,0");
    EXPECT_LT(degrees_between(right.direction_world, {-1, 0, 0}), light_tolerance);
    EXPECT_EQ(right.irradiance, glm::vec3(1.0F));
    const auto above = parsed<DirectionalLight>("directional:0,90,2.5");
    EXPECT_LT(degrees_between(above.direction_world, {0, -1, 0}), light_tolerance);
    EXPECT_EQ(above.irradiance, glm::vec3(2.5F));
    const auto front = parsed<DirectionalLight>("directional:0,0,2,#ff0000");
    EXPECT_LT(degrees_between(front.direction_world, {0, 0, -1}), light_tolerance);
    EXPECT_EQ(front.irradiance, glm::vec3(2.0F, 0.0F, 0.0F));
}

TEST(LightOption, APointLightStandsWhereItIsNamed) {
    const auto light = parsed<PointLight>("point:1,-2,3.5,4,#0000ff");
    EXPECT_EQ(light.position_world, glm::vec3(1.0F, -2.0F, 3.5F));
    EXPECT_EQ(light.intensity, glm::vec3(0.0F, 0.0F, 4.0F));
    EXPECT_FALSE(light.range);
}

TEST(LightOption, ASpotLightShinesAtItsTargetWithinItsCone) {
    const auto light = parsed<SpotLight>("spot:0,5,0,0,0,0,40,10");
    EXPECT_LT(degrees_between(light.direction_world, {0, -1, 0}), light_tolerance);
    EXPECT_FLOAT_EQ(light.outer_cone, glm::radians(40.0F));
    EXPECT_FLOAT_EQ(light.inner_cone, glm::radians(30.0F));
    EXPECT_EQ(light.point.intensity, glm::vec3(10.0F));
    EXPECT_FLOAT_EQ(parsed<SpotLight>("spot:0,5,0,0,0,0").outer_cone, glm::radians(30.0F));
}

TEST(LightOption, NoneIsNoLight) {
    EXPECT_TRUE(std::holds_alternative<NoLight>(parse_light("--light none", "none")));
}

TEST(LightOption, RefusesWhatIsNotALight) {
    EXPECT_EQ(light_refusal("sun"), "--light sun: not a light");
    EXPECT_EQ(light_refusal("sun:1,2"), "--light sun:1,2: not a light");
    EXPECT_EQ(light_refusal("point"), "--light point: '': not a number");
    EXPECT_EQ(light_refusal("point:1,2"), "--light point:1,2: too few values");
    EXPECT_EQ(light_refusal("point:1,2,x"), "--light point:1,2,x: 'x': not a number");
    EXPECT_EQ(light_refusal("point:1,2,3,-1"),
              "--light point:1,2,3,-1: '-1': not between 0 and 1000000000");
    EXPECT_EQ(light_refusal("point:1,2,3,1,#fff"),
              "--light point:1,2,3,1,#fff: '#fff': not a color like #ff8000");
    EXPECT_EQ(light_refusal("directional:0,0,1,#ffffff,9"),
              "--light directional:0,0,1,#ffffff,9: too many values");
    EXPECT_EQ(light_refusal("directional:0,91"),
              "--light directional:0,91: '91': not between -90 and 90 degrees");
    EXPECT_EQ(
        light_refusal("spot:1,1,1,1,1,1"),
        "--light spot:1,1,1,1,1,1: the position and the target of the spotlight are the same");
}

}  // namespace
}  // namespace relief::tools
