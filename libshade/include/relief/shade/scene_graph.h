// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines scenes whose objects are attached to nodes, and the animations of nodes: key frames,
/// orbits, turntables.
///
/// World space, right-handed, y up; radians and seconds. A pose depends on the time alone, not on
/// earlier poses.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relief/export.h"
#include "relief/shade/scene.h"

namespace RELIEF_API relief {

/// A node at rest: scaled, then rotated, then translated within its parent's space.
struct SceneNode {
    std::string name;
    std::optional<std::size_t> parent;  ///< If absent, the world.
    glm::vec3 translation{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};  ///< Any length but 0.
    glm::vec3 scale{1.0F};
    std::optional<glm::mat4> matrix;  ///< Replaces the three above; excludes key frames.
};

/// The node that carries an object, and the transform of the object in the space of the node.
struct Carried {
    std::optional<std::size_t> node;  ///< If absent, pose() does not move the object.
    glm::mat4 node_from_object{1.0F};
    /// Takes only the position from the node, neither rotation nor scale.
    bool place_only = false;
};

/// A node that orbits on spherical coordinates within its parent's space.
struct Orbit {
    std::size_t node = 0;
    glm::vec3 center{0.0F};
    float radius = 1.0F;
    float azimuth = 0.0F;    ///< At time 0, from +z towards +x.
    float elevation = 0.0F;  ///< At time 0, above the xz plane; it may pass the pole.
    float azimuth_speed = 1.0F;
    float elevation_speed = 0.0F;
    /// Rotates the node's -z, along which cameras and lights look, to the center. Otherwise the
    /// node keeps its rotation.
    bool faces_center = false;
};

/// A node that rotates about an axis through its own origin, in its own space.
struct Turntable {
    std::size_t node = 0;
    glm::vec3 axis{0.0F, 1.0F, 0.0F};  ///< Any length but 0.
    float speed = 1.0F;                ///< Counter-clockwise seen from the tip of the axis.
    float angle = 0.0F;                ///< At time 0.
};

using Animation = std::variant<KeyAnimation, Orbit, Turntable>;

/// A scene with its nodes and animations.
///
/// The lists of Carried correspond to the scene's lists of the same name; if one is shorter, the
/// remaining objects do not move. A light shines along its object's -z from the origin, a camera
/// looks along it.
struct SceneGraph {
    Scene scene;
    std::vector<SceneNode> nodes;
    std::vector<Carried> instances;
    std::vector<Carried> directional_lights;
    std::vector<Carried> point_lights;
    std::vector<Carried> spot_lights;
    Carried camera;
    /// The width and height of the picture that a scene file requests.
    std::optional<glm::ivec2> picture_size;
    /// True if the far plane must stay behind all moving meshes, because the file does not name
    /// one.
    bool camera_sees_all = false;
    /// All play at the same time. If two move the same node, the later one wins.
    std::vector<Animation> animations;
    /// The bounds of every mesh, for camera_sees_all; pose() fills them on first use.
    std::vector<Bounds> mesh_bounds;
};

/// Moves all objects that are attached to nodes to their transforms at this time. Meshes do not
/// change.
///
/// A light whose node is scaled to 0 shines along the world's -z; such a camera has the world's
/// axes.
/// \throws InvalidInput if an index of a node does not exist, nodes form a cycle, the time is not
///         finite, or keys are not as KeyChannel requires
void pose(SceneGraph& graph, double seconds);

/// Returns the duration of the longest animation: the time of its last key, or of a full rotation.
/// 0 without animations; those of speed 0 are ignored.
double duration(const SceneGraph& graph);

/// Checks everything that pose() relies on, and the scene. \throws InvalidInput naming the first
/// error
void validate(const SceneGraph& graph);

/// Returns the transform of an object that looks along a direction, as lights and cameras do: its
/// -z is along `direction` (any length but 0), its +y as close as possible to the world's +y.
glm::mat4 looking_along(const glm::vec3& position, const glm::vec3& direction);

/// Adds a small unlit sphere for every point and spot light, in the color of the light scaled to a
/// maximum of 1. Spheres move with the nodes of their lights; black lights get none.
///
/// \param radius  in world units, independent of the scale of nodes
/// \throws InvalidInput if the radius is not positive and finite
void add_light_markers(SceneGraph& graph, float radius);

}  // namespace relief
