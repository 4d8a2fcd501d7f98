// SPDX-License-Identifier: Apache-2.0
// Draws the preview of a bake: three panels with one camera and gray materials, which show only the
// shape. Large maps are reduced row by row. Tests: tests/tools/relief_bake_preview_test.cpp.
#include "mesh_preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <span>

#include "common/text.h"
#include "file_replacement.h"
#include "page_comparison.h"
#include "portable_math.h"
#include "relief/mesh/image.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"

namespace relief::tools {
using namespace relief::detail;
using namespace relief::shade;

namespace {

constexpr glm::ivec2 default_size{512, 512};
constexpr int panels = 3;
/// Texels along a side of the map per pixel of the panel's longer side. The camera seldom sees more
/// than half of them.
constexpr int texels_per_pixel = 4;
constexpr int min_map_size = 2048;  ///< Smaller maps are not reduced.

/// The projected area of a mesh that faces each direction, without occlusion.
std::vector<double> facing_areas(const Mesh& mesh, const std::vector<glm::dvec3>& directions) {
    std::vector<double> areas(directions.size(), 0.0);
    for (const glm::uvec3& triangle : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[triangle.x]);
        const glm::dvec3 b(mesh.positions[triangle.y]);
        const glm::dvec3 c(mesh.positions[triangle.z]);
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        for (std::size_t i = 0; i < directions.size(); ++i) {
            const double area = glm::dot(normal, directions[i]);
            if (area > 0.0 && std::isfinite(area)) areas[i] += area;
        }
    }
    return areas;
}

glm::dvec3 direction_to_eye(const ViewDirection& view) {
    const double across = portable::cos(view.elevation);
    return {across * portable::sin(view.azimuth), portable::sin(view.elevation),
            across * portable::cos(view.azimuth)};
}

Material gray() {
    Material material;
    material.ambient = material.diffuse = glm::vec3(0.6F);
    material.specular = glm::vec3(0.15F);
    material.shininess = 40.0F;
    return material;
}

/// Adds a mesh without its vertex colors.
void add_mesh(Scene& scene, Mesh mesh, const glm::mat4& world_from_object = glm::mat4(1.0F)) {
    mesh.colors.clear();
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({scene.meshes.size() - 1, world_from_object, ""});
}

/// Transforms a mesh to the object space of its file, which an object-space map refers to.
Mesh in_object_axes(Mesh mesh, const glm::dmat3& world_from_object) {
    const glm::dmat3 object_from_world = glm::inverse(world_from_object);
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(object_from_world * glm::dvec3(position));
    for (glm::vec3& normal : mesh.normals)
        normal = glm::vec3(glm::normalize(glm::transpose(world_from_object) * glm::dvec3(normal)));
    mesh.tangents.clear();
    return mesh;
}

/// Sorts triangles by map, with a material for each map; the first material is for triangles
/// without a map.
void split_by_map(Mesh& mesh, const std::vector<PreviewMap>& maps) {
    std::vector<std::vector<glm::uvec3>> parts(maps.size() + 1);
    std::vector<std::size_t> part_of(mesh.triangles.size(), 0);
    for (std::size_t i = 0; i < maps.size(); ++i) {
        if (!maps[i].triangles) std::fill(part_of.begin(), part_of.end(), i + 1);
        if (!maps[i].triangles) continue;
        for (const std::uint32_t triangle : *maps[i].triangles)
            part_of[triangle] = i + 1;
    }
    for (std::size_t i = 0; i < part_of.size(); ++i)
        parts[part_of[i]].push_back(mesh.triangles[i]);
    mesh.triangles.clear();
    mesh.material_ranges.clear();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].empty()) continue;
        mesh.material_ranges.push_back({static_cast<std::uint32_t>(mesh.triangles.size()),
                                        static_cast<std::uint32_t>(parts[i].size()),
                                        static_cast<std::uint32_t>(i)});
        mesh.triangles.insert(mesh.triangles.end(), parts[i].begin(), parts[i].end());
    }
}

