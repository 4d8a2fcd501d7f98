// SPDX-License-Identifier: Apache-2.0
// `relief-accuracy fidelity SOURCE RESULT...` measures how much models differ from their source: in
// pictures, in degrees between normals, in pixels along silhouettes, and in distances between the
// surfaces. Tests: tests/tools/fidelity_command_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "commands.h"
#include "common/command.h"
#include "common/error_bound.h"
#include "common/options.h"
#include "common/summary.h"
#include "common/text.h"
#include "common/view_direction.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/topology.h"
#include "relief/shade/fidelity.h"
#include "relief/shade/scene_file.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

struct FidelityRequest {
    std::filesystem::path source;
    std::vector<std::filesystem::path> results;
    FidelityOptions how;
    ErrorBound max_error;
    std::optional<double> max_flip;
    std::optional<std::filesystem::path> pictures;
    ReportOptions report;
    GeneralOptions general;
};

/// A model, and what it lost.
struct MeasuredStage {
    std::filesystem::path file;
    std::size_t triangles = 0;
    Fidelity loss;
    SurfaceDistance distance;  ///< a is the source.
};

struct MeasuredChain {
    std::size_t source_triangles = 0;
    double diagonal = 0.0;  ///< Of the source's box.
    std::vector<MeasuredStage> stages;
    Findings findings;
};

/// Reads a model without turning it, so that formats with other axes stay comparable.
Scene read_scene(const std::filesystem::path& file, Findings& findings) {
    SceneOptions options;
    options.up = UpAxis::y;
    Report report;
    Scene scene = load_scene(file, options, report);
    findings.add(file.string(), report);
    return scene;
}

double diagonal_of(const Scene& scene) {
    const Bounds bounds = world_bounds(scene);
    return bounds.empty() ? 0.0 : glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
}

MeasuredChain measured_chain(const FidelityRequest& request, Stages& stages) {
    // The part of a surface that is farther than the maximum of its samples is below 0.03 % with a
    // probability of 95 %.
    constexpr std::size_t distance_samples = 10'000;
    MeasuredChain chain;
    const Scene source =
        stages.run("read", [&] { return read_scene(request.source, chain.findings); });
    const Mesh source_surface = world_surface(source);
    chain.source_triangles = source_surface.triangles.size();
    chain.diagonal = diagonal_of(source);
    const Context context;
    Report source_report;
    std::optional<FidelityMeter> meter;
    stages.run("draw source", [&] {
        about(request.source, [&] { meter.emplace(context, source, request.how, source_report); });
    });
    chain.findings.add(request.source.string(), source_report);
    for (const std::filesystem::path& file : request.results) {
        MeasuredStage& stage = chain.stages.emplace_back();
        stage.file = file;
        const Scene scene = stages.run("read", [&] { return read_scene(file, chain.findings); });
        const Mesh surface = world_surface(scene);
        stage.triangles = surface.triangles.size();
        Report report;
        stage.loss = stages.run(
            "compare", [&] { return about(file, [&] { return meter->measure(scene, report); }); });
        chain.findings.add(file.string(), report);
        stage.distance = stages.run("distance", [&] {
            return sampled_distance(source_surface, surface, distance_samples, distance_samples);
        });
    }
    return chain;
}

constexpr std::string_view row_format = "{:<24}{:>9}{:>9}{:>12}{:>10}{:>13}";

using FlipOfLights = std::array<double, fidelity_light_count>;

/// A row of the table; figures that do not exist are empty.
std::string row(const std::string& name, const std::optional<FlipOfLights>& flip, double degrees,
                const std::optional<double>& silhouette) {
    const auto cell = [&](std::size_t light) {
        return flip ? fmt::format("{:.4f}", (*flip)[light]) : "";
    };
    return fmt::format(row_format, name, cell(0), cell(1), cell(2), fmt::format("{:.3f}", degrees),
                       silhouette ? fmt::format("{:.3f}", *silhouette) : "");
}

