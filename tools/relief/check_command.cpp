// SPDX-License-Identifier: Apache-2.0
// The command `relief check`: models first, in parallel, then the images that they name or that lie
// in the folders, each once. Tests: tests/check/relief_check_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "check_cache.h"
#include "check_files.h"
#include "check_fix.h"
#include "check_project.h"
#include "check_report.h"
#include "check_rules.h"
#include "check_walk.h"
#include "common/file_jobs.h"
#include "common/options.h"
#include "common/summary.h"
#include "driver.h"
#include "file_replacement.h"
#include "parallel.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/limits.h"

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

void check_options(const CLI::App& app, const CheckCommand& command) {
    if (command.lists_rules) {
        if (!command.paths.empty())
            throw UsageError("--rules: lists the rules and checks nothing", "leave out PATH");
        return;
    }
    if (command.paths.empty()) throw UsageError("PATH: is missing", "give a folder or files");
    if (command.general.quiet && command.format != CheckFormat::text)
        throw UsageError("--format and --quiet contradict each other", "give one of them");
    if (!command.fixes) refuse_given(app, {"--output", "--in-place"}, "--fix");
    if (command.fixes && command.folder.has_value() == command.in_place) {
        throw UsageError("--fix: needs either a folder for copies or --in-place",
                         "give -o FOLDER or --in-place");
    }
    for (const fs::path& file : command.reports) {
        format_of_report(file);
        require_folder_of(file);
    }
    if (command.cache) require_folder_of(*command.cache);
}

/// No output may replace relief.json, or another output. \throws UsageError
void check_outputs(const CheckCommand& command, const CheckProject& project) {
    std::vector<fs::path> others = {project.file};
    if (command.cache) {
        check_distinct("--cache", *command.cache, others);
        others.push_back(*command.cache);
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

/// Returns a text of the limits that change the findings of a file.
std::string limits_key() {
    const InputLimits limits = input_limits();
    return fmt::format("{} {} {}", limits.outside_files, limits.memory, limits.pixels);
}

/// Checks files in parallel, with the cache.
class Checker {
  public:
    explicit Checker(const CheckCommand& command) : stages_(command.general.quiet) {
        if (command.cache) cache_.emplace(*command.cache);
    }

    /// Checks models and images. \return in the order of the walk, then images of other folders
    std::vector<CheckedItem> check(const std::vector<CheckInput>& inputs) {
        std::vector<CheckedItem> items(inputs.size());
        std::vector<std::size_t> models;
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            if (inputs[i].kind == CheckedKind::model) models.push_back(i);
        }
        run("models", models.size(), [&](std::size_t i) {
            const CheckInput& input = inputs[models[i]];
            Json paired = Json::array();
            for (const UsedImage& image : input.paired)
                paired.push_back(image.file.string());
            items[models[i]] =
                cached(input.file, paired.dump(-1, ' ', false, Json::error_handler_t::replace),
                       [&] { return check_model_file(input); });
        });
        check_images(inputs, items);
        return items;
    }

    /// \throws FileError
    void write_cache() const {
        if (cache_) cache_->write();
    }

  private:
    struct ImageTask {
        fs::path file;
        std::vector<ImageRole> roles;
        std::vector<std::size_t> items;  ///< Several for links to one file.
    };

    void check_images(const std::vector<CheckInput>& inputs, std::vector<CheckedItem>& items) {
        std::map<fs::path, ImageTask> tasks;
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            if (inputs[i].kind != CheckedKind::image) continue;
            ImageTask& task = tasks[identity_of(inputs[i].file)];
            if (task.file.empty()) task.file = inputs[i].file;
            task.items.push_back(i);
        }
        for (const CheckedItem& item : items) {
            for (const UsedImage& image : item.images) {
                ImageTask& task = tasks[identity_of(image.file)];
                if (task.file.empty()) task.file = image.file;
                task.roles.push_back(image.role);
            }
        }
        std::vector<ImageTask> list;
        for (auto& [identity, task] : tasks) {
            std::ranges::sort(task.roles);
            task.roles.erase(std::unique(task.roles.begin(), task.roles.end()), task.roles.end());
            if (task.items.empty()) {
                task.items.push_back(items.size());
                items.emplace_back().file = task.file;
            }
            list.push_back(std::move(task));
        }
        run("images", list.size(), [&](std::size_t i) {
            const ImageTask& task = list[i];
            const CheckedItem item = cached(task.file, roles_key(task.roles), [&] {
                return check_image_file(task.file, task.roles);
            });
            for (const std::size_t each : task.items) {
                items[each] = item;
                if (each < inputs.size()) items[each].file = inputs[each].file;
            }
        });
    }

    static std::string roles_key(const std::vector<ImageRole>& roles) {
        const Json json = json_list(roles, [](const ImageRole& role) -> Json {
            return {static_cast<int>(role.slot), role.is_gltf, role.material, role.materials};
        });
        return json.dump(-1, ' ', false, Json::error_handler_t::replace);
    }

    template <typename Work>
    void run(const std::string& name, std::size_t count, const Work& work) {
        stages_.run(name, [&] {
            relief::detail::parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    work(i);
            });
        });
    }

    template <typename Work>
    CheckedItem cached(const fs::path& file, const std::string& key, const Work& work) {
        const std::string whole = limits_key() + " " + key;
        if (cache_) {
            if (auto found = cache_->find(file, whole)) {
                cache_->add(*found, whole);
                return *std::move(found);
            }
        }
        CheckedItem item = work();
        if (cache_) cache_->add(item, whole);
        return item;
    }

    Stages stages_;
    std::optional<CheckCache> cache_;
};

std::map<fs::path, ImageFigures> figures_of(const std::vector<CheckedItem>& items) {
    std::map<fs::path, ImageFigures> images;
    for (const CheckedItem& item : items) {
        if (item.kind == CheckedKind::image && !item.is_unreadable)
            images.emplace(identity_of(item.file), item.image);
    }
    return images;
}

/// Checks all files and applies the project.
CheckResults results_of(const CheckCommand& command, const CheckProject& project,
                        Checker& checker) {
    WalkedFiles walked =
        walk_files(command.paths, [&](const fs::path& path) { return project.excludes(path); });
    CheckResults results;
    results.shows_notes = command.notes;
    results.items = checker.check(walked.files);
    std::ranges::move(walked.findings, std::back_inserter(results.items));
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

ExitCode run(const CLI::App& app, const CheckCommand& command) {
    check_options(app, command);
    if (command.lists_rules) return print_rules(command);
    set_thread_limit(command.general.threads);
    CheckProject project = project_of(command);
    check_outputs(command, project);
    if (command.writes_baseline) project.baseline.clear();
    Checker checker(command);
    CheckResults results = results_of(command, project, checker);
    if (command.writes_baseline) write_baseline(project, results.items);
    if (command.fixes) {
        results.fixes =
            fix_files(results.items, command.in_place ? std::optional<fs::path>() : command.folder);
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
    if (!command.general.quiet) print_text(report_text(results, command.format));
    checker.write_cache();
    return exit_code_of(app, command, results);
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
    add_general_options(app, command.general);
    set_examples(app, {"relief check data", "relief check --rules",
                       "relief check data/vase.obj data/scenes --strict --notes",
                       "relief check data --report out/check.html --report out/check.sarif",
                       "relief check data --cache out/check-cache.json --format json"});
}

}  // namespace

Command add_check_files_command(CLI::App& tool) {
    return add_command<CheckCommand>(
        tool, "check",
        "Checks the models and maps of folders, alone and together, by all rules that relief has.",
        add_options, run);
}

}  // namespace relief::tools
