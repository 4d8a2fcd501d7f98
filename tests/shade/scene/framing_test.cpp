// SPDX-License-Identifier: Apache-2.0
// The depth range that moves along, and the smallest distance from which all vertices are seen.
#include "relief/shade/framing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "relief/mesh/error.h"
#include "support/angle.h"
#include "support/shapes.h"

namespace relief {
namespace {

/// Depth of the farthest corner of the cube from -1 to 1.
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
}

/// The largest of |x| and |y| in clip space after division, over all finite vertices: 1 is the edge
/// of the picture.
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
    // A vertex that is nowhere must not push the camera away.
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

TEST(Framing, OfNothingStandsAtDistanceOne) {
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

}  // namespace
}  // namespace relief
