// SPDX-License-Identifier: Apache-2.0
// The rule of validity for documents that are written: what the reader checks, and what it leaves
// to the users of meshes because reading must show it: indices in range, finite values, and the
// faults that repair_document() cannot repair.
//
// Values that a command has computed or converted are repaired, which is reported. A document that
// is still not valid is not written. Source: glTF 2.0 (ISO/IEC 12113), sections 3.5 to 3.7 and 5.
// Tests: tests/mesh/io/gltf/gltf_validity_test.cpp, tests/tools/valid_outputs_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "parallel.h"
#include "progress_stage.h"
#include "relief/mesh/report.h"

namespace relief::detail {
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

/// Returns 1 if all bits of the exponent are set, otherwise 0.
std::uint32_t is_non_finite(float value) {
    constexpr std::uint32_t exponent = 0x7F800000U;
    return (std::bit_cast<std::uint32_t>(value) & exponent) == exponent ? 1U : 0U;
}

/// Returns the place of the first float that is not finite.
std::optional<std::size_t> first_non_finite(std::string_view bytes) {
    constexpr std::size_t block = 1024;
    constexpr std::size_t blocks_per_piece = 256;
    const std::size_t count = bytes.size() / sizeof(float);
    std::atomic<std::size_t> first = count;
    parallel_for((count + block - 1) / block, blocks_per_piece,
                 [&](std::size_t from, std::size_t to) {
                     std::array<float, block> values;
                     for (std::size_t begin = from * block; begin < std::min(to * block, count);
                          begin += block) {
                         const std::size_t size = std::min(block, count - begin);
                         std::memcpy(values.data(), bytes.data() + begin * sizeof(float),
                                     size * sizeof(float));
                         std::uint32_t found = 0;
                         for (std::size_t i = 0; i < size; ++i)
                             found |= is_non_finite(values[i]);
                         if (found == 0) continue;
                         std::size_t place = begin;
                         while (is_non_finite(values[place - begin]) == 0)
                             ++place;
                         std::size_t known = first;
                         while (place < known && !first.compare_exchange_weak(known, place)) {
                         }
                         return;
                     }
                 });
    return first == count ? std::nullopt : std::optional<std::size_t>(first);
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

std::string name_of_node(const Json& nodes, std::size_t number) {
    const std::string name = text_in(nodes[number], "name");
    return name.empty() ? fmt::format("nodes[{}]", number) : fmt::format("node '{}'", name);
}

/// Checks what glTF requires of nodes, skins, accessors and arrays.
class DocumentChecker {
  public:
    explicit DocumentChecker(const GltfContents& contents)
        : contents_(contents), root_(contents.root) {}

    void check() {
        check_arrays();
        const Json& nodes = array_in(root_, "nodes");
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            check_matrix(nodes, i);
            check_joints(nodes, i);
        }
        const Json& skins = array_in(root_, "skins");
        for (std::size_t i = 0; i < skins.size(); ++i)
            check_skin(skins[i], i);
        check_cameras();
        check_images();
        check_accessors();
    }

  private:
    void check_arrays() const {
        const auto require = [](const Json& holder, const char* key, const char* array,
                                std::size_t number) {
            if (!holder[key].empty()) return;
            fail_gltf("{}[{}].{} is empty, which glTF does not permit (remove it)", array, number,
                      key);
        };
        const Json& meshes = array_in(root_, "meshes");
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            require(meshes[i], "primitives", "meshes", i);
            const Json& primitives = meshes[i]["primitives"];
            for (std::size_t k = 0; k < primitives.size(); ++k)
                check_primitive(primitives, {i, k});
        }
        const Json& animations = array_in(root_, "animations");
        for (std::size_t i = 0; i < animations.size(); ++i) {
            require(animations[i], "channels", "animations", i);
            require(animations[i], "samplers", "animations", i);
        }
        const Json& skins = array_in(root_, "skins");
        for (std::size_t i = 0; i < skins.size(); ++i)
            require(skins[i], "joints", "skins", i);
    }

