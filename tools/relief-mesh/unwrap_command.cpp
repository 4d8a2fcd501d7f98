// SPDX-License-Identifier: Apache-2.0
// `relief-mesh unwrap IN OUT` gives a mesh texture coordinates. Tests: tests/tools/unwrap_test.cpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "atlas_summary.h"
#include "commands.h"
#include "common/command.h"
#include "common/model_file.h"
#include "common/options.h"
#include "common/summary.h"
#include "common/text.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/model_texcoords.h"
#include "relief/mesh/unwrap.h"

namespace relief::tools {
namespace {

constexpr int max_texcoord_set = 1000;

/// The relative density of texels.
struct DensityRequest {
    bool by_color = false;
    std::vector<std::pair<std::string, double>> by_material;  ///< Others have density 1.
};

struct UnwrapCommand {
    std::filesystem::path input;
    std::filesystem::path output;
    UnwrapOptions options;
    TexcoordOptions texcoords;
    std::string density_text = "equal";
    DensityRequest density;
    std::optional<double> hard_degrees;
    AtlasPictureOptions picture;
    ReportOptions report;
    GeneralOptions general;
};

/// Parses "equal", "color" or "Head=2,Eyes=4".
DensityRequest parse_density(const std::string& subject, const std::string& text) {
    DensityRequest request;
    if (text == "equal") return request;
    request.by_color = text == "color";
    if (request.by_color) return request;
    for (const std::string& part : split(text, ',')) {
        const std::string here = fmt::format("{}: '{}'", subject, part);
        const std::size_t equals = part.rfind('=');
        if (equals == std::string::npos)
            throw UsageError(here + ": not equal, color or MATERIAL=FACTOR",
                             "for example Head=2,Eyes=4");
        request.by_material.emplace_back(
            part.substr(0, equals),
            parse_number(here, part.substr(equals + 1), {0.001, 1000.0, ""}));
    }
    return request;
}

/// The names of the materials, by the indices in material ranges.
std::vector<std::string> material_names(const Model& model) {
    std::vector<std::string> names;
    if (const auto* document = std::get_if<GltfDocument>(&model)) {
        for (const GltfMaterial& material : document->view().materials)
            names.push_back(material.name);
    } else {
        for (const MtlMaterial& material : std::get<MeshFile>(model).materials)
            names.push_back(material.name);
    }
    return names;
}

/// \return the density of each material; empty if none is requested
std::vector<float> material_densities(const Model& model, const DensityRequest& request) {
    if (request.by_material.empty()) return {};
    const std::vector<std::string> names = material_names(model);
    std::vector<float> densities(names.size(), 1.0F);
    for (const auto& [name, factor] : request.by_material) {
        bool is_found = false;
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (names[i] != name) continue;
            is_found = true;
            densities[i] = static_cast<float>(factor);
        }
        if (!is_found)
            throw InvalidInput(fmt::format(
                "--density: there is no material '{}', only {}", name,
                names.empty() ? "faces without one" : fmt::format("{}", fmt::join(names, ", "))));
    }
    return densities;
}

/// The density of each triangle; empty if all are equal.
std::vector<float> triangle_densities(const Mesh& mesh, bool by_color,
                                      const std::vector<float>& by_material) {
    /// Black would need no texels at all.
    constexpr float min_brightness = 1.0F / 16.0F;
    std::vector<float> densities;
    if (by_color) {
        if (mesh.colors.empty()) throw InvalidInput("--density color: there are no vertex colors");
        densities.reserve(mesh.triangles.size());
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::vec4 sum = mesh.colors[t.x] + mesh.colors[t.y] + mesh.colors[t.z];
            const float brightness = (sum.r + sum.g + sum.b) / 9.0F;
            densities.push_back(std::clamp(brightness, min_brightness, 1.0F));
        }
    } else if (!by_material.empty()) {
        densities.assign(mesh.triangles.size(), 1.0F);
        for (const MaterialRange& range : mesh.material_ranges) {
            if (range.material)
                std::fill_n(densities.begin() + range.first_triangle, range.triangle_count,
                            by_material[*range.material]);
        }
    }
    return densities;
}

