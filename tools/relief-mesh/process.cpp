// SPDX-License-Identifier: Apache-2.0
// Tangents of a glTF primitive belong to the texture coordinates of its normal texture, or to the
// requested set. A primitive without texture coordinates gets no new tangents, which is a finding;
// it is an error if no primitive has any.
#include "process.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "common/command.h"
#include "common/text.h"

namespace relief::tools {
namespace {

/// glTF requires flat normals if a mesh has none. Other formats do not specify them, and get smooth
/// ones.
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

/// Returns a list of sets: "0, 1".
std::string in_words(const std::vector<int>& sets) {
    return fmt::format("{}", fmt::join(sets, ", "));
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
void add_material_notes(const GltfDocument& document, GltfPrimitiveId id, ProcessedPart& part,
                        Report& report) {
    const GltfTangentTexcoords usual = document.tangent_texcoords(id);
    if (usual.missing && part.texcoords.reason == "the first") {
        report.add("texture on a missing texture coordinate set", "primitive", id.primitive,
                   "gets tangents from the first set");
    }
    const int of_texture = usual.missing.value_or(usual.set);
    if (!usual.texture.empty() && !usual.missing && of_texture != part.texcoords.set) {
        part.notes.push_back(fmt::format("{} uses texture coordinate set {}, the tangents use {}",
                                         usual.texture, of_texture, part.texcoords.set));
    }
    if (usual.is_turned) {
        part.notes.push_back(
            fmt::format("KHR_texture_transform rotates or mirrors {}: the tangents are those of "
                        "the stored coordinates, and renderers rotate them with the texture",
                        usual.texture));
    }
}

/// Reports tangents without normals, which glTF requires to ignore.
void report_ignored(const Mesh& mesh, std::size_t index, TangentMode tangents, Report& report) {
    if (!mesh.normals.empty() || mesh.tangents.empty() || tangents != TangentMode::keep) return;
    if (mesh.texcoords.empty()) return;  // with_frames() reports that they are removed.
    report.add("tangents without normals", "primitive", index,
               "are ignored, as glTF requires, and recomputed");
}

/// Returns how to treat the tangents of a primitive without texture coordinates. Existing tangents
/// are kept if their normals are kept.
TangentMode without_texcoords(const Mesh& mesh, std::size_t index, const FrameOptions& options,
                              const char* what, Report& report) {
    const bool are_kept =
        !mesh.tangents.empty() && !mesh.normals.empty() && options.normals == NormalMode::keep;
    report.add(what, "primitive", index, are_kept ? "keeps its tangents" : "gets no tangents");
    return are_kept ? TangentMode::keep : TangentMode::none;
}

/// Computes the frames of a primitive and records the outcome in `part`.
FramedMesh framed_part(Mesh mesh, const FrameOptions& options, ProcessedPart& part,
                       Report& report) {
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

/// Returns the texture coordinate sets of all primitives.
std::set<int> all_sets(const GltfDocument& document) {
    std::set<int> all;
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        const std::vector<int> sets = document.texcoord_sets(id);
        all.insert(sets.begin(), sets.end());
    }
    return all;
}

/// Checks that some primitive has the texture coordinates for the request.
void check_sets(const ProcessRequest& request, const GltfDocument& document) {
    const std::set<int> sets = all_sets(document);
    if (sets.empty() && computes_tangents(request.tangents)) no_texcoords(request.input);
    if (!request.uv_set || sets.count(*request.uv_set) != 0) return;
    throw failure(request.input,
                  fmt::format("no primitive has texture coordinate set {}", *request.uv_set),
                  sets.empty() ? "the model has no texture coordinates"
                               : "available: " + in_words({sets.begin(), sets.end()}));
}

void process_primitive(GltfDocument& document, GltfPrimitiveId id, const ProcessRequest& request,
                       FrameOptions options, ProcessedPart& part, Report& report) {
    part.texcoords = choose_texcoords(document, id, request.uv_set);
    Mesh mesh = document.mesh(id, part.texcoords.set);
    if (computes_tangents(options.tangents) && mesh.texcoords.empty()) {
        const char* what = document.texcoord_sets(id).empty()
                               ? "primitive without texture coordinates"
                               : "primitive without the requested texture coordinate set";
        options.tangents = without_texcoords(mesh, id.primitive, options, what, report);
    }
    report_ignored(mesh, id.primitive, options.tangents, report);
    const FramedMesh framed = framed_part(std::move(mesh), options, part, report);
    if (part.tangents == Fate::computed) add_material_notes(document, id, part, report);
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
    part.texcoords.reason = request.uv_set ? "requested" : "the first";
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

namespace fs = std::filesystem;

/// Returns the name of a model in an output folder.
fs::path name_in_folder(const fs::path& input, std::optional<ModelFormat> format) {
    const ModelFormat input_format = readable_format(input);
    fs::path name = input.filename();
    if (format) return name.replace_extension(extension_for(*format));
    const bool is_writable = !name_of(input_format, writable_choices()).empty();
    return is_writable ? name : name.replace_extension(extension_for(ModelFormat::glb));
}

void refuse_format(ModelFormat format, const fs::path& output) {
    throw UsageError(fmt::format("--format {}: the name {} already has a format",
                                 name_of(format, writable_choices()), output.string()),
                     "omit --format, or give a folder: -o out/");
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
        done.omitted =
            write_model(request.output, model, request.input, has_tangents(done), write_report);
    });
    done.findings.add("", write_report);
    return done;
}

JobList model_jobs_of(const FileWords& words, std::optional<ModelFormat> format) {
    JobList list = jobs_of(words, "model",
                           [&](const fs::path& input) { return name_in_folder(input, format); });
    if (format && !list.folder) refuse_format(*format, list.jobs.front().output);
    return list;
}

}  // namespace relief::tools
