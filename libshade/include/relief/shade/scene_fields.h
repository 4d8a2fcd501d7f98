// SPDX-License-Identifier: Apache-2.0
/// \file
/// Describes every field of a scene that a file, a panel or an option can set: name, range, unit
/// and label. Scene files are read, written and validated by these descriptions, and the window
/// finds edits by them. The default of a field is that of its struct: default_value().
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/shade/scene.h"

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
inline constexpr auto enum_names<Interpolation> = std::to_array<EnumName<Interpolation>>(
    {{"per_pixel", Interpolation::per_pixel},
     {"gouraud", Interpolation::gouraud, "Per vertex (Gouraud)"},
     {"flat", Interpolation::flat}});
template <>
inline constexpr auto enum_names<SpecularModel> = std::to_array<EnumName<SpecularModel>>(
    {{"phong", SpecularModel::phong},
     {"blinn_phong", SpecularModel::blinn_phong, "Blinn-Phong"},
     {"blinn_phong_normalized", SpecularModel::blinn_phong_normalized, "Blinn-Phong, normalized"}});
template <>
inline constexpr auto enum_names<FresnelModel> =
    std::to_array<EnumName<FresnelModel>>({{"schlick", FresnelModel::schlick},
                                           {"dielectric", FresnelModel::dielectric},
                                           {"conductor", FresnelModel::conductor}});
template <>
inline constexpr auto enum_names<TangentFrame> = std::to_array<EnumName<TangentFrame>>(
    {{"stored", TangentFrame::stored}, {"derivatives", TangentFrame::derivatives}});
template <>
inline constexpr auto enum_names<NormalSpace> = std::to_array<EnumName<NormalSpace>>(
    {{"tangent", NormalSpace::tangent}, {"object", NormalSpace::object}});
template <>
inline constexpr auto enum_names<TextureFilter> = std::to_array<EnumName<TextureFilter>>(
    {{"linear", TextureFilter::linear}, {"nearest", TextureFilter::nearest}});
template <>
inline constexpr auto enum_names<Falloff> = std::to_array<EnumName<Falloff>>(
    {{"inverse_square", Falloff::inverse_square}, {"none", Falloff::none}});

/// The limits of a number, or of every component of a color; both are allowed values.
struct FieldRange {
    float min = std::numeric_limits<float>::lowest();
    float max = std::numeric_limits<float>::max();

    friend constexpr bool operator==(const FieldRange&, const FieldRange&) = default;
};

/// The range of numbers that must be positive. Its minimum is the smallest value that a file may
/// name; in memory every positive value is valid.
inline constexpr FieldRange positive_range{1e-30F};

/// The unit of a number or vector.
enum class FieldUnit {
    none,   ///< A factor, an exponent, a flag, a name.
    color,  ///< Linear red, green and blue; with a fourth component: alpha, from 0 to 1.
    texels,
    world_length,
    world_position,
    world_direction,  ///< Any length but 0.
    radians,          ///< Degrees in files and on command lines.
    radians_per_second,
};

