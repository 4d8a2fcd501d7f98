// SPDX-License-Identifier: Apache-2.0
// `relief-mesh decimate IN OUT` and `relief-mesh subdivide IN OUT` give a model other triangles.
// Tests: tests/tools/reshaping_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "common/command.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/text.h"
#include "relief/mesh/decimate.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/model.h"
#include "relief/mesh/subdivide.h"

namespace relief::tools {
namespace {

struct ReshapeRequest {
    std::filesystem::path input;
    std::filesystem::path output;
    NormalMode normals = NormalMode::keep;
    ReportOptions report;
    GeneralOptions general;
};

struct Reshaped {
    ChangedModel changed;
    std::vector<std::string> omitted;  ///< Content that the output format cannot store.
    Findings findings;
};

/// Reads, changes and writes a model.
Reshaped run(const ReshapeRequest& request, const std::string& verb, const TriangleChange& change,
             Stages& stages) {
    Reshaped done;
    Report read_report;
    Model model = stages.run("read", [&] { return read_model(request.input, read_report); });
    done.findings.add("", read_report);
    done.changed = stages.run(verb, [&] {
        return about(request.input,
                     [&] { return change_triangles(model, request.normals, change); });
    });
    for (const PartReport& part : done.changed.reports)
        done.findings.add(part.part, part.report);
    Report write_report;
    stages.run("write", [&] {
        done.omitted = write_model(request.output, model, request.input, done.changed.has_tangents,
                                   write_report);
    });
    done.findings.add("", write_report);
    return done;
}

void print_reshaped(const ReshapeRequest& request, const Reshaped& done, const Stages& stages) {
    print_entry("read", fmt::format("{}: {}, {}, {}", request.input.string(),
                                    format_name(readable_format(request.input)),
                                    counted(done.changed.triangles_read, "triangle"),
                                    counted(done.changed.vertices_read, "vertex", "vertices")));
    print_entry("result",
                fmt::format("{}, {}", counted(done.changed.triangles_written, "triangle"),
                            counted(done.changed.vertices_written, "vertex", "vertices")));
    print_entry("findings",
                done.findings.empty() ? std::vector<std::string>{"none"} : done.findings.lines());
    if (!done.omitted.empty()) {
        print_entry("omitted",
                    fmt::format("{} (cannot be stored in {})", fmt::join(done.omitted, ", "),
                                extension_of(request.output)));
    }
    print_entry("time", durations(stages.finished()));
    print_entry("wrote", file_and_size(request.output));
}

nlohmann::ordered_json report_json(const std::string& command, const ReshapeRequest& request,
                                   const nlohmann::ordered_json& options, const Reshaped& done,
                                   const Stages& stages) {
    return {{"tool", "relief-mesh " + command},
            {"version", version()},
            {"input", request.input.string()},
            {"output", request.output.string()},
            {"options", options},
            {"triangles_read", done.changed.triangles_read},
            {"triangles_written", done.changed.triangles_written},
            {"vertices_read", done.changed.vertices_read},
            {"vertices_written", done.changed.vertices_written},
            {"findings", done.findings.json()},
            {"left_behind", done.omitted},
            {"milliseconds", durations_json(stages.finished())}};
}

/// Adds IN, OUT, --normals, --report, --strict, --threads and --quiet.
void add_reshape_options(CLI::App& app, ReshapeRequest& request, const std::string& about_normals) {
    add_file(app, "IN", request.input, "Model to read: .glb .gltf .obj .ply .stl .off");
    add_file(app, "OUT", request.output, "Model to write: .glb .gltf .obj .ply. May be IN itself.");
    add_choice(app, "--normals", request.normals, enum_choices<NormalMode>(), about_normals)
        .group("Frames");
    add_report_options(app, request.report);
    add_general_options(app, request.general);
}

/// Runs a command: reads, changes and writes the model, and reports.
///
/// \param options  the command's options for the report
/// \throws UsageError, FileError; then no file is written
ExitCode reshape(const CLI::App& app, const ReshapeRequest& request, const TriangleChange& change,
                 const nlohmann::ordered_json& options) {
    readable_format(request.input);
    writable_format(request.output);
    check(request.report, {request.input, request.output});
    require_folder_of(request.output);
    set_thread_limit(request.general.threads);
    Stages stages(request.general.quiet);
    const Reshaped done = run(request, command_name(app), change, stages);
    if (!request.general.quiet) print_reshaped(request, done, stages);
    return finish(app, request.report, request.input, done.findings,
                  report_json(command_name(app), request, options, done, stages));
}

struct DecimateCommand {
    ReshapeRequest request;
    std::optional<int> triangles;
    std::optional<double> ratio;
    std::optional<double> max_error;
};

void check_limits(const DecimateCommand& command) {
    if (command.triangles && command.ratio)
        throw UsageError("--triangles and --ratio contradict each other", "give one of them");
    if (!command.triangles && !command.ratio && !command.max_error)
        throw UsageError("no limit is given", "give --triangles N, --ratio R or --max-error E");
}

/// Returns the number of triangles for one of several meshes, in proportion to its size.
std::optional<std::size_t> wanted_triangles(const DecimateCommand& command, std::size_t count,
                                            std::size_t all) {
    if (!command.triangles && !command.ratio) return std::nullopt;
    const double ratio = command.ratio ? *command.ratio
                                       : static_cast<double>(*command.triangles) /
                                             static_cast<double>(std::max<std::size_t>(all, 1));
    const double wanted = std::round(ratio * static_cast<double>(count));
    return static_cast<std::size_t>(std::max(wanted, 1.0));
}

nlohmann::ordered_json options_json(const DecimateCommand& command) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    if (command.triangles) json["triangles"] = *command.triangles;
    if (command.ratio) json["ratio"] = *command.ratio;
    if (command.max_error) json["max_error"] = *command.max_error;
    json["normals"] = enum_name(command.request.normals);
    return json;
}

ExitCode decimate(const CLI::App& app, const DecimateCommand& command) {
    check_limits(command);
    const auto change = [&](const Mesh& mesh, std::size_t all_triangles, Report& report) {
        DecimateOptions options;
        options.triangles = wanted_triangles(command, mesh.triangles.size(), all_triangles);
        options.max_error = command.max_error;
        options.frames.normals = command.request.normals;
        return decimated(mesh, options, report);
    };
    return reshape(app, command.request, change, options_json(command));
}

void add_decimate_options(CLI::App& app, DecimateCommand& command) {
    add_reshape_options(
        app, command.request,
        "Normals: those of the file at the remaining vertices (keep), with hard edges preserved "
        "like seams, or recomputed, with hard edges ignored. Default: keep.");
    const std::string limits = "Limits; the first one reached ends the decimation";
    add_value(app, "--triangles", "N",
              "Stop at N triangles in total. Several meshes are reduced by the same ratio.",
              [&command](const std::string& subject, const std::string& text) {
                  command.triangles =
                      parse_integer(subject, text, 1, std::numeric_limits<int>::max());
              })
        .group(limits);
    add_number(app, "--ratio", "R", command.ratio, {0.0, 1.0, ""},
               "Stop at this fraction of the triangles, 0 to 1.")
        .group(limits);
    add_number(app, "--max-error", "E", command.max_error, {0.0, Range().max, ""},
               "Stop before a vertex of IN would be farther than E from the result, in the unit of "
               "the model (relief-mesh info prints its size).")
        .group(limits);
    set_examples(
        app, {"relief-mesh decimate data/vase.obj out/vase-1000.glb --triangles 1000",
              "relief-mesh decimate data/vase.obj out/vase-tenth.obj --ratio 0.1 --normals angle",
              "relief-mesh decimate data/vase.obj out/vase-near.glb --max-error 0.01"});
}

struct SubdivideCommand {
    ReshapeRequest request;
    int levels = 1;
};

ExitCode subdivide(const CLI::App& app, const SubdivideCommand& command) {
    const auto change = [&](const Mesh& mesh, std::size_t, Report& report) {
        return FramedMesh{
            subdivided(mesh, command.levels, {.normals = command.request.normals}, report), {}};
    };
    return reshape(app, command.request, change,
                   {{"levels", command.levels}, {"normals", enum_name(command.request.normals)}});
}

void add_subdivide_options(CLI::App& app, SubdivideCommand& command) {
    constexpr int max_levels = 12;
    add_reshape_options(
        app, command.request,
        "Normals of the result: one per triangle (flat), or averaged with the named weights. "
        "Default: keep, which recomputes them by angle if the file has normals.");
    add_value(app, "--levels", "N",
              "The number of steps, 1 to 12; each step makes four triangles of one. Default: 1.",
              [&command](const std::string& subject, const std::string& text) {
                  command.levels = parse_integer(subject, text, 1, max_levels);
              })
        .group("Shape");
    set_examples(app, {"relief-mesh subdivide data/vase.obj out/vase-fine.glb",
                       "relief-mesh subdivide data/vase.obj out/vase-finer.ply --levels 2"});
}

}  // namespace

Command add_decimate_command(CLI::App& tool) {
    return add_command<DecimateCommand>(
        tool, "decimate",
        "Reduces the number of triangles; texture seams, materials and borders are kept.",
        add_decimate_options, decimate);
}

Command add_subdivide_command(CLI::App& tool) {
    return add_command<SubdivideCommand>(
        tool, "subdivide",
        "Refines and smooths a model by Loop subdivision; the texture mapping is kept.",
        add_subdivide_options, subdivide);
}

}  // namespace relief::tools
