// SPDX-License-Identifier: Apache-2.0
// The condition of every effect: two scenes on both sides of each part of the condition, and the
// reasons that the planner gives.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string_view>
#include <type_traits>

#include "relief/shade/effects.h"
#include "shade/effects/feature_sets.h"

namespace relief {
namespace {

using test::gray;
using test::lit_scene;
using test::reason;

/// Scenes on both sides of each part of every effect's condition.
namespace boundaries {

/// A scene with one draw, and the settings of its frame.
struct Frame {
    Scene scene = lit_scene(gray());
    FrameSettings settings{.samples = 1};

    Material& material() { return scene.materials[0]; }
    Mesh& mesh() { return scene.meshes[0].edit(); }
};

using Change = std::function<void(Frame&)>;
using Sun = DirectionalLight;

template <typename T>
Change with(T Material::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.material().*member = value; };
}
template <typename T>
Change with(T Scene::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.scene.*member = value; };
}
template <typename T>
Change with(T FrameSettings::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.settings.*member = value; };
}
template <typename T>
Change with_sun(T Sun::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.scene.directional_lights[0].*member = value; };
}
template <typename T>
Change with_point_light(T PointLight::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.scene.point_lights[0].*member = value; };
}
template <typename T>
Change with_spot(T PointLight::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.scene.spot_lights[0].point.*member = value; };
}
Change with_suns(std::size_t count) {
    return [=](Frame& f) { f.scene.directional_lights.resize(count); };
}
Change with_colors(const glm::vec4& color) {
    return [=](Frame& f) { f.mesh().colors.assign(4, color); };
}
Change with_last_color(const glm::vec4& color) {
    return [=](Frame& f) { f.mesh().colors.back() = color; };
}

const glm::vec3 black{0.0F};
const glm::vec3 faint{0, 0, 0.001F};

const Change unlit = with(&Material::unlit, true);
const Change physical = with(&Material::metallic_roughness, MetallicRoughness{});
const Change physical_texture = [](Frame& f) {
    f.material().metallic_roughness->texture = Texture{};
};
template <typename T>
Change with(T MetallicRoughness::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) {
        std::optional<MetallicRoughness>& model = f.material().metallic_roughness;
        if (!model) model.emplace().metallic = 0.0F;
        (*model).*member = value;
    };
}
/// A dielectric without highlights of its own: light between its facets does not count.
const Change smooth_dielectric = [](Frame& f) {
    MetallicRoughness& model = f.material().metallic_roughness.emplace();
    model.metallic = 0.0F;
    model.roughness = 0.05F;
};
const Change no_metal = with(&MetallicRoughness::metallic, 0.0F);
const Change denser = with(&MetallicRoughness::refractive_index, 1.501F);
const Change sheen = with(&MetallicRoughness::sheen_color, {0, 0, 0.001F});
const Change clearcoat = with(&MetallicRoughness::clearcoat, 0.001F);
const Change brushed = with(&MetallicRoughness::anisotropy, 0.001F);
const Change filmy = with(&MetallicRoughness::iridescence, 0.001F);
const Change specular_weight = with(&MetallicRoughness::specular_texture, Texture{});
const Change specular_color = with(&MetallicRoughness::specular_color_texture, Texture{});
const Change sheen_texture = with(&MetallicRoughness::sheen_color_texture, Texture{});
const Change sheen_roughness = with(&MetallicRoughness::sheen_roughness_texture, Texture{});
const Change coat_texture = with(&MetallicRoughness::clearcoat_texture, Texture{});
const Change coat_roughness = with(&MetallicRoughness::clearcoat_roughness_texture, Texture{});
const Change coat_map = with(&MetallicRoughness::clearcoat_normal_map, NormalMap{});
const Change brush_texture = with(&MetallicRoughness::anisotropy_texture, Texture{});
const Change film_texture = with(&MetallicRoughness::iridescence_texture, Texture{});
const Change thickness_texture = with(&MetallicRoughness::iridescence_thickness_texture, Texture{});
const Change clear = with(&MetallicRoughness::transmission, 0.001F);
const Change thick = with(&MetallicRoughness::thickness, 0.001F);
const Change clear_texture = with(&MetallicRoughness::transmission_texture, Texture{});
const Change volume_texture = with(&MetallicRoughness::thickness_texture, Texture{});
const Change metal = with(&MetallicRoughness::metallic, 1.0F);
const Change gouraud = with(&Material::interpolation, Interpolation::gouraud);
const Change flat = with(&Material::interpolation, Interpolation::flat);
const Change black_surface = [](Frame& f) { f.material().diffuse = f.material().ambient = black; };
const Change scattering = with(&Material::diffuse, faint);
const Change shiny = with(&Material::specular, faint);
const Change by_normal = with(&Material::reflection_by_normal, true);
const Change tinted = with(&Material::environment_tint, true);
const Change gleaming = with(&Material::highlight_fresnel, true);
const Change phong = with(&Material::specular_model, SpecularModel::phong);
const Change emissive = with(&Material::emission, faint);
const Change mirror = with(&Material::reflectivity, faint);
const Change rough = with(&Material::reflection_roughness, 0.001F);
const Change dielectric = with(&Material::fresnel, FresnelModel::dielectric);
const Change conductor = with(&Material::fresnel, FresnelModel::conductor);
const Change transmitting = with(&Material::transmission, 0.001F);
const Change translucent = with(&Material::opacity, 0.999F);
const Change masked = with(&Material::alpha_mode, AlphaMode::mask);
const Change blended = with(&Material::alpha_mode, AlphaMode::blend);
const Change double_sided = with(&Material::double_sided, true);
const Change antialiased = with(&Material::specular_antialiasing, true);
const Change derivative_frames = with(&Material::tangent_frame, TangentFrame::derivatives);
const Change diffuse_texture = with(&Material::diffuse_texture, Texture{});
const Change specular_texture = with(&Material::specular_texture, Texture{});
const Change emission_texture = with(&Material::emission_texture, Texture{});
const Change occlusion_texture = with(&Material::occlusion_texture, Texture{});
const Change opacity_texture = with(&Material::opacity_texture, Texture{});
const Change normal_map = with(&Material::normal_map, NormalMap{});
const Change object_map = [](Frame& f) {
    f.material().normal_map = NormalMap{};
    f.material().normal_map->space = NormalSpace::object;
};
const Change bump_map = with(&Material::bump_map, BumpMap{});

