// SPDX-License-Identifier: Apache-2.0
// `relief-bake heights IN OUT` and `IN... -o DIR/`: options in, make_heights() called for each map,
// report out. Tests: tests/tools/relief_bake_heights_test.cpp.
#include <memory>

#include "commands.h"
#include "heights/heights_job.h"
#include "map_jobs.h"

namespace relief::tools {
namespace {

struct HeightsCommand {
    MapFiles files;
    HeightsRequest request;
};

FileOutcome convert(const Job& job, const HeightsRequest& request, Stages& stages,
                    bool prints_summary) {
    const MadeHeights made = make_heights(job, request, stages);
    if (prints_summary) print_summary(job, made, stages);
    return {line_of(job, made, stages), made.findings, results_json(made, stages)};
}

ExitCode run(const CLI::App& app, const HeightsCommand& command) {
    MapWork work;
    work.head = {{"tool", "relief-bake heights"}, {"version", version()}};
    work.check = [&](const Job& job) {
        bits_of(command.request, job.output);
        refuse_to_replace(job.input, "normal map", job);
    };
    work.work = [&](const Job& job, Stages& stages, bool prints_summary) {
        return convert(job, command.request, stages, prints_summary);
    };
    return run_map_jobs(app, command.files, work);
}

}  // namespace

Command add_heights_command(CLI::App& tool) {
    CLI::App& app =
        add_subcommand(tool, "heights",
                       "Converts tangent-space normal maps to height maps: the opposite of bump.");
    const auto command = std::make_shared<HeightsCommand>();
    add_map_files(app, command->files, "normal map",
                  "Heights are those whose slopes are nearest to the map's, by least squares; how "
                  "much of it no heights can have is said.",
                  "height map");
    add_heights_options(app, command->request);
    add_map_folder(app, command->files);
    add_report_options(app, command->files.report);
    add_general_options(app, command->files.general);
    set_examples(app, {"relief-bake heights data/scenes/bricks-normal.png out/bricks-height.png",
                       "relief-bake heights data/scenes/bricks-normal.png out/bricks-height.exr "
                       "--wrap clamp --kernel sobel3"});
    return {&app, [&app, command] { return run(app, *command); }};
}

}  // namespace relief::tools
