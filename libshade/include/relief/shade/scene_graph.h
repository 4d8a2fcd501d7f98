// SPDX-License-Identifier: Apache-2.0
/// \file
/// A scene whose things hang on nodes, and how the nodes move: key frames, orbits, turntables.
///
/// World space, right-handed, y up; radians and seconds. A pose depends on the time alone, not on
/// the poses before. Tests: tests/shade/scene/scene_graph_test.cpp.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relief/shade/scene.h"

namespace relief {

/// A node at rest: scaled, then turned, then moved within its parent's space.
struct SceneNode {
    std::string name;
    std::optional<std::size_t> parent;  ///< Absent: the world.
    glm::vec3 translation{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};  ///< Any length but 0.
    glm::vec3 scale{1.0F};
    std::optional<glm::mat4> matrix;  ///< Takes the place of the three above; not for key frames.
};

/// What a thing hangs on, and where in that node's space it is.
struct Carried {
    std::optional<std::size_t> node;  ///< Absent: pose() leaves the thing where it is.
    glm::mat4 node_from_object{1.0F};
    /// Takes from its node only where it is: neither rotation nor scale.
    bool place_only = false;
};

/// How values between two keys are found; glTF's ways.
enum class KeyInterpolation {
    step,          ///< The key before.
    linear,        ///< On the straight line; rotations on the shortest arc.
    cubic_spline,  ///< By Hermite's cubic, with a tangent before and after each key.
};

/// The keys of one property of a node. Before the first key its value holds, and after the last.
struct KeyChannel {
    enum class Property { translation, rotation, scale };

    std::size_t node = 0;
    Property property = Property::translation;
    KeyInterpolation interpolation = KeyInterpolation::linear;
    std::vector<float> times;  ///< Ascending, at least one.
    /// One for each time, or three for cubic_spline: in-tangent, value, out-tangent. Quaternions
    /// are x, y, z, w of any length but 0; of the others w does not count.
    std::vector<glm::vec4> values;
};

/// Key frames, again and again from the start.
struct KeyAnimation {
    std::string name;
    std::vector<KeyChannel> channels;
};

/// A node that circles on spherical coordinates within its parent's space.
struct Orbit {
    std::size_t node = 0;
    glm::vec3 center{0.0F};
    float radius = 1.0F;
    float azimuth = 0.0F;    ///< At time 0, from +z towards +x.
    float elevation = 0.0F;  ///< At time 0, above the xz plane; past the pole it goes on.
    float azimuth_speed = 1.0F;
    float elevation_speed = 0.0F;
    /// Turns the node's -z, along which cameras and lights look, to the centre. Else it keeps its
    /// rotation.
    bool faces_center = false;
};

/// A node that turns about an axis through its own origin, in its own space.
struct Turntable {
    std::size_t node = 0;
    glm::vec3 axis{0.0F, 1.0F, 0.0F};  ///< Any length but 0.
    float speed = 1.0F;                ///< Anticlockwise as seen from the axis' tip.
    float angle = 0.0F;                ///< At time 0.
};

using Animation = std::variant<KeyAnimation, Orbit, Turntable>;

/// A scene and what moves it.
///
/// The lists of what is carried go along with the scene's lists of the same name; where one is
/// shorter, the rest stands in the world by itself. A light shines along its object's -z from the
/// origin there, a camera looks along it.
struct SceneGraph {
    Scene scene;
    std::vector<SceneNode> nodes;
    std::vector<Carried> instances;
    std::vector<Carried> directional_lights;
    std::vector<Carried> point_lights;
    std::vector<Carried> spot_lights;
    Carried camera;
    /// Width and height of the picture that a scene file asks for.
    std::optional<glm::ivec2> picture_size;
    /// The camera's far plane keeps behind every mesh as things move: the file named none.
    bool camera_sees_all = false;
    /// All play at once; where two move the same node, the later one has its way.
    std::vector<Animation> animations;
    /// Of every mesh, for camera_sees_all; pose() fills it when it is needed first.
    std::vector<Bounds> mesh_bounds;
};

/// Puts everything that hangs on a node where it is at this time. Meshes are not touched.
///
/// A light whose node is scaled to nothing shines along the world's -z; a camera likewise keeps the
/// world's axes. \throws InvalidInput if a node, a channel or a thing names no node, nodes form a
/// cycle, the time is not finite, or keys are not as KeyChannel says
void pose(SceneGraph& graph, double seconds);

/// How long the longest animation takes until it is where it began: the time of its last key, or a
/// full turn. 0 where nothing moves; what stands still for ever (speed 0) does not count.
double duration(const SceneGraph& graph);

/// Checks what pose() relies on, and the scene. \throws InvalidInput naming the first offence
void validate(const SceneGraph& graph);

/// Where an object stands that looks along a direction, as lights and cameras do: its -z along
/// `direction` (any length but 0), its +y as near to the world's +y as can be.
glm::mat4 looking_along(const glm::vec3& position, const glm::vec3& direction);

/// Draws every point and spot light as a small sphere of its colour, unlit, the largest channel 1.
/// Spheres hang on the nodes of their lights, so they move along; black lights get none.
///
/// \param radius  in world units, whatever the nodes' scale
/// \throws InvalidInput if the radius is not positive and finite
void add_light_markers(SceneGraph& graph, float radius);

}  // namespace relief
