// SPDX-License-Identifier: Apache-2.0
// `relief-mesh process IN OUT` and `IN... -o DIR/`: options in, process() called for each model,
// report out. A request that could have no effect is refused before anything is read.
// Tests: tests/tools/relief_mesh_test.cpp, process_jobs_test.cpp, process_batch_test.cpp.
#include <fmt/format.h>

#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "common/frame_choices.h"
#include "common/options.h"
#include "common/report_options.h"
#include "common/text.h"
#include "process_batch.h"
#include "process_jobs.h"
#include "process_summary.h"
#include "processing.h"
#include "relief/mesh/threads.h"

namespace relief::tools {
namespace {

constexpr int largest_uv_set = 1000;

struct ProcessOptions {
    FileWords words;
    std::optional<ModelFormat> format;  ///< Of what is written to a folder.
    ProcessRequest request;  ///< What to do to each model; its files are filled in per model.
    ReportOptions report;
    GeneralOptions general;
};

/// Refuses what the command line alone shows to be useless.
void check_request(const ProcessRequest& request) {
    const ModelFormat input = readable_format(request.input);
    const ModelFormat output = writable_format(request.output);
    if (computes_tangents(request.tangents) && !is_document(output)) {
        throw UsageError(fmt::format("--tangents {}: {} cannot hold tangents",
                                     word_of(request.tangents), extension_of(request.output)),
                         "write .glb or .gltf");
    }
    if (request.uv_set.value_or(0) > 0 && !is_document(input)) {
        throw UsageError(fmt::format("--uv-set {}: {}: has no texture coordinate set but 0",
                                     *request.uv_set, request.input.string()),
                         "only glTF has several");
    }
}

/// Refuses options that could not do anything.
void check_normals(const ProcessRequest& request) {
    const bool averages =
        request.normals != NormalMode::keep && request.normals != NormalMode::flat;
    const auto need = [](bool holds, const char* option, const char* what) {
        if (!holds) throw UsageError(fmt::format("{}: {}", option, what));
    };
    const char* averaged = "is for averaged normals: --normals auto, angle, max, ...";
    need(averages || !request.crease_degrees, "--crease", averaged);
    need(averages || !request.ignore_smoothing_groups, "--ignore-smoothing-groups", averaged);
    need(averages || request.repair_normals || request.weld_tolerance == 0.0, "--weld", averaged);
    need(request.normals == NormalMode::keep || !request.repair_normals, "--repair-normals",
         "is for normals that are kept: leave --normals out");
}

/// Refuses to choose texture coordinates for tangents that are not computed.
void check_tangent_options(const ProcessRequest& request) {
    const bool follow_normals =
        request.tangents == TangentMode::keep && request.normals != NormalMode::keep;
    if (!request.uv_set || computes_tangents(request.tangents) || follow_normals) return;
    throw UsageError(fmt::format("--uv-set {}: is for tangents that are computed", *request.uv_set),
                     "give --tangents mikktspace");
}

/// The same work for every model. \throws UsageError, FileError before anything is done
std::vector<ProcessRequest> requests_of(const ProcessOptions& options, const JobList& list) {
    check_normals(options.request);
    check_tangent_options(options.request);
    std::vector<ProcessRequest> requests;
    std::vector<std::filesystem::path> files;
    for (const Job& job : list.jobs) {
        ProcessRequest request = options.request;
        request.input = job.input;
        request.output = job.output;
        check_request(request);
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
    if (!options.general.quiet) print_summary(request, done, stages);
    return finish(app, options.report, request.input, done.findings,
                  process_json(request, done, stages));
}

ExitCode run(const CLI::App& app, const ProcessOptions& options) {
    const JobList list = model_jobs_of(options.words, options.format);
    const std::vector<ProcessRequest> requests = requests_of(options, list);
    set_thread_limit(options.general.threads);
    if (!list.is_single()) return process_all(app, requests, options.report, options.general);
    return process_one(app, requests.front(), options);
}

void add_file_options(CLI::App& app, ProcessOptions& options) {
    FileWords& words = options.words;
    add_files(app, "FILE...", words.files,
              "IN OUT: the model to read (.glb .gltf .obj .ply .stl .off) and the file to write "
              "(.glb .gltf .obj .ply), which may be IN itself: it is replaced only once the new "
              "file is complete. With -o: the models to read, any number of them. glTF compressed "
              "by Draco or meshopt is read, and written uncompressed.");
    add_value(app, "-o,--output", "PATH",
              "Where to write: a folder, which ends in / or exists, or for one model a file. In a "
              "folder each model keeps its name. One that fails does not stop the others.",
              [&words](const std::string&, const std::string& text) { words.output = text; })
        .group("Output");
    add_choice(app, "--format", options.format, writable_choices(),
               "The format of what is written to a folder. Default: that of the input, or glb for "
               ".stl and .off, which cannot be written.")
        .group("Output");
}

void add_normal_options(CLI::App& app, ProcessRequest& request) {
    const char* group = "Normals";
    add_choice(app, "--normals", request.normals, normal_choices(),
               "Where normals come from: the file (keep), one per triangle (flat), or averaged "
               "around each vertex, with triangles weighted as named; auto takes max, the most "
               "accurate on smooth meshes, but area where triangles fold over. docs/normals.md has "
               "errors and times. Default: keep; a mesh that has none gets flat ones from glTF, as "
               "its rules ask, and angle ones otherwise.")
        .group(group);
    add_number(app, "--crease", "DEG", request.crease_degrees, {0.0, 180.0, "degrees"},
               "Edges sharper than this many degrees are hard: vertices are split along them. "
               "Triangles that only touch in a vertex are apart too. Default: no hard edges but "
               "those between an OBJ file's smoothing groups.")
        .group(group);
    add_switch(app, "--ignore-smoothing-groups", request.ignore_smoothing_groups,
               "Smooth across the smoothing groups of an OBJ file, and where it says off.")
        .group(group);
    add_number(app, "--weld", "TOLERANCE", request.weld_tolerance,
               {0.0, std::numeric_limits<float>::max(), "units"},
               "Vertices no further apart than this, in the model's unit, share their normal. "
               "Default: 0, those at equal positions.")
        .group(group);
    add_switch(app, "--repair-normals", request.repair_normals,
               "Of the file's own normals, replace those that are zero or not finite by averaged "
               "ones, and scale others to unit length. Default: they are kept and reported.")
        .group(group);
}

void add_tangent_options(CLI::App& app, ProcessRequest& request) {
    const char* group = "Tangents";
    add_choice(app, "--tangents", request.tangents, tangent_choices(),
               "Tangents for normal maps: the file's own (keep; computed anew where normals are), "
               "none, or computed, splitting vertices where needed: as bakers and glTF assume "
               "(mikktspace), weighted by area, so that thin bevels do not disturb large faces, or "
               "by Lengyel's sum over each vertex. A map is right only in the frame that it was "
               "baked for: docs/tangents.md. Default: keep.")
        .group(group);
    add_value(app, "--uv-set", "N",
              "Compute tangents from texture coordinate set N (TEXCOORD_N of glTF; other formats "
              "have set 0 alone). Default: for each primitive the set of its normal texture, as "
              "glTF asks, where KHR_texture_transform has the last word; the first set if there "
              "is no normal texture. All sets stay in the file.",
              [&request](const std::string& subject, const std::string& text) {
                  request.uv_set = parse_integer(subject, text, 0, largest_uv_set);
              })
        .group(group);
}

void add_options(CLI::App& app, ProcessOptions& options) {
    add_file_options(app, options);
    add_normal_options(app, options.request);
    add_tangent_options(app, options.request);
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
    CLI::App& app = add_subcommand(
        tool, "process",
        "Gives models normals and tangents; everything else in a glTF file stays as it is.");
    const auto options = std::make_shared<ProcessOptions>();
    add_options(app, *options);
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
