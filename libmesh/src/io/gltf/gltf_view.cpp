// SPDX-License-Identifier: Apache-2.0
// A glTF document as a scene: world matrices of nodes, materials, images, lights, cameras and
// animations.
//
// World space, right-handed, +Y up; colors linear; angles in radians; times in seconds. Properties
// without a place in the scene types stay only in the document. Instance attributes of a wrong type
// throw InvalidInput. An unusable animation channel is left out and counted. Source: glTF 2.0
// (ISO/IEC 12113), KHR_lights_punctual, KHR_materials_emissive_strength, KHR_materials_unlit, the
// extensions in material.h, KHR_texture_transform, EXT_mesh_gpu_instancing.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string_view>
#include <type_traits>
#include <utility>

#include "geometry/direction.h"
#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

const Json* detail::find_path(const Json& object, std::string_view path) {
    const Json* found = &object;
    while (found != nullptr && !path.empty()) {
        const std::size_t length = std::min(path.find('/'), path.size());
        const std::string key(path.substr(0, length));
        found = found->is_object() ? find(*found, key.c_str()) : nullptr;
        path.remove_prefix(std::min(length + 1, path.size()));
    }
    return found;
}

bool detail::has_factors(std::string_view extension) {
    const std::string prefix = fmt::format("extensions/{}/", extension);
    bool has = false;
    for_each_field<MetallicRoughness>(
        [&](const auto& field) { has |= std::string_view(field.gltf).starts_with(prefix); });
    return has;
}

namespace {

bool has_triangles(const Json& primitive) {
    return size_in(primitive, "mode", 4) >= 4 && primitive["attributes"].contains("POSITION");
}

glm::mat4 transform(const glm::vec3& translation, const glm::vec4& rotation,
                    const glm::vec3& scale) {
    const glm::quat quaternion(rotation.w, rotation.x, rotation.y, rotation.z);
    return glm::translate(glm::mat4(1.0F), translation) * glm::mat4_cast(quaternion) *
           glm::scale(glm::mat4(1.0F), scale);
}

/// Returns the weights of a node, else of its mesh, for as many morph targets as a primitive has.
std::vector<float> morph_weights(const Json& root, const Json& node, std::size_t mesh) {
    const Json& json = root["meshes"][mesh];
    std::size_t count = 0;
    for (const Json& primitive : json["primitives"])
        count = std::max(count, array_in(primitive, "targets").size());
    std::vector<float> weights(count, 0.0F);
    const Json& given =
        !array_in(node, "weights").empty() ? array_in(node, "weights") : array_in(json, "weights");
    for (std::size_t i = 0; i < std::min(count, given.size()); ++i)
        weights[i] = given[i].is_number() ? given[i].get<float>() : 0.0F;
    return weights;
}

GltfNode node_from(const Json& root, const Json& json) {
    GltfNode node;
    node.name = text_in(json, "name");
    node.has_skin = json.contains("skin");
    if (const auto mesh = index_in(json, "mesh")) {
        const Json& primitives = root["meshes"][*mesh]["primitives"];
        node.has_morph_targets = std::any_of(
            primitives.begin(), primitives.end(),
            [](const Json& primitive) { return !array_in(primitive, "targets").empty(); });
        if (node.has_morph_targets) node.morph_weights = morph_weights(root, json, *mesh);
    }
    node.skin = index_in(json, "skin");
    node.translation = vector_in(json, "translation", node.translation);
    node.rotation = vector_in(json, "rotation", node.rotation);
    node.scale = vector_in(json, "scale", node.scale);
    if (const Json* matrix = find(json, "matrix")) {
        node.matrix.emplace();
        for (std::size_t i = 0; i < 16; ++i) {
            (*node.matrix)[static_cast<int>(i / 4)][static_cast<int>(i % 4)] =
                (*matrix)[i].get<float>();
        }
    }
    return node;
}

std::vector<GltfNode> nodes_of(const Json& root) {
    const Json& nodes = array_in(root, "nodes");
    std::vector<GltfNode> result;
    for (const Json& node : nodes)
        result.push_back(node_from(root, node));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const Json& child : array_in(nodes[i], "children"))
            result[child.get<std::size_t>()].parent = i;
    }
    return result;
}

