// SPDX-License-Identifier: Apache-2.0
// The rows of the table of effects that belong to a relief: its methods, its shadows on itself, its
// silhouette, its depth, and that in shadow maps. They are planned by bounds in pixels. Pure.
// Tests: tests/shade/render/depth_mapping_test.cpp, relief_effects_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "effects/features.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

using Subject = const DrawSubject&;
using Forced = const ForcingSubject&;
using F = Features;

const char* method_label(HeightMethod method) {
    constexpr std::array labels{"parallax mapping", "parallax occlusion mapping", "relief mapping",
                                "relaxed cones", "maximum mipmaps"};
    return labels.at(static_cast<std::size_t>(method));
}

constexpr DepthMapping depth_mapping_of(HeightMethod method) {
    return static_cast<DepthMapping>(static_cast<int>(method) + 1);
}
static_assert(depth_mapping_of(HeightMethod::maximum_mipmaps) == DepthMapping::maximum_mipmaps);

/// Returns the reason why nothing of the material's relief shows on this mesh; "" if something may.
std::string missing_relief(Subject s) {
    const std::optional<ReliefMap>& map = s.material.height_map;
    if (!map) return s.name + " has no height map";
    const Decision texture = of_texture(s, true);
    if (!texture.on) return texture.reason;
    if (map->depth == 0.0F) return s.name + " has a relief without depth";
    if (map->method == HeightMethod::relaxed_cones && !map->cones)
        return s.name + " has no cone map";
    return "";
}

/// Decides by a bound of the relief: "<what> 0.2 pixels <how>, less than 0.5".
Decision by_bound(Subject s, double ReliefBounds::*bound, const std::string& what,
                  const char* how = "") {
    if (!s.relief) return {true, s.name + " has a relief, seen from any distance"};
    const double pixels = (*s.relief).*bound;
    if (std::isinf(pixels)) return {true, fmt::format("the relief of {} reaches the eye", s.name)};
    const float least = s.material.height_map->bound;
    const bool on = pixels >= static_cast<double>(least);
    return {on, fmt::format("{} {:.2g} pixels{}{}", what, pixels, how,
                            on ? "" : fmt::format(", less than {}", least))};
}

Decision of_self_shadow(Subject s) {
    const std::string missing = missing_relief(s);
    if (!missing.empty()) return {false, missing};
    if (!s.material.height_map->self_shadow) return {false, s.name + " does not request it"};
    if (s.material.unlit) return {false, s.name + " is unlit"};
    if (s.material.interpolation == Interpolation::gouraud)
        return {false, "Gouraud shading uses light only at vertices"};
    if (light_count(s.lights) == 0) return {false, "no light source shines"};
    if (s.relief && std::isinf(s.relief->shadow))
        return {true, fmt::format("light grazes the relief of {}", s.name)};
    return by_bound(s, &ReliefBounds::shadow,
                    fmt::format("the relief of {} casts shadows of at most", s.name), " on itself");
}

Decision of_written_depth(Subject s) {
    const std::string missing = missing_relief(s);
    if (!missing.empty()) return {false, missing};
    if (!s.material.height_map->write_depth) return {false, s.name + " does not request it"};
    return by_bound(s, &ReliefBounds::depth, fmt::format("the relief of {} is at most", s.name),
                    " deep");
}

/// Shadow maps have the depth of the relief where the view has it.
Decision of_displaced_shadow(Subject s) {
    const Decision written = of_written_depth(s);
    if (!written.on) return written;
    if (s.material.unlit) return {false, s.name + " is unlit"};
    if (s.lights.shadow == ShadowTerm::none) return {false, "no light casts a shadow"};
    return {true, "the shadow of the main light meets the relief of " + s.name};
}

Decision of_clipped_relief(Subject s) {
    const std::string missing = missing_relief(s);
    if (!missing.empty()) return {false, missing};
    const ReliefMap& map = *s.material.height_map;
    if (map.silhouette == ReliefSilhouette::none) return {false, s.name + " does not request it"};
    if (map.texture.wrap_u != Wrap::clamp && map.texture.wrap_v != Wrap::clamp)
        return {false, fmt::format("the height map of {} has no border: it repeats", s.name)};
    const Decision moved =
        by_bound(s, &ReliefBounds::shift,
                 fmt::format("the relief of {} moves its border by at most", s.name));
    if (moved.on || !of_displaced_shadow(s).on) return moved;
    return {true, s.name + " casts the shadow of its relief"};
}

/// True if all triangles have one normal, so that no surface curves below the relief.
bool has_flat_triangles(Subject s) {
    const std::vector<glm::vec3>& normals = s.mesh.normals;
    return s.pose == nullptr && !normals.empty() &&
           std::all_of(s.mesh.triangles.begin(), s.mesh.triangles.end(), [&](const auto& corners) {
               return normals[corners.x] == normals[corners.y] &&
                      normals[corners.x] == normals[corners.z];
           });
}

