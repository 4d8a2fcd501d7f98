// SPDX-License-Identifier: Apache-2.0
// The commands `relief check` and `relief merge`, which finishes a check of several shards.
// Tests: tests/check/relief_check_test.cpp, check_shards_test.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "check_cache.h"
#include "check_fix.h"
#include "check_part.h"
#include "check_project.h"
#include "check_report.h"
#include "check_rules.h"
#include "check_run.h"
#include "check_walk.h"
#include "common/content_hash.h"
#include "common/file_jobs.h"
#include "common/options.h"
#include "common/shard_choice.h"
#include "common/summary.h"
#include "driver.h"
#include "file_replacement.h"
#include "relief/mesh/execution.h"

namespace relief::tools {
namespace {

namespace fs = std::filesystem;

struct CheckCommand {
    std::vector<fs::path> paths;
    std::optional<fs::path> project;
    CheckFormat format = CheckFormat::text;
    std::vector<fs::path> reports;
    std::optional<fs::path> cache;
    std::optional<fs::path> folder;  ///< Of fixed copies.
    bool lists_rules = false;
    bool notes = false;
    bool strict = false;
    bool fixes = false;
    bool in_place = false;
    bool writes_baseline = false;
    std::optional<ShardChoice> shard;
    std::optional<fs::path> part;
    GeneralOptions general;
};

struct MergeCommand {
    std::vector<fs::path> parts;
    bool keeps_parts = false;
    GeneralOptions general;
};

CheckFormat format_of_report(const fs::path& file) {
    const std::string extension = extension_of(file);
    if (extension == ".json") return CheckFormat::json;
    if (extension == ".sarif") return CheckFormat::sarif;
    if (extension == ".xml") return CheckFormat::junit;
    if (extension == ".html") return CheckFormat::html;
    if (extension == ".txt") return CheckFormat::text;
    throw UsageError(fmt::format("--report {}: {} is not the extension of a report", file.string(),
                                 extension.empty() ? "'': it" : extension),
                     "use .json, .sarif, .xml (JUnit), .html or .txt");
}

/// Returns relief.json of --config, of the only folder that is checked, or of the current folder.
CheckProject project_of(const CheckCommand& command) {
    if (command.project) {
        std::error_code error;
        if (command.writes_baseline && !fs::exists(*command.project, error)) {
            CheckProject project;
            project.file = *command.project;
            project.folder = command.project->parent_path();
            return project;
        }
        return read_check_project(*command.project);
    }
    std::error_code error;
    std::vector<fs::path> candidates = {"relief.json"};
    if (command.paths.size() == 1 && fs::is_directory(command.paths.front(), error))
        candidates.insert(candidates.begin(), command.paths.front() / "relief.json");
    for (const fs::path& file : candidates) {
        if (fs::exists(file, error)) return read_check_project(file);
    }
    CheckProject project;
    project.file = candidates.front();
    project.folder = candidates.front().parent_path();
    return project;
}

/// A file of the tool must not replace a checked one. \throws UsageError
void check_private_file(const std::string& option, const fs::path& file) {
    if (kind_by_name(file)) {
        throw UsageError(
            fmt::format("{} {}: is the name of a model or an image", option, file.string()),
            "give a name with another extension");
    }
    require_folder_of(file);
}

void check_options(const CLI::App& app, const CheckCommand& command) {
    if (command.lists_rules) {
        if (!command.paths.empty())
            throw UsageError("--rules: lists the rules and checks nothing", "leave out PATH");
        return;
    }
    if (command.paths.empty()) throw UsageError("PATH: is missing", "give a folder or files");
    if (command.general.quiet && command.format != CheckFormat::text)
        throw UsageError("--format and --quiet contradict each other", "give one of them");
    if (command.fixes && command.writes_baseline) {
        throw UsageError("--fix, --write-baseline: contradict each other",
                         "store what is left after --fix");
    }
    if (!command.fixes) refuse_given(app, {"--output", "--in-place"}, "--fix");
    if (command.fixes && command.folder.has_value() == command.in_place) {
        throw UsageError("--fix: needs either a folder for copies or --in-place",
                         "give -o FOLDER or --in-place");
    }
    for (const fs::path& file : command.reports) {
        format_of_report(file);
        require_folder_of(file);
    }
    if (command.cache) check_private_file("--cache", *command.cache);
    if (!command.shard) {
        if (command.part) throw UsageError("--part: has no effect without --shard");
    } else if (command.cache) {
        throw UsageError("--cache, --shard: contradict each other", "leave out --cache");
    }
    if (command.part) check_private_file("--part", *command.part);
}

/// No output may replace relief.json, or another output. \throws UsageError
void check_outputs(const CheckCommand& command, const CheckProject& project) {
    std::vector<fs::path> others = {project.file};
    if (command.cache) {
        check_distinct("--cache", *command.cache, others);
        others.push_back(*command.cache);
    }
    if (command.part) {
        check_distinct("--part", *command.part, others);
        others.push_back(*command.part);
    }
    for (const fs::path& file : command.reports) {
        check_distinct("--report", file, others);
        others.push_back(file);
    }
}

ExitCode print_rules(const CheckCommand& command) {
    if (command.format == CheckFormat::json) {
        print_json(json_list(check_rules(), [](const CheckRule& rule) -> Json {
            return {{"rule", rule.id},
                    {"severity", enum_name(rule.severity)},
                    {"title", rule.title},
                    {"cause", rule.cause},
                    {"cost", rule.cost},
                    {"remedy", rule.remedy},
                    {"fixable", rule.is_fixable()}};
        }));
        return ExitCode::done;
    }
    if (command.format != CheckFormat::text)
        throw UsageError("--rules: only as text or JSON", "leave out --format");
    for (const CheckRule& rule : check_rules())
        print_text(fmt::format("{:<32} {:<8} {}\n", rule.id, enum_name(rule.severity), rule.title));
    return ExitCode::done;
}

std::map<fs::path, ImageFigures> figures_of(const std::vector<CheckedItem>& items) {
    std::map<fs::path, ImageFigures> images;
    for (const CheckedItem& item : items) {
        if (item.kind == CheckedKind::image && !item.is_unreadable)
            images.emplace(identity_of(item.file), item.image);
    }
    return images;
}

WalkedFiles walk(const CheckCommand& command, const CheckProject& project) {
    // Fixed copies of an earlier run.
    const fs::path copies = command.folder ? identity_of(*command.folder) : fs::path();
    return walk_files(command.paths, [&](const fs::path& path) {
        return project.excludes(path) || (command.folder && identity_of(path) == copies);
    });
}

/// Checks all files and applies the project.
CheckResults results_of(const CheckCommand& command, const CheckProject& project,
                        const WalkedFiles& walked, const CheckSource& source, Stages& stages) {
    CheckResults results;
    results.shows_notes = command.notes;
    results.items = check_all(walked.files, source, stages);
    std::ranges::copy(walked.findings, std::back_inserter(results.items));
    const auto images = figures_of(results.items);
    for (CheckedItem& item : results.items) {
        const RemovedFindings removed = apply(project, images, item);
        results.suppressed += removed.suppressed;
        results.in_baseline += removed.in_baseline;
        results.from_cache += item.is_from_cache ? std::size_t{1} : std::size_t{0};
    }
    return results;
}

ExitCode exit_code_of(const CLI::App& app, const CheckCommand& command,
                      const CheckResults& results) {
    const std::size_t problems =
        results.count(CheckSeverity::error) + results.count(CheckSeverity::warning);
    const auto failed = std::ranges::count_if(
        results.fixes, [](const CheckFix& fix) { return !fix.error.empty(); });
    const bool is_fault = command.strict && problems > 0 && !command.writes_baseline;
    if (is_fault) {
        warn(app, fmt::format("{} (exit code 3, because of --strict)",
                              counted(problems, "error or warning", "errors or warnings")));
    }
    if (command.writes_baseline) return ExitCode::done;
    if (results.unreadable() > 0 || failed > 0) return ExitCode::failed;
    return is_fault ? ExitCode::fell_back : ExitCode::done;
}

/// Runs fixes and writes the reports.
ExitCode finish(const CLI::App& app, const CheckCommand& command, const CheckProject& project,
                CheckResults& results) {
    if (command.writes_baseline) write_baseline(project, results.items);
    if (command.fixes) {
        results.fixes = fix_files(
            results.items, command.in_place ? std::optional<fs::path>() : command.folder, project);
    }
    for (const fs::path& file : command.reports) {
        const CheckFormat format = format_of_report(file);
        if (format == CheckFormat::html) {
            write_check_page(file, results);
        } else {
            const std::string text = report_text(results, format);
            relief::detail::replace_file(file, std::as_bytes(std::span(text)));
        }
    }
    for (const CheckedItem& item : results.items) {
        for (const CheckFinding& finding : item.findings) {
            if (command.general.quiet && item.is_unreadable &&
                finding.severity == CheckSeverity::error)
                complain(app, printable(fmt::format("{}: {}", item.file.string(), finding.text)));
        }
    }
    for (const CheckFix& fix : results.fixes) {
        if (command.general.quiet && !fix.error.empty())
            complain(app, printable(fmt::format("not fixed {}: {}", fix.file.string(), fix.error)));
    }
    if (!command.general.quiet) print_text(report_text(results, command.format));
    return exit_code_of(app, command, results);
}

// Shards.

/// The facts that all shards share.
PartJob job_of(const CLI::App& app, const CheckCommand& command, const CheckProject& project,
               const WalkedFiles& walked) {
    PartJob job;
    job.version = version_and_commit();
    job.count = command.shard->count;
    job.arguments = shared_options(app);
    for (const fs::path& path : command.paths)
        job.files.push_back(path.string());
    job.inputs = {{project.file.string(), file_hash(project.file)},
                  {"the checked folders", hash_of(walked)}};
    return job;
}

ExitCode run_shard(const CLI::App& app, const CheckCommand& command, const CheckProject& project) {
    const WalkedFiles walked = walk(command, project);
    CheckPart part;
    part.job = job_of(app, command, project, walked);
    part.shard = command.shard->shard;
    if (part.shard == 1) part.walked = walked;
    const fs::path file = command.part.value_or(
        fmt::format("relief-check.{}-{}-of-{}.part", part.job.hash(), part.shard, part.job.count));
    Stages stages(command.general.quiet);
    check_shard(walked, part, stages);
    write_part(file, part);
    // Other formats have the merge's results only.
    if (!command.general.quiet && command.format == CheckFormat::text) {
        print_entry("part", printable(file.string()));
        print_entry("checked", fmt::format("{} and {}", counted(part.models.size(), "model"),
                                           counted(part.images.size(), "image")));
    }
    return ExitCode::done;
}

ExitCode run(const CLI::App& app, const CheckCommand& command) {
    check_options(app, command);
    if (command.lists_rules) return print_rules(command);
    set_thread_limit(command.general.threads);
    CheckProject project = project_of(command);
    check_outputs(command, project);
    if (command.shard) return run_shard(app, command, project);
    if (command.writes_baseline) project.baseline.clear();
    std::optional<CheckCache> cache;
    if (command.cache) cache.emplace(*command.cache);
    Stages stages(command.general.quiet);
    CheckResults results =
        results_of(command, project, walk(command, project), reading_source(cache), stages);
    const ExitCode code = finish(app, command, project, results);
    if (cache) cache->write();
    return code;
}

void add_options(CLI::App& app, CheckCommand& command) {
    add_files(app, "PATH...", command.paths,
              "Folders, with all models (.glb .gltf .obj .ply .stl .off) and images in them and "
              "below, or files. Hidden folders, and links to folders, are left out.");
    const std::string rules = "Rules";
    add_path(app, "--config", command.project,
             "Severities, suppressions, budgets and the baseline. Default: relief.json of the "
             "checked folder, or of the current one. docs/check.md describes it.")
        .group(rules);
    add_switch(app, "--rules", command.lists_rules,
               "List all rules, as text or with --format json, and check nothing.")
        .group(rules);
    add_switch(app, "--write-baseline", command.writes_baseline,
               "Store all errors and warnings as the baseline in relief.json: they are not "
               "reported any more, unless their number grows.")
        .group(rules);
    const std::string output = "Report";
    Choices<CheckFormat> formats = enum_choices<CheckFormat>();
    std::erase_if(formats, [](const auto& one) { return one.second == CheckFormat::html; });
    add_choice(app, "--format", command.format, formats,
               "Of the results on standard output: text, JSON, SARIF 2.1.0, JUnit, or annotations "
               "of GitHub. Default: text.")
        .group(output);
    add_repeatable(app, "--report", "FILE",
                   "Also write the results to FILE: .json, .sarif, .xml (JUnit), .txt, or .html, a "
                   "page with pictures, worst first. May be given several times.",
                   [&command](const std::string&, const std::string& text) {
                       command.reports.emplace_back(text);
                   })
        .group(output);
    add_switch(app, "--notes", command.notes,
               "Show notes, too, which also apply to sound files. Reports always have them.")
        .group(output);
    add_switch(app, "--strict", command.strict,
               "Exit with 3 if there are errors or warnings. A file that cannot be read is exit "
               "code 1 in any case.")
        .group(output);
    add_path(app, "--cache", command.cache,
             "Remember the results in FILE, and check only files that changed. Changed files, "
             "options and versions are noticed.");
    const std::string fix = "Fixes";
    add_switch(app, "--fix", command.fixes,
               "Run the remedies of errors and warnings that are commands: on copies with -o, or "
               "--in-place.")
        .group(fix);
    add_value(app, "-o,--output", "FOLDER", "The folder for fixed copies.",
              [&command](const std::string&, const std::string& text) { command.folder = text; })
        .group(fix);
    add_switch(app, "--in-place", command.in_place, "Replace the files by the fixed ones.")
        .group(fix);
    add_shard_option(app, command.shard,
                     "Check only part K of N of the files, and write the findings as a file for "
                     "relief merge, which makes the reports that the same command without --shard "
                     "would have made.");
    add_path(app, "--part", command.part,
             "The file of the shard. Default: relief-check.JOB-K-of-N.part in the current folder, "
             "where JOB is a hash of inputs and options.")
        .group("Several machines");
    add_general_options(app, command.general);
    set_examples(app, {"relief check data", "relief check --rules",
                       "relief check data/vase.obj data/scenes --strict --notes",
                       "relief check data --report out/check.html --report out/check.sarif",
                       "relief check data --cache out/check-cache.json --format json"});
}

/// Reads the command line of the shards.
CheckCommand parse_check(const PartJob& job) {
    CLI::App app;
    CheckCommand command;
    add_options(app, command);
    try {
        app.parse(std::vector<std::string>(job.arguments.rbegin(), job.arguments.rend()));
    } catch (const CLI::Error& error) {
        throw UsageError(error.what());
    }
    command.paths.assign(job.files.begin(), job.files.end());
    check_options(app, command);
    return command;
}

std::vector<CheckPart> read_parts(const MergeCommand& merge, std::vector<fs::path>& names) {
    std::vector<CheckPart> parts;
    std::vector<PartName> identities;
    for (const fs::path& file : merge.parts)
        parts.push_back(read_check_part(file));
    for (std::size_t i = 0; i < parts.size(); ++i)
        identities.push_back({merge.parts[i], &parts[i].job, parts[i].shard});
    std::vector<CheckPart> sorted;
    for (const std::size_t index : sorted_parts(identities, "check")) {
        names.push_back(merge.parts[index]);
        sorted.push_back(std::move(parts[index]));
    }
    return sorted;
}

ExitCode run_merge(const CLI::App& app, const MergeCommand& merge) {
    if (merge.parts.empty())
        throw UsageError("PART: is missing", "give the files that relief check --shard wrote");
    set_thread_limit(merge.general.threads);
    std::vector<fs::path> names;
    const std::vector<CheckPart> parts = read_parts(merge, names);
    const PartJob& job = parts.front().job;
    CheckCommand command = parse_check(job);
    command.general = merge.general;
    CheckProject project = project_of(command);
    check_outputs(command, project);
    if (job.inputs.empty() || job.inputs.front().second != file_hash(project.file)) {
        throw failure(project.file, "has changed since the shards ran", "repeat all shards");
    }
    if (command.writes_baseline) project.baseline.clear();
    Stages stages(merge.general.quiet);
    CheckResults results =
        results_of(command, project, parts.front().walked, merged_source(parts, names), stages);
    const ExitCode code = finish(app, command, project, results);
    if (merge.keeps_parts || code == ExitCode::failed) return code;
    for (const fs::path& file : names) {
        std::error_code error;
        fs::remove(file, error);
        if (error) warn(app, file.string() + ": cannot be removed");
    }
    return code;
}

void add_merge_options(CLI::App& app, MergeCommand& merge) {
    add_files(app, "PART...", merge.parts,
              "All parts of one check, in any order, as relief check --shard wrote them. They are "
              "removed when the reports are written, unless the exit code is 1.");
    add_switch(app, "--keep", merge.keeps_parts, "Do not remove the parts.").group("Output");
    add_general_options(app, merge.general);
    set_examples(app, {"relief check data --shard 1/2 --report out/check.html",
                       "relief check data --shard 2/2 --report out/check.html",
                       "relief merge relief-check.*.part"});
}

}  // namespace

Command add_merge_check_command(CLI::App& tool) {
    return add_command<MergeCommand>(
        tool, "merge", "Makes the reports of relief check from the parts of its shards.",
        add_merge_options, run_merge);
}

Command add_check_files_command(CLI::App& tool) {
    return add_command<CheckCommand>(
        tool, "check",
        "Checks the models and maps of folders, alone and together, by all rules that relief has.",
        add_options, run);
}

}  // namespace relief::tools
