// SPDX-License-Identifier: Apache-2.0
// The rule of validity for documents that are written: what the reader checks, and what it leaves
// to the users of meshes because reading must show it: indices in range and finite vertex values.
//
// Values that a command has computed or converted are repaired, which is reported. A document that
// is still not valid is not written. Source: glTF 2.0 (ISO/IEC 12113), sections 3.6.2 and 3.7.2.
// Tests: tests/mesh/io/gltf/gltf_validity_test.cpp, tests/tools/valid_outputs_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

/// The value of an attribute that replaces one that glTF forbids.
struct Replacement {
    std::string_view kind;  ///< The name of the attribute without its number.
    std::array<float, 4> value;
    /// True if `value` replaces all components together, because it is a direction.
    bool is_direction;
    const char* text;
};

constexpr std::array replacements = {
    Replacement{"NORMAL", {0.0F, 0.0F, 1.0F, 0.0F}, true, "becomes (0,0,1)"},
    Replacement{"TANGENT", {1.0F, 0.0F, 0.0F, 1.0F}, true, "becomes (1,0,0,1)"},
    Replacement{"TEXCOORD", {}, false, "becomes 0"},
    Replacement{"COLOR", {1.0F, 1.0F, 1.0F, 1.0F}, false, "becomes 1"},
    Replacement{"WEIGHTS", {}, false, "becomes 0"},
};
constexpr Replacement no_displacement{"", {}, true, "becomes 0"};

const Replacement* replacement_of(std::string_view attribute) {
    const std::string_view kind = attribute.substr(0, attribute.find('_'));
    const auto* const found =
        std::find_if(replacements.begin(), replacements.end(),
                     [&](const Replacement& replacement) { return replacement.kind == kind; });
    return found == replacements.end() ? nullptr : found;
}

bool is_float(const GltfContents& contents, std::size_t accessor) {
    return element_layout(contents.root["accessors"][accessor]).component_type ==
           gltf_code::float32;
}

/// Returns the place of the first float that is not finite.
std::optional<std::size_t> first_non_finite(std::string_view bytes) {
    constexpr std::size_t block = 1024;
    std::array<float, block> values;
    const std::size_t count = bytes.size() / sizeof(float);
    for (std::size_t begin = 0; begin < count; begin += block) {
        const std::size_t size = std::min(block, count - begin);
        std::memcpy(values.data(), bytes.data() + begin * sizeof(float), size * sizeof(float));
        float sum = 0.0F;
        for (std::size_t i = 0; i < size; ++i)
            sum += values[i] * 0.0F;  // NaN if the value is not finite, otherwise 0.
        if (sum == 0.0F) continue;
        for (std::size_t i = 0; i < size; ++i) {
            if (!std::isfinite(values[i])) return begin + i;
        }
    }
    return std::nullopt;
}

/// Checks the primitives of a document. Accessors that several share are checked once.
class PrimitiveChecker {
  public:
    explicit PrimitiveChecker(const GltfContents& contents) : contents_(contents) {}