Decision of_curved_relief(Subject s) {
    const std::string missing = missing_relief(s);
    if (!missing.empty()) return {false, missing};
    if (s.material.height_map->silhouette != ReliefSilhouette::curve)
        return {false, s.name + " does not request it"};
    if (has_flat_triangles(s)) return {false, s.name + " covers flat triangles only"};
    return by_bound(s, &ReliefBounds::curve,
                    fmt::format("the curvature moves the relief of {} by at most", s.name));
}

/// Depth mapping is planned where it moves what is seen, and where an effect shows the depth of the
/// relief without moving it.
Decision of_depth_mapping(Subject s, HeightMethod method) {
    const std::optional<ReliefMap>& map = s.material.height_map;
    if (map && map->method != method)
        return {false, fmt::format("{} requests {}", s.name, method_label(map->method))};
    const std::string missing = missing_relief(s);
    if (!missing.empty()) return {false, missing};
    const Decision moved =
        by_bound(s, &ReliefBounds::shift,
                 fmt::format("the relief of {} moves what is seen by at most", s.name));
    if (moved.on) return moved;
    if (of_self_shadow(s).on) return {true, s.name + " shows the shadows of its relief"};
    if (of_written_depth(s).on) return {true, s.name + " writes the depth of its relief"};
    return moved;
}

/// A height map with the method of a row, which may be forced on where the bound leaves it out.
template <HeightMethod Method>
bool has_relief_for(Forced s) {
    const std::optional<ReliefMap>& map = s.material.height_map;
    return map && map->method == Method && (Method != HeightMethod::relaxed_cones || map->cones);
}

template <HeightMethod Method>
EffectRow depth_row() {
    return {.effect = one_value<&F::depth_mapping, depth_mapping_of(Method)>(
                method_label(Method), "no texture shows the displacement"),
            .decide = [](Subject s) { return of_depth_mapping(s, Method); },
            .choice = "the relief and its method are the material's choice",
            .neutral = has_relief_for<Method>,
            .only_by_name = true};
}

}  // namespace

void detail::set_height_wraps(const Material& material, Features& f) {
    const bool counts = has_height_wraps(f) && material.height_map;
    f.height_wrap_u = counts ? material.height_map->texture.wrap_u : Wrap::repeat;
    f.height_wrap_v = counts ? material.height_map->texture.wrap_v : Wrap::repeat;
}

std::vector<EffectRow> detail::relief_rows() {
    return {
        depth_row<HeightMethod::parallax>(),
        depth_row<HeightMethod::parallax_occlusion>(),
        depth_row<HeightMethod::relief_mapping>(),
        depth_row<HeightMethod::relaxed_cones>(),
        depth_row<HeightMethod::maximum_mipmaps>(),
        {.effect = one_switch<&F::self_shadow>(
             "self-shadow", "no relief is displaced, or no light source reaches it"),
         .decide = of_self_shadow,
         .choice = "whether a relief shades itself is the material's choice",
         .neutral =
             [](Forced s) { return s.material.height_map && s.material.height_map->self_shadow; },
         .only_by_name = true},
        {.effect = one_switch<&F::clipped_relief>("clipped relief",
                                                  "no relief is displaced, or its map repeats"),
         .decide = of_clipped_relief,
         .choice = "the silhouette of a relief is the material's choice",
         .neutral =
             [](Forced s) {
                 return s.material.height_map &&
                        s.material.height_map->silhouette != ReliefSilhouette::none;
             },
         .only_by_name = true},
        {.effect = one_switch<&F::curved_relief>("curved relief", "no relief is displaced"),
         .decide = of_curved_relief,
         .choice = "the silhouette of a relief is the material's choice",
         .neutral =
             [](Forced s) {
                 return s.material.height_map &&
                        s.material.height_map->silhouette == ReliefSilhouette::curve;
             },
         .only_by_name = true},
        {.effect = one_switch<&F::written_depth>("written depth", "no relief is displaced"),
         .decide = of_written_depth,
         .choice = "the depth of a relief is the material's choice",
         .neutral =
             [](Forced s) { return s.material.height_map && s.material.height_map->write_depth; },
         .only_by_name = true},
        {.effect = one_switch<&F::displaced_shadow>(
             "displaced shadow", "no relief writes its depth, or no light casts a shadow"),
         .decide = of_displaced_shadow,
         .choice = "the depth of a relief is the material's choice",
         .neutral =
             [](Forced s) { return s.material.height_map && s.material.height_map->write_depth; },
         .only_by_name = true},
    };
}

}  // namespace relief::shade