const Change second_texcoords = [](Frame& f) { f.mesh().texcoords_2.resize(4); };
const Change no_texcoords = [](Frame& f) { f.mesh().texcoords.clear(); };
const Change stored_tangents = [](Frame& f) { f.mesh().tangents.assign(4, {1, 0, 0, 1}); };

const Change ambient = with(&Scene::ambient, faint);
const Change clamped = with(&Scene::clamp_terms, true);
const Change no_suns = with(&Scene::directional_lights, {});
const Change point_light = [](Frame& f) { f.scene.point_lights.push_back({{0, 0, 1}, faint}); };
const Change constant_light = [](Frame& f) {
    f.scene.point_lights.push_back({{0, 0, 1}, faint, std::nullopt, Falloff::none});
};
const Change black_point_light = with_point_light(&PointLight::intensity, black);
const Change black_second_light = [](Frame& f) { f.scene.point_lights[1].intensity = black; };
const Change spot_light = [](Frame& f) { f.scene.spot_lights.push_back({{{0, 0, 1}, faint}}); };
/// An environment that is neither visible itself nor scattered.
const Change environment =
    with(&Scene::environment, Environment{Equirectangular{}, 1.0F, false, false});
const Change rotated = [](Frame& f) { f.scene.environment->rotation = 0.001F; };
const Change skybox = [](Frame& f) { f.scene.environment->skybox = true; };
const Change hazy = [](Frame& f) { f.scene.environment->skybox_blur = 0.001F; };
const Change scattered = [](Frame& f) { f.scene.environment->lights = true; };

const Change morph_target = [](Frame& f) {
    MeshPose& pose = f.scene.instances[0].pose.emplace();
    pose.deformation.edit().targets.resize(1);
    pose.deformation.edit().targets[0].positions.assign(4, {0, 0, 1});
    pose.weights = {0.0F};
};
const Change morphed = [](Frame& f) {
    if (!f.scene.instances[0].pose) f.scene.instances[0].pose.emplace();
    f.scene.instances[0].pose->weights = {0.001F};
};
const Change joints = [](Frame& f) {
    MeshPose& pose = f.scene.instances[0].pose.emplace();
    pose.joint_matrices.assign(2, glm::mat4(1.0F));
};
const Change moved_joint = [](Frame& f) {
    f.scene.instances[0].pose->joint_matrices[1][3].x = 0.001F;
};
const Change flat_normals = [](Frame& f) { f.scene.instances[0].pose->has_flat_normals = true; };

const Change shadowed = with(&Scene::shadow, Shadow{});
/// A point light at this share of the radius of the mesh from its middle.
Change with_light_at(float share) {
    return [=](Frame& f) {
        const Bounds bounds = world_bounds(f.scene);
        const glm::vec3 middle = 0.5F * (bounds.min + bounds.max);
        const float radius = 0.5F * glm::distance(bounds.min, bounds.max);
        f.scene.point_lights.push_back({middle + glm::vec3(0, 0, share * radius), faint});
    };
}

Change with_last_share(float share) {
    return [=](Frame& f) {
        f.scene.instances[0].open_shares = std::vector{1.0F, 1.0F, 1.0F, share};
    };
}

const Change exposed = with(&Scene::exposure, 0.999F);
const Change reinhard = with(&Scene::tone_mapping, ToneMapping::reinhard);
const Change aces = with(&Scene::tone_mapping, ToneMapping::aces);
const Change linear_output = with(&FrameSettings::output, OutputCoding::linear);
const Change two_samples = with(&FrameSettings::samples, 2);
const Change view_of_data = with(&FrameSettings::view, DebugView::shading_normal);

/// A part of an effect's condition: two scenes that differ in this part only. Only the second one
/// needs the effect.
struct Boundary {
    const char* effect;
    const char* condition;
    std::vector<Change> both;
    std::vector<Change> off;
    std::vector<Change> on;
};

