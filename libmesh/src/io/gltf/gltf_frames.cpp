// SPDX-License-Identifier: Apache-2.0
// Putting new normals and tangents into a glTF primitive, in object space.
//
// What changes is written as fresh accessors, so that others who share the old ones keep them; what
// it replaces is retired, and left out when the document is written (gltf_layout.h). Values that
// come out as they were keep their accessor, or at least their type and bits. A framed mesh that
// does not belong to the primitive throws InvalidInput. Tests:
// tests/mesh/io/gltf/gltf_frames_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_edit.h"
#include "io/gltf/gltf_primitive.h"
#include "io/gltf/gltf_schema.h"
#include "relief/mesh/error.h"

namespace relief {
namespace {

/// Replaces the parts of one primitive.
class FrameReplacement {
  public:
    FrameReplacement(GltfContents& contents, GltfPrimitiveId id, const FramedMesh& framed);
    void run();

  private:
    Json& primitive() { return contents_.root["meshes"][id_.mesh]["primitives"][id_.primitive]; }
    void check() const;
    std::size_t carried(std::size_t accessor);
    template <typename Vector>
    void replace(const char* name, const std::vector<Vector>& values);
    void carry_all();
    void carry_neighbours(std::size_t accessor);
    void replace_indices();
    void drop_draco();
    std::size_t add(Json accessor, const std::string& elements, int target) {
        return shares_vertices_
                   ? add_shared_accessor(contents_, std::move(accessor), elements, target)
                   : add_accessor(contents_, std::move(accessor), elements, target);
    }
    void retire(std::size_t accessor) { contents_.retired_accessors.insert(accessor); }

    GltfContents& contents_;
    GltfPrimitiveId id_;
    const FramedMesh& framed_;
    GltfTriangles before_;
    std::vector<std::uint32_t> sources_;  ///< Accessor element of every new vertex.
    bool shares_vertices_ = false;        ///< Others may come to the same results.
    bool same_vertices_ = false;
    bool same_triangles_ = false;
    std::map<std::size_t, std::size_t> carried_;  ///< Old accessor to new.
};

FrameReplacement::FrameReplacement(GltfContents& contents, GltfPrimitiveId id,
                                   const FramedMesh& framed)
    : contents_(contents), id_(id), framed_(framed), before_(read_triangles(contents, id)) {
    check();
    shares_vertices_ = shares_vertices(contents, primitive_json(contents, id));
    sources_.reserve(framed.source_vertex.size());
    for (const std::uint32_t source : framed.source_vertex) {
        sources_.push_back(before_.used ? (*before_.used)[source] : source);
    }
    same_vertices_ = sources_.size() == before_.vertex_count;
    for (std::size_t i = 0; same_vertices_ && i < sources_.size(); ++i) {
        same_vertices_ = sources_[i] == i;
    }
    // Vertices that only others use may be missing: that alone is no reason to write anything.
    bool all_in_place = before_.used && framed.mesh.positions.size() == before_.used->size();
    for (std::size_t i = 0; all_in_place && i < sources_.size(); ++i) {
        all_in_place = sources_[i] == (*before_.used)[i];
    }
    same_triangles_ = framed.mesh.triangles.size() == before_.triangles.size() &&
                      (same_vertices_ || all_in_place);
    for (std::size_t i = 0; same_triangles_ && i < before_.triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            same_triangles_ =
                same_triangles_ && sources_[framed.mesh.triangles[i][k]] == before_.triangles[i][k];
        }
    }
}

void FrameReplacement::check() const {
    const std::size_t input_count = before_.used ? before_.used->size() : before_.vertex_count;
    const std::size_t count = framed_.mesh.positions.size();
    const auto fits = [&](std::size_t length) { return length == 0 || length == count; };
    if (framed_.source_vertex.size() != count || !fits(framed_.mesh.normals.size()) ||
        !fits(framed_.mesh.tangents.size())) {
        throw InvalidInput(fmt::format("{}: the frames' arrays differ in length",
                                       describe_primitive(contents_, id_)));
    }
    for (const std::uint32_t source : framed_.source_vertex) {
        if (source < input_count) continue;
        throw InvalidInput(fmt::format("{}: the frames name vertex {}, but there are only {}",
                                       describe_primitive(contents_, id_), source, input_count));
    }
    validate(framed_.mesh);
}

/// An accessor with its elements in the order of the new vertices, in its own type.
std::size_t FrameReplacement::carried(std::size_t accessor) {
    if (const auto done = carried_.find(accessor); done != carried_.end()) return done->second;
    Json json = contents_.root["accessors"][accessor];
    const std::size_t size = element_layout(json).size;
    const std::string old_elements = raw_elements(contents_, accessor);
    std::string elements(sources_.size() * size, '\0');
    for (std::size_t i = 0; i < sources_.size(); ++i) {
        std::memcpy(elements.data() + i * size, old_elements.data() + sources_[i] * size, size);
    }
    renew_bounds(json, elements);
    const std::size_t number = add(std::move(json), elements, gltf_code::array_buffer);
    carried_.emplace(accessor, number);
    return number;
}

/// Whether what is stored, read as floats, is what is wanted, bit for bit.
template <typename Vector>
bool is_stored(const GltfContents& contents, std::size_t accessor,
               const std::vector<std::uint32_t>& sources, const std::vector<Vector>& wanted) {
    const std::vector<Vector> stored = float_elements<Vector>(contents, accessor);
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (std::memcmp(&stored[sources[i]], &wanted[i], sizeof(Vector)) != 0) return false;
    }
    return true;
}

