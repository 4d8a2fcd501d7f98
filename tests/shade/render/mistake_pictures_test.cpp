// SPDX-License-Identifier: Apache-2.0
// The costs of mistakes are angles in closed form, and a mistake without surfaces changes no pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "relief/shade/mistakes.h"
#include "shade/render/draw_support.h"
#include "shade/render/random_scene.h"
#include "support/sanitized.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

using test::pixel;

/// Degrees; shaders compute with floats, whose angles have an error of 1e-7 at best.
constexpr double float_degrees = 1e-3;
constexpr double degree = std::numbers::pi / 180.0;
constexpr int picture_side = 32;

FrameSettings small(int samples = 1, OutputCoding output = OutputCoding::srgb) {
    return {.width = picture_side, .height = picture_side, .samples = samples, .output = output};
}

class MistakePictures : public test::DrawTest {
  protected:
    [[nodiscard]] MistakeCost cost(const char* name, const Scene& scene,
                                   const FrameSettings& settings = small()) const {
        RenderCache cache(context());
        return mistake_cost(*find_mistake(name), scene, scene.camera.value_or(test::front_camera()),
                            settings, context(), cache);
    }

    void expect_angle(const char* name, const Scene& scene, double degrees) const {
        SCOPED_TRACE(name);
        const MistakeCost found = cost(name, scene);
        ASSERT_TRUE(found.angles);
        EXPECT_GT(found.angles->count, 0U);
        EXPECT_EQ(found.angles->undefined, 0U);
        EXPECT_NEAR(found.angles->mean, degrees, float_degrees);
        EXPECT_NEAR(found.angles->max, degrees, float_degrees);
    }
};

/// The square, lit and shiny.
Scene shiny_square() {
    Material material;
    material.specular = glm::vec3(0.6F);
    material.shininess = 20.0F;
    Scene scene = test::square_scene(material);
    scene.directional_lights = {{{-0.4F, -0.5F, -1}, glm::vec3(0.7F)}};
    return scene;
}

/// Turns the square about the x axis in object space: its normal leans upwards.
Scene leaning_square(double angle) {
    Scene scene = shiny_square();
    Mesh& mesh = scene.meshes[0].edit();
    const auto cosine = static_cast<float>(std::cos(angle));
    const auto sine = static_cast<float>(std::sin(angle));
    for (glm::vec3& p : mesh.positions)
        p = {p.x, p.y * cosine, -p.y * sine};
    mesh.normals.assign(mesh.positions.size(), {0, sine, cosine});
    return scene;
}

TEST_F(MistakePictures, ComparesWithTheRightPictureThatIsKnown) {
    const Scene scene = shiny_square();
    const MistakeCost drawn = cost("gamma-twice", scene);
    Image black = drawn.right;
    for (std::uint8_t& sample : black.as<std::uint8_t>())
        sample = 0;
    RenderCache cache(context());
    const MistakeCost found =
        mistake_cost(*find_mistake("gamma-twice"), scene, test::front_camera(), small(), context(),
                     cache, IgnoredReport(), &black);
    EXPECT_EQ(found.right.samples, black.samples);
    EXPECT_EQ(found.wrong.samples, drawn.wrong.samples);
    EXPECT_EQ(found.difference.differing_pixels, compare(black, drawn.wrong).differing_pixels);
    EXPECT_NE(found.flip.mean, drawn.flip.mean);
}

TEST_F(MistakePictures, NormalMatrixOfALeaningPlane) {
    // The normal (0, 1, 1) is (0, 1/2, 1) by the inverse transpose of the scale (1, 2, 1), but
    // (0, 2, 1) by the scale itself.
    Scene scene = leaning_square(45.0 * degree);
    scene.instances[0].world_from_object[1][1] = 2.0F;
    const double degrees = (std::atan2(2.0, 1.0) - std::atan2(0.5, 1.0)) / degree;
    EXPECT_NEAR(degrees, 36.8699, 1e-4);
    expect_angle("normal-matrix", scene, degrees);
    EXPECT_GT(cost("normal-matrix", scene).flip.mean, 0.05);
    // The same where the lights are computed at the vertices.
    scene.materials[0].interpolation = Interpolation::gouraud;
    expect_angle("normal-matrix", scene, degrees);
    EXPECT_GT(cost("normal-matrix", scene).flip.mean, 0.05);
    // Without scale, nothing changes.
    scene.instances[0].world_from_object = glm::mat4(1.0F);
    expect_angle("normal-matrix", scene, 0.0);
    EXPECT_EQ(cost("normal-matrix", scene).difference.differing_pixels, 0U);
}

