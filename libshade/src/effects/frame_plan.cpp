// SPDX-License-Identifier: Apache-2.0
// The effects of a whole frame, which follow from its draws: what is made of the environment, and
// how the picture is finished. Pure. Tests: tests/shade/effects/plan_test.cpp.
#include <fmt/format.h>

#include <algorithm>

#include "relief/shade/effects.h"

namespace relief {

namespace {

template <typename Condition>
bool any_draw(const FramePlan& plan, Condition condition) {
    return std::any_of(plan.draws.begin(), plan.draws.end(),
                       [&](const DrawPlan& draw) { return condition(draw.features); });
}

void plan_environment(const Scene& scene, FramePlan& plan) {
    const auto decide = [&](const char* effect, bool on, const char* why, const char* why_not) {
        plan.reasons.push_back({effect, on,
                                on                  ? why
                                : scene.environment ? why_not
                                                    : "the scene has no environment"});
        return on;
    };
    plan.skybox = decide("skybox", scene.environment && scene.environment->skybox,
                         "the environment is to be seen behind the model",
                         "the environment is not to be seen itself");
    const bool mirrored = any_draw(plan, [](const Features& f) {
        return f.reflection == ReflectionTerm::mirror || f.refraction;
    });
    plan.prefiltered_map = decide(
        "prefiltered environment",
        any_draw(plan, [](const Features& f) { return f.reflection == ReflectionTerm::glossy; }),
        "a rough material reflects it", "no rough material reflects it");
    plan.environment_brdf = decide(
        "environment BRDF table",
        any_draw(plan,
                 [](const Features& f) {
                     return f.metallic_roughness &&
                            (f.reflection == ReflectionTerm::glossy || f.environment_diffuse);
                 }),
        "a metallic-roughness material reflects the environment",
        "no metallic-roughness material reflects it");
    plan.environment_irradiance =
        decide("environment irradiance",
               any_draw(plan, [](const Features& f) { return f.environment_diffuse; }),
               "a material scatters its light", "no material scatters its light");
    plan.environment_map =
        decide("environment map",
               plan.skybox || mirrored || plan.prefiltered_map || plan.environment_irradiance,
               mirrored ? "a material mirrors it" : "the effects above are made from it",
               "nothing shows it");
}

}  // namespace

void plan_frame(const Scene& scene, const FrameSettings& settings, FramePlan& plan) {
    plan.reasons.clear();
    plan_environment(scene, plan);
    plan.sorted_blending =
        any_draw(plan, [](const Features& f) { return f.alpha == AlphaMode::blend; });
    plan.reasons.push_back({"sorted blending", plan.sorted_blending,
                            plan.sorted_blending ? "a material lets through what is behind it"
                                                 : "every material is opaque or has holes only"});
    const bool averaged = settings.samples > 1;
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