const std::vector<Boundary> color_boundaries = {
    {"unlit", "asked for", {}, {}, {unlit}},
    {"metallic-roughness", "its model", {}, {}, {physical}},
    {"metallic-roughness", "light", {no_suns}, {physical}, {physical, ambient}},
    {"metallic-roughness", "lit", {physical}, {unlit}, {}},
    {"metallic-roughness texture", "has one", {physical}, {}, {physical_texture}},
    {"metallic-roughness texture",
     "texture coordinates",
     {physical, physical_texture},
     {no_texcoords},
     {}},
    {"dielectric reflectance", "another index", {no_metal}, {}, {denser}},
    {"dielectric reflectance",
     "another weight",
     {no_metal},
     {with(&MetallicRoughness::specular, 1.0F)},
     {with(&MetallicRoughness::specular, 0.999F)}},
    {"dielectric reflectance",
     "another color",
     {no_metal},
     {with(&MetallicRoughness::specular_color, glm::vec3(1.0F))},
     {with(&MetallicRoughness::specular_color, {1, 1, 0.999F})}},
    {"dielectric reflectance",
     "not all metal",
     {denser},
     {with(&MetallicRoughness::metallic, 1.0F)},
     {with(&MetallicRoughness::metallic, 0.999F)}},
    {"dielectric reflectance",
     "a texture of metal",
     {denser, with(&MetallicRoughness::metallic, 1.0F)},
     {},
     {physical_texture}},
    {"dielectric reflectance",
     "texture coordinates",
     {denser, with(&MetallicRoughness::metallic, 1.0F), physical_texture},
     {no_texcoords},
     {}},
    {"dielectric reflectance", "light", {denser, no_suns}, {}, {ambient}},
    {"energy compensation", "glTF's model", {}, {}, {physical}},
    {"energy compensation",
     "roughness",
     {smooth_dielectric},
     {},
     {with(&MetallicRoughness::roughness, 0.051F)}},
    {"energy compensation",
     "metal",
     {smooth_dielectric},
     {},
     {with(&MetallicRoughness::metallic, 0.001F)}},
    {"energy compensation",
     "reflectance",
     {smooth_dielectric},
     {},
     {with(&MetallicRoughness::refractive_index, 1.6F)}},
    {"energy compensation", "a film", {smooth_dielectric}, {}, {filmy}},
    {"energy compensation",
     "a coat",
     {smooth_dielectric},
     {},
     {with(&MetallicRoughness::clearcoat, 0.001F)}},
    {"energy compensation",
     "anisotropy",
     {smooth_dielectric},
     {},
     {with(&MetallicRoughness::anisotropy, 0.001F)}},
    {"energy compensation", "lights", {physical, ambient}, {no_suns}, {}},
    {"energy compensation", "an environment", {physical, no_suns, ambient}, {}, {environment}},
    {"energy compensation", "lit", {physical}, {unlit}, {}},
    {"sheen", "a channel", {no_metal}, {}, {sheen}},
    {"sheen", "ambient light", {sheen, no_suns}, {}, {ambient}},
    {"sheen", "light besides its emission", {sheen, emissive}, {no_suns}, {}},
    {"sheen", "lit", {sheen}, {unlit}, {}},
    {"clearcoat", "its weight", {no_metal}, {}, {clearcoat}},
    {"clearcoat", "light", {clearcoat, no_suns}, {}, {ambient}},
    {"clearcoat", "emission", {clearcoat, no_suns}, {}, {emissive}},
    {"clearcoat", "lit", {clearcoat}, {unlit}, {}},
    {"iridescence", "its weight", {no_metal}, {}, {filmy}},
    {"iridescence", "light", {filmy, no_suns}, {}, {ambient}},
    {"iridescence", "light besides its emission", {filmy, emissive}, {no_suns}, {}},
    {"iridescence", "lit", {filmy}, {unlit}, {}},
    {"anisotropy", "its strength", {no_metal}, {}, {brushed}},
    {"anisotropy", "lights", {brushed}, {no_suns}, {}},
    {"anisotropy", "highlights", {brushed, no_suns, ambient}, {}, {environment}},
    {"anisotropy", "lit", {brushed}, {unlit}, {}},
    {"anisotropy", "texture coordinates", {brushed}, {no_texcoords}, {}},
    {"anisotropy", "a frame", {brushed, no_texcoords}, {}, {stored_tangents}},
    {"anisotropy",
     "a frame from derivatives",
     {brushed, no_texcoords, stored_tangents},
     {derivative_frames},
     {}},
    {"dielectric reflectance", "a texture of the weight", {no_metal}, {}, {specular_weight}},
    {"dielectric reflectance", "a texture of the color", {no_metal}, {}, {specular_color}},
    {"dielectric reflectance", "texture coordinates", {specular_color}, {no_texcoords}, {}},
    {"specular weight texture", "has one", {denser}, {}, {specular_weight}},
    {"specular weight texture", "not all metal", {physical, specular_weight}, {}, {no_metal}},
    {"specular color texture", "has one", {denser}, {}, {specular_color}},
    {"specular color texture", "texture coordinates", {denser, specular_color}, {no_texcoords}, {}},
    {"sheen color texture", "has one", {sheen}, {}, {sheen_texture}},
    {"sheen color texture", "a sheen", {sheen_texture}, {}, {sheen}},
    {"sheen roughness texture", "has one", {sheen}, {}, {sheen_roughness}},
    {"sheen roughness texture", "a sheen", {sheen_roughness}, {}, {sheen}},
    {"sheen roughness texture",
     "texture coordinates",
     {sheen, sheen_roughness},
     {no_texcoords},
     {}},
    {"clearcoat texture", "has one", {clearcoat}, {}, {coat_texture}},
    {"clearcoat texture", "a coat", {coat_texture}, {}, {clearcoat}},
    {"clearcoat roughness texture", "has one", {clearcoat}, {}, {coat_roughness}},
    {"clearcoat roughness texture",
     "highlights",
     {clearcoat, coat_roughness, ambient},
     {no_suns},
     {}},
    {"clearcoat normal map", "has one", {clearcoat}, {}, {coat_map}},
    {"clearcoat normal map", "a coat", {coat_map}, {}, {clearcoat}},
    {"clearcoat normal map", "not flat", {clearcoat, coat_map}, {flat}, {}},
    {"clearcoat normal map", "texture coordinates", {clearcoat, coat_map}, {no_texcoords}, {}},
    {"anisotropy texture", "has one", {brushed}, {}, {brush_texture}},
    {"anisotropy texture", "anisotropy", {brush_texture}, {}, {brushed}},
    {"iridescence texture", "has one", {filmy}, {}, {film_texture}},
    {"iridescence texture", "a film", {film_texture}, {}, {filmy}},
    {"film thickness texture", "has one", {filmy}, {}, {thickness_texture}},
    {"film thickness texture", "a film", {thickness_texture}, {}, {filmy}},
    {"transmission", "its share", {no_metal}, {}, {clear}},
    {"transmission",
     "not all metal",
     {clear},
     {metal},
     {with(&MetallicRoughness::metallic, 0.999F)}},
    {"transmission", "a texture of metal", {clear, metal}, {}, {physical_texture}},
    {"transmission", "texture coordinates", {clear, metal, physical_texture}, {no_texcoords}, {}},
    {"transmission", "lit", {clear}, {unlit}, {}},
    {"transmission texture", "has one", {clear}, {}, {clear_texture}},
    {"transmission texture", "transmission", {clear_texture}, {}, {clear}},
    {"volume", "a thickness", {clear}, {}, {thick}},
    {"volume", "transmission", {thick}, {}, {clear}},
    {"thickness texture", "has one", {clear, thick}, {}, {volume_texture}},
    {"thickness texture", "a volume", {clear, volume_texture}, {}, {thick}},
    {"diffuse texture",
     "second texture coordinates",
     {with(&Material::diffuse_texture, Texture{.second_texcoords = true})},
     {},
     {second_texcoords}},
    {"transmission",
     "a texture of metal at second texture coordinates",
     {clear, metal, with(&MetallicRoughness::texture, Texture{.second_texcoords = true})},
     {},
     {second_texcoords}},
    {"metallic-roughness", "what is behind", {no_suns}, {no_metal}, {clear}},
    {"diffuse texture", "what is behind", {no_suns, diffuse_texture, no_metal}, {}, {clear}},
    {"normal map", "what is behind", {no_suns, normal_map, no_metal}, {}, {clear}},
    {"sheen", "what is behind", {sheen, no_suns}, {}, {clear}},
    {"clearcoat", "what is behind", {clearcoat, no_suns}, {}, {clear}},
    {"iridescence", "what is behind", {filmy, no_suns}, {}, {clear}},
    {"transmission background", "a surface", {no_metal}, {}, {clear}},
    {"metallic-roughness", "coated emission", {no_suns, emissive}, {no_metal}, {clearcoat}},
    {"normal map", "a sheen", {normal_map, no_suns, ambient, no_metal}, {clearcoat}, {sheen}},
    {"double-sided normals", "a coat", {double_sided, no_suns, ambient, no_metal}, {}, {clearcoat}},
    {"Gouraud", "asked for", {}, {}, {gouraud}},
    {"Gouraud", "lights", {gouraud}, {no_suns}, {}},
    {"Gouraud", "Phong's model", {gouraud}, {physical}, {}},
    {"flat", "asked for", {}, {}, {flat}},
    {"flat", "lights", {flat}, {no_suns}, {}},
    {"flat",
     "an environment that is scattered",
     {flat, no_suns},
     {environment},
     {environment, scattered}},
    {"flat", "an environment that is mirrored", {flat, no_suns, environment}, {}, {mirror}},
    {"diffuse texture", "has one", {}, {}, {diffuse_texture}},
    {"diffuse texture", "texture coordinates", {diffuse_texture}, {no_texcoords}, {}},
    {"diffuse texture", "scattered light", {diffuse_texture, black_surface}, {}, {scattering}},
    {"diffuse texture",
     "alpha that counts on a black surface",
     {diffuse_texture, black_surface},
     {},
     {masked}},
    {"vertex colors", "red", {with_colors({1, 1, 1, 1})}, {}, {with_last_color({0.999F, 1, 1, 1})}},
    {"vertex colors",
     "green",
     {with_colors({1, 1, 1, 1})},
     {},
     {with_last_color({1, 0.999F, 1, 1})}},
    {"vertex colors",
     "blue",
     {with_colors({1, 1, 1, 1})},
     {},
     {with_last_color({1, 1, 0.999F, 1})}},
    {"vertex colors", "alpha that counts", {with_colors({1, 1, 1, 0.5F})}, {}, {blended}},
    {"vertex colors",
     "scattered light",
     {with_colors({0.5F, 1, 1, 1}), black_surface},
     {},
     {scattering}},
    {"alpha mask", "opacity", {masked}, {}, {translucent}},
    {"alpha mask",
     "a cutoff above 1",
     {masked},
     {with(&Material::alpha_cutoff, 1.0F)},
     {with(&Material::alpha_cutoff, 1.001F)}},
    {"alpha mask", "its mode", {translucent}, {}, {masked}},
    {"alpha mask", "a diffuse texture that shows", {masked, diffuse_texture}, {no_texcoords}, {}},
    {"alpha mask", "an opacity texture that shows", {masked, opacity_texture}, {no_texcoords}, {}},
    {"alpha mask",
     "the alpha of vertex colors",
     {masked, with_colors({1, 1, 1, 1})},
     {},
     {with_last_color({1, 1, 1, 0.999F})}},
    {"alpha blending", "opacity", {blended}, {}, {translucent}},
    {"alpha blending",
     "no cutoff",
     {blended, with(&Material::alpha_cutoff, 2.0F)},
     {},
     {translucent}},
    {"alpha blending", "its mode", {translucent}, {}, {blended}},
    {"alpha blending",
     "an opacity texture that shows",
     {blended, opacity_texture},
     {no_texcoords},
     {}},
    {"opacity texture", "has one", {masked}, {}, {opacity_texture}},
    {"opacity texture", "not opaque", {opacity_texture}, {}, {blended}},
    {"opacity texture",
     "texture coordinates",
     {masked, translucent, opacity_texture},
     {no_texcoords},
     {}},
    {"diffuse texture", "unlit", {unlit}, {}, {diffuse_texture}},
    {"vertex colors", "unlit", {unlit}, {}, {with_colors({1, 0.999F, 1, 1})}},
    {"alpha mask", "unlit", {unlit, translucent}, {}, {masked}},
    {"opacity texture", "unlit", {unlit, masked}, {}, {opacity_texture}},
    {"opacity texture", "unlit and opaque", {unlit, opacity_texture}, {}, {masked}},
};