FlipOfLights flip_of(const Fidelity& loss, double PictureLoss::*figure) {
    FlipOfLights values{};
    for (std::size_t i = 0; i < fidelity_light_count; ++i)
        values[i] = loss.pictures[i].*figure;
    return values;
}

std::string distance_text(const DistanceStats& stats, const MeasuredChain& chain,
                          const Fidelity& loss) {
    const auto text = [&](const char* name, double value) {
        return fmt::format("{} {:.4g} ({:.3f} %, {:.3f} pixels)", name, value,
                           chain.diagonal > 0.0 ? 100.0 * value / chain.diagonal : 0.0,
                           value / loss.diameter * loss.pixels_across);
    };
    return fmt::format("{}, {}, {}", text("mean", stats.mean), text("95 %", stats.p95),
                       text("largest", stats.max));
}

std::vector<std::string> stage_lines(const MeasuredStage& stage, const MeasuredChain& chain) {
    const Fidelity& loss = stage.loss;
    std::vector<std::string> lines = {
        fmt::format(row_format, "", "studio", "grazing", "base color", "degrees", "silhouette"),
        row("mean of all views", flip_of(loss, &PictureLoss::mean), loss.normals.mean,
            loss.silhouettes.width),
        row("95 % of the pixels", flip_of(loss, &PictureLoss::p95), loss.normals.p95, {}),
        row("99 % of the pixels", {}, loss.normals.p99, {}),
        row("noise floor (mean)", flip_of(loss, &PictureLoss::floor), loss.normals.floor,
            loss.silhouettes.floor)};
    for (const std::size_t view : worst_views_first(loss)) {
        const ViewLoss& one = loss.views[view];
        lines.push_back(row(
            fmt::format("view {}: {:.2f} {:.2f} {:.2f}", view, one.from.x, one.from.y, one.from.z),
            one.flip, one.degrees, one.silhouette_pixels));
    }
    lines.push_back(fmt::format("largest angle {:.3f} degrees, root mean square {:.3f}",
                                loss.normals.max, loss.normals.rms));
    lines.push_back("from the source: " + distance_text(stage.distance.from_a, chain, loss));
    lines.push_back("to the source: " + distance_text(stage.distance.from_b, chain, loss));
    return lines;
}

Json worst_json(const WorstView& worst) {
    return {{"view", worst.view}, {"value", worst.value}};
}

Json distances_json(const DistanceStats& stats) {
    return {{"mean", stats.mean},
            {"rms", stats.rms},
            {"p95", stats.p95},
            {"max", stats.max},
            {"samples", stats.samples}};
}

Json stage_json(const MeasuredStage& stage) {
    const Fidelity& loss = stage.loss;
    Json pictures = Json::object();
    for (std::size_t i = 0; i < fidelity_light_count; ++i) {
        const PictureLoss& one = loss.pictures[i];
        pictures[enum_name(static_cast<FidelityLight>(i))] = {{"mean", one.mean},
                                                              {"p95", one.p95},
                                                              {"worst", worst_json(one.worst)},
                                                              {"floor", one.floor}};
    }
    Json views = Json::array();
    for (const std::size_t view : worst_views_first(loss)) {
        const ViewLoss& one = loss.views[view];
        views.push_back({{"view", view},
                         {"from", {one.from.x, one.from.y, one.from.z}},
                         {"flip", one.flip},
                         {"degrees", one.degrees},
                         {"silhouette_pixels", one.silhouette_pixels}});
    }
    return {{"file", stage.file.string()},
            {"triangles", stage.triangles},
            {"pictures", pictures},
            {"studio_mean_on_black", loss.studio_mean_on_black},
            {"normals",
             {{"mean", loss.normals.mean},
              {"rms", loss.normals.rms},
              {"p95", loss.normals.p95},
              {"p99", loss.normals.p99},
              {"max", loss.normals.max},
              {"worst", worst_json(loss.normals.worst)},
              {"floor", loss.normals.floor},
              {"pixels", loss.normals.pixels},
              {"undefined", loss.normals.undefined}}},
            {"silhouettes",
             {{"width", loss.silhouettes.width},
              {"worst", worst_json(loss.silhouettes.worst)},
              {"floor", loss.silhouettes.floor}}},
            {"distance_from_source", distances_json(stage.distance.from_a)},
            {"distance_to_source", distances_json(stage.distance.from_b)},
            {"views", views}};
}

