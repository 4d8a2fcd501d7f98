// SPDX-License-Identifier: Apache-2.0
// `relief-mesh process IN OUT`: options in, process() called, report out. A request that could have
// no effect is refused before anything is read. Tests: tests/tools/relief_mesh_test.cpp.
#include <fmt/format.h>

#include <memory>

#include "commands.h"
#include "common/options.h"
#include "common/report_options.h"
#include "common/text.h"
#include "process_choices.h"
#include "process_summary.h"
#include "processing.h"
#include "relief/mesh/threads.h"

namespace relief::tools {
namespace {

struct ProcessOptions {
    ProcessRequest request;
    ReportOptions report;
    GeneralOptions general;
};

/// Refuses what the command line alone shows to be useless.
void check_request(const ProcessOptions& options) {
    readable_format(options.request.input);
    const ModelFormat output = writable_format(options.request.output);
    if (options.request.tangents == TangentMode::mikktspace && !is_document(output)) {
        throw UsageError(fmt::format("--tangents mikktspace: {} cannot hold tangents",
                                     extension_of(options.request.output)),
                         "write .glb or .gltf");
    }
    check(options.report, {options.request.input, options.request.output});
    require_folder_of(options.request.output);
}

ExitCode run(const CLI::App& app, const ProcessOptions& options) {
    check_request(options);
    set_thread_limit(options.general.threads);
    Stages stages(options.general.quiet);
    const Processed done = process(options.request, stages);
    if (!options.general.quiet) print_summary(options.request, done, stages);
    return finish(app, options.report, options.request.input, done.findings,
                  process_json(options.request, done, stages));
}

void add_options(CLI::App& app, ProcessOptions& options) {
    add_file(app, "IN", options.request.input, "Model to read: .glb .gltf .obj .ply .stl .off");
    add_file(app, "OUT", options.request.output,
             "Model to write: .glb .gltf .obj .ply. May be IN itself: it is replaced only once the "
             "new file is complete.");
    add_choice(app, "--normals", options.request.normals, normal_choices(),
               "Where normals come from: the file (keep), one per triangle (flat), or averaged "
               "around each vertex by triangle area or corner angle. Default: keep; a mesh that "
               "has none gets flat ones from glTF, as its rules ask, and angle ones otherwise.")
        ->group("Frames");
    add_choice(app, "--tangents", options.request.tangents, tangent_choices(),
               "Tangents for normal maps: the file's own (keep; computed anew where normals are), "
               "none, or computed as MikkTSpace does, splitting vertices where needed. "
               "Default: keep.")
        ->group("Frames");
    add_report_options(app, options.report);
    add_general_options(app, options.general);
    set_examples(
        app,
        {"relief-mesh process data/vase.obj out/vase.glb --tangents mikktspace",
         "relief-mesh process out/vase.glb out/vase-flat.glb --normals flat",
         "relief-mesh process data/vase.obj out/vase.ply --normals area --report out/vase.json"});
}

}  // namespace

Command add_process_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "process",
        "Gives a model normals and tangents; everything else in a glTF file stays as it is.");
    const auto options = std::make_shared<ProcessOptions>();
    add_options(app, *options);
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
