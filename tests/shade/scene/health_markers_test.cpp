// SPDX-License-Identifier: Apache-2.0
// Markers where the health check found trouble: their places, colours and numbers, against the
// check itself.
#include "relief/shade/health_markers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "support/shapes.h"

namespace relief {
namespace {

/// A square, a triangle that collapsed onto its middle, and a vertex of no triangle.
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

TEST(HealthMarkers, StandWhereTheTroubleIs) {
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

TEST(HealthMarkers, AreOfTroubleUnlessRemarksAreAskedForToo) {
    const Scene scene = scene_of(troubled(), 1);
    EXPECT_EQ(marked(health_markers(scene), MeshCondition::edge_boundary), nullptr);
    const HealthMarkers all = health_markers(scene, std::nullopt);
    const Diagnosis diagnosis = diagnose(scene.meshes[0]);
    EXPECT_EQ(all.conditions.size(), diagnosis.found.size());
    for (const MeshConditionCount& found : diagnosis.found) {
        ASSERT_NE(marked(all, found.condition), nullptr);
        EXPECT_EQ(marked(all, found.condition)->count, found.count);
    }
    EXPECT_EQ(marked(all, MeshCondition::edge_boundary)->count, 4U);
}

TEST(HealthMarkers, OfASoundMeshAreNone) {
    const HealthMarkers markers = health_markers(scene_of(test::cube(), 1));
    EXPECT_TRUE(markers.conditions.empty());
    EXPECT_TRUE(markers.markers->empty());
}

TEST(HealthMarkers, CountWhatIsNowhere) {
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

TEST(HealthMarkers, HaveColoursThatDiffer) {
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
