// SPDX-License-Identifier: Apache-2.0
// The effect plan: for every effect one decision, with its reason in words that name what decided
// it. An effect is left out only where its contribution is exactly nothing. Pure: reads the scene,
// touches no file and no OpenGL. Tests: tests/shade/effects/plan_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "effects/light_rows.h"
#include "relief/shade/effects.h"

namespace relief {

namespace {

bool any(const glm::vec3& color) {
    return color != glm::vec3(0.0F);
}

/// What the decisions of one draw look at.
struct Subject {
    const Scene& scene;
    const Material& material;
    const Mesh& mesh;
    std::string name;  ///< "material 'body'"
};

/// Decisions of one draw, as they are asked for: canonical() has the last word.
struct Wishes {
    Features features;
    std::vector<EffectReason> reasons;

    bool decide(const char* effect, bool on, std::string reason) {
        reasons.push_back({effect, on, std::move(reason)});
        return on;
    }
};

/// A texture shows only on a mesh with texture coordinates.
bool decide_texture(Wishes& wishes, const Subject& subject, const char* effect, bool has_texture) {
    if (!has_texture) return wishes.decide(effect, false, subject.name + " has none");
    if (subject.mesh.texcoords.empty()) {
        return wishes.decide(effect, false,
                             fmt::format("{} has one, but mesh '{}' has no texture coordinates",
                                         subject.name, subject.mesh.name));
    }
    return wishes.decide(effect, true,
                         subject.name + " has one and the mesh has texture coordinates");
}

void decide_surface(Wishes& wishes, const Subject& subject) {
    const Material& material = subject.material;
    Features& f = wishes.features;
    f.unlit = wishes.decide("unlit", material.unlit,
                            subject.name + (material.unlit ? " is unlit" : " is lit"));
    f.diffuse_texture =
        decide_texture(wishes, subject, "diffuse texture", material.diffuse_texture.has_value());
    const auto& colors = subject.mesh.colors;
    const bool tinted = std::any_of(colors.begin(), colors.end(), [](const glm::vec4& color) {
        return glm::vec3(color) != glm::vec3(1.0F);
    });
    f.vertex_colors = wishes.decide("vertex colours", tinted,
                                    fmt::format("mesh '{}' has {}", subject.mesh.name,
                                                colors.empty() ? "none"
                                                : tinted       ? "them"
                                                               : "only white ones"));
    f.normal_map = decide_texture(wishes, subject, "normal map", material.normal_map.has_value());
    f.double_sided = wishes.decide(
        "double-sided normals", material.double_sided,
        subject.name + (material.double_sided ? " shows both sides" : " shows its front only"));
}

template <typename Light>
std::uint32_t decide_lights(Wishes& wishes, const char* effect, const std::vector<Light>& lights) {
    const auto shining = static_cast<std::uint32_t>(std::count_if(
        lights.begin(), lights.end(), [](const Light& light) { return shines(light); }));
    const std::string black =
        shining < lights.size() ? fmt::format(", {} of them black", lights.size() - shining) : "";
    wishes.decide(effect, shining > 0,
                  lights.empty() ? "the scene has none"
                                 : fmt::format("the scene has {}{}", lights.size(), black));
    return shining;
}

bool has_ranges(const Scene& scene) {
    const auto ranged = [](const PointLight& light) { return shines(light) && light.range; };
    return std::any_of(scene.point_lights.begin(), scene.point_lights.end(), ranged) ||
           std::any_of(scene.spot_lights.begin(), scene.spot_lights.end(),
                       [&](const SpotLight& light) { return ranged(light.point); });
}

void decide_lighting(Wishes& wishes, const Subject& subject) {
    const Material& material = subject.material;
    const Scene& scene = subject.scene;
    Features& f = wishes.features;
    f.ambient = wishes.decide("ambient", any(scene.ambient * material.ambient),
                              !any(scene.ambient)     ? "the scene has no ambient light"
                              : any(material.ambient) ? subject.name + " scatters ambient light"
                                                      : subject.name + " scatters none");
    f.directional_lights = decide_lights(wishes, "directional lights", scene.directional_lights);
    f.point_lights = decide_lights(wishes, "point lights", scene.point_lights);
    f.spot_lights = decide_lights(wishes, "spot lights", scene.spot_lights);
    const bool ranges = has_ranges(scene);
    f.light_ranges = wishes.decide("light ranges", ranges,
                                   ranges ? "a point or spot light has one" : "no light has one");
    const std::uint32_t rows = light_row_layout(f).count;
    f.lights_in_buffer = wishes.decide(
        "light buffer", rows > max_block_rows,
        fmt::format("the lights take {} of the {} rows of a uniform block", rows, max_block_rows));
    f.diffuse =
        wishes.decide("diffuse", any(material.diffuse),
                      subject.name + (any(material.diffuse) ? " scatters light" : " is black"));
    const bool phong = material.specular_model == SpecularModel::phong;
    if (wishes.decide("highlights", any(material.specular),
                      !any(material.specular) ? subject.name + " has none"
                      : phong                 ? subject.name + " has Phong's"
                                              : subject.name + " has Blinn and Phong's")) {
        f.specular = phong ? SpecularTerm::phong : SpecularTerm::blinn_phong;
    }
}

void decide_radiance(Wishes& wishes, const Subject& subject) {
    const Material& material = subject.material;
    Features& f = wishes.features;
    f.emission = wishes.decide("emission", any(material.emission),
                               subject.name + (any(material.emission) ? " shines" : " has none"));
    f.emission_texture =
        decide_texture(wishes, subject, "emission texture", material.emission_texture.has_value());
    const bool environment = subject.scene.environment.has_value();
    f.reflection = wishes.decide("reflection", environment && any(material.reflectivity),
                                 !any(material.reflectivity) ? subject.name + " reflects nothing"
                                 : environment               ? subject.name +
                                                     " reflects and there is an "
                                                     "environment"
                                               : "the scene has no environment");
}

/// An effect that was wished for and is gone after canonical(): how to see that, and why.
struct Dropped {
    const char* effect;
    std::function<bool(const Features&)> on;
    const char* reason;
};

/// Why canonical() drops what it drops, in words.
const std::vector<Dropped>& droppable() {
    const char* const unlit_or_dark = "no light reaches the surface, or it does nothing with it";
    static const std::vector<Dropped> all = {
        {"diffuse texture", [](const Features& f) { return f.diffuse_texture; },
         "nothing is scattered that it could tint"},
        {"vertex colours", [](const Features& f) { return f.vertex_colors; },
         "nothing is scattered that they could tint"},
        {"normal map", [](const Features& f) { return f.normal_map; },
         "neither light nor reflection shows the normal"},
        {"double-sided normals", [](const Features& f) { return f.double_sided; },
         "neither light nor reflection shows the normal"},
        {"ambient", [](const Features& f) { return f.ambient; }, "the material is unlit"},
        {"directional lights", [](const Features& f) { return f.directional_lights > 0; },
         "the material does nothing with light"},
        {"point lights", [](const Features& f) { return f.point_lights > 0; },
         "the material does nothing with light"},
        {"spot lights", [](const Features& f) { return f.spot_lights > 0; },
         "the material does nothing with light"},
        {"light ranges", [](const Features& f) { return f.light_ranges; }, unlit_or_dark},
        {"light buffer", [](const Features& f) { return f.lights_in_buffer; }, unlit_or_dark},
        {"diffuse", [](const Features& f) { return f.diffuse; }, "no light reaches the surface"},
        {"highlights", [](const Features& f) { return f.specular != SpecularTerm::none; },
         "no light reaches the surface"},
        {"emission", [](const Features& f) { return f.emission; }, "the material is unlit"},
        {"emission texture", [](const Features& f) { return f.emission_texture; },
         "the material has no emission that it could tint"},
        {"reflection", [](const Features& f) { return f.reflection; }, "the material is unlit"},
    };
    return all;
}

/// The wishes that can show, and the reasons put right for those that cannot.
Wishes granted(Wishes wishes) {
    const Features shown = canonical(wishes.features);
    for (const Dropped& dropped : droppable()) {
        if (!dropped.on(wishes.features) || dropped.on(shown)) continue;
        const auto entry =
            std::find_if(wishes.reasons.begin(), wishes.reasons.end(),
                         [&](const EffectReason& r) { return r.effect == dropped.effect; });
        entry->on = false;
        entry->reason = shown.unlit ? "the material is unlit" : dropped.reason;
    }
    wishes.features = shown;
    return wishes;
}

Wishes decide(const Scene& scene, const Material& material, const Mesh& mesh, OutputCoding output) {
    const Subject subject{scene, material, mesh, fmt::format("material '{}'", material.name)};
    Wishes wishes;
    wishes.features.output = output;
    decide_surface(wishes, subject);
    decide_lighting(wishes, subject);
    decide_radiance(wishes, subject);
    return granted(std::move(wishes));
}

/// The plan of one range, with what its normal map asks of the mesh.
DrawPlan plan_draw(const Scene& scene, std::size_t instance, const MaterialRange& range,
                   OutputCoding output) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const Material& material =
        range.material ? scene.materials[*range.material] : default_material();
    Wishes wishes = decide(scene, material, mesh, output);
    DrawPlan draw;
    draw.instance = instance;
    draw.range = range;
    draw.features = wishes.features;
    draw.needs_tangents = draw.features.normal_map && mesh.tangents.empty();
    wishes.decide("computed tangents", draw.needs_tangents,
                  !draw.features.normal_map ? "nothing uses tangents"
                  : draw.needs_tangents     ? fmt::format("mesh '{}' has none", mesh.name)
                                            : fmt::format("mesh '{}' has its own", mesh.name));
    draw.reasons = std::move(wishes.reasons);
    return draw;
}

void plan_frame_effects(const Scene& scene, FramePlan& plan) {
    const bool present = scene.environment.has_value();
    plan.skybox = present && scene.environment->skybox;
    plan.reasons.push_back({"skybox", plan.skybox,
                            plan.skybox ? "the environment is to be seen behind the model"
                            : present   ? "the environment is not to be seen itself"
                                        : "the scene has no environment"});
    const bool reflected =
        std::any_of(plan.draws.begin(), plan.draws.end(),
                    [](const DrawPlan& draw) { return draw.features.reflection; });
    plan.environment_map = plan.skybox || reflected;
    plan.reasons.push_back({"environment map", plan.environment_map,
                            reflected     ? "a material reflects it"
                            : plan.skybox ? "the skybox shows it"
                            : present     ? "nothing shows it"
                                          : "the scene has no environment"});
}

}  // namespace

const Material& default_material() {
    static const Material material = [] {
        Material result;
        result.name = "default";
        return result;
    }();
    return material;
}

Features features_of(const Scene& scene, const Material& material, const Mesh& mesh,
                     OutputCoding output) {
    return decide(scene, material, mesh, output).features;
}

FramePlan plan_effects(const Scene& scene, OutputCoding output) {
    FramePlan plan;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        const MaterialRange whole{0, static_cast<std::uint32_t>(mesh.triangles.size()),
                                  std::nullopt};
        const std::vector<MaterialRange>& ranges = mesh.material_ranges;
        if (ranges.empty()) plan.draws.push_back(plan_draw(scene, i, whole, output));
        for (const MaterialRange& range : ranges) {
            plan.draws.push_back(plan_draw(scene, i, range, output));
        }
    }
    plan_frame_effects(scene, plan);
    return plan;
}

}  // namespace relief
