// SPDX-License-Identifier: Apache-2.0
// Validation of glTF documents: the table of known properties, to which material.h adds those of
// materials, one walk over a document along this table, and the checks beyond types (version,
// required extensions, ranges, node trees).
//
// extras are never examined. Properties that are not in the table are kept and ignored. The first
// offense throws InvalidInput. Source: glTF 2.0 (ISO/IEC 12113), chapters 3 and 5.
#include "io/gltf/gltf_contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "io/gltf/gltf_accessor.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

enum class Kind {
    boolean,
    integer,  ///< Must not be negative.
    number,
    numbers,  ///< An array of `length` numbers, or of any length if that is 0.
    string,
    strings,
    object,      ///< An object of the type that `refers` names.
    objects,     ///< An array of such objects.
    object_map,  ///< Such objects under any keys.
    index,       ///< An index into the array that `refers` names.
    indices,
    index_map,  ///< Indices under any keys.
    index_maps,
};

struct Rule {
    std::string_view type;
    const char* property;
    Kind kind;
    std::string_view refers = {};
    bool is_required = false;
    std::size_t length = 0;
};

constexpr bool required = true;

constexpr Rule rules[] = {
    {"glTF", "asset", Kind::object, "asset", required},
    {"glTF", "extensionsUsed", Kind::strings},
    {"glTF", "extensionsRequired", Kind::strings},
    {"glTF", "accessors", Kind::objects, "accessor"},
    {"glTF", "animations", Kind::objects, "animation"},
    {"glTF", "buffers", Kind::objects, "buffer"},
    {"glTF", "bufferViews", Kind::objects, "bufferView"},
    {"glTF", "cameras", Kind::objects, "camera"},
    {"glTF", "images", Kind::objects, "image"},
    {"glTF", "materials", Kind::objects, "material"},
    {"glTF", "meshes", Kind::objects, "mesh"},
    {"glTF", "nodes", Kind::objects, "node"},
    {"glTF", "samplers", Kind::objects, "sampler"},
    {"glTF", "scene", Kind::index, "scenes"},
    {"glTF", "scenes", Kind::objects, "scene"},
    {"glTF", "skins", Kind::objects, "skin"},
    {"glTF", "textures", Kind::objects, "texture"},
    {"asset", "version", Kind::string, {}, required},
    {"asset", "minVersion", Kind::string},
    {"accessor", "bufferView", Kind::index, "bufferViews"},
    {"accessor", "byteOffset", Kind::integer},
    {"accessor", "componentType", Kind::integer, {}, required},
    {"accessor", "normalized", Kind::boolean},
    {"accessor", "count", Kind::integer, {}, required},
    {"accessor", "type", Kind::string, {}, required},
    {"accessor", "max", Kind::numbers},
    {"accessor", "min", Kind::numbers},
    {"accessor", "sparse", Kind::object, "sparse"},
    {"accessor", "name", Kind::string},
    {"sparse", "count", Kind::integer, {}, required},
    {"sparse", "indices", Kind::object, "sparse.indices", required},
    {"sparse", "values", Kind::object, "sparse.values", required},
    {"sparse.indices", "bufferView", Kind::index, "bufferViews", required},
    {"sparse.indices", "byteOffset", Kind::integer},
    {"sparse.indices", "componentType", Kind::integer, {}, required},
    {"sparse.values", "bufferView", Kind::index, "bufferViews", required},
    {"sparse.values", "byteOffset", Kind::integer},
    {"animation", "channels", Kind::objects, "channel", required},
    {"animation", "samplers", Kind::objects, "animation.sampler", required},
    {"animation", "name", Kind::string},
    {"channel", "sampler", Kind::integer, {}, required},
    {"channel", "target", Kind::object, "channel.target", required},
    {"channel.target", "node", Kind::index, "nodes"},
    {"channel.target", "path", Kind::string, {}, required},
    {"animation.sampler", "input", Kind::index, "accessors", required},
    {"animation.sampler", "interpolation", Kind::string},
    {"animation.sampler", "output", Kind::index, "accessors", required},
    {"buffer", "uri", Kind::string},
    {"buffer", "byteLength", Kind::integer, {}, required},
    {"bufferView", "buffer", Kind::index, "buffers", required},
    {"bufferView", "byteOffset", Kind::integer},
    {"bufferView", "byteLength", Kind::integer, {}, required},
    {"bufferView", "byteStride", Kind::integer},
    {"bufferView", "target", Kind::integer},
    {"camera", "type", Kind::string, {}, required},
    {"camera", "perspective", Kind::object, "perspective"},
    {"camera", "orthographic", Kind::object, "orthographic"},
    {"camera", "name", Kind::string},
    {"perspective", "yfov", Kind::number, {}, required},
    {"perspective", "znear", Kind::number, {}, required},
    {"perspective", "zfar", Kind::number},
    {"perspective", "aspectRatio", Kind::number},
    {"orthographic", "xmag", Kind::number},
    {"orthographic", "ymag", Kind::number, {}, required},
    {"orthographic", "znear", Kind::number, {}, required},
    {"orthographic", "zfar", Kind::number, {}, required},
    {"image", "uri", Kind::string},
    {"image", "mimeType", Kind::string},
    {"image", "bufferView", Kind::index, "bufferViews"},
    {"image", "name", Kind::string},
    {"material", "name", Kind::string},
    {"material", "pbrMetallicRoughness", Kind::object, "pbr"},
    {"material", "emissiveFactor", Kind::numbers, {}, false, 3},
    {"material", "alphaMode", Kind::string},
    {"pbr", "baseColorFactor", Kind::numbers, {}, false, 4},
    {"textureInfo", "index", Kind::index, "textures", required},
    {"textureInfo", "texCoord", Kind::integer},
    {"textureInfo", "scale", Kind::number},
    {"textureInfo", "strength", Kind::number},
    {"mesh", "primitives", Kind::objects, "primitive", required},
    {"mesh", "weights", Kind::numbers},
    {"mesh", "name", Kind::string},
    {"primitive", "attributes", Kind::index_map, "accessors", required},
    {"primitive", "indices", Kind::index, "accessors"},
    {"primitive", "material", Kind::index, "materials"},
    {"primitive", "mode", Kind::integer},
    {"primitive", "targets", Kind::index_maps, "accessors"},
    {"node", "camera", Kind::index, "cameras"},
    {"node", "children", Kind::indices, "nodes"},
    {"node", "skin", Kind::index, "skins"},
    {"node", "matrix", Kind::numbers, {}, false, 16},
    {"node", "mesh", Kind::index, "meshes"},
    {"node", "rotation", Kind::numbers, {}, false, 4},
    {"node", "scale", Kind::numbers, {}, false, 3},
    {"node", "translation", Kind::numbers, {}, false, 3},
    {"node", "weights", Kind::numbers},
    {"node", "name", Kind::string},
    {"sampler", "magFilter", Kind::integer},
    {"sampler", "minFilter", Kind::integer},
    {"sampler", "wrapS", Kind::integer},
    {"sampler", "wrapT", Kind::integer},
    {"scene", "nodes", Kind::indices, "nodes"},
    {"scene", "name", Kind::string},
    {"skin", "inverseBindMatrices", Kind::index, "accessors"},
    {"skin", "skeleton", Kind::index, "nodes"},
    {"skin", "joints", Kind::indices, "nodes", required},
    {"texture", "sampler", Kind::index, "samplers"},
    {"texture", "source", Kind::index, "images"},
    // Extensions, named by what they extend: "TYPE+NAME".
    {"primitive+KHR_draco_mesh_compression", "bufferView", Kind::index, "bufferViews", required},
    {"primitive+KHR_draco_mesh_compression", "attributes", Kind::object, {}, required},
    {"primitive+CESIUM_primitive_outline", "indices", Kind::index, "accessors"},
    {"primitive+KHR_materials_variants", "mappings", Kind::objects, "variantMapping", required},
    {"variantMapping", "material", Kind::index, "materials", required},
    {"variantMapping", "variants", Kind::numbers, {}, required},
    {"bufferView+EXT_meshopt_compression", "buffer", Kind::index, "buffers", required},
    {"bufferView+EXT_meshopt_compression", "byteOffset", Kind::integer},
    {"bufferView+EXT_meshopt_compression", "byteLength", Kind::integer, {}, required},
    {"bufferView+EXT_meshopt_compression", "byteStride", Kind::integer, {}, required},
    {"bufferView+EXT_meshopt_compression", "count", Kind::integer, {}, required},
    {"bufferView+EXT_meshopt_compression", "mode", Kind::string, {}, required},
    {"bufferView+EXT_meshopt_compression", "filter", Kind::string},
    {"bufferView+KHR_meshopt_compression", "buffer", Kind::index, "buffers", required},
    {"bufferView+KHR_meshopt_compression", "byteOffset", Kind::integer},
    {"bufferView+KHR_meshopt_compression", "byteLength", Kind::integer, {}, required},
    {"bufferView+KHR_meshopt_compression", "byteStride", Kind::integer, {}, required},
    {"bufferView+KHR_meshopt_compression", "count", Kind::integer, {}, required},
    {"bufferView+KHR_meshopt_compression", "mode", Kind::string, {}, required},
    {"bufferView+KHR_meshopt_compression", "filter", Kind::string},
    {"node+MSFT_lod", "ids", Kind::indices, "nodes", required},
    {"material+MSFT_lod", "ids", Kind::indices, "materials", required},
    {"node+EXT_mesh_gpu_instancing", "attributes", Kind::index_map, "accessors"},
    {"glTF+EXT_structural_metadata", "propertyTables", Kind::objects, "propertyTable"},
    {"propertyTable", "properties", Kind::object_map, "propertyTable.property"},
    {"propertyTable.property", "values", Kind::index, "bufferViews"},
    {"propertyTable.property", "arrayOffsets", Kind::index, "bufferViews"},
    {"propertyTable.property", "stringOffsets", Kind::index, "bufferViews"},
    {"glTF+EXT_lights_ies", "lights", Kind::objects, "iesLight"},
    {"iesLight", "bufferView", Kind::index, "bufferViews"},
    {"glTF+KHR_lights_punctual", "lights", Kind::objects, "light", required},
    {"light", "type", Kind::string, {}, required},
    {"light", "color", Kind::numbers, {}, false, 3},
    {"light", "intensity", Kind::number},
    {"light", "range", Kind::number},
    {"light", "name", Kind::string},
    {"light", "spot", Kind::object, "spot"},
    {"spot", "innerConeAngle", Kind::number},
    {"spot", "outerConeAngle", Kind::number},
    {"node+KHR_lights_punctual", "light", Kind::index, "lights", required},
    {"material+KHR_materials_emissive_strength", "emissiveStrength", Kind::number},
    {"textureInfo+KHR_texture_transform", "offset", Kind::numbers, {}, false, 2},
    {"textureInfo+KHR_texture_transform", "rotation", Kind::number},
    {"textureInfo+KHR_texture_transform", "scale", Kind::numbers, {}, false, 2},
    {"textureInfo+KHR_texture_transform", "texCoord", Kind::integer},
    {"texture+KHR_texture_basisu", "source", Kind::index, "images"},
    {"texture+EXT_texture_webp", "source", Kind::index, "images"},
    {"texture+EXT_texture_avif", "source", Kind::index, "images"},
    {"texture+MSFT_texture_dds", "source", Kind::index, "images"},
};

