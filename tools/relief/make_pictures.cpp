// SPDX-License-Identifier: Apache-2.0
// Draws an asset beside its source. Tests: tests/make/make_page_test.cpp.
#include "make_pictures.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "make_scenes.h"
#include "mesh_preview.h"
#include "page_comparison.h"
#include "relief/mesh/atlas_picture.h"
#include "relief/mesh/texcoord_quality.h"
#include "relief/shade/fidelity.h"
#include "relief/shade/renderer.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// Removes all textures; the colors are gray, and nothing is metallic or glows.
Scene without_maps(Scene scene) {
    for (Material& material : scene.materials) {
        for (const TextureSlotInfo& slot : texture_slots)
            remove_texture(material, slot.slot);
        material.emission = glm::vec3(0.0F);
        if (!material.metallic_roughness) continue;
        material.metallic_roughness->base_color = glm::vec3(0.8F);
        material.metallic_roughness->metallic = 0.0F;
    }
    return scene;
}

constexpr glm::vec4 dark(0.03F, 0.033F, 0.037F, 1.0F);

/// The scene with the lights and the background of the report.
Scene lit(Scene scene, const Camera& camera) {
    add_default_lights(scene, camera);
    scene.background = dark;
    return scene;
}

Image draw_picture(RenderCache& cache, const Context& context, Scene scene, const Camera& camera,
                   const glm::ivec2& size) {
    Report ignored;
    scene = lit(std::move(scene), camera);
    const FrameSettings settings{.width = size.x, .height = size.y};
    Renderer renderer(cache, context, scene, plan_effects(scene, settings), settings, ignored);
    Image image = renderer.draw(camera).image;
    drop_alpha(image);
    return image;
}

}  // namespace

struct AssetScenes::Implementation {
    Context context;
    RenderCache cache{context};
    Scene source;
    Scene asset;
};

AssetScenes::AssetScenes(const DenseModel& source, const std::filesystem::path& asset)
    : implementation_(std::make_unique<Implementation>()) {
    implementation_->source = source_scene(source, asset);
    implementation_->asset = asset_scene(asset);
}

AssetScenes::~AssetScenes() = default;

AssetPictures AssetScenes::draw(const make::Asset& made, const glm::ivec2& size) {
    auto& [context, cache, source, asset] = *implementation_;
    const ViewDirection view = best_view(made.mesh);
    const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
    const Camera camera =
        framed(source, view.azimuth, view.elevation, default_vertical_fov, aspect);
    AssetPictures pictures;
    pictures.backend = context.backend_name();
    pictures.source = draw_picture(cache, context, source, camera, size);
    pictures.asset = draw_picture(cache, context, asset, camera, size);
    pictures.plain = draw_picture(cache, context, without_maps(asset), camera, size);
    return pictures;
}

std::string AssetScenes::page(const make::Asset& made, const glm::ivec2& size) {
    constexpr std::size_t max_triangles = 250'000;
    auto& [context, cache, source, asset] = *implementation_;
    const ViewDirection view = best_view(made.mesh);
    const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
    const Camera camera =
        framed(source, view.azimuth, view.elevation, default_vertical_fov, aspect);
    std::size_t triangles = 0;
    for (const Instance& instance : source.instances)
        triangles += source.meshes[instance.mesh]->triangles.size();
    const Scene before = lit(source, camera);
    const Scene after = lit(asset, camera);
    const Scene plain = lit(without_maps(asset), camera);
    const PageSide right = {"asset", &after};
    const PageSide without = {"asset without maps", &plain};
    if (triangles > max_triangles)
        return comparison_page(context, camera, without, {right}, size, "asset");
    return comparison_page(context, camera, {"source", &before}, {right, without}, size,
                           "source and asset");
}

struct AssetDrawer::Implementation {
    Context context;
    RenderCache cache{context};
};

AssetDrawer::AssetDrawer() : implementation_(std::make_unique<Implementation>()) {}

AssetDrawer::~AssetDrawer() = default;

Image AssetDrawer::draw(const std::filesystem::path& asset, const glm::ivec2& size) {
    const Scene scene = asset_scene(asset);
    const ViewDirection view = best_view(world_surface(scene));
    const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
    const Camera camera = framed(scene, view.azimuth, view.elevation, default_vertical_fov, aspect);
    return draw_picture(implementation_->cache, implementation_->context, scene, camera, size);
}

Image draw_charts(const make::Asset& made, const glm::ivec2& size) {
    Report ignored;
    const TexcoordQuality quality =
        measure_texcoords(made.mesh, {made.normal_map.width, made.normal_map.height}, ignored);
    std::vector<glm::vec2> corners;
    for (const glm::uvec3& triangle : made.mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            corners.push_back(made.mesh.texcoords[triangle[i]]);
    }
    return draw_atlas(made.mesh, corners, quality.chart, size);
}

namespace {

/// Adds up squares of the samples of an image.
template <typename Sample>
std::vector<std::uint8_t> square_means(const Image& image, const Image& small, int factor) {
    std::vector<std::uint8_t> samples(small.sample_count());
    const std::span<const Sample> from = image.as<Sample>();
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto columns = static_cast<std::size_t>(small.width);
    const auto block = static_cast<std::size_t>(factor);
    // The codes of the bits are multiples of those of 8 bits.
    constexpr std::size_t scale = std::numeric_limits<Sample>::max() / 255;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::size_t channel = i % channels;
        const std::size_t x = i / channels % columns;
        const std::size_t y = i / channels / columns;
        std::size_t sum = 0;
        for (std::size_t k = 0; k < block * block; ++k) {
            const std::size_t row = block * y + k / block;
            const std::size_t column = block * x + k % block;
            sum +=
                from[(row * static_cast<std::size_t>(image.width) + column) * channels + channel];
        }
        samples[i] = static_cast<std::uint8_t>(sum / (scale * block * block));
    }
    return samples;
}

}  // namespace

Image reduced(const Image& image, int max_side) {
    const int factor = std::max(1, (std::max(image.width, image.height) + max_side - 1) / max_side);
    if (factor == 1 && image.bits() == 8) return image;
    Image small = image;
    small.width = image.width / factor;
    small.height = image.height / factor;
    small.samples = image.bits() == 16 ? square_means<std::uint16_t>(image, small, factor)
                                       : square_means<std::uint8_t>(image, small, factor);
    return small;
}

}  // namespace relief::tools
