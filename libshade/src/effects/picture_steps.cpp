// SPDX-License-Identifier: Apache-2.0
// Steps of a picture: one table with the effects of each step, which are forced off before it.
// Tests: tests/shade/effects/picture_steps_test.cpp.
#include "relief/shade/picture_steps.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "effects/shader_source.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

struct StepRow {
    const char* name;
    const char* what;
    std::vector<std::string_view> effects;  ///< By name. Effects in no row are in every step.
};

const std::vector<StepRow>& step_rows() {
    static const std::vector<StepRow> rows = {
        {"ambient",
         "light from everywhere, scattered by the surface",
         {"ambient", "environment light"}},
        {"diffuse",
         "light sources, scattered by the angle to the normal; glTF's surfaces also mirror them",
         {"diffuse"}},
        {"highlights",
         "the mirror images of light sources",
         {"Phong highlights", "Blinn-Phong highlights", "highlight colors"}},
        {"shadows",
         "surfaces hide light",
         {"shadow", "self-shadow", "vertex occlusion", "occlusion texture"}},
        {"maps",
         "textures of colors, and maps that bend the normal",
         {"diffuse texture", "specular texture", "normal map", "object-space normal map",
          "bump map", "specular antialiasing", "parallax mapping", "parallax occlusion mapping",
          "relief mapping", "relaxed cones", "maximum mipmaps", "clipped relief", "curved relief",
          "written depth", "displaced shadow"}},
        {"reflection",
         "the environment, mirrored and refracted",
         {"mirror reflection", "glossy reflection", "reflection by normal", "refraction",
          "transmission", "environment tint"}},
        {"Fresnel",
         "reflection by the angle of the view",
         {"Schlick's Fresnel", "dielectric Fresnel", "conductor Fresnel", "highlight Fresnel"}},
        {"layers",
         "fabric, coat, film, brushed facets, and light that bounces between facets",
         {"sheen", "clearcoat", "iridescence", "anisotropy", "energy compensation"}},
        {"emission", "light that the surface emits", {"emission"}},
    };
    return rows;
}

bool has_tone(const Scene& scene, const FrameSettings& settings) {
    return settings.output == OutputCoding::srgb &&
           (scene.exposure != 1.0F || scene.tone_mapping != ToneMapping::none);
}

/// The effects of a row that are on in the picture.
std::vector<std::string> effects_of(const StepRow& row, const std::set<std::string>& in_picture) {
    std::vector<std::string> names;
    for (const std::string_view name : row.effects) {
        if (in_picture.contains(std::string(name))) names.emplace_back(name);
    }
    return names;
}

std::vector<Features> features_in(const FramePlan& plan) {
    std::vector<Features> features;
    for (const DrawPlan& draw : plan.draws)
        features.push_back(draw.features);
    return features;
}

/// The parts of the surfaces' programs and of the finishing pass.
std::set<std::string> parts_in(const Scene& scene, const FramePlan& plan,
                               const FrameSettings& settings) {
    const ShaderTexts texts = settings.shaders ? *settings.shaders : ShaderTexts{};
    std::set<std::string> parts;
    for (const ShaderListing& listing : shader_listings(plan, texts))
        parts.insert(listing.files.begin(), listing.files.end());
    if (!plan.finishing_pass) return parts;
    const char* const samples =
        settings.samples > 1 ? "picture.glsl#four_samples" : "picture.glsl#one_sample";
    const SurfaceProgram finish = pass_program(
        "picture", finishing_steps(settings.output, scene, samples), GlslVersion::core_330, texts);
    parts.insert(finish.fragment.parts.begin(), finish.fragment.parts.end());
    return parts;
}

/// All steps, also those that change nothing.
std::vector<PictureStep> possible_steps(const Scene& scene, const FrameSettings& settings) {
    const std::vector<std::string> names = effects_in(plan_effects(scene, settings));
    const std::set<std::string> in_picture(names.begin(), names.end());
    std::vector<PictureStep> steps;
    for (const StepRow& row : step_rows()) {
        std::vector<std::string> effects = effects_of(row, in_picture);
        if (effects.empty()) continue;
        for (PictureStep& before : steps) {
            for (const std::string& effect : effects)
                before.request.forced.push_back({effect, false});
        }
        steps.push_back({row.name, row.what, std::move(effects), {}, {}, false});
    }
    if (has_tone(scene, settings)) {
        PictureStep tone;
        tone.name = "tone curve";
        tone.what = "exposure, and the curve for light brighter than white";
        steps.push_back(std::move(tone));
    }
    if (steps.empty()) {
        PictureStep whole;
        whole.name = "picture";
        whole.what = "everything at once";
        steps.push_back(std::move(whole));
    }
    steps.back().is_toned = true;
    return steps;
}

}  // namespace

std::vector<PictureStep> picture_steps(const Scene& scene, const FrameSettings& settings) {
    std::vector<PictureStep> steps;
    std::vector<Features> before;
    std::set<std::string> parts_before;
    for (PictureStep& step : possible_steps(scene, settings)) {
        const Scene shown = scene_of_step(scene, step);
        const FramePlan plan = plan_of_step(shown, settings, step);
        std::vector<Features> features = features_in(plan);
        const bool tones = step.is_toned && has_tone(scene, settings);
        if (!steps.empty() && features == before && !tones) continue;
        const std::set<std::string> parts = parts_in(shown, plan, settings);
        std::set_difference(parts.begin(), parts.end(), parts_before.begin(), parts_before.end(),
                            std::back_inserter(step.parts));
        before = std::move(features);
        parts_before = parts;
        steps.push_back(std::move(step));
    }
    return steps;
}

Scene scene_of_step(const Scene& scene, const PictureStep& step) {
    Scene result = scene;
    if (!step.is_toned) {
        result.exposure = 1.0F;
        result.tone_mapping = ToneMapping::none;
    }
    return result;
}

FramePlan plan_of_step(const Scene& scene, const FrameSettings& settings, const PictureStep& step) {
    return force_effects(scene, settings, plan_effects(scene, settings), step.request);
}

}  // namespace relief::shade
