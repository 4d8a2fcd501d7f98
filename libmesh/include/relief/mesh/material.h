// SPDX-License-Identifier: Apache-2.0
/// \file
/// Defines materials as plain data, Phong's model and glTF's metallic-roughness model, with one
/// table of their textures and one of their factors.
///
/// Colors are linear. Reading and writing glTF and scene files, validation, animation, panels and
/// drawing derive from the tables. The formulas are in relief/shade/material.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "relief/export.h"
#include "relief/mesh/enum_names.h"
#include "relief/mesh/fields.h"
#include "relief/mesh/height_march.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/normal_map.h"

namespace RELIEF_API relief {

/// The maximum of a material's color components.
inline constexpr float max_reflectance = 1e9F;

enum class TextureFilter { linear, nearest };

/// An image as a texture.
struct Texture {
    std::size_t image = 0;  ///< Index into Scene::images, or GltfView::images.
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    TextureFilter filter = TextureFilter::linear;
    /// It is looked up at Mesh::texcoords_2. Maps in the tangent frame (normal and bump maps,
    /// anisotropy) ignore this.
    bool second_texcoords = false;
};

/// The meaning of alpha.
enum class AlphaMode {
    opaque,  ///< Alpha is ignored.
    mask,    ///< The surface exists where alpha is at least alpha_cutoff.
    blend,   ///< Alpha blends the surface over its background; drawn farthest first.
};

/// The place where light is computed.
enum class Interpolation {
    per_pixel,  ///< At every pixel, with the interpolated normal (Phong shading).
    gouraud,    ///< At the vertices, with interpolated colors. Phong materials only.
    flat,       ///< At every pixel, with the normal of the triangle's plane.
};

enum class SpecularModel {
    phong,                   ///< (reflect . view)^shininess
    blinn_phong,             ///< (half . normal)^shininess
    blinn_phong_normalized,  ///< blinn_phong times (shininess + 2) / 8.
};

/// The reflectance of a surface as a function of the angle.
enum class FresnelModel {
    schlick,     ///< From reflectivity to grazing_reflectivity; equal values: no Fresnel effect.
    dielectric,  ///< Exact, unpolarized, from refractive_index; times reflectivity.
    conductor,   ///< Exact, unpolarized, from conductor_index and conductor_absorption; times
                 ///< reflectivity.
};

/// The source of the frame of a tangent-space map.
enum class TangentFrame {
    stored,       ///< The tangents of the mesh; MikkTSpace's if it has none.
    derivatives,  ///< The derivatives of position and texture coordinates between pixels.
};

/// The space of a normal map's vectors.
enum class NormalSpace { tangent, object };

/// A normal map and its conventions (normal_map.h).
struct NormalMap {
    Texture texture;
    float scale = 1.0F;  ///< Multiplies x and y before normalization; in tangent space only.
    Green green = Green::up;
    /// If absent, detect_flat_code decides from the image.
    std::optional<FlatCode> flat = std::nullopt;
    NormalSpace space = NormalSpace::tangent;
};

/// Heights that perturb the normal in the shader, by central differences over one texel, or over
/// one pixel if it is larger.
struct BumpMap {
    Texture texture;         ///< Red is the height.
    float strength = 16.0F;  ///< The height in texels of the value 1.0.
};

/// How a relief ends where the view leaves its height map.
enum class ReliefSilhouette {
    none,   ///< The map continues by its wrap modes.
    clip,   ///< Nothing is drawn beyond [0,1] along axes that are clamped.
    curve,  ///< As clip; and the relief curves with the surface, at whose outline it ends.
};

/// Heights that show a surface's textures displaced along the view: relief mapping. Normals come
/// from the normal or bump map, which may be the same image. The relief lies below the surface of
/// white and in the tangent plane of the interpolated normal, unless it curves with the surface.
struct ReliefMap {
    Texture texture;      ///< Red is the height; white is at the surface.
    float depth = 16.0F;  ///< Of black below white, in texels: the square root of a texel's area.
    // The members of HeightMarch (height_march.h).
    HeightMethod method = HeightMarch{}.method;
    int layers = HeightMarch{}.layers;
    int bisections = HeightMarch{}.bisections;
    int max_steps = HeightMarch{}.max_steps;
    /// The cone map of two channels, which relaxed cones need. The second one is the root of the
    /// ratio of a cone's radius to its height: fractions of the map's larger side and the depth.
    std::optional<Texture> cones = std::nullopt;
    bool self_shadow = false;  ///< The relief hides light from its own points.
    ReliefSilhouette silhouette = ReliefSilhouette::none;
    /// The depth buffer gets the depth of the relief, so that other surfaces meet it where it is
    /// seen.
    bool write_depth = false;
    /// Effects of the relief are planned from this bound on, in pixels, where there is one camera.
    /// From 0, which plans them for every relief that has a depth.
    float bound = 0.5F;
};

/// glTF's metallic-roughness model. In a Material it replaces Phong's ambient, diffuse, specular,
/// shininess and reflectivity; Material::diffuse_texture and vertex colors multiply base_color.
struct MetallicRoughness {
    glm::vec3 base_color{1.0F};
    float metallic = 1.0F;
    float roughness = 1.0F;
    std::optional<Texture> texture;  ///< Green multiplies roughness, blue metallic.
    // The reflection of the dielectric share (KHR_materials_ior, KHR_materials_specular).
    float refractive_index = 1.5F;                    ///< 0 counts as infinite.
    float specular = 1.0F;                            ///< The weight of the reflection.
    glm::vec3 specular_color{1.0F};                   ///< Tints the reflection at normal incidence.
    std::optional<Texture> specular_texture{};        ///< Alpha multiplies specular.
    std::optional<Texture> specular_color_texture{};  ///< sRGB color.
    // A clear layer on top (KHR_materials_clearcoat), which only a normal map of its own bends.
    float clearcoat = 0.0F;  ///< Its weight; 0: none.
    float clearcoat_roughness = 0.0F;
    std::optional<Texture> clearcoat_texture{};            ///< Red multiplies clearcoat.
    std::optional<Texture> clearcoat_roughness_texture{};  ///< Green multiplies its roughness.
    std::optional<NormalMap> clearcoat_normal_map{};       ///< In tangent space.
    // Fibers on top of the surface, under the coat (KHR_materials_sheen).
    glm::vec3 sheen_color{0.0F};  ///< Zero: none.
    float sheen_roughness = 0.0F;
    std::optional<Texture> sheen_color_texture{};      ///< sRGB color.
    std::optional<Texture> sheen_roughness_texture{};  ///< Alpha multiplies sheen_roughness.
    // Facets that are rougher along a direction in the tangent frame, as on brushed metal
    // (KHR_materials_anisotropy).
    float anisotropy = 0.0F;           ///< 0: the same roughness in all directions.
    float anisotropy_rotation = 0.0F;  ///< Radians from the tangent to the bitangent.
    /// The direction before the rotation, in red and green, where 0.5 is 0; the tangent if it has
    /// no length. Blue multiplies anisotropy.
    std::optional<Texture> anisotropy_texture{};
    // A thin film, whose two surfaces interfere (KHR_materials_iridescence).
    float iridescence = 0.0F;                                ///< Its weight; 0: none.
    float iridescence_index = 1.3F;                          ///< The film's refractive index.
    float iridescence_thickness = 400.0F;                    ///< In nanometers.
    float iridescence_thickness_minimum = 100.0F;            ///< Where the thickness texture is 0.
    std::optional<Texture> iridescence_texture{};            ///< Red multiplies iridescence.
    std::optional<Texture> iridescence_thickness_texture{};  ///< Green: from minimum to thickness.
    // What lies behind shows through the surface (KHR_materials_transmission), which may enclose a
    // volume that refracts and absorbs light (KHR_materials_volume).
    float transmission = 0.0F;  ///< The share of the light that passes instead of being scattered.
    std::optional<Texture> transmission_texture{};  ///< Red multiplies transmission.
    float thickness = 0.0F;  ///< Of the volume, in object space; 0: a thin sheet.
    std::optional<Texture> thickness_texture{};  ///< Green multiplies thickness.
    /// The distance in world space after which white light has attenuation_color; if absent, the
    /// volume is clear.
    std::optional<float> attenuation_distance = std::nullopt;
    glm::vec3 attenuation_color{1.0F};
    /// 20 over the Abbe number of the volume, whose index refractive_index is that of green
    /// (KHR_materials_dispersion); 0: all colors take one path.
    float dispersion = 0.0F;
};

/// A material. relief/shade/material.h has the formula of its light.
struct Material {
    std::string name;
    Interpolation interpolation = Interpolation::per_pixel;
    glm::vec3 ambient{0.8F};  ///< The scattered share of ambient light.
    glm::vec3 diffuse{0.8F};
    glm::vec3 specular{0.0F};
    glm::vec3 emission{0.0F};
    float shininess = 32.0F;  ///< 0 to 1e6.
    SpecularModel specular_model = SpecularModel::blinn_phong;
    bool highlight_fresnel = false;  ///< Highlights become brighter at grazing angles.
    std::optional<MetallicRoughness> metallic_roughness;