Scene low_scene(PreviewModels& models, const std::vector<PreviewMap>& maps, NormalSpace space) {
    Scene scene;
    scene.materials.assign(maps.size() + 1, gray());
    split_by_map(models.low, maps);
    if (space == NormalSpace::object && models.world_from_low != glm::dmat3(1.0)) {
        add_mesh(scene, in_object_axes(std::move(models.low), models.world_from_low),
                 glm::mat4(glm::mat3(models.world_from_low)));
    } else {
        add_mesh(scene, std::move(models.low));
    }
    return scene;
}

/// The material of a range of triangles; null if it has none.
const HighMaterial* material_of(const MaterialRange& range, const HighMaterials& materials) {
    if (range.material && *range.material < materials.materials.size())
        return &materials.materials[*range.material];
    return materials.otherwise ? &*materials.otherwise : nullptr;
}

/// The normal maps of the high models, as materials of a scene.
class HighNormalMaps {
  public:
    explicit HighNormalMaps(Scene& scene) : scene_(scene) {}

    /// Gives a high mesh gray materials with the normal maps that the bake adds to its normals. A
    /// mesh is drawn with one texture transform, that of its first map; maps with another one are
    /// left out.
    void apply(Mesh& mesh, const HighMaterials& materials) {
        std::optional<GltfTextureTransform> transform;
        for (MaterialRange& range : mesh.material_ranges) {
            const HighMaterial* const material = material_of(range, materials);
            range.material = 0;
            if (material == nullptr || !material->normal_map || mesh.texcoords.empty()) continue;
            const SurfaceNormalMap& map = *material->normal_map;
            if (!transform) transform = map.texture.transform;
            if (*transform == map.texture.transform) range.material = material_index(map);
        }
        if (!transform || *transform == GltfTextureTransform{}) return;
        for (glm::vec2& texcoord : mesh.texcoords)
            texcoord = transformed(*transform, texcoord);
        if (mesh.normals.empty()) return;
        for (std::size_t v = 0; v < mesh.tangents.size(); ++v)
            mesh.tangents[v] = transformed(*transform, mesh.tangents[v], mesh.normals[v]);
    }

  private:
    std::uint32_t material_index(const SurfaceNormalMap& map) {
        const auto [known, is_new] =
            materials_.emplace(&map, static_cast<std::uint32_t>(scene_.materials.size()));
        if (!is_new) return known->second;
        const SurfaceTexture& texture = map.texture;
        const auto [image, is_new_image] =
            images_.emplace(texture.image.get(), scene_.images.size());
        if (is_new_image) scene_.images.push_back({"normal map of the high model", *texture.image});
        Material material = scene_.materials.front();
        material.normal_map =
            NormalMap{.texture = {image->second, texture.wrap_u, texture.wrap_v, texture.filter},
                      .scale = map.scale,
                      .green = map.green,
                      .flat = map.flat};
        scene_.materials.push_back(std::move(material));
        return known->second;
    }

    Scene& scene_;
    std::map<const SurfaceNormalMap*, std::uint32_t> materials_;
    std::map<const Image*, std::size_t> images_;
};

Scene high_scene(PreviewModels& models) {
    Scene scene;
    scene.materials.push_back(gray());
    scene.materials[0].double_sided = models.shows_back_faces;
    HighNormalMaps maps(scene);
    for (std::size_t i = 0; i < models.high.size(); ++i) {
        Mesh& mesh = models.high[i];
        if (mesh.material_ranges.empty()) {
            mesh.material_ranges = {
                {0, static_cast<std::uint32_t>(mesh.triangles.size()), std::nullopt}};
        }
        if (i < models.high_materials.size()) {
            maps.apply(mesh, models.high_materials[i]);
        } else {
            for (MaterialRange& range : mesh.material_ranges)
                range.material = 0;
        }
        add_mesh(scene, std::move(mesh));
    }
    return scene;
}

