// SPDX-License-Identifier: Apache-2.0
// Measures what assets lost. Tests: tests/make/make_loss_test.cpp.
#include "make_loss_meter.h"

#include <fmt/format.h>

#include <cassert>
#include <cstddef>
#include <utility>

#include "make_scenes.h"
#include "relief/mesh/gltf_document.h"
#include "relief/shade/renderer.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// Removes all textures. Where a texture multiplies a factor, nothing is metallic or glows.
Scene without_textures(Scene scene) {
    for (Material& material : scene.materials) {
        if (find_texture(material, TextureSlot::emission) != nullptr)
            material.emission = glm::vec3(0.0F);
        if (material.metallic_roughness &&
            find_texture(material, TextureSlot::metallic_roughness) != nullptr)
            material.metallic_roughness->metallic = 0.0F;
        for (const TextureSlotInfo& slot : texture_slots)
            remove_texture(material, slot.slot);
    }
    return scene;
}

Scene with_normals(Scene scene, const Image& normal_map) {
    for (const Material& material : scene.materials) {
        const Texture* texture = find_texture(material, TextureSlot::normal);
        assert(texture != nullptr);
        scene.images[texture->image].source = Shared<Image>(normal_map);
    }
    return scene;
}

/// Returns the primitives of each mesh of an asset, which are those of its levels.
std::vector<std::vector<GltfPrimitiveId>> levels_of(const GltfDocument& document) {
    std::vector<std::vector<GltfPrimitiveId>> levels;
    for (const GltfPrimitiveId id : document.triangle_primitives()) {
        if (levels.empty() || levels.back().front().mesh != id.mesh) levels.emplace_back();
        levels.back().push_back(id);
    }
    return levels;
}

/// Replaces the meshes of the finest level, one for each material, by those of another.
Scene with_level(Scene scene, const GltfDocument& document,
                 const std::vector<GltfPrimitiveId>& level) {
    assert(level.size() == scene.instances.size());
    for (std::size_t i = 0; i < level.size(); ++i)
        scene.meshes[scene.instances[i].mesh] = Shared<Mesh>(document.mesh(level[i]));
    return scene;
}

}  // namespace

struct LossMeter::Implementation {
    Mesh source;
    double diagonal = 0.0;
    Context context;
    Report of_source;
    FidelityMeter meter;

    Implementation(const Scene& scene, const FidelityOptions& options)
        : source(world_surface(scene)), meter(context, scene, options, of_source) {
        const Bounds bounds = bounds_of(source);
        if (!bounds.empty())
            diagonal = glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
    }

    [[nodiscard]] SurfaceDistance distance_of(const Scene& scene) const {
        // The part of a surface that is farther than the maximum of its samples is below 0.03 %
        // with a probability of 95 %.
        constexpr std::size_t samples = 10'000;
        return sampled_distance(source, world_surface(scene), samples, samples);
    }
};

LossMeter::LossMeter(const DenseModel& source, const std::filesystem::path& beside,
                     const FidelityOptions& options)
    : implementation_(std::make_unique<Implementation>(source_scene(source, beside), options)) {}

LossMeter::~LossMeter() = default;

AssetLoss LossMeter::measure(const std::filesystem::path& asset, Report& report) {
    report.merge(implementation_->of_source);
    AssetLoss loss;
    loss.fidelity = implementation_->meter.measure(asset_scene(asset), report);
    loss.diagonal = implementation_->diagonal;
    return loss;
}

SampledFidelity LossMeter::measure_with_normals(const std::filesystem::path& asset,
                                                const Image& normal_map) {
    return implementation_->meter.measure_sampled(with_normals(asset_scene(asset), normal_map));
}

std::vector<LossStage> LossMeter::measure_stages(const std::filesystem::path& asset,
                                                 const make::Asset& made, const AssetLoss& loss) {
    FidelityMeter& meter = implementation_->meter;
    const Scene scene = asset_scene(asset);
    const std::size_t triangles = made.mesh.triangles.size();
    const SurfaceDistance distance = implementation_->distance_of(scene);
    std::vector<LossStage> stages;
    stages.push_back(
        {"decimated", triangles, meter.measure_sampled(without_textures(scene)), distance});
    if (made.baked_normals) {
        stages.push_back({"baked", triangles,
                          meter.measure_sampled(with_normals(scene, *made.baked_normals)),
                          distance});
    }
    stages.push_back({"coded", triangles, loss.fidelity.sampled, distance});
    Report ignored;
    const GltfDocument document = GltfDocument::read(asset, ignored);
    const std::vector<std::vector<GltfPrimitiveId>> levels = levels_of(document);
    for (std::size_t level = 1; level < levels.size(); ++level) {
        const Scene lower = with_level(scene, document, levels[level]);
        const SurfaceDistance of_level = implementation_->distance_of(lower);
        std::size_t count = 0;
        for (const GltfPrimitiveId id : levels[level])
            count += document.mesh(id).triangles.size();
        stages.push_back(
            {fmt::format("LOD{}", level), count, meter.measure_sampled(lower), of_level});
    }
    return stages;
}

}  // namespace relief::tools
