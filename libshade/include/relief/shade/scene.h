// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines scenes as plain data: instances of meshes, materials, lights, a camera, an environment
/// and how the picture is exposed; adds default lights and a default environment. No OpenGL.
///
/// World space is right-handed, y up. Colors are linear. Angles are radians. Images are named here
/// and decoded only if the effect plan (effects.h) needs them. scene_fields.h has the name and
/// range of every field.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/mesh.h"
#include "relief/shade/camera.h"
#include "relief/shade/environment.h"
#include "relief/shade/image_source.h"
#include "relief/shade/lights.h"
#include "relief/shade/material.h"
#include "relief/shade/shared.h"

namespace RELIEF_API relief {
namespace shade {

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

/// Checks every index and number that drawing relies on: indices exist, numbers are finite and
/// within the ranges of scene_fields.h, directions have a length, the inner cones of spots are
/// smaller than the outer ones, the camera has a depth range, meshes are valid. Vertex data may
/// hold any value, NaN included; matrices may be singular. \throws InvalidInput naming the first
/// error
void validate(const Scene& scene);

/// Checks only what animations move: instances and lights. Meshes are skipped, so the cost is
/// negligible beside a frame.
void validate_transforms(const Scene& scene);

/// Adds the default material to the list and assigns it to every triangle without a material, so
/// that it can be edited. Meshes that change are copied.
void name_default_material(Scene& scene);

/// Returns true if a triangle has no material.
bool uses_default_material(const Scene& scene);

/// #1e2126, linear, opaque.
inline constexpr glm::vec4 default_background{0.01299F, 0.01521F, 0.01938F, 1.0F};

/// Adds a warm key light from the upper left of the viewer, at an angle that shows relief, and a
/// dim cool light from the right, and sets a small ambient light.
void add_default_lights(Scene& scene, const Camera& camera);

/// Sets studio_environment() if the scene has no environment, and a triangle has a material that
/// shows its surroundings: metallic-roughness that is metallic, coated or transmissive, and lit.
/// Such a material is nearly black without an environment.
///
/// \return the name of the first such material for messages ("material 'body'"); nothing if the
///         scene did not change
std::optional<std::string> add_default_environment(Scene& scene);

}  // namespace shade
}  // namespace relief
