// SPDX-License-Identifier: Apache-2.0
// Repairs of the accessors of a document that is written: their layout in buffer views, their
// bounds, and values that glTF forbids though they have a meaning, such as normals that are not of
// unit length. Values without a meaning are repaired by repair_values() or refused.
//
// Source: glTF 2.0 (ISO/IEC 12113), sections 3.6.2, 3.7.2, 3.7.3 and 3.11.
// Tests: tests/mesh/io/gltf/gltf_repair_test.cpp, tests/tools/valid_outputs_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "parallel.h"
#include "progress_stage.h"

namespace relief::detail {
namespace {

/// The uses of an accessor.
struct AccessorUse {
    bool is_attribute = false;  ///< Of a primitive, or of a morph target.
    bool is_index = false;
    bool is_position = false;
    bool is_normal = false;  ///< NORMAL of a primitive, whose length is 1.
    bool is_tangent = false;
    bool is_color = false;
    bool is_custom = false;    ///< An attribute whose name begins with an underscore.
    bool is_time = false;      ///< Input of an animation.
    bool is_rotation = false;  ///< Output of an animation of rotations.
    bool is_spline = false;    ///< Likewise, with CUBICSPLINE.
    bool is_bind = false;      ///< Inverse bind matrices.

    [[nodiscard]] bool is_used() const {
        return is_attribute || is_index || is_time || is_rotation || is_bind;
    }
};

/// The validator of Khronos permits 0.00674.
constexpr double length_tolerance = 0.0067;

class AccessorRepair {
  public:
    AccessorRepair(GltfContents& contents, Report& report)
        : contents_(contents),
          root_(contents.root),
          report_(report),
          uses_(array_in(contents.root, "accessors").size()) {}

    void run() {
        if (uses_.empty()) return repair_views();
        find_uses();
        const std::set<std::size_t> misplaced = misplaced_accessors();
        for (std::size_t i = 0; i < uses_.size(); ++i) {
            check_cancelled();
            try {
                if (misplaced.contains(i)) restore(i);
                repair_values(i);
                repair_bounds(i);
            } catch (const InvalidInput&) {  // Refused by require_valid().
            }
        }
        repair_weights();
        drop_compressed_copies();
        repair_views();
    }

  private:
    Json& accessor(std::size_t number) { return root_["accessors"][number]; }

    void find_uses() {
        for (const Json& mesh : array_in(root_, "meshes")) {
            for (const Json& primitive : mesh["primitives"])
                find_uses_of(primitive);
        }
        for (const Json& animation : array_in(root_, "animations"))
            find_uses_of_animation(animation);
        for (const Json& skin : array_in(root_, "skins")) {
            if (const auto number = index_in(skin, "inverseBindMatrices"))
                uses_[*number].is_bind = true;
        }
    }

    void find_uses_of(const Json& primitive) {
        for (const auto& [name, value] : primitive["attributes"].items()) {
            AccessorUse& use = uses_[value.get<std::size_t>()];
            use.is_attribute = true;
            use.is_position |= name == "POSITION";
            use.is_normal |= name == "NORMAL";
            use.is_tangent |= name == "TANGENT";
            use.is_color |= name.starts_with("COLOR_");
            use.is_custom |= name.starts_with('_');
        }
        for (const Json& target : array_in(primitive, "targets")) {
            for (const auto& [name, value] : target.items()) {
                AccessorUse& use = uses_[value.get<std::size_t>()];
                use.is_attribute = true;
                use.is_position |= name == "POSITION";
            }
        }
        if (const auto indices = index_in(primitive, "indices")) uses_[*indices].is_index = true;
    }

    void find_uses_of_animation(const Json& animation) {
        const Json& samplers = animation["samplers"];
        for (const Json& sampler : samplers)
            uses_[size_in(sampler, "input")].is_time = true;
        for (const Json& channel : animation["channels"]) {
            const std::size_t number = size_in(channel, "sampler");
            if (number >= samplers.size() || text_in(channel["target"], "path") != "rotation")
                continue;
            AccessorUse& use = uses_[size_in(samplers[number], "output")];
            use.is_rotation = true;
            use.is_spline = text_in(samplers[number], "interpolation") == "CUBICSPLINE";
        }
    }

    // Layout

    struct ViewUse {
        std::size_t attributes = 0;
        std::size_t indices = 0;
        std::size_t others = 0;
    };

