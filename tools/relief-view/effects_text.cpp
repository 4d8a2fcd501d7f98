// SPDX-License-Identifier: Apache-2.0
#include "effects_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/text.h"

namespace relief::tools {
namespace {

std::string instance_name(const Scene& scene, const DrawPlan& draw) {
    const Instance& instance = scene.instances[draw.instance];
    if (!instance.name.empty()) return instance.name;
    const std::string& mesh = scene.meshes[instance.mesh].name;
    return mesh.empty() ? fmt::format("instance {}", draw.instance) : mesh;
}

std::string material_name(const Scene& scene, const DrawPlan& draw) {
    if (!draw.range.material) return "default";
    const std::string& name = scene.materials[*draw.range.material].name;
    return name.empty() ? fmt::format("material {}", *draw.range.material) : name;
}

void print_table(const std::vector<EffectReason>& reasons) {
    std::size_t width = 0;
    for (const EffectReason& reason : reasons)
        width = std::max(width, reason.effect.size());
    for (const EffectReason& reason : reasons) {
        fmt::print("  {:<3}  {:<{}}  {}\n", reason.on ? "on" : "off", reason.effect, width,
                   reason.reason);
    }
}

bool same_table(const DrawPlan& a, const DrawPlan& b) {
    const auto equal = [](const EffectReason& x, const EffectReason& y) {
        return x.effect == y.effect && x.on == y.on && x.reason == y.reason;
    };
    return std::equal(a.reasons.begin(), a.reasons.end(), b.reasons.begin(), b.reasons.end(),
                      equal);
}

/// "'vase', material 'clay', 4096 triangles"
std::string heading(const Scene& scene, const DrawPlan& draw) {
    return fmt::format("'{}', material '{}', {}", instance_name(scene, draw),
                       material_name(scene, draw), counted(draw.range.triangle_count, "triangle"));
}

nlohmann::ordered_json reasons_json(const std::vector<EffectReason>& reasons) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const EffectReason& reason : reasons)
        list.push_back({{"effect", reason.effect}, {"on", reason.on}, {"reason", reason.reason}});
    return list;
}

}  // namespace

void print_effects(const Scene& scene, const FramePlan& plan) {
    fmt::print("Whole frame\n");
    print_table(plan.reasons);
    std::vector<bool> told(plan.draws.size(), false);
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        if (told[i]) continue;
        std::size_t alike = 0;
        for (std::size_t j = i; j < plan.draws.size(); ++j) {
            if (!same_table(plan.draws[i], plan.draws[j])) continue;
            told[j] = true;
            ++alike;
        }
        fmt::print("\n{}{}\n", heading(scene, plan.draws[i]),
                   alike > 1 ? fmt::format(" (and {} alike)", counted(alike - 1, "draw")) : "");
        print_table(plan.draws[i].reasons);
    }
}

nlohmann::ordered_json effects_json(const Scene& scene, const FramePlan& plan) {
    nlohmann::ordered_json draws = nlohmann::ordered_json::array();
    for (const DrawPlan& draw : plan.draws) {
        draws.push_back({{"instance", instance_name(scene, draw)},
                         {"material", material_name(scene, draw)},
                         {"triangles", draw.range.triangle_count},
                         {"tangents_computed", draw.needs_tangents},
                         {"effects", reasons_json(draw.reasons)}});
    }
    return {{"frame", reasons_json(plan.reasons)}, {"draws", std::move(draws)}};
}

}  // namespace relief::tools
