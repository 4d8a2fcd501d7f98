// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/scene_tree_test.cpp.
#include "window/scene_tree.h"

#include <fmt/format.h>

namespace relief::tools {

SceneTree tree_of(const SceneGraph& graph) {
    SceneTree tree;
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
        const std::string& name = graph.nodes[i].name;
        tree.nodes.emplace_back().name = name.empty() ? fmt::format("node {}", i) : name;
    }
    const auto node_of = [&](std::optional<std::size_t> node) -> TreeNode& {
        return node ? tree.nodes.at(*node) : tree.world;
    };
    for (std::size_t i = 0; i < graph.nodes.size(); ++i)
        node_of(graph.nodes[i].parent).children.push_back(i);
    // A list of what is carried may be shorter than its things: the rest hangs on nothing.
    const auto holder = [&](const std::vector<Carried>& carried, std::size_t i) -> TreeNode& {
        return node_of(i < carried.size() ? carried[i].node : std::nullopt);
    };
    for (std::size_t i = 0; i < graph.scene.instances.size(); ++i)
        holder(graph.instances, i).instances.push_back(i);
    const auto hang = [&](const std::vector<Carried>& carried, std::size_t count,
                          const char* kind) {
        for (std::size_t i = 0; i < count; ++i)
            holder(carried, i).carried.push_back(fmt::format("{} light {}", kind, i + 1));
    };
    const Scene& scene = graph.scene;
    hang(graph.directional_lights, scene.directional_lights.size(), "directional");
    hang(graph.point_lights, scene.point_lights.size(), "point");
    hang(graph.spot_lights, scene.spot_lights.size(), "spot");
    if (scene.camera) node_of(graph.camera.node).carried.emplace_back("camera");
    return tree;
}

std::vector<std::size_t> instances_below(const SceneTree& tree, const TreeNode& node) {
    std::vector<std::size_t> all = node.instances;
    std::vector<std::size_t> open = node.children;
    while (!open.empty()) {
        const TreeNode& next = tree.nodes[open.back()];
        open.pop_back();
        all.insert(all.end(), next.instances.begin(), next.instances.end());
        open.insert(open.end(), next.children.begin(), next.children.end());
    }
    return all;
}

}  // namespace relief::tools