    void check() {
        const Json& meshes = array_in(contents_.root, "meshes");
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            for (std::size_t k = 0; k < meshes[i]["primitives"].size(); ++k) {
                check_cancelled();
                const GltfPrimitiveId id{i, k};
                try {
                    check(id, meshes[i]["primitives"][k]);
                } catch (const InvalidInput& error) {
                    fail_gltf("{}: {}", describe_primitive(contents_, id), error.what());
                }
            }
        }
    }

  private:
    void check(GltfPrimitiveId id, const Json& primitive) {
        const auto position = index_in(primitive["attributes"], "POSITION");
        if (!position) return;
        const std::size_t vertices = size_in(contents_.root["accessors"][*position], "count");
        const auto indices = index_in(primitive, "indices");
        const std::size_t mode = size_in(primitive, "mode", gltf_code::triangles);
        if (checked_.emplace(vertices, indices, mode).second) {
            if (mode >= gltf_code::triangles)
                read_triangles(contents_, id);
            else if (indices)
                check_indices(*indices, vertices);
        }
        check_counts(contents_, primitive, vertices);
        for (const auto& [name, accessor] : primitive["attributes"].items()) {
            if (name == "POSITION" || replacement_of(name) != nullptr)
                check_values(name, accessor.get<std::size_t>());
        }
        for (const Json& target : array_in(primitive, "targets")) {
            for (const auto& [name, accessor] : target.items())
                check_values(name + " of a morph target", accessor.get<std::size_t>());
        }
    }

    void check_indices(std::size_t accessor, std::size_t vertices) const {
        const std::vector<std::uint32_t> indices = index_elements(contents_, accessor);
        const auto beyond = std::find_if(indices.begin(), indices.end(), [&](std::uint32_t index) {
            return std::size_t{index} >= vertices;
        });
        if (beyond == indices.end()) return;
        fail_gltf("index {} names vertex {}, but there are only {}", beyond - indices.begin(),
                  *beyond, vertices);
    }

    void check_values(const std::string& name, std::size_t accessor) {
        if (!finite_.insert(accessor).second || !is_float(contents_, accessor)) return;
        const PackedElements packed = packed_elements(contents_, accessor);
        const auto place = first_non_finite(packed.bytes());
        if (!place) return;
        const std::size_t components =
            element_layout(contents_.root["accessors"][accessor]).components;
        fail_gltf(
            "element {} of {} is not finite, which glTF does not permit (relief-mesh process "
            "repairs such values)",
            *place / components, name);
    }

    const GltfContents& contents_;
    std::set<std::tuple<std::size_t, std::optional<std::size_t>, std::size_t>> checked_;
    std::set<std::size_t> finite_;
};

/// Repairs one primitive.
class ValueRepair {
  public:
    ValueRepair(GltfContents& contents, GltfPrimitiveId id, Report& report)
        : contents_(contents),
          id_(id),
          report_(report),
          shares_vertices_(shares_vertices(contents, primitive_json(contents, id))) {}

    void run() {
        Json copy = primitive_json(contents_, id_);  // Adding accessors moves the document's.
        const auto& attributes = copy["attributes"];
        if (const auto position = index_in(attributes, "POSITION"))
            repair_positions(copy, *position);
        for (auto& [name, accessor] : copy["attributes"].items()) {
            if (const Replacement* replacement = replacement_of(name))
                repair(name, *replacement, accessor);
        }
        if (copy.contains("targets")) {
            for (Json& target : copy["targets"]) {
                for (auto& [name, accessor] : target.items())
                    repair(name + " of a morph target", no_displacement, accessor);
            }
        }
        if (!is_changed_) return;
        // The compressed copy has the old values.
        if (const Json* draco = find(copy, "extensions", draco_extension)) {
            contents_.retired_views.insert(size_in(*draco, "bufferView"));
            erase_extension(copy, draco_extension);
        }
        contents_.root["meshes"][id_.mesh]["primitives"][id_.primitive] = std::move(copy);
        remove_unused_extension(contents_.root, draco_extension);
    }

  private:
    using Values = std::vector<float>;

    /// Returns the floats of an accessor if one is not finite or, for normals, zero.
    [[nodiscard]] std::optional<Values> invalid_values(std::size_t accessor, bool are_normals) {
        if (!is_float(contents_, accessor)) return std::nullopt;
        const PackedElements packed = packed_elements(contents_, accessor);
        const std::string_view bytes = packed.bytes();
        if (!are_normals && !first_non_finite(bytes)) return std::nullopt;
        Values values(bytes.size() / sizeof(float));
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
        return values;
    }

    static bool is_invalid(const float* element, std::size_t components, bool is_normal) {
        bool is_zero = true;
        for (std::size_t k = 0; k < components; ++k) {
            if (!std::isfinite(element[k])) return true;
            is_zero = is_zero && element[k] == 0.0F;
        }
        return is_normal && is_zero;
    }

