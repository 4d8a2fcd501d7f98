// SPDX-License-Identifier: Apache-2.0
// Three scenes with one camera; grey surfaces, so that nothing but relief shows.
// Tests: tests/tools/mesh_preview_test.cpp.
#include "mesh/mesh_preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "relief/mesh/error.h"
#include "relief/mesh/image_channels.h"
#include "relief/mesh/image_file.h"
#include "relief/shade/default_view.h"
#include "relief/shade/effects.h"
#include "relief/shade/framing.h"
#include "relief/shade/render_cache.h"
#include "relief/shade/renderer.h"

namespace relief::tools {
namespace {

constexpr glm::ivec2 default_size{512, 512};
constexpr int panels = 3;
/// Texels along a side of the map for each pixel of the panel's longer side: a chart seldom has
/// more than half of that before the camera.
constexpr int texels_per_pixel = 4;
constexpr int least_map_size = 2048;  ///< Smaller maps are never made smaller.

/// The area of a mesh that faces each direction, and nothing hides.
std::vector<double> seen_areas(const Mesh& mesh, const std::vector<glm::dvec3>& directions) {
    std::vector<double> areas(directions.size(), 0.0);
    for (const glm::uvec3& triangle : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[triangle.x]);
        const glm::dvec3 b(mesh.positions[triangle.y]);
        const glm::dvec3 c(mesh.positions[triangle.z]);
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        for (std::size_t i = 0; i < directions.size(); ++i) {
            const double seen = glm::dot(normal, directions[i]);
            if (seen > 0.0 && std::isfinite(seen)) areas[i] += seen;
        }
    }
    return areas;
}

glm::dvec3 towards_eye(const ViewDirection& view) {
    return {std::cos(view.elevation) * std::sin(view.azimuth), std::sin(view.elevation),
            std::cos(view.elevation) * std::cos(view.azimuth)};
}

Material grey() {
    Material material;
    material.ambient = material.diffuse = glm::vec3(0.6F);
    material.specular = glm::vec3(0.15F);
    material.shininess = 40.0F;
    return material;
}

/// Nothing but shape: no colours of its own.
void add(Scene& scene, Mesh mesh, const glm::mat4& world_from_object = glm::mat4(1.0F)) {
    mesh.colors.clear();
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({scene.meshes.size() - 1, world_from_object, ""});
}

/// As the file has it, which is what the numbers of an object-space map are relative to.
Mesh in_own_axes(Mesh mesh, const glm::dmat3& world_from_object) {
    const glm::dmat3 object_from_world = glm::inverse(world_from_object);
    for (glm::vec3& position : mesh.positions)
        position = glm::vec3(object_from_world * glm::dvec3(position));
    for (glm::vec3& normal : mesh.normals)
        normal = glm::vec3(glm::normalize(glm::transpose(world_from_object) * glm::dvec3(normal)));
    mesh.tangents.clear();
    return mesh;
}

/// Triangles by the map that is for them, and a material for each: the first is for those that
/// have none.
void part_by_maps(Mesh& mesh, const std::vector<PreviewMap>& maps) {
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
    scene.materials.assign(maps.size() + 1, grey());
    part_by_maps(models.low, maps);
    if (space == NormalSpace::object && models.world_from_low != glm::dmat3(1.0)) {
        add(scene, in_own_axes(std::move(models.low), models.world_from_low),
            glm::mat4(glm::mat3(models.world_from_low)));
    } else {
        add(scene, std::move(models.low));
    }
    return scene;
}

Scene high_scene(PreviewModels& models) {
    Scene scene;
    scene.materials.push_back(grey());
    scene.materials[0].double_sided = models.shows_back_faces;
    for (Mesh& mesh : models.high) {
        mesh.material_ranges = {{0, static_cast<std::uint32_t>(mesh.triangles.size()), 0}};
        add(scene, std::move(mesh));
    }
    return scene;
}

/// Moves models whose size is beyond a camera's floats to where they are not.
void bring_within_reach(PreviewModels& models) {
    constexpr double least = 1e-9, most = 1e9;
    Bounds box = bounds_of(models.low);
    for (const Mesh& mesh : models.high) {
        const Bounds more = bounds_of(mesh);
        box = {glm::min(box.min, more.min), glm::max(box.max, more.max)};
    }
    if (box.empty()) return;
    const glm::dvec3 low(box.min), high(box.max);
    const glm::dvec3 sides = high - low;
    const double size = std::max({sides.x, sides.y, sides.z});
    if (size == 0.0 || (size >= least && size <= most)) return;
    const auto move = [&](Mesh& mesh) {
        for (glm::vec3& position : mesh.positions)
            position = glm::vec3((glm::dvec3(position) - 0.5 * (low + high)) / size);
    };
    move(models.low);
    for (Mesh& mesh : models.high)
        move(mesh);
}

/// Sees all of both.
Camera camera_for(const Scene& high, const Scene& low, const ViewDirection& view, float aspect) {
    Scene both = high;
    const std::size_t count = both.meshes.size();
    both.meshes.push_back(low.meshes[0]);
    both.instances.push_back({count, low.instances[0].world_from_object, ""});
    return framed(both, view.azimuth, view.elevation, default_vertical_fov, aspect);
}

/// One panel beside the others.
void put(Image& picture, const Image& panel, int index) {
    const auto from = panel.as<std::uint8_t>();
    const auto to = picture.as<std::uint8_t>();
    const auto row = static_cast<std::size_t>(panel.width * panel.channels);
    for (std::size_t y = 0; y < static_cast<std::size_t>(panel.height); ++y) {
        std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(y * row), row,
                    to.begin() + static_cast<std::ptrdiff_t>(
                                     (y * panels + static_cast<std::size_t>(index)) * row));
    }
}

