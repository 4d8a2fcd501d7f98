// SPDX-License-Identifier: Apache-2.0
// The command `relief make`. Tests: tests/tools/relief_make_test.cpp.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/file_jobs.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/shard_choice.h"
#include "common/summary.h"
#include "driver.h"
#include "make_cache.h"
#include "make_index.h"
#include "make_job.h"
#include "make_job_file.h"
#include "make_options.h"
#include "make_page.h"

namespace relief::tools {
namespace {

struct MakeCommand {
    FileWords words;
    std::optional<std::filesystem::path> job_file;
    MakeRequest request;
    std::optional<ShardChoice> shard;
    ReportOptions report;
    GeneralOptions general;
    bool explain = false;
    bool force = false;
    bool no_live_view = false;
};

/// The assets to make.
struct TaskList {
    std::vector<MakeTask> tasks;
    bool is_single = false;
    std::optional<std::filesystem::path> folder;  ///< Of -o.
};

/// \throws UsageError
void check_formats(const Job& job) {
    readable_format(job.input);
    if (!is_document(writable_format(job.output))) {
        throw UsageError(fmt::format("{}: cannot hold the maps of an asset", job.output.string()),
                         "write a .glb or .gltf");
    }
}

/// "models/rock.glb" for models/rock.ply; "models/rock-asset.glb" for models/rock.glb.
std::string output_beside(const std::filesystem::path& input) {
    std::filesystem::path output = input;
    output.replace_extension(extension_for(ModelFormat::glb));
    if (output == input) output.replace_filename(input.stem().string() + "-asset.glb");
    return output.string();
}

TaskList make_tasks_of(const MakeCommand& command) {
    FileWords words = command.words;
    // A plan needs no output.
    if (command.explain && !words.output && words.files.size() == 1)
        words.output = output_beside(words.files.front());
    const JobList list = jobs_of(words, "model", [](const std::filesystem::path& input) {
        readable_format(input);
        return input.filename().replace_extension(extension_for(ModelFormat::glb));
    });
    TaskList tasks{{}, list.is_single(), list.folder};
    for (const Job& job : list.jobs) {
        check_formats(job);
        tasks.tasks.push_back({job, command.request});
    }
    return tasks;
}

/// No file may be written twice, and none may replace an input.
void check_outputs(const MakeCommand& command, const TaskList& list) {
    std::vector<std::filesystem::path> files;
    std::set<std::filesystem::path> inputs, outputs;
    if (command.job_file) {
        inputs.insert(identity_of(*command.job_file));
        files.push_back(*command.job_file);
    }
    for (const MakeTask& task : list.tasks) {
        for (const std::filesystem::path& file : dense_model(task.request, task.job).files) {
            inputs.insert(identity_of(file));
            files.push_back(file);
        }
    }
    for (const MakeTask& task : list.tasks) {
        for (const std::filesystem::path& file : outputs_of(task.request, task.job.output)) {
            if (inputs.contains(identity_of(file)))
                throw UsageError(fmt::format("{}: would replace an input", file.string()),
                                 "choose another output");
            if (!outputs.insert(identity_of(file)).second)
                throw UsageError(fmt::format("{}: is the output of two inputs", file.string()),
                                 "rename one of them");
            files.push_back(file);
        }
    }
    if (list.folder) make_folder(*list.folder);
    if (command.request.stages_folder) make_folder(*command.request.stages_folder);
    check(command.report, files);
    for (const MakeTask& task : list.tasks) {
        if (command.job_file && task.job.output.has_parent_path())
            make_folder(task.job.output.parent_path());
        require_folder_of(task.job.output);
    }
}

/// Returns whether the report is an HTML page.
bool has_page(const ReportOptions& report) {
    return report.file && extension_of(*report.file) == ".html";
}

/// The line that repeats a job, with all options that change the asset.
std::string repeating_line(const MakeRequest& request, const Job& job) {
    std::string line = fmt::format("relief make {} -o {}{}", quoted(job.input), quoted(job.output),
                                   options_line(request));
    if (request.stages_folder)
        line += fmt::format(" --keep-stages {}", quoted(*request.stages_folder));
    if (!request.from.empty()) line += fmt::format(" --from {}", request.from);
    return line;
}

/// Prints the plans of all jobs, and writes them as JSON.
ExitCode explain(const MakeCommand& command, const TaskList& list, Json head) {
    if (has_page(command.report)) {
        throw UsageError(
            fmt::format("--report {}: a plan cannot be a page", command.report.file->string()),
            "write a .json");
    }
    Json plans = Json::array();
    for (const MakeTask& task : list.tasks) {
        const Job& job = task.job;
        SourceFacts facts;
        Findings findings;
        Stages stages(command.general.quiet);
        const make::AssetSource source = stages.run(
            "read", [&] { return read_source(dense_model(task.request, job), facts, findings); });
        const std::vector<PlannedStage> plan =
            plan_of(task.request, source, stages.milliseconds("read") / 1e3);
        const unsigned threads = threads_of(command.general.threads);
        print_entry("plan", fmt::format("{} -> {}", job.input.string(), job.output.string()));
        print_entry("", lines_of(plan, threads));
        plans.push_back({{"input", job.input.string()},
                         {"output", job.output.string()},
                         {"threads", threads},
                         {"stages", plan_json(plan, threads)}});
    }
    head["plans"] = std::move(plans);
    if (command.report.file) write_json(*command.report.file, head);
    return ExitCode::done;
}

ExitCode make_one(const CLI::App& app, const MakeCommand& command, const MakeTask& task,
                  Json head) {
    const auto& [job, request] = task;
    Stages stages(command.general.quiet);
    const MadeAsset made = make_file(request, job, stages);
    ReportOptions report = command.report;
    if (has_page(report)) {
        stages.run("report", [&] {
            write_make_page(*report.file, task.request, task.job, made, stages,
                            repeating_line(task.request, task.job), !command.no_live_view);
        });
        report.file.reset();
    }
    const Summary summary = summary_of(request, job, made, stages);
    if (!command.general.quiet) summary.print();
    head["command"] = repeating_line(request, job);
    head.update(summary.json());
    return finish(app, report, job.input, made.findings, head);
}

/// The caches of the folders of assets.
class MakeCaches {
  public:
    MakeCache& of(const std::filesystem::path& output) {
        return caches_.try_emplace(identity_of(output).parent_path(), output.parent_path())
            .first->second;
    }