Json options_json(const UnwrapCommand& command) {
    const UnwrapOptions& options = command.options;
    Json json = {{"size", {options.size.x, options.size.y}},
                 {"padding", options.padding},
                 {"align", options.alignment},
                 {"udim", options.tiles},
                 {"density", command.density_text},
                 {"flatten", enum_name(options.flattening)},
                 {"max_stretch", options.max_stretch},
                 {"split_materials", options.split_materials},
                 {"keep_seams", options.keep_seams},
                 {"stack", options.stack},
                 {"repack", options.repack},
                 {"fix_mirrored", options.unmirror},
                 {"uv_set", command.texcoords.set},
                 {"remove_textures", command.texcoords.remove_textures}};
    if (command.hard_degrees) json["split_hard"] = *command.hard_degrees;
    if (options.texels_per_unit) json["texels_per_unit"] = *options.texels_per_unit;
    return json;
}

/// Refuses options of new charts with --repack.
void refuse_new_charts(const CLI::App& app) {
    for (const char* option : {"--flatten", "--max-stretch", "--split-hard", "--split-materials",
                               "--keep-seams", "--density", "--stack"}) {
        if (is_given(app, option))
            throw UsageError(
                fmt::format("{}: has no effect with --repack, which keeps charts", option));
    }
}

/// Checks the files and the options that depend on their formats. \throws UsageError, FileError
void check_request(const CLI::App& app, const UnwrapCommand& command) {
    check(command.report, {command.input, command.output});
    std::vector<std::filesystem::path> files = {command.input, command.output};
    if (command.report.file) files.push_back(*command.report.file);
    check(command.picture, files);
    const bool has_sets = is_document(readable_format(command.input));
    const bool keeps_sets = is_document(writable_format(command.output));
    if (command.texcoords.set > 0 && !(has_sets && keeps_sets))
        throw UsageError(
            fmt::format("--uv-set {}: {} has only texture coordinate set 0", command.texcoords.set,
                        (has_sets ? command.output : command.input).string()),
            "only glTF has several");
    if (command.options.repack)
        refuse_new_charts(app);
    else
        refuse_given(app, {"--fix-mirrored"}, "--repack");
    require_folder_of(command.output);
}

/// The times of the stages of unwrap(), in their order.
class UnwrapStages {
  public:
    [[nodiscard]] Progress& progress() { return progress_; }
    /// Ends the last stage.
    void end() { change(""); }
    [[nodiscard]] const std::vector<Stage>& times() const { return times_; }

  private:
    void change(const std::string& stage) {
        // The operation as a whole takes no time beside its stages.
        if (stage == current_ || stage == "unwrapping") return;
        const double milliseconds = 1e3 * stopwatch_.lap();
        const auto known = std::find_if(times_.begin(), times_.end(),
                                        [&](const Stage& one) { return one.name == current_; });
        if (known != times_.end())
            known->milliseconds += milliseconds;
        else if (!current_.empty())
            times_.push_back({current_, milliseconds});
        current_ = stage;
    }

    Progress progress_{[this](const Progress::State& state) { change(state.stage); }};
    std::string current_;
    Stopwatch stopwatch_;
    std::vector<Stage> times_;
};

Json milliseconds_json(const std::vector<Stage>& times) {
    Json json = Json::object();
    for (const Stage& stage : times)
        json[stage.name] = stage.milliseconds;
    return json;
}

