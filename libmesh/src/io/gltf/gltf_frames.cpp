// SPDX-License-Identifier: Apache-2.0
// Replaces normals, tangents, positions and texture coordinates of a glTF primitive, and normals
// and tangents of its morph targets, in object space.
//
// Changed values become new accessors, so that other users of the old ones are not affected. The
// old ones are retired: the writer leaves them out. Unchanged values keep their accessor, or at
// least their type and bits. A framed mesh that does not belong to the primitive throws
// InvalidInput.
//
// glTF adds a target's displacements to a vertex's normal and tangent. The displacements are
// therefore the frames of the displaced shape, computed by with_frames(), minus those of the
// primitive. Corners are compared one by one: if corners that share a vertex at rest differ when
// displaced, the vertex is split. A target with weight 1 then gives exactly the frames of its
// shape; frames in between are interpolated, as glTF requires. Source: glTF 2.0 (ISO/IEC 12113),
// 3.7.2.2.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_contents.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/report.h"

namespace relief {
using namespace relief::detail;

namespace {

/// Replaces the frames of one primitive.
class FrameReplacement {
  public:
    FrameReplacement(GltfContents& contents, GltfPrimitiveId id, const FramedMesh& framed);
    void run();
    /// Replaces only texture coordinates.
    void run(int texcoord_set, Report& report);