/// Extensions without indices into accessors, bufferViews or buffers beyond those in the table. A
/// name that ends in '*' is a prefix.
constexpr std::array known_extensions = {
    "KHR_materials_*",
    "KHR_texture_*",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_animation_pointer",
    "KHR_xmp*",
    "KHR_node_*",
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "EXT_mesh_gpu_instancing",
    "EXT_mesh_features",
    "EXT_instance_features",
    "EXT_structural_metadata",
    "EXT_texture_*",
    "EXT_lights_image_based",
    "EXT_lights_ies",
    "MSFT_texture_dds",
    "MSFT_lod",
    "MSFT_packing_*",
    "CESIUM_primitive_outline",
    "AGI_*",
    "FB_geometry_metadata",
    "FB_ngon_encoding",
    "ADOBE_materials_*",
    "VRM",
    "VRMC_*",
};

bool is_known(std::string_view extension) {
    return std::any_of(known_extensions.begin(), known_extensions.end(),
                       [&](std::string_view known) {
                           if (!known.ends_with('*')) return known == extension;
                           known.remove_suffix(1);
                           return extension.starts_with(known);
                       });
}

using RulesByType = std::map<std::string, std::vector<Rule>, std::less<>>;

/// Returns the type that has a property of a material, by its path (SceneField::gltf).
std::string type_of_path(std::string_view path) {
    constexpr std::string_view extensions = "extensions/";
    const std::size_t end = path.rfind('/');
    if (end == std::string_view::npos) return "material";
    const std::string_view owner = path.substr(0, end);
    if (owner.starts_with(extensions))
        return fmt::format("material+{}", owner.substr(extensions.size()));
    return owner == "pbrMetallicRoughness" ? "pbr" : "textureInfo";
}

