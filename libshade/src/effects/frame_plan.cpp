// SPDX-License-Identifier: Apache-2.0
// The effects of a whole frame, which follow from its draws: what is made of the environment, and
// how the picture is finished. Pure. Tests: tests/shade/effects/plan_test.cpp.
#include <fmt/format.h>

#include <algorithm>

#include "effects/environment_needs.h"
#include "effects/view_features.h"

namespace relief {

namespace {

void plan_environment(const Scene& scene, const FrameSettings& settings, FramePlan& plan) {
    const auto decide = [&](const char* effect, bool on, const char* why, const char* why_not) {
        plan.reasons.push_back({effect, on,
                                on                  ? why
                                : scene.environment ? why_not
                                                    : "the scene has no environment"});
        return on;
    };
    const bool is_picture = settings.view == DebugView::picture;
    plan.skybox = decide("skybox", scene.environment && scene.environment->skybox && is_picture,
                         "the environment is to be seen behind the model",
                         is_picture ? "the environment is not to be seen itself"
                                    : "a debug view shows surfaces alone");
    const EnvironmentNeeds needs = environment_needs(plan);
    plan.prefiltered_map = decide("prefiltered environment", needs.blurred,
                                  "a rough material reflects it", "no rough material reflects it");
    plan.environment_brdf = decide("environment BRDF table", needs.brdf,
                                   "a metallic-roughness material reflects the environment",
                                   "no metallic-roughness material reflects it");
    plan.environment_irradiance =
        decide("environment irradiance", needs.irradiance, "a material scatters its light",
               "no material scatters its light");
    plan.environment_map =
        decide("environment map", plan.skybox || needs.any(),
               needs.sharp ? "a material mirrors it" : "the effects above are made from it",
               "nothing shows it");
}

}  // namespace

EnvironmentNeeds environment_needs(const FramePlan& plan) {
    EnvironmentNeeds needs;
    for (const DrawPlan& draw : plan.draws) {
        const Features& f = draw.features;
        const bool blurs = f.reflection == ReflectionTerm::glossy && !has_black_mirror(f);
        needs.sharp |= (f.reflection == ReflectionTerm::mirror && !has_black_mirror(f)) ||
                       (f.refraction && !has_black_transmission(f));
        needs.blurred |= blurs;
        needs.irradiance |= f.environment_diffuse;
        needs.brdf |= f.metallic_roughness && (blurs || f.environment_diffuse);
    }
    return needs;
}

void plan_frame(const Scene& scene, const FrameSettings& settings, FramePlan& plan) {
    plan.reasons.clear();
    plan_environment(scene, settings, plan);
    plan.sorted_blending =
        std::any_of(plan.draws.begin(), plan.draws.end(),
                    [](const DrawPlan& draw) { return draw.features.alpha == AlphaMode::blend; });
    plan.reasons.push_back({"sorted blending", plan.sorted_blending,
                            plan.sorted_blending ? "a material lets through what is behind it"
                                                 : "every material is opaque or has holes only"});
    const bool averaged = settings.samples > 1 && !is_data(settings.view);
    plan.finishing_pass = averaged || plan.sorted_blending;
    plan.reasons.push_back(
        {"finishing pass", plan.finishing_pass,
         averaged ? fmt::format("{} samples a pixel are averaged in linear light", settings.samples)
         : plan.sorted_blending
             ? "what is blended must be in linear light"
             : "one sample a pixel, and nothing is blended: surfaces write codes"});
    for (DrawPlan& draw : plan.draws) {
        draw.features.output = !plan.finishing_pass                      ? settings.output
                               : settings.output == OutputCoding::linear ? OutputCoding::linear
                                                                         : OutputCoding::half;
        draw.features = canonical(draw.features);
    }
}

}  // namespace relief