glm::mat4 parent_from_node(const GltfNode& node) {
    return node.matrix ? *node.matrix : transform(node.translation, node.rotation, node.scale);
}

/// Returns the transforms of EXT_mesh_gpu_instancing, or one identity matrix.
std::vector<glm::mat4> instances(const GltfContents& contents, const Json& node) {
    const Json* attributes = find(node, "extensions", "EXT_mesh_gpu_instancing", "attributes");
    if (attributes == nullptr || attributes->empty()) return {glm::mat4(1.0F)};
    const auto read = [&]<typename Vector>(const char* name, Vector) {
        const auto accessor = index_in(*attributes, name);
        return accessor ? float_elements<Vector>(contents, *accessor) : std::vector<Vector>();
    };
    const auto translations = read("TRANSLATION", glm::vec3());
    const auto rotations = read("ROTATION", glm::vec4());
    const auto scales = read("SCALE", glm::vec3());
    const std::size_t count = std::max({translations.size(), rotations.size(), scales.size()});
    const auto fits = [&](std::size_t size) { return size == 0 || size == count; };
    if (!fits(translations.size()) || !fits(rotations.size()) || !fits(scales.size())) {
        throw InvalidInput("the attributes of EXT_mesh_gpu_instancing differ in length");
    }
    std::vector<glm::mat4> result;
    for (std::size_t i = 0; i < count; ++i) {
        result.push_back(transform(translations.empty() ? glm::vec3(0.0F) : translations[i],
                                   rotations.empty() ? glm::vec4(0, 0, 0, 1) : rotations[i],
                                   scales.empty() ? glm::vec3(1.0F) : scales[i]));
    }
    return result;
}

Wrap wrap_in(const Json& sampler, const char* key) {
    switch (size_in(sampler, key, 10497)) {
        case 33071:
            return Wrap::clamp;
        case 33648:
            return Wrap::mirror;
        default:
            return Wrap::repeat;
    }
}

/// Returns the image of a texture: the core glTF one, otherwise that of an extension.
std::optional<std::size_t> image_of(const Json& texture) {
    if (const auto image = index_in(texture, "source")) return image;
    for (const char* extension :
         {"EXT_texture_webp", "EXT_texture_avif", "KHR_texture_basisu", "MSFT_texture_dds"}) {
        const Json* inner = find(texture, "extensions", extension);
        if (inner != nullptr && inner->contains("source")) return index_in(*inner, "source");
    }
    return std::nullopt;
}

/// Returns the texture of a texture info, without its texture coordinates; none without an image.
std::optional<Texture> texture_in(const Json& root, const Json& info) {
    const Json& texture = root["textures"][size_in(info, "index")];
    const auto image = image_of(texture);
    if (!image) return std::nullopt;
    Texture result;
    result.image = *image;
    if (const auto number = index_in(texture, "sampler")) {
        const Json& sampler = root["samplers"][*number];
        result.wrap_u = wrap_in(sampler, "wrapS");
        result.wrap_v = wrap_in(sampler, "wrapT");
        constexpr std::size_t nearest = 9728;
        if (size_in(sampler, "magFilter") == nearest) result.filter = TextureFilter::nearest;
    }
    return result;
}

GltfTexcoords texcoords_in(const Json& info) {
    GltfTexcoords result;
    result.set = static_cast<int>(size_in(info, "texCoord"));
    if (const Json* transform = find(info, "extensions", "KHR_texture_transform")) {
        result.transform.offset = vector_in(*transform, "offset", glm::vec2(0.0F));
        result.transform.rotation = float_in(*transform, "rotation", 0.0F);
        result.transform.scale = vector_in(*transform, "scale", glm::vec2(1.0F));
        result.set =
            static_cast<int>(size_in(*transform, "texCoord", static_cast<std::size_t>(result.set)));
    }
    return result;
}