/// Adds the factors and textures of material.h, unless the table above has their rules.
void add_material_rules(RulesByType& by_type) {
    const auto add = [&](const char* path, Kind kind, std::size_t length = 0) {
        const std::string_view all = path;
        if (all.empty()) return;
        const char* const property = path + (all.rfind('/') + 1);
        const auto type = by_type.try_emplace(type_of_path(all)).first;
        for (const Rule& known : type->second) {
            if (known.property == std::string_view(property)) return;
        }
        const std::string_view refers = kind == Kind::object ? "textureInfo" : "";
        type->second.push_back({type->first, property, kind, refers, false, length});
    };
    const auto add_field = [&](const auto& field) {
        using Value = decltype(field.default_value());
        if constexpr (std::is_same_v<Value, bool>)
            add(field.gltf, Kind::boolean);
        else if constexpr (std::is_same_v<Value, glm::vec3>)
            add(field.gltf, Kind::numbers, 3);
        else
            add(field.gltf, Kind::number);
    };
    for_each_field<Material>(add_field);
    for_each_field<MetallicRoughness>(add_field);
    for (const UndrawnFactor& factor : undrawn_factors)
        add(factor.gltf, Kind::number);
    for (const TextureSlotInfo& slot : texture_slots)
        add(slot.gltf, Kind::object);
}

