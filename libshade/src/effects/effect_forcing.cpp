// SPDX-License-Identifier: Apache-2.0
// Forces effects on and off: looks up their names, changes the features of each draw, checks what
// canonical() leaves of them against the request, and rewrites the reasons. Pure. Unknown names and
// impossible sets throw InvalidInput. Tests: tests/shade/effects/effects_test.cpp.
#include "relief/shade/effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <string_view>

#include "effects/features.h"
#include "near_names.h"
#include "relief/mesh/report.h"

namespace relief::shade {
using namespace relief::detail;
using namespace relief::shade::detail;

namespace {

/// Returns the letters and digits of a name in lower case, by which names are compared.
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
    for (const auto& [name, member] : frame_effects)
        names.emplace_back(name);
    return names;
}

/// Returns the name as relief writes it.
std::string known_name(std::string_view wanted) {
    const std::vector<std::string> names = all_names();
    const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
        return bare(name) == bare(wanted);
    });
    if (found != names.end()) return *found;
    throw InvalidInput(fmt::format("'{}' is not an effect{}", wanted, did_you_mean(wanted, names)));
}

/// The requested effects by known names.
class Requests {
  public:
    explicit Requests(const EffectRequest& request) : base_(request.base) {
        for (const ForcedEffect& forced : request.forced) {
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

    /// True if an effect that follows from the pose is forced on or off.
    [[nodiscard]] bool forces_pose() const {
        const auto& rows = effect_rows();
        return base_ != EffectBase::planned ||
               std::any_of(rows.begin(), rows.end(), [&](const EffectRow& row) {
                   return row.follows_pose && find(row.effect.name).has_value();
               });
    }

  private:
    [[nodiscard]] std::optional<bool> find(std::string_view name) const {
        const auto entry = by_name_.find(name);
        return entry == by_name_.end() ? std::nullopt : std::optional(entry->second);
    }

    EffectBase base_;
    std::map<std::string, bool, std::less<>> by_name_;
};

/// Returns the name of an effect that is on in `before` and excluded by what made `after` of it; ""
/// if there is none. Mixed falloff excludes nothing: it is both laws.
std::string displaced_effect(const Features& before, const Features& after) {
    const bool mixes = after.falloff == FalloffTerm::mixed;
    for (const Effect& effect : effects()) {
        if (!effect.on(before) || effect.on(after)) continue;
        if (!mixes || std::string_view(effect.name) != "no falloff") return effect.name;
    }
    return "";
}

/// Returns the reason why an effect that is not planned would change the picture of this draw if it
/// were forced on; "" if it is neutral.
std::string refusal_reason(const ForcingSubject& subject, const EffectRow& row) {
    const bool neutral = row.neutral != nullptr && row.neutral(subject);
    if (row.choice != nullptr && !neutral) return row.choice;
    Features with = subject.planned;
    row.effect.set(with, true);
    const std::string displaced = displaced_effect(subject.planned, with);
    return displaced.empty() ? "" : fmt::format("it would replace '{}'", displaced);
}

/// The reasons by effect.
using Refusals = std::map<std::string, std::string, std::less<>>;

/// The features of a draw with effects forced, and why requested ones are not there.
struct ForcedDraw {
    Features features;
    Refusals refused;
};

void remove_effects(const Requests& requests, Features& f) {
    for (const Effect& effect : effects()) {
        const bool all_off = requests.base() == EffectBase::nothing && !requests.on(effect.name);
        if ((all_off || requests.off(effect.name)) && effect.on(f)) effect.set(f, false);
    }
}

/// Adds the effects requested by name. \throws InvalidInput if two of them exclude each other
void add_requested(const ForcingSubject& subject, const Requests& requests, ForcedDraw& draw) {
    for (const EffectRow& row : effect_rows()) {
        const Effect& effect = row.effect;
        if (!requests.on(effect.name) || effect.on(subject.planned)) continue;
        const std::string refusal = refusal_reason(subject, row);
        if (!refusal.empty()) {
            draw.refused.emplace(effect.name, refusal);
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

/// Adds every neutral effect that excludes no present one.
void add_neutral(const ForcingSubject& subject, const Requests& requests, Features& f) {
    for (const EffectRow& row : effect_rows()) {
        const Effect& effect = row.effect;
        if (requests.off(effect.name) || effect.on(f) || row.only_by_name) continue;
        if (!refusal_reason(subject, row).empty()) continue;
        Features with = f;
        effect.set(with, true);
        if (displaced_effect(f, with).empty()) f = with;
    }
}

ForcedDraw forced_draw(const ForcingSubject& subject, const Requests& requests) {
    ForcedDraw draw{subject.planned, {}};
    remove_effects(requests, draw.features);
    add_requested(subject, requests, draw);
    if (requests.base() == EffectBase::all_neutral) add_neutral(subject, requests, draw.features);
    set_height_wraps(subject.material, draw.features);
    const Features shown = canonical(draw.features);
    for (const EffectRow& row : effect_rows()) {
        if (!requests.on(row.effect.name) || row.effect.on(shown)) continue;
        draw.refused.emplace(row.effect.name, hidden_reason(row, draw.features, shown));
    }
    draw.features = shown;
    return draw;
}

void rewrite_reasons(DrawPlan& draw, const ForcedDraw& forced, const Requests& requests) {
    for (EffectReason& reason : draw.reasons.edit()) {
        const EffectRow* const row = find_effect(reason.effect);
        if (row == nullptr) continue;
        const auto refused = forced.refused.find(reason.effect);
        const bool was_on = row->effect.on(draw.features);
        const bool is_on = row->effect.on(forced.features);
        if (refused != forced.refused.end()) {
            reason = {reason.effect, false, "cannot be forced on: " + refused->second};
        } else if (is_on && !was_on) {
            reason = {reason.effect, true, "forced on: the scene does not need it"};
        } else if (was_on && !is_on) {
            const bool by_name =
                requests.off(reason.effect) || requests.base() == EffectBase::nothing;
            reason = {reason.effect, false,
                      by_name ? "removed" : hidden_reason(*row, draw.features, forced.features)};
        }
    }
}

/// Decides again whether tangents must be computed, and why.
void update_tangents(const Scene& scene, DrawPlan& draw) {
    const std::vector<std::string> attributes = planned_interface(draw.features).attributes;
    const bool uses = std::binary_search(attributes.begin(), attributes.end(), "tangent_object");
    const Mesh& mesh = scene.meshes[scene.instances[draw.instance].mesh];
    draw.needs_tangents = uses && mesh.tangents.empty();
    for (EffectReason& reason : draw.reasons.edit()) {
        if (reason.effect != "computed tangents" || reason.on == draw.needs_tangents) continue;
        reason.on = draw.needs_tangents;
        reason.reason = uses ? "a forced effect lies in their frame" : "nothing uses tangents";
    }
}

/// Refuses an effect that no draw can have, with the reason of the first draw.
void refuse(const std::string& effect, const Material& material, const std::string& reason) {
    throw InvalidInput(fmt::format("effect '{}' cannot be forced on: material '{}': {}", effect,
                                   material.name, reason));
}

/// The mesh, the material, the effects, and the reasons, which equal draws share.
using DrawKey = std::tuple<std::size_t, std::optional<std::uint32_t>, Features,
                           const std::vector<EffectReason>*>;

/// Equal draws with forced effects.
struct ForcedPlan {
    EffectReasons before;  ///< Keeps the reasons of the key.
    DrawPlan plan;
    Refusals refused;
};

void force_draws(const Scene& scene, const Requests& requests, FramePlan& plan) {
    std::map<std::string, std::pair<const Material*, std::string>> refused;
    std::map<std::string, std::size_t> refusals;
    std::map<DrawKey, ForcedPlan> forced_plans;
    for (DrawPlan& draw : plan.draws) {
        const Material& material =
            draw.range.material ? scene.materials[*draw.range.material] : default_material();
        const DrawKey key(scene.instances[draw.instance].mesh, draw.range.material, draw.features,
                          &*draw.reasons);
        auto entry = forced_plans.find(key);
        if (entry == forced_plans.end()) {
            ForcedDraw forced = forced_draw({scene, material, draw.features}, requests);
            DrawPlan forced_plan = draw;
            rewrite_reasons(forced_plan, forced, requests);
            forced_plan.features = forced.features;
            update_tangents(scene, forced_plan);
            entry = forced_plans
                        .emplace(key, ForcedPlan{draw.reasons, std::move(forced_plan),
                                                 std::move(forced.refused)})
                        .first;
        }
        for (const auto& [effect, reason] : entry->second.refused) {
            refused.try_emplace(effect, &material, reason);
            ++refusals[effect];
        }
        draw.reasons = entry->second.plan.reasons;
        draw.features = entry->second.plan.features;
        draw.needs_tangents = entry->second.plan.needs_tangents;
        draw.follows_pose &= !requests.forces_pose();
    }
    for (const auto& [effect, first] : refused) {
        if (refusals[effect] == plan.draws.size()) refuse(effect, *first.first, first.second);
    }
}

/// A finishing pass has the scene's exposure and tone curve, whatever the draws have.
void check_finishing(const Scene& scene, const FrameSettings& settings, const FramePlan& plan,
                     const Requests& requests) {
    if (!plan.finishing_pass || settings.output != OutputCoding::srgb) return;
    Features finish;
    finish.exposure = scene.exposure != 1.0F;
    finish.tone_mapping = scene.tone_mapping;
    for (const Effect& effect : effects()) {
        const bool forced = requests.on(effect.name) || requests.off(effect.name);
        if (forced && effect.on(finish)) {
            throw InvalidInput(
                fmt::format("effect '{}' is in the finishing pass, which follows the "
                            "scene: change the scene's",
                            effect.name));
        }
    }
}

/// Refuses requests for frame-wide effects that the draws do not lead to.
void check_frame(const FramePlan& plan, const Requests& requests) {
    for (const auto& [name, member] : frame_effects) {
        const bool is_on = plan.*member;
        if (name == "skybox" && requests.on(name) && !is_on) {
            throw InvalidInput(
                "effect 'skybox' cannot be forced on: the scene does not show its environment");
        }
        if (name == "skybox" || (!requests.on(name) && !requests.off(name))) continue;
        if (requests.on(name) != is_on) {
            throw InvalidInput(
                fmt::format("effect '{}' cannot be forced {}: it follows from the "
                            "surfaces' effects and the settings",
                            name, is_on ? "off" : "on"));
        }
    }
}

void remove_skybox(FramePlan& plan) {
    plan.skybox = plan.blurred_skybox = false;
    const EnvironmentNeeds needs = environment_needs(plan);
    plan.prefiltered_map = needs.blurred;
    plan.environment_map = needs.any();
    for (EffectReason& reason : plan.reasons) {
        for (const auto& [name, member] : frame_effects) {
            if (reason.effect != name || !reason.on || plan.*member) continue;
            reason = {reason.effect, false, name == "skybox" ? "removed" : "nothing shows it"};
        }
    }
}

}  // namespace

FramePlan force_effects(const Scene& scene, const FrameSettings& settings, FramePlan plan,
                        const EffectRequest& request) {
    const Requests requests(request);
    const bool had_skybox = plan.skybox;
    check_finishing(scene, settings, plan, requests);
    force_draws(scene, requests, plan);
    plan_frame(scene, settings, plan);
    const bool all_off = requests.base() == EffectBase::nothing && !requests.on("skybox");
    if (plan.skybox && (!had_skybox || all_off || requests.off("skybox"))) remove_skybox(plan);
    check_frame(plan, requests);
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

}  // namespace relief::shade
