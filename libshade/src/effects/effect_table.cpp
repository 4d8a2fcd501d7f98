// SPDX-License-Identifier: Apache-2.0
// Every effect by name: how it is seen in a set of features, how it is put in and taken out, and
// why it is dropped where it cannot show. Pure. Tests: tests/shade/effects/effects_test.cpp.
#include "relief/shade/effects.h"

namespace relief {

namespace {

const char* const no_light = "no light reaches the surface, or it does nothing with it";
const char* const no_normal = "neither light nor reflection shows the normal";
const char* const no_colour = "nothing is scattered that it could tint";
const char* const not_reflecting = "nothing is reflected";
const char* const not_srgb = "the picture is not coded in sRGB";

/// An effect that is one switch.
template <bool Features::*Member>
Effect one_switch(const char* name, const char* hidden) {
    return {name, [](const Features& f) { return f.*Member; },
            [](Features& f, bool on) { f.*Member = on; }, hidden};
}

/// An effect that is one value of a choice; taken out, the choice falls back to its first value.
template <auto Member, auto Value>
Effect one_value(const char* name, const char* hidden) {
    return {name, [](const Features& f) { return f.*Member == Value; },
            [](Features& f, bool on) {
                if (on) {
                    f.*Member = Value;
                } else if (f.*Member == Value) {
                    f.*Member = {};
                }
            },
            hidden};
}

/// Lamps of one kind; put in where there are none, one.
template <std::uint32_t Features::*Member>
Effect lamps(const char* name) {
    return {name, [](const Features& f) { return f.*Member > 0; },
            [](Features& f, bool on) {
                if (!on) {
                    f.*Member = 0;
                } else if (f.*Member == 0) {
                    f.*Member = 1;
                }
            },
            "the material does nothing with light"};
}

std::vector<Effect> surface_effects() {
    using F = Features;
    return {
        one_switch<&F::unlit>("unlit", ""),
        one_switch<&F::metallic_roughness>("metallic-roughness", no_light),
        one_switch<&F::metallic_roughness_texture>("metallic-roughness texture",
                                                   "the material is not metallic-roughness"),
        one_value<&F::interpolation, Interpolation::gouraud>("Gouraud", "no lamp is interpolated"),
        one_value<&F::interpolation, Interpolation::flat>("flat", no_normal),
        one_switch<&F::diffuse_texture>("diffuse texture", no_colour),
        one_switch<&F::vertex_colors>("vertex colours", no_colour),
        one_value<&F::alpha, AlphaMode::mask>("alpha mask", ""),
        one_value<&F::alpha, AlphaMode::blend>("alpha blending", ""),
        one_switch<&F::opacity_texture>("opacity texture", "the material is opaque"),
        one_value<&F::detail, NormalDetail::normal_map>("normal map", no_normal),
        one_value<&F::detail, NormalDetail::object_normal_map>("object-space normal map",
                                                               no_normal),
        one_value<&F::detail, NormalDetail::bump_map>("bump map", no_normal),
        one_value<&F::frame, TangentFrame::derivatives>("derivative frames",
                                                        "no map asks for a tangent frame"),
        one_switch<&F::specular_antialiasing>("specular antialiasing",
                                              "no normal map bends sharp highlights"),
        one_switch<&F::double_sided>("double-sided normals", no_normal),
    };
}

std::vector<Effect> light_effects() {
    using F = Features;
    return {
        one_switch<&F::ambient>("ambient", ""),
        lamps<&F::directional_lights>("directional lights"),
        lamps<&F::point_lights>("point lights"),
        lamps<&F::spot_lights>("spot lights"),
        one_value<&F::falloff, FalloffTerm::none>("no falloff", no_light),
        one_value<&F::falloff, FalloffTerm::mixed>("mixed falloff", no_light),
        one_switch<&F::light_ranges>("light ranges", no_light),
        one_switch<&F::highlight_colors>("highlight colours", "there are no highlights"),
        one_switch<&F::lights_in_buffer>("light buffer", no_light),
        one_switch<&F::environment_diffuse>("environment light", ""),
        one_switch<&F::occlusion_texture>("occlusion texture", "no light comes from everywhere"),
        one_switch<&F::diffuse>("diffuse", "no lamp reaches the surface"),
        one_value<&F::specular, SpecularTerm::phong>("Phong highlights",
                                                     "no lamp reaches the surface"),
        one_value<&F::specular, SpecularTerm::blinn_phong>("Blinn-Phong highlights",
                                                           "no lamp reaches the surface"),
        one_switch<&F::specular_texture>("specular texture", "there are no highlights"),
        one_switch<&F::emission>("emission", ""),
        one_switch<&F::emission_texture>("emission texture",
                                         "the material has no emission that it could tint"),
    };
}

std::vector<Effect> picture_effects() {
    using F = Features;
    return {
        one_value<&F::reflection, ReflectionTerm::mirror>("mirror reflection", ""),
        one_value<&F::reflection, ReflectionTerm::glossy>("glossy reflection", ""),
        one_value<&F::fresnel, FresnelTerm::schlick>("Schlick's Fresnel", not_reflecting),
        one_value<&F::fresnel, FresnelTerm::dielectric>("dielectric Fresnel", not_reflecting),
        one_value<&F::fresnel, FresnelTerm::conductor>("conductor Fresnel", not_reflecting),
        one_switch<&F::refraction>("refraction", "glTF's model lets nothing through"),
        one_switch<&F::exposure>("exposure", not_srgb),
        one_value<&F::tone_mapping, ToneMapping::reinhard>("Reinhard tone mapping", not_srgb),
        one_value<&F::tone_mapping, ToneMapping::aces>("ACES tone mapping", not_srgb),
    };
}

}  // namespace

const std::vector<Effect>& effects() {
    static const std::vector<Effect> all = [] {
        std::vector<Effect> result = surface_effects();
        for (const auto& more : {light_effects(), picture_effects()})
            result.insert(result.end(), more.begin(), more.end());
        return result;
    }();
    return all;
}

}  // namespace relief