/// The rules of one type.
const std::vector<Rule>& rules_of(std::string_view type) {
    static const auto by_type = [] {
        RulesByType result;
        for (const Rule& rule : rules)
            result[std::string(rule.type)].push_back(rule);
        add_material_rules(result);
        return result;
    }();
    static const std::vector<Rule> none;
    const auto found = by_type.find(type);
    return found == by_type.end() ? none : found->second;
}

/// The location of a value, as a chain towards the root. It becomes text only for messages.
struct ValuePath {
    const ValuePath* parent = nullptr;
    std::string_view key;
    std::size_t index = 0;

    [[nodiscard]] std::string text() const {
        const std::string outer = parent == nullptr ? std::string() : parent->text();
        if (key.empty()) return parent == nullptr ? outer : fmt::format("{}[{}]", outer, index);
        return outer.empty() ? std::string(key) : fmt::format("{}.{}", outer, key);
    }
};

/// Callbacks of a walk over a document.
struct Visitor {
    virtual ~Visitor() = default;
    /// Called before the walk descends into a property; `value` is null if it is absent.
    virtual void property(const ValuePath&, const Rule&, Json* /*value*/) {}
    virtual void index(const ValuePath&, std::string_view /*target*/, Json& /*value*/) {}
    virtual void extension(const ValuePath&, std::string_view /*name*/, Json& /*value*/) {}
    /// Called before the walk descends into an object. It may erase properties.
    virtual void object(std::string_view /*type*/, Json& /*value*/) {}
};

void walk(Json& object, std::string_view type, const ValuePath& place, Visitor& visitor);

void walk_each(Json& container, std::string_view type, const ValuePath& place, Visitor& visitor) {
    std::size_t number = 0;
    for (auto& [key, value] : container.items()) {
        const bool is_map = container.is_object();
        const ValuePath inner{&place, is_map ? std::string_view(key) : std::string_view(),
                              number++};
        walk(value, type, inner, visitor);
    }
}