Summary summary_of(const FidelityRequest& request, const MeasuredChain& chain) {
    Summary summary;
    summary.add_tool("relief-accuracy fidelity");
    const Fidelity& first = chain.stages.front().loss;
    summary.add("source",
                fmt::format("{}: {}, {:.4g} across", request.source.string(),
                            counted(chain.source_triangles, "triangle"), first.diameter),
                {{"source",
                  {{"file", request.source.string()},
                   {"triangles", chain.source_triangles},
                   {"diameter", first.diameter},
                   {"diagonal", chain.diagonal}}}});
    summary.add("pictures",
                fmt::format("{} of {} x {} pixels, {} a pixel, {:.0f} pixels across the model",
                            counted(request.how.views + request.how.more_views.size(), "view"),
                            request.how.size, request.how.size,
                            counted(static_cast<std::size_t>(request.how.samples), "sample"),
                            first.pixels_across),
                {{"size", request.how.size},
                 {"samples", request.how.samples},
                 {"pixels_across", first.pixels_across}});
    for (const MeasuredStage& stage : chain.stages) {
        summary.add("after", fmt::format("{}: {}", stage.file.string(),
                                         counted(stage.triangles, "triangle")));
        summary.add("", stage_lines(stage, chain));
    }
    summary.add_json(
        {{"stages", json_list(chain.stages, [](const auto& stage) { return stage_json(stage); })},
         {"max_error", or_null(request.max_error.degrees)},
         {"max_error_kind", enum_name(request.max_error.statistic())},
         {"max_picture_error", or_null(request.max_flip)}});
    summary.add_findings(chain.findings);
    return summary;
}

Image side_by_side(const std::array<Image, 3>& pictures) {
    const int width = pictures[0].width;
    Image all = make_image(3 * width, pictures[0].height, 3, 8, ColorSpace::srgb);
    const MutableImageView to(all);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const ImageView from(pictures[i]);
        for (int y = 0; y < all.height; ++y) {
            std::copy_n(from.row<std::uint8_t>(y), 3 * width,
                        to.row<std::uint8_t>(y) + 3 * width * static_cast<int>(i));
        }
    }
    return all;
}

/// Writes the worst view of each stage and light: source, result and difference.
void write_pictures(const std::filesystem::path& folder, const MeasuredChain& chain) {
    make_folder(folder);
    for (std::size_t i = 0; i < chain.stages.size(); ++i) {
        for (std::size_t light = 0; light < fidelity_light_count; ++light) {
            const PictureLoss& loss = chain.stages[i].loss.pictures[light];
            const std::string name =
                fmt::format("{}-{}-{}.png", i + 1, chain.stages[i].file.stem().string(),
                            enum_name(static_cast<FidelityLight>(light)));
            write_image(folder / name, side_by_side({loss.source, loss.result,
                                                     false_color_image(loss.difference, 1.0)}));
        }
    }
}

