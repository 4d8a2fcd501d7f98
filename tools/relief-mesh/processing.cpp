// SPDX-License-Identifier: Apache-2.0
// Reads, computes frames primitive by primitive, writes. Tangents of a glTF primitive belong to the
// texture coordinates of its normal texture, or to those asked for. Primitives without cannot have
// new tangents: one finding each, or a failure where none has any.
// Tests: tests/tools/relief_mesh_test.cpp.
#include "processing.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "common/text.h"

namespace relief::tools {
namespace {

/// glTF says that missing normals are flat; other formats leave it open, and smooth looks right.
FrameOptions frame_options(const ProcessRequest& request, ModelFormat input) {
    return {.normals = request.normals,
            .if_missing = is_document(input) ? NormalMode::flat : NormalMode::angle,
            .tangents = request.tangents,
            .weld_tolerance = request.weld_tolerance,
            .crease_angle = request.crease_degrees
                                ? std::optional(*request.crease_degrees * std::numbers::pi / 180.0)
                                : std::nullopt,
            .smoothing_groups = !request.ignore_smoothing_groups,
            .repair = request.repair_normals};
}

Fate fate(bool before, bool after, bool computed) {
    if (after) return computed ? Fate::computed : Fate::kept;
    return before ? Fate::removed : Fate::absent;
}

/// Sets in words: "0, 1".
std::string in_words(const std::vector<int>& sets) {
    return fmt::format("{}", fmt::join(sets, ", "));
}

/// The texture coordinate set of a primitive's tangents, and why that one.
TangentTexcoords choose_texcoords(const GltfDocument& document, GltfPrimitiveId id,
                                  std::optional<int> asked_for) {
    TangentTexcoords chosen;
    const std::vector<int> sets = document.texcoord_sets(id);
    const GltfTangentTexcoords own = document.tangent_texcoords(id);
    chosen.is_only = sets.size() <= 1;
    chosen.set = asked_for.value_or(own.set);
    if (asked_for)
        chosen.reason = "asked for";
    else if (own.texture.empty() || own.missing)
        chosen.reason = "the first";
    else
        chosen.reason = "of " + own.texture;
    return chosen;
}

/// What the material says of computed tangents that is not as one may expect.
void remark_on_material(const GltfDocument& document, GltfPrimitiveId id, ProcessedPart& part,
                        Report& report) {
    const GltfTangentTexcoords own = document.tangent_texcoords(id);
    if (own.missing && part.texcoords.reason == "the first") {
        report.add("texture on a missing texture coordinate set", "primitive", id.primitive,
                   "gets tangents from the first set that there is");
    }
    const int of_texture = own.missing.value_or(own.set);
    if (!own.texture.empty() && !own.missing && of_texture != part.texcoords.set) {
        part.notes.push_back(fmt::format("{} is on texture coordinate set {}, tangents are of {}",
                                         own.texture, of_texture, part.texcoords.set));
    }
    if (own.is_turned) {
        part.notes.push_back(
            fmt::format("KHR_texture_transform turns or mirrors {}: tangents are those of the "
                        "coordinates as stored, renderers turn them with the texture",
                        own.texture));
    }
}

/// Given tangents that do not count: glTF says that without normals they must be ignored.
void report_ignored(const Mesh& mesh, std::size_t index, TangentMode tangents, Report& report) {
    if (!mesh.normals.empty() || mesh.tangents.empty() || tangents != TangentMode::keep) return;
    if (mesh.texcoords.empty()) return;  // They are removed, which with_frames reports.
    report.add("tangents without normals", "primitive", index,
               "are ignored, as glTF asks, and computed anew");
}

/// What becomes of tangents that cannot be computed for want of texture coordinates: those that
/// belong to normals that stay are no worse than none.
TangentMode without_texcoords(const Mesh& mesh, std::size_t index, const FrameOptions& options,
                              const char* what, Report& report) {
    const bool stay =
        !mesh.tangents.empty() && !mesh.normals.empty() && options.normals == NormalMode::keep;
    report.add(what, "primitive", index,
               stay ? "keeps the tangents that it has" : "gets no tangents");
    return stay ? TangentMode::keep : TangentMode::none;
}

/// Frames of one primitive and the record of how it got them.
/// \param options  what to do; comes back as what can be done
FramedMesh framed_part(Mesh mesh, FrameOptions& options, ProcessedPart& part, Report& report) {
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
        (options.tangents == TangentMode::keep && part.normal_mode != NormalMode::keep);
    part.tangent_mode =
        computes_tangents(options.tangents) ? options.tangents : TangentMode::mikktspace;

    FramedMesh framed = with_frames(std::move(mesh), options, report);
    part.normals_by_area = framed.normals_by_area;
    part.smoothing_groups = framed.within_smoothing_groups;
    part.vertices_written = framed.mesh.positions.size();
    part.normals =
        fate(had_normals, !framed.mesh.normals.empty(), part.normal_mode != NormalMode::keep);
    part.tangents = fate(had_tangents, !framed.mesh.tangents.empty(), has_new_tangents);
    return framed;
}

[[noreturn]] void no_texcoords(const std::filesystem::path& file) {
    throw failure(file, "no texture coordinates, so there can be no tangents",
                  "unwrap the model first, or leave --tangents out");
}

/// The texture coordinate sets that some primitive of a document has.
std::set<int> all_sets(const GltfDocument& document) {
    std::set<int> all;
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const std::vector<int> sets = document.texcoord_sets(id);
        all.insert(sets.begin(), sets.end());
    }
    return all;
}

/// Refuses what no primitive can do.
void check_sets(const ProcessRequest& request, const GltfDocument& document) {
    const std::set<int> sets = all_sets(document);
    if (sets.empty() && computes_tangents(request.tangents)) no_texcoords(request.input);
    if (!request.uv_set || sets.count(*request.uv_set) != 0) return;
    throw failure(
        request.input, fmt::format("no primitive has texture coordinate set {}", *request.uv_set),
        sets.empty() ? "there is none at all" : "there is " + in_words({sets.begin(), sets.end()}));
}

/// One primitive, read, framed and put back.
void process_primitive(GltfDocument& document, GltfPrimitiveId id, const ProcessRequest& request,
                       FrameOptions options, ProcessedPart& part, Report& report) {
    part.texcoords = choose_texcoords(document, id, request.uv_set);
    Mesh mesh = document.mesh(id, part.texcoords.set);
    if (computes_tangents(options.tangents) && mesh.texcoords.empty()) {
        const char* what = document.texcoord_sets(id).empty()
                               ? "primitive without texture coordinates"
                               : "primitive without the texture coordinate set asked for";
        options.tangents = without_texcoords(mesh, id.primitive, options, what, report);
    }
    report_ignored(mesh, id.primitive, options.tangents, report);
    const FramedMesh framed = framed_part(std::move(mesh), options, part, report);
    if (part.tangents == Fate::computed) remark_on_material(document, id, part, report);
    part.vertices_written = document.set_frames(id, framed, options, report);
}

void process_document(const ProcessRequest& request, GltfDocument& document,
                      const FrameOptions& options, Processed& done) {
    const std::vector<GltfPrimitiveId> ids = document.triangle_primitives();
    if (ids.empty()) throw FileError(request.input, "holds no triangles");
    check_sets(request, document);
    for (const GltfPrimitiveId id : ids) {
        ProcessedPart part;
        part.name = document.describe(id);
        Report report;
        try {
            process_primitive(document, id, request, options, part, report);
        } catch (const InvalidInput& error) {
            throw FileError(request.input, part.name + ": " + error.what());
        }
        done.findings.add(part.name, report);
        done.parts.push_back(std::move(part));
    }
}

void process_mesh(const ProcessRequest& request, MeshFile& contents, FrameOptions options,
                  Processed& done) {
    if (computes_tangents(options.tangents) && contents.mesh.texcoords.empty())
        no_texcoords(request.input);
    ProcessedPart part;
    part.texcoords.reason = request.uv_set ? "asked for" : "the first";
    Report report;
    FramedMesh framed = about(request.input, [&] {
        return framed_part(std::move(contents.mesh), options, part, report);
    });
    contents.mesh = std::move(framed.mesh);
    done.findings.add("", report);
    done.parts.push_back(std::move(part));
}

bool has_tangents(const Processed& done) {
    return std::any_of(done.parts.begin(), done.parts.end(), [](const ProcessedPart& part) {
        return part.tangents == Fate::kept || part.tangents == Fate::computed;
    });
}

}  // namespace

Processed process(const ProcessRequest& request, Stages& stages) {
    const FrameOptions options = frame_options(request, readable_format(request.input));
    Processed done;

    Report read_report;
    Model model = stages.run("read", [&] { return read_model(request.input, read_report); });
    done.findings.add("", read_report);

    if (const auto* document = std::get_if<GltfDocument>(&model))
        done.decompressed = compression_in_words(*document, true);
    stages.run("frames", [&] {
        if (auto* document = std::get_if<GltfDocument>(&model))
            process_document(request, *document, options, done);
        else
            process_mesh(request, std::get<MeshFile>(model), options, done);
    });
    Report write_report;
    stages.run("write", [&] {
        done.left_behind =
            write_model(request.output, model, request.input, has_tangents(done), write_report);
    });
    done.findings.add("", write_report);
    return done;
}

}  // namespace relief::tools
