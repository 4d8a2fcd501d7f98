// SPDX-License-Identifier: Apache-2.0
// `relief-mesh check FILES...`: the health of model files, as text or JSON. Every file is looked
// at, whatever is wrong with those before it. Tests: tests/tools/relief_mesh_check_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/text.h"
#include "model_check.h"
#include "relief/mesh/threads.h"

namespace relief::tools {
namespace {

constexpr const char* page = "docs/hard-cases.md";

struct CheckOptions {
    std::vector<std::filesystem::path> files;
    bool json = false;
    bool strict = false;
    bool for_baking = false;
    GeneralOptions general;
};

/// How many files are how.
struct Verdicts {
    std::size_t sound = 0;
    std::size_t in_trouble = 0;
    std::size_t unreadable = 0;

    explicit Verdicts(const std::vector<CheckedModel>& models) {
        for (const CheckedModel& model : models)
            ++(!model.error.empty() ? unreadable : model.is_sound() ? sound : in_trouble);
    }
};

void print_verdicts(const Verdicts& verdicts, std::size_t file_count) {
    if (file_count > 1) {
        print_entry("verdict", fmt::format("{}: {} sound, {} with trouble, {} unreadable",
                                           counted(file_count, "file"), verdicts.sound,
                                           verdicts.in_trouble, verdicts.unreadable));
    }
    if (verdicts.sound + verdicts.in_trouble > 0)
        print_entry("words", fmt::format("{} says what each comes to", page));
}

void print_checks(const std::vector<CheckedModel>& models, const Verdicts& verdicts) {
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (const CheckedModel& model : models)
        files.push_back(json_of(model));
    tools::print_json({{"tool", "relief-mesh check"},
                       {"version", version()},
                       {"sound", verdicts.sound},
                       {"with_trouble", verdicts.in_trouble},
                       {"unreadable", verdicts.unreadable},
                       {"words", page},
                       {"files", std::move(files)}});
}

ExitCode judge(const CLI::App& app, const Verdicts& verdicts, bool strict) {
    if (strict && verdicts.in_trouble > 0) {
        warn(app, fmt::format("{} with trouble (exit code 3, because of --strict)",
                              counted(verdicts.in_trouble, "file")));
    }
    if (verdicts.unreadable > 0) return ExitCode::failed;
    return strict && verdicts.in_trouble > 0 ? ExitCode::fell_back : ExitCode::done;
}

ExitCode run(const CLI::App& app, const CheckOptions& options) {
    if (options.json && options.general.quiet)
        throw UsageError("--json and --quiet contradict each other");
    for (const std::filesystem::path& file : options.files)
        readable_format(file);
    set_thread_limit(options.general.threads);
    const bool to_print = !options.json && !options.general.quiet;
    Stages stages(options.general.quiet);
    std::vector<CheckedModel> models;
    for (const std::filesystem::path& file : options.files) {
        models.push_back(stages.run("check", "check " + file.string(),
                                    [&] { return check_model(file, options.for_baking); }));
        if (!models.back().error.empty())
            complain(app, models.back().error);
        else if (to_print)
            print_text(models.back());
    }
    const Verdicts verdicts(models);
    if (to_print) print_verdicts(verdicts, models.size());
    if (options.json) print_checks(models, verdicts);
    return judge(app, verdicts, options.strict);
}

}  // namespace

Command add_check_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "check",
        "Says how healthy model files are, and by which method their tangents were made.");
    const auto options = std::make_shared<CheckOptions>();
    add_files(app, "FILES", options->files, "Models to read: .glb .gltf .obj .ply .stl .off")
        .required();
    add_switch(
        app, "--json", options->json,
        "Print one JSON object: tool, version, sound, with_trouble and unreadable (numbers "
        "of files), words, files [file, sound, error or: format, trouble and remarks (of reading), "
        "primitives [name, sound, triangles, vertices, size, spacing, overlap_raster, tangents "
        "{basis, variant, nearest, nearest_by_far, same_here, texcoord_set, "
        "texcoord_set_of_material, corners, left_out, "
        "without_direction, stored_bits, tolerance, agreements} or null, "
        "trouble and remarks [kind, element, count, first, outcome]]].");
    add_switch(app, "--strict", options->strict,
               "Exit with 3 if a file has trouble. Remarks are no trouble.");
    add_switch(app, "--for-baking", options->for_baking,
               "Maps are to be baked onto the models: overlapping texture is trouble then, and so "
               "is texture without gradient, whatever the materials say.");
    add_general_options(app, options->general);
    set_examples(app, {"relief-mesh check data/vase.obj data/scenes/pot.glb",
                       "relief-mesh check data/scenes/knot.glb --for-baking --strict",
                       "relief-mesh check data/vase.obj --strict --json"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
