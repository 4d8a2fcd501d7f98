// SPDX-License-Identifier: Apache-2.0
// The table of effects that are choices of the scene. All others are neutral where the scene gives
// them nothing to show: DrawValues' defaults and the neutral textures are chosen so. Pure.
// Tests: tests/shade/effects/effect_forcing_test.cpp, tests/shade/render/forced_effects_test.cpp.
#include "effects/neutral.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace relief {

namespace {

/// An effect that changes the picture where it is forced on, unless `neutral` says otherwise.
struct Choice {
    std::string_view effect;
    bool (*neutral)(const ForcingSubject& subject);
    const char* reason;
};

bool never(const ForcingSubject& /*subject*/) {
    return false;
}

bool has_no_map(const ForcingSubject& s) {
    return s.planned.detail == NormalDetail::none;
}

bool has_no_placed_lamps(const ForcingSubject& s) {
    return s.planned.point_lights + s.planned.spot_lights == 0;
}

/// A black environment, or none, or a surface that is black to it.
bool is_dark_around(const ForcingSubject& s) {
    if (!s.scene.environment) return true;
    return !s.material.metallic_roughness && s.material.diffuse == glm::vec3(0.0F);
}

bool is_phongs(const ForcingSubject& s) {
    return !s.planned.metallic_roughness;
}

bool mirrors_nothing(const ForcingSubject& s) {
    return s.planned.reflection == ReflectionTerm::none;
}

const std::vector<Choice>& choices() {
    static const std::vector<Choice> all = {
        {"unlit", never, "whether light counts is the material's choice"},
        {"metallic-roughness", never, "its model is the material's choice"},
        {"Gouraud", never, "where light is computed is the material's choice"},
        {"flat", never, "where light is computed is the material's choice"},
        {"alpha blending", never,
         "it hides nothing that is behind it, and is drawn after all else"},
        {"object-space normal map", never, "without a map of its own it has no neutral value"},
        {"derivative frames", never, "its map's frame is the material's choice"},
        {"specular antialiasing", has_no_map, "it would widen the highlights of its map"},
        {"no falloff", has_no_placed_lamps, "the lamps fall off with distance"},
        {"environment light", is_dark_around, "the environment is not to light surfaces"},
        {"mirror reflection", is_phongs, "metallic-roughness has its own"},
        {"dielectric Fresnel", mirrors_nothing, "how much it mirrors is the material's choice"},
        {"conductor Fresnel", mirrors_nothing, "how much it mirrors is the material's choice"},
        {"Reinhard tone mapping", never, "the tone curve is the scene's choice"},
        {"ACES tone mapping", never, "the tone curve is the scene's choice"},
    };
    return all;
}

}  // namespace

std::string displaced_effect(const Features& before, const Features& after) {
    const bool mixes = after.falloff == FalloffTerm::mixed;
    for (const Effect& effect : effects()) {
        if (!effect.on(before) || effect.on(after)) continue;
        if (!mixes || std::string_view(effect.name) != "no falloff") return effect.name;
    }
    return "";
}

std::string why_not_neutral(const ForcingSubject& subject, const Effect& effect) {
    const auto choice = std::find_if(choices().begin(), choices().end(),
                                     [&](const Choice& c) { return c.effect == effect.name; });
    if (choice != choices().end() && !choice->neutral(subject)) return choice->reason;
    Features with = subject.planned;
    effect.set(with, true);
    const std::string displaced = displaced_effect(subject.planned, with);
    return displaced.empty() ? "" : fmt::format("it would take the place of '{}'", displaced);
}

}  // namespace relief
