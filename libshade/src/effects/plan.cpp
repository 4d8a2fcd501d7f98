// SPDX-License-Identifier: Apache-2.0
// The effect plan: decides every effect of every draw by the table of effects, then the frame-wide
// effects, which follow from the draws. Reads the scene and no files, except for the sizes of
// height maps; uses no OpenGL. Tests: tests/shade/effects/plan_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "effects/features.h"
#include "effects/light_rows.h"
#include "relief/shade/effects.h"
#include "relief/shade/frame_settings.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

/// The effects of one draw, canonical, and the reason of each.
struct DrawDecisions {
    Features features;
    std::vector<EffectReason> reasons;
};

/// \param name  the material's, for the reasons
DrawDecisions decide(const Scene& scene, const Material& material, const std::string& name,
                     const Mesh& mesh, const Instance* instance, OutputCoding output,
                     ShadowTerm shadow, std::optional<ReliefBounds> relief = std::nullopt) {
    DrawSubject subject = draw_subject(scene, material, name, mesh, instance, shadow);
    subject.relief = relief;
    DrawDecisions decisions;
    decisions.reasons.reserve(effect_rows().size() + 1);  // And that of computed tangents.
    Features requested = subject.lights;
    requested.output = output;
    for (const EffectRow& row : effect_rows()) {
        Decision decision = row.decide(subject);
        if (decision.on) row.effect.set(requested, true);
        decisions.reasons.push_back({row.effect.name, decision.on, std::move(decision.reason)});
    }
    requested.second_texcoords = second_texcoords_of(material);
    set_height_wraps(material, requested);
    decisions.features = canonical(requested);
    for (EffectReason& reason : decisions.reasons) {
        const EffectRow& row = *find_effect(reason.effect);
        if (!reason.on || row.effect.on(decisions.features)) continue;
        reason.on = false;
        reason.reason = hidden_reason(row, requested, decisions.features);
    }
    return decisions;
}

/// Replaces the reason of an effect, if it differs.
void set_reason(EffectReasons& reasons, EffectReason reason) {
    const auto old = std::find_if(reasons.begin(), reasons.end(),
                                  [&](const EffectReason& r) { return r.effect == reason.effect; });
    if (old == reasons.end() || (old->on == reason.on && old->reason == reason.reason)) return;
    const auto index = old - reasons.begin();
    reasons.edit()[static_cast<std::size_t>(index)] = std::move(reason);
}

DrawPlan plan_draw(const Scene& scene, std::size_t instance, const MaterialRange& range,
                   const FrameSettings& settings, ShadowTerm shadow) {
    const std::size_t mesh_index = scene.instances[instance].mesh;
    const Mesh& mesh = scene.meshes[mesh_index];
    const Material& material =
        range.material ? scene.materials[*range.material] : default_material();
    DrawDecisions decisions = decide(
        scene, material, material_label(scene, range.material), mesh, &scene.instances[instance],
        settings.output, shadow, relief_bounds(scene, scene.instances[instance], range, settings));
    const Features& f = decisions.features;
    const bool uses_tangents = lies_in_frame(f) && f.frame == TangentFrame::stored;
    const bool needs_tangents = uses_tangents && mesh.tangents.empty();
    const std::string mesh_name = mesh_label(scene, mesh_index);
    decisions.reasons.push_back({"computed tangents", needs_tangents,
                                 !uses_tangents   ? "nothing uses tangents"
                                 : needs_tangents ? mesh_name + " has none"
                                                  : mesh_name + " has its own"});
    return {instance, range, f, std::move(decisions.reasons), needs_tangents};
}

/// Equal lists of reasons, in one copy, as those of most meshes with the same material.
class SharedReasons {
  public:
    EffectReasons share(EffectReasons reasons) {
        std::size_t hash = 0;
        for (const EffectReason& reason : reasons)
            hash = 31 * hash + 2 * std::hash<std::string>()(reason.reason) + (reason.on ? 1 : 0);
        const auto [first, last] = known_.equal_range(hash);
        const auto known = std::find_if(
            first, last, [&](const auto& entry) { return are_equal(*entry.second, *reasons); });
        return known == last ? known_.emplace(hash, std::move(reasons))->second : known->second;
    }