/// Replaces underscores by spaces.
inline std::string spaced(std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

/// Begins an English text with a capital letter.
inline std::string capitalized(std::string text) {
    if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
        text.front() = static_cast<char>(text.front() - 'a' + 'A');
    return text;
}

/// The names of an enumeration's values in panels, in the order of its table of names.
template <typename Enum>
std::vector<std::string> enum_labels() {
    std::vector<std::string> labels;
    for (const EnumName<Enum>& entry : enum_names<Enum>)
        labels.push_back(entry.label != nullptr ? entry.label : capitalized(spaced(entry.name)));
    return labels;
}

/// The description of one member of a struct.
template <typename Owner, typename Value>
struct SceneField {
    /// The key in scene files. If empty, the fields of the member are in the owner's own object.
    const char* name;
    Value Owner::*member;
    FieldRange range{};
    FieldUnit unit = FieldUnit::none;
    const char* label_text = nullptr;

    /// The name of the field in messages: label_text, or the name with spaces instead of
    /// underscores.
    [[nodiscard]] std::string label() const {
        return label_text != nullptr ? label_text : spaced(name);
    }
    /// The name of the field in panels: the label with a capital initial.
    [[nodiscard]] std::string title() const { return capitalized(label()); }
    [[nodiscard]] Value default_value() const { return Owner{}.*member; }
};
template <typename Owner, typename Value>
SceneField(const char*, Value Owner::*, FieldRange = {}, FieldUnit = {}, const char* = nullptr)
    -> SceneField<Owner, Value>;

/// The fields of T as a tuple of SceneField, in the order in which scene files are written. Empty
/// for a type that is one value.
template <typename T>
inline constexpr auto fields_of = std::tuple<>{};

template <typename T>
inline constexpr bool has_fields = std::tuple_size_v<std::decay_t<decltype(fields_of<T>)>> != 0;

template <typename T>
inline constexpr bool is_optional_value = false;
template <typename T>
inline constexpr bool is_optional_value<std::optional<T>> = true;

/// Calls visit(field) for every field of T, in order.
template <typename T, typename Visit>
constexpr void for_each_field(const Visit& visit) {
    std::apply([&](const auto&... fields) { (visit(fields), ...); }, fields_of<T>);
}

/// Its image is not among the fields: it has no meaning without its scene.
template <>
inline constexpr auto fields_of<Texture> =
    std::tuple{SceneField{"wrap_u", &Texture::wrap_u}, SceneField{"wrap_v", &Texture::wrap_v},
               SceneField{"filter", &Texture::filter},
               SceneField{"second_texcoords", &Texture::second_texcoords}};

template <>
inline constexpr auto fields_of<NormalMap> =
    std::tuple{SceneField{"texture", &NormalMap::texture, {}, {}, "normal map"},
               SceneField{"scale", &NormalMap::scale, {-1e6F, 1e6F}, {}, "normal map scale"},
               SceneField{"green", &NormalMap::green}, SceneField{"space", &NormalMap::space},
               SceneField{"zero_code", &NormalMap::flat}};

template <>
inline constexpr auto fields_of<BumpMap> = std::tuple{
    SceneField{"texture", &BumpMap::texture, {}, {}, "bump map"},
    SceneField{
        "strength", &BumpMap::strength, {-1e6F, 1e6F}, FieldUnit::texels, "bump map strength"}};

template <>
inline constexpr auto fields_of<MetallicRoughness> = std::tuple{
    SceneField{
        "base_color", &MetallicRoughness::base_color, {0, 1}, FieldUnit::color, "base color"},
    SceneField{"metallic", &MetallicRoughness::metallic, {0, 1}},
    SceneField{"roughness", &MetallicRoughness::roughness, {0, 1}},
    SceneField{"texture", &MetallicRoughness::texture, {}, {}, "metallic-roughness texture"},
    SceneField{"refractive_index", &MetallicRoughness::refractive_index, {0, 1e3F}},
    SceneField{"specular", &MetallicRoughness::specular, {0, 1}},
    SceneField{"specular_color",
               &MetallicRoughness::specular_color,
               {0, max_reflectance},
               FieldUnit::color},
    SceneField{"specular_texture", &MetallicRoughness::specular_texture},
    SceneField{"specular_color_texture", &MetallicRoughness::specular_color_texture},
    SceneField{"clearcoat", &MetallicRoughness::clearcoat, {0, 1}},
    SceneField{"clearcoat_roughness", &MetallicRoughness::clearcoat_roughness, {0, 1}},
    SceneField{"clearcoat_texture", &MetallicRoughness::clearcoat_texture},
    SceneField{"clearcoat_roughness_texture", &MetallicRoughness::clearcoat_roughness_texture},
    SceneField{"clearcoat_normal_map", &MetallicRoughness::clearcoat_normal_map},
    SceneField{"sheen_color", &MetallicRoughness::sheen_color, {0, 1}, FieldUnit::color},
    SceneField{"sheen_roughness", &MetallicRoughness::sheen_roughness, {0, 1}},
    SceneField{"sheen_color_texture", &MetallicRoughness::sheen_color_texture},
    SceneField{"sheen_roughness_texture", &MetallicRoughness::sheen_roughness_texture},
    SceneField{"anisotropy", &MetallicRoughness::anisotropy, {0, 1}},
    SceneField{
        "anisotropy_rotation", &MetallicRoughness::anisotropy_rotation, {}, FieldUnit::radians},
    SceneField{"anisotropy_texture", &MetallicRoughness::anisotropy_texture},
    SceneField{"iridescence", &MetallicRoughness::iridescence, {0, 1}},
    SceneField{"iridescence_index", &MetallicRoughness::iridescence_index, {1, 1e3F}},
    SceneField{"iridescence_thickness", &MetallicRoughness::iridescence_thickness, {0, 1e6F}},
    SceneField{"iridescence_thickness_minimum",
               &MetallicRoughness::iridescence_thickness_minimum,
               {0, 1e6F}},
    SceneField{"iridescence_texture", &MetallicRoughness::iridescence_texture},
    SceneField{"iridescence_thickness_texture", &MetallicRoughness::iridescence_thickness_texture},
    SceneField{"transmission", &MetallicRoughness::transmission, {0, 1}},
    SceneField{"transmission_texture", &MetallicRoughness::transmission_texture},
    SceneField{"thickness", &MetallicRoughness::thickness, {0, std::numeric_limits<float>::max()}},
    SceneField{"thickness_texture", &MetallicRoughness::thickness_texture},
    SceneField{"attenuation_distance", &MetallicRoughness::attenuation_distance, positive_range,
               FieldUnit::world_length},
    SceneField{
        "attenuation_color", &MetallicRoughness::attenuation_color, {0, 1}, FieldUnit::color}};

template <>
inline constexpr auto fields_of<Material> = std::tuple{
    SceneField{"name", &Material::name},
    SceneField{"interpolation", &Material::interpolation},
    SceneField{"ambient", &Material::ambient, {0, max_reflectance}, FieldUnit::color},
    SceneField{"diffuse", &Material::diffuse, {0, max_reflectance}, FieldUnit::color},
    SceneField{"specular", &Material::specular, {0, max_reflectance}, FieldUnit::color},
    SceneField{"emission", &Material::emission, {0, max_reflectance}, FieldUnit::color},
    SceneField{"shininess", &Material::shininess, {0, 1e6F}},
    SceneField{"specular_model", &Material::specular_model},
    SceneField{"highlight_fresnel", &Material::highlight_fresnel},
    SceneField{"metallic_roughness", &Material::metallic_roughness},
    SceneField{"reflectivity", &Material::reflectivity, {0, 1}, FieldUnit::color},
    SceneField{"grazing_reflectivity", &Material::grazing_reflectivity, {0, 1}, FieldUnit::color},
    SceneField{"fresnel", &Material::fresnel},
    SceneField{"refractive_index", &Material::refractive_index, {1, 1e3F}},
    SceneField{"conductor_index", &Material::conductor_index, {0, 1e3F}, FieldUnit::color},
    SceneField{
        "conductor_absorption", &Material::conductor_absorption, {0, 1e3F}, FieldUnit::color},
    SceneField{"reflection_roughness", &Material::reflection_roughness, {0, 1}},
    SceneField{"reflection_by_normal", &Material::reflection_by_normal},
    SceneField{"environment_tint", &Material::environment_tint},
    SceneField{"transmission", &Material::transmission, {0, 1}},
    SceneField{"diffuse_texture", &Material::diffuse_texture},
    SceneField{"specular_texture", &Material::specular_texture},
    SceneField{"emission_texture", &Material::emission_texture},
    SceneField{"occlusion_texture", &Material::occlusion_texture},
    SceneField{"occlusion_strength", &Material::occlusion_strength, {0, 1}},
    SceneField{"opacity_texture", &Material::opacity_texture},
    SceneField{"normal_map", &Material::normal_map},
    SceneField{"bump_map", &Material::bump_map},
    SceneField{"tangent_frame", &Material::tangent_frame},
    SceneField{"specular_antialiasing", &Material::specular_antialiasing},
    SceneField{"alpha_mode", &Material::alpha_mode},
    SceneField{"opacity", &Material::opacity, {0, 1}},
    SceneField{"alpha_cutoff", &Material::alpha_cutoff, {0, max_reflectance}},
    SceneField{"double_sided", &Material::double_sided},
    SceneField{"unlit", &Material::unlit}};

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
    SceneField{"rotation", &Environment::rotation, {}, FieldUnit::radians, "environment rotation"}};

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

/// Returns the description of a member that has one.
template <typename Owner, typename Value>
constexpr SceneField<Owner, Value> field_of(Value Owner::*member) {
    SceneField<Owner, Value> found{"", member};
    for_each_field<Owner>([&](const auto& field) {
        if constexpr (std::is_same_v<std::decay_t<decltype(field)>, SceneField<Owner, Value>>) {
            if (field.member == member) found = field;
        }
    });
    return found;
}

}  // namespace relief
