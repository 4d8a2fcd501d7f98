// SPDX-License-Identifier: Apache-2.0
#include "window/health_search.h"

#include <gtest/gtest.h>

#include "tools/window/display.h"

namespace relief::tools {
namespace {

using test::eventually;

/// One triangle, and one without an area.
std::shared_ptr<const Scene> collapsed() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
    Scene scene;
    scene.meshes.emplace_back(std::move(mesh));
    scene.instances.push_back({});
    return std::make_shared<const Scene>(std::move(scene));
}

TEST(HealthSearch, FindsWhatTheSceneSuffersFrom) {
    HealthSearch search([] {});
    search.start({collapsed(), HealthChoice::trouble});
    std::optional<FoundHealth> found;
    ASSERT_TRUE(eventually([&] { return (found = search.take()).has_value(); }));
    EXPECT_EQ(found->error, "");
    ASSERT_TRUE(found->markers.markers);
    EXPECT_FALSE(found->markers.markers->empty());
    EXPECT_FALSE(search.is_going_on());
}

TEST(HealthSearch, WhatIsNotWishedAnyMoreNeverComes) {
    HealthSearch search([] {});
    search.start({collapsed(), HealthChoice::all});
    search.start({collapsed(), std::nullopt});
    EXPECT_FALSE(search.is_going_on());
    EXPECT_FALSE(search.take());
}

TEST(HealthSearch, ABrokenSceneIsAnError) {
    auto broken = std::make_shared<Scene>(*collapsed());
    broken->meshes[0].edit().triangles.push_back({0, 1, 9});
    HealthSearch search([] {});
    search.start({broken, HealthChoice::trouble});
    std::optional<FoundHealth> found;
    ASSERT_TRUE(eventually([&] { return (found = search.take()).has_value(); }));
    EXPECT_NE(found->error, "");
}

}  // namespace
}  // namespace relief::tools
