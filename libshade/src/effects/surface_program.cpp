// SPDX-License-Identifier: Apache-2.0
// Programs put together from the parts that a set of effects chooses (shader_parts.h), and what
// they take from outside. Pure. Tests: tests/shade/effects/surface_program_test.cpp.
#include "effects/surface_program.h"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "effects/light_rows.h"
#include "effects/shader_parts.h"

namespace relief {

namespace {

/// The parts that these features choose: one for each step that they need.
Parts chosen_of(const std::vector<Parts>& all) {
    Parts chosen;
    for (const Parts& parts : all) {
        std::copy_if(parts.begin(), parts.end(), std::back_inserter(chosen),
                     [](const Part& part) { return part.chosen; });
    }
    return chosen;
}

struct ChosenParts {
    Parts vertex;
    Parts fragment;
};

ChosenParts chosen_parts(const Features& f) {
    return {chosen_of(vertex_parts(f)), chosen_of(is_data(f.view) ? data_parts(f)
                                                  : f.unlit       ? unlit_parts(f)
                                                                  : fragment_parts(f))};
}

ShaderSteps steps_of(const Parts& parts) {
    ShaderSteps steps;
    for (const Part& part : parts) {
        [[maybe_unused]] const bool first = steps.emplace(part.step, part.file).second;
        assert(first && "two files for one step");
    }
    return steps;
}

ShaderConstants light_constants(const Features& f) {
    const LightRowLayout layout = light_row_layout(f);
    const auto number = [](std::uint32_t value) { return static_cast<int>(value); };
    return {{"directional_light_count", number(f.directional_lights)},
            {"point_light_count", number(f.point_lights)},
            {"spot_light_count", number(f.spot_lights)},
            {"directional_light_rows", number(layout.directional_rows)},
            {"point_light_rows", number(layout.point_rows)},
            {"spot_light_rows", number(layout.spot_rows)},
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

ChosenSteps chosen_steps(const Features& features) {
    const ChosenParts parts = chosen_parts(features);
    return {steps_of(parts.vertex), steps_of(parts.fragment)};
}

ShaderSteps output_steps(OutputCoding coding, const Scene& scene) {
    Features features;
    features.output = coding;
    features.exposure = scene.exposure != 1.0F;
    features.tone_mapping = scene.tone_mapping;
    return steps_of(chosen_of({output_parts(canonical(features))}));
}

SurfaceProgram surface_program(const Features& features) {
    const ChosenSteps steps = chosen_steps(features);
    const ShaderConstants constants =
        lamp_count(features) > 0 ? light_constants(features) : ShaderConstants{};
    // The stage that computes the lamps.
    const bool at_vertices = features.interpolation == Interpolation::gouraud;
    return {assemble(steps.vertex.at("stage"), steps.vertex,
                     at_vertices ? constants : ShaderConstants{}),
            assemble(steps.fragment.at("stage"), steps.fragment,
                     at_vertices ? ShaderConstants{} : constants)};
}

PlannedInterface planned_interface(const Features& features) {
    PlannedInterface planned;
    const ChosenParts parts = chosen_parts(features);
    for (const Parts& stage : {parts.vertex, parts.fragment}) {
        for (const Part& part : stage) {
            append(planned.attributes, part.takes.attributes);
            append(planned.uniforms, part.takes.uniforms);
            append(planned.samplers, part.takes.samplers);
            append(planned.uniform_blocks, part.takes.blocks);
        }
    }
    sort_and_unite(planned.attributes);
    sort_and_unite(planned.uniforms);
    sort_and_unite(planned.samplers);
    sort_and_unite(planned.uniform_blocks);
    return planned;
}

}  // namespace relief
