// SPDX-License-Identifier: Apache-2.0
// Effects forced on and off: names looked up, each draw's features changed, what canonical() leaves
// of them checked against what was asked for, and the reasons rewritten. Pure. Unknown names and
// impossible sets throw InvalidInput. Tests: tests/shade/effects/effect_forcing_test.cpp.
#include "relief/shade/effect_forcing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <string_view>

#include "effects/neutral.h"
#include "effects/why_hidden.h"
#include "near_names.h"
#include "relief/mesh/error.h"

namespace relief {

namespace {

/// What is not a draw's own, and follows from the draws and the settings; but for the skybox.
const std::vector<std::pair<std::string_view, bool FramePlan::*>>& frame_effects() {
    static const std::vector<std::pair<std::string_view, bool FramePlan::*>> all = {
        {"skybox", &FramePlan::skybox},
        {"environment map", &FramePlan::environment_map},
        {"prefiltered environment", &FramePlan::prefiltered_map},
        {"environment BRDF table", &FramePlan::environment_brdf},
        {"environment irradiance", &FramePlan::environment_irradiance},
        {"sorted blending", &FramePlan::sorted_blending},
        {"finishing pass", &FramePlan::finishing_pass},
    };
    return all;
}

/// Letters and digits alone, lower case: how names are compared.
std::string bare(std::string_view name) {
    std::string result;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0) result += static_cast<char>(std::tolower(byte));
    }
    return result;
}

std::vector<std::string> all_names() {
    std::vector<std::string> names;
    for (const Effect& effect : effects())
        names.emplace_back(effect.name);
    for (const auto& [name, member] : frame_effects())
        names.emplace_back(name);
    return names;
}

/// The name as relief writes it.
std::string known_name(std::string_view wanted) {
    const std::vector<std::string> names = all_names();
    const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
        return bare(name) == bare(wanted);
    });
    if (found != names.end()) return *found;
    throw InvalidInput(fmt::format("'{}' is no effect{}", wanted, did_you_mean(wanted, names)));
}

/// What is asked for, by known names.
class Wishes {
  public:
    explicit Wishes(const EffectWishes& wishes) : base_(wishes.base) {
        for (const ForcedEffect& forced : wishes.forced) {
            const std::string name = known_name(forced.name);
            const auto [entry, is_new] = by_name_.emplace(name, forced.on);
            if (!is_new && entry->second != forced.on) {
                throw InvalidInput(fmt::format("effect '{}' is forced both on and off", name));
            }
        }
    }

    [[nodiscard]] EffectBase base() const { return base_; }
    [[nodiscard]] bool on(std::string_view name) const { return find(name) == true; }
    [[nodiscard]] bool off(std::string_view name) const { return find(name) == false; }

  private:
    [[nodiscard]] std::optional<bool> find(std::string_view name) const {
        const auto entry = by_name_.find(name);
        return entry == by_name_.end() ? std::nullopt : std::optional(entry->second);
    }

    EffectBase base_;
    std::map<std::string, bool, std::less<>> by_name_;
};

/// A draw's features as forced, and why those wished for are not there.
struct ForcedDraw {
    Features features;
    std::map<std::string, std::string, std::less<>> refused;  ///< By effect.
};

void take_out(const Wishes& wishes, Features& f) {
    for (const Effect& effect : effects()) {
        const bool all_off = wishes.base() == EffectBase::nothing && !wishes.on(effect.name);
        if ((all_off || wishes.off(effect.name)) && effect.on(f)) effect.set(f, false);
    }
}

/// Puts in what was wished for by name. \throws InvalidInput if two wishes exclude each other
void put_in_wished(const ForcingSubject& subject, const Wishes& wishes, ForcedDraw& draw) {
    for (const Effect& effect : effects()) {
        if (!wishes.on(effect.name) || effect.on(subject.planned)) continue;
        const std::string why_not = why_not_neutral(subject, effect);
        if (!why_not.empty()) {
            draw.refused.emplace(effect.name, why_not);
            continue;
        }
        Features with = draw.features;
        effect.set(with, true);
        const std::string displaced = displaced_effect(draw.features, with);
        if (!displaced.empty()) {
            throw InvalidInput(
                fmt::format("effects '{}' and '{}' exclude each other: a surface has "
                            "one of them at most",
                            displaced, effect.name));
        }
        draw.features = with;
    }
}

/// Puts in every neutral effect that excludes none that is there already.
void put_in_neutral(const ForcingSubject& subject, const Wishes& wishes, Features& f) {
    for (const Effect& effect : effects()) {
        if (wishes.off(effect.name) || effect.on(f)) continue;
        if (!why_not_neutral(subject, effect).empty()) continue;
        Features with = f;
        effect.set(with, true);
        if (displaced_effect(f, with).empty()) f = with;
    }
}

ForcedDraw forced_draw(const ForcingSubject& subject, const Wishes& wishes) {
    ForcedDraw draw{subject.planned, {}};
    take_out(wishes, draw.features);
    put_in_wished(subject, wishes, draw);
    if (wishes.base() == EffectBase::all_neutral) put_in_neutral(subject, wishes, draw.features);
    const Features shown = canonical(draw.features);
    for (const Effect& effect : effects()) {
        if (!wishes.on(effect.name) || effect.on(shown)) continue;
        draw.refused.emplace(effect.name, why_hidden(effect, draw.features, shown));
    }
    draw.features = shown;
    return draw;
}

