// SPDX-License-Identifier: Apache-2.0
// `relief-bake bump IN OUT` and `IN... -o DIR/`: options in, bake_bump() called for each map,
// report out. A request that could have no effect is refused before anything is read. Tests:
// tests/tools/relief_bake_test.cpp.
#include <algorithm>
#include <memory>

#include "bump_job.h"
#include "bump_summary.h"
#include "commands.h"
#include "common/batch.h"
#include "common/text.h"
#include "relief/mesh/threads.h"

namespace relief::tools {
namespace {

struct BumpCommand {
    FileWords words;
    BumpRequest request;
    ReportOptions report;
    GeneralOptions general;
};

/// What can hold a normal map keeps its name; of others only the format changes.
std::filesystem::path name_in_folder(const std::filesystem::path& input) {
    std::filesystem::path name = input.filename();
    return can_hold_normals(name) ? name : name.replace_extension(".png");
}

nlohmann::ordered_json head() {
    return {{"tool", "relief-bake bump"}, {"version", version()}};
}

/// Checks, before anything is read, whatever the command line alone shows to be wrong.
void check(const BumpCommand& command, const JobList& list) {
    bump_of(command.request);
    std::vector<std::filesystem::path> files;
    for (const Job& job : list.jobs) {
        file_format_of(command.request, job.output);
        std::error_code error;
        if (std::filesystem::equivalent(job.input, job.output, error)) {
            throw UsageError(job.output.string() + ": would replace the height map",
                             "write to another folder, or by another name");
        }
        files.insert(files.end(), {job.input, job.output});
    }
    if (list.folder) make_folder(*list.folder);
    check(command.report, files);
    require_folder_of(list.jobs.front().output);
}

ExitCode bake_one(const CLI::App& app, const BumpCommand& command, const Job& job) {
    Stages stages(command.general.quiet);
    const Baked baked = bake_bump(job, command.request, stages);
    if (!command.general.quiet) print_summary(job, command.request, baked, stages);
    nlohmann::ordered_json report = head();
    report["input"] = job.input.string();
    report["output"] = job.output.string();
    report.update(results_json(baked, stages));
    return finish(app, command.report, job.input, baked.findings, report);
}

/// Whether several maps at a time would take a lot of memory: each is worked on by all threads
/// anyway, but for the reading of small ones.
bool are_large(const std::vector<Job>& jobs) {
    constexpr std::uintmax_t large_file = 32'000'000;
    return std::any_of(jobs.begin(), jobs.end(), [](const Job& job) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(job.input, error);
        return !error && size > large_file;
    });
}

ExitCode bake_all(const CLI::App& app, const BumpCommand& command, const JobList& list) {
    Batch batch;
    batch.jobs = list.jobs;
    batch.head = head();
    batch.one_by_one = are_large(list.jobs);
    batch.work = [&](std::size_t index) {
        Stages stages(true);
        const Job& job = list.jobs[index];
        const Baked baked = bake_bump(job, command.request, stages);
        return FileOutcome{line_of(job, baked, stages), baked.findings,
                           results_json(baked, stages)};
    };
    return run_batch(app, batch, command.report, command.general);
}

ExitCode run(const CLI::App& app, const BumpCommand& command) {
    const JobList list = jobs_of(command.words, "map", name_in_folder);
    check(command, list);
    set_thread_limit(command.general.threads);
    return list.is_single() ? bake_one(app, command, list.jobs.front())
                            : bake_all(app, command, list);
}

void add_file_arguments(CLI::App& app, FileWords& words) {
    add_files(app, "FILE...", words.files,
              "IN OUT: the height map to read (PNG, TIFF, EXR, HDR, JPEG, ...: grey, or colour of "
              "which the mean counts) and the normal map to write (.png .tif .exr). With -o: the "
              "height maps to read, any number of them. <UDIM> in a name stands for all tiles that "
              "exist.");
}

void add_output_option(CLI::App& app, FileWords& words) {
    add_value(app, "-o,--output", "PATH",
              "Where to write: a folder, which ends in / or exists, or for one map a file. In a "
              "folder each map keeps its name. One that fails does not stop the others.",
              [&words](const std::string&, const std::string& text) { words.output = text; })
        ->group("Output");
}

}  // namespace

Command add_bump_command(CLI::App& tool) {
    CLI::App& app =
        add_subcommand(tool, "bump", "Converts height maps to tangent-space normal maps.");
    const auto command = std::make_shared<BumpCommand>();
    add_file_arguments(app, command->words);
    add_bump_options(app, command->request);
    add_output_option(app, command->words);
    add_bump_content_options(app, command->request);
    add_map_output_options(app, command->request.output);
    add_report_options(app, command->report);
    add_general_options(app, command->general);
    set_examples(
        app,
        {"relief-bake bump data/bricks-height.png out/bricks-normal.png --strength 12",
         "relief-bake bump data/bricks-height.png out/bricks-dx.png --green down --bits 8",
         "relief-bake bump data/bricks-height.png out/bricks.exr --kernel central5 --wrap clamp",
         "relief-bake bump data/bricks-height.png out/bricks.png --compare",
         "relief-bake bump data/bricks-height.png out/bricks.tif --max-error 0.2",
         "relief-bake bump data/bricks-height.png out/wall.png --height 0.02 --texel-size "
         "0.001",
         "relief-bake bump data/bricks-height.png out/bricks-parallax.png --alpha height",
         "relief-bake bump data/*-height.png -o out/maps/ --strength 8"});
    return {&app, [&app, command] { return run(app, *command); }};
}

}  // namespace relief::tools
