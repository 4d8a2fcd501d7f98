// SPDX-License-Identifier: Apache-2.0
// `relief-bake convert IN OUT` and `IN... -o DIR/`: options in, convert_map() called for each map,
// report out. Tests: tests/tools/convert_test.cpp.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>

#include "commands.h"
#include "common/text.h"
#include "convert/convert_job.h"
#include "convert/convert_summary.h"
#include "map_jobs.h"

namespace relief::tools {
namespace {

struct ConvertCommand {
    MapFiles files;
    ConvertRequest request;
};

/// Whose result each file is.
using Owners = std::map<std::filesystem::path, std::filesystem::path>;

/// The conversion itself may replace its input, but not the map laid over it; and no level the
/// input, or what becomes of another map.
void check_files(const Job& job, const ConvertRequest& request, Owners& owners) {
    for (const std::filesystem::path& file : files_of(job.output, request.mips)) {
        const Job written{job.input, file};
        if (request.detail.file) refuse_to_replace(*request.detail.file, "detail map", written);
        if (file != job.output) refuse_to_replace(job.input, "normal map", written);
        const auto [known, is_new] = owners.emplace(weakly_canonical(absolute(file)), job.input);
        if (is_new) continue;
        throw UsageError(fmt::format("{} and {}: would both be written to {}",
                                     known->second.string(), job.input.string(), file.string()),
                         "convert them by separate calls, to different folders");
    }
}

void check_job(const Job& job, const ConvertRequest& request, Owners& owners) {
    format_of(request.output, job.output);
    write_options_of(request.output, job.output);
    check_files(job, request, owners);
}

FileOutcome convert(const Job& job, const ConvertRequest& request, Stages& stages,
                    bool prints_summary) {
    const Converted converted = convert_map(job, request, stages);
    if (prints_summary) print_summary(job, converted, stages);
    return {line_of(job, converted, stages), converted.findings, results_json(converted, stages)};
}

ExitCode run(const CLI::App& app, const ConvertCommand& command) {
    check_convert_options(command.request);
    MapWork work;
    work.head = {{"tool", "relief-bake convert"}, {"version", version()}};
    Owners owners;
    work.check = [&](const Job& job) { check_job(job, command.request, owners); };
    work.work = [&](const Job& job, Stages& stages, bool prints_summary) {
        return convert(job, command.request, stages, prints_summary);
    };
    return run_map_jobs(app, command.files, work);
}

}  // namespace

Command add_convert_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "convert", "Converts normal maps: conventions, size, strength, details, mip levels.");
    const auto command = std::make_shared<ConvertCommand>();
    add_map_files(app, command->files, "normal map",
                  "OUT may be IN itself: it is replaced only once the new map is complete. "
                  "Whatever order the options are given in, z comes first, then axes, size, "
                  "slopes, detail, mip levels, codes.");
    add_convert_options(app, command->request);
    add_map_folder(app, command->files);
    add_map_output_options(app, command->request.output, true);
    add_report_options(app, command->files.report);
    add_general_options(app, command->files.general);
    set_examples(app, {"relief-bake bump data/bricks-height.png out/bricks.png",
                       "relief-bake convert out/bricks.png out/bricks-dx.png --flip green",
                       "relief-bake convert out/bricks.png out/bricks8.png --bits 8 --dither "
                       "blue-noise",
                       "relief-bake convert out/bricks.png out/small.png --resize 50% --strength 2",
                       "relief-bake convert out/bricks.png out/fine.png --detail out/small.png "
                       "--detail-repeat 4",
                       "relief-bake convert out/bricks.png out/mips.png --mips "
                       "--roughness-from-variance 0.3"});
    return {&app, [&app, command] { return run(app, *command); }};
}

}  // namespace relief::tools
