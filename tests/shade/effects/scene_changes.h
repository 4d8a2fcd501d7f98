// SPDX-License-Identifier: Apache-2.0
/// \file
/// A scene with one draw, and changes of it that need effects or do without them.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <type_traits>
#include <vector>

#include "relief/shade/effects.h"
#include "shade/effects/feature_sets.h"

namespace relief::test::changes {

/// A scene with one draw, and the settings of its frame.
struct Frame {
    shade::Scene scene = lit_scene(gray());
    shade::FrameSettings settings{.samples = 1};

    Material& material() { return scene.materials[0]; }
    Mesh& mesh() { return scene.meshes[0].edit(); }
};

using Change = std::function<void(Frame&)>;
using Sun = shade::DirectionalLight;

template <typename T>
Change with(T Material::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.material().*member = value; };
}
template <typename T>
Change with(T shade::Scene::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.scene.*member = value; };
}
template <typename T>
Change with(T shade::FrameSettings::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.settings.*member = value; };
}
template <typename T>
Change with_sun(T Sun::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.scene.directional_lights[0].*member = value; };
}
template <typename T>
Change with_point_light(T shade::PointLight::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.scene.point_lights[0].*member = value; };
}
template <typename T>
Change with_spot(T shade::PointLight::*member, std::type_identity_t<T> value) {
    return [=](Frame& f) { f.scene.spot_lights[0].point.*member = value; };
}
inline Change with_suns(std::size_t count) {
    return [=](Frame& f) { f.scene.directional_lights.resize(count); };
}
inline Change with_colors(const glm::vec4& color) {
    return [=](Frame& f) { f.mesh().colors.assign(4, color); };
}
inline Change with_last_color(const glm::vec4& color) {
    return [=](Frame& f) { f.mesh().colors.back() = color; };
}

inline const glm::vec3 black{0.0F};
inline const glm::vec3 faint{0, 0, 0.001F};

