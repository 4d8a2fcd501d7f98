// SPDX-License-Identifier: Apache-2.0
// Frames of all primitives of a model, and changes of its triangles.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

#include "io/model/mesh_instances.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/model.h"
#include "relief/mesh/report.h"

namespace relief {
namespace {

AttributeOutcome attribute_outcome(bool before, bool after, bool computed) {
    if (after) return computed ? AttributeOutcome::computed : AttributeOutcome::kept;
    return before ? AttributeOutcome::removed : AttributeOutcome::absent;
}

/// Returns the texture coordinate set for a primitive's tangents, and the reason for it.
TangentTexcoords choose_texcoords(const GltfDocument& document, GltfPrimitiveId id,
                                  std::optional<int> requested) {
    TangentTexcoords chosen;
    const std::vector<int> sets = document.texcoord_sets(id);
    const GltfTangentTexcoords usual = document.tangent_texcoords(id);
    chosen.is_only = sets.size() <= 1;
    chosen.set = requested.value_or(usual.set);
    if (requested)
        chosen.reason = "requested";
    else if (usual.texture.empty() || usual.missing)
        chosen.reason = "the first";
    else
        chosen.reason = "of " + usual.texture;
    return chosen;
}

/// Adds findings and notes about texture settings that affect computed tangents.
void add_material_notes(const GltfDocument& document, GltfPrimitiveId id, FramedPart& part) {
    const GltfTangentTexcoords usual = document.tangent_texcoords(id);
    if (usual.missing && part.texcoords.reason == "the first") {
        part.report.add("texture on a missing texture coordinate set", "primitive", id.primitive,
                        "gets tangents from the first set");
    }
    const int of_texture = usual.missing.value_or(usual.set);
    if (!usual.texture.empty() && !usual.missing && of_texture != part.texcoords.set) {
        part.notes.push_back(fmt::format("{} uses texture coordinate set {}, the tangents use {}",
                                         usual.texture, of_texture, part.texcoords.set));
    }
    if (usual.is_rotated) {
        part.notes.push_back(
            fmt::format("KHR_texture_transform rotates or mirrors {}: the tangents are those of "
                        "the stored coordinates, and renderers rotate them with the texture",
                        usual.texture));
    }
}

/// Reports tangents without normals, which glTF requires to ignore.
void report_ignored(const Mesh& mesh, std::size_t index, TangentMethod tangents, Report& report) {
    if (!mesh.normals.empty() || mesh.tangents.empty() || tangents != TangentMethod::keep) return;
    if (mesh.texcoords.empty()) return;  // with_frames() reports that they are removed.
    report.add("tangents without normals", "primitive", index,
               "are ignored, as glTF requires, and recomputed");
}

/// Returns how to treat the tangents of a primitive without texture coordinates. Existing tangents
/// are kept if their normals are kept.
TangentMethod without_texcoords(const Mesh& mesh, std::size_t index, const FrameOptions& options,
                                const char* what, Report& report) {
    const bool are_kept =
        !mesh.tangents.empty() && !mesh.normals.empty() && options.normals == NormalMode::keep;
    report.add(what, "primitive", index, are_kept ? "keeps its tangents" : "gets no tangents");
    return are_kept ? TangentMethod::keep : TangentMethod::none;
}

/// Computes the frames of a primitive and records the outcome in `part`.
FramedMesh framed_part(Mesh mesh, const FrameOptions& options, FramedPart& part) {
    const bool had_normals = !mesh.normals.empty();
    const bool had_tangents = !mesh.tangents.empty();
    part.triangles = mesh.triangles.size();
    part.vertices_read = mesh.positions.size();
    if (options.normals == NormalMode::keep && !had_normals)
        part.normal_mode = options.if_missing;
    else
        part.normal_mode = options.normals;
    const bool has_new_tangents =
        computes_tangents(options.tangents) ||
        (options.tangents == TangentMethod::keep && part.normal_mode != NormalMode::keep);
    part.tangent_method =
        computes_tangents(options.tangents) ? options.tangents : TangentMethod::mikktspace;

    FramedMesh framed = with_frames(std::move(mesh), options, part.report);
    part.normals_by_area = framed.normals_by_area;
    part.smoothing_groups = framed.within_smoothing_groups;
    part.vertices_written = framed.mesh.positions.size();
    part.normals = attribute_outcome(had_normals, !framed.mesh.normals.empty(),
                                     part.normal_mode != NormalMode::keep);
    part.tangents =
        attribute_outcome(had_tangents, !framed.mesh.tangents.empty(), has_new_tangents);
    return framed;
}

void frame_primitive(GltfDocument& document, GltfPrimitiveId id, std::optional<int> texcoord_set,
                     FrameOptions options, FramedPart& part) {
    part.texcoords = choose_texcoords(document, id, texcoord_set);
    Mesh mesh = document.mesh(id, part.texcoords.set);
    if (computes_tangents(options.tangents) && mesh.texcoords.empty()) {
        const char* what = document.texcoord_sets(id).empty()
                               ? "primitive without texture coordinates"
                               : "primitive without the requested texture coordinate set";
        options.tangents = without_texcoords(mesh, id.primitive, options, what, part.report);
    }
    report_ignored(mesh, id.primitive, options.tangents, part.report);
    const FramedMesh framed = framed_part(std::move(mesh), options, part);
    if (part.tangents == AttributeOutcome::computed) add_material_notes(document, id, part);
    part.vertices_written = document.set_frames(id, framed, options, part.report);
}

std::vector<FramedPart> frame_primitives(GltfDocument& document,
                                         const std::vector<GltfPrimitiveId>& ids,
                                         const FrameOptions& options,
                                         std::optional<int> texcoord_set) {
    std::vector<FramedPart> parts;
    for (const GltfPrimitiveId id : ids) {
        FramedPart& part = parts.emplace_back();
        part.name = document.describe(id);
        try {
            frame_primitive(document, id, texcoord_set, options, part);
        } catch (const InvalidInput& error) {
            throw InvalidInput(part.name + ": " + error.what());
        }
    }
    return parts;
}

}  // namespace

std::vector<FramedPart> compute_frames(Model& model, FrameOptions options,
                                       std::optional<int> texcoord_set) {
    if (auto* document = std::get_if<GltfDocument>(&model)) {
        options.if_missing = NormalMode::flat;
        const std::vector<GltfPrimitiveId> ids = document->triangle_primitives();
        if (ids.empty()) throw InvalidInput("has no triangles");
        return frame_primitives(*document, ids, options, texcoord_set);
    }
    options.if_missing = NormalWeight::angle;
    Mesh& mesh = std::get<MeshFile>(model).mesh;
    FramedPart part;
    part.texcoords.reason = texcoord_set ? "requested" : "the first";
    mesh = framed_part(std::move(mesh), options, part).mesh;
    return {std::move(part)};
}

std::vector<FramedPart> add_tangents(GltfDocument& document, std::size_t material) {
    std::vector<GltfPrimitiveId> ids;
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const Mesh mesh = document.mesh(id);
        if (mesh.tangents.empty() && !mesh.material_ranges.empty() &&
            mesh.material_ranges.front().material == material)
            ids.push_back(id);
    }
    const FrameOptions options{.normals = NormalMode::keep,
                               .if_missing = NormalMode::flat,
                               .tangents = TangentMethod::mikktspace};
    return frame_primitives(document, ids, options, std::nullopt);
}

