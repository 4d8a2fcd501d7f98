// SPDX-License-Identifier: Apache-2.0
// Textures of materials: an image entry is added, a texture entry is changed or added, and the old
// image is retired. Samplers, texture coordinate sets and transforms stay. Textures of a set are
// removed.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files.h"
#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Extensions whose `source` takes precedence over that of a texture.
constexpr std::array source_extensions = {"KHR_texture_basisu", "EXT_texture_webp",
                                          "EXT_texture_avif", "MSFT_texture_dds"};

/// The member of a material that holds a texture.
struct SlotMember {
    std::string parent;  ///< The object that has the member; empty for the material itself.
    std::string key;
};

/// \throws InvalidInput if the texture does not belong to glTF without extensions
SlotMember member_of(TextureSlot slot) {
    const std::string path = slot_info(slot).gltf;
    if (path.empty() || path.starts_with("extensions/")) {
        fail_gltf("the {} texture cannot be set, because glTF without extensions does not have it",
                  slot_info(slot).name);
    }
    const std::size_t end = path.find('/');
    if (end == std::string::npos) return {"", path};
    return {path.substr(0, end), path.substr(end + 1)};
}

/// Returns the number of objects below `json` that use a texture: "baseColorTexture", those of
/// material extensions, and "texture" of extensions.
std::size_t texture_uses(const Json& json, std::size_t texture) {
    std::size_t count = 0;
    if (!json.is_structured()) return count;
    for (const auto& [key, value] : json.items()) {
        const bool is_use = json.is_object() && value.is_object() && key.ends_with("exture");
        if (is_use && find(value, "index") != nullptr && value["index"] == texture) ++count;
        count += texture_uses(value, texture);
    }
    return count;
}

/// Returns whether extensions may use textures or images in a form that is not known here.
bool has_hidden_uses(const Json& root) {
    constexpr std::array harmless = {"KHR_lights_punctual", "KHR_materials_variants",
                                     "KHR_xmp_json_ld"};
    if (has_unknown_extension(root)) return true;
    const Json* extensions = find(root, "extensions");
    if (extensions == nullptr) return false;
    return std::any_of(
        extensions->items().begin(), extensions->items().end(), [&](const auto& entry) {
            return std::find(harmless.begin(), harmless.end(), entry.key()) == harmless.end();
        });
}

/// Retires the images of a texture, and removes the extensions that name them.
void retire_images(GltfContents& contents, Json& texture) {
    if (const auto image = index_in(texture, "source")) contents.retired_images.insert(*image);
    for (const char* extension : source_extensions) {
        const Json* other = find(texture, "extensions", extension);
        if (other == nullptr) continue;
        if (const auto image = index_in(*other, "source")) contents.retired_images.insert(*image);
        erase_extension(texture, extension);
    }
}

/// Returns the entry of an image file. A file that was stored before is not stored again.
std::size_t image_entry(GltfContents& contents, const std::filesystem::path& file,
                        GltfImageStorage storage, Report& report) {
    std::error_code failed;  // The file is missing or unreadable: read_file() tells why.
    const std::filesystem::path path = std::filesystem::weakly_canonical(file, failed);
    const auto known = contents.stored_images.find({path, storage});
    if (!failed && known != contents.stored_images.end()) return known->second;
    const std::string bytes = read_file(file);
    const std::string media_type = image_media_type(bytes);
    if (media_type != "image/png" && media_type != "image/jpeg")
        throw FileError(file, "is neither PNG nor JPEG, the formats of glTF");
    const std::size_t index = array_in(contents.root, "images").size();
    Json image = {{"name", utf8_name(file.stem().string(), "image", index, report)}};
    if (storage == GltfImageStorage::embedded) {
        image["bufferView"] = add_view(contents, bytes);
        image["mimeType"] = media_type;
    } else {
        const std::string uri = uri_of(file.filename().string());
        const auto [entry, is_new] =
            contents.image_files.emplace(uri, std::filesystem::absolute(file));
        if (!is_new && read_file(entry->second) != bytes) {
            throw FileError(
                file, fmt::format("has the name of another image, {}", entry->second.string()));
        }
        image["uri"] = uri;
    }
    contents.root["images"].push_back(std::move(image));
    if (!failed) contents.stored_images.emplace(std::pair(path, storage), index);
    return index;
}

/// Returns a texture of an image with a sampler, or without one.
std::size_t texture_entry(Json& root, std::size_t image, const Json* sampler) {
    Json wanted = {{"source", image}};
    if (sampler != nullptr) wanted["sampler"] = *sampler;
    Json& textures = root["textures"];
    if (textures.is_null()) textures = Json::array();
    const auto known = std::find(textures.begin(), textures.end(), wanted);
    if (known != textures.end()) return static_cast<std::size_t>(known - textures.begin());
    textures.push_back(std::move(wanted));
    return textures.size() - 1;
}