/// Tells whether an extension of a material has values that change nothing.
bool is_neutral(const Json& material, const std::string& name) {
    const std::string prefix = "extensions/" + name + "/";
    return std::any_of(undrawn_factors.begin(), undrawn_factors.end(),
                       [&](const UndrawnFactor& factor) {
                           if (!std::string_view(factor.gltf).starts_with(prefix)) return false;
                           const Json* const value = find_path(material, factor.gltf);
                           return value == nullptr || *value == 0.0;
                       });
}

/// Returns true for extensions whose factors are members of GltfMaterial.
bool has_members(const std::string& name) {
    return name == "KHR_materials_unlit" || name == "KHR_materials_emissive_strength" ||
           has_factors(name);
}

/// Returns the extensions that GltfMaterial does not have, without neutral ones.
std::vector<std::string> more_extensions_of(const Json& json) {
    std::vector<std::string> names;
    const Json* extensions = find(json, "extensions");
    if (extensions == nullptr || !extensions->is_object()) return names;
    for (const auto& [name, extension] : extensions->items()) {
        if (!has_members(name) && !is_neutral(json, name)) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

float value_in(const Json& json, float /*as*/) {
    return json.get<float>();
}
bool value_in(const Json& json, bool /*as*/) {
    return json.get<bool>();
}
glm::vec3 value_in(const Json& json, const glm::vec3& /*as*/) {
    return {json[0].get<float>(), json[1].get<float>(), json[2].get<float>()};
}

/// Sets the fields that have a path in glTF and that the document states.
template <typename Owner>
void read_factors(const Json& json, Owner& owner) {
    for_each_field<Owner>([&](const auto& field) {
        auto& member = owner.*field.member;
        using Value = std::decay_t<decltype(member)>;
        constexpr bool is_factor = std::is_same_v<Value, float> || std::is_same_v<Value, bool> ||
                                   std::is_same_v<Value, glm::vec3>;
        if constexpr (is_factor || std::is_same_v<Value, std::optional<float>>) {
            const Json* const found = *field.gltf == '\0' ? nullptr : find_path(json, field.gltf);
            if (found == nullptr) return;
            if constexpr (is_factor) {
                member = value_in(*found, member);
            } else {
                member = value_in(*found, 0.0F);
            }
        }
    });
}

void read_textures(const Json& root, const Json& json, GltfMaterial& material) {
    for (std::size_t i = 0; i < texture_slot_count; ++i) {
        const TextureSlotInfo& slot = texture_slots[i];
        const Json* const info = *slot.gltf == '\0' ? nullptr : find_path(json, slot.gltf);
        if (info == nullptr) continue;
        const std::optional<Texture> texture = texture_in(root, *info);
        if (!texture) continue;
        set_texture(material, slot.slot, *texture);
        material.texcoords[i] = texcoords_in(*info);
    }
    const auto read_scale = [&](std::optional<NormalMap>& map, TextureSlot slot) {
        if (map) map->scale = float_in(*find_path(json, slot_info(slot).gltf), "scale", 1.0F);
    };
    read_scale(material.normal_map, TextureSlot::normal);
    read_scale(material.metallic_roughness->clearcoat_normal_map, TextureSlot::clearcoat_normal);
}

GltfMaterial material_from(const Json& root, const Json& json) {
    GltfMaterial material;
    material.name = text_in(json, "name");
    read_factors<Material>(json, material);
    read_factors(json, *material.metallic_roughness);
    read_textures(root, json, material);
    if (const Json* pbr = find(json, "pbrMetallicRoughness"))
        material.opacity = vector_in(*pbr, "baseColorFactor", glm::vec4(1.0F)).a;
    material.emission_factor = vector_in(json, "emissiveFactor", glm::vec3(0.0F));
    if (const Json* strength = find(json, "extensions", "KHR_materials_emissive_strength")) {
        material.emission_strength = float_in(*strength, "emissiveStrength", 1.0F);
    }
    material.emission = material.emission_factor * material.emission_strength;
    const std::string mode = text_in(json, "alphaMode");
    material.alpha_mode = mode == "MASK"    ? AlphaMode::mask
                          : mode == "BLEND" ? AlphaMode::blend
                                            : AlphaMode::opaque;
    material.unlit = find(json, "extensions", "KHR_materials_unlit") != nullptr;
    material.more_extensions = more_extensions_of(json);
    return material;
}

std::vector<std::byte> bytes_of(std::string_view text) {
    std::vector<std::byte> bytes(text.size());
    if (!text.empty()) std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
}

GltfImage image_from(const GltfContents& contents, std::size_t index) {
    const Json& json = contents.root["images"][index];
    GltfImage image;
    image.name = text_in(json, "name");
    const std::string uri = text_in(json, "uri");
    if (const auto number = index_in(json, "bufferView")) {
        const Json& view = contents.root["bufferViews"][*number];
        image.source = bytes_of(contents.buffers[size_in(view, "buffer")].bytes().substr(
            size_in(view, "byteOffset"), size_in(view, "byteLength")));
    } else if (is_data_uri(uri)) {
        image.source = bytes_of(decode_data_uri(uri).bytes);
    } else if (const auto path = readable_path(contents.folder(), uri)) {
        image.source = *path;
    } else {
        image.fault = uri.empty() ? fmt::format("images[{}] names no file and has no bytes", index)
                                  : fmt::format(
                                        "images[{}].uri '{}' leads out of the document's "
                                        "folder, so it is not read",
                                        index, uri);
    }
    return image;
}

GltfLight light_from(const Json& json, std::size_t number) {
    GltfLight light;
    light.number = number;
    light.name = text_in(json, "name");
    const std::string type = text_in(json, "type");
    light.type = type == "directional" ? LightType::directional
                 : type == "spot"      ? LightType::spot
                                       : LightType::point;
    light.color = vector_in(json, "color", glm::vec3(1.0F));
    light.intensity = float_in(json, "intensity", 1.0F);
    if (json.contains("range")) light.range = float_in(json, "range", 0.0F);
    if (const Json* spot = find(json, "spot")) {
        light.inner_cone = float_in(*spot, "innerConeAngle", light.inner_cone);
        light.outer_cone = float_in(*spot, "outerConeAngle", light.outer_cone);
    }
    return light;
}

/// Walks the nodes of a scene and collects their primitives, lights and cameras in world space.
class SceneWalk {
  public:
    SceneWalk(const GltfContents& contents, GltfView& view) : contents_(contents), view_(view) {}

    void run() {
        std::vector<Open> open;
        for (const std::size_t root : root_nodes())
            open.push_back({root, glm::mat4(1.0F)});
        std::reverse(open.begin(), open.end());
        while (!open.empty()) {
            const Open next = open.back();
            open.pop_back();
            const Json& node = contents_.root["nodes"][next.node];
            const glm::mat4 world_from_node =
                next.world_from_parent * parent_from_node(view_.nodes[next.node]);
            place(next.node, world_from_node);
            const Json& children = array_in(node, "children");
            for (std::size_t i = children.size(); i-- > 0;) {
                open.push_back({children[i].get<std::size_t>(), world_from_node});
            }
        }
    }

  private:
    struct Open {
        std::size_t node = 0;
        glm::mat4 world_from_parent{1.0F};
    };

    /// Roots of the default scene, or of the first one. Without scenes: all nodes without a parent.
    [[nodiscard]] std::vector<std::size_t> root_nodes() const {
        const Json& root = contents_.root;
        const Json& scenes = array_in(root, "scenes");
        std::vector<std::size_t> result;
        if (!scenes.empty()) {
            for (const Json& node : array_in(scenes[size_in(root, "scene")], "nodes")) {
                result.push_back(node.get<std::size_t>());
            }
            return result;
        }
        const Json& nodes = array_in(root, "nodes");
        std::vector<bool> has_parent(nodes.size(), false);
        for (const Json& node : nodes) {
            for (const Json& child : array_in(node, "children")) {
                has_parent[child.get<std::size_t>()] = true;
            }
        }
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (!has_parent[i]) result.push_back(i);
        }
        return result;
    }

    void place(std::size_t number, const glm::mat4& world_from_node) {
        const Json& node = contents_.root["nodes"][number];
        const std::string& name = view_.nodes[number].name;
        if (const auto mesh = index_in(node, "mesh")) {
            const Json& primitives = contents_.root["meshes"][*mesh]["primitives"];
            for (const glm::mat4& node_from_instance : instances(contents_, node)) {
                for (std::size_t i = 0; i < primitives.size(); ++i) {
                    if (!has_triangles(primitives[i])) continue;
                    view_.primitives.push_back({{*mesh, i},
                                                world_from_node * node_from_instance,
                                                name,
                                                number,
                                                node_from_instance});
                }
            }
        }
        if (const Json* light = find(node, "extensions", "KHR_lights_punctual")) {
            const Json& lights = contents_.root["extensions"]["KHR_lights_punctual"]["lights"];
            const std::size_t index = size_in(*light, "light");
            view_.lights.push_back(
                {light_from(lights[index], index), world_from_node, name, number});
        }
        if (const auto index = index_in(node, "camera")) {
            const Json& json = contents_.root["cameras"][*index];
            GltfCamera camera;
            camera.number = *index;
            camera.name = text_in(json, "name");
            const Json* lens = find(json, "perspective");
            if (lens != nullptr) {
                camera.vertical_fov = float_in(*lens, "yfov", camera.vertical_fov);
            } else {
                lens = find(json, "orthographic");
                if (lens == nullptr) return;
                camera.orthographic_height = 2.0F * float_in(*lens, "ymag", 1.0F);
            }
            camera.near = float_in(*lens, "znear", camera.near);
            if (lens->contains("zfar")) camera.far = float_in(*lens, "zfar", 0.0F);
            view_.cameras.push_back({camera, world_from_node, name, number});
        }
    }

    const GltfContents& contents_;
    GltfView& view_;
};

}  // namespace

