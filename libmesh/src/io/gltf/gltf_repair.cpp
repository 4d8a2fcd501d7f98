// SPDX-License-Identifier: Apache-2.0
// Repairs of the JSON of a document that is written: extensions that are not declared, empty
// arrays, numbers out of range, properties without the one that they depend on, and attributes that
// a primitive must have. Each is an error of the Khronos validator, and no reader needs the fault.
//
// Source: glTF 2.0 (ISO/IEC 12113), chapter 5, and the specifications of the extensions.
// Tests: tests/mesh/io/gltf/gltf_repair_test.cpp, tests/tools/valid_outputs_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"

namespace relief::detail {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr const char* quantization = "KHR_mesh_quantization";

/// The values that glTF permits for a number, or for each number of an array.
struct NumberRange {
    std::string_view type;
    const char* path;
    FieldRange range;
};

/// Those of the numbers that no field of material.h has alone.
constexpr NumberRange more_ranges[] = {
    {"material", "emissiveFactor", {0, 1}},
    {"material", "extensions/KHR_materials_emissive_strength/emissiveStrength", non_negative_range},
    {"light", "color", {0, 1}},
    {"light", "intensity", non_negative_range},
};

const std::vector<NumberRange>& number_ranges() {
    static const auto all = [] {
        std::vector<NumberRange> result(std::begin(more_ranges), std::end(more_ranges));
        const auto add = [&](const auto& field) {
            if (*field.gltf != '\0') result.push_back({"material", field.gltf, field.gltf_range});
        };
        for_each_field<Material>(add);
        for_each_field<MetallicRoughness>(add);
        for (const auto& [path, range] : undrawn_factors)
            result.push_back({"material", path, range});
        return result;
    }();
    return all;
}

/// The types that an extension of Khronos extends.
struct ExtensionPlace {
    std::string_view extension;
    std::string_view types;
};

constexpr ExtensionPlace places[] = {
    {"KHR_texture_transform", "textureInfo"}, {"KHR_texture_basisu", "texture"},
    {"EXT_texture_webp", "texture"},          {"KHR_draco_mesh_compression", "primitive"},
    {"KHR_lights_punctual", "glTF node"},     {"KHR_materials_variants", "glTF primitive"},
    {"KHR_materials_unlit", "material"},      {"KHR_materials_emissive_strength", "material"},
};

/// Returns the types that an extension extends; "" if that is not known.
std::string_view extended_types(std::string_view extension) {
    const auto* const place =
        std::ranges::find(places, extension, [](const ExtensionPlace& p) { return p.extension; });
    if (place != std::end(places)) return place->types;
    const std::string prefix = fmt::format("extensions/{}/", extension);
    const bool is_undrawn = std::ranges::any_of(undrawn_factors, [&](const UndrawnFactor& factor) {
        return std::string_view(factor.gltf).starts_with(prefix);
    });
    return is_undrawn || has_factors(extension) ? "material" : "";
}

bool is_misplaced(std::string_view extension, std::string_view type) {
    const std::string_view types = extended_types(extension);
    if (types.empty() || type.find('+') != std::string_view::npos) return false;
    for (std::size_t begin = 0; begin < types.size();) {
        const std::size_t end = std::min(types.find(' ', begin), types.size());
        if (types.substr(begin, end - begin) == type) return false;
        begin = end + 1;
    }
    return true;
}

/// Arrays that may be absent, but not empty.
constexpr std::array<std::string_view, 18> optional_arrays = {
    "accessors", "animations", "buffers", "bufferViews", "cameras",        "images",
    "materials", "meshes",     "nodes",   "samplers",    "scenes",         "skins",
    "textures",  "children",   "weights", "targets",     "extensionsUsed", "extensionsRequired"};

class DocumentRepair {
  public:
    DocumentRepair(GltfContents& contents, Report& report)
        : contents_(contents), root_(contents.root), report_(report) {}

    void run() {
        visit_objects(root_, [&](std::string_view type, Json& object) {
            const std::size_t number = counts_[std::string(type)]++;
            repair_extensions(type, object, number);
            erase_empty(type, object, number);
            clamp(type, object, number);
            if (type == "node") repair_node(object, number);
            if (type == "accessor") repair_accessor(object, number);
        });
        Json& meshes = root_.contains("meshes") ? root_["meshes"] : none_;
        for (Json& mesh : meshes)
            repair_mesh(mesh);
        repair_scenes();
        repair_images();
        repair_declarations();
    }

  private:
    void repair_extensions(std::string_view type, Json& object, std::size_t number) {
        const auto found = object.find("extensions");
        if (found == object.end() || !found->is_object()) return;
        std::set<std::string> misplaced;
        for (const auto& [name, value] : found->items()) {
            if (is_misplaced(name, type))
                misplaced.insert(name);
            else
                extensions_.insert(name);
        }
        for (const std::string& name : misplaced) {
            erase_extension(object, name.c_str());
            report_.add(name + " in the wrong place", type, number, "is left out");
        }
    }

