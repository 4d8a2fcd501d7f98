// SPDX-License-Identifier: Apache-2.0
// Makes an asset from file to file, and describes it. Tests: tests/tools/relief_make_test.cpp.
#include "make_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "common/model_file.h"
#include "file_replacement.h"
#include "make_baked.h"
#include "make_engine.h"
#include "make_loss.h"
#include "make_loss_meter.h"
#include "make_parts.h"
#include "make_remesh.h"
#include "make_stages.h"
#include "make_start.h"
#include "mesh_maps.h"
#include "relief/mesh/execution.h"

namespace relief::tools {
namespace {

/// Returns the largest memory that the process has used so far.
std::uint64_t peak_memory() {
    rusage use{};
    ::getrusage(RUSAGE_SELF, &use);
#if defined(__APPLE__)
    return static_cast<std::uint64_t>(use.ru_maxrss);
#else
    return 1024 * static_cast<std::uint64_t>(use.ru_maxrss);
#endif
}

/// Returns the processor time of this process, in all threads.
double processor_seconds() {
    rusage use{};
    ::getrusage(RUSAGE_SELF, &use);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return seconds(use.ru_utime) + seconds(use.ru_stime);
}

std::string atlas_text(const AtlasStats& stats, const glm::ivec2& size) {
    return fmt::format("{}, {:.1f} % of {} x {} texels used, mean stretch {:.3f}",
                       counted(stats.charts, "chart"), 100.0 * stats.used, size.x, size.y,
                       stats.stretch);
}

Json atlas_json(const AtlasStats& stats) {
    return {{"charts", stats.charts},
            {"used", stats.used},
            {"texels_per_unit", stats.texels_per_unit},
            {"stretch", stats.stretch},
            {"seam_length", stats.seam_length},
            {"safe_mip_level", or_null(stats.safe_mip_level)}};
}

/// ", opacity in alpha"
std::string map_note(const make::Asset& asset, const make::AssetMap& map) {
    if (map.name == "color" && map.image->channels == 4) return ", opacity in alpha";
    if (map.name == "emission" && asset.material.emission_strength != 1.0F)
        return fmt::format(", times {:.4g}", asset.material.emission_strength);
    const auto range = map.metadata.find("relief:range");
    if (map.slots.empty() && range != map.metadata.end()) {
        const double limit = std::stod(range->second);
        const bool is_signed = map.metadata.contains("relief:zero");
        return fmt::format(", {:.4g} to {:.4g}", is_signed ? -limit : 0.0, limit);
    }
    return "";
}

/// The factors of the material that no map multiplies.
std::string factors_text(const make::Asset& asset) {
    const GltfMaterial& material = asset.material;
    const MetallicRoughness& surface = *material.metallic_roughness;
    const auto color_text = [](const glm::vec3& color) {
        return fmt::format("({:.3g}, {:.3g}, {:.3g})", color.r, color.g, color.b);
    };
    std::vector<std::string> factors;
    if (!asset.color_map) factors.push_back("color " + color_text(surface.base_color));
    if (!asset.color_map && material.opacity < 1.0F)
        factors.push_back(fmt::format("opacity {:.3g}", material.opacity));
    if (!asset.surface_map) {
        factors.push_back(fmt::format("roughness {:.3g}", surface.roughness));
        factors.push_back(fmt::format("metalness {:.3g}", surface.metallic));
    }
    if (!asset.emission_map && material.emission_factor != glm::vec3(0.0F)) {
        factors.push_back("emission " +
                          color_text(material.emission_factor * material.emission_strength));
    }
    return fmt::format("{}", fmt::join(factors, ", "));
}

/// The factors with the names of scene files. The opacity is a factor of the color.
Json material_json(const GltfMaterial& material) {
    const auto color_json = [](const glm::vec3& color) -> Json {
        return {color.r, color.g, color.b};
    };
    const MetallicRoughness& surface = *material.metallic_roughness;
    return {{"base_color", color_json(surface.base_color)},
            {"opacity", material.opacity},
            {"roughness", surface.roughness},
            {"metallic", surface.metallic},
            {"emission", color_json(material.emission_factor)},
            {"emission_strength", material.emission_strength},
            {"alpha_mode", enum_name(material.alpha_mode)},
            {"double_sided", material.double_sided}};
}

std::size_t triangles_of(const make::Asset& asset, std::size_t material) {
    std::size_t count = 0;
    for (const MaterialRange& range : asset.mesh.material_ranges)
        count += range.material == material ? range.triangle_count : 0;
    return count;
}

/// "3 materials share the maps: 2300 triangles opaque, 600 cut below 0.5, 100 blended"
std::vector<std::string> material_lines(const make::Asset& asset) {
    if (asset.draw_modes.empty()) return {};
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < asset.draw_modes.size(); ++i) {
        const make::DrawMode& mode = asset.draw_modes[i];
        const std::size_t count = triangles_of(asset, i);
        const std::string alpha = mode.alpha_mode == AlphaMode::opaque ? "opaque"
                                  : mode.alpha_mode == AlphaMode::blend
                                      ? "blended"
                                      : fmt::format("cut below {:g}", mode.alpha_cutoff);
        texts.push_back(fmt::format(
            "{} {}{}", texts.empty() ? counted(count, "triangle") : fmt::to_string(count), alpha,
            mode.double_sided ? ", double-sided" : ""));
    }
    return {fmt::format("{} share the maps: {}", texts.size(), fmt::join(texts, "; "))};
}

Json materials_json(const make::Asset& asset) {
    Json materials = Json::array();
    const std::vector<make::DrawMode> modes = make::draw_modes_of(asset);
    for (std::size_t i = 0; i < modes.size(); ++i) {
        materials.push_back(
            {{"alpha_mode", enum_name(modes[i].alpha_mode)},
             {"alpha_cutoff",
              modes[i].alpha_mode == AlphaMode::mask ? Json(modes[i].alpha_cutoff) : Json()},
             {"double_sided", modes[i].double_sided},
             {"triangles",
              asset.draw_modes.empty() ? asset.mesh.triangles.size() : triangles_of(asset, i)}});
    }
    return materials;
}

bool has_layer(const make::Asset& asset, LayerKind kind) {
    return std::ranges::any_of(
        asset.layers, [&](const make::AssetLayer& layer) { return layer.coding.kind == kind; });
}

std::vector<std::string> map_lines(const MadeAsset& made) {
    const make::Asset& asset = made.asset;
    const BakeResult& bake = asset.bake;
    std::vector<std::string> lines = {fmt::format(
        "normals {} x {}{}: {} baked, {} missed; the source is {:.3g} to {:.3g} outside",
        asset.normal_map.width, asset.normal_map.height,
        asset.normal_map.bits() == 8 ? "" : ", 16 bits", counted(bake.texels_baked, "texel"),
        bake.texels_missed, bake.min_height, bake.max_height)};
    for (const make::AssetMap& map : make::maps_of(asset)) {
        if (map.name == "normal") continue;
        lines.push_back(fmt::format("{} {} x {}{}", map.content, map.image->width,
                                    map.image->height, map_note(asset, map)));
    }
    if (bake.occlusion_rays > 0) {
        const bool has_bent = has_layer(asset, LayerKind::bent_normal);
        const bool has_occlusion = asset.occlusion_map || asset.surface_has_occlusion;
        lines.push_back(fmt::format("{:.3g} million rays for {}",
                                    static_cast<double>(bake.occlusion_rays) / 1e6,
                                    !has_bent       ? "occlusion"
                                    : has_occlusion ? "occlusion and bent normals"
                                                    : "bent normals"));
    }
    if (bake.thickness_rays > 0) {
        lines.push_back(fmt::format("{:.3g} million rays for thickness, of which {} hit nothing",
                                    static_cast<double>(bake.thickness_rays) / 1e6,
                                    bake.open_thickness_rays));
    }
    for (const make::AssetLayer& layer : asset.layers) {
        if (layer.coding.kind == LayerKind::id)
            lines.push_back("ids: " + id_text(layer.coding.ids));
    }
    const std::string factors = factors_text(asset);
    if (!factors.empty()) lines.push_back("without a map: " + factors);
    return lines;
}

Json maps_json(const make::Asset& asset) {
    Json maps = Json::array();
    for (const make::AssetMap& map : make::maps_of(asset)) {
        Json json = {{"content", map.content},
                     {"width", map.image->width},
                     {"height", map.image->height},
                     {"bits", map.image->bits()}};
        const auto range = map.metadata.find("relief:range");
        if (range != map.metadata.end()) json["range"] = std::stod(range->second);
        const auto layer = std::ranges::find_if(asset.layers, [&](const make::AssetLayer& one) {
            return &one.image == map.image && one.coding.kind == LayerKind::id;
        });
        if (layer != asset.layers.end()) json["ids"] = ids_json(layer->coding.ids);
        maps.push_back(std::move(json));
    }
    return {{"maps", maps},
            {"material", material_json(asset.material)},
            {"materials", materials_json(asset)},
            {"texels_baked", asset.bake.texels_baked},
            {"texels_missed", asset.bake.texels_missed},
            {"rays", asset.bake.rays},
            {"occlusion_rays", asset.bake.occlusion_rays},
            {"thickness_rays", asset.bake.thickness_rays},
            {"open_thickness_rays", asset.bake.open_thickness_rays},
            {"min_height", asset.bake.min_height},
            {"max_height", asset.bake.max_height}};
}

std::vector<std::string> level_lines(const MadeAsset& made) {
    std::vector<std::string> lines;
    for (const make::AssetLevel& level : made.levels) {
        lines.push_back(fmt::format(
            "LOD{}: {}, largest distance {:.3g}, used below {:.4g} pixels, {:.3g} % of the screen",
            lines.size() + 1, counted(level.triangles, "triangle"), level.distance, level.pixels,
            100.0 * level.coverage));
    }
    return lines;
}

Json level_json(const make::AssetLevel& level) {
    return {{"triangles", level.triangles},
            {"distance", level.distance},
            {"pixels", level.pixels},
            {"coverage", level.coverage}};
}

std::vector<std::string> stage_lines(const MadeAsset& made, const Stages& stages) {
    std::vector<std::string> lines;
    double processor = 0.0;
    for (const StageUse& stage : made.stages) {
        const double milliseconds = stages.milliseconds(stage.stage);
        lines.push_back(fmt::format("{:<9}{:>9}{:>11}{:>11}", stage.stage, duration(milliseconds),
                                    duration(1e3 * stage.processor_seconds),
                                    byte_size(stage.peak_bytes)));
        processor += stage.processor_seconds;
    }
    lines.push_back(fmt::format("{:<9}{:>9}{:>11}   (time, processor time, peak memory so far)",
                                "all", duration(stages.milliseconds()), duration(1e3 * processor)));
    return lines;
}

Json stages_json(const MadeAsset& made, const Stages& stages) {
    return json_list(made.stages, [&](const StageUse& stage) -> Json {
        return {{"stage", stage.stage},
                {"milliseconds", stages.milliseconds(stage.stage)},
                {"processor_milliseconds", 1e3 * stage.processor_seconds},
                {"peak_bytes", stage.peak_bytes}};
    });
}

/// Makes an asset from file to file, once or until limits hold.
class FileMaker {
  public:
    FileMaker(const MakeRequest& request, const Job& job, Stages& stages)
        : request_(request), job_(job), stages_(stages) {}