/// A normal map of one texel with 8 bits, whose code of zero is 128.
Scene mapped_square(int x, int y, int z, NormalSpace space = NormalSpace::tangent) {
    Scene scene = shiny_square();
    Image map = make_image(1, 1, 3, 8, ColorSpace::data);
    const auto code = [](int value) { return static_cast<std::uint8_t>(128 + value); };
    map.samples = std::vector<std::uint8_t>{code(x), code(y), code(z)};
    scene.images = {{"map", map}};
    scene.materials[0].normal_map = NormalMap{Texture{0}, 1.0F, Green::up, FlatCode::middle, space};
    return scene;
}

TEST_F(MistakePictures, GreenOfAKnownSlope) {
    const double slope = std::atan2(60.0, 112.0) / degree;
    Scene scene = mapped_square(0, 60, 112);
    expect_angle("green", scene, 2.0 * slope);
    scene.materials[0].tangent_frame = TangentFrame::derivatives;
    expect_angle("green", scene, 2.0 * slope);
    expect_angle("green", mapped_square(60, 0, 112), 0.0);
    // The angle between (x, y, z) and (x, -y, z).
    const double both = 2.0 * std::atan2(60.0, std::hypot(40.0, 90.0)) / degree;
    expect_angle("green", mapped_square(40, 60, 90), both);
}

TEST_F(MistakePictures, HandednessOfAMirroredTexture) {
    Scene scene = mapped_square(0, 60, 112);
    expect_angle("handedness", scene, 0.0);
    for (glm::vec2& uv : scene.meshes[0].edit().texcoords)
        uv.x = 1.0F - uv.x;
    const double slope = std::atan2(60.0, 112.0) / degree;
    expect_angle("handedness", scene, 2.0 * slope);
    EXPECT_GT(cost("handedness", scene).difference.differing_pixels, 0U);
    scene.instances[0].world_from_object[0][0] = -1.0F;  // Mirrored twice.
    expect_angle("handedness", scene, 0.0);
}