  private:
    Json& primitive() { return contents_.root["meshes"][id_.mesh]["primitives"][id_.primitive]; }
    void check() const;
    void remove_displacements(const std::string& attribute, Report& report);
    void add_zeros(const std::string& attribute);
    std::size_t carried(std::size_t accessor);
    template <typename Vector>
    void replace(const char* name, const std::vector<Vector>& values);
    void carry_all();
    void carry_neighbors(std::size_t accessor);
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
    std::vector<std::uint32_t> sources_;  ///< Accessor element of each new vertex.
    bool shares_vertices_ = false;        ///< Other primitives may produce the same results.
    bool same_vertices_ = false;
    bool same_triangles_ = false;
    std::map<std::size_t, std::size_t> carried_;  ///< Maps an old accessor to the new one.
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
    // If only vertices that this primitive does not use are missing, nothing needs to be written.
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

/// Copies an accessor with its elements in the order of the new vertices. The type stays.
std::size_t FrameReplacement::carried(std::size_t accessor) {
    if (const auto done = carried_.find(accessor); done != carried_.end()) return done->second;
    Json json = contents_.root["accessors"][accessor];
    const std::size_t size = element_layout(json).size;
    const PackedElements packed = packed_elements(contents_, accessor);
    const std::string_view old_elements = packed.bytes();
    std::string elements(sources_.size() * size, '\0');
    for (std::size_t i = 0; i < sources_.size(); ++i) {
        std::memcpy(elements.data() + i * size, old_elements.data() + sources_[i] * size, size);
    }
    update_bounds(json, elements);
    const std::size_t number = add(std::move(json), elements, gltf_code::array_buffer);
    carried_.emplace(accessor, number);
    return number;
}

/// Returns true if the stored elements, read as floats, have exactly the wanted bits.
template <typename Vector>
bool is_stored(const GltfContents& contents, std::size_t accessor,
               const std::vector<std::uint32_t>& sources, const std::vector<Vector>& wanted) {
    const std::vector<Vector> stored = float_elements<Vector>(contents, accessor, sources);
    return std::memcmp(stored.data(), wanted.data(), stored.size() * sizeof(Vector)) == 0;
}

/// Replaces an attribute. Without values it is removed. Unchanged values are left for carry_all();
/// others are written as floats.
template <typename Vector>
void FrameReplacement::replace(const char* name, const std::vector<Vector>& values) {
    const auto accessor = index_in(primitive()["attributes"], name);
    if (values.empty()) {
        if (!accessor) return;
        carry_neighbors(*accessor);
        retire(*accessor);
        primitive()["attributes"].erase(name);
        // Morph targets must not change an attribute that the primitive lacks.
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
        carry_neighbors(*accessor);
        retire(*accessor);
        json = contents_.root["accessors"][*accessor];
        for (const char* key : {"normalized", "min", "max"})
            json.erase(key);
    }
    json["componentType"] = gltf_code::float32;
    json["type"] = fmt::format("VEC{}", Vector::length());
    const std::string elements(reinterpret_cast<const char*>(values.data()),
                               values.size() * sizeof(Vector));
    if constexpr (Vector::length() == 3) {
        if (std::string_view(name) == "POSITION") set_bounds(json, values);
    }
    const std::size_t number = add(std::move(json), elements, gltf_code::array_buffer);
    primitive()["attributes"][name] = number;
    carried_.emplace(number, number);  // These elements already have the new order.
}

/// Reorders all attributes and morph targets for the new vertices.
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
    Json copy = primitive();  // Adding accessors reallocates the arrays of the document.
    carry(copy["attributes"]);
    if (copy.contains("targets")) {
        for (Json& target : copy["targets"])
            carry(target);
    }
    primitive() = std::move(copy);
}

/// If the removed accessor is interleaved with others of this primitive, rewrites those, so that no
/// gaps remain.
void FrameReplacement::carry_neighbors(std::size_t accessor) {
    if (!same_vertices_) return;  // In this case carry_all() rewrites everything.
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

/// Indices of the new triangles, in the smallest type that holds them. The largest value of a type
/// is not used, because it restarts strips.
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
    primitive().erase("mode");  // Triangles are the default mode.
}

/// Removes the compressed copy of the primitive, which is outdated now.
void FrameReplacement::drop_draco() {
    const Json* draco = find(primitive(), "extensions", draco_extension);
    if (draco == nullptr) return;
    contents_.retired_views.insert(size_in(*draco, "bufferView"));
    erase_extension(primitive(), draco_extension);
    remove_unused_extension(contents_.root, draco_extension);
}

void FrameReplacement::run() {
    const Json unchanged = primitive();
    const auto is_as_wanted = [&]<typename Vector>(const char* name,
                                                   const std::vector<Vector>& values) {
        const auto accessor = index_in(unchanged["attributes"], name);
        return accessor ? !values.empty() && is_stored(contents_, *accessor, sources_, values)
                        : values.empty();
    };
    if (same_triangles_ && is_as_wanted("POSITION", framed_.mesh.positions) &&
        is_as_wanted("NORMAL", framed_.mesh.normals) &&
        is_as_wanted("TANGENT", framed_.mesh.tangents)) {
        return;
    }
    replace("POSITION", framed_.mesh.positions);
    replace("NORMAL", framed_.mesh.normals);
    replace("TANGENT", framed_.mesh.tangents);
    if (!same_vertices_) carry_all();
    if (!same_triangles_ || !same_vertices_) replace_indices();
    drop_draco();
}

void FrameReplacement::remove_displacements(const std::string& attribute, Report& report) {
    if (!primitive().contains("targets")) return;
    for (std::size_t i = 0; i < primitive()["targets"].size(); ++i) {
        Json& target = primitive()["targets"][i];
        const auto accessor = index_in(target, attribute.c_str());
        if (!accessor) continue;
        retire(*accessor);
        target.erase(attribute);
        report.add("displacements of replaced texture coordinates", "morph target", i,
                   "are removed");
    }
}

/// Adds the coordinates (0, 0) of all vertices, which take no bytes.
void FrameReplacement::add_zeros(const std::string& attribute) {
    Json& accessors = contents_.root["accessors"];
    accessors.push_back({{"componentType", gltf_code::float32},
                         {"count", framed_.mesh.positions.size()},
                         {"type", "VEC2"}});
    primitive()["attributes"][attribute] = accessors.size() - 1;
}

void FrameReplacement::run(int texcoord_set, Report& report) {
    const auto name = [](int set) { return fmt::format("TEXCOORD_{}", set); };
    remove_displacements(name(texcoord_set), report);
    replace(name(texcoord_set).c_str(), framed_.mesh.texcoords);
    if (!same_vertices_) carry_all();
    if (!same_triangles_ || !same_vertices_) replace_indices();
    for (int set = 0; set < texcoord_set; ++set) {
        if (primitive()["attributes"].contains(name(set))) continue;
        add_zeros(name(set));
        report.add("missing texture coordinate set below the new one", "set",
                   static_cast<std::size_t>(set), "is (0, 0), because glTF numbers them all");
    }
    drop_draco();
}

void replace_frames(GltfContents& contents, GltfPrimitiveId id, const FramedMesh& framed) {
    FrameReplacement(contents, id, framed).run();
}

/// The displacements of one target, one per vertex of the primitive's mesh; empty if it has none.
struct Displacements {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
};

/// The attributes that one target needs, and the frames of its shape at each corner.
struct TargetFrames {
    std::size_t target = 0;
    bool wants_normals = false;
    bool wants_tangents = false;
    std::vector<glm::vec3> corner_normals;
    std::vector<glm::vec4> corner_tangents;
};

std::vector<glm::vec3> displacements(const GltfContents& contents, const Json& target,
                                     const char* name, const GltfTriangles& triangles) {
    const auto accessor = index_in(target, name);
    if (!accessor) return {};
    return triangles.used ? float_elements<glm::vec3>(contents, *accessor, *triangles.used)
                          : float_elements<glm::vec3>(contents, *accessor);
}

/// Returns the mesh before vertices were split: the original vertices come first, in order.
Mesh unsplit(const FramedMesh& framed, std::size_t vertex_count) {
    Mesh mesh;
    const auto first = [&](const auto& values) {
        auto result = values;
        if (!result.empty()) result.resize(vertex_count);
        return result;
    };
    mesh.positions = first(framed.mesh.positions);
    mesh.normals = first(framed.mesh.normals);
    mesh.texcoords = first(framed.mesh.texcoords);
    for (const glm::uvec3& t : framed.mesh.triangles) {
        mesh.triangles.emplace_back(framed.source_vertex[t.x], framed.source_vertex[t.y],
                                    framed.source_vertex[t.z]);
    }
    return mesh;
}

template <typename Vector>
std::vector<Vector> at_corners(const Mesh& mesh, const std::vector<Vector>& values) {
    std::vector<Vector> result;
    if (values.empty()) return result;
    result.reserve(3 * mesh.triangles.size());
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k)
            result.push_back(values[triangle[k]]);
    }
    return result;
}

