// SPDX-License-Identifier: Apache-2.0
// What a set of effects implies: the rules by which canonical() drops what cannot show, and the set
// in words. Pure. Tests: tests/shade/effects/effects_test.cpp.
#include <fmt/format.h>

#include "effects/light_rows.h"
#include "relief/shade/effects.h"

namespace relief {

namespace {

std::uint32_t light_count(const Features& f) {
    return f.directional_lights + f.point_lights + f.spot_lights;
}

/// An unlit surface shows its tinted diffuse colour and nothing else.
Features unlit_only(const Features& f) {
    Features result;
    result.unlit = true;
    result.diffuse_texture = f.diffuse_texture;
    result.vertex_colors = f.vertex_colors;
    result.output = f.output;
    return result;
}

std::string counted(std::uint32_t count, const char* kind) {
    return fmt::format("{} {} light{}", count, kind, count == 1 ? "" : "s");
}

}  // namespace

Features canonical(Features f) {
    if (f.unlit) return unlit_only(f);
    if (light_count(f) == 0) {
        f.diffuse = false;
        f.specular = SpecularTerm::none;
    }
    if (!f.diffuse && f.specular == SpecularTerm::none) {
        f.directional_lights = f.point_lights = f.spot_lights = 0;
    }
    if (f.point_lights + f.spot_lights == 0) f.light_ranges = false;
    if (light_count(f) == 0) f.lights_in_buffer = false;
    if (light_row_layout(f).count > max_block_rows) f.lights_in_buffer = true;
    const bool normal_shows = f.diffuse || f.specular != SpecularTerm::none || f.reflection;
    if (!normal_shows) f.normal_map = f.double_sided = false;
    if (!f.ambient && !f.diffuse) f.diffuse_texture = f.vertex_colors = false;
    if (!f.emission) f.emission_texture = false;
    return f;
}

std::string describe(const Features& f) {
    std::vector<std::string> parts;
    const auto add_if = [&](bool on, const char* name) {
        if (on) parts.emplace_back(name);
    };
    add_if(f.unlit, "unlit");
    add_if(f.diffuse_texture, "diffuse texture");
    add_if(f.vertex_colors, "vertex colours");
    add_if(f.normal_map, "normal map");
    add_if(f.double_sided, "double-sided");
    add_if(f.ambient, "ambient");
    if (f.directional_lights > 0) parts.push_back(counted(f.directional_lights, "directional"));
    if (f.point_lights > 0) parts.push_back(counted(f.point_lights, "point"));
    if (f.spot_lights > 0) parts.push_back(counted(f.spot_lights, "spot"));
    add_if(f.light_ranges, "light ranges");
    add_if(f.lights_in_buffer, "light buffer");
    add_if(f.diffuse, "diffuse");
    add_if(f.specular == SpecularTerm::phong, "Phong");
    add_if(f.specular == SpecularTerm::blinn_phong, "Blinn-Phong");
    add_if(f.reflection, "reflection");
    add_if(f.emission, "emission");
    add_if(f.emission_texture, "emission texture");
    add_if(f.output == OutputCoding::linear, "linear");
    add_if(f.output == OutputCoding::clamped, "clamped");
    add_if(f.output == OutputCoding::srgb, "sRGB");
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace relief
