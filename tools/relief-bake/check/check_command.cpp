// SPDX-License-Identifier: Apache-2.0
// `relief-bake check MAPS...`: what images that should be normal maps are, and what is wrong with
// them, as text or JSON. Every file is looked at, whatever is wrong with those before it.
// Tests: tests/tools/relief_bake_check_test.cpp.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "check/map_check.h"
#include "check/surface_check.h"
#include "commands.h"
#include "common/choices.h"
#include "common/options.h"
#include "common/text.h"
#include "relief/mesh/threads.h"

namespace relief::tools {
namespace {

constexpr const char* page = "docs/map-check.md";

struct CheckOptions {
    std::vector<std::filesystem::path> files;
    std::optional<Green> green;
    bool json = false;
    bool strict = false;
    GeneralOptions general;
    SurfaceCheckRequest surface;

    [[nodiscard]] SurfaceCheckRequest surface_of(const std::filesystem::path& file) const {
        SurfaceCheckRequest request = surface;
        request.verify.map = file;
        request.verify.input.green = green;
        return request;
    }
};

/// How many maps are how.
struct Verdicts {
    std::size_t sound = 0;
    std::size_t in_trouble = 0;
    std::size_t unreadable = 0;

    void add(const CheckedMap& map, bool is_on_surface) {
        ++(!map.error.empty() ? unreadable : map.is_sound() && is_on_surface ? sound : in_trouble);
    }
    [[nodiscard]] std::size_t all() const { return sound + in_trouble + unreadable; }
};

void print_verdicts(const Verdicts& verdicts) {
    if (verdicts.all() > 1) {
        print_entry("verdict", fmt::format("{}: {} sound, {} with trouble, {} unreadable",
                                           counted(verdicts.all(), "file"), verdicts.sound,
                                           verdicts.in_trouble, verdicts.unreadable));
    }
    if (verdicts.sound + verdicts.in_trouble > 0)
        print_entry("words", fmt::format("{} says what each comes to", page));
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
    check(app, options.surface, options.files);
    set_thread_limit(options.general.threads);
    const bool to_print = !options.json && !options.general.quiet;
    Stages stages(options.general.quiet);
    Verdicts verdicts;
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (const std::filesystem::path& file : options.files) {
        const CheckedMap map = stages.run("check", "check " + file.string(),
                                          [&] { return check_map(file, options.green); });
        std::optional<SurfaceCheck> surface;
        if (is_wanted(options.surface) && map.error.empty())
            surface = check_surface(app, options.surface_of(file), stages);
        verdicts.add(map, !surface || surface->is_good());
        if (!map.error.empty())
            complain(app, map.error);
        else if (to_print)
            print_text(map);
        if (to_print && surface) print_text(*surface);
        if (options.json) files.push_back(json_of(map));
        if (options.json && surface) files.back()["surface"] = json_of(*surface);
    }
    if (to_print) print_verdicts(verdicts);
    if (options.json) {
        print_json({{"tool", "relief-bake check"},
                    {"version", version()},
                    {"sound", verdicts.sound},
                    {"with_trouble", verdicts.in_trouble},
                    {"unreadable", verdicts.unreadable},
                    {"words", page},
                    {"files", std::move(files)}});
    }
    return judge(app, verdicts, options.strict);
}

}  // namespace

Command add_map_check_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(tool, "check",
                                   "Says whether images are normal maps, what their numbers mean "
                                   "and what is wrong with them.");
    const auto options = std::make_shared<CheckOptions>();
    add_files(app, "MAPS", options->files, "Images to read: PNG, JPEG, TIFF, EXR, ...").required();
    add_surface_check_options(app, options->surface);
    add_choice(app, "--green", options->green, green_choices(),
               "Which way green should grow: it is trouble if the slopes show the other. Default: "
               "what the file says, if it says so.");
    add_switch(
        app, "--json", options->json,
        "Print one JSON object: tool, version, sound, with_trouble and unreadable (numbers of "
        "files), words, files [file, sound, error or: width, height, channels, bits, content, "
        "curve, color_tag, lengths and lengths_uncurved {mean, rms_deviation, within}, green {is, "
        "correlation, deviation, confidence, scale} or null, flat, seams [x, y], bits_used, "
        "alpha_correlation, trouble and remarks [kind, element, count, first, meaning, remedy], "
        "milliseconds, megapixels_per_second, surface {baked, error and centre {rms, mean, p99, "
        "max, texels}, stages {share, rms}, worst, convention, trouble, remedies, ...}].");
    add_switch(
        app, "--strict", options->strict,
        "Exit with 3 if a file has trouble, by itself or on its models. Remarks are no trouble.");
    add_general_options(app, options->general);
    set_examples(app,
                 {"relief-bake check data/scenes/bricks-normal.png",
                  "relief-bake check data/scenes/bricks-normal.png --green up --strict",
                  "relief-mesh subdivide data/vase.obj out/high.obj --levels 2",
                  "relief-bake mesh out/high.obj data/vase.obj out/vase-baked.png --size 256",
                  "relief-bake check out/vase-baked.png --high out/high.obj --low data/vase.obj",
                  "relief-bake check data/bricks-height.png data/scenes/bricks-normal.png --json"});
    return {&app, [&app, options] { return run(app, *options); }};
}

}  // namespace relief::tools
