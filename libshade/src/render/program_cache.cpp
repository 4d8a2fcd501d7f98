// SPDX-License-Identifier: Apache-2.0
// Links programs with common bindings, once for each set of features. Tests:
// tests/shade/render/render_cache_test.cpp.
#include "render/program_cache.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "effects/shader_source.h"
#include "relief/mesh/statistics.h"
#include "relief/shade/renderer.h"

namespace relief::shade::detail {

namespace {

std::vector<gl::Location> attribute_locations() {
    const auto at = [](const char* name, Attribute attribute) {
        return gl::Location{name, static_cast<GLuint>(attribute)};
    };
    return {at("position_object", Attribute::position_object),
            at("normal_object", Attribute::normal_object),
            at("texcoord", Attribute::texcoord),
            at("tangent_object", Attribute::tangent_object),
            at("color_linear", Attribute::color_linear),
            at("texcoord_2", Attribute::texcoord_2)};
}

constexpr std::array<std::pair<const char*, TextureUnit>, 13> texture_units{{
    {"environment", TextureUnit::environment},
    {"blurred_environment", TextureUnit::blurred_environment},
    {"environment_brdf", TextureUnit::environment_brdf},
    {"light_buffer", TextureUnit::light_buffer},
    {"shadow_maps", TextureUnit::shadow_maps},
    {"behind", TextureUnit::behind},
    {"joint_matrices", TextureUnit::joint_matrices},
    {"joint_weights", TextureUnit::joint_weights},
    {"morph_weights", TextureUnit::morph_weights},
    {"morph_displacements", TextureUnit::morph_displacements},
    {"facet_corners", TextureUnit::facet_corners},
    {"hidden_shares", TextureUnit::hidden_shares},
    {"drawn", TextureUnit::drawn},
}};

}  // namespace

gl::LinkedProgram link(const gl::Api& api, const std::string& name, const ShaderSource& vertex,
                       const ShaderSource& fragment) {
    try {
        gl::LinkedProgram program(api,
                                  {name, vertex.text, fragment.text, attribute_locations(), {}});
        program.use();
        for (const TextureSlotInfo& slot : texture_slots)
            program.set(slot.sampler, static_cast<int>(slot.slot));
        for (const auto& [sampler, unit] : texture_units)
            program.set(sampler, static_cast<int>(unit));
        program.bind_block("Lights", lights_binding);
        return program;
    } catch (const GpuError& error) {
        const std::string message = error.what();
        const bool in_vertex = message.find("vertex shader:") != std::string::npos;
        throw GpuError(with_file_names(message, in_vertex ? vertex : fragment));
    }
}

void check_texture_units(const PlannedInterface& planned, int available, std::string_view where) {
    std::vector<std::string> samplers = planned.samplers;
    std::erase_if(samplers, [](const std::string& name) {
        return std::any_of(texture_units.begin(), texture_units.end(), [&](const auto& row) {
            return row.first == name && is_vertex_texture(row.second);
        });
    });
    const std::size_t needed = samplers.size();
    if (needed <= static_cast<std::size_t>(available)) return;
    throw GpuError(
        fmt::format("a surface needs {} textures at once, and a shader of {} can sample {}: {}",
                    needed, where, available, fmt::join(samplers, ", ")));
}

namespace {

/// Adds the uniforms that only edited parts declare, so that they get their values, too.
void add_active_uniforms(PlannedInterface& planned, const gl::LinkedProgram& program) {
    std::vector<std::string>& names = planned.uniforms;
    for (const gl::ActiveVariable& uniform : program.interface().uniforms) {
        const auto place = std::lower_bound(names.begin(), names.end(), uniform.name);
        if (place == names.end() || *place != uniform.name) names.insert(place, uniform.name);
    }
}

}  // namespace

std::shared_ptr<const DrawProgram> ProgramCache::get(const Features& features) {
    std::shared_ptr<const DrawProgram> entry;
    if (const auto known = programs_.find(features); known != programs_.end())
        entry = known->second;
    if (!entry) {
        const Stopwatch stopwatch;
        PlannedInterface planned = planned_interface(features);
        check_texture_units(planned, api_->limits().texture_units);
        const SurfaceProgram source = surface_program(features, GlslVersion::core_330, *texts_);
        gl::LinkedProgram program = link(*api_, fmt::format("surface ({})", describe(features)),
                                         source.vertex, source.fragment);
        add_active_uniforms(planned, program);
        entry = std::make_shared<const DrawProgram>(
            DrawProgram{std::move(program), std::move(planned)});
        programs_.emplace(features, entry);
        milliseconds_ += 1e3 * stopwatch.seconds();
    }
    return entry;
}

std::shared_ptr<const gl::LinkedProgram> ProgramCache::get(const std::string& name,
                                                           const ShaderSteps& steps) {
    const auto known = others_.find({name, steps});
    if (known != others_.end()) return known->second;
    const SurfaceProgram source = pass_program(name, steps, GlslVersion::core_330, *texts_);
    auto program = std::make_shared<const gl::LinkedProgram>(
        link(*api_, name, source.vertex, source.fragment));
    others_.emplace(std::pair(name, steps), program);
    return program;
}

void ProgramCache::clear() {
    programs_.clear();
    others_.clear();
}

const ShaderTexts& ProgramCache::no_texts() {
    static const ShaderTexts none;
    return none;
}

ProgramCache& ProgramCaches::with(const std::shared_ptr<const ShaderTexts>& texts) {
    std::erase_if(edited_, [](const auto& entry) { return entry.first.expired(); });
    return texts ? edited_.try_emplace(texts, *api_, *texts).first->second : plain_;
}

void ProgramCaches::clear() {
    plain_.clear();
    for (auto& [texts, programs] : edited_)
        programs.clear();
}

std::size_t ProgramCaches::size() const {
    std::size_t size = plain_.size();
    for (const auto& [texts, programs] : edited_)
        size += programs.size();
    return size;
}

}  // namespace relief::shade::detail