    void check_primitive(const Json& primitives, GltfPrimitiveId id) const {
        const Json& primitive = primitives[id.primitive];
        const std::string name = describe_primitive(contents_, id);
        if (array_in(primitive, "targets").size() != array_in(primitives[0], "targets").size()) {
            fail_gltf("{}: has {} morph targets, but the first primitive {} (give all the same)",
                      name, array_in(primitive, "targets").size(),
                      array_in(primitives[0], "targets").size());
        }
        for (const char* prefix : {"COLOR_", "JOINTS_", "WEIGHTS_"}) {
            std::size_t sets = 0;
            for (const auto& [attribute, accessor] : primitive["attributes"].items())
                sets += attribute.starts_with(prefix) ? 1 : 0;
            for (std::size_t set = 0; set < sets; ++set) {
                const std::string wanted = fmt::format("{}{}", prefix, set);
                if (primitive["attributes"].contains(wanted)) continue;
                fail_gltf("{}: has {} sets of {}n, but no {} (number them from 0)", name, sets,
                          prefix, wanted);
            }
            if (std::string_view(prefix) != "JOINTS_") continue;
            const bool has_weights =
                sets == 0 ? !primitive["attributes"].contains("WEIGHTS_0")
                          : primitive["attributes"].contains(fmt::format("WEIGHTS_{}", sets - 1)) &&
                                !primitive["attributes"].contains(fmt::format("WEIGHTS_{}", sets));
            if (!has_weights)
                fail_gltf("{}: has not as many WEIGHTS_n as JOINTS_n (export the skin again)",
                          name);
        }
        for (const auto& [attribute, accessor] : primitive["attributes"].items()) {
            const Json& json = root_["accessors"][accessor.get<std::size_t>()];
            if (size_in(json, "count") == 0) fail_gltf("{}: has no vertices (remove it)", name);
            if (element_layout(json).component_type == gltf_code::uint32) {
                fail_gltf(
                    "{}: {} has integers of 32 bits, which glTF does not permit (store "
                    "floats)",
                    name, attribute);
            }
        }
    }

