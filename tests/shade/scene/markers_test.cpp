// SPDX-License-Identifier: Apache-2.0
// The framed camera with its default lights, and the markers of lights and mesh problems.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <set>

#include "relief/mesh/report.h"
#include "relief/shade/frame_settings.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_graph.h"
#include "support/invariants.h"
#include "support/shapes.h"

namespace relief {
using namespace relief::shade;

namespace {

/// Returns the depth of the farthest corner of the cube from -1 to 1.
float farthest_corner(const Camera& camera) {
    const glm::mat4 view_from_world = glm::inverse(camera.world_from_view);
    float farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec4 world((corner & 1) * 2 - 1, (corner & 2) - 1, (corner & 4) / 2 - 1, 1);
        farthest = std::max(farthest, -(view_from_world * world).z);
    }
    return farthest;
}

TEST(Framing, TheDepthRangeMovesAlongWithTheCamera) {
    const Bounds box{glm::vec3(-1.0F), glm::vec3(1.0F)};
    const Camera camera = framed(box, 0.4F, 0.2F, 0.6F, 1.0F);
    const glm::vec3 eye(camera.world_from_view[3]);
    for (const float factor : {0.01F, 0.5F, 1.0F, 20.0F}) {
        const Camera moved = at_distance(camera, glm::vec3(0.0F), factor);
        const glm::vec3 moved_eye(moved.world_from_view[3]);
        EXPECT_LT(test::degrees_between(eye, moved_eye), 1e-4);
        EXPECT_NEAR(glm::length(moved_eye), factor * glm::length(eye), 1e-4);
        EXPECT_GT(moved.near, 0.0F);
        EXPECT_GT(moved.far, moved.near);
        EXPECT_GE(moved.far * 1.0001F, farthest_corner(moved));
    }
    EXPECT_NO_THROW(validate(at_distance(camera, glm::vec3(0.0F), 0.01F)));
    Camera parallel = camera;
    parallel.orthographic_height = 3.0F;
    const Camera enlarged = at_distance(parallel, glm::vec3(0.0F), 0.5F);
    EXPECT_EQ(enlarged.orthographic_height, 1.5F);
    EXPECT_EQ(enlarged.world_from_view, parallel.world_from_view);
}

/// Returns the largest |x| or |y| of all finite vertices in normalized device coordinates. The edge
/// of the picture is at 1.
float extent_in_picture(const Scene& scene, const Camera& camera, float aspect) {
    const glm::mat4 view_from_world = glm::inverse(camera.world_from_view);
    const float tan_y = std::tan(0.5F * camera.vertical_fov);
    float extent = 0;
    for (const glm::vec3& position : scene.meshes[0]->positions) {
        if (!std::isfinite(position.x)) continue;
        const glm::vec4 view =
            view_from_world * scene.instances[0].world_from_object * glm::vec4(position, 1.0F);
        extent = std::max({extent, std::abs(view.x / view.z) / (tan_y * aspect),
                           std::abs(view.y / view.z) / tan_y});
    }
    return extent;
}

TEST(Framing, EveryVertexIsSeenAndTheModelFillsThePicture) {
    Scene scene;
    scene.meshes.push_back(test::sphere(64, 32));
    // A non-finite vertex must not move the camera away.
    scene.meshes[0].edit().positions.push_back(glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    scene.instances.emplace_back();
    scene.instances[0].world_from_object[3] = glm::vec4(10, 20, -30, 1);
    const glm::vec3 center(10, 20, -30);
    for (const float aspect : {0.5F, 1.0F, 2.0F}) {
        const float boxed = glm::distance(
            glm::vec3(framed(world_bounds(scene), 0.7F, 0.4F, 0.6F, aspect).world_from_view[3]),
            center);
        const Camera camera = framed(scene, 0.7F, 0.4F, 0.6F, aspect);
        EXPECT_NO_THROW(validate(camera));
        const float distance = glm::distance(glm::vec3(camera.world_from_view[3]), center);
        EXPECT_LT(distance, 0.9F * boxed) << "a sphere is smaller than its box's corners";
        const float extent = extent_in_picture(scene, camera, aspect);
        EXPECT_LT(extent, 1.0F);
        EXPECT_GT(extent, 0.94F);
        const Camera twice = framed(scene, 0.7F, 0.4F, 0.6F, aspect, 2.0F);
        EXPECT_NEAR(glm::distance(glm::vec3(twice.world_from_view[3]), center), 2.0F * distance,
                    1e-4F);
    }
}

TEST(Framing, EmptySceneIsSeenFromDistanceOne) {
    EXPECT_EQ(framed(Scene{}, 0, 0, 0.7F, 1).world_from_view[3], glm::vec4(0, 0, 1, 1));
    Scene point;
    point.meshes.resize(1);
    point.meshes[0].edit().positions = {{2, 3, 4}};
    point.instances.emplace_back();
    EXPECT_EQ(framed(point, 0, 0, 0.7F, 1, 3.0F).world_from_view[3], glm::vec4(2, 3, 7, 1));
}

TEST(Framing, RefusesADistanceThatIsNone) {
    for (const float factor : {0.0F, -1.0F, std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::quiet_NaN()}) {
        EXPECT_THROW((void)framed(Scene{}, 0, 0, 0.7F, 1, factor), InvalidInput) << factor;
    }
}

TEST(DefaultView, TheKeyLightComesFromTheViewersUpperLeft) {
    Scene scene;
    add_default_lights(scene, Camera{});
    ASSERT_EQ(scene.directional_lights.size(), 2U);
    const glm::vec3 key = scene.directional_lights[0].direction_world;
    EXPECT_GT(key.x, 0.0F);
    EXPECT_LT(key.y, 0.0F);
    EXPECT_LT(key.z, 0.0F);
    // The light is oblique: on a surface that faces the viewer, its angle of incidence is more than
    // 60 degrees.
    EXPECT_GT(test::degrees_between(-key, glm::vec3(0, 0, 1)), 60.0);
    EXPECT_GT(scene.directional_lights[0].irradiance.r,
              4.0F * scene.directional_lights[1].irradiance.r);
    EXPECT_FLOAT_EQ(scene.ambient.g, 0.08F);
}

TEST(DefaultView, RotatingTheCameraRotatesTheLights) {
    Scene still;
    add_default_lights(still, Camera{});
    Camera turned;
    turned.world_from_view =
        glm::rotate(glm::translate(glm::mat4(1.0F), {5, 6, 7}), 1.25F, glm::vec3(0.6F, 0.0F, 0.8F));
    Scene scene;
    add_default_lights(scene, turned);
    for (std::size_t i = 0; i < 2; ++i) {
        const glm::vec3 expected =
            glm::mat3(turned.world_from_view) * still.directional_lights[i].direction_world;
        EXPECT_LT(glm::length(scene.directional_lights[i].direction_world - expected), 1e-6F);
    }
}

glm::vec3 diffuse_of(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    return scene.materials[mesh.material_ranges.at(0).material.value()].diffuse;
}

TEST(LightMarkers, AreSpheresOfTheLightsColor) {
    SceneGraph graph;
    Scene& scene = graph.scene;
    scene.point_lights = {{{1, 2, 3}, {8, 4, 0}}, {{5, 0, 0}, {2, 1, 0}}, {{9, 0, 0}, {0, 0, 0}}};
    scene.spot_lights.resize(1);
    scene.spot_lights[0].point.intensity = {0, 0, 0.5F};
    scene.directional_lights.resize(1);
    add_light_markers(graph, 0.25F);
    ASSERT_EQ(scene.instances.size(), 3U);  // The black light and the sun have no marker.
    EXPECT_EQ(diffuse_of(scene, scene.instances[0]), glm::vec3(1, 0.5F, 0));
    EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh);  // Both have the same color.
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

/// A square, a triangle that is degenerate to its center, and an isolated vertex.
Mesh troubled() {
    Mesh mesh = test::grid(1);
    mesh.normals.clear();
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec3& place :
         {glm::vec3(3, 0, 0), glm::vec3(3, 0, 0), glm::vec3(6, 3, 0), glm::vec3(9, 9, 9)}) {
        mesh.positions.push_back(place);
        mesh.texcoords.emplace_back(0.0F);
    }
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    return mesh;
}

Scene scene_of(const Mesh& mesh, std::size_t instances) {
    Scene scene;
    scene.meshes = {mesh};
    for (std::size_t i = 0; i < instances; ++i)
        scene.instances.push_back({0, glm::mat4(1.0F), ""});
    return scene;
}

const MarkedCondition* marked(const HealthMarkers& markers, MeshCondition condition) {
    for (const MarkedCondition& one : markers.conditions)
        if (one.condition == condition) return &one;
    return nullptr;
}

TEST(HealthMarkers, AreAtTheProblems) {
    const Scene scene = scene_of(troubled(), 2);
    const HealthMarkers markers = health_markers(scene);
    const MarkedCondition* collapsed = marked(markers, MeshCondition::triangle_collapsed);
    ASSERT_NE(collapsed, nullptr);
    EXPECT_EQ(collapsed->count, 2U) << "one for each instance";
    EXPECT_EQ(collapsed->marked, 2U);
    const glm::vec3 color = marker_color(MeshCondition::triangle_collapsed);
    EXPECT_EQ(collapsed->color_srgb, color);
    EXPECT_EQ(markers.markers->at(0), (Marker{0, {4, 1, 0}, color}));
    EXPECT_EQ(markers.markers->at(1), (Marker{1, {4, 1, 0}, color}));
    const MarkedCondition* isolated = marked(markers, MeshCondition::vertex_isolated);
    ASSERT_NE(isolated, nullptr);
    const Marker at_vertex{0, {9, 9, 9}, marker_color(MeshCondition::vertex_isolated)};
    EXPECT_EQ(std::count(markers.markers->begin(), markers.markers->end(), at_vertex), 1);
}

TEST(HealthMarkers, ShowNotesOnlyOnRequest) {
    const Scene scene = scene_of(troubled(), 1);
    EXPECT_EQ(marked(health_markers(scene), MeshCondition::edge_boundary), nullptr);
    const HealthMarkers all = health_markers(scene, std::nullopt);
    const Diagnosis diagnosis = diagnose(scene.meshes[0]);
    EXPECT_EQ(all.conditions.size(), diagnosis.conditions.size());
    for (const MeshConditionCount& found : diagnosis.conditions) {
        ASSERT_NE(marked(all, found.condition), nullptr);
        EXPECT_EQ(marked(all, found.condition)->count, found.count);
    }
    EXPECT_EQ(marked(all, MeshCondition::edge_boundary)->count, 4U);
}

TEST(HealthMarkers, SoundMeshHasNone) {
    const HealthMarkers markers = health_markers(scene_of(test::cube(), 1));
    EXPECT_TRUE(markers.conditions.empty());
    EXPECT_TRUE(markers.markers->empty());
}

TEST(HealthMarkers, CountProblemsWithoutPosition) {
    Mesh mesh = test::grid(1);
    mesh.positions[0].x = std::numeric_limits<float>::infinity();
    const HealthMarkers markers = health_markers(scene_of(mesh, 1));
    const MarkedCondition* nowhere = marked(markers, MeshCondition::vertex_not_finite);
    ASSERT_NE(nowhere, nullptr);
    EXPECT_EQ(nowhere->count, 1U);
    EXPECT_EQ(nowhere->marked, 0U);
}

TEST(HealthMarkers, NameMoreThanAReportDoes) {
    Mesh mesh = test::grid(1);
    for (int i = 0; i < 100; ++i) {
        mesh.positions.emplace_back(0.0F, 0.0F, static_cast<float>(i + 1));
        mesh.normals.emplace_back(0, 0, 1);
        mesh.texcoords.emplace_back(0.0F);
    }
    const HealthMarkers markers = health_markers(scene_of(mesh, 1));
    EXPECT_EQ(marked(markers, MeshCondition::vertex_isolated)->marked, 100U);
}

TEST(HealthMarkers, HaveDistinctColors) {
    for (const MeshConditionInfo& a : mesh_conditions()) {
        for (const MeshConditionInfo& b : mesh_conditions()) {
            if (a.condition >= b.condition) continue;
            const glm::vec3 apart = marker_color(a.condition) - marker_color(b.condition);
            EXPECT_GT(glm::length(apart), 0.07F) << a.word << ", " << b.word;
        }
    }
}

}  // namespace
}  // namespace relief