namespace {

/// The primitives of one glTF mesh as one mesh.
class JoinedPrimitives {
  public:
    JoinedPrimitives(const GltfDocument& document, std::vector<GltfPrimitiveId> ids);

    [[nodiscard]] const Mesh& mesh() const { return joined_; }
    [[nodiscard]] const Deformation& deformation() const { return deformation_; }
    [[nodiscard]] const std::vector<GltfPrimitiveId>& ids() const { return ids_; }

    /// Returns primitive `i` of the changed mesh, with indices into its own vertices.
    [[nodiscard]] FramedMesh part(const FramedMesh& changed, std::size_t i, NormalMode normals,
                                  Report& report) const;

  private:
    void add(Mesh primitive, const Deformation& deformation);
    FramedMesh with_new_tangents(FramedMesh part, const FramedMesh& changed, std::size_t i,
                                 Report& report) const;

    std::vector<GltfPrimitiveId> ids_;
    std::vector<Mesh> primitives_;
    /// By primitive: the texture coordinates of its tangents, or none.
    std::vector<std::vector<glm::vec2>> tangent_texcoords_;
    std::vector<std::uint32_t> first_vertex_;
    Mesh joined_;
    Deformation deformation_;  ///< Of joined_.
};

/// Appends values. If only some primitives have values, `filler` completes the others.
template <typename T>
void append(std::vector<T>& values, const std::vector<T>& more, std::size_t before,
            std::size_t count, const T& filler) {
    if (values.empty() && more.empty()) return;
    values.resize(before, filler);
    values.insert(values.end(), more.begin(), more.end());
    values.resize(before + count, filler);
}

void JoinedPrimitives::add(Mesh primitive, const Deformation& deformation) {
    const std::size_t before = joined_.positions.size();
    const std::size_t count = primitive.positions.size();
    append(joined_.normals, primitive.normals, before, count, glm::vec3(0.0F));
    append(joined_.texcoords, primitive.texcoords, before, count, glm::vec2(0.0F));
    append(joined_.colors, primitive.colors, before, count, glm::vec4(1.0F));
    append(deformation_.joints, deformation.joints, before, count, glm::vec4(0.0F));
    for (std::size_t i = 0; i < deformation.displacements.size(); ++i)
        append(deformation_.displacements[i], deformation.displacements[i], before, count,
               glm::vec3(0.0F));
    joined_.positions.insert(joined_.positions.end(), primitive.positions.begin(),
                             primitive.positions.end());
    const auto first = static_cast<std::uint32_t>(before);
    joined_.material_ranges.push_back({static_cast<std::uint32_t>(joined_.triangles.size()),
                                       static_cast<std::uint32_t>(primitive.triangles.size()),
                                       std::nullopt});
    for (const glm::uvec3& triangle : primitive.triangles)
        joined_.triangles.push_back(triangle + first);
    first_vertex_.push_back(first);
    primitives_.push_back(std::move(primitive));
}

JoinedPrimitives::JoinedPrimitives(const GltfDocument& document, std::vector<GltfPrimitiveId> ids)
    : ids_(std::move(ids)) {
    for (const GltfPrimitiveId id : ids_) {
        Mesh mesh = document.mesh(id);
        const int set = document.tangent_texcoords(id).set;
        const bool differs = !mesh.tangents.empty() && set != 0;
        tangent_texcoords_.push_back(differs ? document.mesh(id, set).texcoords : mesh.texcoords);
        add(std::move(mesh), document.deformation_sums(id));
    }
    joined_.name = primitives_.front().name;
}

/// Returns the triangles of a range with the vertices that they use.
FramedMesh range_of(const Mesh& mesh, const MaterialRange& range) {
    VertexSplit used;
    const auto begin = mesh.triangles.begin() + range.first_triangle;
    used.triangles.assign(begin, begin + range.triangle_count);
    std::vector<bool> is_used(mesh.positions.size(), false);
    for (const glm::uvec3& triangle : used.triangles) {
        for (int k = 0; k < 3; ++k)
            is_used[triangle[k]] = true;
    }
    std::vector<std::uint32_t> place(mesh.positions.size(), 0);
    for (std::uint32_t v = 0; v < is_used.size(); ++v) {
        if (!is_used[v]) continue;
        place[v] = static_cast<std::uint32_t>(used.source_vertex.size());
        used.source_vertex.push_back(v);
    }
    for (glm::uvec3& triangle : used.triangles)
        triangle = {place[triangle.x], place[triangle.y], place[triangle.z]};
    FramedMesh part;
    part.mesh = carried(mesh, used);
    part.mesh.tangents.clear();  // They belong to the old triangles.
    part.mesh.material_ranges.clear();
    part.source_vertex = std::move(used.source_vertex);
    return part;
}

/// Computes new tangents from the texture coordinates of the old ones. Further texture coordinate
/// sets are kept for copied vertices; if there are new vertices, no primitive has further sets.
FramedMesh JoinedPrimitives::with_new_tangents(FramedMesh part, const FramedMesh& changed,
                                               std::size_t i, Report& report) const {
    if (!changed.source_vertex.empty()) {
        part.mesh.texcoords.clear();
        for (const std::uint32_t v : part.source_vertex) {
            part.mesh.texcoords.push_back(
                tangent_texcoords_[i][changed.source_vertex[v] - first_vertex_[i]]);
        }
    }
    FramedMesh framed =
        with_frames(std::move(part.mesh), {.tangents = TangentMethod::mikktspace}, report);
    for (std::uint32_t& source : framed.source_vertex)
        source = part.source_vertex[source];
    return framed;
}

FramedMesh JoinedPrimitives::part(const FramedMesh& changed, std::size_t i, NormalMode normals,
                                  Report& report) const {
    const Mesh& before = primitives_[i];
    FramedMesh part = range_of(changed.mesh, changed.mesh.material_ranges[i]);
    if (before.normals.empty() && normals == NormalMode::keep) part.mesh.normals.clear();
    if (before.texcoords.empty()) part.mesh.texcoords.clear();
    if (before.colors.empty()) part.mesh.colors.clear();
    if (!before.tangents.empty()) {
        // glTF ignores tangents without normals.
        // New vertices have texture coordinates only if the change computes them.
        const bool has_texcoords = changed.source_vertex.empty() ? !part.mesh.texcoords.empty()
                                                                 : !tangent_texcoords_[i].empty();
        const bool possible = has_texcoords && !part.mesh.normals.empty();
        report.add("tangents of other triangles", "primitive", ids_[i].primitive,
                   possible ? "are recomputed" : "are removed");
        if (possible) part = with_new_tangents(std::move(part), changed, i, report);
    }
    for (std::uint32_t& source : part.source_vertex) {
        if (changed.source_vertex.empty()) break;
        source = changed.source_vertex[source] - first_vertex_[i];
        assert(source < before.positions.size());
    }
    return part;
}

/// Returns the primitives of a document by mesh, in its order.
std::map<std::size_t, std::vector<GltfPrimitiveId>> primitives_by_mesh(
    const GltfDocument& document) {
    std::map<std::size_t, std::vector<GltfPrimitiveId>> meshes;
    for (const GltfPrimitiveId id : document.triangle_primitives())
        meshes[id.mesh].push_back(id);
    return meshes;
}

void replace_joined(GltfDocument& document, const JoinedPrimitives& joined,
                    const FramedMesh& changed, NormalMode normals, Report report,
                    ChangedModel& done) {
    for (std::size_t i = 0; i < joined.ids().size(); ++i) {
        const GltfPrimitiveId id = joined.ids()[i];
        if (changed.mesh.material_ranges[i].triangle_count == 0) {
            report.add("primitive without area", "primitive", id.primitive, "is unchanged");
            continue;
        }
        const FramedMesh part = joined.part(changed, i, normals, report);
        done.triangles_written += part.mesh.triangles.size();
        done.vertices_written += part.mesh.positions.size();
        done.has_tangents = done.has_tangents || !part.mesh.tangents.empty();
        if (changed.source_vertex.empty())
            document.set_geometry(id, part.mesh);
        else
            document.set_frames(id, part);
    }
    done.reports.push_back({document.describe(joined.ids().front()), std::move(report)});
}

ChangedModel change_document(GltfDocument& document,
                             const std::map<std::size_t, std::vector<GltfPrimitiveId>>& primitives,
                             NormalMode normals, const ModelChange& change) {
    ChangedModel done;
    std::vector<JoinedPrimitives> meshes;
    for (const auto& [mesh, ids] : primitives)
        meshes.emplace_back(document, ids);
    if (meshes.empty()) throw InvalidInput("has no triangles");
    const std::map<std::size_t, detail::MeshInstances> instances = detail::instances_of(document);
    std::vector<TriangleInput> inputs;
    for (const JoinedPrimitives& joined : meshes) {
        done.triangles_read += joined.mesh().triangles.size();
        done.vertices_read += joined.mesh().positions.size();
        const auto placed = instances.find(joined.ids().front().mesh);
        const bool has_scale = placed != instances.end() && placed->second.largest > 0.0;
        inputs.push_back(
            {joined.mesh(), joined.deformation(), has_scale ? placed->second.largest : 1.0});
    }
    std::vector<Report> reports(meshes.size());
    Report whole;
    const std::vector<FramedMesh> changed = change(inputs, reports, whole);
    for (std::size_t i = 0; i < meshes.size(); ++i)
        replace_joined(document, meshes[i], changed[i], normals, std::move(reports[i]), done);
    if (!whole.empty()) done.reports.push_back({"", std::move(whole)});
    return done;
}

void change_mesh(Mesh& mesh, const ModelChange& change, ChangedModel& done) {
    Report report;
    Report whole;
    done.triangles_read = mesh.triangles.size();
    done.vertices_read = mesh.positions.size();
    const Deformation none;
    const TriangleInput input{mesh, none};
    mesh = std::move(change(std::span(&input, 1), std::span(&report, 1), whole).front().mesh);
    report.merge(whole);
    if (mesh.triangles.empty()) throw InvalidInput("none of its triangles has an area");
    done.triangles_written = mesh.triangles.size();
    done.vertices_written = mesh.positions.size();
    done.has_tangents = !mesh.tangents.empty();
    done.reports.push_back({"", std::move(report)});
}

/// Applies a change to each mesh.
ModelChange one_by_one(const TriangleChange& change) {
    return [&change](std::span<const TriangleInput> meshes, std::span<Report> reports, Report&) {
        std::vector<FramedMesh> changed;
        for (std::size_t i = 0; i < meshes.size(); ++i)
            changed.push_back(change(meshes[i], reports[i]));
        return changed;
    };
}

}  // namespace

ChangedModel change_triangles(Model& model, NormalMode normals, const TriangleChange& change) {
    return change_triangles(model, normals, one_by_one(change));
}

ChangedModel change_triangles(Model& model, NormalMode normals, const ModelChange& change) {
    if (auto* document = std::get_if<GltfDocument>(&model))
        return change_document(*document, primitives_by_mesh(*document), normals, change);
    ChangedModel done;
    change_mesh(std::get<MeshFile>(model).mesh, change, done);
    return done;
}

ChangedModel change_triangles(GltfDocument& document, std::span<const std::size_t> meshes,
                              NormalMode normals, const TriangleChange& change) {
    auto primitives = primitives_by_mesh(document);
    std::erase_if(primitives, [&](const auto& entry) {
        return std::find(meshes.begin(), meshes.end(), entry.first) == meshes.end();
    });
    return change_document(document, primitives, normals, one_by_one(change));
}

}  // namespace relief
