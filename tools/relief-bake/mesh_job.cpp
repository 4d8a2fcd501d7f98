// SPDX-License-Identifier: Apache-2.0
// Bakes maps from files to files: reads the models, plans the maps, bakes them one after another,
// and then renames the finished files. Tests: tests/tools/relief_bake_mesh_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "mesh_bake.h"
#include "mesh_preview.h"
#include "relief/mesh/timing.h"

namespace relief::tools {
namespace {

/// Shows the progress of all maps on a terminal.
class MapProgress {
  public:
    MapProgress(Stages& stages, std::size_t maps) : stages_(stages), maps_(maps) {}

    /// The callback for the next map; empty if there is no terminal.
    std::function<void(const BakeProgress&)> next_map(int height) {
        rays_before_ += rays_;
        rays_ = 0;
        const std::size_t index = begun_++;
        if (!stages_.shows_progress()) return {};
        return [this, index, height](const BakeProgress& progress) {
            rays_ = progress.rays;
            const double part = (static_cast<double>(index) +
                                 static_cast<double>(progress.rows) / static_cast<double>(height)) /
                                static_cast<double>(maps_);
            stages_.show_progress("bake", part,
                                  progress_text(part, stopwatch_.seconds(), rays_before_ + rays_));
        };
    }

  private:
    Stages& stages_;
    std::size_t maps_;
    std::size_t begun_ = 0;
    std::size_t rays_before_ = 0;  ///< Of the finished maps.
    std::size_t rays_ = 0;         ///< Of the current map.
    Stopwatch stopwatch_;
};

/// Adds the result of one map to the sums and extremes over all maps.
void add_result(BakeResult& all, const BakeResult& more) {
    if (more.texels_baked > 0) {
        const bool is_first = all.texels_baked == 0;
        all.min_height = is_first ? more.min_height : std::min(all.min_height, more.min_height);
        all.max_height = is_first ? more.max_height : std::max(all.max_height, more.max_height);
    }
    all.distances = more.distances;
    all.coverage += more.coverage;
    all.texels_baked += more.texels_baked;
    all.texels_missed += more.texels_missed;
    all.samples += more.samples;
    all.rays += more.rays;
    all.occlusion_rays += more.occlusion_rays;
}

/// A baked map whose files are complete but not renamed yet. They are deleted unless finished.
class PendingMap {
  public:
    PendingMap(const MeshBakeRequest& request, const Baker& baker, MapPlan plan,
               const BakeOptions& options, MapProgress& progress, const NormalMapFormat& format)
        : map_{std::move(plan), {}, {}, {}} {
        BakeMapOptions map = map_options(options, map_.plan);
        map.progress = progress.next_map(request.size.y);
        map.measures_missed = true;
        map_.layers = planned_layers(request, map_.plan, baker, map.layers);
        writer_.emplace(request, map_.plan, format, map_.layers, report_);
        map_.result = baker.bake(
            map, [&](const BakedRows& rows) { writer_->write(rows); }, report_);
        writer_->complete();
    }
    PendingMap(const PendingMap&) = delete;
    PendingMap& operator=(const PendingMap&) = delete;

    [[nodiscard]] const BakedMap& map() const { return map_; }

    /// Renames the files.
    BakedMap finish(Findings& findings) {
        writer_->finish();
        findings.add(map_.plan.name(), report_);
        return std::move(map_);
    }

