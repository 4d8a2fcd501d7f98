// SPDX-License-Identifier: Apache-2.0
// Renders a sphere to an image in memory, without a window.
#include <cstdint>
#include <cstdio>
#include <exception>
#include <span>

#include "relief/mesh/mesh.h"
#include "relief/mesh/report.h"
#include "relief/shade/renderer.h"
#include "relief/shade/scene.h"

int main() {
    try {
        relief::shade::Scene scene;
        scene.meshes.emplace_back(relief::make_sphere());
        scene.instances.push_back({.mesh = 0, .name = "sphere"});
        relief::Material material;
        material.diffuse = glm::vec3(0.5F);
        scene.materials.push_back(material);
        scene.meshes[0].edit().material_ranges = {
            {.triangle_count = static_cast<std::uint32_t>(scene.meshes[0]->triangles.size()),
             .material = 0}};
        // The light comes from the camera, so the center of the sphere has the radiance 0.5.
        const relief::shade::Camera camera = relief::shade::framed(scene, 0.0F, 0.0F, 0.6F, 1.0F);
        scene.directional_lights.push_back({.direction_world = glm::vec3(0.0F, 0.0F, -1.0F)});

        const relief::shade::Context context;  // A GPU without a display, or Mesa's rasterizer.
        relief::Report report;
        const relief::shade::FrameSettings settings = {
            .width = 256, .height = 256, .output = relief::shade::OutputCoding::linear};
        relief::shade::Renderer renderer(context, scene, settings, report);
        const relief::shade::Frame frame = renderer.draw(camera);

        const std::span<const float> pixels = frame.image.as<float>();
        const std::size_t center = (128 * 256 + 128) * 4;
        std::size_t covered = 0;
        for (std::size_t i = 3; i < pixels.size(); i += 4)
            covered += pixels[i] > 0.5F;
        std::fprintf(stderr, "%s\n", context.backend_name().c_str());
        std::printf("picture %d x %d\n", frame.image.width, frame.image.height);
        std::printf("center %.3f %.3f %.3f\n", pixels[center], pixels[center + 1],
                    pixels[center + 2]);
        std::printf("covered %.2f\n", static_cast<double>(covered) / (256.0 * 256.0));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
