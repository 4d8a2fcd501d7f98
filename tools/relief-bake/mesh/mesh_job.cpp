// SPDX-License-Identifier: Apache-2.0
// Maps one after another; rows go from the baker to codes to the file as they are made, so that no
// image is ever in memory. Tests: tests/tools/relief_bake_mesh_test.cpp.
#include "mesh/mesh_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "common/choices.h"
#include "mesh/bake_models.h"
#include "mesh/bake_words.h"
#include "mesh/mesh_preview.h"
#include "mesh/mesh_progress.h"
#include "mesh/model_fit.h"
#include "relief/mesh/image_rows.h"

namespace relief::tools {
namespace {

std::map<std::string, std::string> metadata_of(const MeshBakeRequest& request, const MapPlan& plan,
                                               const NormalMapFormat& format) {
    std::map<std::string, std::string> metadata = normal_map_metadata(format);
    metadata.merge(bake_metadata(request, plan));
    if (request.space == SpaceChoice::object)
        metadata["relief:content"] = "normal map, object space";
    if (request.space == SpaceChoice::world) metadata["relief:content"] = "normal map, world space";
    return metadata;
}

/// Three channels and a fourth, full where there is a normal, be it of the padding or not.
template <typename Sample>
std::vector<Sample> with_alpha(std::span<const Sample> codes, std::span<const TexelState> states,
                               bool has_padding) {
    const Sample full =
        std::is_floating_point_v<Sample> ? Sample{1} : std::numeric_limits<Sample>::max();
    std::vector<Sample> result(4 * states.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
        std::copy_n(&codes[3 * i], 3, &result[4 * i]);
        const bool is_there =
            states[i] == TexelState::baked || (has_padding && states[i] == TexelState::padded);
        result[4 * i + 3] = is_there ? full : Sample{0};
    }
    return result;
}

/// Codes rows of normals and writes them.
class MapWriter {
  public:
    MapWriter(const MeshBakeRequest& request, const MapPlan& plan, const NormalMapFormat& format,
              Report& report)
        : format_(format),
          has_alpha_(request.background == Background::transparent),
          shows_padding_(!request.fills_to_border),
          report_(report),
          writer_(
              plan.output,
              {request.size.x, request.size.y, has_alpha_ ? 4 : 3, format.bits, ColorSpace::data},
              metadata_of(request, plan, format), write_options_of(request.map, plan.output)) {}

    void write(const BakedRows& rows) {
        const auto width =
            static_cast<int>(rows.states.size() / static_cast<std::size_t>(rows.row_count));
        Image normals;
        normals.width = width;
        normals.height = rows.row_count;
        normals.channels = 3;
        normals.color_space = ColorSpace::data;
        normals.samples = std::vector<float>(rows.normals.begin(), rows.normals.end());
        // Row counts are multiples of the dither tile's, so that its pattern goes on.
        const Image codes = encode_normal_map(normals, format_, report_);
        if (format_.bits == 8) write(codes.as<std::uint8_t>(), rows.states);
        if (format_.bits == 16) write(codes.as<std::uint16_t>(), rows.states);
        if (format_.bits == 32) write(codes.as<float>(), rows.states);
    }

    void complete() { writer_.complete(report_); }
    void finish() { writer_.finish(report_); }

  private:
    template <typename Sample>
    void write(std::span<const Sample> codes, std::span<const TexelState> states) {
        if (!has_alpha_) return writer_.write(std::as_bytes(codes));
        const std::vector<Sample> all = with_alpha(codes, states, shows_padding_);
        writer_.write(std::as_bytes(std::span(all)));
    }

