// SPDX-License-Identifier: Apache-2.0
// The effect plan: for every effect one decision, with its reason in words that name what decided
// it. An effect is left out only where its contribution is exactly nothing. Pure: reads the scene,
// touches no file and no OpenGL. Tests: tests/shade/effects/plan_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "effects/light_rows.h"
#include "effects/why_hidden.h"
#include "relief/shade/effects.h"
#include "relief/shade/labels.h"

namespace relief {

namespace {

/// What the decisions of one draw look at.
struct Subject {
    const Scene& scene;
    const Material& material;
    const Mesh& mesh;
    std::string name;  ///< "material 'body'"
};

/// Decisions of one draw, as they are asked for: canonical() has the last word.
struct DrawWishes {
    Features features;
    std::vector<EffectReason> reasons;

    bool decide(const char* effect, bool on, std::string reason) {
        reasons.push_back({effect, on, std::move(reason)});
        return on;
    }
};

/// A texture shows only on a mesh with texture coordinates.
bool decide_texture(DrawWishes& wishes, const Subject& subject, const char* effect,
                    bool has_texture) {
    if (!has_texture) return wishes.decide(effect, false, subject.name + " has none");
    if (subject.mesh.texcoords.empty()) {
        return wishes.decide(effect, false,
                             fmt::format("{} has one, but mesh '{}' has no texture coordinates",
                                         subject.name, subject.mesh.name));
    }
    return wishes.decide(effect, true,
                         subject.name + " has one and the mesh has texture coordinates");
}

void decide_model(DrawWishes& wishes, const Subject& subject) {
    const Material& material = subject.material;
    const bool physical = material.metallic_roughness.has_value();
    Features& f = wishes.features;
    f.unlit = wishes.decide("unlit", material.unlit,
                            subject.name + (material.unlit ? " is unlit" : " is lit"));
    f.metallic_roughness =
        wishes.decide("metallic-roughness", physical,
                      subject.name + (physical ? " is glTF's model" : " is Phong's model"));
    f.metallic_roughness_texture =
        decide_texture(wishes, subject, "metallic-roughness texture",
                       physical && material.metallic_roughness->texture.has_value());
    f.interpolation = material.interpolation;
    const bool gouraud = material.interpolation == Interpolation::gouraud;
    const bool flat = material.interpolation == Interpolation::flat;
    wishes.decide("Gouraud", gouraud,
                  subject.name + (gouraud ? " is lit at its vertices" : " is lit at every pixel"));
    wishes.decide("flat", flat,
                  subject.name + (flat ? " shows its facets" : " interpolates its normals"));
}

/// Whether vertex colours change anything, alpha included where it counts.
bool has_tint(const Subject& subject) {
    const bool alpha_counts = subject.material.alpha_mode != AlphaMode::opaque;
    const auto& colors = subject.mesh.colors;
    return std::any_of(colors.begin(), colors.end(), [&](const glm::vec4& color) {
        return glm::vec3(color) != glm::vec3(1.0F) || (alpha_counts && color.a != 1.0F);
    });
}

/// Alpha is looked at only where something says less than 1.
AlphaMode shown_alpha_mode(const Subject& subject, bool textured, bool tinted) {
    const Material& material = subject.material;
    if (material.alpha_mode == AlphaMode::opaque) return AlphaMode::opaque;
    const bool varies = textured || tinted || material.opacity < 1.0F;
    if (material.alpha_mode == AlphaMode::blend) {
        return varies ? AlphaMode::blend : AlphaMode::opaque;
    }
    const bool all_there = !varies && material.alpha_cutoff <= 1.0F;
    return all_there ? AlphaMode::opaque : AlphaMode::mask;
}

void decide_color(DrawWishes& wishes, const Subject& subject) {
    const Material& material = subject.material;
    Features& f = wishes.features;
    f.diffuse_texture =
        decide_texture(wishes, subject, "diffuse texture", material.diffuse_texture.has_value());
    const bool tinted = has_tint(subject);
    const auto& colors = subject.mesh.colors;
    f.vertex_colors = wishes.decide("vertex colours", tinted,
                                    fmt::format("mesh '{}' has {}", subject.mesh.name,
                                                colors.empty() ? "none"
                                                : tinted       ? "them"
                                                               : "only white ones"));
    const bool opacity = material.opacity_texture && !subject.mesh.texcoords.empty();
    f.alpha = shown_alpha_mode(subject, f.diffuse_texture || opacity, tinted);
    const std::string reason =
        material.alpha_mode == AlphaMode::opaque ? subject.name + " is opaque"
        : f.alpha == AlphaMode::opaque           ? subject.name + " is covered everywhere"
        : f.alpha == AlphaMode::mask ? subject.name + " has holes where alpha is below its cutoff"
                                     : subject.name + " lets through what is behind it";
    wishes.decide("alpha mask", f.alpha == AlphaMode::mask, reason);
    wishes.decide("alpha blending", f.alpha == AlphaMode::blend, reason);
    f.opacity_texture =
        decide_texture(wishes, subject, "opacity texture", material.opacity_texture.has_value());
}

void decide_normal(DrawWishes& wishes, const Subject& subject) {
    const Material& material = subject.material;
    Features& f = wishes.features;
    const bool object_space =
        material.normal_map && material.normal_map->space == NormalSpace::object;
    if (decide_texture(wishes, subject, "normal map", material.normal_map && !object_space)) {
        f.detail = NormalDetail::normal_map;
    }
    if (decide_texture(wishes, subject, "object-space normal map", object_space)) {
        f.detail = NormalDetail::object_normal_map;
    }
    if (decide_texture(wishes, subject, "bump map", material.bump_map.has_value())) {
        f.detail = NormalDetail::bump_map;
    }
    const bool derived = material.tangent_frame == TangentFrame::derivatives;
    f.frame = material.tangent_frame;
    wishes.decide("derivative frames", derived,
                  subject.name + (derived ? " takes its frame from derivatives"
                                          : " uses the mesh's tangents"));
    f.specular_antialiasing = wishes.decide(
        "specular antialiasing", material.specular_antialiasing,
        subject.name + (material.specular_antialiasing ? " asks for it" : " does not ask for it"));
    f.double_sided = wishes.decide(
        "double-sided normals", material.double_sided,
        subject.name + (material.double_sided ? " shows both sides" : " shows its front only"));
}

template <typename Light>
std::uint32_t decide_lights(DrawWishes& wishes, const char* effect,
                            const std::vector<Light>& lights) {
    const auto shining = static_cast<std::uint32_t>(std::count_if(
        lights.begin(), lights.end(), [](const Light& light) { return shines(light); }));
    const std::string black =
        shining < lights.size() ? fmt::format(", {} of them black", lights.size() - shining) : "";
    wishes.decide(effect, shining > 0,
                  lights.empty() ? "the scene has none"
                                 : fmt::format("the scene has {}{}", lights.size(), black));
    return shining;
}

/// The shining lamps that have a place.
std::vector<const PointLight*> placed_lamps(const Scene& scene) {
    std::vector<const PointLight*> lamps;
    for (const PointLight& light : scene.point_lights)
        if (shines(light)) lamps.push_back(&light);
    for (const SpotLight& light : scene.spot_lights)
        if (shines(light)) lamps.push_back(&light.point);
    return lamps;
}

void decide_falloff(DrawWishes& wishes, const Scene& scene) {
    Features& f = wishes.features;
    const std::vector<const PointLight*> lamps = placed_lamps(scene);
    const auto falling = std::count_if(lamps.begin(), lamps.end(), [](const PointLight* light) {
        return light->falloff == Falloff::inverse_square;
    });
    const bool all_fall = falling == std::ssize(lamps);
    f.falloff = all_fall       ? FalloffTerm::inverse_square
                : falling == 0 ? FalloffTerm::none
                               : FalloffTerm::mixed;
    wishes.decide("no falloff", f.falloff == FalloffTerm::none,
                  all_fall       ? "every lamp falls off with the squared distance"
                  : falling == 0 ? "no lamp falls off with distance"
                                 : "some lamps fall off with distance");
    wishes.decide("mixed falloff", f.falloff == FalloffTerm::mixed,
                  all_fall || falling == 0 ? "all lamps follow one law"
                                           : "some lamps fall off with distance and some do not");
    const bool ranges = std::any_of(lamps.begin(), lamps.end(), [](const PointLight* light) {
        return light->range.has_value();
    });
    f.light_ranges = wishes.decide("light ranges", ranges,
                                   ranges ? "a point or spot light has one" : "no light has one");
}

bool has_highlight_colors(const Scene& scene) {
    const auto differs = [](const std::optional<glm::vec3>& highlights, const glm::vec3& light) {
        return highlights && *highlights != light;
    };
    const std::vector<const PointLight*> lamps = placed_lamps(scene);
    return std::any_of(lamps.begin(), lamps.end(),
                       [&](const PointLight* light) {
                           return differs(light->highlight_intensity, light->intensity);
                       }) ||
           std::any_of(scene.directional_lights.begin(), scene.directional_lights.end(),
                       [&](const DirectionalLight& light) {
                           return differs(light.highlight_irradiance, light.irradiance);
                       });
}

void decide_lamps(DrawWishes& wishes, const Subject& subject) {
    const Scene& scene = subject.scene;
    Features& f = wishes.features;
    f.directional_lights = decide_lights(wishes, "directional lights", scene.directional_lights);
    f.point_lights = decide_lights(wishes, "point lights", scene.point_lights);
    f.spot_lights = decide_lights(wishes, "spot lights", scene.spot_lights);
    decide_falloff(wishes, scene);
    const bool colors = has_highlight_colors(scene);
    f.highlight_colors =
        wishes.decide("highlight colours", colors,
                      colors ? "a lamp's highlights have a colour of their own"
                             : "every lamp's highlights have the colour of its light");
    const std::uint32_t rows = light_row_layout(f).count;
    f.lights_in_buffer = wishes.decide(
        "light buffer", rows > max_block_rows,
        fmt::format("the lights take {} of the {} rows of a uniform block", rows, max_block_rows));
}

void decide_scattering(DrawWishes& wishes, const Subject& subject) {
    const Material& material = subject.material;
    const Scene& scene = subject.scene;
    const bool physical = material.metallic_roughness.has_value();
    Features& f = wishes.features;
    const bool takes_ambient = physical || is_not_black(material.ambient);
    f.ambient = wishes.decide(
        "ambient",
        physical ? is_not_black(scene.ambient) : is_not_black(scene.ambient * material.ambient),
        !is_not_black(scene.ambient) ? "the scene has no ambient light"
        : takes_ambient              ? subject.name + " scatters ambient light"
                                     : subject.name + " scatters none");
    const bool scatters = physical || is_not_black(material.diffuse);
    f.diffuse = wishes.decide("diffuse", scatters,
                              subject.name + (scatters ? " scatters light" : " is black"));
    const bool sheds = scene.environment && scene.environment->lights;
    f.environment_diffuse = wishes.decide(
        "environment light", sheds && scatters,
        !scene.environment ? "the scene has no environment"
        : !sheds           ? "the environment is not to light surfaces"
                 : subject.name + (scatters ? " scatters the environment's light" : " is black"));
    f.occlusion_texture = decide_texture(
        wishes, subject, "occlusion texture",
        material.occlusion_texture.has_value() && material.occlusion_strength > 0.0F);
}

void decide_highlights(DrawWishes& wishes, const Subject& subject) {
    const Material& material = subject.material;
    Features& f = wishes.features;
    const bool physical = material.metallic_roughness.has_value();
    const bool phong = material.specular_model == SpecularModel::phong;
    const bool shiny = !physical && is_not_black(material.specular);
    const std::string reason =
        physical ? subject.name + " has those of its own model"
        : !shiny ? subject.name + " has none"
                 : subject.name + (phong ? " has Phong's" : " has the half vector's");
    if (wishes.decide("Phong highlights", shiny && phong, reason)) f.specular = SpecularTerm::phong;
    if (wishes.decide("Blinn-Phong highlights", shiny && !phong, reason)) {
        f.specular = SpecularTerm::blinn_phong;
    }
    f.specular_texture =
        decide_texture(wishes, subject, "specular texture", material.specular_texture.has_value());
    f.emission =
        wishes.decide("emission", is_not_black(material.emission),
                      subject.name + (is_not_black(material.emission) ? " shines" : " has none"));
    f.emission_texture =
        decide_texture(wishes, subject, "emission texture", material.emission_texture.has_value());
}

void decide_fresnel(DrawWishes& wishes, const Subject& subject, bool reflects) {
    const Material& material = subject.material;
    const bool varies = material.grazing_reflectivity != material.reflectivity;
    const FresnelTerm term = material.fresnel == FresnelModel::dielectric  ? FresnelTerm::dielectric
                             : material.fresnel == FresnelModel::conductor ? FresnelTerm::conductor
                             : varies                                      ? FresnelTerm::schlick
                                                                           : FresnelTerm::constant;
    wishes.features.fresnel = term;
    const std::string none = !reflects                     ? subject.name + " reflects nothing"
                             : material.metallic_roughness ? subject.name + " has its own model's"
                                                           : "";
    const auto decide = [&](const char* effect, FresnelTerm which, const char* otherwise) {
        const bool on = none.empty() && term == which;
        wishes.decide(effect, on, !none.empty() ? none : on ? subject.name + " has it" : otherwise);
    };
    decide("Schlick's Fresnel", FresnelTerm::schlick,
           varies ? "an exact form is asked for" : "reflectivity is the same at every angle");
    decide("dielectric Fresnel", FresnelTerm::dielectric, "it is not asked for");
    decide("conductor Fresnel", FresnelTerm::conductor, "it is not asked for");
}

void decide_reflection(DrawWishes& wishes, const Subject& subject) {
    const Material& material = subject.material;
    Features& f = wishes.features;
    const bool physical = material.metallic_roughness.has_value();
    const bool environment = subject.scene.environment.has_value();
    const bool mirrors = physical || is_not_black(material.reflectivity);
    const bool rough = physical || material.reflection_roughness > 0.0F;
    const bool reflects = environment && mirrors;
    const std::string reason = !mirrors       ? subject.name + " reflects nothing"
                               : !environment ? "the scene has no environment"
                               : rough ? subject.name + " is rough and there is an environment"
                                       : subject.name + " is a mirror and there is an environment";
    wishes.decide("mirror reflection", reflects && !rough, reason);
    wishes.decide("glossy reflection", reflects && rough, reason);
    f.reflection = !reflects ? ReflectionTerm::none
                   : rough   ? ReflectionTerm::glossy
                             : ReflectionTerm::mirror;
    decide_fresnel(wishes, subject, reflects);
    const bool transmits = material.transmission > 0.0F && !physical;
    f.refraction =
        wishes.decide("refraction", transmits && environment,
                      !transmits     ? subject.name + " lets nothing through"
                      : !environment ? "the scene has no environment"
                                     : subject.name + " lets through what it does not mirror");
}

void decide_picture(DrawWishes& wishes, const Scene& scene) {
    Features& f = wishes.features;
    f.exposure = wishes.decide("exposure", scene.exposure != 1.0F,
                               fmt::format("the scene's exposure is {}", scene.exposure));
    f.tone_mapping = scene.tone_mapping;
    const bool none = scene.tone_mapping == ToneMapping::none;
    const auto decide = [&](const char* effect, ToneMapping which) {
        const bool on = scene.tone_mapping == which;
        wishes.decide(effect, on,
                      on     ? "the scene asks for it"
                      : none ? "radiance above 1 is shown as 1"
                             : "the scene asks for another curve");
    };
    decide("Reinhard tone mapping", ToneMapping::reinhard);
    decide("ACES tone mapping", ToneMapping::aces);
}

/// The wishes that can show, and the reasons put right for those that cannot.
DrawWishes granted(DrawWishes wishes) {
    const Features shown = canonical(wishes.features);
    for (const Effect& effect : effects()) {
        const auto entry =
            std::find_if(wishes.reasons.begin(), wishes.reasons.end(),
                         [&](const EffectReason& r) { return r.effect == effect.name; });
        if (entry == wishes.reasons.end() || !entry->on || effect.on(shown)) continue;
        entry->on = false;
        entry->reason = why_hidden(effect, wishes.features, shown);
    }
    wishes.features = shown;
    return wishes;
}

/// \param name  of the material, for the reasons
DrawWishes decide(const Scene& scene, const Material& material, const std::string& name,
                  const Mesh& mesh, OutputCoding output) {
    const Subject subject{scene, material, mesh, name};
    DrawWishes wishes;
    wishes.features.output = output;
    decide_model(wishes, subject);
    decide_color(wishes, subject);
    decide_normal(wishes, subject);
    decide_lamps(wishes, subject);
    decide_scattering(wishes, subject);
    decide_highlights(wishes, subject);
    decide_reflection(wishes, subject);
    decide_picture(wishes, scene);
    return granted(std::move(wishes));
}

/// The plan of one range, with what its maps ask of the mesh.
DrawPlan plan_draw(const Scene& scene, std::size_t instance, const MaterialRange& range,
                   OutputCoding output) {
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const Material& material =
        range.material ? scene.materials[*range.material] : default_material();
    DrawWishes wishes =
        decide(scene, material, material_label(scene, range.material), mesh, output);
    const Features& f = wishes.features;
    DrawPlan draw;
    draw.instance = instance;
    draw.range = range;
    draw.features = f;
    const bool uses_tangents =
        (f.detail == NormalDetail::normal_map || f.detail == NormalDetail::bump_map) &&
        f.frame == TangentFrame::stored;
    draw.needs_tangents = uses_tangents && mesh.tangents.empty();
    const std::string mesh_name = mesh_label(scene, scene.instances[instance].mesh);
    wishes.decide("computed tangents", draw.needs_tangents,
                  !uses_tangents        ? "nothing uses tangents"
                  : draw.needs_tangents ? mesh_name + " has none"
                                        : mesh_name + " has its own");
    draw.reasons = std::move(wishes.reasons);
    return draw;
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
    return decide(scene, material, "the material", mesh, output).features;
}

FramePlan plan_effects(const Scene& scene, const FrameSettings& settings) {
    FramePlan plan;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        const MaterialRange whole{0, static_cast<std::uint32_t>(mesh.triangles.size()),
                                  std::nullopt};
        const std::vector<MaterialRange>& ranges = mesh.material_ranges;
        if (ranges.empty()) plan.draws.push_back(plan_draw(scene, i, whole, settings.output));
        for (const MaterialRange& range : ranges) {
            plan.draws.push_back(plan_draw(scene, i, range, settings.output));
        }
    }
    plan_frame(scene, settings, plan);
    return plan;
}

}  // namespace relief