/// Scales and centers models whose size exceeds the float range of a camera.
void normalize_size(PreviewModels& models) {
    constexpr double min_size = 1e-9, max_size = 1e9;
    Bounds box = bounds_of(models.low);
    for (const Mesh& mesh : models.high) {
        const Bounds more = bounds_of(mesh);
        box = {glm::min(box.min, more.min), glm::max(box.max, more.max)};
    }
    if (box.empty()) return;
    const glm::dvec3 low(box.min), high(box.max);
    const glm::dvec3 sides = high - low;
    const double size = std::max({sides.x, sides.y, sides.z});
    if (size == 0.0 || (size >= min_size && size <= max_size)) return;
    const auto move = [&](Mesh& mesh) {
        for (glm::vec3& position : mesh.positions)
            position = glm::vec3((glm::dvec3(position) - 0.5 * (low + high)) / size);
    };
    move(models.low);
    for (Mesh& mesh : models.high)
        move(mesh);
}

/// Frames both scenes.
Camera camera_for(const Scene& high, const Scene& low, const ViewDirection& view, float aspect) {
    Scene both = high;
    const std::size_t count = both.meshes.size();
    both.meshes.push_back(low.meshes[0]);
    both.instances.push_back({count, low.instances[0].world_from_object, ""});
    return framed(both, view.azimuth, view.elevation, default_vertical_fov, aspect);
}

/// Copies a panel into the picture.
void copy_panel(Image& picture, const Image& panel, int index) {
    const auto from = panel.as<std::uint8_t>();
    const auto to = picture.as<std::uint8_t>();
    const auto row = static_cast<std::size_t>(panel.width * panel.channels);
    for (std::size_t y = 0; y < static_cast<std::size_t>(panel.height); ++y) {
        std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(y * row), row,
                    to.begin() + static_cast<std::ptrdiff_t>(
                                     (y * panels + static_cast<std::size_t>(index)) * row));
    }
}

/// Adds the normal maps to the materials of the low scene.
void add_normal_maps(Scene& scene, const std::vector<PreviewMap>& maps,
                     const PreviewReading& reading, const glm::ivec2& size) {
    // Each of several maps covers only a part of the model.
    const double share =
        1.0 / std::sqrt(static_cast<double>(std::max<std::size_t>(maps.size(), 1)));
    const int all = std::max(min_map_size, texels_per_pixel * std::max(size.x, size.y));
    const int max_side = std::max(min_map_size / 4, static_cast<int>(share * all));
    for (std::size_t i = 0; i < maps.size(); ++i) {
        const Wrap wrap = maps[i].repeats ? Wrap::repeat : Wrap::clamp;
        scene.images.push_back(preview_image(maps[i].file, reading.format, max_side));
        const bool is_file =
            std::holds_alternative<std::filesystem::path>(scene.images.back().source);
        scene.materials[i + 1].normal_map =
            NormalMap{.texture = {i, wrap, wrap},
                      .green = is_file ? reading.format.green : Green::up,
                      .flat = reading.format.flat,
                      .space = reading.space};
    }
}

Image draw_panel(RenderCache& cache, const Context& context, const Scene& scene,
                 const Camera& camera, const glm::ivec2& size) {
    Report unused;  // The bake reported the same findings.
    const FrameSettings settings{.width = size.x, .height = size.y};
    Renderer renderer(cache, context, scene, plan_effects(scene, settings), settings, unused);
    Image image = renderer.draw(camera).image;
    drop_alpha(image);
    return image;
}

bool is_page(const PreviewOptions& options) {
    return extension_of(*options.file) == ".html";
}

/// Writes a page (docs/page.md) with the high models beside the low one.
/// \param scenes  the high models, the low model with the map, and without it
void write_page(const std::filesystem::path& file, const Context& context, const Camera& camera,
                const std::array<const Scene*, 3>& scenes, const glm::ivec2& size) {
    const std::string page =
        comparison_page(context, camera, {"high", scenes[0]},
                        {{"low with the map", scenes[1]}, {"low without it", scenes[2]}}, size,
                        file.stem().string());
    relief::detail::replace_file(file, std::as_bytes(std::span(page)));
}

/// Reads the next rows of a map as normals.
Image read_normals(ImageRowReader& reader, int rows, const NormalMapFormat& format) {
    const ImageInfo& info = reader.info();
    Image band = make_image(info.width, rows, info.channels, info.bits, ColorSpace::data);
    std::visit([&](auto& samples) { reader.read(std::as_writable_bytes(std::span(samples))); },
               band.samples);
    Report unused;  // The bake wrote the map, so every texel is a normal.
    return decode_normal_map(band, format.green, format.flat, unused);
}