/// Returns what exceeds the limits, which apply to the last stage; empty: nothing.
std::string above_limits(const FidelityRequest& request, const MeasuredStage& last) {
    std::string text;
    const double degrees = last.loss.normals.error(request.max_error.statistic());
    if (request.max_error.degrees && degrees > *request.max_error.degrees) {
        text = fmt::format("normals differ by {:.3f} degrees ({}), and --max-error allows {:g}",
                           degrees, statistic_name(request.max_error.statistic()),
                           *request.max_error.degrees);
    }
    const double flip = last.loss.max_picture_mean();
    if (request.max_flip && flip > *request.max_flip) {
        text += fmt::format(
            "{}pictures differ by {:.4f} (mean FLIP), and --max-picture-error allows {:g}",
            text.empty() ? "" : "; ", flip, *request.max_flip);
    }
    return text;
}

ExitCode run(const CLI::App& app, const FidelityRequest& request) {
    if (request.results.empty())
        throw UsageError("no RESULT", "name the models to compare with the source");
    std::vector<std::filesystem::path> inputs = request.results;
    inputs.push_back(request.source);
    check(request.report, inputs);
    set_thread_limit(request.general.threads);
    Stages stages(request.general.quiet);
    const MeasuredChain chain = measured_chain(request, stages);
    if (request.pictures) write_pictures(*request.pictures, chain);
    Summary summary = summary_of(request, chain);
    summary.add_times(stages);
    if (!request.general.quiet) summary.print();
    const ExitCode code =
        finish(app, request.report, request.source, chain.findings, summary.json());
    const MeasuredStage& last = chain.stages.back();
    const std::string problem = above_limits(request, last);
    if (problem.empty()) return code;
    complain(app, fmt::format("{}: {}", last.file.string(), problem));
    return ExitCode::failed;
}

void add_options(CLI::App& app, FidelityRequest& request) {
    add_file(app, "SOURCE", request.source, "The detailed model: .glb .gltf .obj .ply .stl .off");
    add_files(app, "RESULT...", request.results,
              "The models to compare with it, in the order of their making. Each is compared with "
              "the source.");
    const char* pictures = "Pictures";
    add_value(app, "--size", "N",
              "The width and height of the pictures, from 16 to 4096. Default: 256.",
              [&](const std::string& subject, const std::string& text) {
                  request.how.size = parse_integer(subject, text, 16, 4096);
              })
        .group(pictures);
    add_value(app, "--views", "N",
              "The number of views, from 1 to 12. Default: 12, from all sides.",
              [&](const std::string& subject, const std::string& text) {
                  request.how.views = static_cast<std::size_t>(
                      parse_integer(subject, text, 1, static_cast<int>(fidelity_view_count)));
              })
        .group(pictures);
    add_view_option(app, request.how.more_views).group(pictures);
    add_choice<int>(app, "--samples", {{"1", 1}, {"4", 4}, {"9", 9}, {"16", 16}},
                    "The samples of a pixel. Default: 4.",
                    [&](int samples) { request.how.samples = samples; })
        .group(pictures);
    add_path(app, "--pictures", request.pictures,
             "Write the worst view of each result and light to this folder: source, result and "
             "difference (FLIP) side by side.")
        .group(pictures);
    const char* verdict = "Verdict, on the last result";
    add_error_bound(app, request.max_error, verdict,
                    "Exit with 1 if the angle between normals is larger at more than 1 % of the "
                    "pixels.");
    add_number(app, "--max-picture-error", "FLIP", request.max_flip, {0.0, 1.0, ""},
               "Exit with 1 if the mean difference of pictures is larger with one of the lights.")
        .group(verdict);
    add_report_options(app, request.report);
    add_general_options(app, request.general);
    set_examples(app, {"relief-accuracy fidelity data/urn-high.ply data/urn-low.obj --size 64",
                       "relief-accuracy fidelity data/urn-high.ply data/urn-low.obj --size 64 "
                       "--views 4 --max-error 60 --pictures out/loss --report out/loss.json"});
}

}  // namespace

Command add_fidelity_command(CLI::App& tool) {
    return add_command<FidelityRequest>(
        tool, "fidelity",
        "Measures how much models differ from their source, in pictures, degrees and pixels.",
        add_options, run);
}

}  // namespace relief::tools