void use(Scene& scene, const std::vector<PreviewMap>& maps, const PreviewReading& reading,
         const glm::ivec2& size) {
    // Each of several maps shows a part of the model.
    const double share =
        1.0 / std::sqrt(static_cast<double>(std::max<std::size_t>(maps.size(), 1)));
    const int all = std::max(least_map_size, texels_per_pixel * std::max(size.x, size.y));
    const int most = std::max(least_map_size / 4, static_cast<int>(share * all));
    for (std::size_t i = 0; i < maps.size(); ++i) {
        const TextureWrap wrap = maps[i].repeats ? TextureWrap::repeat : TextureWrap::clamp;
        scene.images.push_back(preview_image(maps[i].file, reading.format, most));
        const bool is_file =
            std::holds_alternative<std::filesystem::path>(scene.images.back().source);
        scene.materials[i + 1].normal_map =
            NormalMap{.texture = {i, wrap, wrap},
                      .green = is_file ? reading.format.green : Green::up,
                      .flat = reading.format.flat,
                      .space = reading.space};
    }
}

/// What drawing finds odd about the models, the bake has found and reported before.
Image drawn(RenderCache& cache, const Context& context, const Scene& scene, const Camera& camera,
            const glm::ivec2& size) {
    Report known;
    const FrameSettings settings{.width = size.x, .height = size.y};
    Renderer renderer(cache, context, scene, plan_effects(scene, settings), settings, known);
    Image image = renderer.draw(camera).image;
    drop_alpha(image);
    return image;
}

}  // namespace

ViewDirection telling_view(const Mesh& mesh) {
    constexpr double worth_turning = 1.25;
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
        directions.push_back(towards_eye(view));
    const std::vector<double> areas = seen_areas(mesh, directions);
    const auto best = std::max_element(areas.begin(), areas.end());
    if (!(*best > worth_turning * areas.front())) return views.front();
    return views[static_cast<std::size_t>(best - areas.begin())];
}

MeshPreview::MeshPreview() : context_(std::make_unique<Context>()) {}

void MeshPreview::draw(const PreviewOptions& options, PreviewModels models,
                       const std::vector<PreviewMap>& maps, const PreviewReading& reading) {
    const glm::ivec2 size = options.size.value_or(default_size);
    try {
        bring_within_reach(models);
        const ViewDirection view = telling_view(models.low);
        Scene high = high_scene(models);
        Scene low = low_scene(models, maps, reading.space);
        const float aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
        const Camera camera = camera_for(high, low, view, aspect);
        Image picture = make_image(panels * size.x, size.y, 3, 8, ColorSpace::srgb);
        for (Scene* scene : {&high, &low}) {
            scene->background = default_background;
            add_default_lights(*scene, camera);
        }
        RenderCache cache(*context_);
        put(picture, drawn(cache, *context_, high, camera, size), 0);
        high = {};
        cache.drop_unused();
        put(picture, drawn(cache, *context_, low, camera, size), 2);
        use(low, maps, reading, size);
        put(picture, drawn(cache, *context_, low, camera, size), 1);
        write_image(*options.file, picture);
    } catch (const Error& error) {
        throw Error(fmt::format("no preview: {} (the maps are complete)", error.what()));
    }
}

}  // namespace relief::tools
