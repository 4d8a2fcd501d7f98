// SPDX-License-Identifier: Apache-2.0
// `relief-mesh unwrap IN OUT` gives a mesh texture coordinates. Tests: tests/tools/unwrap_test.cpp.
#include <fmt/format.h>

#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <variant>

#include "commands.h"
#include "common/command.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/summary.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/model.h"
#include "relief/mesh/unwrap.h"

namespace relief::tools {
namespace {

struct UnwrapCommand {
    std::filesystem::path input;
    std::filesystem::path output;
    UnwrapOptions options;
    std::optional<double> hard_degrees;
    ReportOptions report;
    GeneralOptions general;
};

/// Parses "2048" or "2048x1024".
glm::ivec2 parse_map_size(const std::string& subject, const std::string& text) {
    const std::size_t cross = text.find('x');
    const auto side = [&](const std::string& number) {
        return parse_integer(subject, number, 16, 65536);
    };
    if (cross == std::string::npos) return glm::ivec2(side(text));
    return {side(text.substr(0, cross)), side(text.substr(cross + 1))};
}

/// The highest mip level in which a bilinear lookup in one chart does not reach another one.
/// \return none if not even level 0 is safe
std::optional<int> safe_level(int padding) {
    if (padding < 3) return std::nullopt;
    int level = 0;
    while (3 << (level + 1) <= padding)
        ++level;
    return level;
}

Json stats_json(const AtlasStats& stats) {
    return {{"charts", stats.charts},
            {"small_charts", stats.small_charts},
            {"used", stats.used},
            {"texels_per_unit", stats.texels_per_unit},
            {"min_density", stats.min_density},
            {"max_density", stats.max_density},
            {"stretch", stats.stretch},
            {"mean_anisotropy", stats.mean_anisotropy},
            {"max_anisotropy", stats.max_anisotropy},
            {"seam_length", stats.seam_length},
            {"relative_seam_length", stats.relative_seam_length},
            {"area", stats.area}};
}

Json options_json(const UnwrapCommand& command) {
    const UnwrapOptions& options = command.options;
    Json json = {{"size", {options.size.x, options.size.y}},
                 {"padding", options.padding},
                 {"align", options.alignment},
                 {"max_stretch", options.max_stretch},
                 {"split_materials", options.split_materials},
                 {"keep_seams", options.keep_seams}};
    if (command.hard_degrees) json["split_hard"] = *command.hard_degrees;
    if (options.texels_per_unit) json["texels_per_unit"] = *options.texels_per_unit;
    return json;
}

void add_stats(Summary& summary, const AtlasStats& stats, const UnwrapOptions& options) {
    summary.add("atlas",
                {fmt::format("{} ({} below 64 texels), {:.1f} % of {} x {} texels used",
                             counted(stats.charts, "chart"), stats.small_charts, 100.0 * stats.used,
                             options.size.x, options.size.y),
                 fmt::format("seams: length {:.4g}, {:.3g} times the root of the area",
                             stats.seam_length, stats.relative_seam_length)},
                {{"atlas", stats_json(stats)}});
    summary.add("density",
                fmt::format("{:.4g} texels per unit; 5 to 95 % of the area: {:.3f} to {:.3f} of it",
                            stats.texels_per_unit, stats.min_density, stats.max_density));
    summary.add("stretch",
                fmt::format("L2 {:.4f}; ratio of singular values: mean {:.3f}, max {:.2f}",
                            stats.stretch, stats.mean_anisotropy, stats.max_anisotropy));
    const std::optional<int> level = safe_level(options.padding);
    summary.add("padding", fmt::format("{} texels, {}", options.padding,
                                       level ? fmt::format("enough up to mip level {}", *level)
                                             : "too few for bilinear lookups"));
}

ExitCode unwrap_model(const CLI::App& app, const UnwrapCommand& command) {
    UnwrapOptions options = command.options;
    check(command.report, {command.input, command.output});
    if (is_document(readable_format(command.input)))
        throw UsageError(command.input.string() + ": glTF files cannot be unwrapped yet",
                         "give a mesh file: .obj, .ply, .stl or .off");
    writable_format(command.output);
    require_folder_of(command.output);
    if (command.hard_degrees) options.split_hard = *command.hard_degrees * std::numbers::pi / 180.0;
    set_thread_limit(command.general.threads);
    Stages stages(command.general.quiet);
    Findings findings;
    Report report;
    Model model = stages.run("read", [&] { return read_model(command.input, report); });
    Mesh& mesh = std::get<MeshFile>(model).mesh;
    const std::size_t vertices_read = mesh.positions.size();
    const Unwrapped unwrapped = about(command.input, [&] {
        return stages.run("unwrap", [&] { return unwrap(mesh, options, report); });
    });
    mesh = with_texcoords(mesh, unwrapped).mesh;
    std::vector<std::string> omitted;
    stages.run("write",
               [&] { omitted = write_model(command.output, model, command.input, false, report); });
    findings.add("", report);

    Summary summary;
    summary.add("read",
                fmt::format("{}: {}, {}", command.input.string(),
                            counted(mesh.triangles.size(), "triangle"),
                            counted(vertices_read, "vertex", "vertices")),
                {{"triangles", mesh.triangles.size()}, {"vertices_read", vertices_read}});
    add_stats(summary, unwrapped.stats, options);
    summary.add("result", fmt::format("{}", counted(mesh.positions.size(), "vertex", "vertices")),
                {{"vertices_written", mesh.positions.size()}});
    summary.add_findings(findings);
    add_omitted(summary, omitted, command.output);
    summary.add_times(stages);
    summary.add("wrote", file_and_size(command.output));
    if (!command.general.quiet) summary.print();
    Json json = {{"tool", "relief-mesh unwrap"},
                 {"version", version()},
                 {"options", options_json(command)},
                 {"input", command.input.string()},
                 {"output", command.output.string()}};
    json.update(summary.json());
    return finish(app, command.report, command.input, findings, json);
}

void add_unwrap_options(CLI::App& app, UnwrapCommand& command) {
    add_file(app, "IN", command.input, "The mesh: .obj, .ply, .stl or .off.");
    add_file(app, "OUT", command.output,
             "The mesh with texture coordinates: .glb, .gltf, .obj or .ply.");
    const std::string map = "Map";
    add_value(app, "--size", "N|WxH", "The size of the map in texels, 16 to 65536. Default: 2048.",
              [&command](const std::string& subject, const std::string& text) {
                  command.options.size = parse_map_size(subject, text);
              })
        .group(map);
    add_value(
        app, "--padding", "N",
        "The least distance between charts in texels, 0 to 256; half of it at the edges of the "
        "map. 3 * 2^k keeps mip level k free of other charts. Default: 4.",
        [&command](const std::string& subject, const std::string& text) {
            command.options.padding = parse_integer(subject, text, 0, 256);
        })
        .group(map);
    add_value(
        app, "--align", "N",
        "No two charts share a block of N x N texels, 1 to 64: 4 for BC compression. Default: "
        "1.",
        [&command](const std::string& subject, const std::string& text) {
            command.options.alignment = parse_integer(subject, text, 1, 64);
        })
        .group(map);
    add_number(app, "--texels-per-unit", "D", command.options.texels_per_unit,
               {1e-30, Range().max, ""},
               "The density of texels. Default: as dense as the map permits.")
        .group(map);
    const std::string charts = "Charts";
    add_number(
        app, "--max-stretch", "S", command.options.max_stretch, {1.01, 1000.0, ""},
        "The largest ratio of a triangle's two scales, and of its areas, 1.01 to 1000; charts "
        "above it are divided. Default: 4.")
        .group(charts);
    add_number(
        app, "--split-hard", "DEGREES", command.hard_degrees, {0.0, 180.0, "degrees"},
        "Put seams where the angle between two triangles is larger, 0 to 180, as far as these "
        "edges separate charts. Default: nowhere.")
        .group(charts);
    add_switch(app, "--split-materials", command.options.split_materials,
               "Put seams between materials. Default: a chart may have several materials.")
        .group(charts);
    add_switch(app, "--keep-seams", command.options.keep_seams,
               "Keep the seams of the texture coordinates of IN. Default: they are ignored.")
        .group(charts);
    add_report_options(app, command.report);
    add_general_options(app, command.general);
    set_examples(app, {"relief-mesh unwrap data/vase.obj out/vase-unwrapped.obj",
                       "relief-mesh unwrap data/vase.obj out/vase-unwrapped.glb --size 1024 "
                       "--padding 8 --split-hard 60",
                       "relief-mesh unwrap data/vase.obj out/vase-unwrapped.ply --size 2048x1024 "
                       "--align 4"});
}

}  // namespace

Command add_unwrap_command(CLI::App& tool) {
    return add_command<UnwrapCommand>(tool, "unwrap",
                                      "Computes texture coordinates without overlaps.",
                                      add_unwrap_options, unwrap_model);
}

}  // namespace relief::tools
