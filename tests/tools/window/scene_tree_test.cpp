// SPDX-License-Identifier: Apache-2.0
#include "window/scene_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace relief::tools {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// A cart with two wheels, of which one carries a lamp; a stone that hangs on nothing.
SceneGraph cart() {
    SceneGraph graph;
    graph.nodes.resize(3);
    graph.nodes[0].name = "cart";
    graph.nodes[1].parent = 0;
    graph.nodes[2].parent = 0;
    graph.nodes[2].name = "wheel";
    graph.scene.instances.resize(4);
    graph.instances.resize(3);
    graph.instances[0].node = 0;
    graph.instances[1].node = 1;
    graph.instances[2].node = 2;
    graph.scene.point_lights.resize(2);
    graph.point_lights.resize(2);
    graph.point_lights[1].node = 2;
    graph.scene.camera.emplace();
    graph.camera.node = 0;
    return graph;
}

TEST(SceneTreeTest, ListsWhatHangsOnWhat) {
    const SceneTree tree = tree_of(cart());
    ASSERT_EQ(tree.nodes.size(), 3U);
    EXPECT_EQ(tree.nodes[0].name, "cart");
    EXPECT_EQ(tree.nodes[1].name, "node 1") << "it has none";
    EXPECT_THAT(tree.world.children, ElementsAre(0));
    EXPECT_THAT(tree.nodes[0].children, ElementsAre(1, 2));
    EXPECT_THAT(tree.nodes[0].instances, ElementsAre(0));
    EXPECT_THAT(tree.nodes[0].carried, ElementsAre("camera"));
    EXPECT_THAT(tree.nodes[2].instances, ElementsAre(2));
    EXPECT_THAT(tree.nodes[2].carried, ElementsAre("point light 2"));
    EXPECT_THAT(tree.world.instances, ElementsAre(3)) << "the list of what is carried is shorter";
    EXPECT_THAT(tree.world.carried, ElementsAre("point light 1"));
}

TEST(SceneTreeTest, KnowsAllThatIsBelowANode) {
    const SceneTree tree = tree_of(cart());
    EXPECT_THAT(instances_below(tree, tree.nodes[0]), UnorderedElementsAre(0, 1, 2));
    EXPECT_THAT(instances_below(tree, tree.nodes[2]), ElementsAre(2));
    EXPECT_THAT(instances_below(tree, tree.world), UnorderedElementsAre(0, 1, 2, 3));
    EXPECT_THAT(instances_below(tree_of({}), tree_of({}).world), IsEmpty());
}

}  // namespace
}  // namespace relief::tools
