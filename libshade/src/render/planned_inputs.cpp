// SPDX-License-Identifier: Apache-2.0
// Descriptions of the attributes, textures and passes of a plan, from the tables that drawing uses.
// Tests: tests/shade/render/draw_values_test.cpp.
#include "relief/shade/effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "effects/features.h"
#include "render/textures.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

struct AttributeRow {
    const char* name;
    bool (*stored)(const Mesh& mesh);
    const char* reason;
};

const std::vector<AttributeRow>& attribute_rows() {
    static const std::vector<AttributeRow> all = {
        {"position_object", [](const Mesh& m) { return !m.positions.empty(); },
         "every vertex has a position"},
        {"normal_object", [](const Mesh& m) { return !m.normals.empty(); },
         "light or a reflection shows the normal"},
        {"tangent_object", [](const Mesh& m) { return !m.tangents.empty(); },
         "a map or anisotropy lies in the mesh's tangent frame"},
        {"texcoord", [](const Mesh& m) { return !m.texcoords.empty(); }, "textures are sampled"},
        {"texcoord_2", [](const Mesh& m) { return !m.texcoords_2.empty(); },
         "textures are sampled at the second texture coordinates"},
        {"color_linear", [](const Mesh& m) { return !m.colors.empty(); },
         "vertex colors tint the surface"},
    };
    return all;
}

/// A sampler that belongs to no material: whether it has mip levels, and its reason.
struct SharedSampler {
    bool mip_chain;
    const char* reason;
};

const std::map<std::string_view, SharedSampler>& shared_samplers() {
    static const std::map<std::string_view, SharedSampler> all = {
        {"environment", {true, "the surface reflects it, refracts it or has its color"}},
        {"blurred_environment", {true, "the surface reflects it blurred; one level per roughness"}},
        {"environment_brdf", {false, "how much a rough surface reflects, by angle and roughness"}},
        {"behind", {true, "the surface shows what is behind it; levels for roughness"}},
        {"light_buffer", {false, "the lights are in a buffer"}},
        {"shadow_maps",
         {false, "surfaces hide the main light; one layer for each sampled point of it"}},
        {"joint_matrices", {false, "joints move the vertices"}},
        {"joint_weights", {false, "each vertex follows some of the joints"}},
        {"morph_weights", {false, "morph targets have weights"}},
        {"morph_displacements", {false, "morph targets displace the vertices"}},
        {"hidden_shares", {false, "surfaces hide light from all around, by vertex"}},
        {"facet_corners", {false, "the normals are those of the deformed triangles"}},
    };
    return all;
}

PlannedTexture texture_of(const Scene& scene, const DrawPlan& draw, const std::string& sampler) {
    const auto shared = shared_samplers().find(sampler);
    if (shared != shared_samplers().end()) {
        return {sampler, "", shared->second.mip_chain, shared->second.reason};
    }
    const Material& material =
        draw.range.material ? scene.materials[*draw.range.material] : default_material();
    const Mesh& mesh = scene.meshes[scene.instances[draw.instance].mesh];
    for (const UsedTexture& used : used_textures(draw.features, material, mesh)) {
        if (slot_info(used.slot).sampler != sampler) continue;
        if (used.texture == nullptr) return {sampler, "", false, "neutral: forced on"};
        return {sampler, scene.images[used.texture->image].name, true,
                material_label(scene, draw.range.material) + " has it"};
    }
    return {sampler, "", false, ""};
}

}  // namespace

DrawInputs planned_inputs(const Scene& scene, const DrawPlan& draw) {
    const PlannedInterface planned = planned_interface(draw.features);
    const Mesh& mesh = scene.meshes[scene.instances[draw.instance].mesh];
    DrawInputs inputs;
    for (const AttributeRow& row : attribute_rows()) {
        if (!std::binary_search(planned.attributes.begin(), planned.attributes.end(), row.name)) {
            continue;
        }
        inputs.attributes.push_back({row.name, row.stored(mesh), row.reason});
    }
    for (const std::string& sampler : planned.samplers)
        inputs.textures.push_back(texture_of(scene, draw, sampler));
    return inputs;
}

std::vector<PlannedPass> planned_passes(const FramePlan& plan) {
    enum class Kind { covering, transmissive, blended };
    const auto any = [&](Kind kind) {
        return std::any_of(plan.draws.begin(), plan.draws.end(), [&](const DrawPlan& draw) {
            const Features& f = draw.features;
            return kind == (f.alpha == AlphaMode::blend ? Kind::blended
                            : transmits(f)              ? Kind::transmissive
                                                        : Kind::covering);
        });
    };
    std::vector<PlannedPass> passes;
    if (plan.shadow_maps)
        passes.push_back({"shadow maps",
                          "the surfaces as the main light sees them; once while "
                          "neither moves"});
    if (any(Kind::covering)) passes.push_back({"surfaces", "nearest first by the depth buffer"});
    if (plan.skybox)
        passes.push_back({"skybox", "the environment is seen where nothing is nearer"});
    if (plan.transmission_background)
        passes.push_back({"transmission background", "a copy of the picture and its mip levels"});
    if (any(Kind::transmissive)) passes.push_back({"transmissive surfaces", "they show the copy"});
    if (any(Kind::blended)) passes.push_back({"blended surfaces", "sorted, farthest first"});
    for (const EffectReason& reason : plan.reasons) {
        if (reason.effect == "finishing pass" && reason.on) {
            passes.push_back({"finishing", reason.reason});
        }
    }
    return passes;
}

}  // namespace relief::shade