std::vector<GltfPrimitiveId> GltfDocument::triangle_primitives() const {
    const GltfContents& contents = contents_->data;
    std::vector<GltfPrimitiveId> result;
    const Json& meshes = array_in(contents.root, "meshes");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Json& primitives = meshes[i]["primitives"];
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            if (has_triangles(primitives[k])) result.push_back({i, k});
        }
    }
    return result;
}

namespace {

/// Returns the matrices of an accessor, or none if it has another type.
std::vector<glm::mat4> matrices_of(const GltfContents& contents, std::size_t accessor) {
    const Json& json = contents.root["accessors"][accessor];
    const ElementLayout layout = element_layout(json);
    if (text_in(json, "type") != "MAT4" || layout.component_type != gltf_code::float32) return {};
    const PackedElements packed = packed_elements(contents, accessor);
    const std::string_view bytes = packed.bytes();
    std::vector<glm::mat4> matrices(bytes.size() / sizeof(glm::mat4));
    if (!matrices.empty())
        std::memcpy(matrices.data(), bytes.data(), matrices.size() * sizeof(glm::mat4));
    return matrices;
}

GltfSkin skin_from(const GltfContents& contents, const Json& json) {
    GltfSkin skin;
    for (const Json& joint : array_in(json, "joints"))
        skin.joints.push_back(joint.get<std::size_t>());
    if (const auto accessor = index_in(json, "inverseBindMatrices"))
        skin.joint_from_mesh = matrices_of(contents, *accessor);
    skin.joint_from_mesh.resize(skin.joints.size(), glm::mat4(1.0F));
    return skin;
}

std::vector<std::string> variants_of(const Json& root) {
    std::vector<std::string> names;
    const Json* extension = find(root, "extensions", "KHR_materials_variants");
    const Json* variants =
        extension == nullptr || !extension->is_object() ? nullptr : find(*extension, "variants");
    if (variants == nullptr || !variants->is_array()) return names;
    for (const Json& variant : *variants) {
        const Json* name = variant.is_object() ? find(variant, "name") : nullptr;
        names.push_back(name != nullptr && name->is_string() ? name->get<std::string>() : "");
    }
    return names;
}

}  // namespace