/// NORMAL or TANGENT: removed where there are no values, left to be carried where they are as they
/// were, else written as floats.
template <typename Vector>
void FrameReplacement::replace(const char* name, const std::vector<Vector>& values) {
    const auto accessor = index_in(primitive()["attributes"], name);
    if (values.empty()) {
        if (!accessor) return;
        carry_neighbours(*accessor);
        retire(*accessor);
        primitive()["attributes"].erase(name);
        // Morph targets may not change what the primitive does not have.
        if (!primitive().contains("targets")) return;
        for (Json& target : primitive()["targets"]) {
            if (const auto displacement = index_in(target, name)) retire(*displacement);
            target.erase(name);
        }
        return;
    }
    if (accessor && is_stored(contents_, *accessor, sources_, values)) return;
    Json json = Json::object();
    if (accessor) {
        carry_neighbours(*accessor);
        retire(*accessor);
        json = contents_.root["accessors"][*accessor];
        for (const char* key : {"normalized", "min", "max"})
            json.erase(key);
    }
    json["componentType"] = gltf_code::float32;
    json["type"] = fmt::format("VEC{}", Vector::length());
    const std::string elements(reinterpret_cast<const char*>(values.data()),
                               values.size() * sizeof(Vector));
    const std::size_t number = add(std::move(json), elements, gltf_code::array_buffer);
    primitive()["attributes"][name] = number;
    carried_.emplace(number, number);  // It is in the new order already.
}

/// Every attribute and morph target in the order of the new vertices.
void FrameReplacement::carry_all() {
    const auto carry = [&](Json& attributes) {
        for (auto& [name, accessor] : attributes.items()) {
            const auto old = accessor.get<std::size_t>();
            const std::size_t number = carried(old);
            if (number == old) continue;
            retire(old);
            accessor = number;
        }
    };
    Json copy = primitive();  // Adding accessors moves the arrays of the document about.
    carry(copy["attributes"]);
    if (copy.contains("targets")) {
        for (Json& target : copy["targets"])
            carry(target);
    }
    primitive() = std::move(copy);
}

/// Where the accessor that goes away lies interleaved with others of this primitive, those are
/// written anew, so that no gaps stay behind.
void FrameReplacement::carry_neighbours(std::size_t accessor) {
    if (!same_vertices_) return;  // All are written anew in any case.
    const Json& root = contents_.root;
    const auto view = index_in(root["accessors"][accessor], "bufferView");
    if (!view) return;
    const std::size_t size = element_layout(root["accessors"][accessor]).size;
    if (size_in(root["bufferViews"][*view], "byteStride", size) < size + 4) return;
    Json attributes = primitive()["attributes"];
    for (auto& [name, other] : attributes.items()) {
        const auto old = other.get<std::size_t>();
        if (old == accessor || index_in(contents_.root["accessors"][old], "bufferView") != view) {
            continue;
        }
        retire(old);
        other = carried(old);
    }
    primitive()["attributes"] = std::move(attributes);
}

/// Indices of the new triangles, in the smallest type that holds them without the value that
/// restarts strips.
void FrameReplacement::replace_indices() {
    const auto old = index_in(primitive(), "indices");
    Json json = Json::object();
    if (old) {
        retire(*old);
        json = contents_.root["accessors"][*old];
        for (const char* key : {"min", "max"})
            json.erase(key);
    }
    std::string elements;
    const bool is_short = sources_.size() <= 0xFFFF;
    for (const glm::uvec3& triangle : framed_.mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const auto narrow = static_cast<std::uint16_t>(triangle[k]);
            elements.append(is_short ? reinterpret_cast<const char*>(&narrow)
                                     : reinterpret_cast<const char*>(&triangle[k]),
                            is_short ? sizeof(narrow) : sizeof(std::uint32_t));
        }
    }
    json["componentType"] = is_short ? gltf_code::uint16 : gltf_code::uint32;
    json["type"] = "SCALAR";
    const std::size_t number = add(std::move(json), elements, gltf_code::element_array_buffer);
    primitive()["indices"] = number;
    primitive().erase("mode");  // Triangles are the default.
}

/// A compressed copy of the primitive would contradict it now.
void FrameReplacement::drop_draco() {
    const Json* draco = find(primitive(), "extensions", draco_extension);
    if (draco == nullptr) return;
    contents_.retired_views.insert(size_in(*draco, "bufferView"));
    erase_extension(primitive(), draco_extension);
    forget_if_unused(contents_.root, draco_extension);
}

void FrameReplacement::run() {
    const Json unchanged = primitive();
    const auto is_as_wanted = [&]<typename Vector>(const char* name,
                                                   const std::vector<Vector>& values) {
        const auto accessor = index_in(unchanged["attributes"], name);
        return accessor ? !values.empty() && is_stored(contents_, *accessor, sources_, values)
                        : values.empty();
    };
    if (same_triangles_ && is_as_wanted("NORMAL", framed_.mesh.normals) &&
        is_as_wanted("TANGENT", framed_.mesh.tangents)) {
        return;
    }
    replace("NORMAL", framed_.mesh.normals);
    replace("TANGENT", framed_.mesh.tangents);
    if (!same_vertices_) carry_all();
    if (!same_triangles_ || !same_vertices_) replace_indices();
    drop_draco();
}

}  // namespace

void replace_frames(GltfContents& contents, GltfPrimitiveId id, const FramedMesh& framed) {
    FrameReplacement(contents, id, framed).run();
}

}  // namespace relief