    glm::vec3 reflectivity{0.0F};  ///< At normal incidence; zero: no environment reflection.
    glm::vec3 grazing_reflectivity{1.0F};  ///< Equal to reflectivity: no Fresnel effect.
    FresnelModel fresnel = FresnelModel::schlick;
    float refractive_index = 1.5F;         ///< The index of the inside relative to the outside.
    glm::vec3 conductor_index{0.2F};       ///< The real part of a metal's index, by channel.
    glm::vec3 conductor_absorption{3.0F};  ///< The imaginary part.
    float reflection_roughness = 0.0F;     ///< 0: a mirror; else the blur of GGX.
    /// The environment is looked up along the normal, not along the mirrored view: as if painted on
    /// the surface.
    bool reflection_by_normal = false;
    /// The environment along the normal multiplies ambient, scattered and highlight light, like a
    /// texture; without an environment, nothing does.
    bool environment_tint = false;
    float transmission = 0.0F;  ///< The transmitted share of the light that is not reflected.

    std::optional<Texture> diffuse_texture;    ///< sRGB color; alpha is used unless opaque.
    std::optional<Texture> specular_texture;   ///< sRGB color.
    std::optional<Texture> emission_texture;   ///< sRGB color.
    std::optional<Texture> occlusion_texture;  ///< Red: the visible share of the environment.
    float occlusion_strength = 1.0F;           ///< Within [0,1].
    std::optional<Texture> opacity_texture;    ///< Red.
    std::optional<NormalMap> normal_map;
    std::optional<BumpMap> bump_map;  ///< Not together with a normal map.
    std::optional<ReliefMap> height_map;
    TangentFrame tangent_frame = TangentFrame::stored;  ///< Of maps and of anisotropy.
    /// Widens highlights by the variance of a minified normal map's normals within a pixel
    /// [Toksvig 2005].
    bool specular_antialiasing = false;

