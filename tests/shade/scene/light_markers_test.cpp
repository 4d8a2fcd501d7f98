// SPDX-License-Identifier: Apache-2.0
// Spheres where lights are: colour, size, and that they follow.
#include <gtest/gtest.h>

#include "relief/mesh/error.h"
#include "relief/shade/scene_graph.h"

namespace relief {
namespace {

glm::vec3 diffuse_of(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    return scene.materials[mesh.material_ranges.at(0).material.value()].diffuse;
}

TEST(LightMarkers, AreSpheresOfTheLightsColour) {
    SceneGraph graph;
    Scene& scene = graph.scene;
    scene.point_lights = {{{1, 2, 3}, {8, 4, 0}}, {{5, 0, 0}, {2, 1, 0}}, {{9, 0, 0}, {0, 0, 0}}};
    scene.spot_lights.resize(1);
    scene.spot_lights[0].point.intensity = {0, 0, 0.5F};
    scene.directional_lights.resize(1);
    add_light_markers(graph, 0.25F);
    ASSERT_EQ(scene.instances.size(), 3U);  // None for the black one, none for the sun.
    EXPECT_EQ(diffuse_of(scene, scene.instances[0]), glm::vec3(1, 0.5F, 0));
    EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh);  // The same colour.
    EXPECT_EQ(diffuse_of(scene, scene.instances[2]), glm::vec3(0, 0, 1));
    EXPECT_TRUE(scene.materials[0].unlit);
    EXPECT_EQ(scene.instances[0].world_from_object[3], glm::vec4(1, 2, 3, 1));
    EXPECT_EQ(scene.instances[0].world_from_object[0].x, 0.25F);
    EXPECT_NO_THROW(validate(graph));
}

TEST(LightMarkers, FollowTheirLightsAtTheirOwnSize) {
    SceneGraph graph;
    graph.scene.instances.resize(1);
    graph.scene.meshes.resize(1);
    graph.scene.point_lights.resize(2);
    graph.nodes.resize(1);
    graph.nodes[0].scale = {4, 4, 4};
    graph.point_lights = {{0, looking_along({0.5F, 0, 0}, {0, -1, 0})}};
    graph.animations = {Orbit{.node = 0, .radius = 10.0F}};
    add_light_markers(graph, 0.5F);
    for (const double seconds : {0.0, 1.0, 2.0}) {
        pose(graph, seconds);
        const Scene& scene = graph.scene;
        const glm::mat4& marker = scene.instances[1].world_from_object;
        EXPECT_EQ(glm::vec3(marker[3]), scene.point_lights[0].position_world);
        EXPECT_EQ(glm::mat3(marker), glm::mat3(0.5F));
        EXPECT_EQ(glm::vec3(scene.instances[2].world_from_object[3]),
                  scene.point_lights[1].position_world);
    }
    EXPECT_NO_THROW(validate(graph));
}

TEST(LightMarkers, NeedARadius) {
    SceneGraph graph;
    EXPECT_THROW(add_light_markers(graph, 0.0F), InvalidInput);
    EXPECT_THROW(add_light_markers(graph, -1.0F), InvalidInput);
}

}  // namespace
}  // namespace relief