  private:
    static bool are_equal(const std::vector<EffectReason>& a, const std::vector<EffectReason>& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [](const EffectReason& x, const EffectReason& y) {
                              return x.on == y.on && x.effect == y.effect && x.reason == y.reason;
                          });
    }

    std::unordered_multimap<std::size_t, EffectReasons> known_;
};

/// Plans draws. Only poses, open shares and reliefs distinguish the instances of a mesh, so that
/// all others share one plan for each material.
class DrawPlanner {
  public:
    DrawPlanner(const Scene& scene, const FrameSettings& settings)
        : scene_(scene), settings_(settings), shadow_(shadow_term(scene)) {}

    DrawPlan plan(std::size_t index, const MaterialRange& range) {
        const Instance& instance = scene_.instances[index];
        const bool has_relief = range.material && scene_.materials[*range.material].height_map;
        if (instance.pose || !instance.open_shares->empty() || has_relief)
            return new_plan(index, range);
        const auto [entry, is_new] = plans_.try_emplace({instance.mesh, range.material});
        if (is_new) entry->second = new_plan(index, range);
        DrawPlan plan = entry->second;
        plan.instance = index;
        plan.range = range;
        return plan;
    }

  private:
    using Key = std::pair<std::size_t, std::optional<std::uint32_t>>;

    DrawPlan new_plan(std::size_t index, const MaterialRange& range) {
        DrawPlan plan = plan_draw(scene_, index, range, settings_, shadow_);
        plan.reasons = reasons_.share(std::move(plan.reasons));
        return plan;
    }

    const Scene& scene_;
    const FrameSettings& settings_;
    ShadowTerm shadow_;
    std::map<Key, DrawPlan> plans_;
    SharedReasons reasons_;
};

/// Sets a frame-wide effect and adds its reason.
void set_frame_effect(FramePlan& plan, bool FramePlan::*effect, bool on, std::string reason) {
    const auto row = std::find_if(frame_effects.begin(), frame_effects.end(),
                                  [&](const FrameEffect& r) { return r.member == effect; });
    plan.*effect = on;
    plan.reasons.push_back({std::string(row->name), on, std::move(reason)});
}

void plan_environment(const Scene& scene, const FrameSettings& settings, FramePlan& plan) {
    const auto decide = [&](bool FramePlan::*effect, bool on, const char* if_on,
                            const char* if_off) {
        set_frame_effect(plan, effect, on,
                         on                  ? if_on
                         : scene.environment ? if_off
                                             : "the scene has no environment");
    };
    const bool is_picture = settings.view == DebugView::picture;
    decide(
        &FramePlan::skybox, scene.environment && scene.environment->skybox && is_picture,
        "the environment is visible behind the model",
        is_picture ? "the environment is not visible itself" : "a debug view shows only surfaces");
    decide(&FramePlan::blurred_skybox, plan.skybox && scene.environment->skybox_blur > 0.0F,
           "its blur is not 0", "it is not blurred or not visible");
    const EnvironmentNeeds needs = environment_needs(plan);
    decide(&FramePlan::prefiltered_map, needs.blurred,
           plan.blurred_skybox ? "the skybox is blurred" : "a rough material reflects it",
           "no rough material reflects it");
    decide(&FramePlan::environment_brdf, needs.brdf,
           "a metallic-roughness material reflects the environment or lights",
           "no metallic-roughness material reflects it");
    decide(&FramePlan::environment_irradiance, needs.irradiance, "a material scatters its light",
           "no material scatters its light");
    decide(&FramePlan::environment_map, plan.skybox || needs.any(),
           needs.sharp ? "a material shows it without blur" : "the effects above are made from it",
           "nothing shows it");
}

