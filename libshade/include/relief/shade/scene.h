// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines scenes as plain data: meshes, materials (material.h), lights, a camera, an environment,
/// nodes and their animations; and computes default cameras and lights. No OpenGL.
///
/// World space is right-handed, y up. Colors are linear. Angles are radians. Images are named here
/// and decoded only if the effect plan (effects.h) needs them. scene_fields.h has the name and
/// range of every field.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/image.h"
#include "relief/mesh/mesh.h"
#include "relief/shade/material.h"

namespace RELIEF_API relief {

/// A value that copies share until one of them is edited.
///
/// Several threads may read without a lock, also while another thread edits its own copy.
template <typename T>
class Shared {
    struct Held {
        T value;
        std::uint64_t edits = 0;
    };

  public:
    Shared() : held_(std::make_shared<Held>()) {}
    // The conversions are implicit, so that a Shared<T> can be used like a T.
    Shared(T value) : held_(std::make_shared<Held>(Held{std::move(value)})) {}  // NOLINT

    const T& operator*() const { return held_->value; }
    const T* operator->() const { return &held_->value; }
    operator const T&() const { return held_->value; }  // NOLINT

    /// The value for editing. It is copied first if other copies share it.
    T& edit() {
        if (held_.use_count() > 1) held_ = std::make_shared<Held>(*held_);
        ++held_->edits;
        return held_->value;
    }

    /// Identifies an unedited value without keeping it in memory.
    class Identity {
      public:
        explicit Identity(const Shared& shared)
            : held_(shared.held_), edits_(shared.held_->edits) {}

        /// Returns true if this is the same object, not only an equal one, and has not been edited
        /// since.
        [[nodiscard]] bool is(const Shared& shared) const {
            const bool is_other =
                held_.owner_before(shared.held_) || shared.held_.owner_before(held_);
            return !is_other && edits_ == shared.held_->edits;
        }

      private:
        std::weak_ptr<const Held> held_;
        std::uint64_t edits_;
    };
    [[nodiscard]] Identity identity() const { return Identity(*this); }

