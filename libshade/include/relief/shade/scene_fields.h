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
inline constexpr auto enum_names<shade::ToneMapping> = std::to_array<EnumName<shade::ToneMapping>>(
    {{"none", shade::ToneMapping::none},
     {"reinhard", shade::ToneMapping::reinhard},
     {"aces", shade::ToneMapping::aces, "ACES (Narkowicz)"},
     {"khronos_neutral", shade::ToneMapping::khronos_neutral, "Khronos PBR Neutral"},
     {"aces_hill", shade::ToneMapping::aces_hill, "ACES Filmic (Hill)"},
     {"aces_hill_boost", shade::ToneMapping::aces_hill_boost,
      "ACES Filmic (Hill, exposure boost)"}});
template <>
inline constexpr auto enum_names<shade::Falloff> = std::to_array<EnumName<shade::Falloff>>(
    {{"inverse_square", shade::Falloff::inverse_square}, {"none", shade::Falloff::none}});

template <>
inline constexpr auto fields_of<shade::DirectionalLight> = std::tuple{
    SceneField{
        "direction", &shade::DirectionalLight::direction_world, {}, FieldUnit::world_direction},
    SceneField{"color",
               &shade::DirectionalLight::irradiance,
               {0, shade::max_light},
               FieldUnit::color,
               "irradiance"},
    SceneField{"specular",
               &shade::DirectionalLight::highlight_irradiance,
               {0, shade::max_light},
               FieldUnit::color,
               "highlight irradiance"},
    SceneField{
        "ambient", &shade::DirectionalLight::ambient, {0, shade::max_light}, FieldUnit::color},
    SceneField{"on", &shade::DirectionalLight::on}};

template <>
inline constexpr auto fields_of<shade::PointLight> = std::tuple{
    SceneField{"position", &shade::PointLight::position_world, {}, FieldUnit::world_position},
    SceneField{"color",
               &shade::PointLight::intensity,
               {0, shade::max_light},
               FieldUnit::color,
               "intensity"},
    SceneField{"specular",
               &shade::PointLight::highlight_intensity,
               {0, shade::max_light},
               FieldUnit::color,
               "highlight intensity"},
    SceneField{"falloff", &shade::PointLight::falloff},
    SceneField{"range", &shade::PointLight::range, positive_range, FieldUnit::world_length},
    SceneField{"ambient", &shade::PointLight::ambient, {0, shade::max_light}, FieldUnit::color},
    SceneField{"on", &shade::PointLight::on}};

namespace shade {

inline constexpr SceneField outer_cone_field{
    "outer_cone", &SpotLight::outer_cone, {0, std::numbers::pi_v<float> / 2}, FieldUnit::radians};

}  // namespace shade

/// The inner cone must also be smaller than the outer one.
template <>
inline constexpr auto fields_of<shade::SpotLight> = std::tuple{
    SceneField{"direction", &shade::SpotLight::direction_world, {}, FieldUnit::world_direction},
    SceneField{"inner_cone",
               &shade::SpotLight::inner_cone,
               {0, std::numbers::pi_v<float> / 2},
               FieldUnit::radians},
    shade::outer_cone_field, SceneField{"", &shade::SpotLight::point}};

/// Its images are not among the fields.
template <>
inline constexpr auto fields_of<shade::Environment> = std::tuple{
    SceneField{"intensity",
               &shade::Environment::intensity,
               {0, max_reflectance},
               {},
               "environment intensity"},
    SceneField{"skybox", &shade::Environment::skybox},
    SceneField{"skybox_blur", &shade::Environment::skybox_blur, {0, 1}, {}, "background blur"},
    SceneField{"lights", &shade::Environment::lights},
    SceneField{
        "rotation", &shade::Environment::rotation, {}, FieldUnit::radians, "environment rotation"}
        .on_slider({-std::numbers::pi_v<float>, std::numbers::pi_v<float>})};

/// The field of view lies between 0 and pi, without either; 0 < near < far.
template <>
inline constexpr auto fields_of<shade::Camera> =
    std::tuple{SceneField{"fov",
                          &shade::Camera::vertical_fov,
                          {0, std::numbers::pi_v<float>},
                          FieldUnit::radians,
                          "vertical field of view"},
               SceneField{"near", &shade::Camera::near, {}, FieldUnit::world_length},
               SceneField{"far", &shade::Camera::far, {}, FieldUnit::world_length},
               SceneField{"orthographic_height", &shade::Camera::orthographic_height,
                          positive_range, FieldUnit::world_length}};

template <>
inline constexpr auto fields_of<shade::Shadow> =
    std::tuple{SceneField{"size",
                          &shade::Shadow::size,
                          {0, std::numbers::pi_v<float> / 6},
                          FieldUnit::radians,
                          "shadow size"}};

template <>
inline constexpr auto fields_of<shade::AmbientOcclusion> = std::tuple{SceneField{
    "distance", &shade::AmbientOcclusion::distance, {0, 100}, {}, "ambient occlusion distance"}};

namespace shade {

inline constexpr SceneField ambient_field{
    "ambient", &Scene::ambient, {0, max_light}, FieldUnit::color, "ambient light"};

}  // namespace shade

/// The fields of the scene as a whole.
template <>
inline constexpr auto fields_of<shade::Scene> = std::tuple{
    shade::ambient_field,
    SceneField{"environment", &shade::Scene::environment},
    SceneField{"background", &shade::Scene::background, {0, shade::max_light}, FieldUnit::color},
    SceneField{"exposure", &shade::Scene::exposure, {0, max_reflectance}},
    SceneField{"tone_mapping", &shade::Scene::tone_mapping},
    SceneField{"shadow", &shade::Scene::shadow},
    SceneField{"ambient_occlusion", &shade::Scene::ambient_occlusion},
    SceneField{"clamp_terms", &shade::Scene::clamp_terms}};

template <>
inline constexpr auto fields_of<shade::Orbit> = std::tuple{
    SceneField{"center", &shade::Orbit::center, {}, FieldUnit::world_position},
    SceneField{"radius",
               &shade::Orbit::radius,
               {0, std::numeric_limits<float>::max()},
               FieldUnit::world_length},
    SceneField{"azimuth", &shade::Orbit::azimuth, {}, FieldUnit::radians},
    SceneField{"elevation", &shade::Orbit::elevation, {}, FieldUnit::radians},
    SceneField{"azimuth_speed", &shade::Orbit::azimuth_speed, {}, FieldUnit::radians_per_second},
    SceneField{
        "elevation_speed", &shade::Orbit::elevation_speed, {}, FieldUnit::radians_per_second},
    SceneField{"faces_center", &shade::Orbit::faces_center}};

template <>
inline constexpr auto fields_of<shade::Turntable> =
    std::tuple{SceneField{"axis", &shade::Turntable::axis, {}, FieldUnit::world_direction},
               SceneField{"speed", &shade::Turntable::speed, {}, FieldUnit::radians_per_second},
               SceneField{"angle", &shade::Turntable::angle, {}, FieldUnit::radians}};
}  // namespace relief
