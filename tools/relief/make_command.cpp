// SPDX-License-Identifier: Apache-2.0
// The command `relief make`. Tests: tests/tools/relief_make_test.cpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/error_bound.h"
#include "common/file_jobs.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/summary.h"
#include "common/view_direction.h"
#include "driver.h"
#include "make_cache.h"
#include "make_index.h"
#include "make_job.h"
#include "make_job_file.h"
#include "make_page.h"

namespace relief::tools {
namespace {

struct MakeCommand {
    FileWords words;
    std::optional<std::filesystem::path> job_file;
    MakeRequest request;
    ReportOptions report;
    GeneralOptions general;
    bool explain = false;
    bool force = false;
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

TaskList make_tasks_of(const MakeCommand& command) {
    const JobList list = jobs_of(command.words, "model", [](const std::filesystem::path& input) {
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
        for (const std::filesystem::path& file : sources_of(task.request, task.job)) {
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

Json options_json(const MakeRequest& request) {
    const make::AssetOptions& asset = request.asset;
    Json json = {{"repair", asset.repair.has_value()},
                 {"remesh", enum_name(asset.remesh)},
                 {"resolution", asset.resolution},
                 {"shell", asset.shell},
                 {"triangles", asset.triangles},
                 {"size", {asset.size.x, asset.size.y}},
                 {"padding", asset.padding},
                 {"keep_uvs", asset.keep_texcoords},
                 {"samples", asset.samples},
                 {"occlusion_rays", asset.occlusion ? asset.occlusion_rays : 0},
                 {"lods", asset.levels},
                 {"for", enum_name(request.engine)}};
    json["layers"] =
        json_list(asset.layers, [](LayerKind kind) -> Json { return make::layer_name(kind); });
    json["with"] = json_list(request.more_sources, [](const std::filesystem::path& file) -> Json {
        return file.string();
    });
    json["normal_bits"] = asset.normal_bits;
    json["loss"] = request.measures_loss;
    json["views"] = json_list(request.more_views, [](const glm::vec3& view) -> Json {
        return {view.x, view.y, view.z};
    });
    json["max_error"] = or_null(request.limits.normals.degrees);
    json["max_error_kind"] = enum_name(request.limits.normals.statistic());
    json["max_picture_error"] = or_null(request.limits.flip);
    json["crease"] = nullptr;
    if (asset.crease_angle) json["crease"] = *asset.crease_angle * 180.0 / std::numbers::pi;
    return json;
}

/// Returns whether the report is an HTML page.
bool has_page(const ReportOptions& report) {
    return report.file && extension_of(*report.file) == ".html";
}

/// "height,curvature"
std::string names_of_layers(const std::vector<LayerKind>& layers) {
    std::vector<std::string> names;
    for (const LayerKind kind : layers)
        names.push_back(make::layer_name(kind));
    return fmt::format("{}", fmt::join(names, ","));
}

/// Returns whether the options of remeshing have an effect.
bool can_remesh(const make::AssetOptions& asset) {
    return asset.remesh != make::Remeshing::never && !asset.keep_texcoords;
}

/// The line that repeats a job, with all options that change the asset.
std::string repeating_line(const MakeRequest& request, const Job& job) {
    const make::AssetOptions& asset = request.asset;
    std::string line = fmt::format(
        "relief make {} -o {} --triangles {} --size {}x{} --padding {} --crease {}",
        quoted(job.input), quoted(job.output), asset.triangles, asset.size.x, asset.size.y,
        asset.padding,
        asset.crease_angle ? fmt::format("{:.6g}", *asset.crease_angle * 180.0 / std::numbers::pi)
                           : "none");
    if (!asset.repair) line += " --no-repair";
    line += fmt::format(" --remesh {}", enum_name(asset.remesh));
    if (can_remesh(asset)) {
        line += fmt::format(" --resolution {}", asset.resolution);
        if (asset.shell) line += " --shell";
    }
    if (asset.keep_texcoords) line += " --keep-uvs";
    for (const std::filesystem::path& file : request.more_sources)
        line += " --with " + quoted(file);
    if (!asset.layers.empty()) line += " --layers " + names_of_layers(asset.layers);
    if (asset.normal_bits != 8) line += fmt::format(" --normal-bits {}", asset.normal_bits);
    if (request.stages_folder)
        line += fmt::format(" --keep-stages {}", quoted(*request.stages_folder));
    if (!request.from.empty()) line += fmt::format(" --from {}", request.from);
    if (request.measures_loss) line += " --loss";
    for (const glm::vec3& view : request.more_views)
        line += " --view " + view_text(view);
    const LossLimits& limits = request.limits;
    if (limits.normals.degrees) line += fmt::format(" --max-error {}", *limits.normals.degrees);
    if (limits.normals.kind)
        line += fmt::format(" --max-error-kind {}", enum_name(*limits.normals.kind));
    if (limits.flip) line += fmt::format(" --max-picture-error {}", *limits.flip);
    line += fmt::format(" --samples {} --occlusion-rays {} --lods {} --for {}", asset.samples,
                        asset.occlusion ? asset.occlusion_rays : 0, asset.levels,
                        enum_name(request.engine));
    return line;
}

/// Prints the plans of all jobs.
ExitCode explain(const MakeCommand& command, const TaskList& list) {
    for (const MakeTask& task : list.tasks) {
        const Job& job = task.job;
        SourceFacts facts;
        Findings findings;
        Stages stages(command.general.quiet);
        const make::AssetSource source = stages.run(
            "read", [&] { return read_source(sources_of(task.request, job), facts, findings); });
        print_entry("plan", fmt::format("{} -> {}", job.input.string(), job.output.string()));
        print_entry("", lines_of(plan_of(task.request, source), command.general.threads));
    }
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
                            repeating_line(task.request, task.job));
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
        cache.write();
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

/// \throws UsageError if options of an asset have no effect or contradict others
void check_asset_options(const CLI::App& app, const MakeRequest& request) {
    const make::AssetOptions& asset = request.asset;
    if (asset.keep_texcoords && asset.remesh == make::Remeshing::always) {
        throw UsageError("--remesh always and --keep-uvs contradict each other",
                         "a closed surface needs new texture coordinates");
    }
    if (!request.more_views.empty() && !request.measures_loss && !request.limits.any()) {
        throw UsageError("--view: has no effect, because no loss is measured",
                         "add --loss or a limit of it");
    }
    if (can_remesh(asset)) return;
    for (const char* option : {"--resolution", "--shell"}) {
        if (is_given(app, option)) {
            throw UsageError(fmt::format("{}: has no effect, because nothing is remeshed", option),
                             "leave it out");
        }
    }
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
}

void add_asset_options(CLI::App& app, MakeRequest& request);

/// Reads the job file. \throws UsageError if there are options that it has for each asset
TaskList read_tasks(const CLI::App& app, const MakeCommand& command) {
    const std::filesystem::path& file = *command.job_file;
    if (!command.words.files.empty() || command.words.output) {
        throw UsageError(
            fmt::format("--job {}: names its models and outputs itself", file.string()),
            "leave out FILE and -o");
    }
    refuse_given(app, {"--keep-stages", "--from"}, "a single asset", "leave out --job");
    CLI::App options;
    MakeRequest unused;
    add_asset_options(options, unused);
    for (const CLI::Option* option : options.get_options()) {
        const std::string name = option->get_name();
        if (name != "--help" && is_given(app, name)) {
            throw UsageError(fmt::format("{}: options of assets are in the file of --job", name),
                             "write them into its \"defaults\"");
        }
    }
    TaskList list{read_job_file(file, add_asset_options, check_asset_options), false, {}};
    for (const MakeTask& task : list.tasks)
        check_formats(task.job);
    return list;
}

ExitCode make(const CLI::App& app, const MakeCommand& command) {
    const TaskList list = command.job_file ? read_tasks(app, command) : make_tasks_of(command);
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
    check_start(command);
    set_thread_limit(command.general.threads);
    if (command.explain) return explain(command, list);
    check_outputs(command, list);
    Json head = {{"tool", "relief make"}, {"version", version()}};
    if (command.job_file)
        head["job"] = command.job_file->string();
    else
        head["options"] = options_json(command.request);
    return list.is_single ? make_one(app, command, list.tasks.front(), head)
                          : make_all(app, command, list, head);
}

/// Parses "height,curvature".
std::vector<LayerKind> parse_layers(const std::string& subject, const std::string& text) {
    const Choices<LayerKind> choices = {{"height", LayerKind::height},
                                        {"curvature", LayerKind::curvature},
                                        {"position", LayerKind::position}};
    std::vector<LayerKind> layers;
    std::istringstream names(text);
    for (std::string name; std::getline(names, name, ',');) {
        const auto kind = parse_choice<LayerKind>(subject, name, choices);
        if (std::ranges::find(layers, kind) != layers.end())
            throw UsageError(fmt::format("{}: {} is named twice", subject, name));
        layers.push_back(kind);
    }
    if (layers.empty()) throw UsageError(subject + ": names no layer");
    return layers;
}

/// Parses "2048" or "2048x1024".
glm::ivec2 parse_map_size(const std::string& subject, const std::string& text) {
    if (text.find('x') != std::string::npos) return parse_size(subject, text);
    return glm::ivec2(parse_integer(subject, text, 16, 16384));
}

Choices<std::string> start_choices() {
    return {{"decimate", "decimate"}, {"unwrap", "unwrap"}, {"frames", "frames"}, {"bake", "bake"}};
}

/// Adds the options that each asset of a job file can have.
void add_asset_options(CLI::App& app, MakeRequest& request) {
    make::AssetOptions& asset = request.asset;
    const std::string shape = "Shape";
    add_value(app, "--triangles", "N", "The number of triangles of the asset. Default: 5000.",
              [&asset](const std::string& subject, const std::string& text) {
                  asset.triangles = static_cast<std::size_t>(
                      parse_integer(subject, text, 1, std::numeric_limits<int>::max()));
              })
        .group(shape);
    add_value(app, "--crease", "DEGREES",
              "Edges with a larger angle between their triangles are hard: normals differ on both "
              "sides, and charts end there. none: all edges are smooth. Default: 60.",
              [&asset](const std::string& subject, const std::string& text) {
                  if (text == "none") {
                      asset.crease_angle.reset();
                      return;
                  }
                  asset.crease_angle =
                      parse_number(subject, text, {0.0, 180.0, "degrees"}) * std::numbers::pi / 180;
              })
        .group(shape);
    add_value(app, "--lods", "N",
              "The number of levels of detail below the asset, 0 to 16. Each has half the "
              "triangles of the one before, and the same maps. Default: 0.",
              [&asset](const std::string& subject, const std::string& text) {
                  asset.levels = static_cast<std::size_t>(parse_integer(subject, text, 0, 16));
              })
        .group(shape);
    add_switch(
        app, "--no-repair",
        "Keep the triangles as they are, apart from those without an area or finite positions. "
        "Otherwise equal vertices are merged, repeated triangles removed, parts oriented "
        "outwards and non-manifold edges cut (relief-mesh repair).",
        [&asset] { asset.repair.reset(); })
        .group(shape);
    add_choice(app, "--remesh", asset.remesh, enum_choices<make::Remeshing>(),
               "Replace the triangles by a closed surface before they are decimated "
               "(relief-mesh remesh): always; never; or if one of four printed figures exceeds its "
               "limit and the surface is near enough (auto). Maps still show the model. Default: "
               "auto.")
        .group(shape);
    add_value(app, "--resolution", "N",
              "The number of cells of --remesh along the longest side, 8 to 1024. Default: 256.",
              [&asset](const std::string& subject, const std::string& text) {
                  asset.resolution = parse_integer(subject, text, 8, 1024);
              })
        .group(shape);
    add_switch(app, "--shell", asset.shell,
               "With --remesh, everything within 0.75 cells of a triangle is solid, so that open "
               "surfaces become shells 1.5 cells thick. Default: only what triangles enclose is "
               "solid, and sheets vanish.")
        .group(shape);
    const std::string maps = "Maps";
    add_value(app, "--size", "N|WxH", "The size of the maps in texels. Default: 2048.",
              [&asset](const std::string& subject, const std::string& text) {
                  asset.size = parse_map_size(subject, text);
              })
        .group(maps);
    add_value(app, "--padding", "N",
              "The distance of charts in texels, and the width of the padding around them, 0 to "
              "256. Default: 8.",
              [&asset](const std::string& subject, const std::string& text) {
                  asset.padding = parse_integer(subject, text, 0, 256);
              })
        .group(maps);
    add_switch(app, "--keep-uvs", asset.keep_texcoords,
               "Keep the texture coordinates of the model instead of computing new ones. They must "
               "not overlap.")
        .group(maps);
    add_choice<int>(app, "--normal-bits", {{"8", 8}, {"16", 16}},
                    "The bits of the normal map. Few programs read more than 8 from glTF files. "
                    "Default: 8, and 16 if --max-error needs them.",
                    [&asset](int bits) { asset.normal_bits = bits; })
        .group(maps);
    add_value(app, "--samples", "N",
              "The rays of a texel for normals and colors: 1, 4, 16 or 64. Default: 1.",
              [&asset](const std::string& subject, const std::string& text) {
                  asset.samples = parse_choice<int>(subject, text,
                                                    {{"1", 1}, {"4", 4}, {"16", 16}, {"64", 64}});
              })
        .group(maps);
    add_value(app, "--occlusion-rays", "N",
              "The rays of a texel of the occlusion map, which has a quarter of their size, 0 "
              "to 4096. 0: there is no occlusion map. Default: 32.",
              [&asset](const std::string& subject, const std::string& text) {
                  asset.occlusion_rays = parse_integer(subject, text, 0, 4096);
                  asset.occlusion = asset.occlusion_rays > 0;
              })
        .group(maps);
    add_value(app, "--layers", "NAMES",
              "Also write further layers, from the same rays, as PNG files of 16 bits beside the "
              "asset: height (of the model above the asset), curvature, position; several are "
              "separated by commas.",
              [&asset](const std::string& subject, const std::string& text) {
                  asset.layers = parse_layers(subject, text);
              })
        .group(maps);
    const std::string output = "Output";
    add_choice(app, "--for", request.engine, enum_choices<Engine>(),
               "The engine. unity and unreal: also write maps as PNG files beside the asset, with "
               "the names, channels and green of the engine. Default: gltf.")
        .group(output);
    add_switch(
        app, "--loss", request.measures_loss,
        "Measure what was lost: differences of pictures (FLIP) with three lights, degrees "
        "between normals and pixels between silhouettes, in 12 views, after each stage, and "
        "distances between the surfaces. Needs OpenGL, also without a GPU. With --report "
        "NAME.html, the report is a page with pictures of the "
        "source and the asset, also without --loss; for a folder, an index with a picture of "
        "each asset, worst first.")
        .group(output);
    add_view_option(app, request.more_views).group(output);
    LossLimits& limits = request.limits;
    add_error_bound(app, limits.normals, output,
                    "The largest angle between normals of the source and the asset, which 99 % of "
                    "the pixels of --loss do not exceed. The asset gets more triangles, up to "
                    "those of the source, larger maps, up to 8192, or normals of 16 bits, from "
                    "--triangles and --size on, in at most 6 attempts. If the limit does not hold "
                    "then, nothing is written.");
    add_number(app, "--max-picture-error", "FLIP", limits.flip, {1e-4, 1.0, ""},
               "The same for the largest mean FLIP of the three lights. Both limits can be given.")
        .group(output);
}

void add_make_options(CLI::App& app, MakeCommand& command) {
    add_files(app, "FILE...", command.words.files,
              "IN OUT: the dense model to read (.glb .gltf .obj .ply .stl .off) and the asset to "
              "write (.glb .gltf). With -o: any number of models to read. Skinned and animated "
              "models are refused.");
    add_repeatable(
        app, "--with", "FILE",
        "A further file of the dense model, in the same space as IN. Can be repeated. Only "
        "for one asset.",
        [&command](const std::string&, const std::string& text) {
            readable_format(text);
            command.request.more_sources.emplace_back(text);
        })
        .group("Source");
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
        "still show the model. Files that are missing or stale are an error.",
        [&command](const std::string& stage) { command.request.from = stage; })
        .group(output);
    add_switch(app, "--force", command.force,
               "In a folder, make all assets again. Otherwise those whose options and files are "
               "unchanged are left as they are, by the file relief-make.json of the folder.")
        .group(output);
    add_switch(app, "--explain", command.explain,
               "Print the stages with estimated times, and make nothing.")
        .group(output);
    add_report_options(app, command.report);
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
