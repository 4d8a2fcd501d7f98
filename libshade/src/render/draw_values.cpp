// SPDX-License-Identifier: Apache-2.0
// Uniform values of materials, matrices and cameras, computed in double and rounded once; buffers
// of lights. Tests: tests/shade/render/draw_values_test.cpp.
#include "render/draw_values.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>

#include "effects/light_rows.h"
#include "environment/convolution.h"
#include "portable_math.h"
#include "render/program_cache.h"
#include "scene/scene_parts.h"

namespace relief::shade::detail {
using namespace relief::detail;

namespace {

using Setter = bool (*)(const gl::LinkedProgram&, std::string_view, const DrawValues&);

template <auto Member>
bool set_member(const gl::LinkedProgram& program, std::string_view name, const DrawValues& values) {
    return program.set(name, values.*Member);
}

/// A forced lookup without a texture has the weight 0 for these rows, whatever they are.
bool set_sheen_rows(const gl::LinkedProgram& program, std::string_view name,
                    const DrawValues& values) {
    return values.sheen_albedo_rows == nullptr || program.set(name, *values.sheen_albedo_rows);
}

/// Sets the uniform of a factor of glTF's model, by its place among the fields.
template <std::size_t Place>
bool set_factor(const gl::LinkedProgram& program, std::string_view name, const DrawValues& values) {
    return program.set(name, values.model.*std::get<Place>(fields_of<MetallicRoughness>).member);
}

template <std::size_t... Places>
void add_factors(std::map<std::string_view, Setter>& setters, std::index_sequence<Places...>) {
    const auto add = [&]<std::size_t Place>(std::integral_constant<std::size_t, Place>) {
        constexpr auto field = std::get<Place>(fields_of<MetallicRoughness>);
        using Value = decltype(field.default_value());
        if constexpr (std::is_same_v<Value, float> || std::is_same_v<Value, glm::vec3>)
            setters.emplace(field.name, set_factor<Place>);
    };
    (add(std::integral_constant<std::size_t, Places>()), ...);
}

std::map<std::string_view, Setter> member_setters() {
    return {
        {"clip_from_object", set_member<&DrawValues::clip_from_object>},
        {"world_from_object", set_member<&DrawValues::world_from_object>},
        {"world_from_object_normal", set_member<&DrawValues::world_from_object_normal>},
        {"world_from_object_tangent", set_member<&DrawValues::world_from_object_tangent>},
        {"handedness", set_member<&DrawValues::handedness>},
        {"eye_world", set_member<&DrawValues::eye_world>},
        {"joint_pairs", set_member<&DrawValues::joint_pairs>},
        {"morph_layout", set_member<&DrawValues::morph_layout>},
        {"ambient_scattered", set_member<&DrawValues::ambient_scattered>},
        {"diffuse_color", set_member<&DrawValues::diffuse_color>},
        {"specular_color", set_member<&DrawValues::specular_color>},
        {"specular_gain", set_member<&DrawValues::specular_gain>},
        {"shininess", set_member<&DrawValues::shininess>},
        {"emission_color", set_member<&DrawValues::emission_color>},
        {"dielectric_color", set_member<&DrawValues::dielectric_color>},
        {"dielectric_weight", set_member<&DrawValues::dielectric_weight>},
        {"energy_compensation", set_member<&DrawValues::energy_compensation>},
        {"sheen_alpha", set_member<&DrawValues::sheen_alpha>},
        {"sheen_albedo", set_member<&DrawValues::sheen_albedo>},
        {"clearcoat_normal_scale", set_member<&DrawValues::clearcoat_normal_scale>},
        {"clearcoat_normal_bias", set_member<&DrawValues::clearcoat_normal_bias>},
        {"anisotropy_direction", set_member<&DrawValues::anisotropy_direction>},
        {"clip_from_world", set_member<&DrawValues::clip_from_world>},
        {"object_scale", set_member<&DrawValues::object_scale>},
        {"absorption", set_member<&DrawValues::absorption>},
        {"volume_index_ratio", set_member<&DrawValues::volume_index_ratio>},
        {"blurred_level", set_member<&DrawValues::blurred_level>},
        {"background_radiance", set_member<&DrawValues::background_radiance>},
        {"occlusion_strength", set_member<&DrawValues::occlusion_strength>},
        {"opacity", set_member<&DrawValues::opacity>},
        {"alpha_cutoff", set_member<&DrawValues::alpha_cutoff>},
        {"reflectivity", set_member<&DrawValues::reflectivity>},
        {"grazing_reflectivity", set_member<&DrawValues::grazing_reflectivity>},
        {"refractive_index", set_member<&DrawValues::refractive_index>},
        {"refraction_ratio", set_member<&DrawValues::refraction_ratio>},
        {"conductor_index", set_member<&DrawValues::conductor_index>},
        {"conductor_absorption", set_member<&DrawValues::conductor_absorption>},
        {"reflection_roughness", set_member<&DrawValues::reflection_roughness>},
        {"transmission", set_member<&DrawValues::transmission>},
        {"environment_intensity", set_member<&DrawValues::environment_intensity>},
        {"environment_turn", set_member<&DrawValues::environment_turn>},
        {"blurred_levels", set_member<&DrawValues::blurred_levels>},
        {"irradiance_sh", set_member<&DrawValues::irradiance_sh>},
        {"normal_map_scale", set_member<&DrawValues::normal_map_scale>},
        {"normal_map_bias", set_member<&DrawValues::normal_map_bias>},
        {"normal_map_unscale", set_member<&DrawValues::normal_map_unscale>},
        {"normal_map_rounding", set_member<&DrawValues::normal_map_rounding>},
        {"bump_strength", set_member<&DrawValues::bump_strength>},
        {"height_depth", set_member<&DrawValues::height_depth>},
        {"height_layers", set_member<&DrawValues::height_layers>},
        {"height_bisections", set_member<&DrawValues::height_bisections>},
        {"height_steps", set_member<&DrawValues::height_steps>},
        {"exposure", set_member<&DrawValues::exposure>},
        {"shadow_from_object", set_member<&DrawValues::shadow_from_object>},
        {"shadow_from_world", set_member<&DrawValues::shadow_from_world>},
        {"shadow_lift", set_member<&DrawValues::shadow_lift>},
        {"shadow_shift", set_member<&DrawValues::shadow_shift>},
        {"shadow_samples", set_member<&DrawValues::shadow_samples>},
        {"shadow_points", set_member<&DrawValues::shadow_points>},
        {"sheen_roughness", set_member<&DrawValues::sheen_roughness>},
        {"sheen_albedo_rows", set_sheen_rows},
    };
}

const std::map<std::string_view, Setter>& setters() {
    static const auto all = [] {
        std::map<std::string_view, Setter> result = member_setters();
        constexpr auto count =
            std::tuple_size_v<std::decay_t<decltype(fields_of<MetallicRoughness>)>>;
        add_factors(result, std::make_index_sequence<count>());
        return result;
    }();
    return all;
}

/// Returns a matrix scaled to a largest element of 1, so that directions stay in the range of
/// float.
glm::mat3 scaled_to_one(const glm::dmat3& matrix) {
    double largest = 0.0;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            largest = std::max(largest, std::abs(matrix[column][row]));
        }
    }
    return largest > 0.0 ? glm::mat3(matrix / largest) : glm::mat3(0.0F);
}

