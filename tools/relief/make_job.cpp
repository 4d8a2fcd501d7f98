// SPDX-License-Identifier: Apache-2.0
// Makes an asset from file to file, and describes it. Tests: tests/tools/relief_make_test.cpp.
#include "make_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <utility>

#include "common/model_file.h"
#include "file_replacement.h"
#include "make_loss.h"
#include "make_pictures.h"
#include "make_stages.h"
#include "relief/mesh/execution.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/map_description.h"
#include "relief/mesh/normal_map.h"

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

/// Engines that read the maps of glTF files in their convention need no other files.
bool has_map_files(Engine engine) {
    return engine == Engine::unity || engine == Engine::unreal;
}

/// "rock_N.png" for rock.glb.
std::filesystem::path map_file(const std::filesystem::path& output, const std::string& suffix) {
    return output.parent_path() / (output.stem().string() + suffix + ".png");
}

/// Returns the normal map with the direction of green that an engine reads. The code of zero is
/// 127.5, so that the opposite of each code exists.
Image normal_map_for(const Image& map, Green green) {
    Image result = map;
    if (green == Green::up) return result;
    const std::span<std::uint8_t> samples = result.as<std::uint8_t>();
    for (std::size_t i = 1; i < samples.size(); i += 3)
        samples[i] = static_cast<std::uint8_t>(255 - samples[i]);
    return result;
}

/// Packs the occlusion with the roughness 1 and the metalness 0 of the asset's material.
Image packed_map_for(const Image& occlusion, const EngineRules& rules) {
    Image packed;
    packed.width = occlusion.width;
    packed.height = occlusion.height;
    packed.channels = rules.channels;
    std::vector<std::uint8_t> samples(packed.sample_count());
    const std::span<const std::uint8_t> open = occlusion.as<std::uint8_t>();
    const auto channels = static_cast<std::size_t>(rules.channels);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        switch (rules.packed[i % channels]) {
            case PackedChannel::occlusion:
                samples[i] = open[i / channels];
                break;
            case PackedChannel::roughness:
                samples[i] = 255;
                break;
            default:
                samples[i] = 0;
        }
    }
    packed.samples = std::move(samples);
    return packed;
}

