// SPDX-License-Identifier: Apache-2.0
// One map or many. Tests: tests/tools/relief_bake_test.cpp, convert_test.cpp.
#include "map_jobs.h"

#include <fmt/format.h>

#include <algorithm>

#include "map_output.h"
#include "relief/mesh/threads.h"

namespace relief::tools {
namespace {

/// What can hold a normal map keeps its name; of others only the format changes.
std::filesystem::path name_in_folder(const std::filesystem::path& input) {
    std::filesystem::path name = input.filename();
    return can_hold_normals(name) ? name : name.replace_extension(".png");
}

/// Checks, before anything is read, whatever the command line alone shows to be wrong.
void check(const MapFiles& files, const MapWork& work, const JobList& list) {
    std::vector<std::filesystem::path> named;
    for (const Job& job : list.jobs) {
        work.check(job);
        named.insert(named.end(), {job.input, job.output});
    }
    if (list.folder) make_folder(*list.folder);
    check(files.report, named);
    require_folder_of(list.jobs.front().output);
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

ExitCode run_one(const CLI::App& app, const MapFiles& files, const MapWork& work, const Job& job) {
    Stages stages(files.general.quiet);
    const FileOutcome outcome = work.work(job, stages, !files.general.quiet);
    nlohmann::ordered_json report = work.head;
    report["input"] = job.input.string();
    report["output"] = job.output.string();
    report.update(outcome.json);
    return finish(app, files.report, job.input, outcome.findings, report);
}

ExitCode run_all(const CLI::App& app, const MapFiles& files, const MapWork& work,
                 const JobList& list) {
    Batch batch;
    batch.jobs = list.jobs;
    batch.head = work.head;
    batch.one_by_one = are_large(list.jobs);
    batch.work = [&](std::size_t index) {
        Stages stages(true);
        return work.work(list.jobs[index], stages, false);
    };
    return run_batch(app, batch, files.report, files.general);
}

}  // namespace

void add_map_files(CLI::App& app, MapFiles& files, const std::string& inputs,
                   const std::string& details, const std::string& output) {
    add_files(app, "FILE...", files.words.files,
              fmt::format("IN OUT: the {} to read and the {} to write (.png .tif .exr). "
                          "With -o: the {}s to read, any number of them. <UDIM> in a name stands "
                          "for all tiles that exist. {}",
                          inputs, output, inputs, details));
}

void add_map_folder(CLI::App& app, MapFiles& files) {
    add_value(app, "-o,--output", "PATH",
              "Where to write: a folder, which ends in / or exists, or for one map a file. In a "
              "folder each map keeps its name. One that fails does not stop the others.",
              [&files](const std::string&, const std::string& text) { files.words.output = text; })
        .group("Output");
}

void refuse_to_replace(const std::filesystem::path& file, const std::string& kind, const Job& job) {
    std::error_code error;
    if (!std::filesystem::equivalent(file, job.output, error)) return;
    throw UsageError(fmt::format("{}: would replace the {}", job.output.string(), kind),
                     "write to another folder, or by another name");
}

ExitCode run_map_jobs(const CLI::App& app, const MapFiles& files, const MapWork& work) {
    const JobList list = jobs_of(files.words, "map", name_in_folder);
    check(files, work, list);
    set_thread_limit(files.general.threads);
    return list.is_single() ? run_one(app, files, work, list.jobs.front())
                            : run_all(app, files, work, list);
}

}  // namespace relief::tools