/// Reports findings of the displaced shape that the primitive does not have, one for each kind.
void report_new(const Report& of_target, const Report& at_rest, std::size_t target,
                Report& report) {
    for (const Finding& finding : of_target.findings()) {
        if (finding.count <= at_rest.count(finding.kind)) continue;
        report.add(finding.kind + ", in a morph target", "morph target", target, finding.outcome);
    }
}

/// Computes and stores the frames of all targets of one primitive.
class MorphReplacement {
  public:
    MorphReplacement(GltfContents& contents, GltfPrimitiveId id, const FramedMesh& framed,
                     const FrameOptions& options, Report& report);
    std::size_t run();

  private:
    Json& primitive() { return contents_.root["meshes"][id_.mesh]["primitives"][id_.primitive]; }
    [[nodiscard]] TargetFrames wanted(std::size_t target) const;
    void compute(TargetFrames& frames, const Mesh& rest, const GltfTriangles& triangles);
    template <typename Vector>
    void split_where_differ(const std::vector<Vector>& corner_values);
    void store(const TargetFrames& frames);
    void store_displacements(std::size_t target, const char* name,
                             const std::vector<glm::vec3>& values);

    GltfContents& contents_;
    GltfPrimitiveId id_;
    FramedMesh framed_;
    FrameOptions options_;
    Report& report_;
    Report at_rest_;                ///< Findings of the primitive itself.
    bool shares_vertices_ = false;  ///< As read: other primitives may produce the same results.
    bool had_normals_ = false;
    bool had_tangents_ = false;
    bool has_new_normals_ = false;
    bool has_new_tangents_ = false;
};