std::size_t texcoord_set_of(const Json& info) {
    const std::size_t set = size_in(info, "texCoord");
    const Json* transform = find(info, "extensions", "KHR_texture_transform");
    return transform == nullptr ? set : size_in(*transform, "texCoord", set);
}

/// Gives the primitives of a material the texture coordinates that glTF requires for a texture. The
/// point (0, 0) of all vertices takes no bytes.
/// \throws InvalidInput if no primitive of the material has texture coordinates
void require_texcoords(GltfContents& contents, std::size_t material, std::size_t set,
                       Report& report) {
    Json& root = contents.root;
    if (!root.contains("meshes")) return;
    const std::string name = fmt::format("TEXCOORD_{}", set);
    std::vector<GltfPrimitiveId> without;
    std::size_t with = 0;
    for (std::size_t i = 0; i < root["meshes"].size(); ++i) {
        const Json& primitives = root["meshes"][i]["primitives"];
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            const Json& attributes = primitives[k]["attributes"];
            if (index_in(primitives[k], "material") != material) continue;
            if (attributes.contains(name))
                ++with;
            else if (attributes.contains("POSITION"))
                without.push_back({i, k});
        }
    }
    if (with == 0 && !without.empty()) {
        fail_gltf("{}: has no texture coordinates{} (unwrap the model first)",
                  describe_primitive(contents, without.front()),
                  set == 0 ? "" : fmt::format(" in set {}", set));
    }
    for (const GltfPrimitiveId id : without) {
        Json& primitive = root["meshes"][id.mesh]["primitives"][id.primitive];
        const std::size_t position = size_in(primitive["attributes"], "POSITION");
        Json& accessors = root["accessors"];
        accessors.push_back({{"componentType", gltf_code::float32},
                             {"count", accessors[position]["count"]},
                             {"type", "VEC2"}});
        primitive["attributes"][name] = accessors.size() - 1;
        report.add(fmt::format("{} without texture coordinates for a map",
                               describe_primitive(contents, id)),
                   "material", material, "shows one texel of it");
    }
}

/// Reports properties that hide a new texture, or that change where it is.
void report_slot(const Json& material, std::size_t index, TextureSlot slot, const Json& info,
                 Report& report) {
    const auto add = [&](const std::string& what, const std::string& outcome) {
        report.add(what, "material", index, outcome);
    };
    const bool is_color = slot == TextureSlot::base_color;
    if (!is_color && find(material, "extensions", "KHR_materials_unlit") != nullptr)
        add("map in a material with KHR_materials_unlit", "is not visible");
    if ((is_color || slot == TextureSlot::metallic_roughness) &&
        find(material, "extensions", "KHR_materials_pbrSpecularGlossiness") != nullptr) {
        add("map in a material with KHR_materials_pbrSpecularGlossiness",
            "is ignored by renderers that know the extension");
    }
    if (find(info, "extensions", "KHR_texture_transform") != nullptr)
        add("map with the KHR_texture_transform of the replaced one", "is transformed by it");
    if (size_in(info, "texCoord") != 0)
        add("map on another texture coordinate set than the first", "keeps that set");
}

/// Calls `visit` for each texture below `json` that is looked up at a set, with its owner and key.
template <typename Visitor>
void visit_textures_at(Json& json, std::size_t set, const Visitor& visit) {
    if (!json.is_object()) return;
    std::vector<std::string> keys;
    for (auto& [key, value] : json.items()) {
        const bool is_texture = value.is_object() && key.ends_with("exture");
        if (is_texture && find(value, "index") != nullptr && texcoord_set_of(value) == set)
            keys.push_back(key);
        else
            visit_textures_at(value, set, visit);
    }
    for (const std::string& key : keys)
        visit(json, key);
}

/// \throws InvalidInput if an animation changes a texture of the material
void refuse_animated(const Json& root, std::size_t material, const std::string& texture) {
    const std::string begin = fmt::format("/materials/{}/", material);
    for (const Json& animation : array_in(root, "animations")) {
        for (const Json& channel : array_in(animation, "channels")) {
            const Json* const target = find(channel, "target");
            if (target == nullptr) continue;
            const Json* const extension = find(*target, "extensions", "KHR_animation_pointer");
            if (extension == nullptr) continue;
            const std::string pointer = text_in(*extension, "pointer");
            if (pointer.starts_with(begin) && pointer.find("/" + texture + "/") != pointer.npos)
                fail_gltf("material {}: its {} cannot be removed, because an animation changes it",
                          material, texture);
        }
    }
}