    const NormalMapFormat& format_;
    bool has_alpha_, shows_padding_;
    Report& report_;
    ImageRowWriter writer_;
};

void draw(MeshPreview& preview, const MeshBakeRequest& request, const MeshBake& baked,
          BakeModels models) {
    const bool is_tangent = request.space == SpaceChoice::tangent;
    const bool has_own_axes = request.space == SpaceChoice::object && models.world_from_low;
    std::vector<PreviewMap> maps;
    for (const BakedMap& map : baked.maps) {
        const bool is_tile = map.plan.tile != glm::ivec2(0);
        maps.push_back({.file = map.plan.output,
                        .triangles = map.plan.triangles,
                        .repeats = is_tile || request.outside == OutsideChoice::repeat});
    }
    preview.draw(
        request.preview,
        {.high = std::move(models.high),
         .low = std::move(models.low),
         .world_from_low = has_own_axes ? *models.world_from_low : glm::dmat3(1.0),
         .shows_back_faces = request.back_faces == BackFaces::take},
        maps,
        {.format = baked.format, .space = is_tangent ? NormalSpace::tangent : NormalSpace::object});
}

/// Adds what one map had to what all have.
void add(BakeResult& all, const BakeResult& more) {
    if (more.texels_baked > 0) {
        const bool is_first = all.texels_baked == 0;
        all.least_height =
            is_first ? more.least_height : std::min(all.least_height, more.least_height);
        all.greatest_height =
            is_first ? more.greatest_height : std::max(all.greatest_height, more.greatest_height);
    }
    all.distances = more.distances;
    all.coverage += more.coverage;
    all.texels_baked += more.texels_baked;
    all.texels_missed += more.texels_missed;
    all.samples += more.samples;
    all.rays += more.rays;
    all.occlusion_rays += more.occlusion_rays;
}

/// A map that is baked and not in place yet: its files are complete, and gone unless finished.
class PendingMap {
  public:
    PendingMap(const MeshBakeRequest& request, const Baker& baker, MapPlan plan,
               const BakeOptions& options, MapProgress& progress, const NormalMapFormat& format)
        : map_{std::move(plan), {}, {}, {}}, writer_(request, map_.plan, format, report_) {
        BakeMapOptions map = map_options(options, map_.plan);
        map.progress = progress.next_map(request.size.y);
        map.measures_missed = true;
        map_.layers = planned_layers(request, map_.plan, baker, map.layers);
        layers_.emplace(request, map_.layers, report_);
        const auto take = [&](const BakedRows& rows) {
            writer_.write(rows);
            layers_->write(rows);
        };
        map_.result = baker.bake(map, take, report_);
        writer_.complete();
        layers_->complete();
    }
    PendingMap(const PendingMap&) = delete;
    PendingMap& operator=(const PendingMap&) = delete;

    [[nodiscard]] const BakedMap& map() const { return map_; }

    /// Puts the files in place.
    BakedMap finish(Findings& findings) {
        writer_.finish();
        layers_->finish(map_.plan.output);
        findings.add(map_.plan.name(), report_);
        return std::move(map_);
    }

