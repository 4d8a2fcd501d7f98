// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>

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
        if (ids.empty()) throw InvalidInput("holds no triangles");
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

}  // namespace relief
