// SPDX-License-Identifier: Apache-2.0
/// \file
/// The values that draw calls upload: the uniforms of a draw by GLSL name, and the lights of a
/// scene. Tests: tests/shade/render/draw_values_test.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <tuple>

#include "effects/light_rows.h"
#include "gl/program.h"
#include "gl/resources.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene.h"

namespace relief::shade::detail {

/// 19 rows of 8 vectors.
using SheenRows = std::array<glm::vec4, 152>;

/// The rows of sheens whose roughness a texture multiplies, by that roughness: a table costs as
/// much as 20 of one roughness.
class SheenCache {
  public:
    std::shared_ptr<const SheenRows> get(float roughness);
    void drop_unused();

  private:
    std::map<float, std::shared_ptr<const SheenRows>> rows_;
};

/// The uniforms of the surface shaders; each member but `model` has the name of its uniform.
struct DrawValues {
    glm::mat4 clip_from_object{1.0F};
    glm::mat4 world_from_object{1.0F};
    glm::mat3 world_from_object_normal{1.0F};   ///< Inverse transpose, times a positive number.
    glm::mat3 world_from_object_tangent{1.0F};  ///< The matrix itself, times a positive number.
    float handedness = 1.0F;                    ///< -1 if the matrix mirrors, else 1.
    glm::vec4 eye_world{0.0F};                  ///< Homogeneous: see inputs.glsl#eye.
    int joint_pairs = 0;                        ///< As in GpuPose; see vertex.glsl#skinning.
    glm::ivec3 morph_layout{0};                 ///< As in GpuPose; see vertex.glsl#morphing.

    glm::vec3 ambient_scattered{0.0F};  ///< For metallic-roughness, the ambient light itself.
    glm::vec3 diffuse_color{0.0F};
    glm::vec3 specular_gain{0.0F};   ///< The increase towards grazing angles.
    glm::vec3 specular_color{0.0F};  ///< With the normalization of the model.
    float shininess = 0.0F;
    glm::vec3 emission_color{0.0F};
    /// The factors of glTF's model. The uniform of each has its name (fields_of), unless another
    /// member does.
    MetallicRoughness model;
    glm::vec3 dielectric_color{0.04F};  ///< Reflectance at normal incidence, without weight.
    float dielectric_weight = 1.0F;
    float energy_compensation = 0.0F;  ///< 1 if the material compensates_energy().
    float sheen_alpha = 1.0F;
    std::array<glm::vec4, 8> sheen_albedo{};  ///< sheen_albedo_table().
    glm::vec3 clearcoat_normal_scale{1.0F};   ///< normal = texel * scale + bias.
    glm::vec3 clearcoat_normal_bias{0.0F};
    glm::vec2 anisotropy_direction{1.0F, 0.0F};  ///< In the tangent frame; unit.
    glm::mat4 clip_from_world{1.0F};
    float object_scale = 1.0F;  ///< The cube root of the determinant of world_from_object.
    glm::vec3 absorption{0.0F};
    float volume_index_ratio = 1.0F;
    float blurred_level = 0.0F;  ///< Of the picture behind, for roughness 1.
    glm::vec3 background_radiance{0.0F};
    float occlusion_strength = 0.0F;
    float opacity = 1.0F;
    float alpha_cutoff = 0.0F;

    glm::vec3 reflectivity{0.0F};
    glm::vec3 grazing_reflectivity{0.0F};
    float refractive_index = 1.0F;
    float refraction_ratio = 1.0F;
    glm::vec3 conductor_index{1.0F};
    glm::vec3 conductor_absorption{0.0F};
    float reflection_roughness = 0.0F;
    float transmission = 0.0F;
    float environment_intensity = 0.0F;
    glm::vec2 environment_turn{1.0F, 0.0F};  ///< The cosine and the sine of its rotation.
    float blurred_levels = 0.0F;
    std::array<glm::vec4, 9> irradiance_sh{};  ///< Times the intensity of the environment.

