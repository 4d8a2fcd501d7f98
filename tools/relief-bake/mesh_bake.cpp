// SPDX-License-Identifier: Apache-2.0
// Bakes maps from files to files: reads the models, plans the maps, bakes them one after another,
// and then renames the finished files; and the summary of `relief-bake mesh`.
// Tests: tests/tools/relief_bake_mesh_test.cpp, relief_bake_accuracy_test.cpp.

#include "mesh_bake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <set>
#include <vector>

#include "common/file_jobs.h"
#include "common/options.h"
#include "common/summary.h"
#include "file_replacement.h"
#include "mesh_preview.h"
#include "relief/mesh/statistics.h"

namespace relief::tools {
using namespace relief::accuracy;

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
    all.thickness_rays += more.thickness_rays;
    all.open_thickness_rays += more.open_thickness_rays;
}

/// A baked map whose files are complete but not in the FileSet yet. They are deleted unless
/// finished.
class PendingMap {
  public:
    PendingMap(const MeshBakeRequest& request, const BakeFacts& facts, MapPlan plan,
               const BakeOptions& options, std::size_t index, const MapSource& source,
               const NormalMapFormat& format)
        : width_(request.size.x), map_{std::move(plan), {}, {}, {}} {
        BakeMapOptions map = map_options(options, map_.plan);
        map.measures_missed = true;
        map_.layers = planned_layers(request, map_.plan, facts);
        writer_.emplace(request, map_.plan, format, map_.layers, of_files_);
        map_.result = source(
            index, map, [&](const BakedRows& rows) { writer_->write(rows); }, report_);
        writer_->complete();
    }
    PendingMap(const PendingMap&) = delete;
    PendingMap& operator=(const PendingMap&) = delete;

    [[nodiscard]] const BakedMap& map() const { return map_; }

    /// Adds the files to the FileSet.
    BakedMap finish(Findings& findings) {
        writer_->finish();
        report_.merge(of_files_);
        findings.add(map_.plan.name(), report_, width_);
        return std::move(map_);
    }

  private:
    int width_;
    Report report_;
    Report of_files_;  ///< Apart, so that the order of findings does not depend on strips.
    BakedMap map_;
    std::optional<MapWriter> writer_;
};

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

}  // namespace

void check_outputs(const MeshBakeRequest& request, const std::vector<MapPlan>& plans,
                   const std::vector<std::filesystem::path>& files) {
    std::vector<std::filesystem::path> outputs;
    for (const MapPlan& plan : plans) {
        outputs.push_back(plan.output);
        for (const auto& [kind, file] : request.layers.files)
            outputs.push_back(plan.named(file));
    }
    std::set<std::filesystem::path> inputs;
    for (const std::filesystem::path& file : files)
        inputs.insert(identity_of(file));
    for (const std::filesystem::path& output : outputs) {
        if (inputs.contains(identity_of(output))) {
            throw UsageError(
                fmt::format("{}: would replace a texture of a high model", output.string()),
                "choose another output file");
        }
    }
    check(request.report, outputs);
    outputs.insert(outputs.end(), files.begin(), files.end());
    check(request.preview, outputs);
}

namespace {

void draw_preview(MeshPreview& preview, const MeshBakeRequest& request, const MeshBake& bake,
                  BakeModels models) {
    const bool is_tangent = request.bake.space == VectorSpace::tangent;
    const bool has_object_axes = request.bake.space == VectorSpace::object && models.world_from_low;
    std::vector<PreviewMap> maps;
    for (const BakedMap& map : bake.maps) {
        // An engine repeats a map on triangles outside of it.
        const bool is_exceeded = map.plan.tile != glm::ivec2(0) || map.plan.is_exceeded;
        maps.push_back({.file = map.plan.output,
                        .triangles = map.plan.triangles,
                        .repeats = is_exceeded || request.bake.map.placement.repeat});
    }
    preview.draw(
        request.preview,
        {.high = std::move(models.high),
         .high_materials = models.textures.materials(),
         .low = std::move(models.low),
         .world_from_low = has_object_axes ? *models.world_from_low : glm::dmat3(1.0),
         .shows_back_faces = request.bake.back_faces == BackFaces::take},
        maps,
        {.format = bake.format, .space = is_tangent ? NormalSpace::tangent : NormalSpace::object});
}

/// The maps of a bake that glTF materials have.
std::vector<MaterialMap> material_maps(const MeshBakeRequest& request, const MapPlan& plan) {
    std::vector<MaterialMap> maps = {{TextureSlot::normal, plan.output}};
    const auto add = [&](LayerKind kind, TextureSlot slot) {
        const auto file = request.layers.files.find(kind);
        if (file != request.layers.files.end()) maps.push_back({slot, plan.named(file->second)});
    };
    add(LayerKind::occlusion, TextureSlot::occlusion);
    add(LayerKind::color, TextureSlot::base_color);
    return maps;
}

}  // namespace

