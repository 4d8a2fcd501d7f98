// SPDX-License-Identifier: Apache-2.0
// Checks every index and number of a scene graph that poses rely on, and names the first offence.
// Nothing is repaired. Tests: tests/shade/scene/scene_graph_test.cpp.
#include <fmt/format.h>

#include <cmath>

#include "relief/mesh/error.h"
#include "relief/shade/scene_graph.h"
#include "scene/is_finite.h"
#include "scene/key_channel.h"

namespace relief {

namespace {

std::string node_label(const SceneGraph& graph, std::size_t node) {
    const std::string& name = graph.nodes[node].name;
    return name.empty() ? fmt::format("node {}", node) : fmt::format("node '{}'", name);
}

void check_node(const SceneGraph& graph, const std::string& thing, std::size_t node) {
    if (node >= graph.nodes.size()) {
        throw InvalidInput(fmt::format("{} names node {}, but there are only {}", thing, node,
                                       graph.nodes.size()));
    }
}

void validate_node(const SceneGraph& graph, std::size_t index) {
    const SceneNode& node = graph.nodes[index];
    const std::string thing = node_label(graph, index);
    if (node.parent) check_node(graph, thing + "'s parent", *node.parent);
    const glm::quat& q = node.rotation;
    const bool finite = is_finite(node.translation) && is_finite(node.scale) &&
                        is_finite(glm::vec3(q.x, q.y, q.z)) && std::isfinite(q.w) &&
                        (!node.matrix || is_finite(*node.matrix));
    if (!finite) throw InvalidInput(thing + " has a transform that is not finite");
    if (!(glm::length(q) > 0.0F)) throw InvalidInput(thing + " has a rotation without a length");
    // No chain of parents is longer than there are nodes, unless it goes round.
    std::optional<std::size_t> above = node.parent;
    for (std::size_t steps = 0; above && *above < graph.nodes.size(); ++steps) {
        if (*above == index || steps > graph.nodes.size())
            throw InvalidInput(thing + " is its own ancestor");
        above = graph.nodes[*above].parent;
    }
}

void validate_carried(const SceneGraph& graph, const char* things,
                      const std::vector<Carried>& carried, std::size_t count) {
    if (carried.size() > count) {
        throw InvalidInput(
            fmt::format("nodes carry {} {}, but there are only {}", carried.size(), things, count));
    }
    for (std::size_t i = 0; i < carried.size(); ++i) {
        const std::string thing = fmt::format("number {} of the {}", i, things);
        if (carried[i].node) check_node(graph, thing, *carried[i].node);
        if (!is_finite(carried[i].node_from_object))
            throw InvalidInput(thing + " has a matrix that is not finite");
    }
}

/// What moves translation, rotation or scale needs a node that has them.
void check_parts(const SceneGraph& graph, const std::string& thing, std::size_t node) {
    check_node(graph, thing, node);
    if (graph.nodes[node].matrix) {
        throw InvalidInput(
            fmt::format("{} moves {}, which has a matrix instead of translation, "
                        "rotation and scale",
                        thing, node_label(graph, node)));
    }
}

void validate_motion(const SceneGraph& graph, const std::string& thing,
                     const KeyAnimation& animation) {
    for (const KeyChannel& channel : animation.channels) {
        check_parts(graph, thing, channel.node);
        try {
            check_keys(channel);
        } catch (const InvalidInput& error) {
            throw InvalidInput(thing + ": " + error.what());
        }
    }
}

void validate_motion(const SceneGraph& graph, const std::string& thing, const Orbit& orbit) {
    check_parts(graph, thing, orbit.node);
    const bool finite = is_finite(orbit.center) && std::isfinite(orbit.azimuth) &&
                        std::isfinite(orbit.elevation) && std::isfinite(orbit.azimuth_speed) &&
                        std::isfinite(orbit.elevation_speed);
    if (!finite) throw InvalidInput(thing + " has a number that is not finite");
    if (!(orbit.radius >= 0.0F && std::isfinite(orbit.radius))) {
        throw InvalidInput(fmt::format("{} has radius {}, but it must be finite and not negative",
                                       thing, orbit.radius));
    }
}

void validate_motion(const SceneGraph& graph, const std::string& thing,
                     const Turntable& turntable) {
    check_node(graph, thing, turntable.node);
    if (!is_finite(turntable.axis) || turntable.axis == glm::vec3(0.0F))
        throw InvalidInput(thing + " has an axis without a length");
    if (!std::isfinite(turntable.speed) || !std::isfinite(turntable.angle))
        throw InvalidInput(thing + " has a number that is not finite");
}

}  // namespace

void validate(const SceneGraph& graph) {
    for (std::size_t i = 0; i < graph.nodes.size(); ++i)
        validate_node(graph, i);
    const Scene& scene = graph.scene;
    validate_carried(graph, "instances", graph.instances, scene.instances.size());
    validate_carried(graph, "directional lights", graph.directional_lights,
                     scene.directional_lights.size());
    validate_carried(graph, "point lights", graph.point_lights, scene.point_lights.size());
    validate_carried(graph, "spot lights", graph.spot_lights, scene.spot_lights.size());
    validate_carried(graph, "cameras", {graph.camera}, 1);
    for (std::size_t i = 0; i < graph.animations.size(); ++i) {
        const std::string thing = fmt::format("animation {}", i);
        std::visit([&](const auto& motion) { validate_motion(graph, thing, motion); },
                   graph.animations[i]);
    }
    validate(scene);
}

}  // namespace relief