    /// Returns the accessors whose place in their buffer view glTF does not permit.
    std::set<std::size_t> misplaced_accessors() {
        std::map<std::size_t, ViewUse> views;
        for (std::size_t i = 0; i < uses_.size(); ++i) {
            const auto view = index_in(accessor(i), "bufferView");
            if (!view) continue;
            ViewUse& use = views[*view];
            if (uses_[i].is_attribute)
                ++use.attributes;
            else if (uses_[i].is_index)
                ++use.indices;
            else if (uses_[i].is_used())
                ++use.others;
        }
        std::set<std::size_t> misplaced;
        for (std::size_t i = 0; i < uses_.size(); ++i) {
            const auto view = index_in(accessor(i), "bufferView");
            const std::string problem = view ? placement_problem(i, *view, views[*view])
                                             : std::string(sparse_problem(accessor(i)));
            if (problem.empty()) continue;
            misplaced.insert(i);
            report_.add(problem, "accessor", i, "is stored anew");
        }
        return misplaced;
    }

    std::string placement_problem(std::size_t number, std::size_t view_number,
                                  const ViewUse& view_use) {
        const Json& json = accessor(number);
        const Json& view = root_["bufferViews"][view_number];
        const ElementLayout layout = element_layout(json);
        const std::size_t offset = size_in(json, "byteOffset");
        const std::size_t begin = size_in(view, "byteOffset") + offset;
        const std::size_t stride = size_in(view, "byteStride", layout.size);
        const std::size_t component = component_size(layout.component_type);
        const AccessorUse& use = uses_[number];
        const auto target = index_in(view, "target");
        const bool is_matrix = text_in(json, "type").starts_with("MAT");
        const std::size_t alignment = use.is_attribute || is_matrix ? 4 : component;
        if (offset % alignment != 0 || begin % alignment != 0)
            return "elements at an offset that glTF forbids";
        if (use.is_attribute) {
            if (view.contains("byteStride") && stride > size_in(view, "byteLength"))
                return "byteStride beyond the buffer view";
            if (stride % 4 != 0) return "vertices at a stride that is not a multiple of 4";
            if (view_use.attributes > 1 && !view.contains("byteStride"))
                return "vertex data that shares a buffer view without byteStride";
            if (view_use.indices + view_use.others > 0)
                return "vertex data in a buffer view of other data";
            if (target && *target != std::size_t{gltf_code::array_buffer})
                return "vertex data in a buffer view with another target";
        } else if (use.is_used()) {
            if (view.contains("byteStride")) return "byteStride of data that is not of vertices";
            if (use.is_index && target && *target != std::size_t{gltf_code::element_array_buffer})
                return "indices in a buffer view with another target";
            if (!use.is_index && target) return "data of no vertex in a buffer view with a target";
        }
        return sparse_problem(json);
    }

    /// The elements that a sparse accessor replaces must be named in ascending order.
    const char* sparse_problem(const Json& json) {
        const Json* sparse = find(json, "sparse");
        if (sparse == nullptr) return "";
        const Json& indices = (*sparse)["indices"];
        const Json& view = root_["bufferViews"][size_in(indices, "bufferView")];
        const std::size_t size =
            component_size(static_cast<int>(size_in(indices, "componentType")));
        const std::string_view bytes = contents_.buffers[size_in(view, "buffer")].bytes().substr(
            size_in(view, "byteOffset") + size_in(indices, "byteOffset"));
        std::int64_t last = -1;
        for (std::size_t i = 0; i < size_in(*sparse, "count"); ++i) {
            std::uint32_t index = 0;
            std::memcpy(&index, bytes.data() + i * size, size);  // Little-endian.
            if (std::int64_t{index} <= last) return "sparse elements that are not ascending";
            last = index;
        }
        return "";
    }

    /// Stores an accessor in a buffer view of its own.
    void restore(std::size_t number) { store(number, raw_elements(contents_, number)); }

    void store(std::size_t number, const std::string& elements) {
        const Json& before = accessor(number);
        for (const Json* holder :
             {&before, find(before, "sparse", "indices"), find(before, "sparse", "values")}) {
            if (holder == nullptr) continue;
            if (const auto old = index_in(*holder, "bufferView")) left_views_.insert(*old);
        }
        const std::size_t size = element_layout(accessor(number)).size;
        const AccessorUse& use = uses_[number];
        std::size_t view = 0;
        if (use.is_attribute)
            view = add_elements(contents_, size, elements, gltf_code::array_buffer);
        else if (use.is_index)
            view = add_elements(contents_, size, elements, gltf_code::element_array_buffer);
        else
            view = add_view(contents_, elements);
        Json& json = accessor(number);
        json["bufferView"] = view;
        json.erase("byteOffset");
        json.erase("sparse");
    }