void visit_each_index(Json& container, std::string_view target, const ValuePath& place,
                      Visitor& visitor) {
    std::size_t number = 0;
    for (auto& [key, value] : container.items()) {
        const bool is_map = container.is_object();
        visitor.index({&place, is_map ? std::string_view(key) : std::string_view(), number++},
                      target, value);
    }
}

void walk_property(Json& value, const Rule& rule, const ValuePath& place, Visitor& visitor) {
    switch (rule.kind) {
        case Kind::object:
            walk(value, rule.refers, place, visitor);
            break;
        case Kind::objects:
        case Kind::object_map:
            walk_each(value, rule.refers, place, visitor);
            break;
        case Kind::index:
            visitor.index(place, rule.refers, value);
            break;
        case Kind::indices:
        case Kind::index_map:
            visit_each_index(value, rule.refers, place, visitor);
            break;
        case Kind::index_maps: {
            std::size_t number = 0;
            for (Json& map : value) {
                visit_each_index(map, rule.refers, {&place, {}, number++}, visitor);
            }
            break;
        }
        default:
            break;
    }
}

/// Walks an object and everything in it that the table knows. Properties come in the table's order.
void walk(Json& object, std::string_view type, const ValuePath& place, Visitor& visitor) {
    visitor.object(type, object);
    for (const Rule& rule : rules_of(type)) {
        const auto found = object.find(rule.property);
        const ValuePath inner{&place, rule.property};
        visitor.property(inner, rule, found == object.end() ? nullptr : &*found);
        if (found != object.end()) walk_property(*found, rule, inner, visitor);
    }
    const auto extensions = object.find("extensions");
    if (extensions == object.end()) return;
    const ValuePath outer{&place, "extensions"};
    visitor.property(outer, {type, "extensions", Kind::object}, &*extensions);
    for (auto& [name, value] : extensions->items()) {
        const ValuePath inner{&outer, name};
        visitor.extension(inner, name, value);
        const std::string extension_type = fmt::format("{}+{}", type, name);
        if (value.is_object()) walk(value, extension_type, inner, visitor);
    }
}

[[noreturn]] void fail(const ValuePath& place, const std::string& problem) {
    throw InvalidInput(fmt::format("{} {}", place.text(), problem));
}

/// Numbers that are read are unsigned; those of documents that were made may be signed.
bool is_whole(const Json& value) {
    return value.is_number_unsigned() ||
           (value.is_number_integer() && value.get<std::int64_t>() >= 0);
}

class Checker : public Visitor {
  public:
    explicit Checker(const Json& root) {
        for (const Rule& rule : rules_of("glTF")) {
            if (rule.kind == Kind::objects) counts_[rule.property] = count(root, rule.property);
        }
        const Json* lights = find(root, "extensions", "KHR_lights_punctual");
        counts_["lights"] = lights != nullptr && lights->is_object() ? count(*lights, "lights") : 0;
    }

    void property(const ValuePath& place, const Rule& rule, Json* value) override {
        if (value == nullptr) {
            if (rule.is_required) fail(place, "is missing");
            return;
        }
        if (const char* wanted = mismatch(rule, *value))
            fail(place, fmt::format("is not {}", wanted));
    }

    void index(const ValuePath& place, std::string_view target, Json& value) override {
        if (!is_whole(value)) fail(place, "is not an index");
        const std::size_t count = counts_.find(target)->second;
        if (value.get<std::uint64_t>() >= count) {
            fail(place, fmt::format("is {}, but there are only {} {}", value.get<std::uint64_t>(),
                                    count, target));
        }
    }

    void extension(const ValuePath& place, std::string_view, Json& value) override {
        if (!value.is_object()) fail(place, "is not an object");
    }

  private:
    static std::size_t count(const Json& object, const char* key) {
        const Json* array = find(object, key);
        return array != nullptr && array->is_array() ? array->size() : 0;
    }

    template <typename Predicate>
    static bool all(const Json& array, Predicate predicate) {
        return std::all_of(array.begin(), array.end(), predicate);
    }