/// Sets the factors of a material by their paths.
class FactorWriter {
  public:
    FactorWriter(Json& root, std::size_t material)
        : root_(root), json_(root["materials"][material]), material_(material) {}

    /// \param path   as SceneField::gltf
    /// \param value  a number, or an array of numbers
    void set(const std::string& path, const Json& value, const Json& neutral) {
        if (value == neutral) {
            remove(path);
            return;
        }
        json_[Json::json_pointer(fmt::format("/{}", path))] = value;
        if (path.starts_with(extensions)) declare(extension_of(path));
    }

    /// \throws InvalidInput if the value is not finite
    [[nodiscard]] float clamped(const std::string& path, float value, const FieldRange& to) const {
        if (!std::isfinite(value))
            fail_gltf("material {}: its {} is {}, but must be finite", material_, path, value);
        return std::clamp(value, to.min, to.max);
    }

  private:
    static constexpr std::string_view extensions = "extensions/";

    static std::string extension_of(const std::string& path) {
        const std::size_t first = extensions.size();
        return path.substr(first, path.find('/', first) - first);
    }

    void declare(const std::string& extension) {
        Json& used = root_["extensionsUsed"];
        if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
    }

    void remove(const std::string& path) {
        if (find_path(json_, path) == nullptr) return;
        const std::size_t end = path.rfind('/');
        Json& holder = end == std::string::npos
                           ? json_
                           : json_[Json::json_pointer(fmt::format("/{}", path.substr(0, end)))];
        holder.erase(end == std::string::npos ? path : path.substr(end + 1));
        if (!path.starts_with(extensions) || !holder.empty()) return;
        const std::string extension = extension_of(path);
        erase_extension(json_, extension.c_str());
        remove_unused_extension(root_, extension);
    }

    Json& root_;
    Json& json_;
    std::size_t material_;
};

}  // namespace

std::vector<std::size_t> GltfDocument::materials_with_textures_at(GltfPrimitiveId id,
                                                                  int set) const {
    const Json& primitive = primitive_json(contents_->data, id);
    std::set<std::size_t> candidates;
    if (const auto material = index_in(primitive, "material")) candidates.insert(*material);
    if (const Json* variants = find(primitive, "extensions", "KHR_materials_variants")) {
        for (const Json& mapping : array_in(*variants, "mappings"))
            if (const auto material = index_in(mapping, "material")) candidates.insert(*material);
    }
    std::vector<std::size_t> result;
    for (const std::size_t material : candidates) {
        Json json = contents_->data.root["materials"][material];
        bool is_found = false;
        visit_textures_at(json, static_cast<std::size_t>(set),
                          [&](Json&, const std::string&) { is_found = true; });
        if (is_found) result.push_back(material);
    }
    return result;
}

void GltfDocument::remove_textures_at(std::size_t material, int set) {
    GltfContents& contents = contents_->data;
    Json& root = contents.root;
    const std::size_t count = array_in(root, "materials").size();
    if (material >= count)
        fail_gltf("material {} does not exist, there are only {}", material, count);
    Json& json = root["materials"][material];
    const auto place = static_cast<std::size_t>(set);
    visit_textures_at(json, place, [&](const Json&, const std::string& key) {
        refuse_animated(root, material, key);
    });
    std::vector<std::size_t> removed;
    visit_textures_at(json, place, [&](Json& owner, const std::string& key) {
        removed.push_back(size_in(owner[key], "index"));
        owner.erase(key);
    });
    if (!has_hidden_uses(root)) {
        for (const std::size_t index : removed) {
            if (texture_uses(root, index) > 0) continue;
            retire_images(contents, root["textures"][index]);
            root["textures"][index].erase("source");
        }
    }
    for (const char* extension : source_extensions)
        remove_unused_extension(root, extension);
    remove_unused_extension(root, "KHR_texture_transform");
}

std::size_t GltfDocument::add_material(const std::string& name) {
    Json& root = contents_->data.root;
    Json& materials = root["materials"];
    if (materials.is_null()) materials = Json::array();
    const std::size_t index = materials.size();
    materials.push_back({{"name", name}});
    if (!root.contains("meshes")) return index;
    for (Json& mesh : root["meshes"]) {
        for (Json& primitive : mesh["primitives"]) {
            if (!primitive.contains("material")) primitive["material"] = index;
        }
    }
    return index;
}

