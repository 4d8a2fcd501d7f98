// SPDX-License-Identifier: Apache-2.0
// Reports values that can be read but have no meaning, and corrects the bounds of positions, by
// which viewers cull. Bounds of decompressed positions are corrected without a report, because
// compression moves positions. Source: glTF 2.0 (ISO/IEC 12113), sections 3.5.3 and 3.7.2 to 3.7.3.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "relief/mesh/report.h"

namespace relief::detail {
namespace {

template <typename Value, typename Visit>
void visit_values(std::string_view bytes, const Visit& visit) {
    for (std::size_t at = 0; at + sizeof(Value) <= bytes.size(); at += sizeof(Value)) {
        Value value;
        std::memcpy(&value, bytes.data() + at, sizeof value);
        visit(value, at / sizeof value);
    }
}

class ValueChecker {
  public:
    ValueChecker(GltfContents& contents, Report& report) : contents_(contents), report_(report) {}

    void check() {
        for (const Json& mesh : array_in(contents_.root, "meshes")) {
            for (const Json& primitive : mesh["primitives"]) {
                for (const auto& [name, accessor] : primitive["attributes"].items())
                    check_attribute(name, accessor.get<std::size_t>());
                for (const Json& target : array_in(primitive, "targets")) {
                    if (const auto position = index_in(target, "POSITION"))
                        check_attribute("POSITION", *position);
                }
            }
        }
        const Json& nodes = array_in(contents_.root, "nodes");
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            check_rotation(nodes[i], i);
            check_joints(nodes[i], i);
            check_levels(nodes[i], i);
        }
        check_transforms();
    }

  private:
    /// Each accessor is checked once for each kind of attribute.
    void check_attribute(std::string_view name, std::size_t accessor) {
        const std::string_view kind = name.substr(0, name.find('_'));
        if (!checked_.emplace(kind, accessor).second) return;
        const bool is_float =
            element_layout(contents_.root["accessors"][accessor]).component_type ==
            gltf_code::float32;
        const bool needs_float = kind == "POSITION" || kind == "NORMAL" || kind == "TANGENT";
        if (needs_float && !is_float && !uses_quantization()) {
            report_.add("integer vectors without KHR_mesh_quantization", "accessor", accessor,
                        "are read as they are");
        }
        if (kind == "POSITION") check_bounds(accessor, is_float);
        if (!is_float) return;
        if (kind == "COLOR") {
            check_floats(accessor, "non-finite color",
                         [](float value) { return std::isfinite(value); });
        }
        if (kind == "TEXCOORD") {
            check_floats(accessor, "non-finite texture coordinate",
                         [](float value) { return std::isfinite(value); });
        }
        if (kind == "WEIGHTS") {
            constexpr float rounding = 1e-5F;
            check_floats(accessor, "weight that is not between 0 and 1",
                         [](float value) { return value >= 0.0F && value <= 1.0F + rounding; });
        }
    }

    template <typename IsValid>
    void check_floats(std::size_t accessor, std::string_view kind, const IsValid& is_valid) {
        bool all_valid = true;
        visit<float>(accessor, [&](float value, std::size_t) { all_valid &= is_valid(value); });
        if (!all_valid) report_.add(kind, "accessor", accessor, "is read as it is");
    }

    /// Visits the components of an accessor. An accessor that cannot be read is an error where it
    /// is used.
    template <typename Value, typename Visit>
    void visit(std::size_t accessor, const Visit& visit) const {
        try {
            visit_values<Value>(packed_elements(contents_, accessor).bytes(), visit);
        } catch (const InvalidInput&) {
        }
    }

    [[nodiscard]] bool uses_quantization() const {
        const Json& used = array_in(contents_.root, "extensionsUsed");
        return std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end();
    }

    struct Bounds3 {
        std::array<float, 3> min, max;
    };

    void check_bounds(std::size_t accessor, bool is_float) {
        Json& json = contents_.root["accessors"][accessor];
        if (text_in(json, "type") != "VEC3") return;
        const auto is_vector = [&](const char* key) {
            const Json* value = find(json, key);
            return value != nullptr && value->is_array() && value->size() == 3 &&
                   std::all_of(value->begin(), value->end(),
                               [](const Json& one) { return one.is_number(); });
        };
        if (!is_vector("min") || !is_vector("max")) return add_bounds(json, accessor, is_float);
        if (!is_float) return;
        constexpr float infinity = std::numeric_limits<float>::infinity();
        Bounds3 actual{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
        visit<float>(accessor, [&](float value, std::size_t i) {
            if (!std::isfinite(value)) return;
            actual.min[i % 3] = std::min(actual.min[i % 3], value);
            actual.max[i % 3] = std::max(actual.max[i % 3], value);
        });
        double size = 0.0;
        double difference = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            if (actual.min[k] > actual.max[k]) return;  // No finite value.
            const auto low = static_cast<double>(actual.min[k]);
            const auto high = static_cast<double>(actual.max[k]);
            size = std::max({size, std::abs(low), std::abs(high)});
            difference = std::max({difference, std::abs(json["min"][k].get<double>() - low),
                                   std::abs(json["max"][k].get<double>() - high)});
        }
        constexpr double written_digits = 1e-5;  // Some programs write six digits.
        if (difference <= written_digits * size) return;
        json["min"] = actual.min;
        json["max"] = actual.max;
        if (is_decompressed(json)) return;
        report_.add("wrong bounds of positions", "accessor", accessor, "are recomputed");
    }

