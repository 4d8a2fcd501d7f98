// SPDX-License-Identifier: Apache-2.0
// The names of a probe: its terms, its symbols, and the part of each effect of the planner in it.
// Tests: tests/shade/reference/probe_test.cpp.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "relief/shade/probe.h"

namespace relief::shade {

namespace {

using K = ProbeTermKind;
using V = DebugView;

constexpr std::array all_terms = {
    ProbeTermInfo{K::ambient, "ambient", V::ambient},
    ProbeTermInfo{K::diffuse, "diffuse", V::diffuse},
    ProbeTermInfo{K::highlight, "highlight", V::specular},
    ProbeTermInfo{K::environment_light, "environment light", V::environment_light},
    ProbeTermInfo{K::reflection, "reflection", V::reflection},
    ProbeTermInfo{K::interreflection, "interreflection", V::reflection},
    ProbeTermInfo{K::refraction, "refraction", V::refraction},
    ProbeTermInfo{K::transmission, "transmission", V::picture},
    ProbeTermInfo{K::emission, "emission", V::emission},
    ProbeTermInfo{K::unlit, "unlit color", V::picture},
    ProbeTermInfo{K::sheen_highlight, "sheen highlight", V::specular},
    ProbeTermInfo{K::sheen_ambient, "sheen ambient", V::ambient},
    ProbeTermInfo{K::sheen_environment, "sheen environment light", V::environment_light},
    ProbeTermInfo{K::coat_highlight, "coat highlight", V::specular},
    ProbeTermInfo{K::coat_ambient, "coat ambient", V::ambient},
    ProbeTermInfo{K::coat_reflection, "coat reflection", V::reflection},
    ProbeTermInfo{K::coat_interreflection, "coat interreflection", V::reflection},
    ProbeTermInfo{K::skybox, "skybox", V::picture},
    ProbeTermInfo{K::limit, "limit", V::picture},
};

constexpr bool are_in_order() {
    for (std::size_t i = 0; i < all_terms.size(); ++i) {
        if (all_terms[i].kind != static_cast<K>(i)) return false;
    }
    return all_terms.back().kind == K::limit;
}
static_assert(are_in_order());

constexpr std::array all_symbols = {
    // Vectors.
    ProbeSymbol{"n", "normal for lighting: interpolated, bent by maps, on the visible side"},
    ProbeSymbol{"n'", "normal of the clear coat"},
    ProbeSymbol{"n0", "interpolated normal, without maps, on the front side"},
    ProbeSymbol{"ng", "normal of the triangle's plane, on the front side"},
    ProbeSymbol{"v", "direction to the eye"},
    ProbeSymbol{"l", "direction to the light"},
    ProbeSymbol{"h", "half vector of l and v"},
    ProbeSymbol{"r", "l mirrored at n"},
    ProbeSymbol{"t", "tangent: the direction of increasing u"},
    ProbeSymbol{"b", "bitangent: the direction of decreasing v"},
    ProbeSymbol{"d", "direction of the mirrored ray"},
    // Light.
    ProbeSymbol{"L", "irradiance of the light at normal incidence, over pi"},
    ProbeSymbol{"H", "the same for highlights"},
    ProbeSymbol{"La", "ambient light of the scene and its lights"},
    ProbeSymbol{"E(n)", "irradiance of the environment, over pi"},
    ProbeSymbol{"R", "radiance of the environment that is mirrored"},
    ProbeSymbol{"refracted", "radiance of the refracted environment"},
    ProbeSymbol{"behind", "radiance behind the surface, attenuated by its volume"},
    ProbeSymbol{"unattenuated", "radiance behind the surface"},
    ProbeSymbol{"environment", "radiance of the environment along the ray"},
    // The material.
    ProbeSymbol{"ka", "ambient color of the material"},
    ProbeSymbol{"kd", "diffuse color of the material"},
    ProbeSymbol{"ks", "specular color of the material"},
    ProbeSymbol{"ke", "emission of the material"},
    ProbeSymbol{"k", "color of the highlight"},
    ProbeSymbol{"base color", "base color of the material"},
    ProbeSymbol{"c", "scattering color: base color times the share that is not metal"},
    ProbeSymbol{"c T", "transmitted color"},
    ProbeSymbol{"c + f0", "scattering color and reflectance at normal incidence"},
    ProbeSymbol{"f0", "reflectance at normal incidence"},
    ProbeSymbol{"sheen color", "color of the fibers"},
    ProbeSymbol{"shininess", "exponent of the highlight"},
    ProbeSymbol{"roughness", "roughness of the blur"},
    ProbeSymbol{"alpha", "squared roughness"},
    ProbeSymbol{"alpha_t", "squared roughness along the rough axis"},
    ProbeSymbol{"tint", "diffuse texture times vertex color", true},
    ProbeSymbol{"N", "environment along the normal, as a tint", true},
    ProbeSymbol{"specular texel", "specular texture", true},
    ProbeSymbol{"texel", "emission texture", true},
    ProbeSymbol{"occlusion", "share of the light from all around", true},
    // Cosines.
    ProbeSymbol{"n.l", "cosine of the angle between normal and light"},
    ProbeSymbol{"n.v", "cosine of the angle between normal and eye"},
    ProbeSymbol{"n.h", "cosine of the angle between normal and half vector"},
    ProbeSymbol{"r.v", "cosine of the angle between mirrored light and eye"},
    ProbeSymbol{"v.h", "cosine of the angle between eye and half vector"},
    // Shares.
    ProbeSymbol{"s", "shape of the highlight: (n.h)^shininess or (r.v)^shininess"},
    ProbeSymbol{"F", "Fresnel factor"},
    ProbeSymbol{"1 - F", "share that is not mirrored", true},
    ProbeSymbol{"T", "transmitted share"},
    ProbeSymbol{"1 - T", "share that is not transmitted", true},
    ProbeSymbol{"f", "Fresnel factor of the facets"},
    ProbeSymbol{"1 - f'", "share that facets do not mirror"},
    ProbeSymbol{"gain", "light of further bounces between facets", true},
    ProbeSymbol{"D", "distribution of the facets"},
    ProbeSymbol{"V", "visibility of the facets"},
    ProbeSymbol{"pi D V", "lobe of the highlight"},
    ProbeSymbol{"n.l pi D' V'", "lobe of the sheen"},
    ProbeSymbol{"n'.l pi D V", "lobe of the coat"},
    ProbeSymbol{"A", "albedo of the facets for f0"},
    ProbeSymbol{"B", "albedo of the facets for f90"},
    ProbeSymbol{"f0 A + f90 B", "share of the environment that is mirrored"},
    ProbeSymbol{"unmirrored", "share of the environment that is not mirrored"},
    ProbeSymbol{"bounced", "share that facets mirror after the first bounce"},
    ProbeSymbol{"A + B", "share of the environment that the coat mirrors once"},
    ProbeSymbol{"1 - A - B", "share that the coat mirrors after the first bounce"},
    ProbeSymbol{"1 / (A + B)", "light of further bounces in the coat"},
    ProbeSymbol{"E", "albedo of the sheen"},
    ProbeSymbol{"1 - max(s) E", "share that passes the sheen"},
    ProbeSymbol{"w", "share that the coat mirrors"},
    ProbeSymbol{"1 - w", "share that passes the coat"},
    ProbeSymbol{"length", "way through the volume"},
    ProbeSymbol{"blur", "blur of what is behind, from 0 to 1"},
    ProbeSymbol{"weight", "weight of the corner of the triangle"},
    ProbeSymbol{"clamp", "clamped value over value"},
    ProbeSymbol{"limit", "what limits the sum to numbers that a picture stores"},
    ProbeSymbol{"share", "share of the pixel that the surface covers"},
    ProbeSymbol{"1 / coverage", "one over the share of the pixel that all surfaces cover"},
};

using R = ProbeRole;
using E = ProbeEffect;

constexpr std::array all_effects = {
    E{"unlit", R::term, "unlit color"},
    E{"metallic-roughness", R::factor, "f"},
    E{"metallic-roughness texture", R::lookup, "metallic-roughness"},
    E{"dielectric reflectance", R::factor, "f0"},
    E{"specular weight texture", R::lookup, "specular weight"},
    E{"specular color texture", R::lookup, "specular color"},
    E{"energy compensation", R::term, "interreflection"},
    E{"sheen", R::term, "sheen highlight"},
    E{"sheen color texture", R::lookup, "sheen color"},
    E{"sheen roughness texture", R::lookup, "sheen roughness"},
    E{"clearcoat", R::term, "coat highlight"},
    E{"clearcoat texture", R::lookup, "clearcoat"},
    E{"clearcoat roughness texture", R::lookup, "clearcoat roughness"},
    E{"clearcoat normal map", R::vector, "n'"},
    E{"iridescence", R::factor, "f"},
    E{"iridescence texture", R::lookup, "iridescence"},
    E{"film thickness texture", R::lookup, "film thickness"},
    E{"transmission", R::term, "transmission"},
    E{"transmission texture", R::lookup, "transmission"},
    E{"volume", R::factor, "length"},
    E{"dispersion", R::factor, "behind"},
    E{"thickness texture", R::lookup, "thickness"},
    E{"anisotropy", R::factor, "alpha_t"},
    E{"anisotropy texture", R::lookup, "anisotropy"},
    E{"Gouraud", R::factor, "weight"},
    E{"flat", R::vector, "n"},
    E{"morphing", R::position},
    E{"skinning", R::position},
    E{"deformed facets", R::position},
    E{"diffuse texture", R::factor, "tint"},
    E{"vertex colors", R::factor, "tint"},
    E{"alpha mask", R::coverage},
    E{"alpha blending", R::coverage},
    E{"opacity texture", R::coverage},
    E{"normal map", R::vector, "n"},
    E{"object-space normal map", R::vector, "n"},
    E{"bump map", R::vector, "n"},
    E{"derivative frames", R::vector, "t"},
    E{"specular antialiasing", R::absent},
    E{"double-sided normals", R::vector, "n"},
    E{"parallax mapping", R::texcoord},
    E{"parallax occlusion mapping", R::texcoord},
    E{"relief mapping", R::texcoord},
    E{"relaxed cones", R::texcoord},
    E{"maximum mipmaps", R::texcoord},
    E{"self-shadow", R::factor, "L"},
    E{"clipped relief", R::coverage},
    E{"curved relief", R::coverage},
    E{"written depth", R::storage},
    E{"displaced shadow", R::factor, "L"},
    E{"directional lights", R::term, "diffuse"},
    E{"point lights", R::term, "diffuse"},
    E{"spot lights", R::term, "diffuse"},
    E{"no falloff", R::factor, "L"},
    E{"mixed falloff", R::factor, "L"},
    E{"light ranges", R::factor, "L"},
    E{"highlight colors", R::factor, "H"},
    E{"light buffer", R::storage},
    E{"shadow", R::factor, "L"},
    E{"ambient", R::term, "ambient"},
    E{"diffuse", R::term, "diffuse"},
    E{"environment light", R::term, "environment light"},
    E{"occlusion texture", R::factor, "occlusion"},
    E{"vertex occlusion", R::factor, "occlusion"},
    E{"Phong highlights", R::term, "highlight"},
    E{"Blinn-Phong highlights", R::term, "highlight"},
    E{"highlight Fresnel", R::factor, "k"},
    E{"specular texture", R::factor, "specular texel"},
    E{"environment tint", R::factor, "N"},
    E{"clamped terms", R::factor, "clamp"},
    E{"emission", R::term, "emission"},
    E{"emission texture", R::factor, "texel"},
    E{"mirror reflection", R::term, "reflection"},
    E{"glossy reflection", R::term, "reflection"},
    E{"reflection by normal", R::factor, "R"},
    E{"Schlick's Fresnel", R::factor, "F"},
    E{"dielectric Fresnel", R::factor, "F"},
    E{"conductor Fresnel", R::factor, "F"},
    E{"environment rotation", R::factor, "R"},
    E{"refraction", R::term, "refraction"},
    E{"exposure", R::picture},
    E{"Reinhard tone mapping", R::picture},
    E{"ACES tone mapping", R::picture},
    E{"Khronos neutral tone mapping", R::picture},
    E{"ACES Hill tone mapping", R::picture},
    E{"boosted ACES Hill tone mapping", R::picture},
};

}  // namespace

std::span<const ProbeTermInfo> probe_terms() {
    return all_terms;
}

const ProbeTermInfo& probe_term_info(ProbeTermKind kind) {
    return all_terms.at(static_cast<std::size_t>(kind));
}

std::span<const ProbeSymbol> probe_symbols() {
    return all_symbols;
}

const ProbeSymbol& probe_symbol(std::string_view symbol) {
    const auto* const row = std::find_if(all_symbols.begin(), all_symbols.end(),
                                         [&](const ProbeSymbol& s) { return s.symbol == symbol; });
    return all_symbols.at(static_cast<std::size_t>(row - all_symbols.begin()));
}

std::span<const ProbeEffect> probe_effects() {
    return all_effects;
}

std::string_view to_string(ProbeOutcome outcome) {
    constexpr std::array names{"shown", "culled", "cut out", "transparent"};
    return names.at(static_cast<std::size_t>(outcome));
}

std::string_view to_string(ProbeLightKind kind) {
    constexpr std::array names{"directional light", "point light", "spot light"};
    return names.at(static_cast<std::size_t>(kind));
}

}  // namespace relief::shade