    MadeAsset run();

  private:
    void run_stage(std::string_view name, const std::function<void()>& work);
    void read();
    void make_once();
    [[nodiscard]] bool measures_loss() const {
        return request_.measures_loss || request_.limits.any();
    }
    void measure_loss();
    void measure_stages();
    [[nodiscard]] bool holds_limits();
    void grow(const GrowthStep& step);

    MakeRequest request_;  ///< With what grows until limits hold.
    const Job& job_;
    Stages& stages_;
    make::AssetOptions& options_ = request_.asset;
    make::AssetSource source_;
    std::unique_ptr<LossMeter> meter_;              ///< Created when it is needed.
    bool only_codes_differ_ = false;                ///< The asset is that of the last attempt.
    std::vector<std::filesystem::path> map_files_;  ///< Beside the asset.
    StageLayouts layouts_;                          ///< Of the files of stages.
    Json record_;                                   ///< Of the files with which the job continues.
    MadeAsset made_;
};

void FileMaker::run_stage(std::string_view name, const std::function<void()>& work) {
    const std::string stage(name);
    const double before = processor_seconds();
    stages_.run(stage, work);
    auto use = std::ranges::find(made_.stages, stage, &StageUse::stage);
    if (use == made_.stages.end()) use = made_.stages.insert(use, {stage, 0, 0.0});
    use->peak_bytes = peak_memory();
    use->processor_seconds += processor_seconds() - before;
}

void FileMaker::read() {
    Progress opened;
    const ProgressScope scope(opened);
    source_ = read_source(dense_model(request_, job_), made_.source, made_.findings);
    source_.name = job_.output.stem().string();
    made_.inputs = names_of(opened.files());
    if (request_.from.empty()) return;
    Report report;
    record_ = read_stage_record(*request_.stages_folder);
    options_.start = read_start(record_, *request_.stages_folder, request_.from, request_,
                                made_.inputs, source_.origin, report);
    if (request_.from == "write")
        made_.asset = read_baked(request_, source_, std::move(*options_.start), record_, report);
    if (options_.start->mesh.triangles.empty() && request_.from == "remesh")
        options_.start.reset();  // All stages give what they gave before.
    made_.findings.add("read", report);
}

/// Makes, writes, verifies and, if requested, measures the asset.
void FileMaker::make_once() {
    made_.files.clear();
    std::optional<StageFiles> kept;
    Report of_kept;
    if (request_.stages_folder) {
        kept.emplace(*request_.stages_folder, options_);
        options_.take_mesh = [&](std::string_view stage, const make::StageMesh& mesh) {
            // The files of earlier stages stay as they are.
            if (stage == "repair" && options_.start) return;
            const std::filesystem::path file = kept->mesh_file(stage);
            std::erase(made_.files, file);  // Of a surface that was replaced.
            made_.files.push_back(file);
            layouts_[file.filename().string()] =
                make::write_stage_file(file, std::string(stage), mesh, source_.origin, of_kept);
        };
    }
    if (request_.from == "write") {
        // The asset was read.
    } else if (only_codes_differ_ && !kept) {
        // The other stages would compute the same again.
        made_.asset.normal_map = *std::exchange(made_.asset.baked_normals, std::nullopt);
    } else {
        made_.asset = about(job_.input, [&] { return make::make_asset(source_, options_); });
    }
    for (const make::StageReport& stage : made_.asset.reports) {
        made_.findings.add(stage.stage, stage.report, stage.stage == "bake" ? options_.size.x : 0);
    }
    run_stage("write", [&] {
        Report report;
        if (kept) {
            if (request_.from != "write") {
                for (const std::filesystem::path& file : kept->write_maps(made_.asset))
                    made_.files.push_back(file);
            }
            made_.files.push_back(write_stage_record(*request_.stages_folder, made_.asset, request_,
                                                     made_.inputs, layouts_, record_));
        }
        made_.levels = about(job_.input, [&] {
            return make::write_asset(job_.output, made_.asset, options_.levels, report);
        });
        map_files_ = write_map_files(request_.engine, job_.output, made_.asset);
        made_.findings.add("write", report);
        made_.findings.add("kept stages", of_kept);
    });
    run_stage("verify", [&] {
        const Report problems = make::verify_asset(job_.output, made_.asset);
        made_.findings.add("verify", problems);
    });
    if (measures_loss()) run_stage("loss", [&] { measure_loss(); });
}

/// Measures what was lost, or reports why that is not possible.
void FileMaker::measure_loss() {
    Report report;
    try {
        if (!meter_) {
            shade::FidelityOptions pictures;
            pictures.more_views = request_.more_views;
            meter_ =
                std::make_unique<LossMeter>(dense_model(request_, job_), job_.output, pictures);
        }
        made_.loss = meter_->measure(job_.output, report);
    } catch (const shade::GpuError& error) {
        if (request_.limits.any()) {
            throw FileError(job_.input, fmt::format("limits of the loss need its measurement: {}",
                                                    error.what()));
        }
        report.add("loss that cannot be measured", "asset", 0, error.what());
    }
    made_.findings.add("loss", report);
}

/// Measures the stages of an asset that is not made again.
void FileMaker::measure_stages() {
    if (!made_.loss) return;
    run_stage("loss", [&] {
        made_.loss->stages = meter_->measure_stages(job_.output, made_.asset, *made_.loss);
    });
    made_.asset.baked_normals.reset();
}

/// Notes what was lost. \throws FileError if a limit does not hold and nothing can grow
bool FileMaker::holds_limits() {
    if (!request_.limits.any()) return true;
    std::vector<LimitAttempt>& attempts = made_.attempts;
    const std::size_t triangles = std::min(options_.triangles, made_.asset.source_triangles);
    const shade::Fidelity& loss = made_.loss->fidelity;
    LimitAttempt& last = attempts.emplace_back(
        attempt_of(loss, request_.limits, triangles, options_.size, options_.normal_bits));
    if (!last.exceeded) return true;
    if (may_be_codes(last, request_.limits)) {
        run_stage("loss", [&] {
            note_baked(
                last, request_.limits, loss.sampled.normals,
                meter_->measure_with_normals(job_.output, *made_.asset.baked_normals).normals);
        });
    }
    last.next = next_growth(attempts, request_.limits, made_.asset.source_triangles);
    if (!last.next) throw FileError(job_.input, limits_error(request_.limits, attempts));
    return false;
}

void FileMaker::grow(const GrowthStep& step) {
    only_codes_differ_ = step.growth == Growth::bits;
    switch (step.growth) {
        case Growth::triangles:
            options_.triangles =
                std::min(static_cast<std::size_t>(step.factor) * options_.triangles,
                         made_.asset.source_triangles);
            break;
        case Growth::size:
            options_.size *= step.factor;
            break;
        case Growth::bits:
            options_.normal_bits = 16;
            options_.keep_baked_normals = false;
            break;
    }
}

MadeAsset FileMaker::run() {
    options_.run_stage = [this](std::string_view name, const std::function<void()>& work) {
        run_stage(name, work);
    };
    options_.keep_baked_normals = measures_loss() && options_.normal_bits == 8;
    run_stage("read", [&] { read(); });
    const Findings of_source = made_.findings;
    while (true) {
        relief::detail::FileSet files;  // Without commit(), it removes the files.
        make_once();
        if (holds_limits()) {
            measure_stages();
            files.commit();
            break;
        }
        grow(*made_.attempts.back().next);
        made_.findings = of_source;
    }
    made_.files.push_back(job_.output);
    made_.files.insert(made_.files.end(), map_files_.begin(), map_files_.end());
    return std::move(made_);
}

}  // namespace

