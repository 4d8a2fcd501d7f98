// SPDX-License-Identifier: Apache-2.0
/// \file
/// What hangs on what in a scene, to be listed. No window and no OpenGL.
/// Tests: tests/tools/window/scene_tree_test.cpp.
#pragma once

#include <string>
#include <vector>

#include "relief/shade/scene_graph.h"

namespace relief::tools {

/// A node, or the world.
struct TreeNode {
    std::string name;  ///< "node 3" where it has none.
    std::vector<std::size_t> instances;
    std::vector<std::string> carried;   ///< "camera", "point light 2".
    std::vector<std::size_t> children;  ///< Indices into SceneTree::nodes.
};

/// Of a graph: its nodes in their order.
struct SceneTree {
    std::vector<TreeNode> nodes;
    TreeNode world;  ///< What hangs on nothing.
};
SceneTree tree_of(const SceneGraph& graph);

/// Every instance on a node or below it.
std::vector<std::size_t> instances_below(const SceneTree& tree, const TreeNode& node);

}  // namespace relief::tools
