// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines scenes whose objects are attached to nodes, and the animations of nodes: key frames,
/// orbits, turntables.
///
/// World space is right-handed, y up; radians and seconds. A pose depends on the time alone, not on
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
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh.h"
#include "relief/shade/camera.h"
#include "relief/shade/scene.h"

namespace RELIEF_API relief {
namespace shade {

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
    bool position_only = false;
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

/// Moves nodes or numbers over time: key frames, an orbit or a turntable.
///
/// A channel of Property::pointer moves a number or color of a material, light or camera. `pointer`
/// is its list and its name in scene files ("materials.metallic_roughness.roughness",
/// "spot_lights.color", "cameras.fov"), and `node` is the index in that list. Values outside of the
/// range of the field count as the nearest allowed ones. validate() refuses a channel that names
/// nothing; pose() ignores it.
using Animation = std::variant<KeyAnimation, Orbit, Turntable>;

/// The nodes that deform the mesh of an instance (Instance::pose).
struct DeformedInstance {
    std::size_t instance = 0;    ///< Index into Scene::instances.
    std::size_t node = 0;        ///< The node with the morph weights.
    std::vector<float> weights;  ///< At rest.
    /// The joints, which place the instance in the world; without any, only morph targets deform
    /// it.
    std::vector<std::size_t> joints;
    std::vector<glm::mat4> joint_from_mesh;  ///< One for each joint.
};

/// A camera of a file.
struct FileCamera {
    std::string name;
    Camera camera;
    Carried carried;
    /// True if the far plane must stay behind all moving meshes, because the file does not name
    /// one.
    bool sees_all = false;
};

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
    /// True if the far plane must stay behind all moving meshes, because the file does not name
    /// one.
    bool camera_sees_all = false;
    /// All cameras of a glTF file. The scene's camera is the first one; see choose_camera().
    std::vector<FileCamera> cameras;
    std::size_t chosen_camera = 0;  ///< By choose_camera(), an index into `cameras`.
    /// The width and height of the picture that a scene file requests.
    std::optional<glm::ivec2> picture_size;
    /// The names of the material variants of a glTF file, "variant 1" and so on where a name is
    /// empty. SceneOptions::material_variant selects one.
    std::vector<std::string> material_variants;
    /// All play at the same time, except key animations other than `clip`. If two move the same
    /// node, the later one wins.
    std::vector<Animation> animations;
    /// The key animation that plays, counted among the key animations; if absent, all of them.
    std::optional<std::size_t> clip;
    /// Instances whose meshes pose() deforms.
    std::vector<DeformedInstance> deformed;
    /// The bounds of every mesh at rest, for camera_sees_all; pose() fills them on first use.
    std::vector<Bounds> mesh_bounds;
};

/// Moves all objects that are attached to nodes to their transforms at this time, and sets the
/// joint matrices and morph weights of instances that are deformed (Instance::pose). No mesh
/// changes.
///
/// Numbers and colors that animations move get their values, too. If moves_materials(), a Renderer
/// must be made again, because other effects may be needed.
///
/// A light whose node is scaled to 0 shines along the world's -z; such a camera has the world's
/// axes.
/// \throws InvalidInput if an index of a node does not exist, nodes form a cycle, the time is not
///         finite, or keys are not as KeyChannel requires
void pose(SceneGraph& graph, double seconds);

/// Returns whether an animation that plays moves numbers or colors of materials, or the ambient
/// light of lights.
bool moves_materials(const SceneGraph& graph);

/// Makes a camera of the file the scene's camera. The next pose() places it.
/// \param index  into SceneGraph::cameras \throws InvalidInput if there is no such camera
void choose_camera(SceneGraph& graph, std::size_t index);

/// Returns the names of the cameras of the file, "camera 1" and so on where a name is empty.
std::vector<std::string> camera_names(const SceneGraph& graph);

/// Returns the duration of the longest animation that plays: the time of its last key, or of a full
/// rotation. 0 without animations; those of speed 0 are ignored.
double duration(const SceneGraph& graph);

/// Returns the names of the key animations, "animation 1" and so on where a name is empty.
std::vector<std::string> clip_names(const SceneGraph& graph);

/// Returns whether two key animations move the same property of a node, so that they are meant to
/// play one at a time.
bool clips_exclude_each_other(const SceneGraph& graph);

/// Checks everything that pose() relies on, and the scene. \throws InvalidInput naming the first
/// error
void validate(const SceneGraph& graph);

/// Returns the transform of an object that looks along a direction, as lights and cameras do: its
/// -z is along `direction` (any length but 0), its +y as close as possible to the world's +y.
glm::mat4 looking_along(const glm::vec3& position, const glm::vec3& direction);

/// Adds a small unlit sphere for every point and spot light, in the color of the light scaled to a
/// maximum of 1. Spheres move with the nodes of their lights; lights that are black or off get
/// none.
///
/// \param radius  in world units, independent of the scale of nodes
/// \throws InvalidInput if the radius is not positive and finite
void add_light_markers(SceneGraph& graph, float radius);

}  // namespace shade
}  // namespace relief