    /// The expected type, or null if the value has it.
    static const char* mismatch(const Rule& rule, const Json& value) {
        const auto is_object = [](const Json& item) { return item.is_object(); };
        const auto is_number = [](const Json& item) { return item.is_number(); };
        const auto is_string = [](const Json& item) { return item.is_string(); };
        switch (rule.kind) {
            case Kind::boolean:
                return value.is_boolean() ? nullptr : "true or false";
            case Kind::integer:
                // Offsets and lengths are added: this limit keeps sums far from overflow.
                return is_whole(value) && value.get<std::uint64_t>() < (1ULL << 53U)
                           ? nullptr
                           : "a whole number";
            case Kind::number:
                return value.is_number() ? nullptr : "a number";
            case Kind::numbers:
                return value.is_array() && all(value, is_number) &&
                               (rule.length == 0 || value.size() == rule.length)
                           ? nullptr
                           : "an array of numbers of the right length";
            case Kind::string:
                return value.is_string() ? nullptr : "a string";
            case Kind::strings:
                return value.is_array() && all(value, is_string) ? nullptr : "an array of strings";
            case Kind::object:
            case Kind::index_map:
                return value.is_object() ? nullptr : "an object";
            case Kind::object_map:
                return value.is_object() && all(value, is_object) ? nullptr : "objects by name";
            case Kind::objects:
            case Kind::index_maps:
                return value.is_array() && all(value, is_object) ? nullptr : "an array of objects";
            case Kind::indices:
                return value.is_array() ? nullptr : "an array of indices";
            case Kind::index:
                return nullptr;  // Checked by index().
        }
        return nullptr;
    }

    std::map<std::string_view, std::size_t> counts_;
};

}  // namespace

void check_schema(const Json& root) {
    if (!root.is_object()) throw InvalidInput("the JSON is not an object");
    Checker checker(root);
    // The checker changes nothing, but it shares the walk with a visitor that does.
    walk(const_cast<Json&>(root), "glTF", {}, checker);
}

void visit_references(Json& root,
                      const std::function<void(std::string_view target, Json& index)>& visit) {
    struct : Visitor {
        const std::function<void(std::string_view, Json&)>* visit = nullptr;
        void index(const ValuePath&, std::string_view target, Json& value) override {
            (*visit)(target, value);
        }
    } visitor;
    visitor.visit = &visit;
    walk(root, "glTF", {}, visitor);
}

void visit_objects(Json& root,
                   const std::function<void(std::string_view type, Json& object)>& visit) {
    struct : Visitor {
        const std::function<void(std::string_view, Json&)>* visit = nullptr;
        void object(std::string_view type, Json& value) override { (*visit)(type, value); }
    } visitor;
    visitor.visit = &visit;
    walk(root, "glTF", {}, visitor);
}

bool has_extension(const Json& root, std::string_view name) {
    struct : Visitor {
        std::string_view wanted;
        bool found = false;
        void extension(const ValuePath&, std::string_view extension, Json&) override {
            found = found || extension == wanted;
        }
    } visitor;
    visitor.wanted = name;
    walk(const_cast<Json&>(root), "glTF", {}, visitor);
    return visitor.found;
}

bool has_unknown_extension(const Json& root) {
    struct : Visitor {
        bool found = false;
        void extension(const ValuePath&, std::string_view name, Json&) override {
            found = found || !is_known(name);
        }
    } visitor;
    walk(const_cast<Json&>(root), "glTF", {}, visitor);
    return visitor.found;
}