const std::vector<Boundary> normal_boundaries = {
    {"normal map", "has one", {}, {}, {normal_map}},
    {"normal map", "tangent space", {}, {object_map}, {normal_map}},
    {"normal map", "texture coordinates", {normal_map}, {no_texcoords}, {}},
    {"normal map", "lights", {normal_map}, {no_suns}, {}},
    {"normal map",
     "an environment that is scattered",
     {normal_map, no_suns},
     {environment},
     {environment, scattered}},
    {"normal map",
     "an environment that is mirrored",
     {normal_map, no_suns, environment},
     {},
     {mirror}},
    {"normal map", "refraction", {normal_map, no_suns, environment}, {}, {transmitting}},
    {"normal map", "not Gouraud", {normal_map}, {gouraud}, {}},
    {"normal map", "not flat", {normal_map}, {flat}, {}},
    {"object-space normal map", "has one", {}, {}, {object_map}},
    {"object-space normal map", "object space", {}, {normal_map}, {object_map}},
    {"object-space normal map", "texture coordinates", {object_map}, {no_texcoords}, {}},
    {"object-space normal map", "lights", {object_map}, {no_suns}, {}},
    {"bump map", "has one", {}, {}, {bump_map}},
    {"bump map", "texture coordinates", {bump_map}, {no_texcoords}, {}},
    {"bump map", "lights", {bump_map}, {no_suns}, {}},
    {"derivative frames", "asked for", {normal_map}, {}, {derivative_frames}},
    {"derivative frames", "a map", {derivative_frames}, {}, {bump_map}},
    {"derivative frames", "anisotropy", {derivative_frames, no_metal}, {}, {brushed}},
    {"derivative frames", "tangent space", {derivative_frames}, {object_map}, {normal_map}},
    {"computed tangents", "a map", {}, {}, {normal_map}},
    {"computed tangents", "a height map", {}, {}, {bump_map}},
    {"computed tangents", "anisotropy", {no_metal}, {}, {brushed}},
    {"computed tangents", "a coat's map", {clearcoat}, {}, {coat_map}},
    {"computed tangents", "tangent space", {}, {object_map}, {normal_map}},
    {"computed tangents", "none stored", {normal_map}, {stored_tangents}, {}},
    {"computed tangents", "stored frames", {bump_map}, {derivative_frames}, {}},
    {"computed tangents", "lights", {normal_map}, {no_suns}, {}},
    {"specular antialiasing", "asked for", {shiny, normal_map}, {}, {antialiased}},
    {"specular antialiasing", "highlights", {normal_map, antialiased}, {}, {shiny}},
    {"specular antialiasing", "a normal map", {shiny, antialiased}, {bump_map}, {normal_map}},
    {"specular antialiasing", "an object-space normal map", {shiny, antialiased}, {}, {object_map}},
    {"specular antialiasing",
     "a mirrored environment without lights",
     {physical, no_suns, normal_map, antialiased},
     {},
     {environment}},
    {"specular antialiasing",
     "metallic-roughness under a light",
     {normal_map, antialiased},
     {},
     {physical}},
    {"double-sided normals", "asked for", {}, {}, {double_sided}},
    {"double-sided normals", "lights", {double_sided}, {no_suns}, {}},
    {"double-sided normals", "lights at vertices", {double_sided, gouraud}, {no_suns}, {}},
    {"double-sided normals",
     "a scattered environment",
     {double_sided, no_suns},
     {environment},
     {environment, scattered}},
    {"double-sided normals", "not flat", {double_sided}, {flat}, {}},
};