    glm::vec3 normal_map_scale{1.0F};  ///< normal = texel * scale + bias.
    glm::vec3 normal_map_bias{0.0F};
    glm::vec3 normal_map_unscale{1.0F};
    float normal_map_rounding = 0.0F;
    float bump_strength = 0.0F;
    float height_depth = 0.0F;  ///< In texels; the other members are numbers of ReliefMap.
    float height_layers = 1.0F;
    float height_bisections = 0.0F;
    float height_steps = 1.0F;

    float exposure = 1.0F;

    // These values describe the shadow maps (ShadowView). If there are no samples, nothing is in
    // shadow.
    glm::mat4 shadow_from_object{1.0F};  ///< To places in the maps.
    glm::mat4 shadow_from_world{1.0F};
    glm::mat4 shadow_lift{0.0F};  ///< From the normal to the lift of a place.
    glm::vec2 shadow_shift{0.0F};
    int shadow_samples = 0;
    std::array<glm::vec4, shadow_point_count / 2> shadow_points{};
    float sheen_roughness = 1.0F;
    /// sheen_albedo_tables() without the last; null unless a texture has the roughness.
    std::shared_ptr<const SheenRows> sheen_albedo_rows;
};

/// Sets the uniform `name` of the current program. \return false if there is no such value
bool set_uniform(const gl::LinkedProgram& program, std::string_view name, const DrawValues& values);

/// Sets the values of a material and of the scene's light, except for those of environment maps.
///
/// \param last_level  of the picture behind transmissive surfaces
void set_material(DrawValues& values, const Material& material, const Scene& scene, int last_level);

/// Returns the cosine and the sine of the rotation of an environment.
glm::vec2 environment_turn(const Environment& environment);

/// Sets the values of the shadow maps for an instance; nothing is in shadow without a view.
void set_shadow(DrawValues& values, const std::optional<ShadowView>& view,
                const glm::mat4& world_from_object);

/// Returns true if a matrix mirrors: it turns counter-clockwise triangles into clockwise ones.
bool mirrors(const glm::mat4& world_from_object);

/// Sets the values of an instance's matrix, except for clip_from_object and clip_from_world.
///
/// The normal matrix is the cofactor matrix, which is the inverse transpose times the determinant
/// and also exists for singular matrices: if a matrix flattens to a plane, normals become
/// perpendicular to it. A matrix of lower rank draws nothing.
void set_place(DrawValues& values, const glm::mat4& world_from_object);

/// Sets the decoding of a normal map of 8, 16 or 32 (float) bits (normal_map.h): scale and bias,
/// which include the green direction and the material's scale of x and y; the inverse of that
/// scale; and the rounding error of the length of a unit vector.
void set_normal_map(DrawValues& values, const NormalMap& map, int bits, FlatCode flat);

/// Returns the perspective projection of a camera to OpenGL's clip space. \param aspect  width /
/// height
glm::dmat4 clip_from_world(const Camera& camera, double aspect);

/// The lights of a scene on the GPU: a uniform block, or a buffer texture if there are too many
/// lights. There is one buffer for each light layout; only forced plans have several.
class LightStorage {
  public:
    /// Uploads the lights for these features on their first use. \throws GpuError
    void add(const gl::Api& api, const Scene& scene, const Features& features);

    /// Uploads the lights of the same scene at another time. \throws GpuError
    void update(const gl::Api& api, const Scene& scene);

    /// Binds the lights for the program of these features.
    void bind(const gl::Api& api, const Features& features) const;

  private:
    struct Lights {
        Features features;
        gl::Buffer rows;
        gl::Texture texture;  ///< Only for lights in a buffer.
    };
    using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, bool, bool>;
    static Key key(const Features& features);

    std::map<Key, Lights> lights_;
};

}  // namespace relief::shade::detail