    void add_bounds(Json& json, std::size_t accessor, bool is_float) {
        try {
            if (is_float) {
                set_bounds(json, float_elements<glm::vec3>(contents_, accessor));
            } else {
                json["min"] = json["max"] = Json::array();
                update_bounds(json, raw_elements(contents_, accessor));
            }
        } catch (const InvalidInput&) {
            return;  // An accessor that cannot be read is an error where it is used.
        }
        report_.add("positions without bounds", "accessor", accessor, "get them");
    }

    [[nodiscard]] bool is_decompressed(const Json& accessor) const {
        const auto view = index_in(accessor, "bufferView");
        return view &&
               size_in(contents_.root["bufferViews"][*view], "buffer") == contents_.added_buffer;
    }

    void check_rotation(const Json& node, std::size_t number) {
        const auto q = vector_in(node, "rotation", glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
        constexpr float tolerance = 0.01F;
        if (std::abs(glm::length(q) - 1.0F) <= tolerance) return;
        report_.add("rotation that is not of unit length", "node", number, "is read as it is");
    }

    void check_joints(const Json& node, std::size_t number) {
        const auto mesh = index_in(node, "mesh");
        const auto skin = index_in(node, "skin");
        if (!mesh || !skin) return;
        const std::size_t joints = contents_.root["skins"][*skin]["joints"].size();
        for (const Json& primitive : contents_.root["meshes"][*mesh]["primitives"]) {
            for (const auto& [name, accessor] : primitive["attributes"].items()) {
                if (!name.starts_with("JOINTS_")) continue;
                if (largest_joint(accessor.get<std::size_t>()) < joints) continue;
                report_.add("joint that its skin does not have", "node", number,
                            "is read as it is");
                return;
            }
        }
    }

    /// Renderers that look for the coarsest level would not end.
    void check_levels(const Json& node, std::size_t number) {
        const Json* levels = find(node, "extensions", "MSFT_lod", "ids");
        if (levels == nullptr) return;
        const Json& nodes = contents_.root["nodes"];
        for (const Json& id : *levels) {
            const auto level = id.get<std::size_t>();
            if (level == number) {
                report_.add("node that is its own level of detail", "node", number,
                            "is read as it is");
            } else if (find(nodes[level], "extensions", "MSFT_lod") != nullptr) {
                report_.add("level of detail that has levels itself", "node", level,
                            "is read as it is");
            }
        }
    }

    /// Lengths in world space are squared in float.
    void check_transforms() {
        const Json& nodes = array_in(contents_.root, "nodes");
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            for (const char* key : {"matrix", "translation", "scale"}) {
                const Json* values = find(nodes[i], key);
                if (values == nullptr) continue;
                constexpr double limit = 1e18;
                const bool is_usable = std::all_of(
                    values->begin(), values->end(),
                    [](const Json& value) { return std::abs(value.get<double>()) <= limit; });
                if (is_usable) continue;
                report_.add("transform with numbers beyond 1e18", "node", i, "is read as it is");
                break;
            }
        }
    }

    std::size_t largest_joint(std::size_t accessor) {
        const auto [known, is_new] = largest_joints_.emplace(accessor, 0);
        if (!is_new) return known->second;
        std::size_t& largest = known->second;
        const auto take = [&](auto value, std::size_t) {
            largest = std::max<std::size_t>(largest, value);
        };
        switch (element_layout(contents_.root["accessors"][accessor]).component_type) {
            case gltf_code::uint8:
                visit<std::uint8_t>(accessor, take);
                break;
            case gltf_code::uint16:
                visit<std::uint16_t>(accessor, take);
                break;
            default:
                break;
        }
        return largest;
    }

    GltfContents& contents_;
    Report& report_;
    std::set<std::pair<std::string, std::size_t>> checked_;
    std::map<std::size_t, std::size_t> largest_joints_;
};

}  // namespace

void check_values(GltfContents& contents, Report& report) {
    ValueChecker(contents, report).check();
}

}  // namespace relief::detail
