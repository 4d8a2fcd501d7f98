// SPDX-License-Identifier: Apache-2.0
// Shards of bakes, and their merge. Tests: tests/tools/relief_bake_shards_test.cpp.
#include "mesh_shards.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "common/content_hash.h"
#include "common/file_jobs.h"
#include "common/options.h"
#include "file_replacement.h"
#include "relief/mesh/bake_shards.h"

namespace relief::tools {
namespace {

/// The files that a bake read, and hashes of their contents. Names are relative to the current
/// folder, which may have another name on another machine.
std::vector<std::pair<std::string, std::string>> hashes_of(
    const std::vector<std::filesystem::path>& files) {
    const std::filesystem::path here = std::filesystem::current_path();
    std::set<std::string> names;
    for (const std::filesystem::path& file : files)
        names.insert(file.is_absolute() ? file.lexically_proximate(here).string() : file.string());
    std::vector<std::pair<std::string, std::string>> hashes;
    for (const std::string& name : names)
        hashes.emplace_back(name, file_hash(name));
    return hashes;
}

/// "out/map.png.0123456789abcdef-3-of-16.part"; placeholders are left out.
std::filesystem::path part_name(const std::filesystem::path& output, const Part& part) {
    std::string name = output.filename().string();
    std::erase_if(name, [](char letter) { return letter == '<' || letter == '>'; });
    return output.parent_path() /
           fmt::format("{}.{}-{}-of-{}.part", name, part.job.hash(), part.shard, part.job.count);
}

/// The rows of one map, from all parts.
class MapReader {
  public:
    MapReader(const std::vector<std::unique_ptr<PartFile>>& parts, std::size_t map,
              const BakeLayers& layers, int width, std::size_t ids)
        : width_(static_cast<std::size_t>(width)), ids_(ids) {
        for (const auto& part : parts) {
            for (const PartRows& rows : part->part().rows) {
                if (rows.map != map) continue;
                sources_.push_back({part.get(), rows.found.rows, rows.offset});
                shards_.push_back(rows.found);
            }
        }
        std::ranges::sort(sources_, {}, [](const Source& source) { return source.rows.first; });
        std::ranges::sort(shards_, {}, [](const BakeShard& shard) { return shard.rows.first; });
        const std::size_t texels = width_ * static_cast<std::size_t>(part_chunk_rows);
        states_.resize(texels);
        for (const RowLayer& layer : row_layers()) {
            values_.emplace_back(layer.is_requested(layers) ? layer.channels * texels : 0);
        }
    }

    [[nodiscard]] const std::vector<BakeShard>& shards() const { return shards_; }

    /// Copies the baked texels, and the states of all, of the next rows.
    void read(const BakedRows& rows) {
        for (int row = 0; row < rows.row_count; ++row)
            copy_row(rows, row);
    }

  private:
    struct Source {
        const PartFile* file;
        BakeRowRange rows;
        std::uint64_t offset;
    };

    void copy_row(const BakedRows& rows, int row) {
        while (rows.first_row + row >= chunk_last_)
            load_chunk();
        const auto to = static_cast<std::size_t>(row) * width_;
        const auto from = static_cast<std::size_t>(rows.first_row + row - chunk_first_) * width_;
        std::copy_n(&states_[from], width_, &rows.states[to]);
        for (std::size_t i = 0; i < values_.size(); ++i) {
            if (values_[i].empty()) continue;
            const std::size_t channels = row_layers()[i].channels;
            const std::span<float> target = rows.*row_layers()[i].values;
            for (std::size_t x = 0; x < width_; ++x) {
                if (states_[from + x] != TexelState::baked) continue;
                std::copy_n(&values_[i][channels * (from + x)], channels,
                            &target[channels * (to + x)]);
            }
        }
    }

    void load_chunk() {
        Source& source = sources_.at(source_);
        chunk_first_ = std::max(source.rows.first, chunk_last_);
        chunk_last_ = std::min(chunk_first_ + part_chunk_rows, source.rows.last);
        const auto texels = static_cast<std::size_t>(chunk_last_ - chunk_first_) * width_;
        BakedRows chunk;
        chunk.first_row = chunk_first_;
        chunk.row_count = chunk_last_ - chunk_first_;
        chunk.states = std::span(states_).first(texels);
        for (std::size_t i = 0; i < values_.size(); ++i) {
            if (values_[i].empty()) continue;
            chunk.*row_layers()[i].values =
                std::span(values_[i]).first(row_layers()[i].channels * texels);
        }
        // Chunks hold only baked texels.
        std::ranges::fill(chunk.ids, -1.0F);
        source.file->read(chunk, source.offset, ids_);
        if (chunk_last_ == source.rows.last) ++source_;
    }

