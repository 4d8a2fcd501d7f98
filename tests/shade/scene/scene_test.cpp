// SPDX-License-Identifier: Apache-2.0
// Boxes and cameras by hand, and every number that validate() refuses.
#include "relief/shade/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "relief/mesh/report.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

Scene cube_scene() {
    Scene scene;
    scene.meshes = {test::cube()};
    scene.meshes[0].edit().material_ranges = {{0, 12, 0}};
    scene.materials = {Material{}};
    scene.materials[0].name = "paint";
    scene.images = {{"image", Image{}}};
    scene.instances = {{0, glm::mat4(1.0F), "node"}};
    return scene;
}

TEST(WorldBounds, ContainEveryTransformedInstance) {
    Scene scene = cube_scene();
    scene.instances.push_back({0, glm::mat4(2.0F), "twice"});
    scene.instances[1].world_from_object[3] = glm::vec4(10, 0, 0, 1);
    const Bounds bounds = world_bounds(scene);
    EXPECT_EQ(bounds.min, glm::vec3(-1, -2, -2));
    EXPECT_EQ(bounds.max, glm::vec3(12, 2, 2));
}

TEST(WorldBounds, IgnoreNonFinitePositions) {
    Scene scene = cube_scene();
    scene.meshes[0].edit().positions[0].x = not_a_number;
    scene.meshes[0].edit().positions[1].y = std::numeric_limits<float>::infinity();
    EXPECT_EQ(world_bounds(scene).max, glm::vec3(1, 1, 1));
    EXPECT_TRUE(world_bounds(Scene{}).empty());
}

/// Returns the position of a point in the picture, from -1 to 1 to the right and up if it is
/// visible, and its depth.
glm::vec3 seen(const Camera& camera, const glm::vec3& world, float aspect) {
    const glm::vec3 view(glm::inverse(camera.world_from_view) * glm::vec4(world, 1.0F));
    const float y = std::tan(camera.vertical_fov * 0.5F);
    return {view.x / (-view.z * y * aspect), view.y / (-view.z * y), -view.z};
}

TEST(Framed, SeesAllOfABoxFromEverySideAndNoMuchMore) {
    const Bounds box{{-1, -2, -30}, {3, 8, -20}};
    for (const float aspect : {0.3F, 1.0F, 3.0F}) {
        for (const float azimuth : {0.0F, 1.0F, 2.5F, -3.0F}) {
            for (const float elevation : {-1.5707964F, -0.5F, 0.0F, 0.4F, 1.5707964F}) {
                const Camera camera = framed(box, azimuth, elevation, 0.7F, aspect);
                EXPECT_NO_THROW(validate(camera));
                float widest = 0.0F;
                for (int i = 0; i < 8; ++i) {
                    const glm::vec3 corner((i & 1) != 0 ? box.min.x : box.max.x,
                                           (i & 2) != 0 ? box.min.y : box.max.y,
                                           (i & 4) != 0 ? box.min.z : box.max.z);
                    const glm::vec3 at = seen(camera, corner, aspect);
                    EXPECT_GT(at.z, camera.near);
                    EXPECT_LT(at.z, camera.far);
                    widest = std::max({widest, std::abs(at.x), std::abs(at.y)});
                }
                EXPECT_LT(widest, 1.0F);
                EXPECT_GT(widest, 0.8F);
            }
        }
    }
}

TEST(Framed, LooksFromTheRequestedDirection) {
    const Bounds box{{-1, -1, -1}, {1, 1, 1}};
    const glm::vec3 front(framed(box, 0, 0, 0.7F, 1).world_from_view[3]);
    EXPECT_GT(front.z, 2.0F);
    EXPECT_NEAR(front.x, 0.0F, 1e-6F);
    const glm::vec3 right(framed(box, 1.5707964F, 0, 0.7F, 1).world_from_view[3]);
    EXPECT_GT(right.x, 2.0F);
    EXPECT_NEAR(right.z, 0.0F, 1e-6F);
    const glm::vec3 above(framed(box, 0, 1.5707964F, 0.7F, 1).world_from_view[3]);
    EXPECT_GT(above.y, 2.0F);
    // The camera is upright: its up vector points upwards, and its right vector along world +x.
    const Camera tilted = framed(box, 0, 0.5F, 0.7F, 1);
    EXPECT_GT(tilted.world_from_view[1].y, 0.5F);
    EXPECT_EQ(tilted.world_from_view[0], glm::vec4(1, 0, 0, 0));
}

TEST(Framed, EmptySceneIsSeenFromDistanceOne) {
    const Camera of_nothing = framed(Bounds{}, 0, 0, 0.7F, 1);
    EXPECT_EQ(of_nothing.world_from_view[3], glm::vec4(0, 0, 1, 1));
    const Camera of_a_point = framed(Bounds{{2, 3, 4}, {2, 3, 4}}, 0, 0, 0.7F, 1);
    EXPECT_EQ(of_a_point.world_from_view[3], glm::vec4(2, 3, 5, 1));
    EXPECT_NO_THROW(validate(of_a_point));
}

TEST(Framed, ScalesWithTheBox) {
    for (const float scale : {1e-6F, 1.0F, 1e6F}) {
        const Camera camera = framed(Bounds{glm::vec3(-scale), glm::vec3(scale)}, 0, 0, 1.0F, 1);
        EXPECT_NO_THROW(validate(camera));
        EXPECT_NEAR(camera.world_from_view[3].z / scale, 1.05F * (1.0F + 1.0F / std::tan(0.5F)),
                    1e-4F);
    }
    EXPECT_NO_THROW(validate(framed(Bounds{{-1, -1, 0}, {1, 1, 0}}, 1.5707964F, 0, 0.7F, 1)));
}

