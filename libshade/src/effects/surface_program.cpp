// SPDX-License-Identifier: Apache-2.0
// The table of shader parts: one row a file, with the step that it stands for, when it is chosen,
// and what it takes from outside (its own declarations and those of the files that it includes by
// name). For every Features value exactly one row of each step applies. Pure.
// Tests: tests/shade/effects/surface_program_test.cpp.
#include "effects/surface_program.h"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "effects/light_rows.h"

namespace relief {

namespace {

/// For the table: what a part is chosen by.
using F = const Features&;

bool has_lights(F f) {
    return f.directional_lights + f.point_lights + f.spot_lights > 0;
}
bool has_placed_lights(F f) {
    return f.point_lights + f.spot_lights > 0;
}
bool shows_view(F f) {
    return f.specular != SpecularTerm::none || f.reflection;
}
bool shows_position(F f) {
    return shows_view(f) || has_placed_lights(f);
}
bool shows_normal(F f) {
    return f.diffuse || shows_view(f);
}
bool shows_texcoord(F f) {
    return f.diffuse_texture || f.emission_texture || f.normal_map;
}

/// What a file takes from outside the shader, by GLSL name.
struct Takes {
    std::vector<std::string_view> attributes = {};
    std::vector<std::string_view> uniforms = {};
    std::vector<std::string_view> samplers = {};
    std::vector<std::string_view> blocks = {};
};

/// A shader file, the step that it stands for, and whether these features choose it.
struct Part {
    std::string_view step;
    std::string_view file;
    bool chosen = false;
    Takes takes = {};
};

/// The stages, and vertex attributes on their way.
std::vector<Part> vertex_parts(F f) {
    const bool framed = shows_normal(f) && f.normal_map;
    return {
        {"vertex stage",
         "surface.vert.glsl",
         true,
         {.attributes = {"position_object"}, .uniforms = {"clip_from_object"}}},
        {"fragment stage", "surface.frag.glsl", !f.unlit},
        {"fragment stage", "unlit.frag.glsl", f.unlit, {.uniforms = {"diffuse_color"}}},

        {"pass_position", "absent/pass_position.glsl", !shows_position(f)},
        {"pass_position",
         "vertex/position.glsl",
         shows_position(f),
         {.uniforms = {"world_from_object"}}},
        {"pass_normal", "absent/pass_normal.glsl", !shows_normal(f)},
        {"pass_normal",
         "vertex/normal.glsl",
         shows_normal(f) && !framed,
         {.attributes = {"normal_object"}, .uniforms = {"world_from_object_normal"}}},
        {"pass_normal",
         "vertex/tangent_frame.glsl",
         framed,
         {.attributes = {"normal_object", "tangent_object"},
          .uniforms = {"world_from_object_normal", "world_from_object_tangent", "handedness"}}},
        {"pass_texcoord", "absent/pass_texcoord.glsl", !shows_texcoord(f)},
        {"pass_texcoord", "vertex/texcoord.glsl", shows_texcoord(f), {.attributes = {"texcoord"}}},
        {"pass_color", "absent/pass_color.glsl", !f.vertex_colors},
        {"pass_color", "vertex/color.glsl", f.vertex_colors, {.attributes = {"color_linear"}}},
    };
}

/// What is known of the surface at a fragment.
std::vector<Part> surface_parts(F f) {
    const bool normal = shows_normal(f);
    const bool position = shows_position(f);
    const bool view = shows_view(f);
    return {
        {"surface", "surface/none.glsl", !normal},
        {"surface", "surface/normal.glsl", normal && !position},
        {"surface", "surface/position.glsl", normal && position && !view},
        {"surface", "surface/view.glsl", view, {.uniforms = {"eye_world"}}},
        {"normal", "normal/interpolated.glsl", normal && !f.normal_map},
        {"normal",
         "normal/map.glsl",
         normal && f.normal_map,
         {.uniforms = {"normal_map_scale", "normal_map_bias"}, .samplers = {"normal_texture"}}},
        {"facing", "normal/front.glsl", normal && !f.double_sided},
        {"facing", "normal/both_sides.glsl", normal && f.double_sided},
    };
}

std::vector<Part> light_parts(F f) {
    const bool any = has_lights(f);
    const bool placed = has_placed_lights(f);
    return {
        {"light_rows", "light/rows_block.glsl", any && !f.lights_in_buffer, {.blocks = {"Lights"}}},
        {"light_rows",
         "light/rows_buffer.glsl",
         any && f.lights_in_buffer,
         {.samplers = {"light_buffer"}}},
        {"directional_lights", "absent/directional_lights.glsl", f.directional_lights == 0},
        {"directional_lights", "light/directional.glsl", f.directional_lights > 0},
        {"point_lights", "absent/point_lights.glsl", f.point_lights == 0},
        {"point_lights", "light/point.glsl", f.point_lights > 0},
        {"spot_lights", "absent/spot_lights.glsl", f.spot_lights == 0},
        {"spot_lights", "light/spot.glsl", f.spot_lights > 0},
        {"falloff", "light/falloff.glsl", placed && !f.light_ranges},
        {"falloff", "light/falloff_range.glsl", placed && f.light_ranges},
        {"ambient", "absent/ambient.glsl", !f.ambient},
        {"ambient", "light/ambient.glsl", f.ambient, {.uniforms = {"ambient_scattered"}}},
    };
}

/// What the surface does with the light, and how the picture is coded.
std::vector<Part> material_parts(F f) {
    const Takes highlight{.uniforms = {"specular_color", "shininess"}};
    return {
        {"diffuse", "absent/diffuse.glsl", !f.diffuse},
        {"diffuse", "scatter/lambert.glsl", f.diffuse, {.uniforms = {"diffuse_color"}}},
        {"specular", "absent/specular.glsl", f.specular == SpecularTerm::none},
        {"specular", "scatter/phong.glsl", f.specular == SpecularTerm::phong, highlight},
        {"specular", "scatter/blinn_phong.glsl", f.specular == SpecularTerm::blinn_phong,
         highlight},
        {"diffuse_texture", "absent/diffuse_texture.glsl", !f.diffuse_texture},
        {"diffuse_texture",
         "color/texture.glsl",
         f.diffuse_texture,
         {.samplers = {"diffuse_texture"}}},
        {"vertex_color", "absent/vertex_color.glsl", !f.vertex_colors},
        {"vertex_color", "color/vertex.glsl", f.vertex_colors},
        {"reflection", "absent/reflection.glsl", !f.reflection},
        {"reflection",
         "reflection/environment.glsl",
         f.reflection,
         {.uniforms = {"environment_intensity", "reflectivity", "grazing_reflectivity"},
          .samplers = {"environment"}}},
        {"emission", "absent/emission.glsl", !f.emission},
        {"emission",
         "emission/color.glsl",
         f.emission && !f.emission_texture,
         {.uniforms = {"emission_color"}}},
        {"emission",
         "emission/texture.glsl",
         f.emission && f.emission_texture,
         {.uniforms = {"emission_color"}, .samplers = {"emission_texture"}}},
        {"output", "output/linear.glsl", f.output == OutputCoding::linear},
        {"output", "output/clamped.glsl", f.output == OutputCoding::clamped},
        {"output", "output/srgb.glsl", f.output == OutputCoding::srgb},
    };
}

/// The parts that these features choose: one for each step that they need.
std::vector<Part> chosen_parts(F f) {
    std::vector<Part> chosen;
    for (const auto& parts :
         {vertex_parts(f), surface_parts(f), light_parts(f), material_parts(f)}) {
        std::copy_if(parts.begin(), parts.end(), std::back_inserter(chosen),
                     [](const Part& part) { return part.chosen; });
    }
    return chosen;
}

ShaderConstants light_constants(F f) {
    const LightRowLayout layout = light_row_layout(f);
    const auto number = [](std::uint32_t value) { return static_cast<int>(value); };
    return {{"directional_light_count", number(f.directional_lights)},
            {"point_light_count", number(f.point_lights)},
            {"spot_light_count", number(f.spot_lights)},
            {"first_directional_row", 0},
            {"first_point_row", number(layout.first_point)},
            {"first_spot_row", number(layout.first_spot)},
            {"light_row_count", number(layout.count)}};
}

void append(std::vector<std::string>& names, const std::vector<std::string_view>& more) {
    names.insert(names.end(), more.begin(), more.end());
}

void sort_and_unite(std::vector<std::string>& names) {
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
}

}  // namespace

ShaderSteps chosen_steps(const Features& features) {
    ShaderSteps steps;
    for (const Part& part : chosen_parts(features)) {
        [[maybe_unused]] const bool first = steps.emplace(part.step, part.file).second;
        assert(first && "two files for one step");
    }
    return steps;
}

std::string_view output_file(OutputCoding coding) {
    Features features;
    features.output = coding;
    return chosen_steps(features).at("output");
}

SurfaceProgram surface_program(const Features& features) {
    const ShaderSteps steps = chosen_steps(features);
    const ShaderConstants constants =
        has_lights(features) ? light_constants(features) : ShaderConstants{};
    return {assemble(steps.at("vertex stage"), steps, {}),
            assemble(steps.at("fragment stage"), steps, constants)};
}

PlannedInterface planned_interface(const Features& features) {
    PlannedInterface planned;
    for (const Part& part : chosen_parts(features)) {
        append(planned.attributes, part.takes.attributes);
        append(planned.uniforms, part.takes.uniforms);
        append(planned.samplers, part.takes.samplers);
        append(planned.uniform_blocks, part.takes.blocks);
    }
    sort_and_unite(planned.attributes);
    sort_and_unite(planned.uniforms);
    sort_and_unite(planned.samplers);
    sort_and_unite(planned.uniform_blocks);
    return planned;
}

}  // namespace relief