  private:
    Report report_;
    BakedMap map_;
    MapWriter writer_;
    std::optional<LayerWriters> layers_;
};

/// Which maps are there when another one fails.
FileError failure_after(const MeshBake& baked, const Error& error, const std::size_t count) {
    std::string done;
    for (const BakedMap& map : baked.maps)
        done += (done.empty() ? "" : ", ") + map.plan.output.string();
    return {baked.maps.back().plan.output.parent_path(),
            fmt::format("only {} of {} maps are written: {}; {}", baked.maps.size(), count, done,
                        error.what())};
}

void bake_all(const MeshBakeRequest& request, const Baker& baker, const BakeModels& models,
              MapPlans plans, const BakeOptions& options, Stages& stages, MeshBake& baked) {
    MapProgress progress(stages, plans.maps.size());
    std::vector<std::unique_ptr<PendingMap>> pending;
    for (MapPlan& plan : plans.maps) {
        pending.push_back(std::make_unique<PendingMap>(request, baker, std::move(plan), options,
                                                       progress, baked.format));
        const BakedMap& map = pending.back()->map();
        check_missed(request, models, map.plan.name(), map.result);
    }
    for (const std::unique_ptr<PendingMap>& map : pending) {
        try {
            baked.maps.push_back(map->finish(baked.findings));
        } catch (const Error& error) {
            if (baked.maps.empty()) throw;
            throw failure_after(baked, error, pending.size());
        }
        add(baked.all, baked.maps.back().result);
    }
}

void verify_all(const MeshBakeRequest& request, const Baker& baker, const BakeModels& models,
                const BakeOptions& options, MeshBake& baked) {
    for (BakedMap& map : baked.maps) {
        Report said_by_the_bake;
        map.verified = verify_map(baker, models, request, map_options(options, map.plan),
                                  {.map = map.plan.output,
                                   .bound = request.accuracy.bound,
                                   .error_map = request.verify.error_map},
                                  said_by_the_bake);
        Report report;
        for (const std::string& trouble : map.verified->trouble)
            report.add("map off its surface", "map", 0, trouble);
        baked.findings.add(map.plan.name(), report);
    }
}

void take_samples(const MeshBakeRequest& settled, BakeOptions& options) {
    const BakeOptions anew = bake_options_of(settled);
    options.samples = anew.samples;
    options.sample_angle = anew.sample_angle;
}

/// Whether maps, whose names are known by now, are in the way of what is written after them.
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

}  // namespace

MeshBake bake_maps(const MeshBakeRequest& request, Stages& stages) {
    MeshBake baked;
    baked.format = format_of(request.map, request.output);
    std::optional<MeshPreview> preview;
    if (request.preview.file) stages.run("context", [&] { preview.emplace(); });
    BakeModels models =
        stages.run("read", [&] { return read_bake_models(request, baked.findings); });
    for (const Mesh& mesh : models.high)
        baked.high_triangles += mesh.triangles.size();
    baked.pairs = models.pairs;
    baked.unpaired = models.unpaired;
    baked.low_triangles = models.low.triangles.size();
    if (request.layers.files.contains(LayerKind::height))
        baked.texel_size = mean_texel_size(models.low, request.size);
    baked.has_own_tangents = !models.low.tangents.empty();
    about(request.low, [&] {
        MapPlans plans = plan_maps(request, models.low, models.materials);
        baked.materials = plans.materials;
        baked.findings.add("", plans.report);
        check_outputs(request, plans.maps);
        BakeOptions options = bake_options_of(request);
        options.map_count = plans.maps.size();
        options.output_from_mesh = output_axes(request, models.world_from_low);
        options.layers.position_from_mesh[3] = glm::dvec4(models.origin, 1.0);
        options.details = models.looks.details();
        baked.looks = models.looks.words();
        if (models.cage) options.cage = &*models.cage;
        std::optional<Baker> baker;
        stages.run("bake", [&] {
            Report report;
            baker.emplace(make_baker(request, models, options, report));
            baked.findings.add("", report);
            for (const MapPlan& plan : plans.maps) {
                check_missed_early(request, models, *baker, map_options(options, plan), plan.name(),
                                   needs_trials(request));
            }
        });
        baked.fit = baker->fit();
        baked.origin = models.origin;
        MeshBakeRequest settled = request;
        if (needs_trials(request)) {
            stages.run("choose", [&] {
                baked.accuracy = settle_accuracy(*baker, map_options(options, plans.maps.front()),
                                                 settled, baked.format);
            });
            take_samples(settled, options);
        }
        stages.run("bake", [&] {
            bake_all(settled, *baker, models, std::move(plans), options, stages, baked);
        });
        if (request.verify.wanted)
            stages.run("verify", [&] { verify_all(settled, *baker, models, options, baked); });
    });
    if (preview) stages.run("preview", [&] { draw(*preview, request, baked, std::move(models)); });
    return baked;
}

}  // namespace relief::tools