void rewrite_reasons(DrawPlan& draw, const ForcedDraw& forced, const Wishes& wishes) {
    for (EffectReason& reason : draw.reasons) {
        const auto& all = effects();
        const auto effect = std::find_if(all.begin(), all.end(),
                                         [&](const Effect& e) { return e.name == reason.effect; });
        if (effect == all.end()) continue;
        const auto refused = forced.refused.find(reason.effect);
        const bool was_on = effect->on(draw.features);
        const bool is_on = effect->on(forced.features);
        if (refused != forced.refused.end()) {
            reason = {reason.effect, false, "cannot be forced on: " + refused->second};
        } else if (is_on && !was_on) {
            reason = {reason.effect, true, "forced on: the scene does not call for it"};
        } else if (was_on && !is_on) {
            const bool by_name = wishes.off(effect->name) || wishes.base() == EffectBase::nothing;
            reason = {reason.effect, false,
                      by_name ? "taken out" : why_hidden(*effect, draw.features, forced.features)};
        }
    }
}

/// Whether tangents must be computed now, and why.
void settle_tangents(const Scene& scene, DrawPlan& draw) {
    const std::vector<std::string> attributes = planned_interface(draw.features).attributes;
    const bool uses = std::binary_search(attributes.begin(), attributes.end(), "tangent_object");
    const Mesh& mesh = scene.meshes[scene.instances[draw.instance].mesh];
    draw.needs_tangents = uses && mesh.tangents.empty();
    for (EffectReason& reason : draw.reasons) {
        if (reason.effect != "computed tangents" || reason.on == draw.needs_tangents) continue;
        reason.on = draw.needs_tangents;
        reason.reason = uses ? "a forced normal map lies in their frame" : "nothing uses tangents";
    }
}

/// An effect that no draw can have: why, by the first draw.
void refuse(const std::string& effect, const Material& material, const std::string& reason) {
    throw InvalidInput(fmt::format("effect '{}' cannot be forced on: material '{}': {}", effect,
                                   material.name, reason));
}

void force_draws(const Scene& scene, const Wishes& wishes, FramePlan& plan) {
    std::map<std::string, std::pair<const Material*, std::string>> refused;
    std::map<std::string, std::size_t> refusals;
    for (DrawPlan& draw : plan.draws) {
        const Material& material =
            draw.range.material ? scene.materials[*draw.range.material] : default_material();
        const ForcedDraw forced = forced_draw({scene, material, draw.features}, wishes);
        for (const auto& [effect, reason] : forced.refused) {
            refused.try_emplace(effect, &material, reason);
            ++refusals[effect];
        }
        rewrite_reasons(draw, forced, wishes);
        draw.features = forced.features;
        settle_tangents(scene, draw);
    }
    for (const auto& [effect, first] : refused) {
        if (refusals[effect] == plan.draws.size()) refuse(effect, *first.first, first.second);
    }
}

/// Exposure and tone curve of a finishing pass are the scene's, whatever the draws have.
void check_finishing(const Scene& scene, const FrameSettings& settings, const FramePlan& plan,
                     const Wishes& wishes) {
    if (!plan.finishing_pass || settings.output != OutputCoding::srgb) return;
    Features finish;
    finish.exposure = scene.exposure != 1.0F;
    finish.tone_mapping = scene.tone_mapping;
    for (const Effect& effect : effects()) {
        const bool forced = wishes.on(effect.name) || wishes.off(effect.name);
        if (forced && effect.on(finish)) {
            throw InvalidInput(
                fmt::format("effect '{}' is in the finishing pass, which follows the "
                            "scene: change the scene's",
                            effect.name));
        }
    }
}

/// What of the frame was wished for and is not as the draws make it.
void check_frame(const FramePlan& plan, const Wishes& wishes) {
    for (const auto& [name, member] : frame_effects()) {
        const bool is_on = plan.*member;
        if (name == "skybox" && wishes.on(name) && !is_on) {
            throw InvalidInput(
                "effect 'skybox' cannot be forced on: the scene does not show its surroundings");
        }
        if (name == "skybox" || (!wishes.on(name) && !wishes.off(name))) continue;
        if (wishes.on(name) != is_on) {
            throw InvalidInput(
                fmt::format("effect '{}' cannot be forced {}: it follows from the "
                            "surfaces' effects and the settings",
                            name, is_on ? "off" : "on"));
        }
    }
}

void take_out_skybox(FramePlan& plan) {
    const bool mirrored = std::any_of(plan.draws.begin(), plan.draws.end(), [](const DrawPlan& d) {
        return d.features.reflection == ReflectionTerm::mirror || d.features.refraction;
    });
    plan.skybox = false;
    plan.environment_map = mirrored || plan.prefiltered_map || plan.environment_irradiance;
    for (EffectReason& reason : plan.reasons) {
        if (reason.effect == "skybox") reason = {"skybox", false, "taken out"};
        if (reason.effect == "environment map" && reason.on && !plan.environment_map) {
            reason = {"environment map", false, "nothing shows it"};
        }
    }
}

}  // namespace

FramePlan force_effects(const Scene& scene, const FrameSettings& settings, FramePlan plan,
                        const EffectWishes& effect_wishes) {
    const Wishes wishes(effect_wishes);
    const bool had_skybox = plan.skybox;
    check_finishing(scene, settings, plan, wishes);
    force_draws(scene, wishes, plan);
    plan_frame(scene, settings, plan);
    const bool all_off = wishes.base() == EffectBase::nothing && !wishes.on("skybox");
    if (plan.skybox && (!had_skybox || all_off || wishes.off("skybox"))) take_out_skybox(plan);
    check_frame(plan, wishes);
    return plan;
}

std::vector<std::string> effects_in(const FramePlan& plan) {
    std::vector<std::string> names;
    for (const Effect& effect : effects()) {
        const bool on = std::any_of(plan.draws.begin(), plan.draws.end(),
                                    [&](const DrawPlan& draw) { return effect.on(draw.features); });
        if (on) names.emplace_back(effect.name);
    }
    if (plan.skybox) names.emplace_back("skybox");
    return names;
}

}  // namespace relief