/// Returns the reflectance of a dielectric at normal incidence times its color, without a limit.
glm::vec3 reflectance_of_index(const MetallicRoughness& model) {
    const double n = static_cast<double>(model.refractive_index);
    const double root = (n - 1.0) / (n + 1.0);
    return glm::vec3(root * root * glm::dvec3(model.specular_color));
}

/// Returns the share of the roughness by which light that passes a surface is blurred: none without
/// refraction.
double passing_blur(double index) {
    return index > 0.0 ? std::clamp(2.0 * index - 2.0, 0.0, 1.0) : 1.0;
}

/// Returns the logarithm of the attenuation of a unit of length. Colors count as at least 1e-6.
double absorption(double color, double distance) {
    return -portable::log(std::max(color, 1e-6)) / distance;
}

double cube_root_of_determinant(const glm::dmat3& matrix) {
    const double determinant = std::abs(glm::determinant(matrix));
    return determinant > 0.0 ? portable::exp(portable::log(determinant) / 3.0) : 0.0;
}

/// \param last  the last level of the picture behind
void set_transmission(DrawValues& values, const MetallicRoughness& model, int last) {
    const double index = static_cast<double>(model.refractive_index);
    values.transmission = model.transmission;
    values.volume_index_ratio = index > 0.0 ? static_cast<float>(1.0 / index) : 0.0F;
    values.blurred_level = static_cast<float>(last * passing_blur(index));
    if (!model.attenuation_distance) return;
    for (int i = 0; i < 3; ++i) {
        values.absorption[i] =
            static_cast<float>(absorption(static_cast<double>(model.attenuation_color[i]),
                                          static_cast<double>(*model.attenuation_distance)));
    }
}

/// Writes a table from the vector `first` on.
template <std::size_t Size>
void write_table(const SheenAlbedo& table, std::size_t first, std::array<glm::vec4, Size>& rows) {
    for (std::size_t i = 0; i < table.size(); ++i)
        rows.at(first + i / 4)[static_cast<int>(i % 4)] = static_cast<float>(table[i]);
}

