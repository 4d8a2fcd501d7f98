// SPDX-License-Identifier: Apache-2.0
#include "effects_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/command.h"
#include "common/text.h"
#include "relief/shade/planned_inputs.h"

namespace relief::tools {
namespace {

std::string instance_name(const Scene& scene, const DrawPlan& draw) {
    const Instance& instance = scene.instances[draw.instance];
    if (!instance.name.empty()) return instance.name;
    const std::string& mesh = scene.meshes[instance.mesh]->name;
    return mesh.empty() ? fmt::format("instance {}", draw.instance) : mesh;
}

std::string material_name(const Scene& scene, const DrawPlan& draw) {
    if (!draw.range.material) return "default";
    const std::string& name = scene.materials[*draw.range.material].name;
    return name.empty() ? fmt::format("material {}", *draw.range.material) : name;
}

using Table = std::vector<EffectReason>;

void print_table(const Table& reasons) {
    std::size_t width = 0;
    for (const EffectReason& reason : reasons)
        width = std::max(width, reason.effect.size());
    for (const EffectReason& reason : reasons) {
        fmt::print(out(), "  {:<3}  {:<{}}  {}\n", reason.on ? "on" : "off", reason.effect, width,
                   reason.reason);
    }
}

/// What goes to the GPU for a draw, as lines of its table.
std::vector<EffectReason> input_rows(const Scene& scene, const DrawPlan& draw) {
    std::vector<EffectReason> rows;
    const DrawInputs inputs = planned_inputs(scene, draw);
    for (const PlannedAttribute& attribute : inputs.attributes) {
        rows.push_back({"attribute " + attribute.name, true,
                        attribute.reason + (attribute.stored ? "" : "; the mesh has none")});
    }
    for (const PlannedTexture& texture : inputs.textures) {
        rows.push_back({"texture " + texture.sampler, true,
                        fmt::format("{}{}{}", texture.reason,
                                    texture.image.empty() ? "" : ": " + texture.image,
                                    texture.mip_chain ? "; with a mip chain, for where texels are "
                                                        "smaller than pixels"
                                                      : "")});
    }
    return rows;
}

std::vector<EffectReason> pass_rows(const FramePlan& plan) {
    std::vector<EffectReason> rows;
    for (const PlannedPass& pass : planned_passes(plan))
        rows.push_back({"pass: " + pass.name, true, pass.reason});
    return rows;
}

nlohmann::ordered_json attributes_json(const DrawInputs& inputs) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const PlannedAttribute& attribute : inputs.attributes) {
        list.push_back(
            {{"name", attribute.name}, {"stored", attribute.stored}, {"reason", attribute.reason}});
    }
    return list;
}

nlohmann::ordered_json textures_json(const DrawInputs& inputs) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const PlannedTexture& texture : inputs.textures) {
        list.push_back({{"sampler", texture.sampler},
                        {"image", texture.image},
                        {"mip_chain", texture.mip_chain},
                        {"reason", texture.reason}});
    }
    return list;
}

nlohmann::ordered_json reasons_json(const std::vector<EffectReason>& reasons) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const EffectReason& reason : reasons)
        list.push_back({{"effect", reason.effect}, {"on", reason.on}, {"reason", reason.reason}});
    return list;
}

Table joined(Table rows, const Table& more) {
    rows.insert(rows.end(), more.begin(), more.end());
    return rows;
}

bool same_table(const Table& a, const Table& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const EffectReason& x, const EffectReason& y) {
                          return x.effect == y.effect && x.on == y.on && x.reason == y.reason;
                      });
}

}  // namespace

std::string draw_heading(const Scene& scene, const DrawPlan& draw) {
    return fmt::format("'{}', material '{}', {}", instance_name(scene, draw),
                       material_name(scene, draw), counted(draw.range.triangle_count, "triangle"));
}

void print_effects(const Scene& scene, const FramePlan& plan) {
    fmt::print(out(), "Whole frame\n");
    print_table(joined(plan.reasons, pass_rows(plan)));
    std::vector<Table> tables;
    for (const DrawPlan& draw : plan.draws)
        tables.push_back(joined(draw.reasons, input_rows(scene, draw)));
    std::vector<bool> told(plan.draws.size(), false);
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        if (told[i]) continue;
        std::size_t alike = 0;
        for (std::size_t j = i; j < plan.draws.size(); ++j) {
            if (!same_table(tables[i], tables[j])) continue;
            told[j] = true;
            ++alike;
        }
        fmt::print(out(), "\n{}{}\n", draw_heading(scene, plan.draws[i]),
                   alike > 1 ? fmt::format(" (and {} alike)", counted(alike - 1, "draw")) : "");
        print_table(tables[i]);
    }
}

nlohmann::ordered_json effects_json(const Scene& scene, const FramePlan& plan) {
    nlohmann::ordered_json draws = nlohmann::ordered_json::array();
    for (const DrawPlan& draw : plan.draws) {
        const DrawInputs inputs = planned_inputs(scene, draw);
        draws.push_back({{"instance", instance_name(scene, draw)},
                         {"material", material_name(scene, draw)},
                         {"triangles", draw.range.triangle_count},
                         {"tangents_computed", draw.needs_tangents},
                         {"effects", reasons_json(draw.reasons)},
                         {"attributes", attributes_json(inputs)},
                         {"textures", textures_json(inputs)}});
    }
    nlohmann::ordered_json passes = nlohmann::ordered_json::array();
    for (const PlannedPass& pass : planned_passes(plan))
        passes.push_back({{"pass", pass.name}, {"reason", pass.reason}});
    return {{"frame", reasons_json(plan.reasons)},
            {"passes", std::move(passes)},
            {"draws", std::move(draws)}};
}

}  // namespace relief::tools