const std::vector<Boundary> light_boundaries = {
    {"ambient", "red of the scene", {}, {}, {with(&Scene::ambient, {0.001F, 0, 0})}},
    {"ambient",
     "a channel of both",
     {with(&Scene::ambient, {0, 1, 0})},
     {with(&Material::ambient, {1, 0, 1})},
     {with(&Material::ambient, {0, 0.001F, 0})}},
    {"ambient",
     "metallic-roughness has no ambient color",
     {ambient, black_surface},
     {},
     {physical}},
    {"ambient", "metallic-roughness in ambient light", {physical}, {}, {ambient}},
    {"ambient", "of a light", {}, {}, {with_sun(&Sun::ambient, faint)}},
    {"ambient",
     "of a light that is on",
     {with_sun(&Sun::ambient, faint)},
     {with_sun(&Sun::on, false)},
     {}},
    {"ambient",
     "of a spot light that is on",
     {spot_light, with_spot(&PointLight::ambient, faint)},
     {with_spot(&PointLight::on, false)},
     {}},
    {"directional lights", "on", {}, {with_sun(&Sun::on, false)}, {}},
    {"point lights", "on", {point_light}, {with_point_light(&PointLight::on, false)}, {}},
    {"spot lights", "on", {spot_light}, {with_spot(&PointLight::on, false)}, {}},
    {"highlight colors",
     "of a light that is on",
     {shiny, point_light, with_sun(&Sun::highlight_irradiance, faint)},
     {with_sun(&Sun::on, false)},
     {}},
    {"directional lights", "has one", {}, {no_suns}, {}},
    {"directional lights",
     "not black",
     {},
     {with_sun(&Sun::irradiance, black)},
     {with_sun(&Sun::irradiance, faint)}},
    {"directional lights",
     "highlights that are not black",
     {with_sun(&Sun::irradiance, black), shiny},
     {with_sun(&Sun::highlight_irradiance, black)},
     {with_sun(&Sun::highlight_irradiance, glm::vec3(0.001F, 0, 0))}},
    {"directional lights", "a surface that scatters", {black_surface}, {}, {scattering}},
    {"directional lights", "a surface with highlights", {black_surface}, {}, {shiny}},
    {"point lights", "has one", {}, {}, {point_light}},
    {"point lights", "not black", {point_light}, {black_point_light}, {}},
    {"spot lights", "has one", {}, {}, {spot_light}},
    {"spot lights", "not black", {spot_light}, {with_spot(&PointLight::intensity, black)}, {}},
    {"no falloff", "has one", {}, {}, {constant_light}},
    {"no falloff", "its law", {}, {point_light}, {constant_light}},
    {"no falloff", "every light's law", {constant_light}, {spot_light}, {constant_light}},
    {"no falloff",
     "not black",
     {constant_light, point_light},
     {black_point_light},
     {black_second_light}},
    {"mixed falloff", "one that does not fall off", {point_light}, {point_light}, {constant_light}},
    {"mixed falloff", "one that falls off", {constant_light}, {constant_light}, {point_light}},
    {"mixed falloff", "a spot light that falls off", {constant_light}, {}, {spot_light}},
    {"mixed falloff", "not black", {constant_light, point_light}, {black_point_light}, {}},
    {"light ranges",
     "a point light's",
     {point_light},
     {},
     {with_point_light(&PointLight::range, 5.0F)}},
    {"light ranges", "a spot light's", {spot_light}, {}, {with_spot(&PointLight::range, 5.0F)}},
    {"light ranges",
     "not black",
     {point_light, with_point_light(&PointLight::range, 5.0F), spot_light},
     {black_point_light},
     {}},
    {"highlight colors",
     "another than a directional light's",
     {shiny},
     {with_sun(&Sun::highlight_irradiance, glm::vec3(1.0F))},
     {with_sun(&Sun::highlight_irradiance, glm::vec3(1, 1, 0.999F))}},
    {"highlight colors",
     "another than a point light's",
     {shiny, point_light},
     {with_point_light(&PointLight::highlight_intensity, faint)},
     {with_point_light(&PointLight::highlight_intensity, glm::vec3(0, 0, 0.002F))}},
    {"highlight colors",
     "another than a spot light's",
     {shiny, spot_light},
     {with_spot(&PointLight::highlight_intensity, faint)},
     {with_spot(&PointLight::highlight_intensity, glm::vec3(0, 0.001F, 0.001F))}},
    {"highlight colors", "highlights", {with_sun(&Sun::highlight_irradiance, faint)}, {}, {shiny}},
    {"vertex occlusion", "a share", {ambient}, {with_last_share(1.0F)}, {with_last_share(0.999F)}},
    {"vertex occlusion", "light from everywhere", {with_last_share(0.0F)}, {}, {ambient}},
    {"vertex occlusion", "lit", {with_last_share(0.0F), ambient}, {unlit}, {}},
    {"vertex occlusion",
     "a scattered environment",
     {with_last_share(0.0F), environment},
     {},
     {scattered}},
    {"shadow", "asked for", {}, {}, {shadowed}},
    {"shadow", "a light", {shadowed, ambient}, {no_suns}, {}},
    {"shadow",
     "not black",
     {shadowed, no_suns, ambient, with_light_at(2.0F)},
     {black_point_light},
     {}},
    {"shadow", "far", {shadowed, no_suns}, {with_light_at(1.09F)}, {with_light_at(1.11F)}},
    {"shadow", "a surface that scatters", {shadowed}, {black_surface}, {}},
    {"shadow", "lit", {shadowed}, {unlit}, {}},
    {"shadow", "not blended", {shadowed, translucent}, {blended}, {masked}},
    {"shadow", "no transmission", {shadowed, no_metal}, {clear}, {}},
    {"shadow maps", "asked for", {}, {}, {shadowed}},
    {"shadow maps", "a surface that scatters", {shadowed}, {black_surface}, {}},
    {"light buffer", "more than a block holds", {}, {with_suns(512)}, {with_suns(513)}},
    {"light buffer",
     "rows of highlights",
     {shiny, with_sun(&Sun::highlight_irradiance, faint)},
     {with_suns(341)},
     {with_suns(342)}},
    {"light buffer", "a surface that scatters", {with_suns(513)}, {black_surface}, {}},
    {"environment light", "an environment", {}, {}, {environment, scattered}},
    {"environment light",
     "an environment that is scattered",
     {},
     {environment},
     {environment, scattered}},
    {"environment light",
     "a surface that scatters",
     {black_surface, environment, scattered},
     {},
     {scattering}},
    {"environment light",
     "metallic-roughness has no diffuse color",
     {black_surface, environment, scattered},
     {},
     {physical}},
    {"environment light", "lit", {environment, scattered}, {unlit}, {}},
    {"occlusion texture", "has one", {ambient}, {}, {occlusion_texture}},
    {"occlusion texture",
     "its strength",
     {ambient, occlusion_texture},
     {with(&Material::occlusion_strength, 0.0F)},
     {with(&Material::occlusion_strength, 0.001F)}},
    {"occlusion texture", "texture coordinates", {ambient, occlusion_texture}, {no_texcoords}, {}},
    {"occlusion texture", "ambient light", {occlusion_texture}, {}, {ambient}},
    {"occlusion texture",
     "a scattered environment",
     {occlusion_texture},
     {environment},
     {environment, scattered}},
    {"occlusion texture",
     "an environment mirrored by metallic-roughness",
     {mirror, environment, occlusion_texture},
     {},
     {physical}},
    {"diffuse", "a surface that scatters", {black_surface}, {}, {scattering}},
    {"diffuse", "metallic-roughness has no diffuse color", {black_surface}, {}, {physical}},
    {"diffuse", "lights", {}, {no_suns}, {}},
};