namespace {

/// Parses "2.1" as 2 and 1.
std::pair<int, int> version_in(const Json& asset, const char* key) {
    const std::string text = text_in(asset, key);
    int major = -1;
    int minor = -1;
    const char* end = text.data() + text.size();
    const auto [dot, error] = std::from_chars(text.data(), end, major);
    if (error == std::errc() && dot != end && *dot == '.') std::from_chars(dot + 1, end, minor);
    if (major < 0 || minor < 0) fail_gltf("asset.{} is '{}', which is not a version", key, text);
    return {major, minor};
}

void check_version(const Json& root) {
    const Json& asset = root["asset"];
    const auto [major, minor] = version_in(asset, "version");
    if (major != 2) fail_gltf("asset.version is {}.{}, but only 2 is read", major, minor);
    if (asset.contains("minVersion") && version_in(asset, "minVersion") > std::pair(2, 0)) {
        fail_gltf("asset.minVersion is {}, but only 2.0 is read", text_in(asset, "minVersion"));
    }
}

/// Returns true for extensions that a document may require: those that do not affect meshes, and
/// those that relief decodes. A name that ends in '*' is a prefix.
bool is_accepted(std::string_view extension) {
    static constexpr std::array accepted = {
        "KHR_materials_*",
        "KHR_texture_*",
        "KHR_lights_punctual",
        "KHR_mesh_quantization",
        "KHR_draco_mesh_compression",
        "KHR_meshopt_compression",
        "KHR_animation_pointer",
        "KHR_xmp*",
        "KHR_node_visibility",
        "EXT_meshopt_compression",
        "EXT_mesh_gpu_instancing",
        "EXT_mesh_features",
        "EXT_instance_features",
        "EXT_structural_metadata",
        "EXT_texture_*",
        "EXT_lights_*",
        "MSFT_texture_dds",
        "MSFT_lod",
        "CESIUM_primitive_outline",
        "FB_geometry_metadata",
        "FB_ngon_encoding",
        "AGI_*",
        "ADOBE_materials_*",
    };
    return std::any_of(accepted.begin(), accepted.end(), [&](std::string_view known) {
        if (!known.ends_with('*')) return known == extension;
        known.remove_suffix(1);
        return extension.starts_with(known);
    });
}

void check_required_extensions(const Json& root) {
    for (const Json& name : array_in(root, "extensionsRequired")) {
        const auto& extension = name.get_ref<const std::string&>();
        if (is_accepted(extension)) continue;
        fail_gltf("requires the extension {}, which relief does not know", extension);
    }
}

void check_range(const std::string& what, std::size_t offset, std::size_t length, std::size_t limit,
                 const std::string& container) {
    if (offset + length > limit) {
        fail_gltf("{} covers bytes {} to {}, but {} has only {}", what, offset, offset + length,
                  container, limit);
    }
}

void check_views(const Json& root) {
    const Json& views = array_in(root, "bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
        const Json& view = views[i];
        const std::size_t buffer = size_in(view, "buffer");
        check_range(fmt::format("bufferViews[{}]", i), size_in(view, "byteOffset"),
                    size_in(view, "byteLength"), size_in(root["buffers"][buffer], "byteLength"),
                    fmt::format("buffers[{}]", buffer));
        const std::size_t stride = size_in(view, "byteStride", 4);
        if (stride < 4 || stride > 252) {
            fail_gltf("bufferViews[{}].byteStride is {}, outside 4 to 252", i, stride);
        }
        for (const char* extension : meshopt_extensions) {
            const Json* packed = find(view, "extensions", extension);
            if (packed == nullptr) continue;
            const std::size_t source = size_in(*packed, "buffer");
            check_range(fmt::format("bufferViews[{}].extensions.{}", i, extension),
                        size_in(*packed, "byteOffset"), size_in(*packed, "byteLength"),
                        size_in(root["buffers"][source], "byteLength"),
                        fmt::format("buffers[{}]", source));
        }
    }
}

/// Checks that `count` elements fit into a view.
void check_elements(const Json& root, const std::string& what, const Json& holder,
                    std::size_t count, std::size_t element_size) {
    const std::size_t number = size_in(holder, "bufferView");
    const Json& view = root["bufferViews"][number];
    const std::size_t stride = size_in(view, "byteStride", element_size);
    if (stride < element_size) {
        fail_gltf("{} has elements of {} bytes, but bufferViews[{}].byteStride is {}", what,
                  element_size, number, stride);
    }
    const std::size_t view_length = size_in(view, "byteLength");
    const std::size_t length = count == 0 ? 0 : (count - 1) * stride + element_size;
    // Counts below 2^53 and strides below 2^8 cannot overflow 64 bits.
    check_range(what, size_in(holder, "byteOffset"), length, view_length,
                fmt::format("bufferViews[{}]", number));
}

void check_sparse(const Json& root, const Json& accessor, const std::string& name) {
    const Json* sparse = find(accessor, "sparse");
    if (sparse == nullptr) return;
    const std::size_t count = size_in(*sparse, "count");
    if (count > size_in(accessor, "count")) {
        fail_gltf("{}.sparse.count is {}, but there are only {} elements", name, count,
                  size_in(accessor, "count"));
    }
    const Json& indices = (*sparse)["indices"];
    const std::size_t type = size_in(indices, "componentType");
    if (type != 5121 && type != 5123 && type != 5125) {
        fail_gltf("{}.sparse.indices.componentType is {}", name, type);
    }
    check_elements(root, name + ".sparse.indices", indices, count,
                   component_size(static_cast<int>(type)));
    check_elements(root, name + ".sparse.values", (*sparse)["values"], count,
                   element_layout(accessor).size);
}

void check_accessors(const Json& root) {
    const Json& accessors = array_in(root, "accessors");
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        const Json& accessor = accessors[i];
        const std::string name = fmt::format("accessors[{}]", i);
        if (component_size(static_cast<int>(
                std::min<std::size_t>(size_in(accessor, "componentType"), 100'000))) == 0) {
            fail_gltf("{}.componentType is {}", name, size_in(accessor, "componentType"));
        }
        if (component_count(text_in(accessor, "type")) == 0) {
            fail_gltf("{}.type is '{}'", name, text_in(accessor, "type"));
        }
        const std::size_t count = size_in(accessor, "count");
        if (accessor.contains("bufferView")) {
            check_elements(root, name, accessor, count, element_layout(accessor).size);
        }
        check_sparse(root, accessor, name);
    }
}

void check_primitives(const Json& root) {
    const Json& meshes = array_in(root, "meshes");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Json& primitives = meshes[i]["primitives"];
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            if (size_in(primitives[k], "mode", 4) > 6) {
                fail_gltf("meshes[{}].primitives[{}].mode is {}, more than 6", i, k,
                          size_in(primitives[k], "mode"));
            }
            constexpr std::size_t unsigned_int = 5125;
            const Json* position = find(primitives[k], "attributes", "POSITION");
            if (position == nullptr) continue;
            const Json& accessor = root["accessors"][position->get<std::size_t>()];
            if (size_in(accessor, "componentType") == unsigned_int) {
                fail_gltf(
                    "meshes[{}].primitives[{}].attributes.POSITION has integers of 32 bits, "
                    "which no extension permits",
                    i, k);
            }
        }
    }
}

void check_animations(const Json& root) {
    const Json& animations = array_in(root, "animations");
    for (std::size_t i = 0; i < animations.size(); ++i) {
        const std::size_t samplers = animations[i]["samplers"].size();
        const Json& channels = animations[i]["channels"];
        for (std::size_t k = 0; k < channels.size(); ++k) {
            if (size_in(channels[k], "sampler") < samplers) continue;
            fail_gltf("animations[{}].channels[{}].sampler is {}, but there are only {}", i, k,
                      size_in(channels[k], "sampler"), samplers);
        }
    }
}

/// Checks that every node has at most one parent and is below a root. There are then no cycles, and
/// a walk over the nodes is linear.
void check_nodes(const Json& root) {
    const Json& nodes = array_in(root, "nodes");
    std::vector<bool> has_parent(nodes.size(), false);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const Json& child : array_in(nodes[i], "children")) {
            const auto number = child.get<std::size_t>();
            if (has_parent[number]) fail_gltf("nodes[{}] has more than one parent", number);
            has_parent[number] = true;
        }
    }
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!has_parent[i]) open.push_back(i);
    }
    std::size_t reached = 0;
    std::vector<bool> is_reached(nodes.size(), false);
    while (!open.empty()) {
        const std::size_t node = open.back();
        open.pop_back();
        is_reached[node] = true;
        ++reached;
        for (const Json& child : array_in(nodes[node], "children")) {
            open.push_back(child.get<std::size_t>());
        }
    }
    if (reached == nodes.size()) return;
    const auto lost = std::find(is_reached.begin(), is_reached.end(), false) - is_reached.begin();
    fail_gltf("nodes[{}] is its own ancestor", lost);
}

}  // namespace

void check_gltf(const Json& root) {
    check_schema(root);
    check_version(root);
    check_required_extensions(root);
    check_views(root);
    check_accessors(root);
    check_primitives(root);
    check_animations(root);
    check_nodes(root);
}

}  // namespace relief::detail