    /// Retires views that nothing uses any more, and erases strides without a meaning.
    void repair_views() {
        Json none = Json::array();
        Json& views = root_.contains("bufferViews") ? root_["bufferViews"] : none;
        std::vector<bool> holds_vertices(views.size(), false);
        for (std::size_t i = 0; i < uses_.size(); ++i) {
            const auto view = index_in(accessor(i), "bufferView");
            if (view && (uses_[i].is_attribute || !uses_[i].is_used()))
                holds_vertices[*view] = true;
        }
        contents_.retired_views.insert(left_views_.begin(), left_views_.end());
        repair_empty_views();
        for (std::size_t i = 0; i < views.size(); ++i) {
            Json& view = views[i];
            const std::size_t stride = size_in(view, "byteStride", 4);
            const bool is_index_view =
                size_in(view, "target") == std::size_t{gltf_code::element_array_buffer};
            if (!view.contains("byteStride") ||
                (holds_vertices[i] && stride % 4 == 0 && !is_index_view))
                continue;
            view.erase("byteStride");
            if (left_views_.contains(i)) continue;  // Reported for its accessors.
            report_.add("byteStride of a buffer view without vertices", "buffer view", i,
                        "is left out");
        }
    }

    /// Unused views without bytes are left out. Extensions may use some, for an empty table.
    void repair_empty_views() {
        std::set<std::size_t> used;
        visit_references(root_, [&](std::string_view target, Json& index) {
            if (target == "bufferViews") used.insert(index.get<std::size_t>());
        });
        for (std::size_t i = 0; i < array_in(root_, "bufferViews").size(); ++i) {
            if (size_in(root_["bufferViews"][i], "byteLength") > 0) continue;
            report_.add("buffer view without bytes", "buffer view", i,
                        "is left out, or gets a byte if an extension uses it");
            contents_.retired_views.insert(i);
            if (!used.contains(i)) continue;
            const std::size_t offset = append_bytes(contents_, std::string(1, '\0'));
            Json& view = root_["bufferViews"][i];
            view["buffer"] = contents_.added_buffer;
            view["byteOffset"] = offset;
            view["byteLength"] = 1;
        }
    }

    // Values

    using Values = std::vector<float>;

    [[nodiscard]] bool is_float(std::size_t number) {
        return element_layout(accessor(number)).component_type == gltf_code::float32;
    }

    /// Returns the components as floats; integers that are fractions are converted.
    Values values_of(std::size_t number) {
        const std::string_view type = accessor(number)["type"].get_ref<const std::string&>();
        const auto flat = [](const auto& vectors) {
            const auto* begin = reinterpret_cast<const float*>(vectors.data());
            return Values(begin, begin + vectors.size() * sizeof(vectors[0]) / sizeof(float));
        };
        if (type == "VEC3") return flat(float_elements<glm::vec3>(contents_, number));
        if (type == "VEC4") return flat(float_elements<glm::vec4>(contents_, number));
        const std::string elements = raw_elements(contents_, number);
        Values values(is_float(number) ? elements.size() / sizeof(float) : 0);
        std::memcpy(values.data(), elements.data(), values.size() * sizeof(float));
        return values;
    }

    /// Replaces the components by floats.
    void replace(std::size_t number, const Values& values) {
        accessor(number)["componentType"] = gltf_code::float32;
        accessor(number).erase("normalized");
        store(number, std::string(reinterpret_cast<const char*>(values.data()),
                                  values.size() * sizeof(float)));
        changed_.insert(number);
    }

    void repair_values(std::size_t number) {
        const AccessorUse& use = uses_[number];
        const std::size_t components = element_layout(accessor(number)).components;
        if (use.is_normal && components == 3) repair_directions(number, 3, "normal");
        if (use.is_tangent && components == 4) repair_directions(number, 4, "tangent");
        if (use.is_color && is_float(number)) repair_colors(number);
        if (use.is_rotation && components == 4 && is_float(number)) repair_rotations(number);
        if (use.is_bind && components == 16 && is_float(number)) repair_bind_matrices(number);
        if (use.is_custom) repair_custom(number);
        if (use.is_index) widen_indices(number);
    }