const std::vector<Boundary> highlight_boundaries = {
    {"Phong highlights", "a specular color", {phong}, {}, {shiny}},
    {"Phong highlights", "its model", {shiny}, {}, {phong}},
    {"Phong highlights", "not metallic-roughness", {shiny, phong}, {physical}, {}},
    {"Phong highlights", "lights", {shiny, phong}, {no_suns}, {}},
    {"Blinn-Phong highlights", "a specular color", {}, {}, {shiny}},
    {"Blinn-Phong highlights",
     "its model",
     {shiny},
     {phong},
     {with(&Material::specular_model, SpecularModel::blinn_phong_normalized)}},
    {"Blinn-Phong highlights", "not metallic-roughness", {shiny}, {physical}, {}},
    {"Blinn-Phong highlights", "lights", {shiny}, {no_suns}, {}},
    {"specular texture", "has one", {shiny}, {}, {specular_texture}},
    {"specular texture", "a specular color", {specular_texture}, {}, {shiny}},
    {"specular texture", "texture coordinates", {shiny, specular_texture}, {no_texcoords}, {}},
    {"specular texture", "lights", {shiny, specular_texture}, {no_suns}, {}},
    {"emission", "a channel", {}, {}, {emissive}},
    {"emission texture", "has one", {emissive}, {}, {emission_texture}},
    {"emission texture", "emission", {emission_texture}, {}, {emissive}},
    {"emission texture", "texture coordinates", {emissive, emission_texture}, {no_texcoords}, {}},
    {"mirror reflection", "reflectivity", {environment}, {}, {mirror}},
    {"mirror reflection", "an environment", {mirror}, {}, {environment}},
    {"mirror reflection", "not rough", {mirror, environment}, {rough}, {}},
    {"mirror reflection", "not metallic-roughness", {mirror, environment}, {physical}, {}},
    {"glossy reflection", "reflectivity", {environment, rough}, {}, {mirror}},
    {"glossy reflection", "rough", {mirror, environment}, {}, {rough}},
    {"glossy reflection", "an environment", {physical}, {}, {environment}},
    {"glossy reflection", "metallic-roughness", {environment}, {}, {physical}},
    {"Schlick's Fresnel",
     "two reflectivities",
     {mirror, environment},
     {with(&Material::grazing_reflectivity, faint)},
     {with(&Material::grazing_reflectivity, {0, 0.001F, 0.001F})}},
    {"Schlick's Fresnel", "its form", {mirror, environment}, {dielectric}, {}},
    {"Schlick's Fresnel", "an environment", {mirror}, {}, {environment}},
    {"Schlick's Fresnel", "not metallic-roughness", {mirror, environment}, {physical}, {}},
    {"dielectric Fresnel", "asked for", {mirror, environment}, {}, {dielectric}},
    {"dielectric Fresnel", "reflectivity", {environment, dielectric}, {}, {mirror}},
    {"conductor Fresnel", "asked for", {mirror, environment}, {}, {conductor}},
    {"conductor Fresnel", "an environment", {mirror, conductor}, {}, {environment}},
    {"highlight Fresnel", "the option", {shiny}, {}, {gleaming}},
    {"highlight Fresnel", "highlights", {gleaming}, {}, {shiny}},
    {"highlight Fresnel",
     "a color below white",
     {gleaming, with(&Material::specular, glm::vec3(1.0F))},
     {},
     {with(&Material::specular, glm::vec3(1, 1, 0.999F))}},
    {"reflection by normal", "the option", {environment, mirror}, {}, {by_normal}},
    {"reflection by normal", "a mirror", {environment, by_normal}, {}, {mirror}},
    {"environment tint", "the option", {environment}, {}, {tinted}},
    {"environment tint", "an environment", {tinted}, {}, {environment}},
    {"environment tint", "light", {environment, tinted}, {no_suns}, {}},
    {"environment tint", "ambient light", {environment, tinted, no_suns}, {}, {ambient}},
    {"environment tint", "highlights", {environment, tinted, black_surface}, {}, {shiny}},
    {"environment tint", "not metallic-roughness", {environment, tinted}, {physical}, {}},
    {"environment tint", "lit", {environment, tinted}, {unlit}, {}},
    {"environment rotation", "a tint", {environment, rotated}, {}, {tinted}},
    {"normal map", "a tint", {normal_map, environment, no_suns, ambient}, {}, {tinted}},
    {"clamped terms", "the option", {}, {}, {clamped}},
    {"clamped terms", "ambient light", {clamped, no_suns}, {}, {ambient}},
    {"clamped terms", "emission", {clamped, no_suns}, {}, {emissive}},
    {"clamped terms", "not metallic-roughness", {clamped}, {physical}, {}},
    {"clamped terms", "lit", {clamped}, {unlit}, {}},
    {"environment rotation", "a rotation", {environment, mirror}, {}, {rotated}},
    {"environment rotation", "a mirror", {environment, rotated}, {}, {mirror}},
    {"refraction", "transmission", {environment}, {}, {transmitting}},
    {"refraction", "an environment", {transmitting}, {}, {environment}},
    {"refraction", "not metallic-roughness", {environment, transmitting}, {physical}, {}},
};

