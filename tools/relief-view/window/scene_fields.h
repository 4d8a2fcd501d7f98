// SPDX-License-Identifier: Apache-2.0
/// \file
/// What can be edited in a scene, as lists of members: those that kept_edits.h carries over.
/// Tests: tests/tools/window/kept_edits_test.cpp.
#pragma once

#include <tuple>

#include "relief/shade/scene.h"

namespace relief::tools {

/// The members of T, as a tuple of pointers to them; a T without a list is one value.
template <typename T>
inline constexpr auto fields_of = std::tuple<>{};

template <>
inline constexpr auto fields_of<Texture> =
    std::tuple{&Texture::wrap_u, &Texture::wrap_v, &Texture::filter};

template <>
inline constexpr auto fields_of<NormalMap> = std::tuple{
    &NormalMap::texture, &NormalMap::scale, &NormalMap::green, &NormalMap::flat, &NormalMap::space};

template <>
inline constexpr auto fields_of<BumpMap> = std::tuple{&BumpMap::texture, &BumpMap::strength};

template <>
inline constexpr auto fields_of<MetallicRoughness> =
    std::tuple{&MetallicRoughness::base_color, &MetallicRoughness::metallic,
               &MetallicRoughness::roughness, &MetallicRoughness::texture};

template <>
inline constexpr auto fields_of<Material> = std::tuple{&Material::interpolation,
                                                       &Material::ambient,
                                                       &Material::diffuse,
                                                       &Material::specular,
                                                       &Material::emission,
                                                       &Material::shininess,
                                                       &Material::specular_model,
                                                       &Material::metallic_roughness,
                                                       &Material::reflectivity,
                                                       &Material::grazing_reflectivity,
                                                       &Material::fresnel,
                                                       &Material::refractive_index,
                                                       &Material::conductor_index,
                                                       &Material::conductor_absorption,
                                                       &Material::reflection_roughness,
                                                       &Material::transmission,
                                                       &Material::diffuse_texture,
                                                       &Material::specular_texture,
                                                       &Material::emission_texture,
                                                       &Material::occlusion_texture,
                                                       &Material::occlusion_strength,
                                                       &Material::opacity_texture,
                                                       &Material::normal_map,
                                                       &Material::bump_map,
                                                       &Material::tangent_frame,
                                                       &Material::specular_antialiasing,
                                                       &Material::alpha_mode,
                                                       &Material::opacity,
                                                       &Material::alpha_cutoff,
                                                       &Material::double_sided,
                                                       &Material::unlit};

template <>
inline constexpr auto fields_of<DirectionalLight> =
    std::tuple{&DirectionalLight::direction_world, &DirectionalLight::irradiance,
               &DirectionalLight::highlight_irradiance};

template <>
inline constexpr auto fields_of<PointLight> =
    std::tuple{&PointLight::position_world, &PointLight::intensity, &PointLight::range,
               &PointLight::falloff, &PointLight::highlight_intensity};

template <>
inline constexpr auto fields_of<SpotLight> = std::tuple{
    &SpotLight::point, &SpotLight::direction_world, &SpotLight::inner_cone, &SpotLight::outer_cone};

/// Its images come with the options.
template <>
inline constexpr auto fields_of<Environment> =
    std::tuple{&Environment::intensity, &Environment::skybox, &Environment::lights};

/// Those of the scene as a whole.
template <>
inline constexpr auto fields_of<Scene> =
    std::tuple{&Scene::ambient, &Scene::environment, &Scene::background, &Scene::exposure,
               &Scene::tone_mapping};

}  // namespace relief::tools
