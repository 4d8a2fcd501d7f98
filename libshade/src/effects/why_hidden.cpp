// SPDX-License-Identifier: Apache-2.0
// Why canonical() dropped an effect, in words: the effect's own reason (effects.h), or a nearer one
// where it depends on what else was wished. Pure. Tests: tests/shade/effects/plan_test.cpp,
// effect_forcing_test.cpp.
#include "effects/why_hidden.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace relief {

namespace {

/// What glTF's model has its own of, or none.
bool is_phongs(std::string_view effect) {
    constexpr std::array names{"Phong highlights",   "Blinn-Phong highlights", "specular texture",
                               "highlight colours",  "mirror reflection",      "Schlick's Fresnel",
                               "dielectric Fresnel", "conductor Fresnel",      "refraction"};
    return std::find(names.begin(), names.end(), effect) != names.end();
}

}  // namespace

std::string why_hidden(const Effect& effect, const Features& wished, const Features& shown) {
    const std::string_view name = effect.name;
    if (shown.unlit) return "the material is unlit";
    const bool detail = name.ends_with("map") && wished.detail != shown.detail;
    if (detail && wished.interpolation == Interpolation::gouraud) {
        return "Gouraud shading knows the normal at vertices only";
    }
    if (detail && wished.interpolation == Interpolation::flat) {
        return "flat shading knows the triangle's plane only";
    }
    if (wished.interpolation == Interpolation::flat && name == "double-sided normals") {
        return "a triangle's plane turns to the eye by itself";
    }
    if (wished.output == OutputCoding::half &&
        (name == "exposure" || name.ends_with("tone mapping"))) {
        return "the finishing pass does it";
    }
    if (shown.metallic_roughness && is_phongs(name)) return "metallic-roughness has its own";
    return effect.hidden;
}

}  // namespace relief