const std::vector<Boundary> deformation_boundaries = {
    {"morphing", "a weight", {morph_target}, {}, {morphed}},
    {"morphing", "a target", {}, {morphed}, {morph_target, morphed}},
    {"skinning", "a joint that moves", {joints}, {}, {moved_joint}},
    {"deformed facets", "flat normals", {joints, moved_joint}, {}, {flat_normals}},
    {"deformed facets", "joints that move", {joints, flat_normals}, {}, {moved_joint}},
    {"deformed facets", "a morph target", {morph_target, flat_normals}, {}, {morphed}},
    {"deformed facets", "normals that show", {joints, moved_joint, flat_normals}, {no_suns}, {}},
    {"deformed facets", "normals of vertices", {joints, moved_joint, flat_normals}, {flat}, {}},
    {"deformed facets", "lit", {joints, moved_joint, flat_normals}, {unlit}, {}},
};

const std::vector<Boundary> frame_boundaries = {
    {"exposure", "not 1", {}, {}, {exposed}},
    {"exposure", "sRGB codes", {exposed}, {linear_output}, {}},
    {"exposure", "no finishing pass", {exposed}, {two_samples}, {}},
    {"exposure", "unlit", {unlit}, {}, {exposed}},
    {"exposure", "unlit in sRGB codes", {unlit, exposed}, {linear_output}, {}},
    {"ACES tone mapping", "unlit", {unlit}, {}, {aces}},
    {"Reinhard tone mapping", "its curve", {}, {aces}, {reinhard}},
    {"Reinhard tone mapping", "sRGB codes", {reinhard}, {linear_output}, {}},
    {"ACES tone mapping", "its curve", {}, {reinhard}, {aces}},
    {"ACES tone mapping", "asked for", {}, {}, {aces}},
    {"Khronos neutral tone mapping",
     "asked for",
     {},
     {aces},
     {with(&Scene::tone_mapping, ToneMapping::khronos_neutral)}},
    {"ACES Hill tone mapping",
     "asked for",
     {},
     {aces},
     {with(&Scene::tone_mapping, ToneMapping::aces_hill)}},
    {"boosted ACES Hill tone mapping",
     "asked for",
     {},
     {with(&Scene::tone_mapping, ToneMapping::aces_hill)},
     {with(&Scene::tone_mapping, ToneMapping::aces_hill_boost)}},
    {"skybox", "an environment", {}, {}, {environment, skybox}},
    {"skybox", "asked for", {environment}, {}, {skybox}},
    {"skybox", "not a debug view", {environment, skybox}, {view_of_data}, {}},
    {"prefiltered environment", "rough", {mirror, environment}, {}, {rough}},
    {"prefiltered environment", "a blurred skybox", {environment, skybox}, {}, {hazy}},
    {"blurred skybox", "its blur", {environment, skybox}, {}, {hazy}},
    {"blurred skybox", "a skybox", {environment, hazy}, {}, {skybox}},
    {"prefiltered environment", "lit", {physical, environment}, {unlit}, {}},
    {"environment BRDF table", "metallic-roughness", {mirror, environment, rough}, {}, {physical}},
    {"environment BRDF table", "an environment", {smooth_dielectric}, {}, {environment}},
    {"environment BRDF table", "light between facets", {smooth_dielectric}, {}, {metal}},
    {"environment irradiance",
     "an environment that is scattered",
     {},
     {environment},
     {environment, scattered}},
    {"environment irradiance",
     "a surface that scatters",
     {black_surface, environment, scattered},
     {},
     {scattering}},
    {"environment map", "seen itself", {environment}, {}, {skybox}},
    {"environment map", "mirrored", {environment}, {}, {mirror}},
    {"environment map", "refracted", {environment}, {}, {transmitting}},
    {"environment map", "a tint", {environment}, {}, {tinted}},
    {"environment map", "scattered", {environment}, {}, {scattered}},
    {"environment map", "blurred", {environment}, {}, {physical}},
    {"sorted blending", "not a mask", {translucent}, {masked}, {blended}},
    {"sorted blending", "opacity", {blended}, {}, {translucent}},
    {"finishing pass", "samples", {}, {}, {two_samples}},
    {"finishing pass", "blending", {translucent}, {}, {blended}},
    {"finishing pass", "not data", {two_samples}, {view_of_data}, {}},
};

/// Returns whether the effect is planned on one side of its boundary.
bool is_planned(const Boundary& boundary, const std::vector<Change>& side) {
    Frame frame;
    for (const Change& change : boundary.both)
        change(frame);
    for (const Change& change : side)
        change(frame);
    const FramePlan plan = plan_effects(frame.scene, frame.settings);
    const DrawPlan& draw = plan.draws.at(0);
    const auto effect =
        std::find_if(effects().begin(), effects().end(), [&](const Effect& candidate) {
            return std::string_view(candidate.name) == boundary.effect;
        });
    if (effect != effects().end()) {
        const bool is_on = effect->on(draw.features);
        // If there is a finishing pass, it applies exposure and tone mapping instead of the draw.
        if (!plan.finishing_pass) {
            EXPECT_EQ(reason(draw.reasons, boundary.effect).on, is_on);
        }
        return is_on;
    }
    if (std::string_view(boundary.effect) == "computed tangents") return draw.needs_tangents;
    return reason(plan.reasons, boundary.effect).on;
}

}  // namespace boundaries