    /// Returns whether a direction needs a repair. One that is not finite is refused elsewhere.
    static bool is_bad_direction(const float* v, std::size_t components) {
        const double square = static_cast<double>(v[0]) * static_cast<double>(v[0]) +
                              static_cast<double>(v[1]) * static_cast<double>(v[1]) +
                              static_cast<double>(v[2]) * static_cast<double>(v[2]);
        if (!std::isfinite(square)) return false;
        return std::abs(std::sqrt(square) - 1.0) > length_tolerance ||
               (components == 4 && std::abs(v[3]) != 1.0F && std::isfinite(v[3]));
    }

    /// Looks at the floats of an accessor without a copy.
    [[nodiscard]] bool has_bad_direction(std::size_t number, std::size_t components) {
        constexpr std::size_t grain = 65536;
        const PackedElements packed = packed_elements(contents_, number);
        const std::string_view bytes = packed.bytes();
        const std::size_t size = components * sizeof(float);
        std::atomic<bool> found = false;
        parallel_for(bytes.size() / size, grain, [&](std::size_t begin, std::size_t end) {
            std::array<float, 4> direction{};
            for (std::size_t i = begin; i < end; ++i) {
                std::memcpy(direction.data(), bytes.data() + i * size, size);
                if (is_bad_direction(direction.data(), components)) found = true;
            }
        });
        return found;
    }

    /// Normalizes normals and tangents, and makes the sign of a tangent 1 or -1.
    void repair_directions(std::size_t number, std::size_t components, std::string_view name) {
        if (is_float(number) && !has_bad_direction(number, components)) return;
        Values values = values_of(number);
        bool is_changed = false;
        for (std::size_t i = 0; i < values.size(); i += components) {
            float* const v = values.data() + i;
            const double square = static_cast<double>(v[0]) * static_cast<double>(v[0]) +
                                  static_cast<double>(v[1]) * static_cast<double>(v[1]) +
                                  static_cast<double>(v[2]) * static_cast<double>(v[2]);
            if (!std::isfinite(square)) continue;  // Refused by require_valid().
            const double length = std::sqrt(square);
            if (length == 0.0) {
                v[components == 3 ? 2 : 0] = 1.0F;
                report_.add(fmt::format("{} of length 0", name), "vertex", i / components,
                            components == 3 ? "becomes (0,0,1)" : "becomes (1,0,0)");
                is_changed = true;
            } else if (std::abs(length - 1.0) > length_tolerance) {
                for (std::size_t k = 0; k < 3; ++k)
                    v[k] = static_cast<float>(static_cast<double>(v[k]) / length);
                report_.add(fmt::format("{} that is not of unit length", name), "vertex",
                            i / components, "is normalized");
                is_changed = true;
            }
            if (components == 3 || std::abs(v[3]) == 1.0F || !std::isfinite(v[3])) continue;
            v[3] = v[3] < 0.0F ? -1.0F : 1.0F;
            report_.add("tangent whose w is neither 1 nor -1", "vertex", i / components,
                        "gets the nearer one");
            is_changed = true;
        }
        if (is_changed) replace(number, values);
    }

    void repair_colors(std::size_t number) {
        Values values = values_of(number);
        const std::size_t components = element_layout(accessor(number)).components;
        bool is_changed = false;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const float clamped = std::clamp(values[i], 0.0F, 1.0F);
            if (clamped == values[i] || !std::isfinite(values[i])) continue;
            values[i] = clamped;
            report_.add("color that is not between 0 and 1", "vertex", i / components,
                        "becomes the nearer of the two");
            is_changed = true;
        }
        if (is_changed) replace(number, values);
    }

    void repair_rotations(std::size_t number) {
        Values values = values_of(number);
        bool is_changed = false;
        for (std::size_t i = 0; i < values.size(); i += 4) {
            if (uses_[number].is_spline && i / 4 % 3 != 1) continue;  // In- and out-tangents.
            double square = 0.0;
            for (std::size_t k = 0; k < 4; ++k)
                square += static_cast<double>(values[i + k]) * static_cast<double>(values[i + k]);
            const double length = std::sqrt(square);
            if (!(length > 0.0) || !std::isfinite(length) ||
                std::abs(length - 1.0) <= length_tolerance)
                continue;
            for (std::size_t k = 0; k < 4; ++k)
                values[i + k] = static_cast<float>(static_cast<double>(values[i + k]) / length);
            report_.add("rotation of an animation that is not of unit length", "key", i / 4,
                        "is normalized");
            is_changed = true;
        }
        if (is_changed) replace(number, values);
    }