TEST(Framed, RefusesInvalidViews) {
    const Bounds box{{-1, -1, -1}, {1, 1, 1}};
    EXPECT_THROW((void)framed(box, not_a_number, 0, 0.7F, 1), InvalidInput);
    EXPECT_THROW((void)framed(box, 0, 0, 0.0F, 1), InvalidInput);
    EXPECT_THROW((void)framed(box, 0, 0, 3.2F, 1), InvalidInput);
    EXPECT_THROW((void)framed(box, 0, 0, 0.7F, 0), InvalidInput);
}

/// Returns the message of validate(), or "valid".
std::string verdict(const std::function<void(Scene&)>& spoil) {
    Scene scene = cube_scene();
    spoil(scene);
    try {
        validate(scene);
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "valid";
}

TEST(ValidateScene, AcceptsSoundScenes) {
    EXPECT_EQ(verdict([](Scene&) {}), "valid");
    EXPECT_EQ(verdict([](Scene& s) { s = Scene{}; }), "valid");
    EXPECT_EQ(verdict([](Scene& s) { s.meshes[0].edit().positions[0].x = not_a_number; }), "valid");
    EXPECT_EQ(verdict([](Scene& s) { s.instances[0].world_from_object = glm::mat4(0.0F); }),
              "valid");
}

TEST(ValidateScene, ReportsInvalidIndices) {
    EXPECT_EQ(verdict([](Scene& s) { s.instances[0].mesh = 3; }),
              "instance 'node' names mesh 3, but there are only 1");
    EXPECT_EQ(verdict([](Scene& s) { s.meshes[0].edit().material_ranges[0].material = 7; }),
              "instance 'node' names material 7, but there are only 1");
    EXPECT_EQ(verdict([](Scene& s) { s.materials[0].diffuse_texture = Texture{4}; }),
              "material 'paint': diffuse texture names image 4, but there are only 1");
    EXPECT_EQ(verdict([](Scene& s) { s.materials[0].normal_map = NormalMap{Texture{1}}; }),
              "material 'paint': normal map names image 1, but there are only 1");
    EXPECT_EQ(verdict([](Scene& s) { s.meshes[0].edit().triangles[2].y = 99; }),
              "mesh 0: triangle 2 names vertex 99, but there are only 24");
}

TEST(ValidateScene, NamesNumbersOutOfRange) {
    const std::vector<std::function<void(Scene&)>> spoils = {
        [](Scene& s) { s.materials[0].diffuse.y = -0.5F; },
        [](Scene& s) { s.materials[0].specular.x = not_a_number; },
        [](Scene& s) { s.materials[0].emission.z = 2e9F; },
        [](Scene& s) { s.materials[0].shininess = 2e6F; },
        [](Scene& s) { s.materials[0].reflectivity.x = 1.5F; },
        [](Scene& s) { s.materials[0].grazing_reflectivity.x = -1.0F; },
        [](Scene& s) { s.ambient.x = 2e18F; },
        [](Scene& s) {
            s.directional_lights = {{{0, 0, 0}, {1, 1, 1}}};
        },
        [](Scene& s) {
            s.directional_lights = {{{0, 0, 1}, {1, -1, 1}}};
        },
        [](Scene& s) {
            s.point_lights = {{{not_a_number, 0, 0}, {1, 1, 1}}};
        },
        [](Scene& s) {
            s.point_lights = {{{0, 0, 0}, {1, 1, 1}, 0.0F}};
        },
        [](Scene& s) {
            s.spot_lights = {{{}, {0, 0, 0}, 0.1F, 0.2F}};
        },
        [](Scene& s) {
            s.spot_lights = {{{}, {0, 0, 1}, 0.2F, 0.2F}};
        },
        [](Scene& s) {
            s.spot_lights = {{{}, {0, 0, 1}, 0.2F, 1.6F}};
        },
        [](Scene& s) { s.instances[0].world_from_object[1].y = not_a_number; },
        [](Scene& s) { s.background.a = 1.5F; },
        [](Scene& s) { s.instances[0].open_shares = std::vector(23, 1.0F); },
        [](Scene& s) {
            s.instances[0].open_shares = std::vector(24, 0.5F);
            s.instances[0].open_shares.edit()[7] = not_a_number;
        },
        [](Scene& s) { s.instances[0].open_shares = std::vector(24, 1.5F); },
        [](Scene& s) {
            s.environment = Environment{Equirectangular{}, -1.0F, true};
        },
        [](Scene& s) {
            s.camera = Camera{};
            s.camera->far = s.camera->near;
        },
        [](Scene& s) {
            s.camera = Camera{};
            s.camera->vertical_fov = 0.0F;
        },
    };
    for (std::size_t i = 0; i < spoils.size(); ++i)
        EXPECT_NE(verdict(spoils[i]), "valid") << i;
    EXPECT_EQ(verdict(spoils[0]),
              "material 'paint': diffuse is (0.8, -0.5, 0.8), but every channel must be within "
              "[0, 1000000000]");
    EXPECT_EQ(
        verdict(spoils[12]),
        "spot light 0 inner cone is 0.2, but must be at least 0 and below its outer cone 0.2");
    EXPECT_THAT(verdict(spoils[17]),
                testing::HasSubstr("the open share of vertex 7 is nan, but must be within "
                                   "[0, 1]"));
}

}  // namespace
}  // namespace relief
