// SPDX-License-Identifier: Apache-2.0
// Loads a source and its asset for drawing. Tests: tests/make/make_page_test.cpp,
// make_loss_test.cpp.
#include "make_scenes.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "common/model_file.h"
#include "file_replacement.h"
#include "relief/mesh/frames.h"
#include "relief/shade/scene_file.h"

namespace relief::tools {
using namespace relief::shade;

namespace {

Scene scene_of_file(const std::filesystem::path& file, const std::filesystem::path& beside,
                    const DenseModel& source) {
    Report ignored;  // The findings about the source are those of the stages.
    SceneOptions options;
    options.up = source.has_z_up ? UpAxis::z : UpAxis::y;
    if (is_document(readable_format(file))) return load_scene(file, options, ignored);
    MeshFile contents = read_mesh(file, ignored);
    if (contents.mesh.normals.empty()) {
        FrameOptions frames;
        frames.normals = NormalWeight::angle;
        frames.crease_angle = source.crease_angle;
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

}  // namespace

Scene source_scene(const DenseModel& source, const std::filesystem::path& beside) {
    Scene scene = scene_of_file(source.files.front(), beside, source);
    for (std::size_t i = 1; i < source.files.size(); ++i)
        add_scene(scene, scene_of_file(source.files[i], beside, source));
    return scene;
}

Scene asset_scene(const std::filesystem::path& file) {
    Report ignored;
    SceneOptions options;
    options.up = UpAxis::y;
    return load_scene(file, options, ignored);
}

}  // namespace relief::tools