    /// The last row of an affine matrix is (0,0,0,1).
    void repair_bind_matrices(std::size_t number) {
        Values values = values_of(number);
        bool is_changed = false;
        for (std::size_t i = 0; i + 16 <= values.size(); i += 16) {
            bool is_affine = true;
            for (std::size_t column = 0; column < 4; ++column) {
                float& last = values[i + 4 * column + 3];
                const float wanted = column == 3 ? 1.0F : 0.0F;
                if (last == wanted) continue;
                last = wanted;
                is_affine = false;
            }
            if (is_affine) continue;
            report_.add("inverse bind matrix whose last row is not (0,0,0,1)", "joint", i / 16,
                        "gets that row");
            is_changed = true;
        }
        if (is_changed) replace(number, values);
    }

    /// Attributes must not have integers of 32 bits.
    void repair_custom(std::size_t number) {
        if (element_layout(accessor(number)).component_type != gltf_code::uint32) return;
        const std::string elements = raw_elements(contents_, number);
        Values values;
        constexpr std::uint32_t max_exact = 1U << 24U;
        for (std::size_t at = 0; at < elements.size(); at += sizeof(std::uint32_t)) {
            std::uint32_t value = 0;
            std::memcpy(&value, elements.data() + at, sizeof value);
            if (value > max_exact) return;  // Refused by require_valid().
            values.push_back(static_cast<float>(value));
        }
        replace(number, values);
        report_.add("attribute with integers of 32 bits", "accessor", number,
                    "gets the same numbers as floats");
    }

    /// The largest number of a type is no index: it restarts strips.
    void widen_indices(std::size_t number) {
        const int type = element_layout(accessor(number)).component_type;
        if (type != gltf_code::uint8 && type != gltf_code::uint16) return;
        const std::uint32_t restart = type == gltf_code::uint8 ? 0xFFU : 0xFFFFU;
        const std::vector<std::uint32_t> indices = index_elements(contents_, number);
        if (std::find(indices.begin(), indices.end(), restart) == indices.end()) return;
        accessor(number)["componentType"] = gltf_code::uint32;
        store(number, std::string(reinterpret_cast<const char*>(indices.data()),
                                  indices.size() * sizeof(std::uint32_t)));
        changed_.insert(number);
        report_.add("index that restarts strips", "accessor", number,
                    "is stored in 32 bits, as are the others");
    }

    /// Writes the bounds that the values have, if there are any or glTF requires them.
    void repair_bounds(std::size_t number) {
        Json& json = accessor(number);
        const bool needs_bounds = uses_[number].is_position || uses_[number].is_time;
        if (!needs_bounds && !json.contains("min") && !json.contains("max")) return;
        Json exact = json;
        for (const char* key : {"min", "max"}) {
            if (needs_bounds || exact.contains(key)) exact[key] = Json::array();
        }
        update_bounds(exact, packed_elements(contents_, number).bytes());
        bool is_equal = true;
        for (const char* key : {"min", "max"}) {
            if (exact.contains(key)) is_equal = is_equal && is_same(find(json, key), exact[key]);
        }
        if (is_equal) return;
        for (const char* key : {"min", "max"}) {
            if (!exact.contains(key)) continue;
            if (exact[key].empty())
                json.erase(key);  // Values that are not finite have no bounds.
            else
                json[key] = exact[key];
        }
        if (changed_.contains(number)) return;
        report_.add("bounds that differ from the values", "accessor", number, "are recomputed");
    }

    static bool is_same(const Json* written, const Json& exact) {
        if (written == nullptr || !written->is_array() || written->size() != exact.size())
            return false;
        for (std::size_t k = 0; k < exact.size(); ++k) {
            if (!(*written)[k].is_number() || (*written)[k].get<float>() != exact[k].get<float>())
                return false;
        }
        return true;
    }

    // Weights of joints

    void repair_weights() {
        std::set<std::vector<std::size_t>> done;
        for (const Json& mesh : array_in(root_, "meshes")) {
            for (const Json& primitive : mesh["primitives"]) {
                std::vector<std::size_t> sets;
                const Json& attributes = primitive["attributes"];
                for (std::size_t set = 0;; ++set) {
                    const auto joints = index_in(attributes, fmt::format("JOINTS_{}", set).c_str());
                    const auto weights =
                        index_in(attributes, fmt::format("WEIGHTS_{}", set).c_str());
                    if (!joints || !weights) break;
                    sets.push_back(*joints);
                    sets.push_back(*weights);
                }
                if (!sets.empty() && done.insert(sets).second) repair_weights(sets);
            }
        }
    }