std::vector<std::filesystem::path> outputs_of(const MakeRequest& request,
                                              const std::filesystem::path& output) {
    std::vector<std::filesystem::path> files = {output};
    for (const std::filesystem::path& file : map_files_of(request.engine, request.asset, output))
        files.push_back(file);
    if (request.stages_folder) {
        for (const std::filesystem::path& file :
             StageFiles(*request.stages_folder, request.asset).all())
            files.push_back(file);
        files.push_back(*request.stages_folder / "stages.json");
    }
    return files;
}

DenseModel dense_model(const MakeRequest& request, const Job& job) {
    DenseModel model;
    model.files = {job.input};
    model.files.insert(model.files.end(), request.more_sources.begin(), request.more_sources.end());
    model.has_z_up = request.up == shade::UpAxis::z ||
                     (request.up == shade::UpAxis::automatic && extension_of(job.input) == ".stl");
    model.crease_angle = request.asset.crease_angle;
    if (request.source_crease) {
        model.crease_angle = *request.source_crease;
    } else if (extension_of(job.input) == ".stl") {
        model.crease_angle = shade::stl_crease_angle;
    }
    return model;
}

MadeAsset make_file(const MakeRequest& request, const Job& job, Stages& stages) {
    return FileMaker(request, job, stages).run();
}

