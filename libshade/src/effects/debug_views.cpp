// SPDX-License-Identifier: Apache-2.0
// Debug views: their names and descriptions, and the plan that shows one: the features of each
// draw, or the reason why it has nothing to show. Pure. Tests:
// tests/shade/effects/effects_test.cpp.
#include "relief/shade/frame_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "effects/features.h"
#include "relief/mesh/report.h"
#include "relief/shade/effects.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

using enum DebugViewKind;
using V = DebugView;

constexpr std::array all_views = {
    DebugViewInfo{V::picture, "picture", "the normal picture", picture},
    DebugViewInfo{V::geometric_normal, "geometric-normal", "the normals of triangles", data},
    DebugViewInfo{V::shading_normal, "shading-normal", "the normals for lighting", data},
    DebugViewInfo{V::tangent, "tangent", "the tangents of the normal maps' frame", data},
    DebugViewInfo{V::bitangent, "bitangent", "the bitangents of that frame", data},
    DebugViewInfo{V::handedness, "handedness",
                  "blue where that frame is right-handed, red where it is mirrored", data},
    DebugViewInfo{V::texcoords, "texcoords", "u in red, v in green, 8 x 8 squares in blue", data},
    DebugViewInfo{V::normal_map, "normal-map", "the normal map's vectors", data},
    DebugViewInfo{V::height, "height", "the bump map's heights", data},
    DebugViewInfo{V::ambient, "ambient", "ambient light alone", term},
    DebugViewInfo{V::diffuse, "diffuse", "the scattered light of light sources alone", term},
    DebugViewInfo{V::specular, "specular", "the highlights of light sources alone", term},
    DebugViewInfo{V::environment_light, "environment-light",
                  "the scattered light of the environment alone", term},
    DebugViewInfo{V::reflection, "reflection", "the mirrored environment alone", term},
    DebugViewInfo{V::refraction, "refraction", "the environment seen through surfaces alone", term},
    DebugViewInfo{V::emission, "emission", "emitted light alone", term},
    DebugViewInfo{V::overdraw, "overdraw", "the number of fragments at each pixel", count},
    DebugViewInfo{V::nothing_to_show, "nothing", "that there is nothing to show", data},
};

/// True if the rows are in the order of the enumeration.
constexpr bool are_in_order() {
    for (std::size_t i = 0; i < all_views.size(); ++i) {
        if (all_views[i].view != static_cast<V>(i)) return false;
    }
    return all_views.back().view == V::nothing_to_show;
}
static_assert(are_in_order());

/// True if the features have this term.
bool has_term(const Features& f, DebugView term) {
    if (f.unlit) return false;
    switch (term) {
        case DebugView::ambient:
            return f.ambient;
        case DebugView::diffuse:
            return f.diffuse && light_count(f) > 0;
        case DebugView::specular:
            return f.specular != SpecularTerm::none || (f.metallic_roughness && light_count(f) > 0);
        case DebugView::environment_light:
            return f.environment_diffuse;
        case DebugView::reflection:
            return f.reflection != ReflectionTerm::none;
        case DebugView::refraction:
            return f.refraction;
        default:
            return f.emission;
    }
}

/// The material and mesh of a draw, and their names.
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

/// Returns the effect whose reason explains why there is no such term.
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

std::string missing_term_reason(const DrawPlan& draw, const Drawn& drawn, DebugView term) {
    if (draw.features.unlit) return drawn.material_name + " is unlit";
    const std::string_view name = effect_of(term, drawn.material.metallic_roughness.has_value());
    const auto reason =
        std::find_if(draw.reasons.begin(), draw.reasons.end(),
                     [&](const EffectReason& r) { return r.effect == name && !r.on; });
    return reason == draw.reasons.end() ? drawn.material_name + " has no such light"
                                        : reason->reason;
}

/// Returns the reason why a draw has nothing to show in a view of data; empty if it has something.
std::string missing_data_reason(const Drawn& drawn, DebugView view) {
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

/// True if light shows the normal in the picture; if not, its effects say nothing about the map.
bool is_normal_seen(const Features& f) {
    return f.directional_lights + f.point_lights + f.spot_lights > 0 || f.environment_diffuse ||
           f.reflection != ReflectionTerm::none || f.refraction || f.transmission;
}

/// Makes one draw show the view. \return why it has nothing to show; empty if it has something
std::string show_view(const Drawn& drawn, DebugView view, DrawPlan& draw) {
    Features& f = draw.features;
    const bool missing_term = is_term(view) && !has_term(f, view);
    const std::string reason =
        missing_term ? missing_term_reason(draw, drawn, view) : missing_data_reason(drawn, view);
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
    f.view = reason.empty() || is_term(view) ? view : DebugView::nothing_to_show;
    if (view == DebugView::overdraw) f.displaced_shadow = false;
    f = canonical(f);
    const PlannedInterface planned = planned_interface(f);
    draw.needs_tangents = drawn.mesh.tangents.empty() &&
                          std::find(planned.attributes.begin(), planned.attributes.end(),
                                    "tangent_object") != planned.attributes.end();
    return reason;
}

}  // namespace

std::span<const DebugViewInfo> debug_views() {
    return std::span(all_views).first(all_views.size() - 1);
}

const DebugViewInfo& debug_view_info(DebugView view) {
    return all_views.at(static_cast<std::size_t>(view));
}

FramePlan plan_view(const Scene& scene, const FrameSettings& settings, FramePlan plan,
                    Report& report) {
    const DebugView view = settings.view;
    if (view == DebugView::picture) return plan;
    if (view == DebugView::nothing_to_show)
        throw InvalidInput("nothing_to_show cannot be requested");
    std::string first_reason;
    std::size_t showing = 0;
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        DrawPlan& draw = plan.draws[i];
        if (draw.features.view != DebugView::picture) {  // Planned already.
            ++showing;
            continue;
        }
        const std::string reason = show_view(drawn_by(scene, draw), view, draw);
        if (reason.empty()) {
            ++showing;
            continue;
        }
        if (first_reason.empty()) first_reason = reason;
        if (is_data(view))
            report.add("surface without what the view shows", "draw", i, "hatched in gray");
    }
    if (showing == 0 && !first_reason.empty()) {
        throw InvalidInput(
            fmt::format("{} cannot be shown: {}", debug_view_info(view).name, first_reason));
    }
    plan_frame(scene, settings, plan);
    return plan;
}

}  // namespace relief::shade
