// SPDX-License-Identifier: Apache-2.0
/// \file
/// The numbers that a draw's shaders take, by their GLSL names: the one home of each uniform.
/// Tests: tests/shade/render/draw_values_test.cpp.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string_view>

#include "gl/program.h"
#include "relief/shade/scene.h"

namespace relief {

/// One member for each uniform of shaders/surface.*.glsl and what they include, of the same name.
struct DrawValues {
    glm::mat4 clip_from_object{1.0F};
    glm::mat4 world_from_object{1.0F};
    glm::mat3 world_from_object_normal{1.0F};   ///< Inverse transpose, times a positive number.
    glm::mat3 world_from_object_tangent{1.0F};  ///< The matrix itself, times a positive number.
    float handedness = 1.0F;                    ///< -1 if the matrix mirrors, else 1.
    glm::vec3 eye_world{0.0F};

    glm::vec3 ambient_scattered{0.0F};  ///< Metallic-roughness: the scene's, unscattered.
    glm::vec3 diffuse_color{0.0F};
    glm::vec3 specular_color{0.0F};  ///< With the model's normalisation.
    float shininess = 0.0F;
    glm::vec3 emission_color{0.0F};
    glm::vec3 base_color{0.0F};
    float metallic = 0.0F;
    float roughness = 1.0F;
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
    float blurred_levels = 0.0F;
    std::array<glm::vec4, 9> irradiance_sh{};  ///< With the environment's intensity.

    glm::vec3 normal_map_scale{1.0F};  ///< normal = texel * scale + bias.
    glm::vec3 normal_map_bias{0.0F};
    glm::vec3 normal_map_unscale{1.0F};
    float normal_map_rounding = 0.0F;
    float bump_strength = 0.0F;

    float exposure = 1.0F;
};

/// Sets the uniform `name` of the current program. False if no value has that name.
bool set_uniform(const gl::LinkedProgram& program, std::string_view name, const DrawValues& values);

/// The values that a material and a scene's light decide; the environment's are made elsewhere.
void set_material(DrawValues& values, const Material& material, const Scene& scene);

/// The values that an instance's place decides, but for clip_from_object.
///
/// The normal matrix is the matrix of cofactors, which is the inverse transpose times the
/// determinant and exists for singular matrices too: for one that flattens, it turns normals
/// perpendicular to the plane. A matrix that leaves less than a plane draws nothing.
void set_place(DrawValues& values, const glm::mat4& world_from_object);

/// How a map of this many bits (8, 16; 32 is float) is read, as normal_map.h says: scale and bias
/// with the green direction and the material's scale of x and y in them, how to take that scale
/// out again, and how far rounding may make a unit vector shorter.
void set_normal_map(DrawValues& values, const NormalMap& map, int bits, FlatCode flat);

/// The camera's perspective, OpenGL's clip space. \param aspect  width / height
glm::dmat4 clip_from_world(const Camera& camera, double aspect);

}  // namespace relief