    /// glTF forbids empty arrays. Those that are required stay and are refused.
    void erase_empty(std::string_view type, Json& object, std::size_t number) {
        if (type.find('+') != std::string_view::npos) return;
        std::vector<std::string> empty;
        for (const auto& [name, value] : object.items()) {
            const bool is_required = name == "samplers" && type == "animation";
            const bool is_known = std::ranges::find(optional_arrays, name) != optional_arrays.end();
            if (value.is_array() && value.empty() && is_known && !is_required)
                empty.push_back(name);
        }
        for (const std::string& name : empty) {
            object.erase(name);
            report_.add(fmt::format("empty array '{}'", name), type, number, "is left out");
        }
    }

    void clamp(std::string_view type, Json& object, std::size_t number) {
        for (const auto& [owner, path, range] : number_ranges()) {
            if (owner != type) continue;
            // The object is not constant, and neither are its parts.
            auto* const value = const_cast<Json*>(find_path(object, path));
            if (value == nullptr) continue;
            const double min = limit(range.min);
            const double max = limit(range.max);
            bool is_changed = false;
            const auto clamp_one = [&](Json& one) {
                if (!one.is_number()) return;
                const auto before = one.get<double>();
                const double after = std::clamp(before, min, max);
                if (after == before) return;
                one = after;
                is_changed = true;
            };
            if (value->is_array())
                std::for_each(value->begin(), value->end(), clamp_one);
            else
                clamp_one(*value);
            if (!is_changed) continue;
            const std::string_view property = path;
            report_.add(fmt::format("{} out of range", property.substr(property.rfind('/') + 1)),
                        type, number, "becomes the nearest permitted value");
        }
    }

    /// Returns the limit of a range; infinite where there is none.
    static double limit(float number) {
        constexpr FieldRange all;
        return number == all.min || number == all.max ? std::copysign(unlimited, number)
                                                      : static_cast<double>(number);
    }

    void repair_node(Json& node, std::size_t number) {
        const auto erase = [&](const char* key, const std::string& problem) {
            if (node.erase(key) > 0)
                report_.add(fmt::format("{} {}", key, problem), "node", number, "is left out");
        };
        if (!node.contains("mesh")) {
            erase("weights", "of a node without a mesh");
            erase("skin", "of a node without a mesh");
        }
        if (node.contains("matrix")) {
            for (const char* key : {"translation", "rotation", "scale"})
                erase(key, "beside a matrix");
        }
        const auto mesh = index_in(node, "mesh");
        if (mesh) resize_weights(node, root_["meshes"][*mesh], "node", number);
        if (mesh && node.contains("skin") && !has_joints(root_["meshes"][*mesh]))
            erase("skin", "of a mesh without joints");
        normalize_rotation(node, number);
    }

    static bool has_joints(const Json& mesh) {
        return std::any_of(mesh["primitives"].begin(), mesh["primitives"].end(),
                           [](const Json& one) { return one["attributes"].contains("JOINTS_0"); });
    }

    void normalize_rotation(Json& node, std::size_t number) {
        if (!node.contains("rotation")) return;
        Json& rotation = node["rotation"];
        double square = 0.0;
        for (const Json& one : rotation)
            square += one.get<double>() * one.get<double>();
        const double length = std::sqrt(square);
        constexpr double tolerance = 0.005;  // Less than that of the validator.
        if (std::abs(length - 1.0) <= tolerance) return;
        const bool is_usable = length > 0.0 && std::isfinite(length);
        for (Json& one : rotation)
            one = is_usable ? one.get<double>() / length : 0.0;
        if (!is_usable) rotation[3] = 1.0;
        report_.add("rotation that is not of unit length", "node", number, "is normalized");
    }

    /// The weights of a node or of a mesh are as many as the morph targets.
    void resize_weights(Json& holder, const Json& mesh, const char* element, std::size_t number) {
        if (!holder.contains("weights") || mesh["primitives"].empty()) return;
        Json& weights = holder["weights"];
        const std::size_t wanted = array_in(mesh["primitives"][0], "targets").size();
        if (weights.size() == wanted) return;
        report_.add("weights that are not as many as the morph targets", element, number,
                    wanted == 0 ? "are left out" : "are cut, or continued with 0");
        while (weights.size() > wanted)
            weights.erase(weights.size() - 1);
        while (weights.size() < wanted)
            weights.push_back(0.0);
        if (wanted == 0) holder.erase("weights");
    }