/// Without a color, the table stays zero: nothing reads it.
void set_sheen(DrawValues& values, const MetallicRoughness& model) {
    if (!is_not_black(model.sheen_color)) return;
    const double roughness = static_cast<double>(model.sheen_roughness);
    values.sheen_alpha = static_cast<float>(sheen_alpha(roughness));
    values.sheen_roughness = model.sheen_roughness;
    write_table(sheen_albedo_table(roughness), 0, values.sheen_albedo);
}

}  // namespace

std::shared_ptr<const SheenRows> SheenCache::get(float roughness) {
    std::shared_ptr<const SheenRows>& entry = rows_[roughness];
    if (!entry) {
        const SheenAlbedos tables = sheen_albedo_tables(static_cast<double>(roughness));
        auto rows = std::make_shared<SheenRows>();
        for (std::size_t j = 0; j + 1 < tables.size(); ++j)
            write_table(tables[j], 8 * j, *rows);
        entry = std::move(rows);
    }
    return entry;
}

void SheenCache::drop_unused() {
    std::erase_if(rows_, [](const auto& entry) { return entry.second.use_count() == 1; });
}

bool set_uniform(const gl::LinkedProgram& program, std::string_view name,
                 const DrawValues& values) {
    const auto setter = setters().find(name);
    return setter != setters().end() && setter->second(program, name, values);
}

glm::vec2 environment_turn(const Environment& environment) {
    const auto rotation = static_cast<double>(environment.rotation);
    return {portable::cos(rotation), portable::sin(rotation)};
}

void set_material(DrawValues& values, const Material& material, const Scene& scene, int last) {
    const glm::vec3 ambient = ambient_light(scene);
    values.ambient_scattered = material.ambient * ambient;
    values.diffuse_color = material.diffuse;
    values.specular_color = material.specular * specular_normalization(material);
    if (material.highlight_fresnel) {
        values.specular_gain =
            glm::max(1.0F - material.specular, glm::vec3(0.0F)) * specular_normalization(material);
    }
    values.shininess = material.shininess;
    values.emission_color = material.emission;
    if (const auto& physical = material.metallic_roughness) {
        values.ambient_scattered = ambient;
        values.model = *physical;
        values.diffuse_color = physical->base_color;
        values.dielectric_color = reflectance_of_index(*physical);
        values.dielectric_weight = physical->specular;
        values.energy_compensation = compensates_energy(*physical) ? 1.0F : 0.0F;
        set_sheen(values, *physical);
        const double rotation = static_cast<double>(physical->anisotropy_rotation);
        values.anisotropy_direction = glm::vec2(portable::cos(rotation), portable::sin(rotation));
        set_transmission(values, *physical, last);
    }
    values.background_radiance = glm::vec3(scene.background) * scene.background.a;
    values.occlusion_strength = material.occlusion_texture ? material.occlusion_strength : 0.0F;
    values.opacity = material.alpha_mode == AlphaMode::opaque ? 1.0F : material.opacity;
    values.alpha_cutoff = material.alpha_mode == AlphaMode::mask ? material.alpha_cutoff : 0.0F;
    if (material.bump_map) values.bump_strength = material.bump_map->strength;
    if (const auto& map = material.height_map) {
        values.height_depth = map->depth;
        values.height_layers = static_cast<float>(map->layers);
        values.height_bisections = static_cast<float>(map->bisections);
        values.height_steps = static_cast<float>(map->max_steps);
    }
    values.exposure = scene.exposure;
    if (!scene.environment) return;
    values.environment_intensity = scene.environment->intensity;
    if (scene.environment->rotation != 0.0F)
        values.environment_turn = environment_turn(*scene.environment);
    if (!material.metallic_roughness) values.transmission = material.transmission;
    values.refraction_ratio = 1.0F / material.refractive_index;
    if (material.reflectivity == glm::vec3(0.0F)) return;
    values.reflectivity = material.reflectivity;
    values.grazing_reflectivity = material.grazing_reflectivity;
    values.refractive_index = material.refractive_index;
    values.conductor_index = material.conductor_index;
    values.conductor_absorption = material.conductor_absorption;
    values.reflection_roughness = material.reflection_roughness;
}

bool mirrors(const glm::mat4& world_from_object) {
    const glm::dmat3 m(world_from_object);
    return glm::dot(m[0], glm::cross(m[1], m[2])) < 0.0;
}

void set_place(DrawValues& values, const glm::mat4& world_from_object) {
    const glm::dmat3 m(world_from_object);
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                               glm::cross(m[0], m[1]));
    values.world_from_object = world_from_object;
    const bool is_mirrored = mirrors(world_from_object);
    values.world_from_object_normal = scaled_to_one(is_mirrored ? -cofactors : cofactors);
    values.world_from_object_tangent = scaled_to_one(m);
    values.handedness = is_mirrored ? -1.0F : 1.0F;
    values.object_scale = static_cast<float>(cube_root_of_determinant(glm::dmat3(m)));
}