TEST(EffectPlan, HasEachEffectOnOneSideOfEachPartOfItsCondition) {
    using namespace boundaries;
    std::set<std::string> tested;
    for (const auto* table : {&color_boundaries, &normal_boundaries, &light_boundaries,
                              &highlight_boundaries, &deformation_boundaries, &frame_boundaries}) {
        for (const Boundary& boundary : *table) {
            SCOPED_TRACE(std::string(boundary.effect) + ": " + boundary.condition);
            EXPECT_FALSE(is_planned(boundary, boundary.off));
            EXPECT_TRUE(is_planned(boundary, boundary.on));
            tested.insert(boundary.effect);
        }
    }
    const FramePlan plan = plan_effects(lit_scene(gray()), {.samples = 1});
    for (const std::vector<EffectReason>& reasons :
         {EffectReasons(plan.draws.at(0).reasons), EffectReasons(plan.reasons)}) {
        for (const EffectReason& entry : reasons)
            EXPECT_TRUE(tested.count(entry.effect)) << entry.effect;
    }
}

TEST(EffectPlan, FollowsPosesUnlessTheirEffectsAreForced) {
    Scene scene = lit_scene(gray());
    scene.instances[0].pose.emplace().joint_matrices.assign(1, glm::mat4(1.0F));
    const FrameSettings settings{.samples = 1};
    FramePlan plan = plan_effects(scene, settings);
    const FramePlan at_rest = plan;
    FramePlan without = force_effects(scene, settings, plan, {{}, {{"skinning", false}}});
    FramePlan with = force_effects(scene, settings, plan, {{}, {{"skinning", true}}});
    scene.instances[0].pose->joint_matrices[0][3].x = 1.0F;
    for (FramePlan* each : {&plan, &without, &with})
        plan_pose(scene, *each);
    EXPECT_TRUE(plan.draws[0].features.skinning);
    EXPECT_EQ(plan.draws[0].features, plan_effects(scene, settings).draws[0].features);
    EXPECT_EQ(reason(plan.draws[0].reasons, "skinning").reason, "joints move the vertices");
    EXPECT_FALSE(without.draws[0].features.skinning);
    scene.instances[0].pose->joint_matrices[0] = glm::mat4(1.0F);
    for (FramePlan* each : {&plan, &with})
        plan_pose(scene, *each);
    EXPECT_EQ(plan.draws[0].features, at_rest.draws[0].features);
    EXPECT_TRUE(with.draws[0].features.skinning);
}

TEST(EffectPlan, NamesTheReason) {
    using namespace boundaries;
    struct Decision {
        const char* effect;
        std::vector<Change> changes;
        const char* reason;
    };
    const std::vector<Decision> decisions = {
        {"alpha mask", {}, "material 'body' is opaque"},
        {"alpha mask", {masked}, "material 'body' is covered everywhere"},
        {"alpha mask",
         {masked, translucent},
         "material 'body' has holes where alpha is below its cutoff"},
        {"alpha blending", {blended}, "material 'body' is covered everywhere"},
        {"alpha blending",
         {blended, translucent},
         "material 'body' is blended with what is behind it"},
        {"no falloff", {constant_light}, "no light falls off with distance"},
        {"no falloff", {point_light}, "every light falls off with the squared distance"},
        {"no falloff", {point_light, constant_light}, "some lights fall off with distance"},
        {"mixed falloff", {point_light}, "all lights follow one law"},
        {"mixed falloff", {constant_light}, "all lights follow one law"},
        {"mixed falloff",
         {point_light, constant_light},
         "some lights fall off with distance and some do not"},
        {"morphing", {}, "the mesh has no morph targets"},
        {"morphing", {morph_target}, "the weights of all morph targets are 0"},
        {"morphing", {morph_target, morphed}, "morph targets with a weight: 1 of 1"},
        {"skinning", {morph_target}, "the mesh has no joints"},
        {"skinning", {joints}, "all joints are at rest"},
        {"skinning", {joints, moved_joint}, "joints move the vertices"},
        {"ambient", {}, "the scene has no ambient light"},
        {"ambient", {ambient}, "material 'body' scatters ambient light"},
        {"ambient", {ambient, black_surface}, "material 'body' scatters none"},
        {"ambient", {ambient, black_surface, physical}, "material 'body' scatters ambient light"},
        {"dielectric reflectance", {}, "material 'body' is Phong's model"},
        {"dielectric reflectance", {no_metal}, "material 'body' reflects the 4% of the index 1.5"},
        {"dielectric reflectance",
         {denser},
         "material 'body' has an index, weight or color of its own"},
        {"dielectric reflectance",
         {denser, with(&MetallicRoughness::metallic, 1.0F)},
         "material 'body' is a metal everywhere"},
        {"energy compensation", {}, "material 'body' is Phong's model"},
        {"energy compensation",
         {smooth_dielectric},
         "material 'body' is a smooth dielectric, which loses less than 1% of what it mirrors"},
        {"energy compensation",
         {physical},
         "material 'body' loses light that bounces between its facets"},
        {"energy compensation",
         {physical, no_suns, ambient},
         "the material is not metallic-roughness, or reflects nothing"},
        {"sheen", {}, "material 'body' has none"},
        {"sheen", {sheen}, "material 'body' has a sheen color"},
        {"sheen",
         {sheen, no_suns},
         "the material is not metallic-roughness, or no light reaches it"},
        {"clearcoat", {clearcoat}, "material 'body' has a clear coat"},
        {"environment light", {}, "the scene has no environment"},
        {"environment light", {environment}, "the environment does not light surfaces"},
        {"environment light", {environment, scattered, black_surface}, "material 'body' is black"},
        {"environment rotation", {}, "the scene has no environment"},
        {"environment rotation", {environment, mirror}, "the environment is not rotated"},
        {"environment rotation", {environment, mirror, rotated}, "the environment is rotated"},
        {"environment rotation",
         {environment, rotated},
         "the surface neither mirrors the environment nor refracts it"},
        {"refraction", {}, "material 'body' transmits no light"},
        {"refraction", {transmitting}, "the scene has no environment"},
        {"mirror reflection", {}, "material 'body' reflects nothing"},
        {"mirror reflection", {mirror}, "the scene has no environment"},
        {"ACES tone mapping", {}, "radiance above 1 is shown as 1"},
        {"ACES tone mapping", {reinhard}, "the scene requests another curve"},
    };
    for (const Decision& decision : decisions) {
        Frame frame;
        for (const Change& change : decision.changes)
            change(frame);
        const FramePlan plan = plan_effects(frame.scene, frame.settings);
        EXPECT_EQ(reason(plan.draws.at(0).reasons, decision.effect).reason, decision.reason);
    }
}

}  // namespace
}  // namespace relief