    /// \param sets  the accessors of joints and weights, in turn
    void repair_weights(const std::vector<std::size_t>& sets) {
        std::vector<std::vector<glm::vec4>> joints, weights;
        try {
            for (std::size_t i = 0; i < sets.size(); i += 2) {
                joints.push_back(float_elements<glm::vec4>(contents_, sets[i]));
                weights.push_back(float_elements<glm::vec4>(contents_, sets[i + 1]));
                if (joints.back().size() != joints[0].size() ||
                    weights.back().size() != joints[0].size())
                    return;
            }
        } catch (const InvalidInput&) {
            return;  // Refused by require_valid().
        }
        bool is_changed = false;
        for (std::size_t v = 0; v < joints[0].size(); ++v)
            is_changed = repair_weights(joints, weights, v) || is_changed;
        for (std::size_t i = 0; is_changed && i < sets.size(); i += 2) {
            const auto* const begin = reinterpret_cast<const float*>(weights[i / 2].data());
            replace(sets[i + 1], Values(begin, begin + 4 * weights[i / 2].size()));
        }
    }

    /// Repairs the weights of one vertex: none is negative, no joint counts twice, the sum is 1.
    bool repair_weights(const std::vector<std::vector<glm::vec4>>& joints,
                        std::vector<std::vector<glm::vec4>>& weights, std::size_t v) {
        bool is_changed = false;
        std::map<float, float*> first;  // The weight of each joint.
        float sum = 0.0F;
        std::size_t count = 0;
        const auto change = [&](const char* problem, const char* outcome) {
            report_.add(problem, "vertex", v, outcome);
            is_changed = true;
        };
        for (std::size_t set = 0; set < weights.size(); ++set) {
            for (int k = 0; k < 4; ++k) {
                float& weight = weights[set][v][k];
                if (!std::isfinite(weight)) return false;  // Refused by require_valid().
                if (weight < 0.0F) {
                    weight = 0.0F;
                    change("negative weight of a joint", "becomes 0");
                }
                if (weight == 0.0F) continue;
                const auto [known, is_new] = first.emplace(joints[set][v][k], &weight);
                sum += weight;
                ++count;
                if (is_new) continue;
                *known->second += weight;
                weight = 0.0F;
                change("joint with two weights", "gets their sum");
            }
        }
        if (sum == 0.0F) {
            weights[0][v].x = 1.0F;
            change("vertex without weights", "follows its first joint");
            return true;
        }
        constexpr float rounding = 2e-7F;  // For each weight, as in the validator.
        if (std::abs(sum - 1.0F) <= rounding * static_cast<float>(count)) return is_changed;
        for (auto& [joint, weight] : first)
            *weight = static_cast<float>(static_cast<double>(*weight) / static_cast<double>(sum));
        change("weights whose sum is not 1", "are divided by it");
        return true;
    }

    /// A compressed copy of a primitive has the values from before the repair.
    void drop_compressed_copies() {
        if (changed_.empty()) return;
        for (Json& mesh : root_.contains("meshes") ? root_["meshes"] : none_) {
            for (Json& primitive : mesh["primitives"]) {
                const Json* draco = find(primitive, "extensions", draco_extension);
                if (draco == nullptr) continue;
                const auto is_changed = [&](const Json& number) {
                    return changed_.contains(number.get<std::size_t>());
                };
                const Json& attributes = primitive["attributes"];
                if (std::none_of(attributes.begin(), attributes.end(), is_changed)) continue;
                contents_.retired_views.insert(size_in(*draco, "bufferView"));
                erase_extension(primitive, draco_extension);
            }
        }
        remove_unused_extension(root_, draco_extension);
    }

    GltfContents& contents_;
    Json& root_;
    Report& report_;
    std::vector<AccessorUse> uses_;
    std::set<std::size_t> left_views_;  ///< Views that an accessor has left.
    std::set<std::size_t> changed_;     ///< Accessors with other values or another type.
    Json none_ = Json::array();
};

}  // namespace

void repair_accessors(GltfContents& contents, Report& report) {
    AccessorRepair(contents, report).run();
}

}  // namespace relief::detail