void set_shadow(DrawValues& values, const std::optional<ShadowView>& view,
                const glm::mat4& world_from_object) {
    values.shadow_samples = 0;
    if (!view) return;
    values.shadow_from_object = glm::mat4(view->place_from_world * glm::dmat4(world_from_object));
    values.shadow_from_world = glm::mat4(view->place_from_world);
    values.shadow_lift = glm::mat4(view->lift * view->place_from_world);
    values.shadow_shift = glm::vec2(view->shift);
    values.shadow_samples = static_cast<int>(view->points.size());
    for (std::size_t i = 0; i < view->points.size(); ++i) {
        const glm::vec2 point(view->points[i]);
        glm::vec4& pair = values.shadow_points[i / 2];
        (i % 2 == 0 ? pair.x : pair.z) = point.x;
        (i % 2 == 0 ? pair.y : pair.w) = point.y;
    }
}

void set_normal_map(DrawValues& values, const NormalMap& map, int bits, FlatCode flat) {
    const double largest = bits == 8 ? 255.0 : 65535.0;
    glm::dvec3 factor(2.0);
    glm::dvec3 bias(-1.0);
    if (flat == FlatCode::middle && bits < 32) {
        // n = (code - middle) / (middle - 1), and a lookup returns code / largest.
        const double middle = bits == 8 ? 128.0 : 32768.0;
        factor = glm::dvec3(largest / (middle - 1.0));
        bias = glm::dvec3(-middle / (middle - 1.0));
    }
    const double along = map.space == NormalSpace::tangent ? static_cast<double>(map.scale) : 1.0;
    const glm::dvec3 by_channel(along, map.green == Green::up ? along : -along, 1.0);
    values.normal_map_scale = glm::vec3(factor * by_channel);
    values.normal_map_bias = glm::vec3(bias * by_channel);
    const double unscale = along == 0.0 ? 0.0 : 1.0 / along;
    values.normal_map_unscale = glm::vec3(glm::dvec3(unscale, unscale, 1.0));
    // The error of each component is at most half a code, which is 1 / largest.
    values.normal_map_rounding = bits < 32 ? static_cast<float>(std::sqrt(3.0) / largest) : 1e-6F;
}

glm::dmat4 clip_from_world(const Camera& camera, double aspect) {
    const double near = static_cast<double>(camera.near);
    const double far = static_cast<double>(camera.far);
    const double y = 1.0 / half_height(camera);
    glm::dmat4 clip_from_view(0.0);
    clip_from_view[0][0] = y / aspect;
    clip_from_view[1][1] = y;
    if (camera.orthographic_height) {
        clip_from_view[2][2] = 2.0 / (near - far);
        clip_from_view[3][2] = (far + near) / (near - far);
        clip_from_view[3][3] = 1.0;
    } else {
        clip_from_view[2][2] = (far + near) / (near - far);
        clip_from_view[2][3] = -1.0;
        clip_from_view[3][2] = 2.0 * far * near / (near - far);
    }
    return clip_from_view * glm::inverse(glm::dmat4(camera.world_from_view));
}

LightStorage::Key LightStorage::key(const Features& f) {
    return {f.directional_lights, f.point_lights, f.spot_lights, f.highlight_colors,
            f.lights_in_buffer};
}

void LightStorage::add(const gl::Api& api, const Scene& scene, const Features& features) {
    if (light_row_layout(features).count == 0) return;
    const auto [entry, is_new] = lights_.try_emplace(key(features));
    if (!is_new) return;
    const std::vector<glm::vec4> rows = light_rows(scene, features);
    entry->second.features = features;
    entry->second.rows = gl::make_buffer(api, rows, "lights", GL_DYNAMIC_DRAW);
    if (features.lights_in_buffer) {
        entry->second.texture = gl::make_buffer_texture(api, entry->second.rows, GL_RGBA32F,
                                                        rows.size() * sizeof(glm::vec4), "lights");
    }
}

void LightStorage::update(const gl::Api& api, const Scene& scene) {
    for (const auto& [key, lights] : lights_) {
        const std::vector<glm::vec4> rows = light_rows(scene, lights.features);
        gl::replace_content(api, lights.rows, std::as_bytes(std::span(rows)), "lights");
    }
}

void LightStorage::bind(const gl::Api& api, const Features& features) const {
    const auto entry = lights_.find(key(features));
    if (entry == lights_.end()) return;
    if (features.lights_in_buffer) {
        api->ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(TextureUnit::light_buffer));
        api->BindTexture(GL_TEXTURE_BUFFER, entry->second.texture.name());
    } else {
        api->BindBufferBase(GL_UNIFORM_BUFFER, lights_binding, entry->second.rows.name());
    }
}

}  // namespace relief::shade::detail
