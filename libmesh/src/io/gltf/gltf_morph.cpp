// SPDX-License-Identifier: Apache-2.0
// Frames of morph targets: those of the displaced shape, by the same method, minus the primitive's.
//
// glTF adds displacements to a vertex's normal and tangent, so those of a target are differences,
// per vertex, in object space. The displaced shape gets frames of its own from with_frames(), which
// are compared corner by corner; where corners that share a vertex at rest differ when displaced,
// the vertex is split. A target that is fully on then has exactly the frames of its shape; in
// between they are interpolated, as glTF does it. Source: glTF 2.0 (ISO/IEC 12113), 3.7.2.2.
// Tests: tests/mesh/io/gltf/gltf_morph_test.cpp.
#include "io/gltf/gltf_morph.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "io/gltf/gltf_accessor.h"
#include "io/gltf/gltf_edit.h"
#include "io/gltf/gltf_primitive.h"
#include "relief/mesh/split.h"

namespace relief {
namespace {

/// The displacements of one target, by vertex of the primitive's mesh; empty where it has none.
struct Displacements {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
};

/// What is wanted of one target, and the frames of its shape at every corner.
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
    std::vector<glm::vec3> all = float_elements<glm::vec3>(contents, *accessor);
    if (!triangles.used) return all;
    std::vector<glm::vec3> used;
    used.reserve(triangles.used->size());
    for (const std::uint32_t vertex : *triangles.used)
        used.push_back(all[vertex]);
    return used;
}

/// The mesh as it was before vertices were split: they come first, in order.
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

/// What only the displaced shape shows, one finding for each kind.
void report_new(const Report& of_target, const Report& at_rest, std::size_t target,
                Report& report) {
    for (const Finding& finding : of_target.findings()) {
        if (finding.count <= at_rest.count(finding.kind)) continue;
        report.add(finding.kind + ", in a morph target", "morph target", target, finding.outcome);
    }
}

/// Computes the frames of all targets of one primitive and stores them.
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
    Report at_rest_;                ///< The findings of the primitive itself.
    bool shares_vertices_ = false;  ///< As read: others may come to the same results.
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
        options_.tangents = TangentMode::none;
    else if (!computes_tangents(options_.tangents))
        options_.tangents = TangentMode::mikktspace;  // What new normals bring about.
}

/// A target gets the displacements that it had, and those that a renderer made of its displaced
/// shape because the primitive did not have the attribute at all.
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

/// The frames of the displaced shape.
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
    if (!frames.wants_tangents) options.tangents = TangentMode::none;
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

/// Writes what a target adds to an attribute, or leaves it where it adds that already.
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
    std::vector<bool> is_turned(mesh.positions.size(), false);
    for (std::size_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner) {
        const std::uint32_t v = mesh.triangles[corner / 3][static_cast<int>(corner % 3)];
        if (frames.wants_normals) normals[v] = frames.corner_normals[corner] - mesh.normals[v];
        if (!frames.wants_tangents) continue;
        const glm::vec4& tangent = frames.corner_tangents[corner];
        tangents[v] = glm::vec3(tangent) - glm::vec3(mesh.tangents[v]);
        is_turned[v] = tangent.w != mesh.tangents[v].w;
    }
    if (frames.wants_normals) store_displacements(frames.target, "NORMAL", normals);
    if (frames.wants_tangents) store_displacements(frames.target, "TANGENT", tangents);
    if (std::find(is_turned.begin(), is_turned.end(), true) == is_turned.end()) return;
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

std::size_t replace_all_frames(GltfContents& contents, GltfPrimitiveId id, const FramedMesh& framed,
                               const FrameOptions& options, Report& report) {
    if (array_in(primitive_json(contents, id), "targets").empty()) {
        replace_frames(contents, id, framed);
        return framed.mesh.positions.size();
    }
    return MorphReplacement(contents, id, framed, options, report).run();
}

}  // namespace relief