void GltfDocument::set_texture(std::size_t material, TextureSlot slot,
                               const std::filesystem::path& image, GltfImageStorage storage,
                               Report& report) {
    GltfContents& contents = contents_->data;
    Json& root = contents.root;
    const std::size_t count = array_in(root, "materials").size();
    if (material >= count)
        fail_gltf("material {} does not exist, there are only {}", material, count);
    Json& json = root["materials"][material];
    const SlotMember member = member_of(slot);
    const Json* const before = member.parent.empty()
                                   ? find(json, member.key.c_str())
                                   : find(json, member.parent.c_str(), member.key.c_str());
    require_texcoords(contents, material, before == nullptr ? 0 : texcoord_set_of(*before), report);
    const std::size_t new_image = image_entry(contents, image, storage, report);
    Json& parent = member.parent.empty() ? json : json[member.parent];
    Json& info = parent[member.key];
    if (const auto old = index_in(info, "index")) {
        Json& texture = root["textures"][*old];
        if (texture_uses(root, *old) == 1 && !has_hidden_uses(root)) {
            retire_images(contents, texture);
            texture["source"] = new_image;
        } else {
            const Json old_texture = texture;
            info["index"] = texture_entry(root, new_image, find(old_texture, "sampler"));
        }
    } else {
        info["index"] = texture_entry(root, new_image, nullptr);
    }
    for (const char* extension : source_extensions)
        remove_unused_extension(root, extension);
    if (slot == TextureSlot::emission) {
        constexpr glm::vec3 black(0.0F);
        if (vector_in(json, "emissiveFactor", black) == black) {
            json["emissiveFactor"] = {1, 1, 1};
            report.add("emissive map of a material that emits no light", "material", material,
                       "gets the emissive factor 1");
        }
    }
    report_slot(json, material, slot, info, report);
}

void GltfDocument::set_normal_scale(std::size_t material, double scale) {
    Json& root = contents_->data.root;
    const std::size_t count = array_in(root, "materials").size();
    if (material >= count)
        fail_gltf("material {} does not exist, there are only {}", material, count);
    Json& json = root["materials"][material];
    if (!json.contains("normalTexture")) fail_gltf("material {} has no normal map", material);
    json["normalTexture"]["scale"] = scale;
}

void GltfDocument::set_alpha_mode(std::size_t material, AlphaMode mode, float cutoff) {
    Json& root = contents_->data.root;
    const std::size_t count = array_in(root, "materials").size();
    if (material >= count)
        fail_gltf("material {} does not exist, there are only {}", material, count);
    Json& json = root["materials"][material];
    json.erase("alphaMode");
    json.erase("alphaCutoff");
    if (mode == AlphaMode::opaque) return;
    json["alphaMode"] = mode == AlphaMode::mask ? "MASK" : "BLEND";
    if (mode == AlphaMode::mask && cutoff != 0.5F) json["alphaCutoff"] = cutoff;
}

void GltfDocument::set_factors(std::size_t material, const GltfMaterial& values) {
    Json& root = contents_->data.root;
    const std::size_t count = array_in(root, "materials").size();
    if (material >= count)
        fail_gltf("material {} does not exist, there are only {}", material, count);
    FactorWriter writer(root, material);
    constexpr FieldRange share{0, 1};
    const std::string base_color = field_of(&MetallicRoughness::base_color).gltf;
    const auto color_json = [&](const std::string& path, const glm::vec3& color,
                                const FieldRange& range) -> Json {
        return {writer.clamped(path, color.r, range), writer.clamped(path, color.g, range),
                writer.clamped(path, color.b, range)};
    };
    for_each_field<MetallicRoughness>([&](const auto& field) {
        const auto& value = (*values.metallic_roughness).*field.member;
        using Value = std::decay_t<decltype(value)>;
        const std::string path = field.gltf;
        if constexpr (std::is_same_v<Value, float>) {
            writer.set(path, writer.clamped(path, value, field.gltf_range), field.default_value());
        } else if constexpr (std::is_same_v<Value, std::optional<float>>) {
            Json json;
            if (value) json = writer.clamped(path, *value, field.gltf_range);
            writer.set(path, json, nullptr);
        } else if constexpr (std::is_same_v<Value, glm::vec3>) {
            Json json = color_json(path, value, field.gltf_range);
            Json neutral = color_json(path, field.default_value(), field.gltf_range);
            if (path == base_color) {
                json.push_back(writer.clamped(path, values.opacity, share));
                neutral.push_back(1.0F);
            }
            writer.set(path, json, neutral);
        }
    });
    const std::string emission = "emissiveFactor";
    writer.set(emission, color_json(emission, values.emission_factor, share),
               Json::array({0.0F, 0.0F, 0.0F}));
    const std::string strength = "extensions/KHR_materials_emissive_strength/emissiveStrength";
    writer.set(strength, writer.clamped(strength, values.emission_strength, non_negative_range),
               1.0F);
    const auto sides = field_of(&Material::double_sided);
    writer.set(sides.gltf, values.double_sided, sides.default_value());
}

}  // namespace relief