    /// The columns of a matrix must be orthogonal, of a length above 0 that floats can hold.
    void check_matrix(const Json& nodes, std::size_t number) const {
        const Json* matrix = find(nodes[number], "matrix");
        if (matrix == nullptr) return;
        std::array<std::array<double, 3>, 3> columns{};
        bool is_valid = true;
        for (std::size_t i = 0; i < 16; ++i) {
            const auto value = static_cast<double>((*matrix)[i].get<float>());
            if (i % 4 == 3)
                is_valid = is_valid && value == (i == 15 ? 1.0 : 0.0);
            else if (i < 12)
                columns[i / 4][i % 4] = value;
            is_valid = is_valid && std::isfinite(value);
        }
        const auto dot = [&](std::size_t a, std::size_t b) {
            return columns[a][0] * columns[b][0] + columns[a][1] * columns[b][1] +
                   columns[a][2] * columns[b][2];
        };
        constexpr double tolerance = 1e-3;
        constexpr double max_square = 1e25;  // A product of three lengths is a float.
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            is_valid = is_valid && dot(k, k) > 0.0 && dot(k, k) < max_square &&
                       std::abs(dot(k, next)) <=
                           tolerance * std::sqrt(dot(k, k)) * std::sqrt(dot(next, next));
        }
        if (is_valid) return;
        fail_gltf(
            "{}: its matrix is not a translation, rotation and scale, which glTF requires (apply "
            "the transform to the mesh in the modeling program)",
            name_of_node(nodes, number));
    }

    void check_joints(const Json& nodes, std::size_t number) {
        const auto mesh = index_in(nodes[number], "mesh");
        const auto skin = index_in(nodes[number], "skin");
        if (!mesh || !skin) return;
        const std::size_t joints = root_["skins"][*skin]["joints"].size();
        for (const Json& primitive : root_["meshes"][*mesh]["primitives"]) {
            for (const auto& [attribute, accessor] : primitive["attributes"].items()) {
                if (!attribute.starts_with("JOINTS_")) continue;
                const auto index = accessor.get<std::size_t>();
                const auto [known, is_new] = largest_joints_.emplace(index, 0.0F);
                if (is_new) {
                    for (const glm::vec4& of_vertex : float_elements<glm::vec4>(contents_, index))
                        known->second = std::max(
                            {known->second, of_vertex.x, of_vertex.y, of_vertex.z, of_vertex.w});
                }
                if (static_cast<std::size_t>(known->second) < joints) continue;
                fail_gltf("{}: {} names joint {}, but its skin has only {} (export the skin again)",
                          name_of_node(nodes, number), attribute,
                          static_cast<std::size_t>(known->second), joints);
            }
        }
    }

    void check_skin(const Json& skin, std::size_t number) const {
        const Json& nodes = root_["nodes"];
        const Json& joints = skin["joints"];
        if (std::set<Json>(joints.begin(), joints.end()).size() != joints.size())
            fail_gltf("skins[{}] names a joint twice (export the skin again)", number);
        std::vector<std::size_t> parents(nodes.size(), nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            for (const Json& child : array_in(nodes[i], "children"))
                parents[child.get<std::size_t>()] = i;
        }
        std::set<std::size_t> roots;
        for (const Json& joint : joints) {
            auto node = joint.get<std::size_t>();
            while (parents[node] < nodes.size())
                node = parents[node];
            roots.insert(node);
        }
        if (roots.size() > 1) {
            fail_gltf("skins[{}] has joints without a common root (give them a common parent node)",
                      number);
        }
        const auto matrices = index_in(skin, "inverseBindMatrices");
        if (!matrices) return;
        const Json& accessor = root_["accessors"][*matrices];
        if (size_in(accessor, "count") < joints.size() || text_in(accessor, "type") != "MAT4" ||
            element_layout(accessor).component_type != gltf_code::float32) {
            fail_gltf(
                "skins[{}] has {} joints, but not as many inverse bind matrices of floats "
                "(export the skin again)",
                number, joints.size());
        }
    }

    void check_cameras() const {
        const Json& cameras = array_in(root_, "cameras");
        for (std::size_t i = 0; i < cameras.size(); ++i) {
            const std::string type = text_in(cameras[i], "type");
            const Json* lens = find(cameras[i], type.c_str());
            bool is_valid = lens != nullptr && (type == "perspective" || type == "orthographic");
            if (is_valid) {
                const float near = float_in(*lens, "znear", 0.0F);
                const bool is_perspective = type == "perspective";
                is_valid =
                    float_in(*lens, "zfar", near + 1.0F) > near &&
                    (is_perspective ? near > 0.0F && float_in(*lens, "yfov", 0.0F) > 0.0F &&
                                          float_in(*lens, "aspectRatio", 1.0F) > 0.0F
                                    : near >= 0.0F && float_in(*lens, "xmag", 0.0F) != 0.0F &&
                                          float_in(*lens, "ymag", 0.0F) != 0.0F);
            }
            if (is_valid) continue;
            fail_gltf("cameras[{}] has no lens that glTF permits (remove or correct the camera)",
                      i);
        }
    }

    void check_images() const {
        const Json& images = array_in(root_, "images");
        for (std::size_t i = 0; i < images.size(); ++i) {
            const Json& image = images[i];
            if (image.contains("uri") == image.contains("bufferView")) {
                fail_gltf(
                    "images[{}] must have either a uri or a bufferView (remove or correct "
                    "it)",
                    i);
            }
            const std::string uri = text_in(image, "uri");
            bool is_uri = !uri.starts_with(':');
            for (std::size_t at = uri.find('%'); at != std::string::npos && !is_data_uri(uri);
                 at = uri.find('%', at + 1)) {
                constexpr std::string_view digits = "0123456789abcdefABCDEF";
                is_uri = is_uri && at + 2 < uri.size() &&
                         digits.find(uri[at + 1]) != std::string_view::npos &&
                         digits.find(uri[at + 2]) != std::string_view::npos;
            }
            if (!is_uri)
                fail_gltf("images[{}].uri '{}' is no URI (name a file beside the document)", i,
                          uri);
        }
    }

    void check_accessors() const {
        const Json& accessors = array_in(root_, "accessors");
        for (std::size_t i = 0; i < accessors.size(); ++i) {
            if (contents_.retired_accessors.contains(i)) continue;
            if (size_in(accessors[i], "count") == 0)
                fail_gltf("accessors[{}] has no elements, which glTF does not permit (remove it)",
                          i);
            if (!is_float(contents_, i)) continue;
            const PackedElements packed = packed_elements(contents_, i);
            const auto place = first_non_finite(packed.bytes());
            if (!place) continue;
            fail_gltf(
                "element {} of accessors[{}] is not finite, which glTF does not permit "
                "(correct or remove the accessor)",
                *place / element_layout(accessors[i]).components, i);
        }
    }

    const GltfContents& contents_;
    const Json& root_;
    std::map<std::size_t, float> largest_joints_;
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

    static bool is_invalid(const float* element, std::size_t components, bool is_normal) {
        bool is_zero = true;
        for (std::size_t k = 0; k < components; ++k) {
            if (!std::isfinite(element[k])) return true;
            is_zero = is_zero && element[k] == 0.0F;
        }
        return is_normal && is_zero;
    }

    /// Returns the floats of an accessor if one is not finite or, for normals, if all of an element
    /// are zero.
    [[nodiscard]] std::optional<Values> invalid_values(std::size_t accessor, bool are_normals) {
        if (!is_float(contents_, accessor)) return std::nullopt;
        const PackedElements packed = packed_elements(contents_, accessor);
        const std::string_view bytes = packed.bytes();
        const std::size_t components =
            element_layout(contents_.root["accessors"][accessor]).components;
        if (!first_non_finite(bytes) && !(are_normals && has_zero(bytes, components)))
            return std::nullopt;
        Values values(bytes.size() / sizeof(float));
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
        return values;
    }

    static bool has_zero(std::string_view floats, std::size_t components) {
        constexpr std::size_t grain = 65536;
        const std::size_t size = components * sizeof(float);
        std::atomic<bool> found = false;
        parallel_for(floats.size() / size, grain, [&](std::size_t begin, std::size_t end) {
            std::vector<float> element(components);
            for (std::size_t i = begin; i < end; ++i) {
                std::memcpy(element.data(), floats.data() + i * size, size);
                if (is_invalid(element.data(), components, true)) found = true;
            }
        });
        return found;
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
    DocumentChecker(contents).check();
}

void repair_values(GltfContents& contents, GltfPrimitiveId id, Report& report) {
    ValueRepair(contents, id, report).run();
}

}  // namespace relief::detail