    AlphaMode alpha_mode = AlphaMode::opaque;
    float opacity = 1.0F;
    float alpha_cutoff = 0.5F;
    bool double_sided = false;  ///< Otherwise back faces are not drawn.
    bool unlit = false;         ///< Shows the diffuse color without light.

    /// The extensions of its glTF material that change the appearance and are not drawn, for
    /// reasons.
    std::vector<std::string> undrawn_extensions{};
};

// Names

template <>
inline constexpr auto enum_names<AlphaMode> = std::to_array<EnumName<AlphaMode>>(
    {{"opaque", AlphaMode::opaque}, {"mask", AlphaMode::mask}, {"blend", AlphaMode::blend}});
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
inline constexpr auto enum_names<ReliefSilhouette> =
    std::to_array<EnumName<ReliefSilhouette>>({{"none", ReliefSilhouette::none},
                                               {"clip", ReliefSilhouette::clip},
                                               {"curve", ReliefSilhouette::curve}});
template <>
inline constexpr auto enum_names<NormalSpace> = std::to_array<EnumName<NormalSpace>>(
    {{"tangent", NormalSpace::tangent}, {"object", NormalSpace::object}});
template <>
inline constexpr auto enum_names<TextureFilter> = std::to_array<EnumName<TextureFilter>>(
    {{"linear", TextureFilter::linear}, {"nearest", TextureFilter::nearest}});

// Factors and other fields

/// Its image is not among the fields: it has no meaning without its scene.
template <>
inline constexpr auto fields_of<Texture> =
    std::tuple{SceneField{"wrap_u", &Texture::wrap_u}, SceneField{"wrap_v", &Texture::wrap_v},
               SceneField{"filter", &Texture::filter},
               SceneField{"second_texcoords", &Texture::second_texcoords}};

template <>
inline constexpr auto fields_of<NormalMap> = std::tuple{
    SceneField{"texture", &NormalMap::texture, {}, {}, "normal map"},
    SceneField{"scale", &NormalMap::scale, {-1e6F, 1e6F}, {}, "normal map scale"}.on_slider({0, 4}),
    SceneField{"green", &NormalMap::green}, SceneField{"space", &NormalMap::space},
    SceneField{"zero_code", &NormalMap::flat}};

template <>
inline constexpr auto fields_of<BumpMap> = std::tuple{
    SceneField{"texture", &BumpMap::texture, {}, {}, "bump map"},
    SceneField{
        "strength", &BumpMap::strength, {-1e6F, 1e6F}, FieldUnit::texels, "bump map strength"}
        .on_slider({0, 128})};

template <>
inline constexpr auto fields_of<ReliefMap> = std::tuple{
    SceneField{"texture", &ReliefMap::texture, {}, {}, "height map"},
    SceneField{"depth", &ReliefMap::depth, {0, 1e6F}, FieldUnit::texels, "relief depth"}.on_slider(
        {0, 64}),
    SceneField{"method", &ReliefMap::method, {}, {}, "relief method"},
    SceneField{"layers", &ReliefMap::layers, {1, 512}, {}, "relief layers"}.on_slider({1, 128}),
    SceneField{"bisections", &ReliefMap::bisections, {0, 16}, {}, "relief bisections"},
    SceneField{"max_steps", &ReliefMap::max_steps, {1, 1024}, {}, "maximum relief steps"},
    SceneField{"cones", &ReliefMap::cones, {}, {}, "cone map"},
    SceneField{"self_shadow", &ReliefMap::self_shadow, {}, {}, "relief self-shadow"},
    SceneField{"silhouette", &ReliefMap::silhouette, {}, {}, "relief silhouette"},
    SceneField{"write_depth", &ReliefMap::write_depth, {}, {}, "relief depth buffer"},
    SceneField{"bound", &ReliefMap::bound, {0, 1e6F}, FieldUnit::pixels, "relief bound"}.on_slider(
        {0, 4})};

/// Returns the description of a factor of glTF's model.
/// \param gltf  its path in a material of glTF
template <typename Value>
constexpr SceneField<MetallicRoughness, Value> material_factor(const char* name,
                                                               Value MetallicRoughness::*member,
                                                               const char* gltf,
                                                               FieldRange range = {0, 1},
                                                               FieldUnit unit = FieldUnit::none) {
    return {name, member, range, unit, nullptr, gltf};
}

/// The factors and textures of glTF's model. The glTF path of a texture is in texture_slots. A
/// factor whose uniform has its name and its value needs no further code to be drawn.
template <>
inline constexpr auto fields_of<MetallicRoughness> = std::tuple{
    material_factor("base_color", &MetallicRoughness::base_color,
                    "pbrMetallicRoughness/baseColorFactor", {0, 1}, FieldUnit::color),
    material_factor("metallic", &MetallicRoughness::metallic,
                    "pbrMetallicRoughness/metallicFactor"),
    material_factor("roughness", &MetallicRoughness::roughness,
                    "pbrMetallicRoughness/roughnessFactor"),
    SceneField{"texture", &MetallicRoughness::texture, {}, {}, "metallic-roughness texture"},
    material_factor("refractive_index", &MetallicRoughness::refractive_index,
                    "extensions/KHR_materials_ior/ior", {0, 1e3F})
        .in_gltf(non_negative_range)
        .on_slider({1, 3}),
    material_factor("specular", &MetallicRoughness::specular,
                    "extensions/KHR_materials_specular/specularFactor"),
    material_factor("specular_color", &MetallicRoughness::specular_color,
                    "extensions/KHR_materials_specular/specularColorFactor", {0, max_reflectance},
                    FieldUnit::color)
        .in_gltf(non_negative_range)
        .on_slider({0, 1}),
    SceneField{"specular_texture", &MetallicRoughness::specular_texture},
    SceneField{"specular_color_texture", &MetallicRoughness::specular_color_texture},
    material_factor("clearcoat", &MetallicRoughness::clearcoat,
                    "extensions/KHR_materials_clearcoat/clearcoatFactor"),
    material_factor("clearcoat_roughness", &MetallicRoughness::clearcoat_roughness,
                    "extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor"),
    SceneField{"clearcoat_texture", &MetallicRoughness::clearcoat_texture},
    SceneField{"clearcoat_roughness_texture", &MetallicRoughness::clearcoat_roughness_texture},
    SceneField{"clearcoat_normal_map", &MetallicRoughness::clearcoat_normal_map},
    material_factor("sheen_color", &MetallicRoughness::sheen_color,
                    "extensions/KHR_materials_sheen/sheenColorFactor", {0, 1}, FieldUnit::color),
    material_factor("sheen_roughness", &MetallicRoughness::sheen_roughness,
                    "extensions/KHR_materials_sheen/sheenRoughnessFactor"),
    SceneField{"sheen_color_texture", &MetallicRoughness::sheen_color_texture},
    SceneField{"sheen_roughness_texture", &MetallicRoughness::sheen_roughness_texture},
    material_factor("anisotropy", &MetallicRoughness::anisotropy,
                    "extensions/KHR_materials_anisotropy/anisotropyStrength"),
    material_factor("anisotropy_rotation", &MetallicRoughness::anisotropy_rotation,
                    "extensions/KHR_materials_anisotropy/anisotropyRotation", FieldRange{},
                    FieldUnit::radians)
        .on_slider({-std::numbers::pi_v<float>, std::numbers::pi_v<float>}),
    SceneField{"anisotropy_texture", &MetallicRoughness::anisotropy_texture},
    material_factor("iridescence", &MetallicRoughness::iridescence,
                    "extensions/KHR_materials_iridescence/iridescenceFactor"),
    material_factor("iridescence_index", &MetallicRoughness::iridescence_index,
                    "extensions/KHR_materials_iridescence/iridescenceIor", {1, 1e3F})
        .labeled("film index")
        .in_gltf({1})
        .on_slider({1, 3}),
    material_factor("iridescence_thickness", &MetallicRoughness::iridescence_thickness,
                    "extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", {0, 1e6F},
                    FieldUnit::nanometers)
        .labeled("film thickness")
        .in_gltf(non_negative_range)
        .on_slider({0, 1200}),
    material_factor("iridescence_thickness_minimum",
                    &MetallicRoughness::iridescence_thickness_minimum,
                    "extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", {0, 1e6F},
                    FieldUnit::nanometers)
        .labeled("minimum film thickness")
        .in_gltf(non_negative_range)
        .on_slider({0, 1200}),
    SceneField{"iridescence_texture", &MetallicRoughness::iridescence_texture},
    SceneField{"iridescence_thickness_texture", &MetallicRoughness::iridescence_thickness_texture},
    material_factor("transmission", &MetallicRoughness::transmission,
                    "extensions/KHR_materials_transmission/transmissionFactor"),
    SceneField{"transmission_texture", &MetallicRoughness::transmission_texture},
    material_factor("thickness", &MetallicRoughness::thickness,
                    "extensions/KHR_materials_volume/thicknessFactor", non_negative_range),
    SceneField{"thickness_texture", &MetallicRoughness::thickness_texture},
    material_factor("attenuation_distance", &MetallicRoughness::attenuation_distance,
                    "extensions/KHR_materials_volume/attenuationDistance", positive_range,
                    FieldUnit::world_length),
    material_factor("attenuation_color", &MetallicRoughness::attenuation_color,
                    "extensions/KHR_materials_volume/attenuationColor", {0, 1}, FieldUnit::color),
    material_factor("dispersion", &MetallicRoughness::dispersion,
                    "extensions/KHR_materials_dispersion/dispersion", non_negative_range)};

/// A factor of glTF's materials that is not drawn.
struct UndrawnFactor {
    const char* gltf;  ///< As SceneField::gltf.
    FieldRange range;  ///< The values that glTF permits; 0 changes nothing.
};
inline constexpr std::array undrawn_factors{UndrawnFactor{
    "extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", {0, 1}}};

template <>
inline constexpr auto fields_of<Material> = std::tuple{
    SceneField{"name", &Material::name},
    SceneField{"interpolation", &Material::interpolation},
    SceneField{"ambient", &Material::ambient, {0, max_reflectance}, FieldUnit::color}.on_slider(
        {0, 1}),
    SceneField{"diffuse", &Material::diffuse, {0, max_reflectance}, FieldUnit::color}.on_slider(
        {0, 1}),
    SceneField{"specular", &Material::specular, {0, max_reflectance}, FieldUnit::color}.on_slider(
        {0, 1}),
    SceneField{"emission", &Material::emission, {0, max_reflectance}, FieldUnit::color},
    SceneField{"shininess", &Material::shininess, {0, 1e6F}}.on_slider({0, 1000}),
    SceneField{"specular_model", &Material::specular_model},
    SceneField{"highlight_fresnel", &Material::highlight_fresnel},
    SceneField{"metallic_roughness", &Material::metallic_roughness},
    SceneField{"reflectivity", &Material::reflectivity, {0, 1}, FieldUnit::color},
    SceneField{"grazing_reflectivity", &Material::grazing_reflectivity, {0, 1}, FieldUnit::color},
    SceneField{"fresnel", &Material::fresnel},
    SceneField{"refractive_index", &Material::refractive_index, {1, 1e3F}}.on_slider({1, 3}),
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
    SceneField{"occlusion_strength",
               &Material::occlusion_strength,
               {0, 1},
               {},
               nullptr,
               "occlusionTexture/strength"},
    SceneField{"opacity_texture", &Material::opacity_texture},
    SceneField{"normal_map", &Material::normal_map},
    SceneField{"bump_map", &Material::bump_map},
    SceneField{"height_map", &Material::height_map},
    SceneField{"tangent_frame", &Material::tangent_frame},
    SceneField{"specular_antialiasing", &Material::specular_antialiasing},
    SceneField{"alpha_mode", &Material::alpha_mode},
    SceneField{"opacity", &Material::opacity, {0, 1}},
    SceneField{
        "alpha_cutoff", &Material::alpha_cutoff, {0, max_reflectance}, {}, nullptr, "alphaCutoff"}
        .in_gltf(non_negative_range)
        .on_slider({0, 1}),
    SceneField{"double_sided", &Material::double_sided, {}, {}, nullptr, "doubleSided"},
    SceneField{"unlit", &Material::unlit}};

// Textures

/// The textures of a material. Maps in the tangent frame apart, a mesh takes its texture
/// coordinates from the first ones of glTF's that a material has.
enum class TextureSlot : std::uint8_t {
    base_color,
    specular,
    metallic_roughness,
    normal,
    bump,
    height,
    cones,
    occlusion,
    emission,
    opacity,
    specular_weight,
    specular_color,
    sheen_color,
    sheen_roughness,
    clearcoat,
    clearcoat_roughness,
    clearcoat_normal,
    anisotropy,
    iridescence,
    iridescence_thickness,
    transmission,
    thickness,
};
inline constexpr auto texture_slot_count = static_cast<std::size_t>(TextureSlot::thickness) + 1;

/// The texel that changes nothing.
enum class NeutralTexel : std::uint8_t {
    white,
    flat,     ///< (0, 0, 1), decoded.
    tangent,  ///< (1, 0.5, 1): anisotropy along the tangent.
};

/// The member of a material that has a texture.
using TextureMember =
    std::variant<std::optional<Texture> Material::*, std::optional<Texture> MetallicRoughness::*,
                 std::optional<NormalMap> Material::*,
                 std::optional<NormalMap> MetallicRoughness::*, std::optional<BumpMap> Material::*,
                 std::optional<ReliefMap> Material::*, std::optional<Texture> ReliefMap::*>;

struct TextureSlotInfo {
    TextureSlot slot;
    const char* name;     ///< In reports: "base color".
    const char* sampler;  ///< In shaders: "diffuse_texture".
    const char* effect;   ///< The effect that samples it; the map, if effects share it.
    TextureMember member;
    const char* gltf;      ///< The path in a material of glTF; empty if glTF has no such texture.
    const char* channels;  ///< Those that are used: "rgb", "g".
    ImageUse use;
    NeutralTexel neutral = NeutralTexel::white;
    /// It lies in the tangent frame, which belongs to the first texture coordinates.
    bool in_tangent_frame = false;
};

/// The textures of a material, by slot.
inline constexpr std::array<TextureSlotInfo, texture_slot_count> texture_slots{{
    {TextureSlot::base_color, "base color", "diffuse_texture", "diffuse texture",
     &Material::diffuse_texture, "pbrMetallicRoughness/baseColorTexture", "rgba", ImageUse::color},
    {TextureSlot::specular, "specular", "specular_texture", "specular texture",
     &Material::specular_texture, "", "rgb", ImageUse::color},
    {TextureSlot::metallic_roughness, "metallic-roughness", "metallic_roughness_texture",
     "metallic-roughness texture", &MetallicRoughness::texture,
     "pbrMetallicRoughness/metallicRoughnessTexture", "gb", ImageUse::data},
    {TextureSlot::normal, "normal", "normal_texture", "normal map", &Material::normal_map,
     "normalTexture", "rgb", ImageUse::data, NeutralTexel::flat, true},
    {TextureSlot::bump, "bump", "bump_texture", "bump map", &Material::bump_map, "", "r",
     ImageUse::data, NeutralTexel::white, true},
    {TextureSlot::height, "height", "height_texture", "height map", &Material::height_map, "", "r",
     ImageUse::data, NeutralTexel::white, true},
    {TextureSlot::cones, "cone", "cone_texture", "cone map", &ReliefMap::cones, "", "rg",
     ImageUse::data, NeutralTexel::white, true},
    {TextureSlot::occlusion, "occlusion", "occlusion_texture", "occlusion texture",
     &Material::occlusion_texture, "occlusionTexture", "r", ImageUse::data},
    {TextureSlot::emission, "emission", "emission_texture", "emission texture",
     &Material::emission_texture, "emissiveTexture", "rgb", ImageUse::color},
    {TextureSlot::opacity, "opacity", "opacity_texture", "opacity texture",
     &Material::opacity_texture, "", "r", ImageUse::data},
    {TextureSlot::specular_weight, "specular weight", "specular_weight_texture",
     "specular weight texture", &MetallicRoughness::specular_texture,
     "extensions/KHR_materials_specular/specularTexture", "a", ImageUse::data},
    {TextureSlot::specular_color, "specular color", "specular_color_texture",
     "specular color texture", &MetallicRoughness::specular_color_texture,
     "extensions/KHR_materials_specular/specularColorTexture", "rgb", ImageUse::color},
    {TextureSlot::sheen_color, "sheen color", "sheen_color_texture", "sheen color texture",
     &MetallicRoughness::sheen_color_texture, "extensions/KHR_materials_sheen/sheenColorTexture",
     "rgb", ImageUse::color},
    {TextureSlot::sheen_roughness, "sheen roughness", "sheen_roughness_texture",
     "sheen roughness texture", &MetallicRoughness::sheen_roughness_texture,
     "extensions/KHR_materials_sheen/sheenRoughnessTexture", "a", ImageUse::data},
    {TextureSlot::clearcoat, "clearcoat", "clearcoat_texture", "clearcoat texture",
     &MetallicRoughness::clearcoat_texture, "extensions/KHR_materials_clearcoat/clearcoatTexture",
     "r", ImageUse::data},
    {TextureSlot::clearcoat_roughness, "clearcoat roughness", "clearcoat_roughness_texture",
     "clearcoat roughness texture", &MetallicRoughness::clearcoat_roughness_texture,
     "extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture", "g", ImageUse::data},
    {TextureSlot::clearcoat_normal, "clearcoat normal", "clearcoat_normal_texture",
     "clearcoat normal map", &MetallicRoughness::clearcoat_normal_map,
     "extensions/KHR_materials_clearcoat/clearcoatNormalTexture", "rgb", ImageUse::data,
     NeutralTexel::flat, true},
    {TextureSlot::anisotropy, "anisotropy", "anisotropy_texture", "anisotropy texture",
     &MetallicRoughness::anisotropy_texture,
     "extensions/KHR_materials_anisotropy/anisotropyTexture", "rgb", ImageUse::data,
     NeutralTexel::tangent, true},
    {TextureSlot::iridescence, "iridescence", "iridescence_texture", "iridescence texture",
     &MetallicRoughness::iridescence_texture,
     "extensions/KHR_materials_iridescence/iridescenceTexture", "r", ImageUse::data},
    {TextureSlot::iridescence_thickness, "film thickness", "film_thickness_texture",
     "film thickness texture", &MetallicRoughness::iridescence_thickness_texture,
     "extensions/KHR_materials_iridescence/iridescenceThicknessTexture", "g", ImageUse::data},
    {TextureSlot::transmission, "transmission", "transmission_texture", "transmission texture",
     &MetallicRoughness::transmission_texture,
     "extensions/KHR_materials_transmission/transmissionTexture", "r", ImageUse::data},
    {TextureSlot::thickness, "thickness", "thickness_texture", "thickness texture",
     &MetallicRoughness::thickness_texture, "extensions/KHR_materials_volume/thicknessTexture", "g",
     ImageUse::data},
}};

static_assert([] {
    for (std::size_t i = 0; i < texture_slot_count; ++i) {
        if (texture_slots[i].slot != static_cast<TextureSlot>(i)) return false;
    }
    return true;
}());

constexpr const TextureSlotInfo& slot_info(TextureSlot slot) {
    return texture_slots[static_cast<std::size_t>(slot)];
}

/// Returns true for a texture of glTF's model, which a material without that model cannot have.
constexpr bool is_of_metallic_roughness(const TextureSlotInfo& slot) {
    return std::holds_alternative<std::optional<Texture> MetallicRoughness::*>(slot.member) ||
           std::holds_alternative<std::optional<NormalMap> MetallicRoughness::*>(slot.member);
}

/// Returns the texture in a slot; null if there is none.
const Texture* find_texture(const Material& material, TextureSlot slot);
Texture* find_texture(Material& material, TextureSlot slot);

/// Sets the texture in a slot. A map that the material has keeps its other fields. Textures of
/// glTF's model are ignored if the material does not have it, and cones without a height map.
void set_texture(Material& material, TextureSlot slot, const Texture& texture);

/// Removes the texture from a slot, with its map.
void remove_texture(Material& material, TextureSlot slot);

}  // namespace relief
