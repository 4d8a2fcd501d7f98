// SPDX-License-Identifier: Apache-2.0
// `relief-bake mesh HIGH... LOW OUT`: options in, bake_map(), report out. What the command line
// alone shows to be wrong is refused before anything is read.
// Tests: tests/tools/relief_bake_mesh_test.cpp.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "common/options.h"
#include "common/report_options.h"
#include "mesh/mesh_summary.h"
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

ExitCode run(const CLI::App& app, MeshCommand& command) {
    check(command);
    set_thread_limit(command.general.threads);
    Stages stages(command.general.quiet);
    const MeshBake baked = bake_maps(command.request, stages);
    if (!command.general.quiet) print_summary(command.request, baked, stages);
    const std::string remedy = remedy_for_shared_texels(command.request, baked);
    if (!remedy.empty()) warn(app, remedy);
    nlohmann::ordered_json report = {{"tool", "relief-bake mesh"}, {"version", version()}};
    report.update(results_json(command.request, baked, stages));
    return finish(app, command.request.report, command.request.low, baked.findings, report);
}

}  // namespace

Command add_mesh_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "mesh", "Bakes the normals of detailed models into a map for a simple one.");
    const auto command = std::make_shared<MeshCommand>();
    add_mesh_options(app, command->request, command->files);
    add_report_options(app, command->request.report);
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