void plan_finishing(const FrameSettings& settings, FramePlan& plan) {
    const bool blends = std::any_of(plan.draws.begin(), plan.draws.end(), [](const DrawPlan& draw) {
        return draw.features.alpha == AlphaMode::blend;
    });
    set_frame_effect(plan, &FramePlan::sorted_blending, blends,
                     blends ? "a material is blended with what is behind it"
                            : "every material is opaque or masked");
    const bool shadows =
        std::any_of(plan.draws.begin(), plan.draws.end(),
                    [](const DrawPlan& draw) { return draw.features.shadow != ShadowTerm::none; });
    set_frame_effect(
        plan, &FramePlan::shadow_maps, shadows,
        shadows ? "a surface shows the shadow of the main light" : "no surface shows a shadow");
    const bool transmits =
        std::any_of(plan.draws.begin(), plan.draws.end(),
                    [](const DrawPlan& draw) { return shade::detail::transmits(draw.features); });
    set_frame_effect(plan, &FramePlan::transmission_background, transmits,
                     transmits ? "a material shows what is behind it by transmission"
                               : "no material shows what is behind it by transmission");
    const bool averaged = settings.samples > 1 && !is_data(settings.view);
    set_frame_effect(
        plan, &FramePlan::finishing_pass, averaged || blends || transmits,
        averaged
            ? fmt::format("{} samples per pixel are averaged in linear light", settings.samples)
        : blends    ? "what is blended must be in linear light"
        : transmits ? "what shows through surfaces must be in linear light"
                    : "one sample per pixel, and nothing is blended: surfaces write codes");
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
    return decide(scene, material, "the material", mesh, nullptr, output, shadow_term(scene))
        .features;
}

EnvironmentNeeds detail::environment_needs(const FramePlan& plan) {
    EnvironmentNeeds needs;
    needs.blurred = plan.blurred_skybox;
    for (const DrawPlan& draw : plan.draws) {
        const Features& f = draw.features;
        const bool blurs = f.reflection == ReflectionTerm::glossy && !has_black_mirror(f);
        needs.sharp |= (f.reflection == ReflectionTerm::mirror && !has_black_mirror(f)) ||
                       (f.refraction && !has_black_transmission(f)) || f.environment_tint;
        needs.blurred |= blurs;
        needs.irradiance |= f.environment_diffuse;
        needs.brdf |=
            f.energy_compensation || (f.metallic_roughness && (blurs || f.environment_diffuse));
    }
    return needs;
}

void plan_pose(const Scene& scene, FramePlan& plan) {
    for (DrawPlan& draw : plan.draws) {
        const Instance& instance = scene.instances.at(draw.instance);
        if (!draw.follows_pose || !instance.pose) continue;
        const DrawSubject subject{scene, default_material(), scene.meshes[instance.mesh], "", false,
                                  {},    &*instance.pose};
        Features requested = draw.features;
        for (const EffectRow& row : effect_rows()) {
            if (!row.follows_pose) continue;
            Decision decision = row.decide(subject);
            row.effect.set(requested, decision.on);
            set_reason(draw.reasons, {row.effect.name, decision.on, std::move(decision.reason)});
        }
        draw.features = canonical(requested);
    }
}

void plan_frame(const Scene& scene, const FrameSettings& settings, FramePlan& plan) {
    plan.reasons.clear();
    plan_environment(scene, settings, plan);
    plan_finishing(settings, plan);
    for (DrawPlan& draw : plan.draws) {
        draw.features.output = !plan.finishing_pass                      ? settings.output
                               : settings.output == OutputCoding::linear ? OutputCoding::linear
                                                                         : OutputCoding::half;
        draw.features = canonical(draw.features);
    }
}

FramePlan plan_effects(const Scene& scene, const FrameSettings& settings) {
    FramePlan plan;
    DrawPlanner planner(scene, settings);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        const MaterialRange whole{0, static_cast<std::uint32_t>(mesh.triangles.size()),
                                  std::nullopt};
        const std::vector<MaterialRange>& ranges = mesh.material_ranges;
        if (ranges.empty()) plan.draws.push_back(planner.plan(i, whole));
        for (const MaterialRange& range : ranges)
            plan.draws.push_back(planner.plan(i, range));
    }
    plan_frame(scene, settings, plan);
    return plan;
}

}  // namespace relief::shade
