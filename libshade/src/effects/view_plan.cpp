// SPDX-License-Identifier: Apache-2.0
// A plan turned to a debug view: what each draw shows of it, or why it cannot. Pure. A view without
// meaning for any draw throws InvalidInput; for some, is counted in the report.
// Tests: tests/shade/effects/debug_views_test.cpp.
#include <fmt/format.h>

#include <algorithm>

#include "effects/view_features.h"
#include "relief/mesh/error.h"
#include "relief/shade/effects.h"
#include "relief/shade/labels.h"

namespace relief {

namespace {

/// One draw and what it draws.
struct Drawn {
    const Material& material;
    const Mesh& mesh;
    std::string material_name;
    std::string mesh_name;
};

Drawn drawn_by(const Scene& scene, const DrawPlan& draw) {
    const std::size_t mesh = scene.instances[draw.instance].mesh;
    return {draw.range.material ? scene.materials[*draw.range.material] : default_material(),
            scene.meshes[mesh], material_label(scene, draw.range.material),
            mesh_label(scene, mesh)};
}

NormalDetail detail_of(const Drawn& drawn) {
    if (drawn.mesh.texcoords.empty()) return NormalDetail::none;
    if (drawn.material.bump_map) return NormalDetail::bump_map;
    if (!drawn.material.normal_map) return NormalDetail::none;
    return drawn.material.normal_map->space == NormalSpace::object ? NormalDetail::object_normal_map
                                                                   : NormalDetail::normal_map;
}

/// The effect whose reason says why there is no such term.
std::string_view effect_of(DebugView term, bool physical) {
    switch (term) {
        case DebugView::ambient:
            return "ambient";
        case DebugView::diffuse:
            return "diffuse";
        case DebugView::specular:
            return physical ? "diffuse" : "Blinn-Phong highlights";
        case DebugView::environment_light:
            return "environment light";
        case DebugView::reflection:
            return physical ? "glossy reflection" : "mirror reflection";
        case DebugView::refraction:
            return "refraction";
        default:
            return "emission";
    }
}

std::string why_no_term(const DrawPlan& draw, const Drawn& drawn, DebugView term) {
    if (draw.features.unlit) return drawn.material_name + " is unlit";
    const std::string_view name = effect_of(term, drawn.material.metallic_roughness.has_value());
    const auto reason =
        std::find_if(draw.reasons.begin(), draw.reasons.end(),
                     [&](const EffectReason& r) { return r.effect == name && !r.on; });
    return reason == draw.reasons.end() ? drawn.material_name + " has no such light"
                                        : reason->reason;
}

/// Why a draw has nothing to show of a view of data; empty: it has.
std::string why_no_data(const Drawn& drawn, DebugView view) {
    const bool has_texcoords = !drawn.mesh.texcoords.empty();
    const std::string no_texcoords = drawn.mesh_name + " has no texture coordinates";
    const bool derived = drawn.material.tangent_frame == TangentFrame::derivatives;
    switch (view) {
        case DebugView::tangent:
        case DebugView::bitangent:
        case DebugView::handedness:
            if (!derived && !drawn.mesh.tangents.empty()) return "";
            return has_texcoords ? "" : no_texcoords + ", so there is no tangent frame";
        case DebugView::texcoords:
            return has_texcoords ? "" : no_texcoords;
        case DebugView::normal_map:
            if (!drawn.material.normal_map && !drawn.material.bump_map)
                return drawn.material_name + " has no normal map and no bump map";
            return has_texcoords ? "" : no_texcoords;
        case DebugView::height:
            if (!drawn.material.bump_map) return drawn.material_name + " has no bump map";
            return has_texcoords ? "" : no_texcoords;
        default:
            return "";
    }
}

/// Whether light shows the normal in the picture; else its effects say nothing about the map.
bool is_normal_seen(const Features& f) {
    return f.directional_lights + f.point_lights + f.spot_lights > 0 || f.environment_diffuse ||
           f.reflection != ReflectionTerm::none || f.refraction;
}

/// Turns one draw to the view. \return why it has nothing to show; empty: it has
std::string turn(const Drawn& drawn, DebugView view, DrawPlan& draw) {
    Features& f = draw.features;
    const bool missing_term = is_term(view) && !has_term(f, view);
    const std::string why =
        missing_term ? why_no_term(draw, drawn, view) : why_no_data(drawn, view);
    const bool maps = view == DebugView::normal_map || view == DebugView::height;
    if (maps || (view == DebugView::shading_normal && !is_normal_seen(f))) {
        f.detail = detail_of(drawn);
        f.double_sided = drawn.material.double_sided;
        if (f.interpolation != Interpolation::gouraud)
            f.interpolation = drawn.material.interpolation;
    }
    const bool shows_maps_frame = view == DebugView::tangent || view == DebugView::bitangent ||
                                  view == DebugView::handedness ||
                                  view == DebugView::shading_normal;
    if (shows_maps_frame) f.frame = drawn.material.tangent_frame;
    f.view = why.empty() || is_term(view) ? view : DebugView::nothing_to_show;
    f = canonical(f);
    const PlannedInterface planned = planned_interface(f);
    draw.needs_tangents = drawn.mesh.tangents.empty() &&
                          std::find(planned.attributes.begin(), planned.attributes.end(),
                                    "tangent_object") != planned.attributes.end();
    return why;
}

}  // namespace

FramePlan plan_view(const Scene& scene, const FrameSettings& settings, FramePlan plan,
                    Report& report) {
    const DebugView view = settings.view;
    if (view == DebugView::picture) return plan;
    if (view == DebugView::nothing_to_show)
        throw InvalidInput("nothing_to_show is no view to ask for");
    std::string first_reason;
    std::size_t showing = 0;
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        DrawPlan& draw = plan.draws[i];
        if (draw.features.view != DebugView::picture) {  // Planned already.
            ++showing;
            continue;
        }
        const std::string why = turn(drawn_by(scene, draw), view, draw);
        if (why.empty()) {
            ++showing;
            continue;
        }
        if (first_reason.empty()) first_reason = why;
        if (is_data(view))
            report.add("surface without what the view shows", "draw", i, "hatched in grey");
    }
    if (showing == 0 && !first_reason.empty()) {
        throw InvalidInput(fmt::format("there is nothing to show of {}: {}",
                                       debug_view_info(view).name, first_reason));
    }
    plan_frame(scene, settings, plan);
    return plan;
}

}  // namespace relief