std::optional<std::size_t> GltfDocument::variant_material(GltfPrimitiveId id,
                                                          std::size_t variant) const {
    const GltfContents& contents = contents_->data;
    const Json* mappings =
        find(primitive_json(contents, id), "extensions", "KHR_materials_variants", "mappings");
    if (mappings == nullptr) return std::nullopt;
    for (const Json& mapping : *mappings) {
        for (const Json& number : array_in(mapping, "variants")) {
            if (number.get<double>() == static_cast<double>(variant))
                return index_in(mapping, "material");
        }
    }
    return std::nullopt;
}

GltfView GltfDocument::view() const {
    const GltfContents& contents = contents_->data;
    GltfView view;
    view.nodes = nodes_of(contents.root);
    for (const Json& material : array_in(contents.root, "materials")) {
        view.materials.push_back(material_from(contents.root, material));
    }
    for (std::size_t i = 0; i < array_in(contents.root, "images").size(); ++i)
        view.images.push_back(image_from(contents, i));
    for (const Json& name : array_in(contents.root, "extensionsRequired"))
        view.required_extensions.push_back(name.get<std::string>());
    for (const Json& skin : array_in(contents.root, "skins"))
        view.skins.push_back(skin_from(contents, skin));
    view.material_variants = variants_of(contents.root);
    SceneWalk(contents, view).run();
    return view;
}