  private:
    Report report_;
    BakedMap map_;
    std::optional<MapWriter> writer_;
};

/// The error if a map cannot be renamed, with the maps that are finished.
FileError partial_failure(const MeshBake& bake, const Error& error, const std::size_t count) {
    std::string finished;
    for (const BakedMap& map : bake.maps)
        finished += (finished.empty() ? "" : ", ") + map.plan.output.string();
    return {bake.maps.back().plan.output.parent_path(),
            fmt::format("only {} of {} maps are written: {}; {}", bake.maps.size(), count, finished,
                        error.what())};
}

void bake_all(const MeshBakeRequest& request, const Baker& baker, const BakeModels& models,
              MapPlans plans, const BakeOptions& options, Stages& stages, MeshBake& bake) {
    MapProgress progress(stages, plans.maps.size());
    std::vector<std::unique_ptr<PendingMap>> pending;
    for (MapPlan& plan : plans.maps) {
        pending.push_back(std::make_unique<PendingMap>(request, baker, std::move(plan), options,
                                                       progress, bake.format));
        const BakedMap& map = pending.back()->map();
        check_missed(request, models, map.plan.name(), map.result);
    }
    for (const std::unique_ptr<PendingMap>& map : pending) {
        try {
            bake.maps.push_back(map->finish(bake.findings));
        } catch (const Error& error) {
            if (bake.maps.empty()) throw;
            throw partial_failure(bake, error, pending.size());
        }
        add_result(bake.all, bake.maps.back().result);
    }
}

void verify_all(const MeshBakeRequest& request, const Baker& baker, const BakeModels& models,
                const BakeOptions& options, MeshBake& bake) {
    for (BakedMap& map : bake.maps) {
        Report unused;  // The bake reported the same findings.
        map.verified = verify_map(
            baker, models, request, map_options(options, map.plan),
            {.map = map.plan.output, .bound = request.bound, .error_map = request.error_map},
            unused);
        Report report;
        for (const std::string& problem : map.verified->problems)
            report.add("map differs from its surface", "map", 0, problem);
        bake.findings.add(map.plan.name(), report);
    }
}

/// Checks that no planned map is the report or the preview.
void check_outputs(const MeshBakeRequest& request, const std::vector<MapPlan>& plans) {
    std::vector<std::filesystem::path> outputs;
    for (const MapPlan& plan : plans) {
        outputs.push_back(plan.output);
        for (const auto& [kind, file] : request.layers.files)
            outputs.push_back(plan.named(file));
    }
    check(request.report, outputs);
    check(request.preview, outputs);
}

void draw_preview(MeshPreview& preview, const MeshBakeRequest& request, const MeshBake& bake,
                  BakeModels models) {
    const bool is_tangent = request.space == SpaceChoice::tangent;
    const bool has_object_axes = request.space == SpaceChoice::object && models.world_from_low;
    std::vector<PreviewMap> maps;
    for (const BakedMap& map : bake.maps) {
        const bool is_tile = map.plan.tile != glm::ivec2(0);
        maps.push_back({.file = map.plan.output,
                        .triangles = map.plan.triangles,
                        .repeats = is_tile || request.bake.placement.repeat});
    }
    preview.draw(
        request.preview,
        {.high = std::move(models.high),
         .low = std::move(models.low),
         .world_from_low = has_object_axes ? *models.world_from_low : glm::dmat3(1.0),
         .shows_back_faces = request.bake.back_faces == BackFaces::take},
        maps,
        {.format = bake.format, .space = is_tangent ? NormalSpace::tangent : NormalSpace::object});
}

/// The mean side of a texel over the area of the map, in the unit of the mesh.
double mean_texel_size(const Mesh& low, const glm::ivec2& size) {
    double area = 0.0, texels = 0.0;
    for (const glm::uvec3& corners : low.triangles) {
        const glm::dvec3 a(low.positions[corners.x]);
        const double surface = glm::length(glm::cross(glm::dvec3(low.positions[corners.y]) - a,
                                                      glm::dvec3(low.positions[corners.z]) - a));
        const glm::dvec2 u = glm::dvec2(low.texcoords[corners.y] - low.texcoords[corners.x]);
        const glm::dvec2 v = glm::dvec2(low.texcoords[corners.z] - low.texcoords[corners.x]);
        const double covered = std::abs(u.x * v.y - u.y * v.x) * size.x * size.y;
        if (!std::isfinite(surface) || !std::isfinite(covered)) continue;
        area += surface;
        texels += covered;
    }
    return texels > 0.0 ? std::sqrt(area / texels) : 0.0;
}

/// The parts of the result that are known from the models.
void describe_models(const MeshBakeRequest& request, const BakeModels& models, MeshBake& bake) {
    for (const Mesh& mesh : models.high)
        bake.high_triangles += mesh.triangles.size();
    bake.low_triangles = models.low.triangles.size();
    bake.has_file_tangents = !models.low.tangents.empty();
    bake.pairs = models.pairs;
    bake.unpaired = models.unpaired;
    bake.textures = models.textures.description();
    bake.origin = models.origin;
    if (request.layers.has(LayerKind::height))
        bake.texel_size = mean_texel_size(models.low, request.size);
}

/// The steps after the models are read.
void bake_models(const MeshBakeRequest& request, const BakeModels& models, Stages& stages,
                 MeshBake& bake) {
    MapPlans plans = plan_maps(request, models.low, models.materials);
    bake.materials = plans.materials;
    bake.findings.add("", plans.report);
    check_outputs(request, plans.maps);
    BakeOptions options = bake_options_of(request);
    options.map_count = plans.maps.size();
    options.output_from_mesh = output_axes(request, models.world_from_low);
    options.layers.position_from_mesh[3] = glm::dvec4(models.origin, 1.0);
    options.details = models.textures.details();
    if (models.cage) options.cage = &*models.cage;
    std::optional<Baker> baker;
    stages.run("bake", [&] {
        Report report;
        baker.emplace(make_baker(request, models, options, report));
        bake.findings.add("", report);
        for (const MapPlan& plan : plans.maps)
            check_missed_early(request, models, *baker, map_options(options, plan), plan.name());
    });
    bake.fit = baker->fit();
    MeshBakeRequest settled = request;  // With the selected samples.
    if (request.needs_trials()) {
        stages.run("choose", [&] {
            bake.accuracy = select_accuracy(*baker, map_options(options, plans.maps.front()),
                                            settled, bake.format);
        });
        const BakeOptions selected = bake_options_of(settled);
        options.samples = selected.samples;
        options.sample_angle = selected.sample_angle;
    }
    stages.run("bake",
               [&] { bake_all(settled, *baker, models, std::move(plans), options, stages, bake); });
    if (request.verify)
        stages.run("verify", [&] { verify_all(settled, *baker, models, options, bake); });
}

}  // namespace

std::string progress_text(double part, double seconds, std::size_t rays) {
    const double rate = seconds > 0.0 ? static_cast<double>(rays) / seconds / 1e6 : 0.0;
    const std::string text = fmt::format("{:.1f} million rays per second", rate);
    if (seconds < 1.0 || part <= 0.0) return text;
    const double left = std::ceil(seconds / part * (1.0 - part));
    return text + (left < 120.0 ? fmt::format(", {:.0f} s left", left)
                                : fmt::format(", {:.0f} min left", std::ceil(left / 60.0)));
}

MeshBake bake_maps(const MeshBakeRequest& request, Stages& stages) {
    MeshBake bake;
    bake.format = format_of(request.map, request.output);
    std::optional<MeshPreview> preview;
    if (request.preview.file) stages.run("context", [&] { preview.emplace(); });
    BakeModels models =
        stages.run("read", [&] { return read_bake_models(request, bake.findings); });
    describe_models(request, models, bake);
    about(request.low, [&] { bake_models(request, models, stages, bake); });
    if (preview) {
        stages.run("preview", [&] { draw_preview(*preview, request, bake, std::move(models)); });
    }
    return bake;
}

}  // namespace relief::tools