  private:
    std::shared_ptr<Held> held_;
};

// Lights are plain data in world space. Intensities are irradiances over pi: a white surface that
// faces a directional light of irradiance 1 has radiance 1.

/// Light from infinitely far away.
struct DirectionalLight {
    /// The direction in which light travels; any length but 0.
    glm::vec3 direction_world{0.0F, -1.0F, 0.0F};
    /// Irradiance over pi of a surface that faces the light: the radiance of a white surface.
    glm::vec3 irradiance{1.0F};
    /// The irradiance for highlights, if different; metallic-roughness ignores it.
    std::optional<glm::vec3> highlight_irradiance = std::nullopt;
    glm::vec3 ambient{0.0F};  ///< The ambient light that it adds to the scene's.
    bool on = true;           ///< False: the light is off, and so is its ambient light.
};

/// The decrease of light with distance.
enum class Falloff {
    inverse_square,
    none,  ///< The same at every distance, as in introductory courses.
};

/// Light from a point. Its own position gets no light, and no surface gets more than max_light.
struct PointLight {
    glm::vec3 position_world{0.0F};
    glm::vec3 intensity{1.0F};  ///< Irradiance over pi at distance 1.
    /// The light fades to 0 at this distance (KHR_lights_punctual).
    std::optional<float> range = std::nullopt;
    Falloff falloff = Falloff::inverse_square;
    /// The intensity for highlights, if different; metallic-roughness ignores it.
    std::optional<glm::vec3> highlight_intensity = std::nullopt;
    glm::vec3 ambient{0.0F};  ///< The ambient light that it adds to the scene's, everywhere.
    bool on = true;           ///< False: the light is off, and so is its ambient light.
};

/// A point light within a cone.
struct SpotLight {
    PointLight point;
    glm::vec3 direction_world{0.0F, -1.0F, 0.0F};  ///< The cone's axis; any length but 0.
    float inner_cone = 0.0F;          ///< Full intensity within; radians from the axis.
    float outer_cone = 0.785398163F;  ///< No light beyond; above inner_cone, at most pi / 2.
};

/// The maximum irradiance, intensity and ambient radiance of a scene, and of a surface by one light
/// at any distance. Products with it stay finite.
inline constexpr float max_light = 1e18F;

/// The source of an image: a file, an encoded file in memory, or a decoded image.
struct ImageSource {
    std::string name;  ///< For messages.
    std::variant<std::filesystem::path, Shared<std::vector<std::byte>>, Shared<Image>> source;
    std::string origin{};  ///< The file that names the image, for messages; empty: none.
    /// The reason why the image cannot be decoded; empty if there is none.
    std::string fault{};
    /// True if a Renderer throws if it cannot decode the image. Otherwise it reports the error and
    /// draws without the texture.
    bool is_required = false;
};

/// A camera that looks along its own -z.
struct Camera {
    glm::mat4 world_from_view{1.0F};  ///< Rotation and translation only.
    float vertical_fov = 0.8F;
    float near = 0.1F;
    float far = 100.0F;
    /// The height of the picture in world units. If present, the projection is orthographic and
    /// vertical_fov has no effect.
    std::optional<float> orthographic_height = std::nullopt;

    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Six square images of one size, in OpenGL's order and orientation: +x -x +y -y +z -z, each looked
/// up by the world direction. Seen from inside, OpenGL's faces are those of a left-handed world:
/// sets drawn for a right-handed world appear mirrored unless left_handed is set.
struct CubeFaces {
    std::array<ImageSource, 6> faces;
    bool left_handed = false;  ///< Drawn for a left-handed world: x is reversed.
};

/// Six faces in one image, as a horizontal (4:3) or vertical (3:4) cross, recognized by its shape.
struct CubeCross {
    ImageSource image;
};

/// A panorama by longitude and latitude: its center is -z, its top row +y.
struct Equirectangular {
    ImageSource image;
};

/// A light probe: the view into a mirrored ball, by angle. The center is -z, the rim +z, up is +y.
struct AngularMap {
    ImageSource image;
};

/// An environment map: light from all directions.
struct Environment {
    std::variant<CubeFaces, CubeCross, Equirectangular, AngularMap> source;
    float intensity = 1.0F;
    bool skybox = true;   ///< The environment is visible behind the model.
    bool lights = false;  ///< Surfaces scatter its light, by spherical harmonics of order 2.
    /// Radians by which it is rotated about the world's y axis, from +z to +x. Finite.
    float rotation = 0.0F;
    /// The blur of the visible environment: 0 is none, 1 that of a mirror of roughness 1.
    float skybox_blur = 0.0F;
};

/// The curve from radiance times exposure to the picture (shaders/tone.glsl). The names in panels
/// are those of the glTF Sample Viewer.
enum class ToneMapping {
    none,             ///< Values above 1 are clamped.
    reinhard,         ///< x / (1 + x), by channel.
    aces,             ///< ACES (Narkowicz): a fit to the film curve of ACES, by channel.
    khronos_neutral,  ///< Khronos PBR Neutral: keeps the colors of materials, up to 0.76.
    aces_hill,        ///< ACES Filmic (Hill): a fit that mixes channels, as ACES does.
    aces_hill_boost,  ///< The same with an exposure of 1 / 0.6.
};

/// The shadow of the main light: of the first directional light that shines, or if there is none,
/// of the first spot light, or else of the first point light.
///
/// The light is a disc that faces the middle of the scene. The shadow at a point is the fraction of
/// `shadow_point_count` points of the disc that a surface hides, for all light of the main light.
/// Rays begin above the point, by 2.5 texels of the shadow maps along its normal, so that a surface
/// does not shade itself. Unlit materials and those with alpha blending or glTF's transmission cast
/// none. Middle and radius are those of the sphere around the bounding box of all that casts one.
/// A point or spot light closer to the middle than 1.1 times the radius casts none.
struct Shadow {
    /// The diameter of the disc, as an angle seen from the middle; 0 is a hard edge.
    float size = 0.0349065850F;  // 2 degrees
};

/// The points of a light that casts a soft shadow.
inline constexpr std::size_t shadow_point_count = 16;

/// A request for ambient occlusion: light from all around, of ambient light and the environment, is
/// multiplied by the fraction that arrives at the vertices (Instance::open_shares). Nothing
/// computes them on its own: see add_ambient_occlusion() in reference.h.
struct AmbientOcclusion {
    /// Surfaces within this distance occlude, as a fraction of the longest side of the box of the
    /// scene.
    float distance = 0.5F;
};

/// The pose of a mesh that morph targets and joints deform. glTF 2.0, sections 3.7.2.2 and 3.7.3.3.
/// The mesh itself stays at rest: renderers deform it in the vertex stage, deformed_mesh() on the
/// CPU.
struct MeshPose {
    Shared<GltfDeformation> deformation;  ///< For the vertices of the mesh; poses share it.
    std::vector<float> weights;           ///< Of the morph targets; missing ones are 0.
    /// For each joint, from the mesh at rest to object space; without any, only morph targets
    /// deform the mesh.
    std::vector<glm::mat4> joint_matrices;
    /// The normals are those of the deformed triangles, of which no two share a vertex.
    bool has_flat_normals = false;
};

/// A mesh in the world. Its material ranges refer to Scene::materials, or to the default material.
struct Instance {
    std::size_t mesh = 0;
    glm::mat4 world_from_object{1.0F};
    std::string name;
    std::optional<MeshPose> pose = std::nullopt;  ///< Only for meshes that can be deformed.
    /// For each vertex of the mesh, the fraction of the light from all around that arrives, from 0
    /// to 1; empty: all of it.
    Shared<std::vector<float>> open_shares{};
};

struct Scene {
    std::vector<Shared<Mesh>> meshes;  ///< Copies of a scene share them.
    std::vector<Material> materials;
    std::vector<ImageSource> images;
    std::vector<Instance> instances;
    /// Constant radiance from all directions, besides that of lights: ambient_light() has the sum.
    glm::vec3 ambient{0.0F};
    std::vector<DirectionalLight> directional_lights;
    std::vector<PointLight> point_lights;
    std::vector<SpotLight> spot_lights;
    std::optional<Environment> environment;
    std::optional<Camera> camera;  ///< If absent, framed() decides.
    glm::vec4 background{0.0F};    ///< Linear, alpha not multiplied in; visible without a skybox.
                                   ///< Neither exposed nor tone-mapped.
    float exposure = 1.0F;         ///< Multiplies radiance before tone mapping.
    ToneMapping tone_mapping = ToneMapping::none;  ///< For pictures with sRGB codes only.
    std::optional<Shadow> shadow = std::nullopt;   ///< If absent, no light casts a shadow.
    std::optional<AmbientOcclusion> ambient_occlusion = std::nullopt;
    /// Phong's surfaces clamp each term to [0, 1] before they add it (Material has the formula), as
    /// hardware with fixed functions did.
    bool clamp_terms = false;
};

/// Returns the ambient light of the scene: its own, and that of all lights that are on.
glm::vec3 ambient_light(const Scene& scene);

/// Returns true if the pose adds displacements of a morph target, because its weight is not 0.
bool is_morphed(const MeshPose& pose);

/// Returns true if a joint moves vertices: its matrix is not the identity.
bool is_skinned(const MeshPose& pose);

/// Returns the mesh of an instance as its pose deforms it: the displacements of morph targets are
/// added, and each vertex is then moved by the weighted mean of the matrices of its joints. Normals
/// and tangents become unit; one that loses its length is that at rest. A vertex without weights
/// follows the first joint.
///
/// \return the scene's own mesh, without a copy, if the pose does not deform it
Shared<Mesh> deformed_mesh(const Scene& scene, std::size_t instance);

/// Returns the bounding box of all instances in world space, as their poses deform them.
Bounds world_bounds(const Scene& scene);

/// Computes a camera that sees a whole box, for any aspect ratio.
///
/// \param azimuth  radians from +z towards +x, to the position of the camera
/// \param elevation  radians above the horizon
/// \param aspect  width / height of the picture
/// \return near and far enclose the box closely; for an empty box or one without extent, a camera
///         at distance 1 from its center (the origin for an empty box)
/// \throws InvalidInput if an angle or the aspect is not finite, the aspect is not positive, or the
///         field of view is not within (0, pi)
Camera framed(const Bounds& world, float azimuth, float elevation, float vertical_fov,
              float aspect);

/// Checks every index and number that drawing relies on: indices exist, numbers are finite and
/// within the ranges of scene_fields.h, directions have a length, the inner cones of spots are
/// smaller than the outer ones, the camera has a depth range, meshes are valid. Vertex data may
/// hold any value, NaN included; matrices may be singular. \throws InvalidInput naming the first
/// error
void validate(const Scene& scene);

/// Checks only what animations move: instances and lights. Meshes are skipped, so the cost is
/// negligible beside a frame.
void validate_transforms(const Scene& scene);

/// Checks a camera alone.
void validate(const Camera& camera);

/// Adds the default material to the list and assigns it to every triangle without a material, so
/// that it can be edited. Meshes that change are copied.
void name_default_material(Scene& scene);

/// Returns true if a triangle has no material.
bool uses_default_material(const Scene& scene);

/// The direction and field of view of the default camera, in radians.
inline constexpr float default_azimuth = 0.523598776F;       // 30 degrees
inline constexpr float default_elevation = 0.34906585F;      // 20 degrees
inline constexpr float default_vertical_fov = 0.610865238F;  // 35 degrees

/// #1e2126, linear, opaque.
inline constexpr glm::vec4 default_background{0.01299F, 0.01521F, 0.01938F, 1.0F};

/// Adds a warm key light from the upper left of the viewer, at an angle that shows relief, and a
/// dim cool light from the right, and sets a small ambient light.
void add_default_lights(Scene& scene, const Camera& camera);

/// Returns a neutral photo studio as an environment: a large soft light from the front left, a dim
/// one from the right, two strips behind that outline the model, and a panel above, in a gray room.
/// It is generated, so that no file is needed, as a panorama of 512 x 256 texels. Its irradiance
/// from the front is about that of the default lights. Surfaces scatter its light; it is not
/// visible as a background.
Environment studio_environment();

/// Returns true if the environment has the image of studio_environment().
bool is_studio(const Environment& environment);

/// Sets studio_environment() if the scene has no environment, and a triangle has a material that
/// shows its surroundings: metallic-roughness that is metallic, coated or transmissive, and lit.
/// Such a material is nearly black without an environment.
///
/// \return the name of the first such material for messages ("material 'body'"); nothing if the
///         scene did not change
std::optional<std::string> add_default_environment(Scene& scene);

/// Computes a camera that sees every finite vertex of a scene, with a small margin. It is closer
/// than framed() of the scene's box, whose corners are mostly empty.
///
/// \param azimuth  radians from +z towards +x, to the position of the camera
/// \param elevation  radians above the horizon
/// \param aspect  width / height of the picture
/// \param distance_factor  multiplies the distance from the center of the scene's box
/// \return a valid camera. A scene without extent is seen from distance 1, multiplied by the factor
/// \throws InvalidInput as framed() of a box does, and if the factor is not positive and finite
Camera framed(const Scene& scene, float azimuth, float elevation, float vertical_fov, float aspect,
              float distance_factor = 1.0F);

/// Returns an orthographic camera with the position and the depth range of another camera. Its
/// height is the smallest that shows every finite vertex, with a small margin; 1 for a scene
/// without extent.
///
/// \param aspect  width / height of the picture, positive
Camera orthographic(const Scene& scene, Camera camera, float aspect);

/// Moves a camera along its line of sight: its distance from `target` is multiplied by `factor`.
/// The depth range moves along and still contains the same objects. The height of an orthographic
/// camera is multiplied instead.
Camera at_distance(Camera camera, const glm::vec3& target, float factor);

// Scenes whose objects are attached to nodes, and the animations of nodes: key frames, orbits,
// turntables.
//
// World space, right-handed, y up; radians and seconds. A pose depends on the time alone, not on
// earlier poses.

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
    /// The width and height of the picture that a scene file requests.
    std::optional<glm::ivec2> picture_size;
    /// True if the far plane must stay behind all moving meshes, because the file does not name
    /// one.
    bool camera_sees_all = false;
    /// All cameras of a glTF file. The scene's camera is the first one; see choose_camera().
    std::vector<FileCamera> cameras;
    std::size_t chosen_camera = 0;  ///< By choose_camera(), an index into `cameras`.
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

}  // namespace relief