MorphReplacement::MorphReplacement(GltfContents& contents, GltfPrimitiveId id,
                                   const FramedMesh& framed, const FrameOptions& options,
                                   Report& report)
    : contents_(contents), id_(id), framed_(framed), options_(options), report_(report) {
    const Json& attributes = primitive_json(contents, id)["attributes"];
    shares_vertices_ = shares_vertices(contents, primitive_json(contents, id));
    had_normals_ = attributes.contains("NORMAL");
    had_tangents_ = attributes.contains("TANGENT");
    if (options_.normals == NormalMode::keep && !had_normals_) {
        options_.normals = options_.if_missing;
    }
    has_new_normals_ = options_.normals != NormalMode::keep && !framed_.mesh.normals.empty();
    has_new_tangents_ = !framed_.mesh.tangents.empty() &&
                        (has_new_normals_ || computes_tangents(options_.tangents));
    if (!has_new_tangents_)
        options_.tangents = TangentMethod::none;
    else if (!computes_tangents(options_.tangents))
        options_.tangents = TangentMethod::mikktspace;  // New normals require new tangents.
}

/// A target needs the displacements that it had. It also needs those that renderers derived from
/// the displaced shape because the primitive lacked the attribute.
TargetFrames MorphReplacement::wanted(std::size_t target) const {
    const Json& json = primitive_json(contents_, id_)["targets"][target];
    const bool moves = json.contains("POSITION");
    TargetFrames frames;
    frames.target = target;
    frames.wants_normals =
        has_new_normals_ && (json.contains("NORMAL") || (moves && !had_normals_));
    frames.wants_tangents =
        has_new_tangents_ &&
        (json.contains("TANGENT") || ((moves || json.contains("NORMAL")) && !had_tangents_));
    return frames;
}

/// Computes the frames of the displaced shape.
void MorphReplacement::compute(TargetFrames& frames, const Mesh& rest,
                               const GltfTriangles& triangles) {
    const Json& target = primitive_json(contents_, id_)["targets"][frames.target];
    const auto positions = displacements(contents_, target, "POSITION", triangles);
    Mesh shape = rest;
    for (std::size_t v = 0; v < positions.size(); ++v)
        shape.positions[v] += positions[v];
    if (!has_new_normals_) {
        const auto normals = displacements(contents_, target, "NORMAL", triangles);
        for (std::size_t v = 0; v < normals.size(); ++v) {
            const glm::vec3 sum = shape.normals[v] + normals[v];
            const float length = glm::length(sum);
            if (length > 0.0F) shape.normals[v] = sum / length;
        }
    }
    FrameOptions options = options_;
    if (!frames.wants_tangents) options.tangents = TangentMethod::none;
    Report report;
    const FramedMesh displaced = with_frames(std::move(shape), options, report);
    report_new(report, at_rest_, frames.target, report_);
    frames.corner_normals = at_corners(displaced.mesh, displaced.mesh.normals);
    frames.corner_tangents = at_corners(displaced.mesh, displaced.mesh.tangents);
}

template <typename Vector>
void MorphReplacement::split_where_differ(const std::vector<Vector>& corner_values) {
    const VertexSplit split = split_where_corners_differ(framed_.mesh.positions.size(),
                                                         framed_.mesh.triangles, corner_values);
    if (split.source_vertex.size() == framed_.mesh.positions.size()) return;
    framed_.source_vertex = carried<std::uint32_t>(framed_.source_vertex, split);
    framed_.mesh = carried(framed_.mesh, split);
}