  private:
    std::map<std::filesystem::path, MakeCache> caches_;
};

/// The title of the index page.
std::string title_of(const MakeCommand& command, const TaskList& list) {
    if (command.job_file) return command.job_file->filename().string();
    return list.folder ? list.folder->lexically_normal().string() : "Assets";
}

ExitCode make_all(const CLI::App& app, const MakeCommand& command, const TaskList& list,
                  Json head) {
    MakeCaches caches;
    Batch batch;
    for (const MakeTask& task : list.tasks)
        batch.jobs.push_back(task.job);
    batch.one_by_one = true;  // Each asset uses all processors and much memory.
    batch.head = std::move(head);
    std::vector<IndexEntry> entries(list.tasks.size());
    const auto make_job = [&](std::size_t index) -> FileOutcome {
        const auto& [job, request] = list.tasks[index];
        MakeCache& cache = caches.of(job.output);
        const Json options_of_job = options_json(request);
        const std::string options = fmt::format("{} {}", job.input.string(), options_of_job.dump());
        const auto with_options = [&](Summary summary) {
            if (command.job_file) summary.add_json({{"options", options_of_job}});
            return summary;
        };
        if (!command.force && cache.is_current(job.output, options)) {
            entries[index].facts = cache.facts_of(job.output);
            Summary skipped;
            skipped.add_json({{"input", job.input.string()},
                              {"output", job.output.string()},
                              {"unchanged", true}});
            return {fmt::format("{}: unchanged", job.output.string()), {}, with_options(skipped)};
        }
        Stages stages(true);
        const MadeAsset made = make_file(request, job, stages);
        entries[index].facts = index_facts(made);
        cache.add(job.output, options, made.inputs, made.files, entries[index].facts);
        // Shards would overwrite each other's entries.
        if (!command.shard) cache.write();
        return {line_of(job, made, stages), made.findings,
                with_options(summary_of(request, job, made, stages))};
    };
    batch.work = [&](std::size_t index) {
        entries[index].job = list.tasks[index].job;
        try {
            return make_job(index);
        } catch (const std::exception& error) {
            entries[index].error = error.what();
            throw;
        }
    };
    if (!has_page(command.report)) return run_batch(app, batch, command.report, command.general);
    ReportOptions report = command.report;
    report.file.reset();
    const ExitCode code = run_batch(app, batch, report, command.general);
    write_make_index(*command.report.file, title_of(command, list), entries);
    return code;
}

/// \throws UsageError if --from contradicts other options
void check_start(const MakeCommand& command) {
    const MakeRequest& request = command.request;
    if (request.from.empty()) return;
    const std::string option = fmt::format("--from {}", request.from);
    if (!request.stages_folder)
        throw UsageError(option + ": needs files of stages", "give their folder by --keep-stages");
    if (request.limits.any())
        throw UsageError(option + ": limits of the loss need all stages",
                         "leave out --max-error and --max-picture-error");
    if (request.from == "unwrap" && request.asset.keep_texcoords)
        throw UsageError(option + ": --keep-uvs leaves out this stage", "continue at frames");
    if (request.from == "remesh" &&
        (request.asset.keep_texcoords || request.asset.remesh == make::Remeshing::never))
        throw UsageError(option + ": nothing is remeshed", "continue at decimate");
}

/// Reads the job file. \throws UsageError if there are options that it has for each asset
TaskList read_tasks(const CLI::App& app, const MakeCommand& command) {
    const std::filesystem::path& file = *command.job_file;
    if (!command.words.files.empty() || command.words.output) {
        throw UsageError(
            fmt::format("--job {}: names its models and outputs itself", file.string()),
            "leave out FILE and -o");
    }
    refuse_given(app, {"--keep-stages", "--from"}, "a single asset", "leave out --job");
    for (const MakeOption& option : make_options()) {
        const std::string name = fmt::format("--{}", option.name);
        if (is_given(app, name)) {
            throw UsageError(fmt::format("{}: options of assets are in the file of --job", name),
                             "write them into its \"defaults\"");
        }
    }
    TaskList list{read_job_file(file), false, {}};
    for (const MakeTask& task : list.tasks)
        check_formats(task.job);
    return list;
}

ExitCode make(const CLI::App& app, const MakeCommand& command) {
    TaskList list = command.job_file ? read_tasks(app, command) : make_tasks_of(command);
    if (command.request.stages_folder && !list.is_single) {
        throw UsageError(fmt::format("--keep-stages {}: keeps the stages of one asset",
                                     command.request.stages_folder->string()),
                         "make a single asset without an output folder");
    }
    if (!command.request.more_sources.empty() && !list.is_single) {
        throw UsageError(fmt::format("--with {}: is a part of the model of one asset",
                                     command.request.more_sources.front().string()),
                         "make a single asset without an output folder");
    }
    if (!command.job_file) check_asset_options(app, command.request);
    if (command.no_live_view && !(list.is_single && has_page(command.report)))
        throw UsageError("--no-live-view: needs the report page of one asset",
                         "add --report FILE.html, or leave it out");
    check_start(command);
    if (command.shard && list.is_single)
        throw UsageError("--shard: divides several assets", "give an output folder with -o");
    set_thread_limit(command.general.threads);
    if (!command.explain) check_outputs(command, list);
    keep_shard(command.shard, list.tasks);
    Json head = {{"tool", "relief make"}, {"version", version()}};
    if (command.job_file)
        head["job"] = command.job_file->string();
    else
        head["options"] = options_json(command.request);
    if (command.explain) return explain(command, list, head);
    return list.is_single ? make_one(app, command, list.tasks.front(), head)
                          : make_all(app, command, list, head);
}

Choices<std::string> start_choices() {
    return {{"remesh", "remesh"}, {"decimate", "decimate"}, {"unwrap", "unwrap"},
            {"frames", "frames"}, {"bake", "bake"},         {"write", "write"}};
}

void add_make_options(CLI::App& app, MakeCommand& command) {
    add_files(app, "FILE...", command.words.files,
              "IN OUT: the dense model to read (.glb .gltf .obj .ply .stl .off) and the asset to "
              "write (.glb .gltf). With -o: any number of models to read. Skinned and animated "
              "models are refused.");
    const std::string output = "Output";
    add_value(
        app, "-o,--output", "PATH",
        "The output: a folder (with / at the end, or existing), or a file for one model. In a "
        "folder, each model keeps its name, as .glb. If a model fails, the others are still made.",
        [&command](const std::string&, const std::string& text) { command.words.output = text; })
        .group(output);
    add_asset_options(app, command.request);
    add_value(app, "--job", "FILE",
              "Make the assets that a JSON file lists, with options for each of them: "
              "{\"defaults\": {\"size\": 512}, \"assets\": [{\"input\": \"rock.ply\", "
              "\"triangles\": 500}]}. Paths are relative to the file.",
              [&command](const std::string&, const std::string& text) { command.job_file = text; })
        .group(output);
    add_value(app, "--keep-stages", "FOLDER",
              "Also write the mesh after each stage (01-repair.glb, 03-decimate.glb, ...) and the "
              "baked maps as PNG files. Only for one asset.",
              [&command](const std::string&, const std::string& text) {
                  command.request.stages_folder = text;
              })
        .group(output);
    add_choice<std::string>(
        app, "--from", start_choices(),
        "Continue at this stage with the files of --keep-stages, which may have been edited; maps "
        "still show the model. write: with the maps, of which edited ones go into the asset. Files "
        "that are missing or stale are an error.",
        [&command](const std::string& stage) { command.request.from = stage; })
        .group(output);
    add_switch(app, "--force", command.force,
               "In a folder, make all assets again. Otherwise those whose options and files are "
               "unchanged are left as they are, by the file relief-make.json of the folder.")
        .group(output);
    add_shard_option(app, command.shard,
                     "Make only every N-th asset, from the K-th on, so that several machines share "
                     "them: together, shards 1/N to N/N make each asset once. They use "
                     "relief-make.json, but do not write it.");
    add_switch(app, "--explain", command.explain,
               "Print the stages with estimated times, and make nothing. The output need not be "
               "named. --report FILE.json: also write them as JSON.")
        .group(output);
    add_report_options(app, command.report);
    add_switch(app, "--no-live-view", command.no_live_view,
               "Leave the models out of the report page (--report NAME.html), which can be orbited "
               "in it.")
        .group("Report");
    add_general_options(app, command.general);
    set_examples(app,
                 {"relief make data/urn-high.ply out/urn-asset.glb --triangles 2000 --size 512",
                  "relief make data/vase.obj out/vase-asset.glb --remesh always --resolution 64 "
                  "--triangles 500 --size 256",
                  "relief make data/urn-high.ply -o out/urn-asset.glb --size 512 --lods 2 "
                  "--for unreal --report out/urn-asset.html",
                  "relief make data/*.obj -o out/assets/ --triangles 500 --size 256",
                  "relief make --job data/make-job.json --report out/job.html",
                  "relief make data/vase.obj out/vase-kept.glb --size 64 --keep-stages out/stages",
                  "relief make data/vase.obj out/vase-kept.glb --size 128 --keep-stages out/stages "
                  "--from unwrap"});
}

}  // namespace

Command add_make_command(CLI::App& tool) {
    return add_command<MakeCommand>(
        tool, "make",
        "Makes an asset with maps from a dense mesh: decimates, unwraps, bakes, writes and checks.",
        add_make_options, make);
}

}  // namespace relief::tools