namespace {

std::optional<KeyChannel::Property> property_from(const std::string& path) {
    if (path == "translation") return KeyChannel::Property::translation;
    if (path == "rotation") return KeyChannel::Property::rotation;
    if (path == "scale") return KeyChannel::Property::scale;
    if (path == "weights") return KeyChannel::Property::weights;
    return std::nullopt;
}

KeyInterpolation interpolation_from(const std::string& name) {
    if (name == "STEP") return KeyInterpolation::step;
    if (name == "CUBICSPLINE") return KeyInterpolation::cubic_spline;
    return KeyInterpolation::linear;
}

std::vector<glm::vec4> values_of(const GltfContents& contents, std::size_t accessor,
                                 KeyChannel::Property property) {
    if (property == KeyChannel::Property::rotation)
        return float_elements<glm::vec4>(contents, accessor);
    std::vector<glm::vec4> values;
    if (property == KeyChannel::Property::pointer) {
        const std::string type = text_in(contents.root["accessors"][accessor], "type");
        if (type == "VEC4") return float_elements<glm::vec4>(contents, accessor);
        if (type == "SCALAR") {
            for (const glm::vec1& value : float_elements<glm::vec1>(contents, accessor))
                values.emplace_back(value.x, 0.0F, 0.0F, 0.0F);
            return values;
        }
        if (type == "VEC2") {
            for (const glm::vec2& value : float_elements<glm::vec2>(contents, accessor))
                values.emplace_back(value, 0.0F, 0.0F);
            return values;
        }
    }
    for (const glm::vec3& value : float_elements<glm::vec3>(contents, accessor))
        values.emplace_back(value, 0.0F);
    return values;
}

bool is_usable(const KeyChannel& channel) {
    const bool cubic = channel.interpolation == KeyInterpolation::cubic_spline;
    const std::size_t per_key = cubic ? 3 : 1;
    if (channel.times.empty()) return false;
    if (channel.property == KeyChannel::Property::weights) {
        if (channel.weights.empty() ||
            channel.weights.size() % (per_key * channel.times.size()) != 0)
            return false;
        if (!std::all_of(channel.weights.begin(), channel.weights.end(),
                         [](float weight) { return std::isfinite(weight); }))
            return false;
    } else if (channel.values.size() != per_key * channel.times.size()) {
        return false;
    }
    const auto no_order =
        std::adjacent_find(channel.times.begin(), channel.times.end(), std::greater_equal<float>());
    if (no_order != channel.times.end() || !(channel.times.front() >= 0.0F) ||
        !std::isfinite(channel.times.back())) {
        return false;
    }
    if (!std::all_of(channel.values.begin(), channel.values.end(), is_finite<4, float>))
        return false;
    if (channel.property != KeyChannel::Property::rotation) return true;
    for (std::size_t key = 0; key < channel.times.size(); ++key) {
        if (channel.values[key * per_key + per_key / 2] == glm::vec4(0.0F)) return false;
    }
    return true;
}

/// The keys of a channel, or nullopt if its accessors are unusable.
std::optional<KeyChannel> keys_from(const GltfContents& contents, const Json& sampler,
                                    std::size_t node, KeyChannel::Property property) {
    KeyChannel channel{.node = node, .property = property, .times = {}, .values = {}};
    channel.interpolation = interpolation_from(text_in(sampler, "interpolation"));
    try {
        for (const auto& time : float_elements<glm::vec1>(contents, size_in(sampler, "input")))
            channel.times.push_back(time.x);
        if (property == KeyChannel::Property::weights) {
            for (const auto& weight :
                 float_elements<glm::vec1>(contents, size_in(sampler, "output")))
                channel.weights.push_back(weight.x);
        } else {
            channel.values = values_of(contents, size_in(sampler, "output"), property);
        }
    } catch (const InvalidInput&) {
        return std::nullopt;
    }
    if (!is_usable(channel)) return std::nullopt;
    return channel;
}

/// The object that a channel moves.
struct ChannelTarget {
    std::optional<std::size_t> node;
    std::optional<KeyChannel::Property> property;
    std::string pointer{};
};

/// Returns the target of a JSON pointer, which may be a property of a node: "/nodes/3/scale".
ChannelTarget pointed_at(const GltfContents& contents, const std::string& pointer) {
    constexpr std::string_view nodes = "/nodes/";
    const std::size_t end = pointer.find('/', nodes.size());
    if (!pointer.starts_with(nodes) || end == std::string::npos)
        return {0, KeyChannel::Property::pointer, pointer};
    std::size_t node = 0;
    const char* const first = pointer.data() + nodes.size();
    const auto [stop, error] = std::from_chars(first, pointer.data() + end, node);
    const bool exists = error == std::errc() && stop == pointer.data() + end &&
                        node < array_in(contents.root, "nodes").size();
    const auto property = property_from(pointer.substr(end + 1));
    if (!exists || !property) return {0, KeyChannel::Property::pointer, pointer};
    return {node, property};
}

ChannelTarget target_of(const GltfContents& contents, const Json& target) {
    const std::string path = text_in(target, "path");
    if (path != "pointer") return {index_in(target, "node"), property_from(path)};
    const Json* extension = find(target, "extensions", "KHR_animation_pointer");
    const std::string pointer = extension == nullptr ? "" : text_in(*extension, "pointer");
    return pointer.empty() ? ChannelTarget{} : pointed_at(contents, pointer);
}

void add_channel(const GltfContents& contents, const Json& animation, const Json& json,
                 std::size_t number, KeyAnimation& result, Report& report) {
    const ChannelTarget target = target_of(contents, json["target"]);
    const std::optional<std::size_t> node = target.node;
    const std::optional<KeyChannel::Property> property = target.property;
    if (!property) {
        report.add("animation of an extension", "channel", number, "left out");
        return;
    }
    if (!node) return;  // By the specification, channels without a node are ignored.
    if (property != KeyChannel::Property::weights && property != KeyChannel::Property::pointer &&
        contents.root["nodes"][*node].contains("matrix")) {
        report.add("animated node with a matrix", "channel", number, "left out");
        return;
    }
    const Json& sampler = animation["samplers"][size_in(json, "sampler")];
    if (auto channel = keys_from(contents, sampler, *node, *property)) {
        channel->pointer = target.pointer;
        result.channels.push_back(std::move(*channel));
    } else {
        report.add("animation channel with unusable keys", "channel", number,
                   "left out: what it moves stays at rest");
    }
}

}  // namespace

std::vector<KeyAnimation> GltfDocument::animations(Report& report) const {
    const GltfContents& contents = contents_->data;
    std::vector<KeyAnimation> result;
    std::size_t number = 0;  // Counts the channels of all animations.
    for (const Json& json : array_in(contents.root, "animations")) {
        KeyAnimation& animation = result.emplace_back();
        animation.name = text_in(json, "name");
        for (const Json& channel : json["channels"])
            add_channel(contents, json, channel, number++, animation, report);
    }
    return result;
}

}  // namespace relief
