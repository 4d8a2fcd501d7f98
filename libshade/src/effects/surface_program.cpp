// SPDX-License-Identifier: Apache-2.0
// The program of a set of effects: its source, its inputs, and listings of the programs of a plan.
// Pure. Tests: tests/shade/effects/shader_source_test.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "effects/features.h"
#include "effects/light_rows.h"
#include "effects/shader_source.h"
#include "relief/shade/effects.h"

namespace relief::shade {
using namespace relief::shade::detail;

namespace {

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

void sort_and_unite(std::vector<std::string>& names) {
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
}

/// Changes the lookups of the textures that use the second texture coordinates.
std::string at_second_texcoords(std::string text, const Features& f) {
    for_each_sampled(f, [&](const TextureSlotInfo& texture, bool is_second) {
        if (!is_second) return;
        const std::string lookup = fmt::format("texture({}, texcoord_surface", texture.sampler);
        const std::size_t place = text.find(lookup);
        assert(place != std::string::npos && text.find(lookup, place + 1) == std::string::npos);
        text.insert(place + lookup.size(), "_2");
    });
    return text;
}

/// Changes the lookups at the coordinates of the surface to displaced ones (height_march.glsl).
std::string at_displaced_texcoords(const std::string& text) {
    constexpr std::string_view function = "texture(";
    constexpr std::string_view coordinates = ", texcoord_surface";
    std::string changed;
    std::size_t copied = 0;
    for (std::size_t at = text.find(function); at != std::string::npos;
         at = text.find(function, at + 1)) {
        const std::size_t sampler = at + function.size();
        const std::size_t comma = text.find_first_of(",)", sampler);
        if (comma == std::string::npos || text.compare(comma, coordinates.size(), coordinates) != 0)
            continue;
        const std::size_t suffix = comma + coordinates.size();
        const std::size_t end = text.find(')', suffix);
        const std::string set = text.substr(suffix, end - suffix);
        if (!set.empty() && set != "_2") continue;
        changed += text.substr(copied, at - copied);
        changed += fmt::format(
            "textureGrad({}, texcoord_displaced{}, texcoord_right{}, "
            "texcoord_up{}",
            text.substr(sampler, comma - sampler), set, set, set);
        copied = end;
    }
    return changed + text.substr(copied);
}

/// The embedded parts of one stage's program.
class StageParts {
  public:
    explicit StageParts(const ShaderSteps& steps) : steps_(steps) {}

    /// Adds a part and everything that it includes.
    void add(const ShaderPart* part) {
        if (part == nullptr || std::find(all_.begin(), all_.end(), part) != all_.end()) return;
        all_.push_back(part);
        for (const ShaderInclude& include : part->includes) {
            const auto step = include.is_step ? steps_.find(include.name) : steps_.end();
            if (step != steps_.end()) {
                add(find_embedded_part(step->second));
            } else if (include.is_step) {
                add(find_neutral_code(include.name));
            } else {
                add(find_embedded_part(include.name));
            }
        }
    }

    [[nodiscard]] const std::vector<const ShaderPart*>& all() const { return all_; }

  private:
    const ShaderSteps& steps_;
    std::vector<const ShaderPart*> all_;
};

/// Adds the inputs of a stage. What the fragment stage gets from the vertex stage is no input.
void add_inputs(PlannedInterface& planned, std::string_view main, const ShaderSteps& steps,
                bool is_vertex_stage) {
    StageParts parts(steps);
    parts.add(find_embedded_part(main));
    for (const ShaderPart* const part : parts.all()) {
        for (const auto& [kind, name] : part->inputs) {
            switch (kind) {
                case ShaderInputKind::varying:
                    if (is_vertex_stage) planned.attributes.emplace_back(name);
                    break;
                case ShaderInputKind::uniform:
                    planned.uniforms.emplace_back(name);
                    break;
                case ShaderInputKind::sampler:
                    planned.samplers.emplace_back(name);
                    break;
                case ShaderInputKind::block:
                    planned.uniform_blocks.emplace_back(name);
                    break;
            }
        }
    }
}

ShaderListing listing_of(const Features& features, const ShaderTexts& texts) {
    const SurfaceProgram program = surface_program(features, GlslVersion::core_330, texts);
    ShaderListing listing;
    listing.features = features;
    listing.vertex = program.vertex.text;
    listing.fragment = program.fragment.text;
    listing.files = program.vertex.parts;
    listing.files.insert(listing.files.end(), program.fragment.parts.begin(),
                         program.fragment.parts.end());
    sort_and_unite(listing.files);
    return listing;
}

}  // namespace

SurfaceProgram detail::surface_program(const Features& features, GlslVersion version,
                                       const ShaderTexts& texts) {
    return surface_program_with(features, version, nullptr, texts);
}

SurfaceProgram detail::surface_program_with(const Features& features, GlslVersion version,
                                            void (*change)(ShaderSteps& fragment),
                                            const ShaderTexts& texts) {
    ChosenSteps chosen = chosen_steps(features);
    if (change != nullptr) change(chosen.fragment);
    const ShaderConstants constants =
        light_count(features) > 0 ? light_constants(features) : ShaderConstants{};
    // The stage that computes the lights.
    const bool at_vertices = features.interpolation == Interpolation::gouraud;
    SurfaceProgram program{assemble(chosen.vertex_main, chosen.vertex,
                                    at_vertices ? constants : ShaderConstants{}, version, texts),
                           assemble(chosen.fragment_main, chosen.fragment,
                                    at_vertices ? ShaderConstants{} : constants, version, texts)};
    program.fragment.text = at_second_texcoords(std::move(program.fragment.text), features);
    if (is_displaced(features))
        program.fragment.text = at_displaced_texcoords(program.fragment.text);
    return program;
}

SurfaceProgram detail::pass_program(std::string_view file, const ShaderSteps& steps,
                                    GlslVersion version, const ShaderTexts& texts) {
    return {assemble(fmt::format("{}.glsl#vertex", file), steps, {}, version, texts),
            assemble(fmt::format("{}.glsl#fragment", file), steps, {}, version, texts)};
}

PlannedInterface planned_interface(const Features& features) {
    const ChosenSteps chosen = chosen_steps(features);
    PlannedInterface planned;
    add_inputs(planned, chosen.vertex_main, chosen.vertex, true);
    add_inputs(planned, chosen.fragment_main, chosen.fragment, false);
    sort_and_unite(planned.attributes);
    sort_and_unite(planned.uniforms);
    sort_and_unite(planned.samplers);
    sort_and_unite(planned.uniform_blocks);
    return planned;
}

std::vector<ShaderListing> shader_listings(const FramePlan& plan, const ShaderTexts& texts) {
    std::vector<ShaderListing> listings;
    std::map<Features, std::size_t> known;
    for (std::size_t i = 0; i < plan.draws.size(); ++i) {
        const Features& features = plan.draws[i].features;
        const auto [entry, is_new] = known.emplace(features, listings.size());
        if (is_new) listings.push_back(listing_of(features, texts));
        listings[entry->second].draws.push_back(i);
    }
    return listings;
}

}  // namespace relief::shade
