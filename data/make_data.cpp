// SPDX-License-Identifier: Apache-2.0
// Writes the samples of data/ into a folder: relief-make-data FOLDER. data/README.md describes each
// file. Every run writes the same bytes. Exit codes: 0 done, 1 failed, 2 wrong usage.
// Tests: tests/mesh/image/sample_data_test.cpp.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>

#include "relief/mesh/bump.h"
#include "relief/mesh/frames.h"
#include "relief/mesh/gltf_document.h"
#include "relief/mesh/height_map.h"
#include "relief/mesh/image_file.h"
#include "relief/mesh/mesh_file.h"
#include "relief/mesh/normal_map.h"
#include "samples.h"

namespace {

namespace sample = relief::sample;

relief::MeshFile vase_with_material(const std::filesystem::path& folder) {
    relief::MeshFile file;
    file.mesh = sample::vase();
    file.mesh.material_ranges = {
        {0, static_cast<std::uint32_t>(file.mesh.triangles.size()), std::uint32_t{0}}};
    relief::MtlMaterial bricks;
    bricks.name = "bricks";
    bricks.diffuse = glm::vec3(1.0F);
    bricks.specular = glm::vec3(0.05F);
    bricks.shininess = 24.0F;
    bricks.diffuse_map = folder / "bricks-diffuse.png";
    file.materials.push_back(bricks);
    return file;
}

/// Writes a model with smooth normals. Without normals, glTF requires flat ones.
void write_glb(const std::filesystem::path& file, relief::Mesh mesh) {
    relief::Report report;
    const relief::FrameOptions smooth;
    mesh = relief::with_frames(std::move(mesh), smooth, report).mesh;
    relief::GltfDocument::from_mesh({std::move(mesh), {}}).write(file);
}

/// Writes the normal map of the bricks at a quarter of the size, with a quarter of the depth of 24
/// texels.
void write_brick_normals(const std::filesystem::path& file) {
    relief::Report report;
    relief::BumpOptions options;
    options.kernel = relief::Kernel::sobel3;
    options.wrap = relief::Wrap::repeat;
    options.strength = 6.0;
    const relief::Image heights = relief::height_field(sample::brick_heights(256));
    const relief::NormalMapFormat format{
        .bits = 8, .green = relief::Green::up, .flat = relief::FlatCode::middle};
    relief::write_image(
        file, relief::encode_normal_map(relief::normals_from_height(heights, options, report),
                                        format, report));
}

void write_all(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "sky");
    relief::write_image(folder / "bricks-height.png", sample::brick_heights(1024),
                        {{"relief:content", "height map, tiles"}});
    relief::write_image(folder / "bricks-diffuse.png", sample::brick_colors(512));
    for (std::size_t face = 0; face < sample::face_names.size(); ++face) {
        relief::write_image(folder / "sky" / fmt::format("{}.jpg", sample::face_names[face]),
                            sample::sky_face(static_cast<int>(face), 512));
    }
    relief::write_mesh(folder / "vase.obj", vase_with_material(folder));
    relief::write_mesh(folder / "urn-high.ply", {sample::carved_urn(), {}});
    relief::write_mesh(folder / "urn-low.obj", {sample::plain_urn(), {}});
    relief::write_mesh(folder / "fossil.ply", {sample::fossil(), {}});
    std::filesystem::create_directories(folder / "scenes");
    write_glb(folder / "scenes" / "pot.glb", sample::pot());
    write_glb(folder / "scenes" / "knot.glb", sample::knot());
    write_brick_normals(folder / "scenes" / "bricks-normal.png");
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2 || arguments[1][0] == '-') {
        fmt::print(stderr, "usage: relief-make-data FOLDER\n");
        return 2;
    }
    try {
        write_all(arguments[1]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "relief-make-data: error: {}\n", error.what());
        return 1;
    }
    return 0;
}
