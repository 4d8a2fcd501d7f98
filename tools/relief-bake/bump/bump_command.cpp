// SPDX-License-Identifier: Apache-2.0
// `relief-bake bump IN OUT` and `IN... -o DIR/`: options in, bake_bump() called for each map,
// report out. A request that could have no effect is refused before anything is read. Tests:
// tests/tools/relief_bake_test.cpp.
#include <memory>

#include "bump/bump_job.h"
#include "bump/bump_summary.h"
#include "commands.h"
#include "common/text.h"
#include "map_jobs.h"

namespace relief::tools {
namespace {

struct BumpCommand {
    MapFiles files;
    BumpRequest request;
};

void check_job(const Job& job, const BumpRequest& request) {
    bump_of(request);
    file_format_of(request, job.output);
    refuse_to_replace(job.input, "height map", job);
}

FileOutcome bake(const Job& job, const BumpRequest& request, Stages& stages, bool prints_summary) {
    const Baked baked = bake_bump(job, request, stages);
    if (prints_summary) print_summary(job, request, baked, stages);
    return {line_of(job, baked, stages), baked.findings, results_json(baked, stages)};
}

ExitCode run(const CLI::App& app, const BumpCommand& command) {
    MapWork work;
    work.head = {{"tool", "relief-bake bump"}, {"version", version()}};
    work.check = [&](const Job& job) { check_job(job, command.request); };
    work.work = [&](const Job& job, Stages& stages, bool prints_summary) {
        return bake(job, command.request, stages, prints_summary);
    };
    return run_map_jobs(app, command.files, work);
}

}  // namespace

Command add_bump_command(CLI::App& tool) {
    CLI::App& app =
        add_subcommand(tool, "bump", "Converts height maps to tangent-space normal maps.");
    const auto command = std::make_shared<BumpCommand>();
    add_map_files(app, command->files, "height map",
                  "Heights are grey, or colour of which the mean counts, in PNG, TIFF, EXR, HDR, "
                  "JPEG, ...");
    add_bump_options(app, command->request);
    add_map_folder(app, command->files);
    add_bump_content_options(app, command->request);
    add_map_output_options(app, command->request.output);
    add_report_options(app, command->files.report);
    add_general_options(app, command->files.general);
    set_examples(
        app,
        {"relief-bake bump data/bricks-height.png out/bricks-normal.png --strength 12",
         "relief-bake bump data/bricks-height.png out/bricks-dx.png --green down --bits 8",
         "relief-bake bump data/bricks-height.png out/bricks.exr --kernel central5 --wrap clamp",
         "relief-bake bump data/bricks-height.png out/bricks.png --compare",
         "relief-bake bump data/bricks-height.png out/bricks.tif --max-error 2",
         "relief-bake bump data/bricks-height.png out/wall.png --height 0.02 --texel-size "
         "0.001",
         "relief-bake bump data/bricks-height.png out/bricks-parallax.png --alpha height",
         "relief-bake bump data/*-height.png -o out/maps/ --strength 8"});
    return {&app, [&app, command] { return run(app, *command); }};
}

}  // namespace relief::tools