    void repair_accessor(Json& accessor, std::size_t number) {
        if (!accessor.contains("bufferView") && accessor.erase("byteOffset") > 0)
            report_.add("byteOffset without a buffer view", "accessor", number, "is left out");
        const std::size_t type = size_in(accessor, "componentType");
        const bool is_fraction =
            type != std::size_t{gltf_code::float32} && type != std::size_t{gltf_code::uint32};
        if (bool_in(accessor, "normalized") && !is_fraction) {
            accessor.erase("normalized");
            report_.add("normalized floats or integers of 32 bits", "accessor", number,
                        "are kept as they are, without the mark");
        }
    }

    void repair_mesh(Json& mesh) {
        const std::size_t number = meshes_++;
        resize_weights(mesh, mesh, "mesh", number);
        for (Json& primitive : mesh["primitives"]) {
            rename_attributes(primitive);
            repair_targets(primitive);
            add_texcoords(primitive);
            declare_quantization(primitive);
            ++primitives_;
        }
    }

    static bool is_standard(std::string_view name) {
        for (const std::string_view known : {"POSITION", "NORMAL", "TANGENT"}) {
            if (name == known) return true;
        }
        for (const std::string_view set : {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"}) {
            if (!name.starts_with(set)) continue;
            const std::string_view digits = name.substr(set.size());
            return !digits.empty() && (digits == "0" || digits.front() != '0') &&
                   digits.find_first_not_of("0123456789") == std::string_view::npos;
        }
        return false;
    }

    /// Attributes that glTF does not name must begin with an underscore.
    void rename_attributes(Json& primitive) {
        Json& attributes = primitive["attributes"];
        std::vector<std::string> names;
        for (const auto& [name, accessor] : attributes.items()) {
            if (!is_standard(name) && !name.starts_with('_')) names.push_back(name);
        }
        for (const std::string& name : names) {
            std::string renamed = "_" + name;
            while (attributes.contains(renamed))
                renamed.insert(0, 1, '_');
            attributes[renamed] = attributes[name];
            attributes.erase(name);
            report_.add(fmt::format("attribute '{}' without a leading underscore", name),
                        "primitive", primitives_, "gets it");
        }
    }

    void repair_targets(Json& primitive) {
        if (!primitive.contains("targets")) return;
        for (Json& target : primitive["targets"]) {
            std::vector<std::string> names;
            for (const auto& [name, accessor] : target.items()) {
                if (!primitive["attributes"].contains(name)) names.push_back(name);
            }
            for (const std::string& name : names) {
                target.erase(name);
                report_.add(fmt::format("{} of a morph target that the primitive lacks", name),
                            "primitive", primitives_, "is left out");
            }
            const auto position = index_in(primitive["attributes"], "POSITION");
            if (!target.empty() || !position) continue;
            const Json zero = {0.0, 0.0, 0.0};
            target["POSITION"] = add_zeros("VEC3", *position);
            root_["accessors"].back()["min"] = zero;
            root_["accessors"].back()["max"] = zero;
            report_.add("empty morph target", "primitive", primitives_,
                        "becomes one without displacements");
        }
    }

    /// Adds an accessor of as many zeros as another has elements. They take no bytes, because it
    /// has no buffer view. \return its index
    std::size_t add_zeros(const char* type, std::size_t other) {
        Json accessor = {{"componentType", gltf_code::float32},
                         {"type", type},
                         {"count", root_["accessors"][other]["count"]}};
        root_["accessors"].push_back(std::move(accessor));
        return root_["accessors"].size() - 1;
    }

    /// Adds the sets that the material samples, at (0,0), and those below the highest set, as
    /// copies of it.
    void add_texcoords(Json& primitive) {
        Json& attributes = primitive["attributes"];
        const auto position = index_in(attributes, "POSITION");
        if (!position) return;
        for (const std::size_t set : sampled_sets(primitive)) {
            const std::string name = fmt::format("TEXCOORD_{}", set);
            if (attributes.contains(name)) continue;
            attributes[name] = add_zeros("VEC2", *position);
            report_.add(fmt::format("missing {} that the material samples", name), "primitive",
                        primitives_, "becomes (0,0)");
        }
        std::size_t highest = 0;
        std::size_t sets = 0;
        for (const auto& [name, accessor] : attributes.items()) {
            if (!name.starts_with("TEXCOORD_") || !is_standard(name)) continue;
            highest = std::max<std::size_t>(highest, std::stoul(name.substr(9).substr(0, 6)));
            ++sets;
        }
        constexpr std::size_t max_sets = 64;
        if (sets == 0 || sets == highest + 1 || highest >= max_sets) return;
        const Json source = attributes[fmt::format("TEXCOORD_{}", highest)];
        for (std::size_t set = 0; set < highest; ++set) {
            const std::string name = fmt::format("TEXCOORD_{}", set);
            if (attributes.contains(name)) continue;
            attributes[name] = source;
            report_.add(fmt::format("missing {} below TEXCOORD_{}", name, highest), "primitive",
                        primitives_, "becomes a copy of that");
        }
    }

    /// The sets of texture coordinates that the textures of a primitive's material name.
    std::set<std::size_t> sampled_sets(const Json& primitive) {
        std::set<std::size_t> sets;
        const auto material = index_in(primitive, "material");
        if (!material) return sets;
        Json copy = {{"asset", {{"version", "2.0"}}},
                     {"materials", Json::array({root_["materials"][*material]})}};
        visit_objects(copy, [&](std::string_view type, Json& object) {
            if (type != "textureInfo") return;
            const Json* transformed =
                find(object, "extensions", "KHR_texture_transform", "texCoord");
            sets.insert(size_in(object, "texCoord"));
            if (transformed != nullptr) sets.insert(transformed->get<std::size_t>());
        });
        return sets;
    }

    /// Integers of 8 and 16 bits need an extension.
    void declare_quantization(const Json& primitive) {
        for (const auto& [name, accessor] : primitive["attributes"].items()) {
            if (name != "POSITION" && name != "NORMAL" && name != "TANGENT") continue;
            const Json& json = root_["accessors"][accessor.get<std::size_t>()];
            if (size_in(json, "componentType") != std::size_t{gltf_code::float32})
                extensions_.insert(quantization);
        }
    }

    /// A scene names roots. A node below a root of the scene is drawn anyway.
    void repair_scenes() {
        std::set<std::size_t> children;
        for (const Json& node : array_in(root_, "nodes")) {
            for (const Json& child : array_in(node, "children"))
                children.insert(child.get<std::size_t>());
        }
        Json& scenes = root_.contains("scenes") ? root_["scenes"] : none_;
        for (std::size_t i = 0; i < scenes.size(); ++i) {
            if (!scenes[i].contains("nodes")) continue;
            Json kept = Json::array();
            for (const Json& node : scenes[i]["nodes"]) {
                if (std::ranges::find(kept, node) == kept.end()) kept.push_back(node);
            }
            if (kept.size() == scenes[i]["nodes"].size()) continue;
            scenes[i]["nodes"] = std::move(kept);
            report_.add("node that a scene names twice", "scene", i, "is kept once");
        }
    }

    void repair_images() {
        Json& images = root_.contains("images") ? root_["images"] : none_;
        for (std::size_t i = 0; i < images.size(); ++i) {
            Json& image = images[i];
            const auto number = index_in(image, "bufferView");
            if (!number) continue;
            Json& view = root_["bufferViews"][*number];
            if (view.erase("byteStride") > 0)
                report_.add("byteStride of an image", "image", i, "is left out");
            const std::string_view buffer = contents_.buffers[size_in(view, "buffer")].bytes();
            const std::size_t begin = std::min(size_in(view, "byteOffset"), buffer.size());
            const std::string actual =
                image_media_type(buffer.substr(begin, size_in(view, "byteLength")));
            if (actual.empty() || actual == text_in(image, "mimeType")) continue;
            image["mimeType"] = actual;
            report_.add("image of another type than its mimeType", "image", i,
                        "gets that of its bytes");
        }
    }

    void repair_declarations() {
        for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
            if (!root_.contains(list)) continue;
            std::set<std::string> seen;
            Json kept = Json::array();
            for (const Json& name : root_[list]) {
                if (seen.insert(name.get<std::string>()).second) kept.push_back(name);
            }
            if (kept.size() == root_[list].size()) continue;
            report_.add(fmt::format("name that {} holds twice", list), "document", 0,
                        "is kept once");
            root_[list] = std::move(kept);
        }
        for (const Json& name : array_in(root_, "extensionsRequired"))
            extensions_.insert(name.get<std::string>());
        for (const std::string& name : extensions_)
            declare("extensionsUsed", name);
        if (is_declared("extensionsUsed", quantization))
            declare("extensionsRequired", quantization);
    }

    [[nodiscard]] bool is_declared(const char* list, const std::string& name) const {
        const Json& names = array_in(root_, list);
        return std::find(names.begin(), names.end(), name) != names.end();
    }

    void declare(const char* list, const std::string& name) {
        if (is_declared(list, name)) return;
        root_[list].push_back(name);
        report_.add(fmt::format("{} that {} does not name", name, list), "document", 0,
                    "is added there");
    }

    GltfContents& contents_;
    Json& root_;
    Report& report_;
    Json none_ = Json::array();
    std::map<std::string, std::size_t> counts_;  ///< Visited objects, by type.
    std::set<std::string> extensions_;           ///< Those that the document uses.
    std::size_t meshes_ = 0;
    std::size_t primitives_ = 0;
};

}  // namespace

void repair_document(GltfContents& contents, Report& report) {
    DocumentRepair(contents, report).run();
    repair_accessors(contents, report);
}

}  // namespace relief::detail
