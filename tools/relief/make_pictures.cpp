// SPDX-License-Identifier: Apache-2.0
// Draws an asset beside its source. Tests: tests/make/make_page_test.cpp.
#include "make_pictures.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "common/model_file.h"
#include "file_replacement.h"
#include "mesh_preview.h"
#include "relief/mesh/atlas_picture.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/texcoord_quality.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene_file.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

/// Loads the source with the materials that glTF gives it, so that both scenes have the same model
/// of shading.
Scene source_scene(const std::filesystem::path& file, const std::filesystem::path& beside,
                   std::optional<double> crease_angle) {
    Report ignored;  // The findings about the source are those of the stages.
    SceneOptions options;
    options.up = UpAxis::y;
    if (is_document(readable_format(file))) return load_scene(file, options, ignored);
    MeshFile contents = read_mesh(file, ignored);
    if (contents.mesh.normals.empty()) {
        FrameOptions frames;
        frames.normals = NormalWeight::angle;
        frames.crease_angle = crease_angle;
        contents.mesh = with_frames(std::move(contents.mesh), frames, ignored).mesh;
    }
    if (contents.materials.empty()) {
        // The asset is white and matte then. A renderer's default material need not be.
        MtlMaterial white;
        white.diffuse = glm::vec3(1.0F);
        contents.materials.push_back(white);
        const auto count = static_cast<std::uint32_t>(contents.mesh.triangles.size());
        contents.mesh.material_ranges = {{0, count, 0U}};
    }
    std::filesystem::path converted = beside;
    converted.replace_filename(beside.stem().string() + "-source.glb");
    const relief::detail::FileSet temporary;  // It is never committed.
    GltfDocument::from_mesh(contents, ignored).write(converted, ignored);
    return load_scene(converted, options, ignored);
}

/// Adds the meshes of another scene without poses, with their materials and images.
void add_scene(Scene& scene, Scene more) {
    const std::size_t first_mesh = scene.meshes.size();
    const auto first_material = static_cast<std::uint32_t>(scene.materials.size());
    const std::size_t first_image = scene.images.size();
    for (Shared<Mesh>& mesh : more.meshes) {
        for (MaterialRange& range : mesh.edit().material_ranges) {
            if (range.material) *range.material += first_material;
        }
        scene.meshes.push_back(std::move(mesh));
    }
    for (Material& material : more.materials) {
        for (const TextureSlotInfo& slot : texture_slots) {
            if (Texture* texture = find_texture(material, slot.slot)) texture->image += first_image;
        }
        scene.materials.push_back(std::move(material));
    }
    std::ranges::move(more.images, std::back_inserter(scene.images));
    for (Instance& instance : more.instances) {
        instance.mesh += first_mesh;
        scene.instances.push_back(std::move(instance));
    }
}

Scene source_scene(std::span<const std::filesystem::path> files,
                   const std::filesystem::path& beside, std::optional<double> crease_angle) {
    Scene scene = source_scene(files.front(), beside, crease_angle);
    for (const std::filesystem::path& file : files.subspan(1))
        add_scene(scene, source_scene(file, beside, crease_angle));
    return scene;
}

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

Image draw_picture(RenderCache& cache, const Context& context, Scene scene, const Camera& camera,
                   const glm::ivec2& size) {
    Report ignored;
    add_default_lights(scene, camera);
    scene.background = glm::vec4(0.03F, 0.033F, 0.037F, 1.0F);
    const FrameSettings settings{.width = size.x, .height = size.y};
    Renderer renderer(cache, context, scene, plan_effects(scene, settings), settings, ignored);
    Image image = renderer.draw(camera).image;
    drop_alpha(image);
    return image;
}

Scene asset_scene(const std::filesystem::path& file) {
    Report ignored;
    SceneOptions options;
    options.up = UpAxis::y;
    return load_scene(file, options, ignored);
}

}  // namespace

struct AssetScenes::Implementation {
    Context context;
    RenderCache cache{context};
    Scene source;
    Scene asset;
};

AssetScenes::AssetScenes(std::span<const std::filesystem::path> sources,
                         const std::filesystem::path& asset, std::optional<double> crease_angle)
    : implementation_(std::make_unique<Implementation>()) {
    implementation_->source = source_scene(sources, asset, crease_angle);
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

struct LossMeter::Implementation {
    Context context;
    Report of_source;
    FidelityMeter meter;

    explicit Implementation(const Scene& source) : meter(context, source, {}, of_source) {}
};

LossMeter::LossMeter(std::span<const std::filesystem::path> sources,
                     const std::filesystem::path& beside, std::optional<double> crease_angle)
    : implementation_(
          std::make_unique<Implementation>(source_scene(sources, beside, crease_angle))) {}

LossMeter::~LossMeter() = default;

Fidelity LossMeter::measure(const std::filesystem::path& asset, Report& report) {
    report.merge(implementation_->of_source);
    return implementation_->meter.measure(asset_scene(asset), report);
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

Image reduced(const Image& image, int max_side) {
    const int factor = (std::max(image.width, image.height) + max_side - 1) / max_side;
    if (factor <= 1) return image;
    Image small = image;
    small.width = image.width / factor;
    small.height = image.height / factor;
    std::vector<std::uint8_t> samples(small.sample_count());
    const auto from = image.as<std::uint8_t>();
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto columns = static_cast<std::size_t>(small.width);
    const auto block = static_cast<std::size_t>(factor);
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
        samples[i] = static_cast<std::uint8_t>(sum / (block * block));
    }
    small.samples = std::move(samples);
    return small;
}

}  // namespace relief::tools