ExitCode unwrap_model(const CLI::App& app, const UnwrapCommand& command) {
    check_request(app, command);
    UnwrapOptions options = command.options;
    if (command.hard_degrees) options.split_hard = *command.hard_degrees * std::numbers::pi / 180.0;
    set_thread_limit(command.general.threads);
    Stages stages(command.general.quiet);
    Findings findings;
    Report report;
    Model model = stages.run("read", [&] { return read_model(command.input, report); });
    findings.add("", report);
    const std::vector<float> by_material =
        about(command.input, [&] { return material_densities(model, command.density); });
    AtlasStats stats;
    UnwrapStages unwrap_stages;
    options.execution.progress = &unwrap_stages.progress();
    const ChangedTexcoords changed = about(command.input, [&] {
        return change_texcoords(
            model, command.texcoords, [&](const TexcoordInput& input, Report& found) {
                Unwrapped unwrapped = stages.run("unwrap", [&] {
                    options.first_vertices = input.first_vertices;
                    options.densities =
                        triangle_densities(input.mesh, command.density.by_color, by_material);
                    return unwrap(input.mesh, options, found);
                });
                unwrap_stages.end();
                stats = unwrapped.stats;
                if (command.picture.file)
                    stages.run("draw", [&] {
                        write_picture(command.picture, input.mesh, unwrapped.corner_texcoords,
                                      unwrapped.chart, options.size, options.tiles);
                    });
                return std::move(unwrapped.corner_texcoords);
            });
    });
    for (const PartReport& part : changed.reports)
        findings.add(part.part, part.report);
    std::vector<std::string> omitted;
    Report write_report;
    stages.run("write", [&] {
        omitted =
            write_model(command.output, model, command.input, changed.has_tangents, write_report);
    });
    findings.add("", write_report);

    Summary summary;
    summary.add("read",
                fmt::format("{}: {}, {}, {}", command.input.string(),
                            format_name(readable_format(command.input)),
                            counted(changed.triangles, "triangle"),
                            counted(changed.vertices_read, "vertex", "vertices")),
                {{"triangles", changed.triangles}, {"vertices_read", changed.vertices_read}});
    add_stats(summary, stats, options.size, options.tiles);
    summary.add("padding",
                fmt::format("{} texels, {}", options.padding, mip_text(stats.safe_mip_level)));
    summary.add("result",
                fmt::format("{}", counted(changed.vertices_written, "vertex", "vertices")),
                {{"vertices_written", changed.vertices_written}});
    summary.add_findings(findings);
    summary.add("notes", changed.notes, {{"notes", changed.notes}});
    add_omitted(summary, omitted, command.output);
    summary.add("unwrap", durations(unwrap_stages.times()),
                {{"unwrap_milliseconds", milliseconds_json(unwrap_stages.times())}});
    summary.add_times(stages);
    std::vector<std::string> wrote = {file_and_size(command.output)};
    if (command.picture.file) wrote.push_back(file_and_size(*command.picture.file));
    summary.add("wrote", wrote);
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
    add_file(app, "IN", command.input,
             "The model: .glb, .gltf, .obj, .ply, .stl or .off. All its meshes share one map.");
    add_file(app, "OUT", command.output,
             "The model with texture coordinates: .glb, .gltf, .obj or .ply. All other data of a "
             "glTF file stays.");
    const std::string map = "Map";
    add_value(app, "--size", "N|WxH", "The size of the map in texels, 16 to 65536. Default: 2048.",
              [&command](const std::string& subject, const std::string& text) {
                  command.options.size = parse_atlas_size(subject, text);
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
    add_value(
        app, "--udim", "N",
        "Use N maps of this size, 1 to 100: tiles 1001, 1002, ... of UDIM. No chart is in two "
        "tiles, and all have one density. Default: 1.",
        [&command](const std::string& subject, const std::string& text) {
            command.options.tiles = parse_integer(subject, text, 1, 100);
        })
        .group(map);
    add_number(app, "--texels-per-unit", "D", command.options.texels_per_unit,
               {1e-30, Range().max, ""},
               "The density of texels. Default: as dense as the map permits.")
        .group(map);
    add_value(app, "--density", "equal|color|MATERIAL=FACTOR,...",
              "The relative density of texels: of materials by their names, the others have 1; or "
              "the mean brightness of vertex colors, 1/16 to 1. A factor of 2 means twice as many "
              "texels in each direction. Default: equal.",
              [&command](const std::string& subject, const std::string& text) {
                  command.density_text = text;
                  command.density = parse_density(subject, text);
              })
        .group(map);
    add_value(app, "--uv-set", "N",
              "Write texture coordinate set N (TEXCOORD_N of glTF). Sets that the file has are "
              "replaced, others stay. Default: 0.",
              [&command](const std::string& subject, const std::string& text) {
                  command.texcoords.set = parse_integer(subject, text, 0, max_texcoord_set);
              })
        .group(map);
    add_switch(app, "--remove-textures", command.texcoords.remove_textures,
               "Remove the textures that materials look up at replaced coordinates. Default: they "
               "stay, although they do not fit any more, which is a finding.")
        .group(map);
    const std::string charts = "Charts";
    add_choice(app, "--flatten", command.options.flattening, enum_choices<Flattening>(),
               "What charts keep: lengths as far as possible (arap), or angles (conformal), which "
               "makes the density of texels less even. Default: arap.")
        .group(charts);
    add_number(
        app, "--max-stretch", "S", command.options.max_stretch, {1.01, 1000.0, ""},
        "The largest ratio of a triangle's two scales, and of its areas, 1.01 to 1000; charts "
        "above it are divided. Default: 4.")
        .group(charts);
    add_number(
        app, "--split-hard", "DEGREES", command.hard_degrees, {0.0, 180.0, "degrees"},
        "Put seams where the angle between two triangles is larger, 0 to 180, as far as these "
        "edges separate charts; 0: at all edges that are not flat. Default: nowhere.")
        .group(charts);
    add_switch(app, "--split-materials", command.options.split_materials,
               "Put seams between materials. Default: a chart may have several materials.")
        .group(charts);
    add_switch(
        app, "--keep-seams", command.options.keep_seams,
        "Keep the seams of the texture coordinates of IN: those of set N, or of the first set "
        "if there is no set N. Default: they are ignored.")
        .group(charts);
    add_switch(
        app, "--stack", command.options.stack,
        "Parts that are equal up to a rotation and a shift share their texels. Mirrored parts "
        "do not. Default: every part has texels of its own.")
        .group(charts);
    add_switch(app, "--repack", command.options.repack,
               "Keep the charts of the texture coordinates of IN with their shapes and relative "
               "sizes, and only pack them anew: those of set N, or of the first set if there is no "
               "set N. Default: compute new charts.")
        .group(charts);
    add_switch(
        app, "--fix-mirrored", command.options.unmirror,
        "With --repack: reflect mirrored charts, so that all have the same handedness. Default: "
        "they stay, which is a finding.")
        .group(charts);
    add_picture_options(app, command.picture);
    add_report_options(app, command.report);
    add_general_options(app, command.general);
    set_examples(app, {"relief-mesh unwrap data/vase.obj out/vase-unwrapped.obj",
                       "relief-mesh unwrap data/vase.obj out/vase-unwrapped.glb --size 1024 "
                       "--padding 8 --split-hard 60 --split-materials --max-stretch 2",
                       "relief-mesh unwrap data/vase.obj out/vase-unwrapped.ply --size 2048x1024 "
                       "--align 4 --picture out/vase-charts.png --picture-shows stretch",
                       "relief-mesh unwrap data/vase.obj out/vase-tiles.obj --size 512 --udim 4 "
                       "--report out/vase-tiles.json",
                       "relief-mesh unwrap data/vase.obj out/vase-angles.obj --flatten conformal",
                       "relief-mesh unwrap data/vase.obj out/vase-dense.obj --density bricks=2 "
                       "--texels-per-unit 100 --stack",
                       "relief-mesh unwrap data/vase.obj out/vase-seams.glb --keep-seams "
                       "--remove-textures",
                       "relief-mesh unwrap data/vase.obj out/vase-repacked.obj --repack "
                       "--fix-mirrored --size 512 --padding 12",
                       "relief-mesh unwrap out/vase-unwrapped.glb out/vase-two-sets.glb --uv-set "
                       "1"});
}

}  // namespace

Command add_unwrap_command(CLI::App& tool) {
    return add_command<UnwrapCommand>(tool, "unwrap",
                                      "Computes texture coordinates without overlaps.",
                                      add_unwrap_options, unwrap_model);
}

}  // namespace relief::tools