MaterialRequest material_request(const MeshBakeRequest& request, const std::vector<MapPlan>& plans,
                                 const std::optional<BakedAlpha>& alpha) {
    const std::filesystem::path& model = *request.write_into.model;
    const bool exists = std::filesystem::exists(model);
    MaterialRequest wanted;
    wanted.input = exists ? model : request.low;
    wanted.output = model;
    wanted.are_baked = true;
    wanted.assumed = {MapKind::normal, MapKind::occlusion, MapKind::color};
    wanted.embeds = request.write_into.embed;
    if (request.layers.has(LayerKind::color)) wanted.alpha = alpha;
    // A map of the whole low model belongs to all of its materials.
    wanted.all_materials = !exists || identity_of(model) == identity_of(request.low);
    for (const MapPlan& plan : plans) {
        wanted.materials.push_back({plan.material ? plan.material : request.write_into.material,
                                    material_maps(request, plan)});
    }
    return wanted;
}

void write_into(const MaterialRequest& request, Stages& stages, MeshBake& bake) {
    bake.stored = store_maps(request, stages);
    for (const PlacedFinding& placed : bake.stored->findings.all()) {
        Report report;
        report.add(placed.finding);
        bake.findings.add(placed.where, report, placed.map_width);
    }
}

namespace {

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

}  // namespace

void describe_models(const MeshBakeRequest& request, const BakeModels& models, MeshBake& bake) {
    for (const Mesh& mesh : models.high)
        bake.high_triangles += mesh.triangles.size();
    bake.low_triangles = models.low.triangles.size();
    bake.has_file_tangents = !models.low.tangents.empty();
    for (const BakePair& pair : models.pairs)
        bake.pairs.push_back({pair.name, pair.high_triangles, pair.low.size()});
    bake.unpaired = models.unpaired;
    bake.textures = models.textures.description();
    bake.alpha = models.textures.alpha();
    bake.origin = models.origin;
    if (request.layers.has(LayerKind::height))
        bake.texel_size = mean_texel_size(models.low, request.size);
}

PreparedBake prepare_bake(const MeshBakeRequest& request, const BakeModels& models, Stages& stages,
                          MeshBake& bake, bool estimates_missed) {
    PreparedBake prepared;
    prepared.plans = plan_maps(request, models.low, models.materials);
    const std::vector<MapPlan>& plans = prepared.plans.maps;
    bake.materials = prepared.plans.materials;
    bake.findings.add("", prepared.plans.report);
    check_outputs(request, plans, models.files);
    if (request.write_into.model) {
        prepared.materials = material_request(request, plans, models.textures.alpha());
        check_materials(*prepared.materials);
    }
    BakeOptions& options = prepared.options;
    options = bake_options_of(request);
    options.map_count = plans.size();
    options.output_from_mesh = output_axes(request, models.world_from_low);
    options.map.layers.position_from_mesh[3] = glm::dvec4(models.origin, 1.0);
    options.materials = models.textures.materials();
    options.ids = models.ids;
    options.map.layers.opacity = options.map.layers.colors && models.textures.alpha();
    options.cage = models.cage;
    stages.run("bake", [&] {
        Report report;
        prepared.baker.emplace(make_baker(request, models, options, report));
        bake.findings.add("", report);
        if (!estimates_missed) return;
        for (const MapPlan& plan : plans) {
            check_missed_early(request, models, *prepared.baker, map_options(options, plan),
                               plan.name());
        }
    });
    const Baker& baker = *prepared.baker;
    bake.fit = baker.fit();
    bake.agreement = baker.agreement();
    prepared.facts = {baker.bounds(options.map.layers), baker.ids(), options.map.layers.opacity,
                      baker.distances()};
    return prepared;
}

