// SPDX-License-Identifier: Apache-2.0
// `relief-accuracy own FILE...`: experiments on one's own data, with what to take.
// Tests: tests/tools/accuracy_own_test.cpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "commands.h"
#include "common/console.h"
#include "common/map_choices.h"
#include "common/quoted.h"
#include "common/text.h"
#include "experiment_options.h"
#include "own/own_inputs.h"
#include "report_table.h"

namespace relief::tools {
namespace {

/// Which error a bound is for.
enum class BoundKind { rms, p99, max };

struct OwnCommandOptions {
    OwnRequest request;
    std::optional<double> max_error;
    std::optional<BoundKind> max_error_kind;
    std::optional<double> max_milliseconds;
    ExperimentOptions how;
};

/// More rows than this are a wall: those not worth their time are left to the report.
constexpr std::size_t most_rows = 24;

double ErrorFigures::*figure_of(BoundKind kind) {
    switch (kind) {
        case BoundKind::p99:
            return &ErrorFigures::p99;
        case BoundKind::max:
            return &ErrorFigures::max;
        case BoundKind::rms:
            break;
    }
    return &ErrorFigures::rms;
}

void check(const OwnCommandOptions& options) {
    check(options.how);
    if (options.max_error_kind && !options.max_error)
        throw UsageError("--max-error-kind: is for --max-error", "give --max-error DEG");
    if (options.how.no_times && options.max_milliseconds)
        throw UsageError("--no-times and --max-time contradict each other");
}

std::string command_for(const OwnCommandOptions& options) {
    std::string command = "relief-accuracy own";
    for (const std::filesystem::path& file : options.request.files)
        command += " " + quoted(file);
    command += words_of(options.request);
    if (options.max_error) command += fmt::format(" --max-error {:g}", *options.max_error);
    if (options.max_error_kind) {
        constexpr std::array words = {"rms", "p99", "max"};
        command += fmt::format(" --max-error-kind {}",
                               words.at(static_cast<std::size_t>(*options.max_error_kind)));
    }
    if (options.max_milliseconds)
        command += fmt::format(" --max-time {:g}", *options.max_milliseconds);
    return command + effort_words(options.how);
}

/// What a terminal shows of an experiment of many methods.
std::string short_table(const OwnExperiment& own) {
    Experiment shown = own.experiment;
    const std::size_t all = shown.measurements.size();
    if (all <= most_rows) return table_of(shown);
    std::vector<Measurement> rows;
    for (std::size_t i = 0; i < all; ++i) {
        const bool is_taken = own.recommendation.method == i || own.recommendation.next == i;
        if (is_taken || shown.measurements[i].is_efficient)
            rows.push_back(std::move(shown.measurements[i]));
    }
    shown.input +=
        fmt::format(" (of {} methods those worth their time; all are in the report)", all);
    shown.measurements = std::move(rows);
    return table_of(shown);
}

/// Returns the findings on an input, from its first experiment, because all share the input.
std::vector<std::string> findings_of(const std::vector<OwnExperiment>& found) {
    if (found.empty() || found.front().experiment.input_findings.empty()) return {"none"};
    return found.front().experiment.input_findings;
}

OwnOptions own_options(const OwnCommandOptions& options, Stages& stages) {
    OwnOptions own;
    own.run = run_options(options.how);
    own.run.tell = [&stages](const std::string& title, std::size_t, std::size_t) {
        stages.show_progress(title, 0.0);
    };
    own.command = command_for(options);
    own.wish.max_error = options.max_error;
    own.wish.figure = figure_of(options.max_error_kind.value_or(BoundKind::rms));
    if (options.max_milliseconds) own.wish.max_seconds = 1e-3 * *options.max_milliseconds;
    return own;
}

ExitCode run(const OwnCommandOptions& options) {
    check(options);
    const std::vector<OwnInput> inputs = inputs_of(options.request);
    prepare(options.how);
    Stages stages(options.how.general.quiet);
    const OwnOptions own = own_options(options, stages);
    AccuracyReport report;
    report.command = own.command;
    bool keeps_wish = true;
    for (const OwnInput& input : inputs) {
        std::string taken;
        std::vector<OwnExperiment> found = measure(input, options.request, own, taken);
        stages.clear_progress();
        if (prints_tables(options.how)) {
            print_entry("input", input.file.string() + ": " + taken);
            print_entry("findings", findings_of(found));
        }
        for (OwnExperiment& one : found) {
            if (prints_tables(options.how)) fmt::print(out(), "\n{}", short_table(one));
            keeps_wish = keeps_wish && one.recommendation.method.has_value();
            report.experiments.push_back(std::move(one.experiment));
        }
        if (prints_tables(options.how)) fmt::print(out(), "\n");
        std::fflush(out());
    }
    hand_over(options.how, std::move(report), false);
    const bool has_wish = options.max_error || options.max_milliseconds;
    return has_wish && !keeps_wish ? ExitCode::failed : ExitCode::done;
}

void add_input_options(CLI::App& app, OwnRequest& request) {
    add_files(
        app, "FILE...", request.files,
        "Meshes (.glb .gltf .obj .ply .stl .off), height maps and normal maps. Two meshes are "
        "two, not a pair.");
    const char* pair = "A pair: what a map baked from one mesh for the other errs";
    add_path(app, "--high", request.high, "The detailed mesh.").group(pair);
    add_path(app, "--low", request.low, "The simple one, with texture coordinates.").group(pair);
    add_value(app, "--size", "N", "Of the map, texels along each side. Default: 256.",
              [&](const std::string& subject, const std::string& text) {
                  request.size = parse_integer(subject, text, 16, 16384);
              })
        .group(pair);
    const char* mesh = "Meshes";
    const Choices<NormalTruth> truths = {{"surface", NormalTruth::surface},
                                         {"file", NormalTruth::file}};
    add_choice(app, "--truth", request.truth, truths,
               "What normals are compared with: a smooth surface fitted through the vertices, or "
               "the normals that the file holds. Default: surface.")
        .group(mesh);
    add_number(app, "--crease", "DEG", request.crease_degrees, {0.0, 180.0, "degrees"},
               "Edges sharper than this are hard; 180: none is. Default: by the file's smoothing "
               "groups, else by where its own normals break, else none.")
        .group(mesh);
    const char* image = "Maps";
    const Choices<ImageKind> kinds = {{"heights", ImageKind::heights},
                                      {"normals", ImageKind::normals}};
    add_choice(app, "--image", request.image_kind, kinds,
               "What images hold. Default: by what each shows, which is said.")
        .group(image);
    add_number(app, "--strength", "S", request.strength, {-1e6, 1e6, "texels"},
               "Of height maps: the height in texels that the value 1.0 stands for. Default: 16.")
        .group(image);
    add_choice(app, "--channel", request.channel, height_channel_choices(),
               "Of height maps, what of a color is the height, as for relief-bake bump; the image "
               "is then one of heights. Default: mean, with a finding where the channels differ.")
        .group(image);
    request.wrap.reset();
    add_value(app, "--wrap", "WORD",
              "Of height maps, what lies beyond the border: repeat, clamp, mirror, or auto, by "
              "whether it tiles. Default: auto.",
              [&](const std::string& subject, const std::string& text) {
                  Choices<std::optional<Wrap>> words = {{"repeat", Wrap::repeat},
                                                        {"clamp", Wrap::clamp},
                                                        {"mirror", Wrap::mirror},
                                                        {"auto", std::nullopt}};
                  const std::optional<Wrap> wrap = parse_choice(subject, text, words);
                  request.wrap = WrapsOrAuto{wrap, wrap};
              })
        .group(image);
}

void add_wish_options(CLI::App& app, OwnCommandOptions& options) {
    const char* group = "What to recommend; neither: where more time buys little";
    add_number(app, "--max-error", "DEG", options.max_error, {0.0, 180.0, "degrees"},
               "The cheapest method whose expected error is within this: what the map or model "
               "itself is expected to be off, and what the method adds. Without times, the one "
               "that stores the fewest bytes, then the one of the fewest operations. Exit 1 where "
               "an experiment has none.")
        .group(group);
    const Choices<BoundKind> kinds = {
        {"rms", BoundKind::rms}, {"p99", BoundKind::p99}, {"max", BoundKind::max}};
    add_choice(app, "--max-error-kind", options.max_error_kind, kinds,
               "Which error that is: root mean square, 99 of 100, or the greatest. Default: rms.")
        .group(group);
    add_number(app, "--max-time", "MS", options.max_milliseconds, {0.0, 1e9, "milliseconds"},
               "The most accurate method that takes no longer.")
        .group(group);
}

}  // namespace

Command add_own_command(CLI::App& tool) {
    CLI::App& app = add_subcommand(
        tool, "own", "Measures methods on your own meshes and maps, and says which to take.");
    const auto options = std::make_shared<OwnCommandOptions>();
    add_input_options(app, options->request);
    add_wish_options(app, *options);
    add_experiment_options(app, options->how);
    set_examples(
        app, {"relief-accuracy own data/vase.obj --quick",
              "relief-accuracy own data/bricks-height.png --strength 12 --max-error 2 --quick",
              "relief-mesh subdivide data/vase.obj out/high.obj --levels 2",
              "relief-accuracy own --high out/high.obj --low data/vase.obj --size 64 --repeats 3",
              "relief-accuracy own data/vase.obj --crease 40 --no-times --output out/vase"});
    return {&app, [options] { return run(*options); }};
}

}  // namespace relief::tools