namespace {

/// " and 2 more files"
std::string with_text(const std::vector<std::filesystem::path>& more) {
    return more.empty() ? "" : " and " + counted(more.size(), "more file");
}

}  // namespace

Summary summary_of(const MakeRequest& request, const Job& job, const MadeAsset& made,
                   const Stages& stages) {
    const make::Asset& asset = made.asset;
    Summary summary;
    summary.add(
        "read",
        fmt::format("{}{}: {}, {}, {}{}{}{}", job.input.string(), with_text(request.more_sources),
                    made.source.format, counted(made.source.triangles, "triangle"),
                    counted(made.source.vertices, "vertex", "vertices"),
                    made.source.textures.empty() ? "" : ", ", made.source.textures,
                    made.source.has_z_up ? ", z up (y in the asset)" : ""),
        {{"input", job.input.string()},
         {"output", job.output.string()},
         {"source",
          {{"format", made.source.format},
           {"triangles", made.source.triangles},
           {"vertices", made.source.vertices},
           {"up", made.source.has_z_up ? "z" : "y"},
           {"usable_triangles", asset.source_triangles}}}});
    summary.add(
        "asset",
        fmt::format("{}, {}", counted(asset.mesh.triangles.size(), "triangle"),
                    counted(asset.mesh.positions.size(), "vertex", "vertices")),
        {{"triangles", asset.mesh.triangles.size()}, {"vertices", asset.mesh.positions.size()}});
    if (asset.remesh) {
        summary.add("remesh", remesh_lines(*asset.remesh),
                    {{"remesh", remesh_json(*asset.remesh)}});
    }
    if (asset.atlas) {
        summary.add("atlas",
                    atlas_text(*asset.atlas, {asset.normal_map.width, asset.normal_map.height}),
                    {{"atlas", atlas_json(*asset.atlas)}});
    }
    summary.add("materials", material_lines(asset));
    summary.add("parts", part_lines(asset.parts), {{"parts", parts_json(asset.parts)}});
    summary.add("maps", map_lines(made), maps_json(asset));
    summary.add("levels", level_lines(made), {{"levels", json_list(made.levels, level_json)}});
    if (request.limits.any()) {
        summary.add("limits", limit_lines(request.limits, made.attempts),
                    {{"limits", limits_json(request.limits, made.attempts)}});
    }
    if (made.loss) {
        summary.add("loss", loss_lines(*made.loss, request.limits.normals.statistic()),
                    {{"loss", loss_json(*made.loss)}});
    }
    summary.add_findings(made.findings);
    summary.add("stages", stage_lines(made, stages), {{"stages", stages_json(made, stages)}});
    std::vector<std::string> written;
    for (const std::filesystem::path& file : made.files)
        written.push_back(file_and_size(file));
    summary.add("wrote", written);
    return summary;
}

std::string line_of(const Job& job, const MadeAsset& made, const Stages& stages) {
    return fmt::format("{}: {} -> {}, {}, {}", job.output.string(), made.source.triangles,
                       counted(made.asset.mesh.triangles.size(), "triangle"),
                       made.findings.count_text(), duration(stages.milliseconds()));
}

}  // namespace relief::tools
