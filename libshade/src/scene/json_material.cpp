// SPDX-License-Identifier: Apache-2.0
// A material of a scene file, member by member. Colours as three linear numbers, one number, or an
// sRGB code. Unknown members and values are refused with what is allowed.
// Tests: tests/shade/scene/scene_json_test.cpp.
#include "scene/json_material.h"

#include <fmt/format.h>

#include <functional>

namespace relief {

namespace {

/// The value of two hexadecimal digits, divided by 255.
std::optional<float> hex_code(std::string_view digits) {
    int code = 0;
    for (const char c : digits) {
        int digit = 0;
        if (c >= '0' && c <= '9') {
            digit = c - '0';
        } else if (c >= 'a' && c <= 'f') {
            digit = c - 'a' + 10;
        } else if (c >= 'A' && c <= 'F') {
            digit = c - 'A' + 10;
        } else {
            return std::nullopt;
        }
        code = 16 * code + digit;
    }
    return static_cast<float>(code) / 255.0F;
}

using MemberSetter = std::function<void(const JsonCursor&)>;
/// What each member of an object does, by its key.
using Members = std::map<std::string, MemberSetter>;

void read_members(const JsonCursor& object, const Members& members) {
    std::vector<std::string> known;
    for (const auto& [key, setter] : members)
        known.push_back(key);
    object.allow(known);
    for (const std::string& key : object.keys())
        members.at(key)(object.at(key));
}

MemberSetter number(float& value, float least, float most) {
    return [&value, least, most](const JsonCursor& c) { value = c.number(least, most); };
}
MemberSetter color(glm::vec3& value) {
    return [&value](const JsonCursor& c) { value = color_in(c); };
}
MemberSetter flag(bool& value) {
    return [&value](const JsonCursor& c) { value = c.boolean(); };
}
template <typename Value, std::size_t count>
MemberSetter choice(Value& value, const Named<Value> (&names)[count]) {
    return [&value, &names](const JsonCursor& c) { value = one_of(c, names); };
}
/// What a material may have or not: null takes it away.
template <typename Value, typename Read>
MemberSetter optional(std::optional<Value>& value, const Read& read) {
    return [&value, read](const JsonCursor& c) {
        value.reset();
        if (!c.is_null()) value = read(c);
    };
}
MemberSetter texture(std::optional<Texture>& value, JsonImages& images) {
    return optional(value, [&images](const JsonCursor& c) { return images.texture(c); });
}

NormalMap normal_map_from(const JsonCursor& object, JsonImages& images) {
    NormalMap map;
    if (object.is_text()) {
        map.texture = images.texture(object);
        return map;
    }
    read_members(
        object, {{"texture", [&](const JsonCursor& c) { map.texture = images.texture(c); }},
                 {"scale", number(map.scale, -1e6F, 1e6F)},
                 {"green", choice(map.green, green_words)},
                 {"zero_code", [&](const JsonCursor& c) { map.flat = one_of(c, zero_code_words); }},
                 {"space", choice(map.space, normal_space_words)}});
    (void)object.at("texture");
    return map;
}

BumpMap bump_map_from(const JsonCursor& object, JsonImages& images) {
    BumpMap map;
    if (object.is_text()) {
        map.texture = images.texture(object);
        return map;
    }
    read_members(object,
                 {{"texture", [&](const JsonCursor& c) { map.texture = images.texture(c); }},
                  {"strength", number(map.strength, -1e6F, 1e6F)}});
    (void)object.at("texture");
    return map;
}

MetallicRoughness metallic_roughness_from(const JsonCursor& object, JsonImages& images) {
    MetallicRoughness model;
    read_members(object, {{"base_color", color(model.base_color)},
                          {"metallic", number(model.metallic, 0.0F, 1.0F)},
                          {"roughness", number(model.roughness, 0.0F, 1.0F)},
                          {"texture", texture(model.texture, images)}});
    return model;
}

/// How a texture is looked up, where the file says more than its image.
Texture with_sampling(const JsonCursor& cursor, Texture texture) {
    if (cursor.is_object()) {
        read_members(cursor, {{"image", [](const JsonCursor&) {}},
                              {"wrap_u", choice(texture.wrap_u, wrap_words)},
                              {"wrap_v", choice(texture.wrap_v, wrap_words)},
                              {"filter", choice(texture.filter, filter_words)}});
    }
    return texture;
}

Material classic_material(const JsonCursor& cursor) {
    const auto found = material_by_name(cursor.text());
    if (!found) cursor.fail_unknown(cursor.text(), material_names());
    return *found;
}

/// Every member by the name that it has in Material. "like" has been done before.
Members members_of(Material& m, JsonImages& images) {
    return {
        {"like", [](const JsonCursor&) {}},
        {"name", [&](const JsonCursor& c) { m.name = c.text(); }},
        {"interpolation", choice(m.interpolation, interpolation_words)},
        {"ambient", color(m.ambient)},
        {"diffuse", color(m.diffuse)},
        {"specular", color(m.specular)},
        {"emission", color(m.emission)},
        {"shininess", number(m.shininess, 0.0F, 1e6F)},
        {"specular_model", choice(m.specular_model, specular_model_words)},
        {"metallic_roughness",
         optional(m.metallic_roughness,
                  [&](const JsonCursor& c) { return metallic_roughness_from(c, images); })},
        {"reflectivity", color(m.reflectivity)},
        {"grazing_reflectivity", color(m.grazing_reflectivity)},
        {"fresnel", choice(m.fresnel, fresnel_words)},
        {"refractive_index", number(m.refractive_index, 1.0F, 1e3F)},
        {"conductor_index", color(m.conductor_index)},
        {"conductor_absorption", color(m.conductor_absorption)},
        {"reflection_roughness", number(m.reflection_roughness, 0.0F, 1.0F)},
        {"transmission", number(m.transmission, 0.0F, 1.0F)},
        {"diffuse_texture", texture(m.diffuse_texture, images)},
        {"specular_texture", texture(m.specular_texture, images)},
        {"emission_texture", texture(m.emission_texture, images)},
        {"occlusion_texture", texture(m.occlusion_texture, images)},
        {"occlusion_strength", number(m.occlusion_strength, 0.0F, 1.0F)},
        {"opacity_texture", texture(m.opacity_texture, images)},
        {"normal_map",
         optional(m.normal_map, [&](const JsonCursor& c) { return normal_map_from(c, images); })},
        {"bump_map",
         optional(m.bump_map, [&](const JsonCursor& c) { return bump_map_from(c, images); })},
        {"tangent_frame", choice(m.tangent_frame, tangent_frame_words)},
        {"specular_antialiasing", flag(m.specular_antialiasing)},
        {"alpha_mode", choice(m.alpha_mode, alpha_mode_words)},
        {"opacity", number(m.opacity, 0.0F, 1.0F)},
        {"alpha_cutoff", number(m.alpha_cutoff, 0.0F, max_reflectance)},
        {"double_sided", flag(m.double_sided)},
        {"unlit", flag(m.unlit)},
    };
}

}  // namespace

glm::vec3 color_in(const JsonCursor& cursor) {
    if (cursor.is_number()) return glm::vec3(cursor.number());
    if (cursor.is_array()) return cursor.vector();
    const char* const allowed = "must be three numbers, one number, or \"#rrggbb\"";
    if (!cursor.is_text()) cursor.fail(allowed);
    const std::string& code = cursor.text();
    if (code.size() != 7 || code.front() != '#') cursor.fail(allowed);
    glm::vec3 color(0.0F);
    for (int i = 0; i < 3; ++i) {
        const auto channel =
            hex_code(std::string_view(code).substr(1 + 2 * static_cast<std::size_t>(i), 2));
        if (!channel) cursor.fail(allowed);
        color[i] = linear_from_srgb(*channel);
    }
    return color;
}

std::filesystem::path JsonImages::file(const JsonCursor& cursor) const {
    const std::filesystem::path path = (folder_ / cursor.text()).lexically_normal();
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        cursor.fail(fmt::format("there is no file {}", path.string()));
    return path;
}

std::filesystem::path JsonImages::folder(const JsonCursor& cursor) const {
    return (folder_ / cursor.text()).lexically_normal();
}

ImageSource JsonImages::source(const JsonCursor& cursor) const {
    const std::filesystem::path path = file(cursor);
    return {path.string(), path};
}

std::size_t JsonImages::own_image(const JsonCursor& number) const {
    if (images_.empty()) number.fail("is the number of an image, but no model has brought one");
    return static_cast<std::size_t>(number.whole_number(0, static_cast<int>(images_.size()) - 1));
}

Texture JsonImages::texture(const JsonCursor& cursor) {
    const JsonCursor image = cursor.is_object() ? cursor.at("image") : cursor;
    if (image.is_number()) return with_sampling(cursor, {own_image(image)});
    const std::filesystem::path path = (folder_ / image.text()).lexically_normal();
    const auto [entry, is_new] = index_of_.try_emplace(path, images_.size());
    if (is_new) images_.push_back({path.string(), path, scene_file_.string()});
    return with_sampling(cursor, {entry->second});
}

void read_material(const JsonCursor& object, JsonImages& images, Material& material) {
    if (const auto like = object.find("like")) material = classic_material(*like);
    read_members(object, members_of(material, images));
    if (material.normal_map && material.bump_map)
        object.fail("has a normal map and a bump map, but a surface has one normal");
}

}  // namespace relief