/// Adds a band of up to `factor` rows to its row of sums.
void add_band(std::span<const float> band, int width, int factor, std::span<float> sums) {
    const std::size_t texels = band.size() / 3;
    for (std::size_t i = 0; i < texels; ++i) {
        const std::size_t x = i % static_cast<std::size_t>(width);
        for (std::size_t channel = 0; channel < 3; ++channel)
            sums[3 * (x / static_cast<std::size_t>(factor)) + channel] += band[3 * i + channel];
    }
}

}  // namespace

ViewDirection best_view(const Mesh& mesh) {
    constexpr double min_gain = 1.25;
    const float steep = 2.5F * default_elevation;
    std::vector<ViewDirection> views;
    for (const float elevation : {default_elevation, steep, -default_elevation, -steep}) {
        for (int quarter = 0; quarter < 4; ++quarter)
            views.push_back(
                {default_azimuth + 0.5F * std::numbers::pi_v<float> * static_cast<float>(quarter),
                 elevation});
    }
    std::vector<glm::dvec3> directions;
    for (const ViewDirection& view : views)
        directions.push_back(direction_to_eye(view));
    const std::vector<double> areas = facing_areas(mesh, directions);
    const auto best = std::max_element(areas.begin(), areas.end());
    if (!(*best > min_gain * areas.front())) return views.front();
    return views[static_cast<std::size_t>(best - areas.begin())];
}

ImageSource preview_image(const std::filesystem::path& map, const NormalMapFormat& format,
                          int max_side) {
    ImageRowReader reader(map);
    const int width = reader.info().width;
    const int height = reader.info().height;
    const int factor = (std::max(width, height) + max_side - 1) / max_side;
    if (factor <= 1) return {.name = map.string(), .source = map, .is_required = true};
    // The remainders at the right and at the bottom become separate texels, which extends the map
    // by less than one reduced texel.
    Image means = make_image((width + factor - 1) / factor, (height + factor - 1) / factor, 3, 32,
                             ColorSpace::data);
    const std::span<float> all = means.as<float>();
    const std::size_t row = 3 * static_cast<std::size_t>(means.width);
    for (int y = 0; y < means.height; ++y) {
        const Image band = read_normals(reader, std::min(factor, height - y * factor), format);
        add_band(band.as<float>(), width, factor,
                 all.subspan(static_cast<std::size_t>(y) * row, row));
    }
    Report unused;  // Normals that cancel out become flat.
    return {map.string(), encode_normal_map(means, {.bits = 32}, unused)};
}

MeshPreview::MeshPreview() : context_(std::make_unique<Context>()) {}

void MeshPreview::draw(const PreviewOptions& options, PreviewModels models,
                       const std::vector<PreviewMap>& maps, const PreviewReading& reading) {
    const glm::ivec2 size = options.size.value_or(default_size);
    try {
        normalize_size(models);
        const ViewDirection view = best_view(models.low);
        Scene high = high_scene(models);
        Scene low = low_scene(models, maps, reading.space);
        const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
        const Camera camera = camera_for(high, low, view, aspect);
        for (Scene* scene : {&high, &low}) {
            scene->background = default_background;
            add_default_lights(*scene, camera);
        }
        if (is_page(options)) {
            const Scene plain = low;
            add_normal_maps(low, maps, reading, size);
            write_page(*options.file, *context_, camera, {&high, &low, &plain}, size);
            return;
        }
        Image picture = make_image(panels * size.x, size.y, 3, 8, ColorSpace::srgb);
        RenderCache cache(*context_);
        copy_panel(picture, draw_panel(cache, *context_, high, camera, size), 0);
        high = {};
        cache.drop_unused();
        copy_panel(picture, draw_panel(cache, *context_, low, camera, size), 2);
        add_normal_maps(low, maps, reading, size);
        copy_panel(picture, draw_panel(cache, *context_, low, camera, size), 1);
        write_image(*options.file, picture);
    } catch (const Error& error) {
        throw Error(fmt::format("no preview: {} (the maps are complete)", error.what()));
    }
}

}  // namespace relief::tools