/// Writes the displacements of one attribute, unless they are unchanged.
void MorphReplacement::store_displacements(std::size_t target, const char* name,
                                           const std::vector<glm::vec3>& values) {
    const auto old = index_in(primitive()["targets"][target], name);
    if (old && float_elements<glm::vec3>(contents_, *old) == values) return;
    Json json = Json::object();
    if (old) {
        contents_.retired_accessors.insert(*old);
        json = contents_.root["accessors"][*old];
        for (const char* key : {"normalized", "min", "max"})
            json.erase(key);
    }
    json["componentType"] = gltf_code::float32;
    json["type"] = "VEC3";
    const std::string elements(reinterpret_cast<const char*>(values.data()),
                               values.size() * sizeof(glm::vec3));
    const auto add = shares_vertices_ ? add_shared_accessor : add_accessor;
    const std::size_t number = add(contents_, std::move(json), elements, gltf_code::array_buffer);
    primitive()["targets"][target][name] = number;
}

void MorphReplacement::store(const TargetFrames& frames) {
    const Mesh& mesh = framed_.mesh;
    std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0F));
    std::vector<glm::vec3> tangents = normals;
    std::vector<bool> is_rotated(mesh.positions.size(), false);
    for (std::size_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner) {
        const std::uint32_t v = mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
        if (frames.wants_normals) normals[v] = frames.corner_normals[corner] - mesh.normals[v];
        if (!frames.wants_tangents) continue;
        const glm::vec4& tangent = frames.corner_tangents[corner];
        tangents[v] = glm::vec3(tangent) - glm::vec3(mesh.tangents[v]);
        is_rotated[v] = tangent.w != mesh.tangents[v].w;
    }
    if (frames.wants_normals) store_displacements(frames.target, "NORMAL", normals);
    if (frames.wants_tangents) store_displacements(frames.target, "TANGENT", tangents);
    if (std::find(is_rotated.begin(), is_rotated.end(), true) == is_rotated.end()) return;
    report_.add("tangents of other handedness in a morph target", "morph target", frames.target,
                "keep that of the shape at rest, which a target cannot change");
}

std::size_t MorphReplacement::run() {
    std::vector<TargetFrames> all;
    const std::size_t target_count = array_in(primitive(), "targets").size();
    for (std::size_t i = 0; i < target_count; ++i) {
        TargetFrames frames = wanted(i);
        if (frames.wants_normals || frames.wants_tangents) all.push_back(std::move(frames));
    }
    if (!all.empty()) {
        const GltfTriangles triangles = read_triangles(contents_, id_);
        const std::size_t vertex_count =
            triangles.used ? triangles.used->size() : triangles.vertex_count;
        const Mesh rest = unsplit(framed_, vertex_count);
        with_frames(rest, options_, at_rest_);
        for (TargetFrames& frames : all) {
            compute(frames, rest, triangles);
            if (frames.wants_normals) split_where_differ(frames.corner_normals);
            if (frames.wants_tangents) split_where_differ(frames.corner_tangents);
        }
    }
    replace_frames(contents_, id_, framed_);
    for (const TargetFrames& frames : all)
        store(frames);
    return framed_.mesh.positions.size();
}

}  // namespace

void GltfDocument::set_frames(GltfPrimitiveId id, const FramedMesh& framed) {
    replace_frames(contents_->data, id, framed);
}

void GltfDocument::set_texcoords(GltfPrimitiveId id, int set, const FramedMesh& framed,
                                 Report& report) {
    if (framed.mesh.texcoords.size() != framed.mesh.positions.size())
        fail_gltf("{}: there are {} texture coordinates for {} vertices", describe(id),
                  framed.mesh.texcoords.size(), framed.mesh.positions.size());
    FrameReplacement(contents_->data, id, framed).run(set, report);
}

std::size_t GltfDocument::set_frames(GltfPrimitiveId id, const FramedMesh& framed,
                                     const FrameOptions& options, Report& report) {
    GltfContents& contents = contents_->data;
    if (array_in(primitive_json(contents, id), "targets").empty()) {
        replace_frames(contents, id, framed);
        repair_values(contents, id, report);
        return framed.mesh.positions.size();
    }
    const std::size_t vertices = MorphReplacement(contents, id, framed, options, report).run();
    repair_values(contents, id, report);
    return vertices;
}

}  // namespace relief
