// SPDX-License-Identifier: Apache-2.0
// Tests: tests/tools/window/saving_test.cpp.
#include "scene/json_values.h"

#include <fmt/format.h>

#include <cstdlib>

#include "scene/json_words.h"

namespace relief {
namespace {

template <typename Value, typename ToJson>
Json optional(const std::optional<Value>& value, const ToJson& to_json) {
    return value ? to_json(*value) : Json(nullptr);
}

Json texture_json(const Texture& texture, const ImageName& name) {
    return {{"image", name(texture.image)},
            {"wrap_u", word_for(texture.wrap_u, wrap_words)},
            {"wrap_v", word_for(texture.wrap_v, wrap_words)},
            {"filter", word_for(texture.filter, filter_words)}};
}

Json normal_map_json(const NormalMap& map, const ImageName& name) {
    Json json = {{"texture", texture_json(map.texture, name)},
                 {"scale", json_number(map.scale)},
                 {"green", word_for(map.green, green_words)},
                 {"space", word_for(map.space, normal_space_words)}};
    if (map.flat) json["zero_code"] = word_for(*map.flat, zero_code_words);
    return json;
}

Json model_json(const MetallicRoughness& model, const ImageName& name) {
    return {{"base_color", json_vector(model.base_color)},
            {"metallic", json_number(model.metallic)},
            {"roughness", json_number(model.roughness)},
            {"texture",
             optional(model.texture, [&](const Texture& t) { return texture_json(t, name); })}};
}

void add_point(Json& json, const PointLight& light) {
    json["position"] = json_vector(light.position_world);
    json["color"] = json_vector(light.intensity);
    if (light.highlight_intensity) json["specular"] = json_vector(*light.highlight_intensity);
    json["falloff"] = word_for(light.falloff, falloff_words);
    if (light.range) json["range"] = json_number(*light.range);
}

}  // namespace

Json json_number(float value) {
    return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

Json json_vector(const glm::vec3& value) {
    return Json::array({json_number(value.x), json_number(value.y), json_number(value.z)});
}

Json json_degrees(float radians) {
    constexpr int usual_digits = 6;
    constexpr int digits_of_double = 17;
    const double degrees = glm::degrees(static_cast<double>(radians));
    for (int digits = usual_digits;; ++digits) {
        const double rounded =
            std::strtod(fmt::format("{:.{}g}", degrees, digits).c_str(), nullptr);
        if (static_cast<float>(glm::radians(rounded)) == radians || digits == digits_of_double)
            return rounded;
    }
}

Json material_json(const Material& m, const ImageName& name) {
    const auto texture = [&](const std::optional<Texture>& value) {
        return optional(value, [&](const Texture& t) { return texture_json(t, name); });
    };
    return {
        {"name", m.name},
        {"interpolation", word_for(m.interpolation, interpolation_words)},
        {"ambient", json_vector(m.ambient)},
        {"diffuse", json_vector(m.diffuse)},
        {"specular", json_vector(m.specular)},
        {"emission", json_vector(m.emission)},
        {"shininess", json_number(m.shininess)},
        {"specular_model", word_for(m.specular_model, specular_model_words)},
        {"metallic_roughness",
         optional(m.metallic_roughness,
                  [&](const auto& model) { return model_json(model, name); })},
        {"reflectivity", json_vector(m.reflectivity)},
        {"grazing_reflectivity", json_vector(m.grazing_reflectivity)},
        {"fresnel", word_for(m.fresnel, fresnel_words)},
        {"refractive_index", json_number(m.refractive_index)},
        {"conductor_index", json_vector(m.conductor_index)},
        {"conductor_absorption", json_vector(m.conductor_absorption)},
        {"reflection_roughness", json_number(m.reflection_roughness)},
        {"transmission", json_number(m.transmission)},
        {"diffuse_texture", texture(m.diffuse_texture)},
        {"specular_texture", texture(m.specular_texture)},
        {"emission_texture", texture(m.emission_texture)},
        {"occlusion_texture", texture(m.occlusion_texture)},
        {"occlusion_strength", json_number(m.occlusion_strength)},
        {"opacity_texture", texture(m.opacity_texture)},
        {"normal_map",
         optional(m.normal_map, [&](const NormalMap& map) { return normal_map_json(map, name); })},
        {"bump_map", optional(m.bump_map,
                              [&](const BumpMap& map) {
                                  return Json{{"texture", texture_json(map.texture, name)},
                                              {"strength", json_number(map.strength)}};
                              })},
        {"tangent_frame", word_for(m.tangent_frame, tangent_frame_words)},
        {"specular_antialiasing", m.specular_antialiasing},
        {"alpha_mode", word_for(m.alpha_mode, alpha_mode_words)},
        {"opacity", json_number(m.opacity)},
        {"alpha_cutoff", json_number(m.alpha_cutoff)},
        {"double_sided", m.double_sided},
        {"unlit", m.unlit},
    };
}

Json lights_json(const Scene& scene) {
    Json lights = Json::array();
    for (const DirectionalLight& light : scene.directional_lights) {
        Json json = {{"type", "directional"},
                     {"direction", json_vector(light.direction_world)},
                     {"color", json_vector(light.irradiance)}};
        if (light.highlight_irradiance) json["specular"] = json_vector(*light.highlight_irradiance);
        lights.push_back(std::move(json));
    }
    for (const PointLight& light : scene.point_lights) {
        Json json = {{"type", "point"}};
        add_point(json, light);
        lights.push_back(std::move(json));
    }
    for (const SpotLight& light : scene.spot_lights) {
        Json json = {{"type", "spot"},
                     {"direction", json_vector(light.direction_world)},
                     {"inner_cone", json_degrees(light.inner_cone)},
                     {"outer_cone", json_degrees(light.outer_cone)}};
        add_point(json, light.point);
        lights.push_back(std::move(json));
    }
    return lights;
}

Json environment_json(const Environment& environment, const SourceName& name) {
    Json json;
    if (const auto* cube = std::get_if<CubeFaces>(&environment.source)) {
        json["faces"] = Json::array();
        for (const ImageSource& face : cube->faces)
            json["faces"].push_back(name(face));
        json["left_handed"] = cube->left_handed;
    } else if (const auto* cross = std::get_if<CubeCross>(&environment.source)) {
        json["cross"] = name(cross->image);
    } else if (const auto* panorama = std::get_if<Equirectangular>(&environment.source)) {
        json["panorama"] = name(panorama->image);
    } else {
        json["angular_map"] = name(std::get<AngularMap>(environment.source).image);
    }
    json["intensity"] = json_number(environment.intensity);
    json["skybox"] = environment.skybox;
    json["lights"] = environment.lights;
    return json;
}

Json camera_json(const Camera& camera) {
    Json matrix = Json::array();
    for (int i = 0; i < 16; ++i)
        matrix.push_back(json_number(camera.world_from_view[i / 4][i % 4]));
    return {{"matrix", std::move(matrix)},
            {"fov", json_degrees(camera.vertical_fov)},
            {"near", json_number(camera.near)},
            {"far", json_number(camera.far)}};
}

}  // namespace relief