    void repair(const std::string& name, const Replacement& replacement, Json& accessor) {
        const auto number = accessor.get<std::size_t>();
        const bool is_normal = replacement.kind == "NORMAL";
        std::optional<Values> values = invalid_values(number, is_normal);
        if (!values) return;
        const std::size_t components =
            element_layout(contents_.root["accessors"][number]).components;
        std::size_t repaired = 0;
        for (std::size_t v = 0; v * components < values->size(); ++v) {
            float* const element = values->data() + v * components;
            if (!is_invalid(element, components, is_normal)) continue;
            for (std::size_t k = 0; k < std::min<std::size_t>(components, 4); ++k) {
                if (replacement.is_direction || !std::isfinite(element[k]))
                    element[k] = replacement.value[k];
            }
            report_.add("invalid " + name, "vertex", v, replacement.text);
            ++repaired;
        }
        if (repaired > 0) accessor = replaced(number, *values);
    }

    /// Gives vertices without a position that of another vertex, and collapses their triangles.
    void repair_positions(Json& primitive, std::size_t accessor) {
        if (text_in(contents_.root["accessors"][accessor], "type") != "VEC3") return;
        std::optional<Values> values = invalid_values(accessor, false);
        if (!values) return;
        const std::size_t count = values->size() / 3;
        std::vector<bool> is_bad(count, false);
        std::array<float, 3> substitute{};
        bool has_substitute = false;
        for (std::size_t v = 0; v < count; ++v) {
            const float* const position = values->data() + 3 * v;
            is_bad[v] = is_invalid(position, 3, false);
            if (is_bad[v] || has_substitute) continue;
            std::copy_n(position, 3, substitute.begin());
            has_substitute = true;
        }
        for (std::size_t v = 0; v < count; ++v) {
            if (!is_bad[v]) continue;
            std::copy_n(substitute.begin(), 3,
                        values->begin() + static_cast<std::ptrdiff_t>(3 * v));
            report_.add("invalid POSITION", "vertex", v, "becomes that of another vertex");
        }
        collapse_triangles(primitive, is_bad);
        primitive["attributes"]["POSITION"] = replaced(accessor, *values);
    }

    void collapse_triangles(Json& primitive, const std::vector<bool>& is_bad) {
        std::vector<glm::uvec3> triangles = read_triangles(contents_, id_).triangles;
        bool any = false;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            glm::uvec3& corners = triangles[t];
            const bool is_affected = is_bad[corners.x] || is_bad[corners.y] || is_bad[corners.z];
            if (!is_affected) continue;
            const std::uint32_t kept = !is_bad[corners.x]   ? corners.x
                                       : !is_bad[corners.y] ? corners.y
                                                            : corners.z;
            corners = glm::uvec3(kept);
            report_.add("triangle with an invalid POSITION", "triangle", t,
                        "its corners become one vertex");
            any = true;
        }
        if (!any) return;
        if (const auto old = index_in(primitive, "indices"))
            contents_.retired_accessors.insert(*old);
        const std::string elements(reinterpret_cast<const char*>(triangles.data()),
                                   triangles.size() * sizeof(glm::uvec3));
        primitive["indices"] =
            add_accessor(contents_, {{"componentType", gltf_code::uint32}, {"type", "SCALAR"}},
                         elements, gltf_code::element_array_buffer);
        primitive.erase("mode");  // Triangles are the default mode.
        is_changed_ = true;
    }

    /// Adds an accessor with other values. \return its index
    std::size_t replaced(std::size_t accessor, const Values& values) {
        contents_.retired_accessors.insert(accessor);
        Json json = contents_.root["accessors"][accessor];
        const std::string elements(reinterpret_cast<const char*>(values.data()),
                                   values.size() * sizeof(float));
        update_bounds(json, elements);
        is_changed_ = true;
        return shares_vertices_
                   ? add_shared_accessor(contents_, std::move(json), elements,
                                         gltf_code::array_buffer)
                   : add_accessor(contents_, std::move(json), elements, gltf_code::array_buffer);
    }

    GltfContents& contents_;
    GltfPrimitiveId id_;
    Report& report_;
    bool shares_vertices_;
    bool is_changed_ = false;
};

}  // namespace

void require_valid(const GltfContents& contents) {
    check_gltf(contents.root);
    PrimitiveChecker(contents).check();
}

void repair_values(GltfContents& contents, GltfPrimitiveId id, Report& report) {
    ValueRepair(contents, id, report).run();
}

}  // namespace relief