    std::size_t width_, ids_;
    std::vector<Source> sources_;
    std::vector<BakeShard> shards_;
    std::size_t source_ = 0;
    int chunk_first_ = 0, chunk_last_ = 0;
    std::vector<TexelState> states_;
    std::vector<std::vector<float>> values_;  ///< As row_layers(); empty if not requested.
};

/// The maps with their names, which must be different files.
std::vector<MapPlan> named_plans(const MeshBakeRequest& request, const PartFile& part) {
    std::vector<MapPlan> plans = part.part().plans;
    std::set<std::filesystem::path> used;
    for (MapPlan& plan : plans) {
        plan.output = plan.named(request.output);
        if (!used.insert(identity_of(plan.output)).second) {
            throw failure(part.path(), "several maps would be the file " + plan.output.string(),
                          "write <material> or <UDIM> in its name as for the shards");
        }
    }
    return plans;
}

}  // namespace

void check_sharded(const MeshBakeRequest& request) {
    const char* const option = request.verify          ? "--verify"
                               : request.compare       ? "--compare"
                               : request.bound.degrees ? "--max-error"
                               : request.preview.file  ? "--preview"
                               : request.error_map     ? "--error-map"
                                                       : nullptr;
    if (option == nullptr) return;
    throw UsageError(fmt::format("{}, --shard: contradict each other", option),
                     "use relief-bake check after the merge");
}

BakedShard bake_shard(const MeshBakeRequest& request, const MeshArguments& arguments,
                      const ShardChoice& choice, const std::optional<std::filesystem::path>& file,
                      Stages& stages) {
    BakedShard shard;
    Part& part = shard.part;
    part.shard = choice.shard;
    part.job.count = choice.count;
    part.job.version = version_and_commit();
    part.job.arguments = arguments.options;
    for (const std::filesystem::path& name : arguments.files)
        part.job.files.push_back(name.string());
    part.bake.format = format_of(request.map, request.output);
    const BakeModels models =
        stages.run("read", [&] { return read_bake_models(request, part.bake.findings); });
    part.job.inputs = stages.run("hash", [&] { return hashes_of(models.files); });
    describe_models(request, models, part.bake);
    about(request.low, [&] {
        // Each shard would make the same estimate of missed texels.
        const PreparedBake prepared =
            prepare_bake(request, models, stages, part.bake, choice.shard == 1);
        part.facts = prepared.facts;
        std::vector<BakeMapOptions> maps;
        for (const MapPlan& plan : prepared.plans.maps) {
            maps.push_back(map_options(prepared.options, plan));
            maps.back().measures_missed = true;
            part.plans.push_back(plan);
            part.plans.back().triangles.reset();
        }
        shard.file = file.value_or(part_name(request.output, part));
        PartWriter writer(shard.file);
        stages.run("bake", [&] {
            const Baker& baker = *prepared.baker;
            for (const ShardRows& rows :
                 rows_of_shard(baker.low(), maps, choice.shard - 1, choice.count)) {
                PartRows done{rows.map, {}, writer.offset()};
                done.found = baker.bake_shard(maps[rows.map], rows.rows,
                                              [&](const BakedRows& baked) { writer.write(baked); });
                part.rows.push_back(std::move(done));
            }
        });
        part.milliseconds = stages.milliseconds("bake");
        writer.finish(part);
    });
    return shard;
}

void sort_parts(std::vector<std::unique_ptr<PartFile>>& parts) {
    std::vector<PartName> names;
    for (const auto& part : parts)
        names.push_back({part->path(), &part->part().job, part->part().shard});
    std::vector<std::unique_ptr<PartFile>> sorted;
    for (const std::size_t index : sorted_parts(names, "bake"))
        sorted.push_back(std::move(parts[index]));
    parts = std::move(sorted);
}

MeshBake merge_parts(const MeshBakeRequest& request,
                     const std::vector<std::unique_ptr<PartFile>>& parts, Stages& stages) {
    const Part& first = parts.front()->part();
    MeshBake bake = first.bake;
    bake.format = format_of(request.map, request.output);
    std::vector<MapPlan> plans = named_plans(request, *parts.front());
    std::vector<std::filesystem::path> inputs;
    for (const auto& part : parts) {
        inputs.push_back(part->path());
        stages.book("bake", part->part().milliseconds);
    }
    for (const auto& [name, hash] : first.job.inputs)
        inputs.emplace_back(name);
    check_outputs(request, plans, inputs);
    std::optional<MaterialRequest> materials;
    if (request.write_into.model) {
        materials = material_request(request, plans, bake.alpha);
        check_materials(*materials);
    }
    BakeOptions options = bake_options_of(request);
    options.map.layers.opacity = first.facts.has_opacity;
    relief::detail::FileSet outputs;
    stages.run("merge", [&] {
        const MapSource source = [&](std::size_t index, const BakeMapOptions& map, const auto& take,
                                     Report& report) {
            MapReader reader(parts, index, map.layers, map.width, first.facts.ids.size());
            return about(parts.front()->path(), [&] {
                return merge_shards(
                    map, first.facts.distances, reader.shards(),
                    [&](const BakedRows& rows) { reader.read(rows); }, take, report);
            });
        };
        const auto uncovered = [&] {
            return failure(request.low, "covers no texel of the map",
                           "unwrap it with relief-mesh unwrap; nothing is written");
        };
        write_maps(request, first.facts, std::move(plans), options, source, uncovered, bake);
    });
    if (materials) write_into(*materials, stages, bake);
    outputs.commit();
    return bake;
}

}  // namespace relief::tools