inline const Change unlit = with(&Material::unlit, true);
inline const Change physical = with(&Material::metallic_roughness, MetallicRoughness{});
inline const Change physical_texture = [](Frame& f) {
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
inline const Change smooth_dielectric = [](Frame& f) {
    MetallicRoughness& model = f.material().metallic_roughness.emplace();
    model.metallic = 0.0F;
    model.roughness = 0.05F;
};
inline const Change no_metal = with(&MetallicRoughness::metallic, 0.0F);
inline const Change denser = with(&MetallicRoughness::refractive_index, 1.501F);
inline const Change sheen = with(&MetallicRoughness::sheen_color, {0, 0, 0.001F});
inline const Change clearcoat = with(&MetallicRoughness::clearcoat, 0.001F);
inline const Change brushed = with(&MetallicRoughness::anisotropy, 0.001F);
inline const Change filmy = with(&MetallicRoughness::iridescence, 0.001F);
inline const Change specular_weight = with(&MetallicRoughness::specular_texture, Texture{});
inline const Change specular_color = with(&MetallicRoughness::specular_color_texture, Texture{});
inline const Change sheen_texture = with(&MetallicRoughness::sheen_color_texture, Texture{});
inline const Change sheen_roughness = with(&MetallicRoughness::sheen_roughness_texture, Texture{});
inline const Change coat_texture = with(&MetallicRoughness::clearcoat_texture, Texture{});
inline const Change coat_roughness =
    with(&MetallicRoughness::clearcoat_roughness_texture, Texture{});
inline const Change coat_map = with(&MetallicRoughness::clearcoat_normal_map, NormalMap{});
inline const Change brush_texture = with(&MetallicRoughness::anisotropy_texture, Texture{});
inline const Change film_texture = with(&MetallicRoughness::iridescence_texture, Texture{});
inline const Change thickness_texture =
    with(&MetallicRoughness::iridescence_thickness_texture, Texture{});
inline const Change clear = with(&MetallicRoughness::transmission, 0.001F);
inline const Change thick = with(&MetallicRoughness::thickness, 0.001F);
inline const Change dispersive = with(&MetallicRoughness::dispersion, 0.001F);
inline const Change index_1 = with(&MetallicRoughness::refractive_index, 1.0F);
inline const Change clear_texture = with(&MetallicRoughness::transmission_texture, Texture{});
inline const Change volume_texture = with(&MetallicRoughness::thickness_texture, Texture{});
inline const Change metal = with(&MetallicRoughness::metallic, 1.0F);
inline const Change gouraud = with(&Material::interpolation, Interpolation::gouraud);
inline const Change flat = with(&Material::interpolation, Interpolation::flat);
inline const Change black_surface = [](Frame& f) {
    f.material().diffuse = f.material().ambient = black;
};
inline const Change scattering = with(&Material::diffuse, faint);
inline const Change shiny = with(&Material::specular, faint);
inline const Change by_normal = with(&Material::reflection_by_normal, true);
inline const Change tinted = with(&Material::environment_tint, true);
inline const Change gleaming = with(&Material::highlight_fresnel, true);
inline const Change phong = with(&Material::specular_model, SpecularModel::phong);
inline const Change emissive = with(&Material::emission, faint);
inline const Change mirror = with(&Material::reflectivity, faint);
inline const Change rough = with(&Material::reflection_roughness, 0.001F);
inline const Change dielectric = with(&Material::fresnel, FresnelModel::dielectric);
inline const Change conductor = with(&Material::fresnel, FresnelModel::conductor);
inline const Change transmitting = with(&Material::transmission, 0.001F);
inline const Change translucent = with(&Material::opacity, 0.999F);
inline const Change masked = with(&Material::alpha_mode, AlphaMode::mask);
inline const Change blended = with(&Material::alpha_mode, AlphaMode::blend);
inline const Change double_sided = with(&Material::double_sided, true);
inline const Change antialiased = with(&Material::specular_antialiasing, true);
inline const Change derivative_frames = with(&Material::tangent_frame, TangentFrame::derivatives);
inline const Change diffuse_texture = with(&Material::diffuse_texture, Texture{});
inline const Change specular_texture = with(&Material::specular_texture, Texture{});
inline const Change emission_texture = with(&Material::emission_texture, Texture{});
inline const Change occlusion_texture = with(&Material::occlusion_texture, Texture{});
inline const Change opacity_texture = with(&Material::opacity_texture, Texture{});
inline const Change normal_map = with(&Material::normal_map, NormalMap{});
inline const Change object_map = [](Frame& f) {
    f.material().normal_map = NormalMap{};
    f.material().normal_map->space = NormalSpace::object;
};
inline const Change bump_map = with(&Material::bump_map, BumpMap{});

/// A relief by this method.
inline Change relief(HeightMethod method) {
    return [method](Frame& f) {
        ReliefMap map;
        map.method = method;
        map.cones = Texture{};
        f.material().height_map = map;
    };
}
inline const Change maximum_mipmaps = [](Frame& f) { relief(HeightMethod::maximum_mipmaps)(f); };
inline const Change relief_by_cones = [](Frame& f) { relief(HeightMethod::relaxed_cones)(f); };
inline const Change no_cones = [](Frame& f) { f.material().height_map->cones.reset(); };
inline const Change self_shadow = [](Frame& f) { f.material().height_map->self_shadow = true; };
inline const Change clipped_relief = [](Frame& f) {
    f.material().height_map->silhouette = ReliefSilhouette::clip;
};
inline const Change curved_relief = [](Frame& f) {
    f.material().height_map->silhouette = ReliefSilhouette::curve;
};
inline const Change bent_normals = [](Frame& f) {
    f.mesh().normals.at(0) = glm::normalize(glm::vec3(0.3F, 0.0F, 1.0F));
};
inline const Change clamped_heights = [](Frame& f) {
    f.material().height_map->texture.wrap_v = Wrap::clamp;
};
inline const Change written_depth = [](Frame& f) { f.material().height_map->write_depth = true; };
inline const Change no_depth = [](Frame& f) { f.material().height_map->depth = 0.0F; };

inline const Change second_texcoords = [](Frame& f) { f.mesh().texcoords_2.resize(4); };
inline const Change no_texcoords = [](Frame& f) { f.mesh().texcoords.clear(); };
inline const Change stored_tangents = [](Frame& f) { f.mesh().tangents.assign(4, {1, 0, 0, 1}); };

inline const Change ambient = with(&shade::Scene::ambient, faint);
inline const Change clamped = with(&shade::Scene::clamp_terms, true);
inline const Change no_suns = with(&shade::Scene::directional_lights, {});
inline const Change point_light = [](Frame& f) {
    f.scene.point_lights.push_back({{0, 0, 1}, faint});
};
inline const Change constant_light = [](Frame& f) {
    f.scene.point_lights.push_back({{0, 0, 1}, faint, std::nullopt, shade::Falloff::none});
};
inline const Change black_point_light = with_point_light(&shade::PointLight::intensity, black);
inline const Change black_second_light = [](Frame& f) {
    f.scene.point_lights[1].intensity = black;
};
inline const Change spot_light = [](Frame& f) {
    f.scene.spot_lights.push_back({{{0, 0, 1}, faint}});
};
/// An environment that is neither visible itself nor scattered.
inline const Change environment = with(
    &shade::Scene::environment, shade::Environment{shade::Equirectangular{}, 1.0F, false, false});
inline const Change rotated = [](Frame& f) { f.scene.environment->rotation = 0.001F; };
inline const Change skybox = [](Frame& f) { f.scene.environment->skybox = true; };
inline const Change hazy = [](Frame& f) { f.scene.environment->skybox_blur = 0.001F; };
inline const Change scattered = [](Frame& f) { f.scene.environment->lights = true; };

inline const Change morph_target = [](Frame& f) {
    shade::MeshPose& pose = f.scene.instances[0].pose.emplace();
    pose.deformation.edit().targets.resize(1);
    pose.deformation.edit().targets[0].positions.assign(4, {0, 0, 1});
    pose.weights = {0.0F};
};
inline const Change morphed = [](Frame& f) {
    if (!f.scene.instances[0].pose) f.scene.instances[0].pose.emplace();
    f.scene.instances[0].pose->weights = {0.001F};
};
inline const Change joints = [](Frame& f) {
    shade::MeshPose& pose = f.scene.instances[0].pose.emplace();
    pose.joint_matrices.assign(2, glm::mat4(1.0F));
};
inline const Change moved_joint = [](Frame& f) {
    f.scene.instances[0].pose->joint_matrices[1][3].x = 0.001F;
};
inline const Change flat_normals = [](Frame& f) {
    f.scene.instances[0].pose->has_flat_normals = true;
};

inline const Change shadowed = with(&shade::Scene::shadow, shade::Shadow{});
/// A point light at this share of the radius of the mesh from its middle.
inline Change with_light_at(float share) {
    return [=](Frame& f) {
        const Bounds bounds = shade::world_bounds(f.scene);
        const glm::vec3 middle = 0.5F * (bounds.min + bounds.max);
        const float radius = 0.5F * glm::distance(bounds.min, bounds.max);
        f.scene.point_lights.push_back({middle + glm::vec3(0, 0, share * radius), faint});
    };
}

inline Change with_last_share(float share) {
    return [=](Frame& f) {
        f.scene.instances[0].open_shares = std::vector{1.0F, 1.0F, 1.0F, share};
    };
}

inline const Change exposed = with(&shade::Scene::exposure, 0.999F);
inline const Change reinhard = with(&shade::Scene::tone_mapping, shade::ToneMapping::reinhard);
inline const Change aces = with(&shade::Scene::tone_mapping, shade::ToneMapping::aces);
inline const Change linear_output =
    with(&shade::FrameSettings::output, shade::OutputCoding::linear);
inline const Change two_samples = with(&shade::FrameSettings::samples, 2);
inline const Change view_of_data =
    with(&shade::FrameSettings::view, shade::DebugView::shading_normal);

}  // namespace relief::test::changes