/// The sRGB code of 0 to 1 as light.
double decoded(double code) {
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

TEST_F(MistakePictures, NormalMapDecodedAsColors) {
    const auto component = [](int code) { return (255.0 * decoded(code / 255.0) - 128.0) / 127.0; };
    const glm::dvec3 wrong(component(128), component(128), component(255));
    const double degrees = std::atan2(std::hypot(wrong.x, wrong.y), wrong.z) / degree;
    EXPECT_NEAR(degrees, 39.1, 0.1);
    expect_angle("normal-map-srgb", mapped_square(0, 0, 127), degrees);
    expect_angle("normal-map-srgb", mapped_square(0, 0, 127, NormalSpace::object), degrees);
}

TEST_F(MistakePictures, ObjectNormalOfARotation) {
    Scene scene = shiny_square();
    const float angle = 0.4F;
    glm::mat4& matrix = scene.instances[0].world_from_object;
    matrix[0] = {std::cos(angle), 0, -std::sin(angle), 0};
    matrix[2] = {std::sin(angle), 0, std::cos(angle), 0};
    expect_angle("object-normal", scene, 0.4 / degree);
    // The map in object space is rotated by its matrix, too.
    Scene mapped = mapped_square(0, 0, 127, NormalSpace::object);
    mapped.instances[0].world_from_object = matrix;
    expect_angle("object-normal", mapped, 0.4 / degree);
}

TEST_F(MistakePictures, BackFacesAreOpposite) {
    Scene scene = shiny_square();
    scene.materials[0].double_sided = true;
    expect_angle("back-faces", scene, 0.0);
    EXPECT_EQ(cost("back-faces", scene).difference.differing_pixels, 0U);
    scene.instances[0].world_from_object[0][0] = -1.0F;  // Turned about the y axis.
    scene.instances[0].world_from_object[2][2] = -1.0F;
    expect_angle("back-faces", scene, 180.0);
    for (const Interpolation each : {Interpolation::per_pixel, Interpolation::gouraud}) {
        scene.materials[0].interpolation = each;
        EXPECT_GT(cost("back-faces", scene).difference.differing_pixels, 0U);
    }
    scene.materials[0].interpolation = Interpolation::flat;
    EXPECT_EQ(cost("back-faces", scene).difference.differing_pixels, 0U);
}

/// The statistics of an angle over the pixels of front_camera() that see a square of 4 x 4 in the
/// plane of this z; in degrees.
ErrorStats expected_angles(double z, const std::function<double(double x, double y)>& angle) {
    std::vector<float> degrees;
    const double scale = (3.0 - z) / 3.0 * 2.0;
    for (int row = 0; row < picture_side; ++row) {
        for (int column = 0; column < picture_side; ++column) {
            const double x = scale * ((column + 0.5) / picture_side * 2.0 - 1.0);
            const double y = scale * (1.0 - (row + 0.5) / picture_side * 2.0);
            if (std::abs(x) < 2.0 && std::abs(y) < 2.0)
                degrees.push_back(static_cast<float>(angle(x, y) / degree));
        }
    }
    return error_stats(std::move(degrees));
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

void expect_same(const ErrorStats& found, const ErrorStats& expected) {
    EXPECT_EQ(found.count, expected.count);
    EXPECT_EQ(found.undefined, 0U);
    EXPECT_NEAR(found.mean, expected.mean, float_degrees);
    EXPECT_NEAR(found.p99, expected.p99, float_degrees);
    EXPECT_NEAR(found.max, expected.max, float_degrees);
}

TEST_F(MistakePictures, EyeAtTheOrigin) {
    Scene scene = shiny_square();
    scene.background = {0.5F, 0.2F, 0.1F, 1.0F};  // It counts as no direction.
    scene.instances[0].world_from_object[3] = {0, 0, -1, 1};
    const ErrorStats expected = expected_angles(-1.0, [](double x, double y) {
        return angle_between({-x, -y, 4}, {-x, -y, 1});
    });
    EXPECT_NEAR(expected.max, 36.87, 0.05);  // atan(r) - atan(r / 4) is largest at r = 2.
    expect_same(*cost("eye-at-origin", scene).angles, expected);
    EXPECT_GT(cost("eye-at-origin", scene).difference.differing_pixels, 0U);
}

TEST_F(MistakePictures, PositionInObjectSpace) {
    Scene scene = shiny_square();
    scene.instances[0].world_from_object[3] = {0, 0, -1, 1};
    // Without a point light, the direction to the eye counts.
    expect_same(*cost("object-position", scene).angles,
                expected_angles(-1.0, [](double x, double y) {
                    return angle_between({-x, -y, 4}, {-x, -y, 3});
                }));
    PointLight light;
    light.position_world = {0.25F, 0, 1};
    scene.point_lights = {light};
    expect_same(*cost("object-position", scene).angles,
                expected_angles(-1.0, [](double x, double y) {
                    return angle_between({0.25 - x, -y, 2}, {0.25 - x, -y, 1});
                }));
    EXPECT_EQ(measured_name(*find_mistake("object-position"), scene), "direction to the light");
    EXPECT_GT(cost("object-position", scene).difference.differing_pixels, 0U);
}

TEST_F(MistakePictures, UnitNormalBendsMirrorDirections) {
    Scene scene = shiny_square();
    const double lean = 50.0 * degree;
    Mesh& mesh = scene.meshes[0].edit();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const double turn = mesh.positions[i].x > 0 ? lean : -lean;
        mesh.normals[i] = glm::vec3(glm::dvec3(std::sin(turn), 0, std::cos(turn)));
    }
    expect_same(*cost("unit-normal", scene).angles, expected_angles(0.0, [&](double x, double y) {
        const glm::dvec3 n(std::sin(lean) * x / 2.0, 0, std::cos(lean));
        const glm::dvec3 v = glm::normalize(glm::dvec3(-x, -y, 3));
        const auto mirrored = [&](const glm::dvec3& m) { return 2.0 * glm::dot(m, v) * m - v; };
        return angle_between(mirrored(glm::normalize(n)), mirrored(n));
    }));
    EXPECT_GT(cost("unit-normal", scene).difference.differing_pixels, 0U);
    scene.materials[0].interpolation = Interpolation::gouraud;
    EXPECT_EQ(cost("unit-normal", scene).difference.differing_pixels, 0U);
}

TEST_F(MistakePictures, ReflectionOfTheWrongVectorIsOpposite) {
    Scene scene = shiny_square();
    scene.environment = test::constant_environment({0.5F, 0.5F, 0.5F}, false);
    scene.materials[0].reflectivity = glm::vec3(0.5F);
    scene.materials[0].specular_model = SpecularModel::phong;
    expect_angle("reflection-sign", scene, 180.0);
    EXPECT_GT(cost("reflection-sign", scene).difference.differing_pixels, 0U);
}

TEST_F(MistakePictures, HalfVectorBendsNoDirection) {
    const MistakeCost found = cost("half-vector", shiny_square());
    EXPECT_FALSE(found.angles);
    EXPECT_GT(found.difference.differing_pixels, 0U);
}

TEST_F(MistakePictures, ColorsHaveKnownCodes) {
    Material material = test::black_material();
    material.diffuse = glm::vec3(1.0F);
    material.diffuse_texture = Texture{0};
    Scene scene = test::square_scene(material);
    scene.images = {
        {"gray", test::constant_image(glm::vec4(128.0F / 255.0F), 3, 8, ColorSpace::srgb)}};
    scene.directional_lights = {{{0, 0, -1}, glm::vec3(1.0F)}};
    // The code of the light 128 / 255 is 188.
    for (const int samples : {1, 4}) {
        for (const char* name : {"srgb", "gamma-twice"}) {
            SCOPED_TRACE(name);
            const MistakeCost found = cost(name, scene, small(samples));
            EXPECT_EQ(pixel(found.right, 9, 9).r, 128.0);
            EXPECT_EQ(pixel(found.wrong, 9, 9).r, 188.0);
            EXPECT_EQ(
                found.difference.differing_pixels,
                static_cast<std::size_t>(picture_side) * static_cast<std::size_t>(picture_side));
            EXPECT_FALSE(found.angles);
        }
    }
}

TEST_F(MistakePictures, ChangeOnlySurfacesThatTheyReach) {
    // Two squares with a gap between them: only the right one is scaled.
    Scene scene = leaning_square(45.0 * degree);
    scene.instances.push_back(scene.instances[0]);
    for (std::size_t i = 0; i < 2; ++i) {
        glm::mat4& matrix = scene.instances[i].world_from_object;
        matrix[0][0] = 0.4F;
        matrix[1][1] = matrix[2][2] = 0.4F;
        matrix[3] = {i == 0 ? -1.0F : 1.0F, 0, 0, 1};
    }
    scene.instances[1].world_from_object[1][1] = 0.8F;
    const MistakeCost found = cost("normal-matrix", scene);
    for (int y = 0; y < picture_side; ++y) {
        for (int x = 0; x < picture_side / 2; ++x)
            ASSERT_EQ(pixel(found.right, x, y), pixel(found.wrong, x, y)) << x << ", " << y;
    }
    EXPECT_GT(found.difference.differing_pixels, 10U);
    EXPECT_NEAR(found.angles->max, 36.8699, float_degrees * 10);
    EXPECT_GT(found.angles->mean, 15.0);  // The left square has 0 degrees, the right one is larger.
    EXPECT_LT(found.angles->mean, 32.0);
}

TEST_F(MistakePictures, AreEqualWhereTheReasonSaysSo) {
    std::size_t hidden = 0;
    std::size_t shown = 0;
    const std::uint64_t scenes = test::is_sanitized ? 1 : 4;
    for (std::uint64_t seed = 1; seed <= scenes; ++seed) {
        const Scene scene = test::random_scene(seed);
        const Camera camera = scene.camera.value_or(test::front_camera());
        RenderCache cache(context());
        for (const Mistake& each : mistakes()) {
            SCOPED_TRACE(std::string(each.name) + " in scene " + std::to_string(seed));
            const FrameSettings settings = small(seed % 2 == 0 ? 4 : 1);
            const MistakeReach reach = reach_of(each, scene, settings);
            const MistakeCost found = mistake_cost(each, scene, camera, settings, context(), cache);
            if (reach.hidden.empty()) {
                ++shown;
                EXPECT_GT(reach.draws, 0U);
            } else {
                ++hidden;
                EXPECT_EQ(reach.draws, 0U);
                EXPECT_EQ(found.difference.differing_pixels, 0U) << reach.hidden;
            }
        }
    }
    EXPECT_GE(hidden, 3 * scenes);
    EXPECT_GE(shown, 3 * scenes);
}

}  // namespace
}  // namespace relief
