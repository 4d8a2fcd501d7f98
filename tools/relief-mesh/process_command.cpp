// SPDX-License-Identifier: Apache-2.0
// `relief-mesh process IN OUT` and `IN... -o DIR/` process one or more models, print a summary and
// write the report. Options that could have no effect are refused before a file is read.
// Tests: tests/tools/relief_mesh_test.cpp, batch_test.cpp, process_tangents_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <vector>

#include "commands.h"
#include "common/command.h"
#include "common/file_jobs.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/shard_choice.h"
#include "common/summary.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/model.h"

namespace relief::tools {
namespace {

struct ProcessRequest {
    std::filesystem::path input;
    std::filesystem::path output;
    FrameOptions frames;
    std::optional<int> uv_set;  ///< For computed tangents. Default: the set of the normal texture.
    std::optional<double> crease_degrees;  ///< Becomes frames.crease_angle.
    /// A model without texture coordinates is an error if tangents are to be computed. Otherwise it
    /// gets none, which is a finding.
    bool requires_tangents = false;
};

/// The result for a model.
struct Processed {
    std::vector<FramedPart> parts;
    std::vector<std::string> decompressed;  ///< Compressed content that is written uncompressed.
    std::vector<std::string> omitted;       ///< Content that the output format cannot store.
    Findings findings;
};

FrameOptions frame_options(const ProcessRequest& request) {
    FrameOptions options = request.frames;
    if (request.crease_degrees)
        options.crease_angle = *request.crease_degrees * std::numbers::pi / 180.0;
    return options;
}

/// Returns the texture coordinate sets of all primitives.
std::set<int> texcoord_sets(const Model& model) {
    const auto* document = std::get_if<GltfDocument>(&model);
    if (document == nullptr) {
        const bool has_set = !std::get<MeshFile>(model).mesh.texcoords.empty();
        return has_set ? std::set<int>{0} : std::set<int>{};
    }
    std::set<int> all;
    for (const GltfPrimitiveId id : document->triangle_primitives()) {
        const std::vector<int> sets = document->texcoord_sets(id);
        all.insert(sets.begin(), sets.end());
    }
    return all;
}

/// Returns whether a model is a mesh without texture coordinates. Primitives of glTF are checked
/// one by one.
bool has_no_texcoords(const Model& model) {
    const auto* file = std::get_if<MeshFile>(&model);
    return file != nullptr && file->mesh.texcoords.empty();
}

/// Checks that some primitive has the texture coordinates for the request. \throws FileError
void check_texcoords(const ProcessRequest& request, const Model& model) {
    const auto* document = std::get_if<GltfDocument>(&model);
    if (document != nullptr && document->triangle_primitives().empty()) return;
    const std::set<int> sets = texcoord_sets(model);
    if (sets.empty() && computes_tangents(request.frames.tangents) && request.requires_tangents) {
        throw failure(request.input, "no texture coordinates, so there can be no tangents",
                      "unwrap the model first with relief-mesh unwrap, or leave --tangents out");
    }
    if (document == nullptr || !request.uv_set || sets.contains(*request.uv_set)) return;
    throw failure(request.input,
                  fmt::format("no primitive has texture coordinate set {}", *request.uv_set),
                  sets.empty() ? "the model has no texture coordinates"
                               : fmt::format("available: {}", fmt::join(sets, ", ")));
}

/// Reads a model, computes normals and tangents, and writes it.
/// \throws FileError; then no file is written
Processed process(const ProcessRequest& request, Stages& stages) {
    Processed done;
    Report read_report;
    Model model = stages.run("read", [&] { return read_model(request.input, read_report); });
    done.findings.add("", read_report);
    if (const auto* document = std::get_if<GltfDocument>(&model))
        done.decompressed = compression_text(*document, true);
    stages.run("frames", [&] {
        check_texcoords(request, model);
        FrameOptions options = frame_options(request);
        Report report;
        if (has_no_texcoords(model) && computes_tangents(request.frames.tangents)) {
            options.tangents = TangentMethod::none;
            report.add("model without texture coordinates", "model", 0, "gets no tangents");
        }
        done.findings.add("", report);
        done.parts =
            about(request.input, [&] { return compute_frames(model, options, request.uv_set); });
    });
    for (const FramedPart& part : done.parts)
        done.findings.add(part.name, part.report);
    const bool has_tangents =
        std::any_of(done.parts.begin(), done.parts.end(), [](const FramedPart& part) {
            return part.tangents == AttributeOutcome::kept ||
                   part.tangents == AttributeOutcome::computed;
        });
    Report write_report;
    stages.run("write", [&] {
        done.omitted =
            write_model(request.output, model, request.input, has_tangents, write_report);
    });
    done.findings.add("", write_report);
    return done;
}

struct Totals {
    std::size_t triangles = 0;
    std::size_t vertices_read = 0;
    std::size_t vertices_written = 0;
};

Totals totals_of(const Processed& done) {
    Totals totals;
    for (const FramedPart& part : done.parts) {
        totals.triangles += part.triangles;
        totals.vertices_read += part.vertices_read;
        totals.vertices_written += part.vertices_written;
    }
    return totals;
}

std::string part_normals_text(const FramedPart& part) {
    switch (part.normals) {
        case AttributeOutcome::kept:
            return "kept";
        case AttributeOutcome::removed:
            return "removed";
        case AttributeOutcome::absent:
            return "none";
        case AttributeOutcome::computed:
            break;
    }
    if (part.normal_mode == NormalMode::flat) return "computed, one per triangle";
    std::string text = fmt::format("computed, averaged by {}", enum_name(part.normal_mode));
    if (part.normal_mode == NormalMode::automatic) {
        text = "computed, averaged by max";
        if (part.normals_by_area != 0) {
            text += fmt::format(", and by area at {} with folded triangles",
                                counted(part.normals_by_area, "vertex", "vertices"));
        }
    }
    return text + (part.smoothing_groups ? ", within the file's smoothing groups" : "");
}

/// "MikkTSpace", "area-weighted", ...
std::string method_text(TangentMethod method) {
    return method == TangentMethod::mikktspace ? "MikkTSpace" : enum_name(method);
}

std::string part_tangents_text(const FramedPart& part) {
    switch (part.tangents) {
        case AttributeOutcome::kept:
            return "kept";
        case AttributeOutcome::computed: {
            const std::string method = "computed, " + method_text(part.tangent_method);
            if (part.texcoords.is_only && part.texcoords.set == 0) return method;
            return fmt::format("{}, from texture coordinate set {} ({})", method,
                               part.texcoords.set, part.texcoords.reason);
        }
        case AttributeOutcome::removed:
            return "removed";
        case AttributeOutcome::absent:
            break;
    }
    return "none";
}

/// "kept", or for different primitives: "kept in 3 primitives; computed in 1 primitive".
std::string text_of(const std::vector<FramedPart>& parts,
                    const std::function<std::string(const FramedPart&)>& words) {
    std::map<std::string, std::size_t> counts;
    for (const FramedPart& part : parts)
        ++counts[words(part)];
    if (counts.size() == 1) return counts.begin()->first;
    std::string text;
    for (const auto& [what, count] : counts) {
        text +=
            fmt::format("{}{} in {}", text.empty() ? "" : "; ", what, counted(count, "primitive"));
    }
    return text;
}

std::string splits_text(const Totals& totals) {
    if (totals.vertices_written == totals.vertices_read) return "none needed";
    return fmt::format("{} -> {} vertices", totals.vertices_read, totals.vertices_written);
}

std::string outcome_name(AttributeOutcome outcome) {
    switch (outcome) {
        case AttributeOutcome::kept:
            return "kept";
        case AttributeOutcome::computed:
            return "computed";
        case AttributeOutcome::removed:
            return "removed";
        case AttributeOutcome::absent:
            break;
    }
    return "none";
}

/// Returns the notes of all primitives. Equal notes share a line.
std::vector<std::string> notes_text(const Processed& done) {
    std::vector<std::pair<std::string, std::vector<std::string>>> places;
    for (const FramedPart& part : done.parts) {
        for (const std::string& note : part.notes) {
            auto place = std::find_if(places.begin(), places.end(),
                                      [&](const auto& other) { return other.first == note; });
            if (place == places.end()) place = places.insert(places.end(), {note, {}});
            place->second.push_back(part.name);
        }
    }
    std::vector<std::string> lines;
    for (const auto& [note, names] : places) {
        lines.push_back(fmt::format(
            "{}{}: {}", names.front(),
            names.size() == 1 ? "" : fmt::format(" and {} more", names.size() - 1), note));
    }
    return lines;
}

Json primitive_json(const FramedPart& part) {
    Json json = {{"name", part.name},
                 {"triangles", part.triangles},
                 {"vertices_read", part.vertices_read},
                 {"vertices_written", part.vertices_written},
                 {"normals", outcome_name(part.normals)}};
    if (part.normals == AttributeOutcome::computed) {
        json["normal_method"] = enum_name(part.normal_mode);
        if (part.normal_mode == NormalMode::automatic)
            json["vertices_by_area"] = part.normals_by_area;
        json["smoothing_groups"] = part.smoothing_groups;
    }
    json["tangents"] = outcome_name(part.tangents);
    if (part.tangents == AttributeOutcome::computed) {
        json["tangent_method"] = enum_name(part.tangent_method);
        json["texcoord_set"] = part.texcoords.set;
        json["texcoord_set_reason"] = part.texcoords.reason;
    }
    json["notes"] = part.notes;
    return json;
}

Summary summary_of(const ProcessRequest& request, const Processed& done, const Stages& stages) {
    const Totals totals = totals_of(done);
    Summary summary;
    summary.add(
        "read",
        fmt::format("{}: {}, {}, {}, {}", request.input.string(),
                    format_name(readable_format(request.input)),
                    counted(done.parts.size(), "primitive"), counted(totals.triangles, "triangle"),
                    counted(totals.vertices_read, "vertex", "vertices")),
        {{"primitives", json_list(done.parts, primitive_json)}});
    summary.add("normals", text_of(done.parts, part_normals_text));
    summary.add("tangents", text_of(done.parts, part_tangents_text));
    summary.add("splits", splits_text(totals));
    summary.add_findings(done.findings);
    summary.add("notes", notes_text(done));
    summary.add("unpacked",
                done.decompressed.empty()
                    ? ""
                    : fmt::format("{} (written uncompressed)", fmt::join(done.decompressed, ", ")),
                {{"decompressed", done.decompressed}});
    add_omitted(summary, done.omitted, request.output);
    summary.add_times(stages);
    const bool has_companions = writable_format(request.output) == ModelFormat::gltf;
    summary.add("wrote", file_and_size(request.output) +
                             (has_companions ? ", its buffer and images beside it" : ""));
    return summary;
}

std::string line_of(const ProcessRequest& request, const Processed& done, const Stages& stages) {
    const Totals totals = totals_of(done);
    return fmt::format(
        "{}: {}, {}, normals {}, tangents {}, {}{}, {}", request.output.string(),
        counted(totals.triangles, "triangle"),
        counted(totals.vertices_written, "vertex", "vertices"),
        text_of(done.parts, part_normals_text), text_of(done.parts, part_tangents_text),
        done.findings.count_text(),
        done.omitted.empty() ? "" : fmt::format(", left out: {}", fmt::join(done.omitted, ", ")),
        duration(stages.milliseconds()));
}

/// The head of the report, without the files.
Json head_json(const ProcessRequest& request) {
    Json options = {{"normals", enum_name(request.frames.normals)},
                    {"tangents", enum_name(request.frames.tangents)}};
    if (request.uv_set) options["uv_set"] = *request.uv_set;
    if (request.crease_degrees) options["crease_degrees"] = *request.crease_degrees;
    options["weld_tolerance"] = request.frames.weld_tolerance;
    return {
        {"tool", "relief-mesh process"}, {"version", version()}, {"options", std::move(options)}};
}

FileOutcome outcome_of(const ProcessRequest& request) {
    Stages stages(true);
    const Processed done = process(request, stages);
    return {line_of(request, done, stages), done.findings, summary_of(request, done, stages)};
}

/// Processes several models, in parallel unless they could write the same companion files. An error
/// in one model does not stop the others. Prints a line per model in the given order, and writes
/// the report.
///
/// \return failed if a model failed; else fell_back if --strict was given and there are findings
ExitCode process_all(const CLI::App& app, const std::vector<ProcessRequest>& requests,
                     const ReportOptions& report, const GeneralOptions& general) {
    Batch batch;
    for (const ProcessRequest& request : requests)
        batch.jobs.push_back({request.input, request.output});
    batch.work = [&](std::size_t index) { return outcome_of(requests[index]); };
    batch.one_by_one = may_share_companions(batch.jobs);
    batch.head = head_json(requests.front());
    return run_batch(app, batch, report, general);
}

constexpr int max_uv_set = 1000;

struct ProcessOptions {
    FileWords words;
    std::optional<ModelFormat> format;  ///< The format of files in an output folder.
    ProcessRequest request;             ///< The files are set for each model.
    std::optional<ShardChoice> shard;
    ReportOptions report;
    GeneralOptions general;
};

/// Refuses requests that the formats of input and output cannot fulfill.
void check_formats(const ProcessRequest& request) {
    const ModelFormat input = readable_format(request.input);
    const ModelFormat output = writable_format(request.output);
    if (computes_tangents(request.frames.tangents) && !is_document(output)) {
        throw UsageError(
            fmt::format("--tangents {}: {} cannot store tangents",
                        enum_name(request.frames.tangents), extension_of(request.output)),
            "write .glb or .gltf");
    }
    if (request.uv_set.value_or(0) > 0 && !is_document(input)) {
        throw UsageError(fmt::format("--uv-set {}: {}: has only texture coordinate set 0",
                                     *request.uv_set, request.input.string()),
                         "only glTF has several");
    }
}

/// Refuses normal options without effect.
void check_normal_options(const ProcessRequest& request) {
    const bool averages =
        request.frames.normals != NormalMode::keep && request.frames.normals != NormalMode::flat;
    const auto require = [](bool condition, const char* option, const char* what) {
        if (!condition) throw UsageError(fmt::format("{}: {}", option, what));
    };
    const char* averaged = "applies only to averaged normals: --normals auto, angle, max, ...";
    require(averages || !request.crease_degrees, "--crease", averaged);
    require(averages || request.frames.smoothing_groups, "--ignore-smoothing-groups", averaged);
    require(averages || request.frames.repair || request.frames.weld_tolerance == 0.0, "--weld",
            averaged);
    require(request.frames.normals == NormalMode::keep || !request.frames.repair,
            "--repair-normals", "applies only to kept normals: omit --normals");
}

/// Refuses --uv-set if no tangents are computed.
void check_tangent_options(const ProcessRequest& request) {
    const bool follow_normals = request.frames.tangents == TangentMethod::keep &&
                                request.frames.normals != NormalMode::keep;
    if (!request.uv_set || computes_tangents(request.frames.tangents) || follow_normals) return;
    throw UsageError(fmt::format("--uv-set {}: applies only to computed tangents", *request.uv_set),
                     "give --tangents mikktspace");
}

/// Refuses --require-tangents if no tangents are computed.
void check_required_tangents(const ProcessRequest& request) {
    if (!request.requires_tangents || computes_tangents(request.frames.tangents)) return;
    throw UsageError("--require-tangents: has no effect without computed tangents",
                     "give --tangents mikktspace");
}

/// Returns a request per model. \throws UsageError, FileError
std::vector<ProcessRequest> requests_of(const ProcessOptions& options, const JobList& list) {
    check_normal_options(options.request);
    check_tangent_options(options.request);
    check_required_tangents(options.request);
    std::vector<ProcessRequest> requests;
    std::vector<std::filesystem::path> files;
    for (const Job& job : list.jobs) {
        ProcessRequest request = options.request;
        request.input = job.input;
        request.output = job.output;
        if (list.is_single()) request.requires_tangents = true;
        check_formats(request);
        files.insert(files.end(), {job.input, job.output});
        requests.push_back(std::move(request));
    }
    if (list.folder) make_folder(*list.folder);
    check(options.report, files);
    require_folder_of(requests.front().output);
    return requests;
}

ExitCode process_one(const CLI::App& app, const ProcessRequest& request,
                     const ProcessOptions& options) {
    Stages stages(options.general.quiet);
    const Processed done = process(request, stages);
    const Summary summary = summary_of(request, done, stages);
    if (!options.general.quiet) summary.print();
    Json report = head_json(request);
    report["input"] = request.input.string();
    report["output"] = request.output.string();
    report.update(summary.json());
    return finish(app, options.report, request.input, done.findings, report);
}

ExitCode run(const CLI::App& app, const ProcessOptions& options) {
    const JobList list = model_jobs_of(options.words, options.format);
    if (options.shard && list.is_single())
        throw UsageError("--shard: divides several models", "give an output folder with -o");
    std::vector<ProcessRequest> requests = requests_of(options, list);
    keep_shard(options.shard, requests);
    set_thread_limit(options.general.threads);
    if (!list.is_single()) return process_all(app, requests, options.report, options.general);
    return process_one(app, requests.front(), options);
}

void add_normal_options(CLI::App& app, ProcessRequest& request) {
    const char* group = "Normals";
    add_choice(app, "--normals", request.frames.normals, enum_choices<NormalMode>(),
               "The source of normals: the file (keep), one per triangle (flat), or an average "
               "around each vertex with the named weights. auto uses max, the most accurate on "
               "smooth meshes, and area at folded triangles. docs/normals.md lists errors and "
               "times. Default: keep; a mesh without normals gets flat ones if it is glTF, which "
               "requires it, and angle otherwise.")
        .group(group);
    add_number(app, "--crease", "DEG", request.crease_degrees, {0.0, 180.0, "degrees"},
               "Edges sharper than this angle in degrees are hard: vertices are split along them, "
               "and between triangles that share only a vertex. Default: hard edges only between "
               "the smoothing groups of an OBJ file.")
        .group(group);
    add_switch(app, "--ignore-smoothing-groups",
               "Smooth across the smoothing groups of an OBJ file, also if they are off.",
               [&request] { request.frames.smoothing_groups = false; })
        .group(group);
    add_number(app, "--weld", "TOLERANCE", request.frames.weld_tolerance,
               {0.0, std::numeric_limits<float>::max(), "units"},
               "Vertices within this distance, in the unit of the model, share a normal. Default: "
               "0 (equal positions).")
        .group(group);
    add_switch(app, "--repair-normals", request.frames.repair,
               "Replace zero and non-finite normals of the file by averaged ones, and normalize "
               "the others. Default: such normals are kept and reported.")
        .group(group);
}

void add_tangent_options(CLI::App& app, ProcessRequest& request) {
    const char* group = "Tangents";
    add_choice(app, "--tangents", request.frames.tangents, tangent_choices(),
               "Tangents for normal maps: those of the file (keep; recomputed if normals are), "
               "none, or computed, with split vertices where necessary: by the standard of bakers "
               "and glTF (mikktspace), weighted by area, so that thin bevels do not affect large "
               "faces, or by Lengyel's sum over each vertex. A normal map is correct only with the "
               "tangents for which it was baked, see docs/tangents.md. Default: keep.")
        .group(group);
    add_value(app, "--uv-set", "N",
              "Compute tangents from texture coordinate set N (TEXCOORD_N of glTF; other formats "
              "have only set 0). Default: the set of the normal texture of each primitive, as glTF "
              "requires, including the set of KHR_texture_transform; without normal texture, the "
              "first set. All sets stay in the file.",
              [&request](const std::string& subject, const std::string& text) {
                  request.uv_set = parse_integer(subject, text, 0, max_uv_set);
              })
        .group(group);
    add_switch(app, "--require-tangents", request.requires_tangents,
               "Fail for a model without texture coordinates, from which --tangents cannot compute "
               "any, also among several models. Default: among several models, it gets only "
               "normals, which is a finding.")
        .group(group);
}

void add_options(CLI::App& app, ProcessOptions& options) {
    add_model_files(app, options.words, options.format);
    add_normal_options(app, options.request);
    add_tangent_options(app, options.request);
    add_shard_option(app, options.shard,
                     "Process only every N-th model, from the K-th on, so that several machines "
                     "share them: together, shards 1/N to N/N process each model once.");
    add_report_options(app, options.report);
    add_general_options(app, options.general);
    set_examples(
        app,
        {"relief-mesh process data/vase.obj out/vase.glb --tangents mikktspace",
         "relief-mesh process out/vase.glb out/vase-flat.glb --normals flat",
         "relief-mesh process out/vase.glb out/vase-0.glb --tangents mikktspace --uv-set 0",
         "relief-mesh process data/vase.obj out/vase-area.glb --tangents area-weighted",
         "relief-mesh process data/vase.obj out/vase.ply --normals area --report out/vase.json",
         "relief-mesh process data/vase.obj out/vase-hard.glb --normals auto --crease 40",
         "relief-mesh process data/*.obj -o out/models/ --format glb --normals angle"});
}

}  // namespace

Command add_process_command(CLI::App& tool) {
    return add_command<ProcessOptions>(
        tool, "process",
        "Computes the normals and tangents of models; all other content of a glTF file is kept.",
        add_options, run);
}

}  // namespace relief::tools
