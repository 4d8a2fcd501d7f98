// SPDX-License-Identifier: Apache-2.0
// Explains which effects a scene needs, and why all others are left out. This uses no OpenGL.
#include <cstdint>
#include <cstdio>

#include "relief/mesh/mesh.h"
#include "relief/shade/effects.h"
#include "relief/shade/scene.h"

int main() {
    relief::shade::Scene scene;
    scene.meshes.emplace_back(relief::make_torus());
    scene.instances.push_back({.mesh = 0, .name = "torus"});
    relief::Material material;
    material.name = "plastic";
    material.specular = glm::vec3(0.04F);
    material.emission = glm::vec3(0.0F);  // Black, so emission is left out.
    scene.materials.push_back(material);
    scene.meshes[0].edit().material_ranges = {
        {.triangle_count = static_cast<std::uint32_t>(scene.meshes[0]->triangles.size()),
         .material = 0}};
    scene.directional_lights.push_back({});

    const relief::shade::FramePlan plan =
        relief::shade::plan_effects(scene, relief::shade::FrameSettings{});
    const relief::shade::DrawPlan& draw = plan.draws.front();
    std::printf("%s\n", relief::shade::describe(draw.features).c_str());
    int on = 0;
    for (const relief::shade::EffectReason& effect : draw.reasons) {
        on += effect.on;
        std::printf("%-3s %s: %s\n", effect.on ? "on" : "off", effect.effect.c_str(),
                    effect.reason.c_str());
    }
    std::printf("%d of %zu effects\n", on, draw.reasons.size());
}