void write_engine_maps(const MakeRequest& request, const std::filesystem::path& output,
                       const make::Asset& asset) {
    if (!has_map_files(request.engine)) return;
    const EngineRules& rules = rules_of(request.engine);
    NormalMapFormat format;
    format.bits = 8;
    format.green = rules.green;
    write_image(map_file(output, rules.normal_name), normal_map_for(asset.normal_map, rules.green),
                normal_map_metadata(format));
    if (asset.occlusion_map) {
        MapDescription packed{.kind = MapKind::packed};
        packed.detail = enum_name(request.engine);
        packed.color_space = ColorSpace::data;
        write_image(map_file(output, rules.packed_name),
                    packed_map_for(*asset.occlusion_map, rules), write_description(packed, 8));
    }
    if (asset.color_map) {
        write_image(
            map_file(output, "_color"), *asset.color_map,
            write_description({.kind = MapKind::color, .color_space = ColorSpace::srgb}, 8));
    }
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

std::vector<std::string> map_lines(const MadeAsset& made) {
    const make::Asset& asset = made.asset;
    const BakeResult& bake = asset.bake;
    std::vector<std::string> lines = {fmt::format(
        "normals {} x {}: {} baked, {} missed; the source is {:.3g} to {:.3g} outside",
        asset.normal_map.width, asset.normal_map.height, counted(bake.texels_baked, "texel"),
        bake.texels_missed, bake.min_height, bake.max_height)};
    if (asset.occlusion_map) {
        lines.push_back(fmt::format("occlusion {} x {}: {:.3g} million rays",
                                    asset.occlusion_map->width, asset.occlusion_map->height,
                                    static_cast<double>(bake.occlusion_rays) / 1e6));
    }
    if (asset.color_map) {
        lines.push_back(fmt::format("colors {} x {}{}", asset.color_map->width,
                                    asset.color_map->height,
                                    asset.color_map->channels == 4 ? ", opacity in alpha" : ""));
    }
    return lines;
}

Json maps_json(const make::Asset& asset) {
    const auto map_json = [](const char* content, const Image& image) -> Json {
        return {{"content", content}, {"width", image.width}, {"height", image.height}};
    };
    Json maps = Json::array({map_json("normals", asset.normal_map)});
    if (asset.occlusion_map) maps.push_back(map_json("occlusion", *asset.occlusion_map));
    if (asset.color_map) maps.push_back(map_json("colors", *asset.color_map));
    return {{"maps", maps},
            {"texels_baked", asset.bake.texels_baked},
            {"texels_missed", asset.bake.texels_missed},
            {"rays", asset.bake.rays},
            {"occlusion_rays", asset.bake.occlusion_rays},
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

/// The asset, and for some engines its maps.
std::vector<std::filesystem::path> asset_files_of(const MakeRequest& request,
                                                  const std::filesystem::path& output) {
    std::vector<std::filesystem::path> files = {output};
    if (!has_map_files(request.engine)) return files;
    const EngineRules& rules = rules_of(request.engine);
    files.push_back(map_file(output, rules.normal_name));
    if (request.asset.occlusion) files.push_back(map_file(output, rules.packed_name));
    files.push_back(map_file(output, "_color"));
    return files;
}

/// Makes an asset from file to file, once or until limits hold.
class FileMaker {
  public:
    FileMaker(const MakeRequest& request, const Job& job, Stages& stages)
        : request_(request), job_(job), stages_(stages), options_(request.asset) {}

    MadeAsset run();

  private:
    void run_stage(std::string_view name, const std::function<void()>& work);
    void read();
    void make_once();
    void measure_loss();
    [[nodiscard]] bool holds_limits();
    void grow(Growth growth);

    const MakeRequest& request_;
    const Job& job_;
    Stages& stages_;
    make::AssetOptions options_;
    make::AssetSource source_;
    std::unique_ptr<LossMeter> meter_;  ///< Created when it is needed.
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
    source_ = read_source(job_.input, made_.source, made_.findings);
    source_.name = job_.output.stem().string();
    made_.inputs = names_of(opened.files());
}

/// Makes, writes, verifies and, if requested, measures the asset.
void FileMaker::make_once() {
    made_.files.clear();
    std::optional<StageFiles> kept;
    Report of_kept;
    if (request_.stages_folder) {
        kept.emplace(*request_.stages_folder, options_);
        options_.take_mesh = [&](std::string_view stage, const Mesh& mesh) {
            made_.files.push_back(kept->write_mesh(stage, mesh, source_.origin, of_kept));
        };
    }
    made_.asset = about(job_.input, [&] { return make::make_asset(source_, options_); });
    for (const make::StageReport& stage : made_.asset.reports) {
        made_.findings.add(stage.stage, stage.report, stage.stage == "bake" ? options_.size.x : 0);
    }
    run_stage("write", [&] {
        Report report;
        if (kept) {
            for (const std::filesystem::path& file : kept->write_maps(made_.asset))
                made_.files.push_back(file);
        }
        made_.levels = about(job_.input, [&] {
            return make::write_asset(job_.output, made_.asset, options_.levels, report);
        });
        write_engine_maps(request_, job_.output, made_.asset);
        made_.findings.add("write", report);
        made_.findings.add("kept stages", of_kept);
    });
    run_stage("verify", [&] {
        const Report problems = make::verify_asset(job_.output, made_.asset);
        made_.findings.add("verify", problems);
    });
    if (request_.measures_loss || request_.limits.any()) run_stage("loss", [&] { measure_loss(); });
}

/// Measures what was lost, or reports why that is not possible.
void FileMaker::measure_loss() {
    Report report;
    try {
        if (!meter_) {
            meter_ = std::make_unique<LossMeter>(job_.input, job_.output, options_.crease_angle);
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

/// Notes what was lost. \throws FileError if a limit does not hold and nothing can grow
bool FileMaker::holds_limits() {
    if (!request_.limits.any()) return true;
    std::vector<LimitAttempt>& attempts = made_.attempts;
    const std::size_t triangles = std::min(options_.triangles, made_.asset.source_triangles);
    attempts.push_back(attempt_of(*made_.loss, request_.limits, triangles, options_.size));
    if (!attempts.back().exceeded) return true;
    attempts.back().next = next_growth(attempts, made_.asset.source_triangles);
    if (!attempts.back().next) throw FileError(job_.input, limits_error(request_.limits, attempts));
    return false;
}

void FileMaker::grow(Growth growth) {
    if (growth == Growth::size)
        options_.size *= 2;
    else
        options_.triangles = std::min(2 * options_.triangles, made_.asset.source_triangles);
}

MadeAsset FileMaker::run() {
    options_.run_stage = [this](std::string_view name, const std::function<void()>& work) {
        run_stage(name, work);
    };
    run_stage("read", [&] { read(); });
    const Findings of_source = made_.findings;
    while (true) {
        relief::detail::FileSet files;  // Without commit(), it removes the files.
        make_once();
        if (holds_limits()) {
            files.commit();
            break;
        }
        grow(*made_.attempts.back().next);
        made_.findings = of_source;
    }
    for (const std::filesystem::path& file : asset_files_of(request_, job_.output)) {
        const bool is_color = file == map_file(job_.output, "_color");
        if (!is_color || made_.asset.color_map) made_.files.push_back(file);
    }
    return std::move(made_);
}

}  // namespace

std::vector<std::filesystem::path> outputs_of(const MakeRequest& request,
                                              const std::filesystem::path& output) {
    std::vector<std::filesystem::path> files = asset_files_of(request, output);
    if (request.stages_folder) {
        for (const std::filesystem::path& file :
             StageFiles(*request.stages_folder, request.asset).all())
            files.push_back(file);
    }
    return files;
}

MadeAsset make_file(const MakeRequest& request, const Job& job, Stages& stages) {
    return FileMaker(request, job, stages).run();
}

Summary summary_of(const MakeRequest& request, const Job& job, const MadeAsset& made,
                   const Stages& stages) {
    const make::Asset& asset = made.asset;
    Summary summary;
    summary.add("read",
                fmt::format("{}: {}, {}, {}{}{}", job.input.string(), made.source.format,
                            counted(made.source.triangles, "triangle"),
                            counted(made.source.vertices, "vertex", "vertices"),
                            made.source.textures.empty() ? "" : ", ", made.source.textures),
                {{"input", job.input.string()},
                 {"output", job.output.string()},
                 {"source",
                  {{"format", made.source.format},
                   {"triangles", made.source.triangles},
                   {"vertices", made.source.vertices},
                   {"usable_triangles", asset.source_triangles}}}});
    summary.add(
        "asset",
        fmt::format("{}, {}", counted(asset.mesh.triangles.size(), "triangle"),
                    counted(asset.mesh.positions.size(), "vertex", "vertices")),
        {{"triangles", asset.mesh.triangles.size()}, {"vertices", asset.mesh.positions.size()}});
    if (asset.atlas) {
        summary.add("atlas",
                    atlas_text(*asset.atlas, {asset.normal_map.width, asset.normal_map.height}),
                    {{"atlas", atlas_json(*asset.atlas)}});
    }
    summary.add("maps", map_lines(made), maps_json(asset));
    summary.add("levels", level_lines(made), {{"levels", json_list(made.levels, level_json)}});
    if (request.limits.any()) {
        summary.add("limits", limit_lines(request.limits, made.attempts),
                    {{"limits", limits_json(request.limits, made.attempts)}});
    }
    if (made.loss) summary.add("loss", loss_lines(*made.loss), {{"loss", loss_json(*made.loss)}});
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
