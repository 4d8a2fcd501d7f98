// SPDX-License-Identifier: Apache-2.0
// The command `relief-bake merge`: makes the maps of a bake from the parts of its shards.
// Tests: tests/tools/relief_bake_shards_test.cpp.
#include <fmt/format.h>

#include <memory>

#include "common/file_jobs.h"
#include "common/summary.h"
#include "mesh_shards.h"
#include "relief/mesh/execution.h"

namespace relief::tools {
namespace {

struct MergeOptions {
    std::vector<std::filesystem::path> parts;
    std::optional<std::filesystem::path> output;
    bool keeps_parts = false;
    ReportOptions report;
    GeneralOptions general;
};

void remove_parts(const CLI::App& app, const std::vector<std::unique_ptr<PartFile>>& parts) {
    for (const auto& part : parts) {
        std::error_code error;
        std::filesystem::remove(part->path(), error);
        if (error) warn(app, part->path().string() + ": cannot be removed");
    }
}

ExitCode run(const CLI::App& app, const MergeOptions& options) {
    if (options.parts.empty())
        throw UsageError("PART: is missing", "give the files that relief-bake mesh --shard wrote");
    set_thread_limit(options.general.threads);
    std::vector<std::unique_ptr<PartFile>> parts;
    for (const std::filesystem::path& file : options.parts)
        parts.push_back(std::make_unique<PartFile>(file));
    sort_parts(parts);
    const PartJob& job = parts.front()->part().job;
    MeshArguments arguments{job.arguments, {}};
    arguments.files.assign(job.files.begin(), job.files.end());
    if (options.output && !arguments.files.empty()) arguments.files.back() = *options.output;
    MeshBakeRequest request = parse_mesh_request(arguments);
    check_sharded(request);
    if (options.report.file) {
        check(options.report, options.parts);
        request.report.file = options.report.file;
    }
    request.report.strict |= options.report.strict;
    Stages stages(options.general.quiet);
    const MeshBake bake = merge_parts(request, parts, stages);
    const Summary summary = summary_of(request, bake, stages);
    if (!options.general.quiet) summary.print();
    for (const std::string& warning :
         {shared_texels_warning(request, bake),
          swapped_models_warning(request, bake.high_triangles, bake.low_triangles)}) {
        if (!warning.empty()) warn(app, warning);
    }
    const ExitCode code = finish(app, request.report, request.low,
                                 strict_findings(request, bake.findings), summary.json());
    if (!options.keeps_parts) remove_parts(app, parts);
    return code;
}

void add_options(CLI::App& app, MergeOptions& options) {
    add_files(app, "PART...", options.parts,
              "All parts of one bake, in any order, as relief-bake mesh --shard wrote them. They "
              "are removed when the maps are written.");
    add_path(app, "-o,--output", options.output,
             "Write this map instead of the OUT of the shards. Its other files keep their names.")
        .group("Output");
    add_switch(app, "--keep", options.keeps_parts, "Do not remove the parts.").group("Output");
    add_report_options(app, options.report);
    add_general_options(app, options.general);
    set_examples(app, {"relief-mesh subdivide data/vase.obj out/high.obj --levels 2",
                       "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 128 "
                       "--shard 1/2",
                       "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 128 "
                       "--shard 2/2",
                       "relief-bake merge out/vase-baked.png.*.part"});
}

}  // namespace

Command add_merge_command(CLI::App& tool) {
    return add_command<MergeOptions>(
        tool, "merge", "Makes the maps of a bake from the parts of its shards.", add_options, run);
}

}  // namespace relief::tools
