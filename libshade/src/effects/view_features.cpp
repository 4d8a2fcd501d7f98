// SPDX-License-Identifier: Apache-2.0
// Which effects a debug view keeps. Terms keep what dims them, so that together they are the
// picture. Pure. Tests: tests/shade/effects/debug_views_test.cpp.
#include "effects/view_features.h"

#include "effects/light_rows.h"

namespace relief {

namespace {

/// Holes are the surface's shape; what multiplies alpha comes with them.
void keep_mask(const Features& f, Features& kept) {
    if (f.alpha != AlphaMode::mask) return;
    kept.alpha = f.alpha;
    kept.opacity_texture = f.opacity_texture;
    kept.diffuse_texture = f.diffuse_texture;
    kept.vertex_colors = f.vertex_colors;
}

void keep_normal(const Features& f, Features& kept) {
    const bool is_flat = f.interpolation == Interpolation::flat;
    if (is_flat) kept.interpolation = f.interpolation;
    kept.double_sided = f.double_sided && !is_flat;
    if (f.interpolation != Interpolation::per_pixel) return;
    kept.detail = f.detail;
    if (f.detail == NormalDetail::normal_map || f.detail == NormalDetail::bump_map)
        kept.frame = f.frame;
}

}  // namespace

Features data_features(const Features& f) {
    Features kept;
    kept.view = f.view;
    kept.output = OutputCoding::linear;
    keep_mask(f, kept);
    switch (f.view) {
        case DebugView::geometric_normal:
            kept.interpolation = Interpolation::flat;
            break;
        case DebugView::shading_normal:
            keep_normal(f, kept);
            break;
        case DebugView::tangent:
        case DebugView::bitangent:
        case DebugView::handedness:
            kept.frame = f.frame;
            break;
        case DebugView::normal_map:
            kept.detail = f.detail;
            if (f.detail == NormalDetail::none) kept.view = DebugView::nothing_to_show;
            break;
        case DebugView::height:
            kept.detail = NormalDetail::bump_map;
            if (f.detail != NormalDetail::bump_map) {
                kept.detail = NormalDetail::none;
                kept.view = DebugView::nothing_to_show;
            }
            break;
        default:
            break;
    }
    return kept;
}

Features term_features(Features f) {
    const DebugView term = f.view;
    const bool is_lamps = term == DebugView::diffuse || term == DebugView::specular;
    const bool is_scattered = term == DebugView::ambient || term == DebugView::diffuse ||
                              term == DebugView::environment_light;
    f.unlit = false;
    f.ambient &= term == DebugView::ambient;
    f.environment_diffuse &= term == DebugView::environment_light;
    f.emission &= term == DebugView::emission;
    if (!is_lamps) f.directional_lights = f.point_lights = f.spot_lights = 0;
    if (!f.metallic_roughness) {
        f.diffuse &= term == DebugView::diffuse;
        if (term != DebugView::specular) f.specular = SpecularTerm::none;
    }
    // What is mirrored and let through dims what Phong's surfaces scatter, and each other.
    const bool dims = is_scattered && !f.metallic_roughness;
    if (term != DebugView::reflection && term != DebugView::refraction && !dims)
        f.reflection = ReflectionTerm::none;
    if (term != DebugView::refraction && !dims) f.refraction = false;
    return f;
}

bool has_term(const Features& f, DebugView term) {
    if (f.unlit) return false;
    switch (term) {
        case DebugView::ambient:
            return f.ambient;
        case DebugView::diffuse:
            return f.diffuse && lamp_count(f) > 0;
        case DebugView::specular:
            return f.specular != SpecularTerm::none || (f.metallic_roughness && lamp_count(f) > 0);
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

}  // namespace relief
