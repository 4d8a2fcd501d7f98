// SPDX-License-Identifier: Apache-2.0
/// \file
/// Describes every field of a scene that a file, a panel or an option can set: name, range, unit
/// and label. Scene files are read, written and validated by these descriptions, and the window
/// finds edits by them. The default of a field is that of its struct: default_value().
#pragma once

#include <array>
#include <limits>
#include <numbers>
#include <tuple>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/fields.h"
#include "relief/mesh/material.h"
#include "relief/shade/scene.h"
#include "relief/shade/scene_graph.h"

namespace RELIEF_API relief {

template <>
inline constexpr auto enum_names<ToneMapping> = std::to_array<EnumName<ToneMapping>>(
    {{"none", ToneMapping::none},
     {"reinhard", ToneMapping::reinhard},
     {"aces", ToneMapping::aces, "ACES (Narkowicz)"},
     {"khronos_neutral", ToneMapping::khronos_neutral, "Khronos PBR Neutral"},
     {"aces_hill", ToneMapping::aces_hill, "ACES Filmic (Hill)"},
     {"aces_hill_boost", ToneMapping::aces_hill_boost, "ACES Filmic (Hill, exposure boost)"}});
template <>
inline constexpr auto enum_names<Falloff> = std::to_array<EnumName<Falloff>>(
    {{"inverse_square", Falloff::inverse_square}, {"none", Falloff::none}});

template <>
inline constexpr auto fields_of<DirectionalLight> = std::tuple{
    SceneField{"direction", &DirectionalLight::direction_world, {}, FieldUnit::world_direction},
    SceneField{
        "color", &DirectionalLight::irradiance, {0, max_light}, FieldUnit::color, "irradiance"},
    SceneField{"specular",
               &DirectionalLight::highlight_irradiance,
               {0, max_light},
               FieldUnit::color,
               "highlight irradiance"},
    SceneField{"ambient", &DirectionalLight::ambient, {0, max_light}, FieldUnit::color},
    SceneField{"on", &DirectionalLight::on}};

template <>
inline constexpr auto fields_of<PointLight> = std::tuple{
    SceneField{"position", &PointLight::position_world, {}, FieldUnit::world_position},
    SceneField{"color", &PointLight::intensity, {0, max_light}, FieldUnit::color, "intensity"},
    SceneField{"specular",
               &PointLight::highlight_intensity,
               {0, max_light},
               FieldUnit::color,
               "highlight intensity"},
    SceneField{"falloff", &PointLight::falloff},
    SceneField{"range", &PointLight::range, positive_range, FieldUnit::world_length},
    SceneField{"ambient", &PointLight::ambient, {0, max_light}, FieldUnit::color},
    SceneField{"on", &PointLight::on}};

inline constexpr SceneField outer_cone_field{
    "outer_cone", &SpotLight::outer_cone, {0, std::numbers::pi_v<float> / 2}, FieldUnit::radians};

/// The inner cone must also be smaller than the outer one.
template <>
inline constexpr auto fields_of<SpotLight> =
    std::tuple{SceneField{"direction", &SpotLight::direction_world, {}, FieldUnit::world_direction},
               SceneField{"inner_cone",
                          &SpotLight::inner_cone,
                          {0, std::numbers::pi_v<float> / 2},
                          FieldUnit::radians},
               outer_cone_field, SceneField{"", &SpotLight::point}};

/// Its images are not among the fields.
template <>
inline constexpr auto fields_of<Environment> = std::tuple{
    SceneField{
        "intensity", &Environment::intensity, {0, max_reflectance}, {}, "environment intensity"},
    SceneField{"skybox", &Environment::skybox},
    SceneField{"skybox_blur", &Environment::skybox_blur, {0, 1}, {}, "background blur"},
    SceneField{"lights", &Environment::lights},
    SceneField{"rotation", &Environment::rotation, {}, FieldUnit::radians, "environment rotation"}
        .on_slider({-std::numbers::pi_v<float>, std::numbers::pi_v<float>})};

/// The field of view lies between 0 and pi, without either; 0 < near < far.
template <>
inline constexpr auto fields_of<Camera> =
    std::tuple{SceneField{"fov",
                          &Camera::vertical_fov,
                          {0, std::numbers::pi_v<float>},
                          FieldUnit::radians,
                          "vertical field of view"},
               SceneField{"near", &Camera::near, {}, FieldUnit::world_length},
               SceneField{"far", &Camera::far, {}, FieldUnit::world_length},
               SceneField{"orthographic_height", &Camera::orthographic_height, positive_range,
                          FieldUnit::world_length}};

template <>
inline constexpr auto fields_of<Shadow> = std::tuple{SceneField{
    "size", &Shadow::size, {0, std::numbers::pi_v<float> / 6}, FieldUnit::radians, "shadow size"}};

template <>
inline constexpr auto fields_of<AmbientOcclusion> = std::tuple{SceneField{
    "distance", &AmbientOcclusion::distance, {0, 100}, {}, "ambient occlusion distance"}};

inline constexpr SceneField ambient_field{
    "ambient", &Scene::ambient, {0, max_light}, FieldUnit::color, "ambient light"};

/// The fields of the scene as a whole.
template <>
inline constexpr auto fields_of<Scene> =
    std::tuple{ambient_field,
               SceneField{"environment", &Scene::environment},
               SceneField{"background", &Scene::background, {0, max_light}, FieldUnit::color},
               SceneField{"exposure", &Scene::exposure, {0, max_reflectance}},
               SceneField{"tone_mapping", &Scene::tone_mapping},
               SceneField{"shadow", &Scene::shadow},
               SceneField{"ambient_occlusion", &Scene::ambient_occlusion},
               SceneField{"clamp_terms", &Scene::clamp_terms}};

template <>
inline constexpr auto fields_of<Orbit> = std::tuple{
    SceneField{"center", &Orbit::center, {}, FieldUnit::world_position},
    SceneField{
        "radius", &Orbit::radius, {0, std::numeric_limits<float>::max()}, FieldUnit::world_length},
    SceneField{"azimuth", &Orbit::azimuth, {}, FieldUnit::radians},
    SceneField{"elevation", &Orbit::elevation, {}, FieldUnit::radians},
    SceneField{"azimuth_speed", &Orbit::azimuth_speed, {}, FieldUnit::radians_per_second},
    SceneField{"elevation_speed", &Orbit::elevation_speed, {}, FieldUnit::radians_per_second},
    SceneField{"faces_center", &Orbit::faces_center}};

template <>
inline constexpr auto fields_of<Turntable> =
    std::tuple{SceneField{"axis", &Turntable::axis, {}, FieldUnit::world_direction},
               SceneField{"speed", &Turntable::speed, {}, FieldUnit::radians_per_second},
               SceneField{"angle", &Turntable::angle, {}, FieldUnit::radians}};

}  // namespace relief