void write_maps(const MeshBakeRequest& request, const BakeFacts& facts, std::vector<MapPlan> plans,
                const BakeOptions& options, const MapSource& source,
                const std::function<FileError()>& uncovered, MeshBake& bake) {
    std::vector<std::unique_ptr<PendingMap>> pending;
    std::size_t covered = 0;  // Texels of all maps.
    for (std::size_t i = 0; i < plans.size(); ++i) {
        pending.push_back(std::make_unique<PendingMap>(request, facts, std::move(plans[i]), options,
                                                       i, source, bake.format));
        const BakedMap& map = pending.back()->map();
        check_missed(request, bake.fit, bake.origin, map.plan.name(), map.result);
        covered += map.result.texels_baked + map.result.texels_missed;
    }
    if (covered == 0) throw uncovered();
    for (const std::unique_ptr<PendingMap>& map : pending) {
        bake.maps.push_back(map->finish(bake.findings));
        add_result(bake.all, bake.maps.back().result);
    }
}

namespace {

/// The steps after the models are read.
void bake_models(const MeshBakeRequest& request, const BakeModels& models, Stages& stages,
                 MeshBake& bake) {
    PreparedBake prepared = prepare_bake(request, models, stages, bake);
    const Baker& baker = *prepared.baker;
    BakeOptions& options = prepared.options;
    MeshBakeRequest settled = request;  // With the selected samples.
    if (request.measures_errors()) {
        stages.run("choose", [&] {
            bake.accuracy = measure_errors(baker, map_options(options, prepared.plans.maps.front()),
                                           settled, bake.format);
        });
        const BakeOptions selected = bake_options_of(settled);
        options.map.samples = selected.map.samples;
        options.map.sample_angle = selected.map.sample_angle;
    }
    relief::detail::FileSet outputs;
    stages.run("bake", [&] {
        MapProgress progress(stages, prepared.plans.maps.size());
        const MapSource source = [&](std::size_t, const BakeMapOptions& map, const auto& take,
                                     Report& report) {
            BakeMapOptions shown = map;
            shown.progress = progress.next_map(map.height);
            return baker.bake(shown, take, report);
        };
        write_maps(
            settled, prepared.facts, std::move(prepared.plans.maps), options, source,
            [&] { return uncovered_error(request, models.low); }, bake);
    });
    if (prepared.materials) write_into(*prepared.materials, stages, bake);
    outputs.commit();
    if (request.verify)
        stages.run("verify", [&] { verify_all(settled, baker, models, options, bake); });
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

// The summary.

namespace {

/// The rays per second of the whole bake, including encoding and writing, in millions.
double megarays_per_second(const MeshBake& bake, const Stages& stages) {
    const double milliseconds = stages.milliseconds("bake");
    return milliseconds > 0 ? static_cast<double>(bake.all.rays) / milliseconds / 1000 : 0;
}

// Text.

std::string ray_text(const MeshBakeRequest& request, const BakeResult& result) {
    const std::string heights = result.texels_baked == 0
                                    ? ""
                                    : fmt::format("; the surface is {:.4g} to {:.4g} outside",
                                                  result.min_height, result.max_height);
    if (request.cage) return "from the cage" + heights;
    const bool is_given = request.bake.offset && request.bake.max_distance;
    return fmt::format("from {:.4g} outside to {:.4g} inside{}{}", result.distances.offset,
                       result.distances.max_distance, is_given ? "" : " (automatic)", heights);
}

std::string space_text(const MeshBakeRequest& request, const MeshBake& bake) {
    if (request.bake.space == VectorSpace::object) return "object space";
    if (request.bake.space == VectorSpace::world) return "world space";
    return bake.has_file_tangents ? "tangent space, with the model's tangents"
                                  : "tangent space, with MikkTSpace tangents";
}

/// "a, b, c"; long lists end with "...".
std::string join_names(std::vector<std::string> names) {
    constexpr std::size_t max_names = 8;
    if (names.size() > max_names) {
        names.resize(max_names);
        names.emplace_back("...");
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

/// The name of the map and a colon, if there are several maps.
std::string prefix_of(const BakedMap& map) {
    const std::string name = map.plan.name();
    return name.empty() ? "" : name + ": ";
}

std::vector<std::string> read_lines(const MeshBakeRequest& request, const MeshBake& bake) {
    const std::string high =
        request.high.size() == 1 ? request.high[0].string() : counted(request.high.size(), "model");
    std::vector<std::string> lines = {
        fmt::format("{}: {}{}{}", high, counted(bake.high_triangles, "triangle"),
                    bake.textures.empty() ? "" : ", ", bake.textures),
        fmt::format("{}: {}", request.low.string(), counted(bake.low_triangles, "triangle"))};
    if (!bake.pairs.empty()) {
        std::vector<std::string> names;
        for (const PairCount& pair : bake.pairs)
            names.push_back(pair.name);
        const std::string count = counted(names.size(), "part");
        lines.push_back(fmt::format("{} matched by name: {}", count, join_names(std::move(names))));
    }
    if (!bake.unpaired.empty())
        lines.push_back("not matched by name: no counterpart for " + join_names(bake.unpaired));
    return lines;
}

std::vector<std::string> map_lines(const MeshBakeRequest& request, const MeshBake& bake) {
    std::vector<std::string> lines;
    for (const BakedMap& map : bake.maps) {
        lines.push_back(fmt::format(
            "{}{} x {}: {} baked, {} missed", prefix_of(map), request.size.x, request.size.y,
            counted(map.result.texels_baked, "texel"), map.result.texels_missed));
    }
    return lines;
}

std::vector<std::string> all_missed_lines(const MeshBakeRequest& request, const MeshBake& bake) {
    std::vector<std::string> lines;
    for (const BakedMap& map : bake.maps) {
        for (const std::string& line : missed_lines(request, map.result, bake.origin))
            lines.push_back(prefix_of(map) + line);
    }
    return lines;
}

/// "auto 2" or "16", for the table.
std::string sample_cell(const MeasuredBake& bake) {
    return bake.sampling.sample_degrees ? fmt::format("auto {:g}", *bake.sampling.sample_degrees)
                                        : fmt::format("{}", bake.sampling.samples);
}

/// The table of --compare, sorted by error.
std::vector<std::string> comparison_table(const BakeComparison& accuracy) {
    std::vector<const MeasuredBake*> rows;
    for (const MeasuredBake& bake : accuracy.measured)
        rows.push_back(&bake);
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto* a, const auto* b) { return a->error.rms < b->error.rms; });
    std::vector<std::string> lines = {
        fmt::format("{:<9} {:<4} {:<10} {:>9} {:>9} {:>9} {:>9} {:>9}", "samples", "bits", "dither",
                    "RMS deg", "99% deg", "max deg", "time", "MRays/s")};
    for (const MeasuredBake* row : rows) {
        const double rate =
            row->seconds > 0.0 ? static_cast<double>(row->rays) / row->seconds / 1e6 : 0.0;
        lines.push_back(
            fmt::format("{:<9} {:<4} {:<10} {:>9.3g} {:>9.3g} {:>9.3g} {:>9} {:>9.2f} {}",
                        sample_cell(*row), row->format.bits, enum_name(row->format.dither),
                        row->error.rms, row->error.p99, row->error.max,
                        duration(1000.0 * row->seconds), rate, row->is_pareto_optimal ? "*" : ""));
    }
    lines.emplace_back("* no other method is both faster and more accurate");
    lines.emplace_back("auto: 4 samples, and 16 if they differ by more than this angle in degrees");
    for (std::string& line : lines)
        line.erase(line.find_last_not_of(' ') + 1);
    return lines;
}

/// The steps of --max-error: a line for each number of samples.
std::vector<std::string> step_lines(const MeshBakeRequest& request,
                                    const BakeComparison& accuracy) {
    std::vector<std::string> lines;
    const MeasuredBake* previous = nullptr;
    for (const MeasuredBake& bake : accuracy.measured) {
        const bool is_new =
            previous == nullptr || previous->sampling.samples != bake.sampling.samples;
        const auto bytes = std::uintmax_t{3} * static_cast<unsigned>(bake.format.bits / 8) *
                           static_cast<unsigned>(request.size.x) *
                           static_cast<unsigned>(request.size.y);
        const std::string error = fmt::format(
            "{:.3g} degrees ({}) in {} bit (at most {})", request.bound.error(bake.error),
            statistic_name(request.bound.statistic()), bake.format.bits, byte_size(bytes));
        if (is_new) {
            lines.push_back(fmt::format(
                "{}, {} rays in {}: {}",
                bake.sampling.sample_degrees
                    ? std::string("auto samples")
                    : counted(static_cast<std::size_t>(bake.sampling.samples), "sample"),
                bake.rays, duration(1000.0 * bake.seconds), error));
        } else {
            lines.back() += ", " + error;
        }
        previous = &bake;
    }
    return lines;
}

/// "out/height.png: height map, 16 bit, -0.1 to 0.1"
std::string layer_text(const WrittenLayer& layer) {
    const LayerCoding& coding = layer.coding;
    std::string text =
        fmt::format("{}: {}, {}", layer.file.string(), enum_name(coding.kind),
                    coding.bits == 32 ? "float" : fmt::format("{} bit", coding.bits));
    if (coding.bits != 32 && coding.is_signed())
        text += fmt::format(", {:.6g} to {:.6g}", -coding.range, coding.range);
    if (coding.bits != 32 && coding.kind == LayerKind::color) text += ", sRGB";
    if (coding.bits != 32 && coding.kind == LayerKind::thickness)
        text += fmt::format(", 0 to {:.6g}", coding.range);
    if (layer.has_opacity) text += ", opacity in alpha";
    return text;
}

bool has_layer(const MeshBake& bake, LayerKind kind) {
    return std::ranges::any_of(bake.maps.front().layers, [&](const WrittenLayer& layer) {
        return layer.coding.kind == kind;
    });
}

std::vector<std::string> layer_lines(const MeshBake& bake) {
    std::vector<std::string> lines;
    for (const BakedMap& map : bake.maps) {
        for (const WrittenLayer& layer : map.layers)
            lines.push_back(layer_text(layer));
    }
    for (const WrittenLayer& layer : bake.maps.front().layers) {
        const LayerCoding& coding = layer.coding;
        if (coding.kind == LayerKind::id) lines.push_back("ids: " + id_text(coding.ids));
        if (coding.kind != LayerKind::height) continue;
        lines.push_back(fmt::format("heights as a displacement: strength {:.7g}, midlevel {:.7g}",
                                    coding.strength(), coding.midlevel()));
        if (bake.texel_size > 0.0) {
            lines.push_back(
                fmt::format("heights for relief-bake bump: --height {:.7g} --texel-size {:.5g}",
                            coding.strength(), bake.texel_size));
        }
    }
    if (bake.all.occlusion_rays > 0) {
        const bool has_occlusion = has_layer(bake, LayerKind::occlusion);
        const bool has_bent = has_layer(bake, LayerKind::bent_normal);
        lines.push_back(fmt::format("{} rays for {}", bake.all.occlusion_rays,
                                    !has_occlusion ? "bent normals"
                                    : has_bent     ? "occlusion and bent normals"
                                                   : "occlusion"));
    }
    if (bake.all.thickness_rays > 0) {
        lines.push_back(fmt::format("{} rays for thickness, of which {} hit nothing",
                                    bake.all.thickness_rays, bake.all.open_thickness_rays));
    }
    return lines;
}

std::vector<std::string> written_files(const MeshBakeRequest& request, const MeshBake& bake) {
    std::vector<std::string> files;
    for (const BakedMap& map : bake.maps) {
        files.push_back(file_and_size(map.plan.output));
        for (const WrittenLayer& layer : map.layers)
            files.push_back(file_and_size(layer.file));
    }
    if (request.preview.file) {
        files.push_back(file_and_size(*request.preview.file) +
                        " (high, low with the map, low without)");
    }
    if (bake.stored) files.push_back(file_and_size(*request.write_into.model));
    return files;
}

// JSON.

Json point_json(const glm::dvec3& point) {
    return {point.x, point.y, point.z};
}

Json clipped_json(const ClippedRays& clipped) {
    return {{"texels", clipped.texels},
            {"shortest", clipped.shortest},
            {"half", clipped.half},
            {"longest", clipped.longest}};
}

Json missed_json(const BakeResult& result, const glm::dvec3& origin) {
    const auto texel_json = [&](const MissedTexel& texel) -> Json {
        return {{"x", texel.x}, {"y", texel.y}, {"position", point_json(texel.position + origin)}};
    };
    return {{"percent", missed_percent(result.texels_missed, result.texels_baked)},
            {"first", json_list(result.first_missed, texel_json)},
            {"from_behind", result.missed_from_behind},
            {"clipped_outside", clipped_json(result.clipped_outside)},
            {"clipped_inside", clipped_json(result.clipped_inside)},
            {"measuring_rays", result.measuring_rays}};
}

Json agreement_json(const BakeAgreement& agreement) {
    const auto degrees = [](double angle) { return angle * 180.0 / std::numbers::pi; };
    Json json = {{"rays", agreement.samples},
                 {"missed", agreement.missed},
                 {"from_behind", agreement.from_behind},
                 {"median_distance", agreement.median_distance},
                 {"mean_degrees", degrees(agreement.mean_angle)}};
    if (const std::optional<BakeCorrection>& correction = agreement.correction) {
        json["correction"] = {{"scale", correction->scale},
                              {"shift", point_json(correction->shift)},
                              {"median_distance", correction->median_distance},
                              {"mean_degrees", degrees(correction->mean_angle)}};
    }
    return json;
}

/// The bounding boxes in world space, their gap and the ratio of their sizes.
Json boxes_json(const BakeFit& fit, const glm::dvec3& origin) {
    const auto box_json = [&](const Bounds& box) -> Json {
        if (box.empty()) return nullptr;
        return {{"min", point_json(glm::dvec3(box.min) + origin)},
                {"max", point_json(glm::dvec3(box.max) + origin)}};
    };
    return {{"high", box_json(fit.high)},
            {"low", box_json(fit.low)},
            {"gap", fit.gap},
            {"size_ratio", fit.size_ratio}};
}

Json layer_json(const WrittenLayer& layer) {
    const LayerCoding& coding = layer.coding;
    Json json = {{"content", enum_name(coding.kind)},
                 {"output", layer.file.string()},
                 {"bits", coding.bits}};
    if (coding.bits != 32 && coding.is_signed()) {
        json["range"] = coding.range;
        json["zero"] = coding.zero_code();
    }
    if (coding.bits != 32 && coding.kind == LayerKind::thickness) json["range"] = coding.range;
    if (coding.kind == LayerKind::id) json["ids"] = ids_json(coding.ids);
    if (coding.kind == LayerKind::height) {
        json["strength"] = coding.strength();
        json["midlevel"] = coding.midlevel();
    }
    return json;
}

Json map_json(const BakedMap& map, const glm::dvec3& origin) {
    Json json = {{"output", map.plan.output.string()}};
    if (map.plan.material) json["material"] = *map.plan.material;
    if (map.plan.udim) json["tile"] = *map.plan.udim;
    json.update({{"texels_baked", map.result.texels_baked},
                 {"texels_missed", map.result.texels_missed},
                 {"min_height", map.result.min_height},
                 {"max_height", map.result.max_height},
                 {"samples", map.result.samples},
                 {"rays", map.result.rays},
                 {"missed", missed_json(map.result, origin)}});
    if (map.verified) json["check"] = summary_of(*map.verified).json();
    for (const WrittenLayer& layer : map.layers)
        json["layers"].push_back(layer_json(layer));
    return json;
}

Json measured_json(const MeasuredBake& bake) {
    return {{"samples", bake.sampling.sample_degrees ? Json("auto") : Json(bake.sampling.samples)},
            {"sample_angle", or_null(bake.sampling.sample_degrees)},
            {"bits", bake.format.bits},
            {"dither", enum_name(bake.format.dither)},
            {"rms", bake.error.rms},
            {"mean", bake.error.mean},
            {"p99", bake.error.p99},
            {"max", bake.error.max},
            {"rounding", bake.quantization.rms},
            {"sampling", bake.sampling_error.rms},
            {"rays", bake.rays},
            {"milliseconds", 1000.0 * bake.seconds},
            {"efficient", bake.is_pareto_optimal}};
}

void add_accuracy(Summary& summary, const MeshBakeRequest& request,
                  const BakeComparison& accuracy) {
    const Json measured = json_list(accuracy.measured, measured_json);
    if (accuracy.selected) {
        const MeasuredBake& selected = *accuracy.selected;
        summary.add("steps", step_lines(request, accuracy), {{"steps", measured}});
        summary.add("selected",
                    fmt::format("{}: {}", to_string(selected), to_string(selected.error)),
                    {{"selected", measured_json(selected)}});
    }
    summary.add("errors",
                fmt::format("measured on {} of the map, against {} samples per texel",
                            accuracy.is_whole ? "all" : fmt::format("{} texels", accuracy.texels),
                            accuracy.reference_samples),
                {{"reference",
                  {{"samples", accuracy.reference_samples},
                   {"rays", accuracy.reference_rays},
                   {"texels", accuracy.texels},
                   {"whole", accuracy.is_whole}}}});
    if (!accuracy.selected) summary.add("", comparison_table(accuracy), {{"comparison", measured}});
}

}  // namespace

std::string shared_texels_warning(const MeshBakeRequest& request, const MeshBake& bake) {
    if (bake.materials < 2 || bake.all.coverage.shared == 0 || bake.maps.front().plan.material)
        return "";
    return fmt::format(
        "{}: {} share one map, in which some texels belong to several triangles "
        "(<material> in the map's name writes a map for each material)",
        request.low.string(), counted(bake.materials, "material"));
}

Summary summary_of(const MeshBakeRequest& request, const MeshBake& bake, const Stages& stages) {
    const BakeResult& result = bake.all;
    const NormalMapFormat& format = bake.format;
    const double rate = megarays_per_second(bake, stages);
    const auto file_name = [](const std::filesystem::path& file) { return file.string(); };
    const auto pair_json = [](const PairCount& pair) -> Json {
        return {{"name", pair.name},
                {"high_triangles", pair.high_triangles},
                {"low_triangles", pair.low_triangles}};
    };
    Summary summary;
    summary.add_tool("relief-bake mesh");
    summary.add("read", read_lines(request, bake),
                {{"high", json_list(request.high, file_name)},
                 {"low", request.low.string()},
                 {"output", request.output.string()},
                 {"high_triangles", bake.high_triangles},
                 {"low_triangles", bake.low_triangles},
                 {"boxes", boxes_json(bake.fit, bake.origin)},
                 {"agreement", agreement_json(bake.agreement)},
                 {"pairs", json_list(bake.pairs, pair_json)}});
    summary.add(
        "rays",
        {ray_text(request, result), fmt::format("{} for {}, {:.2f} million per second", result.rays,
                                                counted(result.samples, "sample"), rate)},
        {{"offset", result.distances.offset},
         {"max_distance", result.distances.max_distance},
         {"min_height", result.min_height},
         {"max_height", result.max_height},
         {"samples", result.samples},
         {"rays", result.rays},
         {"occlusion_rays", result.occlusion_rays},
         {"thickness_rays", result.thickness_rays},
         {"open_thickness_rays", result.open_thickness_rays},
         {"rays_per_second", rate * 1e6}});
    summary.add(bake.maps.size() == 1 ? "map" : "maps", map_lines(request, bake),
                {{"width", request.size.x},
                 {"height", request.size.y},
                 {"texels_baked", result.texels_baked},
                 {"texels_missed", result.texels_missed},
                 {"maps", json_list(bake.maps, [&](const BakedMap& map) {
                      return map_json(map, bake.origin);
                  })}});
    summary.add("missed", all_missed_lines(request, bake));
    const char* const stored =
        is_texture(request.output) ? ", stored as a texture with all mip levels" : "";
    summary.add("format",
                fmt::format("{}, {}{}", space_text(request, bake), to_string(format), stored),
                {{"space", enum_name(request.bake.space)},
                 {"bits", format.bits},
                 {"green", enum_name(format.green)},
                 {"zero_code", enum_name(format.flat)},
                 {"dither", enum_name(format.dither)}});
    if (bake.accuracy) add_accuracy(summary, request, *bake.accuracy);
    for (const BakedMap& map : bake.maps) {
        if (map.verified) summary.add_lines(summary_of(*map.verified));
    }
    summary.add("layers", layer_lines(bake));
    if (bake.stored) summary.add_part("stored", summary_of(*bake.stored));
    summary.add_findings(bake.findings);
    summary.add_times(stages);
    summary.add("wrote", written_files(request, bake));
    if (request.preview.file) summary.add_json({{"preview", request.preview.file->string()}});
    return summary;
}

}  // namespace relief::tools
