// SPDX-License-Identifier: Apache-2.0
// `relief-bake mesh HIGH... LOW OUT`: options in, bake_map(), report out. What the command line
// alone shows to be wrong is refused before anything is read.
// Tests: tests/tools/relief_bake_mesh_test.cpp.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "common/findings.h"
#include "common/options.h"
#include "mesh/mesh_summary.h"
#include "mesh/model_fit.h"
#include "relief/mesh/threads.h"

namespace relief::tools {
namespace {

struct MeshCommand {
    std::vector<std::filesystem::path> files;
    MeshBakeRequest request;
    GeneralOptions general;
};

void check(MeshCommand& command) {
    check_mesh_options(command.request, command.files);
    std::vector<std::filesystem::path> files = command.files;
    if (command.request.cage) files.push_back(*command.request.cage);
    for (const auto& [kind, file] : command.request.layers.files)
        files.push_back(file);
    check(command.request.report, files);
    if (command.request.report.file) files.push_back(*command.request.report.file);
    check(command.request.preview, files);
    if (command.request.preview.file) files.push_back(*command.request.preview.file);
    check_verify(command.request, files);
    require_folder_of(command.request.output);
    for (const auto& [kind, file] : command.request.layers.files)
        require_folder_of(file);
}

/// The findings that make --strict exit with 3: all but those that are intended, or that an option
/// puts a limit to.
Findings strict_findings(const MeshBakeRequest& request, const Findings& findings) {
    Findings strict;
    for (const PlacedFinding& placed : findings.all()) {
        const std::string& kind = placed.finding.kind;
        const bool is_intended = kind == "texel of mirrored triangles";
        const bool is_limited =
            (kind == "texel missed by its rays" && request.max_missed) ||
            (kind == "normal behind the surface" && request.accuracy.bound.degrees);
        if (is_intended || is_limited) continue;
        Report report;
        report.add(placed.finding);
        strict.add(placed.where, report);
    }
    return strict;
}

ExitCode run(const CLI::App& app, MeshCommand& command) {
    check(command);
    set_thread_limit(command.general.threads);
    Stages stages(command.general.quiet);
    const MeshBake baked = bake_maps(command.request, stages);
    if (!command.general.quiet) print_summary(command.request, baked, stages);
    const std::string remedy = remedy_for_shared_texels(command.request, baked);
    if (!remedy.empty()) warn(app, remedy);
    const std::string swapped =
        words_of_swapped_models(command.request, baked.high_triangles, baked.low_triangles);
    if (!swapped.empty()) warn(app, swapped);
    nlohmann::ordered_json report = {{"tool", "relief-bake mesh"}, {"version", version()}};
    report.update(results_json(command.request, baked, stages));
    return finish(app, command.request.report, command.request.low,
                  strict_findings(command.request, baked.findings), report);
}

}  // namespace

Command add_mesh_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "mesh", "Bakes the normals of detailed models into a map for a simple one.");
    const auto command = std::make_shared<MeshCommand>();
    add_mesh_options(app, command->request, command->files);
    add_report_options(
        app, command->request.report,
        "Exit with 3 if there is a finding, but for texels of mirrored triangles; for missed "
        "texels "
        "if --max-missed is given; and for normals behind the surface if --max-error is given. The "
        "map is written all the same.");
    add_general_options(app, command->general);
    set_examples(
        app,
        {"relief-mesh subdivide data/vase.obj out/high.obj --levels 2",
         "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 512 "
         "--preview out/vase-preview.png",
         "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 256 --verify",
         "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 128 --max-error 1",
         "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 64 --compare",
         "relief-bake mesh out/high.obj data/vase.obj 'out/<material>-<UDIM>.png'"});
    return {&app, [&app, command] { return run(app, *command); }};
}

}  // namespace relief::tools
