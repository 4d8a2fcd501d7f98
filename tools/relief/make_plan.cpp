// SPDX-License-Identifier: Apache-2.0
// The plan of `relief make --explain`, with estimated times. Tests:
// tests/make/relief_make_test.cpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <thread>
#include <utility>

#include "make_job.h"
#include "make_stages.h"

namespace relief::tools {
namespace {

/// Processor time in seconds, on one thread of a busy Xeon of 2.8 GHz (428,800 triangles to 5,000,
/// maps of 2048 x 2048).
struct EstimatedCosts {
    double repair = 1.1;         ///< Per million triangles of the source.
    double decimate = 2.0;       ///< The same.
    double decimated = 30.0;     ///< Per million triangles of the asset.
    double unwrap = 35.0;        ///< Per million triangles of the asset.
    double unwrap_size = 0.005;  ///< Per million texels.
    double remesh = 2.0;         ///< At 256 cells; grows with their square.
    double prepare = 1.3;        ///< Of the bake, per million triangles of the source.
    double bake = 0.55;          ///< Per million rays.
    double occlusion = 0.43;     ///< Per million rays of occlusion.
    double thickness = 1.2;      ///< Per million rays of thickness.
    double write = 0.015;        ///< Per million texels of a map.
    double level = 6.0;          ///< Of detail, per million triangles of the asset.
    double loss = 4.0;           ///< Without a GPU, and per million triangles of the source.
    double loss_of_source = 2.0;
    double loss_of_stage = 0.5;
};

constexpr double million = 1e6;
/// The part of the texels that charts cover.
constexpr double covered = 0.65;

double texels_of(const glm::ivec2& size) {
    return static_cast<double>(size.x) * static_cast<double>(size.y);
}

/// The stage "remesh". The time without a replacement is counted.
PlannedStage remesh_plan(const make::AssetOptions& options, double dense) {
    const EstimatedCosts costs;
    const std::string grid = fmt::format("a closed surface of {} cells{}", options.resolution,
                                         options.shell ? ", with shells" : "");
    const double share = options.resolution / 256.0;
    const double replacing = costs.remesh * share * share + costs.prepare * dense;
    if (options.remesh == make::Remeshing::always)
        return {"remesh", "replace the triangles by " + grid, replacing};
    return {"remesh",
            fmt::format(
                "measure whether the mesh needs {}; if so, and if it is at most {:g} cells away, "
                "about {} more, and decimate and unwrap again",
                grid, make::max_remesh_distance, duration(1e3 * replacing)),
            0.0};
}

/// Returns the layers that the rays of the bake give: "normals", "colors", ...
std::vector<std::string> layers_of(const make::AssetOptions& options,
                                   const make::AssetSource& source) {
    const make::VaryingProperties varying = make::varying_properties(source.mesh, source);
    std::vector<std::string> layers = {"normals"};
    if (varying.color) layers.emplace_back("colors");
    if (varying.surface) layers.emplace_back("roughness and metalness");
    if (varying.occlusion) layers.emplace_back("occlusion textures");
    if (varying.emission) layers.emplace_back("emission");
    for (const LayerKind kind : options.layers) {
        if (kind != LayerKind::bent_normal && kind != LayerKind::thickness)
            layers.emplace_back(enum_name(kind));
    }
    return layers;
}

/// ", 2 million for occlusion and bent normals, 2 million for thickness"
/// \param occlusion,thickness  millions of rays
std::string hemisphere_text(bool has_occlusion, bool has_bent, double occlusion, double thickness) {
    std::string text;
    if (has_occlusion || has_bent) {
        text +=
            fmt::format(", {:.0f} million for {}{}{}", occlusion, has_occlusion ? "occlusion" : "",
                        has_occlusion && has_bent ? " and " : "", has_bent ? "bent normals" : "");
    }
    if (thickness > 0.0) text += fmt::format(", {:.0f} million for thickness", thickness);
    return text;
}

std::string edges_text(const std::optional<double>& crease_angle) {
    return crease_angle
               ? fmt::format("hard at edges above {:g} degrees",
                             std::round(*crease_angle * 180.0 / std::numbers::pi * 1e6) / 1e6)
               : "smooth";
}

}  // namespace

std::vector<PlannedStage> plan_of(const MakeRequest& request, const make::AssetSource& source,
                                  double reading) {
    const make::AssetOptions& options = request.asset;
    const EstimatedCosts costs;
    const double dense = static_cast<double>(source.mesh.triangles.size()) / million;
    const double result = std::min(static_cast<double>(options.triangles) / million, dense);
    const double texels = texels_of(options.size) / million;
    const double rays = covered * texels * options.samples;
    const double hemispheres =
        covered * texels / 16.0 * (options.occlusion_rays > 0 ? options.occlusion_rays : 32);
    const auto has_layer = [&](LayerKind kind) {
        return std::ranges::find(options.layers, kind) != options.layers.end();
    };
    const bool has_bent = has_layer(LayerKind::bent_normal);
    const double occlusion = options.occlusion || has_bent ? hemispheres : 0.0;
    const double thickness = has_layer(LayerKind::thickness) ? hemispheres : 0.0;
    const std::string edges = edges_text(options.crease_angle);
    const std::string source_edges =
        edges_text(source.crease_angle ? source.crease_angle : options.crease_angle);
    std::vector<PlannedStage> plan = {
        {"read", counted(source.mesh.triangles.size(), "triangle"), reading},
        {"repair",
         fmt::format("{}{}",
                     options.repair ? "merge vertices, orient parts, cut non-manifold edges"
                                    : "remove unusable triangles",
                     source.mesh.normals.empty() ? "; compute normals, " + source_edges : ""),
         costs.repair * dense}};
    if (options.remesh == make::Remeshing::always) plan.push_back(remesh_plan(options, dense));
    plan.push_back({"decimate",
                    fmt::format("{} to {}", counted(source.mesh.triangles.size(), "triangle"),
                                std::min(options.triangles, source.mesh.triangles.size())),
                    result < dense ? costs.decimate * dense + costs.decimated * result : 0.0});
    if (!options.keep_texcoords) {
        plan.push_back({"unwrap",
                        fmt::format("charts in {} x {} texels, padding {}", options.size.x,
                                    options.size.y, options.padding),
                        costs.unwrap * result + costs.unwrap_size * texels, 0.2});
    }
    if (options.remesh == make::Remeshing::automatic && !options.keep_texcoords)
        plan.push_back(remesh_plan(options, dense));
    plan.push_back({"frames", fmt::format("normals, {}; MikkTSpace tangents", edges), 0.0});
    plan.push_back({"bake",
                    fmt::format("{:.1f} million rays for {}{}", rays,
                                fmt::join(layers_of(options, source), ", "),
                                hemisphere_text(options.occlusion, has_bent, occlusion, thickness)),
                    costs.prepare * dense + costs.bake * rays + costs.occlusion * occlusion +
                        costs.thickness * thickness,
                    0.8});
    plan.push_back(
        {"write",
         fmt::format("the asset with its maps{}",
                     options.levels > 0
                         ? fmt::format(" and {} of detail", counted(options.levels, "level"))
                         : ""),
         costs.write * 2.0 * texels + (options.levels > 0 ? costs.level * result : 0.0), 0.5});
    plan.push_back({"verify", "read the asset back and compare it", costs.write * texels, 0.5});
    if (request.measures_loss || request.limits.any()) {
        const auto stages = static_cast<double>(2 + options.levels);
        plan.push_back(
            {"loss",
             fmt::format("{} views with 3 lights{}", 12 + request.more_views.size(),
                         request.limits.any() ? "; if a limit does not hold, the stages run again, "
                                                "in at most 6 attempts"
                                              : ""),
             costs.loss + costs.loss_of_source * dense + costs.loss_of_stage * stages, 0.8});
    }
    if (!request.from.empty()) {
        constexpr std::array<std::string_view, 4> always = {"read", "write", "verify", "loss"};
        std::erase_if(plan, [&](const PlannedStage& stage) {
            if (std::ranges::find(always, stage.name) != always.end()) return false;
            if (stage.name == "remesh") return request.from != "remesh";
            if (stage.name == "repair") return request.from == "write";
            return stage_number(stage.name) < stage_number(request.from);
        });
    }
    return plan;
}

unsigned threads_of(unsigned requested) {
    return requested != 0 ? requested : std::max(1U, std::thread::hardware_concurrency());
}

namespace {

double seconds_of(const PlannedStage& stage, unsigned threads) {
    return stage.processor_seconds * (1.0 - stage.parallel + stage.parallel / threads);
}

}  // namespace

std::vector<std::string> lines_of(const std::vector<PlannedStage>& plan, unsigned threads) {
    std::vector<std::string> lines;
    double all = 0.0;
    for (const PlannedStage& stage : plan) {
        const double seconds = seconds_of(stage, threads);
        all += seconds;
        lines.push_back(
            fmt::format("{:<9} about {:>7}  {}", stage.name, duration(1e3 * seconds), stage.text));
    }
    lines.push_back(fmt::format("{:<9} about {:>7}  on {}; estimates may be wrong by a factor of 2",
                                "all", duration(1e3 * all), counted(threads, "thread")));
    return lines;
}

Json plan_json(const std::vector<PlannedStage>& plan, unsigned threads) {
    return json_list(plan, [&](const PlannedStage& stage) -> Json {
        return {{"stage", stage.name},
                {"text", stage.text},
                {"milliseconds", 1e3 * seconds_of(stage, threads)},
                {"processor_milliseconds", 1e3 * stage.processor_seconds}};
    });
}

}  // namespace relief::tools
