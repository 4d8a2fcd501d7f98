// SPDX-License-Identifier: Apache-2.0
// Reads, computes frames primitive by primitive, writes. glTF's primitives without texture
// coordinates cannot have tangents: one finding each, or a failure where none has any.
// Tests: tests/tools/relief_mesh_test.cpp.
#include "processing.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

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

/// Frames of one primitive and the record of how it got them.
FramedMesh framed_part(Mesh mesh, std::size_t index, FrameOptions options, ProcessedPart& part,
                       Report& report) {
    const bool had_normals = !mesh.normals.empty();
    const bool had_tangents = !mesh.tangents.empty();
    if (options.tangents == TangentMode::mikktspace && mesh.texcoords.empty()) {
        report.add("primitive without texture coordinates", "primitive", index, "gets no tangents");
        options.tangents = TangentMode::none;
    }
    part.triangles = mesh.triangles.size();
    part.vertices_read = mesh.positions.size();
    if (options.normals == NormalMode::keep && !had_normals)
        part.normal_mode = options.if_missing;
    else
        part.normal_mode = options.normals;

    FramedMesh framed = with_frames(std::move(mesh), options, report);
    part.normals_by_area = framed.normals_by_area;
    part.smoothing_groups = framed.within_smoothing_groups;
    part.vertices_written = framed.mesh.positions.size();
    part.normals =
        fate(had_normals, !framed.mesh.normals.empty(), part.normal_mode != NormalMode::keep);
    part.tangents =
        fate(had_tangents, !framed.mesh.tangents.empty(),
             options.tangents == TangentMode::mikktspace || part.normal_mode != NormalMode::keep);
    return framed;
}

[[noreturn]] void no_texcoords(const std::filesystem::path& file) {
    throw failure(file, "no texture coordinates, so there can be no tangents",
                  "unwrap the model first, or leave --tangents out");
}

void process_document(const ProcessRequest& request, GltfDocument& document,
                      const FrameOptions& options, Processed& done) {
    const std::vector<GltfPrimitiveId> ids = document.triangle_primitives();
    if (ids.empty()) throw FileError(request.input, "holds no triangles");
    bool any_texcoords = false;
    for (const GltfPrimitiveId id : ids) {
        ProcessedPart part{.name = document.describe(id)};
        Report report;
        try {
            Mesh mesh = document.mesh(id);
            any_texcoords = any_texcoords || !mesh.texcoords.empty();
            const FramedMesh framed =
                framed_part(std::move(mesh), id.primitive, options, part, report);
            part.vertices_written = document.set_frames(id, framed, options, report);
        } catch (const InvalidInput& error) {
            throw FileError(request.input, part.name + ": " + error.what());
        }
        done.findings.add(part.name, report);
        done.parts.push_back(std::move(part));
    }
    if (options.tangents == TangentMode::mikktspace && !any_texcoords) no_texcoords(request.input);
}

void process_mesh(const ProcessRequest& request, MeshFile& contents, const FrameOptions& options,
                  Processed& done) {
    if (options.tangents == TangentMode::mikktspace && contents.mesh.texcoords.empty())
        no_texcoords(request.input);
    ProcessedPart part;
    Report report;
    FramedMesh framed = about(request.input, [&] {
        return framed_part(std::move(contents.mesh), 0, options, part, report);
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
    stages.run("write", [&] {
        done.left_behind = write_model(request.output, model, request.input, has_tangents(done));
    });
    return done;
}

}  // namespace relief::tools
